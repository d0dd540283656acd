/* The shortest tied cords, then as many as asked for, evened out by exchanges that leave the nodes tied. */
#include "tortuosity/tie/tube_cords.h"
#include "graph/threading/walks.h"
#include "lp/length/balance.h"
#include "lp/length/share.h"
#include "lp/length/share_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The framework is one component. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits;
  thr_share share;
  int *component;           /* [n_nodes] zeros: what the share says of every node */
  const thr_tube *shortest; /* of any number of cords that the options allow; closed: one */
  int *passes;              /* [n_edges] of the walks at hand */
  thr_walks walks;          /* result */
  double work;              /* that searches for short cords may still do: about a second of linear programmes */
  bool least, certain;      /* the passes are the shortest, the longest cord as short as can be: the solver's word */
  bool asked;               /* max_length: the table was, for any number of cords */
} several;

static void several_destroy(several *x)
{
  thr_walks_destroy(&x->walks);
  free(x->component);
  free(x->passes);
}

static thr_status several_init(several *x, thr_err *err)
{
  x->component = thr_calloc((size_t)x->f->n_nodes, sizeof *x->component);
  x->passes = thr_calloc((size_t)x->f->n_edges, sizeof *x->passes);
  x->share = (thr_share){x->f, x->o, x->component};
  x->least = x->certain = true;
  x->work = 1e8;
  return x->component && x->passes ? THR_OK : thr_nomem(err);
}

static bool closed_cords(const several *x)
{
  return x->o->ends == THR_ENDS_CLOSED;
}

/* ---- a number of cords ---- */

/* The cords as walks; out is empty before. */
static thr_status walks_of(const several *x, const thr_tube *tube, thr_walks *out, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < tube->n_cords && !st; i++) {
    const thr_cord *cord = &tube->cord[i];
    thr_walk walk = {cord->n_passes, thr_calloc((size_t)cord->n_passes, sizeof *walk.half), 0, closed_cords(x)};
    if (!walk.half) return thr_nomem(err);
    memcpy(walk.half, cord->half, (size_t)cord->n_passes * sizeof *walk.half);
    st = thr_walks_add(out, x->f, walk, err);
  }
  return st;
}

/* Short walks: exactly n open ones, or as many as the counts say; of closed ones, one. */
static thr_status short_walks(several *x, int n, thr_walks *out, thr_err *err)
{
  thr_request options = *x->o;
  thr_limits some = *x->limits;
  thr_tube tube = {0};
  thr_err why = {0};
  if (closed_cords(x) || options.ends == THR_ENDS_COUNTS || x->shortest->n_cords == n) return walks_of(x, x->shortest, out, err);
  options.cords = options.cords_least = n;
  some.work = &x->work;
  thr_status st =
      x->work > 0 ? thr_tube_shortest(x->f, &options, &some, &tube, &why) : thr_tube_some(x->f, &options, x->limits, &tube, &why);
  if (st == THR_OK || st == THR_ELIMIT)
    st = walks_of(x, &tube, out, err);
  else
    st = thr_fail(err, st, "%s", why.text);
  thr_tube_destroy(&tube);
  return st;
}

/* passes are those of the walks. */
static void count_passes(const several *x, const thr_walks *w)
{
  memset(x->passes, 0, (size_t)x->f->n_edges * sizeof *x->passes);
  thr_walks_count(w, x->passes);
}

static double total(const thr_walks *w)
{
  double sum = 0;
  for (int i = 0; i < w->n_walks; i++)
    sum += w->walk[i].length;
  return sum;
}

static bool within(double length, double limit)
{
  return length <= limit * (1 + 1e-12);
}

/* n closed walks from few. *found false: not so many; certain: there are none. */
static thr_status split(several *x, int n, bool even, thr_walks *w, bool *found, bool *certain, thr_err *err)
{
  double least = x->shortest->length * (1 + 1e-12);
  *certain = false;
  thr_status st = thr_share_tied(&x->share, n, even, x->passes, w, found, err);
  if (st || (*found && (even || total(w) <= least))) return st;
  st = thr_share_table(&x->share, 0, &(thr_share_ask){n, n, false, INFINITY}, x->limits, w, x->passes, certain, err);
  *found = w->n_walks >= n;
  if (!even) x->least &= *certain;
  return st;
}

static thr_status even_out(several *x, double goal, thr_walks *w, thr_err *err)
{
  bool certain;
  const int n = w->n_walks;
  const bool counts = x->o->ends == THR_ENDS_COUNTS;
  thr_share_ask ask = {n, n, true, INFINITY};
  if (goal > 0) ask = (thr_share_ask){counts ? n : x->o->cords_least, counts ? n : x->o->cords, false, goal};
  thr_status st = thr_balance_walks(&x->share, w, goal, x->limits, x->passes, err);
  if (st || (goal > 0 && (x->asked || within(thr_walks_longest(w), goal)))) return st;
  x->asked = goal > 0;
  st = thr_share_table(&x->share, 0, &ask, x->limits, w, x->passes, &certain, err);
  if (!st) x->certain &= certain;
  return st;
}

/* From short walks n. */
static thr_status make_walks(several *x, int n, bool even, double goal, thr_walks *w, bool *found, bool *certain, thr_err *err)
{
  thr_status st = THR_OK;
  *found = true;
  *certain = false;
  count_passes(x, w);
  if (closed_cords(x)) st = split(x, n, even, w, found, certain, err);
  return !st && even && *found ? even_out(x, goal, w, err) : st;
}

