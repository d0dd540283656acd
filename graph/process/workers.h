/* Independent jobs in forked processes; results in fixed order, whatever the number of processes. */
#ifndef THR_WORKERS_H
#define THR_WORKERS_H

#include "graph/limits.h"
#include "graph/status.h"

typedef struct {
  int n_jobs;
  size_t result_size; /* bytes of one result: plain data without pointers */
  /* Runs in a child process: fills result, or returns a failure whose text is carried back. */
  thr_status (*run)(void *user, int job, void *result, thr_err *err);
  /* Runs in the parent as each job ends, in any order: e.g. to store it in the cache. May be NULL. */
  void (*done)(void *user, int job, const void *result);
  void *user;
  const char *what;   /* for the progress line and for messages */
  const char *advice; /* what to do if a child dies, ends its message; NULL: nothing known */
} thr_work;

/* Fills results[n_jobs * result_size] and finished[n_jobs]. Stops on the limits (THR_ELIMIT; finished says which results count)
 * and on the first failing job in job order: its status and text, and no later job counts as finished. A child that dies is
 * THR_ESOLVER. processes <= 1 still forks one child at a time, so that a crash in a library cannot take the parent with it.
 * limits->advance is called in the parent with the part of the jobs that is done. No child is left, running or as a zombie. */
thr_status thr_workers_run(const thr_work *w, int processes, const thr_limits *limits, void *results, bool *finished,
                           thr_err *err) THR_MUST_CHECK;

#endif
