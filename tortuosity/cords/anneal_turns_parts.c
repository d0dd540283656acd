/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the state that the annealing of turns changes: the numbers of turns, extra passes and ends,
 * with changes that can be undone, and the number of connected parts. Internal to
 * tortuosity/cords/anneal_turns*.c.
 *
 * Two edges are connected if they turn into each other. A change can separate only edges of the
 * turns that it changes, hence the parts are counted by breadth-first searches from these edges
 * alone, which advance in turns and end as soon as all have met, or all but one have nothing left
 * to visit. Where the edges are connected nearby, as they nearly always are, few edges are visited.
 *
 * Example: turns (a b)(c d) become (a c)(b d). The searches from a and c meet at once, as do those
 * from b and d; if b and c turn into one edge e further on, all have met there: one part. */
#include "tortuosity/cords/several.h"

#include <math.h>
#include <string.h>

/* Notes that half-edges a and b of one node turn into each other from now on, or no longer. */
static void toggle(thr_turn_state *state, int a, int b)
{
  state->partners[a] ^= UINT64_C(1) << state->c->position[b];
  state->partners[b] ^= UINT64_C(1) << state->c->position[a];
}

thr_status thr_turn_state_init(thr_turn_state *state, const thr_turning_columns *columns,
                               const int *x, thr_err *err)
{
  const size_t n = (size_t)columns->n_columns, m = (size_t)columns->f->n_edges;
  *state = (thr_turn_state){.c = columns,
                            .spare = columns->extra_limit < 0 ? INT64_MAX : columns->extra_limit};
  state->x = thr_scratch_array(&state->own, n, sizeof *state->x);
  state->cost = thr_scratch_array(&state->own, n, sizeof *state->cost);
  state->partners = thr_scratch_array(&state->own, 2 * m, sizeof *state->partners);
  state->label = thr_scratch_array(&state->own, m, sizeof *state->label);
  state->queue = thr_scratch_array(&state->own, m, sizeof *state->queue);
  thr_status st = thr_scratch_check(&state->own, err);
  if (st) return st;

  /* The columns, with their prices as the proof counts them. */
  memcpy(state->x, x, n * sizeof *x);
  for (int j = 0; j < columns->n_columns; j++)
    state->cost[j] = ldexp((double)columns->weight[j], -THR_TURNING_BITS);

  /* Which half-edges turn into each other, and the extra length that the limit leaves. */
  for (int j = 0; j < columns->first_extra; j++)
    if (x[j] > 0) toggle(state, columns->half[j][0], columns->half[j][1]);
  for (int e = 0; e < columns->f->n_edges; e++) {
    state->label[e] = -1;
    if (columns->extra_limit >= 0) state->spare -= x[columns->first_extra + e] * columns->length[e];
  }
  return THR_OK;
}

void thr_turn_state_destroy(thr_turn_state *state)
{
  thr_scratch_free(&state->own);
}

/* Adds `by` to a column, and updates the partners or the extra length that depend on the column. */
static void add(thr_turn_state *state, int column, int by)
{
  const thr_turning_columns *columns = state->c;
  const bool before = state->x[column] > 0;
  state->x[column] += by;

  /* Partners change only with the first turn of a pair of half-edges, or with the last. */
  if (column < columns->first_extra && before != (state->x[column] > 0))
    toggle(state, columns->half[column][0], columns->half[column][1]);
  if (columns->extra_limit >= 0 && column >= columns->first_extra && column < columns->first_end)
    state->spare -= by * columns->length[column - columns->first_extra];
}

void thr_turn_state_change(thr_turn_state *state, int column, int by)
{
  state->change[state->n_changes][0] = column;
  state->change[state->n_changes++][1] = by;
  state->gain += by * state->cost[column];
  add(state, column, by);
}

void thr_turn_state_undo(thr_turn_state *state)
{
  while (state->n_changes > 0) {
    const int *change = state->change[--state->n_changes];
    add(state, change[0], -change[1]);
  }
  state->gain = 0;
}

/* ---- connected parts ---- */

enum { SOURCES = 2 * THR_TURN_CHANGES };

/* Breadth-first searches from several source edges, in one queue. Sources whose searches have met
 * are one set. */
typedef struct {
  thr_turn_state *state;
  int n, tail;          /* sources; edges in the queue */
  int parent[SOURCES];  /* disjoint sets of the sources */
  int waiting[SOURCES]; /* of each set's root: edges in the queue that are not expanded yet */
  int parts, live;      /* sets; sets with edges that are not expanded yet */
} flood;

/* Labels edge e with the source that reached it, and appends the edge to the queue. */
static void reach(flood *search, int e, int source)
{
  search->state->label[e] = source;
  search->state->queue[search->tail++] = e;
  search->waiting[source]++;
}

/* Makes the edge of a half-edge a source, unless the half-edge is -1 or the edge is one already. */
static void begin(flood *search, int half)
{
  if (half < 0 || search->state->label[half >> 1] >= 0) return;

  search->parent[search->n] = search->n;
  search->waiting[search->n] = 0;
  reach(search, half >> 1, search->n++);
}

/* Joins the sets of sources a and b. */
static void meet(flood *search, int a, int b)
{
  const int waiting = search->waiting[a = thr_disjoint_find(search->parent, a)],
            other = search->waiting[b = thr_disjoint_find(search->parent, b)];
  if (a == b) return;

  thr_disjoint_join(search->parent, a, b);

  /* The lower root stays, and gets the unexpanded edges of both. */
  search->waiting[a < b ? a : b] = waiting + other;
  search->live -= waiting > 0 && other > 0;
  search->parts--;
}

/* Visits the edges that edge e turns into at the node which the edge's half-edge h leaves. */
static void spread(flood *search, int e, int h)
{
  const thr_frame *frame = search->state->c->f;
  const int *half = frame->half + frame->first[thr_tail(frame, h)];

  /* Each partner: an edge that is new, or one that some search has reached. */
  for (uint64_t left = search->state->partners[h]; left; left &= left - 1) {
    const int other = half[__builtin_ctzll(left)] >> 1;
    if (search->state->label[other] < 0)
      reach(search, other, thr_disjoint_find(search->parent, search->state->label[e]));
    else
      meet(search, search->state->label[e], search->state->label[other]);
  }
}

int thr_turn_parts(thr_turn_state *state)
{
  /* Sources: the edges of all turns that have changed. */
  flood search = {.state = state};
  for (int i = 0; i < state->n_changes; i++) {
    const int j = state->change[i][0];
    if (j >= state->c->first_extra) continue; /* no turn */

    begin(&search, state->c->half[j][0]);
    begin(&search, state->c->half[j][1]);
  }

  /* Expand edges until all searches have met, or only one can go on: nobody is left to meet. */
  search.parts = search.live = search.n;
  for (int head = 0; head < search.tail && search.parts > 1 && search.live > 1; head++) {
    const int e = state->queue[head];
    spread(&search, e, 2 * e);
    spread(&search, e, 2 * e + 1);
    search.live -= --search.waiting[thr_disjoint_find(search.parent, state->label[e])] == 0;
  }

  /* Leave no labels behind. */
  for (int i = 0; i < search.tail; i++)
    state->label[state->queue[i]] = -1;
  return search.n ? search.parts : 1;
}

int thr_turn_parts_before(thr_turn_state *state)
{
  for (int i = 0; i < state->n_changes; i++)
    add(state, state->change[i][0], -state->change[i][1]);
  const int parts = thr_turn_parts(state);

  /* Make the changes again. */
  for (int i = 0; i < state->n_changes; i++)
    add(state, state->change[i][0], state->change[i][1]);
  return parts;
}
