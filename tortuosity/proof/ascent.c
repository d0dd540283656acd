/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a first bound for tube joints without a linear programme.
 *
 * Multipliers on the equations of the half-edges leave one problem per node: turns that tie its
 * edges, each at its price less the multipliers of its two half-edges. A minimum spanning tree is
 * the cheapest way to tie them; turns of negative price are added as often as allowed. The
 * multipliers climb along the mean of the solutions' subgradients (the volume algorithm: F.
 * Barahona & R. Anbil, Math. Programming 87, 2000); the limit on the length has a multiplier as
 * well. As no number of turns is odd or even here, the bound comes near the optimum of the linear
 * programme without its odd rows. In the end the multipliers become integers, and the trees become
 * junctions that prove them (Kruskal's method).
 *
 * Example: a node with three edges whose turns cost 1, 2 and 4 has the tree of 1 and 2: the bound
 * 3, proved by the junction of single edges with value 1 and the one of {1, 1, 2} with value 1. */
#include "tortuosity/proof/relax_parts.h"
#include "lp/solver/solver.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Steps at most; steps in turn without a better bound after which steps become shorter. */
enum { STEPS = 1000, PATIENCE = 20 };

/* Lengths of steps as parts of what would reach the target; largest part of a new solution in the
 * mean. */
static const double first_step = 0.05, least_step = 1e-4, most_new = 0.1;
static const double most_multiplier =
    2000; /* where there is no plan, nothing else would stop them */

/* State of the ascent. A point has 2 m + 1 coordinates: shift[m], which one half-edge of an edge
 * gets and the other one pays; both[m] >= 0, which both get; and the multiplier of the length, >=
 * 0. */
typedef struct {
  const thr_turning_columns *c;
  int m, n;              /* edges; multipliers: 2 * m + 1 */
  double scale;          /* of the last multiplier: a step changes the price of every extra pass */
  double *price;         /* [n_columns] */
  double *potential;     /* [2 * m] of the half-edges */
  double *count;         /* [2 * m] passes that turn or end at a half-edge in the last solution */
  double *mean;          /* [2 * m] of the solutions */
  double *rise, *uphill; /* [n] what the bound gains per unit of a multiplier; of the mean */
  double *at, *best;     /* [n] */
  double *ends;          /* [2 * m] of the passes of count, those that end */
  double *mean_ends;     /* [2 * m] */
  double *key;           /* [largest degree] of Prim's algorithm */
  int *via, *end_at; /* [largest degree] the same; [n_ends] half-edge where ends are worth most, -1
                        = none */
  double *block;
} ascent_state;

/* Releases the arrays. */
static void ascent_destroy(ascent_state *state)
{
  free(state->block);
  free(state->via);
}

/* Allocates all arrays of doubles in one block, and computes the prices. */
static thr_status ascent_init(ascent_state *state, const thr_turning_columns *turning_columns,
                              thr_err *err)
{
  int m = turning_columns->f->n_edges, degree = thr_frame_largest_degree(turning_columns->f);
  *state = (ascent_state){.c = turning_columns, .m = m, .n = 2 * m + 1, .scale = 1 / sqrt(m)};

  double *block = state->block = thr_calloc((size_t)turning_columns->n_columns + 10 * (size_t)m +
                                                4 * (size_t)state->n + (size_t)degree,
                                            sizeof *block);
  state->via = thr_calloc((size_t)degree + (size_t)turning_columns->n_ends, sizeof *state->via);
  if (!block || !state->via) {
    ascent_destroy(state);
    return thr_nomem(err);
  }

  state->end_at = state->via + degree;

  /* Divide the block. */
  double **darts[] = {&state->potential, &state->count, &state->mean, &state->ends,
                      &state->mean_ends};
  for (int i = 0; i < 5; i++, block += 2 * m)
    *darts[i] = block;
  double **multipliers[] = {&state->rise, &state->uphill, &state->at, &state->best};
  for (int i = 0; i < 4; i++, block += state->n)
    *multipliers[i] = block;
  state->key = block;
  state->price = block + degree;

  for (int j = 0; j < turning_columns->n_columns; j++)
    state->price[j] = ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
  return THR_OK;
}

/* Returns the length of an edge in units of the longest. */
static double length_of(const ascent_state *state, int e)
{
  return ldexp((double)state->c->length[e], -THR_LENGTH_BITS);
}

/* ---- the bound at a point ---- */

/* Returns the price of an extra pass of edge e, including what the multiplier of the length adds.
 */
static double weight_of(const ascent_state *state, const double *u, int e)
{
  return state->price[state->c->first_extra + e] +
         state->scale * u[2 * state->m] * length_of(state, e);
}

/* Sets the potentials of a point such that no extra pass has a negative reduced price. Returns the
 * sum of potentials x covers. */
static double set_potentials(ascent_state *state, const double *u)
{
  double value = 0;
  for (int e = 0; e < state->m; e++) {
    double half = u[state->m + e] - weight_of(state, u, e) / 2;
    state->potential[2 * e] = half + u[e];
    state->potential[2 * e + 1] = half - u[e];
    value += 2 * half * state->c->cover[e];
  }
  return value;
}

/* Returns the reduced price of the turn between half-edges g and h. */
static double price_of(const ascent_state *state, int g, int h)
{
  return state->price[thr_turning_column(state->c, g, h)] - state->potential[g] -
         state->potential[h];
}

/* Adds the minimum spanning tree at node v to the solution (Prim's method) and returns its price.
 * Turns of negative price count as 0 here: add_gains adds their prices and passes. */
static double add_tree(ascent_state *state, int v)
{
  const int *half = state->c->f->half + state->c->f->first[v], d = thr_degree(state->c->f, v);
  double value = 0;
  for (int i = 0; i < d; i++)
    state->key[i] = INFINITY;

  /* Add one edge of the node after the other: the one that the cheapest turn joins to the tree. */
  for (int at = 0, joined = 1; joined < d; joined++) {
    int next = -1;
    state->key[at] = -1; /* in the tree */
    for (int i = 0; i < d; i++) {
      if (state->key[i] < 0) continue;
      double price = fmax(0, price_of(state, half[at], half[i]));
      if (price < state->key[i]) {
        state->key[i] = price;
        state->via[i] = at;
      }
      if (next < 0 || state->key[i] < state->key[next]) next = i;
    }

    value += state->key[next];
    if (price_of(state, half[next], half[state->via[next]]) >= 0) {
      state->count[half[next]]++;
      state->count[half[state->via[next]]]++;
    }

    at = next;
  }
  return value;
}

/* Adds all turns of negative price, as often as they may be made, and returns what they cost. */
static double add_gains(ascent_state *state)
{
  const thr_turning_columns *turning_columns = state->c;
  double value = 0;
  for (int j = 0; j < turning_columns->first_extra; j++) {
    int g = turning_columns->half[j][0], h = turning_columns->half[j][1];

    /* Turns of other prices come into the solution with the trees. */
    double price = state->price[j] - state->potential[g] - state->potential[h];
    if (price >= 0) continue;

    int most = thr_turning_most(turning_columns, j);
    value += most * price;
    state->count[g] += most;
    state->count[h] += most;
  }
  return value;
}

/* Adds the ends of every group, all at the half-edge with the largest potential: as many as must
 * be, or as many as may be if the potential is positive. Returns their price. */
static double add_ends(ascent_state *state)
{
  const thr_turning_columns *turning_columns = state->c;
  double value = 0;
  for (int k = 0; k < turning_columns->n_ends; k++)
    state->end_at[k] = -1;

  /* The half-edge with the largest potential. */
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++) {
    int h = turning_columns->half[j][0],
        *at = &state->end_at[turning_columns->end_group[thr_tail(turning_columns->f, h)]];
    if (*at < 0 || state->potential[h] > state->potential[*at]) *at = h;
  }

  for (int k = 0; k < turning_columns->n_ends; k++) {
    int h = state->end_at[k];
    if (h < 0) continue;

    int ends = turning_columns->supply[k][state->potential[h] > 0];
    value -= ends * state->potential[h];
    state->count[h] += ends;
    state->ends[h] += ends;
  }
  return value;
}

