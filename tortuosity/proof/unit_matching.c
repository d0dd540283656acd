/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest passes with tube joints, closed cords, as one perfect matching. Internal to
 * tortuosity/.
 *
 * A node of d edges whose covers sum to C asks for 2 (d - 1) - C extra passes, or for as many as
 * its parity needs, and then for any number of pairs of them (tortuosity/tie/tie.h). Each that it
 * asks for is a unit, a node of the matching; so are pairs of spare units, which may be matched
 * with each other for nothing. Units of neighbours may be matched at the length of the edge between
 * them: that is an extra pass over it (b-matching by copies of nodes, W. T. Tutte, "A short proof
 * of the factor theorem for finite graphs", Canad. J. Math. 6, 1954). No edge gets more passes than
 * all others of a node together if the units of a pair take different ones; so they do where covers
 * are 1, and at nodes of two edges, whose passes must be equal.
 *
 * The moats of the matching are multipliers of the turning proof: what the units of a node pay is
 * the price of its passes, and a blossom of whole nodes is an odd set. Spare units come in where
 * these say that they may save.
 *
 * Example: an octahedron: four edges at every node, which asks for two passes; twelve units, six
 * pairs of neighbours. */
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of more and more spare units; those that begin anew before they have come to the finest level,
 * which is enough to have most of them. */
enum { MOST_ROUNDS = 8, COARSE_ROUNDS = 2 };

/* Pairs of units beyond which a linear programme, with a row for every node, is the faster way. */
enum { PAIRS_PER_NODE = 250 };

/* ---- what nodes ask for ---- */

static int cover_at(const thr_turning_columns *c, int v)
{
  int sum = 0;
  for (int i = c->f->first[v]; i < c->f->first[v + 1]; i++)
    sum += c->cover[c->f->half[i] >> 1];
  return sum;
}

bool thr_unit_covered(const thr_turning_columns *c, int v)
{
  return cover_at(c, v) > 2 * (thr_degree(c->f, v) - 1);
}

/* At a node of two edges: how many more passes the first one needs than the second. */
static int uneven(const thr_turning_columns *c, int v)
{
  const int *half = c->f->half + c->f->first[v];
  return c->cover[half[1] >> 1] - c->cover[half[0] >> 1];
}

static int extra_needed(const thr_turning_columns *c, int v)
{
  int d = thr_degree(c->f, v), sum = cover_at(c, v);
  if (d == 2) return abs(uneven(c, v));
  return thr_unit_covered(c, v) ? sum % 2 : 2 * (d - 1) - sum;
}

/* Where every edge is covered once, none gets more passes than all others together if the two units
 * of a pair take different edges: of any two there is a bit in which their places differ. Elsewhere
 * others have passes to spare as a rule. */
static int kinds_at(const thr_turning_columns *c, int v)
{
  int d = thr_degree(c->f, v), kinds = 0;
  while ((d - 1) >> kinds)
    kinds++;
  return d == 2 || cover_at(c, v) == d ? kinds : 0;
}

/* So that all duals together stay far below 2^60. */
static void set_bits(thr_units *u)
{
  const thr_turning_columns *c = u->c;
  double most = 0;
  for (int e = 0; e < c->f->n_edges; e++)
    most += (double)c->weight[c->first_extra + e] *
            (thr_degree(c->f, c->f->edge[e][0]) + thr_degree(c->f, c->f->edge[e][1]));
  u->bits = 1;
  while (ldexp(most, -u->bits) > 0x1p57)
    u->bits++;
}

static thr_status units_init(thr_units *u, const thr_turning_columns *c, thr_err *err)
{
  size_t n = (size_t)c->f->n_nodes;
  *u = (thr_units){.c = c};
  u->needed = thr_scratch_array(&u->own, n, sizeof *u->needed);
  u->kinds = thr_scratch_array(&u->own, n, sizeof *u->kinds);
  u->spares = thr_scratch_array(&u->own, n, sizeof *u->spares);
  u->home = thr_scratch_array(&u->own, n, sizeof *u->home);
  u->dual = thr_scratch_array(&u->own, 2 * (size_t)c->f->n_edges, sizeof *u->dual);
  thr_status st = thr_scratch_check(&u->own, err);
  for (int v = 0; v < c->f->n_nodes && !st; v++) {
    u->needed[v] = extra_needed(c, v);
    u->kinds[v] = kinds_at(c, v);
    u->spares[v] = u->needed[v] <= 1 || thr_degree(c->f, v) == 2;
  }
  if (!st) set_bits(u);
  return st;
}

/* ---- the graph ---- */

static void layer_destroy(thr_unit_layer *l)
{
  free(l->asked);
  free(l->first);
  free(l->edge);
  free(l->of);
  free(l->weight);
  thr_matching_destroy(&l->matching);
  *l = (thr_unit_layer){0};
}

bool thr_unit_may_take(const thr_units *u, const thr_unit_layer *l, int h, int unit)
{
  int v = thr_tail(u->c->f, h), spare = unit - l->first[v] - l->asked[v], place = u->c->position[h];
  if (spare < 0) return thr_degree(u->c->f, v) != 2 || place == (uneven(u->c, v) < 0);
  return u->kinds[v] == 0 || (place >> spare / 2 % u->kinds[v]) % 2 == spare % 2;
}

/* Pairs of spare units at a node. */
static int spare_pairs(const thr_units *u, int v)
{
  return u->spares[v] * (u->kinds[v] > 0 ? u->kinds[v] : 1);
}

static void add_pair(const thr_units *u, thr_unit_layer *l, int a, int b, int of)
{
  l->edge[l->n_edges][0] = a;
  l->edge[l->n_edges][1] = b;
  l->of[l->n_edges] = of;
  l->weight[l->n_edges++] = of < 0 ? 0 : u->c->weight[u->c->first_extra + of] >> u->bits;
}

static void add_pairs_over(const thr_units *u, thr_unit_layer *l, int e)
{
  int v = thr_tail(u->c->f, 2 * e), w = thr_tail(u->c->f, 2 * e + 1);
  for (int i = l->first[v]; i < l->first[v + 1]; i++)
    for (int j = l->first[w]; j < l->first[w + 1] && thr_unit_may_take(u, l, 2 * e, i); j++)
      if (thr_unit_may_take(u, l, 2 * e + 1, j)) add_pair(u, l, i, j, e);
}

/* Sets asked for a level: the same number or one more than what is needed shared out, and even in
 * every component. */
static thr_status ask(const thr_units *u, int level, int *asked, thr_err *err)
{
  const thr_turning_columns *c = u->c;
  bool *odd = thr_calloc((size_t)c->n_components, sizeof *odd);
  if (!odd) return thr_nomem(err);
  for (int v = 0; v < c->f->n_nodes; v++) {
    asked[v] = (u->needed[v] + (1 << level) - 1) >> level;
    odd[c->component[v]] ^= asked[v] % 2;
  }
  for (int v = 0; v < c->f->n_nodes; v++)
    if (odd[c->component[v]] && asked[v] > 0 && thr_degree(c->f, v) > 2) {
      asked[v]++;
      odd[c->component[v]] = false;
    }
  free(odd);
  return THR_OK;
}

/* Numbers the units; returns how many pairs of them there are at most. */
static int64_t number_units(const thr_units *u, thr_unit_layer *l)
{
  const thr_frame *frame = u->c->f;
  int64_t n = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    l->first[v + 1] = l->first[v] + l->asked[v] + 2 * spare_pairs(u, v);
    n += spare_pairs(u, v);
  }
  for (int e = 0; e < frame->n_edges; e++) {
    int v = frame->edge[e][0], w = frame->edge[e][1];
    n += (int64_t)(l->first[v + 1] - l->first[v]) * (l->first[w + 1] - l->first[w]);
  }
  return n;
}

