/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what pulling, gripping, letting down and knotting leave of tension in a cord, in closed
 * form.
 *
 * Friction lets the tensions of neighbouring passes differ by at most a factor exp(e(k)), where
 * e(k) = mu x turn is the exponent of the turn between passes k and k + 1 (the capstan equation of
 * Euler and Eytelwein). Any tensions with T(k) exp(-e(k)) <= T(k + 1) <= T(k) exp(e(k)) are a state
 * of the cord at rest. With E(j, k) = the sum of the exponents between passes j and k:
 *
 *   pull P at pass j       T(k) becomes max(T(k), P exp(-E(j, k))): tighter passes do not move
 *   let down to F at j     T(k) becomes min(T(k), F exp(E(j, k))): slacker passes do not move
 *   knot that slips by u   the end is let down to the F at which the cord is shorter by u mm, which
 *                          is the sum over the passes of (tension lost, N) x (length, mm) / EA
 *
 * (the same rules as for tendons that are stressed and released: Eurocode 2, 5.10).
 *
 * A grip that draws cord from one side holds the turn on its other side until the next grip or pull
 * has taken its slack. When the grip is let go, the cord slips over the held turn, and over the
 * neighbouring turns, until each turn holds again. If the stiffness EA is known, the state after
 * slipping is the one that keeps the sum of the elongations. If EA is not known, this state lies
 * between the largest admissible state below and the least admissible state above; both are kept.
 *
 * An end that nobody has pulled, let down or knotted is free: a free end keeps no tension, and a
 * grip draws no tension from its side. Pulling one end implies that the other one is held.
 *
 * Example: exponents ln 2, ln 2 between three passes. Pulled at the end with 8 N, the passes have
 * 2, 4, 8 N. Let down to 1 N there, they have 2, 2, 1 N. */
#include "eval/cord/profile.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The tensions of one cord while a schedule is carried out. If the stiffness is known, `tension` is
 * the elastic state, and `most` the same. If the stiffness is 0 (not known), the elastic state lies
 * between the two. */
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
} cord_state;

enum { NO_TURN = THR_NO_TURN };
static const double SAME = 1e-12; /* relative: a tension that a turn just holds */

static bool at_start(thr_pull end)
{
  return end != THR_PULL_END;
}

static bool at_end(thr_pull end)
{
  return end != THR_PULL_START;
}

/* Raises every pass from `from` to `to` to what friction leaves there of a pull at pass j. */
static void raise_from(cord_state *state, int j, double pull, int from, int to)
{
  for (int k = from; k <= to; k++) {
    const double reached =
        thr_friction_less(&state->friction, pull, fabs(state->sum[k] - state->sum[j]));
    state->tension[k] = fmax(state->tension[k], reached);
    state->most[k] = fmax(state->most[k], reached);
  }
}

/* Returns the tension of pass k after letting the end down to force, if it is at tension before. */
static double lowered(const cord_state *state, int k, thr_pull end, double force, double tension)
{
  /* At pass k friction holds up to force x exp(E) against a tension of `force` at the end. */
  if (at_start(end))
    tension =
        fmin(tension, thr_friction_more(&state->friction, force, state->sum[k] - state->sum[0]));
  if (at_end(end))
    tension = fmin(tension, thr_friction_more(&state->friction, force,
                                              state->sum[state->n - 1] - state->sum[k]));
  return tension;
}

/* Lets the end down to force; only the passes on this side of a held turn give way. */
static void lower_to(cord_state *state, thr_pull end, double force)
{
  /* A held turn parts the cord: passes beyond the turn do not see the end. */
  const bool held = state->held != NO_TURN;
  const int from = held && end == THR_PULL_END ? state->held + 1 : 0,
            to = held && end == THR_PULL_START ? state->held : state->n - 1;

  for (int k = from; k <= to; k++) {
    state->tension[k] = lowered(state, k, end, force, state->tension[k]);
    state->most[k] = lowered(state, k, end, force, state->most[k]);
  }
}

/* Returns by how many mm the cord is shorter when the end is let down to force. */
static double shorter(const cord_state *state, thr_pull end, double force)
{
  double sum = 0;
  for (int k = 0; k < state->n; k++)
    sum += (state->tension[k] - lowered(state, k, end, force, state->tension[k])) *
           state->length[k] / state->stiffness;
  return sum;
}

