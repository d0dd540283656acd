/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-join by linear programming over odd cuts (Edmonds & Johnson 1973; separation: Padberg &
 * Rao 1982).
 *
 * Minimize the sum of w(e) x(e) with x(edges that leave S) >= 1 for every set S with an odd number
 * of nodes of T; the corners of this polyhedron are T-joins, and its dual, a packing of odd cuts,
 * is the proof.
 *
 * Example: a cycle of four edges of weight 1 with two opposite odd nodes: both halves are T-joins
 * of weight 2, and moats of width 1 round each odd node prove it.
 *
 * The cutting-plane loop: solve, separate, round to a join, turn the dual into an exact
 * certificate. */
#include "lp/tjoin/tjoin.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "lp/solver/lp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128
    wide; /* sums of cut values times weights pass 64 bits on hostile inputs */

typedef struct {
  const thr_tjoin_problem *p;
  const thr_limits *limits;
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  thr_search search;
  bool exact;  /* GLPK's exact method, with the weights themselves as costs? */
  double unit; /* costs of the linear programme = weights / unit, so that they are about 1 */
  double *cost, *x, *reduced_cost, *key; /* [n_edges] */
  double *whole;  /* [n_edges] the weights themselves: GLPK's exact method rounds costs that are no
                     integers */
  int64_t *value; /* [search.pool.count] multipliers as integers that load no edge too much */
  int *order, *parent; /* [n_edges], [n_nodes] scratch of the rounding */
  bool *tree_join;     /* [n_edges] */
  bool *leaf_used;     /* [n_leaves] */
  wide *slack;         /* [n_edges] */
  thr_tjoin best;
  thr_scratch own; /* the arrays */
} solver;

static thr_status solver_init(solver *s, const thr_tjoin_problem *tjoin_problem,
                              const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes, m = (size_t)tjoin_problem->n_edges;
  *s = (solver){.p = tjoin_problem, .limits = limits};
  thr_status st = thr_oddcut_graph_init(&s->graph, tjoin_problem, err);
  if (st) return st;
  s->cost = thr_scratch_array(&s->own, m, sizeof *s->cost);
  s->whole = thr_scratch_array(&s->own, m, sizeof *s->whole);
  s->x = thr_scratch_array(&s->own, m, sizeof *s->x);
  s->reduced_cost = thr_scratch_array(&s->own, m, sizeof *s->reduced_cost);
  s->key = thr_scratch_array(&s->own, m, sizeof *s->key);
  s->order = thr_scratch_array(&s->own, m, sizeof *s->order);
  s->parent = thr_scratch_array(&s->own, n, sizeof *s->parent);
  s->tree_join = thr_scratch_array(&s->own, m, sizeof *s->tree_join);
  s->leaf_used = thr_scratch_array(&s->own, (size_t)tjoin_problem->n_leaves, sizeof *s->leaf_used);
  s->slack = thr_scratch_array(&s->own, m, sizeof *s->slack);
  s->best.in_join = thr_calloc(m, sizeof *s->best.in_join);
  s->best.length = INT64_MAX;
  if (!s->best.in_join || thr_scratch_check(&s->own, err)) return thr_nomem(err);
  if ((st = thr_search_init(&s->search, tjoin_problem->n_edges, s->x, err))) return st;
  s->odd = (thr_oddcuts){.graph = &s->graph,
                         .x = s->x,
                         .reduced_cost = s->reduced_cost,
                         .threshold = {1e-6, 0.2, 0.35, 0.51, 0.7},
                         .pool = &s->search.pool};
  thr_search_use(&s->search, thr_oddcuts_moats, &s->odd, 0);
  thr_search_use(&s->search, thr_oddcuts_exact, &s->odd, THR_FALLBACK);
  double sum = 0;
  for (size_t e = 0; e < m; e++)
    sum += s->whole[e] = (double)tjoin_problem->weight[e];
  s->unit = sum > 0 ? sum / (double)m : 1;
  for (size_t e = 0; e < m; e++)
    s->cost[e] = s->reduced_cost[e] = (double)tjoin_problem->weight[e] / s->unit;
  return thr_lp_create(&s->search.lp, tjoin_problem->n_edges, s->cost, NULL, err);
}

static void solver_destroy(solver *s)
{
  thr_search_destroy(&s->search);
  thr_oddcut_graph_destroy(&s->graph);
  thr_scratch_free(&s->own);
  free(s->value);
}

