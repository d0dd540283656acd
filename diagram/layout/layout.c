/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes candidate layouts, where each node goes on paper, and chooses the best of all: the
 * projections here, unrolled, spread and in panels in the other files of this folder.
 *
 * A candidate is judged by its faults (pairs of edges that cross on paper but not in space, and
 * edges too short for a bead), then by the ratio of its shortest edge to the median. Projections
 * are true to scale and come first; what is stretched has to be clearly better (CLEARLY) to be
 * taken.
 *
 * Example: a plan without crossings whose shortest edge is 0.87 of the median is taken at once,
 * since no ratio (at most 1) can be 1.25 times as large. */

#include "diagram/layout/layout.h"
#include "graph/number.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double MAX_COORDINATE = 1e100; /* squares must stay finite */
static const double CLEARLY = 1.25;         /* so much larger a ratio shows */
static const double LEGIBLE = 0.5;          /* ratio of a picture that needs no second panel */

/* Returns what a reader of a drawing is told about how the framework is seen. Sentences are in the
 * order of the kinds. */
const char *thr_layout_words(thr_layout_kind kind)
{
  static const char *const words[THR_LAYOUT_KINDS] = {
      "Plan, seen from above.",
      "Unrolled from the crown in the middle outwards, seen from outside (from above); distances "
      "around the middle are "
      "stretched.",
      "Elevation, seen from the front: x to the right, z up.",
      "Elevation, seen from the side: y to the right, z up.",
      "Seen at right angles to the plane that fits best, with the higher nodes up the page.",
      "Unrolled about the x axis, seen from outside (from the +x end, which is in the middle); "
      "distances around it are "
      "stretched.",
      "Unrolled about the y axis, seen from outside (from the +y end, which is in the middle); "
      "distances around it are "
      "stretched.",
      "Spread flat from the middle outwards, like a shell opened on the far side, seen from "
      "outside; beads far out look longer "
      "than they are.",
      "Two halves of a closed shell, both seen from outside: turn the shell half round about the "
      "page's vertical to get from one "
      "to the other. Places on their rims are on both.",
      "Schematic: which bead joins which is true, lengths and angles are not.",
      "Seen in space, from all four sides: what is far away is pale, and what lies behind a piece "
      "is "
      "hidden. Each step has its own picture in the booklet."};

  return (unsigned)kind < THR_LAYOUT_KINDS ? words[kind] : "";
}

/* Returns whether distances on paper are those in space, but for foreshortening. */
bool thr_layout_to_scale(thr_layout_kind kind)
{
  return kind == THR_LAYOUT_PLAN || kind == THR_LAYOUT_FRONT || kind == THR_LAYOUT_SIDE ||
         kind == THR_LAYOUT_PLANE;
}

/* Releases the arrays. */
void thr_layout_destroy(thr_layout *layout)
{
  free(layout->xy);
  free(layout->node);
  thr_frame_destroy(&layout->paper);
  *layout = (thr_layout){0};
}

/* Copies a layout with its arrays; the frame of its points is joined anew from the edges. *to is
 * unchanged on failure. */
thr_status thr_layout_copy(thr_layout *to, const thr_layout *from, thr_err *err)
{
  thr_layout layout = *from;
  size_t n = (size_t)from->n_points;
  thr_status st = THR_OK;

  /* The copy has arrays of its own, made before anything is filled in. */
  layout.paper = (thr_frame){0};
  layout.xy = thr_calloc(n, sizeof *layout.xy);
  layout.node = from->node ? thr_calloc(n, sizeof *layout.node) : NULL;
  if (!layout.xy || (from->node && !layout.node)) st = thr_nomem(err);

  /* A layout with points of its own has its own edges. */
  if (!st && from->node)
    st = thr_layout_join(&layout.paper, from->n_points, from->paper.n_edges,
                         (const int(*)[2])from->paper.edge, err);

  /* Out of memory: what was made is freed. */
  if (st) {
    thr_layout_destroy(&layout);
    return st;
  }

  /* All memory is there, so that nothing can fail from here on. */
  if (n) memcpy(layout.xy, from->xy, n * sizeof *layout.xy);
  if (layout.node) memcpy(layout.node, from->node, n * sizeof *layout.node);
  *to = layout;
  return THR_OK;
}

/* Makes a frame of points and edges without coordinates, only to be asked for ends and half-edges.
 * *paper is unchanged on failure. */
