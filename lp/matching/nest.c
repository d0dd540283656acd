/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The duals of a matching as nested moats: every odd place, and every blossom, is a set with a moat
 * of some width round it. Internal to lp/.
 *
 * The depth of a place is the sum of the widths of the moats round it; two places can be paired at
 * no loss if their depths add up to their distance. A negative width of a single place is taken
 * from the moats round the place and its mate, which leaves every such sum as it is.
 *
 * Example: three odd places at distance 2 from each other in a blossom have width 1 each, and the
 * moat of the blossom comes on top of that. */
#include "lp/matching/blossom_parts.h"
#include "graph/sort.h"

#include <stdlib.h>
#include <string.h>

static thr_status allocate(thr_nest *nest, int n_odd, int n_blossoms, thr_err *err)
{
  size_t n = (size_t)n_odd + (size_t)n_blossoms;
  *nest = (thr_nest){.n_odd = n_odd, .n_sets = (int)n};
  nest->parent = thr_scratch_array(&nest->own, n, sizeof *nest->parent);
  nest->jump = thr_scratch_array(&nest->own, n, sizeof *nest->jump);
  nest->level = thr_scratch_array(&nest->own, n, sizeof *nest->level);
  nest->width = thr_scratch_array(&nest->own, n, sizeof *nest->width);
  nest->outer = thr_scratch_array(&nest->own, n, sizeof *nest->outer);
  thr_status st = thr_scratch_check(&nest->own, err);
  if (st) thr_nest_destroy(nest);
  return st;
}

void thr_nest_destroy(thr_nest *nest)
{
  thr_scratch_free(&nest->own);
  *nest = (thr_nest){0};
}

/* Levels and jumps: a set jumps as far as its parent's jump if that jump and the one after are as
 * long as each other, else to its parent (E. W. Myers, "An applicative random-access stack", Inf.
 * Proc. Letters 17, 1983). */
static void link_up(thr_nest *nest)
{
  for (int s = nest->n_sets - 1; s >= 0; s--) {
    int up = nest->parent[s], far = up < 0 ? -1 : nest->jump[up],
        farther = far < 0 ? -1 : nest->jump[far];
    nest->jump[s] = up;
    nest->level[s] = up < 0 ? 0 : nest->level[up] + 1;
    if (farther >= 0 &&
        nest->level[up] - nest->level[far] == nest->level[far] - nest->level[farther])
      nest->jump[s] = farther;
  }
}

/* Innermost common set of a and b, or -1. */
static int common_set(const thr_nest *nest, int a, int b)
{
  const int *level = nest->level, *jump = nest->jump;
  int low = level[a] > level[b] ? a : b, high = low == a ? b : a;
  while (level[low] > level[high])
    low = jump[low] >= 0 && level[jump[low]] >= level[high] ? jump[low] : nest->parent[low];
  while (low != high) { /* at equal levels jumps are equally long */
    bool far = jump[low] != jump[high];
    low = far ? jump[low] : nest->parent[low];
    high = far ? jump[high] : nest->parent[high];
  }
  return low;
}

static void take(thr_nest *nest, int set, int64_t *missing)
{
  int64_t part = nest->width[set] < *missing ? nest->width[set] : *missing;
  if (part <= 0) return;
  nest->width[set] -= part;
  *missing -= part;
}

/* The sets around i that do not hold its mate k, then those of k. chain[n_sets] is scratch space.
 */
static void raise_width(thr_nest *nest, int i, int k, int *chain)
{
  int64_t missing = -nest->width[i];
  int common = common_set(nest, i, k), n = 0;
  nest->width[i] = 0;
  for (int s = nest->parent[i]; s != common && missing; s = nest->parent[s])
    take(nest, s, &missing);
  for (int s = k; s != common; s = nest->parent[s])
    chain[n++] = s;
  while (n && missing)
    take(nest, chain[--n], &missing);
}

static void find_depths(thr_nest *nest)
{
  for (int s = nest->n_sets - 1; s >= 0; s--) {
    int up = nest->parent[s];
    nest->outer[s] = up < 0 ? 0 : nest->outer[up] + nest->width[up];
  }
}

