/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Views of steps in space: what is claimed of a view is measured anew from its projection. */
#include "diagram/space/space.h"
#include "graph/number.h"
#include "tests/support.h"

#include <math.h>

enum { EXAMPLES = 300 };

static double uniform(rng *r, double low, double high)
{
  return low + (high - low) * rng_unit(r);
}

/* A walk of n passes with edges between half a pitch and two; on a shell it goes over a sphere. */
static thr_camera_scene walk(rng *r, int n, bool shell)
{
  thr_camera_scene scene = {.n = n, .pitch = 10, .shell = shell};
  double at[3] = {0, 0, shell ? 40 : 0};
  for (int i = 0; i < n; i++) {
    double size = 0;
    for (int k = 0; k < 3; k++) {
      scene.from[i][k] = at[k];
      at[k] += uniform(r, -10, 10);
      size += at[k] * at[k];
    }
    for (int k = 0; k < 3; k++) {
      if (shell) at[k] *= 40 / sqrt(size);
      scene.to[i][k] = at[k];
      scene.outward[i][k] = shell ? 0.5 * (scene.from[i][k] + at[k]) / 40 : 0;
    }
  }
  return scene;
}

static double dist(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int k = 0; k < n; k++)
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sqrt(sum);
}

/* Length that a pass has to have on paper. */
static double wanted(const thr_camera_scene *scene, int i)
{
  return 9 * fmin(1, dist(scene->from[i], scene->to[i], 3) / (0.5 * scene->pitch));
}

static bool shows_all(const thr_camera_scene *scene, const thr_camera_view *view)
{
  for (int i = 0; i < scene->n; i++) {
    double a[3], b[3];
    thr_camera_project(view, scene->from[i], a);
    thr_camera_project(view, scene->to[i], b);
    if (dist(a, b, 2) < wanted(scene, i) - 1e-9) return false;
    if (scene->shell && thr_dot(scene->outward[i], view->camera.eye) <= 0) return false;
  }
  return true;
}

START_TEST(what_can_be_seen_is_seen)
{
  int some = 0, none = 0;
  for (int i = 0; i < EXAMPLES; i++) {
    rng r = rng_make((uint64_t)i);
    thr_camera_scene scene = walk(&r, 2 + i % 23, i % 3 == 0);
    const double size[2] = {186, 60 + i % 80};
    int any = i % 420, first = 0;
    bool legible = thr_camera_legible(&scene, size, &any);
    ck_assert_int_eq(thr_camera_legible(&scene, size, &first), legible); /* wherever it begins */
    thr_camera_view view = thr_camera_choose(&scene, size);
    ck_assert_msg(shows_all(&scene, &view) == legible, "example %d", i);
    some += legible;
    none += !legible;
  }
  ck_assert_int_gt(some, 20);
  ck_assert_int_gt(none, 20);
}
END_TEST

/* The camera is a right-handed system of unit vectors, upright; everything is on the paper. */
START_TEST(views_are_true_and_on_the_paper)
{
  for (int i = 0; i < EXAMPLES; i++) {
    rng r = rng_make((uint64_t)i);
    thr_camera_scene scene = walk(&r, 1 + i % 24, false);
    const double size[2] = {186, 120};
    thr_camera_view view = thr_camera_choose(&scene, size);
    const thr_camera *c = &view.camera;
    double across[3];
    thr_cross(c->right, c->up, across);
    for (int k = 0; k < 3; k++)
      ck_assert_double_eq_tol(across[k], c->eye[k], 1e-12);
    ck_assert_double_eq_tol(thr_dot(c->right, c->right), 1, 1e-12);
    ck_assert_double_eq_tol(thr_dot(c->right, c->up), 0, 1e-12);
    ck_assert(c->right[2] == 0 && c->up[2] > 0);
    for (int k = 0; k < scene.n; k++) {
      double at[3];
      thr_camera_project(&view, scene.to[k], at);
      ck_assert(at[0] >= 0 && at[0] <= size[0] && at[1] >= 0 && at[1] <= size[1]);
    }
  }
}
END_TEST

/* A flat zigzag that stands upright is seen at right angles or nearly so. */
START_TEST(a_flat_part_is_seen_from_its_front)
{
  thr_camera_scene scene = {.n = 8, .pitch = 10};
  const double size[2] = {186, 120};
  for (int i = 0; i < 8; i++) {
    const double from[3] = {10 * ((i + 1) / 2), 0, 10 * (i / 2)},
                 to[3] = {10 * ((i + 2) / 2), 0, 10 * ((i + 1) / 2)};
    for (int k = 0; k < 3; k++) {
      scene.from[i][k] = from[k];
      scene.to[i][k] = to[k];
    }
  }
  thr_camera_view view = thr_camera_choose(&scene, size);
  ck_assert_double_gt(fabs(view.camera.eye[1]), 0.97);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("camera");
  ADD_TEST(s, 20, what_can_be_seen_is_seen);
  ADD_TEST(s, 20, views_are_true_and_on_the_paper);
  ADD_TEST(s, 20, a_flat_part_is_seen_from_its_front);
  return run_suite(s);
}
