/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs one job in a child process, with an answer of any size: for libraries that may crash, end
 * the program or take no heed of time.
 *
 * The child sends messages: answers, of which the last one counts, progress, and its end with
 * status and text. At a limit the parent asks the child to stop by SIGUSR1, which the child's
 * limits see as an interrupt, and kills it a third of a second later. Whatever was sent last is the
 * best so far. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double WATCH = 0.05;    /* s between two looks at the limits */
static const double GRACE = 1.0 / 3; /* s that a child has to stop by itself */

/* Kinds of messages. Bytes: the answer, what is being done, or the text of a failure; value: best
 * and bound, the part done, or the work left; code: the status. */
enum { ANSWER, PROGRESS, ADVANCE, END };

/* Leads from a child to its parent. */
struct thr_sender {
  const thr_limits *limits; /* of the parent */
  int fd;
};

/* ---- the child ---- */

static volatile sig_atomic_t told_to_stop;

/* Handles SIGUSR1. */
static void stop(int signal_number)
{
  (void)signal_number;
  told_to_stop = 1;
}

/* Sends an answer in place of the one before; see process.h. */
thr_status thr_child_send(thr_sender *to, const thr_text *answer, thr_err *err)
{
  if (answer->failed) return thr_nomem(err);

  if (thr_message_send(to->fd, (thr_message){.kind = ANSWER, .length = answer->length},
                       answer->data))
    return THR_OK;

  return thr_fail(err, THR_ESOLVER, "a worker cannot send its answer: %s", strerror(errno));
}

/* Sends progress to the parent. */
static void post_progress(void *user, const char *what, double best, double bound)
{
  const thr_sender *to = user;
  thr_message_send(to->fd,
                   (thr_message){.kind = PROGRESS, .length = strlen(what), .value = {best, bound}},
                   what);
}

/* Sends the part done to the parent. */
static void post_advance(void *user, const char *what, double done)
{
  const thr_sender *to = user;
  thr_message_send(to->fd, (thr_message){.kind = ADVANCE, .length = strlen(what), .value = {done}},
                   what);
}

/* Says what the child is to do. */
typedef struct {
  const thr_child *job;
  const thr_limits *limits;
} task;

/* Runs in the child: runs the job with limits like the parent's, and sends how it ended. */
static bool run_job(void *user, int fd)
{
  const task *own = user;

  /* The parent's functions become messages; its interrupt, a flag of the child's own. */
  thr_sender to = {.limits = own->limits, .fd = fd};
  double work = own->limits->work ? *own->limits->work : 0;
  const thr_limits limits = {.deadline = own->limits->deadline,
                             .interrupted = &told_to_stop,
                             .work = own->limits->work ? &work : NULL,
                             .work_kept = own->limits->work_kept,
                             .brief = own->limits->brief,
                             .usual = own->limits->usual,
                             .gap = own->limits->gap,
                             .progress = own->limits->progress ? post_progress : NULL,
                             .advance = own->limits->advance ? post_advance : NULL,
                             .user = &to};

  /* Listen to the parent, who may have been interrupted already. */
  struct sigaction ask = {.sa_handler = stop};
  thr_err err = {0};
  told_to_stop = own->limits->interrupted && *own->limits->interrupted;
  sigemptyset(&ask.sa_mask);
  sigaction(SIGUSR1, &ask, NULL);

  thr_status st = own->job->run(own->job->user, &limits, &to, &err);

  /* The end: status, text, and the work that is left. */
  return thr_message_send(
      fd,
      (thr_message){.kind = END, .length = strlen(err.text), .value = {work}, .code = (int32_t)st},
      err.text);
}

/* ---- the parent ---- */

/* Holds what the parent knows of its child. */
typedef struct {
  const thr_child *job;
  const thr_limits *limits;
  thr_process process;
  thr_text *answer, arrived; /* bytes not yet taken for a message */
  thr_grace grace;           /* from when the child was asked to stop */
  bool stuck;                /* the child waits for itself */
  bool ended;                /* the message of its end has come, with this status and text */
  thr_err end;
  thr_status status;
} watched_child;

/* Takes a message of the child. */
static void take(void *user, const thr_message *message, const char *bytes)
{
  watched_child *child = user;
  const thr_limits *limits = child->limits;

  /* The bytes are no C string. */
  char what[200];
  snprintf(what, sizeof what, "%.*s",
           message->length < sizeof what ? (int)message->length : (int)sizeof what - 1, bytes);

  /* The caller's functions run in this process. */
  if (message->kind == PROGRESS)
    limits->progress(limits->user, what, message->value[0], message->value[1]);
  if (message->kind == ADVANCE) limits->advance(limits->user, what, message->value[0]);

  /* An answer replaces the one before. */
  if (message->kind == ANSWER) {
    child->answer->length = 0;
    thr_text_append_bytes(child->answer, bytes, message->length);
  }

  /* The end. Work that the child did counts here. */
  if (message->kind == END) {
    child->ended = true;
    child->status = (thr_status)message->code;
    if (child->status) thr_fail(&child->end, child->status, "%.*s", (int)message->length, bytes);
    if (limits->work) *limits->work = message->value[0];
  }
}

