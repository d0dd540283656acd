/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leads channels that cross inside a piece otherwise, such that they no longer cross
 * (planner/planner.h states what is kept).
 *
 * Where two channels of one cord cross, the part of the cord between them is run backwards
 * (REVERSE). Two cords exchange their ends (EXCHANGE), or one goes on along the other backwards
 * (TURN). Each such change lowers the number of crossings, so the iteration ends. Closed cords
 * that were joined to one are cut again (planner/recut.c).
 *
 * Example: a cord goes through a node from arm a to b, and later from c to d, where a, c, b, d
 * stand in this order around the node. Afterwards the cord goes from a to c, backwards along the
 * part, and from b to d. */

#include "planner/planner_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_plan *plan;
  const thr_channels *channels; /* of the plan as it was: they say in which nodes some cross */
  bool exactly;                 /* the turning must stay the same */
  bool between;                 /* cords may exchange their ends; closed ones are joined */
  int node, n;
  thr_channel
      *channel; /* [n] those of the node, by cord and pass; room for as many as any node has */
} uncross_state;

/* How two channels, the first of the earlier cord or pass, are to be led instead. */
typedef enum {
  REVERSE,  /* of one cord: the part between them is run the other way round */
  EXCHANGE, /* of two: each cord ends as the other did; closed, they are one then */
  TURN /* of two: the first cord ends as the second began, backwards, and the second begins as the
          first ended */
} way;

typedef struct {
  way way;
  thr_channel a, b;
  int longer;  /* of two cords, passes of the longer one then, or of the one; 0 = of one cord */
  double more; /* turning, rad */
} channel_change;

/* Lists the channels that the node has now. */
static void list_channels(uncross_state *uncrossing)
{
  const thr_plan *plan = uncrossing->plan;

  uncrossing->n = 0;

  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];
    for (int k = 0, turns = thr_cord_turns(&plan->options, cord); k < turns; k++)
      if (thr_head(&plan->frame, cord->half[k]) == uncrossing->node)
        uncrossing->channel[uncrossing->n++] =
            (thr_channel){c, k, cord->half[k] ^ 1, cord->half[(k + 1) % cord->n_passes], 0};
  }
}

/* Returns by how much the cords would turn more, rad. */
static double more_turning(const thr_frame *frame, way how, const thr_channel *a,
                           const thr_channel *b)
{
  double now = thr_turn_angle(frame, a->in ^ 1, a->out) + thr_turn_angle(frame, b->in ^ 1, b->out);

  if (how == EXCHANGE)
    return thr_turn_angle(frame, a->in ^ 1, b->out) + thr_turn_angle(frame, b->in ^ 1, a->out) -
           now;
  return thr_turn_angle(frame, a->in ^ 1, b->in) + thr_turn_angle(frame, a->out ^ 1, b->out) - now;
}

/* Counts the passes of the longer of two cords that exchange their ends. */
static int longer_of(const thr_plan *plan, way how, const thr_channel *a, const thr_channel *b)
{
  int all = plan->cord[a->cord].n_passes + plan->cord[b->cord].n_passes, before = b->pass + 1;

  if (plan->options.ends == THR_ENDS_CLOSED) return all;

  int first = a->pass + 1 + (how == EXCHANGE ? plan->cord[b->cord].n_passes - before : before);
  return first > all - first ? first : all - first;
}

/* Orders changes: those of one cord first, of two the most even, then what turns least. */
static bool is_less(const channel_change *a, const channel_change *b)
{
  return a->longer != b->longer ? a->longer < b->longer : a->more < b->more;
}