static thr_status make_number(several *x, int n, bool even, thr_err *err)
{
  bool found, certain;
  thr_status st = short_walks(x, n, &x->walks, err);
  if (!st) st = make_walks(x, n, even, 0, &x->walks, &found, &certain, err);
  if (st || found) return st;
  return thr_fail(err, THR_EINFEASIBLE, "the component with node %s: %s %d closed cords that tie its joints", x->f->name[0],
                  certain ? "there are no" : "did not find", n);
}

/* Of even lengths, as many cords as the shortest are: their number is one that can be. */
static thr_status even_shortest(several *x, thr_err *err)
{
  bool found, certain;
  thr_status st = walks_of(x, x->shortest, &x->walks, err);
  return st ? st : make_walks(x, x->walks.n_walks, true, 0, &x->walks, &found, &certain, err);
}

/* Of even lengths: as many cords as there may be. */
static thr_status make_even(several *x, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int least = x->o->cords_least;
  thr_err why = {0};
  thr_status st = THR_EINFEASIBLE;
  for (int n = x->o->cords; n >= least && st == THR_EINFEASIBLE; n = n > 2 * least && n > IN_SINGLE_STEPS ? n / 2 : n - 1) {
    why = (thr_err){0};
    x->least = x->certain = true;
    thr_walks_destroy(&x->walks);
    st = make_number(x, n, true, &why);
  }
  if (st == THR_EINFEASIBLE && !closed_cords(x)) {
    thr_walks_destroy(&x->walks);
    st = even_shortest(x, &why);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- no cord longer than a limit ---- */

/* Tries n cords, if so few may do. */
static thr_status try_number(several *x, int n, bool *done, thr_err *err)
{
  bool found = false, certain;
  thr_err why = {0};
  thr_walks new = {0};
  thr_status st = short_walks(x, n, &new, &why);
  bool none = st == THR_EINFEASIBLE;
  if (!st && total(&new) <= fmax(n, new.n_walks) * x->o->max_length * (1 + 1e-9))
    st = make_walks(x, n, true, x->o->max_length, &new, &found, &certain, &why);
  if (!st && found) {
    thr_walks_destroy(&x->walks);
    x->walks = new;
    new = (thr_walks){0};
    *done = within(thr_walks_longest(&x->walks), x->o->max_length);
  }
  thr_walks_destroy(&new);
  return st && !none ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

static thr_status none_found(const several *x, thr_err *err)
{
  const char *units = x->f->units;
  double limit = x->o->max_length;
  if (x->walks.n_walks == 0)
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s: did not find up to %d cords that tie its joints, none longer than %g %s; together "
        "they need %g %s",
        x->f->name[0], x->o->cords, limit, units, x->shortest->length, units);
  return thr_fail(
      err, THR_EINFEASIBLE,
      "the component with node %s: did not find up to %d cords that tie its joints, none longer than %g %s, but one of %g "
      "%s",
      x->f->name[0], x->o->cords, limit, units, thr_walks_longest(&x->walks), units);
}

/* The fewest cords that the shortest length leaves possible, and more, in larger steps after some. */
static thr_status grow(several *x, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int most = x->o->cords;
  bool done = false;
  thr_status st = thr_cords_reach(x->f, x->o, err);
  double least = ceil(x->shortest->bound / x->o->max_length * (1 - 1e-9)), fewest = fmin(most, least);
  int n = fewest > x->o->cords_least ? (int)fewest : x->o->cords_least;
  if (x->o->ends == THR_ENDS_COUNTS) n = most;
  for (int tried = 0, step = 1; !st && n <= most && !done; n += step) {
    st = try_number(x, n, &done, err);
    if (++tried > IN_SINGLE_STEPS && n < most) step = 2 * step < most - n ? 2 * step : most - n;
  }
  return !st && !done ? none_found(x, err) : st;
}

/* ---- the plan ---- */

/* Is more asked for than the shortest length? */
static bool lengths_asked(const thr_request *options)
{
  return thr_wants_balance(options) || options->max_length > 0;
}

bool thr_tube_shares(const thr_request *options)
{
  return lengths_asked(options) || (options->ends == THR_ENDS_CLOSED && options->cords_least > 1);
}

static void move_cords(thr_tube *tube, thr_plan *plan)
{
  plan->cord = tube->cord;
  plan->n_cords = tube->n_cords;
  tube->cord = NULL;
  tube->n_cords = 0;
}

static thr_status make_some(several *x, thr_plan *plan, thr_err *err)
{
  const thr_request *options = x->o;
  thr_status st = options->max_length > 0      ? grow(x, err)
                  : thr_wants_balance(options) ? make_even(x, err)
                                               : make_number(x, options->cords_least, false, err);
  return st ? st : thr_walks_plan(&x->walks, 1, plan, err);
}

thr_status thr_tube_cords(thr_tube *tube, const thr_limits *limits, thr_plan *plan, thr_cords_word *word, thr_err *err)
{
  const thr_request *options = &plan->options;
  several x = {.f = &plan->frame, .o = options, .limits = limits, .shortest = tube};
  *word = (thr_cords_word){0};
  if (!thr_tube_shares(options)) {
    move_cords(tube, plan);
    return THR_OK;
  }
  thr_status st = several_init(&x, err);
  if (!st) st = make_some(&x, plan, err);
  if (!st) *word = (thr_cords_word){x.least && !lengths_asked(options), x.certain && thr_wants_balance(options)};
  several_destroy(&x);
  return st;
}
