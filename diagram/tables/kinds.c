/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds which edges and which node beads are alike.
 *
 * Edges are sorted by length; a kind reaches as far as the tolerance from its first, shortest edge.
 *
 * Two node beads are alike if a rotation maps the tips of one on to those of the other. Two arms
 * that are not in line fix a rotation. So one pair of arms of the first bead, as near to a right
 * angle as its first arm has one, is laid on every pair of arms of the second whose lengths fit,
 * and then all tips must meet. No mirroring: a piece and its mirror image are two kinds. A size
 * that is the same for beads that are alike (the sum of all distances between tips and node) sorts
 * beads, so that only neighbours in this order are compared.
 *
 * Example: with a tolerance of 0.1, edges of 10, 10.05, 10.2 and 10.25 make two kinds: 1 1 2 2. */
#include "diagram/tables/tables.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* An edge or a node with a size by which like ones are found next to each other. */
typedef struct {
  double size;
  int item;  /* number of the edge or node */
  int group; /* only items of one group are compared */
} keyed;

/* Orders items by group, then by size, then by number, for qsort. */
static int by_size(const void *a, const void *b)
{
  const keyed *one = a, *other = b;
  if (one->group != other->group) return one->group - other->group;
  if (one->size != other->size) return one->size < other->size ? -1 : 1;
  return one->item - other->item;
}

/* Renumbers kinds, which come in any order from 0, to 1, 2, .. in the order of their first items.
 * next: [n] scratch. */
static void renumber(int *kind, int n, int *next)
{
  int count = 0;
  for (int i = 0; i < n; i++)
    next[i] = 0;

  for (int i = 0; i < n; i++) {
    /* A kind gets its number when its first item comes. */
    if (!next[kind[i]]) next[kind[i]] = ++count;
    kind[i] = next[kind[i]];
  }
}

/* ---- node beads ---- */

/* The tips of a bead's arms, seen from the frame that two of them span. */
typedef struct {
  int n;
  double tip[THR_KINDS_ARMS][3]; /* from the node, in units */
  double length[THR_KINDS_ARMS]; /* of each arm, in units */
  int base[2]; /* arms that span the frame: along the first, beside it the second; equal if all arms
                  are in one line */
  double slant; /* sine of the angle between them */
} node_bead;

static const double IN_LINE = THR_KINDS_TOLERANCE; /* sine: the tips of arms so nearly in line are
                                                      within the tolerance of one */

/* Returns the sine of the angle between arms i and j of a bead. */
static double sine(const node_bead *bead, int i, int j)
{
  double cross[3], area = bead->length[i] * bead->length[j];
  thr_cross(bead->tip[i], bead->tip[j], cross);
  return area > 0 ? sqrt(thr_dot(cross, cross)) / area : 0;
}

/* Fills the bead of node v: its arms from the node to the middles of its edges, and the pair of
 * arms that spans its frame. */
static void bead_make(const thr_frame *frame, int v, node_bead *bead)
{
  *bead = (node_bead){0};
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    const double *from = frame->xyz[v], *to = frame->xyz[thr_head(frame, frame->half[i])];

    /* Directions come from coordinates, lengths from the edges' own, which may differ. */
    double to_other[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]},
           apart = sqrt(thr_dot(to_other, to_other));
    bead->length[bead->n] = frame->length[frame->half[i] >> 1] / 2;
    for (int k = 0; k < 3; k++)
      bead->tip[bead->n][k] = apart > 0 ? to_other[k] / apart * bead->length[bead->n] : 0;

    bead->n++;
  }

  /* Arm 0 and the arm at the largest sine to it: the frame is best determined at a right angle.
   * Ties go to the first arm, whatever rounding does. */
  for (int j = 1; j < bead->n; j++) {
    double this_sine = sine(bead, 0, j);
    if (this_sine <= IN_LINE || this_sine <= bead->slant * (1 + 1e-9)) continue;
    bead->slant = this_sine;
    bead->base[1] = j;
  }
}

/* Computes a frame of unit vectors: along arm i, at right angles to it towards arm j (towards any
 * side if i = j), and at right angles to both. */
