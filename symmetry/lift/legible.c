/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords of a symmetric cover that are read in fewer instructions (graph/plan/reading.c), with every
 * aim at the value it has: two turns of a node, in all their images, exchange their partners where
 * that turns no more.
 *
 * Example: two stairs over a grid that go right and then up here, up and then right there, become
 * stairs that are one the other moved along, which is read once. */
#include "graph/plan/plan_measures.h"
#include "symmetry/lift/lift.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Passes that are traced, in all trials together: some tenths of a second. */
static const double MOST_TRACED = 1e6;

/* What has to stay as low as it is. */
typedef struct {
  int cords, paths;
  double steps, turning, pulled, longest;
} level;

typedef struct {
  const thr_quotient *q;
  const thr_cover_options *how;
  const thr_request *o;
  const thr_limits *limits;
  thr_programme p;
  int *component;
  int *value, *best; /* [p.n] of the trial, and of the best so far */
  double worth[THR_N_AIMS], passes, traced;
  bool better;
  level most;
  int instructions;
  thr_lifted *now;
} reader;

static void reader_destroy(reader *r)
{
  free(r->component);
  free(r->value);
  free(r->best);
  thr_programme_destroy(&r->p);
}

static void threading_destroy(thr_lifted *t)
{
  thr_cords_destroy(t->cord, t->n_cords);
  thr_symmetry_record_destroy(&t->record);
}

static int count_instructions(const reader *r, const thr_lifted *t)
{
  const thr_plan plan = {.frame = *r->q->f,
                         .options = *r->o,
                         .cord = t->cord,
                         .n_cords = t->n_cords,
                         .symmetry = t->record};
  return thr_reading_of(&plan).instructions;
}

static level level_of(const reader *r, const thr_lifted *t)
{
  level out = {.cords = t->n_cords, .paths = t->record.unique_paths, .steps = t->record.steps};
  for (int i = 0; i < t->n_cords; i++)
    out.turning += thr_cord_turning(r->q->f, &t->cord[i], r->o->ends == THR_ENDS_CLOSED);
  out.pulled = thr_cords_pulled_turning(r->q->f, t->cord, t->n_cords);
  out.longest = thr_cords_longest(r->q->f, t->cord, t->n_cords);
  return out;
}

/* But for rounding. */
static bool at_most(double a, double b)
{
  return a <= b + 1e-9 * fmax(1, fabs(b));
}

static bool stays(const reader *r, const thr_lifted *t)
{
  const level x = level_of(r, t);
  return x.cords == r->most.cords && x.paths == r->most.paths && at_most(x.steps, r->most.steps) &&
         at_most(x.turning, r->most.turning) && at_most(x.pulled, r->most.pulled) &&
         at_most(x.longest, r->most.longest) &&
         (!thr_keep_asked(r->o) || thr_keep_does(r->q->f, r->o, r->component, t->cord, t->n_cords));
}

/* The cords of r->value, if they are of this kind, are no worse and there is less to read. */
static thr_status try_value(reader *r, thr_err *err)
{
  double worth[THR_N_AIMS];
  bool valid;
  thr_lifted t = {0};
  const thr_cover cover = {
      .copies = r->value, .pairs = r->value + r->p.first_pair, .ends = r->value + r->p.first_end};
  thr_status st = thr_programme_value(&r->p, r->value, worth, &valid, err);
  if (st || !valid || thr_programme_compare(&r->p, worth, r->worth) > 0) return st;
  r->traced += r->passes;
  st = thr_cover_cords(r->q, r->how, &cover, &t.cord, &t.n_cords, &t.record, &(thr_err){0});
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* no cords of this kind */
  const int instructions = count_instructions(r, &t);
  r->better = instructions < r->instructions && stays(r, &t);
  if (r->better) {
    memcpy(r->best, r->value, (size_t)r->p.n * sizeof *r->best);
    r->instructions = instructions;
    const thr_lifted old = *r->now;
    *r->now = t;
    t = old;
  }
  threading_destroy(&t);
  return THR_OK;
}

/* One exchange: of a pass over all of them only the first that is better counts. */
static thr_status attempt(void *user, thr_err *err)
{
  reader *r = user;
  const bool over = r->better || r->traced >= MOST_TRACED || thr_limits_stop(r->limits);
  return over ? THR_OK : try_value(r, err);
}

static thr_status search(reader *r, thr_err *err)
{
  thr_status st = THR_OK;
  do {
    memcpy(r->value, r->best, (size_t)r->p.n * sizeof *r->best);
    r->better = false;
    st = thr_programme_attempt(&r->p, r->value, true, attempt, r, err);
  } while (!st && r->better);
  return st;
}

static thr_status reader_init(reader *r, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *q = r->q;
  int components;
  bool valid;
  r->component = thr_calloc((size_t)q->f->n_nodes, sizeof *r->component);
  thr_status st =
      r->component ? thr_frame_components(q->f, r->component, &components, err) : thr_nomem(err);
  if (!st) st = thr_programme_init(&r->p, q, r->how, err);
  if (!st && r->how->tube) st = thr_programme_tie(&r->p, err);
  if (st) return st;
  r->value = thr_calloc((size_t)r->p.n, sizeof *r->value);
  r->best = thr_calloc((size_t)r->p.n, sizeof *r->best);
  if (!r->value || !r->best) return thr_nomem(err);
  memcpy(r->best, cover->copies, (size_t)q->n_copies * sizeof *r->best);
  if (q->n_pairs > 0)
    memcpy(r->best + r->p.first_pair, cover->pairs, (size_t)q->n_pairs * sizeof *r->best);
  memcpy(r->best + r->p.first_end, cover->ends, (size_t)q->n_darts * sizeof *r->best);
  for (int i = 0; i < r->now->n_cords; i++)
    r->passes += r->now->cord[i].n_passes;
  r->most = level_of(r, r->now);
  r->instructions = count_instructions(r, r->now);
  return thr_programme_value(&r->p, r->best, r->worth, &valid, err);
}

thr_status thr_legible_cords(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_request *request, const thr_limits *limits, thr_cover *cover,
                             thr_lifted *threading, int *instructions, thr_err *err)
{
  reader r = {.q = quotient, .how = options, .o = request, .limits = limits, .now = threading};
  thr_status st = reader_init(&r, cover, err);
  if (!st) st = search(&r, err);
  if (!st) {
    memcpy(cover->copies, r.best, (size_t)quotient->n_copies * sizeof *r.best);
    if (quotient->n_pairs > 0)
      memcpy(cover->pairs, r.best + r.p.first_pair, (size_t)quotient->n_pairs * sizeof *r.best);
    memcpy(cover->ends, r.best + r.p.first_end, (size_t)quotient->n_darts * sizeof *r.best);
    *instructions = r.instructions;
  }
  reader_destroy(&r);
  return st;
}
