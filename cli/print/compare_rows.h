/* The table of `thread compare`: a row per value, a column per plan. */
#ifndef THR_COMPARE_ROWS_H
#define THR_COMPARE_ROWS_H

#include "cli/pull.h"
#include "eval/eval.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/text.h"

typedef struct {
  const char *path;
  thr_plan plan;
  thr_eval eval[THR_N_METHODS];  /* record.present only where the method ran and did not fail */
  double fall[2], fall_error[2]; /* N, in simulation at the settings given and with half the time step; NAN = did not fall, or
                                    never came to rest */
  bool contradicted;             /* that is said of the plan */
} compare_entry;

typedef struct {
  const char *label, *key;
  double (*value)(const compare_entry *); /* NAN = not known, INFINITY = beyond 1e300 */
  bool rate;                              /* less is better; rows that say what a plan is, not how good, mark nothing */
  int decimals;                           /* -1: whole number, -k: k significant digits */
  thr_method method;                      /* that must be wanted */
  bool optional;                          /* left out of the text where no plan has it */
  bool machinery;                         /* in the text only with --verbose: what proofs are made of */
} compare_row;

extern const compare_row compare_rows[];
extern const int compare_n_rows;

/* Largest pull by a method, N; NAN if a cord is not known. */
double compare_largest(const compare_entry *e, thr_method method);

/* Is row r of plan i the best of n? Within a millionth is a tie: both are. */
bool compare_is_best(const compare_entry *e, int n, const compare_row *r, int i);

/* Is plan i on the frontier: does no other plan beat it in cord, number of cords and pull (as measured, if every plan's is)? */
bool compare_on_frontier(const compare_entry *e, int n, int i);

/* Is row r in the text for n plans? */
bool compare_is_shown(const compare_entry *e, int n, const compare_row *r);

/* A space, 16 columns, and the mark of the best. */
void compare_put_cell(thr_text *text, const compare_row *r, double value, bool best);

#endif
