/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what commands found out: tables and sentences for people, objects for programs.
 *
 * Every function appends to a thr_text, or writes members to a thr_writer (JSON); nothing here
 * computes plans, and nothing reads or writes files. Text has forces in N, angles in degrees and
 * lengths in units of the framework; JSON has angles in rad and null for what is not known. A
 * sentence says "proved" of what the checker has verified (graph/check/check.h), and of nothing
 * else. Memory that runs out is kept in text->failed, which whoever writes the text reports.
 *
 * Read plain.c first: forces and proofs in words, which all others use; terminal.c fits tables to
 * the terminal. Then, by command: plan_summary.c with turning_summary.c, symmetry_table.c and
 * seated.c (thread plan); verdict.c and terms.c (thread check); eval_text.c, eval_json.c and
 * load_words.c (thread eval); compare_table.c (thread compare); advice_table.c (thread advise);
 * facts.c, motion_facts.c (thread info). */
#ifndef THR_PRINT_H
#define THR_PRINT_H

#include "cli/cli.h"
#include "cli/commands/commands.h"
#include "eval/eval.h"
#include "eval/rise/rise.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "kit/kit.h"
#include "lib/comparison.h"
#include "lib/lib.h"
#include "lp/length/postman.h"
#include "planner/planner.h"
#include "symmetry/symmetry.h"

/* ---- plain.c: Formats forces and proofs in plain words, for the first screen of every command:
 * newtons with the mass that weighs as much, and one clause for what is proved. */

/* Format a volume given in mm3 and a mass given in g with three digits: "62.1 cm3", "16 m3" from
 * 1 m3 on; "25.3 g", "12.4 kg", "20 t". Return out. */
const char *plain_volume(double volume, char out[64]);
const char *plain_mass(double gram, char out[64]);

/* Formats newtons with the mass that weighs as much at 9.80665 m/s2: "225 N (23 kg)". Beyond 1e6 N
 * without: "4.5 million N", "over a trillion N". "-" for NAN. Returns out. */
const char *plain_force(double newton, char out[64]);

/* Formats the pulls at the two ends of a cord, N: "7.70 and 8.94 N"; of two that read alike "8.94 N
 * (0.91 kg)". Returns out. */
const char *plain_both(double first, double second, char out[64]);

/* Formats the same without unit or mass: "7.70 and 8.94", "8.94". Returns out. */
const char *plain_two(double first, double second, char out[64]);

/* Appends what is proved of a value that should be small. optimal: "proved: nothing shorter exists"
 * for `less` "nothing shorter exists"; else "at most 3.1 % above the shortest possible (proved)",
 * rounded up, for `least` "shortest possible". bound <= 0: "how near that is to the shortest
 * possible is not known". */
void plain_put_proof(thr_text *text, bool optimal, double value, double bound, const char *less,
                     const char *least);

/* Appends the same of a plan's length: with so many cords, where the options ask for few cords
 * before little length; of a symmetric plan as what the symmetry may cost, since the bound is one
 * of any cords. */
void plain_put_length_proof(thr_text *text, const thr_plan *plan);

/* Appends the same of the price of all turns, and of the cord that turns most or is hardest to
 * pull. */
void plain_put_turning_proof(thr_text *text, const thr_plan *plan);
void plain_put_largest_proof(thr_text *text, const thr_plan *plan);

/* Appends "; proved: fewer than 3 cords are impossible within that pull" for cords " cords" and
 * within " within that pull". Where several cords were asked for, smaller numbers are not what is
 * proved: "; proved: from 4 cords on, fewer than 6 are impossible". Returns false, and appends
 * nothing, if the bound says no more than what was asked for. */
bool plain_put_fewest(thr_text *text, const thr_plan *plan, int fewest, const char *cords,
                      const char *within);

/* Appends what pieces are taken to be made of: "assumed: printed solid in PLA, 1.24 g/cm3" where
 * nobody said so, else "0.5 g/cm3". physics: as asked for. */
