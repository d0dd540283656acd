/* The linear programme on the cuts of a finished T-join, solved by GLPK from the join. */
#include "lp/engine.h"
#include "lp/lp.h"

#include <stdlib.h>

/* Cuts as rows: the edges that leave the set of cut i are edge[first[i] .. first[i + 1] - 1]. */
typedef struct {
  const thr_tjoin_problem *p;
  const thr_tjoin *t;
  int *tree;              /* [n_cuts] the root of its tree */
  int *first_cut, *holds; /* cuts that name node v: holds[first_cut[v] .. first_cut[v + 1] - 1] */
  int *first, *edge;
} rows;

static void rows_destroy(rows *r)
{
  free(r->tree);
  free(r->first_cut);
  free(r->holds);
  free(r->first);
  free(r->edge);
}

static thr_status list_places(rows *r, thr_err *err)
{
  const thr_tjoin *t = r->t;
  size_t n = (size_t)r->p->n_nodes, named = 0;
  r->tree = thr_calloc((size_t)t->n_cuts, sizeof *r->tree);
  r->first_cut = thr_calloc(n + 2, sizeof *r->first_cut);
  r->first = thr_calloc((size_t)t->n_cuts + 2, sizeof *r->first);
  if (!r->tree || !r->first_cut || !r->first) return thr_nomem(err);
  for (int i = t->n_cuts - 1; i >= 0; i--) {
    r->tree[i] = t->cut[i].parent < 0 ? i : r->tree[t->cut[i].parent];
    named += (size_t)t->cut[i].n_nodes;
    for (int k = 0; k < t->cut[i].n_nodes; k++)
      r->first_cut[t->cut[i].node[k] + 2]++;
  }
  for (size_t v = 1; v <= n; v++)
    r->first_cut[v + 1] += r->first_cut[v];
  r->holds = thr_calloc(named, sizeof *r->holds);
  if (!r->holds) return thr_nomem(err);
  for (int i = 0; i < t->n_cuts; i++)
    for (int k = 0; k < t->cut[i].n_nodes; k++)
      r->holds[r->first_cut[t->cut[i].node[k] + 1]++] = i;
  return THR_OK;
}

/* The cut of that tree that names node v, or -1. */
static int place_of(const rows *r, int v, int tree)
{
  for (int k = r->first_cut[v]; k < r->first_cut[v + 1]; k++)
    if (r->tree[r->holds[k]] == tree) return r->holds[k];
  return -1;
}

/* Counts (edge NULL), or lists, edge e in all cuts of one tree that it leaves: those on the way between the cuts a and b. */
static void leave(rows *r, int e, int a, int b)
{
  while (a != b) {
    int *inner = b < 0 || (a >= 0 && a < b) ? &a : &b; /* parents come later */
    if (r->edge)
      r->edge[r->first[*inner + 1]++] = e;
    else
      r->first[*inner + 2]++;
    *inner = r->t->cut[*inner].parent;
  }
}

static void leave_all(rows *r)
{
  for (int e = 0; e < r->p->n_edges; e++) {
    int u = r->p->edge[e][0], v = r->p->edge[e][1];
    for (int k = r->first_cut[u]; k < r->first_cut[u + 1]; k++)
      leave(r, e, r->holds[k], place_of(r, v, r->tree[r->holds[k]]));
    for (int k = r->first_cut[v]; k < r->first_cut[v + 1]; k++)
      if (place_of(r, u, r->tree[r->holds[k]]) < 0) leave(r, e, -1, r->holds[k]);
  }
}

static thr_status rows_init(rows *r, thr_err *err)
{
  thr_status st = list_places(r, err);
  if (st) return st;
  leave_all(r);
  for (int i = 1; i <= r->t->n_cuts; i++)
    r->first[i + 1] += r->first[i];
  r->edge = thr_calloc((size_t)r->first[r->t->n_cuts + 1], sizeof *r->edge);
  if (!r->edge) return thr_nomem(err);
  leave_all(r);
  return THR_OK;
}

/* Basic: every edge of the join that has a row for itself, one that no other edge of the join is in; and the slacks of all other
 * rows. That is a basis, and the join is its point. */
