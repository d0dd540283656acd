/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least length with tube joints: one cord or several, of limited or even lengths. The shortest
 * tied passes (tortuosity/tie/tube.c) are cut into cords at no cost where they may end; exchanges
 * that leave every node tied then even them out.
 *
 * The shortest tied cords, then as many as asked for, evened out by exchanges that leave the nodes
 * tied. */
#include "tortuosity/tie/tie.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_decomposition s;
  const thr_tube *shortest; /* of any number of cords that the options allow; closed: one */
  double work; /* that searches for short cords may still do: about a second of linear programmes */
} several;

static bool closed_cords(const several *x)
{
  return x->s.o->ends == THR_ENDS_CLOSED;
}

/* ---- a number of cords ---- */

/* The cords as the walks. */
static thr_status take_cords(several *x, const thr_tube *tube, thr_err *err)
{
  thr_status st = THR_OK;
  thr_walks_destroy(&x->s.walks);
  for (int i = 0; i < tube->n_cords && !st; i++)
    st = thr_walks_copy(&x->s.walks, x->s.f, tube->cord[i].half, tube->cord[i].n_passes,
                        closed_cords(x), err);
  memset(x->s.passes, 0, (size_t)x->s.f->n_edges * sizeof *x->s.passes);
  thr_walks_count(&x->s.walks, x->s.passes);
  return st;
}

/* Short walks: exactly n open ones, or as many as the counts say; of closed ones, one. */
static thr_status short_walks(several *x, int n, thr_err *err)
{
  thr_request options = *x->s.o;
  const thr_limits some = thr_limits_counted(x->s.limits, &x->work);
  thr_tube tube = {0};
  thr_err why = {0};
  if (closed_cords(x) || options.ends == THR_ENDS_COUNTS || x->shortest->n_cords == n)
    return take_cords(x, x->shortest, err);
  options.cords = options.cords_least = n;
  thr_status st = x->work > 0 ? thr_tube_shortest(x->s.f, &options, &some, &tube, &why)
                              : thr_tube_some(x->s.f, &options, x->s.limits, &tube, &why);
  if (st == THR_OK || st == THR_ELIMIT)
    st = take_cords(x, &tube, err);
  else
    st = thr_fail(err, st, "%s", why.text);
  thr_tube_destroy(&tube);
  return st;
}

/* n closed walks from few. *found false: not so many; certain: there are none. */
static thr_status split(several *x, int n, bool even, bool *found, bool *certain, thr_err *err)
{
  double least = x->shortest->length * (1 + 1e-12);
  *certain = false;
  thr_status st = thr_decomposition_tied(&x->s, n, even, found, err);
  if (st || (*found && (even || thr_walks_length(&x->s.walks) <= least))) return st;
  st =
      thr_decomposition_table(&x->s, &(thr_decomposition_ask){n, n, false, INFINITY}, certain, err);
  *found = x->s.walks.n_walks >= n;
  if (!even) x->s.least &= *certain;
  return st;
}

/* From short walks n. */
static thr_status make_walks(several *x, int n, bool even, double goal, bool *found, bool *certain,
                             thr_err *err)
{
  thr_status st = THR_OK;
  *found = true;
  *certain = false;
  if (closed_cords(x)) st = split(x, n, even, found, certain, err);
  return !st && even && *found ? thr_decomposition_even(&x->s, goal, err) : st;
}

static thr_status make_number(several *x, int n, bool even, thr_err *err)
{
  bool found = false, certain = false;
  thr_status st = short_walks(x, n, err);
  if (!st) st = make_walks(x, n, even, 0, &found, &certain, err);
  if (st || found) return st;
  return thr_fail(err, certain ? THR_EINFEASIBLE : THR_ELIMIT,
                  "the component with node %s: %s %d closed cords that tie its joints",
                  x->s.f->name[0], certain ? "there are no" : "did not find", n);
}

/* Of even lengths, as many cords as the shortest are: their number is one that can be. */
static thr_status even_shortest(several *x, thr_err *err)
{
  bool found, certain;
  thr_status st = take_cords(x, x->shortest, err);
  return st ? st : make_walks(x, x->s.walks.n_walks, true, 0, &found, &certain, err);
}

