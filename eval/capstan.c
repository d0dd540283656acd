/* The capstan law along every cord. */
#include "eval/capstan.h"

#include <math.h>
#include <stdlib.h>

thr_capstan_options thr_capstan_options_default(void)
{
  return (thr_capstan_options){.mu = 0.2, .seating = 1, .pull = THR_PULL_BOTH};
}

void thr_capstan_destroy(thr_capstan *c)
{
  for (int i = 0; i < c->n_cords; i++)
    free(c->cord[i].tension);
  free(c->cord);
  *c = (thr_capstan){0};
}

/* The pass that the last tension reaches: the far end, or between two pulled ends the first pass with no less turning behind it
 * than before it. */
static int slackest_pass(const thr_frame *f, const thr_cord *c, thr_pull pull, double turning)
{
  if (pull == THR_PULL_START) return c->n_passes - 1;
  if (pull == THR_PULL_END) return 0;
  double behind = 0, next = 0;
  int i = 0;
  for (; i + 1 < c->n_passes; i++) {
    next = behind + thr_turn_angle(f, c->half[i], c->half[i + 1]);
    if (next > turning / 2) break;
    behind = next;
  }
  /* Passes i and i + 1 lie either side of the middle: the better one needs less force at its far end. */
  bool later = i + 1 < c->n_passes && fmax(next, turning - next) < fmax(behind, turning - behind);
  return later ? i + 1 : i;
}

static thr_status eval_cord(const thr_frame *f, const thr_cord *c, const thr_capstan_options *o, thr_capstan_cord *out,
                            thr_err *err)
{
  out->turning = thr_cord_turning(f, c, false);
  out->slackest = slackest_pass(f, c, o->pull, out->turning);
  if (!(out->tension = thr_calloc((size_t)c->n_passes, sizeof *out->tension))) return thr_nomem(err);
  double from = 0, to = 0; /* turning between the slackest pass and the pass at hand, towards the start and the end */
  out->tension[out->slackest] = o->seating;
  for (int i = out->slackest; i > 0; i--) {
    from += thr_turn_angle(f, c->half[i - 1], c->half[i]);
    out->tension[i - 1] = o->seating * exp(o->mu * from);
  }
  for (int i = out->slackest; i + 1 < c->n_passes; i++) {
    to += thr_turn_angle(f, c->half[i], c->half[i + 1]);
    out->tension[i + 1] = o->seating * exp(o->mu * to);
  }
  double at_start = out->tension[0], at_end = out->tension[c->n_passes - 1];
  if (o->mu * fmax(from, to) > 700 || !isfinite(at_start) || !isfinite(at_end))
    return thr_fail(
        err, THR_EINPUT,
        "cord %s: mu * turning = %.0f is past what a number can hold (700); use a smaller mu, or a plan with more cords", c->id,
        o->mu * fmax(from, to));
  out->force = o->pull == THR_PULL_START ? at_start : o->pull == THR_PULL_END ? at_end : fmax(at_start, at_end);
  out->other_force = o->pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;
  out->loss = 1 - o->seating / out->force;
  return THR_OK;
}

thr_status thr_capstan_eval(const thr_frame *f, const thr_cord *cord, int n_cords, const thr_capstan_options *o, thr_capstan *out,
                            thr_err *err)
{
  thr_capstan result = {0};
  *out = result;
  if (!(o->mu >= 0) || !isfinite(o->mu)) return thr_fail(err, THR_EINPUT, "mu = %g: a friction coefficient is 0 or more", o->mu);
  if (!(o->seating > 0) || !isfinite(o->seating))
    return thr_fail(err, THR_EINPUT, "seating tension = %g N: must be more than 0", o->seating);
  if (!(result.cord = thr_calloc((size_t)n_cords, sizeof *result.cord))) return thr_nomem(err);
  result.n_cords = n_cords;
  thr_status st = THR_OK;
  for (int i = 0; i < n_cords && !st; i++) {
    st = eval_cord(f, &cord[i], o, &result.cord[i], err);
    if (result.cord[i].force > result.largest) result.largest = result.cord[i].force;
    result.total += result.cord[i].force + result.cord[i].other_force;
  }
  if (st) thr_capstan_destroy(&result);
  *out = result;
  return st;
}
