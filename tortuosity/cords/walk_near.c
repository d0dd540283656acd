/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords near others: some of them are taken away, and a programme over walks chooses what takes
 * their place. Internal to tortuosity/. */
#include "graph/framework/frame.h"
#include "graph/random.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ANEW = 4, MOST_MISSES = 60 };

typedef struct {
  thr_walk_programme *p;
  thr_cord *cord; /* [p->cords] */
  thr_scratch own;
  double *price; /* [p->cords] */
  int *meets;    /* [p->cords] nodes that a cord has with the dearest one */
  int *order;    /* [p->cords] those that are kept, then those that are dived for */
  bool *seen;    /* [n_nodes] */
  thr_cord *try; /* [p->cords] in that order */
  uint64_t random;
} near;

static double price_of(const near *x, const thr_cord *cord)
{
  return thr_walk_price(x->p->c, x->p->steps.measure, cord);
}

static int dearest(const near *x)
{
  int most = 0;
  for (int i = 1; i < x->p->cords; i++)
    if (x->price[i] > x->price[most]) most = i;
  return most;
}

static void count_meetings(near *x, int with)
{
  const thr_frame *frame = x->p->c->f;
  memset(x->seen, 0, (size_t)frame->n_nodes * sizeof *x->seen);
  for (int k = 0; k < x->cord[with].n_passes; k++)
    x->seen[thr_tail(frame, x->cord[with].half[k])] =
        x->seen[thr_head(frame, x->cord[with].half[k])] = true;
  for (int i = 0; i < x->p->cords; i++) {
    x->meets[i] = 0;
    for (int k = 0; k < x->cord[i].n_passes; k++)
      x->meets[i] += x->seen[thr_head(frame, x->cord[i].half[k])];
  }
}

static void exchange(int *order, int i, int k)
{
  int at_i = order[i];
  order[i] = order[k];
  order[k] = at_i;
}

/* The dearest cord goes to the end of the order, before it anew - 1 others that meet it, drawn as
 * often as they do and as there is room below the dearest. Returns their number with it. */
static int choose(near *x, int anew)
{
  const int n = x->p->cords, most = dearest(x);
  int chosen = 1;
  count_meetings(x, most);
  for (int i = 0; i < n; i++)
    x->order[i] = i;
  exchange(x->order, most, n - 1);
  for (; chosen < anew; chosen++) {
    double sum = 0;
    int pick = -1;
    for (int i = 0; i < n - chosen; i++) {
      const int k = x->order[i];
      const double worth = x->meets[k] * (x->price[most] * 1.02 - x->price[k]);
      sum += worth;
      if (worth > 0 && thr_random_unit(&x->random) * sum < worth) pick = i;
    }
    if (pick < 0) break;
    exchange(x->order, pick, n - 1 - chosen);
  }
  return chosen;
}

/* Units below which the new cords are to stay: between the mean of the old ones and the dearest. */
static int limit_of(const near *x, int anew, double part)
{
  const int n = x->p->cords;
  double sum = 0, most = x->price[x->order[n - 1]];
  for (int i = n - anew; i < n; i++)
    sum += x->price[x->order[i]];
  double limit = sum / anew + part * (most - sum / anew), unit = thr_walk_programme_price(x->p, 1);
  int units = (int)floor(fmin(limit, most * (1 - 1e-3)) / unit);
  return units < x->p->most_units ? units : x->p->most_units;
}

/* Takes the new cords over if the dearest of them costs less than before. */
static void keep_better(near *x, int anew, bool *better)
{
  const int n = x->p->cords;
  double largest = 0;
  for (int i = n - anew; i < n; i++)
    largest = fmax(largest, price_of(x, &x->try[i]));
  *better = largest < x->price[x->order[n - 1]] * (1 - 1e-9);
  for (int i = n - anew; i < n; i++) {
    thr_cord *old = &x->cord[x->order[i]];
    if (*better) {
      const thr_cord before = *old;
      *old = x->try[i];
      x->try[i] = before;
      x->price[x->order[i]] = price_of(x, old);
    }
    free(x->try[i].half);
    x->try[i] = (thr_cord){0};
  }
}

static thr_status look(near *x, int anew, double part, bool draw, bool *better, thr_err *err)
{
  const int n = x->p->cords;
  bool found = false;
  *better = false;
  if ((anew = choose(x, anew)) < 2 && n > 1) return THR_OK;
  for (int i = 0; i < n - anew; i++)
    x->try[i] = x->cord[x->order[i]]; /* borrowed */
  thr_status st = thr_walk_dive(x->p, limit_of(x, anew, part), draw ? &x->random : NULL, n - anew,
                                x->try, &found, err);
  if (!st && found) keep_better(x, anew, better);
  return st;
}

thr_status thr_walk_near(thr_walk_programme *p, double enough, thr_cord *cord, bool *improved,
                         thr_err *err)
{
  static const double part[] = {.5, .8, .2, .95};
  near x = {.p = p, .cord = cord, .random = 1};
  size_t n = (size_t)p->cords;
  x.price = thr_scratch_array(&x.own, n, sizeof *x.price);
  x.meets = thr_scratch_array(&x.own, n, sizeof *x.meets);
  x.order = thr_scratch_array(&x.own, n, sizeof *x.order);
  x.seen = thr_scratch_array(&x.own, (size_t)p->c->f->n_nodes, sizeof *x.seen);
  x.try = thr_scratch_array(&x.own, n, sizeof *x.try);
  *improved = false;
  thr_status st = thr_scratch_check(&x.own, err);
  for (int i = 0; i < p->cords && !st; i++)
    x.price[i] = price_of(&x, &cord[i]);
  for (int misses = 0, i = 0; !st && misses < MOST_MISSES && !thr_limits_stop(p->limits); i++) {
    bool better;
    if (x.price[dearest(&x)] <= enough) break;
    const int most = p->cords < MOST_ANEW ? p->cords : MOST_ANEW;
    st = look(&x, 2 + i % (most - 1), part[i / 3 % 4], i % 2, &better, err);
    misses = better ? 0 : misses + 1;
    *improved |= better;
  }
  thr_scratch_free(&x.own);
  return st;
}
