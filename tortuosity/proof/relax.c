/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The turning relaxation: a linear programme over the columns of graph/plan/turning_proof.h (turns,
 * extra passes, ends, turns back) whose value no plan can undercut.
 *
 * It minimizes the sum of price x column, subject at every half-edge to: passes = turns + ends
 * there. Four families of inequalities that every plan keeps are added as a point violates them:
 * odd sets, as for matchings (Edmonds 1965); groups (what is chosen in a set of edges must leave
 * the set); partitions (b blocks need b - 1 links); and junctions, of single tied nodes. Where
 * turns cost nothing the columns of the turns may be left out (tortuosity/proof/project.c). The
 * equations are made in equations.c; this file holds bounds, reduced costs, and copies.
 *
 * Example: a node with four edges, each passed once, has two turns, and each edge is in one of
 * them; if the two pairs of opposite edges are straight, both turns cost 0. */
#include "lp/solver/solver.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>

/* Returns the number of the column that is the programme's column 0. */
static int first_column(const thr_relax *relax)
{
  return relax->projected ? relax->c->first_extra : 0;
}

/* Adds the limit on the length of the extra passes, in units of the longest edge:
 * -length + artificial >= -limit. The artificial column is the last one, which all added rows
 * share. The row counts as one of the fixed rows. */
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

/* Makes the graph in which odd sets are looked for. Its nodes are the half-edges and, behind these,
 * the end groups; its edges are the columns: turns and extra passes join two half-edges, an end
 * joins a half-edge and the group of its node. A node is odd if the columns at it must have an odd
 * sum in every plan. */
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

/* Adds the first odd sets, the half-edges of each node: a node of odd degree, passed once by every
 * edge, has at least one extra pass or end. */
static thr_status add_node_sets(thr_relax *relax, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  thr_status st = THR_OK;
  for (int v = 0; v < frame->n_nodes && !st; v++)
    st = thr_oddcut_add(&relax->graph, &relax->search.pool, frame->half + frame->first[v],
                        thr_degree(frame, v), err);
  return st;
}

/* Sets the bounds of a column. A turn at its largest value gets no upper bound, because the
 * equations of its half-edges bound it already. */
thr_status thr_relax_set(thr_relax *relax, int column, int low, int high, thr_err *err)
{
  bool unbounded = column < relax->c->first_extra && high == thr_turning_most(relax->c, column);
  return thr_lp_set_bounds(relax->search.lp, column - first_column(relax), low,
                           unbounded ? (double)INFINITY : high, err);
}

/* ---- the search ---- */

/* Subtracts from the costs what the multipliers of the equations pay: each column stands in the
 * equations of its two half-edges, or of its half-edge and its end group. An extra pass stands on
 * the other side of the equation, hence its opposite sign. */
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

/* Computes the sum of the artificial columns and the reduced costs of all others but turns back,
 * from the multipliers of equations and pool. */
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

/* Allocates a relaxation whose programme has no columns and rows yet. Two artificial columns for
 * every equation, one of either sign, and one for all rows that are added later keep every branch
 * feasible. */
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

  /* The search sees the programme's own columns, which begin with the extra passes if projected. */
  if (!st) st = thr_search_init(&relax->search, columns, relax->x + first_column(relax), err);
  relax->search.n_fixed = equations;
  relax->search.help = projected ? columns : relax->n_all - 1;
  return st;
}

/* Makes the graph of odd sets and the state of their separator, which reads point and reduced costs
 * from the relaxation and adds rows to its pool. */
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

/* Makes the programme with its fixed rows, a basis to start from, and the first odd sets. Turns
 * have no bounds, because their equations bound them. On failure the relaxation is empty. */
thr_status thr_relax_init(thr_relax *relax, const thr_turning_columns *turning_columns,
                          bool projected, double penalty, const thr_limits *limits, thr_err *err)
{
  thr_status st = begin(relax, turning_columns, projected, err);
  if (!st)
    st =
        projected ? thr_project_create(relax, penalty, err) : thr_relax_create(relax, penalty, err);
  if (!st && turning_columns->extra_limit >= 0) st = add_length_row(relax, err);
  for (int j = turning_columns->first_extra; j < turning_columns->n_columns && !st; j++)
    st = thr_lp_set_bounds(relax->search.lp, j - first_column(relax), 0,
                           thr_turning_most(turning_columns, j), err);

  /* The basis comes before the odd sets: thr_relax_crash knows only the equations. */
  if (!st && !projected) st = thr_relax_crash(relax, limits, err);
  if (!st) st = add_graph(relax, err);
  if (!st && !projected) st = add_node_sets(relax, err);
  if (st) thr_relax_destroy(relax);
  return st;
}

/* Copies programme, basis and pool. The graph of odd sets is made anew, because its arrays are
 * owned by each relaxation. On failure the copy is empty. */
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

/* Releases all that a relaxation owns, also one that was left half made. */
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
