/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the minimum T-join that may leave a limited number of odd nodes to cord ends, and so
 * decides at which nodes several cords end.
 *
 * An end is an edge to one more node, the hub, and costs a price q (Lagrangian relaxation of the
 * number of ends). Let w(q) be the least weight of a join with its ends at price q. The number of
 * ends falls as q rises, and the least weight with exactly n ends is the maximum over q of
 * w(q) - n q. This function of q is concave, so that the file searches for q between a price with
 * too many ends and one with too few. There is no duality gap: the difference of two joins falls
 * into circuits, each of which changes the number of ends by two at most, so that the join with
 * few ends gets exactly n of them by taking over circuits.
 *
 * One cord in a connected graph takes no search: two odd leaves stand for its ends, and the price
 * follows from the cuts of a single T-join problem.
 *
 * Example: a star with four leaves, all odd, ends allowed at the leaves. Four ends need no further
 * pass; with two ends the two shortest edges are passed twice. */
#include "lp/tjoin/tjoin.h"
#include "graph/arrays.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A join that is optimal at a price per end. Weights are doubled, so that the price at which two
 * ends more pay is an integer. */
typedef struct {
  int64_t price, weight; /* weight: of the join without its hub edges */
  int n_ends;
  bool no_hub;    /* found without the hub: the cuts need not respect the price */
  thr_tjoin join; /* in_join [n_edges] of the graph with the hub */
} priced_join;

/* The graph with the hub, and the interval of prices that is left. */
typedef struct {
  const thr_endjoin_problem *problem;
  const thr_limits *limits;
  thr_scratch own;       /* the arrays */
  int hub, n_edges;      /* edges of the graph, then one to the hub from every node where ends are
                            allowed */
  int n_components;      /* of the graph without the hub */
  int *end_of_component; /* [n_components] one of its edges to the hub */
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  priced_join few, many; /* optimal at their prices with at most, or more than, n_ends; 0 = none
                            yet */
} price_search;

static void search_destroy(price_search *search)
{
  thr_scratch_free(&search->own);
  thr_tjoin_destroy(&search->few.join);
  thr_tjoin_destroy(&search->many.join);
}

/* Finds the components of the graph without the hub, and in each of them one edge to the hub. */
static thr_status find_components(price_search *search, thr_err *err)
{
  /* Join the ends of every edge of the graph in a disjoint-set forest. */
  int n = search->problem->graph.n_nodes, *parent = thr_calloc((size_t)n, sizeof *parent);
  bool *seen = thr_calloc((size_t)n, sizeof *seen);
  search->end_of_component =
      thr_scratch_array(&search->own, (size_t)n, sizeof *search->end_of_component);
  thr_status st = parent && seen && search->end_of_component ? THR_OK : thr_nomem(err);
  for (int v = 0; v < n && !st; v++)
    parent[v] = v;
  for (int e = 0; e < search->problem->graph.n_edges && !st; e++)
    thr_disjoint_join(parent, search->edge[e][0], search->edge[e][1]);

  /* The first hub edge of every component stands for the component. */
  for (int e = search->problem->graph.n_edges; e < search->n_edges && !st; e++) {
    int component = thr_disjoint_find(parent, search->edge[e][0]);
    if (!seen[component]) search->end_of_component[search->n_components++] = e;
    seen[component] = true;
  }

  free(parent);
  free(seen);
  return st;
}

/* Builds the graph with the hub: its edges with doubled weights, and one edge to the hub from
 * every node where an end is allowed. */
