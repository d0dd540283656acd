/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what commands found out: tables and sentences for people, objects for programs.
 *
 * Every function appends to a thr_text, or writes members to a thr_writer (JSON); nothing here
 * computes plans, and nothing reads or writes files. Text has forces in N, angles in degrees and
 * lengths in units of the framework; JSON has angles in rad and null for what is not known. A
 * sentence says "proved" of what the checker has verified (graph/check/check.h), and of nothing
 * else. Memory that runs out is kept in text->failed, which whoever writes the text reports.
 *
 * Read plain.c first: forces and proofs in words, which all others use. Then, by command:
 * plan_summary.c with turning_summary.c, symmetry_table.c and seated.c (thread plan); terms.c
 * (thread check); eval_text.c, eval_json.c and load_words.c (thread eval); compare_rows.c and
 * ranking.c (thread compare); advice_table.c (thread advise). */
#ifndef THR_PRINT_H
#define THR_PRINT_H

#include "cli/cli.h"
#include "cli/pull.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/advice.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lp/length/postman.h"
#include "planner/planner.h"
#include "symmetry/symmetry.h"

#include <stdbool.h>

/* ---- plain.c: Forces and proofs in plain words, for the first screen of every command: newtons
 * with the weight that pulls as much, and one clause for what is proved. */

/* "3.49", "225", "4.5e+06"; "> 1e300", "-" for NAN. */
const char *plain_newtons(double newton, char out[24]);

/* "225 N (23 kg)": the weight hangs at 9.80665 m/s2. Beyond 1e6 N no weight: "4.5e+06 N", "> 1e300
 * N". "-" for NAN. */
const char *plain_force(double newton, char out[64]);

/* "7.70 and 8.94 N": at the two ends of a cord; of two that read alike "8.94 N (0.91 kg)". */
const char *plain_both(double smaller, double larger, char out[64]);

/* The same without unit or weight: "7.70 and 8.94", "8.94". */
const char *plain_two(double smaller, double larger, char out[64]);

/* What is proved of a value that should be small. optimal: "proved: nothing shorter exists" for
 * `less` "nothing shorter exists"; else "at most 3.1 % above the shortest possible (proved)",
 * rounded up, for `least` "shortest possible". bound <= 0: "how near that is to the shortest
 * possible is not known". */
void plain_put_proof(thr_text *text, bool optimal, double value, double bound, const char *less,
                     const char *least);

/* The same of a plan's length, with so many cords where the options ask for few cords before little
 * length; of a symmetric one what its symmetry may cost, as the bound is one of any cords. */
void plain_put_length_proof(thr_text *text, const thr_plan *plan);

/* Appends "; proved: fewer than 3 cords are impossible within that pull" for cords " cords" and
 * within " within that pull". Where several cords were asked for, smaller numbers are not what is
 * proved: "; proved: from 4 cords on, fewer than 6 are impossible". Returns false, and appends
 * nothing, if the bound says no more than what was asked for. */
bool plain_put_fewest(thr_text *text, const thr_plan *plan, int fewest, const char *cords,
                      const char *within);

/* Whether a hand can pull that much: "too hard for a hand, which manages about 50 N (5.1 kg)";
 * "within the 10 N (1 kg) that a hand manages time after time". */
void plain_put_hand(thr_text *text, double newton);

/* ---- ranking.c: An order of plans by a value of which more or less is known. */

/* The bands: of the cords' friction, and of that of beads and ground. */
enum { RANKING_BANDS = 2, RANKING_ENDS = 2 * RANKING_BANDS };
extern const char *const ranking_bands[RANKING_BANDS];

/* Least first, or most. The rank of a plan is 1 and one more for every plan that is surely less:
 * whose interval ends before its own begins. Two plans tie where their intervals overlap; a third
 * between them changes nothing. Filled by ranking_make from value, low and high; plans of one rank
 * stand in the order of their values. */
typedef struct {
  const char *title; /* "simulated seating pull" */
  const char *key;   /* in JSON: "joint" */
  const char *unit;  /* " N", or "" for a bare number */
  const char *open;  /* what to say of a plan without an upper end; NULL = nothing */
  bool most;  /* most first: value, low and high are then negative, and printed without the sign */
  bool error; /* print the interval as +- percent, else as from .. to */
  int n, n_ranked;            /* plans, and how many of them have a rank */
  double *end[RANKING_ENDS];  /* [n] values at the ends of the bands of friction, in the order of
                                 ranking_bands; NAN = not known;  owned */
  double *value, *low, *high; /* [n] of plan i; value NAN = not known, not ranked; INFINITY = proved
                                 that there is none; high INFINITY = no upper end; owned */
  int *order;                 /* [n_ranked] plans; owned */
  int *rank;                  /* [n] 1, 2, .. of plan i, 0 = not ranked; owned */
} ranking;

/* Room for n plans, none known. */
thr_status ranking_init(ranking *r, int n, thr_err *err) THR_MUST_CHECK;
void ranking_destroy(ranking *r);
void ranking_make(ranking *r);

/* Are not all plans tied? */
bool ranking_tells_apart(const ranking *r);

