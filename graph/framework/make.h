/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes example frameworks, shapes by name; and draws graphs in the plane. */
#ifndef THR_MAKE_H
#define THR_MAKE_H

#include "graph/framework/frame.h"

/* ---- make.c: Generators of example frameworks. */

typedef enum {
  THR_MAKE_DOME,
  THR_MAKE_GEODESIC,
  THR_MAKE_TUBE,
  THR_MAKE_SPHERE,
  THR_MAKE_HONEYCOMB,
  THR_N_SHAPES
} thr_shape;
const char *thr_shape_name(int shape); /* "dome", "geodesic", "tube", "sphere", "honeycomb" */

typedef struct {
  thr_shape shape;
  int size;  /* dome: nodes per side (>= 2); geodesic, sphere: frequency (>= 1); tube: nodes around
                (>= 3);  honeycomb: rings of hexagons (>= 1) */
  int rings; /* tube: rings of nodes along the axis (>= 2) */
  double pitch; /* mm between neighbouring nodes (dome: in plan; others: nominal), > 0 */
  double rise; /* dome, honeycomb: height of the crown over the feet as a fraction of the half span,
                  >= 0 */
} thr_make_options;

thr_make_options thr_make_options_default(thr_shape shape);

/* THR_EINPUT with the option's name for a size out of range; at most 2 million nodes. */
thr_status thr_make(thr_draft *draft, const thr_make_options *options, thr_err *err) THR_MUST_CHECK;

/* ---- Drawing of graphs by igraph. */

/* Kamada & Kawai 1989: nodes as springs, whose lengths are the shortest ways along the edges. Graph
 * with n nodes and m undirected edges of length > 0; xy[n] is where the search starts, unless it is
 * to start from a circle, and receives where it ends. No randomness. O(n m log n), then O(n) for
 * each of at most 50 n steps; n^2 numbers of memory. THR_ESOLVER if igraph fails. */
thr_status thr_kamada_kawai(int n, int m, const int (*edge)[2], const double *length, bool circle,
                            double (*xy)[2], thr_err *err) THR_MUST_CHECK;

#endif
