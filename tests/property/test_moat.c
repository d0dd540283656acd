/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-joins of random graphs: both engines against each other and against all subsets; every
 * certificate is checked here, by sums of 128 bits. */
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "lp/matching/blossom.h"
#include "lp/matching/blossom_parts.h"
#include "lp/tjoin/tjoin.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide;

static const thr_limits no_limit;

/* ---- graphs ---- */

typedef struct {
  int n, m, capacity;
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
} graph;

static void graph_destroy(graph *g)
{
  free(g->edge);
  free(g->weight);
  free(g->odd);
}

static graph graph_make(int n)
{
  graph g = {.n = n, .odd = calloc((size_t)n, sizeof *g.odd)};
  ck_assert_ptr_nonnull(g.odd);
  return g;
}

static void add(graph *g, int a, int b, int64_t weight)
{
  if (g->m == g->capacity) {
    g->capacity = 2 * g->capacity + 16;
    g->edge = realloc(g->edge, (size_t)g->capacity * sizeof *g->edge);
    g->weight = realloc(g->weight, (size_t)g->capacity * sizeof *g->weight);
    ck_assert(g->edge && g->weight);
  }
  g->edge[g->m][0] = a;
  g->edge[g->m][1] = b;
  g->weight[g->m++] = weight;
}

static thr_tjoin_problem problem_of(const graph *g)
{
  return (thr_tjoin_problem){.n_nodes = g->n,
                             .n_edges = g->m,
                             .edge = (const int(*)[2])g->edge,
                             .weight = g->weight,
                             .odd = g->odd};
}

/* T: as the degrees are, or at random. */
static void choose_odd(rng *r, graph *g, bool degrees)
{
  int last = -1, count = 0;
  for (int e = 0; e < g->m && degrees; e++) {
    g->odd[g->edge[e][0]] ^= true;
    g->odd[g->edge[e][1]] ^= true;
  }
  for (int v = 0; v < g->n && !degrees; v++)
    if (rng_below(r, 2)) g->odd[last = v] = true, count++;
  if (count % 2) g->odd[last] = false;
}

typedef enum {
  WEIGHTS_ONE,
  WEIGHTS_WITH_ZERO,
  WEIGHTS_SMALL,
  WEIGHTS_WIDE,
  WEIGHT_KINDS
} weight_kind;

static int64_t draw_weight(rng *r, weight_kind kind)
{
  switch (kind) {
  case WEIGHTS_ONE: return 1;
  case WEIGHTS_WITH_ZERO: return rng_below(r, 3);
  case WEIGHTS_SMALL: return rng_between(r, 1, 9);
  default: return 1 + (int64_t)(rng_unit(r) * 0x1p36);
  }
}

typedef enum {
  SHAPE_SPARSE,
  SHAPE_DENSE,
  SHAPE_CHAINS,
  SHAPE_TREE,
  SHAPE_GRID,
  SHAPE_HUB,
  SHAPES
} shape_kind;

/* A random tree, further edges (perhaps parallel ones), edges divided into chains, a hub joined to
 * many nodes. */
