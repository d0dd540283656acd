/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for evaluations: what must follow from tensions, cords and physics. Knows
 * nothing of eval/. */
#include "graph/check/check_parts.h"
#include "graph/framework/units.h"
#include "graph/plan/schedule.h"

#include <math.h>
#include <stdlib.h>

/* What is claimed about one cord. */
typedef struct {
  const thr_frame *f;
  const thr_cord *cord;
  const thr_evaluation *e;
  const thr_eval_cord *c;
  const char *id;
  int from_end; /* the first pass that the end's pull reaches */
} cord_claim;

static thr_status evaluated(const cord_claim *k, const char *name, double stated, double found,
                            thr_err *err)
{
  if (thr_check_close(stated, found, found)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: %s: stated %.12g, but expected %.12g",
                  k->id, name, stated, found);
}

/* The loss, and that no pass is slacker. */
static thr_status check_slackest(const cord_claim *k, double force, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  const double least = eval_cord->tension[eval_cord->slackest],
               loss = force > 0 ? 1 - least / force : 0;
  if (!thr_check_close(eval_cord->loss, loss, 1))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: loss: stated %.12g, but the tensions give %.12g", k->id,
                    eval_cord->loss, loss);
  for (int i = 0; i < eval_cord->n_passes; i++)
    if (eval_cord->tension[i] < least)
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: pass %d is slacker than pass %d, which is said to be slackest",
          k->id, i + 1, eval_cord->slackest + 1);
  return THR_OK;
}

/* The numbers that follow from the tensions. */
static thr_status check_forces(const cord_claim *k, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  double at_start = eval_cord->tension[0], at_end = eval_cord->tension[eval_cord->n_passes - 1];
  double force = eval_cord->pull == THR_PULL_START  ? at_start
                 : eval_cord->pull == THR_PULL_END  ? at_end
                 : eval_cord->pull == THR_PULL_NONE ? 0
                                                    : fmax(at_start, at_end);
  double other = eval_cord->pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;
  thr_status st;
  if ((st = evaluated(k, "force", eval_cord->force, force, err))) return st;
  if ((st = evaluated(k, "other_force", eval_cord->other_force, other, err))) return st;
  if ((st = evaluated(k, "work", eval_cord->work, force + other, err))) return st;
  return check_slackest(k, force, err);
}

/* A cord that slides towards a pulled end gets tighter on the way, or stays as it is. */
static thr_status check_rise(const cord_claim *k, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  for (int i = 0; i + 1 < eval_cord->n_passes; i++) {
    bool to_end = i >= eval_cord->slackest;
    if (to_end ? eval_cord->pull == THR_PULL_START : eval_cord->pull == THR_PULL_END) continue;
    double rise = to_end ? eval_cord->tension[i + 1] - eval_cord->tension[i]
                         : eval_cord->tension[i] - eval_cord->tension[i + 1];
    if (rise < 0)
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: the tension falls between pass %d and %d, towards a pulled end",
          k->id, i + 1, i + 2);
  }
  return THR_OK;
}

/* What bores that are not straight add: mu x wobble x metres from the middle of pass i to that of
 * the next. */
static double wobble_exponent(const thr_frame *frame, const thr_physics *physics,
                              const thr_cord *cord, int i)
{
  double mm = 0;
  if (physics->wobble == 0 || thr_units_in_mm(frame->units, &mm, NULL)) return 0;
  return physics->mu * physics->wobble * mm / 2000 *
         (frame->length[cord->half[i] >> 1] + frame->length[cord->half[i + 1] >> 1]);
}

/* The mitre law in another form than the one that made the plan. */
double thr_check_exponent(const thr_frame *frame, const thr_evaluation *evaluation,
                          const thr_cord *cord, int i)
{
  if (i + 1 >= cord->n_passes) return 0;
  double mu = evaluation->physics.mu,
         angle = thr_check_angle(frame, cord->half[i], cord->half[i + 1]);
  return wobble_exponent(frame, &evaluation->physics, cord, i) +
         (evaluation->law == THR_LAW_CAPSTAN ? mu * angle : log(1 / (1 - mu * sin(angle / 2))));
}

