/* Short walks that make one more cord: without U-turns but at nodes with one edge. Internal to tortuosity/. */
#ifndef THR_WALK_SEARCH_H
#define THR_WALK_SEARCH_H

#include "graph/plan/turning_proof.h"
#include "graph/status.h"

typedef struct {
  const thr_turning_columns *c;
  int *by, *stamp, *queue; /* [2 * n_edges] search over half-edges */
  double *length;          /* [2 * n_edges] */
  int searches, head, n_queued;
  int *half, n; /* [2 * n_edges] the walk found last; n = 0: there is none */
} thr_walk_search;

thr_status thr_walk_search_init(thr_walk_search *walk_search, const thr_turning_columns *turning_columns,
                                thr_err *err) THR_MUST_CHECK;
void thr_walk_search_destroy(thr_walk_search *walk_search);

/* A closed walk of fewest edges through half-edge h. O(sum of the squares of the degrees). */
void thr_walk_search_closed(thr_walk_search *walk_search, int h);

/* The shortest walk of a component between nodes where cords may end, or back to the same one, over edges with less than
 * most_passes; with them its passes can be paired without U-turns if these could. It may turn back where other passes take its
 * own up. O(edges * sum of the squares of the degrees) at worst. */
void thr_walk_search_open(thr_walk_search *walk_search, int component, const int *passes);

/* Adds the walk found last to passes[n_edges], if that leaves none above most_passes; says whether. */
bool thr_walk_search_add(const thr_walk_search *walk_search, int *passes);

#endif
