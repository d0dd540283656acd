/* Turns by node, and whether they hang together. */
#include "graph/threading/junction_graphs.h"

#include <stdlib.h>
#include <string.h>

void thr_junction_graphs_destroy(thr_junction_graphs *t)
{
  free(t->first);
  free(t->place);
  free(t->count);
  free(t->queue);
  free(t->seen);
  *t = (thr_junction_graphs){0};
}

static void count_turn(thr_junction_graphs *t, int in, int out, int by)
{
  int v = thr_tail(t->f, out);
  size_t d = (size_t)thr_degree(t->f, v), a = (size_t)t->place[in ^ 1], b = (size_t)t->place[out];
  t->count[t->first[v] + a * d + b] += by;
  if (a != b) t->count[t->first[v] + b * d + a] += by;
}

static void count_walks(thr_junction_graphs *t, const thr_walks *w)
{
  for (int i = 0; i < w->n_walks; i++) {
    const thr_walk *x = &w->walk[i];
    for (int k = x->cyclic ? 0 : 1; k < x->n; k++)
      count_turn(t, x->half[k ? k - 1 : x->n - 1], x->half[k], 1);
  }
}

thr_status thr_junction_graphs_init(thr_junction_graphs *t, const thr_frame *f, const thr_walks *w, thr_err *err)
{
  size_t sum = 0;
  int most = 1;
  *t = (thr_junction_graphs){.f = f,
                             .first = thr_calloc((size_t)f->n_nodes, sizeof *t->first),
                             .place = thr_calloc(2 * (size_t)f->n_edges, sizeof *t->place)};
  for (int v = 0; v < f->n_nodes && t->first && t->place; v++) {
    int d = thr_degree(f, v);
    t->first[v] = sum;
    sum += (size_t)d * (size_t)d;
    if (d > most) most = d;
    for (int i = 0; i < d; i++)
      t->place[f->half[f->first[v] + i]] = i;
  }
  t->count = thr_calloc(sum, sizeof *t->count);
  t->queue = thr_calloc((size_t)most, sizeof *t->queue);
  t->seen = thr_calloc((size_t)most, sizeof *t->seen);
  if (!t->first || !t->place || !t->count || !t->queue || !t->seen) {
    thr_junction_graphs_destroy(t);
    return thr_nomem(err);
  }
  count_walks(t, w);
  return THR_OK;
}

/* Half-edges at node v that hang together with its first one; -1: something turns back. */
static int reached(thr_junction_graphs *t, int v)
{
  int d = thr_degree(t->f, v), n = 1;
  const int *count = t->count + t->first[v];
  memset(t->seen, 0, (size_t)d * sizeof *t->seen);
  t->queue[0] = 0;
  t->seen[0] = true;
  for (int at = 0; at < n; at++) {
    const int *row = count + (size_t)t->queue[at] * (size_t)d;
    if (row[t->queue[at]] > 0) return -1;
    for (int b = 0; b < d; b++)
      if (row[b] > 0 && !t->seen[b]) {
        t->seen[b] = true;
        t->queue[n++] = b;
      }
  }
  return n;
}

void thr_turn_change_note(thr_turn_change *c, int in, int out, int by)
{
  if (in < 0 || out < 0) return;
  c->turn[c->n].in = in;
  c->turn[c->n].out = out;
  c->turn[c->n++].by = by;
}

void thr_junction_graphs_make(thr_junction_graphs *t, const thr_turn_change *c)
{
  for (int i = 0; i < c->n; i++)
    count_turn(t, c->turn[i].in, c->turn[i].out, c->turn[i].by);
}

bool thr_junction_graphs_allow(thr_junction_graphs *t, const thr_turn_change *c)
{
  bool allowed = true;
  for (int i = 0; i < c->n && allowed; i++)
    allowed = c->turn[i].by < 0 || c->turn[i].in != (c->turn[i].out ^ 1);
  if (!allowed) return false;
  thr_junction_graphs_make(t, c);
  for (int i = 0; i < c->n && allowed; i++) {
    int v = thr_tail(t->f, c->turn[i].out);
    allowed = reached(t, v) == thr_degree(t->f, v);
  }
  for (int i = 0; i < c->n; i++)
    count_turn(t, c->turn[i].in, c->turn[i].out, -c->turn[i].by);
  return allowed;
}
