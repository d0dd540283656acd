/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One job in a child process: answers of any size, the best so far, deaths, limits, and no child
 * that outlives its parent. */
#define _POSIX_C_SOURCE 200809L
#include "graph/limits.h"
#include "graph/process/process.h"
#include "tests/processes.h"
#include "tests/support.h"

#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char byte_of(size_t i)
{
  return (char)(i * 31 % 251);
}

static thr_status send_bytes(thr_sender *to, size_t n, thr_err *err)
{
  thr_text t = {0};
  for (size_t i = 0; i < n; i++)
    thr_text_append_bytes(&t, &(char){byte_of(i)}, 1);
  thr_status st = thr_child_send(to, &t, err);
  thr_text_destroy(&t);
  return st;
}

static thr_status send_word(thr_sender *to, const char *word, thr_err *err)
{
  return thr_child_send(to, &(thr_text){.data = (char *)(uintptr_t)word, .length = strlen(word)},
                        err);
}

static thr_status send_many_bytes(void *user, const thr_limits *limits, thr_sender *to,
                                  thr_err *err)
{
  (void)limits;
  thr_status st = send_bytes(to, 1000, err); /* replaced */
  return st ? st : send_bytes(to, *(const size_t *)user, err);
}

static const size_t sizes[] = {0, 1, 4096, 65536, 5000001};

START_TEST(an_answer_of_any_size_arrives)
{
  size_t n = sizes[_i];
  thr_child c = {.what = "bytes", .run = send_many_bytes, .user = &n};
  thr_text answer = {0};
  thr_err err = {0};
  int files = open_files();
  ck_assert_msg(!thr_child_run(&c, &(thr_limits){0}, &answer, &err), "%s", err.text);
  ck_assert_uint_eq(answer.length, n);
  for (size_t i = 0; i < n; i++)
    if (answer.data[i] != byte_of(i)) ck_abort_msg("byte %zu", i);
  thr_text_destroy(&answer);
  ck_assert_int_eq(open_files(), files);
  assert_no_children();
}
END_TEST

/* ---- failures ---- */

typedef enum { REFUSE, CRASH, LEAVE, BREAK_OFF } harm;

static thr_status come_to_harm(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)limits;
  struct rlimit none = {0};
  setrlimit(RLIMIT_CORE, &none);
  signal(SIGABRT, SIG_DFL);
  if (send_word(to, "best so far", err)) return err->code;
  switch (*(harm *)user) {
  case REFUSE: return thr_fail(err, THR_EINFEASIBLE, "cannot be done");
  case CRASH: (void)!write(2, "\n  library: no memory\nmore\n", 27); abort();
  case LEAVE: (void)!write(1, "bye", 3); exit(0);
  case BREAK_OFF: break;
  }
  thr_err lost = {0}; /* dies while it sends a message that no pipe holds */
  const struct sigaction die = {.sa_handler = SIG_DFL};
  sigaction(SIGALRM, &die, NULL);
  alarm(1);
  for (;;)
    if (send_bytes(to, 50000001, &lost)) return THR_OK;
}

static thr_status run_harm(harm h, thr_text *answer, thr_err *err)
{
  thr_child c = {.what = "harm", .advice = "do without", .run = come_to_harm, .user = &h};
  thr_status st = thr_child_run(&c, &(thr_limits){0}, answer, err);
  assert_no_children();
  return st;
}

static const struct {
  harm how;
  thr_status status;
  const char *text;
} harms[] = {
    {REFUSE, THR_EINFEASIBLE, "cannot be done"},
    {CRASH, THR_ESOLVER,
     "harm: its process died of signal 6 (Aborted) (it said: library: no memory); do without"},
    {LEAVE, THR_ESOLVER, "harm: its process ended without a result (it said: bye); do without"},
};

START_TEST(a_death_is_a_message_and_leaves_the_best_so_far)
{
  thr_text answer = {0};
  thr_err err = {0};
  ck_assert_int_eq(run_harm(harms[_i].how, &answer, &err), harms[_i].status);
  ck_assert_str_eq(err.text, harms[_i].text);
  ck_assert_str_eq(answer.data, "best so far");
  thr_text_destroy(&answer);
}
END_TEST

START_TEST(half_an_answer_does_not_count)
{
  thr_text answer = {0};
  thr_err err = {0};
  assert_status(run_harm(BREAK_OFF, &answer, &err), THR_ESOLVER, &err, "died of signal 14");
  ck_assert(answer.length == 11 || answer.length == 50000001);
  thr_text_destroy(&answer);
}
END_TEST

