/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pulls, holds and lets down, and takes the steps of a schedule (hands.h).
 *
 * Example: "A: pull both 8; A: release end 1; A: knot both" takes three times: hands pull A's ends
 * up to 8 N and hold them, the end is let down to 1 N, and both stay where they are. */
#include "eval/rise/hands.h"
#include "graph/plan/plan.h"

#include <math.h>

static const double GENTLE = 0.02;  /* of the weight, that hands begin to pull with */
static const double UP = 0.36;      /* s in which hands pull e times as much */
static const double DOWN = 1;       /* s in which they let down by a factor e .. */
static const double NOTHING = 1e-3; /* .. to so much of the pull */
static const double HOLD = 1;       /* s */
static const double DENTED = 4;     /* so many times as long where a hand dents */
static const double SETTLING = 0.5; /* s before hands pull, so that what is dropped lies */
static const double QUIET = 0.5; /* s that faces are closed, or nothing moves, before hands go on */
static const double PATIENCE = 3; /* s after which they go on anyway */
static const double STILL = 0.05; /* edges in a second: slower is quiet */
static const double WOUND = 0.99; /* of its force, with which a hand has wound its cord up */
static const double LAG = 0.05;   /* edges that a hand which winds is ahead of its cord at most */

thr_status thr_hands_check(const thr_rise_structure *structure, const thr_rise_options *options,
                           thr_err *err)
{
  const thr_schedule *schedule = options->schedule;
  bool pulled = false;
  if (options->rate < 0 || !isfinite(options->rate))
    return thr_fail(err, THR_EINPUT, "rise: hands draw cord in by more than 0 mm/s");
  if (options->spare < 0)
    return thr_fail(err, THR_EINPUT, "rise: hands have more than 0 mm of cord to give out");

  for (int c = 0; c < structure->n_cords && !schedule; c++)
    pulled |= structure->cord[c].pulled[0] || structure->cord[c].pulled[1];
  if (!schedule)
    return pulled ? THR_OK
                  : thr_fail(err, THR_EINPUT, "rise: nothing holds a cord: no end is pulled");

  if (!(structure->physics.stiffness > 0))
    return thr_fail(err, THR_EINPUT,
                    "rise: a cord whose ends are held is as tight as it is stretched: say its "
                    "stiffness EA in newtons (--stiffness)");
  if (options->let_down)
    return thr_fail(err, THR_EINPUT, "rise: the schedule says what is let down");

  for (int k = 0; k < schedule->n; k++) {
    const thr_schedule_step *step = &schedule->step[k];
    const bool grips = step->deed == THR_DEED_GRIP;
    bool held = false;
    pulled |= step->deed == THR_DEED_PULL || step->deed == THR_DEED_KNOT || grips;

    /* Some end from whose side a grip draws has been pulled, let down or tied before; pulling one
     * holds both. */
    for (int i = 0; i < k && grips; i++)
      held |= schedule->step[i].cord == step->cord && schedule->step[i].deed != THR_DEED_GRIP &&
              (schedule->step[i].deed == THR_DEED_PULL || step->end == THR_PULL_BOTH ||
               schedule->step[i].end == THR_PULL_BOTH || schedule->step[i].end == step->end);
    if (grips && !held) {
      char id[12];
      thr_cord_id(step->cord, id);
      return thr_fail(err, THR_EINPUT,
                      "rise: nothing holds cord %s against the grip at its pass %d: knot or pull "
                      "its end first",
                      id, step->pass + 1);
    }
  }
  return pulled ? THR_OK
                : thr_fail(err, THR_EINPUT,
                           "rise: nothing holds a cord: the schedule pulls and knots none");
}

thr_status thr_hands_make(thr_hands *hands, const thr_rise_structure *structure,
                          const thr_rise_options *options, thr_cable *cable, double scale,
                          double edge, double weight, thr_scratch *own, thr_err *err)
{
  const double slower = scale * (options->slower > 0 ? options->slower : 1);
  /* What is closed has the whole pull at once; what is laid is not let fall. */
  const bool shape = options->start == THR_RISE_SHAPE, laid = options->start == THR_RISE_LAID;
  *hands =
      (thr_hands){.structure = structure,
                  .options = options,
                  .cable = cable,
                  .cord = thr_scratch_array(own, (size_t)structure->n_cords, sizeof *hands->cord),
                  .friction = thr_friction_of(&structure->physics),
                  .edge = edge,
                  .settle = shape || laid ? 0 : SETTLING * scale,
                  .hold = options->shaken + scale * (options->hold > 0   ? options->hold
                                                     : options->dent > 0 ? DENTED * HOLD
                                                                         : HOLD),
                  .up = UP * slower,
                  .down = DOWN * slower,
                  .gentle = options->rate > 0 || (shape && !options->schedule)
                                ? options->pull
                                : fmin((laid ? 1 : GENTLE) * weight, options->pull),
                  .most = options->pull,
                  .quiet = QUIET * scale,
                  .patience = PATIENCE * slower,
                  .still = STILL * edge / scale,
                  .closed_since = INFINITY};
  hands->full = hands->settle + hands->up * log(hands->most / hands->gentle);
  thr_status st = thr_scratch_check(own, err);
  for (int c = 0; c < structure->n_cords && !st; c++)
    for (int end = 0; end < 2; end++) {
      hands->cord[c].free[end] = options->schedule != NULL;
      cable[c].pulled[end] = options->schedule || structure->cord[c].pulled[end];
    }
  return st;
}

