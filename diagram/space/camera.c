/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses from which direction the passes of a step are drawn in parallel projection.
 *
 * 420 directions are tried: 60 azimuths in each of 7 levels of elevation, from looking up a little
 * to looking down steeply. A direction's value grows with the lengths of passes on paper as parts
 * of their lengths in space (mean, and twice the lower quartile), and with how far the passes face
 * the eye; passes that are too short or lie on the far side of a shell cost more than anything else
 * can bring; planes of the framework that are seen edge-on, numbers that lie on each other and
 * passes that cross cost a little.
 *
 * Example: a step round the foot of a dome is seen from its own side, from somewhat above. */
#include "diagram/space/space.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 60, LEVELS = 7, DIRECTIONS = AROUND * LEVELS, STRIDE = 97 };

/* degrees of elevation, and from level to level */
static const double LOWEST = -15, LEVEL = 79.0 / 6;
static const double RING = 0.55;  /* pitches of context on each side */
static const double LARGEST = 48; /* mm: a pitch is at most so large on paper */

/* mm between two numbers; part of the way at which one stands */
static const double NUMBERS = 5.2, NUMBER_AT = 0.7;
static const double ROOMY = 14; /* mm: longer passes are no better */
static const double RIM = 0.02; /* cosine: nearer to the rim of a shell a pass counts as hidden */

static const double EDGE_ON =
    0.2; /* sine: from a plane seen at so small an angle nothing is told */

/* against foreshortening */
static const double SHORT = 1000, HIDDEN = 1000, NEAR = 0.3, CROSSED = 0.15, OUTWARD = 0.8,
                    PLANE = 2;

thr_camera thr_camera_at(double azimuth, double elevation)
{
  /* The right is level, so that pictures stand upright. */
  thr_camera camera = {
      .right = {-sin(azimuth), cos(azimuth), 0},
      .eye = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)}};
  thr_cross(camera.eye, camera.right, camera.up);
  return camera;
}

/* Returns direction i. 97 and 420 have no common divisor: neighbours in this order look from far
 * apart, so that a search for any legible direction ends early. */
static thr_camera camera_number(int i)
{
  int k = i * STRIDE % DIRECTIONS;
  return thr_camera_at(2 * THR_PI * (k % AROUND) / AROUND,
                       (LOWEST + LEVEL * (k / AROUND)) * THR_PI / 180);
}

void thr_camera_project(const thr_camera_view *view, const double point[3], double at[3])
{
  const thr_camera *camera = &view->camera;
  at[0] = 0.5 * view->size[0] + view->scale * (thr_dot(point, camera->right) - view->middle[0]);
  at[1] = 0.5 * view->size[1] + view->scale * (-thr_dot(point, camera->up) - view->middle[1]);
  at[2] = thr_dot(point, camera->eye);
}

/* What the camera sees of the passes. */
typedef struct {
  thr_camera_view view;
  double from[THR_CAMERA_PASSES][2],
      to[THR_CAMERA_PASSES][2]; /* ends, in the plane of view; units */
  double length[THR_CAMERA_PASSES],
      part[THR_CAMERA_PASSES]; /* mm on paper; part of it that is not foreshortened */
  double least;                /* of the lengths, each as a part of what it has to be */
  double facing, most_hidden;  /* cosines between the eye and the outside: their mean; the least, at
                                  most 0 on the far side */
} camera_sight;

/* Projects the passes, chooses the scale that fills the paper, and measures the passes on paper. */
static void look(const thr_camera_scene *scene, const thr_camera *camera, const double size[2],
                 camera_sight *sight)
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

  /* The ends of the passes in units, and their bounding box. */
  for (int i = 0; i < scene->n; i++)
    for (int end = 0; end < 2; end++) {
      const double *point = end ? scene->to[i] : scene->from[i];
      double *at = end ? sight->to[i] : sight->from[i];
      at[0] = thr_dot(point, camera->right);
      at[1] = -thr_dot(point, camera->up);
      thr_widen(low, high, at, 2);
    }

  /* The box and a ring of context fill the paper. */
  double ring = 2 * RING * scene->pitch;
  sight->view = (thr_camera_view){.camera = *camera, .size = {size[0], size[1]}};
  sight->view.scale =
      fmin(fmin(size[0] / (high[0] - low[0] + ring), size[1] / (high[1] - low[1] + ring)),
           LARGEST / scene->pitch);

  /* The middle of the box lies in the middle of the paper. */
  sight->least = sight->most_hidden = HUGE_VAL;
  sight->facing = 0;
  for (int k = 0; k < 2; k++)
    sight->view.middle[k] = 0.5 * (low[k] + high[k]);

  /* Each pass: its length on paper, and how far it faces the eye. */
  for (int i = 0; i < scene->n; i++) {
    double direction[3] = {scene->to[i][0] - scene->from[i][0], scene->to[i][1] - scene->from[i][1],
                           scene->to[i][2] - scene->from[i][2]};
    double whole = sqrt(thr_dot(direction, direction)),
           wanted = THR_CAMERA_PASS * fmin(1, whole / (0.5 * scene->pitch));

    /* Short passes need only a part of THR_CAMERA_PASS. */
    sight->length[i] = sight->view.scale * hypot(sight->to[i][0] - sight->from[i][0],
                                                 sight->to[i][1] - sight->from[i][1]);
    sight->part[i] = whole > 0 ? sight->length[i] / (sight->view.scale * whole) : 1;
    sight->least = fmin(sight->least, wanted > 0 ? sight->length[i] / wanted : 1);

    /* The cosine between its outside and the direction to the eye. */
    double facing = thr_dot(scene->outward[i], camera->eye);
    sight->facing += facing / scene->n;
    sight->most_hidden = fmin(sight->most_hidden, facing);
  }
}

