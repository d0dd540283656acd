/* Cords evened out by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983) that changes their passes, too. What
 * exchanges of pairs (graph/threading/even.h) cannot do, it does: a part that other cords pass as well goes another way or is
 * left out, and an open cord ends elsewhere.
 *
 * Example: a cord that turns by 400 degrees passes an edge that another one passes as well, with two turns of 90 degrees; it goes
 * straight on instead. */
#ifndef THR_ANNEAL_H
#define THR_ANNEAL_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"

typedef struct {
  thr_walk_measure measure;
  int steps; /* of a run at most: changes at random */
  int first,
      rounds;    /* number of the first round, whose random numbers are others than those of the rounds before; and how many */
  bool alone;    /* one run in a round instead of two: this thread has no other beside it */
  bool near;     /* of turnings: every second run stays near the best cords, again and again, where the others forget them */
  double enough; /* largest price or length that need not become less */
} thr_anneal_task;

/* Lowers the largest price of the turns of n_cords cords, or their largest length, and replaces them where it falls, as long as
 * it is above enough: in rounds of two runs each from the best so far (alone: of one; of lengths every second run begins hotter),
 * until all rounds are done, or several in turn were in vain, or the limits' time is up. Solid joints, and no given numbers of
 * ends at nodes. Every edge keeps the passes that the columns ask for, and has no more than they allow. *better: whether it fell.
 * A change that is not taken takes time that does not depend on the framework, one that is O(passes of two cords). */
thr_status thr_anneal(const thr_turning_columns *columns, const thr_anneal_task *task, const thr_limits *limits, thr_cord *cord,
                      int n_cords, bool *better, thr_err *err) THR_MUST_CHECK;

#endif
