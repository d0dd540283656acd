/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A first bound for tube joints, without a linear programme. Internal to tortuosity/.
 *
 * Multipliers on the equations of the half-edges alone leave one problem per node: turns that tie
 * its edges, each at its price less the multipliers of its two half-edges. The cheapest are a
 * minimum spanning tree, and what is cheaper than nothing as often as it may be. The multipliers
 * follow the mean of these solutions upwards (the volume algorithm: F. Barahona & R. Anbil, Math.
 * Programming 87, 2000); the limit on the length has one as well. As no number of turns is odd or
 * even here, this comes near the optimum of the linear programme without its odd rows. */
#include "tortuosity/proof/relax_parts.h"
#include "graph/angle.h"
#include "graph/disjoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 1000, PATIENCE = 20 };

static const double first_step = 0.05, least_step = 1e-4, most_new = 0.1;
static const double most_multiplier =
    2000; /* where there is no plan, nothing else would stop them */

/* Where the multipliers stand: shift[m], which one half-edge of an edge gets and the other one
 * pays; both[m] >= 0, which both get; and that of the length, >= 0. One component. */
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
  double *room;
} ascent;

static void ascent_destroy(ascent *a)
{
  free(a->room);
  free(a->via);
}

static thr_status ascent_init(ascent *a, const thr_turning_columns *turning_columns, thr_err *err)
{
  int m = turning_columns->f->n_edges, degree = thr_frame_largest_degree(turning_columns->f);
  *a = (ascent){.c = turning_columns, .m = m, .n = 2 * m + 1, .scale = 1 / sqrt(m)};
  double *room = a->room = thr_calloc((size_t)turning_columns->n_columns + 10 * (size_t)m +
                                          4 * (size_t)a->n + (size_t)degree,
                                      sizeof *room);
  a->via = thr_calloc((size_t)degree + (size_t)turning_columns->n_ends, sizeof *a->via);
  if (!room || !a->via) {
    ascent_destroy(a);
    return thr_nomem(err);
  }
  a->end_at = a->via + degree;
  double **darts[] = {&a->potential, &a->count, &a->mean, &a->ends, &a->mean_ends};
  for (int i = 0; i < 5; i++, room += 2 * m)
    *darts[i] = room;
  double **multipliers[] = {&a->rise, &a->uphill, &a->at, &a->best};
  for (int i = 0; i < 4; i++, room += a->n)
    *multipliers[i] = room;
  a->key = room;
  a->price = room + degree;
  for (int j = 0; j < turning_columns->n_columns; j++)
    a->price[j] = ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
  return THR_OK;
}

static double length_of(const ascent *a, int e)
{
  return ldexp((double)a->c->length[e], -THR_LENGTH_BITS);
}

/* ---- the bound at a point ---- */

static double weight_of(const ascent *a, const double *u, int e)
{
  return a->price[a->c->first_extra + e] + a->scale * u[2 * a->m] * length_of(a, e);
}

/* Potentials with which no extra pass is cheaper than nothing, and what they are worth. */
static double set_potentials(ascent *a, const double *u)
{
  double value = 0;
  for (int e = 0; e < a->m; e++) {
    double half = u[a->m + e] - weight_of(a, u, e) / 2;
    a->potential[2 * e] = half + u[e];
    a->potential[2 * e + 1] = half - u[e];
    value += 2 * half * a->c->cover[e];
  }
  return value;
}

static double price_of(const ascent *a, int g, int h)
{
  return a->price[thr_turning_column(a->c, g, h)] - a->potential[g] - a->potential[h];
}

/* Prim's tree at node v. Turns below 0 join for nothing here, and are counted elsewhere. */
static double add_tree(ascent *a, int v)
{
  const int *half = a->c->f->half + a->c->f->first[v], d = thr_degree(a->c->f, v);
  double value = 0;
  for (int i = 0; i < d; i++)
    a->key[i] = INFINITY;
  for (int at = 0, joined = 1; joined < d; joined++) {
    int next = -1;
    a->key[at] = -1; /* in the tree */
    for (int i = 0; i < d; i++) {
      if (a->key[i] < 0) continue;
      double price = fmax(0, price_of(a, half[at], half[i]));
      if (price < a->key[i]) {
        a->key[i] = price;
        a->via[i] = at;
      }
      if (next < 0 || a->key[i] < a->key[next]) next = i;
    }
    value += a->key[next];
    if (price_of(a, half[next], half[a->via[next]]) >= 0) {
      a->count[half[next]]++;
      a->count[half[a->via[next]]]++;
    }
    at = next;
  }
  return value;
}

/* All turns that are cheaper than nothing. */
static double add_gains(ascent *a)
{
  const thr_turning_columns *turning_columns = a->c;
  double value = 0;
  for (int j = 0; j < turning_columns->first_extra; j++) {
    int g = turning_columns->half[j][0], h = turning_columns->half[j][1];
    double price = a->price[j] - a->potential[g] - a->potential[h];
    if (price >= 0) continue;
    int most = thr_turning_most(turning_columns, j);
    value += most * price;
    a->count[g] += most;
    a->count[h] += most;
  }
  return value;
}

