/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A given number of closed cords in every component: circuits cut apart at nodes that one visits
 * twice, and joined where two meet.
 *
 * Cutting at a node replaces turns (a b)(c d) by (a d)(c b), and one circuit becomes two; joining
 * is the same exchange the other way round.
 *
 * Example: a figure of eight is one circuit or two, by the exchange at its middle. */
#include "graph/framework/frame.h"
#include "graph/random.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/cords/walk_model.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* All circuits, followed. */
typedef struct {
  thr_join *j;
  thr_threading t;
  const thr_limits *limits;
  int *count;       /* [n_components] circuits */
  int *here, *list; /* [n_darts] scratch */
  uint64_t state;   /* of the random numbers */
} circuits;

static void circuits_destroy(circuits *s)
{
  thr_threading_destroy(&s->t);
  free(s->count);
  free(s->here);
  free(s->list);
}

/* Follows all circuits again, and counts them by components. */
static void follow(circuits *s)
{
  const thr_turning_columns *turning_columns = s->j->c;
  thr_threading_follow(&s->t, s->t.g->n_darts);
  memset(s->count, 0, (size_t)turning_columns->n_components * sizeof *s->count);
  for (int k = 0; k < s->t.n_cords; k++)
    s->count[turning_columns->component[s->t.g->tail[s->t.place[s->t.first[k]].in]]]++;
}

/* Follows the circuits of j, whose pairs change with them. */
static thr_status circuits_init(circuits *s, thr_join *j, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *s = (circuits){.j = j, .limits = limits, .state = 1};
  s->count = thr_calloc((size_t)j->c->n_components, sizeof *s->count);
  s->here = thr_calloc(n, sizeof *s->here);
  s->list = thr_calloc(n, sizeof *s->list);
  thr_status st = thr_join_threading(j, &s->t, err);
  if (!st && !(s->count && s->here && s->list)) st = thr_nomem(err);
  if (!st) follow(s);
  return st;
}

/* Makes an exchange, whose broken pairs go to `old`, and follows the circuits again. */
static void make(circuits *s, const thr_exchange *x, thr_broken *old)
{
  thr_threading_make(&s->t, x, old);
  follow(s);
}

/* Returns the step from one partner to the next, such that all pairs of a few transitions are
 * tried, and about PAIRS of very many. */
static int partner_step(int n)
{
  enum { PAIRS = 20000 };
  return 1 + (int)((int64_t)n * n / 2 / PAIRS);
}

/* Replaces *best by the cheapest allowed exchange at node v that changes the number of circuits by
 * `change`, if this one is cheaper. */
static void consider_node(circuits *s, int v, int change, thr_exchange *best)
{
  int n = thr_threading_places(&s->t, v, s->list), step = partner_step(n);
  for (int i = 0; i < n; i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) {
        thr_exchange x = thr_threading_exchange(&s->t, s->list[i], s->list[k], crossed);
        if (x.change == change && x.extra < best->extra - 1e-12 && thr_threading_allows(&s->t, &x))
          *best = x;
      }
}

/* Returns the cheapest exchange in a component that changes the number of its circuits by `change`,
 * as far as the limits let it look; extra is infinite if there is none. */
static thr_exchange cheapest(circuits *s, int component, int change)
{
  const thr_turning_columns *turning_columns = s->j->c;
  thr_exchange best = {.extra = INFINITY};
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    if (turning_columns->component[v] != component) continue;
    consider_node(s, v, change, &best);
    if (isfinite(best.extra) && thr_limits_stop(s->limits)) break;
  }
  return best;
}

