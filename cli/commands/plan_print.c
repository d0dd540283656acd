/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the summary of what `thread plan` has planned, as its objective needs it: plans of least
 * turning beside the plans that they are compared with, symmetric plans with the table of groups.
 */
#include "cli/commands/plan_parts.h"
#include "diagram/overview/charts.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"
#include "lib/lib.h"

#include <stdlib.h>

/* Returns when everything must be done, as thr_clock(): the plan and those that it is compared with
 * share the time that was asked for. 0: none was. */
static double deadline_of(const plan_arguments *args)
{
  return args->guard.seconds > 0 ? guard_deadline() : 0;
}

/* Adds the summary of the plan, as text or JSON. */
static void put_plan(thr_writer *writer, const plan_arguments *args, planned_result *result,
                     const thr_rivals *rivals)
{
  if (cli_json)
    plan_put_json(writer, &result->plan, rivals, result->report.word);
  else
    result->holds = plan_put_summary(writer->out, &result->plan, rivals, result->report.word,
                                     plan_is_recommended(args, &result->plan.options));
}

/* Draws the frontier of length and turning into the file of --plot. Where there is none, says why.
 * Returns an exit code. */
static int write_frontier(const plan_arguments *args, const thr_plan *plan,
                          const thr_rivals *rivals)
{
  const thr_frontier *frontier = &rivals->frontier;
  thr_err err = {0};
  thr_text svg = {0};
  thr_physics physics;
  char stem[256];

  if (frontier->n == 0) {
    cli_error("%s: nothing to draw: there is no frontier", args->request.plot);
    return EXIT_INPUT;
  }

  cli_stem(args->path, stem, sizeof stem);
  thr_frontier_mark *mark = thr_calloc((size_t)frontier->n, sizeof *mark);
  thr_status st = mark ? thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, &err)
                       : thr_nomem(&err);

  /* A mark for each point, with its pulls over the band of mu, N. */
  for (int i = 0; i < frontier->n && !st; i++) {
    const thr_frontier_point *point = &frontier->point[i];
    mark[i] = (thr_frontier_mark){
        .length = point->length, .turning = point->turning, .proved = !point->open};
    thr_advice_pulls(&physics, point->pulled, mark[i].pull);
  }

  const thr_frontier_chart chart = {.name = stem,
                                    .units = plan->frame.units,
                                    .physics = &physics,
                                    .shortest = plan->proof.lower_bound,
                                    .n = frontier->n,
                                    .mark = mark};

  if (!st) st = thr_frontier_svg(&chart, &svg, &err);
  free(mark);

  return cli_write_drawn(st, &svg, args->request.plot, &err);
}

/* Makes the plans that a plan of least turning is compared with, and adds the summary with them.
 * Returns an exit code. */
static int put_turning(thr_writer *writer, const plan_arguments *args, planned_result *result)
{
  thr_rivals rivals = {0};
  thr_err err = {0};
  thr_limits limits = cli_limits(0);

  limits.deadline = deadline_of(args);

  /* What nobody asked for is held against nothing on the first screen. */
  if (plan_is_recommended(args, &result->plan.options) && !cli_json && !cli_verbose) {
    put_plan(writer, args, result, NULL);
    return EXIT_OK;
  }

  /* The shortest cords that the planner left are taken over. */
  thr_status st = thr_rivals_make(&result->plan, &result->report.shortest, args->request.compare,
                                  args->request.frontier, &limits, &rivals, &err);
  cli_progress_end();

  /* What the user may not have expected. */
  if (args->request.frontier && !args->request.minimize && result->plan.options.cords > 1)
    cli_note("note: with --frontier all turning together is minimized; --minimize max-turning is "
             "for the cord that turns most");
  if (rivals.no_frontier.code) cli_note("no frontier: %s", rivals.no_frontier.text);

  put_plan(writer, args, result, &rivals);
  int code = st ? cli_fail(&err) : EXIT_OK;
  if (!code && args->request.plot) code = write_frontier(args, &result->plan, &rivals);
  thr_rivals_destroy(&rivals);

  return code;
}

/* Adds the table of groups and the summary of a symmetric plan. At most 8 rows as text; all of them
 * as JSON. */
static void put_symmetry(thr_writer *writer, const plan_arguments *args, planned_result *result)
{
  enum { ROWS = 8 };
  const thr_plan *plan = &result->plan;

  if (!cli_json) {
    symmetry_put_head(writer->out, &plan->frame, &plan->options, &result->report.symmetries);
    symmetry_put_table(writer->out, &plan->options, &result->report.symmetries, ROWS);
    thr_text_append(writer->out, "\n");
  }

  /* The plan itself, and in JSON the table after it. */
  put_plan(writer, args, result, NULL);
  if (!cli_json) return;
  thr_write_object(writer, "symmetries");
  thr_symmetries_put_table(writer, &plan->options, &result->report.symmetries);
  thr_write_close(writer);
}

int plan_print_summary(const plan_arguments *args, planned_result *result)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  int code = EXIT_OK;

  if (cli_json) thr_write_object(&writer, NULL);

  /* Each objective is compared with something else. */
  if (thr_wants_turning(&result->plan.options))
    code = put_turning(&writer, args, result);
  else if (thr_wants_symmetry(&result->plan.options))
    put_symmetry(&writer, args, result);
  else
    put_plan(&writer, args, result, NULL);

  if (args->compare) {
    int done = plan_put_comparison(&writer, args, &result->plan, deadline_of(args));
    if (!code) code = done;
  }

  if (cli_json) {
    answer_put_files(&writer);
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }

  /* With --quiet the text was made only because a picture is made on the way. */
  int written = EXIT_OK;
  if (cli_quiet && !cli_json)
    thr_text_destroy(&text);
  else
    written = print_text(&text);

  return code ? code : written;
}