/* Returns whether a pass of a shell lies on its far side, or at its rim. */
static bool some_hidden(const thr_camera_scene *scene, const thr_camera *camera)
{
  for (int i = 0; i < scene->n && scene->shell; i++)
    if (thr_dot(scene->outward[i], camera->eye) <= RIM) return true;
  return false;
}

bool thr_camera_legible(const thr_camera_scene *scene, const double size[2], int *first)
{
  /* Begin with the direction that served last; the cheaper test comes first. */
  for (int k = 0; k < DIRECTIONS; k++) {
    const int i = (*first + k) % DIRECTIONS;
    thr_camera camera = camera_number(i);
    camera_sight sight = {0};

    if (some_hidden(scene, &camera)) continue;
    look(scene, &camera, size, &sight);

    if (sight.least < 1) continue;
    *first = i;
    return true;
  }
  return false;
}

/* Returns the value of a direction without what pairs of passes cost; the more the better. */
static double judge_lengths(const thr_camera_scene *scene, const camera_sight *sight)
{
  double part[THR_CAMERA_PASSES], sum = 0, value, shortest = HUGE_VAL;

  /* Sorted, the quarter is the lower quartile. */
  memcpy(part, sight->part, (size_t)scene->n * sizeof *part);
  thr_sort_doubles(part, (size_t)scene->n);

  for (int i = 0; i < scene->n; i++) {
    sum += sight->part[i];
    shortest = fmin(shortest, sight->length[i]);
  }

  /* Foreshortening, facing, and what makes a direction unfit. */
  value = sum / scene->n + 2 * part[scene->n / 4] + OUTWARD * sight->facing;
  if (scene->shell && sight->most_hidden <= RIM) value -= HIDDEN + RIM - sight->most_hidden;
  return value + 0.5 * fmin(1, shortest / ROOMY) -
         (sight->least < 1 ? SHORT + 1 - sight->least : 0);
}

/* Returns what planes of the framework cost that are seen edge-on. */
static double judge_planes(const thr_camera_scene *scene, const thr_camera *camera)
{
  double sum = 0;
  for (int i = 0; i < scene->n_planes; i++)
    sum += fmax(0, 1 - fabs(thr_dot(scene->plane[i], camera->eye)) / EDGE_ON);
  return scene->n_planes ? PLANE * sum / scene->n_planes : 0;
}

/* Returns twice the area of a triangle, with the sign of its orientation. */
static double turn(const double a[2], const double b[2], const double c[2])
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Returns whether two lines cross: each has the ends of the other on different sides. */
static bool cross(const double a[2], const double b[2], const double c[2], const double d[2])
{
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/* Returns what pairs of passes cost: numbers that lie on each other, and crossings. */
static double judge_pairs(const thr_camera_scene *scene, const camera_sight *sight)
{
  double off = 0, at[THR_CAMERA_PASSES][2];

  /* Where the numbers would stand, and how near they come to those before. */
  for (int i = 0; i < scene->n; i++) {
    for (int k = 0; k < 2; k++)
      at[i][k] = sight->view.scale *
                 (sight->from[i][k] + NUMBER_AT * (sight->to[i][k] - sight->from[i][k]));

    /* Consecutive passes meet at a hub and cannot cross. */
    for (int j = 0; j < i; j++) {
      double apart = fabs(at[i][0] - at[j][0]) + fabs(at[i][1] - at[j][1]);
      if (apart < NUMBERS) off += NEAR * (1 - apart / NUMBERS);
      if (j < i - 1 && cross(sight->from[i], sight->to[i], sight->from[j], sight->to[j]))
        off += CROSSED;
    }
  }
  return off;
}

thr_camera_view thr_camera_choose(const thr_camera_scene *scene, const double size[2])
{
  thr_camera_view best = {0};
  double most = -HUGE_VAL;

  /* Pairs are looked at only where the rest is better than the best so far. */
  for (int i = 0; i < DIRECTIONS; i++) {
    thr_camera camera = camera_number(i);
    camera_sight sight = {0};
    look(scene, &camera, size, &sight);
    double value = judge_lengths(scene, &sight) - judge_planes(scene, &camera);
    if (value <= most) continue;

    value -= judge_pairs(scene, &sight);
    if (value <= most) continue;
    most = value;
    best = sight.view;
  }
  return best;
}
