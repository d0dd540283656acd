/* Nodes with very many passes: matching over near pairs, and the cheapest exchanges between near pairs. */
#include "tortuosity/proof/hubs.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "graph/threading/multigraph.h"
#include "lp/matching/blossom.h"
#include "tortuosity/proof/nearest.h"

#include <math.h>
#include <stdlib.h>

enum { NEAREST = 8, END_CHOICES = 16, ROUNDS = 8 };

/* The darts of a node, sorted by half-edge; cord ends after all half-edges. */
typedef struct {
  const thr_join *j;
  const int *dart; /* [n] */
  int n, degree;
  thr_nearest near;
  int *sorted; /* [n] darts by half-edge */
  int *first; /* [degree + 2] those of half-edge i: sorted[first[i]] .. sorted[first[i + 1] - 1]; of the ends: first[degree] .. */
} hub;

static void hub_destroy(hub *h)
{
  thr_nearest_destroy(&h->near);
  free(h->sorted);
  free(h->first);
}

static int place_of(const hub *h, int i)
{
  int half = h->j->g.half[h->dart[i]];
  return half < 0 ? h->degree : h->j->c->position[half];
}

static thr_status hub_init(hub *h, const thr_join *j, int v, thr_err *err)
{
  const thr_multigraph *multigraph = &j->g;
  *h = (hub){.j = j,
             .dart = multigraph->dart + multigraph->first[v],
             .n = multigraph->first[v + 1] - multigraph->first[v],
             .degree = thr_degree(j->c->f, v)};
  h->sorted = thr_calloc((size_t)h->n, sizeof *h->sorted);
  h->first = thr_calloc((size_t)h->degree + 3, sizeof *h->first);
  if (!h->sorted || !h->first) return thr_nomem(err);
  for (int i = 0; i < h->n; i++)
    h->first[place_of(h, i) + 2]++;
  for (int i = 1; i <= h->degree + 1; i++)
    h->first[i + 1] += h->first[i];
  for (int i = 0; i < h->n; i++)
    h->sorted[h->first[place_of(h, i) + 1]++] = i;
  return thr_nearest_find(j->c, v, j->c->weight, NEAREST, &h->near, err);
}

static double price(const hub *h, int a, int b)
{
  return thr_join_price(h->j, h->dart[a], h->dart[b]);
}

/* ---- matching ---- */

/* Weights in units of 2^-40, so that very many add up in 64 bits; what is forbidden costs more than any turn. */
typedef struct {
  int n, capacity, weights;
  int (*edge)[2];
  int64_t *weight;
} near_pairs;

static thr_status add_pair(const hub *h, near_pairs *p, int a, int b, thr_err *err)
{
  enum { BITS = 40, FORBIDDEN = 64 };
  thr_status st = thr_grow(&p->edge, p->n, &p->capacity, sizeof *p->edge, err);
  if (!st) st = thr_grow(&p->weight, p->n, &p->weights, sizeof *p->weight, err);
  if (st) return st;
  p->edge[p->n][0] = a;
  p->edge[p->n][1] = b;
  p->weight[p->n++] = (int64_t)ldexp(fmin(price(h, a, b), FORBIDDEN), BITS);
  return THR_OK;
}

/* Passes of one edge are alike: of many, number k of the one half-edge meets numbers k - 1 to k + 1 of the other. */
static thr_status add_passes(const hub *h, near_pairs *p, int i, int q, thr_err *err)
{
  thr_status st = THR_OK;
  for (int a = h->first[i]; a < h->first[i + 1] && !st; a++)
    for (int b = h->first[q]; b < h->first[q + 1] && !st; b++)
      if (abs((a - h->first[i]) - (b - h->first[q])) <= 1) st = add_pair(h, p, h->sorted[a], h->sorted[b], err);
  return st;
}

