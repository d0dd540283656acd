/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the relaxation without its turns, for the shortest passes with tube joints, where turns
 * cost nothing.
 *
 * What the turns at a node v with d edges demand of passes and ends is then a projection, a few
 * rows per node (tortuosity/tie/tie.h): passes - ends >= 2 (d - 1), or 0 if d = 1; for every edge e
 * at v, passes less ends of the other edges >= passes less ends of e; and passes less ends of e >=
 * 1 if d > 1. Sets of nodes with an odd number of covers are odd sets as before. relax.c calls
 * these functions for tasks with free turns.
 *
 * Example: three edges meet at a node and are passed once each: 3 < 2 (3 - 1), so one of them gets
 * an extra pass. */
#include "tortuosity/proof/relax_parts.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>

/* Puts passes less ends of half-edge h, times sign, into the draft of a row. Returns what the
 * passes that every plan has contribute to it. */
static int put_half(thr_relax *relax, int h, int sign)
{
  const thr_turning_columns *turning_columns = relax->c;
  thr_pool_put(&relax->search.pool, h >> 1, sign);
  if (turning_columns->end_column[h] >= 0)
    thr_pool_put(&relax->search.pool, turning_columns->end_column[h] - turning_columns->first_extra,
                 -sign);
  return sign * turning_columns->cover[h >> 1];
}

/* Puts the row of this kind and index into the draft. Returns its right side. The rows of a node
 * (SUM, SIDE) are sums over its half-edges, those of the ends (LEAST, MOST) over the ends of a
 * group. */
static int put_row(thr_relax *relax, thr_relax_kind kind, int k)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  /* The node whose half-edges the row sums up, or -1. */
  int v = kind == THR_RELAX_SUM    ? k
          : kind == THR_RELAX_SIDE ? thr_tail(frame, k)
                                   : -1,
      sign = kind == THR_RELAX_MOST ? -1 : 1;

  /* A node's row; in a SIDE row half-edge k stands on the other side. */
  int lower = kind == THR_RELAX_SUM ? 2 * (thr_degree(frame, v) - 1) : kind == THR_RELAX_USE;
  for (int i = v < 0 ? 0 : frame->first[v]; v >= 0 && i < frame->first[v + 1]; i++)
    lower -=
        put_half(relax, frame->half[i], kind == THR_RELAX_SIDE && frame->half[i] == k ? -1 : 1);

  if (kind == THR_RELAX_USE) lower -= put_half(relax, k, 1);

  /* A row of the number of ends. */
  if (kind != THR_RELAX_LEAST && kind != THR_RELAX_MOST) return lower;
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++)
    if (turning_columns->end_group[thr_tail(frame, turning_columns->half[j][0])] == k)
      thr_pool_put(&relax->search.pool, j - turning_columns->first_extra, sign);
  return sign * turning_columns->supply[k][kind == THR_RELAX_MOST];
}

/* Adds the row of this kind and index to the pool. */
static thr_status add_row(thr_relax *relax, thr_relax_kind kind, int k, thr_err *err)
{
  int lower = put_row(relax, kind, k);
  return thr_pool_add(&relax->search.pool, (thr_row){.kind = (int)kind, .index = k, .lower = lower},
                      err);
}

/* Adds the row of this kind and index to the pool if x violates it. */
static thr_status offer_row(thr_relax *relax, thr_relax_kind kind, int k, int *added, thr_err *err)
{
  const double tolerance = 1e-6, *x = relax->x + relax->c->first_extra;
  int lower = put_row(relax, kind, k);
  return thr_pool_offer(&relax->search.pool,
                        (thr_row){.kind = (int)kind, .index = k, .lower = lower}, x, tolerance,
                        added, err);
}

/* Adds the rows to begin with: of every node, and of the edges at nodes with no more than two. Rows
 * of the ends come later: what ends cost is known only from the other rows, and until then the
 * simplex method would try them one after the other. */
