/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A T-join problem made ready for shortest paths: adjacency in one block, edges of weight 0
 * contracted. Internal to lp/.
 *
 * A contracted place is odd if it holds an odd number of odd nodes; joins of the contracted graph
 * and of the whole one have the same weight.
 *
 * Example: in a triangle with weights 0, 3 and 4 the ends of the first edge become one place, with
 * two arcs of weight 3 and 4 to the third node. */
#include "lp/matching/blossom.h"
#include "graph/disjoint.h"

#include <stdlib.h>
#include <string.h>

/* Numbers the places by their lowest node. */
static void number_places(thr_network *net, int *parent)
{
  const thr_tjoin_problem *tjoin_problem = net->p;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    parent[v] = v;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (tjoin_problem->weight[e] == 0)
      thr_disjoint_join(parent, tjoin_problem->edge[e][0], tjoin_problem->edge[e][1]);
  for (int v = 0; v < tjoin_problem->n_nodes; v++) {
    int root = thr_disjoint_find(parent, v); /* the lowest */
    net->place[v] = root == v ? net->n_places++ : net->place[root];
  }
}

static bool between_places(const thr_network *net, int e, int place[2])
{
  place[0] = net->place[net->p->edge[e][0]];
  place[1] = net->place[net->p->edge[e][1]];
  return place[0] != place[1];
}

static thr_status fill_arcs(thr_network *net, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = net->p;
  int at[2];
  net->first = thr_scratch_array(&net->own, (size_t)net->n_places + 2, sizeof *net->first);
  if (!net->first) return thr_nomem(err);
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    if (!between_places(net, e, at)) continue;
    net->first[at[0] + 2]++;
    net->first[at[1] + 2]++;
    net->n_arcs += 2;
  }
  for (int v = 1; v <= net->n_places; v++)
    net->first[v + 1] += net->first[v];
  net->arc = thr_scratch_array(&net->own, (size_t)net->n_arcs, sizeof *net->arc);
  if (!net->arc) return thr_nomem(err);
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    if (!between_places(net, e, at)) continue;
    net->arc[net->first[at[0] + 1]++] = (thr_arc){tjoin_problem->weight[e], at[1], e};
    net->arc[net->first[at[1] + 1]++] = (thr_arc){tjoin_problem->weight[e], at[0], e};
  }
  return THR_OK;
}

static thr_status list_odd(thr_network *net, thr_err *err)
{
  net->number = thr_scratch_array(&net->own, (size_t)net->n_places, sizeof *net->number);
  net->odd = thr_scratch_array(&net->own, (size_t)net->n_places, sizeof *net->odd);
  thr_status st = thr_scratch_check(&net->own, err);
  if (st) return st;
  for (int v = 0; v < net->p->n_nodes; v++)
    net->number[net->place[v]] ^= net->p->odd[v];
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

/* ---- mending a join ---- */

/* A forest as its edges at each node, taken from the leaves inwards: a node with the wrong parity
 * passes that on. */
typedef struct {
  int *degree, *stack; /* [n_nodes] */
  int *across; /* [n_nodes] xor of the forest's edges at a node: of a leaf it is the only one */
  bool *wrong; /* [n_nodes] parity of the join is not that of T */
} forest;

typedef struct {
  int64_t weight;
  int edge;
} weighed;

static int by_weight(const void *pa, const void *pb)
{
  const weighed *a = pa, *b = pb;
  if (a->weight != b->weight) return a->weight < b->weight ? -1 : 1;
  return (a->edge > b->edge) - (a->edge < b->edge);
}

/* A lightest spanning forest, of all edges or of those of weight 0. *edge is allocated, *n of them.
 */
static thr_status find_forest(const thr_tjoin_problem *tjoin_problem, bool any_weight, int **edge,
                              int *n, thr_err *err)
{
  int *parent = thr_calloc((size_t)tjoin_problem->n_nodes, sizeof *parent), count = 0;
  weighed *list = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *list);
  *n = 0;
  *edge = thr_calloc((size_t)tjoin_problem->n_nodes, sizeof **edge);
  thr_status st = parent && list && *edge ? THR_OK : thr_nomem(err);
  for (int v = 0; v < tjoin_problem->n_nodes && !st; v++)
    parent[v] = v;
  for (int e = 0; e < tjoin_problem->n_edges && !st; e++)
    if (any_weight || tjoin_problem->weight[e] == 0)
      list[count++] = (weighed){tjoin_problem->weight[e], e};
  if (!st) qsort(list, (size_t)count, sizeof *list, by_weight);
  for (int k = 0; k < count && !st; k++) {
    const int *end = tjoin_problem->edge[list[k].edge];
    if (thr_disjoint_join(parent, end[0], end[1])) (*edge)[(*n)++] = list[k].edge;
  }
  free(parent);
  free(list);
  return st;
}

