/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs branch and bound, the node of least bound first (Land & Doig, Econometrica 28, 1960; Dakin,
 * Computer Journal 8, 1965), over lower bounds that the caller computes.
 *
 * A node of the tree is a set of solutions: those that keep the decisions x[column] <= value or
 * x[column] >= value + 1 on the way from the root to the node. The caller's function computes a
 * lower bound on these solutions, by a linear programme, a matching or an ascent, and chooses the
 * column to branch on. A node whose bound reaches tree.enough, the value of the incumbent or a
 * little less, is closed, and nothing below it is solved. No solution is below the lesser of
 * tree.enough and the least open bound, and when all nodes are closed none is below tree.enough.
 *
 * Symmetries: where all images of a decision under the symmetries of the solutions have the same
 * optimum, the first child decides for all images at once (orbital branching: Ostrowski, Linderoth,
 * Rossi & Smriglio, Math. Programming 126, 2011).
 *
 * Among nodes of equal bound the deepest is solved first, then the youngest, of siblings the one
 * that was preferred. Several nodes may be solved at the same time, each in a thr_tree_place, for
 * instance by threads; how many depends on the tree alone, and so does the result.
 *
 *   thr_tree_init(&tree, n, least, most, &err);
 *   thr_tree_run(&tree, &calls, &err);    calls.solve sets tree.node[node].bound, and tree.enough
 *                                         when there is a better solution
 *   if (!tree.stopped) ..                 no solution has a value below tree.enough */
#include "lp/model/tree.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_status thr_tree_init(thr_tree *t, int n_columns, const int *least, const int *most,
                         thr_err *err)
{
  size_t n = (size_t)n_columns;
  *t = (thr_tree){.n_columns = n_columns, .enough = INFINITY, .most_nodes = INT_MAX};

  thr_status st = thr_grow(&t->node, 0, &t->capacity, sizeof *t->node, err);
  if (!st) st = thr_grow(&t->open, 0, &t->open_capacity, sizeof *t->open, err);
  if (!st && !(t->least = thr_calloc(6 * n, sizeof *t->least))) st = thr_nomem(err);
  if (st) {
    thr_tree_destroy(t);
    return st;
  }

  /* One block holds the bounds of the root, those in force, and scratch. */
  t->most = t->least + n;
  t->here.low = t->most + n;
  t->here.high = t->here.low + n;
  t->here.next[0] = t->here.high + n;
  t->here.next[1] = t->here.next[0] + n;
  for (size_t j = 0; j < n; j++) {
    t->least[j] = t->here.low[j] = least ? least[j] : 0;
    t->most[j] = t->here.high[j] = most[j];
  }

  /* The tree consists of the root, which is open. */
  t->node[t->n_nodes++] = (thr_tree_node){.parent = -1, .bound = -INFINITY, .proof = -1};
  t->open[t->n_open++] = 0;
  return THR_OK;
}

void thr_tree_destroy(thr_tree *t)
{
  for (int i = 0; i < t->n_nodes; i++)
    free(t->node[i].also);
  free(t->least);
  free(t->node);
  free(t->open);
  *t = (thr_tree){0};
}

/* Says whether the bound of a node is enough. */
static bool tree_closed(const thr_tree *t, int node)
{
  return t->node[node].bound >= t->enough;
}

/* ---- the heap of open nodes ---- */

/* Returns the multiple of the tree's grain that a bound is compared by. */
static double rounded_bound(const thr_tree *t, double bound)
{
  return t->grain > 0 ? floor(bound / t->grain) : bound;
}

/* Says whether node a is to be solved before node b. */
static bool before(const thr_tree *t, int a, int b)
{
  const thr_tree_node *node = &t->node[a], *other = &t->node[b];
  double bound = rounded_bound(t, node->bound), other_bound = rounded_bound(t, other->bound);

  if (bound != other_bound) return bound < other_bound;
  if (node->depth != other->depth) return node->depth > other->depth;

  /* Nodes 2 k + 1 and 2 k + 2 are siblings. */
  return (a - 1) / 2 == (b - 1) / 2 ? node->first : a > b;
}

/* Opens a node. */
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

/* Takes the first node out of the heap. */
static int pop(thr_tree *t)
{
  /* Fill the hole at the top with children until there is a place for the last entry. */
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
  /* Nodes that are being solved have the bounds known so far. */
  double least = t->n_open > 0 ? t->node[t->open[0]].bound : INFINITY;
  for (int i = 0; i < t->n_taken; i++)
    least = fmin(least, t->node[t->taken[i]].bound);
  return least;
}

int thr_tree_undecided(const double *x, int first, int end, double tolerance, const int *decided)
{
  int best = -1;
  double most = tolerance;

  /* Equal distances from a whole number leave the first column, whatever the rounding. */
  for (int j = first; j < end; j++) {
    double distance = fabs(x[j] - nearbyint(x[j]));
    if (distance <= most + 1e-9 || (decided && decided[j] > 0)) continue;
    most = distance;
    best = j;
  }
  return best;
}

/* ---- bounds on columns ---- */

/* Returns number i, 0 .. n_also, of the columns that a node decides on. */
static int decided(const thr_tree_node *node, int i)
{
  return i == 0 ? node->column : node->also[i - 1];
}

/* Sets the bounds to be entered of all columns decided between a node and the root to those of
 * the root. */
