/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns and extra passes changed together by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M.
 * P. Vecchi 1983), for the least turning of single cords.
 *
 * Passes over one edge are alike, so the counts of turns, extra passes and ends
 * (graph/plan/turning_proof.h) are all there is to change; they are cords if their turns join all
 * edges of a component. Two kinds of change keep the equations of all half-edges:
 * - at one node, turns (a b)(c d) become (a c)(b d);
 * - along a short cycle every edge gets an extra pass, or loses one that it has. At each of its
 * nodes the new passes turn into one another, or into a turn that was there, (a b) becoming (a p)(q
 * b); lost ones leave their partners to each other. Parts that are apart are allowed for a time, at
 * a price each that rises and falls until a fifth of the points hang together.
 *
 * Example: three rings of a sphere cross at 60 degrees. Exchanges join two of them by two turns of
 * 60 degrees; an extra pass that leaves one ring's line for another's joins them by one. */
#include "graph/angle.h"
#include "graph/framework/frame.h"
#include "graph/random.h"
#include "tortuosity/cords/anneal_turns.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In rad, of turns that cost their angle: temperatures, and what a part that is apart costs. On
 * spheres hotter ones took longer to the same turning, and long runs were no better than short ones
 * begun again, less hot, from what they found. */
static const double hottest = 0.25, warm = 0.13, cold = 0.03, apart_first = 1.3, apart_least = 0.3,
                    apart_most = 6;
static const double whole_share = 0.2; /* of the points that are to hang together */

typedef struct {
  thr_turn_state s;
  const thr_short_cycles *cycles;
  uint64_t random;
  double unit, hot, heat,
      price_apart; /* price of 1 rad; temperatures, first and now; price of a part */
  int apart;       /* parts above one in every component */
  double value, best_value;
  int *best; /* [n_columns] */
  int64_t steps,
      whole; /* since the price was changed last; of these without parts that are apart */
} annealer;

bool thr_anneal_turns_serves(const thr_turning_columns *c)
{
  const thr_turning_task *task = c->task;
  return !task->tube && !task->free_turns && task->cords == 1 && !task->end_count &&
         thr_frame_largest_degree(c->f) <= THR_TURN_DEGREE;
}

/* ---- at one node ---- */

/* A partner of half-edge a, each that it has with the same probability; -1: an end; -2: none. */
static int random_partner(annealer *an, int a)
{
  const thr_turning_columns *c = an->s.c;
  const int *half = c->f->half + c->f->first[thr_tail(c->f, a)], end = c->end_column[a];
  int found = -2, n = 0;
  for (uint64_t left = an->s.partners[a]; left; left &= left - 1)
    if (thr_random_below(&an->random, ++n) == 0) found = half[__builtin_ctzll(left)];
  return end >= 0 && an->s.x[end] > 0 && thr_random_below(&an->random, ++n) == 0 ? -1 : found;
}

/* (a b)(c d) become (a c)(b d); false: there is no such exchange. */
static bool exchange(annealer *an)
{
  const thr_frame *f = an->s.c->f;
  const int v = thr_random_below(&an->random, f->n_nodes), degree = thr_degree(f, v);
  if (degree < 3) return false;
  const int a = f->half[f->first[v] + thr_random_below(&an->random, degree)];
  const int c = f->half[f->first[v] + thr_random_below(&an->random, degree)];
  const int b = random_partner(an, a), d = random_partner(an, c);
  if (a == c || b == d || b == c || a == d || b == -2 || d == -2) return false;
  thr_turn_state_change(&an->s, thr_turn_state_column(&an->s, a, b), -1);
  thr_turn_state_change(&an->s, thr_turn_state_column(&an->s, c, d), -1);
  thr_turn_state_change(&an->s, thr_turn_state_column(&an->s, a, c), 1);
  thr_turn_state_change(&an->s, thr_turn_state_column(&an->s, b, d), 1);
  return true;
}

/* ---- along a cycle ---- */

/* One of the ways to change a node's turns: columns that lose and get a turn, -1 = none. */
typedef struct {
  int less[2], more[2];
  double value; /* the least is taken: what it costs, less a random amount at this temperature
                   (Gumbel's), which draws each with the probability of Boltzmann's law */
} option;

