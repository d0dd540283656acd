/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says for which passes and ends every node can be tied with tube joints
 * (graph/plan/plan_measures.h), and computes the turns that tie it. Internal to tortuosity/.
 *
 * Which passes can be tied. At a node with d >= 2 edges let e have m_e passes of which t_e end
 * there, z = sum t, M = sum m. Turns that tie the edges and never go back are a connected
 * multigraph without loops on them, in which e has m_e - t_e turns. There is one, for some t, if
 * and only if M - z is even and at least 2 (d - 1), and no 2 m_e is more than M + z (S. L. Hakimi,
 * "On realizability of a set of integers as degrees of the vertices of a linear graph", J. SIAM 10,
 * 1962, for the degrees; two parts of which one has a circuit are joined by exchanging two turns).
 * At a node with one edge, m = z.
 *
 * Example: three edges with one pass each, no ends: M = 3 is odd and below 4, so one more pass is
 * needed. */
#include "tortuosity/tie/tie.h"
#include "graph/arrays.h"

#include <stdlib.h>
#include <string.h>

int thr_tie_need(const thr_turning_columns *turning_columns, int v, const int *passes,
                 const int *ends)
{
  const thr_frame *frame = turning_columns->f;
  int n_ends = ends ? ends[v] : 0, sum = 0, most = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int n_passes = passes[frame->half[i] >> 1];
    sum += n_passes;
    if (n_passes > most) most = n_passes;
  }

  int few = 2 * (thr_degree(frame, v) - 1) + n_ends - sum, many = 2 * most - sum - n_ends,
      need = few > many ? few : many;

  return need > 0 ? need : (sum + n_ends) % 2;
}

/* Fails if the edges at a node have too little room for the passes that tie them. */
static thr_status check_room(const thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  for (int v = 0; v < frame->n_nodes; v++) {
    int64_t room = 0,
            needed = 2 * (thr_degree(frame, v) - 1) +
                     (turning_columns->task->end_count ? turning_columns->task->end_count[v] : 0);

    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      room += turning_columns->most[frame->half[i] >> 1];

    if (room < needed)
      return thr_fail(
          err, THR_EINFEASIBLE,
          "node %s: its edges have room for %d passes, but tying them together takes %d",
          frame->name[v], (int)room, (int)needed);
  }
  return THR_OK;
}

thr_status thr_tie_possible(const thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  int *loose = thr_calloc((size_t)turning_columns->n_ends,
                          sizeof *loose); /* passes that end at nodes with one edge, by equation */
  if (!loose) return thr_nomem(err);

  /* At a node with one edge every pass ends. */
  thr_status st = THR_OK;
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_degree(frame, v) == 1)
      loose[turning_columns->end_group[v]] +=
          turning_columns->cover[frame->half[frame->first[v]] >> 1];

  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int k = turning_columns->end_group[v];
    if (thr_degree(frame, v) != 1) continue;

    if (turning_columns->end_column[frame->half[frame->first[v]]] < 0)
      st = thr_fail(
          err, THR_EINFEASIBLE,
          "node %s has one edge only: with tube joints a cord must end there, but none may",
          frame->name[v]);
    else if (loose[k] > turning_columns->supply[k][1])
      st = thr_fail(err, THR_EINFEASIBLE,
                    "nodes with one edge only, such as %s, take %d ends with tube joints, but "
                    "there are no more than %d in their "
                    "component; ask for more --cords",
                    frame->name[v], loose[k], turning_columns->supply[k][1]);
  }

  free(loose);
  return st ? st : check_room(turning_columns, err);
}

thr_status thr_tie_holds(const thr_turning_columns *turning_columns, const int *x, bool *tied,
                         thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  int *parent = thr_calloc(2 * (size_t)frame->n_edges, sizeof *parent), apart = 0;
  if (!parent) return thr_nomem(err);

  /* Half-edges are parts of their own; the turns join them. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    parent[h] = h;
  for (int v = 0; v < frame->n_nodes; v++)
    apart += thr_degree(frame, v) - 1;

  /* Every turn may join two parts; all nodes are tied when no parts are apart. */
  for (int j = 0; j < turning_columns->first_extra; j++)
    if (x[j] > 0)
      apart -= thr_disjoint_join(parent, turning_columns->half[j][0], turning_columns->half[j][1]);

  *tied = apart == 0;
  free(parent);
  return THR_OK;
}

/* Says whether there are as many ends as there must be, at nodes where they may be (*fit). */
static thr_status count_ends(const thr_turning_columns *turning_columns, const int *ends, bool *fit,
                             thr_err *err)
{
  int *sum = thr_calloc((size_t)turning_columns->n_ends, sizeof *sum);
  if (!sum) return thr_nomem(err);
  *fit = true;

  /* Ends at nodes where none are allowed do not fit. */
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    int n = ends ? ends[v] : 0;
    sum[turning_columns->end_group[v]] += n;
    *fit &=
        n == 0 ||
        turning_columns->end_column[turning_columns->f->half[turning_columns->f->first[v]]] >= 0;
  }

  /* Neither does a component with too few or too many of them. */
  for (int k = 0; k < turning_columns->n_ends; k++)
    *fit &= sum[k] >= turning_columns->supply[k][0] && sum[k] <= turning_columns->supply[k][1];
  free(sum);
  return THR_OK;
}

/* ---- all nodes ---- */

/* Returns the number of passes and ends at node v. */
static int count_knot(const thr_turning_columns *turning_columns, int v, const int *passes,
                      const int *ends)
{
  const thr_frame *frame = turning_columns->f;
  int n = ends ? ends[v] : 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    n += passes[frame->half[i] >> 1];
  return n;
}

/* Adds the pairs of the node that was tied last to the columns x. */
static void count_turns(const thr_knot *knot, int *column)
{
  const int *half = knot->c->f->half + knot->c->f->first[knot->at];
  for (int i = 0; i < knot->n; i++) {
    int a = knot->pair[i].a, b = knot->pair[i].b;
    if (a == knot->d || b == knot->d)
      column[knot->c->end_column[half[a == knot->d ? b : a]]]++;
    else
      column[thr_turning_column(knot->c, half[a], half[b])]++;
  }
}

thr_status thr_tie_pair(const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, int *x, bool *found, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  thr_knot knot = {0};
  int most = 0;

  /* Can all nodes be tied, and how many passes are there at most? */
  thr_status st = count_ends(turning_columns, ends, found, err);
  for (int v = 0; v < frame->n_nodes && !st && *found; v++) {
    int n = count_knot(turning_columns, v, passes, ends);
    if (n > most) most = n;
    *found = thr_tie_need(turning_columns, v, passes, ends) == 0;
  }
  if (st || !*found) return st;

  /* All turns, ends and U-turns begin at 0; extra passes stay as they are. */
  memset(x, 0, (size_t)turning_columns->first_extra * sizeof *x);
  memset(x + turning_columns->first_end, 0,
         (size_t)(turning_columns->n_columns - turning_columns->first_end) * sizeof *x);

  /* Tie node by node. */
  st = thr_knot_init(&knot, turning_columns, most, err);
  for (int v = 0; v < frame->n_nodes && !st && *found; v++) {
    *found = thr_knot_tie(&knot, v, passes, ends);
    if (*found) count_turns(&knot, x);
  }
  thr_knot_destroy(&knot);
  return st;
}
