/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes plans that claim nothing of the cords that a search has found so far, so that something is
 * left if the search has to be ended.
 *
 * Searches call thr_limits.found whenever they have cords of the whole framework (graph/limits.h).
 * Cords become a plan if they are what was asked for, better than the last ones, and pass the
 * checker; and at most five times a second, because every plan is measured, checked and written for
 * that. Better cords that come sooner wait, the best of them, until it is time, and the plan that
 * the search ends with is always told last. */
#include "graph/check/check.h"
#include "lib/lib.h"
#include "planner/planner.h"
#include "symmetry/cover/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* s between two plans that are told, and so many times as long as looking took, but for the first
 * two: one that takes no search, and a good one. */
static const double OFTEN = 0.2, MUCH = 9;

/* Returns what is minimized where as few cords are wanted as a hand can pull with `hand`, N, even
 * at the upper end of the band of mu: their number, and of as many the pull; what is beyond the
 * hand comes after all others. */
static double recommended_value(const thr_plan *plan, double hand)
{
  double pull[THR_ADVICE_PULLS];
  thr_plan_pulls(plan, pull);
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

/* Returns whether a plan is better than the last one by more than rounding, and passes the checker.
 */
static bool is_better(const thr_incumbent *best, thr_plan *plan)
{
  bool others;

  /* Cords that cross inside pieces are led otherwise, as in the final plan. */
  if (thr_plan_uncross(plan, &others, NULL)) return false;
  if (plan->options.distinct > 0 && plan->metrics.distinct < plan->frame.n_edges) return false;

  return minimized_value(best, plan) < best->value * (1 - 1e-9) &&
         thr_check_plan(plan, NULL) == THR_OK;
}

/* Hands a plan over if it is better than the last one. plan: measured, of borrowed parts. */
static void keep_better(thr_incumbent *best, thr_plan *plan)
{
  thr_text text = {0};

  if (!is_better(best, plan)) return;

  /* A plan without claims: proofs are made at the end of a search. */
  thr_plan_write(plan, &text);
  best->keep(best->user, plan, &text);
  thr_text_destroy(&text);

  best->value = minimized_value(best, plan);
  best->last = plan->metrics;
  best->n++;
}

/* Lays out cords, which stay the caller's, as a plan that is measured. Returns false if it is not
 * what was asked for. */
static bool lay_out(const thr_incumbent *best, thr_cord *cord, int n_cords, thr_plan *plan)
{
  *plan = (thr_plan){
      .frame = *best->frame, .options = *best->options, .cord = cord, .n_cords = n_cords};
  return fits_request(best, plan) && thr_plan_measure(&plan->frame, &plan->options, cord, n_cords,
                                                      &plan->metrics, NULL) == THR_OK;
}

/* Forgets the cords that wait. */
static void forget(thr_incumbent *best)
{
  thr_cords_destroy(best->waiting, best->n_waiting);
  best->waiting = NULL;
  best->n_waiting = 0;
}

/* Lets a copy of cords wait in place of those that waited, if they are better than these and than
 * what was kept. Steps of symmetric cords are not known yet: the last ones wait. Without memory
 * none do. */
static void let_wait(thr_incumbent *best, const thr_cord *cord, int n_cords)
{
  thr_cord *copy = NULL;
  thr_plan plan;
  if (thr_cords_copy(cord, n_cords, &copy, NULL)) return;
  for (int i = 0; i < n_cords; i++)
    thr_cord_id(i, copy[i].id);

  double value = 0;
  if (!thr_wants_symmetry(best->options))
    value = lay_out(best, copy, n_cords, &plan) ? minimized_value(best, &plan) : INFINITY;
  const double least = best->n_waiting > 0 ? fmin(best->value, best->waiting_value) : best->value;
  if (value > 0 && value >= least * (1 - 1e-9)) {
    thr_cords_destroy(copy, n_cords);
    return;
  }

  forget(best);
  best->waiting = copy;
  best->n_waiting = n_cords;
  best->waiting_value = value;
}

/* Looks at the cords that wait. symmetry: the record of symmetric ones, NULL = none. */
static void look(thr_incumbent *best, const thr_symmetry_record *symmetry)
{
  const double now = thr_clock();
  const int n_kept = best->n;
  thr_symmetry_record own = {0};
  thr_plan plan;

  /* A symmetric plan whose search gives no record: every cord is a path of its own, unless a group
   * was asked for. */
  const bool copies = thr_wants_symmetry(best->options);
  bool sound = true;
  if (copies && !symmetry) {
    const thr_cover_options how = {.ends = best->options->ends,
                                   .tube = best->options->joint == THR_JOINT_TUBE};
    sound =
        !*best->options->symmetry.group &&
        thr_cords_alone(best->frame, &how, best->waiting, best->n_waiting, &own, NULL) == THR_OK;
  }

  if (sound && lay_out(best, best->waiting, best->n_waiting, &plan)) {
    if (copies) plan.symmetry = symmetry ? *symmetry : own;
    keep_better(best, &plan);
    best->waiting = plan.cord; /* channels may be led by other passes */
    best->n_waiting = plan.n_cords;
  }

  /* Most of the time stays with the search. */
  const double end = thr_clock(), busy = MUCH * (end - now);
  if (best->pause > 0 && best->n == n_kept) best->next = end + busy;
  if (best->pause > 0 && best->n > n_kept && best->n > 1)
    best->next = end + fmax(best->pause, busy);

  thr_symmetry_record_destroy(&own);
  forget(best);
}

thr_incumbent thr_incumbent_begin(const thr_frame *frame, const thr_request *options, double hand)
{
  return (thr_incumbent){
      .frame = frame, .options = options, .hand = hand, .value = INFINITY, .pause = OFTEN};
}

/* Takes cords that a search has found; see lib.h. */
void thr_incumbent_found(thr_incumbent *best, const thr_cord *cord, int n_cords,
                         const thr_symmetry_record *symmetry)
{
  if (!best->frame || n_cords == 0) return;

  /* Symmetric cords do not wait, because their record does not. */
  const bool due = thr_clock() >= best->next;
  if (due || !thr_wants_symmetry(best->options)) let_wait(best, cord, n_cords);
  if (due && best->n_waiting > 0) look(best, symmetry);
}

void thr_incumbent_look(thr_incumbent *best)
{
  if (best->frame && best->n_waiting > 0 && thr_clock() >= best->next) look(best, NULL);
}

/* Are sums of the same in another order equal? */
static bool is_same(double a, double b)
{
  return fabs(a - b) <= 1e-9 * fabs(b);
}

/* Tells the last plan; see lib.h. */
void thr_incumbent_end(thr_incumbent *best, const thr_plan *plan)
{
  const thr_metrics *last = &best->last, *now = &plan->metrics;
  const bool told = best->n > 0 && is_same(last->length, now->length) &&
                    is_same(last->turning, now->turning) &&
                    is_same(last->max_turning, now->max_turning);

  /* By its own options any plan is better than none. */
  forget(best);
  if (plan->n_cords > 0 && !told) {
    thr_incumbent final = thr_incumbent_begin(&plan->frame, &plan->options, 0);
    final.keep = best->keep;
    final.user = best->user;
    thr_incumbent_found(&final, plan->cord, plan->n_cords,
                        plan->symmetry.present ? &plan->symmetry : NULL);
  }
  best->frame = NULL;
}
