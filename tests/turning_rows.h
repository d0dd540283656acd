/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The columns and rows of the turning bound by their definition, an oracle that shares no code with
 * the program: what multipliers prove for an integer programme, added up row by row in integers
 * that do not overflow. */
#ifndef THR_TURNING_ROWS_H
#define THR_TURNING_ROWS_H

#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"

__extension__ typedef __int128 wide;

enum { MOST = 2000, MOST_NODES = 16, MOST_EDGES = 40 };

typedef enum { TURN, EXTRA, END, BACK } column_kind;

typedef struct {
  column_kind kind;
  int a, b; /* half-edges; b = -1 of an end */
  int64_t weight;
  int most, node;
} column;

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  bool end_allowed[MOST_NODES];
  int end_count[MOST_NODES];
  int component[MOST_NODES], n_components;
  thr_turning_columns columns;
  column column[MOST]; /* in the order of columns */
  int low[MOST], high[MOST];
} model;

/* Names every column by definition, and compares it with the one of that name. */
void rows_fill(model *m);

int rows_cover(const model *m, int e);                /* passes that edge e needs */
int rows_supply(const model *m, int k, bool largest); /* ends of group k: least or largest number */

/* What the multipliers prove of plans whose columns lie in low .. high, times 2^40: the limit on
 * the length has multipliers of that. Of the cords of one component, or of all (piece < 0): in one,
 * rows that are in several have the right side 0, and the limit on the length is as it is. O(rows *
 * columns). */
wide rows_bound(const model *m, const thr_turning_dual *d, const int *low, const int *high,
                int piece);

#endif
