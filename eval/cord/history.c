/* Tensions after a schedule, and the schedule of fewest grips. */
#include "eval/cord/history.h"
#include "graph/framework/units.h"
#include "graph/plan/friction.h"
#include "graph/plan/physics.h"
#include "graph/plan/schedule.h"
#include "graph/scratch.h"
#include "graph/plan/pulled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A cord while things are done to it. */
typedef struct {
  int n;
  double *sum;     /* [n] exponents before each pass */
  double *tension; /* [n] N */
  double *length;  /* [n] mm */
  double stiffness;
  thr_friction friction;
} state;

static bool at_start(thr_pull end)
{
  return end != THR_PULL_END;
}

static bool at_end(thr_pull end)
{
  return end != THR_PULL_START;
}

/* A pull of P at pass j, from which passes `from` to `to` slide towards it. */
static void raise_from(state *s, int j, double pull, int from, int to)
{
  for (int k = from; k <= to; k++)
    s->tension[k] = fmax(s->tension[k], thr_friction_less(&s->friction, pull, fabs(s->sum[k] - s->sum[j])));
}

static double lowered(const state *s, int k, thr_pull end, double force)
{
  double tension = s->tension[k];
  if (at_start(end)) tension = fmin(tension, thr_friction_more(&s->friction, force, s->sum[k] - s->sum[0]));
  if (at_end(end)) tension = fmin(tension, thr_friction_more(&s->friction, force, s->sum[s->n - 1] - s->sum[k]));
  return tension;
}

static void lower_to(state *s, thr_pull end, double force)
{
  for (int k = 0; k < s->n; k++)
    s->tension[k] = lowered(s, k, end, force);
}

/* mm that the cord is shorter by when the end is let down to force. */
static double shorter(const state *s, thr_pull end, double force)
{
  double sum = 0;
  for (int k = 0; k < s->n; k++)
    sum += (s->tension[k] - lowered(s, k, end, force)) * s->length[k] / s->stiffness;
  return sum;
}

/* Lets the end down until the cord is shorter by the slip, or slack at that end; by halves to the last bit. */
static void let_slip(state *s, thr_pull end, double slip)
{
  double low = 0, high = fmax(s->tension[0], s->tension[s->n - 1]);
  if (shorter(s, end, 0) <= slip) high = 0;
  for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2) {
    if (shorter(s, end, middle) > slip)
      low = middle;
    else
      high = middle;
  }
  lower_to(s, end, high);
}

static void apply(state *s, const thr_schedule_step *step)
{
  const int last = s->n - 1, pass = step->pass;
  switch (step->deed) {
  case THR_DEED_PULL:
    if (at_start(step->end)) raise_from(s, 0, step->force, 0, last);
    if (at_end(step->end)) raise_from(s, last, step->force, 0, last);
    break;
  case THR_DEED_GRIP: raise_from(s, pass, step->force, at_start(step->end) ? 0 : pass, at_end(step->end) ? last : pass); break;
  case THR_DEED_RELEASE: lower_to(s, step->end, step->force); break;
  default:
    if (step->slip > 0) let_slip(s, step->end, step->slip);
  }
}

static thr_status state_init(state *s, const thr_frame *frame, const thr_cord *cord, const thr_eval_cord *eval_cord,
                             const thr_physics *physics, thr_scratch *own, thr_err *err)
{
  const size_t n = (size_t)cord->n_passes;
  double mm = 1;
  *s = (state){.n = cord->n_passes, .stiffness = physics->stiffness, .friction = thr_friction_of(physics)};
  s->sum = thr_scratch_array(own, n, sizeof *s->sum);
  s->length = thr_scratch_array(own, n, sizeof *s->length);
  s->tension = thr_scratch_array(own, n, sizeof *s->tension);
  thr_status st = thr_scratch_check(own, err);
  if (!st && s->stiffness > 0) st = thr_units_in_mm(frame->units, &mm, err);
  for (int k = 0; k < s->n && !st; k++) {
    s->length[k] = mm * frame->length[cord->half[k] >> 1];
    if (k > 0) s->sum[k] = s->sum[k - 1] + eval_cord->exponent[k - 1];
  }
  return st;
}

/* The record of the cord from its tensions. THR_EINPUT if there are none. */
static thr_status take_state(const state *s, const char *id, double hardest, thr_eval_cord *out, thr_err *err)
{
  int slackest = 0;
  double most = 0;
  for (int k = 0; k < s->n; k++) {
    if (s->tension[k] < s->tension[slackest]) slackest = k;
    most = fmax(most, s->tension[k]);
  }
  if (most == 0)
    return thr_fail(err, THR_EINPUT,
                    "schedule: it leaves cord %s without any tension; end with a pull, or let its ends "
                    "down to more than 0 N",
                    id);
  memcpy(out->tension, s->tension, (size_t)s->n * sizeof *s->tension);
  out->pull = THR_PULL_BOTH;
  out->force = hardest;
  out->other_force = 0;
  out->work = hardest;
  out->slackest = slackest;
  out->loss = 1 - s->tension[slackest] / hardest;
  return THR_OK;
}

