/* Short walks that make one more cord: without U-turns but at nodes with one edge. Internal to tortuosity/. */
#ifndef THR_WALKS_H
#define THR_WALKS_H

#include "graph/plan/turning_proof.h"

typedef struct {
  const thr_turning_columns *c;
  int *by, *stamp, *queue; /* [2 * n_edges] search over half-edges */
  double *length;          /* [2 * n_edges] */
  int searches, head, n_queued;
  int *half, n; /* [2 * n_edges] the walk found last; n = 0: there is none */
} thr_walks;

thr_status thr_walks_init(thr_walks *w, const thr_turning_columns *c, thr_err *err) THR_MUST_CHECK;
void thr_walks_destroy(thr_walks *w);

/* A closed walk of fewest edges through half-edge h. O(sum of the squares of the degrees). */
void thr_walks_closed(thr_walks *w, int h);

/* The shortest walk of a component between nodes where cords may end, or back to the same one, over edges with less than
 * most_passes; with them its passes can be paired without U-turns if these could. It may turn back where other passes take its
 * own up. O(edges * sum of the squares of the degrees) at worst. */
void thr_walks_open(thr_walks *w, int component, const int *passes);

/* Adds the walk found last to passes[n_edges], if that leaves none above most_passes; says whether. */
bool thr_walks_add(const thr_walks *w, int *passes);

#endif
