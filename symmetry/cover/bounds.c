/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds the overlap, the steps and the paths of symmetric covers from below, by a minimum T-join
 * (symmetry/cover/start.c) or by counting.
 *
 * Overlap: a symmetric cover is a cover, so the bound for the identity's programme holds as well.
 * Steps, and paths, of covers whose overlap is known: one T-join bounds the sum of overlap and a
 * small multiple of the aim. Paths: every orbit of components needs one. Bounds only grow: each
 * becomes the larger of what it was and what is proved here, in the aim's unit. Limits weaken them.
 *
 * Example: nine edge orbits need nine steps at least. */
#include "symmetry/cover/cover_parts.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_TYPES = 500000 }; /* of the quotient by the identity */

/* Bounds the overlap, or the overlap and a tie together (thr_contraction_bound), of the covers of a
 * programme. *weight: of the tie in the sum. */
static thr_status bound_by_join(const thr_programme *programme, thr_aim tie,
                                const thr_limits *limits, double *bound, double *weight,
                                thr_err *err)
{
  thr_contraction contraction;
  thr_status st = thr_contraction_init(&contraction, programme, true, err);
  if (st) return st;
  *weight = thr_contraction_tie(&contraction, tie);
  st = thr_contraction_bound(&contraction, tie, limits, bound, err);
  thr_contraction_destroy(&contraction);
  return st;
}

/* Raises a bound to what is proved, rounded up to a value that a cover can have. */
static void raise_bound(const thr_programme *programme, thr_aim aim, double proved, double *bound)
{
  *bound = fmax(*bound, thr_programme_round(programme, aim, proved));
}

thr_status thr_bounds_overlap(const thr_programme *programme, const thr_limits *limits,
                              double *bound, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  int identity = 0;
  const thr_subgroup alone = {1, &identity};
  double proved, weight;
  thr_quotient whole_quotient;
  thr_programme whole = {0};
  thr_status st = bound_by_join(programme, THR_AIM_OVERLAP, limits, &proved, &weight, err);

  /* Under the group. */
  if (!st) raise_bound(programme, THR_AIM_OVERLAP, proved, bound);
  if (st || quotient->h->order == 1) return st;

  /* Without symmetry, if that is not too large. */
  st = thr_quotient_make(&whole_quotient, quotient->f, quotient->group, &alone, MOST_TYPES, limits,
                         &(thr_err){0});
  if (st == THR_ELIMIT) return THR_OK;
  if (st) return thr_nomem(err);

  if (!st) st = thr_programme_init(&whole, &whole_quotient, programme->o, err);
  if (!st) st = bound_by_join(&whole, THR_AIM_OVERLAP, limits, &proved, &weight, err);
  if (!st) raise_bound(programme, THR_AIM_OVERLAP, proved, bound);

  thr_programme_destroy(&whole);
  thr_quotient_destroy(&whole_quotient);
  return st;
}

thr_status thr_bounds_tie(const thr_programme *programme, thr_aim tie, double overlap,
                          const thr_limits *limits, double *bound, thr_err *err)
{
  double proved, weight;
  thr_status st = bound_by_join(programme, tie, limits, &proved, &weight, err);
  if (!st) raise_bound(programme, tie, (proved - overlap) / weight, bound);
  return st;
}

thr_status thr_bounds_paths(const thr_programme *programme, double *bound, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  int n_nodes = quotient->f->n_nodes, count = 0, orbits = 0,
      *component = thr_calloc((size_t)n_nodes, sizeof *component);
  int *parent = thr_calloc((size_t)n_nodes, sizeof *parent);
  thr_status st = component && parent ? thr_frame_components(quotient->f, component, &count, err)
                                      : thr_nomem(err);

  /* Components that elements map to each other. */
  for (int c = 0; c < count && !st; c++)
    parent[c] = c;
  for (int i = 0; i < quotient->h->order && !st; i++)
    for (int v = 0; v < n_nodes; v++)
      thr_disjoint_join(
          parent, component[v],
          component[quotient->group
                        ->image[(size_t)quotient->h->element[i] * (size_t)n_nodes + (size_t)v]]);

  /* Every orbit has a root. */
  for (int c = 0; c < count && !st; c++)
    orbits += parent[c] == c;
  if (!st) raise_bound(programme, THR_AIM_PATHS, orbits, bound);

  free(component);
  free(parent);
  return st;
}
