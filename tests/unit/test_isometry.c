/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What automorphisms are in space, against the known classes of point groups; isometries from
 * coordinates against nauty's group.
 */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The listed group of a framework, and what each element is within tolerance. */
typedef struct {
  thr_group g;
  thr_isometry *element;
} named_group;

static named_group name_elements(const thr_frame *f, double tolerance)
{
  thr_automorphism_options o = {0};
  thr_automorphisms a;
  named_group n;
  ck_assert_int_eq(thr_automorphisms_find(f, &o, &a, NULL), THR_OK);
  ck_assert_int_eq(thr_group_generate(a.n, a.generator, a.n_generators, THR_GROUP_CAP, &n.g, NULL),
                   THR_OK);
  n.element = calloc((size_t)n.g.order, sizeof *n.element);
  ck_assert(n.element != NULL);
  for (int k = 0; k < n.g.order; k++)
    thr_isometry_of(f, &n.g.image[k * a.n], tolerance, &n.element[k]);
  thr_automorphisms_destroy(&a);
  return n;
}

static void named_group_destroy(named_group *n)
{
  thr_group_destroy(&n->g);
  free(n->element);
}

static int count_named(const named_group *n, const char *name)
{
  int count = 0;
  for (int k = 0; k < n->g.order; k++)
    count += strcmp(n->element[k].name, name) == 0;
  return count;
}

/* Where axis and angle, or the mirror or inversion, send a node must be where its image is. */
static void assert_moves(const thr_frame *f, const int *image, const thr_isometry *o,
                         double tolerance)
{
  double c[3] = {0}, size = 0;
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      c[i] += f->xyz[v][i] / f->n_nodes;
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      size += (f->xyz[v][i] - c[i]) * (f->xyz[v][i] - c[i]) / f->n_nodes;
  size = sqrt(size);
  for (int v = 0; v < f->n_nodes; v++) {
    double x[3], along = 0, turned[3], cosine = cos(o->angle), sine = sin(o->angle), off = 0;
    const double *a = o->axis;
    for (int i = 0; i < 3; i++)
      x[i] = f->xyz[v][i] - c[i];
    for (int i = 0; i < 3; i++)
      along += a[i] * x[i];
    for (int i = 0; i < 3; i++) { /* Rodrigues; angle 0 for a mirror */
      double across = a[(i + 1) % 3] * x[(i + 2) % 3] - a[(i + 2) % 3] * x[(i + 1) % 3];
      turned[i] = x[i] * cosine + across * sine + a[i] * along * (1 - cosine);
      if (o->kind == THR_ISO_MIRROR || o->kind == THR_ISO_ROTOREFLECTION)
        turned[i] -= 2 * a[i] * along;
      if (o->kind == THR_ISO_INVERSION) turned[i] = -x[i];
      if (o->kind == THR_ISO_IDENTITY) turned[i] = x[i];
      off += pow(turned[i] - (f->xyz[image[v]][i] - c[i]), 2);
    }
    ck_assert_double_le(sqrt(off), tolerance * size);
  }
}

static void assert_sound(const thr_frame *f, const named_group *n, double tolerance)
{
  for (int k = 0; k < n->g.order; k++) {
    const thr_isometry *o = &n->element[k];
    double norm = sqrt(o->axis[0] * o->axis[0] + o->axis[1] * o->axis[1] + o->axis[2] * o->axis[2]);
    bool turns = o->kind == THR_ISO_ROTATION || o->kind == THR_ISO_ROTOREFLECTION;
    ck_assert_int_eq(o->order, n->g.power_order[k]);
    ck_assert((k == 0) == (o->kind == THR_ISO_IDENTITY));
    if (o->kind == THR_ISO_NONE) continue;
    ck_assert_double_eq_tol(norm, turns || o->kind == THR_ISO_MIRROR, 1e-12);
    ck_assert(turns ? o->angle > -THR_PI && o->angle <= THR_PI && o->angle != 0 : o->angle == 0);
    for (int i = 0; i < 3; i++) /* the largest component is positive */
      ck_assert(o->axis[i] > -1e-9 ||
                fmax(fmax(o->axis[0], o->axis[1]), o->axis[2]) >= -o->axis[i] - 1e-9);
    assert_moves(f, &n->g.image[k * f->n_nodes], o, tolerance);
  }
}

/* ---- point groups ---- */

static void expect_counts(thr_frame f, const char *group, int kinds, const char *const *name,
                          const int *count)
{
  named_group n = name_elements(&f, 1e-6);
  char text[16];
  int all = 0;
  assert_sound(&f, &n, 1e-9);
  for (int i = 0; i < kinds; i++) {
    ck_assert_msg(count_named(&n, name[i]) == count[i], "%s: %d of %s", group,
                  count_named(&n, name[i]), name[i]);
    all += count[i];
  }
  ck_assert_int_eq(all, n.g.order);
  for (int k = 0; k < n.g.order; k++)
    ck_assert_double_le(n.element[k].residual, 1e-12);
  thr_point_group_name(n.element, n.g.order, text);
  ck_assert_str_eq(text, group);
  named_group_destroy(&n);
  thr_frame_destroy(&f);
}