/* The ends, all where the potential is largest. */
static double add_ends(ascent *a)
{
  const thr_turning_columns *turning_columns = a->c;
  double value = 0;
  for (int k = 0; k < turning_columns->n_ends; k++)
    a->end_at[k] = -1;
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++) {
    int h = turning_columns->half[j][0],
        *at = &a->end_at[turning_columns->end_group[thr_tail(turning_columns->f, h)]];
    if (*at < 0 || a->potential[h] > a->potential[*at]) *at = h;
  }
  for (int k = 0; k < turning_columns->n_ends; k++) {
    int h = a->end_at[k];
    if (h < 0) continue;
    int ends = turning_columns->supply[k][a->potential[h] > 0];
    value -= ends * a->potential[h];
    a->count[h] += ends;
    a->ends[h] += ends;
  }
  return value;
}

/* The bound at u; rise receives its slope there. */
static double bound_at(ascent *a, const double *u)
{
  const thr_turning_columns *turning_columns = a->c;
  int m = a->m;
  double value = set_potentials(a, u), longer = 0,
         limit = ldexp((double)turning_columns->extra_limit, -THR_LENGTH_BITS);
  memset(a->count, 0, 2 * (size_t)m * sizeof *a->count);
  memset(a->ends, 0, 2 * (size_t)m * sizeof *a->ends);
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    value += add_tree(a, v);
  value += add_gains(a) + add_ends(a);
  for (int e = 0; e < m; e++) {
    double forth = a->count[2 * e], back = a->count[2 * e + 1],
           few = 2 * turning_columns->cover[e] - forth - back;
    a->rise[e] = back - forth;
    a->rise[m + e] = few;
    longer -= few / 2 * length_of(a, e);
  }
  a->rise[2 * m] = turning_columns->extra_limit < 0 ? 0 : a->scale * (longer - limit);
  return turning_columns->extra_limit < 0 ? value : value - a->scale * u[2 * m] * limit;
}

/* ---- steps ---- */

static double product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

static void mix(double *mean, const double *x, int n, double part)
{
  for (int i = 0; i < n; i++)
    mean[i] += part * (x[i] - mean[i]);
}

/* From best along the mean's slope, so far as would reach the target were it straight. */
static void step(ascent *a, double part, double missing, double steep)
{
  for (int i = 0; i < a->n; i++) {
    double to = a->best[i] + part * missing / steep * a->uphill[i];
    a->at[i] = fmax(i < a->m ? -most_multiplier : 0, fmin(most_multiplier, to));
  }
}

/* Takes the new solution into the mean, by as much as makes the mean's slope small. */
static void take_mean(ascent *a, double steep, double along)
{
  double apart = product(a->rise, a->rise, a->n) - 2 * along + steep;
  double part = apart > 0 ? (steep - along) / apart : most_new;
  part = fmin(most_new, fmax(most_new / 10, part));
  mix(a->uphill, a->rise, a->n, part);
  mix(a->mean, a->count, 2 * a->m, part);
  mix(a->mean_ends, a->ends, 2 * a->m, part);
}

static void climb(ascent *a, double target, const thr_limits *limits)
{
  double value = bound_at(a, a->at), part = first_step,
         u_turn = thr_turn_cost_of(a->c->task->cost, THR_PI);
  memcpy(a->uphill, a->rise, (size_t)a->n * sizeof *a->rise);
  memcpy(a->mean, a->count, 2 * (size_t)a->m * sizeof *a->count);
  memcpy(a->mean_ends, a->ends, 2 * (size_t)a->m * sizeof *a->ends);
  for (int i = 0, failed = 0; i < STEPS && value < target && !thr_limits_stop(limits); i++) {
    double steep = product(a->uphill, a->uphill, a->n),
           hoped = fmax(0.1 * value, 0.01 * u_turn * a->m);
    if (steep < 1e-12) break;
    step(a, part, fmin(hoped, target - value), steep);
    double now = bound_at(a, a->at), along = product(a->uphill, a->rise, a->n);
    take_mean(a, steep, along);
    if (now > value) {
      value = now;
      memcpy(a->best, a->at, (size_t)a->n * sizeof *a->at);
      part = fmin(2, along >= 0 ? 1.1 * part : part);
      failed = 0;
    } else if (++failed > PATIENCE) {
      part = fmax(least_step, 0.66 * part);
      failed = 0;
    }
  }
}

/* ---- multipliers as integers ---- */

typedef struct {
  int64_t price;
  int a, b;
} turn;

static int by_price(const void *x, const void *y)
{
  const turn *p = x, *q = y;
  if (p->price != q->price) return p->price < q->price ? -1 : 1;
  return p->a != q->a ? p->a - q->a : p->b - q->b;
}

