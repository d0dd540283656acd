/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the moats of a matching of units to the multipliers of the turning proof.
 *
 * The units of a node are alike, so that they pay the same, and a blossom that holds some of them
 * only need not be there. What spare units pay for the edges that they may take counts as well; so
 * an edge may pay less than nothing where another pays more.
 */
#include "graph/sort.h"
#include "tortuosity/proof/relax_parts.h"

#include <stdlib.h>
#include <string.h>

/* ---- duals of nodes ---- */

/* Is the node one whose units that are asked for stand for it, not spare ones? */
static bool asks(const thr_units *u, int v)
{
  return thr_degree(u->c->f, v) != 2 && u->needed[v] > 0;
}

/* Are two spare units free to be left: in the same blossoms, and do they pay nothing for it? */
static bool loose(const thr_matching *matching, int i)
{
  return matching->node_blossom[i] == matching->node_blossom[i + 1] &&
         matching->dual[i] + matching->dual[i + 1] >= 0;
}

/* The units that stand for a node, first[v] <= *from < *end: those asked for, or a pair of spare
 * ones, a loose one if there is any. */
static void typical_units(const thr_units *u, const thr_unit_layer *l, int v, int *from, int *end)
{
  int spare = l->first[v] + l->asked[v];
  *from = asks(u, v) ? l->first[v] : spare;
  *end = asks(u, v) ? spare : spare + 2;
  for (int i = spare; i < l->first[v + 1] && !asks(u, v) && !loose(&l->matching, *from); i += 2) {
    *from = i;
    *end = i + 2;
  }
}

/* The innermost blossom round all units from a to b - 1, or -1; those round some of them only are
 * marked in cut. at: [b - a]. */
static int blossom_round(const thr_matching *matching, int a, int b, int *at, bool *cut)
{
  for (int i = a; i < b; i++)
    at[i - a] = matching->node_blossom[i];
  for (;;) { /* outwards, the innermost first: children come before parents, and -1 is outside of
                all */
    int least = at[0];
    bool same = true;
    for (int i = 1; i < b - a; i++) {
      same &= at[i] == at[0];
      if (at[i] >= 0 && (least < 0 || at[i] < least)) least = at[i];
    }
    if (same) return least;
    cut[least] = true;
    for (int i = 0; i < b - a; i++)
      if (at[i] == least) at[i] = matching->blossom_parent[least];
  }
}

/* Sum of the duals of the blossoms that are round one of a and b only, or one of these. Those that
 * cut a node do not count. */
static int64_t between(const thr_matching *matching, const bool *cut, int a, int b)
{
  int64_t sum = 0;
  while (a != b) { /* outwards */
    int *inner = b < 0 || (a >= 0 && a < b) ? &a : &b;
    if (!cut[*inner]) sum += matching->blossom_dual[*inner];
    *inner = matching->blossom_parent[*inner];
  }
  return sum;
}

/* Sets what passes over half-edge h pay at their node v: as much as the unit that pays most, if it
 * were in the node's home. For units asked for, all of them alike, a blossom that holds one and not
 * another need not be there: the other pays as much as the one with it. */
static void settle(thr_units *u, const thr_unit_layer *l, const bool *cut, int h)
{
  int v = thr_tail(u->c->f, h), from, end;
  const thr_matching *matching = &l->matching;
  typical_units(u, l, v, &from, &end);
  int64_t most = INT64_MIN;
  for (int i = from; i < (asks(u, v) && u->kinds[v] > 0 ? l->first[v + 1] : end); i++) {
    int64_t paid = matching->dual[i] -
                   (i < end ? 0 : between(matching, cut, u->home[v], matching->node_blossom[i]));
    if (thr_unit_may_take(u, l, h, i) && paid > most) most = paid;
  }
  u->dual[h] = thr_degree(u->c->f, v) == 2 || asks(u, v) ? most : 0;
}

/* Sets home and duals of all nodes, and marks the blossoms that cut one. */
static thr_status settle_all(thr_units *u, const thr_unit_layer *l, bool *cut, thr_err *err)
{
  const thr_frame *frame = u->c->f;
  int *at = thr_calloc((size_t)l->first[frame->n_nodes] + 2, sizeof *at), from, end;
  if (!at) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    typical_units(u, l, v, &from, &end);
    u->home[v] = blossom_round(&l->matching, from, end, at, cut);
  }
  free(at);
  for (int h = 0; h < 2 * frame->n_edges; h++)
    settle(u, l, cut, h);
  return THR_OK;
}

/* Pairs of spare units more where they may save: at a node that asks for units if two half-edges
 * pay less than nothing together, at others if no pair is loose. false: nowhere. */
static bool add_spares(thr_units *u, const thr_unit_layer *l)
{
  const thr_frame *frame = u->c->f;
  bool more = false;
  for (int v = 0; v < frame->n_nodes; v++) {
    int64_t least = INT64_MAX, next = INT64_MAX;
    int from, end;
    typical_units(u, l, v, &from, &end);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int64_t paid = u->dual[frame->half[i]];
      next = paid < least ? least : paid < next ? paid : next;
      least = paid < least ? paid : least;
    }
    bool lacks = asks(u, v) ? least + next < 0 : !loose(&l->matching, from);
    u->spares[v] += lacks;
    more |= lacks;
  }
  return more;
}

/* ---- multipliers ---- */

static int64_t value_of(const thr_units *u, int64_t dual)
{
  return dual * (INT64_C(1) << (u->bits - 1));
}

