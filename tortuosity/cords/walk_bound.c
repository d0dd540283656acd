/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much some cord has to turn, or how long it must be, and cords little above that: the
 * programme over walks.
 *
 * Example: on a 7 x 7 dome with 14 cords between its feet some cord turns by 257 degrees, which is
 * what the plan has. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>

enum {
  MOST_LOOKS = 300,
  MOST_DENSE = 450 /* variables whose dense factors take less time than corners */,
  MOST_GROWTHS = 6,
  MOST_DIVES = 20,
  FEW_DIVES = 8,
  MOST_DRAWN = 12
};

/* Cords no further above the bound than that are near: few dives, no walks drawn at random, none
 * chosen in integers. */
static const double near_enough = 1.05;

/* Are cords of at most so many units too few? Then proof is why. *grown, where it is asked for: the
 * walks that were enough go round and round, which they remember from now on. */
static thr_status exclude(thr_walk_programme *p, int units, bool *grown, thr_walk_proof *proof,
                          thr_err *err)
{
  p->to_exclude = true;
  thr_status st =
      thr_walk_programme_begin(p, units, 1, err); /* no walk that counts is worth more than 1 */
  if (!st)
    st = p->n_variables <= MOST_DENSE ? thr_walk_centre(p, MOST_LOOKS, err)
                                      : thr_walk_programme_rounds(p, MOST_LOOKS, err);
  if (!st && p->excluded) st = thr_walk_take_proof(p, proof, err);
  if (grown) *grown = false;
  if (st) return st;
  return grown && !p->excluded ? thr_walk_remember(p, grown, err) : thr_walk_programme_end(p, err);
}

/* The highest limit that is excluded, nearly; *open: the lowest that was found not to be. Without
 * remembers the walks learn nothing. */
static thr_status bisect(thr_walk_programme *p, double largest, bool remembers,
                         thr_walk_proof *proof, double *bound, int *open, thr_err *err)
{
  const double near = 5e-4; /* of the largest */
  int part = 3; /* limits near what is known are excluded soonest, later ones know more walks */
  int low = (int)floor(*bound / thr_walk_programme_price(p, 1)) - 1,
      high = (int)ceil(largest / thr_walk_programme_price(p, 1));
  thr_status st = THR_OK;
  int most =
      remembers
          ? 1 + low / 500
          : high / 2; /* units of a step; with a memory few at first and more with each success */
  if (high > p->most_units) high = p->most_units;
  while (high - low > 1 && thr_walk_programme_price(p, high - low) > near * largest && !st &&
         !thr_limits_near(p->limits, largest, *bound) && !thr_limits_stop(p->limits)) {
    const int step = (high - low) / part, middle = low + (step < most ? step : most);
    bool grown = remembers;
    for (int i = 0; i < MOST_GROWTHS && !st && (grown || i == 0) && !thr_limits_stop(p->limits);
         i++)
      st = exclude(p, middle, remembers ? &grown : NULL, proof, err);
    part = 2;
    if (st) break;
    if (p->excluded) {
      low = middle;
      most = (int)fmin(high, 2 * most + low * (p->best / p->cords - 1) / 2);
      *bound = fmax(*bound, thr_walk_programme_price(p, low + 1));
    } else {
      high = middle;
    }
  }
  *open = high;
  return st;
}

/* Do cords have to turn by more than is enough? *open: where to look for some that do not. */
static thr_status try_limit(thr_walk_programme *p, double enough, thr_walk_proof *proof,
                            double *bound, int *open, thr_err *err)
{
  const int part = 64; /* of the limit that cords may stay below */
  double most = floor(enough / thr_walk_programme_price(p, 1));
  int units = most < p->most_units ? (int)most : p->most_units;
  if (thr_walk_programme_price(p, units + 1) <= enough) units++; /* prices are rounded down */
  *open = units - units / part;
  if (units > p->most_units) return THR_OK;
  thr_status st = exclude(p, units, NULL, proof, err);
  if (!st && p->excluded) *bound = fmax(*bound, thr_walk_programme_price(p, units + 1));
  return st;
}

/* The passes of the dive's walks, and of the cords of other components, are within the limits? */
static bool within_limits(const thr_turning_columns *columns, const thr_cord *cord, int n,
                          int *passes)
{
  const thr_frame *frame = columns->f;
  double extra = 0;
  for (int e = 0; e < frame->n_edges; e++)
    passes[e] = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      passes[cord[i].half[k] >> 1]++;
  for (int e = 0; e < frame->n_edges; e++) {
    if (passes[e] > columns->most[e]) return false;
    extra += (passes[e] - columns->cover[e]) * frame->length[e];
  }
  return columns->task->extra_limit < 0 || extra <= columns->task->extra_limit;
}

