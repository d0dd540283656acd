/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the multigraph of passes and cord ends, and pairs its darts as columns, tied nodes or cords
 * say.
 *
 * Every pass is an edge of the multigraph; a cord end is a virtual edge to one more node, the end
 * node of its component. A pairing says at every node which pass continues into which; cords are
 * what one gets by following the pairs. Passes over one edge are interchangeable, hence a column of
 * value 2 takes any two free passes of each of its edges. That may leave several circuits; two of
 * them that pass one edge are joined, at no price, by exchanging the partners of these passes.
 *
 * Example: one cord twice round a ring, as columns, becomes two circuits or one; the exchange of
 * the two passes of any edge makes one of them. */
#include "tortuosity/cords/join.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>
#include <string.h>

/* ---- the multigraph ---- */

/* Fills pair[i] with the node of the i-th cord end and the end node of its component (pair NULL:
 * no), and returns the number of ends. */
static int list_ends(const thr_turning_columns *turning_columns, const int *ends, int (*pair)[2])
{
  int n = 0;
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    for (int k = 0; k < ends[v]; k++, n++) {
      if (!pair) continue;
      pair[n][0] = v;
      pair[n][1] = turning_columns->f->n_nodes + turning_columns->component[v];
    }
  return n;
}

thr_status thr_join_init(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                         const int *ends, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  *j = (thr_join){.c = turning_columns};

  /* Virtual edges for the ends. */
  int n = ends ? list_ends(turning_columns, ends, NULL) : 0,
      (*pair)[2] = thr_calloc((size_t)n, sizeof *pair);
  if (!pair) return thr_nomem(err);
  if (ends) list_ends(turning_columns, ends, pair);
  thr_status st = thr_multigraph_init(&j->g, frame, turning_columns->n_components, passes,
                                      (const int(*)[2])pair, n, err);
  if (!st && !(j->mate = thr_calloc((size_t)j->g.n_darts, sizeof *j->mate))) st = thr_nomem(err);
  for (int d = 0; d < j->g.n_darts && !st; d++)
    j->mate[d] = -1;

  /* Every node needs an even number of darts to be paired. */
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if ((j->g.first[v + 1] - j->g.first[v]) % 2)
      st =
          thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends", frame->name[v]);
  free(pair);
  if (st) thr_join_destroy(j);
  return st;
}

/* Returns whether a component has cord ends. */
static bool join_open(const thr_join *j, int component)
{
  const int *first = j->g.first + j->c->f->n_nodes + component;
  return first[1] > first[0];
}

int thr_join_count(const thr_join *j)
{
  const int *first = j->g.first + j->c->f->n_nodes;
  int n = 0;

  /* An open cord has two ends. A component without ends under open cords is one closed cord. */
  for (int k = 0; k < j->c->n_components; k++)
    n += join_open(j, k)           ? (first[k + 1] - first[k]) / 2
         : j->c->task->end_allowed ? 1
                                   : j->c->task->cords;
  return n;
}

void thr_join_destroy(thr_join *j)
{
  thr_multigraph_destroy(&j->g);
  free(j->mate);
  *j = (thr_join){0};
}

double thr_join_price(const thr_join *j, int a, int b)
{
  int half_a = j->g.half[a], half_b = j->g.half[b];
  if (half_a < 0 || half_b < 0) return half_a == half_b ? thr_join_forbidden : 0;
  if (half_a != half_b)
    return (double)j->c->weight[thr_turning_column(j->c, half_a, half_b)] *
           0x1p-44; /* 2^-THR_TURNING_BITS */

  /* Two passes of one edge: a U-turn, which only a node with a single edge may have. */
  return thr_degree(j->c->f, j->g.tail[a]) == 1
             ? thr_turn_price(j->c->f, j->c->task->cost, half_a ^ 1, half_a)
             : thr_join_forbidden;
}

/* Computes thr_join_price for a threading. */
static double pair_price(const void *of, int a, int b)
{
  return thr_join_price(of, a, b);
}

thr_status thr_join_threading(thr_join *j, thr_threading *threading, thr_err *err)
{
  return thr_threading_init(threading, j->c->f, &j->g, j->mate, pair_price, j, j->c->task->tube,
                            err);
}

