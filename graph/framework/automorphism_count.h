/* How many automorphisms a coloured graph has, by igraph (bliss; Junttila & Kaski 2007): an opinion independent of nauty's. */
#ifndef THR_AUTOMORPHISM_COUNT_H
#define THR_AUTOMORPHISM_COUNT_H

#include "graph/status.h"

/* Graph with n nodes and m undirected edges; colour: [n], NULL = all alike. *digits receives the number in decimal; the caller
 * frees it. THR_ESOLVER if igraph fails. */
thr_status thr_automorphism_count(int n, int m, const int (*edge)[2], const int *colour, char **digits,
                                  thr_err *err) THR_MUST_CHECK;

#endif
