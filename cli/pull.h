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
/* How a pull is measured, --json, and what is for developers; where measured joints are kept. */
extern const cli_option pull_options[], pull_tuned[], pull_run_options[];

/* The name of a method, or "all", for the rows of --method that commands have. */
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

/* Returns the relative error, in per cent, that an error of the exponent makes: 100 (exp(error) -
 * 1). */
double pull_percent(double error);

/* Appends the cords that are not known: "A, C, D and 4 more". */
void pull_unknown_cords(const thr_plan *plan, const thr_evaluation *evaluation, thr_text *text);

#endif
