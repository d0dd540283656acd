/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks proofs of a lower bound on turning: a branch-and-bound tree with multipliers at its
 * leaves.
 *
 * Every inner node splits the range of a column in two; a node with an orbit does so for all images
 * of the column under some symmetries (orbital branching, graph/plan/turning_proof.h). A leaf names
 * multipliers, which prove a bound within its box (turning_leaf.c). The bound of the tree is the
 * least of its leaves.
 *
 * Leaves with the same multipliers are visited together: a walk through the tree narrows and widens
 * the box column by column, and keeps the value of the multipliers up to date. So a leaf costs only
 * what changes on the way to it.
 *
 * Example: two leaves below "edge 3 has at most 0 extra passes" (bound 7) and "at least 1" (bound
 * 6) prove 6. */
#include "graph/check/check_parts.h"
#include "graph/plan/turning_proof.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

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

/* Returns the column that a node branches on, or -1 if its half-edges name none. */
static int branch_column(const thr_turning_columns *columns, const thr_turning_node *node)
{
  int a = node->a, b = node->b, darts = 2 * columns->f->n_edges;
  if (a < 0 || a >= darts || b >= darts) return -1;

  /* One half-edge: a cord end. Both of an edge: an extra pass. The same twice: a U-turn. */
  if (b < 0) return b == -1 ? columns->end_column[a] : -1;
  if (b == (a ^ 1)) return columns->first_extra + (a >> 1);
  for (int j = columns->first_back; a == b && j < columns->n_columns; j++)
    if (columns->half[j][0] == a) return j;

  /* Two half-edges that leave one node: a turn. */
  if (a == b) return -1;
  return thr_tail(columns->f, a) == thr_tail(columns->f, b) ? thr_turning_column(columns, a, b)
                                                            : -1;
}

/* Fills parent[i] and column[i] of every node, the column that it branches on or -1. Checks that
 * every node but the root is the child of exactly one node before it, so that walking upwards ends.
 */
