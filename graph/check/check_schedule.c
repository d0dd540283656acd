/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for schedules: the tensions that pulls, grips, releases and knots leave, swept
 * from pass to pass (docs/plan-format.md, "A step of a schedule"). Where a cord settles with its
 * stiffness known, passes are pooled from the start on as in isotonic regression. Knows nothing of
 * eval/. */
#include "graph/check/check_parts.h"
#include "graph/framework/units.h"
#include "graph/plan/schedule.h"

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
  bool largest;  /* Is it followed for the largest tensions? */
  bool loose[2]; /* Is its start, its end, free? */
  int kept;      /* the turn that a grip keeps from slipping, or -1 */
} cord;

/* A pull spreads from pass j to pass `to`: as much as the turns let through, where there is less.
 */
static void spread(cord *c, int j, int to, double pull)
{
  const int step = to < j ? -1 : 1;
  c->tension[j] = fmax(c->tension[j], pull);
  for (int k = j; k != to; k += step) {
    pull = thr_check_tension(c->physics, pull, -c->exponent[step > 0 ? k : k - 1]);
    c->tension[k + step] = fmax(c->tension[k + step], pull);
  }
}

/* What is left when one end is let down: each pass gives way as far as the turns between do not
 * hold it. */
static void give_way(const cord *c, bool start, double force, double *tension)
{
  for (int i = 0; i < c->n; i++) {
    const int k = start ? i : c->n - 1 - i;
    tension[k] = fmin(tension[k], force);
    if (i + 1 < c->n) force = thr_check_tension(c->physics, force, c->exponent[start ? k : k - 1]);
  }
}

static void let_down(const cord *c, thr_pull end, double force, double *to)
{
  memcpy(to, c->tension, (size_t)c->n * sizeof *to);
  if (end != THR_PULL_END) give_way(c, true, force, to);
  if (end != THR_PULL_START) give_way(c, false, force, to);
}

/* mm that the cord is shorter by, EA = stiffness. */
static double shortening(cord *c, thr_pull end, double force, double stiffness)
{
  double sum = 0;
  let_down(c, end, force, c->lower);
  for (int k = 0; k < c->n; k++)
    sum += (c->tension[k] - c->lower[k]) * c->length[k];
  return sum / stiffness;
}

/* The force that a knot which slips leaves at its end. The shortening falls as the force rises: by
 * the secant, held in by halves.
 */
static void slip(cord *c, thr_pull end, double by, double stiffness)
{
  double low = 0, high = fmax(c->tension[0], c->tension[c->n - 1]);
  if (shortening(c, end, 0, stiffness) <= by) high = 0;
  for (int i = 0; i < 200 && high > low; i++) {
    const double at_low = shortening(c, end, low, stiffness) - by,
                 at_high = shortening(c, end, high, stiffness) - by;
    double next = i % 3 ? low + (high - low) * at_low / (at_low - at_high) : (low + high) / 2;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (next <= low || next >= high) break;
    if (shortening(c, end, next, stiffness) > by)
      low = next;
    else
      high = next;
  }
  let_down(c, end, high, c->lower);
  memcpy(c->tension, c->lower, (size_t)c->n * sizeof *c->tension);
}

/* ---- the cord settles ---- */

/* The tension at pass `to` that turns hold at least (or, up, at most) against one at pass `from`.
 */
static double carried(const cord *c, double tension, int from, int to, bool up)
{
  for (int k = from; k != to; k += to < from ? -1 : 1) {
    const double exponent = c->exponent[to < from ? k - 1 : k];
    tension = thr_check_tension(c->physics, tension, up ? exponent : -exponent);
  }
  return tension;
}

/* Without stiffness: no pass more (less) than the one beside it lets it be. */
static void settle_open(const cord *c)
{
  for (int i = 1; i < c->n; i++)
    if (c->kept != i - 1) {
      const double held = carried(c, c->tension[i - 1], i - 1, i, !c->largest);
      c->tension[i] = c->largest ? fmax(c->tension[i], held) : fmin(c->tension[i], held);
    }
  for (int i = c->n - 2; i >= 0; i--)
    if (c->kept != i) {
      const double held = carried(c, c->tension[i + 1], i + 1, i, !c->largest);
      c->tension[i] = c->largest ? fmax(c->tension[i], held) : fmin(c->tension[i], held);
    }
}

