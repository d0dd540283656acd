/* Local search over extra passes. */
#include "tortuosity/proof/cycles.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/process/threads.h"
#include "graph/scratch.h"
#include "tortuosity/proof/branch.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { AT_ONCE = 8 }; /* tries */

/* One try, with what it needs for itself. */
typedef struct {
  thr_branch own;      /* takes the plan if it is better than the best one */
  int edge;            /* that the cycle is through */
  int *trial;          /* [n_edges] passes */
  int *by, *queue;     /* [n_nodes] half-edge that reached a node */
  int *cycle, n_cycle; /* edges */
} attempt;

typedef struct {
  const thr_branch *branch;
  thr_scratch own;
  int *passes, *ends; /* of the best plan */
  attempt attempt[AT_ONCE];
  atomic_int first; /* lowest number of a try that found a better plan; AT_ONCE = none */
} searcher;

static void searcher_destroy(searcher *s)
{
  for (int k = 0; k < AT_ONCE; k++)
    thr_branch_destroy(&s->attempt[k].own);
  thr_scratch_free(&s->own);
}

static thr_status searcher_init(searcher *s, const thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  const size_t n = (size_t)branch->c->f->n_nodes, m = (size_t)branch->c->f->n_edges;
  *s = (searcher){.branch = branch};
  s->passes = thr_scratch_array(&s->own, m, sizeof *s->passes);
  s->ends = thr_scratch_array(&s->own, n, sizeof *s->ends);
  thr_status st = THR_OK;
  for (int k = 0; k < AT_ONCE && !st; k++) {
    attempt *a = &s->attempt[k];
    a->trial = thr_scratch_array(&s->own, m, sizeof *a->trial);
    a->by = thr_scratch_array(&s->own, n, sizeof *a->by);
    a->queue = thr_scratch_array(&s->own, n, sizeof *a->queue);
    a->cycle = thr_scratch_array(&s->own, n + 1, sizeof *a->cycle);
    st = thr_branch_init(&a->own, branch->c, 1, limits, err);
  }
  return st ? st : thr_scratch_check(&s->own, err);
}

/* Breadth-first from one end of edge e to the other without it. No cycle through a bridge: n_cycle = 0. */
static void find_cycle(attempt *s, const thr_frame *frame, int e)
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

/* A job. What comes after a better plan is not needed, as the next tries begin with that. */
static thr_status try_cycle(void *user, int k, const thr_limits *limits, thr_err *err)
{
  searcher *s = user;
  attempt *a = &s->attempt[k];
  const thr_frame *frame = s->branch->c->f;
  a->n_cycle = 0;
  if (s->first < k || thr_limits_stop(limits)) return THR_OK;
  find_cycle(a, frame, a->edge);
  if (a->n_cycle == 0) return THR_OK;
  memcpy(a->trial, s->passes, (size_t)frame->n_edges * sizeof *a->trial);
  for (int i = 0; i < a->n_cycle; i++)
    a->trial[a->cycle[i]] += s->passes[a->cycle[i]] > s->branch->c->cover[a->cycle[i]] ? -1 : 1;
  thr_branch_brief(&a->own, s->branch);
  thr_status st = thr_branch_try(&a->own, a->trial, s->ends, err);
  for (int first = s->first; a->own.found && k < first && !atomic_compare_exchange_weak(&s->first, &first, k);)
    ;
  return st;
}

/* Tries cycles through n edges from `edge` on; so many of them count, those up to the first that finds a better plan. */
static thr_status try_cycles(searcher *s, thr_branch *branch, int edge, int n, int *counted, thr_err *err)
{
  s->first = AT_ONCE;
  for (int k = 0; k < n; k++)
    s->attempt[k].edge = (edge + k) % branch->c->f->n_edges;
  thr_status st = thr_team_run(branch->team, n, try_cycle, s, err);
  *counted = s->first < n ? s->first + 1 : n;
  for (int k = 0; k < n; k++)
    if (k != s->first || st)
      thr_branch_forget(&s->attempt[k].own);
    else
      st = thr_branch_take(branch, &s->attempt[k].own, err);
  return st;
}

thr_status thr_cycles_improve(thr_branch *branch, int most_tries, thr_err *err)
{
  const thr_frame *frame = branch->c->f;
  searcher s;
  int tries = 0, unchanged = 0;
  thr_status st = thr_branch_gather(branch, err);
  if (st) return st;
  st = searcher_init(&s, branch, &branch->quiet, err);
  if (!st) thr_branch_best(branch, s.passes, s.ends);
  for (int e = 0, counted; !st && unchanged < frame->n_edges && tries < most_tries && !thr_limits_stop(branch->limits);
       e = (e + counted) % frame->n_edges) {
    int n = frame->n_edges - unchanged < most_tries - tries ? frame->n_edges - unchanged : most_tries - tries;
    st = try_cycles(&s, branch, e, n < AT_ONCE ? n : AT_ONCE, &counted, err);
    unchanged = s.first < AT_ONCE ? 0 : unchanged + counted;
    for (int k = 0; k < counted; k++)
      tries += s.attempt[k].n_cycle > 0;
    if (unchanged == 0) thr_branch_best(branch, s.passes, s.ends);
  }
  searcher_destroy(&s);
  return st;
}
