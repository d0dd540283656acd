/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a drawing nearly says: nodes that are almost one, nodes that lie on an edge which passes
 * them, edges that cross without a node. Joints that are meant to be there and are not make other
 * cords, so a reader of frameworks remarks them.
 *
 * Two grids of cells about as large as an edge is long, one with the nodes in each cell and one
 * with the edges that pass through: nodes are compared with the nodes around them and the edges of
 * their cell, edges with those that they share a cell with. */
#include "graph/framework/frame.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double CLOSE = 0.1, TOUCHING = 1e-3; /* of the length of an edge */
enum { MOST_COMPARISONS = 100000000 };

/* What lies in the cells, which share buckets by a hash of their place. */
typedef struct {
  int *start;  /* [buckets + 1] */
  int *member; /* by bucket, ascending */
} grid;

typedef struct {
  int node, edge;
  double at; /* from 0, the edge's first end, to 1 */
} touch;

typedef struct {
  const thr_frame *frame;
  thr_near *near;
  thr_err *err;
  double *apart;    /* [n_edges] distance of an edge's ends */
  double *shortest; /* [n_nodes] of these at a node */
  double low[3], cell;
  uint32_t mask; /* buckets - 1 */
  grid nodes, edges;
  int64_t comparisons;
  double widest; /* gap of the close pairs */
  touch *touch;  /* every node on an edge */
  int n_touches, touches_capacity;
} search;

typedef struct {
  int64_t x, y, z;
} place;

/* ---- geometry ---- */

static double distance(const double a[3], const double b[3])
{
  const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return sqrt(thr_dot(d, d));
}

static const double *end_of(const search *s, int e, int side)
{
  return s->frame->xyz[s->frame->edge[e][side]];
}

static void point_on(const search *s, int e, double at, double out[3])
{
  const double *a = end_of(s, e, 0), *b = end_of(s, e, 1);
  for (int i = 0; i < 3; i++)
    out[i] = a[i] + at * (b[i] - a[i]);
}

static bool is_straight(const search *s, int e)
{
  return s->frame->length[e] <= 1.01 * s->apart[e];
}

/* ---- the grids ---- */

static place place_of(const search *s, const double p[3], double shift)
{
  return (place){(int64_t)floor((p[0] - s->low[0] + shift) / s->cell),
                 (int64_t)floor((p[1] - s->low[1] + shift) / s->cell),
                 (int64_t)floor((p[2] - s->low[2] + shift) / s->cell)};
}

/* Cells side by side have buckets side by side. */
static uint32_t bucket_of(const search *s, place p)
{
  const uint64_t hash = ((uint64_t)p.y * UINT64_C(0xc2b2ae3d27d4eb4f)) ^
                        ((uint64_t)p.z * UINT64_C(0x165667b19e3779f9));
  return (uint32_t)((hash ^ hash >> 32) + (uint64_t)p.x) & s->mask;
}

/* The cell size: that of the median of some edges, but so that all together pass through few cells,
 * and none beyond counting. */
static thr_status choose_cells(search *s)
{
  enum { SAMPLE = 10000 };
  const thr_frame *f = s->frame;
  const int every = f->n_edges / SAMPLE + 1;
  double total = 0, *sorted = thr_calloc((size_t)(f->n_edges / every + 1), sizeof *sorted);
  size_t n = 0;
  if (!sorted) return thr_nomem(s->err);
  for (int e = 0; e < f->n_edges; e++) {
    if (e % every == 0) sorted[n++] = s->apart[e];
    total += s->apart[e];
  }
  thr_sort_doubles(sorted, n);
  s->cell = fmax(fmax(sorted[n / 2], total / (4.0 * f->n_edges)), 1e-7 * thr_frame_diagonal(f));
  free(sorted);
  memcpy(s->low, f->xyz[0], sizeof s->low);
  for (int v = 0; v < f->n_nodes; v++)
    for (int k = 0; k < 3; k++)
      s->low[k] = fmin(s->low[k], f->xyz[v][k]);
  for (s->mask = 1; s->mask < (uint32_t)f->n_edges; s->mask = 2 * s->mask + 1) {
  }
  return THR_OK;
}

