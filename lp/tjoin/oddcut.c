/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates odd-cut inequalities: finds sets S of nodes, with an odd number of odd nodes in them,
 * such that a fractional point x has x(edges that leave S) < 1, which is less than any T-join has.
 * An odd set cannot be paired up inside, so that at least one edge of a T-join leaves the set.
 *
 * The heuristic separation grows a ball round every odd component of the support until balls
 * meet. The exact one computes a Gomory-Hu tree of the support (Padberg & Rao, Mathematics of
 * Operations Research 7, 1982): among the edges of such a tree of minimum cuts with an odd number
 * of odd nodes on either side, the lightest is a minimum odd cut. Every set becomes a row of a
 * pool, with the nodes of its smaller side as the row's members:
 *
 *   thr_oddcuts odd = {.graph = &graph, .x = x, .reduced_cost = cost, .threshold = {0.5},
 *                      .pool = &pool};
 *   thr_search_use(&search, thr_oddcuts_moats, &odd, 0);
 *   thr_search_use(&search, thr_oddcuts_exact, &odd, THR_FALLBACK);
 *
 * Example: a triangle of odd nodes with x = 1/4 on the edges that leave it, one at each node, is
 * violated, because 3/4 < 1. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "lp/tjoin/tjoin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* On x; far below the 1/2 and 1/3 that vertices of these polyhedra show. */
static const double tolerance = 1e-6;

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

  /* List the edges at every node: count them two places further on, add up, fill. */
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      graph->first[tjoin_problem->edge[e][i] + 2]++;
  for (size_t v = 1; v <= n; v++)
    graph->first[v + 1] += graph->first[v];
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      graph->incident[graph->first[tjoin_problem->edge[e][i] + 1]++] = e;

  /* A set is named by the xor of its members' random keys. */
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

/* Returns the end of edge e that is not v. */
static int other_end(const thr_tjoin_problem *tjoin_problem, int e, int v)
{
  return tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0];
}

/* ---- rows ---- */

/* Puts the edges that leave the n nodes marked in graph->member; returns the right side of their
 * row. */
static double put_crossing(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n)
{
  /* Edges inside the set have both ends marked and are left out. */
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

/* Adds the row of the marked nodes to the pool. Its members are the nodes of the smaller side of
 * the cut, ascending; of equal sides the one without node 0. */
static thr_status add_row(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n,
                          uint64_t name, thr_err *err)
{
  const int n_nodes = graph->p->n_nodes;
  bool flip = 2 * n > n_nodes || (2 * n == n_nodes && graph->member[0]);
  int size = flip ? n_nodes - n : n, *side = thr_calloc((size_t)size, sizeof *side);
  if (!side) return thr_nomem(err);

  /* Copy the smaller side. */
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
  /* Name the set and count its odd nodes. */
  uint64_t name = 0;
  bool odd = false;
  for (int i = 0; i < n; i++) {
    name ^= graph->key[node[i]];
    odd ^= graph->p->odd[node[i]];
  }

  /* The set and its complement are one cut, which gets the smaller one of their names. */
  if (!odd) return THR_OK;
  if ((name ^ graph->all) < name) name ^= graph->all;
  if (thr_pool_knows(pool, name)) return THR_OK;

  /* Mark the members for as long as the row is being put together. */
  for (int i = 0; i < n; i++)
    graph->member[node[i]] = true;
  thr_status st = add_row(graph, pool, node, n, name, err);
  for (int i = 0; i < n; i++)
    graph->member[node[i]] = false;
  return st;
}

/* ---- moats ---- */

/* A node with the length of a path to it. */
typedef struct {
  double distance;
  int node;
} reached_node;

/* A binary heap, least distance first. */
typedef struct {
  reached_node *heap;
  int count;
} node_queue;

/* Orders by distance; ties go to the lower node, so that results do not depend on the heap. */
static bool nearer(reached_node a, reached_node b)
{
  return a.distance < b.distance || (a.distance == b.distance && a.node < b.node);
}

/* Puts a node into the queue. */
static void push(node_queue *queue, reached_node entry)
{
  /* Move larger ancestors down until there is a place for the new entry. */
  int i = queue->count++;
  for (; i > 0 && nearer(entry, queue->heap[(i - 1) / 2]); i = (i - 1) / 2)
    queue->heap[i] = queue->heap[(i - 1) / 2];
  queue->heap[i] = entry;
}

/* Takes the nearest node out of the queue. */
static reached_node pop(node_queue *queue)
{
  reached_node top = queue->heap[0], last = queue->heap[--queue->count];

  /* Fill the hole at the top with smaller children until there is a place for the last entry. */
  int i = 0;
  for (int child; (child = 2 * i + 1) < queue->count; i = child) {
    if (child + 1 < queue->count && nearer(queue->heap[child + 1], queue->heap[child])) child++;
    if (!nearer(queue->heap[child], last)) break;
    queue->heap[i] = queue->heap[child];
  }

  queue->heap[i] = last;
  return top;
}

/* The Voronoi diagram of the odd components under the reduced costs, by Dijkstra's method from all
 * of them at once. */
typedef struct {
  double *distance;   /* [n] to the nearest odd component */
  int *owner;         /* [n] root of the component whose ball reaches the node first, -1 = none */
  bool *odd_root;     /* [n] is the component with this root odd? */
  double *radius;     /* [n] by root: how far its ball may grow */
  int *order;         /* [settled] nodes by distance */
  int settled;        /* number of nodes reached */
  reached_node *heap; /* [2 * n_edges + n] */
  thr_scratch own;    /* the arrays */
} voronoi_diagram;

/* Computes distances and owners of all nodes. */
static void grow_balls(const thr_oddcut_graph *graph, const double *reduced_cost, int *parent,
                       voronoi_diagram *voronoi)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  node_queue queue = {voronoi->heap, 0};

  /* All nodes of odd components are at distance 0. */
  for (int v = 0; v < tjoin_problem->n_nodes; v++) {
    int root = thr_disjoint_find(parent, v);
    voronoi->owner[v] = voronoi->odd_root[root] ? root : -1;
    voronoi->distance[v] = voronoi->odd_root[root] ? 0 : INFINITY;
    voronoi->radius[v] = INFINITY;
    if (voronoi->odd_root[root]) push(&queue, (reached_node){0, v});
  }

  /* Settle nodes in order of distance. */
  voronoi->settled = 0;
  while (queue.count) {
    reached_node nearest = pop(&queue);
    int v = nearest.node;

    /* An entry that a shorter path has overtaken is skipped. */
    if (nearest.distance > voronoi->distance[v]) continue;
    voronoi->order[voronoi->settled++] = v;

    /* Relax the edges at v. Reduced costs may be negative by rounding. */
    for (int k = graph->first[v]; k < graph->first[v + 1]; k++) {
      int e = graph->incident[k], other = other_end(tjoin_problem, e, v);
      double through = nearest.distance + fmax(reduced_cost[e], 0);
      if (through < voronoi->distance[other]) {
        voronoi->distance[other] = through;
        voronoi->owner[other] = voronoi->owner[v];
        push(&queue, (reached_node){through, other});
      }
    }
  }
}

