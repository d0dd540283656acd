/* Rows, separation and multipliers of the turning relaxation. */
#include "tortuosity/proof/relax.h"
#include "graph/framework/frame.h"
#include "graph/sort.h"
#include "tortuosity/proof/column_groups.h"
#include "tortuosity/proof/partition.h"
#include "tortuosity/proof/project.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6;

/* The first column of the programme. */
static int first_column(const thr_relax *r)
{
  return r->projected ? r->c->first_extra : 0;
}

/* The limit on the extra length, in units of the longest edge; then it is one of the equations as far as rows are counted. */
static thr_status add_length_row(thr_relax *r, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int m = c->f->n_edges;
  int *column = thr_calloc((size_t)m + 1, sizeof *column);
  double *value = thr_calloc((size_t)m + 1, sizeof *value);
  thr_status st = column && value ? THR_OK : thr_nomem(err);
  for (int e = 0; e < m && !st; e++) {
    column[e] = c->first_extra + e;
    value[e] = -ldexp((double)c->length[e], -THR_LENGTH_BITS);
  }
  if (!st) {
    column[m] = r->n_all - 1;
    value[m] = 1;
    st = thr_lp_add_row(r->lp, m + 1, column, value, -ldexp((double)c->extra_limit, -THR_LENGTH_BITS), err);
    r->n_equations++;
  }
  free(column);
  free(value);
  return st;
}

static thr_status init_graph(thr_relax *r, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges, n = darts + c->n_ends, m = c->first_back;
  int(*edge)[2] = thr_calloc((size_t)m, sizeof *edge);
  bool *odd = thr_calloc((size_t)n, sizeof *odd);
  r->problem = (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .odd = odd};
  if (!edge || !odd) return thr_nomem(err);
  for (int j = 0; j < m; j++) {
    edge[j][0] = c->half[j][0];
    edge[j][1] = c->half[j][1] >= 0 ? c->half[j][1] : darts + c->end_group[thr_tail(c->f, c->half[j][0])];
  }
  for (int h = 0; h < darts; h++)
    r->any_odd |= odd[h] = c->cover[h >> 1] % 2;
  for (int k = 0; k < c->n_ends; k++)
    r->any_odd |= odd[darts + k] = c->supply[k][0] % 2;
  return thr_oddcut_graph_init(&r->graph, &r->problem, err);
}

/* The first odd sets: the half-edges of one node, an extra pass or an end at every node of odd degree. */
static thr_status add_node_sets(thr_relax *r, thr_err *err)
{
  const thr_frame *f = r->c->f;
  thr_status st = THR_OK;
  for (int v = 0; v < f->n_nodes && !st; v++)
    st = thr_oddcut_add(&r->graph, &r->pool, f->half + f->first[v], thr_degree(f, v), err);
  return st;
}

thr_status thr_relax_init(thr_relax *r, const thr_turning_columns *c, bool projected, double penalty, const thr_limits *limits,
                          thr_err *err)
{
  size_t n = (size_t)c->n_columns;
  *r = (thr_relax){.c = c, .projected = projected};
  if (!projected) r->n_equations = 2 * c->f->n_edges + (c->task->end_allowed ? c->n_ends : 0);
  r->n_all = c->n_columns + 2 * r->n_equations + 1;
  r->x = thr_calloc((size_t)r->n_all, sizeof *r->x);
  r->reduced = thr_calloc(n, sizeof *r->reduced);
  thr_status st = r->x && r->reduced ? THR_OK : thr_nomem(err);
  if (!st) st = thr_pool_init(&r->pool, projected ? c->first_back - c->first_extra : c->n_columns, err);
  if (!st) st = projected ? thr_project_create(r, penalty, err) : thr_relax_create(r, penalty, err);
  if (!st && c->extra_limit >= 0) st = add_length_row(r, err);
  for (int j = c->first_extra; j < c->n_columns && !st; j++) /* turns: by their equations */
    st = thr_lp_set_bounds(r->lp, j - first_column(r), 0, thr_turning_most(c, j), err);
  if (!st && !projected) st = thr_relax_crash(r, limits, err);
  if (!st) st = projected ? thr_project_graph(r, err) : init_graph(r, err);
  if (!st && !projected) st = add_node_sets(r, err);
  if (st) thr_relax_destroy(r);
  return st;
}

