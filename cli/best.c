/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best cords found so far, handed to the parent (cli/guard.c) as a plan that claims nothing. */
#include "cli/cli.h"
#include "graph/check/check.h"
#include "graph/os.h"
#include "planner/planner.h"
#include "symmetry/cover/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double OFTEN = 0.2; /* s between two plans that are kept, but for the first two: one
                                    that takes no search, and a good one */

static struct {
  const thr_frame *f;
  const thr_request *o;
  int n;            /* kept so far */
  double value, at; /* of the last one: what is minimized, thr_clock() */
} best;

void best_begin(const thr_frame *frame, const thr_request *options)
{
  best.f = frame;
  best.o = options;
  best.n = 0;
  best.value = INFINITY;
}

/* What is minimized first. */
static double value_of(const thr_plan *plan)
{
  if (thr_wants_symmetry(&plan->options)) return plan->symmetry.steps;
  if (thr_wants_balance(&plan->options))
    return thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);
  if (thr_wants_pull(&plan->options))
    return thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords);
  if (thr_wants_turning(&plan->options))
    return thr_wants_largest(&plan->options) ? plan->metrics.max_turning : plan->metrics.turning;
  return plan->metrics.length;
}

/* Cords in the component that has most, and in the one that has fewest; false without memory. */
static bool count_cords(const thr_plan *plan, int *fewest, int *most)
{
  int *count = thr_calloc((size_t)plan->frame.n_nodes, sizeof *count);
  *most = 0;
  for (int i = 0; count && i < plan->n_cords; i++)
    count[plan->cord[i].component]++;
  *fewest = count ? count[0] : 0;
  for (int k = 0; count && k < plan->frame.n_nodes; k++) {
    if (count[k] > *most) *most = count[k];
    if (count[k] > 0 && count[k] < *fewest)
      *fewest = count[k]; /* components are numbered without gaps, and all have cords */
  }
  free(count);
  return count != NULL;
}

/* As many cords as asked for, none too long? Of a symmetric plan they may be as many as they are.
 */
static bool fits(thr_plan *plan)
{
  int fewest, most;
  if (!count_cords(plan, &fewest, &most) || most > THR_MOST_CORDS) return false;
  bool counted = thr_plan_counted(&plan->options);
  if (!counted) plan->options.cords = most;
  bool few_enough = most <= plan->options.cords, enough = fewest >= plan->options.cords_least;
  const double limit = plan->options.max_length * (1 + 1e-12);
  bool short_enough =
      limit == 0 || thr_cords_longest(&plan->frame, plan->cord, plan->n_cords) <= limit;
  return few_enough && short_enough &&
         (enough || !counted || plan->options.ends == THR_ENDS_COUNTS);
}

static bool is_wanted(thr_plan *plan)
{
  bool others;
  if (!fits(plan) || thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                      &plan->metrics, NULL))
    return false;
  if (thr_plan_uncross(plan, &others, NULL)) return false;
  if (plan->options.distinct > 0 && plan->metrics.distinct < plan->frame.n_edges) return false;
  return value_of(plan) < best.value * (1 - 1e-9) && thr_check_plan(plan, NULL) == THR_OK;
}

/* plan: of borrowed parts. */
static void keep_better(thr_plan *plan, double now)
{
  thr_text text = {0};
  if (!is_wanted(plan)) return;
  thr_plan_write(plan, &text);
  guard_keep(&text);
  if (progress_wanted()) progress_plan(plan);
  if (cli_verbose)
    cli_note("plan: length %.10g, turning %.10g rad, %.3f CPU s", plan->metrics.length,
             plan->metrics.turning, thr_os_processor_seconds());
  thr_text_destroy(&text);
  best.value = value_of(plan);
  best.at = now;
  best.n++;
}

/* Passes of their own for the cords, which are borrowed, if they may be led otherwise; false, and
 * none, if there is no memory. */
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
  if (i == plan->n_cords) return true;
  while (i-- > 0)
    free(plan->cord[i].half);
  return false;
}

static void free_passes(thr_plan *plan)
{
  for (int i = 0; i < plan->n_cords && plan->options.crossings != THR_CROSSINGS_ALLOW; i++)
    free(plan->cord[i].half);
}

void best_found(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry)
{
  (void)user;
  double now = thr_clock();
  thr_symmetry_record own = {0};
  if (!best.f || n_cords == 0 || (best.n > 1 && now - best.at < OFTEN)) return;
  thr_plan plan = {.frame = *best.f, .options = *best.o, .n_cords = n_cords};
  plan.cord = thr_calloc((size_t)n_cords, sizeof *plan.cord);
  for (int i = 0; plan.cord && i < n_cords; i++) {
    plan.cord[i] = cord[i];
    thr_cord_id(i, plan.cord[i].id);
  }
  bool copies = thr_wants_symmetry(best.o), sound = plan.cord != NULL;
  if (sound && copies && !symmetry) {
    const thr_cover_options how = {.ends = best.o->ends, .tube = best.o->joint == THR_JOINT_TUBE};
    sound = !*best.o->symmetry.group &&
            thr_cords_alone(best.f, &how, plan.cord, n_cords, &own, NULL) == THR_OK;
  }
  if (copies) plan.symmetry = symmetry ? *symmetry : own;
  if (sound && own_passes(&plan)) {
    keep_better(&plan, now);
    free_passes(&plan);
  }
  thr_symmetry_record_destroy(&own);
  free(plan.cord);
}
