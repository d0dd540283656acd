/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what pulling, gripping, letting down and knotting leave of tension in a cord, in closed
 * form.
 *
 * Friction holds neighbouring passes apart by at most the factor of the turn between them: any
 * tensions with T(k) exp(-e(k)) <= T(k + 1) <= T(k) exp(e(k)) are a state of the cord at rest. A
 * pull P at pass j raises every pass that slides to P exp(-(exponents between)), and leaves the
 * tighter ones; letting down to f at j lowers every pass to f exp(+(exponents between)) at most,
 * and leaves the slacker ones (the same rules as for tendons that are stressed and released:
 * Eurocode 2, 5.10). A knot lets its end down until the cord is shorter by the slip: the sum of
 * (force lost) x length / EA.
 *
 * A grip that draws from one side holds the turn on its other side until the next grip or pull has
 * taken its slack. Then the cord slips over that turn, and over those beside it, until each holds
 * again. With the stiffness known the state is the one that keeps the sum of the elongations;
 * without it that state lies between the largest state below and the least one above.
 *
 * An end that nobody has pulled, let down or knotted is free: it keeps no tension, and a grip draws
 * none from its side. Who pulls one end holds the other one.
 *
 * Example: exponents ln 2, ln 2 between three passes; pulled at the end with 8 N: 2, 4, 8. Let down
 * to 1 N: 2, 2, 1. */
#include "eval/cord/profile.h"
#include "graph/framework/units.h"
#include "graph/plan/schedule.h"
#include "graph/scratch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A cord while things are done to it. With the stiffness known, tension is the elastic state, and
 * most the same. Without it the elastic state lies between the two. */
typedef struct {
  int n;
  double *sum;      /* [n] exponents before each pass */
  double *exponent; /* [n - 1] of each turn */
  double *tension;  /* [n] N, the least */
  double *most;     /* [n] N, the largest */
  double *length;   /* [n] mm */
  double stiffness;
  thr_friction friction;
  bool start_free, end_free; /* Nobody has held or tied this end yet. */
  int held; /* The turn that a grip keeps the cord from sliding over, or NO_TURN. */
} state;

enum { NO_TURN = -1 };
static const double SAME = 1e-12; /* relative: a tension that a turn just holds */

static bool at_start(thr_pull end)
{
  return end != THR_PULL_END;
}

static bool at_end(thr_pull end)
{
  return end != THR_PULL_START;
}

/* Raises every pass from `from` to `to` to what a pull at pass j leaves of itself there. */
static void raise_from(state *s, int j, double pull, int from, int to)
{
  for (int k = from; k <= to; k++) {
    const double reached = thr_friction_less(&s->friction, pull, fabs(s->sum[k] - s->sum[j]));
    s->tension[k] = fmax(s->tension[k], reached);
    s->most[k] = fmax(s->most[k], reached);
  }
}

/* Returns the tension of pass k after letting the end down to force, if it is at tension before. */
static double lowered(const state *s, int k, thr_pull end, double force, double tension)
{
  if (at_start(end))
    tension = fmin(tension, thr_friction_more(&s->friction, force, s->sum[k] - s->sum[0]));
  if (at_end(end))
    tension = fmin(tension, thr_friction_more(&s->friction, force, s->sum[s->n - 1] - s->sum[k]));
  return tension;
}

/* Lets the end down to force; only the passes on this side of a held turn give way. */
static void lower_to(state *s, thr_pull end, double force)
{
  const bool held = s->held != NO_TURN;
  const int from = held && end == THR_PULL_END ? s->held + 1 : 0,
            to = held && end == THR_PULL_START ? s->held : s->n - 1;
  for (int k = from; k <= to; k++) {
    s->tension[k] = lowered(s, k, end, force, s->tension[k]);
    s->most[k] = lowered(s, k, end, force, s->most[k]);
  }
}

/* Returns by how many mm the cord is shorter when the end is let down to force. */
static double shorter(const state *s, thr_pull end, double force)
{
  double sum = 0;
  for (int k = 0; k < s->n; k++)
    sum += (s->tension[k] - lowered(s, k, end, force, s->tension[k])) * s->length[k] / s->stiffness;
  return sum;
}

/* Lets the end down until the cord is shorter by the slip, or slack at that end; by halves to the
 * last bit. */
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

/* ---- letting go of a grip ---- */

/* Returns whether the cord slips over turn k, from the slack side to the tight one. */
static bool slips(const state *s, const double *tension, int k, bool falling)
{
  const double tight = tension[falling ? k : k + 1], slack = tension[falling ? k + 1 : k];
  return k != s->held &&
         tight > thr_friction_more(&s->friction, slack, s->exponent[k]) * (1 + SAME);
}

