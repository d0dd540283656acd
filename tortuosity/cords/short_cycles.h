/* Shortest paths by number of edges, and the short cycles that they close. Internal to tortuosity/.
 *
 * Example: through two sides of a triangle of a mesh that meet there is one cycle of three edges. */
#ifndef THR_SHORT_CYCLES_H
#define THR_SHORT_CYCLES_H

#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"

/* Breadth-first searches, one after the other. */
typedef struct {
  const thr_frame *f;
  int *by, *seen, *queue; /* [n_nodes] half-edge that reached a node; search that did; nodes in order */
  int search;
} thr_path_finder;

/* The arrays are taken from own, whose owner asks whether they are there. */
void thr_path_finder_init(thr_path_finder *finder, const thr_frame *frame, thr_scratch *own);

/* The half-edges, half[most], of a shortest path from a node to another that keeps off a node and an edge (-1: none); returns
 * their number, 0: there is none of so many. O(what is that near). */
int thr_path_find(thr_path_finder *finder, int from, int to, int off_node, int off_edge, int most, int *half);

/* Short cycles: half-edges half[first[i]] .. half[first[i + 1] - 1], each leaving the node at which the one before arrives. */
typedef struct {
  int n, *first, *half; /* owned */
} thr_short_cycles;

/* Through every turn between two edges a shortest cycle, where it has at most THR_CYCLE_MOST edges: the faces of a mesh, and
 * what surrounds two of them. O(turns * what is that near). */
enum { THR_CYCLE_MOST = 8 };
thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *columns, thr_err *err) THR_MUST_CHECK;
void thr_short_cycles_destroy(thr_short_cycles *cycles);

#endif
