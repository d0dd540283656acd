/* What `thread eval` found out about a plan, in the form that is kept in plan.json: the eval methods fill it, drawings show it,
 * the checker verifies that it is consistent with the plan. */
#ifndef THR_EVALUATION_H
#define THR_EVALUATION_H

#include "graph/plan/physics.h"
#include "graph/plan/pulled.h"
#include "graph/plan/standing.h"

typedef enum { THR_CAPSTAN, THR_JOINT, THR_STRUCTURE, THR_N_METHODS } thr_method;
typedef enum {
  THR_LAW_CAPSTAN, /* T_out = T_in exp(mu theta) */
  THR_LAW_MITRE,   /* thesis, Fig. 13: a mitred bead takes mu T_out sin(theta / 2) off the tension */
  THR_N_LAWS
} thr_law;

/* One thing that is done to a cord (graph/plan/schedule.h). */
typedef enum { THR_DEED_PULL, THR_DEED_GRIP, THR_DEED_RELEASE, THR_DEED_KNOT, THR_DEED_NONE, THR_N_DEEDS } thr_deed;
typedef struct {
  thr_deed deed;
  int cord;
  thr_pull end;       /* of pull, release and knot: which end(s). Of a grip: from which side(s) the cord is drawn. Never none */
  int pass;           /* of a grip, counted from 0 */
  double force;       /* N; of a knot 0 */
  double slip;        /* of a knot, mm of cord that it gives back; else 0 */
  const char *remark; /* what its giver may not have meant, or NULL; not in plans */
} thr_schedule_step;
typedef struct {
  int n, room;
  thr_schedule_step *step; /* owned */
} thr_schedule;

typedef struct {
  bool known;          /* false: stopped before all of this cord's joints were measured; the rest is then 0 and tension NULL */
  thr_pull pull;       /* which end(s) are pulled */
  int n_passes;        /* of the cord */
  double turning;      /* rad, nominal: through the bead centres; without a closed cord's closing turn */
  double taut_turning; /* rad, of the path that the tight cord takes in its bores; capstan and structure: = turning */
  double force;        /* N at the pulled end; with both ends pulled, at the one that needs more; after a schedule its largest */
  double other_force;  /* N at the other end with both pulled, else 0 */
  double loss;         /* friction loss 1 - tension[slackest] / force */
  double work;         /* J per metre of cord drawn out at every pulled end: force (+ other_force) x 1 m */
  double error;        /* the force is right within a factor exp(+-error) but for what refused turns add; 0 for closed forms */
  int slackest;        /* pass with the least tension, counted from 0 */
  int refused;         /* turns not measured (too sharp, out of range, unsteady): the closed form stands in for them */
  double *tension;     /* [n_passes] N; after a schedule the least that may be in them; owned */
  double *most;        /* [n_passes] N that may be in them where a schedule leaves that open, or NULL; owned */
  double *turn; /* [n_passes - 1] rad: of the tight cord, where method structure counts those; else NULL; owned, not in plans */
  double *exponent; /* [n_passes - 1] ln of the ratio of the tensions that a turn holds apart, or NULL; in the plan only with
                       a schedule or turns of the tight cord (thr_standing); owned */
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
  bool seated_known;            /* false: seated is not stated, since not every cord is known or an older version wrote it */
  double seated;                /* part of the gaps that is seated (graph/plan/seating.h), 0 to 1 */
  thr_schedule schedule;        /* after which the tensions are what they are; empty: at the end of a pull */
  thr_standing standing;        /* of method structure: what acts on it, and what was proved; an older version wrote none */
} thr_evaluation;

const char *thr_method_name(int m); /* "capstan", "joint", "structure" */
const char *thr_law_name(int l);    /* "capstan", "mitre" */

/* Returns the cord that needs the largest force at an end, the first of several; there is at least one. */
const thr_eval_cord *thr_evaluation_hardest(const thr_evaluation *evaluation);

/* Largest and total from the cords; those that are not known count as 0. */
void thr_evaluation_sum(thr_evaluation *evaluation);
void thr_evaluation_destroy(thr_evaluation *evaluation);

/* Does the plan state the exponents of every cord, which then cannot be worked out again from the law or belong to a schedule? */
bool thr_evaluation_exponents(const thr_evaluation *evaluation);

/* Least and largest tension of any pass, N; after a schedule the least of those that have any. False, and both 0, if no cord is
 * known. */
bool thr_evaluation_range(const thr_evaluation *evaluation, double range[2]);

/* Colour of a tension: a perceptually even, colour-blind safe ramp over the logarithm of range, pale = slack, dark = tight.
 * Out of range: the nearer end; a range of one value: pale. "#rrggbb". O(1). */
void thr_tension_colour(const double range[2], double tension, char hex[8]);

/* The member "evaluation" of plan.json, written after "metrics". */
void thr_evaluation_write(const thr_evaluation *evaluation, thr_writer *writer, const char *key);
/* Reads it with its shape checked: known members only, one record per cord with its id, finite numbers, tensions of 0 or more,
 * one colour per tension, scale and colours as they follow from the tensions. place names file and member for messages;
 * THR_EVIOLATED. n_passes is that of the tension list, 0 for a cord that is not known: the reader of the plan compares and fills
 * it in. thr_check_plan verifies the rest: forces, losses, slackest pass and sums from the tensions, no fall towards a pulled
 * end, turning and (method capstan) every tension from the cords. Release with thr_evaluation_destroy. O(passes). */
thr_status thr_evaluation_from_json(thr_evaluation *evaluation, const thr_json *object, const char *place,
                                    thr_err *err) THR_MUST_CHECK;

#endif
