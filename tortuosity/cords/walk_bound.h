/* How much some cord has to turn, or how long it must be, and cords little above that: the programme over walks.
 *
 * Example: on a 7 x 7 dome with 14 cords between its feet some cord turns by 257 degrees, which is what the plan has. */
#ifndef THR_WALK_BOUND_H
#define THR_WALK_BOUND_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"
#include "tortuosity/proof/orbits.h"

typedef struct {
  thr_walk_measure measure;
  const thr_cord *cord; /* [n_cords] */
  int n_cords;
  double least;  /* proved: of the turning of all cords of the component of the dearest one, or their length */
  double enough; /* > 0: asked is only whether some cord costs more; one limit is tried, and better cords are looked for just
                    below it */
  thr_orbits_motions *motions; /* near ones will do; NULL: none */
} thr_walk_ask;

/* Raises *bound, on the turning of the cord that turns most, the pulled turning of the one that is hardest to pull, of which no
 * better cords are looked for, or the length of the longest, as far as the highest limit below which
 * the walks are too few: by bisection, in the component of that cord. proof receives the prices, if there are any; what it held
 * is released. *better, NULL at first, receives n_cords cords of which the dearest costs less, if the columns make some; the
 * caller's. Nothing is done for one cord in each component, or where places and units are more than the recursion takes in a
 * moment. A large framework that motions map onto itself is bounded by prices that are the same for all images; then no cords are
 * looked for. */
thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_walk_ask *ask, const thr_limits *limits,
                          thr_walk_proof *proof, double *bound, thr_cord **better, thr_err *err) THR_MUST_CHECK;

#endif