/* Bounds the radius of every ball so that balls may touch but not overlap: half the shortest
 * path between two components is the most that either of them may grow. */
static void bound_radii(const thr_tjoin_problem *tjoin_problem, const double *reduced_cost,
                        voronoi_diagram *voronoi)
{
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    /* An edge between two cells closes a path between their components. */
    int u = tjoin_problem->edge[e][0], v = tjoin_problem->edge[e][1];
    if (voronoi->owner[u] == voronoi->owner[v] || voronoi->owner[u] < 0 || voronoi->owner[v] < 0)
      continue;
    double half = (voronoi->distance[u] + fmax(reduced_cost[e], 0) + voronoi->distance[v]) / 2;
    for (int i = 0; i < 2; i++) {
      double *radius = &voronoi->radius[voronoi->owner[tjoin_problem->edge[e][i]]];
      if (half < *radius) *radius = half;
    }
  }
}

/* Adds the balls of every component as rows. The nodes of one owner come in order of distance,
 * so that every prefix that ends before a node farther away is a ball. */
static thr_status add_balls(const thr_oddcut_graph *graph, const voronoi_diagram *voronoi,
                            const int *start, const int *by_owner, thr_pool *pool, thr_err *err)
{
  thr_status st = THR_OK;
  int *prefix = thr_calloc((size_t)graph->p->n_nodes, sizeof *prefix);
  if (!prefix) return thr_nomem(err);
  for (int root = 0; root < graph->p->n_nodes && !st; root++) {
    const int *node = by_owner + start[root];
    int n = start[root + 1] - start[root];

    /* Distances this close are equal: edges inside even components cost rounding. */
    double near = 1e-9 * (1 + voronoi->radius[root]);

    for (int i = 0; i < n && !st; i++) {
      prefix[i] = node[i];
      double next = i + 1 < n ? voronoi->distance[node[i + 1]] : INFINITY;

      /* Stop at the radius; a node at the same distance as the next one ends no ball. */
      if (voronoi->distance[node[i]] > voronoi->radius[root] + near) break;
      if (next - voronoi->distance[node[i]] > near)
        st = thr_oddcut_add(graph, pool, prefix, i + 1, err);
    }
  }

  free(prefix);
  return st;
}

