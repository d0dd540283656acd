/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks schedules: computes the tensions that pulls, grips, releases and knots leave in a cord.
 *
 * A turn holds the tensions on both sides of it apart by a factor (docs/plan-format.md, "A step of
 * a schedule"). A step changes the tension at one pass; sweeps along the cord then restore the
 * inequality at every turn. Where the cord's stiffness is known, cord that slips takes its stretch
 * along: passes are pooled from the start on, as in isotonic regression (pool adjacent violators).
 * Where it is not, the schedule is followed twice, for the least and for the largest tensions. The
 * file shares no code with eval/. */
#include "graph/check/check_parts.h"

#include <math.h>
#include <string.h>

/* A cord: tension and length of each pass, and by what factor each turn holds the tensions on both
 * sides of it apart. Without stiffness the schedule is followed twice: for the least tensions and
 * for the largest ones. */
typedef struct {
  int n;
  const thr_physics *physics;
  const double *exponent;
  double *tension, *lower, *length, *sum;
  int *first;    /* of pools of passes */
  bool largest;  /* the largest tensions are followed, not the least ones */
  bool loose[2]; /* its start, its end, is free */
  int kept;      /* the turn that a grip keeps from slipping, or -1 */
} cord_state;

/* Spreads a pull from pass j to pass `to`: every pass on the way has at least what the turns let
 * through. */
static void spread(cord_state *cord, int j, int to, double pull)
{
  const int step = to < j ? -1 : 1;
  cord->tension[j] = fmax(cord->tension[j], pull);

  for (int k = j; k != to; k += step) {
    pull = thr_check_tension(cord->physics, pull, -cord->exponent[step > 0 ? k : k - 1]);
    cord->tension[k + step] = fmax(cord->tension[k + step], pull);
  }
}

/* Lets one end down to a force: each pass gives way as far as the turns between do not hold it. */
static void give_way(const cord_state *cord, bool start, double force, double *tension)
{
  for (int i = 0; i < cord->n; i++) {
    const int k = start ? i : cord->n - 1 - i;
    tension[k] = fmin(tension[k], force);
    if (i + 1 < cord->n)
      force = thr_check_tension(cord->physics, force, cord->exponent[start ? k : k - 1]);
  }
}

/* Writes to `to` the tensions after one end, or both, is let down to a force. */
static void let_down(const cord_state *cord, thr_pull end, double force, double *to)
{
  memcpy(to, cord->tension, (size_t)cord->n * sizeof *to);
  if (end != THR_PULL_END) give_way(cord, true, force, to);
  if (end != THR_PULL_START) give_way(cord, false, force, to);
}

/* Returns by how much the cord gets shorter, mm, if the end is let down to a force; stiffness: EA.
 */
static double shortening(cord_state *cord, thr_pull end, double force, double stiffness)
{
  double sum = 0;
  let_down(cord, end, force, cord->lower);

  for (int k = 0; k < cord->n; k++)
    sum += (cord->tension[k] - cord->lower[k]) * cord->length[k];
  return sum / stiffness;
}

/* Lets an end down to the force that a knot leaves which slips by so much, mm. */
static void slip(cord_state *cord, thr_pull end, double by, double stiffness)
{
  double low = 0, high = fmax(cord->tension[0], cord->tension[cord->n - 1]);

  /* Even a free end may not shorten the cord so much. */
  if (shortening(cord, end, 0, stiffness) <= by) high = 0;

  /* The shortening falls as the force rises: the secant method, every third step by halves. */
  for (int i = 0; i < 200 && high > low; i++) {
    const double at_low = shortening(cord, end, low, stiffness) - by,
                 at_high = shortening(cord, end, high, stiffness) - by;
    double next = i % 3 ? low + (high - low) * at_low / (at_low - at_high) : (low + high) / 2;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next <= low || next >= high) break;

    if (shortening(cord, end, next, stiffness) > by)
      low = next;
    else
      high = next;
  }

  /* The upper end of the interval shortens the cord by no more than the slip. */
  let_down(cord, end, high, cord->lower);
  memcpy(cord->tension, cord->lower, (size_t)cord->n * sizeof *cord->tension);
}

