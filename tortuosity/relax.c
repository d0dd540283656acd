/* Rows, separation and multipliers of the turning relaxation. */
#include "tortuosity/relax.h"
#include "graph/disjoint.h"
#include "tortuosity/groups.h"
#include "tortuosity/partition.h"

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
  int darts = 2 * c->f->n_edges, n = darts + c->n_components, m = c->first_back;
  int(*edge)[2] = thr_calloc((size_t)m, sizeof *edge);
  bool *odd = thr_calloc((size_t)n, sizeof *odd);
  r->problem = (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .odd = odd};
  if (!edge || !odd) return thr_nomem(err);
  for (int j = 0; j < m; j++) {
    edge[j][0] = c->half[j][0];
    edge[j][1] = c->half[j][1] >= 0 ? c->half[j][1] : darts + c->component[thr_tail(c->f, c->half[j][0])];
  }
  for (int h = 0; h < darts; h++)
    odd[h] = c->task->cover % 2;
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

thr_status thr_relax_init(thr_relax *r, const thr_turning_columns *c, double penalty, thr_err *err)
{
  size_t n = (size_t)c->n_columns;
  *r = (thr_relax){.c = c, .n_equations = 2 * c->f->n_edges + (c->task->end_allowed ? c->n_components : 0)};
  r->n_all = c->n_columns + 2 * r->n_equations + 1;
  r->x = thr_calloc((size_t)r->n_all, sizeof *r->x);
  r->low = thr_calloc(n, sizeof *r->low);
  r->high = thr_calloc(n, sizeof *r->high);
  r->reduced = thr_calloc(n, sizeof *r->reduced);
  thr_status st = r->x && r->low && r->high && r->reduced ? THR_OK : thr_nomem(err);
  if (!st) st = thr_relax_create(r, penalty, err);
  if (!st && c->extra_limit >= 0) st = add_length_row(r, err);
  for (int j = 0; j < c->n_columns && !st; j++) {
    r->high[j] = thr_turning_most(c, j);
    if (j >= c->first_extra) st = thr_lp_set_bounds(r->lp, j, 0, r->high[j], err); /* turns are bounded by their equations */
  }
  if (!st) st = thr_relax_crash(r, err);
  if (!st) st = init_graph(r, err);
  if (!st) st = add_node_sets(r, err);
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

void thr_relax_destroy(thr_relax *r)
{
  thr_lp_destroy(r->lp);
  for (int i = 0; i < r->n_groups; i++)
    destroy_group(&r->group[i]);
  for (int i = 0; i < r->n_partitions; i++)
    destroy_partition(&r->partition[i]);
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
  return thr_lp_set_bounds(r->lp, column, low, unbounded ? (double)INFINITY : high, err);
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
  if (r->c->task->cover % 2 == 0) return THR_OK; /* all sets are even */
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

static int ascending(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
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
    qsort(g.edge, (size_t)n, sizeof *g.edge, ascending);
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

/* ---- solving ---- */

static void reduce_costs(thr_relax *r)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges;
  for (int j = 0; j < c->first_back; j++) {
    int a = c->half[j][0], b = c->half[j][1];
    double sum = r->dual[a] + (b >= 0 ? r->dual[b] : r->dual[darts + c->component[thr_tail(c->f, a)]]);
    r->reduced[j] = ldexp((double)c->weight[j], -THR_TURNING_BITS) + (j >= c->first_extra && j < c->first_end ? sum : -sum);
  }
  for (int i = 0; i < r->n_cuts; i++) {
    double y = r->dual[r->n_equations + i];
    int n, k = r->cut[i].index;
    const int *column;
    const double *value = NULL;
    switch (r->cut[i].kind) {
    case THR_RELAX_ODD: n = r->pool.cut[k].n_edges, column = r->pool.cut[k].edge; break;
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
  if (!st && r->n_cuts == 0 && outcome == THR_LP_OPTIMAL) { /* the first basis is not feasible for the first odd sets */
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
  thr_lp_primal(r->lp, r->x);
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
  thr_status st = connected ? thr_groups_support(&groups, tolerance, added, err) : THR_OK;
  if (!st) st = separate_odd(r, false, added, err);
  if (!st && !*added && !t->end_allowed) st = thr_partitions_separate(r, added, err);
  for (double threshold = 0.2; connected && !st && !*added && threshold < 1; threshold += 0.25)
    st = thr_groups_support(&groups, threshold, added, err);
  if (!st && !*added && connected && !thr_limits_stop(limits)) st = thr_groups_flow(&groups, added, err);
  if (!st && !*added && !thr_limits_stop(limits)) st = separate_odd(r, true, added, err);
  return st;
}

/* ---- multipliers ---- */

static int64_t whole(double value)
{
  return (int64_t)nearbyint(ldexp(fmax(-1e4, fmin(1e4, value)), THR_TURNING_BITS));
}

static thr_status copy_set(thr_turning_set *to, int n, const int *member, int64_t value, thr_err *err)
{
  *to = (thr_turning_set){n, thr_calloc((size_t)n, sizeof *to->member), value};
  if (!to->member) return thr_nomem(err);
  memcpy(to->member, member, (size_t)n * sizeof *member);
  return THR_OK;
}

static thr_status copy_blocks(const thr_relax *r, thr_turning_partition *to, const int *block, int64_t value, thr_err *err)
{
  size_t m = (size_t)r->c->f->n_edges;
  *to = (thr_turning_partition){thr_calloc(m, sizeof *to->block), value};
  if (!to->block) return thr_nomem(err);
  memcpy(to->block, block, m * sizeof *block);
  return THR_OK;
}

static thr_status copy_cuts(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < r->n_cuts && !st; i++) {
    int64_t value = whole(r->dual[r->n_equations + i]);
    int k = r->cut[i].index;
    if (value <= 0) continue;
    if (r->cut[i].kind == THR_RELAX_PARTITION)
      st = copy_blocks(r, &d->partition[d->n_partitions++], r->partition[k].block, value, err);
    else if (r->cut[i].kind == THR_RELAX_ODD)
      st = copy_set(&d->odd[d->n_odd++], r->pool.cut[k].n_nodes, r->pool.cut[k].node, value, err);
    else
      st = copy_set(&d->group[d->n_groups++], r->group[k].n_edges, r->group[k].edge, value, err);
  }
  return st;
}

thr_status thr_relax_dual(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges, used[3] = {0};
  *d = (thr_turning_dual){0};
  for (int i = 0; i < r->n_cuts; i++)
    used[r->cut[i].kind] += whole(r->dual[r->n_equations + i]) > 0;
  d->potential = thr_calloc((size_t)darts, sizeof *d->potential);
  d->ends = thr_calloc((size_t)c->n_components, sizeof *d->ends);
  d->odd = thr_calloc((size_t)used[0], sizeof *d->odd);
  d->group = thr_calloc((size_t)used[1], sizeof *d->group);
  d->partition = thr_calloc((size_t)used[2], sizeof *d->partition);
  thr_status st = d->potential && d->ends && d->odd && d->group && d->partition ? THR_OK : thr_nomem(err);
  for (int h = 0; h < darts && !st; h++)
    d->potential[h] = whole(r->dual[h]);
  for (int i = 0; c->task->end_allowed && i < c->n_components && !st; i++)
    d->ends[i] = whole(r->dual[darts + i]);
  if (!st && c->extra_limit >= 0) d->length = whole(fmax(0, r->dual[r->n_equations - 1]));
  if (!st) st = copy_cuts(r, d, err);
  if (st) thr_turning_dual_destroy(d);
  return st;
}
