/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks limits on the pull: what each cord needs, and that fewer cords would need more.
 *
 * A cord that is pulled at both ends is cut at one turn; the harder end has to overcome the larger
 * part of its turning, and the capstan law turns that into a ratio of tensions, exp(mu * turning).
 * That K cords are too few is proved by single edges, by a tree of multipliers for all turns
 * (turning_proof.c), by prices of walks within the pull (walk_proof.c), or in components of few
 * edges by all sets of edges (few_edges.c). */
#include "graph/check/check_parts.h"
#include "graph/framework/components.h"
#include "graph/plan/walk_proof.h"

#include <math.h>
#include <stdlib.h>

/* The exponent of the capstan law, mu times the turning, may exceed the limit by this part. */
static const double rounding = 1e-9;

/* ---- the cords ---- */

double thr_check_pulled_turning(const thr_frame *frame, const thr_cord *cord, bool at_pass)
{
  double whole = 0, before = 0;
  for (int k = 1; k < cord->n_passes; k++)
    whole += thr_check_angle(frame, cord->half[k - 1], cord->half[k]);

  /* The turn at the cut belongs to neither part, but in version 1 to the first one. */
  double larger = whole;
  for (int k = 1; k < cord->n_passes; k++) {
    const double turn = thr_check_angle(frame, cord->half[k - 1], cord->half[k]);
    larger = fmin(larger, fmax(before + (at_pass ? turn : 0), whole - before - turn));
    before += turn;
  }

  return larger;
}

thr_status thr_check_pulls(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                           int n_cords, thr_err *err)
{
  const double mu = options->physics.mu;
  for (int i = 0; i < n_cords && options->max_pull > 0; i++) {
    double exponent = mu * thr_check_pulled_turning(frame, &cord[i], options->old_pull),
           most = log(options->max_pull);

    if (exponent > most + rounding * (1 + most))
      return thr_fail(err, THR_EVIOLATED,
                      "cord %s: pulled at both ends it needs %.12g times the seating tension; the "
                      "plan's options allow %.12g",
                      cord[i].id, exp(exponent), options->max_pull);
  }
  return THR_OK;
}

/* ---- their length ---- */

/* Computes a lower bound on the length of at most so many cords (0: as many as the options say) of
 * the component that the prices are about, within the pull. */
static thr_status walks_bound(const thr_frame *frame, const thr_request *options,
                              const thr_check_walked *check_walked, const thr_walk_proof *walks,
                              int cords, int *component, double *bound, thr_err *err)
{
  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  int *most = thr_calloc((size_t)check_walked->n_components, sizeof *most);
  thr_turning_columns columns = {0};

  thr_status st = end_allowed && most ? THR_OK : thr_nomem(err);

  /* The columns of the task give the turns with their weights, and the ends. */
  if (!st) {
    const thr_turning_task task = thr_walk_length_task(frame, options, end_allowed);
    thr_check_most_cords(frame, options, check_walked, most);

    st = thr_turning_columns_init(&columns, frame, &task, err);
    *component = st ? 0 : thr_walk_component(&columns, walks);

    if (!st)
      st = thr_walk_pull_check(&columns, options, walks,
                               cords > 0 && cords < most[*component] ? cords : most[*component],
                               bound, err);
    thr_turning_columns_destroy(&columns);
  }

  free(end_allowed);
  free(most);
  return st;
}

thr_status thr_check_pulled_length(const thr_frame *frame, const thr_request *options,
                                   const thr_check_walked *check_walked,
                                   const thr_walk_proof *pulled, double *length, thr_err *err)
{
  double bound = 0;
  int k;

  thr_status st = walks_bound(frame, options, check_walked, pulled, 0, &k, &bound, err);
  if (!st) length[k] = fmax(length[k], bound);
  return st;
}

/* ---- too few cords ---- */

/* Returns the task of least turning that the tree of a claim is about. end_allowed: [n_nodes]
 * filled, and borrowed by the task. */
static thr_turning_task task_of(const thr_frame *frame, const thr_request *options, int cords,
                                const thr_pull_claim *claim, bool *end_allowed)
{
  const int least = thr_plan_cords_least(options);
  thr_turning_task task = thr_turning_task_of(frame, options, end_allowed);

  task.most_passes = claim->tree.n_nodes > 0 ? claim->most_passes : THR_PULL_PASSES;
  task.cords = cords;
  task.cords_least = least < cords ? least : cords;
  task.cost = THR_TURN_ANGLE;
  task.cut = claim->cut;
  return task;
}

