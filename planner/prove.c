/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Judges the cords of one plan by the proofs of another, tells what is not proved of a plan, and
 * reads a written plan back (thr_plan_confirm), dropping claims that the checker does not confirm.
 *
 * A proof of length or turning is about all cords of a request, so a certificate that was found
 * with other cords still bounds these from below; what it proves of them is always stated by the
 * checker. */
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "tortuosity/tie/tie.h"

#include <math.h>

/* Prices of walks may need another proof of length than there is now: then they go. */
static thr_status judge_cords(thr_plan *plan, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;

  thr_err why = {0};
  thr_status st =
      thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords, proof->certificate,
                      proof->n_certificates, &proof->walks, &plan->cords_claim, &why);

  if (st != THR_EVIOLATED || !(proof->walks.unit || proof->walks.sets))
    return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
  thr_walk_proof_destroy(&proof->walks);
  return thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                         proof->certificate, proof->n_certificates, NULL, &plan->cords_claim, err);
}

thr_status thr_planner_prove_length(thr_plan *plan, thr_plan *source, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  thr_length_proof *from = &source->proof;

  /* The proof of tied cords is a tree, which moves over. */
  if (options->joint == THR_JOINT_TUBE) {
    thr_tube tube = {.proof = from->tied};
    from->tied = (thr_turning_proof){0};
    thr_status st = thr_tied_least(frame, options, &tube.proof, &tube.bound, err);
    if (!st) thr_tube_prove(&tube, plan->metrics.length, &plan->proof);
    thr_tube_destroy(&tube);
    return st ? st
              : thr_check_tied_cords(frame, options, plan->cord, plan->n_cords, &plan->proof.tied,
                                     &plan->cords_claim, err);
  }

  /* The certificates of solid joints move over, and the checker states what they prove. */
  thr_shortest shortest = {.n_certificates = from->n_certificates,
                           .certificate = from->certificate};
  shortest.confirmed.confirmed = from->confirmed;
  shortest.confirmed.skipped = from->unconfirmed;
  from->certificate = NULL;
  from->n_certificates = 0;

  thr_status st =
      thr_postman_prove(frame, options, plan->cord, plan->n_cords, &shortest, &plan->proof, err);
  thr_shortest_destroy(&shortest);

  /* Proofs by walks come along, and are judged with the cords. */
  plan->proof.walks = from->walks;
  from->walks = (thr_walk_proof){0};
  return st ? st : judge_cords(plan, err);
}

double thr_planner_length_limit(const thr_plan *plan, double limit)
{
  if (limit < 0 || !plan->proof.present) return limit;
  return fmax(limit, (1 + plan->options.turning.length_slack) * plan->proof.lower_bound);
}

thr_status thr_planner_prove_turning(thr_plan *plan, thr_turning_claim *claim, thr_err *err)
{
  thr_err why = {0};
  if (!claim->present) return THR_OK;

  /* The limit on the length may be looser now, as the proof of length is another. */
  claim->length_limit = thr_planner_length_limit(plan, claim->length_limit);
  thr_turning_claim found;
  thr_status st = thr_check_turning(&plan->frame, &plan->options, plan->cord, plan->n_cords, claim,
                                    &found, &why);

  if (st == THR_EVIOLATED) return THR_OK;
  if (st) return thr_fail(err, st, "%s", why.text);

  plan->turning = found;
  plan->turning.tree = claim->tree;
  claim->tree = (thr_turning_proof){0};
  return THR_OK;
}

thr_status thr_planner_prove_again(thr_plan *plan, thr_err *err)
{
  /* Set the old proofs aside, and measure the cords. */
  thr_plan before = {.proof = plan->proof, .turning = plan->turning};
  plan->proof = (thr_length_proof){0};
  plan->turning = (thr_turning_claim){0};
  thr_status st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                   &plan->metrics, err);

  /* Judge the length, with the walks for cords within a pull apart. */
  if (!st && before.proof.present) {
    const thr_walk_proof pulled = before.proof.pulled;
    before.proof.pulled = (thr_walk_proof){0};
    st = thr_planner_prove_length(plan, &before, err);
    plan->proof.pulled = pulled;
    if (!st && pulled.unit) st = thr_planner_judge_length(plan, err);
    plan->proof.slack_open =
        !thr_plan_within_slack(&plan->options, plan->metrics.length, plan->proof.lower_bound);
  }

  /* Judge the turning. */
  if (!st) st = thr_planner_prove_turning(plan, &before.turning, err);

  thr_plan_destroy(&before);
  return st;
}

