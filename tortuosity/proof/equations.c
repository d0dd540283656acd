/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of the turning relaxation, and a basis to start from. */
#include "graph/scratch.h"
#include "lp/solver/lp.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int n, *start, *row;
  double *value, *cost, *rhs;
  thr_scratch own; /* the arrays */
} matrix;

static void put(matrix *m, int row, double value)
{
  m->row[m->n] = row;
  m->value[m->n++] = value;
}

static void fill_matrix(const thr_relax *relax, double penalty, matrix *m)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges, j = 0;
  for (; j < turning_columns->n_columns; j++) {
    int a = turning_columns->half[j][0], b = turning_columns->half[j][1];
    bool extra = j >= turning_columns->first_extra && j < turning_columns->first_end;
    m->start[j] = m->n;
    m->cost[j] = ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
    put(m, a, a == b ? 2 : extra ? -1 : 1);
    if (b >= 0 && a != b) put(m, b, extra ? -1 : 1);
    if (b < 0) put(m, darts + turning_columns->end_group[thr_tail(turning_columns->f, a)], 1);
  }
  for (int i = 0; i < relax->search.n_fixed; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      m->start[j] = m->n;
      m->cost[j++] = penalty;
      put(m, i, sign);
    }
  m->start[j] = m->n; /* helps every row that is added later */
  m->cost[j++] = penalty;
  m->start[j] = m->n;
  for (int h = 0; h < darts; h++)
    m->rhs[h] = turning_columns->cover[h >> 1];
  for (int i = darts; i < relax->search.n_fixed; i++)
    m->rhs[i] = turning_columns->supply[i - darts][0];
}

static thr_status matrix_init(matrix *m, const thr_relax *relax, double penalty, thr_err *err)
{
  size_t n = (size_t)relax->n_all,
         entries = 3 * (size_t)relax->c->n_columns + 2 * (size_t)relax->search.n_fixed;
  *m = (matrix){0};
  m->start = thr_scratch_array(&m->own, n + 1, sizeof *m->start);
  m->row = thr_scratch_array(&m->own, entries, sizeof *m->row);
  m->value = thr_scratch_array(&m->own, entries, sizeof *m->value);
  m->cost = thr_scratch_array(&m->own, n, sizeof *m->cost);
  m->rhs = thr_scratch_array(&m->own, (size_t)relax->search.n_fixed, sizeof *m->rhs);
  if (thr_scratch_check(&m->own, err)) return THR_ENOMEM;
  fill_matrix(relax, penalty, m);
  return THR_OK;
}

thr_status thr_relax_create(thr_relax *relax, double penalty, thr_err *err)
{
  matrix m;
  thr_status st = matrix_init(&m, relax, penalty, err);
  if (!st)
    st = thr_lp_create_equations(&relax->search.lp, relax->search.n_fixed, m.rhs, relax->n_all,
                                 m.cost, NULL, m.start, m.row, m.value, err);
  thr_scratch_free(&m.own);
  return st;
}

/* ---- a basis to start from ---- */

typedef struct {
  const thr_relax *r;
  matrix m;                       /* of one node: its rows, and its turns or its U-turn */
  bool *row_basic, *column_basic; /* of the whole programme */
  int *back;                      /* [2 * n_edges] column of the U-turn at a half-edge, else 0 */
} crash;

static thr_status crash_init(crash *k, const thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  size_t most = 1, turns;
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if ((size_t)thr_degree(turning_columns->f, v) > most)
      most = (size_t)thr_degree(turning_columns->f, v);
  turns = most * most;
  *k = (crash){.r = relax};
  k->m.start = thr_scratch_array(&k->m.own, turns + 1, sizeof *k->m.start);
  k->m.row = thr_scratch_array(&k->m.own, 2 * turns, sizeof *k->m.row);
  k->m.value = thr_scratch_array(&k->m.own, 2 * turns, sizeof *k->m.value);
  k->m.cost = thr_scratch_array(&k->m.own, turns, sizeof *k->m.cost);
  k->m.rhs = thr_scratch_array(&k->m.own, most, sizeof *k->m.rhs);
  k->row_basic =
      thr_scratch_array(&k->m.own, (size_t)thr_lp_rows(relax->search.lp), sizeof *k->row_basic);
  k->column_basic = thr_scratch_array(&k->m.own, (size_t)relax->n_all, sizeof *k->column_basic);
  k->back = thr_scratch_array(&k->m.own, 2 * (size_t)turning_columns->f->n_edges, sizeof *k->back);
  if (thr_scratch_check(&k->m.own, err)) return THR_ENOMEM;
  for (int j = turning_columns->first_back; j < turning_columns->n_columns; j++)
    k->back[turning_columns->half[j][0]] = j;
  return THR_OK;
}

/* The cheapest turns at node v without extra passes and ends: what is basic there is basic in the
 * whole. */
static thr_status crash_node(crash *k, int v, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *turning_columns = k->r->c;
  const int *half = turning_columns->f->half + turning_columns->f->first[v];
  int d = thr_degree(turning_columns->f, v), n = d == 1 ? 1 : d * (d - 1) / 2,
      first = d == 1 ? k->back[half[0]] : turning_columns->pair_first[v];
  thr_lp *lp;
  thr_lp_outcome outcome = THR_LP_OPTIMAL;
  k->m.n = 0;
  for (int j = 0; j < n; j++) {
    int a = turning_columns->half[first + j][0], b = turning_columns->half[first + j][1];
    k->m.start[j] = k->m.n;
    k->m.cost[j] = ldexp((double)turning_columns->weight[first + j], -THR_TURNING_BITS);
    put(&k->m, turning_columns->position[a], a == b ? 2 : 1);
    if (a != b) put(&k->m, turning_columns->position[b], 1);
  }
  k->m.start[n] = k->m.n;
  for (int i = 0; i < d; i++)
    k->m.rhs[i] = turning_columns->cover[half[i] >> 1];
  thr_status st = thr_lp_create_equations(&lp, d, k->m.rhs, n, k->m.cost, NULL, k->m.start,
                                          k->m.row, k->m.value, err);
  if (!st) st = thr_lp_solve(lp, limits, &outcome, err);
  for (int i = 0; i < d && !st; i++)
    k->row_basic[half[i]] = thr_lp_row_basic(lp, i);
  for (int j = 0; j < n && !st; j++)
    k->column_basic[first + j] = thr_lp_column_basic(lp, j);
  thr_lp_destroy(lp);
  return st;
}

thr_status thr_relax_crash(thr_relax *relax, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges;
  crash k;
  thr_status st = crash_init(&k, relax, err);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    if (thr_degree(turning_columns->f, v) == 1 && turning_columns->task->tube)
      k.column_basic[turning_columns
                         ->end_column[turning_columns->f->half[turning_columns->f->first[v]]]] =
          true; /* all that can be there */
    else if (thr_degree(turning_columns->f, v) > 0)
      st = crash_node(&k, v, limits, err);
  for (int i = darts; !st && i < thr_lp_rows(relax->search.lp); i++)
    if (i < darts + turning_columns->n_ends && turning_columns->task->end_allowed)
      k.column_basic[turning_columns->n_columns + 2 * i + 1] =
          true; /* no ends yet: the artificial column makes up for them */
    else
      k.row_basic[i] = true;
  if (!st) st = thr_lp_set_basis(relax->search.lp, k.row_basic, k.column_basic, err);
  relax->search.bare = true;
  thr_scratch_free(&k.m.own);
  return st;
}
