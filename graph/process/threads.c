/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs independent jobs in threads of this process. Each job writes to a place of its own, so that
 * the outcome is the same whatever the number of threads. Jobs that may crash, or must be ended
 * from outside, go into forked processes instead (workers.c, child.c): threads share what a library
 * breaks.
 *
 *   thr_limits limits = {.threads = 2};
 *   st = thr_threads_run(n_rows, solve_row, rows, &limits, &err);
 *
 * calls solve_row(rows, 0, ..) .. solve_row(rows, n_rows - 1, ..).
 *
 * A team keeps its threads from run to run. Thread k does jobs k, k + n, k + 2 n, .. of every run,
 * so that a job finds the objects of its thread again; a shared run has one such job per thread,
 * which takes jobs from a queue.
 *
 * What libraries allow: an igraph with thread-local storage, nauty's sparse functions and Bullet
 * are used from any thread, each with its own objects. GLPK's environment is the thread's, and a
 * programme lives and dies in the thread that made it: jobs that keep one from run to run need a
 * team. fontconfig is called in a child only. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"
#include "graph/plan/plan.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>

/* Stands for a thread of a team, other than the caller's. */
typedef struct {
  pthread_t thread;
  thr_team *team;
  int number; /* 1 .. n - 1; the caller is 0 */
} member;

/* Holds a team and its present run. */
struct thr_team {
  const thr_limits *outer;
  thr_limits own; /* of the jobs: outer's functions, one caller at a time */
  int n;          /* threads */
  member *member; /* [n - 1] */
  thr_threads_job *run;
  void *user;
  int n_jobs;
  pthread_mutex_t lock;    /* of what follows */
  pthread_cond_t go, done; /* a run begins, or all is over; a thread is done with its jobs */
  int runs, busy;          /* begun so far; threads that are at work on the last one */
  bool over;
  int failed;            /* lowest failed job; INT_MAX = none */
  thr_err failure;       /* of that job */
  pthread_mutex_t speak; /* of outer's functions */
};

/* ---- one at a time under sanitizers ---- */

/* A job may fork. The address sanitizer's allocator does not wait for other threads at a fork, as
 * malloc does: a child could be born with a lock that another thread holds, and wait or spin for
 * ever. So one thread works at a time in such a build. */
#if defined __SANITIZE_ADDRESS__
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

/* Waits until no other thread works, under the sanitizer. */
static void take_turn(const thr_team *team)
{
  if (team->n > 1) pthread_mutex_lock(&turn);
}

/* Lets the next thread work, under the sanitizer. */
static void give_turn(const thr_team *team)
{
  if (team->n > 1) pthread_mutex_unlock(&turn);
}
#else
static void take_turn(const thr_team *team)
{
  (void)team;
}

static void give_turn(const thr_team *team)
{
  (void)team;
}
#endif

/* ---- the caller's functions, from any thread: one at a time ---- */

/* Tells the caller the best value and bound. */
static void progress(void *user, const char *what, double best, double bound)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->progress(team->outer->user, what, best, bound);
  pthread_mutex_unlock(&team->speak);
}

/* Tells the caller which part is done. */
static void advance(void *user, const char *what, double done)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->advance(team->outer->user, what, done);
  pthread_mutex_unlock(&team->speak);
}

/* Hands a plan to the caller. */
static void found(void *user, const struct thr_cord *cord, int n_cords,
                  const struct thr_symmetry_record *symmetry)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->found(team->outer->user, cord, n_cords, symmetry);
  pthread_mutex_unlock(&team->speak);
}

/* ---- a team ---- */

/* Keeps the failure of the lowest job: the same whatever the order in which jobs end. */
static void note_failure(thr_team *team, int job, thr_status st, const thr_err *why)
{
  pthread_mutex_lock(&team->lock);
  if (job < team->failed) {
    team->failed = job;
    team->failure = *why;
    team->failure.code = st;
  }
  pthread_mutex_unlock(&team->lock);
}

/* Runs one job with the limits of the team. */
static void do_job(thr_team *team, thr_threads_job *run, void *user, int job)
{
  thr_err why = {0};

  /* Failures are gathered, and told when the run is over. */
  const thr_status st = run(user, job, &team->own, &why);
  if (st) note_failure(team, job, st, &why);
}