thr_status thr_network_tree_weight(const thr_tjoin_problem *tjoin_problem, double *weight,
                                   thr_err *err)
{
  int *edge, n;
  *weight = 0;
  thr_status st = find_forest(tjoin_problem, true, &edge, &n, err);
  for (int k = 0; k < n && !st; k++)
    *weight += (double)tjoin_problem->weight[edge[k]];
  free(edge);
  return st;
}

static void stand(const thr_tjoin_problem *tjoin_problem, const bool *in_join, const int *edge,
                  int n, forest *f)
{
  memcpy(f->wrong, tjoin_problem->odd, (size_t)tjoin_problem->n_nodes * sizeof *f->wrong);
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (in_join[e])
      f->wrong[tjoin_problem->edge[e][0]] ^= true, f->wrong[tjoin_problem->edge[e][1]] ^= true;
  for (int k = 0; k < n; k++)
    for (int i = 0; i < 2; i++) {
      int v = tjoin_problem->edge[edge[k]][i];
      f->degree[v]++;
      f->across[v] ^= edge[k];
    }
}

static void pass_on(const thr_tjoin_problem *tjoin_problem, bool *in_join, forest *f)
{
  int top = 0;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    if (f->degree[v] == 1) f->stack[top++] = v;
  while (top) {
    int v = f->stack[--top], e = f->across[v];
    if (f->degree[v] == 0) continue; /* the last of its tree */
    int w = tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0];
    in_join[e] ^= f->wrong[v];
    f->wrong[w] ^= f->wrong[v];
    f->across[w] ^= e;
    if (--f->degree[w] == 1) f->stack[top++] = w;
  }
}

thr_status thr_network_mend(const thr_network *net, bool any_weight, bool *in_join, thr_err *err)
{
  size_t n = (size_t)net->p->n_nodes;
  if (!any_weight && net->n_places == net->p->n_nodes) return THR_OK;
  thr_scratch own = {0};
  forest f = {.degree = thr_scratch_array(&own, n, sizeof *f.degree)};
  f.stack = thr_scratch_array(&own, n, sizeof *f.stack);
  f.across = thr_scratch_array(&own, n, sizeof *f.across);
  f.wrong = thr_scratch_array(&own, n, sizeof *f.wrong);
  int *edge = NULL, n_edges = 0;
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = find_forest(net->p, any_weight, &edge, &n_edges, err);
  if (!st) {
    stand(net->p, in_join, edge, n_edges, &f);
    pass_on(net->p, in_join, &f);
  }
  free(edge);
  thr_scratch_free(&own);
  return st;
}

/* ---- queue ---- */

thr_status thr_queue_push(thr_queue *q, thr_queued in, thr_err *err)
{
  thr_status st =
      q->count < q->capacity ? THR_OK : thr_grow(&q->entry, q->count, &q->capacity, sizeof in, err);
  if (st) return st;
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
  for (int child = 1; child < q->count; child = 4 * at + 1) {
    int most = child, end = child + 4 < q->count ? child + 4 : q->count;
    for (int c = child + 1; c < end; c++)
      if (q->entry[c].key > q->entry[most].key) most = c;
    if (q->entry[most].key <= last.key) break;
    q->entry[at] = q->entry[most];
    at = most;
  }
  q->entry[at] = last;
  return top;
}
