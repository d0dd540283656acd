/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finding odd sets that a fractional point violates: sets S of nodes, an odd number of them odd,
 * with x(edges that leave S) < 1. Heuristically by moats (a ball round every odd component of the
 * support), exactly by a Gomory-Hu tree (Padberg & Rao, Mathematics of Operations Research 7,
 * 1982): of a tree of minimum cuts the lightest edge with an odd number of odd nodes on its sides.
 * Every set becomes a row of a pool, its members those of the row:
 *
 *   thr_oddcuts odd = {.graph = &graph, .x = x, .reduced_cost = cost, .threshold = {1e-6, 0.5},
 * .pool = &pool}; thr_search_use(&search, thr_oddcuts_moats, &odd, 0); thr_search_use(&search,
 * thr_oddcuts_exact, &odd, THR_FALLBACK);
 *
 * Example: a triangle of odd nodes with x = 1/2 on its edges and 0 on the others that leave it
 * breaks the row of the triangle. */
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "graph/random.h"
#include "graph/scratch.h"
#include "graph/sort.h"
#include "lp/tjoin/tjoin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance =
    1e-6; /* on x, far below the 1/2 and 1/3 that vertices of these polyhedra show */

/* ---- graph ---- */

thr_status thr_oddcut_graph_init(thr_oddcut_graph *graph, const thr_tjoin_problem *tjoin_problem,
                                 thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes;
  uint64_t state = 1;
  *graph = (thr_oddcut_graph){.p = tjoin_problem};
  graph->first = thr_calloc(n + 2, sizeof *graph->first);
  graph->incident = thr_calloc(2 * (size_t)tjoin_problem->n_edges, sizeof *graph->incident);
  graph->key = thr_calloc(n, sizeof *graph->key);
  graph->member = thr_calloc(n, sizeof *graph->member);
  if (!graph->first || !graph->incident || !graph->key || !graph->member) {
    thr_oddcut_graph_destroy(graph);
    return thr_nomem(err);
  }
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      graph->first[tjoin_problem->edge[e][i] + 2]++;
  for (size_t v = 1; v <= n; v++)
    graph->first[v + 1] += graph->first[v];
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      graph->incident[graph->first[tjoin_problem->edge[e][i] + 1]++] = e;
  for (size_t v = 0; v < n; v++)
    graph->all ^= graph->key[v] = thr_random(&state);
  return THR_OK;
}

void thr_oddcut_graph_destroy(thr_oddcut_graph *graph)
{
  free(graph->first);
  free(graph->incident);
  free(graph->key);
  free(graph->member);
  *graph = (thr_oddcut_graph){0};
}

static int other_end(const thr_tjoin_problem *tjoin_problem, int e, int v)
{
  return tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0];
}

/* ---- rows ---- */

/* Puts the edges that leave the n nodes marked in graph->member; returns the right side of their
 * row. */
static double put_crossing(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n)
{
  double lower = 1;
  for (int i = 0; i < n; i++)
    for (int k = graph->first[node[i]]; k < graph->first[node[i] + 1]; k++) {
      int e = graph->incident[k];
      if (graph->member[other_end(graph->p, e, node[i])]) continue;
      if (graph->put)
        lower += graph->put(graph->user, pool, e);
      else
        thr_pool_put(pool, e, 1);
    }
  return lower;
}

/* The row of the marked nodes, whose members are their side or, if that is smaller, the other;
 * ascending. */
static thr_status add_row(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n,
                          uint64_t name, thr_err *err)
{
  const int all = graph->p->n_nodes;
  bool flip = 2 * n > all || (2 * n == all && graph->member[0]);
  int size = flip ? all - n : n, *side = thr_calloc((size_t)size, sizeof *side);
  if (!side) return thr_nomem(err);
  for (int v = 0, k = 0; flip && k < size; v++)
    if (!graph->member[v]) side[k++] = v;
  if (!flip) {
    memcpy(side, node, (size_t)n * sizeof *side);
    thr_sort_ints(side, (size_t)n);
  }
  double lower = put_crossing(graph, pool, node, n);
  thr_status st = thr_pool_add(
      pool, (thr_row){.name = name, .lower = lower, .member = side, .n_members = size}, err);
  free(side);
  return st;
}

thr_status thr_oddcut_add(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n,
                          thr_err *err)
{
  uint64_t name = 0;
  bool odd = false;
  for (int i = 0; i < n; i++) {
    name ^= graph->key[node[i]];
    odd ^= graph->p->odd[node[i]];
  }
  if (!odd) return THR_OK;
  if ((name ^ graph->all) < name) name ^= graph->all;
  if (thr_pool_knows(pool, name)) return THR_OK;
  for (int i = 0; i < n; i++)
    graph->member[node[i]] = true;
  thr_status st = add_row(graph, pool, node, n, name, err);
  for (int i = 0; i < n; i++)
    graph->member[node[i]] = false;
  return st;
}

