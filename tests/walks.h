/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least that cords of a small piece can cost, by exhaustive search over walks: the oracle of
 * tests that cross options. It shares no code with the program. A state is what the cords so far
 * have done: passes of every edge (more than are needed count only where there is a limit), for
 * tube joints which edges of every node their turns tie together, how many different cords passed
 * every edge, and the ends at nodes where their number is given. A cord is a walk from state to
 * state; passes are not limited otherwise, so the least is that of all plans. */
#ifndef THR_TEST_WALKS_H
#define THR_TEST_WALKS_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "tests/support.h"

enum { WALKS_EDGES = 8, WALKS_NODES = 9, WALKS_DEGREE = 5 };

/* Where a cord may turn back into its edge. */
typedef enum { BACK_ANYWHERE, BACK_AT_LEAVES, BACK_NEVER } walks_back;

/* One piece of a framework with what is asked of its cords. Half-edges are numbered as in
 * thr_frame, within the piece. */
typedef struct {
  int n_nodes, n_edges;
  int node[WALKS_NODES], edge[WALKS_EDGES]; /* in the framework */
  int half_tail[2 * WALKS_EDGES], slot[2 * WALKS_EDGES],
      degree[WALKS_NODES]; /* slot: of a half-edge among those of its tail */
  double length[WALKS_EDGES];
  double price[2 * WALKS_EDGES][2 * WALKS_EDGES]; /* of turning from one half-edge into another,
                                                     INFINITY where none may */
  int least[WALKS_EDGES], most[WALKS_EDGES];      /* passes; INT_MAX: no limit */
  bool closed, tube, may_end[WALKS_NODES];
  int ends[WALKS_NODES]; /* exactly so many; -1: not counted */
  int distinct;          /* different cords over every edge; 0: any */
  /* digits of a state */
  int top[WALKS_EDGES]; /* passes are counted up to this; beyond, they are as many (no limit) or too
                           many */
  long stride[WALKS_EDGES], end_stride[WALKS_NODES], tie_stride[WALKS_NODES], n_states;
  long cords_stride[WALKS_EDGES],
      here_stride[WALKS_EDGES]; /* cords that passed an edge; does the one that walks? */
} walks_piece;

/* Piece number k of the framework, its turns priced as by cost. count_all: passes are counted up to
 * those of a plan no longer than that (INFINITY: only as needed). False if it is too large for this
 * oracle, with most_states states at most. */
bool walks_piece_init(walks_piece *w, const thr_frame *f, const thr_request *o, int k,
                      walks_back back, thr_turn_cost cost, double count_all, long most_states);

/* What is minimized: w_length * length + w_turn * price of turns. */
typedef struct {
  double length, turn;
  double longest; /* 0, or none of the cords costs more, each taken by itself: as many searches as
                     there are states */
} walks_weights;

/* cost[n_states]: of no cord at all. */
void walks_begin(const walks_piece *w, double *cost);

/* out[s]: least cost of one cord more than those that cost in[s]. limit < 0: costs add up; else
 * each cord costs at most limit, and out is 0 or INFINITY. in and out are different. */
void walks_one_more(const walks_piece *w, walks_weights weights, double limit, const double *in,
                    double *out);

/* Are all edges covered, all nodes tied and all ends used? */
bool walks_complete(const walks_piece *w, long state);
double walks_length(const walks_piece *w, long state); /* of the passes counted */

/* Least of the complete states; INFINITY: none. */
double walks_least(const walks_piece *w, const double *cost);

/* Of just so many cords through a framework of one piece; they turn back anywhere, or where turning
 * counts at leaves. */
double walks_least_of(const thr_frame *f, const thr_request *o, int cords, walks_weights weights);

/* What the turn from half-edge in to out of the framework costs, as docs/plan-format.md has it. */
double walks_price(const thr_frame *f, thr_turn_cost cost, int in, int out);

/* May a cord end at v, and the passes that e needs and takes (INT_MAX: any), read off the options.
 */
bool walks_may_end(const thr_frame *f, const thr_request *o, int v);
int walks_cover(const thr_frame *f, const thr_request *o, int e);
int walks_capacity(const thr_frame *f, const thr_request *o, int e);

#endif
