/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certificates that no solver would make, on small frameworks of one or two pieces with requests of
 * every kind: the checker takes one if and only if plain sums over sets do, and what it takes
 * proves no more than is true of all subsets of edges. */
#include "tests/support.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "graph/check/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  ROUNDS = 3000,
  PIECES = 2,
  NODES = 6,
  EDGES = 10,
  CUTS = 7,
  MOST_NODES = PIECES * NODES,
  MOST_EDGES = PIECES * EDGES
};
__extension__ typedef __int128 wide;

/* A framework with its pieces, each a framework too. */
typedef struct {
  int n_pieces, first_node[PIECES + 1], first_edge[PIECES + 1];
  thr_frame piece[PIECES], whole;
  thr_request o, of_piece[PIECES];
  bool end_node[MOST_NODES];
  int end_count[MOST_NODES];
  int passes[MOST_EDGES];
} request;

static int *passes_list(rng *r, int n, int kind)
{
  int *list = kind ? calloc((size_t)n, sizeof *list) : NULL;
  for (int e = 0; list && e < n; e++)
    list[e] = kind == 1 ? rng_between(r, 1, 3) : rng_below(r, 2) ? 0 : rng_between(r, 3, 4);
  return list;
}

static void unite(request *q)
{
  double xyz[MOST_NODES][3], length[MOST_EDGES];
  int edge[MOST_EDGES][2], feet[MOST_NODES + 1], n_feet = 0;
  bool covers = false, capacities = false;
  for (int k = 0; k < q->n_pieces; k++) {
    const thr_frame *f = &q->piece[k];
    int v0 = q->first_node[k], e0 = q->first_edge[k];
    for (int v = 0; v < f->n_nodes; v++) {
      for (int i = 0; i < 3; i++)
        xyz[v0 + v][i] = f->xyz[v][i] + (i == 0 ? 1e4 * k : 0);
      if (f->foot[v]) feet[n_feet++] = v0 + v;
    }
    for (int e = 0; e < f->n_edges; e++) {
      for (int i = 0; i < 2; i++)
        edge[e0 + e][i] = v0 + f->edge[e][i];
      length[e0 + e] = f->length[e];
    }
    q->first_node[k + 1] = v0 + f->n_nodes;
    q->first_edge[k + 1] = e0 + f->n_edges;
    covers |= f->cover != NULL;
    capacities |= f->capacity != NULL;
  }
  feet[n_feet] = -1;
  int n = q->first_node[q->n_pieces], m = q->first_edge[q->n_pieces];
  q->whole = frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, length, feet);
  if (covers) q->whole.cover = calloc((size_t)m, sizeof(int));
  if (capacities) q->whole.capacity = calloc((size_t)m, sizeof(int));
  for (int k = 0; k < q->n_pieces; k++)
    for (int e = 0; e < q->piece[k].n_edges; e++) {
      if (covers)
        q->whole.cover[q->first_edge[k] + e] = q->piece[k].cover ? q->piece[k].cover[e] : 1;
      if (capacities)
        q->whole.capacity[q->first_edge[k] + e] =
            q->piece[k].capacity ? q->piece[k].capacity[e] : 0;
    }
}

static int need(const request *q, int e)
{
  int own = q->whole.cover ? q->whole.cover[e] : 1;
  return own > q->o.cover ? own : q->o.cover;
}

static int room(const request *q, int e)
{
  int own = q->whole.capacity && q->whole.capacity[e] ? q->whole.capacity[e] : 1000;
  return (q->o.capacity && q->o.capacity < own ? q->o.capacity : own) - need(q, e);
}

static bool free_ends(const request *q)
{
  return q->o.ends != THR_ENDS_CLOSED && q->o.ends != THR_ENDS_COUNTS;
}

static bool allowed(const request *q, int v)
{
  return q->o.ends == THR_ENDS_ANY ||
         (q->o.ends == THR_ENDS_FEET ? q->whole.foot[v] : q->end_node[v]);
}

static int piece_of(const request *q, int v)
{
  return v >= q->first_node[1];
}

/* Is the number of passes at v, together with the ends that it is to have, odd? */
static bool odd_at(const request *q, int v, const int *passes)
{
  int sum = q->o.ends == THR_ENDS_COUNTS ? q->end_count[v] : 0;
  for (int e = 0; e < q->whole.n_edges; e++)
    if (q->whole.edge[e][0] == v || q->whole.edge[e][1] == v)
      sum += passes ? passes[e] : need(q, e);
  return sum % 2;
}

