/* Cords cut evenly by what they turn. */
#include "planner/cut.h"
#include "graph/framework/frame.h"
#include "graph/plan/least_pull.h"

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

static thr_status cutter_init(cutter *x, const thr_plan *plan, const thr_request *options, const thr_cord *cord, thr_err *err)
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
    const bool ends = k + 1 == x->n || thr_plan_end_allowed(&plan->frame, options, thr_head(&plan->frame, half));
    x->end[k] = ends ? k : k > 0 ? x->end[k - 1] : -1;
    x->length[k + 1] = x->length[k] + plan->frame.length[half >> 1];
    if (k > 0) x->before[k] = x->before[k - 1] + thr_turns_next(&turns, half);
  }
  return THR_OK;
}

/* The last pass from first on, at most most, that the cord has not turned more than the limit before. O(log passes). */
static int reach_of(const cutter *x, int first, int most, double limit)
{
  int low = first, high = most + 1;
  while (high - low > 1) {
    int middle = low + (high - low) / 2;
    if (x->before[middle] - x->before[first] <= limit)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Parts that turn by at most the limit, each as long as can be: there are no fewer such parts. False: some part turns more. */
static bool cut_within(cutter *x, double limit)
{
  x->n_parts = 0;
  for (int first = 0; first < x->n;) {
    int last = x->end[reach_of(x, first, x->n - 1, limit)];
    if (last < first) return false;
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
      double larger = fmax(x->before[k] - x->before[first], x->before[x->last[i]] - x->before[k + 1]);
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
  double low = 0, high = x->before[x->n - 1];
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (low + high) / 2;
    if (cut_within(x, middle) && x->n_parts <= parts)
      high = middle;
    else
      low = middle;
  }
  bool done = cut_within(x, high) && x->n_parts <= parts;
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
    *part = (thr_cord){.component = cord->component, .n_passes = n, .half = thr_calloc((size_t)n, sizeof *part->half)};
    if (!part->half) return thr_nomem(err);
    memcpy(part->half, cord->half + first, (size_t)n * sizeof *part->half);
    part->closed = thr_cord_start(&seed->frame, part) == thr_cord_end(&seed->frame, part);
    thr_cord_id(seed->n_cords++, part->id);
  }
  return THR_OK;
}

thr_status thr_parts_open(thr_parts *cuts, const thr_plan *plan, const thr_request *options, thr_err *err)
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
      m.pulled = fmax(m.pulled, thr_parting_larger(&parting));
      m.longest = fmax(m.longest, x->length[last + 1] - x->length[first]);
    }
  }
  return m;
}

thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed, thr_err *err)
{
  thr_parts cuts;
  thr_status st = thr_parts_open(&cuts, plan, options, err);
  const bool done = !st && thr_parts_into(&cuts, options->cords);
  if (done) st = thr_plan_request(seed, &plan->frame, options, err);
  if (done && !st && !(seed->cord = thr_calloc((size_t)plan->n_cords * (size_t)options->cords, sizeof *seed->cord)))
    st = thr_nomem(err);
  for (int i = 0; i < plan->n_cords && !st && done; i++)
    st = add_parts(&cuts.cord[i], &plan->cord[i], seed, err);
  if (!st && done) st = thr_plan_measure(&seed->frame, &seed->options, seed->cord, seed->n_cords, &seed->metrics, err);
  if (st) thr_plan_destroy(seed);
  thr_parts_destroy(&cuts);
  return st;
}
