/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a command in two processes: the child works, the parent waits, ends the child when its time
 * is over, and knows afterwards how it ended.
 *
 * The child tells its parent through a pipe what it would leave (KEEP), that it is writing its
 * result and has written it (WRITING, WRITTEN), how much time it has (ALLOW), that memory ran out,
 * that stdout has an answer for programs (ANSWERED), and that it ends by itself, with its error. So
 * the parent can tell a result from an accident, and write the last KEEP if there is no result.
 *
 * Signals: the first SIGINT, SIGTERM or SIGHUP reaches the child as a request to end, the second
 * one ends both processes at once, but for a second SIGHUP. A child has half a second of grace
 * after its deadline, more if the machine is so busy that it does not get the processor
 * (graph/process/process.h). */
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

/* s that a child has to end by itself after its deadline or a signal. */
static const double GRACE = 0.5;

/* s between two looks at the child when no signal wakes its parent. */
static const double LOOK = 0.1;

/* ---- messages from the child ---- */

/* Kinds of messages; code: the exit code; value[0] of ALLOW: s. */
enum { KEEP, WRITING, WRITTEN, NO_MEMORY, ALLOW, ANSWERED, ENDING };

static int to_parent = -1; /* in the child: where messages go */
static double deadline;    /* thr_clock() */

/* Sends a message. A parent that has gone is told nothing any more. */
static void send_to_parent(thr_message message, const char *bytes)
{
  if (to_parent >= 0 && !thr_message_send(to_parent, message, bytes)) to_parent = -1;
}

void guard_keep(const thr_text *text)
{
  if (!text->failed)
    send_to_parent((thr_message){.kind = KEEP, .length = text->length}, text->data);
}

void guard_writing(void)
{
  send_to_parent((thr_message){.kind = WRITING}, NULL);
}

void guard_written(int code)
{
  send_to_parent((thr_message){.kind = WRITTEN, .code = code}, NULL);
}

bool guard_no_memory(void)
{
  send_to_parent((thr_message){.kind = NO_MEMORY}, NULL);
  return to_parent >= 0;
}

void guard_answered(void)
{
  send_to_parent((thr_message){.kind = ANSWERED}, NULL);
}

bool guard_ending(int code, const char *error)
{
  send_to_parent((thr_message){.kind = ENDING, .code = code, .length = strlen(error)}, error);
  return to_parent >= 0;
}

void guard_allow(double seconds)
{
  deadline = seconds > 0 ? thr_clock() + seconds : 0;
  send_to_parent((thr_message){.kind = ALLOW, .value = {seconds}}, NULL);
}

double guard_deadline(void)
{
  return deadline;
}

/* ---- the parent ---- */

static volatile sig_atomic_t signals, hung_up;

/* Counts a SIGINT or SIGTERM, which the loop of the parent looks at. */
static void count_signal(int signal)
{
  (void)signal;
  signals++;
}

/* Counts that the terminal closes, which kernel and shell both say: once. Nobody reading is no
 * reason to end before the plan is written, so that SIGPIPE is ignored from now on. */
static void count_hangup(int signal_number)
{
  (void)signal_number;
  signal(SIGPIPE, SIG_IGN);
  if (!hung_up) signals++;
  hung_up = 1;
}

/* Does nothing: SIGCHLD only has to interrupt poll(). */
static void wake(int signal)
{
  (void)signal;
}

/* What the parent knows of its child. */
typedef struct {
  pid_t pid;
  int pipe, status;
  thr_grace grace;
  double first; /* when the first signal came; 0 = none has */
  bool ended, writing, out_of_memory;
  bool by_itself;   /* it said that it would end, and how */
  thr_text arrived; /* bytes that are no whole message yet */
  guard_end *end;
} guarded_child;

/* Takes a message of the child. Signature of thr_messages_receive. */
static void take_message(void *user, const thr_message *message, const char *bytes)
{
  guarded_child *child = user;

  switch (message->kind) {
  /* The last one that was kept is replaced. */
  case KEEP:
    child->end->kept.length = 0;
    thr_text_append_bytes(&child->end->kept, bytes, message->length);
    break;
  case WRITING: child->writing = true; break;

  /* From here on there is a result. */
  case WRITTEN:
    child->writing = false;
    child->end->written = true;
    child->end->code = message->code;
    break;
  case NO_MEMORY: child->out_of_memory = true; break;
  case ANSWERED: answer_given(); break;

  /* What it failed of is known here as well, and may be said better. */
  case ENDING: {
    char error[1024];
    snprintf(error, sizeof error, "%.*s", (int)message->length, bytes);
    child->by_itself = true;
    answer_error_is(error);
    break;
  }

  /* After a signal no message gives more time. */
  case ALLOW:
    if (!child->first)
      child->grace =
          (thr_grace){.from = message->value[0] > 0 ? thr_clock() + message->value[0] : 0};
    break;
  }
}

