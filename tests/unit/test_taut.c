/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The taut path: closed forms by hand, a brute force that knows the openings only by distances to
 * the channels' axes, symmetry.
 */
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 7001 };

/* A cord through n + 1 points in a row. */
typedef struct {
  thr_frame frame;
  thr_cord cord;
} strung;

static strung string_up(int n, const double (*at)[3])
{
  int(*edge)[2] = calloc((size_t)n, sizeof *edge);
  strung s = {.cord = {.id = "A", .n_passes = n, .half = calloc((size_t)n, sizeof *s.cord.half)}};
  for (int i = 0; i < n; i++) {
    edge[i][0] = i;
    edge[i][1] = i + 1;
    s.cord.half[i] = 2 * i;
  }
  s.frame = frame_make(n + 1, at, n, (const int(*)[2])edge, NULL, NULL);
  free(edge);
  return s;
}

static void unstring(strung *s)
{
  thr_frame_destroy(&s->frame);
  free(s->cord.half);
}

typedef struct {
  double turn[MOST], point[MOST][3], length, turning;
} result;

static result *pull_thick(const strung *s, double radius, double clearance)
{
  result *r = calloc(1, sizeof *r);
  thr_err err = {0};
  ck_assert_msg(
      !thr_taut_path(&s->frame, &s->cord, radius, clearance, r->turn, r->point, &r->length, &err),
      "%s", err.text);
  for (int i = 0; i + 1 < s->cord.n_passes; i++)
    r->turning += r->turn[i];
  return r;
}

static result *pull_taut(const strung *s, double clearance)
{
  return pull_thick(s, 0, clearance);
}

static double distance(const double a[3], const double b[3])
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

static void zigzag(int n, double edge, double turn, double (*at)[3])
{
  for (int i = 0; i <= n; i++) {
    at[i][0] = i * edge * cos(turn / 2);
    at[i][1] = i % 2 * edge * sin(turn / 2);
    at[i][2] = 0;
  }
}

