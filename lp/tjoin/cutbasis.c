/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the cuts of a T-join as a linear programme, and chooses a basis from the join, so that
 * GLPK needs few pivots to confirm the optimum.
 *
 * The programme minimizes the sum of w(e) x(e) with x >= 0 and x(edges that leave S) - s = 1, s >=
 * 0, for every set S among the cuts. From the equation of a cut those of its children are
 * subtracted. An edge that leaves a set and sets within this set at one node then has an entry in
 * the equation of the innermost set only, so that deeply nested cuts have few entries.
 *
 * Example: one odd set S with two edges of weight 2 and 3 leaving it, the first one in the join:
 * the equation x1 + x2 - s = 1, in which x1 is basic. */
#include "lp/tjoin/tjoin.h"
#include "graph/arrays.h"

#include <stdlib.h>

/* ---- the cuts round a node ---- */

/* For every node the cuts that list it, at most one in each tree of the forest. */
typedef struct {
  const thr_tjoin_problem *problem;
  const thr_tjoin *join;
  int *tree;          /* [n_cuts] root of the cut's tree */
  int *first, *holds; /* cuts that list node v: holds[first[v] .. first[v + 1] - 1] */
  thr_scratch own;    /* the arrays */
} cut_index;

/* Fills the index; children must come before their parents. */
static thr_status index_init(cut_index *by_node, const thr_tjoin_problem *tjoin_problem,
                             const thr_tjoin *tjoin, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes, named = 0;
  *by_node = (cut_index){.problem = tjoin_problem, .join = tjoin};
  by_node->tree = thr_scratch_array(&by_node->own, (size_t)tjoin->n_cuts, sizeof *by_node->tree);
  by_node->first = thr_scratch_array(&by_node->own, n + 2, sizeof *by_node->first);
  if (thr_scratch_check(&by_node->own, err)) return THR_ENOMEM;

  /* Find the root of every cut, parents first, and count the cuts at every node. */
  for (int i = tjoin->n_cuts - 1; i >= 0; i--) {
    by_node->tree[i] = tjoin->cut[i].parent < 0 ? i : by_node->tree[tjoin->cut[i].parent];
    named += (size_t)tjoin->cut[i].n_nodes;
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      by_node->first[tjoin->cut[i].node[k] + 2]++;
  }

  /* Sort the cuts by node. */
  for (size_t v = 1; v <= n; v++)
    by_node->first[v + 1] += by_node->first[v];
  by_node->holds = thr_scratch_array(&by_node->own, named, sizeof *by_node->holds);
  if (thr_scratch_check(&by_node->own, err)) return THR_ENOMEM;
  for (int i = 0; i < tjoin->n_cuts; i++)
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      by_node->holds[by_node->first[tjoin->cut[i].node[k] + 1]++] = i;
  return THR_OK;
}

/* Returns the cut of a tree that lists node v, or -1. */
static int cut_in_tree(const cut_index *by_node, int v, int tree)
{
  for (int k = by_node->first[v]; k < by_node->first[v + 1]; k++)
    if (by_node->tree[by_node->holds[k]] == tree) return by_node->holds[k];
  return -1;
}

/* Computes where edge e lies in the k-th of the trees that list one of its ends: at[i] becomes
 * the cut that lists end i, -1 if the tree does not list this end. Both are -1 if the tree came
 * up at a smaller k. Returns false if there are fewer trees. */
static bool ends_in_tree(const cut_index *by_node, int e, int k, int at[2])
{
  /* The trees at the first end come first, then the trees at the second one. */
  int u = by_node->problem->edge[e][0], v = by_node->problem->edge[e][1],
      of_u = by_node->first[u + 1] - by_node->first[u];
  bool second = k >= of_u;
  if (second && k - of_u >= by_node->first[v + 1] - by_node->first[v]) return false;
  at[second] = by_node->holds[second ? by_node->first[v] + k - of_u : by_node->first[u] + k];
  at[!second] = cut_in_tree(by_node, second ? u : v, by_node->tree[at[second]]);

  /* A tree at both ends has come up at the first one. */
  if (second && at[0] >= 0) at[0] = at[1] = -1;
  return true;
}

/* Moves the inner one of the cuts at[0] and at[1] (-1: outside of all) to its parent, and
 * returns this inner cut, which the edge leaves. Repeated until both are the same, this visits
 * all cuts of the tree that the edge leaves. */
static int step_out(const thr_cut *cut, int at[2])
{
  bool second = at[0] < 0 || (at[1] >= 0 && at[1] < at[0]); /* parents have higher numbers */
  int left = at[second];
  at[second] = cut[left].parent;
  return left;
}

/* ---- columns ---- */

/* Appends an entry to the column that is being written. */
static void add_entry(thr_cut_programme *cut_programme, int *n, int row, double value)
{
  cut_programme->row[*n] = row;
  cut_programme->value[(*n)++] = value;
}

/* Writes the column of an edge: in every tree an entry 1 at the innermost cuts that the edge
 * leaves, one at either end, and as many times -1 at the innermost cut that holds both ends. */
