/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes where the nodes of a framework go on paper.
 *
 * Several candidates are made and measured: projections, unrolled domes and tubes, closed shells
 * spread flat or cut into two halves, and at last a drawing by springs. The one with the fewest
 * faults is drawn: pairs of edges that cross on paper but not in space, and edges too short for a
 * bead. A layout keeps the handedness of the framework seen from outside, so that "turn left" on
 * paper is "turn left" in the hand.
 *
 * Order in which to read the files: layout.c (projections, and the choice among all candidates),
 * layout_measure.c (what makes a layout good), then layout_unroll.c, layout_spread.c and
 * layout_panels.c, one kind of candidate each. */
#ifndef THR_LAYOUT_H
#define THR_LAYOUT_H

#include "graph/framework/frame.h"
#include "graph/number.h"
#include "graph/status.h"

enum { THR_LAYOUT_DRAWN_NODES = 1000 };
static const double THR_LAYOUT_OPEN =
    1; /* rad, seen from the middle: half the angle of the widest opening of a closed shell */

typedef enum {
  THR_LAYOUT_PLAN,       /* x to the right, y up the page, +z towards the viewer */
  THR_LAYOUT_UNROLLED_Z, /* azimuthal-equidistant about the vertical: the crown in the middle, rings
                            around it */
  THR_LAYOUT_FRONT,      /* x to the right, z up, seen from -y */
  THR_LAYOUT_SIDE,       /* y to the right, z up, seen from +x */
  THR_LAYOUT_PLANE,      /* at right angles onto the best-fit plane */
  THR_LAYOUT_UNROLLED_X, /* azimuthal-equidistant about the x axis: the +x end in the middle */
  THR_LAYOUT_UNROLLED_Y, /* the same about the y axis */
  THR_LAYOUT_SPREAD,     /* a closed shell opened at the face opposite the middle and spread flat
                            (stereographic) */
  THR_LAYOUT_PANELS, /* a closed shell cut near its equator: both halves azimuthal-equidistant, side
                        by side */
  THR_LAYOUT_DRAWN,  /* made by a drawing algorithm: only the adjacency is true (see
                        thr_layout_adopt) */
  THR_LAYOUT_SPACE,  /* none: the framework is seen in space (diagram/space/space_overview.c) */
  THR_LAYOUT_KINDS
} thr_layout_kind;

/* Arrays are owned; {0} is valid and empty. With two panels, a node on the seam between them has a
 * point on each, so that every edge lies in one panel; a cord that goes on from one panel to the
 * other does so between the two points of a node. */
typedef struct {
  int n_nodes;
  int n_points;    /* on paper: n_nodes, and the second points of nodes that have two */
  double (*xy)[2]; /* [n_points] units of the framework (THR_LAYOUT_DRAWN: any), +y up the page;
                      point v < n_nodes shows node v */
  int *node;       /* [n_points] which node a point shows; NULL: no node has two */
  thr_frame paper; /* with node, the edges of the framework, joining points: n_nodes (= n_points),
                      n_edges, edge, first and half are filled, the rest is empty */
  int axis; /* of two panels: they are seen from the positive end of the x (0), y (1) or z axis and
               from the other */
  double middle[2][2]; /* and these are their middles, the left one's first */
  thr_layout_kind kind;
  long crossings; /* pairs of edges that cross, touch or lie on each other on paper (see
                     thr_layout_measure) */
  bool estimated; /* from the crossings of a part of the edges, evenly spread */
  int squeezed;   /* edges shorter than a fifth of the median: no room for a bead */
  double median;  /* median edge length on paper, in units of xy */
  double ratio;   /* shortest edge on paper over median, 0 .. 1; 0 when the median is 0 */
} thr_layout;

/* Returns what edges join on paper: the framework's nodes, or the layout's points. Either is a
 * frame to ask for ends and half-edges; of a layout's points no more is known. */
static inline const thr_frame *thr_layout_paper(const thr_layout *layout, const thr_frame *frame)
{
  return layout->node ? &layout->paper : frame;
}

/* Returns whether the picture shows the framework as the surface that it is, so that a hand finds
 * every piece and every cord in it: nothing crosses and, unless it is a projection, no more than a
 * quarter of the pieces' faces lie within an arm's width of others that are further away in space.
 * O(n log n). THR_ENOMEM. */
thr_status thr_layout_is_surface(const thr_layout *layout, const thr_frame *frame, bool *surface,
                                 thr_err *err) THR_MUST_CHECK;

/* Returns the node that a point shows. */
static inline int thr_layout_node(const thr_layout *layout, int point)
{
  return layout->node ? layout->node[point] : point;
}

/* Makes and measures one candidate other than THR_LAYOUT_DRAWN. THR_EINPUT if the frame has no such
 * view (a flat frame has nothing to unroll, one with an opening as wide as THR_LAYOUT_OPEN no two
 * halves). */
thr_status thr_layout_make(thr_layout *layout, const thr_frame *frame, thr_layout_kind kind,
                           thr_err *err) THR_MUST_CHECK;