/* Adds the edge to the buckets of the cells that one of its parts comes close to; while members are
 * counted, member is NULL. last[bucket]: the edge that came last. */
static void put_part(search *s, int e, double from, double to, int *last)
{
  double a[3], b[3], low[3], high[3];
  const double reach = TOUCHING * fmin(s->apart[e], 10 * s->cell);
  point_on(s, e, from, a);
  point_on(s, e, to, b);
  for (int k = 0; k < 3; k++) {
    low[k] = fmin(a[k], b[k]);
    high[k] = fmax(a[k], b[k]);
  }
  const place first = place_of(s, low, -reach), end = place_of(s, high, reach);
  place p;
  for (p.x = first.x; p.x <= end.x; p.x++)
    for (p.y = first.y; p.y <= end.y; p.y++)
      for (p.z = first.z; p.z <= end.z; p.z++) {
        const uint32_t bucket = bucket_of(s, p);
        if (last[bucket] == e) continue;
        last[bucket] = e;
        if (s->edges.member)
          s->edges.member[s->edges.start[bucket + 1]++] = e;
        else
          s->edges.start[bucket + 2]++;
      }
}

static void put_edges(search *s, int *last)
{
  for (uint32_t i = 0; i <= s->mask; i++)
    last[i] = -1;
  for (int e = 0; e < s->frame->n_edges; e++) {
    const int parts = (int)ceil(s->apart[e] / s->cell) + (s->apart[e] == 0);
    for (int i = 0; is_straight(s, e) && i < parts; i++)
      put_part(s, e, (double)i / parts, (double)(i + 1) / parts, last);
  }
}

static void put_nodes(search *s)
{
  for (int v = 0; v < s->frame->n_nodes; v++) {
    const uint32_t bucket = bucket_of(s, place_of(s, s->frame->xyz[v], 0));
    if (s->nodes.member)
      s->nodes.member[s->nodes.start[bucket + 1]++] = v;
    else
      s->nodes.start[bucket + 2]++;
  }
}

/* From counts, shifted by two places, to where each bucket begins, shifted by one. */
static thr_status reserve(search *s, grid *g)
{
  for (uint32_t i = 2; i <= s->mask + 2; i++)
    g->start[i] += g->start[i - 1];
  g->member = thr_calloc((size_t)g->start[s->mask + 2], sizeof *g->member);
  return g->member ? THR_OK : thr_nomem(s->err);
}

static thr_status fill_grids(search *s)
{
  const size_t buckets = (size_t)s->mask + 1;
  int *last = thr_calloc(buckets, sizeof *last);
  s->nodes.start = thr_calloc(buckets + 2, sizeof *s->nodes.start);
  s->edges.start = thr_calloc(buckets + 2, sizeof *s->edges.start);
  thr_status st = last && s->nodes.start && s->edges.start ? THR_OK : thr_nomem(s->err);
  if (!st) put_nodes(s);
  if (!st) st = reserve(s, &s->nodes);
  if (!st) put_nodes(s);
  if (!st) put_edges(s, last);
  if (!st) st = reserve(s, &s->edges);
  if (!st) put_edges(s, last);
  free(last);
  return st;
}

/* May another pair be compared? */
static bool goes_on(search *s)
{
  if (++s->comparisons > MOST_COMPARISONS) s->near->tangled = true;
  return !s->near->tangled;
}

/* ---- nodes close to nodes ---- */

static void compare_nodes(search *s, int v, int w)
{
  const double gap = distance(s->frame->xyz[v], s->frame->xyz[w]);
  if (gap > CLOSE * fmin(fmin(s->shortest[v], s->shortest[w]), s->cell) ||
      thr_frame_edge_between(s->frame, v, w) >= 0)
    return;
  if (s->near->n_close++ == 0 || gap < s->near->gap) {
    s->near->gap = gap;
    s->near->closest[0] = v;
    s->near->closest[1] = w;
  }
  s->widest = fmax(s->widest, gap);
}

