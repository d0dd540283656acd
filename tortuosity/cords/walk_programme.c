/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A linear programme over the walks that the cords of one component can be, below a limit on their
 * turning or their length. Internal to tortuosity/.
 *
 * A column for every walk between nodes where cords may end, or every closed one, at the cost of 1:
 * a cord. Every edge needs its passes; at a node where their number is odd, passes and ends are one
 * more; all cords together turn by the least that cords do, or are as long as they must be. What is
 * solved is the dual, whose variables are prices (graph/plan/walk_proof.h) and whose rows, one for
 * every walk, are found by the recursion that checks the proof (P. C. Gilmore & R. E. Gomory 1961).
 * It goes by prices between the last optimum and the best so far, where optima alone would swing
 * (P. Wentges 1997); any prices give a valid bound (A. A. Farley 1990), which ends most searches
 * early. Optima are corners, by the simplex method, or near the middle
 * (tortuosity/cords/walk_centre.c). */
#include "graph/framework/frame.h"
#include "lp/solver/lp.h"
#include "tortuosity/cords/walk_model.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  FEWEST_BITS = 20,       /* of a price */
  MOST_PRICE = 200,       /* lengths of the longest edge that a pass costs at most, with a pull */
  MOST_ENTRIES = 1 << 23, /* of the recursion's table */
  MOST_UNITS = 4000,
  FEWEST_UNITS = 100,
  MOST_STARTS = 400, /* first passes that one look at the prices goes through, of a recursion */
  MOST_WALKS = 40,   /* that it adds */
  SOME_WALKS = 16    /* of several recursions: the others are not looked at then */
};

static const double one = 4294967296.0;    /* 1 in the integers of a proof */
static const double most_steps = 2e8;      /* of all recursions for a look at the prices */
static const double most_pull_steps = 3e7; /* where they are about all cords, and look longer */
static const double per_step = 1e-9;       /* seconds */

/* ---- set up ---- */

/* A unit of which at most so many make up the whole, and of those up to twice as large the one of
 * which most turns, or edges, of the cord are nearly whole numbers; of lengths no longer than any
 * edge. */
static int64_t choose_unit(const thr_walk_programme *p, thr_walk_measure measure,
                           const thr_cord *cord, double whole, int units)
{
  enum { CANDIDATES = 256 };
  const thr_frame *frame = p->c->f;
  double smallest = whole / units, least_loss = INFINITY, unit = smallest, most = INFINITY;
  for (int e = 0; e < frame->n_edges && measure == THR_WALK_LENGTH; e++)
    if (p->c->component[frame->edge[e][0]] == p->component) most = fmin(most, frame->length[e]);
  for (int i = 0; i < CANDIDATES; i++) {
    double candidate = fmin(smallest * (1 + (double)i / CANDIDATES), most), loss = 0;
    for (int k = -1; k < thr_walk_priced_passes(p->c, measure, cord); k++) {
      double part = thr_walk_pass_price(p->c, measure, cord, k) / candidate;
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
  bool length = measure == THR_WALK_LENGTH, pull = measure == THR_WALK_PULL;
  for (int v = 0; v < columns->f->n_nodes; v++) {
    double degree = thr_degree(columns->f, v);
    if (columns->component[v] != component) continue;
    nodes++;
    halves += degree;
    squares += degree * degree;
  }
  double runs = columns->task->end_allowed ? 1 : length || pull ? nodes : halves / 2;
  double steps = pull ? most_pull_steps : most_steps;
  double units =
      fmin(MOST_ENTRIES / (length ? nodes : halves), steps / ((length ? halves : squares) * runs));
  return (int)fmin(units, MOST_UNITS);
}

/* The variable that the lowest of its images has, or a new one (of -1); more stands on its right
 * side. */
static int number_of(thr_walk_programme *p, int lowest, double right)
{
  const int j = lowest < 0 ? p->n_variables++ : lowest;
  p->right[j] = (lowest < 0 ? 0 : p->right[j]) + right;
  return j;
}

/* edge, node: as for thr_walk_programme_merge, or NULL. */
static void number_variables(thr_walk_programme *p, const int *edge, const int *node)
{
  const thr_frame *frame = p->c->f;
  p->n_variables = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    const int lowest = edge ? edge[e] : e;
    const bool here = p->c->component[frame->edge[e][0]] == p->component;
    p->edge[e] = here ? number_of(p, lowest < e ? p->edge[lowest] : -1, p->c->cover[e]) : -1;
  }
  p->n_edges = p->n_variables;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int64_t needed = thr_walk_needed_at(p->c, v);
    const int lowest = node ? node[v] : v;
    const bool here = p->c->component[v] == p->component && needed % 2;
    p->node[v] = here ? number_of(p, lowest < v ? p->node[lowest] : -1, (double)needed + 1) : -1;
  }
  if (p->least > 0) p->right[p->n_variables++] = 1;
  if (p->lengths) p->right[p->n_variables++] = -p->cords;
}

