/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a minimum T-join by linear programming over odd cuts (Edmonds & Johnson 1973;
 * separation: Padberg & Rao 1982).
 *
 * The programme minimizes the sum of w(e) x(e) with x >= 0 and x(edges that leave S) >= 1 for every
 * set S with an odd number of nodes of T. The corners of this polyhedron are T-joins, and its dual,
 * a packing of odd cuts, is the proof. There are exponentially many sets, so the cuts are added as
 * they are violated: a round solves the programme, rounds its point to a T-join, turns its
 * multipliers into cut values in exact integers, and separates (oddcut.c).
 *
 * Example: a cycle of four edges of weight 1 with two opposite odd nodes: both halves are T-joins
 * of weight 2, and moats of width 1 round each odd node prove it. */
#include "lp/tjoin/tjoin.h"
#include "graph/arrays.h"
#include "lp/matching/blossom.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sums of cut values times weights pass 64 bits on hostile inputs. */
__extension__ typedef __int128 wide;

typedef struct {
  const thr_tjoin_problem *problem;
  const thr_limits *limits;
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  thr_search search;
  bool exact;  /* GLPK's exact method, with the weights themselves as costs? */
  double unit; /* costs of the linear programme = weights / unit, so that they are about 1 */
  double *cost, *x, *reduced_cost, *key; /* [n_edges] */
  double *whole;   /* [n_edges] the weights themselves: GLPK's exact method rounds costs that are no
                      integers */
  int64_t *value;  /* [search.pool.count] multipliers as integers that load no edge too much */
  int *tree;       /* [n_edges] the edges of the tree that is rounded to */
  bool *tree_join; /* [n_edges] the join within the tree */
  wide *slack;     /* [n_edges] weight * THR_DUAL_DENOMINATOR less the values of the cuts */
  thr_tjoin best;  /* the best join, and the cuts of the best bound */
  thr_scratch own; /* the arrays */
} tjoin_solver;

/* Allocates, and sets up the linear programme without rows and its separators. */
static thr_status solver_init(tjoin_solver *solver, const thr_tjoin_problem *tjoin_problem,
                              const thr_limits *limits, thr_err *err)
{
  size_t n_edges = (size_t)tjoin_problem->n_edges;
  *solver = (tjoin_solver){.problem = tjoin_problem, .limits = limits};
  thr_status st = thr_oddcut_graph_init(&solver->graph, tjoin_problem, err);
  if (st) return st;

  /* All arrays of the loop. */
  solver->cost = thr_scratch_array(&solver->own, n_edges, sizeof *solver->cost);
  solver->whole = thr_scratch_array(&solver->own, n_edges, sizeof *solver->whole);
  solver->x = thr_scratch_array(&solver->own, n_edges, sizeof *solver->x);
  solver->reduced_cost = thr_scratch_array(&solver->own, n_edges, sizeof *solver->reduced_cost);
  solver->key = thr_scratch_array(&solver->own, n_edges, sizeof *solver->key);
  solver->tree = thr_scratch_array(&solver->own, n_edges, sizeof *solver->tree);
  solver->tree_join = thr_scratch_array(&solver->own, n_edges, sizeof *solver->tree_join);
  solver->slack = thr_scratch_array(&solver->own, n_edges, sizeof *solver->slack);
  solver->best.in_join = thr_calloc(n_edges, sizeof *solver->best.in_join);
  solver->best.length = INT64_MAX;
  if (!solver->best.in_join || thr_scratch_check(&solver->own, err)) return thr_nomem(err);

  /* Moats are fast; the exact separation is asked where they find nothing. */
  if ((st = thr_search_init(&solver->search, tjoin_problem->n_edges, solver->x, err))) return st;
  solver->odd = (thr_oddcuts){.graph = &solver->graph,
                              .x = solver->x,
                              .reduced_cost = solver->reduced_cost,
                              .threshold = {1e-6, 0.2, 0.35, 0.51, 0.7},
                              .pool = &solver->search.pool};
  thr_search_use(&solver->search, thr_oddcuts_moats, &solver->odd, 0);
  thr_search_use(&solver->search, thr_oddcuts_exact, &solver->odd, THR_FALLBACK);

  /* Scale the costs to a mean of 1. */
  double sum = 0;
  for (size_t e = 0; e < n_edges; e++)
    sum += solver->whole[e] = (double)tjoin_problem->weight[e];
  solver->unit = sum > 0 ? sum / (double)n_edges : 1;
  for (size_t e = 0; e < n_edges; e++)
    solver->cost[e] = solver->reduced_cost[e] = (double)tjoin_problem->weight[e] / solver->unit;

  return thr_lp_create(&solver->search.lp, tjoin_problem->n_edges, solver->cost, NULL, err);
}

