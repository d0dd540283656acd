/* How long all cords together must be if each keeps to a limit on the pull: the programme over walks.
 *
 * Example: on a 7 x 7 dome 10 cords between its feet, none of which needs more than twice the seating tension, are 2168.6 mm long
 * at least, where 1995.2 mm is what any cords need. */
#ifndef THR_WALK_PULL_H
#define THR_WALK_PULL_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"

/* *bound: what the cords of a component have together at least, in units of length; 0: nothing was proved. proof, empty at first,
 * receives the prices that prove it. cord: of a plan within the pull. Nothing is done where places and units are more than the
 * recursion takes in a moment. */
thr_status thr_walk_pull_length(const thr_turning_columns *columns, const thr_request *options, const thr_cord *cord, int n_cords,
                                int component, const thr_limits *limits, thr_walk_proof *proof, double *bound,
                                thr_err *err) THR_MUST_CHECK;

/* Few cords of a component within options.max_pull, short ones where as few may be: by diving on the columns of a programme that
 * prices cords. some, of all components: any cords. cord[most] receives n cords without names; the caller's. *n is 0 if none
 * were found, or more than most. */
thr_status thr_walk_pull_few(const thr_turning_columns *columns, const thr_request *options, const thr_cord *some, int n_some,
                             int component, const thr_limits *limits, int most, thr_cord *cord, int *n,
                             thr_err *err) THR_MUST_CHECK;

/* *excluded: so many cords of the component, at most `cords`, are proved to be too few for options.max_pull; 0: none are that
 * were not known to be. proof, empty at first, receives the prices that prove it. cord: of a plan within the pull, or of any. */
thr_status thr_walk_pull_too_few(const thr_turning_columns *columns, const thr_request *options, const thr_cord *cord,
                                 int n_cords, int component, int known, int cords, const thr_limits *limits,
                                 thr_walk_proof *proof, int *excluded, thr_err *err) THR_MUST_CHECK;

#endif