static thr_status allocate(thr_walk_programme *p, thr_err *err)
{
  size_t n = (size_t)p->c->f->n_nodes, m = (size_t)p->c->f->n_edges, most = n + m + 1,
         places = (size_t)p->steps.n;
  p->edge = thr_scratch_array(&p->own, m, sizeof *p->edge);
  p->node = thr_scratch_array(&p->own, n, sizeof *p->node);
  p->right = thr_scratch_array(&p->own, most, sizeof *p->right);
  p->upper = thr_scratch_array(&p->own, most, sizeof *p->upper);
  p->passed = thr_scratch_array(&p->own, m, sizeof *p->passed);
  p->x = thr_scratch_array(&p->own, most, sizeof *p->x);
  p->middle = thr_scratch_array(&p->own, most, sizeof *p->middle);
  p->try = thr_scratch_array(&p->own, most, sizeof *p->try);
  p->start = thr_scratch_array(&p->own, MOST_STARTS, sizeof *p->start);
  size_t entries =
      (size_t)thr_walk_levels(p->most_units) * places * thr_walk_tables(p->steps.measure);
  p->value = thr_calloc(entries, sizeof *p->value);
  p->half = thr_scratch_array(&p->own, entries, sizeof *p->half);
  p->trial.edge = thr_calloc(m, sizeof *p->trial.edge);
  p->trial.node = thr_calloc(n, sizeof *p->trial.node);
  if (!p->value || !p->trial.edge || !p->trial.node) return thr_nomem(err);
  return thr_scratch_check(&p->own, err);
}

static thr_status init(thr_walk_programme *p, const thr_turning_columns *columns,
                       thr_walk_measure measure, const thr_cord *cord, int n_cords,
                       const thr_cord *most, double whole, double least, bool lengths,
                       const thr_limits *limits, thr_err *err)
{
  int component = columns->component[thr_tail(columns->f, most->half[0])], here = 0;
  *p = (thr_walk_programme){
      .c = columns, .limits = limits, .component = component, .scale = one, .lengths = lengths};
  for (int i = 0; i < n_cords; i++)
    here += columns->component[thr_tail(columns->f, cord[i].half[0])] == component;
  p->cords = !columns->task->end_count    ? columns->task->cords
             : measure == THR_WALK_LENGTH ? here
                                          : n_cords;
  p->least = least * (1 - 1e-10);
  p->most_units = most_units(columns, measure, component);
  if (p->most_units < FEWEST_UNITS)
    return thr_fail(err, THR_ELIMIT, "the component is too large for walks");
  p->unit = choose_unit(p, measure, most, whole, p->most_units - 1);
  thr_status st = thr_walk_steps_init(&p->steps, columns, measure, component, p->unit, err);
  if (st) return st == THR_EVIOLATED ? THR_ELIMIT : st;
  if ((st = allocate(p, err))) return st;
  p->trial.unit = p->unit;
  p->trial.pulled = measure == THR_WALK_PULL;
  number_variables(p, NULL, NULL);
  return thr_pool_init(&p->walks, p->n_variables, err);
}

thr_status thr_walk_programme_init(thr_walk_programme *p, const thr_turning_columns *columns,
                                   thr_walk_measure measure, const thr_cord *cord, int n_cords,
                                   double least, const thr_limits *limits, thr_err *err)
{
  const thr_cord *most = &cord[thr_walk_dearest(columns, measure, cord, n_cords)];
  return init(p, columns, measure, cord, n_cords, most, thr_walk_price(columns, measure, most),
              least, false, limits, err);
}

/* Prices, of which a pass costs at most most lengths of the longest edge, have as many bits as
 * their sums leave room for. */
static void choose_bits(thr_walk_programme *p, double most)
{
  const int all = 61; /* in 64 bits */
  int passes, price;
  frexp(((double)p->units + 2) * (p->steps.n + 1), &passes);
  frexp(5 * most, &price); /* a pass, its nodes, an end, and a length */
  const int bits = all - price - passes;
  p->trial.bits = bits < THR_TURNING_BITS ? bits : THR_TURNING_BITS;
  p->scale = ldexp(p->longest,
                   thr_walk_exponent(p->c->f, THR_WALK_LENGTH) - THR_TURNING_BITS + p->trial.bits);
}

