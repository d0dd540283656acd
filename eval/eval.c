/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluates a plan: how hard must one pull? Three methods behind one interface (docs/method.md,
 * "Pull force"). Seating pull = force at the pulled ends such that the slackest point of every cord
 * holds the seating tension (methods capstan, joint). Holding pull = least pull at which the closed
 * structure has any equilibrium while the cords are being drawn in (method structure). The two are
 * different quantities: the first is proportional to the seating tension, the second to the weight.
 *
 * Checks what is asked, prepares the record, calls the method, follows the schedule, sums up.
 *
 * Example: a cord that turns by 360 degrees, mu = 0.2, seating tension 1 N, pulled at one end: 1 N
 * x exp(0.2 x 2 pi) = 3.5 N. */
#include "eval/eval.h"
#include "graph/plan/plan_measures.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* Returns the usual options: both ends of every cord are pulled. */
thr_eval_options thr_eval_options_default(void)
{
  return (thr_eval_options){.physics = thr_physics_default(),
                            .pull = THR_PULL_BOTH,
                            .time_step = 1,
                            .iterations = 1,
                            .processes = 1};
}

double thr_eval_percent(double error)
{
  return 100 * expm1(error);
}

/* Frees what an evaluation owns. */
void thr_eval_destroy(thr_eval *eval)
{
  thr_evaluation_destroy(&eval->record);
  thr_holding_destroy(&eval->holding);
  thr_holding_destroy(&eval->ideal);
  thr_holding_destroy(&eval->equal);
  thr_holding_destroy(&eval->loosest);
  thr_holding_destroy(&eval->after);
  thr_holding_destroy(&eval->stretch);
  thr_holding_destroy(&eval->loaded);

  for (int i = 0; i < eval->n_carries; i++)
    thr_carry_destroy(&eval->carries[i].carry);
  thr_carry_destroy(&eval->after_carries);
  free(eval->carries);
  *eval = (thr_eval){0};
}

/* Checks the options that do not depend on the framework. */
static thr_status check_options(const thr_eval_options *options, thr_err *err)
{
  static const uint64_t largest_seed = UINT64_C(1) << 53;

  /* Factors on what was validated. */
  if (!(options->time_step >= 0.01 && options->time_step <= 10))
    return thr_fail(err, THR_EINPUT,
                    "time step: a factor of %g; expected 0.01 to 10 times the validated step",
                    options->time_step);
  if (!(options->iterations >= 0.1 && options->iterations <= 100))
    return thr_fail(err, THR_EINPUT,
                    "iterations: a factor of %g; expected 0.1 to 100 times the validated number",
                    options->iterations);

  if (options->processes < 1)
    return thr_fail(err, THR_EINPUT, "processes: %d; expected 1 or more", options->processes);

  /* JSON's numbers are doubles, which hold every whole number up to 2^53. */
  if (options->seed > largest_seed)
    return thr_fail(err, THR_EINPUT, "seed: %" PRIu64 "; expected 0 to %" PRIu64, options->seed,
                    largest_seed);

  return THR_OK;
}

/* Returns whether the physics say what only lengths in mm make sense of. */
static bool physics_needs_units(const thr_physics *physics)
{
  return physics->wobble > 0 || physics->stiffness > 0 || physics->bead_strength > 0;
}

/* Checks that friction which changes with the load is asked of the closed form only, as no other
 * method knows it. */
static thr_status check_friction(thr_method method, thr_law law, const thr_physics *physics,
                                 thr_err *err)
{
  if (thr_friction_of(physics).power == 1 || (method == THR_CAPSTAN && law == THR_LAW_CAPSTAN))
    return THR_OK;

  return thr_fail(err, THR_EINPUT,
                  "mu_power: friction that changes with the load is of method capstan and its law; "
                  "--mu-power 0 leaves it out");
}

/* Checks the options, resolves the physics against the framework, and prepares the record of every
 * cord. */
static thr_status prepare(const thr_frame *frame, const thr_cord *cord, int n_cords,
                          thr_method method, const thr_eval_options *options,
                          thr_evaluation *evaluation, thr_err *err)
{
  *evaluation = (thr_evaluation){.present = true,
                                 .method = method,
                                 .law = method == THR_CAPSTAN ? options->law : THR_LAW_CAPSTAN,
                                 .seed = options->seed,
                                 .time_step = options->time_step,
                                 .iterations = options->iterations};

  /* What is asked for must make sense .. */
  thr_status st = check_options(options, err);
  if (!st) st = thr_physics_resolve(&options->physics, frame, &evaluation->physics, err);
  if (!st) st = check_friction(method, evaluation->law, &evaluation->physics, err);
  if (st) return st;

  /* An empty record of each cord. */
  if (!(evaluation->cord = thr_calloc((size_t)n_cords, sizeof *evaluation->cord)))
    return thr_nomem(err);
  evaluation->n_cords = n_cords;

  /* Wobble per metre, stiffness and strength need lengths in mm. */
  if (physics_needs_units(&evaluation->physics) &&
      (st = thr_units_in_mm(frame->units, &(double){0}, err)))
    return st;

  /* Each cord with its own pull, or with that of all. */
  for (int i = 0; i < n_cords; i++) {
    evaluation->cord[i].n_passes = cord[i].n_passes;
    evaluation->cord[i].pull = options->cord_pull ? options->cord_pull[i] : options->pull;
  }

  return THR_OK;
}

