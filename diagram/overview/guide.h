/* What nodes and turns are called for whoever threads a plan, the same in every document. Private to diagram/. */
#ifndef THR_GUIDE_H
#define THR_GUIDE_H

#include "diagram/layout/layout.h"
#include "diagram/scene/places.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* {0} is valid and empty. Arrays are owned, the frame is borrowed. */
typedef struct {
  const thr_frame *f;
  thr_layout layout;
  thr_places places;
  bool sides;               /* have left and right a meaning? Not where the layout shows beads that cross, or is only drawn */
  double (*outward)[3];     /* [n_nodes] unit normal towards the viewer of the layout; 0 where none is known */
  char (*label)[THR_LABEL]; /* [n_nodes] the node's place as in the overview; all different, without blanks */
} thr_guide;

/* Lays the framework out as the overview does: as layout, which is copied, or, NULL, as thr_layout_choose. O(n log n). Release
 * with thr_guide_destroy, after a failure too. */
thr_status thr_guide_make(thr_guide *guide, const thr_frame *frame, const thr_layout *layout, thr_err *err) THR_MUST_CHECK;
void thr_guide_destroy(thr_guide *guide);

/* Appends "foot A1 (node 17)": the node's own name where it is called by its place. */
void thr_guide_place(const thr_guide *guide, int v, thr_text *text);

/* The half-edges that leave each node in around[2 * n_edges], as frame->half, but clockwise as seen from outside where that is
 * known, from the one on that points up most nearly in the picture. O(n log n). */
thr_status thr_guide_around(const thr_guide *guide, int *around, thr_err *err) THR_MUST_CHECK;

/* How half-edge out goes on from half-edge in (head(in) = tail(out)). */
typedef enum {
  THR_WAY_STRAIGHT,
  THR_WAY_LEFT, /* as seen from outside, going with the needle */
  THR_WAY_RIGHT,
  THR_WAY_OVER, /* ahead, where the surface bends */
  THR_WAY_TURN, /* to a side that cannot be told */
  THR_WAY_BACK  /* into the same edge */
} thr_way;

thr_way thr_guide_way(const thr_guide *guide, int in, int out);

/* Appends "straight on", "turn left 90 degrees", "over the curve 24 degrees", "turn back". */
void thr_guide_say(const thr_guide *guide, int in, int out, thr_text *text);

/* "second", "third", "4th", "21st" */
void thr_guide_ordinal(int n, char word[16]);

#endif