/* Ways to lead a pair of channels that cross, if they are better than *best. */
static void try_ways(const uncross_state *uncrossing, const thr_channel *a, const thr_channel *b,
                     channel_change *best)
{
  bool one = a->cord == b->cord;
  if (!one && !uncrossing->between) return;

  /* One cord can only be reversed in part; two cords have two ways to go on. */
  for (way how = one ? REVERSE : EXCHANGE; how <= (one ? REVERSE : TURN); how++) {
    channel_change changed = {how, *a, *b, one ? 0 : longer_of(uncrossing->plan, how, a, b),
                              more_turning(&uncrossing->plan->frame, how, a, b)};
    if (is_less(&changed, best) && (!uncrossing->exactly || fabs(changed.more) <= 1e-12))
      *best = changed;
  }
}

/* Lets two cords go on, after passes i of a and j of b, as the other did; new passes take the place
 * of those that they had. */
static thr_status exchange(thr_plan *plan, thr_cord *a, int i, thr_cord *b, int j, thr_err *err)
{
  /* Each cord takes its own passes up to the crossing and the other's after it. */
  int n = i + b->n_passes - j, m = j + a->n_passes - i;
  int *one = thr_calloc((size_t)n, sizeof *one), *other = thr_calloc((size_t)m, sizeof *other);
  if (!one || !other) {
    free(one);
    free(other);
    return thr_nomem(err);
  }

  memcpy(one, a->half, (size_t)i * sizeof *one);
  memcpy(one + i, b->half + j, (size_t)(n - i) * sizeof *one);
  memcpy(other, b->half, (size_t)j * sizeof *other);
  memcpy(other + j, a->half + i, (size_t)(m - j) * sizeof *other);

  /* The new passes take the place of the old ones. */
  free(a->half);
  free(b->half);
  a->half = one;
  a->n_passes = n;
  b->half = other;
  b->n_passes = m;

  a->closed = thr_cord_start(&plan->frame, a) == thr_cord_end(&plan->frame, a);
  b->closed = thr_cord_start(&plan->frame, b) == thr_cord_end(&plan->frame, b);
  return THR_OK;
}

/* Makes a change. Closed cords are joined; open ones exchange their ends. */
static thr_status make(thr_plan *plan, const channel_change *change, thr_err *err)
{
  thr_cord *a = &plan->cord[change->a.cord], *b = &plan->cord[change->b.cord];

  int j = change->b.pass + 1;
  if (change->way == REVERSE) {
    thr_passes_reverse(a->half, change->a.pass + 1, change->b.pass);
    return THR_OK;
  }

  if (plan->options.ends == THR_ENDS_CLOSED)
    return thr_cords_join(plan, &change->a, &change->b, change->way == TURN, err);
  if (change->way == TURN) { /* backwards the second cord comes by the arm by which it went */
    thr_passes_reverse(b->half, 0, b->n_passes - 1);
    j = b->n_passes - j;
  }

  return exchange(plan, a, change->a.pass + 1, b, j, err);
}

/* Leads one pair of channels of the node otherwise, such that it crosses no longer. *changed: there
 * was one. */
static thr_status uncross_pair(uncross_state *uncrossing, bool *changed, thr_err *err)
{
  channel_change best = {.longer = INT_MAX, .more = HUGE_VAL};

  /* Choose the best change of all pairs that cross. */
  list_channels(uncrossing);
  for (int j = 0; j < uncrossing->n; j++)
    for (int i = 0; i < j; i++)
      if (thr_channels_cross(uncrossing->channels->rank, &uncrossing->channel[i],
                             &uncrossing->channel[j]))
        try_ways(uncrossing, &uncrossing->channel[i], &uncrossing->channel[j], &best);

  *changed = best.longer < INT_MAX;
  return *changed ? make(uncrossing->plan, &best, err) : THR_OK;
}

/* Goes node by node, and once more where cords changed, as channels of two cords may then be of
 * one. */
