/* What a drawing nearly says: nodes that are almost one, nodes that lie on an edge which passes them, edges that cross without a
 * node. Joints that are meant to be there and are not make other cords, so a reader of frameworks remarks them. */
#ifndef THR_NEAR_H
#define THR_NEAR_H

#include "graph/framework/frame.h"

typedef struct {
  int n_close; /* pairs of nodes without an edge between them, at most a tenth of the shortest edge at either apart */
  int closest[2];
  double gap;                     /* of the closest pair */
  double weld;                    /* a tolerance that joins all of these pairs, and what it would do: */
  int n_welded, n_merged, n_lost; /* nodes merged, edges merged, edges of no length dropped */
  int components, components_welded;
  int n_on_edge, on_edge[2]; /* nodes at most a thousandth of its length from an edge that does not end there; one and its edge */
  int n_crossings, crossing[2]; /* pairs of edges as close to each other between their ends; one of them */
  bool tangled;                 /* so many edges pass close to each other that not all pairs were looked at */
} thr_near;

/* Edges that are longer than their nodes are apart are taken for curves, of which only the ends count. O(n + m) where edges of
 * about one length fill space evenly; at most about 1e8 comparisons. */
thr_status thr_frame_near(const thr_frame *frame, thr_near *near, thr_err *err) THR_MUST_CHECK;

/* Cuts each edge at the nodes that lie on it: its parts share its length, and each needs and takes as many passes. *n_cut
 * receives how many edges were cut; parts that are edges already are dropped and counted in the report. */
thr_status thr_frame_split(thr_frame *frame, int *n_cut, thr_read_report *report, thr_err *err) THR_MUST_CHECK;

#endif
