/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Replaces walks by the best cords of a small framework, which are computed exactly by a dynamic
 * programme over subsets (graph/threading/small_cords.c).
 *
 * Example: of a ring of six edges of length 1, two open cords become two walks of three passes. */
#include "lp/length/postman.h"

#include <string.h>

/* Makes the cords, whose half-edges are moved, the walks, and counts their passes. */
static thr_status take(thr_decomposition *decomposition, thr_small_cords *cords, thr_err *err)
{
  const thr_frame *frame = decomposition->f;
  thr_walks new = {0};
  thr_status st = THR_OK;

  /* The walks get their lengths as they are added. */
  for (int i = 0; i < cords->n && !st; i++) {
    thr_walk walk = {cords->n_passes[i], cords->half[i], 0,
                     decomposition->o->ends == THR_ENDS_CLOSED};
    cords->half[i] = NULL;
    st = thr_walks_add(&new, frame, walk, err);
  }

  /* On failure the walks stay. */
  if (st) {
    thr_walks_destroy(&new);
    return st;
  }

  thr_walks_destroy(&decomposition->walks);
  decomposition->walks = new;
  memset(decomposition->passes, 0, (size_t)frame->n_edges * sizeof *decomposition->passes);
  thr_walks_count(&new, decomposition->passes);
  return THR_OK;
}

thr_status thr_decomposition_table(thr_decomposition *decomposition,
                                   const thr_decomposition_ask *ask, bool *certain, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_small_cords cords;
  const thr_small_ask all = {ask->least,
                             ask->most,
                             false,
                             ask->even,
                             ask->limit,
                             walks->n_walks,
                             thr_walks_most(walks),
                             thr_walks_length(walks)};

  /* The walks at hand are the known cords, which must be beaten. */
  thr_status st = thr_small_cords_find(decomposition->f, decomposition->o, &all,
                                       decomposition->limits, &cords, certain, err);
  if (!st && cords.n > 0) st = take(decomposition, &cords, err);
  thr_small_cords_destroy(&cords);
  return st;
}
