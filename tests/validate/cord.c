/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole cords of 20 turns in Bullet against joints composed along the taut path. */
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "tests/validate/drags.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CORDS = 5, SEGMENT = 10 };
static const double degree = THR_PI / 180, BORE = 2;

typedef struct {
  double nominal, taut; /* rad */
} turning;

/* The corners of the channels as nodes: the same course that the drag experiment builds, made here
 * a second time. */
static void corners(const drag_case *c, double (*xyz)[3])
{
  double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
  for (int i = 0; i <= c->n; i++) {
    for (int k = 0; k < 3; k++)
      xyz[i + 1][k] = xyz[i][k] + SEGMENT * x[k];
    if (i == c->n) return;
    double ct = cos(c->twist[i]), st = sin(c->twist[i]), ca = cos(c->turn[i]), sa = sin(c->turn[i]);
    for (int k = 0; k < 3; k++) {
      double inside = ct * y[k] + st * z[k], up = ct * z[k] - st * y[k], ahead = x[k];
      x[k] = ca * ahead + sa * inside;
      y[k] = ca * inside - sa * ahead;
      z[k] = up;
    }
  }
}

static thr_status find_turning(const drag_case *c, turning *out, thr_err *err)
{
  double xyz[MOST_TURNS + 2][3] = {{0}}, turn[MOST_TURNS + 1];
  int half[MOST_TURNS + 1];
  thr_draft d = {0};
  thr_frame f = {0};
  thr_read_report read;
  thr_status st = THR_OK;
  corners(c, xyz);
  for (int i = 0; i < c->n + 2 && !st; i++)
    st = thr_draft_add_node(&d, xyz[i], NULL, false, err);
  for (int i = 0; i < c->n + 1 && !st; i++)
    st = thr_draft_add_edge(&d, i, i + 1, 0, err);
  for (int i = 0; i < c->n + 1; i++)
    half[i] = 2 * i;
  if (!st) st = thr_draft_build(&d, 0, &f, &read, err);
  thr_cord cord = {.id = "A", .n_passes = c->n + 1, .half = half};
  if (!st) st = thr_taut_path(&f, &cord, 1, BORE - 1, turn, NULL, NULL, err);
  *out = (turning){st ? 0 : thr_cord_turning(&f, &cord, false), 0};
  for (int i = 0; i < c->n && !st; i++)
    out->taut += turn[i];
  thr_frame_destroy(&f);
  thr_draft_destroy(&d);
  return st;
}

static drag_case make(int kind)
{
  drag_case c = {.n = MOST_TURNS,
                 .drag = {.segment = SEGMENT,
                          .bore = BORE,
                          .mu = 0.1,
                          .seed = 1,
                          .time_step = 1,
                          .iterations = 1,
                          .spacing = 1,
                          .settle = 2}};
  uint64_t state = 12345;
  for (int i = 0; i < c.n; i++) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    double unit = (double)(state >> 11) * 0x1p-53;
    switch (kind) {
    case 0: c.turn[i] = 60 * degree, c.twist[i] = i ? 180 * degree : 0; break; /* zigzag */
    case 1: c.turn[i] = 30 * degree, c.twist[i] = i ? 180 * degree : 0; break;
    case 2: c.turn[i] = 30 * degree, c.twist[i] = 20 * degree; break; /* helix */
    case 3: c.turn[i] = 60 * degree, c.twist[i] = 45 * degree; break;
    default:
      c.turn[i] = (30 + 50 * unit) * degree, c.twist[i] = (120 + 120 * fmod(unit * 97, 1)) * degree;
      break;
    }
  }
  return c;
}

thr_status validate_cord(report *r, thr_err *err)
{
  static const char *const name[CORDS] = {"zigzag of 60 degrees", "zigzag of 30 degrees",
                                          "helix of 30 degrees", "helix of 60 degrees",
                                          "random in space"};
  drag_case c[CORDS];
  turning t[CORDS];
  thr_drag_result found[CORDS];
  thr_status st = THR_OK;
  for (int i = 0; i < CORDS && !st; i++) {
    c[i] = make(i);
    st = find_turning(&c[i], &t[i], err);
  }
  if (!st) st = drags_run(c, CORDS, found, err);
  if (st) return st;
  report_section(r, "Cords of 20 turns",
                 "Straight pieces of 10 cord radii, bore twice the cord, mu 0.1. Expected: exp(mu "
                 "x turning of the taut path). "
                 "Cords that have "
                 "not settled are said and not judged.");
  for (int i = 0; i < CORDS; i++) {
    char what[120];
    snprintf(what, sizeof what, "%s: %.0f degrees nominal, %.0f taut, %.0f seen in Bullet", name[i],
             t[i].nominal / degree, t[i].taut / degree, found[i].taut / degree);
    if (found[i].status == THR_DRAG_SETTLED)
      report_relative(r, what, exp(c[i].drag.mu * t[i].taut), found[i].ratio, 0.15);
    else
      report_shown(r, what, exp(c[i].drag.mu * t[i].taut), found[i].ratio, "not settled");
  }
  return THR_OK;
}