/* Adds what was asked for beyond one pull at the ends, grips by hand and the steps of a schedule,
 * and follows it: the record holds the tensions at the end of the schedule then. */
static thr_status follow_schedule(const thr_frame *frame, const thr_cord *cord,
                                  const thr_eval_options *options, thr_evaluation *evaluation,
                                  thr_err *err)
{
  thr_status st = THR_OK;

  if (options->hand > 0)
    st = thr_history_grips(cord, options->hand, evaluation, &evaluation->schedule, err);

  /* Its steps follow the grips. */
  for (int k = 0; options->schedule && k < options->schedule->n && !st; k++)
    st = thr_schedule_add(&evaluation->schedule, &options->schedule->step[k], err);

  return st || evaluation->schedule.n == 0 ? st : thr_history_follow(frame, cord, evaluation, err);
}

/* Adds up the cords' errors, refused turns, pulls and seated gaps. */
static thr_status sum_up(const thr_frame *frame, const thr_cord *cord, thr_eval *eval, thr_err *err)
{
  eval->complete = true;
  for (int i = 0; i < eval->record.n_cords; i++) {
    const thr_eval_cord *record = &eval->record.cord[i];
    eval->complete &= record->known;
    eval->error = fmax(eval->error, record->error);
    eval->refused += record->refused;
  }

  /* Forces grow exponentially with the turning, so that their sum may overflow. */
  thr_evaluation_sum(&eval->record);
  thr_status st = thr_seating_fraction(frame, cord, &eval->record, err);

  if (st) return st;
  if (isfinite(eval->record.total)) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "all pulls together are past what a number can hold; use a smaller mu, or a plan "
                  "with more cords");
}

/* Evaluates a plan by one method; see eval.h. */
thr_status thr_eval_plan(const thr_frame *frame, const thr_cord *cord, int n_cords,
                         thr_method method, const thr_eval_options *options,
                         const thr_limits *limits, thr_eval *out, thr_err *err)
{
  static thr_status (*const run[THR_N_METHODS])(
      const thr_frame *, const thr_cord *, const thr_eval_options *, const thr_limits *, thr_eval *,
      thr_err *) = {[THR_CAPSTAN] = thr_capstan_method,
                    [THR_JOINT] = thr_joint_method,
                    [THR_STRUCTURE] = thr_structure_method};

  /* What no method sets is unknown. */
  thr_eval eval = {.interpolation = NAN, .let_down = NAN, .after_carries = {.first_bead = -1}};
  *out = (thr_eval){0};

  /* The method, and what is done to the cords after it. */
  thr_status st = prepare(frame, cord, n_cords, method, options, &eval.record, err);
  if (!st) st = run[method](frame, cord, options, limits, &eval, err);
  if (!st) st = follow_schedule(frame, cord, options, &eval.record, err);

  /* With a schedule, method structure answers what its tensions hold. */
  if (!st && method == THR_STRUCTURE && eval.record.schedule.n > 0)
    st = thr_structure_after(frame, cord, options, limits, &eval, err);

  /* Proofs are recorded even if the time did not suffice for all of them; not those of pieces that
   * the record does not know. */
  if (eval.record.standing.present && !options->bodies && (!st || st == THR_ELIMIT)) {
    const thr_status kept = thr_structure_record(frame->n_nodes, options, &eval, err);
    if (kept) st = kept;
  }

  /* What is complete stays after a stop, whatever it adds up to. */
  if (!st)
    st = sum_up(frame, cord, &eval, err);
  else if (st == THR_ELIMIT)
    (void)sum_up(frame, cord, &eval, NULL);
  if (st && st != THR_ELIMIT) thr_eval_destroy(&eval);
  *out = eval;
  return st;
}

/* Evaluates a plan by the closed form; see eval.h. */
thr_status thr_eval_closed_form(const thr_plan *plan, double seating, thr_eval *out, thr_err *err)
{
  const thr_limits none = {0};
  thr_eval_options options = thr_eval_options_default();
  options.physics = plan->options.physics;
  options.physics.seating = seating;
  return thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, THR_CAPSTAN, &options, &none, out,
                       err);
}

/* Computes from which multiple of the pulls the pieces hold; see eval.h. */
thr_status thr_eval_holding_factor(const thr_plan *plan, const thr_evaluation *evaluation,
                                   double *times, thr_err *err)
{
  const thr_limits none = {0};
  *times = NAN;

  /* Tubes have no shape in the limit analysis; method structure and schedules have answers of their
   * own. */
  if (plan->options.joint == THR_JOINT_TUBE || evaluation->method == THR_STRUCTURE ||
      evaluation->schedule.n > 0)
    return THR_OK;

  for (int i = 0; i < evaluation->n_cords; i++)
    if (!evaluation->cord[i].known) return THR_OK;

  thr_status st = thr_eval_holds_from(&plan->frame, plan->cord, evaluation, &none, times, err);
  if (!st && isinf(*times) && thr_frame_feet(&plan->frame) == 0) *times = NAN;

  return st;
}