/* Lowers (raises) tensions as little as turns need to hold them apart: a sweep from each end. */
static void sweep(const state *s, double *tension, bool lower)
{
  for (int way = 0; way < 2; way++)
    for (int i = 0; i + 1 < s->n; i++) {
      const int k = way ? s->n - 2 - i : i, from = way ? k + 1 : k, to = way ? k : k + 1;
      if (k == s->held) continue;
      if (lower)
        tension[to] =
            fmin(tension[to], thr_friction_more(&s->friction, tension[from], s->exponent[k]));
      else
        tension[to] =
            fmax(tension[to], thr_friction_less(&s->friction, tension[from], s->exponent[k]));
    }
}

/* Returns tension x length of passes a .. b if each turn between them holds as much as it can, with
 * `top` at the tight end. */
static double profile_sum(const state *s, int a, int b, bool falling, double top)
{
  double sum = 0;
  for (int k = a; k <= b; k++)
    sum += s->length[k] *
           thr_friction_less(&s->friction, top, fabs(s->sum[k] - s->sum[falling ? a : b]));
  return sum;
}

/* Returns the tension at the tight end with which passes a .. b keep the sum of their elongations.
 */
static double profile_top(const state *s, int a, int b, bool falling)
{
  double sum = 0, low = 0, high = 0;
  for (int k = a; k <= b; k++) {
    sum += s->length[k] * s->tension[k];
    high = fmax(high, s->tension[k]);
  }
  if (s->friction.power == 1) return sum / profile_sum(s, a, b, falling, 1);
  for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2) {
    if (profile_sum(s, a, b, falling, middle) < sum)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Lets the cord slip over turn k, and over the turns beside it that then hold no longer, until all
 * of them just hold: cord goes one way over all of them, the sum of the elongations of passes a ..
 * b stays. Extending the range on one side never takes a reason for extending it on the other, so
 * that the order does not matter (pooling of adjacent violators, as in isotonic regression: R. E.
 * Barlow et al., 1972). */
static void relax_at(state *s, int k, bool falling)
{
  int a = k, b = k + 1;
  for (bool more = true; more;) {
    const double top = profile_top(s, a, b, falling);
    const double far = thr_friction_less(&s->friction, top, s->sum[b] - s->sum[a]);
    const double first = falling ? top : far, last = falling ? far : top;
    more = false;

    /* Does the pass before the range pull cord out of it, or draw cord in? Does the pass behind it?
     */
    if (a > 0 && a - 1 != s->held) {
      const double tight = falling ? s->tension[a - 1] : first,
                   slack = falling ? first : s->tension[a - 1];
      more = tight > thr_friction_more(&s->friction, slack, s->exponent[a - 1]) * (1 + SAME);
      a -= more;
    }
    if (!more && b + 1 < s->n && b != s->held) {
      const double tight = falling ? last : s->tension[b + 1],
                   slack = falling ? s->tension[b + 1] : last;
      more = tight > thr_friction_more(&s->friction, slack, s->exponent[b]) * (1 + SAME);
      b += more;
    }
    for (int i = a; !more && i <= b; i++)
      s->tension[i] =
          thr_friction_less(&s->friction, top, fabs(s->sum[i] - s->sum[falling ? a : b]));
  }
}

/* Lets the cord slip until every turn holds the tensions on its two sides apart. The stiffness
 * tells which state that is: the elongation is kept. Without it that state lies between the largest
 * one below and the least one above. */
static void relax(state *s)
{
  if (s->stiffness == 0) {
    sweep(s, s->tension, true);
    sweep(s, s->most, false);
    return;
  }
  for (int k = 0; k + 1 < s->n; k++)
    for (int falling = 0; falling < 2; falling++)
      if (slips(s, s->tension, k, falling)) relax_at(s, k, falling);
  memcpy(s->most, s->tension, (size_t)s->n * sizeof *s->most);
}

/* A free end gives way to any tension: it keeps what friction holds against none. */
static void hang_free_ends(state *s)
{
  if (s->start_free) lower_to(s, THR_PULL_START, 0);
  if (s->end_free) lower_to(s, THR_PULL_END, 0);
}

/* Lets go of the grip that is held, if any. */
static void let_go(state *s)
{
  s->held = NO_TURN;
  relax(s);
  hang_free_ends(s);
}

/* Draws the cord out at a pass. From a side whose end is free it comes without tension. A grip that
 * is drawn from one side keeps the cord from sliding over the turn on its other side; the grip
 * before it is let go when this one has taken its slack. */
static void grip(state *s, const thr_schedule_step *step)
{
  const int last = s->n - 1, pass = step->pass;
  const bool from_start = at_start(step->end) && !s->start_free,
             from_end = at_end(step->end) && !s->end_free;
  if (from_start || from_end)
    raise_from(s, pass, step->force, from_start ? 0 : pass, from_end ? last : pass);
  s->held = from_start == from_end ? NO_TURN
            : from_start           ? (pass < last ? pass : NO_TURN)
                                   : pass - 1;
  relax(s);
  hang_free_ends(s);
}

/* Who pulls one end holds the other one. */
static void pull(state *s, const thr_schedule_step *step)
{
  const int last = s->n - 1;
  s->start_free = s->end_free = false;
  if (at_start(step->end)) raise_from(s, 0, step->force, 0, last);
  if (at_end(step->end)) raise_from(s, last, step->force, 0, last);
  let_go(s);
}

static void apply(state *s, const thr_schedule_step *step)
{
  switch (step->deed) {
  case THR_DEED_PULL: pull(s, step); return;
  case THR_DEED_GRIP: grip(s, step); return;
  case THR_DEED_RELEASE:
    let_go(s);
    lower_to(s, step->end, step->force);
    break;
  default:
    if (step->slip > 0) {
      let_go(s);
      let_slip(s, step->end, step->slip);
      memcpy(s->most, s->tension, (size_t)s->n * sizeof *s->most);
    }
  }
  if (at_start(step->end)) s->start_free = false;
  if (at_end(step->end)) s->end_free = false;
}

static thr_status state_init(state *s, const thr_frame *frame, const thr_cord *cord,
                             const thr_eval_cord *eval_cord, const thr_physics *physics,
                             thr_scratch *own, thr_err *err)
{
  const size_t n = (size_t)cord->n_passes;
  double mm = 1;
  *s = (state){.n = cord->n_passes,
               .exponent = eval_cord->exponent,
               .stiffness = physics->stiffness,
               .friction = thr_friction_of(physics),
               .start_free = true,
               .end_free = true,
               .held = NO_TURN};
  s->sum = thr_scratch_array(own, n, sizeof *s->sum);
  s->length = thr_scratch_array(own, n, sizeof *s->length);
  s->tension = thr_scratch_array(own, n, sizeof *s->tension);
  s->most = thr_scratch_array(own, n, sizeof *s->most);
  thr_status st = thr_scratch_check(own, err);
  if (!st && s->stiffness > 0) st = thr_units_in_mm(frame->units, &mm, err);
  for (int k = 0; k < s->n && !st; k++) {
    s->length[k] = mm * frame->length[cord->half[k] >> 1];
    if (k > 0) s->sum[k] = s->sum[k - 1] + eval_cord->exponent[k - 1];
  }
  return st;
}

/* Does the state have a second, larger one, which the cord may be in as well? */
static bool is_open(const state *s)
{
  for (int k = 0; k < s->n; k++)
    if (s->most[k] > s->tension[k] * (1 + 1e-9)) return true;
  return false;
}

/* The record of the cord from its tensions. THR_ENOMEM. */
static thr_status take_state(const state *s, double hardest, thr_eval_cord *out, thr_err *err)
{
  int slackest = 0;
  for (int k = 0; k < s->n; k++)
    if (s->tension[k] < s->tension[slackest]) slackest = k;
  memcpy(out->tension, s->tension, (size_t)s->n * sizeof *s->tension);
  if (is_open(s)) {
    if (!(out->most = thr_calloc((size_t)s->n, sizeof *out->most))) return thr_nomem(err);
    memcpy(out->most, s->most, (size_t)s->n * sizeof *s->most);
  }
  out->pull = THR_PULL_BOTH;
  out->force = hardest;
  out->other_force = 0;
  out->work = hardest;
  out->slackest = slackest;
  out->loss = hardest > 0 ? 1 - s->tension[slackest] / hardest : 0;
  return THR_OK;
}

/* What of a step its giver may not have meant, or NULL; before: tensions, the most of them, and
 * whether a grip was held. */
static const char *remark_on(const state *s, const thr_schedule_step *step, const double *before,
                             bool held)
{
  const bool grips = step->deed == THR_DEED_GRIP;
  if (step->deed == THR_DEED_KNOT) return NULL;
  if (grips && (!at_start(step->end) || s->start_free) && (!at_end(step->end) || s->end_free))
    return "the cord comes without tension: its end is free; knot or pull that first";
  if (held) return NULL;
  for (int k = 0; k < s->n; k++)
    if (fabs(s->tension[k] - before[k]) > SAME * before[k] ||
        fabs(s->most[k] - before[s->n + k]) > SAME * before[s->n + k])
      return NULL;
  return step->deed == THR_DEED_RELEASE
             ? "this changes nothing: no pass is as tight as that lets it be"
             : "this changes nothing: no pass is as slack as that";
}

static thr_status follow(const thr_frame *frame, const thr_cord *cord, thr_schedule *schedule,
                         int i, const thr_physics *physics, thr_eval_cord *out, thr_err *err)
{
  thr_scratch own = {0};
  state s;
  double *before = thr_scratch_array(&own, 2 * (size_t)cord->n_passes, sizeof *before);
  thr_status st = state_init(&s, frame, cord, out, physics, &own, err);
  for (int k = 0; k < schedule->n && !st; k++) {
    if (schedule->step[k].cord != i) continue;
    const bool held = s.held != NO_TURN;
    memcpy(before, s.tension, (size_t)s.n * sizeof *before);
    memcpy(before + s.n, s.most, (size_t)s.n * sizeof *before);
    apply(&s, &schedule->step[k]);
    schedule->step[k].remark = remark_on(&s, &schedule->step[k], before, held);
  }
  if (!st) {
    let_go(&s);
    st = take_state(&s, thr_schedule_hardest(schedule, i), out, err);
  }
  thr_scratch_free(&own);
  return st;
}

static void leave_slack(thr_eval_cord *out)
{
  memset(out->tension, 0, (size_t)out->n_passes * sizeof *out->tension);
  out->pull = THR_PULL_NONE;
  out->force = out->other_force = out->loss = out->work = 0;
  out->slackest = 0;
}

/* A factor on tensions is no question where there are none. */
static thr_status some_tension(const thr_evaluation *evaluation, thr_err *err)
{
  double range[2];
  if (!thr_evaluation_range(evaluation, range) || range[1] > 0) return THR_OK;
  return thr_fail(
      err, THR_EINPUT,
      "schedule: it leaves all cords without tension; knot or pull their ends before grips");
}

thr_status thr_history_follow(const thr_frame *frame, const thr_cord *cord,
                              thr_evaluation *evaluation, thr_err *err)
{
  const double stiffness = evaluation->physics.stiffness;
  thr_schedule *schedule = &evaluation->schedule;
  thr_status st = THR_OK;
  for (int k = 0; k < schedule->n; k++)
    if (schedule->step[k].slip > 0 && stiffness == 0)
      return thr_fail(err, THR_EINPUT,
                      "schedule: a knot that slips lets go of tension by the cord's stiffness; "
                      "give --stiffness, EA in N");
  for (int i = 0; i < evaluation->n_cords && !st; i++) {
    const int steps = thr_schedule_steps(schedule, i);
    if (!evaluation->cord[i].known) continue;
    if (steps == 0)
      st = thr_fail(err, THR_EINPUT,
                    "schedule: it says nothing of cord %s; \"%s: none\" leaves it slack",
                    cord[i].id, cord[i].id);
    else if (thr_schedule_slack(schedule, i))
      leave_slack(&evaluation->cord[i]);
    else
      st = follow(frame, &cord[i], schedule, i, &evaluation->physics, &evaluation->cord[i], err);
  }
  if (!st) thr_evaluation_sum(evaluation);
  return st || evaluation->method != THR_STRUCTURE ? st : some_tension(evaluation, err);
}

/* ---- grips ---- */

/* Divides the cord into parts that one pull each draws in, as few as there are with at most `most`
 * of exponents in a part: each is made as long as possible. The turn between two parts is in
 * neither, for nobody slides over it. last[p], if not NULL, is the last pass of part p, counted
 * from the end that is passed first. Returns how many parts; *largest part. */
static int parts_within(const thr_eval_cord *cord, bool backward, double most, double *largest,
                        int *last)
{
  int parts = 0;
  double part = 0;
  *largest = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    const double exponent = cord->exponent[backward ? cord->n_passes - 2 - k : k];
    if (part + exponent > most) {
      if (last) last[parts] = k;
      parts++;
      part = 0;
      continue;
    }
    part += exponent;
    *largest = fmax(*largest, part);
  }
  if (last) last[parts] = cord->n_passes - 1;
  return parts + 1;
}

