/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Composing measured joints along taut cords, with the measuring function as a parameter. Private
 * to eval/.
 *
 * Ratios are measured at some angles and read off between two of them by their rate, ln(ratio) /
 * angle, linearly in the angle; the ratio of a cord is the product over its turns.
 *
 * Example: a turn of 50 degrees between measured ones of 45 and 60 takes two thirds of the rate of
 * the one and a third of that of the other.
 *
 * Method joint: a table of joints measured in Bullet, composed along the taut path of every cord.
 */
#include "eval/cord/profile.h"
#include "eval/joint/joint.h"
#include "graph/angle.h"
#include "graph/framework/units.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/process/threads.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const double thr_joint_step = THR_PI / 24;

static const double STRAIGHT = 1e-6; /* rad: a turn that costs nothing */
static const double ON_GRID = 1e-9;  /* rad: closer to a measured angle is that angle */
static const double QUANTA =
    1e6; /* per 1 of mu and of bore / cord, so that rounding does not ask for another joint */

/* A measured angle. */
typedef struct {
  double turn; /* rad */
  bool needed, known;
  thr_drag_result result;
  double rate;  /* exponent per rad: ln(ratio) / turn */
  double error; /* of the rate, from drift and scatter */
} joint;

typedef struct {
  int n;
  joint *at;   /* by ascending turn */
  double *gap; /* [n - 1] error of the rate interpolated half-way to the next joint */
  double mu;
} table;

/* Whether a turn has been measured, or why the closed form stands in. */
typedef enum { MEASURED, UNSETTLED, OUTSIDE, SHARP } verdict;

/* Where an angle lies in the table: between joints i and i + 1, part of the way; or exactly at i if
 * part is 0. part < 0: below the first. */
typedef struct {
  int i; /* -1: beyond the table */
  double part;
} place;

typedef struct {
  const thr_joint_source *source;
  const char *cache;
  thr_drag drag; /* of every job, but for the turn */
  table *table;
  int *job; /* joint of each job */
  bool cache_failed;
} work;

static void table_destroy(table *t)
{
  free(t->at);
  free(t->gap);
  *t = (table){0};
}

static thr_status table_make(table *t, double largest_turn, double mu, thr_err *err)
{
  int whole = (int)floor(largest_turn / thr_joint_step + ON_GRID);
  bool odd_end = largest_turn > whole * thr_joint_step + ON_GRID;
  *t = (table){.n = whole + odd_end, .mu = mu};
  t->at = thr_calloc((size_t)t->n, sizeof *t->at);
  t->gap = thr_calloc((size_t)t->n, sizeof *t->gap);
  if (!t->at || !t->gap) {
    table_destroy(t);
    return thr_nomem(err);
  }
  for (int i = 0; i < t->n; i++)
    t->at[i].turn = i < whole ? (i + 1) * thr_joint_step : largest_turn;
  return THR_OK;
}

static place locate(const table *t, double turn)
{
  if (turn > t->at[t->n - 1].turn + ON_GRID) return (place){.i = -1};
  int i = 0;
  while (i + 1 < t->n && t->at[i + 1].turn <= turn + ON_GRID)
    i++;
  double past = turn - t->at[i].turn;
  if (fabs(past) <= ON_GRID || t->n == 1) return (place){.i = i};
  return (place){.i = i, .part = past / (t->at[i + 1].turn - t->at[i].turn)};
}

static void ask_for(table *t, double turn)
{
  place p = locate(t, turn);
  if (p.i < 0) return;
  t->at[p.i].needed = true;
  if (p.part != 0) t->at[p.i + 1].needed = true;
  if (p.part > 0 && t->n > 2)
    t->at[p.i > 0 ? p.i - 1 : 2].needed = true; /* a third, to judge interpolation by */
}

static void ask_for_cord(table *t, const thr_frame *frame, const thr_cord *cord, const double *taut)
{
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    if (taut[k] < STRAIGHT) continue;
    ask_for(t, thr_turn_angle(frame, cord->half[k], cord->half[k + 1]));
    ask_for(t, taut[k]);
  }
}

