/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans that are made in two threads at once are those that one thread makes; jobs in many threads
 * come to what they do in one.
 */
#define _POSIX_C_SOURCE 200809L
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/process/process.h"
#include "planner/planner.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <pthread.h>
#include <string.h>

/* What is planned: of every objective and joint, several cords, cut trees, symmetries, linear
 * programmes in children. */
static void request_number(int i, thr_frame *f, thr_request *o)
{
  *o = thr_request_default();
  o->confirm = THR_CONFIRM_NEVER; /* for a second at most: which second is not ours to say */
  *f = i % 2 ? solid_make(CUBE) : wheel_make(7);
  o->ends = i % 3 ? THR_ENDS_ANY : THR_ENDS_CLOSED;
  switch (i % 5) {
  case 0: break;
  case 1: o->aims = thr_aims_straightest; break;
  case 2: o->aims = thr_aims_symmetric; break;
  case 3: o->joint = THR_JOINT_TUBE; break;
  default:
    o->cords = o->cords_least = 3;
    ck_assert_int_eq(thr_aims_parse("longest", o, NULL), THR_OK);
  }
}
enum { N_REQUESTS = 10 };

/* As it is written; "" if there is none. */
static void plan_number(int i, thr_text *t)
{
  thr_frame f;
  thr_request o;
  thr_plan p;
  request_number(i, &f, &o);
  thr_status st = thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, NULL);
  if (st == THR_OK || st == THR_ELIMIT) thr_plan_write(&p, t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}

typedef struct {
  int first;
  thr_text plan[N_REQUESTS];
} work;

static void *plan_all(void *user)
{
  work *w = user;
  for (int i = 0; i < N_REQUESTS; i++)
    plan_number((w->first + i) % N_REQUESTS, &w->plan[(w->first + i) % N_REQUESTS]);
  return NULL;
}

START_TEST(two_threads_plan_as_one)
{
  work w[3] = {{.first = 0}, {.first = 0}, {.first = N_REQUESTS / 2}};
  pthread_t thread[2];
  plan_all(&w[0]);
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(pthread_create(&thread[k], NULL, plan_all, &w[k + 1]), 0);
  for (int k = 0; k < 2; k++)
    ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
  for (int i = 0; i < N_REQUESTS; i++) {
    ck_assert(w[0].plan[i].length > 100);
    for (int k = 1; k < 3; k++)
      ck_assert_str_eq(w[k].plan[i].data, w[0].plan[i].data);
    for (int k = 0; k < 3; k++)
      thr_text_destroy(&w[k].plan[i]);
  }
}
END_TEST

/* ---- jobs ---- */

enum { N_JOBS = 200 };

typedef struct {
  int value[N_JOBS], calls[N_JOBS], fails_from, said;
} jobs;

static void note_advance(void *user, const char *what, double done)
{
  jobs *j = user;
  ck_assert_str_eq(what, "squares");
  ck_assert(done >= 0 && done <= 1);
  j->said++; /* by one thread at a time, or the count is wrong */
}

static thr_status square(void *user, int job, const thr_limits *limits, thr_err *err)
{
  jobs *j = user;
  ck_assert_int_eq(limits->threads, 1);
  for (int i = 0; i < 20; i++)
    limits->advance(limits->user, "squares", (double)job / N_JOBS);
  j->calls[job]++;
  if (job >= j->fails_from) return thr_fail(err, THR_EINPUT, "job %d", job);
  j->value[job] = job * job;
  return THR_OK;
}

START_TEST(jobs_come_to_the_same)
{
  static const int threads[] = {0, 1, 2, 16, 1000};
  jobs j = {.fails_from = N_JOBS};
  const thr_limits limits = {.threads = threads[_i], .advance = note_advance, .user = &j};
  ck_assert_int_eq(thr_threads_run(N_JOBS, square, &j, &limits, NULL), THR_OK);
  for (int i = 0; i < N_JOBS; i++)
    ck_assert(j.value[i] == i * i && j.calls[i] == 1);
  ck_assert_int_eq(j.said, 20 * N_JOBS);
  ck_assert_int_eq(thr_threads_run(0, square, &j, &limits, NULL), THR_OK);
}
END_TEST

