/* Odd cuts: pool, moats by Dijkstra, exact separation by a Gomory-Hu tree. */
#include "lp/tjoin/oddcut.h"
#include "graph/framework/cuttree.h"
#include "graph/disjoint.h"
#include "graph/random.h"
#include "graph/sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6; /* on x, far below the 1/2 and 1/3 that vertices of these polyhedra show */

/* ---- graph ---- */

thr_status thr_oddcut_graph_init(thr_oddcut_graph *g, const thr_tjoin_problem *p, thr_err *err)
{
  size_t n = (size_t)p->n_nodes;
  uint64_t state = 1;
  *g = (thr_oddcut_graph){.p = p};
  g->first = thr_calloc(n + 2, sizeof *g->first);
  g->incident = thr_calloc(2 * (size_t)p->n_edges, sizeof *g->incident);
  g->key = thr_calloc(n, sizeof *g->key);
  g->member = thr_calloc(n, sizeof *g->member);
  if (!g->first || !g->incident || !g->key || !g->member) {
    thr_oddcut_graph_destroy(g);
    return thr_nomem(err);
  }
  for (int e = 0; e < p->n_edges; e++)
    for (int i = 0; i < 2; i++)
      g->first[p->edge[e][i] + 2]++;
  for (size_t v = 1; v <= n; v++)
    g->first[v + 1] += g->first[v];
  for (int e = 0; e < p->n_edges; e++)
    for (int i = 0; i < 2; i++)
      g->incident[g->first[p->edge[e][i] + 1]++] = e;
  for (size_t v = 0; v < n; v++)
    g->all ^= g->key[v] = thr_random(&state);
  return THR_OK;
}

void thr_oddcut_graph_destroy(thr_oddcut_graph *g)
{
  free(g->first);
  free(g->incident);
  free(g->key);
  free(g->member);
  *g = (thr_oddcut_graph){0};
}

static int other_end(const thr_tjoin_problem *p, int e, int v)
{
  return p->edge[e][0] == v ? p->edge[e][1] : p->edge[e][0];
}

/* ---- pool ---- */

void thr_oddcut_pool_destroy(thr_oddcut_pool *pool)
{
  for (int i = 0; i < pool->count; i++) {
    free(pool->cut[i].node);
    free(pool->cut[i].edge);
  }
  free(pool->cut);
  free(pool->seen);
  *pool = (thr_oddcut_pool){0};
}

/* Slot of a name in the table (0 marks an empty slot; a name of 0 is as good as impossible and is merely lost). */
static int slot_of(const thr_oddcut_pool *pool, uint64_t name)
{
  int i = (int)(name % (uint64_t)pool->seen_size);
  while (pool->seen[i] && pool->seen[i] != name)
    i = i + 1 == pool->seen_size ? 0 : i + 1;
  return i;
}

static thr_status rehash(thr_oddcut_pool *pool, int size, thr_err *err)
{
  uint64_t *table = thr_calloc((size_t)size, sizeof *table);
  if (!table) return thr_nomem(err);
  free(pool->seen);
  pool->seen = table;
  pool->seen_size = size;
  pool->seen_used = pool->count;
  for (int i = 0; i < pool->count; i++)
    table[slot_of(pool, pool->cut[i].name)] = pool->cut[i].name;
  return THR_OK;
}

void thr_oddcut_pool_drop(thr_oddcut_pool *pool, const bool *drop)
{
  int kept = 0;
  for (int i = 0; i < pool->count; i++) {
    if (drop[i]) {
      free(pool->cut[i].node);
      free(pool->cut[i].edge);
    } else {
      pool->cut[kept++] = pool->cut[i];
    }
  }
  pool->count = kept;
  if (pool->seen_size == 0) return;
  memset(pool->seen, 0, (size_t)pool->seen_size * sizeof *pool->seen);
  pool->seen_used = kept;
  for (int i = 0; i < kept; i++)
    pool->seen[slot_of(pool, pool->cut[i].name)] = pool->cut[i].name;
}

