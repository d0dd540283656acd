/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thesis's Fig. 12: a row of beads held out from a wall by one straight cord. */
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "tests/validate/validate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double LENGTH = 400;       /* mm, from the first interface to the tip */
static const double CORD = 1, BORE = 2; /* mm */

typedef struct {
  thr_frame frame;
  thr_cord cord;
  thr_beads beads;
  thr_physics physics;
} cantilever;

static void destroy(cantilever *c)
{
  free(c->cord.half);
  thr_beads_destroy(&c->beads);
  thr_frame_destroy(&c->frame);
}

/* n loose beads; of any width the row weighs the same. */
static thr_status make(cantilever *c, int n, double width, thr_err *err)
{
  thr_draft d = {0};
  thr_read_report read;
  double step = LENGTH / (n - 0.5);
  bool *clamped = thr_calloc((size_t)n + 1, sizeof *clamped);
  *c = (cantilever){.cord = {.id = "A", .n_passes = n, .half = thr_calloc((size_t)n, sizeof(int))}};
  thr_status st = clamped && c->cord.half ? THR_OK : thr_nomem(err);
  for (int i = 0; i <= n && !st; i++)
    st = thr_draft_add_node(&d, (double[3]){i * step, 0, 1000}, NULL, false, err);
  for (int i = 0; i < n && !st; i++) {
    st = thr_draft_add_edge(&d, i, i + 1, 0, err);
    c->cord.half[i] = 2 * i;
  }
  if (!st) st = thr_draft_build(&d, 0, &c->frame, &read, err);
  thr_physics asked = thr_physics_default();
  asked.cord_diameter = CORD;
  asked.bore = BORE;
  asked.bead_diameter = width;
  asked.density = 400 / (width * width - acos(-1) / 4 * 4);
  if (!st) st = thr_physics_resolve(&asked, &c->frame, &c->physics, err);
  if (!st) st = thr_beads_make(&c->frame, &c->physics, &c->beads, err);
  if (!st) {
    clamped[0] = true;
    thr_beads_clamp(&c->beads, clamped);
  }
  free(clamped);
  thr_draft_destroy(&d);
  if (st) destroy(c);
  return st;
}

/* Moments about the lower edge of the interface at the wall. */
static double statics(const cantilever *c)
{
  double moment = 0;
  for (int i = 1; i < c->beads.n_beads; i++)
    moment += c->beads.mass[i] * c->physics.gravity *
              (c->beads.mass_centre[i][0] - c->beads.middle[0][0]);
  return moment / (c->beads.width / 2);
}

typedef struct {
  double statics, lower, upper;
} pulls;

static thr_status measure(const cantilever *c, pulls *out, thr_err *err)
{
  int n = c->cord.n_passes;
  double *tension = thr_calloc((size_t)n, sizeof *tension);
  double *press = thr_calloc((size_t)n, sizeof *press);
  const double *profile[1] = {tension};
  thr_holding h = {0};
  thr_limits none = {0};
  thr_status st = tension && press ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n && !st; i++)
    tension[i] = 1;
  if (!st) {
    thr_holding_press(&c->cord, 1, profile, press);
    st = thr_holding_pull(&c->beads, &c->frame, &c->physics, press, true, &none, &h, err);
  }
  *out = (pulls){statics(c), h.lower, h.upper};
  thr_holding_destroy(&h);
  free(tension);
  free(press);
  return st;
}

static thr_status one(int n, double width, pulls *out, thr_err *err)
{
  cantilever c;
  thr_status st = make(&c, n, width, err);
  if (st) return st;
  st = measure(&c, out, err);
  destroy(&c);
  return st;
}

thr_status validate_cantilever(report *r, thr_err *err)
{
  static const struct {
    int n;
    double width;
  } v[] = {{5, 20}, {10, 20}, {20, 20}, {10, 14}, {10, 28}};
  enum { N = sizeof v / sizeof *v };
  pulls found[N];
  thr_status st = THR_OK;
  for (int i = 0; i < N && !st; i++)
    st = one(v[i].n, v[i].width, &found[i], err);
  if (st) return st;
  report_section(
      r, "The thesis's Fig. 12: cantilever",
      "A row of beads of the same total weight, held by one straight cord. The needed "
      "tension must not depend on the "
      "number of beads, "
      "and go as 1 / width. Newtons: limit analysis against moments about the lower edge at "
      "the "
      "wall, of a cord in the middle of its bores. The play of a bore, half of bore "
      "less cord, lets it lie higher: below "
      "the pull of that lever nothing holds the row.");
  for (int i = 0; i < N; i++) {
    char what[80];
    snprintf(what, sizeof what, "%d beads %g mm wide: an equilibrium from, N", v[i].n, v[i].width);
    report_relative(r, what, found[i].statics, found[i].upper, 1e-6);
    snprintf(what, sizeof what, "%d beads %g mm wide: nothing holds it below, N", v[i].n,
             v[i].width);
    report_relative(r, what, found[i].statics * v[i].width / (v[i].width + BORE - CORD),
                    found[i].lower, 1e-6);
  }
  report_relative(r, "statics: 20 beads / 5 beads", 1, found[2].statics / found[0].statics, 0.02);
  report_relative(r, "statics: 14 mm / 28 mm", 2, found[3].statics / found[4].statics, 1e-6);
  return THR_OK;
}
