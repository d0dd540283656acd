/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the motions of a framework onto itself, for bounds that sum over equal edges
 * (tortuosity/proof/orbits.c).
 *
 * More than 240 motions are not worth the time to find; then there are none, which weakens the
 * bound and breaks nothing. */
#include "planner/planner_parts.h"
#include "symmetry/group/group.h"

/* Finds up to 240 isometries, to within rounding of the framework's size; more than that, or no
 * time: none. */
static thr_status find(const thr_frame *frame, double rounding, const thr_limits *limits,
                       int **image, int *n, thr_err *err)
{
  enum { MOST = 240 };

  thr_err why = {0};
  thr_status st = thr_isometries_find(frame, NULL, rounding, MOST, limits, image, n, &why);
  if (!st) return THR_OK;

  *image = NULL;
  *n = 0;
  return st == THR_ELIMIT ? THR_OK : thr_fail(err, st, "%s", why.text);
}

thr_status thr_planner_motions(const thr_frame *frame, const thr_limits *limits, int **image,
                               int *n, thr_err *err)
{
  return find(frame, 1e-9, limits, image, n, err);
}

thr_status thr_planner_near_motions(const thr_frame *frame, const thr_limits *limits, int **image,
                                    int *n, thr_err *err)
{
  return find(frame, 1e-4, limits, image, n, err);
}
