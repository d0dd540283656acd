/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decides what a file may leave open: which of its coordinates points upwards, and what its numbers
 * are multiplied by.
 *
 * A structure stands on more than one line of nodes. If the nodes of least z are all on one line
 * but those of least y are not, the structure seems to lie on its side, and the report says so. */
#include "graph/io/read.h"

#include <float.h>
#include <math.h>

const char *thr_up_name(int up)
{
  static const char *const names[] = {"auto", "y", "z"};
  return names[up];
}

/* Returns whether the nodes of least coordinate `up` span a plane, instead of being on one line.
 * Distances within 1e-6 of the size do not count. */
static bool stands_on(const thr_draft *draft, int up, double size)
{
  const int first_axis = (up + 1) % 3, second_axis = (up + 2) % 3;
  double low = DBL_MAX, du = 0, dv = 0;
  const double *first = NULL;

  /* The lowest nodes. */
  for (int i = 0; i < draft->n_nodes; i++)
    low = fmin(low, draft->node[i].xyz[up]);
  for (int i = 0; i < draft->n_nodes; i++) {
    const double *at = draft->node[i].xyz;
    if (at[up] > low + 1e-6 * size) continue;
    if (!first) first = at;

    /* Two vectors from the first of them span a parallelogram with an area unless they are
     * parallel; the longest one so far is kept, because its direction is known best. */
    const double eu = at[first_axis] - first[first_axis], ev = at[second_axis] - first[second_axis];
    if (fabs(du * ev - dv * eu) > 1e-6 * size * size) return true;
    if (hypot(eu, ev) > hypot(du, dv)) {
      du = eu;
      dv = ev;
    }
  }

  return false;
}

/* Returns the longest side of the bounding box. */
static double size_of(const thr_draft *draft)
{
  double size = 0;

  /* In each direction, from the least to the largest coordinate. */
  for (int k = 0; k < 3; k++) {
    double low = DBL_MAX, high = -DBL_MAX;
    for (int i = 0; i < draft->n_nodes; i++) {
      low = fmin(low, draft->node[i].xyz[k]);
      high = fmax(high, draft->node[i].xyz[k]);
    }
    size = fmax(size, high - low);
  }

  return size;
}

/* Multiplies coordinates and lengths by a factor. THR_EINPUT if they leave the range of numbers. */
static thr_status scale(thr_draft *draft, double factor, thr_err *err)
{
  double most = 0, least = DBL_MAX;

  /* Coordinates. */
  for (int i = 0; i < draft->n_nodes; i++)
    for (int k = 0; k < 3; k++) {
      draft->node[i].xyz[k] *= factor;
      most = fmax(most, fabs(draft->node[i].xyz[k]));
    }

  /* Lengths that were given; others follow from the coordinates. */
  for (int e = 0; e < draft->n_edges; e++) {
    if (draft->edge[e].length == 0) continue;
    draft->edge[e].length *= factor;
    most = fmax(most, draft->edge[e].length);
    least = fmin(least, draft->edge[e].length);
  }

  /* Squares of numbers beyond 1e100 would overflow. */
  if (most < 1e100 && least > 0) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "scaled by %g, its coordinates or lengths are no numbers to work with", factor);
}

/* Decides which axis is up, turns the draft if it is y, and scales it. */
thr_status thr_draft_stand(thr_draft *draft, thr_up up, double factor, thr_read_report *report,
                           thr_err *err)
{
  const bool unasked = up == THR_UP_AUTO;

  /* The user's word, then what the maker is known to write, then what the format says. */
  report->up_from = !unasked         ? THR_FROM_USER
                    : draft->y_up    ? THR_FROM_MAKER
                    : draft->up_is_y ? THR_FROM_FILE
                                     : THR_FROM_NOBODY;
  report->y_up = up == THR_UP_Y || (unasked && (draft->y_up || draft->up_is_y));

  /* A quarter turn about x: (x, y, z) becomes (x, -z, y). */
  if (report->y_up) {
    for (int i = 0; i < draft->n_nodes; i++) {
      double *at = draft->node[i].xyz, y = at[1];
      at[1] = at[2] == 0 ? 0 : -at[2];
      at[2] = y;
    }

    /* Only where nobody says what is up there is something to warn of. */
  } else if (unasked) {
    const double size = size_of(draft);
    report->lies = !stands_on(draft, 2, size) && stands_on(draft, 1, size);
  }

  return factor == 1 ? THR_OK : scale(draft, factor, err);
}