void thr_tjoin_destroy(thr_tjoin *tjoin)
{
  for (int i = 0; i < tjoin->n_cuts; i++)
    free(tjoin->cut[i].node);
  free(tjoin->cut);
  free(tjoin->in_join);
  *tjoin = (thr_tjoin){0};
}

/* ---- rounding: the T-join of a spanning tree that prefers edges of large x ---- */

static _Thread_local const double *sort_key; /* qsort has no user pointer */

static int by_key(const void *pa, const void *pb)
{
  int a = *(const int *)pa, b = *(const int *)pb;
  if (sort_key[a] != sort_key[b]) return sort_key[a] < sort_key[b] ? -1 : 1;
  return (a > b) - (a < b);
}

/* Marks in s->tree_join the edges of a spanning tree, cheapest keys first (a leaf joined to a leaf
 * stays apart). */
static void spanning_tree(solver *s)
{
  const thr_tjoin_problem *tjoin_problem = s->p;
  int first_leaf = tjoin_problem->n_nodes - tjoin_problem->n_leaves;
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    s->order[e] = e;
    s->tree_join[e] = false;
  }
  sort_key = s->key;
  qsort(s->order, (size_t)tjoin_problem->n_edges, sizeof *s->order, by_key);
  memset(s->leaf_used, 0, (size_t)tjoin_problem->n_leaves * sizeof *s->leaf_used);
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    s->parent[v] = v;
  for (int i = 0; i < tjoin_problem->n_edges; i++) {
    int e = s->order[i], a = tjoin_problem->edge[e][0], b = tjoin_problem->edge[e][1];
    if ((a >= first_leaf && s->leaf_used[a - first_leaf]) ||
        (b >= first_leaf && s->leaf_used[b - first_leaf]))
      continue;
    if (a >= first_leaf) s->leaf_used[a - first_leaf] = true;
    if (b >= first_leaf) s->leaf_used[b - first_leaf] = true;
    s->tree_join[e] =
        thr_disjoint_join(s->parent, tjoin_problem->edge[e][0], tjoin_problem->edge[e][1]);
  }
}

/* Keeps of the tree the edges that separate an odd number of odd nodes: the only T-join in it.
 * Leaves inwards. */
static thr_status prune_tree(solver *s, thr_err *err)
{
  thr_scratch own = {0};
  const thr_tjoin_problem *tjoin_problem = s->p;
  size_t n = (size_t)tjoin_problem->n_nodes;
  int *degree = thr_scratch_array(&own, n, sizeof *degree),
      *stack = thr_scratch_array(&own, n, sizeof *stack), top = 0;
  bool *odd = thr_scratch_array(&own, n, sizeof *odd),
       *done = thr_scratch_array(&own, (size_t)tjoin_problem->n_edges, sizeof *done);
  thr_status st = thr_scratch_check(&own, err);
  if (st) goto done;
  memcpy(odd, tjoin_problem->odd, n * sizeof *odd);
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; s->tree_join[e] && i < 2; i++)
      degree[tjoin_problem->edge[e][i]]++;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    if (degree[v] == 1) stack[top++] = v;
  while (top) {
    int v = stack[--top];
    for (int k = s->graph.first[v]; k < s->graph.first[v + 1]; k++) {
      int e = s->graph.incident[k];
      if (!s->tree_join[e] || done[e]) continue;
      int w =
          tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0];
      done[e] = true;
      if (odd[v])
        odd[w] = !odd[w];
      else
        s->tree_join[e] = false;
      if (--degree[w] == 1) stack[top++] = w;
      break;
    }
  }
done:
  thr_scratch_free(&own);
  return st;
}

/* Keeps the T-join of the spanning tree under s->key if it is the best so far. */
static thr_status try_tree(solver *s, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = s->p;
  spanning_tree(s);
  thr_status st = prune_tree(s, err);
  if (st) return st;
  int64_t length = 0;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (s->tree_join[e]) length += tjoin_problem->weight[e];
  if (length < s->best.length) {
    s->best.length = length;
    memcpy(s->best.in_join, s->tree_join, (size_t)tjoin_problem->n_edges * sizeof *s->tree_join);
  }
  return THR_OK;
}

/* Two roundings: of the point x (all 0 at the start), and of the dual, whose tight edges hold every
 * shortest join. */
