/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cuts of a T-join as a linear programme, and a basis of it from the join, so that GLPK needs
 * few pivots to confirm the optimum. Internal to lp/.
 *
 * Minimize the sum of w(e) x(e) with x(edges that leave S) >= 1 for every set S among the cuts.
 *
 * Example: one odd set S with two edges of weight 2 and 3 leaving it: the row x1 + x2 >= 1, basic
 * x1 = 1.
 *
 * Writes the programme of a T-join's cuts, and chooses a basis from the join.
 *
 * A cut's equation is its own less those of the cuts right inside of it: an edge that leaves a set
 * and the sets within it at one node then stands in the equation of the innermost set only. */
#include "lp/tjoin/tjoin.h"
#include "graph/scratch.h"

#include <stdlib.h>

/* ---- where the nodes are ---- */

typedef struct {
  const thr_tjoin_problem *p;
  const thr_tjoin *t;
  int *tree; /* [n_cuts] the outermost cut round it, or itself */
  int *first,
      *holds; /* cuts that name node v: holds[first[v] .. first[v + 1] - 1], in one tree each */
  thr_scratch own; /* the arrays */
} places;

static void places_destroy(places *s)
{
  thr_scratch_free(&s->own);
}

static thr_status places_init(places *s, const thr_tjoin_problem *tjoin_problem,
                              const thr_tjoin *tjoin, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes, named = 0;
  *s = (places){.p = tjoin_problem, .t = tjoin};
  s->tree = thr_scratch_array(&s->own, (size_t)tjoin->n_cuts, sizeof *s->tree);
  s->first = thr_scratch_array(&s->own, n + 2, sizeof *s->first);
  if (thr_scratch_check(&s->own, err)) return THR_ENOMEM;
  for (int i = tjoin->n_cuts - 1; i >= 0; i--) {
    s->tree[i] = tjoin->cut[i].parent < 0 ? i : s->tree[tjoin->cut[i].parent];
    named += (size_t)tjoin->cut[i].n_nodes;
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      s->first[tjoin->cut[i].node[k] + 2]++;
  }
  for (size_t v = 1; v <= n; v++)
    s->first[v + 1] += s->first[v];
  s->holds = thr_scratch_array(&s->own, named, sizeof *s->holds);
  if (thr_scratch_check(&s->own, err)) return THR_ENOMEM;
  for (int i = 0; i < tjoin->n_cuts; i++)
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      s->holds[s->first[tjoin->cut[i].node[k] + 1]++] = i;
  return THR_OK;
}

/* The cut of that tree that names node v, or -1. */
static int place_in(const places *s, int v, int tree)
{
  for (int k = s->first[v]; k < s->first[v + 1]; k++)
    if (s->tree[s->holds[k]] == tree) return s->holds[k];
  return -1;
}

/* Of the k-th tree that names an end of edge e: the cuts that do so, -1 for an end that it does not
 * name; a tree that came before: -1 for both. False: there are not so many. */
static bool ends_in_tree(const places *s, int e, int k, int at[2])
{
  int u = s->p->edge[e][0], v = s->p->edge[e][1], of_u = s->first[u + 1] - s->first[u];
  bool second = k >= of_u;
  if (second && k - of_u >= s->first[v + 1] - s->first[v]) return false;
  at[second] = s->holds[second ? s->first[v] + k - of_u : s->first[u] + k];
  at[!second] = place_in(s, second ? u : v, s->tree[at[second]]);
  if (second && at[0] >= 0) at[0] = at[1] = -1;
  return true;
}

/* One step on the way between the cuts at[0] and at[1] (-1: outside), out of the inner one, which
 * it returns. */
static int step_out(const thr_cut *cut, int at[2])
{
  bool second = at[0] < 0 || (at[1] >= 0 && at[1] < at[0]); /* parents come later */
  int left = at[second];
  at[second] = cut[left].parent;
  return left;
}

/* ---- columns ---- */

static void add_entry(thr_cut_programme *cut_programme, int *n, int row, double value)
{
  cut_programme->row[*n] = row;
  cut_programme->value[(*n)++] = value;
}

