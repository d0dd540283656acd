/* Tracing, cutting and merging of walks. */
#include "graph/threading/walks.h"
#include "graph/threading/multigraph.h"
#include "graph/threading/tour.h"
#include "graph/threading/transition.h"

#include <stdlib.h>
#include <string.h>

void thr_walks_destroy(thr_walks *w)
{
  for (int i = 0; i < w->n_walks; i++)
    free(w->walk[i].half);
  free(w->walk);
  *w = (thr_walks){0};
}

double thr_walk_length(const thr_frame *f, const int *half, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += f->length[half[i] >> 1];
  return sum;
}

double thr_walks_longest(const thr_walks *w)
{
  double most = 0;
  for (int i = 0; i < w->n_walks; i++)
    most = w->walk[i].length > most ? w->walk[i].length : most;
  return most;
}

thr_status thr_walks_add(thr_walks *w, const thr_frame *f, thr_walk walk, thr_err *err)
{
  thr_status st = thr_grow(&w->walk, w->n_walks, &w->capacity, sizeof *w->walk, err);
  if (st) {
    free(walk.half);
    return st;
  }
  walk.length = thr_walk_length(f, walk.half, walk.n);
  w->walk[w->n_walks++] = walk;
  return THR_OK;
}

thr_status thr_walks_copy(thr_walks *w, const thr_frame *f, const int *half, int n, bool cyclic, thr_err *err)
{
  thr_walk new = {n, thr_calloc((size_t)n, sizeof *new.half), 0, cyclic};
  if (!new.half) return thr_nomem(err);
  memcpy(new.half, half, (size_t)n * sizeof *half);
  return thr_walks_add(w, f, new, err);
}

void thr_walks_count(const thr_walks *w, int *passes)
{
  for (int i = 0; i < w->n_walks; i++)
    for (int k = 0; k < w->walk[i].n; k++)
      passes[w->walk[i].half[k] >> 1]++;
}

double thr_walk_turn(const thr_frame *f, int in, int out)
{
  return thr_turn_angle(f, in, out) + (out == (in ^ 1) ? THR_U_TURN_PRICE : 0);
}

/* ---- tracing ---- */

/* Nodes with an odd number of passes, in twos of one component. */
static thr_status pair_odd_nodes(const thr_frame *f, const int *passes, const int *component, int n_components, int (*pair)[2],
                                 int *n_pairs, thr_err *err)
{
  int *waiting = thr_calloc((size_t)n_components, sizeof *waiting); /* node + 1 */
  *n_pairs = 0;
  if (!waiting) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes; v++) {
    int sum = 0, *w = &waiting[component[v]];
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += passes[f->half[i] >> 1];
    if (sum % 2 == 0) continue;
    if (*w) {
      pair[*n_pairs][0] = *w - 1;
      pair[*n_pairs][1] = v;
      ++*n_pairs;
    }
    *w = *w ? 0 : v + 1;
  }
  free(waiting);
  return THR_OK;
}

/* Cuts the circuit dart[0 .. n-1], which starts with a virtual dart if it has any, at those. */
static thr_status break_circuit(const thr_frame *f, const thr_multigraph *g, const int *dart, int n, thr_walks *out, thr_err *err)
{
  thr_status st = THR_OK;
  bool cyclic = g->half[dart[0]] >= 0;
  for (int from = cyclic ? 0 : 1, end; from < n && !st; from = end + 1) {
    for (end = from; end < n && g->half[dart[end]] >= 0;)
      end++;
    if (end == from) return thr_fail(err, THR_ESOLVER, "a cord without a pass");
    thr_walk w = {end - from, thr_calloc((size_t)(end - from), sizeof *w.half), 0, cyclic};
    if (!w.half) return thr_nomem(err);
    for (int i = from; i < end; i++)
      w.half[i - from] = g->half[dart[i]];
    st = thr_walks_add(out, f, w, err);
  }
  return st;
}

/* start[k]: the dart to trace component k from, a virtual one if there are any; -1 if it has no darts. */
static void find_starts(const thr_multigraph *g, const int *component, int *start, int n_components)
{
  for (int k = 0; k < n_components; k++)
    start[k] = -1;
  for (int d = 0; d < g->n_darts; d++) {
    int *s = &start[component[g->tail[d]]];
    if (*s < 0 || (g->half[d] < 0 && g->half[*s] >= 0)) *s = d;
  }
}

static thr_status trace_circuits(const thr_frame *f, const thr_multigraph *g, const int *component, int n_components,
                                 thr_walks *out, thr_err *err)
{
  int *mate = thr_calloc((size_t)g->n_darts, sizeof *mate), *walk = thr_calloc((size_t)g->n_darts, sizeof *walk);
  int *start = thr_calloc((size_t)n_components, sizeof *start), n;
  thr_status st = mate && walk && start ? THR_OK : thr_nomem(err);
  if (!st) st = thr_transition_pair(f, g, mate, err);
  if (!st) st = thr_transition_join(f, g, mate, err);
  if (!st) find_starts(g, component, start, n_components);
  for (int k = 0; k < n_components && !st; k++) {
    if (start[k] < 0) continue;
    thr_transition_trace(mate, start[k], walk, &n);
    st = break_circuit(f, g, walk, n, &out[k], err);
  }
  free(mate);
  free(walk);
  free(start);
  return st;
}

