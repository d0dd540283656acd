/* SPDX-License-Identifier: GPL-3.0-or-later */
/* More cords by cutting few: a start for the cord that turns most, and the rows of advice. Private
 * to planner/. */
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of one cord: a part of it is passes a .. b, and turns by before[b] - before[a]. */
typedef struct thr_cut {
  int n;          /* passes */
  double *before; /* [n] turning before the pass, rad; owned */
  double *length; /* [n + 1] of the passes before; owned */
  int *end;       /* [n] the last pass up to this one that a part may end with, -1 = none; owned */
  int *last;      /* [n] last passes of the parts; owned */
  int n_parts;
} cutter;

static void cutter_destroy(cutter *x)
{
  free(x->before);
  free(x->length);
  free(x->end);
  free(x->last);
}

static thr_status cutter_init(cutter *x, const thr_plan *plan, const thr_request *options,
                              const thr_cord *cord, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  *x = (cutter){.n = cord->n_passes,
                .before = thr_calloc(n, sizeof *x->before),
                .length = thr_calloc(n + 1, sizeof *x->length),
                .end = thr_calloc(n, sizeof *x->end),
                .last = thr_calloc(n, sizeof *x->last)};
  if (!x->before || !x->length || !x->end || !x->last) return thr_nomem(err);
  thr_turns turns = thr_turns_begin(&plan->frame, cord->half[0]);
  for (int k = 0; k < x->n; k++) {
    const int half = cord->half[k];
    const bool ends =
        k + 1 == x->n || thr_plan_end_allowed(&plan->frame, options, thr_head(&plan->frame, half));
    x->end[k] = ends ? k : k > 0 ? x->end[k - 1] : -1;
    x->length[k + 1] = x->length[k] + plan->frame.length[half >> 1];
    if (k > 0) x->before[k] = x->before[k - 1] + thr_turns_next(&turns, half);
  }
  return THR_OK;
}

/* Is a part within all limits? Each of them holds for whatever is inside such a part as well. */
static bool is_within(const cutter *x, int first, int last, const thr_parts_measures *limit)
{
  if (x->before[last] - x->before[first] > limit->turning) return false;
  if (x->length[last + 1] - x->length[first] > limit->longest) return false;
  if (limit->pulled >= x->before[last] - x->before[first]) return true;
  const thr_parting parting = thr_least_pull(x->before, first, last);
  return thr_parting_larger(&parting) <= limit->pulled;
}

/* Returns the last pass with which a part from first on is within the limits, or first. O(log^2
 * passes). */
