/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Types of copies, darts and turns under a group: known cases, counts that must agree, limits,
 * failing allocations. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>

static thr_group whole_group(const thr_frame *f)
{
  thr_automorphism_options plain = {0};
  thr_automorphisms a;
  thr_group g;
  ck_assert_int_eq(thr_automorphisms_find(f, &plain, &a, NULL), THR_OK);
  ck_assert_int_eq(
      thr_group_generate(f->n_nodes, a.generator, a.n_generators, THR_GROUP_CAP, &g, NULL), THR_OK);
  thr_automorphisms_destroy(&a);
  return g;
}

static int image(const thr_quotient *q, int element, int half)
{
  int i = 0;
  while (q->h->element[i] != element)
    i++;
  return q->half_image[i * 2 * q->f->n_edges + half];
}

static void check_darts(const thr_quotient *q)
{
  for (int d = 0; d < q->n_darts; d++) {
    const thr_dart_type *t = &q->dart[d];
    ck_assert_int_eq(t->darts * t->stabilizer.order, q->h->order);
    ck_assert_int_eq(t->stabilizer.order == 1, t->layer == 0);
    ck_assert_int_lt(t->layer, q->n_layers);
    for (int k = 0; k < t->stabilizer.order; k++)
      ck_assert_int_eq(image(q, t->stabilizer.element[k], t->half), t->half);
    for (int i = 0; i < q->h->order; i++)
      ck_assert_int_ge(image(q, q->h->element[i], t->half), t->half);
  }
}

static void check_copies(const thr_quotient *q)
{
  for (int c = 0; c < q->n_copies; c++) {
    const thr_copy_type *t = &q->copy[c];
    bool turns = false;
    for (int k = 0; k < t->stabilizer.order; k++) {
      int to = image(q, t->stabilizer.element[k], 2 * t->edge);
      ck_assert_int_eq(to >> 1, t->edge);
      turns = turns || to != 2 * t->edge;
    }
    ck_assert(turns == t->fold);
    ck_assert_int_eq(t->copies * t->stabilizer.order, q->h->order);
    ck_assert_int_eq(t->passes * q->orbit_size[t->edge_orbit], t->copies);
    ck_assert_int_eq(t->layer, q->dart[t->dart[0]].layer);
    int darts = q->dart[t->dart[0]].darts;
    ck_assert_int_eq(t->fold ? darts : darts + q->dart[t->dart[1]].darts, 2 * t->copies);
  }
}

static void check_pairs(const thr_quotient *q)
{
  for (int y = 0; y < q->n_pairs; y++) {
    const thr_pair_type *t = &q->pair[y];
    const thr_subgroup *s = &q->dart[t->dart[0]].stabilizer;
    int v = thr_tail(q->f, t->half[0]);
    ck_assert_int_eq(v, thr_tail(q->f, t->half[1]));
    ck_assert_int_eq(t->half[0], q->dart[t->dart[0]].half);
    ck_assert_int_eq(q->dart[t->dart[0]].layer, q->dart[t->dart[1]].layer);
    ck_assert_int_eq(t->turns, q->dart[t->dart[0]].darts / (t->self ? 2 : 1));
    for (int k = 0; k < s->order; k++)
      ck_assert_int_eq(image(q, s->element[k], t->half[1]), t->half[1]);
    ck_assert(t->self == (t->element >= 0));
    if (!t->self) continue;
    ck_assert_int_eq(image(q, t->element, t->half[0]), t->half[1]);
    ck_assert_int_eq(image(q, t->element, t->half[1]), t->half[0]);
    ck_assert(thr_subgroup_has(s, q->group->product[t->element * q->group->order + t->element]));
    ck_assert(!thr_subgroup_has(s, t->element));
  }
}

static thr_quotient quotient_of(const thr_frame *f, const thr_group *g, const thr_subgroup *h)
{
  thr_quotient q;
  ck_assert_int_eq(thr_quotient_init(&q, f, g, h, 100000, NULL), THR_OK);
  check_darts(&q);
  check_copies(&q);
  check_pairs(&q);
  return q;
}

START_TEST(counts_agree_under_all_subgroups)
{
  thr_frame list[] = {solid_make(TETRAHEDRON),  solid_make(CUBE), solid_make(OCTAHEDRON),
                      solid_make(DODECAHEDRON), path_make(5),     star_make(4),
                      grid_make(4, 4),          wheel_make(6)};
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    thr_group g = whole_group(&list[i]);
    thr_subgroup_classes classes;
    ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
    for (int k = 0; k < classes.n; k++) {
      thr_quotient q = quotient_of(&list[i], &g, &classes.subgroup[k]);
      thr_quotient_destroy(&q);
    }
    thr_subgroup_classes_destroy(&classes);
    thr_group_destroy(&g);
    thr_frame_destroy(&list[i]);
  }
}
END_TEST

static thr_subgroup everything(const thr_group *g)
{
  int *all = thr_calloc((size_t)g->order, sizeof *all);
  ck_assert_ptr_nonnull(all);
  for (int a = 0; a < g->order; a++)
    all[a] = a;
  return (thr_subgroup){g->order, all};
}

/* The stabilizer of an edge of the cube is Klein's group: identity, two mirrors, a half turn; the
 * mirror across the edge and the half turn turn it round. So there are five copy types, three of
 * them folds; three at one dart each are of the free layer. */
