/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans of symmetric threadings: known ones made by hand, what the checker says of every change to
 * them, JSON. */
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 64, MOST_CORDS = 8, MOST_ROWS = 8 };

/* ---- plans by hand ---- */

/* A cord as nodes, ending with -1. */
typedef struct {
  int node[2 * MOST_NODES];
} walk;

/* What a plan is made of: lists of images are of f's nodes. */
typedef struct {
  const char *name;
  thr_frame (*frame)(void);
  thr_ends ends;
  int cover, cords, order, n_cords, n_generators, n_images, unique_paths;
  double steps;
  const char *group;
  walk cord[MOST_CORDS]; /* unique ones; the others are images */
  int unique[MOST_CORDS], element[MOST_CORDS];
  void (*generator)(int k, const thr_frame *f, int *image);
  void (*image)(int k, const thr_frame *f, int *image);
} known;

static thr_cord cord_of(const thr_frame *f, const int *node, const int *image, int number)
{
  thr_cord c = {.half = calloc(2 * MOST_NODES, sizeof *c.half)};
  int *component = calloc((size_t)f->n_nodes, sizeof *component), n;
  ck_assert(c.half && component);
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int i = 0; node[i + 1] >= 0; i++) {
    int e = thr_frame_edge_between(f, image[node[i]], image[node[i + 1]]);
    ck_assert_int_ge(e, 0);
    c.half[c.n_passes++] = 2 * e + (f->edge[e][1] == image[node[i]]);
  }
  thr_cord_id(number, c.id);
  c.closed = thr_cord_start(f, &c) == thr_cord_end(f, &c);
  c.component = component[thr_cord_start(f, &c)];
  free(component);
  return c;
}

static thr_plan plan_known(const known *k)
{
  thr_frame f = k->frame();
  thr_plan p = {0};
  thr_request o = options_for(k->ends, k->cover);
  want(&o, "overlap,steps");
  o.cords = k->cords;
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  thr_symmetry_record *r = &p.symmetry;
  size_t n = (size_t)f.n_nodes;
  *r = (thr_symmetry_record){true,
                             k->order,
                             "",
                             k->n_generators,
                             calloc(MOST_ROWS * n, sizeof(int)),
                             k->n_images,
                             calloc(MOST_ROWS * n, sizeof(int)),
                             calloc(MOST_CORDS, sizeof(int)),
                             calloc(MOST_CORDS, sizeof(int)),
                             k->steps,
                             k->unique_paths,
                             false};
  p.cord = calloc(MOST_CORDS, sizeof *p.cord);
  p.generator = thr_strdup("by hand");
  ck_assert(r->generator && r->image && r->unique && r->element && p.cord && p.generator);
  snprintf(r->name, sizeof r->name, "%s", k->group);
  for (int i = 0; i < k->n_generators; i++)
    k->generator(i, &f, r->generator + (size_t)i * n);
  for (int i = 0; i < k->n_images; i++)
    k->image(i, &f, r->image + (size_t)i * n);
  for (int i = 0; i < k->n_cords; i++) {
    r->unique[i] = k->unique[i];
    r->element[i] = k->element[i];
    p.cord[p.n_cords++] =
        cord_of(&f, k->cord[k->unique[i]].node, r->image + (size_t)k->element[i] * n, i);
  }
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, p.n_cords, &p.metrics, NULL), THR_OK);
  thr_frame_destroy(&f);
  return p;
}

static thr_frame grid6(void)
{
  return grid_make(6, 6);
}
static thr_frame ring8(void)
{
  return no_feet(ring_make(8));
}
static thr_frame path4(void)
{
  return no_feet(path_make(4));
}
static thr_frame triangles2(void)
{
  return triangles_make(2);
}
static thr_frame star4(void)
{
  return no_feet(star_make(4));
}

static void identity(int k, const thr_frame *f, int *image)
{
  (void)k;
  for (int v = 0; v < f->n_nodes; v++)
    image[v] = v;
}