/* Returns the least largest part of any division into no more than so many parts, `most` allowing
 * that. Each try ends at a largest part that exists, or at too many parts. */
static double even_parts(const thr_eval_cord *cord, bool backward, double most, int parts)
{
  double low = 0, best, found;
  (void)parts_within(cord, backward, most, &best, NULL);
  while (best - low > 1e-12 * best) {
    const double middle = (low + best) / 2;
    if (parts_within(cord, backward, middle, &found, NULL) <= parts)
      best = found;
    else
      low = middle;
  }
  return best;
}

static thr_status add(thr_schedule *schedule, int cord, thr_deed deed, thr_pull end, int pass,
                      double force, thr_err *err)
{
  return thr_schedule_add(
      schedule,
      &(thr_schedule_step){.cord = cord, .deed = deed, .end = end, .pass = pass, .force = force},
      err);
}

/* Returns the pull that draws in the passes from `from` to `to`, counted as parts_within does. */
static double part_pull(const thr_eval_cord *cord, bool backward, int from, int to, double seating,
                        const thr_friction *friction)
{
  double part = 0;
  for (int k = from; k < to; k++)
    part += cord->exponent[backward ? cord->n_passes - 2 - k : k];
  return thr_friction_more(friction, seating, part);
}

/* Hand over hand from the end that is pulled or tied first to the other one: a pull for the first
 * part if both ends are pulled, a grip at the end of each part between, a pull for the last one. */
