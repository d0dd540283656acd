/* Exchanges between and within the circuits of closed cords. */
#include "tortuosity/cords/circuits.h"
#include "graph/random.h"
#include "tortuosity/cords/walk_search.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* All circuits as transitions: number i arrives by in[i] and leaves by out[i] (both darts leave its node). */
typedef struct {
  thr_join *j;
  const thr_limits *limits;
  int n;
  int *in, *out, *circuit; /* [n_darts / 2] */
  int *at;                 /* [n_darts] transition that the dart is part of */
  int *count;              /* [n_components] circuits */
  int *here, *list;        /* [n_darts] scratch */
  int *parent;             /* [n_edges] scratch */
  int *node, *first;       /* nodes by component: node[first[k]] .. node[first[k + 1] - 1] */
  uint64_t state;          /* of the random numbers */
} circuits;

/* Two transitions of one node and how to pair their darts anew. */
typedef struct {
  double extra; /* what that costs more */
  int change;   /* circuits more */
  int made[4];  /* pairs to make: made[0] with made[1], made[2] with made[3] */
  int old[4];   /* pairs before, in the same way */
} exchange;

static void circuits_destroy(circuits *s)
{
  free(s->in);
  free(s->out);
  free(s->circuit);
  free(s->at);
  free(s->count);
  free(s->here);
  free(s->list);
  free(s->parent);
  free(s->node);
  free(s->first);
}

static void sort_nodes(circuits *s)
{
  const thr_turning_columns *c = s->j->c;
  for (int v = 0; v < c->f->n_nodes; v++)
    s->first[c->component[v] + 2]++;
  for (int k = 1; k <= c->n_components; k++)
    s->first[k + 1] += s->first[k];
  for (int v = 0; v < c->f->n_nodes; v++)
    s->node[s->first[c->component[v] + 1]++] = v;
}

static thr_status circuits_init(circuits *s, thr_join *j, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *s = (circuits){.j = j, .limits = limits, .state = 1};
  s->in = thr_calloc(n / 2, sizeof *s->in);
  s->out = thr_calloc(n / 2, sizeof *s->out);
  s->circuit = thr_calloc(n / 2, sizeof *s->circuit);
  s->at = thr_calloc(n, sizeof *s->at);
  s->count = thr_calloc((size_t)j->c->n_components, sizeof *s->count);
  s->here = thr_calloc(n, sizeof *s->here);
  s->list = thr_calloc(n, sizeof *s->list);
  s->parent = thr_calloc((size_t)j->c->f->n_edges, sizeof *s->parent);
  s->node = thr_calloc((size_t)j->c->f->n_nodes, sizeof *s->node);
  s->first = thr_calloc((size_t)j->c->n_components + 2, sizeof *s->first);
  bool all = s->in && s->out && s->circuit && s->at && s->count && s->here && s->list && s->parent && s->node && s->first;
  if (!all) return thr_nomem(err);
  sort_nodes(s);
  return THR_OK;
}

/* Walks all circuits. The same pairs give the same numbers. */
static void follow(circuits *s)
{
  const thr_multigraph *g = &s->j->g;
  int circuit = 0;
  s->n = 0;
  for (int d = 0; d < g->n_darts; d++)
    s->at[d] = -1;
  memset(s->count, 0, (size_t)s->j->c->n_components * sizeof *s->count);
  for (int start = 0; start < g->n_darts; start++) {
    if (s->at[start] >= 0) continue;
    for (int d = start; s->at[d ^ 1] < 0; d = s->j->mate[d ^ 1]) {
      s->in[s->n] = d ^ 1;
      s->out[s->n] = s->j->mate[d ^ 1];
      s->circuit[s->n] = circuit;
      s->at[s->in[s->n]] = s->at[s->out[s->n]] = s->n;
      s->n++;
    }
    s->count[s->j->c->component[g->tail[start]]]++;
    circuit++;
  }
}

