/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Can the framework move without stretching an edge, if its nodes were free hinges (thesis, chapter
 * 3)? What it can, joints that lock must hold.
 *
 * Row of edge uv: (x(u) - x(v)) . (s(u) - s(v)) = 0 for velocities s. Motions = 3 n - rank, of
 * which 6 of each component are those of a rigid body; states of self-stress = edges - rank
 * (Maxwell 1864, Calladine 1978).
 *
 * Example: a square of four bars in space has rank 4 of 12: 8 motions, 2 beyond those of a rigid
 * body, one of them within its plane. */
#include "eval/structure/beads.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double ROUNDING = 1e-9, DOUBT = 1e-6;

/* A matrix with a row for every edge and a few columns for every node, by columns. */
typedef struct {
  int n_columns;
  int *start, *row;
  double *value;
} matrix;

static void matrix_destroy(matrix *a)
{
  free(a->start);
  free(a->row);
  free(a->value);
}

static void unit_along(const thr_frame *frame, int h, double u[3])
{
  const double *from = frame->xyz[thr_tail(frame, h)], *to = frame->xyz[thr_head(frame, h)];
  double size = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
  for (int i = 0; i < 3; i++)
    u[i] = (to[i] - from[i]) / size;
}

/* The space that motions come from: at node v the span of axis[3 * v + i], i < n_axes[v]. */
typedef struct {
  const int *n_axes;
  const double (*axis)[3];
} velocities;

static thr_status matrix_make(matrix *a, const thr_frame *frame, const velocities *s, thr_err *err)
{
  size_t columns = 0, entries = 0, n = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    columns += (size_t)s->n_axes[v];
    entries += (size_t)s->n_axes[v] * (size_t)thr_degree(frame, v);
  }
  *a = (matrix){.n_columns = (int)columns,
                .start = thr_calloc(columns + 1, sizeof *a->start),
                .row = thr_calloc(entries, sizeof *a->row),
                .value = thr_calloc(entries, sizeof *a->value)};
  if (!a->start || !a->row || !a->value) return thr_nomem(err);
  for (int v = 0, j = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < s->n_axes[v]; i++) {
      for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
        double u[3];
        unit_along(frame, frame->half[k], u);
        a->row[n] = frame->half[k] >> 1;
        a->value[n++] = thr_dot(u, s->axis[3 * v + i]);
      }
      a->start[++j] = (int)n;
    }
  return THR_OK;
}

static thr_status rank_of(const thr_frame *frame, const velocities *s, int *rank, bool *unclear,
                          thr_err *err)
{
  matrix a;
  int coarse = 0;
  *rank = 0;
  thr_status st = matrix_make(&a, frame, s, err);
  if (!st) st = thr_rank(frame->n_edges, a.n_columns, a.start, a.row, a.value, ROUNDING, rank, err);
  if (!st) st = thr_rank(frame->n_edges, a.n_columns, a.start, a.row, a.value, DOUBT, &coarse, err);
  *unclear |= !st && coarse != *rank;
  matrix_destroy(&a);
  return st;
}

/* ---- the shape of pieces ---- */

/* What a piece spans, found from its edges: basis[0 .. dimension - 1] orthonormal. */
typedef struct {
  int dimension;
  double basis[3][3];
} span;

/* Takes in a direction (unit vector) if it is not in the span yet. */
static void widen(span *s, const double u[3])
{
  double rest[3] = {u[0], u[1], u[2]};
  for (int pass = 0; pass < 2; pass++) /* twice is enough (Gram & Schmidt) */
    for (int i = 0; i < s->dimension; i++) {
      double along = thr_dot(rest, s->basis[i]);
      for (int k = 0; k < 3; k++)
        rest[k] -= along * s->basis[i][k];
    }
  double size = sqrt(thr_dot(rest, rest));
  if (s->dimension == 3 || size <= DOUBT) return;
  for (int k = 0; k < 3; k++)
    s->basis[s->dimension][k] = rest[k] / size;
  s->dimension++;
}

static void find_spans(const thr_frame *frame, const int *component, span *piece)
{
  for (int e = 0; e < frame->n_edges; e++) {
    double u[3];
    unit_along(frame, 2 * e, u);
    widen(&piece[component[frame->edge[e][0]]], u);
  }
}

/* ---- the counts ---- */

typedef struct {
  const thr_frame *f;
  int n_pieces;
  int *component; /* [n_nodes] */
  span *piece;    /* [n_pieces] */
  int *n_axes;    /* [n_nodes] */
  double (*axis)[3];
} work;

static int axes(const work *w)
{
  int sum = 0;
  for (int v = 0; v < w->f->n_nodes; v++)
    sum += w->n_axes[v];
  return sum;
}

/* Motions that stretch nothing, rigid ones among them. */
static thr_status freedoms(work *w, int *count, bool *unclear, thr_err *err)
{
  int rank;
  thr_status st =
      rank_of(w->f, &(velocities){w->n_axes, (const double(*)[3])w->axis}, &rank, unclear, err);
  *count = axes(w) - rank;
  return st;
}

static void all_directions(work *w)
{
  for (int v = 0; v < w->f->n_nodes; v++) {
    w->n_axes[v] = 3;
    memset(w->axis[3 * v], 0, 3 * sizeof *w->axis);
    for (int i = 0; i < 3; i++)
      w->axis[3 * v + i][i] = 1;
  }
}

static thr_status count_motions(work *w, thr_rigidity *out, thr_err *err)
{
  const thr_frame *frame = w->f;
  int freedom, feet = 0;
  all_directions(w);
  out->flat = true;
  for (int k = 0; k < w->n_pieces; k++) {
    out->rigid_motions += w->piece[k].dimension == 1 ? 5 : 6;
    out->flat &= w->piece[k].dimension == 2;
  }
  thr_status st = freedoms(w, &freedom, &out->unclear, err);
  out->rank = 3 * frame->n_nodes - freedom;
  out->motions = freedom - out->rigid_motions;
  out->self_stresses = frame->n_edges - out->rank;
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot[v]) w->n_axes[v] = 0, feet++;
  out->pinned = freedom;
  if (!st && feet > 0) st = freedoms(w, &out->pinned, &out->unclear, err);
  if (st || !out->flat) return st;
  for (int v = 0; v < frame->n_nodes; v++) {
    w->n_axes[v] = 2;
    memcpy(w->axis[3 * v], w->piece[w->component[v]].basis, 2 * sizeof *w->axis);
  }
  st = freedoms(w, &freedom, &out->unclear, err);
  out->plane_motions = freedom - 3 * w->n_pieces;
  return st;
}

thr_status thr_rigidity_find(const thr_frame *frame, thr_rigidity *out, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *out = (thr_rigidity){0};
  work w = {.f = frame,
            .component = thr_calloc(n, sizeof *w.component),
            .piece = thr_calloc(n, sizeof *w.piece),
            .n_axes = thr_calloc(n, sizeof *w.n_axes),
            .axis = thr_calloc(3 * n, sizeof *w.axis)};
  thr_status st = w.component && w.piece && w.n_axes && w.axis ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, w.component, &w.n_pieces, err);
  if (!st) {
    find_spans(frame, w.component, w.piece);
    st = count_motions(&w, out, err);
  }
  free(w.component);
  free(w.piece);
  free(w.n_axes);
  free(w.axis);
  return st;
}