/* ---- the cord settles ---- */

/* Returns the tension that turns hold at pass `to` against one at pass `from`: at least or, up, at
 * most. */
static double carried(const cord_state *cord, double tension, int from, int to, bool up)
{
  for (int k = from; k != to; k += to < from ? -1 : 1) {
    const double exponent = cord->exponent[to < from ? k - 1 : k];
    tension = thr_check_tension(cord->physics, tension, up ? exponent : -exponent);
  }
  return tension;
}

/* Settles a cord without stiffness: no pass has more (or less) tension than its neighbours allow.
 */
static void settle_open(const cord_state *cord)
{
  /* Forwards, then backwards; a turn that a grip keeps does not slip. */
  for (int i = 1; i < cord->n; i++)
    if (cord->kept != i - 1) {
      const double held = carried(cord, cord->tension[i - 1], i - 1, i, !cord->largest);
      cord->tension[i] =
          cord->largest ? fmax(cord->tension[i], held) : fmin(cord->tension[i], held);
    }

  for (int i = cord->n - 2; i >= 0; i--)
    if (cord->kept != i) {
      const double held = carried(cord, cord->tension[i + 1], i + 1, i, !cord->largest);
      cord->tension[i] =
          cord->largest ? fmax(cord->tension[i], held) : fmin(cord->tension[i], held);
    }
}

/* Returns tension x length of passes a .. b, each turn between them holding all that it can against
 * `tight` at the tight end. */
static double stretched(const cord_state *cord, int a, int b, bool falls, double tight)
{
  double sum = 0;

  for (int i = a; i <= b; i++) {
    const int k = falls ? i : b - (i - a);
    sum += tight * cord->length[k];
    if (i < b) tight = thr_check_tension(cord->physics, tight, -cord->exponent[falls ? k : k - 1]);
  }

  return sum;
}

/* Returns the tension at the tight end of passes a .. b that keep their stretch. The sum rises with
 * it, in proportion where friction goes by factors. */
static double tight_end(const cord_state *cord, int a, int b, bool falls)
{
  double sum = 0, low = 0, high = 0;

  for (int k = a; k <= b; k++) {
    sum += cord->sum[k];
    high = fmax(high, cord->tension[k]);
  }

  /* A single pass keeps its tension; with friction by factors the sum is proportional to the tight
   * end. */
  if (a == b) return cord->tension[a];
  if (cord->physics->mu_power == 0 || cord->physics->mu_power == 1)
    return sum / stretched(cord, a, b, falls, 1);

  /* Otherwise by halving. */
  for (int i = 0; i < 200 && high > low; i++) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    if (stretched(cord, a, b, falls, middle) < sum)
      low = middle;
    else
      high = middle;
  }

  return high;
}

/* Pools passes from the start on: a pool whose end pulls more than the beginning of the next one
 * holds is joined to it; every pool keeps its stretch. falls: cord slips towards the start, where
 * tension falls along it by more than turns hold; else the other way. */