thr_status thr_layout_join(thr_frame *paper, int n_points, int n_edges, const int (*edge)[2],
                           thr_err *err)
{
  thr_frame frame = {.n_nodes = n_points, .n_edges = n_edges};

  /* What thr_frame_index fills: edges, and half-edges by node. */
  frame.edge = thr_calloc((size_t)frame.n_edges, sizeof *frame.edge);
  frame.first = thr_calloc((size_t)n_points + 1, sizeof *frame.first);
  frame.half = thr_calloc(2 * (size_t)frame.n_edges, sizeof *frame.half);

  if (!frame.edge || !frame.first || !frame.half) {
    thr_frame_destroy(&frame);
    return thr_nomem(err);
  }

  /* Edges are copied, half-edges follow from them. */
  memcpy(frame.edge, edge, (size_t)frame.n_edges * sizeof *frame.edge);
  thr_frame_index(&frame);
  *paper = frame;
  return THR_OK;
}

/* Returns whether a is clearly better than b: by fewer faults, else by a ratio more than CLEARLY
 * times as large. Neither of two nearly equal ones is better, so that the earlier one stays. */
bool thr_layout_better(const thr_layout *a, const thr_layout *b)
{
  long faults_a = a->crossings + a->squeezed, faults_b = b->crossings + b->squeezed;

  /* A fault misleads the hand, a small ratio only strains the eye. */
  if (faults_a != faults_b) return faults_a < faults_b;
  return a->ratio > CLEARLY * b->ratio;
}

/* Keeps the better one of two layouts in *best and frees the other. */
void thr_layout_keep_better(thr_layout *best, thr_layout *layout)
{
  if (!best->xy || thr_layout_better(layout, best)) {
    thr_layout swapped = *best;
    *best = *layout;
    *layout = swapped;
  }
  thr_layout_destroy(layout);
}

/* Projects all nodes onto a plane: right and up are unit vectors at right angles. */
static void project(thr_layout *layout, const thr_frame *frame, const double right[3],
                    const double up[3])
{
  for (int v = 0; v < frame->n_nodes; v++) {
    layout->xy[v][0] = thr_dot(frame->xyz[v], right);
    layout->xy[v][1] = thr_dot(frame->xyz[v], up);
  }
}

/* ---- best-fit plane ---- */

/* Makes one Jacobi rotation, which zeroes element p, q of a symmetric matrix; vectors collects the
 * eigenvectors as columns. The angle phi has cot(2 phi) = (a_qq - a_pp) / (2 a_pq); t = tan(phi) is
 * the smaller root of t^2 + 2 t cot(2 phi) - 1 = 0 (Golub & Van Loan, Matrix Computations). */
static void rotate(double matrix[3][3], double vectors[3][3], int p, int q)
{
  /* tan(phi), and from it cos(phi) and sin(phi). */
  if (matrix[p][q] == 0) return;
  double cotangent = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
  double tangent = (cotangent >= 0 ? 1 : -1) / (fabs(cotangent) + sqrt(cotangent * cotangent + 1)),
         cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;

  /* Columns, then rows; the eigenvectors are rotated as the columns. */
  for (int k = 0; k < 3; k++) {
    double x = matrix[k][p], y = matrix[k][q];
    matrix[k][p] = cosine * x - sine * y;
    matrix[k][q] = sine * x + cosine * y;
  }

  for (int k = 0; k < 3; k++) {
    double x = matrix[p][k], y = matrix[q][k];
    matrix[p][k] = cosine * x - sine * y;
    matrix[q][k] = sine * x + cosine * y;
    x = vectors[k][p], y = vectors[k][q];
    vectors[k][p] = cosine * x - sine * y;
    vectors[k][q] = sine * x + cosine * y;
  }
}

/* Computes the unit normal of the least-squares plane through the nodes: the eigenvector of the
 * least eigenvalue of the covariance matrix. The normal points towards the viewer: upwards, or for
 * a wall to the front (-y) or the side (+x). */
