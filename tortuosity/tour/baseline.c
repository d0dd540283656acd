/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fleury (1883) and Hierholzer (1873) on the multigraph of passes. */
#include "tortuosity/tour/baseline.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/threading/euler.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_join *j;
  thr_scratch own; /* the arrays */
  int *partner;    /* [n_darts] in the cheapest pairing of its node; NULL if pairings are ignored */
  bool *used;      /* [n_darts] both darts of a pass that is walked */
  int *walk;       /* [n_darts / 2 + 1] darts in order */
  int *stack;      /* [n_darts / 2 + 1] */
  int *cursor;     /* [n_nodes] first dart at a node that may be unused */
  int *stamp;      /* [n_nodes] */
  int *queue;      /* [n_nodes] */
  int searches;
} walker;

static thr_status walker_init(walker *w, thr_join *j, thr_err *err)
{
  size_t d = (size_t)j->g.n_darts, n = (size_t)j->g.n_nodes;
  *w = (walker){.j = j};
  w->used = thr_scratch_array(&w->own, d, sizeof *w->used);
  w->walk = thr_scratch_array(&w->own, d / 2 + 1, sizeof *w->walk);
  w->stack = thr_scratch_array(&w->own, d / 2 + 1, sizeof *w->stack);
  w->cursor = thr_scratch_array(&w->own, n, sizeof *w->cursor);
  w->stamp = thr_scratch_array(&w->own, n, sizeof *w->stamp);
  w->queue = thr_scratch_array(&w->own, n, sizeof *w->queue);
  thr_status st = thr_scratch_check(&w->own, err);
  if (st) return st;
  for (size_t v = 0; v < n; v++)
    w->cursor[v] = j->g.first[v];
  return THR_OK;
}

static int head_of(const walker *w, int d)
{
  return w->j->g.tail[d ^ 1];
}

/* An unused dart that leaves v, or -1. */
static int unused_at(walker *w, int v)
{
  const thr_multigraph *multigraph = &w->j->g;
  while (w->cursor[v] < multigraph->first[v + 1] && w->used[multigraph->dart[w->cursor[v]]])
    w->cursor[v]++;
  return w->cursor[v] < multigraph->first[v + 1] ? multigraph->dart[w->cursor[v]] : -1;
}

/* What Hierholzer walks after dart d, or -1. */
static int next_in_circuit(walker *w, int d)
{
  int partner = w->partner ? w->partner[d ^ 1] : -1;
  return partner >= 0 && !w->used[partner] ? partner : unused_at(w, head_of(w, d));
}

static int hierholzer(walker *w, int start)
{
  int top = 0, n = 0;
  w->used[start] = w->used[start ^ 1] = true;
  w->stack[top++] = start;
  while (top) {
    int d = next_in_circuit(w, w->stack[top - 1]);
    if (d < 0) {
      w->walk[n++] = w->stack[--top];
      continue;
    }
    w->used[d] = w->used[d ^ 1] = true;
    w->stack[top++] = d;
  }
  for (int i = 0; i < n / 2; i++) {
    int swap = w->walk[i];
    w->walk[i] = w->walk[n - 1 - i];
    w->walk[n - 1 - i] = swap;
  }
  return n;
}

/* Can v be reached from the head of dart d over unused passes other than d's? */
static bool leads_back(walker *w, int d, int v)
{
  const thr_multigraph *multigraph = &w->j->g;
  int head = 0, tail = 0, now = ++w->searches;
  w->stamp[head_of(w, d)] = now;
  w->queue[tail++] = head_of(w, d);
  while (head < tail) {
    int u = w->queue[head++];
    if (u == v) return true;
    for (int i = multigraph->first[u]; i < multigraph->first[u + 1]; i++) {
      int e = multigraph->dart[i], to = head_of(w, e);
      if (w->used[e] || (e | 1) == (d | 1) || w->stamp[to] == now) continue;
      w->stamp[to] = now;
      w->queue[tail++] = to;
    }
  }
  return false;
}

/* How early Fleury tries dart e after dart d. */
static double rank_of(const walker *w, int d, int e)
{
  if (!w->partner) return 0;
  return e == w->partner[d ^ 1] ? -1 : thr_join_price(w->j, d ^ 1, e);
}

/* What Fleury walks after dart d, or -1: the first by rank, then in order, that is no bridge. No
 * two of what is left at a node are bridges, so two looks do. */
static int next_but_bridges(walker *w, int d)
{
  const thr_multigraph *multigraph = &w->j->g;
  int v = head_of(w, d), bridge = -1, at = -1, left;
  do {
    double best = INFINITY;
    bridge = at;
    at = -1;
    left = 0;
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
      int e = multigraph->dart[i];
      if (w->used[e]) continue;
      left++;
      double rank = rank_of(w, d, e);
      if (e != bridge && rank < best) best = rank, at = e;
    }
  } while (left > 1 && bridge < 0 && !leads_back(w, at, v));
  return at;
}

