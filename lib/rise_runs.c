/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs rising structures in parallel processes, which Bullet may end, and sums up what several runs
 * say: one run is no fact.
 *
 * A process sends its record, with the moments, but without the places of all pieces: those are
 * wanted of one run at most, which `thread rise` does by itself.
 *
 * Example: three runs of data/dome7-lines.json come up at 1.28, 1.3 and 1.34 N: 1.3 (1.28 to 1.34).
 */
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/process/process.h"
#include "lib/rise_pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double thr_rise_hand = 50, thr_rise_coarse = 2.2;

/* ---- the pieces ---- */

thr_status thr_rise_pieces_make(thr_rise_pieces *pieces, const thr_plan *plan,
                                const thr_kit_options *options, const thr_rise_setting *setting,
                                const thr_limits *limits, thr_err *err)
{
  thr_physics physics;
  thr_pull *pull = thr_calloc((size_t)plan->n_cords, sizeof *pull);
  const thr_physics *asked = setting->physics ? setting->physics : &plan->options.physics;
  *pieces = (thr_rise_pieces){.ends = setting->ends, .seated = NAN, .stands = NAN};
  for (int c = 0; c < plan->n_cords && pull; c++)
    pull[c] = setting->ends;

  thr_status st = thr_kit_make(&pieces->kit, plan, options, NULL, true, limits, err);
  if (!st && !pull) st = thr_nomem(err);
  if (!st) st = thr_physics_resolve(asked, &plan->frame, &physics, err);
  if (!st) st = thr_rise_kit_make(&pieces->made, &pieces->kit, pull, setting->feet, &physics, err);
  free(pull);
  return st;
}

void thr_rise_pieces_destroy(thr_rise_pieces *pieces)
{
  thr_rise_kit_destroy(&pieces->made);
  thr_kit_destroy(&pieces->kit);
}

void thr_rise_foretell(thr_rise_pieces *pieces, const thr_limits *limits)
{
  const thr_plan *plan = pieces->kit.plan;
  thr_err err = {0};
  thr_bodies bodies;
  const bool known = !thr_kit_bodies(&pieces->kit, &bodies, &err);
  err = (thr_err){0};
  for (int method = 0; method < 2; method++) {
    thr_eval eval;
    thr_eval_options options = thr_eval_options_default();
    options.physics = pieces->made.structure.physics;
    options.pull = pieces->ends;
    if (method == 1 && (!known || plan->frame.n_nodes > THR_HOLDS_LARGEST)) break;
    if (method == 1) options.bodies = &bodies;
    if (!thr_eval_plan(&plan->frame, plan->cord, plan->n_cords,
                       method ? THR_STRUCTURE : THR_CAPSTAN, &options, limits, &eval, &err)) {
      if (method)
        pieces->stands = eval.equal.present ? eval.equal.lower : eval.holding.lower;
      else
        pieces->seated = eval.record.largest;
    }
    thr_eval_destroy(&eval);
    err = (thr_err){0};
  }
  thr_scratch_free(&bodies.own);
}

void thr_rise_pass_names(const thr_rise_pieces *pieces, int pass, const char *name[2])
{
  const thr_rise_structure *structure = &pieces->made.structure;
  for (int c = 0; c < structure->n_cords; c++) {
    const thr_rise_cord *cord = &structure->cord[c];
    if (pass >= cord->n_passes) {
      pass -= cord->n_passes;
      continue;
    }
    name[0] = pieces->kit.name[cord->piece[pass]];
    name[1] = pieces->kit.name[cord->piece[pass + 1]];
    return;
  }
}

/* ---- the runs ---- */

/* What a process returns of a run. */
typedef struct {
  thr_status status;
  thr_err why;
  thr_rise_record record; /* without its arrays */
  thr_rise_moment moment[THR_RISE_MOST_MOMENTS];
  double angle[]; /* [2 n_passes] kinks, twists */
} run_result;

