/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulates in Bullet how the closed structure falls, as a witness for the limit analysis.
 *
 * The structure settles at 1.3 times the pull at which an equilibrium exists. Then the pull is let
 * off, evenly in its logarithm, down to 0.7 times the pull below which none does, until a bead
 * moves faster and faster. The result is in newtons, between the pulls at which the fall began and
 * was seen, also where it contradicts the two proved pulls.
 *
 * Friction is the limit analysis's own (faces open by mu times their slide, bullet.cpp), so that
 * both speak of one state. Coulomb's law, under which sliding faces do not open, lets a structure
 * fall at a somewhat larger pull (docs/method.md). Beads touch only at the faces that meet in the
 * middle of an edge, feet only their own ground: a falling bead passes the others.
 *
 * Example: the 7 x 7 dome with one snaking cord, pulled with 131 N and let down, falls at 0.038 N,
 * where the limit analysis says 0.041 N. */
#include "eval/structure/blocks.h"

#include <math.h>
#include <stdlib.h>

/* Returns the largest number of beads that are simulated; see beads.h. */
int thr_settle_largest(bool large)
{
  return large ? 1000 : 400;
}

/* The protocol. Times are in the unit of the simulation, sqrt(mean edge / gravity). */
static const double SETTLE_TIME = 2;
static const double FROZEN_TIME = 1; /* of SETTLE_TIME, in which no velocity is kept from step to
                                        step: forces are distributed first */
static const double SETTLE_DAMPING = 0.999; /* of the velocity, per unit of time, from then on */
static const double START = 1.3, END = 0.7; /* of the pulls between which the fall must be */
static const double RAMP_TIME = 15;         /* for the pull to fall from START to END */
static const double REST_TIME = 3;          /* without any pull, where none may be needed */
static const double SHIFTED = 0.05;    /* of an edge: by how much no bead may move while settling */
static const double MOVED = 0.005;     /* and this far within .. */
static const double WITHIN = 0.5;      /* .. such a time falls .. */
static const double BEGUN = 0.1;       /* .. and this part of it begins to */
static const double AFTER_TIME = 3;    /* from there to the picture of the fall .. */
static const double AFTER_MOVED = 0.5; /* .. or when a bead has moved so many edges */
static const int ATTEMPTS = 2;
static const double MORE = 4; /* times the iterations at the second */
static const double ACCURACY = 0.05;

/* ---- the run ---- */

/* Lets the structure settle, with the velocities frozen at first. Records how far a bead moved and
 * how wide a face opened, mm, and makes this home. */
static thr_status settle(thr_simulated *simulated, thr_settle *out, thr_err *err)
{
  int bead = -1;
  thr_simulated_damp(simulated, 1);

  /* Velocities are frozen at first, then damped, until the time is over or a bead has moved too
   * far. */
  double most = 0;
  for (long i = 0; i < thr_simulated_steps(simulated, SETTLE_TIME) && most < SHIFTED; i++) {
    if (i == thr_simulated_steps(simulated, FROZEN_TIME))
      thr_simulated_damp(simulated, SETTLE_DAMPING);
    thr_status st = thr_simulated_step(simulated, err);
    if (st != THR_OK) return st;
    most = fmax(most, thr_simulated_most_moved(simulated, &bead));
  }

  /* In mm: how far a bead moved, and how wide a face opened. */
  thr_simulated_damp(simulated, 0);
  out->drift = 1e3 * simulated->unit * most;
  out->gap_before = 1e3 * simulated->unit * thr_simulated_widest_gap(simulated);
  out->status = most < SHIFTED ? THR_SETTLE_HELD : THR_SETTLE_NEVER_SETTLED;
  out->first_bead = most < SHIFTED ? -1 : bead;

  /* Movements are measured from here on. */
  thr_simulated_take_poses(simulated, out->before);
  thr_simulated_set_home(simulated);

  return THR_OK;
}

/* Returns the time in which the pull falls to a part of its start. */
static double time_to_fall(double part)
{
  return RAMP_TIME * log(part) / log(END / START);
}

/* Returns the part of the start down to which the pull is let off step by step: END times the
 * proved pull, or END / START if nothing is proved. */
static double end_of(const thr_settle_options *options, double start)
{
  return options->least > 0 ? fmin(1, END * options->least / start) : END / START;
}

/* Lets the pull off from `start` to `end` times that, then to 0 for the time `rest`, until a bead
 * falls: moves by MOVED within WITHIN. out->fall is between the pull at which it moved by a tenth
 * of that for the last time and the pull at which the fall is seen. */
static thr_status let_off(thr_simulated *simulated, double start, double end, double rest,
                          thr_settle *out, thr_err *err)
{
  const long ramp = thr_simulated_steps(simulated, time_to_fall(end)),
             every = (long)fmax(1, floor(WITHIN / simulated->dt / THR_LOOKS));

  /* The last pull at which nothing had begun to move. */
  double stood = start;
  int bead = -1;

  for (long i = 1; i <= ramp + thr_simulated_steps(simulated, rest); i++) {
    /* Evenly in the logarithm, and at last without any pull. */
    simulated->pull = i <= ramp ? start * pow(end, (double)i / (double)ramp) : 0;
    thr_status st = thr_simulated_step(simulated, err);
    if (st != THR_OK) return st;
    if (i % every != 0) continue;

    /* Look THR_LOOKS times within the time in which a fall is judged. */
    const double moved = thr_simulated_moved_lately(simulated, i / every - 1, &bead);
    if (moved < BEGUN * MOVED) stood = simulated->pull;
    if (moved < MOVED) continue;

    /* The fall began between the last look without a movement and this one. */
    out->status = THR_SETTLE_FELL;
    out->fall = (stood + simulated->pull) / 2;
    out->error = stood - simulated->pull; /* it began before it could be seen to */
    out->first_bead = bead;
    return THR_OK;
  }

  return THR_OK;
}

