/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three threadings of the 7x7 dome: the order of their pulls by every method and under varied
 * settings of the simulation. */
#include "eval/eval.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/process/process.h"
#include "tests/validate/validate.h"

#include <stdio.h>
#include <unistd.h>

enum { PLANS = 3 };
static const char *const name[PLANS] = {"lines", "stairs", "snake"};

typedef struct {
  const char *what;
  thr_method method;
  double time_step, iterations;
  uint64_t seed;
} setting;

static const setting settings[] = {
    {"closed form: seating pull, N", THR_CAPSTAN, 1, 1, 1},
    {"joints in Bullet: seating pull, N", THR_JOINT, 1, 1, 1},
    {"the same, another seed", THR_JOINT, 1, 1, 2},
    {"the same, time step halved", THR_JOINT, 0.5, 1, 1},
    {"limit analysis: holding pull at least, N", THR_STRUCTURE, 1, 1, 1}};
enum { SETTINGS = sizeof settings / sizeof *settings };

typedef struct {
  double largest, lower, upper, residual;
} pulls;

typedef struct {
  thr_plan plan[PLANS];
  const int *job; /* setting x PLANS + plan */
  int processes;  /* inside a job */
} context;

static thr_status run(void *user, int i, void *result, thr_err *err)
{
  const context *c = user;
  const setting *s = &settings[c->job[i] / PLANS];
  const thr_plan *p = &c->plan[c->job[i] % PLANS];
  thr_eval_options o = thr_eval_options_default();
  o.time_step = s->time_step;
  o.iterations = s->iterations;
  o.seed = s->seed;
  o.processes = c->processes;
  thr_eval e;
  thr_limits none = {0};
  thr_status st = thr_eval_plan(&p->frame, p->cord, p->n_cords, s->method, &o, &none, &e, err);
  if (st) return st;
  *(pulls *)result =
      (pulls){e.record.largest, e.holding.lower, e.holding.upper, e.holding.residual};
  thr_eval_destroy(&e);
  return THR_OK;
}

static thr_status run_jobs(context *c, const int *job, int n, pulls *found, thr_err *err)
{
  bool finished[SETTINGS * PLANS];
  int processors = (int)sysconf(_SC_NPROCESSORS_ONLN);
  thr_limits none = {0};
  thr_work w = {.n_jobs = n, .result_size = sizeof *found, .run = run, .user = c, .what = "dome"};
  c->job = job;
  return thr_workers_run(&w, processors, &none, found, finished, err);
}

static void judge(report *r, const char *what, const double value[PLANS])
{
  char found[120];
  snprintf(found, sizeof found, "%.4g, %.4g, %.4g", value[0], value[1], value[2]);
  report_holds(r, what, "lines < stairs < snake", found,
               value[0] < value[1] && value[1] < value[2]);
}

static void judge_all(report *r, pulls (*p)[PLANS])
{
  double value[PLANS];
  report_section(r, "Three threadings of the 7x7 dome",
                 "data/dome7-lines.json, -stairs.json, -snake.json: 14 straight cords, 12 "
                 "staircases, one snake. The order must "
                 "be the same by every "
                 "method and under every setting.");
  for (int s = 0; s < SETTINGS; s++) {
    for (int i = 0; i < PLANS; i++)
      value[i] = settings[s].method == THR_STRUCTURE ? p[s][i].lower : p[s][i].largest;
    judge(r, settings[s].what, value);
  }
  int s = SETTINGS - 1;
  for (int i = 0; i < PLANS; i++)
    value[i] = p[s][i].upper;
  judge(r, "limit analysis: holding pull at most, N", value);
  for (int i = 0; i < PLANS; i++) {
    char what[80];
    snprintf(what, sizeof what, "%s: violation of the bound's proof", name[i]);
    report_at_most(r, what, p[s][i].residual, 1e-6);
  }
}

thr_status validate_ranking(report *r, thr_err *err)
{
  context c = {.processes = 1};
  pulls found[SETTINGS][PLANS];
  int job[SETTINGS * PLANS];
  thr_status st = THR_OK;
  for (int i = 0; i < PLANS && !st; i++) {
    char path[64];
    snprintf(path, sizeof path, "data/dome7-%s.json", name[i]);
    st = thr_plan_read(&c.plan[i], path, err);
  }
  for (int i = 0; i < SETTINGS * PLANS; i++)
    job[i] = i;
  if (!st) st = run_jobs(&c, job, SETTINGS * PLANS, found[0], err);
  if (!st) judge_all(r, found);
  for (int i = 0; i < PLANS; i++)
    thr_plan_destroy(&c.plan[i]);
  return st;
}