/* Runs the jobs of thread `number`. */
static void do_jobs(thr_team *team, int number)
{
  take_turn(team);
  for (int job = number; job < team->n_jobs; job += team->n)
    do_job(team, team->run, team->user, job);
  give_turn(team);
}

/* Tells the caller when the last thread is done. The team's lock is held. */
static void be_done(thr_team *team)
{
  if (--team->busy == 0) pthread_cond_signal(&team->done);
}

/* Waits until all other threads are done. The team's lock is held, and released. */
static void wait_for_others(thr_team *team)
{
  while (team->busy > 0)
    pthread_cond_wait(&team->done, &team->lock);
  pthread_mutex_unlock(&team->lock);
}

/* Runs in every thread but the caller's: waits for runs and does their jobs, until the team is
 * over. */
static void *wait_and_work(void *user)
{
  const member *self = user;
  thr_team *team = self->team;

  /* Starting counts as work, which ends here. */
  pthread_mutex_lock(&team->lock);
  be_done(team);

  /* A run begins when their number has grown. */
  for (int seen = 0;;) {
    while (team->runs == seen && !team->over)
      pthread_cond_wait(&team->go, &team->lock);
    if (team->over) break;

    /* The lock is not held during the jobs. */
    seen = team->runs;
    pthread_mutex_unlock(&team->lock);
    do_jobs(team, self->number);
    pthread_mutex_lock(&team->lock);
    be_done(team);
  }

  pthread_mutex_unlock(&team->lock);

  return NULL;
}

/* Makes a team; see threads.h. Fewer threads than wanted are no failure. */
thr_status thr_team_create(thr_team **out, int most, const thr_limits *limits, thr_err *err)
{
  /* Where work is counted, one thread does it all, so that the count is the same on any machine. */
  const int allowed = limits->work || most < 1 ? 1 : limits->threads, wanted = allowed <= 1 ? 1
                                                                               : allowed < most
                                                                                   ? allowed
                                                                                   : most;
  thr_team *team = *out = thr_calloc(1, sizeof *team);
  if (!team) return thr_nomem(err);

  /* One thread so far, the caller's. */
  *team = (thr_team){.outer = limits,
                     .own = *limits,
                     .n = 1,
                     .member = thr_calloc((size_t)wanted, sizeof *team->member)};

  /* Jobs see the caller's limits, with functions that any thread may call. */
  team->own.threads = 1;
  team->own.user = team;
  team->own.progress = limits->progress ? progress : NULL;
  team->own.advance = limits->advance ? advance : NULL;
  team->own.found = limits->found ? found : NULL;

  /* The team is whole, but for its threads. */
  pthread_mutex_init(&team->lock, NULL);
  pthread_mutex_init(&team->speak, NULL);
  pthread_cond_init(&team->go, NULL);
  pthread_cond_init(&team->done, NULL);

  /* Each thread counts as busy until it has started. */
  pthread_mutex_lock(&team->lock);
  for (; team->member && team->n < wanted; team->n++) {
    member *next = &team->member[team->n - 1];
    *next = (member){.team = team, .number = team->n};
    if (pthread_create(&next->thread, NULL, wait_and_work, next) != 0) break;
    team->busy++;
  }

  /* A thread that is still starting may hold a lock of the allocator's, which a fork would copy. */
  wait_for_others(team);
  if (team->member) return THR_OK;

  /* Nothing is left after a failure. */
  thr_team_destroy(team);
  *out = NULL;
  return thr_nomem(err);
}

/* Ends the threads and frees the team; NULL ok. */
void thr_team_destroy(thr_team *team)
{
  if (!team) return;

  /* Wake them up, to end. */
  pthread_mutex_lock(&team->lock);
  team->over = true;
  pthread_cond_broadcast(&team->go);
  pthread_mutex_unlock(&team->lock);

  /* None of them works any more. */
  for (int i = 0; i < team->n - 1; i++)
    pthread_join(team->member[i].thread, NULL);

  pthread_cond_destroy(&team->go);
  pthread_cond_destroy(&team->done);
  pthread_mutex_destroy(&team->lock);
  pthread_mutex_destroy(&team->speak);
  free(team->member);
  free(team);
}