/* Lets the end down until the cord is shorter by the slip, mm, or until the end is slack. Bisection
 * on the force to the last bit: shorter() falls as the force rises. */
static void let_slip(cord_state *state, thr_pull end, double slip)
{
  double low = 0, high = fmax(state->tension[0], state->tension[state->n - 1]);

  /* A slip longer than all of the elongation leaves the end without tension. */
  if (shorter(state, end, 0) <= slip) high = 0;

  for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2) {
    if (shorter(state, end, middle) > slip)
      low = middle;
    else
      high = middle;
  }

  lower_to(state, end, high);
}

/* ---- letting go of a grip ---- */

/* Changes tensions to the largest state below them (lower) or to the least state above them in
 * which every turn holds: one sweep forwards and one backwards, as for shortest paths on a line. */
static void sweep(const cord_state *state, double *tension, bool lower)
{
  for (int way = 0; way < 2; way++)
    for (int i = 0; i + 1 < state->n; i++) {
      const int k = way ? state->n - 2 - i : i, from = way ? k + 1 : k, to = way ? k : k + 1;

      /* A held turn takes any difference. */
      if (k == state->held) continue;

      if (lower)
        tension[to] = fmin(tension[to],
                           thr_friction_more(&state->friction, tension[from], state->exponent[k]));
      else
        tension[to] = fmax(tension[to],
                           thr_friction_less(&state->friction, tension[from], state->exponent[k]));
    }
}

/* Lets the cord slip until every turn holds the tensions on its two sides apart. With the stiffness
 * known, this is the state that keeps the elongation. Without the stiffness, `tension` becomes the
 * largest state below and `most` the least state above. */
static void relax(cord_state *state)
{
  /* EA is not known: bounds from below and from above. */
  if (state->stiffness == 0) {
    sweep(state, state->tension, true);
    sweep(state, state->most, false);
    return;
  }

  /* EA is known: the state that keeps the sum of the elongations. */
  const thr_slide slide = {state->n,      state->exponent, state->sum,
                           state->length, state->held,     state->friction};
  thr_slide_relax(&slide, state->tension);

  /* The elastic state is unique. */
  memcpy(state->most, state->tension, (size_t)state->n * sizeof *state->most);
}

/* Lets the free ends down to 0 N. A free end gives way to any tension, so that the passes keep what
 * friction alone holds. */
static void hang_free_ends(cord_state *state)
{
  if (state->start_free) lower_to(state, THR_PULL_START, 0);
  if (state->end_free) lower_to(state, THR_PULL_END, 0);
}

/* Lets go of the grip that is held, if any. */
static void let_go(cord_state *state)
{
  state->held = NO_TURN;
  relax(state);
  hang_free_ends(state);
}

/* Draws the cord out at a pass. From a side whose end is free the cord comes without tension. A
 * grip that is drawn from one side keeps the cord from sliding over the turn on its other side. The
 * grip before this one is let go when this one has taken its slack. */
static void grip(cord_state *state, const thr_schedule_step *step)
{
  /* The sides that the cord comes from with tension. */
  const int last = state->n - 1, pass = step->pass;
  const bool from_start = at_start(step->end) && !state->start_free,
             from_end = at_end(step->end) && !state->end_free;

  /* The pull of the hand spreads to these sides. */
  if (from_start || from_end)
    raise_from(state, pass, step->force, from_start ? 0 : pass, from_end ? last : pass);

  /* A grip from both sides holds nothing; a grip from one side holds the turn on the other side. */
  state->held = from_start == from_end ? NO_TURN
                : from_start           ? (pass < last ? pass : NO_TURN)
                                       : pass - 1;

  /* The grip before this one has been let go: relax() sees the new held turn only. */
  relax(state);
  hang_free_ends(state);
}

/* Pulls one end or both. Pulling one end implies that the other one is held, so that no end is free
 * afterwards. */
static void pull(cord_state *state, const thr_schedule_step *step)
{
  const int last = state->n - 1;
  state->start_free = state->end_free = false;

  if (at_start(step->end)) raise_from(state, 0, step->force, 0, last);
  if (at_end(step->end)) raise_from(state, last, step->force, 0, last);
  let_go(state);
}