static void solver_destroy(tjoin_solver *solver)
{
  thr_search_destroy(&solver->search);
  thr_oddcut_graph_destroy(&solver->graph);
  thr_scratch_free(&solver->own);
  free(solver->value);
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

/* Rounds by the spanning tree under solver->key, and keeps the T-join if it is the best so far. */
static thr_status try_tree(tjoin_solver *solver, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = solver->problem;
  int n;
  memset(solver->tree_join, 0, (size_t)tjoin_problem->n_edges * sizeof *solver->tree_join);

  /* The only T-join within the tree: the empty set, its parities mended along the tree. */
  thr_status st = thr_forest_find(tjoin_problem, solver->key, INFINITY, tjoin_problem->n_leaves,
                                  solver->tree, &n, err);
  if (!st) st = thr_forest_mend(tjoin_problem, solver->tree, n, solver->tree_join, err);
  if (st) return st;

  int64_t length = 0;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (solver->tree_join[e]) length += tjoin_problem->weight[e];

  if (length < solver->best.length) {
    solver->best.length = length;
    memcpy(solver->best.in_join, solver->tree_join,
           (size_t)tjoin_problem->n_edges * sizeof *solver->tree_join);
  }
  return THR_OK;
}

/* Rounds twice: by the point x (all 0 at the start), and by the dual, whose tight edges contain
 * every minimum join once the dual is optimal. */
static thr_status round_to_join(tjoin_solver *solver, thr_err *err)
{
  int n_edges = solver->problem->n_edges;
  for (int e = 0; e < n_edges; e++)
    solver->key[e] = solver->cost[e] * (1 - fmin(solver->x[e], 1));
  thr_status st = try_tree(solver, err);

  /* Among tight edges the point decides. */
  for (int e = 0; e < n_edges; e++)
    solver->key[e] = fmax(solver->reduced_cost[e], 0) + 1e-6 * solver->key[e];
  return st ? st : try_tree(solver, err);
}

/* ---- the dual as integers ---- */

/* Fills solver->value with integer values of the rows that overload no edge, and returns their
 * sum. dual[search.pool.count] in units of a cost, NULL = all 0. greedy: rows whose multiplier
 * is 0 may get a value, too. */
static int64_t integer_dual(tjoin_solver *solver, const double *dual, bool greedy)
{
  const thr_tjoin_problem *tjoin_problem = solver->problem;
  const thr_pool *pool = &solver->search.pool;

  /* Round the multipliers down, and compute the slack that they leave on every edge. */
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    solver->slack[e] = (wide)tjoin_problem->weight[e] * THR_DUAL_DENOMINATOR;
  for (int i = 0; i < pool->count; i++) {
    double scaled = dual ? dual[i] * solver->unit * THR_DUAL_DENOMINATOR : 0;
    solver->value[i] = scaled > 1 ? (int64_t)fmin(scaled, 4e18) : 0;
    for (int k = 0; k < pool->row[i].n; k++)
      solver->slack[pool->row[i].column[k]] -= solver->value[i];
  }

  /* The first pass takes back what overloads an edge, the second hands out slack that is left. */
  wide sum = 0;
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < pool->count; i++) {
      const thr_row *row = &pool->row[i];
      wide least = solver->slack[row->column[0]];
      for (int k = 1; k < row->n; k++)
        if (solver->slack[row->column[k]] < least) least = solver->slack[row->column[k]];
      if (pass == 0 ? least >= 0 : least <= 0 || (solver->value[i] == 0 && !greedy)) continue;

      /* Change the value by the least slack of the row's edges, but not below 0. */
      if (least < -(wide)solver->value[i]) least = -(wide)solver->value[i];
      solver->value[i] += (int64_t)least;
      for (int k = 0; k < row->n; k++)
        solver->slack[row->column[k]] -= least;
    }

  for (int i = 0; i < pool->count; i++)
    sum += solver->value[i];
  return (int64_t)sum;
}

