/* A plan of the least turning beside its lower bound, the other end of the trade-off and the shortest plan. */
#ifndef THR_CLI_TURNING_SUMMARY_H
#define THR_CLI_TURNING_SUMMARY_H

#include "cli/cli.h"
#include "tortuosity/tortuosity.h"

/* A plan that another is held against. */
typedef struct {
  const char *title, *key; /* of its column; of its JSON member */
  bool made;
  thr_plan plan;
  thr_err why; /* if it is not made */
} turning_rival;

typedef struct {
  turning_rival corner; /* the least turning among the shortest, or of any length; of a classical tour: the least turning */
  turning_rival length; /* of the objective length */
  thr_frontier frontier;
} turning_rivals;

/* Makes them until deadline (thr_clock(); 0 = none, but the frontier has the time limit of the plan once more): the shortest plan
 * where it takes no search; optima: that in any case, and the corner, which is a search as long as the plan's own; and a frontier
 * of that many points (0 = none). Returns EXIT_OK, also where there is no such plan (why says so); or prints and returns the
 * code, with out holding what was made. Release with turning_rivals_destroy. */
int turning_rivals_make(const thr_plan *p, bool optima, int frontier, double deadline, turning_rivals *out);
void turning_rivals_destroy(turning_rivals *r);

static const double turning_right_angle = 1.57079632679489661923;

/* Factor on the tension over that much turning (rad): exp(mu * turning), INFINITY beyond 1e300. */
double turning_capstan(double mu, double turning);

/* Largest pull of a plan by the closed form, times the tension at the slackest point: INFINITY beyond 1e300, NAN if not known.
 * cord (NULL or [n_cords]) receives that of each. */
double turning_pull(const thr_plan *p, double *cord);

/* "65.9 x", "1.2e+34 x", "> 1e300 x"; "-" for NAN. */
const char *turning_factor(double value, char out[24]);

/* What is proved of the turning; then the table; then the frontier, if there is one. */
void turning_put_status(thr_text *t, const thr_plan *p, const turning_rivals *r);
void turning_put_table(thr_text *t, const thr_plan *p, const turning_rivals *r);
void turning_put_frontier(thr_text *t, const thr_plan *p, const turning_rivals *r);

/* All of that as members of an object, each with a comma before it. */
void turning_put_json(thr_text *t, const thr_plan *p, const turning_rivals *r);

#endif