static void plane_normal(const thr_frame *frame, double normal[3])
{
  double mean[3], covariance[3][3] = {{0}}, vectors[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  /* The covariance matrix, but for a factor. */
  thr_layout_mean_point(frame, mean);
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        covariance[i][j] += (frame->xyz[v][i] - mean[i]) * (frame->xyz[v][j] - mean[j]);

  /* Each sweep makes the elements off the diagonal much smaller; 30 are more than enough for 3 x
   * 3. */
  for (int sweep = 0; sweep < 30; sweep++) {
    rotate(covariance, vectors, 0, 1);
    rotate(covariance, vectors, 0, 2);
    rotate(covariance, vectors, 1, 2);
  }

  /* The least eigenvalue, and its vector. */
  int least = 2;
  for (int i = 1; i >= 0; i--)
    if (covariance[i][i] < covariance[least][least]) least = i;
  for (int i = 0; i < 3; i++)
    normal[i] = vectors[i][least];

  /* Of a normal and its opposite that is taken which points to the viewer. */
  double sign = fabs(normal[2]) > 1e-6   ? normal[2]
                : fabs(normal[1]) > 1e-6 ? -normal[1]
                                         : normal[0];
  for (int i = 0; i < 3 && sign < 0; i++)
    normal[i] = -normal[i];
}

/* Projects all nodes at right angles onto the best-fit plane, with the higher ones up the page. */
static void project_plane(thr_layout *layout, const thr_frame *frame)
{
  double normal[3], up[3], right[3];

  plane_normal(frame, normal);

  /* Near the horizontal, "higher up the page" would turn the sheet for a trifle: y stays up. */
  const double top[3] = {0, normal[2] > 0.95, normal[2] <= 0.95};

  /* The part of that direction that lies in the plane, as a unit vector. */
  double along = thr_dot(top, normal);
  thr_along(top, -along, normal, up);
  thr_normalize(up);

  /* To the right on paper, so that right, up and normal are right-handed. */
  thr_cross(up, normal, right);
  project(layout, frame, right, up);
}

/* ---- candidates ---- */

/* Lays the nodes out as the layout's kind says. */
static thr_status place(thr_layout *layout, const thr_frame *frame, thr_err *err)
{
  static const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};

  /* Axes of the projections; the third axis points to the viewer. */
  switch (layout->kind) {
  case THR_LAYOUT_PLAN: project(layout, frame, x, y); return THR_OK;
  case THR_LAYOUT_FRONT: project(layout, frame, x, z); return THR_OK;
  case THR_LAYOUT_SIDE: project(layout, frame, y, z); return THR_OK;
  case THR_LAYOUT_PLANE: project_plane(layout, frame); return THR_OK;
  case THR_LAYOUT_UNROLLED_X: return thr_layout_unroll(layout, frame, 0, err);
  case THR_LAYOUT_UNROLLED_Y: return thr_layout_unroll(layout, frame, 1, err);
  case THR_LAYOUT_UNROLLED_Z: return thr_layout_unroll(layout, frame, 2, err);
  case THR_LAYOUT_SPREAD: return thr_layout_spread(layout, frame, err);
  default:
    return thr_fail(err, THR_EINPUT, "layout kind %d cannot be made from coordinates",
                    (int)layout->kind);
  }
}

/* Makes one candidate and measures it. *out is empty on failure. */
thr_status thr_layout_make(thr_layout *out, const thr_frame *frame, thr_layout_kind kind,
                           thr_err *err)
{
  thr_layout layout = {.n_nodes = frame->n_nodes, .n_points = frame->n_nodes, .kind = kind};

  *out = (thr_layout){0};

  /* Coordinates whose squares overflow cannot be measured. */
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      if (!(fabs(frame->xyz[v][i]) < MAX_COORDINATE))
        return thr_fail(err, THR_EINPUT, "node %d lies at %g: too far to be drawn", v,
                        frame->xyz[v][i]);

  /* Panels have more points than nodes, and so allocate for themselves. */
  if (kind == THR_LAYOUT_PANELS) return thr_layout_panels(out, frame, err);
  layout.xy = thr_calloc((size_t)frame->n_nodes, sizeof *layout.xy);
  if (!layout.xy) return thr_nomem(err);

  /* Where the nodes lie, and how good that is. */
  thr_status st = place(&layout, frame, err);
  if (!st) st = thr_layout_measure(&layout, frame, err);
  if (st) thr_layout_destroy(&layout);
  *out = layout;
  return st;
}

/* Takes over coordinates made elsewhere and measures them. *out is empty on failure. */
thr_status thr_layout_adopt(thr_layout *out, const thr_frame *frame, const double (*xy)[2],
                            thr_err *err)
{
  thr_layout layout = {
      .n_nodes = frame->n_nodes, .n_points = frame->n_nodes, .kind = THR_LAYOUT_DRAWN};

  /* Coordinates from a file or an algorithm may be anything. */
  for (int v = 0; v < frame->n_nodes; v++)
    if (!(fabs(xy[v][0]) < MAX_COORDINATE && fabs(xy[v][1]) < MAX_COORDINATE))
      return thr_fail(err, THR_EINPUT, "node %d of the layout has no finite place on paper", v);

  layout.xy = thr_calloc((size_t)frame->n_nodes, sizeof *layout.xy);
  if (!layout.xy) return thr_nomem(err);
  if (frame->n_nodes) memcpy(layout.xy, xy, (size_t)frame->n_nodes * sizeof *layout.xy);

  /* Faults and ratio of the foreign layout. */
  thr_status st = thr_layout_measure(&layout, frame, err);
  if (st) thr_layout_destroy(&layout);
  *out = layout;
  return st;
}

