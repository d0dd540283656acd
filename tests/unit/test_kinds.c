/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of beads against turned, mirrored and renamed ones; bores against closed forms and areas.
 */
#include "diagram/tables/tables.h"
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- kinds ---- */

typedef struct {
  int *edge, *node;
} kinds;

static kinds kinds_of(const thr_frame *f)
{
  kinds k = {calloc((size_t)f->n_edges, sizeof(int)), calloc((size_t)f->n_nodes, sizeof(int))};
  thr_err err = {0};
  ck_assert(k.edge && k.node);
  assert_ok(thr_kinds_find(f, 0, k.edge, k.node, &err), &err);
  return k;
}

static void kinds_destroy(kinds *k)
{
  free(k->edge);
  free(k->node);
}

/* How many there are; they are numbered as they come. */
static int count_kinds(const int *of, int n)
{
  int most = 0;
  for (int i = 0; i < n; i++) {
    ck_assert(of[i] >= 1 && of[i] <= most + 1);
    if (of[i] > most) most = of[i];
  }
  return most;
}

/* Of these shapes it is known: bodies with one kind of corner, and grids, whose beads have 2, 3 or
 * 4 arms at right angles, and with the straight ones of a ladder. */
START_TEST(known_kinds)
{
  thr_frame f[] = {solid_make(CUBE),
                   solid_make(ICOSAHEDRON),
                   truncated_icosahedron(),
                   grid_make(5, 4),
                   ring_make(9),
                   path_make(4),
                   star_make(THR_KINDS_ARMS + 1)};
  static const int nodes[] = {1, 1, 1, 3, 1, 2, 2};
  for (int i = 0; i < 7; i++) {
    kinds k = kinds_of(&f[i]);
    ck_assert_int_eq(count_kinds(k.node, f[i].n_nodes), nodes[i]);
    ck_assert_int_eq(count_kinds(k.edge, f[i].n_edges), 1);
    kinds_destroy(&k);
    thr_frame_destroy(&f[i]);
  }
}
END_TEST

/* A random turn in space: two rows of random numbers made orthogonal, and their cross product. */
static void random_turn(rng *r, double m[3][3])
{
  double length = 0, along = 0;
  for (int i = 0; i < 3; i++) {
    m[0][i] = rng_unit(r) - 0.5;
    m[1][i] = rng_unit(r) - 0.5;
    length += m[0][i] * m[0][i];
  }
  for (int i = 0; i < 3; i++)
    m[0][i] /= sqrt(length);
  for (int i = 0; i < 3; i++)
    along += m[0][i] * m[1][i];
  length = 0;
  for (int i = 0; i < 3; i++) {
    m[1][i] -= along * m[0][i];
    length += m[1][i] * m[1][i];
  }
  for (int i = 0; i < 3; i++)
    m[1][i] /= sqrt(length);
  for (int i = 0; i < 3; i++)
    m[2][i] = m[0][(i + 1) % 3] * m[1][(i + 2) % 3] - m[0][(i + 2) % 3] * m[1][(i + 1) % 3];
}

static void turn(const double m[3][3], double *point)
{
  double to[3] = {0};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      to[i] += m[i][k] * point[k];
  memcpy(point, to, sizeof to);
}

/* Hubs with arms at random: the second is the first turned and its arms renamed, the third its
 * mirror image, one arm of the fourth is longer by more than two tolerances. */
START_TEST(turned_beads_are_alike_mirrored_ones_are_not)
{
  enum { ARMS = 4, HUBS = 4 };
  rng r = rng_make(7001 + (uint64_t)_i);
  double xyz[HUBS * (ARMS + 1)][3] = {{0}}, m[3][3];
  int edge[HUBS * ARMS][2];
  for (int hub = 0; hub < HUBS; hub++) {
    random_turn(&r, m);
    for (int arm = 0; arm < ARMS; arm++) {
      double *p = xyz[hub * (ARMS + 1) + 1 + (hub == 1 ? (arm + 2) % ARMS : arm)];
      for (int i = 0; i < 3; i++)
        p[i] = hub        ? xyz[1 + arm][i]
               : i == arm ? 1 + 0.2 * i
                          : -0.3 - 0.6 * rng_unit(&r) * (arm == 3);
      if (hub == 2) p[0] = -p[0];
      for (int i = 0; i < 3 && hub == 3 && arm == 0; i++)
        p[i] *= 1 + 6 * THR_KINDS_TOLERANCE;
      if (hub) turn((const double(*)[3])m, p);
      edge[hub * ARMS + arm][0] = hub * (ARMS + 1);
      edge[hub * ARMS + arm][1] = hub * (ARMS + 1) + 1 + arm;
    }
  }
  for (int hub = 1; hub < HUBS; hub++) /* apart from each other */
    for (int v = 0; v <= ARMS; v++)
      xyz[hub * (ARMS + 1) + v][0] += 10 * hub;
  thr_frame f = frame_make(HUBS * (ARMS + 1), (const double(*)[3])xyz, HUBS * ARMS,
                           (const int(*)[2])edge, NULL, NULL);
  kinds k = kinds_of(&f);
  ck_assert_int_eq(k.node[0], k.node[ARMS + 1]);
  ck_assert_int_ne(k.node[0], k.node[2 * (ARMS + 1)]);
  ck_assert_int_ne(k.node[0], k.node[3 * (ARMS + 1)]);
  ck_assert_int_ne(k.node[2 * (ARMS + 1)], k.node[3 * (ARMS + 1)]);
  kinds_destroy(&k);
  thr_frame_destroy(&f);
}
END_TEST

