/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed structure in Bullet, as a witness for the limit analysis: rigid beads that touch at
 * the corners of their faces, cords as forces between them. It settles above the pull at which an
 * equilibrium exists, then the pull is let off until a bead moves faster and faster. Newtons,
 * between the pulls at which the fall began and was seen, also where they contradict it. Friction
 * is the limit analysis's own (faces open by mu times their slide, bullet.cpp), so that both speak
 * of one state; Coulomb's law, under which sliding faces do not open, lets a structure fall at a
 * somewhat larger pull (docs/method.md). Beads touch only at the faces that meet in the middle of
 * an edge, feet only their own ground: a falling bead passes the others.
 *
 * The closed structure in Bullet: settles above the pull that holds it, then the pull is let off
 * until a bead moves. */
#include "eval/structure/blocks.h"

#include <math.h>
#include <stdlib.h>

int thr_settle_largest(bool large)
{
  return large ? 1000 : 400;
}

/* The protocol. */
static const double SETTLE_TIME = 2;
static const double FROZEN_TIME =
    1; /* of it no velocity is kept from step to step: forces find their way first */
static const double SETTLE_DAMPING = 0.999; /* of the velocity, per unit of time, from then on */
static const double START = 1.3, END = 0.7; /* of the pulls between which the fall must be */
static const double RAMP_TIME =
    15; /* for the pull to fall from one to the other, evenly in its logarithm */
static const double REST_TIME = 3; /* without any pull, where none need be needed */
static const double SHIFTED =
    0.05; /* of an edge: a bead that moves this far while settling does not settle */
static const double MOVED = 0.005;     /* and this far within .. */
static const double WITHIN = 0.5;      /* .. such a time falls .. */
static const double BEGUN = 0.1;       /* .. and this part of it begins to */
static const double AFTER_TIME = 3;    /* from there to the picture of the fall .. */
static const double AFTER_MOVED = 0.5; /* .. or when a bead has moved so many edges */
static const int ATTEMPTS = 2;
static const double MORE = 4; /* times the iterations at the second */
static const double ACCURACY = 0.05;

/* ---- the run ---- */

static thr_status settle(thr_simulated *m, thr_settle *out, thr_err *err)
{
  int bead = -1;
  thr_simulated_damp(m, 1);
  double most = 0;
  for (long i = 0; i < thr_simulated_steps(m, SETTLE_TIME) && most < SHIFTED; i++) {
    if (i == thr_simulated_steps(m, FROZEN_TIME)) thr_simulated_damp(m, SETTLE_DAMPING);
    thr_status s = thr_simulated_step(m, err);
    if (s != THR_OK) return s;
    most = fmax(most, thr_simulated_most_moved(m, &bead));
  }
  thr_simulated_damp(m, 0);
  out->drift = 1e3 * m->unit * most;
  out->gap_before = 1e3 * m->unit * thr_simulated_widest_gap(m);
  out->status = most < SHIFTED ? THR_SETTLE_HELD : THR_SETTLE_NEVER_SETTLED;
  out->first_bead = most < SHIFTED ? -1 : bead;
  thr_simulated_take_poses(m, out->before);
  thr_simulated_set_home(m);
  return THR_OK;
}

/* For the pull to fall by so much. */
static double time_to_fall(double part)
{
  return RAMP_TIME * log(part) / log(END / START);
}

/* The part of the start down to which the pull is let off step by step. */
static double end_of(const thr_settle_options *options, double start)
{
  return options->least > 0 ? fmin(1, END * options->least / start) : END / START;
}

static thr_status let_off(thr_simulated *m, double start, double end, double rest, thr_settle *out,
                          thr_err *err)
{
  const long ramp = thr_simulated_steps(m, time_to_fall(end)),
             every = (long)fmax(1, floor(WITHIN / m->dt / THR_LOOKS));
  double stood = start;
  int bead = -1;
  for (long i = 1; i <= ramp + thr_simulated_steps(m, rest); i++) {
    m->pull = i <= ramp ? start * pow(end, (double)i / (double)ramp) : 0;
    thr_status s = thr_simulated_step(m, err);
    if (s != THR_OK) return s;
    if (i % every != 0) continue;
    const double moved = thr_simulated_moved_lately(m, i / every - 1, &bead);
    if (moved < BEGUN * MOVED) stood = m->pull;
    if (moved < MOVED) continue;
    out->status = THR_SETTLE_FELL;
    out->fall = (stood + m->pull) / 2;
    out->error = stood - m->pull; /* it began before it could be seen to */
    out->first_bead = bead;
    return THR_OK;
  }
  return THR_OK;
}

/* A little later, for the picture. */
static thr_status fall(thr_simulated *m, thr_err *err)
{
  int bead;
  m->leans = true;
  for (long i = 0;
       i < thr_simulated_steps(m, AFTER_TIME) && thr_simulated_most_moved(m, &bead) < AFTER_MOVED;
       i++) {
    thr_status s = thr_simulated_step(m, err);
    if (s != THR_OK) return s;
  }
  return THR_OK;
}

