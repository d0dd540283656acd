/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the isometries of a framework from its coordinates.
 *
 * Two reference nodes may go to few places, and where they go fixes the motion up to a mirror.
 * Every such motion is applied to all nodes, whose nearest nodes of their kind (in a grid of cells)
 * make a matching; the motion is refined by Procrustes analysis of the matching (P. Schoenemann
 * 1966), and the matching verified on all nodes and edges.
 *
 * Example: on a cube a corner may go to 8 places and a neighbour of it then to 3, each with and
 * without a mirror: the 48 isometries. */
#include "graph/arrays.h"
#include "graph/number.h"
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
/* Nodes that are moved and nodes that are compared: about a second. A count and not a time, so that
 * the result is always the same. */
static const int64_t MOST_WORK = INT64_C(1) << 28;

/* A node and what it can be mistaken for: nodes of its kind (colour, degree and foot) at its
 * distance from the centroid. */
typedef struct {
  int64_t kind;
  int node;
  double radius;
} node_likeness;

/* The search, and the isometries found so far. */
typedef struct {
  const thr_frame *frame;
  const thr_limits *limits;
  const thr_automorphism_options *colours;
  double tolerance; /* in parts of size, of every node */
  double centroid[3], size;
  thr_scratch own;       /* the arrays */
  double (*position)[3]; /* [n_nodes] from the centroid, in parts of size */
  double *radius, most;  /* [n_nodes] and the largest */
  int64_t *kind;         /* [n_nodes] */
  node_likeness *like;   /* [n_nodes] by kind and radius */
  int first, second;     /* reference nodes; second < 0: all on a line */
  double loose;          /* how far a motion from two references may be off at any node */
  int side, *cell_first,
      *cell;         /* side^3 cells; their nodes: cell[cell_first[c] .. cell_first[c + 1] - 1] */
  int *image, *next; /* [n_nodes] of the present motion */
  bool *hit;         /* [n_nodes] */
  int *found, count, capacity; /* [count * n_nodes] */
  int tried;                   /* motions that sent every node near another, as none before */
  int64_t work;                /* see MOST_WORK */
} isometry_search;

/* Compares entries by kind, radius and node. */
static int by_likeness(const void *a, const void *b)
{
  const node_likeness *first_entry = a, *second_entry = b;
  if (first_entry->kind != second_entry->kind)
    return first_entry->kind < second_entry->kind ? -1 : 1;
  if (first_entry->radius != second_entry->radius)
    return first_entry->radius < second_entry->radius ? -1 : 1;
  return (first_entry->node > second_entry->node) - (first_entry->node < second_entry->node);
}

/* Returns the index of the first entry of like that is not below this kind and radius. */
static int lower_bound(const isometry_search *search, int64_t kind, double radius)
{
  node_likeness key = {kind, -1, radius};
  int low = 0, high = search->frame->n_nodes;
  /* Bisection. */
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (by_likeness(&search->like[middle], &key) < 0)
      low = middle + 1;
    else
      high = middle;
  }

  return low;
}

/* Finds the entries of like where node v may go: returned .. *end - 1. */
static int find_places(const isometry_search *search, int v, int *end)
{
  *end = lower_bound(search, search->kind[v],
                     nextafter(search->radius[v] + search->tolerance, INFINITY));
  return lower_bound(search, search->kind[v], search->radius[v] - search->tolerance);
}

/* Returns how many there are. */
static int count_places(const isometry_search *search, int v)
{
  int end, begin = find_places(search, v, &end);
  return end - begin;
}

/* Returns the distance of node v from the line through the centroid and node u. */
static double off_line(const isometry_search *search, int u, int v)
{
  double cross[3];
  thr_cross(search->position[u], search->position[v], cross);
  return sqrt(thr_dot(cross, cross)) / search->radius[u];
}