/* ---- moats ---- */

typedef struct {
  double distance;
  int node;
} reached;

typedef struct {
  reached *heap;
  int count;
} queue;

static bool nearer(reached a, reached b)
{
  return a.distance < b.distance || (a.distance == b.distance && a.node < b.node);
}

static void push(queue *q, reached r)
{
  int i = q->count++;
  for (; i > 0 && nearer(r, q->heap[(i - 1) / 2]); i = (i - 1) / 2)
    q->heap[i] = q->heap[(i - 1) / 2];
  q->heap[i] = r;
}

static reached pop(queue *q)
{
  reached top = q->heap[0], last = q->heap[--q->count];
  int i = 0;
  for (int child; (child = 2 * i + 1) < q->count; i = child) {
    if (child + 1 < q->count && nearer(q->heap[child + 1], q->heap[child])) child++;
    if (!nearer(q->heap[child], last)) break;
    q->heap[i] = q->heap[child];
  }
  q->heap[i] = last;
  return top;
}

/* Dijkstra from all odd components at once: owner[v] = component whose ball reaches v first, order
 * = nodes by distance. */
typedef struct {
  double *distance; /* [n] */
  int *owner;       /* [n] root of the component that reaches v, -1 = none */
  bool *odd_root;   /* [n] is the component with this root odd? */
  double *radius;   /* [n] by root: how far its ball may grow */
  int *order;       /* [n] nodes as settled */
  int settled;
  reached *heap;   /* [2 * n_edges + n] */
  thr_scratch own; /* the arrays */
} voronoi;

static void grow_balls(const thr_oddcut_graph *graph, const double *reduced_cost, int *parent,
                       voronoi *z)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  queue q = {z->heap, 0};
  for (int v = 0; v < tjoin_problem->n_nodes; v++) {
    int root = thr_disjoint_find(parent, v);
    z->owner[v] = z->odd_root[root] ? root : -1;
    z->distance[v] = z->odd_root[root] ? 0 : INFINITY;
    z->radius[v] = INFINITY;
    if (z->odd_root[root]) push(&q, (reached){0, v});
  }
  z->settled = 0;
  while (q.count) {
    reached r = pop(&q);
    int v = r.node;
    if (r.distance > z->distance[v]) continue;
    z->order[z->settled++] = v;
    for (int k = graph->first[v]; k < graph->first[v + 1]; k++) {
      int e = graph->incident[k], w = other_end(tjoin_problem, e, v);
      double through = r.distance + fmax(reduced_cost[e], 0);
      if (through < z->distance[w]) {
        z->distance[w] = through;
        z->owner[w] = z->owner[v];
        push(&q, (reached){through, w});
      }
    }
  }
}

/* Balls may touch but not overlap: half the shortest path between two owners bounds both radii. */
static void bound_radii(const thr_tjoin_problem *tjoin_problem, const double *reduced_cost,
                        voronoi *z)
{
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    int a = tjoin_problem->edge[e][0], b = tjoin_problem->edge[e][1];
    if (z->owner[a] == z->owner[b] || z->owner[a] < 0 || z->owner[b] < 0) continue;
    double half = (z->distance[a] + fmax(reduced_cost[e], 0) + z->distance[b]) / 2;
    for (int i = 0; i < 2; i++) {
      double *radius = &z->radius[z->owner[tjoin_problem->edge[e][i]]];
      if (half < *radius) *radius = half;
    }
  }
}

/* For one owner, nodes come in order of distance: each prefix that ends before a farther node is a
 * ball. */
static thr_status add_balls(const thr_oddcut_graph *graph, const voronoi *z, const int *start,
                            const int *by_owner, thr_pool *pool, thr_err *err)
{
  thr_status st = THR_OK;
  int *prefix = thr_calloc((size_t)graph->p->n_nodes, sizeof *prefix);
  if (!prefix) return thr_nomem(err);
  for (int root = 0; root < graph->p->n_nodes && !st; root++) {
    const int *node = by_owner + start[root];
    int n = start[root + 1] - start[root];
    double near = 1e-9 * (1 + z->radius[root]); /* distances this close are one: edges inside even
                                                   components cost rounding */
    for (int i = 0; i < n && !st; i++) {
      prefix[i] = node[i];
      double next = i + 1 < n ? z->distance[node[i + 1]] : INFINITY;
      if (z->distance[node[i]] > z->radius[root] + near) break;
      if (next - z->distance[node[i]] > near) st = thr_oddcut_add(graph, pool, prefix, i + 1, err);
    }
  }
  free(prefix);
  return st;
}

