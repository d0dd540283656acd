/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the cord that turns most turn less: looks for a symmetric start (thr_even_seed), and
 * exchanges parts of cords from there and from the cords that turn least in all (thr_even_turning;
 * tortuosity/cords/several.h). What remains of the time goes into column generation over walks.
 *
 * Example: six cords on a dome with six-fold symmetry. Symmetric cords all turn by the same angle,
 * which may already be the bound. */
#include "planner/planner_parts.h"
#include "tortuosity/cords/several.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_even_seed(const thr_frame *frame, const thr_request *options,
                         const thr_limits *limits, thr_plan *seed, thr_err *err)
{
  thr_symmetries symmetries;
  thr_request symmetric = *options;
  thr_err why = {0};
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_SEED);

  symmetric.symmetry = thr_request_default().symmetry;
  symmetric.aims = thr_aims_symmetric;
  symmetric.max_pull = 0;

  /* Find symmetric threadings, and take the row with so many cords that is the most even. */
  thr_status st = thr_symmetries_find(frame, &symmetric, false, &share, &symmetries, &why);
  int row = st && st != THR_ELIMIT ? -1 : thr_symmetries_even(&symmetries, options->cords);
  if (row >= 0) st = thr_symmetries_plan(&symmetries, row, frame, &symmetric, &share, seed, &why);

  thr_symmetries_destroy(&symmetries);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves no seed */
}

/* Are they cords of the task: as many in every component as least has, over passes and ends that it
 * allows? Given numbers of ends no other objective's plan keeps to. */
static thr_status seed_fits(const thr_frame *frame, const thr_least *least, const thr_plan *seed,
                            bool *fits, thr_err *err)
{
  int *count = thr_calloc((size_t)frame->n_nodes,
                          sizeof *count); /* cords of a component: least's less the seed's */

  bool *tied = thr_calloc((size_t)frame->n_nodes, sizeof *tied), open = least->end_allowed != NULL;
  thr_status st = count && tied ? THR_OK : thr_nomem(err);
  double length = 0;

  *fits = !least->task.end_count && seed->n_cords == least->n_cords &&
          seed->frame.n_nodes == frame->n_nodes && seed->options.cover == least->task.cover &&
          seed->metrics.most_passes <= least->task.most_passes;
  if (!st && *fits) st = thr_junction_tied(frame, seed->cord, seed->n_cords, !open, tied, err);
  *fits &= !st;

  /* Compare the cords of every component, and look at the ends and U-turns of each. */
  for (int i = 0; *fits && i < least->n_cords; i++) {
    const thr_cord *cord = &seed->cord[i];
    count[least->cord[i].component]++;
    count[cord->component]--;
    length += thr_cord_length(frame, cord);

    *fits = open ? least->end_allowed[thr_cord_start(frame, cord)] &&
                       least->end_allowed[thr_cord_end(frame, cord)]
                 : cord->closed;

    for (int k = 0; k + 1 < cord->n_passes && *fits;
         k++) /* the search never turns back where it need not */
      *fits = cord->half[k + 1] != (cord->half[k] ^ 1) ||
              (thr_degree(frame, thr_head(frame, cord->half[k])) == 1 && !least->task.tube);
  }

  /* All components have as many cords as before, and with tube joints all nodes are tied. */
  for (int v = 0; v < frame->n_nodes && *fits; v++)
    *fits = count[v] == 0 && (tied[v] || !least->task.tube);
  *fits &= least->length_limit < 0 || length <= least->length_limit * (1 + 1e-12);

  free(count);
  free(tied);
  return st;
}

/* Tells whether nothing is left to look for: the bound is attained, or the pull is small enough. */
static bool is_done(const thr_frame *frame, const thr_least *least, const thr_max_turning *found,
                    double enough, const thr_limits *limits)
{
  if (thr_limits_near(limits, found->largest, found->bound)) return true;
  return enough > 0 && thr_cords_pulled_turning(frame, least->cord, least->n_cords) <= enough;
}

/* Exchanges from the seed's cords, and if that is not enough from least's; the better cords stay.
 */
static thr_status exchange(const thr_frame *frame, const thr_plan *seed, double enough,
                           const thr_limits *limits, thr_least *least, thr_max_turning *found,
                           thr_err *err)
{
  bool fits = false;
  thr_max_turning own = {.largest = INFINITY}, other = own;
  thr_least from = *least; /* with the seed's cords; all else stays least's */
  from.cord = NULL;

  /* Begin with the seed's cords, in a part of the time. */
  thr_status st = seed ? seed_fits(frame, least, seed, &fits, err) : THR_OK;
  if (!st && fits) {
    const thr_limits share = thr_dispatch_share(limits, THR_STEP_EVEN_SEED);
    st = thr_cords_copy(seed->cord, seed->n_cords, &from.cord, err);
    if (!st) st = thr_max_turning_improve(frame, enough, &share, &from, &other, err);
  }

  /* The search's own cords are the second start, unless nothing is left to gain. */
  if (!st && !(fits && is_done(frame, &from, &other, enough, limits)))
    st = thr_max_turning_improve(frame, enough, limits, least, &own, err);

  /* The better cords stay in least. */
  if (!st && other.largest < own.largest) {
    thr_cord *cord = least->cord;
    *least = from;
    from.cord = cord;
  }

  *found = other.largest < own.largest ? other : own;
  thr_cords_destroy(from.cord, least->n_cords);
  return st;
}

thr_status thr_even_turning(const thr_frame *frame, const thr_plan *seed, double enough,
                            const thr_limits *limits, thr_least *least, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_EXCHANGES);

  thr_max_turning found;
  thr_status st = exchange(frame, seed, enough, &share, least, &found, err);

  return st || limits->unpriced || is_done(frame, least, &found, enough, limits)
             ? st
             : thr_max_turning_walks(frame, enough, thr_planner_near_motions, limits, least, &found,
                                     err);
}
