/* Bisection on the limit; for each a search with rows (lp/model/search.h). */
#include "tortuosity/cords/walk_bound.h"
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
#include <string.h>

enum {
  MOST_ENTRIES = 1 << 23, /* of the recursion's table */
  MOST_UNITS = 4000,
  MOST_WALKS = 40, /* that one look at the prices adds */
  MOST_ROUNDS = 300
};

static const double one = 4294967296.0; /* 1 in the integers of a proof */

typedef struct {
  const thr_turning_columns *c;
  const thr_limits *limits;
  int component, cords;
  double least; /* of the turning of all cords; 0: not known, or of more than this component */
  thr_scratch own;
  thr_walk_steps steps;
  int64_t unit;
  int units;                     /* of the limit that is being tried */
  int n_variables, *edge, *node; /* [n_edges], [n_nodes] their variables, -1: none. The last one, if least > 0: of turning */
  double *right;                 /* [n_variables] the right sides: costs of the dual */
  double *x, *middle, *try;      /* [n_variables] the last optimum, the best so far, what is priced */
  double best;                   /* number of cords that the best proves */
  bool has_middle, excluded;
  int64_t *value; /* [MOST_UNITS + 1][steps.n] */
  int *start;     /* [steps.n] places in the order of their worth */
  thr_walk_proof trial, found;
  thr_search search;
  thr_pool walks; /* of all limits so far */
} programme;

/* ---- set up ---- */

static double price_of(const thr_turning_columns *columns, const thr_cord *cord)
{
  double price = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++)
    price += thr_turn_price(columns->f, columns->task->cost, cord->half[k], cord->half[k + 1]);
  return price;
}

/* A unit of which so many make up the largest turning, and of those up to twice as large the one of which most turns of the cord
 * are nearly whole numbers. */
static int64_t choose_unit(const thr_turning_columns *columns, const thr_cord *cord, int units)
{
  enum { CANDIDATES = 256 };
  double largest = price_of(columns, cord), least_loss = INFINITY, unit = 0;
  for (int i = 0; i < CANDIDATES; i++) {
    double candidate = largest / units * (1 + (double)i / CANDIDATES), loss = 0;
    for (int k = 0; k + 1 < cord->n_passes; k++) {
      double turn = thr_turn_price(columns->f, columns->task->cost, cord->half[k], cord->half[k + 1]) / candidate;
      loss += candidate * (turn + 1e-9 - floor(turn + 1e-9));
    }
    if (loss < least_loss) least_loss = loss, unit = candidate;
  }
  return (int64_t)floor(ldexp(unit, THR_TURNING_BITS) * (1 - 1e-9));
}

static bool needs_odd(const thr_turning_columns *columns, int v, double *right)
{
  int sum = 0;
  for (int i = columns->f->first[v]; i < columns->f->first[v + 1]; i++)
    sum += columns->cover[columns->f->half[i] >> 1];
  *right = sum + 1;
  return sum % 2 != 0;
}

static void number_variables(programme *p)
{
  const thr_frame *frame = p->c->f;
  double right;
  for (int e = 0; e < frame->n_edges; e++) {
    p->edge[e] = p->c->component[frame->edge[e][0]] == p->component ? p->n_variables : -1;
    if (p->edge[e] >= 0) p->right[p->n_variables++] = p->c->cover[e];
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    p->node[v] = p->c->component[v] == p->component && needs_odd(p->c, v, &right) ? p->n_variables : -1;
    if (p->node[v] >= 0) p->right[p->n_variables++] = right;
  }
  if (p->least > 0) p->right[p->n_variables++] = 1;
}

static thr_status prices_init(thr_walk_proof *proof, const programme *p, thr_err *err)
{
  proof->unit = p->unit;
  proof->units = -1;
  proof->edge = thr_calloc((size_t)p->c->f->n_edges, sizeof *proof->edge);
  proof->node = thr_calloc((size_t)p->c->f->n_nodes, sizeof *proof->node);
  return proof->edge && proof->node ? THR_OK : thr_nomem(err);
}

