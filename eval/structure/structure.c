/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Method structure: every cord's tension profile by the capstan law, the pull by limit analysis,
 * its failure shown by Bullet. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/schedule.h"
#include "graph/process/process.h"
#include "graph/process/threads.h"
#include "graph/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Above this the band over mu, and letting ends down bit by bit, would cost more than the answer.
 */
enum { BAND_LARGEST = 100 };

static int pass_count(const thr_evaluation *evaluation)
{
  int most = 1;
  for (int i = 0; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].n_passes > most) most = evaluation->cord[i].n_passes;
  return most;
}

/* Profile of one cord whose harder pulled end has 1, and its exponents. */
static thr_status profile(const thr_frame *frame, const thr_cord *cord, const thr_physics *physics,
                          double mu, thr_eval_cord *eval_cord, thr_err *err)
{
  if (!eval_cord->exponent)
    eval_cord->exponent = thr_calloc((size_t)cord->n_passes, sizeof *eval_cord->exponent);
  double *exponent = eval_cord->exponent;
  if (!exponent) return thr_nomem(err);
  eval_cord->turning = eval_cord->taut_turning = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    const double turn = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]),
                 counts = eval_cord->turn ? eval_cord->turn[k] : turn;
    exponent[k] = mu * counts + thr_profile_wobble(frame, physics, cord, k, mu);
    eval_cord->turning += turn;
    eval_cord->taut_turning += counts;
  }
  free(eval_cord->tension);
  eval_cord->tension = NULL;
  thr_status st = thr_profile_cord(eval_cord, cord, exponent, eval_cord->pull, 1,
                                   &(thr_friction){.power = 1}, err);
  if (st) return st;
  const bool pulled = eval_cord->pull != THR_PULL_NONE;
  const double force = pulled ? eval_cord->force : 1;
  for (int k = 0; k < cord->n_passes; k++)
    eval_cord->tension[k] /= force;
  eval_cord->other_force /= force;
  eval_cord->force = pulled ? 1 : 0;
  return THR_OK;
}

/* Profiles of all cords at a friction of mu; tension[n_cords] receives them, borrowed from the
 * record. */
static thr_status profiles(const thr_frame *frame, const thr_cord *cord, double mu,
                           thr_evaluation *evaluation, const double **tension, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < evaluation->n_cords && !st; i++) {
    st = profile(frame, &cord[i], &evaluation->physics, mu, &evaluation->cord[i], err);
    tension[i] = evaluation->cord[i].tension;
  }
  return st;
}

/* ---- the simulation, in a child process: Bullet does not look whether it was given memory ---- */

typedef struct {
  const thr_frame *f;
  const thr_cord *cord;
  const thr_beads *b;
  const thr_physics *physics;
  int n_cords;
  const double *const *tension, *const *most;
  thr_settle_options o;
} simulation;

static thr_status simulate(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const simulation *m = user;
  thr_settle found = {0};
  thr_text text = {0};
  thr_status st = thr_settle_run(m->b, m->f, m->cord, m->n_cords, m->tension, m->most, m->physics,
                                 &m->o, limits, &found, err);
  size_t poses = (size_t)found.n_beads * sizeof *found.before;
  if (!st) {
    thr_text_append_bytes(&text, (const char *)&found, sizeof found);
    if (found.before) thr_text_append_bytes(&text, (const char *)found.before, poses);
    if (found.after) thr_text_append_bytes(&text, (const char *)found.after, poses);
    st = thr_child_send(to, &text, err);
  }
  thr_text_destroy(&text);
  thr_settle_destroy(&found);
  return st;
}

/* Moves n poses from the text at *at, which goes on behind them; NULL if there are none or no
 * memory. */
static double (*take_poses(const char **at, bool present, size_t n))[7]
{
  double(*pose)[7] = present ? thr_calloc(n, sizeof *pose) : NULL;
  if (pose) memcpy(pose, *at, n * sizeof *pose);
  if (present) *at += n * sizeof *pose;
  return pose;
}

static thr_status take_settle(const thr_text *text, thr_settle *out, thr_err *err)
{
  memcpy(out, text->data, sizeof *out);
  const char *at = text->data + sizeof *out;
  const bool before = out->before, after = out->after; /* there, not here */
  out->before = take_poses(&at, before, (size_t)out->n_beads);
  out->after = take_poses(&at, after, (size_t)out->n_beads);
  if ((!before || out->before) && (!after || out->after)) return THR_OK;
  thr_settle_destroy(out);
  return thr_nomem(err);
}

static thr_status settle(simulation *m, const thr_limits *limits, thr_settle *out, thr_err *err)
{
  const thr_child child = {.what = "simulating the structure",
                           .advice = "use --no-dynamics",
                           .run = simulate,
                           .user = m};
  thr_text answer = {0};
  *out = (thr_settle){0};
  thr_status st = thr_child_run(&child, limits, &answer, err);
  if (!st) st = take_settle(&answer, out, err);
  thr_text_destroy(&answer);
  return st;
}

typedef struct {
  const simulation *of;
  thr_erect_options o;
} erection;

