/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps what lies where on paper: rectangles in a grid of cells, asked for overlaps when a number
 * or a name looks for room.
 *
 * Each cell has a list of the rectangles that touch it; a question looks through the lists of the
 * cells that it touches itself. Rectangles that lie in several of them count once: each remembers
 * the number of the last question. O(rectangles near by) for each question. */
#include "diagram/scene/scene.h"

#include <math.h>
#include <stdlib.h>

enum { MAX_CELLS_ACROSS = 512, MAX_LOOKS = 300 };

thr_box thr_box_around(double x, double y, double half_width, double half_height)
{
  return (thr_box){x - half_width, y - half_height, x + half_width, y + half_height};
}

void thr_box_extend(thr_box *box, thr_box other)
{
  if (other.x0 < box->x0) box->x0 = other.x0;
  if (other.y0 < box->y0) box->y0 = other.y0;
  if (other.x1 > box->x1) box->x1 = other.x1;
  if (other.y1 > box->y1) box->y1 = other.y1;
}

void thr_box_point(thr_box *box, const double at[2])
{
  thr_box_extend(box, (thr_box){at[0], at[1], at[0], at[1]});
}

bool thr_box_touch(thr_box a, thr_box b)
{
  return a.x0 <= b.x1 && a.x1 >= b.x0 && a.y0 <= b.y1 && a.y1 >= b.y0;
}

bool thr_box_inside(thr_box outer, thr_box box)
{
  return box.x0 >= outer.x0 && box.x1 <= outer.x1 && box.y0 >= outer.y0 && box.y1 <= outer.y1;
}

thr_status thr_boxes_init(thr_boxes *boxes, thr_box bounds, double cell, thr_err *err)
{
  /* A cell is larger than asked for on a large sheet, so that the grid stays small. */
  double width = bounds.x1 - bounds.x0, height = bounds.y1 - bounds.y0;
  *boxes =
      (thr_boxes){.bounds = bounds, .cell = fmax(cell, fmax(width, height) / MAX_CELLS_ACROSS)};

  boxes->columns = (int)(width / boxes->cell) + 1;
  boxes->rows = (int)(height / boxes->cell) + 1;

  size_t n_cells = (size_t)boxes->columns * (size_t)boxes->rows;

  /* No cell has a box yet. */
  boxes->head = thr_calloc(n_cells, sizeof *boxes->head);
  if (!boxes->head) return thr_nomem(err);
  for (size_t i = 0; i < n_cells; i++)
    boxes->head[i] = -1;
  return THR_OK;
}

void thr_boxes_destroy(thr_boxes *boxes)
{
  free(boxes->head);
  free(boxes->item);
  free(boxes->link);
  *boxes = (thr_boxes){0};
}

/* Returns the cell of a coordinate in cells; what is outside counts to the border. */
static int clamp_cell(double at, int n)
{
  return at < 0 ? 0 : at >= n ? n - 1 : (int)at;
}

/* Fills span with the cells that a box touches: first and last column, first and last row. */
static void cells_of(const thr_boxes *boxes, const thr_box *box, int span[4])
{
  span[0] = clamp_cell((box->x0 - boxes->bounds.x0) / boxes->cell, boxes->columns);
  span[1] = clamp_cell((box->x1 - boxes->bounds.x0) / boxes->cell, boxes->columns);
  span[2] = clamp_cell((box->y0 - boxes->bounds.y0) / boxes->cell, boxes->rows);
  span[3] = clamp_cell((box->y1 - boxes->bounds.y0) / boxes->cell, boxes->rows);
}

thr_status thr_boxes_add(thr_boxes *boxes, thr_box box, int kind, thr_err *err)
{
  /* Links and boxes refer to each other by number, since both arrays grow. */
  int span[4];
  thr_status st =
      thr_grow(&boxes->item, boxes->n_boxes, &boxes->boxes_capacity, sizeof *boxes->item, err);
  if (st) return st;
  boxes->item[boxes->n_boxes] = (struct thr_boxes_item){box, kind, 0};

  /* Put the box in front of the list of each cell. */
  cells_of(boxes, &box, span);
  for (int r = span[2]; r <= span[3]; r++)
    for (int c = span[0]; c <= span[1]; c++) {
      st = thr_grow(&boxes->link, boxes->n_links, &boxes->links_capacity, sizeof *boxes->link, err);
      if (st) return st;

      int *head = &boxes->head[r * boxes->columns + c];
      boxes->link[boxes->n_links] = (struct thr_boxes_link){boxes->n_boxes, *head};
      *head = boxes->n_links++;
    }

  boxes->n_boxes++;
  return THR_OK;
}

/* Returns the area that two boxes share, mm^2. */
static double shared(const thr_box *a, const thr_box *b)
{
  /* Boxes that only touch share nothing. */
  if (a->x1 <= b->x0 || b->x1 <= a->x0 || a->y1 <= b->y0 || b->y1 <= a->y0) return 0;

  const double wide = (a->x1 < b->x1 ? a->x1 : b->x1) - (a->x0 > b->x0 ? a->x0 : b->x0);
  return wide * ((a->y1 < b->y1 ? a->y1 : b->y1) - (a->y0 > b->y0 ? a->y0 : b->y0));
}

double thr_boxes_overlap(thr_boxes *boxes, thr_box box, int kinds, double enough)
{
  int span[4], looks = 0;
  double area = 0;

  /* A new question: no box has been met yet. */
  boxes->question++;
  cells_of(boxes, &box, span);

  for (int r = span[2]; r <= span[3]; r++)
    for (int c = span[0]; c <= span[1]; c++)
      for (int i = boxes->head[r * boxes->columns + c]; i >= 0; i = boxes->link[i].next) {
        struct thr_boxes_item *item = &boxes->item[boxes->link[i].item];

        /* A crowded place counts as taken, as a whole. */
        if (++looks > MAX_LOOKS) return area + (box.x1 - box.x0) * (box.y1 - box.y0);

        /* Each box once, though it may lie in many cells. */
        const double common = item->kind & kinds ? shared(&item->box, &box) : 0;
        if (!(common > 0) || item->asked == boxes->question) continue;

        item->asked = boxes->question;
        area += common;
        if (area >= enough) return area;
      }
  return area;
}