/* In a fresh world, whose iterations are the options' times out->effort. */
static thr_status attempt(thr_simulated *m, const thr_settle_options *options, double start,
                          thr_settle *out, thr_err *err)
{
  const double end = end_of(options, start), rest = options->least > 0 ? 0 : REST_TIME;
  const thr_simulated_options world = {options->time_step, options->iterations * out->effort,
                                       options->seed};
  thr_status s = thr_simulated_build(m, &world, err);
  if (s != THR_OK) return s;
  m->all = thr_simulated_steps(m, SETTLE_TIME + time_to_fall(end) + rest + AFTER_TIME);
  m->pull = start;
  s = settle(m, out, err);
  if (s == THR_OK && out->status == THR_SETTLE_HELD) s = let_off(m, start, end, rest, out, err);
  if (s == THR_OK && out->status != THR_SETTLE_HELD) s = fall(m, err);
  out->gap_after = 1e3 * m->unit * thr_simulated_widest_gap(m);
  thr_simulated_take_poses(m, out->after);
  return s;
}

static bool counts(const thr_settle *s)
{
  return s->status == THR_SETTLE_FELL || s->status == THR_SETTLE_HELD;
}

static thr_status run(thr_simulated *m, const thr_settle_options *options, double start,
                      thr_settle *out, thr_err *err)
{
  thr_status s = THR_OK;
  out->status = THR_SETTLE_NEVER_SETTLED;
  out->effort = 1;
  for (int i = 0; s == THR_OK && i < ATTEMPTS && !counts(out); i++) {
    if (i > 0) out->effort *= MORE;
    out->fall = out->error = 0;
    s = attempt(m, options, start, out, err);
    if (s == THR_OK) thr_settle_judge(out, options->least, options->equilibrium);
  }
  return s;
}

static thr_status check(const thr_settle_options *options, double start, thr_err *err)
{
  if (!(start > 0 && start <= 1e12))
    return thr_fail(err, THR_EINPUT,
                    "structure: start pull %g N: give more than 0 and at most 1e12", start);
  if (!(options->least >= 0 && options->least <= options->equilibrium))
    return thr_fail(err, THR_EINPUT, "structure: a fall between %g and %g N cannot be",
                    options->least, options->equilibrium);
  if (!(options->time_step >= 1e-3 && options->time_step <= 10))
    return thr_fail(err, THR_EINPUT, "structure: time step factor %g: give 0.001 to 10",
                    options->time_step);
  if (!(options->iterations >= 0.01 && options->iterations <= 1000))
    return thr_fail(err, THR_EINPUT, "structure: iterations factor %g: give 0.01 to 1000",
                    options->iterations);
  return THR_OK;
}

void thr_settle_judge(thr_settle *s, double least, double equilibrium)
{
  if (s->status == THR_SETTLE_HELD && least > 0) s->status = THR_SETTLE_LATE;
  if (s->status != THR_SETTLE_FELL) return;
  if (s->fall > (1 + ACCURACY) * equilibrium || (least > 0 && s->error > ACCURACY * s->fall))
    s->status = THR_SETTLE_CREPT;
  else if (s->fall < (1 - ACCURACY) * least)
    s->status = THR_SETTLE_LATE;
}

static double start_of(const thr_settle_options *options)
{
  if (options->start > 0 || isnan(options->start)) return options->start;
  return START * (isfinite(options->equilibrium) ? options->equilibrium : options->least);
}

thr_status thr_settle_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord,
                          int n_cords, const double *const *tension, const double *const *most,
                          const thr_physics *physics, const thr_settle_options *options,
                          const thr_limits *limits, thr_settle *out, thr_err *err)
{
  const double start = start_of(options);
  *out = (thr_settle){0};
  thr_status s = check(options, start, err);
  if (s != THR_OK) return s;
  *out = (thr_settle){
      .present = true, .first_bead = -1, .n_beads = beads->n_beads, .status = THR_SETTLE_TOO_LARGE};
  if (beads->n_beads > thr_settle_largest(options->large)) return THR_OK;
  thr_simulated m = {.b = beads,
                     .f = frame,
                     .physics = physics,
                     .limits = limits,
                     .cord = cord,
                     .n_cords = n_cords,
                     .tension = tension,
                     .most = most};
  out->before = thr_calloc((size_t)beads->n_beads, sizeof *out->before);
  out->after = thr_calloc((size_t)beads->n_beads, sizeof *out->after);
  s = out->before && out->after ? thr_simulated_begin(&m, err) : thr_nomem(err);
  if (s == THR_OK) s = run(&m, options, start, out, err);
  thr_simulated_end(&m);
  if (s != THR_OK) thr_settle_destroy(out);
  return s;
}

void thr_settle_destroy(thr_settle *s)
{
  if (!s) return;
  free(s->before);
  free(s->after);
  *s = (thr_settle){0};
}