/* Simulates a little further, with cords from hole to hole, for the picture of the fall. */
static thr_status fall(thr_simulated *simulated, thr_err *err)
{
  int bead;
  simulated->leans = true;

  for (long i = 0; i < thr_simulated_steps(simulated, AFTER_TIME) &&
                   thr_simulated_most_moved(simulated, &bead) < AFTER_MOVED;
       i++) {
    thr_status st = thr_simulated_step(simulated, err);
    if (st != THR_OK) return st;
  }

  return THR_OK;
}

/* Simulates the whole protocol once, in a fresh world whose iterations are the options' times
 * out->effort. */
static thr_status attempt(thr_simulated *simulated, const thr_settle_options *options, double start,
                          thr_settle *out, thr_err *err)
{
  const double end = end_of(options, start), rest = options->least > 0 ? 0 : REST_TIME;
  const thr_simulated_options world = {options->time_step, options->iterations * out->effort,
                                       options->seed};
  thr_status st = thr_simulated_build(simulated, &world, err);
  if (st != THR_OK) return st;

  /* The most steps that the protocol may take, for the progress. */
  simulated->all =
      thr_simulated_steps(simulated, SETTLE_TIME + time_to_fall(end) + rest + AFTER_TIME);
  simulated->pull = start;

  /* Each stage follows only if the one before leaves something to show. */
  st = settle(simulated, out, err);
  if (st == THR_OK && out->status == THR_SETTLE_HELD)
    st = let_off(simulated, start, end, rest, out, err);
  if (st == THR_OK && out->status != THR_SETTLE_HELD) st = fall(simulated, err);

  /* The picture of where the beads ended. */
  out->gap_after = 1e3 * simulated->unit * thr_simulated_widest_gap(simulated);
  thr_simulated_take_poses(simulated, out->after);

  return st;
}

/* Returns whether the result decides anything. */
static bool counts(const thr_settle *result)
{
  return result->status == THR_SETTLE_FELL || result->status == THR_SETTLE_HELD;
}

/* Repeats the protocol with more effort until the result decides. */
static thr_status run(thr_simulated *simulated, const thr_settle_options *options, double start,
                      thr_settle *out, thr_err *err)
{
  thr_status st = THR_OK;
  out->status = THR_SETTLE_NEVER_SETTLED;
  out->effort = 1;

  /* Results are judged against what limit analysis proves. */
  for (int i = 0; st == THR_OK && i < ATTEMPTS && !counts(out); i++) {
    if (i > 0) out->effort *= MORE;
    out->fall = out->error = 0;
    st = attempt(simulated, options, start, out, err);
    if (st == THR_OK) thr_settle_judge(out, options->least, options->equilibrium);
  }

  return st;
}

/* Checks the options. */
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

/* Judges a result by the proved pulls; see beads.h. */
void thr_settle_judge(thr_settle *result, double least, double equilibrium)
{
  /* It must fall below the proved pull. */
  if (result->status == THR_SETTLE_HELD && least > 0) result->status = THR_SETTLE_LATE;
  if (result->status != THR_SETTLE_FELL) return;

  /* Not known well enough, or above a pull that holds: something crept. */
  if (result->fall > (1 + ACCURACY) * equilibrium ||
      (least > 0 && result->error > ACCURACY * result->fall))
    result->status = THR_SETTLE_CREPT;
  else if (result->fall < (1 - ACCURACY) * least)
    result->status = THR_SETTLE_LATE;
}

/* Returns the pull at which the structure settles. */
static double start_of(const thr_settle_options *options)
{
  /* A factor above what is known to hold, or, if nothing is, above what is proved to fall. */
  if (options->start > 0 || isnan(options->start)) return options->start;
  return START * (isfinite(options->equilibrium) ? options->equilibrium : options->least);
}

/* Simulates the fall; see beads.h. */
thr_status thr_settle_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord,
                          int n_cords, const double *const *tension, const double *const *most,
                          const thr_physics *physics, const thr_settle_options *options,
                          const thr_limits *limits, thr_settle *out, thr_err *err)
{
  const double start = start_of(options);
  *out = (thr_settle){0};

  /* Options out of range are an error; that a structure is too large is an answer. */
  thr_status st = check(options, start, err);
  if (st != THR_OK) return st;
  *out = (thr_settle){
      .present = true, .first_bead = -1, .n_beads = beads->n_beads, .status = THR_SETTLE_TOO_LARGE};
  if (beads->n_beads > thr_settle_largest(options->large)) return THR_OK;

  thr_simulated simulated = {.b = beads,
                             .f = frame,
                             .physics = physics,
                             .limits = limits,
                             .cord = cord,
                             .n_cords = n_cords,
                             .tension = tension,
                             .most = most};

  /* The poses before and after, and the attempts. */
  out->before = thr_calloc((size_t)beads->n_beads, sizeof *out->before);
  out->after = thr_calloc((size_t)beads->n_beads, sizeof *out->after);
  st = out->before && out->after ? thr_simulated_begin(&simulated, err) : thr_nomem(err);
  if (st == THR_OK) st = run(&simulated, options, start, out, err);
  thr_simulated_end(&simulated);
  if (st != THR_OK) thr_settle_destroy(out);

  return st;
}

/* Frees the poses. */
void thr_settle_destroy(thr_settle *result)
{
  if (!result) return;
  free(result->before);
  free(result->after);
  *result = (thr_settle){0};
}