/* The units and pairs of a level; THR_ELIMIT: there are too many. */
static thr_status layer_init(thr_unit_layer *l, const thr_units *u, int level, thr_err *err)
{
  const thr_frame *frame = u->c->f;
  size_t n = (size_t)frame->n_nodes;
  *l = (thr_unit_layer){.asked = thr_calloc(n, sizeof *l->asked),
                        .first = thr_calloc(n + 1, sizeof *l->first)};
  if (!l->asked || !l->first) return thr_nomem(err);
  thr_status st = ask(u, level, l->asked, err);
  if (st) return st;
  int64_t pairs = number_units(u, l);
  if (pairs > (int64_t)PAIRS_PER_NODE * frame->n_nodes) return THR_ELIMIT;
  l->edge = thr_calloc((size_t)pairs, sizeof *l->edge);
  l->of = thr_calloc((size_t)pairs, sizeof *l->of);
  l->weight = thr_calloc((size_t)pairs, sizeof *l->weight);
  if (!l->edge || !l->of || !l->weight) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = l->first[v] + l->asked[v]; i < l->first[v + 1]; i += 2)
      add_pair(u, l, i, i + 1, -1);
  for (int e = 0; e < frame->n_edges; e++)
    add_pairs_over(u, l, e);
  return THR_OK;
}

/* ---- the matching ---- */

/* The unit of the finer level that comes from unit i of node v in the coarser one, or the second of
 * two such; -1: none. */
static int image(const thr_unit_layer *coarse, const thr_unit_layer *fine, int v, int i, int twin)
{
  int at = i - coarse->first[v], spare = at - coarse->asked[v];
  if (spare >= 0) return twin ? -1 : fine->first[v] + fine->asked[v] + spare;
  return 2 * at + twin < fine->asked[v] ? fine->first[v] + 2 * at + twin : -1;
}

/* Duals and mates of the finer level: each those of the unit where it comes from. node[coarse
 * units]: where they are. */
