/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the structure comes up: the same beads and cords as in settle.c, sunk down under slack cords,
 * then drawn in.
 *
 * A heap under tight cords does not rise by itself: faces that lean on each other's edges lock. A
 * counterweight over every bead (the thesis's Fig. 25) that carries a part of its weight lets the
 * cords close the gaps. The least of five parts that does is found by trying. Cords lead from hole
 * to hole and have the tensions of being drawn in; beads without feet come to lie on the ground,
 * too.
 *
 * This is a picture of one way up, not a proof: friction, damping and the way down are the
 * simulation's. */
#include "eval/structure/blocks.h"
#include "graph/plan/evaluation.h"

#include <math.h>
#include <stdlib.h>

static const double ROUGH = 0.5;    /* of the usual iterations: enough for a picture */
static const double SLACK = 0.1;    /* of the pull: what slack cords still have */
static const double SUNK = 0.2;     /* edges: it sinks until a bead has moved so far .. */
static const double SINK_TIME = 6;  /* .. or for so long */
static const double DRAW_TIME = 12; /* for the pull to grow from slack to MOST */
static const double MOST = 2;       /* times the pull */
static const double REST_TIME = 3;
static const double ALONE_TIME = 3; /* for the counterweight to go */
static const double DAMPING = 0.9;  /* of the velocity, per unit of time */
static const double UP_GAP = 0.02, UP_HEIGHT = 0.9;
static const double PART[] = {0, 0.25, 0.5, 0.75, 1};
enum { PARTS = sizeof PART / sizeof *PART };

/* Of the highest node, m; the underside of the lowest foot is at 0. */
static double height_of(const double (*pose)[7], int n)
{
  double most = 0;
  for (int v = 0; v < n; v++)
    most = fmax(most, pose[v][2]);
  return most;
}

static void take_still(const thr_simulated *m, int i, thr_erect *out)
{
  double(*pose)[7] = out->pose + i * m->b->n_beads;
  thr_simulated_take_poses(m, pose);
  out->still[i] =
      (thr_erect_still){.pull = m->pull,
                        .lift = m->lift,
                        .height = 1e3 * height_of((const double(*)[7])pose, m->b->n_beads),
                        .gap = 1e3 * m->unit * thr_simulated_widest_gap(m),
                        .closed = thr_simulated_closed(m, THR_SEATED)};
}

static thr_status rest(thr_simulated *m, double time, thr_err *err)
{
  thr_status s = THR_OK;
  for (long i = thr_simulated_steps(m, time); i > 0 && !s; i--)
    s = thr_simulated_step(m, err);
  return s;
}

static thr_status sink(thr_simulated *m, double pull, thr_err *err)
{
  int bead;
  thr_status s = THR_OK;
  m->pull = SLACK * pull;
  for (long i = thr_simulated_steps(m, SINK_TIME);
       i > 0 && !s && thr_simulated_most_moved(m, &bead) < SUNK; i--)
    s = thr_simulated_step(m, err);
  return s;
}

/* With a still at half the pull, at it, and at the most. */
static thr_status draw_in(thr_simulated *m, double pull, thr_erect *out, thr_err *err)
{
  static const double at[] = {0.5, 1, 2};
  const long steps = thr_simulated_steps(m, DRAW_TIME);
  int next = 0;
  thr_status s = THR_OK;
  for (long i = 1; i <= steps && !s; i++) {
    m->pull = pull * (SLACK + (MOST - SLACK) * (double)i / (double)steps);
    s = thr_simulated_step(m, err);
    if (i < steps && m->pull >= at[next] * pull) take_still(m, ++next, out);
  }
  return s;
}

/* The counterweight goes bit by bit. */
static thr_status let_alone(thr_simulated *m, double lift, thr_err *err)
{
  const long steps = thr_simulated_steps(m, ALONE_TIME);
  thr_status s = THR_OK;
  for (long i = 1; i <= steps && !s; i++) {
    m->lift = lift * (double)(steps - i) / (double)steps;
    s = thr_simulated_step(m, err);
  }
  return s;
}

static thr_status attempt(thr_simulated *m, const thr_erect_options *options, double lift,
                          thr_erect *out, thr_err *err)
{
  const thr_simulated_options world = {options->time_step, ROUGH * options->iterations,
                                       options->seed};
  thr_status s = thr_simulated_build(m, &world, err);
  if (s) return s;
  m->all = PARTS * thr_simulated_steps(m, SINK_TIME + DRAW_TIME + ALONE_TIME + 2 * REST_TIME);
  m->leans = true;
  thr_simulated_damp(m, DAMPING);
  s = sink(m, options->pull, err);
  if (!s) take_still(m, 0, out);
  m->lift = lift;
  if (!s) s = draw_in(m, options->pull, out, err);
  if (!s) s = rest(m, REST_TIME, err);
  if (!s) take_still(m, 3, out);
  if (!s) s = let_alone(m, lift, err);
  if (!s) take_still(m, 4, out);
  if (!s) s = rest(m, REST_TIME, err);
  if (!s) take_still(m, 5, out);
  return s;
}

static bool is_up(const thr_simulated *m, const thr_erect *e)
{
  const thr_erect_still *last = &e->still[THR_ERECT_STILLS - 1];
  return last->gap < UP_GAP * 1e3 * m->unit && last->height > UP_HEIGHT * e->drawn;
}

thr_status thr_erect_run(const thr_beads *beads, const thr_frame *frame, const thr_cord *cord,
                         int n_cords, const double *const *tension, const thr_physics *physics,
                         const thr_erect_options *options, const thr_limits *limits, thr_erect *out,
                         thr_err *err)
{
  *out = (thr_erect){.lift = NAN};
  if (!(options->pull > 0 && options->pull <= 1e12))
    return thr_fail(err, THR_EINPUT,
                    "structure: a pull of %g N draws nothing up: give more than 0 and at most 1e12",
                    options->pull);
  if (beads->n_beads > thr_settle_largest(false)) return THR_OK;
  thr_simulated m = {.b = beads,
                     .f = frame,
                     .physics = physics,
                     .limits = limits,
                     .cord = cord,
                     .n_cords = n_cords,
                     .tension = tension};
  out->present = true;
  out->n_beads = beads->n_beads;
  out->n_gaps = beads->n_faces;
  out->weight = thr_beads_weight(beads, physics);
  for (int v = 0; v < beads->n_beads; v++)
    out->drawn = fmax(out->drawn, 1e3 * beads->centre[v][2]);
  out->pose = thr_calloc(THR_ERECT_STILLS * (size_t)beads->n_beads, sizeof *out->pose);
  thr_status s = out->pose ? thr_simulated_begin(&m, err) : thr_nomem(err);
  for (int i = 0; i < PARTS && !s && isnan(out->lift); i++) {
    s = attempt(&m, options, PART[i], out, err);
    if (!s && is_up(&m, out)) out->lift = PART[i];
  }
  thr_simulated_end(&m);
  if (s) thr_erect_destroy(out);
  return s;
}

void thr_erect_destroy(thr_erect *erect)
{
  if (!erect) return;
  free(erect->pose);
  *erect = (thr_erect){0};
}