void plain_put_material(thr_text *text, const thr_physics *physics);

/* Appends whether a hand can pull that much: "too hard for a hand, which manages about 50 N (5.1
 * kg)"; "within the 10 N (1 kg) that a hand manages time after time". */
void plain_put_hand(thr_text *text, double newton);

/* ---- terminal.c: Fits what is printed to the width of the terminal. */

/* Stands before each cell of a table but the first, followed by a digit: how soon the column is
 * left out where there is no room, 9 first, 1 last, 0 never. */
#define PRINT_CELL "\v"

/* Fits text to so many columns: tables lose columns, other lines are wrapped. 0: only the marks of
 * cells go. O(bytes). */
void print_fit(thr_text *text, int columns);

/* Fits the text to the terminal that stdout may be, unless it is JSON, and writes it there as
 * cli_write does. Returns an exit code. */
int print_text(thr_text *text);

/* ---- terms.c: Prints among which plans the claims of a plan hold, and what is verified: a proof
 * without its terms can be taken for more than it is. */

/* Appends indented lines: what plans the claims are about (ends, passes, cords, joints, lengths),
 * what is proved of the length slack, and which statements of the plan nobody can verify, if there
 * are any. */
void terms_put(thr_text *text, const thr_plan *plan);

/* Writes the same as members of an open object. */
void terms_put_json(thr_writer *writer, const thr_plan *plan);

/* ---- motion_facts.c: Prints the motions of a framework of bars (thread info --motions). */

/* What was found out about motions. */
typedef struct {
  thr_bars bars;
  bool *held, *cable; /* [n_nodes], [n_edges]; owned */
  int n_held;
  thr_bar_motions basis;
  bool planned; /* the cords are those of a plan, else edges that are cord alone */
  int n_cords;  /* 0: none, and nothing was asked about pulling */
  thr_cord *cord;
  thr_pulling pulling;
  int n_left;                /* motions that keep the lengths of all cords, too */
  int which;                 /* the motion that is drawn and played, from 1; 0: that of pulling */
  const double (*chosen)[3]; /* its velocities, in basis or pulling; NULL: nothing moves */
  thr_path path;             /* n_frames 0: not followed */
} motion_facts;

/* Appends lines: how many motions, what pulling does, how far one was followed. */
void motions_put(thr_text *text, const motion_facts *facts);

/* Writes the same with all vectors and forces as a member of an open object. */
void motions_put_json(thr_writer *writer, const motion_facts *facts);

/* ---- facts.c: Prints what `thread info` found out. */

enum { FACTS_DEGREES = 64 };

/* What was found out about a framework. */
typedef struct {
  int degree[FACTS_DEGREES + 1]; /* nodes of each degree; the last counts all higher ones too */
  int odd, components, bridges, feet;
  double shortest, longest;
  bool analysed;
  thr_rigidity rigidity;
  bool planned; /* the framework came in a plan */
  int n_untied;
  bool *untied;         /* [n_nodes] planned: owned */
  bool channels;        /* planned with solid joints: they run through pieces */
  int64_t crossings;    /* of two channels in a piece */
  int crossed;          /* pieces with one */
  thr_kit_estimate kit; /* planned */
  int n_assumptions;
  thr_assumption assumption[THR_ASSUMPTIONS];
  const motion_facts *motions; /* NULL: not asked for; borrowed */
} frame_facts;

/* Appends all facts, and as what the file was read. */
void facts_put(thr_text *text, const thr_frame *frame, const frame_facts *info);

/* Appends the same as a JSON object and a newline. */
void facts_put_json(thr_text *text, const thr_frame *frame, const frame_facts *info);

/* ---- verdict.c: Prints what `thread check` has verified. */

/* Appends what a plan that holds says of itself, a line and its terms. */
void verdict_put(thr_text *text, const char *path, const thr_plan *plan);

