/* Rows for walks, found by the recursion. */
#include "tortuosity/cords/walk_programme.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/model/pool.h"
#include "lp/model/search.h"
#include "lp/solver/lp.h"

#include <math.h>
#include <stdlib.h>

enum {
  MOST_ENTRIES = 1 << 23, /* of the recursion's table */
  MOST_UNITS = 4000,
  FEWEST_UNITS = 100,
  MOST_WALKS = 40, /* that one look at the prices adds, of a recursion */
  PATIENCE = 30    /* rounds after which a walk that is not needed is forgotten */
};

static const double one = 4294967296.0; /* 1 in the integers of a proof */
static const double most_steps = 2e8;   /* of all recursions for a look at the prices */
static const double per_step = 2e-9;    /* seconds */

/* What the pass after number k of a cord, or the first one for k = -1, adds to it. */
static double pass_price(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord, int k)
{
  int out = cord->half[(k + 1) % cord->n_passes];
  if (measure == THR_WALK_LENGTH) return columns->f->length[out >> 1];
  return k < 0 ? 0 : thr_turn_price(columns->f, columns->task->cost, cord->half[k], out);
}

/* Of the passes from number -1 on that have a price: closed cords turn where they close, too. */
static int priced_passes(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord)
{
  return cord->n_passes - (measure == THR_WALK_LENGTH || columns->task->end_allowed);
}

double thr_walk_price(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord)
{
  double price = 0;
  for (int k = -1; k < priced_passes(columns, measure, cord); k++)
    price += pass_price(columns, measure, cord, k);
  return price;
}

int thr_walk_dearest(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord, int n_cords)
{
  double most = -1;
  int dearest = 0;
  for (int i = 0; i < n_cords; i++) {
    double price = thr_walk_price(columns, measure, &cord[i]);
    if (price > most) dearest = i;
    most = fmax(most, price);
  }
  return dearest;
}

/* ---- set up ---- */

/* A unit of which at most so many make up the cord, and of those up to twice as large the one of which most turns, or edges, of
 * the cord are nearly whole numbers; of lengths no longer than any edge. */
static int64_t choose_unit(const thr_walk_programme *p, thr_walk_measure measure, const thr_cord *cord, int units)
{
  enum { CANDIDATES = 256 };
  const thr_frame *frame = p->c->f;
  double smallest = thr_walk_price(p->c, measure, cord) / units, least_loss = INFINITY, unit = smallest, most = INFINITY;
  for (int e = 0; e < frame->n_edges && measure == THR_WALK_LENGTH; e++)
    if (p->c->component[frame->edge[e][0]] == p->component) most = fmin(most, frame->length[e]);
  for (int i = 0; i < CANDIDATES; i++) {
    double candidate = fmin(smallest * (1 + (double)i / CANDIDATES), most), loss = 0;
    for (int k = -1; k < priced_passes(p->c, measure, cord); k++) {
      double part = pass_price(p->c, measure, cord, k) / candidate;
      loss += candidate * (part + 1e-9 - floor(part + 1e-9));
    }
    if (loss < least_loss) {
      least_loss = loss;
      unit = candidate;
    }
  }
  return (int64_t)floor(ldexp(unit, thr_walk_exponent(frame, measure)) * (1 - 1e-9));
}

/* As many as the recursions take in a moment. */
static int most_units(const thr_turning_columns *columns, thr_walk_measure measure, int component)
{
  double halves = 0, squares = 0, nodes = 0;
  bool length = measure == THR_WALK_LENGTH;
  for (int v = 0; v < columns->f->n_nodes; v++) {
    double degree = thr_degree(columns->f, v);
    if (columns->component[v] != component) continue;
    nodes++;
    halves += degree;
    squares += degree * degree;
  }
  double runs = columns->task->end_allowed ? 1 : length ? nodes : halves / 2;
  double units = fmin(MOST_ENTRIES / (length ? nodes : halves), most_steps / ((length ? halves : squares) * runs));
  return (int)fmin(units, MOST_UNITS);
}