static bool cords_fit(const request *q)
{
  int odd[PIECES] = {0};
  for (int e = 0; e < q->whole.n_edges; e++)
    if (q->passes[e] < need(q, e) || q->passes[e] > need(q, e) + room(q, e)) return false;
  for (int v = 0; v < q->whole.n_nodes; v++)
    if (odd_at(q, v, q->passes) &&
        (!free_ends(q) || !allowed(q, v) || ++odd[piece_of(q, v)] > 2 * q->o.cords))
      return false;
  return true;
}

/* Any extra passes that cords can make; false: none found. */
static bool choose_passes(rng *r, request *q)
{
  for (int tries = 0; tries < 300; tries++) {
    int many = rng_between(r, 2, 5);
    for (int e = 0; e < q->whole.n_edges; e++)
      q->passes[e] = need(q, e) + (rng_below(r, many) == 0) + 2 * (rng_below(r, 12) == 0);
    if (cords_fit(q)) return true;
  }
  return false;
}

static void request_destroy(request *q)
{
  for (int k = 0; k < q->n_pieces; k++)
    thr_frame_destroy(&q->piece[k]);
  thr_frame_destroy(&q->whole);
}

static void request_make(rng *r, request *q)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES,
                                  THR_ENDS_COUNTS};
  *q = (request){.n_pieces = 1 + (rng_below(r, 4) == 0),
                 .o = options_for(ends[rng_below(r, 5)], rng_between(r, 1, 3))};
  for (int k = 0; k < q->n_pieces; k++) {
    thr_frame *f = &q->piece[k];
    *f = random_frame(r, rng_between(r, 2, NODES), rng_below(r, 5),
                      (length_kind)rng_below(r, LENGTH_KINDS));
    ck_assert_int_le(f->n_edges, EDGES);
    f->cover = passes_list(r, f->n_edges, rng_below(r, 2));
    f->capacity = passes_list(r, f->n_edges, 2 * rng_below(r, 2));
  }
  unite(q);
  q->o.cords = rng_between(r, 1, 2);
  q->o.capacity = rng_below(r, 3) ? 0 : rng_between(r, 3, 4);
  for (int v = 0; v < q->whole.n_nodes; v++) {
    q->end_node[v] = rng_below(r, 2);
    q->end_count[v] = rng_below(r, 3) ? 0 : rng_between(r, 1, 2);
  }
  if (q->o.ends == THR_ENDS_NODES) q->o.end_node = q->end_node;
  if (q->o.ends == THR_ENDS_COUNTS) q->o.end_count = q->end_count;
  for (int k = 0; k < q->n_pieces; k++) {
    q->of_piece[k] = q->o;
    if (q->o.end_node) q->of_piece[k].end_node = q->end_node + q->first_node[k];
    if (q->o.end_count) q->of_piece[k].end_count = q->end_count + q->first_node[k];
  }
}

/* ---- certificates ---- */

/* A certificate with its sets as words of bits. */
typedef struct {
  thr_certificate c;
  thr_cut cut[CUTS];
  int node[CUTS][MOST_NODES];
  uint32_t set[CUTS];
} proof;

static int64_t weight_of(const request *q, const proof *p, int e)
{
  return (int64_t)llrint(q->whole.length[e] * p->c.scale);
}

static wide load_of(const request *q, const proof *p, int e)
{
  wide load = 0;
  for (int i = 0; i < p->c.n_cuts; i++)
    if ((p->set[i] >> q->whole.edge[e][0] ^ p->set[i] >> q->whole.edge[e][1]) & 1)
      load += p->cut[i].value;
  return load;
}

/* Least of what edges and ends have left over for this set, with the end price as it is. */
static wide slack_of(const request *q, const proof *p, uint32_t set)
{
  wide least = (wide)1 << 100;
  for (int e = 0; e < q->whole.n_edges; e++)
    if (room(q, e) > 0 && ((set >> q->whole.edge[e][0] ^ set >> q->whole.edge[e][1]) & 1)) {
      wide slack = (wide)weight_of(q, p, e) * p->c.denominator - load_of(q, p, e);
      if (slack < least) least = slack;
    }
  for (int v = 0; v < q->whole.n_nodes && free_ends(q); v++)
    if (set >> v & 1 && allowed(q, v)) {
      wide slack = p->c.end_price;
      for (int i = 0; i < p->c.n_cuts; i++)
        if (p->set[i] >> v & 1) slack -= p->cut[i].value;
      if (slack < least) least = slack;
    }
  return least;
}