/* Howell's friction, from T'^m = T^m + m x exponent x T0^m, m = 1 - n. */
double thr_check_tension(const thr_physics *physics, double tension, double exponent)
{
  const double m = 1 - physics->mu_power, at = physics->mu_tension;
  if (physics->mu_power == 0 || physics->mu_power == 1) return tension * exp(exponent);
  if (!(tension > 0)) return exponent > 0 ? at * pow(m * exponent, 1 / m) : 0;
  const double grown = m * exponent * pow(at / tension, m);
  return grown > -1 ? tension * exp(log1p(grown) / m) : 0;
}

static double law_exponent(const cord_claim *k, int i)
{
  return thr_check_exponent(k->f, k->e, k->cord, i);
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
  for (int i = 0; i + apart < n_passes; i++)
    best = fmin(best, fmax(before[i], total - before[i + apart]));
  return fmax(before[slackest], total - before[from_end]) <= best + 1e-9 * (1 + total);
}

/* before[n_passes]: the exponents before every pass. */
static thr_status check_tensions(const cord_claim *k, const thr_request *request,
                                 const double *before, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  const int n_passes = eval_cord->n_passes, slackest = eval_cord->slackest;
  if (!thr_check_slackest(request, eval_cord->pull, slackest, before, n_passes))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: pass %d is not where its tension is least", k->id,
                    slackest + 1);
  for (int i = 0; i < n_passes; i++) {
    const double apart =
        i <= slackest ? before[slackest] - before[i] : before[i] - before[k->from_end];
    const double expected = log(thr_check_tension(&k->e->physics, k->e->physics.seating, apart));
    if (!thr_check_close(log(eval_cord->tension[i]), expected, 1 + before[n_passes - 1]))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: pass %d: stated %.12g N, but the %s law gives %.12g N", k->id,
          i + 1, eval_cord->tension[i], thr_law_name(k->e->law), exp(expected));
  }
  return THR_OK;
}

/* Method capstan: the slackest pass holds the seating tension, and every other has what the law
 * gives. */
static thr_status check_law(const cord_claim *k, const thr_request *request, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  thr_status st = evaluated(k, "tension of the slackest pass",
                            eval_cord->tension[eval_cord->slackest], k->e->physics.seating, err);
  double *before = st ? NULL : thr_calloc((size_t)eval_cord->n_passes, sizeof *before);
  if (st || !before) return st ? st : thr_nomem(err);
  for (int i = 0; i + 1 < eval_cord->n_passes; i++)
    before[i + 1] = before[i] + law_exponent(k, i);
  st = check_tensions(k, request, before, err);
  free(before);
  return st;
}

/* A cord that is not pulled is slack all along. */
static thr_status check_slack(const cord_claim *k, thr_err *err)
{
  for (int i = 0; i < k->c->n_passes; i++)
    if (k->c->tension[i] != 0)
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation of cord %s: pass %d has tension, but the cord is not pulled",
                      k->id, i + 1);
  return THR_OK;
}

/* After a schedule: the exponents are those of the law, and the tensions what the steps leave,
 * worked out by the checker itself.
 */
static thr_status check_scheduled(const cord_claim *k, int i, thr_err *err)
{
  const thr_eval_cord *eval_cord = k->c;
  const double hardest = thr_schedule_hardest(&k->e->schedule, i);
  const bool slack = thr_schedule_slack(&k->e->schedule, i);
  if (slack && (eval_cord->pull != THR_PULL_NONE || eval_cord->most))
    return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: the schedule leaves it slack",
                    k->id);
  if (!slack && eval_cord->pull != THR_PULL_BOTH)
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: pull: after a schedule it says both", k->id);
  thr_status st = evaluated(k, "force", eval_cord->force, hardest, err);
  if (!st) st = evaluated(k, "other_force", eval_cord->other_force, 0, err);
  if (!st) st = evaluated(k, "work", eval_cord->work, hardest, err);
  if (!st) st = check_slackest(k, hardest, err);
  for (int j = 0;
       j + 1 < eval_cord->n_passes && !st && k->e->method != THR_JOINT && !k->e->standing.taut; j++)
    if (!thr_check_close(eval_cord->exponent[j], law_exponent(k, j), 1))
      st =
          thr_fail(err, THR_EVIOLATED,
                   "evaluation of cord %s: exponents[%d]: stated %.12g, but the %s law gives %.12g",
                   k->id, j, eval_cord->exponent[j], thr_law_name(k->e->law), law_exponent(k, j));
  if (st || slack) return st ? st : check_slack(k, err);
  return thr_check_schedule(k->f, k->cord, &k->e->schedule, i, &k->e->physics, eval_cord, err);
}