/* Raises *side to what the tree proves of the turns on one side of some cord's cut turn, rad. As no
 * turn counts for more than task->cut, all turns of a cord count at most what its two sides do and
 * a cut turn, with closed cords also the turn at its ends. */
static thr_status bound_by_tree(const thr_turning_columns *columns, const thr_turning_proof *tree,
                                double *side, thr_err *err)
{
  const thr_turning_task *task = columns->task;
  double each = 0, all = 0;

  thr_status st = thr_check_shares(columns, task->cords, tree, &all, &each, err);

  /* The turns that neither end has to overcome. */
  const double passed_by_nobody =
      (task->end_allowed ? 1 : 2) * ldexp((double)task->cut, -THR_TURNING_BITS) * (1 + 1e-15);

  /* The mean over all cords bounds the largest one. */
  each = fmax(each, all / ((double)task->cords * columns->n_components));
  *side = fmax(*side, (each - passed_by_nobody) / 2);
  return st;
}

/* Raises *side to what single edges force: some cord passes each, and reaches it from an end. */
static thr_status bound_by_edges(const thr_frame *frame, const thr_turning_task *task, double *side,
                                 thr_err *err)
{
  thr_turning_task uncut = *task;
  thr_turning_columns columns;

  /* Full prices of turns. */
  uncut.cut = 0;

  thr_status st = thr_turning_columns_init(&columns, frame, &uncut, err);
  if (!st) st = thr_walk_forced(&columns, true, side, err);

  thr_turning_columns_destroy(&columns);
  return st;
}

/* Raises *side to the most that single edges and the tree, if there is one, prove. */
static thr_status find_side(const thr_frame *frame, const thr_turning_task *task,
                            const thr_turning_proof *tree, double *side, thr_err *err)
{
  thr_turning_columns columns = {0};
  thr_status st = bound_by_edges(frame, task, side, err);

  if (st || tree->n_nodes == 0) return st;

  st = thr_turning_columns_init(&columns, frame, task, err);
  if (!st) st = bound_by_tree(&columns, tree, side, err);

  thr_turning_columns_destroy(&columns);
  return st;
}

/* Returns the turning, rad, that is allowed on either side of a cut turn, with twice the rounding
 * that cords are allowed. */
static double most_turned(const thr_request *options)
{
  const double most = log(options->max_pull);
  return (most + 2 * rounding * (1 + most)) / options->physics.mu;
}

/* Sets *too_few if so many cords are too few for some component of few edges, with turns of at most
 * `allowed` rad on either side of a cut turn. */
static thr_status few_too_few(const thr_frame *frame, const thr_request *options, int cords,
                              double allowed, bool *too_few, thr_err *err)
{
  thr_scratch own = {0};
  const size_t n = (size_t)frame->n_nodes; /* no more components than that */
  int *component = thr_scratch_array(&own, n, sizeof *component),
      *enough = thr_scratch_array(&own, n, sizeof *enough);
  int *fewest = thr_scratch_array(&own, n, sizeof *fewest), components = 0, least, most;

  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_frame_components(frame, component, &components, err);

  /* The tables count up from the number that is asked about; one more is enough to exclude it. */
  for (int c = 0; c < components && !st; c++) {
    thr_few_edges_cords(frame, options, component, c, &least, &most);
    fewest[c] = options->ends == THR_ENDS_COUNTS ? most : cords;
    enough[c] = fewest[c] + 1;
  }

  if (!st) st = thr_few_edges_within(frame, options, allowed, enough, fewest, err);
  for (int c = 0; c < components && !st; c++)
    *too_few |= fewest[c] == enough[c];

  thr_scratch_free(&own);
  return st;
}

thr_status thr_check_too_few(const thr_frame *frame, const thr_request *options, int cords,
                             const thr_pull_claim *claim, bool *too_few, thr_err *err)
{
  double side = 0;
  *too_few = false;

  /* Without friction no pull is too large. */
  if (options->physics.mu <= 0) return THR_OK;

  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = task_of(frame, options, cords, claim, end_allowed);

  thr_status st = find_side(frame, &task, &claim->tree, &side, err);
  free(end_allowed);

  /* Bounds on the turning first, as the tables take longer. */
  *too_few = !st && side > most_turned(options);
  if (!st && !*too_few) st = few_too_few(frame, options, cords, most_turned(options), too_few, err);
  return st;
}