START_TEST(memory_that_runs_out_is_a_failure)
{
  size_t n = 100000;
  thr_child c = {.what = "bytes", .run = send_many_bytes, .user = &n};
  long k = 1;
  for (;; k++) {
    thr_text answer = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k); /* in the child as well */
    thr_status st = thr_child_run(&c, &(thr_limits){0}, &answer, &err);
    thr_alloc_fail_at(0);
    thr_text_destroy(&answer);
    if (!st) break;
    ck_assert_int_eq(st, THR_ENOMEM);
    assert_no_children();
  }
  ck_assert_int_gt(k, 5);
}
END_TEST

START_TEST(without_pipes_it_says_so)
{
  size_t n = 1;
  thr_child c = {.what = "bytes", .run = send_many_bytes, .user = &n};
  thr_text answer = {0};
  thr_err err = {0};
  allow_files(3);
  thr_status st = thr_child_run(&c, &(thr_limits){0}, &answer, &err);
  allow_files(64);
  assert_status(st, THR_ESOLVER, &err, "bytes: cannot start a worker");
}
END_TEST

/* The pipes lie then where the child's standard output and error are to be. */
START_TEST(closed_standard_files_do_no_harm)
{
  size_t n = 70000;
  thr_child c = {.what = "bytes", .run = send_many_bytes, .user = &n};
  thr_text answer = {0};
  int kept[3];
  for (int i = 0; i < 3; i++)
    kept[i] = dup(i);
  for (int i = 0; i < 3; i++)
    close(i);
  thr_status st = thr_child_run(&c, &(thr_limits){0}, &answer, NULL);
  for (int i = 0; i < 3; i++) {
    dup2(kept[i], i);
    close(kept[i]);
  }
  ck_assert_int_eq(st, THR_OK);
  ck_assert_uint_eq(answer.length, n);
  thr_text_destroy(&answer);
}
END_TEST

/* ---- progress and work ---- */

typedef struct {
  double best, bound, done;
} seen;

static void note_progress(void *user, const char *what, double best, double bound)
{
  ck_assert_str_eq(what, "adding");
  *(seen *)user = (seen){best, bound, 0};
}

static void note_advance(void *user, const char *what, double done)
{
  ck_assert_str_eq(what, "counting");
  ((seen *)user)->done = done;
}

static thr_status tell_progress(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)user;
  limits->progress(limits->user, "adding", 3, 2);
  limits->advance(limits->user, "counting", 0.25);
  ck_assert(limits->work_kept == 10 && limits->brief);
  *limits->work -= 40;
  return send_word(to, "done", err);
}

START_TEST(progress_and_work_come_back)
{
  seen s = {0};
  double work = 100;
  thr_child c = {.what = "sum", .run = tell_progress};
  thr_limits limits = {.work = &work,
                       .work_kept = 10,
                       .brief = true,
                       .progress = note_progress,
                       .advance = note_advance,
                       .user = &s};
  thr_text answer = {0};
  ck_assert_int_eq(thr_child_run(&c, &limits, &answer, NULL), THR_OK);
  ck_assert_str_eq(answer.data, "done");
  ck_assert(s.best == 3 && s.bound == 2 && s.done == 0.25 && work == 60);
  thr_text_destroy(&answer);
}
END_TEST

/* ---- limits ---- */

static thr_status take_no_heed(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)user;
  (void)limits;
  if (send_word(to, "first", err) || send_word(to, "second", err)) return err->code;
  pause_ms(60000);
  return send_word(to, "third", err);
}

static thr_status stop_when_asked(void *user, const thr_limits *limits, thr_sender *to,
                                  thr_err *err)
{
  (void)user;
  while (!thr_limits_stop(limits))
    pause_ms(1);
  return send_word(to, "own last word", err) ? err->code
                                             : thr_fail(err, THR_ELIMIT, "stopped by itself");
}

