/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proofs of turning: a tree of boxes, each leaf with its multipliers. */
#include "graph/check/check_parts.h"
#include "graph/plan/turning_proof.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- memory ---- */

static void destroy_sets(thr_turning_set *set, int n)
{
  for (int i = 0; set && i < n; i++)
    free(set[i].member);
  free(set);
}

thr_status thr_turning_dual_init(thr_turning_dual *dual, const thr_turning_columns *columns,
                                 thr_err *err)
{
  *dual = (thr_turning_dual){
      .potential = thr_calloc(2 * (size_t)columns->f->n_edges, sizeof *dual->potential),
      .ends = thr_calloc((size_t)columns->n_ends, sizeof *dual->ends)};
  if (dual->potential && dual->ends) return THR_OK;
  thr_turning_dual_destroy(dual);
  return thr_nomem(err);
}

void thr_turning_dual_drop_odd(thr_turning_dual *dual, int from)
{
  while (dual->n_odd > from)
    free(dual->odd[--dual->n_odd].member);
}

static void destroy_partitions(thr_turning_partition *partition, int n)
{
  for (int i = 0; partition && i < n; i++)
    free(partition[i].block);
  free(partition);
}

void thr_turning_dual_destroy(thr_turning_dual *dual)
{
  free(dual->potential);
  free(dual->ends);
  destroy_sets(dual->odd, dual->n_odd);
  destroy_sets(dual->group, dual->n_groups);
  destroy_partitions(dual->partition, dual->n_partitions);
  destroy_partitions(dual->rank, dual->n_ranks);
  for (int i = 0; dual->junction && i < dual->n_junctions; i++)
    free(dual->junction[i].block);
  free(dual->junction);
  *dual = (thr_turning_dual){0};
}

void thr_turning_proof_destroy(thr_turning_proof *proof)
{
  for (int i = 0; proof->dual && i < proof->n_duals; i++)
    thr_turning_dual_destroy(&proof->dual[i]);
  free(proof->dual);
  for (int i = 0; proof->node && i < proof->n_nodes; i++)
    free(proof->node[i].orbit);
  free(proof->node);
  free(proof->symmetry);
  thr_walk_proof_destroy(&proof->walks);
  *proof = (thr_turning_proof){0};
}

/* ---- the tree ---- */

/* Column of a branch, or -1. */
static int branch_column(const thr_turning_columns *turning_columns, const thr_turning_node *node)
{
  int a = node->a, b = node->b, darts = 2 * turning_columns->f->n_edges;
  if (a < 0 || a >= darts || b >= darts) return -1;
  if (b < 0) return b == -1 ? turning_columns->end_column[a] : -1;
  if (b == (a ^ 1)) return turning_columns->first_extra + (a >> 1);
  for (int j = turning_columns->first_back; a == b && j < turning_columns->n_columns; j++)
    if (turning_columns->half[j][0] == a) return j;
  if (a == b) return -1;
  return thr_tail(turning_columns->f, a) == thr_tail(turning_columns->f, b)
             ? thr_turning_column(turning_columns, a, b)
             : -1;
}

/* parent[i] and column[i] of every node, the column that it branches on or -1; every node but the
 * root is the child of exactly one before it, so walking up ends. */
static thr_status link_tree(const thr_turning_columns *turning_columns,
                            const thr_turning_proof *proof, int *parent, int *column, thr_err *err)
{
  for (int i = 0; i < proof->n_nodes; i++)
    parent[i] = column[i] = -1;
  for (int i = 0; i < proof->n_nodes; i++) {
    const thr_turning_node *node = &proof->node[i];
    int child[2] = {node->low, node->high};
    if (i > 0 && parent[i] < 0)
      return thr_fail(err, THR_EVIOLATED, "turning proof: node %d hangs nowhere in the tree", i);
    if (node->low == 0 && node->high == 0) {
      if (node->dual < 0 || node->dual >= proof->n_duals)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no multipliers %d", i,
                        node->dual);
      continue;
    }
    column[i] = branch_column(turning_columns, node);
    if (column[i] < 0)
      return thr_fail(err, THR_EVIOLATED, "turning proof: node %d branches on nothing", i);
    for (int k = 0; k < 2; k++) {
      if (child[k] <= i || child[k] >= proof->n_nodes || parent[child[k]] >= 0)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: bad child %d", i, child[k]);
      parent[child[k]] = i;
    }
  }
  return THR_OK;
}