static thr_status simulate_erection(void *user, const thr_limits *limits, thr_sender *to,
                                    thr_err *err)
{
  const erection *m = user;
  const simulation *of = m->of;
  thr_erect found = {0};
  thr_text text = {0};
  thr_status st = thr_erect_run(of->b, of->f, of->cord, of->n_cords, of->tension, of->physics,
                                &m->o, limits, &found, err);
  if (!st) {
    thr_text_append_bytes(&text, (const char *)&found, sizeof found);
    if (found.pose)
      thr_text_append_bytes(&text, (const char *)found.pose,
                            THR_ERECT_STILLS * (size_t)found.n_beads * sizeof *found.pose);
    st = thr_child_send(to, &text, err);
  }
  thr_text_destroy(&text);
  thr_erect_destroy(&found);
  return st;
}

static thr_status erect(const simulation *of, double pull, const thr_limits *limits, thr_erect *out,
                        thr_err *err)
{
  erection m = {of, {pull, of->o.time_step, of->o.iterations, of->o.seed}};
  const thr_child child = {.what = "simulating how the structure comes up",
                           .advice = "leave --stills out",
                           .run = simulate_erection,
                           .user = &m};
  thr_text answer = {0};
  *out = (thr_erect){0};
  thr_status st = thr_child_run(&child, limits, &answer, err);
  if (!st) {
    memcpy(out, answer.data, sizeof *out);
    const char *at = answer.data + sizeof *out;
    const bool there = out->pose;
    out->pose = take_poses(&at, there, THR_ERECT_STILLS * (size_t)out->n_beads);
    if (there && !out->pose) st = thr_nomem(err);
  }
  if (st) *out = (thr_erect){0};
  thr_text_destroy(&answer);
  return st;
}

/* Between a pull below which nothing holds and one at which an equilibrium exists. */
static thr_settle_options between(const thr_eval_options *options, double least, double equilibrium)
{
  return (thr_settle_options){.least = least,
                              .equilibrium = equilibrium,
                              .start = options->start,
                              .time_step = options->time_step,
                              .iterations = options->iterations,
                              .seed = options->seed,
                              .large = options->large};
}

/* ---- states that friction keeps ---- */

/* Which tensions a cord has whose ends have the same force: as little as the turns let in while
 * both are pulled; as much as they keep; as much as they keep of the record's, once the ends are
 * let down. */
typedef enum { DRAWN_IN, KEPT, LET_DOWN } state;

static void set_state(const thr_eval_cord *cord, state which, double force, double *out)
{
  const double most =
      600; /* of an exponent: more is past what a number holds, and more than enough */
  double before = 0, total = 0;
  if (cord->pull == THR_PULL_NONE) force = 0; /* slack, whatever is done to the others */
  for (int k = 0; k + 1 < cord->n_passes; k++)
    total += cord->exponent[k];
  for (int k = 0; k < cord->n_passes; k++) {
    const double near = fmin(most, fmin(before, total - before));
    out[k] = force > 0 ? force * exp(which == DRAWN_IN ? -near : near) : 0;
    if (which == LET_DOWN) out[k] = fmin(out[k], cord->tension[k]);
    if (k + 1 < cord->n_passes) before += cord->exponent[k];
  }
}

/* press[n_faces], 0 before: what such cords press the faces with. */
static thr_status press_of(const thr_cord *cord, const thr_evaluation *evaluation, state which,
                           double force, double *press, thr_err *err)
{
  double *tension = thr_calloc((size_t)pass_count(evaluation), sizeof *tension);
  for (int i = 0; i < evaluation->n_cords && tension; i++) {
    set_state(&evaluation->cord[i], which, force, tension);
    thr_holding_press(&cord[i], 1, &(const double *){tension}, press);
  }
  const bool done = tension != NULL;
  free(tension);
  return done ? THR_OK : thr_nomem(err);
}

/* What the tensions of such cords may be multiplied by. Of all friction states with so much at the
 * ends those that keep most press most, and to press more never harms: an equilibrium with some
 * tensions taken smaller is one. */
static thr_status hold_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                             state which, double force, bool want_upper, const thr_limits *limits,
                             const thr_evaluation *evaluation, thr_holding *out, thr_err *err)
{
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  thr_status st = press ? press_of(cord, evaluation, which, force, press, err) : thr_nomem(err);
  if (!st)
    st = thr_holding_pull(beads, frame, &evaluation->physics, press, want_upper, limits, out, err);
  free(press);
  return st;
}

/* What of the load such cords carry; first_bead -1 where that is not decided. */
static thr_status carry_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                              state which, double force, const double (*load)[3], bool want_carried,
                              const thr_limits *limits, const thr_evaluation *evaluation,
                              thr_carry *out, thr_err *err)
{
  thr_err why = {0};
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  thr_status st = press ? press_of(cord, evaluation, which, force, press, &why) : thr_nomem(&why);
  if (!st)
    st = thr_holding_carry(beads, frame, &evaluation->physics, press, load, want_carried, limits,
                           out, &why);
  free(press);
  if (st) *out = (thr_carry){.first_bead = -1};
  return st == THR_OK || st == THR_ESOLVER ? THR_OK : thr_fail(err, st, "%s", why.text);
}

