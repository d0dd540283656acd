/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets time pass over pieces and cords, and writes down what is seen (rise.h).
 *
 * In every step the cords are looked at first: where their passes lead, by what angles they turn,
 * and so what tension friction leaves them (cable.h); then Bullet moves the pieces. A pass pulls
 * its two mouths together with its tension, but closes its gap no faster than in CLOSING s, as a
 * hand would; and it holds against being opened with what friction adds. */
#include "eval/rise/hands.h"
#include "eval/rise/loose.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TIME_STEP = 5e-4; /* s, for edges of ..  */
static const double TIME_EDGE = 40;   /* .. so many mm */
static const double CLOSING = 0.02;   /* s that a gap takes to close at least, in such steps */
static const double FASTEST = 2.5;    /* edges in such a second, of a gap that closes */
static const double SLOWEST = 2.5e-3; /* .. of one that is closed: so that the cord still pulls */
static const double FRAME = 0.05;     /* s between frames */
static const double DEEP = 1e4; /* edges under the ground, that feet which stay down are tied to */
static const double ANY = 1e6;  /* N: whatever pulls */
enum { FRAMES_AFTER = 20 };     /* that are seen of a fall */
static const double CLOSED = 0.02;        /* of an edge: a gap that is no gap */
static const double STRAIGHT = 0.1;       /* rad between the axes of closed faces */
static const double UPRIGHT = THR_PI / 6; /* rad that what stands on feet is tilted at most */
static const double FALLEN = 0.9;         /* of the height: what is lower has fallen */
static const double DENT_FROM = 0.25, DENT_UNTIL = 0.5; /* of the hold, that a hand dents in */

static const char *const start_names[] = {"flat", "heap", "shape", "laid"};

const char *thr_rise_start_name(int start)
{
  return start >= 0 && start < THR_RISE_N_STARTS ? start_names[start] : NULL;
}

/* A pass of a cord as it is now. */
typedef struct {
  int cord;   /* in the world */
  bool slack; /* its faces do not count */
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
  thr_hands hands;
  double *drawn;           /* [n_cords] mm that each has given out since the start */
  rise_pass *pass;         /* [n_passes] cord after cord */
  int *tie;                /* [n_pieces] of a piece that stays down, the cord in the world; -1 */
  int n_passes, n_counted; /* .. of cords that are not slack */
  thr_friction friction;
  double pull;         /* N, of the hand that pulls hardest */
  double shaken_since; /* s; INFINITY: not yet */
  int beats;           /* of the shaking, that have begun .. */
  double way[3];       /* .. the last one in this direction, unit */
  uint64_t chance;     /* state of what draws these directions */
  double dt, scale;    /* s; and how much slower than with edges of TIME_EDGE everything is */
  double mu;
  thr_scratch own;
} rise_run;

/* ---- the cords ---- */

/* Fills in where pass k first touches the channels of its two pieces, mm from their nodes as drawn.
 */
static void inside_mouths(const thr_rise_structure *structure, const thr_rise_cord *cord, int k,
                          double start[3], double end[3])
{
  double at[2][3];
  for (int i = 0; i < 3; i++) {
    at[0][i] = cord->mouth[k][i] - structure->mouth_depth * cord->along[k][i];
    at[1][i] = cord->mouth[k][i] + structure->mouth_depth * cord->along[k][i];
  }
  thr_rise_drawn(structure, cord, cord->piece[k], at[0], start);
  thr_rise_drawn(structure, cord, cord->piece[k + 1], at[1], end);
}