static graph draw_graph(rng *r, int n, shape_kind shape, weight_kind weights)
{
  int chains = shape == SHAPE_CHAINS ? n : 0, hub = shape == SHAPE_HUB, side = 2;
  if (shape == SHAPE_GRID) {
    while ((side + 1) * (side + 1) <= n)
      side++;
    n = side * side;
  }
  graph g = graph_make(n + chains + hub);
  for (int v = 1; v < n && shape != SHAPE_GRID; v++)
    add(&g, shape == SHAPE_HUB && v > 4 ? v - rng_between(r, 1, 4) : rng_below(r, v), v,
        draw_weight(r, weights));
  for (int v = 0; v < n && shape == SHAPE_GRID; v++) {
    if (v % side < side - 1) add(&g, v, v + 1, draw_weight(r, weights));
    if (v + side < n) add(&g, v, v + side, draw_weight(r, weights));
  }
  int extra = shape == SHAPE_DENSE ? 2 * n : shape == SHAPE_TREE ? 1 : n / 2;
  for (int k = 0; k < extra && n > 1 && shape != SHAPE_GRID; k++) {
    int a = rng_below(r, n), b = rng_below(r, n);
    if (a != b) add(&g, a, b, draw_weight(r, weights));
  }
  for (int k = 0; k < chains; k++) { /* node n + k goes into the middle of an edge */
    int e = rng_below(r, g.m), b = g.edge[e][1];
    g.edge[e][1] = n + k;
    add(&g, n + k, b, draw_weight(r, weights));
  }
  choose_odd(r, &g, rng_below(r, 3) > 0);
  int64_t price = draw_weight(r, weights);
  for (int v = 0; v < n && hub; v++)
    if (rng_below(r, 4)) add(&g, v, n, price);
  if (hub) add(&g, 0, n, price);
  return g;
}

/* ---- oracles ---- */

/* Weight of the lightest T-join, by all subsets of the edges. */
static int64_t least_by_subsets(const graph *g)
{
  int64_t least = INT64_MAX, weight = 0;
  uint32_t wrong = 0;
  for (int v = 0; v < g->n; v++)
    wrong |= (uint32_t)g->odd[v] << v;
  uint32_t in = 0;
  for (uint32_t k = 1; k <= UINT32_C(1) << g->m; k++) { /* Gray code: one edge changes at a time */
    if (wrong == 0 && weight < least) least = weight;
    if (k == UINT32_C(1) << g->m) break;
    int e = __builtin_ctz(k);
    in ^= UINT32_C(1) << e;
    weight += in >> e & 1 ? g->weight[e] : -g->weight[e];
    wrong ^= (UINT32_C(1) << g->edge[e][0]) ^ (UINT32_C(1) << g->edge[e][1]);
  }
  return least;
}

static void assert_is_join(const graph *g, const thr_tjoin *t)
{
  bool *parity = calloc((size_t)g->n, sizeof *parity);
  int64_t length = 0;
  ck_assert_ptr_nonnull(parity);
  for (int e = 0; e < g->m; e++) {
    if (!t->in_join[e]) continue;
    parity[g->edge[e][0]] ^= true;
    parity[g->edge[e][1]] ^= true;
    length += g->weight[e];
  }
  for (int v = 0; v < g->n; v++)
    ck_assert_int_eq(parity[v], g->odd[v]);
  ck_assert_int_eq(length, t->length);
  free(parity);
}

/* Marks in has[n_cuts * n] what each cut holds, and asserts that children are disjoint and before
 * their parents. */
static void spread_sets(const graph *g, const thr_tjoin *t, bool *has)
{
  for (int i = 0; i < t->n_cuts; i++) {
    const thr_cut *c = &t->cut[i];
    bool *set = has + (size_t)i * (size_t)g->n;
    for (int k = 0; k < c->n_nodes; k++) {
      ck_assert_int_ge(c->node[k], 0);
      ck_assert_int_lt(c->node[k], g->n);
      ck_assert(k == 0 || c->node[k - 1] < c->node[k]);
      ck_assert(!set[c->node[k]]);
      set[c->node[k]] = true;
    }
    ck_assert_int_ge(c->value, 0);
    if (c->parent < 0) continue;
    ck_assert_int_gt(c->parent, i);
    ck_assert_int_lt(c->parent, t->n_cuts);
    bool *around = has + (size_t)c->parent * (size_t)g->n;
    for (int v = 0; v < g->n; v++) {
      ck_assert(!(set[v] && around[v]));
      around[v] |= set[v];
    }
  }
}

/* Every set odd, no edge overloaded; returns the sum of the values, in units of 1 /
 * THR_DUAL_DENOMINATOR. */