static void number_variables(thr_walk_programme *p)
{
  const thr_frame *frame = p->c->f;
  for (int e = 0; e < frame->n_edges; e++) {
    p->edge[e] = p->c->component[frame->edge[e][0]] == p->component ? p->n_variables : -1;
    if (p->edge[e] >= 0) p->right[p->n_variables++] = p->c->cover[e];
  }
  p->n_edges = p->n_variables;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int64_t needed = thr_walk_needed_at(p->c, v);
    p->node[v] = p->c->component[v] == p->component && needed % 2 ? p->n_variables : -1;
    if (p->node[v] >= 0) p->right[p->n_variables++] = (double)needed + 1;
  }
  if (p->least > 0) p->right[p->n_variables++] = 1;
}

static thr_status allocate(thr_walk_programme *p, thr_err *err)
{
  size_t n = (size_t)p->c->f->n_nodes, m = (size_t)p->c->f->n_edges, most = n + m + 1, places = (size_t)p->steps.n;
  p->edge = thr_scratch_array(&p->own, m, sizeof *p->edge);
  p->node = thr_scratch_array(&p->own, n, sizeof *p->node);
  p->right = thr_scratch_array(&p->own, most, sizeof *p->right);
  p->x = thr_scratch_array(&p->own, most, sizeof *p->x);
  p->middle = thr_scratch_array(&p->own, most, sizeof *p->middle);
  p->try = thr_scratch_array(&p->own, most, sizeof *p->try);
  p->start = thr_scratch_array(&p->own, MOST_WALKS, sizeof *p->start);
  p->value = thr_scratch_array(&p->own, ((size_t)p->most_units + 1) * places, sizeof *p->value);
  p->half = thr_scratch_array(&p->own, ((size_t)p->most_units + 1) * places, sizeof *p->half);
  p->trial.edge = thr_calloc(m, sizeof *p->trial.edge);
  p->trial.node = thr_calloc(n, sizeof *p->trial.node);
  if (!p->trial.edge || !p->trial.node) return thr_nomem(err);
  return thr_scratch_check(&p->own, err);
}

thr_status thr_walk_programme_init(thr_walk_programme *p, const thr_turning_columns *columns, thr_walk_measure measure,
                                   const thr_cord *cord, int n_cords, double least, const thr_limits *limits, thr_err *err)
{
  const thr_cord *most = &cord[thr_walk_dearest(columns, measure, cord, n_cords)];
  int component = columns->component[thr_tail(columns->f, most->half[0])], here = 0;
  *p = (thr_walk_programme){.c = columns, .limits = limits, .component = component};
  for (int i = 0; i < n_cords; i++)
    here += columns->component[thr_tail(columns->f, cord[i].half[0])] == component;
  p->cords = !columns->task->end_count ? columns->task->cords : measure == THR_WALK_LENGTH ? here : n_cords;
  p->least = least * (1 - 1e-10);
  p->most_units = most_units(columns, measure, component);
  if (p->most_units < FEWEST_UNITS) return thr_fail(err, THR_ELIMIT, "the component is too large for walks");
  p->unit = choose_unit(p, measure, most, p->most_units - 1);
  thr_status st = thr_walk_steps_init(&p->steps, columns, measure, component, p->unit, err);
  if (st) return st == THR_EVIOLATED ? THR_ELIMIT : st;
  if ((st = allocate(p, err))) return st;
  p->trial.unit = p->unit;
  number_variables(p);
  return thr_pool_init(&p->walks, p->n_variables, err);
}

void thr_walk_programme_destroy(thr_walk_programme *p)
{
  thr_walk_steps_destroy(&p->steps);
  thr_walk_proof_destroy(&p->trial);
  thr_search_destroy(&p->search);
  thr_pool_destroy(&p->walks);
  thr_scratch_free(&p->own);
}

double thr_walk_programme_price(const thr_walk_programme *p, int units)
{
  return ldexp((double)p->unit * units, -p->steps.exponent) * (1 - 1e-15);
}

/* ---- walks at given prices ---- */

static int64_t whole(double price)
{
  return price > 0 ? (int64_t)floor(price * one) : 0;
}

