/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks a whole plan: recomputes its metrics from the cords and calls the checkers of its proofs.
 *
 * Nothing here trusts what a plan says about itself. With the code that makes plans the checker
 * shares the framework, the readers, and the one line that defines the weights
 * (thr_certificate_weight). Angles are computed by Kahan's formula, 2 atan2(|a - b|, |a + b|) of
 * unit vectors, which no planner uses. */
#include "graph/check/check_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool thr_check_close(double a, double b, double whole)
{
  return fabs(a - b) <= 1e-9 * whole;
}

/* Computes the direction of a half-edge as a unit vector. */
static void unit_direction(const thr_frame *frame, int half, double unit[3])
{
  thr_direction(frame, half, unit);
  thr_normalize(unit);
}

/* Returns the angle between two unit vectors by Kahan's formula. */
static double angle_of_units(const double a[3], const double b[3])
{
  double sum = 0, difference = 0;
  for (int i = 0; i < 3; i++) {
    sum += (a[i] + b[i]) * (a[i] + b[i]);
    difference += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return 2 * atan2(sqrt(difference), sqrt(sum));
}

double thr_check_angle(const thr_frame *frame, int in, int out)
{
  double unit[2][3];
  unit_direction(frame, in, unit[0]);
  unit_direction(frame, out, unit[1]);
  return angle_of_units(unit[0], unit[1]);
}

/* Compares a metric that is stated with the one that the cords give; whole: what rounding is
 * relative to. */
static thr_status metric(const char *name, double stated, double found, double whole, thr_err *err)
{
  if (thr_check_close(stated, found, whole)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "metrics.%s: stated %.12g, but the cords give %.12g", name,
                  stated, found);
}

/* Returns the metrics that the cords alone give; passes[n_edges] as they were counted. */
static thr_metrics recompute(const thr_plan *plan, const int *passes)
{
  const thr_frame *frame = &plan->frame;
  thr_metrics metrics = {0};

  /* Lengths and passes. */
  for (int e = 0; e < frame->n_edges; e++) {
    int cover = thr_plan_cover(frame, &plan->options, e);
    metrics.base_length += frame->length[e] * cover;
    metrics.overlap += frame->length[e] * (passes[e] - cover);
    metrics.length += frame->length[e] * passes[e];
    metrics.passes += passes[e];
    if (passes[e] > metrics.most_passes) metrics.most_passes = passes[e];
  }

  /* Turning, cord by cord. A closed cord also turns from its last pass into its first one. */
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    const int first = plan->options.ends == THR_ENDS_CLOSED ? 0 : 1;
    double turning = 0, unit[2][3]; /* of pass k at k % 2 */
    unit_direction(frame, cord->half[first ? 0 : cord->n_passes - 1], unit[1 - first]);

    /* A turn is compared by the unit directions of two passes, of which the last is kept. */
    for (int k = first; k < cord->n_passes; k++) {
      int in = cord->half[k ? k - 1 : cord->n_passes - 1], out = cord->half[k];
      unit_direction(frame, out, unit[k % 2]);
      double angle = angle_of_units(unit[1 - k % 2], unit[k % 2]);
      turning += angle;
      metrics.worst_turn = fmax(metrics.worst_turn, angle);
      metrics.u_turns += in >> 1 == out >> 1;
    }

    metrics.turning += turning;
    metrics.max_turning = fmax(metrics.max_turning, turning);
  }

  return metrics;
}

/* Checks the number of crossings that is stated, and that there are none where they are forbidden.
 */
static thr_status check_crossings(const thr_plan *plan, thr_err *err)
{
  thr_channels channels;
  if (plan->options.crossings == THR_CROSSINGS_ALLOW) return THR_OK;

  /* Channels through the pieces tell which cords cross. */
  thr_status st = thr_channels_make(&channels, plan, err);
  if (st) return st;

  double found = (double)channels.crossings;
  thr_channels_destroy(&channels);

  if (plan->options.crossings == THR_CROSSINGS_FORBID && found > 0)
    return thr_fail(err, THR_EVIOLATED,
                    "options.crossings: forbidden, but the cords cross %.0f times inside pieces",
                    found);
  return metric("crossings", plan->metrics.crossings, found, 0, err);
}