/* A column's limits before a branching narrowed them. */
typedef struct {
  int column, low, high;
} was;

/* A node that waits to be visited, and how many entries of the log stand above it. */
typedef struct {
  int node, changes;
} waiting;

/* The box of the node that is visited, and what the multipliers of a leaf come to in it. Both
 * follow the tree from node to node: a branching narrows some columns, and going back up the log
 * undoes it. So a visit takes as long as what it changes, however deep the node lies. */
typedef struct {
  const thr_turning_columns *c;
  const thr_turning_proof *p;
  thr_scratch own;      /* the arrays */
  int *parent, *column; /* [n_nodes] */
  int *marked; /* [n_nodes] the last multipliers that a leaf at or below the node has; -1: none yet
                */
  waiting *stack; /* [n_nodes] */
  int *low, *high,
      *changed; /* [n_columns] the box; how many entries of the log are about a column */
  int *narrowed, n_narrowed; /* columns that the log is about */
  was *log;
  int n_changes, n_empty;    /* entries of the log; columns without a value */
  const thr_turning_leaf *k; /* multipliers, or NULL */
  /* [n_components + 1] values of the cords of a component, and of all */
  thr_wide *here; /* of k in the box */
  int64_t *least; /* of all leaves so far */
} boxes;

static thr_status boxes_init(boxes *x, thr_err *err)
{
  const size_t nodes = (size_t)x->p->n_nodes,
               columns = x->p->n_nodes > 1 ? (size_t)x->c->n_columns : 0;
  size_t changes = nodes;
  for (size_t i = 0; i < nodes; i++)
    changes += (size_t)x->p->node[i].n_orbit;
  x->parent = thr_scratch_array(&x->own, nodes, sizeof *x->parent);
  x->column = thr_scratch_array(&x->own, nodes, sizeof *x->column);
  x->marked = thr_scratch_array(&x->own, nodes, sizeof *x->marked);
  x->stack = thr_scratch_array(&x->own, nodes, sizeof *x->stack);
  x->low = thr_scratch_array(&x->own, columns, sizeof *x->low);
  x->high = thr_scratch_array(&x->own, columns, sizeof *x->high);
  x->changed = thr_scratch_array(&x->own, columns, sizeof *x->changed);
  x->narrowed = thr_scratch_array(&x->own, columns, sizeof *x->narrowed);
  x->log = thr_scratch_array(&x->own, changes, sizeof *x->log);
  x->here = thr_scratch_array(&x->own, (size_t)x->c->n_components + 1, sizeof *x->here);
  x->least = thr_scratch_array(&x->own, (size_t)x->c->n_components + 1, sizeof *x->least);
  thr_status st = thr_scratch_check(&x->own, err);
  if (st) return st;
  for (size_t j = 0; j < columns; j++)
    x->high[j] = thr_turning_most(x->c, (int)j);
  for (size_t i = 0; i < nodes; i++)
    x->marked[i] = -1;
  for (int i = 0; i <= x->c->n_components; i++)
    x->least[i] = INT64_MAX;
  return link_tree(x->c, x->p, x->parent, x->column, err);
}

/* Images of the half-edges under the k-th symmetry of a node's orbit. */
static const int *symmetry_of(const boxes *x, const thr_turning_node *node, int k)
{
  return x->p->symmetry + (size_t)node->orbit[k] * (size_t)x->c->f->n_edges;
}

