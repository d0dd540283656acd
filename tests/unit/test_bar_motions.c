/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motions of frameworks of bars: counts in closed form, laws of the basis, a four-bar linkage
 * against its circles, and cords that may only get shorter, with the proof added up in whole
 * numbers. */
#include "diagram/overview/overview.h"
#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits no_limits = {0};

static double distance(const double a[3], const double b[3])
{
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* How fast an edge gets longer. */
static double rate(const thr_frame *f, int e, const double (*velocity)[3])
{
  int a = f->edge[e][0], b = f->edge[e][1];
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += (f->xyz[b][i] - f->xyz[a][i]) * (velocity[b][i] - velocity[a][i]);
  return sum / distance(f->xyz[a], f->xyz[b]);
}

/* The basis: orthonormal, keeps every bar, neither moves nor turns as a whole. */
static void check_laws(const thr_bars *bars, const thr_bar_motions *m)
{
  const thr_frame *f = bars->frame;
  const size_t n = (size_t)f->n_nodes;
  for (int k = 0; k < m->count; k++) {
    const double(*one)[3] = (const double(*)[3])m->velocity + (size_t)k * n;
    for (int e = 0; e < f->n_edges; e++)
      if (!bars->cable || !bars->cable[e]) ck_assert_double_lt(fabs(rate(f, e, one)), 1e-8);
    for (int l = 0; l <= k; l++) {
      const double(*other)[3] = (const double(*)[3])m->velocity + (size_t)l * n;
      double sum = 0;
      for (size_t v = 0; v < n; v++)
        sum += thr_dot(one[v], other[v]);
      ck_assert_double_eq_tol(sum, k == l, 1e-8);
    }

    double moved[3] = {0}, turned[3] = {0}, turn[3];
    for (size_t v = 0; v < n; v++) {
      thr_cross(f->xyz[v], one[v], turn);
      for (int i = 0; i < 3; i++)
        moved[i] += one[v][i], turned[i] += turn[i];
    }
    if (!bars->held) ck_assert_double_lt(thr_dot(moved, moved) + thr_dot(turned, turned), 1e-12);
  }
}

/* Finds the motions of a framework, which is destroyed, and checks their number and laws. */
static void check_count(thr_frame f, int count)
{
  thr_err err = {0};
  thr_bar_motions m;
  thr_rigidity r;
  const thr_bars bars = {.frame = &f};
  assert_ok(thr_bar_motions_find(&bars, NULL, 0, &m, &err), &err);
  assert_ok(thr_rigidity_find(&f, &r, &err), &err);
  ck_assert_int_eq(m.count, r.motions);
  if (count >= 0) ck_assert_int_eq(m.count, count);
  ck_assert_int_eq(m.unclear, r.unclear);
  check_laws(&bars, &m);
  thr_bar_motions_destroy(&m);

  /* With the feet held. */
  const thr_bars held = {.frame = &f, .held = f.foot};
  assert_ok(thr_bar_motions_find(&held, NULL, 0, &m, &err), &err);
  ck_assert_int_eq(m.count, r.pinned);
  for (int k = 0; k < m.count * f.n_nodes; k++)
    if (f.foot[k % f.n_nodes]) ck_assert(thr_dot(m.velocity[k], m.velocity[k]) == 0);
  check_laws(&held, &m);
  thr_bar_motions_destroy(&m);
  thr_frame_destroy(&f);
}

START_TEST(counts)
{
  check_count(solid_make(TETRAHEDRON), 0);
  check_count(solid_make(ICOSAHEDRON), 0);
  check_count(solid_make(CUBE), 3 * 8 - 12 - 6);
  check_count(solid_make(DODECAHEDRON), 3 * 20 - 30 - 6);
  check_count(shape_make(THR_MAKE_SPHERE, 3, 0), 0); /* convex and triangulated: Cauchy, Dehn */
  check_count(ring_make(4), 2);
  check_count(path_make(5), 6);
  check_count(grid_make(4, 3), 3 * 12 - 17 - 6);
  check_count(wheel_make(6), 4);
  check_count(shape_make(THR_MAKE_DOME, 7, 0), 57);
}
END_TEST

/* The same framework with its edges in another order has the same basis. */
START_TEST(basis_is_canonical)
{
  thr_frame f = solid_make(CUBE), g = {0};
  thr_err err = {0};
  int edge[12][2];
  for (int e = 0; e < 12; e++)
    for (int s = 0; s < 2; s++)
      edge[e][s] = f.edge[11 - e][1 - s];
  g = frame_make(8, (const double(*)[3])f.xyz, 12, (const int(*)[2])edge, NULL, NULL);

  thr_bar_motions one, other;
  assert_ok(thr_bar_motions_find(&(thr_bars){.frame = &f}, NULL, 0, &one, &err), &err);
  assert_ok(thr_bar_motions_find(&(thr_bars){.frame = &g}, NULL, 0, &other, &err), &err);
  ck_assert_int_eq(one.count, other.count);
  for (int k = 0; k < one.count * 8; k++)
    for (int i = 0; i < 3; i++)
      ck_assert_double_eq_tol(one.velocity[k][i], other.velocity[k][i], 1e-9);
  thr_bar_motions_destroy(&one);
  thr_bar_motions_destroy(&other);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* ---- paths ---- */

/* A crank of 2 at (0, 0), a rocker of 3 at (4, 0): where the crank's pin is, the other pin is where
 * two circles meet. */
START_TEST(four_bar_linkage)
{
  static const double xyz[4][3] = {{0, 0, 0}, {0, 2, 0}, {4, 3, 0}, {4, 0, 0}};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  thr_frame f = frame_make(4, xyz, 4, edge, NULL, NULL);
  const bool held[4] = {true, false, false, true};
  const thr_bars bars = {.frame = &f, .held = held};
  const double start[4][3] = {{0}, {1, 0, 0}, {1, 0, 0}, {0}}, coupler = sqrt(17);
  thr_path path;
  thr_err err = {0};

  assert_ok(thr_motion_follow(&bars, NULL, 0, start, 0.05, 120, &no_limits, &path, &err), &err);
  ck_assert_int_gt(path.n_frames, 40);
  ck_assert_double_lt(path.change, 1e-9);
  for (int k = 0; k < path.n_frames; k++) {
    const double(*at)[3] = (const double(*)[3])path.at + (size_t)k * 4;
    double apart = distance(at[1], at[3]),
           along = (coupler * coupler - 9 + apart * apart) / (2 * apart),
           across = sqrt(coupler * coupler - along * along);
    double x = (at[3][0] - at[1][0]) / apart, y = (at[3][1] - at[1][1]) / apart;
    ck_assert_double_eq_tol(hypot(at[1][0], at[1][1]), 2, 1e-8);
    ck_assert_double_eq_tol(at[2][0], at[1][0] + along * x - across * y, 1e-6);
    ck_assert_double_eq_tol(at[2][1], at[1][1] + along * y + across * x, 1e-6);
    ck_assert(at[1][2] == 0 && at[2][2] == 0);
  }
  thr_path_destroy(&path);
  thr_frame_destroy(&f);
}
END_TEST

/* The middle of a straight bar of two, held at its ends, moves to first order only. */
START_TEST(infinitesimal_only)
{
  thr_frame f = path_make(3);
  const bool held[3] = {true, false, true};
  const thr_bars bars = {.frame = &f, .held = held};
  thr_bar_motions m;
  thr_path path;
  thr_err err = {0};
  assert_ok(thr_bar_motions_find(&bars, NULL, 0, &m, &err), &err);
  ck_assert_int_eq(m.count, 2);
  assert_ok(thr_motion_follow(&bars, NULL, 0, (const double(*)[3])m.velocity, 0.02, 10, &no_limits,
                              &path, &err),
            &err);
  ck_assert_int_eq(path.n_frames, 1);
  ck_assert_int_eq(path.end, THR_PATH_STIFF);
  thr_path_destroy(&path);
  thr_bar_motions_destroy(&m);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- pulling ---- */

/* A square of bars, drawn together along a diagonal until the diagonal is nothing. */
START_TEST(pulled_together)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static const int edge[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}};
  static const bool cable[5] = {[4] = true};
  thr_frame f = frame_make(4, xyz, 5, edge, NULL, NULL);
  const thr_bars bars = {.frame = &f, .cable = cable};
  int half = 8;
  const thr_cord cord = {.n_passes = 1, .half = &half};
  thr_pulling p;
  thr_path path;
  thr_err err = {0};
  assert_ok(thr_pulling_find(&bars, &cord, 1, &no_limits, &p, &err), &err);
  assert_ok(thr_motion_follow(&bars, &cord, 1, (const double(*)[3])p.velocity, 0.02, 100,
                              &no_limits, &path, &err),
            &err);
  ck_assert_int_eq(path.end, THR_PATH_TAUT);
  for (int k = 0; k < path.n_frames; k++) { /* diagonals: a^2 + b^2 = 4 */
    const double(*at)[3] = (const double(*)[3])path.at + (size_t)k * 4;
    ck_assert_double_eq_tol(pow(distance(at[0], at[2]), 2) + pow(distance(at[1], at[3]), 2), 4,
                            1e-8);
  }
  ck_assert_double_lt(distance(path.at[4 * path.n_frames - 4], path.at[4 * path.n_frames - 2]),
                      0.1);
  thr_path_destroy(&path);
  thr_pulling_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A square of side 1 with both diagonals, edges 4 and 5, as rhomb or square. */
static thr_frame square_make(double x, double y)
{
  const double xyz[4][3] = {{-x, 0, 0}, {0, -y, 0}, {x, 0, 0}, {0, y, 0}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}};
  return frame_make(4, xyz, 6, edge, NULL, NULL);
}

static void check_pulling(const thr_bars *bars, const thr_cord *cord, int n, bool moves)
{
  thr_pulling p;
  thr_err err = {0};
  const thr_frame *f = bars->frame;
  assert_ok(thr_pulling_find(bars, cord, n, &no_limits, &p, &err), &err);
  ck_assert_int_eq(p.moves, moves);
  ck_assert_double_lt(p.residual, 1e-9);

  if (moves) {
    double least = 0;
    for (int e = 0; e < f->n_edges; e++)
      if (!bars->cable[e])
        ck_assert_double_lt(fabs(rate(f, e, (const double(*)[3])p.velocity)), 1e-9);
    for (int c = 0; c < n; c++) {
      double sum = 0;
      for (int k = 0; k < cord[c].n_passes; k++)
        sum += rate(f, cord[c].half[k] >> 1, (const double(*)[3])p.velocity);
      ck_assert_double_eq_tol(sum, p.rate[c], 1e-9);
      ck_assert_double_lt(p.rate[c], 1e-9);
      least = fmin(least, p.rate[c]);
    }
    ck_assert_double_lt(least, -0.01);
  } else {
    /* Forces by length are whole multiples of the least one here: the balance is exact. */
    double by_length[6];
    long unit[6];
    for (int e = 0; e < f->n_edges; e++) {
      by_length[e] = p.force[e] / distance(f->xyz[f->edge[e][0]], f->xyz[f->edge[e][1]]);
      for (int c = 0; c < n; c++)
        for (int k = 0; k < cord[c].n_passes; k++)
          if (cord[c].half[k] >> 1 == e)
            by_length[e] += p.tension[c] / distance(f->xyz[f->edge[e][0]], f->xyz[f->edge[e][1]]);
    }
    for (int e = 0; e < f->n_edges; e++) {
      unit[e] = lround(by_length[e] / by_length[4]);
      ck_assert_double_eq_tol((double)unit[e] * by_length[4], by_length[e], 1e-9);
    }
    for (int c = 0; c < n; c++)
      ck_assert_double_ge(p.tension[c], 1 - 1e-12);
    for (int v = 0; v < f->n_nodes; v++)
      for (int i = 0; i < 3; i++) {
        long sum = 0;
        for (int e = 0; e < f->n_edges; e++)
          for (int s = 0; s < 2; s++)
            if (f->edge[e][s] == v)
              sum += unit[e] * lround(f->xyz[f->edge[e][1 - s]][i] - f->xyz[v][i]);
        ck_assert_int_eq(sum, 0);
      }
  }
  thr_pulling_destroy(&p);
}

START_TEST(cords_along_diagonals)
{
  static const bool cable[6] = {[4] = true, [5] = true}, one[6] = {[4] = true};
  int half[2] = {8, 10};
  const thr_cord each[2] = {{.n_passes = 1, .half = half}, {.n_passes = 1, .half = half + 1}},
                 both = {.n_passes = 2, .half = half};
  thr_frame square = square_make(1, 1), rhomb = square_make(2, 1);
  const thr_bars of_square = {.frame = &square, .cable = cable},
                 of_rhomb = {.frame = &rhomb, .cable = cable},
                 braced = {.frame = &square, .cable = one};

  /* A diagonal of its own for each cord, or one cord for both: a rhomb flattens. */
  check_pulling(&of_square, each, 1, true);
  check_pulling(&of_square, each, 2, false);
  check_pulling(&of_square, &both, 1, false);
  check_pulling(&of_rhomb, &both, 1, true);
  check_pulling(&of_rhomb, each, 2, false);
  check_pulling(&braced, each, 1, false); /* the other diagonal is a bar */

  /* What is left when cords keep their lengths, too: folding about a diagonal is none, as each is
   * kept; out of its plane a square of six edges moves to first order. */
  thr_bar_motions m;
  thr_err err = {0};
  assert_ok(thr_bar_motions_find(&of_square, each, 2, &m, &err), &err);
  ck_assert_int_eq(m.count, 1);
  thr_bar_motions_destroy(&m);
  thr_frame_destroy(&square);
  thr_frame_destroy(&rhomb);
}
END_TEST

/* Three struts between two triangles, all else cord (Fuller's prism): in balance only where the
 * upper triangle is turned by 30 degrees more than straight struts of a prism would be. */
START_TEST(prism)
{
  static const int edge[12][2] = {{0, 3}, {1, 4}, {2, 5}, {0, 1}, {1, 2}, {2, 0},
                                  {3, 4}, {4, 5}, {5, 3}, {0, 4}, {1, 5}, {2, 3}};
  bool cable[12];
  int half[12];
  thr_cord cord[9];
  for (int e = 0; e < 12; e++) {
    cable[e] = e >= 3;
    half[e] = 2 * e;
    if (e >= 3) cord[e - 3] = (thr_cord){.n_passes = 1, .half = half + e};
  }

  for (int trial = 0; trial < 3; trial++) {
    double turn = (trial == 0 ? 150 : trial == 1 ? 120 : 170) * acos(-1) / 180, xyz[6][3];
    for (int v = 0; v < 6; v++) {
      double angle = v % 3 * acos(-1) * 2 / 3 + (v < 3 ? 0 : -turn);
      xyz[v][0] = cos(angle), xyz[v][1] = sin(angle), xyz[v][2] = v < 3 ? 0 : 1.5;
    }
    thr_frame f = frame_make(6, (const double(*)[3])xyz, 12, edge, NULL, NULL);
    thr_pulling p;
    thr_err err = {0};
    assert_ok(
        thr_pulling_find(&(thr_bars){.frame = &f, .cable = cable}, cord, 9, &no_limits, &p, &err),
        &err);
    ck_assert_int_eq(p.moves, trial > 0);
    ck_assert_double_lt(p.residual, 1e-9);
    thr_pulling_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* All of it with each allocation failing once, and the picture. */
START_TEST(every_allocation_fails_once)
{
  static const bool cable[6] = {[4] = true, [5] = true};
  int half[2] = {8, 10};
  const thr_cord cord[2] = {{.n_passes = 1, .half = half}, {.n_passes = 1, .half = half + 1}};
  thr_frame f = square_make(2, 1);
  const thr_bars bars = {.frame = &f, .cable = cable};
  thr_status st = THR_ENOMEM;

  for (long k = 1; st; k++) {
    thr_bar_motions m = {0};
    thr_pulling moves = {0}, held = {0};
    thr_path path = {0};
    thr_text svg = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_bar_motions_find(&bars, NULL, 0, &m, &err);
    if (!st) st = thr_pulling_find(&bars, cord, 1, &no_limits, &moves, &err);
    if (!st) st = thr_pulling_find(&bars, cord, 2, &no_limits, &held, &err);
    const double(*velocity)[3] = (const double(*)[3])moves.velocity;
    if (!st) st = thr_motion_follow(&bars, cord, 1, velocity, 0.1, 3, &no_limits, &path, &err);
    const thr_motion_picture picture = {&f, velocity, NULL, cable, "title", "note"};
    if (!st) st = thr_motion_svg(&picture, &svg, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: %s", k, err.text);
    if (!st) {
      ck_assert_ptr_nonnull(strstr(svg.data, "class=\"head\""));
      ck_assert_ptr_nonnull(strstr(svg.data, "class=\"cord\""));
      ck_assert_int_gt(k, 20);
    }
    thr_text_destroy(&svg);
    thr_path_destroy(&path);
    thr_pulling_destroy(&moves);
    thr_pulling_destroy(&held);
    thr_bar_motions_destroy(&m);
    ck_assert_int_lt(k, 10000);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(refusals)
{
  thr_frame f = grid_make(32, 32);
  const thr_bars bars = {.frame = &f};
  const double velocity[1024][3] = {{0}};
  thr_bar_motions m;
  thr_pulling p;
  thr_path path;
  thr_err err = {0};
  ck_assert_int_eq(thr_bar_motions_find(&bars, NULL, 0, &m, &err), THR_EINPUT);
  ck_assert_int_eq(thr_motion_follow(&bars, NULL, 0, velocity, 1, 2, &no_limits, &path, &err),
                   THR_EINPUT);
  ck_assert_int_eq(thr_pulling_find(&bars, NULL, 0, &no_limits, &p, &err), THR_EINPUT);

  /* Nothing moves in the picture. */
  thr_text svg = {0};
  const thr_motion_picture picture = {&f, velocity, NULL, NULL, "title", "note"};
  ck_assert_int_eq(thr_motion_svg(&picture, &svg, &err), THR_EINPUT);
  ck_assert_uint_eq(svg.length, 0);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("bar motions");
  ADD_TEST(s, 60, counts);
  ADD_TEST(s, 20, basis_is_canonical);
  ADD_TEST(s, 20, four_bar_linkage);
  ADD_TEST(s, 20, infinitesimal_only);
  ADD_TEST(s, 20, pulled_together);
  ADD_TEST(s, 20, cords_along_diagonals);
  ADD_TEST(s, 20, prism);
  ADD_TEST(s, 60, every_allocation_fails_once);
  ADD_TEST(s, 20, refusals);
  return run_suite(s);
}
