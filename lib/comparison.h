/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares plans of one framework: values, best ones, rankings; for `thread compare` and libthread.
 *
 * A value of a plan is an interval: a measured pull has a relative error, a limit analysis proves a
 * lower and finds an upper pull. Read compare_rows.c first (a value for each plan), then ranking.c
 * and compare_rankings.c (a ranking for each question). */
#ifndef THR_COMPARISON_H
#define THR_COMPARISON_H

#include "eval/eval.h"
#include "eval/rise/rise.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/status.h"
#include "graph/text.h"

/* What plans are compared by beside a thr_method: rising in simulation, or all that compute a pull.
 */
enum { THR_BY_RISE = THR_N_METHODS, THR_BY_ALL };

/* Returns whether `method` is among those that were asked for, a method or one of the two above.
 * The closed form always is. */
bool thr_compare_wants(int asked, int method);

/* ---- ranking.c: Ranks plans by a value of which only an interval is known. */

/* The bands: of the friction of the cords (0), and of that of beads and ground (1). Their names are
 * members in JSON. */
enum { THR_RANKING_BANDS = 2, THR_RANKING_ENDS = 2 * THR_RANKING_BANDS, THR_RANKING_WORDS = 240 };
extern const char *const thr_ranking_bands[THR_RANKING_BANDS];

/* Values from here on only put plans with words in an order. */
static const double thr_ranking_order = 1e7;

/* Plans in the order of a value, the least first or the most. The rank of a plan is 1 and one more
 * for every plan that is surely less, whose interval ends before that of the plan begins. Two plans
 * tie if their intervals overlap; a third plan between them changes nothing. thr_ranking_make fills
 * in order and rank from value, low and high; plans of one rank stand in the order of their values.
 */
typedef struct {
  const char *title; /* "simulated seating pull" */
  const char *key;   /* in JSON: "joint" */
  const char *unit;  /* " N", or "" for a bare number */
  const char *open;  /* what to say of a plan without an upper end; NULL = nothing */
  bool most;  /* most first: value, low and high are then negative, and printed without the sign */
  bool error; /* print the interval as +- percent, else as from .. to */
  char (*words)[THR_RANKING_WORDS]; /* [n] said of plan i instead of its value; NULL: nothing; owned
                                     */
  int n, n_ranked;                  /* plans, and how many of them have a rank */
  double *end[THR_RANKING_ENDS]; /* [n] values at the ends of the bands of friction, in the order of
                                thr_ranking_bands; NAN = not known;  owned */
  double *value, *low, *high; /* [n] of plan i; value NAN = not known, not ranked; INFINITY = proved
                                 that there is none; high INFINITY = no upper end; owned */
  int *order;                 /* [n_ranked] plans; owned */
  int *rank;                  /* [n] 1, 2, .. of plan i, 0 = not ranked; owned */
} thr_ranking;

/* Allocates a ranking of n plans, none of which is known. Title, unit and the like stay as they
 * are. On failure the ranking is empty. Release with thr_ranking_destroy. */
thr_status thr_ranking_init(thr_ranking *r, int n, thr_err *err) THR_MUST_CHECK;
void thr_ranking_destroy(thr_ranking *r);

/* Computes ranks and order. O(n^2). */
void thr_ranking_make(thr_ranking *r);

/* Returns whether not all plans are tied. */
bool thr_ranking_tells_apart(const thr_ranking *r);

/* Returns whether the intervals of plans i and k overlap. */
bool thr_ranking_is_tie(const thr_ranking *r, int i, int k);

/* Appends a line per plan: "1. lines.json  12.3 N (+-0.4 %)", and whether it is more than those
 * before, or with which of them it ties. name[n]. */
void thr_ranking_put_text(const thr_ranking *r, const char *const *name, thr_text *text);

/* Appends for each band whether plans that are not tied stay in this order at both of its ends, or
 * which change places. at[2 * band + end] are the words for an end: "mu 0.1", or "the lower end of
 * mu" where plans have bands of their own. */
void thr_ranking_put_bands(const thr_ranking *r, const char *const *name,
                           char at[THR_RANKING_ENDS][40], thr_text *text);

/* Writes the ranking as an object. */
void thr_ranking_put_json(const thr_ranking *r, const char *const *name, thr_writer *writer);

/* Finds a pair of plans that two rankings put in opposite orders, beyond what their intervals
 * allow. Returns false if there is none. */
bool thr_ranking_disagree(const thr_ranking *a, const thr_ranking *b, int pair[2]);

/* ---- compare_rows.c: The table of `thread compare`: a row per value, a column per plan. */

enum { THR_COMPARE_ROWS = 40 };

/* What was seen of a plan that rises in simulation, over several runs. */
typedef struct {
  int runs, up, fell; /* that were seen; of these, that came up; of these, that fell at last */
  int faces;
  double pull[3], closed[3],
      fall[3];     /* least, middle and largest: N at which those came up; faces that were closed at
                      most in each run; N below which those fell that did */
  double stands;   /* N, by the limit analysis of the same pieces; NAN: not known */
  char jam[2][48]; /* pieces between which the widest gap stayed in .. */
  int jams;        /* .. so many of the runs that did not come up; 0: none is known */
  thr_err why;     /* code 0, or why nothing, or not all, was seen */
} thr_compare_rise;

