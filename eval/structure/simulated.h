/* The closed structure as a world of Bullet: rigid beads that touch at the corners of their faces, feet on patches of ground,
 * cords as forces between beads. Private to the simulations (settle.h, erect.h).
 *
 * Inside, the mean edge is 1 long, the mean bead weighs 1 and gravity is 1: so a structure and its scale model give the same
 * numbers, and a time of 1 is what a bead takes to fall half an edge. */
#ifndef THR_SIMULATED_H
#define THR_SIMULATED_H

#include "eval/joint/world.h"
#include "eval/structure/beads.h"
#include "graph/limits.h"

enum { THR_LOOKS = 10 }; /* that are remembered */

typedef struct {
  double at[3], turn[3][3];
} thr_placed; /* a bead's mass centre and rotation matrix */

typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const thr_limits *limits;
  thr_world *world;
  const thr_cord *cord;
  int n_cords;
  const double *const *tension, *const *most; /* N, of a pull of 1 N */
  double unit, mass, weight;                  /* m per unit of length; kg and N of a mean bead */
  double dt;
  long steps, all;   /* taken; in all, at most */
  double pull;       /* N, on the cords' ends */
  double lift;       /* part of the weights that is carried from above */
  bool leans;        /* cords lead from hole to hole, not along axes */
  double *press;     /* [n_faces] sum of its passes' tensions */
  int *body;         /* [n_beads] in the world */
  thr_placed *now;   /* [n_beads] */
  double (*home)[3]; /* [n_beads] node when settled */
  double (*seen)[3]; /* [THR_LOOKS * n_beads] nodes at the last looks */
  thr_scratch own;   /* the arrays */
} thr_simulated;

typedef struct {
  double time_step, iterations; /* factors on the protocol's, 1 */
  uint64_t seed;                /* of small initial displacements */
} thr_simulated_options;

/* m has b, f, physics, limits, cord, n_cords, tension and most; the rest is 0. End it whatever comes back. */
thr_status thr_simulated_begin(thr_simulated *m, thr_err *err) THR_MUST_CHECK;
void thr_simulated_end(thr_simulated *m);

/* A fresh world as drawn, which is home; the old one goes. */
thr_status thr_simulated_build(thr_simulated *m, const thr_simulated_options *options, thr_err *err) THR_MUST_CHECK;
/* At m->pull and m->lift. THR_ELIMIT when stopped. */
thr_status thr_simulated_step(thr_simulated *m, thr_err *err) THR_MUST_CHECK;
/* Part of the velocity that is lost in a unit of time. */
void thr_simulated_damp(const thr_simulated *m, double damping);
long thr_simulated_steps(const thr_simulated *m, double time);

/* Home is where the beads are now. */
void thr_simulated_set_home(thr_simulated *m);
/* How far the bead that moved most is from home, in edges. */
double thr_simulated_most_moved(const thr_simulated *m, int *bead);
/* How far the bead that moved most has moved within the last THR_LOOKS looks, of which this is the next; 0 before so many. */
double thr_simulated_moved_lately(thr_simulated *m, long look, int *bead);
/* Widest opening of any face, at its corners, in edges. */
double thr_simulated_widest_gap(const thr_simulated *m);
/* Faces that open nowhere by so many edges. */
int thr_simulated_closed(const thr_simulated *m, double gap);
/* pose[n_beads]: node in m, rotation from the drawn position as a quaternion (x y z w). */
void thr_simulated_take_poses(const thr_simulated *m, double (*pose)[7]);

#endif