/* Does a run. Signature of thr_work.run. */
static thr_status run_job(void *user, int i, void *result, thr_err *err)
{
  const thr_rise_job *job = (const thr_rise_job *)user + i;
  run_result *out = result;
  thr_rise_record record;
  (void)err;
  out->status = thr_rise_simulate(job->structure, &job->options, NULL, &record, &out->why);
  if (!out->status) {
    out->record = record;
    if (record.n_frames > THR_RISE_MOST_MOMENTS) out->record.n_frames = THR_RISE_MOST_MOMENTS;
    memcpy(out->moment, record.moment, (size_t)out->record.n_frames * sizeof *out->moment);
    for (int k = 0; k < record.n_passes; k++) {
      out->angle[k] = record.kink[k];
      out->angle[record.n_passes + k] = record.twist[k];
    }
    out->record.kink = out->record.twist = NULL;
    out->record.open = NULL;
    out->record.moment = NULL;
    out->record.pose = NULL;
    out->record.tension = NULL;
  }
  thr_rise_record_destroy(&record);
  return THR_OK;
}

/* Takes over what a process returned. THR_ENOMEM. */
static thr_status take_over(thr_rise_job *job, const run_result *result, thr_err *err)
{
  job->status = result->status;
  job->why = result->why;
  if (job->status) return THR_OK;
  const size_t n_moments = (size_t)result->record.n_frames,
               n_passes = (size_t)result->record.n_passes;
  job->record = result->record;
  job->record.moment = thr_calloc(n_moments, sizeof *job->record.moment);
  job->record.kink = thr_calloc(n_passes, sizeof *job->record.kink);
  job->record.twist = thr_calloc(n_passes, sizeof *job->record.twist);
  if (!job->record.moment || !job->record.kink || !job->record.twist) return thr_nomem(err);
  memcpy(job->record.moment, result->moment, n_moments * sizeof *job->record.moment);
  memcpy(job->record.kink, result->angle, n_passes * sizeof *job->record.kink);
  memcpy(job->record.twist, result->angle + n_passes, n_passes * sizeof *job->record.twist);
  job->done = true;
  return THR_OK;
}

thr_status thr_rise_jobs_run(thr_rise_job *job, int n, int processes, const thr_limits *limits,
                             thr_err *err)
{
  int most = 0; /* passes */
  for (int i = 0; i < n; i++) {
    int passes = 0;
    for (int c = 0; c < job[i].structure->n_cords; c++)
      passes += job[i].structure->cord[c].n_passes;
    if (passes > most) most = passes;
  }
  const size_t size = sizeof(run_result) + 2 * sizeof(double) * (size_t)most;
  const thr_work work = {.n_jobs = n,
                         .result_size = size,
                         .run = run_job,
                         .user = job,
                         .what = "simulating",
                         .advice = "fewer --seeds"};
  char *result = thr_calloc((size_t)n, size);
  bool *finished = thr_calloc((size_t)n, sizeof *finished);
  thr_status st = result && finished
                      ? thr_workers_run(&work, processes, limits, result, finished, err)
                      : thr_nomem(err);

  for (int i = 0; i < n && result && finished; i++)
    if (finished[i] && take_over(&job[i], (const void *)(result + (size_t)i * size), err))
      st = THR_ENOMEM;
  free(result);
  free(finished);
  return st;
}

/* ---- what several say ---- */

double thr_rise_pull_up(const thr_rise_record *record)
{
  double most = 0;
  if (record->came_up < 0) return INFINITY;
  for (int f = record->scheduled ? 0 : record->came_up; f <= record->came_up; f++)
    most = fmax(most, record->moment[f].pull);
  return most;
}

double thr_rise_pull_down(const thr_rise_record *record)
{
  return record->fell >= 0 ? record->moment[record->fell].pull : 0;
}

void thr_rise_spread(double *value, int n, double out[3])
{
  thr_sort_doubles(value, (size_t)n);
  out[0] = value[0];
  out[1] = value[(n - 1) / 2];
  out[2] = value[n - 1];
}

/* ---- as JSON ---- */

/* Writes angles in degrees. */
static void write_degrees(thr_writer *writer, const char *key, const double *angle, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_printf(writer, NULL, "%.4g", thr_degrees(angle[i]));
  thr_write_close(writer);
}