/* Sets the limits of a column, and what the multipliers come to with them. */
static void set_limits(boxes *x, int j, int low, int high)
{
  x->n_empty += (low > high) - (x->low[j] > x->high[j]);
  if (x->k && x->low[j] <= x->high[j] && low <= high) {
    const thr_wide adds = thr_turning_leaf_adds(x->k, j, low, high) -
                          thr_turning_leaf_adds(x->k, j, x->low[j], x->high[j]);
    x->here[thr_turning_leaf_component(x->k, x->c->half[j][0])] += adds;
    x->here[x->c->n_components] += adds;
  }
  x->low[j] = low;
  x->high[j] = high;
}

/* Narrows the limits of a column to low .. high. */
static void narrow_column(boxes *x, int j, int low, int high)
{
  if (low < x->low[j]) low = x->low[j];
  if (high > x->high[j]) high = x->high[j];
  if (low == x->low[j] && high == x->high[j]) return;
  x->log[x->n_changes++] = (was){.column = j, .low = x->low[j], .high = x->high[j]};
  if (x->changed[j]++ == 0) x->narrowed[x->n_narrowed++] = j;
  set_limits(x, j, low, high);
}

/* Narrows the box of the parent of node i to that of node i. */
static void narrow(boxes *x, int i)
{
  const int above = x->parent[i];
  if (above < 0) return;
  const thr_turning_node *node = &x->p->node[above];
  const int j = x->column[above];
  if (node->low != i) {
    narrow_column(x, j, node->value < INT_MAX ? node->value + 1 : INT_MAX, INT_MAX);
    return;
  }
  narrow_column(x, j, 0, node->value);
  for (int k = 0; k < node->n_orbit; k++)
    narrow_column(x, thr_turning_image(x->c, symmetry_of(x, node, k), j), 0, node->value);
}

/* Goes back to the box that had so many changes. */
static void widen(boxes *x, int changes)
{
  while (x->n_changes > changes) {
    const was *before = &x->log[--x->n_changes];
    if (--x->changed[before->column] == 0) x->n_narrowed--;
    set_limits(x, before->column, before->low, before->high);
  }
}

/* Does the symmetry keep the box? */
static bool keeps_box(const boxes *x, const int *image)
{
  for (int i = 0; i < x->n_narrowed; i++) {
    const int j = x->narrowed[i], k = thr_turning_image(x->c, image, j);
    if (x->low[k] != x->low[j] || x->high[k] != x->high[j]) return false;
  }
  return true;
}

/* Orbits of inner nodes only, of symmetries that there are. */
static thr_status check_orbits(const thr_turning_proof *proof, thr_err *err)
{
  for (int i = 0; i < proof->n_nodes; i++) {
    const thr_turning_node *node = &proof->node[i];
    if (node->n_orbit == 0) continue;
    if (!node->low)
      return thr_fail(err, THR_EVIOLATED,
                      "turning proof: node %d: an orbit, but nothing is decided", i);
    for (int k = 0; k < node->n_orbit; k++)
      if (node->orbit[k] < 0 || node->orbit[k] >= proof->n_symmetries)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no symmetry %d", i,
                        node->orbit[k]);
  }
  return THR_OK;
}

/* Values of a leaf's multipliers with columns in their widest limits. In one component alone, sets
 * of several only take off prices, and the limit on all extra length holds for that of the
 * component. */
static void find_widest(boxes *x, const thr_turning_leaf *k)
{
  const int n = x->c->n_components;
  x->here[n] = k->constant[n] - k->limit;
  for (int i = 0; i < n; i++) {
    x->here[i] = k->constant[i] - k->limit;
    x->here[n] += k->constant[i];
  }
  for (int j = 0; j < x->c->n_columns; j++) {
    thr_wide adds = thr_turning_leaf_adds(k, j, 0, thr_turning_most(x->c, j));
    x->here[thr_turning_leaf_component(k, x->c->half[j][0])] += adds;
    x->here[n] += adds;
  }
}

