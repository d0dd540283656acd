/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two processes of a command: the one that works, and the one that waits. */
#define _POSIX_C_SOURCE 200809L
#include "cli/cli.h"
#include "graph/process/process.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const double GRACE =
    0.5; /* s that a child has to end by itself after its deadline or a signal */
static const double LOOK =
    0.1; /* s between two looks at the child when no signal wakes its parent */

/* ---- messages from the child ---- */

enum {
  KEEP,
  WRITING,
  WRITTEN,
  NO_MEMORY,
  ALLOW,
  ENDING
}; /* kinds; code: exit code; value of ALLOW: s */

static int to_parent = -1; /* in the child: where messages go */
static double deadline;    /* thr_clock() */

static void send(thr_message m, const char *bytes)
{
  if (to_parent >= 0 && !thr_message_send(to_parent, m, bytes)) to_parent = -1;
}

void guard_keep(const thr_text *text)
{
  if (!text->failed) send((thr_message){.kind = KEEP, .length = text->length}, text->data);
}

void guard_writing(void)
{
  send((thr_message){.kind = WRITING}, NULL);
}

void guard_written(int code)
{
  send((thr_message){.kind = WRITTEN, .code = code}, NULL);
}

bool guard_no_memory(void)
{
  send((thr_message){.kind = NO_MEMORY}, NULL);
  return to_parent >= 0;
}

void guard_ending(int code)
{
  send((thr_message){.kind = ENDING, .code = code}, NULL);
}

void guard_allow(double seconds)
{
  deadline = seconds > 0 ? thr_clock() + seconds : 0;
  send((thr_message){.kind = ALLOW, .value = {seconds}}, NULL);
}

double guard_deadline(void)
{
  return deadline;
}

/* ---- the parent ---- */

static volatile sig_atomic_t signals, hung_up;

static void count_signal(int signal)
{
  (void)signal;
  signals++;
}

/* The terminal closes, which kernel and shell both say: it counts once. Nobody reading is no reason
 * to end before the plan is written. */
static void count_hangup(int signal_number)
{
  (void)signal_number;
  signal(SIGPIPE, SIG_IGN);
  if (!hung_up) signals++;
  hung_up = 1;
}

static void wake(int signal)
{
  (void)signal;
}

typedef struct {
  pid_t pid;
  int pipe, status;
  thr_grace grace;
  double first; /* when the first signal came; 0 = none has */
  bool ended, writing, out_of_memory;
  bool by_itself;   /* it said that it would end, and how */
  thr_text arrived; /* bytes that are no whole message yet */
  guard_end *end;
} guarded;

static void take(void *user, const thr_message *h, const char *bytes)
{
  guarded *g = user;
  switch (h->kind) {
  case KEEP:
    g->end->kept.length = 0;
    thr_text_append_bytes(&g->end->kept, bytes, h->length);
    break;
  case WRITING: g->writing = true; break;
  case WRITTEN:
    g->writing = false;
    g->end->written = true;
    g->end->code = h->code;
    break;
  case NO_MEMORY: g->out_of_memory = true; break;
  case ENDING: g->by_itself = true; break;
  case ALLOW:
    if (!g->first) g->grace = (thr_grace){.from = h->value[0] > 0 ? thr_clock() + h->value[0] : 0};
    break;
  }
}

/* Takes what lies in the pipe. */
static void receive(guarded *g)
{
  while (thr_messages_receive(g->pipe, &g->arrived, take, g) > 0)
    continue;
}

/* Signals: the first is passed on, the second ends everything, unless it is the first once more,
 * sent to the process and to its group as `timeout` does. */
static void heed_signals(guarded *g)
{
  double now = thr_clock();
  if (signals == 0) return;
  signals = 0;
  if (g->first > 0 && now - g->first > 0.3) {
    kill(g->pid, SIGKILL);
    _exit(130);
  }
  if (g->first > 0) return;
  g->first = now;
  g->grace = (thr_grace){.from = now};
  kill(g->pid, hung_up ? SIGHUP : SIGTERM);
}

static void watch(guarded *g)
{
  struct pollfd news = {.fd = g->pipe, .events = POLLIN};
  while (!g->ended) {
    if (poll(&news, 1, (int)(1000 * LOOK)) > 0 && news.revents & POLLHUP &&
        !(news.revents & POLLIN))
      news.fd = -1; /* closed: only the end is left to wait for */
    receive(g);
    heed_signals(g);
    g->ended = waitpid(g->pid, &g->status, WNOHANG) == g->pid;
    if (g->ended || g->writing || !thr_grace_over(&g->grace, g->pid, GRACE)) continue;
    kill(g->pid, SIGKILL);
    g->end->reason = g->first > 0 ? GUARD_INTERRUPTED : GUARD_TIME;
    g->grace = (thr_grace){0};
  }
  receive(g);
}

/* Returns how many bytes the system gives a process (ulimit -v, -d), or INFINITY. */
static double system_memory(void)
{
  const int kinds[] = {RLIMIT_AS, RLIMIT_DATA};
  double least = INFINITY;
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    struct rlimit r;
    if (getrlimit(kinds[i], &r) == 0 && r.rlim_cur != RLIM_INFINITY)
      least = fmin(least, (double)r.rlim_cur);
  }
  return least;
}