static thr_drag drag_of(const work *w, int i)
{
  thr_drag d = w->drag;
  d.turn = &w->table->at[i].turn;
  return d;
}

static thr_status measure_job(void *user, int job, void *result, thr_err *err)
{
  const work *w = user;
  thr_limits none = {0}; /* the parent keeps them */
  thr_drag d = drag_of(w, w->job[job]);
  return w->source->measure(&d, &none, result, err);
}

static void keep_job(void *user, int job, const void *result)
{
  work *w = user;
  joint *j = &w->table->at[w->job[job]];
  memcpy(&j->result, result, sizeof j->result);
  j->known = true;
  if (!w->cache || j->result.status == THR_DRAG_OUT_OF_RANGE) return;
  thr_drag d = drag_of(w, w->job[job]);
  if (thr_cache_store(w->cache, &d, &j->result, NULL)) w->cache_failed = true;
}

/* Every needed joint from the cache or by measuring it. */
static thr_status measure_joints(work *w, const thr_eval_options *options, const thr_limits *limits,
                                 thr_eval *out, thr_err *err)
{
  table *t = w->table;
  thr_work jobs = {.result_size = sizeof(thr_drag_result),
                   .run = measure_job,
                   .done = keep_job,
                   .user = w,
                   .what = "measuring joints",
                   .advice = "use --method capstan"};
  for (int i = 0; i < t->n; i++) {
    if (!t->at[i].needed) continue;
    thr_drag d = drag_of(w, i);
    t->at[i].known = w->cache && thr_cache_load(w->cache, &d, &t->at[i].result);
    if (t->at[i].known)
      out->joints_cached++;
    else
      w->job[jobs.n_jobs++] = i;
  }
  thr_drag_result *results = thr_calloc((size_t)jobs.n_jobs, sizeof *results);
  bool *finished = thr_calloc((size_t)jobs.n_jobs, sizeof *finished);
  thr_status st = results && finished
                      ? thr_workers_run(&jobs, options->processes, limits, results, finished, err)
                      : thr_nomem(err);
  for (int i = 0; i < jobs.n_jobs && finished; i++)
    out->joints_measured += finished[i];
  free(results);
  free(finished);
  out->cache_failed = w->cache_failed;
  return st;
}

static bool settled(const joint *j)
{
  return j->known && j->result.status == THR_DRAG_SETTLED;
}

/* Rate at joint i as its neighbours predict it, less what was measured there; false if one of the
 * three is missing. */
static bool left_out(const table *t, int i, double *miss)
{
  if (i < 1 || i + 1 >= t->n || !settled(&t->at[i - 1]) || !settled(&t->at[i]) ||
      !settled(&t->at[i + 1]))
    return false;
  const joint *a = &t->at[i - 1], *b = &t->at[i], *c = &t->at[i + 1];
  double part = (b->turn - a->turn) / (c->turn - a->turn);
  *miss = (1 - part) * a->rate + part * c->rate - b->rate;
  return true;
}

static void table_finish(const work *w, thr_eval *out)
{
  table *t = w->table;
  double largest_miss = -1, largest_rate = 0;
  for (int i = 0; i < t->n; i++) {
    joint *j = &t->at[i];
    if (j->known && j->result.status == THR_DRAG_UNSETTLED) out->joints_unsettled++;
    if (!settled(j)) continue;
    j->rate = log(j->result.ratio) / j->turn;
    thr_drag d = drag_of(w, i);
    j->error = w->source->error(&d, &j->result) / j->turn;
    largest_rate = fmax(largest_rate, fabs(j->rate));
  }
  for (int i = 0; i + 1 < t->n; i++) {
    double here, next;
    if (!settled(&t->at[i]) || !settled(&t->at[i + 1])) continue;
    bool has_here = left_out(t, i, &here), has_next = left_out(t, i + 1, &next);
    t->gap[i] = fmax(has_here ? fabs(here) : 0, has_next ? fabs(next) : 0);
    if (has_here || has_next)
      largest_miss = fmax(largest_miss, t->gap[i]);
    else
      t->gap[i] = fabs(t->at[i + 1].rate - t->at[i].rate); /* the third did not settle */
  }
  bool judged = largest_miss >= 0 && largest_rate > 0 && t->mu > 0;
  out->interpolation = judged ? largest_miss / largest_rate : NAN;
}