static void add_edge(thr_cut_programme *cut_programme, const cut_index *by_node, int e, int *n)
{
  int at[2];
  for (int k = 0; ends_in_tree(by_node, e, k, at); k++) {
    /* Find the innermost cut that holds both ends, or -1. */
    int inner[2] = {at[0], at[1]}, leaves = 0;
    while (at[0] != at[1])
      step_out(by_node->join->cut, at);

    /* An end listed by this very cut leaves nothing. */
    for (int i = 0; i < 2; i++) {
      if (inner[i] == at[0]) continue;
      add_entry(cut_programme, n, inner[i], 1);
      leaves++;
    }

    if (leaves > 0 && at[0] >= 0) add_entry(cut_programme, n, at[0], -leaves);
  }
}

/* Writes all columns, of edges and of slacks, and the right sides. */
static thr_status columns_init(thr_cut_programme *cut_programme, const cut_index *by_node,
                               thr_err *err)
{
  const thr_cut *cut = by_node->join->cut;
  size_t most = 2 * (size_t)cut_programme->n_rows;
  int n = 0;

  /* An edge has at most three entries in a tree, a slack two. */
  for (int e = 0; e < by_node->problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      most += 3 * (size_t)(by_node->first[by_node->problem->edge[e][i] + 1] -
                           by_node->first[by_node->problem->edge[e][i]]);
  cut_programme->rhs = thr_calloc((size_t)cut_programme->n_rows, sizeof *cut_programme->rhs);
  cut_programme->start =
      thr_calloc((size_t)cut_programme->n_columns + 1, sizeof *cut_programme->start);
  cut_programme->row = thr_calloc(most, sizeof *cut_programme->row);
  cut_programme->value = thr_calloc(most, sizeof *cut_programme->value);
  if (!cut_programme->rhs || !cut_programme->start || !cut_programme->row || !cut_programme->value)
    return thr_nomem(err);

  /* Columns of edges. */
  for (int e = 0; e < by_node->problem->n_edges; e++) {
    add_edge(cut_programme, by_node, e, &n);
    cut_programme->start[e + 1] = n;
  }

  /* Columns of slacks: -1 in the own equation and, as this is subtracted there, 1 in the
   * parent's. */
  for (int i = 0; i < cut_programme->n_rows; i++) {
    add_entry(cut_programme, &n, i, -1);
    cut_programme->rhs[i] += 1;
    if (cut[i].parent >= 0) {
      add_entry(cut_programme, &n, cut[i].parent, 1);
      cut_programme->rhs[cut[i].parent] -= 1;
    }
    cut_programme->start[by_node->problem->n_edges + i + 1] = n;
  }
  return THR_OK;
}

/* ---- the basis ---- */

/* Marks the columns of the basis: one edge of the join for every cut that only this edge of the
 * join leaves, but no edge twice, and the slacks of all other cuts. The matrix is not singular:
 * the equation x(edges that leave S) - s = 1 of a cut with a basic edge has no other basic
 * column. */
static thr_status choose_basis(const cut_index *by_node, bool *edge, bool *slack, thr_err *err)
{
  thr_scratch own = {0};
  size_t n = (size_t)by_node->join->n_cuts;
  int *joined = thr_scratch_array(&own, n, sizeof *joined),
      *by = thr_scratch_array(&own, n, sizeof *by), at[2];
  thr_status st = thr_scratch_check(&own, err);

  /* Count the edges of the join that leave each cut, and remember one. */
  for (int e = 0; e < by_node->problem->n_edges && !st; e++)
    for (int k = 0; by_node->join->in_join[e] && ends_in_tree(by_node, e, k, at); k++)
      while (at[0] != at[1]) {
        int left = step_out(by_node->join->cut, at);
        joined[left]++;
        by[left] = e;
      }

  /* An edge is basic for the first cut that it alone leaves. */
  for (int i = 0; i < by_node->join->n_cuts && !st; i++) {
    slack[i] = joined[i] != 1 || edge[by[i]];
    if (!slack[i]) edge[by[i]] = true;
  }

  thr_scratch_free(&own);
  return st;
}

void thr_cut_programme_destroy(thr_cut_programme *cut_programme)
{
  free(cut_programme->rhs);
  free(cut_programme->start);
  free(cut_programme->row);
  free(cut_programme->value);
  free(cut_programme->basic);
  *cut_programme = (thr_cut_programme){0};
}

thr_status thr_cut_programme_init(thr_cut_programme *cut_programme,
                                  const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                  thr_err *err)
{
  cut_index by_node;
  *cut_programme = (thr_cut_programme){.n_rows = tjoin->n_cuts,
                                       .n_columns = tjoin_problem->n_edges + tjoin->n_cuts};
  cut_programme->basic = thr_calloc((size_t)cut_programme->n_columns, sizeof *cut_programme->basic);

  thr_status st = index_init(&by_node, tjoin_problem, tjoin, err);
  if (!st && !cut_programme->basic) st = thr_nomem(err);
  if (!st) st = columns_init(cut_programme, &by_node, err);
  if (!st)
    st = choose_basis(&by_node, cut_programme->basic, cut_programme->basic + tjoin_problem->n_edges,
                      err);

  thr_scratch_free(&by_node.own);
  if (st) thr_cut_programme_destroy(cut_programme);
  return st;
}
