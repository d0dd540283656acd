/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tied nodes: the turns of one against all turns, walks against prices from scratch, the ascent's
 * bound against enumeration's optimum in a linear programme with all rows. */
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "lp/solver/solver.h"
#include "tests/frameworks.h"
#include "tortuosity/proof/relax_parts.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- what it costs to tie a node, by trying all turns there ---- */

enum { MOST_TIED = 6 }; /* edges of a node */

typedef struct {
  int d;                              /* edges; point d stands for the cord ends */
  int left[MOST_TIED + 1];            /* passes of an edge, ends */
  double price[MOST_TIED][MOST_TIED]; /* of a turn between edges i < j */
  unsigned link[MOST_TIED + 1];       /* zero between calls */
  double least;
} tied_star;

static bool connected(int d, const unsigned *link)
{
  unsigned seen = 1, next = 1;
  while (next) {
    int i = 0;
    while (!(next >> i & 1u))
      i++;
    next &= ~(1u << i);
    next |= link[i] & ~seen;
    seen |= link[i];
  }
  return seen == (1u << d) - 1;
}

/* Numbers of turns between points a and b and all later pairs, of which none is of a point with
 * itself. */
static void all_turns(tied_star *k, int a, int b, double price)
{
  if (b > k->d) {
    if (k->left[a] > 0) return;
    a++;
    b = a + 1;
  }
  if (price >= k->least) return;
  if (a == k->d) {
    if (k->left[a] == 0 && connected(k->d, k->link)) k->least = price;
    return;
  }
  bool end = b == k->d;
  int most = k->left[a] < k->left[b] ? k->left[a] : k->left[b];
  for (int n = 0; n <= most; n++) {
    unsigned before[2] = {k->link[a], k->link[b]};
    if (n > 0 && !end) {
      k->link[a] |= 1u << b;
      k->link[b] |= 1u << a;
    }
    k->left[a] -= n;
    k->left[b] -= n;
    all_turns(k, a, b + 1, price + (end ? 0 : n * k->price[a][b]));
    k->left[a] += n;
    k->left[b] += n;
    k->link[a] = before[0];
    k->link[b] = before[1];
  }
}

/* Least price of turns that take all passes and ends, none back into its own edge, and tie the
 * edges; INFINITY: there are none.
 */
static double least_by_all_turns(tied_star *k)
{
  k->least = INFINITY;
  all_turns(k, 0, 1, 0);
  return k->least;
}

/* A framework with its columns; ends: open cords, ends anywhere. */
typedef struct {
  thr_frame f;
  bool *end_allowed;
  thr_turning_task task;
  thr_turning_columns c;
  int *passes, *ends;
} world;

/* Columns of f, which is moved. */
static void world_make(world *w, thr_frame f, int cover, bool ends, double slack)
{
  *w = (world){.f = f, .end_allowed = calloc((size_t)f.n_nodes, 1)};
  memset(w->end_allowed, 1, (size_t)f.n_nodes);
  w->task = (thr_turning_task){.cover = cover,
                               .most_passes = thr_turning_most_passes(&w->f, cover),
                               .cords = f.n_nodes, /* no leaf is one too many */
                               .end_allowed = ends ? w->end_allowed : NULL,
                               .tube = true,
                               .extra_limit = slack};
  thr_err err = {0};
  assert_ok(thr_turning_columns_init(&w->c, &w->f, &w->task, &err), &err);
  w->passes = calloc((size_t)f.n_edges, sizeof *w->passes);
  w->ends = calloc((size_t)f.n_nodes, sizeof *w->ends);
}

static void world_destroy(world *w)
{
  thr_turning_columns_destroy(&w->c);
  thr_frame_destroy(&w->f);
  free(w->end_allowed);
  free(w->passes);
  free(w->ends);
}

static double weight(const thr_turning_columns *c, int column)
{
  return ldexp((double)c->weight[column], -THR_TURNING_BITS);
}

/* ---- one node ---- */

/* Spokes in random directions. */
static thr_frame random_star(rng *r, int d)
{
  double xyz[MOST_TIED + 1][3] = {{0}};
  int edge[MOST_TIED][2];
  for (int i = 0; i < d; i++) {
    for (int k = 0; k < 3; k++)
      xyz[i + 1][k] = rng_unit(r) - 0.5;
    edge[i][0] = 0;
    edge[i][1] = i + 1;
  }
  return frame_make(d + 1, (const double(*)[3])xyz, d, (const int(*)[2])edge, NULL, NULL);
}