static thr_status link_tree(const thr_turning_columns *columns, const thr_turning_proof *proof,
                            int *parent, int *column, thr_err *err)
{
  for (int i = 0; i < proof->n_nodes; i++)
    parent[i] = column[i] = -1;

  for (int i = 0; i < proof->n_nodes; i++) {
    const thr_turning_node *node = &proof->node[i];
    int child[2] = {node->low, node->high};

    /* A parent comes before its children, so that it has been seen. */
    if (i > 0 && parent[i] < 0)
      return thr_fail(err, THR_EVIOLATED, "turning proof: node %d hangs nowhere in the tree", i);

    /* A leaf names multipliers. */
    if (node->low == 0 && node->high == 0) {
      if (node->dual < 0 || node->dual >= proof->n_duals)
        return thr_fail(err, THR_EVIOLATED, "turning proof: node %d: no multipliers %d", i,
                        node->dual);
      continue;
    }

    /* An inner node names a column and two later nodes. */
    column[i] = branch_column(columns, node);
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
} old_range;

/* A node that waits to be visited, and how many entries of the log stand above it. */
typedef struct {
  int node, changes;
} waiting;

/* The box of the node that is visited, and what the multipliers of a leaf come to in it. Both
 * follow the tree from node to node: a branching narrows some columns, and going back up the log
 * undoes it. So a visit takes as long as what it changes, however deep the node lies. */
typedef struct {
  const thr_turning_columns *columns;
  const thr_turning_proof *proof;
  thr_scratch own;      /* the arrays */
  int *parent, *column; /* [n_nodes] */
  int *marked; /* [n_nodes] the last multipliers that a leaf at or below the node has; -1: none yet
                */
  waiting *stack; /* [n_nodes] */
  int *low, *high,
      *changed; /* [n_columns] the box; how many entries of the log are about a column */
  int *narrowed, n_narrowed; /* columns that the log is about */
  old_range *log;
  int n_changes, n_empty;       /* entries of the log; columns without a value */
  const thr_turning_leaf *leaf; /* multipliers, or NULL */
  /* [n_components + 1] values of the cords of a component, and of all */
  thr_wide *here; /* of leaf in the box */
  int64_t *least; /* of all leaves so far */
} tree_walk;

/* Allocates the arrays, sets the box to that of the root, and links the tree. */
static thr_status boxes_init(tree_walk *walk, thr_err *err)
{
  const size_t nodes = (size_t)walk->proof->n_nodes,
               columns = walk->proof->n_nodes > 1 ? (size_t)walk->columns->n_columns : 0;
  size_t changes = nodes;
  for (size_t i = 0; i < nodes; i++)
    changes += (size_t)walk->proof->node[i].n_orbit;

  /* The log holds one entry for each column that a node narrows. */
  walk->parent = thr_scratch_array(&walk->own, nodes, sizeof *walk->parent);
  walk->column = thr_scratch_array(&walk->own, nodes, sizeof *walk->column);
  walk->marked = thr_scratch_array(&walk->own, nodes, sizeof *walk->marked);
  walk->stack = thr_scratch_array(&walk->own, nodes, sizeof *walk->stack);
  walk->low = thr_scratch_array(&walk->own, columns, sizeof *walk->low);
  walk->high = thr_scratch_array(&walk->own, columns, sizeof *walk->high);
  walk->changed = thr_scratch_array(&walk->own, columns, sizeof *walk->changed);
  walk->narrowed = thr_scratch_array(&walk->own, columns, sizeof *walk->narrowed);
  walk->log = thr_scratch_array(&walk->own, changes, sizeof *walk->log);
  walk->here =
      thr_scratch_array(&walk->own, (size_t)walk->columns->n_components + 1, sizeof *walk->here);
  walk->least =
      thr_scratch_array(&walk->own, (size_t)walk->columns->n_components + 1, sizeof *walk->least);

  thr_status st = thr_scratch_check(&walk->own, err);
  if (st) return st;

  /* The box of the root: every column may take any of its values. */
  for (size_t j = 0; j < columns; j++)
    walk->high[j] = thr_turning_most(walk->columns, (int)j);
  for (size_t i = 0; i < nodes; i++)
    walk->marked[i] = -1;
  for (int i = 0; i <= walk->columns->n_components; i++)
    walk->least[i] = INT64_MAX;
  return link_tree(walk->columns, walk->proof, walk->parent, walk->column, err);
}

/* Returns the images of the half-edges under the k-th symmetry of a node's orbit. */
static const int *symmetry_of(const tree_walk *walk, const thr_turning_node *node, int k)
{
  return walk->proof->symmetry + (size_t)node->orbit[k] * (size_t)walk->columns->f->n_edges;
}

/* Sets the range of a column, and updates the values of the multipliers. */
static void set_limits(tree_walk *walk, int j, int low, int high)
{
  /* A box with an empty range holds no plan. */
  walk->n_empty += (low > high) - (walk->low[j] > walk->high[j]);

  /* A column changes the values of its component and of the whole. */
  if (walk->leaf && walk->low[j] <= walk->high[j] && low <= high) {
    const thr_wide adds = thr_turning_leaf_adds(walk->leaf, j, low, high) -
                          thr_turning_leaf_adds(walk->leaf, j, walk->low[j], walk->high[j]);
    walk->here[thr_turning_leaf_component(walk->leaf, walk->columns->half[j][0])] += adds;
    walk->here[walk->columns->n_components] += adds;
  }

  walk->low[j] = low;
  walk->high[j] = high;
}

/* Narrows the range of a column to low .. high, and records the old one in the log. */
static void narrow_column(tree_walk *walk, int j, int low, int high)
{
  if (low < walk->low[j]) low = walk->low[j];
  if (high > walk->high[j]) high = walk->high[j];

  /* Only what changes is logged. */
  if (low == walk->low[j] && high == walk->high[j]) return;
  walk->log[walk->n_changes++] =
      (old_range){.column = j, .low = walk->low[j], .high = walk->high[j]};
  if (walk->changed[j]++ == 0) walk->narrowed[walk->n_narrowed++] = j;
  set_limits(walk, j, low, high);
}

/* Narrows the box of the parent of node i to the box of node i. */
static void narrow(tree_walk *walk, int i)
{
  const int above = walk->parent[i];
  if (above < 0) return;

  const thr_turning_node *node = &walk->proof->node[above];
  const int j = walk->column[above];

  /* The upper child bounds the column alone, the lower one all of its images. */
  if (node->low != i) {
    narrow_column(walk, j, node->value < INT_MAX ? node->value + 1 : INT_MAX, INT_MAX);
    return;
  }

  narrow_column(walk, j, 0, node->value);
  for (int k = 0; k < node->n_orbit; k++)
    narrow_column(walk, thr_turning_image(walk->columns, symmetry_of(walk, node, k), j), 0,
                  node->value);
}

/* Undoes the log down to its first `changes` entries. */
static void widen(tree_walk *walk, int changes)
{
  while (walk->n_changes > changes) {
    const old_range *before = &walk->log[--walk->n_changes];
    if (--walk->changed[before->column] == 0) walk->n_narrowed--;
    set_limits(walk, before->column, before->low, before->high);
  }
}

/* Returns whether a symmetry maps the box to itself. */
static bool keeps_box(const tree_walk *walk, const int *image)
{
  for (int i = 0; i < walk->n_narrowed; i++) {
    const int j = walk->narrowed[i], k = thr_turning_image(walk->columns, image, j);
    if (walk->low[k] != walk->low[j] || walk->high[k] != walk->high[j]) return false;
  }
  return true;
}

/* Checks that only inner nodes have orbits, and that their symmetries exist. */
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

/* Computes the values of the multipliers with all columns in their widest range. In one component
 * alone, sets over several components only lower prices, and the limit on the extra length of all
 * holds for its own. */
static void find_widest(tree_walk *walk, const thr_turning_leaf *leaf)
{
  const int n = walk->columns->n_components;

  /* The constants of the multipliers. */
  walk->here[n] = leaf->constant[n] - leaf->limit;

  for (int i = 0; i < n; i++) {
    walk->here[i] = leaf->constant[i] - leaf->limit;
    walk->here[n] += leaf->constant[i];
  }

  /* Every column at the cheaper end of its range. */
  for (int j = 0; j < walk->columns->n_columns; j++) {
    thr_wide adds = thr_turning_leaf_adds(leaf, j, 0, thr_turning_most(walk->columns, j));

    walk->here[thr_turning_leaf_component(leaf, walk->columns->half[j][0])] += adds;
    walk->here[n] += adds;
  }
}

/* Visits a node whose box is not empty. With multipliers: lowers the least values at their leaves.
 * Without: checks that its orbit keeps the box. */
static thr_status visit(tree_walk *walk, int i, thr_err *err)
{
  const thr_turning_node *node = &walk->proof->node[i];
  for (int k = 0; k < node->n_orbit && !walk->leaf; k++)
    if (!keeps_box(walk, symmetry_of(walk, node, k)))
      return thr_fail(err, THR_EVIOLATED,
                      "turning proof: node %d: a symmetry does not keep what was decided before",
                      i);

  /* At a leaf the last entry is the value of all components together. */
  for (int j = 0; j <= walk->columns->n_components && walk->leaf && !node->low; j++) {
    const int64_t here = thr_turning_in_64_bits(walk->here[j]);
    if (here < walk->least[j]) walk->least[j] = here;
  }
  return THR_OK;
}

/* Visits all nodes with this mark (-1: all nodes) whose box is not empty, depth first from the
 * root. */
static thr_status visit_all(tree_walk *walk, int mark, thr_err *err)
{
  int n = 0;
  thr_status st = THR_OK;
  if (mark < 0 || walk->marked[0] == mark) walk->stack[n++] = (waiting){0};

  while (n > 0 && !st) {
    const waiting next = walk->stack[--n];
    const thr_turning_node *node = &walk->proof->node[next.node];

    /* Go back to the box of the parent, then on to that of the node. */
    widen(walk, next.changes);
    narrow(walk, next.node);
    if (walk->n_empty > 0) continue;

    st = visit(walk, next.node, err);

    /* The lower child is taken from the stack first. */
    for (int k = 0; k < 2 && node->low; k++) {
      const int child = k ? node->low : node->high;
      if (mark < 0 || walk->marked[child] == mark)
        walk->stack[n++] = (waiting){.node = child, .changes = walk->n_changes};
    }
  }

  widen(walk, 0);
  return st;
}

/* Checks that every stated symmetry maps plans to plans. */
static thr_status check_symmetries(const thr_turning_columns *columns,
                                   const thr_turning_proof *proof, thr_err *err)
{
  bool yes;
  for (int i = 0; i < proof->n_symmetries; i++) {
    const int *image = proof->symmetry + (size_t)i * (size_t)columns->f->n_edges;
    thr_status st = thr_turning_symmetric(columns, image, &yes, err);
    if (st) return st;

    if (!yes)
      return thr_fail(err, THR_EVIOLATED, "turning proof: symmetry %d does not map plans to plans",
                      i);
  }
  return THR_OK;
}

/* Checks that the proof has a tree, and multipliers of the right number. */
static thr_status check_dual_shape(const thr_turning_columns *columns,
                                   const thr_turning_proof *proof, thr_err *err)
{
  if (proof->n_ends != columns->n_ends)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: multipliers for %d sums of ends, but there are %d",
                    proof->n_ends, columns->n_ends);

  if (proof->n_nodes < 1) return thr_fail(err, THR_EVIOLATED, "turning proof: no tree");

  for (int i = 0; i < proof->n_duals; i++)
    if (!proof->dual[i].potential || !proof->dual[i].ends)
      return thr_fail(err, THR_EVIOLATED, "turning proof: no multipliers");
  return THR_OK;
}

