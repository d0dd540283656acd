/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What pieces look like on paper. Private to diagram/. */
#include "diagram/scene/scene.h"

#include "diagram/overview/overview.h"
#include "graph/angle.h"

#include <math.h>

static const double
    FACES = 0.9,
    FACES_PART = 0.035; /* mm between the faces of two pieces, at most that part of the pitch */
static const double OUTER =
    1.6; /* a corner on the outer side is at most so many half widths from the hub */
static const double SNUG =
    0.9; /* part of the room between its neighbours that a narrowed arm takes */

typedef struct {
  double at[2], along[2],
      side[2];         /* hub; unit vectors along the arm, and to the side of rising angles */
  double length, half; /* from the hub; half its width */
} arm;

/* Least angle between half-edge i of a point's around and its neighbours. */
static double least_angle(const thr_scene *scene, int first, int degree, int i)
{
  double own = scene->angle[scene->around[first + i]];
  double next = thr_scene_sweep(own, scene->angle[scene->around[first + (i + 1) % degree]]);
  double before =
      thr_scene_sweep(scene->angle[scene->around[first + (i + degree - 1) % degree]], own);
  return degree > 1 ? fmin(next, before) : 2 * THR_PI;
}

static arm arm_of(const thr_scene *scene, int point, int i)
{
  int first = scene->paper->first[point], degree = thr_degree(scene->paper, point),
      h = scene->around[first + i];
  double angle = least_angle(scene, first, degree, i);
  arm a = {.at = {scene->at[point][0], scene->at[point][1]}};
  a.length =
      0.5 *
      fmax(thr_scene_edge_length(scene, h >> 1) - fmin(FACES, FACES_PART * scene->size.pitch), 0);
  a.half = 0.5 * scene->bead[h >> 1];
  if (angle < 0.5 * THR_PI)
    a.half = fmin(a.half, fmax(SNUG * a.length * tan(0.5 * angle), 0.25 * a.half));
  thr_scene_direction(scene, h, a.along);
  a.side[0] = -a.along[1];
  a.side[1] = a.along[0];
  return a;
}

/* A point so far along an arm and to its side. */
static void put_point(const arm *a, double along, double side, bool first, thr_text *data)
{
  double at[2];
  for (int k = 0; k < 2; k++)
    at[k] = a->at[k] + along * a->along[k] + side * a->side[k];
  if (first)
    thr_svg_move(data, at);
  else
    thr_svg_line(data, at);
}

/* Between the side of an arm and the facing side of the next one, which turns off by an angle. */
static void put_corner(const arm *a, const arm *next, double angle, thr_text *data)
{
  if (fabs(sin(angle)) < 0.05 && angle < 1.5 * THR_PI) { /* in line */
    put_point(a, 0, a->half, false, data);
    put_point(next, 0, -next->half, false, data);
    return;
  }
  double along = (next->half + a->half * cos(angle)) / sin(angle), wide = fmax(a->half, next->half);
  if (angle > THR_PI && (sin(0.5 * angle) < 1 / OUTER || hypot(along, a->half) > OUTER * wide)) {
    put_point(a, -0.6 * wide, a->half, false, data);
    put_point(next, -0.6 * wide, -next->half, false, data);
  } else if (along < 0.98 * a->length)
    put_point(a, along, a->half, false, data);
}

void thr_outline_solid(const thr_scene *scene, int point, thr_text *data)
{
  int first = scene->paper->first[point], degree = thr_degree(scene->paper, point);
  for (int i = 0; i < degree; i++) {
    int next = (i + 1) % degree;
    arm a = arm_of(scene, point, i), b = arm_of(scene, point, next);
    double angle = degree > 1 ? thr_scene_sweep(scene->angle[scene->around[first + i]],
                                                scene->angle[scene->around[first + next]])
                              : 2 * THR_PI;
    put_point(&a, a.length, -a.half, i == 0, data);
    put_point(&a, a.length, a.half, false, data);
    put_corner(&a, &b, angle, data);
  }
  if (degree) thr_text_append(data, "z");
}

thr_box thr_outline_box(const thr_scene *scene, int point)
{
  double reach = scene->size.bead;
  for (int i = scene->paper->first[point]; i < scene->paper->first[point + 1]; i++)
    reach = fmax(reach, 0.5 * (thr_scene_edge_length(scene, scene->paper->half[i] >> 1) +
                               scene->bead[scene->paper->half[i] >> 1]));
  return thr_box_around(scene->at[point][0], scene->at[point][1], reach, reach);
}

void thr_outline_tube(const thr_scene *scene, int e, double width, double end[2][2])
{
  double along[2], length = thr_scene_edge_length(scene, e), near = scene->gap[2 * e],
                   far = scene->gap[2 * e + 1];
  const double *a = scene->at[scene->paper->edge[e][0]];
  thr_scene_direction(scene, 2 * e, along);
  double reach = fmax(0.5 * (length - near - far - width), 0), middle = 0.5 * (length + near - far);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++)
      end[k][i] = a[i] + (middle + (k ? reach : -reach)) * along[i];
}