static void span(const node_bead *bead, int i, int j, double axis[3][3])
{
  const double *first = bead->tip[i];
  double other[3] = {0};

  /* For a single arm the coordinate axis most across it stands in for the second. */
  int least = fabs(first[0]) <= fabs(first[1]) ? (fabs(first[0]) <= fabs(first[2]) ? 0 : 2)
                                               : (fabs(first[1]) <= fabs(first[2]) ? 1 : 2);
  other[least] = 1;

  for (int k = 0; k < 3; k++) {
    axis[0][k] = bead->length[i] > 0 ? first[k] / bead->length[i] : 0;
    if (i != j) other[k] = bead->tip[j][k];
  }

  /* The third axis is the normal of both, the second completes a right-handed frame (Gram and
   * Schmidt). */
  thr_cross(axis[0], other, axis[2]);
  double length = sqrt(thr_dot(axis[2], axis[2]));
  for (int k = 0; k < 3; k++)
    axis[2][k] = length > 0 ? axis[2][k] / length : 0;

  thr_cross(axis[2], axis[0], axis[1]);
}

/* Computes the tips of a bead in the frame that its arms i and j span. */
static void turn_into(const node_bead *bead, int i, int j, double tip[THR_KINDS_ARMS][3])
{
  double axis[3][3];
  span(bead, i, j, axis);

  for (int arm = 0; arm < bead->n; arm++)
    for (int k = 0; k < 3; k++)
      tip[arm][k] = thr_dot(bead->tip[arm], axis[k]);
}

/* Returns whether every tip of one bead meets a different tip of the other one within the
 * tolerance. Each takes the nearest tip that is free. */
static bool tips_meet(int n, const double (*own)[3], const double (*other)[3], double tolerance)
{
  bool taken[THR_KINDS_ARMS] = {false};

  for (int i = 0; i < n; i++) {
    /* Only tips within the tolerance count. */
    int nearest = -1;
    double least = tolerance;
    for (int j = 0; j < n; j++) {
      double d[3] = {own[i][0] - other[j][0], own[i][1] - other[j][1], own[i][2] - other[j][2]},
             apart = sqrt(thr_dot(d, d));

      if (taken[j] || apart > least) continue;
      least = apart;
      nearest = j;
    }

    /* A tip without a partner: the beads differ. */
    if (nearest < 0) return false;
    taken[nearest] = true;
  }
  return true;
}

/* Returns whether a rotation maps the other bead on to this one within the tolerance. Both have as
 * many arms. */
static bool alike(const node_bead *one, const node_bead *other, double tolerance)
{
  double own[THR_KINDS_ARMS][3], turned[THR_KINDS_ARMS][3];
  int first = one->base[0], second = one->base[1];

  turn_into(one, first, second, own);
  for (int i = 0; i < other->n; i++) {
    /* Arm i of the other bead is laid on the first base arm of this one, arm j on the second:
     * lengths must fit. */
    if (fabs(other->length[i] - one->length[first]) > tolerance) continue;
    for (int j = 0; j < other->n; j++) {
      /* A bead whose arms are in one line has no second arm. */
      if ((i == j) != (first == second) || fabs(other->length[j] - one->length[second]) > tolerance)
        continue;

      /* Two arms in line determine no rotation. */
      if (i != j && sine(other, i, j) < IN_LINE / 2) continue;

      turn_into(other, i, j, turned);
      if (tips_meet(one->n, (const double(*)[3])own, (const double(*)[3])turned, tolerance))
        return true;
    }
  }
  return false;
}

/* Returns the sum of all distances between the tips of a bead, and from these to the node. Sizes of
 * beads that are alike differ by at most sway(arms). */
static double bead_size(const node_bead *bead)
{
  double size = 0;
  for (int i = 0; i < bead->n; i++) {
    size += bead->length[i];
    for (int j = 0; j < i; j++) {
      /* Each pair of tips once. */
      double apart[3] = {bead->tip[i][0] - bead->tip[j][0], bead->tip[i][1] - bead->tip[j][1],
                         bead->tip[i][2] - bead->tip[j][2]};
      size += sqrt(thr_dot(apart, apart));
    }
  }
  return size;
}

/* Returns by how much the sizes of two beads that are alike may differ: each tip moves by at most
 * the tolerance, which changes a distance to the node by as much and one between two tips by twice
 * as much, arms + 2 * arms (arms - 1) / 2 times in all. */