/* Compares all stated metrics with those of the cords. */
static thr_status check_metrics(const thr_plan *plan, const int *passes, thr_err *err)
{
  thr_metrics metrics = recompute(plan, passes);
  const thr_metrics *stated = &plan->metrics;
  thr_status st;

  /* Length and passes. */
  if ((st = metric("length", stated->length, metrics.length, metrics.length, err))) return st;
  if ((st = metric("base_length", stated->base_length, metrics.base_length, metrics.length, err)))
    return st;
  if ((st = metric("overlap", stated->overlap, metrics.overlap, metrics.length, err))) return st;
  if ((st = metric("passes", stated->passes, metrics.passes, 0, err))) return st;
  if ((st = metric("most_passes", stated->most_passes, metrics.most_passes, 0, err))) return st;

  /* Turning. */
  if ((st = metric("turning", stated->turning, metrics.turning, 1 + metrics.turning, err)))
    return st;
  if ((st = metric("max_turning", stated->max_turning, metrics.max_turning, 1 + metrics.turning,
                   err)))
    return st;
  if ((st = metric("worst_turn", stated->worst_turn, metrics.worst_turn, 1 + metrics.turning, err)))
    return st;
  if ((st = metric("u_turns", stated->u_turns, metrics.u_turns, 0, err))) return st;

  return check_crossings(plan, err);
}

/* Checks the claim about the length. *proved: no cords with these options are shorter. */
static thr_status check_length_claim(const thr_plan *plan, const thr_check_walked *check_walked,
                                     const thr_check_verdict *verdict, double *proved, thr_err *err)
{
  bool optimal;
  double lower_bound, length = thr_check_length_of(&plan->frame, check_walked->passes);
  const thr_length_proof *claim = &plan->proof;

  /* With tube joints a tree proves the length, otherwise one certificate for each component. */
  if (plan->options.joint == THR_JOINT_TUBE) {
    thr_status st = thr_tied_least(&plan->frame, &plan->options, &claim->tied, &lower_bound, err);
    if (st) return st;

    if (lower_bound > length && !thr_check_close(lower_bound, length, length))
      return thr_fail(err, THR_EVIOLATED,
                      "proof.length: the tree proves %.12g, which is more than the length %.12g",
                      lower_bound, length);
    optimal = thr_check_close(lower_bound, length, length);
  } else {
    int each = 1;
    thr_status st =
        thr_check_different(&plan->frame, &plan->options, plan->cord, plan->n_cords, &each, err);
    if (!st)
      st = thr_check_sum_verdicts(&plan->frame, &plan->options, check_walked, each, verdict,
                                  &claim->pulled, length, &optimal, &lower_bound, err);
    if (st) return st;
  }

  *proved = lower_bound;
  if (!claim->slack_open && !thr_plan_within_slack(&plan->options, length, lower_bound))
    return thr_fail(err, THR_EVIOLATED,
                    "options.turning.length_slack: at most %.12g above the least length, but the "
                    "cords are %.12g long and only "
                    "%.12g is proved",
                    plan->options.turning.length_slack, length, lower_bound);

  /* A plan may claim less than is proved, not more. */
  if (claim->optimal && !optimal)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.length: says optimal, but the certificate only proves %.12g of %.12g",
                    lower_bound, plan->metrics.length);
  if (claim->optimal &&
      !thr_check_close(claim->lower_bound, plan->metrics.length, plan->metrics.length))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.length: says optimal, but its lower bound %.12g is not the length %.12g",
                    claim->lower_bound, plan->metrics.length);

  const double least =
      optimal ? fmax(lower_bound, length) : lower_bound; /* its own rounding is the length's */
  if (claim->lower_bound > least && !thr_check_close(claim->lower_bound, least, least))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.length.lower_bound: stated %.12g, but the certificate proves %.12g",
                    claim->lower_bound, lower_bound);

  if (!thr_check_close(claim->gap,
                       (plan->metrics.length - claim->lower_bound) / plan->metrics.length, 1))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.length.gap: stated %.12g, but length and lower bound give %.12g",
                    claim->gap, (plan->metrics.length - claim->lower_bound) / plan->metrics.length);
  return THR_OK;
}