/* The walks take the place of the component's cords in a copy of all. */
static thr_status replace_cords(const thr_walk_programme *p, const thr_cord *cord, int n_cords,
                                thr_cord *walk, thr_cord **all, thr_err *err)
{
  thr_status st = thr_cords_copy(cord, n_cords, all, err);
  for (int i = 0, k = 0; i < n_cords && !st; i++) {
    if (p->c->component[thr_tail(p->c->f, cord[i].half[0])] != p->component) continue;
    free((*all)[i].half);
    (*all)[i].half = walk[k].half;
    (*all)[i].n_passes = walk[k].n_passes;
    (*all)[i].closed =
        p->steps.closed || thr_cord_start(p->c->f, &walk[k]) == thr_cord_end(p->c->f, &walk[k]);
    walk[k++].half = NULL;
  }
  return st;
}

/* With the walks, which are taken over, cords that are within the limits and of which the dearest
 * costs less than largest become the better ones. passes: [n_edges] scratch. */
static thr_status keep_better(thr_walk_programme *p, const thr_cord *cord, int n_cords,
                              thr_cord *walk, double largest, int *passes, thr_cord **better,
                              thr_err *err)
{
  const thr_walk_measure measure = p->steps.measure;
  thr_cord *made = NULL;
  thr_status st = replace_cords(p, cord, n_cords, walk, &made, err);
  if (made && within_limits(p->c, made, n_cords, passes) &&
      thr_walk_price(p->c, measure, &made[thr_walk_dearest(p->c, measure, made, n_cords)]) <
          largest * (1 - 1e-9)) {
    thr_cord *before = *better;
    *better = made;
    made = before;
  }
  thr_cords_destroy(made, n_cords);
  return st;
}

/* Cords of at most so many units that turn, or are, less than the dearest of those that are known?
 * Then they are better. */
static thr_status look_below(thr_walk_programme *p, const thr_cord *cord, int n_cords, double bound,
                             int units, int *passes, thr_cord **better, thr_err *err)
{
  const thr_walk_measure measure = p->steps.measure;
  const thr_cord *known = *better ? *better : cord;
  double largest =
      thr_walk_price(p->c, measure, &known[thr_walk_dearest(p->c, measure, known, n_cords)]);
  thr_cord *walk = thr_calloc((size_t)p->cords, sizeof *walk);
  bool found = false, wide = largest > near_enough * bound;
  uint64_t random = 1;
  thr_status st = walk ? thr_walk_dive(p, units, NULL, 0, walk, &found, err) : thr_nomem(err);
  for (int i = 0; i < MOST_DRAWN && wide && !st && !found && !thr_limits_stop(p->limits); i++)
    st = thr_walk_dive(p, units, &random, 0, walk, &found, err);
  if (!st && !found && wide) st = thr_walk_choose(p, units, walk, &found, err);
  if (!st && found) st = keep_better(p, cord, n_cords, walk, largest, passes, better, err);
  thr_cords_destroy(walk, p->cords);
  return st;
}

/* Looks for cords just above what is excluded, in growing steps up to the first that are better,
 * and then below these. */
static thr_status look_for_cords(thr_walk_programme *p, const thr_cord *cord, int n_cords,
                                 double bound, int low, thr_cord **better, thr_err *err)
{
  const thr_walk_measure measure = p->steps.measure;
  const double near = 5e-4; /* of the limit */
  int *passes = thr_calloc((size_t)p->c->f->n_edges, sizeof *passes), units = low;
  thr_status st = passes ? THR_OK : thr_nomem(err);
  for (int i = 0; i < MOST_DIVES && !st && !thr_limits_stop(p->limits); i++) {
    const thr_cord *known = *better ? *better : cord;
    double largest =
        thr_walk_price(p->c, measure, &known[thr_walk_dearest(p->c, measure, known, n_cords)]);
    int high = (int)floor(largest / thr_walk_programme_price(p, 1));
    if (high > p->most_units) high = p->most_units;
    if (*better) units = low + (high - low) / 2;
    if (largest <= near_enough * bound && i >= FEW_DIVES) break;
    if (units > high || thr_walk_programme_price(p, units) >= largest * (1 - 1e-6)) break;
    if (*better && thr_walk_programme_price(p, high - low) < near * largest) break;
    thr_cord *before = *better;
    st = look_below(p, cord, n_cords, bound, units, passes, better, err);
    if (*better != before) continue;
    low = units;
    units += 1 + (high - units) / (i < 2 ? 32 : i < 5 ? 16 : 4);
  }
  free(passes);
  return st;
}