static void offer(annealer *an, option *best, int less, int less_too, int more, int more_too)
{
  const double *cost = an->s.cost;
  option o = {{less, less_too}, {more, more_too}, 0};
  for (int k = 0; k < 2; k++)
    o.value += (o.more[k] >= 0 ? cost[o.more[k]] : 0) - (o.less[k] >= 0 ? cost[o.less[k]] : 0);
  o.value += an->heat * log(-log(thr_random_unit(&an->random) + DBL_MIN) + DBL_MIN);
  if (o.value < best->value) *best = o;
}

/* Half-edge number i of node v, or an end behind the last one. */
static int half_at(const thr_frame *f, int v, int i)
{
  return f->first[v] + i < f->first[v + 1] ? f->half[f->first[v] + i] : -1;
}

/* How many of a turn there are; 0 where there is no such turn. */
static int count(const annealer *an, int a, int b)
{
  if (a == b) return 0;
  const int column = thr_turn_state_column(&an->s, a, b);
  return column < 0 ? 0 : an->s.x[column];
}

/* Both p and q get a pass. */
static void offer_both(annealer *an, int v, int p, int q, option *best)
{
  const thr_turning_columns *c = an->s.c;
  offer(an, best, -1, -1, thr_turning_column(c, p, q), -1);
  for (int i = 0, d = thr_degree(c->f, v); i < d; i++)
    for (int k = i + 1; k <= d; k++) {
      const int a = half_at(c->f, v, i), b = half_at(c->f, v, k);
      if (count(an, a, b) == 0) continue;
      const int old = thr_turn_state_column(&an->s, a, b);
      if (a != p && b != q)
        offer(an, best, old, -1, thr_turn_state_column(&an->s, a, p),
              thr_turn_state_column(&an->s, b, q));
      if (a != q && b != p)
        offer(an, best, old, -1, thr_turn_state_column(&an->s, a, q),
              thr_turn_state_column(&an->s, b, p));
    }
}

/* Both lose one. */
static void offer_neither(annealer *an, int v, int p, int q, option *best)
{
  const thr_turning_columns *c = an->s.c;
  const int d = thr_degree(c->f, v);
  if (count(an, p, q) > 0) offer(an, best, thr_turning_column(c, p, q), -1, -1, -1);
  for (int i = 0; i <= d; i++)
    for (int k = 0; k <= d; k++) {
      const int a = half_at(c->f, v, i), b = half_at(c->f, v, k);
      if (a == b || a == q || b == p || count(an, p, a) == 0 || count(an, q, b) == 0) continue;
      offer(an, best, thr_turn_state_column(&an->s, p, a), thr_turn_state_column(&an->s, q, b),
            thr_turn_state_column(&an->s, a, b), -1);
    }
}

/* p gets one, q loses one. */
static void offer_other(annealer *an, int v, int p, int q, option *best)
{
  const thr_turning_columns *c = an->s.c;
  for (int i = 0, d = thr_degree(c->f, v); i <= d; i++) {
    const int a = half_at(c->f, v, i);
    if (a != p && a != q && count(an, q, a) > 0)
      offer(an, best, thr_turn_state_column(&an->s, q, a), -1, thr_turn_state_column(&an->s, p, a),
            -1);
  }
}

/* The turns of node v, where the cycle's half-edges p and q leave; false: there is no way. */
static bool turn_at(annealer *an, int v, int p, int by_p, int q, int by_q)
{
  option best = {.value = INFINITY};
  if (by_p > 0 && by_q > 0) offer_both(an, v, p, q, &best);
  if (by_p < 0 && by_q < 0) offer_neither(an, v, p, q, &best);
  if (by_p > 0 && by_q < 0) offer_other(an, v, p, q, &best);
  if (by_p < 0 && by_q > 0) offer_other(an, v, q, p, &best);
  if (best.value == INFINITY) return false;
  for (int k = 0; k < 2; k++) {
    if (best.less[k] >= 0) thr_turn_state_change(&an->s, best.less[k], -1);
    if (best.more[k] >= 0) thr_turn_state_change(&an->s, best.more[k], 1);
  }
  return true;
}

/* An edge of the cycle loses an extra pass if it has one, else gets one. 0: it may not. */
static int pass_change(const annealer *an, int e)
{
  const thr_turning_columns *c = an->s.c;
  if (an->s.x[c->first_extra + e] > 0) return -1;
  return c->most[e] > c->cover[e];
}

