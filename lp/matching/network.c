/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prepares a T-join problem for shortest paths: contracts edges of weight 0, and stores the arcs of
 * every contracted node, called a place, in one block. Repairs the parities of joins, and provides
 * the queue for Dijkstra's method.
 *
 * A place is odd if it holds an odd number of odd nodes. A T-join of the contracted graph becomes
 * one of the whole graph by edges of weight 0, so that the minima are the same.
 *
 * Example: in a triangle with weights 0, 3 and 4 the ends of the first edge become one place, with
 * two arcs of weight 3 and 4 to the third node. */
#include "lp/matching/blossom.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Contracts the edges of weight 0, and numbers the places by their lowest nodes. */
static void number_places(thr_network *net, int *parent)
{
  const thr_tjoin_problem *tjoin_problem = net->p;

  /* Join the ends of edges of weight 0. */
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    parent[v] = v;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (tjoin_problem->weight[e] == 0)
      thr_disjoint_join(parent, tjoin_problem->edge[e][0], tjoin_problem->edge[e][1]);

  /* The root of a place is its lowest node, which has its number before the others ask. */
  for (int v = 0; v < tjoin_problem->n_nodes; v++) {
    int root = thr_disjoint_find(parent, v);
    net->place[v] = root == v ? net->n_places++ : net->place[root];
  }
}

/* Computes the places of an edge's ends; says whether they are two. */
static bool between_places(const thr_network *net, int e, int place[2])
{
  place[0] = net->place[net->p->edge[e][0]];
  place[1] = net->place[net->p->edge[e][1]];
  return place[0] != place[1];
}

/* Stores the arcs of both directions by place. */
static thr_status fill_arcs(thr_network *net, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = net->p;
  int at[2];

  net->first = thr_scratch_array(&net->own, (size_t)net->n_places + 2, sizeof *net->first);
  if (!net->first) return thr_nomem(err);

  /* Count the arcs of every place, two places further on for the counting sort. */
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    if (!between_places(net, e, at)) continue;
    net->first[at[0] + 2]++;
    net->first[at[1] + 2]++;
    net->n_arcs += 2;
  }
  for (int v = 1; v <= net->n_places; v++)
    net->first[v + 1] += net->first[v];

  /* Fill the block; first[v + 1] moves to the end of the arcs of v. */
  net->arc = thr_scratch_array(&net->own, (size_t)net->n_arcs, sizeof *net->arc);
  if (!net->arc) return thr_nomem(err);
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    if (!between_places(net, e, at)) continue;
    net->arc[net->first[at[0] + 1]++] = (thr_arc){tjoin_problem->weight[e], at[1], e};
    net->arc[net->first[at[1] + 1]++] = (thr_arc){tjoin_problem->weight[e], at[0], e};
  }
  return THR_OK;
}

/* Lists the odd places in ascending order. */
static thr_status list_odd(thr_network *net, thr_err *err)
{
  net->number = thr_scratch_array(&net->own, (size_t)net->n_places, sizeof *net->number);
  net->odd = thr_scratch_array(&net->own, (size_t)net->n_places, sizeof *net->odd);
  thr_status st = thr_scratch_check(&net->own, err);
  if (st) return st;

  /* A place has the parity of the number of its odd nodes. */
  for (int v = 0; v < net->p->n_nodes; v++)
    net->number[net->place[v]] ^= net->p->odd[v];

  /* Replace the parities by positions in the list. */
  for (int v = 0; v < net->n_places; v++) {
    bool odd = net->number[v];
    net->number[v] = odd ? net->n_odd : -1;
    if (odd) net->odd[net->n_odd++] = v;
  }
  return THR_OK;
}

