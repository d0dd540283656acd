/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes the cords of a symmetric cover so that they are read in fewer instructions
 * (graph/plan/reading.c), with every aim at the value it has: two turns of a node, in all their
 * images, exchange their partners where that turns no more.
 *
 * A local search: the first exchange with fewer instructions is made, and all are tried again,
 * until none has fewer or MOST_TRACED passes have been traced, so that the result depends on no
 * clock.
 *
 * Example: two stairs over a grid that go right and then up here, up and then right there, become
 * stairs of which one is the other moved along, which is read once. */
#include "graph/plan/plan_measures.h"
#include "symmetry/lift/lift.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Passes that are traced, in all trials together, which takes some tenths of a second. */
static const double MOST_TRACED = 1e6;

/* What may not become more: numbers, and values of the aims. */
typedef struct {
  int cords, paths;
  double steps, turning, pulled, longest;
} measures;

typedef struct {
  const thr_quotient *quotient;
  const thr_cover_options *how;
  const thr_request *request;
  const thr_limits *limits;
  thr_programme programme;
  int *component;
  int *value, *best; /* [programme.n] of the trial, and of the best so far */
  double worth[THR_N_AIMS], passes, traced;
  bool better;
  measures most;
  int instructions;
  thr_lifted *threading;
} reading_search;

static void reader_destroy(reading_search *search)
{
  free(search->component);
  free(search->value);
  free(search->best);
  thr_programme_destroy(&search->programme);
}

static void threading_destroy(thr_lifted *threading)
{
  thr_cords_destroy(threading->cord, threading->n_cords);
  thr_symmetry_record_destroy(&threading->record);
}

/* Counts the instructions that a threading is read in. */
static int count_instructions(const reading_search *search, const thr_lifted *threading)
{
  const thr_plan plan = {.frame = *search->quotient->f,
                         .options = *search->request,
                         .cord = threading->cord,
                         .n_cords = threading->n_cords,
                         .symmetry = threading->record};
  return thr_reading_of(&plan).instructions;
}

/* Computes the values of a threading that may not become more. */
static measures measures_of(const reading_search *search, const thr_lifted *threading)
{
  measures out = {.cords = threading->n_cords,
                  .paths = threading->record.unique_paths,
                  .steps = threading->record.steps};

  /* Turning is a sum, the rest are largest values. */
  for (int i = 0; i < threading->n_cords; i++)
    out.turning += thr_cord_turning(search->quotient->f, &threading->cord[i],
                                    search->request->ends == THR_ENDS_CLOSED);
  out.pulled = thr_cords_pulled_turning(search->quotient->f, threading->cord, threading->n_cords);
  out.longest = thr_cords_longest(search->quotient->f, threading->cord, threading->n_cords);

  return out;
}

/* Tells whether a is at most b, up to rounding. */
static bool at_most(double a, double b)
{
  return a <= b + 1e-9 * fmax(1, fabs(b));
}

/* Tells whether a threading is no worse than the one at the beginning, and keeps to what is asked
 * of cords. */
static bool is_no_worse(const reading_search *search, const thr_lifted *threading)
{
  const measures own = measures_of(search, threading);
  return own.cords == search->most.cords && own.paths == search->most.paths &&
         at_most(own.steps, search->most.steps) && at_most(own.turning, search->most.turning) &&
         at_most(own.pulled, search->most.pulled) && at_most(own.longest, search->most.longest) &&
         (!thr_keep_asked(search->request) ||
          thr_keep_does(search->quotient->f, search->request, search->component, threading->cord,
                        threading->n_cords));
}

/* Makes the cords of search->value, if there are any of this kind, and keeps them if they are no
 * worse and there is less to read. */
static thr_status try_value(reading_search *search, thr_err *err)
{
  double worth[THR_N_AIMS];
  bool valid;
  thr_lifted tried = {0};
  const thr_cover cover = {.copies = search->value,
                           .pairs = search->value + search->programme.first_pair,
                           .ends = search->value + search->programme.first_end};

  /* No aim may become worse. */
  thr_status st = thr_programme_value(&search->programme, search->value, worth, &valid, err);
  if (st || !valid || thr_programme_compare(&search->programme, worth, search->worth) > 0)
    return st;

  /* Trace the cords. */
  search->traced += search->passes;
  st = thr_cover_cords(search->quotient, search->how, &cover, &tried.cord, &tried.n_cords,
                       &tried.record, &(thr_err){0});
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;

  /* Keep the best, and free the other. */
  const int instructions = count_instructions(search, &tried);
  search->better = instructions < search->instructions && is_no_worse(search, &tried);
  if (search->better) {
    memcpy(search->best, search->value, (size_t)search->programme.n * sizeof *search->best);
    search->instructions = instructions;
    const thr_lifted old = *search->threading;
    *search->threading = tried;
    tried = old;
  }
  threading_destroy(&tried);
  return THR_OK;
}

/* Tries one exchange; of a round over all exchanges only the first that is better counts. */
static thr_status attempt_exchange(void *user, thr_err *err)
{
  reading_search *search = user;
  const bool over =
      search->better || search->traced >= MOST_TRACED || thr_limits_stop(search->limits);
  return over ? THR_OK : try_value(search, err);
}

/* Makes exchanges, one a round, until there is none that is better. */
static thr_status improve_reading(reading_search *search, thr_err *err)
{
  thr_status st = THR_OK;
  do {
    memcpy(search->value, search->best, (size_t)search->programme.n * sizeof *search->best);
    search->better = false;
    st = thr_programme_attempt(&search->programme, search->value, true, attempt_exchange, search,
                               err);
  } while (!st && search->better);
  return st;
}

/* Starts from the cover and its cords; the caller destroys search also on failure. */
static thr_status reader_init(reading_search *search, const thr_cover *cover, thr_err *err)
{
  const thr_quotient *quotient = search->quotient;
  int components;
  bool valid;

  search->component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *search->component);
  thr_status st = search->component
                      ? thr_frame_components(quotient->f, search->component, &components, err)
                      : thr_nomem(err);
  if (!st) st = thr_programme_init(&search->programme, quotient, search->how, err);
  if (!st && search->how->tube) st = thr_programme_tie(&search->programme, err);
  if (st) return st;

  search->value = thr_calloc((size_t)search->programme.n, sizeof *search->value);
  search->best = thr_calloc((size_t)search->programme.n, sizeof *search->best);
  if (!search->value || !search->best) return thr_nomem(err);

  /* The cover. */
  thr_programme_from_cover(&search->programme, cover, search->best);

  /* The cords, and what is traced for one trial. */
  for (int i = 0; i < search->threading->n_cords; i++)
    search->passes += search->threading->cord[i].n_passes;
  search->most = measures_of(search, search->threading);
  search->instructions = count_instructions(search, search->threading);
  return thr_programme_value(&search->programme, search->best, search->worth, &valid, err);
}

thr_status thr_legible_cords(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_request *request, const thr_limits *limits, thr_cover *cover,
                             thr_lifted *threading, int *instructions, thr_err *err)
{
  reading_search search = {.quotient = quotient,
                           .how = options,
                           .request = request,
                           .limits = limits,
                           .threading = threading};
  thr_status st = reader_init(&search, cover, err);

  /* Exchange, as long as something gets shorter to read. */
  if (!st) st = improve_reading(&search, err);

  /* The cover becomes that of the cords. */
  if (!st) {
    thr_programme_to_cover(&search.programme, search.best, cover);
    *instructions = search.instructions;
  }

  reader_destroy(&search);
  return st;
}