/* Chooses the reference nodes: of those that are far enough from the centroid, and from the line
 * through the first, to fix the motion well, the ones that may go to the fewest places. Also
 * computes how far a motion from two references may be off. */
static void choose_references(isometry_search *search)
{
  int n_nodes = search->frame->n_nodes, best = -1;
  double widest = 0;

  /* The first: not near the centroid. */
  for (int v = 0; v < n_nodes; v++) {
    if (search->radius[v] < 0.5) continue;
    int count = count_places(search, v);
    if (best >= 0 && count >= best) continue;
    best = count;
    search->first = v;
  }

  /* The second: not near that line, unless all are. */
  for (int v = 0; v < n_nodes; v++)
    widest = fmax(widest, off_line(search, search->first, v));

  search->second = best = -1;
  for (int v = 0; v < n_nodes && widest > 1e-4 + 2 * search->tolerance; v++) {
    if (off_line(search, search->first, v) < 0.5 * widest) continue;
    int count = count_places(search, v);
    if (best >= 0 && count >= best) continue;
    best = count;
    search->second = v;
  }

  /* Errors at the references grow with the distance from them. */
  double radius = search->radius[search->first], lever = search->most / radius;
  if (search->second >= 0)
    lever += search->most * (1 + search->most / radius) /
             off_line(search, search->first, search->second);
  search->loose = 2 * search->tolerance * (1 + lever) + (search->second >= 0 ? 0 : 2 * widest);
}

/* Returns the number of a cell along one axis. */
static int axis_cell(const isometry_search *search, double point)
{
  int i = (int)floor((point + search->most) / (2 * search->most) * search->side);
  return i < 0 ? 0 : i >= search->side ? search->side - 1 : i;
}

/* Returns the cell of a point. */
static int cell_of(const isometry_search *search, const double point[3])
{
  return (axis_cell(search, point[0]) * search->side + axis_cell(search, point[1])) * search->side +
         axis_cell(search, point[2]);
}

/* Sorts the nodes into cells no narrower than loose, at most sixteen a node, since frameworks are
 * surfaces and lines. */
static thr_status fill_cells(isometry_search *search, thr_err *err)
{
  int n_nodes = search->frame->n_nodes;
  /* The number of cells along an axis. */
  double fit = fmin(fmin(2 * search->most / search->loose, cbrt(16.0 * n_nodes)), 256);
  search->side = fit < 1 ? 1 : (int)fit;

  int cells = search->side * search->side * search->side;
  search->cell_first =
      thr_scratch_array(&search->own, (size_t)cells + 2, sizeof *search->cell_first);
  search->cell = thr_scratch_array(&search->own, (size_t)n_nodes, sizeof *search->cell);
  thr_status st = thr_scratch_check(&search->own, err);
  if (st) return st;

  /* Count, two places further on, and fill. */
  for (int v = 0; v < n_nodes; v++)
    search->cell_first[cell_of(search, search->position[v]) + 2]++;
  for (int c = 0; c < cells; c++)
    search->cell_first[c + 2] += search->cell_first[c + 1];
  for (int v = 0; v < n_nodes; v++)
    search->cell[search->cell_first[cell_of(search, search->position[v]) + 1]++] = v;
  return THR_OK;
}

