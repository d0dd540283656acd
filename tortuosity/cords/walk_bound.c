/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes lower bounds on the turning of the cord that turns most, on the length of the longest
 * cord, or on the largest pull, and cords little above such a bound.
 *
 * A limit is excluded if the walks below it are too few for all edges: the programme over walks
 * (walk_programme.c) proves that. The bound is the highest limit that is excluded, found by
 * bisection. Walks that were enough although they pass the same edges round and round are then made
 * to remember these edges (walk_memory.c), which strengthens the programme. Just above the bound,
 * dives (walk_dive.c) look for cords.
 *
 * Example: on a 7 x 7 dome with 14 cords between its feet some cord turns by 257 degrees, which is
 * what the plan has. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_LOOKS = 300,
  MOST_DENSE = 450 /* variables whose dense factors take less time than corners */,
  MOST_GROWTHS = 6,
  MOST_DIVES = 20,
  FEW_DIVES = 8
};

/* Cords no further above the bound than this factor are near: few dives are made below them. */
static const double near_enough = 1.05;

/* Asks whether cords of at most `units` units are too few; if so, programme->excluded is set and
 * proof receives the prices. grown may be NULL; otherwise, if the limit is not excluded, the walks
 * remember the edges that they pass repeatedly from now on, and *grown says whether there were any.
 */
static thr_status exclude(thr_walk_programme *programme, int units, bool *grown,
                          thr_walk_proof *proof, thr_err *err)
{
  programme->to_exclude = true;

  /* No walk earns more than 1, hence no pass need cost more. */
  thr_status st = thr_walk_programme_begin(programme, units, 1, err);

  /* With few variables prices near the middle take less time than vertices do. */
  if (!st)
    st = programme->n_variables <= MOST_DENSE
             ? thr_walk_centre(programme, MOST_LOOKS, err)
             : thr_walk_programme_rounds(programme, MOST_LOOKS, err);

  if (!st && programme->excluded) st = thr_walk_take_proof(programme, proof, err);

  if (grown) *grown = false;
  if (st) return st;
  return grown && !programme->excluded ? thr_walk_remember(programme, grown, err)
                                       : thr_walk_programme_end(programme, err);
}

/* Raises *bound nearly to the highest limit that is excluded, by bisection between *bound and
 * `largest`, in units. *open: the lowest limit that was not excluded. remembers: after a limit that
 * was not excluded the walks remember more, and the same limit is tried again. */
static thr_status bisect(thr_walk_programme *programme, double largest, bool remembers,
                         thr_walk_proof *proof, double *bound, int *open, thr_err *err)
{
  const double near = 5e-4; /* of the largest */
  int part = 3; /* limits near what is known are excluded soonest, later ones know more walks */
  int low = (int)floor(*bound / thr_walk_programme_price(programme, 1)) - 1,
      high = (int)ceil(largest / thr_walk_programme_price(programme, 1));
  thr_status st = THR_OK;
  int most =
      remembers
          ? 1 + low / 500
          : high / 2; /* units of a step; with a memory few at first and more with each success */
  if (high > programme->most_units) high = programme->most_units;

  while (high - low > 1 && thr_walk_programme_price(programme, high - low) > near * largest &&
         !st && !thr_limits_near(programme->limits, largest, *bound) &&
         !thr_limits_stop(programme->limits)) {
    const int step = (high - low) / part, middle = low + (step < most ? step : most);

    /* Try the limit, again as long as the walks remember more than before. */
    bool grown = remembers;
    for (int i = 0;
         i < MOST_GROWTHS && !st && (grown || i == 0) && !thr_limits_stop(programme->limits); i++)
      st = exclude(programme, middle, remembers ? &grown : NULL, proof, err);

    part = 2;
    if (st) break;
    if (programme->excluded) {
      /* The number of cords that is proved says how far above this limit the next one may be. */
      low = middle;
      most = (int)fmin(high, 2 * most + low * (programme->best / programme->cords - 1) / 2);
      *bound = fmax(*bound, thr_walk_programme_price(programme, low + 1));
    } else {
      high = middle;
    }
  }
  *open = high;
  return st;
}

/* Tries a single limit: whether some cord has to turn by more than `enough`. *open: just below this
 * limit, where better cords are to be looked for. */
static thr_status try_limit(thr_walk_programme *programme, double enough, thr_walk_proof *proof,
                            double *bound, int *open, thr_err *err)
{
  const int part = 64; /* of the limit that cords may stay below */
  double most = floor(enough / thr_walk_programme_price(programme, 1));
  int units = most < programme->most_units ? (int)most : programme->most_units;
  if (thr_walk_programme_price(programme, units + 1) <= enough)
    units++; /* prices are rounded down */

  *open = units - units / part;
  if (units > programme->most_units) return THR_OK;
  thr_status st = exclude(programme, units, NULL, proof, err);
  if (!st && programme->excluded)
    *bound = fmax(*bound, thr_walk_programme_price(programme, units + 1));
  return st;
}

