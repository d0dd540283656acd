/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forests of cuts (graph/plan/plan.h, thr_cut): nesting sets in each other, and changing the side
 * of a cut. Internal to lp/.
 *
 * Each cut lists only the nodes that no set inside it has; the whole set is the list with those of
 * all sets inside. A set and its complement have the same cut, so any set may be replaced by the
 * nodes outside of it.
 *
 * Example: {0, 1, 2} round {0} is kept as the cut {0} and, outside it, the cut with the list 1, 2.
 */
#include "lp/tjoin/tjoin.h"
#include "graph/scratch.h"
#include "graph/sort.h"

#include <stdlib.h>

void thr_cuts_destroy(thr_cuts *cuts)
{
  for (int i = 0; cuts->cut && i < cuts->n; i++)
    free(cuts->cut[i].node);
  free(cuts->cut);
  *cuts = (thr_cuts){0};
}

/* order[n]: children before their parents. */
static thr_status children_first(const thr_cuts *cuts, int *order, thr_err *err)
{
  int *left = thr_calloc((size_t)cuts->n, sizeof *left), count = 0;
  if (!left) return thr_nomem(err);
  for (int i = 0; i < cuts->n; i++)
    if (cuts->cut[i].parent >= 0) left[cuts->cut[i].parent]++;
  for (int i = 0; i < cuts->n; i++)
    for (int at = i; at >= 0 && left[at] == 0; at = cuts->cut[at].parent) {
      order[count++] = at;
      left[at] = -1; /* listed */
      if (cuts->cut[at].parent >= 0) left[cuts->cut[at].parent]--;
    }
  free(left);
  return THR_OK;
}

static thr_status reorder(thr_cuts *cuts, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  int *order = thr_calloc(n, sizeof *order), *place = thr_calloc(n, sizeof *place);
  thr_cut *sorted = thr_calloc(n, sizeof *sorted);
  thr_status st = order && place && sorted ? children_first(cuts, order, err) : thr_nomem(err);
  for (int i = 0; i < cuts->n && !st; i++)
    place[order[i]] = i;
  for (int i = 0; i < cuts->n && !st; i++) {
    thr_cut *to = &sorted[place[i]];
    *to = cuts->cut[i];
    if (to->parent >= 0) to->parent = place[to->parent];
  }
  if (!st) {
    free(cuts->cut);
    cuts->cut = sorted;
    sorted = NULL;
  }
  free(order);
  free(place);
  free(sorted);
  return st;
}

/* ---- nesting ---- */

typedef struct {
  int total, root; /* nodes of the tree with this root */
} tree;

static int smaller_first(const void *pa, const void *pb)
{
  const tree *a = pa, *b = pb;
  if (a->total != b->total) return a->total < b->total ? -1 : 1;
  return a->root - b->root;
}

/* Trees are those given. Arrays of n cuts but for outer. */
typedef struct {
  int *root, *first, *next; /* of a cut; at a root, the first cut of its tree; the next one of the
                               same tree, or -1 */
  int *total;               /* at a root, nodes of the tree */
  int *met, *met_by;        /* at a root, own nodes of the cut met_by that are in its tree */
  int *outer; /* [n_nodes] root of the last tree that was looked at and holds the node, -1 = none */
  tree *by_size;
  thr_scratch own; /* the arrays */
} nesting;

static void nesting_destroy(nesting *s)
{
  thr_scratch_free(&s->own);
}

static thr_status nesting_init(nesting *s, const thr_cuts *cuts, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  *s = (nesting){0};
  int *order = thr_scratch_array(&s->own, n, sizeof *order);
  s->root = thr_scratch_array(&s->own, n, sizeof *s->root);
  s->first = thr_scratch_array(&s->own, n, sizeof *s->first);
  s->next = thr_scratch_array(&s->own, n, sizeof *s->next);
  s->total = thr_scratch_array(&s->own, n, sizeof *s->total);
  s->met = thr_scratch_array(&s->own, n, sizeof *s->met);
  s->met_by = thr_scratch_array(&s->own, n, sizeof *s->met_by);
  s->outer = thr_scratch_array(&s->own, (size_t)cuts->n_nodes, sizeof *s->outer);
  s->by_size = thr_scratch_array(&s->own, n, sizeof *s->by_size);
  thr_status st = thr_scratch_check(&s->own, err);
  if (!st) st = children_first(cuts, order, err);
  for (int i = 0; i < cuts->n && !st; i++)
    s->first[i] = s->met_by[i] = -1;
  for (int v = 0; v < cuts->n_nodes && !st; v++)
    s->outer[v] = -1;
  for (int k = cuts->n - 1; k >= 0 && !st; k--) {
    int i = order[k], p = cuts->cut[i].parent, root = p < 0 ? i : s->root[p];
    s->root[i] = root;
    s->next[i] = s->first[root];
    s->first[root] = i;
    s->total[root] += cuts->cut[i].n_nodes;
  }
  return st;
}