/* Carries out one step of the schedule. */
static void apply(cord_state *state, const thr_schedule_step *step)
{
  switch (step->deed) {
  case THR_DEED_PULL: pull(state, step); return;
  case THR_DEED_GRIP: grip(state, step); return;
  case THR_DEED_RELEASE:
    let_go(state);
    lower_to(state, step->end, step->force);
    break;
  default:
    /* A knot: tension is lost only if the knot slips before it bites. */
    if (step->slip > 0) {
      let_go(state);
      let_slip(state, step->end, step->slip);

      /* With slip the stiffness is known, and the state is unique. */
      memcpy(state->most, state->tension, (size_t)state->n * sizeof *state->most);
    }
  }

  /* Who lets an end down or knots an end has the end in hand. */
  if (at_start(step->end)) state->start_free = false;
  if (at_end(step->end)) state->end_free = false;
}

/* Makes the state of a cord before any step: no tension, both ends free. Lengths are in mm if the
 * stiffness is known, else in units of the framework, which cancel. The arrays belong to own. */
static thr_status state_init(cord_state *state, const thr_frame *frame, const thr_cord *cord,
                             const thr_eval_cord *eval_cord, const thr_physics *physics,
                             thr_scratch *own, thr_err *err)
{
  const size_t n = (size_t)cord->n_passes;
  double mm = 1;

  *state = (cord_state){.n = cord->n_passes,
                        .exponent = eval_cord->exponent,
                        .stiffness = physics->stiffness,
                        .friction = thr_friction_of(physics),
                        .start_free = true,
                        .end_free = true,
                        .held = NO_TURN};

  state->sum = thr_scratch_array(own, n, sizeof *state->sum);
  state->length = thr_scratch_array(own, n, sizeof *state->length);
  state->tension = thr_scratch_array(own, n, sizeof *state->tension);
  state->most = thr_scratch_array(own, n, sizeof *state->most);
  thr_status st = thr_scratch_check(own, err);

  /* Elongations in mm need a unit of known length. */
  if (!st && state->stiffness > 0) st = thr_units_in_mm(frame->units, &mm, err);

  /* Lengths, and running sums of the exponents: E(j, k) = |sum[k] - sum[j]|. */
  for (int k = 0; k < state->n && !st; k++) {
    state->length[k] = mm * frame->length[cord->half[k] >> 1];
    if (k > 0) state->sum[k] = state->sum[k - 1] + eval_cord->exponent[k - 1];
  }
  return st;
}

/* Returns whether the state is known as a range only: whether `most` is above `tension`
 * anywhere. */
static bool is_open(const cord_state *state)
{
  for (int k = 0; k < state->n; k++)
    if (state->most[k] > state->tension[k] * (1 + 1e-9)) return true;
  return false;
}

/* Writes the record of the cord from its tensions. hardest: the largest force, N, that the cord is
 * pulled with. THR_ENOMEM. */
static thr_status take_state(const cord_state *state, double hardest, thr_eval_cord *out,
                             thr_err *err)
{
  /* The bottleneck of the cord. */
  int slackest = 0;
  for (int k = 0; k < state->n; k++)
    if (state->tension[k] < state->tension[slackest]) slackest = k;

  memcpy(out->tension, state->tension, (size_t)state->n * sizeof *state->tension);

  /* Record the upper tensions only where they differ. */
  if (is_open(state)) {
    if (!(out->most = thr_calloc((size_t)state->n, sizeof *out->most))) return thr_nomem(err);
    memcpy(out->most, state->most, (size_t)state->n * sizeof *state->most);
  }

  /* Totals. A schedule has no pull at a single end, so `pull` says both. */
  out->pull = THR_PULL_BOTH;
  out->force = hardest;
  out->other_force = 0;
  out->work = hardest;
  out->slackest = slackest;
  out->loss = thr_profile_loss(state->tension[slackest], hardest);
  return THR_OK;
}

/* Returns a remark if the giver of a step may not have meant it, else NULL. before: tensions and
 * `most` before the step, [2 n]; held: whether a grip was held then. */
