/* Method structure: every cord's tension profile by the capstan law, the pull by limit analysis, its failure shown by Bullet. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "eval/methods.h"
#include "eval/structure/beads.h"
#include "eval/structure/holding.h"
#include "eval/structure/settle.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/process/child.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Above this the band over mu would cost more than the answer. */
enum { BAND_LARGEST = 100 };

static int pass_count(const thr_evaluation *r)
{
  int most = 1;
  for (int i = 0; i < r->n_cords; i++)
    if (r->cord[i].n_passes > most) most = r->cord[i].n_passes;
  return most;
}

/* Profile of one cord whose harder pulled end has 1. */
static thr_status profile(const thr_frame *f, const thr_cord *cord, double mu, double *exponent, thr_eval_cord *c, thr_err *err)
{
  c->turning = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    double turn = thr_turn_angle(f, cord->half[k], cord->half[k + 1]);
    exponent[k] = mu * turn;
    c->turning += turn;
  }
  free(c->tension);
  c->tension = NULL;
  thr_status st = thr_profile_cord(c, cord->id, cord->n_passes, exponent, c->pull, 1, err);
  if (st) return st;
  double force = c->force;
  for (int k = 0; k < cord->n_passes; k++)
    c->tension[k] /= force;
  c->other_force /= force;
  c->force = 1;
  c->taut_turning = c->turning;
  return THR_OK;
}

/* Profiles of all cords at a friction of mu; tension[n_cords] receives them, borrowed from the record. */
static thr_status profiles(const thr_frame *f, const thr_cord *cord, double mu, thr_evaluation *r, const double **tension,
                           thr_err *err)
{
  double *exponent = thr_calloc((size_t)pass_count(r), sizeof *exponent);
  thr_status st = exponent ? THR_OK : thr_nomem(err);
  for (int i = 0; i < r->n_cords && !st; i++) {
    st = profile(f, &cord[i], mu, exponent, &r->cord[i], err);
    tension[i] = r->cord[i].tension;
  }
  free(exponent);
  return st;
}

static thr_status hold(const thr_frame *f, const thr_cord *cord, const thr_beads *b, double mu, bool want_upper,
                       const thr_limits *limits, thr_evaluation *r, const double **tension, thr_holding *out, thr_err *err)
{
  double *press = thr_calloc((size_t)b->n_faces, sizeof *press);
  thr_status st = press ? profiles(f, cord, mu, r, tension, err) : thr_nomem(err);
  if (!st) {
    thr_holding_press(cord, r->n_cords, tension, press);
    st = thr_holding_pull(b, f, &r->physics, press, want_upper, limits, out, err);
  }
  free(press);
  return st;
}

/* One end of the band: unknown where tensions span more than numbers can hold, or than the solver can. */
static thr_status band_end(const thr_frame *f, const thr_cord *cord, const thr_beads *b, double mu, const thr_limits *limits,
                           thr_evaluation *r, const double **tension, double *out, thr_err *err)
{
  thr_err why = {0};
  thr_holding h = {0};
  thr_status st = hold(f, cord, b, mu, false, limits, r, tension, &h, &why);
  *out = st == THR_OK ? h.lower : st == THR_EINFEASIBLE ? INFINITY : NAN;
  thr_holding_destroy(&h);
  if (st == THR_OK || st == THR_EINFEASIBLE || st == THR_EINPUT || st == THR_ESOLVER) return THR_OK;
  return thr_fail(err, st, "%s", why.text);
}

/* Holding pull at both ends of the band of mu, on a copy of the record's cords. */
static thr_status band(const thr_frame *f, const thr_cord *cord, const thr_beads *b, const thr_limits *limits,
                       const thr_evaluation *r, double out[2], thr_err *err)
{
  thr_evaluation copy = *r;
  const double mu[2] = {r->physics.mu_low, r->physics.mu_high}, **tension = thr_calloc((size_t)r->n_cords, sizeof *tension);
  copy.cord = thr_calloc((size_t)r->n_cords, sizeof *copy.cord);
  thr_status st = tension && copy.cord ? THR_OK : thr_nomem(err);
  for (int i = 0; i < r->n_cords && !st; i++)
    copy.cord[i] = (thr_eval_cord){.pull = r->cord[i].pull, .n_passes = r->cord[i].n_passes};
  for (int i = 0; i < 2 && !st; i++)
    st = band_end(f, cord, b, mu[i], limits, &copy, tension, &out[i], err);
  free(tension);
  if (copy.cord) thr_evaluation_destroy(&copy);
  return st;
}

/* From profiles of a pull of 1 to newtons. */
static void fill_record(thr_evaluation *r, double pull)
{
  for (int i = 0; i < r->n_cords; i++) {
    thr_eval_cord *c = &r->cord[i];
    for (int k = 0; k < c->n_passes; k++)
      c->tension[k] *= pull;
    c->force = pull;
    c->other_force *= pull;
    c->work = c->force + c->other_force;
    c->loss = pull > 0 ? 1 - c->tension[c->slackest] / c->force : 0;
    c->known = true;
  }
}