/* Returns whether a single picture is good enough that two panels would only be a nuisance. */
static bool legible(const thr_layout *layout)
{
  return !layout->crossings && !layout->squeezed && layout->ratio >= LEGIBLE;
}

/* Draws the best layout so far anew with the algorithm of Kamada & Kawai (1989), from where it is
 * or from a circle, and keeps the result if that is better. Springs between all pairs of nodes have
 * the lengths of the shortest paths. */
static thr_status try_drawing(thr_layout *best, const thr_frame *frame, bool circle, thr_err *err)
{
  /* The algorithm starts from a copy, for the best layout is still needed. */
  thr_layout layout = {0};
  double(*xy)[2] = thr_calloc((size_t)frame->n_nodes, sizeof *xy);
  if (!xy) return thr_nomem(err);
  memcpy(xy, best->xy, (size_t)frame->n_nodes * sizeof *xy);

  /* Springs as long as the edges in space. */
  thr_status st = thr_kamada_kawai(frame->n_nodes, frame->n_edges, (const int(*)[2])frame->edge,
                                   frame->length, circle, xy, err);
  if (!st) st = thr_layout_adopt(&layout, frame, (const double(*)[2])xy, err);

  if (!st) thr_layout_keep_better(best, &layout);
  free(xy);
  return st;
}

/* Makes the candidates in order and keeps the better one each time; stops early where no further
 * one could be clearly better. */
thr_status thr_layout_choose(thr_layout *out, const thr_frame *frame, const thr_layout *extra,
                             int n_extra, thr_err *err)
{
  thr_layout best = {0}, candidate = {0};
  thr_status st = THR_OK;

  /* Only the plan must succeed: a flat or an open framework has no such view as some others, which
   * are skipped. */
  for (int kind = THR_LAYOUT_PLAN; kind < THR_LAYOUT_DRAWN; kind++) {
    thr_err flat = {0};

    /* Two panels are a nuisance if one picture is legible. */
    if (kind == THR_LAYOUT_PANELS && legible(&best)) break;
    st = thr_layout_make(&candidate, frame, (thr_layout_kind)kind,
                         kind == THR_LAYOUT_PLAN ? err : &flat);
    if (st == THR_EINPUT && kind != THR_LAYOUT_PLAN) continue;
    if (st) {
      st = kind == THR_LAYOUT_PLAN ? st : thr_fail(err, st, "%s", flat.text);
      goto done;
    }

    /* A plan without crossings and with a ratio near 1 cannot be beaten. */
    thr_layout_keep_better(&best, &candidate);
    if (kind == THR_LAYOUT_PLAN && best.crossings == 0 && best.ratio >= 1 / CLEARLY) break;
  }

  /* Only where all pictures have crossings: a drawing by springs, from two starts. */
  bool tangled = best.crossings && frame->n_nodes <= THR_LAYOUT_DRAWN_NODES;
  st = tangled ? try_drawing(&best, frame, false, err) : THR_OK;
  if (tangled && !st) st = try_drawing(&best, frame, true, err);
  if (st) goto done;

  /* Layouts that the caller has made. */
  for (int i = 0; i < n_extra; i++) {
    if (!thr_layout_better(&extra[i], &best)) continue;
    st = thr_layout_copy(&candidate, &extra[i], err);
    if (st) goto done;
    thr_layout_keep_better(&best, &candidate);
  }

done:
  if (st) thr_layout_destroy(&best);
  *out = best;
  return st;
}

/* ---- around a node ---- */

/* Sorts the half-edges at each node by their angle, equal ones by their number. O(m
 * log(degree)). */
thr_status thr_layout_around(const thr_frame *frame, const double *angle, int *around, thr_err *err)
{
  thr_ranked *ranked = thr_calloc((size_t)frame->n_edges * 2, sizeof *ranked);
  if (!ranked) return thr_nomem(err);

  /* The half-edges of a node with their angles as keys. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int first = frame->first[v], degree = thr_degree(frame, v);
    for (int i = 0; i < degree; i++)
      ranked[i] = (thr_ranked){angle[frame->half[first + i]], frame->half[first + i]};

    thr_sort_ranked(ranked, (size_t)degree);
    for (int i = 0; i < degree; i++)
      around[first + i] = ranked[i].index;
  }

  free(ranked);
  return THR_OK;
}
