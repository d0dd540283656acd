/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A child process that cannot harm its parent: what it prints is kept from the terminal, Ctrl-C is
 * left to the parent, and it dies when the parent dies. Everything that runs in a child is started
 * here (graph/process/workers.c, graph/process/child.c), but for commands as a whole (cli/guard.c).
 */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { READ = 0, WRITE = 1 }; /* ends of a pipe */
enum { FIRST_FREE = 3 };      /* descriptors below are standard input, output and error */
enum {
  SENT = 113
}; /* exit code of a child that has sent everything, other than a library's exit(0) */
enum { BLOCK = 1 << 16 }; /* bytes read at once */
/* Looks without any work in between. A child of a sanitizer's build is born with its allocator
 * locked every so often (fork does not wait for other threads there), and nothing else sleeps so
 * long in the tests. */
#if defined __SANITIZE_ADDRESS__
enum { STUCK = 30 };
#else
enum { STUCK = 200 };
#endif

bool thr_process_send(int fd, const char *data, size_t n)
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

bool thr_message_send(int fd, thr_message m, const char *bytes)
{
  return thr_process_send(fd, (const char *)&m, sizeof m) && thr_process_send(fd, bytes, m.length);
}

/* Hands over the messages that have arrived whole. */
static void take_all(thr_text *arrived,
                     void (*take)(void *user, const thr_message *m, const char *bytes), void *user)
{
  size_t at = 0;
  thr_message m;
  while (arrived->length - at >= sizeof m) {
    memcpy(&m, arrived->data + at, sizeof m);
    if (arrived->length - at - sizeof m < m.length) break;
    take(user, &m, arrived->data + at + sizeof m);
    at += sizeof m + m.length;
  }
  if (at == 0) return;
  arrived->length -= at;
  memmove(arrived->data, arrived->data + at, arrived->length);
}

ssize_t thr_messages_receive(int fd, thr_text *arrived,
                             void (*take)(void *user, const thr_message *m, const char *bytes),
                             void *user)
{
  static _Thread_local char block[BLOCK];
  ssize_t n = read(fd, block, sizeof block);
  if (n <= 0) return n;
  thr_text_append_bytes(arrived, block, (size_t)n);
  take_all(arrived, take, user);
  return n;
}

/* Ctrl-C goes to the whole process group: the parent decides what to do about it. */
static void leave_signals_to_parent(const sigset_t *mask)
{
  signal(SIGINT, SIG_IGN);
  signal(SIGTERM, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGUSR1, SIG_IGN); /* until run() wants it */
  signal(SIGPIPE, SIG_DFL);
  sigprocmask(SIG_SETMASK, mask, NULL);
}

/* What a library prints goes into the words, and so does what exit() would flush of the parent's
 * buffers. A full pipe drops the rest. The result's descriptor moves up if it lies where standard
 * output was closed. */
static bool keep_quiet(int *result, int words)
{
  if (*result < FIRST_FREE) *result = fcntl(*result, F_DUPFD, FIRST_FREE);
  if (words < FIRST_FREE) words = fcntl(words, F_DUPFD, FIRST_FREE);
  return *result >= 0 && words >= 0 && fcntl(words, F_SETFL, O_NONBLOCK) == 0 &&
         dup2(words, 1) >= 0 && dup2(words, 2) >= 0;
}

/* A parent that died before the kernel knew that its death is to end this process is no longer the
 * parent. */
void thr_process_die_with(pid_t parent)
{
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(1);
}

/* Never returns. */
static void run_child(bool (*run)(void *user, int fd), void *user, pid_t parent,
                      const sigset_t *mask, int fd, int words)
{
  thr_process_die_with(parent);
  leave_signals_to_parent(mask);
  _exit(keep_quiet(&fd, words) && run(user, fd) ? SENT : 1);
}

/* false: errno says why not. */
static bool open_pipes(int result[2], int words[2])
{
  if (pipe(result)) return false;
  if (pipe(words) == 0) return true;
  int reason = errno;
  close(result[READ]);
  close(result[WRITE]);
  errno = reason;
  return false;
}

/* One start at a time: a child of another thread would keep the pipe open that this one is to
 * close. */
static pthread_mutex_t starting = PTHREAD_MUTEX_INITIALIZER;

