/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The directions that are tried lie evenly between looking up a little and looking down steeply. */
#include "diagram/space/camera.h"
#include "graph/angle.h"
#include "graph/sort.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 60, LEVELS = 7, DIRECTIONS = AROUND * LEVELS, STRIDE = 97 };
static const double LOWEST = -15,
                    LEVEL = 79.0 / 6; /* degrees of elevation, and from level to level */
static const double RING = 0.55;      /* pitches of context on each side */
static const double LARGEST = 48;     /* mm: a pitch is at most so large on paper */
static const double NUMBERS = 5.2,
                    NUMBER_AT =
                        0.7;    /* mm between two numbers; part of the way at which one stands */
static const double ROOMY = 14; /* mm: longer passes are no better */
static const double RIM = 0.02; /* cosine: nearer to the rim of a shell a pass counts as hidden */
static const double SHORT = 1000, HIDDEN = 1000, NEAR = 0.3, CROSSED = 0.15,
                    OUTWARD = 0.8; /* against foreshortening */

thr_camera thr_camera_at(double azimuth, double elevation)
{
  thr_camera c = {
      .right = {-sin(azimuth), cos(azimuth), 0},
      .eye = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)}};
  thr_cross(c.eye, c.right, c.up);
  return c;
}

/* 97 and 420 have no common divisor: neighbours in this order look from far apart. */
static thr_camera camera_number(int i)
{
  int k = i * STRIDE % DIRECTIONS;
  return thr_camera_at(2 * THR_PI * (k % AROUND) / AROUND,
                       (LOWEST + LEVEL * (k / AROUND)) * THR_PI / 180);
}

void thr_camera_project(const thr_camera_view *view, const double point[3], double at[3])
{
  const thr_camera *c = &view->camera;
  at[0] = 0.5 * view->size[0] + view->scale * (thr_dot(point, c->right) - view->middle[0]);
  at[1] = 0.5 * view->size[1] + view->scale * (-thr_dot(point, c->up) - view->middle[1]);
  at[2] = thr_dot(point, c->eye);
}

/* What the camera sees, in mm. */
typedef struct {
  thr_camera_view view;
  double a[THR_CAMERA_PASSES][2],
      b[THR_CAMERA_PASSES][2]; /* ends of the passes, mm from the middle */
  double length[THR_CAMERA_PASSES],
      part[THR_CAMERA_PASSES]; /* mm on paper; part of it that is not foreshortened */
  double least;                /* of the lengths, each as a part of what it has to be */
  double facing, most_hidden;  /* cosines between the eye and the outside: their mean; the least, at
                                  most 0 on the far side */
} sight;

static void look(const thr_camera_scene *scene, const thr_camera *camera, const double size[2],
                 sight *s)
{
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int i = 0; i < scene->n; i++)
    for (int end = 0; end < 2; end++) {
      const double *p = end ? scene->to[i] : scene->from[i];
      double *at = end ? s->b[i] : s->a[i];
      at[0] = thr_dot(p, camera->right);
      at[1] = -thr_dot(p, camera->up);
      for (int k = 0; k < 2; k++) {
        low[k] = fmin(low[k], at[k]);
        high[k] = fmax(high[k], at[k]);
      }
    }
  double ring = 2 * RING * scene->pitch;
  s->view = (thr_camera_view){.camera = *camera, .size = {size[0], size[1]}};
  s->view.scale =
      fmin(fmin(size[0] / (high[0] - low[0] + ring), size[1] / (high[1] - low[1] + ring)),
           LARGEST / scene->pitch);
  s->least = s->most_hidden = HUGE_VAL;
  s->facing = 0;
  for (int k = 0; k < 2; k++)
    s->view.middle[k] = 0.5 * (low[k] + high[k]);
  for (int i = 0; i < scene->n; i++) {
    double d[3] = {scene->to[i][0] - scene->from[i][0], scene->to[i][1] - scene->from[i][1],
                   scene->to[i][2] - scene->from[i][2]};
    double whole = sqrt(thr_dot(d, d)),
           wanted = THR_CAMERA_PASS * fmin(1, whole / (0.5 * scene->pitch));
    s->length[i] = s->view.scale * hypot(s->b[i][0] - s->a[i][0], s->b[i][1] - s->a[i][1]);
    s->part[i] = whole > 0 ? s->length[i] / (s->view.scale * whole) : 1;
    s->least = fmin(s->least, wanted > 0 ? s->length[i] / wanted : 1);
    double facing = thr_dot(scene->outward[i], camera->eye);
    s->facing += facing / scene->n;
    s->most_hidden = fmin(s->most_hidden, facing);
  }
}

