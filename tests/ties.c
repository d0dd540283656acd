/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All turns of one node, tried. */
#include "tests/ties.h"

#include <math.h>

static bool connected(int d, const unsigned *link)
{
  unsigned seen = 1, next = 1;
  while (next) {
    int i = 0;
    while (!(next >> i & 1u))
      i++;
    next &= ~(1u << i);
    next |= link[i] & ~seen;
    seen |= link[i];
  }
  return seen == (1u << d) - 1;
}

/* Numbers of turns between points a and b and all later pairs, of which none is of a point with
 * itself. */
static void all_turns(tied_star *k, int a, int b, double price)
{
  if (b > k->d) {
    if (k->left[a] > 0) return;
    a++;
    b = a + 1;
  }
  if (price >= k->least) return;
  if (a == k->d) {
    if (k->left[a] == 0 && connected(k->d, k->link)) k->least = price;
    return;
  }
  bool end = b == k->d;
  int most = k->left[a] < k->left[b] ? k->left[a] : k->left[b];
  for (int n = 0; n <= most; n++) {
    unsigned before[2] = {k->link[a], k->link[b]};
    if (n > 0 && !end) {
      k->link[a] |= 1u << b;
      k->link[b] |= 1u << a;
    }
    k->left[a] -= n;
    k->left[b] -= n;
    all_turns(k, a, b + 1, price + (end ? 0 : n * k->price[a][b]));
    k->left[a] += n;
    k->left[b] += n;
    k->link[a] = before[0];
    k->link[b] = before[1];
  }
}

double least_by_all_turns(tied_star *k)
{
  k->least = INFINITY;
  all_turns(k, 0, 1, 0);
  return k->least;
}