/* Takes all messages that lie in the pipe. */
static void receive(guarded_child *child)
{
  while (thr_messages_receive(child->pipe, &child->arrived, take_message, child) > 0)
    continue;
}

/* Heeds signals that came: the first is passed on, the second ends everything, unless it comes
 * within 0.3 s of the first: `timeout` sends it to the process and to its group. */
static void heed_signals(guarded_child *child)
{
  double now = thr_clock();

  if (signals == 0) return;
  signals = 0;

  if (child->first > 0 && now - child->first > 0.3) {
    kill(child->pid, SIGKILL);
    _exit(EXIT_SECOND_SIGNAL);
  }

  if (child->first > 0) return;

  /* The child has its grace from now on. */
  child->first = now;
  child->grace = (thr_grace){.from = now};
  kill(child->pid, hung_up ? SIGHUP : SIGTERM);
}

/* Waits for the end of the child, and ends it when its time and its grace are over. */
static void watch(guarded_child *child)
{
  struct pollfd news = {.fd = child->pipe, .events = POLLIN};

  while (!child->ended) {
    /* A closed pipe would wake poll all the time. */
    if (poll(&news, 1, (int)(1000 * LOOK)) > 0 && news.revents & POLLHUP &&
        !(news.revents & POLLIN))
      news.fd = -1; /* closed: only the end is left to wait for */

    /* Messages, signals, the end; a child that is writing may finish. */
    receive(child);
    heed_signals(child);
    child->ended = waitpid(child->pid, &child->status, WNOHANG) == child->pid;
    if (child->ended || child->writing || !thr_grace_over(&child->grace, child->pid, GRACE))
      continue;

    /* Only now is it certain why there is no result. */
    kill(child->pid, SIGKILL);
    child->end->reason = child->first > 0 ? GUARD_INTERRUPTED : GUARD_TIME;
    child->grace = (thr_grace){0};
  }

  receive(child);
}

/* Returns how many bytes the system gives a process (ulimit -v, -d), or INFINITY. */
static double system_memory(void)
{
  const int kinds[] = {RLIMIT_AS, RLIMIT_DATA};
  double least = INFINITY;

  /* RLIMIT_AS bounds addresses, RLIMIT_DATA what is allocated. */
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    struct rlimit bound;
    if (getrlimit(kinds[i], &bound) == 0 && bound.rlim_cur != RLIM_INFINITY)
      least = fmin(least, (double)bound.rlim_cur);
  }

  return least;
}

/* Returns why the child ended. Where it died or a library ended it, memory is to blame if it was
 * told so, or if more than 0.7 of the limit had been in use: a library that dies where memory is
 * short has come near the limit. */
static guard_reason reason_of(const guarded_child *child, const guard_limits *limits)
{
  struct rusage used;
  bool killed = WIFSIGNALED(child->status);

  getrusage(RUSAGE_CHILDREN, &used);

  /* Memory, in bytes: its limit, and the most that was in use (kB on Linux). */
  const double limit = fmin(limits->memory > 0 ? limits->memory : INFINITY, system_memory());
  bool full = 1024. * (double)used.ru_maxrss > 0.7 * limit;

  if (killed && child->end->reason != GUARD_DONE) return child->end->reason; /* by this process */
  if (child->out_of_memory || ((killed || !child->by_itself) && full)) return GUARD_MEMORY;

  return killed || !child->by_itself ? GUARD_DIED : GUARD_DONE;
}

