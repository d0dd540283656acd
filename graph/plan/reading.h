/* What a hand reads of a plan: a run of passes that go straight on is one instruction, what repeats itself along the framework is
 * read once. Of cords that are copies of each other only one is read.
 *
 * Example: a line of seven beads between ends that may be anywhere is three instructions: an end, "straight on to H1", an end. */
#ifndef THR_READING_H
#define THR_READING_H

#include "graph/plan/plan.h"

/* Turns of less are "straight on". */
static const double THR_STRAIGHT = 0.26179938779914943654; /* rad, 15 degrees */

/* How far from another node's a node's place may be, moved along, to be that node's in what repeats itself: in parts of the mean
 * length of an edge. */
static const double THR_READING_NEAR = 0.05;

typedef struct {
  int instructions; /* runs; ends that may be anywhere; one more for each path that repeats itself, or is repeated elsewhere */
  int repeated;     /* paths that repeat themselves: their first period is read */
  int mapped;       /* paths that are images of a part of themselves under the plan's group: that part is read, up to where it is
                       turned, or to the mirror */
  int moved;        /* unique paths that are an earlier one moved along, without a turn: not read */
} thr_reading;

/* Of the plan's unique paths, or of all its cords if it has no record of symmetry. O(passes^2) at worst for every path, for every
 * two paths of as many passes, and for every generator and two copies of a path. */
thr_reading thr_reading_of(const thr_plan *plan);

#endif
