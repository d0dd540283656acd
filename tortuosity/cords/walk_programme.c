/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Builds and solves a linear programme over the walks that the cords of one component can be, below
 * a limit on their turning, their length or their pull. Internal to tortuosity/.
 *
 * The primal programme has a column for every walk between two nodes where cords may end, or for
 * every closed walk. A column costs 1, because a walk is a cord. Rows say that every edge has the
 * passes that it needs; that a node at which an odd number of passes is needed has one more, as
 * passes and cord ends together are even; and that all cords together turn by at least the proved
 * minimum, or are at least as long as the proved minimum. If the optimum is more than the number of
 * cords that there may be, no plan stays below the limit.
 *
 * This file solves the dual: its variables are prices (graph/plan/walk_proof.h), and its rows, one
 * for every walk, are separated by the recursion that checks the proof (column generation: P. C.
 * Gilmore & R. E. Gomory 1961). Rows are separated at prices between the last optimum and the best
 * prices so far, because optima alone swing from round to round (stabilisation: P. Wentges 1997).
 * Any prices give a valid bound once they are scaled (A. A. Farley 1990), and this bound ends most
 * searches early. Optima are vertices from the simplex method, or near the middle
 * (tortuosity/cords/walk_centre.c). */
#include "graph/framework/frame.h"
#include "lp/solver/solver.h"
#include "tortuosity/cords/walk_model.h"

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

/* Returns the unit in which the recursion counts, such that about `units` of them make up the
 * whole. Of candidates up to twice as large the unit is taken that loses least when the turns, or
 * the edges, of the cord are rounded down to whole units. A unit of length is no longer than any
 * edge of the component, so that every pass takes a unit at least. */
static int64_t choose_unit(const thr_walk_programme *programme, thr_walk_measure measure,
                           const thr_cord *cord, double whole, int units)
{
  enum { CANDIDATES = 256 };
  const thr_frame *frame = programme->c->f;
  double smallest = whole / units, least_loss = INFINITY, unit = smallest, most = INFINITY;

  /* Lengths: no candidate may be longer than the shortest edge. */
  for (int e = 0; e < frame->n_edges && measure == THR_WALK_LENGTH; e++)
    if (programme->c->component[frame->edge[e][0]] == programme->component)
      most = fmin(most, frame->length[e]);

  /* Take the candidate with the smallest sum of rounding losses over the cord's passes. */
  for (int i = 0; i < CANDIDATES; i++) {
    double candidate = fmin(smallest * (1 + (double)i / CANDIDATES), most), loss = 0;
    for (int k = -1; k < thr_walk_priced_passes(programme->c, measure, cord); k++) {
      double part = thr_walk_pass_price(programme->c, measure, cord, k) / candidate;
      loss += candidate * (part + 1e-9 - floor(part + 1e-9));
    }
    if (loss < least_loss) {
      least_loss = loss;
      unit = candidate;
    }
  }

  /* Slightly less than the unit, so that turns of exactly so many units are not rounded down by
   * one. */
  return (int64_t)floor(ldexp(unit, thr_walk_exponent(frame, measure)) * (1 - 1e-9));
}

/* Returns the largest number of units for which the table fits into MOST_ENTRIES and all recursions
 * for one look at the prices take no more than most_steps steps; at most MOST_UNITS. */
static int most_units(const thr_turning_columns *columns, thr_walk_measure measure, int component)
{
  double halves = 0, squares = 0, nodes = 0;
  bool length = measure == THR_WALK_LENGTH, pull = measure == THR_WALK_PULL;

  /* A place is a half-edge, or of lengths a node; the steps from all places are the squares of the
   * degrees, or of lengths the degrees. */
  for (int v = 0; v < columns->f->n_nodes; v++) {
    double degree = thr_degree(columns->f, v);
    if (columns->component[v] != component) continue;
    nodes++;
    halves += degree;
    squares += degree * degree;
  }

  /* Open walks take one recursion; closed walks one for every place where they may begin. */
  double runs = columns->task->end_allowed ? 1 : length || pull ? nodes : halves / 2;
  double steps = pull ? most_pull_steps : most_steps;
  double units =
      fmin(MOST_ENTRIES / (length ? nodes : halves), steps / ((length ? halves : squares) * runs));
  return (int)fmin(units, MOST_UNITS);
}