static wide proven(const graph *g, const thr_tjoin *t)
{
  bool *has = calloc((size_t)t->n_cuts * (size_t)g->n + 1, sizeof *has);
  wide sum = 0;
  ck_assert_ptr_nonnull(has);
  spread_sets(g, t, has);
  for (int i = 0; i < t->n_cuts; i++) {
    int odd = 0;
    for (int v = 0; v < g->n; v++)
      odd += has[(size_t)i * (size_t)g->n + (size_t)v] && g->odd[v];
    ck_assert_int_eq(odd % 2, 1);
    sum += t->cut[i].value;
  }
  for (int e = 0; e < g->m; e++) {
    wide load = 0;
    for (int i = 0; i < t->n_cuts; i++) {
      const bool *set = has + (size_t)i * (size_t)g->n;
      if (set[g->edge[e][0]] != set[g->edge[e][1]]) load += t->cut[i].value;
    }
    ck_assert(load <= (wide)g->weight[e] * THR_DUAL_DENOMINATOR);
  }
  free(has);
  return sum;
}

static void assert_optimal(const graph *g, const thr_tjoin *t, int64_t least)
{
  assert_is_join(g, t);
  ck_assert(t->optimal);
  ck_assert_int_eq(t->length, least);
  wide sum = proven(g, t);
  ck_assert(sum == t->sum);
  ck_assert(sum > (wide)(least - 1) * THR_DUAL_DENOMINATOR);
}

typedef enum { BY_LP, BY_MATCHING, WAYS } way;

static thr_tjoin solve(const graph *g, way by)
{
  thr_tjoin_problem p = problem_of(g);
  thr_tjoin t = {0};
  thr_err err = {0};
  thr_status st = by == BY_LP ? thr_tjoin_solve(&p, &no_limit, &t, &err)
                              : thr_moat_solve(&p, &no_limit, &t, &err);
  ck_assert_msg(st == THR_OK, "way %d: %s", by, err.text);
  return t;
}

static void assert_all_ways(const graph *g, int64_t least)
{
  for (way by = BY_LP; by < WAYS; by++) {
    thr_tjoin t = solve(g, by);
    if (least == INT64_MAX) least = t.length;
    assert_optimal(g, &t, least);
    if (by == BY_MATCHING) ck_assert(t.sum == t.length * THR_DUAL_DENOMINATOR);
    thr_tjoin_destroy(&t);
  }
}

/* ---- tests ---- */

START_TEST(small_ones_match_all_subsets)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int k = 0; k < 120; k++) {
    graph g = draw_graph(&r, rng_between(&r, 2, 6), (shape_kind)(k % SHAPES),
                         (weight_kind)(k / SHAPES % WEIGHT_KINDS));
    if (g.m <= 17) assert_all_ways(&g, least_by_subsets(&g));
    graph_destroy(&g);
  }
}
END_TEST

START_TEST(medium_ones_agree)
{
  rng r = rng_make((uint64_t)_i + 1000);
  for (int k = 0; k < 48; k++) {
    graph g = draw_graph(&r, rng_between(&r, 7, 60), (shape_kind)(k % SHAPES),
                         (weight_kind)(k / SHAPES % WEIGHT_KINDS));
    assert_all_ways(&g, INT64_MAX);
    graph_destroy(&g);
  }
}
END_TEST

/* Optimality needs no second solver: the certificate is enough. */
START_TEST(larger_ones_are_proved)
{
  rng r = rng_make((uint64_t)_i + 2000);
  graph g = draw_graph(&r, rng_between(&r, 300, 900), (shape_kind)(_i % SHAPES),
                       (weight_kind)(_i / SHAPES % WEIGHT_KINDS));
  thr_tjoin t = solve(&g, BY_MATCHING);
  assert_optimal(&g, &t, t.length);
  thr_tjoin_destroy(&t);
  graph_destroy(&g);
}
END_TEST