/* Do the knot's pairs take all passes and ends of node 0, as its price says? */
static void assert_pairs(const thr_knot *k, const world *w)
{
  int used[MOST_TIED + 1] = {0};
  double price = 0;
  for (int i = 0; i < k->n; i++) {
    int a = k->pair[i].a, b = k->pair[i].b;
    ck_assert_int_ne(a, b);
    used[a]++;
    used[b]++;
    if (a < k->d && b < k->d)
      price += weight(&w->c, thr_turning_column(&w->c, w->f.half[a], w->f.half[b]));
  }
  for (int i = 0; i < k->d; i++)
    ck_assert_int_eq(used[i], w->passes[w->f.half[i] >> 1]);
  ck_assert_int_eq(used[k->d], w->ends[0]);
  ck_assert_double_eq_tol(price, k->turning, 1e-9);
}

START_TEST(nodes_by_all_turns)
{
  enum { EACH = 120 };
  rng r = rng_make(500 + (uint64_t)_i);
  int tied = 0, dearer = 0;
  for (int i = 0; i < EACH; i++) {
    world w;
    thr_knot k;
    int d = rng_between(&r, 2, MOST_TIED - 1);
    world_make(&w, random_star(&r, d), 1, true, -1);
    for (int e = 0; e < d; e++)
      w.passes[e] = 1 + rng_below(&r, 3) * rng_below(&r, 2);
    w.ends[0] = rng_below(&r, 3);
    ck_assert_int_eq(thr_knot_init(&k, &w.c, 40, NULL), THR_OK);
    tied_star s = {.d = d};
    for (int a = 0; a < d; a++) {
      s.left[a] = w.passes[w.f.half[a] >> 1];
      for (int b = a + 1; b < d; b++)
        s.price[a][b] = weight(&w.c, thr_turning_column(&w.c, w.f.half[a], w.f.half[b]));
    }
    s.left[d] = w.ends[0];
    double least = least_by_all_turns(&s);
    bool found = thr_knot_tie(&k, 0, w.passes, w.ends);
    ck_assert(found == isfinite(least));
    if (found) {
      assert_pairs(&k, &w);
      ck_assert_double_ge(k.turning, least - 1e-9);
      tied++;
      dearer += k.turning > least + 1e-6;
    }
    thr_knot_destroy(&k);
    world_destroy(&w);
  }
  ck_assert_int_gt(tied, EACH / 6);
  ck_assert_int_le(dearer, tied / 30);
}
END_TEST

/* ---- walks ---- */

/* Price of passes and ends by the turns that tie them, all nodes anew. */
static double price_from_scratch(const world *w)
{
  const thr_turning_columns *c = &w->c;
  int *x = calloc((size_t)c->n_columns, sizeof *x);
  bool found = false, tied = false;
  double price = 0;
  ck_assert_int_eq(thr_tie_pair(c, w->passes, w->ends, x, &found, NULL), THR_OK);
  ck_assert(found);
  ck_assert_int_eq(thr_tie_holds(c, x, &tied, NULL), THR_OK);
  ck_assert(tied);
  for (int e = 0; e < w->f.n_edges; e++) {
    ck_assert(w->passes[e] >= c->cover[e] && w->passes[e] <= c->most[e]);
    x[c->first_extra + e] = w->passes[e] - c->cover[e];
  }
  for (int j = 0; j < c->first_end; j++)
    price += x[j] * weight(c, j);
  free(x);
  return price;
}

static int sum_of(const int *a, int n)
{
  int sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i];
  return sum;
}

/* Walks of all kinds change the price by what they say, and move no end away. */
START_TEST(walks_change_what_they_say)
{
  rng r = rng_make(800 + (uint64_t)_i);
  int taken = 0;
  for (int i = 0; i < 12; i++) {
    world w;
    thr_walker walk;
    bool found;
    world_make(&w,
               i % 3 ? random_frame(&r, rng_between(&r, 5, 9), 8, LENGTHS_EUCLID) : grid_make(3, 4),
               1, true, -1);
    ck_assert_int_eq(thr_tie_round(&w.c, NULL, w.passes, w.ends, &found, NULL), THR_OK);
    if (!found) {
      world_destroy(&w);
      continue;
    }
    int ends = sum_of(w.ends, w.f.n_nodes);
    ck_assert_int_eq(thr_walker_init(&walk, &w.c, w.passes, w.ends, NULL), THR_OK);
    for (int k = 0; k < 40; k++) {
      double before = walk.total, allowed = 4 * rng_unit(&r);
      thr_walker_search(&walk, rng_below(&r, 4 * w.f.n_edges), allowed);
      if (walk.last < 0) continue;
      double change = walk.saved;
      thr_walker_take(&walk);
      taken++;
      ck_assert_double_lt(change, allowed);
      ck_assert_double_eq_tol(walk.total, before + change, 1e-9);
      ck_assert_double_eq_tol(walk.total, price_from_scratch(&w), 1e-9);
      ck_assert_int_eq(sum_of(w.ends, w.f.n_nodes), ends);
    }
    thr_walker_destroy(&walk);
    double best = price_from_scratch(&w);
    ck_assert_int_eq(thr_tie_anneal(&w.c, &(thr_limits){0}, 1, w.passes, w.ends, NULL), THR_OK);
    ck_assert_double_le(price_from_scratch(&w), best + 1e-9);
    world_destroy(&w);
  }
  ck_assert_int_gt(taken, 50);
}
END_TEST

