/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pictures of `thread eval`: the tension along each cord or, with a load, what of the
 * load is carried against the pull. */
#include "cli/commands/commands.h"
#include "diagram/overview/charts.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdlib.h>

/* Evaluates the plan's cords again, pulled at the same ends, at another friction and by the closed
 * form: one edge of the fan of a tension plot. mu: of cord on bead. Release with
 * thr_eval_destroy. */
static thr_status eval_at(const thr_plan *plan, double mu, thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_limits none = {0};
  thr_eval_options options = thr_eval_options_default();
  thr_pull *pull = thr_calloc((size_t)evaluation->n_cords, sizeof *pull);

  if (!pull) return thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords; i++)
    pull[i] = evaluation->cord[i].pull;

  /* The band of this evaluation is not asked for: 0 means that it follows from mu. */
  options.physics = evaluation->physics;
  options.physics.mu = mu;
  options.physics.mu_low = options.physics.mu_high = 0;
  options.law = evaluation->law;
  options.cord_pull = pull;

  thr_status st = thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, THR_CAPSTAN, &options,
                                &none, out, err);
  free(pull);

  return st;
}

int eval_write_plot(const thr_plan *plan, double strength, const char *path)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_physics *physics = &evaluation->physics;
  thr_err err = {0};
  thr_text svg = {0};
  thr_eval low = {0}, high = {0};
  thr_tension_options options = thr_tension_options_default();

  options.hand = evaluation->method != THR_STRUCTURE;
  options.strength = strength;

  /* The edges of the fan. */
  const bool fan = evaluation->method != THR_STRUCTURE && evaluation->schedule.n == 0;
  thr_status st = fan && physics->mu_low < physics->mu_high ? THR_OK : THR_EINFEASIBLE;
  if (!st) st = eval_at(plan, physics->mu_low, &low, &err);
  if (!st) st = eval_at(plan, physics->mu_high, &high, &err);
  options.low = st ? NULL : &low.record;
  options.high = st ? NULL : &high.record;

  /* Without a fan the picture is drawn all the same. */
  if (st != THR_ENOMEM) st = thr_tension_svg(plan, &options, &svg, &err);
  thr_eval_destroy(&low);
  thr_eval_destroy(&high);

  return cli_write_drawn(st, &svg, path, &err);
}

/* Orders points of a load's picture by ascending pull. Signature of qsort. */
static int compare_pulls(const void *a, const void *b)
{
  const double x = ((const thr_load_mark *)a)->pull, y = ((const thr_load_mark *)b)->pull;
  return (x > y) - (x < y);
}

int eval_write_load_plot(const thr_plan *plan, const thr_eval *eval, const char *load,
                         const char *path)
{
  thr_err err = {0};
  thr_text svg = {0}, words = {0};
  thr_load_mark *mark = thr_calloc((size_t)eval->n_carries, sizeof *mark);
  thr_status st = mark ? THR_OK : thr_nomem(&err);

  /* A mark for each pull that was asked for, or chosen by the method. */
  for (int i = 0; i < eval->n_carries && !st; i++) {
    const thr_load_point *point = &eval->carries[i];
    /* Where no equilibrium was found, only what is too much is known, which is no band. */
    const bool decided = point->carry.first_bead >= 0 && isfinite(point->carry.carried);
    mark[i] = (thr_load_mark){.pull = point->pull,
                              .decided = decided,
                              .carried = point->carry.carried,
                              .beyond = point->carry.beyond,
                              .first = decided ? plan->frame.name[point->carry.first_bead] : NULL};
  }

  /* Marks are joined by lines from left to right. */
  if (!st) qsort(mark, (size_t)eval->n_carries, sizeof *mark, compare_pulls);
  thr_text_printf(&words, "--load %s: newtons at the pieces named", load);

  const thr_load_chart chart = {words.data ? words.data : "", &plan->evaluation.physics,
                                eval->n_carries, mark};
  if (!st) st = thr_load_svg(&chart, &svg, &err);

  thr_text_destroy(&words);
  free(mark);

  return cli_write_drawn(st, &svg, path, &err);
}