START_TEST(same_input_gives_the_same_join)
{
  rng r = rng_make((uint64_t)_i + 3000);
  graph g =
      draw_graph(&r, 200, (shape_kind)(_i % SHAPES), (weight_kind)(_i / SHAPES % WEIGHT_KINDS));
  thr_tjoin a = solve(&g, BY_MATCHING), b = solve(&g, BY_MATCHING);
  ck_assert_int_eq(memcmp(a.in_join, b.in_join, (size_t)g.m * sizeof *a.in_join), 0);
  ck_assert_int_eq(a.n_cuts, b.n_cuts);
  for (int i = 0; i < a.n_cuts; i++) {
    ck_assert_int_eq(a.cut[i].value, b.cut[i].value);
    ck_assert_int_eq(a.cut[i].parent, b.cut[i].parent);
    ck_assert_int_eq(a.cut[i].n_nodes, b.cut[i].n_nodes);
  }
  thr_tjoin_destroy(&a);
  thr_tjoin_destroy(&b);
  graph_destroy(&g);
}
END_TEST

/* Stopped at once: a join that is none too good, and a bound that holds. */
START_TEST(a_stopped_one_is_valid)
{
  static const sig_atomic_t stop = 1;
  const thr_limits stopped = {.interrupted = &stop};
  rng r = rng_make(7);
  graph g = draw_graph(&r, 3000, SHAPE_GRID, WEIGHTS_WIDE);
  for (int v = 0; v < g.n; v++)
    g.odd[v] = v < g.n / 2 * 2;
  thr_tjoin_problem p = problem_of(&g);
  thr_tjoin t;
  thr_err err = {0};
  thr_status st = thr_moat_solve(&p, &stopped, &t, &err);
  ck_assert(st == THR_OK || st == THR_ELIMIT);
  assert_is_join(&g, &t);
  ck_assert(proven(&g, &t) == t.sum);
  ck_assert(t.sum <= t.length * THR_DUAL_DENOMINATOR);
  ck_assert_int_eq(t.optimal, st == THR_OK);
  thr_tjoin_destroy(&t);
  graph_destroy(&g);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  rng r = rng_make((uint64_t)_i + 4000);
  graph g = draw_graph(&r, 12, (shape_kind)(_i % SHAPES), WEIGHTS_WITH_ZERO);
  thr_tjoin_problem p = problem_of(&g);
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_tjoin t;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st =
        _i % 2 ? thr_moat_solve(&p, &no_limit, &t, &err) : thr_tjoin_solve(&p, &no_limit, &t, &err);
    thr_alloc_fail_at(0);
    if (st) ck_assert_msg(st == THR_ENOMEM, "allocation %ld: %s", k, err.text);
    if (st) ck_assert(!t.in_join && !t.cut);
    if (!st) thr_tjoin_destroy(&t);
  }
  graph_destroy(&g);
}
END_TEST

START_TEST(too_large_weights_are_refused_or_go_to_the_other_engine)
{
  graph g = graph_make(3);
  add(&g, 0, 1,
      _i ? THR_MOAT_WEIGHTS_MOST + 1
         : THR_MOAT_WEIGHTS_MOST); /* too large by itself, or with the other one */
  add(&g, 1, 2, _i ? 5 : THR_MOAT_WEIGHTS_MOST);
  add(&g, 2, 0, _i ? 5 : THR_MOAT_WEIGHTS_MOST);
  g.odd[0] = g.odd[1] = true;
  thr_tjoin_problem p = problem_of(&g);
  thr_tjoin t;
  thr_err err = {0};
  ck_assert_int_eq(thr_moat_solve(&p, &no_limit, &t, &err), THR_EINPUT);
  ck_assert_ptr_null(t.in_join);
  assert_one_line(&err, "large");
  ck_assert_int_eq(thr_tjoin_minimum(&p, THR_ENGINE_AUTO, &no_limit, &t, NULL), THR_OK);
  assert_optimal(&g, &t, _i ? 10 : THR_MOAT_WEIGHTS_MOST);
  thr_tjoin_destroy(&t);
  graph_destroy(&g);
}
END_TEST