/* The edges in the parts of parent, as the block of a junction. */
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

static int64_t left_of(const thr_turning_columns *turning_columns, const thr_turning_dual *dual,
                       int g, int h)
{
  return turning_columns->weight[thr_turning_column(turning_columns, g, h)] - dual->potential[g] -
         dual->potential[h];
}

/* Prim's tree at node v, its turns into list[degree - 1]. */
static void find_tree(const thr_turning_columns *turning_columns, const thr_turning_dual *dual,
                      int v, turn *list)
{
  const int *half = turning_columns->f->half + turning_columns->f->first[v],
            degree = thr_degree(turning_columns->f, v);
  for (int i = 1; i < degree; i++) /* from each that is not in the tree, the cheapest into it */
    list[i - 1] = (turn){left_of(turning_columns, dual, half[0], half[i]), 0, i};
  for (int joined = 0; joined < degree - 1; joined++) {
    int next = joined;
    for (int i = joined; i < degree - 1; i++)
      if (by_price(&list[i], &list[next]) < 0) next = i;
    turn t = list[next];
    list[next] = list[joined];
    list[joined] = t;
    for (int i = joined + 1; i < degree - 1; i++) {
      int64_t price = left_of(turning_columns, dual, half[t.b], half[list[i].b]);
      if (price < list[i].price) list[i] = (turn){price, t.b, list[i].b};
    }
  }
}

/* Junctions of a node at most: all that its tree has prices, but where nodes of very many edges
 * would make the proof slow to check, which looks at all turns of a node for every junction there.
 */
static int most_junctions(const thr_frame *frame)
{
  const double checked = 2e7;
  enum { LEAST = 8 };
  double turns = 1;
  for (int v = 0; v < frame->n_nodes; v++)
    turns += (double)thr_degree(frame, v) * thr_degree(frame, v);
  return checked / turns > frame->n_edges ? frame->n_edges : (int)fmax(LEAST, checked / turns);
}

/* The cheapest tree at node v: what every part must still be joined for, from one price of the tree
 * to a later one. */
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
  for (int i = 0; i < degree - 1 && !st; i++) {
    if (list[i].price > paid && i % each == 0) {
      st = keep_junction(dual, capacity, v, degree, parent, list[i].price - paid, err);
      paid = list[i].price;
    }
    thr_disjoint_join(parent, list[i].a, list[i].b);
  }
  return st;
}

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

/* The potentials at best, the second of every edge such that its extra passes cost nothing or more.
 */
static void round_potentials(ascent *a, thr_turning_dual *dual)
{
  const thr_turning_columns *turning_columns = a->c;
  set_potentials(a, a->best);
  dual->length =
      turning_columns->extra_limit < 0 ? 0 : thr_relax_whole(a->scale * a->best[2 * a->m]);
  for (int e = 0; e < a->m; e++) {
    int64_t longer = (int64_t)((double)dual->length * length_of(a, e));
    dual->potential[2 * e] = thr_relax_whole(a->potential[2 * e]);
    dual->potential[2 * e + 1] = thr_relax_whole(2 * a->best[a->m + e]) -
                                 turning_columns->weight[turning_columns->first_extra + e] -
                                 longer - dual->potential[2 * e];
  }
  for (int k = 0; k < turning_columns->n_ends; k++)
    a->end_at[k] = -1;
  for (int j = turning_columns->first_end; j < turning_columns->first_back;
       j++) { /* no end is cheaper than nothing */
    int h = turning_columns->half[j][0],
        k = turning_columns->end_group[thr_tail(turning_columns->f, h)];
    if (a->end_at[k] < 0 || -dual->potential[h] < dual->ends[k])
      dual->ends[k] = -dual->potential[h];
    a->end_at[k] = h;
  }
}

static void fill_mean(const ascent *a, double *mean)
{
  const thr_turning_columns *turning_columns = a->c;
  memset(mean, 0, (size_t)turning_columns->n_columns * sizeof *mean);
  for (int e = 0; e < a->m; e++)
    mean[turning_columns->first_extra + e] =
        fmax(0, (a->mean[2 * e] + a->mean[2 * e + 1]) / 2 - turning_columns->cover[e]);
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++)
    mean[j] = a->mean_ends[turning_columns->half[j][0]];
}

thr_status thr_ascent_run(const thr_turning_columns *turning_columns, double target,
                          const thr_limits *limits, thr_turning_dual *dual, double *mean,
                          thr_err *err)
{
  ascent a;
  *dual = (thr_turning_dual){0};
  thr_status st = ascent_init(&a, turning_columns, err);
  if (st) return st;
  st = thr_turning_dual_init(dual, turning_columns, err);
  if (!st) {
    climb(&a, target, limits);
    fill_mean(&a, mean);
    round_potentials(&a, dual);
    st = prove_trees(turning_columns, dual, err);
  }
  if (st) thr_turning_dual_destroy(dual);
  ascent_destroy(&a);
  return st;
}
