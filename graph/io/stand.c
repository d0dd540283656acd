/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file may leave unsaid: which of its coordinates points up, and how large its numbers are
 * meant. */
#include "graph/io/read.h"

#include <float.h>
#include <math.h>

const char *thr_up_name(int up)
{
  static const char *const names[] = {"auto", "y", "z"};
  return names[up];
}

/* Do the nodes of least coordinate `up` span a level, that is, are they not all in one line? Within
 * 1e-6 of the size. */
static bool stands_on(const thr_draft *draft, int up, double size)
{
  const int u = (up + 1) % 3, v = (up + 2) % 3;
  double low = DBL_MAX, du = 0, dv = 0;
  const double *first = NULL;
  for (int i = 0; i < draft->n_nodes; i++)
    low = fmin(low, draft->node[i].xyz[up]);
  for (int i = 0; i < draft->n_nodes; i++) {
    const double *at = draft->node[i].xyz;
    if (at[up] > low + 1e-6 * size) continue;
    if (!first) first = at;
    const double eu = at[u] - first[u], ev = at[v] - first[v];
    if (fabs(du * ev - dv * eu) > 1e-6 * size * size) return true;
    if (hypot(eu, ev) > hypot(du, dv)) {
      du = eu;
      dv = ev;
    }
  }
  return false;
}

/* The longest side of the bounding box. */
static double size_of(const thr_draft *draft)
{
  double size = 0;
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

static thr_status scale(thr_draft *draft, double factor, thr_err *err)
{
  double most = 0, least = DBL_MAX;
  for (int i = 0; i < draft->n_nodes; i++)
    for (int k = 0; k < 3; k++) {
      draft->node[i].xyz[k] *= factor;
      most = fmax(most, fabs(draft->node[i].xyz[k]));
    }
  for (int e = 0; e < draft->n_edges; e++) {
    if (draft->edge[e].length == 0) continue;
    draft->edge[e].length *= factor;
    most = fmax(most, draft->edge[e].length);
    least = fmin(least, draft->edge[e].length);
  }
  if (most < 1e100 && least > 0) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "scaled by %g, its coordinates or lengths are no numbers to work with", factor);
}

thr_status thr_draft_stand(thr_draft *draft, thr_up up, double factor, thr_read_report *report,
                           thr_err *err)
{
  const bool unasked = up == THR_UP_AUTO;
  report->up_from = !unasked         ? THR_FROM_USER
                    : draft->y_up    ? THR_FROM_MAKER
                    : draft->up_is_y ? THR_FROM_FILE
                                     : THR_FROM_NOBODY;
  report->y_up = up == THR_UP_Y || (unasked && (draft->y_up || draft->up_is_y));
  if (report->y_up) {
    for (int i = 0; i < draft->n_nodes; i++) {
      double *at = draft->node[i].xyz, y = at[1];
      at[1] = at[2] == 0 ? 0 : -at[2];
      at[2] = y;
    }
  } else if (unasked) {
    const double size = size_of(draft);
    report->lies = !stands_on(draft, 2, size) && stands_on(draft, 1, size);
  }
  return factor == 1 ? THR_OK : scale(draft, factor, err);
}
