/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lowers the turning of single cords by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P.
 * Vecchi 1983), which changes turns and extra passes together.
 *
 * Passes over one edge are interchangeable, hence a state is the numbers of turns, extra passes and
 * ends alone (the columns of graph/plan/turning_proof.h). Such numbers are one cord for each
 * component if they satisfy the equations of all half-edges and their turns connect all edges of
 * the component. A step proposes one of two changes, both of which keep the equations:
 * - an exchange at one node: turns (a b)(c d) become (a c)(b d);
 * - a round along a short cycle: every edge of the cycle gets an extra pass, or loses one that the
 *   edge has. At each of its nodes two new passes become one turn, or are put into an existing
 * turn, (a b) becoming (a p)(q b); two lost passes leave their partners to each other. A state may
 * fall into several parts for a while, each at a penalty, which is adapted until a fifth of the
 * states are connected.
 *
 * Example: three rings of a sphere cross at 60 degrees. Exchanges connect two of them by two turns
 * of 60 degrees; an extra pass that leaves the line of one ring for that of another connects them
 * by one. */
#include "graph/number.h"
#include "tortuosity/cords/several.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Temperatures, and the penalty of a part at first, at least and at most, in rad, for turns that
 * cost their angle. On spheres higher temperatures took longer to the same turning, and long runs
 * were no better than short ones that started again, at the temperature `warm`, from the best
 * state. */
static const double hottest = 0.25, warm = 0.13, cold = 0.03, penalty_first = 1.3,
                    penalty_least = 0.3, penalty_most = 6;
static const double whole_share = 0.2; /* of the states that are to be connected */

/* A run of the annealing: the state, the schedule and the best state so far. */
typedef struct {
  thr_turn_state state;
  const thr_short_cycles *cycles;
  uint64_t random;
  double unit, hot, heat, penalty; /* price of 1 rad; first and current temperature; price of a part
                                      that is not connected */
  int apart;                       /* parts beyond one in every component */
  double value, best_value;        /* price of the state's columns, and of the best's */
  int *best;                       /* [n_columns] the cheapest connected state */
  int64_t steps, whole; /* steps since the penalty was adapted last, and how many of them left a
                           connected state */
} turn_annealer;

bool thr_anneal_turns_serves(const thr_turning_columns *columns)
{
  const thr_turning_task *task = columns->task;
  return !task->tube && !task->free_turns && task->cords == 1 && !task->end_count &&
         thr_frame_largest_degree(columns->f) <= THR_TURN_DEGREE;
}

/* ---- exchanges at one node ---- */

/* Draws one of the half-edges that half-edge a has turns with, or its cord end, each with the same
 * probability. Returns -1 for an end, -2 if a has neither. */
static int random_partner(turn_annealer *annealer, int a)
{
  const thr_turning_columns *columns = annealer->state.c;
  const int *half = columns->f->half + columns->f->first[thr_tail(columns->f, a)],
            end = columns->end_column[a];
  int found = -2, n = 0;

  /* Reservoir sampling: the n-th candidate replaces the one before with probability 1 / n. */
  for (uint64_t left = annealer->state.partners[a]; left; left &= left - 1)
    if (thr_random_below(&annealer->random, ++n) == 0) found = half[__builtin_ctzll(left)];
  return end >= 0 && annealer->state.x[end] > 0 && thr_random_below(&annealer->random, ++n) == 0
             ? -1
             : found;
}

/* Draws turns (a b) and (c d) of one node and replaces them by (a c) and (b d). Returns false, and
 * changes nothing, if the draw gives no such exchange. */
