/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Joins closed cords to one where they cross, and cuts them again where no channel is crossed by
 * the cut (planner/planner_parts.h).
 *
 * A cut leads two channels of one cord at a node otherwise, such that the part between them
 * becomes a cord of its own. Among all cuts of the longest cord the most even one is taken.
 *
 * Example: a closed cord comes by node v after passes 3 and 8 by channels a-b and c-d. Led as a-d
 * and c-b the channels give two closed cords, of passes 4 .. 8 and of the rest. */
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_passes_reverse(int *half, int from, int last)
{
  for (; from <= last; from++, last--) {
    int one = half[from] ^ 1;
    half[from] = half[last] ^ 1;
    half[last] = one;
  }
}

/* ---- two become one ---- */

thr_status thr_cords_join(thr_plan *plan, const thr_channel *a, const thr_channel *b,
                          bool backwards, thr_err *err)
{
  thr_cord *first = &plan->cord[a->cord], *second = &plan->cord[b->cord],
           *last = &plan->cord[plan->n_cords - 1];
  const int n = first->n_passes, m = second->n_passes, before = a->pass + 1;
  int *half = thr_calloc((size_t)n + (size_t)m, sizeof *half);

  if (!half) return thr_nomem(err);

  /* First cord up to a, second cord once round, first cord from there on. */
  memcpy(half, first->half, (size_t)before * sizeof *half);
  for (int k = 0; k < m; k++) /* from the pass after b, round to b's own */
    half[before + k] = second->half[(b->pass + 1 + k) % m];
  if (backwards) thr_passes_reverse(half, before, before + m - 1);
  memcpy(half + before + m, first->half + before, (size_t)(n - before) * sizeof *half);

  /* The new cord replaces the first, and the last one fills the gap of the second. */
  free(first->half);
  first->half = half;
  first->n_passes = n + m;
  free(second->half);
  *second = *last;
  plan->n_cords--;
  return THR_OK;
}

/* ---- how many there are to be ---- */

static int component_of(const thr_recut *recut, const thr_plan *plan, int cord)
{
  return recut->component[thr_tail(&plan->frame, plan->cord[cord].half[0])];
}

thr_status thr_recut_count(thr_recut *recut, const thr_plan *plan, thr_err *err)
{
  /* Find the component of every node. */
  recut->n_cords = plan->n_cords;
  recut->component = thr_calloc((size_t)plan->frame.n_nodes, sizeof *recut->component);
  thr_status st = recut->component
                      ? thr_frame_components(&plan->frame, recut->component, &recut->n, err)
                      : thr_nomem(err);
  if (st) return st;

  /* Count the cords of each. */
  recut->cords = thr_calloc((size_t)recut->n, sizeof *recut->cords);
  if (!recut->cords) return thr_nomem(err);
  for (int c = 0; c < plan->n_cords; c++)
    recut->cords[component_of(recut, plan, c)]++;
  return THR_OK;
}

void thr_recut_destroy(thr_recut *recut)
{
  free(recut->component);
  free(recut->cords);
  *recut = (thr_recut){0};
}

/* ---- one becomes two ---- */

/* A cord that leaves out what it does between two visits of a node, which becomes a cord of its
 * own. */
typedef struct {
  int cord, from, to; /* the part's passes: from .. to - 1; cord < 0: none */
  double longer;      /* length of the longer part */
} cut;

/* Of cord c, whose first k passes are upto[k] long, at one node: is there a better one? */
static void try_node(const thr_recut *recut, const thr_channel *channel, int n, int c,
                     const double *upto, double whole, bool back, cut *best)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < j; i++) {
      const thr_channel *a = &channel[i], *b = &channel[j];

      if (a->cord != c || b->cord != c) continue;
      double part = upto[b->pass + 1] - upto[a->pass + 1], longer = fmax(part, whole - part);
      if (best->cord >= 0 && longer >= best->longer) continue;

      /* Led otherwise, the two channels may cross neither each other nor any other one. */
      thr_channel one = {.in = a->in, .out = b->out}, other = {.in = b->in, .out = a->out};
      bool free_of = (back || (one.in != one.out && other.in != other.out)) &&
                     !thr_channels_cross(recut->rank, &one, &other);

      for (int k = 0; k < n && free_of; k++)
        free_of = k == i || k == j ||
                  (!thr_channels_cross(recut->rank, &one, &channel[k]) &&
                   !thr_channels_cross(recut->rank, &other, &channel[k]));
      if (free_of) *best = (cut){c, a->pass + 1, b->pass + 1, longer};
    }
}

/* Finds the best cut of cord c over all nodes of its component; back: channels may turn back. */
static thr_status find_cut(const thr_recut *recut, const thr_plan *plan,
                           const thr_channels *channels, int c, bool back, cut *best, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_cord *cord = &plan->cord[c];
  double *upto = thr_calloc((size_t)cord->n_passes + 1, sizeof *upto);
  if (!upto) return thr_nomem(err);

  /* Sum up the lengths, and try every node. */
  for (int k = 0; k < cord->n_passes; k++)
    upto[k + 1] = upto[k] + frame->length[cord->half[k] >> 1];
  for (int v = 0; v < frame->n_nodes; v++)
    if (recut->component[v] == component_of(recut, plan, c))
      try_node(recut, channels->channel + channels->first[v],
               channels->first[v + 1] - channels->first[v], c, upto, upto[cord->n_passes], back,
               best);

  free(upto);
  return THR_OK;
}