/* The variables as the prices of a proof. */
static thr_status set_trial(thr_walk_programme *p, const double *x, thr_err *err)
{
  for (int e = 0; e < p->c->f->n_edges; e++)
    p->trial.edge[e] = p->edge[e] >= 0 ? whole(x[p->edge[e]]) : 0;
  for (int v = 0; v < p->c->f->n_nodes; v++)
    p->trial.node[v] = p->node[v] >= 0 ? whole(x[p->node[v]]) : 0;
  p->trial.all = p->least > 0 ? whole(ldexp(x[p->n_variables - 1] / p->least, THR_TURNING_BITS - p->steps.exponent)) : 0;
  p->trial.units = p->units;
  return thr_walk_steps_price(&p->steps, &p->trial, err);
}

/* Worth of the best walk with a first pass; below 0: there is none. */
static int64_t worth_of(const thr_walk_programme *p, const thr_walk_step *first)
{
  return thr_walk_worth(&p->steps, first, p->units, p->units + 1, p->value);
}

/* The step that the best walk takes from place i with so many units left; NULL: it ends there. */
static const thr_walk_step *best_step(const thr_walk_programme *p, int i, int units, int home)
{
  const thr_walk_steps *steps = &p->steps;
  const thr_walk_step *best = NULL;
  int64_t most = i == home ? 0 : steps->end[i];
  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const thr_walk_step *step = &steps->step[k];
    if (step->units > units) continue;
    int64_t here = p->value[(size_t)(units - step->units) * (size_t)steps->n + (size_t)step->to] + step->worth;
    if (here <= most || here < 0) continue;
    most = here;
    best = step;
  }
  return best;
}

static void put_node(thr_walk_programme *p, int v)
{
  if (p->node[v] >= 0) thr_pool_put(&p->search.pool, p->node[v], -1);
}

/* Puts together the row of the best walk with a first pass, as thr_row.index and member say. home: the place where it closes, -1:
 * it is open. */
static thr_row put_walk(thr_walk_programme *p, const thr_walk_step *step, int home)
{
  const thr_frame *frame = p->c->f;
  thr_row row = {.lower = -1, .member = p->half};
  double all = 0;
  if (home < 0) put_node(p, thr_tail(frame, step->half));
  for (int i = 0; step; step = best_step(p, i, p->units - row.index, home)) {
    p->half[row.n_members++] = step->half;
    thr_pool_put(&p->search.pool, p->edge[step->half >> 1], -1);
    put_node(p, thr_tail(frame, step->half));
    put_node(p, thr_head(frame, step->half));
    row.index += step->units;
    all += (double)step->weight;
    i = step->to;
  }
  if (home < 0) put_node(p, thr_head(frame, p->half[row.n_members - 1]));
  if (p->least > 0) thr_pool_put(&p->search.pool, p->n_variables - 1, -ldexp(all, -p->steps.exponent) / p->least);
  return row;
}

/* Of a recursion, the first passes of the walks that are worth most, in that order; returns their number. */
static int sort_starts(thr_walk_programme *p, int run, int most)
{
  const thr_walk_step *first;
  int n = 0, count = thr_walk_firsts(&p->steps, run, &first);
  for (int i = 0; i < count; i++) {
    int64_t worth = worth_of(p, &first[i]);
    int k = n < most ? n++ : most;
    for (; k > 0 && worth_of(p, p->start[k - 1]) < worth; k--)
      if (k < most) p->start[k] = p->start[k - 1];
    if (k < most) p->start[k] = &first[i];
  }
  return n;
}

/* What these prices, of which a walk is worth so much at most, prove. */
static void judge_prices(thr_walk_programme *p, const double *x, double worth)
{
  double needed = thr_walk_needed(&p->steps, &p->trial, p->least);
  p->excluded = needed > p->cords * worth * (1 + 1e-9) && thr_walk_component(p->c, &p->trial) == p->component;
  if (needed / worth <= p->best) return;
  p->best = needed / worth;
  for (int j = 0; j < p->n_variables; j++)
    p->middle[j] = x[j] * one / worth;
}