static const thr_limits no_limits;

START_TEST(classes_of_cubic_groups)
{
  static const char *const octahedral[] = {"identity",  "C2",     "C3", "C4",
                                           "inversion", "mirror", "S4", "S6"};
  static const int of_octahedral[] = {1, 9, 8, 6, 1, 9, 6, 8}; /* C2: 3 squares of C4, and 6 */
  static const char *const tetrahedral[] = {"identity", "C3", "C2", "S4", "mirror"};
  static const int of_tetrahedral[] = {1, 8, 3, 6, 6};
  expect_counts(no_feet(solid_make(CUBE)), "Oh", 8, octahedral, of_octahedral);
  expect_counts(no_feet(solid_make(OCTAHEDRON)), "Oh", 8, octahedral, of_octahedral);
  expect_counts(no_feet(solid_make(TETRAHEDRON)), "Td", 5, tetrahedral, of_tetrahedral);
}
END_TEST

START_TEST(classes_of_icosahedral_group)
{
  static const char *const name[] = {"identity",  "C5",  "C5^2",  "C3", "C2",
                                     "inversion", "S10", "S10^3", "S6", "mirror"};
  static const int count[] = {1, 12, 12, 20, 15, 1, 12, 12, 20, 15};
  expect_counts(no_feet(solid_make(ICOSAHEDRON)), "Ih", 10, name, count);
  expect_counts(no_feet(solid_make(DODECAHEDRON)), "Ih", 10, name, count);
  expect_counts(truncated_icosahedron(), "Ih", 10, name, count);
  expect_counts(shape_make(THR_MAKE_SPHERE, 4, 0), "Ih", 10, name, count);
}
END_TEST

static void expect_name(thr_frame f, const char *group)
{
  named_group n = name_elements(&f, 1e-6);
  char text[16];
  assert_sound(&f, &n, 1e-9);
  thr_point_group_name(n.element, n.g.order, text);
  ck_assert_str_eq(text, group);
  named_group_destroy(&n);
  thr_frame_destroy(&f);
}

START_TEST(generated_frames)
{
  char name[16];
  expect_name(shape_make(THR_MAKE_DOME, 5, 0), "C4v");
  expect_name(shape_make(THR_MAKE_DOME, 6, 0), "C4v");
  expect_name(shape_make(THR_MAKE_GEODESIC, 2, 0), "C5v");
  expect_name(shape_make(THR_MAKE_GEODESIC, 3, 0), "C5v");
  expect_name(shape_make(THR_MAKE_SPHERE, 1, 0), "Ih");
  expect_name(shape_make(THR_MAKE_SPHERE, 3, 0), "Ih");
  for (int n = 3; n <= 12; n++) {
    snprintf(name, sizeof name, "C%dv", n);
    expect_name(shape_make(THR_MAKE_TUBE, n, 5), name);
    snprintf(name, sizeof name, "D%dh", n);
    expect_name(no_feet(shape_make(THR_MAKE_TUBE, n, 5)), name);
    snprintf(name, sizeof name, "C%dv", n); /* flat: mirrored, not turned over */
    expect_name(no_feet(ring_make(n)), name);
  }
  expect_name(no_feet(path_make(5)), "C2");
  expect_name(path_make(5), "C1");
  expect_name(no_feet(grid_make(4, 4)), "C4v");
  expect_name(no_feet(grid_make(4, 3)), "C2v");
}
END_TEST

/* Antiprism of n: nodes of the upper ring over the gaps of the lower, turned on by twist, which
 * leaves out half the edges between. */
static thr_frame antiprism(int n, double twist)
{
  double xyz[40][3];
  int edge[80][2], m = 0;
  for (int i = 0; i < n; i++) {
    double low = 2 * THR_PI * i / n, high = low + THR_PI / n + twist;
    xyz[i][0] = cos(low), xyz[i][1] = sin(low), xyz[i][2] = 0.6;
    xyz[n + i][0] = cos(high), xyz[n + i][1] = sin(high), xyz[n + i][2] = -0.6;
    edge[m][0] = i, edge[m++][1] = (i + 1) % n;
    edge[m][0] = n + i, edge[m++][1] = n + (i + 1) % n;
    edge[m][0] = i, edge[m++][1] = n + i;
    if (twist == 0) edge[m][0] = i, edge[m++][1] = n + (i + n - 1) % n;
  }
  return no_feet(frame_make(2 * n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL));
}

/* Groups without generators of their own: the subgroups of a larger one, told by their elements'
 * names. The lists are those of the International Tables for Crystallography, and of Altmann &
 * Herzig for the others. */