/* All weights together are more than a spanning tree may be. */
START_TEST(large_weights_with_a_light_tree_are_matched)
{
  rng r = rng_make(5000);
  int tried = 0;
  for (int k = 0; k < 400; k++) {
    graph g = draw_graph(&r, 6, (shape_kind)(k % SHAPES), WEIGHTS_SMALL);
    int64_t sum = 0;
    for (int e = 0; e < g.m; e++)
      sum += g.weight[e] *= THR_MOAT_WEIGHTS_MOST >> 6; /* seven of nine at most fit in 64 */
    if (g.m <= 17 && g.n <= 8 && sum > THR_MOAT_WEIGHTS_MOST && sum <= 2 * THR_MOAT_WEIGHTS_MOST) {
      assert_all_ways(&g, least_by_subsets(&g));
      tried++;
    }
    graph_destroy(&g);
  }
  ck_assert_int_ge(tried, 20);
}
END_TEST

/* Confirms one join; *confirmed: 0 if it was skipped. */
static thr_status confirm(const thr_tjoin_problem *p, const thr_tjoin *t, int *confirmed,
                          thr_err *err)
{
  thr_confirmations confirmations = {.always = true};
  thr_status st = thr_confirmations_add(&confirmations, p, t, err);
  if (!st) st = thr_confirmations_run(&confirmations, &no_limit, err);
  *confirmed = st ? 0 : confirmations.confirmed;
  thr_confirmations_destroy(&confirmations);
  return st;
}

START_TEST(glpk_confirms_what_is_optimal_and_nothing_else)
{
  rng r = rng_make((uint64_t)_i + 5000);
  for (int k = 0; k < 2 * SHAPES; k++) {
    graph g = draw_graph(&r, rng_between(&r, 5, 80), (shape_kind)(k % SHAPES),
                         (weight_kind)(_i % WEIGHT_KINDS));
    thr_tjoin_problem p = problem_of(&g);
    for (way by = BY_LP; by < WAYS; by++) {
      thr_tjoin t = solve(&g, by);
      int said;
      thr_err err = {0};
      assert_ok(confirm(&p, &t, &said, &err), &err);
      ck_assert_int_eq(said, 1);
      t.length += 1 + rng_below(&r, 5);
      if (t.n_cuts) ck_assert_int_eq(confirm(&p, &t, &said, &err), THR_ESOLVER);
      thr_tjoin_destroy(&t);
    }
    graph_destroy(&g);
  }
}
END_TEST

/* ---- the programme on the cuts, and its basis ---- */

/* An equation and those of all cuts inside of its own add up to: the edges that leave the set, less
 * the slack, are 1. */
static void assert_adds_up_to_cuts(const graph *g, const thr_tjoin *t, const thr_cut_programme *c)
{
  size_t rows = (size_t)c->n_rows, columns = (size_t)c->n_columns, n = (size_t)g->n;
  double *sum = calloc(rows * columns, sizeof *sum), *rhs = calloc(rows, sizeof *rhs);
  bool *has = calloc(rows * n, sizeof *has);
  ck_assert(sum && rhs && has);
  spread_sets(g, t, has);
  for (size_t j = 0; j < columns; j++)
    for (int k = c->start[j]; k < c->start[j + 1]; k++)
      sum[(size_t)c->row[k] * columns + j] += c->value[k];
  for (size_t i = 0; i < rows; i++) { /* children come first */
    rhs[i] += c->rhs[i];
    for (size_t j = 0; j < columns; j++) {
      bool leaves = j < (size_t)g->m &&
                    has[i * n + (size_t)g->edge[j][0]] != has[i * n + (size_t)g->edge[j][1]];
      ck_assert(sum[i * columns + j] == (j == (size_t)g->m + i ? -1 : leaves));
      if (t->cut[i].parent >= 0)
        sum[(size_t)t->cut[i].parent * columns + j] += sum[i * columns + j];
    }
    ck_assert(rhs[i] == 1);
    if (t->cut[i].parent >= 0) rhs[t->cut[i].parent] += rhs[i];
  }
  free(sum);
  free(rhs);
  free(has);
}