START_TEST(the_first_failure_is_told)
{
  static const int threads[] = {0, 1, 2, 16, 1000};
  jobs j = {.fails_from = 50};
  thr_err err = {0};
  const thr_limits limits = {.threads = threads[_i], .advance = note_advance, .user = &j};
  ck_assert_int_eq(thr_threads_run(N_JOBS, square, &j, &limits, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "job 50");
  for (int i = 0; i < 50; i++)
    ck_assert(j.value[i] == i * i && j.calls[i] == 1);
}
END_TEST

/* Spends job + 1 s of its own, more than is left from the third job on. */
static thr_status spend(void *user, int job, const thr_limits *limits, thr_err *err)
{
  jobs *j = user;
  (void)err;
  j->calls[job]++;
  thr_limits_spend(limits, job + 1);
  j->value[job] = thr_limits_left(limits, 1) > 0;
  return THR_OK;
}

START_TEST(work_beside_each_other_is_that_of_the_longest)
{
  static const int threads[] = {0, 1, 2, 16, 1000};
  jobs j = {.fails_from = N_JOBS};
  double left = 12;
  thr_limits limits = {.threads = threads[_i], .work = &left, .work_kept = 9.5};
  ck_assert_int_eq(thr_threads_beside(2, spend, &j, &limits, NULL), THR_OK);
  ck_assert_double_eq_tol(left, 10, 1e-12); /* 2 s of the second job */
  ck_assert(j.value[0] == 1 && j.value[1] == 1);
  left = 12;
  ck_assert_int_eq(thr_threads_beside(3, spend, &j, &limits, NULL), THR_OK);
  ck_assert_double_eq_tol(left, 9, 1e-12);
  ck_assert(j.calls[0] == 2 && j.calls[1] == 2 && j.calls[2] == 1 && j.value[1] == 1 &&
            j.value[2] == 0);
  limits.work = NULL;
  ck_assert_int_eq(thr_threads_beside(2, spend, &j, &limits, NULL), THR_OK);
  ck_assert(j.calls[1] == 3 && left == 9);
}
END_TEST

/* Where each job was last done: in the same thread every time. */
typedef struct {
  pthread_t thread[N_JOBS];
  int runs, fails_from;
} places;

static thr_status stay(void *user, int job, const thr_limits *limits, thr_err *err)
{
  places *p = user;
  ck_assert_int_eq(limits->threads, 1);
  if (p->runs > 0) ck_assert(pthread_equal(p->thread[job], pthread_self()));
  p->thread[job] = pthread_self();
  return job >= p->fails_from ? thr_fail(err, THR_EINPUT, "job %d", job) : THR_OK;
}

START_TEST(a_team_does_the_same_job_in_the_same_thread)
{
  static const int threads[] = {0, 1, 2, 16, 1000};
  places p = {.fails_from = 50};
  thr_err err = {0};
  const thr_limits limits = {.threads = threads[_i]};
  thr_team *team;
  ck_assert_int_eq(thr_team_create(&team, 20, &limits, NULL), THR_OK);
  for (; p.runs < 20; p.runs++) {
    ck_assert_int_eq(thr_team_run(team, p.runs ? p.runs : 50, stay, &p, NULL), THR_OK);
    ck_assert(pthread_equal(p.thread[0], pthread_self()));
    if (threads[_i] > 1) ck_assert(!pthread_equal(p.thread[1], pthread_self()));
  }
  p.runs = 0;
  ck_assert_int_eq(thr_team_run(team, N_JOBS, stay, &p, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "job 50");
  ck_assert_int_eq(thr_team_run(team, 0, stay, &p, NULL), THR_OK);
  thr_team_destroy(team);
  thr_team_destroy(NULL);
}
END_TEST

/* Shared by the team of a caller, whose job is always the first. */
typedef struct {
  int calls[N_JOBS];
  pthread_t first;
} shared;

static thr_status note_thread(void *user, int job, const thr_limits *limits, thr_err *err)
{
  shared *s = user;
  ck_assert_int_eq(limits->threads, 1);
  s->calls[job]++;
  if (job == 0) s->first = pthread_self();
  return job == 7 && s->calls[job] == 20 ? thr_fail(err, THR_EINPUT, "job %d", job) : THR_OK;
}

START_TEST(a_team_shares_jobs)
{
  static const int threads[] = {0, 1, 2, 16, 1000};
  shared s = {0};
  thr_err err = {0};
  const thr_limits limits = {.threads = threads[_i]};
  thr_team *team;
  ck_assert_int_eq(thr_team_create(&team, 20, &limits, NULL), THR_OK);
  for (int runs = 1; runs < 20; runs++) {
    ck_assert_int_eq(thr_team_share(team, N_JOBS, note_thread, &s, NULL), THR_OK);
    ck_assert(pthread_equal(s.first, pthread_self()));
    for (int i = 0; i < N_JOBS; i++)
      ck_assert_int_eq(s.calls[i], runs);
  }
  ck_assert_int_eq(thr_team_share(team, 0, note_thread, &s, NULL), THR_OK);
  ck_assert_int_eq(s.calls[0], 19);
  ck_assert_int_eq(thr_team_share(team, N_JOBS, note_thread, &s, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "job 7");
  thr_team_destroy(team);
}
END_TEST

/* Plans of a request in 1, 2 and 16 threads, as they are written with their proofs, are the same;
 * *plan: one of them. most: work that each may do, counted; 0: any. */
static void plan_in_threads(const thr_frame *f, const thr_request *o, double most,
                            thr_status expected, thr_plan *plan)
{
  static const int threads[] = {1, 2, 16};
  thr_text written[3] = {{0}, {0}, {0}};
  for (int k = 0; k < 3; k++) {
    double left = most;
    thr_limits limits = {.threads = threads[k]};
    if (most > 0)
      limits = (thr_limits){.threads = threads[k], .work = &left, .deadline = thr_clock() + 1000};
    ck_assert_int_eq(thr_plan_make(f, o, &limits, plan, NULL, NULL), expected);
    ck_assert_double_le(left, .01);
    thr_plan_write(plan, &written[k]);
    ck_assert_str_eq(written[k].data, written[0].data);
    if (k < 2) thr_plan_destroy(plan);
  }
  for (int k = 0; k < 3; k++)
    thr_text_destroy(&written[k]);
}

/* Nodes of the tree and tries of cycles. */
START_TEST(the_least_turning_does_not_depend_on_threads)
{
  thr_frame f = shape_make(_i % 2 ? THR_MAKE_HONEYCOMB : THR_MAKE_SPHERE, _i % 2 ? 4 : 2, 0);
  thr_request o = thr_request_default();
  thr_plan p;
  o.aims = thr_aims_straightest;
  o.gap = 0; /* on to the proof */
  o.ends = THR_ENDS_ANY;
  if (_i % 2)
    o.turning.length_slack = 0;
  else
    o.turning.nodes = 41;
  plan_in_threads(&f, &o, 0, _i % 2 ? THR_OK : THR_ELIMIT, &p);
  if (_i % 2) ck_assert_int_gt(p.turning.tree.n_nodes, 10);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Work ends the search for the cord that turns most, which anneals beside the programme over walks.
 */
START_TEST(the_largest_turning_does_not_depend_on_threads)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_request o = thr_request_default();
  thr_plan p;
  o.aims = (thr_aims){1, {THR_AIM_MAX_TURNING}};
  o.ends = THR_ENDS_ANY;
  o.cords = o.cords_least = 4;
  plan_in_threads(&f, &o, .3, THR_ELIMIT, &p);
  ck_assert(p.n_cords == 4 && p.turning.tree.walks.unit > 0);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The table of symmetries has its rows solved in threads. */
START_TEST(symmetries_do_not_depend_on_threads)
{
  thr_symmetries table[2];
  thr_frame f = _i % 2 ? solid_make(CUBE) : grid_make(4, 4);
  thr_request o = thr_request_default();
  o.aims = thr_aims_symmetric;
  o.ends = _i / 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED;
  for (int k = 0; k < 2; k++)
    ck_assert_int_ne(
        thr_symmetries_find(&f, &o, false, &(thr_limits){.threads = k ? 3 : 1}, &table[k], NULL),
        THR_ENOMEM);
  ck_assert_int_gt(table[0].n, 2);
  ck_assert_int_eq(table[1].n, table[0].n);
  ck_assert_int_eq(table[1].chosen, table[0].chosen);
  for (int i = 0; i < table[0].n; i++) {
    const thr_symmetry_row *a = &table[0].row[i], *b = &table[1].row[i];
    ck_assert(a->n_cords == b->n_cords && a->metrics.length == b->metrics.length &&
              a->metrics.turning == b->metrics.turning);
    for (int c = 0; c < a->n_cords; c++) {
      ck_assert_int_eq(a->cord[c].n_passes, b->cord[c].n_passes);
      ck_assert_mem_eq(a->cord[c].half, b->cord[c].half,
                       (size_t)a->cord[c].n_passes * sizeof *a->cord[c].half);
    }
  }
  for (int k = 0; k < 2; k++)
    thr_symmetries_destroy(&table[k]);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("threads");
  ADD_TEST(s, 120, two_threads_plan_as_one);
  ADD_EXAMPLES(s, 60, jobs_come_to_the_same, 5);
  ADD_EXAMPLES(s, 60, work_beside_each_other_is_that_of_the_longest, 5);
  ADD_EXAMPLES(s, 60, the_first_failure_is_told, 5);
  ADD_EXAMPLES(s, 60, a_team_does_the_same_job_in_the_same_thread, 5);
  ADD_EXAMPLES(s, 60, a_team_shares_jobs, 5);
  ADD_EXAMPLES(s, 120, the_least_turning_does_not_depend_on_threads, 2);
  ADD_TEST(s, 120, the_largest_turning_does_not_depend_on_threads);
  ADD_EXAMPLES(s, 60, symmetries_do_not_depend_on_threads, 4);
  return run_suite(s);
}