/* Replaces the cuts of the best bound by the rows with a value. */
static thr_status store_cuts(tjoin_solver *solver, int64_t sum, thr_err *err)
{
  const thr_pool *pool = &solver->search.pool;
  thr_tjoin *best = &solver->best;

  /* Release the cuts of the bound before. */
  for (int i = 0; i < best->n_cuts; i++)
    free(best->cut[i].node);
  free(best->cut);
  best->n_cuts = 0;
  best->cut = thr_calloc((size_t)pool->count, sizeof *best->cut);
  if (!best->cut) return thr_nomem(err);

  /* Each row with a value becomes a cut of its members. */
  for (int i = 0; i < pool->count; i++) {
    const thr_row *row = &pool->row[i];
    if (solver->value[i] == 0) continue;
    thr_cut *cut = &best->cut[best->n_cuts];
    *cut = (thr_cut){-1, row->n_members, thr_calloc((size_t)row->n_members, sizeof *cut->node),
                     solver->value[i]};
    if (!cut->node) return thr_nomem(err);
    best->n_cuts++;
    memcpy(cut->node, row->member, (size_t)row->n_members * sizeof *cut->node);
  }

  best->sum = sum;
  return THR_OK;
}

/* Turns multipliers of the rows into cuts with integer values, keeps them if their bound is the
 * best so far, and sets best.optimal. */
static thr_status certify(tjoin_solver *solver, const double *dual, bool greedy, thr_err *err)
{
  int64_t *value = thr_realloc(solver->value, (size_t)solver->search.pool.count, sizeof *value);
  if (!value) return thr_nomem(err);
  solver->value = value;

  int64_t sum = integer_dual(solver, dual, greedy);
  thr_status st = THR_OK;
  if (sum > solver->best.sum || solver->best.n_cuts == 0) st = store_cuts(solver, sum, err);

  /* Weights are integers: a bound above length - 1 proves the join. */
  solver->best.optimal =
      (wide)solver->best.sum > ((wide)solver->best.length - 1) * THR_DUAL_DENOMINATOR;
  return st;
}

/* ---- the search ---- */

/* Reports the best join and bound, as cord. */
static void report(const tjoin_solver *solver)
{
  const thr_limits *limits = solver->limits;
  if (!limits->progress || limits->weight == 0) return;
  double denominator = THR_DUAL_DENOMINATOR;
  limits->progress(limits->user, "extra cord", (double)solver->best.length * limits->weight,
                   (double)solver->best.sum / denominator * limits->weight);
}

/* Computes the reduced costs. The exact method works on the weights themselves, so its
 * multipliers are scaled to the costs first. */
static void reduce_costs(tjoin_solver *solver)
{
  thr_search *search = &solver->search;
  for (int i = 0; solver->exact && i < search->pool.count; i++)
    search->dual[i] *= 1 / solver->unit;

  memcpy(solver->reduced_cost, solver->cost,
         (size_t)solver->problem->n_edges * sizeof *solver->cost);
  for (int i = 0; i < search->pool.count; i++)
    thr_row_charge(&search->pool.row[i], search->dual[i], solver->reduced_cost);
}

/* Looks at a solved programme: rounds its point to joins, and computes the bound that its
 * multipliers prove, which is valid even if the solve was not finished. */
