/* A plan of the least turning beside its lower bound, the other end of the trade-off and the shortest plan. */
#ifndef THR_CLI_TURNING_SUMMARY_H
#define THR_CLI_TURNING_SUMMARY_H

#include "cli/cli.h"
#include "eval/eval.h"
#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/text.h"
#include "planner/planner.h"

static const double turning_right_angle = 1.57079632679489661923;

/* Factor on the tension over that much turning (rad): exp(mu * turning), INFINITY beyond 1e300. */
double turning_capstan(double mu, double turning);

/* Evaluates a plan by the closed form, pulled at both ends until so many N are left where it is slackest. Returns false if the
 * pulls are more than a number holds. Release with thr_eval_destroy. */
bool turning_seat(const thr_plan *plan, double seating, thr_eval *eval);

/* Appends what the other end of the hardest cord takes, "other_pull", and what holding does, "holds_from" (seated.h). */
void turning_put_ends_json(thr_writer *writer, const thr_plan *plan);

/* Largest pull of a plan by the closed form, times the tension at the slackest point: INFINITY beyond 1e300, NAN if not known.
 * cord (NULL or [n_cords]) receives that of each. */
double turning_pull(const thr_plan *plan, double *cord);

/* N at the hardest end of the cords of a point of the frontier, at that friction; INFINITY beyond 1e300. */
double turning_point_pull(const thr_plan *plan, const thr_frontier_point *point, double mu);

/* "65.9 x", "1.2e+34 x", "> 1e300 x"; "-" for NAN. */
const char *turning_factor(double value, char out[24]);

/* What is proved of the turning; then the table; then the frontier, if there is one. */
void turning_put_status(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_table(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_frontier(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);

/* All of that as members of an object, each with a comma before it. */
void turning_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals);

#endif
