/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes plans that claim nothing of the cords that a search has found so far, so that something is
 * left if the search has to be ended.
 *
 * Searches call thr_limits.found whenever they have cords of the whole framework (graph/limits.h).
 * Cords become a plan if they are what was asked for, better than the last ones, and pass the
 * checker; and at most five times a second, because every plan is measured, checked and written for
 * that. */
#include "graph/check/check.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"
#include "lib/lib.h"
#include "planner/planner.h"
#include "symmetry/cover/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* s between two plans that are looked at, and so many times as long as looking took, but for the
 * first two that are kept: one that takes no search, and a good one. */
static const double OFTEN = 0.2, MUCH = 9;

/* Returns what is minimized where as few cords are wanted as a hand can pull with `hand`, N, even
 * at the upper end of the band of mu: their number, and of as many the pull; what is beyond the
 * hand comes after all others. */
static double recommended_value(const thr_plan *plan, double hand)
{
  double pull[THR_ADVICE_PULLS];
  thr_physics physics;
  if (thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, NULL)) return INFINITY;

  thr_advice_pulls(&physics, thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords),
                   pull);
  const double hardest = pull[THR_ADVICE_HIGH];
  return hardest <= hand * (1 + 1e-9) ? plan->n_cords + hardest / (1 + hardest) : 1e9 + hardest;
}

/* Do all cords end at feet? */
static bool ends_at_feet(const thr_plan *plan)
{
  bool all = true;
  for (int i = 0; i < plan->n_cords; i++)
    all &= plan->frame.foot[thr_cord_start(&plan->frame, &plan->cord[i])] &&
           plan->frame.foot[thr_cord_end(&plan->frame, &plan->cord[i])];
  return all;
}

/* Returns what is minimized first: learned steps, the longest cord (units), turning (rad) or length
 * (units). */
static double minimized_value(const thr_incumbent *best, const thr_plan *plan)
{
  if (best->hand > 0) return recommended_value(plan, best->hand);

  /* The first aim that the request has counts; of a symmetric plan the learned steps. */
  if (thr_wants_symmetry(&plan->options)) return plan->symmetry.steps;
  if (thr_wants_balance(&plan->options))
    return thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);

  /* Of several cords the largest pull or turning counts where that is asked for. */
  if (thr_wants_pull(&plan->options))
    return thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords);
  if (thr_wants_turning(&plan->options))
    return thr_wants_largest(&plan->options) ? plan->metrics.max_turning : plan->metrics.turning;

  return plan->metrics.length;
}

/* Counts the cords in the component that has most, and in the one that has fewest. Returns false
 * without memory. */
static bool count_cords(const thr_plan *plan, int *fewest, int *most)
{
  int *count = thr_calloc((size_t)plan->frame.n_nodes, sizeof *count);

  *most = 0;
  for (int i = 0; count && i < plan->n_cords; i++)
    count[plan->cord[i].component]++;

  *fewest = count ? count[0] : 0;

  /* Components are numbered without gaps, and all of them have cords. */
  for (int k = 0; count && k < plan->frame.n_nodes; k++) {
    if (count[k] > *most) *most = count[k];
    if (count[k] > 0 && count[k] < *fewest)
      *fewest = count[k]; /* components are numbered without gaps, and all have cords */
  }
  free(count);

  return count != NULL;
}

/* Returns whether the cords are as many as asked for, and none is too long. Of a symmetric plan
 * they may be as many as they are: options.cords becomes the most in a component. */
static bool fits_request(const thr_incumbent *best, thr_plan *plan)
{
  int fewest, most;

  if (!count_cords(plan, &fewest, &most) || most > THR_MOST_CORDS) return false;

  /* Where nobody says which, the plan says what they are. */
  if (best->hand > 0) {
    plan->options.ends = ends_at_feet(plan) ? THR_ENDS_FEET : THR_ENDS_ANY;
    plan->options.cords = most;
    plan->options.cords_least = fewest;
    return true;
  }
  bool counted = thr_plan_counted(&plan->options);
  if (!counted) plan->options.cords = most;
  bool few_enough = most <= plan->options.cords, enough = fewest >= plan->options.cords_least;

  /* Lengths within rounding. */
  const double limit = plan->options.max_length * (1 + 1e-12);
  bool short_enough =
      limit == 0 || thr_cords_longest(&plan->frame, plan->cord, plan->n_cords) <= limit;

  return few_enough && short_enough &&
         (enough || !counted || plan->options.ends == THR_ENDS_COUNTS);
}

