/* All cords of a small framework of one component at once, exactly: shortest or turning least, together or the worst of them, or
 * as few as a limit allows. A table over subsets (graph/threading/subsets.h) of what cords collect (graph/threading/items.h),
 * again with more items as long as the cords that it finds do not keep to all that was asked.
 *
 * Example: a ring of six edges of length 1, two open cords, ends anywhere: both are 3 long. */
#ifndef THR_SMALL_CORDS_H
#define THR_SMALL_CORDS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/items.h"

/* Cost is length, or with turning the price of turns (options.turning.cost). */
typedef struct {
  int least, most; /* so many cords */
  bool turning;
  bool even;    /* the dearest as cheap as can be; then, and without it, cheap in all */
  double limit; /* of each cord's cost, INFINITY = none: then as few cords as can be */
  int known;    /* cords that are known already; 0 = none. What these cost: */
  double known_dearest, known_sum;
} thr_small_ask;

typedef struct {
  int n;
  int *n_passes, **half; /* half-edges of each; owned */
} thr_small_cords;

void thr_small_cords_destroy(thr_small_cords *cords);

/* Of the options ends, covers, capacities and joint. out: cords that are better than those
 * known, and as asked for; else none. *certain: nothing is better than those or, without them, than the known ones; or there
 * are none at all. Not certain: too many items, or stopped by the limits. */
thr_status thr_small_cords_find(const thr_frame *frame, const thr_request *options, const thr_small_ask *ask,
                                const thr_limits *limits, thr_small_cords *out, bool *certain, thr_err *err) THR_MUST_CHECK;

#endif
