/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays what the limit analysis found into the record that the plan keeps (docs/plan-format.md):
 * answers that are proved come with their mechanisms, so that a checker can balance their powers
 * again without any solver (graph/check/check_standing.c).
 *
 * Example: a holding pull of 4.14 .. 4.60 N becomes {asked: holding, proved: 4.14, found: 4.60}
 * with one velocity of six numbers for every bead. */
#include "eval/eval.h"
#include "eval/structure/beads.h"

#include <math.h>
#include <string.h>

/* There is at most one answer of each name, and one of every pull with a load. */
enum { NAMED = THR_N_ASKED };

/* Adds an answer, with its mechanism if the answer is proved by one. */
static thr_status add(thr_standing *standing, int n_beads, const thr_answer *answer,
                      const double (*velocity)[6], thr_err *err)
{
  thr_answer *to = &standing->answer[standing->n_answers++];

  /* The bound of a load is from above, INFINITY if nothing is proved; of a pull from below, 0. */
  const bool of_load = thr_asked_of_load(answer->asked),
             proved = of_load ? isfinite(answer->proved) : answer->proved > 0;
  *to = *answer;

  /* Rounding may put what was found beyond what is proved; then nothing is said of it. */
  if (of_load ? to->found > to->proved : to->found < to->proved) to->found = INFINITY;

  /* Without a mechanism nothing is claimed. */
  if (!proved || !isfinite(answer->proved) || !velocity) {
    to->proved = of_load ? INFINITY : 0;
    return THR_OK;
  }

  /* The answer owns a copy. */
  if (!(to->velocity = thr_calloc((size_t)n_beads, sizeof *to->velocity))) return thr_nomem(err);
  memcpy(to->velocity, velocity, (size_t)n_beads * sizeof *velocity);
  to->n_beads = n_beads;

  return THR_OK;
}

/* Adds an answer about a pull. Where no pull holds the structure, the plan says nothing: what
 * proves that is a mechanism of another kind. */
static thr_status add_holding(thr_standing *standing, int n_beads, thr_asked asked,
                              const thr_holding *holding, thr_err *err)
{
  if (!holding->present || !isfinite(holding->lower)) return THR_OK;

  /* What a newton metre of stretch resists is known of a stretch only. */
  return add(standing, n_beads,
             &(thr_answer){.asked = asked,
                           .proved = holding->lower,
                           .found = holding->upper,
                           .resists = asked == THR_ASKED_STRETCH ? holding->resists : -1},
             (const double(*)[6])holding->velocity, err);
}

/* Adds the answer that knotted cords break before they hold the structure: the tension that is not
 * enough is what they bear. */
static thr_status add_tightest(thr_standing *standing, int n_beads, const thr_holding *stretch,
                               thr_err *err)
{
  if (!stretch->present || isfinite(stretch->lower) || !stretch->velocity) return THR_OK;

  /* Proved: this strength is not enough. Found: nothing. */
  return add(standing, n_beads,
             &(thr_answer){.asked = THR_ASKED_TIGHTEST,
                           .proved = standing->strength,
                           .found = INFINITY,
                           .resists = -1},
             (const double(*)[6])stretch->velocity, err);
}

/* Adds an answer about a load, unless that was not decided. */
static thr_status add_carry(thr_standing *standing, int n_beads, thr_asked asked, double pull,
                            const thr_carry *carry, thr_err *err)
{
  if (carry->first_bead < 0) return THR_OK;

  /* A multiple of the load at this pull. */
  return add(standing, n_beads,
             &(thr_answer){.asked = asked,
                           .pull = pull,
                           .proved = carry->beyond,
                           .found = carry->carried,
                           .resists = -1},
             (const double(*)[6])carry->velocity, err);
}

/* Adds the loads, of which nodes without one are left out. */
static thr_status add_loads(thr_standing *standing, int n_nodes, const double (*load)[3],
                            thr_err *err)
{
  if (!load) return THR_OK;
  if (!(standing->load = thr_calloc((size_t)n_nodes, sizeof *standing->load)))
    return thr_nomem(err);
  for (int v = 0; v < n_nodes; v++) {
    /* Only the loaded nodes are listed. */
    if (load[v][0] == 0 && load[v][1] == 0 && load[v][2] == 0) continue;
    standing->load[standing->n_loads].node = v;
    memcpy(standing->load[standing->n_loads++].force, load[v], sizeof *load);
  }

  return THR_OK;
}

/* Begins the record: which model, and how the cords are drawn in; see eval.h. */
thr_status thr_structure_drawn(thr_evaluation *evaluation, const thr_eval_options *options,
                               thr_err *err)
{
  thr_standing *standing = &evaluation->standing;
  *standing = (thr_standing){.present = true,
                             .model = THR_STANDING_MODEL,
                             .clamped = options->clamped,
                             .taut = options->taut,
                             .tilt = options->tilt,
                             .azimuth = options->tilt > 0 ? options->azimuth : 0,
                             .let_down = NAN,
                             .n_cords = evaluation->n_cords};

  /* Each cord by its pulled ends and its slackest pass. */
  standing->drawn = thr_calloc((size_t)evaluation->n_cords, sizeof *standing->drawn);
  if (!standing->drawn) return thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords; i++)
    standing->drawn[i] = (thr_drawn){(int)evaluation->cord[i].pull, evaluation->cord[i].slackest};

  return THR_OK;
}

/* Lays answers and loads into the record; see eval.h. */
thr_status thr_structure_record(int n_beads, const thr_eval_options *options, thr_eval *out,
                                thr_err *err)
{
  thr_standing *standing = &out->record.standing;
  standing->let_down = out->let_down;
  standing->strength = out->stretch.present ? options->strength : 0;

  /* At most one answer of each name, and one of every pull. */
  standing->answer = thr_calloc((size_t)NAMED + (size_t)out->n_carries, sizeof *standing->answer);
  if (!standing->answer) return thr_nomem(err);

  /* The load first. */
  thr_status st = add_loads(standing, n_beads, options->load, err);

  /* Answers in a fixed order, which is that of the file. */
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_HOLDING, &out->holding, err);
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_EQUAL, &out->equal, err);
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_ANY_STATE, &out->loosest, err);
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_AFTER, &out->after, err);
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_STRETCH, &out->stretch, err);
  if (!st) st = add_tightest(standing, n_beads, &out->stretch, err);
  if (!st) st = add_holding(standing, n_beads, THR_ASKED_LOADED, &out->loaded, err);

  /* At last the loads at each pull, and after the schedule. */
  for (int i = 0; i < out->n_carries && !st; i++)
    st = add_carry(standing, n_beads, THR_ASKED_CARRIED, out->carries[i].pull,
                   &out->carries[i].carry, err);
  return st ? st
            : add_carry(standing, n_beads, THR_ASKED_CARRIED_AFTER, 0, &out->after_carries, err);
}