/* An edge stands in the equations of the innermost cuts that it leaves, at either end, and of the
 * one that holds all of them. */
static void add_edge(thr_cut_programme *cut_programme, const places *s, int e, int *n)
{
  int at[2];
  for (int k = 0; ends_in_tree(s, e, k, at); k++) {
    int inner[2] = {at[0], at[1]}, leaves = 0;
    while (at[0] != at[1])
      step_out(s->t->cut, at);
    for (int i = 0; i < 2; i++) {
      if (inner[i] == at[0]) continue;
      add_entry(cut_programme, n, inner[i], 1);
      leaves++;
    }
    if (leaves > 0 && at[0] >= 0) add_entry(cut_programme, n, at[0], -leaves);
  }
}

static thr_status columns_init(thr_cut_programme *cut_programme, const places *s, thr_err *err)
{
  const thr_cut *cut = s->t->cut;
  size_t most = 2 * (size_t)cut_programme->n_rows;
  int n = 0;
  for (int e = 0; e < s->p->n_edges; e++)
    for (int i = 0; i < 2; i++)
      most += 3 * (size_t)(s->first[s->p->edge[e][i] + 1] - s->first[s->p->edge[e][i]]);
  cut_programme->rhs = thr_calloc((size_t)cut_programme->n_rows, sizeof *cut_programme->rhs);
  cut_programme->start =
      thr_calloc((size_t)cut_programme->n_columns + 1, sizeof *cut_programme->start);
  cut_programme->row = thr_calloc(most, sizeof *cut_programme->row);
  cut_programme->value = thr_calloc(most, sizeof *cut_programme->value);
  if (!cut_programme->rhs || !cut_programme->start || !cut_programme->row || !cut_programme->value)
    return thr_nomem(err);
  for (int e = 0; e < s->p->n_edges; e++) {
    add_edge(cut_programme, s, e, &n);
    cut_programme->start[e + 1] = n;
  }
  for (int i = 0; i < cut_programme->n_rows; i++) {
    add_entry(cut_programme, &n, i, -1);
    cut_programme->rhs[i] += 1;
    if (cut[i].parent >= 0) {
      add_entry(cut_programme, &n, cut[i].parent, 1);
      cut_programme->rhs[cut[i].parent] -= 1;
    }
    cut_programme->start[s->p->n_edges + i + 1] = n;
  }
  return THR_OK;
}

/* ---- the basis ---- */

/* Marks as basic every edge of the join that leaves a cut which no other edge of the join leaves,
 * one edge for such a cut, and the slacks of all other cuts. Such a matrix is not singular: in the
 * rows of the basic edges there is no other basic column. */
static thr_status choose_basis(const places *s, bool *edge, bool *slack, thr_err *err)
{
  thr_scratch own = {0};
  size_t n = (size_t)s->t->n_cuts;
  int *joined = thr_scratch_array(&own, n, sizeof *joined),
      *by = thr_scratch_array(&own, n, sizeof *by), at[2];
  thr_status st = thr_scratch_check(&own, err);
  for (int e = 0; e < s->p->n_edges && !st; e++)
    for (int k = 0; s->t->in_join[e] && ends_in_tree(s, e, k, at); k++)
      while (at[0] != at[1]) {
        int left = step_out(s->t->cut, at);
        joined[left]++;
        by[left] = e;
      }
  for (int i = 0; i < s->t->n_cuts && !st; i++) {
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
  places s;
  *cut_programme = (thr_cut_programme){.n_rows = tjoin->n_cuts,
                                       .n_columns = tjoin_problem->n_edges + tjoin->n_cuts};
  cut_programme->basic = thr_calloc((size_t)cut_programme->n_columns, sizeof *cut_programme->basic);
  thr_status st = places_init(&s, tjoin_problem, tjoin, err);
  if (!st && !cut_programme->basic) st = thr_nomem(err);
  if (!st) st = columns_init(cut_programme, &s, err);
  if (!st)
    st = choose_basis(&s, cut_programme->basic, cut_programme->basic + tjoin_problem->n_edges, err);
  places_destroy(&s);
  if (st) thr_cut_programme_destroy(cut_programme);
  return st;
}