/* Returns the variable that the lowest image of an edge or node has, or a new variable if `lowest`
 * is -1, and adds `right` to the variable's right side. */
static int number_of(thr_walk_programme *programme, int lowest, double right)
{
  const int j = lowest < 0 ? programme->n_variables++ : lowest;
  programme->right[j] = (lowest < 0 ? 0 : programme->right[j]) + right;
  return j;
}

/* Numbers the variables: edges first, then nodes at which an odd number of passes is needed, then
 * the variable of all turning or length (if least > 0), then the price of a cord (if lengths
 * count). Images share a variable: edge and node as for thr_walk_programme_merge, or NULL. */
static void number_variables(thr_walk_programme *programme, const int *edge, const int *node)
{
  const thr_frame *frame = programme->c->f;
  programme->n_variables = 0;

  /* Edges: the right side is the number of needed passes. */
  for (int e = 0; e < frame->n_edges; e++) {
    const int lowest = edge ? edge[e] : e;
    const bool here = programme->c->component[frame->edge[e][0]] == programme->component;
    programme->edge[e] = here ? number_of(programme, lowest < e ? programme->edge[lowest] : -1,
                                          programme->c->cover[e])
                              : -1;
  }

  /* Nodes where this number is odd: one more pass or cord end than needed. */
  programme->n_edges = programme->n_variables;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int64_t needed = thr_walk_needed_at(programme->c, v);
    const int lowest = node ? node[v] : v;
    const bool here = programme->c->component[v] == programme->component && needed % 2;
    programme->node[v] =
        here ? number_of(programme, lowest < v ? programme->node[lowest] : -1, (double)needed + 1)
             : -1;
  }

  /* The variable of all cords together is scaled to least; a cord's price counts against the
   * objective, once for every cord. */
  if (programme->least > 0) programme->right[programme->n_variables++] = 1;
  if (programme->lengths) programme->right[programme->n_variables++] = -programme->cords;
}

/* Allocates the arrays for at most n_nodes + n_edges + 1 variables, the recursion's table for
 * most_units, and the proof in trial. */
static thr_status allocate(thr_walk_programme *programme, thr_err *err)
{
  size_t n = (size_t)programme->c->f->n_nodes, m = (size_t)programme->c->f->n_edges,
         most = n + m + 1, places = (size_t)programme->steps.n;

  /* Variables and points. */
  programme->edge = thr_scratch_array(&programme->own, m, sizeof *programme->edge);
  programme->node = thr_scratch_array(&programme->own, n, sizeof *programme->node);
  programme->right = thr_scratch_array(&programme->own, most, sizeof *programme->right);
  programme->upper = thr_scratch_array(&programme->own, most, sizeof *programme->upper);
  programme->passed = thr_scratch_array(&programme->own, m, sizeof *programme->passed);
  programme->x = thr_scratch_array(&programme->own, most, sizeof *programme->x);
  programme->middle = thr_scratch_array(&programme->own, most, sizeof *programme->middle);
  programme->try = thr_scratch_array(&programme->own, most, sizeof *programme->try);
  programme->start = thr_scratch_array(&programme->own, MOST_STARTS, sizeof *programme->start);

  /* The table, in which a walk has at most as many passes as there are entries. */
  size_t entries = (size_t)thr_walk_levels(programme->most_units) * places *
                   thr_walk_tables(programme->steps.measure);
  programme->value = thr_calloc(entries, sizeof *programme->value);
  programme->half = thr_scratch_array(&programme->own, entries, sizeof *programme->half);
  programme->trial.edge = thr_calloc(m, sizeof *programme->trial.edge);
  programme->trial.node = thr_calloc(n, sizeof *programme->trial.node);
  if (!programme->value || !programme->trial.edge || !programme->trial.node) return thr_nomem(err);
  return thr_scratch_check(&programme->own, err);
}

/* Sets up the programme of the component that the cord `most` belongs to, with a unit such that
 * `whole` is just below the largest number of units. THR_ELIMIT: the component is too large, or the
 * unit has steps of no units that go round in a circle. */
