/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least turning of random small frameworks against enumeration, its proof under alteration, and
 * what must not change. */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/threading/threading.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- oracle: every choice of passes, ends and turns ---- */

enum { MOST_EDGES = 12, MOST_NODES = 8, MOST_OPTIONS = 6000 };

/* One way of pairing what arrives at a node: its price, and which edges it links (bit b of
 * link[a]). */
typedef struct {
  double price;
  unsigned link[MOST_EDGES];
} node_option;

typedef struct {
  const thr_frame *f;
  thr_turn_cost cost;
  int cords;        /* 0 = closed */
  const int *count; /* [n_nodes] ends, or NULL */
  int passes[MOST_EDGES], ends[2 * MOST_EDGES];
  int n_options[MOST_NODES];
  node_option *option[MOST_NODES];
  double rest[MOST_NODES + 1]; /* least price of the nodes from v on */
  double best;
} oracle;

/* Do the links hang together: all edges in one piece if closed or one cord, else every piece with
 * an end? */
static bool hangs_together(const oracle *o, const node_option *const *chosen)
{
  const thr_frame *f = o->f;
  int piece[MOST_EDGES];
  bool has_end[MOST_EDGES] = {false};
  for (int e = 0; e < f->n_edges; e++)
    piece[e] = e;
  for (int v = 0; v < f->n_nodes; v++)
    for (int a = 0; a < f->n_edges; a++)
      for (int b = 0; b < f->n_edges; b++)
        if (chosen[v]->link[a] >> b & 1u && piece[a] != piece[b])
          for (int e = 0, from = piece[b], to = piece[a]; e < f->n_edges; e++)
            if (piece[e] == from) piece[e] = to;
  for (int h = 0; h < 2 * f->n_edges; h++)
    if (o->ends[h]) has_end[piece[h >> 1]] = true;
  for (int e = 0; e < f->n_edges; e++)
    if (o->cords ? !has_end[piece[e]] : piece[e] != piece[0]) return false;
  return true;
}

static void combine(oracle *o, int v, double price, const node_option **chosen)
{
  if (price + o->rest[v] >= o->best - 1e-12) return;
  if (v == o->f->n_nodes) {
    if (hangs_together(o, chosen)) o->best = price;
    return;
  }
  for (int i = 0; i < o->n_options[v]; i++) {
    chosen[v] = &o->option[v][i];
    combine(o, v + 1, price + chosen[v]->price, chosen);
  }
}

/* Pairs what is left of the edges at v, the first edge with something left first. left[i] counts by
 * position at v. */
static void pair_node(oracle *o, int v, int *left, node_option *made)
{
  const thr_frame *f = o->f;
  int d = thr_degree(f, v), i = 0;
  const int *half = f->half + f->first[v];
  while (i < d && left[i] == 0)
    i++;
  if (i == d) {
    ck_assert_int_lt(o->n_options[v], MOST_OPTIONS);
    o->option[v][o->n_options[v]++] = *made;
    return;
  }
  for (int k = i; k < d; k++) {
    if (k == i ? d > 1 || left[i] < 2 : left[k] == 0) continue;
    node_option next = *made;
    next.price += k == i ? thr_turn_cost_of(o->cost, THR_PI)
                         : thr_turn_cost_of(o->cost, thr_turn_angle(f, half[i] ^ 1, half[k]));
    next.link[half[i] >> 1] |= 1u << (half[k] >> 1);
    left[i]--;
    left[k]--;
    pair_node(o, v, left, &next);
    left[i]++;
    left[k]++;
  }
}

static void try_passes_and_ends(oracle *o)
{
  const thr_frame *f = o->f;
  const node_option *chosen[MOST_NODES];
  o->rest[f->n_nodes] = 0;
  for (int v = f->n_nodes - 1; v >= 0; v--) {
    int left[MOST_EDGES];
    node_option none = {0};
    double least = INFINITY;
    for (int i = 0; i < thr_degree(f, v); i++) {
      int h = f->half[f->first[v] + i];
      left[i] = o->passes[h >> 1] - o->ends[h];
      if (left[i] < 0) return;
    }
    o->n_options[v] = 0;
    pair_node(o, v, left, &none);
    for (int i = 0; i < o->n_options[v]; i++)
      least = fmin(least, o->option[v][i].price);
    o->rest[v] = o->rest[v + 1] + least;
    if (o->rest[v] >= o->best) return;
  }
  combine(o, 0, 0, chosen);
}

