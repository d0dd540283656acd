/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear programme over the columns of graph/plan/turning_proof.h, with its odd, group,
 * partition and junction rows added as a point violates them. Where turns cost nothing the columns
 * of the turns may be left out (tortuosity/proof/project.c).
 *
 * Minimize the sum of price x turns, subject at every half-edge to: passes = turns + ends there.
 * Odd sets, like those of matchings (Edmonds 1965), groups (what is chosen in a set of edges must
 * leave it) and partitions (b blocks need b - 1 links) are separated.
 *
 * Example: a node with four edges passed once: two turns, each edge in one of them; the straight
 * ones cost 0. */
#include "lp/solver/lp.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The first column of the programme. */
static int first_column(const thr_relax *relax)
{
  return relax->projected ? relax->c->first_extra : 0;
}

/* The limit on the extra length, in units of the longest edge; then it is one of the equations as
 * far as rows are counted. */
static thr_status add_length_row(thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int m = turning_columns->f->n_edges;
  int *column = thr_calloc((size_t)m + 1, sizeof *column);
  double *value = thr_calloc((size_t)m + 1, sizeof *value);
  thr_status st = column && value ? THR_OK : thr_nomem(err);
  for (int e = 0; e < m && !st; e++) {
    column[e] = turning_columns->first_extra + e;
    value[e] = -ldexp((double)turning_columns->length[e], -THR_LENGTH_BITS);
  }
  if (!st) {
    column[m] = relax->n_all - 1;
    value[m] = 1;
    st = thr_lp_add_row(relax->search.lp, m + 1, column, value,
                        -ldexp((double)turning_columns->extra_limit, -THR_LENGTH_BITS), err);
    relax->search.n_fixed++;
  }
  free(column);
  free(value);
  return st;
}

static thr_status init_graph(thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges, n = darts + turning_columns->n_ends,
      m = turning_columns->first_back;
  int(*edge)[2] = thr_calloc((size_t)m, sizeof *edge);
  bool *odd = thr_calloc((size_t)n, sizeof *odd);
  relax->problem =
      (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .odd = odd};
  if (!edge || !odd) return thr_nomem(err);
  for (int j = 0; j < m; j++) {
    edge[j][0] = turning_columns->half[j][0];
    edge[j][1] =
        turning_columns->half[j][1] >= 0
            ? turning_columns->half[j][1]
            : darts + turning_columns
                          ->end_group[thr_tail(turning_columns->f, turning_columns->half[j][0])];
  }
  for (int h = 0; h < darts; h++)
    relax->any_odd |= odd[h] = turning_columns->cover[h >> 1] % 2;
  for (int k = 0; k < turning_columns->n_ends; k++)
    relax->any_odd |= odd[darts + k] = turning_columns->supply[k][0] % 2;
  return thr_oddcut_graph_init(&relax->graph, &relax->problem, err);
}

/* The first odd sets: the half-edges of one node, an extra pass or an end at every node of odd
 * degree. */
static thr_status add_node_sets(thr_relax *relax, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  thr_status st = THR_OK;
  for (int v = 0; v < frame->n_nodes && !st; v++)
    st = thr_oddcut_add(&relax->graph, &relax->search.pool, frame->half + frame->first[v],
                        thr_degree(frame, v), err);
  return st;
}

thr_status thr_relax_set(thr_relax *relax, int column, int low, int high, thr_err *err)
{
  bool unbounded = column < relax->c->first_extra && high == thr_turning_most(relax->c, column);
  return thr_lp_set_bounds(relax->search.lp, column - first_column(relax), low,
                           unbounded ? (double)INFINITY : high, err);
}

/* ---- the search ---- */

/* What the equations leave of the costs. */
static void reduce_by_equations(thr_relax *relax)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges;
  for (int j = 0; j < turning_columns->first_back; j++) {
    int a = turning_columns->half[j][0], b = turning_columns->half[j][1];
    double sum =
        relax->search.dual[a] +
        (b >= 0 ? relax->search.dual[b]
                : relax->search
                      .dual[darts + turning_columns->end_group[thr_tail(turning_columns->f, a)]]);
    relax->reduced[j] +=
        j >= turning_columns->first_extra && j < turning_columns->first_end ? sum : -sum;
  }
}