static thr_status uncross_nodes(uncross_state *uncrossing, thr_err *err)
{
  const int *first = uncrossing->channels->first;
  thr_status st = THR_OK;

  /* The channels tell in which nodes some crossed at the beginning; other nodes never get a
   * crossing. */
  for (bool some = true; some && !st;) {
    some = false;
    for (uncrossing->node = 0; uncrossing->node < uncrossing->plan->frame.n_nodes && !st;
         uncrossing->node++) {
      bool changed = false, crossed = false;
      for (int k = first[uncrossing->node]; k < first[uncrossing->node + 1]; k++)
        crossed |= uncrossing->channels->channel[k].crosses > 0;
      do {
        if (crossed) st = uncross_pair(uncrossing, &changed, err);
        some |= changed;
      } while (changed && !st);
    }
  }
  return st;
}

/* Tells whether different cords may exchange ends: in short plans, and in all plans if no crossing
 * is allowed. */
static bool may_exchange(const thr_request *request)
{
  return (thr_wants_length(request) || request->crossings == THR_CROSSINGS_FORBID) &&
         request->max_pull == 0;
}

/* Leads the channels of all nodes otherwise. between: cords may also exchange their ends. */
static thr_status uncross_cords(thr_plan *plan, bool between, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  size_t most = 0;
  thr_channels channels = {0};
  thr_status st = thr_channels_make(&channels, plan, err);

  /* No node has more channels than it has now. */
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if ((size_t)(channels.first[v + 1] - channels.first[v]) > most)
      most = (size_t)(channels.first[v + 1] - channels.first[v]);

  uncross_state uncrossing = {.plan = plan,
                              .channels = &channels,
                              .exactly = thr_wants_turning(&plan->options) &&
                                         plan->options.crossings != THR_CROSSINGS_FORBID,
                              .between = between,
                              .channel = thr_calloc(most, sizeof *uncrossing.channel)};
  thr_recut recut = {.rank = channels.rank};

  /* Closed cords that become one are cut until every component has as many as before. */
  if (!st) st = uncrossing.channel ? thr_recut_count(&recut, plan, err) : thr_nomem(err);
  if (!st) st = uncross_nodes(&uncrossing, err);
  if (!st) st = thr_recut_cords(&recut, plan, err);

  thr_recut_destroy(&recut);
  free(uncrossing.channel);
  thr_channels_destroy(&channels);
  return st;
}

/* ---- what is asked of single cords ---- */

static thr_status measure(thr_plan *plan, thr_err *err)
{
  return thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
}

/* As many cords as before, over every edge as many different ones, and none longer than may be;
 * even ones stay as even, unless no crossing is allowed. */
static bool serves(const thr_plan *plan, int n_cords, int distinct, double longest)
{
  const thr_request *request = &plan->options;
  double limit = request->max_length > 0 ? request->max_length : HUGE_VAL;

  if (thr_wants_balance(request) && request->crossings != THR_CROSSINGS_FORBID) limit = longest;
  return plan->n_cords == n_cords && plan->metrics.distinct >= distinct &&
         thr_cords_longest(&plan->frame, plan->cord, plan->n_cords) <= limit * (1 + 1e-12);
}

/* Uncrosses each cord by itself, and different cords with each other if what is asked of single
 * cords is kept. before[n]: a copy of the cords. */
static thr_status uncross(thr_plan *plan, const thr_cord *before, int n, thr_err *err)
{
  const int distinct = plan->metrics.distinct;
  const double longest = thr_cords_longest(&plan->frame, plan->cord, n);
  thr_cord *again;

  /* Each cord by itself, where cords may not exchange their ends. */
  if (n == 1 || !may_exchange(&plan->options)) {
    thr_status st = uncross_cords(plan, false, err);
    return st ? st : measure(plan, err);
  }

  /* All cords together, unless that breaks what the request asks of single cords. */
  thr_status st = uncross_cords(plan, true, err);
  if (!st) st = measure(plan, err);
  if (st || serves(plan, n, distinct, longest)) return st;

  /* Else begin again with the cords as they were, each by itself. */
  st = thr_cords_copy(before, n, &again, err);
  if (st) return st;
  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = again;
  plan->n_cords = n;
  st = uncross_cords(plan, false, err);
  return st ? st : measure(plan, err);
}

