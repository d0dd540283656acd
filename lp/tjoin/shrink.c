/* Bridges by depth-first search, then series and parallel edges until none is left. */
#include "lp/tjoin/shrink.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "lp/tjoin/oddcut.h"

void thr_shrinking_destroy(thr_shrinking *shrinking)
{
  thr_scratch_free(&shrinking->own);
  *shrinking = (thr_shrinking){0};
}

static thr_status allocate(thr_shrinking *shrinking, thr_err *err)
{
  size_t n = (size_t)shrinking->p->n_nodes, m = (size_t)shrinking->p->n_edges;
  shrinking->edge = thr_scratch_array(&shrinking->own, m, sizeof *shrinking->edge);
  shrinking->weight = thr_scratch_array(&shrinking->own, m, sizeof *shrinking->weight);
  shrinking->odd = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->odd);
  shrinking->origin = thr_scratch_array(&shrinking->own, m, sizeof *shrinking->origin);
  shrinking->kept = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->kept);
  shrinking->block = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->block);
  shrinking->order = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->order);
  shrinking->up = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->up);
  shrinking->odd_bridge = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->odd_bridge);
  shrinking->step = thr_scratch_array(&shrinking->own, n, sizeof *shrinking->step);
  return thr_scratch_check(&shrinking->own, err);
}

static int other_end(const int (*edge)[2], int e, int v)
{
  return edge[e][0] == v ? edge[e][1] : edge[e][0];
}

/* ---- bridges ---- */

typedef struct {
  thr_oddcut_graph graph;
  int *number;  /* [n_nodes] place in the order, -1: not visited */
  int *low;     /* [n_nodes] lowest number that an edge from the subtree leads to */
  int *cursor;  /* [n_nodes] edges at a node that are done */
  bool *parity; /* [n_nodes] of the odd nodes in the subtree */
  int *parent;  /* [n_nodes] disjoint sets: blocks */
} bridge_search;

/* A depth-first search tree: shrinking->order, shrinking->up and numbers. */
static void visit_all(thr_shrinking *shrinking, bridge_search *b)
{
  const thr_tjoin_problem *tjoin_problem = shrinking->p;
  int n = 0, v = 0;
  shrinking->up[0] = -1;
  b->number[0] = 0;
  shrinking->order[n++] = 0;
  for (;;) {
    if (b->cursor[v] == b->graph.first[v + 1]) {
      if (shrinking->up[v] < 0) return;
      v = other_end(tjoin_problem->edge, shrinking->up[v], v);
      continue;
    }
    int e = b->graph.incident[b->cursor[v]++], w = other_end(tjoin_problem->edge, e, v);
    if (b->number[w] >= 0) continue;
    shrinking->up[w] = e;
    b->number[w] = n;
    shrinking->order[n++] = w;
    v = w;
  }
}

/* An edge up from a subtree is a bridge if no other leads out of it. */
static void judge_edges(thr_shrinking *shrinking, bridge_search *b)
{
  const thr_tjoin_problem *tjoin_problem = shrinking->p;
  for (int i = tjoin_problem->n_nodes - 1; i >= 0; i--) {
    int v = shrinking->order[i];
    for (int k = b->graph.first[v]; k < b->graph.first[v + 1]; k++) {
      int e = b->graph.incident[k], w = other_end(tjoin_problem->edge, e, v);
      if (e != shrinking->up[v] && b->number[w] < b->low[v]) b->low[v] = b->number[w];
    }
    if (shrinking->up[v] < 0) continue;
    int above = other_end(tjoin_problem->edge, shrinking->up[v], v);
    b->parity[above] ^= b->parity[v];
    if (b->low[v] < b->low[above]) b->low[above] = b->low[v];
    if (b->low[v] < i) continue;
    shrinking->odd_bridge[v] = b->parity[v];
    thr_disjoint_join(b->parent, v, above);
  }
}

