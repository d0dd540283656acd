/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Method joint: measures a table of joints in Bullet and composes them along the taut path of every
 * cord. The measuring function is a parameter.
 *
 * Joints are measured at a grid of angles. A joint's rate, ln(ratio) / angle, is friction per rad
 * and changes slowly with the angle, so that the rate is interpolated linearly between two measured
 * angles. The exponent of a turn is the rate of its nominal angle (the shape of the joint) times
 * the angle by which the taut cord turns there. The ratio of a cord is the product over its turns.
 *
 * Steps: which angles are needed (ask_for), measure them in child processes or read them from the
 * cache (measure_joints), rates and errors (table_finish), exponents of each cord (fill_cord), and
 * the same by the closed form for comparison (raise_to_closed_form).
 *
 * Example: a turn of 50 degrees between measured ones of 45 and 60 takes two thirds of the rate of
 * the one and a third of the rate of the other. */
#include "eval/cord/profile.h"
#include "eval/joint/joint.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/process/process.h"

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
} measured_joint;

/* The angles of the grid up to the largest turn of the source. */
typedef struct {
  int n;
  measured_joint *at; /* by ascending turn */
  double *gap;        /* [n - 1] error of the rate interpolated half-way to the next joint */
  double mu;
} joint_table;

/* Whether a turn has been measured, or why the closed form stands in. */
typedef enum { MEASURED, UNSETTLED, OUTSIDE, SHARP } verdict;

/* Where an angle lies in the table: between joints i and i + 1, part of the way; or exactly at i if
 * part is 0. part < 0: below the first. */
typedef struct {
  int i; /* -1: beyond the table */
  double part;
} table_place;

/* The measuring of a table, job by job. */
typedef struct {
  const thr_joint_source *source;
  const char *cache;
  thr_drag drag; /* of every job, but for the turn */
  joint_table *table;
  int *job; /* joint of each job */
  bool cache_failed;
} measuring;

/* Releases a table and leaves an empty one. */
static void table_destroy(joint_table *table)
{
  free(table->at);
  free(table->gap);
  *table = (joint_table){0};
}

/* Makes a table of the multiples of thr_joint_step up to largest_turn, and of largest_turn
 * itself. */
static thr_status table_make(joint_table *table, double largest_turn, double mu, thr_err *err)
{
  int whole = (int)floor(largest_turn / thr_joint_step + ON_GRID);
  bool odd_end = largest_turn > whole * thr_joint_step + ON_GRID;

  *table = (joint_table){.n = whole + odd_end, .mu = mu};
  table->at = thr_calloc((size_t)table->n, sizeof *table->at);
  table->gap = thr_calloc((size_t)table->n, sizeof *table->gap);
  if (!table->at || !table->gap) {
    table_destroy(table);
    return thr_nomem(err);
  }

  for (int i = 0; i < table->n; i++)
    table->at[i].turn = i < whole ? (i + 1) * thr_joint_step : largest_turn;
  return THR_OK;
}

/* Returns where an angle, rad, lies in the table. */
static table_place locate(const joint_table *table, double turn)
{
  if (turn > table->at[table->n - 1].turn + ON_GRID) return (table_place){.i = -1};

  /* The last measured angle that is not above the turn. */
  int i = 0;
  while (i + 1 < table->n && table->at[i + 1].turn <= turn + ON_GRID)
    i++;

  double past = turn - table->at[i].turn;
  if (fabs(past) <= ON_GRID || table->n == 1) return (table_place){.i = i};
  return (table_place){.i = i, .part = past / (table->at[i + 1].turn - table->at[i].turn)};
}

/* Marks the joints that an angle needs: those on its two sides, and a third beside them. */
static void ask_for(joint_table *table, double turn)
{
  table_place place = locate(table, turn);
  if (place.i < 0) return;

  table->at[place.i].needed = true;
  if (place.part != 0) table->at[place.i + 1].needed = true;

  /* A third one, to judge the interpolation by leaving the middle one of three out. */
  if (place.part > 0 && table->n > 2) table->at[place.i > 0 ? place.i - 1 : 2].needed = true;
}

