/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how many cords are drawn with ease through a round bore, and how wide a bore has to be
 * for so many: the cords' sections may fill a share of the bore's section, as conduits for cables
 * (NFPA 70, chapter 9, table 1). */
#include "graph/framework/frame.h"

#include <math.h>

double thr_bore_clear(int n)
{
  double fill = n == 1 ? 0.53 : n == 2 ? 0.31 : 0.40;
  return sqrt(n / fill);
}

int thr_bore_fits(double bore, double cord)
{
  double ratio = bore / cord * (1 + 1e-9); /* what fits exactly fits */
  int n = 0;
  while (n < THR_BORE_MOST && thr_bore_clear(n + 1) <= ratio)
    n++;
  return n;
}
