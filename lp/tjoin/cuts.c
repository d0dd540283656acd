/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes forests of cuts (graph/plan/plan.h, thr_cut): nests disjoint trees of cuts in each other,
 * replaces sets by their complements, and removes cuts.
 *
 * Each cut lists only its own nodes, which no cut inside of it has; the set of a cut is the list of
 * its own nodes together with the lists of all cuts inside. A set and its complement are left by
 * the same edges, so that any set may be replaced by its complement.
 *
 * Example: the set {0, 1, 2} round the set {0} is kept as a cut with the list 0 and its parent with
 * the list 1, 2. */
#include "lp/tjoin/tjoin.h"
#include "graph/arrays.h"

#include <stdlib.h>

void thr_cuts_destroy(thr_cuts *cuts)
{
  for (int i = 0; cuts->cut && i < cuts->n; i++)
    free(cuts->cut[i].node);
  free(cuts->cut);
  *cuts = (thr_cuts){0};
}

/* Fills order[n] with all cuts, children before their parents. */
static thr_status children_first(const thr_cuts *cuts, int *order, thr_err *err)
{
  int *left = thr_calloc((size_t)cuts->n, sizeof *left), count = 0;
  if (!left) return thr_nomem(err);

  /* Count the children of every cut that are not listed yet. */
  for (int i = 0; i < cuts->n; i++)
    if (cuts->cut[i].parent >= 0) left[cuts->cut[i].parent]++;

  /* List every cut without such children, and then each ancestor that has become one. */
  for (int i = 0; i < cuts->n; i++)
    for (int at = i; at >= 0 && left[at] == 0; at = cuts->cut[at].parent) {
      order[count++] = at;
      left[at] = -1; /* listed, and never taken again */
      if (cuts->cut[at].parent >= 0) left[cuts->cut[at].parent]--;
    }

  free(left);
  return THR_OK;
}