/* A plan with all that was found about it. */
typedef struct {
  const char *path;
  thr_plan plan;
  thr_eval eval[THR_N_METHODS];   /* record.present only where the method ran and did not fail */
  thr_compare_rise rise;          /* 0 where none was asked for */
  double value[THR_COMPARE_ROWS]; /* of each row; NAN = not known, INFINITY = beyond 1e300 */
} thr_compare_entry;

/* A row of the table. */
typedef struct {
  const char *label, *key;
  bool rate;      /* less is better; rows that say what a plan is, not how good, mark nothing */
  int decimals;   /* -1: whole number, -k: k significant digits */
  int method;     /* that must be wanted: thr_method or THR_BY_RISE */
  bool optional;  /* left out of the text where no plan has it */
  bool machinery; /* in the text only with --verbose: what proofs are made of */
} thr_compare_row;

extern const thr_compare_row thr_compare_rows[THR_COMPARE_ROWS];

/* Fills in the values of all rows from the plan and its evaluations. */
void thr_compare_measure(thr_compare_entry *entry);

/* Returns the largest pull by a method, N; of method structure the proved lower bound of the
 * holding pull. NAN if a cord is not known. */
double thr_compare_largest(const thr_compare_entry *e, thr_method method);

/* Returns whether plan i is the best of n plans in a row. Values within a millionth tie: both are.
 */
bool thr_compare_is_best(const thr_compare_entry *e, int n, int row, int i);

/* Returns what plan i of n costs: its pull is the measured one if that of every plan is known, else
 * that of the closed form. */
thr_price thr_compare_price(const thr_compare_entry *e, int n, int i);

/* Returns whether plan i is on the frontier: no other plan beats its price. */
bool thr_compare_on_frontier(const thr_compare_entry *e, int n, int i);

/* ---- compare_rankings.c: A ranking for each question that was asked of the plans. */

enum { THR_COMPARE_RANKINGS = 9 };

/* Fills `rankings` with those of the wanted methods and *count with their number. On failure the
 * rankings so far, and the one that failed, can be released. */
thr_status thr_compare_rank(int method, const thr_compare_entry *entries, int n,
                            thr_ranking *rankings, int *count, thr_err *err) THR_MUST_CHECK;

/* compare_rises.c: Fills in value, interval and words of a ranking of what comes up in simulation.
 */
thr_status thr_compare_rank_rises(thr_ranking *ranked, const thr_compare_entry *entries,
                                  thr_err *err) THR_MUST_CHECK;

/* Returns whether no two rankings contradict each other: ties do not. */
bool thr_compare_agree(const thr_ranking *rankings, int count);

/* Appends whether the rankings agree. If all of them are about the pull while cords are drawn in,
 * agreement says little, and the sentence says so. */
void thr_compare_put_agreement(const thr_ranking *rankings, int count, const char *const *name,
                               thr_text *text);

/* ---- compare_take.c: Which of several plans to take, and why. */

/* Returns which of n plans to take by a method that was asked for; `without` is left out, -1:
 * none. At least one plan must be left. */
int thr_compare_take(const thr_compare_entry *entries, int n, int method, int without);

/* Appends why that plan is to be taken rather than the next best one, of n >= 2. Returns whether
 * they differ. */
bool thr_compare_put_why(const thr_compare_entry *entries, int n, int method, thr_text *text);

/* ---- compare_rise.c: Lets the structures that are compared rise. */

/* What is asked of the runs. */
typedef struct {
  int seeds; /* of each plan, at most THR_RISE_MOST_SEEDS */
  thr_rise_start start;
  bool let_down;
  uint64_t seed;    /* of the first run of each */
  double pull;      /* N, the most that hands pull every end with */
  double time_step; /* factor */
  int processes;
} thr_compare_rise_asked;

/* Lets every plan rise so many times, and fills in entry[n].rise; where that fails for a plan, its
 * values stay unknown, and rise.why says so. THR_ELIMIT: stopped, with what was seen by then. */
thr_status thr_compare_rises(thr_compare_entry *entry, int n, const thr_compare_rise_asked *asked,
                             const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* ---- compare_json.c: The comparison as JSON. */

/* Checks that a plan is for the framework of the first one, whose feet may be other nodes; else
 * THR_EINPUT, by the plans' paths. */
thr_status thr_compare_framework(const thr_compare_entry *entry, const thr_compare_entry *first,
                                 thr_err *err) THR_MUST_CHECK;

/* Returns whether two plans were evaluated with the same cord and beads. */
bool thr_compare_same_physics(const thr_compare_entry *one, const thr_compare_entry *other);

/* Writes the members of an open object: a row per plan, the rankings, whether these agree, and, of
 * two plans and more, which one to take and why.
 * name[n]: of the plans. */
void thr_compare_put_json(thr_writer *writer, int method, const thr_compare_entry *entries, int n,
                          const thr_ranking *rankings, int count, const char *const *name);

#endif