/* Appends the verdict as one line of JSON. err: what is wrong with the plan, none if it holds;
 * code: the exit code then. */
void verdict_put_json(thr_text *text, const char *path, const thr_plan *plan, const thr_err *err,
                      int code);

/* ---- load_words.c: Prints what part of a load is carried, in words and as JSON. */

/* Appends the pull that carries all of the load, a line per pull with what is carried, and one of
 * what is carried after the schedule if there was one. */
void load_put(thr_text *text, const thr_plan *plan, const thr_eval *eval);

/* Writes member "load": the same, with a list of pulls, and "after". */
void load_put_json(thr_writer *writer, const thr_frame *frame, const thr_eval *eval);

/* ---- seated.c: Prints which part of the gaps between pieces is closed by which pull, and by one
 * cord or the other. */

/* Appends what the plan's evaluation seats: after a schedule the part of the gaps; else the pulls,
 * N and equal at all pulled ends, that seat a quarter to all of the gaps, and what up to eight
 * cords seat when they are pulled alone. Nothing if not every cord is known. */
void seated_put(thr_text *text, const thr_plan *plan);

/* Appends the line, with `label` before it, that says what holding the pieces together takes where
 * that is more than what seats them, or that it was left out as they are too many. Nothing if it is
 * no more or not decided, or the pieces are tubes. evaluation: of the plan's cords, pulled until
 * they are seated. Returns the pull at the hardest end below which nothing holds, N; NAN: not
 * known. */
double seated_put_holding(thr_text *text, const char *label, const thr_plan *plan,
                          const thr_evaluation *evaluation);

/* Writes the same as members: "holds_from", N at the hardest end, and null if no pull holds; none
 * if that is not decided. */
void seated_put_holding_json(thr_writer *writer, const thr_plan *plan,
                             const thr_evaluation *evaluation);

/* ---- eval_text.c, eval_json.c: Print what `thread eval` found of a plan, whose evaluation is the
 * plan's own. */

/* What was asked for, beside the plan. */
typedef struct {
  const char *pulled; /* which ends, as given */
  double strength;    /* N, of the cord; 0 = not said */
  int knot;           /* at its ends, of thr_knots */
  bool tension;       /* every pass */
  bool loaded;        /* a load hangs on it */
  const char
      *pieces;  /* profile of pieces as they are made, which were evaluated; NULL: ideal ones */
  bool stopped; /* before all was known */
} eval_view;

/* Appends everything in words. */
void eval_put_text(thr_text *text, const eval_view *view, const thr_plan *plan,
                   const thr_eval *eval);

/* Appends everything as a JSON object and a newline. stopped: not all is known. */
void eval_put_json(thr_text *text, const eval_view *view, const thr_plan *plan,
                   const thr_eval *eval);

/* ---- compare_table.c: Prints the comparison. */

/* Appends the table, what it was computed with, and the rankings with what the bands of friction
 * change about them. name[n]: of the plans. */
void compare_put_text(thr_text *text, const pull_args *args, const thr_compare_entry *entries,
                      int n, const thr_ranking *rankings, int count, const char *const *name);

/* Appends how the pulls of the picture were found: "Pull at both ends of every cord, so that 1 N is
 * left where it is slackest ..". */
void compare_put_note(thr_text *text, const pull_args *args, const thr_compare_entry *entries,
                      int n);

/* ---- advice_table.c: Prints the table of `thread advise`, as text and as JSON, and the command
 * that makes the recommended plan. */

/* Appends the head of the table: what is counted and what the columns are. */
void advice_put_head(thr_text *text, const thr_frame *frame, const thr_physics *physics);

/* Appends a row. base_length: units, of the passes that the edges need. mark: "*> ", three columns.
 */
void advice_put_row(thr_text *text, const thr_advice_row *row, double base_length,
                    const char *mark);

/* Appends a line that says what holding the pieces of the recommended plan takes, where that is
 * more than what seats its cords. The plan needs no proof. */
