/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-join that may leave a limited number of odd nodes to cord ends: where the ends of
 * several cords go.
 *
 * Let w(q) be the least weight of joins if every end costs q more. The number of ends falls as q
 * rises, and the least weight with exactly n ends is the maximum over q of w(q) - n q: a concave
 * function, so q is found by bisection (Lagrange; the differences of joins are circuits that change
 * the number by two, so the maximum has no gap). The ends are edges to a hub, one more node.
 *
 * Example: a star with four leaves, all odd, ends allowed at the leaves. Four ends need no further
 * pass; with two ends the two shortest edges are passed twice. */
#include "lp/tjoin/tjoin.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A join at a price. Weights are doubled, so that the price at which two ends more pay is an
 * integer. */
typedef struct {
  int64_t price, weight; /* of the join without its hub edges */
  int n_ends;
  bool no_hub; /* found without the hub: the cuts need not respect the price */
  thr_tjoin t; /* in_join [n_edges] of the graph with the hub */
} point;

typedef struct {
  const thr_endjoin_problem *p;
  const thr_limits *limits;
  thr_scratch own; /* the arrays */
  int hub,
      n_edges;  /* edges of the graph, then one to the hub from every node where ends are allowed */
  int n_pieces; /* of the graph without the hub */
  int *end_of_piece; /* [n_pieces] one of its edges to the hub */
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  point few, many; /* optimal at their prices with at most, or more than, n_ends; 0 = none yet */
} search;

static void search_destroy(search *s)
{
  thr_scratch_free(&s->own);
  thr_tjoin_destroy(&s->few.t);
  thr_tjoin_destroy(&s->many.t);
}

/* In every component one edge to the hub. */
static thr_status find_pieces(search *s, thr_err *err)
{
  int n = s->p->graph.n_nodes, *parent = thr_calloc((size_t)n, sizeof *parent);
  bool *seen = thr_calloc((size_t)n, sizeof *seen);
  s->end_of_piece = thr_scratch_array(&s->own, (size_t)n, sizeof *s->end_of_piece);
  thr_status st = parent && seen && s->end_of_piece ? THR_OK : thr_nomem(err);
  for (int v = 0; v < n && !st; v++)
    parent[v] = v;
  for (int e = 0; e < s->p->graph.n_edges && !st; e++)
    thr_disjoint_join(parent, s->edge[e][0], s->edge[e][1]);
  for (int e = s->p->graph.n_edges; e < s->n_edges && !st; e++) {
    int component = thr_disjoint_find(parent, s->edge[e][0]);
    if (!seen[component]) s->end_of_piece[s->n_pieces++] = e;
    seen[component] = true;
  }
  free(parent);
  free(seen);
  return st;
}

static thr_status search_init(search *s, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = &s->p->graph;
  s->hub = tjoin_problem->n_nodes;
  s->n_edges = tjoin_problem->n_edges;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    s->n_edges += s->p->end_allowed[v];
  s->edge = thr_scratch_array(&s->own, (size_t)s->n_edges, sizeof *s->edge);
  s->weight = thr_scratch_array(&s->own, (size_t)s->n_edges, sizeof *s->weight);
  s->odd = thr_scratch_array(&s->own, (size_t)tjoin_problem->n_nodes + 1, sizeof *s->odd);
  thr_status st = thr_scratch_check(&s->own, err);
  if (st) return st;
  memcpy(s->odd, tjoin_problem->odd, (size_t)tjoin_problem->n_nodes * sizeof *s->odd);
  memcpy(s->edge, tjoin_problem->edge, (size_t)tjoin_problem->n_edges * sizeof *s->edge);
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    s->weight[e] = 2 * tjoin_problem->weight[e];
  for (int v = 0, e = tjoin_problem->n_edges; v < tjoin_problem->n_nodes; v++) {
    if (!s->p->end_allowed[v]) continue;
    s->edge[e][0] = v;
    s->edge[e++][1] = s->hub;
  }
  return find_pieces(s, err);
}