/* Makes an allowed exchange drawn at random in the component, if one is found in a few tries. */
static void exchange_any(circuits *s, int component)
{
  enum { TRIES = 20 };
  for (int k = 0; k < TRIES; k++) {
    int i = (int)(thr_random(&s->state) % (uint64_t)s->t.n_places),
        v = s->t.g->tail[s->t.place[i].in];
    if (s->j->c->component[v] != component) continue;
    int n = thr_threading_places(&s->t, v, s->list);
    assert(n > 0); /* i is one of them */
    int other = s->list[thr_random(&s->state) % (uint64_t)n];
    if (other == i) continue;

    /* The exchange may change the number of circuits, too. */
    thr_exchange x = thr_threading_exchange(&s->t, i, other, thr_random(&s->state) % 2);
    if (!thr_threading_allows(&s->t, &x)) continue;
    make(s, &x, NULL);
    return;
  }
}

/* Exchanges pairs until the component has as many circuits as cords are asked for; says whether
 * that was reached. Where no exchange helps, some are made at random first. Once the limits say
 * stop, gives up if more circuits would have to be joined or cut than cords are asked for. */
static bool reach(circuits *s, int component)
{
  enum { SHAKES = 100 };
  for (int shakes = 0;;) {
    int change = s->j->c->task->cords - s->count[component];
    if (change == 0) return true;
    if (abs(change) > s->j->c->task->cords && thr_limits_stop(s->limits)) return false;
    thr_exchange x = cheapest(s, component, change > 0 ? 1 : -1);
    if (isfinite(x.extra)) {
      make(s, &x, NULL);
      continue;
    }

    /* No circuit can be cut, or none meet: change some pairs. */
    if (shakes++ == SHAKES || thr_limits_stop(s->limits)) return false;
    exchange_any(s, component);
  }
}

/* Tries to save at node v by one exchange that keeps the number of circuits, or by one that changes
 * the number and a second one, anywhere in the component, that restores it. Says whether something
 * was saved. */
static bool improve_at(void *of, int v)
{
  circuits *s = of;
  int component = s->j->c->component[v], n = thr_threading_places(&s->t, v, s->here),
      step = partner_step(n);
  for (int i = 0; i < n && !thr_limits_stop(s->limits); i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) {
        thr_exchange x = thr_threading_exchange(&s->t, s->here[i], s->here[k], crossed);
        thr_broken old = {0};
        if (x.extra >= -enough || !thr_threading_allows(&s->t, &x)) continue;
        make(s, &x, &old);
        if (x.change == 0) return true;

        /* The cheapest exchange that restores the number, given the first one. */
        thr_exchange y = cheapest(s, component, -x.change);
        if (x.extra + y.extra < -enough) {
          make(s, &y, NULL);
          return true;
        }

        /* Both together save nothing. */
        thr_threading_take_back(&s->t, &old);
        follow(s);
      }
  return false;
}

thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found, thr_err *err)
{
  circuits s;
  thr_status st = circuits_init(&s, j, limits, err);
  *found = !st;
  for (int k = 0; k < j->c->n_components && *found; k++)
    *found = reach(&s, k);
  if (*found) thr_threading_descend(&s.t, limits, improve_at, &s);
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

/* Makes an adder with room for n_cords cords. passes[n_edges] counts their passes. */
static thr_status adder_init(adder *s, const thr_turning_columns *turning_columns, int *passes,
                             int n_cords, thr_err *err)
{
  *s = (adder){.c = turning_columns, .n_cords = n_cords, .passes = passes};
  s->cord = thr_calloc((size_t)n_cords, sizeof *s->cord);
  return s->cord ? thr_walk_search_init(&s->walks, turning_columns, err) : thr_nomem(err);
}

/* Returns the price of the walk found last; infinite if the walk needs more passes than allowed. */
static double walk_price(const adder *s)
{
  const thr_turning_task *turning_task = s->c->task;
  const thr_walk_search *walk_search = &s->walks;
  double price = 0;
  if (!thr_walk_search_add(walk_search, s->passes)) return INFINITY;
  for (int i = 0; i < walk_search->n; i++) {
    int h = walk_search->half[i];
    price += thr_turn_price(s->c->f, turning_task->cost, h,
                            walk_search->half[(i + 1) % walk_search->n]) +
             turning_task->price_per_length * s->c->f->length[h >> 1];
    s->passes[h >> 1]--;
  }
  return price;
}

/* Appends the walk found last to the cords; its passes are counted already. */
static thr_status take_walk(adder *s, thr_err *err)
{
  thr_cord *c = &s->cord[s->made];
  const thr_walk_search *walk_search = &s->walks;
  if (!(c->half = thr_calloc((size_t)walk_search->n, sizeof *c->half))) return thr_nomem(err);
  memcpy(c->half, walk_search->half, (size_t)walk_search->n * sizeof *c->half);
  c->n_passes = walk_search->n;
  s->made++;
  return THR_OK;
}

/* Adds the cheapest of the shortest closed walks through the component's edges as a cord. */
static thr_status add_walk(adder *s, int component, const thr_limits *limits, bool *found,
                           thr_err *err)
{
  const thr_frame *frame = s->c->f;
  double least = INFINITY;
  int best = -1;
  for (int h = 0; h < 2 * frame->n_edges; h += 2) {
    if (s->c->component[thr_tail(frame, h)] != component) continue;
    thr_walk_search_closed(&s->walks, h);
    double price = walk_price(s);
    if (price < least - 1e-12) least = price, best = h;
    if (best >= 0 && thr_limits_stop(limits)) break;
  }

  /* The search keeps one walk only: find the cheapest again. */
  *found = best >= 0;
  if (best < 0) return THR_OK;
  thr_walk_search_closed(&s->walks, best);
  *found = thr_walk_search_add(&s->walks, s->passes);
  return *found ? take_walk(s, err) : THR_OK;
}

/* Copies circuit number k as a cord, and counts its passes. */
static thr_status copy_circuit(adder *s, const thr_threading *from, int k, thr_err *err)
{
  const thr_place *place = from->place + from->first[k];
  thr_cord *c = &s->cord[s->made];
  int n = from->first[k + 1] - from->first[k];
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    c->half[i] = from->g->half[place[i].out];
    s->passes[c->half[i] >> 1]++;
  }
  c->n_passes = n;
  s->made++;
  return THR_OK;
}

thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes,
                            bool *found, thr_err *err)
{
  const thr_turning_columns *turning_columns = j->c;
  int cords = turning_columns->task->cords;
  circuits from;
  adder s = {0};
  thr_join same = *j; /* following does not change it */
  *out = (thr_join){0};
  thr_status st = circuits_init(&from, &same, limits, err);
  *found = !st;
  for (int k = 0; k < turning_columns->n_components && !st; k++)
    *found &= from.count[k] <= cords;
  if (*found)
    st = adder_init(&s, turning_columns, passes, cords * turning_columns->n_components, err);
  if (!st && *found) memset(passes, 0, (size_t)turning_columns->f->n_edges * sizeof *passes);
  for (int k = 0; k < from.t.n_cords && !st && *found; k++)
    st = copy_circuit(&s, &from.t, k, err);
  for (int k = 0; k < turning_columns->n_components && !st && *found; k++)
    for (; from.count[k] < cords && !st && *found; from.count[k]++)
      st = add_walk(&s, k, limits, found, err);
  if (!st && *found) st = thr_join_from_cords(out, turning_columns, s.cord, s.n_cords, err);
  circuits_destroy(&from);
  adder_destroy(&s);
  return st;
}

/* Adds a closed walk of fewest edges through each edge that has too few passes yet, beginning with
 * edge number `first`. *found becomes false where a walk has no room. */
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

thr_status thr_circuits_cover(const thr_turning_columns *turning_columns, int first, thr_join *out,
                              int *passes, bool *found, thr_err *err)
{
  adder s;
  int most = 0;
  *out = (thr_join){0};
  *found = true;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    most += turning_columns->cover[e];
  thr_status st = adder_init(&s, turning_columns, passes, most, err);
  if (!st) st = cover_edges(&s, first, found, err);
  if (!st && *found) st = thr_join_from_cords(out, turning_columns, s.cord, s.made, err);
  adder_destroy(&s);
  return st;
}
