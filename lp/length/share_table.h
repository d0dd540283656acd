/* The cords of a small component by a table over subsets (graph/threading/small_cords.h): exact. */
#ifndef THR_SHARE_TABLE_H
#define THR_SHARE_TABLE_H

#include "graph/limits.h"
#include "graph/status.h"
#include "graph/threading/walks.h"
#include "lp/length/share.h"

/* What is asked of the cords of a component. */
typedef struct {
  int least, most; /* so many */
  bool even;       /* the longest as short as can be; then, and without it, little length in all */
  double limit;    /* of each cord, INFINITY = none: then the fewest */
} thr_share_ask;

/* Puts such cords of component k in place of walks where walks is worse, or is none: the options' ends, covers, capacities,
 * joint. walks and passes become the best known; *certain: nothing is better, or there is nothing (w is then as it was).
 * Components that are too large, and what the limits stop, leave walks as it is. */
thr_status thr_share_table(const thr_share *share, int k, const thr_share_ask *ask, const thr_limits *limits, thr_walks *walks,
                           int *passes, bool *certain, thr_err *err) THR_MUST_CHECK;

#endif