static void expect_classes(thr_frame f, int names, const char *const *name)
{
  named_group n = name_elements(&f, 1e-6);
  thr_subgroup_classes c;
  bool *seen = calloc((size_t)names, sizeof *seen);
  ck_assert(seen != NULL);
  ck_assert_int_eq(thr_subgroup_classes_find(&n.g, 200, &c, NULL), THR_OK);
  for (int k = 0; k < c.n; k++) {
    thr_isometry *part = calloc((size_t)c.subgroup[k].order, sizeof *part);
    char text[16];
    bool known = false;
    ck_assert(part != NULL);
    for (int i = 0; i < c.subgroup[k].order; i++)
      part[i] = n.element[c.subgroup[k].element[i]];
    thr_point_group_name(part, c.subgroup[k].order, text);
    for (int i = 0; i < names; i++)
      if (strcmp(text, name[i]) == 0) known = seen[i] = true;
    ck_assert_msg(known, "subgroup of order %d is called %s", c.subgroup[k].order, text);
    free(part);
  }
  for (int i = 0; i < names; i++)
    ck_assert_msg(seen[i], "no subgroup is called %s", name[i]);
  thr_subgroup_classes_destroy(&c);
  named_group_destroy(&n);
  thr_frame_destroy(&f);
  free(seen);
}

START_TEST(names_of_subgroups)
{
  static const char *const cubic[] = {"Oh",  "O",  "Td",  "Th",  "T",   "D4h", "D4",  "C4v", "C4h",
                                      "D2d", "C4", "S4",  "D2h", "D2",  "C2v", "C2h", "C2",  "Cs",
                                      "Ci",  "C1", "D3d", "D3",  "C3v", "S6",  "C3"};
  static const char *const hexagonal[] = {"D6h", "D6",  "C6v", "C6h", "C6", "D3h", "D3d",
                                          "D3",  "C3v", "C3h", "S6",  "C3", "D2h", "D2",
                                          "C2v", "C2h", "C2",  "Cs",  "Ci", "C1"};
  static const char *const icosahedral[] = {"Ih",  "I",   "Th", "T",   "D5d", "D5", "C5v", "S10",
                                            "C5",  "D3d", "D3", "C3v", "S6",  "C3", "D2h", "D2",
                                            "C2v", "C2h", "C2", "Cs",  "Ci",  "C1"};
  static const char *const square[] = {"D4d", "D4", "C4v", "S8", "C4",
                                       "C2v", "D2", "C2",  "Cs", "C1"};
  expect_classes(no_feet(solid_make(CUBE)), 25, cubic);
  expect_classes(no_feet(shape_make(THR_MAKE_TUBE, 6, 3)), 20, hexagonal);
  expect_classes(no_feet(solid_make(ICOSAHEDRON)), 22, icosahedral);
  expect_classes(antiprism(4, 0), 10, square);
  expect_name(antiprism(5, 0), "D5d");
  expect_name(antiprism(7, 0), "D7d");
}
END_TEST

