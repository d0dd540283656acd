/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of the relaxation that hold for tube joints. */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>

enum { FEW = 8 }; /* tubes at a node up to which all sets of them are looked at */

/* Puts the row of these blocks; no column need count more than what is asked for. */
static void put_blocks(thr_relaxation *relaxation, int star, const int *block, int blocks)
{
  const thr_ties *ties = relaxation->p->ties;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int y = ties->pair[i], turns = thr_ties_between(ties, y, block);
    thr_pool_put(&relaxation->search.pool, relaxation->p->first_pair + y,
                 turns < blocks - 1 ? turns : blocks - 1);
  }
}

thr_status thr_relaxation_tie_first(thr_relaxation *relaxation, thr_err *err)
{
  const thr_ties *ties = relaxation->p->ties;
  thr_status st = THR_OK;
  int *block = thr_calloc((size_t)ties->most, sizeof *block);
  if (!block) return thr_nomem(err);
  for (int i = 0; i < ties->most; i++)
    block[i] = i;
  for (int i = 0; i < ties->n && !st; i++) {
    put_blocks(relaxation, i, block, ties->degree[i]);
    st = thr_relaxation_add_row(relaxation, ties->degree[i] - 1, err);
  }
  free(block);
  return st;
}

/* The two blocks with the fewest turns between them, each column counted once. block: as in
 * thr_ties_between. */
static bool find_cut(const thr_relaxation *relaxation, int star, int *block, int *best)
{
  const thr_ties *ties = relaxation->p->ties;
  double least = 1 - 1e-4;
  bool found = false;
  for (unsigned set = 1; set < 1U << (ties->degree[star] - 1); set++) {
    double sum = 0;
    for (int i = 0; i < ties->degree[star]; i++)
      block[i] = set >> i & 1;
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

static thr_status tie_star(thr_relaxation *relaxation, int star, int *block, int *best, int *added,
                           thr_err *err)
{
  static const double threshold[] = {1e-6, 0.3, 0.51};
  const thr_ties *ties = relaxation->p->ties;
  thr_status st = THR_OK;
  int before = *added;
  for (size_t k = 0; k < sizeof threshold / sizeof *threshold && *added == before && !st; k++) {
    int blocks =
        thr_ties_blocks(ties, star, relaxation->x + relaxation->p->first_pair, threshold[k], block);
    if (blocks < 2) continue;
    put_blocks(relaxation, star, block, blocks);
    st = thr_relaxation_add_violated(relaxation, blocks - 1, added, err);
  }
  if (st || *added > before || relaxation->search.whole || ties->degree[star] > FEW ||
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
