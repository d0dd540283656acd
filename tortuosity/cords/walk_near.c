/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improves known cords by large neighbourhood search around the most expensive one. Internal to
 * tortuosity/.
 *
 * The most expensive cord of a component and one to three others that share nodes with it are
 * removed, and a dive (walk_dive.c) chooses as many new walks for the edges that these cords
 * passed, below a limit between the mean price of the removed cords and the highest one. The new
 * cords are kept if the most expensive of them costs less. (P. Shaw, "Using constraint programming
 * and local search methods to solve vehicle routing problems", CP 1998.) */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_REMOVED = 4, MOST_MISSES = 60 };

/* The cords, how they meet the most expensive one, and scratch. */
typedef struct {
  thr_walk_programme *programme;
  thr_cord *cord; /* [programme->cords] */
  thr_scratch own;
  double *price; /* [programme->cords] */
  int *meets;    /* [programme->cords] nodes that a cord shares with the most expensive one */
  int *order;    /* [programme->cords] cords that stay, then those that are removed */
  bool *seen;    /* [n_nodes] */
  thr_cord *try; /* [programme->cords] in that order */
  uint64_t random;
} neighbourhood_search;

/* Returns the turning, length or pull of a cord, as the programme measures it. */
static double price_of(const neighbourhood_search *search, const thr_cord *cord)
{
  return thr_walk_price(search->programme->c, search->programme->steps.measure, cord);
}

/* Returns the number of the most expensive cord. */
static int most_expensive(const neighbourhood_search *search)
{
  int most = 0;
  for (int i = 1; i < search->programme->cords; i++)
    if (search->price[i] > search->price[most]) most = i;
  return most;
}

/* Counts for every cord how often it comes to a node of the cord `with`. */
static void count_meetings(neighbourhood_search *search, int with)
{
  const thr_frame *frame = search->programme->c->f;

  /* The nodes of the one cord. */
  memset(search->seen, 0, (size_t)frame->n_nodes * sizeof *search->seen);
  for (int k = 0; k < search->cord[with].n_passes; k++)
    search->seen[thr_tail(frame, search->cord[with].half[k])] =
        search->seen[thr_head(frame, search->cord[with].half[k])] = true;

  /* How often each cord arrives at one of them. */
  for (int i = 0; i < search->programme->cords; i++) {
    search->meets[i] = 0;
    for (int k = 0; k < search->cord[i].n_passes; k++)
      search->meets[i] += search->seen[thr_head(frame, search->cord[i].half[k])];
  }
}

/* Exchanges two entries of the order. */
static void exchange(int *order, int i, int k)
{
  int at_i = order[i];
  order[i] = order[k];
  order[k] = at_i;
}

/* Chooses which cords are removed: the most expensive one goes to the end of the order, and before
 * it come up to `removed` - 1 others, drawn with a probability that grows with the nodes that they
 * share with it and with how much cheaper they are. Returns the number of removed cords. */
static int choose(neighbourhood_search *search, int removed)
{
  const int n = search->programme->cords, most = most_expensive(search);
  int chosen = 1;

  /* The most expensive cord is the first. */
  count_meetings(search, most);
  for (int i = 0; i < n; i++)
    search->order[i] = i;

  exchange(search->order, most, n - 1);
  for (; chosen < removed; chosen++) {
    double sum = 0;
    int pick = -1;

    /* Draw one of the cords that are not chosen yet from a stream of weights. */
    for (int i = 0; i < n - chosen; i++) {
      const int k = search->order[i];
      const double weight = search->meets[k] * (search->price[most] * 1.02 - search->price[k]);
      sum += weight;
      if (weight > 0 && thr_random_unit(&search->random) * sum < weight) pick = i;
    }

    /* No other cord shares a node. */
    if (pick < 0) break;
    exchange(search->order, pick, n - 1 - chosen);
  }
  return chosen;
}

/* Returns the units that the new cords may have: at a given part of the way from the mean price of
 * the removed cords to the highest one, and below the highest. */
static int limit_of(const neighbourhood_search *search, int removed, double part)
{
  const int n = search->programme->cords;
  double sum = 0, most = search->price[search->order[n - 1]];
  for (int i = n - removed; i < n; i++)
    sum += search->price[search->order[i]];

  /* From a price to units, rounded down. */
  double limit = sum / removed + part * (most - sum / removed),
         unit = thr_walk_programme_price(search->programme, 1);

  int units = (int)floor(fmin(limit, most * (1 - 1e-3)) / unit);
  return units < search->programme->most_units ? units : search->programme->most_units;
}

/* Takes the new cords over if the most expensive of them costs less than the most expensive removed
 * one, and frees the cords that are not needed. *better says which. */
static void keep_better(neighbourhood_search *search, int removed, bool *better)
{
  const int n = search->programme->cords;
  double largest = 0;
  for (int i = n - removed; i < n; i++)
    largest = fmax(largest, price_of(search, &search->try[i]));

  /* The most expensive removed cord is the last in the order. */
  *better = largest < search->price[search->order[n - 1]] * (1 - 1e-9);

  /* Old and new cords change places, so that the losers are those in `try`. */
  for (int i = n - removed; i < n; i++) {
    thr_cord *old = &search->cord[search->order[i]];
    if (*better) {
      const thr_cord before = *old;
      *old = search->try[i];
      search->try[i] = before;
      search->price[search->order[i]] = price_of(search, old);
    }
    free(search->try[i].half);
    search->try[i] = (thr_cord){0};
  }
}

/* Removes and replaces cords once. part: as for limit_of. draw: the dive draws its columns at
 * random. *better: the new cords were kept. */
static thr_status look(neighbourhood_search *search, int removed, double part, bool draw,
                       bool *better, thr_err *err)
{
  const int n = search->programme->cords;
  bool found = false;
  *better = false;
  if ((removed = choose(search, removed)) < 2 && n > 1) return THR_OK;

  /* The dive finds the cords that stay at the front. */
  for (int i = 0; i < n - removed; i++)
    search->try[i] = search->cord[search->order[i]]; /* borrowed */
  thr_status st =
      thr_walk_dive(search->programme, limit_of(search, removed, part),
                    draw ? &search->random : NULL, n - removed, search->try, &found, err);
  if (!st && found) keep_better(search, removed, better);
  return st;
}

/* Numbers of removed cords, limits and draws take turns; MOST_MISSES attempts in a row without gain
 * end the search. */
thr_status thr_walk_near(thr_walk_programme *programme, double enough, thr_cord *cord,
                         bool *improved, thr_err *err)
{
  static const double part[] = {.5, .8, .2, .95};
  neighbourhood_search search = {.programme = programme, .cord = cord, .random = 1};
  size_t n = (size_t)programme->cords;
  search.price = thr_scratch_array(&search.own, n, sizeof *search.price);
  search.meets = thr_scratch_array(&search.own, n, sizeof *search.meets);
  search.order = thr_scratch_array(&search.own, n, sizeof *search.order);
  search.seen =
      thr_scratch_array(&search.own, (size_t)programme->c->f->n_nodes, sizeof *search.seen);
  search.try = thr_scratch_array(&search.own, n, sizeof *search.try);
  *improved = false;

  /* Prices of all cords. */
  thr_status st = thr_scratch_check(&search.own, err);

  for (int i = 0; i < programme->cords && !st; i++)
    search.price[i] = price_of(&search, &cord[i]);

  /* Replace cords until the price is low enough or nothing helps. */
  for (int misses = 0, i = 0; !st && misses < MOST_MISSES && !thr_limits_stop(programme->limits);
       i++) {
    bool better;
    if (search.price[most_expensive(&search)] <= enough) break;
    const int most = programme->cords < MOST_REMOVED ? programme->cords : MOST_REMOVED;
    st = look(&search, 2 + i % (most - 1), part[i / 3 % 4], i % 2, &better, err);
    misses = better ? 0 : misses + 1;
    *improved |= better;
  }
  thr_scratch_free(&search.own);
  return st;
}