/* Renaming nodes and edges, and turning the whole, changes no kind. */
START_TEST(kinds_do_not_hang_on_names)
{
  rng r = rng_make(7101 + (uint64_t)_i);
  thr_frame f = _i ? shape_make(THR_MAKE_GEODESIC, _i + 1, 0) : shape_make(THR_MAKE_DOME, 8, 0);
  int *to = calloc((size_t)f.n_nodes, sizeof *to);
  ck_assert_ptr_nonnull(to);
  thr_frame g = shuffled_frame(&r, &f, to);
  double m[3][3];
  random_turn(&r, m);
  for (int v = 0; v < g.n_nodes; v++)
    turn((const double(*)[3])m, g.xyz[v]);
  kinds a = kinds_of(&f), b = kinds_of(&g);
  ck_assert_int_gt(count_kinds(a.node, f.n_nodes), 1);
  ck_assert_int_lt(count_kinds(a.node, f.n_nodes), f.n_nodes / 2);
  for (int v = 0; v < f.n_nodes; v++)
    for (int w = 0; w < v; w++)
      ck_assert_int_eq(a.node[v] == a.node[w], b.node[to[v]] == b.node[to[w]]);
  kinds_destroy(&a);
  kinds_destroy(&b);
  free(to);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* ---- bores ---- */

/* The narrowest circles that hold equal circles, where that is proved (1 to 13 and 19): fewer cords
 * are drawn through them. */
START_TEST(drawn_cords_have_play)
{
  const double ratio[][2] = {{1, 1},
                             {2, 2},
                             {3, 1 + 2 / sqrt(3)},
                             {4, 1 + sqrt(2)},
                             {5, 1 + sqrt(2 + 2 / sqrt(5))},
                             {7, 3},
                             {8, 1 + 1 / sin(THR_PI / 7)},
                             {9, 1 + 1 / sin(THR_PI / 8)},
                             {11, 1 + 1 / sin(THR_PI / 9)},
                             {13, 2 + sqrt(5)},
                             {19, 1 + sqrt(2) + sqrt(6)}};
  for (size_t i = 0; i < sizeof ratio / sizeof *ratio; i++)
    ck_assert_int_lt(thr_bore_fits(1.3 * ratio[i][1], 1.3), (int)ratio[i][0]);
}
END_TEST

/* The sections of cords fill 53 % of a bore at most, of two 31 %, of more 40 %; and one cord more
 * would fill more than that. */
START_TEST(bores_are_filled_as_far_as_allowed)
{
  for (double bore = 1; bore < 20; bore += 0.013) {
    int n = thr_bore_fits(bore, 1), more = n + 1;
    double part = n / (bore * bore), next = more / (bore * bore);
    ck_assert_double_le(part, (n == 1 ? .53 : n == 2 ? .31 : .40) * (1 + 1e-8));
    ck_assert_double_gt(next, more == 1 ? .53 : more == 2 ? .31 : .40);
  }
  ck_assert_int_eq(thr_bore_fits(0.9, 1), 0);
  ck_assert_int_eq(thr_bore_fits(1e6, 1), THR_BORE_MOST);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kinds");
  ADD_TEST(s, 20, known_kinds);
  ADD_LOOP(s, 20, turned_beads_are_alike_mirrored_ones_are_not, 0, 20);
  ADD_LOOP(s, 20, kinds_do_not_hang_on_names, 0, 4);
  ADD_TEST(s, 4, drawn_cords_have_play);
  ADD_TEST(s, 4, bores_are_filled_as_far_as_allowed);
  return run_suite(s);
}