static thr_status init(thr_walk_programme *programme, const thr_turning_columns *columns,
                       thr_walk_measure measure, const thr_cord *cord, int n_cords,
                       const thr_cord *most, double whole, double least, bool lengths,
                       const thr_limits *limits, thr_err *err)
{
  int component = columns->component[thr_tail(columns->f, most->half[0])], here = 0;
  *programme = (thr_walk_programme){
      .c = columns, .limits = limits, .component = component, .scale = one, .lengths = lengths};

  /* The number of cords in the component, at most: as the task says, or where the ends at every
   * node are given, as the plan has them (of turning all cords of the plan are counted). */
  for (int i = 0; i < n_cords; i++)
    here += columns->component[thr_tail(columns->f, cord[i].half[0])] == component;
  programme->cords = !columns->task->end_count    ? columns->task->cords
                     : measure == THR_WALK_LENGTH ? here
                                                  : n_cords;

  /* Rounding errors of the proved minimum must not make the bound too high. */
  programme->least = least * (1 - 1e-10);

  /* A unit in which the recursions stay small enough. */
  programme->most_units = most_units(columns, measure, component);
  if (programme->most_units < FEWEST_UNITS)
    return thr_fail(err, THR_ELIMIT, "the component is too large for walks");
  programme->unit = choose_unit(programme, measure, most, whole, programme->most_units - 1);

  /* The recursion's steps, the arrays, and an empty pool of walks. */
  thr_status st =
      thr_walk_steps_init(&programme->steps, columns, measure, component, programme->unit, err);
  if (st) return st == THR_EVIOLATED ? THR_ELIMIT : st;
  if ((st = allocate(programme, err))) return st;
  programme->trial.unit = programme->unit;
  programme->trial.pulled = measure == THR_WALK_PULL;
  number_variables(programme, NULL, NULL);
  return thr_pool_init(&programme->walks, programme->n_variables, err);
}

thr_status thr_walk_programme_init(thr_walk_programme *programme,
                                   const thr_turning_columns *columns, thr_walk_measure measure,
                                   const thr_cord *cord, int n_cords, double least,
                                   const thr_limits *limits, thr_err *err)
{
  const thr_cord *most = &cord[thr_walk_dearest(columns, measure, cord, n_cords)];
  return init(programme, columns, measure, cord, n_cords, most,
              thr_walk_price(columns, measure, most), least, false, limits, err);
}

/* Chooses how many bits a price has in the proof, so that a walk's sum of prices fits 64 bits.
 * most: the highest price of a pass, in lengths of the longest edge. */
static void choose_bits(thr_walk_programme *programme, double most)
{
  const int all = 61; /* in 64 bits */
  int passes, price;
  frexp(((double)programme->units + 2) * (programme->steps.n + 1), &passes);
  frexp(5 * most, &price); /* a pass, its nodes, an end, and a length */

  /* What is left of the bits after the largest price and the number of summands. */
  const int bits = all - price - passes;
  programme->trial.bits = bits < THR_TURNING_BITS ? bits : THR_TURNING_BITS;
  programme->scale = ldexp(programme->longest, thr_walk_exponent(programme->c->f, THR_WALK_LENGTH) -
                                                   THR_TURNING_BITS + programme->trial.bits);
}

/* The unit is chosen by the cord of the component that is hardest to pull. */
thr_status thr_walk_programme_init_pull(thr_walk_programme *programme,
                                        const thr_turning_columns *columns,
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
  *programme = (thr_walk_programme){0};
  if (!most) return THR_ELIMIT;

  /* At either side of its cut turn a cord turns by at most this much. */
  const double half = thr_request_most_pulled(options);
  thr_status st =
      init(programme, columns, THR_WALK_PULL, cord, n_cords, most, half, 0, lengths, limits, err);
  if (st) return st;

  /* Prices are lengths in units of the longest edge. */
  programme->units = thr_walk_pull_units(options, programme->unit);
  for (int e = 0; e < columns->f->n_edges; e++)
    if (programme->edge[e] >= 0)
      programme->longest = fmax(programme->longest, columns->f->length[e]);
  programme->dearest = MOST_PRICE;
  if (lengths) choose_bits(programme, programme->dearest);
  if (programme->units > programme->most_units || (lengths && programme->trial.bits < FEWEST_BITS))
    return thr_fail(err, THR_ELIMIT, "the component is too large for walks");
  return THR_OK;
}