static void weigh(const search *s, point *at)
{
  for (int e = 0; e < s->n_edges; e++) {
    if (!at->t.in_join[e]) continue;
    if (e < s->p->graph.n_edges)
      at->weight += s->weight[e];
    else
      at->n_ends++;
  }
}

static thr_status solve_at(search *s, int64_t price, point *at, thr_err *err)
{
  *at = (point){.price = price};
  for (int e = s->p->graph.n_edges; e < s->n_edges; e++)
    s->weight[e] = price;
  thr_tjoin_problem tjoin_problem = {s->hub + 1, s->n_edges, (const int(*)[2])s->edge,
                                     s->weight,  s->odd,     0};
  thr_status st = thr_tjoin_minimum(&tjoin_problem, s->p->engine, s->limits, &at->t, err);
  if (!st || st == THR_ELIMIT) weigh(s, at);
  return st;
}

/* A join with the fewest ends: as if a cord could end in every component of the graph at its first
 * node for it only. Of a connected graph it is the lightest closed one. */
static thr_status solve_fewest(search *s, point *at, thr_err *err)
{
  int m = s->p->graph.n_edges, n_pieces = s->n_pieces,
      (*edge)[2] = thr_calloc((size_t)m + (size_t)n_pieces, sizeof *edge);
  int64_t *weight = thr_calloc((size_t)m + (size_t)n_pieces, sizeof *weight);
  *at = (point){.price = 2 * s->p->far, .no_hub = true};
  thr_status st = edge && weight ? THR_OK : thr_nomem(err), limit = THR_OK;
  if (!st) {
    memcpy(edge, s->edge, (size_t)m * sizeof *edge);
    memcpy(weight, s->weight, (size_t)m * sizeof *weight);
    for (int i = 0; i < n_pieces; i++)
      memcpy(edge[m + i], s->edge[s->end_of_piece[i]], sizeof *edge);
    thr_tjoin_problem tjoin_problem = {s->hub + 1, m + n_pieces, (const int(*)[2])edge,
                                       weight,     s->odd,       0};
    limit = thr_tjoin_minimum(&tjoin_problem, s->p->engine, s->limits, &at->t, err);
    if (limit && limit != THR_ELIMIT) st = limit;
  }
  free(edge);
  free(weight);
  bool *all = st ? NULL : thr_calloc((size_t)s->n_edges, sizeof *all);
  if (!st && !all) st = thr_nomem(err);
  if (st) {
    thr_tjoin_destroy(&at->t);
    return st;
  }
  memcpy(all, at->t.in_join, (size_t)m * sizeof *all);
  for (int i = 0; i < n_pieces; i++)
    all[s->end_of_piece[i]] = at->t.in_join[m + i];
  free(at->t.in_join);
  at->t.in_join = all;
  weigh(s, at);
  return limit;
}

static void replace(point *old, point *by)
{
  thr_tjoin_destroy(&old->t);
  *old = *by;
  *by = (point){0};
}

static bool optimal_at(const point *at, const point *other)
{
  return at->weight + other->price * at->n_ends == other->weight + other->price * other->n_ends;
}

/* The price to try next: the slope between the two points, where a convex function has a corner if
 * there is one. As long as there are many ends too many, and matching them over the hub is slow:
 * where the number would be right if its logarithm fell evenly.
 */
static int64_t next_price(const search *s, int round)
{
  enum { GUESSES = 12 };
  const point *few = &s->few, *many = &s->many;
  int64_t price = (few->weight - many->weight) / (many->n_ends - few->n_ends);
  if (round < GUESSES && many->n_ends > 2 * s->p->n_ends) {
    double low = log(few->n_ends + 1.0), high = log(many->n_ends + 1.0);
    double part = (log(s->p->n_ends + 1.0) - low) / (high - low);
    int64_t guess = few->price - (int64_t)(part * (double)(few->price - many->price));
    if (guess > price) price = guess;
  }
  return price >= few->price ? few->price - 1 : price <= many->price ? many->price + 1 : price;
}