thr_status thr_walk_programme_init_pull(thr_walk_programme *p, const thr_turning_columns *columns,
                                        const thr_request *options, const thr_cord *cord,
                                        int n_cords, int component, bool lengths,
                                        const thr_limits *limits, thr_err *err)
{
  const thr_cord *most = NULL;
  for (int i = 0; i < n_cords; i++)
    if (columns->component[thr_tail(columns->f, cord[i].half[0])] == component &&
        (!most || thr_walk_price(columns, THR_WALK_PULL, &cord[i]) >
                      thr_walk_price(columns, THR_WALK_PULL, most)))
      most = &cord[i];
  *p = (thr_walk_programme){0};
  if (!most) return THR_ELIMIT;
  const double half = thr_request_most_pulled(options);
  thr_status st =
      init(p, columns, THR_WALK_PULL, cord, n_cords, most, half, 0, lengths, limits, err);
  if (st) return st;
  p->units = thr_walk_pull_units(options, p->unit);
  for (int e = 0; e < columns->f->n_edges; e++)
    if (p->edge[e] >= 0) p->longest = fmax(p->longest, columns->f->length[e]);
  p->dearest = MOST_PRICE;
  if (lengths) choose_bits(p, p->dearest);
  if (p->units > p->most_units || (lengths && p->trial.bits < FEWEST_BITS))
    return thr_fail(err, THR_ELIMIT, "the component is too large for walks");
  return THR_OK;
}

thr_status thr_walk_programme_merge(thr_walk_programme *p, const int *edge, const int *node,
                                    thr_err *err)
{
  number_variables(p, edge, node);
  thr_pool_destroy(&p->walks);
  return thr_pool_init(&p->walks, p->n_variables, err);
}

void thr_walk_programme_destroy(thr_walk_programme *p)
{
  thr_walk_steps_destroy(&p->steps);
  thr_walk_proof_destroy(&p->trial);
  thr_search_destroy(&p->search);
  thr_pool_destroy(&p->walks);
  thr_walk_memory_free(p->memory, p->n_memories);
  free(p->value);
  thr_scratch_free(&p->own);
}

double thr_walk_programme_price(const thr_walk_programme *p, int units)
{
  return ldexp((double)p->unit * units, -p->steps.exponent) * (1 - 1e-15);
}

/* ---- walks at given prices ---- */

static int64_t whole(double price, double scale)
{
  return price > 0 ? (int64_t)floor(price * scale) : 0;
}

/* The variables as the prices of a proof. */
static thr_status set_trial(thr_walk_programme *p, const double *x, thr_err *err)
{
  for (int e = 0; e < p->c->f->n_edges; e++)
    p->trial.edge[e] = p->edge[e] >= 0 ? whole(x[p->edge[e]], p->scale) : 0;
  for (int v = 0; v < p->c->f->n_nodes; v++)
    p->trial.node[v] = p->node[v] >= 0 ? whole(x[p->node[v]], p->scale) : 0;
  p->trial.all =
      p->least > 0
          ? whole(ldexp(x[p->n_variables - 1] / p->least, THR_TURNING_BITS - p->steps.exponent),
                  one)
          : 0;
  p->trial.units = p->units;
  return thr_walk_steps_price(&p->steps, &p->trial, err);
}

/* Worth of the best walk with a first pass; below 0: there is none. */
static int64_t worth_of(const thr_walk_programme *p, const thr_walk_step *first)
{
  return thr_walk_worth(first, p->units, thr_walk_levels(p->units), p->value);
}

/* Of the recursion; last: after the cut turn, if a pull counts. */
static const int64_t *table_of(const thr_walk_programme *p, bool last)
{
  const size_t entries = (size_t)thr_walk_levels(p->units) * (size_t)p->steps.n;
  return p->value + (last && p->steps.measure == THR_WALK_PULL ? entries : 0);
}

/* What a walk of a recursion is worth from place i on that goes no further there, or not before its
 * cut turn; last: after that turn, if a pull counts. */
static int64_t end_worth(const thr_walk_programme *p, int run, int i, bool last)
{
  const thr_walk_steps *steps = &p->steps;
  if (!last) return steps->cut[i];
  if (!steps->closed) return steps->end[i];
  bool home = steps->n_homes > 0
                  ? steps->group[i] == thr_tail(p->c->f, steps->begin[steps->from[run]].half)
                  : steps->spot[i] == steps->spot[steps->begin[run].to];
  return home ? 0 : INT64_MIN;
}