/* Gives every cord its arrays, and its passes their places in the world. */
static thr_status make_cords(rise_run *run, thr_err *err)
{
  const thr_rise_structure *structure = run->structure;
  thr_status st = THR_OK;
  rise_pass *pass = run->pass;

  for (int c = 0; c < structure->n_cords && !st; c++) {
    const thr_rise_cord *cord = &structure->cord[c];
    thr_cable *cable = &run->cable[c];
    const size_t n = (size_t)cord->n_passes;
    double *length = thr_scratch_array(&run->own, n, sizeof *length);
    *cable = (thr_cable){.n = cord->n_passes,
                         .held = THR_NO_TURN,
                         .stiffness = structure->physics.stiffness,
                         .length = length,
                         .exponent = thr_scratch_array(&run->own, n, sizeof(double)),
                         .tension = thr_scratch_array(&run->own, n, sizeof(double)),
                         .low = thr_scratch_array(&run->own, n, sizeof(double)),
                         .high = thr_scratch_array(&run->own, n, sizeof(double)),
                         .sum = thr_scratch_array(&run->own, n, sizeof(double))};
    st = thr_scratch_check(&run->own, err);

    for (int k = 0; k < cord->n_passes && !st; k++, pass++) {
      const int from = cord->piece[k], to = cord->piece[k + 1];
      pass->slack = cord->slack;
      double start[3], end[3];
      length[k] = thr_distance(structure->piece[from].centre, structure->piece[to].centre);
      inside_mouths(structure, cord, k, start, end);
      for (int i = 0; i < 3; i++) {
        start[i] = (start[i] - structure->piece[from].mass_centre[i]) / run->bodies.length;
        end[i] = (end[i] - structure->piece[to].mass_centre[i]) / run->bodies.length;
      }
      st = thr_world_add_cord(run->bodies.world, run->bodies.body[from], start,
                              run->bodies.body[to], end, &pass->cord, err);
    }
  }
  return st;
}

/* Ties the feet that stay down to places far below, so that they can slide, but not rise. */
static thr_status tie_down(rise_run *run, thr_err *err)
{
  const thr_rise_structure *structure = run->structure;
  const double deep = DEEP * run->bodies.edge / run->bodies.length;
  thr_status st = THR_OK;
  for (int p = 0; p < structure->n_pieces && !st; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    double at[3], node[3];
    run->tie[p] = -1;
    if (!piece->down || piece->held) continue;
    thr_rise_carried(&run->bodies, p, (const double[3]){0, 0, 0}, at);
    for (int k = 0; k < 3; k++)
      node[k] = -piece->mass_centre[k] / run->bodies.length;
    st = thr_world_add_cord(run->bodies.world, run->bodies.ground,
                            (const double[3]){at[0], at[1], -deep}, run->bodies.body[p], node,
                            &run->tie[p], err);
  }
  return st;
}