/* k quarter turns of the 6 x 6 grid, node y * 6 + x. */
static void quarter_turns(int k, const thr_frame *f, int *image)
{
  identity(0, f, image);
  for (; k > 0; k--)
    for (int v = 0; v < 36; v++)
      image[v] = image[v] % 6 * 6 + 5 - image[v] / 6;
}
static void quarter_turn(int k, const thr_frame *f, int *image)
{
  quarter_turns(k + 1, f, image);
}

/* A turn by one node, and a mirror. */
static void ring_generator(int k, const thr_frame *f, int *image)
{
  for (int v = 0; v < f->n_nodes; v++)
    image[v] = k == 0 ? (v + 1) % f->n_nodes : (f->n_nodes - v) % f->n_nodes;
}

static void end_for_end(int k, const thr_frame *f, int *image)
{
  (void)k;
  for (int v = 0; v < f->n_nodes; v++)
    image[v] = f->n_nodes - 1 - v;
}

/* Image 1: the other of two triangles. */
static void swapped_halves(int k, const thr_frame *f, int *image)
{
  for (int v = 0; v < f->n_nodes; v++)
    image[v] = k == 0 ? v : (v + f->n_nodes / 2) % f->n_nodes;
}
static void swap_halves(int k, const thr_frame *f, int *image)
{
  swapped_halves(k + 1, f, image);
}

/* Turns of a star with hub 0. */
static void star_turns(int k, const thr_frame *f, int *image)
{
  for (int v = 0; v < f->n_nodes; v++)
    image[v] = v == 0 ? 0 : (v - 1 + k) % (f->n_nodes - 1) + 1;
}
static void star_turn(int k, const thr_frame *f, int *image)
{
  star_turns(k + 1, f, image);
}

/* Nodes 2 and 3 of a star change places. */
static void swap_tips(int k, const thr_frame *f, int *image)
{
  identity(k, f, image);
  image[2] = 3, image[3] = 2;
}

static void swap_crossbar(int k, const thr_frame *f, int *image)
{
  identity(k, f, image);
  image[3] = 4, image[4] = 3;
}

static const known plans[] = {
    /* MATHS: 6 x 6, corner feet, C4: 1 x 4, 17 learned steps */
    {"dome C4",
     grid6,
     THR_ENDS_FEET,
     1,
     4,
     4,
     4,
     1,
     4,
     1,
     17,
     "C4",
     {{{0, 1, 2, 3, 4, 10, 9, 8, 2, 1, 7, 8, 14, 15, 9, 3, 4, 5, -1}}},
     {0},
     {0, 1, 2, 3},
     quarter_turn,
     quarter_turns},
    /* turned into itself by 8 turns, and reversed: half a step */
    {"ring D8",
     ring8,
     THR_ENDS_CLOSED,
     1,
     1,
     16,
     1,
     2,
     1,
     1,
     0.5,
     "D8",
     {{{2, 3, 4, 5, 6, 7, 0, 1, 2, -1}}},
     {0},
     {0},
     ring_generator,
     identity},
    /* three passes and two ends, by half */
    {"folded path",
     path4,
     THR_ENDS_ANY,
     1,
     1,
     2,
     1,
     1,
     1,
     1,
     2.5,
     "C2",
     {{{0, 1, 2, 3, -1}}},
     {0},
     {0},
     end_for_end,
     identity},
    /* one cord in each of two pieces */
    {"two triangles",
     triangles2,
     THR_ENDS_CLOSED,
     1,
     1,
     2,
     2,
     1,
     2,
     1,
     3,
     "",
     {{{0, 1, 2, 0, -1}}},
     {0, 0},
     {0, 1},
     swap_halves,
     swapped_halves},
    /* two cords that run alike: one is a copy by the identity; nothing else maps cords to cords */
    {"twice round",
     ring8,
     THR_ENDS_CLOSED,
     2,
     2,
     1,
     2,
     0,
     1,
     1,
     8,
     "C1",
     {{{0, 1, 2, 3, 4, 5, 6, 7, 0, -1}}},
     {0, 0},
     {0, 0},
     identity,
     identity},
    /* a spoke there and back is its own reverse under the identity: one step */
    {"star",
     star4,
     THR_ENDS_CLOSED,
     2,
     4,
     4,
     4,
     1,
     4,
     1,
     1,
     "C4",
     {{{0, 1, 0, -1}}},
     {0},
     {0, 1, 2, 3},
     star_turn,
     star_turns},
    /* a cord that goes round twice: what it repeats is learned once */
    {"one cord twice round",
     ring8,
     THR_ENDS_CLOSED,
     2,
     1,
     1,
     1,
     0,
     1,
     1,
     8,
     "C1",
     {{{0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7, 0, -1}}},
     {0},
     {0},
     identity,
     identity},
    /* two unique paths, each from the hub and mapped to the other by nothing: the trivial group */
    {"two halves of a star",
     star4,
     THR_ENDS_ANY,
     1,
     2,
     1,
     2,
     0,
     1,
     2,
     8,
     "C1",
     {{{1, 0, 2, -1}}, {{3, 0, 4, -1}}},
     {0, 1},
     {0, 0},
     identity,
     identity},
    /* a mirror keeps every node of the first cord, and turns the second round: only of that are the
       steps halved */
    {"bar and crossbar",
     star4,
     THR_ENDS_ANY,
     1,
     2,
     2,
     2,
     1,
     1,
     2,
     6,
     "",
     {{{1, 0, 2, -1}}, {{3, 0, 4, -1}}},
     {0, 1},
     {0, 0},
     swap_crossbar,
     identity},
    /* two cords in one piece, one in the other */
    {"two and one",
     triangles2,
     THR_ENDS_ANY,
     1,
     2,
     1,
     3,
     0,
     1,
     2,
     6,
     "C1",
     {{{0, 1, 2, 0, -1}}, {{0}}, {{3, 4, 5, 3, -1}}},
     {0, 0, 2},
     {0, 0, 0},
     identity,
     identity},
};
enum { N_PLANS = sizeof plans / sizeof *plans };

