/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a model for the dynamic programme over subsets (graph/threading/subsets.c) from a small
 * framework of one component: cords become walks that collect items, and states are half-edges.
 *
 * Items are each pass that an edge needs, and a cord end wherever ends are counted. Capacities and
 * tube joints would take so many items more that the table became large. So they come in only where
 * the cords that were found break them (thr_items_refine):
 * - capacities: each pass that the edge may have becomes an item, which is collected once;
 * - tube joints: a cut parts the edges at a node in two, and any turn between both sides is an
 *   item. Where cords never end, a node of three edges needs no cuts: each edge turns to another.
 *
 * Without some of these items the cords of the model cost no more than those of the whole problem,
 * so a bound stays valid.
 *
 * Example: a path of two edges, each passed once, has two items, and 18 are left for what comes in.
 */
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

static int tail_of(const thr_items *items, int state)
{
  return thr_tail(items->f, state);
}

static bool tube(const thr_items *items)
{
  return items->o->joint == THR_JOINT_TUBE;
}

/* Releases the model, which becomes empty. */
static void forget_model(thr_items *items)
{
  free(items->m.step);
  free(items->m.start);
  free(items->m.end);
  items->m = (thr_subsets_model){0};
}

/* ---- items ---- */

static uint32_t lowest(uint32_t set)
{
  return set & (~set + 1);
}

/* Adds a group of n items and returns them as a set. Returns 0 where there are too many, which
 * n_items then tells. */
static uint32_t add_items(thr_items *items, int n)
{
  const int first = items->m.n_items;
  if (first > THR_SUBSETS_MOST_ITEMS || n > THR_SUBSETS_MOST_ITEMS - first) {
    items->m.n_items = THR_SUBSETS_MOST_ITEMS + 1;
    return 0;
  }

  for (int i = 0; i < n; i++)
    items->m.first[items->m.n_items++] = first;
  return ((UINT32_C(1) << n) - 1) << first;
}

/* Returns whether a cut between one end of the edge and the other edges there is among the items.
 * The turn that crosses this cut also makes the edge's first pass. */
static bool is_cut_off(const thr_items *items, int i)
{
  for (int c = 0; c < items->n_cuts; c++)
    if (items->cut[c] == UINT64_C(1) << (2 * i) || items->cut[c] == UINT64_C(2) << (2 * i))
      return true;
  return false;
}

/* Adds the items of the passes of every edge: as many as its cover, or as its capacity where
 * capacities count. */
static void add_passes(thr_items *items)
{
  for (int i = 0; i < items->n_edges; i++) {
    const int cover = thr_plan_cover(items->f, items->o, i),
              capacity = thr_plan_capacity(items->f, items->o, i);

    const bool counts = items->full >> i & 1;

    items->pass[i] = 0;
    if (!counts && cover == 1 && is_cut_off(items, i)) continue;

    items->pass[i] = add_items(items, counts ? capacity : cover);
    if (counts) items->m.once |= items->pass[i];

    /* The first items of the group are required, as many as the cover. */
    for (int j = 0; j < cover; j++)
      items->m.required |= lowest(items->pass[i] & ~items->m.required);
  }
}

/* Adds an item for each cut. */
static void add_cuts(thr_items *items)
{
  for (int c = 0; c < items->n_cuts; c++)
    items->m.required |= items->turn[c] = add_items(items, 1);
}

/* Adds the cord ends of every node as items, which are required and collected once. */
static void add_ends(thr_items *items)
{
  for (int v = 0; v < items->f->n_nodes; v++) {
    items->end[v] = add_items(items, items->o->end_count[v]);
    items->m.once |= items->end[v];
    items->m.required |= items->end[v];
  }
}

/* ---- steps ---- */

/* Appends a step to a growing list. */
static thr_status add(thr_subsets_step **list, int *n, int *room, thr_subsets_step step,
                      thr_err *err)
{
  thr_status st = thr_grow(list, *n, room, sizeof **list, err);
  if (!st) (*list)[(*n)++] = step;
  return st;
}

/* Returns the cost of a pass. For turnings this is a very small part of the length, so that of
 * cords that turn alike the shorter ones are preferred. */
static double pass_cost(const thr_items *items, int state)
{
  const double little = 1e-11, length = items->f->length[state >> 1];
  return items->turning ? little * length / items->longest : length;
}

static double turn_cost(const thr_items *items, int in, int out)
{
  return items->turning ? thr_turn_price(items->f, items->o->turning.cost, in, out) : 0;
}