/* Says whether the passes of n cords keep to the number that every edge may have, and whether the
 * extra cord keeps to the task's limit. passes: [n_edges] scratch. */
static bool cords_allowed(const thr_turning_columns *columns, const thr_cord *cord, int n,
                          int *passes)
{
  memset(passes, 0, (size_t)columns->f->n_edges * sizeof *passes);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      passes[cord[i].half[k] >> 1]++;
  return thr_passes_allowed(columns, passes);
}

/* Copies the plan's cords to *all, with the walks in place of the cords of the programme's
 * component. The half-edges of the walks are moved, not copied. */
static thr_status replace_cords(const thr_walk_programme *programme, const thr_cord *cord,
                                int n_cords, thr_cord *walk, thr_cord **all, thr_err *err)
{
  thr_status st = thr_cords_copy(cord, n_cords, all, err);

  /* The walks take the places of the component's cords in their order. */
  for (int i = 0, k = 0; i < n_cords && !st; i++) {
    if (programme->c->component[thr_tail(programme->c->f, cord[i].half[0])] != programme->component)
      continue;

    free((*all)[i].half);
    (*all)[i].half = walk[k].half;
    (*all)[i].n_passes = walk[k].n_passes;
    (*all)[i].closed = programme->steps.closed || thr_cord_start(programme->c->f, &walk[k]) ==
                                                      thr_cord_end(programme->c->f, &walk[k]);
    walk[k++].half = NULL;
  }
  return st;
}

/* Replaces the component's cords by the walks, and keeps the result in *better if its passes are
 * within the limits and the price of the most expensive cord is below `largest`. The walks are
 * taken over. passes: [n_edges] scratch. */
static thr_status keep_better(thr_walk_programme *programme, const thr_cord *cord, int n_cords,
                              thr_cord *walk, double largest, int *passes, thr_cord **better,
                              thr_err *err)
{
  const thr_walk_measure measure = programme->steps.measure;
  thr_cord *made = NULL;
  thr_status st = replace_cords(programme, cord, n_cords, walk, &made, err);

  /* Cords that improve on the known ones take the place of any found before. */
  if (made && cords_allowed(programme->c, made, n_cords, passes) &&
      thr_walk_price(programme->c, measure,
                     &made[thr_walk_dearest(programme->c, measure, made, n_cords)]) <
          largest * (1 - 1e-9)) {
    thr_cord *before = *better;
    *better = made;
    made = before;
  }
  thr_cords_destroy(made, n_cords);
  return st;
}

/* Dives for cords of at most `units` units. *better receives the cords if they improve on the known
 * ones. */
static thr_status look_below(thr_walk_programme *programme, const thr_cord *cord, int n_cords,
                             int units, int *passes, thr_cord **better, thr_err *err)
{
  const thr_walk_measure measure = programme->steps.measure;
  const thr_cord *known = *better ? *better : cord;
  double largest = thr_walk_price(programme->c, measure,
                                  &known[thr_walk_dearest(programme->c, measure, known, n_cords)]);
  thr_cord *walk = thr_calloc((size_t)programme->cords, sizeof *walk);
  bool found = false;

  thr_status st = walk ? thr_walk_dive(programme, units, walk, &found, err) : thr_nomem(err);
  if (!st && found) st = keep_better(programme, cord, n_cords, walk, largest, passes, better, err);
  thr_cords_destroy(walk, programme->cords);
  return st;
}

/* Looks for cords just above the bound, from `low` units on in growing steps until some are better
 * than the known ones, and then by bisection between `low` and the better ones. */
static thr_status look_for_cords(thr_walk_programme *programme, const thr_cord *cord, int n_cords,
                                 double bound, int low, thr_cord **better, thr_err *err)
{
  const thr_walk_measure measure = programme->steps.measure;
  const double near = 5e-4; /* of the limit */
  int *passes = thr_calloc((size_t)programme->c->f->n_edges, sizeof *passes), units = low;
  thr_status st = passes ? THR_OK : thr_nomem(err);
  for (int i = 0; i < MOST_DIVES && !st && !thr_limits_stop(programme->limits); i++) {
    const thr_cord *known = *better ? *better : cord;
    double largest = thr_walk_price(
        programme->c, measure, &known[thr_walk_dearest(programme->c, measure, known, n_cords)]);

    /* Units of the most expensive known cord; better cords halve the interval. */
    int high = (int)floor(largest / thr_walk_programme_price(programme, 1));
    if (high > programme->most_units) high = programme->most_units;
    if (*better) units = low + (high - low) / 2;

    /* Stop where the known cords are near the bound, or no units are left between. */
    if (largest <= near_enough * bound && i >= FEW_DIVES) break;
    if (units > high || thr_walk_programme_price(programme, units) >= largest * (1 - 1e-6)) break;
    if (*better && thr_walk_programme_price(programme, high - low) < near * largest) break;

    /* A dive without success raises the lower end, by steps that grow with the number of dives. */
    thr_cord *before = *better;
    st = look_below(programme, cord, n_cords, units, passes, better, err);
    if (*better != before) continue;
    low = units;
    units += 1 + (high - units) / (i < 2 ? 32 : i < 5 ? 16 : 4);
  }
  free(passes);
  return st;
}