/* The variables are fewer than before, and so the pool of walks is made anew. */
thr_status thr_walk_programme_merge(thr_walk_programme *programme, const int *edge, const int *node,
                                    thr_err *err)
{
  number_variables(programme, edge, node);
  thr_pool_destroy(&programme->walks);
  return thr_pool_init(&programme->walks, programme->n_variables, err);
}

void thr_walk_programme_destroy(thr_walk_programme *programme)
{
  thr_walk_steps_destroy(&programme->steps);
  thr_walk_proof_destroy(&programme->trial);
  thr_search_destroy(&programme->search);
  thr_pool_destroy(&programme->walks);
  thr_walk_memory_free(programme->memory, programme->n_memories);
  free(programme->value);
  thr_scratch_free(&programme->own);
}

double thr_walk_programme_price(const thr_walk_programme *programme, int units)
{
  return ldexp((double)programme->unit * units, -programme->steps.exponent) * (1 - 1e-15);
}

/* ---- walks at given prices ---- */

static int64_t whole(double price, double scale)
{
  return price > 0 ? (int64_t)floor(price * scale) : 0;
}

/* Makes prices x[n_variables] those of the proof in trial, as whole numbers rounded down, and hands
 * them to the recursion. THR_EVIOLATED: they might not fit 64 bits. */
static thr_status set_trial(thr_walk_programme *programme, const double *x, thr_err *err)
{
  for (int e = 0; e < programme->c->f->n_edges; e++)
    programme->trial.edge[e] =
        programme->edge[e] >= 0 ? whole(x[programme->edge[e]], programme->scale) : 0;
  for (int v = 0; v < programme->c->f->n_nodes; v++)
    programme->trial.node[v] =
        programme->node[v] >= 0 ? whole(x[programme->node[v]], programme->scale) : 0;

  /* The price of all turning is a price per unit of 2^-exponent. */
  programme->trial.all = programme->least > 0
                             ? whole(ldexp(x[programme->n_variables - 1] / programme->least,
                                           THR_TURNING_BITS - programme->steps.exponent),
                                     one)
                             : 0;
  programme->trial.units = programme->units;
  return thr_walk_steps_price(&programme->steps, &programme->trial, err);
}

/* Returns the largest sum of prices of a walk with this first pass; thr_walk_is_none: there is no
 * such walk. */
static int64_t worth_of(const thr_walk_programme *programme, const thr_walk_step *first)
{
  return thr_walk_worth(first, programme->units, thr_walk_levels(programme->units),
                        programme->value);
}

/* Returns the recursion's table. With a pull there are two: before the cut turn, and after it
 * (`last`). */
static const int64_t *table_of(const thr_walk_programme *programme, bool last)
{
  const size_t entries = (size_t)thr_walk_levels(programme->units) * (size_t)programme->steps.n;
  return programme->value + (last && programme->steps.measure == THR_WALK_PULL ? entries : 0);
}

/* Returns what a walk of a recursion gains by going no further than place i: the price of a cord
 * end there, or with a pull and before the cut turn (not `last`) the most over the cut turn. A
 * closed walk may only end where it began: INT64_MIN elsewhere. */
static int64_t end_worth(const thr_walk_programme *programme, int run, int i, bool last)
{
  const thr_walk_steps *steps = &programme->steps;
  if (!last) return steps->cut[i];
  if (!steps->closed) return steps->end[i];

  /* With a pull a closed walk comes home to a node, else to the place of its first pass. */
  bool home = steps->n_homes > 0 ? steps->group[i] == thr_tail(programme->c->f,
                                                               steps->begin[steps->from[run]].half)
                                 : steps->spot[i] == steps->spot[steps->begin[run].to];
  return home ? 0 : INT64_MIN;
}

/* Returns the step that the best walk takes from place i with `units` units left; NULL: the walk
 * ends there, or has its cut turn there. */
