/* What a matching of passes leaves apart, and what it costs to join it. */
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/proof/connect.h"

#include <stdlib.h>

int thr_connect_parts(const thr_turning_columns *turning_columns, const int *x, int *part)
{
  const thr_turning_columns *c = turning_columns;
  int m = c->f->n_edges;
  for (int e = 0; e < m; e++)
    part[e] = e;
  for (int j = 0; j < c->first_extra; j++)
    if (x[j] > 0) thr_disjoint_join(part, c->half[j][0] >> 1, c->half[j][1] >> 1);
  return thr_disjoint_number(part, m, part);
}

/* An exchange of two turns that joins two parts. */
typedef struct {
  int64_t cost;
  int a, b;
} exchange;

typedef struct {
  const thr_turning_columns *c;
  const int *part;
  int n, room;
  exchange *list;
} exchanges;

/* Turns (a b)(d e) as (a d)(b e) or (a e)(b d), whichever is cheaper. */
static int64_t exchange_cost(const thr_turning_columns *c, int i, int k)
{
  const int *one = c->half[i], *two = c->half[k];
  int64_t now = c->weight[i] + c->weight[k];
  int64_t straight = c->weight[thr_turning_column(c, one[0], two[0])] + c->weight[thr_turning_column(c, one[1], two[1])],
          crossed = c->weight[thr_turning_column(c, one[0], two[1])] + c->weight[thr_turning_column(c, one[1], two[0])];
  return (straight < crossed ? straight : crossed) - now;
}

static thr_status list_node(exchanges *s, int v, const int *x, int *used, thr_err *err)
{
  int d = thr_degree(s->c->f, v), first = s->c->pair_first[v], n = 0;
  for (int j = first; j < first + d * (d - 1) / 2; j++)
    if (x[j] > 0) used[n++] = j;
  for (int i = 0; i < n; i++)
    for (int k = i + 1; k < n; k++) {
      int a = s->part[s->c->half[used[i]][0] >> 1], b = s->part[s->c->half[used[k]][0] >> 1];
      if (a == b) continue; /* parts that differ share no edge, so no exchange turns back */
      thr_status st = thr_grow(&s->list, s->n, &s->room, sizeof *s->list, err);
      if (st) return st;
      s->list[s->n++] = (exchange){exchange_cost(s->c, used[i], used[k]), a, b};
    }
  return THR_OK;
}

static int by_cost(const void *a, const void *b)
{
  const exchange *one = a, *two = b;
  if (one->cost != two->cost) return one->cost < two->cost ? -1 : 1;
  return one->a != two->a ? one->a - two->a : one->b - two->b;
}

/* Merges along the sorted exchanges; tells of the parts before the first of each cost. */
static thr_status merge(const exchanges *s, int n, int *parent, int *number, int *now, thr_connect_partition *tell, void *user,
                        thr_err *err)
{
  const int64_t same = INT64_C(1) << 24; /* 1e-6 of a radian */
  int left = n;
  int64_t told = INT64_MIN;
  for (int i = 0; i < s->n && left > 1; i++) {
    if (thr_disjoint_find(parent, s->list[i].a) == thr_disjoint_find(parent, s->list[i].b)) continue;
    if (s->list[i].cost > told + same || told == INT64_MIN) {
      int parts = thr_disjoint_number(parent, n, number);
      for (int e = 0; e < s->c->f->n_edges; e++)
        now[e] = number[s->part[e]];
      told = s->list[i].cost;
      thr_status st = tell(user, now, parts, err);
      if (st) return st;
    }
    left -= thr_disjoint_join(parent, s->list[i].a, s->list[i].b);
  }
  return THR_OK;
}

thr_status thr_connect_chain(const thr_turning_columns *turning_columns, const int *x, const int *part, int n,
                             thr_connect_partition *tell, void *user, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  thr_scratch own = {0};
  exchanges s = {.c = turning_columns, .part = part};
  int *used = thr_scratch_array(&own, (size_t)turning_columns->first_extra, sizeof *used),
      *parent = thr_scratch_array(&own, (size_t)n, sizeof *parent), *number = thr_scratch_array(&own, (size_t)n, sizeof *number),
      *now = thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *now);
  thr_status st = thr_scratch_check(&own, err);
  for (int v = 0; v < frame->n_nodes && !st; v++)
    st = list_node(&s, v, x, used, err);
  for (int i = 0; i < n && !st; i++)
    parent[i] = i;
  if (!st && s.n) qsort(s.list, (size_t)s.n, sizeof *s.list, by_cost);
  if (!st) st = merge(&s, n, parent, number, now, tell, user, err);
  free(s.list);
  thr_scratch_free(&own);
  return st;
}
