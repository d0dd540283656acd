/* The shortest tied cords, then as many as asked for, evened out by exchanges that leave the nodes tied. */
#include "tortuosity/tie/tube_cords.h"
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "graph/threading/walks.h"
#include "lp/length/balance.h"
#include "lp/length/share.h"
#include "lp/length/share_table.h"
#include "tortuosity/tie/tube.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_plan_options *o;
  const thr_limits *limits;
  thr_share share;
  const thr_tube *shortest; /* of any number of cords that the options allow; closed: one per component */
  int n_components, *component;
  double *length;      /* [n_components] of the shortest */
  int *passes;         /* [n_edges] of the walks at hand */
  thr_walks *walks;    /* [n_components] results */
  double work;         /* that searches for short cords may still do: about a second of linear programmes */
  bool least, certain; /* the passes are the shortest, the longest cord as short as can be: the solver's word */
} several;

static void walks_destroy(thr_walks *walks, int n)
{
  for (int k = 0; walks && k < n; k++)
    thr_walks_destroy(&walks[k]);
}

static void several_destroy(several *x)
{
  walks_destroy(x->walks, x->n_components);
  free(x->walks);
  free(x->component);
  free(x->length);
  free(x->passes);
}

static thr_status several_init(several *x, thr_err *err)
{
  if (!(x->component = thr_calloc((size_t)x->f->n_nodes, sizeof *x->component))) return thr_nomem(err);
  thr_status st = thr_frame_components(x->f, x->component, &x->n_components, err);
  if (st) return st;
  size_t n = (size_t)x->n_components;
  x->length = thr_calloc(n, sizeof *x->length);
  x->walks = thr_calloc(n, sizeof *x->walks);
  x->passes = thr_calloc((size_t)x->f->n_edges, sizeof *x->passes);
  x->share = (thr_share){x->f, x->o, x->component};
  x->least = x->certain = true;
  x->work = 1e8;
  if (!x->length || !x->walks || !x->passes) return thr_nomem(err);
  for (int i = 0; i < x->shortest->n_cords; i++)
    x->length[x->shortest->cord[i].component] += thr_cord_length(x->f, &x->shortest->cord[i]);
  return THR_OK;
}

static bool closed_cords(const several *x)
{
  return x->o->ends == THR_ENDS_CLOSED;
}

static const char *node_of(const several *x, int k)
{
  int v = 0;
  while (x->component[v] != k)
    v++;
  return x->f->name[v];
}

/* ---- a number of cords ---- */

/* The cords as walks, by component: out[n_components], empty before. */
static thr_status walks_of(const several *x, const thr_tube *t, thr_walks *out, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < t->n_cords && !st; i++) {
    const thr_cord *c = &t->cord[i];
    st = thr_walks_copy(&out[c->component], x->f, c->half, c->n_passes, closed_cords(x), err);
  }
  return st;
}

static int walks_in(const thr_tube *t, int k)
{
  int n = 0;
  for (int i = 0; i < t->n_cords; i++)
    n += t->cord[i].component == k;
  return n;
}

/* Is the number of cords in every component of the shortest n? */
static bool has_number(const several *x, int n)
{
  bool all = true;
  for (int k = 0; k < x->n_components; k++)
    all &= walks_in(x->shortest, k) == n;
  return all;
}

/* Short walks: exactly n open ones in every component, or as many as the counts say; of closed ones, one. */
static thr_status short_walks(several *x, int n, thr_walks *out, thr_err *err)
{
  thr_plan_options o = *x->o;
  thr_limits some = *x->limits;
  thr_tube t = {0};
  thr_err why = {0};
  if (closed_cords(x) || o.ends == THR_ENDS_COUNTS || has_number(x, n)) return walks_of(x, x->shortest, out, err);
  o.cords = o.cords_least = n;
  some.work = &x->work;
  thr_status st = x->work > 0 ? thr_tube_shortest(x->f, &o, &some, &t, &why) : thr_tube_some(x->f, &o, x->limits, &t, &why);
  if (st == THR_OK || st == THR_ELIMIT)
    st = walks_of(x, &t, out, err);
  else
    st = thr_fail(err, st, "%s", why.text);
  thr_tube_destroy(&t);
  return st;
}