/* Trees all of whose nodes are own nodes of this cut, and in no tree looked at later, become its
 * children. */
static void adopt(thr_cuts *cuts, nesting *s, int to)
{
  thr_cut *cut = &cuts->cut[to];
  int kept = 0;
  for (int j = 0; j < cut->n_nodes; j++) {
    int inner = s->outer[cut->node[j]];
    if (inner < 0) continue;
    if (s->met_by[inner] != to) s->met[inner] = 0;
    s->met_by[inner] = to;
    s->met[inner]++;
  }
  for (int j = 0; j < cut->n_nodes; j++) {
    int v = cut->node[j], inner = s->outer[v];
    s->outer[v] = s->root[to];
    if (inner >= 0 && s->met[inner] == s->total[inner])
      cuts->cut[inner].parent = to;
    else
      cut->node[kept++] = v;
  }
  cut->n_nodes = kept;
}

thr_status thr_cuts_nest(thr_cuts *cuts, thr_err *err)
{
  nesting s;
  int n_trees = 0;
  thr_status st = nesting_init(&s, cuts, err);
  for (int i = 0; i < cuts->n && !st; i++)
    if (cuts->cut[i].parent < 0) s.by_size[n_trees++] = (tree){s.total[i], i};
  if (!st && n_trees > 0) qsort(s.by_size, (size_t)n_trees, sizeof *s.by_size, smaller_first);
  for (int k = 0; k < n_trees && !st; k++)
    for (int i = s.first[s.by_size[k].root]; i >= 0; i = s.next[i])
      adopt(cuts, &s, i);
  nesting_destroy(&s);
  return st ? st : reorder(cuts, err);
}

/* ---- the other side ---- */

/* Marks all nodes of the tree as member; list of its cuts by next, as in nesting. */
static void mark_tree(const thr_cuts *cuts, const nesting *s, int root, bool member,
                      bool *is_member)
{
  for (int i = s->first[root]; i >= 0; i = s->next[i])
    for (int j = 0; j < cuts->cut[i].n_nodes; j++)
      is_member[cuts->cut[i].node[j]] = member;
}

/* The nodes outside of the tree. */
static thr_status outside(const thr_cuts *cuts, const nesting *s, int root, bool *is_member,
                          thr_cut *out, thr_err *err)
{
  out->node = thr_calloc((size_t)(cuts->n_nodes - s->total[root]), sizeof *out->node);
  if (!out->node) return thr_nomem(err);
  mark_tree(cuts, s, root, true, is_member);
  for (int v = 0; v < cuts->n_nodes; v++)
    if (!is_member[v]) out->node[out->n_nodes++] = v;
  mark_tree(cuts, s, root, false, is_member);
  return THR_OK;
}

/* Of the cuts that hold the last node: A1 in A2 in .. in Ak, for every tree with one. */
typedef struct {
  bool *holds;     /* [n] is it one? */
  int *inner;      /* [n] of A(i), A(i-1); -1 = none */
  bool *is_member; /* [n_nodes] all false between calls */
  thr_cut *fresh;  /* [n] of A(k): the nodes outside of it, owned */
} chains;

static void chains_destroy(chains *h, int n)
{
  for (int i = 0; h->fresh && i < n; i++)
    free(h->fresh[i].node);
  free(h->holds);
  free(h->inner);
  free(h->is_member);
  free(h->fresh);
}

static thr_status chains_init(chains *h, const thr_cuts *cuts, const nesting *s, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  *h = (chains){.holds = thr_calloc(n, sizeof *h->holds),
                .inner = thr_calloc(n, sizeof *h->inner),
                .is_member = thr_calloc((size_t)cuts->n_nodes, sizeof *h->is_member),
                .fresh = thr_calloc(n, sizeof *h->fresh)};
  if (!h->holds || !h->inner || !h->is_member || !h->fresh) return thr_nomem(err);
  for (int i = 0; i < cuts->n; i++)
    h->inner[i] = -1;
  for (int i = 0; i < cuts->n; i++) {
    const thr_cut *cut = &cuts->cut[i];
    if (cut->n_nodes > 0 && cut->node[cut->n_nodes - 1] == cuts->n_nodes - 1) h->holds[i] = true;
    if (!h->holds[i]) continue;
    thr_status st = cut->parent < 0 ? outside(cuts, s, i, h->is_member, &h->fresh[i], err) : THR_OK;
    if (st) return st;
    if (cut->parent < 0) continue;
    h->holds[cut->parent] = true;
    h->inner[cut->parent] = i;
  }
  return THR_OK;
}