thr_status thr_nest_init(thr_nest *nest, int n_odd, const thr_matching *matching, bool *raised,
                         thr_err *err)
{
  thr_status st = allocate(nest, n_odd, matching->n_blossoms, err);
  if (st) return st;
  int *chain = thr_calloc((size_t)nest->n_sets, sizeof *chain);
  if (!chain) {
    thr_nest_destroy(nest);
    return thr_nomem(err);
  }
  for (int s = 0; s < nest->n_sets; s++) {
    int up = s < n_odd ? matching->node_blossom[s] : matching->blossom_parent[s - n_odd];
    nest->parent[s] = up < 0 ? -1 : n_odd + up;
    nest->width[s] = s < n_odd ? matching->dual[s] : matching->blossom_dual[s - n_odd];
  }
  link_up(nest);
  for (int i = 0; i < n_odd; i++) {
    raised[i] = nest->width[i] < 0;
    if (raised[i]) raise_width(nest, i, matching->mate[i], chain);
  }
  free(chain);
  find_depths(nest);
  return THR_OK;
}

thr_status thr_nest_of_balls(thr_nest *nest, int n_odd, const int64_t *width, thr_err *err)
{
  thr_status st = allocate(nest, n_odd, 0, err);
  if (st) return st;
  memcpy(nest->width, width, (size_t)n_odd * sizeof *width);
  for (int i = 0; i < n_odd; i++)
    nest->parent[i] = nest->jump[i] = -1;
  return THR_OK;
}

int64_t thr_nest_shared_depth(const thr_nest *nest, int i, int j)
{
  int s = common_set(nest, i, j);
  return s < 0 ? 0 : nest->outer[s] + nest->width[s];
}

void thr_nest_depths(const thr_nest *nest, int64_t *start)
{
  for (int i = 0; i < nest->n_odd; i++)
    start[i] = nest->outer[i] + nest->width[i];
}

/* ---- cuts ---- */

typedef struct {
  const thr_nest *nest;
  const thr_network *net;
  const thr_flood *f;
  thr_scratch own;   /* all arrays but the cuts */
  int *set;          /* [n_places] in whose moat a place lies */
  int *first, *list; /* places of set s, deepest first: list[first[s] .. first[s + 1] - 1] */
  int *first_node; /* [n_places + 1] nodes of place v: node[first_node[v] .. first_node[v + 1] - 1]
                    */
  int *node;       /* [p->n_nodes] */
  int *open;       /* [n_sets] last of the cuts that still wait for the one around them, or -1 */
  int *last_open;  /* [n_sets] end of that list */
  int *waiting;    /* [cuts] the next in it, or -1 */
  thr_cut *cut;
  int n_cuts, capacity;
  int64_t sum;
} cutter;

static thr_status cutter_init(cutter *c, thr_err *err)
{
  const thr_network *net = c->net;
  size_t n = (size_t)net->n_places, sets = (size_t)c->nest->n_sets, nodes = (size_t)net->p->n_nodes;
  c->set = thr_scratch_array(&c->own, n, sizeof *c->set);
  c->first = thr_scratch_array(&c->own, sets + 2, sizeof *c->first);
  c->list = thr_scratch_array(&c->own, (size_t)c->f->n_reached, sizeof *c->list);
  c->first_node = thr_scratch_array(&c->own, n + 2, sizeof *c->first_node);
  c->node = thr_scratch_array(&c->own, nodes, sizeof *c->node);
  c->open = thr_scratch_array(&c->own, sets, sizeof *c->open);
  c->last_open = thr_scratch_array(&c->own, sets, sizeof *c->last_open);
  size_t most =
      (size_t)c->f->n_reached + sets; /* each cut is the first of a set or ends above a place */
  c->capacity = (int)most;
  c->cut = thr_calloc(most, sizeof *c->cut);
  c->waiting = thr_scratch_array(&c->own, most, sizeof *c->waiting);
  if (!c->cut) return thr_nomem(err);
  thr_status st = thr_scratch_check(&c->own, err);
  if (st) return st;
  memset(c->open, -1, sets * sizeof *c->open);
  return THR_OK;
}

/* The set of odd place i's in whose moat, or at whose inner edge, depth > 0 lies. O(log n_sets). */
static int set_at(const thr_nest *nest, int i, int64_t depth)
{
  int s = i;
  while (depth <= nest->outer[s]) {
    int far = nest->jump[s];
    s = far >= 0 && depth <= nest->outer[far] ? far : nest->parent[s];
  }
  return s;
}