/* A prism whose top is turned: its turns stay rotations, its mirrors become topological. */
START_TEST(twisted_prism)
{
  thr_frame f = antiprism(5, 0.1);
  named_group n = name_elements(&f, 1e-6);
  thr_isometry part[20];
  char text[16];
  int kept = 0;
  ck_assert_int_eq(n.g.order, 20);
  assert_sound(&f, &n, 1e-9);
  for (int k = 0; k < 20; k++) {
    if (n.element[k].kind != THR_ISO_NONE) {
      part[kept++] = n.element[k];
      ck_assert_double_le(n.element[k].residual, 1e-12);
    } else {
      snprintf(text, sizeof text, "order %d", n.g.power_order[k]);
      ck_assert_str_eq(n.element[k].name, text);
      ck_assert_double_ge(n.element[k].residual, 0.01);
    }
  }
  ck_assert_int_eq(kept, 10);
  thr_point_group_name(part, kept, text);
  ck_assert_str_eq(text, "D5");
  thr_point_group_name(n.element, 20, text);
  ck_assert_str_eq(text, "");
  named_group_destroy(&n);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- noise, motion, warping ---- */

static double gauss(rng *r)
{
  return sqrt(-2 * log(1 - rng_unit(r))) * cos(2 * THR_PI * rng_unit(r));
}

static thr_frame noisy(rng *r, const thr_frame *f, double sigma)
{
  thr_frame g;
  ck_assert_int_eq(thr_frame_copy(&g, f, NULL), THR_OK);
  for (int v = 0; v < g.n_nodes; v++)
    for (int i = 0; i < 3; i++)
      g.xyz[v][i] += sigma * gauss(r);
  return g;
}

/* Each residual is about the noise; the names stay. An image differs from a moved node by noise of
 * twice the variance, in 3 directions. */
START_TEST(noise_is_the_residual)
{
  rng r = rng_make(77);
  thr_frame exact = no_feet(shape_make(THR_MAKE_SPHERE, 3, 0));
  double radius = sqrt(pow(exact.xyz[0][0], 2) + pow(exact.xyz[0][1], 2) + pow(exact.xyz[0][2], 2));
  for (int power = 2; power <= 6; power++) {
    double sigma = pow(10, -power);
    thr_frame f = noisy(&r, &exact, sigma * radius);
    named_group n = name_elements(&f, 10 * sigma), true_ones = name_elements(&exact, 1e-6);
    assert_sound(&f, &n, 20 * sigma);
    for (int k = 1; k < n.g.order; k++) {
      ck_assert_str_eq(n.element[k].name, true_ones.element[k].name);
      ck_assert_double_ge(n.element[k].residual, 0.5 * sqrt(6) * sigma);
      ck_assert_double_le(n.element[k].residual, 1.5 * sqrt(6) * sigma);
    }
    char text[16];
    thr_point_group_name(n.element, n.g.order, text);
    ck_assert_str_eq(text, "Ih");
    named_group_destroy(&n);
    n = name_elements(&f, 0.1 * sigma);
    for (int k = 1; k < n.g.order; k++)
      ck_assert_int_eq(n.element[k].kind, THR_ISO_NONE);
    named_group_destroy(&n);
    named_group_destroy(&true_ones);
    thr_frame_destroy(&f);
  }
  thr_frame_destroy(&exact);
}
END_TEST

/* A square about a point far away, or tiny, or huge: its size and a quarter turn about its centre
 * are known. */
START_TEST(squares_turn_wherever_they_are)
{
  static const struct {
    double scale, at, within;
  } cases[] = {{1, 0, 1e-14}, {1, 1e7 / 3, 1e-7}, {1e-150, 0, 1e-14}, {1e140, 0, 1e-14}};
  double xyz[4][3];
  int image[4] = {1, 2, 3, 0};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const double scale = cases[k].scale, at = cases[k].at;
    for (int v = 0; v < 4; v++)
      for (int i = 0; i < 3; i++)
        xyz[v][i] = at * (i + 1) + scale * (i == 0   ? (v == 0) - (v == 2)
                                            : i == 1 ? (v == 1) - (v == 3)
                                                     : 0);
    const thr_frame f = {.n_nodes = 4, .xyz = xyz};
    double centroid[3], size;
    thr_frame_extent(&f, centroid, &size);
    thr_motion m;
    thr_procrustes(&f, image, &m);
    const double quarter[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++) {
      ck_assert_double_eq_tol(centroid[i] / scale, at * (i + 1) / scale, cases[k].within);
      for (int j = 0; j < 3; j++)
        ck_assert_double_eq_tol(m.q[i][j], quarter[i][j], cases[k].within);
    }
    ck_assert_double_eq_tol(size / scale, 1, cases[k].within);
    ck_assert(m.proper && m.flat && m.residual <= cases[k].within && m.farthest <= cases[k].within);
  }
}
END_TEST

/* Two nodes that nearly lie on a line, and two on another line at so small an angle to it: all go
 * to the latter, or to its other ends. What is found is orthogonal but for rounding, which a tilt
 * near to it makes large. */
START_TEST(lines_are_tilted_by_rotations)
{
  rng r = rng_make(77);
  double xyz[4][3], a[3], b[3];
  for (int k = 0; k < 400; k++) {
    double tilt = pow(10, -4.5 - 10 * rng_unit(&r)),
           within = tilt > 1e-9 ? 2e-14 / tilt : 2 * tilt + 1e-14;
    int back = k % 2, image[4] = {2 + back, 3 - back, 2 + back, 3 - back};
    for (int i = 0; i < 3; i++)
      a[i] = gauss(&r), b[i] = tilt * gauss(&r);
    for (int v = 0; v < 4; v++)
      for (int i = 0; i < 3; i++)
        xyz[v][i] = (v % 2 ? -1 : 1) * (a[i] + (v / 2) * b[i]);
    const thr_frame f = {.n_nodes = 4, .xyz = xyz};
    thr_motion m;
    thr_procrustes(&f, image, &m);
    ck_assert(m.proper && m.flat);
    ck_assert_double_le(m.residual, 10 * tilt);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        ck_assert_double_eq_tol(thr_dot(m.q[i], m.q[j]), i == j, 10 * within);
  }
}
END_TEST

/* Distances of the moved nodes from their images, by definition; and the motion is the nearest one,
 * which leaves the correlation symmetric, if it is not flat. */
