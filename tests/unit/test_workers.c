/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pool of processes: order, failures, crashes, signals, limits, and nothing left behind. */
#define _POSIX_C_SOURCE 200809L
#include "graph/limits.h"
#include "graph/process/process.h"
#include "tests/processes.h"
#include "tests/support.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { JOBS = 13 };

typedef struct {
  int seen[JOBS];
  double last;
  int calls;
} diary;

static thr_status square(void *user, int job, void *result, thr_err *err)
{
  (void)user;
  (void)err;
  pause_ms(job % 3 * 5); /* they end out of order */
  double value = job * job;
  memcpy(result, &value, sizeof value);
  return THR_OK;
}

static void note_done(void *user, int job, const void *result)
{
  double value;
  memcpy(&value, result, sizeof value);
  ck_assert_double_eq(value, job * job);
  ((diary *)user)->seen[job]++;
}

static void note_advance(void *user, const char *what, double done)
{
  diary *d = user;
  ck_assert_str_eq(what, "squares");
  ck_assert_double_gt(done, d->last);
  d->last = done;
  d->calls++;
}

START_TEST(results_stand_in_order)
{
  diary d = {.last = 0};
  thr_work w = {.n_jobs = JOBS,
                .result_size = sizeof(double),
                .run = square,
                .done = note_done,
                .user = &d,
                .what = "squares"};
  thr_limits limits = {.advance = note_advance, .user = &d};
  double results[JOBS];
  bool finished[JOBS];
  thr_err err = {0};
  int files = open_files();
  ck_assert_msg(!thr_workers_run(&w, _i, &limits, results, finished, &err), "%s", err.text);
  for (int i = 0; i < JOBS; i++) {
    ck_assert(finished[i] && d.seen[i] == 1);
    ck_assert_double_eq(results[i], i * i);
  }
  ck_assert(d.calls == JOBS && d.last == 1);
  ck_assert_int_eq(open_files(), files);
  assert_no_children();
}
END_TEST

START_TEST(no_jobs_is_no_work)
{
  thr_work w = {.run = square, .what = "squares"};
  thr_limits limits = {0};
  bool finished[1];
  ck_assert_int_eq(thr_workers_run(&w, 4, &limits, NULL, finished, NULL), THR_OK);
}
END_TEST

/* More than any pipe holds, so that it arrives in parts. */
enum { LARGE = 3 << 20 };

static thr_status fill_large(void *user, int job, void *result, thr_err *err)
{
  (void)user;
  (void)err;
  for (int i = 0; i < LARGE; i++)
    ((unsigned char *)result)[i] = (unsigned char)(i * 31 + job);
  return THR_OK;
}

static void ignore_alarm(int signal_number)
{
  (void)signal_number;
}

START_TEST(large_results_arrive_whole_in_spite_of_signals)
{
  struct sigaction ring = {
      .sa_handler = ignore_alarm}; /* without SA_RESTART: every call may end with EINTR */
  struct itimerval often = {.it_interval = {.tv_usec = 500}, .it_value = {.tv_usec = 500}},
                   off = {.it_value = {0}};
  thr_work w = {.n_jobs = 4, .result_size = LARGE, .run = fill_large, .what = "large"};
  thr_limits limits = {0};
  unsigned char *results = calloc(4, LARGE);
  bool finished[4];
  thr_err err = {0};
  sigaction(SIGALRM, &ring, NULL);
  setitimer(ITIMER_REAL, &often, NULL);
  thr_status st = thr_workers_run(&w, 2, &limits, results, finished, &err);
  setitimer(ITIMER_REAL, &off, NULL);
  ck_assert_msg(!st, "%s", err.text);
  for (int job = 0; job < 4; job++)
    for (int i = 0; i < LARGE; i++)
      if (results[(size_t)job * LARGE + (size_t)i] != (unsigned char)(i * 31 + job))
        ck_abort_msg("job %d, byte %d", job, i);
  free(results);
  assert_no_children();
}
END_TEST

/* ---- failures ---- */

typedef struct {
  enum { FAIL, CRASH, LEAVE } how;
  int from; /* jobs from this one on do it, the later the sooner */
} harm;

