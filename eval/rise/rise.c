/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets time pass over pieces and cords, and writes down what is seen (rise.h).
 *
 * In every step the cords are looked at first: where their passes lead, by what angles they turn,
 * and so what tension friction leaves them (cable.h); then Bullet moves the pieces. A pass pulls
 * its two mouths together with its tension, but closes its gap no faster than in CLOSING s, as a
 * hand would; and it holds against being opened with what friction adds. */
#include "eval/rise/cable.h"
#include "eval/rise/loose.h"
#include "eval/rise/rise.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TIME_STEP = 5e-4; /* s, for edges of ..  */
static const double TIME_EDGE = 40;   /* .. so many mm */
static const double CLOSING = 0.02;   /* s that a gap takes to close at least, in such steps */
static const double FASTEST = 2.5;    /* edges in such a second, of a gap that closes */
static const double UNCUT = 1e6;      /* in the world's units: more than any cord takes */
static const double SLOWEST = 2.5e-3; /* .. of one that is closed: so that the cord still pulls */
static const double GENTLE = 0.02;    /* of the weight, that hands begin to pull with */
static const double UP = 0.36;        /* s in which hands pull e times as much */
static const double DOWN = 1;         /* s in which they let down by a factor e .. */
static const double NOTHING = 1e-3;   /* .. to so much of the pull */
static const double FRAME = 0.05;     /* s between frames */
static const double HOLD = 1;         /* s */
enum { FRAMES_AFTER = 20 };           /* that are seen of a fall */
static const double SETTLING = 0.5;   /* s before hands pull, so that what is dropped lies */
static const double CLOSED = 0.02;    /* of an edge: a gap that is no gap */
static const double STRAIGHT = 0.1;   /* rad between the axes of closed faces */
static const double FALLEN = 0.9;     /* of the height: what is lower has fallen */
static const double QUIET = 0.5; /* s that all faces are closed before hands stop pulling more */

static const char *const start_names[] = {"flat", "heap", "shape"};

const char *thr_rise_start_name(int start)
{
  return start >= 0 && start < THR_RISE_N_STARTS ? start_names[start] : NULL;
}

/* A pass of a cord as it is now. */
typedef struct {
  int cord; /* in the world */
  double direction[3];
  double gap;                     /* between the mouths along the cord, in the world's units */
  double first_gap;               /* at the start */
  double in_axis[3], out_axis[3]; /* of the mouth that it leaves and the one that it enters */
} rise_pass;

typedef struct {
  const thr_rise_structure *structure;
  const thr_rise_options *options;
  thr_rise_bodies bodies;
  thr_cable *cable; /* [n_cords] */
  rise_pass *pass;  /* [n_passes] cord after cord */
  int n_passes;
  thr_friction friction;
  double dt, scale; /* s; and how much slower than with edges of TIME_EDGE everything is */
  double mu;
  thr_scratch own;
} rise_run;

/* ---- the cords ---- */

/* Gives every cord its arrays, and its passes their places in the world. */
static thr_status make_cords(rise_run *run, thr_err *err)
{
  const thr_rise_structure *structure = run->structure;
  const double depth = structure->mouth_depth;
  thr_status st = THR_OK;
  rise_pass *pass = run->pass;

  for (int c = 0; c < structure->n_cords && !st; c++) {
    const thr_rise_cord *cord = &structure->cord[c];
    thr_cable *cable = &run->cable[c];
    const size_t n = (size_t)cord->n_passes;
    *cable = (thr_cable){.n = cord->n_passes,
                         .pulled = {cord->pulled[0], cord->pulled[1]},
                         .exponent = thr_scratch_array(&run->own, n, sizeof(double)),
                         .tension = thr_scratch_array(&run->own, n, sizeof(double)),
                         .low = thr_scratch_array(&run->own, n, sizeof(double)),
                         .high = thr_scratch_array(&run->own, n, sizeof(double)),
                         .sum = thr_scratch_array(&run->own, n, sizeof(double))};
    st = thr_scratch_check(&run->own, err);

    for (int k = 0; k < cord->n_passes && !st; k++, pass++) {
      const int from = cord->piece[k], to = cord->piece[k + 1];
      double start[3], end[3];
      for (int i = 0; i < 3; i++) {
        const thr_rise_piece *one = &structure->piece[from], *other = &structure->piece[to];
        start[i] =
            (cord->mouth[k][i] - depth * cord->along[k][i] - one->centre[i] - one->mass_centre[i]) /
            run->bodies.length;
        end[i] = (cord->mouth[k][i] + depth * cord->along[k][i] - other->centre[i] -
                  other->mass_centre[i]) /
                 run->bodies.length;
      }
      st = thr_world_add_cord(run->bodies.world, run->bodies.body[from], start,
                              run->bodies.body[to], end, &pass->cord, err);
    }
  }
  return st;
}