START_TEST(known_plans_are_sound)
{
  thr_plan p = plan_known(&plans[_i]);
  assert_plan_sound(&p);
  thr_text t = plan_text(&p);
  thr_plan q = plan_from(t.data);
  size_t row = (size_t)p.frame.n_nodes * sizeof(int), cords = (size_t)p.n_cords * sizeof(int);
  const thr_symmetry_record *a = &p.symmetry, *b = &q.symmetry;
  ck_assert(b->present && b->order == a->order && strcmp(b->name, a->name) == 0 &&
            b->steps == a->steps);
  ck_assert(b->n_generators == a->n_generators && b->n_images == a->n_images &&
            b->unique_paths == a->unique_paths);
  ck_assert(memcmp(b->generator, a->generator, (size_t)a->n_generators * row) == 0);
  ck_assert(memcmp(b->image, a->image, (size_t)a->n_images * row) == 0);
  ck_assert(memcmp(b->unique, a->unique, cords) == 0 && memcmp(b->element, a->element, cords) == 0);
  ck_assert(thr_wants_symmetry(&q.options) && q.options.symmetry.geometric < 0 &&
            !q.options.symmetry.group[0]);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
}
END_TEST

START_TEST(dome_has_the_published_numbers)
{
  thr_plan p = plan_known(&plans[0]);
  ck_assert_int_eq(p.metrics.passes, 68);
  ck_assert_double_eq(p.metrics.overlap, 8); /* of 60: two orbits of four edges again */
  ck_assert_int_eq(p.metrics.u_turns, 0);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(options_survive_json)
{
  thr_plan p = plan_known(&plans[0]);
  thr_symmetry_options *o = &p.options.symmetry;
  memcpy(o->group, "C4 \"x\" \xc3\xa4", 10);
  o->geometric = 1.0 / 3;
  for (int i = 0; i < THR_N_AIMS; i++)
    p.options.aims.aim[i] = (thr_aim)(THR_N_AIMS - 1 - i);
  thr_text t = plan_text(&p);
  thr_plan q = plan_from(t.data);
  ck_assert_str_eq(q.options.symmetry.group, o->group);
  ck_assert(q.options.symmetry.geometric == o->geometric);
  ck_assert(memcmp(&q.options.aims, &p.options.aims, sizeof p.options.aims) == 0);
  memcpy(o->group, "C4", 3);
  assert_plan_sound(&p);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
}
END_TEST

/* ---- changes ---- */

static void assert_seen(const thr_plan *p, const char *what, const char *word)
{
  thr_err err = {0};
  thr_status st = thr_check_plan(p, &err);
  ck_assert_msg(st == THR_EVIOLATED, "%s: status %d, %s", what, (int)st, err.text);
  assert_one_line(&err, word);
}

/* Every number of the record changed to every other in its range, one past it included: refused,
 * unless the cord that it is about is as good a copy by another image (a closed one which the group
 * turns in itself). */
static void change_each(thr_plan *p, int *value, int n, int low, int high, const char *what)
{
  for (int i = 0; i < n; i++)
    for (int other = low; other <= high; other++) {
      int kept = value[i];
      if (other == kept) continue;
      value[i] = other;
      assert_seen(p, what, "symmetry.");
      value[i] = kept;
    }
}

START_TEST(every_changed_number_is_refused)
{
  thr_plan p = plan_known(&plans[_i]);
  thr_symmetry_record *r = &p.symmetry;
  int n = p.frame.n_nodes;
  change_each(&p, &r->order, 1, -1, 40, "order");
  change_each(&p, &r->unique_paths, 1, -1, 40, "unique_paths");
  change_each(&p, r->generator, r->n_generators * n, -1, n, "generators");
  change_each(&p, r->image, r->n_images * n, -1, n, "images");
  change_each(&p, r->unique, p.n_cords, -1, p.n_cords, "of");
  change_each(&p, r->element, p.n_cords, -1, r->n_images, "image");
  const double wrong[] = {0, -1, r->steps + 1, r->steps / 2, NAN, INFINITY};
  double kept = r->steps;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    r->steps = wrong[i];
    assert_seen(&p, "steps", "symmetry.steps");
  }
  r->steps = kept;
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* Of the names of order 4 those of groups with other elements, too: C2v, C2h, D2 and the like have
 * no element of order 4. */
START_TEST(every_other_name_of_a_group_is_refused)
{
  static const char *const alike[] = {"C4", "S4", ""};
  static const char *const others[] = {
      "C2v", "C2h", "D2",  "D1h", "D1d", "C1",  "Cs",          "Ci",  "C3", "C8",
      "C4v", "D4",  "D2d", "T",   "Td",  "Th",  "O",           "Oh",  "I",  "Ih",
      "X4",  "C",   "C04", "C4 ", "C4x", "C+4", "c4",          "S4v", "4",  "C4vv",
      "S3",  "D",   "Tv",  "C-4", "C 4", "D0d", "C99999999999"};
  thr_plan p = plan_known(&plans[0]);
  for (size_t i = 0; i < sizeof alike / sizeof *alike; i++) {
    snprintf(p.symmetry.name, sizeof p.symmetry.name, "%s", alike[i]);
    assert_plan_sound(&p);
  }
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    snprintf(p.symmetry.name, sizeof p.symmetry.name, "%s", others[i]);
    assert_seen(&p, others[i], "symmetry.name");
  }
  thr_plan_destroy(&p);
}
END_TEST

