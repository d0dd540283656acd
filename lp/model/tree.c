/* Nodes in a heap; their bounds on columns are found on the way to the root. */
#include "lp/model/tree.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_status thr_tree_init(thr_tree *t, int n_columns, const int *least, const int *most, thr_err *err)
{
  size_t n = (size_t)n_columns;
  *t = (thr_tree){.n_columns = n_columns, .enough = INFINITY, .most_nodes = INT_MAX};
  thr_status st = thr_grow(&t->node, 0, &t->capacity, sizeof *t->node, err);
  if (!st) st = thr_grow(&t->open, 0, &t->open_capacity, sizeof *t->open, err);
  if (!st && !(t->least = thr_calloc(4 * n, sizeof *t->least))) st = thr_nomem(err);
  if (st) {
    thr_tree_destroy(t);
    return st;
  }
  t->most = t->least + n;
  t->low = t->most + n;
  t->high = t->low + n;
  for (size_t j = 0; j < n; j++) {
    t->least[j] = t->low[j] = least ? least[j] : 0;
    t->most[j] = t->high[j] = most[j];
  }
  t->node[t->n_nodes++] = (thr_tree_node){.parent = -1, .bound = -INFINITY, .proof = -1};
  t->open[t->n_open++] = 0;
  return THR_OK;
}

void thr_tree_destroy(thr_tree *t)
{
  free(t->least);
  free(t->node);
  free(t->open);
  *t = (thr_tree){0};
}

bool thr_tree_closed(const thr_tree *t, int node)
{
  return t->node[node].bound >= t->enough;
}

/* ---- the heap ---- */

static double rounded(const thr_tree *t, double bound)
{
  return t->grain > 0 ? floor(bound / t->grain) : bound;
}

static bool before(const thr_tree *t, int a, int b)
{
  const thr_tree_node *node = &t->node[a], *q = &t->node[b];
  double x = rounded(t, node->bound), y = rounded(t, q->bound);
  if (x != y) return x < y;
  if (node->depth != q->depth) return node->depth > q->depth;
  return (a - 1) / 2 == (b - 1) / 2 ? node->first : a > b; /* nodes 2 k + 1 and 2 k + 2 are siblings */
}

static thr_status push(thr_tree *t, int node, thr_err *err)
{
  thr_status st = thr_grow(&t->open, t->n_open, &t->open_capacity, sizeof *t->open, err);
  if (st) return st;
  int i = t->n_open++;
  for (; i > 0 && before(t, node, t->open[(i - 1) / 2]); i = (i - 1) / 2)
    t->open[i] = t->open[(i - 1) / 2];
  t->open[i] = node;
  return THR_OK;
}

static int pop(thr_tree *t)
{
  int top = t->open[0], last = t->open[--t->n_open], i = 0;
  for (int child; (child = 2 * i + 1) < t->n_open; i = child) {
    if (child + 1 < t->n_open && before(t, t->open[child + 1], t->open[child])) child++;
    if (!before(t, t->open[child], last)) break;
    t->open[i] = t->open[child];
  }
  t->open[i] = last;
  return top;
}

double thr_tree_bound(const thr_tree *t)
{
  double at = t->node[t->at].bound;
  return t->n_open > 0 ? fmin(at, t->node[t->open[0]].bound) : at;
}

int thr_tree_undecided(const double *x, int first, int end, double tolerance, const int *decided)
{
  int best = -1;
  double most = tolerance;
  for (int j = first; j < end; j++) {
    double far = fabs(x[j] - nearbyint(x[j]));
    if (far <= most + 1e-9 || (decided && decided[j] > 0)) continue;
    most = far;
    best = j;
  }
  return best;
}

/* ---- bounds on columns ---- */

/* What the decisions of a node leave of a column. */
static void bounds_at(const thr_tree *t, int node, int column, int *low, int *high)
{
  *low = t->least[column];
  *high = t->most[column];
  for (int k = node; k > 0; k = t->node[k].parent) {
    const thr_tree_node *n = &t->node[k];
    if (n->column != column) continue;
    if (n->high && n->value + 1 > *low) *low = n->value + 1;
    if (!n->high && n->value < *high) *high = n->value;
  }
}

/* Puts the bounds of node `to` in force on the columns that are decided on the way from `from` to the root. */
static thr_status set_along(thr_tree *t, const thr_tree_calls *calls, int from, int to, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = from, low, high; k > 0 && !st; k = t->node[k].parent) {
    int j = t->node[k].column;
    bounds_at(t, to, j, &low, &high);
    if (low == t->low[j] && high == t->high[j]) continue;
    t->low[j] = low;
    t->high[j] = high;
    st = calls->set(calls->user, j, low, high, err);
  }
  return st;
}

thr_status thr_tree_enter(thr_tree *t, const thr_tree_calls *calls, int node, thr_err *err)
{
  thr_status st = set_along(t, calls, t->at, node, err);
  if (!st) st = set_along(t, calls, node, node, err);
  t->at = node;
  return st;
}

/* ---- the search ---- */

static thr_status split(thr_tree *t, int node, thr_tree_branch branch, thr_err *err)
{
  if (t->n_nodes + 2 > t->most_nodes) {
    t->stopped = true;
    return THR_OK;
  }
  for (int side = 0; side < 2; side++) {
    thr_status st = thr_grow(&t->node, t->n_nodes, &t->capacity, sizeof *t->node, err);
    if (st) return st;
    thr_tree_node *parent = &t->node[node], *child = &t->node[t->n_nodes];
    *child = (thr_tree_node){.parent = node,
                             .depth = parent->depth + 1,
                             .column = branch.column,
                             .value = branch.value,
                             .high = side == 1,
                             .first = branch.high == (side == 1),
                             .bound = parent->bound,
                             .proof = parent->proof};
    parent->child[side] = t->n_nodes++;
    if ((st = push(t, parent->child[side], err))) return st;
  }
  return THR_OK;
}

thr_status thr_tree_run(thr_tree *t, const thr_tree_calls *calls, thr_err *err)
{
  thr_status st = THR_OK;
  while (!st && !t->stopped && t->n_open > 0 && !thr_tree_closed(t, t->open[0])) {
    int node = t->open[0];
    thr_tree_branch branch = {.column = -1};
    t->stopped = node > 0 && calls->limits && thr_limits_stop(calls->limits);
    if (t->stopped) break;
    st = thr_tree_enter(t, calls, pop(t), err);
    if (!st) st = calls->solve(calls->user, node, &branch, err);
    if (!st && !t->stopped && branch.column >= 0 && !thr_tree_closed(t, node)) st = split(t, node, branch, err);
  }
  return st;
}
