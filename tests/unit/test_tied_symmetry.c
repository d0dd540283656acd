/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric threadings that tie tube joints: published lengths, the search without symmetry, the
 * checker. That they are the best under every group of small frameworks is shown in
 * tests/property/test_cover.c. */
#include "graph/check/check.h"
#include "graph/plan/plan_measures.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"
#include "tortuosity/tie/tie.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static thr_request tied(thr_ends ends)
{
  thr_request o = options_for(ends, 1);
  want(&o, "overlap,steps");
  o.joint = THR_JOINT_TUBE;
  return o;
}

static thr_symmetries table_of(const thr_frame *f, const thr_request *o, double seconds)
{
  thr_symmetries t;
  thr_err err = {0};
  const thr_limits limits = {.deadline = thr_clock() + seconds};
  thr_status st = thr_symmetries_find(f, o, false, &limits, &t, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  return t;
}

/* Every row with cords makes a plan that the checker accepts, in as many passes as ties need, and
 * with no less than its bounds.
 */
static int check_rows(const thr_frame *f, const thr_request *o, thr_symmetries *t)
{
  int made = 0;
  for (int i = 0; i < t->n; i++) {
    thr_plan p;
    thr_err err = {0};
    if (t->row[i].n_cords == 0) continue;
    for (int a = 0; a < THR_N_AIMS; a++)
      ck_assert_double_le(t->row[i].bound[a], t->row[i].value[a] + 1e-6 * (1 + t->row[i].value[a]));
    thr_status st = thr_symmetries_plan(t, i, f, o, &(thr_limits){0}, &p, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
    err = (thr_err){0};
    ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "row %d: %s", i + 1, err.text);
    ck_assert(p.symmetry.present && !p.proof.present);
    int ends = o->ends == THR_ENDS_CLOSED ? 0 : 2 * p.n_cords;
    ck_assert_int_ge(2 * p.metrics.passes - ends, 2 * (2 * f->n_edges - f->n_nodes));
    made++;
    thr_plan_destroy(&p);
  }
  return made;
}

/* Demaine, Kirkpatrick & Lin 2024: passes of the best threading of solids with edges of length 1,
 * closed. */
START_TEST(published_lengths)
{
  static const struct {
    solid s;
    double passes;
  } known[] = {{TETRAHEDRON, 8}, {CUBE, 16}, {OCTAHEDRON, 18}, {DODECAHEDRON, 40}};
  thr_frame f = no_feet(solid_make(known[_i].s));
  thr_request o = tied(THR_ENDS_CLOSED);
  thr_symmetries t = table_of(&f, &o, 20);
  ck_assert_double_eq_tol(t.shortest, known[_i].passes, 1e-6);
  ck_assert(t.shortest_optimal);
  const thr_symmetry_row *trivial = &t.row[t.n - 1];
  ck_assert_int_eq(trivial->order, 1);
  ck_assert_double_eq_tol(trivial->metrics.length, known[_i].passes, 1e-6);
  ck_assert_double_eq_tol(trivial->bound[THR_AIM_OVERLAP], known[_i].passes - f.n_edges, 1e-5);
  for (int i = 0; i < t.n; i++)
    ck_assert_double_ge(t.row[i].metrics.length, known[_i].passes - 1e-6);
  ck_assert_int_eq(check_rows(&f, &o, &t), t.n);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

/* All ends, on frameworks with symmetric feet. */
START_TEST(plans_pass_the_checker)
{
  static const struct {
    thr_shape shape;
    int size, rings;
  } made[] = {{THR_MAKE_DOME, 3, 0},
              {THR_MAKE_DOME, 4, 0},
              {THR_MAKE_TUBE, 3, 2},
              {THR_MAKE_TUBE, 4, 3},
              {THR_MAKE_GEODESIC, 2, 0}};
  thr_frame f = shape_make(made[_i].shape, made[_i].size, made[_i].rings);
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    thr_request o = tied((thr_ends)ends);
    thr_symmetries t = table_of(&f, &o, 6);
    ck_assert_int_ge(check_rows(&f, &o, &t), t.n / 2);
    ck_assert_int_ge(t.chosen, 0);
    thr_symmetries_destroy(&t);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* What the shortest cords need without symmetry, by the search for tube joints, which shares no
 * code with this one. */
START_TEST(shortest_is_that_of_the_other_search)
{
  rng r = rng_make(5 + (unsigned)_i);
  int compared = 0;
  for (int run = 0; run < 12; run++) {
    thr_frame f = random_frame(&r, rng_between(&r, 5, 9), rng_between(&r, 4, 9),
                               (length_kind)(run % LENGTH_KINDS));
    thr_request o = tied(run % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED);
    const thr_limits limits = {.deadline = thr_clock() + 10};
    thr_tube best;
    thr_symmetries t;
    o.symmetry.group[0] = '1';
    thr_status found = thr_symmetries_find(&f, &o, false, &limits, &t, NULL),
               st = thr_tube_shortest(&f, &o, &limits, &best, NULL);
    if (!st && t.n > 0 && t.shortest_optimal) {
      ck_assert_double_eq_tol(t.shortest, best.length, 1e-6 * best.length);
      compared++;
    }
    ck_assert(found != THR_OK || t.row[0].metrics.length >= thr_frame_total_length(&f) - 1e-9);
    thr_tube_destroy(&best);
    thr_symmetries_destroy(&t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(compared, 4);
}
END_TEST

static thr_cord round_from(const thr_frame *f, int start, const char *id)
{
  thr_cord c = {
      .closed = true, .n_passes = f->n_nodes, .half = calloc((size_t)f->n_nodes, sizeof *c.half)};
  ck_assert(c.half != NULL);
  snprintf(c.id, sizeof c.id, "%s", id);
  for (int k = 0; k < f->n_nodes; k++) {
    int v = (start + k) % f->n_nodes, e = thr_frame_edge_between(f, v, (v + 1) % f->n_nodes);
    c.half[k] = 2 * e + (f->edge[e][0] != v);
  }
  return c;
}

/* A cord's end ties nothing, so that it matters where a closed cord comes out. Two cords go once
 * round a square and come out at opposite corners, each tying the other's: a half turn maps them to
 * each other. Neither where they come out at neighbours. */
START_TEST(ends_are_mapped_to_ends)
{
  static const int images[] = {0, 1, 2, 3, 2, 3, 0, 1};
  thr_frame f = no_feet(ring_make(4));
  thr_request o = tied(THR_ENDS_ANY);
  o.cords = 2;
  for (int start = 1; start < 4; start++) {
    thr_plan p = {0};
    thr_err err = {0};
    ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
    p.cord = calloc(2, sizeof *p.cord);
    p.symmetry = (thr_symmetry_record){.present = true,
                                       .order = 2,
                                       .n_generators = 1,
                                       .generator = calloc(4, sizeof(int)),
                                       .n_images = 2,
                                       .image = calloc(8, sizeof(int)),
                                       .unique = calloc(2, sizeof(int)),
                                       .element = calloc(2, sizeof(int)),
                                       .steps = 6, /* four passes, two ends */
                                       .unique_paths = 1};
    ck_assert(p.cord && p.symmetry.generator && p.symmetry.image && p.symmetry.unique &&
              p.symmetry.element);
    memcpy(p.symmetry.generator, images + 4, 4 * sizeof *images);
    memcpy(p.symmetry.image, images, sizeof images);
    p.symmetry.element[1] = 1;
    p.cord[p.n_cords++] = round_from(&p.frame, 0, "A");
    p.cord[p.n_cords++] = round_from(&p.frame, start, "B");
    ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                     THR_OK);
    ck_assert_int_eq(thr_check_plan(&p, &err), start == 2 ? THR_OK : THR_EVIOLATED);
    ck_assert_msg(start == 2 || strstr(err.text, "symmetry"), "%s", err.text);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A leaf where no cord may end, and passes that are too few for ties. */
START_TEST(what_cannot_be_tied_is_said)
{
  thr_frame star = no_feet(star_make(3)), ring = no_feet(ring_make(4));
  thr_request o = tied(THR_ENDS_CLOSED);
  thr_symmetries t;
  thr_err err = {0};
  ck_assert_int_eq(thr_symmetries_find(&star, &o, false, &(thr_limits){0}, &t, &err),
                   THR_EINFEASIBLE);
  ck_assert_msg(strstr(err.text, "one edge") != NULL, "%s", err.text);
  o = tied(
      THR_ENDS_ANY); /* a cord's two ends tie nothing, and every edge of the ring has one pass */
  o.capacity = 1;
  err = (thr_err){0};
  ck_assert_int_eq(thr_symmetries_find(&ring, &o, false, &(thr_limits){0}, &t, &err),
                   THR_EINFEASIBLE);
  thr_frame_destroy(&star);
  thr_frame_destroy(&ring);
}
END_TEST

/* ---- stars ---- */

/* Random numbers of turns at every node, each turn followed to all its images: connected or not? */
START_TEST(stars_against_images)
{
  setting s = setting_make(100, no_feet(solid_make(_i ? OCTAHEDRON : CUBE)));
  rng r = rng_make(77);
  int yes = 0, all = 0;
  for (int k = 0; k < s.classes.n; k++) {
    thr_quotient q;
    thr_ties t;
    const thr_subgroup *h = &s.classes.subgroup[k];
    ck_assert_int_eq(thr_quotient_init(&q, &s.f, &s.g, h, 100000, NULL), THR_OK);
    int n = s.f.n_nodes, orbit[32], *value = calloc((size_t)q.n_pairs + 1, sizeof *value),
        parent[32];
    ck_assert(value != NULL);
    for (int v = 0; v < n; v++) {
      orbit[v] = v;
      for (int i = 0; i < h->order; i++)
        if (s.g.image[h->element[i] * n + v] < orbit[v])
          orbit[v] = s.g.image[h->element[i] * n + v];
    }
    ck_assert_int_eq(thr_ties_init(&t, &q, orbit, NULL), THR_OK);
    for (int run = 0; run < 40; run++) {
      for (int y = 0; y < q.n_pairs; y++)
        value[y] = rng_between(&r, 0, 3) == 0;
      for (int star = 0; star < t.n; star++) {
        int tube[64], blocks = -1, v = t.node[star];
        for (int x = 0; x < 2 * s.f.n_edges; x++)
          tube[x] = x;
        for (int y = 0; y < q.n_pairs; y++)
          for (int i = 0; i < h->order && value[y]; i++) {
            int a = q.half_image[i * 2 * s.f.n_edges + q.pair[y].half[0]],
                b = q.half_image[i * 2 * s.f.n_edges + q.pair[y].half[1]];
            int from = tube[a], to = tube[b];
            for (int x = 0; x < 2 * s.f.n_edges; x++)
              if (tube[x] == from) tube[x] = to;
          }
        for (int x = 0; x < 2 * s.f.n_edges; x++) /* one name in a block is its own */
          blocks += thr_tail(&s.f, x) == v && tube[x] == x;
        bool is_tied = blocks == 0;
        ck_assert_int_eq(thr_ties_tied(&t, star, value, parent), is_tied);
        yes += is_tied;
        all++;
      }
    }
    free(value);
    thr_ties_destroy(&t);
    thr_quotient_destroy(&q);
  }
  ck_assert(yes > all / 20 && yes < all - all / 20);
  setting_destroy(&s);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_FEET};
  thr_frame f = shape_make(THR_MAKE_TUBE, 3, 2);
  thr_request o = tied(ends[_i]);
  thr_status st = THR_ENOMEM;
  int k = 0;
  memcpy(o.symmetry.group, "2", 2);
  while (st == THR_ENOMEM) {
    thr_symmetries t;
    thr_plan p;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_symmetry_plan(&f, &o, &(thr_limits){0}, &t, &p, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM || st == THR_ELIMIT,
                  "allocation %d: status %d, %s", k, st, err.text);
    if (st == THR_ENOMEM) ck_assert(t.n == 0 && p.n_cords == 0);
    thr_plan_destroy(&p);
    thr_symmetries_destroy(&t);
  }
  ck_assert_int_gt(k, 100);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tied_symmetry");
  ADD_EXAMPLES(s, 60, published_lengths, 4);
  ADD_EXAMPLES(s, 60, plans_pass_the_checker, 5);
  ADD_EXAMPLES(s, 120, shortest_is_that_of_the_other_search, 2);
  ADD_TEST(s, 20, ends_are_mapped_to_ends);
  ADD_TEST(s, 10, what_cannot_be_tied_is_said);
  ADD_LOOP(s, 20, stars_against_images, 0, 2);
  ADD_EXAMPLES(s, 100, every_allocation_fails_once, 2);
  return run_suite(s);
}
