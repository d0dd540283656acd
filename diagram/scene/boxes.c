/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lies where on paper: rectangles in a grid, asked for overlaps when a number or a name looks
 * for room. */
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

thr_status thr_boxes_init(thr_boxes *b, thr_box bounds, double cell, thr_err *err)
{
  double w = bounds.x1 - bounds.x0, h = bounds.y1 - bounds.y0;
  *b = (thr_boxes){.bounds = bounds, .cell = fmax(cell, fmax(w, h) / MAX_CELLS_ACROSS)};
  b->columns = (int)(w / b->cell) + 1;
  b->rows = (int)(h / b->cell) + 1;
  size_t n = (size_t)b->columns * (size_t)b->rows;
  b->head = thr_calloc(n, sizeof *b->head);
  if (!b->head) return thr_nomem(err);
  for (size_t i = 0; i < n; i++)
    b->head[i] = -1;
  return THR_OK;
}

void thr_boxes_destroy(thr_boxes *b)
{
  free(b->head);
  free(b->item);
  free(b->link);
  *b = (thr_boxes){0};
}

static int clamp_cell(double t, int n)
{
  return t < 0 ? 0 : t >= n ? n - 1 : (int)t;
}

/* Cells that a box touches: span = first and last column, first and last row. */
static void cells_of(const thr_boxes *b, const thr_box *box, int span[4])
{
  span[0] = clamp_cell((box->x0 - b->bounds.x0) / b->cell, b->columns);
  span[1] = clamp_cell((box->x1 - b->bounds.x0) / b->cell, b->columns);
  span[2] = clamp_cell((box->y0 - b->bounds.y0) / b->cell, b->rows);
  span[3] = clamp_cell((box->y1 - b->bounds.y0) / b->cell, b->rows);
}

thr_status thr_boxes_add(thr_boxes *b, thr_box box, int kind, thr_err *err)
{
  int span[4];
  thr_status st = thr_grow(&b->item, b->n_boxes, &b->boxes_capacity, sizeof *b->item, err);
  if (st) return st;
  b->item[b->n_boxes] = (struct thr_boxes_item){box, kind, 0};
  cells_of(b, &box, span);
  for (int r = span[2]; r <= span[3]; r++)
    for (int c = span[0]; c <= span[1]; c++) {
      st = thr_grow(&b->link, b->n_links, &b->links_capacity, sizeof *b->link, err);
      if (st) return st;
      int *head = &b->head[r * b->columns + c];
      b->link[b->n_links] = (struct thr_boxes_link){b->n_boxes, *head};
      *head = b->n_links++;
    }
  b->n_boxes++;
  return THR_OK;
}

static double shared(const thr_box *a, const thr_box *b)
{
  if (a->x1 <= b->x0 || b->x1 <= a->x0 || a->y1 <= b->y0 || b->y1 <= a->y0) return 0;
  const double wide = (a->x1 < b->x1 ? a->x1 : b->x1) - (a->x0 > b->x0 ? a->x0 : b->x0);
  return wide * ((a->y1 < b->y1 ? a->y1 : b->y1) - (a->y0 > b->y0 ? a->y0 : b->y0));
}

double thr_boxes_overlap(thr_boxes *b, thr_box box, int kinds, double enough)
{
  int span[4], looks = 0;
  double area = 0;
  b->question++;
  cells_of(b, &box, span);
  for (int r = span[2]; r <= span[3]; r++)
    for (int c = span[0]; c <= span[1]; c++)
      for (int i = b->head[r * b->columns + c]; i >= 0; i = b->link[i].next) {
        struct thr_boxes_item *it = &b->item[b->link[i].item];
        if (++looks > MAX_LOOKS) return area + (box.x1 - box.x0) * (box.y1 - box.y0);
        const double common = it->kind & kinds ? shared(&it->box, &box) : 0;
        if (!(common > 0) || it->asked == b->question) continue;
        it->asked = b->question;
        area += common;
        if (area >= enough) return area;
      }
  return area;
}
