/* Rows of covers and lengths. */
#include "lp/length/share_rows.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

void thr_share_rows_destroy(thr_share_rows *r)
{
  thr_lp_destroy(r->lp);
  free(r->edge);
  free(r->column);
  free(r->value);
  free(r->x);
}

thr_status thr_share_rows_init(thr_share_rows *r, thr_err *err)
{
  size_t n = (size_t)r->n_cords * (size_t)r->block;
  r->column = thr_calloc(n, sizeof *r->column);
  r->value = thr_calloc(n, sizeof *r->value);
  r->x = thr_calloc(n, sizeof *r->x);
  return r->column && r->value && r->x ? THR_OK : thr_nomem(err);
}

void thr_share_put(thr_share_rows *r, int column, double value)
{
  r->column[r->n] = column;
  r->value[r->n++] = value;
}

thr_status thr_share_row(thr_share_rows *r, double lower, bool both, thr_err *err)
{
  thr_status st = thr_lp_add_row(r->lp, r->n, r->column, r->value, lower, err);
  for (int i = 0; i < r->n && both; i++)
    r->value[i] = -r->value[i];
  if (!st && both) st = thr_lp_add_row(r->lp, r->n, r->column, r->value, -lower, err);
  r->n = 0;
  return st;
}

thr_status thr_share_covers(thr_share_rows *r, thr_err *err)
{
  const thr_share *s = r->s;
  thr_status st = THR_OK;
  for (int e = 0; e < r->n_edges && !st; e++) {
    int capacity = thr_plan_capacity(s->f, s->o, r->edge[e]);
    for (int c = 0; c < r->n_cords; c++)
      thr_share_put(r, thr_share_passes(r, c, e), 1);
    st = thr_share_row(r, thr_plan_cover(s->f, s->o, r->edge[e]), false, err);
    for (int c = 0; c < r->n_cords && capacity < INT_MAX; c++)
      thr_share_put(r, thr_share_passes(r, c, e), -1);
    if (!st && capacity < INT_MAX) st = thr_share_row(r, -capacity, false, err);
  }
  return st;
}

/* Passes of cord c as lengths in units of unit, times sign. */
static void put_length(thr_share_rows *r, int c, double sign, double unit)
{
  for (int e = 0; e < r->n_edges; e++)
    thr_share_put(r, thr_share_passes(r, c, e), sign * r->s->f->length[r->edge[e]] / unit);
}

thr_status thr_share_lengths(thr_share_rows *r, int c, double limit, thr_err *err)
{
  double unit = limit < INFINITY ? limit : thr_frame_total_length(r->s->f);
  thr_status st = THR_OK;
  for (int e = 0; e < r->n_edges && !st; e++) {
    thr_share_put(r, thr_share_used(r, c, e), r->most);
    thr_share_put(r, thr_share_passes(r, c, e), -1);
    st = thr_share_row(r, 0, false, err);
  }
  if (st) return st;
  for (int e = 0; e < r->n_edges; e++)
    thr_share_put(r, thr_share_passes(r, c, e), 1);
  st = thr_share_row(r, 1, false, err);
  if (!st && limit < INFINITY) {
    put_length(r, c, -1, unit);
    st = thr_share_row(r, -1, false, err);
  }
  if (c == 0 || st) return st;
  put_length(r, c - 1, 1, unit);
  put_length(r, c, -1, unit);
  return thr_share_row(r, 0, false, err);
}
