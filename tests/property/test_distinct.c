/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several different cords over every edge, against all choices of the edges that each cord passes;
 * and what the checker makes of claims about them. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/planner.h"
#include "tests/attack.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the oracle ---- */

enum { MOST_EDGES = 6, SETS = 1 << MOST_EDGES, MOST_NODES = 7 };

/* least[set]: of one cord over all these edges and perhaps others, closed or between nodes where
 * one may end, turning back anywhere. (Bellman's iteration over node and set, from every node.) */
static void least_of_one(const thr_frame *f, const thr_request *o, double *least)
{
  const bool closed = o->ends == THR_ENDS_CLOSED;
  int sets = 1 << f->n_edges;
  for (int set = 0; set < sets; set++)
    least[set] = INFINITY;
  for (int start = 0; start < f->n_nodes; start++) {
    double far[MOST_NODES][SETS];
    if (!thr_plan_end_allowed(f, o, start)) continue;
    for (int v = 0; v < f->n_nodes; v++)
      for (int set = 0; set < sets; set++)
        far[v][set] = v == start && set == 0 ? 0 : INFINITY;
    for (bool changed = true; changed;) {
      changed = false;
      for (int h = 0; h < 2 * f->n_edges; h++)
        for (int set = 0; set < sets; set++) {
          double length = far[thr_tail(f, h)][set] + f->length[h >> 1],
                 *to = &far[thr_head(f, h)][set | 1 << (h >> 1)];
          if (length >= *to - 1e-12) continue;
          *to = length;
          changed = true;
        }
    }
    for (int v = 0; v < f->n_nodes; v++)
      for (int set = 1; set < sets && (closed ? v == start : thr_plan_end_allowed(f, o, v)); set++)
        for (int part = set; part > 0; part = (part - 1) & set)
          least[part] = fmin(least[part], far[v][set]);
  }
}

/* The least length of so many cords, from set `from` downwards, that pass edge e lacks[e] times
 * more at least; or, if longest, the length of the longest. */
static double least_of_all(int n_edges, const double *least, bool longest, int cords, int from,
                           const int *lacks)
{
  double best = INFINITY;
  bool done = true;
  for (int e = 0; e < n_edges; e++)
    done = done && lacks[e] <= 0;
  if (cords == 0) return done ? 0 : INFINITY;
  for (int set = from; set > 0; set--) {
    int left[MOST_EDGES];
    bool enough = true;
    for (int e = 0; e < n_edges; e++) {
      left[e] = lacks[e] - (set >> e & 1);
      enough = enough && left[e] < cords;
    }
    if (!enough || least[set] >= best) continue;
    double others = least_of_all(n_edges, least, longest, cords - 1, set, left);
    best = fmin(best, longest ? fmax(least[set], others) : least[set] + others);
  }
  return best;
}

static double truth_of(const thr_frame *f, const thr_request *o, bool longest, int cords)
{
  double least[SETS];
  int lacks[MOST_EDGES];
  for (int e = 0; e < MOST_EDGES; e++)
    lacks[e] = o->distinct;
  least_of_one(f, o, least);
  return least_of_all(f->n_edges, least, longest, cords, (1 << f->n_edges) - 1, lacks);
}

static double truth(const thr_frame *f, const thr_request *o)
{
  return truth_of(f, o, false, o->cords);
}

/* ---- plans ---- */

static int edges_met(const thr_plan *p)
{
  int met = 0;
  for (int e = 0; e < p->frame.n_edges && p->options.distinct > 0; e++) {
    int cords = 0;
    for (int i = 0; i < p->n_cords; i++) {
      bool here = false;
      for (int k = 0; k < p->cord[i].n_passes; k++)
        here = here || p->cord[i].half[k] / 2 == e;
      cords += here;
    }
    met += cords >= p->options.distinct;
  }
  return met;
}

static thr_request asked(int distinct, int cords, thr_ends ends, const char *aims)
{
  thr_request o = options_for(ends, distinct);
  o.distinct = distinct;
  o.cords = o.cords_least = cords;
  want(&o, aims);
  return o;
}