static thr_status search_init(price_search *search, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = &search->problem->graph;

  /* Count the edges and allocate. */
  search->hub = tjoin_problem->n_nodes;
  search->n_edges = tjoin_problem->n_edges;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    search->n_edges += search->problem->end_allowed[v];
  search->edge = thr_scratch_array(&search->own, (size_t)search->n_edges, sizeof *search->edge);
  search->weight = thr_scratch_array(&search->own, (size_t)search->n_edges, sizeof *search->weight);
  search->odd =
      thr_scratch_array(&search->own, (size_t)tjoin_problem->n_nodes + 1, sizeof *search->odd);
  thr_status st = thr_scratch_check(&search->own, err);
  if (st) return st;

  /* Doubled weights keep the critical price an integer. */
  memcpy(search->odd, tjoin_problem->odd, (size_t)tjoin_problem->n_nodes * sizeof *search->odd);
  memcpy(search->edge, tjoin_problem->edge, (size_t)tjoin_problem->n_edges * sizeof *search->edge);
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    search->weight[e] = 2 * tjoin_problem->weight[e];

  /* The weights of hub edges are set with each price. */
  for (int v = 0, e = tjoin_problem->n_edges; v < tjoin_problem->n_nodes; v++) {
    if (!search->problem->end_allowed[v]) continue;
    search->edge[e][0] = v;
    search->edge[e++][1] = search->hub;
  }
  return find_components(search, err);
}

/* Computes the weight of a join without its hub edges, and its number of ends. */
static void weigh(const price_search *search, priced_join *candidate)
{
  for (int e = 0; e < search->n_edges; e++) {
    if (!candidate->join.in_join[e]) continue;
    if (e < search->problem->graph.n_edges)
      candidate->weight += search->weight[e];
    else
      candidate->n_ends++;
  }
}

/* Computes the minimum T-join in which every end costs price. */
static thr_status solve_at(price_search *search, int64_t price, priced_join *candidate,
                           thr_err *err)
{
  *candidate = (priced_join){.price = price};
  for (int e = search->problem->graph.n_edges; e < search->n_edges; e++)
    search->weight[e] = price;
  thr_tjoin_problem tjoin_problem = {
      search->hub + 1, search->n_edges, (const int(*)[2])search->edge,
      search->weight,  search->odd,     0};
  thr_status st = thr_tjoin_minimum(&tjoin_problem, search->problem->engine, search->limits,
                                    &candidate->join, err);
  if (!st || st == THR_ELIMIT) weigh(search, candidate);
  return st;
}

/* Computes a join with the fewest ends: one in every component with an odd number of odd nodes,
 * at the first node where the component allows an end. In a connected graph this is the lightest
 * join without ends. */
static thr_status solve_fewest(price_search *search, priced_join *candidate, thr_err *err)
{
  int n_edges = search->problem->graph.n_edges, n_components = search->n_components,
      (*edge)[2] = thr_calloc((size_t)n_edges + (size_t)n_components, sizeof *edge);
  int64_t *weight = thr_calloc((size_t)n_edges + (size_t)n_components, sizeof *weight);
  *candidate = (priced_join){.price = 2 * search->problem->far, .no_hub = true};
  thr_status st = edge && weight ? THR_OK : thr_nomem(err), limit = THR_OK;

  /* One hub edge of weight 0 per component: an even component gains nothing by using its edge. */
  if (!st) {
    memcpy(edge, search->edge, (size_t)n_edges * sizeof *edge);
    memcpy(weight, search->weight, (size_t)n_edges * sizeof *weight);
    for (int i = 0; i < n_components; i++)
      memcpy(edge[n_edges + i], search->edge[search->end_of_component[i]], sizeof *edge);
    thr_tjoin_problem tjoin_problem = {
        search->hub + 1, n_edges + n_components, (const int(*)[2])edge, weight, search->odd, 0};
    limit = thr_tjoin_minimum(&tjoin_problem, search->problem->engine, search->limits,
                              &candidate->join, err);
    if (limit && limit != THR_ELIMIT) st = limit;
  }

  free(edge);
  free(weight);

  /* Copy the join into an array with all hub edges. */
  bool *whole = st ? NULL : thr_calloc((size_t)search->n_edges, sizeof *whole);
  if (!st && !whole) st = thr_nomem(err);
  if (st) {
    thr_tjoin_destroy(&candidate->join);
    return st;
  }
  memcpy(whole, candidate->join.in_join, (size_t)n_edges * sizeof *whole);
  for (int i = 0; i < n_components; i++)
    whole[search->end_of_component[i]] = candidate->join.in_join[n_edges + i];
  free(candidate->join.in_join);
  candidate->join.in_join = whole;
  weigh(search, candidate);
  return limit;
}