/* Allocates the arrays for the nodes and edges of a problem. */
static thr_status voronoi_init(voronoi_diagram *voronoi, const thr_tjoin_problem *tjoin_problem,
                               thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes;
  voronoi->distance = thr_scratch_array(&voronoi->own, n, sizeof *voronoi->distance);
  voronoi->owner = thr_scratch_array(&voronoi->own, n, sizeof *voronoi->owner);
  voronoi->odd_root = thr_scratch_array(&voronoi->own, n, sizeof *voronoi->odd_root);
  voronoi->radius = thr_scratch_array(&voronoi->own, n, sizeof *voronoi->radius);
  voronoi->order = thr_scratch_array(&voronoi->own, n, sizeof *voronoi->order);
  voronoi->heap = thr_scratch_array(&voronoi->own, 2 * (size_t)tjoin_problem->n_edges + n,
                                    sizeof *voronoi->heap);
  return thr_scratch_check(&voronoi->own, err);
}

/* Joins the components of the support {e : x_e > threshold} in parent; x NULL: single nodes. */
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
  voronoi_diagram voronoi = {0};
  int *parent = thr_scratch_array(&own, n, sizeof *parent),
      *start = thr_scratch_array(&own, n + 2, sizeof *start),
      *by_owner = thr_scratch_array(&own, n, sizeof *by_owner);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = voronoi_init(&voronoi, tjoin_problem, err);
  if (st) goto done;

  /* Find the odd components and grow their balls. */
  components(tjoin_problem, x, threshold, parent);
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    if (tjoin_problem->odd[v]) voronoi.odd_root[thr_disjoint_find(parent, v)] ^= true;
  grow_balls(graph, reduced_cost, parent, &voronoi);
  bound_radii(tjoin_problem, reduced_cost, &voronoi);

  /* Sort the nodes by owner and, for one owner, by distance (a counting sort). */
  for (int i = 0; i < voronoi.settled; i++)
    start[voronoi.owner[voronoi.order[i]] + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int i = 0; i < voronoi.settled; i++) {
    int owner = voronoi.owner[voronoi.order[i]];
    by_owner[start[owner + 1]++] = voronoi.order[i];
  }

  st = add_balls(graph, &voronoi, start, by_owner, pool, err);
done:
  thr_scratch_free(&voronoi.own);
  thr_scratch_free(&own);
  return st;
}

/* ---- exact separation ---- */

/* One component of the support, with edges of x >= 1 contracted, and its Gomory-Hu tree. */
typedef struct {
  int n_nodes, n_edges;
  int (*edge)[2];   /* [n_edges] */
  double *capacity; /* [n_edges] the x of an edge */
  int (*tree)[2];   /* [n_nodes - 1] edges of the Gomory-Hu tree */
  double *flow;     /* [n_nodes - 1] capacity of the minimum cut between their ends */
  int *parent;      /* disjoint sets over the tree without one edge */
  bool *side;       /* [n_nodes] */
  thr_scratch own;  /* the arrays */
} contracted_support;

/* Allocates for n nodes and m edges. */
static thr_status support_init(contracted_support *support, int n, int m, thr_err *err)
{
  size_t nodes = (size_t)n, edges = (size_t)m;
  *support = (contracted_support){0};
  support->edge = thr_scratch_array(&support->own, edges, sizeof *support->edge);
  support->capacity = thr_scratch_array(&support->own, edges, sizeof *support->capacity);
  support->tree = thr_scratch_array(&support->own, nodes, sizeof *support->tree);
  support->flow = thr_scratch_array(&support->own, nodes, sizeof *support->flow);
  support->parent = thr_scratch_array(&support->own, nodes, sizeof *support->parent);
  support->side = thr_scratch_array(&support->own, nodes, sizeof *support->side);
  return thr_scratch_check(&support->own, err);
}

/* Adds the set of framework nodes on one side of tree edge i: the nodes whose contracted node is
 * still joined to tree[i][0] when the edge is taken out. Sets that are not odd are ignored. */
static thr_status add_side(const thr_oddcut_graph *graph, const contracted_support *support, int i,
                           const int *node, const int *contracted_of, int n, int *list,
                           thr_pool *pool, thr_err *err)
{
  /* Join the ends of all other tree edges. */
  for (int v = 0; v < support->n_nodes; v++)
    support->parent[v] = v;
  for (int k = 0; k < support->n_nodes - 1; k++)
    if (k != i) thr_disjoint_join(support->parent, support->tree[k][0], support->tree[k][1]);

  /* Collect the nodes on the side of tree[i][0]. */
  int root = thr_disjoint_find(support->parent, support->tree[i][0]), count = 0;
  for (int k = 0; k < n; k++)
    if (thr_disjoint_find(support->parent, contracted_of[node[k]]) == root) list[count++] = node[k];

  return thr_oddcut_add(graph, pool, list, count, err);
}

