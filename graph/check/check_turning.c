/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the claim about turning: the price of the cords' turns and the bound that its proof gives.
 *
 * The price is recomputed from the cords. The bound comes from the tree of multipliers
 * (turning_proof.c), from single edges and prices of walks (walk_proof.c), and in components of few
 * edges from tables over all sets of edges (few_edges.c). The plan must be of the kind that the
 * proof is about: no U-turns but at nodes with one edge, no more passes over an edge and no more
 * length than stated. Where all turns are multiples of one angle the bound is rounded up to the
 * next one. */
#include "graph/number.h"
#include "graph/check/check_parts.h"
#include "graph/plan/walk_proof.h"

#include <math.h>
#include <stdlib.h>

double thr_check_price(const thr_frame *frame, thr_turn_cost cost, int in, int out)
{
  if (thr_turn_counted(cost)) return thr_turn_price(frame, cost, in, out);
  return thr_turn_cost_of(cost, in == (out ^ 1) ? THR_PI : thr_check_angle(frame, in, out));
}

/* ---- the cords ---- */

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_cord *cord;
  int n_cords;
  int cords_least, cords_most; /* that a plan with these options has in all */
  int *passes;                 /* [n_edges] */
  bool *end_allowed;           /* [n_nodes] filled by thr_turning_task_of */
} walked_cords;

static void walked_destroy(walked_cords *walked)
{
  free(walked->passes);
  free(walked->end_allowed);
}

/* Computes how many cords plans with these options have in all; given ends make as many as this
 * plan has. */
static thr_status count_cords(walked_cords *walked, thr_err *err)
{
  int components;
  const thr_status st = thr_frame_components(walked->frame, NULL, &components, err);
  if (st) return st;

  bool counts = walked->request->ends == THR_ENDS_COUNTS;
  walked->cords_least = counts ? walked->n_cords : components * walked->request->cords_least;
  walked->cords_most = counts ? walked->n_cords : components * walked->request->cords;
  return THR_OK;
}

/* Counts the passes of the cords, and notes where cords may end. Release with walked_destroy, after
 * a failure too. */
static thr_status walked_init(walked_cords *walked, const thr_frame *frame,
                              const thr_request *options, const thr_cord *cord, int n_cords,
                              thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *walked = (walked_cords){.frame = frame, .request = options, .cord = cord, .n_cords = n_cords};
  walked->passes = thr_calloc((size_t)frame->n_edges, sizeof *walked->passes);
  walked->end_allowed = thr_calloc(n, sizeof *walked->end_allowed);
  if (!walked->passes || !walked->end_allowed) return thr_nomem(err);

  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      walked->passes[cord[i].half[k] >> 1]++;
  return count_cords(walked, err);
}

/* Computes the price of a cord's turns. Refuses a U-turn where the proof's plans have none. */
static thr_status price_cord(const walked_cords *walked, const thr_cord *cord, double *price,
                             thr_err *err)
{
  int turns = walked->request->ends == THR_ENDS_CLOSED ? cord->n_passes : cord->n_passes - 1;
  *price = 0;

  for (int k = 0; k < turns; k++) {
    int in = cord->half[k], out = cord->half[k + 1 < cord->n_passes ? k + 1 : 0],
        v = thr_head(walked->frame, in);
    bool back = in == (out ^ 1);

    /* A U-turn at a node with other edges is no column of the proof. */
    if (back && thr_degree(walked->frame, v) > 1)
      return thr_fail(err, THR_EVIOLATED,
                      "proof.turning: cord %s turns back at node %d after pass %d; the proof is "
                      "about plans that turn back only at "
                      "nodes with one edge",
                      cord->id, v, k + 1);

    *price += thr_check_price(walked->frame, walked->request->turning.cost, in, out);
  }
  return THR_OK;
}

/* ---- turns that are all multiples of one angle ---- */

enum { MOST_PARTS = 180, SEEN = 16 };

/* The parts of pi that are left, and the angles that were last compared with them, in a circle. */
typedef struct {
  bool in[MOST_PARTS + 1];
  double seen[SEEN];
  int n_seen;
} parts;

/* Leaves in[k] only where the angle is a multiple of pi / k, and returns whether any is left. */
static bool keep_parts(parts *left, double angle, double tolerance)
{
  bool any = false;

  /* Most angles of a framework repeat. */
  for (int i = 0; i < SEEN && i < left->n_seen; i++)
    if (left->seen[i] == angle) return true;
  left->seen[left->n_seen++ % SEEN] = angle;

  for (int k = 1; k <= MOST_PARTS; k++) {
    const double times = angle * k / THR_PI;
    left->in[k] = left->in[k] && fabs(times - round(times)) * THR_PI / k <= tolerance;
    any |= left->in[k];
  }

  return any;
}