thr_status thr_network_init(thr_network *net, const thr_tjoin_problem *tjoin_problem, thr_err *err)
{
  *net = (thr_network){.p = tjoin_problem};
  int *parent = thr_scratch_array(&net->own, (size_t)tjoin_problem->n_nodes, sizeof *parent);
  net->place = thr_scratch_array(&net->own, (size_t)tjoin_problem->n_nodes, sizeof *net->place);

  thr_status st = thr_scratch_check(&net->own, err);
  if (!st) number_places(net, parent);
  if (!st) st = fill_arcs(net, err);
  if (!st) st = list_odd(net, err);

  if (st) thr_network_destroy(net);
  return st;
}

void thr_network_destroy(thr_network *net)
{
  thr_scratch_free(&net->own);
  *net = (thr_network){0};
}

/* ---- repairing the parities of a join ---- */

/* A forest, as the edges at every node, that is taken apart from the leaves inwards. */
typedef struct {
  int *degree, *stack; /* [n_nodes] */
  int *across; /* [n_nodes] xor of the forest's edges at a node, which at a leaf is the only one */
  bool *wrong; /* [n_nodes] does the parity of the join differ from that of T? */
} parity_forest;

/* An edge to be sorted. */
typedef struct {
  double key;
  int edge;
} keyed_edge;

/* Orders edges by key, then by number. */
static int by_key(const void *pa, const void *pb)
{
  const keyed_edge *a = pa, *b = pb;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  return (a->edge > b->edge) - (a->edge < b->edge);
}

thr_status thr_forest_find(const thr_tjoin_problem *tjoin_problem, const double *key, double most,
                           int n_leaves, int *edge, int *n, thr_err *err)
{
  const int n_nodes = tjoin_problem->n_nodes, first_leaf = n_nodes - n_leaves;
  thr_scratch own = {0};
  int *parent = thr_scratch_array(&own, (size_t)n_nodes, sizeof *parent), count = 0;
  bool *used = thr_scratch_array(&own, (size_t)n_nodes, sizeof *used);
  keyed_edge *list = thr_scratch_array(&own, (size_t)tjoin_problem->n_edges, sizeof *list);
  thr_status st = thr_scratch_check(&own, err);
  *n = 0;

  /* List the edges that may be used, the least key first. */
  for (int v = 0; v < n_nodes && !st; v++)
    parent[v] = v;
  for (int e = 0; e < tjoin_problem->n_edges && !st; e++) {
    double of = key ? key[e] : (double)tjoin_problem->weight[e];
    if (of <= most) list[count++] = (keyed_edge){of, e};
  }
  if (!st) qsort(list, (size_t)count, sizeof *list, by_key);

  /* Take each edge that closes no circuit and finds its leaves without an edge. */
  for (int k = 0; k < count && !st; k++) {
    const int *end = tjoin_problem->edge[list[k].edge];
    if ((end[0] >= first_leaf && used[end[0]]) || (end[1] >= first_leaf && used[end[1]])) continue;
    used[end[0]] = used[end[1]] = true;
    if (thr_disjoint_join(parent, end[0], end[1])) edge[(*n)++] = list[k].edge;
  }

  thr_scratch_free(&own);
  return st;
}

thr_status thr_network_tree_weight(const thr_tjoin_problem *tjoin_problem, double *weight,
                                   thr_err *err)
{
  int *edge = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *edge), n = 0;
  *weight = 0;
  thr_status st =
      edge ? thr_forest_find(tjoin_problem, NULL, INFINITY, 0, edge, &n, err) : thr_nomem(err);

  for (int k = 0; k < n && !st; k++)
    *weight += (double)tjoin_problem->weight[edge[k]];

  free(edge);
  return st;
}

/* Computes the wrong parities of a join, and the edges of a forest at every node. */
static void forest_init(const thr_tjoin_problem *tjoin_problem, const bool *in_join,
                        const int *edge, int n, parity_forest *forest)
{
  memcpy(forest->wrong, tjoin_problem->odd, (size_t)tjoin_problem->n_nodes * sizeof *forest->wrong);

  /* A node is wrong if it is odd and has an even degree in the join, or the other way round. */
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (in_join[e])
      forest->wrong[tjoin_problem->edge[e][0]] ^= true,
          forest->wrong[tjoin_problem->edge[e][1]] ^= true;

  /* The xor of the edges is enough to find the last one at a node. */
  for (int k = 0; k < n; k++)
    for (int i = 0; i < 2; i++) {
      int v = tjoin_problem->edge[edge[k]][i];
      forest->degree[v]++;
      forest->across[v] ^= edge[k];
    }
}