/* Sorts the leaves by their multipliers: number[first[d] .. first[d + 1] - 1] have those of number
 * d. */
static void sort_leaves(const thr_turning_proof *proof, int *first, int *number)
{
  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) first[proof->node[i].dual + 2]++;

  for (int d = 0; d < proof->n_duals; d++)
    first[d + 2] += first[d + 1];

  for (int i = 0; i < proof->n_nodes; i++)
    if (!proof->node[i].low) number[first[proof->node[i].dual + 1]++] = i;
}

/* Lowers the least values to those of n leaves that have the multipliers number d. O(columns +
 * members of the sets times turns at them + nodes above the leaves + leaves * components). */
static thr_status least_of_leaves(tree_walk *walk, int d, const int *node, int n, thr_err *err)
{
  thr_turning_leaf leaf;
  thr_status st = thr_turning_leaf_init(&leaf, walk->columns, &walk->proof->dual[d], err);
  if (!st) find_widest(walk, &leaf);

  /* Mark the paths from these leaves to the root; all other subtrees are skipped. */
  for (int i = 0; i < n; i++)
    for (int above = node[i]; above >= 0 && walk->marked[above] != d; above = walk->parent[above])
      walk->marked[above] = d;

  walk->leaf = &leaf;

  if (!st) st = visit_all(walk, d, err);
  walk->leaf = NULL;

  thr_scratch_free(&leaf.own);
  return st;
}