/* Allocates search, and prepares positions, kinds, references and cells. */
static thr_status search_init(isometry_search *search, thr_err *err)
{
  const thr_frame *frame = search->frame;
  size_t n = (size_t)frame->n_nodes;
  search->position = thr_scratch_array(&search->own, n, sizeof *search->position);
  search->radius = thr_scratch_array(&search->own, n, sizeof *search->radius);
  search->kind = thr_scratch_array(&search->own, n, sizeof *search->kind);
  search->like = thr_scratch_array(&search->own, n, sizeof *search->like);
  search->image = thr_scratch_array(&search->own, n, sizeof *search->image);
  search->next = thr_scratch_array(&search->own, n, sizeof *search->next);
  search->hit = thr_scratch_array(&search->own, n, sizeof *search->hit);
  thr_status st = thr_scratch_check(&search->own, err);
  if (st) return st;

  /* Positions from the centroid, kinds and radii. */
  thr_frame_extent(frame, search->centroid, &search->size);
  for (int v = 0; v < frame->n_nodes; v++) {
    for (int i = 0; i < 3; i++)
      search->position[v][i] = (frame->xyz[v][i] - search->centroid[i]) / search->size;

    search->radius[v] = sqrt(thr_dot(search->position[v], search->position[v]));
    search->most = fmax(search->most, search->radius[v]);
    /* The kind in one number. */
    int64_t colour = search->colours->node_colour ? search->colours->node_colour[v] : 0;
    search->kind[v] =
        colour * (INT64_C(1) << 32) + 2 * (int64_t)thr_degree(frame, v) + frame->foot[v];
    search->like[v] = (node_likeness){search->kind[v], v, search->radius[v]};
  }

  qsort(search->like, n, sizeof *search->like, by_likeness);
  choose_references(search);
  return fill_cells(search, err);
}

/* Returns the node of this kind that is nearest to a point, within loose; -1: none. */
static int nearest_node(isometry_search *search, const double point[3], int64_t kind)
{
  int low[3], high[3], best = -1;
  double least = search->loose * search->loose;

  /* Cells within reach. */
  for (int i = 0; i < 3; i++) {
    low[i] = axis_cell(search, point[i] - search->loose);
    high[i] = axis_cell(search, point[i] + search->loose);
  }

  /* All their nodes; cells of a row stand together. */
  for (int i = low[0]; i <= high[0]; i++)
    for (int j = low[1]; j <= high[1]; j++) {
      const int *row = &search->cell_first[(i * search->side + j) * search->side];
      search->work += row[high[2] + 1] - row[low[2]];
      for (int k = row[low[2]]; k < row[high[2] + 1]; k++) {
        /* Of its kind, and nearer than all before. */
        int v = search->cell[k];
        if (search->kind[v] != kind) continue;
        double d[3] = {point[0] - search->position[v][0], point[1] - search->position[v][1],
                       point[2] - search->position[v][2]},
               square = thr_dot(d, d);

        if (square > least || (square == least && best >= 0)) continue;
        least = square;
        best = v;
      }
    }

  return best;
}

/* Finds the node nearest to where a motion moves every node, into image; returns false if there is
 * none for some node. */
static bool match_nodes(isometry_search *search, double rotation[3][3], int *image)
{
  /* Move each node, and find what is there. */
  for (int v = 0; v < search->frame->n_nodes; v++) {
    double moved[3] = {thr_dot(rotation[0], search->position[v]),
                       thr_dot(rotation[1], search->position[v]),
                       thr_dot(rotation[2], search->position[v])};
    search->work++;
    image[v] = nearest_node(search, moved, search->kind[v]);
    if (image[v] < 0) return false;
  }
  return true;
}

int thr_edge_joining(const thr_frame *frame, int a, int b)
{
  bool fewer = thr_degree(frame, a) <= thr_degree(frame, b);
  return thr_frame_edge_between(frame, fewer ? a : b, fewer ? b : a);
}

/* Tells whether search->image is a permutation that keeps the edges and their colours. */
static bool is_automorphism(isometry_search *search)
{
  const thr_frame *frame = search->frame;
  memset(search->hit, 0, (size_t)frame->n_nodes * sizeof *search->hit);

  /* No two nodes may have one image. */
  for (int v = 0; v < frame->n_nodes; v++) {
    if (search->hit[search->image[v]]) return false;
    search->hit[search->image[v]] = true;
  }

  /* Edges go to edges of their colour. */
  for (int e = 0; e < frame->n_edges; e++) {
    int to =
        thr_edge_joining(frame, search->image[frame->edge[e][0]], search->image[frame->edge[e][1]]);
    search->work++;
    if (to < 0 || (search->colours->edge_colour &&
                   search->colours->edge_colour[to] != search->colours->edge_colour[e]))
      return false;
  }
  return true;
}