static void assert_nearest(const thr_frame *f, const int *image, const thr_motion *m)
{
  double centroid[3], size, sum = 0, most = 0, left[3][3] = {{0}};
  thr_frame_extent(f, centroid, &size);
  for (int v = 0; v < f->n_nodes; v++) {
    double from[3], off[3];
    for (int i = 0; i < 3; i++)
      from[i] = f->xyz[v][i] - centroid[i];
    for (int i = 0; i < 3; i++) {
      double to = f->xyz[image[v]][i] - centroid[i];
      off[i] = thr_dot(m->q[i], from) - to;
      for (int j = 0; j < 9; j++)
        left[j / 3][j % 3] += m->q[i][j / 3] * to * from[j % 3];
    }
    sum += thr_dot(off, off);
    most = fmax(most, sqrt(thr_dot(off, off)));
  }
  ck_assert_double_eq_tol(m->residual, sqrt(sum / f->n_nodes) / size, 1e-9);
  ck_assert_double_eq_tol(m->farthest, most / size, 1e-9);
  for (int i = 0; i < 3 && !m->flat; i++)
    ck_assert_double_eq_tol(left[i][(i + 1) % 3], left[(i + 1) % 3][i], 1e-9 * size * size);
}

/* However far a permutation is from an isometry, the motion is one, but for the last digits. */
START_TEST(motions_are_orthogonal)
{
  rng r = rng_make(31);
  double xyz[6][3], stretch[3];
  int image[6];
  for (int k = 0; k < 5000; k++) {
    for (int i = 0; i < 3; i++)
      stretch[i] = exp(gauss(&r));
    for (int v = 0; v < 6; v++) {
      image[v] = rng_below(&r, 6);
      for (int i = 0; i < 3; i++)
        xyz[v][i] = stretch[i] * gauss(&r);
    }
    const thr_frame f = {.n_nodes = 6, .xyz = xyz};
    thr_motion m;
    thr_procrustes(&f, image, &m);
    assert_nearest(&f, image, &m);
    for (int i = 0; i < 3 && !m.flat; i++)
      for (int j = 0; j < 3; j++)
        ck_assert_double_eq_tol(thr_dot(m.q[i], m.q[j]), i == j, 1e-14);
  }
}
END_TEST

/* A box of half the sides 1, 1 and so much: flat if that is less than a ten-thousandth. Seen from
 * each of its sides. */