/* Raises the price of too many ends and lowers that of few until they are 1 apart, or equal, or few
 * has as many as allowed; each keeps being optimal at its price. *same: the point whose cuts prove
 * the number allowed, if one does. */
static thr_status close_in(search *s, const point **same, thr_err *err)
{
  point *few = &s->few, *many = &s->many;
  *same = NULL;
  for (int round = 0; few->n_ends < s->p->n_ends && few->price - many->price > 1; round++) {
    point at;
    thr_status st = solve_at(s, next_price(s, round), &at, err);
    if (st) {
      thr_tjoin_destroy(&at.t);
      return st;
    }
    point *side = at.n_ends <= s->p->n_ends ? few : many, *other = side == few ? many : few;
    bool meet = optimal_at(other, &at);
    replace(side, &at);
    if (!meet) continue;
    other->price = side->price;
    *same = side;
    return THR_OK;
  }
  if (few->n_ends == s->p->n_ends) *same = few;
  return THR_OK;
}

/* ---- from few ends to as many as allowed ---- */

/* The edges that only one of the two joins has: an even number at every node. */
typedef struct {
  int *first, *incident,
      *next;  /* those at v: incident[first[v] .. first[v + 1] - 1]; the next one to look at */
  bool *used; /* [n_edges] also those that both or none have */
  int n_trails, n_steps;
  int *start,
      *step;       /* trail i, from the hub back to it: edges step[start[i] .. start[i + 1] - 1] */
  int64_t *change; /* [n_trails] of the weight, if few takes over the trail */
  thr_scratch own; /* the arrays */
} difference;

static void difference_destroy(difference *d)
{
  thr_scratch_free(&d->own);
}

static thr_status difference_init(difference *d, const search *s, thr_err *err)
{
  size_t n = (size_t)s->hub + 1, m = (size_t)s->n_edges;
  *d = (difference){0};
  d->first = thr_scratch_array(&d->own, n + 2, sizeof *d->first);
  d->incident = thr_scratch_array(&d->own, 2 * m, sizeof *d->incident);
  d->next = thr_scratch_array(&d->own, n, sizeof *d->next);
  d->used = thr_scratch_array(&d->own, m, sizeof *d->used);
  d->start = thr_scratch_array(&d->own, n + 1, sizeof *d->start);
  d->step = thr_scratch_array(&d->own, m, sizeof *d->step);
  d->change = thr_scratch_array(&d->own, n, sizeof *d->change);
  if (thr_scratch_check(&d->own, err)) return THR_ENOMEM;
  for (size_t e = 0; e < m; e++) {
    d->used[e] = s->few.t.in_join[e] == s->many.t.in_join[e];
    for (int i = 0; i < 2 && !d->used[e]; i++)
      d->first[s->edge[e][i] + 2]++;
  }
  for (size_t v = 1; v <= n; v++)
    d->first[v + 1] += d->first[v];
  for (int e = 0; e < s->n_edges; e++)
    for (int i = 0; i < 2 && !d->used[e]; i++)
      d->incident[d->first[s->edge[e][i] + 1]++] = e;
  memcpy(d->next, d->first, n * sizeof *d->next);
  return THR_OK;
}

static int unused_edge(difference *d, int v)
{
  while (d->next[v] < d->first[v + 1] && d->used[d->incident[d->next[v]]])
    d->next[v]++;
  return d->next[v] < d->first[v + 1] ? d->incident[d->next[v]] : -1;
}