static thr_status first_rows(thr_relax *relax, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  thr_status st = THR_OK;
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    st = add_row(relax, THR_RELAX_SUM, v, err);
    for (int i = frame->first[v]; i < frame->first[v + 1] && thr_degree(frame, v) <= 2 && !st; i++)
      st = add_row(relax, THR_RELAX_SIDE, frame->half[i], err);
  }
  return st;
}

/* Makes the programme of extra passes and ends, with one artificial column of cost penalty, and the
 * first rows. */
thr_status thr_project_create(thr_relax *relax, double penalty, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int n = turning_columns->first_back - turning_columns->first_extra + 1;
  double *cost = thr_calloc((size_t)n, sizeof *cost);
  if (!cost) return thr_nomem(err);

  for (int j = 0; j + 1 < n; j++)
    cost[j] =
        ldexp((double)turning_columns->weight[turning_columns->first_extra + j], -THR_TURNING_BITS);
  cost[n - 1] = penalty;

  thr_status st = thr_lp_create(&relax->search.lp, n, cost, NULL, err);
  free(cost);
  return st ? st : first_rows(relax, err);
}

/* Makes the graph in which odd sets are looked for. Its nodes are the framework's nodes and the
 * groups of ends; its edges are the columns from first_extra on: an extra pass joins the ends of
 * its edge, a cord end joins its node and its group. */
thr_status thr_project_graph(thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  int n = frame->n_nodes + turning_columns->n_ends,
      m = turning_columns->first_back - turning_columns->first_extra;
  int(*edge)[2] = thr_calloc((size_t)m, sizeof *edge);
  bool *odd = thr_calloc((size_t)n, sizeof *odd);
  relax->problem =
      (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .odd = odd};
  if (!edge || !odd) return thr_nomem(err);

  /* A node is odd if its covers have an odd sum. */
  for (int e = 0; e < frame->n_edges; e++)
    for (int side = 0; side < 2; side++) {
      edge[e][side] = frame->edge[e][side];
      if (turning_columns->cover[e] % 2) odd[frame->edge[e][side]] = !odd[frame->edge[e][side]];
    }

  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++) {
    int v = thr_tail(frame, turning_columns->half[j][0]);
    edge[j - turning_columns->first_extra][0] = v;
    edge[j - turning_columns->first_extra][1] = frame->n_nodes + turning_columns->end_group[v];
  }

  /* A group is odd if it has an odd number of ends. */
  for (int k = 0; k < turning_columns->n_ends; k++)
    odd[frame->n_nodes + k] = turning_columns->supply[k][0] % 2;
  for (int v = 0; v < n; v++)
    relax->any_odd |= odd[v];
  return thr_oddcut_graph_init(&relax->graph, &relax->problem, err);
}

/* ---- separation ---- */

/* Offers the rows of single edges: the sides at nodes of more than two edges, and the uses where an
 * end is allowed. */
thr_status thr_project_sides(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  const thr_frame *frame = relax->c->f;
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * frame->n_edges && !st; h++) {
    int d = thr_degree(frame, thr_tail(frame, h));
    if (d > 2) st = offer_row(relax, THR_RELAX_SIDE, h, added, err);
    if (!st && d > 1 && relax->c->end_column[h] >= 0)
      st = offer_row(relax, THR_RELAX_USE, h, added, err);
  }
  return st;
}

/* Offers the rows of the least and the largest number of ends of every group. */
thr_status thr_project_ends(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  thr_status st = THR_OK;
  for (int k = 0; k < relax->c->n_ends && relax->c->task->end_allowed && !st; k++) {
    st = offer_row(relax, THR_RELAX_LEAST, k, added, err);
    if (!st) st = offer_row(relax, THR_RELAX_MOST, k, added, err);
  }
  return st;
}

/* ---- multipliers ---- */

/* Appends the junction that divides the edges at node v into half-edge h and all others, or into
 * single edges (h < 0). */
