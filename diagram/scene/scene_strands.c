/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays the line of every pass: straight in its lane, and a Bezier curve through the node before it.
 *
 * The curve leaves the lane before in its direction and enters the lane behind in its direction.
 * Its control points lie on these two rays, at 0.58 of the way to the point where the rays meet, so
 * that a right angle becomes nearly a quarter circle; parallel lanes have an S, and a cord that
 * turns back has a loop that shows in the node.
 *
 * Example: from (0, 0) in direction (1, 0) to (1, 1) in direction (0, 1): the rays meet in (1, 0),
 * and the control points are (0.58, 0) and (1, 0.42). */
#include "diagram/scene/scene.h"

#include <math.h>

void thr_scene_curve_at(const double a[2], const double b[2], const double c[2], const double d[2],
                        double t, double at[2])
{
  double rest = 1 - t;
  for (int k = 0; k < 2; k++)
    at[k] = rest * rest * rest * a[k] + 3 * rest * rest * t * b[k] + 3 * rest * t * t * c[k] +
            t * t * t * d[k];
}

/* Computes the end of the lane of pass i, mm, at the pass's start or its end. */
static void lane_end(const thr_scene *scene, int i, bool end, double at[2])
{
  const thr_scene_pass *pass = &scene->pass[i];
  const thr_frame *frame = scene->paper;
  int e = pass->half >> 1, n = scene->first_on[e + 1] - scene->first_on[e],
      tail = end ? pass->half ^ 1 : pass->half;

  /* The lanes lie side by side round the edge's middle line, towards the normal of its
   * direction. */
  double lane_direction[2], outwards[2], offset = (pass->lane - 0.5 * (n - 1)) * scene->lane[e];
  const double *node = scene->at[thr_tail(frame, tail)];

  thr_scene_direction(scene, 2 * e, lane_direction);
  thr_scene_direction(scene, tail, outwards);

  for (int k = 0; k < 2; k++)
    at[k] = node[k] + scene->gap[tail] * outwards[k];
  at[0] -= offset * lane_direction[1];
  at[1] += offset * lane_direction[0];
}

/* Finds where two rays meet: p + a p_direction = q - b q_direction with a, b > 0. Returns false if
 * they do not, or are nearly parallel. */
static bool meet(const double p[2], const double p_direction[2], const double q[2],
                 const double q_direction[2], double *a, double *b)
{
  double x = q[0] - p[0], y = q[1] - p[1],
         cross = p_direction[0] * q_direction[1] - p_direction[1] * q_direction[0];

  if (fabs(cross) < 0.05) return false;
  *a = (x * q_direction[1] - y * q_direction[0]) / cross;
  *b = (p_direction[0] * y - p_direction[1] * x) / cross;
  return *a > 0 && *b > 0;
}

/* Computes the control points of a curve from p to q with directions at either end. reach: how far
 * the curve may go into the node, mm. */
static void bend(const double p[2], const double p_direction[2], const double q[2],
                 const double q_direction[2], double reach, double turn[2][2])
{
  double chord = hypot(q[0] - p[0], q[1] - p[1]), a = 0, b = 0;

  if (meet(p, p_direction, q, q_direction, &a, &b)) {
    /* 0.55 of the way to the corner is a quarter circle for a right angle. */
    a = 0.58 * fmin(a, fmax(2 * chord, reach));
    b = 0.58 * fmin(b, fmax(2 * chord, reach));
  } else if (p_direction[0] * q_direction[0] + p_direction[1] * q_direction[1] < 0) {
    a = b = fmax(0.67 * chord, 0.9 * reach); /* back again: a loop that shows in the node */
  } else {
    a = b = 0.42 * chord;
  }

  for (int k = 0; k < 2; k++) {
    turn[0][k] = p[k] + a * p_direction[k];
    turn[1][k] = q[k] - b * q_direction[k];
  }
}

/* Computes the control points of the curve between a mark and a lane: the curve leaves the mark
 * towards the node, or along the lane if the mark sits on the node. */