/* Every cord end with some of the darts, another lot for every end; each dart with the one half of all further on. */
static thr_status add_spread(const hub *h, near_pairs *p, thr_err *err)
{
  thr_status st = THR_OK;
  int passes = h->first[h->degree], ends = h->n - passes,
      step = passes > ends * END_CHOICES ? passes / (ends * END_CHOICES + 1) : 1;
  for (int i = 0; i < h->n / 2 && !st; i++)
    st = add_pair(h, p, h->sorted[i], h->sorted[i + h->n / 2], err);
  for (int e = 0; e < ends && passes > 0; e++)
    for (int k = 0; k < END_CHOICES && !st; k++)
      st = add_pair(h, p, h->sorted[passes + e], h->sorted[(int)((int64_t)(e * END_CHOICES + k) * (step + 1) % passes)], err);
  return st;
}

static thr_status find_pairs(const hub *h, near_pairs *p, thr_err *err)
{
  thr_status st = add_spread(h, p, err);
  for (int i = 0; i < h->degree && !st; i++)
    for (int k = 0; k < h->near.n && !st; k++)
      st = add_passes(h, p, i, h->near.partner[i * h->near.n + k], err);
  return st;
}

typedef struct {
  int64_t weight;
  int a, b;
} ranked;

static int by_weight(const void *pa, const void *pb)
{
  const ranked *x = pa, *y = pb;
  if (x->weight != y->weight) return x->weight < y->weight ? -1 : 1;
  return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
}

/* What is left over, as it comes; and pairs that must not be are exchanged with the first that allows it. */
static void pair_left_over(const hub *h, int *pair)
{
  for (int k = 0, last = -1; k < h->n; k++) {
    int a = h->sorted[k];
    if (pair[a] >= 0) continue;
    if (last >= 0) thr_set_pair(pair, a, last);
    last = last >= 0 ? -1 : a;
  }
  for (int a = 0; a < h->n; a++)
    for (int c = 0; c < h->n && price(h, a, pair[a]) >= thr_join_forbidden; c++) {
      int b = pair[a], d = pair[c];
      if (c == a || c == b || price(h, a, c) >= thr_join_forbidden || price(h, b, d) >= thr_join_forbidden) continue;
      thr_set_pair(pair, a, c);
      thr_set_pair(pair, b, d);
    }
}

/* The cheapest first, as long as both darts are free. */
static thr_status pair_greedily(const hub *h, const near_pairs *p, int *pair, thr_err *err)
{
  ranked *list = thr_calloc((size_t)p->n, sizeof *list);
  if (!list) return thr_nomem(err);
  for (int k = 0; k < p->n; k++)
    list[k] = (ranked){p->weight[k], p->edge[k][0], p->edge[k][1]};
  qsort(list, (size_t)p->n, sizeof *list, by_weight);
  for (int i = 0; i < h->n; i++)
    pair[i] = -1;
  for (int k = 0; k < p->n; k++)
    if (pair[list[k].a] < 0 && pair[list[k].b] < 0) thr_set_pair(pair, list[k].a, list[k].b);
  free(list);
  pair_left_over(h, pair);
  return THR_OK;
}

thr_status thr_hub_pair(const thr_join *j, int v, const thr_limits *limits, int *pair, thr_err *err)
{
  hub h;
  near_pairs p = {0};
  thr_matching matching = {0};
  thr_err stopped = {0};
  thr_status st = hub_init(&h, j, v, err), found = THR_ELIMIT;
  if (!st) st = find_pairs(&h, &p, err);
  if (!st && !thr_limits_stop(limits)) {
    thr_matching_problem problem = {h.n, p.n, (const int(*)[2])p.edge, p.weight};
    found = thr_matching_solve(&problem, limits, &matching, &stopped);
    if (found && found != THR_ELIMIT) st = thr_fail(err, found, "%s", stopped.text);
  }
  for (int i = 0; i < h.n && !st && !found; i++)
    pair[i] = matching.mate[i];
  if (!st && found) st = pair_greedily(&h, &p, pair, err);
  thr_matching_destroy(&matching);
  free(p.edge);
  free(p.weight);
  hub_destroy(&h);
  return st;
}

