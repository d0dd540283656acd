/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the linear programme of the equations of the turning relaxation, and a basis to start from.
 *
 * Row h says for half-edge h: turns + ends + 2 x turns back - extra passes = cover. One more row
 * for every group of ends says how many ends it has, if ends are allowed. Two artificial columns
 * per row, +1 and -1, and one for all rows that are added later keep the programme feasible under
 * every branching.
 *
 * From the slack basis the simplex method would need about as many pivots as there are rows.
 * Instead the small programme of each node by itself is solved, with turns alone, and what is basic
 * there is basic in the whole: without extra passes the matrix is block diagonal.
 *
 * Example: a node with two edges has the rows of half-edges a and b and the one turn (a, b), which
 * is basic, with the slack of one of the rows. */
#include "graph/arrays.h"
#include "lp/solver/solver.h"
#include "tortuosity/proof/branch.h"

#include <math.h>

/* A programme of equations as thr_lp_create_equations takes it, by columns. */
typedef struct {
  int n, *start, *row;
  double *value, *cost, *rhs;
  thr_scratch own; /* the arrays */
} equation_matrix;

/* Appends an entry to the column that is being written. */
static void put(equation_matrix *matrix, int row, double value)
{
  matrix->row[matrix->n] = row;
  matrix->value[matrix->n++] = value;
}

/* Writes all columns and right sides. penalty: cost of the artificial columns. */
static void fill_matrix(const thr_relax *relax, double penalty, equation_matrix *matrix)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges, j = 0;

  /* Turns, extra passes, ends and turns back. A turn back has its half-edge's row alone, with a 2.
   */
  for (; j < turning_columns->n_columns; j++) {
    int a = turning_columns->half[j][0], b = turning_columns->half[j][1];
    bool extra = j >= turning_columns->first_extra && j < turning_columns->first_end;
    matrix->start[j] = matrix->n;
    matrix->cost[j] = ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
    put(matrix, a, a == b ? 2 : extra ? -1 : 1);
    if (b >= 0 && a != b) put(matrix, b, extra ? -1 : 1);
    if (b < 0) put(matrix, darts + turning_columns->end_group[thr_tail(turning_columns->f, a)], 1);
  }

  /* The artificial columns of the rows, then the one of all rows that are added later. */
  for (int i = 0; i < relax->search.n_fixed; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      matrix->start[j] = matrix->n;
      matrix->cost[j++] = penalty;
      put(matrix, i, sign);
    }
  matrix->start[j] = matrix->n;
  matrix->cost[j++] = penalty;
  matrix->start[j] = matrix->n;

  /* Right sides. */
  for (int h = 0; h < darts; h++)
    matrix->rhs[h] = turning_columns->cover[h >> 1];
  for (int i = darts; i < relax->search.n_fixed; i++)
    matrix->rhs[i] = turning_columns->supply[i - darts][0];
}

/* Allocates and fills the matrix: at most 3 entries in a column of the model. */
static thr_status matrix_init(equation_matrix *matrix, const thr_relax *relax, double penalty,
                              thr_err *err)
{
  size_t n = (size_t)relax->n_all,
         entries = 3 * (size_t)relax->c->n_columns + 2 * (size_t)relax->search.n_fixed;
  *matrix = (equation_matrix){0};

  matrix->start = thr_scratch_array(&matrix->own, n + 1, sizeof *matrix->start);
  matrix->row = thr_scratch_array(&matrix->own, entries, sizeof *matrix->row);
  matrix->value = thr_scratch_array(&matrix->own, entries, sizeof *matrix->value);
  matrix->cost = thr_scratch_array(&matrix->own, n, sizeof *matrix->cost);
  matrix->rhs = thr_scratch_array(&matrix->own, (size_t)relax->search.n_fixed, sizeof *matrix->rhs);

  if (thr_scratch_check(&matrix->own, err)) return THR_ENOMEM;
  fill_matrix(relax, penalty, matrix);
  return THR_OK;
}

/* Makes the programme of the fixed rows. */
thr_status thr_relax_create(thr_relax *relax, double penalty, thr_err *err)
{
  equation_matrix matrix;
  thr_status st = matrix_init(&matrix, relax, penalty, err);
  if (!st)
    st = thr_lp_create_equations(&relax->search.lp, relax->search.n_fixed, matrix.rhs, relax->n_all,
                                 matrix.cost, NULL, matrix.start, matrix.row, matrix.value, err);
  thr_scratch_free(&matrix.own);
  return st;
}

/* ---- a basis to start from ---- */

/* State of the search for a basis. */
typedef struct {
  const thr_relax *r;
  equation_matrix matrix;         /* of one node: its rows, and its turns or its U-turn */
  bool *row_basic, *column_basic; /* of the whole programme */
  int *back;                      /* [2 * n_edges] column of the U-turn at a half-edge, else 0 */
} crash;