static thr_status follow(const thr_frame *frame, const thr_cord *cord, const thr_schedule *schedule, int i,
                         const thr_physics *physics, thr_eval_cord *out, thr_err *err)
{
  thr_scratch own = {0};
  state s;
  thr_status st = state_init(&s, frame, cord, out, physics, &own, err);
  for (int k = 0; k < schedule->n && !st; k++)
    if (schedule->step[k].cord == i) apply(&s, &schedule->step[k]);
  if (!st) st = take_state(&s, cord->id, thr_schedule_hardest(schedule, i), out, err);
  thr_scratch_free(&own);
  return st;
}

thr_status thr_history_follow(const thr_frame *frame, const thr_cord *cord, const thr_schedule *schedule,
                              thr_evaluation *evaluation, thr_err *err)
{
  const double stiffness = evaluation->physics.stiffness;
  thr_status st = THR_OK;
  for (int k = 0; k < schedule->n; k++)
    if (schedule->step[k].slip > 0 && stiffness == 0)
      return thr_fail(err, THR_EINPUT,
                      "schedule: a knot that slips lets go of tension by the cord's stiffness; give --stiffness, EA in N");
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].known) st = follow(frame, &cord[i], schedule, i, &evaluation->physics, &evaluation->cord[i], err);
  if (!st) thr_evaluation_sum(evaluation);
  return st;
}

/* ---- grips ---- */

/* Parts of the exponents, in order, none with more than most: how many, -1 if one exponent alone is more; *largest part. */
static int parts_within(const thr_eval_cord *cord, double most, double *largest)
{
  int parts = 1;
  double part = 0;
  *largest = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    if (cord->exponent[k] > most) return -1;
    if (part + cord->exponent[k] > most) {
      parts++;
      part = 0;
    }
    part += cord->exponent[k];
    *largest = fmax(*largest, part);
  }
  return parts;
}

/* The least largest part of as few parts as `most` allows. Each try ends at a largest part that exists, or at too many parts. */
static double even_parts(const thr_eval_cord *cord, double most, int parts)
{
  double low = 0, best, found;
  (void)parts_within(cord, most, &best);
  while (best - low > 1e-12 * best) {
    const double middle = (low + best) / 2;
    if (parts_within(cord, middle, &found) == parts)
      best = found;
    else
      low = middle;
  }
  return best;
}

static thr_status add(thr_schedule *schedule, int cord, thr_deed deed, thr_pull end, int pass, double force, thr_err *err)
{
  return thr_schedule_add(schedule, &(thr_schedule_step){.cord = cord, .deed = deed, .end = end, .pass = pass, .force = force},
                          err);
}

/* Grips from a start that is tied, the last at the end. */
static thr_status grip_on(const thr_eval_cord *cord, int i, double seating, const thr_friction *friction, double most,
                          thr_schedule *schedule, thr_err *err)
{
  const int last = cord->n_passes - 1;
  double part = 0;
  thr_status st = add(schedule, i, THR_DEED_KNOT, THR_PULL_START, 0, 0, err);
  for (int k = 0; k < last && !st; k++) {
    if (part + cord->exponent[k] > most) {
      st = add(schedule, i, THR_DEED_GRIP, THR_PULL_START, k, thr_friction_more(friction, seating, part), err);
      part = 0;
    }
    part += cord->exponent[k];
  }
  return st ? st : add(schedule, i, THR_DEED_PULL, THR_PULL_END, 0, thr_friction_more(friction, seating, part), err);
}

static thr_status grip_cord(const thr_eval_cord *cord, const char *id, int i, const thr_physics *physics, double hand,
                            thr_schedule *schedule, thr_err *err)
{
  const thr_friction friction = thr_friction_of(physics);
  const double seating = physics->seating, most = thr_friction_exponent(&friction, hand, seating) * (1 + 1e-12),
               both = fmax(cord->force, cord->other_force);
  double largest;
  thr_status st;
  if (cord->pull == THR_PULL_BOTH && both <= hand) {
    st = add(schedule, i, THR_DEED_PULL, THR_PULL_BOTH, 0, both, err);
  } else {
    const int parts = parts_within(cord, most, &largest);
    if (parts < 0 || hand < seating)
      return thr_fail(
          err, THR_EINPUT,
          "cord %s: %g N at one grip do not bring %g N past every single turn; more --hand, less --seating or a smaller mu", id,
          hand, seating);
    st = grip_on(cord, i, seating, &friction, even_parts(cord, most, parts) * (1 + 1e-12), schedule, err);
  }
  return st ? st : add(schedule, i, THR_DEED_KNOT, THR_PULL_BOTH, 0, 0, err);
}

thr_status thr_history_grips(const thr_cord *cord, double hand, const thr_evaluation *evaluation, thr_schedule *schedule,
                             thr_err *err)
{
  thr_status st = THR_OK;
  *schedule = (thr_schedule){0};
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].known) st = grip_cord(&evaluation->cord[i], cord[i].id, i, &evaluation->physics, hand, schedule, err);
  if (st) thr_schedule_destroy(schedule);
  return st;
}