static const thr_walk_step *best_step(const thr_walk_programme *programme, int run, int i,
                                      int units, bool last)
{
  const thr_walk_steps *steps = &programme->steps;
  const int64_t *table = table_of(programme, last);
  const int levels = thr_walk_levels(programme->units);
  const thr_walk_step *best = NULL;
  int64_t most = end_worth(programme, run, i, last);

  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const thr_walk_step *step = &steps->step[k];
    if (step->units > units) continue;

    /* The sum of prices from the step on; equal ones leave the first. */
    const int64_t on = table[thr_walk_entry(step->to, units - step->units, levels)];
    if (thr_walk_is_none(on) || on + step->worth <= most) continue;

    most = on + step->worth;
    best = step;
  }
  return best;
}

/* Returns the step of the best walk over its cut turn at place i, which takes no units: after the
 * cut turn all units are left again. NULL: the walk ends there. */
static const thr_walk_step *cut_step(const thr_walk_programme *programme, int run, int i)
{
  const thr_walk_steps *steps = &programme->steps;
  const thr_walk_step *best = NULL;
  int64_t most = end_worth(programme, run, i, true);

  /* Behind the cut turn the walk has all units of the limit. */
  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const int64_t on = table_of(programme, true)[thr_walk_entry(steps->step[k].to, programme->units,
                                                                thr_walk_levels(programme->units))];
    if (thr_walk_is_none(on) || on + steps->step[k].worth <= most) continue;

    most = on + steps->step[k].worth;
    best = &steps->step[k];
  }
  return best;
}

/* Counts a pass or cord end at node v in the draft of a row. */
static void put_node(const thr_walk_programme *programme, thr_pool *pool, int v)
{
  if (programme->node[v] >= 0) thr_pool_put(pool, programme->node[v], -1);
}

/* Returns the place of a walk ahead of its pass number `first`, which is the first pass that may be
 * remembered. */
static int place_before(const thr_walk_programme *programme, const int *half, int n, int first)
{
  return first ? thr_walk_begun(&programme->steps, half[0])
               : thr_walk_closed(&programme->steps, half[n - 1]);
}

/* Moves *place over a half-edge and says whether the walk remembers that it passed this edge
 * before; such a pass does not earn the edge's price. */
static bool go_on(const thr_walk_programme *programme, int half, int *place)
{
  const thr_walk_steps *steps = &programme->steps;
  int k = steps->first[*place];
  while (steps->step[k].half != half)
    k++;
  *place = steps->step[k].to;
  return steps->step[k].known;
}

/* A row says that the prices of the walk's passes, nodes and ends are at most 1, or with lengths at
 * most the walk's length and the price of a cord: coefficients are -1 for each. */
thr_row thr_walk_programme_row(const thr_walk_programme *programme, thr_pool *pool, const int *half,
                               int n)
{
  const thr_frame *frame = programme->c->f;
  const int first = programme->steps.closed && programme->steps.n_homes == 0 ? 0 : 1;
  thr_row row = {.lower = -1, .member = (int *)half, .n_members = n}; /* copied by the pool */
  int place = programme->n_memories > 0 ? place_before(programme, half, n, first) : -1;
  double length = 0;

  /* Every pass counts for its edge, unless it is remembered, and for both its nodes. */
  for (int k = 0; k < n; k++) {
    const bool known = place >= 0 && k >= first && go_on(programme, half[k], &place);
    if (!known) thr_pool_put(pool, programme->edge[half[k] >> 1], -1);
    put_node(programme, pool, thr_tail(frame, half[k]));
    put_node(programme, pool, thr_head(frame, half[k]));
    length += frame->length[half[k] >> 1];
  }

  /* Cord ends count at the first and the last node. */
  if (!programme->steps.closed) {
    put_node(programme, pool, thr_tail(frame, half[0]));
    put_node(programme, pool, thr_head(frame, half[n - 1]));
  }

  /* With lengths: minus the prices plus that of a cord is at least minus the length. */
  if (!programme->lengths) return row;
  row.lower = -length / programme->longest;
  thr_pool_put(pool, programme->n_variables - 1, 1);
  return row;
}

/* A walk that was traced through the table. */
typedef struct {
  int n, units; /* passes, in programme->half; with a pull units are those of the larger side of the
                   cut turn */
  double weight; /* of its turns, or its length */
} traced_walk;

