/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds what a drawing nearly says: nodes that are almost one, nodes that lie on an edge which
 * passes them, edges that cross without a node. Joints that are meant to be there but are missing
 * change the cords, so that readers of frameworks are warned of them; and edges can be cut at the
 * nodes that lie on them (thr_frame_split).
 *
 * Two grids have cells about as large as an edge is long. One holds the nodes in each cell, the
 * other one the edges that pass through a cell. Nodes are compared with the nodes around them and
 * with the edges of their cell, edges with those that they share a cell with. So the time is linear
 * where edges of about one length fill space evenly. Cells are found by a hash of their place: a
 * bucket may hold several cells.
 *
 * Example: of the edges (0, 0, 0)-(20, 0, 0) and (10, -5, 0)-(10, 5, 0) each passes through the
 * cell of (10, 0, 0), where they are found to cross. */
#include "graph/framework/frame.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* CLOSE: two nodes may be meant to be one; TOUCHING: two edges, or an edge and a node, meet. */
static const double CLOSE = 0.1, TOUCHING = 1e-3; /* of the length of an edge */
enum { MOST_COMPARISONS = 100000000 };

/* What is in the cells: members of bucket b are member[start[b]] .. member[start[b + 1] - 1]. */
typedef struct {
  int *start;  /* [buckets + 1] */
  int *member; /* by bucket, ascending */
} grid;

/* A node on an edge that does not end there. */
typedef struct {
  int node, edge;
  double at; /* from 0, the edge's first end, to 1 */
} touch;

/* The state of one search. */
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
} near_search;

/* A cell of the grids, by its place in each direction. */
typedef struct {
  int64_t x, y, z;
} place;

/* ---- geometry ---- */

/* Returns the coordinates of an end of an edge. */
static const double *end_of(const near_search *search, int e, int side)
{
  return search->frame->xyz[search->frame->edge[e][side]];
}

/* Computes the point at a share of an edge. */
static void point_on(const near_search *search, int e, double at, double out[3])
{
  const double *a = end_of(search, e, 0), *b = end_of(search, e, 1);
  thr_mix(a, b, at, out);
}

/* Returns whether an edge is as long as its nodes are apart, within 1 %. Longer edges are curves,
 * whose course is not known. */
static bool is_straight(const near_search *search, int e)
{
  return search->frame->length[e] <= 1.01 * search->apart[e];
}

/* ---- the grids ---- */

/* Returns the cell of a point that is moved by `shift` in each direction. */
static place place_of(const near_search *search, const double point[3], double shift)
{
  return (place){(int64_t)floor((point[0] - search->low[0] + shift) / search->cell),
                 (int64_t)floor((point[1] - search->low[1] + shift) / search->cell),
                 (int64_t)floor((point[2] - search->low[2] + shift) / search->cell)};
}

/* Returns the bucket of a cell. Cells that are neighbours in x have neighbouring buckets, which are
 * in one line of the processor's cache. */
static uint32_t bucket_of(const near_search *search, place cell)
{
  const uint64_t hash = ((uint64_t)cell.y * UINT64_C(0xc2b2ae3d27d4eb4f)) ^
                        ((uint64_t)cell.z * UINT64_C(0x165667b19e3779f9));
  return (uint32_t)((hash ^ hash >> 32) + (uint64_t)cell.x) & search->mask;
}

/* Chooses the size of cells: the median length of some edges. If a few edges are much longer, cells
 * are larger, so that the edges pass through at most some four cells each on average; and cells are
 * never so small that their places could not be counted. */
static thr_status choose_cells(near_search *search)
{
  enum { SAMPLE = 10000 };
  const thr_frame *frame = search->frame;

  /* A sample is enough for a median. */
  const int every = frame->n_edges / SAMPLE + 1;
  double total = 0, *sorted = thr_calloc((size_t)(frame->n_edges / every) + 1, sizeof *sorted);
  size_t n = 0;
  if (!sorted) return thr_nomem(search->err);

  /* The mean bounds the number of cells that edges pass through. */
  for (int e = 0; e < frame->n_edges; e++) {
    if (e % every == 0) sorted[n++] = search->apart[e];
    total += search->apart[e];
  }

  thr_sort_doubles(sorted, n);
  search->cell =
      fmax(fmax(sorted[n / 2], total / (4.0 * frame->n_edges)), 1e-7 * thr_frame_diagonal(frame));
  free(sorted);

  /* The grid begins at the lowest coordinates. */
  memcpy(search->low, frame->xyz[0], sizeof search->low);
  for (int v = 0; v < frame->n_nodes; v++)
    for (int k = 0; k < 3; k++)
      search->low[k] = fmin(search->low[k], frame->xyz[v][k]);

  /* At least one bucket for each edge, a power of two. */
  for (search->mask = 1; search->mask < (uint32_t)frame->n_edges;
       search->mask = 2 * search->mask + 1) {
  }

  return THR_OK;
}

