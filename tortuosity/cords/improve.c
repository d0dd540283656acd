/* Exchanges on a tour: reversals, and cuts that are joined elsewhere (2- and 3-opt on transitions). */
#include "tortuosity/cords/improve.h"

#include <math.h>
#include <stdlib.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* The circuit of one component, as transitions: number i arrives by in[i] and leaves by out[i] (both darts leave its node). Cord
 * ends are paired at their node in the order of the cords, so that open cords make one circuit too; those pairs are never
 * exchanged. */
typedef struct {
  thr_join *j;
  int n;
  int *in, *out;
  int *at;       /* [n_darts] transition that the dart is part of */
  int *ring;     /* [n_darts] mate, with pairs at the end nodes */
  bool *visited; /* [n_darts] */
  int *node;     /* [n_nodes of the framework] by component: those of the one at hand are node[begin] .. node[end - 1] */
  int *first;    /* [n_components + 2] */
  int component, begin, end;
} tour;

static void tour_destroy(tour *t)
{
  free(t->in);
  free(t->out);
  free(t->at);
  free(t->ring);
  free(t->visited);
  free(t->node);
  free(t->first);
}

static void sort_nodes(tour *t)
{
  const thr_turning_columns *c = t->j->c;
  for (int v = 0; v < c->f->n_nodes; v++)
    t->first[c->component[v] + 2]++;
  for (int k = 1; k <= c->n_components; k++)
    t->first[k + 1] += t->first[k];
  for (int v = 0; v < c->f->n_nodes; v++)
    t->node[t->first[c->component[v] + 1]++] = v;
}

static thr_status tour_init(tour *t, thr_join *j, thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *t = (tour){.j = j};
  t->in = thr_calloc(n, sizeof *t->in);
  t->out = thr_calloc(n, sizeof *t->out);
  t->at = thr_calloc(n, sizeof *t->at);
  t->ring = thr_calloc(n, sizeof *t->ring);
  t->visited = thr_calloc(n, sizeof *t->visited);
  t->node = thr_calloc((size_t)j->c->f->n_nodes, sizeof *t->node);
  t->first = thr_calloc((size_t)j->c->n_components + 2, sizeof *t->first);
  if (!t->in || !t->out || !t->at || !t->ring || !t->visited || !t->node || !t->first) return thr_nomem(err);
  sort_nodes(t);
  return THR_OK;
}

static void copy_pairs(tour *t, int v)
{
  const thr_multigraph *g = &t->j->g;
  for (int i = g->first[v]; i < g->first[v + 1]; i++) {
    t->ring[g->dart[i]] = t->j->mate[g->dart[i]];
    t->visited[g->dart[i]] = false;
  }
}

/* Pairs the ends of cord after cord at their node: the far end of one with the near end of the next. */
static void close_ring(tour *t)
{
  const thr_join *j = t->j;
  const thr_multigraph *g = &j->g;
  int v = j->c->f->n_nodes + t->component, first = -1, far = -1;
  for (int i = t->begin; i < t->end; i++)
    copy_pairs(t, t->node[i]);
  copy_pairs(t, v);
  for (int i = g->first[v]; i < g->first[v + 1]; i++) {
    int near = g->dart[i], d = near;
    if (t->ring[near] >= 0 || near == far) continue;
    while (j->mate[d ^ 1] >= 0)
      d = j->mate[d ^ 1];
    if (first < 0)
      first = near;
    else
      t->ring[far] = near, t->ring[near] = far;
    far = d ^ 1;
  }
  if (first >= 0) t->ring[far] = first, t->ring[first] = far;
}

static void walk(tour *t, int start)
{
  t->n = 0;
  for (int d = start; !t->visited[d]; d = t->ring[d ^ 1]) {
    t->visited[d] = t->visited[d ^ 1] = true;
    t->in[t->n] = d ^ 1;
    t->out[t->n] = t->ring[d ^ 1];
    t->at[t->in[t->n]] = t->at[t->out[t->n]] = t->n;
    t->n++;
  }
}

static int node_of(const tour *t, int i)
{
  return t->j->g.tail[t->in[i]];
}

static double pair_price(const tour *t, int i)
{
  return thr_join_price(t->j, t->in[i], t->out[i]);
}

/* Replaces two pairs; what they were is known from mate. */
static void exchange(tour *t, int a, int b, int c, int d)
{
  int *mate = t->j->mate;
  mate[a] = b;
  mate[b] = a;
  mate[c] = d;
  mate[d] = c;
}

/* The next transition after i at the same node, in the order of the node's darts; each transition once. */
static int transitions_at(const tour *t, int v, int *list)
{
  const thr_multigraph *g = &t->j->g;
  int n = 0;
  for (int k = g->first[v]; k < g->first[v + 1]; k++) {
    int d = g->dart[k];
    if (t->in[t->at[d]] == d) list[n++] = t->at[d];
  }
  return n;
}