static thr_status round_to_join(solver *s, thr_err *err)
{
  int m = s->p->n_edges;
  for (int e = 0; e < m; e++)
    s->key[e] = s->cost[e] * (1 - fmin(s->x[e], 1));
  thr_status st = try_tree(s, err);
  for (int e = 0; e < m; e++)
    s->key[e] = fmax(s->reduced_cost[e], 0) + 1e-6 * s->key[e];
  return st ? st : try_tree(s, err);
}

/* ---- the dual as integers ---- */

/* value = dual in units of 1/denominator of a weight, rounded down; then whatever still overloads
 * an edge is taken back from the cuts over it, and what slack is left is given out again: to cuts
 * in use, or with greedy to any cut in turn. dual: [search.pool.count], NULL = all 0. Fills
 * s->value, returns their sum. */
static int64_t integer_dual(solver *s, const double *dual, bool greedy)
{
  const thr_tjoin_problem *tjoin_problem = s->p;
  const thr_pool *pool = &s->search.pool;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    s->slack[e] = (wide)tjoin_problem->weight[e] * THR_DUAL_DENOMINATOR;
  for (int i = 0; i < pool->count; i++) {
    double y = dual ? dual[i] * s->unit * THR_DUAL_DENOMINATOR : 0;
    s->value[i] = y > 1 ? (int64_t)fmin(y, 4e18) : 0;
    for (int k = 0; k < pool->row[i].n; k++)
      s->slack[pool->row[i].column[k]] -= s->value[i];
  }
  wide sum = 0;
  for (int pass = 0; pass < 2; pass++) /* first take back, then give out */
    for (int i = 0; i < pool->count; i++) {
      const thr_row *r = &pool->row[i];
      wide least = s->slack[r->column[0]];
      for (int k = 1; k < r->n; k++)
        if (s->slack[r->column[k]] < least) least = s->slack[r->column[k]];
      if (pass == 0 ? least >= 0 : least <= 0 || (s->value[i] == 0 && !greedy)) continue;
      if (least < -(wide)s->value[i]) least = -(wide)s->value[i];
      s->value[i] += (int64_t)least;
      for (int k = 0; k < r->n; k++)
        s->slack[r->column[k]] -= least;
    }
  for (int i = 0; i < pool->count; i++)
    sum += s->value[i];
  return (int64_t)sum;
}

static thr_status store_cuts(solver *s, int64_t sum, thr_err *err)
{
  const thr_pool *pool = &s->search.pool;
  thr_tjoin *best = &s->best;
  for (int i = 0; i < best->n_cuts; i++)
    free(best->cut[i].node);
  free(best->cut);
  best->n_cuts = 0;
  best->cut = thr_calloc((size_t)pool->count, sizeof *best->cut);
  if (!best->cut) return thr_nomem(err);
  for (int i = 0; i < pool->count; i++) {
    const thr_row *r = &pool->row[i];
    if (s->value[i] == 0) continue;
    thr_cut *to = &best->cut[best->n_cuts];
    *to = (thr_cut){-1, r->n_members, thr_calloc((size_t)r->n_members, sizeof *to->node),
                    s->value[i]};
    if (!to->node) return thr_nomem(err);
    best->n_cuts++;
    memcpy(to->node, r->member, (size_t)r->n_members * sizeof *to->node);
  }
  best->sum = sum;
  return THR_OK;
}

/* Turns multipliers of the rows into a certificate and keeps it if its bound is the best; sets
 * best.optimal. */
static thr_status certify(solver *s, const double *dual, bool greedy, thr_err *err)
{
  int64_t *value = thr_realloc(s->value, (size_t)s->search.pool.count, sizeof *value);
  if (!value) return thr_nomem(err);
  s->value = value;
  int64_t sum = integer_dual(s, dual, greedy);
  thr_status st = THR_OK;
  if (sum > s->best.sum || s->best.n_cuts == 0) st = store_cuts(s, sum, err);
  s->best.optimal = (wide)s->best.sum > ((wide)s->best.length - 1) * THR_DUAL_DENOMINATOR;
  return st;
}

/* ---- the search ---- */

static void report(const solver *s, const char *what)
{
  if (!s->limits->progress) return;
  double denominator = THR_DUAL_DENOMINATOR;
  s->limits->progress(s->limits->user, what, (double)s->best.length,
                      (double)s->best.sum / denominator);
}