static bool go_round(annealer *an)
{
  const thr_turning_columns *c = an->s.c;
  if (an->cycles->n == 0) return false;
  const int i = thr_random_below(&an->random, an->cycles->n),
            *half = an->cycles->half + an->cycles->first[i];
  const int n = an->cycles->first[i + 1] - an->cycles->first[i];
  int by[THR_CYCLE_MOST];
  for (int k = 0; k < n; k++)
    if ((by[k] = pass_change(an, half[k] >> 1)) == 0) return false;
  for (int k = 0; k < n; k++)
    thr_turn_state_change(&an->s, c->first_extra + (half[k] >> 1), by[k]);
  bool done = an->s.spare >= 0;
  for (int k = 0, before = n - 1; k < n && done; before = k++)
    done = turn_at(an, thr_tail(c->f, half[k]), half[k], by[k], half[before] ^ 1, by[before]);
  if (!done) thr_turn_state_undo(&an->s);
  return done;
}

/* ---- the run ---- */

static void keep_best(annealer *an)
{
  if (an->apart > 0 || an->value >= an->best_value - 1e-9 * an->unit) return;
  an->best_value = an->value;
  memcpy(an->best, an->s.x, (size_t)an->s.c->n_columns * sizeof *an->best);
}

static void step(annealer *an)
{
  thr_turn_state *s = &an->s;
  const bool changed = thr_random(&an->random) & 1 ? exchange(an) : go_round(an);
  if (!changed) return;
  const double most =
      -an->heat * log(thr_random_unit(&an->random) + DBL_MIN); /* that a change may cost */
  bool taken = s->gain - an->apart * an->price_apart <= most;
  int more = 0;
  if (taken) {
    more = thr_turn_parts(s) - (an->apart > 0 ? thr_turn_parts_before(s) : 1);
    taken = s->gain + more * an->price_apart <= most;
  }
  if (!taken) {
    thr_turn_state_undo(s);
    return;
  }
  an->value += s->gain;
  an->apart += more;
  s->n_changes = 0;
  s->gain = 0;
  keep_best(an);
}

static void set_price(annealer *an)
{
  enum { OFTEN = 1000 };
  an->whole += an->apart == 0;
  if (++an->steps < OFTEN) return;
  an->price_apart *= (double)an->whole > whole_share * OFTEN ? 0.98 : 1.02;
  an->price_apart = fmin(apart_most * an->unit, fmax(apart_least * an->unit, an->price_apart));
  an->steps = an->whole = 0;
}

static void run(annealer *an, int64_t steps, const thr_limits *limits)
{
  enum { LOOK = 256 };
  for (int64_t i = 0; i < steps; i++) {
    if (i % LOOK == 0) {
      if (thr_limits_stop(limits)) return;
      thr_limits_spend(limits, LOOK * 2e-6);
      an->heat = an->hot * pow(an->unit * cold / an->hot, (double)i / (double)steps);
    }
    step(an);
    set_price(an);
  }
}

thr_status thr_anneal_turns(const thr_turning_columns *c, const thr_short_cycles *cycles,
                            bool again, int64_t steps, uint64_t seed, const thr_limits *limits,
                            int *x, bool *better, thr_err *err)
{
  annealer an = {
      .cycles = cycles, .random = seed, .unit = thr_turn_cost_of(c->task->cost, THR_PI) / THR_PI};
  an.price_apart = apart_first * an.unit;
  an.hot = (again ? warm : hottest) * an.unit;
  *better = false;
  thr_status st = thr_turn_state_init(&an.s, c, x, err);
  an.best = thr_scratch_array(&an.s.own, (size_t)c->n_columns, sizeof *an.best);
  if (!st) st = thr_scratch_check(&an.s.own, err);
  if (!st) {
    for (int j = 0; j < c->n_columns; j++)
      an.value += x[j] * an.s.cost[j];
    const double before = an.best_value = an.value;
    run(&an, steps, limits);
    *better = an.best_value < before;
    if (*better) memcpy(x, an.best, (size_t)c->n_columns * sizeof *x);
  }
  thr_turn_state_destroy(&an.s);
  return st;
}