/* The transitions at node v, each once. */
static int transitions_at(const circuits *s, int v, int *list)
{
  const thr_multigraph *g = &s->j->g;
  int n = 0;
  for (int k = g->first[v]; k < g->first[v + 1]; k++)
    if (s->in[s->at[g->dart[k]]] == g->dart[k]) list[n++] = s->at[g->dart[k]];
  return n;
}

/* Either of the two ways to pair the darts of two transitions anew. crossed: arriving with arriving, which runs a part of one
 * circuit the other way round; not crossed cuts one circuit in two. Two circuits become one either way. */
static exchange exchange_of(const circuits *s, int i, int k, bool crossed)
{
  int a = s->in[i], b = crossed ? s->in[k] : s->out[k], c = s->out[i], d = crossed ? s->out[k] : s->in[k];
  double old = thr_join_price(s->j, s->in[i], s->out[i]) + thr_join_price(s->j, s->in[k], s->out[k]);
  int change = s->circuit[i] != s->circuit[k] ? -1 : crossed ? 0 : 1;
  double now = thr_join_price(s->j, a, b) + thr_join_price(s->j, c, d);
  return (exchange){now - old, change, {a, b, c, d}, {s->in[i], s->out[i], s->in[k], s->out[k]}};
}

static void set_pairs(const circuits *s, const int *pair)
{
  for (int i = 0; i < 4; i++)
    s->j->mate[pair[i]] = pair[i ^ 1];
}

static void make(circuits *s, const int *pair)
{
  set_pairs(s, pair);
  follow(s);
}

/* Is it one that may be made: with tube joints, does its node stay tied? */
static bool allowed(const circuits *s, const exchange *x)
{
  if (x->extra >= thr_join_forbidden / 2) return false;
  if (!s->j->c->task->tube) return true;
  set_pairs(s, x->made);
  bool tied = thr_join_tied(s->j, s->j->g.tail[x->made[0]], s->parent);
  set_pairs(s, x->old);
  return tied;
}

/* Of n transitions, the step from one partner to the next: all pairs of a few, about PAIRS of very many. */
static int partner_step(int n)
{
  enum { PAIRS = 20000 };
  return 1 + (int)((int64_t)n * n / 2 / PAIRS);
}

/* The better of best and what changes the number of circuits so at node v. */
static void consider_node(const circuits *s, int v, int change, exchange *best)
{
  int n = transitions_at(s, v, s->list), step = partner_step(n);
  for (int i = 0; i < n; i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) {
        exchange x = exchange_of(s, s->list[i], s->list[k], crossed);
        if (x.change == change && x.extra < best->extra - 1e-12 && allowed(s, &x)) *best = x;
      }
}

/* The cheapest exchange in a component that changes the number of its circuits so, as far as the limits let it look; extra is
 * infinite if there is none. */
static exchange cheapest(const circuits *s, int component, int change)
{
  exchange best = {.extra = INFINITY};
  for (int i = s->first[component]; i < s->first[component + 1]; i++) {
    consider_node(s, s->node[i], change, &best);
    if (isfinite(best.extra) && thr_limits_stop(s->limits)) break;
  }
  return best;
}

/* An allowed exchange anywhere in the component. */
static void exchange_any(circuits *s, int component)
{
  enum { TRIES = 20 };
  for (int k = 0; k < TRIES; k++) {
    int i = (int)(thr_random(&s->state) % (uint64_t)s->n), v = s->j->g.tail[s->in[i]];
    if (s->j->c->component[v] != component) continue;
    int n = transitions_at(s, v, s->list);
    assert(n > 0); /* i is one of them */
    int other = s->list[thr_random(&s->state) % (uint64_t)n];
    if (other == i) continue;
    exchange x = exchange_of(s, i, other, thr_random(&s->state) % 2);
    if (!allowed(s, &x)) continue;
    make(s, x.made);
    return;
  }
}