static int reach_of(const cutter *x, int first, const thr_parts_measures *limit)
{
  int low = first, high = x->n;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (is_within(x, first, middle, limit))
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Parts within the limits, each as long as can be: there are no fewer such parts. False: some part
 * is not. */
static bool cut_within(cutter *x, const thr_parts_measures *limit)
{
  x->n_parts = 0;
  for (int first = 0; first < x->n;) {
    const int last = x->end[reach_of(x, first, limit)];
    if (last < first || !is_within(x, first, last, limit)) return false;
    x->last[x->n_parts++] = last;
    first = last + 1;
  }
  return true;
}

/* One part more: the part that turns most is cut near its middle. False where no part can be. */
static bool cut_once_more(cutter *x)
{
  int part = -1, at = -1;
  double most = -1;
  for (int i = 0, first = 0; i < x->n_parts; first = x->last[i++] + 1) {
    double turning = x->before[x->last[i]] - x->before[first], nearest = INFINITY;
    for (int k = first; k < x->last[i] && turning > most; k++) {
      double larger =
          fmax(x->before[k] - x->before[first], x->before[x->last[i]] - x->before[k + 1]);
      if (x->end[k] != k || larger >= nearest) continue;
      nearest = larger;
      part = i;
      at = k;
    }
    if (part == i) most = turning;
  }
  if (part < 0) return false;
  memmove(x->last + part + 1, x->last + part, (size_t)(x->n_parts - part) * sizeof *x->last);
  x->last[part] = at;
  x->n_parts++;
  return true;
}

/* Into exactly so many parts. */
static bool cut_evenly(cutter *x, int parts)
{
  enum { HALVINGS = 60 };
  thr_parts_measures limit = {
      .turning = x->before[x->n - 1], .pulled = INFINITY, .longest = INFINITY};
  double low = 0, high = limit.turning;
  for (int i = 0; i < HALVINGS; i++) {
    limit.turning = (low + high) / 2;
    if (cut_within(x, &limit) && x->n_parts <= parts)
      high = limit.turning;
    else
      low = limit.turning;
  }
  limit.turning = high;
  bool done = cut_within(x, &limit) && x->n_parts <= parts;
  while (done && x->n_parts < parts)
    done = cut_once_more(x);
  return done;
}

/* The parts as cords of seed, behind those that it has. */
static thr_status add_parts(const cutter *x, const thr_cord *cord, thr_plan *seed, thr_err *err)
{
  for (int i = 0, first = 0; i < x->n_parts; first = x->last[i++] + 1) {
    thr_cord *part = &seed->cord[seed->n_cords];
    int n = x->last[i] + 1 - first;
    *part = (thr_cord){.component = cord->component,
                       .n_passes = n,
                       .half = thr_calloc((size_t)n, sizeof *part->half)};
    if (!part->half) return thr_nomem(err);
    memcpy(part->half, cord->half + first, (size_t)n * sizeof *part->half);
    part->closed = thr_cord_start(&seed->frame, part) == thr_cord_end(&seed->frame, part);
    thr_cord_id(seed->n_cords++, part->id);
  }
  return THR_OK;
}

thr_status thr_parts_open(thr_parts *cuts, const thr_plan *plan, const thr_request *options,
                          thr_err *err)
{
  *cuts = (thr_parts){.plan = plan, .cord = thr_calloc((size_t)plan->n_cords, sizeof *cuts->cord)};
  thr_status st = cuts->cord ? THR_OK : thr_nomem(err);
  while (!st && cuts->n < plan->n_cords) {
    st = cutter_init(&cuts->cord[cuts->n], plan, options, &plan->cord[cuts->n], err);
    cuts->n++;
  }
  return st;
}

void thr_parts_destroy(thr_parts *cuts)
{
  for (int i = 0; i < cuts->n; i++)
    cutter_destroy(&cuts->cord[i]);
  free(cuts->cord);
  *cuts = (thr_parts){0};
}

bool thr_parts_into(thr_parts *cuts, int parts)
{
  bool done = cuts->n > 0;
  for (int i = 0; i < cuts->n && done; i++)
    done = cut_evenly(&cuts->cord[i], parts);
  return done;
}

thr_parts_measures thr_parts_measure(const thr_parts *cuts)
{
  thr_parts_measures m = {0};
  for (int c = 0; c < cuts->n; c++) {
    const cutter *x = &cuts->cord[c];
    for (int i = 0, first = 0; i < x->n_parts; first = x->last[i++] + 1) {
      const int last = x->last[i];
      m.turning = fmax(m.turning, x->before[last] - x->before[first]);
      const thr_parting parting = thr_least_pull(x->before, first, last);
      if (thr_parting_larger(&parting) > m.pulled)
        m.other = thr_least_pull_other(x->before, first, last);
      m.pulled = fmax(m.pulled, thr_parting_larger(&parting));
      m.longest = fmax(m.longest, x->length[last + 1] - x->length[first]);
    }
  }
  return m;
}

/* ---- the shortest cords, opened and cut ---- */

/* The closed cord begins where it turned most, of the nodes where an end may be. False: there is
 * none. */
static bool open_cord(const thr_frame *frame, const thr_request *request, thr_cord *cord,
                      int *scratch)
{
  int best = -1, n = cord->n_passes;
  double most = -1;
  for (int i = 0; i < n; i++) {
    double angle = thr_turn_angle(frame, cord->half[(i + n - 1) % n], cord->half[i]);
    if (angle <= most || !thr_plan_end_allowed(frame, request, thr_tail(frame, cord->half[i])))
      continue;
    most = angle;
    best = i;
  }
  for (int i = 0; i < n && best >= 0; i++)
    scratch[i] = cord->half[(best + i) % n];
  if (best >= 0) memcpy(cord->half, scratch, (size_t)n * sizeof *scratch);
  return best >= 0;
}

thr_status thr_cut_open(const thr_frame *frame, const thr_request *request, const thr_plan *closed,
                        thr_plan *opened, thr_err *err)
{
  bool can = closed->n_cords > 0;
  thr_status st = thr_plan_request(opened, frame, request, err);
  if (!st) st = thr_cords_copy(closed->cord, closed->n_cords, &opened->cord, err);
  if (!st) opened->n_cords = closed->n_cords;
  int *scratch = thr_calloc((size_t)closed->metrics.passes + 1, sizeof *scratch);
  if (!scratch && !st) st = thr_nomem(err);
  for (int i = 0; i < opened->n_cords && !st && can; i++)
    can = open_cord(frame, request, &opened->cord[i], scratch);
  if (!st && can)
    st = thr_plan_measure(&opened->frame, &opened->options, opened->cord, opened->n_cords,
                          &opened->metrics, err);
  free(scratch);
  if (st || !can) thr_plan_destroy(opened);
  return st;
}

/* Cuts every cord into as few parts as keep to the limits, at least as many as asked for. False:
 * more are needed than allowed. */
static bool cut_few(thr_parts *cuts, const thr_request *options)
{
  const thr_parts_measures limit = {.turning = INFINITY,
                                    .pulled = thr_request_most_pulled(options),
                                    .longest =
                                        options->max_length > 0 ? options->max_length : INFINITY};
  bool done = cuts->n > 0;
  for (int i = 0; i < cuts->n && done; i++) {
    cutter *x = &cuts->cord[i];
    done = cut_within(x, &limit) && x->n_parts <= options->cords;
    while (done && x->n_parts < options->cords_least)
      done = cut_once_more(x);
  }
  return done;
}

static int count_parts(const thr_parts *cuts)
{
  int n = 0;
  for (int i = 0; i < cuts->n; i++)
    n += cuts->cord[i].n_parts;
  return n;
}

/* Makes a plan of the parts that the cords of a plan are cut into. On failure seed is empty. */
static thr_status plan_parts(const thr_parts *cuts, const thr_request *options, thr_plan *seed,
                             thr_err *err)
{
  const thr_plan *plan = cuts->plan;
  thr_status st = thr_plan_request(seed, &plan->frame, options, err);
  if (!st && !(seed->cord = thr_calloc((size_t)count_parts(cuts), sizeof *seed->cord)))
    st = thr_nomem(err);
  for (int i = 0; i < plan->n_cords && !st; i++)
    st = add_parts(&cuts->cord[i], &plan->cord[i], seed, err);
  if (!st)
    st = thr_plan_measure(&seed->frame, &seed->options, seed->cord, seed->n_cords, &seed->metrics,
                          err);
  if (st) thr_plan_destroy(seed);
  return st;
}

thr_status thr_cut_few(const thr_frame *frame, const thr_request *options, const thr_plan *closed,
                       thr_plan *seed, thr_err *err)
{
  const bool is_range = options->cords_least<options->cords, is_limited = options->max_pull> 0 ||
                        options->max_length > 0;
  thr_plan opened = {0};
  thr_parts cuts = {0};
  *seed = (thr_plan){0};
  if (options->ends == THR_ENDS_COUNTS || options->joint == THR_JOINT_TUBE) return THR_OK;
  thr_status st = thr_cut_open(frame, options, closed, &opened, err);
  if (!st && opened.n_cords > 0) st = thr_parts_open(&cuts, &opened, options, err);
  bool done = !st && (is_range && is_limited ? cut_few(&cuts, options)
                                             : thr_parts_into(&cuts, options->cords));
  if (options->ends == THR_ENDS_CLOSED && count_parts(&cuts) > cuts.n) done = false;
  if (done) st = plan_parts(&cuts, options, seed, err);
  thr_parts_destroy(&cuts);
  thr_plan_destroy(&opened);
  return st;
}

thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed,
                        thr_err *err)
{
  thr_parts cuts;
  thr_status st = thr_parts_open(&cuts, plan, options, err);
  if (!st && thr_parts_into(&cuts, options->cords)) st = plan_parts(&cuts, options, seed, err);
  thr_parts_destroy(&cuts);
  return st;
}