static thr_status come_to_harm(void *user, int job, void *result, thr_err *err)
{
  const harm *h = user;
  memset(result, 1, sizeof(double));
  pause_ms(job < h->from ? 1 : 10 * (JOBS - job) + 20);
  if (job < h->from) return THR_OK;
  if (h->how == FAIL) return thr_fail(err, THR_EINFEASIBLE, "job %d cannot be done", job);
  if (h->how == LEAVE) _exit(0);
  struct rlimit none = {0};
  setrlimit(RLIMIT_CORE, &none);
  signal(SIGABRT, SIG_DFL);
  fprintf(stderr, "\nno room left\nsecond line\n");
  abort();
}

static thr_status run_harm(harm h, int processes, bool *finished, thr_err *err)
{
  thr_work w = {.n_jobs = JOBS,
                .result_size = sizeof(double),
                .run = come_to_harm,
                .user = &h,
                .what = "harm",
                .advice = "take a walk"};
  thr_limits limits = {0};
  double results[JOBS];
  thr_status st = thr_workers_run(&w, processes, &limits, results, finished, err);
  assert_no_children();
  for (int i = 0; i < JOBS; i++)
    ck_assert_int_eq(finished[i], i < h.from);
  return st;
}

START_TEST(the_first_failure_in_job_order_counts)
{
  bool finished[JOBS];
  thr_err err = {0};
  ck_assert_int_eq(run_harm((harm){FAIL, 5}, _i, finished, &err), THR_EINFEASIBLE);
  ck_assert_str_eq(err.text, "job 5 cannot be done");
}
END_TEST

START_TEST(a_crash_is_a_failure_of_its_own)
{
  bool finished[JOBS];
  thr_err err = {0};
  ck_assert_int_eq(run_harm((harm){CRASH, 3}, _i, finished, &err), THR_ESOLVER);
  assert_one_line(&err, "job 4 died of signal 6");
  assert_one_line(&err, "(it said: no room left)");
  assert_one_line(&err, "; take a walk");
  err = (thr_err){0};
  assert_status(run_harm((harm){LEAVE, 0}, _i, finished, &err), THR_ESOLVER, &err,
                "job 1 ended without a result");
}
END_TEST

START_TEST(without_pipes_it_says_so)
{
  thr_work w = {.n_jobs = 2, .result_size = sizeof(double), .run = square, .what = "squares"};
  thr_limits limits = {0};
  double results[2];
  bool finished[2];
  thr_err err = {0};
  allow_files(3); /* none but those that stand open */
  ck_assert_int_eq(thr_workers_run(&w, 2, &limits, results, finished, &err), THR_ESOLVER);
  allow_files(64);
  assert_one_line(&err, "cannot start a worker");
  assert_no_children();
}
END_TEST

/* Pipes for some of the processes only: the others wait for them. */
START_TEST(with_few_pipes_it_gets_there)
{
  thr_work w = {.n_jobs = JOBS, .result_size = sizeof(double), .run = square, .what = "squares"};
  thr_limits limits = {0};
  double results[JOBS];
  bool finished[JOBS];
  thr_err err = {0};
  int spare = dup(0);
  close(spare);
  allow_files(spare + 6); /* two pipes while a process starts, two ends of them while it runs */
  thr_status st = thr_workers_run(&w, 8, &limits, results, finished, &err);
  allow_files(64);
  ck_assert_msg(!st, "%s", err.text);
  for (int i = 0; i < JOBS; i++)
    ck_assert(finished[i] && results[i] == i * i);
}
END_TEST

START_TEST(memory_that_runs_out_is_a_failure)
{
  thr_work w = {.n_jobs = 2, .result_size = sizeof(double), .run = square, .what = "squares"};
  thr_limits limits = {0};
  double results[2];
  bool finished[2];
  long k = 1;
  for (;; k++) {
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = thr_workers_run(&w, 2, &limits, results, finished, &err);
    thr_alloc_fail_at(0);
    if (!st) break;
    ck_assert_int_eq(st, THR_ENOMEM);
    ck_assert(!finished[0] && !finished[1]);
  }
  ck_assert_int_gt(k, 1);
}
END_TEST

/* ---- limits and signals ---- */

/* Job 0 is quick, the others would take a minute. */
static thr_status sleep_long(void *user, int job, void *result, thr_err *err)
{
  (void)user;
  (void)err;
  memset(result, 0, sizeof(double));
  if (job > 0) pause_ms(60000);
  return THR_OK;
}

