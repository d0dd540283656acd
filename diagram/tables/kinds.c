/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "diagram/tables/kinds.h"

#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  double size;
  int item, group; /* group: only items of one group are compared */
} keyed;

static int by_size(const void *a, const void *b)
{
  const keyed *p = a, *q = b;
  if (p->group != q->group) return p->group - q->group;
  if (p->size != q->size) return p->size < q->size ? -1 : 1;
  return p->item - q->item;
}

/* Kinds come as found; they are numbered again by their first item. next: [n] scratch. */
static void renumber(int *kind, int n, int *next)
{
  int count = 0;
  for (int i = 0; i < n; i++)
    next[i] = 0;
  for (int i = 0; i < n; i++) {
    if (!next[kind[i]]) next[kind[i]] = ++count;
    kind[i] = next[kind[i]];
  }
}

/* ---- node beads ---- */

/* The tips of a bead's arms, seen from the frame that two of them span. */
typedef struct {
  int n;
  double tip[THR_KINDS_ARMS][3];
  double length[THR_KINDS_ARMS];
  int base[2]; /* arms that span the frame: along the first, beside it the second; equal if all arms
                  are in one line */
  double slant; /* sine of the angle between them */
} bead;

static const double IN_LINE = THR_KINDS_TOLERANCE; /* sine: the tips of arms so nearly in line are
                                                      within the tolerance of one */

/* Sine of the angle between two arms. */
static double sine(const bead *b, int i, int j)
{
  double cross[3], area = b->length[i] * b->length[j];
  thr_cross(b->tip[i], b->tip[j], cross);
  return area > 0 ? sqrt(thr_dot(cross, cross)) / area : 0;
}

static void bead_make(const thr_frame *frame, int v, bead *b)
{
  *b = (bead){0};
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    const double *from = frame->xyz[v], *to = frame->xyz[thr_head(frame, frame->half[i])];
    double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, apart = sqrt(thr_dot(d, d));
    b->length[b->n] = frame->length[frame->half[i] >> 1] / 2;
    for (int k = 0; k < 3; k++)
      b->tip[b->n][k] = apart > 0 ? d[k] / apart * b->length[b->n] : 0;
    b->n++;
  }
  for (int j = 1; j < b->n; j++) {
    double s = sine(b, 0, j);
    if (s <= IN_LINE || s <= b->slant * (1 + 1e-9)) continue;
    b->slant = s;
    b->base[1] = j;
  }
}

/* Unit vectors: along arm i, at right angles to it towards arm j (any if i = j), and at right
 * angles to both. */
static void span(const bead *b, int i, int j, double axis[3][3])
{
  const double *a = b->tip[i];
  double other[3] = {0};
  int least = fabs(a[0]) <= fabs(a[1]) ? (fabs(a[0]) <= fabs(a[2]) ? 0 : 2)
                                       : (fabs(a[1]) <= fabs(a[2]) ? 1 : 2);
  other[least] = 1;
  for (int k = 0; k < 3; k++) {
    axis[0][k] = b->length[i] > 0 ? a[k] / b->length[i] : 0;
    if (i != j) other[k] = b->tip[j][k];
  }
  thr_cross(axis[0], other, axis[2]);
  double length = sqrt(thr_dot(axis[2], axis[2]));
  for (int k = 0; k < 3; k++)
    axis[2][k] = length > 0 ? axis[2][k] / length : 0;
  thr_cross(axis[2], axis[0], axis[1]);
}

static void turn_into(const bead *b, int i, int j, double tip[THR_KINDS_ARMS][3])
{
  double axis[3][3];
  span(b, i, j, axis);
  for (int arm = 0; arm < b->n; arm++)
    for (int k = 0; k < 3; k++)
      tip[arm][k] = thr_dot(b->tip[arm], axis[k]);
}

/* Does every tip of one bead meet another one of the other bead? */
static bool tips_meet(int n, const double (*a)[3], const double (*b)[3], double tolerance)
{
  bool taken[THR_KINDS_ARMS] = {false};
  for (int i = 0; i < n; i++) {
    int nearest = -1;
    double least = tolerance;
    for (int j = 0; j < n; j++) {
      double d[3] = {a[i][0] - b[j][0], a[i][1] - b[j][1], a[i][2] - b[j][2]},
             apart = sqrt(thr_dot(d, d));
      if (taken[j] || apart > least) continue;
      least = apart;
      nearest = j;
    }
    if (nearest < 0) return false;
    taken[nearest] = true;
  }
  return true;
}

