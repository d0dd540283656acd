/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest cords for tube joints against all walks (tests/walks.h) in small frameworks, and
 * against published values. */
#include "graph/plan/plan_measures.h"
#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/judging.h"
#include "tests/plans.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_STATES = 200000 };

/* ---- small frameworks ---- */

static bool small_degrees(const thr_frame *f, int most)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) > most) return false;
  return true;
}

typedef struct {
  int solved, infeasible, open, unknown; /* unknown: too large for the oracle */
} tally;

static void compare(const thr_frame *f, const thr_request *o, tally *t)
{
  const thr_limits none = {0};
  thr_plan p;
  thr_err err = {0};
  const judged all = judged_of(f, o, MOST_STATES);
  double least = judged_least(&all, BACK_NEVER, judged_by_length, -1);
  if (isnan(least)) {
    t->unknown++;
    return;
  }
  thr_status st = length_plan(f, o, &none, &p, NULL, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(isinf(least), "%s; but there is one of length %g", err.text, least);
    t->infeasible++;
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  ck_assert_double_le(p.metrics.length, least * (1 + 1e-9));
  ck_assert_double_le(p.proof.lower_bound, least * (1 + 1e-9));
  ck_assert_double_ge(p.metrics.length, least * (1 - 1e-9));
  t->solved += st == THR_OK;
  t->open += st == THR_ELIMIT;
  thr_plan_destroy(&p);
}

/* The least turning of any length, or among the shortest. */
static void compare_turning(const thr_frame *f, thr_request *o, tally *t)
{
  const thr_limits none = {0};
  thr_plan p;
  thr_err err = {0};
  want(o, "turning");
  o->cords_least = o->cords;
  const judged all = judged_of(f, o, MOST_STATES);
  double shortest = judged_least(&all, BACK_NEVER, judged_by_length, -1);
  double limit = o->turning.length_slack < 0 ? INFINITY : shortest * (1 + 1e-9);
  double least = judged_least_turning(&all, limit, -1);
  if (isnan(least)) {
    t->unknown++;
    return;
  }
  thr_status st = thr_tortuosity_plan(f, o, &none, &p, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(isinf(least), "%s; but there is one of price %g", err.text, least);
    t->infeasible++;
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  if (st == THR_OK) ck_assert_double_le(p.turning.price, least + 1e-6);
  ck_assert_double_le(p.turning.lower_bound, least + 1e-6);
  if (st == THR_OK) ck_assert_double_ge(p.turning.price, least - 1e-6);
  t->solved += st == THR_OK;
  t->open += st == THR_ELIMIT;
  thr_plan_destroy(&p);
}

/* Options at random: ends, cords, capacity, covers of single edges. */
static void random_options(rng *r, thr_frame *f, thr_request *o)
{
  static const thr_ends kind[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_COUNTS};
  *o = options_for(kind[rng_below(r, 4)], rng_between(r, 1, 2));
  o->joint = THR_JOINT_TUBE;
  o->cords = rng_between(r, 1, 3);
  o->cords_least = o->ends == THR_ENDS_CLOSED ? 1 : rng_between(r, 1, o->cords);
  if (rng_below(r, 4) == 0) o->capacity = o->cover + rng_between(r, 1, 3);
  if (rng_below(r, 3) == 0) {
    f->cover = calloc((size_t)f->n_edges, sizeof *f->cover);
    f->capacity = calloc((size_t)f->n_edges, sizeof *f->capacity);
    for (int e = 0; e < f->n_edges; e++) {
      f->cover[e] = e > 0 && rng_below(r, 4) ? 1 : 2;
      f->capacity[e] = e > 0 && rng_below(r, 3) ? 0 : rng_between(r, 2, 4);
    }
  }
  if (o->ends != THR_ENDS_COUNTS) return;
  o->cords_least = 1;
  o->end_count = calloc((size_t)f->n_nodes, sizeof *o->end_count);
  for (int i = 2 * rng_between(r, 1, o->cords); i > 0; i--)
    o->end_count[rng_below(r, f->n_nodes)]++;
}

START_TEST(shortest_by_enumeration)
{
  enum { EACH = 165 };
  rng r = rng_make(900 + (uint64_t)_i);
  tally t = {0};
  for (int i = 0; i < EACH; i++) {
    int n = rng_between(&r, 3, 5);
    thr_frame f = random_frame(&r, n, rng_between(&r, 1, 7 - n + 1),
                               (length_kind)rng_below(&r, LENGTH_KINDS));
    thr_request o = {0};
    if (f.n_edges <= 7 && small_degrees(&f, 4)) {
      random_options(&r, &f, &o);
      compare(&f, &o, &t);
      free(o.end_count);
    }
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.solved, EACH / 8);
  ck_assert_int_le(t.open, (t.solved + t.open) / 50);
  ck_assert_int_le(t.unknown, EACH / 10);
}
END_TEST

START_TEST(least_turning_by_enumeration)
{
  enum { EACH = 40 };
  rng r = rng_make(1700 + (uint64_t)_i);
  tally t = {0};
  for (int i = 0; i < EACH; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 3, 4), rng_between(&r, 1, 3),
                               (length_kind)rng_below(&r, LENGTH_KINDS));
    thr_request o = {0};
    random_options(&r, &f, &o);
    if (o.ends == THR_ENDS_CLOSED || o.ends == THR_ENDS_COUNTS) o.cords = 1;
    for (int v = 0; v < f.n_nodes && o.ends == THR_ENDS_COUNTS; v++) /* two ends */
      o.end_count[v] = v == 0 || v == _i % (f.n_nodes - 1) + 1;
    o.turning.cost = (thr_turn_cost)rng_below(&r, THR_N_TURN_COSTS);
    o.turning.length_slack = rng_below(&r, 2) - 1;
    compare_turning(&f, &o, &t);
    free(o.end_count);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.solved, EACH / 8);
  ck_assert_int_le(t.open, 1 + t.solved / 10);
  ck_assert_int_le(t.unknown, EACH / 10);
}
END_TEST

