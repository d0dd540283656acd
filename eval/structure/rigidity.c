/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts the motions of the framework that stretch no edge, if its nodes were free hinges (thesis,
 * chapter 3). What can move so, the joints must hold, which lock when the cords are tight.
 *
 * Row of edge uv in the rigidity matrix: (x(u) - x(v)) . (s(u) - s(v)) = 0 for velocities s. There
 * are 3 n - rank motions, of which 6 of each component are those of a rigid body, and edges - rank
 * states of self-stress (Maxwell 1864, Calladine 1978). The rank comes from a sparse QR
 * factorization (spqr.c).
 *
 * Example: a square of four bars in space has rank 4 of 12: 8 motions, 2 beyond those of a rigid
 * body, one of them within its plane. */
#include "eval/structure/beads.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Parts of a column that are left once its dependence on others is taken out: up to ROUNDING such a
 * column is dependent; if DOUBT decides otherwise, the count is unclear. */
static const double ROUNDING = 1e-9, DOUBT = 1e-6;

/* Holds a matrix by columns, with a row for every edge and a few columns for every node. */
typedef struct {
  int n_columns;
  int *start, *row;
  double *value;
} matrix;

/* Frees the arrays. */
static void matrix_destroy(matrix *rigidity)
{
  free(rigidity->start);
  free(rigidity->row);
  free(rigidity->value);
}

/* Computes the unit vector along a half-edge. */
static void unit_along(const thr_frame *frame, int h, double along_edge[3])
{
  const double *from = frame->xyz[thr_tail(frame, h)], *to = frame->xyz[thr_head(frame, h)];
  double size = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
  for (int i = 0; i < 3; i++)
    along_edge[i] = (to[i] - from[i]) / size;
}

/* Spans the space that motions come from: at node v the span of axis[3 * v + i], i < n_axes[v].
 * Held nodes have no axis. */
typedef struct {
  const int *n_axes;
  const double (*axis)[3];
} velocities;

/* Makes the matrix that maps velocities to how fast edges stretch, with rows of unit vectors. */
static thr_status matrix_make(matrix *rigidity, const thr_frame *frame, const velocities *space,
                              thr_err *err)
{
  size_t columns = 0, entries = 0, n = 0;

  /* Count columns and entries. */
  for (int v = 0; v < frame->n_nodes; v++) {
    columns += (size_t)space->n_axes[v];
    entries += (size_t)space->n_axes[v] * (size_t)thr_degree(frame, v);
  }

  /* An entry for every half-edge and axis. */
  *rigidity = (matrix){.n_columns = (int)columns,
                       .start = thr_calloc(columns + 1, sizeof *rigidity->start),
                       .row = thr_calloc(entries, sizeof *rigidity->row),
                       .value = thr_calloc(entries, sizeof *rigidity->value)};
  if (!rigidity->start || !rigidity->row || !rigidity->value) return thr_nomem(err);

  /* A column for every axis of every node: the edges that meet there, by unit vector times axis. */
  for (int v = 0, j = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < space->n_axes[v]; i++) {
      for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
        double along_edge[3];
        unit_along(frame, frame->half[k], along_edge);
        rigidity->row[n] = frame->half[k] >> 1;
        rigidity->value[n++] = thr_dot(along_edge, space->axis[3 * v + i]);
      }
      rigidity->start[++j] = (int)n;
    }

  return THR_OK;
}

/* Computes the rank of the rigidity matrix. *unclear is set where a coarser tolerance gives another
 * one. */
static thr_status rank_of(const thr_frame *frame, const velocities *space, int *rank, bool *unclear,
                          thr_err *err)
{
  matrix rigidity;
  int coarse = 0;

  *rank = 0;

  /* Twice: as rounding has it, and coarser. */
  thr_status st = matrix_make(&rigidity, frame, space, err);
  if (!st)
    st = thr_rank(frame->n_edges, rigidity.n_columns, rigidity.start, rigidity.row, rigidity.value,
                  ROUNDING, rank, err);
  if (!st)
    st = thr_rank(frame->n_edges, rigidity.n_columns, rigidity.start, rigidity.row, rigidity.value,
                  DOUBT, &coarse, err);

  /* Where the tolerance matters, the count is not to be relied on. */
  *unclear |= !st && coarse != *rank;
  matrix_destroy(&rigidity);

  return st;
}

/* ---- the shape of pieces ---- */

/* Says what a piece spans, found from its edges: basis[0 .. dimension - 1] is orthonormal. */
typedef struct {
  int dimension;
  double basis[3][3];
} span;