/* Until the component has so many circuits. Stopped, no more are joined or split than cords were asked for. */
static bool reach(circuits *s, int component)
{
  enum { SHAKES = 100 };
  for (int shakes = 0;;) {
    int change = s->j->c->task->cords - s->count[component];
    if (change == 0) return true;
    if (abs(change) > s->j->c->task->cords && thr_limits_stop(s->limits)) return false;
    exchange x = cheapest(s, component, change > 0 ? 1 : -1);
    if (isfinite(x.extra)) {
      make(s, x.made);
      continue;
    }
    if (shakes++ == SHAKES || thr_limits_stop(s->limits)) return false;
    exchange_any(s, component);
  }
}

/* One exchange at node v that saves and keeps the number, or one that saves with one anywhere that puts the number right. */
static bool improve_at(circuits *s, int v)
{
  int component = s->j->c->component[v], n = transitions_at(s, v, s->here), step = partner_step(n);
  for (int i = 0; i < n && !thr_limits_stop(s->limits); i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) {
        exchange x = exchange_of(s, s->here[i], s->here[k], crossed);
        if (x.extra >= -enough || !allowed(s, &x)) continue;
        make(s, x.made);
        if (x.change == 0) return true;
        exchange y = cheapest(s, component, -x.change);
        if (x.extra + y.extra < -enough) {
          make(s, y.made);
          return true;
        }
        make(s, x.old);
      }
  return false;
}

static void improve(circuits *s)
{
  const thr_frame *f = s->j->c->f;
  for (bool changed = true; changed && !thr_limits_stop(s->limits);) {
    changed = false;
    for (int v = 0; v < f->n_nodes; v++)
      while (!thr_limits_stop(s->limits) && improve_at(s, v))
        changed = true;
  }
}

thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found, thr_err *err)
{
  circuits s;
  thr_status st = circuits_init(&s, j, limits, err);
  *found = !st;
  if (!st) follow(&s);
  for (int k = 0; k < j->c->n_components && *found; k++)
    *found = reach(&s, k);
  if (*found) improve(&s);
  if (!st) thr_join_measure(j);
  circuits_destroy(&s);
  return st;
}

/* ---- further cords ---- */

typedef struct {
  const thr_turning_columns *c;
  thr_cord *cord; /* [n_cords] owned */
  int n_cords, made;
  int *passes;
  thr_walk_search walks;
} adder;

static void adder_destroy(adder *s)
{
  thr_cords_destroy(s->cord, s->n_cords);
  thr_walk_search_destroy(&s->walks);
}

static thr_status adder_init(adder *s, const thr_turning_columns *c, int *passes, int n_cords, thr_err *err)
{
  *s = (adder){.c = c, .n_cords = n_cords, .passes = passes};
  s->cord = thr_calloc((size_t)n_cords, sizeof *s->cord);
  return s->cord ? thr_walk_search_init(&s->walks, c, err) : thr_nomem(err);
}

/* Price of the walk found last; infinite if it needs more passes than allowed. */
static double walk_price(const adder *s)
{
  const thr_turning_task *t = s->c->task;
  const thr_walk_search *w = &s->walks;
  double price = 0;
  if (!thr_walk_search_add(w, s->passes)) return INFINITY;
  for (int i = 0; i < w->n; i++) {
    int h = w->half[i];
    price += thr_turn_price(s->c->f, t->cost, h, w->half[(i + 1) % w->n]) + t->price_per_length * s->c->f->length[h >> 1];
    s->passes[h >> 1]--;
  }
  return price;
}

/* The walk found last as a cord; its passes are counted already. */
static thr_status take_walk(adder *s, thr_err *err)
{
  thr_cord *c = &s->cord[s->made];
  const thr_walk_search *w = &s->walks;
  if (!(c->half = thr_calloc((size_t)w->n, sizeof *c->half))) return thr_nomem(err);
  memcpy(c->half, w->half, (size_t)w->n * sizeof *c->half);
  c->n_passes = w->n;
  s->made++;
  return THR_OK;
}

