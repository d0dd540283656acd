/* SPDX-License-Identifier: GPL-3.0-or-later */
/* T-joins and the shortest cord: known answers, data files, limits. */
#include "graph/framework/frame.h"
#include "lp/length/postman.h"
#include "lp/tjoin/tjoin.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- known answers ---- */

static const struct {
  solid which;
  int nodes, edges;
  double closed, open;
} solids[] = {{TETRAHEDRON, 4, 6, 8, 7},
              {CUBE, 8, 12, 16, 15},
              {OCTAHEDRON, 6, 12, 12, 12},
              {DODECAHEDRON, 20, 30, 40, 39},
              {ICOSAHEDRON, 12, 30, 36, 35}};

START_TEST(platonic_solids)
{
  thr_frame f = solid_make(solids[_i].which);
  ck_assert_int_eq(f.n_nodes, solids[_i].nodes);
  ck_assert_int_eq(f.n_edges, solids[_i].edges);
  thr_plan closed = plan_simple(&f, THR_ENDS_CLOSED, 1), open = plan_simple(&f, THR_ENDS_ANY, 1),
           twice = plan_simple(&f, THR_ENDS_ANY, 2);
  ck_assert_double_eq_tol(closed.metrics.length, solids[_i].closed, 1e-9);
  ck_assert_double_eq_tol(open.metrics.length, solids[_i].open, 1e-9);
  ck_assert_double_eq_tol(twice.metrics.length, 2 * solids[_i].edges, 1e-9);
  ck_assert(closed.proof.optimal && open.proof.optimal && twice.proof.optimal);
  assert_plan_sound(&closed);
  assert_plan_sound(&open);
  assert_plan_sound(&twice);
  thr_plan_destroy(&closed);
  thr_plan_destroy(&open);
  thr_plan_destroy(&twice);
  thr_frame_destroy(&f);
}
END_TEST

static void assert_length(const char *path, double base, double length)
{
  thr_frame f = frame_load(path, NULL);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  ck_assert_double_eq_tol(p.metrics.base_length, base, 1e-6 * base);
  ck_assert_double_eq_tol(p.metrics.length, length, 1e-6 * length);
  ck_assert(p.proof.optimal);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}

START_TEST(lengths_of_real_frameworks)
{
  assert_length("data/jax_fdm/liew_dome.json", 1504.362, 1568.966);
  assert_length("data/assembly-instances/C_shape.json", 7851.928556, 8626.087785);
}
END_TEST

START_TEST(trees_need_every_edge_twice)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 40), 0, (length_kind)(_i % LENGTH_KINDS));
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  ck_assert_double_eq_tol(p.metrics.length, 2 * thr_frame_total_length(&f),
                          1e-9 * p.metrics.length);
  ck_assert_int_eq(p.metrics.most_passes, 2);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A grid's odd nodes are the border's; for w = h = 2 k + 2, two neighbours at a time: k pairs a
 * side. */
