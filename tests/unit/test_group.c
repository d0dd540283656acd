/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Automorphism groups by nauty against closed forms and all permutations; listed groups
 * against their axioms; subgroups against published counts and all subsets. */
#define _POSIX_C_SOURCE 200809L
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* ---- automorphisms ---- */

static thr_automorphisms find(const thr_frame *f, const int *node_colour, const int *edge_colour)
{
  thr_automorphism_options o = {node_colour, edge_colour};
  thr_automorphisms a;
  thr_err err = {0};
  assert_ok(thr_automorphisms_find(f, &o, &a, &err), &err);
  return a;
}

/* Generators that keep the framework, orbits that are theirs, and the same on a second
 * call. */
static double order_checked(const thr_frame *f, const int *node_colour, const int *edge_colour)
{
  thr_automorphisms a = find(f, node_colour, edge_colour),
                    again = find(f, node_colour, edge_colour);
  size_t bytes = (size_t)a.n * (size_t)a.n_generators * sizeof *a.generator;
  for (int g = 0; g < a.n_generators; g++) {
    const int *image = &a.generator[g * a.n];
    ck_assert(keeps_frame(f, edge_colour, image));
    for (int v = 0; v < a.n; v++) {
      ck_assert_int_eq(a.orbit[image[v]], a.orbit[v]);
      ck_assert(!node_colour || node_colour[image[v]] == node_colour[v]);
    }
  }
  for (int v = 0; v < a.n; v++)
    ck_assert(a.orbit[v] <= v && a.orbit[a.orbit[v]] == a.orbit[v]);
  double order = a.mantissa * pow(10, a.exponent);
  ck_assert_int_eq(a.n_generators, again.n_generators);
  ck_assert(bytes == 0 || memcmp(a.generator, again.generator, bytes) == 0);
  if (order <= THR_GROUP_CAP) {
    thr_group g;
    ck_assert_int_eq(thr_group_generate(a.n, a.generator, a.n_generators, THR_GROUP_CAP, &g, NULL),
                     THR_OK);
    ck_assert_double_eq(g.order, order);
    thr_group_destroy(&g);
  }
  thr_automorphisms_destroy(&a);
  thr_automorphisms_destroy(&again);
  return order;
}

static void expect_order(thr_frame f, double order)
{
  ck_assert_double_eq_tol(order_checked(&f, NULL, NULL) / order, 1, 1e-12);
  thr_frame_destroy(&f);
}

START_TEST(orders_of_solids_and_shapes)
{
  expect_order(no_feet(solid_make(TETRAHEDRON)), 24);
  expect_order(no_feet(solid_make(CUBE)), 48);
  expect_order(no_feet(solid_make(OCTAHEDRON)), 48);
  expect_order(no_feet(solid_make(DODECAHEDRON)), 120);
  expect_order(no_feet(solid_make(ICOSAHEDRON)), 120);
  expect_order(truncated_icosahedron(), 120);
  expect_order(shape_make(THR_MAKE_DOME, 3, 0), 8);
  expect_order(shape_make(THR_MAKE_DOME, 6, 0), 8);
  expect_order(no_feet(grid_make(5, 3)), 4);
  expect_order(no_feet(grid_make(4, 4)), 8);
  expect_order(shape_make(THR_MAKE_GEODESIC, 3, 0), 10);
  expect_order(shape_make(THR_MAKE_SPHERE, 4, 0), 120);
  expect_order(shape_make(THR_MAKE_HONEYCOMB, 2, 0), 12);
}
END_TEST

/* Ring times path: 2n turns and mirrors of the ring, and upside down unless the lowest ring is the
 * feet; the cube has more. */
START_TEST(orders_of_tubes)
{
  for (int n = 3; n <= 12; n++)
    for (int rings = 2; rings <= 4; rings++) {
      expect_order(shape_make(THR_MAKE_TUBE, n, rings), 2 * n);
      expect_order(no_feet(shape_make(THR_MAKE_TUBE, n, rings)), n == 4 && rings == 2 ? 48 : 4 * n);
    }
}
END_TEST

