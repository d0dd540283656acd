/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One joint in Bullet against the capstan law, and how the result moves with every number of the
 * protocol. */
#include "tests/validate/drags.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

static const double degree = THR_PI / 180;

/* A bore of two cords, and wider where the cord would wedge in it. */
static double round_bore(double degrees)
{
  return degrees <= 120 ? 2 : degrees <= 135 ? 2.7 : 4;
}

static drag_case joint_case(double degrees, double mu)
{
  return (drag_case){.n = 1,
                     .turn = {degrees * degree},
                     .drag = {.bore = round_bore(degrees),
                              .mu = mu,
                              .seed = 1,
                              .time_step = 1,
                              .iterations = 1,
                              .spacing = 1}};
}

static thr_status angles(report *r, thr_err *err)
{
  static const double mu[] = {0.1, 0.2, 0.3, 0.4, 0.5};
  enum { ANGLES = 10, MUS = sizeof mu / sizeof *mu };
  drag_case c[ANGLES * MUS];
  thr_drag_result found[ANGLES * MUS];
  for (int i = 0; i < ANGLES * MUS; i++)
    c[i] = joint_case(15 * (i / MUS + 1), mu[i % MUS]);
  thr_status st = drags_run(c, ANGLES * MUS, found, err);
  if (st) return st;
  report_section(r, "One joint: capstan ratio",
                 "A cord dragged over one mitred joint. Expected: exp(mu theta). The bore is twice "
                 "the cord up to 120 degrees, 2.7 times at "
                 "135 and 4 times at 150: in a narrower one the cord wedges (below).");
  for (int i = 0; i < ANGLES * MUS; i++) {
    char what[80];
    snprintf(what, sizeof what, "%.0f degrees, mu %g", c[i].turn[0] / degree, c[i].drag.mu);
    if (found[i].status == THR_DRAG_SETTLED)
      report_relative(r, what, exp(c[i].drag.mu * c[i].turn[0]), found[i].ratio, 0.01);
    else
      report_holds(r, what, "settled", drag_status_name(found[i].status), false);
  }
  return THR_OK;
}

/* The opening of a mitred bore is an ellipse; where its end is more pointed than the cord, the cord
 * lies on two points of the rim. */
static thr_status wedged(report *r, thr_err *err)
{
  static const struct {
    double degrees, bore;
    bool refused;
  } v[] = {{110, 2, false},  {130, 2, false}, {135, 2, false}, {90, 1.3, false},
           {90, 1.1, false}, {150, 2, true},  {160, 10, true}};
  enum { N = sizeof v / sizeof *v };
  drag_case c[N];
  thr_drag_result found[N];
  for (int i = 0; i < N; i++) {
    c[i] = joint_case(v[i].degrees, 0.3);
    c[i].drag.bore = v[i].bore;
  }
  thr_status st = drags_run(c, N, found, err);
  if (st) return st;
  report_section(r, "One joint: where the cord wedges",
                 "mu 0.3. A cord wedges beyond 2 acos(1 / bore), bore in cord diameters, and then "
                 "loses more than the capstan "
                 "law. No closed form says "
                 "how much; the ratio is shown as a part of exp(mu theta). Too deep a wedge, and "
                 "turns beyond 150 degrees, must "
                 "be refused.");
  for (int i = 0; i < N; i++) {
    char what[100];
    double part = found[i].ratio / exp(0.3 * c[i].turn[0]);
    snprintf(what, sizeof what, "%g degrees, bore %g", v[i].degrees, v[i].bore);
    if (v[i].refused)
      report_holds(r, what, "refused", drag_status_name(found[i].status),
                   found[i].status == THR_DRAG_OUT_OF_RANGE);
    else if (c[i].turn[0] <= thr_drag_round_turn(v[i].bore))
      report_relative(r, what, 1, part, 0.01);
    else
      report_at_least(r, what, part, 1);
  }
  return THR_OK;
}

static thr_status straight(report *r, thr_err *err)
{
  static const double mu[] = {0, 0.1, 0.3, 0.5};
  drag_case c[4];
  thr_drag_result found[4];
  for (int i = 0; i < 4; i++)
    c[i] = joint_case(0, mu[i]);
  thr_status st = drags_run(c, 4, found, err);
  if (st) return st;
  report_section(r, "Straight channel",
                 "The same without a turn: the loss 1 - hold / drag in percent.");
  for (int i = 0; i < 4; i++) {
    char what[80];
    snprintf(what, sizeof what, "loss in %%, mu %g", mu[i]);
    report_at_most(r, what, 100 * fabs(1 - 1 / found[i].ratio), 0.1);
  }
  return THR_OK;
}

static thr_status convergence(report *r, thr_err *err)
{
  static const struct {
    const char *what;
    double time_step, iterations, spacing;
    int sides;
    uint64_t seed;
    double bore;
  } v[] = {{"protocol", 1, 1, 1, 0, 1, 2},           {"time step halved", 0.5, 1, 1, 0, 1, 2},
           {"iterations doubled", 1, 2, 1, 0, 1, 2}, {"links half as long", 1, 1, 0.5, 0, 1, 2},
           {"32 sides", 1, 1, 1, 32, 1, 2},          {"another seed", 1, 1, 1, 0, 7, 2},
           {"bore 1.5 cords", 1, 1, 1, 0, 1, 1.5},   {"bore 3 cords", 1, 1, 1, 0, 1, 3}};
  enum { N = sizeof v / sizeof *v };
  drag_case c[N];
  thr_drag_result found[N];
  for (int i = 0; i < N; i++) {
    c[i] = joint_case(90, 0.3);
    c[i].drag = (thr_drag){.bore = v[i].bore,
                           .mu = 0.3,
                           .seed = v[i].seed,
                           .time_step = v[i].time_step,
                           .iterations = v[i].iterations,
                           .spacing = v[i].spacing,
                           .sides = v[i].sides};
  }
  thr_status st = drags_run(c, N, found, err);
  if (st) return st;
  report_section(r, "One joint: convergence",
                 "90 degrees, mu 0.3: the ratio must stay as one number of the protocol changes.");
  for (int i = 0; i < N; i++)
    report_relative(r, v[i].what, exp(0.3 * 90 * degree), found[i].ratio, 0.01);
  return THR_OK;
}

thr_status validate_joint(report *r, thr_err *err)
{
  thr_status st = angles(r, err);
  if (!st) st = wedged(r, err);
  if (!st) st = straight(r, err);
  return st ? st : convergence(r, err);
}