/* Tells whether search->image has been found before. */
static bool is_known(const isometry_search *search)
{
  size_t n = (size_t)search->frame->n_nodes;
  for (int k = 0; k < search->count; k++)
    if (memcmp(&search->found[(size_t)k * n], search->image, n * sizeof *search->found) == 0)
      return true;
  return false;
}

/* Keeps search->image, unless it is known. THR_ELIMIT: there are too many. */
static thr_status keep_image(isometry_search *search, int cap, thr_err *err)
{
  size_t n = (size_t)search->frame->n_nodes, row = n * sizeof *search->found;
  if (is_known(search)) return THR_OK;
  if (search->count >= cap) return thr_fail(err, THR_ELIMIT, "more than %d isometries", cap);
  thr_status st = thr_grow(&search->found, search->count, &search->capacity, row, err);
  if (!st) memcpy(&search->found[(size_t)search->count++ * n], search->image, row);
  return st;
}

/* Fails with THR_ELIMIT because too many motions fit. */
static thr_status fail_too_many(const isometry_search *search, thr_err *err)
{
  return thr_fail(err, THR_ELIMIT,
                  "tolerance %g is too large for nodes so near to each other: too many motions fit",
                  search->tolerance);
}

/* Refines a motion until its matching is an isometry, which is kept, or stays the same without
 * being one. */
static thr_status try_motion(isometry_search *search, double rotation[3][3], int cap, thr_err *err)
{
  size_t row = (size_t)search->frame->n_nodes * sizeof *search->image;

  /* Only a matching that is new. */
  if (!match_nodes(search, rotation, search->image) || is_known(search)) return THR_OK;
  if (search->tried++ / TRIES > cap + 256) return fail_too_many(search, err);

  /* Match and refine in turn. */
  for (int round = 0; round < ROUNDS; round++) {
    thr_motion motion;
    thr_procrustes(search->frame, search->image, &motion);
    if (motion.farthest <= search->tolerance && is_automorphism(search))
      return keep_image(search, cap, err);

    /* Refined: does the matching change? */
    if (!match_nodes(search, motion.q, search->next) ||
        memcmp(search->next, search->image, row) == 0)
      return THR_OK;
    memcpy(search->image, search->next, row);
  }
  return THR_OK;
}

/* Makes orthonormal rows: towards a, across it towards b, and across both. Returns false if a and b
 * are on a line with the origin. */
static bool base_of(const double *a, const double *b, double base[3][3])
{
  double across[3];
  thr_cross(a, b, across);

  /* Lengths. */
  double norm = sqrt(thr_dot(a, a)), wide = sqrt(thr_dot(across, across));
  if (norm <= 0 || wide <= 0) return false;

  /* Two of the rows; the third is across them. */
  for (int i = 0; i < 3; i++) {
    base[0][i] = a[i] / norm;
    base[2][i] = across[i] / wide;
  }

  thr_cross(base[2], base[0], base[1]);
  return true;
}

/* Tries the motion that takes the references' base to another, and the one that is mirrored at the
 * plane of both besides. */
static thr_status try_bases(isometry_search *search, double from[3][3], double to[3][3], int cap,
                            thr_err *err)
{
  thr_status st = THR_OK;
  for (int sign = 1; sign >= -1 && !st; sign -= 2) {
    double rotation[3][3];
    /* to^T from, with the last row of either sign. */
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        rotation[i][j] =
            to[0][i] * from[0][j] + to[1][i] * from[1][j] + sign * to[2][i] * from[2][j];

    st = try_motion(search, rotation, cap, err);
  }
  return st;
}