/* Looks where pass k of a cord leads now. */
static void look_at(const rise_run *run, const thr_rise_cord *cord, int k, rise_pass *pass)
{
  const int from = cord->piece[k], to = cord->piece[k + 1];
  const double depth = run->structure->mouth_depth;
  const thr_rise_piece *one = &run->structure->piece[from], *other = &run->structure->piece[to];
  double inside[2][3], start[3], end[3];

  for (int i = 0; i < 3; i++) {
    inside[0][i] = cord->mouth[k][i] - depth * cord->along[k][i] - one->centre[i];
    inside[1][i] = cord->mouth[k][i] + depth * cord->along[k][i] - other->centre[i];
  }
  thr_rise_carried(&run->bodies, from, inside[0], start);
  thr_rise_carried(&run->bodies, to, inside[1], end);
  thr_rise_turned(&run->bodies, from, cord->along[k], pass->in_axis);
  thr_rise_turned(&run->bodies, to, cord->along[k], pass->out_axis);

  for (int i = 0; i < 3; i++)
    pass->direction[i] = end[i] - start[i];
  pass->gap = thr_normalize(pass->direction) - 2 * depth / run->bodies.length;
  if (thr_dot(pass->direction, pass->direction) == 0)
    memcpy(pass->direction, pass->in_axis, sizeof pass->direction);
}

/* Looks at all passes, and works out the friction of every turn. */
static void look_at_cords(rise_run *run)
{
  rise_pass *pass = run->pass;
  thr_rise_look(&run->bodies);

  for (int c = 0; c < run->structure->n_cords; c++) {
    const thr_rise_cord *cord = &run->structure->cord[c];
    for (int k = 0; k < cord->n_passes; k++, pass++) {
      const double before = pass->gap;
      look_at(run, cord, k, pass);
      thr_cable_felt(&run->cable[c], k, 0,
                     before - pass->gap >
                         SLOWEST * run->bodies.edge / run->bodies.length * run->dt / run->scale);
      if (k == 0) continue;

      /* Into the channel, through it, and out of it. */
      const double angle = thr_angle_between(pass[-1].direction, pass[-1].out_axis) +
                           thr_angle_between(cord->along[k - 1], cord->along[k]) +
                           thr_angle_between(pass->in_axis, pass->direction);
      run->cable[c].exponent[k - 1] = run->mu * angle + (cord->wobble ? cord->wobble[k - 1] : 0);
    }
  }
}

/* Sets what the cords do in the next step while hands pull with `pull` N. */
static void pull_cords(rise_run *run, double pull)
{
  const double force[2] = {pull, pull};
  const double edge = run->bodies.edge / run->bodies.length;
  rise_pass *pass = run->pass;

  for (int c = 0; c < run->structure->n_cords; c++) {
    thr_cable *cable = &run->cable[c];
    thr_cable_pull(cable, force, &run->friction);
    for (int k = 0; k < cable->n; k++, pass++) {
      /* What is dropped hangs on its cords, none of which gets longer. */
      const bool hangs =
          run->options->start == THR_RISE_HEAP && pull == 0 && pass->gap > pass->first_gap;
      const double speed =
          fmin(fmax(pass->gap / (CLOSING * run->scale), SLOWEST * edge / run->scale),
               FASTEST * edge / run->scale);
      thr_world_pull(run->bodies.world, pass->cord, cable->tension[k] / run->bodies.force, speed,
                     hangs ? UNCUT
                           : fmin(cable->high[k] - cable->tension[k], 1e6) / run->bodies.force);
    }
  }
}

/* Takes over what the cords held beyond their tension in the last step. */
static void feel_cords(rise_run *run)
{
  const rise_pass *pass = run->pass;
  for (int c = 0; c < run->structure->n_cords; c++)
    for (int k = 0; k < run->cable[c].n; k++, pass++)
      thr_cable_felt(&run->cable[c], k,
                     thr_world_cord_held(run->bodies.world, pass->cord) * run->bodies.force, false);
}