/* Returns whether a plan is what was asked for, better than the last one by more than rounding, and
 * passes the checker. */
static bool is_better(const thr_incumbent *best, thr_plan *plan)
{
  bool others;

  if (!fits_request(best, plan) || thr_plan_measure(&plan->frame, &plan->options, plan->cord,
                                                    plan->n_cords, &plan->metrics, NULL))
    return false;

  /* Cords that cross inside pieces are led otherwise, as in the final plan. */
  if (thr_plan_uncross(plan, &others, NULL)) return false;
  if (plan->options.distinct > 0 && plan->metrics.distinct < plan->frame.n_edges) return false;

  return minimized_value(best, plan) < best->value * (1 - 1e-9) &&
         thr_check_plan(plan, NULL) == THR_OK;
}

/* Hands a plan over if it is better than the last one. plan: of borrowed parts. */
static void keep_better(thr_incumbent *best, thr_plan *plan)
{
  thr_text text = {0};

  if (!is_better(best, plan)) return;

  /* A plan without claims: proofs are made at the end of a search. */
  thr_plan_write(plan, &text);
  best->keep(best->user, plan, &text);
  thr_text_destroy(&text);

  best->value = minimized_value(best, plan);
  best->n++;
}

/* Gives the cords, whose passes are borrowed, passes of their own if they may be led otherwise.
 * Returns false, with nothing allocated, if there is no memory. */
static bool own_passes(thr_plan *plan)
{
  int i;

  if (plan->options.crossings == THR_CROSSINGS_ALLOW) return true;
  for (i = 0; i < plan->n_cords; i++) {
    int *half = thr_calloc((size_t)plan->cord[i].n_passes, sizeof *half);
    if (!half) break;

    plan->cord[i].half =
        memcpy(half, plan->cord[i].half, (size_t)plan->cord[i].n_passes * sizeof *half);
  }

  /* Undoes what was done so far. */
  if (i == plan->n_cords) return true;
  while (i-- > 0)
    free(plan->cord[i].half);

  return false;
}

/* Frees what own_passes allocated. */
static void free_passes(thr_plan *plan)
{
  for (int i = 0; i < plan->n_cords && plan->options.crossings != THR_CROSSINGS_ALLOW; i++)
    free(plan->cord[i].half);
}

/* Takes cords that a search has found; see lib.h. */
void thr_incumbent_found(thr_incumbent *best, const thr_cord *cord, int n_cords,
                         const thr_symmetry_record *symmetry)
{
  const double now = thr_clock();
  const int n_kept = best->n;
  thr_symmetry_record own = {0};

  if (!best->frame || n_cords == 0 || now < best->next) return;

  /* A plan of borrowed parts; ids by number. */
  thr_plan plan = {.frame = *best->frame, .options = *best->options, .n_cords = n_cords};
  plan.cord = thr_calloc((size_t)n_cords, sizeof *plan.cord);
  for (int i = 0; plan.cord && i < n_cords; i++) {
    plan.cord[i] = cord[i];
    thr_cord_id(i, plan.cord[i].id);
  }

  /* A symmetric plan whose search gives no record: every cord is a path of its own, unless a group
   * was asked for. */
  bool copies = thr_wants_symmetry(best->options), sound = plan.cord != NULL;
  if (sound && copies && !symmetry) {
    const thr_cover_options how = {.ends = best->options->ends,
                                   .tube = best->options->joint == THR_JOINT_TUBE};
    sound = !*best->options->symmetry.group &&
            thr_cords_alone(best->frame, &how, plan.cord, n_cords, &own, NULL) == THR_OK;
  }

  /* Passes are led otherwise on copies. */
  if (copies) plan.symmetry = symmetry ? *symmetry : own;

  if (sound && own_passes(&plan)) {
    keep_better(best, &plan);
    free_passes(&plan);
  }

  /* Most of the time stays with the search. */
  const double end = thr_clock();
  if (best->n == n_kept || best->n > 1) best->next = end + fmax(OFTEN, MUCH * (end - now));

  thr_symmetry_record_destroy(&own);
  free(plan.cord);
}