/* Takes over coordinates made elsewhere (igraph's Kamada-Kawai, a file): copies xy[frame->n_nodes],
 * measures, kind = THR_LAYOUT_DRAWN. Coordinates must be finite (THR_EINPUT). */
thr_status thr_layout_adopt(thr_layout *layout, const thr_frame *frame, const double (*xy)[2],
                            thr_err *err) THR_MUST_CHECK;

/* Fills crossings, estimated, squeezed, median and ratio from xy. Two edges without a common node
 * count as crossing when they come nearer than 2 % of the median; two edges at a node when they
 * leave it within 1 degree of each other. Hash grid: O(m + pairs that are near), and O(m log m) at
 * most: beyond that crossings are estimated. */
thr_status thr_layout_measure(thr_layout *layout, const thr_frame *frame,
                              thr_err *err) THR_MUST_CHECK;

/* Chooses the layout to draw, by crossings + squeezed, then ratio; of nearly equal candidates
 * (ratio within a quarter) the earlier kind wins, so a plan view with no crossing and a ratio of
 * 0.8 or more is always taken, and one of 0.5 unless unrolling opens up a rim that it shows
 * foreshortened. Two panels are only considered when every single picture has faults or a ratio
 * under 0.5; a drawing by the algorithm of Kamada & Kawai (graph/framework/frame.h), for up to
 * THR_LAYOUT_DRAWN_NODES nodes, only when all others have faults. extra[n_extra] are further
 * measured candidates (NULL and 0 for none), only used if they are better; the best is copied. */
thr_status thr_layout_choose(thr_layout *best, const thr_frame *frame, const thr_layout *extra,
                             int n_extra, thr_err *err) THR_MUST_CHECK;

/* Returns whether candidate a is clearly better than b, in the order of thr_layout_choose. */
bool thr_layout_better(const thr_layout *a, const thr_layout *b);

/* Copy a layout, and release one. */
thr_status thr_layout_copy(thr_layout *to, const thr_layout *from, thr_err *err) THR_MUST_CHECK;
void thr_layout_destroy(thr_layout *layout);

/* Returns a sentence for the reader of a diagram: "Plan, seen from above." */
const char *thr_layout_words(thr_layout_kind kind);

/* Lists the half-edges as paper->half, but by ascending angle[2 * n_edges] (rad, in (-pi, pi])
 * within a node, in around[2 * n_edges]. */
thr_status thr_layout_around(const thr_frame *paper, const double *angle, int *around,
                             thr_err *err) THR_MUST_CHECK;

/* Returns whether distances on paper are those of the framework, up to the foreshortening of a
 * projection. */
bool thr_layout_to_scale(thr_layout_kind kind);

/* ---- Declares what the files that make layouts share: candidates of one kind each, the best-fit
 * sphere, and the directions of the nodes seen from its centre. Private to diagram/. */

/* Fill xy[n_nodes], which is allocated, and measure; THR_EINPUT if the frame is flat (not about
 * z). */
thr_status thr_layout_unroll(thr_layout *layout, const thr_frame *frame, int axis,
                             thr_err *err) THR_MUST_CHECK; /* 0 = x, 1 = y, 2 = z */
thr_status thr_layout_spread(thr_layout *layout, const thr_frame *frame,
                             thr_err *err) THR_MUST_CHECK;

/* The same for two panels, which have points of their own: fills all of *layout on success, nothing
 * otherwise. */
thr_status thr_layout_panels(thr_layout *layout, const thr_frame *frame,
                             thr_err *err) THR_MUST_CHECK;

/* Fills *paper of a layout with points of their own: edge[n_edges] holds the points that the edges
 * join, and is copied. */
thr_status thr_layout_join(thr_frame *paper, int n_points, int n_edges, const int (*edge)[2],
                           thr_err *err) THR_MUST_CHECK;

/* Replaces *best by *layout when that is better or best is empty; the loser is freed. */
void thr_layout_keep_better(thr_layout *best, thr_layout *layout);

/* Computes the centre of the least-squares sphere; returns false if the sphere is larger than
 * THR_LAYOUT_FLAT diagonals: the frame is flat. */
enum { THR_LAYOUT_FLAT = 50 };
bool thr_layout_fit_sphere(const thr_frame *frame, double centre[3]);

/* Computes the mean of the nodes' coordinates. */
void thr_layout_mean_point(const thr_frame *frame, double mean[3]);

/* Computes the directions of the nodes from the centre of that sphere, allocated: (*unit)[n_nodes].
 * THR_EINPUT if the frame is flat. */
thr_status thr_layout_directions(const thr_frame *frame, double (**unit)[3],
                                 thr_err *err) THR_MUST_CHECK;

/* Computes the middle of a widest empty cap among n directions, the lowest of nearly equal ones;
 * returns the angle from there to the nearest direction, rad. */
double thr_layout_opening(const double (*unit)[3], int n, double middle[3]);

#endif