/* Fills in how the child ended, and the reason in words. */
static void judge(guarded_child *child, const guard_limits *limits)
{
  guard_end *outcome = child->end;

  outcome->reason = reason_of(child, limits);
  if (!WIFSIGNALED(child->status) && (outcome->reason == GUARD_DONE || !outcome->written))
    outcome->code = WEXITSTATUS(child->status);

  /* Words, with the limit that was met. */
  switch (outcome->reason) {
  case GUARD_TIME: snprintf(outcome->why, sizeof outcome->why, "not done in time"); break;
  case GUARD_INTERRUPTED: snprintf(outcome->why, sizeof outcome->why, "stopped"); break;
  case GUARD_MEMORY:
    if (system_memory() < (limits->memory > 0 ? limits->memory : INFINITY))
      snprintf(outcome->why, sizeof outcome->why,
               "out of memory (the system's limit, ulimit -v, allows %.4g MB)",
               system_memory() / 1e6);
    else if (limits->memory > 0)
      snprintf(outcome->why, sizeof outcome->why, "out of memory (--memory allows %g MB)",
               limits->memory / 1e6);
    else
      snprintf(outcome->why, sizeof outcome->why, "out of memory");
    break;

  case GUARD_DIED:
    if (WIFSIGNALED(child->status))
      snprintf(outcome->why, sizeof outcome->why,
               "died of signal %d (a fault of this program, or memory ran out)",
               WTERMSIG(child->status));
    else
      snprintf(outcome->why, sizeof outcome->why, "ended by a library (exit code %d)",
               WEXITSTATUS(child->status));
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

/* Bounds the memory of this process, in bytes, unless the system was stricter already. */
static void bound_memory(double bytes)
{
  struct rlimit bound;
  if (!MEMORY_IS_BOUNDED || bytes <= 0 || getrlimit(RLIMIT_DATA, &bound)) return;
  if (bound.rlim_cur != RLIM_INFINITY && (double)bound.rlim_cur <= bytes)
    return; /* somebody was stricter */
  /* RLIMIT_DATA counts private mappings, too, so that large blocks are bounded. */
  bound.rlim_cur = (rlim_t)bytes;
  setrlimit(RLIMIT_DATA, &bound);
}

/* Has the parent count signals and be woken by the child's end. With nohup SIGHUP stays ignored. */
static void install_handlers(void)
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

/* Forks with signals held back until either process knows what to do with them. Returns as fork()
 * does. */
static pid_t fork_quietly(void)
{
  const pid_t parent = getpid();
  sigset_t all, before;

  fflush(NULL);
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &before);

  /* The child does not outlive its parent. */
  pid_t pid = fork();
  if (pid == 0) {
    thr_process_die_with(parent);
    cli_heed_signals();
  } else if (pid > 0) {
    install_handlers();
  }

  sigprocmask(SIG_SETMASK, &before, NULL);

  return pid;
}

/* Ends this process by a signal as if there were no child: nobody reads what the child printed. */
static void die_of(int signal_number)
{
  signal(signal_number, SIG_DFL);
  raise(signal_number);
}

/* Prints why there is no child, and fills in an end with EXIT_INTERNAL. Returns true, as the parent
 * of guard_fork does. */
static bool fork_failed(guard_end *end)
{
  cli_error("cannot start a process: %s; close other programs", strerror(errno));
  end->code = EXIT_INTERNAL;
  return true;
}

bool guard_fork(const guard_limits *limits, guard_end *end)
{
  int ends[2];

  *end = (guard_end){0};
  deadline = limits->seconds > 0 ? thr_clock() + limits->seconds : 0;
  guarded_child child = {.end = end, .grace = {.from = deadline}};
  if (pipe(ends)) return fork_failed(end);
  child.pid = fork_quietly();
  if (child.pid < 0) return fork_failed(end);

  /* The child: where messages go, and how much memory there is. */
  if (child.pid == 0) {
    close(ends[0]);
    to_parent = ends[1];
    bound_memory(limits->memory);
    return false;
  }

  /* The parent: it reads the pipe without waiting, since it has more to look at. */
  close(ends[1]);
  child.pipe = ends[0];
  fcntl(child.pipe, F_SETFL, O_NONBLOCK);
  watch(&child);
  close(child.pipe);

  /* What is left when the child has ended. */
  if (WIFSIGNALED(child.status) && WTERMSIG(child.status) == SIGPIPE) die_of(SIGPIPE);
  thr_text_destroy(&child.arrived);
  judge(&child, limits);

  /* A child that was ended could not wipe its progress line. */
  if (end->reason != GUARD_DONE) cli_wipe_line();

  return true;
}

bool guard_alone(int code, guard_end *end)
{
  (void)code;
  (void)end;
  return false;
}