static thr_status voronoi_init(voronoi *z, const thr_tjoin_problem *tjoin_problem, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes;
  z->distance = thr_scratch_array(&z->own, n, sizeof *z->distance);
  z->owner = thr_scratch_array(&z->own, n, sizeof *z->owner);
  z->odd_root = thr_scratch_array(&z->own, n, sizeof *z->odd_root);
  z->radius = thr_scratch_array(&z->own, n, sizeof *z->radius);
  z->order = thr_scratch_array(&z->own, n, sizeof *z->order);
  z->heap = thr_scratch_array(&z->own, 2 * (size_t)tjoin_problem->n_edges + n, sizeof *z->heap);
  return thr_scratch_check(&z->own, err);
}

static void voronoi_destroy(voronoi *z)
{
  thr_scratch_free(&z->own);
}

/* Components of {e : x_e > threshold}; x NULL: single nodes. */
static void components(const thr_tjoin_problem *tjoin_problem, const double *x, double threshold,
                       int *parent)
{
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    parent[v] = v;
  for (int e = 0; x && e < tjoin_problem->n_edges; e++)
    if (x[e] > threshold)
      thr_disjoint_join(parent, tjoin_problem->edge[e][0], tjoin_problem->edge[e][1]);
}

thr_status thr_oddcut_moats(const thr_oddcut_graph *graph, const double *x, double threshold,
                            const double *reduced_cost, thr_pool *pool, thr_err *err)
{
  thr_scratch own = {0};
  const thr_tjoin_problem *tjoin_problem = graph->p;
  size_t n = (size_t)tjoin_problem->n_nodes;
  voronoi z = {0};
  int *parent = thr_scratch_array(&own, n, sizeof *parent),
      *start = thr_scratch_array(&own, n + 2, sizeof *start),
      *by_owner = thr_scratch_array(&own, n, sizeof *by_owner);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = voronoi_init(&z, tjoin_problem, err);
  if (st) goto done;
  components(tjoin_problem, x, threshold, parent);
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    if (tjoin_problem->odd[v]) z.odd_root[thr_disjoint_find(parent, v)] ^= true;
  grow_balls(graph, reduced_cost, parent, &z);
  bound_radii(tjoin_problem, reduced_cost, &z);
  for (int i = 0; i < z.settled; i++)
    start[z.owner[z.order[i]] + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int i = 0; i < z.settled; i++) {
    int owner = z.owner[z.order[i]];
    by_owner[start[owner + 1]++] = z.order[i];
  }
  st = add_balls(graph, &z, start, by_owner, pool, err);
done:
  voronoi_destroy(&z);
  thr_scratch_free(&own);
  return st;
}

/* ---- exact separation ---- */

/* One component of the support, with edges of x >= 1 contracted. */
typedef struct {
  int n, m;
  int (*edge)[2];
  double *capacity;
  int (*tree)[2];
  double *flow;
  int *parent;     /* disjoint sets over the tree without one edge */
  bool *side;      /* [n] */
  thr_scratch own; /* the arrays */
} shrunk;

static void shrunk_destroy(shrunk *s)
{
  thr_scratch_free(&s->own);
}

static thr_status shrunk_init(shrunk *s, int n, int m, thr_err *err)
{
  size_t nodes = (size_t)n, edges = (size_t)m;
  *s = (shrunk){0};
  s->edge = thr_scratch_array(&s->own, edges, sizeof *s->edge);
  s->capacity = thr_scratch_array(&s->own, edges, sizeof *s->capacity);
  s->tree = thr_scratch_array(&s->own, nodes, sizeof *s->tree);
  s->flow = thr_scratch_array(&s->own, nodes, sizeof *s->flow);
  s->parent = thr_scratch_array(&s->own, nodes, sizeof *s->parent);
  s->side = thr_scratch_array(&s->own, nodes, sizeof *s->side);
  return thr_scratch_check(&s->own, err);
}

/* Adds the side of tree edge i, in framework nodes: those whose shrunk node is still joined to
 * tree[i][0]. */
static thr_status add_side(const thr_oddcut_graph *graph, const shrunk *s, int i, const int *node,
                           const int *shrunk_of, int n, int *list, thr_pool *pool, thr_err *err)
{
  for (int v = 0; v < s->n; v++)
    s->parent[v] = v;
  for (int k = 0; k < s->n - 1; k++)
    if (k != i) thr_disjoint_join(s->parent, s->tree[k][0], s->tree[k][1]);
  int root = thr_disjoint_find(s->parent, s->tree[i][0]), count = 0;
  for (int k = 0; k < n; k++)
    if (thr_disjoint_find(s->parent, shrunk_of[node[k]]) == root) list[count++] = node[k];
  return thr_oddcut_add(graph, pool, list, count, err); /* ignores an even side */
}

