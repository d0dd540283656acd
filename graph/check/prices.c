/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what extra passes over an edge cost less the price of the places that they add.
 *
 * A certificate may give prices to places for cords (graph/plan/plan_measures.h, "Prices of
 * places"): without enough passes there is no room for as many cords as are asked for. Less the
 * price of its places an odd number of extra passes may cost less than an even one. For closed
 * cords a pass counts by the length of the shortest loop over its edge, as a circuit over the edge
 * has no fewer edges.
 *
 * Example: weight 5, places 3 at either node: one extra pass costs 5 - 6 = -1, none costs 0. */
#include "graph/framework/frame.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"

#include <limits.h>

enum { LONGEST_LOOP = 10, MOST_STEPS = 1 << 24 };

int thr_prices_number(const thr_request *options, int n_nodes)
{
  if (thr_wants_symmetry(options)) return 0;
  return options->ends == THR_ENDS_COUNTS ? n_nodes : 1;
}

/* Returns the price of the places that n passes of an edge are. */
static thr_wide price_of(const thr_request *options, thr_wide of, int loop, int n)
{
  if (options->ends != THR_ENDS_CLOSED) return of * n;
  return 2 * of * (n / 2) + (n % 2 ? (2 * of + loop - 1) / loop : 0);
}

thr_priced thr_prices_edge(const thr_frame *frame, const thr_request *options, int e,
                           thr_wide weight, thr_wide of, int loop)
{
  int cover = thr_plan_cover(frame, options, e), most = thr_plan_capacity(frame, options, e);
  thr_priced priced = {.held = price_of(options, of, loop, cover),
                       .room = most > cover,
                       .endless = of > weight && most == INT_MAX};

  /* The cheapest even and the cheapest odd number of extra passes: costs are linear in pairs, so
   * either the fewest or the most. */
  for (int i = 0; i < 2; i++) {
    int n = i;
    if (of > weight && most > cover && most < INT_MAX) n = most - cover - ((most - cover) % 2 != i);
    thr_wide cost = n > 0 ? weight * n - (price_of(options, of, loop, cover + n) - priced.held) : 0;

    priced.passes[i] = n;
    *(i ? &priced.odd : &priced.even) = cost;
  }
  return priced;
}

/* Searches from one node, cut off at a depth. */
typedef struct {
  int *mark, *queue; /* [n_nodes] number of the edge whose search reached a node last, plus 1; those
                        reached */
  int steps;
} loop_search;

/* Returns the number of edges of the shortest path between the edge's nodes that avoids the edge,
 * at most `most`; `most` if there is none. Breadth-first search. */
static int way_round(const thr_frame *frame, int e, int most, loop_search *search)
{
  int n = 0, depth = 0, goal = frame->edge[e][1];

  search->queue[n++] = frame->edge[e][0];
  search->mark[frame->edge[e][0]] = e + 1;

  /* Level by level. */
  for (int at = 0, level = n; at < n && depth < most - 1; depth++, level = n)
    for (; at < level; at++)
      for (int i = frame->first[search->queue[at]]; i < frame->first[search->queue[at] + 1];
           i++, search->steps++) {
        int v = thr_head(frame, frame->half[i]);
        if (frame->half[i] >> 1 == e || search->mark[v] == e + 1) continue;

        if (v == goal) return depth + 1;
        search->mark[v] = e + 1;
        search->queue[n++] = v;
      }

  return most;
}

void thr_prices_loops(const thr_frame *frame, const int *edge, int n, int *work, int *loop)
{
  loop_search search = {.mark = work, .queue = work + frame->n_nodes};

  /* After MOST_STEPS steps loops count as the shortest possible. */
  for (int i = 0; i < n; i++)
    loop[i] =
        search.steps < MOST_STEPS ? 1 + way_round(frame, edge[i], LONGEST_LOOP - 1, &search) : 2;
}