/* Tries the identity and the reversal, which are all isometries of a line. */
static thr_status try_line(isometry_search *search, int cap, thr_err *err)
{
  thr_status st = THR_OK;
  for (int sign = 1; sign >= -1 && !st; sign -= 2) {
    double rotation[3][3] = {{sign, 0, 0}, {0, sign, 0}, {0, 0, sign}};
    st = try_motion(search, rotation, cap, err);
  }
  return st;
}

/* Tries the motions that take the references to all places where they may go. */
static thr_status try_all(isometry_search *search, int cap, thr_err *err)
{
  double from[3][3], to[3][3];
  const double *first_position = search->position[search->first],
               *second_position = search->position[search->second];
  int first_end, second_end, first = find_places(search, search->first, &first_end),
                             second = find_places(search, search->second, &second_end);

  thr_status st = THR_OK;
  /* The references' own base. */
  if (!base_of(first_position, second_position, from)) return THR_OK;

  for (int i = first; i < first_end && !st; i++)
    for (int j = second; j < second_end && !st; j++) {
      /* The distance of the references is kept, up to the tolerance of both. */
      const double *to_first = search->position[search->like[i].node],
                   *to_second = search->position[search->like[j].node];
      if (search->work++ > MOST_WORK || thr_limits_stop(search->limits))
        return fail_too_many(search, err);
      if (fabs(thr_distance(first_position, second_position) - thr_distance(to_first, to_second)) >
              2 * search->tolerance ||
          !base_of(to_first, to_second, to))
        continue;

      st = try_bases(search, from, to, cap, err);
    }
  return st;
}

thr_status thr_isometries_find(const thr_frame *frame, const thr_automorphism_options *colours,
                               double tolerance, int cap, const thr_limits *limits, int **out,
                               int *count, thr_err *err)
{
  const thr_automorphism_options none = {0};
  isometry_search search = {.frame = frame,
                            .limits = limits,
                            .colours = colours ? colours : &none,
                            .tolerance = tolerance + THR_ISOMETRY_ROUNDING};
  *out = NULL;
  *count = 0;

  thr_status st = search_init(&search, err);

  /* Try all motions, and sort what was found. */
  if (!st) st = search.second < 0 ? try_line(&search, cap, err) : try_all(&search, cap, err);
  if (!st) st = thr_rows_sort(search.found, search.count, frame->n_nodes, NULL, err);

  thr_scratch_free(&search.own);
  if (st) {
    free(search.found);
    return st;
  }

  *out = search.found;
  *count = search.count;
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

  /* Each is judged by its own best motion. */
  for (int i = 0; i < n; i++) {
    thr_motion motion;
    thr_procrustes(frame, image + (size_t)i * row, &motion);
    if (motion.farthest <= tolerance + THR_ISOMETRY_ROUNDING)
      memcpy(*out + (size_t)(*count)++ * row, image + (size_t)i * row, row * sizeof *image);
  }
  return THR_OK;
}

/* ---- colours of edge lengths ---- */

thr_status thr_length_colours(const thr_frame *frame, double tolerance, int *colour, thr_err *err)
{
  thr_ranked *measured_edge = thr_calloc((size_t)frame->n_edges, sizeof *measured_edge);
  double centroid[3], size;
  if (!measured_edge) return thr_nomem(err);
  thr_frame_extent(frame, centroid, &size);

  /* Edges by length; a gap wider than what an isometry can change makes a new colour. */
  for (int e = 0; e < frame->n_edges; e++)
    measured_edge[e] = (thr_ranked){frame->length[e], e};
  thr_sort_ranked(measured_edge, (size_t)frame->n_edges);
  /* An isometry moves either end by the tolerance at most. */
  double step = 2 * (tolerance + 2 * THR_ISOMETRY_ROUNDING) * size;
  for (int i = 0, last = 0; i < frame->n_edges; i++) {
    last += i > 0 && measured_edge[i].key - measured_edge[i - 1].key > step;
    colour[measured_edge[i].index] = last;
  }

  free(measured_edge);
  return THR_OK;
}
