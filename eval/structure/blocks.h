/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of eval/structure/ share with each other and with nobody else: rigid blocks and
 * their programme (blocks.c), collapse mechanisms (mechanism.c), welds (welds.c), and rows of bars
 * (bar_motions.c). beads.h says in which order to read the files. */
#ifndef THR_BLOCKS_H
#define THR_BLOCKS_H

#include "eval/structure/beads.h"
#include "graph/plan/plan_measures.h"
#include "lp/solver/solver.h"

/* ---- blocks.c: The framework as rigid blocks, and the linear programme of their equilibrium
 * (eval/structure/holding.c says what for). */

/* Beads from which on the solver's bounds need not be nearer to each other than THR_BLOCKS_ROUGH,
 * relative; twice that where the multipliers do not count. */
enum { THR_BLOCKS_LARGE = 1000 };
static const double THR_BLOCKS_ROUGH = 5e-4;
/* How far the equations are met then, in weights; and where only the multipliers count: their bound
 * is proved by itself. */
static const double THR_BLOCKS_MET = 5e-6, THR_BLOCKS_UNMET = 1e-3;

/* Holds a contact: a corner of a face between two beads, or of a foot on the ground. */
typedef struct {
  int bead, other; /* pushed along the rays of the friction pyramid; pushed back, -1 = the ground */
  double press;    /* N: its share of what the cords press its face with, as thr_blocks.press */
  double at[3], axis[3][3]; /* normal and tangents */
  double ray[THR_MOST_RAYS][3];
} thr_contact;

/* Holds the blocks. Bodies are beads, or sets of beads that move as one. Forces are counted in
 * weights of a mean bead, lengths in `length`, the pull in `pull`: numbers near 1 for the solver.
 */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double *press;     /* [n_faces] of a pull of 1; N where the load is asked for */
  const double (*load)[3]; /* [n_beads] N, at its node; NULL = none */
  thr_warm *warm; /* where a large programme may start, and leaves a start for the next; NULL ok */
  bool bound;     /* only the multipliers count */
  bool round;     /* contact forces are within cones, not pyramids .. */
  double guess;   /* .. and N: a pull that is enough, not a thousand times too much */
  bool outside;   /* for a proved bound: cords anywhere within their bores, polygons round faces
                     and the discs of feet; else cords in the middle, and polygons inside */
  bool stretches; /* the unknown is how much more tension than the least there is in the passes that
                     b->rise tells, each newton at the cost of their lengths; the rest is given */
  bool carries;   /* the unknown is not the pull but what the load is multiplied by */
  double most;    /* press above it is taken for it .. */
  bool merged;    /* .. and the beads on either side for one body */
  const int *weld; /* [n_beads] beads with equal numbers are one body (welds.c); NULL = none are */
  double weight, length, pull; /* N, m, N */
  double widen;                /* factor on friction */
  int n_bodies, n_contacts, n_rows, n_copies, n_ties, n_plays;
  int n_rises; /* passes whose tension is unknown: all of b->rise, or none. When stretched n_copies
                  is 0 */
  thr_contact *contact; /* of a face one after the other, faces before feet */
  int *body;            /* [n_beads] */
  double (*origin)[3];  /* [n_bodies] where moments are taken about, m */
  double (*wrench)[6];  /* [n_bodies] of what is unknown: the cords at a pull of 1, or the load */
  double (*given)[6];   /* [n_bodies] of the other one; none of a pull that is unknown */
  int *row;             /* [n_bodies] first of a body's six rows, -1 = held in place */
  int *copy;            /* [n_bodies] of the pull that acts on it */
  int (*tie)[2];        /* [n_ties] copies that are equal */
  int *play;            /* [n_plays] faces that cords go through, not only in the middle */
  int *play_of;         /* [n_faces] which of these a face is, -1 = none */
  thr_scratch own;      /* the arrays */
} thr_blocks;

/* Holds a solution of the programme, and its multipliers. */
typedef struct {
  thr_lp_outcome outcome;
  double objective;
  double imbalance; /* largest violation of an equation, in weights */
  double *x;        /* columns */
  double *dual;     /* rows */
} thr_blocks_solution;

/* Returns the factor on friction that puts the pyramids round the cones. */
double thr_blocks_widening(const thr_beads *beads);

/* Returns the friction of a contact, widened. */
double thr_blocks_friction(const thr_blocks *blocks, const thr_contact *contact);

/* Returns whether knotted cords tighten, within what they bear. */
bool thr_blocks_tightens(const thr_blocks *blocks);

/* Returns the number of columns that the programme has for each of the passes of knotted cords; the
 * first one is what its tension has grown by. */
int thr_blocks_columns_of_a_rise(const thr_blocks *blocks);

/* Returns whether a face is within a body, or between two that are held. */
bool thr_blocks_inside(const thr_blocks *blocks, int face);