static double sway(int arms, double tolerance)
{
  return tolerance * (arms + arms * (arms - 1.0)) * (1 + 1e-9);
}

/* Numbers the kinds of node beads. sorted: [n_nodes] scratch. */
static thr_status find_nodes(const thr_frame *frame, double tolerance, int *node, keyed *sorted,
                             thr_err *err)
{
  int n = frame->n_nodes, kinds = 0;
  int *model =
      thr_calloc((size_t)n, sizeof *model); /* place in sorted of the first of every kind */
  if (!model) return thr_nomem(err);

  node_bead bead_here, other;

  /* Beads with very many arms have no size: each of them is a kind of its own. */
  for (int v = 0; v < n; v++) {
    sorted[v] = (keyed){.item = v, .group = thr_degree(frame, v)};
    if (sorted[v].group > THR_KINDS_ARMS) continue;
    bead_make(frame, v, &bead_here);
    sorted[v].size = bead_size(&bead_here);
  }

  qsort(sorted, (size_t)n, sizeof *sorted, by_size);

  /* Compare each bead with the first one of every kind found before, the nearest in size first. */
  for (int i = 0; i < n; i++) {
    int found = -1, arms = sorted[i].group;
    if (arms <= THR_KINDS_ARMS) bead_make(frame, sorted[i].item, &bead_here);
    for (int kind = kinds - 1; kind >= 0 && found < 0 && arms <= THR_KINDS_ARMS; kind--) {
      const keyed *like = &sorted[model[kind]];

      /* Kinds before this one are smaller still: none of them can be alike. */
      if (like->group != arms || sorted[i].size - like->size > sway(arms, tolerance)) break;
      bead_make(frame, like->item, &other);

      if (alike(&other, &bead_here, tolerance)) found = kind;
    }

    /* A new kind, with this bead as its first. */
    if (found < 0) {
      model[kinds] = i;
      found = kinds++;
    }

    node[sorted[i].item] = found;
  }

  renumber(node, n, model);
  free(model);
  return THR_OK;
}

/* ---- edges ---- */

/* Sorts the edges by length; *median receives the median length, in units. */
static void sort_edges(const thr_frame *frame, keyed *sorted, double *median)
{
  for (int e = 0; e < frame->n_edges; e++)
    sorted[e] = (keyed){.size = frame->length[e], .item = e};

  qsort(sorted, (size_t)frame->n_edges, sizeof *sorted, by_size);
  *median = sorted[frame->n_edges / 2].size;
}

/* Numbers the kinds of edges. sorted: [n] edges by length; next: [n] scratch. A kind begins with
 * the first edge that is longer by more than the tolerance than the first edge of the kind
 * before. */
static void find_edges(int n, const keyed *sorted, double tolerance, int *edge, int *next)
{
  double first = sorted[0].size;
  int kinds = 0;

  for (int i = 0; i < n; i++) {
    /* The margin keeps lengths that differ by exactly the tolerance together. */
    if (sorted[i].size - first > tolerance * (1 + 1e-9)) {
      first = sorted[i].size;
      kinds++;
    }
    edge[sorted[i].item] = kinds;
  }

  renumber(edge, n, next);
}

thr_status thr_kinds_find(const thr_frame *frame, double tolerance, int *edge, int *node,
                          thr_err *err)
{
  int most = frame->n_edges > frame->n_nodes ? frame->n_edges : frame->n_nodes;
  double median;

  /* One array serves edges and nodes in turn. */
  keyed *sorted = thr_calloc((size_t)most, sizeof *sorted);
  int *next = thr_calloc((size_t)frame->n_edges, sizeof *next);
  thr_status st = sorted && next ? THR_OK : thr_nomem(err);

  if (!st) {
    sort_edges(frame, sorted, &median);

    /* The usual tolerance is a share of the median edge. */
    if (tolerance == 0) tolerance = THR_KINDS_TOLERANCE * median;
    if (edge) find_edges(frame->n_edges, sorted, tolerance, edge, next);
    if (node) st = find_nodes(frame, tolerance, node, sorted, err);
  }

  free(sorted);
  free(next);
  return st;
}