/* Fills c with the cut of the n nodes marked in g->member: their side or, if that is smaller, the other. */
static thr_status collect(const thr_oddcut_graph *g, const int *node, int n, struct thr_oddcut *c, thr_err *err)
{
  const thr_tjoin_problem *p = g->p;
  bool flip = 2 * n > p->n_nodes || (2 * n == p->n_nodes && g->member[0]);
  int crossing = 0, size = flip ? p->n_nodes - n : n;
  for (int i = 0; i < n; i++)
    for (int k = g->first[node[i]]; k < g->first[node[i] + 1]; k++)
      crossing += !g->member[other_end(p, g->incident[k], node[i])];
  c->node = thr_calloc((size_t)size, sizeof *c->node);
  c->edge = thr_calloc((size_t)crossing, sizeof *c->edge);
  if (!c->node || !c->edge) return thr_nomem(err);
  for (int i = 0; i < n; i++)
    for (int k = g->first[node[i]]; k < g->first[node[i] + 1]; k++)
      if (!g->member[other_end(p, g->incident[k], node[i])]) c->edge[c->n_edges++] = g->incident[k];
  if (flip) {
    for (int v = 0; v < p->n_nodes; v++)
      if (!g->member[v]) c->node[c->n_nodes++] = v;
  } else {
    memcpy(c->node, node, (size_t)n * sizeof *node);
    c->n_nodes = n;
    thr_sort_ints(c->node, (size_t)n);
  }
  return THR_OK;
}