/* The step that the best walk takes from place i with so many units left; NULL: it ends there, or
 * its cut turn is there. */
static const thr_walk_step *best_step(const thr_walk_programme *p, int run, int i, int units,
                                      bool last)
{
  const thr_walk_steps *steps = &p->steps;
  const int64_t *table = table_of(p, last);
  const int levels = thr_walk_levels(p->units);
  const thr_walk_step *best = NULL;
  int64_t most = end_worth(p, run, i, last);
  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const thr_walk_step *step = &steps->step[k];
    if (step->units > units) continue;
    const int64_t on = table[thr_walk_entry(step->to, units - step->units, levels)];
    if (thr_walk_is_none(on) || on + step->worth <= most) continue;
    most = on + step->worth;
    best = step;
  }
  return best;
}

/* The step of the best walk over its cut turn at place i; NULL: it ends there. */
static const thr_walk_step *cut_step(const thr_walk_programme *p, int run, int i)
{
  const thr_walk_steps *steps = &p->steps;
  const thr_walk_step *best = NULL;
  int64_t most = end_worth(p, run, i, true);
  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const int64_t on =
        table_of(p, true)[thr_walk_entry(steps->step[k].to, p->units, thr_walk_levels(p->units))];
    if (thr_walk_is_none(on) || on + steps->step[k].worth <= most) continue;
    most = on + steps->step[k].worth;
    best = &steps->step[k];
  }
  return best;
}

static void put_node(const thr_walk_programme *p, thr_pool *pool, int v)
{
  if (p->node[v] >= 0) thr_pool_put(pool, p->node[v], -1);
}

/* The place of a walk before its pass number first that may be known. */
static int place_before(const thr_walk_programme *p, const int *half, int n, int first)
{
  return first ? thr_walk_begun(&p->steps, half[0]) : thr_walk_closed(&p->steps, half[n - 1]);
}

/* Goes on from a place over a half-edge; is that a pass that the walk knows of? */
static bool go_on(const thr_walk_programme *p, int half, int *place)
{
  const thr_walk_steps *steps = &p->steps;
  int k = steps->first[*place];
  while (steps->step[k].half != half)
    k++;
  *place = steps->step[k].to;
  return steps->step[k].known;
}

thr_row thr_walk_programme_row(const thr_walk_programme *p, thr_pool *pool, const int *half, int n)
{
  const thr_frame *frame = p->c->f;
  const int first = p->steps.closed && p->steps.n_homes == 0 ? 0 : 1;
  thr_row row = {.lower = -1, .member = (int *)half, .n_members = n}; /* copied by the pool */
  int place = p->n_memories > 0 ? place_before(p, half, n, first) : -1;
  double length = 0;
  for (int k = 0; k < n; k++) {
    const bool known = place >= 0 && k >= first && go_on(p, half[k], &place);
    if (!known) thr_pool_put(pool, p->edge[half[k] >> 1], -1);
    put_node(p, pool, thr_tail(frame, half[k]));
    put_node(p, pool, thr_head(frame, half[k]));
    length += frame->length[half[k] >> 1];
  }
  if (!p->steps.closed) {
    put_node(p, pool, thr_tail(frame, half[0]));
    put_node(p, pool, thr_head(frame, half[n - 1]));
  }
  if (!p->lengths) return row;
  row.lower = -length / p->longest;
  thr_pool_put(pool, p->n_variables - 1, 1);
  return row;
}

typedef struct {
  int n, units;  /* passes, in p->half; with a pull units are those of the larger side of the cut
                    turn */
  double weight; /* of its turns, or its length */
} traced;

/* The best walk of a recursion with a first pass. */
static traced trace_walk(thr_walk_programme *p, int run, const thr_walk_step *step)
{
  traced walk = {0};
  int left = p->units;
  bool last = p->steps.measure != THR_WALK_PULL;
  while (step) {
    const int i = step->to;
    p->half[walk.n++] = step->half;
    left -= step->units;
    if (p->units - left > walk.units) walk.units = p->units - left;
    walk.weight += (double)step->weight;
    step = best_step(p, run, i, left, last);
    if (step || last) continue;
    last = true;
    step = cut_step(p, run, i);
    left = p->units + (step ? step->units : 0);
  }
  return walk;
}

