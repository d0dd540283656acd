/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Isometries of a framework from its coordinates: two reference nodes may go to few places, and
 * where they go fixes the motion up to a mirror; every such motion is refined by Procrustes
 * analysis and verified on all nodes and edges. */
#include "graph/scratch.h"
#include "graph/vector.h"
#include "symmetry/group/group.h"
#include "symmetry/group/groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  ROUNDS = 8, /* of matching and refining: two or three suffice unless nodes crowd */
  TRIES = 4   /* motions that send every node near another but match otherwise, for each isometry
                 allowed */
};
/* Nodes moved and nodes near them: about a second. A count and not a time, so that the result is
 * always the same. */
static const int64_t MOST_WORK = INT64_C(1) << 28;

/* A node as it may be mistaken for others: by kind (colour, degree and foot) and distance from the
 * centroid. */
typedef struct {
  int64_t kind;
  int node;
  double radius;
} likeness;

typedef struct {
  const thr_frame *f;
  const thr_limits *limits;
  const thr_automorphism_options *colours;
  double tolerance; /* in parts of size, of every node */
  double centroid[3], size;
  thr_scratch own;      /* the arrays */
  double (*x)[3];       /* [n_nodes] from the centroid, in parts of size */
  double *radius, most; /* [n_nodes] and the largest */
  int64_t *kind;        /* [n_nodes] */
  likeness *like;       /* [n_nodes] by kind and radius */
  int first, second;    /* reference nodes; second < 0: all on a line */
  double loose;         /* how far a motion from two references may be off at any node */
  int side, *cell_first,
      *cell;         /* side^3 cells; their nodes: cell[cell_first[c] .. cell_first[c + 1] - 1] */
  int *image, *next; /* [n_nodes] of the motion at hand */
  bool *hit;         /* [n_nodes] */
  int *found, count, capacity; /* [count * n_nodes] */
  int tried;                   /* motions that sent every node near another, as none before */
  int64_t work;                /* see MOST_WORK */
} search;

static int by_likeness(const void *a, const void *b)
{
  const likeness *p = a, *q = b;
  if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
  if (p->radius != q->radius) return p->radius < q->radius ? -1 : 1;
  return (p->node > q->node) - (p->node < q->node);
}