/* Looks where pass k of a cord leads now. */
static void look_at(const rise_run *run, const thr_rise_cord *cord, int k, rise_pass *pass)
{
  const int from = cord->piece[k], to = cord->piece[k + 1];
  const double depth = run->structure->mouth_depth;
  double inside[2][3], axis[2][3], start[3], end[3];

  inside_mouths(run->structure, cord, k, inside[0], inside[1]);
  thr_rise_drawn_turn(cord, from, cord->along[k], axis[0]);
  thr_rise_drawn_turn(cord, to, cord->along[k], axis[1]);
  thr_rise_carried(&run->bodies, from, inside[0], start);
  thr_rise_carried(&run->bodies, to, inside[1], end);
  thr_rise_turned(&run->bodies, from, axis[0], pass->in_axis);
  thr_rise_turned(&run->bodies, to, axis[1], pass->out_axis);

  thr_between(start, end, pass->direction);
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
    run->drawn[c] = 0;
    for (int k = 0; k < cord->n_passes; k++, pass++) {
      const double before = pass->gap;
      look_at(run, cord, k, pass);
      run->drawn[c] += (pass->first_gap - pass->gap) * run->bodies.length;
      if (run->cable[c].stiffness > 0)
        thr_cable_opened(&run->cable[c], k, (pass->gap - before) * run->bodies.length);
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

/* Sets what the cords do in the next step. */
static void pull_cords(rise_run *run)
{
  const thr_rise_bodies *bodies = &run->bodies;
  const double edge = bodies->edge / bodies->length;
  rise_pass *pass = run->pass;

  for (int c = 0; c < run->structure->n_cords; c++) {
    thr_cable *cable = &run->cable[c];
    if (run->structure->cord[c].slack) {
      for (int k = 0; k < cable->n; k++, pass++)
        thr_world_pull(run->bodies.world, pass->cord, 0, 0, 0, 0);
      continue;
    }
    thr_cable_pull(cable, &run->friction);
    for (int k = 0; k < cable->n; k++, pass++) {
      const double tension = fmax(cable->tension[k], 0);
      double speed = fmin(fmax(pass->gap / (CLOSING * run->scale), SLOWEST * edge / run->scale),
                          FASTEST * edge / run->scale),
             hold = fmin(cable->high[k] - tension, ANY), stiffness = 0;

      /* What stretches is a spring. Where no hand takes it up, it closes by no more than its
       * stretch, and holds unless it is slack. */
      if (cable->stiffness > 0) stiffness = cable->stiffness / cable->length[k];
      if (stiffness > 0 && !thr_cable_is_fed(cable, k)) {
        speed = fmin(speed, tension / stiffness / bodies->length / run->dt);
        hold = tension > 0 ? ANY : 0;
      }
      /* What is dropped hangs on its cords, none of which gets longer. */
      if (run->options->start == THR_RISE_HEAP && run->pull == 0 && pass->gap > pass->first_gap)
        hold = ANY;
      thr_world_pull(bodies->world, pass->cord, tension / bodies->force, speed,
                     hold / bodies->force, stiffness * bodies->length / bodies->force);
    }
  }
  for (int p = 0; p < run->structure->n_pieces; p++)
    if (run->tie[p] >= 0) thr_world_pull(bodies->world, run->tie[p], 0, 0, ANY / bodies->force, 0);
}

/* Takes over what the cords held beyond their tension in the last step. */
static void feel_cords(rise_run *run)
{
  const rise_pass *pass = run->pass;
  for (int c = 0; c < run->structure->n_cords; c++)
    for (int k = 0; k < run->cable[c].n; k++, pass++)
      if (!run->structure->cord[c].slack)
        thr_cable_felt(&run->cable[c], k,
                       thr_world_cord_held(run->bodies.world, pass->cord) * run->bodies.force,
                       false);
}

/* Have the faces of a pass met? */
static bool is_closed(const rise_run *run, const rise_pass *pass)
{
  return !pass->slack && pass->gap < CLOSED * run->bodies.edge / run->bodies.length &&
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

/* The speed of the fastest piece, mm/s. */
static double fastest(const rise_run *run)
{
  double most = 0;
  for (int p = 0; p < run->structure->n_pieces; p++) {
    double linear[3], angular[3];
    thr_world_velocity(run->bodies.world, run->bodies.body[p], linear, angular);
    most = fmax(most, run->bodies.length * sqrt(thr_dot(linear, linear)));
  }
  return most;
}

/* Fills a moment with what is to be seen now. */
static void see(const rise_run *run, double time, double pull, double lift, thr_rise_moment *moment)
{
  const double mm = run->bodies.length;
  *moment = (thr_rise_moment){.time = time, .pull = pull, .lift = lift, .speed = fastest(run)};

  for (int i = 0; i < run->n_passes; i++) {
    const rise_pass *pass = &run->pass[i];
    if (pass->slack) continue;
    moment->closed += is_closed(run, pass);
    moment->widest = fmax(moment->widest, pass->gap * mm);
    moment->drawn += (pass->first_gap - pass->gap) * mm;
  }
  for (int p = 0; p < run->structure->n_pieces; p++) {
    double at[3];
    node_of(run, p, at);
    moment->height = fmax(moment->height, at[2]);
  }
}

/* Where the cords that are pulled have the pieces in their shape; NULL: as drawn. */
static const double (*closed_places(const thr_rise_structure *structure))[7]
{
  for (int c = 0; c < structure->n_cords; c++)
    if (!structure->cord[c].slack) return structure->cord[c].place;
  return NULL;
}

/* Measures how far the shape is from that of the cords in a frame, mm, and how far up is tilted by
 * the best fit, rad; NULL: not asked for. */
static thr_status fit_shape(const rise_run *run, const thr_rise_record *record, int frame,
                            double *off, double *tilt, thr_err *err)
{
  double q[4];
  const int n = record->n_pieces;
  const double(*place)[7] = closed_places(run->structure);
  const double(*pose)[7] = (const double(*)[7])record->pose + (size_t)frame * (size_t)n;
  thr_scratch work = {0};
  double(*drawn)[3] = thr_scratch_array(&work, (size_t)n, sizeof *drawn);
  double(*last)[3] = thr_scratch_array(&work, (size_t)n, sizeof *last);
  thr_status st = thr_scratch_check(&work, err);
  for (int p = 0; p < n && !st; p++) {
    memcpy(drawn[p], place ? place[p] : run->structure->piece[p].centre, sizeof *drawn);
    memcpy(last[p], pose[p], sizeof *last);
  }
  if (!st) {
    const double most =
        thr_fit_points((const double(*)[3])drawn, (const double(*)[3])last, n, q, NULL);
    if (off) *off = most;
    if (tilt) *tilt = acos(fmax(-1, 1 - 2 * (q[0] * q[0] + q[1] * q[1])));
  }
  thr_scratch_free(&work);
  return st;
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
      *tension++ = fmax(run->cable[c].tension[k], 0);
  record->n_frames++;

  return run->structure->stands_up ? fit_shape(run, record, record->n_frames - 1, NULL,
                                               &record->moment[record->n_frames - 1].tilt, err)
                                   : THR_OK;
}

/* Measures the shape when hands began to let down, and how the faces were turned to each other. */
static thr_status measure_shape(const rise_run *run, thr_rise_record *record, thr_err *err)
{
  const int frame = record->held - 1;
  record->kink = thr_calloc((size_t)record->n_passes, sizeof *record->kink);
  record->twist = thr_calloc((size_t)record->n_passes, sizeof *record->twist);
  if (!record->kink || !record->twist) return thr_nomem(err);
  thr_rise_kinks(run->structure,
                 (const double(*)[7])record->pose + (size_t)frame * (size_t)record->n_pieces,
                 record->kink, record->twist);
  return fit_shape(run, record, frame, &record->off, NULL, err);
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

/* Pushes the dented piece with so many N towards the middle of the drawn nodes. Equal parts of the
 * counterforce act on all pieces, as by hands that hold the rest: nothing topples. */
static void push_in(const rise_run *run, double dent)
{
  const thr_rise_structure *structure = run->structure;
  const int dented = run->options->dented;
  double inward[3] = {0, 0, 0};
  for (int p = 0; p < structure->n_pieces; p++)
    for (int k = 0; k < 3; k++)
      inward[k] += (structure->piece[p].centre[k] - structure->piece[dented].centre[k]) /
                   structure->n_pieces;
  thr_normalize(inward);
  for (int p = 0; p < structure->n_pieces; p++) {
    const double share = (p == dented) - 1. / structure->n_pieces;
    double force[3];
    for (int k = 0; k < 3; k++)
      force[k] = share * dent / run->bodies.force * inward[k];
    thr_world_force(run->bodies.world, run->bodies.body[p], force);
  }
}

/* Shakes. In each beat of T = 1 / beat s the ground goes out by shake (1 - cos(2 pi t / T)) / 2 and
 * back. What is seen, is seen from there: pieces feel the acceleration the other way, as a weight.
 */
static void shake(rise_run *run, double time)
{
  const thr_rise_options *options = run->options;
  if (run->shaken_since == INFINITY && time >= run->hands.full) run->shaken_since = time;
  const double since = time - run->shaken_since;
  if (!(since >= 0 && since < options->shaken)) return;

  const double turn = 2 * THR_PI * options->beat, beat = floor(since * options->beat);
  for (; run->beats <= beat; run->beats++) {
    const double height = thr_random_disorder(&run->chance),
                 around = THR_PI * thr_random_disorder(&run->chance),
                 beside = sqrt(1 - height * height);
    memcpy(run->way, (const double[3]){beside * cos(around), beside * sin(around), height},
           sizeof run->way);
  }
  const double faster = 0.5 * options->shake * turn * turn * cos(turn * since); /* mm/s2 */
  for (int p = 0; p < run->structure->n_pieces; p++) {
    const double mass = run->structure->piece[p].mass / run->bodies.mass;
    double force[3];
    for (int k = 0; k < 3; k++)
      force[k] = -mass * faster / run->bodies.length * run->way[k];
    if (!run->structure->piece[p].held)
      thr_world_force(run->bodies.world, run->bodies.body[p], force);
  }
}

/* Takes one step. dent: N. */
static thr_status take_step(rise_run *run, double time, double dent, double *lift, thr_err *err)
{
  pull_cords(run);
  *lift = lift_now(run);
  if (*lift > 0)
    thr_world_force(run->bodies.world, run->bodies.body[run->options->lifted],
                    (const double[3]){0, 0, *lift / run->bodies.force});
  if (dent > 0) push_in(run, dent);
  if (run->options->shaken > 0) shake(run, time);
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
    if (run->pass[i].slack) continue;
    if (run->pass[*widest].slack || run->pass[i].gap > run->pass[*widest].gap) *widest = i;
  }
  return n;
}

/* Reads off the record when all faces closed, when the structure came up, and when it fell. */
static void conclude(const rise_run *run, thr_rise_record *record)
{
  record->closed = record->came_up = record->fell = -1;
  for (int i = record->held - 1; i >= 0 && record->moment[i].closed == run->n_counted; i--)
    record->closed = i;
  for (int i = record->held - 1; record->closed >= 0 && i >= record->closed; i--) {
    if (record->moment[i].tilt > UPRIGHT) break;
    record->came_up = i;
  }
  for (int i = record->held; i < record->n_frames && record->fell < 0 && record->held > 0; i++)
    if (record->moment[i].height < FALLEN * record->moment[record->held - 1].height)
      record->fell = i;
}

/* Reads off the record whether the structure stood when hands let down, or at the end. */
static void judge(const rise_run *run, thr_rise_record *record)
{
  const thr_rise_moment *last = &record->moment[record->held - 1];
  int first = 0;
  while (record->moment[first].closed < run->n_counted && first < record->held - 1)
    first++;
  record->stands = last->closed == run->n_counted && last->tilt <= UPRIGHT &&
                   last->height >= FALLEN * record->moment[first].height;
}

/* Writes down what is seen, and tells how far the simulation is. */
static thr_status report(const rise_run *run, double time, double pull, double lift, bool held,
                         const thr_limits *limits, thr_rise_record *record, thr_err *err)
{
  thr_status st = keep_frame(run, time, pull, lift, record, err);
  if (!st && held) {
    record->held = record->n_frames;
    for (int i = 0; i < run->n_passes; i++)
      record->open[i] = !run->pass[i].slack && !is_closed(run, &run->pass[i]);
  }
  if (!st && limits && thr_limits_stop(limits))
    st = thr_fail(err, THR_ELIMIT, "rise: stopped before all was seen");
  if (!st && limits && limits->advance) {
    char words[64];
    snprintf(words, sizeof words, "%d of %d faces closed",
             record->moment[record->n_frames - 1].closed, run->n_counted);
    limits->advance(limits->user, words, thr_hands_part(&run->hands, time));
  }
  return st;
}

/* Lets time pass: settling, pulling, holding, letting down. */
static thr_status let_pass(rise_run *run, const thr_limits *limits, thr_rise_record *record,
                           thr_err *err)
{
  const thr_rise_options *options = run->options;
  thr_hands *hands = &run->hands;
  const long per_frame = lround(fmax(record->between / run->dt, 1));
  double lift = 0, time = 0;
  thr_status st = THR_OK;

  for (long step = 0; !st && !thr_hands_are_done(hands, time); step++) {
    time = (double)step * run->dt;
    int widest;
    const int closed = count_closed(run, &widest);
    thr_hands_watch(hands, time, closed == run->n_counted,
                    run->options->schedule ? fastest(run) : 0);
    const double pull = run->pull = thr_hands_pull(hands, time, run->dt, run->drawn);
    if (closed > record->most_closed && time >= hands->settle) {
      record->most_closed = closed;
      record->loosest = widest;
    }

    if (step % per_frame == 0) {
      st = report(run, time, pull, lift, thr_hands_hold(hands, time), limits, record, err);
      conclude(run, record);
      if (record->fell >= 0 && record->n_frames - record->fell > FRAMES_AFTER) break;
    }

    const double part = (time - hands->full) / hands->hold;
    const bool dents = part >= DENT_FROM && part < DENT_UNTIL;
    if (step % per_frame == 0 && dents && options->dent > 0 && !st) {
      double off;
      st = fit_shape(run, record, record->n_frames - 1, &off, NULL, err);
      if (!st) record->dented = fmax(record->dented, off);
    }
    if (!st) st = take_step(run, time, dents ? options->dent : 0, &lift, err);
  }

  record->finished = !st;

  /* What was seen counts where time ran out, too. */
  thr_err ignored = {0};
  if (record->held) {
    judge(run, record);
    const thr_status measured = measure_shape(run, record, st ? &ignored : err);
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
  if (!(structure->physics.gravity > 0) && options->start != THR_RISE_SHAPE)
    return thr_fail(err, THR_EINPUT,
                    "rise: without gravity nothing lies on the ground: give a gravity above 0, or "
                    "let it begin in its shape");
  if (structure->physics.gravity < 0 || structure->physics.stiffness < 0)
    return thr_fail(err, THR_EINPUT, "rise: %s is below 0",
                    structure->physics.gravity < 0 ? "gravity" : "the stiffness of cords");
  if (options->shake < 0 || options->shaken < 0 || (options->shaken > 0 && !(options->beat > 0)))
    return thr_fail(err, THR_EINPUT,
                    "rise: what shakes goes to and fro by more than 0 mm, some "
                    "times a second, for some time");
  if (options->shaken > 0 && (options->schedule || options->dent > 0))
    return thr_fail(err, THR_EINPUT, "rise: %s while all is shaken",
                    options->schedule ? "no schedule can go on" : "no hand dents");
  const thr_status st = thr_hands_check(structure, options, err);
  if (st) return st;
  bool pulled = false;
  for (int c = 0; c < structure->n_cords; c++)
    pulled |=
        !structure->cord[c].slack && (structure->cord[c].pulled[0] || structure->cord[c].pulled[1]);
  if (!pulled && !options->schedule)
    return thr_fail(err, THR_EINPUT, "rise: no cord has an end that is pulled");
  if (!(thr_rise_edge(structure) > 0))
    return thr_fail(err, THR_EINPUT, "rise: the cords join no two pieces at different places");
  bool loose = false;
  for (int p = 0; p < structure->n_pieces; p++) {
    loose |= !structure->piece[p].held;
    if (!(structure->piece[p].mass > 0))
      return thr_fail(err, THR_EINPUT, "rise: piece %d weighs nothing", p);
  }
  return loose ? THR_OK : thr_fail(err, THR_EINPUT, "rise: all pieces are held: nothing can move");
}

thr_status thr_rise_simulate(const thr_rise_structure *structure, const thr_rise_options *options,
                             const thr_limits *limits, thr_rise_record *record, thr_err *err)
{
  *record = (thr_rise_record){.n_pieces = structure->n_pieces,
                              .closed = -1,
                              .came_up = -1,
                              .fell = -1,
                              .scheduled = options->schedule != NULL};
  thr_status st = check(structure, options, err);
  if (st) return st;

  rise_run run = {.structure = structure,
                  .options = options,
                  .shaken_since = INFINITY,
                  .chance = options->seed,
                  .mu = structure->physics.mu,
                  .friction = thr_friction_of(&structure->physics)};
  for (int c = 0; c < structure->n_cords; c++) {
    run.n_passes += structure->cord[c].n_passes;
    if (!structure->cord[c].slack) run.n_counted += structure->cord[c].n_passes;
  }
  record->n_passes = run.n_passes;
  record->n_counted = run.n_counted;
  run.cable = thr_scratch_array(&run.own, (size_t)structure->n_cords, sizeof *run.cable);
  run.drawn = thr_scratch_array(&run.own, (size_t)structure->n_cords, sizeof *run.drawn);
  run.pass = thr_scratch_array(&run.own, (size_t)run.n_passes, sizeof *run.pass);
  run.tie = thr_scratch_array(&run.own, (size_t)structure->n_pieces, sizeof *run.tie);
  record->open = thr_calloc((size_t)run.n_passes, sizeof *record->open);
  st = record->open ? thr_scratch_check(&run.own, err) : thr_nomem(err);

  /* Everything takes longer where pieces are larger, as falling does. */
  double low = INFINITY, high = -INFINITY;
  run.scale = sqrt(thr_rise_edge(structure) / TIME_EDGE);
  run.dt = TIME_STEP * run.scale * (options->time_step > 0 ? options->time_step : 1);
  record->between = FRAME * run.scale;
  if (!st) st = thr_rise_bodies_make(&run.bodies, structure, options, run.dt, err);
  if (!st) st = make_cords(&run, err);
  if (!st) st = tie_down(&run, err);
  for (int p = 0; p < structure->n_pieces && !st; p++) {
    const thr_rise_piece *piece = &structure->piece[p];
    if (!piece->held) record->weight += 1e-3 * piece->mass * structure->physics.gravity;
    low = fmin(low, piece->centre[2]);
    high = fmax(high, piece->centre[2]);
  }
  record->drawn_height = high - low;
  if (!st)
    st = thr_hands_make(&run.hands, structure, options, run.cable, run.scale, run.bodies.edge,
                        record->weight, &run.own, err);
  if (!st) {
    look_at_cords(&run);
    for (int i = 0; i < run.n_passes; i++)
      run.pass[i].first_gap = run.pass[i].gap;

    /* Nothing has opened yet. */
    for (int c = 0; c < structure->n_cords; c++) {
      memset(run.cable[c].tension, 0, (size_t)run.cable[c].n * sizeof(double));
      run.drawn[c] = 0;
    }
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
  free(record->open);
  free(record->kink);
  free(record->twist);
  *record = (thr_rise_record){0};
}