void thr_relax_destroy(thr_relax *r)
{
  thr_lp_destroy(r->lp);
  free(r->x);
  free(r->dual);
  free(r->reduced);
  thr_pool_destroy(&r->pool);
  thr_oddcut_graph_destroy(&r->graph);
  free((void *)r->problem.edge);
  free((void *)r->problem.odd);
  *r = (thr_relax){0};
}

thr_status thr_relax_set(thr_relax *r, int column, int low, int high, thr_err *err)
{
  bool unbounded = column < r->c->first_extra && high == thr_turning_most(r->c, column);
  return thr_lp_set_bounds(r->lp, column - first_column(r), low, unbounded ? (double)INFINITY : high, err);
}

/* ---- rows ---- */

thr_status thr_relax_odd(thr_relax *r, bool exact, int *added, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.2, 0.35, 0.51, 0.7};
  const int before = r->pool.count, first = first_column(r);
  const double *x = r->x + first;
  thr_status st = THR_OK;
  if (!r->any_odd) return THR_OK; /* all sets are even */
  if (exact) st = thr_oddcut_exact(&r->graph, x, &r->pool, err);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && !exact && !st && r->pool.count == before; i++) {
    st = thr_oddcut_moats(&r->graph, x, threshold[i], r->reduced + first, &r->pool, err);
    if (!st) st = thr_pool_keep_violated(&r->pool, before, x, tolerance, added, err);
  }
  return st || !exact ? st : thr_pool_keep_violated(&r->pool, before, x, tolerance, added, err);
}

/* ---- groups ---- */

/* Puts the columns that leave the edges of a group, which are marked. */
static void put_crossing(thr_relax *r, const int *edge, int n, const bool *inside)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  for (int k = 0; k < 2 * n; k++) {
    int h = 2 * edge[k / 2] + k % 2, v = thr_tail(f, h);
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      if (!inside[f->half[i] >> 1]) thr_pool_put(&r->pool, thr_turning_column(c, h, f->half[i]), 1);
    if (c->end_column[h] >= 0) thr_pool_put(&r->pool, c->end_column[h], 1);
  }
}

/* Adds the group's row if x violates it and it is new. */
static thr_status add_group(void *user, const int *edge, int n, int *added, thr_err *err)
{
  thr_relax *r = user;
  bool *inside = thr_calloc((size_t)r->c->f->n_edges, sizeof *inside);
  int *group = thr_calloc((size_t)n, sizeof *group);
  thr_status st = inside && group ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n && !st; i++)
    inside[group[i] = edge[i]] = true;
  if (!st) {
    thr_sort_ints(group, (size_t)n);
    put_crossing(r, group, n, inside);
    const thr_row row = {.kind = THR_RELAX_GROUP, .lower = 2, .member = group, .n_members = n};
    st = thr_pool_offer(&r->pool, row, r->x, tolerance, added, err);
  }
  free(inside);
  free(group);
  return st;
}

/* ---- partitions ---- */

/* Puts the coefficients of the row; returns how much less it asks for than the connections to make. even is scratch. */
static double put_partition(thr_relax *r, const int *block, bool *even)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  double less = 0;
  for (int v = 0; v < f->n_nodes; v++) {
    const int *half = f->half + f->first[v];
    int odd, b = thr_turning_blocks_at(c, block, v, &odd, even);
    if (b < 2) continue;
    double share = (b - 1.0) / b;
    less += share / 2 * odd;
    for (int i = 0; i < thr_degree(f, v); i++) {
      for (int j = i + 1; j < thr_degree(f, v); j++)
        if (block[half[i] >> 1] != block[half[j] >> 1]) thr_pool_put(&r->pool, thr_turning_column(c, half[i], half[j]), share);
      if (even[i]) thr_pool_put(&r->pool, c->first_extra + (half[i] >> 1), share / 2);
    }
  }
  return less;
}

thr_status thr_relax_add_partition(thr_relax *r, int *block, int connections, int *added, thr_err *err)
{
  bool *even = thr_calloc((size_t)r->c->f->n_edges, sizeof *even);
  if (!even) return thr_nomem(err);
  double lower = connections - put_partition(r, block, even);
  const thr_row row = {.kind = THR_RELAX_PARTITION, .lower = lower, .member = block, .n_members = r->c->f->n_edges};
  thr_status st = thr_pool_offer(&r->pool, row, r->x, 1e-4, added, err);
  free(even);
  return st;
}

/* ---- junctions ---- */