/* Marks the joints that a cord needs, for the nominal and for the taut angle of each turn. */
static void ask_for_cord(joint_table *table, const thr_frame *frame, const thr_cord *cord,
                         const double *taut)
{
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    if (taut[k] < STRAIGHT) continue;
    ask_for(table, thr_turn_angle(frame, cord->half[k], cord->half[k + 1]));
    ask_for(table, taut[k]);
  }
}

/* Returns the experiment that measures joint i. */
static thr_drag drag_of(const measuring *work, int i)
{
  thr_drag drag = work->drag;
  drag.turn = &work->table->at[i].turn;
  return drag;
}

/* Measures the joint of a job; runs in a child process. */
static thr_status measure_job(void *user, int job, void *result, thr_err *err)
{
  const measuring *work = user;
  thr_limits none = {0}; /* the parent keeps them */
  thr_drag drag = drag_of(work, work->job[job]);

  return work->source->measure(&drag, &none, result, err);
}

/* Takes a job's result into the table, and stores it in the cache. */
static void keep_job(void *user, int job, const void *result)
{
  measuring *work = user;
  measured_joint *joint = &work->table->at[work->job[job]];
  memcpy(&joint->result, result, sizeof joint->result);
  joint->known = true;

  /* What is out of range was not measured; a cache that fails is reported once, in the end. */
  if (!work->cache || joint->result.status == THR_DRAG_OUT_OF_RANGE) return;
  thr_drag drag = drag_of(work, work->job[job]);
  if (thr_cache_store(work->cache, &drag, &joint->result, NULL)) work->cache_failed = true;
}

/* Fills every needed joint from the cache or by measuring. When stopped (THR_ELIMIT) the joints
 * that were finished are known. */
static thr_status measure_joints(measuring *work, const thr_eval_options *options,
                                 const thr_limits *limits, thr_eval *out, thr_err *err)
{
  joint_table *table = work->table;
  thr_work jobs = {.result_size = sizeof(thr_drag_result),
                   .run = measure_job,
                   .done = keep_job,
                   .user = work,
                   .what = "measuring joints",
                   .advice = "use --method capstan"};

  /* The cache first; what it does not hold becomes a job. */
  for (int i = 0; i < table->n; i++) {
    if (!table->at[i].needed) continue;
    thr_drag drag = drag_of(work, i);
    table->at[i].known = work->cache && thr_cache_load(work->cache, &drag, &table->at[i].result);

    if (table->at[i].known)
      out->joints_cached++;
    else
      work->job[jobs.n_jobs++] = i;
  }

  /* Measure the rest. */
  thr_drag_result *results = thr_calloc((size_t)jobs.n_jobs, sizeof *results);
  bool *finished = thr_calloc((size_t)jobs.n_jobs, sizeof *finished);
  thr_status st = results && finished
                      ? thr_workers_run(&jobs, options->processes, limits, results, finished, err)
                      : thr_nomem(err);

  /* Count what was measured, also when stopped. */
  for (int i = 0; i < jobs.n_jobs && finished; i++)
    out->joints_measured += finished[i];

  free(results);
  free(finished);
  out->cache_failed = work->cache_failed;
  return st;
}

/* Returns whether a joint was measured in steady sliding. */
static bool settled(const measured_joint *joint)
{
  return joint->known && joint->result.status == THR_DRAG_SETTLED;
}

/* Computes the rate at joint i as its neighbours predict it, less what was measured there. Returns
 * false if one of the three is missing. */
static bool left_out(const joint_table *table, int i, double *miss)
{
  if (i < 1 || i + 1 >= table->n || !settled(&table->at[i - 1]) || !settled(&table->at[i]) ||
      !settled(&table->at[i + 1]))
    return false;

  const measured_joint *before = &table->at[i - 1], *here = &table->at[i],
                       *next = &table->at[i + 1];

  /* Linear between the two neighbours. */
  double part = (here->turn - before->turn) / (next->turn - before->turn);
  *miss = (1 - part) * before->rate + part * next->rate - here->rate;

  return true;
}