/* Follows the best walk of a recursion with a given first pass through the table, and writes its
 * half-edges to programme->half. */
static traced_walk trace_walk(thr_walk_programme *programme, int run, const thr_walk_step *step)
{
  traced_walk walk = {0};
  int left = programme->units;
  bool last = programme->steps.measure != THR_WALK_PULL;

  while (step) {
    const int i = step->to;

    /* The pass, its units and its price. */
    programme->half[walk.n++] = step->half;
    left -= step->units;
    if (programme->units - left > walk.units) walk.units = programme->units - left;
    walk.weight += (double)step->weight;

    /* With a pull the walk goes over its cut turn once, and has all units afresh behind it. */
    step = best_step(programme, run, i, left, last);
    if (step || last) continue;
    last = true;
    step = cut_step(programme, run, i);
    left = programme->units + (step ? step->units : 0);
  }
  return walk;
}

/* Puts together the row of a traced walk, whose index is the number of units, so that later
 * limits can leave the row out. */
static thr_row row_of(thr_walk_programme *programme, const traced_walk *walk)
{
  thr_row row =
      thr_walk_programme_row(programme, &programme->search.pool, programme->half, walk->n);
  row.index = walk->units;
  if (programme->least > 0)
    thr_pool_put(&programme->search.pool, programme->n_variables - 1,
                 -ldexp(walk->weight, -programme->steps.exponent) / programme->least);
  return row;
}

/* Lists the first passes of a recursion by the sum of prices of their best walks, largest first, in
 * programme->start; at most `most`. Returns their number. */
static int sort_starts(thr_walk_programme *programme, int run, int most)
{
  const thr_walk_step *first;
  int n = 0, count = thr_walk_firsts(&programme->steps, run, &first);

  for (int i = 0; i < count; i++) {
    const thr_walk_start here = {worth_of(programme, &first[i]), &first[i]};

    /* Insertion from the end; the last one drops out of a full list. */
    int k = n < most ? n++ : most;
    for (; k > 0 && programme->start[k - 1].worth < here.worth; k--)
      if (k < most) programme->start[k] = programme->start[k - 1];
    if (k < most) programme->start[k] = here;
  }
  return n;
}

/* Computes what prices x prove of the length of all cords within a limit on the pull, no walk's
 * prices being more than `worth` above its length. Keeps the prices if they prove more than the
 * best so far. */
static void judge_lengths(thr_walk_programme *programme, const double *x, int64_t worth)
{
  const double bound =
      thr_walk_pull_bound(&programme->steps, &programme->trial, programme->cords, worth);
  if (bound <= programme->best) return;

  programme->best = bound;
  for (int j = 0; j < programme->n_variables; j++)
    programme->middle[j] = x[j];
  programme->excluded = bound >= programme->enough * (1 - 1e-9);
}

/* Returns the value that is assumed for the best walk if no walk earns more: a small part of what a
 * pass may cost, so that the quotient in judge_prices stays finite and still exceeds the number of
 * cords of any plan. */
static double least_worth(const thr_walk_programme *programme)
{
  return 0x1p-12 * one * programme->upper[0];
}

/* Computes the bound that prices x prove: what every plan earns at these prices, divided by what
 * one walk earns at most, is a lower bound on the number of cords (A. A. Farley 1990). Keeps the
 * prices, scaled so that the best walk earns 1, if the bound is the best so far. If no walk earns
 * anything, any scale proves the bound. */
static void judge_prices(thr_walk_programme *programme, const double *x, double worth)
{
  const double scale = worth > least_worth(programme) ? worth : one * programme->upper[0];
  double needed = thr_walk_needed(&programme->steps, &programme->trial, programme->least);
  programme->excluded = needed > programme->cords * worth * (1 + 1e-9) &&
                        thr_walk_component(programme->c, &programme->trial) == programme->component;

  /* Farley's bound: a fraction, which rounds up to a number of cords. */
  if (needed / worth <= programme->best) return;
  programme->best = needed / worth;
  for (int j = 0; j < programme->n_variables; j++)
    programme->middle[j] = x[j] * one / scale;
}

/* Says whether more than nine tenths of a walk's passes are over edges that earlier walks of this
 * look have; if not, notes the walk's edges. */
