/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Starts child processes that cannot harm their parent: what a child prints is kept from the
 * terminal, Ctrl-C is left to the parent, and a child dies when its parent dies. Everything that
 * runs in a child is started here (workers.c, child.c), but for commands as a whole (cli/guard.c).
 *
 * A child has two pipes: one for its result, and one for what libraries print to standard output
 * and error, of which the first line is quoted if the child fails. A child that has sent everything
 * ends with the exit code SENT, which tells it from one in which a library called exit(0). */
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
enum { SENT = 113 };          /* exit code of a child that has sent everything */
enum { BLOCK = 1 << 16 };     /* bytes read at once */

/* Looks in a row at which a child sleeps without any work in between, until it counts as stuck. A
 * child of a sanitizer's build is now and then born with the allocator locked (fork does not wait
 * for other threads there), and nothing else sleeps so long in the tests. */
#if defined __SANITIZE_ADDRESS__
enum { STUCK = 60 };
#else
enum { STUCK = 400 };
#endif

/* Writes n bytes, in spite of signals. */
bool thr_process_send(int fd, const char *data, size_t n)
{
  while (n > 0) {
    ssize_t sent = write(fd, data, n);

    /* A signal interrupts the call, not the writing. */
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    n -= (size_t)sent;
  }

  return true;
}

/* Writes a message and its bytes. */
bool thr_message_send(int fd, thr_message message, const char *bytes)
{
  return thr_process_send(fd, (const char *)&message, sizeof message) &&
         thr_process_send(fd, bytes, message.length);
}

/* Hands over the messages that have arrived whole, and keeps the rest. */
static void take_all(thr_text *arrived,
                     void (*take)(void *user, const thr_message *m, const char *bytes), void *user)
{
  size_t at = 0;
  thr_message message;

  /* The head of a message says how many bytes follow. */
  while (arrived->length - at >= sizeof message) {
    memcpy(&message, arrived->data + at, sizeof message);
    if (arrived->length - at - sizeof message < message.length) break;
    take(user, &message, arrived->data + at + sizeof message);
    at += sizeof message + message.length;
  }

  /* Move what is left to the front. */
  if (at == 0) return;
  arrived->length -= at;
  memmove(arrived->data, arrived->data + at, arrived->length);
}

/* Reads what lies in the pipe; see process.h. */
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

/* Ignores the signals that the terminal sends to the whole process group: the parent decides what
 * to do about them. */
static void leave_signals_to_parent(const sigset_t *mask)
{
  signal(SIGINT, SIG_IGN);
  signal(SIGTERM, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGUSR1, SIG_IGN); /* until run() wants it */
  signal(SIGPIPE, SIG_DFL);
  sigprocmask(SIG_SETMASK, mask, NULL);
}

/* Redirects standard output and error into the pipe `words`: what a library prints goes there, and
 * so does what exit() would flush of the parent's buffers. A full pipe drops the rest. *result
 * moves up if it lies where standard output was closed. */
static bool keep_quiet(int *result, int words)
{
  /* Neither pipe may be one of the three descriptors that are redirected. */
  if (*result < FIRST_FREE) *result = fcntl(*result, F_DUPFD, FIRST_FREE);
  if (words < FIRST_FREE) words = fcntl(words, F_DUPFD, FIRST_FREE);
  return *result >= 0 && words >= 0 && fcntl(words, F_SETFL, O_NONBLOCK) == 0 &&
         dup2(words, 1) >= 0 && dup2(words, 2) >= 0;
}

/* Lets this process be killed when its parent dies. A parent that died before the kernel was told
 * is no longer the parent, and the process ends at once. */
void thr_process_die_with(pid_t parent)
{
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) _exit(1);
}

/* Runs in the child. Never returns. */
static void run_child(bool (*run)(void *user, int fd), void *user, pid_t parent,
                      const sigset_t *mask, int fd, int words)
{
  thr_process_die_with(parent);
  leave_signals_to_parent(mask);
  _exit(keep_quiet(&fd, words) && run(user, fd) ? SENT : 1);
}

/* Opens both pipes. If that fails, errno says why, and nothing is open. */
static bool open_pipes(int result[2], int words[2])
{
  if (pipe(result)) return false;
  if (pipe(words) == 0) return true;

  /* Closing must not hide the reason. */
  int reason = errno;
  close(result[READ]);
  close(result[WRITE]);
  errno = reason;

  return false;
}

/* One start at a time: a child that another thread starts would inherit the end of the pipe that
 * this one is to close, and the parent would never see the end of the result. */
static pthread_mutex_t starting = PTHREAD_MUTEX_INITIALIZER;

/* Forks a child; thr_process_start holds the lock. */
static thr_status start(thr_process *process, bool (*run)(void *user, int fd), void *user,
                        thr_err *err)
{
  int result[2], words[2];
  sigset_t all, old;
  const pid_t parent = getpid();

  if (!open_pipes(result, words))
    return thr_fail(err, THR_ESOLVER, "cannot start a worker: %s; close other programs",
                    strerror(errno));

  /* Block all signals for the fork, or one would run the parent's handler in the child. */
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, &old);
  pid_t pid = fork();
  if (pid == 0) {
    /* The child has a copy of the lock, which it must release. */
    pthread_mutex_unlock(&starting);
    close(result[READ]);
    close(words[READ]);
    run_child(run, user, parent, &old, result[WRITE], words[WRITE]);
  }

  /* The parent keeps the reading ends. */
  int reason = errno;
  sigprocmask(SIG_SETMASK, &old, NULL);
  close(result[WRITE]);
  close(words[WRITE]);

  if (pid > 0) {
    *process = (thr_process){.pid = pid, .pipe = result[READ], .words = words[READ]};
    return THR_OK;
  }

  /* The system gives no process. */
  close(result[READ]);
  close(words[READ]);
  return thr_fail(err, THR_ESOLVER,
                  "cannot start a worker: %s; close other programs or ask for fewer processes",
                  strerror(reason));
}

