/* The cords of a small framework by a table over subsets (graph/threading/small_cords.h): exact. */
#ifndef THR_DECOMPOSITION_TABLE_H
#define THR_DECOMPOSITION_TABLE_H

#include "graph/status.h"
#include "lp/length/decomposition.h"

/* What is asked of the cords. */
typedef struct {
  int least, most; /* so many */
  bool even;       /* the longest as short as can be; then, and without it, little length in all */
  double limit;    /* of each cord, INFINITY = none: then the fewest */
} thr_decomposition_ask;

/* Puts such cords in place of the walks where those are worse, or are none: the options' ends, covers, capacities, joint. Walks
 * and passes become the best known; *certain: nothing is better, or there is nothing (they are then as they were). Frameworks
 * that are too large, and what the limits stop, leave them as they are. */
thr_status thr_decomposition_table(thr_decomposition *decomposition, const thr_decomposition_ask *ask, bool *certain,
                                   thr_err *err) THR_MUST_CHECK;

#endif
