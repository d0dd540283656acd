/* Cords cut evenly by what they turn. */
#include "planner/cut.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of one cord: a part of it is passes a .. b, and turns by before[b] - before[a]. */
typedef struct {
  int n;          /* passes */
  double *before; /* [n] turning before the pass, rad; owned */
  bool *ends;     /* [n] may a part end with this pass? owned */
  int *last;      /* [n] last passes of the parts; owned */
  int n_parts;
} cutter;

static void cutter_destroy(cutter *x)
{
  free(x->before);
  free(x->ends);
  free(x->last);
}

static thr_status cutter_init(cutter *x, const thr_plan *plan, const thr_request *options, const thr_cord *cord, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  *x = (cutter){.n = cord->n_passes,
                .before = thr_calloc(n, sizeof *x->before),
                .ends = thr_calloc(n, sizeof *x->ends),
                .last = thr_calloc(n, sizeof *x->last)};
  if (!x->before || !x->ends || !x->last) return thr_nomem(err);
  for (int k = 0; k < x->n; k++) {
    x->ends[k] = k + 1 == x->n || thr_plan_end_allowed(&plan->frame, options, thr_head(&plan->frame, cord->half[k]));
    if (k > 0) x->before[k] = x->before[k - 1] + thr_turn_angle(&plan->frame, cord->half[k - 1], cord->half[k]);
  }
  return THR_OK;
}

/* Parts that turn by at most the limit, each as long as can be: there are no fewer such parts. False: some part turns more. */
static bool cut_within(cutter *x, double limit)
{
  x->n_parts = 0;
  for (int first = 0; first < x->n;) {
    int last = -1;
    for (int k = first; k < x->n && x->before[k] - x->before[first] <= limit; k++)
      if (x->ends[k]) last = k;
    if (last < 0) return false;
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
      if (!x->ends[k] || larger >= nearest) continue;
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

thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed, thr_err *err)
{
  bool done = plan->n_cords > 0;
  thr_status st = thr_plan_request(seed, &plan->frame, options, err);
  if (!st && !(seed->cord = thr_calloc((size_t)plan->n_cords * (size_t)options->cords, sizeof *seed->cord))) st = thr_nomem(err);
  for (int i = 0; i < plan->n_cords && !st && done; i++) {
    cutter x;
    st = cutter_init(&x, plan, options, &plan->cord[i], err);
    done = !st && cut_evenly(&x, options->cords);
    if (done) st = add_parts(&x, &plan->cord[i], seed, err);
    cutter_destroy(&x);
  }
  if (!st && done) st = thr_plan_measure(&seed->frame, &seed->options, seed->cord, seed->n_cords, &seed->metrics, err);
  if (st || !done) thr_plan_destroy(seed);
  return st;
}
