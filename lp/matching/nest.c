/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays the duals of a matching out as nested moats, and turns the moats into odd cuts of the
 * problem. Every odd place and every blossom is a set with a moat round it, whose width is the
 * dual.
 *
 * The depth of a place is the sum of the widths of the moats that it lies inside of. Two places are
 * matched at no loss if their depths outside of the sets that hold both add up to their distance.
 * The dual of a single place may be negative, but the width of a moat may not: what is missing is
 * taken from the moats between the place and its mate, which leaves the sum of these two as it is.
 *
 * Example: three odd places at distance 2 from each other in a blossom have moats of width 1 each,
 * and the moat of the blossom lies around all three. */
#include "lp/matching/blossom_parts.h"

#include <stdlib.h>
#include <string.h>

/* Allocates a nest of the odd places and the blossoms. */
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

/* Computes the levels, and jumps that make searches outwards logarithmic: a set jumps as far as
 * the jump of its parent and the next jump from there lead, if these two are equally long, else
 * to its parent (E. W. Myers, "An applicative random-access stack", Inf. Proc. Letters 17,
 * 1983). */
static void link_up(thr_nest *nest)
{
  /* Parents come after their children, so that the parent of a set is done before the set. */
  for (int set = nest->n_sets - 1; set >= 0; set--) {
    int up = nest->parent[set], far = up < 0 ? -1 : nest->jump[up],
        farther = far < 0 ? -1 : nest->jump[far];

    nest->jump[set] = up;
    nest->level[set] = up < 0 ? 0 : nest->level[up] + 1;

    /* Two jumps of the same length make one. */
    if (farther >= 0 &&
        nest->level[up] - nest->level[far] == nest->level[far] - nest->level[farther])
      nest->jump[set] = farther;
  }
}

/* Returns the innermost set that holds both a and b, or -1. */
static int common_set(const thr_nest *nest, int a, int b)
{
  const int *level = nest->level, *jump = nest->jump;
  int low = level[a] > level[b] ? a : b, high = low == a ? b : a;

  /* Climb from the deeper set to the level of the other one. */
  while (level[low] > level[high])
    low = jump[low] >= 0 && level[jump[low]] >= level[high] ? jump[low] : nest->parent[low];

  /* Climb together. At equal levels jumps are equally long: jump unless both end in one set, which
   * need not be the innermost. */
  while (low != high) {
    bool far = jump[low] != jump[high];
    low = far ? jump[low] : nest->parent[low];
    high = far ? jump[high] : nest->parent[high];
  }
  return low;
}

/* Takes as much of the missing width as there is from the moat of a set. */
static void take_width(thr_nest *nest, int set, int64_t *missing)
{
  int64_t part = nest->width[set] < *missing ? nest->width[set] : *missing;
  if (part <= 0) return;
  nest->width[set] -= part;
  *missing -= part;
}

/* Raises the negative width of odd place i to 0, at the cost of the moats between i and its mate
 * k: those round i that do not hold k, from the inside outwards, then those round k that do not
 * hold i, from the outside inwards. chain[n_sets] is scratch space. */
static void raise_width(thr_nest *nest, int i, int k, int *chain)
{
  int64_t missing = -nest->width[i];
  int common = common_set(nest, i, k), n = 0;
  nest->width[i] = 0;

  /* The moats round i. */
  for (int set = nest->parent[i]; set != common && missing; set = nest->parent[set])
    take_width(nest, set, &missing);

  /* The moats round k, of which the inner ones are listed first and served last. */
  for (int set = k; set != common; set = nest->parent[set])
    chain[n++] = set;
  while (n && missing)
    take_width(nest, chain[--n], &missing);
}