/* Counts the channels that cross, and the pieces in which some do. */
static thr_status count(thr_plan *plan, int *crossed, thr_err *err)
{
  thr_channels channels;
  *crossed = 0;
  if (plan->options.crossings == THR_CROSSINGS_ALLOW) return THR_OK;

  thr_status st = thr_channels_make(&channels, plan, err);
  if (st) return st;

  plan->metrics.crossings = (int)channels.crossings;
  *crossed = channels.crossed;
  thr_channels_destroy(&channels);
  return THR_OK;
}

thr_status thr_plan_count_crossings(thr_plan *plan, thr_err *err)
{
  int crossed;
  return count(plan, &crossed, err);
}

/* Fails with THR_ELIMIT where the request forbids crossings and some are left. */
static thr_status refuse(const thr_plan *plan, int crossed, thr_err *err)
{
  if (plan->options.crossings != THR_CROSSINGS_FORBID || plan->metrics.crossings == 0)
    return THR_OK;
  return thr_fail(
      err, THR_ELIMIT,
      "no plan without crossing channels was found: %d cross inside %d of %d pieces; use "
      "--crossings price, fewer "
      "cords, or nothing that is asked of single cords (--balance, --max-length, --distinct)",
      plan->metrics.crossings, crossed, plan->frame.n_nodes);
}

/* Measures the longest cord again, which may be another one now; the bound is about any cords. */
static void claim_longest(thr_plan *plan)
{
  thr_cords_claim *claim = &plan->cords_claim;
  if (!claim->present) return;
  claim->longest = thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);
  claim->longest_optimal = claim->longest <= claim->longest_bound * (1 + 1e-9);
}

/* Where exchanges left crossings, or made the cords longer, searches for others
 * (planner/channel_search.c). */
static thr_status search_again(thr_plan *plan, const thr_cord *before, int n_before, thr_err *err)
{
  bool changed = false;
  if (plan->options.crossings != THR_CROSSINGS_FORBID || plan->options.distinct > 0) return THR_OK;

  thr_status st = thr_channel_search(plan, before, n_before, &changed, err);
  return !st && changed ? measure(plan, err) : st;
}

/* Compares the passes over every edge. *others: some edge has more or fewer than before. */
static thr_status compare_passes(const thr_plan *plan, const thr_cord *before, int n_before,
                                 bool *others, thr_err *err)
{
  int *more = thr_calloc((size_t)plan->frame.n_edges, sizeof *more);
  if (!more) return thr_nomem(err);

  /* Subtract the passes before from those now: the same passes leave 0 everywhere. */
  thr_cords_add_passes(plan->cord, plan->n_cords, 1, more);
  thr_cords_add_passes(before, n_before, -1, more);
  *others = false;
  for (int e = 0; e < plan->frame.n_edges; e++)
    *others |= more[e] != 0;

  free(more);
  return THR_OK;
}

thr_status thr_plan_uncross(thr_plan *plan, bool *others, thr_err *err)
{
  int crossed = 0;
  const int n_before = plan->n_cords;
  const double length = plan->metrics.length;
  thr_cord *before = NULL;
  *others = false;
  if (plan->options.crossings == THR_CROSSINGS_ALLOW || plan->n_cords == 0) return THR_OK;

  /* Lead the channels otherwise, search where this leaves crossings, and compare the passes. */
  thr_status st = thr_cords_copy(plan->cord, n_before, &before, err);
  if (!st) st = uncross(plan, before, n_before, err);
  if (!st) st = search_again(plan, before, n_before, err);
  if (!st) st = compare_passes(plan, before, n_before, others, err);

  thr_cords_destroy(before, n_before);
  if (st) return st;

  if (!*others) plan->metrics.length = length; /* to the last bit */
  claim_longest(plan);
  st = count(plan, &crossed, err);
  return st ? st : refuse(plan, crossed, err);
}
