/* Best bound first; every node keeps the multipliers that prove its bound. */
#include "tortuosity/proof/branch.h"
#include "graph/angle.h"
#include "tortuosity/proof/ascent.h"
#include "tortuosity/proof/cycles.h"
#include "tortuosity/proof/nearest.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double integral = 1e-6; /* what counts as a whole number */

/* More turns than these, and more per edge, make a linear programme that is not solved in any time that anybody waits. */
enum { DENSE = 200000, DENSE_PER_EDGE = 20 };

/* Tying a node of more edges once takes seconds: it is not done again for a plan that may be better. */
enum { TIED_DEGREE = 1000 };

thr_status thr_branch_init(thr_branch *b, const thr_turning_columns *c, int most_nodes, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)c->f->n_nodes, m = (size_t)c->f->n_edges;
  const int room = 50 + 1000000 / c->f->n_edges; /* every leaf of the proof has two multipliers per edge */
  *b = (thr_branch){.c = c,
                    .limits = limits,
                    .most_nodes = most_nodes < room ? most_nodes : room,
                    .best_price = INT64_MAX,
                    .best_length = INFINITY};
  b->several = !c->task->end_allowed && c->task->cords > 1;
  b->dense = !c->task->free_turns && c->first_extra > DENSE && c->first_extra / DENSE_PER_EDGE > c->f->n_edges;
  b->passes = thr_calloc(m, sizeof *b->passes);
  b->ends = thr_calloc(n, sizeof *b->ends);
  b->whole = thr_calloc((size_t)c->n_columns, sizeof *b->whole);
  b->weight = thr_calloc(m, sizeof *b->weight);
  b->end_weight = thr_calloc(n, sizeof *b->end_weight);
  if (b->passes && b->ends && b->whole && b->weight && b->end_weight) return THR_OK;
  thr_branch_destroy(b);
  return thr_nomem(err);
}

void thr_branch_destroy(thr_branch *b)
{
  for (int i = 0; i < b->n_duals; i++)
    thr_turning_dual_destroy(&b->dual[i]);
  free(b->dual);
  free(b->node);
  free(b->passes);
  free(b->ends);
  free(b->whole);
  free(b->weight);
  free(b->end_weight);
  if (b->found) thr_join_destroy(&b->best);
  if (b->relax.c) thr_relax_destroy(&b->relax);
  *b = (thr_branch){0};
}

/* Price of all passes that must be. */
static double base_price(const thr_turning_columns *c)
{
  double sum = 0;
  for (int e = 0; e < c->f->n_edges; e++)
    sum += c->cover[e] * (double)c->weight[c->first_extra + e];
  return sum;
}

int64_t thr_branch_tolerance(const thr_branch *b)
{
  double u_turn = thr_turn_cost_of(b->c->task->cost, THR_PI);
  if (b->c->task->free_turns) return (int64_t)(0.3e-9 * ((double)b->best_price + base_price(b->c)));
  return (int64_t)ldexp(1e-9 * u_turn * b->best_passes, THR_TURNING_BITS);
}

static double fraction(double x)
{
  return fabs(x - nearbyint(x));
}

/* Column to branch on: extras first, then ends, then the rest; the one nearest a half. -1: the point is whole. */
static int most_fractional(const thr_branch *b)
{
  const thr_turning_columns *c = b->c;
  const int range[4][2] = {
      {c->first_extra, c->first_end}, {c->first_end, c->first_back}, {0, c->first_extra}, {c->first_back, c->n_columns}};
  for (int r = 0; r < 4; r++) {
    int best = -1;
    double most = integral;
    for (int k = range[r][0]; k < range[r][1]; k++)
      if (fraction(b->relax.x[k]) > most + 1e-9) {
        most = fraction(b->relax.x[k]);
        best = k;
      }
    if (best >= 0) return best;
  }
  return -1;
}

/* ---- nodes ---- */

static thr_status new_node(thr_branch *b, thr_branch_node node, int *index, thr_err *err)
{
  thr_status st = thr_grow(&b->node, b->n_nodes, &b->nodes_capacity, sizeof *b->node, err);
  if (st) return st;
  *index = b->n_nodes;
  b->node[b->n_nodes++] = node;
  return THR_OK;
}

