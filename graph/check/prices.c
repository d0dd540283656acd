/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges at their price. */
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

/* Price of the places that n passes of an edge are. */
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
  for (int i = 0; i < 2; i++) { /* costs are linear in pairs of passes */
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
} search;

/* Edges of the shortest way between the edge's nodes that is not the edge, up to most; most if
 * there is none. */
static int way_round(const thr_frame *frame, int e, int most, search *s)
{
  int n = 0, depth = 0, goal = frame->edge[e][1];
  s->queue[n++] = frame->edge[e][0];
  s->mark[frame->edge[e][0]] = e + 1;
  for (int at = 0, level = n; at < n && depth < most - 1; depth++, level = n)
    for (; at < level; at++)
      for (int i = frame->first[s->queue[at]]; i < frame->first[s->queue[at] + 1];
           i++, s->steps++) {
        int v = thr_head(frame, frame->half[i]);
        if (frame->half[i] >> 1 == e || s->mark[v] == e + 1) continue;
        if (v == goal) return depth + 1;
        s->mark[v] = e + 1;
        s->queue[n++] = v;
      }
  return most;
}

void thr_prices_loops(const thr_frame *frame, const int *edge, int n, int *work, int *loop)
{
  search s = {.mark = work, .queue = work + frame->n_nodes};
  for (int i = 0; i < n; i++)
    loop[i] = s.steps < MOST_STEPS ? 1 + way_round(frame, edge[i], LONGEST_LOOP - 1, &s) : 2;
}
