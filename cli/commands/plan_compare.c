/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares the plan of `thread plan` with those for the other objectives: makes these plans and
 * measures the largest pull of each by simulated joints. */
#include "cli/commands/plan_parts.h"

#include <math.h>

/* Writes the largest pull of the plan for one objective, N, and its error (a part of the exponent).
 * code: why the pull is not known, EXIT_OK if it is. */
static void put_pull_json(thr_writer *writer, thr_objective objective, const thr_eval *eval,
                          int code)
{
  thr_write_object(writer, NULL);
  thr_write_string(writer, "objective", thr_objective_name(objective));
  thr_write_number(writer, "pull", code == EXIT_OK ? eval->record.largest : NAN);

  /* Turns that were refused have no known error. */
  if (code == EXIT_OK) {
    thr_write_number(writer, "error", eval->error);
    thr_write_int(writer, "refused", eval->refused);
  }
  thr_write_close(writer);
}

/* Appends the same as a line: "tortuosity 12.3 N (+-0.4 %) this plan". */
static void put_pull(thr_text *text, const plan_arguments *args, thr_objective objective,
                     const thr_plan *plan, const thr_eval *eval, int code)
{
  thr_text_printf(text, "  %-12s", thr_objective_name(objective));

  /* With turns that were refused, the error is at least that of the others. */
  if (code == EXIT_OK) {
    char number[THR_PLAIN_NUMBER];
    thr_text_printf(text, eval->refused ? "%12s N (error at least %.3g %%" : "%12s N (+-%.3g %%",
                    thr_plain_number(eval->record.largest, 4, number),
                    thr_eval_percent(eval->error));
    if (eval->refused)
      thr_text_printf(text, ": %d %s by closed form", eval->refused,
                      cli_plural(eval->refused, "turn", "turns"));

    thr_text_printf(text, ")%s", objective == args->request.objective ? "   this plan" : "");
    if (thr_wants_symmetry(&plan->options))
      thr_text_printf(text, "   %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  } else {
    thr_text_printf(text, "%14s", "not known");
  }

  thr_text_append(text, "\n");
}

/* Measures the pull of a plan by simulated joints and adds it to the comparison. Returns an exit
 * code. */
static int put_objective(thr_writer *writer, const plan_arguments *args, thr_objective objective,
                         const thr_plan *plan)
{
  thr_eval eval;
  int code = pull_eval(&args->pull, thr_objective_name(objective), plan, THR_JOINT, &eval);

  /* A pull that is not known is told as such. */
  if (cli_json)
    put_pull_json(writer, objective, &eval, code);
  else
    put_pull(writer->out, args, objective, plan, &eval, code);
  thr_eval_destroy(&eval);

  return code;
}

/* Plans for one objective, unless this is the plan's own, and adds its pull to the comparison.
 * deadline: thr_clock(), 0 = none. Returns an exit code. */
static int plan_and_put(thr_writer *writer, const plan_arguments *args, thr_objective objective,
                        const thr_plan *plan, double deadline)
{
  thr_err err = {0};
  thr_plan other = {0};

  /* The plan that was asked for is there already. */
  if (objective == args->request.objective) return put_objective(writer, args, objective, plan);

  /* The same request with another objective. */
  thr_request options = plan->options;
  plan_ask(args, objective, &options);
  double work;
  thr_limits limits = plan_limits(args, &options, options.time_limit, &work);
  if (deadline > 0) limits.deadline = deadline;

  /* A plan that is not proved is good enough to compare with. */
  thr_status st = thr_plan_make(&plan->frame, &options, &limits, &other, NULL, &err);
  cli_progress_end();
  int code =
      st && st != THR_ELIMIT ? cli_fail(&err) : put_objective(writer, args, objective, &other);
  thr_plan_destroy(&other);

  return code;
}

int plan_put_comparison(thr_writer *writer, const plan_arguments *args, const thr_plan *plan,
                        double deadline)
{
  int code = EXIT_OK;

  if (cli_json)
    thr_write_array(writer, "objectives");
  else
    thr_text_append(writer->out, "\nlargest pull by objective, joints measured in simulation\n");

  /* This plan stands among the others, in the order of objectives. */
  for (int i = 0; i < THR_N_OBJECTIVES; i++) {
    int done = plan_and_put(writer, args, thr_dispatch_objective(i), plan, deadline);
    if (!code) code = done;
  }

  if (cli_json) thr_write_close(writer);

  return code;
}