/* Adds an edge to the buckets of the cells that one of its parts comes close to. In the first pass,
 * when member is NULL, only counts. last[bucket]: the edge that was added last, so that no edge is
 * twice in one bucket. */
static void put_part(near_search *search, int e, double from, double to, int *last)
{
  double a[3], b[3], low[3], high[3];

  /* Cells that are within reach of what may touch the part. */
  const double reach = TOUCHING * fmin(search->apart[e], 10 * search->cell);
  point_on(search, e, from, a);
  point_on(search, e, to, b);

  for (int k = 0; k < 3; k++) {
    low[k] = fmin(a[k], b[k]);
    high[k] = fmax(a[k], b[k]);
  }

  const place first = place_of(search, low, -reach), highest = place_of(search, high, reach);
  place cell;

  /* All cells of the part's bounding box; parts are short, so few of them are empty. */
  for (cell.x = first.x; cell.x <= highest.x; cell.x++)
    for (cell.y = first.y; cell.y <= highest.y; cell.y++)
      for (cell.z = first.z; cell.z <= highest.z; cell.z++) {
        const uint32_t bucket = bucket_of(search, cell);
        if (last[bucket] == e) continue;
        last[bucket] = e;
        if (search->edges.member)
          search->edges.member[search->edges.start[bucket + 1]++] = e;
        else
          search->edges.start[bucket + 2]++;
      }
}

/* Adds all straight edges, in parts no longer than a cell. */
static void put_edges(near_search *search, int *last)
{
  for (uint32_t i = 0; i <= search->mask; i++)
    last[i] = -1;
  for (int e = 0; e < search->frame->n_edges; e++) {
    const int parts = (int)ceil(search->apart[e] / search->cell) + (search->apart[e] == 0);
    for (int i = 0; is_straight(search, e) && i < parts; i++)
      put_part(search, e, (double)i / parts, (double)(i + 1) / parts, last);
  }
}

/* Adds all nodes, or counts them. */
static void put_nodes(near_search *search)
{
  for (int v = 0; v < search->frame->n_nodes; v++) {
    const uint32_t bucket = bucket_of(search, place_of(search, search->frame->xyz[v], 0));
    if (search->nodes.member)
      search->nodes.member[search->nodes.start[bucket + 1]++] = v;
    else
      search->nodes.start[bucket + 2]++;
  }
}

/* Turns the counts, which are shifted by two places, into where each bucket begins, shifted by one
 * place. Adding the members then moves each beginning to its right place. */
static thr_status reserve(near_search *search, grid *filled)
{
  for (uint32_t i = 2; i <= search->mask + 2; i++)
    filled->start[i] += filled->start[i - 1];
  filled->member = thr_calloc((size_t)filled->start[search->mask + 2], sizeof *filled->member);
  return filled->member ? THR_OK : thr_nomem(search->err);
}

/* Fills both grids, each in two passes: counting and adding. */
static thr_status fill_grids(near_search *search)
{
  const size_t buckets = (size_t)search->mask + 1;
  int *last = thr_calloc(buckets, sizeof *last);

  search->nodes.start = thr_calloc(buckets + 2, sizeof *search->nodes.start);
  search->edges.start = thr_calloc(buckets + 2, sizeof *search->edges.start);
  thr_status st =
      last && search->nodes.start && search->edges.start ? THR_OK : thr_nomem(search->err);

  /* In the first pass member is NULL: members are counted; in the second they are added. */
  if (!st) put_nodes(search);
  if (!st) st = reserve(search, &search->nodes);
  if (!st) put_nodes(search);
  if (!st) put_edges(search, last);
  if (!st) st = reserve(search, &search->edges);
  if (!st) put_edges(search, last);

  free(last);
  return st;
}

/* Returns whether another pair may be compared. If there have been too many, the search is given up
 * as tangled. */
static bool goes_on(near_search *search)
{
  if (++search->comparisons > MOST_COMPARISONS) search->near->tangled = true;
  return !search->near->tangled;
}

/* ---- nodes close to nodes ---- */