/* Have the faces of a pass met? */
static bool is_closed(const rise_run *run, const rise_pass *pass)
{
  return pass->gap < CLOSED * run->bodies.edge / run->bodies.length &&
         thr_angle_between(pass->in_axis, pass->out_axis) < STRAIGHT;
}

/* ---- what is seen ---- */

/* Where the node of a piece is, mm. */
static void node_of(const rise_run *run, int p, double at[3])
{
  thr_rise_carried(&run->bodies, p, (const double[3]){0, 0, 0}, at);
  for (int k = 0; k < 3; k++)
    at[k] *= run->bodies.length;
}

/* Fills a moment with what is to be seen now. */
static void see(const rise_run *run, double time, double pull, double lift, thr_rise_moment *moment)
{
  const double mm = run->bodies.length;
  *moment = (thr_rise_moment){.time = time, .pull = pull, .lift = lift};

  for (int i = 0; i < run->n_passes; i++) {
    const rise_pass *pass = &run->pass[i];
    moment->closed += is_closed(run, pass);
    moment->widest = fmax(moment->widest, pass->gap * mm);
    moment->drawn += (pass->first_gap - pass->gap) * mm;
  }
  for (int p = 0; p < run->structure->n_pieces; p++) {
    double at[3], linear[3], angular[3];
    node_of(run, p, at);
    thr_world_velocity(run->bodies.world, run->bodies.body[p], linear, angular);
    moment->height = fmax(moment->height, at[2]);
    moment->speed = fmax(moment->speed, mm * sqrt(thr_dot(linear, linear)));
  }
}

/* Makes room for another frame and fills it. */
static thr_status keep_frame(const rise_run *run, double time, double pull, double lift,
                             thr_rise_record *record, thr_err *err)
{
  const size_t n = (size_t)record->n_pieces, passes = (size_t)record->n_passes;
  if (record->n_frames == record->room) {
    const size_t room = record->room ? 2 * (size_t)record->room : 64;
    void *moment = thr_realloc(record->moment, room, sizeof *record->moment);
    if (moment) record->moment = moment;
    void *pose = thr_realloc(record->pose, room * n, sizeof *record->pose);
    if (pose) record->pose = pose;
    void *tension = thr_realloc(record->tension, room * passes, sizeof *record->tension);
    if (tension) record->tension = tension;
    if (!moment || !pose || !tension) return thr_nomem(err);
    record->room = (int)room;
  }

  see(run, time, pull, lift, &record->moment[record->n_frames]);
  double(*pose)[7] = record->pose + (size_t)record->n_frames * n;
  for (int p = 0; p < record->n_pieces; p++) {
    memcpy(pose[p], run->bodies.pose[p], sizeof *pose);
    node_of(run, p, pose[p]);
  }
  double *tension = record->tension + (size_t)record->n_frames * passes;
  for (int c = 0; c < run->structure->n_cords; c++)
    for (int k = 0; k < run->cable[c].n; k++)
      *tension++ = run->cable[c].tension[k];
  record->n_frames++;
  return THR_OK;
}

/* Measures how far the shape was from the drawn one when hands began to let down. */
static thr_status measure_off(const rise_run *run, thr_rise_record *record, thr_err *err)
{
  const int n = record->n_pieces;
  thr_scratch work = {0};
  double(*drawn)[3] = thr_scratch_array(&work, (size_t)n, sizeof *drawn);
  double(*last)[3] = thr_scratch_array(&work, (size_t)n, sizeof *last);
  thr_status st = thr_scratch_check(&work, err);
  for (int p = 0; p < n && !st; p++) {
    const size_t frame = (size_t)record->held - 1;
    memcpy(drawn[p], run->structure->piece[p].centre, sizeof *drawn);
    memcpy(last[p], record->pose[frame * (size_t)n + (size_t)p], sizeof *last);
  }
  if (!st)
    record->off =
        thr_fit_points((const double(*)[3])drawn, (const double(*)[3])last, n, NULL, NULL);
  thr_scratch_free(&work);
  return st;
}

/* ---- time passes ---- */

/* What a hand lifts with now, N. */
static double lift_now(const rise_run *run)
{
  const thr_rise_options *options = run->options;
  if (!(options->lift > 0)) return 0;
  double at[3];
  node_of(run, options->lifted, at);
  double low = INFINITY;
  for (int p = 0; p < run->structure->n_pieces; p++)
    low = fmin(low, run->structure->piece[p].centre[2]);

  /* A hand that only carries lets go of what is high enough, over a tenth of an edge. */
  const double above =
      run->structure->piece[options->lifted].centre[2] - low + run->structure->width / 2;
  const double missing = (above - at[2]) / (0.1 * run->bodies.edge);
  return options->carried ? options->lift * fmin(fmax(missing, 0), 1) : options->lift;
}

