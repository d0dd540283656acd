/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several cords for tube joints against all walks (tests/walks.h) in small frameworks; what must
 * hold in larger ones. */
#include "tests/frameworks.h"
#include "tests/judging.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 6 };

/* ---- small frameworks ---- */

static bool has_leaf(const thr_frame *f)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) == 1) return true;
  return false;
}

/* With closed cords few that have a node with one edge, where there are none. */
static thr_frame small_frame(rng *r, const thr_request *o)
{
  for (;;) {
    int n = rng_between(r, 3, 4), most = o->cover == 1 ? 5 : 4;
    thr_frame f = random_frame(r, n, rng_between(r, o->ends == THR_ENDS_CLOSED, EDGES - n),
                               (length_kind)rng_below(r, LENGTH_KINDS));
    bool leaf = o->ends == THR_ENDS_CLOSED && has_leaf(&f) && rng_below(r, 8);
    if (f.n_edges <= most && !leaf) return f;
    thr_frame_destroy(&f);
  }
}

static thr_request random_options(rng *r, int k)
{
  static const thr_ends kind[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_CLOSED};
  thr_request o = options_for(kind[k % 4], rng_below(r, 4) ? 1 : 2);
  o.joint = THR_JOINT_TUBE;
  if (rng_below(r, 4) == 0) o.capacity = o.cover + rng_between(r, 1, 3);
  return o;
}

static void random_counts(rng *r, const thr_frame *f, thr_request *o)
{
  o->ends = THR_ENDS_COUNTS;
  o->end_count = calloc((size_t)f->n_nodes, sizeof *o->end_count);
  for (int i = 0; i < 2 * o->cords; i++)
    o->end_count[rng_below(r, f->n_nodes)]++;
}

static double longest_of(const thr_plan *p)
{
  double most = 0;
  for (int i = 0; i < p->n_cords; i++)
    most = fmax(most, thr_cord_length(&p->frame, &p->cord[i]));
  return most;
}

/* Claims beyond what is proved. */
static void assert_lies_are_refused(thr_plan *p)
{
  thr_cords_claim truth = p->cords_claim;
  if (!truth.longest_optimal) {
    p->cords_claim.longest_bound += 0.3 * (truth.longest - truth.longest_bound);
    ck_assert_int_eq(judge_plan(p, NULL), THR_EVIOLATED);
    p->cords_claim = truth;
    p->cords_claim.longest_optimal = true;
    p->cords_claim.longest_bound = truth.longest;
    ck_assert_int_eq(judge_plan(p, NULL), THR_EVIOLATED);
    p->cords_claim = truth;
  }
  p->cords_claim.longest *= 0.99;
  ck_assert_int_eq(judge_plan(p, NULL), THR_EVIOLATED);
  p->cords_claim = truth;
  if (truth.fewest) {
    p->cords_claim.fewest++;
    p->cords_claim.fewest_optimal = p->cords_claim.fewest == p->n_cords;
    ck_assert_int_eq(judge_plan(p, NULL), THR_EVIOLATED);
    p->cords_claim = truth;
  }
  ck_assert_int_eq(judge_plan(p, NULL), THR_OK);
}

typedef struct {
  int solved, open, infeasible;
} tally;

/* What GLPK calls no better. */
static const double tolerance = 2e-5;

