/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What several commands do: measuring the pull, drawing a plan, advice beside a plan, and
 * calibration. */
#ifndef THR_COMMANDS_H
#define THR_COMMANDS_H

#include "cli/args/args.h"
#include "cli/cli.h"
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/status.h"
#include "graph/text.h"
#include "kit/picture.h"
#include "lib/comparison.h"

/* ---- Prints advice on the number of cords beside a plan: shared by `thread advise` and by the
 * last lines of `thread plan`. */

/* What commands have in common that make the plans of advice; borrowed. */
typedef struct {
  const char *path; /* of FRAME */
  const cli_physics *physics;
  double hand; /* N */
} advice_commands;

/* Appends, for a shell, the command that makes the plan of a row, with the options that FRAME was
 * read with and what was said of cord and beads: "thread plan FRAME" where that makes it, else
 * "thread advise FRAME --cords 4 --ends feet -T plan -o plan.json"; row NULL: of any row. user:
 * advice_commands. Signature of thr_advice_command. */
void advice_put_command(const void *user, const thr_advice_row *row, thr_text *text);

/* Returns limits for so many seconds by the clock, 0 = none, silent but for --verbose; and for so
 * much counted work, 0 = any. Seconds below 0: as much work as advice is usually given, which *work
 * becomes. *work stays while the limits are used. */
thr_limits advice_limits(double seconds, double *work);

/* Appends that a hand cannot pull the cords of a plan, if it cannot, and which plan it can; unsaid:
 * this was to be the one. */
void advice_put_hint(const thr_plan *plan, bool unsaid, thr_text *text);

/* Appends how many cords the recommended plan has, what they are pulled with until they are seated,
 * and what holds them where that is much more. hand: N, less than thr_hand_always where the cord
 * bears no more; holds: as seated_put_holding returns. Returns whether a hand can pull them at all;
 * else appends nothing. */
bool advice_put_recommended(const thr_plan *plan, double hand, double holds, thr_text *text);

/* ---- thread eval --calibrate: computes frictions from weights and tilted boards at the bench, and
 * draws the piece that the weights hang from. */

/* value: of --calibrate; bore: mm, of the piece. Returns the exit code. */
int calibrate_run(const char *value, double bore, const char *output);

/* ---- Writes the documents that are made from a plan: one of them, or all into a folder, where
 * they have their usual names (lib/lib.h has the table). Shared by `thread draw` and `thread plan`.
 */

/* How documents are drawn. */
typedef struct {
  double pitch_mm;            /* of the overview; 0 = automatic */
  thr_overview_colour colour; /* of the overview */
  double
      kind_tolerance; /* pieces that differ by no more are of a kind, in units; 0 = the usual one */
  double working_mm;  /* cord that is worked with at a time; 0 = the usual one */
  int page;           /* of the step sheets: thr_page_size */
  int needles; /* that cords are threaded with in the step sheets: 1, 2 = from their middle; 0 = not
                  said */
  thr_line_options lines; /* of cords for CAD */
  thr_kit_view view;      /* of the picture, and the only piece in it by its name; NULL = all */
  const char *piece;
  const char *path; /* of the file that the thing is named after; NULL or "-": of none */
  bool quick;       /* all documents means all but the step sheets of too many pieces */
} drawings_args;

/* With more pieces step sheets are hundreds of pages, which nobody prints unasked. */
enum { DRAWINGS_SHEETS_PIECES = 1000, DRAWINGS_NAMES = 128 };

/* --kind-tolerance; --page, --from, --working-length: of the step sheets. */
extern const cli_option drawings_options[];

/* Writes document i of the plan to path ("-" = stdout). Returns EXIT_OK or prints and returns the
 * code. */
int drawings_write(const thr_plan *plan, int i, const char *path, const drawings_args *a);

/* Writes all of them into folder, which is made if needed, under their usual names; stops at the
 * first that fails, and with EXIT_LIMIT, printed, where the time of the command is over. */
int drawings_write_all(const thr_plan *plan, const char *folder, const drawings_args *a);

/* Compares the names of document i, or of all that drawings_write_all may write (i = -1), in folder
 * with the files that this command reads and writes (cli/files.c). Returns EXIT_OK, or prints which
 * one would be lost and returns EXIT_USAGE. */
int drawings_claim(const char *command, const char *folder, int i);

