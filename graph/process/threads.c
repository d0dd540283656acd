/* A pool of threads that take the next job each. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/threads.h"
#include "graph/plan/plan.h"

#include <pthread.h>
#include <stdlib.h>

typedef struct {
  thr_threads_job *run;
  void *user;
  const thr_limits *outer;
  thr_limits own;        /* of the jobs: outer's functions, one caller at a time */
  pthread_mutex_t lock;  /* of what follows */
  int n_jobs, next;      /* the job to begin next */
  int failed;            /* lowest failed job; n_jobs = none */
  thr_err failure;       /* of that job */
  pthread_mutex_t speak; /* of outer's functions */
} pool;

/* ---- outer's functions, from any thread ---- */

static void progress(void *user, const char *what, double best, double bound)
{
  pool *p = user;
  pthread_mutex_lock(&p->speak);
  p->outer->progress(p->outer->user, what, best, bound);
  pthread_mutex_unlock(&p->speak);
}

static void advance(void *user, const char *what, double done)
{
  pool *p = user;
  pthread_mutex_lock(&p->speak);
  p->outer->advance(p->outer->user, what, done);
  pthread_mutex_unlock(&p->speak);
}

static void found(void *user, const struct thr_cord *cord, int n_cords, const struct thr_symmetry_record *symmetry)
{
  pool *p = user;
  pthread_mutex_lock(&p->speak);
  p->outer->found(p->outer->user, cord, n_cords, symmetry);
  pthread_mutex_unlock(&p->speak);
}

/* ---- the jobs ---- */

/* The next job, -1 = none. */
static int take(pool *p)
{
  pthread_mutex_lock(&p->lock);
  int job = p->failed == p->n_jobs && p->next < p->n_jobs ? p->next++ : -1;
  pthread_mutex_unlock(&p->lock);
  return job;
}

static void note_failure(pool *p, int job, thr_status st, const thr_err *why)
{
  pthread_mutex_lock(&p->lock);
  if (job < p->failed) {
    p->failed = job;
    p->failure = *why;
    p->failure.code = st;
  }
  pthread_mutex_unlock(&p->lock);
}

static void *work(void *user)
{
  pool *p = user;
  for (int job; (job = take(p)) >= 0;) {
    thr_err why = {0};
    const thr_status st = p->run(p->user, job, &p->own, &why);
    if (st) note_failure(p, job, st, &why);
  }
  return NULL;
}

thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits, thr_err *err)
{
  pool p = {.run = run, .user = user, .outer = limits, .own = *limits, .n_jobs = n_jobs, .failed = n_jobs};
  int n = limits->threads < n_jobs ? limits->threads : n_jobs, begun = 0;
  pthread_t *thread = n > 1 && !limits->work ? malloc((size_t)(n - 1) * sizeof *thread) : NULL;
  p.own.threads = 1;
  p.own.user = &p;
  p.own.progress = limits->progress ? progress : NULL;
  p.own.advance = limits->advance ? advance : NULL;
  p.own.found = limits->found ? found : NULL;
  pthread_mutex_init(&p.lock, NULL);
  pthread_mutex_init(&p.speak, NULL);
  while (thread && begun < n - 1 && pthread_create(&thread[begun], NULL, work, &p) == 0)
    begun++;
  work(&p);
  for (int i = 0; i < begun; i++)
    pthread_join(thread[i], NULL);
  pthread_mutex_destroy(&p.lock);
  pthread_mutex_destroy(&p.speak);
  free(thread);
  return p.failed < n_jobs ? thr_fail(err, p.failure.code, "%s", p.failure.text) : THR_OK;
}