START_TEST(grids_pair_their_border)
{
  for (int k = 1; k < 9; k++) {
    thr_frame f = grid_make(2 * k + 2, 2 * k + 2);
    thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
    ck_assert_double_eq_tol(p.metrics.overlap, 4 * k, 1e-9);
    ck_assert(p.proof.optimal);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(one_edge)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  static const double length[] = {2, 1, 2};
  thr_frame f = path_make(2);
  for (int i = 0; i < 3; i++) {
    thr_plan p = plan_simple(&f, ends[i], 1);
    ck_assert_double_eq(p.metrics.length, length[i]);
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(the_most_passes)
{
  thr_frame f = solid_make(CUBE);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 99), q = plan_simple(&f, THR_ENDS_CLOSED, 100);
  ck_assert_double_eq_tol(p.metrics.length, 99 * 12 + 4, 1e-6);
  ck_assert_double_eq_tol(q.metrics.length, 100 * 12, 1e-6);
  assert_plan_sound(&p);
  assert_plan_sound(&q);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(lengths_of_very_different_size)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, 12, 6, LENGTHS_RANDOM);
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] = pow(10, rng_between(&r, -6, 6)) * (1 + rng_unit(&r));
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  double base = thr_frame_total_length(&f);
  ck_assert_double_eq_tol(p.metrics.length, base + least_extra_by_matching(&f, &o), 1e-9 * base);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(no_end_allowed_is_infeasible)
{
  thr_frame f = triangles_make(3);
  f.foot[4] = false; /* the only foot of the second triangle */
  thr_request o = options_for(THR_ENDS_FEET, 1);
  thr_plan p;
  thr_limits none = {0};
  thr_err err = {0};
  assert_status(thr_postman_plan(&f, &o, &none, &p, &err), THR_EINFEASIBLE, &err,
                "the component with node");
  ck_assert(p.cord == NULL && p.frame.xyz == NULL);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(a_plan_for_the_length_has_one_cord_a_piece)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_plan p;
  thr_err err = {0};
  o.cords = 2;
  assert_status(thr_postman_plan(&f, &o, &(thr_limits){0}, &p, &err), THR_EINPUT, &err,
                "--objective tortuosity");
  ck_assert(p.cord == NULL && p.frame.xyz == NULL);
  thr_frame_destroy(&f);
}
END_TEST

/* A cube has 8 odd nodes; 2 K of them may be left to the ends of K cords, and each pair of the
 * others costs an edge. */
START_TEST(cords_of_a_cube)
{
  thr_frame f = solid_make(CUBE);
  for (int cords = 1; cords <= 6; cords++) {
    thr_request o = options_for(THR_ENDS_ANY, 1);
    o.cords = cords;
    thr_plan p = plan_of_cords(&f, &o);
    ck_assert_double_eq_tol(p.metrics.length, 12 + (cords < 4 ? 4 - cords : 0), 1e-12);
    ck_assert(p.proof.optimal);
    ck_assert_double_eq_tol(p.proof.lower_bound, p.metrics.length, 1e-12);
    ck_assert_int_eq(p.proof.certificate[0].end_price > 0,
                     cords < 4); /* 4 cords end at all the odd nodes */
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Prices that are no whole weight (equal beads), a search between prices, no price at all, one
 * cord, and two parts that no extra pass joins. */
START_TEST(every_allocation_with_ends_fails_once)
{
  static const int cords[] = {2, 3, 4, 1, 1};
  rng r = rng_make(5);
  thr_frame f = _i % 4 == 0 ? solid_make(CUBE)
                            : random_frame(&r, 30, 30, _i == 2 ? LENGTHS_EQUAL : LENGTHS_RANDOM);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_status st = THR_ENOMEM;
  o.cords = cords[_i];
  if (_i == 4) {
    f.capacity = calloc((size_t)f.n_edges, sizeof *f.capacity);
    for (int e = 0; e < f.n_edges; e++)
      f.capacity[e] = fabs(f.xyz[f.edge[e][0]][2] - f.xyz[f.edge[e][1]][2]) > 0.5;
  }
  for (long k = 1; st; k++) {
    thr_shortest s;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st,
                  err.text);
    ck_assert(st ? !s.passes && !s.certificate : s.optimal);
    thr_shortest_destroy(&s);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- limits ---- */

/* A framework on which the cutting planes need many rounds. */
static thr_frame hard_frame(void)
{
  rng r = rng_make(77);
  return random_frame(&r, 300, 300, LENGTHS_RANDOM);
}

static void assert_stopped_well(const thr_frame *f, const thr_request *o, const thr_limits *l,
                                double best)
{
  thr_plan p;
  thr_err err = {0};
  thr_status st = thr_postman_plan(f, o, l, &p, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  if (st) assert_one_line(&err, "stopped early");
  ck_assert_int_eq(st == THR_OK, p.proof.optimal);
  ck_assert_int_eq(verdict_by_sums(&p), p.proof.optimal ? 2 : 1);
  ck_assert(p.metrics.length > best * (1 - 1e-9) && p.proof.lower_bound < best * (1 + 1e-9));
  ck_assert(p.proof.gap >= 0 && p.proof.gap < 0.6);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
}

START_TEST(passed_deadline_leaves_a_valid_plan)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = hard_frame();
  thr_request o = options_for(ends[_i], 1);
  thr_plan best = plan_make(&f, &o);
  volatile sig_atomic_t pressed = 1;
  assert_stopped_well(&f, &o, &(thr_limits){.deadline = thr_clock() - 10}, best.metrics.length);
  assert_stopped_well(&f, &o, &(thr_limits){.interrupted = &pressed}, best.metrics.length);
  for (int ms = 1; ms < 40; ms += 3)
    assert_stopped_well(&f, &o, &(thr_limits){.deadline = thr_clock() + ms / 1000.0},
                        best.metrics.length);
  thr_plan_destroy(&best);
  thr_frame_destroy(&f);
}
END_TEST

typedef struct {
  volatile sig_atomic_t pressed;
  int calls, stop_after;
  double best, bound;
} watcher;

static void watch(void *user, const char *what, double best, double bound)
{
  watcher *w = user;
  ck_assert(what != NULL && best >= bound);
  ck_assert(w->calls == 0 || (best <= w->best && bound >= w->bound));
  w->best = best;
  w->bound = bound;
  if (++w->calls == w->stop_after) w->pressed = 1;
}

START_TEST(passed_deadline_leaves_valid_passes)
{
  thr_frame f = hard_frame();
  thr_request o = options_for(_i % 2 ? THR_ENDS_ANY : THR_ENDS_FEET, 1);
  thr_shortest best, s;
  o.cords = 2 + 3 * _i;
  ck_assert_int_eq(thr_postman_shortest(&f, &o, &(thr_limits){0}, &best, NULL), THR_OK);
  for (int ms = -1; ms < 200; ms = ms < 0 ? 1 : 2 * ms) {
    thr_err err = {0};
    thr_status st = thr_postman_shortest(
        &f, &o, &(thr_limits){.deadline = thr_clock() + ms / 1000.0}, &s, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
    ck_assert_int_eq(st == THR_OK, s.optimal);
    ck_assert(s.length >= best.length * (1 - 1e-9) && s.lower_bound <= best.length * (1 + 1e-9));
    thr_shortest_destroy(&s);
  }
  thr_shortest_destroy(&best);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(interrupt_between_rounds_leaves_a_valid_plan)
{
  thr_frame f = hard_frame();
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan best = plan_make(&f, &o);
  watcher w = {.stop_after = _i + 1};
  assert_stopped_well(&f, &o,
                      &(thr_limits){.interrupted = &w.pressed, .progress = watch, .user = &w},
                      best.metrics.length);
  ck_assert_int_gt(w.calls, 0);
  thr_plan_destroy(&best);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(stopped_before_any_proof_with_many_components)
{
  thr_frame f = triangles_make(50);
  thr_request o = options_for(THR_ENDS_FEET, 1);
  volatile sig_atomic_t pressed = 1;
  assert_stopped_well(&f, &o, &(thr_limits){.interrupted = &pressed}, 150);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- T-joins themselves ---- */

/* The lightest subset of edges whose odd nodes are odd[], by trying all; and the solver's, with its
 * cuts added up. */
START_TEST(joins_match_all_subsets)
{
  rng r = rng_make((uint64_t)_i + 5);
  int n = rng_between(&r, 2, 8), m = n - 1 + rng_below(&r, 7), edge[16][2];
  int64_t weight[16], least = INT64_MAX;
  bool odd[8] = {false};
  uint32_t wanted = 0;
  for (int e = 0; e < m; e++) {
    edge[e][1] = e < n - 1 ? e + 1 : rng_below(&r, n);
    edge[e][0] = e < n - 1 ? rng_below(&r, e + 1)
                           : (edge[e][1] + rng_between(&r, 1, n - 1)) % n; /* parallel ones too */
    weight[e] = _i % 3 ? rng_below(&r, 5) : rng_below(&r, 1000000000);
  }
  for (int k = rng_below(&r, n); k > 0; k--) {
    int a = rng_below(&r, n), b = (a + rng_between(&r, 1, n - 1)) % n;
    odd[a] = !odd[a], odd[b] = !odd[b];
  }
  for (int v = 0; v < n; v++)
    wanted |= (uint32_t)odd[v] << v;
  for (uint32_t s = 0; s < UINT32_C(1) << m; s++) {
    int64_t sum = 0;
    uint32_t left = wanted;
    for (int e = 0; e < m; e++)
      if (s >> e & 1)
        sum += weight[e], left ^= UINT32_C(1) << edge[e][0] ^ UINT32_C(1) << edge[e][1];
    if (left == 0 && sum < least) least = sum;
  }
  thr_tjoin_problem p = {
      .n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .weight = weight, .odd = odd};
  thr_tjoin t;
  thr_err err = {0};
  thr_limits none = {0};
  assert_ok(thr_tjoin_solve(&p, &none, &t, &err), &err);
  int64_t length = 0, sum = 0, load[16] = {0};
  uint32_t side[64] = {0};
  for (int e = 0; e < m; e++)
    if (t.in_join[e])
      length += weight[e], wanted ^= UINT32_C(1) << edge[e][0] ^ UINT32_C(1) << edge[e][1];
  ck_assert_int_le(t.n_cuts, 64);
  for (int i = 0; i < t.n_cuts; i++) {
    int odds = 0, up = t.cut[i].parent;
    for (int k = 0; k < t.cut[i].n_nodes; k++)
      side[i] |= UINT32_C(1) << t.cut[i].node[k];
    for (int v = 0; v < n; v++)
      odds += odd[v] && side[i] >> v & 1;
    ck_assert(odds % 2 == 1 && t.cut[i].value >= 0 && (up == -1 || (up > i && up < t.n_cuts)));
    if (up >= 0) side[up] |= side[i];
    sum += t.cut[i].value;
    for (int e = 0; e < m; e++)
      if ((side[i] >> edge[e][0] ^ side[i] >> edge[e][1]) & 1) load[e] += t.cut[i].value;
  }
  for (int e = 0; e < m; e++)
    ck_assert_int_le(load[e], weight[e] * THR_DUAL_DENOMINATOR);
  ck_assert_uint_eq(wanted, 0);
  ck_assert_int_eq(length, least);
  ck_assert_int_eq(t.length, least);
  ck_assert_int_eq(t.sum, sum);
  ck_assert(t.optimal && sum > (least - 1) * THR_DUAL_DENOMINATOR);
  thr_tjoin_destroy(&t);
}
END_TEST

/* A cord end may be at each of thousands of nodes: pairs over outside are too many to list. */
START_TEST(ends_anywhere_in_a_large_framework)
{
  thr_make_options make = thr_make_options_default(THR_MAKE_HONEYCOMB);
  make.size = 22;
  thr_draft draft = {0};
  thr_frame f;
  thr_read_report report;
  ck_assert_int_eq(thr_make(&draft, &make, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&draft, -1, &f, &report, NULL), THR_OK);
  rng r = rng_make(6);
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] = 10 + 20 * rng_unit(&r);
  double closed = INFINITY;
  for (int cords = 0; cords <= 3; cords++) { /* 0: a closed one */
    thr_request o = options_for(cords ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
    thr_shortest s;
    thr_err err = {0};
    o.confirm = THR_CONFIRM_NEVER;
    o.cords = o.cords_least = cords ? cords : 1;
    assert_ok(thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, &err), &err);
    ck_assert(s.optimal);
    ck_assert_double_lt(s.length, closed);
    ck_assert(s.confirmed.confirmed == 0 && s.confirmed.skipped == 0);
    closed = s.length;
    thr_shortest_destroy(&s);
  }
  thr_frame_destroy(&f);
  thr_draft_destroy(&draft);
}
END_TEST

/* More edges than are confirmed without being asked. */
START_TEST(confirmation_as_asked)
{
  thr_frame f = grid_make(72, 72);
  ck_assert_int_gt(f.n_edges, THR_CONFIRM_EDGES);
  for (thr_confirm c = THR_CONFIRM_AUTO; c <= THR_CONFIRM_NEVER; c++) {
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    thr_shortest s;
    o.confirm = c;
    ck_assert_int_eq(thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, NULL), THR_OK);
    ck_assert_int_eq(s.confirmed.confirmed, c == THR_CONFIRM_ALWAYS);
    ck_assert_int_eq(s.confirmed.skipped, c == THR_CONFIRM_AUTO);
    thr_shortest_destroy(&s);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("shortest cord");
  ADD_LOOP(s, 10, platonic_solids, 0, 5);
  ADD_TEST(s, 20, lengths_of_real_frameworks);
  ADD_LOOP(s, 10, trees_need_every_edge_twice, 0, 12);
  ADD_TEST(s, 20, grids_pair_their_border);
  ADD_TEST(s, 10, one_edge);
  ADD_TEST(s, 20, the_most_passes);
  ADD_LOOP(s, 10, lengths_of_very_different_size, 0, 20);
  ADD_TEST(s, 10, a_plan_for_the_length_has_one_cord_a_piece);
  ADD_TEST(s, 10, cords_of_a_cube);
  ADD_LOOP(s, 60, every_allocation_with_ends_fails_once, 0, 5);
  ADD_TEST(s, 10, no_end_allowed_is_infeasible);
  ADD_LOOP(s, 30, passed_deadline_leaves_a_valid_plan, 0, 3);
  ADD_LOOP(s, 60, passed_deadline_leaves_valid_passes, 0, 4);
  ADD_LOOP(s, 30, interrupt_between_rounds_leaves_a_valid_plan, 0, 6);
  ADD_TEST(s, 10, stopped_before_any_proof_with_many_components);
  ADD_TEST(s, 60, ends_anywhere_in_a_large_framework);
  ADD_TEST(s, 60, confirmation_as_asked);
  ADD_EXAMPLES(s, 10, joins_match_all_subsets, 300);
  return run_suite(s);
}