/* With an interrupt after 0.2 s, or a deadline then. */
static void assert_stops(const thr_child *c, bool by_interrupt, const char *wanted,
                         const char *word)
{
  thr_limits limits = {.interrupted = &interrupted};
  thr_text answer = {0};
  thr_err err = {0};
  double begin = thr_clock();
  setpgid(0, 0);
  signal(SIGINT, interrupt);
  interrupted = 0;
  if (!by_interrupt) limits.deadline = begin + 0.2;
  pid_t hand = by_interrupt ? fork() : -1;
  if (hand == 0) {
    pause_ms(200);
    kill(0, SIGINT); /* Ctrl-C: the whole process group */
    _exit(0);
  }
  ck_assert_int_eq(thr_child_run(c, &limits, &answer, &err), THR_ELIMIT);
  ck_assert_double_ge(thr_clock() - begin, 0.19);
  ck_assert_double_lt(thr_clock() - begin, 3);
  ck_assert_str_eq(answer.data, wanted);
  assert_one_line(&err, word);
  thr_text_destroy(&answer);
  if (by_interrupt) waitpid(hand, NULL, 0);
  assert_no_children();
}

START_TEST(a_child_that_takes_no_heed_is_killed)
{
  assert_stops(&(thr_child){.what = "sleep", .run = take_no_heed}, _i, "second",
               "sleep: stopped before it was done");
}
END_TEST

START_TEST(a_child_may_stop_by_itself)
{
  assert_stops(&(thr_child){.what = "wait", .run = stop_when_asked}, _i, "own last word",
               "stopped by itself");
}
END_TEST

static bool spin(void *user, int fd)
{
  (void)user;
  for (volatile double x = 0; fd >= 0; x += 1)
    continue;
  return true;
}

static bool sleep_on(void *user, int fd)
{
  (void)user;
  (void)fd;
  pause_ms(60000);
  return true;
}

/* Is it at some of so many looks, so many ms apart? */
static bool found_stuck(bool (*run)(void *user, int fd), int looks, long pause)
{
  thr_process p;
  bool stuck = false;
  ck_assert_int_eq(thr_process_start(&p, run, NULL, NULL), THR_OK);
  pause_ms(200);
  for (int i = 0; i < looks && !stuck; i++) {
    pause_ms(pause);
    stuck = thr_process_stuck(&p);
  }
  thr_process_kill(&p);
  assert_no_children();
  return stuck;
}

START_TEST(a_child_that_waits_for_itself_is_found)
{
  ck_assert(found_stuck(sleep_on, 402, 1));
  ck_assert(!found_stuck(spin, 410, 3));
}
END_TEST

/* A child whose parent is killed: its end of the pipe closes. */
static thr_status sleep_with(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)limits;
  (void)err;
  if (write(*(int *)user, "x", 1) != 1 || send_word(to, "asleep", err)) return THR_ESOLVER;
  pause_ms(60000);
  return THR_OK;
}

START_TEST(a_child_dies_with_its_parent)
{
  int ends[2];
  char byte;
  ck_assert_int_eq(pipe(ends), 0);
  pid_t middle = fork();
  if (middle == 0) {
    thr_text answer = {0};
    thr_child c = {.what = "sleep", .run = sleep_with, .user = &ends[1]};
    close(ends[0]);
    _exit(thr_child_run(&c, &(thr_limits){0}, &answer, NULL));
  }
  close(ends[1]);
  ck_assert_int_eq(read(ends[0], &byte, 1), 1); /* it runs */
  kill(middle, SIGKILL);
  waitpid(middle, NULL, 0);
  struct pollfd last = {.fd = ends[0], .events = POLLIN};
  ck_assert_int_eq(poll(&last, 1, 5000), 1);
  ck_assert_int_eq(read(ends[0], &byte, 1), 0);
  close(ends[0]);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("child");
  ADD_LOOP(s, 20, an_answer_of_any_size_arrives, 0, 5);
  ADD_LOOP(s, 20, a_death_is_a_message_and_leaves_the_best_so_far, 0, 3);
  ADD_TEST(s, 30, half_an_answer_does_not_count);
  ADD_TEST(s, 30, memory_that_runs_out_is_a_failure);
  ADD_TEST(s, 10, without_pipes_it_says_so);
  ADD_TEST(s, 10, closed_standard_files_do_no_harm);
  ADD_TEST(s, 10, progress_and_work_come_back);
  ADD_LOOP(s, 20, a_child_that_takes_no_heed_is_killed, 0, 2);
  ADD_LOOP(s, 20, a_child_may_stop_by_itself, 0, 2);
  ADD_TEST(s, 120, a_child_that_waits_for_itself_is_found);
  ADD_TEST(s, 20, a_child_dies_with_its_parent);
  return run_suite(s);
}
