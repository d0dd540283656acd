/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords that turn evenly, tied cords that turn least, and given numbers of ends that differ from
 * piece to piece, of random small frameworks against every choice of passes, ends and pairs. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- oracle: every choice of passes, ends and pairs, pass by pass ---- */

enum { MOST_EDGES = 10, MOST_NODES = 8, MOST_POINTS = 64, MOST_CORDS = 8, MOST_STEPS = 40000000 };

/* Points are what is paired: the two sides of every pass (2 p and 2 p + 1, at the nodes where it
 * leaves), then the cord ends. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  bool largest;   /* of the cord that turns most; else of all together */
  int most_extra; /* passes of an edge */
  double most_length;
  int component[MOST_NODES], n_components;
  int passes[MOST_EDGES], ends[MOST_NODES];
  int n_points, n_sides, half[MOST_POINTS], node[MOST_POINTS], mate[MOST_POINTS];
  double best;
  long steps;
} oracle;

static double pair_price(const oracle *w, int a, int b)
{
  if (a >= w->n_sides && b >= w->n_sides) return INFINITY;
  if (a >= w->n_sides || b >= w->n_sides) return 0;
  bool back = w->half[a] == w->half[b];
  if (back && (thr_degree(w->f, w->node[a]) > 1 || w->o->joint == THR_JOINT_TUBE)) return INFINITY;
  return thr_turn_price(w->f, w->o->turning.cost, w->half[a] ^ 1, w->half[b]);
}

/* Do the pairs at the node hang together, edge by edge? */
static bool node_tied(const oracle *w, int v)
{
  unsigned reached = 0, all = 0, first = 0;
  for (int a = 0; a < w->n_sides; a++)
    if (w->node[a] == v) {
      all |= 1u << (w->half[a] >> 1);
      if (!first) first = 1u << (w->half[a] >> 1);
    }
  for (unsigned next = first; next != reached;) {
    reached = next;
    for (int a = 0; a < w->n_sides; a++)
      if (w->node[a] == v && w->mate[a] < w->n_sides && next >> (w->half[a] >> 1) & 1u)
        next |= 1u << (w->half[w->mate[a]] >> 1);
  }
  return reached == all;
}

/* Follows the cord from an end, or a closed one from a side, and marks what it meets; its price. */
static double run_along(const oracle *w, int a, bool *met)
{
  double price = 0;
  met[a] = true;
  for (int b = a, next;; b = next) {
    int other = b < w->n_sides ? b ^ 1 : b; /* across the pass */
    next = w->mate[other];
    met[other] = met[next] = true;
    price += pair_price(w, other, next);
    if (next == a || next >= w->n_sides) return price;
  }
}

/* As many cords in every component as there must be: what is to be small, or INFINITY. */
static double judge(const oracle *w)
{
  bool met[MOST_POINTS] = {false}, closed = w->o->ends == THR_ENDS_CLOSED;
  int count[MOST_NODES] = {0};
  double sum = 0, largest = 0;
  for (int a = closed ? 0 : w->n_sides; a < w->n_points; a++) {
    if (met[a]) continue;
    double price = run_along(w, a, met);
    sum += price;
    largest = fmax(largest, price);
    count[w->component[w->node[a]]]++;
  }
  for (int a = 0; a < w->n_points; a++)
    if (!met[a]) return INFINITY; /* on a circuit without ends */
  for (int k = 0; k < w->n_components; k++)
    if (w->o->ends != THR_ENDS_COUNTS && count[k] != w->o->cords) return INFINITY;
  return w->largest ? largest : sum;
}

/* Is nothing paired yet of the pass that a side belongs to? */
static bool fresh(const oracle *w, int side)
{
  return w->mate[side] < 0 && w->mate[side ^ 1] < 0;
}

/* Was the point before b, which is like it, tried as the mate of a? Ends at a node are alike, and
 * so are passes of an edge of which nothing is paired yet. */
static bool tried(const oracle *w, int a, int b)
{
  if (b >= w->n_sides)
    return b - 1 >= w->n_sides && w->node[b - 1] == w->node[b] && w->mate[b - 1] < 0;
  return b >= 2 && w->half[b - 2] == w->half[b] && a >> 1 != (b - 2) >> 1 && fresh(w, b) &&
         fresh(w, b - 2);
}

/* Pairs what has no mate, node by node. */
static void pair_points(oracle *w, double price)
{
  int cords = w->o->ends == THR_ENDS_CLOSED ? w->o->cords * w->n_components
                                            : (w->n_points - w->n_sides) / 2,
      a = -1;
  if (price / (w->largest ? cords : 1) >= w->best - 1e-9) return;
  ck_assert_int_lt(++w->steps, MOST_STEPS);
  for (int v = 0; v < w->f->n_nodes && a < 0; v++) {
    for (int i = 0; i < w->n_points && a < 0; i++)
      if (w->node[i] == v && w->mate[i] < 0) a = i;
    if (a < 0 && w->o->joint == THR_JOINT_TUBE && !node_tied(w, v)) return;
  }
  if (a < 0) {
    w->best = fmin(w->best, judge(w));
    return;
  }
  for (int b = a + 1; b < w->n_points; b++) {
    double more = w->node[b] != w->node[a] || w->mate[b] >= 0 || tried(w, a, b)
                      ? (double)INFINITY
                      : pair_price(w, a, b);
    if (isinf(more)) continue;
    w->mate[a] = b;
    w->mate[b] = a;
    pair_points(w, price + more);
    w->mate[a] = w->mate[b] = -1;
  }
}

