/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rigidity: closed forms, theorems (Cauchy and Dehn: convex triangulated spheres), and the rank of
 * random frameworks with whole coordinates by elimination modulo a prime. */
#include "eval/structure/beads.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <stdlib.h>

static thr_rigidity rigidity_of(const thr_frame *f)
{
  thr_rigidity r;
  thr_err err = {0};
  assert_ok(thr_rigidity_find(f, &r, &err), &err);
  ck_assert_int_eq(3 * f->n_nodes - r.rank - r.rigid_motions, r.motions);
  ck_assert_int_eq(f->n_edges - r.rank, r.self_stresses);
  return r;
}

static void check(thr_frame f, int motions, int self_stresses, int within_plane)
{
  thr_rigidity r = rigidity_of(&f);
  ck_assert_int_eq(r.motions, motions);
  ck_assert_int_eq(r.self_stresses, self_stresses);
  ck_assert_int_eq(r.flat, within_plane >= 0);
  if (within_plane >= 0) ck_assert_int_eq(r.plane_motions, within_plane);
  ck_assert(!r.unclear);
  thr_frame_destroy(&f);
}

START_TEST(solids)
{
  check(solid_make(TETRAHEDRON), 0, 0, -1);
  check(solid_make(OCTAHEDRON), 0, 0, -1);
  check(solid_make(ICOSAHEDRON), 0, 0, -1);
  check(solid_make(CUBE), 6, 0, -1);          /* 24 - 12 - 6, no bar to spare */
  check(solid_make(DODECAHEDRON), 24, 0, -1); /* 60 - 30 - 6 */
  check(shape_make(THR_MAKE_SPHERE, 4, 0), 0, 0,
        -1); /* convex, triangulated: 3 n - 6 edges, rigid */
  check(shape_make(THR_MAKE_SPHERE, 10, 0), 0, 0, -1); /* 1,002 nodes */
}
END_TEST

START_TEST(flat_and_straight)
{
  check(path_make(2), 0, 0, -1); /* one bar: 5 rigid motions */
  check(path_make(5), 6, 0, -1); /* 15 - 4 - 5: straight, each inner node moves off two ways */
  check(ring_make(3), 0, 0, 0);
  check(ring_make(4), 2, 0, 1); /* shears in its plane, folds out of it */
  check(ring_make(6), 6, 0, 3); /* 18 - 6 - 6; 12 - 6 - 3 */
  check(grid_make(4, 3), 3 * 12 - 17 - 6, 0, 2 * 12 - 17 - 3);
  check(triangles_make(5), 0, 0, 0); /* each piece by itself */
  check(wheel_make(6), 18 + 3 - 11 - 6, 12 - 11,
        0); /* 7 nodes, 12 edges, in the plane 11 of them independent */
}
END_TEST

/* Two bipyramids over a triangle that share their tips: 18 edges for 8 nodes, as many as a rigid
 * framework needs, but each half has one of its own too many and turns about the line through the
 * tips. */
START_TEST(double_banana)
{
  static const double xyz[8][3] = {{0, 0, 2},   {0, 0, -2},  {2, 1, 0},   {3, -1, .5},
                                   {1, 0, -.5}, {-2, 1, .3}, {-3, -1, 0}, {-1, 0, .4}};
  static const int edge[18][2] = {{2, 3}, {3, 4}, {4, 2}, {0, 2}, {0, 3}, {0, 4},
                                  {1, 2}, {1, 3}, {1, 4}, {5, 6}, {6, 7}, {7, 5},
                                  {0, 5}, {0, 6}, {0, 7}, {1, 5}, {1, 6}, {1, 7}};
  check(frame_make(8, xyz, 18, edge, NULL, NULL), 1, 1, -1);
}
END_TEST

START_TEST(feet_hold)
{
  thr_frame f = solid_make(CUBE);
  thr_rigidity r = rigidity_of(&f);
  ck_assert_int_eq(r.pinned, 12); /* no feet: 24 - 12 */
  f.foot[0] = true;
  ck_assert_int_eq(rigidity_of(&f).pinned, 9);
  for (int v = 0; v < f.n_nodes; v++)
    f.foot[v] = true;
  ck_assert_int_eq(rigidity_of(&f).pinned, 0);
  thr_frame_destroy(&f);
  f = path_make(3); /* foot at one end: each of two bars swings two ways */
  ck_assert_int_eq(rigidity_of(&f).pinned, 4);
  thr_frame_destroy(&f);
}
END_TEST