/* Computes rates and errors of all measured joints, and the error of interpolation in each gap. */
static void table_finish(const measuring *work, thr_eval *out)
{
  joint_table *table = work->table;
  double largest_miss = -1, largest_rate = 0;

  /* Rates, and their errors from the experiments. */
  for (int i = 0; i < table->n; i++) {
    measured_joint *joint = &table->at[i];

    /* Joints that did not settle are counted, and not used. */
    if (joint->known && joint->result.status == THR_DRAG_UNSETTLED) out->joints_unsettled++;
    if (!settled(joint)) continue;

    joint->rate = log(joint->result.ratio) / joint->turn;
    thr_drag drag = drag_of(work, i);
    joint->error = work->source->error(&drag, &joint->result) / joint->turn;
    largest_rate = fmax(largest_rate, fabs(joint->rate));
  }

  /* The error in a gap: the larger one of those seen when either end is left out. */
  for (int i = 0; i + 1 < table->n; i++) {
    double here, next;
    if (!settled(&table->at[i]) || !settled(&table->at[i + 1])) continue;

    bool has_here = left_out(table, i, &here), has_next = left_out(table, i + 1, &next);
    table->gap[i] = fmax(has_here ? fabs(here) : 0, has_next ? fabs(next) : 0);
    if (has_here || has_next)
      largest_miss = fmax(largest_miss, table->gap[i]);
    else
      table->gap[i] =
          fabs(table->at[i + 1].rate - table->at[i].rate); /* the third did not settle */
  }

  /* For the report: the largest error, relative to the largest rate. */
  bool judged = largest_miss >= 0 && largest_rate > 0 && table->mu > 0;
  out->interpolation = judged ? largest_miss / largest_rate : NAN;
}

static verdict worse(verdict a, verdict b)
{
  return a > b ? a : b;
}

/* Returns whether a joint can be used, or why not. */
static verdict verdict_of(const measured_joint *joint)
{
  if (settled(joint)) return MEASURED;
  return joint->result.status == THR_DRAG_OUT_OF_RANGE ? OUTSIDE : UNSETTLED;
}

/* Computes the exponent per rad at an angle, and its error, if the table can tell. */
static verdict rate_at(const joint_table *table, double turn, double *rate, double *error)
{
  /* Beyond the largest turn of the source nothing is measured. */
  table_place place = locate(table, turn);
  if (place.i < 0) return SHARP;

  /* Both joints beside the angle must have settled. */
  const measured_joint *low = &table->at[place.i], *high = place.part != 0 ? low + 1 : low;
  verdict judged = worse(verdict_of(low), verdict_of(high));
  if (judged != MEASURED) return judged;

  /* Interpolate. The error made by interpolation is a parabola over the gap, 4 part (1 - part) of
   * its value half-way. Below the first joint its rate stays, in doubt by as much as the next gap
   * would change it. */
  *rate = low->rate;
  *error = low->error;
  if (place.part > 0) {
    *rate += place.part * (high->rate - low->rate);
    *error += place.part * (high->error - low->error) +
              4 * place.part * (1 - place.part) * table->gap[place.i];
  } else if (place.part < 0)
    *error += -place.part * fabs(high->rate - low->rate);
  return MEASURED;
}

/* Computes the exponent of one turn and its error. nominal, taut: rad. If the table cannot tell,
 * the closed form mu x taut stands in, without an error of its own. */
static verdict exponent_of(const joint_table *table, double nominal, double taut, double *exponent,
                           double *error)
{
  double rate, doubt, taut_rate, taut_doubt;
  *exponent = *error = 0;

  if (taut < STRAIGHT) return MEASURED;
  verdict judged =
      worse(rate_at(table, nominal, &rate, &doubt), rate_at(table, taut, &taut_rate, &taut_doubt));

  /* The closed form stands in. */
  if (judged != MEASURED) {
    *exponent = table->mu * taut;
    return judged;
  }

  /* The rate belongs to the joint's shape, hence to its nominal angle. Friction never helps: a
   * ratio below 1 is an error. */
  *exponent = fmax(0, rate * taut);
  *error = (doubt + fabs(rate - taut_rate)) * taut + fmax(0, -rate * taut);
  return MEASURED;
}

/* Returns whether every joint is known that an angle needs. */
static bool angle_measured(const joint_table *table, double turn)
{
  table_place place = locate(table, turn);
  return place.i < 0 ||
         (table->at[place.i].known && (place.part == 0 || table->at[place.i + 1].known));
}