static bool exchange(turn_annealer *annealer)
{
  /* Two half-edges of a node, and a partner of each. */
  const thr_frame *frame = annealer->state.c->f;
  const int v = thr_random_below(&annealer->random, frame->n_nodes), degree = thr_degree(frame, v);
  if (degree < 3) return false;

  const int a = frame->half[frame->first[v] + thr_random_below(&annealer->random, degree)];
  const int c = frame->half[frame->first[v] + thr_random_below(&annealer->random, degree)];
  const int b = random_partner(annealer, a), d = random_partner(annealer, c);

  /* No U-turns, no turns between two ends, and no exchange that would change nothing. */
  if (a == c || b == d || b == c || a == d || b == -2 || d == -2) return false;
  thr_turn_state_change(&annealer->state, thr_turn_state_column(&annealer->state, a, b), -1);
  thr_turn_state_change(&annealer->state, thr_turn_state_column(&annealer->state, c, d), -1);
  thr_turn_state_change(&annealer->state, thr_turn_state_column(&annealer->state, a, c), 1);
  thr_turn_state_change(&annealer->state, thr_turn_state_column(&annealer->state, b, d), 1);
  return true;
}

/* ---- rounds along a cycle ---- */

/* One possible change of the turns at a node: columns that lose and columns that get a turn, -1 =
 * none. */
typedef struct {
  int less[2], more[2];
  double value; /* the price, less a random amount at this temperature (Gumbel's distribution). The
                   option of the least value is taken, which draws each with the probability of
                   Boltzmann's law */
} option;

/* Replaces *best by the option of these columns if the option's value is less. */
static void offer(turn_annealer *annealer, option *best, int less, int less_too, int more,
                  int more_too)
{
  const double *cost = annealer->state.cost;
  option offered = {{less, less_too}, {more, more_too}, 0};

  /* The price that the option adds. */
  for (int k = 0; k < 2; k++)
    offered.value += (offered.more[k] >= 0 ? cost[offered.more[k]] : 0) -
                     (offered.less[k] >= 0 ? cost[offered.less[k]] : 0);

  /* Gumbel's noise. */
  offered.value +=
      annealer->heat * log(-log(thr_random_unit(&annealer->random) + DBL_MIN) + DBL_MIN);
  if (offered.value < best->value) *best = offered;
}

/* Returns the i-th half-edge of node v, or -1, which stands for a cord end, behind the last one. */
static int half_at(const thr_frame *frame, int v, int i)
{
  return frame->first[v] + i < frame->first[v + 1] ? frame->half[frame->first[v] + i] : -1;
}

/* Returns the number of turns between a and b in the state; 0 if the model has no such column. */
static int count(const turn_annealer *annealer, int a, int b)
{
  if (a == b) return 0;
  const int column = thr_turn_state_column(&annealer->state, a, b);
  return column < 0 ? 0 : annealer->state.x[column];
}

/* Offers all changes at node v where p and q both get a pass. */
static void offer_both(turn_annealer *annealer, int v, int p, int q, option *best)
{
  const thr_turning_columns *columns = annealer->state.c;

  /* The new passes turn into each other. */
  offer(annealer, best, -1, -1, thr_turning_column(columns, p, q), -1);

  /* They are put into an existing turn (a b), either way round; b may be a cord end. */
  for (int i = 0, degree = thr_degree(columns->f, v); i < degree; i++)
    for (int k = i + 1; k <= degree; k++) {
      const int a = half_at(columns->f, v, i), b = half_at(columns->f, v, k);
      if (count(annealer, a, b) == 0) continue;
      const int old = thr_turn_state_column(&annealer->state, a, b);
      if (a != p && b != q)
        offer(annealer, best, old, -1, thr_turn_state_column(&annealer->state, a, p),
              thr_turn_state_column(&annealer->state, b, q));
      if (a != q && b != p)
        offer(annealer, best, old, -1, thr_turn_state_column(&annealer->state, a, q),
              thr_turn_state_column(&annealer->state, b, p));
    }
}

/* Offers all changes at node v where p and q both lose a pass. */
static void offer_neither(turn_annealer *annealer, int v, int p, int q, option *best)
{
  const thr_turning_columns *columns = annealer->state.c;
  const int degree = thr_degree(columns->f, v);

  /* The lost passes turned into each other. */
  if (count(annealer, p, q) > 0)
    offer(annealer, best, thr_turning_column(columns, p, q), -1, -1, -1);

  /* They had partners a and b, which turn into each other from now on. */
  for (int i = 0; i <= degree; i++)
    for (int k = 0; k <= degree; k++) {
      const int a = half_at(columns->f, v, i), b = half_at(columns->f, v, k);
      if (a == b || a == q || b == p || count(annealer, p, a) == 0 || count(annealer, q, b) == 0)
        continue;
      offer(annealer, best, thr_turn_state_column(&annealer->state, p, a),
            thr_turn_state_column(&annealer->state, q, b),
            thr_turn_state_column(&annealer->state, a, b), -1);
    }
}