static const char *remark_on(const cord_state *state, const thr_schedule_step *step,
                             const double *before, bool held)
{
  const bool grips = step->deed == THR_DEED_GRIP;
  if (step->deed == THR_DEED_KNOT) return NULL;

  /* A grip whose sides all have free ends draws in cord without any tension. */
  if (grips && (!at_start(step->end) || state->start_free) &&
      (!at_end(step->end) || state->end_free))
    return "the cord comes without tension: its end is free; knot or pull that first";

  /* A step that lets go of a grip has done this at least. */
  if (held) return NULL;

  /* Did the step change any tension? */
  for (int k = 0; k < state->n; k++)
    if (fabs(state->tension[k] - before[k]) > SAME * before[k] ||
        fabs(state->most[k] - before[state->n + k]) > SAME * before[state->n + k])
      return NULL;

  return step->deed == THR_DEED_RELEASE
             ? "this changes nothing: no pass is as tight as that lets it be"
             : "this changes nothing: no pass is as slack as that";
}

/* Carries out the steps of cord i, writes a remark into each, and fills the record `out`. */
static thr_status follow(const thr_frame *frame, const thr_cord *cord, thr_schedule *schedule,
                         int i, const thr_physics *physics, thr_eval_cord *out, thr_err *err)
{
  thr_scratch own = {0};
  cord_state state;
  double *before = thr_scratch_array(&own, 2 * (size_t)cord->n_passes, sizeof *before);
  thr_status st = state_init(&state, frame, cord, out, physics, &own, err);

  /* Carry out the steps of this cord; compare the tensions before and after each. */
  for (int k = 0; k < schedule->n && !st; k++) {
    if (schedule->step[k].cord != i) continue;
    const bool held = state.held != NO_TURN;

    memcpy(before, state.tension, (size_t)state.n * sizeof *before);
    memcpy(before + state.n, state.most, (size_t)state.n * sizeof *before);
    apply(&state, &schedule->step[k]);
    schedule->step[k].remark = remark_on(&state, &schedule->step[k], before, held);
  }

  /* The last grip is let go at the end. */
  if (!st) {
    let_go(&state);
    st = take_state(&state, thr_schedule_hardest(schedule, i), out, err);
  }

  thr_scratch_free(&own);
  return st;
}

/* Writes the record of a cord that is never pulled: no tension anywhere. */
static void leave_slack(thr_eval_cord *out)
{
  memset(out->tension, 0, (size_t)out->n_passes * sizeof *out->tension);
  out->pull = THR_PULL_NONE;
  out->force = out->other_force = out->loss = out->work = 0;
  out->slackest = 0;
}

/* Fails with THR_EINPUT if no cord has any tension. Method structure asks for the factor on the
 * tensions at which the structure stands, and there is no such factor then. */
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

  /* A knot that slips turns a length into a loss of tension, which needs EA. */
  for (int k = 0; k < schedule->n; k++)
    if (schedule->step[k].slip > 0 && stiffness == 0)
      return thr_fail(err, THR_EINPUT,
                      "schedule: a knot that slips lets go of tension by the cord's stiffness; "
                      "give --stiffness, EA in N");

  /* Each known cord follows its own steps, independently of the others. */
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

  /* Totals over all cords. */
  if (!st) thr_evaluation_sum(evaluation);
  return st || evaluation->method != THR_STRUCTURE ? st : some_tension(evaluation, err);
}

/* ---- grips ---- */

/* Divides the cord into parts that one pull each draws in: as few parts as possible, each with a
 * sum of exponents of at most `most`. The greedy choice, each part as long as possible, is optimal.
 * The turn between two parts is in neither, for nobody slides over this turn. last[p], if not NULL,
 * is the last pass of part p, counted from the end that is passed first (backward: the cord's end).
 * *largest: the largest sum of a part. Returns the number of parts. */
static int parts_within(const thr_eval_cord *cord, bool backward, double most, double *largest,
                        int *last)
{
  int parts = 0;
  double part = 0;
  *largest = 0;

  for (int k = 0; k + 1 < cord->n_passes; k++) {
    const double exponent = cord->exponent[backward ? cord->n_passes - 2 - k : k];

    /* The turn would overload the hand: the part ends before this turn. */
    if (part + exponent > most) {
      if (last) last[parts] = k;
      parts++;
      part = 0;
      continue;
    }

    /* The turn belongs to the part. */
    part += exponent;
    *largest = fmax(*largest, part);
  }

  if (last) last[parts] = cord->n_passes - 1;
  return parts + 1;
}