/* Returns the bound at a point. state->rise receives a subgradient there: by how much the equations
 * are missed. */
static double bound_at(ascent_state *state, const double *u)
{
  const thr_turning_columns *turning_columns = state->c;
  int m = state->m;
  double value = set_potentials(state, u), longer = 0,
         limit = ldexp((double)turning_columns->extra_limit, -THR_LENGTH_BITS);

  /* The solution of all nodes. */
  memset(state->count, 0, 2 * (size_t)m * sizeof *state->count);
  memset(state->ends, 0, 2 * (size_t)m * sizeof *state->ends);
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    value += add_tree(state, v);
  value += add_gains(state) + add_ends(state);

  /* A shift moves between the two half-edges of an edge; `both` pays for passes that are missing to
   * the cover. */
  for (int e = 0; e < m; e++) {
    double forth = state->count[2 * e], back = state->count[2 * e + 1],
           few = 2 * turning_columns->cover[e] - forth - back;
    state->rise[e] = back - forth;
    state->rise[m + e] = few;
    longer -= few / 2 * length_of(state, e);
  }

  /* The length is the last row: without a limit its multiplier stays 0. */
  state->rise[2 * m] = turning_columns->extra_limit < 0 ? 0 : state->scale * (longer - limit);
  return turning_columns->extra_limit < 0 ? value : value - state->scale * u[2 * m] * limit;
}

