/* The piece in which a cord's friction is weighed: a bore that turns by 90 degrees, as in a bead with two arms. */
#ifndef THR_TEST_PIECE_H
#define THR_TEST_PIECE_H

#include "graph/text.h"

/* True to size: where to drill a block, and what to hang where. bore: mm. Failures stick to svg. */
void thr_test_piece_svg(double bore, thr_text *svg);

/* To be printed: two arms of square section at a right angle, a bore of sixteen sides from end to end, in mm. */
void thr_test_piece_stl(double bore, thr_text *stl);

#endif