/* ---- joining parts ---- */

/* Darts a and b are paired, and so are their partners of before. */
typedef struct {
  double extra;
  int a, b;
} swap;

static int by_extra(const void *pa, const void *pb)
{
  const swap *x = pa, *y = pb;
  if (x->extra != y->extra) return x->extra < y->extra ? -1 : 1;
  return x->a != y->a ? (x->a > y->a) - (x->a < y->a) : (x->b > y->b) - (x->b < y->b);
}

static double extra_of(const hub *h, const int *pair, int a, int b)
{
  return price(h, a, b) + price(h, pair[a], pair[b]) - price(h, a, pair[a]) - price(h, b, pair[b]);
}

static bool apply(int *part, int *pair, int a, int b)
{
  if (pair[a] == b || !thr_disjoint_join(part, a, b)) return false;
  int c = pair[a], d = pair[b];
  thr_set_pair(pair, a, b);
  thr_set_pair(pair, c, d);
  return true;
}

/* Exchanges that join parts, between a dart and the darts of its near half-edges. */
static int list_swaps(const hub *h, int *part, const int *pair, swap *list)
{
  int n = 0;
  for (int i = 0; i < h->degree; i++)
    for (int a = h->first[i]; a < h->first[i + 1]; a++)
      for (int k = 0; k < h->near.n; k++) {
        int q = h->near.partner[i * h->near.n + k], x = h->sorted[a];
        int count = h->first[q + 1] - h->first[q];
        if (count == 0) continue;
        int y = h->sorted[h->first[q] + (a - h->first[i]) % count];
        if (thr_disjoint_find(part, x) != thr_disjoint_find(part, y)) list[n++] = (swap){extra_of(h, pair, x, y), x, y};
      }
  return n;
}

/* One sweep of them, cheapest first. One that others before it have made dearer waits for the next sweep. */
static int sweep(const hub *h, int most, int parts, int *part, int *pair, swap *list)
{
  int n = list_swaps(h, part, pair, list);
  qsort(list, (size_t)n, sizeof *list, by_extra);
  for (int i = 0; i < n && parts > most; i++) {
    double now = extra_of(h, pair, list[i].a, list[i].b);
    if (now <= list[i].extra + 1e-9 && now < thr_join_forbidden / 2) parts -= apply(part, pair, list[i].a, list[i].b);
  }
  return parts;
}

/* What near pairs do not join: every part with that of the first dart, over the first pair that may be exchanged. */
static int join_rest(const hub *h, int most, int parts, int *part, int *pair)
{
  for (int i = 1; i < h->n && parts > most; i++)
    for (int k = 0; k < h->n && thr_disjoint_find(part, i) != thr_disjoint_find(part, 0); k++) {
      bool joins = thr_disjoint_find(part, k) == thr_disjoint_find(part, 0);
      if (joins && extra_of(h, pair, i, k) < thr_join_forbidden / 2) parts -= apply(part, pair, i, k);
    }
  return parts;
}

thr_status thr_hub_join(const thr_join *j, int v, int most, int *part, int *pair, thr_err *err)
{
  hub h;
  int parts = 0;
  thr_status st = hub_init(&h, j, v, err);
  swap *list = st ? NULL : thr_calloc((size_t)h.n * NEAREST, sizeof *list);
  if (!st && !list) st = thr_nomem(err);
  for (int i = 0; i < h.n && !st; i++)
    thr_disjoint_join(part, i, pair[i]);
  for (int i = 0; i < h.n && !st; i++)
    parts += thr_disjoint_find(part, i) == i;
  for (int round = 0; round < ROUNDS && parts > most && !st; round++)
    parts = sweep(&h, most, parts, part, pair, list);
  if (!st) join_rest(&h, most, parts, part, pair);
  free(list);
  hub_destroy(&h);
  return st;
}