static double factorial(int n)
{
  return n < 2 ? 1 : n * factorial(n - 1);
}

static thr_frame on_moment_curve(int n, int m, const int (*edge)[2])
{
  double xyz[200][3];
  ck_assert_int_le(n, 200);
  for (int v = 0; v < n; v++)
    xyz[v][0] = v, xyz[v][1] = v * v, xyz[v][2] = v * v * v;
  return no_feet(frame_make(n, (const double(*)[3])xyz, m, edge, NULL, NULL));
}

static thr_frame complete_make(int n)
{
  int edge[400][2], m = 0;
  for (int a = 0; a < n; a++)
    for (int b = a + 1; b < n; b++)
      edge[m][0] = a, edge[m++][1] = b;
  return on_moment_curve(n, m, (const int(*)[2])edge);
}

static thr_frame petersen_make(void)
{
  int edge[15][2];
  for (int i = 0; i < 5; i++) {
    edge[i][0] = i, edge[i][1] = (i + 1) % 5;
    edge[5 + i][0] = i, edge[5 + i][1] = 5 + i;
    edge[10 + i][0] = 5 + i, edge[10 + i][1] = 5 + (i + 2) % 5;
  }
  return on_moment_curve(10, 15, (const int(*)[2])edge);
}

START_TEST(orders_of_graphs)
{
  for (int n = 3; n <= 40; n++)
    expect_order(no_feet(ring_make(n)), 2 * n);
  for (int n = 2; n <= 30; n += 7)
    expect_order(no_feet(path_make(n)), 2);
  for (int k = 3; k <= 30; k++) { /* one spoke's end is the foot */
    expect_order(star_make(k), factorial(k - 1));
    expect_order(no_feet(star_make(k)), factorial(k));
  }
  for (int n = 3; n <= 14; n++)
    expect_order(complete_make(n), factorial(n));
  for (int k = 2; k <= 8; k++) { /* each has one foot */
    expect_order(triangles_make(k), pow(2, k) * factorial(k));
    expect_order(no_feet(triangles_make(k)), pow(6, k) * factorial(k));
  }
  expect_order(petersen_make(), 120);
}
END_TEST

/* How many of all permutations keep the framework. */
static int count_permutations(const thr_frame *f, const int *edge_colour, int *image, int fixed)
{
  int n = f->n_nodes, count = 0;
  if (fixed == n) return keeps_frame(f, edge_colour, image);
  for (int v = fixed; v < n; v++) {
    int swap = image[fixed];
    image[fixed] = image[v], image[v] = swap;
    if (f->foot[image[fixed]] == f->foot[fixed])
      count += count_permutations(f, edge_colour, image, fixed + 1);
    image[v] = image[fixed], image[fixed] = swap;
  }
  return count;
}

