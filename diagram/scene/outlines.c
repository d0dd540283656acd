/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws what pieces look like on paper: the outline of a solid piece, and the middle line of a
 * tube.
 *
 * A solid piece has an arm to the middle of each of its edges. Its outline goes round the arms by
 * angle: along one side of an arm to its end face and back along the other side, then to the corner
 * with the next arm. Between two arms at an angle t, of half widths a and b, the sides meet at (b +
 * a cos t) / sin t from the hub. */
#include "diagram/scene/scene.h"

#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>

/* mm between the faces of two pieces, at most that part of the pitch */
static const double FACES = 0.9, FACES_PART = 0.035;

/* A corner on the outer side is at most so many half widths from the hub. */
static const double OUTER = 1.6;

/* Part of the room between its neighbours that a narrowed arm takes. */
static const double SNUG = 0.9;

/* An arm of a piece on paper. */
typedef struct {
  double at[2], along[2],
      side[2];         /* hub; unit vectors along the arm, and to the side of rising angles */
  double length, half; /* from the hub; half its width */
} outline_arm;

/* Returns the least angle between half-edge i round a point and its two neighbours. */
static double least_angle(const thr_scene *scene, int first, int degree, int i)
{
  double own = scene->angle[scene->around[first + i]];
  double next = thr_scene_sweep(own, scene->angle[scene->around[first + (i + 1) % degree]]);
  double before =
      thr_scene_sweep(scene->angle[scene->around[first + (i + degree - 1) % degree]], own);
  return degree > 1 ? fmin(next, before) : 2 * THR_PI;
}

/* Returns arm i, by angle, of the piece at a point. */
static outline_arm arm_of(const thr_scene *scene, int point, int i)
{
  int first = scene->paper->first[point], degree = thr_degree(scene->paper, point),
      h = scene->around[first + i];
  double angle = least_angle(scene, first, degree, i);
  outline_arm arm = {.at = {scene->at[point][0], scene->at[point][1]}};

  /* From the hub to the middle of the edge, less half the gap between the faces. */
  arm.length =
      0.5 *
      fmax(thr_scene_edge_length(scene, h >> 1) - fmin(FACES, FACES_PART * scene->size.pitch), 0);

  /* Arms that stand closer than a right angle are narrower. */
  arm.half = 0.5 * scene->bead[h >> 1];
  if (angle < 0.5 * THR_PI)
    arm.half = fmin(arm.half, fmax(SNUG * arm.length * tan(0.5 * angle), 0.25 * arm.half));

  thr_scene_direction(scene, h, arm.along);
  arm.side[0] = -arm.along[1];
  arm.side[1] = arm.along[0];
  return arm;
}

/* Appends a point so far along an arm and to its side, mm. */
static void put_point(const outline_arm *arm, double along, double side, bool first, thr_text *data)
{
  double at[2];
  for (int k = 0; k < 2; k++)
    at[k] = arm->at[k] + along * arm->along[k] + side * arm->side[k];

  if (first)
    thr_svg_move(data, at);
  else
    thr_svg_line(data, at);
}

/* Appends the corner between the side of an arm and the facing side of the next one, which turns
 * off by an angle. */
static void put_corner(const outline_arm *arm, const outline_arm *next, double angle,
                       thr_text *data)
{
  /* In line the sides do not meet: go on from one to the other at the hub. */
  if (fabs(sin(angle)) < 0.05 && angle < 1.5 * THR_PI) {
    put_point(arm, 0, arm->half, false, data);
    put_point(next, 0, -next->half, false, data);
    return;
  }

  /* On the outer side of a sharp turn the corner would lie far out: cut it off. */
  double along = (next->half + arm->half * cos(angle)) / sin(angle),
         wide = fmax(arm->half, next->half);
  if (angle > THR_PI && (sin(0.5 * angle) < 1 / OUTER || hypot(along, arm->half) > OUTER * wide)) {
    put_point(arm, -0.6 * wide, arm->half, false, data);
    put_point(next, -0.6 * wide, -next->half, false, data);
  } else if (along < 0.98 * arm->length)
    put_point(arm, along, arm->half, false, data);
}

void thr_outline_solid(const thr_scene *scene, int point, thr_text *data)
{
  int first = scene->paper->first[point], degree = thr_degree(scene->paper, point);

  for (int i = 0; i < degree; i++) {
    int next = (i + 1) % degree;

    outline_arm arm = arm_of(scene, point, i), next_arm = arm_of(scene, point, next);

    /* A single arm turns to itself by a full turn. */
    double angle = degree > 1 ? thr_scene_sweep(scene->angle[scene->around[first + i]],
                                                scene->angle[scene->around[first + next]])
                              : 2 * THR_PI;

    /* The end face, and the corner to the next arm. */
    put_point(&arm, arm.length, -arm.half, i == 0, data);
    put_point(&arm, arm.length, arm.half, false, data);
    put_corner(&arm, &next_arm, angle, data);
  }
  if (degree) thr_text_append(data, "z");
}

thr_box thr_outline_box(const thr_scene *scene, int point)
{
  double reach = scene->size.bead;

  /* Half the longest edge, and half the width of its arm. */
  for (int i = scene->paper->first[point]; i < scene->paper->first[point + 1]; i++)
    reach = fmax(reach, 0.5 * (thr_scene_edge_length(scene, scene->paper->half[i] >> 1) +
                               scene->bead[scene->paper->half[i] >> 1]));
  return thr_box_around(scene->at[point][0], scene->at[point][1], reach, reach);
}

void thr_outline_tube(const thr_scene *scene, int e, double width, double end[2][2])
{
  double along[2], length = thr_scene_edge_length(scene, e), near = scene->gap[2 * e],
                   far = scene->gap[2 * e + 1];
  const double *tail = scene->at[scene->paper->edge[e][0]];
  thr_scene_direction(scene, 2 * e, along);

  /* The line ends half a width before the tube does, since its ends are round. */
  double reach = fmax(0.5 * (length - near - far - width), 0), middle = 0.5 * (length + near - far);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++)
      end[k][i] = tail[i] + (middle + (k ? reach : -reach)) * along[i];
}