/* What is not known stays empty. */
static void clear_record(thr_evaluation *r)
{
  for (int i = 0; i < r->n_cords; i++) {
    free(r->cord[i].tension);
    r->cord[i] = (thr_eval_cord){.pull = r->cord[i].pull, .n_passes = r->cord[i].n_passes};
  }
}

/* ---- the simulation, in a child process: Bullet does not look whether it was given memory ---- */

typedef struct {
  const thr_frame *f;
  const thr_cord *cord;
  const thr_beads *b;
  const thr_physics *physics;
  int n_cords;
  const double **tension;
  thr_settle_options o;
} simulation;

static thr_status simulate(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const simulation *m = user;
  thr_settle found = {0};
  thr_text t = {0};
  thr_status st = thr_settle_run(m->b, m->f, m->cord, m->n_cords, m->tension, m->physics, &m->o, limits, &found, err);
  size_t poses = (size_t)found.n_beads * sizeof *found.before;
  if (!st) {
    thr_text_append_bytes(&t, (const char *)&found, sizeof found);
    if (found.before) thr_text_append_bytes(&t, (const char *)found.before, poses);
    if (found.after) thr_text_append_bytes(&t, (const char *)found.after, poses);
    st = thr_child_send(to, &t, err);
  }
  thr_text_destroy(&t);
  thr_settle_destroy(&found);
  return st;
}

/* Moves n poses from the text at *at, which goes on behind them; NULL if there are none or no memory. */
static double (*take_poses(const char **at, bool present, size_t n))[7]
{
  double(*pose)[7] = present ? thr_calloc(n, sizeof *pose) : NULL;
  if (pose) memcpy(pose, *at, n * sizeof *pose);
  if (present) *at += n * sizeof *pose;
  return pose;
}

static thr_status take_settle(const thr_text *t, thr_settle *out, thr_err *err)
{
  memcpy(out, t->data, sizeof *out);
  const char *at = t->data + sizeof *out;
  const bool before = out->before, after = out->after; /* there, not here */
  out->before = take_poses(&at, before, (size_t)out->n_beads);
  out->after = take_poses(&at, after, (size_t)out->n_beads);
  if ((!before || out->before) && (!after || out->after)) return THR_OK;
  thr_settle_destroy(out);
  return thr_nomem(err);
}

static thr_status settle(simulation *m, const thr_limits *limits, thr_settle *out, thr_err *err)
{
  const thr_child child = {.what = "simulating the structure", .advice = "use --no-dynamics", .run = simulate, .user = m};
  thr_text answer = {0};
  *out = (thr_settle){0};
  thr_status st = thr_child_run(&child, limits, &answer, err);
  if (!st) st = take_settle(&answer, out, err);
  thr_text_destroy(&answer);
  return st;
}

/* The pull, then what is worth less than it, so that a stop leaves the most. */
static thr_status run(const thr_frame *f, const thr_cord *cord, const thr_beads *b, const thr_eval_options *o,
                      const thr_limits *limits, const double **tension, thr_eval *out, thr_err *err)
{
  thr_evaluation *r = &out->record;
  out->band[0] = out->band[1] = NAN;
  thr_status st = hold(f, cord, b, r->physics.mu, true, limits, r, tension, &out->holding, err);
  if (st) {
    clear_record(r);
    return st;
  }
  double start = o->start > 0 ? o->start : 3 * out->holding.lower;
  if (o->dynamics && start > 0 && b->n_beads <= thr_settle_largest) {
    simulation m = {f,
                    cord,
                    b,
                    &r->physics,
                    r->n_cords,
                    tension,
                    {.start = start, .time_step = o->time_step, .iterations = o->iterations, .seed = o->seed}};
    st = settle(&m, limits, &out->settle, err);
    thr_settle_judge(&out->settle, start, out->holding.upper);
  }
  if (!st && b->n_beads <= BAND_LARGEST) st = band(f, cord, b, limits, r, out->band, err);
  fill_record(r, out->holding.lower);
  return st;
}

thr_status thr_structure_method(const thr_frame *f, const thr_cord *cord, const thr_eval_options *o, const thr_limits *limits,
                                thr_eval *out, thr_err *err)
{
  thr_beads b = {0};
  const double **tension = thr_calloc((size_t)out->record.n_cords, sizeof *tension);
  thr_status st = tension ? thr_beads_make(f, &out->record.physics, &b, err) : thr_nomem(err);
  if (!st) st = run(f, cord, &b, o, limits, tension, out, err);
  thr_beads_destroy(&b);
  free(tension);
  return st;
}