/* Separates exactly in one component of the support, the nodes node[0 .. n - 1], ascending.
 * block[v]: disjoint sets of the edges to be contracted. contracted_of and list are scratch
 * space for n_nodes entries. */
static thr_status separate_component(const thr_oddcut_graph *graph, const double *x,
                                     const int *node, int n, int *block, int *contracted_of,
                                     int *list, thr_pool *pool, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  contracted_support support;
  int ids = 0, degrees = 0;

  /* Number the contracted nodes. A root is the lowest node of its block, so its number is known
   * before the other nodes of the block ask for it. */
  for (int i = 0; i < n; i++) {
    int root = thr_disjoint_find(block, node[i]);
    if (root == node[i]) contracted_of[root] = ids++;
    contracted_of[node[i]] = contracted_of[root];
    degrees += graph->first[node[i] + 1] - graph->first[node[i]];
  }

  /* The component itself is left by no edge of the support. Balls do not find it where an edge with
   * x = 0 and reduced cost 0 leaves it. Even components are ignored. */
  if (n > 0) memcpy(list, node, (size_t)n * sizeof *list);
  thr_status st = thr_oddcut_add(graph, pool, list, n, err);

  if (st || ids < 2) return st;

  /* List the edges between contracted nodes, each once, with x as capacity. */
  st = support_init(&support, ids, degrees, err);
  support.n_nodes = ids;
  for (int i = 0; i < n && !st; i++)
    for (int k = graph->first[node[i]]; k < graph->first[node[i] + 1]; k++) {
      int e = graph->incident[k], other = other_end(tjoin_problem, e, node[i]);
      if (other < node[i] || x[e] <= tolerance || contracted_of[node[i]] == contracted_of[other])
        continue;
      support.edge[support.n_edges][0] = contracted_of[node[i]];
      support.edge[support.n_edges][1] = contracted_of[other];
      support.capacity[support.n_edges++] = x[e];
    }

  /* A Gomory-Hu tree holds a minimum cut for every pair of nodes, and a minimum odd cut. */
  if (!st)
    st = thr_cut_tree(support.n_nodes, support.n_edges, (const int(*)[2])support.edge,
                      support.capacity, support.tree, support.flow, err);
  for (int i = 0; i < support.n_nodes - 1 && !st; i++)
    if (support.flow[i] < 1 - tolerance)
      st = add_side(graph, &support, i, node, contracted_of, n, list, pool, err);

  thr_scratch_free(&support.own);
  return st;
}

/* Separates exactly: adds the odd cuts with x(cut) < 1 of a Gomory-Hu tree of every component of
 * the support. If any odd cut is violated, one of these is (Padberg & Rao 1982). Edges with x >= 1
 * lie in no violated cut and are contracted first. */
static thr_status oddcut_exact(const thr_oddcut_graph *graph, const double *x, thr_pool *pool,
                               thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = graph->p;
  size_t n = (size_t)tjoin_problem->n_nodes;
  thr_scratch own = {0};
  int *parent = thr_scratch_array(&own, n, sizeof *parent),
      *block = thr_scratch_array(&own, n, sizeof *block),
      *contracted_of = thr_scratch_array(&own, n, sizeof *contracted_of);
  int *list = thr_scratch_array(&own, n, sizeof *list),
      *start = thr_scratch_array(&own, n + 2, sizeof *start),
      *node = thr_scratch_array(&own, n, sizeof *node);
  thr_status st = thr_scratch_check(&own, err);
  if (st) goto done;

  /* Find the components of the support, and the blocks to be contracted: edges with x >= 1 lie
   * in no violated cut. */
  components(tjoin_problem, x, tolerance, parent);
  components(tjoin_problem, x, 1 - tolerance, block);

  /* Sort the nodes by component; within one they stay in ascending order. */
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    start[thr_disjoint_find(parent, v) + 2]++;
  for (size_t v = 1; v <= n; v++)
    start[v + 1] += start[v];
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    node[start[thr_disjoint_find(parent, v) + 1]++] = v;

  for (int root = 0; root < tjoin_problem->n_nodes && !st; root++)
    st = separate_component(graph, x, node + start[root], start[root + 1] - start[root], block,
                            contracted_of, list, pool, err);
done:
  thr_scratch_free(&own);
  return st;
}

/* ---- for a search ---- */

/* Counts the rows from number first on, and drops those that odd->point satisfies. */
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

  /* Each further threshold leaves fewer edges in the support. The first one that gives rows is
   * enough. */
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
  thr_status st = oddcut_exact(odd->graph, odd->x, odd->pool, err);
  return st ? st : keep(odd, first, added, err);
}
