/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the shortest different cords over every edge of a small framework exactly.
 *
 * Which sets of edges the cords pass is known from a table (graph/check/few_edges.c), and the
 * shortest cord over each set from another (graph/check/short_cords.c).
 *
 * Example: a triangle, three closed cords, two different ones over every edge: two cords round the
 * triangle, and one to and fro over one edge. */
#include "planner/planner_parts.h"
#include "graph/check/check_parts.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

/* Tells whether the request asks for a given number of short cords, and for nothing that the tables
 * do not know. */
static bool is_asked(const thr_frame *frame, const thr_request *options)
{
  const bool counted = options->cords == options->cords_least && options->ends != THR_ENDS_COUNTS;
  const bool alone = options->max_length == 0 && options->max_pull == 0 && options->capacity == 0 &&
                     !frame->capacity && thr_wants_length(options);
  return counted && alone && options->joint == THR_JOINT_SOLID &&
         options->cover <= options->distinct && !frame->cover;
}

/* Finds the shortest cord over each of the sets, none of which costs more than few->one says.
 * *found false: there are too many sets to list. */
static thr_status walk_over_all(const thr_frame *frame, const thr_request *options,
                                const thr_few_edges *few, const unsigned *set,
                                const thr_limits *limits, thr_cord *cord, bool *found, thr_err *err)
{
  thr_short_cords cords;
  double longest = 0;
  for (int i = 0; i < options->cords; i++)
    longest = fmax(longest, few->one[set[i]]);

  thr_status st = thr_short_cords_init(&cords, frame, options, longest * (1 + 1e-9), limits, err);
  *found = !st;

  /* The shortest cord that passes a set may pass more edges. */
  for (int i = 0; i < options->cords && *found; i++) {
    int best = -1;
    for (int k = 0; k < cords.n; k++)
      if ((set[i] & ~(unsigned)cords.set[k].set) == 0 &&
          (best < 0 || cords.set[k].length < cords.set[best].length))
        best = k;
    *found = best >= 0;
    if (*found) st = thr_short_cords_walk(&cords, best, &cord[i], err);
    *found = *found && !st;
  }

  thr_short_cords_destroy(&cords);
  return st;
}

/* Chooses the sets of edges that the cords pass: together the cheapest; or, with balance, sets of
 * which the most expensive is as cheap as can be, and together the cheapest of these if there are
 * few enough to tell. */
static thr_status choose_sets(thr_few_edges *few, const thr_request *options, bool even,
                              unsigned *set, bool *found, thr_err *err)
{
  const int n = options->cords;
  double proved, dearest = INFINITY;
  thr_status st = THR_OK;

  *found = false;

  /* First the most expensive set is made as cheap as can be; sets that cost more are then out. */
  if (even) {
    st = thr_few_edges_different_dearest(few, options->distinct, n, 0, set, &proved, &dearest, err);
    for (unsigned k = 0; k < 1u << few->n; k++)
      if (few->one[k] > dearest) few->one[k] = INFINITY;
  }

  /* The cheapest sets together, by the table of sums. */
  bool summed = false;
  const bool known = dearest < INFINITY;
  if (!st && (known || !even) && few->n <= THR_FEW_SUMMED)
    st = thr_few_edges_sets(few, options->distinct, n, set, &summed, err);

  *found = !st && (known || summed);
  return st;
}

thr_status thr_distinct_few(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_cord **cord, int *n_cords, thr_err *err)
{
  const int n = options->cords;
  int parts = 0;
  thr_few_edges few = {0};
  bool found = false;
  *cord = NULL;
  *n_cords = 0;

  const bool even = thr_wants_balance(options);
  if (!is_asked(frame, options) || frame->n_edges > (even ? THR_FEW_EDGES : THR_FEW_SUMMED))
    return THR_OK;

  int *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  unsigned *set = thr_calloc((size_t)n, sizeof *set);
  thr_cord *made = thr_calloc((size_t)n, sizeof *made);
  thr_status st = component && set && made ? THR_OK : thr_nomem(err);

  /* The tables are for one component. */
  if (!st) st = thr_frame_components(frame, component, &parts, err);
  if (!st && parts == 1)
    st = thr_few_edges_init(&few, frame, options, component, 0, false, INFINITY, THR_FEW_SETS, err);

  /* Choose the sets, and find a cord over each. */
  if (!st && few.n > 0) st = choose_sets(&few, options, even, set, &found, err);
  if (!st && found) st = walk_over_all(frame, options, &few, set, limits, made, &found, err);

  if (!st && found) {
    *cord = made;
    *n_cords = n;
  } else
    thr_cords_destroy(made, made ? n : 0);

  thr_few_edges_destroy(&few);
  free(component);
  free(set);
  return st;
}
