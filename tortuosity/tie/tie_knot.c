/* Turns that tie one node: a spanning tree that keeps to the numbers of passes, the rest paired cheaply, then exchanges. */
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 5000, TRIPLES = 14 }; /* passes at a node; pairs up to which three of them are exchanged too */

static const double forbidden = 1e6, saving = -1e-9;

void thr_knot_destroy(thr_knot *k)
{
  free(k->pair);
  free(k->parent);
  free(k->order);
  free(k->price);
  *k = (thr_knot){0};
}

typedef struct {
  int64_t weight;
  int column;
} ranked;

static int by_weight(const void *a, const void *b)
{
  const ranked *x = a, *y = b;
  if (x->weight != y->weight) return x->weight < y->weight ? -1 : 1;
  return (x->column > y->column) - (x->column < y->column);
}

/* The turns of every node, the cheapest first. */
static thr_status rank_turns(thr_knot *k, thr_err *err)
{
  const thr_turning_columns *c = k->c;
  ranked *list = thr_calloc((size_t)c->first_extra, sizeof *list);
  if (!list) return thr_nomem(err);
  for (int j = 0; j < c->first_extra; j++)
    list[j] = (ranked){c->weight[j], j};
  for (int v = 0; v < c->f->n_nodes; v++) {
    int d = thr_degree(c->f, v);
    qsort(list + c->pair_first[v], (size_t)d * (size_t)(d - 1) / 2, sizeof *list, by_weight);
  }
  for (int j = 0; j < c->first_extra; j++)
    k->order[j] = list[j].column;
  free(list);
  return THR_OK;
}

thr_status thr_knot_init(thr_knot *k, const thr_turning_columns *c, int most, thr_err *err)
{
  int degree = 1;
  *k = (thr_knot){.c = c, .most = most / 2, .at = -1};
  for (int v = 0; v < c->f->n_nodes; v++)
    if (thr_degree(c->f, v) > degree) degree = thr_degree(c->f, v);
  if (most > MOST || degree > MOST)
    return thr_fail(err, THR_EINPUT, "a node with %d passes is too large to tie", most > degree ? most : degree);
  size_t places = (size_t)degree + 1;
  k->pair = thr_calloc((size_t)k->most, sizeof *k->pair);
  k->parent = thr_calloc(3 * places, sizeof *k->parent);
  k->left = k->parent + places;
  k->room = k->left + places;
  k->order = thr_calloc((size_t)c->first_extra, sizeof *k->order);
  k->price = thr_calloc(places * places, sizeof *k->price);
  thr_status st = k->pair && k->parent && k->order && k->price ? rank_turns(k, err) : thr_nomem(err);
  if (st) thr_knot_destroy(k);
  return st;
}

/* Prices between the places of a node; the last place is that of the ends, where nothing turns. */
static void price_places(thr_knot *k, int v)
{
  const thr_turning_columns *c = k->c;
  const int *half = c->f->half + c->f->first[v], d = k->d;
  for (int i = 0; i < d; i++) {
    for (int j = i + 1; j < d; j++)
      k->price[i * (d + 1) + j] = k->price[j * (d + 1) + i] =
          ldexp((double)c->weight[thr_turning_column(c, half[i], half[j])], -THR_TURNING_BITS);
    k->price[i * (d + 2)] = forbidden;
    k->price[i * (d + 1) + d] = k->price[d * (d + 1) + i] = 0;
  }
  k->price[d * (d + 2)] = forbidden;
  k->at = v;
}

static double price_of(const thr_knot *k, thr_knot_pair p)
{
  return k->price[p.a * (k->d + 1) + p.b];
}

static void add_pair(thr_knot *k, int a, int b)
{
  k->left[a]--;
  k->left[b]--;
  k->pair[k->n++] = (thr_knot_pair){a, b};
}

static void take_node(thr_knot *k, int v, const int *passes, int ends)
{
  const thr_frame *f = k->c->f;
  k->d = thr_degree(f, v);
  k->n = 0;
  if (k->at != v) price_places(k, v);
  for (int i = 0; i < k->d; i++) {
    k->left[i] = k->room[i] = passes[f->half[f->first[v] + i] >> 1];
    k->parent[i] = i;
  }
  k->left[k->d] = ends;
}

/* Kruskal's tree, except that a part keeps a pass to be joined by until it is the last. The passes are enough for a tree, so a
 * part with two or more is there to join with. */
static void grow_tree(thr_knot *k, int v)
{
  const thr_turning_columns *c = k->c;
  const int *order = k->order + c->pair_first[v];
  for (int parts = k->d, turns = k->d * (k->d - 1) / 2; parts > 1;)
    for (int q = 0; q < turns && parts > 1; q++) {
      int i = c->position[c->half[order[q]][0]], j = c->position[c->half[order[q]][1]];
      if (k->left[i] == 0 || k->left[j] == 0) continue;
      int a = thr_disjoint_find(k->parent, i), b = thr_disjoint_find(k->parent, j), room = k->room[a] + k->room[b] - 2;
      if (a == b || (room == 0 && parts > 2)) continue;
      thr_disjoint_join(k->parent, a, b);
      k->room[a < b ? a : b] = room;
      add_pair(k, i, j);
      parts--;
    }
}