static void pool(cord_state *cord, bool falls)
{
  int n = 0;

  for (int k = 0; k < cord->n; k++)
    cord->sum[k] = cord->tension[k] * cord->length[k];

  /* Every pass begins as a pool of its own. */
  for (int i = 0; i < cord->n; i++) {
    cord->first[n++] = i;

    /* A turn that a grip keeps separates pools. */
    while (n > 1 && cord->kept != cord->first[n - 1] - 1) {
      const int a = cord->first[n - 2], middle = cord->first[n - 1];
      const double left = tight_end(cord, a, middle - 1, falls),
                   right = tight_end(cord, middle, i, falls);

      /* Compare the tensions on both sides of the turn between the last two pools. */
      const double before = falls ? carried(cord, left, a, middle - 1, false) : left;
      const double behind = falls ? right : carried(cord, right, i, middle, false);
      const double tight = falls ? before : behind, slack = falls ? behind : before;
      if (!(tight >
            thr_check_tension(cord->physics, slack, cord->exponent[middle - 1]) * (1 + 1e-12)))
        break;

      n--;
    }
  }

  /* Write the tensions of pools of several passes. */
  for (int p = 0; p < n; p++) {
    const int a = cord->first[p], b = p + 1 < n ? cord->first[p + 1] - 1 : cord->n - 1;
    double tight = tight_end(cord, a, b, falls);
    for (int i = a; i <= b && a < b; i++) {
      const int k = falls ? i : b - (i - a);
      cord->lower[k] = tight;
      if (i < b)
        tight = thr_check_tension(cord->physics, tight, -cord->exponent[falls ? k : k - 1]);
    }

    /* A pool of one pass keeps its tension. */
    if (a < b)
      memcpy(cord->tension + a, cord->lower + a, (size_t)(b - a + 1) * sizeof *cord->tension);
  }
}

/* Limits the tension from a free end on: it is no more than what turns hold against nothing. */
static void hang(const cord_state *cord)
{
  for (int end = 0; end < 2; end++) {
    double most = 0;

    /* From the end inwards, as long as no grip keeps a turn. */
    for (int i = 0; cord->loose[end] && i < cord->n; i++) {
      const int k = end ? cord->n - 1 - i : i, turn = end ? k - 1 : k;
      cord->tension[k] = fmin(cord->tension[k], most);

      if (i + 1 == cord->n || turn == cord->kept) break;
      most = thr_check_tension(cord->physics, most, cord->exponent[turn]);
    }
  }
}

/* Restores the inequality at every turn, and the free ends. */
static void settle(cord_state *cord)
{
  if (cord->physics->stiffness > 0) {
    pool(cord, true);
    pool(cord, false);
  } else {
    settle_open(cord);
  }

  hang(cord);
}

/* ---- the steps ---- */

/* Pulls one end or both with a force; they are not free after it. */
static void do_pull(cord_state *cord, bool start, bool end, double force)
{
  const int last = cord->n - 1;
  cord->loose[0] = cord->loose[1] = false;
  cord->kept = -1;

  if (start) spread(cord, 0, last, force);
  if (end) spread(cord, last, 0, force);
  settle(cord);
}

/* Grips pass `at` and pulls towards the ends that are not free; the turn behind the grip does not
 * slip. */
static void do_grip(cord_state *cord, int at, bool start, bool end, double force)
{
  start &= !cord->loose[0];
  end &= !cord->loose[1];

  if (start) spread(cord, at, 0, force);
  if (end) spread(cord, at, cord->n - 1, force);

  /* With one end pulled, the turn on the other side of the grip stays as it is. */
  cord->kept = start == end ? -1 : start ? at : at - 1;
  settle(cord);
}

/* Carries out one step of the schedule. Returns what is wrong with it, or NULL. */
static const char *do_step(cord_state *cord, const thr_schedule_step *step, double stiffness)
{
  const bool start = step->end != THR_PULL_END, end = step->end != THR_PULL_START;

  if (step->pass < 0 || step->pass >= cord->n)
    return "a grip at a pass that the cord does not have";
  if (step->slip > 0 && !(stiffness > 0))
    return "a knot that slips on a cord whose stiffness is not known";

  if (step->deed == THR_DEED_PULL) do_pull(cord, start, end, step->force);
  if (step->deed == THR_DEED_GRIP) do_grip(cord, step->pass, start, end, step->force);

  /* Nothing keeps a turn any more when an end gives way. */
  if (step->deed == THR_DEED_RELEASE || step->slip > 0) {
    cord->kept = -1;
    settle(cord);
  }

  if (step->deed == THR_DEED_RELEASE) {
    let_down(cord, step->end, step->force, cord->lower);
    memcpy(cord->tension, cord->lower, (size_t)cord->n * sizeof *cord->tension);
  }

  /* A knot that slips gives way by a length, a release down to a force. */
  if (step->deed == THR_DEED_KNOT && step->slip > 0) slip(cord, step->end, step->slip, stiffness);

  /* An end that was released or knotted is no longer free. */
  if (step->deed == THR_DEED_RELEASE || step->deed == THR_DEED_KNOT) {
    cord->loose[0] &= !start;
    cord->loose[1] &= !end;
  }

  return NULL;
}

