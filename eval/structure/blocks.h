/* The framework as rigid blocks, and the linear programme of their equilibrium (eval/structure/holding.h says what for). Private
 * to the limit analysis.
 *
 * Example: two beads merged into one body give six equations, not twelve. */
#ifndef THR_BLOCKS_H
#define THR_BLOCKS_H

#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "lp/solver/lp.h"
#include "lp/solver/solver.h"

#include <stdbool.h>

/* Beads from which on the solver's bounds need not be nearer to each other than THR_BLOCKS_ROUGH, relative; twice that where the
 * multipliers do not count. */
enum { THR_BLOCKS_LARGE = 1000 };
enum { THR_CORNERS = 4 }; /* contacts of a face, one after the other, faces before feet */
static const double THR_BLOCKS_ROUGH = 5e-4;
/* How far the equations are met then, in weights; and where only the multipliers count: their bound is proved by itself. */
static const double THR_BLOCKS_MET = 5e-6, THR_BLOCKS_UNMET = 1e-3;

typedef struct {
  int bead, other;          /* pushed along the rays of the friction pyramid; pushed back, -1 = the ground */
  double press;             /* N: its share of what the cords press its face with, as thr_blocks.press */
  double at[3], axis[3][3]; /* normal and tangents */
  double ray[THR_MOST_RAYS][3];
} thr_contact;

/* Bodies are beads, or sets of beads that move as one. Forces are counted in weights of a mean bead, lengths in `length`, the
 * pull in `pull`: numbers near 1 for the solver. */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double *press;         /* [n_faces] of a pull of 1; N where the load is asked for */
  const double (*load)[3];     /* [n_beads] N, at its node; NULL = none */
  thr_warm *warm;              /* where a large programme may start, and leaves a start for the next; NULL ok */
  bool bound;                  /* only the multipliers count */
  bool round;                  /* contact forces are within cones, not pyramids .. */
  double guess;                /* .. and N: a pull that is enough, not a thousand times too much */
  bool outside;                /* all that may be: cords anywhere within their bores, polygons round the discs of feet; else cords
                                  in the middle, and polygons inside */
  bool stretches;              /* the unknown is how much more tension than the least there is in the passes that b->rise tells,
                                  each newton at the cost of their lengths; the rest is given */
  bool carries;                /* the unknown is not the pull but what the load is multiplied by */
  double most;                 /* press above it is taken for it .. */
  bool merged;                 /* .. and the beads on either side for one body */
  const int *weld;             /* [n_beads] beads with equal numbers are one body (welds.h); NULL = none are */
  double weight, length, pull; /* N, m, N */
  double widen;                /* factor on friction */
  int n_bodies, n_contacts, n_rows, n_copies, n_ties, n_plays;
  int n_rises; /* passes whose tension is unknown: all of b->rise, or none. When stretched n_copies is 0 */
  thr_contact *contact;
  int *body;           /* [n_beads] */
  double (*origin)[3]; /* [n_bodies] where moments are taken about, m */
  double (*wrench)[6]; /* [n_bodies] of what is unknown: the cords at a pull of 1, or the load */
  double (*given)[6];  /* [n_bodies] of the other one; none of a pull that is unknown */
  int *row;            /* [n_bodies] first of a body's six rows, -1 = held in place */
  int *copy;           /* [n_bodies] of the pull that acts on it */
  int (*tie)[2];       /* [n_ties] copies that are equal */
  int *play;           /* [n_plays] faces that cords go through, not only in the middle */
  int *play_of;        /* [n_faces] which of these a face is, -1 = none */
  thr_scratch own;     /* the arrays */
} thr_blocks;

typedef struct {
  thr_lp_outcome outcome;
  double objective;
  double imbalance; /* largest violation of an equation, in weights */
  double *x;        /* columns */
  double *dual;     /* rows */
} thr_blocks_solution;

/* The factor on friction that puts the pyramids round the cones. */
double thr_blocks_widening(const thr_beads *beads);

/* Friction of a contact, widened. */
double thr_blocks_friction(const thr_blocks *s, const thr_contact *contact);

/* Do knotted cords tighten, within what they bear? */
bool thr_blocks_tightens(const thr_blocks *s);

/* Columns that the programme has for each of these passes, the first one what its tension has grown by. */
int thr_blocks_columns_of_a_rise(const thr_blocks *s);

/* Is the face within a body, or between two that are held? */
bool thr_blocks_inside(const thr_blocks *s, int face);

/* From s->b, f, physics, press, load, outside, stretches, carries, most, merged and weld; the rest is 0. widen: factor on
 * friction. s is freed on failure. */
thr_status thr_blocks_make(thr_blocks *s, double widen, thr_err *err) THR_MUST_CHECK;
void thr_blocks_destroy(thr_blocks *s);

/* The least pull, or the largest load, at which they are in equilibrium; with hands, that push and turn each bead at a cost, the
 * least of that cost. THR_ELIMIT when stopped. Release out whatever comes back. */
thr_status thr_blocks_solve(const thr_blocks *s, bool hands, const thr_limits *limits, thr_blocks_solution *out,
                            thr_err *err) THR_MUST_CHECK;

/* Contact forces that balance each other without any weight or cord, of one on the mean: hands that push and turn do what is
 * missing, at a cost. With the cost 0 they are a self-stress, x of each contact's rays; else the multipliers are velocities that
 * open every contact. Release out whatever comes back. */
thr_status thr_blocks_self_stress(const thr_blocks *s, const thr_limits *limits, thr_blocks_solution *out,
                                  thr_err *err) THR_MUST_CHECK;
void thr_blocks_solution_destroy(thr_blocks_solution *o);

#endif
