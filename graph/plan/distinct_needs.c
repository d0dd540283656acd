/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how many passes edges need where several different cords are to pass each of them.
 *
 * A bridge parts its component in two. A cord that passes the bridge an odd number of times has an
 * end on either side; every other cord that passes the bridge does so at least twice. So N
 * different cords, of which at most k have an end on either side, make 2 N - k passes if k is below
 * N; closed cords make 2 N.
 *
 * Example: the tail of a kite, two different closed cords: four passes. */
#include "graph/plan/request.h"

#include <stdlib.h>

/* Returns how many cord ends there may be at a node; where ends are not counted, as many as all
 * cords of a component have. */
static long ends_at(const thr_frame *frame, const thr_request *options, int v)
{
  if (options->ends == THR_ENDS_CLOSED) return 0;
  if (options->ends == THR_ENDS_COUNTS) return options->end_count[v];
  return thr_plan_end_allowed(frame, options, v) ? 2L * options->cords : 0;
}

/* Makes a spanning tree of every component, breadth first: order[n_nodes] lists the nodes,
 * via[n_nodes] the half-edge over which each one was reached (-1: a root). */
static void span(const thr_frame *frame, int *order, int *via, bool *reached)
{
  int n = 0, done = 0;

  for (int root = 0; root < frame->n_nodes; root++) {
    if (reached[root]) continue;
    reached[root] = true;
    via[root] = -1;

    /* Nodes that have been reached wait in `order` for their neighbours. */
    for (order[n++] = root; done < n; done++)
      for (int v = order[done], i = frame->first[v]; i < frame->first[v + 1]; i++) {
        int w = thr_head(frame, frame->half[i]);
        if (reached[w]) continue;
        reached[w] = true;
        via[w] = frame->half[i];
        order[n++] = w;
      }
  }
}

/* Sums up, in below[n_nodes], the ends in the subtree of each node. Nodes come after their parents
 * in order, so the sums are complete when they are passed on. */
static void sum_below(const thr_frame *frame, const int *order, const int *via, long *below)
{
  for (int i = frame->n_nodes - 1; i > 0; i--)
    if (via[order[i]] >= 0) below[thr_tail(frame, via[order[i]])] += below[order[i]];
}

/* Raises needs[n_edges] of bridges. *more becomes whether any was raised. */
static thr_status raise_bridges(const thr_frame *frame, const thr_request *options, int *needs,
                                bool *more, thr_err *err)
{
  const size_t n = (size_t)frame->n_nodes;
  thr_scratch own = {0};
  int *order = thr_scratch_array(&own, n, sizeof *order),
      *via = thr_scratch_array(&own, n, sizeof *via);
  bool *reached = thr_scratch_array(&own, n, sizeof *reached),
       *bridge = thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *bridge);
  long *below = thr_scratch_array(&own, n, sizeof *below),
       *all = thr_scratch_array(&own, n, sizeof *all);

  thr_status st = thr_scratch_check(&own, err);
  *more = false;

  /* A bridge is an edge of every spanning tree, so its subtree is one of the two sides. */
  if (!st) st = thr_frame_bridges(frame, bridge, err);
  if (!st) span(frame, order, via, reached);

  for (int v = 0; v < frame->n_nodes && !st; v++)
    below[v] = ends_at(frame, options, v);

  if (!st) sum_below(frame, order, via, below);

  /* all[v]: the ends of the whole component, handed down from the root. */
  for (int i = 0; i < frame->n_nodes && !st; i++) {
    const int v = order[i], e = via[v] >> 1, distinct = options->distinct;
    all[v] = via[v] < 0 ? below[v] : all[thr_tail(frame, via[v])];
    if (via[v] < 0 || !bridge[e]) continue;

    /* Cords with ends on both sides: no more than there are ends on the side with fewer. */
    const long other = all[v] - below[v], once = below[v] < other ? below[v] : other;
    const int least = once < distinct ? 2 * distinct - (int)once : distinct;
    if (least <= needs[e]) continue;
    needs[e] = least;
    *more = true;
  }

  thr_scratch_free(&own);
  return st;
}

/* Starts from the covers, and raises the bridges. */
thr_status thr_distinct_needs(const thr_frame *frame, const thr_request *options, int **needs,
                              thr_err *err)
{
  bool more = false;
  *needs = NULL;

  /* The proof of length of symmetric plans is about any cords. */
  if (thr_wants_symmetry(options)) return THR_OK;
  int *found = thr_calloc((size_t)frame->n_edges, sizeof *found);
  if (!found) return thr_nomem(err);

  /* At least the cover; without bridges to raise, there is nothing to say. */
  for (int e = 0; e < frame->n_edges; e++)
    found[e] = thr_plan_cover(frame, options, e);

  thr_status st = raise_bridges(frame, options, found, &more, err);
  if (!st && more)
    *needs = found;
  else
    free(found);

  return st;
}