/* Does a pass of a shell lie on its far side, or at its rim? */
static bool some_hidden(const thr_camera_scene *scene, const thr_camera *camera)
{
  for (int i = 0; i < scene->n && scene->shell; i++)
    if (thr_dot(scene->outward[i], camera->eye) <= RIM) return true;
  return false;
}

bool thr_camera_legible(const thr_camera_scene *scene, const double size[2], int *first)
{
  for (int k = 0; k < DIRECTIONS; k++) {
    const int i = (*first + k) % DIRECTIONS;
    thr_camera camera = camera_number(i);
    sight s = {0};
    if (some_hidden(scene, &camera)) continue;
    look(scene, &camera, size, &s);
    if (s.least < 1) continue;
    *first = i;
    return true;
  }
  return false;
}

/* What needs no pairs of passes; the more the better. */
static double judge_lengths(const thr_camera_scene *scene, const sight *s)
{
  double part[THR_CAMERA_PASSES], sum = 0, worth, shortest = HUGE_VAL;
  memcpy(part, s->part, (size_t)scene->n * sizeof *part);
  thr_sort_doubles(part, (size_t)scene->n);
  for (int i = 0; i < scene->n; i++) {
    sum += s->part[i];
    shortest = fmin(shortest, s->length[i]);
  }
  worth = sum / scene->n + 2 * part[scene->n / 4] + OUTWARD * s->facing;
  if (scene->shell && s->most_hidden <= RIM) worth -= HIDDEN + RIM - s->most_hidden;
  return worth + 0.5 * fmin(1, shortest / ROOMY) - (s->least < 1 ? SHORT + 1 - s->least : 0);
}

/* Twice the area of a triangle, with its sign. */
static double turn(const double a[2], const double b[2], const double c[2])
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool cross(const double a[2], const double b[2], const double c[2], const double d[2])
{
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/* What pairs of passes take off. */
static double judge_pairs(const thr_camera_scene *scene, const sight *s)
{
  double off = 0, at[THR_CAMERA_PASSES][2];
  for (int i = 0; i < scene->n; i++) {
    for (int k = 0; k < 2; k++)
      at[i][k] = s->view.scale * (s->a[i][k] + NUMBER_AT * (s->b[i][k] - s->a[i][k]));
    for (int j = 0; j < i; j++) {
      double apart = fabs(at[i][0] - at[j][0]) + fabs(at[i][1] - at[j][1]);
      if (apart < NUMBERS) off += NEAR * (1 - apart / NUMBERS);
      if (j < i - 1 && cross(s->a[i], s->b[i], s->a[j], s->b[j])) off += CROSSED;
    }
  }
  return off;
}

thr_camera_view thr_camera_choose(const thr_camera_scene *scene, const double size[2])
{
  thr_camera_view best = {0};
  double most = -HUGE_VAL;
  for (int i = 0; i < DIRECTIONS; i++) {
    thr_camera camera = camera_number(i);
    sight s = {0};
    look(scene, &camera, size, &s);
    double worth = judge_lengths(scene, &s);
    if (worth <= most) continue;
    worth -= judge_pairs(scene, &s);
    if (worth <= most) continue;
    most = worth;
    best = s.view;
  }
  return best;
}
