#include "planner/uncross.h"

#include "graph/framework/frame.h"
#include "graph/plan/channels.h"
#include "graph/plan/request.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_frame *frame;
  const int *rank;
  thr_cord *cord;
  int turns;    /* of the cord (thr_cord_turns) */
  bool exactly; /* the turning must stay the same */
  int node, n;
  thr_channel *channel; /* [n] those of the cord in the node, by pass; room for all its passes */
} uncrossing;

static void list_channels(uncrossing *x)
{
  const thr_cord *cord = x->cord;
  x->n = 0;
  for (int k = 0; k < x->turns; k++)
    if (thr_head(x->frame, cord->half[k]) == x->node)
      x->channel[x->n++] = (thr_channel){.pass = k, .in = cord->half[k] ^ 1, .out = cord->half[(k + 1) % cord->n_passes]};
}

/* By how much the cord would turn more, rad, if the part between two channels were run the other way round. */
static double more_turning(const uncrossing *x, const thr_channel *a, const thr_channel *b)
{
  double now = thr_turn_angle(x->frame, a->in ^ 1, a->out) + thr_turn_angle(x->frame, b->in ^ 1, b->out);
  return thr_turn_angle(x->frame, a->in ^ 1, b->in) + thr_turn_angle(x->frame, a->out ^ 1, b->out) - now;
}

static void reverse(int *half, int from, int last)
{
  for (; from <= last; from++, last--) {
    int one = half[from] ^ 1;
    half[from] = half[last] ^ 1;
    half[last] = one;
  }
}

/* Runs a part round such that one pair of channels in the node crosses no longer: that which costs least turning. False: none. */
static bool uncross_pair(uncrossing *x)
{
  double least = HUGE_VAL;
  int from = 0, last = 0;
  list_channels(x);
  for (int j = 0; j < x->n; j++)
    for (int i = 0; i < j; i++) {
      const thr_channel *a = &x->channel[i], *b = &x->channel[j];
      if (!thr_channels_cross(x->rank, a, b)) continue;
      double more = more_turning(x, a, b);
      if (more >= least || (x->exactly && fabs(more) > 1e-12)) continue;
      least = more;
      from = a->pass + 1;
      last = b->pass;
    }
  if (least == HUGE_VAL) return false;
  reverse(x->cord->half, from, last);
  return true;
}

static thr_status uncross_cord(uncrossing *x, thr_err *err)
{
  x->channel = thr_calloc((size_t)x->cord->n_passes, sizeof *x->channel);
  if (!x->channel) return thr_nomem(err);
  for (x->node = 0; x->node < x->frame->n_nodes; x->node++)
    while (uncross_pair(x))
      ;
  free(x->channel);
  return THR_OK;
}

static thr_status uncross_cords(thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  size_t n = 2 * (size_t)frame->n_edges;
  int *around = thr_calloc(n, sizeof *around), *rank = thr_calloc(n, sizeof *rank);
  thr_status st = around && rank ? thr_channels_around(frame, around, err) : thr_nomem(err);
  for (int i = 0; i < (int)n && !st; i++)
    rank[around[i]] = i;
  for (int c = 0; c < plan->n_cords && !st; c++) {
    thr_cord *cord = &plan->cord[c];
    uncrossing x = {.frame = frame,
                    .rank = rank,
                    .cord = cord,
                    .turns = thr_cord_turns(&plan->options, cord),
                    .exactly = thr_wants_turning(&plan->options)};
    st = uncross_cord(&x, err);
  }
  free(around);
  free(rank);
  return st;
}

/* How many are left, and in which piece one is. */
static thr_status count(thr_plan *plan, thr_err *err)
{
  thr_channels channels;
  thr_status st = thr_channels_make(&channels, plan, err);
  if (st) return st;
  plan->metrics.crossings = (int)channels.crossings;
  int crossed = channels.crossed;
  thr_channels_destroy(&channels);
  if (plan->options.crossings != THR_CROSSINGS_FORBID || plan->metrics.crossings == 0) return THR_OK;
  return thr_fail(
      err, THR_ELIMIT,
      "no plan without crossing channels was found: %d cross inside %d of %d pieces; use --crossings price, or one cord "
      "in each component, which never needs any",
      plan->metrics.crossings, crossed, plan->frame.n_nodes);
}

thr_status thr_plan_uncross(thr_plan *plan, thr_err *err)
{
  if (plan->options.crossings == THR_CROSSINGS_ALLOW || plan->n_cords == 0) return THR_OK;
  const double length = plan->metrics.length; /* the same passes, whatever the order in which they are added up */
  thr_status st = uncross_cords(plan, err);
  if (!st) st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics, err);
  plan->metrics.length = length;
  return st ? st : count(plan, err);
}