/* ---- the frictions of beads and ground, which are estimates ---- */

/* Is it worth to ask again at both ends of their band? */
static bool has_bands(const thr_evaluation *record, const thr_beads *beads)
{
  return beads->n_beads <= BAND_LARGEST && record->physics.mu > 0;
}

/* The record, borrowed, with the frictions at an end of their band: as that of the cords, in
 * proportion. */
static thr_evaluation at_end(const thr_evaluation *record, int end)
{
  thr_evaluation other = *record;
  const double times =
      (end ? record->physics.mu_high : record->physics.mu_low) / record->physics.mu;
  other.physics.mu_bead *= times;
  other.physics.mu_ground *= times;
  return other;
}

/* What is proved, INFINITY where nothing holds it, NAN where that is not decided. Takes what was
 * found. */
static thr_status take_bound(thr_status st, thr_holding *found, const thr_err *why, double *bound,
                             thr_err *err)
{
  *bound = st == THR_OK ? found->lower : st == THR_EINFEASIBLE ? INFINITY : NAN;
  thr_holding_destroy(found);
  return st == THR_OK || st == THR_EINFEASIBLE || st == THR_ESOLVER
             ? THR_OK
             : thr_fail(err, st, "%s", why->text);
}

/* The bound of hold_state at an end of the band. */
static thr_status bound_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                              state which, double force, int end, const thr_limits *limits,
                              const thr_evaluation *record, double *bound, thr_err *err)
{
  const thr_evaluation other = at_end(record, end);
  thr_holding found = {0};
  thr_err why = {0};
  const thr_status st =
      hold_state(frame, cord, beads, which, force, false, limits, &other, &found, &why);
  return take_bound(st, &found, &why, bound, err);
}

/* What of the load is too much for carry_state at an end of the band, in the same words. */
static thr_status bound_carried(const thr_frame *frame, const thr_cord *cord,
                                const thr_beads *beads, state which, double force,
                                const double (*load)[3], int end, const thr_limits *limits,
                                const thr_evaluation *record, double *bound, thr_err *err)
{
  const thr_evaluation other = at_end(record, end);
  thr_carry found = {0};
  const thr_status st =
      carry_state(frame, cord, beads, which, force, load, false, limits, &other, &found, err);
  *bound = !st && found.first_bead >= 0 ? found.beyond : NAN;
  thr_carry_destroy(&found);
  return st;
}

typedef struct {
  const thr_frame *frame;
  const thr_cord *cord;
  const thr_beads *beads;
  const double (*load)[3];
  thr_eval *out;
} loading;

/* The pull of all ends that carries the whole load; INFINITY: none does. */
static thr_status carry_all(const loading *l, const thr_limits *limits, thr_err *err)
{
  thr_err why = {0};
  const size_t n = (size_t)l->beads->n_beads;
  thr_beads loaded = *l->beads;
  loaded.load = thr_calloc(n, sizeof *loaded.load);
  if (!loaded.load) return thr_nomem(err);
  memcpy(loaded.load, l->load, n * sizeof *loaded.load);
  thr_status st = hold_state(l->frame, l->cord, &loaded, DRAWN_IN, 1, true, limits, &l->out->record,
                             &l->out->loaded, &why);
  for (int end = 0;
       end < 2 && has_bands(&l->out->record, &loaded) && (st == THR_OK || st == THR_EINFEASIBLE);
       end++) {
    const thr_status more =
        bound_state(l->frame, l->cord, &loaded, DRAWN_IN, 1, end, limits, &l->out->record,
                    &l->out->band_beads[THR_ASKED_LOADED][end], &why);
    if (more) st = more;
  }
  free(loaded.load);
  if (st == THR_EINFEASIBLE || st == THR_ESOLVER)
    l->out->loaded = (thr_holding){.present = true,
                                   .lower = st == THR_EINFEASIBLE ? INFINITY : 0,
                                   .upper = INFINITY,
                                   .first_bead = -1};
  return st == THR_OK || st == THR_EINFEASIBLE || st == THR_ESOLVER
             ? THR_OK
             : thr_fail(err, st, "%s", why.text);
}

/* Job 0: the pull that carries it all; job k: what the k-th pull carries. */
static thr_status carry_one(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const loading *l = user;
  if (job == 0) return carry_all(l, limits, err);
  thr_load_point *point = &l->out->carries[job - 1];
  thr_status st = carry_state(l->frame, l->cord, l->beads, DRAWN_IN, point->pull, l->load, true,
                              limits, &l->out->record, &point->carry, err);
  for (int end = 0; end < 2 && has_bands(&l->out->record, l->beads) && !st; end++)
    st = bound_carried(l->frame, l->cord, l->beads, DRAWN_IN, point->pull, l->load, end, limits,
                       &l->out->record, &point->band_beads[end], err);
  return st;
}