/* Lowers the bound of each component to those of its images. Leaves are about a plan or one of its
 * images under the symmetries, so a component's own bound may be that of an image. */
static void share_bounds(const thr_turning_columns *columns, const thr_turning_proof *proof,
                         double *bound_of)
{
  const int *component = columns->component;
  const int m = columns->f->n_edges;

  for (bool changed = columns->n_components > 1; changed;) {
    changed = false;
    for (int i = 0; i < proof->n_symmetries * m; i++) {
      /* Symmetry i / m maps edge i % m to another component. */
      double *a = &bound_of[component[columns->f->edge[i % m][0]]],
             *b = &bound_of[component[columns->f->edge[proof->symmetry[i] >> 1][0]]];

      changed |= *a != *b;
      *a = *b = fmin(*a, *b);
    }
  }
}

/* Computes *bound, the least over all leaves, and bound_of (NULL: not wanted) of each component. */
static thr_status check_tree(const thr_turning_columns *columns, const thr_turning_proof *proof,
                             double *bound, double *bound_of, thr_err *err)
{
  tree_walk walk = {.columns = columns, .proof = proof};
  const int n = columns->n_components;
  int *first = thr_scratch_array(&walk.own, (size_t)proof->n_duals + 2, sizeof *first);
  int *leaves = thr_scratch_array(&walk.own, (size_t)proof->n_nodes, sizeof *leaves);

  thr_status st = thr_scratch_check(&walk.own, err);

  /* Orbits are checked along the tree, without multipliers. */
  if (!st) st = boxes_init(&walk, err);
  if (!st) st = check_orbits(proof, err);
  if (!st && proof->n_symmetries > 0) st = visit_all(&walk, -1, err);

  /* Leaf by leaf, those with the same multipliers together. */
  if (!st) sort_leaves(proof, first, leaves);
  for (int d = 0; d < proof->n_duals && !st; d++)
    if (first[d + 1] > first[d])
      st = least_of_leaves(&walk, d, leaves + first[d], first[d + 1] - first[d], err);

  /* In units of the price; no bound is below 0. */
  if (!st && walk.least[n] > 0) *bound = ldexp((double)walk.least[n], -THR_TURNING_BITS);
  for (int i = 0; i < n && !st && bound_of; i++)
    bound_of[i] = fmax(0, ldexp((double)walk.least[i], -THR_TURNING_BITS));
  if (!st && bound_of) share_bounds(columns, proof, bound_of);

  thr_scratch_free(&walk.own);
  return st;
}

thr_status thr_turning_proof_check_columns(const thr_turning_columns *columns,
                                           const thr_turning_proof *proof, double *bound,
                                           double *bound_of, thr_err *err)
{
  thr_turning_columns lower;
  *bound = 0;

  thr_status st = check_dual_shape(columns, proof, err);
  if (st || proof->n_symmetries == 0)
    return st ? st : check_tree(columns, proof, bound, bound_of, err);

  /* With symmetries, prices are lowered to the least of their images (turning_symmetry.c). */
  st = check_symmetries(columns, proof, err);
  if (!st) st = thr_turning_lower(columns, proof->symmetry, proof->n_symmetries, &lower, err);
  if (st) return st;

  st = check_tree(&lower, proof, bound, bound_of, err);
  thr_turning_columns_destroy(&lower);
  return st;
}

thr_status thr_turning_proof_check(const thr_frame *frame, const thr_turning_task *task,
                                   const thr_turning_proof *proof, double *bound, thr_err *err)
{
  thr_turning_columns columns;
  *bound = 0;

  if (proof->walks.unit)
    return thr_fail(err, THR_EVIOLATED,
                    "turning proof: walks, which are about the cord that turns most");

  thr_status st = thr_turning_columns_init(&columns, frame, task, err);
  if (st) return st;
  st = thr_turning_proof_check_columns(&columns, proof, bound, NULL, err);
  thr_turning_columns_destroy(&columns);
  return st;
}
