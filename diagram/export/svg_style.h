/* Styles of the SVG that is written in diagram/. They come from presentation attributes, from style="..", and from style sheets
 * whose selectors are lists of elements and classes with blanks between them, ".view-1 .place text.own", and
 * :not([stroke-dasharray]). All properties are inherited. What is not known is an error. Private to diagram/export/. */
#ifndef THR_SVG_STYLE_H
#define THR_SVG_STYLE_H

#include "graph/status.h"

#include <stddef.h>

/* Borrowed text that has no NUL at its end. */
typedef struct {
  const char *s;
  size_t n;
} thr_slice;

bool thr_slice_is(thr_slice slice, const char *word);
thr_slice thr_slice_trim(thr_slice slice); /* without blanks and ends of lines on either side */

/* Takes a number off the front of text, with what stands before it of blanks and commas; false if there is none. */
bool thr_slice_number(thr_slice *text, double *value);

typedef enum {
  THR_SVG_FILL, /* none, or red, green, blue from 0 to 1 */
  THR_SVG_STROKE,
  THR_SVG_FILL_OPACITY,
  THR_SVG_STROKE_OPACITY,
  THR_SVG_STROKE_WIDTH,
  THR_SVG_LINECAP,   /* 1 = round */
  THR_SVG_LINEJOIN,  /* 1 = round */
  THR_SVG_DASHARRAY, /* none, or up to four lengths */
  THR_SVG_DASHOFFSET,
  THR_SVG_ANCHOR, /* 0 start, 1 middle, 2 end */
  THR_SVG_FONT_SIZE,
  THR_SVG_FONT_WEIGHT, /* 1 = bold */
  THR_SVG_FONT_FAMILY, /* 1 = of one width */
  THR_SVG_PAINT_ORDER, /* 1 = the stroke below the fill */
  THR_SVG_PROPERTIES
} thr_svg_property;

typedef struct {
  int n; /* numbers in x; 0 = none */
  double x[4];
} thr_svg_value;

typedef struct {
  thr_svg_value value[THR_SVG_PROPERTIES];
} thr_svg_style;

/* The root's: black, without a stroke. */
thr_svg_style thr_svg_style_first(void);

/* Is the attribute a property? */
bool thr_svg_is_property(thr_slice name);

thr_status thr_svg_style_set(thr_svg_style *style, thr_slice name, thr_slice value, thr_err *err) THR_MUST_CHECK;

/* "fill:#fff;stroke:none". */
thr_status thr_svg_style_list(thr_svg_style *style, thr_slice list, thr_err *err) THR_MUST_CHECK;

/* ---- style sheets ---- */

typedef struct thr_svg_rule thr_svg_rule;
typedef struct thr_svg_declaration thr_svg_declaration;

/* {0} is empty. Rules weakest first. */
typedef struct {
  thr_svg_rule *rule;
  int n_rules, rules_capacity;
  thr_svg_declaration *declaration;
  int n_declarations, declarations_capacity;
} thr_svg_sheet;

/* An element: its name, its classes, whether it has the attribute stroke-dasharray. */
typedef struct {
  thr_slice name, classes;
  bool dashed;
} thr_svg_element;

/* Adds the rules of CSS text, which is borrowed as long as the sheet lives. */
thr_status thr_svg_sheet_add(thr_svg_sheet *sheet, thr_slice css, thr_err *err) THR_MUST_CHECK;

/* Changes style as the rules say that meet the last of n elements, each of which is inside the one before it. O(rules n). */
void thr_svg_sheet_apply(const thr_svg_sheet *sheet, const thr_svg_element *const *element, int n, thr_svg_style *style);

void thr_svg_sheet_destroy(thr_svg_sheet *sheet);

#endif
