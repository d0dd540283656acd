/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a given number of closed cords in every component: cuts circuits at nodes that one of them
 * visits twice, and joins circuits at nodes where two meet.
 *
 * Cutting at a node replaces turns (a b)(c d) by (a d)(c b), and one circuit becomes two; joining
 * is the same exchange the other way round. Each step takes the cheapest such exchange; once the
 * number is right, a descent exchanges pairs, or twice two pairs, that keep the number and save.
 * Where the passes hold too few circuits, further cords get passes of their own: shortest closed
 * walks through an edge.
 *
 * Example: a figure of eight is one circuit or two, by the exchange at its middle. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/cords/walk_model.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* A multigraph whose pairs are exchanged, and its circuits, followed. */
typedef struct {
  thr_join *join;
  thr_threading threading;
  const thr_limits *limits;
  int *count;       /* [n_components] circuits */
  int *here, *list; /* [n_darts] scratch */
  uint64_t random;  /* state of the random numbers */
} circuits;

static void circuits_destroy(circuits *search)
{
  thr_threading_destroy(&search->threading);
  free(search->count);
  free(search->here);
  free(search->list);
}

/* Follows all circuits again, and counts them by components. */
static void follow(circuits *search)
{
  const thr_turning_columns *turning_columns = search->join->c;

  thr_threading_follow(&search->threading, search->threading.g->n_darts);
  memset(search->count, 0, (size_t)turning_columns->n_components * sizeof *search->count);
  for (int k = 0; k < search->threading.n_cords; k++) {
    const int start = search->threading.place[search->threading.first[k]].in;
    search->count[turning_columns->component[search->threading.g->tail[start]]]++;
  }
}

/* Follows the circuits of j, whose pairs change with them. */
static thr_status circuits_init(circuits *search, thr_join *j, const thr_limits *limits,
                                thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *search = (circuits){.join = j, .limits = limits, .random = 1};

  search->count = thr_calloc((size_t)j->c->n_components, sizeof *search->count);
  search->here = thr_calloc(n, sizeof *search->here);
  search->list = thr_calloc(n, sizeof *search->list);
  thr_status st = thr_join_threading(j, &search->threading, err);
  if (!st && !(search->count && search->here && search->list)) st = thr_nomem(err);

  if (!st) follow(search);
  return st;
}

/* Makes an exchange, whose broken pairs go to `old`, and follows the circuits again. */
static void make(circuits *search, const thr_exchange *exchange, thr_broken *old)
{
  thr_threading_make(&search->threading, exchange, old);
  follow(search);
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
static void consider_node(circuits *search, int v, int change, thr_exchange *best)
{
  int n = thr_threading_places(&search->threading, v, search->list), step = partner_step(n);

  for (int i = 0; i < n; i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) { /* (a b)(c d) has two other pairings */
        thr_exchange exchange =
            thr_threading_exchange(&search->threading, search->list[i], search->list[k], crossed);
        if (exchange.change == change && exchange.extra < best->extra - 1e-12 &&
            thr_threading_allows(&search->threading, &exchange))
          *best = exchange;
      }
}

/* Returns the cheapest exchange in a component that changes the number of its circuits by `change`,
 * as far as the limits let it look; extra is infinite if there is none. */
static thr_exchange cheapest(circuits *search, int component, int change)
{
  const thr_turning_columns *turning_columns = search->join->c;
  thr_exchange best = {.extra = INFINITY};

  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    if (turning_columns->component[v] != component) continue;
    consider_node(search, v, change, &best);

    /* Stopped: whatever was found is good enough. */
    if (isfinite(best.extra) && thr_limits_stop(search->limits)) break;
  }
  return best;
}

/* Makes an allowed exchange drawn at random in the component, if one is found in a few tries. */
static void exchange_any(circuits *search, int component)
{
  enum { TRIES = 20 };
  for (int k = 0; k < TRIES; k++) {
    int i = (int)(thr_random(&search->random) % (uint64_t)search->threading.n_places),
        v = search->threading.g->tail[search->threading.place[i].in];
    if (search->join->c->component[v] != component) continue;

    /* Another place of the same node. */
    int n = thr_threading_places(&search->threading, v, search->list);
    assert(n > 0); /* i is one of them */
    int other = search->list[thr_random(&search->random) % (uint64_t)n];
    if (other == i) continue;

    /* The exchange may change the number of circuits, too. */
    thr_exchange exchange =
        thr_threading_exchange(&search->threading, i, other, thr_random(&search->random) % 2);
    if (!thr_threading_allows(&search->threading, &exchange)) continue;
    make(search, &exchange, NULL);
    return;
  }
}

/* Exchanges pairs until the component has as many circuits as cords are asked for; says whether
 * that was reached. Where no exchange helps, some are made at random first. Once the limits say
 * stop, gives up if more circuits would have to be joined or cut than cords are asked for. */
