/* A bound from the nodes one by one. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"
#include "graph/sort.h"
#include "tortuosity/proof/nearest.h"

#include <stdlib.h>

enum { NEAREST = 10, ROUNDS = 6, NEW_PER_HALF = 4 };

/* The assignment at one node: half-edge i is nodes i and degree + i of the matching. */
typedef struct {
  const thr_turning_columns *c;
  const thr_limits *limits;
  int v, degree;
  int n_edges, capacity, weights; /* weights: capacity of weight[] */
  int (*edge)[2];
  int64_t *weight;
  int64_t *share; /* [degree] multipliers */
} assignment;

static thr_status add_edge(assignment *a, int from, int to, int64_t weight, thr_err *err)
{
  thr_status st = thr_grow(&a->edge, a->n_edges, &a->capacity, sizeof *a->edge, err);
  if (!st) st = thr_grow(&a->weight, a->n_edges, &a->weights, sizeof *a->weight, err);
  if (st) return st;
  a->edge[a->n_edges][0] = from;
  a->edge[a->n_edges][1] = a->degree + to;
  a->weight[a->n_edges++] = weight;
  return THR_OK;
}

static thr_status add_turn(assignment *a, int i, int j, int64_t weight, thr_err *err)
{
  thr_status st = add_edge(a, i, j, weight, err);
  return st ? st : add_edge(a, j, i, weight, err);
}

static bool is_near(const thr_nearest *nearest, int i, int j)
{
  for (int k = 0; k < nearest->n; k++)
    if (nearest->partner[i * nearest->n + k] == j) return true;
  return false;
}

/* The cheapest turns; and each half-edge with itself for twice its cheapest turn, which covers it alone. */
static thr_status first_edges(assignment *a, const thr_nearest *nearest, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < nearest->degree && !st; i++) {
    st = add_edge(a, i, i, 2 * nearest->weight[i * nearest->n], err);
    for (int k = 0; k < nearest->n && !st; k++) {
      int j = nearest->partner[i * nearest->n + k];
      if (i < j || !is_near(nearest, j, i)) st = add_turn(a, i, j, nearest->weight[i * nearest->n + k], err);
    }
  }
  return st;
}

/* Turns that the multipliers overload become edges, up to so many per half-edge: the first in their order. */
static thr_status price_turns(assignment *a, bool *complete, thr_err *err)
{
  const int64_t *weight = a->c->weight + a->c->pair_first[a->v];
  int64_t most = 0;
  *complete = true;
  for (int i = 0; i < a->degree; i++)
    if (a->share[i] > most) most = a->share[i];
  for (int i = 0; i < a->degree; weight += a->degree - 1 - i, i++) {
    const int64_t *own = weight - i - 1;
    for (int j = i + 1, added = 0; j < a->degree && added < NEW_PER_HALF; j++) {
      if (own[j] >= a->share[i] + most || own[j] >= a->share[i] + a->share[j]) continue;
      *complete = false;
      added++;
      thr_status st = add_turn(a, i, j, own[j], err);
      if (st) return st;
    }
  }
  return THR_OK;
}

/* Raises the multipliers, one after the other, to what the others leave of their turns. */
static void raise_shares(assignment *a)
{
  const int64_t *weight = a->c->weight + a->c->pair_first[a->v];
  for (int i = 0; i < a->degree; i++) {
    int64_t least = INT64_MAX;
    for (int j = 0, column = i - 1; j < a->degree; j++) {
      if (j != i && weight[column] - a->share[j] < least) least = weight[column] - a->share[j];
      column += j < i ? a->degree - 2 - j : 1;
    }
    if (least > a->share[i]) a->share[i] = least;
  }
}

/* Of the dearer of two half-edges that pay more than their turn costs. */
static void repair(assignment *a)
{
  const int64_t *weight = a->c->weight + a->c->pair_first[a->v];
  for (int i = 0; i < a->degree; i++)
    for (int j = i + 1; j < a->degree; j++) {
      int64_t over = a->share[i] + a->share[j] - *weight++;
      int dear = a->share[j] > a->share[i] ? j : i, cheap = i + j - dear;
      if (over <= 0) continue;
      int64_t less = over < a->share[dear] ? over : a->share[dear];
      a->share[dear] -= less;
      a->share[cheap] -= over - less;
    }
}