static void refine(const thr_units *u, const thr_unit_layer *coarse, const thr_unit_layer *fine,
                   int *node, int64_t *dual, int *mate)
{
  int n = u->c->f->n_nodes;
  for (int v = 0; v < n; v++)
    for (int i = coarse->first[v]; i < coarse->first[v + 1]; i++)
      node[i] = v;
  for (int i = 0; i < 2 * coarse->first[n]; i++) {
    int own = i / 2, other = coarse->matching.mate[own],
        unit = image(coarse, fine, node[own], own, i % 2);
    if (unit < 0) continue;
    dual[unit] = coarse->matching.dual[own];
    mate[unit] = image(coarse, fine, node[other], other, i % 2);
  }
}

/* Matches the units, from a coarser level unless that is empty. */
static thr_status layer_match(thr_unit_layer *l, const thr_units *u, const thr_unit_layer *coarse,
                              const thr_limits *limits, thr_err *err)
{
  int n = u->c->f->n_nodes;
  bool begun = coarse->matching.mate;
  const thr_matching_problem problem = {l->first[n], l->n_edges, (const int(*)[2])l->edge,
                                        l->weight};
  thr_scratch own = {0};
  int *node = thr_scratch_array(&own, begun ? (size_t)coarse->first[n] : 0, sizeof *node);
  int *mate = thr_scratch_array(&own, (size_t)l->first[n], sizeof *mate);
  int64_t *dual = thr_scratch_array(&own, (size_t)l->first[n], sizeof *dual);
  thr_status st = thr_scratch_check(&own, err);
  if (!st && begun) refine(u, coarse, l, node, dual, mate);
  if (!st)
    st = thr_matching_near(&problem, begun ? dual : NULL, begun ? mate : NULL, limits, &l->matching,
                           err);
  thr_scratch_free(&own);
  return st;
}

/* The level to begin with: where most nodes have one unit. */
static int coarsest(const thr_units *u)
{
  int64_t sum = 0, asking = 0;
  int level = 0;
  for (int v = 0; v < u->c->f->n_nodes; v++) {
    sum += u->needed[v];
    asking += u->needed[v] > 0;
  }
  while (2 * sum >= 3 * asking << level && asking > 0)
    level++;
  return level;
}

/* ---- all ---- */

static void count_passes(const thr_units *u, const thr_unit_layer *l, int *passes)
{
  const thr_matching *matching = &l->matching;
  memcpy(passes, u->c->cover, (size_t)u->c->f->n_edges * sizeof *passes);
  for (int i = 0; i < l->first[u->c->f->n_nodes]; i++)
    if (i < matching->mate[i] && l->of[matching->mate_edge[i]] >= 0)
      passes[l->of[matching->mate_edge[i]]]++;
}

/* Spare units for every node that has none; where all have some, more for all. */
static void spare_everywhere(thr_units *u)
{
  bool all = true;
  for (int v = 0; v < u->c->f->n_nodes; v++)
    all &= u->spares[v] > 0;
  for (int v = 0; v < u->c->f->n_nodes; v++)
    u->spares[v] += all || u->spares[v] == 0;
}

/* The matching of a level, which begins with that of the coarser one in *l and takes its place.
 * *matched false: there is none. *more: pairs of spare units were added, and it is to be done again
 * from the coarsest level. Of level 0: passes and multipliers, in place of those before. */
static thr_status match(thr_units *u, int level, const thr_limits *limits, thr_unit_layer *l,
                        int *passes, thr_turning_dual *dual, bool *matched, bool *more,
                        thr_err *err)
{
  thr_unit_layer fine;
  thr_err why = {0};
  thr_status st = layer_init(&fine, u, level, &why);
  if (!st) st = layer_match(&fine, u, l, limits, &why);
  layer_destroy(l);
  *l = fine;
  *matched = !st;
  *more = st == THR_EINFEASIBLE && level == 0;
  if (*more) spare_everywhere(u);
  if (st == THR_EINFEASIBLE) return THR_OK;
  if (st) return thr_fail(err, st, "%s", why.text);
  if (level == 0) {
    thr_turning_dual_destroy(dual);
    count_passes(u, l, passes);
  }
  return thr_unit_dual(u, l, level == 0 ? dual : NULL, more, err);
}

thr_status thr_unit_matching(const thr_turning_columns *turning_columns, const thr_limits *limits,
                             int *passes, thr_turning_dual *dual, bool *found, thr_err *err)
{
  thr_units u;
  thr_unit_layer l = {0};
  bool more = true, matched;
  thr_err why = {0};
  *dual = (thr_turning_dual){0};
  *found = false;
  thr_status st = units_init(&u, turning_columns, &why);
  for (int round = 0; round < MOST_ROUNDS && more && !st; round++) {
    more = false;
    layer_destroy(&l);
    for (int level = coarsest(&u); level >= 0 && !more && !st; level--) {
      st = match(&u, level, limits, &l, passes, dual, &matched, &more, &why);
      *found |= level == 0 && matched;
      more &= level == 0 || round < COARSE_ROUNDS;
    }
  }
  layer_destroy(&l);
  thr_scratch_free(&u.own);
  if (st == THR_OK || st == THR_ELIMIT) return THR_OK;
  *found = false;
  thr_turning_dual_destroy(dual);
  return thr_fail(err, st, "%s", why.text);
}
