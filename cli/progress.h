/* --progress: how far a search is, for a program that reads it: one JSON object on a line of stderr each time the plan or its
 * bound is better.
 *
 *   {"what":"plan","length":1995.2,"turning":53.5,"cords":1,"seconds":0.31}   a whole plan was found
 *   {"what":"turning","best":53.5,"bound":51.2,"gap":4.3,"seconds":0.52}      what is minimized, and what nothing is below; gap:
 * %
 *   {"what":"joints","done":0.25,"seconds":2.1}                               work whose amount is known
 *
 * best and bound are prices of turns (rad, or as --turn-cost has it) where what is turning, else weights of extra cord; length is
 * in the framework's units, turning in rad, seconds since the search began. */
#ifndef THR_CLI_PROGRESS_H
#define THR_CLI_PROGRESS_H

#include "graph/limits.h"
#include "graph/plan/plan.h"

#include <stdbool.h>

/* From here on lines are written. */
void progress_begin(void);

bool progress_wanted(void);

/* Sets the functions of limits that tell of progress; their user may be any. */
void progress_listen(thr_limits *limits);

/* A plan that is better than the last one. */
void progress_plan(const thr_plan *plan);

#endif