thr_status thr_check_pulled_least(const thr_frame *frame, const thr_request *options,
                                  const thr_turning_task *task, const thr_turning_claim *claim,
                                  double *side, thr_err *err)
{
  thr_turning_proof tree = claim->tree;
  thr_turning_task cut = *task;
  thr_turning_columns columns;
  double walks = 0;

  tree.walks = (thr_walk_proof){0};
  cut.cut = claim->cut;

  /* Single edges, and the tree, in which no turn counts for more than the cut. */
  thr_status st = bound_by_edges(frame, task, side, err);
  if (!st && claim->cut > 0) {
    st = thr_turning_columns_init(&columns, frame, &cut, err);
    if (!st) st = bound_by_tree(&columns, &tree, side, err);
    thr_turning_columns_destroy(&columns);
  }

  /* Prices of walks. */
  if (!st && claim->tree.walks.unit > 0) {
    if (task->tube)
      return thr_fail(err, THR_EVIOLATED, "walks: with tube joints none are within a pull");
    st = thr_turning_columns_init(&columns, frame, task, err);
    const int component = st ? 0 : thr_walk_component(&columns, &claim->tree.walks);
    if (!st)
      st = thr_walk_pull_least(&columns, &claim->tree.walks,
                               thr_check_cords_of(&columns, component, task->cords), &walks, err);
    *side = fmax(*side, walks);
    thr_turning_columns_destroy(&columns);
  }

  /* All sets of cords through few edges decide whether what is claimed is so. */
  bool too_few = false;
  const double stated = claim->largest_bound - 5e-10 * (1 + claim->largest_bound);
  if (!st && stated > *side)
    st = few_too_few(frame, options, options->cords, stated, &too_few, err);
  if (too_few) *side = stated;
  return st;
}

thr_status thr_check_fewest_pulled(const thr_frame *frame, const thr_request *options,
                                   const int *cords, int components, int excluded, int *fewest,
                                   thr_err *err)
{
  thr_scratch own = {0};
  const int least = thr_plan_cords_least(options);
  int *number = thr_scratch_array(&own, (size_t)components, sizeof *number), largest = least;

  thr_status st = thr_scratch_check(&own, err);

  /* Every component has the least number, unless tables show that it needs more. */
  for (int c = 0; c < components && !st; c++)
    number[c] = least;
  if (!st && options->physics.mu > 0)
    st = thr_few_edges_within(frame, options, most_turned(options), cords, number, err);

  *fewest = 0;
  for (int c = 0; c < components && !st; c++) {
    *fewest += number[c];
    largest = number[c] > largest ? number[c] : largest;
  }

  /* Some component has more cords than are excluded. */
  if (excluded >= largest) *fewest += excluded + 1 - largest;
  thr_scratch_free(&own);
  return st;
}

/* ---- the claim ---- */

/* Checks that `excluded` cords in every component are too few: by the tree, by single edges, and by
 * tables over all sets of few edges. */
static thr_status check_too_few(const thr_plan *plan, thr_err *err)
{
  const thr_pull_claim *claim = &plan->pull_claim;
  bool too_few;
  if (claim->tree.n_nodes > 0 && claim->most_passes < THR_PULL_PASSES)
    return thr_fail(
        err, THR_EVIOLATED,
        "proof.pull.most_passes: %d; a proof is about plans with up to %d passes over an edge",
        claim->most_passes, THR_PULL_PASSES);

  if (claim->tree.n_nodes > 0 && claim->cut <= 0)
    return thr_fail(err, THR_EVIOLATED, "proof.pull.cut: missing");

  thr_status st =
      thr_check_too_few(&plan->frame, &plan->options, claim->excluded, claim, &too_few, err);

  if (st || too_few) return st;
  return thr_fail(
      err, THR_EVIOLATED,
      "proof.pull: it is not proved that %d cords in every component are too few for the pull",
      claim->excluded);
}

/* Checks by prices of walks that `excluded` cords are too few. With bits 0 lengths count for
 * nothing, so a bound > 0 on the length of so many cords says that there are none. */