/* Checks the claims about the longest cord and the fewest cords. */
static thr_status check_cords_claim(const thr_plan *plan, const thr_check_walked *check_walked,
                                    const thr_check_verdict *verdict, thr_err *err)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  thr_cords_claim found;
  const thr_turning_proof *tied =
      plan->options.joint == THR_JOINT_TUBE && plan->proof.present ? &plan->proof.tied : NULL;

  /* Find what the proofs give. */
  thr_status st =
      thr_check_several(&plan->frame, &plan->options, check_walked, plan->cord, plan->n_cords,
                        plan->proof.certificate, verdict, tied, &plan->proof.walks, &found, err);
  if (st) return st;

  /* The longest cord. */
  const double whole = found.longest;
  if (!thr_check_close(claim->longest, found.longest, whole))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.cords.longest.length: stated %.12g, but the longest cord is %.12g long",
                    claim->longest, found.longest);

  if (claim->longest_bound > found.longest_bound &&
      !thr_check_close(claim->longest_bound, found.longest_bound, found.longest_bound))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.cords.longest.lower_bound: stated %.12g, but only %.12g is proved",
                    claim->longest_bound, found.longest_bound);

  if (claim->longest_optimal &&
      !(found.longest_optimal && thr_check_close(claim->longest_bound, found.longest, whole)))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.cords.longest: says optimal, but only %.12g of %.12g is proved",
                    fmin(claim->longest_bound, found.longest_bound), found.longest);

  /* The number of cords. */
  if (claim->fewest > found.fewest)
    return thr_fail(err, THR_EVIOLATED,
                    "proof.cords.fewest.lower_bound: stated %d, but only %d is proved",
                    claim->fewest, found.fewest);
  if (claim->fewest_optimal && (claim->fewest != plan->n_cords || claim->fewest == 0))
    return thr_fail(err, THR_EVIOLATED,
                    "proof.cords.fewest: says optimal, but there are %d cords and its bound is %d",
                    plan->n_cords, claim->fewest);

  return THR_OK;
}

/* Checks the claims about length and cords. *proved: as for check_length_claim; left alone without
 * one. */
static thr_status check_claims(const thr_plan *plan, const thr_check_walked *check_walked,
                               double *proved, thr_err *err)
{
  thr_check_verdict *verdict = NULL;
  thr_status st = THR_OK;

  if (plan->proof.present &&
      (plan->options.joint == THR_JOINT_TUBE) != (plan->proof.tied.n_nodes > 0))
    return thr_fail(err, THR_EVIOLATED, "proof.length: has a %s, but the plan's joints are %s",
                    plan->proof.tied.n_nodes > 0 ? "proof" : "certificate",
                    thr_joint_name(plan->options.joint));

  /* Certificates are verified once for both claims. */
  if (plan->proof.present && plan->options.joint == THR_JOINT_SOLID)
    st = thr_check_judge(&plan->frame, &plan->options, check_walked, plan->proof.certificate,
                         plan->proof.n_certificates, &verdict, err);
  if (!st && plan->proof.present) st = check_length_claim(plan, check_walked, verdict, proved, err);
  if (!st && plan->cords_claim.present) st = check_cords_claim(plan, check_walked, verdict, err);

  free(verdict);
  return st;
}

/* Checks that cords are named by their number. */
static thr_status check_names(const thr_plan *plan, thr_err *err)
{
  for (int i = 0; i < plan->n_cords; i++) {
    char id[12];
    thr_cord_id(i, id);
    if (strcmp(plan->cord[i].id, id) != 0)
      return thr_fail(err, THR_EVIOLATED, "cord number %d is called %s; expected %s", i + 1,
                      plan->cord[i].id, id);
  }
  return THR_OK;
}

thr_status thr_check_own(thr_status st, const thr_err *found, thr_err *err)
{
  if (st == THR_EVIOLATED)
    return thr_fail(err, THR_ESOLVER, "the plan does not pass its own check: %s", found->text);
  return st ? thr_fail(err, st, "%s", found->text) : THR_OK;
}

/* Checks how many edges are passed by enough different cords. Unless all are, nothing may be
 * optimal. */
static thr_status check_distinct(const thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  int found = 0;
  thr_status st = thr_check_count_different(frame, plan->options.distinct, plan->cord,
                                            plan->n_cords, &found, err);
  if (!st) st = metric("distinct", plan->metrics.distinct, found, 0, err);

  /* Any claim of optimality counts. */
  bool optimal = plan->proof.optimal || plan->cords_claim.longest_optimal ||
                 plan->cords_claim.fewest_optimal || plan->pull_claim.optimal ||
                 plan->turning.optimal || plan->turning.largest_optimal;

  if (!st && optimal && found < frame->n_edges)
    st = thr_fail(err, THR_EVIOLATED,
                  "proof: says optimal, but only %d of %d edges are passed by %d different cords",
                  found, frame->n_edges, plan->options.distinct);
  return st;
}