START_TEST(all_permutations_of_small_frames)
{
  int more = 0;
  for (int seed = 0; seed < 250; seed++) {
    rng r = rng_make(1000 + (uint64_t)seed);
    int n = rng_between(&r, 2, seed < 225 ? 7 : 8), image[8], edge_colour[64];
    thr_frame f = random_frame(&r, n, rng_below(&r, 2 * n), LENGTHS_EQUAL);
    if (seed % 2) f = no_feet(f);
    ck_assert_int_le(f.n_edges, 64);
    for (int e = 0; e < f.n_edges; e++)
      edge_colour[e] = rng_below(&r, 5) == 0 ? -3 : 7;
    for (int coloured = 0; coloured < 2; coloured++) {
      for (int v = 0; v < n; v++)
        image[v] = v;
      int count = count_permutations(&f, coloured ? edge_colour : NULL, image, 0);
      ck_assert_double_eq(order_checked(&f, NULL, coloured ? edge_colour : NULL), count);
      more += count > 1;
    }
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(more, 100);
}
END_TEST

/* The order and the sizes of orbits do not depend on how nodes are numbered. */
START_TEST(renumbering)
{
  rng r = rng_make(5);
  thr_frame all[] = {shape_make(THR_MAKE_GEODESIC, 3, 0), shape_make(THR_MAKE_TUBE, 6, 4),
                     solid_make(CUBE), triangles_make(3)};
  for (int k = 0; k < 4; k++) {
    int *to = calloc((size_t)all[k].n_nodes, sizeof *to);
    thr_frame g = shuffled_frame(&r, &all[k], to);
    thr_automorphisms a = find(&all[k], NULL, NULL), b = find(&g, NULL, NULL);
    ck_assert_double_eq(a.mantissa, b.mantissa);
    for (int v = 0; v < a.n; v++)
      for (int w = 0; w < a.n; w++)
        ck_assert((a.orbit[v] == a.orbit[w]) == (b.orbit[to[v]] == b.orbit[to[w]]));
    thr_automorphisms_destroy(&a);
    thr_automorphisms_destroy(&b);
    thr_frame_destroy(&g);
    thr_frame_destroy(&all[k]);
    free(to);
  }
}
END_TEST

START_TEST(node_and_edge_colours)
{
  thr_frame cube = no_feet(solid_make(CUBE));
  int node[8] = {0}, edge[12];
  node[0] = -5; /* what fixes a corner: C3v */
  ck_assert_double_eq(order_checked(&cube, node, NULL), 6);
  for (int e = 0; e < 12; e++) /* one direction apart from the others: D4h */
    edge[e] = cube.xyz[cube.edge[e][0]][2] != cube.xyz[cube.edge[e][1]][2];
  ck_assert_double_eq(order_checked(&cube, NULL, edge), 16);
  ck_assert_double_eq(order_checked(&cube, node, edge), 2);
  for (int e = 0; e < 12; e++)
    edge[e] = 9; /* no colours at all */
  ck_assert_double_eq(order_checked(&cube, NULL, edge), 48);
  thr_frame_destroy(&cube);
}
END_TEST

static void expect_length_order(double a, double b, double c, double shear, double tolerance,
                                int colours, double order)
{
  thr_frame f = box_make(a, b, c, shear);
  int colour[12], most = 0;
  ck_assert_int_eq(thr_length_colours(&f, tolerance, colour, NULL), THR_OK);
  for (int e = 0; e < 12; e++)
    if (colour[e] > most) most = colour[e];
  ck_assert_int_eq(most + 1, colours);
  ck_assert_double_eq(order_checked(&f, NULL, colour), order);
  thr_frame_destroy(&f);
}

/* Boxes: what keeps three, two or one edge length. Sheared along its diagonal a cube has fewer
 * isometries, but equal edges. */
START_TEST(edge_lengths_are_colours)
{
  expect_length_order(1, 1, 1, 0, 0, 1, 48);
  expect_length_order(1, 1, 2, 0, 0.01, 2, 16);
  expect_length_order(3, 1, 2, 0, 0.01, 3, 8);
  expect_length_order(3, 1, 2, 0, 0, 3, 8);
  expect_length_order(1, 1, 1, 0.2, 0, 1, 48);
  /* 1, 1.1, 1.2 about a size of 0.95: one after the other within 2 * 0.06 of it, the first and the
   * last only by the second */
  expect_length_order(1, 1.1, 1.2, 0, 0.06, 1, 48);
  expect_length_order(1, 1.1, 1.2, 0, 0.05, 3, 8);
  expect_length_order(1, 1.1, 1.3, 0, 0.06, 2, 16);
}
END_TEST

START_TEST(too_many_generators_are_refused)
{
  thr_frame f = triangles_make(6000);
  thr_automorphism_options o = {0};
  thr_automorphisms a;
  thr_err err = {0};
  assert_status(thr_automorphisms_find(&f, &o, &a, &err), THR_ELIMIT, &err, "generators");
  ck_assert(!a.generator && !a.orbit);
  thr_frame_destroy(&f);
}
END_TEST

/* In a child the same generators and orbits; without time the identity alone. */
START_TEST(found_within_limits)
{
  thr_frame f = grid_make(7, 7), many = triangles_make(200);
  const thr_frame *const frames[] = {&f, &many};
  for (int i = 0; i < 2; i++) {
    thr_automorphism_options o = {0};
    thr_automorphisms here = find(frames[i], NULL, NULL), a;
    size_t n = (size_t)here.n;
    bool all;
    const thr_limits hour = {.deadline = thr_clock() + 3600}, over = {.deadline = thr_clock() - 1};
    ck_assert_int_eq(thr_automorphisms_within(frames[i], &o, &hour, &all, &a, NULL), THR_OK);
    ck_assert(all && a.n == here.n && a.n_generators == here.n_generators);
    ck_assert_mem_eq(a.generator, here.generator, n * (size_t)a.n_generators * sizeof *a.generator);
    ck_assert_mem_eq(a.orbit, here.orbit, n * sizeof *a.orbit);
    ck_assert(a.mantissa == here.mantissa && a.exponent == here.exponent);
    thr_automorphisms_destroy(&a);
    ck_assert_int_eq(thr_automorphisms_within(frames[i], &o, &over, &all, &a, NULL), THR_OK);
    ck_assert(all || (a.n_generators == 0 &&
                      a.mantissa == 1)); /* a child may be faster than its parent looks */
    thr_automorphisms_destroy(&a);
    thr_automorphisms_destroy(&here);
  }
  thr_frame_destroy(&f);
  thr_frame_destroy(&many);
}
END_TEST

/* nauty ends the program when memory runs out; ours goes on. */
START_TEST(nauty_without_memory)
{
  thr_frame f = grid_make(120, 120);
  struct rlimit old;
  int failures = 0;
  ck_assert_int_eq(getrlimit(RLIMIT_AS, &old), 0);
  for (rlim_t extra = 0;; extra += 256 << 10) {
    struct rlimit low = old;
    thr_automorphism_options o = {0};
    thr_automorphisms a;
    thr_err err = {0};
    unsigned long pages = 0;
    FILE *statm = fopen("/proc/self/statm", "r");
    ck_assert(statm && fscanf(statm, "%lu", &pages) == 1);
    fclose(statm);
    low.rlim_cur = (rlim_t)pages * 4096 + extra;
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &low), 0);
    thr_status st = thr_automorphisms_find(&f, &o, &a, &err);
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &old), 0);
    if (!st) ck_assert_double_eq(a.mantissa, 8);
    thr_automorphisms_destroy(&a);
    if (!st) break;
    ck_assert_msg(st == THR_ENOMEM, "%s", err.text);
    failures++;
  }
  ck_assert_int_gt(failures, 0);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- listed groups ---- */

