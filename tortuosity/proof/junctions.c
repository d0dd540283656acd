/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finding divisions of the edges at a node that a point does not tie. */
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ENUMERATED = 7 }; /* edges at a node whose divisions are all looked at: 877 of 7 */

/* The edges of one node, and how much a point turns between them. */
typedef struct {
  int d;
  const double *between; /* [d * d], above the diagonal */
  int *block, *worst, *parent;
  int worst_blocks;
  double violation;
} star;

/* The division in block, into n parts of which crossing turns join different ones. */
static void judge(star *s, int n, double crossing)
{
  double violation = n - 1 - crossing;
  if (violation <= s->violation + 1e-9) return;
  s->violation = violation;
  s->worst_blocks = n;
  memcpy(s->worst, s->block, (size_t)s->d * sizeof *s->worst);
}

/* All divisions that go on from the first k edges in n parts. */
static void divide(star *s, int k, int n, double crossing)
{
  if (k == s->d) {
    judge(s, n, crossing);
    return;
  }
  for (int b = 0; b <= n; b++) {
    double more = 0;
    for (int i = 0; i < k; i++)
      if (s->block[i] != b) more += s->between[i * s->d + k];
    s->block[k] = b;
    divide(s, k + 1, b == n ? n + 1 : n, crossing + more);
  }
}

/* The parts that turns of more than threshold connect. */
static void judge_parts(star *s, double threshold)
{
  double crossing = 0;
  for (int i = 0; i < s->d; i++)
    s->parent[i] = i;
  for (int i = 0; i < s->d; i++)
    for (int k = i + 1; k < s->d; k++)
      if (s->between[i * s->d + k] > threshold) thr_disjoint_join(s->parent, i, k);
  int n = thr_disjoint_number(s->parent, s->d, s->block);
  for (int i = 0; i < s->d; i++)
    for (int k = 0; k < i; k++)
      if (s->block[k] != s->block[i]) crossing += s->between[k * s->d + i];
  judge(s, n, crossing);
}

/* Of the divisions of d edges into blocks the one with the fewest turns between blocks for its
 * number of them: between[i * d + k], i < k, turns between edges i and k. block[d] and *n_blocks
 * receive it; *n_blocks is 0 if none is violated. For up to 7 edges all divisions, 877 at most; for
 * more those into parts that hang together. */
static thr_status find_worst(int d, const double *between, int *block, int *n_blocks, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.2,  0.35,    0.51,
                                     0.7,  0.99, INFINITY}; /* the last: single edges */
  thr_scratch own = {0};
  star s = {.d = d, .between = between, .worst = block, .violation = 1e-6};
  s.block = thr_scratch_array(&own, (size_t)d, sizeof *s.block);
  s.parent = thr_scratch_array(&own, (size_t)d, sizeof *s.parent);
  thr_status st = thr_scratch_check(&own, err);
  if (!st && d <= ENUMERATED) divide(&s, 0, 0, 0);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && d > ENUMERATED && !st; i++)
    judge_parts(&s, threshold[i]);
  *n_blocks = s.worst_blocks;
  thr_scratch_free(&own);
  return st;
}

/* Adds the row of a node's blocks, 0 .. n - 1, if x violates it. */
static thr_status add_junction(thr_relax *relax, int v, int *block, int n, int *added, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  const int *half = turning_columns->f->half + turning_columns->f->first[v],
            d = thr_degree(turning_columns->f, v);
  for (int a = 0; a < d; a++)
    for (int b = a + 1; b < d; b++)
      if (block[a] != block[b])
        thr_pool_put(&relax->search.pool, thr_turning_column(turning_columns, half[a], half[b]), 1);
  const thr_row row = {
      .kind = THR_RELAX_JUNCTION, .index = v, .lower = n - 1, .member = block, .n_members = d};
  return thr_pool_offer(&relax->search.pool, row, relax->x, 1e-6, added, err);
}

thr_status thr_junctions_separate(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  const size_t most = (size_t)thr_frame_largest_degree(frame);
  double *between = thr_calloc(most * most, sizeof *between);
  int *block = thr_calloc(most, sizeof *block);
  thr_status st = between && block ? THR_OK : thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int d = thr_degree(frame, v), blocks = 0;
    for (int i = 0; i < d; i++)
      for (int k = i + 1; k < d; k++)
        between[i * d + k] = relax->x[thr_turning_column(
            turning_columns, frame->half[frame->first[v] + i], frame->half[frame->first[v] + k])];
    if (d > 1) st = find_worst(d, between, block, &blocks, err);
    if (!st && blocks > 1) st = add_junction(relax, v, block, blocks, added, err);
  }
  free(between);
  free(block);
  return st;
}