/* Returns whether one of all documents, or the plan, would take the place of such a file. */
bool drawings_would_lose(const char *folder);

/* Takes down for programs what drawings_write_all is going to write (answer_file). */
void drawings_foretell(const thr_plan *plan, const char *folder, const drawings_args *a);

/* Appends how many pieces hang loose in a chain at most while the plan is threaded: "longest loose
 * chain: 8 pieces". */
thr_status drawings_chains(const thr_plan *plan, const drawings_args *a, thr_text *text,
                           thr_err *err) THR_MUST_CHECK;

/* Returns whether drawings_write_all leaves out the step sheets. */
bool drawings_no_sheets(const thr_plan *plan, const drawings_args *a);

/* Fills names with what drawings_write_all writes: "overview.svg steps.txt". */
void drawings_names(const thr_plan *plan, const drawings_args *a, char names[DRAWINGS_NAMES]);

/* ---- Takes the options of the methods that measure the pull of a plan, and runs these methods:
 * shared by eval, compare and plan.
 *
 * A command calls pull_args_init, pull_option for each option, pull_check when all are known, and
 * pull_eval for each plan. */

/* What was asked for. */
typedef struct {
  cli_physics physics;
  thr_eval_options options; /* physics and pulls are set for each plan */
  int method;               /* thr_method, THR_BY_RISE or THR_BY_ALL */
  const char *pull;         /* which ends, as given */
  double newtons;           /* .. or, of THR_BY_RISE, the most that a hand pulls; 0 = not said */
  bool no_cache;
  char cache[1024]; /* where options.cache points unless given */
} pull_args;

/* Fills in the defaults. The result points into itself, so that it must stay where it is. */
void pull_args_init(pull_args *a, thr_method method);
/* How a pull is measured, --json, and what is for developers; where measured joints are kept. */
extern const cli_option pull_options[], pull_tuned[], pull_run_options[];

/* The name of a method, "rise" or "all", for the rows of --method that commands have. */
const char *pull_method_name(int method);

/* Checks that what was asked makes sense together. Returns EXIT_OK, or prints and returns the code.
 */
int pull_check(const pull_args *a, const char *command);

/* Evaluates a plan by one method with a progress bar and Ctrl-C; path is for messages. Returns
 * EXIT_OK; EXIT_LIMIT after a stop, with out holding what is known; or prints and returns the code.
 */
int pull_eval(const pull_args *a, const char *path, const thr_plan *plan, thr_method method,
              thr_eval *out);

/* Reads a schedule: a value with a colon is one, another value is the name of a file of one; NULL
 * is none. Returns EXIT_OK, or prints and returns the code. Release with thr_schedule_destroy. */
int pull_read_schedule(const char *value, const thr_plan *plan, thr_schedule *schedule);

/* Appends the cords that are not known: "A, C, D and 4 more". */
void pull_unknown_cords(const thr_plan *plan, const thr_evaluation *evaluation, thr_text *text);

/* ---- eval_pictures.c: Writes the pictures of `thread eval`. */

/* Draws the tension along each cord, N, with a fan from mu_low to mu_high where the method has one:
 * the limit analysis has none, a schedule neither, and beyond 1e300 N nothing is drawn. Lines show
 * what a hand manages and what the cord bears. strength: N that is left of the cord at its knots,
 * 0 = not known. Returns an exit code. */
int eval_write_plot(const thr_plan *plan, double strength, const char *path);

/* Draws what of the load is carried against the pull at all ends, N: from the multiple at which an
 * equilibrium was found to the one above which none exists, and which piece moves first. load: as
 * given. Returns an exit code. */
int eval_write_load_plot(const thr_plan *plan, const thr_eval *eval, const char *load,
                         const char *path);

/* ---- cmd_rise.c: What `thread rise PLAN` does, for `thread eval --method rise`. */

/* Sets what the command line says of cord and beads, beside which sizes of an evaluation that the
 * plan keeps do not count. Returns an exit code. */
int rise_apply_physics(const cli_physics *physics, thr_plan *plan);

typedef struct {
  const cli_physics *physics;
  const guard_limits *guard;
  double newtons;   /* 0: as many as usual */
  double time_step; /* factor */
  int seed;         /* -1: the usual one */
} rise_usual;

/* Lets the plan of this file rise once, in a guarded child, and prints what was seen. Returns the
 * exit code. */
int rise_as_usual(const char *path, const rise_usual *asked);

#endif