static thr_status programme_init(programme *p, const thr_cord *cord, thr_err *err)
{
  const thr_frame *frame = p->c->f;
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges, most = n + m + 1;
  int edges = 0, units;
  for (int e = 0; e < frame->n_edges; e++)
    edges += p->c->component[frame->edge[e][0]] == p->component;
  units = MOST_ENTRIES / (2 * edges) < MOST_UNITS ? MOST_ENTRIES / (2 * edges) : MOST_UNITS;
  if (units < 100) return THR_ELIMIT;
  p->unit = choose_unit(p->c, cord, units - 1);
  thr_status st = thr_walk_steps_init(&p->steps, p->c, p->component, p->unit, err);
  if (st) return st == THR_EVIOLATED ? THR_ELIMIT : st;
  p->edge = thr_scratch_array(&p->own, m, sizeof *p->edge);
  p->node = thr_scratch_array(&p->own, n, sizeof *p->node);
  p->right = thr_scratch_array(&p->own, most, sizeof *p->right);
  p->x = thr_scratch_array(&p->own, most, sizeof *p->x);
  p->middle = thr_scratch_array(&p->own, most, sizeof *p->middle);
  p->try = thr_scratch_array(&p->own, most, sizeof *p->try);
  p->start = thr_scratch_array(&p->own, (size_t)p->steps.n, sizeof *p->start);
  p->value = thr_scratch_array(&p->own, ((size_t)units + 1) * (size_t)p->steps.n, sizeof *p->value);
  st = thr_scratch_check(&p->own, err);
  if (!st) st = prices_init(&p->trial, p, err);
  if (!st) st = prices_init(&p->found, p, err);
  if (st) return st;
  number_variables(p);
  return thr_pool_init(&p->walks, p->n_variables, err);
}

static void programme_destroy(programme *p)
{
  thr_walk_steps_destroy(&p->steps);
  thr_walk_proof_destroy(&p->trial);
  thr_walk_proof_destroy(&p->found);
  thr_pool_destroy(&p->walks);
  thr_scratch_free(&p->own);
}

/* ---- prices ---- */

static int64_t whole(double price)
{
  return price > 0 ? (int64_t)floor(price * one) : 0;
}

/* The variables as the prices of a proof. */
static thr_status set_trial(programme *p, const double *x, thr_err *err)
{
  for (int e = 0; e < p->c->f->n_edges; e++)
    p->trial.edge[e] = p->edge[e] >= 0 ? whole(x[p->edge[e]]) : 0;
  for (int v = 0; v < p->c->f->n_nodes; v++)
    p->trial.node[v] = p->node[v] >= 0 ? whole(x[p->node[v]]) : 0;
  p->trial.turning = p->least > 0 ? whole(x[p->n_variables - 1] / p->least) : 0;
  p->trial.units = p->units;
  return thr_walk_steps_price(&p->steps, &p->trial, err);
}

static int64_t worth_from(const programme *p, int i)
{
  const thr_walk_steps *steps = &p->steps;
  int64_t start = steps->end[steps->place[steps->half[i] ^ 1]], on = p->value[(size_t)p->units * (size_t)steps->n + (size_t)i];
  return start < 0 || on < 0 ? -1 : start + on;
}