/* ---- steps ---- */

/* Moves mean towards x by the given part of the distance. */
static void mix(double *mean, const double *x, int n, double part)
{
  for (int i = 0; i < n; i++)
    mean[i] += part * (x[i] - mean[i]);
}

/* Moves to the point that lies from the best one along the mean subgradient, `part` of as far as
 * would gain what is missing if the bound were linear. steep: square of the subgradient's length.
 * Only shifts may be negative. */
static void step(ascent_state *state, double part, double missing, double steep)
{
  for (int i = 0; i < state->n; i++) {
    double to = state->best[i] + part * missing / steep * state->uphill[i];
    state->at[i] = fmax(i < state->m ? -most_multiplier : 0, fmin(most_multiplier, to));
  }
}

/* Takes the new solution into the mean, by the part that makes the mean subgradient shortest,
 * within limits. along: scalar product of both subgradients. */
static void take_mean(ascent_state *state, double steep, double along)
{
  double apart = thr_sums_product(state->rise, state->rise, state->n) - 2 * along + steep;
  double part = apart > 0 ? (steep - along) / apart : most_new;
  part = fmin(most_new, fmax(most_new / 10, part));

  mix(state->uphill, state->rise, state->n, part);
  mix(state->mean, state->count, 2 * state->m, part);
  mix(state->mean_ends, state->ends, 2 * state->m, part);
}

/* Climbs from point 0 until the target is reached or STEPS are over. The best point is kept in
 * state->best. Steps grow while they succeed in the mean's direction, and shrink after PATIENCE
 * failures. */
static void climb(ascent_state *state, double target, const thr_limits *limits)
{
  double value = bound_at(state, state->at), part = first_step,
         u_turn = thr_turn_cost_of(state->c->task->cost, THR_PI);

  /* The mean begins as the first solution. */
  memcpy(state->uphill, state->rise, (size_t)state->n * sizeof *state->rise);
  memcpy(state->mean, state->count, 2 * (size_t)state->m * sizeof *state->count);
  memcpy(state->mean_ends, state->ends, 2 * (size_t)state->m * sizeof *state->ends);

  for (int i = 0, failed = 0; i < STEPS && value < target && !thr_limits_stop(limits); i++) {
    double steep = thr_sums_product(state->uphill, state->uphill, state->n),
           hoped = fmax(0.1 * value, 0.01 * u_turn * state->m);
    if (steep < 1e-12) break;

    /* No bound far above the present one is aimed at, however far the target is. */
    step(state, part, fmin(hoped, target - value), steep);

    double now = bound_at(state, state->at),
           along = thr_sums_product(state->uphill, state->rise, state->n);
    take_mean(state, steep, along);

    /* A better bound moves the best point; several failures in turn shorten the steps. */
    if (now > value) {
      value = now;
      memcpy(state->best, state->at, (size_t)state->n * sizeof *state->at);
      part = fmin(2, along >= 0 ? 1.1 * part : part);
      failed = 0;
    } else if (++failed > PATIENCE) {
      part = fmax(least_step, 0.66 * part);
      failed = 0;
    }
  }
}