/* passes are those of the walks of component k. */
static void count_passes(const several *x, int k, const thr_walks *w)
{
  for (int e = 0; e < x->f->n_edges; e++)
    if (x->component[x->f->edge[e][0]] == k) x->passes[e] = 0;
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

/* n closed walks of component k from few. *found false: not so many; certain: there are none. */
static thr_status split(several *x, int k, int n, bool even, thr_walks *w, bool *found, bool *certain, thr_err *err)
{
  double least = x->length[k] * (1 + 1e-12);
  *certain = false;
  thr_status st = thr_share_tied(&x->share, n, even, x->passes, w, found, err);
  if (st || (*found && (even || total(w) <= least))) return st;
  st = thr_share_table(&x->share, k, &(thr_share_ask){n, n, false, INFINITY}, x->limits, w, x->passes, certain, err);
  *found = w->n_walks >= n;
  if (!even) x->least &= *certain;
  return st;
}

static thr_status even_out(several *x, int k, double goal, thr_walks *w, thr_err *err)
{
  bool certain;
  const int n = w->n_walks;
  thr_share_ask ask = {n, n, goal == 0, goal > 0 ? goal : INFINITY};
  thr_status st = thr_balance_walks(&x->share, w, goal, x->limits, x->passes, err);
  if (st || (goal > 0 && within(thr_walks_longest(w), goal))) return st;
  st = thr_share_table(&x->share, k, &ask, x->limits, w, x->passes, &certain, err);
  if (!st) x->certain &= certain;
  return st;
}

/* From short walks n of component k. */
static thr_status make_walks(several *x, int k, int n, bool even, double goal, thr_walks *w, bool *found, bool *certain,
                             thr_err *err)
{
  thr_status st = THR_OK;
  *found = true;
  *certain = false;
  count_passes(x, k, w);
  if (closed_cords(x)) st = split(x, k, n, even, w, found, certain, err);
  return !st && even && *found ? even_out(x, k, goal, w, err) : st;
}

/* All components at once, with n cords each. */
static thr_status make_number(several *x, int n, bool even, thr_err *err)
{
  thr_status st = short_walks(x, n, x->walks, err);
  for (int k = 0; k < x->n_components && !st; k++) {
    bool found, certain;
    st = make_walks(x, k, n, even, 0, &x->walks[k], &found, &certain, err);
    if (!st && !found)
      st = thr_fail(err, THR_EINFEASIBLE, "the component with node %s: %s %d closed cords that tie its joints", node_of(x, k),
                    certain ? "there are no" : "did not find", n);
  }
  return st;
}

/* Of even lengths, as many cords as the shortest are: their number is one that can be. */
static thr_status even_shortest(several *x, thr_err *err)
{
  bool found, certain;
  thr_status st = walks_of(x, x->shortest, x->walks, err);
  for (int k = 0; k < x->n_components && !st; k++)
    st = make_walks(x, k, x->walks[k].n_walks, true, 0, &x->walks[k], &found, &certain, err);
  return st;
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
    walks_destroy(x->walks, x->n_components);
    st = make_number(x, n, true, &why);
  }
  if (st == THR_EINFEASIBLE && !closed_cords(x)) {
    walks_destroy(x->walks, x->n_components);
    st = even_shortest(x, &why);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- no cord longer than a limit ---- */

/* Tries n cords in every component that is not done and may do with so few. */
static thr_status try_number(several *x, int n, bool *done, thr_err *err)
{
  bool found, certain;
  thr_err why = {0};
  thr_walks *new = thr_calloc((size_t)x->n_components, sizeof *new);
  if (!new) return thr_nomem(err);
  thr_status st = short_walks(x, n, new, &why);
  bool none = st == THR_EINFEASIBLE;
  for (int k = 0; k < x->n_components && !st; k++) {
    if (done[k] || total(&new[k]) > fmax(n, new[k].n_walks) * x->o->max_length * (1 + 1e-9)) continue;
    st = make_walks(x, k, n, true, x->o->max_length, &new[k], &found, &certain, &why);
    if (st || !found) continue;
    thr_walks_destroy(&x->walks[k]);
    x->walks[k] = new[k];
    new[k] = (thr_walks){0};
    done[k] = within(thr_walks_longest(&x->walks[k]), x->o->max_length);
  }
  walks_destroy(new, x->n_components);
  free(new);
  return st && !none ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

static thr_status none_found(const several *x, int k, thr_err *err)
{
  const char *units = x->f->units;
  double limit = x->o->max_length;
  if (x->walks[k].n_walks == 0)
    return thr_fail(
        err, THR_EINFEASIBLE,
        "the component with node %s: did not find up to %d cords that tie its joints, none longer than %g %s; together "
        "they need %g %s",
        node_of(x, k), x->o->cords, limit, units, x->length[k], units);
  return thr_fail(
      err, THR_EINFEASIBLE,
      "the component with node %s: did not find up to %d cords that tie its joints, none longer than %g %s, but one of %g "
      "%s",
      node_of(x, k), x->o->cords, limit, units, thr_walks_longest(&x->walks[k]), units);
}

/* A component that is not done; -1: all are. */
static int left_over(const several *x, const bool *done)
{
  for (int k = 0; k < x->n_components; k++)
    if (!done[k]) return k;
  return -1;
}

/* The fewest cords that the shortest length leaves possible, and more, in larger steps after some. */
static thr_status grow(several *x, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int most = x->o->cords;
  double fewest = most;
  bool *done = thr_calloc((size_t)x->n_components, sizeof *done);
  thr_status st = done ? thr_cords_reach(x->f, x->o, err) : thr_nomem(err);
  for (int k = 0; k < x->n_components; k++)
    fewest = fmin(fewest, ceil(x->length[k] / x->o->max_length * (x->shortest->bound / x->shortest->length) * (1 - 1e-9)));
  int n = fewest > x->o->cords_least ? (int)fewest : x->o->cords_least;
  if (x->o->ends == THR_ENDS_COUNTS) n = most;
  for (int tried = 0, step = 1; !st && n <= most && left_over(x, done) >= 0; n += step) {
    st = try_number(x, n, done, err);
    if (++tried > IN_SINGLE_STEPS && n < most) step = 2 * step < most - n ? 2 * step : most - n;
  }
  if (!st && left_over(x, done) >= 0) st = none_found(x, left_over(x, done), err);
  free(done);
  return st;
}

/* ---- the plan ---- */

/* Is more asked for than the shortest length? */
static bool lengths_asked(const thr_plan_options *o)
{
  return thr_wants_balance(o) || o->max_length > 0;
}

static void move_cords(thr_tube *t, thr_plan *plan)
{
  plan->cord = t->cord;
  plan->n_cords = t->n_cords;
  t->cord = NULL;
  t->n_cords = 0;
}

/* One component by itself: it may need more cords than another, or hold fewer. */
static thr_status plan_component(void *user, const thr_components *p, int k, const thr_plan *asked, thr_plan *made, thr_err *err)
{
  several *x = user;
  thr_limits quiet = *x->limits;
  thr_cords_word word = {0};
  thr_err why = {0};
  (void)p;
  (void)k;
  quiet.found = NULL; /* cords of a component are no plan */
  thr_status st = thr_tube_cords_plan(&asked->frame, &asked->options, &quiet, made, &word, &why);
  x->certain &= word.longest_least || made->cords_claim.longest_optimal;
  return st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

static thr_status make_some(several *x, thr_plan *plan, thr_err *err)
{
  const thr_plan_options *o = x->o;
  thr_status st = o->max_length > 0      ? grow(x, err)
                  : thr_wants_balance(o) ? make_even(x, err)
                                         : make_number(x, o->cords_least, false, err);
  return st ? st : thr_walks_plan(x->walks, x->n_components, plan, err);
}

/* The cords of the plan; the shortest themselves where nothing more is asked for. */
static thr_status make_cords(thr_tube *t, const thr_limits *limits, thr_plan *plan, thr_cords_word *word, thr_err *err)
{
  const thr_plan_options *o = &plan->options;
  several x = {.f = &plan->frame, .o = o, .limits = limits, .shortest = t};
  bool many = o->ends == THR_ENDS_CLOSED && o->cords_least > 1;
  if (!many && !lengths_asked(o)) {
    move_cords(t, plan);
    return THR_OK;
  }
  thr_status st = several_init(&x, err);
  if (!st)
    st = lengths_asked(o) && x.n_components > 1 ? thr_components_plan(x.f, o, plan_component, &x, plan, err)
                                                : make_some(&x, plan, err);
  if (!st) *word = (thr_cords_word){x.least && many && !lengths_asked(o), x.certain && thr_wants_balance(o)};
  several_destroy(&x);
  return st;
}

static thr_status prove(thr_tube *t, bool one, thr_plan *plan, thr_err *err)
{
  const thr_frame *f = &plan->frame;
  const thr_plan_options *o = &plan->options;
  thr_status st = thr_plan_measure(f, o, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st) thr_tube_prove(t, plan->metrics.length, &plan->proof);
  if (st || one) return st;
  return thr_check_tied_cords(f, o, plan->cord, plan->n_cords, &plan->proof.tied, &plan->cords_claim, err);
}

thr_status thr_tube_cords_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan,
                               thr_cords_word *word, thr_err *err)
{
  thr_tube t = {0};
  thr_err why = {0};
  thr_cords_word said = {0};
  bool one = o->cords == 1 && o->max_length == 0 && o->ends != THR_ENDS_COUNTS;
  *plan = (thr_plan){0};
  const thr_limits part = lengths_asked(o) ? thr_limits_part(limits, 0.5) : *limits;
  thr_status proved = thr_tube_shortest(f, o, &part, &t, &why);
  if (proved && proved != THR_ELIMIT) return thr_fail(err, proved, "%s", why.text);
  thr_status st = thr_plan_request(plan, f, o, err);
  if (!st) st = make_cords(&t, limits, plan, &said, err);
  if (!st) st = prove(&t, one, plan, err);
  thr_tube_destroy(&t);
  if (word) *word = said;
  if (!st) return thr_cords_judge(plan, &(thr_err){0}, err);
  thr_plan_destroy(plan);
  return st;
}

thr_status thr_tube_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  return thr_tube_cords_plan(f, o, limits, plan, NULL, err);
}
