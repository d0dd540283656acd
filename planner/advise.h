/* How many cords, and from where: a plan for every number of cords and kind of ends that may be worth it, and a choice among
 * them.
 *
 *   thr_advice advice;
 *   thr_status st = thr_advise(&frame, &request, &(thr_advise_options){.hand = thr_hand_always}, &limits, &advice, &err);
 *   if (!st && advice.chosen >= 0) printf("%d cords\n", advice.row[advice.chosen].cords);
 *   thr_advice_destroy(&advice); */
#ifndef THR_ADVISE_H
#define THR_ADVISE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/advice.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

typedef struct {
  double hand;          /* N: what the pull is to stay within */
  const thr_plan *plan; /* NULL; or the shortest closed cords, for a framework that is too large for searches. Borrowed */
  /* Hears of every row as soon as it is there or better, before any is dropped; NULL = nobody. plan: whose cords the row
   * measures, NULL if the row measures those that it did before, or its cords were never laid out. Borrowed. */
  void (*row)(void *user, const thr_advice_row *row, const thr_plan *plan);
  void *user;
} thr_advise_options;

/* Of the request only cover, capacity and physics count. Rows: one closed cord; for ends at the feet, if there are any, and ends
 * anywhere, 1, 2, 3, 4, 6, 8, 12, .. cords until the pull is that of the seating tension, two more numbers have bought nothing,
 * or there are four times as many cords as stay within the hand; and numbers below the fewest that do. (More closed cords than
 * one buy nothing that cords with ends anywhere do not.) First the cord that turns least is cut evenly into every number of
 * cords, or symmetric cords are taken if they turn less; then every number has a search from there, the fewest within the hand
 * first, each with a part of the time that is left: where they end before it is over the same input gives the same rows.
 * Of more than 5,000 edges only the shortest closed cords are cut. Of several components each has rows of its own; a row of all
 * is of the most cords in a component, and every other one has as few as need no more pull. THR_EINPUT: physics that do not fit.
 * THR_ELIMIT, THR_EINFEASIBLE: no row has a plan. THR_OK also if the time was over before all searches had their turn (complete
 * says so), as long as there is a row. Release with thr_advice_destroy. */
thr_status thr_advise(const thr_frame *frame, const thr_request *request, const thr_advise_options *options,
                      const thr_limits *limits, thr_advice *out, thr_err *err) THR_MUST_CHECK;

#endif