/* The load against the pull. */
static thr_status carry_at_pulls(const thr_frame *frame, const thr_cord *cord,
                                 const thr_beads *beads, const thr_eval_options *options,
                                 const thr_limits *limits, thr_eval *out, thr_err *err)
{
  static const double usual[] = {1, 2, 5, 10, 20, 50}, few[] = {10, 50}; /* 50 N: a hand */
  const bool large = beads->n_beads > BAND_LARGEST;
  const double *pull = options->n_load_pulls > 0 ? options->load_pull : large ? few : usual;
  const int n = options->n_load_pulls > 0 ? options->n_load_pulls : large ? 2 : 6;
  if (!(out->carries = thr_calloc((size_t)n, sizeof *out->carries))) return thr_nomem(err);
  out->n_carries = n;
  for (int i = 0; i < n; i++)
    out->carries[i] =
        (thr_load_point){.pull = pull[i], .carry = {.first_bead = -1}, .band_beads = {NAN, NAN}};
  loading l = {frame, cord, beads, options->load, out};
  return thr_threads_run(n + 1, carry_one, &l, limits, err);
}

/* The beads with what is done to them beside the pull. */
static thr_status make_beads(const thr_frame *frame, const thr_physics *physics,
                             const thr_eval_options *options, thr_beads *beads, thr_err *err)
{
  thr_status st = thr_beads_make(frame, physics, beads, err);
  bool *held = st ? NULL : thr_calloc((size_t)beads->n_beads, sizeof *held);
  if (!st && !held) st = thr_nomem(err);
  for (int k = 0; !st && k < beads->n_feet; k++)
    held[beads->foot[k]] = true;
  if (!st && options->clamped) thr_beads_clamp(beads, held);
  if (!st && options->rays > 0) beads->rays = options->rays;
  if (!st) thr_beads_tilt(beads, options->tilt, options->azimuth);
  free(held);
  return st;
}