static int fleury(walker *w, int start)
{
  int n = 0;
  for (int d = start; d >= 0; d = next_but_bridges(w, d)) {
    w->used[d] = w->used[d ^ 1] = true;
    w->walk[n++] = d;
  }
  return n;
}

/* Pairs along the walk; at end nodes nothing is paired. */
static void take_pairs(walker *w, int n)
{
  thr_join *j = w->j;
  for (int i = 0; i < n; i++) {
    int arriving = w->walk[i] ^ 1, leaving = w->walk[(i + 1) % n];
    if (j->g.tail[arriving] < j->c->f->n_nodes) thr_set_pair(j->mate, arriving, leaving);
  }
}

/* The cheapest pairing of the passes and ends at every node, and of the two ends of a cord. */
static thr_status pair_nodes(walker *w, thr_err *err)
{
  const thr_multigraph *multigraph = &w->j->g;
  int most = 0;
  for (int v = 0; v < multigraph->n_nodes; v++)
    if (multigraph->first[v + 1] - multigraph->first[v] > most)
      most = multigraph->first[v + 1] - multigraph->first[v];
  double *price = thr_scratch_array(&w->own, (size_t)most * (size_t)most, sizeof *price);
  int *mate = thr_scratch_array(&w->own, (size_t)most, sizeof *mate);
  w->partner = thr_scratch_array(&w->own, (size_t)multigraph->n_darts, sizeof *w->partner);
  thr_status st = thr_scratch_check(&w->own, err);
  for (int v = 0; v < multigraph->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    for (int i = 0; i < n; i++)
      for (int k = 0; k < n; k++)
        price[i * n + k] = i == k ? 0 : thr_join_price(w->j, dart[i], dart[k]);
    st = thr_pairing_best(n, price, mate, err);
    for (int i = 0; i < n && !st; i++)
      w->partner[dart[i]] = dart[mate[i]];
  }
  return st;
}

static thr_status walk_all(thr_join *j, thr_tour tour, bool ignore_pairings, thr_err *err)
{
  walker w;
  thr_status st = walker_init(&w, j, err);
  if (!st && !ignore_pairings) st = pair_nodes(&w, err);
  for (int k = 0; k < j->c->n_components && !st; k++) {
    int v = j->c->f->n_nodes + k, start = 0;
    if (j->c->task->end_allowed)
      start = j->g.dart[j->g.first[v]];
    else
      while (j->c->component[j->g.tail[start]] != k)
        start++;
    take_pairs(&w, tour == THR_TOUR_FLEURY ? fleury(&w, start) : hierholzer(&w, start));
  }
  thr_scratch_free(&w.own);
  return st;
}

/* Where the cords end: given, or where passes are odd in number, or, where they nowhere are, both
 * at the first node that may have them. Closed cords end nowhere. */
static void find_ends(const thr_turning_columns *turning_columns, const int *passes, int *ends)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *task = turning_columns->task;
  for (int v = 0; v < frame->n_nodes; v++) {
    int sum = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += passes[frame->half[i] >> 1];
    ends[v] = task->end_count ? task->end_count[v] : sum % 2;
  }
  for (int k = 0; k < turning_columns->n_components && task->end_allowed; k++) {
    int n = 0, first = -1;
    for (int v = frame->n_nodes - 1; v >= 0; v--) {
      if (turning_columns->component[v] != k) continue;
      n += ends[v];
      if (task->end_allowed[v]) first = v;
    }
    if (n == 0 && first >= 0) ends[first] = 2;
  }
}

thr_status thr_baseline_tour(const thr_frame *frame, const thr_least_options *options,
                             thr_tour tour, bool ignore_pairings, const int *passes, thr_least *out,
                             thr_err *err)
{
  thr_least made = {0};
  thr_turning_columns turning_columns = {0};
  thr_join j = {0};
  *out = (thr_least){0};
  if (tour != THR_TOUR_FLEURY && tour != THR_TOUR_HIERHOLZER)
    return thr_fail(err, THR_EINPUT,
                    "the least turning is no classical tour; name fleury or hierholzer");
  if (options->cords > 1)
    return thr_fail(err, THR_EINPUT,
                    "the classical tours make one cord per component; leave --cords out");
  int *ends = thr_calloc((size_t)frame->n_nodes, sizeof *ends);
  thr_status st = ends ? thr_least_task(frame, options, &made, err) : thr_nomem(err);
  if (!st) st = thr_turning_columns_init(&turning_columns, frame, &made.task, err);
  if (!st) find_ends(&turning_columns, passes, ends);
  if (!st) st = thr_join_init(&j, &turning_columns, passes, made.end_allowed ? ends : NULL, err);
  if (!st) st = walk_all(&j, tour, ignore_pairings, err);
  if (!st) st = thr_least_cords(frame, &j, &made, err);
  if (!st) {
    made.shortest = made.length;
    *out = made;
    made = (thr_least){0};
  }
  thr_least_destroy(&made);
  thr_join_destroy(&j);
  thr_turning_columns_destroy(&turning_columns);
  free(ends);
  return st;
}