static void find_close_nodes(search *s, int v)
{
  const double reach = CLOSE * fmin(s->shortest[v], s->cell);
  const place first = place_of(s, s->frame->xyz[v], -reach),
              end = place_of(s, s->frame->xyz[v], reach);
  place p;
  for (p.x = first.x; p.x <= end.x; p.x++)
    for (p.y = first.y; p.y <= end.y; p.y++)
      for (p.z = first.z; p.z <= end.z; p.z++) {
        const uint32_t bucket = bucket_of(s, p);
        for (int i = s->nodes.start[bucket]; i < s->nodes.start[bucket + 1] && goes_on(s); i++) {
          const int w = s->nodes.member[i];
          if (w <= v || distance(s->frame->xyz[v], s->frame->xyz[w]) > reach) continue;
          const place q = place_of(s, s->frame->xyz[w], 0);
          if (q.x == p.x && q.y == p.y && q.z == p.z) compare_nodes(s, v, w);
        }
      }
}

/* ---- nodes on edges, edges across edges ---- */

static bool is_within(double at)
{
  return at > TOUCHING && at < 1 - TOUCHING;
}

static thr_status compare_node(search *s, int v, int e)
{
  if (s->frame->edge[e][0] == v || s->frame->edge[e][1] == v) return THR_OK;
  const double *a = end_of(s, e, 0), *b = end_of(s, e, 1), *p = s->frame->xyz[v];
  const double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]},
               to[3] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
  const double at = thr_dot(along, to) / thr_dot(along, along);
  double foot[3];
  if (!is_within(at)) return THR_OK;
  point_on(s, e, at, foot);
  if (distance(p, foot) > TOUCHING * fmin(s->apart[e], fmin(s->shortest[v], 10 * s->cell)))
    return THR_OK;
  for (int side = 0; side < 2; side++)
    if (distance(p, end_of(s, e, side)) <=
        CLOSE * fmin(s->shortest[v], s->shortest[s->frame->edge[e][side]]))
      return THR_OK;
  thr_status st = thr_grow(&s->touch, s->n_touches, &s->touches_capacity, sizeof *s->touch, s->err);
  if (!st) s->touch[s->n_touches++] = (touch){v, e, at};
  return st;
}