static thr_group generate(int degree, const int *generator, int n)
{
  thr_group g;
  thr_err err = {0};
  assert_ok(thr_group_generate(degree, generator, n, THR_GROUP_CAP, &g, &err), &err);
  return g;
}

static thr_group group_of(thr_frame f)
{
  thr_automorphisms a = find(&f, NULL, NULL);
  thr_group g = generate(a.n, a.generator, a.n_generators);
  thr_automorphisms_destroy(&a);
  thr_frame_destroy(&f);
  return g;
}

static thr_group symmetric_group(int n)
{
  int generator[16];
  for (int x = 0; x < n; x++) {
    generator[x] = (x + 1) % n;
    generator[n + x] = x == 0 ? 1 : x == 1 ? 0 : x;
  }
  return generate(n, generator, 2);
}

/* Even permutations of n points, n odd or 4: from the cycles (0 1 x). */
static thr_group alternating_group(int n)
{
  int generator[64];
  for (int s = 0; s + 2 < n; s++) {
    for (int x = 0; x < n; x++)
      generator[s * n + x] = x;
    generator[s * n] = 1, generator[s * n + 1] = s + 2, generator[s * n + s + 2] = 0;
  }
  return generate(n, generator, n - 2);
}

/* Rings of these lengths side by side, each turned by itself. */
static thr_group abelian_group(int factors, const int *length)
{
  int degree = 0, generator[1024];
  for (int k = 0; k < factors; k++)
    degree += length[k];
  for (int k = 0, first = 0; k < factors; first += length[k++])
    for (int x = 0; x < degree; x++)
      generator[k * degree + x] =
          x < first || x >= first + length[k] ? x : first + (x - first + 1) % length[k];
  return generate(degree, generator, factors);
}

