/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords from passes and ends: pairings at the nodes, chosen so that all passes of a component hang
 * together.
 *
 * Bouchet's greedy (Greedy algorithm and symmetric matroids, Math. Programming 38, 1987): nodes in
 * order of regret, each with the cheapest pairing that can still be completed; then exchanges join
 * what is left apart.
 *
 * Example: at a crossing of two circuits the straight pairing leaves two; if nothing else joins
 * them, the next cheapest is taken there. */
#include "tortuosity/cords/join.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the multigraph ---- */

/* pair[i]: node of the i-th cord end and the end node of its component; returns how many. */
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
  int n = ends ? list_ends(turning_columns, ends, NULL) : 0,
      (*pair)[2] = thr_calloc((size_t)n, sizeof *pair);
  if (!pair) return thr_nomem(err);
  if (ends) list_ends(turning_columns, ends, pair);
  thr_status st = thr_multigraph_init(&j->g, frame, turning_columns->n_components, passes,
                                      (const int(*)[2])pair, n, err);
  if (!st && !(j->mate = thr_calloc((size_t)j->g.n_darts, sizeof *j->mate))) st = thr_nomem(err);
  for (int d = 0; d < j->g.n_darts && !st; d++)
    j->mate[d] = -1;
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if ((j->g.first[v + 1] - j->g.first[v]) % 2)
      st =
          thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends", frame->name[v]);
  free(pair);
  if (st) thr_join_destroy(j);
  return st;
}

bool thr_join_open(const thr_join *j, int component)
{
  const int *first = j->g.first + j->c->f->n_nodes + component;
  return first[1] > first[0];
}

int thr_join_count(const thr_join *j)
{
  const int *first = j->g.first + j->c->f->n_nodes;
  int n = 0;
  for (int k = 0; k < j->c->n_components; k++)
    n += thr_join_open(j, k)       ? (first[k + 1] - first[k]) / 2
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
  int ha = j->g.half[a], hb = j->g.half[b];
  if (ha < 0 || hb < 0) return ha == hb ? thr_join_forbidden : 0;
  if (ha != hb)
    return (double)j->c->weight[thr_turning_column(j->c, ha, hb)] *
           0x1p-44; /* 2^-THR_TURNING_BITS */
  return thr_degree(j->c->f, j->g.tail[a]) == 1
             ? thr_turn_price(j->c->f, j->c->task->cost, ha ^ 1, ha)
             : thr_join_forbidden;
}

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

/* ---- pairs as given ---- */

/* Free darts by half-edge: the next one of each is taken off its list. */
typedef struct {
  int *head;      /* [2 * n_edges] first free dart of a half-edge, -1 = none */
  int *next;      /* [n_darts] */
  int *end_first; /* [n_nodes] first free virtual dart */
} stock;

static int take(int *head, const int *next)
{
  int d = *head;
  if (d >= 0) *head = next[d];
  return d;
}

static void pair_columns(thr_join *j, const int *x, stock *s)
{
  const thr_turning_columns *turning_columns = j->c;
  for (int k = 0; k < turning_columns->n_columns; k++) {
    if (k >= turning_columns->first_extra && k < turning_columns->first_end) continue;
    for (int i = 0; i < x[k]; i++) {
      int half_a = turning_columns->half[k][0], half_b = turning_columns->half[k][1];
      int a = take(&s->head[half_a], s->next);
      int b =
          take(half_b >= 0 ? &s->head[half_b] : &s->end_first[thr_tail(turning_columns->f, half_a)],
               s->next);
      if (a >= 0 && b >= 0) thr_set_pair(j->mate, a, b);
    }
  }
}

/* The open cords of a component are one set, and every closed one is its own: joins them over equal
 * passes. Is a component one set then? first: [n_components] scratch. */
static bool join_all(thr_join *j, const int *cord, int n_cords, int *parent, int *first)
{
  const thr_turning_columns *turning_columns = j->c;
  bool single = true;
  for (int i = 0; i < n_cords; i++)
    parent[i] = i;
  for (int k = 0; k < turning_columns->n_components; k++)
    first[k] = -1;
  for (int d = j->g.n_darts - 1; d >= 0; d--) {
    int v = j->g.tail[d];
    if (v >= turning_columns->f->n_nodes) continue;
    int *f = &first[turning_columns->component[v]];
    if (*f < 0)
      *f = cord[d];
    else if (j->g.half[d] < 0) /* virtual ones have the highest numbers */
      thr_disjoint_join(parent, *f, cord[d]);
  }
  thr_transition_join_equal(&j->g, cord, parent, j->mate);
  for (int d = 0; d < j->g.n_darts && single; d++)
    if (j->g.tail[d] < turning_columns->f->n_nodes)
      single = thr_disjoint_find(parent, cord[d]) ==
               thr_disjoint_find(parent, first[turning_columns->component[j->g.tail[d]]]);
  return single;
}

thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err)
{
  const thr_frame *frame = j->c->f;
  size_t darts = (size_t)j->g.n_darts;
  stock s = {thr_calloc(2 * (size_t)frame->n_edges, sizeof *s.head),
             thr_calloc(darts, sizeof *s.next),
             thr_calloc((size_t)frame->n_nodes, sizeof *s.end_first)};
  int *cord = thr_calloc(darts, sizeof *cord), *parent = thr_calloc(darts, sizeof *parent);
  int *first = thr_calloc((size_t)j->c->n_components, sizeof *first);
  thr_status st =
      s.head && s.next && s.end_first && cord && parent && first ? THR_OK : thr_nomem(err);
  *single = false;
  if (!st) {
    for (int h = 0; h < 2 * frame->n_edges; h++)
      s.head[h] = -1;
    for (int v = 0; v < frame->n_nodes; v++)
      s.end_first[v] = -1;
    for (int d = j->g.n_darts - 1; d >= 0; d--) {
      if (j->g.tail[d] >= frame->n_nodes) continue;
      int *head = j->g.half[d] >= 0 ? &s.head[j->g.half[d]] : &s.end_first[j->g.tail[d]];
      s.next[d] = *head;
      *head = d;
    }
    pair_columns(j, x, &s);
    for (int d = 0; d < j->g.n_darts && !st; d++)
      if (j->mate[d] < 0 && j->g.tail[d] < frame->n_nodes)
        st = thr_fail(err, THR_ESOLVER, "turns do not fit the passes");
  }
  if (!st) {
    *single = join_all(j, cord, thr_threading_label(&j->g, j->mate, cord), parent, first);
    thr_join_measure(j);
  }
  free(s.head);
  free(s.next);
  free(s.end_first);
  free(cord);
  free(parent);
  free(first);
  return st;
}

void thr_join_point(const thr_join *j, int *x)
{
  const thr_turning_columns *c = j->c;
  memset(x, 0, (size_t)c->n_columns * sizeof *x);
  for (int e = 0; e < c->f->n_edges; e++)
    x[c->first_extra + e] = -c->cover[e];
  for (int d = 0; d < j->g.n_darts; d++) {
    const int mate = j->mate[d], a = j->g.half[d], b = mate < 0 ? -1 : j->g.half[mate];
    if (a < 0) continue; /* virtual ones have the highest numbers */
    x[c->first_extra + (a >> 1)] += d % 2;
    if (mate < d) continue;
    if (b < 0)
      x[c->end_column[a]]++;
    else if (a != b)
      x[thr_turning_column(c, a, b)]++;
    else
      for (int k = c->first_back; k < c->n_columns; k++)
        x[k] += c->half[k][0] == a;
  }
}

/* ---- tied ---- */

thr_status thr_join_tie(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, bool *found, thr_err *err)
{
  bool single;
  int *x = thr_calloc((size_t)turning_columns->n_columns, sizeof *x);
  *j = (thr_join){0};
  thr_status st = x ? thr_tie_pair(turning_columns, passes, ends, x, found, err) : thr_nomem(err);
  if (!st && *found) st = thr_join_init(j, turning_columns, passes, ends, err);
  if (!st && *found) st = thr_join_columns(j, x, &single, err);
  if (st) thr_join_destroy(j);
  free(x);
  return st;
}

/* ---- from cords ---- */

thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *turning_columns,
                               const thr_cord *cord, int n_cords, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  size_t m = (size_t)frame->n_edges, n = (size_t)frame->n_nodes;
  const bool open = turning_columns->task->end_allowed != NULL;
  int *count = thr_calloc(m + n, sizeof *count), *next = thr_calloc(m + n, sizeof *next);
  thr_status st = count && next ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++) {
    for (int k = 0; k < cord[i].n_passes; k++)
      count[cord[i].half[k] >> 1]++;
    if (!open) continue;
    count[m + (size_t)thr_cord_start(frame, &cord[i])]++;
    count[m + (size_t)thr_cord_end(frame, &cord[i])]++;
  }
  if (!st) st = thr_join_init(j, turning_columns, count, count + m, err);
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