static void widen(const thr_tree *t, thr_tree_place *place, int node)
{
  for (int k = node; k > 0; k = t->node[k].parent)
    for (int i = 0; i <= t->node[k].n_also; i++) {
      int j = decided(&t->node[k], i);
      place->next[0][j] = t->least[j];
      place->next[1][j] = t->most[j];
    }
}

/* Tightens the bounds to be entered by the decisions between a node and the root. */
static void narrow(const thr_tree *t, thr_tree_place *place, int node)
{
  for (int k = node; k > 0; k = t->node[k].parent) {
    const thr_tree_node *decision = &t->node[k];
    for (int i = 0; i <= decision->n_also; i++) {
      int j = decided(decision, i);
      if (decision->high && decision->value + 1 > place->next[0][j])
        place->next[0][j] = decision->value + 1;
      if (!decision->high && decision->value < place->next[1][j])
        place->next[1][j] = decision->value;
    }
  }
}

/* Puts the bounds to be entered of these columns in force where they differ. */
static thr_status set_along(const thr_tree *t, const thr_tree_calls *calls, thr_tree_place *place,
                            int node, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = node; k > 0 && !st; k = t->node[k].parent)
    for (int i = 0; i <= t->node[k].n_also && !st; i++) {
      int j = decided(&t->node[k], i), low = place->next[0][j], high = place->next[1][j];
      if (low == place->low[j] && high == place->high[j]) continue;

      place->low[j] = low;
      place->high[j] = high;
      st = calls->set(calls->user, j, low, high, err);
    }
  return st;
}

thr_status thr_tree_enter_at(const thr_tree *t, const thr_tree_calls *calls, thr_tree_place *place,
                             int node, thr_err *err)
{
  /* Only columns decided above the old node or above the new one can change. */
  widen(t, place, place->at);
  widen(t, place, node);
  narrow(t, place, node);

  thr_status st = set_along(t, calls, place, place->at, err);
  if (!st) st = set_along(t, calls, place, node, err);
  place->at = node;
  return st;
}

thr_status thr_tree_enter(thr_tree *t, const thr_tree_calls *calls, int node, thr_err *err)
{
  return thr_tree_enter_at(t, calls, &t->here, node, err);
}

/* ---- the search ---- */

/* Creates the two children of a node and opens them. */
static thr_status split(thr_tree *t, int node, thr_tree_branch branch, thr_err *err)
{
  /* A tree that may not grow any more is stopped; its open nodes keep their bounds. */
  if (t->n_nodes + 2 > t->most_nodes) {
    t->stopped = true;
    return THR_OK;
  }

  /* The child with the lower values is the first. */
  for (int side = 0; side < 2; side++) {
    thr_status st = thr_grow(&t->node, t->n_nodes, &t->capacity, sizeof *t->node, err);
    if (st) return st;

    /* A child begins with its parent's bound and proof. */
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

    /* The first child may decide on images of the column, too. */
    if (side == 0 && branch.n_also > 0) {
      if (!(child->also = thr_calloc((size_t)branch.n_also, sizeof *child->also)))
        return thr_nomem(err);
      memcpy(child->also, branch.also, (size_t)branch.n_also * sizeof *child->also);
      child->n_also = branch.n_also;
    }

    if ((st = push(t, parent->child[side], err))) return st;
  }
  return THR_OK;
}

/* Takes the nodes of the next batch out of the heap: the root alone, two after this, then up to
 * THR_TREE_BATCH. The size of a batch does not depend on the number of threads. */
static void take(thr_tree *t, bool several)
{
  const int most = !several || t->n_solved == 0 ? 1 : t->n_solved < 3 ? 2 : THR_TREE_BATCH;
  t->n_taken = 0;

  while (t->n_taken < most && t->n_open > 0 && !tree_closed(t, t->open[0]))
    t->taken[t->n_taken++] = pop(t);
  t->n_solved += t->n_taken;
}

/* Solves the nodes of the batch. */
static thr_status solve_taken(thr_tree *t, const thr_tree_calls *calls, thr_tree_branch *branch,
                              thr_err *err)
{
  if (t->n_taken > 1) return calls->solve_all(calls->user, t->n_taken, t->taken, branch, err);

  thr_status st = thr_tree_enter(t, calls, t->taken[0], err);
  return st ? st : calls->solve(calls->user, t->taken[0], branch, err);
}

thr_status thr_tree_run(thr_tree *t, const thr_tree_calls *calls, thr_err *err)
{
  thr_status st = THR_OK;
  while (!st && !t->stopped && t->n_open > 0 && !tree_closed(t, t->open[0])) {
    thr_tree_branch branch[THR_TREE_BATCH];

    /* The root is solved in any case, so that there is a bound. */
    t->stopped = t->open[0] > 0 && calls->limits && thr_limits_stop(calls->limits);
    if (t->stopped) break;

    /* Solve a batch. */
    take(t, calls->solve_all != NULL);
    for (int i = 0; i < t->n_taken; i++)
      branch[i] = (thr_tree_branch){.column = -1};
    st = solve_taken(t, calls, branch, err);

    /* Branch where the caller asks for it, unless the new bound closes the node. */
    for (int i = 0; i < t->n_taken && !st && !t->stopped; i++)
      if (branch[i].column >= 0 && !tree_closed(t, t->taken[i]))
        st = split(t, t->taken[i], branch[i], err);
  }
  return st;
}
