/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how far pieces can shift where their bores are wider than the cord (thesis, Fig. 14).
 *
 * Two bores that a cord goes through may be askew by bore - cord at the gap between them, in any
 * direction across the cord. In a row of pieces this adds up from gap to gap. In a framework every
 * row of gaps from a foot to a piece limits the shift of the piece, so the shortest row counts:
 * breadth-first search from all feet.
 *
 * Example: 10 pieces out from a wall, cord 1 mm in bores of 1.5 mm: the last one may hang 5 mm
 * low. */
#include "graph/plan/physics.h"

#include "graph/arrays.h"

/* Measures, for every piece, the fewest gaps to a foot by breadth-first search; the shift is at
 * most gaps x (bore - cord diameter), in mm. */
thr_status thr_play_find(const thr_frame *frame, const thr_physics *physics, thr_play *out,
                         thr_err *err)
{
  thr_scratch own = {0};
  const size_t nodes = (size_t)frame->n_nodes;
  int *queue = thr_scratch_array(&own, nodes, sizeof *queue),
      *distance = thr_scratch_array(&own, nodes, sizeof *distance), n = 0;
  bool *foot = thr_scratch_array(&own, nodes, sizeof *foot);
  thr_status st = thr_scratch_check(&own, err);
  *out = (thr_play){.gap = physics->bore - physics->cord_diameter, .piece = -1};

  /* All feet are at distance 0, other nodes not reached. */
  if (!st) thr_frame_standing(frame, foot);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    distance[v] = foot[v] ? 0 : -1;
    if (foot[v]) queue[n++] = v;
  }

  /* Breadth-first search: nodes leave the queue in the order of their distance. */
  for (int i = 0; i < n; i++)
    for (int k = frame->first[queue[i]]; k < frame->first[queue[i] + 1]; k++) {
      const int v = thr_head(frame, frame->half[k]);
      if (distance[v] >= 0) continue;
      distance[v] = distance[queue[i]] + 1;
      queue[n++] = v;
    }

  /* The piece that is farthest from all feet; the first one of several. */
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (distance[v] >= 0 && (out->piece < 0 || distance[v] > out->gaps)) {
      out->piece = v;
      out->gaps = distance[v];
    }

  out->most = out->gaps * out->gap;
  thr_scratch_free(&own);
  return st;
}
