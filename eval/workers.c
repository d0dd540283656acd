/* A pool of forked processes, one per job, each with a pipe that carries its result back. */
#define _POSIX_C_SOURCE 200809L
#include "eval/workers.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

static const double WATCH = 0.1; /* s between two looks at the limits */

/* What a child sends, followed by the result if status is THR_OK. */
typedef struct {
  _Alignas(max_align_t) int32_t status; /* so that a result of any type may follow */
  char text[sizeof((thr_err *)0)->text];
} message;

typedef struct {
  pid_t pid; /* 0 = free */
  int job, pipe;
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

static bool send_all(int fd, const char *data, size_t n)
{
  while (n > 0) {
    ssize_t sent = write(fd, data, n);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    n -= (size_t)sent;
  }
  return true;
}

/* Ctrl-C goes to the whole process group: the parent decides what to do about it. A parent that is gone ends the child by
 * SIGPIPE at the latest when it answers. */
static void leave_signals_to_parent(const sigset_t *mask)
{
  signal(SIGINT, SIG_IGN);
  signal(SIGTERM, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGPIPE, SIG_DFL);
  sigprocmask(SIG_SETMASK, mask, NULL);
}

/* Never returns: neither the parent's buffered output nor its exit handlers may run twice. */
static void run_child(const pool *p, const slot *s, int fd)
{
  message *head = (message *)(void *)s->data;
  void *result = s->data + sizeof *head;
  thr_err err = {0};
  memset(s->data, 0, p->size);
  head->status = (int32_t)p->work->run(p->work->user, s->job, result, &err);
  memcpy(head->text, err.text, sizeof head->text);
  _exit(send_all(fd, s->data, head->status == THR_OK ? p->size : sizeof *head) ? 0 : 1);
}

/* THR_ESOLVER if the system gives no pipe or process. */
static thr_status start(pool *p, slot *s, thr_err *err)
{
  int fd[2];
  sigset_t all, old;
  if (pipe(fd)) return thr_fail(err, THR_ESOLVER, "cannot start a worker: %s; close other programs", strerror(errno));
  *s = (slot){.job = p->next, .pipe = fd[0], .data = s->data};
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &old); /* or a signal would run the parent's handler in the child */
  s->pid = fork();
  if (s->pid == 0) {
    close(fd[0]);
    leave_signals_to_parent(&old);
    run_child(p, s, fd[1]);
  }
  int reason = errno;
  sigprocmask(SIG_SETMASK, &old, NULL);
  close(fd[1]);
  if (s->pid < 0) {
    s->pid = 0;
    close(fd[0]);
    return thr_fail(err, THR_ESOLVER, "cannot start a worker: %s; close other programs or ask for fewer processes",
                    strerror(reason));
  }
  p->next++;
  return THR_OK;
}

/* Waits for the child and frees its slot; its wait status, or -1 if somebody else has reaped it. */
static int reap(slot *s)
{
  int status;
  pid_t got;
  close(s->pipe);
  while ((got = waitpid(s->pid, &status, 0)) < 0 && errno == EINTR)
    continue;
  s->pid = 0;
  return got < 0 ? -1 : status;
}

/* Ends the children of jobs from `first` on. */
static void kill_from(pool *p, int first)
{
  for (int i = 0; i < p->n_slots; i++)
    if (p->slot[i].pid && p->slot[i].job >= first) kill(p->slot[i].pid, SIGKILL);
  for (int i = 0; i < p->n_slots; i++)
    if (p->slot[i].pid && p->slot[i].job >= first) reap(&p->slot[i]);
}

static thr_status judge(const pool *p, const slot *s, int wait_status, thr_err *err)
{
  const message *head = (const message *)(const void *)s->data;
  if (s->received == p->size && head->status == THR_OK) return THR_OK;
  if (s->received == sizeof *head && head->status != THR_OK)
    return thr_fail(err, (thr_status)head->status, "%.*s", (int)sizeof head->text - 1, head->text);
  if (wait_status != -1 && WIFSIGNALED(wait_status))
    return thr_fail(err, THR_ESOLVER, "%s: the process of job %d died of signal %d (%s); use --method capstan", p->work->what,
                    s->job + 1, WTERMSIG(wait_status), strsignal(WTERMSIG(wait_status)));
  return thr_fail(err, THR_ESOLVER, "%s: the process of job %d ended without a result; use --method capstan", p->work->what,
                  s->job + 1);
}

/* The child has closed its pipe. */
static void end_job(pool *p, slot *s)
{
  thr_err err = {0};
  int wait_status = reap(s);
  if (judge(p, s, wait_status, &err)) {
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
  if (p->limits->advance) p->limits->advance(p->limits->user, p->work->what, (double)p->n_finished / p->work->n_jobs);
}

static void receive(pool *p, slot *s)
{
  char beyond;
  size_t room = p->size - s->received;
  ssize_t n = read(s->pipe, room ? s->data + s->received : &beyond, room ? room : 1);
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
    if (p->slot[i].pid) p->watch[n++] = (struct pollfd){.fd = p->slot[i].pipe, .events = POLLIN};
  if (poll(p->watch, n, (int)ceil(1000 * thr_limits_left(p->limits, WATCH))) <= 0) return;
  for (nfds_t k = 0; k < n; k++)
    for (int i = 0; i < p->n_slots && p->watch[k].revents; i++)
      if (p->slot[i].pid && p->slot[i].pipe == p->watch[k].fd) {
        receive(p, &p->slot[i]);
        break;
      }
}

static int running(const pool *p)
{
  int n = 0;
  for (int i = 0; i < p->n_slots; i++)
    n += p->slot[i].pid != 0;
  return n;
}

/* Starts jobs in order while there are free slots. Too few processes or pipes is only a failure if none is left to wait for. */
static thr_status fill_slots(pool *p, thr_err *err)
{
  for (int i = 0; i < p->n_slots && p->next < p->work->n_jobs && p->failed == p->work->n_jobs; i++) {
    if (p->slot[i].pid) continue;
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
    if (p->n_finished < n_jobs && thr_limits_stop(p->limits)) {
      kill_from(p, 0);
      return thr_fail(err, THR_ELIMIT, "%s: stopped after %d of %d", p->work->what, p->n_finished, n_jobs);
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

thr_status thr_workers_run(const thr_work *w, int processes, const thr_limits *limits, void *results, bool *finished,
                           thr_err *err)
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