static verdict worse(verdict a, verdict b)
{
  return a > b ? a : b;
}

static verdict verdict_of(const joint *j)
{
  if (settled(j)) return MEASURED;
  return j->result.status == THR_DRAG_OUT_OF_RANGE ? OUTSIDE : UNSETTLED;
}

/* Exponent per rad at an angle, and its error, if the table can tell. */
static verdict rate_at(const table *t, double turn, double *rate, double *error)
{
  place p = locate(t, turn);
  if (p.i < 0) return SHARP;
  const joint *a = &t->at[p.i], *b = p.part != 0 ? a + 1 : a;
  verdict v = worse(verdict_of(a), verdict_of(b));
  if (v != MEASURED) return v;
  *rate = a->rate;
  *error = a->error;
  if (p.part > 0) {
    *rate += p.part * (b->rate - a->rate);
    *error += p.part * (b->error - a->error) + 4 * p.part * (1 - p.part) * t->gap[p.i];
  } else if (p.part < 0)
    *error += -p.part * fabs(b->rate - a->rate);
  return MEASURED;
}

/* Exponent of one turn and its error. If the table cannot tell, the closed form stands in, without
 * an error of its own. */
static verdict exponent_of(const table *t, double nominal, double taut, double *exponent,
                           double *error)
{
  double rate, doubt, taut_rate, taut_doubt;
  *exponent = *error = 0;
  if (taut < STRAIGHT) return MEASURED;
  verdict v = worse(rate_at(t, nominal, &rate, &doubt), rate_at(t, taut, &taut_rate, &taut_doubt));
  if (v != MEASURED) {
    *exponent = t->mu * taut;
    return v;
  }
  *exponent = fmax(0, rate * taut);
  *error = (doubt + fabs(rate - taut_rate)) * taut +
           fmax(0, -rate * taut); /* friction never helps: a ratio below 1 is an error */
  return MEASURED;
}

/* Is every joint known that these angles need? */
static bool angle_measured(const table *t, double turn)
{
  place p = locate(t, turn);
  return p.i < 0 || (t->at[p.i].known && (p.part == 0 || t->at[p.i + 1].known));
}

static bool cord_measured(const table *t, const thr_frame *frame, const thr_cord *cord,
                          const double *taut)
{
  for (int k = 0; k + 1 < cord->n_passes; k++)
    if (taut[k] >= STRAIGHT &&
        (!angle_measured(t, taut[k]) ||
         !angle_measured(t, thr_turn_angle(frame, cord->half[k], cord->half[k + 1]))))
      return false;
  return true;
}

/* An end's force hangs on the turns between it and the slackest pass; their errors may all have one
 * sign. Where both ends are pulled, neither slides over the turn behind that. */
static double error_from_slackest(const thr_eval_cord *cord, const double *error)
{
  double side[2] = {0};
  for (int k = 0; k + 1 < cord->n_passes; k++)
    if (cord->pull != THR_PULL_BOTH || k != cord->slackest) side[k >= cord->slackest] += error[k];
  return fmax(side[0], side[1]);
}

/* Leaves the cord's record as it is if some joint of it is not known. Adds its refused turns to
 * out, its others to *measured. */
