/* Independent jobs in threads of this process; each writes to its own place, so that the outcome is the same whatever the number
 * of threads. For jobs that may crash or must be ended from outside see graph/process/workers.h and child.h.
 *
 *   thr_limits limits = {.threads = 2};
 *   st = thr_threads_run(n_rows, solve_row, rows, &limits, &err);   solve_row(rows, 0, ..) .. solve_row(rows, n_rows - 1, ..) */
#ifndef THR_THREADS_H
#define THR_THREADS_H

#include "graph/limits.h"
#include "graph/status.h"

/* One job. limits: those of thr_threads_run, for one thread, whose functions may be called from any thread. */
typedef thr_status thr_threads_job(void *user, int job, const thr_limits *limits, thr_err *err);

/* Runs jobs 0 .. n_jobs - 1, begun in this order, in limits->threads threads, this one among them (fewer if the system has no
 * more; one where limits->work counts what they do). After a failure no more are begun: the status and text are those of the
 * failed job of lowest number, the same whatever the number of threads. */
thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

#endif
