/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords of limited length at once: what there is before a search has found any. Internal to lp/ and
 * whoever keeps the best. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int *left; /* [n_edges] passes still to be made */
  thr_walks tour, cords;
  thr_paths home; /* to where cords may end, or to the start of the one at hand */
} cutting;

static void cutting_destroy(cutting *x)
{
  thr_walks_destroy(&x->tour);
  thr_walks_destroy(&x->cords);
  thr_paths_destroy(&x->home);
  free(x->left);
}

static bool closed_cords(const cutting *x)
{
  return x->o->ends == THR_ENDS_CLOSED;
}

static thr_status trace_tour(cutting *x, thr_err *err)
{
  int *even = thr_calloc((size_t)x->f->n_edges, sizeof *even);
  if (!even) return thr_nomem(err);
  for (int e = 0; e < x->f->n_edges; e++)
    even[e] = x->left[e] + x->left[e] % 2;
  thr_status st = thr_walks_trace(x->f, even, &x->tour, err);
  free(even);
  return st;
}

static thr_status cutting_init(cutting *x, thr_err *err)
{
  const thr_frame *frame = x->f;
  thr_status st = thr_paths_init(&x->home, frame, err);
  if (st) return st;
  if (!(x->left = thr_calloc((size_t)frame->n_edges, sizeof *x->left))) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++)
    x->left[e] = thr_plan_cover(frame, x->o, e);
  for (int v = 0; v < frame->n_nodes && !st && !closed_cords(x); v++)
    if (thr_plan_end_allowed(frame, x->o, v)) st = thr_paths_start(&x->home, v, err);
  if (!st) st = thr_paths_spread(&x->home, x->o, NULL, 0, INFINITY, err);
  return st ? st : trace_tour(x, err);
}

/* Closed cords: the paths to node v. */
static thr_status begin_at(cutting *x, int v, thr_err *err)
{
  if (!closed_cords(x)) return THR_OK;
  thr_paths_clear(&x->home);
  thr_status st = thr_paths_start(&x->home, v, err);
  return st ? st : thr_paths_spread(&x->home, x->o, NULL, 0, x->o->max_length, err);
}

/* Where the section of tour walk that begins at pass `from` ends: after the last pass that still
 * has to be made with which the cord is no longer than it may be; `from`: there is none. */
static int section_end(const cutting *x, const thr_walk *walk, int from)
{
  const thr_frame *frame = x->f;
  double most = x->o->max_length * (1 + 1e-12),
         length = x->home.far[thr_walk_node(frame, walk, from)];
  int end = from;
  for (int i = from; i < walk->n && length <= most; i++) {
    int e = walk->half[i] >> 1;
    length += frame->length[e];
    if (x->left[e] > 0 && length + x->home.far[thr_head(frame, walk->half[i])] <= most) end = i + 1;
  }
  return end;
}

/* Passes from .. end - 1 of walk, and the paths to and from them. */
static thr_status add_cord(cutting *x, const thr_walk *walk, int from, int end, thr_err *err)
{
  int a = thr_walk_node(x->f, walk, from), b = thr_walk_node(x->f, walk, end);
  int n_to = thr_paths_back(&x->home, a, -1, NULL), n_back = thr_paths_back(&x->home, b, -1, NULL),
      section = end - from;
  thr_walk cord = {n_to + section + n_back, NULL, 0, closed_cords(x)};
  if (!(cord.half = thr_calloc((size_t)cord.n, sizeof *cord.half))) return thr_nomem(err);
  thr_paths_to(&x->home, a, cord.half);
  memcpy(cord.half + n_to, walk->half + from, (size_t)section * sizeof *cord.half);
  thr_paths_back(&x->home, b, -1, cord.half + n_to + section);
  for (int i = 0; i < cord.n; i++)
    x->left[cord.half[i] >> 1]--;
  return thr_walks_add(&x->cords, x->f, cord, err);
}

/* *found: no cord would be too long, and there are not too many. */
static thr_status cut(cutting *x, bool *found, thr_err *err)
{
  thr_status st = THR_OK;
  const thr_walk *walk = x->tour.walk;
  *found = true;
  for (int i = 0, end; i < walk->n && !st && *found; i = end) {
    end = i + 1;
    if (x->left[walk->half[i] >> 1] <= 0) continue;
    st = begin_at(x, thr_walk_node(x->f, walk, i), err);
    if (!st) end = section_end(x, walk, i);
    *found = end > i && x->cords.n_walks < x->o->cords;
    if (!st && *found) st = add_cord(x, walk, i, end, err);
  }
  *found &= x->cords.n_walks >= x->o->cords_least;
  return st;
}

thr_status thr_cut_tour(const thr_frame *frame, const thr_request *options, const int *passes,
                        thr_cord **cord, int *n_cords, thr_err *err)
{
  cutting x = {.f = frame, .o = options};
  bool found = false;
  (void)passes;
  *cord = NULL;
  *n_cords = 0;
  if (options->ends == THR_ENDS_COUNTS) return THR_OK;
  thr_status st = cutting_init(&x, err);
  if (!st) st = cut(&x, &found, err);
  if (!st && found) st = thr_walks_cords(&x.cords, frame, options, cord, n_cords, err);
  cutting_destroy(&x);
  return st;
}