/* The junction of the half-edges half[d] of a node where the first n are one block. */
static thr_status add_junction(const thr_units *u, thr_turning_dual *dual, const int *half, int d,
                               int n, int64_t value, thr_err *err)
{
  thr_turning_junction *to = &dual->junction[dual->n_junctions];
  *to = (thr_turning_junction){thr_tail(u->c->f, half[0]), thr_calloc((size_t)d, sizeof *to->block),
                               value};
  if (!to->block) return thr_nomem(err);
  for (int i = n; i < d; i++)
    to->block[u->c->position[half[i]]] = i - n + 1;
  dual->n_junctions++;
  return THR_OK;
}

/* The odd set of all half-edges at a node. */
static thr_status add_node_set(const thr_units *u, thr_turning_dual *dual, int v, int64_t value,
                               thr_err *err)
{
  int d = thr_degree(u->c->f, v);
  thr_turning_set *to = &dual->odd[dual->n_odd];
  *to = (thr_turning_set){d, thr_calloc((size_t)d, sizeof *to->member), value};
  if (!to->member) return thr_nomem(err);
  memcpy(to->member, u->c->f->half + u->c->f->first[v], (size_t)d * sizeof *to->member);
  thr_sort_ints(to->member, (size_t)d);
  dual->n_odd++;
  return THR_OK;
}

/* Potentials and junctions of a node: a turn is worth what both half-edges pay, and its turns hold
 * at least a spanning tree, which is worth least as a star round the half-edge that pays least.
 * by_dual[d] is scratch. */
static thr_status add_node(const thr_units *u, thr_turning_dual *dual, int v, int *by_dual,
                           thr_err *err)
{
  const int *half = u->c->f->half + u->c->f->first[v];
  int d = thr_degree(u->c->f, v);
  if (d == 0) return THR_OK;
  int64_t before = 0, first = value_of(u, u->dual[half[0]]);
  thr_status st = THR_OK;
  if (d > 2 && thr_unit_covered(u->c, v))
    return first > 0 ? add_node_set(u, dual, v, first, err) : THR_OK;
  for (int i = 0, k; i < d; i++) {
    dual->potential[half[i]] = -value_of(u, u->dual[half[i]]);
    for (k = i; k > 0 && u->dual[by_dual[k - 1]] > u->dual[half[i]]; k--)
      by_dual[k] = by_dual[k - 1];
    by_dual[k] = half[i];
  }
  for (int i = 1; i < d && !st; i++) {
    int64_t worth = value_of(u, u->dual[by_dual[0]] + u->dual[by_dual[i]]);
    if (worth <= before) continue;
    st = add_junction(u, dual, by_dual, d, i, worth - before, err);
    before = worth;
  }
  return st;
}

/* Odd sets of the blossoms that cut no node, of all half-edges at the nodes in them. size, odd,
 * set: [n_blossoms] scratch. */
static thr_status add_sets(const thr_units *u, const thr_matching *matching, const bool *cut,
                           int *size, bool *odd, int *set, thr_turning_dual *dual, thr_err *err)
{
  const thr_frame *frame = u->c->f;
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * frame->n_edges; h++)
    for (int b = u->home[thr_tail(frame, h)]; b >= 0; b = matching->blossom_parent[b]) {
      size[b]++;
      odd[b] ^= u->c->cover[h >> 1] % 2;
    }
  for (int b = 0; b < matching->n_blossoms && !st; b++) {
    set[b] = odd[b] && !cut[b] ? dual->n_odd++ : -1;
    if (set[b] < 0) continue;
    dual->odd[set[b]] = (thr_turning_set){.member = thr_calloc((size_t)size[b], sizeof(int)),
                                          .value = value_of(u, matching->blossom_dual[b])};
    if (!dual->odd[set[b]].member) st = thr_nomem(err);
  }
  for (int h = 0; h < 2 * frame->n_edges && !st; h++)
    for (int b = u->home[thr_tail(frame, h)]; b >= 0; b = matching->blossom_parent[b])
      if (set[b] >= 0) dual->odd[set[b]].member[dual->odd[set[b]].n++] = h;
  return st;
}

static thr_status make_dual(const thr_units *u, const thr_matching *matching, const bool *cut,
                            thr_turning_dual *dual, thr_err *err)
{
  size_t n = (size_t)u->c->f->n_nodes, halves = 2 * (size_t)u->c->f->n_edges,
         blossoms = (size_t)matching->n_blossoms;
  thr_scratch own = {0};
  int *by_dual = thr_scratch_array(&own, halves, sizeof *by_dual);
  int *size = thr_scratch_array(&own, blossoms, sizeof *size),
      *set = thr_scratch_array(&own, blossoms, sizeof *set);
  bool *odd = thr_scratch_array(&own, blossoms, sizeof *odd);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_turning_dual_init(dual, u->c, err);
  if (!st && !(dual->odd = thr_calloc(n + blossoms, sizeof *dual->odd))) st = thr_nomem(err);
  if (!st && !(dual->junction = thr_calloc(halves, sizeof *dual->junction))) st = thr_nomem(err);
  for (int v = 0; v < u->c->f->n_nodes && !st; v++)
    st = add_node(u, dual, v, by_dual, err);
  if (!st) st = add_sets(u, matching, cut, size, odd, set, dual, err);
  thr_scratch_free(&own);
  if (st) thr_turning_dual_destroy(dual);
  return st;
}

thr_status thr_unit_dual(thr_units *u, const thr_unit_layer *l, thr_turning_dual *dual, bool *more,
                         thr_err *err)
{
  bool *cut = thr_calloc((size_t)l->matching.n_blossoms, sizeof *cut);
  thr_status st = cut ? settle_all(u, l, cut, err) : thr_nomem(err);
  *more = !st && add_spares(u, l);
  if (!st && dual) st = make_dual(u, &l->matching, cut, dual, err);
  free(cut);
  return st;
}
