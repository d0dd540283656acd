/* Edges at their price. */
#include "graph/framework/frame.h"
#include "graph/plan/prices.h"
#include "graph/plan/request.h"

#include <limits.h>

enum { LONGEST_LOOP = 10, MOST_STEPS = 1 << 24 };

int thr_prices_number(const thr_plan_options *o, int n_nodes)
{
  if (thr_wants_symmetry(o)) return 0;
  return o->ends == THR_ENDS_COUNTS ? n_nodes : 1;
}

/* Price of the places that n passes of an edge are. */
static thr_wide price_of(const thr_plan_options *o, thr_wide of, int loop, int n)
{
  if (o->ends != THR_ENDS_CLOSED) return of * n;
  return 2 * of * (n / 2) + (n % 2 ? (2 * of + loop - 1) / loop : 0);
}

thr_priced thr_prices_edge(const thr_frame *f, const thr_plan_options *o, int e, thr_wide weight, thr_wide of, int loop)
{
  int cover = thr_plan_cover(f, o, e), most = thr_plan_capacity(f, o, e);
  thr_priced p = {.held = price_of(o, of, loop, cover), .room = most > cover, .endless = of > weight && most == INT_MAX};
  for (int i = 0; i < 2; i++) { /* costs are linear in pairs of passes */
    int n = i;
    if (of > weight && most > cover && most < INT_MAX) n = most - cover - ((most - cover) % 2 != i);
    thr_wide cost = n > 0 ? weight * n - (price_of(o, of, loop, cover + n) - p.held) : 0;
    p.passes[i] = n;
    *(i ? &p.odd : &p.even) = cost;
  }
  return p;
}

/* Searches from one node, cut off at a depth. */
typedef struct {
  int *mark, *queue; /* [n_nodes] number of the edge whose search reached a node last, plus 1; those reached */
  int steps;
} search;

/* Edges of the shortest way between the edge's nodes that is not the edge, up to most; most if there is none. */
static int way_round(const thr_frame *f, int e, int most, search *s)
{
  int n = 0, depth = 0, goal = f->edge[e][1];
  s->queue[n++] = f->edge[e][0];
  s->mark[f->edge[e][0]] = e + 1;
  for (int at = 0, level = n; at < n && depth < most - 1; depth++, level = n)
    for (; at < level; at++)
      for (int i = f->first[s->queue[at]]; i < f->first[s->queue[at] + 1]; i++, s->steps++) {
        int v = thr_head(f, f->half[i]);
        if (f->half[i] >> 1 == e || s->mark[v] == e + 1) continue;
        if (v == goal) return depth + 1;
        s->mark[v] = e + 1;
        s->queue[n++] = v;
      }
  return most;
}

void thr_prices_loops(const thr_frame *f, const int *edge, int n, int *work, int *loop)
{
  search s = {.mark = work, .queue = work + f->n_nodes};
  for (int i = 0; i < n; i++)
    loop[i] = s.steps < MOST_STEPS ? 1 + way_round(f, edge[i], LONGEST_LOOP - 1, &s) : 2;
}
