/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes the options of the methods that measure the pull of a plan, and runs these methods: shared
 * by eval, compare and plan.
 *
 * A command calls pull_args_init, pull_option for each option, pull_check when all are known, and
 * pull_eval for each plan. */
#ifndef THR_PULL_H
#define THR_PULL_H

#include "cli/args/args.h"
#include "cli/cli.h"
#include "eval/eval.h"
#include "graph/plan/evaluation.h"

enum {
  OPTION_PULL_METHOD = OPTION_FREE,
  OPTION_PULL_LAW,
  OPTION_PULL_END,
  OPTION_PULL_SEED,
  OPTION_PULL_TIME_STEP,
  OPTION_PULL_ITERATIONS,
  OPTION_PULL_CACHE,
  OPTION_PULL_NO_CACHE,
  OPTION_PULL_NO_DYNAMICS,
  OPTION_PULL_DYNAMICS,
  OPTION_PULL_START,
  OPTION_PULL_JSON,
  OPTION_PULL_FREE
};
#define PULL_LETTERS CLI_PROCESSES_LETTER
#define PULL_RUN_OPTIONS                                                                           \
  CLI_PROCESSES_OPTION, {"cache", required_argument, NULL, OPTION_PULL_CACHE},                     \
  {                                                                                                \
    "no-cache", no_argument, NULL, OPTION_PULL_NO_CACHE                                            \
  }
#define PULL_OPTIONS                                                                               \
  PULL_RUN_OPTIONS, {"method", required_argument, NULL, OPTION_PULL_METHOD},                       \
      {"law", required_argument, NULL, OPTION_PULL_LAW},                                           \
      {"pull", required_argument, NULL, OPTION_PULL_END},                                          \
      {"seed", required_argument, NULL, OPTION_PULL_SEED},                                         \
      {"time-step", required_argument, NULL, OPTION_PULL_TIME_STEP},                               \
      {"iterations", required_argument, NULL, OPTION_PULL_ITERATIONS},                             \
      {"no-dynamics", no_argument, NULL, OPTION_PULL_NO_DYNAMICS},                                 \
      {"dynamics", no_argument, NULL, OPTION_PULL_DYNAMICS},                                       \
      {"start", required_argument, NULL, OPTION_PULL_START},                                       \
  {                                                                                                \
    "json", no_argument, NULL, OPTION_PULL_JSON                                                    \
  }
#define PULL_RUN_HELP                                                                              \
  CLI_PROCESSES_HELP                                                                               \
  "      --cache DIR      keep measured joints here (default: $XDG_CACHE_HOME/thread or "          \
  "~/.cache/thread);  --no-cache\n"
#define PULL_HELP(START)                                                                           \
  "      --law capstan|mitre   of method capstan: exp(mu x turning), or the mitred bead of the "   \
  "thesis (default: capstan)\n"                                                                    \
  "      --pull start|end|both   which end of each cord is pulled (default: both); or "            \
  "A=start,B=none for single cords\n"                                                              \
  "      --seed N         of a simulation's small initial disorder, 0 to 2^53 (default: 0)\n"      \
  "      --time-step X    factor on the simulation's validated time step, 0.01 to 10 (default: "   \
  "1)\n"                                                                                           \
  "      --iterations X   factor on its validated iterations, 0.1 to 100 (default: 1)\n"           \
  "      --start N        structure: pull in newton at which the simulation begins (default: 1.3 " \
  "x the " START ")\n"                                                                             \
  "      --no-dynamics    structure: limit analysis only, no simulation (of up to\n"               \
  "                       400 pieces; seconds, beyond 100 minutes)\n"                              \
  "      --dynamics       structure: simulate up to 1,000 pieces (a quarter of an "                \
  "hour)\n" PULL_RUN_HELP GUARD_HELP

enum { PULL_ALL_METHODS = THR_N_METHODS };

/* What was asked for. */
typedef struct {
  cli_physics physics;
  thr_eval_options options; /* physics and pulls are set for each plan */
  int method;               /* thr_method, or PULL_ALL_METHODS */
  const char *pull;         /* as given */
  bool json, no_cache;
  char cache[1024]; /* where options.cache points unless given */
} pull_args;

/* Fills in the defaults. The result points into itself, so that it must stay where it is. */
void pull_args_init(pull_args *a, thr_method method);

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad
 * (printed). */
bool pull_option(pull_args *a, const char *command, int option, const char *value, bool *ok);

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

/* Returns the relative error, in per cent, that an error of the exponent makes: 100 (exp(error) -
 * 1). */
double pull_percent(double error);

/* Appends the cords that are not known: "A, C, D and 4 more". */
void pull_unknown_cords(const thr_plan *plan, const thr_evaluation *evaluation, thr_text *text);

#endif