static bool alike(const bead *a, const bead *b, double tolerance)
{
  double own[THR_KINDS_ARMS][3], turned[THR_KINDS_ARMS][3];
  int first = a->base[0], second = a->base[1];
  turn_into(a, first, second, own);
  for (int i = 0; i < b->n; i++) {
    if (fabs(b->length[i] - a->length[first]) > tolerance) continue;
    for (int j = 0; j < b->n; j++) {
      if ((i == j) != (first == second) || fabs(b->length[j] - a->length[second]) > tolerance)
        continue;
      if (i != j && sine(b, i, j) < IN_LINE / 2) continue;
      turn_into(b, i, j, turned);
      if (tips_meet(a->n, (const double(*)[3])own, (const double(*)[3])turned, tolerance))
        return true;
    }
  }
  return false;
}

/* Of beads that are alike it differs by at most sway(arms): the distances of their tips from each
 * other and from the node. */
static double bead_size(const bead *b)
{
  double size = 0;
  for (int i = 0; i < b->n; i++) {
    size += b->length[i];
    for (int j = 0; j < i; j++) {
      double d[3] = {b->tip[i][0] - b->tip[j][0], b->tip[i][1] - b->tip[j][1],
                     b->tip[i][2] - b->tip[j][2]};
      size += sqrt(thr_dot(d, d));
    }
  }
  return size;
}

static double sway(int arms, double tolerance)
{
  return tolerance * (arms + arms * (arms - 1.0)) * (1 + 1e-9);
}

static thr_status find_nodes(const thr_frame *frame, double tolerance, int *node, keyed *k,
                             thr_err *err)
{
  int n = frame->n_nodes, kinds = 0;
  int *model = thr_calloc((size_t)n, sizeof *model); /* place in k of the first of every kind */
  if (!model) return thr_nomem(err);
  bead b, other;
  for (int v = 0; v < n; v++) {
    k[v] = (keyed){.item = v, .group = thr_degree(frame, v)};
    if (k[v].group > THR_KINDS_ARMS) continue;
    bead_make(frame, v, &b);
    k[v].size = bead_size(&b);
  }
  qsort(k, (size_t)n, sizeof *k, by_size);
  for (int i = 0; i < n; i++) {
    int found = -1, arms = k[i].group;
    if (arms <= THR_KINDS_ARMS) bead_make(frame, k[i].item, &b);
    for (int m = kinds - 1; m >= 0 && found < 0 && arms <= THR_KINDS_ARMS; m--) {
      const keyed *like = &k[model[m]];
      if (like->group != arms || k[i].size - like->size > sway(arms, tolerance)) break;
      bead_make(frame, like->item, &other);
      if (alike(&other, &b, tolerance)) found = m;
    }
    if (found < 0) {
      model[kinds] = i;
      found = kinds++;
    }
    node[k[i].item] = found;
  }
  renumber(node, n, model);
  free(model);
  return THR_OK;
}

/* ---- edges ---- */

/* *median receives their median length. */
static void sort_edges(const thr_frame *frame, keyed *k, double *median)
{
  for (int e = 0; e < frame->n_edges; e++)
    k[e] = (keyed){.size = frame->length[e], .item = e};
  qsort(k, (size_t)frame->n_edges, sizeof *k, by_size);
  *median = k[frame->n_edges / 2].size;
}

static void find_edges(int n, const keyed *k, double tolerance, int *edge, int *next)
{
  double first = k[0].size;
  int kinds = 0;
  for (int i = 0; i < n; i++) {
    if (k[i].size - first > tolerance * (1 + 1e-9)) {
      first = k[i].size;
      kinds++;
    }
    edge[k[i].item] = kinds;
  }
  renumber(edge, n, next);
}

thr_status thr_kinds_find(const thr_frame *frame, double tolerance, int *edge, int *node,
                          thr_err *err)
{
  int most = frame->n_edges > frame->n_nodes ? frame->n_edges : frame->n_nodes;
  double median;
  keyed *k = thr_calloc((size_t)most, sizeof *k);
  int *next = thr_calloc((size_t)frame->n_edges, sizeof *next);
  thr_status st = k && next ? THR_OK : thr_nomem(err);
  if (!st) {
    sort_edges(frame, k, &median);
    if (tolerance == 0) tolerance = THR_KINDS_TOLERANCE * median;
    if (edge) find_edges(frame->n_edges, k, tolerance, edge, next);
    if (node) st = find_nodes(frame, tolerance, node, k, err);
  }
  free(k);
  free(next);
  return st;
}
