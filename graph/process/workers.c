/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Independent jobs in forked processes; results in fixed order, whatever the number of processes.
 */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/threads.h"
#include "graph/process/process.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double WATCH = 0.1; /* s between two looks at the limits */

/* What a child sends, followed by the result if status is THR_OK. */
typedef struct {
  _Alignas(max_align_t) int32_t status; /* so that a result of any type may follow */
  char text[sizeof((thr_err *)0)->text];
} message;

typedef struct {
  thr_process process; /* none = free */
  int job;
  size_t received;
  char *data; /* message and result */
} slot;

typedef struct {
  const thr_work *work;
  const thr_limits *limits;
  size_t size; /* of message and result */
  int n_slots;
  slot *slot;
  struct pollfd *watch;
  char *data; /* of all slots */
  char *results;
  bool *finished;
  int n_finished, next; /* jobs finished; next job to start */
  int failed;           /* lowest failed job, or n_jobs */
  thr_err *failure;     /* of that job */
} pool;

typedef struct {
  const pool *pool;
  const slot *slot;
} task;

static bool run_job(void *user, int fd)
{
  const task *t = user;
  const pool *p = t->pool;
  message *head = (message *)(void *)t->slot->data;
  void *result = t->slot->data + sizeof *head;
  thr_err err = {0};
  memset(t->slot->data, 0, p->size);
  head->status = (int32_t)p->work->run(p->work->user, t->slot->job, result, &err);
  memcpy(head->text, err.text, sizeof head->text);
  return thr_process_send(fd, t->slot->data, head->status == THR_OK ? p->size : sizeof *head);
}

static thr_status start(pool *p, slot *s, thr_err *err)
{
  *s = (slot){.job = p->next, .data = s->data};
  thr_status st = thr_process_start(&s->process, run_job, &(task){p, s}, err);
  if (!st) p->next++;
  return st;
}

/* Ends the children of jobs from `first` on. */
static void kill_from(pool *p, int first)
{
  for (int i = 0; i < p->n_slots; i++)
    if (p->slot[i].job >= first) thr_process_kill(&p->slot[i].process);
}

/* What came of the job whose child has closed its pipe. */
static thr_status judge(const pool *p, slot *s, thr_err *err)
{
  char who[200];
  const message *head = (const message *)(const void *)s->data;
  snprintf(who, sizeof who, "%s: the process of job %d", p->work->what, s->job + 1);
  thr_err death = {0};
  thr_status st = thr_process_end(&s->process, who, p->work->advice, &death);
  if (s->received == p->size && head->status == THR_OK) return THR_OK;
  if (s->received == sizeof *head && head->status != THR_OK)
    return thr_fail(err, (thr_status)head->status, "%.*s", (int)sizeof head->text - 1, head->text);
  return thr_fail(err, st ? st : THR_ESOLVER, "%s", st ? death.text : "a worker sent too little");
}

/* The child has closed its pipe. */
static void end_job(pool *p, slot *s)
{
  thr_err err = {0};
  if (judge(p, s, &err)) {
    p->failed = s->job; /* lower than any before: those above were killed then */
    *p->failure = err;
    kill_from(p, s->job + 1);
    return;
  }
  char *result = p->results + (size_t)s->job * p->work->result_size;
  if (p->work->result_size) memcpy(result, s->data + sizeof(message), p->work->result_size);
  p->finished[s->job] = true;
  p->n_finished++;
  if (p->work->done) p->work->done(p->work->user, s->job, result);
  if (p->limits->advance)
    p->limits->advance(p->limits->user, p->work->what, (double)p->n_finished / p->work->n_jobs);
}

static void receive(pool *p, slot *s)
{
  char beyond;
  size_t room = p->size - s->received;
  ssize_t n = read(s->process.pipe, room ? s->data + s->received : &beyond, room ? room : 1);
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (n > 0 && room)
    s->received += (size_t)n;
  else
    end_job(p, s);
}

/* Waits for news of the children, or until it is time to look at the limits. */
static void serve(pool *p)
{
  nfds_t n = 0;
  for (int i = 0; i < p->n_slots; i++)
    if (p->slot[i].process.pid)
      p->watch[n++] = (struct pollfd){.fd = p->slot[i].process.pipe, .events = POLLIN};
  if (poll(p->watch, n, (int)ceil(1000 * thr_limits_left(p->limits, WATCH))) <= 0) return;
  for (nfds_t k = 0; k < n; k++)
    for (int i = 0; i < p->n_slots && p->watch[k].revents; i++)
      if (p->slot[i].process.pid && p->slot[i].process.pipe == p->watch[k].fd) {
        receive(p, &p->slot[i]);
        break;
      }
}

static int running(const pool *p)
{
  int n = 0;
  for (int i = 0; i < p->n_slots; i++)
    n += p->slot[i].process.pid != 0;
  return n;
}

/* Starts jobs in order while there are free slots. Too few processes or pipes is only a failure if
 * none is left to wait for. */
static thr_status fill_slots(pool *p, thr_err *err)
{
  for (int i = 0; i < p->n_slots && p->next < p->work->n_jobs && p->failed == p->work->n_jobs;
       i++) {
    if (p->slot[i].process.pid) continue;
    thr_err reason = {0};
    thr_status st = start(p, &p->slot[i], &reason);
    if (st && running(p)) return THR_OK;
    if (st) return thr_fail(err, st, "%s: %s", p->work->what, reason.text);
  }
  return THR_OK;
}

static thr_status run_pool(pool *p, thr_err *err)
{
  const int n_jobs = p->work->n_jobs;
  for (;;) {
    if (p->n_finished < n_jobs &&
        thr_limits_left(p->limits, 1) <= 0) { /* what waiting takes is no work */
      kill_from(p, 0);
      return thr_fail(err, THR_ELIMIT, "%s: stopped after %d of %d", p->work->what, p->n_finished,
                      n_jobs);
    }
    thr_status st = fill_slots(p, err);
    if (st) return st;
    if (!running(p)) break;
    serve(p);
  }
  if (p->failed == n_jobs) return THR_OK;
  memset(p->finished + p->failed, 0, (size_t)(n_jobs - p->failed) * sizeof *p->finished);
  return thr_fail(err, p->failure->code, "%s", p->failure->text);
}

thr_status thr_workers_run(const thr_work *w, int processes, const thr_limits *limits,
                           void *results, bool *finished, thr_err *err)
{
  thr_err failure = {0};
  int n_slots = processes < 1 ? 1 : processes < w->n_jobs ? processes : w->n_jobs;
  memset(finished, 0, (size_t)w->n_jobs * sizeof *finished);
  if (w->n_jobs == 0) return THR_OK;
  const size_t align = sizeof(max_align_t), size = sizeof(message) + w->result_size;
  const size_t stride = (size + align - 1) / align * align;
  pool p = {.work = w,
            .limits = limits,
            .size = size,
            .n_slots = n_slots,
            .slot = thr_calloc((size_t)n_slots, sizeof *p.slot),
            .watch = thr_calloc((size_t)n_slots, sizeof *p.watch),
            .data = thr_calloc((size_t)n_slots, stride),
            .results = results,
            .finished = finished,
            .failed = w->n_jobs,
            .failure = &failure};
  thr_status st = THR_OK;
  if (!p.slot || !p.watch || !p.data) st = thr_nomem(err);
  for (int i = 0; i < n_slots && !st; i++)
    p.slot[i].data = p.data + (size_t)i * stride;
  if (!st) st = run_pool(&p, err);
  if (p.slot) kill_from(&p, 0);
  free(p.slot);
  free(p.watch);
  free(p.data);
  return st;
}
