/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a multigraph of the passes of a plan: one copy of an edge per pass, plus a virtual edge
 * between each two cord ends, so that every degree is even and a threading is a set of closed
 * circuits.
 *
 * Example: an edge of two passes and one cord end at each of its nodes gives three copies, 0 and 1
 * along the edge and 2 virtual, with the darts 0 .. 5. */
#include "graph/threading/threading.h"

#include <limits.h>
#include <stdlib.h>

/* Appends the two darts of a copy between nodes a and b. half: the half-edge from a to b, or -1 for
 * a virtual edge. */
static void add_copy(thr_multigraph *multigraph, int *n, int half, int a, int b)
{
  multigraph->half[*n] = half;
  multigraph->tail[(*n)++] = a;
  multigraph->half[*n] = half < 0 ? -1 : half ^ 1;
  multigraph->tail[(*n)++] = b;
}

thr_status thr_multigraph_init(thr_multigraph *multigraph, const thr_frame *frame, int n_more,
                               const int *passes, const int (*end)[2], int n_ends, thr_err *err)
{
  *multigraph = (thr_multigraph){0};

  int64_t copies = n_ends;
  for (int e = 0; e < frame->n_edges; e++)
    copies += passes[e];

  if (copies > INT_MAX / 4)
    return thr_fail(err, THR_EINPUT, "more than %d passes; use a smaller --cover", INT_MAX / 4);

  size_t n_darts = 2 * (size_t)copies;
  thr_multigraph made = {.n_darts = (int)n_darts, .n_nodes = frame->n_nodes + n_more};
  made.half = thr_calloc(n_darts, sizeof *made.half);
  made.tail = thr_calloc(n_darts, sizeof *made.tail);
  made.dart = thr_calloc(n_darts, sizeof *made.dart);
  made.first = thr_calloc((size_t)made.n_nodes + 2, sizeof *made.first);
  if (!made.half || !made.tail || !made.dart || !made.first) {
    thr_multigraph_destroy(&made);
    return thr_nomem(err);
  }

  /* Copies of one edge are consecutive; virtual edges come last. */
  int n = 0;
  for (int e = 0; e < frame->n_edges; e++)
    for (int k = 0; k < passes[e]; k++)
      add_copy(&made, &n, 2 * e, frame->edge[e][0], frame->edge[e][1]);
  for (int i = 0; i < n_ends; i++)
    add_copy(&made, &n, -1, end[i][0], end[i][1]);

  /* Counting sort by tail; the array is shifted by one place so that filling leaves first[] right.
   */
  for (int d = 0; d < n; d++)
    made.first[made.tail[d] + 2]++;
  for (int v = 1; v <= made.n_nodes; v++)
    made.first[v + 1] += made.first[v];
  for (int d = 0; d < n; d++)
    made.dart[made.first[made.tail[d] + 1]++] = d;

  *multigraph = made;
  return THR_OK;
}

void thr_multigraph_destroy(thr_multigraph *multigraph)
{
  free(multigraph->half);
  free(multigraph->tail);
  free(multigraph->first);
  free(multigraph->dart);
  *multigraph = (thr_multigraph){0};
}
