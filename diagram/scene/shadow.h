/* The whole of a framework in so small a picture that its lines would run together: the area that they cover. Private to
 * diagram/. */
#ifndef THR_SHADOW_H
#define THR_SHADOW_H

#include "diagram/scene/boxes.h"
#include "graph/framework/frame.h"
#include "graph/text.h"

enum { THR_SHADOW_CELLS = 64 }; /* across, at most */

typedef struct {
  thr_box paper;
  double cell; /* mm */
  bool covered[THR_SHADOW_CELLS][THR_SHADOW_CELLS];
} thr_shadow;

/* With nothing in it. */
thr_shadow thr_shadow_on(thr_box paper);

/* Adds a line; what is beyond the paper counts as on its edge. O(its length). */
void thr_shadow_line(thr_shadow *shadow, const double a[2], const double b[2]);

/* Appends the area as one element. */
void thr_shadow_put(const thr_shadow *shadow, const char *colour, thr_text *text);

/* Appends the edges of a framework in small, within the paper: lines of their own if the pitch on paper, mm, leaves room between
 * them, else the area that they cover. Node v lies at at[stride * v], mm. O(edges). */
void thr_shadow_edges(const thr_frame *frame, const double *at, int stride, double pitch, thr_box paper, thr_text *text);

#endif