/* ---- multipliers as integers ---- */

/* A turn of a tree, between edges number a and b of a node. */
typedef struct {
  int64_t price;
  int a, b;
} turn;

/* Compares turns by price, then by their edges. */
static int by_price(const void *x, const void *y)
{
  const turn *p = x, *q = y;
  if (p->price != q->price) return p->price < q->price ? -1 : 1;
  return p->a != q->a ? p->a - q->a : p->b - q->b;
}

/* Appends the junction whose blocks are the sets in parent. */
static thr_status keep_junction(thr_turning_dual *dual, int *capacity, int v, int degree,
                                int *parent, int64_t value, thr_err *err)
{
  thr_status st =
      thr_grow(&dual->junction, dual->n_junctions, capacity, sizeof *dual->junction, err);
  if (st) return st;
  thr_turning_junction turning_junction = {
      v, thr_calloc((size_t)degree, sizeof *turning_junction.block), value};
  if (!turning_junction.block) return thr_nomem(err);

  thr_disjoint_number(parent, degree, turning_junction.block);
  dual->junction[dual->n_junctions++] = turning_junction;
  return THR_OK;
}

/* Returns the reduced price of the turn between half-edges g and h, as an integer. */
static int64_t left_of(const thr_turning_columns *turning_columns, const thr_turning_dual *dual,
                       int g, int h)
{
  return turning_columns->weight[thr_turning_column(turning_columns, g, h)] - dual->potential[g] -
         dual->potential[h];
}

/* Computes the minimum spanning tree at node v by Prim's method; list[degree - 1] receives its
 * turns. The entries behind the turns of the tree are the cheapest turns into it from each
 * other edge. */
static void find_tree(const thr_turning_columns *turning_columns, const thr_turning_dual *dual,
                      int v, turn *list)
{
  const int *half = turning_columns->f->half + turning_columns->f->first[v],
            degree = thr_degree(turning_columns->f, v);
  for (int i = 1; i < degree; i++)
    list[i - 1] = (turn){left_of(turning_columns, dual, half[0], half[i]), 0, i};

  for (int joined = 0; joined < degree - 1; joined++) {
    int next = joined;
    for (int i = joined; i < degree - 1; i++)
      if (by_price(&list[i], &list[next]) < 0) next = i;

    /* Swap the cheapest turn to the front, and improve the others by the new edge. */
    turn t = list[next];
    list[next] = list[joined];
    list[joined] = t;
    for (int i = joined + 1; i < degree - 1; i++) {
      int64_t price = left_of(turning_columns, dual, half[t.b], half[list[i].b]);
      if (price < list[i].price) list[i] = (turn){price, t.b, list[i].b};
    }
  }
}

/* Returns how many junctions a node has at most in the proof: as many as its tree has prices,
 * except where nodes of very many edges would make the proof slow to check, because the checker
 * looks at all turns of a node for every junction there. */
static int most_junctions(const thr_frame *frame)
{
  const double checked = 2e7;
  enum { LEAST = 8 };

  double turns = 1;
  for (int v = 0; v < frame->n_nodes; v++)
    turns += (double)thr_degree(frame, v) * thr_degree(frame, v);
  return checked / turns > frame->n_edges ? frame->n_edges : (int)fmax(LEAST, checked / turns);
}

/* Proves the minimum spanning tree at node v. In order of price, until turns of the next price are
 * made, all parts joined so far must still be joined for at least this price: each rise in price is
 * the value of a junction of these parts. At most so many junctions are kept. */