/* i and j acting on 1, i, j, k, -1, -i, -j, -k by multiplication from the left. */
static thr_group quaternion_group(void)
{
  static const int generator[16] = {1, 4, 3, 6, 5, 0, 7, 2, 2, 7, 4, 1, 6, 3, 0, 5};
  return generate(8, generator, 2);
}

static int times(const thr_group *g, int a, int b)
{
  return g->product[a * g->order + b];
}

static void assert_group(const thr_group *g)
{
  for (int a = 0; a < g->order; a++) {
    const int *image = &g->image[a * g->degree];
    ck_assert(a == 0 || memcmp(&g->image[(a - 1) * g->degree], image,
                               (size_t)g->degree * sizeof *image) != 0);
    for (int x = 0; x < g->degree && a; x++) {
      int before = g->image[(a - 1) * g->degree + x];
      if (before == image[x]) continue;
      ck_assert_int_lt(before, image[x]);
      break;
    }
    for (int b = 0; b < g->order; b++)
      for (int x = 0; x < g->degree; x++)
        ck_assert_int_eq(g->image[times(g, a, b) * g->degree + x],
                         image[g->image[b * g->degree + x]]);
    ck_assert_int_eq(times(g, a, g->inverse[a]), 0);
    int power = 0;
    for (int k = 1; k <= g->power_order[a]; k++) {
      power = times(g, power, a);
      ck_assert((power == 0) == (k == g->power_order[a]));
    }
  }
  for (int x = 0; x < g->degree; x++)
    ck_assert_int_eq(g->image[x], x);
}

START_TEST(listed_groups_obey_the_axioms)
{
  thr_group all[] = {symmetric_group(3),
                     symmetric_group(5),
                     alternating_group(5),
                     quaternion_group(),
                     abelian_group(3, (const int[]){2, 3, 4}),
                     group_of(no_feet(solid_make(CUBE))),
                     group_of(no_feet(solid_make(DODECAHEDRON))),
                     generate(4, NULL, 0),
                     group_of(shape_make(THR_MAKE_DOME, 4, 0))};
  static const int order[] = {6, 120, 60, 8, 24, 48, 120, 1, 8};
  for (int k = 0; k < 9; k++) {
    ck_assert_int_eq(all[k].order, order[k]);
    assert_group(&all[k]);
    thr_group_destroy(&all[k]);
  }
}
END_TEST

START_TEST(refused_groups)
{
  static const int seven[14] = {1, 2, 3, 4, 5, 6, 0, 1, 0, 2, 3, 4, 5, 6}, twice[3] = {0, 1, 1},
                   far[3] = {0, 1, 3};
  thr_group g;
  thr_err err = {0};
  assert_status(thr_group_generate(7, seven, 2, THR_GROUP_CAP, &g, &err), THR_ELIMIT, &err, "1024");
  ck_assert(!g.image && !g.product && g.order == 0);
  ck_assert_int_eq(thr_group_generate(7, seven, 1, 6, &g, NULL), THR_ELIMIT);
  ck_assert_int_eq(thr_group_generate(7, seven, 1, 7, &g, NULL), THR_OK);
  thr_group_destroy(&g);
  ck_assert_int_eq(thr_group_generate(3, twice, 1, 9, &g, NULL), THR_EINPUT);
  ck_assert_int_eq(thr_group_generate(3, far, 1, 9, &g, NULL), THR_EINPUT);
}