static bool is_like_others(thr_walk_programme *programme, int n)
{
  int old = 0;
  for (int k = 0; k < n; k++)
    old += programme->passed[programme->edge[programme->half[k] >> 1]];

  if (10 * old > 9 * n) return true;
  for (int k = 0; k < n; k++)
    programme->passed[programme->edge[programme->half[k] >> 1]] = true;
  return false;
}

/* Runs one recursion at the prices in trial and offers its best walks to the pool, as far as the
 * last optimum programme->x violates their rows. *most grows to the largest sum of prices of a
 * walk. */
static thr_status price_run(thr_walk_programme *programme, int run, int64_t *most, int *added,
                            thr_err *err)
{
  thr_status st = THR_OK;
  thr_walk_run(&programme->steps, run, programme->units, thr_walk_levels(programme->units),
               programme->value);
  thr_limits_spend(programme->limits, per_step * programme->units *
                                          programme->steps.first[programme->steps.n] *
                                          (double)thr_walk_tables(programme->steps.measure));

  /* There are many recursions of closed walks: the best walk of each is enough. */
  const int n = sort_starts(programme, run, programme->steps.closed ? 1 : MOST_STARTS);
  if (n > 0 && programme->start[0].worth > *most) *most = programme->start[0].worth;

  /* Rows are taken in the order of their violation, but only of walks that differ. */
  memset(programme->passed, 0, (size_t)programme->c->f->n_edges * sizeof *programme->passed);
  for (int i = 0, taken = 0; i < n && taken < MOST_WALKS && !st && programme->start[i].worth > 0;
       i++) {
    const traced_walk walk = trace_walk(programme, run, programme->start[i].first);
    if (is_like_others(programme, walk.n)) continue;
    st = thr_pool_offer(&programme->search.pool, row_of(programme, &walk), programme->x, 1e-6,
                        added, err);
    taken++;
  }
  return st;
}

/* A bound needs all recursions. They are gone through from where the last look ended; if some walks
 * were found on the way, the look ends without a bound. */
thr_status thr_walk_programme_look(thr_walk_programme *programme, const double *x, int *added,
                                   thr_err *err)
{
  thr_status st = set_trial(programme, x, err);
  int64_t most = programme->lengths ? 0 : (int64_t)least_worth(programme);
  if (st) return st == THR_EVIOLATED ? THR_OK : st;

  const int runs = thr_walk_runs(&programme->steps);
  for (int i = 0; i < runs && !st; i++) {
    programme->run = (programme->run + 1) % runs;
    st = price_run(programme, programme->run, &most, added, err);
    if (*added >= SOME_WALKS && i + 1 < runs) return st;
  }

  /* All recursions have run: the prices prove something. */
  if (programme->to_exclude && !st && programme->lengths) judge_lengths(programme, x, most);
  if (programme->to_exclude && !st && !programme->lengths) judge_prices(programme, x, (double)most);
  return st;
}

/* Prices between the best so far and the last optimum are tried first (P. Wentges 1997). If they
 * separate no row, prices x themselves decide. */
thr_status thr_walk_programme_find(thr_walk_programme *programme, int *added, thr_err *err)
{
  thr_status st = THR_OK;

  /* Without a bound there are no best prices to smooth with. */
  if (programme->to_exclude && programme->best > 0) {
    for (int j = 0; j < programme->n_variables; j++)
      programme->try[j] = .3 * programme->x[j] + .7 * programme->middle[j];
    st = thr_walk_programme_look(programme, programme->try, added, err);
  }

  return st || programme->excluded || *added > 0
             ? st
             : thr_walk_programme_look(programme, programme->x, added, err);
}

/* Adapts thr_walk_programme_find to a separator of the search. */
static thr_status find_walks(void *user, int *added, thr_err *err)
{
  return thr_walk_programme_find(user, added, err);
}

/* Rounds the units of all steps up instead of down, so that a walk within the units keeps to the
 * limit for certain. */