/* Of even lengths: as many cords as there may be. */
static thr_status make_even(several *x, thr_err *err)
{
  enum { IN_SINGLE_STEPS = 12 };
  const int least = x->s.o->cords_least;
  thr_err why = {0};
  bool none = true;
  thr_status st = THR_OK;
  for (int n = x->s.o->cords; n >= least && none;
       n = n > 2 * least && n > IN_SINGLE_STEPS ? n / 2 : n - 1) {
    why = (thr_err){0};
    x->s.least = x->s.certain = true;
    st = make_number(x, n, true, &why);
    none = st == THR_EINFEASIBLE || st == THR_ELIMIT;
  }
  if (none && !closed_cords(x)) st = even_shortest(x, &why);
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- no cord longer than a limit ---- */

/* Tries n cords, if so few may do. Where there are none the walks stay as they were. */
static thr_status try_number(thr_decomposition *decomposition, void *of, int n, bool *done,
                             thr_err *err)
{
  several *x = of;
  bool found = false, certain;
  thr_err why = {0};
  thr_walks before = decomposition->walks;
  decomposition->walks = (thr_walks){0};
  thr_status st = short_walks(x, n, &why);
  bool none = st == THR_EINFEASIBLE;
  if (!st && thr_walks_length(&decomposition->walks) <=
                 fmax(n, decomposition->walks.n_walks) * decomposition->o->max_length * (1 + 1e-9))
    st = make_walks(x, n, true, decomposition->o->max_length, &found, &certain, &why);
  if (st || !found) {
    thr_walks new = decomposition->walks;
    decomposition->walks = before;
    before = new;
  } else
    *done = thr_decomposition_within(thr_walks_most(&decomposition->walks),
                                     decomposition->o->max_length);
  thr_walks_destroy(&before);
  return st && !none ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

static thr_status none_found(const several *x, thr_err *err)
{
  const char *units = x->s.f->units, *name = x->s.f->name[0];
  double limit = x->s.o->max_length;
  bool proved = x->shortest->bound > x->s.o->cords * limit * (1 + 1e-9) || x->s.none;
  if (proved)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s: of up to %d cords that tie its joints one is "
                    "longer than %g %s; together they need %g %s",
                    name, x->s.o->cords, limit, units, x->shortest->bound, units);
  if (x->s.walks.n_walks == 0)
    return thr_fail(err, THR_ELIMIT,
                    "the component with node %s: did not find up to %d cords that tie its joints, "
                    "none longer than %g %s; together "
                    "they need %g %s",
                    name, x->s.o->cords, limit, units, x->shortest->length, units);
  return thr_fail(err, THR_ELIMIT,
                  "the component with node %s: did not find up to %d cords that tie its joints, "
                  "none longer than %g %s, but one of %g "
                  "%s",
                  name, x->s.o->cords, limit, units, thr_walks_most(&x->s.walks), units);
}

/* The fewest cords that the shortest length leaves possible, and more. */
static thr_status grow(several *x, thr_err *err)
{
  bool done = false;
  thr_status st = thr_cords_grow(&x->s, x->shortest->bound, try_number, x, &done, err);
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
  const thr_request *options = x->s.o;
  thr_status st = options->max_length > 0      ? grow(x, err)
                  : thr_wants_balance(options) ? make_even(x, err)
                                               : make_number(x, options->cords_least, false, err);
  return st ? st
            : thr_walks_cords(&x->s.walks, &plan->frame, options, &plan->cord, &plan->n_cords, err);
}

thr_status thr_tube_cords(thr_tube *tube, const thr_limits *limits, thr_plan *plan,
                          thr_cords_word *word, thr_err *err)
{
  const thr_request *options = &plan->options;
  several x = {.shortest = tube, .work = 1};
  *word = (thr_cords_word){0};
  if (!thr_tube_shares(options)) {
    move_cords(tube, plan);
    return THR_OK;
  }
  thr_status st = thr_decomposition_init(&x.s, &plan->frame, options, limits, err);
  if (!st) st = make_some(&x, plan, err);
  if (!st)
    *word = (thr_cords_word){x.s.least && !lengths_asked(options),
                             x.s.certain && thr_wants_balance(options)};
  thr_decomposition_destroy(&x.s);
  return st;
}