thr_status thr_planner_verdict(const thr_plan *plan, thr_err *err)
{
  const thr_turning_claim *claim = &plan->turning;
  const thr_length_proof *length = &plan->proof;
  bool largest = thr_wants_largest(&plan->options);

  if (thr_wants_balance(&plan->options) && !plan->cords_claim.longest_optimal)
    return thr_not_proved(err, "the length of the longest cord", plan->cords_claim.longest,
                          plan->cords_claim.longest_bound);

  if (thr_wants_length(&plan->options) && length->optimal) return THR_OK;
  if (thr_wants_length(&plan->options))
    return thr_not_proved(err, "the length", plan->metrics.length, length->lower_bound);

  if (!claim->present) return thr_fail(err, THR_ELIMIT, "nothing is proved of the turning");
  if (largest ? claim->largest_optimal : claim->optimal) return THR_OK;
  return largest ? thr_not_proved(err, thr_largest_name(&plan->options), claim->largest,
                                  claim->largest_bound)
                 : thr_not_proved(err, "the turning", claim->price, claim->lower_bound);
}

/* ---- what is enough ---- */

/* Are there no cords that break what was asked of every plan? */
static bool keeps_to_limits(const thr_plan *plan)
{
  const thr_request *request = &plan->options;

  const double longest = thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);
  return !(plan->proof.present && plan->proof.slack_open && request->turning.length_slack >= 0) &&
         (request->distinct == 0 || plan->metrics.distinct == plan->frame.n_edges) &&
         (request->max_length == 0 || longest <= request->max_length * (1 + 1e-9)) &&
         (request->max_pull == 0 ||
          thr_cords_within_pull(&plan->frame, request, plan->cord, plan->n_cords)) &&
         (request->crossings != THR_CROSSINGS_FORBID || plan->metrics.crossings == 0);
}

/* With a limit on the pull or the length few cords are asked for first. */
static bool has_few_cords(const thr_plan *plan, double gap)
{
  const thr_request *request = &plan->options;
  const thr_pull_claim *pull = &plan->pull_claim;
  const bool few = request->cords_least < request->cords;

  const int least = pull->present ? pull->fewest : plan->cords_claim.fewest;
  if (!few || (request->max_pull == 0 && request->max_length == 0)) return true;

  return (pull->present && pull->optimal) ||
         (plan->cords_claim.present && plan->cords_claim.fewest_optimal) ||
         plan->n_cords <= least * (1 + gap);
}

bool thr_planner_is_enough(const thr_plan *plan, const thr_limits *limits)
{
  const thr_request *request = &plan->options;
  const double gap = thr_request_gap(request) + 1e-12;

  if (plan->n_cords == 0 || !keeps_to_limits(plan)) return false;

  /* Where nobody asked for a gap, any bound is enough, unless short cords are what is wanted. */
  const bool is_proved = thr_wants_symmetry(request) || thr_plan_gap(plan) < INFINITY;
  if (request->gap < 0 && limits->usual && is_proved &&
      (!thr_wants_length(request) || request->max_pull > 0))
    return true;

  return thr_plan_gap(plan) <= gap && has_few_cords(plan, gap);
}

/* ---- as it was written ---- */

const char *thr_claim_name(int claim)
{
  switch (claim) {
  case THR_CLAIM_TURNING: return "its turning";
  case THR_CLAIM_PULL: return "the number of cords within the pull";
  case THR_CLAIM_CORDS: return "its longest cord";
  default: return "its length";
  }
}

static int count_claims(int claims)
{
  int n = 0;
  for (; claims; claims &= claims - 1)
    n++;
  return n;
}

/* Reads the plan without some claims, and checks it. plan is empty on failure. */
static thr_status confirm_without(thr_plan *plan, const thr_text *text, const char *name,
                                  int claims, thr_err *err)
{
  thr_status st = thr_plan_parse_without(plan, text->data, text->length, name, claims, err);
  if (!st && (st = thr_check_plan(plan, err))) thr_plan_destroy(plan);
  return st;
}

thr_status thr_plan_confirm(thr_plan *plan, thr_text *text, const char *name, int *dropped,
                            thr_err *err)
{
  const int confirmed = plan->proof.confirmed,
            unconfirmed = plan->proof.unconfirmed; /* are not written */
  thr_err why = {0};
  *dropped = 0;

  thr_status st = thr_plan_parse_back(plan, text->data, text->length, name, &why);
  if (!st && (st = thr_check_plan(plan, &why))) thr_plan_destroy(plan);

  /* First each claim alone is left out, then two of them, .. */
  for (int n = 1; n <= count_claims(THR_CLAIMS_ALL) && st && st != THR_ENOMEM; n++)
    for (int claims = 1; claims <= THR_CLAIMS_ALL && st && st != THR_ENOMEM; claims++) {
      if (count_claims(claims) != n) continue;
      thr_err again = {0};
      st = confirm_without(plan, text, name, claims, &again);
      if (st == THR_ENOMEM) why = again;
      *dropped = claims;
    }
  if (st) return thr_fail(err, st == THR_ENOMEM ? st : THR_ESOLVER, "%s", why.text);

  /* Numbers that are not written down are set again, and the text is written without the dropped
   * claims. */
  plan->proof.confirmed = confirmed;
  plan->proof.unconfirmed = unconfirmed;

  if (*dropped == 0) return THR_OK;
  *err = why;
  thr_text_destroy(text);
  thr_plan_write(plan, text);
  return text->failed ? thr_nomem(err) : THR_OK;
}