static thr_status check_walks(const thr_plan *plan, const thr_check_walked *check_walked,
                              thr_err *err)
{
  const thr_pull_claim *claim = &plan->pull_claim;
  double bound = 0;
  int k;

  if (claim->walks.bits != 0)
    return thr_fail(err, THR_EVIOLATED, "proof.pull.walks.bits: %d; 0 is expected",
                    claim->walks.bits);

  thr_status st = walks_bound(&plan->frame, &plan->options, check_walked, &claim->walks,
                              claim->excluded, &k, &bound, err);

  if (st || bound > 0) return st;
  return thr_fail(
      err, THR_EVIOLATED,
      "proof.pull: it is not proved that %d cords in every component are too few for the pull",
      claim->excluded);
}

/* Computes *fewest, what the claim proves without its parts. */
static thr_status check_fewest(const thr_plan *plan, const thr_check_walked *check_walked,
                               int *fewest, thr_err *err)
{
  const thr_pull_claim *claim = &plan->pull_claim;
  thr_status st = THR_OK;

  if (claim->walks.unit > 0)
    st = check_walks(plan, check_walked, err);
  else if (thr_pull_excludes(claim))
    st = check_too_few(plan, err);

  /* Given ends leave no choice of the number. */
  if (st || plan->options.ends == THR_ENDS_COUNTS) return st;
  return thr_check_fewest_pulled(&plan->frame, &plan->options, check_walked->cords,
                                 check_walked->n_components, claim->excluded, fewest, err);
}

/* Checks the claim about component k alone, with as many cords as it has. */
static thr_status check_part(const thr_components *components, int k, const thr_pull_claim *part,
                             int cords, thr_err *err)
{
  thr_check_walked walked = {0};
  thr_plan alone;
  thr_err why = {0};

  thr_status st = thr_component_take(components, k, &alone, err);
  if (st) return st;

  st = thr_check_walked_init(&walked, &alone.frame, &alone.options, err);
  if (!st) {
    walked.cords[0] = alone.n_cords = cords; /* whose number alone is read */
    alone.pull_claim = *part;
    st = thr_check_pull_claim(&alone, &walked, &why);
    if (st) thr_fail(err, st, "component %d: %s", k, why.text);

    /* The claim is borrowed. */
    alone.pull_claim = (thr_pull_claim){0};
    alone.n_cords = 0;
  }

  thr_check_walked_destroy(&walked);
  thr_plan_destroy(&alone);
  return st;
}

/* Computes *fewest, what is proved of all components, each alone. */
static thr_status check_parts(const thr_plan *plan, const thr_check_walked *check_walked,
                              int *fewest, thr_err *err)
{
  const thr_pull_claim *claim = &plan->pull_claim;
  thr_components components;
  thr_status st = thr_components_init(&components, &plan->frame, &plan->options, err);
  *fewest = 0;

  for (int k = 0; k < claim->n_parts && !st; k++) {
    st = check_part(&components, k, &claim->part[k], check_walked->cords[k], err);
    *fewest += claim->part[k].fewest;
  }

  thr_components_destroy(&components);
  return st;
}

thr_status thr_check_pull_claim(const thr_plan *plan, const thr_check_walked *check_walked,
                                thr_err *err)
{
  const thr_pull_claim *claim = &plan->pull_claim;
  int fewest = plan->n_cords;
  if (plan->options.max_pull <= 0)
    return thr_fail(err, THR_EVIOLATED, "proof.pull: the options set no limit on the pull");

  /* What is proved. */
  thr_status st = claim->n_parts > 0 ? check_parts(plan, check_walked, &fewest, err)
                                     : check_fewest(plan, check_walked, &fewest, err);
  if (st) return st;

  /* A plan may claim less than is proved, not more. */
  if (claim->fewest > fewest)
    return thr_fail(err, THR_EVIOLATED, "proof.pull.lower_bound: stated %d, but only %d is proved",
                    claim->fewest, fewest);

  if (claim->fewest > plan->n_cords)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.pull: any plan would have %d cords or more, but this one has %d",
                    claim->fewest, plan->n_cords);

  if (claim->optimal && claim->fewest != plan->n_cords)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.pull: says optimal, but there are %d cords and its bound is %d",
                    plan->n_cords, claim->fewest);
  return THR_OK;
}
