/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the annealing of turns is made of. Internal to tortuosity/cords/anneal_turns*.c. */
#include "graph/disjoint.h"
#include "graph/framework/frame.h"
#include "tortuosity/cords/anneal_turns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half-edges a and b of a node turn into each other, or do so no longer. */
static void toggle(thr_turn_state *s, int a, int b)
{
  s->partners[a] ^= UINT64_C(1) << s->c->position[b];
  s->partners[b] ^= UINT64_C(1) << s->c->position[a];
}

thr_status thr_turn_state_init(thr_turn_state *s, const thr_turning_columns *c, const int *x,
                               thr_err *err)
{
  const size_t n = (size_t)c->n_columns, m = (size_t)c->f->n_edges;
  *s = (thr_turn_state){.c = c, .spare = c->extra_limit < 0 ? INT64_MAX : c->extra_limit};
  s->x = thr_scratch_array(&s->own, n, sizeof *s->x);
  s->cost = thr_scratch_array(&s->own, n, sizeof *s->cost);
  s->partners = thr_scratch_array(&s->own, 2 * m, sizeof *s->partners);
  s->label = thr_scratch_array(&s->own, m, sizeof *s->label);
  s->queue = thr_scratch_array(&s->own, m, sizeof *s->queue);
  thr_status st = thr_scratch_check(&s->own, err);
  if (st) return st;
  memcpy(s->x, x, n * sizeof *x);
  for (int j = 0; j < c->n_columns; j++)
    s->cost[j] = ldexp((double)c->weight[j], -THR_TURNING_BITS);
  for (int j = 0; j < c->first_extra; j++)
    if (x[j] > 0) toggle(s, c->half[j][0], c->half[j][1]);
  for (int e = 0; e < c->f->n_edges; e++) {
    s->label[e] = -1;
    if (c->extra_limit >= 0) s->spare -= x[c->first_extra + e] * c->length[e];
  }
  return THR_OK;
}

void thr_turn_state_destroy(thr_turn_state *s)
{
  thr_scratch_free(&s->own);
}

static void add(thr_turn_state *s, int column, int by)
{
  const thr_turning_columns *c = s->c;
  const bool before = s->x[column] > 0;
  s->x[column] += by;
  if (column < c->first_extra && before != (s->x[column] > 0))
    toggle(s, c->half[column][0], c->half[column][1]);
  if (c->extra_limit >= 0 && column >= c->first_extra && column < c->first_end)
    s->spare -= by * c->length[column - c->first_extra];
}

void thr_turn_state_change(thr_turn_state *s, int column, int by)
{
  s->change[s->n_changes][0] = column;
  s->change[s->n_changes++][1] = by;
  s->gain += by * s->cost[column];
  add(s, column, by);
}

void thr_turn_state_undo(thr_turn_state *s)
{
  while (s->n_changes > 0) {
    const int *change = s->change[--s->n_changes];
    add(s, change[0], -change[1]);
  }
  s->gain = 0;
}

/* ---- what hangs together ---- */

enum { SOURCES = 2 * THR_TURN_CHANGES };

typedef struct {
  thr_turn_state *s;
  int n, tail;                           /* edges that were begun with; in the queue */
  int parent[SOURCES], waiting[SOURCES]; /* sets of those; edges of each set in the queue whose
                                            neighbours are not looked at */
  int parts, live;                       /* sets; those with such edges */
} flood;

static void reach(flood *f, int e, int source)
{
  f->s->label[e] = source;
  f->s->queue[f->tail++] = e;
  f->waiting[source]++;
}

static void begin(flood *f, int half)
{
  if (half < 0 || f->s->label[half >> 1] >= 0) return;
  f->parent[f->n] = f->n;
  f->waiting[f->n] = 0;
  reach(f, half >> 1, f->n++);
}

static void meet(flood *f, int a, int b)
{
  const int waiting = f->waiting[a = thr_disjoint_find(f->parent, a)],
            other = f->waiting[b = thr_disjoint_find(f->parent, b)];
  if (a == b) return;
  thr_disjoint_join(f->parent, a, b);
  f->waiting[a < b ? a : b] = waiting + other;
  f->live -= waiting > 0 && other > 0;
  f->parts--;
}

/* The edges that edge e turns into at the node that its half-edge h leaves. */
static void spread(flood *f, int e, int h)
{
  const thr_frame *frame = f->s->c->f;
  const int *half = frame->half + frame->first[thr_tail(frame, h)];
  for (uint64_t left = f->s->partners[h]; left; left &= left - 1) {
    const int w = half[__builtin_ctzll(left)] >> 1;
    if (f->s->label[w] < 0)
      reach(f, w, thr_disjoint_find(f->parent, f->s->label[e]));
    else
      meet(f, f->s->label[e], f->s->label[w]);
  }
}

/* Floods spread from all edges at once; over when they have met, or when only one goes on. */
int thr_turn_parts(thr_turn_state *s)
{
  flood f = {.s = s};
  for (int i = 0; i < s->n_changes; i++) {
    const int j = s->change[i][0];
    if (j >= s->c->first_extra) continue;
    begin(&f, s->c->half[j][0]);
    begin(&f, s->c->half[j][1]);
  }
  f.parts = f.live = f.n;
  for (int head = 0; head < f.tail && f.parts > 1 && f.live > 1; head++) {
    const int e = s->queue[head];
    spread(&f, e, 2 * e);
    spread(&f, e, 2 * e + 1);
    f.live -= --f.waiting[thr_disjoint_find(f.parent, s->label[e])] == 0;
  }
  for (int i = 0; i < f.tail; i++)
    s->label[s->queue[i]] = -1;
  return f.n ? f.parts : 1;
}

int thr_turn_parts_before(thr_turn_state *s)
{
  for (int i = 0; i < s->n_changes; i++)
    add(s, s->change[i][0], -s->change[i][1]);
  const int parts = thr_turn_parts(s);
  for (int i = 0; i < s->n_changes; i++)
    add(s, s->change[i][0], s->change[i][1]);
  return parts;
}