START_TEST(walks_keep_the_length)
{
  world w;
  bool found;
  double length = 0, limit = 16;
  world_make(&w, grid_make(4, 4), 1, false, limit);
  ck_assert_int_eq(thr_tie_round(&w.c, NULL, w.passes, w.ends, &found, NULL), THR_OK);
  ck_assert(found);
  ck_assert_int_eq(thr_tie_anneal(&w.c, &(thr_limits){0}, 2, w.passes, w.ends, NULL), THR_OK);
  for (int e = 0; e < w.f.n_edges; e++)
    length += (w.passes[e] - 1) * w.f.length[e];
  ck_assert_double_le(length, limit);
  world_destroy(&w);
}
END_TEST

/* ---- the ascent ---- */

typedef struct {
  const thr_turning_columns *c;
  thr_lp *lp;
  int v, d, block[MOST_TIED], *column;
} divider;

/* The rows of all divisions of a node's edges that go on from the first k of them in n blocks. */
static void add_divisions(divider *g, int k, int n)
{
  const int *half = g->c->f->half + g->c->f->first[g->v];
  if (k < g->d) {
    for (int b = 0; b <= n; b++) {
      g->block[k] = b;
      add_divisions(g, k + 1, b == n ? n + 1 : n);
    }
    return;
  }
  int count = 0;
  for (int i = 0; i < g->d; i++)
    for (int j = i + 1; j < g->d; j++)
      if (g->block[i] != g->block[j])
        g->column[count++] = thr_turning_column(g->c, half[i], half[j]);
  if (n > 1) ck_assert_int_eq(thr_lp_add_row(g->lp, count, g->column, NULL, n - 1, NULL), THR_OK);
}

/* Sum over both half-edges of edge e: passes there less sign * what turns at the other one; <= and
 * >= make them equal. */
static void add_balance(const thr_turning_columns *c, thr_lp *lp, int e, double sign, int *column,
                        double *value)
{
  const thr_frame *f = c->f;
  int n = 0;
  for (int h = 2 * e; h <= 2 * e + 1; h++) {
    int v = thr_tail(f, h);
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      if (f->half[i] == h) continue;
      column[n] = thr_turning_column(c, h, f->half[i]);
      value[n++] = h % 2 ? -sign : sign;
    }
  }
  ck_assert_int_eq(thr_lp_add_row(lp, n, column, value, 0, NULL), THR_OK);
}