static void take_shares(assignment *a, const thr_matching *matching)
{
  for (int i = 0; i < a->degree; i++) {
    int64_t both = matching->dual[i] + matching->dual[a->degree + i]; /* in halves of a weight, for each of two copies */
    a->share[i] = both > 0 ? both / 4 : 0;
  }
}

/* Matching and pricing until no turn is overloaded; where that is stopped, from half of every cheapest turn. */
static thr_status assign(assignment *a, const thr_nearest *nearest, thr_err *err)
{
  thr_matching matching = {0};
  thr_err stopped = {0};
  bool complete = false;
  thr_status st = first_edges(a, nearest, err);
  for (int i = 0; i < a->degree && !st; i++)
    a->share[i] = nearest->weight[i * nearest->n] / 2;
  for (int round = 0; round < ROUNDS && !complete && !st && !thr_limits_stop(a->limits); round++) {
    thr_matching_problem matching_problem = {2 * a->degree, a->n_edges, (const int(*)[2])a->edge, a->weight};
    thr_status found = round ? thr_matching_again(&matching_problem, a->limits, &matching, &stopped)
                             : thr_matching_solve(&matching_problem, a->limits, &matching, &stopped);
    if (found == THR_ELIMIT) break;
    st = found ? thr_fail(err, found, "%s", stopped.text) : THR_OK;
    if (!st) take_shares(a, &matching);
    if (!st) st = price_turns(a, &complete, err);
  }
  if (!st && !complete) repair(a);
  if (!st && !complete) raise_shares(a);
  thr_matching_destroy(&matching);
  return st;
}

static thr_status solve_node(const thr_turning_columns *turning_columns, int v, const thr_limits *limits, int64_t *potential,
                             thr_err *err)
{
  assignment a = {.c = turning_columns, .limits = limits, .v = v, .degree = thr_degree(turning_columns->f, v)};
  thr_nearest near = {0};
  thr_status st = thr_nearest_find(turning_columns, v, NEAREST, &near, err);
  if (!st && !(a.share = thr_calloc((size_t)a.degree, sizeof *a.share))) st = thr_nomem(err);
  if (!st) st = assign(&a, &near, err);
  for (int i = 0; i < a.degree && !st; i++)
    potential[turning_columns->f->half[turning_columns->f->first[v] + i]] = a.share[i];
  thr_nearest_destroy(&near);
  free(a.edge);
  free(a.weight);
  free(a.share);
  return st;
}

/* An end takes the place of half a turn: what that saves at most is owed to every end. */
static void charge_ends(const thr_turning_columns *turning_columns, thr_turning_dual *dual)
{
  for (int j = turning_columns->first_end; j < turning_columns->first_back; j++) {
    int h = turning_columns->half[j][0], k = turning_columns->end_group[thr_tail(turning_columns->f, h)];
    if (-dual->potential[h] < dual->ends[k]) dual->ends[k] = -dual->potential[h];
  }
}

static bool is_odd(const thr_turning_columns *turning_columns, int v)
{
  int sum = 0;
  for (int i = turning_columns->f->first[v]; i < turning_columns->f->first[v + 1]; i++)
    sum += turning_columns->cover[turning_columns->f->half[i] >> 1];
  return sum % 2 != 0;
}

/* A node of odd passes needs one more, or an end: what the multipliers leave of the cheapest extra pass, half of it where that
 * serves another such node too. */
static int64_t pass_left(const thr_turning_columns *turning_columns, const thr_turning_dual *dual, const bool *odd, int v)
{
  int64_t least = INT64_MAX;
  for (int i = turning_columns->f->first[v]; i < turning_columns->f->first[v + 1]; i++) {
    int h = turning_columns->f->half[i];
    int64_t extra =
        turning_columns->weight[turning_columns->first_extra + (h >> 1)] + dual->potential[h] + dual->potential[h ^ 1];
    if (odd[thr_head(turning_columns->f, h)]) extra /= 2;
    if (turning_columns->most[h >> 1] > turning_columns->cover[h >> 1] && extra < least) least = extra;
  }
  return least < INT64_MAX ? least : 0;
}