static void random_points(rng *r, int n, double least, double most_turn, double (*at)[3])
{
  double u[3] = {1, 0, 0};
  memset(at, 0, (size_t)(n + 1) * sizeof *at);
  for (int i = 1; i <= n; i++) {
    double edge = least * (1 + rng_unit(r));
    for (int k = 0; k < 3; k++)
      at[i][k] = at[i - 1][k] + edge * u[k];
    double v[3], norm, cosine;
    do {
      for (int k = 0; k < 3; k++)
        v[k] = 2 * rng_unit(r) - 1;
      norm = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      cosine = (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / norm;
    } while (norm > 1 || norm < 0.1 || cosine < cos(most_turn));
    for (int k = 0; k < 3; k++)
      u[k] = v[k] / norm;
  }
}

START_TEST(straight_run_does_not_turn)
{
  static double at[MOST][3];
  for (int i = 0; i < MOST; i++) {
    at[i][0] = 0.6 * i;
    at[i][1] = 0.64 * i;
    at[i][2] = 0.48 * i;
  }
  for (int n = 1; n < MOST; n = 7 * n + 1) {
    strung s = string_up(n, (const double(*)[3])at);
    for (double clearance = 0; clearance < 0.4; clearance += 0.1) {
      result *r = pull_taut(&s, clearance);
      ck_assert_double_eq_tol(r->turning, 0, 1e-9);
      ck_assert_double_eq_tol(r->length, n, 1e-10 * n);
      free(r);
    }
    unstring(&s);
  }
}
END_TEST

START_TEST(without_clearance_it_is_the_centre_line)
{
  rng r = rng_make((uint64_t)_i + 1);
  double at[31][3];
  random_points(&r, 30, 10, THR_PI, at);
  strung s = string_up(30, (const double(*)[3])at);
  for (int k = 0; k < 2; k++) { /* a clearance of next to nothing moves it by next to nothing */
    result *t = pull_taut(&s, k * 1e-5);
    for (int i = 0; i < 29; i++)
      ck_assert_double_eq_tol(t->turn[i], thr_turn_angle(&s.frame, 2 * i, 2 * i + 2),
                              k ? 1e-3 : 1e-14);
    for (int i = 0; i <= 30; i++)
      ck_assert_double_lt(distance(t->point[i], at[i]), k ? 1e-3 : 1e-14);
    ck_assert_double_eq_tol(t->length, thr_cord_length(&s.frame, &s.cord), k ? 1e-2 : 1e-9);
    free(t);
  }
  unstring(&s);
}
END_TEST

/* Two equal edges: the cord goes to the inside of the ellipse, or straight from end to end if that
 * is inside it. */
START_TEST(single_turn_by_hand)
{
  for (int a = 0; a <= 10; a++)
    for (int b = 0; b < 6; b++) {
      double turn = a * THR_PI / 12, c = 0.02 * b, edge = 1, half = turn / 2;
      const double at[3][3] = {{-edge * cos(half), -edge * sin(half), 1},
                               {0, 0, 1},
                               {edge * cos(half), -edge * sin(half), 1}};
      strung s = string_up(2, at);
      result *r = pull_taut(&s, c);
      double in = fmin(c / cos(half), edge * sin(half)), rest = edge * sin(half) - in;
      ck_assert_double_eq_tol(r->turn[0], 2 * atan2(rest, edge * cos(half)), 1e-9);
      ck_assert_double_eq_tol(r->length, 2 * hypot(rest, edge * cos(half)), 1e-11);
      ck_assert_double_eq_tol(r->point[1][1], -in, 1e-7);
      free(r);
      unstring(&s);
    }
}
END_TEST

/* Far from its ends a long zigzag or ring is pressed to the inside of every opening. */
START_TEST(long_zigzag_and_ring_by_hand)
{
  static double at[402][3];
  for (int k = 0; k < 4; k++) {
    double turn = (k + 1) * THR_PI / 6, in = 1 / cos(turn / 2);
    zigzag(401, 10, turn, at);
    strung s = string_up(401, (const double(*)[3])at);
    result *r = pull_taut(&s, 1);
    ck_assert_double_eq_tol(r->turn[200],
                            2 * atan2(10 * sin(turn / 2) - 2 * in, 10 * cos(turn / 2)), 1e-9);
    free(r);
    unstring(&s);
  }
  for (int sides = 5; sides < 12; sides++) {
    double radius = 5 / sin(THR_PI / sides);
    for (int i = 0; i < 402; i++) {
      at[i][0] = radius * cos(2 * THR_PI * (i % sides) / sides);
      at[i][1] = radius * sin(2 * THR_PI * (i % sides) / sides);
      at[i][2] = i * 1e-6; /* several nodes at one place would be welded */
    }
    strung s = string_up(401, (const double(*)[3])at);
    result *r = pull_taut(&s, 1);
    ck_assert_double_eq_tol(r->turn[200], 2 * THR_PI / sides, 1e-5);
    ck_assert_double_eq_tol(distance(r->point[200], r->point[201]),
                            2 * (radius - 1 / cos(THR_PI / sides)) * sin(THR_PI / sides), 1e-5);
    free(r);
    unstring(&s);
  }
}
END_TEST

/* Angle to a channel's axis of a straight line that touches a circle of this radius round the
 * bore's inner edge, dx along the axis and dy across it from where the line begins or touches the
 * next such circle the other way round. */
static double slope(double dx, double dy, double touching)
{
  return atan2(dy, dx) - asin(touching / hypot(dx, dy));
}

/* A thick cord in a plane is straight lines that touch circles of its radius round the inner edges.
 */
START_TEST(thick_cord_in_a_plane_by_hand)
{
  static double at[402][3];
  for (int a = 1; a <= 8; a++)
    for (double bore = 1.1; bore < 3; bore += 0.3) { /* radii; the cord's is 1 */
      double turn = a * THR_PI / 12, edge = 2.6 * bore * tan(turn / 2) + 10,
             in = bore * tan(turn / 2);
      zigzag(401, edge, turn, at);
      strung s = string_up(401, (const double(*)[3])at), two = string_up(2, (const double(*)[3])at);
      result *r = pull_thick(&s, 1, bore - 1), *t = pull_thick(&two, 1, bore - 1);
      ck_assert_double_eq_tol(r->turn[200], fmax(0, turn - 2 * slope(edge - 2 * in, 2 * bore, 2)),
                              1e-6);
      ck_assert_double_eq_tol(t->turn[0], fmax(0, turn - 2 * slope(edge - in, bore, 1)), 1e-6);
      free(r);
      free(t);
      unstring(&s);
      unstring(&two);
    }
}
END_TEST

/* Where the cord lies on the walls between all turns, its thickness makes no difference. */
START_TEST(thick_cord_round_a_ring_by_hand)
{
  static double at[402][3];
  for (int i = 0; i < 402; i++) {
    at[i][0] = 10 * cos(THR_PI * (i % 6) / 3);
    at[i][1] = 10 * sin(THR_PI * (i % 6) / 3);
    at[i][2] = i * 1e-6;
  }
  strung s = string_up(401, (const double(*)[3])at);
  result *r = pull_thick(&s, 1, 1), *thin = pull_taut(&s, 1);
  ck_assert_double_eq_tol(r->turn[200], THR_PI / 3, 1e-5);
  ck_assert_double_eq_tol(r->point[200][0], thin->point[200][0], 1e-5);
  free(r);
  free(thin);
  unstring(&s);
}
END_TEST

START_TEST(shallow_zigzag_becomes_straight)
{
  static double at[1001][3];
  zigzag(1000, 10, 10 * THR_PI / 180, at);
  strung s = string_up(1000, (const double(*)[3])at);
  result *r = pull_taut(&s, 1); /* half the zigzag's width, 0.44, fits */
  ck_assert_double_eq_tol(r->turning, 0, 1e-8);
  ck_assert_double_eq_tol(r->length, distance(at[0], at[1000]), 1e-8);
  free(r);
  unstring(&s);
}
END_TEST

START_TEST(u_turns_go_round_the_node)
{
  const double at[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  thr_frame f = frame_make(3, at, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
  strung s = {.frame = f, .cord = {.id = "A", .n_passes = 4, .half = (int[]){0, 2, 3, 1}}};
  result *r = pull_taut(&s, 0.1);
  ck_assert_double_eq_tol(r->turn[1], THR_PI, 1e-9);
  ck_assert_double_eq_tol(distance(r->point[2], at[2]), 0, 1e-12);
  ck_assert_double_eq_tol(distance(r->point[1], r->point[3]), 0, 1e-7);
  ck_assert_double_lt(r->turn[0], THR_PI / 2);
  free(r);
  thr_frame_destroy(&f);

  for (int k = 1; k < 12;
       k++) { /* nearly a U-turn: stays within the two beads, and still turns about as much */
    double off = pow(10, -k);
    const double sharp[3][3] = {{0, 0, 0}, {1, 0, 0}, {1 - cos(off), sin(off), 0}};
    s = string_up(2, sharp);
    r = pull_taut(&s, 0.1);
    ck_assert_double_le(distance(r->point[1], sharp[1]), 0.5);
    ck_assert_double_gt(r->turn[0], THR_PI / 2);
    ck_assert_double_le(r->turn[0], THR_PI);
    free(r);
    unstring(&s);
  }
}
END_TEST

/* ---- brute force ---- */

static double from_axis(const double p[3], const double a[3], const double b[3])
{
  double d[3], q[3], along = 0, length = distance(a, b), across = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = (b[k] - a[k]) / length;
    q[k] = p[k] - a[k];
    along += q[k] * d[k];
  }
  for (int k = 0; k < 3; k++)
    across += (q[k] - along * d[k]) * (q[k] - along * d[k]);
  return sqrt(across);
}

/* Two directions that span the mitre plane at node i: it holds the points as far before the node on
 * the one axis as behind it on the other. */
static void mitre_plane(const double (*at)[3], int i, double x[3], double y[3])
{
  double normal[3], before = distance(at[i - 1], at[i]), behind = distance(at[i], at[i + 1]);
  for (int k = 0; k < 3; k++)
    normal[k] = (at[i][k] - at[i - 1][k]) / before + (at[i + 1][k] - at[i][k]) / behind;
  const double zero[3] = {0, 0, 0};
  double norm = distance(normal, zero);
  double least[3] = {0, 0, 0};
  int k = 0;
  for (int j = 1; j < 3; j++)
    if (fabs(normal[j]) < fabs(normal[k])) k = j;
  least[k] = 1;
  for (int j = 0; j < 3; j++)
    x[j] = least[j] - normal[k] * normal[j] / (norm * norm);
  for (int j = 0; j < 3; j++)
    y[j] = (normal[(j + 1) % 3] * x[(j + 2) % 3] - normal[(j + 2) % 3] * x[(j + 1) % 3]) / norm;
}

/* Point of opening i in a direction of its plane, part of the way to where a channel's wall stops
 * it. */
static void point_in(const double (*at)[3], int i, double clearance, double angle, double part,
                     double p[3])
{
  const double zero[3] = {0, 0, 0};
  double x[3], y[3], reach = 0;
  mitre_plane(at, i, x, y);
  double norm = distance(x, zero);
  for (double step = 64 * clearance; step > 1e-13 * clearance; step /= 2) {
    for (int k = 0; k < 3; k++)
      p[k] = at[i][k] + (reach + step) * (cos(angle) * x[k] + sin(angle) * y[k]) / norm;
    if (from_axis(p, at[i - 1], at[i]) <= clearance && from_axis(p, at[i], at[i + 1]) <= clearance)
      reach += step;
  }
  for (int k = 0; k < 3; k++)
    p[k] = at[i][k] + part * reach * (cos(angle) * x[k] + sin(angle) * y[k]) / norm;
}

/* The best place of one vertex between its two neighbours, by a grid that closes in on it. */
static void place_vertex(const double (*at)[3], int i, double clearance, double (*p)[3])
{
  double angle = 0, part = 0.5, least = INFINITY, q[3], best[3] = {0};
  for (double width = 1; width > 1e-5; width *= 0.6) {
    double middle = angle, height = part;
    for (int a = -4; a <= 4; a++)
      for (int b = -2; b <= 2; b++) {
        double u = middle + a * width * THR_PI / 4, v = fmin(1, fmax(0, height + b * width / 4));
        point_in(at, i, clearance, u, v, q);
        double length = distance(p[i - 1], q) + distance(q, p[i + 1]);
        if (length >= least) continue;
        least = length;
        angle = u;
        part = v;
        memcpy(best, q, sizeof best);
      }
  }
  memcpy(p[i], best, sizeof best);
}

START_TEST(no_shorter_path_by_brute_force)
{
  rng random = rng_make((uint64_t)_i + 1);
  int n = rng_between(&random, 2, 6);
  double at[7][3], p[7][3], clearance = 0.2 + 0.8 * rng_unit(&random);
  random_points(&random, n, 5, 2.0, at); /* up to 115 degrees: the openings are whole ellipses */
  strung s = string_up(n, (const double(*)[3])at);
  result *r = pull_taut(&s, clearance);
  memcpy(p, at, sizeof p);
  for (int sweep = 0; sweep < 20; sweep++)
    for (int i = 1; i < n; i++)
      place_vertex((const double(*)[3])at, i, clearance, p);
  double length = 0, own = 0;
  for (int i = 0; i < n; i++) {
    length += distance(p[i], p[i + 1]);
    own += distance(r->point[i], r->point[i + 1]);
    if (i > 0) {
      double x[3], y[3], out[3];
      mitre_plane((const double(*)[3])at, i, x, y);
      for (int k = 0; k < 3; k++)
        out[k] = x[(k + 1) % 3] * y[(k + 2) % 3] - x[(k + 2) % 3] * y[(k + 1) % 3];
      double off = 0;
      for (int k = 0; k < 3; k++)
        off += out[k] * (r->point[i][k] - at[i][k]);
      ck_assert_double_eq_tol(off, 0, 1e-9);
      ck_assert_double_le(from_axis(r->point[i], at[i - 1], at[i]), clearance * (1 + 1e-9));
      ck_assert_double_le(from_axis(r->point[i], at[i], at[i + 1]), clearance * (1 + 1e-9));
    }
  }
  ck_assert_double_eq_tol(r->length, own, 1e-9 * own);
  ck_assert_double_le(r->length, length * (1 + 1e-9));
  ck_assert_double_eq_tol(r->length, length, 1e-8 * length);
  free(r);
  unstring(&s);
}
END_TEST

/* ---- symmetry, size ---- */

START_TEST(turned_scaled_or_reversed_it_is_the_same)
{
  rng random = rng_make((uint64_t)_i + 1);
  enum { N = 60 };
  double at[N + 1][3], other[N + 1][3], scale = pow(10, rng_between(&random, -6, 6)),
                                        angle = 6 * rng_unit(&random);
  random_points(&random, N, 10, 2.5, at);
  for (int i = 0; i <= N; i++) {
    const double *q = at[N - i];
    other[i][0] = scale * (cos(angle) * q[0] - sin(angle) * q[1]);
    other[i][1] = scale * q[2];
    other[i][2] = scale * (sin(angle) * q[0] + cos(angle) * q[1]);
  }
  strung a = string_up(N, (const double(*)[3])at), b = string_up(N, (const double(*)[3])other);
  result *r = pull_thick(&a, 0.7, 1), *t = pull_thick(&b, 0.7 * scale, scale);
  ck_assert_double_eq_tol(t->length, scale * r->length, 1e-7 * t->length);
  for (int i = 0; i + 1 < N; i++)
    ck_assert_double_eq_tol(r->turn[i], t->turn[N - 2 - i], 2e-6);
  free(r);
  free(t);
  unstring(&a);
  unstring(&b);
}
END_TEST

START_TEST(more_clearance_is_shorter)
{
  rng random = rng_make(3);
  static double at[MOST][3];
  random_points(&random, MOST - 1, 10, 1.2, at);
  strung s = string_up(MOST - 1, (const double(*)[3])at);
  double last = thr_cord_length(&s.frame, &s.cord) * (1 + 1e-12);
  for (double c = 0.25; c < 3; c *= 2) {
    result *r = pull_thick(&s, 1, c);
    ck_assert_double_lt(r->length, last);
    last = r->length;
    free(r);
  }
  ck_assert_double_gt(last, distance(at[0], at[MOST - 1]));
  unstring(&s);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  const double at[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const double wrong[] = {-1, NAN, INFINITY};
  strung s = string_up(2, at);
  double turn[1], length;
  for (int i = 0; i < 3; i++) {
    thr_err err = {0};
    assert_status(thr_taut_path(&s.frame, &s.cord, 0, wrong[i], turn, NULL, &length, &err),
                  THR_EINPUT, &err, "clearance");
    assert_status(thr_taut_path(&s.frame, &s.cord, wrong[i], 0.1, turn, NULL, &length, &err),
                  THR_EINPUT, &err, "radius");
  }
  for (long k = 1;; k++) {
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = thr_taut_path(&s.frame, &s.cord, 0.1, 0.1, turn, NULL, NULL, &err);
    thr_alloc_fail_at(0);
    if (!st) break;
    ck_assert_int_eq(st, THR_ENOMEM);
    ck_assert_int_lt(k, 100);
  }
  unstring(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("taut");
  ADD_TEST(s, 10, straight_run_does_not_turn);
  ADD_LOOP(s, 10, without_clearance_it_is_the_centre_line, 0, 10);
  ADD_TEST(s, 10, single_turn_by_hand);
  ADD_TEST(s, 10, long_zigzag_and_ring_by_hand);
  ADD_TEST(s, 10, thick_cord_in_a_plane_by_hand);
  ADD_TEST(s, 10, thick_cord_round_a_ring_by_hand);
  ADD_TEST(s, 10, shallow_zigzag_becomes_straight);
  ADD_TEST(s, 10, u_turns_go_round_the_node);
  ADD_EXAMPLES(s, 20, no_shorter_path_by_brute_force, 10);
  ADD_EXAMPLES(s, 10, turned_scaled_or_reversed_it_is_the_same, 20);
  ADD_TEST(s, 20, more_clearance_is_shorter);
  ADD_TEST(s, 10, nonsense_is_refused);
  return run_suite(s);
}