/* Compares stated tensions with those found, within 1e-9 of each or 1e-15 of the largest. */
static thr_status compare(const cord_state *cord, const char *id, const double *claim,
                          const char *what, thr_err *err)
{
  double most = 0;
  for (int k = 0; k < cord->n; k++)
    most = fmax(most, cord->tension[k]);

  for (int k = 0; k < cord->n; k++)
    if (!thr_check_close(claim[k], cord->tension[k], fmax(cord->tension[k], 1e-6 * most)))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: %s of pass %d: stated %.12g N, but the schedule leaves %.12g N",
          id, what, k + 1, claim[k], cord->tension[k]);
  return THR_OK;
}

/* Follows the steps of cord i from a slack cord, and compares what they leave. */
static thr_status follow(cord_state *cord, const thr_schedule *schedule, int i, const char *id,
                         const double *claim, const char *what, thr_err *err)
{
  cord->loose[0] = cord->loose[1] = true;
  cord->kept = -1;

  for (int k = 0; k < cord->n; k++)
    cord->tension[k] = 0;

  for (int k = 0; k < schedule->n; k++) {
    const char *wrong = schedule->step[k].cord == i
                            ? do_step(cord, &schedule->step[k], cord->physics->stiffness)
                            : NULL;
    if (wrong) return thr_fail(err, THR_EVIOLATED, "evaluation: schedule[%d]: %s", k, wrong);
  }

  /* After the last step no grip holds. */
  cord->kept = -1;
  settle(cord);
  return compare(cord, id, claim, what, err);
}

thr_status thr_check_schedule(const thr_frame *frame, const thr_cord *path,
                              const thr_schedule *schedule, int i, const thr_physics *physics,
                              const thr_eval_cord *claim, thr_err *err)
{
  thr_scratch own = {0};
  const size_t n = (size_t)path->n_passes;
  double mm = 1;

  cord_state cord = {.n = path->n_passes,
                     .physics = physics,
                     .exponent = claim->exponent,
                     .tension = thr_scratch_array(&own, n, sizeof *cord.tension),
                     .lower = thr_scratch_array(&own, n, sizeof *cord.lower),
                     .length = thr_scratch_array(&own, n, sizeof *cord.length),
                     .sum = thr_scratch_array(&own, n, sizeof *cord.sum),
                     .first = thr_scratch_array(&own, n, sizeof *cord.first)};

  thr_status st = thr_scratch_check(&own, err);
  if (!st && physics->stiffness > 0 && thr_units_in_mm(frame->units, &mm, NULL))
    st = thr_fail(err, THR_EVIOLATED, "evaluation: a cord's stiffness, but no unit of length");

  if (!st && thr_schedule_steps(schedule, i) == 0)
    st = thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: no step of the schedule is its own",
                  path->id);

  /* Lengths in mm. */
  for (int k = 0; k < cord.n && !st; k++)
    cord.length[k] = mm * frame->length[path->half[k] >> 1];

  /* For the least tensions, then for the largest ones. */
  if (!st) st = follow(&cord, schedule, i, path->id, claim->tension, "tension", err);
  cord.largest = true;
  if (!st)
    st = follow(&cord, schedule, i, path->id, claim->most ? claim->most : claim->tension,
                "tension_most", err);

  thr_scratch_free(&own);
  return st;
}