thr_status thr_walks_trace(const thr_frame *f, const int *passes, const int *component, int n_components, thr_walks *out,
                           thr_err *err)
{
  thr_multigraph g = {0};
  int n_pairs = 0, (*pair)[2] = thr_calloc((size_t)f->n_nodes / 2 + 1, sizeof *pair);
  memset(out, 0, (size_t)n_components * sizeof *out);
  thr_status st = pair ? pair_odd_nodes(f, passes, component, n_components, pair, &n_pairs, err) : thr_nomem(err);
  if (!st) st = thr_multigraph_init(&g, f, 0, passes, (const int(*)[2])pair, n_pairs, err);
  if (!st) st = trace_circuits(f, &g, component, n_components, out, err);
  for (int k = 0; k < n_components && st; k++)
    thr_walks_destroy(&out[k]);
  thr_multigraph_destroy(&g);
  free(pair);
  return st;
}

/* ---- changes ---- */

thr_status thr_walk_rotate(thr_walk *w, int at, thr_err *err)
{
  if (at == 0) return THR_OK;
  int *half = thr_calloc((size_t)w->n, sizeof *half);
  if (!half) return thr_nomem(err);
  memcpy(half, w->half + at, (size_t)(w->n - at) * sizeof *half);
  memcpy(half + w->n - at, w->half, (size_t)at * sizeof *half);
  free(w->half);
  w->half = half;
  return THR_OK;
}

/* ---- visits ---- */

static void list_walk(thr_walk_visits *x, int i)
{
  const thr_walk *w = &x->w[i];
  double sum = 0;
  for (int k = 0; k <= w->n; k++) {
    int e = x->n++;
    x->walk[e] = i;
    x->at[e] = k;
    x->sum[e] = sum;
    x->next[e] = -1;
    if (k < w->n) sum += x->f->length[w->half[k] >> 1];
    if (k == w->n && w->cyclic) continue;
    int *first = &x->first[thr_walk_node(x->f, w, k)];
    x->next[e] = *first;
    *first = e;
  }
}

thr_status thr_walk_visits_init(thr_walk_visits *x, const thr_frame *f, const thr_walk *w, int n_walks, int *first, thr_err *err)
{
  size_t n = (size_t)n_walks, nodes = (size_t)f->n_nodes;
  for (int i = 0; i < n_walks; i++)
    n += (size_t)w[i].n;
  *x = (thr_walk_visits){.f = f,
                         .w = w,
                         .first = first ? first : thr_calloc(nodes, sizeof *x->first),
                         .next = thr_calloc(n, sizeof *x->next),
                         .walk = thr_calloc(n, sizeof *x->walk),
                         .at = thr_calloc(n, sizeof *x->at),
                         .sum = thr_calloc(n, sizeof *x->sum),
                         .own = !first};
  if (!x->first || !x->next || !x->walk || !x->at || !x->sum) {
    thr_walk_visits_destroy(x);
    return thr_nomem(err);
  }
  if (x->own) memset(x->first, 0xff, nodes * sizeof *x->first);
  for (int i = 0; i < n_walks; i++)
    list_walk(x, i);
  return THR_OK;
}

void thr_walk_visits_forget(const thr_walk_visits *x)
{
  for (int e = 0; e < x->n; e++)
    x->first[thr_walk_node(x->f, &x->w[x->walk[e]], x->at[e])] = -1;
}

void thr_walk_visits_destroy(thr_walk_visits *x)
{
  if (x->own) free(x->first);
  free(x->next);
  free(x->walk);
  free(x->at);
  free(x->sum);
  *x = (thr_walk_visits){0};
}

/* ---- cords ---- */

int thr_walk_node(const thr_frame *f, const thr_walk *w, int at)
{
  return at < w->n ? thr_tail(f, w->half[at]) : thr_head(f, w->half[w->n - 1]);
}

void thr_walk_reverse(int *half, int n)
{
  for (int i = 0, j = n - 1; i <= j; i++, j--) {
    int h = half[i];
    half[i] = half[j] ^ 1;
    half[j] = h ^ 1;
  }
}

thr_status thr_walks_cords(thr_walks *w, const thr_frame *f, const thr_plan_options *o, int k, int first, thr_cord *cord,
                           thr_err *err)
{
  for (int i = 0; i < w->n_walks; i++) {
    thr_walk *x = &w->walk[i];
    int start = thr_tail(f, x->half[0]), end = thr_head(f, x->half[x->n - 1]);
    if (start > end) thr_walk_reverse(x->half, x->n);
    thr_status st = x->cyclic ? thr_walk_rotate(x, thr_tour_start(f, o, x->half, x->n), err) : THR_OK;
    if (st) return st;
    cord[i] = (thr_cord){.component = k, .closed = start == end, .n_passes = x->n, .half = x->half};
    thr_cord_id(first + i, cord[i].id);
    x->half = NULL;
  }
  thr_walks_destroy(w);
  return THR_OK;
}

thr_status thr_walks_plan(thr_walks *walks, int n_components, thr_plan *plan, thr_err *err)
{
  int n = 0;
  thr_status st = THR_OK;
  for (int k = 0; k < n_components; k++)
    n += walks[k].n_walks;
  if (!(plan->cord = thr_calloc((size_t)n, sizeof *plan->cord))) return thr_nomem(err);
  plan->n_cords = n;
  for (int k = 0, first = 0; k < n_components && !st; k++) {
    int made = walks[k].n_walks;
    st = thr_walks_cords(&walks[k], &plan->frame, &plan->options, k, first, plan->cord + first, err);
    first += made;
  }
  return st;
}
