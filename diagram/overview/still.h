/* Still pictures: rigid beads before and after something gave way, or as they come up, side by side. */
#ifndef THR_STILL_H
#define THR_STILL_H

#include "graph/framework/frame.h"
#include "graph/status.h"
#include "graph/text.h"

/* Beads are a node's arms of square section to the middles of its edges, one side as level as the edge allows. Lengths in units
 * of the framework; everything is borrowed. */
typedef struct {
  const char *id;          /* of the panel's element */
  const char *caption;     /* below it */
  const double (*pose)[7]; /* [n_nodes] where the node is and how its bead is turned: position, quaternion (x y z w) */
} thr_still_panel;

typedef struct {
  const char *title; /* NULL or "": "Before and after" */
  const char *note;  /* below the panels; NULL = none */
  double width;      /* of an arm */
  double ground;     /* z of the ground */
  int n_panels;      /* at least 1, in rows of three at most */
  const thr_still_panel *panel;
  int first_bead; /* in another colour; -1 = none */
} thr_still;

/* Appends the picture to svg: all panels seen from one side, to one scale, faces shaded and drawn back to front; ends of arms
 * are pale, so that gaps show. What has gone far away from the first panel is cut off at the edge. The same input gives the same
 * bytes. THR_EINPUT for poses that are not finite, a width <= 0 or a bead out of range. O(n log n). svg is unchanged on failure.
 */
thr_status thr_still_svg(const thr_frame *frame, const thr_still *still, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