/* Returns the largest part of pi, at least pi / 180, of which every turn at a node is a multiple,
 * within 9e-10 over most_passes; 0 if there is none. O(sum of degrees^2). */
static double common_angle(const thr_frame *frame, int most_passes)
{
  const double tolerance = 9e-10 / most_passes;
  parts left = {.n_seen = 0};
  int k = 1;
  for (int i = 1; i <= MOST_PARTS; i++)
    left.in[i] = true;

  for (int v = 0; v < frame->n_nodes; v++) {
    const int n = thr_degree(frame, v), *half = &frame->half[frame->first[v]];
    for (int i = 0; i < n; i++)
      for (int j = i + 1; j < n; j++)
        if (!keep_parts(&left, thr_check_angle(frame, half[i] ^ 1, half[j]), tolerance)) return 0;
  }

  /* The smallest k is the largest part. */
  while (!left.in[k])
    k++;
  return THR_PI / k;
}

/* Rounds a bound on a sum of turns up to a multiple of the angle (0: none), but for 1e-9 for each
 * edge: the sum has no more turns than most_passes of every edge. */
static double round_up(const walked_cords *walked, double angle, double bound)
{
  const double rounding = 1e-9 * walked->frame->n_edges;
  if (angle == 0 || bound <= rounding) return bound;
  return fmax(bound, ceil((bound - rounding) / angle) * angle - rounding);
}

/* Adds to *found, which is zeros, what follows from the cords, and checks that they are of the kind
 * that the proof is about. *largest_price: the largest price of a cord's turns; found->largest is
 * the same unless a pull is minimized. */
static thr_status judge_cords(const walked_cords *walked, thr_turning_claim *found,
                              double *largest_price, thr_err *err)
{
  const thr_frame *frame = walked->frame;
  double length = 0;

  for (int i = 0; i < walked->n_cords; i++) {
    double price;
    thr_status st = price_cord(walked, &walked->cord[i], &price, err);
    if (st) return st;

    found->price += price;
    *largest_price = fmax(*largest_price, price);
    found->largest =
        fmax(found->largest, thr_wants_pull(walked->request)
                                 ? thr_check_pulled_turning(frame, &walked->cord[i], false)
                                 : price);
  }

  /* No more passes over an edge, and no more length, than the proof allows. */
  for (int e = 0; e < frame->n_edges; e++) {
    length += walked->passes[e] * frame->length[e];
    if (walked->passes[e] > found->most_passes)
      return thr_fail(
          err, THR_EVIOLATED,
          "proof.turning: %d passes over edge %d; the proof is about plans with at most %d",
          walked->passes[e], e, found->most_passes);
  }

  if (found->length_limit >= 0 && length > found->length_limit &&
      !thr_check_close(length, found->length_limit, length))
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning: the cords are %.12g long; the proof is about plans of at most %.12g",
        length, found->length_limit);
  return THR_OK;
}

/* ---- the claim ---- */

int thr_check_cords_of(const thr_turning_columns *columns, int k, int cords)
{
  int ends = 0;
  for (int v = 0; v < columns->f->n_nodes && columns->task->end_count; v++)
    if (columns->component[v] == k) ends += columns->task->end_count[v];
  return ends > 0 ? ends / 2 : cords;
}

/* Raises *largest to what the tree proves of each component alone, shared out evenly among its
 * cords, and to what prices of walks make of that. */
thr_status thr_check_shares(const thr_turning_columns *columns, int cords,
                            const thr_turning_proof *tree, double *all, double *largest,
                            thr_err *err)
{
  double by_walks = 0, *bound_of = thr_calloc((size_t)columns->n_components, sizeof *bound_of);
  if (!bound_of) return thr_nomem(err);

  thr_status st = thr_turning_proof_check_columns(columns, tree, all, bound_of, err);
  if (!st && tree->walks.unit)
    st = thr_walk_proof_check(columns, THR_WALK_TURNING, &tree->walks, cords,
                              bound_of[thr_walk_component(columns, &tree->walks)], &by_walks, err);

  /* The largest of so many cords is at least their mean. */
  for (int k = 0; k < columns->n_components && !st; k++)
    *largest = fmax(*largest, fmax(by_walks, bound_of[k] / thr_check_cords_of(columns, k, cords)));

  free(bound_of);
  return st;
}

/* Computes what tree, single edges, walks and tables over sets of few edges prove of the price of
 * turns: all: of all cords; *largest: of the cord with the largest price, component by component
 * (limit: need not be known above it). cords: the most that a component may have. */
