/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs the passes at one node: a minimum-weight perfect matching of n points under any prices.
 *
 * Up to 16 points by a dynamic programme over subsets: best(S) = min over j of price(i, j) + best(S
 * - {i, j}), with i the lowest point of S. More points: point i with i + n / 2, then exchanges of
 * two pairs while any saves.
 *
 * Example: four passes straight across each other are paired with their opposites, at price 0. */
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

/* Returns the lowest point of a subset, which is not empty. */
static int lowest(unsigned s)
{
  int i = 0;
  while (!(s >> i & 1u))
    i++;
  return i;
}

/* Returns the number of points of a subset. */
static int size_of(unsigned s)
{
  int n = 0;
  for (; s; s &= s - 1)
    n++;
  return n;
}

/* Returns whether subset s can be left when lowest points are paired off, one after the other, with
 * any others. Then all points below its lowest are gone, and with each of them at most one more. */
static bool is_left(int n, unsigned set, int low)
{
  int gone = n - size_of(set);
  return gone % 2 == 0 && gone <= 2 * low;
}

/* Pairs n points by the dynamic programme. best[s] is the least price of pairing the points of
 * subset s, choice[s] the partner of its lowest point. */
static thr_status pair_by_subsets(int n, const double *price, int *mate, thr_err *err)
{
  unsigned all = (1u << n) - 1;
  double *best = thr_calloc((size_t)all + 1, sizeof *best);
  unsigned char *choice = thr_calloc((size_t)all + 1, sizeof *choice);
  thr_status st = best && choice ? THR_OK : thr_nomem(err);

  for (unsigned set = 1; set <= all && !st; set++) {
    int i = lowest(set);

    if (!is_left(n, set, i)) continue;
    best[set] = INFINITY;

    for (int j = i + 1; j < n; j++) {
      if (!(set >> j & 1u)) continue;
      double total = price[i * n + j] + best[set & ~(1u << i | 1u << j)];
      if (total < best[set]) {
        best[set] = total;
        choice[set] = (unsigned char)j;
      }
    }
  }

  /* Read the pairs off, from all points on. */
  for (unsigned set = all; set && !st;) {
    int i = lowest(set);
    thr_set_pair(mate, i, choice[set]);
    set &= ~(1u << i | 1u << choice[set]);
  }

  free(best);
  free(choice);
  return st;
}

/* Makes one round of exchanges (a b)(c d) -> (a c)(b d) or (a d)(b c); returns whether one saved.
 */
static bool exchange_pairs(int n, const double *price, int *mate)
{
  bool saved = false;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++) {
      int b = mate[a], d = mate[c];
      if (b == c) continue;

      /* Both other pairings of the four points. */
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