/* Ends at the edges with most passes left; then cheapest first. What is left then goes back into its own edge, until exchanged.
 */
static void pair_rest(thr_knot *k, int v)
{
  const thr_turning_columns *c = k->c;
  const int *order = k->order + c->pair_first[v], turns = k->d * (k->d - 1) / 2;
  while (k->left[k->d] > 0) {
    int most = k->d;
    for (int i = k->d - 1; i >= 0; i--)
      if (k->left[i] > 0 && (most == k->d || k->left[i] >= k->left[most])) most = i;
    add_pair(k, most, k->d);
  }
  for (int q = 0; q < turns; q++) {
    int i = c->position[c->half[order[q]][0]], j = c->position[c->half[order[q]][1]];
    while (k->left[i] > 0 && k->left[j] > 0)
      add_pair(k, i, j);
  }
  for (int i = 0; i < k->d; i++)
    while (k->left[i] > 0)
      add_pair(k, i, i);
}

/* ---- exchanges ---- */

static int connects(thr_knot *k, thr_knot_pair p)
{
  return p.a != k->d && p.b != k->d && thr_disjoint_join(k->parent, p.a, p.b);
}

/* Is the node tied with pairs `in` in the place of pairs `out`, n of each, out ascending? */
static bool stays_tied(thr_knot *k, int n, const int *out, const thr_knot_pair *in)
{
  int parts = k->d, skipped = 0;
  for (int i = 0; i < k->d; i++)
    k->parent[i] = i;
  for (int i = 0; i < k->n && parts > 1; i++)
    if (skipped < n && out[skipped] == i)
      skipped++;
    else
      parts -= connects(k, k->pair[i]);
  for (int i = 0; i < n && parts > 1; i++)
    parts -= connects(k, in[i]);
  return parts == 1;
}

static thr_knot_pair turned(thr_knot_pair p, bool around)
{
  return around ? (thr_knot_pair){p.b, p.a} : p;
}

/* The cheapest exchange of pair i with another one, if it saves. */
static bool exchange_two(thr_knot *k, int i)
{
  double best = saving;
  thr_knot_pair p = k->pair[i], better[2] = {p, p};
  int with = -1;
  for (int j = 0; j < k->n; j++)
    for (int way = 0; way < 2; way++) {
      thr_knot_pair q = turned(k->pair[j], way), in[2] = {{p.a, q.a}, {p.b, q.b}};
      double more = price_of(k, in[0]) + price_of(k, in[1]) - price_of(k, p) - price_of(k, q);
      if (j == i || more >= best || !stays_tied(k, 2, (const int[2]){i < j ? i : j, i < j ? j : i}, in)) continue;
      best = more;
      with = j;
      memcpy(better, in, sizeof better);
    }
  if (with < 0) return false;
  k->pair[i] = better[0];
  k->pair[with] = better[1];
  return true;
}

/* Both ways around of pairs out[0], out[1], out[2], each of the last two forwards or backwards. */
static bool exchange_these(thr_knot *k, const int *out)
{
  const thr_knot_pair first = k->pair[out[0]];
  double before = price_of(k, first) + price_of(k, k->pair[out[1]]) + price_of(k, k->pair[out[2]]);
  for (int way = 0; way < 8; way++) {
    thr_knot_pair p = turned(first, way & 1), q = turned(k->pair[out[1]], way & 2), r = turned(k->pair[out[2]], way & 4);
    thr_knot_pair in[3] = {{p.a, q.a}, {q.b, r.a}, {r.b, p.b}};
    if (price_of(k, in[0]) + price_of(k, in[1]) + price_of(k, in[2]) - before >= saving || !stays_tied(k, 3, out, in)) continue;
    for (int i = 0; i < 3; i++)
      k->pair[out[i]] = in[i];
    return true;
  }
  return false;
}

static bool exchange_three(thr_knot *k)
{
  int out[3];
  for (out[0] = 0; out[0] < k->n; out[0]++)
    for (out[1] = out[0] + 1; out[1] < k->n; out[1]++)
      for (out[2] = out[1] + 1; out[2] < k->n; out[2]++)
        if (exchange_these(k, out)) return true;
  return false;
}

static void exchange(thr_knot *k)
{
  bool saved = true;
  while (saved) {
    saved = false;
    for (int i = 0; i < k->n; i++)
      saved |= exchange_two(k, i);
    if (!saved && k->n <= TRIPLES) saved = exchange_three(k);
  }
}

bool thr_knot_tie(thr_knot *k, int v, const int *passes, const int *ends)
{
  const thr_frame *f = k->c->f;
  int sum = ends ? ends[v] : 0;
  k->turning = INFINITY;
  for (int i = f->first[v]; i < f->first[v + 1]; i++) {
    sum += passes[f->half[i] >> 1];
    if (passes[f->half[i] >> 1] < 1) return false;
  }
  if (sum / 2 > k->most || thr_tie_need(k->c, v, passes, ends) > 0) return false;
  take_node(k, v, passes, ends ? ends[v] : 0);
  grow_tree(k, v);
  pair_rest(k, v);
  exchange(k);
  k->turning = 0;
  for (int i = 0; i < k->n; i++)
    k->turning += price_of(k, k->pair[i]);
  if (k->turning < forbidden / 2) return true;
  k->turning = INFINITY;
  return false;
}