static thr_status start_from_join(const rows *r, thr_lp *lp, thr_err *err)
{
  bool *row = thr_calloc((size_t)r->t->n_cuts, sizeof *row), *column = thr_calloc((size_t)r->p->n_edges, sizeof *column);
  thr_status st = row && column ? THR_OK : thr_nomem(err);
  for (int i = 0; i < r->t->n_cuts && !st; i++) {
    int joined = 0, e = -1;
    for (int k = r->first[i]; k < r->first[i + 1]; k++)
      if (r->t->in_join[r->edge[k]]) joined++, e = r->edge[k];
    row[i] = joined != 1 || column[e];
    if (!row[i]) column[e] = true;
  }
  if (!st) st = thr_lp_set_basis(lp, row, column, err);
  free(row);
  free(column);
  return st;
}

static thr_status solve_on_cuts(const rows *r, const thr_limits *limits, thr_lp_outcome *outcome, double *value, thr_err *err)
{
  size_t m = (size_t)r->p->n_edges;
  double *cost = thr_calloc(m, sizeof *cost), sum = 0;
  thr_lp *lp = NULL;
  *outcome = THR_LP_STOPPED;
  thr_status st = cost ? THR_OK : thr_nomem(err);
  for (size_t e = 0; e < m && !st; e++)
    sum += (double)r->p->weight[e];
  for (size_t e = 0; e < m && !st; e++)
    cost[e] = (double)r->p->weight[e] * (double)m / sum; /* about 1 */
  if (!st) st = thr_lp_create(&lp, r->p->n_edges, cost, NULL, err);
  for (int i = 0; i < r->t->n_cuts && !st; i++)
    st = thr_lp_add_row(lp, r->first[i + 1] - r->first[i], &r->edge[r->first[i]], NULL, 1, err);
  if (!st) st = start_from_join(r, lp, err);
  if (!st) st = thr_lp_solve(lp, limits, outcome, err);
  for (size_t e = 0; e < m && !st; e++)
    cost[e] = (double)r->p->weight[e]; /* whole numbers: exact */
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_set_costs(lp, cost, err);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_exact(lp, limits, outcome, err);
  if (!st && *outcome == THR_LP_OPTIMAL) *value = thr_lp_objective(lp);
  thr_lp_destroy(lp);
  free(cost);
  return st;
}

thr_status thr_tjoin_confirm(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits, thr_confirmation *out,
                             thr_err *err)
{
  rows r = {.p = p, .t = t};
  thr_lp_outcome outcome = THR_LP_STOPPED;
  double value = 0;
  *out = THR_CONFIRM_SKIPPED;
  if (t->n_cuts == 0 || t->length == 0) { /* nothing is lighter than nothing */
    *out = t->length == 0 ? THR_CONFIRMED : THR_CONFIRM_SKIPPED;
    return THR_OK;
  }
  thr_status st = rows_init(&r, err);
  if (!st) {
    thr_err failure = {0};
    st = solve_on_cuts(&r, limits, &outcome, &value, &failure);
    if (st == THR_ENOMEM) thr_nomem(err);
    if (st == THR_ESOLVER) st = THR_OK; /* a library's failure says nothing about the join */
  }
  rows_destroy(&r);
  if (st || outcome == THR_LP_STOPPED || outcome == THR_LP_UNDECIDED) return st;
  if (outcome != THR_LP_OPTIMAL || value > (double)t->length || value <= (double)t->length - 1)
    return thr_fail(err, THR_ESOLVER,
                    "GLPK's exact method finds %.17g on the cuts of a join that weighs %.17g; please report this", value,
                    (double)t->length);
  *out = THR_CONFIRMED;
  return THR_OK;
}

thr_status thr_tjoin_confirm_soon(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits,
                                  thr_confirmations *count, thr_err *err)
{
  if (!count) return THR_OK;
  thr_limits soon = *limits;
  thr_confirmation said = THR_CONFIRM_SKIPPED;
  double now = thr_clock();
  soon.deadline = now + thr_limits_left(limits, 1);
  soon.progress = NULL;
  thr_status st = p->n_edges <= THR_CONFIRM_EDGES ? thr_tjoin_confirm(p, t, &soon, &said, err) : THR_OK;
  count->confirmed += said == THR_CONFIRMED;
  count->skipped += said != THR_CONFIRMED;
  return st;
}
