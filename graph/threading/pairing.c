/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairing the passes at one node: minimum-weight perfect matching of n points under any prices.
 *
 * Up to 16 points by dynamic programming over subsets: best(S) = min over j of price(i, j) + best(S
 * - {i, j}), i the lowest point of S; beyond, point i with i + n / 2, then exchanges of two pairs
 * while any saves.
 *
 * Example: four passes straight across each other are paired with their opposites, at price 0. */
#include "graph/threading/euler.h"

#include <math.h>
#include <stdlib.h>

static int lowest(unsigned s)
{
  int i = 0;
  while (!(s >> i & 1u))
    i++;
  return i;
}

static int size_of(unsigned s)
{
  int n = 0;
  for (; s; s &= s - 1)
    n++;
  return n;
}

/* Is subset s left when lowest points are paired off, one after the other, with any others? Then
 * all points below its lowest are gone, and with each of them at most one more. */
static bool is_left(int n, unsigned s, int low)
{
  int gone = n - size_of(s);
  return gone % 2 == 0 && gone <= 2 * low;
}

/* best[s] = least price of pairing the points of subset s; choice[s] = partner of its lowest. */
static thr_status pair_by_subsets(int n, const double *price, int *mate, thr_err *err)
{
  unsigned all = (1u << n) - 1;
  double *best = thr_calloc((size_t)all + 1, sizeof *best);
  unsigned char *choice = thr_calloc((size_t)all + 1, sizeof *choice);
  thr_status st = best && choice ? THR_OK : thr_nomem(err);
  for (unsigned s = 1; s <= all && !st; s++) {
    int i = lowest(s);
    if (!is_left(n, s, i)) continue;
    best[s] = INFINITY;
    for (int j = i + 1; j < n; j++) {
      if (!(s >> j & 1u)) continue;
      double total = price[i * n + j] + best[s & ~(1u << i | 1u << j)];
      if (total < best[s]) {
        best[s] = total;
        choice[s] = (unsigned char)j;
      }
    }
  }
  for (unsigned s = all; s && !st;) {
    int i = lowest(s);
    thr_set_pair(mate, i, choice[s]);
    s &= ~(1u << i | 1u << choice[s]);
  }
  free(best);
  free(choice);
  return st;
}

/* One pass of exchanges (a b)(c d) -> (a c)(b d) or (a d)(b c); true if one saved. */
static bool exchange_pairs(int n, const double *price, int *mate)
{
  bool saved = false;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++) {
      int b = mate[a], d = mate[c];
      if (b == c) continue;
      double old = price[a * n + b] + price[c * n + d];
      double straight = price[a * n + c] + price[b * n + d],
             cross = price[a * n + d] + price[b * n + c];
      if (fmin(straight, cross) >= old - 1e-9 * (1 + fabs(old))) continue;
      thr_set_pair(mate, a, straight <= cross ? c : d);
      thr_set_pair(mate, b, straight <= cross ? d : c);
      saved = true;
    }
  return saved;
}

thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err)
{
  if (n % 2) return thr_fail(err, THR_EINPUT, "%d passes and ends at a node cannot be paired", n);
  if (n <= THR_PAIRING_EXACT) return pair_by_subsets(n, price, mate, err);
  for (int i = 0; i < n / 2; i++)
    thr_set_pair(mate, i, i + n / 2);
  while (exchange_pairs(n, price, mate))
    ;
  return THR_OK;
}
