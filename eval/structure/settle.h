/* The closed structure in Bullet: rigid beads, cords as forces from hole to hole with the capstan profile; settles under a firm
 * pull, then the pull is let off until a bead moves. Says which bead fails first and how plans rank. Its absolute force is not
 * stable (the fall is seen late, by more the faster the pull is let off; friction contacts creep) and is never given in newtons.
 * Beads touch only at the faces that meet in the middle of an edge, feet only their own ground: a falling bead passes the others.
 */
#ifndef THR_SETTLE_H
#define THR_SETTLE_H

#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

typedef struct {
  double start;                 /* N: pull at which the structure settles; the same for plans that are to be ranked */
  double time_step, iterations; /* factors on the protocol's, 1 */
  uint64_t seed;
} thr_settle_options;

typedef enum {
  THR_SETTLE_FELL,
  THR_SETTLE_HELD,
  THR_SETTLE_NEVER_SETTLED,
  THR_SETTLE_TOO_LARGE,
  THR_SETTLE_CREPT, /* a bead moved at a pull at which an equilibrium exists (thr_settle_judge) */
  THR_SETTLE_LATE   /* it stood without any pull, where limit analysis proves that it needs one (thr_settle_judge) */
} thr_settle_status;

typedef struct {
  bool present;
  int status;                   /* thr_settle_status */
  double index;                 /* pull at the fall / start: only its order among plans with the same start means anything; 0 =
                                   none if CREPT or LATE */
  int first_bead;               /* that moved; -1 if none */
  double gap_before, gap_after; /* mm, widest gap between two adjacent faces, settled and at the end */
  double drift;                 /* mm, largest movement while settling */
  double finer;                 /* factor on the options' time step and iterations with which this was found: 1, 1/2 or 1/4 */
  int n_beads;
  double (*before)[7], (*after)[7]; /* [n_beads] position of the node (m, as thr_beads.centre) and rotation from the drawn
                                       position as a quaternion (x y z w) of each bead, settled and after the fall; owned */
} thr_settle;

/* Settles for 2, then divides the pull by 1,000 over 15 (and takes off the rest) in units of the time sqrt(mean edge /
 * gravity): structures and their scale models behave alike. HELD: stands without any pull. NEVER_SETTLED: a bead moved by a
 * twentieth of the mean edge under the start, also with the time step and iterations halved and halved again; index is then 0.
 * Then a larger start helps only if start was below what limit analysis asks for; else a smaller one (contacts creep under firm
 * pulls) or a finer time_step may. FELL: a bead moved by a fiftieth from where it had settled (index 0: only when no pull was
 * left). Same input and seed, same bits on one machine. n beads of depth d (edges from a support): O(n d) a step, 3,000 to 15,000
 * steps, more with time_step below 1 or after failed attempts: 49 beads about 5 s, 100 about 10 s. THR_EINPUT for a start that is
 * not positive or factors out of range, THR_ELIMIT when stopped, both with out empty. n_beads above thr_settle_largest: status
 * TOO_LARGE, nothing else.
 */
extern const int thr_settle_largest;

/* Limit analysis has found an equilibrium at the pull `equilibrium` (N; INFINITY: at none), and so at every larger one, since
 * more tension only presses the faces more. If the structure fell above it, its contacts crept: status CREPT, no index. It has
 * proved that there is none below the pull `least` (N; 0: nothing is proved). If the structure stood until the pull was gone, its
 * fall was too slow to be seen: status LATE, no index. */
void thr_settle_judge(thr_settle *settle, double start, double least, double equilibrium);

thr_status thr_settle_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const double *const *tension, const thr_physics *physics, const thr_settle_options *options,
                          const thr_limits *limits, thr_settle *out, thr_err *err) THR_MUST_CHECK;
void thr_settle_destroy(thr_settle *settle);

#endif