/* Writes the moments of run i, and the place of every piece if that is asked for. */
static void write_run(thr_writer *writer, const thr_rise_seen *seen, int i)
{
  const thr_rise_record *record = &seen->record[i];
  thr_write_object(writer, NULL);
  thr_write_int(writer, "seed", seen->first_seed + i);
  thr_write_bool(writer, "came_up", record->came_up >= 0);
  if (record->came_up >= 0) thr_write_number(writer, "pull_up", thr_rise_pull_up(record));
  if (record->fell >= 0) thr_write_number(writer, "pull_down", thr_rise_pull_down(record));
  thr_write_int(writer, "most_closed", record->most_closed);
  thr_write_number(writer, "off", record->off);
  if (seen->pieces->made.structure.stands_up && record->held > 0)
    thr_write_printf(writer, "tilt", "%.4g", thr_degrees(record->moment[record->held - 1].tilt));
  if (seen->after && record->finished) thr_write_bool(writer, "stands", record->stands);
  if (seen->dented) thr_write_number(writer, "dented", record->dented);
  write_degrees(writer, "kink", record->kink, record->n_passes);
  write_degrees(writer, "twist", record->twist, record->n_passes);

  thr_write_array(writer, "moments");
  for (int f = 0; f < record->n_frames; f++) {
    const thr_rise_moment *moment = &record->moment[f];
    thr_write_row(writer, NULL);
    thr_write_printf(writer, NULL, "%.6g", moment->time);
    thr_write_printf(writer, NULL, "%.6g", moment->pull);
    thr_write_printf(writer, NULL, "%.6g", moment->drawn);
    thr_write_int(writer, NULL, moment->closed);
    thr_write_printf(writer, NULL, "%.6g", moment->height);
    thr_write_printf(writer, NULL, "%.6g", moment->lift);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  if (seen->motion && record->pose) {
    thr_write_array(writer, "frames");
    for (int f = 0; f < record->n_frames; f++) {
      const double *pose = record->pose[(size_t)f * (size_t)record->n_pieces];
      thr_write_row(writer, NULL);
      for (int k = 0; k < 7 * record->n_pieces; k++)
        thr_write_printf(writer, NULL, "%.6g", pose[k]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* Writes the tensions that the schedule leaves in the first run, and those of the closed form. */
static void write_left(thr_writer *writer, const thr_rise_seen *seen)
{
  const thr_rise_record *record = &seen->record[0];
  const double *left = record->tension + (size_t)(record->n_frames - 1) * (size_t)record->n_passes;
  thr_write_array(writer, "left");
  for (int c = 0; c < seen->pieces->made.structure.n_cords; c++) {
    const thr_eval_cord *cord = &seen->after->record.cord[c];
    thr_write_object(writer, NULL);
    thr_write_string(writer, "cord", seen->pieces->kit.plan->cord[c].id);
    for (int i = 0; i < 2; i++) {
      thr_write_row(writer, i ? "closed_form" : "tension");
      for (int k = 0; k < cord->n_passes; k++)
        thr_write_printf(writer, NULL, "%.6g", i ? cord->tension[k] : left[k]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
    left += cord->n_passes;
  }
  thr_write_close(writer);
}

/* Writes why the first run did not come up, and what may help. */
static void write_jam(thr_writer *writer, const thr_rise_seen *seen, const thr_rise_jam *jam)
{
  thr_write_object(writer, "jam");
  thr_write_int(writer, "open", jam->open);
  thr_write_string(writer, "cord", seen->pieces->kit.plan->cord[jam->cord].id);
  thr_write_int(writer, "on_cord", jam->on_cord);
  thr_write_number(writer, "tension", jam->tension);
  thr_write_string(writer, "top", seen->pieces->kit.name[jam->top]);
  thr_write_row(writer, "try");
  for (int i = 0; i < jam->n; i++)
    thr_write_string(writer, NULL, thr_rise_remedy_words(jam->remedy[i]));
  thr_write_close(writer);
  thr_write_close(writer);
}

void thr_rise_put_json(thr_writer *writer, const thr_rise_seen *seen)
{
  const thr_rise_record *record = &seen->record[0];
  thr_rise_jam jam;
  thr_write_string(writer, "start", thr_rise_start_name(seen->options->start));
  thr_write_int(writer, "pieces", record->n_pieces);
  thr_write_int(writer, "faces", record->n_counted);
  thr_write_number(writer, "weight", record->weight);
  thr_write_number(writer, "seconds_a_frame", record->between);
  thr_write_number(writer, "closed_form", seen->pieces->seated);
  thr_write_number(writer, "limit_analysis", seen->pieces->stands);
  if (seen->after && record->finished) write_left(writer, seen);
  if (thr_rise_jam_find(seen->pieces, record, seen->options, &jam)) write_jam(writer, seen, &jam);
  thr_write_array(writer, "runs");
  for (int i = 0; i < seen->n; i++)
    write_run(writer, seen, i);
  thr_write_close(writer);
}