/* Closed cords, cover 1: the linear programme of turns alone with every row that ties a node. */
static double tied_optimum(const thr_turning_columns *c)
{
  double *cost = calloc((size_t)c->first_extra, sizeof *cost),
         *value = calloc((size_t)c->first_extra, sizeof *value);
  divider g = {.c = c, .column = calloc((size_t)c->first_extra, sizeof *g.column)};
  thr_lp_outcome outcome;
  for (int j = 0; j < c->first_extra; j++)
    cost[j] = weight(c, j);
  ck_assert_int_eq(thr_lp_create(&g.lp, c->first_extra, cost, NULL, NULL), THR_OK);
  for (int e = 0; e < c->f->n_edges; e++) {
    add_balance(c, g.lp, e, 1, g.column, value);
    add_balance(c, g.lp, e, -1, g.column, value);
  }
  for (g.v = 0; g.v < c->f->n_nodes; g.v++) {
    g.d = thr_degree(c->f, g.v);
    add_divisions(&g, 0, 0);
  }
  ck_assert_int_eq(thr_lp_solve(g.lp, &(thr_limits){0}, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_OPTIMAL);
  double optimum = thr_lp_objective(g.lp);
  thr_lp_destroy(g.lp);
  free(g.column);
  free(cost);
  free(value);
  return optimum;
}

/* What the checker says of the ascent's multipliers. */
static double ascent_bound(const thr_turning_columns *c, const thr_limits *limits)
{
  thr_turning_dual d;
  int64_t bound;
  thr_err err = {0};
  int *low = calloc((size_t)c->n_columns, sizeof *low),
      *high = calloc((size_t)c->n_columns, sizeof *high);
  double *mean = calloc((size_t)c->n_columns, sizeof *mean);
  for (int j = 0; j < c->n_columns; j++)
    high[j] = thr_turning_most(c, j);
  assert_ok(thr_ascent_run(c, INFINITY, limits, &d, mean, &err), &err);
  assert_ok(thr_turning_dual_bound(c, &d, low, high, &bound, &err), &err);
  for (int j = 0; j < c->n_columns; j++)
    ck_assert(mean[j] >= 0 && (j >= c->first_extra || mean[j] == 0));
  thr_turning_dual_destroy(&d);
  free(low);
  free(high);
  free(mean);
  return ldexp((double)bound, -THR_TURNING_BITS);
}

/* Never above the linear programme, which no plan undercuts, and near it. */
START_TEST(ascent_comes_near_the_programme)
{
  rng r = rng_make(40 + (uint64_t)_i);
  double reached = 0, possible = 0;
  for (int i = 0; i < 8; i++) {
    world w;
    thr_frame f = i < 2    ? solid_make(i ? ICOSAHEDRON : OCTAHEDRON)
                  : i == 2 ? grid_make(4, 5)
                           : random_frame(&r, 7, 12, LENGTHS_EUCLID);
    bool fits = true;
    for (int v = 0; v < f.n_nodes; v++)
      fits &= thr_degree(&f, v) <= MOST_TIED && thr_degree(&f, v) > 1;
    if (!fits) {
      thr_frame_destroy(&f);
      continue;
    }
    world_make(&w, f, 1, false, -1);
    double optimum = tied_optimum(&w.c), bound = ascent_bound(&w.c, &(thr_limits){0});
    ck_assert_double_le(bound, optimum + 1e-6);
    reached += bound;
    possible += optimum;
    world_destroy(&w);
  }
  ck_assert_double_ge(reached, 0.98 * possible);
}
END_TEST

/* With ends, covers and a limit on the length: never above the price of passes that keep to them;
 * and a bound without any time.
 */
START_TEST(ascent_stays_below_plans)
{
  rng r = rng_make(90 + (uint64_t)_i);
  const thr_limits no_time = {.deadline = 1e-9};
  for (int i = 0; i < 10; i++) {
    world w;
    bool found;
    double slack = rng_below(&r, 2) ? -1 : 60;
    world_make(&w, random_frame(&r, rng_between(&r, 4, 8), 6, LENGTHS_EQUAL), rng_between(&r, 1, 2),
               rng_below(&r, 2), slack);
    w.task.cords_least = 1;
    thr_turning_columns_destroy(&w.c);
    ck_assert_int_eq(thr_turning_columns_init(&w.c, &w.f, &w.task, NULL), THR_OK);
    ck_assert_int_eq(thr_tie_round(&w.c, NULL, w.passes, w.ends, &found, NULL), THR_OK);
    double bound = ascent_bound(&w.c, &(thr_limits){0}), at_once = ascent_bound(&w.c, &no_time);
    ck_assert_double_ge(bound, at_once - 1e-9);
    if (found) {
      ck_assert_int_eq(thr_tie_anneal(&w.c, &(thr_limits){0}, 1, w.passes, w.ends, NULL), THR_OK);
      ck_assert_double_le(bound, price_from_scratch(&w) + 1e-6);
    }
    world_destroy(&w);
  }
}
END_TEST

/* ---- memory ---- */

/* All steps one after the other; nothing goes into t. */
static thr_status run_steps(const void *user, thr_text *t, thr_err *err)
{
  const world *w = user;
  (void)t;
  thr_turning_dual d = {0};
  bool found;
  double *mean = calloc((size_t)w->c.n_columns, sizeof *mean);
  thr_status st = thr_ascent_run(&w->c, INFINITY, &(thr_limits){0}, &d, mean, err);
  if (!st) st = thr_tie_round(&w->c, mean, w->passes, w->ends, &found, err);
  if (!st) st = thr_tie_anneal(&w->c, &(thr_limits){0}, 1, w->passes, w->ends, err);
  thr_turning_dual_destroy(&d);
  free(mean);
  return st;
}

START_TEST(every_allocation_may_fail)
{
  world w;
  world_make(&w, grid_make(2, 3), 1, _i == 1, -1);
  assert_allocations_may_fail(run_steps, &w, 2000);
  world_destroy(&w);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tie");
  ADD_EXAMPLES(s, 120, every_allocation_may_fail, 2);
  ADD_EXAMPLES(s, 120, nodes_by_all_turns, 6);
  ADD_EXAMPLES(s, 120, walks_change_what_they_say, 3);
  ADD_TEST(s, 60, walks_keep_the_length);
  ADD_EXAMPLES(s, 120, ascent_comes_near_the_programme, 3);
  ADD_EXAMPLES(s, 120, ascent_stays_below_plans, 3);
  return run_suite(s);
}
