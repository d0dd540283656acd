/* Gomory-Hu cut tree (Gomory & Hu 1961), by igraph. */
#ifndef THR_CUTTREE_H
#define THR_CUTTREE_H

#include "graph/status.h"

/* Graph with n nodes and m undirected edges of capacity >= 0; it should be connected. tree[0 .. n-2] receives the tree's
 * edges and flow[0 .. n-2] the minimum cut that each stands for: removing the tree edge leaves the cut's two sides.
 * n - 1 maximum flows. THR_ESOLVER if igraph fails. */
thr_status thr_cut_tree(int n, int m, const int (*edge)[2], const double *capacity, int (*tree)[2], double *flow,
                        thr_err *err) THR_MUST_CHECK;

const char *thr_igraph_version(void);

#endif
