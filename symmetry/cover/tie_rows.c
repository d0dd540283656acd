/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adds the rows of tube joints to the relaxation: between the b blocks of any partition of a star's
 * tubes there are at least b - 1 turns, where every column counts for no more than is asked for
 * (symmetry/cover/ties.c).
 *
 * The row of all tubes apart is there from the start. Violated rows are looked for among the blocks
 * that the turns of a point connect if only turns above a threshold count, and, at nodes with few
 * tubes, among all partitions into two blocks. For whole points that is exact.
 *
 * Example: three tubes with 2/3 of each of the turns a-b and b-c: the row of {a} and {b, c} asks
 * for 1 where there is 2/3. */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_TUBES = 8 }; /* at a node whose partitions into two blocks are all looked at */

/* Appends the columns of the row of these blocks; none counts for more than what is asked for. */
static void put_blocks(thr_relaxation *relaxation, int star, const int *block, int blocks)
{
  const thr_ties *ties = relaxation->p->ties;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int pair = ties->pair[i], turns = thr_ties_between(ties, pair, block);
    thr_pool_put(&relaxation->search.pool, relaxation->p->first_pair + pair,
                 turns < blocks - 1 ? turns : blocks - 1);
  }
}

thr_status thr_relaxation_tie_first(thr_relaxation *relaxation, thr_err *err)
{
  const thr_ties *ties = relaxation->p->ties;
  thr_status st = THR_OK;
  int *block = thr_calloc((size_t)ties->most, sizeof *block);
  if (!block) return thr_nomem(err);

  /* Every tube is a block. */
  for (int i = 0; i < ties->most; i++)
    block[i] = i;
  for (int i = 0; i < ties->n && !st; i++) {
    put_blocks(relaxation, i, block, ties->degree[i]);
    st = thr_relaxation_add_row(relaxation, ties->degree[i] - 1, err);
  }

  free(block);
  return st;
}

/* Finds the two blocks with the least sum of turns between them, each column counted once, if that
 * is less than 1. block: as in thr_ties_between; best receives the blocks. */
static bool find_cut(const thr_relaxation *relaxation, int star, int *block, int *best)
{
  const thr_ties *ties = relaxation->p->ties;
  double least = 1 - 1e-4;
  bool found = false;
  /* The last tube is in block 0, so that every partition comes once. */
  for (unsigned subset = 1; subset < 1U << (ties->degree[star] - 1); subset++) {
    double sum = 0;
    for (int i = 0; i < ties->degree[star]; i++)
      block[i] = subset >> i & 1;
    for (int i = ties->first[star]; i < ties->first[star + 1] && sum < least; i++)
      if (thr_ties_between(ties, ties->pair[i], block) > 0)
        sum += fmax(0, relaxation->x[relaxation->p->first_pair + ties->pair[i]]);
    if (sum >= least) continue;
    least = sum;
    found = true;
    for (int i = 0; i < ties->degree[star]; i++)
      best[i] = block[i];
  }
  return found;
}

/* Separates the rows of one star. block, best: [ties->most] scratch. */
static thr_status tie_star(thr_relaxation *relaxation, int star, int *block, int *best, int *added,
                           thr_err *err)
{
  static const double threshold[] = {1e-6, 0.3, 0.51};
  const thr_ties *ties = relaxation->p->ties;
  thr_status st = THR_OK;
  int before = *added;

  /* Blocks that turns above a threshold connect; the first threshold that gives a violated row is
   * enough. */
  for (size_t k = 0; k < sizeof threshold / sizeof *threshold && *added == before && !st; k++) {
    int blocks =
        thr_ties_blocks(ties, star, relaxation->x + relaxation->p->first_pair, threshold[k], block);
    if (blocks < 2) continue;
    put_blocks(relaxation, star, block, blocks);
    st = thr_relaxation_add_violated(relaxation, blocks - 1, added, err);
  }

  /* Any two blocks, where there are few tubes. */
  if (st || *added > before || relaxation->search.whole || ties->degree[star] > MOST_TUBES ||
      !find_cut(relaxation, star, block, best))
    return st;
  put_blocks(relaxation, star, best, 2);
  return thr_relaxation_add_violated(relaxation, 1, added, err);
}

thr_status thr_relaxation_tie(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  const thr_ties *ties = relaxation->p->ties;
  thr_status st = THR_OK;
  int *block = thr_calloc((size_t)ties->most, sizeof *block),
      *best = thr_calloc((size_t)ties->most, sizeof *best);
  if (!block || !best) st = thr_nomem(err);

  for (int i = 0; i < ties->n && !st; i++)
    st = tie_star(relaxation, i, block, best, added, err);

  free(block);
  free(best);
  return st;
}
