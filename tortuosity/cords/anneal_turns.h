/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulated annealing of turns and extra passes, for single cords. */
#ifndef THR_ANNEAL_TURNS_H
#define THR_ANNEAL_TURNS_H

#include "graph/scratch.h"
#include "tortuosity/cords/join.h"

#include <stdint.h>

/* ---- anneal_turns.c: Turns and extra passes changed together by simulated annealing (S.
 * Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983), for the least turning of single cords. */

/* Is it made for what is asked? Solid joints, one cord in every component, closed or open, turns
 * that cost, and at most 64 edges at a node. */
bool thr_anneal_turns_serves(const thr_turning_columns *columns);

/* cycles: of these columns (thr_short_cycles_find). x[n_columns], whole numbers that keep the
 * equations and hang together, is replaced if something cheaper is found: in so many steps of one
 * run with these random numbers, or when the limits stop it. again: x was found by such a run, and
 * the temperature begins so low that most of it stays. Cord ends stay at their nodes. A step is
 * O(length of a cycle * degree), and what it looks at to see whether all hangs together; memory
 * O(columns). */
thr_status thr_anneal_turns(const thr_turning_columns *columns, const thr_short_cycles *cycles,
                            bool again, int64_t steps, uint64_t seed, const thr_limits *limits,
                            int *x, bool *better, thr_err *err) THR_MUST_CHECK;

/* ---- anneal_turns_parts.c: What the annealing of turns is made of. */

/* Edges at a node at most; changes of columns that are tried together. */
enum { THR_TURN_DEGREE = 64, THR_TURN_CHANGES = 5 * THR_CYCLE_MOST + 8 };

typedef struct {
  const thr_turning_columns *c;
  thr_scratch own;
  int *x;             /* [n_columns] */
  uint64_t *partners; /* [2 * n_edges] of a half-edge: those of its node, by position, that it has
                         turns with */
  double *cost;       /* [n_columns] */
  int64_t spare;      /* extra length that is left, in units of c->length; INT64_MAX = no limit */
  int n_changes, change[THR_TURN_CHANGES][2]; /* column, by how much, in this order */
  double gain;                                /* what they cost */
  /* for thr_turn_parts */
  int *label, *queue; /* [n_edges] source that an edge was reached from, -1 = none */
} thr_turn_state;

thr_status thr_turn_state_init(thr_turn_state *state, const thr_turning_columns *columns,
                               const int *x, thr_err *err) THR_MUST_CHECK;
void thr_turn_state_destroy(thr_turn_state *state);

/* The partner -1 is a cord's end. */
static inline int thr_turn_state_column(const thr_turn_state *state, int a, int b)
{
  return a < 0   ? state->c->end_column[b]
         : b < 0 ? state->c->end_column[a]
                 : thr_turning_column(state->c, a, b);
}

void thr_turn_state_change(thr_turn_state *state, int column, int by);
void thr_turn_state_undo(thr_turn_state *state);

/* Into how many parts the edges of the turns that were changed fall. O(edges) at worst, few where
 * they hang together. */
int thr_turn_parts(thr_turn_state *state);

/* The same before the changes. */
int thr_turn_parts_before(thr_turn_state *state);

#endif