/* Returns whether every joint is known that a cord needs. */
static bool cord_measured(const joint_table *table, const thr_frame *frame, const thr_cord *cord,
                          const double *taut)
{
  for (int k = 0; k + 1 < cord->n_passes; k++)
    if (taut[k] >= STRAIGHT &&
        (!angle_measured(table, taut[k]) ||
         !angle_measured(table, thr_turn_angle(frame, cord->half[k], cord->half[k + 1]))))
      return false;
  return true;
}

/* Returns the error of a cord's end force, as that of its exponent: an end's force depends on the
 * turns between this end and the slackest pass, whose errors may all have one sign. If both ends
 * are pulled, neither slides over the turn behind the slackest pass. */
static double error_from_slackest(const thr_eval_cord *cord, const double *error)
{
  double side[2] = {0};
  for (int k = 0; k + 1 < cord->n_passes; k++)
    if (cord->pull != THR_PULL_BOTH || k != cord->slackest) side[k >= cord->slackest] += error[k];

  return fmax(side[0], side[1]);
}

/* Fills the record of a cord: exponents, tensions, turnings, error, refused turns. Leaves the
 * record as it is if some joint of the cord is not known. Adds its refused turns to out, its others
 * to *measured. */
static thr_status fill_cord(thr_eval *out, thr_eval_cord *eval_cord, const thr_frame *frame,
                            const thr_cord *cord, const joint_table *table, const double *taut,
                            bool gripped, int *measured, thr_err *err)
{
  int count[SHARP + 1] = {0};

  /* A cord with a joint that is not known has no record. */
  if (!cord_measured(table, frame, cord, taut)) return THR_OK;
  double *exponent = thr_calloc((size_t)cord->n_passes, sizeof *exponent);
  double *error = thr_calloc((size_t)cord->n_passes, sizeof *error);
  thr_status st = exponent && error ? THR_OK : thr_nomem(err);

  /* Exponent and verdict of each turn. */
  for (int k = 0; k + 1 < cord->n_passes && !st; k++) {
    double nominal = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]);
    verdict judged = exponent_of(table, nominal, taut[k], &exponent[k], &error[k]);

    /* Wobble beside the turn; turns of no angle count as nothing. */
    exponent[k] += thr_profile_wobble(frame, &out->record.physics, cord, k, table->mu);
    count[judged] += taut[k] >= STRAIGHT;
    eval_cord->turning += nominal;
    eval_cord->taut_turning += taut[k];
  }

  /* Tensions by the capstan law: the exponents add up. */
  if (!st)
    st = thr_profile_before(eval_cord, cord, exponent, out->record.physics.seating,
                            &(thr_friction){.power = 1}, gripped, err);
  if (!st) eval_cord->error = error_from_slackest(eval_cord, error);
  eval_cord->known = !st;

  /* Counts of turns by verdict. */
  eval_cord->refused = count[SHARP] + count[OUTSIDE] + count[UNSETTLED];
  out->refused_sharp += count[SHARP];
  out->refused_outside += count[OUTSIDE];
  out->refused_unsettled += count[UNSETTLED];
  *measured += count[MEASURED];

  /* The record owns the exponents. */
  eval_cord->exponent = exponent;
  free(error);
  return st;
}

/* Raises *largest to the cord's larger end force, N, by the closed form with this mu over the taut
 * turns; INFINITY if the force is past what a double can hold. */
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

/* Fails with THR_EINPUT if all turns that cost anything were refused. Called when no turn was
 * measured, which is no error if none costs anything. */
static thr_status check_any_measured(const thr_eval *eval, const thr_drag *drag,
                                     double largest_turn, thr_err *err)
{
  int sharp = eval->refused_sharp, outside = eval->refused_outside,
      unsettled = eval->refused_unsettled;
  char why[3][120] = {{0}};
  if (sharp + outside + unsettled == 0) return THR_OK;

  /* Each reason with its number of turns. */
  if (sharp)
    snprintf(why[0], sizeof why[0], "; %d sharper than %.0f degrees", sharp,
             largest_turn * (180 / THR_PI));
  if (outside)
    snprintf(why[1], sizeof why[1],
             "; %d out of range at bore / cord diameter = %.4g and mu = %.4g", outside, drag->bore,
             drag->mu);
  if (unsettled)
    snprintf(why[2], sizeof why[2], "; %d where the cord does not slide steadily", unsettled);

  /* The advice that fits the reasons. */
  return thr_fail(err, THR_EINPUT, "no turn could be measured%s%s%s; use %s%s%s--method capstan",
                  why[0], why[1], why[2], outside ? "a wider --bore, " : "",
                  unsettled ? "a finer --tune time-step, " : "",
                  outside || unsettled ? "a smaller --mu, or " : "");
}