static thr_status find_blocks(thr_shrinking *shrinking, thr_err *err)
{
  size_t n = (size_t)shrinking->p->n_nodes;
  thr_scratch own = {0};
  bridge_search b = {.number = thr_scratch_array(&own, n, sizeof *b.number),
                     .low = thr_scratch_array(&own, n, sizeof *b.low),
                     .cursor = thr_scratch_array(&own, n, sizeof *b.cursor),
                     .parity = thr_scratch_array(&own, n, sizeof *b.parity),
                     .parent = thr_scratch_array(&own, n, sizeof *b.parent)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_oddcut_graph_init(&b.graph, shrinking->p, err);
  if (!st) {
    for (int v = 0; v < shrinking->p->n_nodes; v++) {
      b.number[v] = -1;
      b.low[v] = shrinking->p->n_nodes;
      b.cursor[v] = b.graph.first[v];
      b.parity[v] = shrinking->p->odd[v];
      b.parent[v] = v;
    }
    visit_all(shrinking, &b);
    judge_edges(shrinking, &b);
    for (int v = 0; v < shrinking->p->n_nodes; v++) { /* the lowest of a block is its root */
      int root = thr_disjoint_find(b.parent, v);
      shrinking->block[v] = root == v ? shrinking->n_blocks++ : shrinking->block[root];
      shrinking->odd[shrinking->block[v]] ^= shrinking->p->odd[v];
    }
    for (int v = 0; v < shrinking->p->n_nodes; v++)
      if (shrinking->odd_bridge[v]) {
        shrinking->odd[shrinking->block[v]] ^= true;
        shrinking->odd[shrinking->block[other_end(shrinking->p->edge, shrinking->up[v], v)]] ^= true;
      }
  }
  thr_oddcut_graph_destroy(&b.graph);
  thr_scratch_free(&own);
  return st;
}

/* ---- series and parallel edges ---- */

/* Half-edge h = 2 * e + side stands in the ring of s->edge[e][side]. */
typedef struct {
  thr_shrinking *s;
  int *next, *previous; /* [2 * n_edges] */
  int *ring;            /* [n_blocks] some half-edge, or -1 */
  int *degree;          /* [n_blocks] */
  bool *gone;           /* [n_edges] */
  bool *out;            /* [n_blocks] taken out */
  bool *queued;         /* [n_blocks] */
  int *queue;           /* [n_queued] blocks of degree 1 or 2 */
  int n_queued;
  thr_scratch own; /* the arrays */
} shrinker;

static void consider(shrinker *r, int v)
{
  if (r->degree[v] > 2 || r->queued[v]) return;
  r->queued[v] = true;
  r->queue[r->n_queued++] = v;
}

static void attach(shrinker *r, int h, int v)
{
  int at = r->ring[v];
  r->s->edge[h / 2][h % 2] = v;
  r->next[h] = at < 0 ? h : r->next[at];
  r->previous[h] = at < 0 ? h : at;
  r->previous[r->next[h]] = h;
  r->next[r->previous[h]] = h;
  r->ring[v] = h;
  r->degree[v]++;
}

static void detach(shrinker *r, int h)
{
  int v = r->s->edge[h / 2][h % 2];
  r->next[r->previous[h]] = r->next[h];
  r->previous[r->next[h]] = r->previous[h];
  r->ring[v] = r->next[h] == h ? -1 : r->next[h];
  r->degree[v]--;
  consider(r, v);
}

static void drop(shrinker *r, int e)
{
  r->gone[e] = true;
  detach(r, 2 * e);
  detach(r, 2 * e + 1);
}

static int far_end(const shrinker *r, int h)
{
  return r->s->edge[h / 2][1 - h % 2];
}

/* Of two edges between the same blocks the heavier goes. */
static void drop_heavier(shrinker *r, int e, int f)
{
  drop(r, r->s->weight[e] > r->s->weight[f] ? e : f);
}

enum { LOOK = 16 }; /* edges looked at for a parallel one: between two hubs one may be missed */

static void drop_parallel(shrinker *r, int e)
{
  int side = r->degree[r->s->edge[e][0]] <= r->degree[r->s->edge[e][1]] ? 0 : 1, h = 2 * e + side;
  for (int k = r->next[h], i = 0; k != h && i < LOOK; k = r->next[k], i++)
    if (far_end(r, k) == far_end(r, h)) {
      drop_heavier(r, e, k / 2);
      return;
    }
}

static void take_leaf(shrinker *r, int v)
{
  thr_shrinking *shrinking = r->s;
  int h = r->ring[v], a = h / 2, x = far_end(r, h);
  shrinking->step[shrinking->n_steps++] = (thr_shrink_step){
      .kind = THR_SHRINK_LEAF, .odd = shrinking->odd[v], .node = v, .a = a, .x = x, .weight_a = shrinking->weight[a]};
  shrinking->odd[x] ^= shrinking->odd[v];
  drop(r, a);
}

static void take_middle(shrinker *r, int v)
{
  thr_shrinking *shrinking = r->s;
  int h = r->ring[v], k = r->next[h];
  if (far_end(r, h) == far_end(r, k)) {
    r->out[v] = false; /* it will come back as a leaf */
    drop_heavier(r, h / 2, k / 2);
    return;
  }
  if (shrinking->odd[v] && shrinking->weight[k / 2] < shrinking->weight[h / 2]) {
    int lighter = k;
    k = h;
    h = lighter;
  }
  int a = h / 2, b = k / 2, x = far_end(r, h), y = far_end(r, k);
  shrinking->step[shrinking->n_steps++] = (thr_shrink_step){.kind = shrinking->odd[v] ? THR_SHRINK_ODD : THR_SHRINK_EVEN,
                                                            .node = v,
                                                            .a = a,
                                                            .b = b,
                                                            .x = x,
                                                            .y = y,
                                                            .weight_a = shrinking->weight[a],
                                                            .weight_b = shrinking->weight[b]};
  int stays = shrinking->odd[v] ? k : h, goes = shrinking->odd[v] ? a : b;
  shrinking->weight[stays / 2] =
      shrinking->odd[v] ? shrinking->weight[b] - shrinking->weight[a] : shrinking->weight[a] + shrinking->weight[b];
  shrinking->odd[x] ^= shrinking->odd[v];
  drop(r, goes);
  detach(r, stays);
  attach(r, stays, shrinking->odd[v] ? x : y);
  drop_parallel(r, stays / 2);
}

static thr_status shrinker_init(shrinker *r, thr_err *err)
{
  size_t m = (size_t)r->s->p->n_edges, n = (size_t)r->s->n_blocks;
  r->next = thr_scratch_array(&r->own, 2 * m, sizeof *r->next);
  r->previous = thr_scratch_array(&r->own, 2 * m, sizeof *r->previous);
  r->ring = thr_scratch_array(&r->own, n, sizeof *r->ring);
  r->degree = thr_scratch_array(&r->own, n, sizeof *r->degree);
  r->gone = thr_scratch_array(&r->own, m, sizeof *r->gone);
  r->out = thr_scratch_array(&r->own, n, sizeof *r->out);
  r->queued = thr_scratch_array(&r->own, n, sizeof *r->queued);
  r->queue = thr_scratch_array(&r->own, n, sizeof *r->queue);
  return thr_scratch_check(&r->own, err);
}

static void shrinker_destroy(shrinker *r)
{
  thr_scratch_free(&r->own);
}

/* Rings of all edges but the bridges, the lightest of each set of parallel ones. */
static void fill_rings(shrinker *r)
{
  thr_shrinking *shrinking = r->s;
  for (int v = 0; v < shrinking->n_blocks; v++)
    r->ring[v] = -1;
  for (int e = 0; e < shrinking->p->n_edges; e++) {
    int a = shrinking->block[shrinking->p->edge[e][0]], b = shrinking->block[shrinking->p->edge[e][1]];
    shrinking->weight[e] = shrinking->p->weight[e];
    r->gone[e] = a == b;
    if (a == b) continue;
    attach(r, 2 * e, a);
    attach(r, 2 * e + 1, b);
  }
  int *last = shrinking->kept; /* not used yet: the last edge seen to a block */
  for (int v = 0; v < shrinking->n_blocks; v++)
    last[v] = -1;
  for (int v = 0; v < shrinking->n_blocks; v++) {
    int left = r->degree[v];
    for (int h = r->ring[v]; left > 0; left--) {
      int e = h / 2, w = far_end(r, h), f = last[w];
      h = r->next[h];
      last[w] = e;
      if (f < 0 || r->gone[f] || (shrinking->edge[f][0] != v && shrinking->edge[f][1] != v)) continue;
      if (shrinking->weight[f] <= shrinking->weight[e]) last[w] = f;
      drop_heavier(r, e, f);
    }
  }
}

static void shrink_blocks(shrinker *r)
{
  fill_rings(r);
  for (int v = 0; v < r->s->n_blocks; v++)
    consider(r, v);
  while (r->n_queued) {
    int v = r->queue[--r->n_queued];
    r->queued[v] = false;
    if (r->out[v] || r->degree[v] == 0 || r->degree[v] > 2) continue;
    r->out[v] = true;
    if (r->degree[v] == 1)
      take_leaf(r, v);
    else
      take_middle(r, v);
  }
}

/* What is left, numbered anew. */
static void collect(shrinker *r)
{
  thr_shrinking *shrinking = r->s;
  int n = 0, m = 0, *number = r->degree; /* which has served */
  for (int v = 0; v < shrinking->n_blocks; v++) {
    if (r->out[v]) continue;
    number[v] = n;
    shrinking->odd[n] = shrinking->odd[v];
    shrinking->kept[n++] = v;
  }
  for (int e = 0; e < shrinking->p->n_edges; e++) {
    if (r->gone[e]) continue;
    shrinking->origin[m] = e;
    shrinking->weight[m] = shrinking->weight[e];
    shrinking->edge[m][0] = number[shrinking->edge[e][0]];
    shrinking->edge[m++][1] = number[shrinking->edge[e][1]];
  }
  shrinking->reduced = (thr_tjoin_problem){
      .n_nodes = n, .n_edges = m, .edge = (const int(*)[2])shrinking->edge, .weight = shrinking->weight, .odd = shrinking->odd};
}

thr_status thr_shrinking_init(thr_shrinking *shrinking, const thr_tjoin_problem *tjoin_problem, thr_err *err)
{
  *shrinking = (thr_shrinking){.p = tjoin_problem};
  shrinker r = {.s = shrinking};
  thr_status st = allocate(shrinking, err);
  if (!st) st = find_blocks(shrinking, err);
  if (!st) st = shrinker_init(&r, err);
  if (!st) {
    shrink_blocks(&r);
    collect(&r);
  }
  shrinker_destroy(&r);
  if (st) thr_shrinking_destroy(shrinking);
  return st;
}