/* Automorphisms that are not the plan's. */
/* A group that was asked for by its name is that of the plan; a row's number says nothing. */
START_TEST(group_that_was_asked_for)
{
  thr_plan p = plan_known(&plans[0]);
  const char *said[] = {"", "3", "C4"}, *others[] = {"C2v", "Q"};
  for (int i = 0; i < 3; i++) {
    snprintf(p.options.symmetry.group, sizeof p.options.symmetry.group, "%s", said[i]);
    assert_plan_sound(&p);
  }
  for (int i = 0; i < 2; i++) {
    snprintf(p.options.symmetry.group, sizeof p.options.symmetry.group, "%s", others[i]);
    assert_seen(&p, others[i], "options.symmetry.group");
  }
  thr_plan_destroy(&p);
}
END_TEST

static void warp(thr_plan *p, double by)
{
  p->frame.xyz[0][2] += by;
  ck_assert(!thr_plan_measure(&p->frame, &p->options, p->cord, p->n_cords, &p->metrics, NULL));
}

/* A point group's name claims isometries, roughly; --geometric claims them within its tolerance. An
 * automorphism of the graph alone may claim neither. */
START_TEST(names_and_tolerances_claim_isometries)
{
  static const double by[] = {0, 1e-3, 1e2};
  for (int i = 0; i < 3; i++) {
    thr_plan p = plan_known(&plans[0]);
    warp(&p, by[i]);
    if (i < 2)
      ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    else
      assert_seen(&p, "far", "no isometry");
    p.symmetry.name[0] = '\0';
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    p.options.symmetry.geometric = 1e-6;
    if (i == 0)
      ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    else
      assert_seen(&p, "near", "options.symmetry.geometric");
    thr_plan_destroy(&p);
  }
}
END_TEST