/* Runs jobs in fixed threads; see threads.h. */
thr_status thr_team_run(thr_team *team, int n_jobs, thr_threads_job *run, void *user, thr_err *err)
{
  /* Begin the run. */
  pthread_mutex_lock(&team->lock);
  team->run = run;
  team->user = user;
  team->n_jobs = n_jobs;
  team->failed = INT_MAX;
  team->busy = team->n - 1;
  team->runs++;
  pthread_cond_broadcast(&team->go);
  pthread_mutex_unlock(&team->lock);

  /* The caller is thread 0. */
  do_jobs(team, 0);
  pthread_mutex_lock(&team->lock);
  wait_for_others(team);

  /* Of all failures that of the lowest job is told. */
  return team->failed < INT_MAX ? thr_fail(err, team->failure.code, "%s", team->failure.text)
                                : THR_OK;
}

/* ---- jobs for whichever thread is free ---- */

/* Holds the jobs of a shared run. */
typedef struct {
  thr_team *team;
  thr_threads_job *run;
  void *user;
  int n_jobs, next; /* the job to begin next; of the team's lock */
} queue;

/* Returns the next job, or -1 if there is none, or one has failed. */
static int take(queue *jobs)
{
  pthread_mutex_lock(&jobs->team->lock);
  int job = jobs->team->failed == INT_MAX && jobs->next < jobs->n_jobs ? jobs->next++ : -1;
  pthread_mutex_unlock(&jobs->team->lock);
  return job;
}

/* Does jobs of the queue until there are no more, as one job of a team's thread. The caller begins
 * with job 0. */
static thr_status take_jobs(void *user, int number, const thr_limits *limits, thr_err *err)
{
  /* Failures are noted by do_job, so that this job itself never fails. */
  queue *jobs = user;
  (void)limits;
  (void)err;
  for (int job = number == 0 && jobs->n_jobs > 0 ? 0 : take(jobs); job >= 0; job = take(jobs))
    do_job(jobs->team, jobs->run, jobs->user, job);

  return THR_OK;
}

/* Runs jobs in whichever thread is free; see threads.h. */
thr_status thr_team_share(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                          thr_err *err)
{
  queue jobs = {.team = team, .run = run, .user = user, .n_jobs = n_jobs, .next = 1};

  /* A shared run has one job for every thread of the team. */
  return thr_team_run(team, team->n, take_jobs, &jobs, err);
}

/* Runs jobs in a team of their own; see threads.h. */
thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits,
                           thr_err *err)
{
  /* The team lives as long as the run. */
  thr_team *team;
  thr_status st = thr_team_create(&team, n_jobs, limits, err);
  if (!st) st = thr_team_share(team, n_jobs, run, user, err);

  thr_team_destroy(team);
  return st;
}

/* ---- jobs beside each other, each with all the work that is left ---- */

/* Holds jobs with a count of work for each. */
typedef struct {
  thr_threads_job *run;
  void *user;
  double left[THR_BESIDE]; /* work of every job */
} counted;

/* Runs a job with its own count. */
static thr_status run_counted(void *user, int job, const thr_limits *limits, thr_err *err)
{
  counted *jobs = user;
  const thr_limits own = thr_limits_counted(limits, &jobs->left[job]);
  return jobs->run(jobs->user, job, &own, err);
}

/* Runs jobs as if each had a processor of its own; see threads.h. */
thr_status thr_threads_beside(int n_jobs, thr_threads_job *run, void *user,
                              const thr_limits *limits, thr_err *err)
{
  if (!limits->work) return thr_threads_run(n_jobs, run, user, limits, err);
  counted jobs = {.run = run, .user = user};

  /* Each job may do all that is left .. */
  thr_limits uncounted = *limits;
  double least = thr_limits_work(limits);
  uncounted.work = NULL;

  for (int i = 0; i < n_jobs; i++)
    jobs.left[i] = least;

  thr_status st = thr_threads_run(n_jobs, run_counted, &jobs, &uncounted, err);

  /* .. and as much is gone as the job took that took most. */
  for (int i = 0; i < n_jobs; i++)
    least = fmin(least, jobs.left[i]);
  *limits->work = limits->work_kept + least;
  return st;
}