/* Takes one step. */
static thr_status take_step(rise_run *run, double pull, double *lift, thr_err *err)
{
  pull_cords(run, pull);
  *lift = lift_now(run);
  if (*lift > 0)
    thr_world_force(run->bodies.world, run->bodies.body[run->options->lifted],
                    (const double[3]){0, 0, *lift / run->bodies.force});
  thr_status st = thr_world_step(run->bodies.world, err);
  if (st) return st;
  feel_cords(run);
  look_at_cords(run);
  return THR_OK;
}

/* Counts closed passes, and finds the widest gap. */
static int count_closed(const rise_run *run, int *widest)
{
  int n = 0;
  *widest = 0;
  for (int i = 0; i < run->n_passes; i++) {
    n += is_closed(run, &run->pass[i]);
    if (run->pass[i].gap > run->pass[*widest].gap) *widest = i;
  }
  return n;
}

/* What hands do: wait until all lies, pull more until `full`, hold, and let down. Times in s. */
typedef struct {
  double settle, full, hold;
  double up, down;     /* in which the pull changes by a factor e */
  double gentle, most; /* N */
  double quiet, closed_since;
} rise_hands;

static double pull_at(const rise_hands *hands, double time)
{
  if (time < hands->settle) return 0;
  const double upward = fmin(time, hands->full) - hands->settle,
               downward = time - hands->full - hands->hold;
  const double pull = fmin(hands->gentle * exp(upward / hands->up), hands->most);
  return downward > 0 ? pull * exp(-downward / hands->down) : pull;
}

/* Hands stop pulling more once all faces have been closed for a while. */
static void watch(rise_hands *hands, double time, bool closed)
{
  if (!closed)
    hands->closed_since = INFINITY;
  else if (hands->closed_since == INFINITY)
    hands->closed_since = time;
  if (time < hands->full && time - hands->closed_since > hands->quiet) hands->full = time;
}

/* Reads off the record when the structure came up and when it fell. */
static void conclude(const rise_run *run, thr_rise_record *record)
{
  record->came_up = record->fell = -1;
  for (int i = record->held - 1; i >= 0 && record->moment[i].closed == run->n_passes; i--)
    record->came_up = i;
  for (int i = record->held; i < record->n_frames && record->fell < 0 && record->held > 0; i++)
    if (record->moment[i].height < FALLEN * record->moment[record->held - 1].height)
      record->fell = i;
}

/* Writes down what is seen, and tells how far the simulation is. all: s. */
static thr_status report(const rise_run *run, double time, double pull, double lift, double all,
                         bool held, const thr_limits *limits, thr_rise_record *record, thr_err *err)
{
  thr_status st = keep_frame(run, time, pull, lift, record, err);
  if (!st && held) record->held = record->n_frames;
  if (!st && limits && thr_limits_stop(limits))
    st = thr_fail(err, THR_ELIMIT, "rise: stopped before all was seen");
  if (!st && limits && limits->advance) {
    char words[64];
    snprintf(words, sizeof words, "%d of %d faces closed",
             record->moment[record->n_frames - 1].closed, run->n_passes);
    limits->advance(limits->user, words, fmin(time / all, 1));
  }
  return st;
}