/* Measures the joints that the cords need, and evaluates every cord whose joints are known. */
static thr_status compose(const thr_frame *frame, const thr_cord *cord,
                          const thr_eval_options *options, const thr_limits *limits,
                          measuring *work, double *const *taut, thr_eval *out, thr_err *err)
{
  const thr_physics *physics = &out->record.physics;
  thr_err stop = {0};
  int measured = 0;

  /* Measure. When stopped, cords whose joints are known are evaluated all the same. */
  for (int i = 0; i < out->record.n_cords; i++)
    ask_for_cord(work->table, frame, &cord[i], taut[i]);
  thr_status stopped = measure_joints(work, options, limits, out, &stop), st = THR_OK;
  if (stopped && stopped != THR_ELIMIT) return thr_fail(err, stopped, "%s", stop.text);
  table_finish(work, out);

  /* Evaluate cord by cord, and by the closed form with the ends of mu's range. */
  for (int i = 0; i < out->record.n_cords && !st; i++) {
    thr_eval_cord *eval_cord = &out->record.cord[i];
    st = fill_cord(out, eval_cord, frame, &cord[i], work->table, taut[i], options->hand > 0,
                   &measured, err);
    if (st || !eval_cord->known) continue;

    st = raise_to_closed_form(frame, &cord[i], physics, eval_cord->pull, taut[i], physics->mu_low,
                              &out->band[0], err);
    if (!st)
      st = raise_to_closed_form(frame, &cord[i], physics, eval_cord->pull, taut[i],
                                physics->mu_high, &out->band[1], err);
  }

  /* Report the stop only now, after what is complete. */
  if (!st && stopped) return thr_fail(err, stopped, "%s", stop.text);
  if (!st && measured == 0)
    st = check_any_measured(out, &work->drag, work->source->largest_turn, err);
  return st;
}

/* Rounds mu or a ratio of diameters such that rounding errors do not ask for another joint. */
static double quantized(double value)
{
  return rint(value * QUANTA) / QUANTA;
}

/* Fails with THR_EINPUT if the source is not good for a ratio of bore to cord diameter. */
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

  /* One turn, with bore and mu in numbers that the cache can find again. */
  joint_table table = {0};
  measuring work = {.source = source, .cache = options->cache, .table = &table};
  work.drag = (thr_drag){.n_turns = 1,
                         .bore = quantized(physics->bore / physics->cord_diameter),
                         .mu = quantized(physics->mu),
                         .seed = options->seed,
                         .time_step = options->time_step,
                         .iterations = options->iterations,
                         .spacing = 1};

  /* The source must be good for the bore. */
  thr_status st = check_bore(source, work.drag.bore, physics, err);
  if (st) return st;

  /* The taut turns of all cords, then the table, then all cords. */
  double **taut = thr_calloc((size_t)n_cords, sizeof *taut);
  st = taut ? thr_taut_turns(frame, cord, n_cords, physics, limits, taut, err) : thr_nomem(err);
  if (!st) st = table_make(&table, source->largest_turn, physics->mu, err);

  if (!st && !(work.job = thr_calloc((size_t)table.n, sizeof *work.job))) st = thr_nomem(err);

  if (!st) st = compose(frame, cord, options, limits, &work, taut, out, err);

  for (int i = 0; i < n_cords && taut; i++)
    free(taut[i]);
  free(taut);
  free(work.job);
  table_destroy(&table);
  return st;
}

thr_status thr_joint_method(const thr_frame *frame, const thr_cord *cord,
                            const thr_eval_options *options, const thr_limits *limits,
                            thr_eval *out, thr_err *err)
{
  /* Bullet is the source of joints. */
  const thr_joint_source bullet = {.measure = thr_drag_measure,
                                   .error = thr_drag_error,
                                   .largest_turn = thr_drag_largest_turn,
                                   .least_bore = thr_drag_least_bore,
                                   .largest_bore = thr_drag_largest_bore};
  return thr_joint_compose(frame, cord, options, limits, &bullet, out, err);
}
