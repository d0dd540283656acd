/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work beside the main thread: children that cannot harm this process, threads, and libraries that
 * are loaded when they are needed. Whatever runs beside each other, results do not depend on how
 * much does.
 *
 * Read process.c first (one child), then child.c (one job in a child, which tells its progress and
 * can be stopped) and workers.c (many jobs in children); threads.c (many jobs in threads) and
 * lazy.c stand by themselves. threads.h declares threads.c and workers.c. */
#ifndef THR_PROCESS_H
#define THR_PROCESS_H

#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

#include <sys/types.h>

/* ---- process.c: A child process that cannot harm its parent: what it prints is kept from the
 * terminal, Ctrl-C is left to the parent, and it dies when the parent dies. */

/* A child process. {0} is valid: no child. */
typedef struct {
  pid_t pid; /* 0 = none */
  int pipe;  /* what the child writes to the descriptor that it is given arrives here */
  int words; /* what it or a library prints, of which thr_process_end quotes the first line */
  int looks; /* of thr_process_stuck, since its processor time grew; that was: */
  double cpu;
} thr_process;

/* Starts a child process. The child calls run(user, fd) and ends; nothing else of the program runs
 * in it, neither buffered output nor exit handlers of the parent. run returns whether its writing
 * succeeded. THR_ESOLVER if the system gives no pipe or process. */
thr_status thr_process_start(thr_process *process, bool (*run)(void *user, int fd), void *user,
                             thr_err *err) THR_MUST_CHECK;

/* Writes n bytes, in spite of signals; returns whether all were written. */
bool thr_process_send(int fd, const char *data, size_t n);

/* A message, followed by `length` bytes. What the others mean is up to sender and receiver. */
typedef struct {
  size_t length;
  double value[2];
  int32_t kind, code;
} thr_message;

/* Writes a message and its bytes; returns whether all was written. */
bool thr_message_send(int fd, thr_message message, const char *bytes);

/* Reads what lies in the pipe, 64 KB at most, and hands over the messages that have arrived whole;
 * `arrived` keeps what has not. As read() returns; 0: the other end is closed. */
ssize_t thr_messages_receive(int fd, thr_text *arrived,
                             void (*take)(void *user, const thr_message *m, const char *bytes),
                             void *user);

/* Waits for the end, closes the pipes and leaves *process empty. THR_ESOLVER if the child did not
 * end by run returning true: the text begins with `who`, says the signal and what was printed, and
 * ends with `advice` (NULL: none). */
thr_status thr_process_end(thr_process *process, const char *who, const char *advice, thr_err *err);

/* Lets this process, a child, be killed when its parent dies, whose id it was told; at once if the
 * parent is dead already. */
void thr_process_die_with(pid_t parent);

/* The time that a process has to end by itself after it was asked to: so many seconds, and as much
 * of its own processor time, so that a busy machine does not kill it before it has sent its result.
 * {0} is valid: it was not asked. */
typedef struct {
  double from;        /* thr_clock() at which it is to begin; 0 = never */
  double begun, used; /* its processor time then, and at the last look, s; 0 before */
  double idle_from;   /* thr_clock() at which that last grew */
} thr_grace;

/* Returns whether this time is over: at the latest after five times `seconds`, and when the process
 * has done nothing but sleep for `seconds`. To be called every 0.05 s or so. */
bool thr_grace_over(thr_grace *grace, pid_t pid, double seconds);

/* Returns whether a child has slept without any work for some 20 s (3 s under sanitizers) of such
 * calls, one every 0.05 s. A library that waits for itself where memory is out while it holds a
 * lock never ends. */
bool thr_process_stuck(thr_process *process);

/* Ends a child at once, whatever it does, and closes the pipes; nothing if there is no child. */
void thr_process_kill(thr_process *process);

/* ---- child.c: One job in a child process, with an answer of any size: for libraries that may
 * crash, end the program or take no heed of time. */

/* What a job needs to send its answer to the parent. */
typedef struct thr_sender thr_sender;

/* A job for a child. */
typedef struct {
  const char *what;   /* messages begin with it, e.g. "sheets.pdf" */
  const char *advice; /* what to do if the child dies, ends its message; NULL: nothing known */
  /* Runs in the child, with the deadline, progress and work of the parent's limits; an interrupt of
   * the parent's reaches it too. What it sends last is the answer. Returns a failure, whose text is
   * carried back, or THR_ELIMIT with the best so far sent. */
  thr_status (*run)(void *user, const thr_limits *limits, thr_sender *to, thr_err *err);
  /* NULL; or called in the parent while it waits, every 0.05 s at least. A child that is to stop is
   * then killed after `grace` seconds by the clock, at most and where that is 0 a third of one */
  void (*look)(void *user);
  double grace;
  void *user;
} thr_child;

/* Sends, in the child, all bytes of `answer` in place of what was sent before. Sent now and then,
 * it is the best so far that the parent has when it must end the child. Fails if the text failed
 * (THR_ENOMEM) or the parent no longer listens (THR_ESOLVER). */
thr_status thr_child_send(thr_sender *to, const thr_text *answer, thr_err *err) THR_MUST_CHECK;