/* The trails through the hub that give few two ends more. */
static void find_trails(difference *d, const search *s)
{
  for (int e; (e = unused_edge(d, s->hub)) >= 0;) {
    int v = s->hub, more = 0, begin = d->n_steps;
    int64_t change = 0;
    do {
      assert(e >= 0);
      int sign = s->few.t.in_join[e] ? -1 : 1;
      d->used[e] = true;
      d->step[d->n_steps++] = e;
      if (e < s->p->graph.n_edges)
        change += sign * s->weight[e];
      else
        more += sign;
      v = s->edge[e][0] == v ? s->edge[e][1] : s->edge[e][0];
      e = unused_edge(d, v);
    } while (v != s->hub);
    if (more == 2) {
      d->change[d->n_trails++] = change;
      d->start[d->n_trails] = d->n_steps;
    } else {
      d->n_steps = begin;
    }
  }
}

/* few takes over as many trails as it may, those first that save most: as both joins are optimal at
 * prices at most 1 apart, a trail saves the one price twice or the other. *last: whether one of the
 * others was needed, too. */
static thr_status take_over(search *s, bool *last, thr_err *err)
{
  difference d;
  thr_status st = difference_init(&d, s, err);
  *last = false;
  if (!st) find_trails(&d, s);
  for (int round = 0; round < 2 && !st; round++)
    for (int i = 0; i < d.n_trails && s->few.n_ends < s->p->n_ends; i++) {
      bool dear = d.change[i] > -2 * s->few.price;
      if (dear != (round == 1)) continue;
      for (int k = d.start[i]; k < d.start[i + 1]; k++)
        s->few.t.in_join[d.step[k]] = !s->few.t.in_join[d.step[k]];
      s->few.n_ends += 2;
      *last |= dear;
    }
  difference_destroy(&d);
  return st;
}

/* ---- the result ---- */

/* Sets of the graph alone, and the price that they ask for. */
static thr_status finish(const thr_endjoin_problem *endjoin_problem, thr_cuts *cuts,
                         thr_endjoin *out, thr_err *err)
{
  int64_t *held = thr_calloc((size_t)cuts->n_nodes, sizeof *held);
  thr_status st = held ? thr_cuts_avoid_last(cuts, err) : thr_nomem(err);
  if (!st) st = thr_cuts_nest(cuts, err);
  if (!st) st = thr_cuts_held(cuts, held, err);
  for (int v = 0; v < endjoin_problem->graph.n_nodes && !st; v++)
    if (endjoin_problem->end_allowed[v] && held[v] > out->end_price) out->end_price = held[v];
  for (int i = 0; i < cuts->n && !st; i++)
    out->sum += cuts->cut[i].value;
  free(held);
  return st;
}

/* Moves the cuts of tjoin into out, which holds the join already. */
static thr_status take_cuts(const thr_endjoin_problem *endjoin_problem, int n_nodes,
                            thr_tjoin *tjoin, thr_endjoin *out, thr_err *err)
{
  thr_cuts cuts = {tjoin->n_cuts, n_nodes, tjoin->cut};
  tjoin->cut = NULL;
  tjoin->n_cuts = 0;
  thr_status st = finish(endjoin_problem, &cuts, out, err);
  out->cut = cuts.cut;
  out->n_cuts = cuts.n;
  if (st) thr_endjoin_destroy(out);
  return st;
}

/* Of a join that is optimal at its price. */
static thr_status confirm(search *s, const point *at, thr_err *err)
{
  for (int e = s->p->graph.n_edges; e < s->n_edges; e++)
    s->weight[e] = at->price;
  thr_tjoin_problem tjoin_problem = {s->hub + 1, s->n_edges, (const int(*)[2])s->edge,
                                     s->weight,  s->odd,     0};
  return at->no_hub ? THR_OK : thr_confirmations_add(s->p->count, &tjoin_problem, &at->t, err);
}

static thr_status take(search *s, point *join, point *proof, thr_endjoin *out, thr_err *err)
{
  *out = (thr_endjoin){.in_join = join->t.in_join};
  join->t.in_join = NULL;
  return take_cuts(s->p, s->hub + 1, &proof->t, out, err);
}

static double bound(const search *s, const point *at)
{
  return (double)at->t.sum - (double)at->price * s->p->n_ends * THR_DUAL_DENOMINATOR;
}