static thr_status prove_tree(const thr_turning_columns *turning_columns, thr_turning_dual *dual,
                             int *capacity, int v, int most, turn *list, int *parent, thr_err *err)
{
  const int degree = thr_degree(turning_columns->f, v), each = (degree - 2) / most + 1;
  int64_t paid = 0;
  thr_status st = THR_OK;

  for (int i = 0; i < degree; i++)
    parent[i] = i;

  find_tree(turning_columns, dual, v, list);
  qsort(list, degree > 0 ? (size_t)degree - 1 : 0, sizeof *list, by_price);

  /* The turns in order of price, as in Kruskal's method. */
  for (int i = 0; i < degree - 1 && !st; i++) {
    if (list[i].price > paid && i % each == 0) {
      st = keep_junction(dual, capacity, v, degree, parent, list[i].price - paid, err);
      paid = list[i].price;
    }
    thr_disjoint_join(parent, list[i].a, list[i].b);
  }
  return st;
}

/* Appends the junctions of all nodes. */
static thr_status prove_trees(const thr_turning_columns *turning_columns, thr_turning_dual *dual,
                              thr_err *err)
{
  size_t most = (size_t)thr_frame_largest_degree(turning_columns->f);
  int capacity = 0, junctions = most_junctions(turning_columns->f);
  turn *list = thr_calloc(most, sizeof *list);
  int *parent = thr_calloc(most, sizeof *parent);
  thr_status st = list && parent ? THR_OK : thr_nomem(err);

  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    st = prove_tree(turning_columns, dual, &capacity, v, junctions, list, parent, err);

  free(list);
  free(parent);
  return st;
}

/* Makes the multipliers of the best point integers. Rounding must leave no column a negative
 * reduced price: the second potential of every edge is computed such that its extra passes cost 0
 * or more. */
static void round_potentials(ascent_state *state, thr_turning_dual *dual)
{
  const thr_turning_columns *turning_columns = state->c;
  set_potentials(state, state->best);
  dual->length = turning_columns->extra_limit < 0
                     ? 0
                     : thr_relax_whole(state->scale * state->best[2 * state->m]);

  /* Potentials of both half-edges of every edge, the second from the rounded first one. */
  for (int e = 0; e < state->m; e++) {
    int64_t longer = (int64_t)((double)dual->length * length_of(state, e));
    dual->potential[2 * e] = thr_relax_whole(state->potential[2 * e]);
    dual->potential[2 * e + 1] = thr_relax_whole(2 * state->best[state->m + e]) -
                                 turning_columns->weight[turning_columns->first_extra + e] -
                                 longer - dual->potential[2 * e];
  }

  /* The multipliers of the ends: the largest that leave no end a negative price. */
  for (int k = 0; k < turning_columns->n_ends; k++)
    state->end_at[k] = -1;
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++) {
    int h = turning_columns->half[j][0],
        k = turning_columns->end_group[thr_tail(turning_columns->f, h)];
    if (state->end_at[k] < 0 || -dual->potential[h] < dual->ends[k])
      dual->ends[k] = -dual->potential[h];
    state->end_at[k] = h;
  }
}

/* Fills mean[n_columns] with the extra passes and ends of the mean solution. */
static void fill_mean(const ascent_state *state, double *mean)
{
  const thr_turning_columns *turning_columns = state->c;
  memset(mean, 0, (size_t)turning_columns->n_columns * sizeof *mean);

  for (int e = 0; e < state->m; e++)
    mean[turning_columns->first_extra + e] =
        fmax(0, (state->mean[2 * e] + state->mean[2 * e + 1]) / 2 - turning_columns->cover[e]);

  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++)
    mean[j] = state->mean_ends[turning_columns->half[j][0]];
}

/* Runs the ascent, and makes the multipliers of its best point. On failure dual is empty. */
thr_status thr_ascent_run(const thr_turning_columns *turning_columns, double target,
                          const thr_limits *limits, thr_turning_dual *dual, double *mean,
                          thr_err *err)
{
  ascent_state state;
  *dual = (thr_turning_dual){0};
  thr_status st = ascent_init(&state, turning_columns, err);
  if (st) return st;

  st = thr_turning_dual_init(dual, turning_columns, err);
  if (!st) {
    climb(&state, target, limits);
    fill_mean(&state, mean);
    round_potentials(&state, dual);
    st = prove_trees(turning_columns, dual, err);
  }

  if (st) thr_turning_dual_destroy(dual);
  ascent_destroy(&state);
  return st;
}