/* Counts a pair of nodes that is close but has no edge, and keeps the closest one. */
static void compare_nodes(near_search *search, int v, int w)
{
  const double gap = thr_distance(search->frame->xyz[v], search->frame->xyz[w]);

  /* Close means a tenth of the shortest edge at either node. */
  if (gap > CLOSE * fmin(fmin(search->shortest[v], search->shortest[w]), search->cell) ||
      thr_frame_edge_between(search->frame, v, w) >= 0)
    return;

  if (search->near->n_close++ == 0 || gap < search->near->gap) {
    search->near->gap = gap;
    search->near->closest[0] = v;
    search->near->closest[1] = w;
  }

  search->widest = fmax(search->widest, gap);
}

/* Compares a node with all nodes of higher number within reach. */
static void find_close_nodes(near_search *search, int v)
{
  /* The cells within reach. */
  const double reach = CLOSE * fmin(search->shortest[v], search->cell);
  const place first = place_of(search, search->frame->xyz[v], -reach),
              highest = place_of(search, search->frame->xyz[v], reach);
  place cell;

  for (cell.x = first.x; cell.x <= highest.x; cell.x++)
    for (cell.y = first.y; cell.y <= highest.y; cell.y++)
      for (cell.z = first.z; cell.z <= highest.z; cell.z++) {
        const uint32_t bucket = bucket_of(search, cell);
        for (int i = search->nodes.start[bucket];
             i < search->nodes.start[bucket + 1] && goes_on(search); i++) {
          const int w = search->nodes.member[i];
          if (w <= v || thr_distance(search->frame->xyz[v], search->frame->xyz[w]) > reach)
            continue;

          /* The bucket may hold nodes of other cells, which get their turn there. */
          const place own = place_of(search, search->frame->xyz[w], 0);
          if (own.x == cell.x && own.y == cell.y && own.z == cell.z) compare_nodes(search, v, w);
        }
      }
}

/* ---- nodes on edges, edges across edges ---- */

/* Returns whether a share of an edge is between its ends, not at one of them. */
static bool is_within(double at)
{
  return at > TOUCHING && at < 1 - TOUCHING;
}

/* Keeps a node that lies on an edge. */
static thr_status compare_node(near_search *search, int v, int e)
{
  if (search->frame->edge[e][0] == v || search->frame->edge[e][1] == v) return THR_OK;
  const double *a = end_of(search, e, 0), *b = end_of(search, e, 1), *point = search->frame->xyz[v];

  /* The foot of the perpendicular, as a share of the edge. */
  const double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]},
               to[3] = {point[0] - a[0], point[1] - a[1], point[2] - a[2]};
  const double at = thr_dot(along, to) / thr_dot(along, along);
  double foot[3];
  if (!is_within(at)) return THR_OK;

  /* Is the node close enough? */
  point_on(search, e, at, foot);
  if (thr_distance(point, foot) >
      TOUCHING * fmin(search->apart[e], fmin(search->shortest[v], 10 * search->cell)))
    return THR_OK;

  /* A node close to one of the ends is a matter of welding. */
  for (int side = 0; side < 2; side++)
    if (thr_distance(point, end_of(search, e, side)) <=
        CLOSE * fmin(search->shortest[v], search->shortest[search->frame->edge[e][side]]))
      return THR_OK;

  thr_status st = thr_grow(&search->touch, search->n_touches, &search->touches_capacity,
                           sizeof *search->touch, search->err);
  if (!st) search->touch[search->n_touches++] = (touch){v, e, at};

  return st;
}

/* Finds where two lines p + t d1 and q + t d2 come closest, as shares of d1 and d2: both scalar
 * products of the connecting vector with the directions are 0, two linear equations. Returns false
 * if the lines are parallel. */
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

/* Counts two edges without a common node that come close to each other between their ends. */
static void compare_edges(near_search *search, int e, int f, uint32_t bucket)
{
  const int *ends = search->frame->edge[e], *other_ends = search->frame->edge[f];

  if (ends[0] == other_ends[0] || ends[0] == other_ends[1] || ends[1] == other_ends[0] ||
      ends[1] == other_ends[1])
    return;

  const double *start = search->frame->xyz[ends[0]],
               *other_start = search->frame->xyz[other_ends[0]],
               *finish = search->frame->xyz[ends[1]],
               *other_finish = search->frame->xyz[other_ends[1]];

  /* Where they come closest, which must be between the ends of both. */
  const double d1[3] = {finish[0] - start[0], finish[1] - start[1], finish[2] - start[2]},
               d2[3] = {other_finish[0] - other_start[0], other_finish[1] - other_start[1],
                        other_finish[2] - other_start[2]};
  double at1, at2, here[3], there[3];

  if (!closest_points(start, d1, other_start, d2, &at1, &at2) || !is_within(at1) || !is_within(at2))
    return;

  /* Close enough? */
  point_on(search, e, at1, here);
  point_on(search, f, at2, there);
  if (thr_distance(here, there) >
      TOUCHING * fmin(fmin(search->apart[e], search->apart[f]), 10 * search->cell))
    return;

  if (bucket_of(search, place_of(search, here, 0)) != bucket)
    return; /* they share other cells as well */

  /* The first pair is an example for the report. */
  if (search->near->n_crossings++ == 0) {
    search->near->crossing[0] = e < f ? e : f;
    search->near->crossing[1] = e < f ? f : e;
  }
}