static bool odd_set(const request *q, uint32_t set)
{
  bool odd = false;
  for (int v = 0; v < q->whole.n_nodes; v++)
    if (set >> v & 1) odd ^= odd_at(q, v, NULL);
  return odd;
}

/* Random disjoint own nodes in random trees, most of them odd. */
static void choose_sets(rng *r, const request *q, proof *p, int piece)
{
  int from = q->first_node[piece], to = q->first_node[piece + 1], whole = rng_below(r, 6) ? 1 : 10;
  p->c.n_cuts = rng_below(r, CUTS + 1);
  uint32_t of_tree[CUTS] = {0};
  for (int i = p->c.n_cuts - 1; i >= 0; i--) { /* parents first, so that a tree's nodes are known */
    int up = rng_below(r, 3) && i + 1 < p->c.n_cuts ? rng_between(r, i + 1, p->c.n_cuts - 1) : -1,
        root = i;
    p->cut[i] = (thr_cut){.parent = up, .node = p->node[i]};
    while (p->cut[root].parent >= 0)
      root = p->cut[root].parent;
    for (int v = from; v < to; v++)
      if (rng_below(r, 3) < whole && (!(of_tree[root] >> v & 1) || rng_below(r, 200) == 0)) {
        if (rng_below(r, 2 + 3 * (up < 0)) >= 1 && whole == 1) continue; /* some for the children */
        p->node[i][p->cut[i].n_nodes++] = v;
        of_tree[root] |= UINT32_C(1) << v;
      }
  }
  for (int i = 0; i < p->c.n_cuts; i++)
    p->set[i] = 0;
  for (int i = 0; i < p->c.n_cuts; i++) {
    for (int j = 0; j < p->cut[i].n_nodes; j++)
      p->set[i] |= UINT32_C(1) << p->node[i][j];
    int root = i;
    while (p->cut[root].parent >= 0)
      root = p->cut[root].parent;
    for (int k = rng_below(r, 40); k > 0 && !odd_set(q, p->set[i]);
         k--) { /* mend the parity with a node of no set */
      int v = rng_between(r, from, to - 1);
      if (of_tree[root] >> v & 1 || !odd_at(q, v, NULL)) continue;
      of_tree[root] |= UINT32_C(1) << v;
      p->set[i] |= UINT32_C(1) << v;
      int at = p->cut[i].n_nodes++;
      for (; at > 0 && p->node[i][at - 1] > v; at--)
        p->node[i][at] = p->node[i][at - 1];
      p->node[i][at] = v;
    }
    if (p->cut[i].parent >= 0) p->set[p->cut[i].parent] |= p->set[i];
  }
}

/* Sets, and multipliers that use up most of what there is, sometimes a little more. */
static void proof_make(rng *r, const request *q, proof *p, int piece)
{
  static const double scale[] = {1, 1, 2, 1000, 0.25, 1e-3, 1 << 20, 1e15};
  static const int64_t denominator[] = {1, 1, 2, 3, 4096, INT64_C(1) << 40};
  memset(p, 0, sizeof *p);
  p->c = (thr_certificate){.component = piece,
                           .cut = p->cut,
                           .scale = scale[rng_below(r, 8)],
                           .denominator = denominator[rng_below(r, 6)]};
  if (p->c.scale > 1e6) p->c.denominator = rng_between(r, 1, 3);
  choose_sets(r, q, p, piece);
  double price = free_ends(q) || rng_below(r, 50) == 0
                     ? rng_below(r, 4) * 0.5 * p->c.scale * (double)p->c.denominator
                     : 0;
  p->c.end_price = price < 1e15 ? (int64_t)price * rng_between(r, 1, 3) : 0;
  bool sound = rng_below(r, 3) > 0;
  for (int rounds = 0; rounds < 3; rounds++)
    for (int i = 0; i < p->c.n_cuts; i++) {
      if (rounds && rng_below(r, 2)) continue;
      wide slack = odd_set(q, p->set[i]) || !sound ? slack_of(q, p, p->set[i]) : 0;
      if (slack > INT64_C(1) << 55) slack = INT64_C(1) << 55;
      int64_t most = slack > 0 ? (int64_t)slack : 0;
      if (rng_below(r, 3) == 0) most = most / 2;
      p->cut[i].value += most;
    }
  if (!sound && p->c.n_cuts) p->cut[rng_below(r, p->c.n_cuts)].value += rng_between(r, -1, 1);
  if (!sound && rng_below(r, 3) == 0 && p->c.end_price > 0) p->c.end_price--;
  for (int i = 0; i < p->c.n_cuts; i++)
    p->c.sum += p->cut[i].value;
  for (int e = q->first_edge[piece]; e < q->first_edge[piece + 1]; e++)
    p->c.join += weight_of(q, p, e) * (q->passes[e] - need(q, e));
  if (rng_below(r, 100) == 0) p->c.sum++;
  if (rng_below(r, 100) == 0) p->c.join++;
}

