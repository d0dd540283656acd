/* A page drawn from SVG, read in one pass. It knows the SVG that diagram/ writes for pages: svg (in mm), title, desc, style, g
 * with translations and clipping, clipPath around a rect, rect, turned or not, circle, path of M L H V C Z and their small
 * letters, text; and of these no attribute but those that are drawn or say nothing of the picture. Private to diagram/. */
#ifndef THR_SVG_PAGE_H
#define THR_SVG_PAGE_H

#include "diagram/export/paper.h"

/* Draws a whole SVG document on a page. Pages may be drawn in several threads. THR_ESOLVER with what it does not know, so that
 * nothing is left out silently. A style sheet holds for what comes after it. O(bytes + elements times rules). */
thr_status thr_svg_page(thr_paper *paper, const thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
