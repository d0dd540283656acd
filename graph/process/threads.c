/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Independent jobs in threads of this process; each writes to its own place, so that the outcome is
 * the same whatever the number of threads. Jobs that may crash or must be ended from outside go
 * into forked processes instead (graph/process/workers.c, child.c): threads share what a library
 * breaks.
 *
 *   thr_limits limits = {.threads = 2};
 *   st = thr_threads_run(n_rows, solve_row, rows, &limits, &err);
 *
 * calls solve_row(rows, 0, ..) .. solve_row(rows, n_rows - 1, ..).
 *
 * What libraries allow: an igraph with thread-local storage, nauty's sparse functions and Bullet
 * are used from any thread, each with its own objects. GLPK's environment is the thread's, and a
 * programme lives and dies in the thread that made it: jobs that keep one from run to run need a
 * team. fontconfig is called in a child only. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/threads.h"
#include "graph/plan/plan.h"

#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>

typedef struct {
  pthread_t thread;
  thr_team *team;
  int number; /* 1 .. n - 1; the caller is 0 */
} member;

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
 * ever. So one thread works at a time there. */
#if defined __SANITIZE_ADDRESS__
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

static void take_turn(const thr_team *team)
{
  if (team->n > 1) pthread_mutex_lock(&turn);
}

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

/* ---- outer's functions, from any thread ---- */

static void progress(void *user, const char *what, double best, double bound)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->progress(team->outer->user, what, best, bound);
  pthread_mutex_unlock(&team->speak);
}

static void advance(void *user, const char *what, double done)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->advance(team->outer->user, what, done);
  pthread_mutex_unlock(&team->speak);
}

static void found(void *user, const struct thr_cord *cord, int n_cords,
                  const struct thr_symmetry_record *symmetry)
{
  thr_team *team = user;
  pthread_mutex_lock(&team->speak);
  team->outer->found(team->outer->user, cord, n_cords, symmetry);
  pthread_mutex_unlock(&team->speak);
}

/* ---- a team ---- */

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

static void do_job(thr_team *team, thr_threads_job *run, void *user, int job)
{
  thr_err why = {0};
  const thr_status st = run(user, job, &team->own, &why);
  if (st) note_failure(team, job, st, &why);
}

static void do_jobs(thr_team *team, int number)
{
  take_turn(team);
  for (int job = number; job < team->n_jobs; job += team->n)
    do_job(team, team->run, team->user, job);
  give_turn(team);
}

/* With the team's lock. */
static void be_done(thr_team *team)
{
  if (--team->busy == 0) pthread_cond_signal(&team->done);
}

/* With the team's lock, which it gives back. */
static void wait_for_others(thr_team *team)
{
  while (team->busy > 0)
    pthread_cond_wait(&team->done, &team->lock);
  pthread_mutex_unlock(&team->lock);
}

static void *wait_and_work(void *user)
{
  const member *own = user;
  thr_team *team = own->team;
  pthread_mutex_lock(&team->lock);
  be_done(team);
  for (int seen = 0;;) {
    while (team->runs == seen && !team->over)
      pthread_cond_wait(&team->go, &team->lock);
    if (team->over) break;
    seen = team->runs;
    pthread_mutex_unlock(&team->lock);
    do_jobs(team, own->number);
    pthread_mutex_lock(&team->lock);
    be_done(team);
  }
  pthread_mutex_unlock(&team->lock);
  return NULL;
}

thr_status thr_team_create(thr_team **out, int most, const thr_limits *limits, thr_err *err)
{
  const int allowed = limits->work || most < 1 ? 1 : limits->threads, wanted = allowed <= 1 ? 1
                                                                               : allowed < most
                                                                                   ? allowed
                                                                                   : most;
  thr_team *team = *out = thr_calloc(1, sizeof *team);
  if (!team) return thr_nomem(err);
  *team = (thr_team){.outer = limits,
                     .own = *limits,
                     .n = 1,
                     .member = thr_calloc((size_t)wanted, sizeof *team->member)};
  team->own.threads = 1;
  team->own.user = team;
  team->own.progress = limits->progress ? progress : NULL;
  team->own.advance = limits->advance ? advance : NULL;
  team->own.found = limits->found ? found : NULL;
  pthread_mutex_init(&team->lock, NULL);
  pthread_mutex_init(&team->speak, NULL);
  pthread_cond_init(&team->go, NULL);
  pthread_cond_init(&team->done, NULL);
  pthread_mutex_lock(&team->lock);
  for (; team->member && team->n < wanted; team->n++) {
    member *next = &team->member[team->n - 1];
    *next = (member){.team = team, .number = team->n};
    if (pthread_create(&next->thread, NULL, wait_and_work, next) != 0) break;
    team->busy++;
  }
  wait_for_others(team); /* a thread that is still starting may hold a lock of the allocator's */
  if (team->member) return THR_OK;
  thr_team_destroy(team);
  *out = NULL;
  return thr_nomem(err);
}

