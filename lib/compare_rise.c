/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets plans that are compared rise in simulation (eval/rise/rise.h): every plan in several runs,
 * all of them in parallel processes, and beside that what the limit analysis says of the same
 * pieces.
 *
 * A plan whose pieces cannot be made, or cannot be simulated, leaves its values unknown. */
#include "lib/comparison.h"
#include "lib/rise_pieces.h"

#include <stdio.h>

/* Plan i of n has the pieces pieces[i] and the jobs job[first[i]] and so on. */
typedef struct {
  const thr_compare_rise_asked *asked;
  thr_compare_entry *entry;
  int n;
  thr_rise_pieces *pieces; /* [n] */
  bool *made;              /* [n] */
  thr_rise_job *job;       /* [n * seeds]; those of plans without pieces come last */
  int *first;              /* [n] job; -1 */
  int n_jobs;
} comparison;

/* Makes the pieces of plan i, and its jobs; where that fails, the entry says why. */
static void prepare(comparison *work, int i, const thr_limits *limits)
{
  const thr_kit_options kit = {.names = THR_KIT_NO_NAMES, .coarse = thr_rise_coarse};
  const thr_rise_setting setting = {.ends = THR_PULL_BOTH};
  thr_compare_entry *entry = &work->entry[i];

  work->made[i] = true;
  if (thr_rise_pieces_make(&work->pieces[i], &entry->plan, &kit, &setting, limits,
                           &entry->rise.why))
    return;
  thr_rise_foretell(&work->pieces[i], limits);
  entry->rise.stands = work->pieces[i].stands;

  work->first[i] = work->n_jobs;
  for (int k = 0; k < work->asked->seeds; k++) {
    thr_rise_job *job = &work->job[work->n_jobs++];
    job->structure = &work->pieces[i].made.structure;
    job->options = (thr_rise_options){.start = work->asked->start,
                                      .seed = work->asked->seed + (uint64_t)k,
                                      .pull = work->asked->pull,
                                      .let_down = work->asked->let_down,
                                      .time_step = work->asked->time_step};
  }
}

/* Finds the pass with the widest gap in most of the runs that did not close. */
static void find_jam(const thr_rise_job *job, int n, const thr_rise_pieces *pieces,
                     thr_compare_rise *rise)
{
  const char *name[2] = {"", ""};
  int jam = -1;
  for (int i = 0; i < n; i++) {
    int same = 0;
    if (!job[i].done || job[i].record.closed >= 0) continue;
    for (int k = 0; k < n; k++)
      same +=
          job[k].done && job[k].record.closed < 0 && job[k].record.loosest == job[i].record.loosest;
    if (same < rise->jams || (same == rise->jams && job[i].record.loosest > jam)) continue;
    rise->jams = same;
    jam = job[i].record.loosest;
  }
  if (jam < 0) return;
  thr_rise_pass_names(pieces, jam, name);
  for (int side = 0; side < 2; side++)
    snprintf(rise->jam[side], sizeof rise->jam[side], "%s", name[side]);
}

/* Sums up the runs of plan i; the entry says why the first run failed that did. */
static void sum_up(const comparison *work, int i)
{
  const int n = work->asked->seeds;
  const thr_rise_job *job = &work->job[work->first[i]];
  thr_compare_rise *rise = &work->entry[i].rise;
  double pull[THR_RISE_MOST_SEEDS], closed[THR_RISE_MOST_SEEDS], fall[THR_RISE_MOST_SEEDS];

  for (int k = 0; k < n; k++) {
    if (job[k].status && !rise->why.code)
      thr_fail(&rise->why, job[k].status, "%s", job[k].why.text);
    if (!job[k].done) continue;
    rise->faces = job[k].record.n_counted;
    closed[rise->runs++] = job[k].record.most_closed;
    if (job[k].record.came_up < 0) continue;
    pull[rise->up++] = thr_rise_pull_up(&job[k].record);
    if (job[k].record.fell >= 0) fall[rise->fell++] = thr_rise_pull_down(&job[k].record);
  }

  if (rise->runs > 0) thr_rise_spread(closed, rise->runs, rise->closed);
  if (rise->up > 0) thr_rise_spread(pull, rise->up, rise->pull);
  if (rise->fell > 0) thr_rise_spread(fall, rise->fell, rise->fall);
  find_jam(job, n, &work->pieces[i], rise);
}

/* Prepares all plans, does the runs of all of them together, and sums up. */
static thr_status run(comparison *work, const thr_limits *limits, thr_err *err)
{
  for (int i = 0; i < work->n; i++)
    work->first[i] = -1;
  for (int i = 0; i < work->n; i++) {
    if (thr_limits_stop(limits)) return thr_fail(err, THR_ELIMIT, "stopped before a run");
    prepare(work, i, limits);
  }
  if (work->n_jobs == 0) return THR_OK;

  const thr_status st =
      thr_rise_jobs_run(work->job, work->n_jobs, work->asked->processes, limits, err);
  for (int i = 0; i < work->n; i++)
    if (work->first[i] >= 0) sum_up(work, i);
  return st;
}

thr_status thr_compare_rises(thr_compare_entry *entry, int n, const thr_compare_rise_asked *asked,
                             const thr_limits *limits, thr_err *err)
{
  thr_scratch own = {0};
  comparison work = {.asked = asked, .entry = entry, .n = n};
  work.pieces = thr_scratch_array(&own, (size_t)n, sizeof *work.pieces);
  work.made = thr_scratch_array(&own, (size_t)n, sizeof *work.made);
  work.first = thr_scratch_array(&own, (size_t)n, sizeof *work.first);
  work.job = thr_scratch_array(&own, (size_t)n * (size_t)asked->seeds, sizeof *work.job);

  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = run(&work, limits, err);

  for (int k = 0; k < work.n_jobs; k++)
    thr_rise_record_destroy(&work.job[k].record);
  for (int i = 0; i < n && work.made; i++)
    if (work.made[i]) thr_rise_pieces_destroy(&work.pieces[i]);
  thr_scratch_free(&own);
  return st;
}