/* Widens a span by a direction (unit vector) that is not in it yet. */
static void widen(span *piece_span, const double direction[3])
{
  double rest[3] = {direction[0], direction[1], direction[2]};

  /* Take out what is in the span: twice is enough (Gram & Schmidt). */
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < piece_span->dimension; i++) {
      double along = thr_dot(rest, piece_span->basis[i]);
      thr_along(rest, -along, piece_span->basis[i], rest);
    }

  /* What is left is a new direction, unless it is as small as doubt. */
  double size = sqrt(thr_dot(rest, rest));
  if (piece_span->dimension == 3 || size <= DOUBT) return;
  for (int k = 0; k < 3; k++)
    piece_span->basis[piece_span->dimension][k] = rest[k] / size;
  piece_span->dimension++;
}

/* Computes the spans of all pieces. */
static void find_spans(const thr_frame *frame, const int *component, span *piece)
{
  for (int e = 0; e < frame->n_edges; e++) {
    double direction[3];
    unit_along(frame, 2 * e, direction);
    widen(&piece[component[frame->edge[e][0]]], direction);
  }
}

/* ---- the counts ---- */

/* Holds the input and scratch of the counts. */
typedef struct {
  const thr_frame *frame;
  int n_pieces;
  int *component; /* [n_nodes] */
  span *piece;    /* [n_pieces] */
  int *n_axes;    /* [n_nodes] */
  double (*axis)[3];
} rigidity_counts;

/* Returns the number of columns. */
static int axes(const rigidity_counts *counts)
{
  int sum = 0;
  for (int v = 0; v < counts->frame->n_nodes; v++)
    sum += counts->n_axes[v];
  return sum;
}

/* Counts the motions that stretch nothing, rigid ones among them. */
static thr_status freedoms(rigidity_counts *counts, int *count, bool *unclear, thr_err *err)
{
  /* Nullity = columns - rank. */
  int rank;
  thr_status st =
      rank_of(counts->frame, &(velocities){counts->n_axes, (const double(*)[3])counts->axis}, &rank,
              unclear, err);
  *count = axes(counts) - rank;
  return st;
}

/* Lets every node move in all directions. */
static void all_directions(rigidity_counts *counts)
{
  for (int v = 0; v < counts->frame->n_nodes; v++) {
    counts->n_axes[v] = 3;
    memset(counts->axis[3 * v], 0, 3 * sizeof *counts->axis);
    for (int i = 0; i < 3; i++)
      counts->axis[3 * v + i][i] = 1;
  }
}

/* Counts motions and self-stresses: free, with the feet held, and within the planes of flat pieces.
 */
static thr_status count_motions(rigidity_counts *counts, thr_rigidity *out, thr_err *err)
{
  const thr_frame *frame = counts->frame;
  int freedom, feet = 0;

  /* Free nodes. A straight piece does not turn about itself. */
  all_directions(counts);
  out->flat = true;

  for (int k = 0; k < counts->n_pieces; k++) {
    out->rigid_motions += counts->piece[k].dimension == 1 ? 5 : 6;
    out->flat &= counts->piece[k].dimension == 2;
  }

  /* Maxwell's count: motions beyond those of rigid pieces, and states of self-stress. */
  thr_status st = freedoms(counts, &freedom, &out->unclear, err);
  out->rank = 3 * frame->n_nodes - freedom;
  out->motions = freedom - out->rigid_motions;
  out->self_stresses = frame->n_edges - out->rank;

  /* The same with the feet held. */
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot[v]) counts->n_axes[v] = 0, feet++;
  out->pinned = freedom;
  if (!st && feet > 0) st = freedoms(counts, &out->pinned, &out->unclear, err);

  /* Within the planes, where a rigid piece has 3 motions. */
  if (st || !out->flat) return st;
  for (int v = 0; v < frame->n_nodes; v++) {
    counts->n_axes[v] = 2;
    memcpy(counts->axis[3 * v], counts->piece[counts->component[v]].basis,
           2 * sizeof *counts->axis);
  }

  st = freedoms(counts, &freedom, &out->unclear, err);
  out->plane_motions = freedom - 3 * counts->n_pieces;

  return st;
}

/* Counts motions and self-stresses; see beads.h. */
thr_status thr_rigidity_find(const thr_frame *frame, thr_rigidity *out, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *out = (thr_rigidity){0};

  /* Pieces and their spans, then the counts. */
  rigidity_counts counts = {.frame = frame,
                            .component = thr_calloc(n, sizeof *counts.component),
                            .piece = thr_calloc(n, sizeof *counts.piece),
                            .n_axes = thr_calloc(n, sizeof *counts.n_axes),
                            .axis = thr_calloc(3 * n, sizeof *counts.axis)};
  thr_status st =
      counts.component && counts.piece && counts.n_axes && counts.axis ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, counts.component, &counts.n_pieces, err);
  if (!st) {
    find_spans(frame, counts.component, counts.piece);
    st = count_motions(&counts, out, err);
  }

  free(counts.component);
  free(counts.piece);
  free(counts.n_axes);
  free(counts.axis);
  return st;
}