/* Puts the bounds of a node's branches on the relaxation. */
static thr_status enter(thr_branch *b, int i, thr_err *err)
{
  const thr_turning_columns *c = b->c;
  thr_status st = THR_OK;
  int *low = thr_calloc((size_t)c->n_columns, sizeof *low), *high = b->whole;
  if (!low) return thr_nomem(err);
  for (int k = 0; k < c->n_columns; k++)
    high[k] = thr_turning_most(c, k);
  for (; b->node[i].parent >= 0; i = b->node[i].parent) {
    const thr_branch_node *n = &b->node[i];
    if (n->high && n->value + 1 > low[n->column]) low[n->column] = n->value + 1;
    if (!n->high && n->value < high[n->column]) high[n->column] = n->value;
  }
  for (int k = 0; k < c->n_columns && !st; k++)
    st = thr_relax_set(&b->relax, k, low[k], high[k], err);
  free(low);
  return st;
}

/* Takes multipliers over, for node i if they prove more than it has. */
static thr_status keep_dual(thr_branch *b, int i, thr_turning_dual d, const int *low, const int *high, thr_err *err)
{
  int64_t bound;
  thr_status st = thr_turning_dual_bound(b->c, &d, low, high, &bound, err);
  if (!st && (b->node[i].dual < 0 || bound > b->node[i].bound)) {
    st = thr_grow(&b->dual, b->n_duals, &b->duals_capacity, sizeof *b->dual, err);
    if (!st) {
      b->node[i].bound = bound;
      b->node[i].dual = b->n_duals;
      b->dual[b->n_duals++] = d;
      return THR_OK;
    }
  }
  thr_turning_dual_destroy(&d);
  return st;
}

/* The multipliers of the last solve. */
static thr_status certify(thr_branch *b, int i, thr_err *err)
{
  thr_turning_dual d;
  thr_status st = thr_relax_dual(&b->relax, &d, err);
  return st ? st : keep_dual(b, i, d, b->relax.low, b->relax.high, err);
}

static bool closed(const thr_branch *b, int i)
{
  return b->node[i].bound >= b->best_price - thr_branch_tolerance(b);
}

static int largest_degree(const thr_frame *f)
{
  int most = 0;
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) > most) most = thr_degree(f, v);
  return most;
}

/* Tube joints: the bound of the ascent, and from the mean of its solutions passes to begin with. */
static thr_status climb(thr_branch *b, int root, thr_err *err)
{
  const thr_limits some = thr_limits_part(b->limits, 0.4);
  double target = b->found ? ldexp((double)b->best_price, -THR_TURNING_BITS) : INFINITY;
  thr_turning_dual d = {0};
  bool found = false;
  double *mean = thr_calloc((size_t)b->c->n_columns, sizeof *mean);
  const thr_limits half = thr_limits_part(b->limits, b->dense ? 0.5 : 1);
  thr_status st = mean ? thr_ascent_run(b->c, target, &half, &d, mean, err) : thr_nomem(err);
  if (!st) st = keep_dual(b, root, d, NULL, NULL, err);
  bool more = !b->found || (!closed(b, root) && !thr_limits_stop(b->limits) && largest_degree(b->c->f) <= TIED_DEGREE);
  if (!st && more) st = thr_tie_round(b->c, mean, b->passes, b->ends, &found, err);
  if (!st && found) st = thr_tie_improve(b->c, &some, b->passes, b->ends, err);
  if (!st && found) st = thr_branch_try(b, b->passes, b->ends, err);
  free(mean);
  return st;
}

thr_status thr_branch_begin(thr_branch *b, thr_err *err)
{
  thr_turning_dual d;
  int root;
  thr_status st = new_node(b, (thr_branch_node){.parent = -1, .bound = INT64_MIN, .dual = -1, .open = true}, &root, err);
  if (st || b->c->task->free_turns || b->c->task->tube) return st;
  const thr_limits some = thr_limits_part(b->limits, 0.2);
  st = thr_nodes_bound(b->c, &some, &d, err);
  return st ? st : keep_dual(b, root, d, NULL, NULL, err);
}

/* Where every open node's bound is above the best price, or none is open, that price is the bound: a plan has it. */
static void report(const thr_branch *b)
{
  if (!b->limits->progress) return;
  int64_t least = b->best_price;
  for (int i = 0; i < b->n_nodes; i++)
    if (b->node[i].open && b->node[i].bound < least) least = b->node[i].bound;
  b->limits->progress(b->limits->user, "turning", ldexp((double)b->best_price, -THR_TURNING_BITS),
                      ldexp((double)least, -THR_TURNING_BITS));
}