/* Visits a node whose box is there: of multipliers, takes the least values at their leaves;
 * without, checks that its orbit keeps the box. */
static thr_status visit(boxes *x, int i, thr_err *err)
{
  const thr_turning_node *node = &x->p->node[i];
  for (int k = 0; k < node->n_orbit && !x->k; k++)
    if (!keeps_box(x, symmetry_of(x, node, k)))
      return thr_fail(err, THR_EVIOLATED,
                      "turning proof: node %d: a symmetry does not keep what was decided before",
                      i);
  for (int j = 0; j <= x->c->n_components && x->k && !node->low; j++) {
    const int64_t here = thr_turning_in_64_bits(x->here[j]);
    if (here < x->least[j]) x->least[j] = here;
  }
  return THR_OK;
}

/* Visits all nodes that are marked so, -1: all, and whose box is not empty, from the root on. */
static thr_status visit_all(boxes *x, int mark, thr_err *err)
{
  int n = 0;
  thr_status st = THR_OK;
  if (mark < 0 || x->marked[0] == mark) x->stack[n++] = (waiting){0};
  while (n > 0 && !st) {
    const waiting next = x->stack[--n];
    const thr_turning_node *node = &x->p->node[next.node];
    widen(x, next.changes);
    narrow(x, next.node);
    if (x->n_empty > 0) continue;
    st = visit(x, next.node, err);
    for (int k = 0; k < 2 && node->low; k++) {
      const int child = k ? node->low : node->high;
      if (mark < 0 || x->marked[child] == mark)
        x->stack[n++] = (waiting){.node = child, .changes = x->n_changes};
    }
  }
  widen(x, 0);
  return st;
}

static thr_status check_symmetries(const thr_turning_columns *turning_columns,
                                   const thr_turning_proof *proof, thr_err *err)
{
  bool yes;
  for (int i = 0; i < proof->n_symmetries; i++) {
    const int *image = proof->symmetry + (size_t)i * (size_t)turning_columns->f->n_edges;
    thr_status st = thr_turning_symmetric(turning_columns, image, &yes, err);
    if (st) return st;
    if (!yes)
      return thr_fail(err, THR_EVIOLATED, "turning proof: symmetry %d does not map plans to plans",
                      i);
  }
  return THR_OK;
}

static thr_status check_dual_shape(const thr_turning_columns *turning_columns,
                                   const thr_turning_proof *proof, thr_err *err)
{
  if (proof->n_ends != turning_columns->n_ends)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: multipliers for %d sums of ends, but there are %d",
                    proof->n_ends, turning_columns->n_ends);
  if (proof->n_nodes < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: no tree");
  for (int i = 0; i < proof->n_duals; i++)
    if (!proof->dual[i].potential || !proof->dual[i].ends)
      return thr_fail(err, THR_EVIOLATED, "turning proof: no multipliers");
  return THR_OK;
}

/* The leaves by their multipliers: number[first[d] .. first[d + 1] - 1] have those of number d. */
static void sort_leaves(const thr_turning_proof *proof, int *first, int *number)
{
  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) first[proof->node[i].dual + 2]++;
  for (int d = 0; d < proof->n_duals; d++)
    first[d + 2] += first[d + 1];
  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) number[first[proof->node[i].dual + 1]++] = i;
}

/* Least values over the boxes of n leaves that have the multipliers number d. O(columns + what they
 * list, each member as often as there are turns at it, + nodes above the leaves + leaves *
 * components). */