/* Compares every node with nodes and edges near by. */
static thr_status look_around(near_search *search)
{
  thr_status st = THR_OK;

  /* A node on an edge is in a cell of the edge: the edge was added with its reach. */
  for (int v = 0; v < search->frame->n_nodes && !st && !search->near->tangled; v++) {
    find_close_nodes(search, v);
    const uint32_t bucket = bucket_of(search, place_of(search, search->frame->xyz[v], 0));
    for (int i = search->edges.start[bucket];
         i < search->edges.start[bucket + 1] && !st && goes_on(search); i++)
      st = compare_node(search, v, search->edges.member[i]);
  }

  return st;
}

/* Compares all edges that share a bucket. */
static void look_across(near_search *search)
{
  for (uint32_t bucket = 0; bucket <= search->mask && !search->near->tangled; bucket++)
    for (int i = search->edges.start[bucket]; i < search->edges.start[bucket + 1]; i++)
      for (int j = search->edges.start[bucket]; j < i && goes_on(search); j++)
        compare_edges(search, search->edges.member[j], search->edges.member[i], bucket);
}

/* ---- all of it ---- */

/* Prepares a search: the lengths on which tolerances depend, and the grids. */
static thr_status begin_search(near_search *search, const thr_frame *frame, thr_near *near,
                               thr_err *err)
{
  *near = (thr_near){0};
  *search = (near_search){.frame = frame, .near = near, .err = err};

  /* Tolerances are shares of these lengths. */
  search->apart = thr_calloc((size_t)frame->n_edges, sizeof *search->apart);
  search->shortest = thr_calloc((size_t)frame->n_nodes, sizeof *search->shortest);
  if (!search->apart || !search->shortest) return thr_nomem(err);

  /* The shortest edge at each node. */
  for (int v = 0; v < frame->n_nodes; v++)
    search->shortest[v] = INFINITY;
  for (int e = 0; e < frame->n_edges; e++) {
    search->apart[e] = thr_distance(end_of(search, e, 0), end_of(search, e, 1));
    for (int side = 0; side < 2; side++)
      search->shortest[frame->edge[e][side]] =
          fmin(search->shortest[frame->edge[e][side]], search->apart[e]);
  }

  /* The grids need all lengths. */
  thr_status st = choose_cells(search);
  return st ? st : fill_grids(search);
}

/* Releases the arrays. */
static void end_search(near_search *search)
{
  free(search->apart);
  free(search->shortest);
  free(search->nodes.start);
  free(search->nodes.member);
  free(search->edges.start);
  free(search->edges.member);
  free(search->touch);
}

/* Appends the framework's nodes to a draft, as a reader would have collected them. */
static thr_status add_nodes(const thr_frame *frame, thr_draft *draft, thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < frame->n_nodes && !st; v++)
    st = thr_draft_add_node(draft, frame->xyz[v], frame->name[v], frame->foot[v], err);
  memcpy(draft->units, frame->units, sizeof draft->units);
  return st;
}

/* Appends a share `part` of edge e between nodes a and b; its passes are those of the edge. */
static thr_status add_part(const thr_frame *frame, int e, int a, int b, double part,
                           thr_draft *draft, thr_err *err)
{
  thr_status st =
      thr_draft_add_edge(draft, a, b, frame->own_lengths ? frame->length[e] * part : 0, err);
  return st ? st
            : thr_draft_edge_passes(draft, frame->cover ? frame->cover[e] : 0,
                                    frame->capacity ? frame->capacity[e] : 0, err);
}

/* Computes what welding with the tolerance near->weld would change. */
static thr_status try_weld(const thr_frame *frame, thr_near *near, thr_err *err)
{
  thr_draft draft = {0};
  thr_frame welded = {0};
  thr_read_report report = {0};

  /* The draft that would have made this framework, built with the tolerance. */
  thr_status st = add_nodes(frame, &draft, err);
  for (int e = 0; e < frame->n_edges && !st; e++)
    st = add_part(frame, e, frame->edge[e][0], frame->edge[e][1], 1, &draft, err);

  /* Build, and count what has been welded. */
  if (!st) st = thr_draft_build(&draft, near->weld, &welded, &report, err);
  if (!st) st = thr_frame_components(&welded, NULL, &near->components_welded, err);
  near->n_welded = report.welded_nodes;
  near->n_lost = report.zero_length_edges;
  near->n_merged = report.duplicate_edges;

  thr_draft_destroy(&draft);
  thr_frame_destroy(&welded);
  return st;
}