/* Elements that are products of the generators. */
static int order_generated(const thr_group *g, const int *generator, int n)
{
  int *made = calloc((size_t)g->order, sizeof *made), count = 1;
  bool *has = calloc((size_t)g->order, sizeof *has);
  ck_assert(made && has);
  has[0] = true;
  for (int i = 0; i < count; i++)
    for (int k = 0; k < n; k++) {
      int product = times(g, made[i], generator[k]);
      if (!has[product]) made[count++] = product;
      has[product] = true;
    }
  free(made);
  free(has);
  return count;
}
END_TEST

/* ---- subgroups ---- */

static void assert_subgroup(const thr_group *g, const thr_subgroup *s)
{
  int generator[16];
  ck_assert_int_eq(s->element[0], 0);
  ck_assert_int_eq(g->order % s->order, 0);
  for (int i = 0; i < s->order; i++) {
    ck_assert(i == 0 || s->element[i - 1] < s->element[i]);
    for (int j = 0; j < s->order; j++)
      ck_assert(thr_subgroup_has(s, times(g, s->element[i], s->element[j])));
  }
  int members = 0, n = thr_subgroup_generators(g, s, generator);
  for (int a = -1; a <= g->order; a++)
    members += thr_subgroup_has(s, a);
  ck_assert_int_eq(members, s->order);
  ck_assert(n <= 10 && 1 << n <= s->order);
  ck_assert_int_eq(order_generated(g, generator, n), s->order); /* all of s, as s is closed */
}

/* Below 0, 0 or above: by descending order, then by elements. */
static int compare(const thr_subgroup *a, const thr_subgroup *b)
{
  if (a->order != b->order) return b->order - a->order;
  for (int i = 0; i < a->order; i++)
    if (a->element[i] != b->element[i]) return a->element[i] - b->element[i];
  return 0;
}

static int by_value(const void *a, const void *b)
{
  return *(const int *)a - *(const int *)b;
}

static thr_subgroup conjugate(const thr_group *g, const thr_subgroup *s, int b)
{
  thr_subgroup c = {s->order, calloc((size_t)s->order, sizeof(int))};
  ck_assert(c.element != NULL);
  for (int i = 0; i < s->order; i++)
    c.element[i] = times(g, times(g, b, s->element[i]), g->inverse[b]);
  qsort(c.element, (size_t)c.order, sizeof *c.element, by_value);
  return c;
}

/* Sums of classes and subgroups; every representative the least of its class, whose size is the
 * index of the normalizer, and no two classes the same. */
static void count_subgroups(const thr_group *g, int *classes, int *subgroups)
{
  thr_subgroup_classes c;
  ck_assert_int_eq(thr_subgroup_classes_find(g, 1000, &c, NULL), THR_OK);
  ck_assert(c.complete);
  *classes = c.n;
  *subgroups = 0;
  for (int k = 0; k < c.n; k++) {
    int normalizer = 0;
    assert_subgroup(g, &c.subgroup[k]);
    for (int b = 0; b < g->order; b++) {
      thr_subgroup image = conjugate(g, &c.subgroup[k], b);
      ck_assert_int_ge(compare(&image, &c.subgroup[k]), 0);
      normalizer += compare(&image, &c.subgroup[k]) == 0;
      thr_subgroup_destroy(&image);
    }
    ck_assert_int_eq(c.conjugates[k] * normalizer, g->order);
    ck_assert(k == 0 || compare(&c.subgroup[k - 1], &c.subgroup[k]) < 0);
    *subgroups += c.conjugates[k];
  }
  thr_subgroup_classes_destroy(&c);
}

static void expect_subgroups(thr_group g, int order, int classes, int subgroups)
{
  int k, n;
  ck_assert_int_eq(g.order, order);
  count_subgroups(&g, &k, &n);
  ck_assert_int_eq(k, classes);
  ck_assert_int_eq(n, subgroups);
  thr_group_destroy(&g);
}