static thr_status look(void *user, thr_err *err)
{
  tjoin_solver *solver = user;
  reduce_costs(solver);
  thr_status st = round_to_join(solver, err);
  if (!st) st = certify(solver, solver->search.dual, false, err);
  if (!st) report(solver);

  solver->search.enough = solver->best.optimal;
  return st;
}

/* Solves the programme by GLPK's exact method on integer costs, and puts the scaled costs back. */
static thr_status solve_exact(void *user, const thr_limits *limits, thr_lp_outcome *outcome,
                              thr_err *err)
{
  tjoin_solver *solver = user;
  thr_status st = thr_lp_set_costs(solver->search.lp, solver->whole, err);
  if (!st) st = thr_lp_solve_exact(solver->search.lp, limits, outcome, err);
  return st ? st : thr_lp_set_costs(solver->search.lp, solver->cost, err);
}

/* Grows balls round the odd nodes, which give a first join and a first bound before any linear
 * programme is solved. */
static thr_status start(tjoin_solver *solver, thr_err *err)
{
  thr_status st =
      thr_oddcut_moats(&solver->graph, NULL, 0, solver->reduced_cost, &solver->search.pool, err);
  if (!st) st = round_to_join(solver, err);
  return st ? st : certify(solver, NULL, true, err);
}

/* Runs rounds until bound and join meet, separation finds nothing, or the limits stop them. In
 * floating point, joins whose weights differ by one unit cannot be told apart, so that the
 * rounds may end at an integral point before the bound is proved. The exact method then goes on
 * with cuts of its own. */
static thr_status solve(tjoin_solver *solver, thr_err *err)
{
  enum { PATIENCE = 6 };
  static const char name[] = "an odd-cut relaxation";
  const thr_search_calls calls = {.user = solver, .name = name, .look = look, .patience = PATIENCE},
                         exact = {.user = solver, .name = name, .solve = solve_exact, .look = look};

  thr_status st = thr_search_rounds(&solver->search, &calls, solver->limits, err);
  if (st || solver->best.optimal || solver->search.outcome != THR_LP_OPTIMAL) return st;

  solver->exact = true;
  return thr_search_rounds(&solver->search, &exact, solver->limits, err);
}

/* Runs the algorithm; THR_ELIMIT if join and bound do not meet, both being valid all the same. */
static thr_status run(tjoin_solver *solver, thr_err *err)
{
  /* The odd nodes' balls are often enough. */
  thr_err failure = {0};
  thr_status st = start(solver, err);
  if (st || solver->best.optimal) return st;

  /* A failure of the library leaves the best join and bound as they are. */
  st = solve(solver, &failure);
  if (st == THR_ENOMEM) return thr_nomem(err);
  if (solver->best.optimal) return THR_OK;
  if (st) return thr_fail(err, THR_ELIMIT, "%s", failure.text);
  if (solver->search.outcome == THR_LP_STOPPED) return thr_fail(err, THR_ELIMIT, "stopped early");
  return thr_fail(err, THR_ELIMIT,
                  "the odd-cut bound and the best join do not meet; please report this framework");
}

thr_status thr_tjoin_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                           thr_tjoin *out, thr_err *err)
{
  tjoin_solver solver;
  *out = (thr_tjoin){0};

  int n_odd = 0;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    n_odd += tjoin_problem->odd[v];

  /* The empty join needs no proof. */
  if (n_odd == 0) {
    out->in_join = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *out->in_join);
    out->optimal = true;
    return out->in_join ? THR_OK : thr_nomem(err);
  }

  thr_status st = solver_init(&solver, tjoin_problem, limits, err);
  if (!st) st = run(&solver, err);

  /* Nest the cuts into a forest, also if the limits stopped the work. */
  if (!st || st == THR_ELIMIT) {
    thr_cuts forest = {solver.best.n_cuts, tjoin_problem->n_nodes, solver.best.cut};
    if (thr_cuts_nest(&forest, err)) st = THR_ENOMEM;
    solver.best.cut = forest.cut;
  }

  solver_destroy(&solver);
  if (st && st != THR_ELIMIT) thr_tjoin_destroy(&solver.best);
  *out = solver.best;
  return st;
}
