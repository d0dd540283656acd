/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts few cords into more: a start for the search for the cord that turns most, and the rows of
 * advice.
 *
 * A cord can be cut where it visits a node that may hold an end. Parts within a limit are made
 * greedily, each as long as possible, which gives the fewest parts (cut_within); the least limit
 * that gives at most so many parts is found by bisection (cut_evenly). The turns at the cuts are
 * saved.
 *
 * Example: a cord of 12 passes that turns by 90 degrees between any two and may be cut anywhere:
 * three parts have 4 passes each, and turn by 270 degrees each. */
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What parts may turn, need at an end and be long at most, rad, rad, units. */
typedef struct {
  double turning, pulled, longest;
} part_limits;

/* Of one cord: a part of it is passes a .. b, and turns by before[b] - before[a]. */
typedef struct {
  int n;          /* passes */
  double *before; /* [n] turning before the pass, rad; owned */
  double *length; /* [n + 1] of the passes before; owned */
  int *end;       /* [n] the last pass up to this one that a part may end with, -1 = none; owned */
  int *last;      /* [n] last passes of the parts; owned */
  int n_parts;
} cord_cutter;

static void cutter_destroy(cord_cutter *cutter)
{
  free(cutter->before);
  free(cutter->length);
  free(cutter->end);
  free(cutter->last);
}

/* Prepares to cut a cord: sums up turns and lengths, and finds the passes that a part may end
 * with. */
static thr_status cutter_init(cord_cutter *cutter, const thr_plan *plan, const thr_request *options,
                              const thr_cord *cord, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  *cutter = (cord_cutter){.n = cord->n_passes,
                          .before = thr_calloc(n, sizeof *cutter->before),
                          .length = thr_calloc(n + 1, sizeof *cutter->length),
                          .end = thr_calloc(n, sizeof *cutter->end),
                          .last = thr_calloc(n, sizeof *cutter->last)};

  if (!cutter->before || !cutter->length || !cutter->end || !cutter->last) return thr_nomem(err);

  /* Go along the cord; a pass that no part may end with refers to the last one before it. */
  thr_turns turns = thr_turns_begin(&plan->frame, cord->half[0]);
  for (int k = 0; k < cutter->n; k++) {
    const int half = cord->half[k];
    const bool ends = k + 1 == cutter->n ||
                      thr_plan_end_allowed(&plan->frame, options, thr_head(&plan->frame, half));
    cutter->end[k] = ends ? k : k > 0 ? cutter->end[k - 1] : -1;
    cutter->length[k + 1] = cutter->length[k] + plan->frame.length[half >> 1];
    if (k > 0) cutter->before[k] = cutter->before[k - 1] + thr_turns_next(&turns, half);
  }

  return THR_OK;
}

/* Is a part within all limits? Each of them holds for whatever is inside such a part as well. */
static bool is_within(const cord_cutter *cutter, int first, int last, const part_limits *limit)
{
  if (cutter->before[last] - cutter->before[first] > limit->turning) return false;
  if (cutter->length[last + 1] - cutter->length[first] > limit->longest) return false;

  if (limit->pulled >= cutter->before[last] - cutter->before[first]) return true;
  const thr_parting parting = thr_least_pull(cutter->before, first, last);
  return thr_parting_larger(&parting) <= limit->pulled;
}

/* Returns the last pass with which a part from first on is within the limits, or first. O(log^2
 * passes). */
