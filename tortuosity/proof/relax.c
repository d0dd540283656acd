/* Rows, separation and multipliers of the turning relaxation. */
#include "tortuosity/proof/relax.h"
#include "graph/disjoint.h"
#include "graph/sort.h"
#include "tortuosity/proof/column_groups.h"
#include "tortuosity/proof/partition.h"
#include "tortuosity/proof/project.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6;

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
  int *list = thr_calloc(2 * (size_t)f->n_edges, sizeof *list);
  if (!list) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++) {
    memcpy(list, f->half + f->first[v], (size_t)thr_degree(f, v) * sizeof *list);
    st = thr_oddcut_add(&r->graph, &r->pool, list, thr_degree(f, v), err);
  }
  free(list);
  return st;
}

static int lp_column(const thr_relax *r, int column)
{
  return r->projected ? column - r->c->first_extra : column;
}

thr_status thr_relax_init(thr_relax *r, const thr_turning_columns *c, bool projected, double penalty, const thr_limits *limits,
                          thr_err *err)
{
  size_t n = (size_t)c->n_columns;
  *r = (thr_relax){.c = c, .projected = projected};
  if (!projected) r->n_equations = 2 * c->f->n_edges + (c->task->end_allowed ? c->n_ends : 0);
  r->n_all = c->n_columns + 2 * r->n_equations + 1;
  r->x = thr_calloc((size_t)r->n_all, sizeof *r->x);
  r->low = thr_calloc(n, sizeof *r->low);
  r->high = thr_calloc(n, sizeof *r->high);
  r->reduced = thr_calloc(n, sizeof *r->reduced);
  thr_status st = r->x && r->low && r->high && r->reduced ? THR_OK : thr_nomem(err);
  if (!st) st = projected ? thr_project_create(r, penalty, err) : thr_relax_create(r, penalty, err);
  if (!st && c->extra_limit >= 0) st = add_length_row(r, err);
  for (int j = 0; j < c->n_columns && !st; j++) {
    r->high[j] = thr_turning_most(c, j);
    if (j >= c->first_extra) st = thr_lp_set_bounds(r->lp, lp_column(r, j), 0, r->high[j], err); /* turns: by their equations */
  }
  if (!st && !projected) st = thr_relax_crash(r, limits, err);
  if (!st) st = projected ? thr_project_graph(r, err) : init_graph(r, err);
  if (!st && !projected) st = add_node_sets(r, err);
  if (st) thr_relax_destroy(r);
  return st;
}

static void destroy_group(thr_relax_group *g)
{
  free(g->edge);
  free(g->column);
}

static void destroy_partition(thr_relax_partition *p)
{
  free(p->block);
  free(p->column);
  free(p->value);
}

static void destroy_junction(thr_relax_junction *j)
{
  free(j->block);
  free(j->column);
}

void thr_relax_destroy(thr_relax *r)
{
  thr_lp_destroy(r->lp);
  for (int i = 0; i < r->n_groups; i++)
    destroy_group(&r->group[i]);
  for (int i = 0; i < r->n_partitions; i++)
    destroy_partition(&r->partition[i]);
  for (int i = 0; i < r->n_junctions; i++)
    destroy_junction(&r->junction[i]);
  free(r->junction);
  free(r->partition);
  free(r->group);
  free(r->cut);
  free(r->x);
  free(r->dual);
  free(r->low);
  free(r->high);
  free(r->reduced);
  thr_oddcut_pool_destroy(&r->pool);
  thr_oddcut_graph_destroy(&r->graph);
  free((void *)r->problem.edge);
  free((void *)r->problem.odd);
  *r = (thr_relax){0};
}

thr_status thr_relax_set(thr_relax *r, int column, int low, int high, thr_err *err)
{
  if (r->low[column] == low && r->high[column] == high) return THR_OK;
  bool unbounded = column < r->c->first_extra && high == thr_turning_most(r->c, column);
  r->low[column] = low;
  r->high[column] = high;
  return thr_lp_set_bounds(r->lp, lp_column(r, column), low, unbounded ? (double)INFINITY : high, err);
}

/* ---- rows ---- */

