/* The passes of a plan as a multigraph: one copy of an edge per pass, plus a virtual edge between each two cord ends, so
 * that every degree is even and a threading is a set of closed circuits. */
#ifndef THR_MULTIGRAPH_H
#define THR_MULTIGRAPH_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* Copy c has two darts, 2c and 2c + 1, one leaving each of its nodes; dart ^ 1 is the other. half[d] is the framework's
 * half-edge that dart d runs along, or -1 for a virtual edge. */
typedef struct {
  int n_darts, n_nodes;
  int *half;  /* [n_darts] */
  int *tail;  /* [n_darts] node that the dart leaves */
  int *first; /* [n_nodes + 1] darts leaving v: dart[first[v] .. first[v + 1] - 1] */
  int *dart;  /* [n_darts] ascending within a node */
} thr_multigraph;

/* passes[e] copies of each edge (0 leaves an edge out), and n_ends virtual edges between end[i][0] and end[i][1], which may also
 * be one of n_more nodes that have numbers from the framework's number of nodes on. O(n + darts). Release with
 * thr_multigraph_destroy. */
thr_status thr_multigraph_init(thr_multigraph *multigraph, const thr_frame *frame, int n_more, const int *passes,
                               const int (*end)[2], int n_ends, thr_err *err) THR_MUST_CHECK;
void thr_multigraph_destroy(thr_multigraph *multigraph);

/* Pairs a and b in an array in which every member names its mate. */
static inline void thr_set_pair(int *mate, int a, int b)
{
  mate[a] = b;
  mate[b] = a;
}

#endif