/* Places by set, in the order in which the flood came; nodes by place, ascending. */
static void sort_places(cutter *c)
{
  const thr_flood *flood = c->f;
  for (int k = 0; k < flood->n_reached; k++) {
    int v = flood->order[k];
    c->set[v] = set_at(c->nest, flood->root[v], flood->depth[v]);
    c->first[c->set[v] + 2]++;
  }
  for (int s = 1; s <= c->nest->n_sets; s++)
    c->first[s + 1] += c->first[s];
  for (int k = 0; k < flood->n_reached; k++)
    c->list[c->first[c->set[flood->order[k]] + 1]++] = flood->order[k];
  for (int v = 0; v < c->net->p->n_nodes; v++)
    c->first_node[c->net->place[v] + 2]++;
  for (int v = 1; v <= c->net->n_places; v++)
    c->first_node[v + 1] += c->first_node[v];
  for (int v = 0; v < c->net->p->n_nodes; v++)
    c->node[c->first_node[c->net->place[v] + 1]++] = v;
}

/* A cut of set s: the places list[from .. end - 1] and all that waits inside. */
static thr_status add_cut(cutter *c, int s, int from, int end, int64_t width, thr_err *err)
{
  int n = 0, k = c->n_cuts;
  for (int i = from; i < end; i++)
    n += c->first_node[c->list[i] + 1] - c->first_node[c->list[i]];
  thr_cut *cut = &c->cut[k];
  *cut = (thr_cut){.parent = -1,
                   .node = thr_calloc((size_t)n, sizeof *cut->node),
                   .value = width * (THR_DUAL_DENOMINATOR / 2)};
  if (!cut->node) return thr_nomem(err);
  c->n_cuts++;
  c->sum += cut->value;
  for (int i = from; i < end; i++)
    for (int j = c->first_node[c->list[i]]; j < c->first_node[c->list[i] + 1]; j++)
      cut->node[cut->n_nodes++] = c->node[j];
  thr_sort_ints(cut->node, (size_t)n);
  for (int inside = c->open[s]; inside >= 0; inside = c->waiting[inside])
    c->cut[inside].parent = k;
  c->open[s] = c->last_open[s] = k;
  c->waiting[k] = -1;
  return THR_OK;
}

/* The moat of a set: one cut from each depth at which places come in to the next. */
static thr_status cut_moat(cutter *c, int s, thr_err *err)
{
  const thr_nest *nest = c->nest;
  int64_t bottom = nest->outer[s], depth = bottom + nest->width[s];
  thr_status st = THR_OK;
  for (int from = c->first[s], end = from; depth > bottom && !st; from = end) {
    while (end < c->first[s + 1] && c->f->depth[c->list[end]] == depth)
      end++;
    int64_t next = end < c->first[s + 1] ? c->f->depth[c->list[end]] : bottom;
    st = add_cut(c, s, from, end, depth - next, err);
    depth = next;
  }
  return st;
}

/* What waits inside set s waits inside its parent. */
static void hand_on(cutter *c, int s)
{
  int up = c->nest->parent[s];
  if (up < 0 || c->open[s] < 0) return;
  c->waiting[c->last_open[s]] = c->open[up];
  if (c->open[up] < 0) c->last_open[up] = c->last_open[s];
  c->open[up] = c->open[s];
}

thr_status thr_nest_cuts(const thr_nest *nest, const thr_network *net, const thr_flood *flood,
                         thr_cut **cut, int *n_cuts, int64_t *sum, thr_err *err)
{
  cutter c = {.nest = nest, .net = net, .f = flood};
  thr_status st = cutter_init(&c, err);
  if (!st) sort_places(&c);
  for (int s = 0; s < nest->n_sets && !st; s++) {
    st = cut_moat(&c, s, err);
    hand_on(&c, s);
  }
  thr_scratch_free(&c.own);
  if (st) {
    for (int k = 0; k < c.n_cuts; k++)
      free(c.cut[k].node);
    free(c.cut);
    c = (cutter){0};
  }
  *cut = c.cut;
  *n_cuts = c.n_cuts;
  *sum = c.sum;
  return st;
}