/* Returns the least possible largest sum of exponents of a part, over all divisions into at most
 * `parts` parts, which `most` must allow. Bisection: every step replaces `best` by the largest part
 * of a division that exists, or raises the lower bound. */
static double even_parts(const thr_eval_cord *cord, bool backward, double most, int parts)
{
  double low = 0, best, found;

  /* Invariant: `best` is possible, `low` is not. */
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

/* Appends a step to the schedule. */
static thr_status add(thr_schedule *schedule, int cord, thr_deed deed, thr_pull end, int pass,
                      double force, thr_err *err)
{
  return thr_schedule_add(
      schedule,
      &(thr_schedule_step){.cord = cord, .deed = deed, .end = end, .pass = pass, .force = force},
      err);
}

/* Returns the pull, N, that draws in the passes from `from` to `to` such that each has at least the
 * seating tension. Passes are counted as in parts_within. */
static double part_pull(const thr_eval_cord *cord, bool backward, int from, int to, double seating,
                        const thr_friction *friction)
{
  double part = 0;
  for (int k = from; k < to; k++)
    part += cord->exponent[backward ? cord->n_passes - 2 - k : k];
  return thr_friction_more(friction, seating, part);
}

/* Appends the steps that draw the cord in hand over hand, from the end that is pulled or tied first
 * to the other one: a pull for the first part if both ends are pulled, a grip at the end of each
 * part between, a pull for the last part. last[parts]: as parts_within fills it. */
static thr_status grip_on(const thr_eval_cord *cord, int i, double seating,
                          const thr_friction *friction, const int *last, int parts,
                          thr_schedule *schedule, thr_err *err)
{
  const bool backward = cord->pull == THR_PULL_START, both = cord->pull == THR_PULL_BOTH;

  /* The end where the work begins, and the end where it stops. */
  const thr_pull near = backward ? THR_PULL_END : THR_PULL_START,
                 far = backward ? THR_PULL_START : THR_PULL_END;

  /* The first part: pulled at its end, or tied there. */
  const double first = part_pull(cord, backward, 0, last[0], seating, friction);
  thr_status st = both ? add(schedule, i, THR_DEED_PULL, near, 0, first, err)
                       : add(schedule, i, THR_DEED_KNOT, near, 0, 0, err);

  /* Every other part has a grip at its last pass; the last part is pulled at the far end. */
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

/* Appends the steps for cord i: the fewest grips such that no pull exceeds `hand` N, with the
 * largest pull as small as possible. THR_EINPUT: the seating tension is more than hand. */
static thr_status grip_cord(const thr_eval_cord *cord, const char *id, int i,
                            const thr_physics *physics, double hand, thr_schedule *schedule,
                            thr_err *err)
{
  const thr_friction friction = thr_friction_of(physics);

  /* `hand` can draw in a part with exponents of ln(hand / seating), and no more. */
  const double seating = physics->seating,
               most = fmax(0, thr_friction_exponent(&friction, hand, seating)) * (1 + SAME);
  const bool backward = cord->pull == THR_PULL_START;

  /* A cord without a pull has no steps; a hand weaker than the seating tension has no solution. */
  if (cord->pull == THR_PULL_NONE) return add(schedule, i, THR_DEED_NONE, THR_PULL_BOTH, 0, 0, err);
  if (hand < seating * (1 - SAME))
    return thr_fail(
        err, THR_EINPUT,
        "cord %s: a hand of %g N cannot bring %g N anywhere; more --hand, or less --seating", id,
        hand, seating);

  int *last = thr_calloc((size_t)cord->n_passes, sizeof *last);
  if (!last) return thr_nomem(err);

  /* The number of parts first, then the least largest part for this number. */
  double largest;
  int parts = parts_within(cord, backward, most, &largest, NULL);

  /* Both ends at once draw in two parts without any grip. */
  const bool at_once = cord->pull == THR_PULL_BOTH && parts <= 2;
  largest = even_parts(cord, backward, most, at_once ? 2 : parts) * (1 + SAME);
  parts = parts_within(cord, backward, largest, &largest, last);

  /* Steps: one pull at both ends, or hand over hand. Both ends are knotted in the end. */
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