/* The exact method needs costs that are integers: the multipliers are brought back to those of
 * s->cost. */
static void reduce_costs(solver *s)
{
  thr_search *search = &s->search;
  for (int i = 0; s->exact && i < search->pool.count; i++)
    search->dual[i] *= 1 / s->unit;
  memcpy(s->reduced_cost, s->cost, (size_t)s->p->n_edges * sizeof *s->cost);
  for (int i = 0; i < search->pool.count; i++)
    thr_row_charge(&search->pool.row[i], search->dual[i], s->reduced_cost);
}

/* Joins from the point, and what its multipliers prove: also of an unfinished solve. */
static thr_status look(void *user, thr_err *err)
{
  solver *s = user;
  reduce_costs(s);
  thr_status st = round_to_join(s, err);
  if (!st) st = certify(s, s->search.dual, false, err);
  if (!st) report(s, "odd cuts");
  s->search.enough = s->best.optimal;
  return st;
}

static thr_status solve_exact(void *user, const thr_limits *limits, thr_lp_outcome *outcome,
                              thr_err *err)
{
  solver *s = user;
  thr_status st = thr_lp_set_costs(s->search.lp, s->whole, err);
  if (!st) st = thr_lp_solve_exact(s->search.lp, limits, outcome, err);
  return st ? st : thr_lp_set_costs(s->search.lp, s->cost, err);
}

/* Balls round the odd nodes, and what they prove before any linear programme is solved. */
static thr_status start(solver *s, thr_err *err)
{
  thr_status st = thr_oddcut_moats(&s->graph, NULL, 0, s->reduced_cost, &s->search.pool, err);
  if (!st) st = round_to_join(s, err);
  return st ? st : certify(s, NULL, true, err);
}

/* Until bound and join meet, separation finds nothing, or the limits stop it. The inexact method
 * cannot tell joins apart whose weights differ by a unit, and so may stop at a point that looks
 * integral: the exact one goes on from there, with cuts of its own. */
static thr_status solve(solver *s, thr_err *err)
{
  enum { PATIENCE = 6 };
  static const char name[] = "an odd-cut relaxation";
  const thr_search_calls calls = {.user = s, .name = name, .look = look, .patience = PATIENCE},
                         exact = {.user = s, .name = name, .solve = solve_exact, .look = look};
  thr_status st = thr_search_rounds(&s->search, &calls, s->limits, err);
  if (st || s->best.optimal || s->search.outcome != THR_LP_OPTIMAL) return st;
  s->exact = true;
  return thr_search_rounds(&s->search, &exact, s->limits, err);
}

static thr_status run(solver *s, thr_err *err)
{
  thr_err failure = {0};
  thr_status st = start(s, err);
  if (st || s->best.optimal) return st;
  st = solve(s, &failure);
  if (st == THR_ENOMEM) return thr_nomem(err);
  if (s->best.optimal) return THR_OK;
  if (st)
    return thr_fail(err, THR_ELIMIT, "%s",
                    failure.text); /* join and bound stay good whatever a library does */
  if (s->search.outcome == THR_LP_STOPPED) return thr_fail(err, THR_ELIMIT, "stopped early");
  return thr_fail(err, THR_ELIMIT,
                  "the odd-cut bound and the best join do not meet; please report this framework");
}

thr_status thr_tjoin_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                           thr_tjoin *out, thr_err *err)
{
  solver s;
  *out = (thr_tjoin){0};
  int n_odd = 0;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    n_odd += tjoin_problem->odd[v];
  if (n_odd == 0) { /* the empty join needs no proof */
    out->in_join = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *out->in_join);
    out->optimal = true;
    return out->in_join ? THR_OK : thr_nomem(err);
  }
  thr_status st = solver_init(&s, tjoin_problem, limits, err);
  if (!st) st = run(&s, err);
  if (!st || st == THR_ELIMIT) {
    thr_cuts forest = {s.best.n_cuts, tjoin_problem->n_nodes, s.best.cut};
    if (thr_cuts_nest(&forest, err)) st = THR_ENOMEM;
    s.best.cut = forest.cut;
  }
  solver_destroy(&s);
  if (st && st != THR_ELIMIT) thr_tjoin_destroy(&s.best);
  *out = s.best;
  return st;
}
