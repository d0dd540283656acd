/* Cords of the table as walks. */
#include "lp/length/share_table.h"
#include "graph/framework/frame.h"
#include "graph/threading/small_cords.h"

#include <stdlib.h>

static double total(const thr_walks *walks)
{
  double sum = 0;
  for (int i = 0; i < walks->n_walks; i++)
    sum += walks->walk[i].length;
  return sum;
}

/* The half-edges are moved. */
static thr_status take(const thr_share *share, int k, thr_small_cords *cords, thr_walks *walks, int *passes, thr_err *err)
{
  const thr_frame *frame = share->f;
  thr_walks new = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < cords->n && !st; i++) {
    thr_walk walk = {cords->n_passes[i], cords->half[i], 0, share->o->ends == THR_ENDS_CLOSED};
    cords->half[i] = NULL;
    st = thr_walks_add(&new, frame, walk, err);
  }
  if (st) {
    thr_walks_destroy(&new);
    return st;
  }
  for (int e = 0; e < frame->n_edges; e++)
    if (share->component[frame->edge[e][0]] == k) passes[e] = 0;
  thr_walks_count(&new, passes);
  thr_walks_destroy(walks);
  *walks = new;
  return THR_OK;
}

thr_status thr_share_table(const thr_share *share, int k, const thr_share_ask *ask, const thr_limits *limits, thr_walks *walks,
                           int *passes, bool *certain, thr_err *err)
{
  thr_small_cords cords;
  const thr_small_ask all = {ask->least,  ask->most, false, ask->even, ask->limit, walks->n_walks, thr_walks_longest(walks),
                             total(walks)};
  thr_status st = thr_small_cords_find(share->f, share->o, share->component, k, &all, limits, &cords, certain, err);
  if (!st && cords.n > 0) st = take(share, k, &cords, walks, passes, err);
  thr_small_cords_destroy(&cords);
  return st;
}
