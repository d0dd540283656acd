/* Cords of the table as walks. */
#include "graph/threading/walks.h"
#include "lp/length/share_table.h"
#include "graph/framework/frame.h"
#include "graph/threading/small_cords.h"

#include <stdlib.h>
#include <string.h>

/* The half-edges are moved. */
static thr_status take(thr_share *share, thr_small_cords *cords, thr_err *err)
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
  thr_walks_destroy(&share->walks);
  share->walks = new;
  memset(share->passes, 0, (size_t)frame->n_edges * sizeof *share->passes);
  thr_walks_count(&new, share->passes);
  return THR_OK;
}

thr_status thr_share_table(thr_share *share, const thr_share_ask *ask, bool *certain, thr_err *err)
{
  const thr_walks *walks = &share->walks;
  thr_small_cords cords;
  const thr_small_ask all = {
      ask->least, ask->most, false, ask->even, ask->limit, walks->n_walks, thr_walks_most(walks), thr_walks_length(walks)};
  thr_status st = thr_small_cords_find(share->f, share->o, &all, share->limits, &cords, certain, err);
  if (!st && cords.n > 0) st = take(share, &cords, err);
  thr_small_cords_destroy(&cords);
  return st;
}