static thr_status start(thr_process *process, bool (*run)(void *user, int fd), void *user,
                        thr_err *err)
{
  int result[2], words[2];
  sigset_t all, old;
  const pid_t parent = getpid();
  if (!open_pipes(result, words))
    return thr_fail(err, THR_ESOLVER, "cannot start a worker: %s; close other programs",
                    strerror(errno));
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &old); /* or a signal would run the parent's handler in the child */
  pid_t pid = fork();
  if (pid == 0) {
    pthread_mutex_unlock(&starting); /* the child's copy */
    close(result[READ]);
    close(words[READ]);
    run_child(run, user, parent, &old, result[WRITE], words[WRITE]);
  }
  int reason = errno;
  sigprocmask(SIG_SETMASK, &old, NULL);
  close(result[WRITE]);
  close(words[WRITE]);
  if (pid > 0) {
    *process = (thr_process){.pid = pid, .pipe = result[READ], .words = words[READ]};
    return THR_OK;
  }
  close(result[READ]);
  close(words[READ]);
  return thr_fail(err, THR_ESOLVER,
                  "cannot start a worker: %s; close other programs or ask for fewer processes",
                  strerror(reason));
}

thr_status thr_process_start(thr_process *process, bool (*run)(void *user, int fd), void *user,
                             thr_err *err)
{
  pthread_mutex_lock(&starting);
  thr_status st = start(process, run, user, err);
  pthread_mutex_unlock(&starting);
  return st;
}

/* The first line of the words that says something, of at most size - 1 bytes. */
static void first_line(int words, char *line, size_t size)
{
  char said[1024];
  fcntl(words, F_SETFL,
        O_NONBLOCK); /* a process that the child started may still hold the other end */
  ssize_t n = read(words, said, sizeof said - 1);
  said[n > 0 ? n : 0] = '\0';
  const char *s = said;
  while (isspace((unsigned char)*s))
    s++;
  snprintf(line, size, "%.*s", (int)strcspn(s, "\r\n"), s);
}

/* Its wait status, or -1 if somebody else has waited for it. */
static int reap(thr_process *process, char *line, size_t size)
{
  int status;
  pid_t got;
  close(process->pipe);
  while ((got = waitpid(process->pid, &status, 0)) < 0 && errno == EINTR)
    continue;
  first_line(process->words, line, size);
  close(process->words);
  *process = (thr_process){0};
  return got < 0 ? -1 : status;
}

thr_status thr_process_end(thr_process *process, const char *who, const char *advice, thr_err *err)
{
  char line[200];
  int status = reap(process, line, sizeof line);
  const char *opening = *line ? " (it said: " : "", *closing = *line ? ")" : "",
             *comma = advice ? "; " : "";
  if (!advice) advice = "";
  if (status != -1 && WIFSIGNALED(status))
    return thr_fail(err, THR_ESOLVER, "%s died of signal %d (%s)%s%s%s%s%s", who, WTERMSIG(status),
                    strsignal(WTERMSIG(status)), opening, line, closing, comma, advice);
  if (status == -1 || WEXITSTATUS(status) != SENT)
    return thr_fail(err, THR_ESOLVER, "%s ended without a result%s%s%s%s%s", who, opening, line,
                    closing, comma, advice);
  return THR_OK;
}

/* Processor time that it has used, s. */
static double cpu_time(pid_t pid)
{
  clockid_t clock;
  struct timespec t;
  if (clock_getcpuclockid(pid, &clock) || clock_gettime(clock, &t)) return 0;
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Does it sleep, rather than wait for a processor? The third field of the file, after a name in
 * brackets. */
static bool sleeps(pid_t pid)
{
  char path[40], line[200] = "";
  snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const ssize_t n = read(fd, line, sizeof line - 1);
  close(fd);
  const char *name_end = n > 0 ? strrchr(line, ')') : NULL;
  return name_end && name_end[1] == ' ' && name_end[2] == 'S';
}

/* Sanitizers slow everything down. */
#if defined __SANITIZE_ADDRESS__
static const double SLOWER = 4;
#else
static const double SLOWER = 1;
#endif
static const double MOST_GRACES = 5;

bool thr_grace_over(thr_grace *grace, pid_t pid, double seconds)
{
  const double now = thr_clock(), gone = now - grace->from, used = cpu_time(pid);
  if (grace->from == 0 || gone < 0) return false;
  if (grace->begun == 0) grace->begun = used;
  if (used != grace->used) grace->idle_from = now;
  grace->used = used;
  if (now - grace->idle_from >= seconds && sleeps(pid)) return true;
  seconds *= SLOWER;
  return gone >= MOST_GRACES * seconds || (gone >= seconds && used - grace->begun >= seconds);
}

bool thr_process_stuck(thr_process *process)
{
  double cpu = cpu_time(process->pid);
  process->looks = cpu == process->cpu && sleeps(process->pid) ? process->looks + 1 : 0;
  process->cpu = cpu;
  return process->looks >= STUCK;
}

void thr_process_kill(thr_process *process)
{
  char line[2];
  if (!process->pid) return;
  kill(process->pid, SIGKILL);
  reap(process, line, sizeof line);
}