void thr_team_destroy(thr_team *team)
{
  if (!team) return;
  pthread_mutex_lock(&team->lock);
  team->over = true;
  pthread_cond_broadcast(&team->go);
  pthread_mutex_unlock(&team->lock);
  for (int i = 0; i < team->n - 1; i++)
    pthread_join(team->member[i].thread, NULL);
  pthread_cond_destroy(&team->go);
  pthread_cond_destroy(&team->done);
  pthread_mutex_destroy(&team->lock);
  pthread_mutex_destroy(&team->speak);
  free(team->member);
  free(team);
}

thr_status thr_team_run(thr_team *team, int n_jobs, thr_threads_job *run, void *user, thr_err *err)
{
  pthread_mutex_lock(&team->lock);
  team->run = run;
  team->user = user;
  team->n_jobs = n_jobs;
  team->failed = INT_MAX;
  team->busy = team->n - 1;
  team->runs++;
  pthread_cond_broadcast(&team->go);
  pthread_mutex_unlock(&team->lock);
  do_jobs(team, 0);
  pthread_mutex_lock(&team->lock);
  wait_for_others(team);
  return team->failed < INT_MAX ? thr_fail(err, team->failure.code, "%s", team->failure.text)
                                : THR_OK;
}

/* ---- whichever is free ---- */

typedef struct {
  thr_team *team;
  thr_threads_job *run;
  void *user;
  int n_jobs, next; /* the job to begin next; of the team's lock */
} queue;

/* The next job, -1 = none. */
static int take(queue *q)
{
  pthread_mutex_lock(&q->team->lock);
  int job = q->team->failed == INT_MAX && q->next < q->n_jobs ? q->next++ : -1;
  pthread_mutex_unlock(&q->team->lock);
  return job;
}

/* A thread's job of the team: as many of the queue as it comes to, the caller's beginning with job
 * 0. */
static thr_status take_jobs(void *user, int number, const thr_limits *limits, thr_err *err)
{
  queue *q = user;
  (void)limits;
  (void)err;
  for (int job = number == 0 && q->n_jobs > 0 ? 0 : take(q); job >= 0; job = take(q))
    do_job(q->team, q->run, q->user, job);
  return THR_OK;
}

thr_status thr_team_share(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                          thr_err *err)
{
  queue q = {.team = team, .run = run, .user = user, .n_jobs = n_jobs, .next = 1};
  return thr_team_run(team, team->n, take_jobs, &q, err);
}

thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits,
                           thr_err *err)
{
  thr_team *team;
  thr_status st = thr_team_create(&team, n_jobs, limits, err);
  if (!st) st = thr_team_share(team, n_jobs, run, user, err);
  thr_team_destroy(team);
  return st;
}

/* ---- beside each other ---- */

typedef struct {
  thr_threads_job *run;
  void *user;
  double left[THR_BESIDE]; /* work of every job */
} counted;

static thr_status run_counted(void *user, int job, const thr_limits *limits, thr_err *err)
{
  counted *c = user;
  const thr_limits own = thr_limits_counted(limits, &c->left[job]);
  return c->run(c->user, job, &own, err);
}

thr_status thr_threads_beside(int n_jobs, thr_threads_job *run, void *user,
                              const thr_limits *limits, thr_err *err)
{
  if (!limits->work) return thr_threads_run(n_jobs, run, user, limits, err);
  counted c = {.run = run, .user = user};
  thr_limits uncounted = *limits;
  double least = thr_limits_work(limits);
  uncounted.work = NULL;
  for (int i = 0; i < n_jobs; i++)
    c.left[i] = least;
  thr_status st = thr_threads_run(n_jobs, run_counted, &c, &uncounted, err);
  for (int i = 0; i < n_jobs; i++)
    least = fmin(least, c.left[i]);
  *limits->work = limits->work_kept + least;
  return st;
}
