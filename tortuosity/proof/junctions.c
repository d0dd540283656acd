/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates junction rows, which tube joints need: at every node the edges must be tied.
 *
 * Row of a division of a node's edges into b blocks: at least b - 1 turns go between
 * different blocks, because the turns must connect all edges. These are the partition inequalities
 * of spanning trees. Up to ENUMERATED edges all divisions are tried; at larger nodes only the
 * components of the edges that turns of more than a threshold connect.
 *
 * Example: four edges, each turned into one other in pairs, x = 1 for two turns: the division into
 * these two pairs has no turn between its blocks, and needs one. */
#include "graph/arrays.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ENUMERATED = 7 }; /* edges at a node whose divisions are all looked at: 877 of 7 */

/* The turns at one node, and the most violated division found so far. */
typedef struct {
  int d;
  const double *between; /* [d * d], above the diagonal */
  int *block, *worst, *parent;
  int worst_blocks;
  double violation;
} node_division;

/* Keeps the division in block if it is the most violated so far. n: number of blocks; crossing:
 * turns between different ones. */
static void judge(node_division *division, int n, double crossing)
{
  double violation = n - 1 - crossing;
  if (violation <= division->violation + 1e-9) return;
  division->violation = violation;
  division->worst_blocks = n;
  memcpy(division->worst, division->block, (size_t)division->d * sizeof *division->worst);
}

/* Goes through all divisions that continue the one of the first k edges, which has n blocks and
 * `crossing` turns between them. */
static void divide(node_division *division, int k, int n, double crossing)
{
  if (k == division->d) {
    judge(division, n, crossing);
    return;
  }

  /* Edge k joins each of the blocks, or begins a new one. */
  for (int b = 0; b <= n; b++) {
    double more = 0;
    for (int i = 0; i < k; i++)
      if (division->block[i] != b) more += division->between[i * division->d + k];
    division->block[k] = b;
    divide(division, k + 1, b == n ? n + 1 : n, crossing + more);
  }
}

/* Judges the division into the parts that turns of more than threshold connect. */
static void judge_parts(node_division *division, double threshold)
{
  double crossing = 0;
  for (int i = 0; i < division->d; i++)
    division->parent[i] = i;
  for (int i = 0; i < division->d; i++)
    for (int k = i + 1; k < division->d; k++)
      if (division->between[i * division->d + k] > threshold)
        thr_disjoint_join(division->parent, i, k);

  /* Count the turns between different parts. */
  int n = thr_disjoint_number(division->parent, division->d, division->block);
  for (int i = 0; i < division->d; i++)
    for (int k = 0; k < i; k++)
      if (division->block[k] != division->block[i])
        crossing += division->between[k * division->d + i];
  judge(division, n, crossing);
}

/* Finds the most violated division of the d edges. between[i * d + k], i < k: turns between edges i
 * and k. block[d] and *n_blocks receive the division; *n_blocks is 0 if none is violated. */
static thr_status find_worst(int d, const double *between, int *block, int *n_blocks, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.2,  0.35,    0.51,
                                     0.7,  0.99, INFINITY}; /* the last: single edges */
  thr_scratch own = {0};
  node_division division = {.d = d, .between = between, .worst = block, .violation = 1e-6};
  division.block = thr_scratch_array(&own, (size_t)d, sizeof *division.block);
  division.parent = thr_scratch_array(&own, (size_t)d, sizeof *division.parent);
  thr_status st = thr_scratch_check(&own, err);

  if (!st && d <= ENUMERATED) divide(&division, 0, 0, 0);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && d > ENUMERATED && !st; i++)
    judge_parts(&division, threshold[i]);

  *n_blocks = division.worst_blocks;
  thr_scratch_free(&own);
  return st;
}

/* Adds the row of the blocks 0 .. n - 1 of node v if x violates it. */
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

/* Offers the most violated junction row of every node. */
thr_status thr_junctions_separate(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  const size_t most = (size_t)thr_frame_largest_degree(frame);
  double *between = thr_calloc(most * most, sizeof *between);
  int *block = thr_calloc(most, sizeof *block);
  thr_status st = between && block ? THR_OK : thr_nomem(err);

  /* The values of all turns at the node, then its worst division. */
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
