/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Folds that outnumber the ends they could be led to: a flow. */
#include "graph/scratch.h"
#include "symmetry/cover/cover.h"

#include <math.h>

static const double least_flow = 1e-6;

/* Flows from folds to ends. Nodes: 2 * d the copies' side of dart type d, 2 * d + 1 the turns'
 * side. */
typedef struct {
  int n, m;
  int (*edge)[2];
  double *capacity, *flow;        /* [m] flow from edge[e][0] to edge[e][1] */
  double *supply, *demand, *used; /* [n] left; of copies at a dart type */
  int *first, *incident;          /* as in lp/tjoin/oddcut.c */
  int *queue, *arrived;           /* [n] edge by which a node was reached, -1 = not, m = a source */
  thr_scratch own;                /* the arrays */
} network;

static thr_status network_init(network *w, const thr_programme *p, thr_err *err)
{
  int darts = p->q->n_darts;
  size_t n = 2 * (size_t)darts, m = (size_t)p->first_end + (size_t)darts;
  w->n = 2 * darts;
  w->edge = thr_scratch_array(&w->own, m, sizeof *w->edge);
  w->capacity = thr_scratch_array(&w->own, m, sizeof *w->capacity);
  w->flow = thr_scratch_array(&w->own, m, sizeof *w->flow);
  w->supply = thr_scratch_array(&w->own, n, sizeof *w->supply);
  w->demand = thr_scratch_array(&w->own, n, sizeof *w->demand);
  w->used = thr_scratch_array(&w->own, n, sizeof *w->used);
  w->first = thr_scratch_array(&w->own, n + 2, sizeof *w->first);
  w->incident = thr_scratch_array(&w->own, 2 * m, sizeof *w->incident);
  w->queue = thr_scratch_array(&w->own, n, sizeof *w->queue);
  w->arrived = thr_scratch_array(&w->own, n, sizeof *w->arrived);
  return thr_scratch_check(&w->own, err);
}

static void network_fill(network *w, const thr_programme *p, const double *value)
{
  for (int j = 0; j < p->first_circle; j++) {
    int side = j >= p->first_pair, a = 2 * p->join[j][0] + side;
    if (value[j] < least_flow) continue;
    if (j >= p->first_end)
      w->demand[a] += value[j];
    else if (thr_programme_terminal(p, j))
      w->supply[a] += value[j];
    else {
      w->edge[w->m][0] = a;
      w->edge[w->m][1] = 2 * p->join[j][1] + side;
      w->capacity[w->m++] = value[j];
    }
    if (side) continue;
    for (int i = 0; i < 2; i++) /* each copy leads over to the turns */
      if (p->join[j][i] < p->q->n_darts) w->used[p->join[j][i]] += value[j];
  }
  for (int d = 0; d < p->q->n_darts; d++)
    if (w->used[d] > 0) {
      w->edge[w->m][0] = 2 * d;
      w->edge[w->m][1] = 2 * d + 1;
      w->capacity[w->m++] = w->used[d];
    }
  for (int e = 0; e < w->m; e++)
    for (int i = 0; i < 2; i++)
      w->first[w->edge[e][i] + 2]++;
  for (int v = 1; v <= w->n; v++)
    w->first[v + 1] += w->first[v];
  for (int e = 0; e < w->m; e++)
    for (int i = 0; i < 2; i++)
      w->incident[w->first[w->edge[e][i] + 1]++] = e;
}

static double room(const network *w, int e, int from)
{
  return w->edge[e][0] == from ? w->capacity[e] - w->flow[e] : w->capacity[e] + w->flow[e];
}

/* As much as fits along the path on which v was reached. */
static void push(network *w, int v)
{
  double amount = w->demand[v];
  int source = v;
  while (w->arrived[source] < w->m) {
    int e = w->arrived[source], from = w->edge[e][w->edge[e][1] == source ? 0 : 1];
    amount = fmin(amount, room(w, e, from));
    source = from;
  }
  amount = fmin(amount, w->supply[source]);
  w->supply[source] -= amount;
  w->demand[v] -= amount;
  while (w->arrived[v] < w->m) {
    int e = w->arrived[v], forward = w->edge[e][1] == v;
    w->flow[e] += forward ? amount : -amount;
    v = w->edge[e][!forward];
  }
}

/* More flow along a shortest path (Edmonds & Karp 1972); false if there is none, then arrived marks
 * what the folds left over reach. */
static bool augment(network *w)
{
  int head = 0, tail = 0;
  for (int v = 0; v < w->n; v++) {
    w->arrived[v] = w->supply[v] >= least_flow ? w->m : -1;
    if (w->arrived[v] >= 0) w->queue[tail++] = v;
  }
  while (head < tail) {
    int v = w->queue[head++];
    if (w->demand[v] >= least_flow) {
      push(w, v);
      return true;
    }
    for (int k = w->first[v]; k < w->first[v + 1]; k++) {
      int e = w->incident[k], to = w->edge[e][w->edge[e][0] == v];
      if (w->arrived[to] >= 0 || room(w, e, v) < least_flow) continue;
      w->arrived[to] = e;
      w->queue[tail++] = to;
    }
  }
  return false;
}

thr_status thr_programme_folds(const thr_programme *p, const double *value, bool *copy_side,
                               bool *pair_side, bool *found, thr_err *err)
{
  network w = {0};
  thr_status st = network_init(&w, p, err);
  *found = false;
  if (!st) {
    network_fill(&w, p, value);
    while (augment(&w))
      continue;
    for (int d = 0; d < p->q->n_darts; d++) {
      *found = *found || w.supply[2 * d] >= least_flow || w.supply[2 * d + 1] >= least_flow;
      copy_side[d] = w.arrived[2 * d] >= 0;
      pair_side[d] = w.arrived[2 * d + 1] >= 0;
    }
  }
  thr_scratch_free(&w.own);
  return st;
}