/* Rounds of rows until none is violated, the bound is good enough, or rounds stop paying. */
static thr_status solve_node(thr_branch *b, int i, const thr_limits *limits, thr_err *err)
{
  enum { PATIENCE = 12 };
  double risen = -INFINITY;
  int idle = 0;
  for (int added = 1; added;) {
    thr_status st = thr_relax_solve(&b->relax, limits, err);
    if (st) return st;
    b->rounds++;
    bool whole = b->relax.solved && b->relax.artificial < integral && most_fractional(b) < 0;
    if ((st = whole ? thr_branch_try_whole(b, err) : b->relax.solved ? thr_branch_try_rounded(b, err) : THR_OK)) return st;
    double target = ldexp((double)(b->best_price - thr_branch_tolerance(b)), -THR_TURNING_BITS);
    if (!b->relax.solved) b->stopped = true;
    if (b->relax.objective >= target || b->stopped) break;
    idle = b->relax.objective > risen + 1e-3 * (target - risen) ? 0 : idle + 1;
    if (idle == 0) risen = b->relax.objective;
    if (idle > PATIENCE && !whole) break;
    if ((st = thr_relax_separate(&b->relax, limits, &added, err))) return st;
    b->stopped |= thr_limits_stop(limits);
  }
  return certify(b, i, err);
}

/* Tube joints: the relaxation of a large framework is not solved in the time that there is, and hardly better than the ascent; of
 * any it says little of where good plans are. So some rows, then annealing, then the rest of the rows. */
static thr_status solve_tied_root(thr_branch *b, int i, thr_err *err)
{
  enum { ROUNDS = 3, LARGE = 5000 };
  bool large = b->c->first_extra > LARGE, unsolved = large;
  thr_limits some = thr_limits_part(b->limits, 0.4);
  thr_status st = large ? THR_OK : solve_node(b, i, &some, err);
  unsolved |= b->stopped;
  if (st || closed(b, i)) return st;
  some = thr_limits_part(b->limits, large ? 0.9 : 0.6);
  if (b->found) st = thr_branch_anneal(b, &some, ROUNDS, err);
  b->stopped = thr_limits_stop(b->limits);
  return st || !unsolved || b->stopped || closed(b, i) ? st : solve_node(b, i, b->limits, err);
}

static thr_status split(thr_branch *b, int i, thr_err *err)
{
  int k = most_fractional(b), child[2];
  if (k < 0) return THR_OK;
  if (b->n_nodes + 2 > b->most_nodes) {
    b->stopped = true;
    return THR_OK;
  }
  int value = (int)floor(b->relax.x[k]);
  for (int side = 0; side < 2; side++) {
    thr_branch_node n = {.parent = i,
                         .depth = b->node[i].depth + 1,
                         .column = k,
                         .value = value,
                         .high = side == 1,
                         .bound = b->node[i].bound,
                         .dual = b->node[i].dual,
                         .open = true};
    thr_status st = new_node(b, n, &child[side], err);
    if (st) return st;
  }
  b->node[i].low_child = child[0];
  b->node[i].high_child = child[1];
  b->node[i].branched = k;
  b->node[i].branch_value = value;
  return THR_OK;
}

/* The open node of least bound, the deepest of equals; -1 if every open node is closed by its bound. */
static int next_node(const thr_branch *b)
{
  int best = -1;
  for (int i = 0; i < b->n_nodes; i++) {
    const thr_branch_node *n = &b->node[i];
    if (!n->open || (n->dual >= 0 && closed(b, i))) continue;
    if (best < 0 || n->bound < b->node[best].bound || (n->bound == b->node[best].bound && n->depth > b->node[best].depth))
      best = i;
  }
  return best;
}

static double covers(const thr_turning_columns *c)
{
  double sum = 0;
  for (int e = 0; e < c->f->n_edges; e++)
    sum += c->cover[e];
  return sum;
}

/* No programme: the bound of the nodes, or of the ascent, and the plans that there are. */
static thr_status settle_for_bound(thr_branch *b, bool tied, thr_err *err)
{
  thr_status st = tied ? climb(b, 0, err) : THR_OK;
  b->stopped = true;
  return st;
}

