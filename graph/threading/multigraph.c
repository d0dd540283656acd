/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The passes of a plan as a multigraph: one copy of an edge per pass, plus a virtual edge between
 * each two cord ends, so that every degree is even and a threading is a set of closed circuits. */
#include "graph/threading/euler.h"

#include <limits.h>
#include <stdlib.h>

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
  thr_multigraph m = {.n_darts = (int)n_darts, .n_nodes = frame->n_nodes + n_more};
  m.half = thr_calloc(n_darts, sizeof *m.half);
  m.tail = thr_calloc(n_darts, sizeof *m.tail);
  m.dart = thr_calloc(n_darts, sizeof *m.dart);
  m.first = thr_calloc((size_t)m.n_nodes + 2, sizeof *m.first);
  if (!m.half || !m.tail || !m.dart || !m.first) {
    thr_multigraph_destroy(&m);
    return thr_nomem(err);
  }
  int n = 0;
  for (int e = 0; e < frame->n_edges; e++)
    for (int k = 0; k < passes[e]; k++)
      add_copy(&m, &n, 2 * e, frame->edge[e][0], frame->edge[e][1]);
  for (int i = 0; i < n_ends; i++)
    add_copy(&m, &n, -1, end[i][0], end[i][1]);
  /* Counting sort by tail; the array is shifted by one place so that filling leaves first[] right.
   */
  for (int d = 0; d < n; d++)
    m.first[m.tail[d] + 2]++;
  for (int v = 1; v <= m.n_nodes; v++)
    m.first[v + 1] += m.first[v];
  for (int d = 0; d < n; d++)
    m.dart[m.first[m.tail[d] + 1]++] = d;
  *multigraph = m;
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