/* Offers all changes at node v where p gets a pass and q loses one: p takes over a partner a of q,
 * which may be a cord end. */
static void offer_other(turn_annealer *annealer, int v, int p, int q, option *best)
{
  const thr_turning_columns *columns = annealer->state.c;
  for (int i = 0, degree = thr_degree(columns->f, v); i <= degree; i++) {
    const int a = half_at(columns->f, v, i);
    if (a != p && a != q && count(annealer, q, a) > 0)
      offer(annealer, best, thr_turn_state_column(&annealer->state, q, a), -1,
            thr_turn_state_column(&annealer->state, p, a), -1);
  }
}

/* Draws and makes a change of the turns at node v after the passes of the cycle's half-edges p and
 * q, which leave v, have changed by by_p and by_q. Returns false if no change is possible. */
static bool turn_at(turn_annealer *annealer, int v, int p, int by_p, int q, int by_q)
{
  option best = {.value = INFINITY};

  /* All changes that fit the two half-edges. */
  if (by_p > 0 && by_q > 0) offer_both(annealer, v, p, q, &best);
  if (by_p < 0 && by_q < 0) offer_neither(annealer, v, p, q, &best);
  if (by_p > 0 && by_q < 0) offer_other(annealer, v, p, q, &best);
  if (by_p < 0 && by_q > 0) offer_other(annealer, v, q, p, &best);
  if (best.value == INFINITY) return false;

  /* Make the change that was drawn. */
  for (int k = 0; k < 2; k++) {
    if (best.less[k] >= 0) thr_turn_state_change(&annealer->state, best.less[k], -1);
    if (best.more[k] >= 0) thr_turn_state_change(&annealer->state, best.more[k], 1);
  }
  return true;
}

/* Returns by how much the passes of edge e change in a round: -1 if the edge has an extra pass,
 * else 1, or 0 if the edge may have no further one. */
static int pass_change(const turn_annealer *annealer, int e)
{
  const thr_turning_columns *columns = annealer->state.c;
  if (annealer->state.x[columns->first_extra + e] > 0) return -1;
  return columns->most[e] > columns->cover[e];
}

/* Draws a short cycle and changes the passes of its edges and the turns at its nodes. Returns
 * false, and leaves the state as it was, if some edge or node allows no change. */
static bool go_round(turn_annealer *annealer)
{
  const thr_turning_columns *columns = annealer->state.c;
  if (annealer->cycles->n == 0) return false;

  const int i = thr_random_below(&annealer->random, annealer->cycles->n),
            *half = annealer->cycles->half + annealer->cycles->first[i];
  const int n = annealer->cycles->first[i + 1] - annealer->cycles->first[i];
  int by[THR_CYCLE_MOST];

  /* The passes of all edges first: how they change says which turns a node can take. */
  for (int k = 0; k < n; k++)
    if ((by[k] = pass_change(annealer, half[k] >> 1)) == 0) return false;
  for (int k = 0; k < n; k++)
    thr_turn_state_change(&annealer->state, columns->first_extra + (half[k] >> 1), by[k]);

  /* Then the turns at each node, between the half-edge that leaves it and the one that arrives. */
  bool done = annealer->state.spare >= 0; /* within the limit on the extra length */
  for (int k = 0, before = n - 1; k < n && done; before = k++)
    done = turn_at(annealer, thr_tail(columns->f, half[k]), half[k], by[k], half[before] ^ 1,
                   by[before]);
  if (!done) thr_turn_state_undo(&annealer->state);
  return done;
}

/* ---- the run ---- */

