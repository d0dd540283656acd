/* Items, the steps that collect them, and what walks miss that are not held to it. */
#include "graph/threading/items.h"
#include "graph/disjoint.h"
#include "graph/plan/turning_proof.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

static int tail_of(const thr_items *p, int state)
{
  return p->f->edge[p->edge[state >> 1]][state & 1];
}

int thr_items_half(const thr_items *p, int state)
{
  return 2 * p->edge[state >> 1] + (state & 1);
}

static bool tube(const thr_items *p)
{
  return p->o->joint == THR_JOINT_TUBE;
}

static void forget_model(thr_items *p)
{
  free(p->m.step);
  free(p->m.start);
  free(p->m.end);
  p->m = (thr_subsets_model){0};
}

/* ---- items ---- */

static uint32_t lowest(uint32_t set)
{
  return set & (~set + 1);
}

/* A group of n; 0 where there is no room for so many, which n_items then tells. */
static uint32_t add_items(thr_items *p, int n)
{
  const int first = p->m.n_items;
  if (first > THR_SUBSETS_MOST_ITEMS || n > THR_SUBSETS_MOST_ITEMS - first) {
    p->m.n_items = THR_SUBSETS_MOST_ITEMS + 1;
    return 0;
  }
  for (int i = 0; i < n; i++)
    p->m.first[p->m.n_items++] = first;
  return ((UINT32_C(1) << n) - 1) << first;
}

/* Is a cut between one end of the edge and the others there among the items? Then that holds its first pass. */
static bool is_cut_off(const thr_items *p, int i)
{
  for (int c = 0; c < p->n_cuts; c++)
    if (p->cut[c] == UINT64_C(1) << (2 * i) || p->cut[c] == UINT64_C(2) << (2 * i)) return true;
  return false;
}

static void add_passes(thr_items *p)
{
  for (int i = 0; i < p->n_edges; i++) {
    const int cover = thr_plan_cover(p->f, p->o, p->edge[i]), capacity = thr_plan_capacity(p->f, p->o, p->edge[i]);
    const bool counts = p->full >> i & 1;
    p->pass[i] = 0;
    if (!counts && cover == 1 && is_cut_off(p, i)) continue;
    p->pass[i] = add_items(p, counts ? capacity : cover);
    if (counts) p->m.once |= p->pass[i];
    for (int j = 0; j < cover; j++)
      p->m.required |= lowest(p->pass[i] & ~p->m.required);
  }
}

static void add_cuts(thr_items *p)
{
  for (int c = 0; c < p->n_cuts; c++)
    p->m.required |= p->turn[c] = add_items(p, 1);
}

static void add_ends(thr_items *p)
{
  for (int v = 0; v < p->f->n_nodes; v++) {
    if (p->component[v] != p->k) continue;
    p->end[v] = add_items(p, p->o->end_count[v]);
    p->m.once |= p->end[v];
    p->m.required |= p->end[v];
  }
}

/* ---- steps ---- */

static thr_status add(thr_subsets_step **list, int *n, int *room, thr_subsets_step step, thr_err *err)
{
  thr_status st = thr_grow(list, *n, room, sizeof **list, err);
  if (!st) (*list)[(*n)++] = step;
  return st;
}

/* Of cords that turn as much the shorter ones win. */
static double pass_cost(const thr_items *p, int state)
{
  const double little = 1e-11, length = p->f->length[p->edge[state >> 1]];
  return p->turning ? little * length / p->longest : length;
}

static double turn_cost(const thr_items *p, int in, int out)
{
  return p->turning ? thr_turn_price(p->f, p->o->turning.cost, thr_items_half(p, in), thr_items_half(p, out)) : 0;
}

static bool in_cut(const thr_items *p, int c, int state)
{
  return p->cut[c] >> state & 1;
}