/* Eight nodes of a regular octahedron's kind, one moved so far into a face's plane that rounding
 * decides. */
START_TEST(close_calls_are_said)
{
  double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {.3, .3, 1e-7}};
  static const int edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  thr_frame f = frame_make(4, (const double(*)[3])xyz, 6, edge, NULL, NULL);
  ck_assert(rigidity_of(&f).unclear);
  thr_frame_destroy(&f);
  xyz[3][2] = 0.01;
  check(frame_make(4, (const double(*)[3])xyz, 6, edge, NULL, NULL), 0, 0, -1);
}
END_TEST

/* ---- a second algorithm ---- */

#define PRIME UINT64_C(2147483647)

static uint64_t power(uint64_t a, uint64_t n)
{
  uint64_t result = 1;
  for (; n; n /= 2, a = a * a % PRIME)
    if (n % 2) result = result * a % PRIME;
  return result;
}

/* Rank modulo a prime of the matrix with rows of coordinate differences: of whole coordinates it is
 * the true rank, unless the prime divides a minor. */
static int rank_modulo(const thr_frame *f)
{
  int columns = 3 * f->n_nodes, rank = 0;
  uint64_t *a = calloc((size_t)(f->n_edges * columns), sizeof *a);
  for (int e = 0; e < f->n_edges; e++)
    for (int s = 0; s < 2; s++)
      for (int i = 0; i < 3; i++) {
        long long d = (long long)f->xyz[f->edge[e][s]][i] - (long long)f->xyz[f->edge[e][1 - s]][i];
        a[e * columns + 3 * f->edge[e][s] + i] = (uint64_t)(d + (long long)PRIME) % PRIME;
      }
  for (int j = 0; j < columns && rank < f->n_edges; j++) {
    int pivot = rank;
    while (pivot < f->n_edges && a[pivot * columns + j] == 0)
      pivot++;
    if (pivot == f->n_edges) continue;
    for (int k = 0; k < columns; k++) {
      uint64_t swap = a[pivot * columns + k];
      a[pivot * columns + k] = a[rank * columns + k];
      a[rank * columns + k] = swap;
    }
    uint64_t inverse = power(a[rank * columns + j], PRIME - 2);
    for (int e = rank + 1; e < f->n_edges; e++) {
      uint64_t factor = a[e * columns + j] * inverse % PRIME;
      for (int k = j; factor && k < columns; k++)
        a[e * columns + k] =
            (a[e * columns + k] + (PRIME - factor) * a[rank * columns + k]) % PRIME;
    }
    rank++;
  }
  free(a);
  return rank;
}

/* Coordinates from a small grid, so that collinear and coplanar nodes abound. */
START_TEST(whole_coordinates)
{
  rng r = rng_make(900 + (uint64_t)_i);
  for (int trial = 0; trial < 40; trial++) {
    int n = rng_between(&r, 2, 14), m = 0, edge[91][2], width = rng_between(&r, 2, 6);
    double xyz[14][3];
    for (int v = 0; v < n;) {
      for (int i = 0; i < 3; i++)
        xyz[v][i] = rng_below(&r, i == 2 && trial % 3 == 0 ? 1 : width);
      bool twice = false;
      for (int w = 0; w < v; w++)
        twice |= xyz[w][0] == xyz[v][0] && xyz[w][1] == xyz[v][1] && xyz[w][2] == xyz[v][2];
      if (twice)
        width++;
      else
        v++;
    }
    int share = rng_between(&r, 2, 9);
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++)
        if (b == a + 1 || rng_below(&r, 10) < share) edge[m][0] = a, edge[m++][1] = b;
    thr_frame f = frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL);
    ck_assert_int_eq(rigidity_of(&f).rank, rank_modulo(&f));
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(empty_matrices)
{
  int start[3] = {0, 0, 0}, rank = 7;
  ck_assert_int_eq(thr_rank(3, 2, start, NULL, NULL, 1e-9, &rank, NULL), THR_OK);
  ck_assert_int_eq(rank, 0);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rigidity");
  ADD_TEST(s, 60, solids);
  ADD_TEST(s, 20, flat_and_straight);
  ADD_TEST(s, 20, double_banana);
  ADD_TEST(s, 20, feet_hold);
  ADD_TEST(s, 20, close_calls_are_said);
  ADD_EXAMPLES(s, 60, whole_coordinates, 8);
  ADD_TEST(s, 20, empty_matrices);
  return run_suite(s);
}
