/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs independent jobs in forked processes. Results lie in the order of the jobs, whatever the
 * number of processes.
 *
 * Each slot has one child at a time, which runs one job, sends a message and, if the job did not
 * fail, its result of fixed size, and ends. The parent waits for all pipes with poll().
 *
 * Of several failures the one of the job with the lowest number counts, so that it does not depend
 * on the number of processes either: when a job fails, the children of later jobs are killed, and
 * those of earlier ones go on. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double WATCH = 0.1; /* s between two looks at the limits */

/* Heads what a child sends; the result follows if status is THR_OK. */
typedef struct {
  _Alignas(max_align_t) int32_t status; /* so that a result of any type may follow */
  char text[sizeof((thr_err *)0)->text];
} message;

/* Holds one child at a time, and what it has sent. */
typedef struct {
  thr_process process; /* none = free */
  int job;
  size_t received;
  char *data; /* message and result */
} slot;

/* Holds all jobs, and their children. */
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

/* Says which job a child is to do. */
typedef struct {
  const pool *jobs;
  const slot *slot;
} task;

/* Runs in the child: runs the job and sends message and result. */
static bool run_job(void *user, int fd)
{
  const task *own = user;
  const pool *jobs = own->jobs;

  /* The result follows the message. */
  message *head = (message *)(void *)own->slot->data;
  void *result = own->slot->data + sizeof *head;
  thr_err err = {0};

  /* No byte of the parent's memory is sent by mistake. */
  memset(own->slot->data, 0, jobs->size);
  head->status = (int32_t)jobs->work->run(jobs->work->user, own->slot->job, result, &err);
  memcpy(head->text, err.text, sizeof head->text);

  return thr_process_send(fd, own->slot->data, head->status == THR_OK ? jobs->size : sizeof *head);
}

/* Starts the next job in a free slot. */
static thr_status start(pool *jobs, slot *place, thr_err *err)
{
  *place = (slot){.job = jobs->next, .data = place->data};
  thr_status st = thr_process_start(&place->process, run_job, &(task){jobs, place}, err);
  if (!st) jobs->next++;
  return st;
}

/* Kills the children of jobs from `first` on. */
static void kill_from(pool *jobs, int first)
{
  for (int i = 0; i < jobs->n_slots; i++)
    if (jobs->slot[i].job >= first) thr_process_kill(&jobs->slot[i].process);
}

/* Returns what came of the job whose child has closed its pipe. */
static thr_status judge(const pool *jobs, slot *place, thr_err *err)
{
  char who[200];
  const message *head = (const message *)(const void *)place->data;

  snprintf(who, sizeof who, "%s: the process of job %d", jobs->work->what, place->job + 1);

  /* Why the child ended counts only if it has not sent everything. */
  thr_err death = {0};
  thr_status st = thr_process_end(&place->process, who, jobs->work->advice, &death);

  if (place->received == jobs->size && head->status == THR_OK) return THR_OK;
  if (place->received == sizeof *head && head->status != THR_OK)
    return thr_fail(err, (thr_status)head->status, "%.*s", (int)sizeof head->text - 1, head->text);

  return thr_fail(err, st ? st : THR_ESOLVER, "%s", st ? death.text : "a worker sent too little");
}

/* Ends the job of a slot whose child has closed its pipe: keeps the result, or the failure. */
static void end_job(pool *jobs, slot *place)
{
  thr_err err = {0};
  if (judge(jobs, place, &err)) {
    /* Lower than any failure before: later jobs were killed then. */
    jobs->failed = place->job;
    *jobs->failure = err;
    kill_from(jobs, place->job + 1);
    return;
  }

  /* The result goes to its place in the caller's array. */
  char *result = jobs->results + (size_t)place->job * jobs->work->result_size;
  if (jobs->work->result_size)
    memcpy(result, place->data + sizeof(message), jobs->work->result_size);
  jobs->finished[place->job] = true;
  jobs->n_finished++;

  /* The caller may store it, and hears how far the work is. */
  if (jobs->work->done) jobs->work->done(jobs->work->user, place->job, result);
  if (jobs->limits->advance)
    jobs->limits->advance(jobs->limits->user, jobs->work->what,
                          (double)jobs->n_finished / jobs->work->n_jobs);
}

/* Reads what a child has sent. */
static void receive(pool *jobs, slot *place)
{
  char beyond;

  /* A child that sends more than it should is read, too, and does not count. */
  size_t missing = jobs->size - place->received;
  ssize_t n = read(place->process.pipe, missing ? place->data + place->received : &beyond,
                   missing ? missing : 1);
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;

  if (n > 0 && missing)
    place->received += (size_t)n;
  else
    end_job(jobs, place);
}

