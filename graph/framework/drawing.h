/* Drawing of graphs by igraph. */
#ifndef THR_DRAWING_H
#define THR_DRAWING_H

#include "graph/status.h"

/* Kamada & Kawai 1989: nodes as springs, whose lengths are the shortest ways along the edges. Graph with n nodes and m undirected
 * edges of length > 0; xy[n] is where the search starts, unless it is to start from a circle, and receives where it ends. No
 * randomness. O(n m log n), then O(n) for each of at most 50 n steps; n^2 numbers of memory. THR_ESOLVER if igraph fails. */
thr_status thr_kamada_kawai(int n, int m, const int (*edge)[2], const double *length, bool circle, double (*xy)[2],
                            thr_err *err) THR_MUST_CHECK;

#endif
