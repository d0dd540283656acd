/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks evaluations: the tensions of the cords, and what must follow from them and the physics.
 *
 * With the method capstan the checker computes the tensions anew: the slackest pass has the seating
 * tension, and every turn multiplies it by the law's factor, written here in another form than the
 * one that made the plan. With other methods it checks what any friction implies: tension rises
 * towards a pulled end. Forces, work, losses and seated gaps follow from the tensions. It shares no
 * code with eval/. */
#include "graph/check/check_parts.h"

#include <math.h>
#include <stdlib.h>

/* What is claimed about one cord. */
typedef struct {
  const thr_frame *frame;
  const thr_cord *cord;
  const thr_evaluation *evaluation;
  const thr_eval_cord *stated;
  const char *id;
  int from_end; /* the first pass that the end's pull reaches */
} cord_claim;

/* Compares a number that is stated of the cord with the one found. */
static thr_status evaluated(const cord_claim *claim, const char *name, double stated, double found,
                            thr_err *err)
{
  if (thr_check_close(stated, found, found)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: %s: stated %.12g, but expected %.12g",
                  claim->id, name, stated, found);
}

/* Checks the loss, and that no pass is slacker than the slackest one. */
static thr_status check_slackest(const cord_claim *claim, double force, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  const double least = stated->tension[stated->slackest], loss = force > 0 ? 1 - least / force : 0;

  /* The loss is the part of the force that does not reach the slackest pass. */
  if (!thr_check_close(stated->loss, loss, 1))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: loss: stated %.12g, but the tensions give %.12g",
                    claim->id, stated->loss, loss);

  for (int i = 0; i < stated->n_passes; i++)
    if (stated->tension[i] < least)
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: pass %d is slacker than pass %d, which is said to be slackest",
          claim->id, i + 1, stated->slackest + 1);

  return THR_OK;
}

/* Checks forces and work, which follow from the tensions at the ends. */
static thr_status check_forces(const cord_claim *claim, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  double at_start = stated->tension[0], at_end = stated->tension[stated->n_passes - 1];

  /* The force is that of the harder pulled end, the other force that of the other one. */
  double force = stated->pull == THR_PULL_START  ? at_start
                 : stated->pull == THR_PULL_END  ? at_end
                 : stated->pull == THR_PULL_NONE ? 0
                                                 : fmax(at_start, at_end);
  double other = stated->pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;

  thr_status st;
  if ((st = evaluated(claim, "force", stated->force, force, err))) return st;
  if ((st = evaluated(claim, "other_force", stated->other_force, other, err))) return st;
  if ((st = evaluated(claim, "work", stated->work, force + other, err))) return st;

  return check_slackest(claim, force, err);
}

/* Checks that a cord which slides towards a pulled end gets tighter on the way, or stays as it is.
 */
static thr_status check_rise(const cord_claim *claim, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  for (int i = 0; i + 1 < stated->n_passes; i++) {
    /* Passes behind the slackest one move towards the end, the others towards the start. */
    bool to_end = i >= stated->slackest;
    if (to_end ? stated->pull == THR_PULL_START : stated->pull == THR_PULL_END) continue;

    /* By how much the tension rises towards the pulled end. */
    double rise = to_end ? stated->tension[i + 1] - stated->tension[i]
                         : stated->tension[i] - stated->tension[i + 1];

    if (rise < 0)
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: the tension falls between pass %d and %d, towards a pulled end",
          claim->id, i + 1, i + 2);
  }
  return THR_OK;
}

/* Returns what bores that are not straight add to the exponent: mu x wobble x metres from the
 * middle of pass i to that of the next one. */
static double wobble_exponent(const thr_frame *frame, const thr_physics *physics,
                              const thr_cord *cord, int i)
{
  double mm = 0;
  if (physics->wobble == 0 || thr_units_in_mm(frame->units, &mm, NULL)) return 0;
  return physics->mu * physics->wobble * mm / 2000 *
         (frame->length[cord->half[i] >> 1] + frame->length[cord->half[i + 1] >> 1]);
}

/* Returns the exponent of the turn after pass i; the mitre law in another form than the one that
 * made the plan. */
