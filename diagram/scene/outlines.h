/* What pieces look like on paper. Private to diagram/. */
#ifndef THR_OUTLINES_H
#define THR_OUTLINES_H

#include "diagram/scene/scene.h"
#include "graph/text.h"

/* Appends the outline of the solid piece at a point as path data: arms to the middles of its edges, less half the gap between two
 * faces; between neighbouring arms the corner where their sides meet. Arms that stand too close for their width are narrower. */
void thr_outline_solid(const thr_scene *scene, int point, thr_text *data);

/* Around the arms of the piece at a point. */
thr_box thr_outline_box(const thr_scene *scene, int point);

/* Ends of the middle line of edge e's tube, half its width from its round ends. */
void thr_outline_tube(const thr_scene *scene, int e, double width, double end[2][2]);

#endif