static void send_interrupt(void *user, int job, const void *result)
{
  (void)user;
  (void)result;
  if (job == 0) kill(0, SIGINT); /* Ctrl-C: the whole process group */
}

START_TEST(an_interrupt_ends_all_children)
{
  setpgid(0, 0);
  signal(SIGINT, interrupt);
  thr_work w = {.n_jobs = 6,
                .result_size = sizeof(double),
                .run = sleep_long,
                .done = send_interrupt,
                .what = "sleep"};
  thr_limits limits = {.interrupted = &interrupted};
  double results[6];
  bool finished[6];
  thr_err err = {0};
  double begin = thr_clock();
  ck_assert_int_eq(thr_workers_run(&w, 3, &limits, results, finished, &err), THR_ELIMIT);
  ck_assert_double_lt(thr_clock() - begin, 5);
  assert_one_line(&err, "1 of 6");
  ck_assert(finished[0] && !finished[1] && !finished[5]);
  assert_no_children();
}
END_TEST

START_TEST(a_deadline_ends_all_children)
{
  thr_work w = {.n_jobs = 4, .result_size = sizeof(double), .run = sleep_long, .what = "sleep"};
  double results[4], begin = thr_clock();
  thr_limits limits = {.deadline = begin + 0.3};
  bool finished[4];
  thr_err err = {0};
  ck_assert_int_eq(thr_workers_run(&w, 2, &limits, results, finished, &err), THR_ELIMIT);
  ck_assert_double_ge(thr_clock() - begin, 0.29);
  ck_assert_double_lt(thr_clock() - begin, 5);
  assert_no_children();
}
END_TEST

/* A child leaves Ctrl-C to the parent: with a parent that goes on, so does the child. */
static thr_status signal_self(void *user, int job, void *result, thr_err *err)
{
  raise(SIGINT);
  raise(SIGTERM);
  return square(user, job, result, err);
}

START_TEST(children_leave_ctrl_c_to_the_parent)
{
  thr_work w = {.n_jobs = 2, .result_size = sizeof(double), .run = signal_self, .what = "squares"};
  thr_limits limits = {0};
  double results[2];
  bool finished[2];
  signal(SIGINT, interrupt);
  ck_assert_int_eq(thr_workers_run(&w, 2, &limits, results, finished, NULL), THR_OK);
  ck_assert(results[1] == 1 && !interrupted);
  sigset_t blocked;
  sigprocmask(SIG_BLOCK, NULL, &blocked);
  ck_assert(!sigismember(&blocked, SIGINT) && !sigismember(&blocked, SIGTERM));
}
END_TEST

START_TEST(buffered_output_is_written_once)
{
  thr_work w = {.n_jobs = 5, .result_size = sizeof(double), .run = square, .what = "squares"};
  thr_limits limits = {0};
  double results[5];
  bool finished[5];
  FILE *file = tmpfile();
  ck_assert_ptr_nonnull(file);
  fputs("once", file); /* still in the buffer that each child gets a copy of */
  ck_assert_int_eq(thr_workers_run(&w, 2, &limits, results, finished, NULL), THR_OK);
  fflush(file);
  ck_assert_int_eq(ftell(file), 4);
  fseek(file, 0, SEEK_END);
  ck_assert_int_eq(ftell(file), 4);
  fclose(file);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("workers");
  ADD_LOOP(s, 20, results_stand_in_order, 0, 5);
  ADD_TEST(s, 10, no_jobs_is_no_work);
  ADD_TEST(s, 30, large_results_arrive_whole_in_spite_of_signals);
  ADD_LOOP(s, 20, the_first_failure_in_job_order_counts, 1, 5);
  ADD_LOOP(s, 20, a_crash_is_a_failure_of_its_own, 1, 5);
  ADD_TEST(s, 10, without_pipes_it_says_so);
  ADD_TEST(s, 20, with_few_pipes_it_gets_there);
  ADD_TEST(s, 10, memory_that_runs_out_is_a_failure);
  ADD_TEST(s, 30, an_interrupt_ends_all_children);
  ADD_TEST(s, 30, a_deadline_ends_all_children);
  ADD_TEST(s, 10, children_leave_ctrl_c_to_the_parent);
  ADD_TEST(s, 10, buffered_output_is_written_once);
  return run_suite(s);
}
