/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What it costs to tie a node, by trying all turns there: the oracle of the tests of tube joints.
 */
#ifndef THR_TEST_TIES_H
#define THR_TEST_TIES_H

#include "tests/support.h"

enum { MOST_TIED = 6 }; /* edges of a node */

typedef struct {
  int d;                              /* edges; point d stands for the cord ends */
  int left[MOST_TIED + 1];            /* passes of an edge, ends */
  double price[MOST_TIED][MOST_TIED]; /* of a turn between edges i < j */
  unsigned link[MOST_TIED + 1];       /* zero between calls */
  double least;
} tied_star;

/* Least price of turns that take all passes and ends, none back into its own edge, and tie the
 * edges; INFINITY: there are none.
 */
double least_by_all_turns(tied_star *k);

#endif
