/* What is written around the overview picture: heading, key, one line per cord, scale bar. Private to diagram/. */
#ifndef THR_LEGEND_H
#define THR_LEGEND_H

#include "diagram/scene/scene.h"
#include "graph/status.h"
#include "graph/text.h"

/* The title to show: the given one, or one made from the counts. */
void thr_legend_title(const thr_scene *scene, const char *given, char title[160]);

/* Appends title and explanations within width mm from the left margin x; returns the y below them. */
double thr_legend_heading(const thr_scene *scene, const char *title, double x, double y, double width, thr_text *text);

/* Appends scale bar, key and the lines of the cords; *bottom receives the y below them. */
thr_status thr_legend_foot(const thr_scene *scene, double x, double y, double width, thr_text *text, double *bottom,
                           thr_err *err) THR_MUST_CHECK;

/* Width that the longest line wants, mm. */
enum { THR_LEGEND_WIDTH = 165 };

#endif