/* Runs the part between two transitions of one node the other way round where that saves. true: the tour has changed. */
static bool reverse_part(tour *t, int i, int k)
{
  double old = pair_price(t, i) + pair_price(t, k);
  double now = thr_join_price(t->j, t->in[i], t->in[k]) + thr_join_price(t->j, t->out[i], t->out[k]);
  if (now >= old - enough) return false;
  exchange(t, t->in[i], t->in[k], t->out[i], t->out[k]);
  return true;
}

typedef struct {
  double extra;
  int a, b, c, d; /* pairs to make */
} joint;

static void consider(const tour *t, int a, int b, int c, int d, double old, joint *best)
{
  double extra = thr_join_price(t->j, a, b) + thr_join_price(t->j, c, d) - old;
  if (extra < best->extra - 1e-12) *best = (joint){extra, a, b, c, d};
}

/* The cheapest way to join the part i < .. < k, once cut off, to the rest again, at any node. The cut itself does not count. */
static joint cheapest_joint(const tour *t, int i, int k, double most, const thr_limits *limits, int *list)
{
  joint best = {.extra = most};
  for (int x = i + 1; x < k && (x % 64 || !thr_limits_stop(limits)); x++) {
    int v = node_of(t, x), n;
    if (v >= t->j->c->f->n_nodes) continue;
    n = transitions_at(t, v, list);
    for (int y = 0; y < n; y++) {
      int z = list[y];
      if (z >= i && z <= k) continue;
      double old = pair_price(t, x) + pair_price(t, z);
      consider(t, t->in[x], t->in[z], t->out[x], t->out[z], old, &best);
      consider(t, t->in[x], t->out[z], t->out[x], t->in[z], old, &best);
    }
  }
  return best;
}

/* Cuts the part between two transitions of one node off where that saves more than joining it again costs. */
static bool cut_and_join(tour *t, int i, int k, const thr_limits *limits, int *list)
{
  if (i > k) {
    int larger = i;
    i = k;
    k = larger;
  }
  double old = pair_price(t, i) + pair_price(t, k);
  double now = thr_join_price(t->j, t->in[i], t->out[k]) + thr_join_price(t->j, t->in[k], t->out[i]);
  if (now >= old - enough) return false;
  joint best = cheapest_joint(t, i, k, old - now - enough, limits, list);
  if (best.extra >= old - now - enough) return false;
  exchange(t, t->in[i], t->out[k], t->in[k], t->out[i]);
  exchange(t, best.a, best.b, best.c, best.d);
  return true;
}

/* One improvement anywhere at node v. */
static bool improve_node(tour *t, int v, const thr_limits *limits, int *here, int *list)
{
  int n = transitions_at(t, v, here);
  for (int i = 0; i < n && !thr_limits_stop(limits); i++)
    for (int k = i + 1; k < n; k++)
      if (reverse_part(t, here[i], here[k])) return true;
  for (int i = 0; i < n && !thr_limits_stop(limits); i++)
    for (int k = i + 1; k < n; k++)
      if (cut_and_join(t, here[i], here[k], limits, list)) return true;
  return false;
}

/* Improves the circuit through dart start until a whole pass over its nodes changes nothing. */
static void improve_circuit(tour *t, int start, const thr_limits *limits, int *here, int *list)
{
  bool changed = true;
  while (changed && !thr_limits_stop(limits)) {
    changed = false;
    for (int i = t->begin; i < t->end && !thr_limits_stop(limits); i++) {
      while (improve_node(t, t->node[i], limits, here, list)) {
        changed = true;
        close_ring(t);
        walk(t, start);
      }
    }
  }
}

/* The lowest of the component that leaves one of its nodes. */
static int first_dart(const tour *t)
{
  const thr_multigraph *g = &t->j->g;
  int least = g->n_darts;
  for (int i = t->begin; i < t->end; i++)
    for (int k = g->first[t->node[i]]; k < g->first[t->node[i] + 1]; k++)
      if (g->dart[k] < least) least = g->dart[k];
  return least;
}

thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err)
{
  tour t;
  const thr_multigraph *g = &j->g;
  int *here = thr_calloc((size_t)g->n_darts, sizeof *here), *list = thr_calloc((size_t)g->n_darts, sizeof *list);
  thr_status st = tour_init(&t, j, err);
  if (!st && (!here || !list)) st = thr_nomem(err);
  for (int k = 0; k < j->c->n_components && !st; k++) {
    t.component = k;
    t.begin = t.first[k];
    t.end = t.first[k + 1];
    int start = first_dart(&t);
    close_ring(&t);
    walk(&t, start);
    improve_circuit(&t, start, limits, here, list);
  }
  tour_destroy(&t);
  free(here);
  free(list);
  if (!st) thr_join_measure(j);
  return st;
}
