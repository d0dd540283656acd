/* The plans that one of the least turning is held against. */
#ifndef THR_RIVALS_H
#define THR_RIVALS_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "planner/least_turning.h"

/* A plan that another is held against. */
typedef struct {
  const char *title, *key; /* of its column; of its JSON member */
  bool made;
  thr_plan plan;
  thr_err why; /* if it is not made */
} thr_rival;

typedef struct {
  thr_rival corner; /* the least turning among the shortest, or of any length; of a classical tour: the least turning */
  thr_rival length; /* of the least length */
  thr_frontier frontier;
  thr_err no_frontier; /* why there is none although one was asked for; code 0 otherwise */
} thr_rivals;

/* Makes them within the limits (without a deadline the frontier has the time limit of the plan once more): the shortest plan
 * where it takes no search, or shortest, which is taken, unless it has no cords; optima: that in any case, and the corner, which
 * is a search as long as the plan's own; and a frontier of that many points (0 = none). THR_OK also where there is no such plan
 * (why says so); on failure out holds what was made. Release with thr_rivals_destroy. */
thr_status thr_rivals_make(const thr_plan *p, thr_plan *shortest, bool optima, int frontier, const thr_limits *limits,
                           thr_rivals *out, thr_err *err) THR_MUST_CHECK;
void thr_rivals_destroy(thr_rivals *rivals);

#endif
