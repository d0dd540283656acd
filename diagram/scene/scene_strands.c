/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The line of every pass: straight in its lane, and a Bezier curve through the node before it. */
#include "diagram/scene/scene.h"

#include <math.h>

void thr_scene_curve_at(const double a[2], const double b[2], const double c[2], const double d[2],
                        double t, double at[2])
{
  double u = 1 - t;
  for (int k = 0; k < 2; k++)
    at[k] = u * u * u * a[k] + 3 * u * u * t * b[k] + 3 * u * t * t * c[k] + t * t * t * d[k];
}

/* End of the lane of pass i at its start or its end, and there the unit direction of travel. */
static void lane_end(const thr_scene *scene, int i, bool end, double at[2])
{
  const thr_scene_pass *pass = &scene->pass[i];
  const thr_frame *frame = scene->paper;
  int e = pass->half >> 1, n = scene->first_on[e + 1] - scene->first_on[e],
      tail = end ? pass->half ^ 1 : pass->half;
  double d[2], out[2], offset = (pass->lane - 0.5 * (n - 1)) * scene->lane[e];
  const double *o = scene->at[thr_tail(frame, tail)];
  thr_scene_direction(scene, 2 * e, d);
  thr_scene_direction(scene, tail, out);
  for (int k = 0; k < 2; k++)
    at[k] = o[k] + scene->gap[tail] * out[k];
  at[0] -= offset * d[1];
  at[1] += offset * d[0];
}

/* Where two rays meet: p + a * d = q - b * g, for a, b > 0; false if they do not. */
static bool meet(const double p[2], const double d[2], const double q[2], const double g[2],
                 double *a, double *b)
{
  double x = q[0] - p[0], y = q[1] - p[1], cross = d[0] * g[1] - d[1] * g[0];
  if (fabs(cross) < 0.05) return false;
  *a = (x * g[1] - y * g[0]) / cross;
  *b = (d[0] * y - d[1] * x) / cross;
  return *a > 0 && *b > 0;
}

/* Control points of a curve from p in direction d to q in direction g; reach is how far it may go
 * into the node. */
static void bend(const double p[2], const double d[2], const double q[2], const double g[2],
                 double reach, double turn[2][2])
{
  double chord = hypot(q[0] - p[0], q[1] - p[1]), a = 0, b = 0;
  if (meet(p, d, q, g, &a, &b)) {
    /* 0.55 of the way to the corner is a quarter circle for a right angle */
    a = 0.58 * fmin(a, fmax(2 * chord, reach));
    b = 0.58 * fmin(b, fmax(2 * chord, reach));
  } else if (d[0] * g[0] + d[1] * g[1] < 0) {
    a = b = fmax(0.67 * chord, 0.9 * reach); /* back again: a loop that shows in the node */
  } else {
    a = b = 0.42 * chord;
  }
  for (int k = 0; k < 2; k++) {
    turn[0][k] = p[k] + a * d[k];
    turn[1][k] = q[k] - b * g[k];
  }
}

/* The curve between a mark and a lane: leaves the mark towards the node, or along the lane if it
 * sits on the node. */
static void stub(const thr_scene *scene, const thr_mark *mark, const double lane[2],
                 const double into[2], double turn[2][2])
{
  const double *o = scene->at[mark->point];
  double length = hypot(lane[0] - mark->at[0], lane[1] - mark->at[1]);
  for (int k = 0; k < 2; k++) {
    turn[0][k] = mark->beside ? mark->at[k] + 0.6 * (o[k] - mark->at[k]) : mark->at[k];
    turn[1][k] = lane[k] - fmin(0.5 * length, scene->size.gap) * into[k];
  }
}

static void lay_turn(thr_scene *scene, int i)
{
  thr_scene_pass *pass = &scene->pass[i];
  double d[2], g[2];
  thr_scene_direction(scene, pass->half, g);
  const thr_mark *mark = thr_scene_mark_before(scene, i);
  if (mark) {
    stub(scene, mark, pass->from, g, pass->turn);
    return;
  }
  thr_scene_direction(scene, pass[-1].half, d);
  bend(pass[-1].to, d, pass->from, g, fmin(scene->gap[pass->half], scene->gap[pass[-1].half ^ 1]),
       pass->turn);
}

void thr_scene_lay_strands(thr_scene *scene)
{
  for (int i = 0; i < scene->n_passes; i++) {
    lane_end(scene, i, false, scene->pass[i].from);
    lane_end(scene, i, true, scene->pass[i].to);
  }
  for (int i = 0; i < scene->n_passes; i++) {
    thr_scene_pass *pass = &scene->pass[i];
    lay_turn(scene, i);
    const thr_mark *mark = thr_scene_mark_after(scene, i);
    if (!mark) continue;
    double back[2], turn[2][2];
    thr_scene_direction(scene, pass->half ^ 1, back);
    stub(scene, mark, pass->to, back, turn);
    for (int k = 0; k < 2; k++) {
      pass->leave[0][k] = turn[1][k];
      pass->leave[1][k] = turn[0][k];
    }
  }
}

/* Boxes along a curve through a node, as dense as the line is wide. */
static thr_status box_curve(thr_scene *scene, const double a[2], const double b[2],
                            const double c[2], const double d[2], thr_err *err)
{
  thr_status st = THR_OK;
  double at[2], half = 0.5 * scene->size.cord + scene->size.casing;
  int n = 2 + (int)fmin(hypot(d[0] - a[0], d[1] - a[1]) / half, 30);
  for (int k = 1; k < n && !st; k++) {
    thr_scene_curve_at(a, b, c, d, (double)k / n, at);
    st = thr_boxes_add(&scene->boxes, thr_box_around(at[0], at[1], half, half), THR_BOX_CORD, err);
  }
  return st;
}

thr_status thr_scene_box_strands(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    const thr_mark *mark = thr_scene_mark_after(scene, i);
    st = box_curve(scene, thr_scene_turn_start(scene, i), pass->turn[0], pass->turn[1], pass->from,
                   err);
    if (!st && mark) st = box_curve(scene, pass->to, pass->leave[0], pass->leave[1], mark->at, err);
  }
  for (int v = 0; v < scene->layout->n_points && !st; v++)
    if (scene->frame->foot && scene->frame->foot[thr_layout_node(scene->layout, v)])
      st = thr_boxes_add(
          &scene->boxes,
          thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot, scene->size.foot),
          THR_BOX_FOOT, err);
  return st;
}