void thr_walk_programme_round_up(thr_walk_programme *programme, double per_cord)
{
  thr_walk_steps *steps = &programme->steps;
  const double rounding = 2e-9; /* twice what the unit is less than turns of whole numbers of it */

  for (int d = 0; d < 2 * programme->c->f->n_edges; d++) {
    const int i = steps->place[d];
    for (int k = i < 0 ? 0 : steps->first[i]; i >= 0 && k < steps->first[i + 1]; k++) {
      thr_walk_step *step = &steps->step[k];
      step->units = (int)ceil((double)step->weight / (double)programme->unit * (1 - rounding));
    }
  }

  /* A pass may cost more than a cord: then an edge is rather passed by a cord of its own. */
  programme->per_cord = per_cord;
  programme->dearest = 2 * per_cord;
  choose_bits(programme, programme->dearest);
}

thr_status thr_walk_programme_middle(thr_walk_programme *programme, thr_err *err)
{
  return set_trial(programme, programme->middle, err);
}

/* ---- a limit ---- */

/* Copies the rows of walks of at most `units` units from one pool to another, except those that are
 * there already. */
static thr_status carry_walks(const thr_pool *from, int units, thr_pool *to, thr_err *err)
{
  thr_status st = THR_OK;

  for (int i = 0; i < from->count && !st; i++) {
    const thr_row *row = &from->row[i];
    if (row->index > units || thr_pool_knows(to, row->name)) continue;

    /* The entries first, then the row that owns them. */
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

/* The search minimises minus the right sides, which maximises the dual objective. */
thr_status thr_walk_programme_begin(thr_walk_programme *programme, int units, double price,
                                    thr_err *err)
{
  double *cost = thr_calloc((size_t)programme->n_variables, sizeof *cost);
  thr_status st =
      cost ? thr_search_init(&programme->search, programme->n_variables, programme->x, err)
           : thr_nomem(err);
  programme->units = units;
  programme->excluded = false;
  programme->best = 0;

  /* Costs and upper bounds of the dual variables. */
  for (int j = 0; j < programme->n_variables && !st; j++) {
    cost[j] = -programme->right[j];
    programme->upper[j] =
        j + 1 == programme->n_variables && programme->least > 0 ? 2 * programme->cords : price;
  }

  /* The programme; with a given price of a cord its variable is fixed. Rows: the walks that are
   * known. */
  if (!st)
    st = thr_lp_create(&programme->search.lp, programme->n_variables, cost, programme->upper, err);
  if (!st && programme->per_cord > 0)
    st = thr_lp_set_bounds(programme->search.lp, programme->n_variables - 1, programme->per_cord,
                           programme->per_cord, err);
  if (!st) st = carry_walks(&programme->walks, units, &programme->search.pool, err);
  if (!st) thr_search_use(&programme->search, find_walks, programme, THR_SLOW);
  free(cost);
  return st;
}

/* Ends the rounds when the known walks already suffice for the cords that there may be, so that the
 * limit cannot be excluded; with lengths, when the bound has met the optimum. */
static thr_status look(void *user, thr_err *err)
{
  thr_walk_programme *programme = user;
  const double value = -programme->search.objective, near = 1e-9;
  (void)err;
  const double most = programme->enough > 0
                          ? programme->enough
                          : programme->cords; /* of cords, where their number counts */

  const bool enough = programme->lengths
                          ? programme->best >= value * programme->longest * (1 - near)
                          : value <= most * (1 + near);

  programme->search.enough =
      programme->to_exclude && programme->search.outcome == THR_LP_OPTIMAL && enough;
  return THR_OK;
}

thr_status thr_walk_programme_add(thr_walk_programme *programme, const thr_cord *cord, thr_err *err)
{
  return thr_pool_add(
      &programme->search.pool,
      thr_walk_programme_row(programme, &programme->search.pool, cord->half, cord->n_passes), err);
}

thr_status thr_walk_programme_rounds(thr_walk_programme *programme, int most_rounds, thr_err *err)
{
  const thr_search_calls calls = {.user = programme, .look = look, .most_rounds = most_rounds};
  return thr_search_rounds(&programme->search, &calls, programme->limits, err);
}

thr_status thr_walk_programme_end(thr_walk_programme *programme, thr_err *err)
{
  thr_status st = carry_walks(&programme->search.pool, programme->units, &programme->walks, err);
  thr_search_destroy(&programme->search);
  return st;
}
