/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for symmetry against groups made of matrices, and against readings of cords
 * that are counted one by one. */
#include "graph/number.h"
#include "graph/check/check_parts.h"
#include "graph/framework/frame.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- point groups ---- */

enum { MOST = 130, MOST_GENERATORS = 3 };

typedef double matrix[3][3];

typedef struct {
  const char *name;
  int order, n_generators;
  matrix generator[MOST_GENERATORS];
} point_group;

/* Turn about z by a part of the full one, followed by the mirror z = 0 if asked for. */
static void turn(double part, bool mirror, matrix m)
{
  double c = cos(2 * THR_PI * part), s = sin(2 * THR_PI * part);
  memcpy(m, (matrix){{c, -s, 0}, {s, c, 0}, {0, 0, mirror ? -1 : 1}}, sizeof(matrix));
}

static matrix mirror_x = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
              mirror_z = {{1, 0, 0}, {0, 1, 0}, {0, 0, -1}},
              half_x = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
              half_z = {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
              third = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
              invert = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
              diagonal = {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
              quarter = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};

static void add(point_group *g, matrix m)
{
  memcpy(g->generator[g->n_generators++], m, sizeof(matrix));
}

/* A turn by a fifth about (0, 1, golden ratio), Rodrigues' formula. */
static void fifth(matrix m)
{
  double phi = (1 + sqrt(5)) / 2, norm = sqrt(1 + phi * phi), k[3] = {0, 1 / norm, phi / norm};
  double c = cos(2 * THR_PI / 5), s = sin(2 * THR_PI / 5);
  const matrix cross = {{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      m[i][j] = (i == j) * c + s * cross[i][j] + (1 - c) * k[i] * k[j];
}

enum { N_GROUPS = 36 };

/* The generators are those of the textbooks; orders are multiplied out from them below. */
static point_group group_number(int i)
{
  static const char *const name[N_GROUPS] = {
      "C1",  "Cs", "Ci",  "T",  "Td", "Th",  "O",   "Oh",  "I",   "Ih",  "C2",  "C3",
      "C4",  "C6", "S4",  "S6", "S8", "C2v", "C3v", "C4v", "C6v", "C2h", "C3h", "C4h",
      "C6h", "C9", "C9v", "D2", "D3", "D4",  "D6",  "D2h", "D3h", "D4h", "D2d", "D3d"};
  point_group g = {.name = name[i]};
  matrix m;
  if (i < 10) {
    if (i == 1) add(&g, mirror_z);
    if (i == 2) add(&g, invert);
    if (i >= 3 && i < 8) add(&g, third), add(&g, i < 6 ? half_z : quarter);
    if (i == 4) add(&g, diagonal);
    if (i == 5 || i == 7 || i == 9) add(&g, invert);
    if (i >= 8) fifth(m), add(&g, third), add(&g, m);
    return g;
  }
  int n = name[i][1] - '0';
  char letter = name[i][0], more = name[i][2];
  turn(more == 'd' ? 0.5 / n : 1.0 / n, letter == 'S' || more == 'd', m);
  add(&g, m);
  if (letter == 'D') add(&g, half_x);
  if (more == 'v') add(&g, mirror_x);
  if (more == 'h') add(&g, mirror_z);
  return g;
}

/* Number of the point, added if it is new. */
static int point_number(double (*xyz)[3], int *n, const double p[3])
{
  for (int v = 0; v < *n; v++)
    if (fabs(xyz[v][0] - p[0]) + fabs(xyz[v][1] - p[1]) + fabs(xyz[v][2] - p[2]) < 1e-9) return v;
  ck_assert_int_lt(*n, MOST);
  memcpy(xyz[*n], p, sizeof xyz[*n]);
  return (*n)++;
}

static void apply(matrix m, const double p[3], double out[3])
{
  for (int i = 0; i < 3; i++)
    out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2];
}

/* All images of a point that no motion keeps, each joined to each, and of another so that no motion
 * but the group's fits. */
static thr_plan plan_of_group(point_group *g)
{
  static double xyz[MOST][3];
  static int edge[MOST * MOST][2];
  const double first[3] = {0.31, 0.52, 0.79};
  int n = 0, m = 0;
  point_number(xyz, &n, first);
  for (int v = 0; v < n; v++)
    for (int k = 0; k < g->n_generators; k++) {
      double p[3];
      apply(g->generator[k], xyz[v], p);
      point_number(xyz, &n, p);
    }
  g->order = n;
  if (n < 20) { /* so few points may lie in a plane, or have other motions: more orbits */
    const double more[3][3] = {{1.7, -0.4, 0.23}, {-0.6, 1.9, 0.55}, {0.15, -1.2, 1.4}};
    for (int i = 0; i < 3; i++) {
      int from = n;
      point_number(xyz, &n, more[i]);
      for (int v = from; v < n; v++)
        for (int k = 0; k < g->n_generators; k++) {
          double p[3];
          apply(g->generator[k], xyz[v], p);
          point_number(xyz, &n, p);
        }
    }
  }
  static double moved[MOST][3]; /* a framework may lie anywhere */
  for (int v = 0; v < n; v++)
    for (int i = 0; i < 3; i++)
      moved[v][i] = xyz[v][i] + 10 * (i + 1);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < a; b++)
      edge[m][0] = b, edge[m++][1] = a;
  thr_plan p = {.options = options_for(THR_ENDS_ANY, 1)};
  p.frame = frame_make(n, (const double(*)[3])moved, m, (const int(*)[2])edge, NULL, NULL);
  want(&p.options, "overlap,steps");
  p.options.symmetry.geometric = -1;
  p.symmetry = (thr_symmetry_record){
      .present = true, .order = g->order, .n_generators = g->n_generators, .n_images = 1};
  p.symmetry.generator = calloc(MOST * MOST_GENERATORS, sizeof(int));
  p.symmetry.image = calloc(MOST, sizeof(int));
  for (int v = 0; v < n; v++) {
    p.symmetry.image[v] = v;
    for (int k = 0; k < g->n_generators; k++) {
      double to[3];
      int all = n;
      apply(g->generator[k], xyz[v], to);
      p.symmetry.generator[k * n + v] = point_number(xyz, &all, to);
      ck_assert_int_eq(all, n);
    }
  }
  return p;
}

static thr_status name_it(thr_plan *p, const char *name, thr_err *err)
{
  thr_check_elements g = {0};
  memset(p->symmetry.name, 0, sizeof p->symmetry.name);
  memcpy(p->symmetry.name, name, strlen(name));
  *err = (thr_err){0};
  thr_status st = thr_check_group(p, &g, err);
  if (!st) ck_assert_int_eq(g.order, p->symmetry.order);
  ck_assert(!st || !g.image);
  free(g.image);
  return st;
}

/* A plan whose symmetries need not be isometries, without a record of them yet. */
static thr_plan plan_with(thr_frame f, thr_ends ends, int n, thr_cord *cord)
{
  thr_plan p = {.frame = f, .options = options_for(ends, 1), .n_cords = n, .cord = cord};
  want(&p.options, "overlap,steps");
  p.options.symmetry.geometric = -1;
  return p;
}

/* The record holds (word NULL), or the checker says of it in one line what contains word. */
static void assert_symmetry(const thr_plan *p, const char *word)
{
  thr_err err = {0};
  thr_status st = thr_check_symmetry(p, &err);
  ck_assert_msg(st == (word ? THR_EVIOLATED : THR_OK), "%s", err.text);
  if (word) assert_one_line(&err, word);
}

/* A group has its own name and no other's. */
START_TEST(groups_have_one_name)
{
  point_group g = group_number(_i);
  thr_plan p = plan_of_group(&g);
  thr_err err;
  for (int k = 0; k < N_GROUPS; k++) {
    const char *name = group_number(k).name;
    thr_status st = name_it(&p, name, &err);
    ck_assert_msg(st == (k == _i ? THR_OK : THR_EVIOLATED), "%s called %s: %s", g.name, name,
                  err.text);
  }
  static const char *const alias[][2] = {{"C2", "D1"}, {"Cs", "C1v"},  {"Cs", "C1h"},
                                         {"Ci", "S2"}, {"C2v", "D1h"}, {"C2h", "D1d"},
                                         {"D2", "D2"}};
  for (size_t k = 0; k < sizeof alias / sizeof *alias; k++) /* axes of one turn are none */
    ck_assert_int_eq(name_it(&p, alias[k][1], &err),
                     strcmp(g.name, alias[k][0]) == 0 ? THR_OK : THR_EVIOLATED);
  static const char *const nonsense[] = {
      "C",   "C0", "C1x", "Cx", "D",  "D2x", "T1",   "Oi",   "S3",     "S5",     "S4v", "C01",
      "C2d", "S0", "Cv",  "Ds", "Is", "C-2", "C2vv", "D2dd", "C99999", "C1024h", "t",   "Tdd"};
  for (size_t k = 0; k < sizeof nonsense / sizeof *nonsense; k++)
    ck_assert_int_eq(name_it(&p, nonsense[k], &err), THR_EVIOLATED);
  ck_assert_int_eq(name_it(&p, "", &err), THR_OK);
  static const int other[] = {-1, 1};
  for (int k = 0; k < 2; k++) {
    p.symmetry.order += other[k];
    ck_assert_int_eq(name_it(&p, "", &err), THR_EVIOLATED);
    p.symmetry.order -= other[k];
  }
  thr_plan_destroy(&p);
}
END_TEST

/* A bipyramid on a triangle, turned by a third of a turn and mirrored: its tips are back after two,
 * its corners after three, and all after six. */
START_TEST(orders_are_those_of_all_cycles)
{
  double xyz[5][3] = {{0, 0, 1}, {0, 0, -1}};
  int edge[6][2], six[5] = {1, 0, 3, 4, 2}, same[5] = {0, 1, 2, 3, 4};
  for (int i = 0; i < 3; i++) {
    xyz[2 + i][0] = cos(2 * THR_PI * i / 3), xyz[2 + i][1] = sin(2 * THR_PI * i / 3);
    edge[i][0] = 0, edge[3 + i][0] = 1, edge[i][1] = edge[3 + i][1] = 2 + i;
  }
  thr_frame f = frame_make(5, (const double(*)[3])xyz, 6, (const int(*)[2])edge, NULL, NULL);
  for (int v = 0; v < 5; v++)
    f.foot[v] = false;
  thr_plan p = plan_with(f, THR_ENDS_CLOSED, 0, NULL);
  p.symmetry = (thr_symmetry_record){.present = true,
                                     .order = 6,
                                     .n_generators = 1,
                                     .generator = six,
                                     .n_images = 1,
                                     .image = same};
  thr_err err;
  assert_ok(name_it(&p, "C3h", &err), &err);
  ck_assert_int_eq(name_it(&p, "C6", &err), THR_EVIOLATED);
  thr_frame_destroy(&f);
}
END_TEST

/* A square may be turned over or mirrored, which is the same in its plane; but five of its motions
 * are of order 2, not three. */
START_TEST(names_of_flat_frameworks)
{
  static const struct {
    const char *name;
    bool holds;
  } cases[] = {{"C4v", true},  {"D4", true},   {"D2d", true},
               {"C4h", false}, {"D2h", false}, {"C8", false}};
  thr_frame f = ring_make(4);
  int generator[8] = {1, 2, 3, 0, 0, 3, 2, 1}, same[4] = {0, 1, 2, 3};
  for (int v = 0; v < 4; v++)
    f.foot[v] = false;
  thr_plan p = plan_with(f, THR_ENDS_CLOSED, 0, NULL);
  p.symmetry = (thr_symmetry_record){.present = true,
                                     .order = 8,
                                     .n_generators = 2,
                                     .generator = generator,
                                     .n_images = 1,
                                     .image = same};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    thr_err err;
    ck_assert_msg(name_it(&p, cases[k].name, &err) == (cases[k].holds ? THR_OK : THR_EVIOLATED),
                  "%s", cases[k].name);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A ring of n edges and no feet, with one generator: the turn by an edge. */
typedef struct {
  thr_frame f;
  thr_plan p;
  int *next, *same; /* the generator, and the image of a cord that is its own */
} ring;

static ring turned_ring(int n)
{
  ring r = {.f = ring_make(n),
            .next = calloc((size_t)n, sizeof *r.next),
            .same = calloc((size_t)n, sizeof *r.same)};
  ck_assert(r.next && r.same);
  r.p = plan_with(r.f, THR_ENDS_CLOSED, 0, NULL);
  for (int v = 0; v < n; v++) {
    r.f.foot[v] = false;
    r.next[v] = (v + 1) % n;
    r.same[v] = v;
  }
  r.p.symmetry = (thr_symmetry_record){.present = true,
                                       .order = n,
                                       .n_generators = 1,
                                       .generator = r.next,
                                       .n_images = 1,
                                       .image = r.same};
  return r;
}

static void ring_destroy(ring *r)
{
  free(r->next);
  free(r->same);
  thr_frame_destroy(&r->f);
}

/* A ring is turned by each of its edges: so many elements, one less and one more are refused. */
START_TEST(rings_turn_in_as_many_ways_as_they_have_nodes)
{
  for (int n = 480; n < 520; n++) {
    ring r = turned_ring(n);
    for (int off = -1; off <= 1; off++) {
      thr_err err;
      r.p.symmetry.order = n + off;
      ck_assert_msg(name_it(&r.p, "", &err) == (off ? THR_EVIOLATED : THR_OK), "%d, stated %d: %s",
                    n, n + off, err.text);
    }
    ring_destroy(&r);
  }
}
END_TEST

/* At most 1024 elements. */
START_TEST(groups_have_1024_elements_at_most)
{
  for (int n = 1024; n <= 1025; n++) {
    ring r = turned_ring(n);
    thr_err err;
    r.p.options.symmetry.geometric = 0; /* but for rounding */
    thr_status st = name_it(&r.p, "", &err);
    assert_status(st, n > 1024 ? THR_EVIOLATED : THR_OK, &err, "expected 1 to 1024");
    if (n == 1024) ck_assert_int_eq(name_it(&r.p, "C1024", &err), THR_OK);
    ring_destroy(&r);
  }
}
END_TEST

/* The spokes of a star are permuted in 6! ways, whose images of the hub are the same. */
START_TEST(spokes_are_permuted_in_all_ways)
{
  thr_frame f = star_make(6);
  for (int v = 0; v < 7; v++)
    f.foot[v] = false;
  int generator[14] = {0, 2, 1, 3, 4, 5, 6, 0, 2, 3, 4, 5, 6, 1}, same[7] = {0, 1, 2, 3, 4, 5, 6};
  thr_plan p = plan_with(f, THR_ENDS_CLOSED, 0, NULL);
  for (int order = 719; order <= 721; order++) {
    thr_err err;
    p.symmetry = (thr_symmetry_record){.present = true,
                                       .order = order,
                                       .n_generators = 2,
                                       .generator = generator,
                                       .n_images = 1,
                                       .image = same};
    ck_assert_int_eq(name_it(&p, "", &err), order == 720 ? THR_OK : THR_EVIOLATED);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* The first node moved by so much of the framework's size: a name holds up to 5 %, a tolerance of
 * one's own up to that. */
START_TEST(names_are_those_of_isometries)
{
  static const char *const names[] = {"Td", "O", "Oh", "Ih"};
  thr_err err;
  for (int k = 0; k < 4; k++) {
    int i = 0;
    while (strcmp(group_number(i).name, names[k]) != 0)
      i++;
    point_group g = group_number(i);
    thr_plan p = plan_of_group(&g);
    double size = sqrt(0.31 * 0.31 + 0.52 * 0.52 + 0.79 * 0.79), kept = p.frame.xyz[0][2];
    for (double part = 1e-4; part < 1; part *= 1.2) {
      p.frame.xyz[0][2] = kept + part * size;
      if (part < 0.02) ck_assert_int_eq(name_it(&p, names[k], &err), THR_OK);
      if (part > 0.6) ck_assert_int_eq(name_it(&p, names[k], &err), THR_EVIOLATED);
      ck_assert_int_eq(name_it(&p, "", &err), THR_OK);
      p.options.symmetry.geometric = part / 4;
      ck_assert_int_eq(name_it(&p, "", &err), THR_EVIOLATED);
      p.options.symmetry.geometric = 2.5 * part;
      ck_assert_int_eq(name_it(&p, "", &err), THR_OK);
      p.options.symmetry.geometric = -1;
    }
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Names hold up to 5 %, and tolerances of one's own as far as they go, but for rounding: a mirror
 * that a node is moved off. */
START_TEST(limits_of_isometries_are_sharp)
{
  point_group g = group_number(1);
  thr_plan p = plan_of_group(&g);
  double low = 0, high = 10, kept = p.frame.xyz[0][2];
  static const struct {
    double more;
    bool holds;
  } cases[] = {{-1e-9, true}, {0.5e-9, true}, {1.5e-9, false}};
  thr_err err;
  thr_motion m;
  for (int k = 0; k < 3; k++) {
    for (low = 0, high = 10;
         nextafter(low, high) < high;) { /* so far off that the residual is what it should be */
      double middle = (low + high) / 2;
      p.frame.xyz[0][2] = kept + middle;
      thr_procrustes(&p.frame, p.symmetry.generator, &m);
      *(m.residual < THR_ISOMETRY_NEAR + cases[k].more ? &low : &high) = middle;
    }
    ck_assert_int_eq(name_it(&p, "Cs", &err), cases[k].holds ? THR_OK : THR_EVIOLATED);
  }
  static const struct {
    double less;
    bool holds;
  } own[] = {{-1e-9, true}, {1.5e-9, true}, {2.5e-9, false}};
  for (int k = 0; k < 3; k++) {
    p.options.symmetry.geometric = m.farthest - own[k].less;
    ck_assert_int_eq(name_it(&p, "", &err), own[k].holds ? THR_OK : THR_EVIOLATED);
  }
  p.options.symmetry.geometric = 0;
  ck_assert_int_eq(name_it(&p, "", &err), THR_EVIOLATED);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- cords ---- */

enum { CORNERS = 4, MOST_WALK = 24 };

/* A closed walk on the tetrahedron, mostly one that repeats itself or reads the same backward. */
static int random_walk(rng *r, int *walk)
{
  for (;;) {
    int n = 0, part = rng_between(r, 2, 6), times = rng_between(r, 1, 3);
    bool back = rng_below(r, 3) == 0;
    for (int i = 0; i < part; i++)
      walk[n++] = rng_below(r, CORNERS - 1);
    for (int i = part - 2; back && i > 0; i--)
      walk[n++] = walk[i];
    int period = n;
    while (n < times * period)
      walk[n] = walk[n - period], n++;
    bool ok = true;
    for (int i = 0; i < n; i++)
      ok &= walk[i] != walk[(i + 1) % n];
    if (ok) return n;
  }
}

/* Rotations and reversals that read the same. */
static int count_readings(const int *walk, int n)
{
  int count = 0;
  for (int start = 0; start < n; start++)
    for (int back = 0; back < 2; back++) {
      bool same = true;
      for (int i = 0; i < n; i++)
        same &= walk[i] == walk[((back ? start - i : start + i) % n + n) % n];
      count += same;
    }
  return count;
}

static thr_cord cord_of(const thr_frame *f, int number, const int *walk, int n, int first,
                        int start, bool back)
{
  thr_cord c = {
      .closed = true, .component = number, .n_passes = n, .half = calloc((size_t)n, sizeof(int))};
  for (int i = 0; i < n; i++) {
    int a = first + walk[((back ? start - i : start + i) % n + n) % n];
    int b = first + walk[((back ? start - i - 1 : start + i + 1) % n + n) % n];
    int e = thr_frame_edge_between(f, a, b);
    c.half[i] = 2 * e + (f->edge[e][1] == a);
  }
  thr_cord_id(number, c.id);
  return c;
}

/* Two tetrahedra, a cord round each, from anywhere and either way: one is the image of the other
 * when they are exchanged. What is learned is one reading of it. */
START_TEST(copies_may_start_anywhere_and_run_backward)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame one = solid_make(TETRAHEDRON), two = side_by_side(&one, &one);
  int walk[MOST_WALK * 3], n = random_walk(&r, walk), exchange[8], same[16];
  for (int v = 0; v < 8; v++)
    exchange[v] = (v + 4) % 8, same[v] = v, same[8 + v] = exchange[v];
  thr_cord cord[2] = {cord_of(&two, 0, walk, n, 0, rng_below(&r, n), rng_below(&r, 2)),
                      cord_of(&two, 1, walk, n, 4, rng_below(&r, n), rng_below(&r, 2))};
  thr_plan p = plan_with(two, THR_ENDS_CLOSED, 2, cord);
  int unique[2] = {0, 0}, element[2] = {0, 1};
  p.symmetry = (thr_symmetry_record){
      true, 2,    "", 1, exchange, 2, same, unique, element, (double)n / count_readings(walk, n),
      1,    false};
  assert_symmetry(&p, NULL);
  p.symmetry.steps *= 1 + 2e-9;
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  p.symmetry.steps /= 1 + 2e-9;
  p.symmetry.unique_paths = 2;
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  p.symmetry.unique_paths = 1;
  static const int wrong[][2] = {{-1, 1}, {2, 1}, {0, -1}, {0, 2}, {0, 0}, {1, 0}, {1, 1}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong;
       k++) { /* no such cord, no such image, not that image, not a copy */
    unique[1] = wrong[k][0], element[1] = wrong[k][1];
    ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  }
  unique[1] = 0, element[1] = 1;
  element[0] = 1; /* a unique path is its own image 0 */
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  element[0] = 0;
  memcpy(same, exchange, sizeof exchange); /* image 0 is the identity */
  assert_symmetry(&p, "not the identity");
  for (int v = 0; v < 8; v++)
    same[v] = v;
  int other[MOST_WALK * 3], at = rng_below(&r, n); /* the node that no walk comes to */
  memcpy(other, walk, sizeof walk);
  other[at] = CORNERS - 1;
  for (int k = 0; k < 2; k++) {
    thr_cord kept = p.cord[k];
    p.cord[k] = cord_of(&two, k, other, n, 4 * k, rng_below(&r, n), rng_below(&r, 2));
    assert_symmetry(&p, "symmetry");
    free(p.cord[k].half);
    p.cord[k] = kept;
  }
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_OK);
  free(cord[0].half);
  free(cord[1].half);
  thr_frame_destroy(&one);
  thr_frame_destroy(&two);
}
END_TEST

/* Walks that read backward as they do forward at some places, or repeat all but a node, or almost
 * all of a part. */
START_TEST(walks_are_learned_whole)
{
  static const int walk[][12] = {{0, 1, 2, 0, 3},
                                 {0, 1, 3, 0, 2, 1},
                                 {0, 1, 0, 2, 3, 2, 1, 0, 2, 3},
                                 {0, 1, 0, 2, 0, 3, 2, 1, 0, 2, 0, 3},
                                 {0, 1, 2, 3, 0, 1, 2, 3},
                                 {0, 1, 2, 1},
                                 {0, 1, 2, 0, 1, 2, 0, 1, 2, 1}},
                   length[] = {5, 6, 10, 12, 8, 4, 10};
  thr_frame f = solid_make(TETRAHEDRON);
  int same[CORNERS] = {0, 1, 2, 3}, zero = 0;
  for (size_t k = 0; k < sizeof length / sizeof *length; k++)
    for (int start = 0; start < 2 * length[k]; start++) {
      int n = length[k], readings = count_readings(walk[k], n);
      thr_cord cord = cord_of(&f, 0, walk[k], n, 0, start / 2, start % 2);
      thr_plan p = plan_with(f, THR_ENDS_CLOSED, 1, &cord);
      p.symmetry = (thr_symmetry_record){
          true, 1, "", 0, same, 1, same, &zero, &zero, (double)n / readings, 1, false};
      assert_symmetry(&p, NULL);
      free(cord.half);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* One spoke, and that spoke and another: the longer one is no copy of the shorter, nor the other
 * way round. */
START_TEST(copies_are_as_long)
{
  thr_frame f = path_make(3);
  int half[2] = {0, 2}, same[3] = {0, 1, 2}, unique[2] = {0, 0}, which[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    thr_cord cord[2] = {{.id = "A", .n_passes = 1 + k, .half = half},
                        {.id = "B", .n_passes = 2 - k, .half = half}};
    thr_plan p = plan_with(f, THR_ENDS_ANY, 2, cord);
    p.symmetry =
        (thr_symmetry_record){true, 1, "", 0, same, 1, same, unique, which, 1 + k, 1, false};
    assert_symmetry(&p, "cord B is not image 0 of cord A");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Two spokes of a star whose hub has any number: their paths differ in one node, the first or the
 * last of them. */
START_TEST(copies_come_to_the_same_nodes)
{
  static const double xyz[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
  for (int hub = 0; hub < 3; hub++) {
    int edge[2][2] = {{(hub + 1) % 3, hub}, {(hub + 2) % 3, hub}};
    thr_frame f = frame_make(3, xyz, 2, (const int(*)[2])edge, NULL, NULL);
    int half[2] = {0, 2}, same[3] = {0, 1, 2}, unique[2] = {0, 0}, which[2] = {0, 0};
    thr_cord cord[2] = {{.id = "A", .n_passes = 1, .half = half},
                        {.id = "B", .n_passes = 1, .half = half + 1}};
    thr_plan p = plan_with(f, THR_ENDS_ANY, 2, cord);
    p.symmetry = (thr_symmetry_record){true, 1, "", 0, same, 1, same, unique, which, 1, 1, false};
    assert_symmetry(&p, "cord B is not image 0 of cord A");
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A fork whose tines are exchanged: that keeps the nodes of the cord over its handle, and not those
 * of a cord over a tine. */
START_TEST(what_is_kept_is_learned_whole)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {2, -1, 0}};
  static const int edge[3][2] = {{0, 1}, {2, 1}, {3, 1}};
  for (int back = 0; back < 2; back++) {
    thr_frame f = frame_make(4, xyz, 3, edge, NULL, NULL);
    int half[3] = {back, 2 + back, 4 + back}, exchange[4] = {0, 1, 3, 2},
        image[8] = {0, 1, 2, 3, 0, 1, 3, 2};
    int unique[3] = {0, 1, 1}, which[3] = {0, 0, 1};
    thr_cord cord[3];
    for (int i = 0; i < 3; i++) {
      cord[i] = (thr_cord){.n_passes = 1, .half = &half[i]};
      thr_cord_id(i, cord[i].id);
    }
    for (int v = 0; v < 4; v++)
      f.foot[v] = false;
    thr_plan p = plan_with(f, THR_ENDS_ANY, 3, cord);
    p.symmetry =
        (thr_symmetry_record){true, 2, "", 1, exchange, 2, image, unique, which, 6, 2, false};
    assert_symmetry(&p, NULL);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A cord round a triangle is its own image in every turn, but is said to be image 0. Without the
 * cord the group is still judged.
 */
START_TEST(a_unique_path_is_its_own_image_0)
{
  thr_frame f = ring_make(3);
  f.foot[0] = false;
  int walk[3] = {0, 1, 2}, next[3] = {1, 2, 0}, image[6] = {0, 1, 2, 1, 2, 0}, zero = 0;
  thr_cord cord = cord_of(&f, 0, walk, 3, 0, 0, false);
  for (int which = 0; which < 2; which++) {
    thr_plan p = plan_with(f, THR_ENDS_CLOSED, 1, &cord);
    p.symmetry = (thr_symmetry_record){true, 3, "", 1, next, 2, image, &zero, &which, 1, 1, false};
    thr_err err = {0};
    ck_assert_msg(thr_check_symmetry(&p, &err) == (which ? THR_EVIOLATED : THR_OK), "%s", err.text);
    if (which) assert_one_line(&err, "its own image 0");
    p.n_cords = p.symmetry.unique_paths = 0;
    p.symmetry.steps = 0;
    p.symmetry.order = 2;
    assert_symmetry(&p, "symmetry.order");
  }
  free(cord.half);
  thr_frame_destroy(&f);
}
END_TEST

/* One cord over two spokes of a star, of which a half turn makes the other two: it permutes no
 * cords. Either order of nodes. */
START_TEST(cords_are_permuted)
{
  thr_frame f = star_make(4);
  f.foot[1] = false;
  int half_turn[5] = {0, 3, 4, 1, 2}, same[5] = {0, 1, 2, 3, 4}, zero = 0;
  for (int k = 0; k < 2; k++) {
    int half[2] = {k ? 5 : 1, k ? 6 : 2};
    thr_cord cord = {.id = "A", .n_passes = 2, .half = half};
    thr_plan p = plan_with(f, THR_ENDS_ANY, 1, &cord);
    p.symmetry =
        (thr_symmetry_record){true, 2, "", 1, half_turn, 1, same, &zero, &zero, 2, 1, false};
    assert_symmetry(&p, "symmetry.generators[0]: takes");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A cord over each spoke of a star, which a third of a turn permutes: all are copies of the first,
 * and not of each other. */
START_TEST(copies_are_of_unique_paths)
{
  thr_frame f = star_make(3);
  int third_turn[4] = {0, 2, 3, 1}, image[12] = {0, 1, 2, 3, 0, 2, 3, 1, 0, 3, 1, 2},
      half[3] = {0, 2, 4};
  int unique[3] = {0, 0, 0}, which[3] = {0, 1, 2};
  thr_cord cord[3];
  for (int i = 0; i < 3; i++) {
    cord[i] = (thr_cord){.n_passes = 1, .half = &half[i]};
    thr_cord_id(i, cord[i].id);
    f.foot[i + 1] = false;
  }
  thr_plan p = plan_with(f, THR_ENDS_ANY, 3, cord);
  p.symmetry = (thr_symmetry_record){.present = true,
                                     .order = 3,
                                     .n_generators = 1,
                                     .generator = third_turn,
                                     .n_images = 3,
                                     .image = image,
                                     .unique = unique,
                                     .element = which,
                                     .unique_paths = 1,
                                     .steps = 3};
  assert_symmetry(&p, NULL);
  for (int i = 1; i < 3; i++) { /* one that is said to be a unique path, too */
    unique[i] = i, which[i] = 0;
    p.symmetry.unique_paths = 2, p.symmetry.steps = 6;
    assert_symmetry(&p, "is an image of cord A, but said to be one of cord");
    unique[i] = 0, which[i] = i;
    p.symmetry.unique_paths = 1, p.symmetry.steps = 3;
  }
  unique[2] = which[2] = 1; /* image 1 of the second is the third, too */
  assert_symmetry(&p, "which is a copy itself");
  unique[2] = 3;
  assert_symmetry(&p, "there is no such cord or image");
  unique[2] = 0, which[2] = 3;
  assert_symmetry(&p, "there is no such cord or image");
  thr_frame_destroy(&f);
}
END_TEST

/* Round a triangle, and from its first node to its last: the same nodes, but no copy. */
START_TEST(an_open_cord_is_no_copy_of_a_closed_one)
{
  thr_frame f = ring_make(3);
  int half[3], same[3] = {0, 1, 2}, unique[2] = {0, 0}, which[2] = {0, 0};
  for (int k = 0; k < 3; k++) {
    int e = thr_frame_edge_between(&f, k, (k + 1) % 3);
    half[k] = 2 * e + (f.edge[e][1] == k);
  }
  thr_cord cord[2] = {{.id = "A", .closed = true, .n_passes = 3, .half = half},
                      {.id = "B", .n_passes = 2, .half = half}};
  thr_plan p = plan_with(f, THR_ENDS_ANY, 2, cord);
  p.symmetry = (thr_symmetry_record){.present = true,
                                     .order = 1,
                                     .generator = same,
                                     .n_images = 1,
                                     .image = same,
                                     .unique = unique,
                                     .element = which,
                                     .unique_paths = 1,
                                     .steps = 3};
  assert_symmetry(&p, "cord B is not image 0 of cord A");
  unique[1] = 1;
  p.symmetry.unique_paths = 2;
  p.symmetry.steps = 7;
  assert_symmetry(&p, NULL);
  thr_frame_destroy(&f);
}
END_TEST

/* On a star with any hub: no node goes to where another one goes, or to none, by the first
 * generator or the second. */
START_TEST(no_two_nodes_go_to_one)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 3, 0}};
  for (int hub = 0; hub < 4; hub++)
    for (int v = 0; v < 4; v++)
      for (int to = -1; to <= 4; to++) {
        int edge[3][2], generator[12] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}, *bad = generator + 4;
        const bool second = (hub + v) % 2;
        for (int i = 0; i < 3; i++)
          edge[i][0] = hub, edge[i][1] = (hub + 1 + i) % 4;
        thr_frame f = frame_make(4, xyz, 3, (const int(*)[2])edge, NULL, NULL);
        thr_plan p = plan_with(f, THR_ENDS_ANY, 0, NULL);
        for (int k = 0; k < 4; k++)
          f.foot[k] = false;
        bad[v] = to;
        p.symmetry = (thr_symmetry_record){.present = true,
                                           .order = 1 + (to != v),
                                           .n_generators = 2,
                                           .generator = second ? generator : bad,
                                           .n_images = 1,
                                           .image = generator};
        thr_err err;
        ck_assert_int_eq(name_it(&p, "", &err), to == v ? THR_OK : THR_EVIOLATED);
        if (to != v)
          assert_one_line(&err, second ? "generators[1]: not a permutation"
                                       : "generators[0]: not a permutation");
        thr_frame_destroy(&f);
      }
}
END_TEST

/* Turning the numbers of a path takes one of its edges to where there is none, whichever number
 * that edge has. */
START_TEST(every_edge_goes_to_an_edge)
{
  static const double xyz[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  static const int edge[2][2][2] = {{{0, 1}, {1, 2}}, {{1, 2}, {0, 1}}};
  int turned[2][3] = {{2, 0, 1}, {1, 2, 0}}, same[3] = {0, 1, 2};
  for (int k = 0; k < 4; k++) {
    thr_frame f = frame_make(3, xyz, 2, edge[k % 2], NULL, NULL);
    thr_plan p = plan_with(f, THR_ENDS_ANY, 0, NULL);
    for (int v = 0; v < 3; v++)
      f.foot[v] = false;
    p.symmetry = (thr_symmetry_record){.present = true,
                                       .order = 3,
                                       .n_generators = 1,
                                       .generator = turned[k / 2],
                                       .n_images = 1,
                                       .image = same};
    thr_err err;
    assert_status(name_it(&p, "", &err), THR_EVIOLATED, &err, "which no edge joins");
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Out from a foot and back to it: it reads the same backward, but does not run round. */
START_TEST(a_cord_there_and_back_is_learned_both_ways_or_once)
{
  thr_frame f = path_make(3);
  int half[4] = {0, 2, 3, 1}, same[3] = {0, 1, 2}, zero = 0;
  thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  thr_plan p = plan_with(f, THR_ENDS_FEET, 1, &cord);
  p.symmetry = (thr_symmetry_record){true, 1, "", 0, same, 1, same, &zero, &zero, 2, 1, false};
  assert_symmetry(&p, NULL);
  p.symmetry.steps = 4;
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  p.symmetry.retraced = true; /* both ways are learned */
  assert_symmetry(&p, NULL);
  p.symmetry.steps = 2;
  ck_assert_int_eq(thr_check_symmetry(&p, NULL), THR_EVIOLATED);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("checker of symmetry");
  ADD_LOOP(s, 30, groups_have_one_name, 0, N_GROUPS);
  ADD_TEST(s, 30, names_are_those_of_isometries);
  ADD_TEST(s, 10, limits_of_isometries_are_sharp);
  ADD_TEST(s, 10, names_of_flat_frameworks);
  ADD_TEST(s, 10, orders_are_those_of_all_cycles);
  ADD_EXAMPLES(s, 10, copies_may_start_anywhere_and_run_backward, 150);
  ADD_TEST(s, 30, rings_turn_in_as_many_ways_as_they_have_nodes);
  ADD_TEST(s, 30, groups_have_1024_elements_at_most);
  ADD_TEST(s, 10, spokes_are_permuted_in_all_ways);
  ADD_TEST(s, 10, walks_are_learned_whole);
  ADD_TEST(s, 10, copies_are_as_long);
  ADD_TEST(s, 10, copies_come_to_the_same_nodes);
  ADD_TEST(s, 10, what_is_kept_is_learned_whole);
  ADD_TEST(s, 10, a_unique_path_is_its_own_image_0);
  ADD_TEST(s, 10, cords_are_permuted);
  ADD_TEST(s, 10, copies_are_of_unique_paths);
  ADD_TEST(s, 10, no_two_nodes_go_to_one);
  ADD_TEST(s, 10, every_edge_goes_to_an_edge);
  ADD_TEST(s, 10, an_open_cord_is_no_copy_of_a_closed_one);
  ADD_TEST(s, 10, a_cord_there_and_back_is_learned_both_ways_or_once);
  return run_suite(s);
}