static thr_status add_row(thr_relax *r, int n, const int *column, const double *value, double lower, thr_relax_cut cut,
                          thr_err *err)
{
  thr_status st = thr_grow(&r->cut, r->n_cuts, &r->cuts_capacity, sizeof *r->cut, err);
  int *all = thr_calloc((size_t)n + 1, sizeof *all);
  double *with = thr_calloc((size_t)n + 1, sizeof *with);
  if (!st && (!all || !with)) st = thr_nomem(err);
  for (int i = 0; i < n && !st; i++) {
    all[i] = column[i];
    with[i] = value ? value[i] : 1;
  }
  if (!st) {
    all[n] = r->n_all - 1;
    with[n] = 1;
    st = thr_lp_add_row(r->lp, n + 1, all, with, lower, err);
  }
  if (!st) r->cut[r->n_cuts++] = cut;
  free(all);
  free(with);
  return st;
}

/* Rows for the odd sets from first on. */
static thr_status add_odd_rows(thr_relax *r, int first, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = first; i < r->pool.count && !st; i++)
    st = add_row(r, r->pool.cut[i].n_edges, r->pool.cut[i].edge, NULL, 1, (thr_relax_cut){THR_RELAX_ODD, i}, err);
  return st;
}

static double sum_over(const double *x, int n, const int *column)
{
  double sum = 0;
  for (int k = 0; k < n; k++)
    sum += x[column[k]];
  return sum;
}

/* Forgets the sets from first on that x does not violate. */
static thr_status keep_violated(thr_relax *r, int first, thr_err *err)
{
  bool *drop = thr_calloc((size_t)r->pool.count, sizeof *drop);
  if (!drop) return thr_nomem(err);
  for (int i = first; i < r->pool.count; i++)
    drop[i] = sum_over(r->x, r->pool.cut[i].n_edges, r->pool.cut[i].edge) > 1 - tolerance;
  thr_oddcut_pool_drop(&r->pool, drop);
  free(drop);
  return THR_OK;
}

static thr_status separate_odd(thr_relax *r, bool exact, int *added, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.2, 0.35, 0.51, 0.7};
  int before = r->pool.count;
  thr_status st = THR_OK;
  if (!r->any_odd) return THR_OK; /* all sets are even */
  if (exact) st = thr_oddcut_exact(&r->graph, r->x, &r->pool, err);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && !exact && !st && r->pool.count == before; i++) {
    st = thr_oddcut_moats(&r->graph, r->x, threshold[i], r->reduced, &r->pool, err);
    if (!st) st = keep_violated(r, before, err);
  }
  if (!st) st = add_odd_rows(r, before, err);
  *added += r->pool.count - before;
  return st;
}

/* ---- groups ---- */

static uint64_t name_of(int n, const int *edge)
{
  uint64_t name = 0;
  for (int i = 0; i < n; i++) {
    uint64_t z = ((uint64_t)edge[i] + 1) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    name ^= z ^ z >> 27;
  }
  return name;
}

/* The columns that cross the marked edges. */
static thr_status crossing(const thr_turning_columns *c, thr_relax_group *g, const bool *inside, thr_err *err)
{
  const thr_frame *f = c->f;
  int capacity = 0;
  for (int k = 0; k < g->n_edges; k++)
    for (int side = 0; side < 2; side++) {
      int h = 2 * g->edge[k] + side, v = thr_tail(f, h);
      for (int i = f->first[v]; i <= f->first[v + 1]; i++) {
        bool last = i == f->first[v + 1]; /* after the turns: the end */
        int j = last ? c->end_column[h] : inside[f->half[i] >> 1] ? -1 : thr_turning_column(c, h, f->half[i]);
        if (j < 0) continue;
        thr_status st = thr_grow(&g->column, g->n_columns, &capacity, sizeof *g->column, err);
        if (st) return st;
        g->column[g->n_columns++] = j;
      }
    }
  return THR_OK;
}

/* Adds the group's row if x violates it and it is new. */
static thr_status add_group(void *user, const int *edge, int n, bool *used, thr_err *err)
{
  thr_relax *r = user;
  const thr_frame *f = r->c->f;
  thr_relax_group g = {.name = name_of(n, edge), .n_edges = n};
  *used = false;
  for (int i = 0; i < r->n_groups; i++)
    if (r->group[i].name == g.name) return THR_OK;
  bool *inside = thr_calloc((size_t)f->n_edges, sizeof *inside);
  g.edge = thr_calloc((size_t)n, sizeof *g.edge);
  thr_status st = inside && g.edge ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n && !st; i++)
    inside[g.edge[i] = edge[i]] = true;
  if (!st) {
    thr_sort_ints(g.edge, (size_t)n);
    st = crossing(r->c, &g, inside, err);
  }
  free(inside);
  if (!st && sum_over(r->x, g.n_columns, g.column) < 2 - tolerance) {
    st = thr_grow(&r->group, r->n_groups, &r->groups_capacity, sizeof *r->group, err);
    if (!st) st = add_row(r, g.n_columns, g.column, NULL, 2, (thr_relax_cut){THR_RELAX_GROUP, r->n_groups}, err);
    *used = !st;
  }
  if (*used)
    r->group[r->n_groups++] = g;
  else
    destroy_group(&g);
  return st;
}