double thr_check_exponent(const thr_frame *frame, const thr_evaluation *evaluation,
                          const thr_cord *cord, int i)
{
  if (i + 1 >= cord->n_passes) return 0;
  double mu = evaluation->physics.mu,
         angle = thr_check_angle(frame, cord->half[i], cord->half[i + 1]);
  return wobble_exponent(frame, &evaluation->physics, cord, i) +
         (evaluation->law == THR_LAW_CAPSTAN ? mu * angle : log(1 / (1 - mu * sin(angle / 2))));
}

/* Applies Howell's friction, from T'^m = T^m + m x exponent x T0^m, m = 1 - n. */
double thr_check_tension(const thr_physics *physics, double tension, double exponent)
{
  const double m = 1 - physics->mu_power, at = physics->mu_tension;

  /* Friction in proportion to the tension: the capstan law. */
  if (physics->mu_power == 0 || physics->mu_power == 1) return tension * exp(exponent);

  if (!(tension > 0)) return exponent > 0 ? at * pow(m * exponent, 1 / m) : 0;

  const double grown = m * exponent * pow(at / tension, m);
  return grown > -1 ? tension * exp(log1p(grown) / m) : 0;
}

static double law_exponent(const cord_claim *claim, int i)
{
  return thr_check_exponent(claim->frame, claim->evaluation, claim->cord, i);
}

int thr_check_from_end(const thr_request *request, thr_pull pull, int slackest, int n_passes)
{
  return pull == THR_PULL_BOTH && !request->old_pull && n_passes > 1 ? slackest + 1 : slackest;
}

bool thr_check_slackest(const thr_request *request, thr_pull pull, int slackest,
                        const double *before, int n_passes)
{
  const int from_end = thr_check_from_end(request, pull, slackest, n_passes),
            apart = from_end - slackest;
  const double total = before[n_passes - 1];
  double best = INFINITY;

  if (pull != THR_PULL_BOTH) return slackest == (pull == THR_PULL_START ? n_passes - 1 : 0);
  if (from_end >= n_passes) return false;

  /* The cord is cut where the harder end has least to overcome. */
  for (int i = 0; i + apart < n_passes; i++)
    best = fmin(best, fmax(before[i], total - before[i + apart]));

  return fmax(before[slackest], total - before[from_end]) <= best + 1e-9 * (1 + total);
}

/* Checks every tension against the law, in logarithms. before[n_passes]: the exponents before every
 * pass. */
static thr_status check_tensions(const cord_claim *claim, const thr_request *request,
                                 const double *before, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  const int n_passes = stated->n_passes, slackest = stated->slackest;

  if (!thr_check_slackest(request, stated->pull, slackest, before, n_passes))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: pass %d is not where its tension is least", claim->id,
                    slackest + 1);

  /* Exponents add up from the slackest pass to either end. */
  for (int i = 0; i < n_passes; i++) {
    const double apart =
        i <= slackest ? before[slackest] - before[i] : before[i] - before[claim->from_end];

    const double expected = log(
        thr_check_tension(&claim->evaluation->physics, claim->evaluation->physics.seating, apart));

    if (!thr_check_close(log(stated->tension[i]), expected, 1 + before[n_passes - 1]))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: pass %d: stated %.12g N, but the %s law gives %.12g N", claim->id,
          i + 1, stated->tension[i], thr_law_name(claim->evaluation->law), exp(expected));
  }
  return THR_OK;
}

/* Checks the tensions of the method capstan: the slackest pass holds the seating tension, and every
 * other one what the law gives. */
static thr_status check_law(const cord_claim *claim, const thr_request *request, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  thr_status st =
      evaluated(claim, "tension of the slackest pass", stated->tension[stated->slackest],
                claim->evaluation->physics.seating, err);
  double *before = st ? NULL : thr_calloc((size_t)stated->n_passes, sizeof *before);
  if (st || !before) return st ? st : thr_nomem(err);

  /* Exponents add up along the cord. */
  for (int i = 0; i + 1 < stated->n_passes; i++)
    before[i + 1] = before[i] + law_exponent(claim, i);
  st = check_tensions(claim, request, before, err);

  free(before);
  return st;
}

