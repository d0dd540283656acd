/* Holding pull: least pull at which the closed structure of rigid beads has any equilibrium. Rigid-block limit analysis (R. K.
 * Livesley, "Limit analysis of structures formed from rigid blocks", 1978) as a linear programme. */
#ifndef THR_HOLDING_H
#define THR_HOLDING_H

#include "eval/beads.h"
#include "graph/limits.h"

typedef struct {
  bool present;
  double lower; /* N: below it no equilibrium exists (friction pyramids round the cones), proved by the power balance of the
                   mechanism `velocity`; 0 if the structure stands by itself */
  double gap;   /* relative: how far below the least pull the solver found it may be; 1e-6 or less unless numbers are bad */
  double upper; /* N: at it an equilibrium exists (pyramids inside the cones), 0 if not computed, INFINITY if none was found */
  double imbalance; /* largest force left over in that equilibrium, in weights of a mean bead */
  int first_bead;   /* that moves fastest in the collapse mechanism just below lower; -1 if lower is 0 */
  double
      residual; /* fastest closing of a contact in the mechanism, whose fastest bead moves with 1: how exactly lower is proved */
  double (*velocity)[6]; /* [n_beads] collapse mechanism: translation of the mass centre, rotation (1/m), scaled to a largest
                            translation of 1; owned */
} thr_holding;

/* wrench: thr_beads_cord_wrench. THR_EINFEASIBLE if no pull holds it (says which bead fails: e.g. feet slide); THR_ELIMIT when
 * stopped. */
thr_status thr_holding_pull(const thr_beads *b, const thr_frame *f, const thr_physics *physics, const double (*wrench)[6],
                            bool want_upper, const thr_limits *limits, thr_holding *out, thr_err *err) THR_MUST_CHECK;
void thr_holding_destroy(thr_holding *h);

#endif
