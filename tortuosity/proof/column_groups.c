/* Groups: components of the support, and minimum cuts by augmenting paths. */
#include "tortuosity/proof/column_groups.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/sort.h"
#include "lp/model/pool.h"
#include "tortuosity/proof/relax.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6;

static int end_node(const thr_turning_columns *turning_columns, int column)
{
  return turning_columns->f->n_edges + turning_columns->component[thr_tail(turning_columns->f, turning_columns->half[column][0])];
}

/* The two edges (or an edge and the ends of its component, numbered after the edges) that a column joins; false for others. */
static bool joins(const thr_turning_columns *turning_columns, int j, int *a, int *b)
{
  if (j >= turning_columns->first_back || (j >= turning_columns->first_extra && j < turning_columns->first_end)) return false;
  *a = turning_columns->half[j][0] >> 1;
  *b = j < turning_columns->first_extra ? turning_columns->half[j][1] >> 1 : end_node(turning_columns, j);
  return true;
}

/* ---- rows ---- */

/* Puts the columns that leave the edges of a group, which are marked. */
static void put_crossing(thr_relax *relax, const int *edge, int n, const bool *inside)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  for (int k = 0; k < 2 * n; k++) {
    int h = 2 * edge[k / 2] + k % 2, v = thr_tail(frame, h);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      if (!inside[frame->half[i] >> 1])
        thr_pool_put(&relax->search.pool, thr_turning_column(turning_columns, h, frame->half[i]), 1);
    if (turning_columns->end_column[h] >= 0) thr_pool_put(&relax->search.pool, turning_columns->end_column[h], 1);
  }
}

