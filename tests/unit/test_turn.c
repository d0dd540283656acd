/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far two pieces can turn on a cord: closed forms against solids that are sampled, and against
 * Bullet. */
#include "eval/rise/turn.h"
#include "graph/number.h"
#include "tests/support.h"

#include <math.h>
#include <stdbool.h>

/* ---- solids of revolution about z, by their half section ---- */

enum { MOST_SIDES = 4, ROUND = 36, ALONG = 16, MOST_POINTS = MOST_SIDES * ROUND * ALONG };

typedef struct {
  int n_sides;
  double corner[MOST_SIDES][2]; /* distance from the axis, height; a convex polygon, either way */
} section;

typedef struct {
  int n;
  double at[MOST_POINTS][3];
} sample;

/* Is a point of the half plane inside by more than eps? */
static bool is_inside(const section *solid, double across, double up, double eps)
{
  int left = 0, right = 0;
  for (int i = 0; i < solid->n_sides; i++) {
    const double *a = solid->corner[i], *b = solid->corner[(i + 1) % solid->n_sides];
    if (a[0] == 0 && b[0] == 0) continue; /* the axis is no border */
    const double off = ((b[0] - a[0]) * (up - a[1]) - (b[1] - a[1]) * (across - a[0])) /
                       hypot(b[0] - a[0], b[1] - a[1]);
    left += off > eps;
    right += off < -eps;
    if (fabs(off) <= eps) return false;
  }
  return left == 0 || right == 0;
}

/* Samples one half of the surface, more densely towards z = 0: the other half mirrors it. */
static void take_sample(const section *solid, sample *out)
{
  out->n = 0;
  for (int i = 0; i < solid->n_sides; i++) {
    const double *a = solid->corner[i], *b = solid->corner[(i + 1) % solid->n_sides];
    if (a[0] == 0 && b[0] == 0) continue; /* the axis */
    const bool from_a = fabs(a[1]) <= fabs(b[1]);
    for (int k = 0; k < ALONG; k++) {
      const double t = (double)k / (ALONG - 1), part = fabs(a[1] - b[1]) > 2 ? t * t : t,
                   w = from_a ? part : 1 - part;
      for (int j = 0; j < ROUND; j++, out->n++) {
        const double angle = THR_PI * j / (ROUND - 1), across = a[0] + w * (b[0] - a[0]);
        out->at[out->n][0] = across * cos(angle);
        out->at[out->n][1] = across * sin(angle);
        out->at[out->n][2] = a[1] + w * (b[1] - a[1]);
      }
    }
  }
}

/* ---- search ---- */

typedef struct {
  section lower, upper;
  sample low, high;
  double rim[2]; /* of the lower solid: the cord may bend there */
} pair;

/* Is a point of the plane y = 0, given with the pose (x, z, angle) of the upper solid, in either?
 */
static bool is_in_way(const pair *two, const double pose[3], double x, double z)
{
  const double eps = 1e-3, c = cos(pose[2]), s = sin(pose[2]), a = x - pose[0], b = z - pose[1];
  return is_inside(&two->lower, fabs(x), z, eps) ||
         is_inside(&two->upper, fabs(c * a + s * b), -s * a + c * b, eps);
}

static bool sees(const pair *two, const double pose[3], const double from[2], const double to[2])
{
  for (int i = 1; i < 50; i++)
    if (is_in_way(two, pose, from[0] + i / 50. * (to[0] - from[0]),
                  from[1] + i / 50. * (to[1] - from[1])))
      return false;
  return true;
}

/* The length of the cord in a pose; infinite if it would have to take another way. */
static double cord_of(const pair *two, const double pose[3])
{
  const double middle[2] = {0, 0};
  double least = INFINITY;
  if (sees(two, pose, middle, pose)) return hypot(pose[0], pose[1]);
  for (int side = -1; side <= 1; side += 2) {
    const double rim[2] = {side * two->rim[0], two->rim[1]};
    if (sees(two, pose, middle, rim) && sees(two, pose, rim, pose))
      least = fmin(least, hypot(rim[0], rim[1]) + hypot(pose[0] - rim[0], pose[1] - rim[1]));
  }
  return least;
}

/* Do the solids overlap? */
static bool overlap(const pair *two, const double pose[3])
{
  const double eps = 2e-3, c = cos(pose[2]), s = sin(pose[2]);
  for (int i = 0; i < two->high.n; i++) {
    const double *p = two->high.at[i];
    if (is_inside(&two->lower, hypot(c * p[0] - s * p[2] + pose[0], p[1]),
                  s * p[0] + c * p[2] + pose[1], eps))
      return true;
  }
  for (int i = 0; i < two->low.n; i++) {
    const double *p = two->low.at[i], a = p[0] - pose[0], b = p[2] - pose[1];
    if (is_inside(&two->upper, hypot(c * a + s * b, p[1]), -s * a + c * b, eps)) return true;
  }
  return false;
}

/* The least cord at an angle, by trying places on a grid, and then on finer ones round the best. */
static double search(const pair *two, double angle)
{
  double best = 3, at[2] = {0, 0.5}, wide = 2.2;
  for (int level = 0; level < 4; level++, wide /= 7) {
    const double about[2] = {at[0], at[1]};
    for (int i = -20; i <= 20; i++)
      for (int k = -20; k <= 20; k++) {
        const double pose[3] = {about[0] + wide * i / 20, about[1] + wide * k / 20, angle};
        if (hypot(pose[0], pose[1]) >= best || overlap(two, pose)) continue;
        const double cord = cord_of(two, pose);
        if (cord >= best) continue;
        best = cord;
        at[0] = pose[0];
        at[1] = pose[1];
      }
  }
  return best;
}