/* Waits for news of the children, or until it is time to look at the limits. */
static void serve(pool *jobs)
{
  nfds_t n = 0;

  /* Watch the pipes of all children. */
  for (int i = 0; i < jobs->n_slots; i++)
    if (jobs->slot[i].process.pid)
      jobs->watch[n++] = (struct pollfd){.fd = jobs->slot[i].process.pipe, .events = POLLIN};
  if (poll(jobs->watch, n, (int)ceil(1000 * thr_limits_left(jobs->limits, WATCH))) <= 0) return;

  /* Any event, even the end of a pipe, is read. */
  for (nfds_t k = 0; k < n; k++)
    for (int i = 0; i < jobs->n_slots && jobs->watch[k].revents; i++)
      if (jobs->slot[i].process.pid && jobs->slot[i].process.pipe == jobs->watch[k].fd) {
        receive(jobs, &jobs->slot[i]);
        break;
      }
}

/* Returns the number of children. */
static int running(const pool *jobs)
{
  int n = 0;
  for (int i = 0; i < jobs->n_slots; i++)
    n += jobs->slot[i].process.pid != 0;
  return n;
}

/* Starts jobs in order while there are free slots, and none has failed. That the system has no more
 * processes or pipes is only a failure if there is no child to wait for. */
static thr_status fill_slots(pool *jobs, thr_err *err)
{
  for (int i = 0;
       i < jobs->n_slots && jobs->next < jobs->work->n_jobs && jobs->failed == jobs->work->n_jobs;
       i++) {
    if (jobs->slot[i].process.pid) continue;

    thr_err reason = {0};
    thr_status st = start(jobs, &jobs->slot[i], &reason);
    if (st && running(jobs)) return THR_OK;
    if (st) return thr_fail(err, st, "%s: %s", jobs->work->what, reason.text);
  }

  return THR_OK;
}

/* Serves the children until all jobs are finished, one has failed, or a limit is reached. */
static thr_status run_pool(pool *jobs, thr_err *err)
{
  const int n_jobs = jobs->work->n_jobs;
  for (;;) {
    /* The limits. What waiting takes is no work. */
    if (jobs->n_finished < n_jobs && thr_limits_left(jobs->limits, 1) <= 0) {
      kill_from(jobs, 0);
      return thr_fail(err, THR_ELIMIT, "%s: stopped after %d of %d", jobs->work->what,
                      jobs->n_finished, n_jobs);
    }

    /* Children for the jobs that are not begun, then news of any child. */
    thr_status st = fill_slots(jobs, err);
    if (st) return st;
    if (!running(jobs)) break;
    serve(jobs);
  }

  /* No job after the failed one counts as finished. */
  if (jobs->failed == n_jobs) return THR_OK;
  memset(jobs->finished + jobs->failed, 0,
         (size_t)(n_jobs - jobs->failed) * sizeof *jobs->finished);

  return thr_fail(err, jobs->failure->code, "%s", jobs->failure->text);
}

/* Runs jobs in forked processes; see threads.h. */
thr_status thr_workers_run(const thr_work *work, int processes, const thr_limits *limits,
                           void *results, bool *finished, thr_err *err)
{
  thr_err failure = {0};

  /* No more slots than jobs. */
  int n_slots = processes < 1 ? 1 : processes < work->n_jobs ? processes : work->n_jobs;
  memset(finished, 0, (size_t)work->n_jobs * sizeof *finished);
  if (work->n_jobs == 0) return THR_OK;

  /* Message and result of each slot are aligned for any type. */
  const size_t align = sizeof(max_align_t), size = sizeof(message) + work->result_size;
  const size_t stride = (size + align - 1) / align * align;
  pool jobs = {.work = work,
               .limits = limits,
               .size = size,
               .n_slots = n_slots,
               .slot = thr_calloc((size_t)n_slots, sizeof *jobs.slot),
               .watch = thr_calloc((size_t)n_slots, sizeof *jobs.watch),
               .data = thr_calloc((size_t)n_slots, stride),
               .results = results,
               .finished = finished,
               .failed = work->n_jobs,
               .failure = &failure};

  /* Each slot has its part of one block. */
  thr_status st = THR_OK;
  if (!jobs.slot || !jobs.watch || !jobs.data) st = thr_nomem(err);
  for (int i = 0; i < n_slots && !st; i++)
    jobs.slot[i].data = jobs.data + (size_t)i * stride;

  /* Whatever happened, no child is left. */
  if (!st) st = run_pool(&jobs, err);
  if (jobs.slot) kill_from(&jobs, 0);

  free(jobs.slot);
  free(jobs.watch);
  free(jobs.data);
  return st;
}
