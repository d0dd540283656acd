/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs the passes at one node such that the turns tie the node: a spanning tree of its edges that
 * keeps to the numbers of passes, the remaining passes paired cheaply, then exchanges of pairs.
 *
 * The tree is Kruskal's, by the prices of turns. Exchanges of two pairs, and of three at small
 * nodes, are made while they save and the node stays tied.
 *
 * Example: a node with three edges of two passes each is tied by the three turns between them. */
#include "graph/arrays.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST = 5000,
  TRIPLES = 14
}; /* passes at a node; pairs up to which three of them are exchanged too */

static const double forbidden = 1e6, saving = -1e-9;

void thr_knot_destroy(thr_knot *knot)
{
  free(knot->pair);
  free(knot->parent);
  free(knot->order);
  free(knot->price);
  *knot = (thr_knot){0};
}

/* A column with its weight. */
typedef struct {
  int64_t weight;
  int column;
} ranked;

/* Orders columns by weight, then by number. */
static int by_weight(const void *a, const void *b)
{
  const ranked *one = a, *other = b;
  if (one->weight != other->weight) return one->weight < other->weight ? -1 : 1;
  return (one->column > other->column) - (one->column < other->column);
}

/* Sorts the turns of every node, the cheapest first. */
static thr_status rank_turns(thr_knot *knot, thr_err *err)
{
  const thr_turning_columns *turning_columns = knot->c;
  ranked *list = thr_calloc((size_t)turning_columns->first_extra, sizeof *list);
  if (!list) return thr_nomem(err);

  for (int j = 0; j < turning_columns->first_extra; j++)
    list[j] = (ranked){turning_columns->weight[j], j};

  /* Turns of one node are consecutive columns. */
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    int d = thr_degree(turning_columns->f, v);
    qsort(list + turning_columns->pair_first[v], (size_t)d * (size_t)(d - 1) / 2, sizeof *list,
          by_weight);
  }

  for (int j = 0; j < turning_columns->first_extra; j++)
    knot->order[j] = list[j].column;
  free(list);
  return THR_OK;
}

thr_status thr_knot_init(thr_knot *knot, const thr_turning_columns *turning_columns, int most,
                         thr_err *err)
{
  int degree = 1;
  *knot = (thr_knot){.c = turning_columns, .most = most / 2, .at = -1};
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if (thr_degree(turning_columns->f, v) > degree) degree = thr_degree(turning_columns->f, v);

  if (most > MOST || degree > MOST)
    return thr_fail(err, THR_EINPUT, "a node with %d passes is too large to tie",
                    most > degree ? most : degree);

  /* The edges of the largest node, and the place of the ends. */
  size_t places = (size_t)degree + 1;
  knot->pair = thr_calloc((size_t)knot->most, sizeof *knot->pair);
  knot->parent = thr_calloc(3 * places, sizeof *knot->parent);
  knot->left = knot->parent + places;
  knot->room = knot->left + places;
  knot->order = thr_calloc((size_t)turning_columns->first_extra, sizeof *knot->order);
  knot->price = thr_calloc(places * places, sizeof *knot->price);
  thr_status st = knot->pair && knot->parent && knot->order && knot->price ? rank_turns(knot, err)
                                                                           : thr_nomem(err);
  if (st) thr_knot_destroy(knot);
  return st;
}

/* Fills in the prices between the places of node v; the last place is that of the ends, where
 * nothing turns. */
static void price_places(thr_knot *knot, int v)
{
  const thr_turning_columns *turning_columns = knot->c;
  const int *half = turning_columns->f->half + turning_columns->f->first[v], d = knot->d;
  for (int i = 0; i < d; i++) {
    for (int j = i + 1; j < d; j++)
      knot->price[i * (d + 1) + j] = knot->price[j * (d + 1) + i] = ldexp(
          (double)turning_columns->weight[thr_turning_column(turning_columns, half[i], half[j])],
          -THR_TURNING_BITS);
    knot->price[i * (d + 2)] = forbidden;
    knot->price[i * (d + 1) + d] = knot->price[d * (d + 1) + i] = 0;
  }
  knot->price[d * (d + 2)] = forbidden;
  knot->at = v;
}

/* Returns the price of a pair. */
static double price_of(const thr_knot *knot, thr_knot_pair knot_pair)
{
  return knot->price[knot_pair.a * (knot->d + 1) + knot_pair.b];
}