static thr_status add_junction(const thr_turning_columns *turning_columns, thr_turning_dual *dual,
                               int v, int h, int64_t value, thr_err *err)
{
  int degree = thr_degree(turning_columns->f, v);
  if (degree < 2) return THR_OK;
  thr_turning_junction *to = &dual->junction[dual->n_junctions];
  *to = (thr_turning_junction){v, thr_calloc((size_t)degree, sizeof *to->block), value};
  if (!to->block) return thr_nomem(err);
  for (int i = 0; i < degree; i++)

    to->block[i] = h < 0 ? i : i == turning_columns->position[h];
  dual->n_junctions++;
  return THR_OK;
}

/* Appends the odd set of a row: all half-edges of its nodes, and the groups of ends in it. */
static thr_status add_set(const thr_relax *relax, thr_turning_dual *dual, const thr_row *row,
                          int64_t value, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  bool *in = thr_calloc((size_t)relax->problem.n_nodes, sizeof *in);
  thr_turning_set *to = &dual->odd[dual->n_odd++];
  int n = 0;
  *to = (thr_turning_set){.value = value};
  if (!in) return thr_nomem(err);

  /* Mark the nodes, and count the members. */
  for (int i = 0; i < row->n_members; i++) {
    in[row->member[i]] = true;
    n += row->member[i] < frame->n_nodes ? thr_degree(frame, row->member[i]) : 1;
  }

  /* Half-edges first, then groups, so that members ascend. */
  to->member = thr_calloc((size_t)n, sizeof *to->member);
  for (int h = 0; to->member && h < 2 * frame->n_edges; h++)
    if (in[thr_tail(frame, h)]) to->member[to->n++] = h;
  for (int k = 0; to->member && k < relax->c->n_ends; k++)
    if (in[frame->n_nodes + k]) to->member[to->n++] = 2 * frame->n_edges + k;

  free(in);
  return to->member ? THR_OK : thr_nomem(err);
}

/* Adds a row's multiplier to the dual of the whole model. A node's row is a sum of its half-edges'
 * equations and a multiple of a junction, so its multiplier is spread over these. */
static thr_status add_multiplier(const thr_relax *relax, thr_turning_dual *dual, const thr_row *row,
                                 int64_t value, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  int k = row->index, v;

  switch (row->kind) {
  case THR_RELAX_LEAST: dual->ends[k] += value; return THR_OK;
  case THR_RELAX_MOST: dual->ends[k] -= value; return THR_OK;
  case THR_RELAX_ODD: return add_set(relax, dual, row, value, err);
  case THR_RELAX_USE:
    dual->potential[k] -= value;
    return add_junction(turning_columns, dual, thr_tail(frame, k), k, value, err);
  default: break;
  }

  /* Rows of a node: potentials of its half-edges and, for SUM, twice the junction of single edges,
   * from which the 2 (d - 1) of the row comes. */
  v = row->kind == THR_RELAX_SUM ? k : thr_tail(frame, k);
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    dual->potential[frame->half[i]] -=
        row->kind == THR_RELAX_SIDE && frame->half[i] == k ? -value : value;
  return row->kind == THR_RELAX_SUM ? add_junction(turning_columns, dual, v, -1, 2 * value, err)
                                    : THR_OK;
}

/* Makes the multipliers of the last solve, as integers, multipliers of the whole model. On failure
 * dual is empty. */
thr_status thr_project_dual(const thr_relax *relax, thr_turning_dual *dual, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  thr_status st = thr_turning_dual_init(dual, turning_columns, err);
  if (st) return st;

  dual->odd = thr_calloc((size_t)relax->search.pool.count, sizeof *dual->odd);
  dual->junction = thr_calloc((size_t)relax->search.pool.count, sizeof *dual->junction);
  if (!dual->odd || !dual->junction) st = thr_nomem(err);

  /* Mark the nodes, and count the members. */

  for (int i = 0; i < relax->search.pool.count && !st; i++)
    if (thr_relax_whole(relax->search.dual[i]) > 0)
      st = add_multiplier(relax, dual, &relax->search.pool.row[i],
                          thr_relax_whole(relax->search.dual[i]), err);
  if (st) thr_turning_dual_destroy(dual);
  return st;
}
