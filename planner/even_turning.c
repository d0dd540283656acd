/* A second start for the cord that turns most: symmetric cords turn alike. */
#include "planner/even_turning.h"
#include "graph/plan/junction.h"
#include "planner/dispatch.h"
#include "symmetry/symmetry.h"
#include "tortuosity/cords/maxturn.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_status thr_even_seed(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *seed, thr_err *err)
{
  thr_symmetries s;
  thr_plan_options so = *o;
  thr_err why = {0};
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_SEED);
  so.symmetry = thr_plan_options_default().symmetry;
  so.aims = thr_aims_symmetric;
  thr_status st = thr_symmetries_find(f, &so, &share, &s, &why);
  int row = st && st != THR_ELIMIT ? -1 : thr_symmetries_even(&s, o->cords);
  if (row >= 0) st = thr_symmetries_plan(&s, row, f, &so, &share, seed, &why);
  thr_symmetries_destroy(&s);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves no seed */
}

/* Are they cords of the task: as many in every component as l has, over passes and ends that it allows? Given numbers of ends no
 * other objective's plan keeps to. */
static thr_status seed_fits(const thr_frame *f, const thr_least *l, const thr_plan *seed, bool *fits, thr_err *err)
{
  int *count = thr_calloc((size_t)f->n_nodes, sizeof *count); /* cords of a component: l's less the seed's */
  bool *tied = thr_calloc((size_t)f->n_nodes, sizeof *tied), open = l->end_allowed != NULL;
  thr_status st = count && tied ? THR_OK : thr_nomem(err);
  double length = 0;
  *fits = !l->task.end_count && seed->n_cords == l->n_cords && seed->frame.n_nodes == f->n_nodes &&
          seed->options.cover == l->task.cover && seed->metrics.most_passes <= l->task.most_passes;
  if (!st && *fits) st = thr_junction_tied(f, seed->cord, seed->n_cords, !open, tied, err);
  *fits &= !st;
  for (int i = 0; *fits && i < l->n_cords; i++) {
    const thr_cord *c = &seed->cord[i];
    count[l->cord[i].component]++;
    count[c->component]--;
    length += thr_cord_length(f, c);
    *fits = open ? l->end_allowed[thr_cord_start(f, c)] && l->end_allowed[thr_cord_end(f, c)] : c->closed;
    for (int k = 0; k + 1 < c->n_passes && *fits; k++) /* the search never turns back where it need not */
      *fits = c->half[k + 1] != (c->half[k] ^ 1) || (thr_degree(f, thr_head(f, c->half[k])) == 1 && !l->task.tube);
  }
  for (int v = 0; v < f->n_nodes && *fits; v++)
    *fits = count[v] == 0 && (tied[v] || !l->task.tube);
  *fits &= l->length_limit < 0 || length <= l->length_limit * (1 + 1e-12);
  free(count);
  free(tied);
  return st;
}

static thr_status copy_cords(const thr_cord *from, int n, thr_cord **to, thr_err *err)
{
  if (!(*to = thr_calloc((size_t)n, sizeof **to))) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    (*to)[i] = from[i];
    if (!((*to)[i].half = thr_calloc((size_t)from[i].n_passes, sizeof *from[i].half))) return thr_nomem(err);
    memcpy((*to)[i].half, from[i].half, (size_t)from[i].n_passes * sizeof *from[i].half);
  }
  return THR_OK;
}

thr_status thr_even_turning(const thr_frame *f, const thr_plan *seed, const thr_limits *limits, thr_least *l, thr_err *err)
{
  bool fits = false;
  thr_max_turning own = {.largest = INFINITY}, other = own;
  thr_least from = *l; /* with the seed's cords; all else stays l's */
  from.cord = NULL;
  thr_status st = seed ? seed_fits(f, l, seed, &fits, err) : THR_OK;
  if (!st && fits) {
    const thr_limits share = thr_dispatch_share(limits, THR_STEP_EVEN_SEED);
    st = copy_cords(seed->cord, seed->n_cords, &from.cord, err);
    if (!st) st = thr_max_turning_improve(f, &share, &from, &other, err);
  }
  if (!st && !(other.largest <= other.bound * (1 + 1e-9))) st = thr_max_turning_improve(f, limits, l, &own, err);
  if (!st && other.largest < own.largest) {
    thr_cord *cord = l->cord;
    *l = from;
    from.cord = cord;
  }
  thr_cords_destroy(from.cord, l->n_cords);
  return st;
}