thr_status thr_branch_run(thr_branch *b, thr_err *err)
{
  const int root = 0;
  bool tied = b->c->task->tube && !b->c->task->free_turns;
  double penalty = 10 + (b->found ? ldexp((double)b->best_price, -THR_TURNING_BITS) : 10 * covers(b->c));
  if (!b->c->task->free_turns) penalty += 2 * b->c->task->price_per_length * thr_frame_total_length(b->c->f);
  thr_status st = b->n_nodes ? THR_OK : thr_branch_begin(b, err);
  if (!st && b->dense) return settle_for_bound(b, tied, err);
  if (!st && !b->projected && !b->c->task->free_turns && b->found && !tied && closed(b, root)) return THR_OK;
  if (!st) st = thr_relax_init(&b->relax, b->c, b->projected, penalty, b->limits, err);
  if (!st && tied) st = climb(b, root, err);
  for (int i; !st && !b->stopped && (i = next_node(b)) >= 0;) {
    st = enter(b, i, err);
    if (!st) st = i == root && tied ? solve_tied_root(b, i, err) : solve_node(b, i, b->limits, err);
    if (st) break;
    report(b);
    if (b->stopped) break;
    b->node[i].open = false;
    if (i == root && b->found && !b->c->task->tube && !closed(b, i))
      st = thr_cycles_improve(b, (int)fmin(2000, 1e6 / b->c->f->n_edges), err);
    if (!st && !closed(b, i)) st = split(b, i, err);
  }
  return st;
}

/* What the proof is to prove: what closes the search, or what all leaves prove but a thousandth of the gap, for which very many
 * leaves may be left out where the bound hardly rises. */
static int64_t worth_proving(const thr_branch *b)
{
  int64_t target = b->found ? b->best_price - thr_branch_tolerance(b) : INT64_MAX, least = target;
  for (int i = 0; i < b->n_nodes; i++)
    if (!b->node[i].low_child && b->node[i].bound < least) least = b->node[i].bound;
  return least - (b->found ? (target - least) / 1000 : 0);
}

/* place[i]: number of node i in the proof, -1 = not needed, because a node above it proves enough. */
static int place_nodes(const thr_branch *b, int64_t enough, int *place)
{
  int n = 0;
  for (int i = 0; i < b->n_nodes; i++) {
    int above = b->node[i].parent;
    bool needed = above < 0 || (place[above] >= 0 && b->node[above].bound < enough);
    place[i] = needed ? n++ : -1;
  }
  return n;
}

static thr_turning_node proof_node(const thr_branch *b, const thr_branch_node *n, const int *place)
{
  return (thr_turning_node){.low = place[n->low_child],
                            .high = place[n->high_child],
                            .a = b->c->half[n->branched][0],
                            .b = b->c->half[n->branched][1],
                            .value = n->branch_value,
                            .dual = -1};
}

thr_status thr_branch_proof(thr_branch *b, thr_turning_proof *p, thr_err *err)
{
  *p = (thr_turning_proof){.n_ends = b->c->n_ends};
  p->node = thr_calloc((size_t)b->n_nodes, sizeof *p->node);
  p->dual = thr_calloc((size_t)b->n_duals, sizeof *p->dual);
  int *moved = thr_calloc((size_t)b->n_duals, sizeof *moved), *place = thr_calloc((size_t)b->n_nodes, sizeof *place);
  thr_status st = p->node && p->dual && moved && place ? THR_OK : thr_nomem(err);
  int64_t enough = worth_proving(b);
  if (!st) p->n_nodes = place_nodes(b, enough, place);
  for (int i = 0; i < b->n_nodes && !st; i++) {
    const thr_branch_node *n = &b->node[i];
    if (place[i] < 0) continue;
    if (n->low_child && n->bound < enough) {
      p->node[place[i]] = proof_node(b, n, place);
      continue;
    }
    if (!moved[n->dual]) {
      p->dual[p->n_duals] = b->dual[n->dual];
      b->dual[n->dual] = (thr_turning_dual){0};
      moved[n->dual] = ++p->n_duals;
    }
    p->node[place[i]] = (thr_turning_node){.dual = moved[n->dual] - 1};
  }
  free(moved);
  free(place);
  if (st) thr_turning_proof_destroy(p);
  return st;
}