void thr_relax_look(thr_relax *relax)
{
  const thr_turning_columns *turning_columns = relax->c;
  int first = first_column(relax);
  relax->artificial = 0;
  for (int j = turning_columns->n_columns; j < relax->n_all; j++)
    relax->artificial += relax->x[j];
  for (int j = first; j < turning_columns->first_back; j++)
    relax->reduced[j] = ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
  if (!relax->projected) reduce_by_equations(relax);
  for (int i = 0; i < relax->search.pool.count; i++)
    thr_row_charge(&relax->search.pool.row[i], relax->search.dual[relax->search.n_fixed + i],
                   relax->reduced + first);
}

/* ---- all ---- */

/* Without programme and rows. */
static thr_status begin(thr_relax *relax, const thr_turning_columns *turning_columns,
                        bool projected, thr_err *err)
{
  size_t n = (size_t)turning_columns->n_columns;
  *relax = (thr_relax){.c = turning_columns, .projected = projected};
  int equations = 2 * turning_columns->f->n_edges +
                  (turning_columns->task->end_allowed ? turning_columns->n_ends : 0);
  if (projected) equations = 0;
  relax->n_all = turning_columns->n_columns + 2 * equations + 1;
  relax->x = thr_calloc((size_t)relax->n_all, sizeof *relax->x);
  relax->reduced = thr_calloc(n, sizeof *relax->reduced);
  thr_status st = relax->x && relax->reduced ? THR_OK : thr_nomem(err);
  int columns = projected ? turning_columns->first_back - turning_columns->first_extra
                          : turning_columns->n_columns;
  if (!st) st = thr_search_init(&relax->search, columns, relax->x + first_column(relax), err);
  relax->search.n_fixed = equations;
  relax->search.help = projected ? columns : relax->n_all - 1;
  return st;
}

/* What odd sets are looked for in. */
static thr_status add_graph(thr_relax *relax, thr_err *err)
{
  relax->odd = (thr_oddcuts){.graph = &relax->graph,
                             .x = relax->search.x,
                             .reduced_cost = relax->reduced + first_column(relax),
                             .point = relax->search.x,
                             .threshold = {1e-6, 0.2, 0.35, 0.51, 0.7},
                             .pool = &relax->search.pool};
  return relax->projected ? thr_project_graph(relax, err) : init_graph(relax, err);
}

thr_status thr_relax_init(thr_relax *relax, const thr_turning_columns *turning_columns,
                          bool projected, double penalty, const thr_limits *limits, thr_err *err)
{
  thr_status st = begin(relax, turning_columns, projected, err);
  if (!st)
    st =
        projected ? thr_project_create(relax, penalty, err) : thr_relax_create(relax, penalty, err);
  if (!st && turning_columns->extra_limit >= 0) st = add_length_row(relax, err);
  for (int j = turning_columns->first_extra; j < turning_columns->n_columns && !st;
       j++) /* turns: by their equations */
    st = thr_lp_set_bounds(relax->search.lp, j - first_column(relax), 0,
                           thr_turning_most(turning_columns, j), err);
  if (!st && !projected) st = thr_relax_crash(relax, limits, err);
  if (!st) st = add_graph(relax, err);
  if (!st && !projected) st = add_node_sets(relax, err);
  if (st) thr_relax_destroy(relax);
  return st;
}

thr_status thr_relax_copy(thr_relax *relax, const thr_relax *from, thr_err *err)
{
  thr_status st = begin(relax, from->c, from->projected, err);
  relax->search.n_fixed = from->search.n_fixed;
  if (!st) st = thr_lp_copy(&relax->search.lp, from->search.lp, err);
  if (!st) st = thr_pool_copy(&relax->search.pool, &from->search.pool, err);
  if (!st) st = add_graph(relax, err);
  if (st) thr_relax_destroy(relax);
  return st;
}

void thr_relax_destroy(thr_relax *relax)
{
  thr_search_destroy(&relax->search);
  free(relax->x);
  free(relax->reduced);
  thr_oddcut_graph_destroy(&relax->graph);
  free((void *)relax->problem.edge);
  free((void *)relax->problem.odd);
  *relax = (thr_relax){0};
}
