/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns the pairs of a joined multigraph into cords.
 *
 * The pairs are followed (graph/threading/threading.c), which gives places in order; the passes
 * between them are a cord's half-edges. An open cord is listed from its end node with the lower
 * number, a closed one from the node where it turns most sharply, so that its two ends come out
 * there and the sharpest turn is not made. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/join.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Makes cord number k of a followed threading. The half-edges are allocated for the caller, also on
 * failure if cord->half is set. */
static thr_status make_cord(const thr_threading *threading, int k, thr_cord *cord, thr_err *err)
{
  const thr_frame *frame = threading->f;
  const thr_place *place = threading->place + threading->first[k];
  bool open = !thr_threading_closed(threading, k);
  int n = threading->first[k + 1] - threading->first[k] - open;
  if (n < 1) return thr_fail(err, THR_ESOLVER, "a cord without a pass");
  if (!(cord->half = thr_calloc((size_t)n, sizeof *cord->half))) return thr_nomem(err);

  /* The half-edge that leaves each place. The first place of a closed cord comes after the cord's
   * first pass. */
  for (int i = 0; i < n; i++)
    cord->half[i] = threading->g->half[place[open ? i : (i + n - 1) % n].out];

  /* Where the cord begins. */
  thr_walk walk = {n, cord->half, 0, !open};
  if (open && thr_walk_node(frame, &walk, 0) > thr_walk_node(frame, &walk, n))
    thr_walk_reverse(cord->half, n);
  thr_status st =
      open ? THR_OK : thr_walk_rotate(&walk, thr_tour_start(frame, NULL, cord->half, n), err);

  cord->half = walk.half;
  cord->n_passes = n;
  cord->closed = thr_walk_node(frame, &walk, 0) == thr_walk_node(frame, &walk, n);
  return st;
}

/* Makes all cords of a followed threading, component by component, and names them. */
static thr_status make_cords(const thr_threading *threading,
                             const thr_turning_columns *turning_columns, thr_cord *cord,
                             thr_err *err)
{
  thr_status st = THR_OK;
  for (int component = 0, made = 0; component < turning_columns->n_components; component++)
    for (int k = 0; k < threading->n_cords && !st; k++) {
      if (turning_columns
              ->component[threading->g->tail[threading->place[threading->first[k]].in]] !=
          component)
        continue;

      /* Numbers and names are given in the order of the components. */
      st = make_cord(threading, k, &cord[made], err);
      cord[made].component = component;
      thr_cord_id(made, cord[made].id);
      made++;
    }
  return st;
}

thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords, thr_err *err)
{
  thr_threading threading;
  thr_join same = *j; /* following does not change it */
  memset(cord, 0, (size_t)n_cords * sizeof *cord);

  thr_status st = thr_join_threading(&same, &threading, err);
  if (!st) thr_threading_follow(&threading, INT_MAX);
  if (!st && threading.n_cords != n_cords)
    st = thr_fail(err, THR_ESOLVER, "%d cords instead of the %d asked for", threading.n_cords,
                  n_cords);
  if (!st) st = make_cords(&threading, j->c, cord, err);
  thr_threading_destroy(&threading);

  /* On failure nothing is left allocated. */
  for (int i = 0; st && i < n_cords; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }
  return st;
}