/* Checks that a cord which is not pulled is slack all along. */
static thr_status check_slack(const cord_claim *claim, thr_err *err)
{
  for (int i = 0; i < claim->stated->n_passes; i++)
    if (claim->stated->tension[i] != 0)
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation of cord %s: pass %d has tension, but the cord is not pulled",
                      claim->id, i + 1);
  return THR_OK;
}

/* Checks a cord after a schedule: its exponents are those of the law, and its tensions what the
 * steps leave, which the checker computes itself (check_schedule.c). */
static thr_status check_scheduled(const cord_claim *claim, int i, thr_err *err)
{
  const thr_eval_cord *stated = claim->stated;
  const double hardest = thr_schedule_hardest(&claim->evaluation->schedule, i);
  const bool slack = thr_schedule_slack(&claim->evaluation->schedule, i);

  if (slack && (stated->pull != THR_PULL_NONE || stated->most))
    return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: the schedule leaves it slack",
                    claim->id);

  if (!slack && stated->pull != THR_PULL_BOTH)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: pull: after a schedule it says both", claim->id);

  /* Forces are those of the hardest pull of all steps. */
  thr_status st = evaluated(claim, "force", stated->force, hardest, err);
  if (!st) st = evaluated(claim, "other_force", stated->other_force, 0, err);
  if (!st) st = evaluated(claim, "work", stated->work, hardest, err);
  if (!st) st = check_slackest(claim, hardest, err);

  /* Turns that were tightened have exponents of their own. */
  for (int j = 0; j + 1 < stated->n_passes && !st && claim->evaluation->method != THR_JOINT &&
                  !claim->evaluation->standing.taut;
       j++)
    if (!thr_check_close(stated->exponent[j], law_exponent(claim, j), 1))
      st =
          thr_fail(err, THR_EVIOLATED,
                   "evaluation of cord %s: exponents[%d]: stated %.12g, but the %s law gives %.12g",
                   claim->id, j, stated->exponent[j], thr_law_name(claim->evaluation->law),
                   law_exponent(claim, j));

  if (st || slack) return st ? st : check_slack(claim, err);
  return thr_check_schedule(claim->frame, claim->cord, &claim->evaluation->schedule, i,
                            &claim->evaluation->physics, stated, err);
}

/* Checks what is stated of cord i. */
static thr_status check_cord_evaluation(const thr_plan *plan, int i, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_cord *cord = &plan->cord[i];
  const thr_eval_cord *stated = &evaluation->cord[i];
  const int from_end =
      thr_check_from_end(&plan->options, stated->pull, stated->slackest, cord->n_passes);
  const cord_claim claim = {&plan->frame, cord, evaluation, stated, cord->id, from_end};
  const bool tight = evaluation->method == THR_JOINT || evaluation->standing.taut;

  /* The turning, by the checker's own formula. */
  double turning = 0;
  for (int j = 0; j + 1 < cord->n_passes; j++)
    turning += thr_check_angle(&plan->frame, cord->half[j], cord->half[j + 1]);
  if (!thr_check_close(stated->turning, turning, 1 + turning))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: turning: stated %.12g, but the cord turns by %.12g",
                    claim.id, stated->turning, turning);

  if (!(stated->taut_turning >= 0) || (!tight && stated->taut_turning != stated->turning))
    return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: taut_turning: %.12g; expected %s",
                    claim.id, stated->taut_turning,
                    tight ? "0 or more" : "the turning, for this method");

  if (!(stated->error >= 0) ||
      (evaluation->method == THR_CAPSTAN && (stated->error > 0 || stated->refused > 0)))
    return thr_fail(
        err, THR_EVIOLATED,
        "evaluation of cord %s: error and refused: no such error is possible with this method",
        claim.id);

  /* The tensions. */
  if (evaluation->schedule.n > 0) return check_scheduled(&claim, i, err);
  thr_status st = check_forces(&claim, err);
  if (stated->pull == THR_PULL_NONE) return st ? st : check_slack(&claim, err);
  if (!st) st = check_rise(&claim, err);

  /* Both pulls meet behind the slackest pass, at one tension. */
  if (!st && evaluation->method != THR_CAPSTAN && from_end < cord->n_passes)
    st = evaluated(&claim, "tension behind the slackest pass", stated->tension[from_end],
                   stated->tension[stated->slackest], err);
  if (!st && evaluation->method == THR_CAPSTAN) st = check_law(&claim, &plan->options, err);

  return st;
}

