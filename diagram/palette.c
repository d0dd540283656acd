#include "diagram/palette.h"

#include <stddef.h>

thr_colour thr_palette(int i)
{
  /* neighbours in this order differ most: vermillion and orange are kept apart */
  static const thr_colour colour[THR_COLOURS] = {{"#0072B2", "blue"}, {"#D55E00", "vermillion"}, {"#009E73", "green"},
                                                 {"#CC79A7", "pink"}, {"#56B4E9", "sky blue"},   {"#E69F00", "orange"}};
  return colour[i % THR_COLOURS];
}

const double *thr_palette_dash(int i)
{
  static const double dash[THR_DASHES - 1][5] = {{3, 1, 0}, {1, 1, 0}, {4, 1, 1, 1, 0}};
  i %= THR_DASHES;
  return i ? dash[i - 1] : NULL;
}