/* Where two lines that are not parallel come closest, as parts of the edges. */
static bool closest_points(const double p[3], const double d1[3], const double q[3],
                           const double d2[3], double *at1, double *at2)
{
  const double r[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  const double a = thr_dot(d1, d1), b = thr_dot(d1, d2), c = thr_dot(d2, d2), d = thr_dot(d1, r),
               e = thr_dot(d2, r);
  const double determinant = a * c - b * b;
  if (!(determinant > 1e-9 * a * c)) return false;
  *at1 = (b * e - c * d) / determinant;
  *at2 = (a * e - b * d) / determinant;
  return true;
}

static void compare_edges(search *s, int e, int f, uint32_t bucket)
{
  const int *m = s->frame->edge[e], *n = s->frame->edge[f];
  if (m[0] == n[0] || m[0] == n[1] || m[1] == n[0] || m[1] == n[1]) return;
  const double *p = s->frame->xyz[m[0]], *q = s->frame->xyz[n[0]], *pp = s->frame->xyz[m[1]],
               *qq = s->frame->xyz[n[1]];
  const double d1[3] = {pp[0] - p[0], pp[1] - p[1], pp[2] - p[2]},
               d2[3] = {qq[0] - q[0], qq[1] - q[1], qq[2] - q[2]};
  double at1, at2, here[3], there[3];
  if (!closest_points(p, d1, q, d2, &at1, &at2) || !is_within(at1) || !is_within(at2)) return;
  point_on(s, e, at1, here);
  point_on(s, f, at2, there);
  if (distance(here, there) > TOUCHING * fmin(fmin(s->apart[e], s->apart[f]), 10 * s->cell)) return;
  if (bucket_of(s, place_of(s, here, 0)) != bucket) return; /* they share other cells as well */
  if (s->near->n_crossings++ == 0) {
    s->near->crossing[0] = e < f ? e : f;
    s->near->crossing[1] = e < f ? f : e;
  }
}

static thr_status look_around(search *s)
{
  thr_status st = THR_OK;
  for (int v = 0; v < s->frame->n_nodes && !st && !s->near->tangled; v++) {
    find_close_nodes(s, v);
    const uint32_t bucket = bucket_of(s, place_of(s, s->frame->xyz[v], 0));
    for (int i = s->edges.start[bucket]; i < s->edges.start[bucket + 1] && !st && goes_on(s); i++)
      st = compare_node(s, v, s->edges.member[i]);
  }
  return st;
}

static void look_across(search *s)
{
  for (uint32_t bucket = 0; bucket <= s->mask && !s->near->tangled; bucket++)
    for (int i = s->edges.start[bucket]; i < s->edges.start[bucket + 1]; i++)
      for (int j = s->edges.start[bucket]; j < i && goes_on(s); j++)
        compare_edges(s, s->edges.member[j], s->edges.member[i], bucket);
}

/* ---- all of it ---- */

static thr_status begin(search *s, const thr_frame *frame, thr_near *near, thr_err *err)
{
  *near = (thr_near){0};
  *s = (search){.frame = frame, .near = near, .err = err};
  s->apart = thr_calloc((size_t)frame->n_edges, sizeof *s->apart);
  s->shortest = thr_calloc((size_t)frame->n_nodes, sizeof *s->shortest);
  if (!s->apart || !s->shortest) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++)
    s->shortest[v] = INFINITY;
  for (int e = 0; e < frame->n_edges; e++) {
    s->apart[e] = distance(end_of(s, e, 0), end_of(s, e, 1));
    for (int side = 0; side < 2; side++)
      s->shortest[frame->edge[e][side]] = fmin(s->shortest[frame->edge[e][side]], s->apart[e]);
  }
  thr_status st = choose_cells(s);
  return st ? st : fill_grids(s);
}

static void end(search *s)
{
  free(s->apart);
  free(s->shortest);
  free(s->nodes.start);
  free(s->nodes.member);
  free(s->edges.start);
  free(s->edges.member);
  free(s->touch);
}

/* The framework's nodes as a reader would have collected them. */
static thr_status add_nodes(const thr_frame *f, thr_draft *draft, thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < f->n_nodes && !st; v++)
    st = thr_draft_add_node(draft, f->xyz[v], f->name[v], f->foot[v], err);
  memcpy(draft->units, f->units, sizeof draft->units);
  return st;
}

/* Adds a part of an edge, all of it is 1. */
static thr_status add_part(const thr_frame *f, int e, int a, int b, double part, thr_draft *draft,
                           thr_err *err)
{
  thr_status st = thr_draft_add_edge(draft, a, b, f->own_lengths ? f->length[e] * part : 0, err);
  return st ? st
            : thr_draft_edge_passes(draft, f->cover ? f->cover[e] : 0,
                                    f->capacity ? f->capacity[e] : 0, err);
}

static thr_status count_components(const thr_frame *f, int *count, thr_err *err)
{
  int *component = thr_calloc((size_t)f->n_nodes, sizeof *component);
  thr_status st = component ? thr_frame_components(f, component, count, err) : thr_nomem(err);
  free(component);
  return st;
}