/* Puts together the row of the dearest walk from place i, and says how many units it has. */
static int put_walk(programme *p, int i)
{
  const thr_walk_steps *steps = &p->steps;
  const thr_frame *frame = p->c->f;
  thr_pool *pool = &p->search.pool;
  int r = p->units, from = p->node[thr_tail(frame, steps->half[i])];
  double turning = 0;
  if (from >= 0) thr_pool_put(pool, from, -1);
  for (int next = i; next >= 0;) {
    int64_t most = steps->end[i = next];
    int rest = r, nodes[2] = {p->node[thr_tail(frame, steps->half[i])], p->node[thr_head(frame, steps->half[i])]};
    double turn = 0;
    thr_pool_put(pool, p->edge[steps->half[i] >> 1], -1);
    for (int k = 0; k < 2; k++)
      if (nodes[k] >= 0) thr_pool_put(pool, nodes[k], -1);
    next = -1;
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
      const thr_walk_step *step = &steps->step[k];
      int64_t here =
          step->units > r ? -1 : p->value[(size_t)(r - step->units) * (size_t)steps->n + (size_t)step->to] + step->worth;
      if (here <= most || here < 0) continue;
      most = here;
      next = step->to;
      rest = r - step->units;
      turn = (double)step->weight;
    }
    r = rest;
    turning += turn;
    if (next < 0 && nodes[1] >= 0) thr_pool_put(pool, nodes[1], -1);
  }
  if (p->least > 0) thr_pool_put(pool, p->n_variables - 1, -ldexp(turning, -THR_TURNING_BITS) / p->least);
  return p->units - r;
}

/* The places by what walks from them are worth, the dearest first. */
static int sort_starts(programme *p)
{
  int n = 0;
  for (int i = 0; i < p->steps.n; i++) {
    int64_t worth = worth_from(p, i);
    int k = n < MOST_WALKS ? n++ : MOST_WALKS;
    for (; k > 0 && worth_from(p, p->start[k - 1]) < worth; k--)
      if (k < MOST_WALKS) p->start[k] = p->start[k - 1];
    if (k < MOST_WALKS) p->start[k] = i;
  }
  return n;
}

/* The walks that are worth most at these prices, as far as the last optimum does not know them. The prices prove the limit if K
 * of the dearest are not worth enough. */
static thr_status price_walks(programme *p, const double *x, int *added, thr_err *err)
{
  thr_status st = set_trial(p, x, err);
  if (st) return st == THR_EVIOLATED ? THR_OK : st;
  double worth = (double)thr_walk_best(&p->steps, p->units, p->units + 1, p->value),
         needed = thr_walk_needed(&p->steps, &p->trial, p->least);
  double cords = needed / fmax(worth, 1);
  if (cords > p->best) {
    p->best = cords;
    for (int j = 0; j < p->n_variables; j++)
      p->middle[j] = x[j] * one / fmax(worth, 1);
    p->has_middle = true;
  }
  p->excluded = needed > p->cords * worth * (1 + 1e-9);
  int n = p->excluded ? 0 : sort_starts(p);
  for (int i = 0; i < n && !st; i++) {
    if (worth_from(p, p->start[i]) <= 0) break;
    int units = put_walk(p, p->start[i]);
    st = thr_pool_offer(&p->search.pool, (thr_row){.index = units, .lower = -1}, p->x, 1e-6, added, err);
  }
  return st;
}

/* First between the last optimum and the best prices so far, where the optimum alone would swing. */
static thr_status find_walks(void *user, int *added, thr_err *err)
{
  programme *p = user;
  thr_status st = THR_OK;
  if (p->has_middle) {
    for (int j = 0; j < p->n_variables; j++)
      p->try[j] = .3 * p->x[j] + .7 * p->middle[j];
    st = price_walks(p, p->try, added, err);
  }
  return st || p->excluded || *added > 0 ? st : price_walks(p, p->x, added, err);
}

/* No more cords are needed than there are? */
static thr_status look(void *user, thr_err *err)
{
  programme *p = user;
  (void)err;
  p->search.enough = p->search.outcome == THR_LP_OPTIMAL && -p->search.objective <= p->cords * (1 + 1e-9);
  return THR_OK;
}

/* ---- one limit ---- */

/* Rows of walks from pool to pool, those of at most so many units. */
static thr_status carry_walks(const thr_pool *from, int units, thr_pool *to, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < from->count && !st; i++) {
    const thr_row *row = &from->row[i];
    if (row->index > units || thr_pool_knows(to, row->name)) continue;
    for (int k = 0; k < row->n; k++)
      thr_pool_put(to, row->column[k], row->value ? row->value[k] : 1);
    st = thr_pool_add(to, (thr_row){.name = row->name, .index = row->index, .lower = -1}, err);
  }
  return st;
}