/* Stopped: the join with few ends, and the best bound so far. */
static thr_status take_best(search *s, thr_endjoin *out, thr_err *err)
{
  bool better = !s->few.no_hub && bound(s, &s->few) > bound(s, &s->many);
  return take(s, &s->few, better ? &s->few : &s->many, out, err);
}

/* The lightest join without ends is optimal at the price that its cuts ask: the values of the sets
 * round a node. */
static thr_status lower_closed_price(search *s, thr_err *err)
{
  int64_t *held = thr_calloc((size_t)s->hub + 1, sizeof *held), most = 0;
  const thr_cuts cuts = {s->few.t.n_cuts, s->hub + 1, s->few.t.cut};
  thr_status st = held ? thr_cuts_held(&cuts, held, err) : thr_nomem(err);
  for (int v = 0; v < s->hub && !st; v++)
    if (s->p->end_allowed[v] && held[v] > most) most = held[v];
  free(held);
  if (!st && most / THR_DUAL_DENOMINATOR + 1 < s->few.price)
    s->few.price = most / THR_DUAL_DENOMINATOR + 1;
  return st;
}

/* Of the joins with the fewest ends the lightest: at a price at which two more never pay. */
static thr_status solve_few(search *s, thr_err *err)
{
  thr_status st = solve_fewest(s, &s->few, err);
  if (st) return st;
  if (s->n_pieces == 1) return lower_closed_price(s, err);
  point at;
  st = solve_at(s, 2 * s->p->far, &at, err);
  if (!st) replace(&s->few, &at);
  thr_tjoin_destroy(&at.t);
  return st;
}

static thr_status run(search *s, thr_endjoin *out, thr_err *err)
{
  thr_err stopped = {0};
  const point *same = NULL;
  bool last = false;
  thr_status st = solve_at(s, 0, &s->many, &stopped), limit = st;
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", stopped.text);
  if (s->many.n_ends <= s->p->n_ends) {
    st = limit ? THR_OK : confirm(s, &s->many, err);
    if (!st) st = take(s, &s->many, &s->many, out, err);
    return !st && limit ? thr_fail(err, limit, "%s", stopped.text) : st;
  }
  st = solve_few(s, &stopped);
  if (!st && !limit) st = close_in(s, &same, &stopped);
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", stopped.text);
  if (st || limit) {
    st = take_best(s, out, err);
    return st ? st : thr_fail(err, THR_ELIMIT, "%s", stopped.text);
  }
  bool before = same == &s->many; /* whose join is as it was found */
  if ((st = confirm(s, before ? &s->many : &s->few, err))) return st;
  if (s->few.n_ends < s->p->n_ends && (st = take_over(s, &last, err))) return st;
  bool by_many = same ? before : last;
  return take(s, &s->few, by_many ? &s->many : &s->few, out, err);
}

/* ---- two ends ---- */

/* The cuts of a join with two leaves a and b, the last nodes, as cuts with a hub, both being the
 * same. The leaves are alike, so every set with only one of them can be had once with each, at half
 * the value; and then {a} and {b} alone at these values load no edge more. These two need not be
 * kept: as cuts with a price they say nothing. */
static thr_status join_leaves(thr_cuts *cuts, thr_err *err)
{
  const int a = cuts->n_nodes - 2, b = a + 1;
  int *leaves = thr_calloc((size_t)cuts->n, sizeof *leaves); /* 1 = holds a, 2 = holds b */
  bool *drop = thr_calloc((size_t)cuts->n, sizeof *drop);
  thr_status st = leaves && drop ? THR_OK : thr_nomem(err);
  for (int i = 0; i < cuts->n && !st; i++) {
    const thr_cut *cut = &cuts->cut[i];
    for (int j = cut->n_nodes - 1; j >= 0 && cut->node[j] >= a; j--)
      leaves[i] |= cut->node[j] == a ? 1 : 2;
    if (cut->parent >= 0) leaves[cut->parent] |= leaves[i];
    drop[i] = leaves[i] == 1 || leaves[i] == 2;
  }
  if (!st) st = thr_cuts_drop(cuts, drop, err);
  for (int i = 0; i < cuts->n && !st; i++) {
    thr_cut *cut = &cuts->cut[i];
    cut->value *= 2;
    if (cut->n_nodes > 0 && cut->node[cut->n_nodes - 1] == b) cut->n_nodes--;
  }
  cuts->n_nodes = b;
  free(leaves);
  free(drop);
  return st;
}