/* Does it stand with the ends let down so far; is it proved that it falls? */
static thr_status stands_at(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                            double force, const thr_limits *limits,
                            const thr_evaluation *evaluation, bool *stands, bool *falls,
                            thr_err *err)
{
  thr_holding holding = {0};
  thr_err why = {0};
  thr_status st =
      hold_state(frame, cord, beads, LET_DOWN, force, true, limits, evaluation, &holding, &why);
  *stands = st == THR_OK && holding.upper <= 1;
  *falls = st == THR_EINFEASIBLE || (st == THR_OK && holding.lower > 1);
  thr_holding_destroy(&holding);
  return st == THR_ENOMEM || st == THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* By halves of the logarithm, to half a percent: the force at which it stands (proved false: the
 * one at which it is proved to fall; 0 if it is at none). */
static thr_status let_down(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                           const thr_limits *limits, const thr_evaluation *evaluation, bool proved,
                           double *out, thr_err *err)
{
  double high = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    high = fmax(high, fmax(evaluation->cord[i].tension[0],
                           evaluation->cord[i].tension[evaluation->cord[i].n_passes - 1]));
  double low = 1e-6 * high;
  bool stands, falls;
  thr_status st = stands_at(frame, cord, beads, low, limits, evaluation, &stands, &falls, err);
  if (!st && (proved ? !falls : stands)) {
    *out = proved ? 0 : low;
    return THR_OK;
  }
  while (!st && high > 1.005 * low) {
    const double middle = sqrt(low * high);
    st = stands_at(frame, cord, beads, middle, limits, evaluation, &stands, &falls, err);
    if (proved ? !falls : stands)
      high = middle;
    else
      low = middle;
  }
  *out = proved ? low : high;
  return st;
}

/* Simulates how the cords as they are now are let down at all ends. */
static thr_status settle_let_down(const thr_frame *frame, const thr_cord *cord,
                                  const thr_beads *beads, const thr_eval_options *options,
                                  const thr_limits *limits, double least, thr_eval *out,
                                  thr_err *err)
{
  const thr_evaluation *evaluation = &out->record;
  const size_t n = (size_t)evaluation->n_cords;
  thr_scratch own = {0};
  const double **tension = thr_scratch_array(&own, n, sizeof *tension),
               **most = thr_scratch_array(&own, n, sizeof *most);
  for (int i = 0; i < evaluation->n_cords && tension && most; i++) {
    double *kept = thr_scratch_array(&own, (size_t)cord[i].n_passes, sizeof *kept);
    if (kept) set_state(&evaluation->cord[i], KEPT, 1, kept);
    tension[i] = kept;
    most[i] = evaluation->cord[i].tension;
  }
  thr_status st = thr_scratch_check(&own, err);
  simulation m = {frame,
                  cord,
                  beads,
                  &evaluation->physics,
                  evaluation->n_cords,
                  tension,
                  most,
                  between(options, least, out->let_down)};
  if (!st) st = settle(&m, limits, &out->settle, err);
  thr_scratch_free(&own);
  return st;
}

/* Lists the passes of cords that are knotted at both ends, into own. */
static thr_status set_rises(const thr_frame *frame, const thr_cord *cord,
                            const thr_evaluation *evaluation, double strength, thr_scratch *own,
                            thr_beads *beads, thr_err *err)
{
  size_t n = 1;
  for (int i = 0; i < evaluation->n_cords; i++)
    n += (size_t)cord[i].n_passes;
  beads->rise = thr_scratch_array(own, n, sizeof *beads->rise);
  beads->strength = strength;
  const thr_status st = thr_scratch_check(own, err);
  for (int i = 0; i < evaluation->n_cords && !st; i++) {
    if (!thr_schedule_knotted(&evaluation->schedule, i)) continue;
    for (int k = 0; k < cord[i].n_passes; k++) {
      const int e = cord[i].half[k] >> 1;
      const double *from = beads->centre[frame->edge[e][0]], *to = beads->centre[frame->edge[e][1]];
      beads->rise[beads->n_rises++] =
          (thr_rise){.face = e,
                     .least = evaluation->cord[i].tension[k],
                     .length = sqrt(pow(to[0] - from[0], 2) + pow(to[1] - from[1], 2) +
                                    pow(to[2] - from[2], 2)),
                     .exponent = k + 1 < cord[i].n_passes ? evaluation->cord[i].exponent[k] : -1};
    }
  }
  return st;
}

/* Raises tensions by more[n_rises], and as much further as friction demands where rounding left it
 * short; returns the sum of what they grew by, times their lengths, N m. *tightest: the largest
 * tension then. */
static double raise_tensions(const thr_beads *beads, const double *more, double *tightest,
                             double *raised)
{
  const thr_rise *rise = beads->rise;
  const int n = beads->n_rises;
  double sum = 0;
  *tightest = 0;
  for (int i = 0; i < n; i++)
    raised[i] = rise[i].least + more[i];
  for (int i = 1; i < n; i++)
    if (rise[i - 1].exponent >= 0)
      raised[i] = fmax(raised[i], raised[i - 1] * exp(-rise[i - 1].exponent));
  for (int i = n - 2; i >= 0; i--)
    if (rise[i].exponent >= 0) raised[i] = fmax(raised[i], raised[i + 1] * exp(-rise[i].exponent));
  for (int i = 0; i < n; i++) {
    sum += (raised[i] - rise[i].least) * rise[i].length;
    *tightest = fmax(*tightest, raised[i]);
  }
  return sum;
}

/* What cannot be decided is no failure of the rest: nothing is proved then, and no equilibrium
 * found. */
static thr_status undecided(thr_status st, const thr_err *why, thr_holding *out, thr_err *err)
{
  if (st == THR_ESOLVER) *out = (thr_holding){.present = true, .upper = INFINITY, .first_bead = -1};
  return st == THR_OK || st == THR_EINFEASIBLE || st == THR_ESOLVER
             ? THR_OK
             : thr_fail(err, st, "%s", why->text);
}

/* What knotted cords have to stretch by. */
static thr_status stretch(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                          const thr_limits *limits, thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &out->record;
  thr_scratch own = {0};
  thr_err why = {0};
  double *press = thr_scratch_array(&own, (size_t)beads->n_faces + 1, sizeof *press);
  double *more = thr_scratch_array(&own, (size_t)beads->n_rises + 1, sizeof *more);
  double *raised = thr_scratch_array(&own, (size_t)beads->n_rises + 1, sizeof *raised);
  thr_status st = thr_scratch_check(&own, err);
  if (st) return st;
  for (int i = 0; i < evaluation->n_cords; i++)
    thr_holding_press(&cord[i], 1, &(const double *){evaluation->cord[i].tension}, press);
  st = thr_holding_stretch(beads, frame, &evaluation->physics, press, limits, &out->stretch, more,
                           &why);
  if (!st && out->stretch.upper > 0 && isfinite(out->stretch.upper))
    out->stretch.upper =
        fmax(out->stretch.lower, raise_tensions(beads, more, &out->tightest, raised));
  if (st == THR_EINFEASIBLE) {
    out->stretch.present = true;
    out->stretch.lower = out->stretch.upper = INFINITY;
    out->stretch.first_bead = -1;
  }
  st = undecided(st, &why, &out->stretch, err);
  for (int end = 0; end < 2 && has_bands(evaluation, beads) && !st; end++) {
    const thr_evaluation other = at_end(evaluation, end);
    thr_holding found = {0};
    st = thr_holding_stretch(beads, frame, &other.physics, press, limits, &found, more, &why);
    st = take_bound(st, &found, &why, &out->band_beads[THR_ASKED_STRETCH][end], err);
  }
  thr_scratch_free(&own);
  return st;
}

thr_status thr_structure_after(const thr_frame *frame, const thr_cord *cord,
                               const thr_eval_options *options, const thr_limits *limits,
                               thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &out->record;
  thr_beads beads = {0};
  thr_scratch own = {0};
  thr_err why = {0};
  thr_status st = make_beads(frame, &evaluation->physics, options, &beads, err);
  if (!st) st = set_rises(frame, cord, evaluation, options->strength, &own, &beads, err);
  const bool knotted = beads.n_rises > 0;
  if (knotted) st = stretch(frame, cord, &beads, limits, out, err);
  if (!st && !knotted) {
    st = hold_state(frame, cord, &beads, LET_DOWN, INFINITY, true, limits, evaluation, &out->after,
                    &why);
    if (st == THR_EINFEASIBLE)
      out->after =
          (thr_holding){.present = true, .lower = INFINITY, .upper = INFINITY, .first_bead = -1};
    st = undecided(st, &why, &out->after, err);
    for (int end = 0; end < 2 && has_bands(evaluation, &beads) && !st; end++)
      st = bound_state(frame, cord, &beads, LET_DOWN, INFINITY, end, limits, evaluation,
                       &out->band_beads[THR_ASKED_AFTER][end], err);
  }
  if (!st && !knotted && out->after.upper <= 1 && beads.n_beads <= BAND_LARGEST) {
    st = let_down(frame, cord, &beads, limits, evaluation, false, &out->let_down, err);
    double least = 0;
    if (!st && options->dynamics && !options->load) {
      st = let_down(frame, cord, &beads, limits, evaluation, true, &least, err);
      if (!st) st = settle_let_down(frame, cord, &beads, options, limits, least, out, err);
    }
  }
  if (!st && options->load)
    st = carry_state(frame, cord, &beads, LET_DOWN, INFINITY, options->load, true, limits,
                     evaluation, &out->after_carries, err);
  if (!st && options->load && knotted && !(options->strength > 0) &&
      out->after_carries.first_bead < 0) { /* no load is too much, however tight they get */
    beads.n_rises = 0;
    st = carry_state(frame, cord, &beads, LET_DOWN, INFINITY, options->load, true, limits,
                     evaluation, &out->after_carries, err);
    free(out->after_carries.velocity);
    out->after_carries.velocity = NULL;
    out->after_carries.beyond = INFINITY;
  }
  for (int end = 0; end < 2 && options->load && isfinite(out->after_carries.beyond) &&
                    has_bands(evaluation, &beads) && !st;
       end++)
    st = bound_carried(frame, cord, &beads, LET_DOWN, INFINITY, options->load, end, limits,
                       evaluation, &out->band_beads[THR_ASKED_CARRIED_AFTER][end], err);
  thr_scratch_free(&own);
  thr_beads_destroy(&beads);
  return st;
}

/* ---- the pull ---- */

/* With cords whose tensions at a pull of 1 are these. */
static thr_status hold(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                       bool want_upper, const thr_limits *limits, const thr_evaluation *evaluation,
                       const double *const *tension, thr_holding *out, thr_err *err)
{
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  if (!press) return thr_nomem(err);
  thr_holding_press(cord, evaluation->n_cords, tension, press);
  thr_status st =
      thr_holding_pull(beads, frame, &evaluation->physics, press, want_upper, limits, out, err);
  free(press);
  return st;
}

/* Below which pull, and force in any state, nothing holds at another friction of the cords; unknown
 * where tensions span more than numbers can hold, or than the solver can. */
static thr_status hold_at(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                          double mu, const thr_limits *limits, thr_evaluation *evaluation,
                          const double **tension, double *pull, double *any_state, thr_err *err)
{
  thr_err why = {0};
  thr_holding drawn_in = {0}, kept = {0};
  thr_status st = profiles(frame, cord, mu, evaluation, tension, &why);
  if (st == THR_EINPUT) return THR_OK;
  if (!st) st = hold(frame, cord, beads, false, limits, evaluation, tension, &drawn_in, &why);
  st = take_bound(st, &drawn_in, &why, pull, err);
  if (!st) st = hold_state(frame, cord, beads, KEPT, 1, false, limits, evaluation, &kept, &why);
  return take_bound(st, &kept, &why, any_state, err);
}

/* One end of the band of mu, on a copy of the record's cords. */
static thr_status band_end(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                           double mu, const thr_limits *limits, const thr_evaluation *evaluation,
                           double *pull, double *any_state, thr_err *err)
{
  thr_evaluation copy = *evaluation;
  const double **tension = thr_calloc((size_t)evaluation->n_cords, sizeof *tension);
  copy.cord = thr_calloc((size_t)evaluation->n_cords, sizeof *copy.cord);
  thr_status st = tension && copy.cord ? THR_OK : thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    copy.cord[i] = (thr_eval_cord){.pull = evaluation->cord[i].pull,
                                   .n_passes = evaluation->cord[i].n_passes,
                                   .turn = evaluation->cord[i].turn};
  if (!st) st = hold_at(frame, cord, beads, mu, limits, &copy, tension, pull, any_state, err);
  free(tension);
  for (int i = 0; i < evaluation->n_cords && copy.cord; i++)
    copy.cord[i].turn = NULL; /* the record's */
  if (copy.cord) thr_evaluation_destroy(&copy);
  return st;
}

/* Below which pull nothing holds at an end of the band of the frictions of beads and ground. */
static thr_status hold_beads(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                             int end, const thr_limits *limits, const thr_evaluation *record,
                             const double *const *tension, double *bound, thr_err *err)
{
  thr_err why = {0};
  thr_holding found = {0};
  const thr_evaluation other = at_end(record, end);
  const thr_status st = hold(frame, cord, beads, false, limits, &other, tension, &found, &why);
  return take_bound(st, &found, &why, bound, err);
}

/* What is asked of the cords as they are drawn in, each by itself. */
typedef enum {
  PULL,
  EQUAL_PULLS,
  ANY_STATE,
  BAND_LOW,
  BAND_HIGH,
  PULL_BEADS, /* at the lower end, and one further at the upper one */
  EQUAL_BEADS = PULL_BEADS + 2,
  ANY_BEADS = EQUAL_BEADS + 2,
  N_QUESTIONS = ANY_BEADS + 2
} question;

typedef struct {
  const thr_frame *frame;
  const thr_cord *cord;
  const thr_beads *beads;
  const double *const *tension;
  thr_eval *out;
  int n, n_answered;
  question asked[N_QUESTIONS]; /* [n] */
} questions;

static thr_status answer(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const questions *q = user;
  const thr_evaluation *record = &q->out->record;
  const int asked = (int)q->asked[q->n_answered + job], end = (asked - PULL_BEADS) % 2;
  double(*band)[2] = q->out->band_beads;
  switch (asked) {
  case PULL:
    return hold(q->frame, q->cord, q->beads, true, limits, record, q->tension, &q->out->holding,
                err);
  case EQUAL_PULLS:
    return hold_state(q->frame, q->cord, q->beads, DRAWN_IN, 1, true, limits, record,
                      &q->out->equal, err);
  case ANY_STATE:
    return hold_state(q->frame, q->cord, q->beads, KEPT, 1, true, limits, record, &q->out->loosest,
                      err);
  case BAND_LOW:
    return band_end(q->frame, q->cord, q->beads, record->physics.mu_low, limits, record,
                    &q->out->band[0], &q->out->band_any[0], err);
  case PULL_BEADS:
  case PULL_BEADS + 1:
    return hold_beads(q->frame, q->cord, q->beads, end, limits, record, q->tension,
                      &band[THR_ASKED_HOLDING][end], err);
  case EQUAL_BEADS:
  case EQUAL_BEADS + 1:
    return bound_state(q->frame, q->cord, q->beads, DRAWN_IN, 1, end, limits, record,
                       &band[THR_ASKED_EQUAL][end], err);
  case ANY_BEADS:
  case ANY_BEADS + 1:
    return bound_state(q->frame, q->cord, q->beads, KEPT, 1, end, limits, record,
                       &band[THR_ASKED_ANY_STATE][end], err);
  default:
    return band_end(q->frame, q->cord, q->beads, record->physics.mu_high, limits, record,
                    &q->out->band[1], &q->out->band_any[1], err);
  }
}

/* From profiles of a pull of 1 to newtons. */
static void fill_record(thr_evaluation *evaluation, double pull)
{
  for (int i = 0; i < evaluation->n_cords; i++) {
    thr_eval_cord *eval_cord = &evaluation->cord[i];
    for (int k = 0; k < eval_cord->n_passes; k++)
      eval_cord->tension[k] *= pull;
    eval_cord->force *= pull;
    eval_cord->other_force *= pull;
    eval_cord->work = eval_cord->force + eval_cord->other_force;
    eval_cord->loss =
        eval_cord->force > 0 ? 1 - eval_cord->tension[eval_cord->slackest] / eval_cord->force : 0;
    eval_cord->known = true;
  }
}

/* What is not known stays empty. */
static void clear_record(thr_evaluation *evaluation)
{
  for (int i = 0; i < evaluation->n_cords; i++) {
    free(evaluation->cord[i].tension);
    free(evaluation->cord[i].exponent);
    free(evaluation->cord[i].turn);
    evaluation->cord[i] =
        (thr_eval_cord){.pull = evaluation->cord[i].pull, .n_passes = evaluation->cord[i].n_passes};
  }
}

/* Are both ends of every cord pulled that is pulled? */
static bool all_both(const thr_evaluation *evaluation)
{
  bool both = true;
  for (int i = 0; i < evaluation->n_cords; i++)
    both &= evaluation->cord[i].pull == THR_PULL_BOTH || evaluation->cord[i].pull == THR_PULL_NONE;
  return both;
}

/* The questions from where they were left, each by whichever thread is free. */
static thr_status answer_up_to(questions *q, int n, const thr_limits *limits, thr_err *err)
{
  thr_status st = thr_threads_run(n - q->n_answered, answer, q, limits, err);
  q->n_answered = n;
  return st;
}

/* As far as its size allows, most wanted first. */
static void ask(questions *q)
{
  const bool small = q->beads->n_beads <= BAND_LARGEST, equal = small && all_both(&q->out->record);
  q->asked[q->n++] = PULL;
  if (equal) q->asked[q->n++] = EQUAL_PULLS;
  q->asked[q->n++] = ANY_STATE;
  if (small) q->asked[q->n++] = BAND_LOW, q->asked[q->n++] = BAND_HIGH;
  for (int asked = PULL_BEADS; asked < N_QUESTIONS && has_bands(&q->out->record, q->beads); asked++)
    if (equal || asked < EQUAL_BEADS || asked >= ANY_BEADS) q->asked[q->n++] = (question)asked;
}

static simulation simulation_of(const questions *q, thr_settle_options how)
{
  const thr_evaluation *record = &q->out->record;
  return (simulation){q->frame,        q->cord,    q->beads, &record->physics,
                      record->n_cords, q->tension, NULL,     how};
}

/* Bullet, with the pull that was found. */
static thr_status show(const questions *q, const thr_eval_options *options,
                       const thr_limits *limits, thr_err *err)
{
  thr_eval *out = q->out;
  const double lower = out->holding.lower, upper = out->holding.upper;
  simulation m = simulation_of(q, between(options, lower, upper));
  thr_status st = THR_OK;
  if (!options->schedule && (options->start > 0 || lower > 0))
    st = settle(&m, limits, &out->settle, err);
  if (!st && options->erect && lower > 0)
    st = erect(&m, isfinite(upper) ? upper : lower, limits, &out->erect, err);
  return st;
}

/* What comes of it where no pull holds, drawn in as hard as it is heavy: a picture, without which
 * there is one answer less. */
static void show_fallen(const questions *q, const thr_eval_options *options,
                        const thr_limits *limits)
{
  const simulation m = simulation_of(q, between(options, 0, 0));
  const double weight = thr_beads_weight(q->beads, m.physics);
  thr_err why = {0};
  if (erect(&m, weight, limits, &q->out->erect, &why)) thr_erect_destroy(&q->out->erect);
}

/* The pull, then what is worth less than it, so that a stop leaves the most. All at once where
 * nothing is simulated. */
static thr_status run(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                      const thr_eval_options *options, const thr_limits *limits,
                      const double **tension, thr_eval *out, thr_err *err)
{
  thr_evaluation *evaluation = &out->record;
  const bool simulated =
      beads->n_beads <= thr_settle_largest(options->large) && !options->load && options->dynamics;
  questions q = {.frame = frame, .cord = cord, .beads = beads, .tension = tension, .out = out};
  out->band[0] = out->band[1] = out->band_any[0] = out->band_any[1] = NAN;
  for (int i = 0; i < THR_N_ASKED; i++)
    out->band_beads[i][0] = out->band_beads[i][1] = NAN;
  thr_status st = profiles(frame, cord, evaluation->physics.mu, evaluation, tension, err);
  ask(&q);
  if (!st) st = answer_up_to(&q, simulated ? 1 : q.n, limits, err);
  if (st && !out->holding.present) {
    if (st == THR_EINFEASIBLE && simulated && options->erect) show_fallen(&q, options, limits);
    thr_holding_destroy(&out->loosest); /* of another thread */
    clear_record(evaluation);
    return st;
  }
  if (!st && simulated) st = show(&q, options, limits, err);
  if (!st) st = answer_up_to(&q, q.n, limits, err);
  if (!st && options->load) st = carry_at_pulls(frame, cord, beads, options, limits, out, err);
  fill_record(evaluation, out->holding.lower);
  return st ? st : thr_structure_drawn(evaluation, options, err);
}

static thr_status take_taut_turns(const thr_frame *frame, const thr_cord *cord,
                                  const thr_limits *limits, thr_evaluation *evaluation,
                                  thr_err *err)
{
  double **turn = thr_calloc((size_t)evaluation->n_cords, sizeof *turn);
  thr_status st = turn ? thr_taut_turns(frame, cord, evaluation->n_cords, &evaluation->physics,
                                        limits, turn, err)
                       : thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords && turn; i++)
    evaluation->cord[i].turn = turn[i];
  free(turn);
  return st;
}