/* Lets time pass: settling, pulling, holding, letting down. */
static thr_status let_pass(rise_run *run, const thr_limits *limits, thr_rise_record *record,
                           thr_err *err)
{
  const thr_rise_options *options = run->options;
  const double slower = run->scale * (options->slower > 0 ? options->slower : 1);
  rise_hands hands = {.settle = options->start == THR_RISE_SHAPE ? 0 : SETTLING * run->scale,
                      .hold = run->scale * (options->hold > 0 ? options->hold : HOLD),
                      .up = UP * slower,
                      .down = DOWN * slower,
                      .gentle = options->start == THR_RISE_SHAPE
                                    ? options->pull
                                    : fmin(GENTLE * record->weight, options->pull),
                      .most = options->pull,
                      .quiet = QUIET * run->scale,
                      .closed_since = INFINITY};
  hands.full = hands.settle + hands.up * log(hands.most / hands.gentle);
  const double down = options->let_down ? hands.down * log(1 / NOTHING) : 0,
               all = hands.full + hands.hold + down;
  const long per_frame = lround(fmax(record->between / run->dt, 1));
  double lift = 0, time = 0;
  thr_status st = THR_OK;

  for (long step = 0; !st && time <= hands.full + hands.hold + down; step++) {
    time = (double)step * run->dt;
    int widest;
    const int closed = count_closed(run, &widest);
    const double pull = pull_at(&hands, time);
    watch(&hands, time, closed == run->n_passes);
    if (closed > record->most_closed && time >= hands.settle) {
      record->most_closed = closed;
      record->loosest = widest;
    }

    if (step % per_frame == 0) {
      st = report(run, time, pull, lift, all, time <= hands.full + hands.hold, limits, record, err);
      conclude(run, record);
      if (record->fell >= 0 && record->n_frames - record->fell > FRAMES_AFTER) break;
    }
    if (!st) st = take_step(run, pull, &lift, err);
  }

  /* What was seen counts where time ran out, too. */
  thr_err ignored = {0};
  if (record->held) {
    const thr_status measured = measure_off(run, record, st ? &ignored : err);
    if (!st) st = measured;
  }
  return st;
}

/* Refuses what cannot be simulated. */
static thr_status check(const thr_rise_structure *structure, const thr_rise_options *options,
                        thr_err *err)
{
  if (!(options->pull > 0) || !isfinite(options->pull))
    return thr_fail(err, THR_EINPUT, "rise: hands pull with more than 0 N");
  if (!(structure->physics.gravity > 0))
    return thr_fail(err, THR_EINPUT,
                    "rise: without gravity nothing lies on the ground: give a gravity above 0");
  bool pulled = false;
  for (int c = 0; c < structure->n_cords; c++)
    pulled |= structure->cord[c].pulled[0] || structure->cord[c].pulled[1];
  if (!pulled) return thr_fail(err, THR_EINPUT, "rise: no cord has an end that is pulled");
  if (!(thr_rise_edge(structure) > 0))
    return thr_fail(err, THR_EINPUT, "rise: the cords join no two pieces at different places");
  for (int p = 0; p < structure->n_pieces; p++)
    if (!(structure->piece[p].mass > 0))
      return thr_fail(err, THR_EINPUT, "rise: piece %d weighs nothing", p);
  return THR_OK;
}

thr_status thr_rise_simulate(const thr_rise_structure *structure, const thr_rise_options *options,
                             const thr_limits *limits, thr_rise_record *record, thr_err *err)
{
  *record = (thr_rise_record){.n_pieces = structure->n_pieces, .came_up = -1, .fell = -1};
  thr_status st = check(structure, options, err);
  if (st) return st;

  rise_run run = {.structure = structure,
                  .options = options,
                  .mu = structure->physics.mu,
                  .friction = thr_friction_of(&structure->physics)};
  for (int c = 0; c < structure->n_cords; c++)
    run.n_passes += structure->cord[c].n_passes;
  record->n_passes = run.n_passes;
  run.cable = thr_scratch_array(&run.own, (size_t)structure->n_cords, sizeof *run.cable);
  run.pass = thr_scratch_array(&run.own, (size_t)run.n_passes, sizeof *run.pass);
  st = thr_scratch_check(&run.own, err);

  /* Everything takes longer where pieces are larger, as falling does. */
  double low = INFINITY, high = -INFINITY;
  run.scale = sqrt(thr_rise_edge(structure) / TIME_EDGE);
  run.dt = TIME_STEP * run.scale * (options->time_step > 0 ? options->time_step : 1);
  record->between = FRAME * run.scale;
  if (!st) st = thr_rise_bodies_make(&run.bodies, structure, options, run.dt, err);
  if (!st) st = make_cords(&run, err);
  for (int p = 0; p < structure->n_pieces && !st; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    if (!piece->held) record->weight += 1e-3 * piece->mass * structure->physics.gravity;
    low = fmin(low, piece->centre[2]);
    high = fmax(high, piece->centre[2]);
  }
  record->drawn_height = high - low;
  if (!st) {
    look_at_cords(&run);
    for (int i = 0; i < run.n_passes; i++)
      run.pass[i].first_gap = run.pass[i].gap;
    st = let_pass(&run, limits, record, err);
  }

  thr_rise_bodies_destroy(&run.bodies);
  thr_scratch_free(&run.own);
  return st;
}

void thr_rise_record_destroy(thr_rise_record *record)
{
  free(record->moment);
  free(record->pose);
  free(record->tension);
  *record = (thr_rise_record){0};
}