START_TEST(published_counts_of_subgroups)
{
  expect_subgroups(symmetric_group(3), 6, 4, 6);
  expect_subgroups(symmetric_group(4), 24, 11, 30);
  expect_subgroups(symmetric_group(5), 120, 19, 156);
  expect_subgroups(symmetric_group(6), 720, 56, 1455);
  expect_subgroups(alternating_group(4), 12, 5, 10);
  expect_subgroups(alternating_group(5), 60, 9, 59);
  expect_subgroups(alternating_group(6), 360, 22, 501);
  expect_subgroups(group_of(shape_make(THR_MAKE_DOME, 5, 0)), 8, 8, 10);
  expect_subgroups(group_of(no_feet(solid_make(TETRAHEDRON))), 24, 11, 30);
  expect_subgroups(group_of(no_feet(solid_make(CUBE))), 48, 33, 98);
  expect_subgroups(group_of(no_feet(solid_make(ICOSAHEDRON))), 120, 22, 164);
  expect_subgroups(group_of(truncated_icosahedron()), 120, 22, 164);
  expect_subgroups(quaternion_group(), 8, 6, 6);
  expect_subgroups(abelian_group(2, (const int[]){2, 2}), 4, 5, 5);
  expect_subgroups(abelian_group(4, (const int[]){2, 2, 2, 2}), 16, 67, 67);
  expect_subgroups(generate(3, NULL, 0), 1, 1, 1);
}
END_TEST

/* Z_n: one per divisor. D_n: one cyclic per divisor d of n, and n/d dihedral ones with d turns. */
START_TEST(cyclic_and_dihedral_groups)
{
  for (int n = 3; n <= 60; n++) {
    int divisors = 0, sum = 0;
    for (int d = 1; d <= n; d++)
      if (n % d == 0) divisors++, sum += d;
    expect_subgroups(abelian_group(1, &n), n, divisors, divisors);
    int k, all;
    thr_group g = group_of(no_feet(ring_make(n)));
    count_subgroups(&g, &k, &all);
    ck_assert_int_eq(all, divisors + sum);
    thr_group_destroy(&g);
  }
}
END_TEST

/* Every subset of a group of order 16 or less. */
START_TEST(all_subsets_of_small_groups)
{
  thr_group all[] = {symmetric_group(3),
                     alternating_group(4),
                     quaternion_group(),
                     abelian_group(2, (const int[]){4, 4}),
                     abelian_group(3, (const int[]){2, 2, 4}),
                     abelian_group(4, (const int[]){2, 2, 2, 2}),
                     abelian_group(2, (const int[]){2, 8}),
                     group_of(no_feet(ring_make(8))),
                     group_of(no_feet(ring_make(7))),
                     group_of(shape_make(THR_MAKE_TUBE, 6, 2)),
                     group_of(no_feet(shape_make(THR_MAKE_TUBE, 4, 3))),
                     group_of(no_feet(grid_make(2, 3)))};
  for (int k = 0; k < 12; k++) {
    thr_group *g = &all[k];
    int classes, subgroups, count = 0;
    ck_assert_int_le(g->order, 16);
    for (unsigned s = 1; s < 1u << g->order; s += 2) {
      bool closed = true;
      for (int a = 0; a < g->order && closed; a++)
        for (int b = 0; b < g->order && closed; b++)
          closed = !(s >> a & 1) || !(s >> b & 1) || (s >> times(g, a, b) & 1);
      count += closed;
    }
    count_subgroups(g, &classes, &subgroups);
    ck_assert_int_eq(subgroups, count);
    thr_group_destroy(g);
  }
}
END_TEST

/* With too few classes allowed, what is there is sound, and the least and the whole are among it.
 */
START_TEST(capped_classes)
{
  thr_group g = symmetric_group(5);
  for (int most = 2; most <= 19; most++) {
    thr_subgroup_classes c;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, most, &c, NULL), THR_OK);
    ck_assert_int_eq(c.n, most);
    ck_assert(c.complete == (most == 19));
    ck_assert_int_eq(c.subgroup[0].order, 120);
    ck_assert_int_eq(c.subgroup[most - 1].order, 1);
    for (int k = 0; k < c.n; k++)
      assert_subgroup(&g, &c.subgroup[k]);
    thr_subgroup_classes_destroy(&c);
  }
  thr_group_destroy(&g);
}
END_TEST