/* What a turn collects. */
static uint32_t turn_items(const thr_items *p, int in, int out)
{
  uint32_t all = 0;
  for (int c = 0; c < p->n_cuts; c++)
    if (in_cut(p, c, in ^ 1) != in_cut(p, c, out)) all |= p->turn[c];
  return all;
}

/* May a cord go on from one state with the other? */
static bool may_turn(const thr_items *p, int in, int out)
{
  const int v = tail_of(p, out);
  if (v != tail_of(p, in ^ 1)) return false;
  return out != (in ^ 1) || (!tube(p) && (!p->turning || thr_degree(p->f, v) == 1));
}

static thr_status add_steps(thr_items *p, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;
  for (int in = 0; in < 2 * p->n_edges; in++)
    for (int out = 0; out < 2 * p->n_edges && !st; out++) {
      const double cost = turn_cost(p, in, out) + pass_cost(p, out);
      const thr_subsets_step step = {in, out, cost, turn_items(p, in, out), {p->pass[out >> 1], 0}};
      if (may_turn(p, in, out)) st = add(&p->m.step, &p->m.n_steps, &room, step, err);
    }
  return st;
}

/* Closed cords start with their lowest edge, forwards. */
static thr_status add_starts(thr_items *p, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;
  for (int state = 0; state < 2 * p->n_edges && !st; state += p->m.closed ? 2 : 1) {
    const int v = tail_of(p, state);
    const thr_subsets_step start = {-1, state, pass_cost(p, state), 0, {p->pass[state >> 1], p->end[v]}};
    if (p->m.closed || thr_plan_end_allowed(p->f, p->o, v)) st = add(&p->m.start, &p->m.n_starts, &room, start, err);
  }
  return st;
}

static thr_status add_closings(thr_items *p, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;
  for (int in = 0; in < 2 * p->n_edges; in++)
    for (int out = 0; out <= in && !st; out += 2) {
      const thr_subsets_step end = {in, out, turn_cost(p, in, out), turn_items(p, in, out), {0, 0}};
      if (may_turn(p, in, out)) st = add(&p->m.end, &p->m.n_ends, &room, end, err);
    }
  return st;
}

static thr_status add_open_ends(thr_items *p, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;
  for (int state = 0; state < 2 * p->n_edges && !st; state++) {
    const int v = tail_of(p, state ^ 1);
    const thr_subsets_step end = {state, -1, 0, 0, {p->end[v], 0}};
    if (thr_plan_end_allowed(p->f, p->o, v)) st = add(&p->m.end, &p->m.n_ends, &room, end, err);
  }
  return st;
}

thr_status thr_items_model(thr_items *p, bool *small, thr_err *err)
{
  forget_model(p);
  p->m = (thr_subsets_model){.n_states = 2 * p->n_edges, .closed = p->o->ends == THR_ENDS_CLOSED};
  *small = p->edge != NULL;
  if (!*small) return THR_OK;
  add_cuts(p);
  add_passes(p);
  if (p->o->ends == THR_ENDS_COUNTS) add_ends(p);
  *small = p->m.n_items <= THR_SUBSETS_MOST_ITEMS;
  if (!*small) return THR_OK;
  thr_status st = add_steps(p, err);
  if (!st) st = add_starts(p, err);
  return st ? st : p->m.closed ? add_closings(p, err) : add_open_ends(p, err);
}

/* ---- what walks miss ---- */

/* Edges with more passes than their capacity, 1 << i. */
static thr_status find_full(const thr_items *p, int n_walks, int *const *state, const int *n_passes, uint32_t *full, thr_err *err)
{
  int *passes = thr_calloc((size_t)p->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int i = 0; i < n_walks; i++)
    for (int j = 0; j < n_passes[i]; j++)
      passes[state[i][j] >> 1]++;
  *full = 0;
  for (int i = 0; i < p->n_edges; i++)
    if (passes[i] > thr_plan_capacity(p->f, p->o, p->edge[i])) *full |= UINT32_C(1) << i;
  free(passes);
  return THR_OK;
}

