/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What eval/ found about a plan, as plan.json has it: tensions in N by pass, forces at the ends,
 * the schedule after which they hold, and the proofs of a limit analysis. */
#ifndef THR_EVALUATION_H
#define THR_EVALUATION_H

#include "graph/arrays.h"
#include "graph/plan/physics.h"

/* ---- Pieces as they are made, which kit/ measures and eval/ takes instead of its ideal ones. */

enum { THR_MOST_CORNERS = 16 };

/* What the limit analysis needs of pieces that are made: masses, faces and feet. {0} is valid and
 * empty. Release with thr_scratch_free(&own). */
typedef struct {
  double *mass;        /* [n_nodes] g */
  double (*centre)[3]; /* [n_nodes] mm: of the mass, from the node */
  double (*foot)[2]; /* [n_nodes] mm: radius of the base, and how far it is below the node; 0 where
                        the piece has none */
  double *width;     /* [n_edges] mm, of the face */
  double *play;      /* [n_edges] mm: how far from the middle of the face a cord may be */
  double (*up)[3];   /* [n_edges] unit, in the face: the outline's first coordinate */
  int n_corners;     /* of the convex hull of a face, as a polygon .. */
  double outline[2][THR_MOST_CORNERS][2]; /* .. [0] inside it and [1] round it, in halves of the
                                             width, in order round the edge */
  thr_scratch own;                        /* the arrays */
} thr_bodies;

/* ---- standing.c: What the limit analysis found of a structure, in the form that is kept in
 * plan.json: what acts on it, what was asked, and the mechanisms that prove the answers. */

/* What may be unknown: a pull of the cords, a factor on the tensions after a schedule, or a
 * multiple of the load. */
typedef enum {
  THR_ASKED_HOLDING,   /* pull at the harder end of each cord while the cords are drawn in */
  THR_ASKED_EQUAL,     /* pull at all ends, the same, while the cords are drawn in */
  THR_ASKED_ANY_STATE, /* force at all ends in any state that friction keeps */
  THR_ASKED_AFTER,     /* factor on the tensions that the schedule leaves */
  THR_ASKED_LOADED,    /* pull at all ends while the cords are drawn in, with the load */
  THR_ASKED_CARRIED,   /* multiple of the load at a given pull of all ends while the cords are drawn
                          in */
  THR_ASKED_CARRIED_AFTER, /* multiple of the load with the tensions that the schedule leaves */
  THR_ASKED_STRETCH,  /* N m by which knotted cords have to stretch beyond the tensions that the
                         schedule leaves */
  THR_ASKED_TIGHTEST, /* N that some pass of a knotted cord has to have after the schedule */
  THR_N_ASKED
} thr_asked;

typedef struct {
  thr_asked asked;
  double pull;    /* N at all ends, of CARRIED; else 0 */
  double proved;  /* below it, or above it if a load is asked for, there is no equilibrium; 0, or
                     INFINITY: nothing is proved */
  double found;   /* at it the solver found an equilibrium; INFINITY: it found none */
  double resists; /* 1/m, of STRETCH: the price of a newton metre by which it is proved; -1: the
                     most that any face parts by */
  int n_beads;    /* that move in the mechanism, all of the framework; 0 if nothing is proved */
  double (*velocity)[6]; /* [n_beads] that proves it: translation of the mass centre, rotation
                            (1/m); owned */
} thr_answer;

typedef struct {
  int node;
  double force[3]; /* N */
} thr_load;

/* How a cord is drawn in, which a schedule does not say: which ends (a thr_pull), and its slackest
 * pass then. */
typedef struct {
  int pull, slackest;
} thr_drawn;

enum { THR_STANDING_MODEL = 2 };

typedef struct {
  bool present;
  int model; /* of bodies and cords: THR_STANDING_MODEL, or 1: square feet, cords in the middle of
                their bores */
  bool clamped;         /* the feet are held; else they stand on the ground */
  bool taut;            /* turns are those of the tight cord, and each cord states its exponents */
  double tilt, azimuth; /* rad: of the ground, and where it goes down (from x towards y) */
  double strength;      /* N: no pass of a knotted cord bears more; 0: any tension */
  double let_down; /* N: to which all ends can be let down after the schedule; NAN: was not asked */
  int n_loads, n_cords, n_answers;
  thr_load *load;     /* [n_loads] owned */
  thr_drawn *drawn;   /* [n_cords] owned */
  thr_answer *answer; /* [n_answers] owned */
} thr_standing;

const char *thr_asked_name(int asked);   /* "holding", "equal", .. as in plan.json */
bool thr_asked_of_load(thr_asked asked); /* is a multiple of the load what is unknown? */
bool thr_asked_after(thr_asked asked);   /* is it about the tensions that a schedule leaves? */

void thr_standing_destroy(thr_standing *standing);

/* The member "structure" of an evaluation, and reading it: shapes and ranges; nodes and numbers of
 * beads are compared with the framework by the checker. THR_EVIOLATED with place. */
void thr_standing_write(const thr_standing *standing, thr_writer *writer, const char *key);
thr_status thr_standing_from_json(thr_standing *standing, const thr_json *object, int n_cords,
                                  const char *place, thr_err *err) THR_MUST_CHECK;

/* ---- evaluation.c: What `thread eval` found out about a plan, in the form that is kept in
 * plan.json: the eval methods fill it, drawings show it, the checker verifies that it is consistent
 * with the plan. */

