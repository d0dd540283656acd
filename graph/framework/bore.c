#include "graph/framework/bore.h"

#include <math.h>

enum { N_BEST = 20 };
static const double SURELY_ALL = 40; /* cord diameters: a hexagonal grid has more than THR_BORE_MOST places in it */

/* Of n = 1 .. 20 equal circles: diameter of the smallest circle known that holds them, in diameters of one, rounded up. */
static const double best[N_BEST] = {1,           2,           2.154700539, 2.414213563, 2.701301618, 3,           3,
                                    3.304764872, 3.613125930, 3.813025632, 3.923804401, 4.029601931, 4.236067978, 4.328428556,
                                    4.521356933, 4.615425596, 4.792033747, 4.863703306, 4.863703306, 5.122320757};

/* Places of a hexagonal grid, in diameters, whose circle is within a circle of diameter ratio round (x, y). */
static int hexagons(double ratio, double x, double y)
{
  int n = 0, reach = (int)(1.2 * ratio) + 2;
  double most = (ratio - 1) / 2 * (1 + 1e-12);
  for (int j = -reach; j <= reach; j++)
    for (int i = -reach; i <= reach; i++)
      n += hypot(i + 0.5 * j - x, j * sqrt(0.75) - y) <= most;
  return n;
}

int thr_bore_fits(double bore, double cord)
{
  double ratio = bore / cord * (1 + 1e-9); /* what fits exactly fits */
  int n = 0;
  if (ratio > SURELY_ALL) return THR_BORE_MOST;
  while (n < N_BEST && best[n] <= ratio)
    n++;
  const double centre[][2] = {{0, 0}, {0.5, 0}, {0.5, sqrt(1.0 / 12)}};
  for (int i = 0; i < 3; i++) {
    int more = hexagons(ratio, centre[i][0], centre[i][1]);
    if (more > n) n = more;
  }
  return n;
}

double thr_bore_clear(int n)
{
  double fill = n == 1 ? 0.53 : n == 2 ? 0.31 : 0.40;
  return sqrt(n / fill);
}