/* Cords near those that are known, in the programme's component. */
static thr_status look_near(thr_walk_programme *p, const thr_cord *cord, int n_cords, double bound,
                            thr_cord **better, thr_err *err)
{
  const double near = fmax(1e-9, p->limits->gap); /* of the bound */
  const thr_walk_measure measure = p->steps.measure;
  const thr_cord *known = *better ? *better : cord;
  const double largest =
      thr_walk_price(p->c, measure, &known[thr_walk_dearest(p->c, measure, known, n_cords)]);
  thr_cord *walk = NULL;
  int n = 0, *passes = thr_calloc((size_t)p->c->f->n_edges, sizeof *passes);
  bool improved = false;
  thr_status st = passes ? thr_cords_copy(known, n_cords, &walk, err) : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++) { /* those of the component come first, in their order */
    if (p->c->component[thr_tail(p->c->f, walk[i].half[0])] != p->component) continue;
    const thr_cord here = walk[i];
    walk[i] = walk[n];
    walk[n++] = here;
  }
  if (!st && n == p->cords) st = thr_walk_near(p, bound * (1 + near), walk, &improved, err);
  if (!st && improved) st = keep_better(p, known, n_cords, walk, largest, passes, better, err);
  thr_cords_destroy(walk, walk ? n_cords : 0);
  free(passes);
  return st;
}

/* Has every edge its price, so that columns are walks that cords can be? */
static bool has_own_prices(const thr_walk_programme *p)
{
  int edges = 0;
  for (int e = 0; e < p->c->f->n_edges; e++)
    edges += p->edge[e] >= 0;
  return p->n_edges == edges;
}

/* Each in its part of the time: the bound; cords just above it; cords near those that are known. */
static thr_status search(thr_walk_programme *p, const thr_walk_ask *ask, double *bound,
                         thr_walk_proof *made, thr_cord **better, thr_err *err)
{
  const double for_bound = .8, for_cords = .3, for_near = .6; /* of what is left */
  const thr_turning_task *task = p->c->task;
  const thr_limits *limits = p->limits;
  const thr_cord *cord = ask->cord;
  const int n_cords = ask->n_cords;
  const double largest = thr_walk_price(p->c, ask->measure,
                                        &cord[thr_walk_dearest(p->c, ask->measure, cord, n_cords)]);
  int open = 0;
  const bool brief = limits->brief; /* nothing is left for cords near others */
  thr_limits share = brief ? *limits : thr_limits_part(limits, for_bound);
  p->limits = &share;
  thr_status st = ask->enough > 0 ? try_limit(p, ask->enough, made, bound, &open, err)
                                  : bisect(p, largest, false, made, bound, &open, err);
  if (!st && ask->enough <= 0) st = bisect(p, largest, true, made, bound, &open, err);
  const bool near = thr_limits_near(limits, largest, *bound);
  const bool wanted = !near && ask->measure != THR_WALK_PULL &&
                      (ask->enough <= 0 || *bound <= ask->enough) && !task->tube &&
                      !task->end_count && has_own_prices(p);
  if (!brief) share = thr_limits_part(limits, for_cords);
  if (!st && wanted) st = look_for_cords(p, cord, n_cords, *bound, open, better, err);
  if (!brief) share = thr_limits_part(limits, for_near);
  if (!st && wanted && !brief) st = look_near(p, cord, n_cords, *bound, better, err);
  p->limits = limits;
  return st;
}

/* One price for all images, where there are many. */
static thr_status merge_images(thr_walk_programme *p, thr_orbits_motions *motions, thr_err *err)
{
  const thr_frame *frame = p->c->f;
  if (!motions || p->n_variables <= MOST_DENSE) return THR_OK;
  int *edge = thr_calloc((size_t)frame->n_edges, sizeof *edge),
      *node = thr_calloc((size_t)frame->n_nodes, sizeof *node);
  thr_status st =
      edge && node ? thr_orbits_lowest(p->c, motions, p->limits, edge, node, err) : thr_nomem(err);
  if (!st) st = thr_walk_programme_merge(p, edge, node, err);
  free(edge);
  free(node);
  return st;
}

thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_walk_ask *ask,
                          const thr_limits *limits, thr_walk_proof *proof, double *bound,
                          thr_cord **better, thr_err *err)
{
  const int dearest = thr_walk_dearest(columns, ask->measure, ask->cord, ask->n_cords);
  const double largest = thr_walk_price(columns, ask->measure, &ask->cord[dearest]);
  thr_walk_programme p;
  thr_walk_proof made = {0};
  thr_err why = {0};
  if (columns->task->cords < 2 || *bound >= largest * (1 - 1e-9)) return THR_OK;
  thr_status st = thr_walk_programme_init(&p, columns, ask->measure, ask->cord, ask->n_cords,
                                          ask->least, limits, &why);
  if (!st) st = merge_images(&p, ask->motions, &why);
  if (!st) st = search(&p, ask, bound, &made, better, &why);
  if (!st && made.edge) {
    thr_walk_proof_destroy(proof);
    *proof = made;
    made = (thr_walk_proof){0};
  }
  thr_walk_proof_destroy(&made);
  thr_walk_programme_destroy(&p);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
