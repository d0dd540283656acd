/* Best bound first; every node keeps the multipliers that prove its bound. */
#include "tortuosity/proof/branch.h"
#include "graph/angle.h"
#include "graph/framework/frame.h"
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
  thr_tree_destroy(&b->tree);
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

/* Takes multipliers over, for node i if they prove more than it has. */
static thr_status keep_dual(thr_branch *b, int i, thr_turning_dual d, const int *low, const int *high, thr_err *err)
{
  int64_t bound;
  thr_status st = thr_turning_dual_bound(b->c, &d, low, high, &bound, err);
  thr_tree_node *n = &b->tree.node[i];
  if (!st && (n->proof < 0 || (double)bound > n->bound)) {
    st = thr_grow(&b->dual, b->n_duals, &b->duals_capacity, sizeof *b->dual, err);
    if (!st) {
      n->bound = (double)bound;
      n->proof = b->n_duals;
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
  return st ? st : keep_dual(b, i, d, b->tree.low, b->tree.high, err);
}

/* A node of this bound is closed. */
static double enough(const thr_branch *b)
{
  return b->found ? (double)(b->best_price - thr_branch_tolerance(b)) : INFINITY;
}

static bool closed(const thr_branch *b, int i)
{
  return b->tree.node[i].bound >= enough(b);
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

static thr_status init_tree(thr_branch *b, thr_err *err)
{
  size_t n = (size_t)b->c->n_columns;
  int *least = thr_calloc(n, sizeof *least);
  if (!least) return thr_nomem(err);
  for (size_t k = 0; k < n; k++)
    b->whole[k] = thr_turning_most(b->c, (int)k);
  thr_status st = thr_tree_init(&b->tree, b->c->n_columns, least, b->whole, err);
  b->tree.most_nodes = b->most_nodes;
  free(least);
  return st;
}

thr_status thr_branch_begin(thr_branch *b, thr_err *err)
{
  thr_turning_dual d;
  thr_status st = init_tree(b, err);
  if (st || b->c->task->free_turns || b->c->task->tube) return st;
  const thr_limits some = thr_limits_part(b->limits, 0.2);
  st = thr_nodes_bound(b->c, &some, &d, err);
  return st ? st : keep_dual(b, 0, d, NULL, NULL, err);
}

/* Where every open node's bound is above the best price, or none is open, that price is the bound: a plan has it. */
static void report(const thr_branch *b)
{
  if (!b->limits->progress) return;
  double least = fmin((double)b->best_price, thr_tree_bound(&b->tree));
  b->limits->progress(b->limits->user, "turning", ldexp((double)b->best_price, -THR_TURNING_BITS),
                      ldexp(least, -THR_TURNING_BITS));
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
    if (!b->relax.solved) b->tree.stopped = true;
    if (b->relax.objective >= target || b->tree.stopped) break;
    idle = b->relax.objective > risen + 1e-3 * (target - risen) ? 0 : idle + 1;
    if (idle == 0) risen = b->relax.objective;
    if (idle > PATIENCE && !whole) break;
    if ((st = thr_relax_separate(&b->relax, limits, &added, err))) return st;
    b->tree.stopped |= thr_limits_stop(limits);
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
  unsolved |= b->tree.stopped;
  if (st || closed(b, i)) return st;
  some = thr_limits_part(b->limits, large ? 0.9 : 0.6);
  if (b->found) st = thr_branch_anneal(b, &some, ROUNDS, err);
  b->tree.stopped = thr_limits_stop(b->limits);
  return st || !unsolved || b->tree.stopped || closed(b, i) ? st : solve_node(b, i, b->limits, err);
}

static thr_status set_bounds(void *user, int column, int low, int high, thr_err *err)
{
  thr_branch *b = user;
  return thr_relax_set(&b->relax, column, low, high, err);
}

/* A node's bound and plans; then the column to branch on. */
static thr_status solve(void *user, int i, thr_tree_branch *branch, thr_err *err)
{
  thr_branch *b = user;
  const thr_turning_task *t = b->c->task;
  bool root = i == 0, tied_root = root && t->tube && !t->free_turns;
  thr_status st = tied_root ? solve_tied_root(b, i, err) : solve_node(b, i, b->limits, err);
  if (st) return st;
  report(b);
  if (root && b->found && !t->tube && !b->tree.stopped && !closed(b, i))
    st = thr_cycles_improve(b, (int)fmin(2000, 1e6 / b->c->f->n_edges), err);
  b->tree.enough = enough(b);
  branch->column = most_fractional(b);
  if (branch->column >= 0) branch->value = (int)floor(b->relax.x[branch->column]);
  return st;
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
  b->tree.stopped = true;
  return st;
}

thr_status thr_branch_run(thr_branch *b, thr_err *err)
{
  const int root = 0;
  bool tied = b->c->task->tube && !b->c->task->free_turns;
  double penalty = 10 + (b->found ? ldexp((double)b->best_price, -THR_TURNING_BITS) : 10 * covers(b->c));
  if (!b->c->task->free_turns) penalty += 2 * b->c->task->price_per_length * thr_frame_total_length(b->c->f);
  thr_status st = b->tree.n_nodes ? THR_OK : thr_branch_begin(b, err);
  if (!st && b->dense) return settle_for_bound(b, tied, err);
  if (!st && !b->projected && !b->c->task->free_turns && b->found && !tied && closed(b, root)) return THR_OK;
  if (!st) st = thr_relax_init(&b->relax, b->c, b->projected, penalty, b->limits, err);
  if (!st && tied) st = climb(b, root, err);
  const thr_tree_calls calls = {b, NULL, set_bounds, solve};
  b->tree.enough = enough(b);
  return st ? st : thr_tree_run(&b->tree, &calls, err);
}

/* What the proof is to prove: what closes the search, or what all leaves prove but a thousandth of the gap, for which very many
 * leaves may be left out where the bound hardly rises. */
static double worth_proving(const thr_branch *b)
{
  double target = enough(b), least = target;
  for (int i = 0; i < b->tree.n_nodes; i++)
    if (!b->tree.node[i].child[0]) least = fmin(least, b->tree.node[i].bound);
  return least - (b->found ? (target - least) / 1000 : 0);
}

/* place[i]: number of node i in the proof, -1 = not needed, because a node above it proves enough. */
static int place_nodes(const thr_tree *t, double enough, int *place)
{
  int n = 0;
  for (int i = 0; i < t->n_nodes; i++) {
    int above = t->node[i].parent;
    bool needed = above < 0 || (place[above] >= 0 && t->node[above].bound < enough);
    place[i] = needed ? n++ : -1;
  }
  return n;
}

static thr_turning_node proof_node(const thr_branch *b, const thr_tree_node *n, const int *place)
{
  const thr_tree_node *child = &b->tree.node[n->child[0]];
  return (thr_turning_node){.low = place[n->child[0]],
                            .high = place[n->child[1]],
                            .a = b->c->half[child->column][0],
                            .b = b->c->half[child->column][1],
                            .value = child->value,
                            .dual = -1};
}

thr_status thr_branch_proof(thr_branch *b, thr_turning_proof *p, thr_err *err)
{
  *p = (thr_turning_proof){.n_ends = b->c->n_ends};
  const thr_tree *t = &b->tree;
  p->node = thr_calloc((size_t)t->n_nodes, sizeof *p->node);
  p->dual = thr_calloc((size_t)b->n_duals, sizeof *p->dual);
  int *moved = thr_calloc((size_t)b->n_duals, sizeof *moved), *place = thr_calloc((size_t)t->n_nodes, sizeof *place);
  thr_status st = p->node && p->dual && moved && place ? THR_OK : thr_nomem(err);
  double needed = worth_proving(b);
  if (!st) p->n_nodes = place_nodes(t, needed, place);
  for (int i = 0; i < t->n_nodes && !st; i++) {
    const thr_tree_node *n = &t->node[i];
    if (place[i] < 0) continue;
    if (n->child[0] && n->bound < needed) {
      p->node[place[i]] = proof_node(b, n, place);
      continue;
    }
    if (!moved[n->proof]) {
      p->dual[p->n_duals] = b->dual[n->proof];
      b->dual[n->proof] = (thr_turning_dual){0};
      moved[n->proof] = ++p->n_duals;
    }
    p->node[place[i]] = (thr_turning_node){.dual = moved[n->proof] - 1};
  }
  free(moved);
  free(place);
  if (st) thr_turning_proof_destroy(p);
  return st;
}
