/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulates how the structure comes up: the same beads and cords as in settle.c, sunk down under
 * slack cords, then drawn in.
 *
 * A heap under tight cords does not rise by itself: faces that lean on each other's edges lock. A
 * counterweight over every bead (thesis, Fig. 25) that carries a part of its weight lets the cords
 * close the gaps. The least of five parts that suffices is found by trying. Cords lead from hole to
 * hole and have the tensions of being drawn in; beads without feet come to lie on the ground, too.
 *
 * This is a picture of one way up, not a proof: friction, damping and the way down are the
 * simulation's.
 *
 * Example: the 7 x 7 dome of straight cords needs three quarters of its weight carried. */
#include "eval/structure/blocks.h"
#include "graph/plan/evaluation.h"

#include <math.h>
#include <stdlib.h>

/* The protocol. Times are in the unit of the simulation, sqrt(mean edge / gravity). */
static const double ROUGH = 0.5;    /* of the usual iterations: enough for a picture */
static const double SLACK = 0.1;    /* of the pull: what slack cords still have */
static const double SUNK = 0.2;     /* edges: it sinks until a bead has moved so far .. */
static const double SINK_TIME = 6;  /* .. or for so long */
static const double DRAW_TIME = 12; /* for the pull to grow from slack to MOST */
static const double MOST = 2;       /* times the pull */
static const double REST_TIME = 3;
static const double ALONE_TIME = 3;  /* for the counterweight to go */
static const double DAMPING = 0.9;   /* of the velocity, per unit of time */
static const double UP_GAP = 0.02;   /* edges: the structure is up if no face opens wider .. */
static const double UP_HEIGHT = 0.9; /* .. and so much of the drawn height is there */
static const double PART[] = {0, 0.25, 0.5, 0.75, 1};
enum { PARTS = sizeof PART / sizeof *PART };

/* Returns the height of the highest node, m; the underside of the lowest foot is at 0. */
static double height_of(const double (*pose)[7], int n)
{
  double most = 0;
  for (int v = 0; v < n; v++)
    most = fmax(most, pose[v][2]);
  return most;
}

/* Records still i of the simulation: poses, pull, counterweight, height and gaps. */
static void take_still(const thr_simulated *simulated, int i, thr_erect *out)
{
  double(*pose)[7] = out->pose + i * simulated->b->n_beads;
  thr_simulated_take_poses(simulated, pose);
  out->still[i] =
      (thr_erect_still){.pull = simulated->pull,
                        .lift = simulated->lift,
                        .height = 1e3 * height_of((const double(*)[7])pose, simulated->b->n_beads),
                        .gap = 1e3 * simulated->unit * thr_simulated_widest_gap(simulated),
                        .closed = thr_simulated_closed(simulated, THR_SEATED)};
}

/* Simulates for a time at the same pull. */
static thr_status rest(thr_simulated *simulated, double time, thr_err *err)
{
  thr_status st = THR_OK;
  for (long i = thr_simulated_steps(simulated, time); i > 0 && !st; i--)
    st = thr_simulated_step(simulated, err);
  return st;
}

/* Lets the structure sink under slack cords, until a bead has moved by SUNK or the time is over. */
static thr_status sink(thr_simulated *simulated, double pull, thr_err *err)
{
  int bead;
  thr_status st = THR_OK;

  /* Slack cords still have some tension. */
  simulated->pull = SLACK * pull;
  for (long i = thr_simulated_steps(simulated, SINK_TIME);
       i > 0 && !st && thr_simulated_most_moved(simulated, &bead) < SUNK; i--)
    st = thr_simulated_step(simulated, err);

  return st;
}

/* Draws the cords in, linearly in time, with a still at half the pull and at the pull. */
static thr_status draw_in(thr_simulated *simulated, double pull, thr_erect *out, thr_err *err)
{
  static const double at[] = {0.5, 1, 2};
  const long steps = thr_simulated_steps(simulated, DRAW_TIME);
  int next = 0;
  thr_status st = THR_OK;

  /* The pull grows; a still when it passes the next of the marks. */
  for (long i = 1; i <= steps && !st; i++) {
    simulated->pull = pull * (SLACK + (MOST - SLACK) * (double)i / (double)steps);
    st = thr_simulated_step(simulated, err);
    if (i < steps && simulated->pull >= at[next] * pull) take_still(simulated, ++next, out);
  }

  return st;
}

