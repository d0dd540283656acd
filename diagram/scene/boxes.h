/* What lies where on paper: rectangles in a grid, asked for overlaps when a number or a name looks for room. */
#ifndef THR_BOXES_H
#define THR_BOXES_H

#include "graph/status.h"

typedef struct {
  double x0, y0, x1, y1; /* mm, x0 <= x1, y0 <= y1 */
} thr_box;

enum {
  THR_BOX_BEAD = 1,
  THR_BOX_CORD = 2,
  THR_BOX_ARROW = 4,
  THR_BOX_MARK = 8,
  THR_BOX_NUMBER = 16,
  THR_BOX_NAME = 32,
  THR_BOX_FOOT = 64,
  THR_BOX_TURN = 128
};

typedef struct {
  thr_box bounds;
  double cell; /* mm */
  int columns, rows;
  int *head; /* [columns * rows] newest link of the cell, or -1 */
  int n_boxes, boxes_capacity, n_links, links_capacity;
  struct thr_boxes_item {
    thr_box box;
    int kind;
    unsigned asked; /* number of the last question that met it */
  } * item;
  struct thr_boxes_link {
    int item, next;
  } * link;
  unsigned question;
} thr_boxes;

/* Boxes outside bounds are allowed and kept in the border cells. Release with thr_boxes_destroy. */
thr_status thr_boxes_init(thr_boxes *b, thr_box bounds, double cell, thr_err *err) THR_MUST_CHECK;
thr_status thr_boxes_add(thr_boxes *b, thr_box box, int kind, thr_err *err) THR_MUST_CHECK;
void thr_boxes_destroy(thr_boxes *b);

/* Area in mm^2 that box shares with the boxes of the kinds (a sum of THR_BOX_..), overlaps counted each time. Stops once
 * it is enough (> 0). A place so crowded that 300 boxes were met counts as taken. */
double thr_boxes_overlap(thr_boxes *b, thr_box box, int kinds, double enough);

thr_box thr_box_around(double x, double y, double half_width, double half_height);
void thr_box_extend(thr_box *b, thr_box other);

#endif
