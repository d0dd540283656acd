/* Independent jobs in threads of this process; each writes to its own place, so that the outcome is the same whatever the number
 * of threads. Jobs that may crash or must be ended from outside go into forked processes instead (graph/process/workers.h,
 * child.h): threads share what a library breaks.
 *
 *   thr_limits limits = {.threads = 2};
 *   st = thr_threads_run(n_rows, solve_row, rows, &limits, &err);   solve_row(rows, 0, ..) .. solve_row(rows, n_rows - 1, ..)
 *
 * What libraries allow: an igraph with thread-local storage, nauty's sparse functions and Bullet are used from any thread, each
 * with its own objects. GLPK's environment is the thread's, and a programme lives and dies in the thread that made it: jobs that
 * keep one from run to run need a team. fontconfig is called in a child only. */
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

/* The same of at most THR_BESIDE jobs, as if each had a processor of its own: where work is counted, each has all that is left,
 * and as much is gone as took the one that took most. */
enum { THR_BESIDE = 4 };
thr_status thr_threads_beside(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits,
                              thr_err *err) THR_MUST_CHECK;

/* Threads that stay from run to run. */
typedef struct thr_team thr_team;

/* At most `most` threads, this one among them, and at most limits->threads; as above. limits must outlive the team. Release with
 * thr_team_destroy (NULL ok). */
thr_status thr_team_create(thr_team **team, int most, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_team_destroy(thr_team *team);

/* Runs jobs 0 .. n_jobs - 1, all of them: job k of every run in the same thread, job 0 in the one that made the team and calls
 * this. Of failures the one of lowest number is told. */
thr_status thr_team_run(thr_team *team, int n_jobs, thr_threads_job *run, void *user, thr_err *err) THR_MUST_CHECK;

/* As thr_threads_run: whichever thread is free takes the next job; job 0 is done in the one that made the team and calls this. */
thr_status thr_team_share(thr_team *team, int n_jobs, thr_threads_job *run, void *user, thr_err *err) THR_MUST_CHECK;

#endif