START_TEST(other_automorphisms_are_refused)
{
  thr_plan p = plan_known(&plans[0]);
  thr_symmetry_record *r = &p.symmetry;
  int *generator = r->generator, mirror[36], turn[36], half[36];
  for (int v = 0; v < 36; v++)
    mirror[v] = v / 6 * 6 + 5 - v % 6;
  quarter_turns(1, &p.frame, turn);
  quarter_turns(2, &p.frame, half);
  memcpy(generator, mirror, sizeof mirror); /* makes two elements */
  assert_seen(&p, "mirror", "symmetry.order: stated 4, but the generators make only 2");
  r->order = 2;
  assert_seen(&p, "mirror", "symmetry.images[1]: not an element");
  r->n_images = 1;
  r->name[0] = '\0';
  assert_seen(&p, "mirror", "symmetry.generators[0]: takes");
  r->n_images = 4;
  r->order = 4;
  memcpy(generator, half, sizeof half); /* half the group */
  assert_seen(&p, "half turn", "only 2 elements");
  r->order = 2;
  assert_seen(&p, "half turn", "symmetry.images[1]");
  r->order = 4;
  memcpy(generator, turn, sizeof turn);
  r->n_generators = 2; /* one more that is of no use, then one that is of another group */
  memcpy(generator + 36, half, sizeof half);
  assert_plan_sound(&p);
  memcpy(generator + 36, mirror, sizeof mirror);
  assert_seen(&p, "both", "more elements");
  r->order = 8;
  assert_seen(&p, "both", "symmetry.generators[1]: takes");
  thr_plan_destroy(&p);
}
END_TEST

/* Permutations that are none of the framework, and one that is, but takes cord A to where no cord
 * runs. */
START_TEST(other_permutations_are_refused)
{
  thr_plan p = plan_known(&plans[0]);
  int *generator = p.symmetry.generator, kept[36];
  memcpy(kept, generator, sizeof kept);
  for (int a = 0; a < 36; a++)
    for (int b = a + 1; b < 36; b++) {
      generator[a] = kept[b], generator[b] = kept[a];
      assert_seen(&p, "swapped", "symmetry.generators[0]: takes");
      generator[a] = kept[a], generator[b] = kept[b];
    }
  thr_plan_destroy(&p);
  known k = {"",
             star4,
             THR_ENDS_ANY,
             1,
             2,
             2,
             2,
             1,
             1,
             2,
             4,
             "",
             {{{1, 0, 3, -1}}, {{2, 0, 4, -1}}},
             {0, 1},
             {0, 0},
             swap_tips,
             identity};
  p = plan_known(&k);
  assert_seen(&p, "star", "symmetry.generators[0]: takes cord A to a path");
  thr_plan_destroy(&p);
}
END_TEST

