/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objective "tortuosity" as a whole: what the length slack is measured from, the trade-off, and
 * what is said of a plan that is not proved. */
#include "graph/number.h"
#include "graph/check/check.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <string.h>

/* A bar 0-1-2 with a leg 1-3. */
static thr_frame tee_make(void)
{
  static const double xyz[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  static const int edge[][2] = {{0, 1}, {1, 2}, {1, 3}};
  return frame_make(4, xyz, 3, edge, NULL, NULL);
}

/* ---- the shortest plan with so many open cords ---- */

typedef struct {
  const thr_frame *f;
  const bool *end_allowed;
  int cords, most_passes;
  bool crowds; /* a node holds any number of ends */
  int passes[16];
  double best;
} oracle;

/* So many passes hold 2 * cords ends if every node has a number of ends between what it needs (for
 * parity, and as partners of an edge with more passes than all others there) and its passes: then
 * every node can be paired without U-turns, and cords that meet can be joined or not as one likes.
 */
static bool holds_cords(const oracle *o)
{
  int least = 0, most = 0;
  for (int v = 0; v < o->f->n_nodes; v++) {
    int sum = 0, largest = 0;
    for (int i = o->f->first[v]; i < o->f->first[v + 1]; i++) {
      int p = o->passes[o->f->half[i] >> 1];
      sum += p;
      largest = p > largest ? p : largest;
    }
    int need = thr_degree(o->f, v) > 1 && 2 * largest > sum ? 2 * largest - sum : sum % 2;
    if (need > 0 && !o->end_allowed[v]) return false;
    if (!o->end_allowed[v]) continue;
    least += need;
    most += sum;
  }
  return least <= 2 * o->cords && (o->crowds || 2 * o->cords <= most);
}

static void try_passes(oracle *o, int e, double length)
{
  if (length >= o->best) return;
  if (e == o->f->n_edges) {
    if (holds_cords(o)) o->best = length;
    return;
  }
  for (o->passes[e] = 1; o->passes[e] <= o->most_passes; o->passes[e]++)
    try_passes(o, e + 1, length + o->passes[e] * o->f->length[e]);
}

/* Few nodes where cords may end and many cords: often more ends than the shortest passes hold. */
START_TEST(slack_is_measured_from_the_shortest_open_cords)
{
  rng r = rng_make((uint64_t)_i + 1);
  int equal = 0, asked = 0, crowded = 0;
  for (int k = 0; k < 12; k++) {
    int n = rng_between(&r, 2, 5);
    thr_frame f = random_frame(&r, n, rng_below(&r, 3), k % 2 ? LENGTHS_EUCLID : LENGTHS_EQUAL);
    thr_least_options o = thr_least_options_default();
    thr_limits limits = {0};
    thr_least l;
    thr_err err = {0};
    bool end[8] = {false};
    for (int i = rng_between(&r, 1, 2); i > 0; i--)
      end[rng_below(&r, n)] = true;
    o.request.ends = THR_ENDS_NODES;
    o.request.end_node = end;
    o.request.cords = rng_between(&r, 1, 4);
    o.length_slack = 0;
    oracle best = {
        .f = &f, .end_allowed = end, .cords = o.request.cords, .most_passes = 8, .best = INFINITY};
    oracle crowds = best;
    crowds.crowds = true;
    try_passes(&best, 0, 0);
    try_passes(&crowds, 0, 0);
    crowded += crowds.best < best.best;
    thr_status st = thr_least_turning(&f, &o, &limits, &l, &err);
    if (st == THR_EINFEASIBLE) {
      ck_assert_msg(isinf(best.best), "%s, but %g is possible", err.text, best.best);
    } else {
      ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
      ck_assert_double_ge(l.shortest, best.best * (1 - 1e-9));
      ck_assert_double_ge(l.length, best.best * (1 - 1e-9));
      ck_assert_double_le(l.length, l.shortest * (1 + 1e-9));
      asked++;
      equal += l.shortest <= best.best * (1 + 1e-9);
    }
    thr_least_destroy(&l);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(10 * equal, 9 * asked);
  ck_assert_int_gt(crowded, 0);
}
END_TEST

/* ---- whole plans ---- */

static thr_status make_plan(const thr_frame *f, int cords, double slack, thr_plan *p, thr_err *err)
{
  thr_request o = thr_request_default();
  const thr_limits limits = {0};
  want(&o, "turning");
  o.ends = THR_ENDS_CLOSED;
  o.cords = o.cords_least = cords;
  o.turning.length_slack = slack;
  return thr_tortuosity_plan(f, &o, &limits, p, err);
}

/* By hand: along the bar and back, and from one of its ends to the leg's and back. Of few edges all
 * sets of cords are tried. */
START_TEST(several_cords_through_few_edges_are_proved)
{
  thr_frame f = tee_make();
  thr_plan p;
  thr_err err = {0};
  assert_ok(make_plan(&f, 2, -1, &p, &err), &err);
  ck_assert_double_eq_tol(p.metrics.turning, 5 * THR_PI, 1e-6);
  ck_assert_double_eq_tol(p.metrics.length, 8, 1e-9);
  ck_assert_double_eq_tol(p.turning.lower_bound, 5 * THR_PI, 1e-6);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The same with arms of five edges: the bound does not know that there must be two cords. */
START_TEST(the_reason_why_it_is_not_proved)
{
  enum { ARM = 5, N = 1 + 3 * ARM };
  static const double way[3][2] = {{-1, 0}, {1, 0}, {0, 1}};
  double xyz[N][3] = {{0}};
  int edge[N - 1][2];
  for (int k = 1; k < N; k++) {
    int arm = (k - 1) / ARM, along = (k - 1) % ARM + 1;
    for (int c = 0; c < 2; c++)
      xyz[k][c] = along * way[arm][c];
    edge[k - 1][0] = along == 1 ? 0 : k - 1;
    edge[k - 1][1] = k;
  }
  thr_frame f = frame_make(N, (const double(*)[3])xyz, N - 1, (const int(*)[2])edge, NULL, NULL);
  thr_plan p;
  thr_err err = {0};
  assert_status(make_plan(&f, 2, -1, &p, &err), THR_ELIMIT, &err,
                "what it costs to have no fewer cords is not part of the bound");
  ck_assert_double_eq_tol(p.metrics.turning, 5 * THR_PI, 1e-6);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The shortest passes round a ring hold one closed cord. A second one turns back at both ends of an
 * edge, which the search for little turning does not know: the shortest cords are the plan, 3 + 2
 * long, and nothing is claimed of their turning. */
START_TEST(more_cords_than_the_shortest_passes_hold)
{
  thr_frame f = ring_make(3);
  thr_plan p;
  thr_err err = {0};
  assert_status(make_plan(&f, 2, 0, &p, &err), THR_ELIMIT, &err,
                "nothing is proved of the turning");
  ck_assert_double_eq_tol(p.metrics.length, 5, 1e-9);
  ck_assert_double_eq_tol(p.metrics.turning, 4 * THR_PI, 1e-6);
  ck_assert(p.proof.optimal && !p.proof.slack_open && !p.turning.present);
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- the trade-off ---- */

static thr_status sweep(const thr_frame *f, int cords, thr_frontier *out, thr_err *err)
{
  thr_request o = thr_request_default();
  const thr_limits limits = {0};
  want(&o, "turning");
  o.ends = THR_ENDS_CLOSED;
  o.cords = cords;
  return thr_tortuosity_frontier(f, &o, 4, &limits, out, err);
}

START_TEST(trade_off_begins_at_the_shortest_plan)
{
  thr_frame f = tee_make();
  thr_frontier out;
  thr_err err = {0};
  assert_status(sweep(&f, 2, &out, &err), THR_ELIMIT, &err, "no fewer cords");
  ck_assert_int_eq(out.n, 1); /* the shortest turns least */
  ck_assert_double_eq_tol(out.point[0].length, 8, 1e-9);
  ck_assert_ptr_nonnull(out.point[0].open);
  thr_frontier_destroy(&out);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(trade_off_without_any_plan)
{
  thr_frame f = ring_make(3);
  thr_frontier out;
  thr_err err = {0};
  ck_assert_int_eq(sweep(&f, 9, &out, &err), THR_EINFEASIBLE); /* 8 passes over an edge */
  assert_one_line(&err, "no plan was found");
  ck_assert_ptr_null(out.point);
  thr_frame_destroy(&f);
}
END_TEST

/* More open cords than the one node for their ends holds; a second closed cord; the trade-off. */
START_TEST(running_out_of_memory_leaves_nothing)
{
  thr_frame f = path_make(2);
  static bool end[] = {true, false};
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_status st = THR_ENOMEM;
  o.length_slack = 0;
  o.request.cords = 2 + (_i == 0);
  o.request.ends = _i == 0 ? THR_ENDS_NODES : THR_ENDS_CLOSED;
  o.request.end_node = end;
  for (long k = 1; st == THR_ENOMEM; k++) {
    thr_least l = {0};
    thr_frontier out = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = _i < 2 ? thr_least_turning(&f, &o, &limits, &l, &err) : sweep(&f, 2, &out, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_ENOMEM, "allocation %ld: %d %s", k,
                  (int)st, err.text);
    ck_assert(st != THR_ENOMEM || (!l.cord && !out.point));
    thr_least_destroy(&l);
    thr_frontier_destroy(&out);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* What is reported on the way: reports, and how many had a bound above the best price. */
typedef struct {
  int reports, above;
} heard;

static void hear(void *user, const char *what, double best, double bound)
{
  heard *h = user;
  if (strcmp(what, "turning") != 0) return;
  h->reports++;
  h->above += bound > best;
}

START_TEST(no_bound_is_reported_above_the_best_price)
{
  heard h = {0};
  thr_limits limits = {.progress = hear, .user = &h};
  for (uint64_t seed = 0; seed < 400; seed++) {
    rng r = rng_make(seed);
    thr_frame f = random_frame(&r, 14, 12, LENGTHS_EUCLID);
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    thr_plan p;
    want(&o, "turning");
    ck_assert_int_eq(thr_tortuosity_plan(&f, &o, &limits, &p, NULL), THR_OK);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
  ck_assert_msg(h.reports > 60 && h.above == 0, "%d of %d", h.above, h.reports);
}
END_TEST

/* A cord turns back only where there is one edge: with closed cords at each of these nodes for
 * every two passes, begun ones too; two of them can be the ends of an open cord instead. */
START_TEST(fewest_u_turns)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f =
      random_frame(&r, rng_between(&r, 4, 12), rng_below(&r, 6), (length_kind)(_i % LENGTH_KINDS));
  int leaves = 0;
  for (int v = 0; v < f.n_nodes; v++)
    leaves += thr_degree(&f, v) == 1;
  for (int k = 0; k < 4; k++) {
    thr_request o = options_for(k < 3 ? THR_ENDS_CLOSED : THR_ENDS_ANY, k < 3 ? k + 1 : 1);
    thr_plan p;
    thr_err err = {0};
    ck_assert_int_eq(thr_aims_parse("turning:uturn", &o, &err), THR_OK);
    assert_ok(thr_tortuosity_plan(&f, &o, &(thr_limits){0}, &p, &err), &err);
    ck_assert(p.turning.optimal);
    ck_assert_double_eq(p.turning.price,
                        k < 3 ? leaves * ((k + 2) / 2) : leaves - (leaves < 2 ? leaves : 2));
    ck_assert_double_eq(p.turning.price, p.metrics.u_turns);
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tortuosity");
  ADD_LOOP(s, 60, slack_is_measured_from_the_shortest_open_cords, 0, 8);
  ADD_TEST(s, 20, several_cords_through_few_edges_are_proved);
  ADD_TEST(s, 20, the_reason_why_it_is_not_proved);
  ADD_TEST(s, 20, more_cords_than_the_shortest_passes_hold);
  ADD_TEST(s, 20, trade_off_begins_at_the_shortest_plan);
  ADD_TEST(s, 20, trade_off_without_any_plan);
  ADD_TEST(s, 60, no_bound_is_reported_above_the_best_price);
  ADD_LOOP(s, 60, fewest_u_turns, 0, 30);
  ADD_LOOP(s, 60, running_out_of_memory_leaves_nothing, 0, 3);
  return run_suite(s);
}
