/* What the annealing of turns is made of. Internal to tortuosity/cords/anneal_turns*.c. */
#ifndef THR_ANNEAL_TURNS_PARTS_H
#define THR_ANNEAL_TURNS_PARTS_H

#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/cords/short_cycles.h"

#include <stdint.h>

/* Edges at a node at most; changes of columns that are tried together. */
enum { THR_TURN_DEGREE = 64, THR_TURN_CHANGES = 5 * THR_CYCLE_MOST + 8 };

typedef struct {
  const thr_turning_columns *c;
  thr_scratch own;
  int *x;             /* [n_columns] */
  uint64_t *partners; /* [2 * n_edges] of a half-edge: those of its node, by position, that it has turns with */
  double *cost;       /* [n_columns] */
  int64_t spare;      /* extra length that is left, in units of c->length; INT64_MAX = no limit */
  int n_changes, change[THR_TURN_CHANGES][2]; /* column, by how much, in this order */
  double gain;                                /* what they cost */
  /* for thr_turn_parts */
  int *label, *queue; /* [n_edges] source that an edge was reached from, -1 = none */
} thr_turn_state;

thr_status thr_turn_state_init(thr_turn_state *state, const thr_turning_columns *columns, const int *x,
                               thr_err *err) THR_MUST_CHECK;
void thr_turn_state_destroy(thr_turn_state *state);

/* The partner -1 is a cord's end. */
static inline int thr_turn_state_column(const thr_turn_state *state, int a, int b)
{
  return a < 0 ? state->c->end_column[b] : b < 0 ? state->c->end_column[a] : thr_turning_column(state->c, a, b);
}

void thr_turn_state_change(thr_turn_state *state, int column, int by);
void thr_turn_state_undo(thr_turn_state *state);

/* Into how many parts the edges of the turns that were changed fall. O(edges) at worst, few where they hang together. */
int thr_turn_parts(thr_turn_state *state);

/* The same before the changes. */
int thr_turn_parts_before(thr_turn_state *state);

#endif