static thr_status check_cord_evaluation(const thr_plan *plan, int i, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_cord *cord = &plan->cord[i];
  const thr_eval_cord *eval_cord = &evaluation->cord[i];
  const int from_end =
      thr_check_from_end(&plan->options, eval_cord->pull, eval_cord->slackest, cord->n_passes);
  const cord_claim k = {&plan->frame, cord, evaluation, eval_cord, cord->id, from_end};
  const bool tight = evaluation->method == THR_JOINT || evaluation->standing.taut;
  double turning = 0;
  for (int j = 0; j + 1 < cord->n_passes; j++)
    turning += thr_check_angle(&plan->frame, cord->half[j], cord->half[j + 1]);
  if (!thr_check_close(eval_cord->turning, turning, 1 + turning))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation of cord %s: turning: stated %.12g, but the cord turns by %.12g",
                    k.id, eval_cord->turning, turning);
  if (!(eval_cord->taut_turning >= 0) || (!tight && eval_cord->taut_turning != eval_cord->turning))
    return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: taut_turning: %.12g; expected %s",
                    k.id, eval_cord->taut_turning,
                    tight ? "0 or more" : "the turning, for this method");
  if (!(eval_cord->error >= 0) ||
      (evaluation->method == THR_CAPSTAN && (eval_cord->error > 0 || eval_cord->refused > 0)))
    return thr_fail(
        err, THR_EVIOLATED,
        "evaluation of cord %s: error and refused: no such error is possible with this method",
        k.id);
  if (evaluation->schedule.n > 0) return check_scheduled(&k, i, err);
  thr_status st = check_forces(&k, err);
  if (eval_cord->pull == THR_PULL_NONE) return st ? st : check_slack(&k, err);
  if (!st) st = check_rise(&k, err);
  if (!st && evaluation->method != THR_CAPSTAN && from_end < cord->n_passes)
    st = evaluated(&k, "tension behind the slackest pass", eval_cord->tension[from_end],
                   eval_cord->tension[eval_cord->slackest], err);
  if (!st && evaluation->method == THR_CAPSTAN) st = check_law(&k, &plan->options, err);
  return st;
}

/* Are all sizes filled in, and do they fit the framework? */
static thr_status check_physics(const thr_plan *plan, thr_err *err)
{
  thr_physics again;
  thr_err found = {0};
  const thr_physics *stated = &plan->evaluation.physics;
  thr_status st = thr_physics_resolve(stated, &plan->frame, &again, &found);
  if (st == THR_ENOMEM) return thr_nomem(err);
  if (st) return thr_fail(err, THR_EVIOLATED, "evaluation.physics: %s", found.text);
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(stated, &thr_physics_fields[i]) !=
        thr_physics_get(&again, &thr_physics_fields[i]))
      return thr_fail(err, THR_EVIOLATED,
                      "evaluation.physics.%s: an evaluation states what it used, so not 0",
                      thr_physics_fields[i].key);
  if (stated->mu_power > 0 && stated->mu_power < 1 &&
      (plan->evaluation.method != THR_CAPSTAN || plan->evaluation.law != THR_LAW_CAPSTAN))
    return thr_fail(err, THR_EVIOLATED,
                    "evaluation.physics.mu_power: only the capstan law of method capstan has it");
  return THR_OK;
}

/* Part of the gaps that the cords go through whose passes press with the seating tension or more.
 * Gaps at the threshold, which rounding may count either way, may be counted either way. */
static thr_status check_seated(const thr_plan *plan, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const int n_edges = plan->frame.n_edges;
  double *press = thr_calloc((size_t)n_edges + 1, sizeof *press);
  if (!press) return thr_nomem(err);
  for (int e = 0; e < n_edges; e++)
    press[e] = -1; /* no cord goes through */
  bool known = true;
  for (int i = 0; i < evaluation->n_cords; i++) {
    known &= evaluation->cord[i].known;
    for (int k = 0; k < plan->cord[i].n_passes; k++) {
      double *at = &press[plan->cord[i].half[k] >> 1];
      *at = fmax(*at, 0) + (evaluation->cord[i].known ? evaluation->cord[i].tension[k] : 0);
    }
  }
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
