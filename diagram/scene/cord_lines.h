/* Where a cord runs in space, as a line through the nodes or with a lane for each of its passes. */
#ifndef THR_CORD_LINES_H
#define THR_CORD_LINES_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* How cords are drawn for CAD. {0}: through the nodes, z upwards. */
typedef struct {
  bool lanes; /* the passes of an edge run beside each other, so that none coincide */
  bool up_y;  /* y points up: a point at x, y, z stands at x, z, -y */
} thr_line_options;

typedef struct {
  const thr_plan *plan;
  thr_line_options options;
  double spacing; /* between lanes, in units */
  int *passes;    /* [n_edges] of all cords */
  int *seen;      /* [n_edges] of the cords that were asked for */
  double (*point)[3];
  int n_points; /* of the cord asked for last */
} thr_cord_lines;

/* lines is to be ended even after a failure. The distance of lanes is 0.115 of the median edge, less on edges that are short or
 * have many passes: all lanes of an edge lie within half its length. */
thr_status thr_cord_lines_begin(thr_cord_lines *lines, const thr_plan *plan, const thr_line_options *options,
                                thr_err *err) THR_MUST_CHECK;

/* Sets point and n_points to those of cord c; cords are asked for in order. Without lanes the nodes along the cord; with lanes
 * the node where it starts, two points for each pass, side by side with those of other passes on the edge, and the node where it
 * ends. */
void thr_cord_lines_next(thr_cord_lines *lines, int c);

/* xyz as the options say which way is up. */
void thr_cord_lines_turn(const thr_line_options *options, const double xyz[3], double out[3]);

void thr_cord_lines_end(thr_cord_lines *lines);

#endif