static void add_point(oracle *w, int half, int node)
{
  ck_assert_int_lt(w->n_points, MOST_POINTS);
  w->half[w->n_points] = half;
  w->node[w->n_points] = node;
  w->mate[w->n_points++] = -1;
}

static void pair_all(oracle *w)
{
  w->n_points = 0;
  for (int e = 0; e < w->f->n_edges; e++)
    for (int i = 0; i < w->passes[e]; i++) {
      add_point(w, 2 * e, w->f->edge[e][0]);
      add_point(w, 2 * e + 1, w->f->edge[e][1]);
    }
  w->n_sides = w->n_points;
  for (int v = 0; v < w->f->n_nodes; v++)
    for (int i = 0; i < w->ends[v]; i++)
      add_point(w, -1, v);
  for (int v = 0; v < w->f->n_nodes; v++) {
    int at = -2 * w->ends[v]; /* passes that turn */
    for (int i = 0; i < w->n_points; i++)
      at += w->node[i] == v;
    if (at % 2 || at < 0 || (w->o->joint == THR_JOINT_TUBE && at < 2 * (thr_degree(w->f, v) - 1)))
      return;
  }
  pair_points(w, 0);
}

/* Ends at node v and after: left[k] of them in component k. */
static void choose_ends(oracle *w, int v, int *left)
{
  const thr_request *o = w->o;
  if (v == w->f->n_nodes) {
    for (int k = 0; k < w->n_components; k++)
      if (left[k]) return;
    pair_all(w);
    return;
  }
  int k = w->component[v], most = thr_plan_end_allowed(w->f, o, v) ? left[k] : 0;
  for (int n = 0; n <= most; n++) {
    if (o->ends == THR_ENDS_COUNTS && n != o->end_count[v]) continue;
    w->ends[v] = n;
    left[k] -= n;
    choose_ends(w, v + 1, left);
    left[k] += n;
  }
  w->ends[v] = 0;
}

static void choose_passes(oracle *w, int e, double length)
{
  if (length > w->most_length * (1 + 1e-9)) return;
  if (e == w->f->n_edges) {
    int left[MOST_NODES] = {0};
    for (int k = 0;
         k < w->n_components && w->o->ends != THR_ENDS_CLOSED && w->o->ends != THR_ENDS_COUNTS; k++)
      left[k] = 2 * w->o->cords;
    for (int v = 0; v < w->f->n_nodes && w->o->ends == THR_ENDS_COUNTS; v++)
      left[w->component[v]] += w->o->end_count[v];
    choose_ends(w, 0, left);
    return;
  }
  int cover = thr_plan_cover(w->f, w->o, e), most = thr_plan_capacity(w->f, w->o, e);
  for (int m = cover; m <= cover + w->most_extra && m <= most; m++) {
    w->passes[e] = m;
    choose_passes(w, e + 1, length + m * w->f->length[e]);
  }
}

/* Least price of all turns, or of those of the cord that turns most, below `below`; or below. */
static double least_by_enumeration(const thr_frame *f, const thr_request *o, bool largest,
                                   int most_extra, double most_length, double below)
{
  oracle w = {.f = f,
              .o = o,
              .largest = largest,
              .most_extra = most_extra,
              .most_length = most_length,
              .best = below};
  ck_assert(f->n_edges <= MOST_EDGES && f->n_nodes <= MOST_NODES);
  ck_assert_int_eq(thr_frame_components(f, w.component, &w.n_components, NULL), THR_OK);
  choose_passes(&w, 0, 0);
  return w.best;
}

/* ---- what holds for every plan ---- */

typedef struct {
  int asked, found, possible, least, optimal;
} tally;

/* Never below the least of all, never a bound above it, never a false claim; how often the plan is
 * the least is counted. */
static void compare(const thr_frame *f, const thr_request *o, int most_extra, tally *t)
{
  const thr_limits none = {0};
  thr_plan p;
  thr_err err = {0};
  bool largest = thr_wants_largest(o);
  thr_status st = thr_tortuosity_plan(f, o, &none, &p, &err);
  t->asked++;
  if (st == THR_EINFEASIBLE) {
    assert_one_line(&err, NULL);
    if (o->turning.length_slack < 0)
      t->possible += isfinite(least_by_enumeration(f, o, largest, most_extra, INFINITY, INFINITY));
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
  double value = largest ? p.turning.largest : p.turning.price,
         bound = largest ? p.turning.largest_bound : p.turning.lower_bound;
  double limit = p.turning.length_limit < 0 ? (double)INFINITY : p.turning.length_limit;
  double least = least_by_enumeration(f, o, largest, most_extra, limit, value + 1e-3);
  bool optimal = largest ? p.turning.largest_optimal : p.turning.optimal;
  if (p.metrics.most_passes <= o->cover + most_extra && !f->cover)
    ck_assert_double_le(least, value + 1e-6); /* it finds the plan */
  ck_assert_double_le(bound, least + 1e-6);
  ck_assert(!optimal || value <= least + 1e-6);
  ck_assert_int_eq(optimal && !p.proof.slack_open, st == THR_OK);
  t->found++;
  t->possible++;
  t->least += value <= least + 1e-6;
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
    compare(&f, &o, 2, &t);
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
    if (f.n_edges <= 5) compare(&f, &o, 2, &t);
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
    compare(&f, &o, 2, &t);
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
  ck_assert_int_eq(judge_plan(p, &err), THR_EVIOLATED);
  assert_one_line(&err, word);
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