/* Solves a[n * n] x = b in place by elimination; x comes to stand in b. */
static void solve_square(size_t n, double *a, double *b)
{
  for (size_t k = 0; k < n; k++) {
    size_t best = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
    ck_assert_msg(fabs(a[best * n + k]) > 1e-6, "a singular basis");
    for (size_t j = 0; j < n; j++) {
      double kept = a[k * n + j];
      a[k * n + j] = a[best * n + j], a[best * n + j] = kept;
    }
    double kept = b[k];
    b[k] = b[best], b[best] = kept;
    for (size_t i = 0; i < n; i++) {
      double by = i == k ? 0 : a[i * n + k] / a[k * n + k];
      for (size_t j = k; j < n && by != 0; j++)
        a[i * n + j] -= by * a[k * n + j];
      b[i] -= by * b[k];
    }
  }
  for (size_t k = 0; k < n; k++)
    b[k] /= a[k * n + k];
}

/* The basis matrix in a new array. */
static double *basis_matrix(const thr_cut_programme *c)
{
  size_t n = (size_t)c->n_rows, count = 0;
  double *a = calloc(n * n, sizeof *a);
  ck_assert_ptr_nonnull(a);
  for (int j = 0; j < c->n_columns; j++) {
    if (!c->basic[j]) continue;
    ck_assert_uint_lt(count, n);
    for (int k = c->start[j]; k < c->start[j + 1]; k++)
      a[(size_t)c->row[k] * n + count] += c->value[k];
    count++;
  }
  ck_assert_uint_eq(count, n);
  return a;
}

/* The basis is one, and its point has no negative column and the join's weight. */
static void assert_basis_is_the_join(const graph *g, const thr_tjoin *t, const thr_cut_programme *c)
{
  size_t n = (size_t)c->n_rows, count = 0;
  double *a = basis_matrix(c), *x = calloc(n, sizeof *x), weight = 0, most = 1;
  ck_assert_ptr_nonnull(x);
  memcpy(x, c->rhs, n * sizeof *x);
  solve_square(n, a, x);
  for (int e = 0; e < g->m; e++)
    most = fmax(most, (double)g->weight[e]);
  for (int j = 0; j < c->n_columns; j++) {
    if (!c->basic[j]) continue;
    ck_assert_double_ge(x[count], -1e-9);
    if (j < g->m) weight += (double)g->weight[j] * x[count];
    count++;
  }
  ck_assert_double_eq_tol(weight, (double)t->length, 1e-9 * most);
  free(a);
  free(x);
}

START_TEST(the_programme_on_the_cuts_starts_at_the_join)
{
  rng r = rng_make((uint64_t)_i + 6000);
  for (int k = 0; k < 2 * SHAPES; k++) {
    graph g = draw_graph(&r, rng_between(&r, 5, 40), (shape_kind)(k % SHAPES),
                         (weight_kind)(_i % WEIGHT_KINDS));
    thr_tjoin_problem p = problem_of(&g);
    for (way by = BY_LP; by < WAYS; by++) {
      thr_tjoin t = solve(&g, by);
      thr_cut_programme c = {0};
      if (t.n_cuts) ck_assert_int_eq(thr_cut_programme_init(&c, &p, &t, NULL), THR_OK);
      assert_adds_up_to_cuts(&g, &t, &c);
      if (t.n_cuts && by == BY_MATCHING) assert_basis_is_the_join(&g, &t, &c);
      thr_cut_programme_destroy(&c);
      thr_tjoin_destroy(&t);
    }
    graph_destroy(&g);
  }
}
END_TEST