void thr_join_measure(thr_join *j)
{
  j->price = 0;
  for (int d = 0; d < j->g.n_darts; d++)
    if (j->mate[d] > d) j->price += thr_join_price(j, d, j->mate[d]);
}

/* ---- pairs from columns ---- */

/* Darts that have no mate yet, in linked lists by half-edge, or by node for virtual ones. */
typedef struct {
  int *head;      /* [2 * n_edges] first free dart of a half-edge, -1 = none */
  int *next;      /* [n_darts] next free dart of the list */
  int *end_first; /* [n_nodes] first free virtual dart */
} free_darts;

/* Takes the first dart off a list and returns the dart, or -1 if the list is empty. */
static int take(int *head, const int *next)
{
  int d = *head;
  if (d >= 0) *head = next[d];
  return d;
}

/* Pairs free darts as the columns x[n_columns] say; columns of extra passes pair nothing. */
static void pair_columns(thr_join *j, const int *x, free_darts *darts)
{
  const thr_turning_columns *turning_columns = j->c;
  for (int k = 0; k < turning_columns->n_columns; k++) {
    if (k >= turning_columns->first_extra && k < turning_columns->first_end) continue;
    for (int i = 0; i < x[k]; i++) {
      int half_a = turning_columns->half[k][0], half_b = turning_columns->half[k][1];

      /* A pass of the one half-edge, and one of the other or a cord end at their node. */
      int a = take(&darts->head[half_a], darts->next);
      int b = take(half_b >= 0 ? &darts->head[half_b]
                               : &darts->end_first[thr_tail(turning_columns->f, half_a)],
                   darts->next);
      if (a >= 0 && b >= 0) thr_set_pair(j->mate, a, b);
    }
  }
}

/* Joins cords that pass one edge by exchanging partners of their passes, and returns whether every
 * component then is a single closed cord, or open cords alone. cord[n_darts]: the cord that a dart
 * is on. parent: [n_cords] scratch; first: [n_components] scratch. */
static bool join_all(thr_join *j, const int *cord, int n_cords, int *parent, int *first)
{
  const thr_turning_columns *turning_columns = j->c;
  bool single = true;
  for (int i = 0; i < n_cords; i++)
    parent[i] = i;
  for (int k = 0; k < turning_columns->n_components; k++)
    first[k] = -1;

  /* Disjoint sets: the open cords of a component are one set, every closed cord is one of its own.
   */
  for (int d = j->g.n_darts - 1; d >= 0; d--) {
    int v = j->g.tail[d];
    if (v >= turning_columns->f->n_nodes) continue;
    int *first_cord = &first[turning_columns->component[v]];
    if (*first_cord < 0)
      *first_cord = cord[d];
    else if (j->g.half[d] < 0) /* virtual darts have the highest numbers */
      thr_disjoint_join(parent, *first_cord, cord[d]);
  }

  /* Closed cords are joined to each other, or to an open one. */
  thr_transition_join_equal(&j->g, cord, parent, j->mate);

  /* A component is one set if all of its darts are in the set of its first cord. */
  for (int d = 0; d < j->g.n_darts && single; d++)
    if (j->g.tail[d] < turning_columns->f->n_nodes)
      single = thr_disjoint_find(parent, cord[d]) ==
               thr_disjoint_find(parent, first[turning_columns->component[j->g.tail[d]]]);
  return single;
}

thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err)
{
  const thr_frame *frame = j->c->f;
  size_t n_darts = (size_t)j->g.n_darts;
  free_darts darts = {thr_calloc(2 * (size_t)frame->n_edges, sizeof *darts.head),
                      thr_calloc(n_darts, sizeof *darts.next),
                      thr_calloc((size_t)frame->n_nodes, sizeof *darts.end_first)};
  int *cord = thr_calloc(n_darts, sizeof *cord), *parent = thr_calloc(n_darts, sizeof *parent);
  int *first = thr_calloc((size_t)j->c->n_components, sizeof *first);
  thr_status st = darts.head && darts.next && darts.end_first && cord && parent && first
                      ? THR_OK
                      : thr_nomem(err);
  *single = false;

  /* List all darts as free, so that each list is ascending. */
  if (!st) {
    for (int h = 0; h < 2 * frame->n_edges; h++)
      darts.head[h] = -1;
    for (int v = 0; v < frame->n_nodes; v++)
      darts.end_first[v] = -1;
    for (int d = j->g.n_darts - 1; d >= 0; d--) {
      if (j->g.tail[d] >= frame->n_nodes) continue;
      int *head = j->g.half[d] >= 0 ? &darts.head[j->g.half[d]] : &darts.end_first[j->g.tail[d]];
      darts.next[d] = *head;
      *head = d;
    }

    /* Pair them; all must have found a mate. */
    pair_columns(j, x, &darts);
    for (int d = 0; d < j->g.n_darts && !st; d++)
      if (j->mate[d] < 0 && j->g.tail[d] < frame->n_nodes)
        st = thr_fail(err, THR_ESOLVER, "turns do not fit the passes");
  }

  /* Join circuits where that is free. */
  if (!st) {
    *single = join_all(j, cord, thr_threading_label(&j->g, j->mate, cord), parent, first);
    thr_join_measure(j);
  }

  free(darts.head);
  free(darts.next);
  free(darts.end_first);
  free(cord);
  free(parent);
  free(first);
  return st;
}

void thr_join_point(const thr_join *j, int *x)
{
  const thr_turning_columns *columns = j->c;
  memset(x, 0, (size_t)columns->n_columns * sizeof *x);

  /* Extra passes are all passes less the cover. */
  for (int e = 0; e < columns->f->n_edges; e++)
    x[columns->first_extra + e] = -columns->cover[e];
  for (int d = 0; d < j->g.n_darts; d++) {
    const int mate = j->mate[d], a = j->g.half[d], b = mate < 0 ? -1 : j->g.half[mate];
    if (a < 0) continue;                         /* virtual darts have the highest numbers */
    x[columns->first_extra + (a >> 1)] += d % 2; /* one dart of each pass is counted */
    if (mate < d) continue;                      /* so is one of each pair */

    /* An end, a turn, or a U-turn at a node with one edge. */
    if (b < 0)
      x[columns->end_column[a]]++;
    else if (a != b)
      x[thr_turning_column(columns, a, b)]++;
    else
      for (int k = columns->first_back; k < columns->n_columns; k++)
        x[k] += columns->half[k][0] == a;
  }
}

/* ---- pairs that tie every node ---- */

thr_status thr_join_tie(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, bool *found, thr_err *err)
{
  bool single;
  int *x = thr_calloc((size_t)turning_columns->n_columns, sizeof *x);
  *j = (thr_join){0};

  /* Columns whose turns tie every node, then pairs from them. */
  thr_status st = x ? thr_tie_pair(turning_columns, passes, ends, x, found, err) : thr_nomem(err);
  if (!st && *found) st = thr_join_init(j, turning_columns, passes, ends, err);
  if (!st && *found) st = thr_join_columns(j, x, &single, err);
  if (st) thr_join_destroy(j);
  free(x);
  return st;
}

/* ---- pairs from cords ---- */

thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *turning_columns,
                               const thr_cord *cord, int n_cords, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  size_t n_edges = (size_t)frame->n_edges, n_nodes = (size_t)frame->n_nodes;
  const bool open = turning_columns->task->end_allowed != NULL;
  int *count = thr_calloc(n_edges + n_nodes, sizeof *count),
      *next = thr_calloc(n_edges + n_nodes, sizeof *next);
  thr_status st = count && next ? THR_OK : thr_nomem(err);

  /* Count the passes of every edge and, behind them, the ends at every node. */
  for (int i = 0; i < n_cords && !st; i++) {
    for (int k = 0; k < cord[i].n_passes; k++)
      count[cord[i].half[k] >> 1]++;
    if (!open) continue;
    count[n_edges + (size_t)thr_cord_start(frame, &cord[i])]++;
    count[n_edges + (size_t)thr_cord_end(frame, &cord[i])]++;
  }
  if (!st) st = thr_join_init(j, turning_columns, count, count + n_edges, err);

  /* Pair the darts along each cord; next: the copy of an edge, or of an end, to be used next. */
  if (!st) {
    thr_transition_copies(frame, &j->g, next);
    for (int i = 0; i < n_cords; i++)
      thr_transition_walk(frame, &j->g, cord[i].half, cord[i].n_passes, open, next, j->mate);
    thr_join_measure(j);
  }

  free(count);
  free(next);
  return st;
}
