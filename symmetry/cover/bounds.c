/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What no symmetric cover is better than, by one minimum T-join (symmetry/cover/start.c) or by
 * counting. Internal.
 *
 * Overlap: a symmetric cover is a cover, so it has no less than the shortest. Steps: every edge
 * orbit needs at least one pass of a unique path. Bounds only grow: each is the larger of what it
 * was and what is proved here, in the aim's unit. Limits weaken them.
 *
 * Example: nine edge orbits need nine steps at least. */
#include "symmetry/cover/cover_parts.h"
#include "graph/disjoint.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

enum { MOST_TYPES = 500000 }; /* of the framework without symmetry */

/* Of overlap, or of overlap and a tie together (thr_contraction_bound): of the covers under these
 * types. */
static thr_status by_join(const thr_programme *p, thr_aim tie, const thr_limits *limits,
                          double *bound, double *weight, thr_err *err)
{
  thr_contraction contraction;
  thr_status st = thr_contraction_init(&contraction, p, true, err);
  if (st) return st;
  *weight = thr_contraction_tie(&contraction, tie);
  st = thr_contraction_bound(&contraction, tie, limits, bound, err);
  thr_contraction_destroy(&contraction);
  return st;
}

static void raise_bound(const thr_programme *p, thr_aim aim, double proved, double *bound)
{
  *bound = fmax(*bound, thr_programme_round(p, aim, proved));
}

thr_status thr_bounds_overlap(const thr_programme *p, const thr_limits *limits, double *bound,
                              thr_err *err)
{
  const thr_quotient *quotient = p->q;
  int identity = 0;
  const thr_subgroup alone = {1, &identity};
  double proved, weight;
  thr_quotient all;
  thr_programme any = {0};
  thr_status st = by_join(p, THR_AIM_OVERLAP, limits, &proved, &weight, err);
  if (!st) raise_bound(p, THR_AIM_OVERLAP, proved, bound);
  if (st || quotient->h->order == 1) return st;
  st = thr_quotient_make(&all, quotient->f, quotient->group, &alone, MOST_TYPES, limits,
                         &(thr_err){0});
  if (st == THR_ELIMIT) return THR_OK; /* then the join under the group is all that is known */
  if (st) return thr_nomem(err);
  if (!st) st = thr_programme_init(&any, &all, p->o, err);
  if (!st) st = by_join(&any, THR_AIM_OVERLAP, limits, &proved, &weight, err);
  if (!st) raise_bound(p, THR_AIM_OVERLAP, proved, bound);
  thr_programme_destroy(&any);
  thr_quotient_destroy(&all);
  return st;
}

thr_status thr_bounds_tie(const thr_programme *p, thr_aim tie, double overlap,
                          const thr_limits *limits, double *bound, thr_err *err)
{
  double proved, weight;
  thr_status st = by_join(p, tie, limits, &proved, &weight, err);
  if (!st) raise_bound(p, tie, (proved - overlap) / weight, bound);
  return st;
}

thr_status thr_bounds_paths(const thr_programme *p, double *bound, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  int n = quotient->f->n_nodes, count = 0, orbits = 0,
      *component = thr_calloc((size_t)n, sizeof *component);
  int *set = thr_calloc((size_t)n, sizeof *set);
  thr_status st =
      component && set ? thr_frame_components(quotient->f, component, &count, err) : thr_nomem(err);
  for (int c = 0; c < count && !st; c++)
    set[c] = c;
  for (int i = 0; i < quotient->h->order && !st; i++)
    for (int v = 0; v < n; v++)
      thr_disjoint_join(
          set, component[v],
          component[quotient->group
                        ->image[(size_t)quotient->h->element[i] * (size_t)n + (size_t)v]]);
  for (int c = 0; c < count && !st; c++)
    orbits += set[c] == c;
  if (!st) raise_bound(p, THR_AIM_PATHS, orbits, bound);
  free(component);
  free(set);
  return st;
}