/* Tension x length of passes a .. b, each turn between holding all that it can against `tight` at
 * the tight end. */
static double stretched(const cord *c, int a, int b, bool falls, double tight)
{
  double sum = 0;
  for (int i = a; i <= b; i++) {
    const int k = falls ? i : b - (i - a);
    sum += tight * c->length[k];
    if (i < b) tight = thr_check_tension(c->physics, tight, -c->exponent[falls ? k : k - 1]);
  }
  return sum;
}

/* The tight end of passes a .. b that keep their stretch: the sum rises with it, and where friction
 * goes by factors in proportion. */
static double tight_end(const cord *c, int a, int b, bool falls)
{
  double sum = 0, low = 0, high = 0;
  for (int k = a; k <= b; k++) {
    sum += c->sum[k];
    high = fmax(high, c->tension[k]);
  }
  if (a == b) return c->tension[a];
  if (c->physics->mu_power == 0 || c->physics->mu_power == 1)
    return sum / stretched(c, a, b, falls, 1);
  for (int i = 0; i < 200 && high > low; i++) {
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    if (stretched(c, a, b, falls, middle) < sum)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Pools passes from the start on: a pool whose end pulls more than the next one's beginning holds
 * is joined to it. falls: cord slips towards the start, where tension falls along it more than
 * turns hold; else the other way. Every pool keeps its stretch.
 */
static void pool(cord *c, bool falls)
{
  int n = 0;
  for (int k = 0; k < c->n; k++)
    c->sum[k] = c->tension[k] * c->length[k];
  for (int i = 0; i < c->n; i++) {
    c->first[n++] = i;
    while (n > 1 && c->kept != c->first[n - 1] - 1) {
      const int a = c->first[n - 2], middle = c->first[n - 1];
      const double left = tight_end(c, a, middle - 1, falls),
                   right = tight_end(c, middle, i, falls);
      const double before = falls ? carried(c, left, a, middle - 1, false) : left;
      const double behind = falls ? right : carried(c, right, i, middle, false);
      const double tight = falls ? before : behind, slack = falls ? behind : before;
      if (!(tight > thr_check_tension(c->physics, slack, c->exponent[middle - 1]) * (1 + 1e-12)))
        break;
      n--;
    }
  }
  for (int p = 0; p < n; p++) {
    const int a = c->first[p], b = p + 1 < n ? c->first[p + 1] - 1 : c->n - 1;
    double tight = tight_end(c, a, b, falls);
    for (int i = a; i <= b && a < b; i++) {
      const int k = falls ? i : b - (i - a);
      c->lower[k] = tight;
      if (i < b) tight = thr_check_tension(c->physics, tight, -c->exponent[falls ? k : k - 1]);
    }
    if (a < b) memcpy(c->tension + a, c->lower + a, (size_t)(b - a + 1) * sizeof *c->tension);
  }
}

/* A free end keeps what turns hold against nothing. */
static void hang(const cord *c)
{
  for (int end = 0; end < 2; end++) {
    double most = 0;
    for (int i = 0; c->loose[end] && i < c->n; i++) {
      const int k = end ? c->n - 1 - i : i, turn = end ? k - 1 : k;
      c->tension[k] = fmin(c->tension[k], most);
      if (i + 1 == c->n || turn == c->kept) break;
      most = thr_check_tension(c->physics, most, c->exponent[turn]);
    }
  }
}

static void settle(cord *c)
{
  if (c->physics->stiffness > 0) {
    pool(c, true);
    pool(c, false);
  } else {
    settle_open(c);
  }
  hang(c);
}

/* ---- the steps ---- */

static void do_pull(cord *c, bool start, bool end, double force)
{
  const int last = c->n - 1;
  c->loose[0] = c->loose[1] = false;
  c->kept = -1;
  if (start) spread(c, 0, last, force);
  if (end) spread(c, last, 0, force);
  settle(c);
}

static void do_grip(cord *c, int at, bool start, bool end, double force)
{
  start &= !c->loose[0];
  end &= !c->loose[1];
  if (start) spread(c, at, 0, force);
  if (end) spread(c, at, c->n - 1, force);
  c->kept = start == end ? -1 : start ? at : at - 1;
  settle(c);
}

static const char *do_step(cord *c, const thr_schedule_step *step, double stiffness)
{
  const bool start = step->end != THR_PULL_END, end = step->end != THR_PULL_START;
  if (step->pass < 0 || step->pass >= c->n) return "a grip at a pass that the cord does not have";
  if (step->slip > 0 && !(stiffness > 0))
    return "a knot that slips on a cord whose stiffness is not known";
  if (step->deed == THR_DEED_PULL) do_pull(c, start, end, step->force);
  if (step->deed == THR_DEED_GRIP) do_grip(c, step->pass, start, end, step->force);
  if (step->deed == THR_DEED_RELEASE || step->slip > 0) {
    c->kept = -1;
    settle(c);
  }
  if (step->deed == THR_DEED_RELEASE) {
    let_down(c, step->end, step->force, c->lower);
    memcpy(c->tension, c->lower, (size_t)c->n * sizeof *c->tension);
  }
  if (step->deed == THR_DEED_KNOT && step->slip > 0) slip(c, step->end, step->slip, stiffness);
  if (step->deed == THR_DEED_RELEASE || step->deed == THR_DEED_KNOT) {
    c->loose[0] &= !start;
    c->loose[1] &= !end;
  }
  return NULL;
}

static thr_status compare(const cord *c, const char *id, const double *claim, const char *what,
                          thr_err *err)
{
  double most = 0;
  for (int k = 0; k < c->n; k++)
    most = fmax(most, c->tension[k]);
  for (int k = 0; k < c->n; k++)
    if (!thr_check_close(claim[k], c->tension[k], fmax(c->tension[k], 1e-6 * most)))
      return thr_fail(
          err, THR_EVIOLATED,
          "evaluation of cord %s: %s of pass %d: stated %.12g N, but the schedule leaves %.12g N",
          id, what, k + 1, claim[k], c->tension[k]);
  return THR_OK;
}

/* Follows the steps of cord i and compares what they leave. */
static thr_status follow(cord *c, const thr_schedule *schedule, int i, const char *id,
                         const double *claim, const char *what, thr_err *err)
{
  c->loose[0] = c->loose[1] = true;
  c->kept = -1;
  for (int k = 0; k < c->n; k++)
    c->tension[k] = 0;
  for (int k = 0; k < schedule->n; k++) {
    const char *wrong =
        schedule->step[k].cord == i ? do_step(c, &schedule->step[k], c->physics->stiffness) : NULL;
    if (wrong) return thr_fail(err, THR_EVIOLATED, "evaluation: schedule[%d]: %s", k, wrong);
  }
  c->kept = -1;
  settle(c);
  return compare(c, id, claim, what, err);
}

thr_status thr_check_schedule(const thr_frame *frame, const thr_cord *path,
                              const thr_schedule *schedule, int i, const thr_physics *physics,
                              const thr_eval_cord *claim, thr_err *err)
{
  thr_scratch own = {0};
  const size_t n = (size_t)path->n_passes;
  double mm = 1;
  cord c = {.n = path->n_passes,
            .physics = physics,
            .exponent = claim->exponent,
            .tension = thr_scratch_array(&own, n, sizeof *c.tension),
            .lower = thr_scratch_array(&own, n, sizeof *c.lower),
            .length = thr_scratch_array(&own, n, sizeof *c.length),
            .sum = thr_scratch_array(&own, n, sizeof *c.sum),
            .first = thr_scratch_array(&own, n, sizeof *c.first)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st && physics->stiffness > 0 && thr_units_in_mm(frame->units, &mm, NULL))
    st = thr_fail(err, THR_EVIOLATED, "evaluation: a cord's stiffness, but no unit of length");
  if (!st && thr_schedule_steps(schedule, i) == 0)
    st = thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: no step of the schedule is its own",
                  path->id);
  for (int k = 0; k < c.n && !st; k++)
    c.length[k] = mm * frame->length[path->half[k] >> 1];
  if (!st) st = follow(&c, schedule, i, path->id, claim->tension, "tension", err);
  c.largest = true;
  if (!st)
    st = follow(&c, schedule, i, path->id, claim->most ? claim->most : claim->tension,
                "tension_most", err);
  thr_scratch_free(&own);
  return st;
}
