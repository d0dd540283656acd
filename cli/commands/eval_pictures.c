/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pictures of `thread eval`: the tension along each cord or, with a load, what of the
 * load is carried against the pull; the beads before and after the fall; and how the structure
 * comes up from slack. */
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Returns a copy of n poses whose positions are in units of the framework instead of metres. mm:
 * millimetres in a unit. NULL when memory runs out; the caller frees it. */
static double (*scale_poses(const double (*from)[7], size_t n, double mm))[7]
{
  double(*pose)[7] = thr_calloc(n, sizeof *pose);
  for (size_t i = 0; i < n && pose; i++) {
    memcpy(pose[i], from[i], sizeof *pose);
    for (int k = 0; k < 3; k++)
      pose[i][k] *= 1000 / mm;
  }
  return pose;
}

/* Draws the beads before and after the fall, side by side, with the widest gap of each in mm. What
 * the picture shows depends on how the simulation ended: the beads fell where the limit analysis
 * expects a fall, or elsewhere, or not at all. */
static thr_status draw_still(const thr_plan *plan, const thr_settle *settle, thr_text *svg,
                             thr_err *err)
{
  const size_t n = (size_t)settle->n_beads;
  double mm = 1;
  thr_status st = thr_units_in_mm(plan->frame.units, &mm, err);

  if (st) return st;
  double(*before)[7] = scale_poses((const double(*)[7])settle->before, n, mm),
  (*after)[7] = scale_poses((const double(*)[7])settle->after, n, mm);

  /* Words for the two panels and below them. */
  char caption[2][160], first[80] = "";
  if (settle->first_bead >= 0)
    snprintf(first, sizeof first, "; bead %.60s moved first", plan->frame.name[settle->first_bead]);
  snprintf(caption[0], sizeof caption[0], "Before: widest gap %.3g mm", settle->gap_before);
  snprintf(caption[1], sizeof caption[1], "After: widest gap %.3g mm%s", settle->gap_after, first);
  const thr_still_panel panel[] = {{"before", caption[0], (const double(*)[7])before},
                                   {"after", caption[1], (const double(*)[7])after}};
  const char *note =
      settle->status == THR_SETTLE_FELL
          ? "Before: under the pull at the start. After: the pull let off until it fell."
      : settle->status == THR_SETTLE_HELD ? "It stands until the pull is gone."
      : settle->fall > 0 ? "Before: under the pull at the start. After: it fell outside the pulls "
                           "that the limit analysis leaves open."
                         : "No fall was seen, though nothing holds it there (proved): what is seen "
                           "here was too slow.";

  const thr_still still = {.title = "The structure in simulation",
                           .note = note,
                           .width = plan->evaluation.physics.bead_diameter / mm,
                           .n_panels = 2,
                           .panel = panel,
                           .first_bead = settle->first_bead};
  st = before && after ? thr_still_svg(&plan->frame, &still, svg, err) : thr_nomem(err);
  free(before);
  free(after);

  return st;
}

/* Draws in six stills how the structure comes up from slack: sunk down, drawn in by a half, once
 * and twice the pull under a counterweight, let alone, at rest (eval/structure/erect.c). */
static thr_status draw_stills(const thr_plan *plan, const thr_erect *erect, thr_text *svg,
                              thr_err *err)
{
  static const char *const id[THR_ERECT_STILLS] = {"slack", "half",  "once",
                                                   "twice", "alone", "rested"};
  static const char *const when[THR_ERECT_STILLS] = {
      "Slack", "Drawn in", "Drawn in", "Drawn in", "Without counterweight", "At rest"};
  thr_still_panel panel[THR_ERECT_STILLS];
  char caption[THR_ERECT_STILLS][200];
  thr_text note = {0};
  double mm = 1;
  thr_status st = thr_units_in_mm(plan->frame.units, &mm, err);

  if (st) return st;

  /* Poses of all stills stand in one array, still by still. */
  double(*pose)[7] =
      scale_poses((const double(*)[7])erect->pose, THR_ERECT_STILLS * (size_t)erect->n_beads, mm);

  /* A panel for each still. */
  for (int i = 0; i < THR_ERECT_STILLS; i++) {
    const thr_erect_still *moment = &erect->still[i];
    snprintf(
        caption[i], sizeof caption[i],
        "%s: %.3g N at the harder ends, counterweight %.3g N; %d of %d gaps closed, %.3g mm high",
        when[i], moment->pull, moment->lift * erect->weight, moment->closed, erect->n_gaps,
        moment->height);
    panel[i] = (thr_still_panel){id[i], caption[i],
                                 (const double(*)[7])(pose ? pose + i * erect->n_beads : NULL)};
  }

  /* Below them the counterweight that it takes. */
  erect_put(&note, erect);
  const thr_still still = {.title = "How the structure comes up",
                           .note = note.data,
                           .width = plan->evaluation.physics.bead_diameter / mm,
                           .n_panels = THR_ERECT_STILLS,
                           .panel = panel,
                           .first_bead = -1};
  st = pose && !note.failed ? thr_still_svg(&plan->frame, &still, svg, err) : thr_nomem(err);

  thr_text_destroy(&note);
  free(pose);

  return st;
}

int eval_write_stills(const thr_plan *plan, const thr_erect *erect, bool stopped, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};

  if (!erect->present) {
    cli_error(stopped ? "%s: not written: stopped before the simulation was done"
                      : "%s: nothing to draw: there was no simulation",
              path);
    return stopped ? EXIT_OK : EXIT_INPUT; /* what stopped it has a code of its own */
  }

  return draw_stills(plan, erect, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

int eval_write_still(const thr_plan *plan, const thr_settle *settle, bool stopped, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};

  if (stopped && !settle->present) {
    cli_error("%s: not written: stopped before the simulation was done", path);
    return EXIT_OK; /* what stopped it has a code of its own */
  }

  /* Where the structure did not come to rest, there is no state before the fall. */
  if (!settle->present || !settle->before || !settle->after ||
      settle->status == THR_SETTLE_TOO_LARGE || settle->status == THR_SETTLE_NEVER_SETTLED) {
    cli_error("%s: nothing to draw: %s", path,
              settle->present && settle->status == THR_SETTLE_NEVER_SETTLED
                  ? "the simulation never came to rest"
                  : "there was no simulation");
    return EXIT_INPUT;
  }

  return draw_still(plan, settle, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}