static bool as_counted(const oracle *o)
{
  int at[MOST_NODES] = {0};
  for (int h = 0; h < 2 * o->f->n_edges; h++)
    at[thr_tail(o->f, h)] += o->ends[h];
  for (int v = 0; v < o->f->n_nodes && o->count; v++)
    if (at[v] != o->count[v]) return false;
  return true;
}

static void try_ends(oracle *o, const bool *allowed, int h, int left)
{
  if (left == 0) {
    if (as_counted(o)) try_passes_and_ends(o);
    return;
  }
  if (h == 2 * o->f->n_edges) return;
  try_ends(o, allowed, h + 1, left);
  if (!allowed[thr_tail(o->f, h)]) return;
  for (int k = 1; k <= left; k++) {
    o->ends[h] = k;
    try_ends(o, allowed, h + 1, left - k);
  }
  o->ends[h] = 0;
}

/* Ends in all, or -1 if there are not so many at some node. */
static int ends_in_all(const thr_frame *f, const thr_turning_task *t)
{
  int sum = 0;
  for (int v = 0; v < f->n_nodes && t->end_count; v++)
    sum += t->end_count[v];
  return t->end_count ? sum : t->end_allowed ? 2 * t->cords : 0;
}

static void try_passes(oracle *o, const thr_turning_task *t, double extra, int e)
{
  if (t->extra_limit >= 0 && extra > t->extra_limit * (1 + 1e-9) + 1e-9) return;
  if (e == o->f->n_edges) {
    try_ends(o, t->end_allowed, 0, ends_in_all(o->f, t));
    return;
  }
  const thr_request limits = {.cover = t->cover, .capacity = t->capacity};
  int cover = thr_plan_cover(o->f, &limits, e), most = thr_plan_capacity(o->f, &limits, e);
  for (int m = cover; m <= t->most_passes && m <= most; m++) {
    o->passes[e] = m;
    try_passes(o, t, extra + (m - cover) * o->f->length[e], e + 1);
  }
}

/* The least price below most, or most. */
static double least_by_enumeration(const thr_frame *f, const thr_turning_task *t, double most)
{
  oracle o = {.f = f,
              .cost = t->cost,
              .cords = t->end_allowed ? t->cords : 0,
              .count = t->end_count,
              .best = most};
  ck_assert_int_le(f->n_edges, MOST_EDGES);
  ck_assert_int_le(f->n_nodes, MOST_NODES);
  for (int v = 0; v < f->n_nodes; v++)
    o.option[v] = calloc(MOST_OPTIONS, sizeof *o.option[v]);
  try_passes(&o, t, 0, 0);
  for (int v = 0; v < f->n_nodes; v++)
    free(o.option[v]);
  return o.best;
}

/* ---- what holds for every result ---- */

static void assert_cords(const thr_frame *f, const thr_least *l)
{
  int *passes = calloc((size_t)f->n_edges, sizeof *passes);
  double price = 0;
  for (int i = 0; i < l->n_cords; i++) {
    const thr_cord *c = &l->cord[i];
    bool open = l->task.end_allowed != NULL;
    for (int k = 0; k < c->n_passes; k++) {
      int next = c->half[(k + 1) % c->n_passes];
      passes[c->half[k] >> 1]++;
      if (open && k + 1 == c->n_passes) continue;
      ck_assert_int_eq(thr_head(f, c->half[k]), thr_tail(f, next));
      if (next == (c->half[k] ^ 1)) ck_assert_int_eq(thr_degree(f, thr_tail(f, next)), 1);
      price += thr_turn_cost_of(l->task.cost, thr_turn_angle(f, c->half[k], next));
    }
    ck_assert(!open || (l->task.end_allowed[thr_cord_start(f, c)] &&
                        l->task.end_allowed[thr_cord_end(f, c)]));
  }
  for (int e = 0; e < f->n_edges; e++)
    ck_assert(passes[e] >= l->task.cover && passes[e] <= l->task.most_passes);
  free(passes);
  ck_assert_double_eq_tol(price, l->price, 1e-9 * (1 + price));
}

static thr_least solve(const thr_frame *f, const thr_least_options *o, bool must_close)
{
  thr_least l;
  thr_err err = {0};
  thr_limits limits = {0};
  thr_status st = thr_least_turning(f, o, &limits, &l, &err);
  ck_assert_msg(st == THR_OK || (!must_close && st == THR_ELIMIT), "%s", err.text);
  assert_cords(f, &l);
  ck_assert_double_le(l.bound, l.price + 1e-9);
  return l;
}