/* Checks all that is proved of cords that were checked already. */
static thr_status check_proofs(const thr_plan *plan, const thr_check_walked *check_walked,
                               thr_err *err)
{
  double least_length = 0;
  thr_status st = check_claims(plan, check_walked, &least_length, err);
  if (!st && plan->pull_claim.present) st = thr_check_pull_claim(plan, check_walked, err);
  if (!st && plan->turning.present) st = thr_check_turning_claim(plan, least_length, err);
  return st;
}

/* Checks the proofs of cords of which several different ones pass every edge. They are about the
 * passes that bridges need for that, if the plan has them everywhere. */
static thr_status check_needed(const thr_plan *plan, const thr_check_walked *check_walked,
                               thr_err *err)
{
  thr_plan needed = *plan;
  int *needs = NULL;
  bool all = true;
  thr_status st = plan->options.distinct > 0
                      ? thr_distinct_needs(&plan->frame, &plan->options, &needs, err)
                      : THR_OK;

  /* Proofs count these passes as needed only if the plan makes them. */
  for (int e = 0; needs && e < plan->frame.n_edges; e++)
    all = all && check_walked->passes[e] >= needs[e];

  if (needs && all) needed.frame.cover = needs;
  if (!st) st = check_proofs(&needed, check_walked, err);

  free(needs);
  return st;
}

/* Takes the next cord of every component, after the numbers next[n_components], and the equal part
 * of the claims that is about these. */
static void take_round(const thr_plan *plan, int n_components, int *next, thr_plan *part)
{
  const int rounds = plan->options.distinct;
  part->n_cords = 0;
  part->metrics.length = 0;

  for (int c = 0; c < n_components; c++) {
    while (plan->cord[next[c]].component != c)
      next[c]++;
    part->metrics.length += thr_cord_length(&plan->frame, &plan->cord[next[c]]);
    part->cord[part->n_cords++] = plan->cord[next[c]++];
  }

  /* Sums are divided by the number of rounds. */
  part->proof.lower_bound = plan->proof.lower_bound / rounds;
  part->turning.price = plan->turning.price / rounds;
  part->turning.lower_bound = plan->turning.lower_bound / rounds;
  if (plan->turning.length_limit > 0)
    part->turning.length_limit = plan->turning.length_limit / rounds;
}

/* Checks a plan in which every cord passes every edge (thr_request_alike): the claims hold in equal
 * parts of one cord of every component by itself, whichever cord it is. */
static thr_status check_alike(const thr_plan *plan, const thr_request *one, int n_components,
                              thr_err *err)
{
  thr_plan part = *plan;
  int *next = thr_calloc((size_t)n_components, sizeof *next);
  part.options = *one;
  part.cord = thr_calloc((size_t)n_components, sizeof *part.cord); /* whose passes are plan's */

  /* Round i has cord number i of every component. */
  thr_status st = next && part.cord ? THR_OK : thr_nomem(err);
  for (int i = 0; i < plan->options.distinct && !st; i++) {
    thr_check_walked round;

    take_round(plan, n_components, next, &part);
    st = thr_check_walked_from(&round, &part.frame, one, part.cord, part.n_cords, err);
    if (st) break;
    st = check_proofs(&part, &round, err);
    thr_check_walked_destroy(&round);
  }

  free(next);
  free(part.cord);
  return st;
}

thr_status thr_check_plan(const thr_plan *plan, thr_err *err)
{
  thr_check_walked check_walked;
  thr_request one;
  thr_status st = check_names(plan, err);
  if (st) return st;

  /* The cords, their number, and the metrics. */
  if ((st = thr_check_walked_from(&check_walked, &plan->frame, &plan->options, plan->cord,
                                  plan->n_cords, err)))
    return st;
  if (plan->proof.present || plan->cords_claim.present || plan->options.distinct > 0 ||
      !thr_wants_length(&plan->options))
    st = thr_check_cord_count(&check_walked, &plan->options, err);
  if (!st) st = check_metrics(plan, check_walked.passes, err);

  if (!st && plan->options.distinct > 0) st = check_distinct(plan, err);
  if (!st && plan->symmetry.present) st = thr_check_symmetry(plan, err);

  /* The proofs. */
  bool whole = plan->metrics.distinct == plan->frame.n_edges;
  if (!st && whole && thr_request_alike(&plan->frame, &plan->options, &one))
    st = check_alike(plan, &one, check_walked.n_components, err);
  else if (!st)
    st = check_needed(plan, &check_walked, err);

  if (!st && plan->evaluation.present) st = thr_check_evaluation(plan, err);

  thr_check_walked_destroy(&check_walked);
  return st;
}