/* At every node that is not tied, a cut around its smallest part: part[2 * n_edges] disjoint sets. False: all are tied. */
static bool add_missing(thr_items *p, int *part)
{
  const int n = 2 * p->n_edges;
  bool any = false;
  for (int v = 0; v < p->f->n_nodes; v++) {
    uint64_t best = 0;
    int fewest = thr_degree(p->f, v);
    for (int a = 0; a < n; a++) {
      uint64_t one = 0;
      int size = 0;
      for (int b = 0; b < n && tail_of(p, a) == v; b++) {
        if (tail_of(p, b) != v || thr_disjoint_find(part, a) != thr_disjoint_find(part, b)) continue;
        one |= UINT64_C(1) << b;
        size++;
      }
      if (size == 0 || size >= fewest) continue;
      fewest = size;
      best = one;
    }
    if (!best) continue;
    any = true;
    if (p->n_cuts < THR_SUBSETS_MOST_ITEMS) p->cut[p->n_cuts++] = best;
  }
  return any;
}

static thr_status tie(thr_items *p, int n_walks, int *const *state, const int *n_passes, bool *keep, thr_err *err)
{
  const int n = 2 * p->n_edges;
  int *part = thr_calloc((size_t)n, sizeof *part);
  if (!part) return thr_nomem(err);
  for (int a = 0; a < n; a++)
    part[a] = a;
  for (int i = 0; i < n_walks; i++)
    for (int j = 0; j < n_passes[i]; j++)
      if (j > 0 || p->m.closed) thr_disjoint_join(part, state[i][j > 0 ? j - 1 : n_passes[i] - 1] ^ 1, state[i][j]);
  *keep = !add_missing(p, part);
  free(part);
  return THR_OK;
}

thr_status thr_items_refine(thr_items *p, int n_walks, int *const *state, const int *n_passes, bool *keep, bool *more,
                            thr_err *err)
{
  bool tied = true;
  uint32_t full;
  const int cuts = p->n_cuts;
  thr_status st = find_full(p, n_walks, state, n_passes, &full, err);
  if (!st && tube(p)) st = tie(p, n_walks, state, n_passes, &tied, err);
  if (st) return st;
  *keep = tied && !full;
  *more = full || p->n_cuts > cuts;
  p->full |= full;
  return THR_OK;
}

/* ---- all of it ---- */

static thr_status find_edges(thr_items *p, thr_err *err)
{
  const thr_frame *f = p->f;
  for (int e = 0; e < f->n_edges; e++)
    p->n_edges += p->component[f->edge[e][0]] == p->k;
  if (p->n_edges > THR_SUBSETS_MOST_ITEMS) return THR_OK;
  p->edge = thr_calloc((size_t)p->n_edges, sizeof *p->edge);
  p->pass = thr_calloc((size_t)p->n_edges, sizeof *p->pass);
  p->end = thr_calloc((size_t)f->n_nodes, sizeof *p->end);
  p->turn = thr_calloc(THR_SUBSETS_MOST_ITEMS, sizeof *p->turn);
  if (!p->edge || !p->pass || !p->end || !p->turn) return thr_nomem(err);
  for (int e = 0, i = 0; e < f->n_edges; e++) {
    if (p->component[f->edge[e][0]] != p->k) continue;
    p->edge[i++] = e;
    p->longest = fmax(p->longest, f->length[e]);
  }
  return THR_OK;
}

thr_status thr_items_init(thr_items *p, const thr_frame *f, const thr_plan_options *o, const int *component, int k, bool turning,
                          thr_err *err)
{
  *p = (thr_items){.f = f, .o = o, .component = component, .k = k, .turning = turning};
  thr_status st = find_edges(p, err);
  if (st) thr_items_destroy(p);
  return st;
}

void thr_items_destroy(thr_items *p)
{
  forget_model(p);
  free(p->edge);
  free(p->pass);
  free(p->end);
  free(p->turn);
  *p = (thr_items){0};
}