/* Keeps the state as the best if the state is connected and cheaper. */
static void keep_best(turn_annealer *annealer)
{
  if (annealer->apart > 0 || annealer->value >= annealer->best_value - 1e-9 * annealer->unit)
    return;
  annealer->best_value = annealer->value;
  memcpy(annealer->best, annealer->state.x,
         (size_t)annealer->state.c->n_columns * sizeof *annealer->best);
}

/* Proposes one change and accepts it by Metropolis's rule, or takes it back. */
static void step(turn_annealer *annealer)
{
  thr_turn_state *state = &annealer->state;
  const bool changed = thr_random(&annealer->random) & 1 ? exchange(annealer) : go_round(annealer);
  if (!changed) return;

  /* Metropolis's rule, drawn ahead: the price that an accepted change may add. */
  const double most = -annealer->heat * log(thr_random_unit(&annealer->random) + DBL_MIN);

  /* The parts take long to count. They are counted only if the change could be accepted even with
   * the gain of connecting all parts; and of a connected state it is known that there was one. */
  bool taken = state->gain - annealer->apart * annealer->penalty <= most;
  int more = 0;
  if (taken) {
    more = thr_turn_parts(state) - (annealer->apart > 0 ? thr_turn_parts_before(state) : 1);
    taken = state->gain + more * annealer->penalty <= most;
  }
  if (!taken) {
    thr_turn_state_undo(state);
    return;
  }

  annealer->value += state->gain;
  annealer->apart += more;
  state->n_changes = 0;
  state->gain = 0;
  keep_best(annealer);
}

/* Counts the connected states, and after every OFTEN steps raises the penalty of parts if these
 * states were too few, or lowers it. */
static void adapt_penalty(turn_annealer *annealer)
{
  enum { OFTEN = 1000 };
  annealer->whole += annealer->apart == 0;
  if (++annealer->steps < OFTEN) return;

  annealer->penalty *= (double)annealer->whole > whole_share * OFTEN ? 0.98 : 1.02;
  annealer->penalty =
      fmin(penalty_most * annealer->unit, fmax(penalty_least * annealer->unit, annealer->penalty));
  annealer->steps = annealer->whole = 0;
}

/* Makes so many steps, or fewer if the limits stop them, while the temperature falls geometrically
 * from `hot` to `cold`. */
static void run(turn_annealer *annealer, int64_t steps, const thr_limits *limits)
{
  enum { LOOK = 256 }; /* steps between two looks at the limits */
  for (int64_t i = 0; i < steps; i++) {
    /* Look at the limits, and cool. */
    if (i % LOOK == 0) {
      if (thr_limits_stop(limits)) return;
      thr_limits_spend(limits, LOOK * 2e-6);
      annealer->heat =
          annealer->hot * pow(annealer->unit * cold / annealer->hot, (double)i / (double)steps);
    }

    step(annealer);
    adapt_penalty(annealer);
  }
}

thr_status thr_anneal_turns(const thr_turning_columns *columns, const thr_short_cycles *cycles,
                            bool again, int64_t steps, uint64_t seed, const thr_limits *limits,
                            int *x, bool *better, thr_err *err)
{
  /* Temperatures and penalty in the prices of the task. */
  turn_annealer annealer = {.cycles = cycles,
                            .random = seed,
                            .unit = thr_turn_cost_of(columns->task->cost, THR_PI) / THR_PI};
  annealer.penalty = penalty_first * annealer.unit;
  annealer.hot = (again ? warm : hottest) * annealer.unit;

  *better = false;
  thr_status st = thr_turn_state_init(&annealer.state, columns, x, err);
  annealer.best =
      thr_scratch_array(&annealer.state.own, (size_t)columns->n_columns, sizeof *annealer.best);
  if (!st) st = thr_scratch_check(&annealer.state.own, err);

  if (!st) {
    for (int j = 0; j < columns->n_columns; j++)
      annealer.value += x[j] * annealer.state.cost[j];
    const double before = annealer.best_value = annealer.value;
    run(&annealer, steps, limits);

    /* The best state takes the place of x. */
    *better = annealer.best_value < before;
    if (*better) memcpy(x, annealer.best, (size_t)columns->n_columns * sizeof *x);
  }

  thr_turn_state_destroy(&annealer.state);
  return st;
}