static void compare(rng *r, const thr_frame *f, int cover, int more, int cords)
{
  static const thr_ends kinds[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  for (int i = cords > 1; i < 3; i++) {
    thr_least_options o = thr_least_options_default();
    o.request.cover = cover;
    o.most_passes = cover + more;
    o.request.ends = kinds[i];
    o.request.cords = cords;
    o.request.turning.cost = (thr_turn_cost)(rng_below(r, 4) == 0 ? rng_between(r, 1, 2) : 0);
    if (rng_below(r, 4) == 0) o.length_slack = rng_below(r, 2) * 0.1;
    thr_least l;
    thr_err err = {0};
    thr_limits limits = {0};
    thr_status st = thr_least_turning(f, &o, &limits, &l, &err);
    if (st) {
      ck_assert_msg(st == THR_EINFEASIBLE, "%s", err.text);
      continue;
    }
    assert_cords(f, &l);
    double least =
        least_by_enumeration(f, &l.task, l.price + 1e-3); /* has to find the plan's price itself */
    ck_assert_double_eq_tol(l.price, least, 1e-6);
    ck_assert(l.optimal);
    ck_assert_double_ge(l.bound, least - 1e-6);
    thr_least_destroy(&l);
  }
}

START_TEST(least_is_least_of_all)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int k = 0; k < 12; k++) {
    int n = rng_between(&r, 3, 6), extra = rng_between(&r, 0, 9 - n);
    thr_frame f = random_frame(&r, n, extra, LENGTHS_EUCLID);
    int cords = rng_below(&r, 5) ? 1 : rng_between(&r, 2, 2 + (f.n_edges < 7));
    compare(&r, &f, 1, 1 + (f.n_edges < 7 && cords < 3), cords);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(least_is_least_of_all_with_more_cover)
{
  rng r = rng_make((uint64_t)_i + 1000);
  for (int k = 0; k < 6; k++) {
    int n = rng_between(&r, 3, 5), extra = rng_between(&r, 0, 6 - n);
    thr_frame f = random_frame(&r, n, extra, LENGTHS_EUCLID);
    compare(&r, &f, rng_between(&r, 2, 3), 1, rng_below(&r, 3) == 0 ? rng_between(&r, 2, 3) : 1);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Covers and capacities of single edges, given numbers of ends. */
START_TEST(least_is_least_of_all_with_limits_of_edges)
{
  rng r = rng_make((uint64_t)_i + 4000);
  for (int k = 0; k < 12; k++) {
    int n = rng_between(&r, 3, 5), count[5] = {0};
    thr_frame f = random_frame(&r, n, rng_between(&r, 0, 6 - n), LENGTHS_EUCLID);
    thr_least_options o = thr_least_options_default();
    f.cover = calloc((size_t)f.n_edges, sizeof *f.cover);
    f.capacity = calloc((size_t)f.n_edges, sizeof *f.capacity);
    for (int e = 0; e < f.n_edges; e++) {
      f.cover[e] = rng_between(&r, 1, 2);
      f.capacity[e] = rng_below(&r, 3) ? 0 : rng_between(&r, 2, 3);
    }
    o.most_passes = 3;
    o.request.cords = rng_between(&r, 1, 2);
    o.request.ends = rng_below(&r, 3) ? THR_ENDS_COUNTS : THR_ENDS_CLOSED;
    if (o.request.ends == THR_ENDS_CLOSED) o.request.cords = 1;
    for (int i = 0; i < 2 * o.request.cords; i++)
      count[rng_below(&r, n)]++;
    o.request.end_count = count;
    thr_least l;
    thr_err err = {0};
    thr_limits limits = {0};
    thr_status st = thr_least_turning(&f, &o, &limits, &l, &err);
    if (!st) {
      assert_cords(&f, &l);
      ck_assert_double_eq_tol(l.price, least_by_enumeration(&f, &l.task, l.price + 1e-3), 1e-6);
      ck_assert_double_le(l.bound, l.price + 1e-9);
    } else {
      ck_assert_msg(st == THR_EINFEASIBLE || st == THR_ELIMIT, "%s", err.text);
    }
    if (st == THR_ELIMIT)
      ck_assert_double_le(l.bound, least_by_enumeration(&f, &l.task, l.price + 1e-3) + 1e-6);
    thr_least_destroy(&l);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A node of 6 edges, whose neighbours are joined at random. */
START_TEST(least_is_least_of_all_at_a_node_of_six)
{
  rng r = rng_make((uint64_t)_i + 2000);
  for (int k = 0; k < 4; k++) {
    double xyz[7][3];
    int edge[9][2], m = 0, feet[] = {rng_below(&r, 7), rng_below(&r, 7), -1};
    for (int v = 0; v < 7; v++)
      for (int i = 0; i < 3; i++)
        xyz[v][i] = rng_unit(&r);
    for (; m < 6; m++)
      edge[m][0] = 0, edge[m][1] = m + 1;
    for (int step = rng_between(&r, 1, 2), first = 1; m < 9; m++, first += step == 1 ? 2 : 1)
      edge[m][0] = first,
      edge[m][1] = step == 1 ? first + 1 : first + 3; /* beside each other, or across */
    thr_frame f = frame_make(7, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, feet);
    compare(&r, &f, 1, 1, 1);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- known answers ---- */

static void expect_degrees(const thr_frame *f, double degrees)
{
  thr_least_options o = thr_least_options_default();
  thr_least l = solve(f, &o, true);
  ck_assert_double_eq_tol(l.price * 180 / THR_PI, degrees, 1e-4);
  ck_assert_double_eq_tol(l.bound, l.price, 1e-6);
  thr_least_destroy(&l);
}

START_TEST(known_answers)
{
  thr_frame f = solid_make(OCTAHEDRON);
  expect_degrees(&f, 1200); /* its pairings alone: 1080, in three loops */
  thr_frame_destroy(&f);
  f = ring_make(7);
  expect_degrees(&f, 360);
  thr_frame_destroy(&f);
  f = path_make(4); /* there and back */
  expect_degrees(&f, 360);
  thr_frame_destroy(&f);
  f = solid_make(
      CUBE); /* 8 nodes of 4 passes, two right angles and more; no straight way through */
  expect_degrees(&f, 16 * 90);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(larger_grids_are_proved)
{
  thr_frame f = grid_make(12, 9);
  thr_least_options o = thr_least_options_default();
  thr_least l = solve(&f, &o, true);
  ck_assert_int_eq(l.proof.n_nodes, 1);
  thr_least_destroy(&l);
  o.request.ends = THR_ENDS_FEET;
  o.request.cords = 2;
  l = solve(&f, &o, true);
  ck_assert_int_eq(l.n_cords, 2);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- the greedy for given passes ---- */

/* Number of circuits that the pairs make, following them dart by dart. */
static int circuits(const thr_join *j)
{
  int n = 0;
  bool *seen = calloc((size_t)j->g.n_darts, sizeof *seen);
  for (int start = 0; start < j->g.n_darts; start++) {
    if (seen[start]) continue;
    n++;
    for (int d = start; !seen[d]; d = j->mate[d ^ 1])
      seen[d] = seen[d ^ 1] = true;
  }
  free(seen);
  return n;
}

/* Least price of all pairings of passes, at node v and after, that make one circuit. */
static double least_single_circuit(thr_join *j, int v, double price, double best)
{
  const thr_multigraph *g = &j->g;
  if (price >= best) return best;
  if (v == j->c->f->n_nodes) return circuits(j) == 1 ? price : best;
  int a = -1;
  for (int i = g->first[v]; i < g->first[v + 1] && a < 0; i++)
    if (j->mate[g->dart[i]] < 0) a = g->dart[i];
  if (a < 0) return least_single_circuit(j, v + 1, price, best);
  for (int i = g->first[v]; i < g->first[v + 1]; i++) {
    int b = g->dart[i];
    if (b == a || j->mate[b] >= 0) continue;
    j->mate[a] = b;
    j->mate[b] = a;
    best = least_single_circuit(j, v, price + thr_join_price(j, a, b), best);
    j->mate[a] = j->mate[b] = -1;
  }
  return best;
}

/* Exact where no node has more than 4 passes; elsewhere one circuit that is no cheaper, and
 * exchanges make it no dearer. */
START_TEST(greedy_matches_enumeration_up_to_four_passes)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_limits limits = {0};
  for (int k = 0, small = 0; small < 20 && k < 1000; k++) {
    thr_frame f = random_frame(&r, rng_between(&r, 4, 8), rng_between(&r, 2, 5), LENGTHS_EUCLID);
    thr_turning_task task = {.cover = 1, .most_passes = 8, .cords = 1, .extra_limit = -1};
    thr_turning_columns c;
    thr_join j, all;
    int passes[32], ends[32], most = 0;
    ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
    ck_assert_int_eq(thr_extra_passes(&c, f.length, NULL, false, &limits, passes, ends, NULL),
                     THR_OK);
    ck_assert_int_eq(thr_join_init(&j, &c, passes, ends, NULL), THR_OK);
    ck_assert_int_eq(thr_join_init(&all, &c, passes, ends, NULL), THR_OK);
    for (int v = 0; v < f.n_nodes; v++)
      if (j.g.first[v + 1] - j.g.first[v] > most) most = j.g.first[v + 1] - j.g.first[v];
    if (most <= 6) {
      double least = least_single_circuit(&all, 0, 0, INFINITY);
      ck_assert_int_eq(thr_join_greedy(&j, 0, NULL), THR_OK);
      ck_assert_int_eq(circuits(&j), 1);
      if (most <= 4) {
        small++;
        ck_assert_double_eq_tol(j.price, least, 1e-6);
      }
      double before = j.price;
      ck_assert_double_ge(before, least - 1e-6);
      ck_assert_int_eq(thr_improve(&j, &limits, NULL), THR_OK);
      ck_assert_int_eq(circuits(&j), 1);
      ck_assert_double_le(j.price, before);
      ck_assert_double_ge(j.price, least - 1e-6);
    }
    thr_join_destroy(&j);
    thr_join_destroy(&all);
    thr_turning_columns_destroy(&c);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- several cords ---- */

static double largest_price(const thr_least *l, const thr_frame *f)
{
  double largest = 0;
  for (int i = 0; i < l->n_cords; i++) {
    double price = 0;
    for (int k = 0; k + 1 < l->cord[i].n_passes; k++)
      price += thr_turn_angle(f, l->cord[i].half[k], l->cord[i].half[k + 1]);
    largest = fmax(largest, price);
  }
  return largest;
}

static thr_max_turning even_out(const thr_frame *f, thr_least *l)
{
  thr_max_turning m;
  thr_err err = {0};
  thr_limits limits = {0};
  double before = largest_price(l, f), sum_bound = l->bound;
  assert_ok(thr_max_turning_improve(f, 0, &limits, l, &m, &err), &err);
  assert_cords(f, l);
  ck_assert_double_eq_tol(m.largest, largest_price(l, f), 1e-9 * m.largest);
  ck_assert_double_le(m.largest, before * (1 + 1e-9));
  ck_assert_double_ge(m.largest, m.bound * (1 - 1e-9));
  ck_assert_double_ge(m.bound, sum_bound / l->n_cords * (1 - 1e-9));
  return m;
}

START_TEST(cords_of_a_dome_turn_alike)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_least_options o = thr_least_options_default();
  o.request.ends = THR_ENDS_FEET;
  o.request.cords = _i;
  thr_least l = solve(&f, &o, true);
  thr_max_turning m = even_out(&f, &l);
  ck_assert_double_eq_tol(m.largest, m.bound, 1e-6); /* its share of the least there is */
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cords_stay_whole_while_evened_out)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, 14, 12, LENGTHS_EUCLID);
  thr_least_options o = thr_least_options_default();
  o.request.ends = THR_ENDS_ANY;
  o.request.cords = rng_between(&r, 1, 4);
  o.request.cover = rng_between(&r, 1, 2);
  o.most_nodes = 1;
  thr_least l = solve(&f, &o, false);
  even_out(&f, &l);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- failures ---- */

START_TEST(running_out_of_memory_leaves_nothing)
{
  thr_frame f = _i ? star_make(5) : solid_make(OCTAHEDRON);
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  if (_i) o.request.ends = THR_ENDS_ANY, o.request.cords = 2;
  thr_status st = THR_ENOMEM;
  for (long k = 1; st != THR_OK;
       k += 1 + _i * k / 32) { /* several cords: thousands of allocations */
    thr_least l;
    thr_max_turning m;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_least_turning(&f, &o, &limits, &l, &err);
    if (!st) st = thr_max_turning_improve(&f, 0, &limits, &l, &m, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: %d %s", k, (int)st, err.text);
    thr_least_destroy(&l);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(requests_without_a_plan_are_refused)
{
  thr_frame f = path_make(3);
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_least l;
  thr_err err = {0};
  bool nowhere[3] = {false};
  o.request.ends = THR_ENDS_NODES;
  o.request.end_node = nowhere;
  assert_status(thr_least_turning(&f, &o, &limits, &l, &err), THR_EINFEASIBLE, &err,
                "no node where a cord may end");
  ck_assert_ptr_null(l.cord);
  o = thr_least_options_default();
  o.most_passes = 1; /* there and back needs 2 */
  assert_status(thr_least_turning(&f, &o, &limits, &l, &err), THR_EINFEASIBLE, &err, "1 passes");
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(two_pieces_have_a_cord_each)
{
  thr_frame f = triangles_make(2);
  thr_least_options o = thr_least_options_default();
  thr_least l = solve(&f, &o, true);
  ck_assert_int_eq(l.n_cords, 2);
  ck_assert_double_eq_tol(l.bound, 4 * THR_PI, 1e-6);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* Without a linear programme the bound is the matching's: three rings of 1080 degrees, of which one
 * cord turns by 1200. Of any framework it is one. */
START_TEST(a_matching_proves_without_a_programme)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = _i ? random_frame(&r, rng_between(&r, 4, 9), rng_between(&r, 4, 12), LENGTHS_EUCLID)
                   : solid_make(OCTAHEDRON);
  thr_least_options o = thr_least_options_default();
  thr_limits limits = {0};
  thr_err err = {0};
  if (_i % 4 == 3) o.request.ends = THR_ENDS_ANY;
  thr_least l, full = solve(&f, &o, true);
  o.most_nodes = 0;
  thr_status st = thr_least_turning(&f, &o, &limits, &l, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_double_le(l.bound, full.price + 1e-6);
  ck_assert_double_ge(l.price, full.price - 1e-6);
  if (_i == 0) ck_assert_double_eq_tol(l.bound, 1080 * THR_PI / 180, 1e-6);
  thr_least_destroy(&l);
  thr_least_destroy(&full);
  thr_frame_destroy(&f);
}
END_TEST

/* Some thousand edges get a bound before anything is solved; without time it is all there is. */
START_TEST(large_frames_have_a_bound_without_time)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 40, 0);
  thr_least_options o = thr_least_options_default();
  o.request.ends = _i ? THR_ENDS_FEET : THR_ENDS_CLOSED;
  thr_least l, full = solve(&f, &o, true);
  thr_err err = {0};
  thr_limits limits = {.deadline = thr_clock() - 1};
  assert_status(thr_least_turning(&f, &o, &limits, &l, &err), THR_ELIMIT, &err, "stopped early");
  assert_cords(&f, &l);
  ck_assert_double_gt(l.bound, full.price / 2);
  ck_assert_double_le(l.bound, full.price + 1e-6);
  thr_least_destroy(&l);
  thr_least_destroy(&full);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- what must not change ---- */

/* Turns every node about an axis through the origin by an angle, scales and moves it. */
static void move_frame(rng *r, thr_frame *f)
{
  double axis[3], norm = 0, angle = 6 * rng_unit(r), scale = 0.01 + 10 * rng_unit(r);
  for (int i = 0; i < 3; i++)
    axis[i] = rng_unit(r) - 0.5, norm += axis[i] * axis[i];
  for (int i = 0; i < 3; i++)
    axis[i] /= sqrt(norm);
  for (int v = 0; v < f->n_nodes; v++) { /* Rodrigues */
    double x[3], along = 0;
    for (int i = 0; i < 3; i++)
      x[i] = f->xyz[v][i], along += x[i] * axis[i];
    for (int i = 0; i < 3; i++) {
      double cross = axis[(i + 1) % 3] * x[(i + 2) % 3] - axis[(i + 2) % 3] * x[(i + 1) % 3];
      f->xyz[v][i] =
          scale * (x[i] * cos(angle) + cross * sin(angle) + axis[i] * along * (1 - cos(angle))) +
          3 * (i + 1);
    }
  }
  for (int e = 0; e < f->n_edges; e++)
    f->length[e] *= scale;
}

START_TEST(shuffled_frames_have_the_same_least)
{
  rng r = rng_make((uint64_t)_i + 1);
  int to[32];
  thr_frame f = random_frame(&r, 10, 8, LENGTHS_EUCLID), g = shuffled_frame(&r, &f, to);
  thr_least_options o = thr_least_options_default();
  o.request.ends = (thr_ends)(_i % 3);
  o.request.cords = o.request.ends == THR_ENDS_CLOSED ? 1 : 1 + _i / 3 % 3;
  if (_i > 9) o.length_slack = 0.05;
  thr_least a = solve(&f, &o, true), b = solve(&g, &o, true);
  ck_assert_double_eq_tol(a.price, b.price, 1e-9);
  move_frame(&r, &g);
  thr_least c = solve(&g, &o, true);
  ck_assert_double_eq_tol(a.price, c.price, 1e-9);
  thr_least_destroy(&a);
  thr_least_destroy(&b);
  thr_least_destroy(&c);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* ---- the proof ---- */

/* Through JSON and back: the same text, the same bound. */
static void assert_round_trip(const thr_frame *f, const thr_least *l)
{
  thr_text text = {0}, again = {0};
  thr_json *doc;
  thr_err err = {0};
  thr_turning_proof p;
  double bound;
  thr_turning_proof_write(&l->proof, f, &(thr_writer){.out = &text}, NULL);
  ck_assert_int_eq(thr_json_parse(&doc, text.data, text.length, "proof", &err), THR_OK);
  assert_ok(thr_turning_proof_from_json(&p, f, doc, "proof", &err), &err);
  thr_turning_proof_write(&p, f, &(thr_writer){.out = &again}, NULL);
  assert_same_text(&text, &again);
  ck_assert_int_eq(thr_turning_proof_check(f, &l->task, &p, &bound, &err), THR_OK);
  ck_assert_double_eq(bound, l->bound);
  thr_turning_proof_destroy(&p);
  thr_json_destroy(doc);
  thr_text_destroy(&text);
  thr_text_destroy(&again);
}

/* No alteration may prove more than the least there is. */
START_TEST(altered_proofs_prove_no_more)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = _i == 0 ? solid_make(OCTAHEDRON) : random_frame(&r, 7, 6, LENGTHS_EUCLID);
  thr_least_options o = thr_least_options_default();
  o.request.cords = 1 + _i % 2;
  thr_least l = solve(&f, &o, o.request.cords == 1);
  assert_round_trip(&f, &l);
  for (int k = 0; k < 300; k++) {
    thr_turning_dual *d = &l.proof.dual[rng_below(&r, l.proof.n_duals)];
    int64_t amount = (int64_t)1 << rng_below(&r, 50), *at = NULL;
    int what = rng_below(&r, 4);
    if (what == 0) at = &d->potential[rng_below(&r, 2 * f.n_edges)];
    if (what == 1 && d->n_odd) at = &d->odd[rng_below(&r, d->n_odd)].value;
    if (what == 2 && d->n_groups) at = &d->group[rng_below(&r, d->n_groups)].value;
    if (what == 3 && d->n_partitions) at = &d->partition[rng_below(&r, d->n_partitions)].value;
    if (!at) continue;
    int64_t old = *at;
    double bound;
    *at += rng_below(&r, 2) ? amount : -amount;
    thr_status st = thr_turning_proof_check(&f, &l.task, &l.proof, &bound, NULL);
    if (st) {
      ck_assert_int_eq(st, THR_EVIOLATED);
      ck_assert_int_lt(*at, 0);
    } else {
      ck_assert_double_le(bound, l.price + 1e-6);
    }
    *at = old;
  }
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

static void expect_violation(const thr_frame *f, const thr_least *l, const char *word)
{
  thr_err err = {0};
  double bound;
  assert_status(thr_turning_proof_check(f, &l->task, &l->proof, &bound, &err), THR_EVIOLATED, &err,
                word);
  ck_assert_double_eq(bound, 0);
}

/* A proof of several leaves, whose first multipliers have a group. */
static thr_least branched_proof(thr_frame *f)
{
  thr_least_options o = thr_least_options_default();
  for (uint64_t seed = 1; seed < 500; seed++) {
    rng r = rng_make(seed);
    *f = random_frame(&r, 7, 8, LENGTHS_EUCLID);
    thr_least l = solve(f, &o, true);
    if (l.proof.n_nodes > 2 && l.proof.dual[0].n_groups > 0) return l;
    thr_least_destroy(&l);
    thr_frame_destroy(f);
  }
  ck_abort_msg("no random framework needs branching");
}

START_TEST(false_trees_are_refused)
{
  thr_frame f;
  thr_least l = branched_proof(&f);
  thr_turning_node root = l.proof.node[0];
  l.proof.node[0].low = root.high;
  expect_violation(&f, &l, "child");
  l.proof.node[0] = root;
  l.proof.node[0].high = l.proof.n_nodes;
  expect_violation(&f, &l, "child");
  l.proof.node[0] = root;
  l.proof.node[0].a = 2 * f.n_edges;
  expect_violation(&f, &l, "branches on nothing");
  l.proof.node[0] = root;
  int leaf = l.proof.n_nodes - 1, dual = l.proof.node[leaf].dual;
  ck_assert_int_eq(l.proof.node[leaf].low, 0);
  l.proof.node[leaf].dual = l.proof.n_duals;
  expect_violation(&f, &l, "no multipliers");
  l.proof.node[leaf].dual = dual;
  thr_turning_dual *d = &l.proof.dual[0];
  int first = d->group[0].member[0];
  d->group[0].member[0] = f.n_edges;
  expect_violation(&f, &l, "out of range");
  d->group[0].member[0] = first;
  double bound;
  ck_assert_int_eq(thr_turning_proof_check(&f, &l.task, &l.proof, &bound, NULL), THR_OK);
  ck_assert_double_eq_tol(bound, l.bound, 1e-12);
  l.task.cords = 2;
  ck_assert_int_eq(thr_turning_proof_check(&f, &l.task, &l.proof, &bound, NULL), THR_EVIOLATED);
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(false_partitions_are_refused)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_least_options o = thr_least_options_default();
  thr_least l = solve(&f, &o, true);
  thr_turning_dual *d = &l.proof.dual[0];
  ck_assert_int_gt(d->n_partitions, 0); /* without them the root proves 1170 degrees */
  int *block = d->partition[0].block, last = block[f.n_edges - 1];
  const int wrong[] = {-1, f.n_edges, f.n_edges - 1};
  for (int i = 0; i < 3; i++) {
    block[f.n_edges - 1] = wrong[i];
    expect_violation(&f, &l, "bad block numbers");
  }
  block[f.n_edges - 1] = last;
  bool anywhere[6] = {true, true, true, true, true, true};
  l.task.end_allowed = anywhere;
  expect_violation(&f, &l, "closed cord");
  l.task.end_allowed = NULL;
  d->partition[0].value = -1;
  expect_violation(&f, &l, "negative");
  thr_least_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

static const char *const false_json[] = {
    "[]",
    "{\"tree\": []}",
    "{\"tree\": 1, \"multipliers\": []}",
    "{\"tree\": [], \"multipliers\": [], \"more\": 1}",
    "{\"tree\": [1], \"multipliers\": []}",
    "{\"tree\": [{}], \"multipliers\": []}",
    "{\"tree\": [{\"low\": 1, \"high\": 0, \"a\": 0, \"b\": 1, \"value\": 0}], \"multipliers\": "
    "[]}",
    "{\"tree\": [{\"multipliers\": -1}], \"multipliers\": []}",
    "{\"tree\": [{\"multipliers\": 0}], \"multipliers\": [{}]}",
    "{\"tree\": [{\"multipliers\": 0}], \"multipliers\": [{\"potentials\": [], \"ends\": [0], "
    "\"length\": 0, \"odd_sets\": [], "
    "\"groups\": [], \"partitions\": []}]}",
};

START_TEST(false_json_is_refused)
{
  thr_frame f = ring_make(3);
  thr_json *doc;
  thr_turning_proof p;
  ck_assert_int_eq(thr_json_parse(&doc, false_json[_i], strlen(false_json[_i]), "proof", NULL),
                   THR_OK);
  thr_err err = {0};
  assert_status(thr_turning_proof_from_json(&p, &f, doc, "proof", &err), THR_EVIOLATED, &err,
                "proof");
  ck_assert_ptr_null(p.node);
  thr_json_destroy(doc);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("turning");
  ADD_TEST(s, 20, known_answers);
  ADD_EXAMPLES(s, 60, least_is_least_of_all, 12);
  ADD_EXAMPLES(s, 60, least_is_least_of_all_with_more_cover, 8);
  ADD_EXAMPLES(s, 60, least_is_least_of_all_with_limits_of_edges, 20);
  ADD_EXAMPLES(s, 60, least_is_least_of_all_at_a_node_of_six, 6);
  ADD_TEST(s, 20, larger_grids_are_proved);
  ADD_EXAMPLES(s, 20, shuffled_frames_have_the_same_least, 15);
  ADD_EXAMPLES(s, 20, altered_proofs_prove_no_more, 6);
  ADD_TEST(s, 20, false_trees_are_refused);
  ADD_TEST(s, 20, false_partitions_are_refused);
  ADD_EXAMPLES(s, 30, greedy_matches_enumeration_up_to_four_passes, 8);
  ADD_LOOP(s, 60, cords_of_a_dome_turn_alike, 2, 3);
  ADD_LOOP(s, 60, cords_of_a_dome_turn_alike, 4, 5);
  ADD_EXAMPLES(s, 20, cords_stay_whole_while_evened_out, 10);
  ADD_EXAMPLES(s, 60, running_out_of_memory_leaves_nothing, 2);
  ADD_TEST(s, 20, requests_without_a_plan_are_refused);
  ADD_EXAMPLES(s, 20, a_matching_proves_without_a_programme, 40);
  ADD_LOOP(s, 20, large_frames_have_a_bound_without_time, 0, 2);
  ADD_TEST(s, 20, two_pieces_have_a_cord_each);
  ADD_LOOP(s, 20, false_json_is_refused, 0, (int)(sizeof false_json / sizeof *false_json));
  return run_suite(s);
}