/* Sorts the cuts so that children come before their parents. */
static thr_status reorder(thr_cuts *cuts, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  int *order = thr_calloc(n, sizeof *order), *place = thr_calloc(n, sizeof *place);
  thr_cut *sorted = thr_calloc(n, sizeof *sorted);
  thr_status st = order && place && sorted ? children_first(cuts, order, err) : thr_nomem(err);

  /* place[i] is the new number of cut i, for itself and as a parent. */
  for (int i = 0; i < cuts->n && !st; i++)
    place[order[i]] = i;
  for (int i = 0; i < cuts->n && !st; i++) {
    thr_cut *to = &sorted[place[i]];
    *to = cuts->cut[i];
    if (to->parent >= 0) to->parent = place[to->parent];
  }

  /* Replace the old array. */
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

/* The trees of a forest before any of them becomes the child of a cut in another one. Arrays are by
 * cut but for outer. */
typedef struct {
  int *root;         /* root of the cut's tree */
  int *first, *next; /* first[root]: first cut of the tree; next: the next one there, or -1 */
  int *total;        /* at a root, nodes of the tree */
  int *met, *met_by; /* at a root, number of own nodes of the cut met_by that are in its tree */
  int *outer;        /* [n_nodes] root of the last tree visited that holds the node, -1 = none */
  thr_ranked *by_size;
  thr_scratch own; /* the arrays */
} cut_nesting;

/* Lists the cuts of every tree and counts their nodes. */
static thr_status nesting_init(cut_nesting *nesting, const thr_cuts *cuts, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  *nesting = (cut_nesting){0};

  int *order = thr_scratch_array(&nesting->own, n, sizeof *order);
  nesting->root = thr_scratch_array(&nesting->own, n, sizeof *nesting->root);
  nesting->first = thr_scratch_array(&nesting->own, n, sizeof *nesting->first);
  nesting->next = thr_scratch_array(&nesting->own, n, sizeof *nesting->next);
  nesting->total = thr_scratch_array(&nesting->own, n, sizeof *nesting->total);
  nesting->met = thr_scratch_array(&nesting->own, n, sizeof *nesting->met);
  nesting->met_by = thr_scratch_array(&nesting->own, n, sizeof *nesting->met_by);
  nesting->outer = thr_scratch_array(&nesting->own, (size_t)cuts->n_nodes, sizeof *nesting->outer);
  nesting->by_size = thr_scratch_array(&nesting->own, n, sizeof *nesting->by_size);
  thr_status st = thr_scratch_check(&nesting->own, err);
  if (!st) st = children_first(cuts, order, err);

  /* No tree has been visited. */
  for (int i = 0; i < cuts->n && !st; i++)
    nesting->first[i] = nesting->met_by[i] = -1;
  for (int v = 0; v < cuts->n_nodes && !st; v++)
    nesting->outer[v] = -1;

  /* Parents come before their children here, so that the root of a parent is known. */
  for (int k = cuts->n - 1; k >= 0 && !st; k--) {
    int i = order[k], parent = cuts->cut[i].parent, root = parent < 0 ? i : nesting->root[parent];
    nesting->root[i] = root;
    nesting->next[i] = nesting->first[root];
    nesting->first[root] = i;
    nesting->total[root] += cuts->cut[i].n_nodes;
  }

  return st;
}

/* Makes every tree visited so far a child of the cut number to if all nodes of the tree are own
 * nodes of this cut and no tree visited later has one of these nodes. */
static void adopt(thr_cuts *cuts, cut_nesting *nesting, int to)
{
  thr_cut *cut = &cuts->cut[to];
  int kept = 0;

  /* Count the own nodes that lie in each of the trees. */
  for (int j = 0; j < cut->n_nodes; j++) {
    int inner = nesting->outer[cut->node[j]];
    if (inner < 0) continue;
    if (nesting->met_by[inner] != to) nesting->met[inner] = 0;
    nesting->met_by[inner] = to;
    nesting->met[inner]++;
  }

  /* A tree that lies wholly among the own nodes becomes a child, and takes its nodes along. */
  for (int j = 0; j < cut->n_nodes; j++) {
    int v = cut->node[j], inner = nesting->outer[v];
    nesting->outer[v] = nesting->root[to];
    if (inner >= 0 && nesting->met[inner] == nesting->total[inner])
      cuts->cut[inner].parent = to;
    else
      cut->node[kept++] = v;
  }

  cut->n_nodes = kept;
}

thr_status thr_cuts_nest(thr_cuts *cuts, thr_err *err)

{
  cut_nesting nesting;
  int n_trees = 0;
  thr_status st = nesting_init(&nesting, cuts, err);

  /* Visit the trees by size, so that a set is visited before the sets that may hold it. */
  for (int i = 0; i < cuts->n && !st; i++)
    if (cuts->cut[i].parent < 0) nesting.by_size[n_trees++] = (thr_ranked){nesting.total[i], i};
  if (!st && n_trees > 0) thr_sort_ranked(nesting.by_size, (size_t)n_trees);

  for (int k = 0; k < n_trees && !st; k++)
    for (int i = nesting.first[nesting.by_size[k].index]; i >= 0; i = nesting.next[i])
      adopt(cuts, &nesting, i);

  thr_scratch_free(&nesting.own);
  return st ? st : reorder(cuts, err);
}

/* ---- the other side ---- */

/* Marks or unmarks all nodes of a tree in is_member. */
static void mark_tree(const thr_cuts *cuts, const cut_nesting *nesting, int root, bool member,
                      bool *is_member)
{
  for (int i = nesting->first[root]; i >= 0; i = nesting->next[i])
    for (int j = 0; j < cuts->cut[i].n_nodes; j++)
      is_member[cuts->cut[i].node[j]] = member;
}

/* Fills out with the nodes outside of a tree. */
static thr_status outside(const thr_cuts *cuts, const cut_nesting *nesting, int root,
                          bool *is_member, thr_cut *out, thr_err *err)
{
  out->node = thr_calloc((size_t)(cuts->n_nodes - nesting->total[root]), sizeof *out->node);
  if (!out->node) return thr_nomem(err);

  mark_tree(cuts, nesting, root, true, is_member);
  for (int v = 0; v < cuts->n_nodes; v++)
    if (!is_member[v]) out->node[out->n_nodes++] = v;

  mark_tree(cuts, nesting, root, false, is_member);
  return THR_OK;
}

/* Of every tree with the last node, the chain of sets with this node: A1 within A2 within .. Ak,
 * where Ak is the root. */
typedef struct {
  bool *holds;     /* [n] does the set hold the last node? */
  int *inner;      /* [n] of A(i), the cut A(i - 1); -1 = none */
  bool *is_member; /* [n_nodes] all false between calls */
  thr_cut *fresh;  /* [n] of Ak, the nodes outside of the set; owned */
} cut_chains;

/* Releases the chains of a forest of n cuts, and outsides that no cut has taken over. */
static void chains_destroy(cut_chains *chains, int n)
{
  for (int i = 0; chains->fresh && i < n; i++)
    free(chains->fresh[i].node);
  free(chains->holds);
  free(chains->inner);
  free(chains->is_member);
  free(chains->fresh);
}

/* Finds the chains, and the nodes outside of each of their roots. */
static thr_status chains_init(cut_chains *chains, const thr_cuts *cuts, const cut_nesting *nesting,
                              thr_err *err)
{
  size_t n = (size_t)cuts->n;
  *chains = (cut_chains){.holds = thr_calloc(n, sizeof *chains->holds),
                         .inner = thr_calloc(n, sizeof *chains->inner),
                         .is_member = thr_calloc((size_t)cuts->n_nodes, sizeof *chains->is_member),
                         .fresh = thr_calloc(n, sizeof *chains->fresh)};
  if (!chains->holds || !chains->inner || !chains->is_member || !chains->fresh)
    return thr_nomem(err);

  /* Own nodes ascend, so the last node is the last of its cut's list. */
  for (int i = 0; i < cuts->n; i++)
    chains->inner[i] = -1;
  for (int i = 0; i < cuts->n; i++) {
    const thr_cut *cut = &cuts->cut[i];
    if (cut->n_nodes > 0 && cut->node[cut->n_nodes - 1] == cuts->n_nodes - 1)
      chains->holds[i] = true;

    /* Children come first: the cut passes the mark on to its parent, and a root gets its
     * outside. */
    if (!chains->holds[i]) continue;
    thr_status st = cut->parent < 0
                        ? outside(cuts, nesting, i, chains->is_member, &chains->fresh[i], err)
                        : THR_OK;
    if (st) return st;
    if (cut->parent < 0) continue;
    chains->holds[cut->parent] = true;
    chains->inner[cut->parent] = i;
  }
  return THR_OK;
}

/* Replaces the sets of every chain by their complements B1 .. Bk, where Bk is within B(k - 1) ..
 * B1. Own nodes and children that are in A(i + 1) but not in A(i) are in B(i) but not in B(i +
 * 1). What is in A1 is in no complement. */
static void turn_chains(thr_cuts *cuts, cut_chains *chains)
{
  /* Children that are no links of a chain move to the complement that holds them. */
  for (int i = 0; i < cuts->n; i++) {
    thr_cut *cut = &cuts->cut[i];
    if (!chains->holds[i] && cut->parent >= 0 && chains->holds[cut->parent])
      cut->parent = chains->inner[cut->parent];
  }

  /* Every link takes over the own nodes of the one around it; the outermost gets the outside. */
  for (int lowest = 0; lowest < cuts->n; lowest++) {
    if (!chains->holds[lowest] || chains->inner[lowest] >= 0) continue;
    free(cuts->cut[lowest].node);
    for (int i = lowest, outer; i >= 0; i = outer) {
      thr_cut *source = (outer = cuts->cut[i].parent) >= 0 ? &cuts->cut[outer] : &chains->fresh[i];
      cuts->cut[i].node = source->node;
      cuts->cut[i].n_nodes = source->n_nodes;
      cuts->cut[i].parent = chains->inner[i];
      source->node = NULL;
    }
  }
}

thr_status thr_cuts_avoid_last(thr_cuts *cuts, thr_err *err)
{
  cut_nesting nesting;
  cut_chains chains = {0};

  thr_status st = nesting_init(&nesting, cuts, err);
  if (!st) st = chains_init(&chains, cuts, &nesting, err);
  if (!st) turn_chains(cuts, &chains);
  if (!st) cuts->n_nodes--;

  chains_destroy(&chains, cuts->n);
  thr_scratch_free(&nesting.own);
  return st;
}

/* ---- fewer cuts ---- */

/* Appends the nodes of each dropped cut i to the cut to[i], the next one round it that stays.
 * more[n] is all 0 at first. */
static thr_status pass_nodes_on(thr_cuts *cuts, const bool *drop, const int *to, int *more,
                                thr_err *err)
{
  /* Count what every cut receives, and make room. */
  for (int i = 0; i < cuts->n; i++)
    if (drop[i] && to[i] >= 0) more[to[i]] += cuts->cut[i].n_nodes;
  for (int i = 0; i < cuts->n; i++) {
    if (more[i] == 0) continue;
    int *node = thr_realloc(cuts->cut[i].node, (size_t)cuts->cut[i].n_nodes + (size_t)more[i],
                            sizeof *node);
    if (!node) return thr_nomem(err);
    cuts->cut[i].node = node;
  }

  /* Move the nodes, and sort all lists again. */
  for (int i = 0; i < cuts->n; i++) {
    thr_cut *dropped = &cuts->cut[i];
    if (!drop[i] || to[i] < 0) continue;
    thr_cut *outer = &cuts->cut[to[i]];
    for (int j = 0; j < dropped->n_nodes; j++)
      outer->node[outer->n_nodes++] = dropped->node[j];
  }
  for (int i = 0; i < cuts->n; i++)
    thr_sort_ints(cuts->cut[i].node, (size_t)cuts->cut[i].n_nodes);
  return THR_OK;
}

thr_status thr_cuts_drop(thr_cuts *cuts, const bool *drop, thr_err *err)
{
  size_t n = (size_t)cuts->n;
  int *to = thr_calloc(n, sizeof *to), *more = thr_calloc(n, sizeof *more), kept = 0;
  int *place = more; /* which has served by then */
  thr_status st = to && more ? THR_OK : thr_nomem(err);

  /* Parents come later: to[i] is the next cut round i that stays. */
  for (int i = cuts->n - 1; i >= 0 && !st; i--) {
    int parent = cuts->cut[i].parent;
    to[i] = parent >= 0 && drop[parent] ? to[parent] : parent;
  }

  if (!st) st = pass_nodes_on(cuts, drop, to, more, err);

  /* Close the gaps. Parents still have their old numbers. */
  for (int i = 0; i < cuts->n && !st; i++) {
    if (drop[i]) {
      free(cuts->cut[i].node);
      continue;
    }
    cuts->cut[kept] = cuts->cut[i];
    cuts->cut[kept].parent = to[i];
    place[i] = kept++;
  }

  /* Renumber the parents. */
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

  /* The depth of a cut is the value of all cuts round a node in it; parents come later. */
  for (int i = cuts->n - 1; i >= 0; i--) {
    const thr_cut *cut = &cuts->cut[i];
    depth[i] = cut->value + (cut->parent >= 0 ? depth[cut->parent] : 0);
    for (int j = 0; j < cut->n_nodes; j++)
      held[cut->node[j]] += depth[i];
  }

  free(depth);
  return THR_OK;
}