/* Starts a child; see process.h. */
thr_status thr_process_start(thr_process *process, bool (*run)(void *user, int fd), void *user,
                             thr_err *err)
{
  pthread_mutex_lock(&starting);
  thr_status st = start(process, run, user, err);
  pthread_mutex_unlock(&starting);
  return st;
}

/* Reads the first line of the words that says something, of at most size - 1 bytes. */
static void first_line(int words, char *line, size_t size)
{
  char said[1024];

  /* Do not wait: a process that the child started may still hold the other end. */
  fcntl(words, F_SETFL, O_NONBLOCK);
  ssize_t n = read(words, said, sizeof said - 1);
  said[n > 0 ? n : 0] = '\0';

  /* Skip blanks, and end with the line. */
  const char *word = said;
  while (isspace((unsigned char)*word))
    word++;
  snprintf(line, size, "%.*s", (int)strcspn(word, "\r\n"), word);
}

/* Waits for the end of a child, closes its pipes and returns its wait status, or -1 if somebody
 * else has waited for it. `line` receives the first line of what it printed. */
static int reap(thr_process *process, char *line, size_t size)
{
  int status;
  pid_t got;

  /* A child that still writes is ended by SIGPIPE. */
  close(process->pipe);
  while ((got = waitpid(process->pid, &status, 0)) < 0 && errno == EINTR)
    continue;

  first_line(process->words, line, size);
  close(process->words);
  *process = (thr_process){0};
  return got < 0 ? -1 : status;
}

/* Waits for the end of a child and judges it; see process.h. */
thr_status thr_process_end(thr_process *process, const char *who, const char *advice, thr_err *err)
{
  char line[200];
  int status = reap(process, line, sizeof line);

  /* The text: who, what happened, what was printed, what to do. */
  const char *opening = *line ? " (it said: " : "", *closing = *line ? ")" : "",
             *comma = advice ? "; " : "";
  if (!advice) advice = "";

  if (status != -1 && WIFSIGNALED(status))
    return thr_fail(err, THR_ESOLVER, "%s died of signal %d (%s)%s%s%s%s%s", who, WTERMSIG(status),
                    strsignal(WTERMSIG(status)), opening, line, closing, comma, advice);

  /* A library that ends the process does not know the right exit code. */
  if (status == -1 || WEXITSTATUS(status) != SENT)
    return thr_fail(err, THR_ESOLVER, "%s ended without a result%s%s%s%s%s", who, opening, line,
                    closing, comma, advice);

  return THR_OK;
}

/* Returns the processor time that a process has used, s; 0 if that is not known. */
static double cpu_time(pid_t pid)
{
  clockid_t clock;
  struct timespec used;
  if (clock_getcpuclockid(pid, &clock) || clock_gettime(clock, &used)) return 0;
  return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

/* Returns whether a process sleeps, rather than waits for a processor: the third field of its file
 * in /proc, after a name in brackets. */
static bool sleeps(pid_t pid)
{
  char path[40], line[200] = "";

  /* The name may contain anything, even brackets. */
  snprintf(path, sizeof path, "/proc/%d/stat", (int)pid);
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const ssize_t n = read(fd, line, sizeof line - 1);
  close(fd);
  const char *name_end = n > 0 ? strrchr(line, ')') : NULL;

  return name_end && name_end[1] == ' ' && name_end[2] == 'S';
}

/* Factor on times of grace, as sanitizers slow everything down; and the most times `seconds` that
 * any child gets. */
#if defined __SANITIZE_ADDRESS__
static const double SLOWER = 4;
#else
static const double SLOWER = 1;
#endif
static const double MOST_GRACES = 5;

/* Returns whether a child has had its time to end by itself; see process.h. */
bool thr_grace_over(thr_grace *grace, pid_t pid, double seconds)
{
  const double now = thr_clock(), gone = now - grace->from, used = cpu_time(pid);

  /* The time has not begun. */
  if (grace->from == 0 || gone < 0) return false;
  if (grace->begun == 0) grace->begun = used;

  /* It has slept for so long: it will not end. */
  if (used != grace->used) grace->idle_from = now;
  grace->used = used;

  if (now - grace->idle_from >= seconds && sleeps(pid)) return true;

  /* It has worked for so long, or the machine was busy for much longer. */
  seconds *= SLOWER;

  return gone >= MOST_GRACES * seconds || (gone >= seconds && used - grace->begun >= seconds);
}

/* Returns whether a child waits for itself; see process.h. */
bool thr_process_stuck(thr_process *process)
{
  double cpu = cpu_time(process->pid);

  /* A look counts if no time was used since the last one. */
  process->looks = cpu == process->cpu && sleeps(process->pid) ? process->looks + 1 : 0;
  process->cpu = cpu;

  return process->looks >= STUCK;
}

/* Kills a child, if there is one. */
void thr_process_kill(thr_process *process)
{
  char line[2];
  if (!process->pid) return;
  kill(process->pid, SIGKILL);
  reap(process, line, sizeof line);
}
