/* How the structure comes up: the same beads and cords as in settle.h, sunk down under slack cords, then drawn in.
 *
 * A heap under tight cords does not rise by itself: faces that lean on each other's edges lock. A counterweight over every bead
 * (the thesis's Fig. 25) that carries a part of its weight lets the cords close the gaps. The least of five parts that does is
 * found by trying. Cords lead from hole to hole and have the tensions of being drawn in; beads without feet come to lie on the
 * ground, too.
 *
 * This is a picture of one way up, not a proof: friction, damping and the way down are the simulation's. */
#ifndef THR_ERECT_H
#define THR_ERECT_H

#include "eval/structure/beads.h"
#include "graph/limits.h"

enum { THR_ERECT_STILLS = 6 };

typedef struct {
  double pull;   /* N, of the harder ends */
  double lift;   /* part of the weight that the counterweight carries */
  double height; /* mm, of the highest node over the ground under the lowest foot */
  double gap;    /* mm, widest opening of any face */
  int closed;    /* faces that open nowhere by a hundredth of an edge */
} thr_erect_still;

typedef struct {
  bool present;
  double
      lift; /* least part of the weight with which it comes up and then stands alone, of 0, 1/4, 1/2, 3/4, 1; NAN = with none */
  double weight; /* N, of all that is not held in place */
  double drawn;  /* mm, height as drawn */
  int n_beads, n_gaps;
  thr_erect_still still[THR_ERECT_STILLS]; /* slack; drawn in by a half, once, twice the pull; let alone */
  double (*pose)[7]; /* [THR_ERECT_STILLS * n_beads] of each still: node (m), rotation (x y z w) from the drawn position; owned */
} thr_erect;

typedef struct {
  double pull; /* N: with which it stands, once it is up */
  double time_step, iterations;
  uint64_t seed;
} thr_erect_options;

/* tension: N, of a pull of 1 N. It comes up if no face opens by a fiftieth of an edge and nine tenths of the drawn height are
 * there, when the counterweight is gone. Stills are those of the least counterweight that does it, or of the largest. Same input
 * and seed, same bits on one machine. At most five runs of some 4,000 steps: 49 beads half a minute. THR_EINPUT for a pull that
 * is not positive, THR_ELIMIT when stopped, both with out empty; above thr_settle_largest(false) beads not present. */
thr_status thr_erect_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord, int n_cords,
                         const double *const *tension, const thr_physics *physics, const thr_erect_options *options,
                         const thr_limits *limits, thr_erect *out, thr_err *err) THR_MUST_CHECK;
void thr_erect_destroy(thr_erect *erect);

#endif