/* Checks that all constants are filled in and fit the framework. */
static thr_status check_physics(const thr_plan *plan, thr_err *err)
{
  thr_physics again;
  thr_err found = {0};
  const thr_physics *stated = &plan->evaluation.physics;

  thr_status st = thr_physics_resolve(stated, &plan->frame, &again, &found);
  if (st == THR_ENOMEM) return thr_nomem(err);
  if (st) return thr_fail(err, THR_EVIOLATED, "evaluation.physics: %s", found.text);

  /* Resolving again may not change what is stated. */
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(stated, &thr_physics_fields[i]) !=
        thr_physics_get(&again, &thr_physics_fields[i]))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.physics.%s: an evaluation states what it used, so not 0",
                      thr_physics_fields[i].key);

  /* Friction by a power of the tension is known to one law only. */
  if (stated->mu_power > 0 && stated->mu_power < 1 &&
      (plan->evaluation.method != THR_CAPSTAN || plan->evaluation.law != THR_LAW_CAPSTAN))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.physics.mu_power: only the capstan law of method capstan has it");
  return THR_OK;
}

/* Checks the part of the gaps which cords pass that presses with the seating tension or more. Gaps
 * at the threshold, which rounding may count either way, may be counted either way. */
static thr_status check_seated(const thr_plan *plan, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const int n_edges = plan->frame.n_edges;
  double *press = thr_calloc((size_t)n_edges + 1, sizeof *press);
  if (!press) return thr_nomem(err);
  for (int e = 0; e < n_edges; e++)
    press[e] = -1; /* no cord goes through */

  /* Press every gap with the tensions of its passes. */
  bool known = true;
  for (int i = 0; i < evaluation->n_cords; i++) {
    known &= evaluation->cord[i].known;
    for (int k = 0; k < plan->cord[i].n_passes; k++) {
      double *at = &press[plan->cord[i].half[k] >> 1];
      *at = fmax(*at, 0) + (evaluation->cord[i].known ? evaluation->cord[i].tension[k] : 0);
    }
  }

  /* Count gaps surely and perhaps at the threshold. */
  int gaps = 0, surely = 0, perhaps = 0;
  for (int e = 0; e < n_edges; e++) {
    gaps += press[e] >= 0;
    surely += press[e] > evaluation->physics.seating * (1 + 1e-8);
    perhaps += press[e] >= evaluation->physics.seating * (1 - 1e-8);
  }
  free(press);

  const double least = gaps > 0 ? (double)surely / gaps : 0,
               most = gaps > 0 ? (double)perhaps / gaps : 0;
  if (known && evaluation->seated >= least - 1e-9 && evaluation->seated <= most + 1e-9)
    return THR_OK;

  if (!known)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.seated: stated, but not every cord's tensions are known");
  return thr_fail(err, THR_EVIOLATED,
                  "evaluation.seated: stated %.12g, but the tensions seat %.12g of the gaps",
                  evaluation->seated, most);
}

thr_status thr_check_evaluation(const thr_plan *plan, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  double largest = 0, total = 0;
  thr_status st = check_physics(plan, err);
  if (st) return st;

  if (!(evaluation->time_step > 0) || !(evaluation->iterations > 0))
    return thr_fail(err, THR_EVIOLATED, "evaluation: time_step and iterations must be positive");

  /* Cord by cord; sums are over the cords that are known. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (!evaluation->cord[i].known) continue;
    if ((st = check_cord_evaluation(plan, i, err))) return st;
    largest = fmax(largest, evaluation->cord[i].force);
    total += evaluation->cord[i].work;
  }

  if (!thr_check_close(evaluation->largest, largest, largest))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.largest: stated %.12g, but the cords give %.12g",
                    evaluation->largest, largest);
  if (!thr_check_close(evaluation->total, total, total))
    return thr_fail(err, THR_EVIOLATED, "evaluation.total: stated %.12g, but the cords give %.12g",
                    evaluation->total, total);

  if (evaluation->seated_known && (st = check_seated(plan, err))) return st;
  return evaluation->standing.present ? thr_check_standing(plan, err) : THR_OK;
}