/* Moves the join *by into *old. */
static void replace(priced_join *old, priced_join *by)
{
  thr_tjoin_destroy(&old->join);
  *old = *by;
  *by = (priced_join){0};
}

/* Says whether a join is optimal at the price of the other one, too. */
static bool optimal_at(const priced_join *candidate, const priced_join *other)
{
  return candidate->weight + other->price * candidate->n_ends ==
         other->weight + other->price * other->n_ends;
}

/* Returns the price to try next: the slope between the two joins, where the piecewise linear
 * w(q) has its corner if there is only one. In the first rounds, while there are many ends too
 * many and matchings over the hub are slow to compute, the price where the number would be right
 * if its logarithm were linear in the price. */
static int64_t next_price(const price_search *search, int round)
{
  enum { GUESSES = 12 };

  const priced_join *few = &search->few, *many = &search->many;
  int64_t price = (few->weight - many->weight) / (many->n_ends - few->n_ends);

  /* Interpolate the logarithm of the number of ends. */
  if (round < GUESSES && many->n_ends > 2 * search->problem->n_ends) {
    double low = log(few->n_ends + 1.0), high = log(many->n_ends + 1.0);
    double part = (log(search->problem->n_ends + 1.0) - low) / (high - low);
    int64_t guess = few->price - (int64_t)(part * (double)(few->price - many->price));
    if (guess > price) price = guess;
  }

  /* Prices are integers, and both ends of the interval are settled. */
  return price >= few->price ? few->price - 1 : price <= many->price ? many->price + 1 : price;
}

/* Narrows the interval of prices until its ends are 1 apart, or both joins are optimal at one
 * price, or the join with few ends has as many as allowed. Each join stays optimal at its price.
 * *proof becomes the join whose cuts prove the least weight with n_ends, if one of them does. */
static thr_status close_in(price_search *search, const priced_join **proof, thr_err *err)
{
  priced_join *few = &search->few, *many = &search->many;
  *proof = NULL;
  for (int round = 0; few->n_ends < search->problem->n_ends && few->price - many->price > 1;
       round++) {
    priced_join candidate;

    /* Solve at a price inside the interval. */
    thr_status st = solve_at(search, next_price(search, round), &candidate, err);
    if (st) {
      thr_tjoin_destroy(&candidate.join);
      return st;
    }

    /* The new join replaces the one on its side of n_ends. */
    priced_join *side = candidate.n_ends <= search->problem->n_ends ? few : many,
                *other = side == few ? many : few;
    bool meet = optimal_at(other, &candidate);
    replace(side, &candidate);
    if (!meet) continue;

    /* Both joins are optimal at this price, so the cuts of the new one hold for every number of
     * ends between theirs. */
    other->price = side->price;
    *proof = side;
    return THR_OK;
  }

  if (few->n_ends == search->problem->n_ends) *proof = few;
  return THR_OK;
}

/* ---- from few ends to as many as allowed ---- */

/* The edges that exactly one of the two joins has: an even number at every node. */
typedef struct {
  int *first, *incident; /* edges at v: incident[first[v] .. first[v + 1] - 1] */
  int *next;             /* at v, the position in incident to look at next */
  bool *used;            /* [n_edges] also edges that both joins or neither of them has */
  int n_trails, n_steps;
  int *start, *step; /* trail i, from the hub back to it: edges
                        step[start[i] .. start[i + 1] - 1] */
  int64_t *change;   /* [n_trails] of the weight, if the join with few ends takes over the trail */
  thr_scratch own;   /* the arrays */
} join_difference;