/* What the multipliers leave of the cheapest end at node v. */
static int64_t end_left(const thr_turning_columns *turning_columns, const thr_turning_dual *dual, int v)
{
  int64_t least = INT64_MAX;
  for (int i = turning_columns->f->first[v]; i < turning_columns->f->first[v + 1]; i++) {
    int h = turning_columns->f->half[i];
    int64_t end = -dual->potential[h] - dual->ends[turning_columns->end_group[v]];
    if (turning_columns->end_column[h] >= 0 && end < least) least = end;
  }
  return least;
}

/* Where that proves more, ends cost so much more that no odd node gains by one. price: [n_nodes] of parity, without ends. */
static thr_status charge_parity(const thr_turning_columns *turning_columns, thr_turning_dual *dual, int64_t *price, thr_err *err)
{
  int64_t *more = thr_calloc((size_t)turning_columns->n_ends, sizeof *more),
          *gain = thr_calloc((size_t)turning_columns->n_ends, sizeof *gain);
  thr_status st = more && gain ? THR_OK : thr_nomem(err);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++) {
    int64_t lack = price[v] - end_left(turning_columns, dual, v);
    int k = turning_columns->end_group[v];
    if (lack <= 0) continue;
    gain[k] += lack;
    if (lack > more[k]) more[k] = lack;
  }
  for (int k = 0; k < turning_columns->n_ends && !st; k++)
    if (more[k] > 0 && gain[k] / more[k] > turning_columns->supply[k][1]) dual->ends[k] -= more[k];
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++) {
    int64_t end = end_left(turning_columns, dual, v);
    if (end < price[v]) price[v] = end;
  }
  free(more);
  free(gain);
  return st;
}

/* The half-edges of a node as an odd set. */
static thr_status add_set(const thr_turning_columns *turning_columns, thr_turning_dual *dual, int v, int64_t value, thr_err *err)
{
  int n = thr_degree(turning_columns->f, v), *member = thr_calloc((size_t)n, sizeof *member);
  if (!member) return thr_nomem(err);
  for (int i = 0; i < n; i++)
    member[i] = turning_columns->f->half[turning_columns->f->first[v] + i];
  thr_sort_ints(member, (size_t)n);
  dual->odd[dual->n_odd++] = (thr_turning_set){n, member, value};
  return THR_OK;
}

static thr_status add_parity(const thr_turning_columns *turning_columns, thr_turning_dual *dual, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes;
  bool *odd = thr_calloc(n, sizeof *odd);
  int64_t *price = thr_calloc(n, sizeof *price);
  dual->odd = thr_calloc(n, sizeof *dual->odd);
  thr_status st = odd && price && dual->odd ? THR_OK : thr_nomem(err);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    odd[v] = is_odd(turning_columns, v);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    price[v] = odd[v] ? pass_left(turning_columns, dual, odd, v) : 0;
  if (!st) st = charge_parity(turning_columns, dual, price, err);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    if (price[v] > 0) st = add_set(turning_columns, dual, v, price[v], err);
  free(odd);
  free(price);
  return st;
}

thr_status thr_nodes_bound(const thr_turning_columns *turning_columns, const thr_limits *limits, thr_turning_dual *dual,
                           thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  *dual = (thr_turning_dual){.potential = thr_calloc(2 * (size_t)frame->n_edges, sizeof *dual->potential),
                             .ends = thr_calloc((size_t)turning_columns->n_ends, sizeof *dual->ends)};
  thr_status st = dual->potential && dual->ends ? THR_OK : thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (thr_degree(frame, v) > 1) st = solve_node(turning_columns, v, limits, dual->potential, err);
  for (int j = turning_columns->first_back; j < turning_columns->n_columns && !st;
       j++) /* where a cord turns back its edge is passed twice */
    dual->potential[turning_columns->half[j][0]] = turning_columns->weight[j] / 2;
  if (!st) charge_ends(turning_columns, dual);
  if (!st && !turning_columns->task->end_count) st = add_parity(turning_columns, dual, err);
  if (st) thr_turning_dual_destroy(dual);
  return st;
}
