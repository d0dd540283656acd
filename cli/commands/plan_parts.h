/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the files of `thread plan` share: its command line, what was planned, and where
 * that goes. */
#ifndef THR_PLAN_PARTS_H
#define THR_PLAN_PARTS_H

#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/request.h"
#include "planner/planner.h"

/* The command line. Strings point into argv. */
typedef struct {
  cli_frame_args frame;
  pull_args pull;
  symmetry_args symmetry;
  request_args request;
  guard_limits guard; /* seconds < 0: as the objective has it */
  thr_request wanted; /* aims, and what belongs to them */
  const char *path, *output, *draw;
  drawings_args drawings;
  bool compare, force, progress;
} plan_arguments;

/* What was planned: the plan, and what else the planner found. */
typedef struct {
  thr_plan plan;
  thr_report report;
  double holds; /* N at the hardest end below which nothing holds, once the summary is printed;
                   NAN: not known */
} planned_result;

/* Where plan and diagrams go: where the options say; where they say nothing, in a folder named
 * after the framework. */
typedef struct {
  const char *plan, *folder; /* folder: NULL = no diagrams */
  char own[280], in_folder[1200];
} output_places;

/* ---- cmd_plan.c ---- */

/* Fills a request for one objective from the options. What is about turning or symmetry concerns
 * only one objective, and is left out of the others. */
void plan_ask(const plan_arguments *args, thr_objective objective, thr_request *options);

/* Is the plan the recommended one, as nothing was said of what it is to be? */
bool plan_is_recommended(const plan_arguments *args, const thr_request *request);

/* Returns limits for a search. Time that nobody asked for is no limit on work that is counted: such
 * a search ends at the same place on every machine, and the clock only ends it on a very busy one.
 * *work: what the limits count with; must stay while they are used. */
thr_limits plan_limits(const plan_arguments *args, const thr_request *options, double seconds,
                       double *work);

/* ---- plan_compare.c: Compares a plan with those for the other objectives. */

/* Adds the pull of this plan beside that of plans for the other objectives. Returns the first exit
 * code that is not EXIT_OK. */
int plan_put_comparison(thr_writer *writer, const plan_arguments *args, const thr_plan *plan,
                        double deadline);

/* ---- plan_print.c: Prints the summary of what was planned. */

/* Prints the summary to stdout, as its objective needs it. Returns an exit code. */
int plan_print_summary(const plan_arguments *args, planned_result *result);

/* ---- plan_outputs.c: Finds where plan and drawings go, and writes them. */

/* Tries, before the search, whether the plan and its drawings can be written where they go unasked,
 * and that no drawing takes the place of a file that is named on the command line. Returns an exit
 * code. */
int plan_try_places(const plan_arguments *args);

/* Finds where the plan and its drawings go. text: of the plan. Returns an exit code. */
int plan_find_places(const plan_arguments *args, const thr_text *text, output_places *places);

/* Writes plan, summary and drawings. *planned_code: of the search; not EXIT_OK afterwards if a
 * claim was dropped. Returns an exit code. */
int plan_write_outputs(const plan_arguments *args, planned_result *result, int *planned_code);

#endif