/* They become B1 .. Bk, where Bi is all but Ai: Bk in .. in B1. What is in A(i+1) but not in Ai,
 * own nodes and children, is in Bi but not in B(i+1); what is in A1 is in none. */
static void turn_chains(thr_cuts *cuts, chains *h)
{
  for (int i = 0; i < cuts->n; i++) {
    thr_cut *cut = &cuts->cut[i];
    if (!h->holds[i] && cut->parent >= 0 && h->holds[cut->parent])
      cut->parent = h->inner[cut->parent];
  }
  for (int lowest = 0; lowest < cuts->n; lowest++) {
    if (!h->holds[lowest] || h->inner[lowest] >= 0) continue;
    free(cuts->cut[lowest].node);
    for (int i = lowest, outer; i >= 0; i = outer) {
      thr_cut *from = (outer = cuts->cut[i].parent) >= 0 ? &cuts->cut[outer] : &h->fresh[i];
      cuts->cut[i].node = from->node;
      cuts->cut[i].n_nodes = from->n_nodes;
      cuts->cut[i].parent = h->inner[i];
      from->node = NULL;
    }
  }
}

thr_status thr_cuts_avoid_last(thr_cuts *cuts, thr_err *err)
{
  nesting s;
  chains h = {0};
  thr_status st = nesting_init(&s, cuts, err);
  if (!st) st = chains_init(&h, cuts, &s, err);
  if (!st) turn_chains(cuts, &h);
  if (!st) cuts->n_nodes--;
  chains_destroy(&h, cuts->n);
  nesting_destroy(&s);
  return st;
}

/* ---- fewer cuts ---- */

/* Appends the nodes of the dropped cuts to to[i], the next cut round i that stays. more[n] is all
 * 0. */
static thr_status pass_nodes_on(thr_cuts *cuts, const bool *drop, const int *to, int *more,
                                thr_err *err)
{
  for (int i = 0; i < cuts->n; i++)
    if (drop[i] && to[i] >= 0) more[to[i]] += cuts->cut[i].n_nodes;
  for (int i = 0; i < cuts->n; i++) {
    if (more[i] == 0) continue;
    int *node = thr_realloc(cuts->cut[i].node, (size_t)cuts->cut[i].n_nodes + (size_t)more[i],
                            sizeof *node);
    if (!node) return thr_nomem(err);
    cuts->cut[i].node = node;
  }
  for (int i = 0; i < cuts->n; i++) {
    thr_cut *from = &cuts->cut[i];
    if (!drop[i] || to[i] < 0) continue;
    thr_cut *outer = &cuts->cut[to[i]];
    for (int j = 0; j < from->n_nodes; j++)
      outer->node[outer->n_nodes++] = from->node[j];
  }
  for (int i = 0; i < cuts->n; i++)
    thr_sort_ints(cuts->cut[i].node, (size_t)cuts->cut[i].n_nodes);
  return THR_OK;
}

thr_status thr_cuts_drop(thr_cuts *cuts, const bool *drop, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  int *to = thr_calloc(n, sizeof *to), *more = thr_calloc(n, sizeof *more), *place = more, kept = 0;
  thr_status st = to && more ? THR_OK : thr_nomem(err);
  for (int i = cuts->n - 1; i >= 0 && !st; i--) {
    int p = cuts->cut[i].parent;
    to[i] = p >= 0 && drop[p] ? to[p] : p;
  }
  if (!st) st = pass_nodes_on(cuts, drop, to, more, err);
  for (int i = 0; i < cuts->n && !st; i++) {
    if (drop[i]) {
      free(cuts->cut[i].node);
      continue;
    }
    cuts->cut[kept] = cuts->cut[i];
    cuts->cut[kept].parent = to[i];
    place[i] = kept++;
  }
  for (int i = 0; i < kept; i++)
    if (cuts->cut[i].parent >= 0) cuts->cut[i].parent = place[cuts->cut[i].parent];
  if (!st) cuts->n = kept;
  free(to);
  free(more);
  return st;
}

thr_status thr_cuts_held(const thr_cuts *cuts, int64_t *held, thr_err *err)
{
  int64_t *depth = thr_calloc((size_t)cuts->n, sizeof *depth);
  if (!depth) return thr_nomem(err);
  for (int i = cuts->n - 1; i >= 0; i--) {
    const thr_cut *cut = &cuts->cut[i];
    depth[i] = cut->value + (cut->parent >= 0 ? depth[cut->parent] : 0);
    for (int j = 0; j < cut->n_nodes; j++)
      held[cut->node[j]] += depth[i];
  }
  free(depth);
  return THR_OK;
}