static int reach_of(const cord_cutter *cutter, int first, const part_limits *limit)
{
  /* Bisection: whatever is inside a part within the limits is within them, too. */
  int low = first, high = cutter->n;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (is_within(cutter, first, middle, limit))
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Parts within the limits, each as long as can be: there are no fewer such parts. False: some part
 * is not. */
static bool cut_within(cord_cutter *cutter, const part_limits *limit)
{
  cutter->n_parts = 0;
  for (int first = 0; first < cutter->n;) {
    /* Go as far as the limits allow, and back to the last pass that may be an end. */
    const int last = cutter->end[reach_of(cutter, first, limit)];
    if (last < first || !is_within(cutter, first, last, limit)) return false;

    cutter->last[cutter->n_parts++] = last;
    first = last + 1;
  }
  return true;
}

/* Makes one part more: cuts the part that turns most near its middle. False: no part can be cut. */
static bool cut_once_more(cord_cutter *cutter)
{
  int part = -1, at = -1;
  double most = -1;

  /* Look for the cut that halves the part with the most turning best. */
  for (int i = 0, first = 0; i < cutter->n_parts; first = cutter->last[i++] + 1) {
    double turning = cutter->before[cutter->last[i]] - cutter->before[first], nearest = INFINITY;
    for (int k = first; k < cutter->last[i] && turning > most; k++) {
      double larger = fmax(cutter->before[k] - cutter->before[first],
                           cutter->before[cutter->last[i]] - cutter->before[k + 1]);
      if (cutter->end[k] != k || larger >= nearest) continue;
      nearest = larger;
      part = i;
      at = k;
    }
    if (part == i) most = turning;
  }

  if (part < 0) return false;

  /* Make room for the new part behind the one that is cut. */
  memmove(cutter->last + part + 1, cutter->last + part,
          (size_t)(cutter->n_parts - part) * sizeof *cutter->last);
  cutter->last[part] = at;
  cutter->n_parts++;
  return true;
}

/* Cuts the cord into exactly so many parts. */
static bool cut_evenly(cord_cutter *cutter, int parts)
{
  enum { HALVINGS = 60 };

  part_limits limit = {
      .turning = cutter->before[cutter->n - 1], .pulled = INFINITY, .longest = INFINITY};
  double low = 0, high = limit.turning;

  /* Halve the interval of the limit; too many parts mean that the limit is too small. */
  for (int i = 0; i < HALVINGS; i++) {
    limit.turning = (low + high) / 2;
    if (cut_within(cutter, &limit) && cutter->n_parts <= parts)
      high = limit.turning;
    else
      low = limit.turning;
  }

  /* The greedy parts may be too few, as the turns do not divide evenly. */
  limit.turning = high;
  bool done = cut_within(cutter, &limit) && cutter->n_parts <= parts;
  while (done && cutter->n_parts < parts)
    done = cut_once_more(cutter);
  return done;
}

/* Appends the parts as cords to seed. */
static thr_status add_parts(const cord_cutter *cutter, const thr_cord *cord, thr_plan *seed,
                            thr_err *err)
{
  for (int i = 0, first = 0; i < cutter->n_parts; first = cutter->last[i++] + 1) {
    thr_cord *part = &seed->cord[seed->n_cords];
    int n = cutter->last[i] + 1 - first;
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

/* The cords of a plan with what they turn up to each pass. */
typedef struct {
  const thr_plan *plan; /* borrowed; must stay */
  int n;                /* its cords */
  cord_cutter *cord;    /* [n]; owned */
} plan_cuts;

/* Opens cuts, to be released with cuts_destroy, after a failure too. options: where ends may be. */
static thr_status cuts_open(plan_cuts *cuts, const thr_plan *plan, const thr_request *options,
                            thr_err *err)
{
  *cuts = (plan_cuts){.plan = plan, .cord = thr_calloc((size_t)plan->n_cords, sizeof *cuts->cord)};

  thr_status st = cuts->cord ? THR_OK : thr_nomem(err);
  while (!st && cuts->n < plan->n_cords) {
    st = cutter_init(&cuts->cord[cuts->n], plan, options, &plan->cord[cuts->n], err);
    cuts->n++;
  }
  return st;
}

static void cuts_destroy(plan_cuts *cuts)
{
  for (int i = 0; i < cuts->n; i++)
    cutter_destroy(&cuts->cord[i]);
  free(cuts->cord);
  *cuts = (plan_cuts){0};
}

/* Cuts every cord, one in each component, into so many. False where the cords do not come by enough
 * nodes that may hold an end. O(parts log passes) for each of some 60 limits. */
static bool cut_into(plan_cuts *cuts, int parts)
{
  bool done = cuts->n > 0;
  for (int i = 0; i < cuts->n && done; i++)
    done = cut_evenly(&cuts->cord[i], parts);
  return done;
}

/* ---- the shortest cords, opened and cut ---- */

/* Begins the closed cord where it turned most, among the nodes that may hold an end. False: there
 * is none. */
static bool open_cord(const thr_frame *frame, const thr_request *request, thr_cord *cord,
                      int *scratch)
{
  int best = -1, n = cord->n_passes;
  double most = -1;

  /* Find the sharpest turn at a node that may hold an end. */
  for (int i = 0; i < n; i++) {
    double angle = thr_turn_angle(frame, cord->half[(i + n - 1) % n], cord->half[i]);
    if (angle <= most || !thr_plan_end_allowed(frame, request, thr_tail(frame, cord->half[i])))
      continue;
    most = angle;
    best = i;
  }

  /* Begin the cord there. */
  for (int i = 0; i < n && best >= 0; i++)
    scratch[i] = cord->half[(best + i) % n];
  if (best >= 0) memcpy(cord->half, scratch, (size_t)n * sizeof *scratch);
  return best >= 0;
}

thr_status thr_cut_open(const thr_frame *frame, const thr_request *request, const thr_plan *closed,
                        thr_plan *opened, thr_err *err)
{
  bool can = closed->n_cords > 0;

  /* Copy the closed cords. */
  thr_status st = thr_plan_request(opened, frame, request, err);
  if (!st) st = thr_cords_copy(closed->cord, closed->n_cords, &opened->cord, err);
  if (!st) opened->n_cords = closed->n_cords;

  int *scratch = thr_calloc((size_t)closed->metrics.passes + 1, sizeof *scratch);
  if (!scratch && !st) st = thr_nomem(err);

  /* Open each of them; a single one that has no such node leaves no plan. */
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
static bool cut_few(plan_cuts *cuts, const thr_request *options)
{
  const part_limits limit = {.turning = INFINITY,
                             .pulled = thr_request_most_pulled(options),
                             .longest = options->max_length > 0 ? options->max_length : INFINITY};
  bool done = cuts->n > 0;

  /* Cut each cord greedily, and then on until the parts are as many as the least number. */
  for (int i = 0; i < cuts->n && done; i++) {
    cord_cutter *cutter = &cuts->cord[i];
    done = cut_within(cutter, &limit) && cutter->n_parts <= options->cords;
    while (done && cutter->n_parts < options->cords_least)
      done = cut_once_more(cutter);
  }
  return done;
}

static int count_parts(const plan_cuts *cuts)
{
  int n = 0;
  for (int i = 0; i < cuts->n; i++)
    n += cuts->cord[i].n_parts;
  return n;
}

/* Makes a plan of the parts that the cords of a plan are cut into. On failure seed is empty. */
static thr_status plan_parts(const plan_cuts *cuts, const thr_request *options, thr_plan *seed,
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
  const bool is_range = options->cords_least < options->cords;
  const bool is_limited = options->max_pull > 0 || options->max_length > 0;
  thr_plan opened = {0};
  plan_cuts cuts = {0};
  *seed = (thr_plan){0};

  if (options->ends == THR_ENDS_COUNTS || options->joint == THR_JOINT_TUBE) return THR_OK;

  /* Open the closed cords, and cut them by the limits, or evenly into a given number. */
  thr_status st = thr_cut_open(frame, options, closed, &opened, err);
  if (!st && opened.n_cords > 0) st = cuts_open(&cuts, &opened, options, err);
  bool done =
      !st && (is_range && is_limited ? cut_few(&cuts, options) : cut_into(&cuts, options->cords));

  if (options->ends == THR_ENDS_CLOSED && count_parts(&cuts) > cuts.n) done = false;
  if (done) st = plan_parts(&cuts, options, seed, err);
  cuts_destroy(&cuts);
  thr_plan_destroy(&opened);
  return st;
}

thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed,
                        thr_err *err)
{
  plan_cuts cuts;
  thr_status st = cuts_open(&cuts, plan, options, err);
  if (!st && cut_into(&cuts, options->cords)) st = plan_parts(&cuts, options, seed, err);
  cuts_destroy(&cuts);
  return st;
}
