/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the few cheapest turns of every half-edge at a node of any degree: the candidates among
 * which pairings and bounds are chosen first.
 *
 * One sweep over the node's turns, O(degree^2), inserts each turn into the sorted lists of both its
 * half-edges.
 *
 * Example: a hub of 1,000 edges has 499,500 turns; with 6 of every half-edge at most 6,000 remain.
 */
#include "tortuosity/proof/relax_parts.h"

#include <stdlib.h>

/* Releases the lists. */
void thr_nearest_destroy(thr_nearest *nearest)
{
  free(nearest->partner);
  free(nearest->price);
  *nearest = (thr_nearest){0};
}

/* Inserts half-edge j into the sorted list of half-edge i if it is cheap enough; the most expensive
 * one is dropped. */
static void insert(thr_nearest *nearest, int i, int j, int64_t price)
{
  int *partner = nearest->partner + (size_t)i * (size_t)nearest->n, at = nearest->n - 1;
  int64_t *by = nearest->price + (size_t)i * (size_t)nearest->n;
  if (price >= by[at]) return;

  for (; at > 0 && price < by[at - 1]; at--) {
    by[at] = by[at - 1];
    partner[at] = partner[at - 1];
  }

  by[at] = price;
  partner[at] = j;
}

/* Fills the lists of all half-edges at node v. */
thr_status thr_nearest_find(const thr_turning_columns *turning_columns, int v, const int64_t *price,
                            int most, thr_nearest *out, thr_err *err)
{
  int d = thr_degree(turning_columns->f, v), column = turning_columns->pair_first[v];
  *out = (thr_nearest){.degree = d, .n = most < d ? most : d - 1};

  size_t all = (size_t)d * (size_t)out->n;
  out->partner = thr_calloc(all, sizeof *out->partner);
  out->price = thr_calloc(all, sizeof *out->price);
  if (!out->partner || !out->price) {
    thr_nearest_destroy(out);
    return thr_nomem(err);
  }

  /* Empty places have the highest price, so that every turn is sorted in before them. */
  for (size_t i = 0; i < all; i++) {
    out->partner[i] = -1;
    out->price[i] = INT64_MAX;
  }

  /* The columns of a node's turns are numbered pair by pair. */
  for (int i = 0; i < d; i++)
    for (int j = i + 1; j < d; j++, column++) {
      insert(out, i, j, price[column]);
      insert(out, j, i, price[column]);
    }
  return THR_OK;
}