static void stub(const thr_scene *scene, const thr_mark *mark, const double lane[2],
                 const double into[2], double turn[2][2])
{
  const double *node = scene->at[mark->point];
  double length = hypot(lane[0] - mark->at[0], lane[1] - mark->at[1]);

  for (int k = 0; k < 2; k++) {
    turn[0][k] = mark->beside ? mark->at[k] + 0.6 * (node[k] - mark->at[k]) : mark->at[k];
    turn[1][k] = lane[k] - fmin(0.5 * length, scene->size.gap) * into[k];
  }
}

/* Lays the curve that leads to pass i, from the pass before or from a mark. */
static void lay_turn(thr_scene *scene, int i)
{
  thr_scene_pass *pass = &scene->pass[i];
  double before[2], ahead[2];
  thr_scene_direction(scene, pass->half, ahead);

  const thr_mark *mark = thr_scene_mark_before(scene, i);

  /* Out of a mark. */
  if (mark) {
    stub(scene, mark, pass->from, ahead, pass->turn);
    return;
  }

  /* Out of the pass before. */
  thr_scene_direction(scene, pass[-1].half, before);
  bend(pass[-1].to, before, pass->from, ahead,
       fmin(scene->gap[pass->half], scene->gap[pass[-1].half ^ 1]), pass->turn);
}

void thr_scene_lay_strands(thr_scene *scene)
{
  /* All straight parts first: curves join two of them. */
  for (int i = 0; i < scene->n_passes; i++) {
    lane_end(scene, i, false, scene->pass[i].from);
    lane_end(scene, i, true, scene->pass[i].to);
  }

  /* Curves, also from the last passes to their marks. */
  for (int i = 0; i < scene->n_passes; i++) {
    thr_scene_pass *pass = &scene->pass[i];
    lay_turn(scene, i);

    const thr_mark *mark = thr_scene_mark_after(scene, i);
    if (!mark) continue;

    /* The curve to a mark is that from the mark, reversed. */
    double back[2], turn[2][2];
    thr_scene_direction(scene, pass->half ^ 1, back);
    stub(scene, mark, pass->to, back, turn);
    for (int k = 0; k < 2; k++) {
      pass->leave[0][k] = turn[1][k];
      pass->leave[1][k] = turn[0][k];
    }
  }
}

/* Adds boxes along a curve through a node, as dense as the line is wide, at most 32. */
static thr_status box_curve(thr_scene *scene, const double a[2], const double b[2],
                            const double c[2], const double d[2], thr_err *err)
{
  thr_status st = THR_OK;
  double at[2], half = 0.5 * scene->size.cord + scene->size.casing;

  int steps = 2 + (int)fmin(hypot(d[0] - a[0], d[1] - a[1]) / half, 30);
  for (int k = 1; k < steps && !st; k++) {
    thr_scene_curve_at(a, b, c, d, (double)k / steps, at);
    st = thr_boxes_add(&scene->boxes, thr_box_around(at[0], at[1], half, half), THR_BOX_CORD, err);
  }
  return st;
}

thr_status thr_scene_box_strands(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;

  /* Every curve of every cord. */
  for (int i = 0; i < scene->n_passes && !st; i++) {
    const thr_scene_pass *pass = &scene->pass[i];
    const thr_mark *mark = thr_scene_mark_after(scene, i);

    st = box_curve(scene, thr_scene_turn_start(scene, i), pass->turn[0], pass->turn[1], pass->from,
                   err);
    if (!st && mark) st = box_curve(scene, pass->to, pass->leave[0], pass->leave[1], mark->at, err);
  }

  /* Feet. */
  for (int v = 0; v < scene->layout->n_points && !st; v++)
    if (scene->frame->foot && scene->frame->foot[thr_layout_node(scene->layout, v)])
      st = thr_boxes_add(
          &scene->boxes,
          thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot, scene->size.foot),
          THR_BOX_FOOT, err);
  return st;
}