/* A library that dies where memory is short has come near the limit. */
static guard_reason reason_of(const guarded *g, const guard_limits *l)
{
  struct rusage used;
  bool killed = WIFSIGNALED(g->status);
  getrusage(RUSAGE_CHILDREN, &used);
  const double limit = fmin(l->memory > 0 ? l->memory : INFINITY, system_memory());
  bool full = 1024. * (double)used.ru_maxrss > 0.7 * limit;
  if (killed && g->end->reason != GUARD_DONE) return g->end->reason; /* by this process */
  if (g->out_of_memory || ((killed || !g->by_itself) && full)) return GUARD_MEMORY;
  return killed || !g->by_itself ? GUARD_DIED : GUARD_DONE;
}

/* How it ended, and why. */
static void judge(guarded *g, const guard_limits *l)
{
  guard_end *e = g->end;
  e->reason = reason_of(g, l);
  if (!WIFSIGNALED(g->status) && (e->reason == GUARD_DONE || !e->written))
    e->code = WEXITSTATUS(g->status);
  switch (e->reason) {
  case GUARD_TIME: snprintf(e->why, sizeof e->why, "not done in time"); break;
  case GUARD_INTERRUPTED: snprintf(e->why, sizeof e->why, "stopped"); break;
  case GUARD_MEMORY:
    if (system_memory() < (l->memory > 0 ? l->memory : INFINITY))
      snprintf(e->why, sizeof e->why,
               "out of memory (the system's limit, ulimit -v, allows %.4g MB)",
               system_memory() / 1e6);
    else if (l->memory > 0)
      snprintf(e->why, sizeof e->why, "out of memory (--memory allows %g MB)", l->memory / 1e6);
    else
      snprintf(e->why, sizeof e->why, "out of memory");
    break;
  case GUARD_DIED:
    if (WIFSIGNALED(g->status))
      snprintf(e->why, sizeof e->why,
               "died of signal %d (a fault of this program, or memory ran out)",
               WTERMSIG(g->status));
    else
      snprintf(e->why, sizeof e->why, "ended by a library (exit code %d)", WEXITSTATUS(g->status));
    break;
  default: break;
  }
}

/* ---- forking ---- */

/* The sanitizers' own bookkeeping is more than any limit. */
#if defined __SANITIZE_ADDRESS__
enum { MEMORY_IS_BOUNDED = 0 };
#else
enum { MEMORY_IS_BOUNDED = 1 };
#endif

static void bound_memory(double bytes)
{
  struct rlimit r;
  if (!MEMORY_IS_BOUNDED || bytes <= 0 || getrlimit(RLIMIT_DATA, &r)) return;
  if (r.rlim_cur != RLIM_INFINITY && (double)r.rlim_cur <= bytes)
    return; /* somebody was stricter */
  r.rlim_cur = (rlim_t)bytes;
  setrlimit(RLIMIT_DATA, &r);
}

static void count_signals(void)
{
  struct sigaction count = {.sa_handler = count_signal},
                   ended = {.sa_handler = wake, .sa_flags = SA_NOCLDSTOP};
  struct sigaction hangup = {.sa_handler = count_hangup}, before;
  sigaction(SIGINT, &count, NULL);
  sigaction(SIGTERM, &count, NULL);
  if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &hangup, NULL); /* not with nohup */
  sigaction(SIGCHLD, &ended, NULL);   /* so that poll returns */
}

/* Forks with signals held back until either process knows what to do with them. */
static pid_t fork_quietly(void)
{
  const pid_t parent = getpid();
  sigset_t all, before;
  fflush(NULL);
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);
  pid_t pid = fork();
  if (pid == 0) {
    thr_process_die_with(parent);
    cli_heed_signals();
  } else if (pid > 0) {
    count_signals();
  }
  sigprocmask(SIG_SETMASK, &before, NULL);
  return pid;
}

/* Nobody reads what the child prints: that is the command's end, as if there were no child. */
static void die_of(int signal_number)
{
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

static bool fork_failed(guard_end *end)
{
  cli_error("cannot start a process: %s; close other programs", strerror(errno));
  end->code = EXIT_INTERNAL;
  return true;
}

bool guard_fork(const guard_limits *l, guard_end *end)
{
  int ends[2];
  *end = (guard_end){0};
  deadline = l->seconds > 0 ? thr_clock() + l->seconds : 0;
  guarded g = {.end = end, .grace = {.from = deadline}};
  if (pipe(ends)) return fork_failed(end);
  g.pid = fork_quietly();
  if (g.pid < 0) return fork_failed(end);
  if (g.pid == 0) {
    close(ends[0]);
    to_parent = ends[1];
    bound_memory(l->memory);
    return false;
  }
  close(ends[1]);
  g.pipe = ends[0];
  fcntl(g.pipe, F_SETFL, O_NONBLOCK);
  watch(&g);
  close(g.pipe);
  if (WIFSIGNALED(g.status) && WTERMSIG(g.status) == SIGPIPE) die_of(SIGPIPE);
  thr_text_destroy(&g.arrived);
  judge(&g, l);
  if (end->reason != GUARD_DONE) cli_wipe_line();
  return true;
}

bool guard_alone(int code, guard_end *end)
{
  (void)code;
  (void)end;
  return false;
}