/* Closed cords: as short together as any so many. */
static void compare_closed(const thr_frame *f, const thr_request *o, tally *t)
{
  thr_plan p;
  thr_cords_word word;
  thr_err err = {0};
  double best = judged_together(f, o, o->cords_least);
  thr_status st = length_plan(f, o, &(thr_limits){0}, &p, &word, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(isinf(best), "%s, but %g will do", err.text, best);
    t->infeasible++;
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_int_eq(p.n_cords, o->cords_least);
  assert_plan_sound(&p);
  if (isfinite(best)) {
    ck_assert_double_le(p.proof.lower_bound, best * (1 + 1e-9));
    if (st == THR_OK || word.passes_least) ck_assert_double_le(p.metrics.length, best * (1 + 1e-9));
    ck_assert_double_ge(p.metrics.length, best * (1 - 1e-9));
  }
  t->solved += st == THR_OK || word.passes_least;
  t->open += st == THR_ELIMIT && !word.passes_least;
  if (p.cords_claim.present) assert_lies_are_refused(&p);
  thr_plan_destroy(&p);
}

START_TEST(closed_cords_by_enumeration)
{
  rng r = rng_make((uint64_t)_i + 4100);
  tally t = {0};
  for (int k = 0; k < 30; k++) {
    thr_request o = random_options(&r, 0);
    thr_frame f = small_frame(&r, &o);
    o.cords_least = 1 + k % 3;
    o.cords = o.cords_least + rng_below(&r, 2);
    compare_closed(&f, &o, &t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.solved, 8);
  ck_assert_int_le(t.open, 1);
}
END_TEST

/* The longest of two or three as short as of any. */
static void compare_even(const thr_frame *f, const thr_request *o, tally *t)
{
  thr_plan p;
  thr_cords_word word;
  thr_err err = {0};
  double best = judged_longest(f, o, o->cords);
  thr_status st = length_plan(f, o, &(thr_limits){0}, &p, &word, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(isinf(best), "%s, but %g will do", err.text, best);
    t->infeasible++;
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_int_eq(p.n_cords, o->cords);
  assert_plan_sound(&p);
  double longest = longest_of(&p);
  bool said = st == THR_OK || word.longest_least;
  if (isfinite(best)) {
    ck_assert_double_le(p.cords_claim.longest_bound, best * (1 + 1e-9));
    if (said) ck_assert_double_le(longest, best * (1 + tolerance));
    ck_assert_double_ge(longest, best * (1 - 1e-9));
  }
  t->solved += said;
  t->open += !said;
  assert_lies_are_refused(&p);
  thr_plan_destroy(&p);
}

START_TEST(even_cords_by_enumeration)
{
  rng r = rng_make((uint64_t)_i + 4300);
  tally t = {0};
  for (int k = 0; k < 24; k++) {
    thr_request o = random_options(&r, k);
    want(&o, "longest");
    o.cords = o.cords_least = 2;
    thr_frame f = small_frame(&r, &o);
    if (o.ends == THR_ENDS_ANY && rng_below(&r, 2)) random_counts(&r, &f, &o);
    compare_even(&f, &o, &t);
    free(o.end_count);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.solved, 5);
  ck_assert_int_le(t.open, 2);
}
END_TEST

/* As few as any of that length. */
static void compare_limited(const thr_frame *f, thr_request *o, double part, tally *t)
{
  thr_plan p;
  thr_err err = {0};
  double longest[2] = {judged_together(f, o, 1), judged_longest(f, o, 2)};
  if (isinf(longest[1])) return;
  o->max_length = isinf(longest[0]) ? longest[1] * (0.9 + 0.2 * part)
                                    : longest[1] + (longest[0] * 1.05 - longest[1]) * part;
  if (part > 0.9) o->max_length = longest[1] * (1 + tolerance);
  int few = longest[0] <= o->max_length ? 1 : longest[1] <= o->max_length ? 2 : 3;
  thr_status st = length_plan(f, o, &(thr_limits){0}, &p, NULL, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(few == 3, "%s, but %d will do", err.text, few);
    t->infeasible++;
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  ck_assert_double_le(longest_of(&p), o->max_length * (1 + 1e-9));
  ck_assert_int_le(p.cords_claim.fewest, p.n_cords);
  if (few < 3) ck_assert_int_le(p.cords_claim.fewest, few);
  ck_assert_int_ge(p.n_cords, few);
  t->solved += p.n_cords <= few;
  t->open += few < 3 && p.n_cords > few;
  assert_lies_are_refused(&p);
  thr_plan_destroy(&p);
}

START_TEST(limited_cords_by_enumeration)
{
  rng r = rng_make((uint64_t)_i + 4500);
  tally t = {0};
  for (int k = 0; k < 24; k++) {
    thr_request o = random_options(&r, k);
    o.cords = 1000;
    thr_frame f = small_frame(&r, &o);
    compare_limited(&f, &o, rng_unit(&r), &t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.solved, 5);
  ck_assert_int_le(t.open, 2);
}
END_TEST

/* ---- by hand ---- */

/* A ring has no place to split a cord: every cord goes all the way round. */
START_TEST(a_ring_takes_a_round_for_every_cord)
{
  thr_frame f = ring_make(5);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p;
  thr_cords_word word;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  o.cords = o.cords_least = 3;
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, &word, &err);
  ck_assert_msg(st == THR_ELIMIT && word.passes_least, "%s", err.text);
  ck_assert_double_eq_tol(p.metrics.length, 3 * thr_frame_total_length(&f), 1e-9);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  o.capacity = 2;
  err = (thr_err){0};
  assert_status(length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err), THR_EINFEASIBLE, &err,
                "there are no 3 closed cords");
  thr_frame_destroy(&f);
}
END_TEST

/* ---- larger ones ---- */

static thr_frame uneven_grid(int w, int h, uint64_t seed)
{
  thr_frame f = grid_make(w, h);
  rng r = rng_make(seed);
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] = 0.5 + rng_unit(&r);
  f.own_lengths = true;
  return f;
}

/* Tied cords share many passes: they come out even, at hardly more than the shortest length; the
 * same in every run. */
START_TEST(cords_of_grids_are_even)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = uneven_grid(8 + _i % 3, 7, (uint64_t)_i + 1);
  thr_request o = options_for(ends[_i % 3], 1 + _i / 3 % 2);
  thr_plan p, q;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  want(&o, "longest");
  o.cords = o.cords_least = 2 + _i % 3;
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_int_eq(p.n_cords, o.cords);
  assert_plan_sound(&p);
  ck_assert_double_le(longest_of(&p), 1.02 * p.proof.lower_bound / o.cords);
  st = length_plan(&f, &o, &(thr_limits){0}, &q, NULL, NULL);
  ck_assert(st == THR_OK || st == THR_ELIMIT);
  thr_text a = plan_text(&p), b = plan_text(&q);
  assert_same_text(&a, &b);
  thr_text_destroy(&a);
  thr_text_destroy(&b);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

/* Half of all at most: two closed cords at least, three or four where the bound leaves no room for
 * two. */
START_TEST(cords_of_grids_keep_to_a_limit)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = uneven_grid(7 + _i % 3, 7, (uint64_t)_i + 50);
  thr_request o = options_for(ends[_i % 3], 1);
  thr_plan p;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  o.cords = 1000;
  o.max_length = 0.7 * thr_frame_total_length(&f);
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == (p.proof.optimal ? THR_OK : THR_ELIMIT), "%s", err.text);
  ck_assert_int_eq(p.n_cords, (int)ceil(p.proof.lower_bound / o.max_length));
  assert_plan_sound(&p);
  assert_lies_are_refused(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Two pieces: the proof is one of both, and each has as many cords as it takes. */
START_TEST(pieces_have_cords_of_their_own)
{
  thr_frame one = uneven_grid(5, 5, 3), other = uneven_grid(3, 3, 4),
            f = side_by_side(&one, &other);
  thr_request o = options_for(_i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  thr_plan p;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  o.cords = _i < 2 ? 2 : 1000;
  o.cords_least = _i < 2 ? 2 : 1;
  want(&o, _i < 2 ? "longest" : "length");
  o.max_length = _i < 2 ? 0 : 1.01 * thr_frame_total_length(&one);
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  int cords[2] = {0};
  for (int i = 0; i < p.n_cords; i++)
    cords[p.cord[i].component]++;
  ck_assert_int_eq(cords[0], 2);
  ck_assert_int_eq(cords[1], _i < 2 ? 2 : 1);
  assert_lies_are_refused(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&one);
  thr_frame_destroy(&other);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- memory ---- */

/* Each of the first thousand; of the many after those, which loops make again and again, one in
 * every hundredth of what is behind. */
START_TEST(every_allocation_may_fail)
{
  thr_frame ring = ring_make(3), path = path_make(3), wheel = wheel_make(3), grid = grid_make(3, 3),
            pieces = triangles_make(2);
  const thr_frame *f = _i == 0   ? &ring
                       : _i == 1 ? &path
                       : _i == 2 ? &wheel
                       : _i == 5 ? &pieces
                                 : &grid; /* which is too large for an integer programme */
  thr_request o = options_for(_i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  thr_status st = THR_ENOMEM;
  o.joint = THR_JOINT_TUBE;
  o.cords = o.cords_least = 2;
  want(&o, _i > 0 && _i < 3 ? "longest" : "length");
  if (_i > 2) o.cords = 1000, o.cords_least = 1, o.max_length = 8;
  for (long k = 1; st == THR_ENOMEM; k += k < 1000 ? 1 : k / 100) {
    thr_plan p;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = length_plan(f, &o, &(thr_limits){0}, &p, NULL, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_ENOMEM, "allocation %ld: %s", k,
                  err.text);
    ck_assert(st != THR_ENOMEM || (!p.cord && p.n_cords == 0 && !p.proof.tied.node));
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&ring);
  thr_frame_destroy(&path);
  thr_frame_destroy(&wheel);
  thr_frame_destroy(&grid);
  thr_frame_destroy(&pieces);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tube_cords");
  ADD_EXAMPLES(s, 120, closed_cords_by_enumeration, 6);
  ADD_EXAMPLES(s, 120, even_cords_by_enumeration, 8);
  ADD_EXAMPLES(s, 120, limited_cords_by_enumeration, 8);
  ADD_TEST(s, 20, a_ring_takes_a_round_for_every_cord);
  ADD_EXAMPLES(s, 60, cords_of_grids_are_even, 6);
  ADD_EXAMPLES(s, 60, cords_of_grids_keep_to_a_limit, 6);
  ADD_EXAMPLES(s, 30, pieces_have_cords_of_their_own, 4);
  ADD_EXAMPLES(s, 300, every_allocation_may_fail, 6);
  return run_suite(s);
}