/* Are cords of at most so many units too few? */
static thr_status try_units(programme *p, int units, thr_err *err)
{
  const thr_search_calls calls = {.user = p, .look = look, .most_rounds = MOST_ROUNDS, .patience = 30};
  double *cost = thr_calloc((size_t)p->n_variables, sizeof *cost), *upper = thr_calloc((size_t)p->n_variables, sizeof *upper);
  thr_status st = cost && upper ? thr_search_init(&p->search, p->n_variables, p->x, err) : thr_nomem(err);
  p->units = units;
  p->excluded = p->has_middle = false;
  p->best = 0;
  for (int j = 0; j < p->n_variables && !st; j++) {
    cost[j] = -p->right[j];
    upper[j] = j + 1 == p->n_variables && p->least > 0 ? 2 * p->cords : 1; /* no walk that counts is worth more than 1 */
  }
  if (!st) st = thr_lp_create(&p->search.lp, p->n_variables, cost, upper, err);
  if (!st) st = carry_walks(&p->walks, units, &p->search.pool, err);
  if (!st) thr_search_use(&p->search, find_walks, p, THR_SLOW);
  if (!st) st = thr_search_rounds(&p->search, &calls, p->limits, err);
  if (!st) st = carry_walks(&p->search.pool, units, &p->walks, err);
  if (!st && p->excluded) {
    thr_walk_proof last = p->found;
    p->found = p->trial;
    p->trial = last;
  }
  thr_search_destroy(&p->search);
  free(cost);
  free(upper);
  return st;
}

/* ---- the limit ---- */

static double bound_of(const programme *p, int units)
{
  return ldexp((double)p->unit * ((double)units + 1), -THR_TURNING_BITS) * (1 - 1e-15);
}

static thr_status bisect(programme *p, double largest, double *bound, thr_err *err)
{
  const double near = 5e-4; /* of the largest */
  int low = (int)floor(*bound / bound_of(p, 0)) - 1, high = (int)ceil(largest / bound_of(p, 0));
  thr_status st = THR_OK;
  while (high - low > 1 && bound_of(p, high) - bound_of(p, low) > near * largest && !st && !thr_limits_stop(p->limits)) {
    int middle = low + (high - low) / 2;
    st = try_units(p, middle, err);
    if (!st && p->excluded)
      low = middle, *bound = fmax(*bound, bound_of(p, low));
    else
      high = middle;
  }
  return st;
}

static const thr_cord *turns_most(const thr_turning_columns *columns, const thr_cord *cord, int n_cords)
{
  const thr_cord *most = cord;
  for (int i = 1; i < n_cords; i++)
    if (price_of(columns, &cord[i]) > price_of(columns, most)) most = &cord[i];
  return most;
}

thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_cord *cord, int n_cords, double least,
                          const thr_limits *limits, thr_walk_proof *proof, double *bound, thr_err *err)
{
  const thr_turning_task *task = columns->task;
  const thr_cord *most = turns_most(columns, cord, n_cords);
  double largest = price_of(columns, most);
  if (!task->end_allowed || task->cords < 2 || *bound >= largest * (1 - 1e-9)) return THR_OK;
  programme p = {.c = columns,
                 .limits = limits,
                 .component = columns->component[thr_tail(columns->f, most->half[0])],
                 .cords = task->end_count ? n_cords : task->cords,
                 .least = columns->n_components == 1 ? least * (1 - 1e-12) : 0};
  thr_status st = programme_init(&p, most, err);
  if (!st) st = bisect(&p, largest, bound, err);
  if (!st && p.found.units >= 0) {
    thr_walk_proof_destroy(proof);
    *proof = p.found;
    p.found = (thr_walk_proof){0};
  }
  programme_destroy(&p);
  return st == THR_ELIMIT ? THR_OK : st;
}