/* One more closed cord in the component. */
static thr_status add_walk(adder *s, int component, const thr_limits *limits, bool *found, thr_err *err)
{
  const thr_frame *f = s->c->f;
  double least = INFINITY;
  int best = -1;
  for (int h = 0; h < 2 * f->n_edges; h += 2) {
    if (s->c->component[thr_tail(f, h)] != component) continue;
    thr_walk_search_closed(&s->walks, h);
    double price = walk_price(s);
    if (price < least - 1e-12) least = price, best = h;
    if (best >= 0 && thr_limits_stop(limits)) break;
  }
  *found = best >= 0;
  if (best < 0) return THR_OK;
  thr_walk_search_closed(&s->walks, best);
  *found = thr_walk_search_add(&s->walks, s->passes);
  return *found ? take_walk(s, err) : THR_OK;
}

/* The circuit through the transitions from first on. */
static thr_status copy_circuit(adder *s, const circuits *from, int first, int n, thr_err *err)
{
  thr_cord *c = &s->cord[s->made];
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    c->half[i] = from->j->g.half[from->out[first + i]];
    s->passes[c->half[i] >> 1]++;
  }
  c->n_passes = n;
  s->made++;
  return THR_OK;
}

static thr_status copy_circuits(adder *s, const circuits *from, thr_err *err)
{
  thr_status st = THR_OK;
  memset(s->passes, 0, (size_t)s->c->f->n_edges * sizeof *s->passes);
  for (int first = 0, next; first < from->n && !st; first = next) {
    for (next = first; next < from->n && from->circuit[next] == from->circuit[first];)
      next++;
    st = copy_circuit(s, from, first, next - first, err);
  }
  return st;
}

thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes, bool *found, thr_err *err)
{
  const thr_turning_columns *c = j->c;
  int cords = c->task->cords;
  circuits from;
  adder s = {0};
  thr_join same = *j; /* follow() does not change it */
  *out = (thr_join){0};
  thr_status st = circuits_init(&from, &same, limits, err);
  if (!st) follow(&from);
  *found = !st;
  for (int k = 0; k < c->n_components && !st; k++)
    *found &= from.count[k] <= cords;
  if (*found) st = adder_init(&s, c, passes, cords * c->n_components, err);
  if (!st && *found) st = copy_circuits(&s, &from, err);
  for (int k = 0; k < c->n_components && !st && *found; k++)
    for (; from.count[k] < cords && !st && *found; from.count[k]++)
      st = add_walk(&s, k, limits, found, err);
  if (!st && *found) st = thr_join_from_cords(out, c, s.cord, s.n_cords, err);
  circuits_destroy(&from);
  adder_destroy(&s);
  return st;
}

/* A closed walk through each edge that too few go over yet, beginning with number first. Stops where one has no room. */
static thr_status cover_edges(adder *s, int first, bool *found, thr_err *err)
{
  const int m = s->c->f->n_edges, *cover = s->c->cover;
  memset(s->passes, 0, (size_t)m * sizeof *s->passes);
  for (int i = 0; i < m; i++)
    while (s->passes[(first + i) % m] < cover[(first + i) % m]) {
      thr_walk_search_closed(&s->walks, 2 * ((first + i) % m));
      if (!(*found = thr_walk_search_add(&s->walks, s->passes))) return THR_OK;
      thr_status st = take_walk(s, err);
      if (st) return st;
    }
  return THR_OK;
}

thr_status thr_circuits_cover(const thr_turning_columns *c, int first, thr_join *out, int *passes, bool *found, thr_err *err)
{
  adder s;
  int most = 0;
  *out = (thr_join){0};
  *found = true;
  for (int e = 0; e < c->f->n_edges; e++)
    most += c->cover[e];
  thr_status st = adder_init(&s, c, passes, most, err);
  if (!st) st = cover_edges(&s, first, found, err);
  if (!st && *found) st = thr_join_from_cords(out, c, s.cord, s.made, err);
  adder_destroy(&s);
  return st;
}
