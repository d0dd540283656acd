/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Independent jobs beside each other: in threads and teams of threads, or in forked processes.
 * process.h says in which order to read the folder. */
#ifndef THR_THREADS_H
#define THR_THREADS_H

#include "graph/limits.h"
#include "graph/status.h"

/* ---- threads.c: Independent jobs in threads of this process; each writes to its own place, so
 * that the outcome is the same whatever the number of threads. */

/* One job. limits: those of thr_threads_run, for one thread, whose functions may be called from any
 * thread. */
typedef thr_status thr_threads_job(void *user, int job, const thr_limits *limits, thr_err *err);

/* Runs jobs 0 .. n_jobs - 1, begun in this order, in limits->threads threads, this one among them
 * (fewer if the system has no more; one where limits->work counts what they do). After a failure no
 * more are begun: the status and text are those of the failed job of lowest number, the same
 * whatever the number of threads. */
thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;

/* Runs at most THR_BESIDE jobs in the same way, as if each had a processor of its own: where work
 * is counted, each has all that is left, and as much is gone as took the one that took most. */
enum { THR_BESIDE = 4 };
thr_status thr_threads_beside(int n_jobs, thr_threads_job *run, void *user,
                              const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Threads that stay from run to run. */
typedef struct thr_team thr_team;

/* Makes a team of at most `most` threads, this one among them, and at most limits->threads; as
 * above. limits must outlive the team. Release with thr_team_destroy (NULL ok). */
thr_status thr_team_create(thr_team **team, int most, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;
void thr_team_destroy(thr_team *team);

/* Runs jobs 0 .. n_jobs - 1, all of them: job k of every run in the same thread, job 0 in the one
 * that made the team and calls this. Of failures the one of lowest number is told. */
thr_status thr_team_run(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                        thr_err *err) THR_MUST_CHECK;

/* Runs jobs as thr_threads_run does: whichever thread is free takes the next job; job 0 is done in
 * the one that made the team and calls this. */
thr_status thr_team_share(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                          thr_err *err) THR_MUST_CHECK;

/* ---- workers.c: Independent jobs in forked processes; results in fixed order, whatever the number
 * of processes. */

/* Jobs for forked processes. */
typedef struct {
  int n_jobs;
  size_t result_size; /* bytes of one result: plain data without pointers */
  /* Runs in a child process: fills result, or returns a failure whose text is carried back. */
  thr_status (*run)(void *user, int job, void *result, thr_err *err);
  /* Runs in the parent as each job ends, in any order: e.g. to store it in the cache. May be NULL.
   */
  void (*done)(void *user, int job, const void *result);
  void *user;
  const char *what;   /* for the progress line and for messages */
  const char *advice; /* what to do if a child dies, ends its message; NULL: nothing known */
} thr_work;

/* Runs the jobs, and fills results[n_jobs * result_size] and finished[n_jobs]. Stops on the limits
 * (THR_ELIMIT; finished says which results count) and on the first failing job in job order: its
 * status and text, and no later job counts as finished. A child that dies is THR_ESOLVER. processes
 * <= 1 still forks one child at a time, so that a crash in a library cannot take the parent with
 * it. limits->advance is called in the parent with the part of the jobs that is done. No child is
 * left, running or as a zombie. */
thr_status thr_workers_run(const thr_work *work, int processes, const thr_limits *limits,
                           void *results, bool *finished, thr_err *err) THR_MUST_CHECK;

#endif