/* Returns whether a state is in the set of cut number c. */
static bool in_cut(const thr_items *items, int c, int state)
{
  return items->cut[c] >> state & 1;
}

/* Returns the items that a turn collects: those of all cuts that the turn crosses. */
static uint32_t turn_items(const thr_items *items, int in, int out)
{
  uint32_t all = 0;
  for (int c = 0; c < items->n_cuts; c++)
    if (in_cut(items, c, in ^ 1) != in_cut(items, c, out)) all |= items->turn[c];
  return all;
}

/* Returns whether a cord may go on from one state with the other. With tube joints nothing turns
 * back; for turnings only at nodes of one edge. */
static bool may_turn(const thr_items *items, int in, int out)
{
  const int v = tail_of(items, out);

  if (v != tail_of(items, in ^ 1)) return false;
  return out != (in ^ 1) || (!tube(items) && (!items->turning || thr_degree(items->f, v) == 1));
}

/* Adds a step for every turn that is allowed, by ascending states. */
static thr_status add_steps(thr_items *items, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;
  for (int in = 0; in < 2 * items->n_edges; in++)
    for (int out = 0; out < 2 * items->n_edges && !st; out++) {
      const double cost = turn_cost(items, in, out) + pass_cost(items, out);
      const thr_subsets_step step = {
          in, out, cost, turn_items(items, in, out), {items->pass[out >> 1], 0}};
      if (may_turn(items, in, out)) st = add(&items->m.step, &items->m.n_steps, &room, step, err);
    }
  return st;
}

/* Adds the starts: of open cords every half-edge from a node where a cord may end, of closed cords
 * every edge forwards, as they start with their lowest edge. */
static thr_status add_starts(thr_items *items, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;

  for (int state = 0; state < 2 * items->n_edges && !st; state += items->m.closed ? 2 : 1) {
    const int v = tail_of(items, state);
    const thr_subsets_step start = {
        -1, state, pass_cost(items, state), 0, {items->pass[state >> 1], items->end[v]}};
    if (items->m.closed || thr_plan_end_allowed(items->f, items->o, v))
      st = add(&items->m.start, &items->m.n_starts, &room, start, err);
  }
  return st;
}

/* Adds the ends of closed cords: turns into a first state, which is the lowest of the cord. */
static thr_status add_closings(thr_items *items, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;

  for (int in = 0; in < 2 * items->n_edges; in++)
    for (int out = 0; out <= in && !st; out += 2) {
      const thr_subsets_step end = {
          in, out, turn_cost(items, in, out), turn_items(items, in, out), {0, 0}};
      if (may_turn(items, in, out)) st = add(&items->m.end, &items->m.n_ends, &room, end, err);
    }
  return st;
}

/* Adds the ends of open cords, at nodes where a cord may end. */
static thr_status add_open_ends(thr_items *items, thr_err *err)
{
  int room = 0;
  thr_status st = THR_OK;

  for (int state = 0; state < 2 * items->n_edges && !st; state++) {
    const int v = tail_of(items, state ^ 1);
    const thr_subsets_step end = {state, -1, 0, 0, {items->end[v], 0}};
    if (thr_plan_end_allowed(items->f, items->o, v))
      st = add(&items->m.end, &items->m.n_ends, &room, end, err);
  }
  return st;
}

thr_status thr_items_model(thr_items *items, bool *small, thr_err *err)
{
  forget_model(items);

  items->m = (thr_subsets_model){.n_states = 2 * items->n_edges,
                                 .closed = items->o->ends == THR_ENDS_CLOSED};
  *small = items->pass != NULL;

  if (!*small) return THR_OK;

  /* Items first: too many of them end the attempt. */
  add_cuts(items);
  add_passes(items);
  if (items->o->ends == THR_ENDS_COUNTS) add_ends(items);
  *small = items->m.n_items <= THR_SUBSETS_MOST_ITEMS;
  if (!*small) return THR_OK;

  /* Then steps, starts and ends, which collect them. */
  thr_status st = add_steps(items, err);
  if (!st) st = add_starts(items, err);
  return st ? st : items->m.closed ? add_closings(items, err) : add_open_ends(items, err);
}

/* ---- what walks miss ---- */