/* Waits for a message, at most until it is time to look at the limits. Returns false when the child
 * has closed its pipe. */
static bool receive(watched_child *child)
{
  struct pollfd news = {.fd = child->process.pipe, .events = POLLIN};
  double wait = child->grace.from > 0 ? WATCH : thr_limits_left(child->limits, WATCH);

  /* No news: does the child do anything at all? */
  const int ready = poll(&news, 1, (int)ceil(1000 * fmin(wait, WATCH)));
  if (child->job->look) child->job->look(child->job->user);
  if (ready <= 0) {
    child->stuck = thr_process_stuck(&child->process);
    return true;
  }

  ssize_t n = thr_messages_receive(child->process.pipe, &child->arrived, take, child);

  return n > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN));
}

/* Returns whether the child has had its time to stop by itself: where somebody looks on, and waits,
 * it is no longer on a busy machine. */
static bool is_grace_over(watched_child *child)
{
  if (!child->job->look) return thr_grace_over(&child->grace, child->process.pid, GRACE);
  const double grace = child->job->grace > 0 ? fmin(child->job->grace, GRACE) : GRACE;
  return child->grace.from > 0 && thr_clock() - child->grace.from >= grace;
}

/* Takes messages until the child has closed its pipe. Returns false if it has not stopped in time.
 */
static bool watch(watched_child *child)
{
  while (!child->arrived.failed && !child->answer->failed && !child->stuck && receive(child)) {
    /* The limits are reached: ask the child to stop. What waiting takes is no work. */
    if (!child->grace.from && thr_limits_left(child->limits, 1) <= 0) {
      child->grace.from = thr_clock();
      kill(child->process.pid, SIGUSR1);
    }

    if (is_grace_over(child)) return false;
  }

  return true;
}

/* Returns what came of the child, with a text for the user. */
static thr_status judge(watched_child *child, bool stopped, thr_err *err)
{
  char who[200];

  /* What ended the watch early. */
  if (child->arrived.failed || child->answer->failed) return thr_nomem(err);
  if (!stopped)
    return thr_fail(err, THR_ELIMIT, "%s: stopped before it was done", child->job->what);
  if (child->stuck)
    return thr_fail(err, THR_ESOLVER,
                    "%s: its process waited for itself (memory ran out in a library)",
                    child->job->what);

  /* The child has told its end; else it died. */
  if (child->ended)
    return child->status ? thr_fail(err, child->status, "%s", child->end.text) : THR_OK;
  snprintf(who, sizeof who, "%s: its process", child->job->what);
  thr_status st = thr_process_end(&child->process, who, child->job->advice, err);

  return st ? st : thr_fail(err, THR_ESOLVER, "%s: its process sent too little", child->job->what);
}

/* Runs the job in one child. */
static thr_status run_once(const thr_child *job, const thr_limits *limits, thr_text *answer,
                           bool *stuck, thr_err *err)
{
  watched_child child = {.job = job, .limits = limits, .answer = answer};
  task own = {job, limits};
  thr_err reason = {0};
  thr_status st = thr_process_start(&child.process, run_job, &own, &reason);
  if (st) return thr_fail(err, st, "%s: %s", job->what, reason.text);

  /* Whatever happened, no child is left. */
  bool stopped = watch(&child);
  st = judge(&child, stopped, err);
  *stuck = child.stuck;
  thr_process_kill(&child.process);
  thr_text_destroy(&child.arrived);

  if (answer->failed) thr_text_destroy(answer);

  return st;
}

/* Limits how many children are tried if they get stuck. */
#if defined __SANITIZE_ADDRESS__
enum { MOST_CHILDREN = 4 };
#else
enum { MOST_CHILDREN = 2 };
#endif

/* Runs a job in a child; see process.h. A child of a process with several threads may be born with
 * a lock that another thread held (under sanitizers, say), and wait for the lock for ever: then
 * another child is tried. */
thr_status thr_child_run(const thr_child *job, const thr_limits *limits, thr_text *answer,
                         thr_err *err)
{
  thr_err why = {0};
  bool stuck = true;
  thr_status st = THR_ESOLVER;

  /* What a stuck child has sent does not count. */
  for (int i = 0; i < MOST_CHILDREN && stuck && st == THR_ESOLVER; i++) {
    thr_text_destroy(answer);
    st = run_once(job, limits, answer, &stuck, &why);
  }

  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