/* 2^10: two hundred million subgroups. */
START_TEST(elementary_abelian_group_is_capped)
{
  static const int two[10] = {2, 2, 2, 2, 2, 2, 2, 2, 2, 2};
  thr_group g = abelian_group(10, two);
  thr_subgroup_classes c;
  ck_assert_int_eq(g.order, 1024);
  ck_assert_int_eq(thr_subgroup_classes_find(&g, 500, &c, NULL), THR_OK);
  ck_assert(!c.complete && c.n == 500);
  thr_subgroup_classes_destroy(&c);
  thr_group_destroy(&g);
}
END_TEST

/* ---- memory ---- */

static thr_status run(const thr_frame *f, const int *edge_colour, thr_automorphisms *a,
                      thr_group *g, thr_subgroup_classes *c, thr_err *err)
{
  thr_automorphism_options o = {NULL, edge_colour};
  thr_status st = thr_automorphisms_find(f, &o, a, err);
  if (!st) st = thr_group_generate(a->n, a->generator, a->n_generators, THR_GROUP_CAP, g, err);
  if (!st) st = thr_subgroup_classes_find(g, 100, c, err);
  return st;
}

START_TEST(every_allocation_fails_once)
{
  thr_frame f = no_feet(solid_make(CUBE));
  int edge_colour[12];
  for (int e = 0; e < 12; e++)
    edge_colour[e] = f.xyz[f.edge[e][0]][2] != f.xyz[f.edge[e][1]][2]; /* one direction apart */
  thr_status st = THR_ENOMEM;
  long k = 0;
  while (st) {
    thr_automorphisms a = {0};
    thr_group g = {0};
    thr_subgroup_classes c = {0};
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = run(&f, edge_colour, &a, &g, &c, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_msg(st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st, err.text);
      ck_assert(!c.subgroup && !c.conjugates && c.n == 0);
      ck_assert(g.image ? g.order == 16 : !g.product);
      ck_assert(!!a.generator == !!a.orbit);
    } else {
      ck_assert_int_eq(g.order, 16);
    }
    thr_automorphisms_destroy(&a);
    thr_group_destroy(&g);
    thr_subgroup_classes_destroy(&c);
    ck_assert_int_lt(k, 10000);
  }
  ck_assert_int_gt(k, 40);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("group");
  ADD_TEST(s, 20, orders_of_solids_and_shapes);
  ADD_TEST(s, 20, orders_of_tubes);
  ADD_TEST(s, 20, orders_of_graphs);
  ADD_TEST(s, 60, all_permutations_of_small_frames);
  ADD_TEST(s, 20, renumbering);
  ADD_TEST(s, 20, node_and_edge_colours);
  ADD_TEST(s, 20, edge_lengths_are_colours);
  ADD_TEST(s, 30, too_many_generators_are_refused);
#ifndef __SANITIZE_ADDRESS__ /* whose shadow memory is beyond every limit */
  ADD_TEST(s, 60, nauty_without_memory);
#else
  (void)nauty_without_memory;
#endif
  ADD_TEST(s, 20, listed_groups_obey_the_axioms);
  ADD_TEST(s, 20, refused_groups);
  ADD_TEST(s, 60, published_counts_of_subgroups);
  ADD_TEST(s, 60, cyclic_and_dihedral_groups);
  ADD_TEST(s, 20, found_within_limits);
  ADD_TEST(s, 20, all_subsets_of_small_groups);
  ADD_TEST(s, 20, capped_classes);
  ADD_TEST(s, 60, elementary_abelian_group_is_capped);
  ADD_TEST(s, 20, every_allocation_fails_once);
  return run_suite(s);
}