static void make_pair(const thr_turn_piece *piece, pair *two)
{
  const double inner = piece->shape == THR_TURN_TUBE ? piece->radius - piece->wall : 0,
               r = piece->radius;
  if (piece->shape == THR_TURN_CONE) {
    const double deep = r / tan(piece->tip);
    two->lower = (section){4, {{0, 0}, {r, deep}, {r, -5}, {0, -5}}};
    two->upper = (section){4, {{0, 0}, {r, deep}, {r, 5}, {0, 5}}};
    two->rim[1] = deep;
  } else {
    two->lower = (section){4, {{inner, 0}, {r, 0}, {r, -5}, {inner, -5}}};
    two->upper = (section){4, {{inner, 0}, {r, 0}, {r, 5}, {inner, 5}}};
    two->rim[1] = 0;
  }
  two->rim[0] = r;
  take_sample(&two->lower, &two->low);
  take_sample(&two->upper, &two->high);
}

static const thr_turn_piece pieces[] = {
    {THR_TURN_CYLINDER, 1, 0, 0},      {THR_TURN_TUBE, 1, 0.05, 0},
    {THR_TURN_TUBE, 1, 0.2, 0},        {THR_TURN_TUBE, 1, 0.5, 0},
    {THR_TURN_CONE, 1, 0, THR_PI / 3}, {THR_TURN_CONE, 1, 0, THR_PI / 4},
    {THR_TURN_CONE, 1, 0, THR_PI / 6}};

/* The search finds a place with hardly more cord than the closed form, and none with less: up to
 * what sampled surfaces may overlap. Narrow tips on a rim are beyond its grid. */
START_TEST(cord_of_sampled_solids)
{
  static const double degrees[] = {10, 40, 60, 80, 100, 140};
  static pair two;
  const thr_turn_piece *piece = &pieces[_i];
  make_pair(piece, &two);
  for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
    const double angle = degrees[i] / 180 * THR_PI;
    if (piece->tip > 0 && piece->tip < THR_PI / 4 && angle > THR_PI / 3 + 1e-9) break;
    ck_assert_double_eq_tol(search(&two, angle), thr_turn_cord(piece, angle), 0.03);
  }
}
END_TEST

/* The functions of figure 5, with their kinks, the jump of figure 10, and both limits of tubes. */
START_TEST(known_forms)
{
  const thr_turn_piece solid = {THR_TURN_TUBE, 7, 7, 0}, blunt = {THR_TURN_CONE, 7, 0, THR_PI / 2};
  const thr_turn_piece cylinder = {THR_TURN_CYLINDER, 7, 0, 0}, cone = {THR_TURN_CONE, 7, 0, 1};
  for (int i = 0; i <= 20; i++) {
    const double part = i / 10., angle = part < 1 ? asin(part) : acos(1 - part);
    ck_assert_double_eq_tol(thr_turn_largest(&cylinder, 7 * part), angle, 1e-7);
    ck_assert_double_eq_tol(thr_turn_largest(&solid, 7 * part), angle, 1e-7);
    ck_assert_double_eq_tol(thr_turn_largest(&blunt, 7 * part), angle, 1e-7);
  }
  ck_assert_double_eq(thr_turn_largest(&cylinder, 15), THR_PI);

  const double side = 7 / sin(1);
  ck_assert_double_lt(thr_turn_largest(&cone, side * (1 - 1e-9)), THR_PI / 2);
  ck_assert_double_eq_tol(thr_turn_largest(&cone, side * (1 + 1e-9)), THR_PI - 1, 1e-6);
}
END_TEST

/* More cord never means less angle, whatever the piece. */
START_TEST(cord_grows_with_angle)
{
  for (int i = 1; i < 40; i++)
    for (int shape = 0; shape < THR_TURN_N_SHAPES; shape++) {
      const thr_turn_piece piece = {(thr_turn_shape)shape, 3, 3 * i / 40., THR_PI / 2 * i / 40};
      double before = 0;
      for (int k = 0; k <= 180; k++) {
        const double cord = thr_turn_cord(&piece, THR_PI * k / 180);
        ck_assert_double_ge(cord, before - 1e-9);
        before = cord;
      }
    }
}
END_TEST

/* Bullet knows nothing of the closed form. Edges of sectors may stop a rim by 3 degrees too soon.
 */
START_TEST(bodies_in_bullet)
{
  const thr_turn_piece *piece = &pieces[_i];
  const double most = thr_turn_cord(piece, THR_PI);
  for (int i = 1; i < 6; i += 2) {
    thr_err err = {0};
    double angle;
    assert_ok(thr_turn_simulate(piece, most * i / 6.5, &angle, &err), &err);
    ck_assert_double_eq_tol(angle, thr_turn_largest(piece, most * i / 6.5), 0.06);
  }
}
END_TEST

int main(void)
{
  enum { N = (int)(sizeof pieces / sizeof *pieces) };
  Suite *s = suite_create("turn");
  ADD_LOOP(s, 60, cord_of_sampled_solids, 0, N);
  ADD_TEST(s, 10, known_forms);
  ADD_TEST(s, 10, cord_grows_with_angle);
  ADD_LOOP(s, 60, bodies_in_bullet, 0, N);
  return run_suite(s);
}
