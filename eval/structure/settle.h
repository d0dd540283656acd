/* The closed structure in Bullet, as a witness for the limit analysis: rigid beads that touch at the corners of their faces,
 * cords as forces between them. It settles above the pull at which an equilibrium exists, then the pull is let off until a bead
 * moves faster and faster. Newtons, between the pulls at which the fall began and was seen, also where they contradict it.
 * Friction is the limit analysis's own (faces open by mu times their slide, bullet.cpp), so that both speak of one state;
 * Coulomb's law, under which sliding faces do not open, lets a structure fall at a somewhat larger pull (docs/method.md). Beads
 * touch only at the faces that meet in the middle of an edge, feet only their own ground: a falling bead passes the others.
 */
#ifndef THR_SETTLE_H
#define THR_SETTLE_H

#include "eval/structure/beads.h"
#include "graph/limits.h"

typedef struct {
  double least;       /* N: below it nothing holds the structure, as limit analysis has proved; 0 = nothing is proved .. */
  double equilibrium; /* N: .. and at it, and at every larger pull, an equilibrium exists; INFINITY = none was found */
  double start;       /* N: pull at which the structure settles; 0 = 1.3 x equilibrium, or least where none was found */
  double time_step, iterations; /* factors on the protocol's, 1 */
  uint64_t seed;
  bool large; /* thr_settle_largest */
} thr_settle_options;

typedef enum {
  THR_SETTLE_FELL,
  THR_SETTLE_HELD, /* without any pull */
  THR_SETTLE_NEVER_SETTLED,
  THR_SETTLE_TOO_LARGE,
  THR_SETTLE_CREPT, /* a bead moved at a pull at which an equilibrium exists, or too slowly to say when (thr_settle_judge) */
  THR_SETTLE_LATE   /* it stood where limit analysis proves that nothing holds it (thr_settle_judge) */
} thr_settle_status;

typedef struct {
  bool present;
  int status;                   /* thr_settle_status */
  double fall, error;           /* N: it began to fall, and that was seen, at fall + error / 2 and fall - error / 2; 0 if it did
                                   not, CREPT or LATE though it may be */
  int first_bead;               /* that moved; -1 if none */
  double gap_before, gap_after; /* mm, widest gap between two adjacent faces, settled and at the end */
  double drift;                 /* mm, largest movement while settling */
  double effort;                /* factor on the options' iterations with which this was found: 1 or 4 */
  int n_beads;
  double (*before)[7], (*after)[7]; /* [n_beads] position of the node (m, as thr_beads.centre) and rotation from the drawn
                                       position as a quaternion (x y z w) of each bead, settled and after the fall; owned */
} thr_settle;

/* n_beads above it: status TOO_LARGE, nothing else; large: where it is asked for, and takes many minutes. */
int thr_settle_largest(bool large);

/* A fall counts if it is known to a twentieth and not more than a twentieth above a pull at which an equilibrium exists (CREPT
 * otherwise) or below the one below which none does (LATE). Without a proof (least 0) it need not be known so well. What does not
 * count is told all the same. */
void thr_settle_judge(thr_settle *settle, double least, double equilibrium);

/* A cord's pass has tension x pull, but not more than most: [n_cords][n_passes] N each; most NULL: no such limit, cords are drawn
 * in; else they were drawn in and are let down, tension = what friction keeps of a force of 1 at the ends. Settles for 2, then
 * lets off the pull by 4 % in units of the time sqrt(mean edge / gravity), down to 0.7 of least; where nothing is proved, for 15
 * and then all of it: structures and their scale models behave alike. It falls when a bead moves by 0.005 of the mean edge within
 * half a unit; it began to when that was a tenth as much. NEVER_SETTLED: a bead moved by a twentieth of an edge at the start.
 * What does not count is tried once more with four times the linear systems and a 16th of the velocity that may be wrong. Same
 * input and seed, same bits on one machine. Some 1,500 steps of five linear systems: 49 beads 4 s, 400 beads
 * two minutes. THR_EINPUT for options out of range, THR_ELIMIT when stopped, both with out empty. */
thr_status thr_settle_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const double *const *tension, const double *const *most, const thr_physics *physics,
                          const thr_settle_options *options, const thr_limits *limits, thr_settle *out,
                          thr_err *err) THR_MUST_CHECK;
void thr_settle_destroy(thr_settle *settle);

#endif