static thr_plan made(const thr_frame *f, const thr_request *o)
{
  thr_plan p;
  thr_err err = {0};
  thr_status st = thr_plan_make(f, o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  assert_plan_sound(&p);
  ck_assert_int_eq(p.metrics.distinct, edges_met(&p));
  return p;
}

/* Through few edges the plan is the truth, and proved. */
START_TEST(plans_are_the_truth)
{
  const int examples = share_of(40);
  for (int i = 0; i < examples; i++) {
    rng r = rng_make((uint64_t)i + 1);
    int nodes = rng_between(&r, 3, 5);
    thr_frame f = random_frame(&r, nodes, rng_below(&r, MOST_EDGES - nodes + 2), LENGTHS_RANDOM);
    int distinct = 2 + (i % 5 == 0), cords = distinct + rng_below(&r, 3);
    thr_request o = asked(distinct, cords, i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, "length");
    double least = truth(&f, &o);
    thr_plan p = made(&f, &o);
    ck_assert_int_eq(p.metrics.distinct, f.n_edges);
    ck_assert_double_eq_tol(p.metrics.length, least, 1e-9 * least);
    ck_assert_double_eq_tol(p.proof.lower_bound, least, 1e-9 * least);
    ck_assert(p.proof.optimal);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Bridges need more passes of closed cords than those of different ones; then a tree's least length
 * is always proved. */
START_TEST(trees_are_proved)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 6), 0, LENGTHS_RANDOM);
  int distinct = 2 + _i % 2;
  thr_request o = asked(distinct, distinct + 1 + rng_below(&r, 2), THR_ENDS_CLOSED, "length");
  thr_plan p = made(&f, &o);
  ck_assert_int_eq(p.metrics.distinct, f.n_edges);
  ck_assert_double_eq_tol(p.metrics.length, truth(&f, &o), 1e-9 * p.metrics.length);
  ck_assert(p.proof.optimal);
  p.options.distinct = 0; /* of any cords the certificate is another's */
  p.metrics.distinct = 0;
  assert_violated(&p, NULL);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Passes that a bridge is said to need are those of some cords, and no fewer do: the least length
 * where it alone has one. */
START_TEST(bridges_need_what_is_said)
{
  rng r = rng_make((uint64_t)_i + 400);
  thr_frame f = random_frame(&r, rng_between(&r, 4, 5), rng_below(&r, 2), LENGTHS_RANDOM);
  thr_request o = asked(2, 3, _i % 2 ? THR_ENDS_NODES : THR_ENDS_CLOSED, "length");
  bool end_node[MOST_NODES] = {false}, bridge[MOST_EDGES];
  int *needs;
  for (int v = 0; v < f.n_nodes; v++)
    end_node[v] = v == 0 || rng_below(&r, 3) == 0;
  if (_i % 2) o.end_node = end_node;
  ck_assert_int_eq(thr_frame_bridges(&f, bridge, NULL), THR_OK);
  ck_assert_int_eq(thr_distinct_needs(&f, &o, &needs, NULL), THR_OK);
  for (int e = 0; e < f.n_edges; e++) {
    for (int k = 0; k < f.n_edges; k++)
      f.length[k] = k == e ? 1 : 1e-9;
    double passes = floor(truth(&f, &o) + 0.5);
    ck_assert_int_le(needs ? needs[e] : 2, (int)passes);
    if (bridge[e]) ck_assert_int_eq(needs ? needs[e] : 2, (int)passes);
  }
  free(needs);
  thr_frame_destroy(&f);
}
END_TEST

/* Changes a number of the certificate at random; the sum of its cuts stays theirs. */
static void change_certificate(rng *r, thr_certificate *c)
{
  int by = rng_between(r, -3, 3);
  switch (rng_below(r, 5)) {
  case 0: c->scale *= rng_below(r, 2) ? 2 : 0.5 + rng_unit(r); break;
  case 1: c->denominator = rng_between(r, 1, 4); break;
  case 2: c->end_price += by > 0 ? by : 0; break;
  case 3: c->join += by; break;
  default: break;
  }
  for (int i = 0; i < c->n_cuts; i++)
    if (rng_below(r, 2))
      c->cut[i].value =
          llabs(c->cut[i].value + (int64_t)(by * rng_unit(r) * (double)(1 + c->cut[i].value)));
  c->sum = 0;
  for (int i = 0; i < c->n_cuts; i++)
    c->sum += c->cut[i].value;
}

/* An adversary: whatever its certificate is changed to, no plan proves more than what is true. */
START_TEST(nothing_is_proved_above_the_truth)
{
  enum { ATTACKS = 3000 };
  rng r = rng_make((uint64_t)_i + 500);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 5), rng_below(&r, 2), LENGTHS_RANDOM);
  thr_request o = asked(2, 3, _i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, "length");
  thr_plan p = made(&f, &o);
  const double least = truth(&f, &o), longest = truth_of(&f, &o, true, o.cords), above = 1 + 1e-6;
  ck_assert(p.proof.present && p.proof.n_certificates == 1 && p.metrics.distinct == f.n_edges);
  p.proof.optimal = p.cords_claim.longest_optimal = false;
  for (int i = 0; i < ATTACKS; i++) {
    thr_plan forged = p;
    thr_certificate certificate = p.proof.certificate[0];
    thr_cut cut[64];
    ck_assert_int_le(certificate.n_cuts, 64);
    memcpy(cut, certificate.cut, (size_t)certificate.n_cuts * sizeof *cut);
    certificate.cut = cut;
    change_certificate(&r, &certificate);
    forged.proof.certificate = &certificate;
    if (i % 2)
      forged.cords_claim.longest_bound = longest * above;
    else
      forged.proof.lower_bound = least * above;
    forged.proof.gap = (p.metrics.length - forged.proof.lower_bound) / p.metrics.length;
    ck_assert_int_ne(thr_check_plan(&forged, NULL), THR_OK);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Cords of even length: through few edges the longest is that of the truth, and proved. */
START_TEST(even_cords_are_the_truth)
{
  const int examples = share_of(30);
  for (int i = 0; i < examples; i++) {
    rng r = rng_make((uint64_t)i + 100);
    int nodes = rng_between(&r, 3, 5);
    thr_frame f = random_frame(&r, nodes, rng_below(&r, MOST_EDGES - nodes + 2), LENGTHS_RANDOM);
    const int distinct = 2 + (i % 5 == 0);
    thr_request o = asked(distinct, distinct + rng_below(&r, 3),
                          i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, "longest,length");
    double least = truth_of(&f, &o, true, o.cords);
    thr_plan p = made(&f, &o);
    ck_assert_int_eq(p.metrics.distinct, f.n_edges);
    ck_assert_double_eq_tol(p.cords_claim.longest, least, 1e-9 * least);
    ck_assert_double_eq_tol(p.cords_claim.longest_bound, least, 1e-9 * least);
    ck_assert(p.cords_claim.longest_optimal);
    p.cords_claim.longest_bound *= 1 + 1e-6;
    p.cords_claim.longest_optimal = false;
    assert_violated(&p, NULL);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A plan whose longest cord is longer than that of another is not said to be the best, whatever it
 * says. */
START_TEST(longer_cords_are_not_the_truth)
{
  int longer = 0;
  for (int i = 0; i < 10; i++) {
    rng r = rng_make((uint64_t)i + 300);
    thr_frame f = random_frame(&r, rng_between(&r, 4, 5), 2, LENGTHS_RANDOM);
    thr_request o = asked(2, 4, i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, "length"),
                even = asked(2, 4, o.ends, "longest,length");
    const double least = truth_of(&f, &o, true, o.cords);
    thr_plan p = made(&f, &o);
    ck_assert_int_eq(p.metrics.distinct, f.n_edges);
    p.options.aims = even.aims;
    if (p.cords_claim.longest > least * (1 + 1e-6)) {
      longer++;
      p.cords_claim.longest_bound = p.cords_claim.longest;
      p.cords_claim.longest_optimal = true;
      assert_violated(&p, NULL);
      p.cords_claim.longest_optimal = false;
      p.cords_claim.longest_bound = least * (1 + 1e-6);
      assert_violated(&p, NULL);
      p.cords_claim.longest_bound = least * (1 - 1e-9);
      assert_holds(&p);
    }
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
  ck_assert_int_ge(longer, 3);
}
END_TEST

/* Fewest of so many cords, none longer than the limit: INT_MAX if there are none. */
static int fewest_within(const thr_frame *f, const thr_request *o)
{
  for (int cords = o->cords_least; cords <= o->cords; cords++)
    if (truth_of(f, o, true, cords) <= o->max_length) return cords;
  return INT_MAX;
}

/* Cords of limited length: as many as the truth or more, and its bound is not above. */
START_TEST(short_cords_are_few)
{
  const int examples = share_of(10);
  int attained = 0, feasible = 0;
  for (int i = 0; i < examples; i++) {
    rng r = rng_make((uint64_t)i + 200);
    thr_frame f = random_frame(&r, rng_between(&r, 3, 4), rng_below(&r, 2), LENGTHS_RANDOM);
    thr_request o = asked(2, 4, i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, "length");
    thr_err err = {0};
    thr_plan p;
    o.cords_least = 2;
    o.max_length = thr_frame_total_length(&f) * (0.6 + rng_unit(&r));
    int fewest = fewest_within(&f, &o);
    thr_status st = thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, &err);
    feasible += fewest < INT_MAX;
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || (st == THR_EINFEASIBLE && fewest == INT_MAX),
                  "%s", err.text);
    if (p.n_cords > 0) {
      assert_plan_sound(&p);
      ck_assert_int_le(p.cords_claim.fewest, fewest);
      if (p.metrics.distinct == f.n_edges) ck_assert_int_ge(p.n_cords, fewest);
      if (p.cords_claim.fewest_optimal) ck_assert_int_eq(p.n_cords, fewest);
      attained += p.metrics.distinct == f.n_edges && p.n_cords == fewest;
    }
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
  ck_assert_msg(10 * attained >= 8 * feasible, "%d of %d are the fewest", attained, feasible);
}
END_TEST

/* Cords within a limit on the pull, and symmetric ones. */
START_TEST(other_wishes_are_kept)
{
  thr_frame f = grid_make(3, 3);
  thr_request o = asked(2, 5, THR_ENDS_ANY, _i < 2 ? "length" : "overlap,steps");
  o.cords_least = 2;
  if (_i % 2) o.max_pull = 3;
  o.symmetry.counted = _i == 3;
  thr_plan p = made(&f, &o);
  ck_assert_int_eq(p.metrics.distinct, f.n_edges);
  ck_assert_int_eq(p.symmetry.present, _i >= 2);
  ck_assert(thr_cords_within_pull(&f, &o, p.cord, p.n_cords));
  if (p.pull_claim.present) {
    p.pull_claim.fewest = p.n_cords + 1;
    assert_violated(&p, "pull");
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Of solids, where every edge can have its cords without more length. */
START_TEST(solids_need_no_more_cord)
{
  static const char *const aims[] = {"length", "turning", "max-turning"};
  static const int cords[] = {4, 4, 3, 4, 5};
  for (int s = TETRAHEDRON; s <= ICOSAHEDRON; s++) {
    thr_frame f = solid_make((solid)s);
    thr_request o = asked(2, cords[s], THR_ENDS_CLOSED, aims[_i]);
    thr_plan p = made(&f, &o);
    ck_assert_int_eq(p.metrics.distinct, f.n_edges);
    ck_assert(_i > 0 || p.proof.optimal);
    ck_assert_double_eq_tol(p.metrics.length, 2 * f.n_edges, 1e-9);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- the checker ---- */

START_TEST(false_claims_are_refused)
{
  thr_frame f = grid_make(3, 3);
  thr_request o = asked(2, 3, THR_ENDS_CLOSED, "length");
  thr_plan p = made(&f, &o);
  thr_err err = {0};
  ck_assert_int_eq(p.metrics.distinct, f.n_edges);
  ck_assert(p.proof.optimal);
  p.metrics.distinct--;
  assert_violated(&p, "distinct");
  p.metrics.distinct += 2;
  assert_violated(&p, "distinct");
  p.metrics.distinct--;
  p.options.distinct = 3; /* of three cords, with two passes: not a request */
  ck_assert_int_eq(judge_plan(&p, &err), THR_EINPUT);
  p.options.distinct = 2;
  assert_holds(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Cords of a plan that was not asked for different ones: nothing may be said to be the least. */
START_TEST(the_least_needs_all_edges)
{
  thr_frame f = grid_make(3, 3);
  thr_request o = asked(2, 3, THR_ENDS_CLOSED, "length");
  o.distinct = 0;
  thr_plan p;
  ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, NULL), THR_OK);
  ck_assert(p.proof.optimal);
  p.options.distinct = 2;
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                   THR_OK);
  ck_assert_int_eq(p.metrics.distinct, edges_met(&p));
  if (p.metrics.distinct < f.n_edges) {
    assert_violated(&p, "optimal");
    p.proof.optimal = p.cords_claim.longest_optimal = false;
    assert_holds(&p);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* As many cords as every edge needs: the proof is one of each. */
START_TEST(alike_cords_have_the_proof_of_one)
{
  static const char *const aims[] = {"length", "turning", "max-turning"};
  thr_frame f = grid_make(3, 3);
  thr_request o = asked(3, 3, _i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, aims[_i / 2]), one = o;
  one.distinct = 0;
  one.cover = one.cords = one.cords_least = 1;
  thr_plan p = made(&f, &o), single = made(&f, &one);
  ck_assert_double_eq_tol(p.metrics.length, 3 * single.metrics.length, 1e-9);
  ck_assert_double_eq_tol(p.proof.lower_bound, 3 * single.proof.lower_bound, 1e-9);
  ck_assert_int_eq(p.proof.optimal, single.proof.optimal);
  ck_assert_int_eq(p.turning.largest_optimal, single.turning.largest_optimal);
  p.proof.lower_bound *= 1 + 1e-6;
  assert_violated(&p, NULL);
  p.proof.lower_bound /= 1 + 1e-6;
  if (p.turning.present) {
    p.turning.largest_bound *= 1 + 1e-6;
    assert_violated(&p, "largest");
    p.turning.largest_bound /= 1 + 1e-6;
    p.turning.lower_bound *= 1 + 1e-6;
    assert_violated(&p, "lower_bound");
  }
  thr_plan_destroy(&p);
  thr_plan_destroy(&single);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- an adversary ---- */

enum { PIECES = 2, MOST_CUTS = 16 };

/* A plan with words of its own; frame and cords are borrowed, and so are the nodes of cuts. */
typedef struct {
  thr_plan plan;
  thr_certificate certificate[PIECES];
  thr_cut cut[PIECES][MOST_CUTS];
} forgery;

/* Does the plan fit a forgery? If so that is it, as it stands. */
static bool forge(const thr_plan *p, forgery *x)
{
  memset(x, 0, sizeof *x);
  x->plan = *p;
  if (p->proof.n_certificates > PIECES) return false;
  for (int k = 0; k < p->proof.n_certificates; k++) {
    x->certificate[k] = p->proof.certificate[k];
    if (x->certificate[k].n_cuts > MOST_CUTS) return false;
    for (int i = 0; i < x->certificate[k].n_cuts; i++)
      x->cut[k][i] = x->certificate[k].cut[i];
  }
  return true;
}

static void change_numbers(rng *r, forgery *x)
{
  if (x->plan.proof.n_certificates == 0) return;
  const int k = rng_below(r, x->plan.proof.n_certificates);
  thr_certificate *c = &x->certificate[k];
  c->cut = x->cut[k];
  if (rng_below(r, 4))
    change_certificate(r, c);
  else if (rng_below(r, 2))
    c->denominator = 1 + (int64_t)fmin(1e12, (double)c->denominator * attack_factor(r));
  else
    c->end_price = attack_integer(r);
}

static void change_forgery(rng *r, const void *target, void *what)
{
  static const double part[] = {1 + 1e-10, 1 + 1e-8, 1 + 1e-6, 1.001, 1.1, 2, .9};
  const thr_plan *p = target;
  forgery *x = what;
  thr_plan *y = &x->plan;
  switch (rng_below(r, 9)) {
  case 0:
  case 1: change_numbers(r, x); break;
  case 2: y->proof.lower_bound *= part[rng_below(r, 7)]; break;
  case 3: y->cords_claim.longest_bound *= part[rng_below(r, 7)]; break;
  case 4: y->proof.optimal = rng_below(r, 2); break;
  case 5: y->cords_claim.longest_optimal = rng_below(r, 2); break;
  case 6: y->metrics.distinct = rng_between(r, 0, p->frame.n_edges); break;
  case 7: y->options.distinct = y->options.cover = rng_between(r, 2, 3); break;
  default: y->options.cords_least = rng_between(r, 2, y->options.cords); break;
  }
  y->proof.gap = (y->metrics.length - y->proof.lower_bound) / y->metrics.length;
}

/* How far what is said, and accepted, is above the truth. */
static double judge_forgery(const void *target, const void *what)
{
  const forgery *x = what;
  thr_plan p = x->plan;
  thr_certificate certificate[PIECES];
  thr_cut cut[PIECES][MOST_CUTS];
  (void)target;
  memcpy(cut, x->cut, sizeof cut);
  for (int k = 0; k < p.proof.n_certificates; k++) {
    certificate[k] = x->certificate[k];
    certificate[k].cut = cut[k];
    certificate[k].sum = 0;
    for (int i = 0; i < certificate[k].n_cuts; i++)
      certificate[k].sum += cut[k][i].value;
  }
  p.proof.certificate = certificate;
  if (thr_check_plan(&p, NULL)) return -INFINITY;
  double least = INFINITY, longest = INFINITY;
  for (int n = p.options.cords_least; n <= p.options.cords; n++) {
    least = fmin(least, truth_of(&p.frame, &p.options, false, n));
    longest = fmin(longest, truth_of(&p.frame, &p.options, true, n));
  }
  if (p.metrics.distinct != edges_met(&p)) return 1;
  double above = p.proof.present ? p.proof.lower_bound / least - 1 : -1;
  if (p.proof.optimal) above = fmax(above, p.metrics.length / least - 1);
  if (!p.cords_claim.present) return above;
  if (p.cords_claim.longest_optimal) above = fmax(above, p.cords_claim.longest / longest - 1);
  return fmax(above, p.cords_claim.longest_bound / longest - 1);
}

static const attack_kind of_forgeries = {sizeof(forgery), change_forgery, judge_forgery, 4e-9};

START_TEST(no_forged_claim_of_different_cords_is_accepted)
{
  enum { STEPS = 150 };
  attack_tally tally = {.name = "different cords", .best = -INFINITY};
  const long most = attack_number(4000);
  for (uint64_t seed = attack_seed(); tally.judged < most; seed++) {
    rng r = rng_make(seed);
    const int nodes = rng_between(&r, 3, 5), distinct = rng_between(&r, 2, 3);
    thr_frame f = random_frame(&r, nodes, rng_below(&r, MOST_EDGES - nodes + 2), LENGTHS_RANDOM);
    thr_request o = asked(distinct, distinct + rng_below(&r, 3),
                          rng_below(&r, 2) ? THR_ENDS_ANY : THR_ENDS_CLOSED,
                          rng_below(&r, 2) ? "length" : "longest");
    thr_plan p = made(&f, &o);
    forgery x;
    for (int again = 0; again < 3 && forge(&p, &x); again++)
      if (attack_climb(&r, &of_forgeries, &p, &x, STEPS, &tally))
        printf("seed %ld: %g above the truth, %d cords, %d different\n", (long)seed,
               judge_forgery(&p, &x), x.plan.n_cords, x.plan.options.distinct);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 20);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("different cords");
  ADD_TEST(s, 120, plans_are_the_truth);
  ADD_EXAMPLES(s, 60, trees_are_proved, 12);
  ADD_EXAMPLES(s, 60, bridges_need_what_is_said, 20);
  ADD_EXAMPLES(s, 60, nothing_is_proved_above_the_truth, 10);
  ADD_TEST(s, 200, even_cords_are_the_truth);
  ADD_TEST(s, 60, longer_cords_are_not_the_truth);
  ADD_TEST(s, 120, short_cords_are_few);
  ADD_EXAMPLES(s, 120, other_wishes_are_kept, 4);
  ADD_EXAMPLES(s, 120, solids_need_no_more_cord, 3);
  ADD_TEST(s, 20, false_claims_are_refused);
  ADD_TEST(s, 20, the_least_needs_all_edges);
  ADD_TEST(s, 120, no_forged_claim_of_different_cords_is_accepted);
  ADD_EXAMPLES(s, 60, alike_cords_have_the_proof_of_one, 6);
  return run_suite(s);
}