/* Takes the counterweight away bit by bit. */
static thr_status let_alone(thr_simulated *simulated, double lift, thr_err *err)
{
  const long steps = thr_simulated_steps(simulated, ALONE_TIME);
  thr_status st = THR_OK;

  for (long i = 1; i <= steps && !st; i++) {
    simulated->lift = lift * (double)(steps - i) / (double)steps;
    st = thr_simulated_step(simulated, err);
  }

  return st;
}

/* Simulates one erection with a part `lift` of the weights carried, in a fresh world. */
static thr_status attempt(thr_simulated *simulated, const thr_erect_options *options, double lift,
                          thr_erect *out, thr_err *err)
{
  const thr_simulated_options world = {options->time_step, ROUGH * options->iterations,
                                       options->seed};
  thr_status st = thr_simulated_build(simulated, &world, err);
  if (st) return st;

  /* The most steps of all parts together, for the progress. */
  simulated->all =
      PARTS * thr_simulated_steps(simulated, SINK_TIME + DRAW_TIME + ALONE_TIME + 2 * REST_TIME);
  simulated->leans = true;
  thr_simulated_damp(simulated, DAMPING);

  /* Sink, and hang the counterweight on. */
  st = sink(simulated, options->pull, err);
  if (!st) take_still(simulated, 0, out);
  simulated->lift = lift;

  /* Draw in, and rest. */
  if (!st) st = draw_in(simulated, options->pull, out, err);
  if (!st) st = rest(simulated, REST_TIME, err);
  if (!st) take_still(simulated, 3, out);

  /* Take the counterweight away, and rest. */
  if (!st) st = let_alone(simulated, lift, err);
  if (!st) take_still(simulated, 4, out);
  if (!st) st = rest(simulated, REST_TIME, err);
  if (!st) take_still(simulated, 5, out);

  return st;
}

/* Returns whether the structure is up: closed and high enough, in the last still. */
static bool is_up(const thr_simulated *simulated, const thr_erect *result)
{
  const thr_erect_still *last = &result->still[THR_ERECT_STILLS - 1];
  return last->gap < UP_GAP * 1e3 * simulated->unit && last->height > UP_HEIGHT * result->drawn;
}

/* Finds the least counterweight; see beads.h. */
thr_status thr_erect_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord,
                         int n_cords, const double *const *tension, const thr_physics *physics,
                         const thr_erect_options *options, const thr_limits *limits, thr_erect *out,
                         thr_err *err)
{
  *out = (thr_erect){.lift = NAN};

  /* No counterweight makes up for cords that draw nothing. */
  if (!(options->pull > 0 && options->pull <= 1e12))
    return thr_fail(err, THR_EINPUT,
                    "structure: a pull of %g N draws nothing up: give more than 0 and at most 1e12",
                    options->pull);

  /* Larger structures are not simulated. */
  if (beads->n_beads > thr_settle_largest(false)) return THR_OK;

  thr_simulated simulated = {.b = beads,
                             .f = frame,
                             .physics = physics,
                             .limits = limits,
                             .cord = cord,
                             .n_cords = n_cords,
                             .tension = tension};

  /* The same for all parts: sizes, weight, and the drawn height in mm. */
  out->present = true;
  out->n_beads = beads->n_beads;
  out->n_gaps = beads->n_faces;
  out->weight = thr_beads_weight(beads, physics);

  for (int v = 0; v < beads->n_beads; v++)
    out->drawn = fmax(out->drawn, 1e3 * beads->centre[v][2]);

  /* The parts in rising order, until one suffices. */
  out->pose = thr_calloc(THR_ERECT_STILLS * (size_t)beads->n_beads, sizeof *out->pose);
  thr_status st = out->pose ? thr_simulated_begin(&simulated, err) : thr_nomem(err);

  for (int i = 0; i < PARTS && !st && isnan(out->lift); i++) {
    st = attempt(&simulated, options, PART[i], out, err);
    if (!st && is_up(&simulated, out)) out->lift = PART[i];
  }

  thr_simulated_end(&simulated);

  if (st) thr_erect_destroy(out);
  return st;
}

/* Frees the poses. */
void thr_erect_destroy(thr_erect *erect)
{
  if (!erect) return;
  free(erect->pose);
  *erect = (thr_erect){0};
}