static thr_status fill_cord(thr_eval *out, thr_eval_cord *eval_cord, const thr_frame *frame,
                            const thr_cord *cord, const table *t, const double *taut, bool gripped,
                            int *measured, thr_err *err)
{
  int count[SHARP + 1] = {0};
  if (!cord_measured(t, frame, cord, taut)) return THR_OK;
  double *exponent = thr_calloc((size_t)cord->n_passes, sizeof *exponent);
  double *error = thr_calloc((size_t)cord->n_passes, sizeof *error);
  thr_status st = exponent && error ? THR_OK : thr_nomem(err);
  for (int k = 0; k + 1 < cord->n_passes && !st; k++) {
    double nominal = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]);
    verdict v = exponent_of(t, nominal, taut[k], &exponent[k], &error[k]);
    exponent[k] += thr_profile_wobble(frame, &out->record.physics, cord, k, t->mu);
    count[v] += taut[k] >= STRAIGHT;
    eval_cord->turning += nominal;
    eval_cord->taut_turning += taut[k];
  }
  if (!st)
    st = thr_profile_before(eval_cord, cord, exponent, out->record.physics.seating,
                            &(thr_friction){.power = 1}, gripped, err);
  if (!st) eval_cord->error = error_from_slackest(eval_cord, error);
  eval_cord->known = !st;
  eval_cord->refused = count[SHARP] + count[OUTSIDE] + count[UNSETTLED];
  out->refused_sharp += count[SHARP];
  out->refused_outside += count[OUTSIDE];
  out->refused_unsettled += count[UNSETTLED];
  *measured += count[MEASURED];
  eval_cord->exponent = exponent;
  free(error);
  return st;
}

/* Raises *largest to the cord's larger end force by the closed form; INFINITY if that is past what
 * a number can hold. */
static thr_status raise_to_closed_form(const thr_frame *frame, const thr_cord *cord,
                                       const thr_physics *physics, thr_pull pull,
                                       const double *taut, double mu, double *largest, thr_err *err)
{
  thr_eval_cord other = {.force = INFINITY};
  double *exponent = thr_calloc((size_t)cord->n_passes, sizeof *exponent);
  if (!exponent) return thr_nomem(err);
  for (int k = 0; k + 1 < cord->n_passes; k++)
    exponent[k] = mu * taut[k] + thr_profile_wobble(frame, physics, cord, k, mu);
  thr_status st = thr_profile_cord(&other, cord, exponent, pull, physics->seating,
                                   &(thr_friction){.power = 1}, NULL);
  free(other.tension);
  free(exponent);
  if (st == THR_ENOMEM) return thr_nomem(err);
  *largest = fmax(*largest, other.force);
  return THR_OK;
}

/* No turn was measured: because none costs anything, or because all were refused. */
static thr_status check_any_measured(const thr_eval *eval, const thr_drag *d, double largest_turn,
                                     thr_err *err)
{
  int sharp = eval->refused_sharp, outside = eval->refused_outside,
      unsettled = eval->refused_unsettled;
  char why[3][120] = {{0}};
  if (sharp + outside + unsettled == 0) return THR_OK;
  if (sharp)
    snprintf(why[0], sizeof why[0], "; %d sharper than %.0f degrees", sharp,
             largest_turn * (180 / THR_PI));
  if (outside)
    snprintf(why[1], sizeof why[1],
             "; %d out of range at bore / cord diameter = %.4g and mu = %.4g", outside, d->bore,
             d->mu);
  if (unsettled)
    snprintf(why[2], sizeof why[2], "; %d where the cord does not slide steadily", unsettled);
  return thr_fail(err, THR_EINPUT, "no turn could be measured%s%s%s; use %s%s%s--method capstan",
                  why[0], why[1], why[2], outside ? "a wider --bore, " : "",
                  unsettled ? "a finer --tune time-step, " : "",
                  outside || unsettled ? "a smaller --mu, or " : "");
}