static thr_status least_of_leaves(boxes *x, int d, const int *node, int n, thr_err *err)
{
  thr_turning_leaf k;
  thr_status st = thr_turning_leaf_init(&k, x->c, &x->p->dual[d], err);
  if (!st) find_widest(x, &k);
  for (int i = 0; i < n; i++)
    for (int above = node[i]; above >= 0 && x->marked[above] != d; above = x->parent[above])
      x->marked[above] = d;
  x->k = &k;
  if (!st) st = visit_all(x, d, err);
  x->k = NULL;
  thr_scratch_free(&k.own);
  return st;
}

/* Leaves are about a plan or one of its images: a component's bound is also that of those which
 * symmetries make of it. */
static void share_bounds(const thr_turning_columns *columns, const thr_turning_proof *proof,
                         double *bound_of)
{
  const int *component = columns->component;
  const int m = columns->f->n_edges;
  for (bool changed = columns->n_components > 1; changed;) {
    changed = false;
    for (int i = 0; i < proof->n_symmetries * m; i++) {
      double *a = &bound_of[component[columns->f->edge[i % m][0]]],
             *b = &bound_of[component[columns->f->edge[proof->symmetry[i] >> 1][0]]];
      changed |= *a != *b;
      *a = *b = fmin(*a, *b);
    }
  }
}

/* The least over all leaves. */
static thr_status check_tree(const thr_turning_columns *turning_columns,
                             const thr_turning_proof *proof, double *bound, double *bound_of,
                             thr_err *err)
{
  boxes x = {.c = turning_columns, .p = proof};
  const int n = turning_columns->n_components;
  int *first = thr_scratch_array(&x.own, (size_t)proof->n_duals + 2, sizeof *first);
  int *leaves = thr_scratch_array(&x.own, (size_t)proof->n_nodes, sizeof *leaves);
  thr_status st = thr_scratch_check(&x.own, err);
  if (!st) st = boxes_init(&x, err);
  if (!st) st = check_orbits(proof, err);
  if (!st && proof->n_symmetries > 0) st = visit_all(&x, -1, err);
  if (!st) sort_leaves(proof, first, leaves);
  for (int d = 0; d < proof->n_duals && !st; d++)
    if (first[d + 1] > first[d])
      st = least_of_leaves(&x, d, leaves + first[d], first[d + 1] - first[d], err);
  if (!st && x.least[n] > 0) *bound = ldexp((double)x.least[n], -THR_TURNING_BITS);
  for (int i = 0; i < n && !st && bound_of; i++)
    bound_of[i] = fmax(0, ldexp((double)x.least[i], -THR_TURNING_BITS));
  if (!st && bound_of) share_bounds(turning_columns, proof, bound_of);
  thr_scratch_free(&x.own);
  return st;
}

thr_status thr_turning_proof_check_columns(const thr_turning_columns *turning_columns,
                                           const thr_turning_proof *proof, double *bound,
                                           double *bound_of, thr_err *err)
{
  thr_turning_columns lower;
  *bound = 0;
  thr_status st = check_dual_shape(turning_columns, proof, err);
  if (st || proof->n_symmetries == 0)
    return st ? st : check_tree(turning_columns, proof, bound, bound_of, err);
  st = check_symmetries(turning_columns, proof, err);
  if (!st)
    st = thr_turning_lower(turning_columns, proof->symmetry, proof->n_symmetries, &lower, err);
  if (st) return st;
  st = check_tree(&lower, proof, bound, bound_of, err);
  thr_turning_columns_destroy(&lower);
  return st;
}

thr_status thr_turning_proof_check(const thr_frame *frame, const thr_turning_task *task,
                                   const thr_turning_proof *proof, double *bound, thr_err *err)
{
  thr_turning_columns turning_columns;
  *bound = 0;
  if (proof->walks.unit)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: walks, which are about the cord that turns most");
  thr_status st = thr_turning_columns_init(&turning_columns, frame, task, err);
  if (st) return st;
  st = thr_turning_proof_check_columns(&turning_columns, proof, bound, NULL, err);
  thr_turning_columns_destroy(&turning_columns);
  return st;
}