/* Allocates for the largest node, and finds the turn back of every half-edge. */
static thr_status crash_init(crash *state, const thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  size_t most = 1, turns;
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if ((size_t)thr_degree(turning_columns->f, v) > most)
      most = (size_t)thr_degree(turning_columns->f, v);
  turns = most * most;

  *state = (crash){.r = relax};
  state->matrix.start =
      thr_scratch_array(&state->matrix.own, turns + 1, sizeof *state->matrix.start);
  state->matrix.row = thr_scratch_array(&state->matrix.own, 2 * turns, sizeof *state->matrix.row);
  state->matrix.value =
      thr_scratch_array(&state->matrix.own, 2 * turns, sizeof *state->matrix.value);
  state->matrix.cost = thr_scratch_array(&state->matrix.own, turns, sizeof *state->matrix.cost);
  state->matrix.rhs = thr_scratch_array(&state->matrix.own, most, sizeof *state->matrix.rhs);
  state->row_basic = thr_scratch_array(&state->matrix.own, (size_t)thr_lp_rows(relax->search.lp),
                                       sizeof *state->row_basic);
  state->column_basic =
      thr_scratch_array(&state->matrix.own, (size_t)relax->n_all, sizeof *state->column_basic);
  state->back = thr_scratch_array(&state->matrix.own, 2 * (size_t)turning_columns->f->n_edges,
                                  sizeof *state->back);

  if (thr_scratch_check(&state->matrix.own, err)) return THR_ENOMEM;
  for (int j = turning_columns->first_back; j < turning_columns->n_columns; j++)
    state->back[turning_columns->half[j][0]] = j;
  return THR_OK;
}

/* Solves the programme of node v by itself: the cheapest turns without extra passes and ends, or
 * the turn back at a node with one edge. Marks what is basic there as basic in the whole. */
static thr_status crash_node(crash *state, int v, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *turning_columns = state->r->c;
  const int *half = turning_columns->f->half + turning_columns->f->first[v];
  int d = thr_degree(turning_columns->f, v), n = d == 1 ? 1 : d * (d - 1) / 2,
      first = d == 1 ? state->back[half[0]] : turning_columns->pair_first[v];
  thr_lp *lp;
  thr_lp_outcome outcome = THR_LP_OPTIMAL;

  /* The columns and right sides of the node. */
  state->matrix.n = 0;
  for (int j = 0; j < n; j++) {
    int a = turning_columns->half[first + j][0], b = turning_columns->half[first + j][1];
    state->matrix.start[j] = state->matrix.n;
    state->matrix.cost[j] = ldexp((double)turning_columns->weight[first + j], -THR_TURNING_BITS);
    put(&state->matrix, turning_columns->position[a], a == b ? 2 : 1);
    if (a != b) put(&state->matrix, turning_columns->position[b], 1);
  }
  state->matrix.start[n] = state->matrix.n;
  for (int i = 0; i < d; i++)
    state->matrix.rhs[i] = turning_columns->cover[half[i] >> 1];

  thr_status st =
      thr_lp_create_equations(&lp, d, state->matrix.rhs, n, state->matrix.cost, NULL,
                              state->matrix.start, state->matrix.row, state->matrix.value, err);
  if (!st) st = thr_lp_solve(lp, limits, &outcome, err);

  /* Copy the basis. */
  for (int i = 0; i < d && !st; i++)
    state->row_basic[half[i]] = thr_lp_row_basic(lp, i);
  for (int j = 0; j < n && !st; j++)
    state->column_basic[first + j] = thr_lp_column_basic(lp, j);
  thr_lp_destroy(lp);
  return st;
}

/* Sets the basis that consists of the bases of all nodes. */
thr_status thr_relax_crash(thr_relax *relax, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges;
  crash state;
  thr_status st = crash_init(&state, relax, err);

  /* With tube joints nothing turns back: at a node with one edge the only column is its end. */
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    if (thr_degree(turning_columns->f, v) == 1 && turning_columns->task->tube)
      state.column_basic[turning_columns
                             ->end_column[turning_columns->f->half[turning_columns->f->first[v]]]] =
          true;
    else if (thr_degree(turning_columns->f, v) > 0)
      st = crash_node(&state, v, limits, err);

  /* Rows of ends: the nodes were solved without ends, and the artificial column makes up for this.
   */
  for (int i = darts; !st && i < thr_lp_rows(relax->search.lp); i++)
    if (i < darts + turning_columns->n_ends && turning_columns->task->end_allowed)
      state.column_basic[turning_columns->n_columns + 2 * i + 1] = true;
    else
      state.row_basic[i] = true;

  /* The basis is optimal node by node, but rows of the pool would make it infeasible. */
  if (!st) st = thr_lp_set_basis(relax->search.lp, state.row_basic, state.column_basic, err);
  relax->search.bare = true;
  thr_scratch_free(&state.matrix.own);
  return st;
}