static thr_status bound_by_tree(const thr_turning_columns *columns, const thr_request *options,
                                int cords, const thr_turning_proof *tree, double limit, double *all,
                                double *largest, thr_err *err)
{
  double few_sum, few_largest;
  thr_status st = thr_walk_forced(columns, false, largest, err);
  if (!st) st = thr_check_shares(columns, cords, tree, all, largest, err);
  if (!st) st = thr_few_edges_bounds(columns->f, options, limit, &few_sum, &few_largest, err);
  if (st) return st;

  /* Each bound holds; the largest counts. */
  *all = fmax(*all, few_sum);
  *largest = fmax(*largest, few_largest);
  return THR_OK;
}

/* Computes what the claim's proof gives for these cords, and fills the bounds of found. */
static thr_status judge_tree(const walked_cords *walked, const thr_turning_claim *claim,
                             double largest_price, thr_turning_claim *found, thr_err *err)
{
  double bound, forced, side = 0, passes = 0, length = 0;
  const bool pull = thr_wants_pull(walked->request);
  thr_turning_proof tree = claim->tree;
  const int cords =
      walked->request->ends == THR_ENDS_COUNTS ? walked->cords_most : walked->request->cords;

  /* The passes that prices can be summed over, for the rounding; and the length. */
  for (int e = 0; e < walked->frame->n_edges; e++) {
    passes += fmin(walked->passes[e], 2 * thr_plan_cover(walked->frame, walked->request, e));
    length += walked->passes[e] * walked->frame->length[e];
  }

  /* The cords must be among the plans that the proof is about, or a limit just below their length
   * would prove anything. */
  double limit = claim->length_limit < 0 ? -1 : fmax(claim->length_limit, length);
  thr_turning_task task = thr_turning_task_of(walked->frame, walked->request, walked->end_allowed);
  task.most_passes = claim->most_passes;
  task.extra_limit = thr_turning_extra_limit(walked->frame, walked->request->cover, limit);

  /* The tree, and whatever else bounds turns. */
  thr_turning_columns columns;
  thr_status st = thr_turning_columns_init(&columns, walked->frame, &task, err);
  if (st) return st;
  if (pull) tree.walks = (thr_walk_proof){0};
  st = bound_by_tree(&columns, walked->request, cords, &tree, largest_price + 1e-3, &bound, &forced,
                     err);
  thr_turning_columns_destroy(&columns);
  if (!st && pull)
    st = thr_check_pulled_least(walked->frame, walked->request, &task, claim, &side, err);
  if (st) return st;

  /* Every closed cord has a least price, and turns may be multiples of one angle. */
  if (walked->request->ends == THR_ENDS_CLOSED)
    bound = fmax(bound, thr_turn_closed(walked->request->turning.cost) * walked->cords_least);
  const double angle = walked->request->turning.cost == THR_TURN_ANGLE
                           ? common_angle(walked->frame, claim->most_passes)
                           : 0;
  bound = round_up(walked, angle, bound);

  /* Prices are sums of so many roundings: equal within 1e-9 of a U-turn for each pass, of an edge
   * at most twice those it needs. */
  double tolerance = 2e-9 * passes * thr_turn_cost_of(walked->request->turning.cost, THR_PI);

  /* No true bound exceeds the price of an actual plan. */
  if (bound > found->price + tolerance)
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning: the tree proves %.12g, which is more than the turns of this plan, %.12g",
        bound, found->price);

  /* All cords together. */
  found->optimal = bound >= found->price - tolerance;
  found->lower_bound = found->optimal ? found->price : bound;
  found->gap = found->optimal ? 0 : (found->price - bound) / found->price;

  /* The cord that turns most: at least the mean of all. */
  found->largest_bound =
      round_up(walked, angle, pull ? side : fmax(found->lower_bound / walked->cords_most, forced));
  if (found->largest_bound > found->largest + tolerance)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning: some cord is proved to turn by %.12g, which is more than any "
                    "of this plan, %.12g",
                    found->largest_bound, found->largest);

  found->largest_optimal = found->largest <= found->largest_bound + tolerance;
  if (found->largest_optimal) found->largest_bound = found->largest;
  return THR_OK;
}

thr_status thr_check_turning(const thr_frame *frame, const thr_request *options,
                             const thr_cord *cord, int n_cords, const thr_turning_claim *claim,
                             thr_turning_claim *found, thr_err *err)
{
  walked_cords walked;
  *found = (thr_turning_claim){.present = true,
                               .most_passes = claim->most_passes,
                               .length_limit = claim->length_limit,
                               .cut = claim->cut};

  /* A proof has to be about all plans with up to so many passes over an edge. */
  int least_most = thr_turning_most_passes(frame, options->cover);
  if (claim->most_passes < least_most)
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning.most_passes: %d; a proof is about plans with up to %d passes over an edge",
        claim->most_passes, least_most);

  /* Prices of walks must be of the measure that is minimized. */
  if (claim->tree.walks.unit > 0 && claim->tree.walks.pulled != thr_wants_pull(options))
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning.proof.walks: with minimize pull they are within a pull, else not");
  if (claim->cut > 0 && !thr_wants_pull(options))
    return thr_fail(err, THR_EVIOLATED, "proof.turning.largest.cut: with minimize pull only");

  thr_status st = walked_init(&walked, frame, options, cord, n_cords, err);
  double largest_price = 0;
  if (!st) st = judge_cords(&walked, found, &largest_price, err);
  if (!st) st = judge_tree(&walked, claim, largest_price, found, err);
  walked_destroy(&walked);
  return st;
}

