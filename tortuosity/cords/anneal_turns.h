/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulated annealing of turns and extra passes, for the least turning of single cords. Read join.h
 * first, then anneal_turns.c (the proposals and the run), then anneal_turns_parts.c (the state,
 * changes that can be undone, and connected parts). */
#ifndef THR_ANNEAL_TURNS_H
#define THR_ANNEAL_TURNS_H

#include "graph/arrays.h"
#include "tortuosity/cords/join.h"

#include <stdint.h>

/* ---- anneal_turns.c: Turns and extra passes changed together by simulated annealing (S.
 * Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983), for the least turning of single cords. */

/* Returns whether the annealing can serve the columns' task: solid joints, one cord in every
 * component, closed or open, turns that cost, and at most 64 edges at a node. */
bool thr_anneal_turns_serves(const thr_turning_columns *columns);

/* Anneals x[n_columns], whole numbers that keep the equations and are connected, in one run of so
 * many steps, or until the limits stop the run; x is replaced, and *better set, if a cheaper
 * connected state is found. cycles: those of the columns (thr_short_cycles_find). again: x was
 * found by such a run, and the temperature begins so low that most of x stays. seed: of the random
 * numbers. Cord ends stay at their nodes. A step takes O(length of a cycle * degree^2) and the
 * search for parts that are not connected; memory O(columns). */
thr_status thr_anneal_turns(const thr_turning_columns *columns, const thr_short_cycles *cycles,
                            bool again, int64_t steps, uint64_t seed, const thr_limits *limits,
                            int *x, bool *better, thr_err *err) THR_MUST_CHECK;

/* ---- anneal_turns_parts.c: What the annealing of turns is made of. */

/* Largest number of edges at a node, and of changes of columns that are proposed together. */
enum { THR_TURN_DEGREE = 64, THR_TURN_CHANGES = 5 * THR_CYCLE_MOST + 8 };

/* Whole numbers for all columns, and the changes that the current proposal has made to them. */
typedef struct {
  const thr_turning_columns *c;
  thr_scratch own;
  int *x;             /* [n_columns] */
  uint64_t *partners; /* [2 * n_edges] of a half-edge: bits of the positions, at its node, of the
                         half-edges that it has turns with */
  double *cost;       /* [n_columns] */
  int64_t spare;      /* extra length that is left, in units of c->length; INT64_MAX = no limit */
  int n_changes, change[THR_TURN_CHANGES][2]; /* column, by how much, in this order */
  double gain;                                /* price that the changes add */

  /* Scratch of thr_turn_parts. */
  int *label, *queue; /* [n_edges] source that an edge was reached from, -1 = none */
} thr_turn_state;

/* Starts with x[n_columns], which is copied, and without changes. On failure state is to be
 * destroyed too. */
thr_status thr_turn_state_init(thr_turn_state *state, const thr_turning_columns *columns,
                               const int *x, thr_err *err) THR_MUST_CHECK;
void thr_turn_state_destroy(thr_turn_state *state);

/* Returns the column of the turn between half-edges a and b of one node, or of the end at one of
 * them if the other one is -1. */
static inline int thr_turn_state_column(const thr_turn_state *state, int a, int b)
{
  return a < 0   ? state->c->end_column[b]
         : b < 0 ? state->c->end_column[a]
                 : thr_turning_column(state->c, a, b);
}

/* Adds `by` to a column and notes the change. */
void thr_turn_state_change(thr_turn_state *state, int column, int by);

/* Takes all noted changes back. */
void thr_turn_state_undo(thr_turn_state *state);

/* Returns the number of connected parts that hold an edge of a turn that was changed; 1 if there is
 * none. O(edges) at worst, few where the edges are connected nearby. */
int thr_turn_parts(thr_turn_state *state);

/* Returns the same number as it was before the changes. */
int thr_turn_parts_before(thr_turn_state *state);

#endif