/* Finds the edges with more passes than their capacity, as a set of 1 << i. */
static thr_status find_full(const thr_items *items, int n_walks, int *const *state,
                            const int *n_passes, uint32_t *full, thr_err *err)
{
  int *passes = thr_calloc((size_t)items->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);

  for (int i = 0; i < n_walks; i++)
    for (int j = 0; j < n_passes[i]; j++)
      passes[state[i][j] >> 1]++;

  *full = 0;
  for (int i = 0; i < items->n_edges; i++)
    if (passes[i] > thr_plan_capacity(items->f, items->o, i)) *full |= UINT32_C(1) << i;
  free(passes);
  return THR_OK;
}

/* Adds at every node that is not tied a cut around its smallest part. part[2 * n_edges]: the
 * half-edges as disjoint sets, joined by the turns. Returns false if all nodes are tied. */
static bool add_missing(thr_items *items, int *part)
{
  const int n = 2 * items->n_edges;
  bool any = false;
  for (int v = 0; v < items->f->n_nodes; v++) {
    uint64_t best = 0;
    int fewest = thr_degree(items->f, v);

    /* For each half-edge at the node: the part that it is in. */
    for (int a = 0; a < n; a++) {
      uint64_t members = 0;
      int size = 0;
      for (int b = 0; b < n && tail_of(items, a) == v; b++) {
        if (tail_of(items, b) != v || thr_disjoint_find(part, a) != thr_disjoint_find(part, b))
          continue;
        members |= UINT64_C(1) << b;
        size++;
      }

      /* The smallest part, which is not all of the node. */
      if (size == 0 || size >= fewest) continue;
      fewest = size;
      best = members;
    }

    if (!best) continue;
    any = true;
    if (items->n_cuts < THR_SUBSETS_MOST_ITEMS) items->cut[items->n_cuts++] = best;
  }
  return any;
}

/* Finds the parts at all nodes from the turns of the walks, and adds cuts. *keep: all nodes are
 * tied. */
static thr_status tie(thr_items *items, int n_walks, int *const *state, const int *n_passes,
                      bool *keep, thr_err *err)
{
  const int n = 2 * items->n_edges;
  int *part = thr_calloc((size_t)n, sizeof *part);
  if (!part) return thr_nomem(err);

  for (int a = 0; a < n; a++)
    part[a] = a;

  for (int i = 0; i < n_walks; i++)
    for (int j = 0; j < n_passes[i]; j++)
      if (j > 0 || items->m.closed)
        thr_disjoint_join(part, state[i][j > 0 ? j - 1 : n_passes[i] - 1] ^ 1, state[i][j]);

  *keep = !add_missing(items, part);
  free(part);
  return THR_OK;
}

thr_status thr_items_refine(thr_items *items, int n_walks, int *const *state, const int *n_passes,
                            bool *keep, bool *more, thr_err *err)
{
  bool tied = true;
  uint32_t full;
  const int cuts = items->n_cuts;

  /* Capacities, and with tube joints the nodes. */
  thr_status st = find_full(items, n_walks, state, n_passes, &full, err);
  if (!st && tube(items)) st = tie(items, n_walks, state, n_passes, &tied, err);
  if (st) return st;

  *keep = tied && !full;
  *more = full || items->n_cuts > cuts;
  items->full |= full;
  return THR_OK;
}

/* ---- all of it ---- */

/* Allocates the arrays, unless the framework has too many edges. */
static thr_status make_room(thr_items *items, thr_err *err)
{
  const thr_frame *frame = items->f;
  items->n_edges = frame->n_edges;
  if (items->n_edges > THR_SUBSETS_MOST_ITEMS) return THR_OK;

  items->pass = thr_calloc((size_t)items->n_edges, sizeof *items->pass);
  items->end = thr_calloc((size_t)frame->n_nodes, sizeof *items->end);
  items->turn = thr_calloc(THR_SUBSETS_MOST_ITEMS, sizeof *items->turn);
  if (!items->pass || !items->end || !items->turn) return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++)
    items->longest = fmax(items->longest, frame->length[e]);
  return THR_OK;
}

thr_status thr_items_init(thr_items *items, const thr_frame *frame, const thr_request *options,
                          bool turning, thr_err *err)
{
  *items = (thr_items){.f = frame, .o = options, .turning = turning};
  thr_status st = make_room(items, err);
  if (st) thr_items_destroy(items);
  return st;
}

void thr_items_destroy(thr_items *items)
{
  forget_model(items);
  free(items->pass);
  free(items->end);
  free(items->turn);
  *items = (thr_items){0};
}