/* Pairs a pass of place a with one of place b. */
static void add_pair(thr_knot *knot, int a, int b)
{
  knot->left[a]--;
  knot->left[b]--;
  knot->pair[knot->n++] = (thr_knot_pair){a, b};
}

/* Starts with node v: no pass is paired, and every edge is a part of its own. */
static void take_node(thr_knot *knot, int v, const int *passes, int ends)
{
  const thr_frame *frame = knot->c->f;
  knot->d = thr_degree(frame, v);
  knot->n = 0;
  if (knot->at != v) price_places(knot, v);

  for (int i = 0; i < knot->d; i++) {
    knot->left[i] = knot->room[i] = passes[frame->half[frame->first[v] + i] >> 1];
    knot->parent[i] = i;
  }

  knot->left[knot->d] = ends;
}

/* Grows Kruskal's tree, except that a part keeps a pass to be joined by until it is the last. The
 * passes are enough for a tree, so a part with two or more is there to join with. */
static void grow_tree(thr_knot *knot, int v)
{
  const thr_turning_columns *turning_columns = knot->c;
  const int *order = knot->order + turning_columns->pair_first[v];

  /* Rounds over the turns, the cheapest first: a turn that was refused may be allowed later. */
  for (int parts = knot->d, turns = knot->d * (knot->d - 1) / 2; parts > 1;)
    for (int q = 0; q < turns && parts > 1; q++) {
      int i = turning_columns->position[turning_columns->half[order[q]][0]],
          j = turning_columns->position[turning_columns->half[order[q]][1]];

      if (knot->left[i] == 0 || knot->left[j] == 0) continue;

      /* Two parts may only be joined if the new part has a pass left, or is the last one. */
      int a = thr_disjoint_find(knot->parent, i), b = thr_disjoint_find(knot->parent, j),
          room = knot->room[a] + knot->room[b] - 2;
      if (a == b || (room == 0 && parts > 2)) continue;
      thr_disjoint_join(knot->parent, a, b);

      knot->room[a < b ? a : b] = room;
      add_pair(knot, i, j);
      parts--;
    }
}

/* Pairs the remaining passes: ends with the edges that have most passes left, then the cheapest
 * turns first. Passes still left go back into their own edge, until they are exchanged. */
static void pair_rest(thr_knot *knot, int v)
{
  const thr_turning_columns *turning_columns = knot->c;
  const int *order = knot->order + turning_columns->pair_first[v],
            turns = knot->d * (knot->d - 1) / 2;

  /* Ends take passes of the edge that has most left. */
  while (knot->left[knot->d] > 0) {
    int most = knot->d;
    for (int i = knot->d - 1; i >= 0; i--)
      if (knot->left[i] > 0 && (most == knot->d || knot->left[i] >= knot->left[most])) most = i;
    add_pair(knot, most, knot->d);
  }

  /* Then the turns, from the cheapest on, as often as both edges allow. */
  for (int q = 0; q < turns; q++) {
    int i = turning_columns->position[turning_columns->half[order[q]][0]],
        j = turning_columns->position[turning_columns->half[order[q]][1]];
    while (knot->left[i] > 0 && knot->left[j] > 0)
      add_pair(knot, i, j);
  }

  /* What is left over turns back, at a price that exchanges will avoid. */
  for (int i = 0; i < knot->d; i++)
    while (knot->left[i] > 0)
      add_pair(knot, i, i);
}

/* ---- exchanges ---- */

/* Joins the parts of a pair's edges; returns 1 if they were apart. */
static int connects(thr_knot *knot, thr_knot_pair knot_pair)
{
  return knot_pair.a != knot->d && knot_pair.b != knot->d &&
         thr_disjoint_join(knot->parent, knot_pair.a, knot_pair.b);
}

/* Returns whether the node is tied with pairs `in` in the place of pairs `out`, n of each, out
 * ascending. */
static bool stays_tied(thr_knot *knot, int n, const int *out, const thr_knot_pair *in)
{
  int parts = knot->d, skipped = 0;

  /* Join the edges by all pairs that stay, then by the new ones. */
  for (int i = 0; i < knot->d; i++)
    knot->parent[i] = i;

  for (int i = 0; i < knot->n && parts > 1; i++)
    if (skipped < n && out[skipped] == i)
      skipped++;
    else
      parts -= connects(knot, knot->pair[i]);
  for (int i = 0; i < n && parts > 1; i++)
    parts -= connects(knot, in[i]);

  return parts == 1;
}

