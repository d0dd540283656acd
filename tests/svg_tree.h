/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads an SVG document as this program writes them, for tests that look at what is drawn where. */
#ifndef THR_SVG_TREE_H
#define THR_SVG_TREE_H

#include <stdbool.h>

/* An element; text is what stands between its tags, up to its first child. */
typedef struct {
  char name[16], id[32]; /* id "" = none */
  int parent;            /* an earlier element, -1 = none */
  char *attributes;      /* as they stand in the tag */
  char *text;            /* entities as they are */
  double shift[2],
      angle; /* its own and its ancestors' translate(), and its own rotate(), degrees */
} svg_element;

typedef struct {
  int n;
  svg_element *element; /* in document order */
  int n_ids, *by_id;    /* the elements that have one, sorted by it */
  double width, height; /* of the sheet, mm */
} svg_tree;

/* Fails the test if the document is not well-formed or has an id twice. Release with
 * svg_tree_destroy. */
svg_tree svg_parse(const char *svg);
void svg_tree_destroy(svg_tree *t);

/* Value of an attribute; false and "" if there is none. */
bool svg_attribute(const svg_tree *t, int i, const char *name, char value[256]);
double svg_number(const svg_tree *t, int i, const char *name); /* fails the test if there is none */
bool svg_has_class(const svg_tree *t, int i, const char *word);

int svg_by_id(const svg_tree *t, const char *id); /* -1 = none */
bool svg_inside(const svg_tree *t, int i, int ancestor);

/* Box of a rect, circle or text on the sheet (of a text about as wide as in DejaVu Sans): x0, y0,
 * x1, y1 in mm; not of rotated elements. */
void svg_box(const svg_tree *t, int i, double box[4]);
bool svg_overlap(const double a[4], const double b[4], double air); /* nearer than air, mm */

/* Points of a path of M, L and C on the sheet, with the letter of each (of a C three times);
 * returns how many. Others: fails. */
int svg_path(const svg_tree *t, int i, char *letter, double (*at)[2], int most);

#endif