/* Chooses a tolerance that welds all close pairs: a power of ten of at least twice the widest gap
 * or, if that would make edges vanish, the gap with two digits, rounded up. */
static thr_status choose_weld(const near_search *search, thr_near *near)
{
  /* digit: the second digit of the gap. */
  double least = INFINITY, digit = pow(10, floor(log10(search->widest)) - 1);
  for (int e = 0; e < search->frame->n_edges; e++)
    least = fmin(least, search->apart[e]);

  near->weld = pow(10, ceil(log10(2 * search->widest) - 1e-9));
  if (near->weld >= least) near->weld = (floor(search->widest / digit) + 1) * digit;
  return try_weld(search->frame, near, search->err);
}

/* Searches for nodes near nodes, nodes on edges and edges across edges, and tries a weld if nodes
 * are close. */
thr_status thr_frame_near(const thr_frame *frame, thr_near *near, thr_err *err)
{
  near_search search;
  thr_status st = begin_search(&search, frame, near, err);

  /* Nodes, then edges, then what they found. */
  if (!st) st = look_around(&search);
  if (!st) look_across(&search);
  near->n_on_edge = search.n_touches;
  if (search.n_touches) near->on_edge[0] = search.touch[0].node;
  if (search.n_touches) near->on_edge[1] = search.touch[0].edge;

  if (!st) st = thr_frame_components(frame, NULL, &near->components, err);
  if (!st && near->n_close) st = choose_weld(&search, near);
  end_search(&search);

  return st;
}

/* ---- edges cut where nodes lie on them ---- */

/* Compares two nodes on edges: by edge, then along the edge. */
static int along_edges(const void *pa, const void *pb)
{
  const touch *a = pa, *b = pb;
  if (a->edge != b->edge) return a->edge < b->edge ? -1 : 1;
  if (a->at != b->at) return a->at < b->at ? -1 : 1;
  return (a->node > b->node) - (a->node < b->node);
}

/* Appends the edges in their order to a draft, each edge that is cut as its parts. search->touch
 * must be sorted along the edges. */
static thr_status cut(const near_search *search, thr_draft *draft, int *n_cut)
{
  const thr_frame *frame = search->frame;
  thr_status st = THR_OK;
  *n_cut = 0;

  for (int e = 0, i = 0; e < frame->n_edges && !st; e++) {
    int from = frame->edge[e][0];
    double at = 0;

    /* Part after part, from node to node on the edge; the last part ends at the edge's own end. */
    *n_cut += i < search->n_touches && search->touch[i].edge == e;
    for (; i < search->n_touches && search->touch[i].edge == e && !st; i++) {
      st = add_part(frame, e, from, search->touch[i].node, search->touch[i].at - at, draft,
                    search->err);
      from = search->touch[i].node;
      at = search->touch[i].at;
    }
    if (!st) st = add_part(frame, e, from, frame->edge[e][1], 1 - at, draft, search->err);
  }

  return st;
}

/* Searches for nodes on edges, and builds the framework again with the parts of edges. */
thr_status thr_frame_split(thr_frame *frame, int *n_cut, thr_read_report *report, thr_err *err)
{
  near_search search;
  thr_near near;
  thr_draft draft = {0};
  thr_frame split = {0};
  thr_read_report done = {0};
  *n_cut = 0;

  thr_status st = begin_search(&search, frame, &near, err);

  if (!st) st = look_around(&search);
  if (!st && near.tangled)
    st = thr_fail(err, THR_ELIMIT,
                  "too many edges pass close to each other to find all nodes that lie on them");

  /* Nothing to cut: the framework stays as it is. */
  if (st || !search.n_touches) goto done;
  qsort(search.touch, (size_t)search.n_touches, sizeof *search.touch, along_edges);
  st = add_nodes(frame, &draft, err);
  if (!st) st = cut(&search, &draft, n_cut);
  if (!st) st = thr_draft_build(&draft, 0, &split, &done, err);

  if (st) goto done;

  /* Parts that are edges already have been dropped. */
  report->duplicate_edges += done.duplicate_edges;
  thr_frame_destroy(frame);
  *frame = split;
done:
  thr_draft_destroy(&draft);

  end_search(&search);
  return st;
}