/* Runs the job and waits. At the deadline or an interrupt the child is asked to stop and killed a
 * third of a second later: THR_ELIMIT. A child that dies is THR_ESOLVER. Whatever the status,
 * *answer (empty before) holds what was sent last and arrived whole, of length 0 if there is none;
 * the caller frees it. What the child took of limits->work is taken here, unless it was killed or
 * died. */
thr_status thr_child_run(const thr_child *child, const thr_limits *limits, thr_text *answer,
                         thr_err *err) THR_MUST_CHECK;

/* ---- lazy.c: Libraries that few commands need are loaded when one of their functions is first
 * called: what starts `thread check` is small. */

/* A function of a library. */
typedef struct {
  const char *name;
  void *pointer;        /* address of a pointer to a function, which receives that of this name */
  void (*linked)(void); /* the function, where the library is linked with the program (THR_LINKED);
                           else NULL */
} thr_lazy_symbol;

/* For a list of functions  #define FUNCTIONS(F) F(one) F(two):
 * struct { FUNCTIONS(THR_LAZY_POINTER) bool loaded; } lib, and the symbols
 * {FUNCTIONS(THR_LAZY_SYMBOL)} that fill it. */
#define THR_LAZY_POINTER(f) __typeof__(f) *(f);
#ifdef THR_LINKED
#define THR_LAZY_SYMBOL(f) {#f, &lib.f, (void (*)(void))(f)},
#else
#define THR_LAZY_SYMBOL(f) {#f, &lib.f, NULL},
#endif

/* Loads a library, unless *loaded, by the name that the run-time linker knows it by (libz.so.1) and
 * fills the pointers, from it and from the libraries that it needs itself. What is loaded stays.
 * THR_ESOLVER with the linker's reason and what to do. A few ms. */
thr_status thr_lazy_load(bool *loaded, const char *library, const thr_lazy_symbol *symbol, size_t n,
                         thr_err *err) THR_MUST_CHECK;

/* ---- Independent jobs beside each other: in threads and teams of threads, or in forked processes.
 * process.h says in which order to read the folder. */

/* ---- threads.c: Independent jobs in threads of this process; each writes to its own place, so
 * that the outcome is the same whatever the number of threads. */

/* One job. limits: those of thr_threads_run, for one thread, whose functions may be called from any
 * thread. */
typedef thr_status thr_threads_job(void *user, int job, const thr_limits *limits, thr_err *err);

/* Runs jobs 0 .. n_jobs - 1, begun in this order, in limits->threads threads, this one among them
 * (fewer if the system has no more; one where limits->work counts what they do). After a failure no
 * more are begun: the status and text are those of the failed job of lowest number, the same
 * whatever the number of threads. */
thr_status thr_threads_run(int n_jobs, thr_threads_job *run, void *user, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;

/* Runs at most THR_BESIDE jobs in the same way, as if each had a processor of its own: where work
 * is counted, each has all that is left, and as much is gone as took the one that took most. */
enum { THR_BESIDE = 4 };
thr_status thr_threads_beside(int n_jobs, thr_threads_job *run, void *user,
                              const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Threads that stay from run to run. */
typedef struct thr_team thr_team;

/* Makes a team of at most `most` threads, this one among them, and at most limits->threads; as
 * above. limits must outlive the team. Release with thr_team_destroy (NULL ok). */
thr_status thr_team_create(thr_team **team, int most, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;
void thr_team_destroy(thr_team *team);

/* Runs jobs 0 .. n_jobs - 1, all of them: job k of every run in the same thread, job 0 in the one
 * that made the team and calls this. Of failures the one of lowest number is told. */
thr_status thr_team_run(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                        thr_err *err) THR_MUST_CHECK;

/* Runs jobs as thr_threads_run does: whichever thread is free takes the next job; job 0 is done in
 * the one that made the team and calls this. */
thr_status thr_team_share(thr_team *team, int n_jobs, thr_threads_job *run, void *user,
                          thr_err *err) THR_MUST_CHECK;

/* ---- workers.c: Independent jobs in forked processes; results in fixed order, whatever the number
 * of processes. */

/* Jobs for forked processes. */
typedef struct {
  int n_jobs;
  size_t result_size; /* bytes of one result: plain data without pointers */
  /* Runs in a child process: fills result, or returns a failure whose text is carried back. */
  thr_status (*run)(void *user, int job, void *result, thr_err *err);
  /* Runs in the parent as each job ends, in any order: e.g. to store it in the cache. May be NULL.
   */
  void (*done)(void *user, int job, const void *result);
  void *user;
  const char *what;   /* for the progress line and for messages */
  const char *advice; /* what to do if a child dies, ends its message; NULL: nothing known */
} thr_work;

/* Runs the jobs, and fills results[n_jobs * result_size] and finished[n_jobs]. Stops on the limits
 * (THR_ELIMIT; finished says which results count) and on the first failing job in job order: its
 * status and text, and no later job counts as finished. A child that dies is THR_ESOLVER. processes
 * <= 1 still forks one child at a time, so that a crash in a library cannot take the parent with
 * it. limits->advance is called in the parent with the part of the jobs that is done. No child is
 * left, running or as a zombie. */
thr_status thr_workers_run(const thr_work *work, int processes, const thr_limits *limits,
                           void *results, bool *finished, thr_err *err) THR_MUST_CHECK;

#endif
