/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Euler tours: a multigraph of passes, pairings at its nodes, and tours that keep to a pairing.
 * This is the first header of the room to read; threading.h builds on it. multigraph.c comes first,
 * then pairing.c for one node and tour.c for one cord. */
#ifndef THR_EULER_H
#define THR_EULER_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* ---- multigraph.c: The passes of a plan as a multigraph: one copy of an edge per pass, plus a
 * virtual edge between each two cord ends, so that every degree is even and a threading is a set of
 * closed circuits. */

/* Copy c has two darts, 2c and 2c + 1, one leaving each of its nodes; dart ^ 1 is the other.
 * half[d] is the framework's half-edge that dart d runs along, or -1 for a virtual edge. */
typedef struct {
  int n_darts, n_nodes;
  int *half;  /* [n_darts] */
  int *tail;  /* [n_darts] node that the dart leaves */
  int *first; /* [n_nodes + 1] darts leaving v: dart[first[v] .. first[v + 1] - 1] */
  int *dart;  /* [n_darts] ascending within a node */
} thr_multigraph;

/* passes[e] copies of each edge (0 leaves an edge out), and n_ends virtual edges between end[i][0]
 * and end[i][1], which may also be one of n_more nodes that have numbers from the framework's
 * number of nodes on. O(n + darts). Release with thr_multigraph_destroy. */
thr_status thr_multigraph_init(thr_multigraph *multigraph, const thr_frame *frame, int n_more,
                               const int *passes, const int (*end)[2], int n_ends,
                               thr_err *err) THR_MUST_CHECK;
void thr_multigraph_destroy(thr_multigraph *multigraph);

/* Pairs a and b in an array in which every member names its mate. */
static inline void thr_set_pair(int *mate, int a, int b)
{
  mate[a] = b;
  mate[b] = a;
}

/* ---- pairing.c: Pairing the passes at one node: minimum-weight perfect matching of n points under
 * any prices. */

enum { THR_PAIRING_EXACT = 16 }; /* largest n that thr_pairing_best solves exactly */

/* price[i * n + j] = price[j * n + i] of pairing i with j. mate[n] receives the pairs; n must be
 * even (THR_EINPUT). n <= THR_PAIRING_EXACT: least total price, by dynamic programming over
 * subsets, O(2^n n). More: first with last half, then exchanges of two pairs until none saves. */
thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err) THR_MUST_CHECK;

/* ---- tour.c: From edge multiplicities and ends to one cord, through the walk that
 * graph/threading/walks.c traces. */

/* The cord of a framework of one component; passes[e] >= 1 for every edge. ends are its two end
 * nodes: different nodes = open from the first to the second; both v = closed at v; both -1 =
 * closed, starting at an end node that the options allow (a foot rather than another) where the
 * turn that closing leaves out is sharpest. The half array of cord is allocated for the caller,
 * none on failure. THR_EINPUT if passes and ends leave a node with an odd number of both.
 * Near-linear in passes. */
thr_status thr_tour_cord(const thr_frame *frame, const thr_request *options, const int *passes,
                         const int ends[2], thr_cord *cord, thr_err *err) THR_MUST_CHECK;

/* The pass from which the closed circuit half[0 .. n-1] had best start as a cord, as above; options
 * NULL: at any node, the first of its sharpest turns. */
int thr_tour_start(const thr_frame *frame, const thr_request *options, const int *half, int n);

#endif