START_TEST(flat_is_thinner_than_a_ten_thousandth)
{
  static const double thin[] = {0, 1e-6, 0.9e-4, 1.1e-4, 1e-3, 1e-2, 1};
  int image[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  double xyz[8][3];
  for (size_t k = 0; k < sizeof thin / sizeof *thin; k++)
    for (int side = 0; side < 3; side++) {
      for (int v = 0; v < 8; v++)
        for (int i = 0; i < 3; i++)
          xyz[v][i] = (v >> i & 1 ? 1 : -1) * (i == side ? thin[k] : 1);
      const thr_frame f = {.n_nodes = 8, .xyz = xyz};
      thr_motion m;
      thr_procrustes(&f, image, &m);
      ck_assert_int_eq(m.flat, thin[k] < 1e-4);
      ck_assert(m.proper);
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
          ck_assert_double_eq_tol(m.q[i][j], i == j, 1e-12);
    }
}
END_TEST

/* Nodes on a line, in this direction or that: reversed by half a turn across it; all in one place,
 * nothing moves. */
START_TEST(lines_are_reversed_by_half_turns)
{
  rng r = rng_make(5);
  double xyz[3][3];
  int image[3] = {2, 1, 0};
  for (int k = 0; k < 40; k++) {
    double along[3];
    for (int i = 0; i < 3; i++)
      along[i] = k == 39 ? 0
                 : k < 6 ? (k / 2 == i) * (k % 2 ? -1 : 1)
                         : gauss(&r) * pow(10, -(k + i) % 4);
    for (int v = 0; v < 3; v++)
      for (int i = 0; i < 3; i++)
        xyz[v][i] = 3 - i + (v - 1) * along[i];
    const thr_frame f = {.n_nodes = 3, .xyz = xyz};
    thr_motion m;
    thr_procrustes(&f, image, &m);
    ck_assert(m.proper && m.flat);
    ck_assert_double_le(m.residual, 1e-12);
    ck_assert_double_le(m.farthest, 1e-12);
    double norm = sqrt(thr_dot(along, along));
    for (int i = 0; i < 3; i++) {
      ck_assert_double_eq_tol(thr_dot(m.q[i], along), k < 39 ? -along[i] : 0, 1e-12 * (1 + norm));
      for (int j = 0; j < 3; j++) {
        ck_assert_double_eq_tol(thr_dot(m.q[i], m.q[j]), i == j, 1e-12);
        if (k == 39) ck_assert_double_eq_tol(m.q[i][j], i == j, 1e-15);
      }
    }
  }
}
END_TEST

/* Turned by a random rotation, scaled and moved. */
static thr_frame moved(rng *r, const thr_frame *f)
{
  thr_frame g;
  double q[4], norm = 0, scale = exp(4 * gauss(r));
  ck_assert_int_eq(thr_frame_copy(&g, f, NULL), THR_OK);
  for (int i = 0; i < 4; i++)
    q[i] = gauss(r), norm += q[i] * q[i];
  for (int i = 0; i < 4; i++)
    q[i] /= sqrt(norm);
  double w = q[0], x = q[1], y = q[2], z = q[3];
  double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                    {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                    {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (int v = 0; v < g.n_nodes; v++)
    for (int i = 0; i < 3; i++)
      g.xyz[v][i] = scale * (m[i][0] * f->xyz[v][0] + m[i][1] * f->xyz[v][1] +
                             m[i][2] * f->xyz[v][2] + 3 * i - 5);
  return g;
}

static thr_frame sample_frame(int k)
{
  switch (k) {
  case 0: return no_feet(solid_make(CUBE));
  case 1: return no_feet(solid_make(ICOSAHEDRON));
  case 2: return shape_make(THR_MAKE_DOME, 6, 0);
  case 3: return shape_make(THR_MAKE_GEODESIC, 3, 0);
  case 4: return no_feet(shape_make(THR_MAKE_TUBE, 7, 4));
  case 5: return antiprism(6, 0);
  case 6: return antiprism(4, 0.2);
  case 7: return no_feet(grid_make(5, 5));
  case 8: return no_feet(path_make(6));
  case 9: return truncated_icosahedron();
  case 10: return shape_make(THR_MAKE_HONEYCOMB, 3, 0);
  case 11: return no_feet(star_make(6));
  case 12: return shape_make(THR_MAKE_SPHERE, 6, 0);
  case 13: return shape_make(THR_MAKE_DOME, 20, 0);
  default: return shape_make(THR_MAKE_TUBE, 24, 20);
  }
}
enum { SAMPLES = 15 };

START_TEST(moving_changes_nothing)
{
  rng r = rng_make(9);
  for (int k = 0; k < 12; k++) {
    thr_frame f = sample_frame(k);
    named_group n = name_elements(&f, 1e-6);
    for (int trial = 0; trial < 5; trial++) {
      thr_frame g = moved(&r, &f);
      named_group m = name_elements(&g, 1e-6);
      ck_assert_int_eq(m.g.order, n.g.order);
      assert_sound(&g, &m, 1e-8);
      for (int i = 0; i < n.g.order; i++) {
        ck_assert_str_eq(m.element[i].name, n.element[i].name);
        ck_assert_double_eq_tol(m.element[i].residual, n.element[i].residual, 1e-9);
      }
      named_group_destroy(&m);
      thr_frame_destroy(&g);
    }
    named_group_destroy(&n);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Warped more and more, a dome keeps its topological group and its elements get farther from
 * isometries. */
START_TEST(warping_raises_residuals)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 7, 0);
  double last[8] = {0}, half = thr_frame_diagonal(&f) / 3;
  for (int step = 1; step <= 5; step++) {
    thr_frame g;
    ck_assert_int_eq(thr_frame_copy(&g, &f, NULL), THR_OK);
    for (int v = 0; v < f.n_nodes; v++) {
      double x = f.xyz[v][0] / half, y = f.xyz[v][1] / half;
      g.xyz[v][0] += 0.05 * step * half * (0.7 * x * x * y + 0.3 * y * y + 0.5 * x);
      g.xyz[v][2] += 0.05 * step * half * (x * y * y + 0.4 * x * x - 0.3 * y);
    }
    named_group n = name_elements(&g, 1e-3);
    ck_assert_int_eq(n.g.order, 8);
    for (int k = 1; k < 8; k++) {
      ck_assert_int_eq(n.element[k].kind, THR_ISO_NONE);
      ck_assert_double_gt(n.element[k].residual, last[k] + 1e-3);
      last[k] = n.element[k].residual;
    }
    named_group_destroy(&n);
    thr_frame_destroy(&g);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Two nodes so near each other that exchanging them moves nothing by much: no isometry. */
START_TEST(exchanged_neighbours)
{
  static const double xyz[5][3] = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 3}, {10, 10, 3.001}};
  static const int edge[6][2] = {{0, 1}, {0, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 4}},
                   image[5] = {0, 1, 2, 4, 3};
  thr_frame f = no_feet(frame_make(5, xyz, 6, edge, NULL, NULL));
  thr_isometry o;
  ck_assert(keeps_frame(&f, NULL, image));
  thr_isometry_of(&f, image, 1e-2, &o);
  ck_assert_int_eq(o.kind, THR_ISO_NONE);
  ck_assert_double_lt(o.residual, 1e-3);
  ck_assert_str_eq(o.name, "order 2");
  thr_frame_destroy(&f);
}
END_TEST

/* ---- isometries from coordinates ---- */

/* The elements of the topological group whose every node comes within tolerance of its image, by
 * the named isometry: rows. */
static void assert_geometric_part(const thr_frame *f, double tolerance)
{
  int *found, count, kept = 0;
  thr_err err = {0};
  named_group n = name_elements(f, tolerance);
  assert_ok(
      thr_isometries_find(f, NULL, tolerance, THR_GROUP_CAP, &no_limits, &found, &count, &err),
      &err);
  for (int k = 0; k < n.g.order; k++) {
    const int *image = &n.g.image[k * f->n_nodes];
    if (n.element[k].kind == THR_ISO_NONE) continue;
    ck_assert_int_lt(kept, count);
    ck_assert(memcmp(&found[kept++ * f->n_nodes], image, (size_t)f->n_nodes * sizeof *image) == 0);
  }
  ck_assert_int_eq(kept, count);
  int *among, listed;
  ck_assert_int_eq(thr_isometries_among(f, n.g.image, n.g.order, tolerance, &among, &listed, NULL),
                   THR_OK);
  ck_assert(listed == count &&
            memcmp(among, found, (size_t)count * (size_t)f->n_nodes * sizeof *found) == 0);
  free(among);
  free(found);
  named_group_destroy(&n);
}

START_TEST(isometries_are_the_geometric_part)
{
  rng r = rng_make(31);
  for (int k = 0; k < SAMPLES; k++) {
    thr_frame f = sample_frame(k), g = moved(&r, &f);
    assert_geometric_part(&f, 1e-6);
    assert_geometric_part(&g, 1e-6);
    thr_frame_destroy(&f);
    thr_frame_destroy(&g);
  }
}
END_TEST

/* Noise of 1e-4 of the size: nothing but the identity at 1e-6, everything at 1e-2. */
START_TEST(isometries_within_tolerance)
{
  rng r = rng_make(32);
  for (int k = 0; k < SAMPLES; k++) {
    thr_frame f = sample_frame(k), g = noisy(&r, &f, 1e-4 * thr_frame_diagonal(&f) / 3);
    int *found, *tight, count, few, *loose, many;
    ck_assert_int_eq(
        thr_isometries_find(&f, NULL, 1e-6, THR_GROUP_CAP, &no_limits, &found, &count, NULL),
        THR_OK);
    ck_assert_int_eq(
        thr_isometries_find(&g, NULL, 1e-6, THR_GROUP_CAP, &no_limits, &tight, &few, NULL), THR_OK);
    ck_assert_int_eq(
        thr_isometries_find(&g, NULL, 1e-2, THR_GROUP_CAP, &no_limits, &loose, &many, NULL),
        THR_OK);
    ck_assert_int_eq(few, 1);
    ck_assert_int_eq(many, count);
    ck_assert(memcmp(loose, found, (size_t)count * (size_t)f.n_nodes * sizeof *found) == 0);
    free(found);
    free(tight);
    free(loose);
    thr_frame_destroy(&f);
    thr_frame_destroy(&g);
  }
}
END_TEST

/* Are edges of one colour if, and only if, lengths lead from one to the other in steps that are
 * small enough? */
static void assert_linked(const thr_frame *f, const int *colour, double step)
{
  for (int a = 0; a < f->n_edges; a++)
    for (int b = 0; b < f->n_edges; b++) {
      double low = fmin(f->length[a], f->length[b]), high = fmax(f->length[a], f->length[b]),
             next = low;
      do { /* as far as one step leads */
        low = next;
        for (int e = 0; e < f->n_edges; e++)
          if (f->length[e] <= low + step) next = fmax(next, f->length[e]);
      } while (next > low);
      ck_assert_int_eq(colour[a] == colour[b], next >= high);
    }
}

/* Every automorphism that takes all nodes as near as this keeps the colours of lengths, whatever
 * the noise. */
START_TEST(colours_of_lengths_lose_no_isometry)
{
  rng r = rng_make(33);
  int kept = 0, lost = 0;
  for (int k = 0; k < 12 * SAMPLES; k++) {
    double tolerance = pow(10, -1 - 2 * rng_unit(&r)), centroid[3], size;
    thr_frame f = sample_frame(k % SAMPLES),
              g = noisy(&r, &f, tolerance * rng_unit(&r) * thr_frame_diagonal(&f) / 4);
    int *colour = calloc((size_t)g.n_edges, sizeof *colour);
    ck_assert(colour != NULL);
    named_group n = name_elements(&f, 1e-6);
    thr_frame_extent(&g, centroid, &size);
    ck_assert_int_eq(thr_length_colours(&g, tolerance, colour, NULL), THR_OK);
    if (g.n_edges < 60) assert_linked(&g, colour, 2 * tolerance * size);
    for (int i = 0; i < n.g.order; i++) {
      const int *image = &n.g.image[i * g.n_nodes];
      thr_motion m;
      thr_procrustes(&g, image, &m);
      if (m.farthest <= tolerance) {
        ck_assert(keeps_frame(&g, colour, image));
        kept += i > 0;
      } else {
        lost++;
      }
    }
    free(colour);
    named_group_destroy(&n);
    thr_frame_destroy(&f);
    thr_frame_destroy(&g);
  }
  ck_assert(kept > 100 && lost > 100);
}
END_TEST

/* All permutations of frameworks with coordinates on a small lattice. */
static void try_permutations(const thr_frame *f, int *image, int fixed, int *count)
{
  int n = f->n_nodes;
  for (int v = fixed; v < n; v++) {
    int swap = image[fixed];
    bool fits = true;
    image[fixed] = image[v], image[v] = swap;
    for (int u = 0; u < fixed && fits; u++) { /* distances between nodes are kept */
      double before = 0, after = 0;
      for (int i = 0; i < 3; i++) {
        before += pow(f->xyz[u][i] - f->xyz[fixed][i], 2);
        after += pow(f->xyz[image[u]][i] - f->xyz[image[fixed]][i], 2);
      }
      fits = before == after;
    }
    if (fits && fixed + 1 == n)
      *count += keeps_frame(f, NULL, image);
    else if (fits)
      try_permutations(f, image, fixed + 1, count);
    image[v] = image[fixed], image[fixed] = swap;
  }
}

START_TEST(isometries_by_all_permutations)
{
  int more = 0;
  for (int seed = 0; seed < 400; seed++) {
    rng r = rng_make(400 + (uint64_t)seed);
    double xyz[8][3];
    int edge[28][2], image[8], n = 0, m = 0, count = 0, by_search, *found,
                               height = rng_between(&r, 1, 2), feet[2] = {-1, -1};
    for (int cell = 0; cell < (seed % 3 ? 18 : 9) && n < 8; cell++) {
      if (rng_below(&r, 2)) continue;
      xyz[n][0] = cell % 3, xyz[n][1] = cell / 3 % 3, xyz[n++][2] = cell / 9 * height;
    }
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++)
        if (b == a + 1 || seed % 4 < 2 || rng_below(&r, 3) == 0) edge[m][0] = a, edge[m++][1] = b;
    if (n < 2) continue;
    if (seed % 8 == 7) feet[0] = rng_below(&r, n);
    thr_frame f = frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, feet);
    for (int v = 0; v < n; v++)
      image[v] = v;
    try_permutations(&f, image, 0, &count);
    ck_assert_int_eq(thr_isometries_find(&f, NULL, 1e-6, 100, &no_limits, &found, &by_search, NULL),
                     THR_OK);
    ck_assert_int_eq(by_search, count);
    for (int k = 0; k < by_search; k++)
      ck_assert(keeps_frame(&f, NULL, &found[k * n]));
    more += count > 1;
    free(found);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(more, 40);
}
END_TEST

START_TEST(more_isometries_than_the_cap)
{
  thr_frame f = no_feet(solid_make(CUBE));
  int *found, count;
  thr_err err = {0};
  assert_status(thr_isometries_find(&f, NULL, 1e-6, 47, &no_limits, &found, &count, &err),
                THR_ELIMIT, &err, "47");
  ck_assert(!found && count == 0);
  ck_assert_int_eq(thr_isometries_find(&f, NULL, 1e-6, 48, &no_limits, &found, &count, NULL),
                   THR_OK);
  ck_assert_int_eq(count, 48);
  free(found);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  thr_frame f = no_feet(solid_make(ICOSAHEDRON));
  thr_status st = THR_ENOMEM;
  long k = 0;
  while (st) {
    int *found, count;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_isometries_find(&f, NULL, 1e-6, THR_GROUP_CAP, &no_limits, &found, &count, &err);
    thr_alloc_fail_at(0);
    if (st)
      ck_assert_msg(st == THR_ENOMEM && !found && count == 0, "allocation %ld: status %d, %s", k,
                    (int)st, err.text);
    else
      ck_assert_int_eq(count, 120);
    free(found);
    ck_assert_int_lt(k, 1000);
  }
  ck_assert_int_gt(k, 10);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("isometry");
  ADD_TEST(s, 20, classes_of_cubic_groups);
  ADD_TEST(s, 20, classes_of_icosahedral_group);
  ADD_TEST(s, 20, generated_frames);
  ADD_TEST(s, 20, names_of_subgroups);
  ADD_TEST(s, 20, twisted_prism);
  ADD_TEST(s, 20, noise_is_the_residual);
  ADD_TEST(s, 20, moving_changes_nothing);
  ADD_TEST(s, 20, warping_raises_residuals);
  ADD_TEST(s, 20, exchanged_neighbours);
  ADD_TEST(s, 60, isometries_are_the_geometric_part);
  ADD_TEST(s, 60, isometries_within_tolerance);
  ADD_TEST(s, 60, colours_of_lengths_lose_no_isometry);
  ADD_TEST(s, 60, isometries_by_all_permutations);
  ADD_TEST(s, 20, more_isometries_than_the_cap);
  ADD_TEST(s, 20, every_allocation_fails_once);
  ADD_TEST(s, 10, squares_turn_wherever_they_are);
  ADD_TEST(s, 10, lines_are_reversed_by_half_turns);
  ADD_TEST(s, 20, lines_are_tilted_by_rotations);
  ADD_TEST(s, 20, motions_are_orthogonal);
  ADD_TEST(s, 20, flat_is_thinner_than_a_ten_thousandth);
  return run_suite(s);
}