/* ---- all ends together ---- */

/* The pull at all ends, N. */
static double pull_at(const thr_hands *hands, double time)
{
  if (time < hands->settle) return 0;
  const double upward = fmin(time, hands->full) - hands->settle,
               downward = time - hands->full - hands->hold;
  const double pull = fmin(hands->gentle * exp(upward / hands->up), hands->most);
  return downward > 0 ? pull * exp(-downward / hands->down) : pull;
}

/* Winds cord c up for dt s, and returns the part of their force that hands pull with: all of it
 * where they are ahead of the cord by LAG, nothing where the cord is ahead of them. They never are
 * ahead by more. */
static double wind(thr_hands *hands, int c, double time, double dt, double drawn)
{
  thr_hands_cord *cord = &hands->cord[c];
  const double lag = LAG * hands->edge;
  const int n = hands->cable[c].pulled[0] + hands->cable[c].pulled[1];
  if (!(hands->options->rate > 0)) return 1;
  if (time < hands->settle) return 0;
  cord->wound = fmin(cord->wound + n * hands->options->rate * dt, drawn + lag);
  return fmax(cord->wound - drawn, 0) / lag;
}

/* Is a hand still drawing in cord at its rate? */
static bool is_winding(const thr_hands *hands)
{
  const bool schedule = hands->options->schedule != NULL;
  for (int c = 0; c < hands->structure->n_cords; c++)
    for (int end = 0; end < 2; end++) {
      const bool moves = schedule ? hands->cord[c].moves[end] : hands->cable[c].pulled[end];
      const double most = schedule ? hands->cord[c].goal[end] : hands->most;
      if (hands->options->rate > 0 && moves && hands->cable[c].force[end] < WOUND * most)
        return true;
    }
  return false;
}

/* ---- the steps of a schedule ---- */

static bool is_at(thr_pull end, int which)
{
  return end == THR_PULL_BOTH || end == (which ? THR_PULL_END : THR_PULL_START);
}

/* Sets which ends of a cord have a hand now: those that move, and with no force those that are
 * free. */
static void put_hands(thr_hands *hands, int c)
{
  for (int end = 0; end < 2; end++)
    hands->cable[c].pulled[end] = hands->cord[c].free[end] || hands->cord[c].moves[end];
}

/* Begins a grip: from the sides whose ends are not free. A grip that draws from one side holds the
 * turn on its other side. */
static void begin_grip(thr_hands *hands, const thr_schedule_step *step)
{
  thr_cable *cable = &hands->cable[step->cord];
  const bool *free = hands->cord[step->cord].free;
  const bool from_start = is_at(step->end, 0) && !free[0],
             from_end = is_at(step->end, 1) && !free[1];
  const int held = from_start == from_end ? THR_NO_TURN
                   : from_start           ? (step->pass < cable->n - 1 ? step->pass : THR_NO_TURN)
                                          : step->pass - 1;
  thr_cable_grip(cable, step->pass, held, step->force, &hands->friction);
}

/* Begins a step, and returns the time that hands take to change their force, s. */
static double begin_step(thr_hands *hands, const thr_schedule_step *step)
{
  thr_cable *cable = &hands->cable[step->cord];
  thr_hands_cord *cord = &hands->cord[step->cord];
  double slip[2] = {0, 0}, longest = 0;
  if (step->deed == THR_DEED_NONE) return 0;
  if (step->deed == THR_DEED_GRIP) {
    begin_grip(hands, step);
    return 0;
  }
  if (step->deed == THR_DEED_RELEASE || step->slip > 0) thr_cable_let_go(cable, &hands->friction);

  for (int end = 0; end < 2; end++) {
    const double now = fmax(cable->tension[end ? cable->n - 1 : 0], 0);
    if (step->deed == THR_DEED_PULL) cord->free[end] = false;
    if (!is_at(step->end, end)) continue;
    cord->free[end] = false;
    slip[end] = step->slip;
    if (step->deed == THR_DEED_KNOT) continue;

    /* Hands pull with more, or with less, than the cord has: else they leave it so. */
    cord->moves[end] = true;
    if (step->deed == THR_DEED_PULL) {
      cord->goal[end] = fmax(step->force, now);
      cord->before[end] =
          hands->options->rate > 0
              ? cord->goal[end]
              : fmax(now, fmax(fmin(hands->gentle, step->force), NOTHING * step->force));
      longest = fmax(longest, hands->up * log(cord->goal[end] / cord->before[end]));
    } else {
      cord->goal[end] = fmin(step->force, now);
      cord->before[end] = now;
      if (now > 0)
        longest = fmax(longest, hands->down * log(now / fmax(cord->goal[end], NOTHING * now)));
    }
  }
  if (step->slip > 0) thr_cable_slip(cable, slip, &hands->friction);
  put_hands(hands, step->cord);
  return longest;
}