static bool reach(circuits *search, int component)
{
  enum { SHAKES = 100 };
  for (int shakes = 0;;) {
    int change = search->join->c->task->cords - search->count[component];
    if (change == 0) return true;
    if (abs(change) > search->join->c->task->cords && thr_limits_stop(search->limits)) return false;

    /* Cut one circuit, or join two. */
    thr_exchange exchange = cheapest(search, component, change > 0 ? 1 : -1);
    if (isfinite(exchange.extra)) {
      make(search, &exchange, NULL);
      continue;
    }

    /* No circuit can be cut, or none meet: change some pairs. */
    if (shakes++ == SHAKES || thr_limits_stop(search->limits)) return false;
    exchange_any(search, component);
  }
}

/* Tries to save at node v by one exchange that keeps the number of circuits, or by one that changes
 * the number and a second one, anywhere in the component, that restores it. Says whether something
 * was saved. */
static bool improve_at(void *of, int v)
{
  circuits *search = of;
  int component = search->join->c->component[v],
      n = thr_threading_places(&search->threading, v, search->here), step = partner_step(n);
  for (int i = 0; i < n && !thr_limits_stop(search->limits); i++)
    for (int k = i + 1; k < n; k += step)
      for (int crossed = 0; crossed < 2; crossed++) {
        thr_exchange exchange =
            thr_threading_exchange(&search->threading, search->here[i], search->here[k], crossed);
        thr_broken old = {0};

        /* The first exchange has to save by itself. */
        if (exchange.extra >= -enough || !thr_threading_allows(&search->threading, &exchange))
          continue;
        make(search, &exchange, &old);
        if (exchange.change == 0) return true;

        /* The cheapest exchange that restores the number, given the first one. */
        thr_exchange second = cheapest(search, component, -exchange.change);
        if (exchange.extra + second.extra < -enough) {
          make(search, &second, NULL);
          return true;
        }

        /* Both together save nothing. */
        thr_threading_take_back(&search->threading, &old);
        follow(search);
      }
  return false;
}

thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found, thr_err *err)
{
  circuits search;
  thr_status st = circuits_init(&search, j, limits, err);
  *found = !st;

  /* First the number of circuits, then their price. */
  for (int k = 0; k < j->c->n_components && *found; k++)
    *found = reach(&search, k);
  if (*found) thr_threading_descend(&search.threading, limits, improve_at, &search);

  if (!st) thr_join_measure(j);
  circuits_destroy(&search);
  return st;
}

/* ---- further cords ---- */

/* Closed cords that are collected one after the other, with the passes of all of them. */
typedef struct {
  const thr_turning_columns *columns;
  thr_cord *cord;    /* [n_cords] owned */
  int n_cords, made; /* room for cords; cords so far */
  int *passes;       /* [n_edges] borrowed */
  thr_walk_search walks;
} adder;

static void adder_destroy(adder *adding)
{
  thr_cords_destroy(adding->cord, adding->n_cords);
  thr_walk_search_destroy(&adding->walks);
}

/* Makes an adder with room for n_cords cords. passes[n_edges] counts their passes. */
static thr_status adder_init(adder *adding, const thr_turning_columns *turning_columns, int *passes,
                             int n_cords, thr_err *err)
{
  *adding = (adder){.columns = turning_columns, .n_cords = n_cords, .passes = passes};
  adding->cord = thr_calloc((size_t)n_cords, sizeof *adding->cord);
  return adding->cord ? thr_walk_search_init(&adding->walks, turning_columns, err) : thr_nomem(err);
}

/* Returns the price of the walk found last; infinite if the walk needs more passes than allowed. */
static double walk_price(const adder *adding)
{
  const thr_turning_task *turning_task = adding->columns->task;
  const thr_walk_search *walk_search = &adding->walks;
  double price = 0;
  if (!thr_walk_search_add(walk_search, adding->passes)) return INFINITY;

  /* Turns and passes; the passes are taken off again. */
  for (int i = 0; i < walk_search->n; i++) {
    int h = walk_search->half[i];
    price += thr_turn_price(adding->columns->f, turning_task->cost, h,
                            walk_search->half[(i + 1) % walk_search->n]) +
             turning_task->price_per_length * adding->columns->f->length[h >> 1];
    adding->passes[h >> 1]--;
  }
  return price;
}

/* Appends the walk found last to the cords; its passes are counted already. */
static thr_status take_walk(adder *adding, thr_err *err)
{
  thr_cord *cord = &adding->cord[adding->made];
  const thr_walk_search *walk_search = &adding->walks;
  if (!(cord->half = thr_calloc((size_t)walk_search->n, sizeof *cord->half))) return thr_nomem(err);
  memcpy(cord->half, walk_search->half, (size_t)walk_search->n * sizeof *cord->half);
  cord->n_passes = walk_search->n;
  adding->made++;
  return THR_OK;
}