static thr_status compose(const thr_frame *frame, const thr_cord *cord,
                          const thr_eval_options *options, const thr_limits *limits, work *w,
                          double *const *taut, thr_eval *out, thr_err *err)
{
  const thr_physics *physics = &out->record.physics;
  thr_err stop = {0};
  int measured = 0;
  for (int i = 0; i < out->record.n_cords; i++)
    ask_for_cord(w->table, frame, &cord[i], taut[i]);
  thr_status stopped = measure_joints(w, options, limits, out, &stop), st = THR_OK;
  if (stopped && stopped != THR_ELIMIT) return thr_fail(err, stopped, "%s", stop.text);
  table_finish(w, out);
  for (int i = 0; i < out->record.n_cords && !st; i++) {
    thr_eval_cord *eval_cord = &out->record.cord[i];
    st = fill_cord(out, eval_cord, frame, &cord[i], w->table, taut[i], options->hand > 0, &measured,
                   err);
    if (st || !eval_cord->known) continue;
    st = raise_to_closed_form(frame, &cord[i], physics, eval_cord->pull, taut[i], physics->mu_low,
                              &out->band[0], err);
    if (!st)
      st = raise_to_closed_form(frame, &cord[i], physics, eval_cord->pull, taut[i],
                                physics->mu_high, &out->band[1], err);
  }
  if (!st && stopped) return thr_fail(err, stopped, "%s", stop.text);
  if (!st && measured == 0) st = check_any_measured(out, &w->drag, w->source->largest_turn, err);
  return st;
}

static double quantized(double x)
{
  return rint(x * QUANTA) / QUANTA;
}

static thr_status check_bore(const thr_joint_source *source, double ratio,
                             const thr_physics *physics, thr_err *err)
{
  if (ratio >= source->least_bore && ratio <= source->largest_bore) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "--bore, %.8g mm, is %.8g times --cord-diameter, %.8g mm; the simulation was "
                  "validated for %g to %g times; use a "
                  "%s --bore, or --method capstan",
                  physics->bore, physics->bore / physics->cord_diameter, physics->cord_diameter,
                  source->least_bore, source->largest_bore,
                  ratio < source->least_bore ? "wider" : "narrower");
}

thr_status thr_joint_compose(const thr_frame *frame, const thr_cord *cord,
                             const thr_eval_options *options, const thr_limits *limits,
                             const thr_joint_source *source, thr_eval *out, thr_err *err)
{
  const thr_physics *physics = &out->record.physics;
  const int n_cords = out->record.n_cords;
  table t = {0};
  work w = {.source = source, .cache = options->cache, .table = &t};
  w.drag = (thr_drag){.n_turns = 1,
                      .bore = quantized(physics->bore / physics->cord_diameter),
                      .mu = quantized(physics->mu),
                      .seed = options->seed,
                      .time_step = options->time_step,
                      .iterations = options->iterations,
                      .spacing = 1};
  thr_status st = check_bore(source, w.drag.bore, physics, err);
  if (st) return st;
  double **taut = thr_calloc((size_t)n_cords, sizeof *taut);
  st = taut ? thr_taut_turns(frame, cord, n_cords, physics, limits, taut, err) : thr_nomem(err);
  if (!st) st = table_make(&t, source->largest_turn, physics->mu, err);
  if (!st && !(w.job = thr_calloc((size_t)t.n, sizeof *w.job))) st = thr_nomem(err);
  if (!st) st = compose(frame, cord, options, limits, &w, taut, out, err);
  for (int i = 0; i < n_cords && taut; i++)
    free(taut[i]);
  free(taut);
  free(w.job);
  table_destroy(&t);
  return st;
}

thr_status thr_joint_method(const thr_frame *frame, const thr_cord *cord,
                            const thr_eval_options *options, const thr_limits *limits,
                            thr_eval *out, thr_err *err)
{
  const thr_joint_source bullet = {.measure = thr_drag_measure,
                                   .error = thr_drag_error,
                                   .largest_turn = thr_drag_largest_turn,
                                   .least_bore = thr_drag_least_bore,
                                   .largest_bore = thr_drag_largest_bore};
  return thr_joint_compose(frame, cord, options, limits, &bullet, out, err);
}
