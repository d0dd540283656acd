/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the shortest different cords over every edge of a small framework exactly.
 *
 * Which sets of edges the cords pass is known from a table (graph/check/few_edges.c), and the
 * shortest cord over each set from another (graph/threading/small_cords.c).
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

/* Finds the shortest cord that passes the edges of the set. */
static thr_status walk_over(thr_frame *covered, const thr_request *one, unsigned set,
                            const thr_limits *limits, thr_cord *cord, bool *found, thr_err *err)
{
  const thr_small_ask ask = {.least = 1, .most = 1, .limit = INFINITY};
  thr_small_cords small;
  bool certain;

  /* The edges of the set are to be passed once at least, all others need no pass. */
  for (int e = 0; e < covered->n_edges; e++)
    covered->cover[e] = (int)(set >> e & 1u);
  thr_status st = thr_small_cords_find(covered, one, &ask, limits, &small, &certain, err);

  /* The cord moves out of the table. */
  *found = !st && certain && small.n == 1;
  if (*found) {
    *cord = (thr_cord){.half = small.half[0], .n_passes = small.n_passes[0]};
    cord->closed =
        thr_tail(covered, cord->half[0]) == thr_head(covered, cord->half[cord->n_passes - 1]);
    small.half[0] = NULL;
  }

  thr_small_cords_destroy(&small);
  return st;
}

/* Finds the shortest cord over each of the sets. *found false: there is none over some set. */
static thr_status walk_over_all(const thr_frame *frame, const thr_request *options,
                                const unsigned *set, const thr_limits *limits, thr_cord *cord,
                                bool *found, thr_err *err)
{
  thr_frame covered = *frame;
  thr_request one = *options;

  one.cords = one.cords_least = 1;
  one.cover = 0; /* what the framework says for every edge */
  one.distinct = 0;
  *found = true;
  if (!(covered.cover = thr_calloc((size_t)frame->n_edges, sizeof *covered.cover)))
    return thr_nomem(err);

  thr_status st = THR_OK;
  for (int i = 0; i < options->cords && !st && *found; i++)
    st = walk_over(&covered, &one, set[i], limits, &cord[i], found, err);
  free(covered.cover);
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
  if (!st && found) st = walk_over_all(frame, options, set, limits, made, &found, err);

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