/* Adds the cheapest of the shortest closed walks through the component's edges as a cord. */
static thr_status add_walk(adder *adding, int component, const thr_limits *limits, bool *found,
                           thr_err *err)
{
  const thr_frame *frame = adding->columns->f;
  double least = INFINITY;
  int best = -1;

  /* One walk for each edge. */
  for (int h = 0; h < 2 * frame->n_edges; h += 2) {
    if (adding->columns->component[thr_tail(frame, h)] != component) continue;
    thr_walk_search_closed(&adding->walks, h);
    double price = walk_price(adding);
    if (price < least - 1e-12) least = price, best = h;
    if (best >= 0 && thr_limits_stop(limits)) break;
  }

  /* The search keeps one walk only: find the cheapest again. */
  *found = best >= 0;
  if (best < 0) return THR_OK;
  thr_walk_search_closed(&adding->walks, best);
  *found = thr_walk_search_add(&adding->walks, adding->passes);
  return *found ? take_walk(adding, err) : THR_OK;
}

/* Copies circuit number k as a cord, and counts its passes. */
static thr_status copy_circuit(adder *adding, const thr_threading *from, int k, thr_err *err)
{
  const thr_place *place = from->place + from->first[k];
  thr_cord *cord = &adding->cord[adding->made];
  int n = from->first[k + 1] - from->first[k];
  if (!(cord->half = thr_calloc((size_t)n, sizeof *cord->half))) return thr_nomem(err);

  /* The half-edge that leaves each place. */
  for (int i = 0; i < n; i++) {
    cord->half[i] = from->g->half[place[i].out];
    adding->passes[cord->half[i] >> 1]++;
  }
  cord->n_passes = n;
  adding->made++;
  return THR_OK;
}

thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes,
                            bool *found, thr_err *err)
{
  const thr_turning_columns *turning_columns = j->c;
  int cords = turning_columns->task->cords;
  circuits from;
  adder adding = {0};
  thr_join same = *j; /* following does not change it */
  *out = (thr_join){0};

  /* No component may have more circuits than cords. */
  thr_status st = circuits_init(&from, &same, limits, err);
  *found = !st;
  for (int k = 0; k < turning_columns->n_components && !st; k++)
    *found &= from.count[k] <= cords;

  /* The circuits that there are, then walks until each component has enough. */
  if (*found)
    st = adder_init(&adding, turning_columns, passes, cords * turning_columns->n_components, err);
  if (!st && *found) memset(passes, 0, (size_t)turning_columns->f->n_edges * sizeof *passes);
  for (int k = 0; k < from.threading.n_cords && !st && *found; k++)
    st = copy_circuit(&adding, &from.threading, k, err);
  for (int k = 0; k < turning_columns->n_components && !st && *found; k++)
    for (; from.count[k] < cords && !st && *found; from.count[k]++)
      st = add_walk(&adding, k, limits, found, err);

  if (!st && *found)
    st = thr_join_from_cords(out, turning_columns, adding.cord, adding.n_cords, err);

  circuits_destroy(&from);
  adder_destroy(&adding);
  return st;
}

/* Adds a closed walk of fewest edges through each edge that has too few passes yet, beginning with
 * edge number `first`. *found becomes false where a walk has no room. */
static thr_status cover_edges(adder *adding, int first, bool *found, thr_err *err)
{
  const int m = adding->columns->f->n_edges, *cover = adding->columns->cover;
  memset(adding->passes, 0, (size_t)m * sizeof *adding->passes);

  for (int i = 0; i < m; i++)
    while (adding->passes[(first + i) % m] < cover[(first + i) % m]) {
      thr_walk_search_closed(&adding->walks, 2 * ((first + i) % m));

      /* The walk's passes count for all edges that it passes. */
      if (!(*found = thr_walk_search_add(&adding->walks, adding->passes))) return THR_OK;
      thr_status st = take_walk(adding, err);
      if (st) return st;
    }
  return THR_OK;
}

thr_status thr_circuits_cover(const thr_turning_columns *turning_columns, int first, thr_join *out,
                              int *passes, bool *found, thr_err *err)
{
  adder adding;
  int most = 0;
  *out = (thr_join){0};
  *found = true;

  /* Each walk gives some edge a pass that it needs, which bounds the number of walks. */
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    most += turning_columns->cover[e];
  thr_status st = adder_init(&adding, turning_columns, passes, most, err);
  if (!st) st = cover_edges(&adding, first, found, err);
  if (!st && *found) st = thr_join_from_cords(out, turning_columns, adding.cord, adding.made, err);
  adder_destroy(&adding);
  return st;
}