/* ---- what the plan states ---- */

/* Compares a number that the claim states with the one found. */
static thr_status stated(const char *name, double said, double found, double whole, thr_err *err)
{
  if (thr_check_close(said, found, whole)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "proof.turning.%s: stated %.12g, but expected %.12g", name,
                  said, found);
}

/* Checks that a bound is no more than what is proved, but for rounding of the latter. It may be
 * less. */
static thr_status not_above(const char *name, double said, double found, thr_err *err)
{
  return said <= found ? THR_OK : stated(name, said, found, 1 + found, err);
}

/* Checks that only what is proved to be optimal is said to be, and that its bound is its price. */
static thr_status check_optimal(const thr_turning_claim *claim, const thr_turning_claim *found,
                                double whole, thr_err *err)
{
  if (claim->optimal && !found->optimal)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning: says optimal, but the tree only proves %.12g of %.12g",
                    found->lower_bound, found->price);
  if (claim->largest_optimal && !found->largest_optimal)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning.largest: says optimal, but only %.12g of %.12g is proved",
                    found->largest_bound, found->largest);

  if (claim->optimal && !thr_check_close(claim->lower_bound, claim->price, whole))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning: says optimal, but its lower bound %.12g is not the price %.12g",
                    claim->lower_bound, claim->price);
  if (claim->largest_optimal && !thr_check_close(claim->largest_bound, claim->largest, whole))
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning.largest: says optimal, but its lower bound %.12g is not the price %.12g",
        claim->largest_bound, claim->largest);

  return THR_OK;
}

/* Checks that the limit on the length excludes no plan that the options allow: those up to
 * length_slack above the least length that is proved. (A plan with a weak proof of length may have
 * a lower limit: its claim about turning names the limit.) */
static thr_status check_limit(const thr_plan *plan, double least_length, thr_err *err)
{
  const double slack = plan->options.turning.length_slack, limit = plan->turning.length_limit;

  /* Without a slack the options allow any length. */
  if (slack < 0) {
    if (limit < 0) return THR_OK;
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning.length_limit: %.12g, but the options allow any length", limit);
  }

  if (limit < 0) return THR_OK; /* more than asked for */

  if (!plan->proof.present)
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.turning.length_limit: nothing says what the least length is (no proof.length)");

  /* Version 1 knew no bounds of few edges with a slack: there what the plan states is enough. */
  const double least =
      plan->options.old_pull ? fmin(least_length, plan->proof.lower_bound) : least_length;

  const double needed = (1 + slack) * least;
  if (limit >= needed * (1 - 5e-12))
    return THR_OK; /* the proof allows 1e-11 more: thr_turning_extra_limit */
  return thr_fail(
      err, THR_EVIOLATED,
      "proof.turning.length_limit: %.12g shuts out plans of up to %.12g, which the options allow",
      limit, needed);
}

thr_status thr_check_turning_claim(const thr_plan *plan, double least_length, thr_err *err)
{
  const thr_turning_claim *claim = &plan->turning;
  thr_turning_claim found;
  if (plan->options.turning.tour != THR_TOUR_LEAST)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.turning: a classical tour claims nothing about its turning");

  thr_status st = check_limit(plan, least_length, err);
  if (!st)
    st = thr_check_turning(&plan->frame, &plan->options, plan->cord, plan->n_cords, claim, &found,
                           err);
  if (st) return st;

  /* Compare what is stated with what is found. */
  double whole = 1 + found.price;
  if ((st = stated("price", claim->price, found.price, whole, err))) return st;
  if ((st = stated("largest.price", claim->largest, found.largest, whole, err))) return st;
  if ((st = not_above("lower_bound", claim->lower_bound, found.lower_bound, err))) return st;
  if ((st = not_above("largest.lower_bound", claim->largest_bound, found.largest_bound, err)))
    return st;

  double gap = found.price > 0 ? (claim->price - claim->lower_bound) / found.price : 0;
  if ((st = stated("gap", claim->gap, gap, 1, err))) return st;
  return check_optimal(claim, &found, whole, err);
}