typedef enum { THR_CAPSTAN, THR_JOINT, THR_STRUCTURE, THR_N_METHODS } thr_method;
typedef enum {
  THR_LAW_CAPSTAN, /* T_out = T_in exp(mu theta) */
  THR_LAW_MITRE, /* thesis, Fig. 13: a mitred bead takes mu T_out sin(theta / 2) off the tension */
  THR_N_LAWS
} thr_law;

/* One thing that is done to a cord (graph/plan/plan.h). */
typedef enum {
  THR_DEED_PULL,
  THR_DEED_GRIP,
  THR_DEED_RELEASE,
  THR_DEED_KNOT,
  THR_DEED_NONE,
  THR_N_DEEDS
} thr_deed;
typedef struct {
  thr_deed deed;
  int cord;
  thr_pull end;  /* of pull, release and knot: which end(s). Of a grip: from which side(s) the cord
                    is drawn. Never none */
  int pass;      /* of a grip, counted from 0 */
  double force;  /* N; of a knot 0 */
  double slip;   /* of a knot, mm of cord that it gives back; else 0 */
  bool together; /* of one "all" with the step before: at the same time; not in plans */
  const char *remark; /* what its giver may not have meant, or NULL; not in plans */
} thr_schedule_step;
typedef struct {
  int n, room;
  thr_schedule_step *step; /* owned */
} thr_schedule;

typedef struct {
  bool known; /* false: stopped before all of this cord's joints were measured; the rest is then 0
                 and tension NULL */
  thr_pull pull;  /* which end(s) are pulled */
  int n_passes;   /* of the cord */
  double turning; /* rad, nominal: through the bead centres; without a closed cord's closing turn */
  double taut_turning; /* rad, of the path that the tight cord takes in its bores; capstan and
                          structure: = turning */
  double force; /* N at the pulled end; with both ends pulled, at the one that needs more; after a
                   schedule its largest */
  double other_force; /* N at the other end with both pulled, else 0 */
  double loss;        /* friction loss 1 - tension[slackest] / force */
  double work;  /* J per metre of cord drawn out at every pulled end: force (+ other_force) x 1 m */
  double error; /* the force is right within a factor exp(+-error) but for what refused turns add; 0
                   for closed forms */
  int slackest; /* pass with the least tension, counted from 0 */
  int refused;  /* turns not measured (too sharp, out of range, unsteady): the closed form stands in
                   for them */
  double *tension; /* [n_passes] N; after a schedule the least that may be in them; owned */
  double *
      most; /* [n_passes] N that may be in them where a schedule leaves that open, or NULL; owned */
  double *turn; /* [n_passes - 1] rad: of the tight cord, where method structure counts those; else
                   NULL; owned, not in plans */
  double *exponent; /* [n_passes - 1] ln of the ratio of the tensions that a turn holds apart, or
                       NULL; in the plan only with a schedule or turns of the tight cord
                       (thr_standing); owned */
} thr_eval_cord;

typedef struct {
  bool present;
  thr_method method;
  thr_law law;                  /* of method capstan */
  thr_physics physics;          /* resolved */
  uint64_t seed;                /* of a simulation's small initial disorder */
  double time_step, iterations; /* factors on the validated protocol's */
  int n_cords;                  /* = the plan's */
  thr_eval_cord *cord;          /* owned */
  double largest;               /* N: largest force at any pulled end */
  double total;                 /* N: sum over all pulled ends */
  bool seated_known; /* false: seated is not stated, since not every cord is known or an older
                        version wrote it */
  double seated;     /* part of the gaps that is seated (graph/plan/seating.c), 0 to 1 */
  thr_schedule
      schedule; /* after which the tensions are what they are; empty: at the end of a pull */
  thr_standing standing; /* of method structure: what acts on it, and what was proved; an older
                            version wrote none */
} thr_evaluation;

const char *thr_method_name(int m); /* "capstan", "joint", "structure" */
const char *thr_law_name(int l);    /* "capstan", "mitre" */

/* Returns the cord that needs the largest force at an end, the first of several; there is at least
 * one. */
const thr_eval_cord *thr_evaluation_hardest(const thr_evaluation *evaluation);

/* Largest and total from the cords; those that are not known count as 0. */
void thr_evaluation_sum(thr_evaluation *evaluation);
void thr_evaluation_destroy(thr_evaluation *evaluation);

/* Least and largest tension of any pass, N; after a schedule the least of those that have any.
 * False, and both 0, if no cord is known. */
bool thr_evaluation_range(const thr_evaluation *evaluation, double range[2]);

/* Colour of a tension: a perceptually even, colour-blind safe ramp over the logarithm of range,
 * pale = slack, dark = tight. Out of range: the nearer end; a range of one value: pale. "#rrggbb".
 * O(1). */
void thr_tension_colour(const double range[2], double tension, char hex[8]);

/* The member "evaluation" of plan.json, written after "metrics". */
void thr_evaluation_write(const thr_evaluation *evaluation, thr_writer *writer, const char *key);
/* Reads it with its shape checked: known members only, one record per cord with its id, finite
 * numbers, tensions of 0 or more, one colour per tension, scale and colours as they follow from the
 * tensions. place names file and member for messages; THR_EVIOLATED. n_passes is that of the
 * tension list, 0 for a cord that is not known: the reader of the plan compares and fills it in.
 * thr_check_plan verifies the rest: forces, losses, slackest pass and sums from the tensions, no
 * fall towards a pulled end, turning and (method capstan) every tension from the cords. Release
 * with thr_evaluation_destroy. O(passes). */
thr_status thr_evaluation_from_json(thr_evaluation *evaluation, const thr_json *object,
                                    const char *place, thr_err *err) THR_MUST_CHECK;

#endif