/* Repairs the parities of a join: a leaf of the forest with the wrong parity changes the edge
 * that is left there, and passes the wrong parity on to the other end. */
static void repair_parities(const thr_tjoin_problem *tjoin_problem, bool *in_join,
                            parity_forest *forest)
{
  int top = 0;

  /* Start with the leaves. */
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    if (forest->degree[v] == 1) forest->stack[top++] = v;

  while (top) {
    int v = forest->stack[--top], e = forest->across[v];
    if (forest->degree[v] == 0) continue; /* the last node of its tree */

    int inner =
        tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0];

    /* Change the edge if the leaf is wrong, and take the leaf off. */
    in_join[e] ^= forest->wrong[v];
    forest->wrong[inner] ^= forest->wrong[v];
    forest->across[inner] ^= e;
    if (--forest->degree[inner] == 1) forest->stack[top++] = inner;
  }
}

thr_status thr_forest_mend(const thr_tjoin_problem *tjoin_problem, const int *edge, int n_edges,
                           bool *in_join, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes;
  thr_scratch own = {0};
  parity_forest forest = {.degree = thr_scratch_array(&own, n, sizeof *forest.degree)};
  forest.stack = thr_scratch_array(&own, n, sizeof *forest.stack);
  forest.across = thr_scratch_array(&own, n, sizeof *forest.across);
  forest.wrong = thr_scratch_array(&own, n, sizeof *forest.wrong);

  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    forest_init(tjoin_problem, in_join, edge, n_edges, &forest);
    repair_parities(tjoin_problem, in_join, &forest);
  }

  thr_scratch_free(&own);
  return st;
}

thr_status thr_network_mend(const thr_network *net, bool any_weight, bool *in_join, thr_err *err)
{
  /* Without edges of weight 0 every place is one node, whose parity is right already. */
  if (!any_weight && net->n_places == net->p->n_nodes) return THR_OK;

  int *edge = thr_calloc((size_t)net->p->n_edges, sizeof *edge), n = 0;
  thr_status st = edge ? thr_forest_find(net->p, NULL, any_weight ? INFINITY : 0, 0, edge, &n, err)
                       : thr_nomem(err);
  if (!st) st = thr_forest_mend(net->p, edge, n, in_join, err);
  free(edge);
  return st;
}

/* ---- a queue for Dijkstra's method ---- */

thr_status thr_queue_push(thr_queue *q, thr_queued in, thr_err *err)
{
  /* Grow the heap. */
  thr_status st =
      q->count < q->capacity ? THR_OK : thr_grow(&q->entry, q->count, &q->capacity, sizeof in, err);
  if (st) return st;

  /* Move smaller ancestors down until there is a place for the new entry. */
  int at = q->count++;
  for (int above; at > 0 && q->entry[above = (at - 1) / 4].key < in.key; at = above)
    q->entry[at] = q->entry[above];
  q->entry[at] = in;
  return THR_OK;
}

thr_queued thr_queue_pop(thr_queue *q)
{
  thr_queued top = q->entry[0], last = q->entry[--q->count];
  int at = 0;

  /* Fill the hole at the top with the greatest of four children, until the last entry fits. */
  for (int child = 1; child < q->count; child = 4 * at + 1) {
    int most = child, end = child + 4 < q->count ? child + 4 : q->count;
    for (int other = child + 1; other < end; other++)
      if (q->entry[other].key > q->entry[most].key) most = other;
    if (q->entry[most].key <= last.key) break;
    q->entry[at] = q->entry[most];
    at = most;
  }

  q->entry[at] = last;
  return top;
}