/* s has the graph and its hub edges: a copy of these for the other leaf, and one between the two.
 */
static thr_status solve_two(search *s, thr_endjoin *out, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = &s->p->graph;
  int n = tjoin_problem->n_nodes, m = s->n_edges, all = 2 * m - tjoin_problem->n_edges + 1,
      (*edge)[2] = thr_calloc((size_t)all, sizeof *edge);
  int64_t *weight = thr_calloc((size_t)all, sizeof *weight);
  bool *odd = thr_calloc((size_t)n + 2, sizeof *odd);
  thr_tjoin tjoin = {0};
  thr_status st = edge && weight && odd ? THR_OK : thr_nomem(err), limit = THR_OK;
  if (!st) {
    memcpy(odd, tjoin_problem->odd, (size_t)n * sizeof *odd);
    odd[n] = odd[n + 1] = true;
    for (int e = 0; e < all - 1; e++) {
      memcpy(edge[e], s->edge[e < m ? e : e - m + tjoin_problem->n_edges], sizeof *edge);
      edge[e][1] += e >= m;
      weight[e] = e < tjoin_problem->n_edges ? tjoin_problem->weight[e] : s->p->far;
    }
    edge[all - 1][0] = n, edge[all - 1][1] = n + 1;
    weight[all - 1] = 2 * s->p->far;
    thr_tjoin_problem p = {n + 2, all, (const int(*)[2])edge, weight, odd, 2};
    limit = thr_tjoin_minimum(&p, s->p->engine, s->limits, &tjoin, err);
    if (limit == THR_ELIMIT) { /* whose quick joins need not respect the leaves */
      thr_tjoin_destroy(&tjoin);
      limit = thr_tjoin_solve(&p, s->limits, &tjoin, err);
    }
    if (limit && limit != THR_ELIMIT) st = limit;
    if (!st && !limit) st = thr_confirmations_add(s->p->count, &p, &tjoin, err);
  }
  if (!st) {
    thr_cuts cuts = {tjoin.n_cuts, n + 2, tjoin.cut};
    st = join_leaves(&cuts, err);
    tjoin.n_cuts = cuts.n;
    *out = (thr_endjoin){.in_join = tjoin.in_join};
    tjoin.in_join = NULL;
    if (!st) st = take_cuts(s->p, n + 1, &tjoin, out, err);
    if (st) thr_endjoin_destroy(out);
  }
  thr_tjoin_destroy(&tjoin);
  free(edge);
  free(weight);
  free(odd);
  return st ? st : limit;
}

thr_status thr_endjoin_solve(const thr_endjoin_problem *endjoin_problem, const thr_limits *limits,
                             thr_endjoin *out, thr_err *err)
{
  thr_limits quiet = *limits; /* bounds at a price are none on the join */
  quiet.progress = NULL;
  search s = {.p = endjoin_problem, .limits = limits};
  *out = (thr_endjoin){0};
  thr_status st = search_init(&s, err);
  bool two = endjoin_problem->n_ends == 2 && s.n_pieces == 1;
  if (!two) s.limits = &quiet;
  if (!st) st = two ? solve_two(&s, out, err) : run(&s, out, err);
  search_destroy(&s);
  return st;
}

void thr_endjoin_destroy(thr_endjoin *endjoin)
{
  for (int i = 0; i < endjoin->n_cuts; i++)
    free(endjoin->cut[i].node);
  free(endjoin->cut);
  free(endjoin->in_join);
  *endjoin = (thr_endjoin){0};
}