thr_status thr_relax_add_junction(thr_relax *r, int v, int *block, int n, int *added, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const int *half = c->f->half + c->f->first[v], d = thr_degree(c->f, v);
  for (int a = 0; a < d; a++)
    for (int b = a + 1; b < d; b++)
      if (block[a] != block[b]) thr_pool_put(&r->pool, thr_turning_column(c, half[a], half[b]), 1);
  const thr_row row = {.kind = THR_RELAX_JUNCTION, .index = v, .lower = n - 1, .member = block, .n_members = d};
  return thr_pool_offer(&r->pool, row, r->x, tolerance, added, err);
}

/* ---- solving ---- */

/* What the equations leave of the costs. */
static void reduce_by_equations(thr_relax *r)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges;
  for (int j = 0; j < c->first_back; j++) {
    int a = c->half[j][0], b = c->half[j][1];
    double sum = r->dual[a] + (b >= 0 ? r->dual[b] : r->dual[darts + c->end_group[thr_tail(c->f, a)]]);
    r->reduced[j] += j >= c->first_extra && j < c->first_end ? sum : -sum;
  }
}

static void reduce_costs(thr_relax *r)
{
  const thr_turning_columns *c = r->c;
  int first = first_column(r);
  for (int j = first; j < c->first_back; j++)
    r->reduced[j] = ldexp((double)c->weight[j], -THR_TURNING_BITS);
  if (!r->projected) reduce_by_equations(r);
  for (int i = 0; i < r->pool.count; i++)
    thr_row_charge(&r->pool.row[i], r->dual[r->n_equations + i], r->reduced + first);
}

/* Adds the rows that are not in the programme yet. */
static thr_status load(thr_relax *r, thr_err *err)
{
  int help = r->projected ? r->c->first_back - r->c->first_extra : r->n_all - 1;
  return thr_pool_load(&r->pool, thr_lp_rows(r->lp) - r->n_equations, help, r->lp, err);
}

thr_status thr_relax_solve(thr_relax *r, const thr_limits *limits, thr_err *err)
{
  thr_lp_outcome outcome = THR_LP_STOPPED;
  bool first = !r->projected && thr_lp_rows(r->lp) == r->n_equations; /* its basis is not feasible for the first odd sets */
  thr_status st = first ? THR_OK : load(r, err);
  if (!st) st = thr_lp_solve(r->lp, limits, &outcome, err);
  if (!st && first) st = load(r, err);
  if (!st && first && outcome == THR_LP_OPTIMAL) st = thr_lp_solve(r->lp, limits, &outcome, err);
  if (st) return st;
  if (outcome == THR_LP_INFEASIBLE || outcome == THR_LP_UNBOUNDED)
    return thr_fail(err, THR_ESOLVER, "GLPK found no optimum of a turning relaxation, which always has one");
  double *dual = thr_realloc(r->dual, (size_t)thr_lp_rows(r->lp), sizeof *dual);
  if (!dual) return thr_nomem(err);
  r->dual = dual;
  r->solved = outcome == THR_LP_OPTIMAL;
  thr_lp_primal(r->lp, r->x + first_column(r));
  thr_lp_dual(r->lp, r->dual);
  r->objective = thr_lp_objective(r->lp);
  r->artificial = 0;
  for (int j = r->c->n_columns; j < r->n_all; j++)
    r->artificial += r->x[j];
  reduce_costs(r);
  return THR_OK;
}

thr_status thr_relax_separate(thr_relax *r, const thr_limits *limits, int *added, thr_err *err)
{
  const thr_turning_task *t = r->c->task;
  bool connected = t->end_allowed || t->cords == 1;
  thr_groups_call groups = {r->c, r->x, add_group, r};
  *added = 0;
  if (r->projected) return thr_project_separate(r, limits, added, err);
  thr_status st = t->tube ? thr_junctions_separate(r, added, err) : THR_OK;
  if (!st && connected && !t->tube) st = thr_groups_support(&groups, tolerance, added, err); /* tied nodes connect all */
  if (!st) st = thr_relax_odd(r, false, added, err);
  connected &= !t->tube;
  if (!st && !*added && !t->end_allowed && !t->tube) st = thr_partitions_separate(r, added, err);
  for (double threshold = 0.2; connected && !st && !*added && threshold < 1; threshold += 0.25)
    st = thr_groups_support(&groups, threshold, added, err);
  if (!st && !*added && connected && !thr_limits_stop(limits)) st = thr_groups_flow(&groups, added, err);
  if (!st && !*added && !thr_limits_stop(limits)) st = thr_relax_odd(r, true, added, err);
  return st;
}