/* Returns a pair, turned round if asked for. */
static thr_knot_pair turned(thr_knot_pair knot_pair, bool around)
{
  return around ? (thr_knot_pair){knot_pair.b, knot_pair.a} : knot_pair;
}

/* Makes the cheapest exchange of pair i with another one, if it saves. */
static bool exchange_two(thr_knot *knot, int i)
{
  double best = saving;
  thr_knot_pair knot_pair = knot->pair[i], better[2] = {knot_pair, knot_pair};
  int with = -1;

  /* Each other pair, in both directions. */
  for (int j = 0; j < knot->n; j++)
    for (int way = 0; way < 2; way++) {
      thr_knot_pair other = turned(knot->pair[j], way),
                    in[2] = {{knot_pair.a, other.a}, {knot_pair.b, other.b}};
      double more = price_of(knot, in[0]) + price_of(knot, in[1]) - price_of(knot, knot_pair) -
                    price_of(knot, other);

      if (j == i || more >= best ||
          !stays_tied(knot, 2, (const int[2]){i < j ? i : j, i < j ? j : i}, in))
        continue;

      best = more;
      with = j;
      memcpy(better, in, sizeof better);
    }

  if (with < 0) return false;
  knot->pair[i] = better[0];
  knot->pair[with] = better[1];
  return true;
}

/* Exchanges pairs out[0], out[1], out[2] in a ring, each forwards or backwards; the first way that
 * saves is taken. */
static bool exchange_these(thr_knot *knot, const int *out)
{
  const thr_knot_pair first = knot->pair[out[0]];
  double before = price_of(knot, first) + price_of(knot, knot->pair[out[1]]) +
                  price_of(knot, knot->pair[out[2]]);

  /* The first pair keeps its place in the ring; 8 ways to turn the pairs round. */
  for (int way = 0; way < 8; way++) {
    thr_knot_pair knot_pair = turned(first, way & 1), second = turned(knot->pair[out[1]], way & 2),
                  third = turned(knot->pair[out[2]], way & 4);
    thr_knot_pair in[3] = {{knot_pair.a, second.a}, {second.b, third.a}, {third.b, knot_pair.b}};

    if (price_of(knot, in[0]) + price_of(knot, in[1]) + price_of(knot, in[2]) - before >= saving ||
        !stays_tied(knot, 3, out, in))
      continue;

    for (int i = 0; i < 3; i++)
      knot->pair[out[i]] = in[i];
    return true;
  }
  return false;
}

/* Makes the first exchange of three pairs that saves. */
static bool exchange_three(thr_knot *knot)
{
  int out[3];
  for (out[0] = 0; out[0] < knot->n; out[0]++)
    for (out[1] = out[0] + 1; out[1] < knot->n; out[1]++)
      for (out[2] = out[1] + 1; out[2] < knot->n; out[2]++)
        if (exchange_these(knot, out)) return true;
  return false;
}

/* Makes exchanges until none saves. */
static void exchange(thr_knot *knot)
{
  bool saved = true;
  while (saved) {
    saved = false;
    for (int i = 0; i < knot->n; i++)
      saved |= exchange_two(knot, i);
    if (!saved && knot->n <= TRIPLES) saved = exchange_three(knot);
  }
}

bool thr_knot_tie(thr_knot *knot, int v, const int *passes, const int *ends)
{
  const thr_frame *frame = knot->c->f;
  int sum = ends ? ends[v] : 0;
  knot->turning = INFINITY;

  /* An edge without passes, or numbers that no turns tie, end the attempt. */
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    sum += passes[frame->half[i] >> 1];
    if (passes[frame->half[i] >> 1] < 1) return false;
  }

  if (sum / 2 > knot->most || thr_tie_need(knot->c, v, passes, ends) > 0) return false;

  take_node(knot, v, passes, ends ? ends[v] : 0);
  grow_tree(knot, v);
  pair_rest(knot, v);
  exchange(knot);

  /* A pair that must not be is left if the exchanges could not remove it. */
  knot->turning = 0;
  for (int i = 0; i < knot->n; i++)
    knot->turning += price_of(knot, knot->pair[i]);

  if (knot->turning < forbidden / 2) return true;
  knot->turning = INFINITY;
  return false;
}