thr_status thr_oddcut_add(const thr_oddcut_graph *g, thr_oddcut_pool *pool, int *node, int n, thr_err *err)
{
  uint64_t name = 0;
  bool odd = false;
  for (int i = 0; i < n; i++) {
    name ^= g->key[node[i]];
    odd ^= g->p->odd[node[i]];
  }
  if (!odd) return THR_OK;
  if ((name ^ g->all) < name) name ^= g->all;
  thr_status st;
  if (2 * pool->seen_used >= pool->seen_size && (st = rehash(pool, pool->seen_size ? 2 * pool->seen_size : 1024, err))) return st;
  int slot = slot_of(pool, name);
  if (pool->seen[slot]) return THR_OK;
  if ((st = thr_grow(&pool->cut, pool->count, &pool->capacity, sizeof *pool->cut, err))) return st;
  struct thr_oddcut c = {.name = name};
  for (int i = 0; i < n; i++)
    g->member[node[i]] = true;
  st = collect(g, node, n, &c, err);
  for (int i = 0; i < n; i++)
    g->member[node[i]] = false;
  if (st) {
    free(c.node);
    free(c.edge);
    return st;
  }
  pool->seen[slot] = name;
  pool->seen_used++;
  pool->cut[pool->count++] = c;
  return THR_OK;
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

/* Dijkstra from all odd components at once: owner[v] = component whose ball reaches v first, order = nodes by distance. */
typedef struct {
  double *distance; /* [n] */
  int *owner;       /* [n] root of the component that reaches v, -1 = none */
  bool *odd_root;   /* [n] is the component with this root odd? */
  double *radius;   /* [n] by root: how far its ball may grow */
  int *order;       /* [n] nodes as settled */
  int settled;
  reached *heap; /* [2 * n_edges + n] */
} voronoi;

static void grow_balls(const thr_oddcut_graph *g, const double *reduced_cost, int *parent, voronoi *z)
{
  const thr_tjoin_problem *p = g->p;
  queue q = {z->heap, 0};
  for (int v = 0; v < p->n_nodes; v++) {
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
    for (int k = g->first[v]; k < g->first[v + 1]; k++) {
      int e = g->incident[k], w = other_end(p, e, v);
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
static void bound_radii(const thr_tjoin_problem *p, const double *reduced_cost, voronoi *z)
{
  for (int e = 0; e < p->n_edges; e++) {
    int a = p->edge[e][0], b = p->edge[e][1];
    if (z->owner[a] == z->owner[b] || z->owner[a] < 0 || z->owner[b] < 0) continue;
    double half = (z->distance[a] + fmax(reduced_cost[e], 0) + z->distance[b]) / 2;
    for (int i = 0; i < 2; i++) {
      double *radius = &z->radius[z->owner[p->edge[e][i]]];
      if (half < *radius) *radius = half;
    }
  }
}

/* For one owner, nodes come in order of distance: each prefix that ends before a farther node is a ball. */
static thr_status add_balls(const thr_oddcut_graph *g, const voronoi *z, const int *start, const int *by_owner,
                            thr_oddcut_pool *pool, thr_err *err)
{
  thr_status st = THR_OK;
  int *prefix = thr_calloc((size_t)g->p->n_nodes, sizeof *prefix);
  if (!prefix) return thr_nomem(err);
  for (int root = 0; root < g->p->n_nodes && !st; root++) {
    const int *node = by_owner + start[root];
    int n = start[root + 1] - start[root];
    double near = 1e-9 * (1 + z->radius[root]); /* distances this close are one: edges inside even components cost rounding */
    for (int i = 0; i < n && !st; i++) {
      prefix[i] = node[i];
      double next = i + 1 < n ? z->distance[node[i + 1]] : INFINITY;
      if (z->distance[node[i]] > z->radius[root] + near) break;
      if (next - z->distance[node[i]] > near) st = thr_oddcut_add(g, pool, prefix, i + 1, err);
    }
  }
  free(prefix);
  return st;
}

static thr_status voronoi_init(voronoi *z, const thr_tjoin_problem *p, thr_err *err)
{
  size_t n = (size_t)p->n_nodes;
  z->distance = thr_calloc(n, sizeof *z->distance);
  z->owner = thr_calloc(n, sizeof *z->owner);
  z->odd_root = thr_calloc(n, sizeof *z->odd_root);
  z->radius = thr_calloc(n, sizeof *z->radius);
  z->order = thr_calloc(n, sizeof *z->order);
  z->heap = thr_calloc(2 * (size_t)p->n_edges + n, sizeof *z->heap);
  return z->distance && z->owner && z->odd_root && z->radius && z->order && z->heap ? THR_OK : thr_nomem(err);
}

static void voronoi_destroy(voronoi *z)
{
  free(z->distance);
  free(z->owner);
  free(z->odd_root);
  free(z->radius);
  free(z->order);
  free(z->heap);
}

/* Components of {e : x_e > threshold}; x NULL: single nodes. */
static void components(const thr_tjoin_problem *p, const double *x, double threshold, int *parent)
{
  for (int v = 0; v < p->n_nodes; v++)
    parent[v] = v;
  for (int e = 0; x && e < p->n_edges; e++)
    if (x[e] > threshold) thr_disjoint_join(parent, p->edge[e][0], p->edge[e][1]);
}

thr_status thr_oddcut_moats(const thr_oddcut_graph *g, const double *x, double threshold, const double *reduced_cost,
                            thr_oddcut_pool *pool, thr_err *err)
{
  const thr_tjoin_problem *p = g->p;
  size_t n = (size_t)p->n_nodes;
  voronoi z = {0};
  int *parent = thr_calloc(n, sizeof *parent), *start = thr_calloc(n + 2, sizeof *start),
      *by_owner = thr_calloc(n, sizeof *by_owner);
  thr_status st = parent && start && by_owner ? voronoi_init(&z, p, err) : thr_nomem(err);
  if (st) goto done;
  components(p, x, threshold, parent);
  for (int v = 0; v < p->n_nodes; v++)
    if (p->odd[v]) z.odd_root[thr_disjoint_find(parent, v)] ^= true;
  grow_balls(g, reduced_cost, parent, &z);
  bound_radii(p, reduced_cost, &z);
  for (int i = 0; i < z.settled; i++)
    start[z.owner[z.order[i]] + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int i = 0; i < z.settled; i++) {
    int owner = z.owner[z.order[i]];
    by_owner[start[owner + 1]++] = z.order[i];
  }
  st = add_balls(g, &z, start, by_owner, pool, err);
done:
  voronoi_destroy(&z);
  free(parent);
  free(start);
  free(by_owner);
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
  int *parent; /* disjoint sets over the tree without one edge */
  bool *side;  /* [n] */
} shrunk;

static void shrunk_destroy(shrunk *s)
{
  free(s->edge);
  free(s->capacity);
  free(s->tree);
  free(s->flow);
  free(s->parent);
  free(s->side);
}

static thr_status shrunk_init(shrunk *s, int n, int m, thr_err *err)
{
  size_t nodes = (size_t)n, edges = (size_t)m;
  *s = (shrunk){.edge = thr_calloc(edges, sizeof *s->edge),
                .capacity = thr_calloc(edges, sizeof *s->capacity),
                .tree = thr_calloc(nodes, sizeof *s->tree),
                .flow = thr_calloc(nodes, sizeof *s->flow),
                .parent = thr_calloc(nodes, sizeof *s->parent),
                .side = thr_calloc(nodes, sizeof *s->side)};
  return s->edge && s->capacity && s->tree && s->flow && s->parent && s->side ? THR_OK : thr_nomem(err);
}

/* Adds the side of tree edge i, in framework nodes: those whose shrunk node is still joined to tree[i][0]. */
static thr_status add_side(const thr_oddcut_graph *g, const shrunk *s, int i, const int *node, const int *shrunk_of, int n,
                           int *list, thr_oddcut_pool *pool, thr_err *err)
{
  for (int v = 0; v < s->n; v++)
    s->parent[v] = v;
  for (int k = 0; k < s->n - 1; k++)
    if (k != i) thr_disjoint_join(s->parent, s->tree[k][0], s->tree[k][1]);
  int root = thr_disjoint_find(s->parent, s->tree[i][0]), count = 0;
  for (int k = 0; k < n; k++)
    if (thr_disjoint_find(s->parent, shrunk_of[node[k]]) == root) list[count++] = node[k];
  return thr_oddcut_add(g, pool, list, count, err); /* ignores an even side */
}

/* node[0 .. n-1] is one component of the support; block[v] its contracted group; shrunk_of and list are scratch. */
static thr_status separate_component(const thr_oddcut_graph *g, const double *x, const int *node, int n, int *block,
                                     int *shrunk_of, int *list, thr_oddcut_pool *pool, thr_err *err)
{
  const thr_tjoin_problem *p = g->p;
  shrunk s;
  int ids = 0, degrees = 0;
  for (int i = 0; i < n; i++) {
    int root = thr_disjoint_find(block, node[i]);
    if (root == node[i]) shrunk_of[root] = ids++; /* a root is the lowest of its block, and node[] ascends */
    shrunk_of[node[i]] = shrunk_of[root];
    degrees += g->first[node[i] + 1] - g->first[node[i]];
  }
  /* The component itself, crossed by nothing: moats miss it where a tight edge of x = 0 leaves it. */
  if (n > 0) memcpy(list, node, (size_t)n * sizeof *list);
  thr_status st = thr_oddcut_add(g, pool, list, n, err); /* ignores an even one */
  if (st || ids < 2) return st;
  st = shrunk_init(&s, ids, degrees, err);
  s.n = ids;
  for (int i = 0; i < n && !st; i++)
    for (int k = g->first[node[i]]; k < g->first[node[i] + 1]; k++) {
      int e = g->incident[k], w = other_end(p, e, node[i]);
      if (w < node[i] || x[e] <= tolerance || shrunk_of[node[i]] == shrunk_of[w]) continue;
      s.edge[s.m][0] = shrunk_of[node[i]];
      s.edge[s.m][1] = shrunk_of[w];
      s.capacity[s.m++] = x[e];
    }
  if (!st) st = thr_cut_tree(s.n, s.m, (const int(*)[2])s.edge, s.capacity, s.tree, s.flow, err);
  for (int i = 0; i < s.n - 1 && !st; i++)
    if (s.flow[i] < 1 - tolerance) st = add_side(g, &s, i, node, shrunk_of, n, list, pool, err);
  shrunk_destroy(&s);
  return st;
}

thr_status thr_oddcut_exact(const thr_oddcut_graph *g, const double *x, thr_oddcut_pool *pool, thr_err *err)
{
  const thr_tjoin_problem *p = g->p;
  size_t n = (size_t)p->n_nodes;
  thr_status st = THR_OK;
  int *parent = thr_calloc(n, sizeof *parent), *block = thr_calloc(n, sizeof *block),
      *shrunk_of = thr_calloc(n, sizeof *shrunk_of);
  int *list = thr_calloc(n, sizeof *list), *start = thr_calloc(n + 2, sizeof *start), *node = thr_calloc(n, sizeof *node);
  if (!parent || !block || !shrunk_of || !list || !start || !node) {
    st = thr_nomem(err);
    goto done;
  }
  components(p, x, tolerance, parent);
  components(p, x, 1 - tolerance, block);
  for (int v = 0; v < p->n_nodes; v++)
    start[thr_disjoint_find(parent, v) + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int v = 0; v < p->n_nodes; v++)
    node[start[thr_disjoint_find(parent, v) + 1]++] = v;
  for (int root = 0; root < p->n_nodes && !st; root++)
    st = separate_component(g, x, node + start[root], start[root + 1] - start[root], block, shrunk_of, list, pool, err);
done:
  free(parent);
  free(block);
  free(shrunk_of);
  free(list);
  free(start);
  free(node);
  return st;
}