/* Do the intervals of plans i and k overlap? */
bool ranking_is_tie(const ranking *r, int i, int k);

/* "1. lines.json  12.3 N (+-0.4 %)" .. and whether each is more than those before, or with which of
 * them it ties. */
void ranking_put_text(const ranking *r, const char *const *name, thr_text *text);

/* Says of each band whether plans that are not tied stay in this order at both of its ends, or
 * which change places. at[band] are the words for an end: "mu 0.1"; NULL: "the lower end", where
 * plans have their own. */
void ranking_put_bands(const ranking *r, const char *const *name, char at[RANKING_ENDS][40],
                       thr_text *text);
void ranking_put_json(const ranking *r, const char *const *name, thr_writer *writer);

/* A pair of plans that the two put in opposite orders, beyond what their intervals allow; false if
 * there is none. */
bool ranking_disagree(const ranking *a, const ranking *b, int pair[2]);

/* ---- terms.c: Of which plans the claims of a plan speak, in words: a proof without its terms can
 * be taken for more than it is. */

/* Indented lines: what plans the claims are about (ends, passes, cords, joints, lengths), what is
 * proved of the length slack, and which statements of the plan nobody can verify, if there are any.
 */
void terms_put(thr_text *text, const thr_plan *plan);

/* The same as members of a JSON object, from ", " on. */
void terms_put_json(thr_writer *writer, const thr_plan *plan);

/* ---- load_words.c: What of a load is carried, in words and as JSON. */

/* A line per pull, and one of what is carried after the schedule if there was one. */
void load_put(thr_text *text, const thr_plan *plan, const thr_eval *eval);
/* Member "load": a list of pulls, and "after". */
void load_put_json(thr_writer *writer, const thr_frame *frame, const thr_eval *eval);

/* ---- seated.c: Prints which part of the gaps between pieces is closed by which pull, and by one
 * cord or the other. */

/* Of the plan's evaluation: after a schedule what its tensions seat; else the pulls, equal at all
 * pulled ends, that seat a quarter to all of the gaps, and up to eight cords pulled alone. Nothing
 * if not every cord is known. */
void seated_put(thr_text *text, const thr_plan *plan);

/* Appends the line, with `label` before it, that says what holding the pieces together takes where
 * that is more than what seats them, or that it was left out as they are too many. Nothing if it is
 * no more or not decided, or the pieces are tubes. evaluation: of the plan's cords, pulled until
 * they are seated. */
void seated_put_holding(thr_text *text, const char *label, const thr_plan *plan,
                        const thr_evaluation *evaluation);
/* The same as members: "holds_from", N at the hardest end, and null if no pull holds; none if that
 * is not decided. */
void seated_put_holding_json(thr_writer *writer, const thr_plan *plan,
                             const thr_evaluation *evaluation);

/* ---- What thread eval says of a plan, whose evaluation is the plan's own: in words, and as JSON.
 */

/* What was asked for, beside the plan. */
typedef struct {
  const char *pulled; /* which ends, as given */
  double strength;    /* N, of the cord; 0 = not said */
  int knot;           /* at its ends, of thr_knots */
  bool tension;       /* every pass */
  bool loaded;        /* a load hangs on it */
  bool simulated;     /* the structure in simulation was asked for, too */
  bool stopped;       /* before all was known */
} eval_view;

void eval_put_text(thr_text *text, const eval_view *view, const thr_plan *plan,
                   const thr_eval *eval);
/* With which counterweight it comes up: a sentence without a newline. */
void erect_put(thr_text *text, const thr_erect *erect);
void eval_put_json(thr_text *text, const thr_plan *plan, const thr_eval *eval, bool stopped);

/* ---- compare_rows.c: The table of `thread compare`: a row per value, a column per plan. */

typedef struct {
  const char *path;
  thr_plan plan;
  thr_eval eval[THR_N_METHODS];  /* record.present only where the method ran and did not fail */
  double fall[2], fall_error[2]; /* N, in simulation at the settings given and with half the time
                                    step; NAN = did not fall, or never came to rest */
  bool contradicted;             /* that is said of the plan */
} compare_entry;

typedef struct {
  const char *label, *key;
  double (*value)(const compare_entry *); /* NAN = not known, INFINITY = beyond 1e300 */
  bool rate;         /* less is better; rows that say what a plan is, not how good, mark nothing */
  int decimals;      /* -1: whole number, -k: k significant digits */
  thr_method method; /* that must be wanted */
  bool optional;     /* left out of the text where no plan has it */
  bool machinery;    /* in the text only with --verbose: what proofs are made of */
} compare_row;

extern const compare_row compare_rows[];
extern const int compare_n_rows;

/* Largest pull by a method, N; NAN if a cord is not known. */
double compare_largest(const compare_entry *e, thr_method method);

/* Is row r of plan i the best of n? Within a millionth is a tie: both are. */
bool compare_is_best(const compare_entry *e, int n, const compare_row *r, int i);

/* Is plan i on the frontier: does no other plan beat it in cord, number of cords and pull (as
 * measured, if every plan's is)? */