/* Lists at every node the edges that one of the two joins has and the other has not. */
static thr_status difference_init(join_difference *difference, const price_search *search,
                                  thr_err *err)
{
  size_t n = (size_t)search->hub + 1, n_edges = (size_t)search->n_edges;
  *difference = (join_difference){0};
  difference->first = thr_scratch_array(&difference->own, n + 2, sizeof *difference->first);
  difference->incident =
      thr_scratch_array(&difference->own, 2 * n_edges, sizeof *difference->incident);
  difference->next = thr_scratch_array(&difference->own, n, sizeof *difference->next);
  difference->used = thr_scratch_array(&difference->own, n_edges, sizeof *difference->used);
  difference->start = thr_scratch_array(&difference->own, n + 1, sizeof *difference->start);
  difference->step = thr_scratch_array(&difference->own, n_edges, sizeof *difference->step);
  difference->change = thr_scratch_array(&difference->own, n, sizeof *difference->change);
  if (thr_scratch_check(&difference->own, err)) return THR_ENOMEM;

  /* Count these edges at every node, two places further on for the counting sort. */
  for (size_t e = 0; e < n_edges; e++) {
    difference->used[e] = search->few.join.in_join[e] == search->many.join.in_join[e];
    for (int i = 0; i < 2 && !difference->used[e]; i++)
      difference->first[search->edge[e][i] + 2]++;
  }
  for (size_t v = 1; v <= n; v++)
    difference->first[v + 1] += difference->first[v];

  /* Fill the lists; first[v + 1] moves to the end of the list of v. */
  for (int e = 0; e < search->n_edges; e++)
    for (int i = 0; i < 2 && !difference->used[e]; i++)
      difference->incident[difference->first[search->edge[e][i] + 1]++] = e;
  memcpy(difference->next, difference->first, n * sizeof *difference->next);
  return THR_OK;
}

/* Returns an edge of the difference at v that no trail has used, or -1. */
static int unused_edge(join_difference *difference, int v)
{
  while (difference->next[v] < difference->first[v + 1] &&
         difference->used[difference->incident[difference->next[v]]])
    difference->next[v]++;
  return difference->next[v] < difference->first[v + 1] ? difference->incident[difference->next[v]]
                                                        : -1;
}

/* Splits the difference into trails from the hub back to the hub, and keeps the trails that give
 * the join with few ends two ends more. */
static void find_trails(join_difference *difference, const price_search *search)
{
  for (int e; (e = unused_edge(difference, search->hub)) >= 0;) {
    int v = search->hub, more = 0, begin = difference->n_steps;
    int64_t change = 0;

    /* Walk along unused edges; every node has an even number of them, so only the hub ends a
     * trail. */
    do {
      assert(e >= 0);
      int sign = search->few.join.in_join[e] ? -1 : 1;
      difference->used[e] = true;
      difference->step[difference->n_steps++] = e;

      /* An edge of the graph changes the weight, one to the hub the number of ends. */
      if (e < search->problem->graph.n_edges)
        change += sign * search->weight[e];
      else
        more += sign;
      v = search->edge[e][0] == v ? search->edge[e][1] : search->edge[e][0];
      e = unused_edge(difference, v);
    } while (v != search->hub);

    /* Trails that change the number of ends by -2 or 0 are of no use here. */
    if (more == 2) {
      difference->change[difference->n_trails++] = change;
      difference->start[difference->n_trails] = difference->n_steps;
    } else {
      difference->n_steps = begin;
    }
  }
}

/* Makes the join with few ends take over trails until it has n_ends. The two joins are optimal
 * at prices that are at most 1 apart, and changes are even, so that a trail saves either twice
 * the higher price or twice the lower one; the former go first. *lower_price says whether one of
 * the latter was needed, in which case only the cuts at the lower price prove the result. */