/* Makes a cut: the part becomes the last cord of the plan. */
static thr_status make_cut(thr_plan *plan, const cut *chosen, thr_err *err)
{
  thr_cord *cord = &plan->cord[chosen->cord], *part = &plan->cord[plan->n_cords];

  const int n = chosen->to - chosen->from;
  int *half = thr_calloc((size_t)n, sizeof *half);
  if (!half) return thr_nomem(err);

  memcpy(half, cord->half + chosen->from, (size_t)n * sizeof *half);
  memmove(cord->half + chosen->from, cord->half + chosen->to,
          (size_t)(cord->n_passes - chosen->to) * sizeof *half);
  cord->n_passes -= n;

  *part = (thr_cord){.half = half, .n_passes = n, .closed = true, .component = cord->component};
  plan->n_cords++;
  return THR_OK;
}

/* Returns the longest cord of a component that is not seen yet; -1: there is none. */
static int longest_left(const thr_recut *recut, const thr_plan *plan, int component,
                        const bool *seen)
{
  int longest = -1;
  double length = -1;
  for (int c = 0; c < plan->n_cords; c++) {
    if (seen[c] || component_of(recut, plan, c) != component) continue;

    double own = thr_cord_length(&plan->frame, &plan->cord[c]);
    if (own <= length) continue;
    longest = c;
    length = own;
  }
  return longest;
}

/* Cuts the longest cord of a component that can be cut. *done: one was. */
static thr_status cut_one(const thr_recut *recut, thr_plan *plan, int component, bool back,
                          bool *done, thr_err *err)
{
  cut best = {.cord = -1};
  thr_channels channels;
  bool *seen = thr_calloc((size_t)plan->n_cords, sizeof *seen);
  if (!seen) return thr_nomem(err);

  /* Try the cords by length, until one can be cut. */
  thr_status st = thr_channels_make(&channels, plan, err);
  for (int c; !st && best.cord < 0 && (c = longest_left(recut, plan, component, seen)) >= 0;
       seen[c] = true)
    st = find_cut(recut, plan, &channels, c, back, &best, err);

  thr_channels_destroy(&channels);
  free(seen);
  *done = best.cord >= 0;
  return !st && *done ? make_cut(plan, &best, err) : st;
}

/* Adds a closed cord over the shortest edge of the component that has room for two passes more, to
 * and fro: its channels turn back, and cross nothing. passes[n_edges] by all cords. */
static thr_status add_loop(const thr_recut *recut, thr_plan *plan, int component, int *passes,
                           bool *done, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  int best = -1;

  /* Look for the shortest edge with room for two passes more. */
  for (int e = 0; e < frame->n_edges; e++) {
    if (recut->component[thr_tail(frame, 2 * e)] != component) continue;
    if (thr_plan_capacity(frame, &plan->options, e) - passes[e] < 2) continue;
    if (best < 0 || frame->length[e] < frame->length[best]) best = e;
  }

  *done = best >= 0;
  if (!*done) return THR_OK;

  int *half = thr_calloc(2, sizeof *half);
  if (!half) return thr_nomem(err);
  half[0] = 2 * best;
  half[1] = 2 * best + 1;
  plan->cord[plan->n_cords++] =
      (thr_cord){.half = half, .n_passes = 2, .closed = true, .component = component};
  passes[best] += 2;
  return THR_OK;
}

/* Adds as many loops as cords are missing, as long as edges have room. */
static thr_status add_loops(const thr_recut *recut, thr_plan *plan, int component, int missing,
                            thr_err *err)
{
  int *passes = thr_calloc((size_t)plan->frame.n_edges, sizeof *passes);

  thr_status st = passes ? THR_OK : thr_nomem(err);
  if (!st) thr_cords_add_passes(plan->cord, plan->n_cords, 1, passes);
  for (bool done = true; missing > 0 && done && !st; missing -= done)
    st = add_loop(recut, plan, component, passes, &done, err);

  free(passes);
  return st;
}

thr_status thr_recut_cords(const thr_recut *recut, thr_plan *plan, thr_err *err)
{
  thr_status st = THR_OK;
  if (plan->n_cords == recut->n_cords) return st;
  for (int k = 0; k < recut->n; k++) {
    /* Count the cords that are missing in the component. */
    int missing = recut->cords[k];
    for (int c = 0; c < plan->n_cords; c++)
      missing -= component_of(recut, plan, c) == k;

    /* Cuts that turn back into an edge come last: they cross nothing, and only plans without
     * crossings need them. */
    for (int back = 0; back <= (plan->options.crossings == THR_CROSSINGS_FORBID); back++)
      for (bool done = true; missing > 0 && done && !st; missing -= done)
        st = cut_one(recut, plan, k, back, &done, err);

    if (!st && missing > 0 && plan->options.crossings == THR_CROSSINGS_FORBID)
      st = add_loops(recut, plan, k, missing, err);
  }

  for (int c = 0; c < plan->n_cords; c++)
    thr_cord_id(c, plan->cord[c].id);
  return st;
}
