/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One job in a child process, with an answer of any size: for libraries that may crash, end the
 * program or take no heed of time.
 *
 * One child process and the messages that it sends: answers, progress, and the end with its status.
 */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double WATCH = 0.1;     /* s between two looks at the limits */
static const double GRACE = 1.0 / 3; /* s that a child has to stop by itself */

/* Kinds of messages. Bytes: the answer, what is being done, or the text of a failure; value: best
 * and bound, the part done, or the work left; code: the status. */
enum { ANSWER, PROGRESS, ADVANCE, END };

struct thr_sender {
  const thr_limits *limits; /* of the parent */
  int fd;
};

/* ---- the child ---- */

static volatile sig_atomic_t told_to_stop;

static void stop(int signal_number)
{
  (void)signal_number;
  told_to_stop = 1;
}

thr_status thr_child_send(thr_sender *to, const thr_text *answer, thr_err *err)
{
  if (answer->failed) return thr_nomem(err);
  if (thr_message_send(to->fd, (thr_message){.kind = ANSWER, .length = answer->length},
                       answer->data))
    return THR_OK;
  return thr_fail(err, THR_ESOLVER, "a worker cannot send its answer: %s", strerror(errno));
}

static void post_progress(void *user, const char *what, double best, double bound)
{
  const thr_sender *to = user;
  thr_message_send(to->fd,
                   (thr_message){.kind = PROGRESS, .length = strlen(what), .value = {best, bound}},
                   what);
}

static void post_advance(void *user, const char *what, double done)
{
  const thr_sender *to = user;
  thr_message_send(to->fd, (thr_message){.kind = ADVANCE, .length = strlen(what), .value = {done}},
                   what);
}

typedef struct {
  const thr_child *child;
  const thr_limits *limits;
} task;

static bool run_job(void *user, int fd)
{
  const task *t = user;
  thr_sender to = {.limits = t->limits, .fd = fd};
  double work = t->limits->work ? *t->limits->work : 0;
  const thr_limits limits = {.deadline = t->limits->deadline,
                             .interrupted = &told_to_stop,
                             .work = t->limits->work ? &work : NULL,
                             .work_kept = t->limits->work_kept,
                             .brief = t->limits->brief,
                             .usual = t->limits->usual,
                             .gap = t->limits->gap,
                             .progress = t->limits->progress ? post_progress : NULL,
                             .advance = t->limits->advance ? post_advance : NULL,
                             .user = &to};
  struct sigaction ask = {.sa_handler = stop};
  thr_err err = {0};
  told_to_stop = t->limits->interrupted && *t->limits->interrupted;
  sigemptyset(&ask.sa_mask);
  sigaction(SIGUSR1, &ask, NULL);
  thr_status st = t->child->run(t->child->user, &limits, &to, &err);
  return thr_message_send(
      fd,
      (thr_message){.kind = END, .length = strlen(err.text), .value = {work}, .code = (int32_t)st},
      err.text);
}

/* ---- the parent ---- */

typedef struct {
  const thr_child *child;
  const thr_limits *limits;
  thr_process process;
  thr_text *answer, arrived; /* bytes not yet taken for a message */
  thr_grace grace;           /* from when the child was asked to stop */
  bool stuck;                /* the child waits for itself */
  bool ended;                /* the message of its end has come, with this status and text */
  thr_err end;
  thr_status status;
} parent;

static void take(void *user, const thr_message *h, const char *bytes)
{
  parent *p = user;
  const thr_limits *l = p->limits;
  char what[200];
  snprintf(what, sizeof what, "%.*s",
           h->length < sizeof what ? (int)h->length : (int)sizeof what - 1, bytes);
  if (h->kind == PROGRESS) l->progress(l->user, what, h->value[0], h->value[1]);
  if (h->kind == ADVANCE) l->advance(l->user, what, h->value[0]);
  if (h->kind == ANSWER) {
    p->answer->length = 0;
    thr_text_append_bytes(p->answer, bytes, h->length);
  }
  if (h->kind == END) {
    p->ended = true;
    p->status = (thr_status)h->code;
    if (p->status) thr_fail(&p->end, p->status, "%.*s", (int)h->length, bytes);
    if (l->work) *l->work = h->value[0];
  }
}

/* false when the child has closed its pipe. */
static bool receive(parent *p)
{
  struct pollfd news = {.fd = p->process.pipe, .events = POLLIN};
  double wait = p->grace.from > 0 ? WATCH : thr_limits_left(p->limits, WATCH);
  if (poll(&news, 1, (int)ceil(1000 * fmin(wait, WATCH))) <= 0) {
    p->stuck = thr_process_stuck(&p->process);
    return true;
  }
  ssize_t n = thr_messages_receive(p->process.pipe, &p->arrived, take, p);
  return n > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN));
}

/* false if the child has not stopped in time and was killed. */
static bool watch(parent *p)
{
  while (!p->arrived.failed && !p->answer->failed && !p->stuck && receive(p)) {
    if (!p->grace.from && thr_limits_left(p->limits, 1) <= 0) { /* what waiting takes is no work */
      p->grace.from = thr_clock();
      kill(p->process.pid, SIGUSR1);
    }
    if (thr_grace_over(&p->grace, p->process.pid, GRACE)) return false;
  }
  return true;
}

static thr_status judge(parent *p, bool stopped, thr_err *err)
{
  char who[200];
  if (p->arrived.failed || p->answer->failed) return thr_nomem(err);
  if (!stopped) return thr_fail(err, THR_ELIMIT, "%s: stopped before it was done", p->child->what);
  if (p->stuck)
    return thr_fail(err, THR_ESOLVER,
                    "%s: its process waited for itself (memory ran out in a library)",
                    p->child->what);
  if (p->ended) return p->status ? thr_fail(err, p->status, "%s", p->end.text) : THR_OK;
  snprintf(who, sizeof who, "%s: its process", p->child->what);
  thr_status st = thr_process_end(&p->process, who, p->child->advice, err);
  return st ? st : thr_fail(err, THR_ESOLVER, "%s: its process sent too little", p->child->what);
}

static thr_status run_once(const thr_child *c, const thr_limits *limits, thr_text *answer,
                           bool *stuck, thr_err *err)
{
  parent p = {.child = c, .limits = limits, .answer = answer};
  task t = {c, limits};
  thr_err reason = {0};
  thr_status st = thr_process_start(&p.process, run_job, &t, &reason);
  if (st) return thr_fail(err, st, "%s: %s", c->what, reason.text);
  bool stopped = watch(&p);
  st = judge(&p, stopped, err);
  *stuck = p.stuck;
  thr_process_kill(&p.process);
  thr_text_destroy(&p.arrived);
  if (answer->failed) thr_text_destroy(answer);
  return st;
}

#if defined __SANITIZE_ADDRESS__
enum { MOST_BIRTHS = 4 };
#else
enum { MOST_BIRTHS = 2 };
#endif

/* A child of a process with several threads may be born with a lock that another thread held (under
 * sanitizers, say), and wait for it for ever: then another one is born. */
thr_status thr_child_run(const thr_child *c, const thr_limits *limits, thr_text *answer,
                         thr_err *err)
{
  thr_err why = {0};
  bool stuck = true;
  thr_status st = THR_ESOLVER;
  for (int i = 0; i < MOST_BIRTHS && stuck && st == THR_ESOLVER; i++) {
    thr_text_destroy(answer);
    st = run_once(c, limits, answer, &stuck, &why);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