/* ---- partitions ---- */

/* Columns and values of the row, from coefficients by column. */
static thr_status fill_partition(thr_relax_partition *p, const double *by_column, int n, thr_err *err)
{
  for (int j = 0; j < n; j++)
    p->n_columns += by_column[j] != 0;
  p->column = thr_calloc((size_t)p->n_columns, sizeof *p->column);
  p->value = thr_calloc((size_t)p->n_columns, sizeof *p->value);
  if (!p->column || !p->value) return thr_nomem(err);
  for (int j = 0, k = 0; j < n; j++)
    if (by_column[j] != 0) {
      p->column[k] = j;
      p->value[k++] = by_column[j];
    }
  return THR_OK;
}

/* Coefficients of the row; lower is its right side, given as the connections to make. even is scratch. */
static void weigh_partition(const thr_turning_columns *c, const int *block, double *by_column, bool *even, double *lower)
{
  const thr_frame *f = c->f;
  for (int v = 0; v < f->n_nodes; v++) {
    const int *half = f->half + f->first[v];
    int odd, b = thr_turning_blocks_at(c, block, v, &odd, even);
    if (b < 2) continue;
    double share = (b - 1.0) / b;
    *lower -= share / 2 * odd;
    for (int i = 0; i < thr_degree(f, v); i++) {
      for (int j = i + 1; j < thr_degree(f, v); j++)
        if (block[half[i] >> 1] != block[half[j] >> 1]) by_column[thr_turning_column(c, half[i], half[j])] = share;
      if (even[i]) by_column[c->first_extra + (half[i] >> 1)] += share / 2;
    }
  }
}

thr_status thr_relax_add_partition(thr_relax *r, const int *block, int connections, bool *used, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  size_t m = (size_t)c->f->n_edges;
  thr_relax_partition p = {.name = 1, .lower = connections};
  double sum = 0;
  *used = false;
  for (size_t e = 0; e < m; e++)
    p.name = (p.name ^ (uint64_t)block[e]) * UINT64_C(0x9e3779b97f4a7c15) + 1;
  for (int i = 0; i < r->n_partitions; i++)
    if (r->partition[i].name == p.name) return THR_OK;
  double *by_column = thr_calloc((size_t)c->n_columns, sizeof *by_column);
  bool *even = thr_calloc(m, sizeof *even);
  thr_status st = by_column && even ? THR_OK : thr_nomem(err);
  if (!st) {
    weigh_partition(c, block, by_column, even, &p.lower);
    for (int j = 0; j < c->n_columns; j++)
      sum += by_column[j] * r->x[j];
  }
  if (!st && sum < p.lower - 1e-4) {
    st = fill_partition(&p, by_column, c->n_columns, err);
    if (!st && !(p.block = thr_calloc(m, sizeof *p.block))) st = thr_nomem(err);
    if (!st) memcpy(p.block, block, m * sizeof *block);
    if (!st) st = thr_grow(&r->partition, r->n_partitions, &r->partitions_capacity, sizeof *r->partition, err);
    if (!st) st = add_row(r, p.n_columns, p.column, p.value, p.lower, (thr_relax_cut){THR_RELAX_PARTITION, r->n_partitions}, err);
    *used = !st;
  }
  if (*used)
    r->partition[r->n_partitions++] = p;
  else
    destroy_partition(&p);
  free(by_column);
  free(even);
  return st;
}

/* ---- junctions ---- */