START_TEST(every_allocation_of_a_confirmation_fails_once)
{
  rng r = rng_make((uint64_t)_i + 7000);
  graph g = draw_graph(&r, 12, (shape_kind)(_i % SHAPES), WEIGHTS_SMALL);
  thr_tjoin_problem p = problem_of(&g);
  thr_tjoin t = solve(&g, _i < SHAPES ? BY_MATCHING : BY_LP);
  int said = 0;
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = confirm(&p, &t, &said, &err);
    thr_alloc_fail_at(0);
    if (st) ck_assert_msg(st == THR_ENOMEM && said == 0, "allocation %ld: %s", k, err.text);
  }
  ck_assert_int_eq(said, 1);
  thr_tjoin_destroy(&t);
  graph_destroy(&g);
}
END_TEST

/* Place 0 in a blossom of width 3 in one of width 4, its mate 1 in one of width 6, the mate itself
 * 2 wide. What place 0 lacks comes from its own blossoms from inside out, then from the mate's from
 * outside in. */
START_TEST(a_negative_width_is_taken_from_the_moats_between_mates)
{
  static const struct {
    int64_t lacking,
        width[5]; /* of place 0, 1, blossom 0 round place 0, 1 round 0, 2 round place 1 */
  } table[] = {{0, {0, 2, 3, 4, 6}},  {2, {0, 2, 1, 4, 6}}, {3, {0, 2, 0, 4, 6}},
               {5, {0, 2, 0, 2, 6}},  {7, {0, 2, 0, 0, 6}}, {9, {0, 2, 0, 0, 4}},
               {14, {0, 1, 0, 0, 0}}, {15, {0, 0, 0, 0, 0}}};
  int mate[2] = {1, 0}, node_blossom[2] = {0, 2}, parent[3] = {1, -1, -1};
  int64_t blossom_dual[3] = {3, 4, 6};
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    int64_t dual[2] = {-table[k].lacking, 2}, start[2];
    thr_matching m = {.mate = mate,
                      .dual = dual,
                      .n_blossoms = 3,
                      .blossom_parent = parent,
                      .node_blossom = node_blossom,
                      .blossom_dual = blossom_dual};
    thr_nest nest;
    bool raised[2];
    ck_assert_int_eq(thr_nest_init(&nest, 2, &m, raised, NULL), THR_OK);
    ck_assert(raised[0] == (table[k].lacking > 0) && !raised[1]);
    for (int s = 0; s < 5; s++)
      ck_assert_int_eq(nest.width[s], table[k].width[s]);
    thr_nest_depths(&nest, start);
    ck_assert_int_eq(start[0], nest.width[0] + nest.width[2] + nest.width[3]);
    ck_assert_int_eq(start[1], nest.width[1] + nest.width[4]);
    ck_assert_int_eq(thr_nest_shared_depth(&nest, 0, 1), 0);
    thr_nest_destroy(&nest);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("moat");
  ADD_EXAMPLES(s, 120, small_ones_match_all_subsets, 20);
  ADD_EXAMPLES(s, 120, medium_ones_agree, 20);
  ADD_EXAMPLES(s, 60, larger_ones_are_proved, 24);
  ADD_EXAMPLES(s, 30, same_input_gives_the_same_join, 24);
  ADD_TEST(s, 30, a_stopped_one_is_valid);
  ADD_EXAMPLES(s, 60, every_allocation_fails_once, 12);
  ADD_EXAMPLES(s, 30, too_large_weights_are_refused_or_go_to_the_other_engine, 2);
  ADD_TEST(s, 30, large_weights_with_a_light_tree_are_matched);
  ADD_EXAMPLES(s, 60, glpk_confirms_what_is_optimal_and_nothing_else, 8);
  ADD_EXAMPLES(s, 60, the_programme_on_the_cuts_starts_at_the_join, 16);
  ADD_EXAMPLES(s, 60, every_allocation_of_a_confirmation_fails_once, 2 * SHAPES);
  ADD_TEST(s, 10, a_negative_width_is_taken_from_the_moats_between_mates);
  return run_suite(s);
}