START_TEST(cube_under_its_whole_group)
{
  thr_frame f = solid_make(CUBE);
  thr_group g = whole_group(&f);
  thr_subgroup h = everything(&g);
  thr_quotient q = quotient_of(&f, &g, &h);
  int folds = 0, free_copies = 0;
  ck_assert_int_eq(q.n_edge_orbits, 1);
  ck_assert_int_eq(q.n_copies, 5);
  for (int c = 0; c < q.n_copies; c++) {
    folds += q.copy[c].fold;
    free_copies += q.copy[c].layer == 0;
  }
  ck_assert_int_eq(folds, 3);
  ck_assert_int_eq(free_copies, 3);
  ck_assert_int_eq(q.n_darts, 2); /* free, or kept by the mirror along the edge */
  ck_assert_int_eq(q.n_layers, 2);
  /* Of the free ones: of two orbits, or within one by the mirror between the edges, and both back
   * into the edge; of the others back into the edge. */
  ck_assert_int_eq(q.n_pairs, 5);
  for (int y = 0; y < q.n_pairs; y++)
    ck_assert_double_eq_tol(q.pair[y].angle,
                            (q.pair[y].half[0] == q.pair[y].half[1] ? 2 : 1) * acos(0), 1e-12);
  thr_quotient_destroy(&q);
  thr_subgroup_destroy(&h);
  thr_group_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

/* Without symmetry: a type per edge and half-edge, a turn for every two edges at a node, and one
 * back into each. */
START_TEST(trivial_group)
{
  thr_frame f = grid_make(5, 4);
  thr_group g = whole_group(&f);
  thr_subgroup h = {1, &(int){0}};
  int turns = 0;
  thr_quotient q = quotient_of(&f, &g, &h);
  for (int v = 0; v < f.n_nodes; v++)
    turns += thr_degree(&f, v) * (thr_degree(&f, v) + 1) / 2;
  ck_assert_int_eq(q.n_copies, f.n_edges);
  ck_assert_int_eq(q.n_darts, 2 * f.n_edges);
  ck_assert_int_eq(q.n_pairs, turns);
  ck_assert_int_eq(q.n_layers, 1);
  thr_quotient_destroy(&q);
  thr_group_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(refusals)
{
  thr_frame f = solid_make(CUBE), other = solid_make(OCTAHEDRON), ring = ring_make(8);
  thr_group g = whole_group(&f), wrong = whole_group(&ring);
  thr_subgroup h = everything(&g), all = everything(&wrong);
  thr_quotient q;
  thr_cover c;
  thr_err err = {0};
  assert_status(thr_quotient_init(&q, &f, &g, &h, 5, &err), THR_ELIMIT, &err, "types");
  ck_assert_ptr_null(q.copy);
  assert_status(thr_quotient_init(&q, &other, &g, &h, 100, &err), THR_EINPUT, &err, "nodes");
  ck_assert_int_eq(thr_quotient_init(&q, &f, &wrong, &all, 100, &err),
                   THR_EINPUT); /* eight nodes too, other edges */
  assert_one_line(&err, "automorphism");

  q = quotient_of(&f, &g, &h);
  bool end_node[8] = {true};
  thr_cover_options o = {
      .cover = 1,
      .ends = THR_ENDS_NODES,
      .end_node = end_node,
      .prefer = {THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING}};
  thr_limits none = {0};
  err = (thr_err){0};
  ck_assert_int_eq(thr_cover_find(&q, &o, &none, &c, &err),
                   THR_EINPUT); /* the group moves the end to another node */
  assert_one_line(&err, "may not");
  o.ends = THR_ENDS_FEET;
  for (int v = 0; v < f.n_nodes; v++)
    f.foot[v] = false;
  err = (thr_err){0};
  assert_status(thr_cover_find(&q, &o, &none, &c, &err), THR_EINFEASIBLE, &err, "component");
  ck_assert_ptr_null(c.copies);
  o.ends = THR_ENDS_CLOSED;
  thr_limits past = {.deadline = thr_clock() - 1};
  o.start_by = thr_clock() + 10;
  assert_status(thr_cover_find(&q, &o, &past, &c, &err), THR_ELIMIT, &err, "time");
  ck_assert_ptr_nonnull(c.copies); /* one that needs no search, with bounds that need none */
  ck_assert(!c.optimal);
  for (int a = 0; a < THR_N_AIMS; a++)
    ck_assert_double_le(c.bound[a], c.value[a]);
  thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
  thr_subgroup_destroy(&h);
  thr_subgroup_destroy(&all);
  thr_group_destroy(&g);
  thr_group_destroy(&wrong);
  thr_frame_destroy(&f);
  thr_frame_destroy(&other);
  thr_frame_destroy(&ring);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  thr_frame f = grid_make(3, 3);
  thr_group g = whole_group(&f);
  thr_subgroup h = everything(&g);
  thr_cover_options o = {
      .cover = 1,
      .ends = THR_ENDS_FEET,
      .prefer = {THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING}};
  thr_limits none = {0};
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_quotient q = {0};
    thr_cover c = {0};
    thr_alloc_fail_at(k);
    st = thr_quotient_init(&q, &f, &g, &h, 1000, NULL);
    if (!st) st = thr_cover_find(&q, &o, &none, &c, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
    if (st) ck_assert_ptr_null(c.copies);
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
  }
  thr_subgroup_destroy(&h);
  thr_group_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("quotient");
  ADD_TEST(s, 60, counts_agree_under_all_subgroups);
  ADD_TEST(s, 10, cube_under_its_whole_group);
  ADD_TEST(s, 10, trivial_group);
  ADD_TEST(s, 10, refusals);
  ADD_TEST(s, 60, every_allocation_fails_once);
  return run_suite(s);
}