/* Says whether every edge has a variable of its own, hence whether the columns are walks that cords
 * can be chosen from. */
static bool has_own_prices(const thr_walk_programme *programme)
{
  int edges = 0;
  for (int e = 0; e < programme->c->f->n_edges; e++)
    edges += programme->edge[e] >= 0;
  return programme->n_edges == edges;
}

/* Raises the bound, then looks for cords just above it, each in a part of the time. Cords are not
 * looked for with a pull, with tube joints, where ends are counted, where images share prices, and
 * where the bound is near enough. */
static thr_status search(thr_walk_programme *programme, const thr_walk_ask *ask, double *bound,
                         thr_walk_proof *made, thr_cord **better, thr_err *err)
{
  const double for_bound = .8; /* of the time */
  const thr_turning_task *task = programme->c->task;
  const thr_limits *limits = programme->limits;
  const thr_cord *cord = ask->cord;
  const int n_cords = ask->n_cords;
  const double largest =
      thr_walk_price(programme->c, ask->measure,
                     &cord[thr_walk_dearest(programme->c, ask->measure, cord, n_cords)]);
  int open = 0;

  /* The bound: at first without a memory of the walks, which is faster, then with one. */
  const thr_limits share = limits->brief ? *limits : thr_limits_part(limits, for_bound);
  programme->limits = &share;
  thr_status st = ask->enough > 0 ? try_limit(programme, ask->enough, made, bound, &open, err)
                                  : bisect(programme, largest, false, made, bound, &open, err);
  if (!st && ask->enough <= 0) st = bisect(programme, largest, true, made, bound, &open, err);

  /* Cords, if they can be chosen from the columns and may be wanted. */
  const bool near = thr_limits_near(limits, largest, *bound);
  const bool wanted = !near && ask->measure != THR_WALK_PULL &&
                      (ask->enough <= 0 || *bound <= ask->enough) && !task->tube &&
                      !task->end_count && has_own_prices(programme);
  programme->limits = limits;
  if (!st && wanted) st = look_for_cords(programme, cord, n_cords, *bound, open, better, err);
  return st;
}

/* Gives all images of an edge or node under the framework's motions one price, where variables are
 * many. */
static thr_status merge_images(thr_walk_programme *programme, thr_orbits_motions *motions,
                               thr_err *err)
{
  const thr_frame *frame = programme->c->f;
  if (!motions || programme->n_variables <= MOST_DENSE) return THR_OK;

  /* The lowest image stands for all. */
  int *edge = thr_calloc((size_t)frame->n_edges, sizeof *edge),
      *node = thr_calloc((size_t)frame->n_nodes, sizeof *node);
  thr_status st = edge && node
                      ? thr_orbits_lowest(programme->c, motions, programme->limits, edge, node, err)
                      : thr_nomem(err);
  if (!st) st = thr_walk_programme_merge(programme, edge, node, err);

  free(edge);
  free(node);
  return st;
}

/* THR_ELIMIT, where the component is too large or time is up, leaves what was proved so far. */
thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_walk_ask *ask,
                          const thr_limits *limits, thr_walk_proof *proof, double *bound,
                          thr_cord **better, thr_err *err)
{
  const int dearest = thr_walk_dearest(columns, ask->measure, ask->cord, ask->n_cords);
  const double largest = thr_walk_price(columns, ask->measure, &ask->cord[dearest]);
  thr_walk_programme programme;
  thr_walk_proof made = {0};
  thr_err why = {0};

  if (columns->task->cords < 2 || *bound >= largest * (1 - 1e-9)) return THR_OK;
  thr_status st = thr_walk_programme_init(&programme, columns, ask->measure, ask->cord,
                                          ask->n_cords, ask->least, limits, &why);
  if (!st) st = merge_images(&programme, ask->motions, &why);
  if (!st) st = search(&programme, ask, bound, &made, better, &why);

  /* A proof that was found replaces the one before. */
  if (!st && made.edge) {
    thr_walk_proof_destroy(proof);
    *proof = made;
    made = (thr_walk_proof){0};
  }
  thr_walk_proof_destroy(&made);
  thr_walk_programme_destroy(&programme);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