static thr_status take_over(price_search *search, bool *lower_price, thr_err *err)
{
  join_difference difference;
  thr_status st = difference_init(&difference, search, err);
  *lower_price = false;
  if (!st) find_trails(&difference, search);

  /* First the trails that save twice the higher price, then the others. */
  for (int round = 0; round < 2 && !st; round++)
    for (int i = 0; i < difference.n_trails && search->few.n_ends < search->problem->n_ends; i++) {
      bool at_lower_price = difference.change[i] > -2 * search->few.price;
      if (at_lower_price != (round == 1)) continue;

      /* Exchange the edges of the trail. */
      for (int k = difference.start[i]; k < difference.start[i + 1]; k++)
        search->few.join.in_join[difference.step[k]] =
            !search->few.join.in_join[difference.step[k]];
      search->few.n_ends += 2;
      *lower_price |= at_lower_price;
    }

  thr_scratch_free(&difference.own);
  return st;
}

/* ---- the result ---- */

/* Turns the cuts of the graph with the hub into a forest of sets without the hub, and computes
 * the price of an end that these sets demand and the sum of their values. */
static thr_status finish(const thr_endjoin_problem *endjoin_problem, thr_cuts *cuts,
                         thr_endjoin *out, thr_err *err)
{
  /* Take complements of the sets with the hub, nest the sets, and add up the values round every
   * node. */
  int64_t *held = thr_calloc((size_t)cuts->n_nodes, sizeof *held);
  thr_status st = held ? thr_cuts_avoid_last(cuts, err) : thr_nomem(err);
  if (!st) st = thr_cuts_nest(cuts, err);
  if (!st) st = thr_cuts_held(cuts, held, err);

  /* A hub edge is loaded with the values of all sets round its node: the price must be no less. */
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

/* Registers a join that is optimal at its price for confirmation by GLPK. */
static thr_status confirm(price_search *search, const priced_join *candidate, thr_err *err)
{
  /* The programme is that of the price at which the join was found. */
  for (int e = search->problem->graph.n_edges; e < search->n_edges; e++)
    search->weight[e] = candidate->price;
  thr_tjoin_problem tjoin_problem = {
      search->hub + 1, search->n_edges, (const int(*)[2])search->edge,
      search->weight,  search->odd,     0};
  return candidate->no_hub
             ? THR_OK
             : thr_confirmations_add(search->problem->count, &tjoin_problem, &candidate->join, err);
}

/* Hands out the edges of one join and the cuts of another, which prove them. */
static thr_status hand_out(price_search *search, priced_join *found, priced_join *proof,
                           thr_endjoin *out, thr_err *err)
{
  *out = (thr_endjoin){.in_join = found->join.in_join};
  found->join.in_join = NULL;
  return take_cuts(search->problem, search->hub + 1, &proof->join, out, err);
}

/* Returns the lower bound on the weight with n_ends that the cuts of a join prove, in units of
 * the cuts' values. */
static double bound(const price_search *search, const priced_join *candidate)
{
  return (double)candidate->join.sum -
         (double)candidate->price * search->problem->n_ends * THR_DUAL_DENOMINATOR;
}

/* Hands out, when the limits stop the search, the join with few ends and the better bound. */
static thr_status take_best(price_search *search, thr_endjoin *out, thr_err *err)
{
  bool better = !search->few.no_hub && bound(search, &search->few) > bound(search, &search->many);
  return hand_out(search, &search->few, better ? &search->few : &search->many, out, err);
}

/* Lowers the price of the join without ends of a connected graph to the least integer at which
 * this join is optimal: more than the sum of the values of the sets round any node where an end
 * is allowed. */
static thr_status lower_closed_price(price_search *search, thr_err *err)
{
  int64_t *held = thr_calloc((size_t)search->hub + 1, sizeof *held), most = 0;
  const thr_cuts cuts = {search->few.join.n_cuts, search->hub + 1, search->few.join.cut};
  thr_status st = held ? thr_cuts_held(&cuts, held, err) : thr_nomem(err);

  /* No hub edge of a higher price is overloaded by the cuts. */
  for (int v = 0; v < search->hub && !st; v++)
    if (search->problem->end_allowed[v] && held[v] > most) most = held[v];

  free(held);
  if (!st && most / THR_DUAL_DENOMINATOR + 1 < search->few.price)
    search->few.price = most / THR_DUAL_DENOMINATOR + 1;
  return st;
}

/* Computes the lightest of the joins with the fewest ends, optimal at a price at which two ends
 * more never pay. */
static thr_status solve_few(price_search *search, thr_err *err)
{
  thr_status st = solve_fewest(search, &search->few, err);
  if (st) return st;
  if (search->n_components == 1) return lower_closed_price(search, err);

  /* Joins of different components may end at other nodes than solve_fewest allows. */
  priced_join candidate;
  st = solve_at(search, 2 * search->problem->far, &candidate, err);
  if (!st) replace(&search->few, &candidate);
  thr_tjoin_destroy(&candidate.join);
  return st;
}

/* Computes the join with n_ends ends by a search for the price, and its proof. */
static thr_status run(price_search *search, thr_endjoin *out, thr_err *err)
{
  thr_err stopped = {0};
  const priced_join *proof = NULL;
  bool lower_price = false;

  /* If ends cost nothing and there are not too many of them, nothing has to be searched for. */
  thr_status st = solve_at(search, 0, &search->many, &stopped), limit = st;
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", stopped.text);
  if (search->many.n_ends <= search->problem->n_ends) {
    st = limit ? THR_OK : confirm(search, &search->many, err);
    if (!st) st = hand_out(search, &search->many, &search->many, out, err);
    return !st && limit ? thr_fail(err, limit, "%s", stopped.text) : st;
  }

  /* Otherwise enclose the price and narrow the interval. */
  st = solve_few(search, &stopped);
  if (!st && !limit) st = close_in(search, &proof, &stopped);
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", stopped.text);

  /* Stopped: hand out the best join and bound so far. */
  if (st || limit) {
    st = take_best(search, out, err);
    return st ? st : thr_fail(err, THR_ELIMIT, "%s", stopped.text);
  }

  /* The join whose cuts are the proof is confirmed as found, before circuits are taken over. */
  bool many_proves = proof == &search->many;
  if ((st = confirm(search, many_proves ? &search->many : &search->few, err))) return st;

  if (search->few.n_ends < search->problem->n_ends && (st = take_over(search, &lower_price, err)))
    return st;

  /* If trails were taken over, the proof is at the price of the last one. */
  bool by_many = proof ? many_proves : lower_price;
  return hand_out(search, &search->few, by_many ? &search->many : &search->few, out, err);
}

/* ---- two ends ---- */

/* Turns the cuts of a join with two leaves a and b, the last nodes, into cuts with one hub in
 * the place of both. The leaves are alike, so a set S + a can be replaced by S + a and S + b of
 * half its value each, and these two by their differences {a} and {b}, which load no edge more.
 * The sets {a} and {b} are dropped, because they say nothing once the ends have a price. */
static thr_status join_leaves(thr_cuts *cuts, thr_err *err)
{
  const int a = cuts->n_nodes - 2, b = a + 1;
  int *leaves = thr_calloc((size_t)cuts->n, sizeof *leaves); /* 1 = holds a, 2 = holds b */
  bool *drop = thr_calloc((size_t)cuts->n, sizeof *drop);
  thr_status st = leaves && drop ? THR_OK : thr_nomem(err);

  /* Find the sets with exactly one of the leaves; children come before their parents. */
  for (int i = 0; i < cuts->n && !st; i++) {
    const thr_cut *cut = &cuts->cut[i];
    for (int j = cut->n_nodes - 1; j >= 0 && cut->node[j] >= a; j--)
      leaves[i] |= cut->node[j] == a ? 1 : 2;
    if (cut->parent >= 0) leaves[cut->parent] |= leaves[i];
    drop[i] = leaves[i] == 1 || leaves[i] == 2;
  }

  /* Drop these sets; the others hold both leaves or none, and one leaf is enough. */
  if (!st) st = thr_cuts_drop(cuts, drop, err);

  /* Doubled values are in halves of a weight, as in the search for a price. */
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

/* Computes the join of one cord in a connected graph: two odd leaves stand for the ends, each
 * with an edge to every node where an end is allowed, and one edge joins the leaves. The search
 * has the graph and the edges of one leaf. */
static thr_status solve_two(price_search *search, thr_endjoin *out, thr_err *err)
{
  const thr_tjoin_problem *tjoin_problem = &search->problem->graph;
  int n = tjoin_problem->n_nodes, n_hub_graph = search->n_edges,
      n_all = 2 * n_hub_graph - tjoin_problem->n_edges + 1,
      (*edge)[2] = thr_calloc((size_t)n_all, sizeof *edge);
  int64_t *weight = thr_calloc((size_t)n_all, sizeof *weight);
  bool *odd = thr_calloc((size_t)n + 2, sizeof *odd);
  thr_tjoin tjoin = {0};
  thr_status st = edge && weight && odd ? THR_OK : thr_nomem(err), limit = THR_OK;

  /* The second leaf gets copies of the hub edges. Leaf edges weigh so much that every leaf has
   * degree 1 in a minimum join. */
  if (!st) {
    memcpy(odd, tjoin_problem->odd, (size_t)n * sizeof *odd);
    odd[n] = odd[n + 1] = true;
    for (int e = 0; e < n_all - 1; e++) {
      memcpy(edge[e], search->edge[e < n_hub_graph ? e : e - n_hub_graph + tjoin_problem->n_edges],
             sizeof *edge);
      edge[e][1] += e >= n_hub_graph;
      weight[e] = e < tjoin_problem->n_edges ? tjoin_problem->weight[e] : search->problem->far;
    }
    edge[n_all - 1][0] = n, edge[n_all - 1][1] = n + 1;
    weight[n_all - 1] = 2 * search->problem->far;

    /* Solve, and confirm the result. */
    thr_tjoin_problem with_leaves = {n + 2, n_all, (const int(*)[2])edge, weight, odd, 2};
    limit = thr_tjoin_minimum(&with_leaves, search->problem->engine, search->limits, &tjoin, err);
    if (limit == THR_ELIMIT) { /* whose quick joins need not respect the leaves */
      thr_tjoin_destroy(&tjoin);
      limit = thr_tjoin_solve(&with_leaves, search->limits, &tjoin, err);
    }
    if (limit && limit != THR_ELIMIT) st = limit;
    if (!st && !limit)
      st = thr_confirmations_add(search->problem->count, &with_leaves, &tjoin, err);
  }

  /* Turn the cuts into cuts with a price, and hand out the join. */
  if (!st) {
    thr_cuts cuts = {tjoin.n_cuts, n + 2, tjoin.cut};
    st = join_leaves(&cuts, err);
    tjoin.n_cuts = cuts.n;
    *out = (thr_endjoin){.in_join = tjoin.in_join};
    tjoin.in_join = NULL;
    if (!st) st = take_cuts(search->problem, n + 1, &tjoin, out, err);
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
  /* Bounds at a price are not bounds on the join, so the search for a price reports no progress. */
  thr_limits quiet = *limits;
  quiet.progress = NULL;
  price_search search = {.problem = endjoin_problem, .limits = limits};
  *out = (thr_endjoin){0};
  thr_status st = search_init(&search, err);
  bool two = endjoin_problem->n_ends == 2 && search.n_components == 1;

  if (!two) search.limits = &quiet;
  if (!st) st = two ? solve_two(&search, out, err) : run(&search, out, err);
  search_destroy(&search);
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