/* Its row, put together. */
static thr_row row_of(thr_walk_programme *p, const traced *walk)
{
  thr_row row = thr_walk_programme_row(p, &p->search.pool, p->half, walk->n);
  row.index = walk->units;
  if (p->least > 0)
    thr_pool_put(&p->search.pool, p->n_variables - 1,
                 -ldexp(walk->weight, -p->steps.exponent) / p->least);
  return row;
}

/* Of a recursion, the first passes of the walks that are worth most, in that order; returns their
 * number. */
static int sort_starts(thr_walk_programme *p, int run, int most)
{
  const thr_walk_step *first;
  int n = 0, count = thr_walk_firsts(&p->steps, run, &first);
  for (int i = 0; i < count; i++) {
    const thr_walk_start here = {worth_of(p, &first[i]), &first[i]};
    int k = n < most ? n++ : most;
    for (; k > 0 && p->start[k - 1].worth < here.worth; k--)
      if (k < most) p->start[k] = p->start[k - 1];
    if (k < most) p->start[k] = here;
  }
  return n;
}

/* What they prove of the length of all cords within a limit on the pull. */
static void judge_lengths(thr_walk_programme *p, const double *x, int64_t worth)
{
  const double bound = thr_walk_pull_bound(&p->steps, &p->trial, p->cords, worth);
  if (bound <= p->best) return;
  p->best = bound;
  for (int j = 0; j < p->n_variables; j++)
    p->middle[j] = x[j];
  p->excluded = bound >= p->enough * (1 - 1e-9);
}

/* What the best walk is said to be worth where none is: a small part of what a pass may cost, so
 * that more cords are too few than any plan has. */
static double least_worth(const thr_walk_programme *p)
{
  return 0x1p-12 * one * p->upper[0];
}

/* What these prices, of which a walk is worth so much at most, prove. Where none is worth anything
 * they prove it at any scale. */
static void judge_prices(thr_walk_programme *p, const double *x, double worth)
{
  const double scale = worth > least_worth(p) ? worth : one * p->upper[0];
  double needed = thr_walk_needed(&p->steps, &p->trial, p->least);
  p->excluded =
      needed > p->cords * worth * (1 + 1e-9) && thr_walk_component(p->c, &p->trial) == p->component;
  if (needed / worth <= p->best) return;
  p->best = needed / worth;
  for (int j = 0; j < p->n_variables; j++)
    p->middle[j] = x[j] * one / scale;
}

/* Notes the passes of a walk; are less than a tenth of them new? Then it is much like those of this
 * look. */
static bool is_like_others(thr_walk_programme *p, int n)
{
  int old = 0;
  for (int k = 0; k < n; k++)
    old += p->passed[p->edge[p->half[k] >> 1]];
  if (10 * old > 9 * n) return true;
  for (int k = 0; k < n; k++)
    p->passed[p->edge[p->half[k] >> 1]] = true;
  return false;
}

/* The walks of a recursion that are worth most, as far as the last optimum does not know them.
 * *most: what any is worth. */
static thr_status price_run(thr_walk_programme *p, int run, int64_t *most, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  thr_walk_run(&p->steps, run, p->units, thr_walk_levels(p->units), p->value);
  thr_limits_spend(p->limits, per_step * p->units * p->steps.first[p->steps.n] *
                                  (double)thr_walk_tables(p->steps.measure));
  const int n = sort_starts(p, run, p->steps.closed ? 1 : MOST_STARTS);
  if (n > 0 && p->start[0].worth > *most) *most = p->start[0].worth;
  memset(p->passed, 0, (size_t)p->c->f->n_edges * sizeof *p->passed);
  for (int i = 0, taken = 0; i < n && taken < MOST_WALKS && !st && p->start[i].worth > 0; i++) {
    const traced walk = trace_walk(p, run, p->start[i].first);
    if (is_like_others(p, walk.n)) continue;
    st = thr_pool_offer(&p->search.pool, row_of(p, &walk), p->x, 1e-6, added, err);
    taken++;
  }
  return st;
}

/* All recursions say what the prices prove; or those from where the last look ended until there are
 * some walks. */
