/* Small pieces of SVG: numbers, text, paths. Private to diagram/. */
#ifndef THR_SVG_H
#define THR_SVG_H

#include "graph/text.h"

/* Rounded to the two decimals that are printed, and never -0. */
double thr_svg_round(double value);

/* The document up to its description, in mm; title and description are escaped. Close it with </svg>. */
void thr_svg_open(thr_text *text, double width, double height, const char *title, const char *description);

/* <text> at the baseline point; attributes is put in as it is ("" for none), e.g. " text-anchor=\"middle\"". */
void thr_svg_text(thr_text *text, double x, double y, double size, const char *attributes, const char *s);

/* The same in lines of at most width mm (estimated for a wide face), broken at spaces, but for "mu = 0.2" and "1 N", and in a
 * name that is too wide behind a slash; returns the y of the next line. */
double thr_svg_wrap(thr_text *text, double x, double y, double size, double width, const char *attributes, const char *words);

void thr_svg_move(thr_text *text, const double at[2]);
void thr_svg_line(thr_text *text, const double at[2]);
void thr_svg_curve(thr_text *text, const double a[2], const double b[2], const double at[2]);

/* A length in the frame's units with about four digits: "2413 mm", "12.35 m". */
void thr_svg_length(double value, const char *units, char text[64]);

/* A force with about three digits: "12.3 N". */
void thr_svg_force(double newton, char text[32]);

/* Round values for an axis from low to high, at most `most` (>= 3) of them, ascending; returns their number. Logarithmic (low >
 * 0): powers of ten, with their 2 and 5 fold where these are few; even steps where that leaves fewer than two. */
int thr_svg_ticks(double low, double high, bool logarithmic, int most, double *tick);

#endif
