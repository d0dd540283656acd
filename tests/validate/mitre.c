/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thesis's Fig. 13: a mitred bead takes mu F sin(theta / 2) off the tension F. A different
 * formula from the capstan law. */
#include "eval/eval.h"
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "tests/validate/validate.h"

#include <math.h>
#include <stdio.h>

static const double degree = THR_PI / 180;

static thr_status one_turn(double angle, double mu, thr_law law, double *loss, thr_err *err)
{
  const double at[3][3] = {{-100, 0, 0}, {0, 0, 0}, {100 * cos(angle), 0, 100 * sin(angle)}};
  thr_draft d = {0};
  thr_frame f = {0};
  thr_read_report read;
  thr_eval e = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < 3 && !st; i++)
    st = thr_draft_add_node(&d, at[i], NULL, false, err);
  for (int i = 0; i < 2 && !st; i++)
    st = thr_draft_add_edge(&d, i, i + 1, 0, err);
  if (!st) st = thr_draft_build(&d, 0, &f, &read, err);
  thr_cord cord = {.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
  thr_eval_options o = thr_eval_options_default();
  o.physics.mu = o.physics.mu_low = o.physics.mu_high = mu;
  o.pull = THR_PULL_START;
  o.law = law;
  thr_limits none = {0};
  if (!st) st = thr_eval_plan(&f, &cord, 1, THR_CAPSTAN, &o, &none, &e, err);
  *loss = st ? 0 : e.record.cord[0].loss;
  thr_eval_destroy(&e);
  thr_frame_destroy(&f);
  thr_draft_destroy(&d);
  return st;
}

thr_status validate_mitre(report *r, thr_err *err)
{
  report_section(
      r, "The thesis's Fig. 13",
      "Loss at one mitred bead, as a part of mu F: sin(theta / 2), which the thesis gives as 71 % "
      "at 90 degrees. The "
      "capstan law's loss "
      "at the same joint stands below it: for small mu it is theta, more than twice as much.");
  thr_status st = THR_OK;
  for (int i = 1; i <= 4 && !st; i++) {
    char what[80];
    double angle = 45 * i * degree, loss;
    if ((st = one_turn(angle, 0.2, THR_LAW_MITRE, &loss, err))) break;
    snprintf(what, sizeof what, "%d degrees, --law mitre: loss / mu", 45 * i);
    report_relative(r, what, i == 2 ? 0.7071 : sin(angle / 2), loss / 0.2, i == 2 ? 1e-4 : 1e-9);
    if ((st = one_turn(angle, 1e-4, THR_LAW_CAPSTAN, &loss, err))) break;
    snprintf(what, sizeof what, "%d degrees, --law capstan, small mu: loss / mu", 45 * i);
    report_relative(r, what, angle, loss / 1e-4, 1e-3);
  }
  return st;
}