/* Computes the depth just outside of every moat, parents first. */
static void find_depths(thr_nest *nest)
{
  for (int set = nest->n_sets - 1; set >= 0; set--) {
    int up = nest->parent[set];
    nest->outer[set] = up < 0 ? 0 : nest->outer[up] + nest->width[up];
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

  /* The sets are the odd places, then the blossoms. */
  for (int set = 0; set < nest->n_sets; set++) {
    int up = set < n_odd ? matching->node_blossom[set] : matching->blossom_parent[set - n_odd];
    nest->parent[set] = up < 0 ? -1 : n_odd + up;
    nest->width[set] = set < n_odd ? matching->dual[set] : matching->blossom_dual[set - n_odd];
  }
  link_up(nest);

  /* No place may have a negative width. */
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

  /* A ball lies in no other set. */
  for (int i = 0; i < n_odd; i++)
    nest->parent[i] = nest->jump[i] = -1;
  return THR_OK;
}

int64_t thr_nest_shared_depth(const thr_nest *nest, int i, int j)
{
  int set = common_set(nest, i, j);
  return set < 0 ? 0 : nest->outer[set] + nest->width[set];
}

void thr_nest_depths(const thr_nest *nest, int64_t *start)
{
  for (int i = 0; i < nest->n_odd; i++)
    start[i] = nest->outer[i] + nest->width[i];
}

/* ---- cuts ---- */

/* The moats on their way to cuts. Sets are visited children first; the cuts inside a set that have
 * no parent yet wait in a list for the next cut around them. */
typedef struct {
  const thr_nest *nest;
  const thr_network *net;
  const thr_flood *flood;
  thr_scratch own;   /* all arrays but the cuts */
  int *set;          /* [n_places] in whose moat a place lies */
  int *first, *list; /* places of set s, deepest first: list[first[s] .. first[s + 1] - 1] */
  int *first_node;   /* [n_places + 1] nodes of place v: node[first_node[v] ..
                        first_node[v + 1] - 1] */
  int *node;         /* [p->n_nodes] */
  int *open;         /* [n_sets] first of the cuts inside that wait for a parent, or -1 */
  int *last_open;    /* [n_sets] last of them */
  int *waiting;      /* [cuts] the next one in the list, or -1 */
  thr_cut *cut;
  int n_cuts;
  int64_t sum;
} moat_cutter;

/* Allocates for all places, sets and cuts. */
static thr_status cutter_init(moat_cutter *cutter, thr_err *err)
{
  const thr_network *net = cutter->net;
  size_t n = (size_t)net->n_places, sets = (size_t)cutter->nest->n_sets,
         nodes = (size_t)net->p->n_nodes;
  cutter->set = thr_scratch_array(&cutter->own, n, sizeof *cutter->set);
  cutter->first = thr_scratch_array(&cutter->own, sets + 2, sizeof *cutter->first);
  cutter->list =
      thr_scratch_array(&cutter->own, (size_t)cutter->flood->n_reached, sizeof *cutter->list);
  cutter->first_node = thr_scratch_array(&cutter->own, n + 2, sizeof *cutter->first_node);
  cutter->node = thr_scratch_array(&cutter->own, nodes, sizeof *cutter->node);
  cutter->open = thr_scratch_array(&cutter->own, sets, sizeof *cutter->open);
  cutter->last_open = thr_scratch_array(&cutter->own, sets, sizeof *cutter->last_open);

  /* Each cut is the outermost of its set or ends at the depth of a place. */
  size_t most = (size_t)cutter->flood->n_reached + sets;
  cutter->cut = thr_calloc(most, sizeof *cutter->cut);
  cutter->waiting = thr_scratch_array(&cutter->own, most, sizeof *cutter->waiting);
  if (!cutter->cut) return thr_nomem(err);
  thr_status st = thr_scratch_check(&cutter->own, err);
  if (st) return st;

  /* No cut waits. */
  memset(cutter->open, -1, sets * sizeof *cutter->open);
  return THR_OK;
}

/* Returns the set round odd place i in whose moat, or at whose inner edge, depth > 0 lies. O(log
 * n_sets). */
static int set_at(const thr_nest *nest, int i, int64_t depth)
{
  int set = i;
  while (depth <= nest->outer[set]) {
    int far = nest->jump[set];
    set = far >= 0 && depth <= nest->outer[far] ? far : nest->parent[set];
  }
  return set;
}

/* Sorts the places by set, in the order in which the flood came, and the nodes by place,
 * ascending. */
static void sort_places(moat_cutter *cutter)
{
  /* Find the set of every place, and count. */
  const thr_flood *flood = cutter->flood;
  for (int k = 0; k < flood->n_reached; k++) {
    int v = flood->order[k];
    cutter->set[v] = set_at(cutter->nest, flood->root[v], flood->depth[v]);
    cutter->first[cutter->set[v] + 2]++;
  }
  for (int set = 1; set <= cutter->nest->n_sets; set++)
    cutter->first[set + 1] += cutter->first[set];

  /* Deepest first within a set, as the flood came. */
  for (int k = 0; k < flood->n_reached; k++)
    cutter->list[cutter->first[cutter->set[flood->order[k]] + 1]++] = flood->order[k];

  /* The nodes of every place. */
  for (int v = 0; v < cutter->net->p->n_nodes; v++)
    cutter->first_node[cutter->net->place[v] + 2]++;
  for (int v = 1; v <= cutter->net->n_places; v++)
    cutter->first_node[v + 1] += cutter->first_node[v];
  for (int v = 0; v < cutter->net->p->n_nodes; v++)
    cutter->node[cutter->first_node[cutter->net->place[v] + 1]++] = v;
}

/* Adds a cut of a set: the places list[from .. end - 1] and all cuts that wait inside of the
 * set. */
static thr_status add_cut(moat_cutter *cutter, int set, int from, int end, int64_t width,
                          thr_err *err)
{
  int n = 0, k = cutter->n_cuts;

  /* Count the nodes and allocate. */
  for (int i = from; i < end; i++)
    n += cutter->first_node[cutter->list[i] + 1] - cutter->first_node[cutter->list[i]];
  thr_cut *cut = &cutter->cut[k];
  *cut = (thr_cut){.parent = -1,
                   .node = thr_calloc((size_t)n, sizeof *cut->node),
                   .value = width * (THR_DUAL_DENOMINATOR / 2)};
  if (!cut->node) return thr_nomem(err);

  cutter->n_cuts++;
  cutter->sum += cut->value;

  /* Copy the nodes. */
  for (int i = from; i < end; i++)
    for (int j = cutter->first_node[cutter->list[i]]; j < cutter->first_node[cutter->list[i] + 1];
         j++)
      cut->node[cut->n_nodes++] = cutter->node[j];
  thr_sort_ints(cut->node, (size_t)n);

  /* The cuts inside get their parent, and now the new cut waits. */
  for (int inside = cutter->open[set]; inside >= 0; inside = cutter->waiting[inside])
    cutter->cut[inside].parent = k;
  cutter->open[set] = cutter->last_open[set] = k;
  cutter->waiting[k] = -1;
  return THR_OK;
}

/* Cuts the moat of a set at every depth where places come in: from each such depth to the next,
 * the cut is the places reached so far. */
static thr_status cut_moat(moat_cutter *cutter, int set, thr_err *err)
{
  const thr_nest *nest = cutter->nest;
  int64_t bottom = nest->outer[set], depth = bottom + nest->width[set];
  thr_status st = THR_OK;
  for (int from = cutter->first[set], end = from; depth > bottom && !st; from = end) {
    /* Take the places at this depth. */
    while (end < cutter->first[set + 1] && cutter->flood->depth[cutter->list[end]] == depth)
      end++;

    /* The cut goes down to the next depth with a place, or to the outer edge of the moat. */
    int64_t next = end < cutter->first[set + 1] ? cutter->flood->depth[cutter->list[end]] : bottom;
    st = add_cut(cutter, set, from, end, depth - next, err);
    depth = next;
  }
  return st;
}

/* Passes the cuts that wait inside a set on to the parent of the set. */
static void hand_on(moat_cutter *cutter, int set)
{
  int up = cutter->nest->parent[set];
  if (up < 0 || cutter->open[set] < 0) return;

  /* Put the list in front of the parent's. */
  cutter->waiting[cutter->last_open[set]] = cutter->open[up];
  if (cutter->open[up] < 0) cutter->last_open[up] = cutter->last_open[set];
  cutter->open[up] = cutter->open[set];
}

thr_status thr_nest_cuts(const thr_nest *nest, const thr_network *net, const thr_flood *flood,
                         thr_cut **cut, int *n_cuts, int64_t *sum, thr_err *err)
{
  moat_cutter cutter = {.nest = nest, .net = net, .flood = flood};
  thr_status st = cutter_init(&cutter, err);

  if (!st) sort_places(&cutter);

  /* Children come before their parents, so that a cut is there before the one around it. */
  for (int set = 0; set < nest->n_sets && !st; set++) {
    st = cut_moat(&cutter, set, err);
    hand_on(&cutter, set);
  }

  thr_scratch_free(&cutter.own);

  /* On failure nothing stays allocated. */
  if (st) {
    for (int k = 0; k < cutter.n_cuts; k++)
      free(cutter.cut[k].node);
    free(cutter.cut);
    cutter = (moat_cutter){0};
  }

  *cut = cutter.cut;
  *n_cuts = cutter.n_cuts;
  *sum = cutter.sum;
  return st;
}