/* Makes the blocks from blocks->b, f, physics, press, load, outside, stretches, carries, most,
 * merged and weld; the rest is 0. widen: factor on friction. *blocks is freed on failure. */
thr_status thr_blocks_make(thr_blocks *blocks, double widen, thr_err *err) THR_MUST_CHECK;
void thr_blocks_destroy(thr_blocks *blocks);

/* Computes the least pull, or the largest load, at which the blocks are in equilibrium; with hands,
 * which push and turn each bead at a cost, the least cost. THR_ELIMIT when stopped. Release out
 * whatever comes back. */
thr_status thr_blocks_solve(const thr_blocks *blocks, bool hands, const thr_limits *limits,
                            thr_blocks_solution *out, thr_err *err) THR_MUST_CHECK;

/* Computes contact forces, of 1 on the mean, that balance each other without any weight or cord:
 * hands that push and turn do what is missing, at a cost. If the cost is 0, the forces are a
 * self-stress, x of each contact's rays; else the multipliers are velocities that open every
 * contact. Release out whatever comes back. */
thr_status thr_blocks_self_stress(const thr_blocks *blocks, const thr_limits *limits,
                                  thr_blocks_solution *out, thr_err *err) THR_MUST_CHECK;
void thr_blocks_solution_destroy(thr_blocks_solution *o);

/* ---- mechanism.c: Collapse mechanisms of rigid blocks: velocities of all beads, with which no
 * contact closes, and the powers of what acts on them. */

/* Holds the powers in a mechanism. */
typedef struct {
  double falling;    /* W, of the weights */
  double most;       /* W, of the weights if every bead went straight down, and of the loads without
                        their signs */
  double resistance; /* W/N, of the cords per newton of pull, by their true tensions */
  double load;       /* W, of the load */
  double all;        /* W, of the weights if every bead fell with the speed 1 */
  double all_loads;  /* W, of the loads if every node went along its load with the speed 1 */
} thr_powers;

/* What drives a mechanism has to be more than this part of all that could: twice what the checker
 * asks for, which counts the fastest point and not the fastest bead (graph/check/check_standing.c).
 */
static const double THR_MECHANISM_DRIVE = 2e-7;

/* Computes velocities [n_beads] from the dual values of thr_blocks_solve, scaled to a largest
 * translation of 1. Contacts that would close by rounding are opened by a little of a mechanism
 * that opens all. */
thr_status thr_mechanism_make(const thr_blocks *blocks, const double *dual,
                              const thr_limits *limits, double (*velocity)[6],
                              thr_err *err) THR_MUST_CHECK;

/* Returns the least power of any contact force: a mechanism has none below 0. */
double thr_mechanism_opening(const thr_blocks *blocks, const double (*velocity)[6]);

/* Returns how fast the beads of a face part along its axis, where within its bore the cord resists
 * most. */
double thr_mechanism_parting(const thr_blocks *blocks, const double (*velocity)[6], int face);

/* Computes how fast the faces of blocks->b->rise part, as above, into apart[n_rises]. Returns the
 * most for each metre of the cord there, or 0: the most that a newton metre of stretch resists,
 * 1/m. */
double thr_mechanism_stretching(const thr_blocks *blocks, const double (*velocity)[6],
                                double *apart);

/* Computes what knotted cords can resist beyond their least tensions (graph/plan/knotted.c), W,
 * within their strength and while they have stretched by no more than `stretch`, N m (INFINITY:
 * any), of which each newton metre takes off `resists`. apart[n_rises] as above; pass[n_rises] and
 * point[n_rises + 2] are scratch. */
double thr_mechanism_tightening(const thr_beads *beads, const double *apart, double resists,
                                double stretch, thr_knotted_pass *pass, double (*point)[2]);

/* Computes the powers of weights, cords and load. */
thr_powers thr_mechanism_balance(const thr_blocks *blocks, const double (*velocity)[6]);

/* Returns the lowest bead among the fastest, or -1 if none moves. */
int thr_mechanism_fastest(const thr_beads *beads, const double (*velocity)[6]);

/* ---- welds.c: Welds: what held feet wedge. */

/* Computes weld[n_beads]: the lowest bead of the body that each bead belongs to. *blocks is as for
 * thr_blocks_make. */
thr_status thr_welds_find(const thr_blocks *blocks, double widen, const thr_limits *limits,
                          int *weld, thr_err *err) THR_MUST_CHECK;

/* ---- bar_motions.c: rows of the rigidity matrix, and motions without those of rigid pieces. */

/* Adds to row[3 * n_nodes] how fast the cord gets longer per velocity of each node that is not
 * held. */
void thr_bars_cord_row(const thr_bars *bars, const thr_cord *cord, double *row);

/* Takes the motions of rigid pieces out of a motion, unless nodes are held, and scales it to length
 * 1. */
thr_status thr_bars_without_rigid(const thr_bars *bars, double (*velocity)[3],
                                  thr_err *err) THR_MUST_CHECK;

#endif