/* Adds the group's row if x violates it and it is new. */
static thr_status add_group(thr_relax *relax, const int *edge, int n, int *added, thr_err *err)
{
  thr_scratch own = {0};
  bool *inside = thr_scratch_array(&own, (size_t)relax->c->f->n_edges, sizeof *inside);
  int *group = thr_scratch_array(&own, (size_t)n, sizeof *group);
  thr_status st = thr_scratch_check(&own, err);
  for (int i = 0; i < n && !st; i++)
    inside[group[i] = edge[i]] = true;
  if (!st) {
    thr_sort_ints(group, (size_t)n);
    put_crossing(relax, group, n, inside);
    const thr_row row = {.kind = THR_RELAX_GROUP, .lower = 2, .member = group, .n_members = n};
    st = thr_pool_offer(&relax->search.pool, row, relax->x, tolerance, added, err);
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- components ---- */

/* Groups that turns with x > threshold join. */
static thr_status find_groups(thr_relax *relax, double threshold, int *added, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int m = turning_columns->f->n_edges, n = m + turning_columns->n_components, a, b;
  thr_scratch own = {0};
  int *parent = thr_scratch_array(&own, (size_t)n, sizeof *parent),
      *start = thr_scratch_array(&own, (size_t)n + 2, sizeof *start);
  int *list = thr_scratch_array(&own, (size_t)m, sizeof *list),
      *pieces = thr_scratch_array(&own, (size_t)turning_columns->n_components, sizeof *pieces);
  thr_status st = thr_scratch_check(&own, err);
  for (int v = 0; v < n && !st; v++)
    parent[v] = v;
  for (int j = 0; j < turning_columns->first_back && !st; j++)
    if (joins(turning_columns, j, &a, &b) && relax->x[j] > threshold) thr_disjoint_join(parent, a, b);
  for (int e = 0; e < m && !st; e++) {
    int root = thr_disjoint_find(parent, e);
    start[root + 2]++;
    pieces[turning_columns->component[turning_columns->f->edge[e][0]]] +=
        root == e; /* the lowest is the root: an edge, not the ends */
  }
  for (int v = 1; v <= n && !st; v++)
    start[v + 1] += start[v];
  for (int e = 0; e < m && !st; e++)
    list[start[thr_disjoint_find(parent, e) + 1]++] = e;
  for (int e = 0; e < m && !st; e++) {
    int k = turning_columns->component[turning_columns->f->edge[e][0]];
    bool alone = pieces[k] == 1;
    if (thr_disjoint_find(parent, e) != e || alone) continue;
    st = add_group(relax, list + start[e], start[e + 1] - start[e], added, err);
  }
  thr_scratch_free(&own);
  return st;
}

thr_status thr_groups_apart(void *user, int *added, thr_err *err)
{
  return find_groups(user, tolerance, added, err);
}

thr_status thr_groups_loose(void *user, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  for (double threshold = 0.2; !st && !*added && threshold < 1; threshold += 0.25)
    st = find_groups(user, threshold, added, err);
  return st;
}

/* ---- flows ---- */

typedef struct {
  int n, m;
  int *first, *arc, *to; /* arcs leaving v: arc[first[v] .. first[v + 1] - 1]; arc a goes to to[a]; a ^ 1 goes back */
  double *capacity, *flow;
  int *block; /* disjoint sets: a root is one node of the shrunk graph */
  int *next;  /* circular list of the nodes of a block */
  int *by, *queue;
  int *list;
  thr_scratch own; /* the arrays */
} network;

static thr_status network_init(network *w, const thr_relax *relax, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int links = 0, a, b;
  for (int j = 0; j < turning_columns->first_back; j++)
    links += joins(turning_columns, j, &a, &b) && relax->x[j] > 1e-9;
  *w = (network){.n = turning_columns->f->n_edges + turning_columns->n_components, .m = 2 * links};
  size_t n = (size_t)w->n, m = (size_t)w->m;
  w->first = thr_scratch_array(&w->own, n + 2, sizeof *w->first);
  w->arc = thr_scratch_array(&w->own, m, sizeof *w->arc);
  w->to = thr_scratch_array(&w->own, m, sizeof *w->to);
  w->capacity = thr_scratch_array(&w->own, m, sizeof *w->capacity);
  w->flow = thr_scratch_array(&w->own, m, sizeof *w->flow);
  w->block = thr_scratch_array(&w->own, n, sizeof *w->block);
  w->next = thr_scratch_array(&w->own, n, sizeof *w->next);
  w->by = thr_scratch_array(&w->own, n, sizeof *w->by);
  w->queue = thr_scratch_array(&w->own, n, sizeof *w->queue);
  w->list = thr_scratch_array(&w->own, n, sizeof *w->list);
  if (thr_scratch_check(&w->own, err)) return THR_ENOMEM;
  for (int j = 0, k = 0; j < turning_columns->first_back; j++) {
    if (!joins(turning_columns, j, &a, &b) || relax->x[j] <= 1e-9) continue;
    w->to[k] = b;
    w->to[k + 1] = a;
    w->capacity[k] = w->capacity[k + 1] = relax->x[j];
    w->first[a + 2]++;
    w->first[b + 2]++;
    k += 2;
  }
  for (int v = 1; v <= w->n; v++)
    w->first[v + 1] += w->first[v];
  for (int k = 0; k < w->m; k++)
    w->arc[w->first[w->to[k ^ 1] + 1]++] = k;
  for (int v = 0; v < w->n; v++)
    w->block[v] = w->next[v] = v;
  return THR_OK;
}

static void merge(network *w, int a, int b)
{
  if (!thr_disjoint_join(w->block, a, b)) return;
  int swap = w->next[a];
  w->next[a] = w->next[b];
  w->next[b] = swap;
}

/* Breadth-first search over arcs with room from the block of s; by[root] = the arc that reached it. True if t is reached. */
static bool reach(network *w, int s, int t, int *reached)
{
  int head = 0, tail = 0;
  for (int v = 0; v < w->n; v++)
    w->by[v] = -1;
  w->by[w->queue[tail++] = s] = -2;
  while (head < tail) {
    int root = w->queue[head++], v = root;
    do {
      for (int i = w->first[v]; i < w->first[v + 1]; i++) {
        int a = w->arc[i], to = thr_disjoint_find(w->block, w->to[a]);
        if (w->by[to] != -1 || w->capacity[a] - w->flow[a] < 1e-9) continue;
        w->by[to] = a;
        w->queue[tail++] = to;
        if (to == t) return true;
      }
      v = w->next[v];
    } while (v != root);
  }
  *reached = tail;
  return false;
}

static double augment(network *w, int s, int t)
{
  double room = INFINITY;
  for (int v = t; v != s; v = thr_disjoint_find(w->block, w->to[w->by[v] ^ 1]))
    room = fmin(room, w->capacity[w->by[v]] - w->flow[w->by[v]]);
  for (int v = t; v != s; v = thr_disjoint_find(w->block, w->to[w->by[v] ^ 1])) {
    w->flow[w->by[v]] += room;
    w->flow[w->by[v] ^ 1] -= room;
  }
  return room;
}

/* A flow from t's block to the root's; tells of the group on t's side if it is less than 2. */
static thr_status separate_from(network *w, thr_relax *relax, int t, int root, int *added, thr_err *err)
{
  double total = 0;
  int reached = 0, n = 0;
  memset(w->flow, 0, (size_t)w->m * sizeof *w->flow);
  while (total < 2 - tolerance) {
    if (!reach(w, t, root, &reached)) break;
    total += augment(w, t, root);
  }
  if (total >= 2 - tolerance) return THR_OK;
  for (int i = 0; i < reached; i++) {
    int v = w->queue[i];
    do {
      if (v < relax->c->f->n_edges) w->list[n++] = v;
      v = w->next[v];
    } while (v != w->queue[i]);
  }
  return add_group(relax, w->list, n, added, err);
}

thr_status thr_groups_exact(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  enum { ENOUGH = 100 };
  const thr_turning_columns *turning_columns = relax->c;
  network w;
  int m = turning_columns->f->n_edges;
  thr_status st = network_init(&w, relax, err);
  int *root = thr_scratch_array(&w.own, (size_t)turning_columns->n_components, sizeof *root);
  if (!st) st = thr_scratch_check(&w.own, err);
  for (int k = 0; k < w.m && !st; k += 2)
    if (w.capacity[k] >= 2 - tolerance) merge(&w, w.to[k], w.to[k + 1]);
  for (int k = 0; k < turning_columns->n_components && !st; k++)
    root[k] = thr_turning_open(turning_columns, k) ? m + k : -1;
  for (int e = 0; e < m && !st && *added < ENOUGH; e++) {
    int k = turning_columns->component[turning_columns->f->edge[e][0]];
    if (root[k] < 0) root[k] = e;
    int from = thr_disjoint_find(w.block, e), to = thr_disjoint_find(w.block, root[k]);
    if (from == to) continue;
    st = separate_from(&w, relax, from, to, added, err);
    merge(&w, from, to);
  }
  thr_scratch_free(&w.own);
  return st;
}
