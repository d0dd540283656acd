/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords that turn evenly, tied cords that turn least, and given numbers of ends that differ from
 * piece to piece, of random small frameworks against all walks (tests/walks.h). */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/judging.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 10, MOST_NODES = 8, MOST_STATES = 400000, MOST_EXTRA = 2 };

/* ---- what holds for every plan ---- */

typedef struct {
  int asked, found, possible, least, optimal;
} tally;

/* Tells whether the cords of some plan no longer than longest turn by at_most in all, or, if
 * largest, by at_most each. */
static bool is_possible(const judged *j, bool largest, double longest, double at_most)
{
  if (largest && at_most < 0) return false;
  const double least = judged_least_turning(j, longest, largest ? at_most : -1);
  ck_assert(!isnan(least));
  return least <= (largest ? 0 : at_most);
}

/* Never below the least of all, never a bound above it, never a false claim; how often the plan is
 * the least is counted. */
static void compare(const thr_frame *f, const thr_request *o, tally *t)
{
  const thr_limits none = {0};
  thr_plan p;
  thr_err err = {0};
  thr_request few = *o; /* within a length short edges would have too many passes to try */
  const bool largest = thr_wants_largest(o);
  few.capacity = o->turning.length_slack < 0 ? 0 : o->cover + MOST_EXTRA;
  const judged all = judged_of(f, &few, MOST_STATES);
  thr_status st = thr_tortuosity_plan(f, o, &none, &p, &err);
  t->asked++;
  if (st == THR_EINFEASIBLE) {
    assert_one_line(&err, NULL);
    if (o->turning.length_slack < 0) t->possible += is_possible(&all, false, INFINITY, DBL_MAX);
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  if (!p.turning.present) { /* the shortest cords, of whose turning nothing is claimed */
    ck_assert_int_eq(st, THR_ELIMIT);
    ck_assert(o->turning.length_slack >= 0);
    thr_plan_destroy(&p);
    return;
  }
  const double value = largest ? p.turning.largest : p.turning.price,
               bound = largest ? p.turning.largest_bound : p.turning.lower_bound,
               limit = p.turning.length_limit < 0 ? (double)INFINITY
                                                  : p.turning.length_limit * (1 + 1e-9);
  const bool optimal = largest ? p.turning.largest_optimal : p.turning.optimal,
             least = !is_possible(&all, largest, limit, value - 1e-6);
  if (few.capacity == 0 || p.metrics.most_passes <= few.capacity)
    ck_assert(is_possible(&all, largest, limit, value + 1e-6)); /* it finds the plan */
  ck_assert(!is_possible(&all, largest, limit, bound - 1e-6));
  ck_assert(!optimal || least);
  ck_assert_int_eq(optimal && !p.proof.slack_open, st == THR_OK);
  t->found++;
  t->possible++;
  t->least += least;
  t->optimal += optimal;
  thr_plan_destroy(&p);
}

static thr_request request(rng *r, thr_joint joint, thr_ends ends, int cords, bool largest)
{
  thr_request o = options_for(ends, 1);
  want(&o, "turning");
  o.joint = joint;
  o.cords = o.cords_least = cords;
  if (largest) want(&o, "max-turning");
  o.turning.cost = (thr_turn_cost)(rng_below(r, 4) ? 0 : rng_between(r, 1, 2));
  o.turning.length_slack = rng_below(r, 4) ? -1 : rng_below(r, 2) * 0.1;
  return o;
}

/* 1 to 3 cords, ends of every kind, tied or not. */
START_TEST(cords_are_least)
{
  static const thr_ends kind[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 1);
  tally t = {0};
  for (int k = 0; k < 48; k++) {
    thr_frame f = random_frame(&r, rng_between(&r, 3, 4), rng_between(&r, 1, 2), LENGTHS_EUCLID);
    bool largest = k % 4 > 0;
    thr_request o =
        request(&r, k % 5 ? THR_JOINT_TUBE : THR_JOINT_SOLID, kind[_i % 3], 1 + k % 3, largest);
    compare(&f, &o, &t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_eq(t.found, t.possible);
  ck_assert_int_gt(t.found, 8);
  ck_assert_int_ge(20 * t.least, 19 * t.found - 19);
  ck_assert_int_gt(2 * t.optimal, t.found / 2);
}
END_TEST

/* A tree of n nodes on the points of a lattice, each a step from another; neighbours are joined now
 * and then, too. */
static thr_frame lattice_frame(rng *r, int n)
{
  double xyz[MOST_NODES][3] = {{0}};
  int edge[MOST_EDGES][2], feet[2] = {rng_below(r, n), -1}, m = 0;
  for (int v = 1; v < n;) {
    const int from = rng_below(r, v), axis = rng_below(r, 3);
    bool free_place = true;
    memcpy(xyz[v], xyz[from], sizeof xyz[v]);
    xyz[v][axis] += rng_below(r, 2) ? 10 : -10;
    for (int u = 0; u < v; u++)
      free_place = free_place && memcmp(xyz[u], xyz[v], sizeof xyz[v]) != 0;
    if (!free_place) continue;
    edge[m][0] = from;
    edge[m++][1] = v;
    for (int u = 0; u < v; u++) {
      const double apart =
          fabs(xyz[u][0] - xyz[v][0]) + fabs(xyz[u][1] - xyz[v][1]) + fabs(xyz[u][2] - xyz[v][2]);
      if (u == from || apart > 10 || rng_below(r, 2)) continue;
      edge[m][0] = u;
      edge[m++][1] = v;
    }
    v++;
  }
  return frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, feet);
}

/* Where all turns are right angles bounds are rounded up to them, and never above the truth. */
START_TEST(right_angles_are_counted)
{
  static const thr_ends kind[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 300);
  tally t = {0};
  for (int k = 0; k < 24; k++) {
    thr_frame f = lattice_frame(&r, rng_between(&r, 3, 5));
    thr_request o = request(&r, THR_JOINT_SOLID, kind[_i % 3], 1 + k % 3, k % 4 > 0);
    if (f.n_edges <= 5) compare(&f, &o, &t);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(t.found, 4);
  ck_assert_int_gt(2 * t.optimal, t.found);
}
END_TEST

/* Two pieces with other numbers of cord ends at their nodes. */
START_TEST(given_ends_in_every_piece)
{
  rng r = rng_make((uint64_t)_i + 100);
  tally t = {0};
  for (int k = 0; k < 8; k++) {
    thr_frame a = k % 2 ? ring_make(3) : path_make(3), b = random_frame(&r, 3, 1, LENGTHS_EUCLID),
              f = side_by_side(&a, &b);
    int end_count[MOST_NODES] = {0}, cords[2] = {1 + k / 4 % 2, 1 + k / 2 % 2};
    thr_request o =
        request(&r, k % 3 ? THR_JOINT_SOLID : THR_JOINT_TUBE, THR_ENDS_COUNTS, 1, _i % 2);
    for (int n = 2 * cords[0]; n > 0; n--)
      end_count[k % 2 ? rng_below(&r, 3) : 2 * (n % 2)]++;
    for (int n = 2 * cords[1]; n > 0; n--)
      end_count[3 + rng_below(&r, 3)]++;
    o.end_count = end_count;
    o.cords = cords[0] > cords[1] ? cords[0] : cords[1];
    o.cords_least = cords[0] + cords[1] - o.cords;
    compare(&f, &o, &t);
    thr_frame_destroy(&a);
    thr_frame_destroy(&b);
    thr_frame_destroy(&f);
  }
  ck_assert_int_eq(t.found, t.possible);
  ck_assert_int_ge(t.least, t.found - 1);
  ck_assert_int_gt(t.found, 2);
}
END_TEST

/* ---- larger ones ---- */

static thr_plan solve(const thr_frame *f, const thr_request *o)
{
  const thr_limits none = {0};
  thr_plan p;
  thr_err err = {0};
  thr_status st = thr_tortuosity_plan(f, o, &none, &p, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  return p;
}

/* Tied domes: as many cords as asked for, none turns less than its share of the bound, and what is
 * made small is not larger than where the sum is; four cords, one from each side, attain the bound.
 */
START_TEST(domes_are_tied_and_evened_out)
{
  rng r = rng_make(1);
  thr_frame f = shape_make(THR_MAKE_DOME, 4, 0);
  thr_request o =
      request(&r, THR_JOINT_TUBE, _i < 4 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1 + _i % 4, false);
  o.turning.cost = THR_TURN_ANGLE;
  o.turning.length_slack = -1;
  thr_plan sum = solve(&f, &o);
  want(&o, "max-turning");
  thr_plan even = solve(&f, &o);
  ck_assert_int_eq(even.n_cords, o.cords);
  ck_assert_double_ge(even.turning.largest, even.turning.largest_bound * (1 - 1e-9));
  ck_assert_double_le(even.turning.largest, sum.turning.largest * (1 + 1e-9));
  ck_assert_double_eq_tol(even.turning.lower_bound, sum.turning.lower_bound, 1e-6);
  if (_i == 3) ck_assert(even.turning.largest_optimal);
  thr_plan_destroy(&sum);
  thr_plan_destroy(&even);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- lies ---- */

static void assert_refused(const thr_plan *p, const char *word)
{
  thr_err err = {0};
  assert_status(judge_plan(p, &err), THR_EVIOLATED, &err, word);
}

START_TEST(false_claims_are_refused)
{
  rng r = rng_make(2);
  thr_frame a = ring_make(3), b = solid_make(TETRAHEDRON), f = side_by_side(&a, &b);
  int end_count[7] = {2, 0, 0, 1, 2, 1, 0};
  thr_request o = request(&r, _i ? THR_JOINT_TUBE : THR_JOINT_SOLID, THR_ENDS_COUNTS, 2, true);
  o.end_count = end_count;
  o.cords_least = 1;
  thr_plan p = solve(&f, &o);
  ck_assert_int_eq(p.n_cords, 3);
  bool optimal = p.turning.largest_optimal;
  p.turning.largest_bound *= optimal ? 0.99 : 1;
  p.turning.largest_optimal = true;
  assert_refused(&p, "proof.turning.largest");
  p.turning.largest_bound /= optimal ? 0.99 : 1;
  p.turning.largest_optimal = optimal;
  p.turning.largest_bound *= 1.01;
  assert_refused(&p, "largest.lower_bound");
  p.turning.largest_bound /= 1.01;
  p.options.cords_least = 2;
  assert_refused(&p, "component 0: has 1 cord");
  p.options.cords_least = 1;
  p.options.end_count[0]--;
  p.options.end_count[1]++;
  assert_refused(&p, "the plan's options say");
  thr_plan_destroy(&p);
  thr_frame_destroy(&a);
  thr_frame_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- memory ---- */

/* All of the first allocations fail once, and one in twenty of the many later ones. */
START_TEST(running_out_of_memory_leaves_nothing)
{
  static const thr_ends kind[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_COUNTS};
  const thr_limits none = {0};
  rng r = rng_make(3);
  thr_frame f = solid_make(TETRAHEDRON);
  int end_count[4] = {2, 0, 1, 1};
  thr_request o = request(&r, _i < 3 ? THR_JOINT_TUBE : THR_JOINT_SOLID, kind[_i % 3], 2, true);
  thr_status st = THR_ENOMEM;
  o.turning.length_slack = _i % 2 ? 0.5 : -1;
  if (o.ends == THR_ENDS_COUNTS) o.end_count = end_count;
  for (long k = 1; st == THR_ENOMEM; k += 1 + k / 20) {
    thr_plan p = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_tortuosity_plan(&f, &o, &none, &p, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_ENOMEM,
                  "allocation %ld: status %d, %s", k, (int)st, err.text);
    ck_assert(st != THR_ENOMEM || (!p.cord && !p.turning.tree.node));
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("cords that turn evenly");
  ADD_EXAMPLES(s, 120, cords_are_least, 12);
  ADD_EXAMPLES(s, 120, right_angles_are_counted, 3);
  ADD_EXAMPLES(s, 60, given_ends_in_every_piece, 24);
  ADD_EXAMPLES(s, 120, domes_are_tied_and_evened_out, 7);
  ADD_EXAMPLES(s, 20, false_claims_are_refused, 2);
  ADD_EXAMPLES(s, 120, running_out_of_memory_leaves_nothing, 6);
  return run_suite(s);
}