/* Ends a step: the ends stay where they are, and a grip is let go that a pull has taken the slack
 * of. */
static void end_step(thr_hands *hands, const thr_schedule_step *step)
{
  thr_cable *cable = &hands->cable[step->cord];
  thr_hands_cord *cord = &hands->cord[step->cord];
  for (int end = 0; end < 2; end++)
    cord->moves[end] = false;
  put_hands(hands, step->cord);
  if (step->deed != THR_DEED_PULL || !cable->gripped) return;
  cable->held = THR_NO_TURN;
  for (int end = 0; end < 2; end++)
    if (is_at(step->end, end))
      thr_cable_raise(cable, end ? cable->n - 1 : 0, step->force, &hands->friction);
  thr_cable_let_go(cable, &hands->friction);
}

/* Ends the steps under way, and begins the next ones. After the last, all grips are let go. */
static void go_on(thr_hands *hands, double time)
{
  const thr_schedule *schedule = hands->options->schedule;
  for (int k = hands->first; k < hands->next; k++)
    end_step(hands, &schedule->step[k]);
  hands->over = hands->first == schedule->n;
  hands->first = hands->next;
  hands->began = time;
  hands->ramp = 0;

  while (hands->next < schedule->n &&
         (hands->next == hands->first || schedule->step[hands->next].together)) {
    hands->ramp = fmax(hands->ramp, begin_step(hands, &schedule->step[hands->next]));
    hands->next++;
  }
  for (int c = 0; c < hands->structure->n_cords && hands->first == schedule->n; c++)
    if (hands->cable[c].gripped) thr_cable_let_go(&hands->cable[c], &hands->friction);
}

/* The force of a hand at an end that moves, N. */
static double force_at(const thr_hands *hands, const thr_hands_cord *cord, int end, double time)
{
  const double before = cord->before[end], goal = cord->goal[end],
               part = hands->ramp > 0 ? (time - hands->began) / hands->ramp : 1;
  if (part >= 1 || !(before > 0)) return goal;
  return before * pow(fmax(goal, NOTHING * before) / before, part);
}

/* ---- both ---- */

double thr_hands_pull(thr_hands *hands, double time, double dt, const double *drawn)
{
  const thr_schedule *schedule = hands->options->schedule;
  const double pull = schedule ? 0 : pull_at(hands, time);
  double largest = 0;
  for (int c = 0; c < hands->structure->n_cords; c++) {
    const double part = wind(hands, c, time, dt, drawn[c]);
    thr_cable *cable = &hands->cable[c];
    cable->stopped = hands->options->spare > 0 && -drawn[c] >= hands->options->spare;
    for (int end = 0; end < 2; end++) {
      const bool moves = !schedule || hands->cord[c].moves[end];
      cable->force[end] = !moves     ? 0
                          : schedule ? part * force_at(hands, &hands->cord[c], end, time)
                                     : part * pull;
      if (cable->pulled[end]) largest = fmax(largest, cable->force[end]);
    }
  }
  for (int k = hands->first; schedule && k < hands->next; k++)
    if (schedule->step[k].deed == THR_DEED_GRIP) largest = fmax(largest, schedule->step[k].force);
  return largest;
}

void thr_hands_watch(thr_hands *hands, double time, bool closed, double speed)
{
  if (hands->options->schedule) {
    const bool first = hands->next == 0;
    const double done = hands->began + (first ? hands->settle : hands->ramp);
    if (speed > hands->still || is_winding(hands) || time < done) hands->moved_last = time;
    if (time >= done && (first || time - hands->moved_last > hands->quiet ||
                         (time - done > hands->patience && !is_winding(hands))))
      go_on(hands, time);
    return;
  }

  /* Hands stop pulling more once all faces have been closed for a while. */
  if (!closed)
    hands->closed_since = INFINITY;
  else if (hands->closed_since == INFINITY)
    hands->closed_since = time;
  if (!closed && is_winding(hands)) hands->full = fmax(hands->full, time + hands->quiet);
  if (time < hands->full && time - hands->closed_since > hands->quiet) hands->full = time;
}

static double whole(const thr_hands *hands)
{
  return hands->full + hands->hold +
         (hands->options->let_down ? hands->down * log(1 / NOTHING) : 0);
}

bool thr_hands_are_done(const thr_hands *hands, double time)
{
  return hands->options->schedule ? hands->over : time > whole(hands);
}

bool thr_hands_hold(const thr_hands *hands, double time)
{
  return hands->options->schedule || time <= hands->full + hands->hold;
}

double thr_hands_part(const thr_hands *hands, double time)
{
  const thr_schedule *schedule = hands->options->schedule;
  return fmin(schedule ? (hands->first + 0.5) / (schedule->n + 1) : time / whole(hands), 1);
}