/* Index of the first entry of like that is not below this kind and radius. */
static int lower(const search *s, int64_t kind, double radius)
{
  likeness key = {kind, -1, radius};
  int low = 0, high = s->f->n_nodes;
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (by_likeness(&s->like[middle], &key) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Entries of like where node v may go: *end - returned are how many. */
static int places(const search *s, int v, int *end)
{
  *end = lower(s, s->kind[v], nextafter(s->radius[v] + s->tolerance, INFINITY));
  return lower(s, s->kind[v], s->radius[v] - s->tolerance);
}

static int count_places(const search *s, int v)
{
  int end, begin = places(s, v, &end);
  return end - begin;
}

/* Distance of node v from the line through the centroid and node u. */
static double off_line(const search *s, int u, int v)
{
  double c[3];
  thr_cross(s->x[u], s->x[v], c);
  return sqrt(thr_dot(c, c)) / s->radius[u];
}

/* The references: with the fewest places among those that are far enough out to fix the motion
 * well. */
static void choose_references(search *s)
{
  int n = s->f->n_nodes, best = -1;
  double widest = 0;
  for (int v = 0; v < n; v++) {
    if (s->radius[v] < 0.5) continue;
    int count = count_places(s, v);
    if (best >= 0 && count >= best) continue;
    best = count;
    s->first = v;
  }
  for (int v = 0; v < n; v++)
    widest = fmax(widest, off_line(s, s->first, v));
  s->second = best = -1;
  for (int v = 0; v < n && widest > 1e-4 + 2 * s->tolerance; v++) {
    if (off_line(s, s->first, v) < 0.5 * widest) continue;
    int count = count_places(s, v);
    if (best >= 0 && count >= best) continue;
    best = count;
    s->second = v;
  }
  double r = s->radius[s->first], lever = s->most / r;
  if (s->second >= 0) lever += s->most * (1 + s->most / r) / off_line(s, s->first, s->second);
  s->loose = 2 * s->tolerance * (1 + lever) + (s->second >= 0 ? 0 : 2 * widest);
}

static int axis_cell(const search *s, double x)
{
  int i = (int)floor((x + s->most) / (2 * s->most) * s->side);
  return i < 0 ? 0 : i >= s->side ? s->side - 1 : i;
}

static int cell_of(const search *s, const double x[3])
{
  return (axis_cell(s, x[0]) * s->side + axis_cell(s, x[1])) * s->side + axis_cell(s, x[2]);
}

/* Cells no narrower than loose, up to sixteen per node, since frameworks are surfaces and lines. */
static thr_status fill_cells(search *s, thr_err *err)
{
  int n = s->f->n_nodes;
  double fit = fmin(fmin(2 * s->most / s->loose, cbrt(16.0 * n)), 256);
  s->side = fit < 1 ? 1 : (int)fit;
  int cells = s->side * s->side * s->side;
  s->cell_first = thr_scratch_array(&s->own, (size_t)cells + 2, sizeof *s->cell_first);
  s->cell = thr_scratch_array(&s->own, (size_t)n, sizeof *s->cell);
  thr_status st = thr_scratch_check(&s->own, err);
  if (st) return st;
  for (int v = 0; v < n; v++)
    s->cell_first[cell_of(s, s->x[v]) + 2]++;
  for (int c = 0; c < cells; c++)
    s->cell_first[c + 2] += s->cell_first[c + 1];
  for (int v = 0; v < n; v++)
    s->cell[s->cell_first[cell_of(s, s->x[v]) + 1]++] = v;
  return THR_OK;
}

static thr_status search_init(search *s, thr_err *err)
{
  const thr_frame *frame = s->f;
  size_t n = (size_t)frame->n_nodes;
  s->x = thr_scratch_array(&s->own, n, sizeof *s->x);
  s->radius = thr_scratch_array(&s->own, n, sizeof *s->radius);
  s->kind = thr_scratch_array(&s->own, n, sizeof *s->kind);
  s->like = thr_scratch_array(&s->own, n, sizeof *s->like);
  s->image = thr_scratch_array(&s->own, n, sizeof *s->image);
  s->next = thr_scratch_array(&s->own, n, sizeof *s->next);
  s->hit = thr_scratch_array(&s->own, n, sizeof *s->hit);
  thr_status st = thr_scratch_check(&s->own, err);
  if (st) return st;
  thr_frame_extent(frame, s->centroid, &s->size);
  for (int v = 0; v < frame->n_nodes; v++) {
    for (int i = 0; i < 3; i++)
      s->x[v][i] = (frame->xyz[v][i] - s->centroid[i]) / s->size;
    s->radius[v] = sqrt(thr_dot(s->x[v], s->x[v]));
    s->most = fmax(s->most, s->radius[v]);
    int64_t colour = s->colours->node_colour ? s->colours->node_colour[v] : 0;
    s->kind[v] = colour * (INT64_C(1) << 32) + 2 * (int64_t)thr_degree(frame, v) + frame->foot[v];
    s->like[v] = (likeness){s->kind[v], v, s->radius[v]};
  }
  qsort(s->like, n, sizeof *s->like, by_likeness);
  choose_references(s);
  return fill_cells(s, err);
}

/* The node of this kind nearest to x within loose; -1: none. */
static int nearest(search *s, const double x[3], int64_t kind)
{
  int low[3], high[3], best = -1;
  double least = s->loose * s->loose;
  for (int i = 0; i < 3; i++) {
    low[i] = axis_cell(s, x[i] - s->loose);
    high[i] = axis_cell(s, x[i] + s->loose);
  }
  for (int i = low[0]; i <= high[0]; i++)
    for (int j = low[1]; j <= high[1]; j++) {
      const int *row = &s->cell_first[(i * s->side + j) * s->side];
      s->work += row[high[2] + 1] - row[low[2]];
      for (int k = row[low[2]]; k < row[high[2] + 1]; k++) { /* cells of a row stand together */
        int v = s->cell[k];
        if (s->kind[v] != kind) continue;
        double d[3] = {x[0] - s->x[v][0], x[1] - s->x[v][1], x[2] - s->x[v][2]},
               square = thr_dot(d, d);
        if (square > least || (square == least && best >= 0)) continue;
        least = square;
        best = v;
      }
    }
  return best;
}

/* Where q moves every node, into image; false: some node to none. */
static bool match(search *s, double q[3][3], int *image)
{
  for (int v = 0; v < s->f->n_nodes; v++) {
    double moved[3] = {thr_dot(q[0], s->x[v]), thr_dot(q[1], s->x[v]), thr_dot(q[2], s->x[v])};
    s->work++;
    image[v] = nearest(s, moved, s->kind[v]);
    if (image[v] < 0) return false;
  }
  return true;
}

int thr_edge_joining(const thr_frame *frame, int a, int b)
{
  bool fewer = thr_degree(frame, a) <= thr_degree(frame, b);
  return thr_frame_edge_between(frame, fewer ? a : b, fewer ? b : a);
}

static bool is_automorphism(search *s)
{
  const thr_frame *frame = s->f;
  memset(s->hit, 0, (size_t)frame->n_nodes * sizeof *s->hit);
  for (int v = 0; v < frame->n_nodes; v++) {
    if (s->hit[s->image[v]]) return false;
    s->hit[s->image[v]] = true;
  }
  for (int e = 0; e < frame->n_edges; e++) {
    int to = thr_edge_joining(frame, s->image[frame->edge[e][0]], s->image[frame->edge[e][1]]);
    s->work++;
    if (to < 0 ||
        (s->colours->edge_colour && s->colours->edge_colour[to] != s->colours->edge_colour[e]))
      return false;
  }
  return true;
}

static bool is_known(const search *s)
{
  size_t n = (size_t)s->f->n_nodes;
  for (int k = 0; k < s->count; k++)
    if (memcmp(&s->found[(size_t)k * n], s->image, n * sizeof *s->found) == 0) return true;
  return false;
}

static thr_status keep(search *s, int cap, thr_err *err)
{
  size_t n = (size_t)s->f->n_nodes, row = n * sizeof *s->found;
  if (is_known(s)) return THR_OK;
  if (s->count >= cap) return thr_fail(err, THR_ELIMIT, "more than %d isometries", cap);
  thr_status st = thr_grow(&s->found, s->count, &s->capacity, row, err);
  if (!st) memcpy(&s->found[(size_t)s->count++ * n], s->image, row);
  return st;
}

static thr_status too_many(const search *s, thr_err *err)
{
  return thr_fail(err, THR_ELIMIT,
                  "tolerance %g is too large for nodes so near to each other: too many motions fit",
                  s->tolerance);
}

/* Refines the motion until its matching is an isometry, or stays the same without being one. */
static thr_status try_motion(search *s, double q[3][3], int cap, thr_err *err)
{
  size_t row = (size_t)s->f->n_nodes * sizeof *s->image;
  if (!match(s, q, s->image) || is_known(s)) return THR_OK;
  if (s->tried++ / TRIES > cap + 256) return too_many(s, err);
  for (int round = 0; round < ROUNDS; round++) {
    thr_motion motion;
    thr_procrustes(s->f, s->image, &motion);
    if (motion.farthest <= s->tolerance && is_automorphism(s)) return keep(s, cap, err);
    if (!match(s, motion.q, s->next) || memcmp(s->next, s->image, row) == 0) return THR_OK;
    memcpy(s->image, s->next, row);
  }
  return THR_OK;
}

/* Orthonormal rows: towards a, across it towards b, across both. false: a and b are on a line. */
static bool base_of(const double *a, const double *b, double base[3][3])
{
  double across[3];
  thr_cross(a, b, across);
  double norm = sqrt(thr_dot(a, a)), wide = sqrt(thr_dot(across, across));
  if (norm <= 0 || wide <= 0) return false;
  for (int i = 0; i < 3; i++) {
    base[0][i] = a[i] / norm;
    base[2][i] = across[i] / wide;
  }
  thr_cross(base[2], base[0], base[1]);
  return true;
}

/* The motion that takes the references' base to another, and the one that is mirrored at the plane
 * of both besides. */
static thr_status try_bases(search *s, double from[3][3], double to[3][3], int cap, thr_err *err)
{
  thr_status st = THR_OK;
  for (int sign = 1; sign >= -1 && !st; sign -= 2) {
    double q[3][3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        q[i][j] = to[0][i] * from[0][j] + to[1][i] * from[1][j] + sign * to[2][i] * from[2][j];
    st = try_motion(s, q, cap, err);
  }
  return st;
}

static double distance(const double *a, const double *b)
{
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(thr_dot(d, d));
}

/* On a line the identity and the reversal are all there is. */
static thr_status try_line(search *s, int cap, thr_err *err)
{
  thr_status st = THR_OK;
  for (int sign = 1; sign >= -1 && !st; sign -= 2) {
    double q[3][3] = {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}};
    st = try_motion(s, q, cap, err);
  }
  return st;
}

static thr_status try_all(search *s, int cap, thr_err *err)
{
  double from[3][3], to[3][3];
  const double *a = s->x[s->first], *b = s->x[s->second];
  int first_end, second_end, first = places(s, s->first, &first_end),
                             second = places(s, s->second, &second_end);
  thr_status st = THR_OK;
  if (!base_of(a, b, from)) return THR_OK;
  for (int i = first; i < first_end && !st; i++)
    for (int j = second; j < second_end && !st; j++) {
      const double *c = s->x[s->like[i].node], *d = s->x[s->like[j].node];
      if (s->work++ > MOST_WORK || thr_limits_stop(s->limits)) return too_many(s, err);
      if (fabs(distance(a, b) - distance(c, d)) > 2 * s->tolerance || !base_of(c, d, to)) continue;
      st = try_bases(s, from, to, cap, err);
    }
  return st;
}

thr_status thr_isometries_find(const thr_frame *frame, const thr_automorphism_options *colours,
                               double tolerance, int cap, const thr_limits *limits, int **out,
                               int *count, thr_err *err)
{
  const thr_automorphism_options none = {0};
  search s = {.f = frame,
              .limits = limits,
              .colours = colours ? colours : &none,
              .tolerance = tolerance + THR_ISOMETRY_ROUNDING};
  *out = NULL;
  *count = 0;
  thr_status st = search_init(&s, err);
  if (!st) st = s.second < 0 ? try_line(&s, cap, err) : try_all(&s, cap, err);
  if (!st) st = thr_rows_sort(s.found, s.count, frame->n_nodes, NULL, err);
  thr_scratch_free(&s.own);
  if (st) {
    free(s.found);
    return st;
  }
  *out = s.found;
  *count = s.count;
  return st;
}

/* ---- the isometries among listed automorphisms ---- */

thr_status thr_isometries_among(const thr_frame *frame, const int *image, int n, double tolerance,
                                int **out, int *count, thr_err *err)
{
  size_t row = (size_t)frame->n_nodes;
  *count = 0;
  *out = thr_calloc((size_t)n * row, sizeof **out);
  if (!*out) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    thr_motion motion;
    thr_procrustes(frame, image + (size_t)i * row, &motion);
    if (motion.farthest <= tolerance + THR_ISOMETRY_ROUNDING)
      memcpy(*out + (size_t)(*count)++ * row, image + (size_t)i * row, row * sizeof *image);
  }
  return THR_OK;
}

/* ---- edge lengths ---- */

typedef struct {
  double length;
  int edge;
} measured;

static int by_length(const void *a, const void *b)
{
  const measured *p = a, *q = b;
  if (p->length != q->length) return p->length < q->length ? -1 : 1;
  return (p->edge > q->edge) - (p->edge < q->edge);
}

thr_status thr_length_colours(const thr_frame *frame, double tolerance, int *colour, thr_err *err)
{
  measured *m = thr_calloc((size_t)frame->n_edges, sizeof *m);
  double centroid[3], size;
  if (!m) return thr_nomem(err);
  thr_frame_extent(frame, centroid, &size);
  for (int e = 0; e < frame->n_edges; e++)
    m[e] = (measured){frame->length[e], e};
  qsort(m, (size_t)frame->n_edges, sizeof *m, by_length);
  double step = 2 * (tolerance + 2 * THR_ISOMETRY_ROUNDING) *
                size; /* an isometry moves either end by the tolerance at most */
  for (int i = 0, last = 0; i < frame->n_edges; i++) {
    last += i > 0 && m[i].length - m[i - 1].length > step;
    colour[m[i].edge] = last;
  }
  free(m);
  return THR_OK;
}