thr_status thr_relax_add_junction(thr_relax *r, int v, const int *block, int n, bool *used, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const int *half = c->f->half + c->f->first[v], d = thr_degree(c->f, v);
  size_t turns = (size_t)d * (size_t)(d - 1) / 2;
  thr_relax_junction j = {.node = v, .n_blocks = n};
  j.block = thr_calloc((size_t)d, sizeof *j.block);
  j.column = thr_calloc(turns, sizeof *j.column);
  thr_status st = j.block && j.column ? THR_OK : thr_nomem(err);
  *used = false;
  for (int a = 0; a < d && !st; a++) {
    j.block[a] = block[a];
    for (int b = a + 1; b < d; b++)
      if (block[a] != block[b]) j.column[j.n_columns++] = thr_turning_column(c, half[a], half[b]);
  }
  if (!st && sum_over(r->x, j.n_columns, j.column) < n - 1 - tolerance) {
    st = thr_grow(&r->junction, r->n_junctions, &r->junctions_capacity, sizeof *r->junction, err);
    if (!st) st = add_row(r, j.n_columns, j.column, NULL, n - 1, (thr_relax_cut){THR_RELAX_JUNCTION, r->n_junctions}, err);
    *used = !st;
  }
  if (*used)
    r->junction[r->n_junctions++] = j;
  else
    destroy_junction(&j);
  return st;
}

/* ---- solving ---- */

static void reduce_costs(thr_relax *r)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges;
  for (int j = 0; j < c->first_back; j++) {
    int a = c->half[j][0], b = c->half[j][1];
    double sum = r->dual[a] + (b >= 0 ? r->dual[b] : r->dual[darts + c->end_group[thr_tail(c->f, a)]]);
    r->reduced[j] = ldexp((double)c->weight[j], -THR_TURNING_BITS) + (j >= c->first_extra && j < c->first_end ? sum : -sum);
  }
  for (int i = 0; i < r->n_cuts; i++) {
    double y = r->dual[r->n_equations + i];
    int n, k = r->cut[i].index;
    const int *column;
    const double *value = NULL;
    switch (r->cut[i].kind) {
    case THR_RELAX_ODD: n = r->pool.cut[k].n_edges, column = r->pool.cut[k].edge; break;
    case THR_RELAX_JUNCTION: n = r->junction[k].n_columns, column = r->junction[k].column; break;
    case THR_RELAX_GROUP: n = r->group[k].n_columns, column = r->group[k].column; break;
    default: n = r->partition[k].n_columns, column = r->partition[k].column, value = r->partition[k].value; break;
    }
    for (int q = 0; y != 0 && q < n; q++)
      r->reduced[column[q]] -= value ? y * value[q] : y;
  }
}

thr_status thr_relax_solve(thr_relax *r, const thr_limits *limits, thr_err *err)
{
  thr_lp_outcome outcome;
  thr_status st = thr_lp_solve(r->lp, limits, &outcome, err);
  if (!st && !r->projected && r->n_cuts == 0 &&
      outcome == THR_LP_OPTIMAL) { /* the first basis is not feasible for the first odd sets */
    st = add_odd_rows(r, 0, err);
    if (!st) st = thr_lp_solve(r->lp, limits, &outcome, err);
  }
  if (st) return st;
  if (outcome == THR_LP_INFEASIBLE || outcome == THR_LP_UNBOUNDED)
    return thr_fail(err, THR_ESOLVER, "GLPK found no optimum of a turning relaxation, which always has one");
  double *dual = thr_realloc(r->dual, (size_t)thr_lp_rows(r->lp), sizeof *dual);
  if (!dual) return thr_nomem(err);
  r->dual = dual;
  r->solved = outcome == THR_LP_OPTIMAL;
  thr_lp_primal(r->lp, r->projected ? r->x + r->c->first_extra : r->x);
  thr_lp_dual(r->lp, r->dual);
  r->objective = thr_lp_objective(r->lp);
  r->artificial = 0;
  for (int j = r->c->n_columns; j < r->n_all; j++)
    r->artificial += r->x[j];
  if (r->projected) return thr_project_reduce(r, err);
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
  if (!st) st = separate_odd(r, false, added, err);
  connected &= !t->tube;
  if (!st && !*added && !t->end_allowed && !t->tube) st = thr_partitions_separate(r, added, err);
  for (double threshold = 0.2; connected && !st && !*added && threshold < 1; threshold += 0.25)
    st = thr_groups_support(&groups, threshold, added, err);
  if (!st && !*added && connected && !thr_limits_stop(limits)) st = thr_groups_flow(&groups, added, err);
  if (!st && !*added && !thr_limits_stop(limits)) st = separate_odd(r, true, added, err);
  return st;
}
