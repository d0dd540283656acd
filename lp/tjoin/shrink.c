/* Bridges by depth-first search, then series and parallel edges until none is left. */
#include "lp/tjoin/shrink.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "lp/tjoin/oddcut.h"


void thr_shrinking_destroy(thr_shrinking *s)
{
  thr_scratch_free(&s->own);
  *s = (thr_shrinking){0};
}

static thr_status allocate(thr_shrinking *s, thr_err *err)
{
  size_t n = (size_t)s->p->n_nodes, m = (size_t)s->p->n_edges;
  s->edge = thr_scratch_array(&s->own, m, sizeof *s->edge);
  s->weight = thr_scratch_array(&s->own, m, sizeof *s->weight);
  s->odd = thr_scratch_array(&s->own, n, sizeof *s->odd);
  s->origin = thr_scratch_array(&s->own, m, sizeof *s->origin);
  s->kept = thr_scratch_array(&s->own, n, sizeof *s->kept);
  s->block = thr_scratch_array(&s->own, n, sizeof *s->block);
  s->order = thr_scratch_array(&s->own, n, sizeof *s->order);
  s->up = thr_scratch_array(&s->own, n, sizeof *s->up);
  s->odd_bridge = thr_scratch_array(&s->own, n, sizeof *s->odd_bridge);
  s->step = thr_scratch_array(&s->own, n, sizeof *s->step);
  return thr_scratch_check(&s->own, err);
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

/* A depth-first search tree: s->order, s->up and numbers. */
static void visit_all(thr_shrinking *s, bridge_search *b)
{
  const thr_tjoin_problem *p = s->p;
  int n = 0, v = 0;
  s->up[0] = -1;
  b->number[0] = 0;
  s->order[n++] = 0;
  for (;;) {
    if (b->cursor[v] == b->graph.first[v + 1]) {
      if (s->up[v] < 0) return;
      v = other_end(p->edge, s->up[v], v);
      continue;
    }
    int e = b->graph.incident[b->cursor[v]++], w = other_end(p->edge, e, v);
    if (b->number[w] >= 0) continue;
    s->up[w] = e;
    b->number[w] = n;
    s->order[n++] = w;
    v = w;
  }
}

/* An edge up from a subtree is a bridge if no other leads out of it. */
static void judge_edges(thr_shrinking *s, bridge_search *b)
{
  const thr_tjoin_problem *p = s->p;
  for (int i = p->n_nodes - 1; i >= 0; i--) {
    int v = s->order[i];
    for (int k = b->graph.first[v]; k < b->graph.first[v + 1]; k++) {
      int e = b->graph.incident[k], w = other_end(p->edge, e, v);
      if (e != s->up[v] && b->number[w] < b->low[v]) b->low[v] = b->number[w];
    }
    if (s->up[v] < 0) continue;
    int above = other_end(p->edge, s->up[v], v);
    b->parity[above] ^= b->parity[v];
    if (b->low[v] < b->low[above]) b->low[above] = b->low[v];
    if (b->low[v] < i) continue;
    s->odd_bridge[v] = b->parity[v];
    thr_disjoint_join(b->parent, v, above);
  }
}

static thr_status find_blocks(thr_shrinking *s, thr_err *err)
{
  size_t n = (size_t)s->p->n_nodes;
  thr_scratch own = {0};
  bridge_search b = {.number = thr_scratch_array(&own, n, sizeof *b.number),
                     .low = thr_scratch_array(&own, n, sizeof *b.low),
                     .cursor = thr_scratch_array(&own, n, sizeof *b.cursor),
                     .parity = thr_scratch_array(&own, n, sizeof *b.parity),
                     .parent = thr_scratch_array(&own, n, sizeof *b.parent)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_oddcut_graph_init(&b.graph, s->p, err);
  if (!st) {
    for (int v = 0; v < s->p->n_nodes; v++) {
      b.number[v] = -1;
      b.low[v] = s->p->n_nodes;
      b.cursor[v] = b.graph.first[v];
      b.parity[v] = s->p->odd[v];
      b.parent[v] = v;
    }
    visit_all(s, &b);
    judge_edges(s, &b);
    for (int v = 0; v < s->p->n_nodes; v++) { /* the lowest of a block is its root */
      int root = thr_disjoint_find(b.parent, v);
      s->block[v] = root == v ? s->n_blocks++ : s->block[root];
      s->odd[s->block[v]] ^= s->p->odd[v];
    }
    for (int v = 0; v < s->p->n_nodes; v++)
      if (s->odd_bridge[v]) {
        s->odd[s->block[v]] ^= true;
        s->odd[s->block[other_end(s->p->edge, s->up[v], v)]] ^= true;
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
  thr_shrinking *s = r->s;
  int h = r->ring[v], a = h / 2, x = far_end(r, h);
  s->step[s->n_steps++] =
      (thr_shrink_step){.kind = THR_SHRINK_LEAF, .odd = s->odd[v], .node = v, .a = a, .x = x, .weight_a = s->weight[a]};
  s->odd[x] ^= s->odd[v];
  drop(r, a);
}

static void take_middle(shrinker *r, int v)
{
  thr_shrinking *s = r->s;
  int h = r->ring[v], k = r->next[h];
  if (far_end(r, h) == far_end(r, k)) {
    r->out[v] = false; /* it will come back as a leaf */
    drop_heavier(r, h / 2, k / 2);
    return;
  }
  if (s->odd[v] && s->weight[k / 2] < s->weight[h / 2]) {
    int lighter = k;
    k = h;
    h = lighter;
  }
  int a = h / 2, b = k / 2, x = far_end(r, h), y = far_end(r, k);
  s->step[s->n_steps++] = (thr_shrink_step){.kind = s->odd[v] ? THR_SHRINK_ODD : THR_SHRINK_EVEN,
                                            .node = v,
                                            .a = a,
                                            .b = b,
                                            .x = x,
                                            .y = y,
                                            .weight_a = s->weight[a],
                                            .weight_b = s->weight[b]};
  int stays = s->odd[v] ? k : h, goes = s->odd[v] ? a : b;
  s->weight[stays / 2] = s->odd[v] ? s->weight[b] - s->weight[a] : s->weight[a] + s->weight[b];
  s->odd[x] ^= s->odd[v];
  drop(r, goes);
  detach(r, stays);
  attach(r, stays, s->odd[v] ? x : y);
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
  thr_shrinking *s = r->s;
  for (int v = 0; v < s->n_blocks; v++)
    r->ring[v] = -1;
  for (int e = 0; e < s->p->n_edges; e++) {
    int a = s->block[s->p->edge[e][0]], b = s->block[s->p->edge[e][1]];
    s->weight[e] = s->p->weight[e];
    r->gone[e] = a == b;
    if (a == b) continue;
    attach(r, 2 * e, a);
    attach(r, 2 * e + 1, b);
  }
  int *last = s->kept; /* not used yet: the last edge seen to a block */
  for (int v = 0; v < s->n_blocks; v++)
    last[v] = -1;
  for (int v = 0; v < s->n_blocks; v++) {
    int left = r->degree[v];
    for (int h = r->ring[v]; left > 0; left--) {
      int e = h / 2, w = far_end(r, h), f = last[w];
      h = r->next[h];
      last[w] = e;
      if (f < 0 || r->gone[f] || (s->edge[f][0] != v && s->edge[f][1] != v)) continue;
      if (s->weight[f] <= s->weight[e]) last[w] = f;
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
  thr_shrinking *s = r->s;
  int n = 0, m = 0, *number = r->degree; /* which has served */
  for (int v = 0; v < s->n_blocks; v++) {
    if (r->out[v]) continue;
    number[v] = n;
    s->odd[n] = s->odd[v];
    s->kept[n++] = v;
  }
  for (int e = 0; e < s->p->n_edges; e++) {
    if (r->gone[e]) continue;
    s->origin[m] = e;
    s->weight[m] = s->weight[e];
    s->edge[m][0] = number[s->edge[e][0]];
    s->edge[m++][1] = number[s->edge[e][1]];
  }
  s->reduced =
      (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])s->edge, .weight = s->weight, .odd = s->odd};
}

thr_status thr_shrinking_init(thr_shrinking *s, const thr_tjoin_problem *p, thr_err *err)
{
  *s = (thr_shrinking){.p = p};
  shrinker r = {.s = s};
  thr_status st = allocate(s, err);
  if (!st) st = find_blocks(s, err);
  if (!st) st = shrinker_init(&r, err);
  if (!st) {
    shrink_blocks(&r);
    collect(&r);
  }
  shrinker_destroy(&r);
  if (st) thr_shrinking_destroy(s);
  return st;
}
