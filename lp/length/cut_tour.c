/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes cords of limited length at once, so that there are some before a search has found any.
 *
 * A tour passes each edge an even number of times and is cut into sections. Each section is a cord
 * together with the shortest paths from and to places where cords may end, or back to its start (G.
 * N. Frederickson, M. S. Hecht & C. E. Kim 1978). Sections are as long as the limit allows, and
 * passes that earlier cords made already are skipped where a section begins.
 *
 * Example: a path of edges 1, 1, 1 long, ends anywhere, limit 2: the first cord has two edges. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The tour and what is left of it. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  int *left; /* [n_edges] passes still to be made */
  thr_walks tour, cords;
  thr_paths home; /* to where cords may end, or to the start of the one at hand */
} tour_cutting;

static void cutting_destroy(tour_cutting *cutting)
{
  thr_walks_destroy(&cutting->tour);
  thr_walks_destroy(&cutting->cords);
  thr_paths_destroy(&cutting->home);
  free(cutting->left);
}

/* Returns whether the cords are to be closed. */
static bool closed_cords(const tour_cutting *cutting)
{
  return cutting->request->ends == THR_ENDS_CLOSED;
}

/* Traces a tour that passes each edge as often as its cover, or once more if this is odd. */
static thr_status trace_tour(tour_cutting *cutting, thr_err *err)
{
  int *even = thr_calloc((size_t)cutting->frame->n_edges, sizeof *even);
  if (!even) return thr_nomem(err);

  /* An odd number of passes gets one more. */
  for (int e = 0; e < cutting->frame->n_edges; e++)
    even[e] = cutting->left[e] + cutting->left[e] % 2;

  thr_status st = thr_walks_trace(cutting->frame, even, &cutting->tour, err);
  free(even);
  return st;
}

/* Allocates the arrays, computes the paths to where cords may end, and traces the tour. */
static thr_status cutting_init(tour_cutting *cutting, thr_err *err)
{
  const thr_frame *frame = cutting->frame;
  thr_status st = thr_paths_init(&cutting->home, frame, err);
  if (st) return st;
  if (!(cutting->left = thr_calloc((size_t)frame->n_edges, sizeof *cutting->left)))
    return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++)
    cutting->left[e] = thr_plan_cover(frame, cutting->request, e);

  /* Open cords: paths from all nodes where cords may end. Those of closed cords differ from cord to
   * cord (begin_at). */
  for (int v = 0; v < frame->n_nodes && !st && !closed_cords(cutting); v++)
    if (thr_plan_end_allowed(frame, cutting->request, v))
      st = thr_paths_start(&cutting->home, v, err);
  if (!st) st = thr_paths_spread(&cutting->home, cutting->request, NULL, 0, INFINITY, err);

  return st ? st : trace_tour(cutting, err);
}

/* Computes for closed cords the paths to node v, where the next cord begins. */
static thr_status begin_at(tour_cutting *cutting, int v, thr_err *err)
{
  if (!closed_cords(cutting)) return THR_OK;
  thr_paths_clear(&cutting->home);
  thr_status st = thr_paths_start(&cutting->home, v, err);
  return st ? st
            : thr_paths_spread(&cutting->home, cutting->request, NULL, 0,
                               cutting->request->max_length, err);
}

/* Returns where the section that begins at pass `from` of the tour ends: after the last pass still
 * to be made with which the cord keeps to the limit; `from`: there is none. */
static int section_end(const tour_cutting *cutting, const thr_walk *walk, int from)
{
  const thr_frame *frame = cutting->frame;
  double most = cutting->request->max_length * (1 + 1e-12),
         length = cutting->home.far[thr_walk_node(frame, walk, from)];

  /* Lengthen the section pass by pass; the path from its end has to fit, too. */
  int end = from;
  for (int i = from; i < walk->n && length <= most; i++) {
    int e = walk->half[i] >> 1;
    length += frame->length[e];
    if (cutting->left[e] > 0 && length + cutting->home.far[thr_head(frame, walk->half[i])] <= most)
      end = i + 1;
  }
  return end;
}

/* Makes a cord of passes from .. end - 1 of the tour, and the paths to and from them. */
static thr_status add_cord(tour_cutting *cutting, const thr_walk *walk, int from, int end,
                           thr_err *err)
{
  int a = thr_walk_node(cutting->frame, walk, from), b = thr_walk_node(cutting->frame, walk, end);
  int n_to = thr_paths_back(&cutting->home, a, -1, NULL),
      n_back = thr_paths_back(&cutting->home, b, -1, NULL), section = end - from;

  /* The cord: a path to the section, the section, and a path back. */
  thr_walk cord = {n_to + section + n_back, NULL, 0, closed_cords(cutting)};
  if (!(cord.half = thr_calloc((size_t)cord.n, sizeof *cord.half))) return thr_nomem(err);

  thr_paths_to(&cutting->home, a, cord.half);
  memcpy(cord.half + n_to, walk->half + from, (size_t)section * sizeof *cord.half);
  thr_paths_back(&cutting->home, b, -1, cord.half + n_to + section);

  /* Passes on the paths count, too, and need not be made by later cords. */
  for (int i = 0; i < cord.n; i++)
    cutting->left[cord.half[i] >> 1]--;
  return thr_walks_add(&cutting->cords, cutting->frame, cord, err);
}

/* Cuts the tour into cords. *found: none is too long, and there are neither too many nor too few.
 */
static thr_status cut(tour_cutting *cutting, bool *found, thr_err *err)
{
  thr_status st = THR_OK;
  const thr_walk *walk = cutting->tour.walk;

  *found = true;
  for (int i = 0, end; i < walk->n && !st && *found; i = end) {
    end = i + 1;

    /* Passes that need not be made again begin no section. */
    if (cutting->left[walk->half[i] >> 1] <= 0) continue;

    /* The longest section that the limit allows. */
    st = begin_at(cutting, thr_walk_node(cutting->frame, walk, i), err);
    if (!st) end = section_end(cutting, walk, i);
    *found = end > i && cutting->cords.n_walks < cutting->request->cords;
    if (!st && *found) st = add_cord(cutting, walk, i, end, err);
  }

  *found &= cutting->cords.n_walks >= cutting->request->cords_least;
  return st;
}

thr_status thr_cut_tour(const thr_frame *frame, const thr_request *options, const int *passes,
                        thr_cord **cord, int *n_cords, thr_err *err)
{
  tour_cutting cutting = {.frame = frame, .request = options};
  bool found = false;
  (void)passes;
  *cord = NULL;
  *n_cords = 0;

  if (options->ends == THR_ENDS_COUNTS) return THR_OK;

  thr_status st = cutting_init(&cutting, err);
  if (!st) st = cut(&cutting, &found, err);
  if (!st && found) st = thr_walks_cords(&cutting.cords, frame, options, cord, n_cords, err);
  cutting_destroy(&cutting);
  return st;
}