thr_status thr_structure_method(const thr_frame *frame, const thr_cord *cord,
                                const thr_eval_options *options, const thr_limits *limits,
                                thr_eval *out, thr_err *err)
{
  thr_beads beads = {0};
  const double **tension = thr_calloc((size_t)out->record.n_cords, sizeof *tension);
  thr_status st =
      tension ? make_beads(frame, &out->record.physics, options, &beads, err) : thr_nomem(err);
  if (!st && options->taut) st = take_taut_turns(frame, cord, limits, &out->record, err);
  if (!st) st = run(frame, cord, &beads, options, limits, tension, out, err);
  thr_beads_destroy(&beads);
  free(tension);
  return st;
}

thr_status thr_eval_holds_from(const thr_frame *frame, const thr_cord *cord,
                               const thr_evaluation *evaluation, const thr_limits *limits,
                               double *times, thr_err *err)
{
  const thr_eval_options usual = thr_eval_options_default();
  thr_err why = {0};
  thr_beads beads = {0};
  thr_holding holding = {0};
  *times = NAN;
  if (frame->n_nodes > THR_HOLDS_LARGEST) return THR_OK;
  thr_status st = make_beads(frame, &evaluation->physics, &usual, &beads, &why);
  double *press = st ? NULL : thr_calloc((size_t)beads.n_faces + 1, sizeof *press);
  if (!st && !press) st = thr_nomem(&why);

  /* What the cords press the faces with as they are; the unknown is the multiple of it. */
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].pull != THR_PULL_NONE)
      thr_holding_press(&cord[i], 1, &(const double *){evaluation->cord[i].tension}, press);
  if (!st)
    st =
        thr_holding_pull(&beads, frame, &evaluation->physics, press, false, limits, &holding, &why);
  if (!st) *times = holding.lower;
  if (st == THR_EINFEASIBLE) *times = INFINITY;

  free(press);
  thr_holding_destroy(&holding);
  thr_beads_destroy(&beads);
  return st == THR_ENOMEM || st == THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