thr_status thr_walk_programme_look(thr_walk_programme *p, const double *x, int *added, thr_err *err)
{
  thr_status st = set_trial(p, x, err);
  int64_t most = p->lengths ? 0 : (int64_t)least_worth(p);
  if (st) return st == THR_EVIOLATED ? THR_OK : st;
  const int runs = thr_walk_runs(&p->steps);
  for (int i = 0; i < runs && !st; i++) {
    p->run = (p->run + 1) % runs;
    st = price_run(p, p->run, &most, added, err);
    if (*added >= SOME_WALKS && i + 1 < runs) return st;
  }
  if (p->to_exclude && !st && p->lengths) judge_lengths(p, x, most);
  if (p->to_exclude && !st && !p->lengths) judge_prices(p, x, (double)most);
  return st;
}

thr_status thr_walk_programme_find(thr_walk_programme *p, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  if (p->to_exclude && p->best > 0) {
    for (int j = 0; j < p->n_variables; j++)
      p->try[j] = .3 * p->x[j] + .7 * p->middle[j];
    st = thr_walk_programme_look(p, p->try, added, err);
  }
  return st || p->excluded || *added > 0 ? st : thr_walk_programme_look(p, p->x, added, err);
}

static thr_status find_walks(void *user, int *added, thr_err *err)
{
  return thr_walk_programme_find(user, added, err);
}

void thr_walk_programme_round_up(thr_walk_programme *p, double per_cord)
{
  thr_walk_steps *steps = &p->steps;
  const double rounding = 2e-9; /* twice what the unit is less than turns of whole numbers of it */
  for (int d = 0; d < 2 * p->c->f->n_edges; d++) {
    const int i = steps->place[d];
    for (int k = i < 0 ? 0 : steps->first[i]; i >= 0 && k < steps->first[i + 1]; k++) {
      thr_walk_step *step = &steps->step[k];
      step->units = (int)ceil((double)step->weight / (double)p->unit * (1 - rounding));
    }
  }
  p->per_cord = per_cord;
  p->dearest = 2 * per_cord;
  choose_bits(p, p->dearest);
}

thr_status thr_walk_programme_middle(thr_walk_programme *p, thr_err *err)
{
  return set_trial(p, p->middle, err);
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
    st = thr_pool_add(to,
                      (thr_row){.name = row->name,
                                .index = row->index,
                                .lower = row->lower,
                                .n_members = row->n_members,
                                .member = row->member},
                      err);
  }
  return st;
}

thr_status thr_walk_programme_begin(thr_walk_programme *p, int units, double price, thr_err *err)
{
  double *cost = thr_calloc((size_t)p->n_variables, sizeof *cost);
  thr_status st = cost ? thr_search_init(&p->search, p->n_variables, p->x, err) : thr_nomem(err);
  p->units = units;
  p->excluded = false;
  p->best = 0;
  for (int j = 0; j < p->n_variables && !st; j++) {
    cost[j] = -p->right[j];
    p->upper[j] = j + 1 == p->n_variables && p->least > 0 ? 2 * p->cords : price;
  }
  if (!st) st = thr_lp_create(&p->search.lp, p->n_variables, cost, p->upper, err);
  if (!st && p->per_cord > 0)
    st = thr_lp_set_bounds(p->search.lp, p->n_variables - 1, p->per_cord, p->per_cord, err);
  if (!st) st = carry_walks(&p->walks, units, &p->search.pool, err);
  if (!st) thr_search_use(&p->search, find_walks, p, THR_SLOW);
  free(cost);
  return st;
}

/* No more cords are needed than there are? */
static thr_status look(void *user, thr_err *err)
{
  thr_walk_programme *p = user;
  const double value = -p->search.objective, near = 1e-9;
  (void)err;
  const double most =
      p->enough > 0 ? p->enough : p->cords; /* of cords, where their number counts */
  const bool enough =
      p->lengths ? p->best >= value * p->longest * (1 - near) : value <= most * (1 + near);
  p->search.enough = p->to_exclude && p->search.outcome == THR_LP_OPTIMAL && enough;
  return THR_OK;
}

thr_status thr_walk_programme_add(thr_walk_programme *p, const thr_cord *cord, thr_err *err)
{
  return thr_pool_add(&p->search.pool,
                      thr_walk_programme_row(p, &p->search.pool, cord->half, cord->n_passes), err);
}

thr_status thr_walk_programme_rounds(thr_walk_programme *p, int most_rounds, thr_err *err)
{
  const thr_search_calls calls = {.user = p, .look = look, .most_rounds = most_rounds};
  return thr_search_rounds(&p->search, &calls, p->limits, err);
}

thr_status thr_walk_programme_end(thr_walk_programme *p, thr_err *err)
{
  thr_status st = carry_walks(&p->search.pool, p->units, &p->walks, err);
  thr_search_destroy(&p->search);
  return st;
}