/* ---- published and hand-made values ---- */

static thr_plan shortest(const thr_frame *f, thr_ends ends, int cover)
{
  const thr_limits none = {0};
  thr_request o = options_for(ends, cover);
  thr_plan p;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  assert_ok(length_plan(f, &o, &none, &p, NULL, &err), &err);
  assert_plan_sound(&p);
  return p;
}

/* Graph Threading of the solids: two passes of a third of the edges where three meet, half more
 * where four do. */
START_TEST(solids)
{
  static const double ratio[] = {4.0 / 3, 4.0 / 3, 1.5, 4.0 / 3, 1.6};
  for (int s = TETRAHEDRON; s <= ICOSAHEDRON; s++) {
    thr_frame f = solid_make((solid)s);
    thr_plan p = shortest(&f, THR_ENDS_CLOSED, 1);
    ck_assert_double_eq_tol(p.metrics.length, ratio[s] * f.n_edges, 1e-9);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* With three edges at every node tying is covering: the same length as Route Inspection. */
START_TEST(cubic_is_route_inspection)
{
  rng r = rng_make(31);
  for (int s = 0; s < 3; s++) {
    thr_frame f = solid_make(s == 0 ? TETRAHEDRON : s == 1 ? CUBE : DODECAHEDRON);
    for (int e = 0; e < f.n_edges; e++)
      f.length[e] = 1 + rng_unit(&r);
    f.own_lengths = true;
    thr_plan p = shortest(&f, THR_ENDS_CLOSED, 1), around = plan_simple(&f, THR_ENDS_CLOSED, 1);
    ck_assert_double_eq_tol(p.metrics.length, around.metrics.length, 1e-9);
    thr_plan_destroy(&p);
    thr_plan_destroy(&around);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(ring_and_path)
{
  thr_frame ring = ring_make(5), path = path_make(4);
  thr_plan p = shortest(&ring, THR_ENDS_CLOSED, 1), q = shortest(&path, THR_ENDS_ANY, 1);
  ck_assert_double_eq_tol(p.metrics.length, 5, 1e-9);
  ck_assert_double_eq_tol(q.metrics.length, thr_frame_total_length(&path), 1e-9);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&ring);
  thr_frame_destroy(&path);
}
END_TEST

START_TEST(what_cannot_be_tied_is_named)
{
  const thr_limits none = {0};
  thr_frame f = star_make(3);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  assert_status(length_plan(&f, &o, &none, &p, NULL, &err), THR_EINFEASIBLE, &err, f.name[1]);
  o.ends = THR_ENDS_ANY; /* three ends at the leaves, two of one cord */
  assert_status(length_plan(&f, &o, &none, &p, NULL, &err), THR_EINFEASIBLE, &err, "--cords");
  o.cords = 2;
  ck_assert_int_eq(length_plan(&f, &o, &none, &p, NULL, &err), THR_OK);
  ck_assert_double_eq_tol(p.metrics.length, 4, 1e-9); /* one spoke twice */
  ck_assert_int_eq(p.n_cords, 2);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
  f = solid_make(CUBE);
  o = options_for(THR_ENDS_CLOSED, 1);
  o.joint = THR_JOINT_TUBE;
  o.capacity = 1; /* three passes at a node, but four tie it */
  err = (thr_err){0};
  assert_status(length_plan(&f, &o, &none, &p, NULL, &err), THR_EINFEASIBLE, &err,
                "room for 3 passes");
  thr_frame_destroy(&f);
}
END_TEST

/* ---- lies ---- */

/* An altered multiplier proves less, or nothing; never more than the truth. */
START_TEST(altered_proofs_prove_no_more)
{
  rng r = rng_make(77);
  thr_frame f = solid_make(OCTAHEDRON);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.joint = THR_JOINT_TUBE;
  thr_plan p = shortest(&f, THR_ENDS_CLOSED, 1);
  for (int i = 0; i < 300; i++) {
    thr_text text = plan_text(&p);
    thr_plan q = plan_from(text.data);
    thr_turning_dual *d = &q.proof.tied.dual[rng_below(&r, q.proof.tied.n_duals)];
    double least = 0;
    int64_t by = rng_between(&r, -8, 8) * ((int64_t)1 << 42);
    switch (rng_below(&r, 4)) {
    case 0: d->potential[rng_below(&r, 2 * f.n_edges)] += by; break;
    case 1:
      if (d->n_junctions) d->junction[rng_below(&r, d->n_junctions)].value += by;
      break;
    case 2:
      if (d->n_junctions)
        d->junction[rng_below(&r, d->n_junctions)].block[rng_below(&r, 4)] = rng_between(&r, -1, 4);
      break;
    default:
      if (d->n_junctions)
        d->junction[rng_below(&r, d->n_junctions)].node = rng_between(&r, -1, f.n_nodes);
      break;
    }
    thr_status st = thr_tied_least(&f, &o, &q.proof.tied, &least, NULL);
    ck_assert(st == THR_EVIOLATED || (st == THR_OK && least <= p.metrics.length * (1 + 1e-9)));
    thr_plan_destroy(&q);
    thr_text_destroy(&text);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(false_claims_are_refused)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_plan p = shortest(&f, THR_ENDS_CLOSED, 1);
  thr_err err = {0};
  p.proof.optimal = false;
  p.proof.lower_bound *= 1.1;
  ck_assert_int_eq(judge_plan(&p, NULL), THR_EVIOLATED);
  p.proof.lower_bound = p.metrics.length;
  p.proof.optimal = true;
  ck_assert_int_eq(judge_plan(&p, NULL), THR_OK);
  p.options.joint = THR_JOINT_SOLID; /* whose proof has certificates */
  ck_assert_int_eq(judge_plan(&p, NULL), THR_EVIOLATED);
  p.options.joint = THR_JOINT_TUBE;
  thr_turning_dual *d = &p.proof.tied.dual[0];
  ck_assert_int_gt(d->n_junctions, 0);
  d->junction[0].value /= 2;
  assert_status(judge_plan(&p, &err), THR_EVIOLATED, &err, "says optimal");
  d->junction[0].value *= -2;
  ck_assert_int_eq(judge_plan(&p, NULL), THR_EVIOLATED);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- memory ---- */

START_TEST(every_allocation_fails_once)
{
  const thr_limits none = {0};
  thr_frame f = solid_make(TETRAHEDRON);
  thr_request o = options_for(_i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  thr_status st = THR_ENOMEM;
  long k = 0;
  o.joint = THR_JOINT_TUBE;
  want(&o, _i < 2 ? "length" : "turning");
  f.length[0] = 1.5; /* nothing to choose from would be too simple */
  f.own_lengths = true;
  while (st) {
    thr_plan p = {0};
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_wants_length(&o) ? length_plan(&f, &o, &none, &p, NULL, &err)
                              : thr_tortuosity_plan(&f, &o, &none, &p, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(!st || st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st, err.text);
    ck_assert(!st || (!p.cord && !p.proof.tied.node));
    thr_plan_destroy(&p);
    ck_assert_int_lt(k, 100000);
  }
  ck_assert_int_gt(k, 60);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tube");
  ADD_EXAMPLES(s, 60, every_allocation_fails_once, 4);
  ADD_EXAMPLES(s, 120, shortest_by_enumeration, 20);
  ADD_EXAMPLES(s, 120, least_turning_by_enumeration, 10);
  ADD_TEST(s, 20, solids);
  ADD_TEST(s, 20, cubic_is_route_inspection);
  ADD_TEST(s, 5, ring_and_path);
  ADD_TEST(s, 5, what_cannot_be_tied_is_named);
  ADD_TEST(s, 20, altered_proofs_prove_no_more);
  ADD_TEST(s, 20, false_claims_are_refused);
  return run_suite(s);
}
