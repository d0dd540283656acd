/* Local search over extra passes. */
#include "tortuosity/proof/cycles.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  int *passes, *ends;  /* of the best plan */
  int *trial;          /* [n_edges] */
  int *by, *queue;     /* [n_nodes] half-edge that reached a node */
  int *cycle, n_cycle; /* edges */
} searcher;

static void searcher_destroy(searcher *s)
{
  free(s->passes);
  free(s->ends);
  free(s->trial);
  free(s->by);
  free(s->queue);
  free(s->cycle);
}

static thr_status searcher_init(searcher *s, const thr_frame *frame, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  *s = (searcher){0};
  s->passes = thr_calloc(m, sizeof *s->passes);
  s->ends = thr_calloc(n, sizeof *s->ends);
  s->trial = thr_calloc(m, sizeof *s->trial);
  s->by = thr_calloc(n, sizeof *s->by);
  s->queue = thr_calloc(n, sizeof *s->queue);
  s->cycle = thr_calloc(n + 1, sizeof *s->cycle);
  return s->passes && s->ends && s->trial && s->by && s->queue && s->cycle ? THR_OK : thr_nomem(err);
}

/* Breadth-first from one end of edge e to the other without it. No cycle through a bridge: n_cycle = 0. */
static void find_cycle(searcher *s, const thr_frame *frame, int e)
{
  int head = 0, tail = 0, from = frame->edge[e][0], to = frame->edge[e][1];
  for (int v = 0; v < frame->n_nodes; v++)
    s->by[v] = -1;
  s->n_cycle = 0;
  s->queue[tail++] = from;
  while (head < tail && s->by[to] < 0) {
    int u = s->queue[head++];
    for (int i = frame->first[u]; i < frame->first[u + 1]; i++) {
      int h = frame->half[i], w = thr_head(frame, h);
      if (h >> 1 == e || w == from || s->by[w] >= 0) continue;
      s->by[w] = h;
      s->queue[tail++] = w;
    }
  }
  if (s->by[to] < 0) return;
  s->cycle[s->n_cycle++] = e;
  for (int v = to; v != from; v = thr_tail(frame, s->by[v]))
    s->cycle[s->n_cycle++] = s->by[v] >> 1;
}

thr_status thr_cycles_improve(thr_branch *branch, int most_tries, thr_err *err)
{
  const thr_frame *frame = branch->c->f;
  searcher s;
  int tries = 0, unchanged = 0;
  thr_status st = searcher_init(&s, frame, err);
  if (!st) thr_branch_best(branch, s.passes, s.ends);
  for (int e = 0; !st && unchanged < frame->n_edges && tries < most_tries && !thr_limits_stop(branch->limits);
       e = (e + 1) % frame->n_edges) {
    int64_t before = branch->best_price;
    find_cycle(&s, frame, e);
    memcpy(s.trial, s.passes, (size_t)frame->n_edges * sizeof *s.trial);
    for (int i = 0; i < s.n_cycle; i++)
      s.trial[s.cycle[i]] += s.passes[s.cycle[i]] > branch->c->cover[s.cycle[i]] ? -1 : 1;
    unchanged++;
    if (s.n_cycle == 0) continue;
    tries++;
    st = thr_branch_try(branch, s.trial, s.ends, err);
    if (branch->best_price >= before) continue;
    unchanged = 0;
    thr_branch_best(branch, s.passes, s.ends);
  }
  searcher_destroy(&s);
  return st;
}
