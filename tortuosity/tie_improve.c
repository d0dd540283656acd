/* Local search over the passes of tied nodes. */
#include "tortuosity/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 4, MEMORY = 1 << 16 }; /* edges of a cycle; node prices remembered */

typedef struct {
  uint64_t name;
  double price;
} known;

typedef struct {
  const thr_turning_columns *c;
  thr_knot knot;
  int *passes;
  const int *ends;
  double *price;                       /* [n_nodes] of the turns there */
  double extra;                        /* length of the passes beyond the cover */
  known *memory;                       /* [MEMORY] by name; a later one takes the place of an earlier one */
  int n, edge[LONGEST], node[LONGEST]; /* the cycle at hand */
} tinker;

static void tinker_destroy(tinker *t)
{
  thr_knot_destroy(&t->knot);
  free(t->price);
  free(t->memory);
}

/* INFINITY: cannot be tied. */
static thr_status price_node(tinker *t, int v, double *price, thr_err *err)
{
  const thr_frame *f = t->c->f;
  uint64_t name = (uint64_t)v + 1;
  bool tied;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    name = (name ^ (uint64_t)t->passes[f->half[i] >> 1]) * UINT64_C(0x9e3779b97f4a7c15) + 1;
  known *k = &t->memory[name >> 48];
  if (k->name != name) {
    thr_status st = thr_knot_tie(&t->knot, v, t->passes, t->ends, &tied, err);
    if (st) return st;
    *k = (known){name, tied ? t->knot.turning : INFINITY};
  }
  *price = k->price;
  return THR_OK;
}

static thr_status tinker_init(tinker *t, const thr_turning_columns *c, int *passes, const int *ends, thr_err *err)
{
  const thr_frame *f = c->f;
  int most = 0;
  *t = (tinker){.c = c, .passes = passes, .ends = ends};
  for (int v = 0; v < f->n_nodes; v++) {
    int n = 2 + ends[v];
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      n += passes[f->half[i] >> 1];
    if (n > most) most = n;
  }
  for (int e = 0; e < f->n_edges; e++)
    t->extra += (passes[e] - c->cover[e]) * f->length[e];
  t->price = thr_calloc((size_t)f->n_nodes, sizeof *t->price);
  t->memory = thr_calloc(MEMORY, sizeof *t->memory);
  thr_status st = thr_knot_init(&t->knot, c, most, err);
  if (!st && (!t->price || !t->memory)) st = thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++)
    st = price_node(t, v, &t->price[v], err);
  return st;
}

/* One more pass, or one less, of each edge of the cycle as the bits of less say. */
static bool shift(tinker *t, unsigned less, int sign, double *longer)
{
  bool room = true;
  *longer = 0;
  for (int i = 0; i < t->n; i++) {
    int e = t->edge[i], by = less >> i & 1u ? -sign : sign;
    t->passes[e] += by;
    *longer += by * t->c->f->length[e];
    room &= t->passes[e] >= t->c->cover[e] && t->passes[e] <= t->c->most[e];
  }
  return room;
}

/* Keeps the shift if it saves. */
static thr_status try_shift(tinker *t, unsigned less, bool *saved, thr_err *err)
{
  const thr_turning_task *task = t->c->task;
  double longer, back, price[LONGEST] = {0}, change;
  thr_status st = THR_OK;
  bool room = shift(t, less, 1, &longer);
  room &= task->extra_limit < 0 || t->extra + longer <= task->extra_limit;
  change = room ? task->price_per_length * longer : INFINITY;
  for (int i = 0; i < t->n && !st && change < INFINITY; i++) {
    st = price_node(t, t->node[i], &price[i], err);
    change += st ? 0 : price[i] - t->price[t->node[i]];
  }
  if (st || change > -1e-9) {
    shift(t, less, -1, &back);
    return st;
  }
  for (int i = 0; i < t->n; i++)
    t->price[t->node[i]] = price[i];
  t->extra += longer;
  *saved = true;
  return THR_OK;
}

static thr_status try_cycle(tinker *t, bool *saved, thr_err *err)
{
  thr_status st = THR_OK;
  for (unsigned less = 0; less < 1u << t->n && !st; less++)
    st = try_shift(t, less, saved, err);
  return st;
}

/* Cycles of three or four edges through half-edge h and on over a, or the two passes of h's edge alone, which is a cycle of two.
 */
static thr_status try_from(tinker *t, int h, bool *saved, thr_err *err)
{
  const thr_frame *f = t->c->f;
  int u = thr_tail(f, h), v = thr_head(f, h);
  thr_status st = THR_OK;
  t->n = 2;
  t->edge[0] = t->edge[1] = h >> 1;
  t->node[0] = u;
  t->node[1] = v;
  st = try_shift(t, 0, saved, err);
  if (!st) st = try_shift(t, 3, saved, err);
  for (int i = f->first[v]; i < f->first[v + 1] && !st; i++) {
    int a = f->half[i], w = thr_head(f, a), e;
    if (w == u || w < u) continue; /* every cycle from its lowest node */
    t->edge[0] = h >> 1;
    t->edge[1] = a >> 1;
    t->node[2] = w;
    if ((e = thr_frame_edge_between(f, w, u)) >= 0) {
      t->n = 3;
      t->edge[2] = e;
      st = try_cycle(t, saved, err);
      continue;
    }
    for (int k = f->first[w]; k < f->first[w + 1] && !st; k++) {
      int b = f->half[k], x = thr_head(f, b);
      if (x == v || x <= u || (e = thr_frame_edge_between(f, x, u)) < 0) continue;
      t->n = 4;
      t->edge[2] = b >> 1;
      t->edge[3] = e;
      t->node[3] = x;
      st = try_cycle(t, saved, err);
    }
  }
  return st;
}

thr_status thr_tie_improve(const thr_turning_columns *c, const thr_limits *limits, int *passes, const int *ends, thr_err *err)
{
  const thr_frame *f = c->f;
  tinker t;
  bool saved = true;
  thr_status st = tinker_init(&t, c, passes, ends, err);
  while (saved && !st && !thr_limits_stop(limits)) {
    saved = false;
    for (int h = 0; h < 2 * f->n_edges && !st && !thr_limits_stop(limits); h++)
      if (thr_tail(f, h) < thr_head(f, h)) st = try_from(&t, h, &saved, err);
  }
  tinker_destroy(&t);
  return st;
}