static thr_status grip_on(const thr_eval_cord *cord, int i, double seating,
                          const thr_friction *friction, const int *last, int parts,
                          thr_schedule *schedule, thr_err *err)
{
  const bool backward = cord->pull == THR_PULL_START, both = cord->pull == THR_PULL_BOTH;
  const thr_pull near = backward ? THR_PULL_END : THR_PULL_START,
                 far = backward ? THR_PULL_START : THR_PULL_END;
  const double first = part_pull(cord, backward, 0, last[0], seating, friction);
  thr_status st = both ? add(schedule, i, THR_DEED_PULL, near, 0, first, err)
                       : add(schedule, i, THR_DEED_KNOT, near, 0, 0, err);
  for (int p = both; p < parts && !st; p++) {
    const double force =
        part_pull(cord, backward, p > 0 ? last[p - 1] + 1 : 0, last[p], seating, friction);
    if (p + 1 < parts)
      st = add(schedule, i, THR_DEED_GRIP, near, backward ? cord->n_passes - 1 - last[p] : last[p],
               force, err);
    else
      st = add(schedule, i, THR_DEED_PULL, far, 0, force, err);
  }
  return st;
}

static thr_status grip_cord(const thr_eval_cord *cord, const char *id, int i,
                            const thr_physics *physics, double hand, thr_schedule *schedule,
                            thr_err *err)
{
  const thr_friction friction = thr_friction_of(physics);
  const double seating = physics->seating,
               most = fmax(0, thr_friction_exponent(&friction, hand, seating)) * (1 + SAME);
  const bool backward = cord->pull == THR_PULL_START;
  if (cord->pull == THR_PULL_NONE) return add(schedule, i, THR_DEED_NONE, THR_PULL_BOTH, 0, 0, err);
  if (hand < seating * (1 - SAME))
    return thr_fail(
        err, THR_EINPUT,
        "cord %s: a hand of %g N cannot bring %g N anywhere; more --hand, or less --seating", id,
        hand, seating);
  int *last = thr_calloc((size_t)cord->n_passes, sizeof *last);
  if (!last) return thr_nomem(err);
  double largest;
  int parts = parts_within(cord, backward, most, &largest, NULL);
  const bool at_once = cord->pull == THR_PULL_BOTH && parts <= 2;
  largest = even_parts(cord, backward, most, at_once ? 2 : parts) * (1 + SAME);
  parts = parts_within(cord, backward, largest, &largest, last);
  thr_status st;
  if (at_once)
    st = add(schedule, i, THR_DEED_PULL, THR_PULL_BOTH, 0,
             thr_friction_more(&friction, seating, largest), err);
  else
    st = grip_on(cord, i, seating, &friction, last, parts, schedule, err);
  free(last);
  return st ? st : add(schedule, i, THR_DEED_KNOT, THR_PULL_BOTH, 0, 0, err);
}

thr_status thr_history_grips(const thr_cord *cord, double hand, const thr_evaluation *evaluation,
                             thr_schedule *schedule, thr_err *err)
{
  thr_status st = THR_OK;
  *schedule = (thr_schedule){0};
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].known)
      st =
          grip_cord(&evaluation->cord[i], cord[i].id, i, &evaluation->physics, hand, schedule, err);
  if (st) thr_schedule_destroy(schedule);
  return st;
}