/* The verdict in plain sums. */
static bool holds(const request *q, const proof *p, int piece)
{
  wide sum = 0, join = 0;
  for (int i = 0; i < p->c.n_cuts; i++) {
    if (p->cut[i].value < 0 || !odd_set(q, p->set[i])) return false;
    for (int j = 0; j < i; j++)
      if (p->set[i] & p->set[j]) { /* one in the other if their trees are one */
        int a = i, b = j;
        bool below = false;
        for (int k = j; k >= 0; k = p->cut[k].parent)
          below |= k == i;
        while (p->cut[a].parent >= 0)
          a = p->cut[a].parent;
        while (p->cut[b].parent >= 0)
          b = p->cut[b].parent;
        if (a == b && !below) return false;
      }
    for (int j = 0; j < p->cut[i].n_nodes; j++) /* a node of its own is in no child */
      for (int k = 0; k < i; k++)
        if (p->cut[k].parent == i && p->set[k] >> p->node[i][j] & 1) return false;
    sum += p->cut[i].value;
  }
  if (slack_of(q, p, ~UINT32_C(0)) < 0) return false; /* of ends: no edge leaves all nodes */
  for (int e = q->first_edge[piece]; e < q->first_edge[piece + 1]; e++) {
    join += (wide)weight_of(q, p, e) * (q->passes[e] - need(q, e));
    if (room(q, e) > 0 && load_of(q, p, e) > (wide)weight_of(q, p, e) * p->c.denominator)
      return false;
  }
  return sum == p->c.sum && join == p->c.join && (free_ends(q) || p->c.end_price == 0);
}

/* ---- the comparison ---- */

static void compare(const request *q, const proof *p, const double *least, int *taken, int *tight)
{
  thr_certificate c[PIECES];
  double length = 0, shortest = 0, bound = 0;
  bool optimal = false, expected = true;
  thr_err err = {0};
  for (int k = 0; k < q->n_pieces; k++) {
    c[k] = p[k].c;
    expected &= holds(q, &p[k], k);
    shortest += least[k];
  }
  for (int e = 0; e < q->whole.n_edges; e++) {
    length += q->passes[e] * q->whole.length[e];
    shortest += need(q, e) * q->whole.length[e];
  }
  thr_status st = thr_check_length_of_passes(&q->whole, &q->o, q->passes, c, q->n_pieces, &optimal,
                                             &bound, &err);
  ck_assert_msg(st == (expected ? THR_OK : THR_EVIOLATED), "status %d, sums say %d: %s", (int)st,
                expected, err.text);
  if (st) return;
  ck_assert_msg(bound <= shortest * (1 + 3e-9), "%.17g is said to be proved, but %.17g is enough",
                bound, shortest);
  ck_assert(!optimal || length <= shortest * (1 + 3e-9));
  ++*taken;
  *tight += bound >= shortest * (1 - 1e-9) && length > shortest * (1 + 1e-9);
}

START_TEST(what_is_proved_is_true)
{
  rng r = rng_make((uint64_t)_i);
  proof *p = calloc(PIECES, sizeof *p);
  int taken = 0, tight = 0, tries = 0;
  ck_assert(p != NULL);
  while (tries < ROUNDS) {
    request q;
    double least[PIECES] = {INFINITY, INFINITY};
    bool fits = true;
    request_make(&r, &q);
    for (int e = 0; e < q.whole.n_edges; e++)
      fits &= room(&q, e) >= 0;
    for (int k = 0; k < q.n_pieces && fits; k++)
      fits = (least[k] = least_extra_by_subsets(&q.piece[k], &q.of_piece[k])) < INFINITY;
    for (int again = 0; again < 20 && fits && choose_passes(&r, &q); again++, tries++) {
      for (int k = 0; k < q.n_pieces; k++)
        proof_make(&r, &q, &p[k], k);
      compare(&q, p, least, &taken, &tight);
    }
    request_destroy(&q);
  }
  free(p);
  ck_assert_int_ge(taken, tries / 5); /* or the proofs are not worth trying */
  ck_assert_int_ge(tight, 1);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("proofs");
  ADD_EXAMPLES(s, 120, what_is_proved_is_true, 4);
  return run_suite(s);
}