bool compare_on_frontier(const compare_entry *e, int n, int i);

/* Is row r in the text for n plans? */
bool compare_is_shown(const compare_entry *e, int n, const compare_row *r);

/* A space, 16 columns, and the mark of the best. */
void compare_put_cell(thr_text *text, const compare_row *r, double value, bool best);

/* ---- advice_table.c: The table of `thread advise`, as text and as JSON, and the command that
 * makes the recommended plan. */

/* Its head: what is counted and what the columns are; and a row of it. mark: "*> ", three columns.
 */
void advice_put_head(thr_text *text, const thr_frame *frame, const thr_physics *physics);
void advice_put_row(thr_text *text, const thr_advice_row *row, double base_length,
                    const char *mark);

/* Appends a line that says what holding the pieces of the recommended plan takes, where that is
 * more than what seats its cords. The plan needs no proof. */
void advice_put_holding(thr_text *text, const thr_plan *plan);

/* All rows and, below, the recommended one with its command. */
void advice_put_table(thr_text *text, const thr_frame *frame, const thr_advice *advice,
                      const char *command);
/* chosen: a plan with the recommended cords, or NULL. */
void advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice,
                     const char *command, const thr_plan *chosen);

/* "thread plan PATH --cords 4 --ends feet --objective tortuosity --minimize pull", with the options
 * that FRAME was read with (each with a blank before it), for a shell. */
void advice_put_command(thr_text *text, const char *path, const char *options,
                        const thr_advice_row *row);

/* A word as a shell reads it: in quotes where it needs them. */
void advice_put_word(thr_text *text, const char *word);

/* "4 cords to the feet", "1 closed cord", "12 cords with ends anywhere". */
void advice_put_cords(thr_text *text, const thr_advice_row *row);

/* The last lines of `thread plan` where a hand cannot pull it: what it can, held against a plan of
 * that length, and the command.
 */
void advice_put_line(thr_text *text, const thr_advice_row *row, double length, const char *command);

/* ---- symmetry_table.c: The table of groups, and how the cords of a symmetric plan are copies of
 * each other. */

/* "8 automorphisms, ..": the group, its orbits, and what was not listed. */
void symmetry_put_head(thr_text *text, const thr_frame *frame, const thr_request *options,
                       const thr_symmetries *symmetries);

/* At most `most` rows, those before and behind the chosen one if there are more (with --group, only
 * the rows that were asked for), and why it was chosen. */
void symmetry_put_table(thr_text *text, const thr_request *options,
                        const thr_symmetries *symmetries, int most);

/* "A: unique, 9 learned steps; B, C, D: copies of A by C4, C2, C4^3", and the learned steps of all.
 */
void symmetry_put_paths(thr_text *text, const thr_plan *plan);

/* The table as members of an object that is left open, the first without a comma before it. */
void symmetry_put_table_json(thr_writer *writer, const thr_request *options,
                             const thr_symmetries *symmetries);

/* Group and paths of a plan as members of an object, each with a comma before it. */
void symmetry_put_json(thr_writer *writer, const thr_plan *plan);

/* ---- turning_summary.c: A plan of the least turning beside its lower bound, the other end of the
 * trade-off and the shortest plan. */

static const double turning_right_angle = 1.57079632679489661923;

/* Factor on the tension over that much turning (rad): exp(mu * turning), INFINITY beyond 1e300. */
double turning_capstan(double mu, double turning);

/* Evaluates a plan by the closed form, pulled at both ends until so many N are left where it is
 * slackest. Returns false if the pulls are more than a number holds. Release with thr_eval_destroy.
 */
bool turning_seat(const thr_plan *plan, double seating, thr_eval *eval);

/* Appends what the other end of the hardest cord takes, "other_pull", and what holding does,
 * "holds_from" (seated.c). */
void turning_put_ends_json(thr_writer *writer, const thr_plan *plan);

/* Largest pull of a plan by the closed form, times the tension at the slackest point: INFINITY
 * beyond 1e300, NAN if not known. cord (NULL or [n_cords]) receives that of each. */
double turning_pull(const thr_plan *plan, double *cord);

/* N at the hardest end of the cords of a point of the frontier, at that friction; INFINITY beyond
 * 1e300. */
double turning_point_pull(const thr_plan *plan, const thr_frontier_point *point, double mu);

/* "65.9 x", "1.2e+34 x", "> 1e300 x"; "-" for NAN. */
const char *turning_factor(double value, char out[24]);

/* What is proved of the turning; then the table; then the frontier, if there is one. */
void turning_put_status(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_table(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_frontier(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);

/* All of that as members of an object, each with a comma before it. */
void turning_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals);

/* ---- plan_summary.c: What `thread plan` says of a plan: its cords, their length, turning and
 * pull. */

/* rivals: for a plan of the least turning, what it is held against; NULL for others. word: what is
 * known beyond what is verified.
 */
void plan_put_summary(thr_text *text, const thr_plan *plan, const thr_rivals *rivals,
                      thr_cords_word word);

/* The same as members of an object that is left open. */
void plan_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals,
                   thr_cords_word word);

#endif
