/* The checker's part for schedules: the tensions that pulls, grips, releases and knots leave, swept from pass to pass. Knows
 * nothing of eval/. */
#include "graph/check/check_parts.h"
#include "graph/framework/units.h"
#include "graph/plan/schedule.h"
#include "graph/scratch.h"
#include "graph/plan/evaluation.h"
#include "graph/status.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/pulled.h"

#include <math.h>
#include <string.h>

/* A cord: tension and length of each pass, and by what factor each turn holds the tensions on both sides of it apart. */
typedef struct {
  int n;
  const thr_physics *physics;
  const double *exponent;
  double *tension, *lower, *length;
} cord;

/* A pull spreads from pass j to pass `to`: as much as the turns let through, where there is less. */
static void spread(cord *c, int j, int to, double pull)
{
  const int step = to < j ? -1 : 1;
  c->tension[j] = fmax(c->tension[j], pull);
  for (int k = j; k != to; k += step) {
    pull = thr_check_tension(c->physics, pull, -c->exponent[step > 0 ? k : k - 1]);
    c->tension[k + step] = fmax(c->tension[k + step], pull);
  }
}

/* What is left when one end is let down: each pass gives way as far as the turns between do not hold it. */
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

/* The force that a knot which slips leaves at its end. The shortening falls as the force rises: by the secant, held in by halves.
 */
static void slip(cord *c, thr_pull end, double by, double stiffness)
{
  double low = 0, high = fmax(c->tension[0], c->tension[c->n - 1]);
  if (shortening(c, end, 0, stiffness) <= by) high = 0;
  for (int i = 0; i < 200 && high > low; i++) {
    const double at_low = shortening(c, end, low, stiffness) - by, at_high = shortening(c, end, high, stiffness) - by;
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

static const char *do_step(cord *c, const thr_schedule_step *step, double stiffness)
{
  const int last = c->n - 1, at = step->pass;
  const bool start = step->end != THR_PULL_END, end = step->end != THR_PULL_START;
  if (at < 0 || at > last) return "a grip at a pass that the cord does not have";
  if (step->slip > 0 && !(stiffness > 0)) return "a knot that slips on a cord whose stiffness is not known";
  if (step->deed == THR_DEED_PULL && start) spread(c, 0, last, step->force);
  if (step->deed == THR_DEED_PULL && end) spread(c, last, 0, step->force);
  if (step->deed == THR_DEED_GRIP && start) spread(c, at, 0, step->force);
  if (step->deed == THR_DEED_GRIP && end) spread(c, at, last, step->force);
  if (step->deed == THR_DEED_RELEASE) {
    let_down(c, step->end, step->force, c->lower);
    memcpy(c->tension, c->lower, (size_t)c->n * sizeof *c->tension);
  }
  if (step->deed == THR_DEED_KNOT && step->slip > 0) slip(c, step->end, step->slip, stiffness);
  return NULL;
}

static thr_status compare(const cord *c, const char *id, const thr_eval_cord *claim, thr_err *err)
{
  double most = 0;
  for (int k = 0; k < c->n; k++)
    most = fmax(most, c->tension[k]);
  if (!(most > 0)) return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: its schedule leaves it without tension", id);
  for (int k = 0; k < c->n; k++)
    if (!thr_check_close(claim->tension[k], c->tension[k], fmax(c->tension[k], 1e-6 * most)))
      return thr_fail(err, THR_EVIOLATED, "evaluation of cord %s: pass %d: stated %.12g N, but the schedule leaves %.12g N", id,
                      k + 1, claim->tension[k], c->tension[k]);
  return THR_OK;
}

thr_status thr_check_schedule(const thr_frame *frame, const thr_cord *path, const thr_schedule *schedule, int i,
                              const thr_physics *physics, const thr_eval_cord *claim, thr_err *err)
{
  thr_scratch own = {0};
  const size_t n = (size_t)path->n_passes;
  const double stiffness = physics->stiffness;
  double mm = 1;
  cord c = {.n = path->n_passes,
            .physics = physics,
            .exponent = claim->exponent,
            .tension = thr_scratch_array(&own, n, sizeof *c.tension),
            .lower = thr_scratch_array(&own, n, sizeof *c.lower),
            .length = thr_scratch_array(&own, n, sizeof *c.length)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st && stiffness > 0 && thr_units_in_mm(frame->units, &mm, NULL))
    st = thr_fail(err, THR_EVIOLATED, "evaluation: a cord's stiffness, but no unit of length");
  for (int k = 0; k < c.n && !st; k++)
    c.length[k] = mm * frame->length[path->half[k] >> 1];
  for (int k = 0; k < schedule->n && !st; k++) {
    const char *wrong = schedule->step[k].cord == i ? do_step(&c, &schedule->step[k], stiffness) : NULL;
    if (wrong) st = thr_fail(err, THR_EVIOLATED, "evaluation: schedule[%d]: %s", k, wrong);
  }
  if (!st) st = compare(&c, path->id, claim, err);
  thr_scratch_free(&own);
  return st;
}