/* node[0 .. n-1] is one component of the support; block[v] its contracted group; shrunk_of and list
 * are scratch. */
static thr_status separate_component(const thr_oddcut_graph *graph, const double *x,
                                     const int *node, int n, int *block, int *shrunk_of, int *list,
                                     thr_pool *pool, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  shrunk s;
  int ids = 0, degrees = 0;
  for (int i = 0; i < n; i++) {
    int root = thr_disjoint_find(block, node[i]);
    if (root == node[i])
      shrunk_of[root] = ids++; /* a root is the lowest of its block, and node[] ascends */
    shrunk_of[node[i]] = shrunk_of[root];
    degrees += graph->first[node[i] + 1] - graph->first[node[i]];
  }
  /* The component itself, crossed by nothing: moats miss it where a tight edge of x = 0 leaves it.
   */
  if (n > 0) memcpy(list, node, (size_t)n * sizeof *list);
  thr_status st = thr_oddcut_add(graph, pool, list, n, err); /* ignores an even one */
  if (st || ids < 2) return st;
  st = shrunk_init(&s, ids, degrees, err);
  s.n = ids;
  for (int i = 0; i < n && !st; i++)
    for (int k = graph->first[node[i]]; k < graph->first[node[i] + 1]; k++) {
      int e = graph->incident[k], w = other_end(tjoin_problem, e, node[i]);
      if (w < node[i] || x[e] <= tolerance || shrunk_of[node[i]] == shrunk_of[w]) continue;
      s.edge[s.m][0] = shrunk_of[node[i]];
      s.edge[s.m][1] = shrunk_of[w];
      s.capacity[s.m++] = x[e];
    }
  if (!st) st = thr_cut_tree(s.n, s.m, (const int(*)[2])s.edge, s.capacity, s.tree, s.flow, err);
  for (int i = 0; i < s.n - 1 && !st; i++)
    if (s.flow[i] < 1 - tolerance) st = add_side(graph, &s, i, node, shrunk_of, n, list, pool, err);
  shrunk_destroy(&s);
  return st;
}

thr_status thr_oddcut_exact(const thr_oddcut_graph *graph, const double *x, thr_pool *pool,
                            thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  size_t n = (size_t)tjoin_problem->n_nodes;
  thr_scratch own = {0};
  int *parent = thr_scratch_array(&own, n, sizeof *parent),
      *block = thr_scratch_array(&own, n, sizeof *block),
      *shrunk_of = thr_scratch_array(&own, n, sizeof *shrunk_of);
  int *list = thr_scratch_array(&own, n, sizeof *list),
      *start = thr_scratch_array(&own, n + 2, sizeof *start),
      *node = thr_scratch_array(&own, n, sizeof *node);
  thr_status st = thr_scratch_check(&own, err);
  if (st) goto done;
  components(tjoin_problem, x, tolerance, parent);
  components(tjoin_problem, x, 1 - tolerance, block);
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    start[thr_disjoint_find(parent, v) + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    node[start[thr_disjoint_find(parent, v) + 1]++] = v;
  for (int root = 0; root < tjoin_problem->n_nodes && !st; root++)
    st = separate_component(graph, x, node + start[root], start[root + 1] - start[root], block,
                            shrunk_of, list, pool, err);
done:
  thr_scratch_free(&own);
  return st;
}

/* ---- for a search ---- */

/* Keeps the rows from number `first` on that count. */
static thr_status keep(const thr_oddcuts *odd, int first, int *added, thr_err *err)
{
  if (odd->point)
    return thr_pool_keep_violated(odd->pool, first, odd->point, tolerance, added, err);
  *added += odd->pool->count - first;
  return THR_OK;
}

thr_status thr_oddcuts_moats(void *oddcuts, int *added, thr_err *err)
{
  const thr_oddcuts *odd = oddcuts;
  const int n = sizeof odd->threshold / sizeof *odd->threshold, first = odd->pool->count;
  thr_status st = THR_OK;
  for (int i = 0; i < n && odd->threshold[i] > 0 && !st && odd->pool->count == first; i++) {
    st = thr_oddcut_moats(odd->graph, odd->x, odd->threshold[i], odd->reduced_cost, odd->pool, err);
    if (!st) st = keep(odd, first, added, err);
  }
  return st;
}

thr_status thr_oddcuts_exact(void *oddcuts, int *added, thr_err *err)
{
  const thr_oddcuts *odd = oddcuts;
  int first = odd->pool->count;
  thr_status st = thr_oddcut_exact(odd->graph, odd->x, odd->pool, err);
  return st ? st : keep(odd, first, added, err);
}