/* What welding with near->weld would come to. */
static thr_status try_weld(const thr_frame *f, thr_near *near, thr_err *err)
{
  thr_draft draft = {0};
  thr_frame welded = {0};
  thr_read_report report = {0};
  thr_status st = add_nodes(f, &draft, err);
  for (int e = 0; e < f->n_edges && !st; e++)
    st = add_part(f, e, f->edge[e][0], f->edge[e][1], 1, &draft, err);
  if (!st) st = thr_draft_build(&draft, near->weld, &welded, &report, err);
  if (!st) st = count_components(&welded, &near->components_welded, err);
  near->n_welded = report.welded_nodes;
  near->n_lost = report.zero_length_edges;
  near->n_merged = report.duplicate_edges;
  thr_draft_destroy(&draft);
  thr_frame_destroy(&welded);
  return st;
}

/* A power of ten of at least twice the widest gap or, if that would swallow edges, the gap with two
 * digits, rounded up. */
static thr_status choose_weld(const search *s, thr_near *near)
{
  double least = INFINITY, digit = pow(10, floor(log10(s->widest)) - 1);
  for (int e = 0; e < s->frame->n_edges; e++)
    least = fmin(least, s->apart[e]);
  near->weld = pow(10, ceil(log10(2 * s->widest) - 1e-9));
  if (near->weld >= least) near->weld = (floor(s->widest / digit) + 1) * digit;
  return try_weld(s->frame, near, s->err);
}

thr_status thr_frame_near(const thr_frame *frame, thr_near *near, thr_err *err)
{
  search s;
  thr_status st = begin(&s, frame, near, err);
  if (!st) st = look_around(&s);
  if (!st) look_across(&s);
  near->n_on_edge = s.n_touches;
  if (s.n_touches) near->on_edge[0] = s.touch[0].node;
  if (s.n_touches) near->on_edge[1] = s.touch[0].edge;
  if (!st) st = count_components(frame, &near->components, err);
  if (!st && near->n_close) st = choose_weld(&s, near);
  end(&s);
  return st;
}

/* ---- edges cut where nodes lie on them ---- */

static int along_edges(const void *pa, const void *pb)
{
  const touch *a = pa, *b = pb;
  if (a->edge != b->edge) return a->edge < b->edge ? -1 : 1;
  if (a->at != b->at) return a->at < b->at ? -1 : 1;
  return (a->node > b->node) - (a->node < b->node);
}

/* The edges in their order, each that is cut as its parts. */
static thr_status cut(const search *s, thr_draft *draft, int *n_cut)
{
  const thr_frame *f = s->frame;
  thr_status st = THR_OK;
  *n_cut = 0;
  for (int e = 0, i = 0; e < f->n_edges && !st; e++) {
    int from = f->edge[e][0];
    double at = 0;
    *n_cut += i < s->n_touches && s->touch[i].edge == e;
    for (; i < s->n_touches && s->touch[i].edge == e && !st; i++) {
      st = add_part(f, e, from, s->touch[i].node, s->touch[i].at - at, draft, s->err);
      from = s->touch[i].node;
      at = s->touch[i].at;
    }
    if (!st) st = add_part(f, e, from, f->edge[e][1], 1 - at, draft, s->err);
  }
  return st;
}

thr_status thr_frame_split(thr_frame *frame, int *n_cut, thr_read_report *report, thr_err *err)
{
  search s;
  thr_near near;
  thr_draft draft = {0};
  thr_frame split = {0};
  thr_read_report done = {0};
  *n_cut = 0;
  thr_status st = begin(&s, frame, &near, err);
  if (!st) st = look_around(&s);
  if (!st && near.tangled)
    st = thr_fail(err, THR_ELIMIT,
                  "too many edges pass close to each other to find all nodes that lie on them");
  if (st || !s.n_touches) goto done;
  qsort(s.touch, (size_t)s.n_touches, sizeof *s.touch, along_edges);
  st = add_nodes(frame, &draft, err);
  if (!st) st = cut(&s, &draft, n_cut);
  if (!st) st = thr_draft_build(&draft, 0, &split, &done, err);
  if (st) goto done;
  report->duplicate_edges += done.duplicate_edges;
  thr_frame_destroy(frame);
  *frame = split;
done:
  thr_draft_destroy(&draft);
  end(&s);
  return st;
}
