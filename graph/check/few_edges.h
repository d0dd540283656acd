/* The least of several cords through a component of few edges, without a proof: all sets of edges are tried. Private to the
 * checker.
 *
 *   one[S]: least cost of a cord that passes at least the edges S. States are (set passed so far, half-edge passed last); sets
 * only grow, so they are settled in ascending order, each by Dijkstra's method. n cords: one of them passes the lowest edge, so
 * best_n[S] = min over T in S with that edge of one[T] + best_(n-1)[S - T], or of the larger of the two. M. Held & R. M. Karp
 * 1962, with walks. All covers count as 1, and nothing else that couples cords is asked: lower bounds then.
 *
 * Example: a ring of four unit edges, two open cords, ends anywhere: 4 together, the longer one 2. */
#ifndef THR_FEW_EDGES_H
#define THR_FEW_EDGES_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"

enum { THR_FEW_EDGES = 12, THR_FEW_SETS = 1 << 15 /* of all components together */ };

typedef struct {
  int n;       /* edges; 0: more than few */
  double *one; /* [2^n] owned */
} thr_few_edges;

/* Of a component (component[n_nodes] as of thr_frame_components). By the price of turns, without U-turns but at nodes with one
 * edge (with tube joints none at all), or by length, with any (tube joints: none). O(2^n n^2), for closed cords 2^n n^3. */
thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame, const thr_request *options, const int *component,
                              int number, bool turning, thr_err *err) THR_MUST_CHECK;
void thr_few_edges_destroy(thr_few_edges *few);

/* Least cost of least .. most cords through the component, each passing something, whichever number has the least: of the
 * dearest, or in all. INFINITY: there are none. O(3^n * n). */
thr_status thr_few_edges_least(const thr_few_edges *few, int least, int most, bool dearest, double *cost,
                               thr_err *err) THR_MUST_CHECK;

/* The same for the components of a framework, as many cords in each as the options allow. *sum: in all, 0 if there are too many
 * edges; *dearest: of the dearest cord in any component of few edges. Components that may have one cord only, and those for which
 * the sets of the ones before leave no room (THR_FEW_SETS), count as large. */
thr_status thr_few_edges_bounds(const thr_frame *frame, const thr_request *options, bool turning, double *sum, double *dearest,
                                thr_err *err) THR_MUST_CHECK;

#endif