/* The walks that are worth most at these prices, as far as the last optimum does not know them. */
static thr_status price_walks(thr_walk_programme *p, const double *x, int *added, thr_err *err)
{
  thr_status st = set_trial(p, x, err);
  const bool closed = p->steps.closed;
  double most = 1;
  if (st) return st == THR_EVIOLATED ? THR_OK : st;
  for (int run = 0; run < thr_walk_runs(&p->steps) && !st; run++) {
    thr_walk_run(&p->steps, run, p->units, p->units + 1, p->value);
    thr_limits_spend(p->limits, per_step * p->units * p->steps.first[p->steps.n]);
    int n = sort_starts(p, run, closed ? 1 : MOST_WALKS);
    if (n > 0) most = fmax(most, (double)worth_of(p, p->start[0]));
    for (int i = 0; i < n && !st && worth_of(p, p->start[i]) > 0; i++)
      st =
          thr_pool_offer(&p->search.pool, put_walk(p, p->start[i], closed ? p->steps.begin[run].to : -1), p->x, 1e-6, added, err);
  }
  if (p->to_exclude && !st) judge_prices(p, x, most);
  return st;
}

static thr_status find_walks(void *user, int *added, thr_err *err)
{
  thr_walk_programme *p = user;
  thr_status st = THR_OK;
  if (p->to_exclude && p->best > 0) {
    for (int j = 0; j < p->n_variables; j++)
      p->try[j] = .3 * p->x[j] + .7 * p->middle[j];
    st = price_walks(p, p->try, added, err);
  }
  return st || p->excluded || *added > 0 ? st : price_walks(p, p->x, added, err);
}

/* ---- a limit ---- */

/* Rows of walks of at most so many units from pool to pool. */
static thr_status carry_walks(const thr_pool *from, int units, thr_pool *to, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < from->count && !st; i++) {
    const thr_row *row = &from->row[i];
    if (row->index > units || thr_pool_knows(to, row->name)) continue;
    for (int k = 0; k < row->n; k++)
      thr_pool_put(to, row->column[k], row->value ? row->value[k] : 1);
    st = thr_pool_add(
        to, (thr_row){.name = row->name, .index = row->index, .lower = -1, .n_members = row->n_members, .member = row->member},
        err);
  }
  return st;
}

thr_status thr_walk_programme_begin(thr_walk_programme *p, int units, double price, thr_err *err)
{
  double *cost = thr_calloc((size_t)p->n_variables, sizeof *cost), *upper = thr_calloc((size_t)p->n_variables, sizeof *upper);
  thr_status st = cost && upper ? thr_search_init(&p->search, p->n_variables, p->x, err) : thr_nomem(err);
  p->units = units;
  p->excluded = false;
  p->best = 0;
  for (int j = 0; j < p->n_variables && !st; j++) {
    cost[j] = -p->right[j];
    upper[j] = j + 1 == p->n_variables && p->least > 0 ? 2 * p->cords : price;
  }
  if (!st) st = thr_lp_create(&p->search.lp, p->n_variables, cost, upper, err);
  if (!st) st = carry_walks(&p->walks, units, &p->search.pool, err);
  if (!st) thr_search_use(&p->search, find_walks, p, THR_SLOW);
  free(cost);
  free(upper);
  return st;
}

/* No more cords are needed than there are? */
static thr_status look(void *user, thr_err *err)
{
  thr_walk_programme *p = user;
  (void)err;
  p->search.enough = p->to_exclude && p->search.outcome == THR_LP_OPTIMAL && -p->search.objective <= p->cords * (1 + 1e-9);
  return THR_OK;
}

thr_status thr_walk_programme_rounds(thr_walk_programme *p, int most_rounds, thr_err *err)
{
  const thr_search_calls calls = {.user = p, .look = look, .most_rounds = most_rounds, .patience = p->to_exclude ? PATIENCE : 0};
  return thr_search_rounds(&p->search, &calls, p->limits, err);
}

thr_status thr_walk_programme_end(thr_walk_programme *p, thr_err *err)
{
  thr_status st = carry_walks(&p->search.pool, p->units, &p->walks, err);
  thr_search_destroy(&p->search);
  return st;
}