void advice_put_holding(thr_text *text, const thr_plan *plan);

/* Appends all rows and, below, the recommended one with its command (lib/lib.h), and that of any
 * other row (NULL). */
void advice_put_table(thr_text *text, const thr_frame *frame, const thr_advice *advice,
                      thr_advice_command *command, const void *user);

/* Writes the table as an object. command: of a row. chosen: a plan with the recommended
 * cords, or NULL. */
void advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice,
                     thr_advice_command *command, const void *user, const thr_plan *chosen);

/* Appends a word as a shell reads it: in quotes where it needs them. */
void advice_put_word(thr_text *text, const char *word);

/* Appends "4 cords to the feet", "1 closed cord", "12 cords with ends anywhere". */
void advice_put_cords(thr_text *text, const thr_advice_row *row);

/* ---- symmetry_table.c: Prints the table of groups, and how the cords of a symmetric plan are
 * copies of each other. */

/* Appends the head: the order of the group, its orbits, and what was not listed. */
void symmetry_put_head(thr_text *text, const thr_frame *frame, const thr_request *options,
                       const thr_symmetries *symmetries);

/* Appends at most `most` rows, those before and behind the chosen one if there are more (with
 * --group, only the rows that were asked for), and why it was chosen. */
void symmetry_put_table(thr_text *text, const thr_request *options,
                        const thr_symmetries *symmetries, int most);

/* Appends the unique paths of a plan with their copies, "A: unique; B, C, D: copies of A by C4, C2,
 * C4^3", and the learned steps of all. */
void symmetry_put_paths(thr_text *text, const thr_plan *plan);

/* Writes group and paths of a plan as members of an open object. */
void symmetry_put_json(thr_writer *writer, const thr_plan *plan);

/* ---- turning_summary.c: Prints a plan of the least turning beside its lower bound, the other end
 * of the trade-off and the shortest plan. */

static const double turning_right_angle = 1.57079632679489661923;

/* Writes what the other end of the hardest cord takes, "other_pull", and what holding does,
 * "holds_from" (seated.c), both in N. seated: the plan's pulls by the closed form. */
void turning_put_ends_json(thr_writer *writer, const thr_plan *plan, const thr_eval *seated);

/* Returns the largest pull of a plan by the closed form, as a factor on the tension at the slackest
 * point: INFINITY beyond 1e300, NAN if not known. cord (NULL or [n_cords]) receives that of each.
 */
double turning_pull(const thr_plan *plan, double *cord);

/* Formats a factor: "65.9 x", "1.2e+34 x", "> 1e300 x"; "-" for NAN. Returns out. */
const char *turning_factor(double value, char out[24]);

/* Append what is proved of the turning; the table; and the frontier, if there is one. */
void turning_put_status(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_table(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);
void turning_put_frontier(thr_text *text, const thr_plan *plan, const thr_rivals *rivals);

/* Writes all of that as members of an open object. */
void turning_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals);

/* ---- plan_summary.c: Prints what `thread plan` says of a plan: its cords, their length, turning
 * and pull. */

/* Appends what a kit of the pieces will be: "49 pieces, 13 kinds (49 with their channels), about 62
 * cm3 with arms 7.22 mm wide", with as many digits of the volume as are sure; what they weigh if
 * some are too large to print; or why there is none. */
void kit_put(thr_text *text, const thr_kit_estimate *kit);

/* Writes the same as an object "kit". */
void kit_put_json(thr_writer *writer, const thr_kit_estimate *kit);

/* Appends the summary. rivals: what a plan of the least turning is compared with; NULL for others.
 * word: what the search found out beyond what is verified. recommended: nobody asked for a limit on
 * the pull. Returns what seated_put_holding does. */
double plan_put_summary(thr_text *text, const thr_plan *plan, const thr_rivals *rivals,
                        thr_cords_word word, bool recommended);

/* Writes the same as members of an open object. */
void plan_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals,
                   thr_cords_word word);

#endif