/* A group that does less than it could: then copies are unique paths, and said so. */
START_TEST(smaller_group_has_more_unique_paths)
{
  thr_plan p = plan_known(&plans[0]);
  thr_symmetry_record *r = &p.symmetry;
  quarter_turns(2, &p.frame, r->generator);
  quarter_turns(2, &p.frame, r->image + 36);
  r->order = r->n_images = 2;
  r->name[0] = '\0';
  int unique[] = {0, 1, 0, 1}, element[] = {0, 0, 1, 1};
  memcpy(r->unique, unique, sizeof unique);
  memcpy(r->element, element, sizeof element);
  r->unique_paths = 2;
  r->steps = 34;
  assert_plan_sound(&p);
  int all[] = {0, 1, 2, 3},
      none[] = {0, 0, 0, 0}; /* "all are unique", when the half turn says otherwise */
  memcpy(r->unique, all, sizeof all);
  memcpy(r->element, none, sizeof none);
  r->unique_paths = 4;
  r->steps = 68;
  assert_seen(&p, "all unique", "is an image of cord");
  thr_plan_destroy(&p);
}
END_TEST

/* The same threading, said differently: a cord from its other end, a closed one from another node.
 */
START_TEST(direction_and_start_do_not_matter)
{
  thr_plan p = plan_known(&plans[0]);
  thr_cord *c = &p.cord[2];
  for (int i = 0, j = c->n_passes - 1; i <= j; i++, j--) {
    int h = c->half[i];
    c->half[i] = c->half[j] ^ 1;
    c->half[j] = h ^ 1;
  }
  assert_plan_sound(&p);
  c->half[0] ^= 1; /* no walk any more */
  assert_seen(&p, "walk", "cord C");
  thr_plan_destroy(&p);
  p = plan_known(&plans[3]);
  c = &p.cord[1];
  int first = c->half[0];
  c->half[0] = c->half[1], c->half[1] = c->half[2], c->half[2] = first;
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* Where ends are at chosen nodes the group maps ends to ends; where they may be anywhere a cord may
 * come out at another node. */
START_TEST(start_matters_where_ends_are_chosen)
{
  for (int chosen = 0; chosen < 2; chosen++) {
    thr_plan p = plan_known(&plans[3]);
    thr_cord *c = &p.cord[1];
    p.options.ends = chosen ? THR_ENDS_NODES : THR_ENDS_ANY;
    if (chosen) p.options.end_node = calloc((size_t)p.frame.n_nodes, sizeof *p.options.end_node);
    for (int v = 0; chosen && v < p.frame.n_nodes; v++)
      p.options.end_node[v] = true;
    ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                     THR_OK);
    assert_plan_sound(&p);
    int first = c->half[0];
    c->half[0] = c->half[1], c->half[1] = c->half[2], c->half[2] = first;
    if (chosen)
      assert_seen(&p, "start", "symmetry.generators[0]");
    else
      assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Feet and nodes where ends are allowed belong to the framework's colours. */
START_TEST(feet_and_end_nodes_are_kept)
{
  thr_plan p = plan_known(&plans[0]);
  p.frame.foot[14] = true; /* in the middle, and the turn takes it to 15, which is none */
  assert_seen(&p, "foot", "is a foot");
  p.frame.foot[14] = false;
  p.options.ends = THR_ENDS_NODES;
  p.options.end_node = calloc(36, sizeof *p.options.end_node);
  ck_assert(p.options.end_node != NULL);
  p.options.end_node[0] = p.options.end_node[5] = p.options.end_node[30] = p.options.end_node[35] =
      true;
  assert_plan_sound(&p);
  p.options.end_node[14] = true;
  assert_seen(&p, "end node", "a cord may end at only one");
  thr_plan_destroy(&p);
}
END_TEST

/* options.cords is the number in the component that has most. */
START_TEST(cords_are_counted)
{
  for (int i = 0; i < N_PLANS; i++) {
    thr_plan p = plan_known(&plans[i]);
    p.options.cords++;
    assert_seen(&p, plans[i].name, "the plan's options say");
    p.options.cords -= 2;
    assert_seen(&p, plans[i].name, "the plan's options say");
    thr_plan_destroy(&p);
  }
}
END_TEST

/* The unconstrained bound for at most so many cords in every component. */
START_TEST(length_proof_bounds_the_plan)
{
  thr_plan p = plan_known(&plans[_i]);
  thr_limits none = {0};
  thr_shortest shortest;
  thr_err err = {0};
  assert_ok(thr_postman_shortest(&p.frame, &p.options, &none, &shortest, &err), &err);
  assert_ok(thr_postman_prove(&p.frame, &p.options, p.cord, p.n_cords, &shortest, &p.proof, &err),
            &err);
  thr_shortest_destroy(&shortest);
  assert_plan_sound(&p);
  ck_assert(p.proof.present && p.proof.lower_bound <= p.metrics.length);
  if (_i == 0)
    ck_assert(p.proof.optimal &&
              p.proof.lower_bound == 68); /* 16 odd nodes in neighbouring pairs, the feet apart */
  thr_plan_destroy(&p);
}
END_TEST

/* ---- JSON ---- */

static char *replaced(const char *text, const char *mark, const char *from, const char *to)
{
  const char *place = strstr(text, mark);
  const char *found = place ? strstr(place, from) : NULL;
  ck_assert_msg(found != NULL, "%s %s", mark, from);
  size_t head = (size_t)(found - text);
  char *out = calloc(strlen(text) + strlen(to) + 1, 1);
  ck_assert(out != NULL);
  memcpy(out, text, head);
  strcpy(out + head, to);
  strcat(out, found + strlen(from));
  return out;
}

START_TEST(nonsense_is_refused_with_its_place)
{
  static const struct {
    const char *mark, *from, *to;
    thr_status status;
    const char *word;
  } wrong[] = {
      {"options", "\"symmetry\": {", "\"symmetries\": {", THR_EVIOLATED, "options.symmetries"},
      {"options", "\"objective\": \"symmetry\"", "\"objective\": \"length\"", THR_EVIOLATED,
       "options.symmetry"},
      {"options", "\"objective\": \"symmetry\"", "\"objective\": \"tortuosity\"", THR_EVIOLATED,
       "options.symmetry"},
      {"options", "\"group\": null, ", "", THR_EINPUT, "group"},
      {"options", "\"group\": null", "\"group\": \"\"", THR_EINPUT, "group"},
      {"options", "\"group\": null", "\"group\": 4", THR_EINPUT, "group"},
      {"options", "\"group\": null", "\"group\": \"0123456789abcdef\"", THR_EINPUT, "group"},
      {"options", "\"geometric\": null", "\"geometric\": -1", THR_EINPUT, "geometric"},
      {"options", "\"geometric\": null", "\"geometric\": \"x\"", THR_EINPUT, "geometric"},
      {"options", "\"steps\"", "\"leaps\"", THR_EINPUT, "prefer"},
      {"options", "\"steps\"", "\"overlap\"", THR_EINPUT, "prefer"},
      {"options", ", \"turning\"]", "]", THR_EINPUT, "prefer"},
      {"options", "\"turning\"]", "\"turning\"], \"more\": 1", THR_EVIOLATED, "more"},
      {"cords", "\"symmetry\": {\"order\"", "\"other\": {\"order\"", THR_EVIOLATED,
       "symmetry: missing"},
      {"\"order\"", "\"order\": 4", "\"order\": 0", THR_EVIOLATED, "order"},
      {"\"order\"", "\"order\": 4", "\"order\": 1025", THR_EVIOLATED, "order"},
      {"\"order\"", "\"order\": 4", "\"order\": 4.5", THR_EVIOLATED, "order"},
      {"\"order\"", "\"order\": 4", "\"more\": 1, \"order\": 4", THR_EVIOLATED, "symmetry.more"},
      {"\"order\"", "\"name\": \"C4\"", "\"name\": 4", THR_EVIOLATED, "name"},
      {"\"order\"", "\"name\": \"C4\"", "\"name\": \"0123456789abcdef\"", THR_EVIOLATED, "name"},
      {"\"order\"", "\"generators\"", "\"workers\"", THR_EVIOLATED, "workers"},
      {"\"generators\"", "[5,", "[5,5,", THR_EVIOLATED, "symmetry.generators[0]"},
      {"\"generators\"", "[5,", "[", THR_EVIOLATED, "symmetry.generators[0]"},
      {"\"generators\"", "[5,", "[36,", THR_EVIOLATED, "symmetry.generators[0][0]"},
      {"\"generators\"", "[5,", "[-1,", THR_EVIOLATED, "symmetry.generators[0][0]"},
      {"\"generators\"", "[5,", "[4,", THR_EVIOLATED, "symmetry.generators[0]"},
      {"\"images\"", "[5,", "[1e9,", THR_EVIOLATED, "symmetry.images[1][0]"},
      {"\"images\"", "[0,", "[null,", THR_EVIOLATED, "symmetry.images[0][0]"},
      {"\"images\"", "\"of\": 0", "\"of\": 4", THR_EVIOLATED, "of"},
      {"\"images\"", "\"of\": 0", "\"off\": 0", THR_EVIOLATED, "off"},
      {"\"images\"", "\"image\": 1", "\"image\": 4", THR_EVIOLATED, "image"},
      {"\"images\"", "\"image\": 1", "\"image\": 2", THR_EVIOLATED, "symmetry.cords[1]"},
      {"\"images\"", "{\"of\": 0, \"image\": 0}, ", "", THR_EVIOLATED, "symmetry.cords"},
      {"\"unique_paths\"", "\"unique_paths\": 1", "\"unique_paths\": 5", THR_EVIOLATED,
       "unique_paths"},
      {"\"images\"", "\"steps\": 17", "\"steps\": 16", THR_EVIOLATED, "symmetry.steps"},
      {"\"images\"", "\"steps\": 17", "\"steps\": null", THR_EVIOLATED, "steps"},
  };
  thr_plan p = plan_known(&plans[0]);
  thr_text t = plan_text(&p);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_err err = {0};
    char *text = replaced(t.data, wrong[i].mark, wrong[i].from, wrong[i].to);
    ck_assert_msg(judge_text(text, strlen(text), &err) == wrong[i].status, "%s: status %d, %s",
                  wrong[i].to, (int)err.code, err.text);
    assert_one_line(&err, wrong[i].word);
    free(text);
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(record_goes_with_its_objective)
{
  thr_frame f = path_make(4);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_text t = plan_text(&p);
  thr_err err = {0};
  char *text = replaced(t.data, "\"metrics\"", "\"metrics\"", "\"symmetry\": {}, \"metrics\"");
  assert_status(judge_text(text, strlen(text), &err), THR_EVIOLATED, &err, "symmetry");
  free(text);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_failed_allocation_is_reported)
{
  thr_plan p = plan_known(&plans[_i]);
  thr_text t = plan_text(&p);
  bool done = false;
  for (long k = 1; !done; k++) {
    thr_plan q;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = thr_plan_parse(&q, t.data, t.length, "plan", &err);
    if (!st) st = thr_check_plan(&q, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st,
                  err.text);
    ck_assert(q.cord || (!q.symmetry.generator && !q.symmetry.unique));
    done = st == THR_OK;
    thr_plan_destroy(&q);
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("symmetry_plan");
  ADD_LOOP(s, 10, known_plans_are_sound, 0, N_PLANS);
  ADD_TEST(s, 10, dome_has_the_published_numbers);
  ADD_TEST(s, 10, options_survive_json);
  ADD_LOOP(s, 20, every_changed_number_is_refused, 0, N_PLANS);
  ADD_TEST(s, 10, every_other_name_of_a_group_is_refused);
  ADD_TEST(s, 10, group_that_was_asked_for);
  ADD_TEST(s, 10, names_and_tolerances_claim_isometries);
  ADD_TEST(s, 10, other_automorphisms_are_refused);
  ADD_TEST(s, 10, other_permutations_are_refused);
  ADD_TEST(s, 10, smaller_group_has_more_unique_paths);
  ADD_TEST(s, 10, direction_and_start_do_not_matter);
  ADD_TEST(s, 10, start_matters_where_ends_are_chosen);
  ADD_TEST(s, 10, feet_and_end_nodes_are_kept);
  ADD_TEST(s, 10, cords_are_counted);
  ADD_LOOP(s, 10, length_proof_bounds_the_plan, 0, N_PLANS);
  ADD_TEST(s, 10, nonsense_is_refused_with_its_place);
  ADD_TEST(s, 10, record_goes_with_its_objective);
  ADD_LOOP(s, 20, every_failed_allocation_is_reported, 0, N_PLANS);
  return run_suite(s);
}
