/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes and describes the framework: a simple graph whose nodes have coordinates. Nodes are beads,
 * edges are interfaces between beads (docs/formats.md).
 *
 * Readers fill a draft with what a file says. thr_draft_build makes a framework of the draft: nodes
 * closer than a tolerance are welded to one node (the lowest in the file), edges that become loops
 * or repeat another edge are dropped, and nodes without edges, too. What is left keeps the order of
 * the file.
 *
 * Example: nodes 0 (0, 0, 0), 1 (20, 0, 0), 2 (20, 0, 1e-9) and edges 0-1, 2-0, 1-2 become two
 * nodes and one edge. */
#include "graph/framework/frame.h"
#include "graph/arrays.h"
#include "graph/number.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lengths outside these bounds are nonsense in any unit, and their sums and quotients would
 * overflow. */
static const double SHORTEST = 1e-100, LONGEST = 1e100;

/* Start of the 64-bit hash FNV-1a (Fowler, Noll, Vo). */
#define FNV_START UINT64_C(14695981039346656037)

/* Returns a hash continued by n bytes: for each byte an exclusive or, then a product with the FNV
 * prime. */
static uint64_t fnv(uint64_t hash, const void *bytes, size_t n)
{
  const unsigned char *b = bytes;
  for (size_t i = 0; i < n; i++)
    hash = (hash ^ b[i]) * UINT64_C(1099511628211);
  return hash;
}

/* ---- drafts ---- */

thr_status thr_draft_add_node(thr_draft *draft, const double xyz[3], const char *name, bool foot,
                              thr_err *err)
{
  /* Nodes without a finite place have no distances; !(a < b) is also true of NaN. */
  for (int i = 0; i < 3; i++)
    if (!(fabs(xyz[i]) < LONGEST))
      return thr_fail(err, THR_EINPUT,
                      "node %d has a coordinate that is not a finite number below %g",
                      draft->n_nodes, LONGEST);

  thr_status st =
      thr_grow(&draft->node, draft->n_nodes, &draft->nodes_capacity, sizeof *draft->node, err);
  if (st) return st;

  /* Names follow one another in one text; the node keeps where its name begins. */
  size_t at = draft->names.length;
  if (name) {
    thr_text_append_clean(&draft->names, name);
    thr_text_append_bytes(&draft->names, "", 1);
  }

  /* Places in the text are ints. */
  if (draft->names.failed || draft->names.length > INT_MAX) return thr_nomem(err);
  draft->node[draft->n_nodes++] =
      (struct thr_draft_node){{xyz[0], xyz[1], xyz[2]}, name ? (int)at : -1, foot};

  return THR_OK;
}

const char *thr_draft_name(const thr_draft *draft, int v)
{
  return draft->node[v].name < 0 ? NULL : draft->names.data + draft->node[v].name;
}

thr_status thr_draft_add_edge(thr_draft *draft, int a, int b, double length, thr_err *err)
{
  /* The first end that does not exist is named. */
  int worst = a < 0 || a >= draft->n_nodes ? a : b;
  if (worst < 0 || worst >= draft->n_nodes)
    return thr_fail(err, THR_EINPUT, "edge %d names node %d, but there are %d nodes",
                    draft->n_edges, worst, draft->n_nodes);

  thr_status st =
      thr_grow(&draft->edge, draft->n_edges, &draft->edges_capacity, sizeof *draft->edge, err);
  if (st) return st;
  draft->edge[draft->n_edges++] = (struct thr_draft_edge){.a = a, .b = b, .length = length};

  return THR_OK;
}

thr_status thr_draft_edge_passes(thr_draft *draft, int cover, int capacity, thr_err *err)
{
  /* The edge added last. */
  int e = draft->n_edges - 1;
  if (cover < 0 || cover > 100)
    return thr_fail(err, THR_EINPUT, "edge %d needs %d passes; a cover lies between 1 and 100", e,
                    cover);

  if (capacity < 0 || capacity > 100 || (capacity > 0 && capacity < cover))
    return thr_fail(err, THR_EINPUT,
                    "edge %d has room for %d passes; a capacity lies between the cover and 100", e,
                    capacity);

  draft->edge[e].cover = cover;
  draft->edge[e].capacity = capacity;
  return THR_OK;
}

thr_status thr_draft_set_units(thr_draft *draft, const char *units, thr_err *err)
{
  const char *name;
  thr_status st = thr_units_find(units, &name, err);
  if (!st) snprintf(draft->units, sizeof draft->units, "%s", name);
  return st;
}

/* Copies nodes and edges behind those that there are. */
thr_status thr_draft_append(thr_draft *draft, const thr_draft *other, const char *prefix,
                            thr_err *err)
{
  const int base = draft->n_nodes;
  thr_text name = {0};
  thr_status st = THR_OK;

  /* Each copy is called prefix + name, also if the other draft calls the node by its index. */
  for (int v = 0; v < other->n_nodes && !st; v++) {
    const char *own = thr_draft_name(other, v);
    name.length = 0;
    thr_text_append(&name, prefix);
    if (own) thr_text_append(&name, own);
    if (!own) thr_text_int(&name, v);
    st = name.failed
             ? thr_nomem(err)
             : thr_draft_add_node(draft, other->node[v].xyz, name.data, other->node[v].foot, err);
  }

  /* Indices move by the number of nodes that were there before. */
  for (int e = 0; e < other->n_edges && !st; e++) {
    const struct thr_draft_edge *edge = &other->edge[e];
    st = thr_draft_add_edge(draft, base + edge->a, base + edge->b, edge->length, err);
    if (!st) st = thr_draft_edge_passes(draft, edge->cover, edge->capacity, err);
  }

  /* Both drafts come from one file, so the units agree. */
  memcpy(draft->units, other->units, sizeof draft->units);
  thr_text_destroy(&name);
  return st;
}

void thr_draft_destroy(thr_draft *draft)
{
  thr_text_destroy(&draft->names);
  free(draft->node);
  free(draft->edge);
  *draft = (thr_draft){0};
}

/* ---- welding ---- */

/* A node and where its projection lies. Nodes within the tolerance of each other are also within
 * the tolerance in their projections on any unit vector. So nodes are sorted by a projection that
 * the nodes of regular grids do not share, and each node is compared only with the window of nodes
 * that lie at most the tolerance before it. */
typedef struct {
  double along; /* projection on a fixed unit direction */
  const double *xyz;
  int node;
} projected;

/* Compares two nodes by projection, then by x, y, z, so that nodes at one place are neighbours,
 * then by number. */
static int by_projection(const void *pa, const void *pb)
{
  const projected *a = pa, *b = pb;

  /* Most comparisons end here. */
  if (a->along != b->along) return a->along < b->along ? -1 : 1;
  for (int i = 0; i < 3; i++)
    if (a->xyz[i] != b->xyz[i]) return a->xyz[i] < b->xyz[i] ? -1 : 1;

  return (a->node > b->node) - (a->node < b->node);
}

/* Returns the bucket of a node, of n buckets of equal width from low to high: a monotone function
 * of the projection. Only `high` itself falls into bucket n - 1. */
static int bucket_of(const projected *item, double low, double high, int n)
{
  return high > low ? (int)((item->along - low) / (high - low) * (n - 1)) : 0;
}

/* Sorts p[n] by projection: distributes the nodes to one bucket for each, then sorts each bucket by
 * itself. O(n) on average where nodes are spread evenly. */
static thr_status sort_projected(projected *item, int n, thr_err *err)
{
  projected *sorted = thr_calloc((size_t)n, sizeof *sorted);
  int *start =
      thr_calloc((size_t)n + 2,
                 sizeof *start); /* shifted by one place so that filling leaves the starts right */
  thr_status st = sorted && start ? THR_OK : thr_nomem(err);

  /* The range of the projections. */
  double low = item[0].along, high = low;
  for (int i = 1; i < n; i++) {
    low = fmin(low, item[i].along);
    high = fmax(high, item[i].along);
  }

  /* Count each bucket, sum up to the starts, and distribute (counting sort). */
  for (int i = 0; i < n && !st; i++)
    start[bucket_of(&item[i], low, high, n) + 2]++;
  for (int i = 2; i <= n + 1 && !st; i++)
    start[i] += start[i - 1];

  for (int i = 0; i < n && !st; i++)
    sorted[start[bucket_of(&item[i], low, high, n) + 1]++] = item[i];

  /* Sort inside each bucket; nearly all hold one or two nodes. */
  for (int i = 0; i < n && !st; i++)
    if (start[i + 1] - start[i] > 1)
      qsort(sorted + start[i], (size_t)(start[i + 1] - start[i]), sizeof *sorted, by_projection);

  if (!st) memcpy(item, sorted, (size_t)n * sizeof *item);
  free(sorted);
  free(start);

  return st;
}

/* Fills parent[n_nodes] with the lowest node of each node's welded group: the connected components
 * of the graph of all pairs within the tolerance. Groups can be wider than the tolerance. */
static thr_status weld(const thr_draft *draft, double tolerance, int *parent, thr_err *err)
{
  int n = draft->n_nodes;
  projected *order = thr_calloc((size_t)n, sizeof *order);

  if (!order) return thr_nomem(err);

  /* Project on (0.6324, 0.5477, 0.5478), which has length 0.99999: never above 1, so that
   * projections are never further apart than nodes. */
  for (int v = 0; v < n; v++) {
    const double *xyz = draft->node[v].xyz;
    parent[v] = v;
    order[v] = (projected){0.6324 * xyz[0] + 0.5477 * xyz[1] + 0.5478 * xyz[2], xyz,
                           v}; /* length 0.99999: never above 1 */
  }

  thr_status st = sort_projected(order, n, err);

  /* Compare each node with those before it, back to the first one whose projection is too far
   * away. */
  for (int i = 0; i < n && !st; i++)
    for (int j = i - 1; j >= 0 && !(order[i].along - order[j].along > tolerance); j--) {
      double apart = thr_distance(order[i].xyz, order[j].xyz);
      if (apart <= tolerance) thr_disjoint_join(parent, order[i].node, order[j].node);

      if (apart == 0) break;     /* what is close to this node was compared with its twin already */
      if (tolerance == 0) break; /* twins are neighbours */
    }

  /* Make every node name its group's lowest node. */
  for (int v = 0; v < n; v++)
    parent[v] = thr_disjoint_find(parent, v);

  free(order);
  return st;
}

/* Returns the diagonal of the bounding box of n points, which are stride bytes apart. */
static double diagonal_of(const double (*xyz)[3], int n, size_t stride)
{
  double low[3] = {0}, high[3] = {0};

  for (int v = 0; v < n; v++) {
    const double *point = (const double *)(const void *)((const char *)xyz + (size_t)v * stride);
    for (int i = 0; i < 3; i++) {
      if (v == 0 || point[i] < low[i]) low[i] = point[i];
      if (v == 0 || point[i] > high[i]) high[i] = point[i];
    }
  }

  return thr_distance(low, high);
}

/* Computes the tolerance for welding where none is given: 1e-6 of the bounding box's diagonal, but
 * no more than a thousandth of the median edge. A stray node far away makes the diagonal long, and
 * must not weld everything else together. There must be at least one edge. */
static thr_status default_tolerance(const thr_draft *draft, double *tolerance, thr_err *err)
{
  double *length = thr_calloc((size_t)draft->n_edges, sizeof *length);

  if (!length) return thr_nomem(err);

  /* The lengths of edges, but for those between nodes at one place. */
  int n = 0;
  for (int e = 0; e < draft->n_edges; e++) {
    double apart =
        thr_distance(draft->node[draft->edge[e].a].xyz, draft->node[draft->edge[e].b].xyz);
    if (apart > 0) length[n++] = apart;
  }
  *tolerance = 1e-6 * diagonal_of((const double(*)[3])draft->node[0].xyz, draft->n_nodes,
                                  sizeof *draft->node);

  /* The median lies below a bound if more than half of the lengths do. Only then sorting is
   * necessary. */
  int shorter = 0;
  for (int i = 0; i < n; i++)
    shorter += 1e-3 * length[i] < *tolerance;

  if (shorter > n / 2) { /* so is the median */
    thr_sort_doubles(length, (size_t)n);
    *tolerance = 1e-3 * length[n / 2];
  }

  free(length);
  return THR_OK;
}

/* ---- from draft to framework ---- */

/* An edge between two different welded nodes low < high. */
typedef struct {
  int low, high, edge;
  double length;
} joining; /* of two welded nodes */

/* Compares two edges by their ends, then by length, then by number. */
static int by_ends(const void *pa, const void *pb)
{
  const joining *a = pa, *b = pb;
  if (a->low != b->low) return a->low < b->low ? -1 : 1;
  if (a->high != b->high) return a->high < b->high ? -1 : 1;
  if (a->length != b->length) return a->length < b->length ? -1 : 1;
  return (a->edge > b->edge) - (a->edge < b->edge);
}

/* Lists the edges that are no loops by their ends, then by length. The caller frees *list, also on
 * failure. */
static thr_status list_by_ends(const thr_draft *draft, const int *parent, joining **list, int *n,
                               thr_err *err)
{
  *n = 0;
  *list = thr_calloc((size_t)draft->n_edges, sizeof **list);
  if (!*list) return thr_nomem(err);

  /* Lengths that the file does not give are the distances of the welded nodes. */
  for (int e = 0; e < draft->n_edges; e++) {
    const int a = parent[draft->edge[e].a], b = parent[draft->edge[e].b];
    const double given = draft->edge[e].length;
    if (a == b) continue;
    const double length = given != 0 ? given : thr_distance(draft->node[a].xyz, draft->node[b].xyz);
    (*list)[(*n)++] = (joining){a < b ? a : b, a < b ? b : a, e, length};
  }

  /* So that edges between the same nodes are neighbours. */
  qsort(*list, (size_t)*n, sizeof **list, by_ends);
  return THR_OK;
}

/* Returns how many edges of the list, from i on, join the same two nodes. */
static int size_of_group(const joining *list, int n, int i)
{
  int end = i + 1;
  while (end < n && list[end].low == list[i].low && list[end].high == list[i].high)
    end++;
  return end - i;
}

/* Returns whether edge i of a list of parallel edges is longer than the one before it, by more than
 * rounding. */
static bool is_longer(const joining *list, int i)
{
  return list[i].length > list[i - 1].length * (1 + 1e-6);
}

/* Appends what a node is called to a message, its index if the draft has no name for it. */
static void append_node(char *text, size_t size, const thr_draft *draft, int v)
{
  const size_t n = strlen(text);
  const char *name = thr_draft_name(draft, v);
  if (name)
    snprintf(text + n, size - n, "%.20s", name);
  else
    snprintf(text + n, size - n, "%d", v);
}

/* Marks in keep[n_edges], of each group of edges between the same nodes, the shortest one instead
 * of the first. The report counts the others that have another length, and tells their lengths
 * beside the shortest. */
static thr_status keep_shortest(const thr_draft *draft, const int *parent, bool *keep,
                                thr_read_report *report, thr_err *err)
{
  joining *list;
  int n;
  thr_status st = list_by_ends(draft, parent, &list, &n, err);

  /* Groups are runs of the sorted list, the shortest edge first. */
  for (int i = 0, size; i < n && !st; i += size) {
    size = size_of_group(list, n, i);
    for (int k = i; k < i + size; k++) {
      char *text = report->parallel;
      keep[list[k].edge] = k == i;

      /* Edges of one length, up to rounding, differ in nothing worth a note. */
      if (k == i || !is_longer(list, k)) continue;

      /* Append "A to B: 25 beside 20"; snprintf cuts the text where the report is full. */
      if (report->parallel_edges++)
        snprintf(text + strlen(text), sizeof report->parallel - strlen(text), "; ");
      append_node(text, sizeof report->parallel, draft, list[k].low);
      snprintf(text + strlen(text), sizeof report->parallel - strlen(text), " to ");
      append_node(text, sizeof report->parallel, draft, list[k].high);
      snprintf(text + strlen(text), sizeof report->parallel - strlen(text), ": %.6g beside %.6g",
               list[k].length, list[i].length);
    }
  }

  free(list);
  return st;
}

/* Marks in keep[n_edges] the edges that survive: not of zero length, and of those that join the
 * same nodes the shortest. Counts the others in the report. O(n + m), unless there are parallel
 * edges. */
static thr_status choose_edges(const thr_draft *draft, const int *parent, bool *keep,
                               thr_read_report *report, thr_err *err)
{
  /* The edges by lower end: first[low] begins a list that next continues, by ascending number. */
  int *next = thr_calloc((size_t)draft->n_edges,
                         sizeof *next); /* of the edges with one lower end, by number */
  int *first = thr_calloc((size_t)draft->n_nodes, sizeof *first),
      *seen = thr_calloc((size_t)draft->n_nodes, sizeof *seen);
  thr_status st = next && first && seen ? THR_OK : thr_nomem(err);

  for (int v = 0; v < draft->n_nodes && !st; v++)
    first[v] = seen[v] = -1;

  /* Going backwards makes the lists ascend. */
  for (int e = draft->n_edges - 1; e >= 0 && !st; e--) {
    int a = parent[draft->edge[e].a], b = parent[draft->edge[e].b], low = a < b ? a : b;
    next[e] = first[low];
    if (a != b) first[low] = e;
    report->zero_length_edges += a == b;
  }

  /* Of each lower end, seen[high] = v says that an edge from v to `high` has come already. */
  for (int v = 0; v < draft->n_nodes && !st; v++)
    for (int e = first[v]; e >= 0; e = next[e]) {
      int a = parent[draft->edge[e].a], b = parent[draft->edge[e].b], high = a < b ? b : a;
      keep[e] = seen[high] != v;
      report->duplicate_edges += !keep[e];
      seen[high] = v;
    }

  free(next);
  free(first);
  free(seen);

  /* Parallel edges are rare: only then they are sorted by length. */
  return st || !report->duplicate_edges ? st : keep_shortest(draft, parent, keep, report, err);
}

/* Puts a node on the straight line of edge e, at a share 0 < share < 1 of its length from its first
 * end, and makes two edges of the edge. The node is called "a~b~number" after the ends of the
 * edge. */
static thr_status part_edge(thr_draft *draft, int e, double share, int number, thr_err *err)
{
  const struct thr_draft_edge edge = draft->edge[e];
  const struct thr_draft_node *a = &draft->node[edge.a], *b = &draft->node[edge.b];
  double xyz[3];
  char name[80] = "";

  /* The place, and the length that both parts share. */
  for (int i = 0; i < 3; i++)
    xyz[i] = (1 - share) * a->xyz[i] + share * b->xyz[i];

  const double length = edge.length != 0 ? edge.length : thr_distance(a->xyz, b->xyz);

  /* The name. */
  append_node(name, sizeof name, draft, edge.a);
  snprintf(name + strlen(name), sizeof name - strlen(name), "~");
  append_node(name, sizeof name, draft, edge.b);
  snprintf(name + strlen(name), sizeof name - strlen(name), "~%d", number);
  thr_status st = thr_draft_add_node(draft, xyz, name, false, err);

  /* The second part is a new edge, which needs and takes as many passes; the first part replaces
   * the edge. */
  if (!st) st = thr_draft_add_edge(draft, draft->n_nodes - 1, edge.b, (1 - share) * length, err);
  if (st) return st;
  draft->edge[draft->n_edges - 1].cover = edge.cover;
  draft->edge[draft->n_edges - 1].capacity = edge.capacity;
  draft->edge[e].b = draft->n_nodes - 1;
  draft->edge[e].length = share * length;

  return THR_OK;
}

/* Parts parallel edges of different lengths, found by welding as thr_draft_build does. */
thr_status thr_draft_keep_parallel(thr_draft *draft, double tolerance, thr_err *err)
{
  joining *list = NULL;
  int n = 0, *parent = NULL;

  if (draft->n_edges == 0) return THR_OK; /* an error of who builds it */

  /* Weld and sort as thr_draft_build will, so that the same edges fall together. */
  thr_status st = tolerance < 0 ? default_tolerance(draft, &tolerance, err) : THR_OK;
  if (!st)
    st = (parent = thr_calloc((size_t)draft->n_nodes, sizeof *parent)) ? THR_OK : thr_nomem(err);

  if (!st) st = weld(draft, tolerance, parent, err);
  if (!st) st = list_by_ends(draft, parent, &list, &n, err);

  /* Part each edge that differs in length from the one before it in its group: of two such edges at
   * 1/3 and 2/3 of the line, so that the new nodes differ. */
  for (int i = 0, size; i < n && !st; i += size) {
    size = size_of_group(list, n, i);
    int longer = 0, parted = 0;
    for (int k = i + 1; k < i + size; k++)
      longer += is_longer(list, k);
    for (int k = i + 1; k < i + size && !st; k++) {
      struct thr_draft_edge *edge = &draft->edge[list[k].edge];

      /* Shares count from the lower end. */
      const double share = (double)(parted + 1) / (longer + 1);
      if (is_longer(list, k))
        st = part_edge(draft, list[k].edge, parent[edge->a] == list[k].low ? share : 1 - share,
                       ++parted, err);
      else if (parted) /* as long as the one before it, whose first half it repeats */
        *edge = draft->edge[list[k - 1].edge];
    }
  }

  free(list);
  free(parent);
  return st;
}

/* Allocates a framework's arrays, zero, but for the passes. On failure those that there are stay
 * for thr_frame_destroy. */
static thr_status allocate(thr_frame *frame, int n_nodes, int n_edges, thr_err *err)
{
  frame->n_nodes = n_nodes;
  frame->n_edges = n_edges;
  frame->xyz = thr_calloc((size_t)n_nodes, sizeof *frame->xyz);
  frame->foot = thr_calloc((size_t)n_nodes, sizeof *frame->foot);
  frame->name = thr_calloc((size_t)n_nodes, sizeof *frame->name);
  frame->edge = thr_calloc((size_t)n_edges, sizeof *frame->edge);
  frame->length = thr_calloc((size_t)n_edges, sizeof *frame->length);
  frame->first = thr_calloc((size_t)n_nodes + 1, sizeof *frame->first);
  frame->half = thr_calloc(2 * (size_t)n_edges, sizeof *frame->half);

  /* All that was allocated must be there. */
  return frame->xyz && frame->foot && frame->name && frame->edge && frame->length && frame->first &&
                 frame->half
             ? THR_OK
             : thr_nomem(err);
}

/* Allocates the covers or capacities, which most frameworks do not have. */
static thr_status allocate_passes(thr_frame *frame, bool covers, bool capacities, thr_err *err)
{
  size_t m = (size_t)frame->n_edges;
  if (covers && !(frame->cover = thr_calloc(m, sizeof *frame->cover))) return thr_nomem(err);
  if (capacities && !(frame->capacity = thr_calloc(m, sizeof *frame->capacity)))
    return thr_nomem(err);
  return THR_OK;
}

void thr_frame_index(thr_frame *frame)
{
  /* Counting sort of the half-edges by tail. Degrees first, in first[v + 1]. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    frame->first[thr_tail(frame, h) + 1]++;

  /* Their sums are the starts. */
  for (int v = 0; v < frame->n_nodes; v++)
    frame->first[v + 1] += frame->first[v];

  /* Filling moves each start to its end, which is the next node's start. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    frame->half[frame->first[thr_tail(frame, h)]++] = h;

  /* Move all starts back by one node. */
  for (int v = frame->n_nodes; v > 0; v--)
    frame->first[v] = frame->first[v - 1];

  frame->first[0] = 0;
}

thr_status thr_frame_take_names(thr_frame *frame, thr_text *names, thr_err *err)
{
  /* A text that failed has lost bytes. */
  if (names->failed) {
    thr_text_destroy(names);
    return thr_nomem(err);
  }

  free(frame->names);
  frame->names = names->data;
  *names = (thr_text){0};

  /* The names follow one another, each ended by a NUL. */
  char *at = frame->names;
  for (int v = 0; v < frame->n_nodes; v++, at += strlen(at) + 1)
    frame->name[v] = at;

  return THR_OK;
}

/* Appends what a node is called, its index where the draft has no name for it, and a NUL. */
static void append_name(thr_text *names, const thr_draft *draft, int v)
{
  if (thr_draft_name(draft, v))
    thr_text_append(names, thr_draft_name(draft, v));
  else
    thr_text_int(names, v);
  thr_text_append_bytes(names, "", 1);
}

/* Fills the nodes of a framework. index[parent[v]] is the node that v becomes, or -1 if v is left
 * out. Any member of a welded group may make the node a foot; place and name are those of the
 * lowest. */
static thr_status fill_nodes(thr_frame *frame, const thr_draft *draft, const int *parent,
                             const int *index, thr_err *err)
{
  thr_text names = {0};

  for (int v = 0; v < draft->n_nodes; v++) {
    int i = index[parent[v]];
    if (i < 0) continue;
    if (draft->node[v].foot) frame->foot[i] = true;

    /* Only the lowest member goes on from here; members come in ascending order, so names do,
     * too. */
    if (parent[v] != v) continue;
    memcpy(frame->xyz[i], draft->node[v].xyz, sizeof frame->xyz[i]);
    append_name(&names, draft, v);
  }

  return thr_frame_take_names(frame, &names, err);
}

/* A name and its node in the draft, for sorting. */
typedef struct {
  const char *name;
  int node; /* of the draft */
} named;

/* Compares two names as bytes, then by node. */
static int by_name(const void *pa, const void *pb)
{
  const named *a = pa, *b = pb;
  int order = strcmp(a->name, b->name);
  return order ? order : (a->node > b->node) - (a->node < b->node);
}

/* Finds out whether all nodes have different names, by a hash table with linear probing.
 * O(bytes). */
static thr_status names_differ(const thr_frame *frame, bool *differ, thr_err *err)
{
  /* A power of two, at most half full. */
  size_t places = 1;
  while (places < 2 * (size_t)frame->n_nodes)
    places *= 2;

  int *table = thr_calloc(places, sizeof *table); /* node + 1 */
  if (!table) return thr_nomem(err);
  *differ = true;

  /* Look for the name from the place that its hash says. */
  for (int v = 0; v < frame->n_nodes && *differ; v++) {
    const uint64_t hash = fnv(FNV_START, frame->name[v], strlen(frame->name[v]));
    size_t at = (hash ^ hash >> 32) & (places - 1);
    while (table[at] && strcmp(frame->name[table[at] - 1], frame->name[v]) != 0)
      at = (at + 1) & (places - 1);
    *differ = !table[at];
    table[at] = v + 1;
  }

  free(table);
  return THR_OK;
}

/* Checks that all names differ, because options and tables call nodes by their names. THR_EINPUT
 * with the first two nodes of one name. O(bytes), and O(n log n) if there are such nodes. */
static thr_status check_names(const thr_frame *frame, const thr_draft *draft, const int *parent,
                              const int *index, thr_err *err)
{
  /* Nodes without names are called by their indices, of which no two are the same. */
  bool indices = true;
  for (int v = 0; v < draft->n_nodes && indices; v++)
    indices = !thr_draft_name(draft, v);

  if (indices) return THR_OK;
  bool differ;
  thr_status st = names_differ(frame, &differ, err);
  if (st || differ) return st;

  /* Sort to find which two nodes share a name. */
  named *list = thr_calloc((size_t)frame->n_nodes, sizeof *list);
  if (!list) return thr_nomem(err);
  for (int v = 0; v < draft->n_nodes; v++)
    if (parent[v] == v && index[v] >= 0) list[index[v]] = (named){frame->name[index[v]], v};

  qsort(list, (size_t)frame->n_nodes, sizeof *list, by_name);
  for (int i = 1; i < frame->n_nodes && !st; i++)
    if (strcmp(list[i - 1].name, list[i].name) == 0)
      st = thr_fail(
          err, THR_EINPUT,
          "nodes %d and %d, counted from 0, are both called '%.40s'; give each its own name",
          list[i - 1].node, list[i].node, list[i].name);

  free(list);
  return st;
}

/* Fills the edges that are kept. THR_EINPUT if a length is out of range. */
static thr_status fill_edges(thr_frame *frame, const thr_draft *draft, const int *parent,
                             const int *index, const bool *keep, thr_err *err)
{
  int n = 0;

  for (int e = 0; e < draft->n_edges; e++) {
    if (!keep[e]) continue;
    int a = index[parent[draft->edge[e].a]], b = index[parent[draft->edge[e].b]];

    /* A length that is given counts, even if it is shorter than the distance of the nodes. */
    double given = draft->edge[e].length, euclidean = thr_distance(frame->xyz[a], frame->xyz[b]);
    double length = given != 0 ? given : euclidean;

    /* Nodes at one place give the edge no direction, and so no angles of turning. */
    if (!(euclidean > SHORTEST)) length = euclidean;
    if (!(length > SHORTEST && length < LONGEST))
      return thr_fail(err, THR_EINPUT,
                      "edge %d (%s to %s) has length %g; lengths must lie between %g and %g", e,
                      frame->name[a], frame->name[b], length, SHORTEST, LONGEST);
    if (given != 0) frame->own_lengths = true;
    frame->edge[n][0] = a;
    frame->edge[n][1] = b;
    frame->length[n++] = length;
  }

  return THR_OK;
}

/* Fills covers and capacities, if any edge that is kept has one. Edges without a cover need 1
 * pass. */
static thr_status fill_passes(thr_frame *frame, const thr_draft *draft, const bool *keep,
                              thr_err *err)
{
  bool covers = false, capacities = false;

  /* Most frameworks have neither, and get no arrays. */
  for (int e = 0; e < draft->n_edges; e++) {
    covers |= keep[e] && draft->edge[e].cover > 0;
    capacities |= keep[e] && draft->edge[e].capacity > 0;
  }

  thr_status st = allocate_passes(frame, covers, capacities, err);
  for (int e = 0, n = 0; e < draft->n_edges && !st; e++) {
    if (!keep[e]) continue;
    if (covers) frame->cover[n] = draft->edge[e].cover > 0 ? draft->edge[e].cover : 1;
    if (capacities) frame->capacity[n] = draft->edge[e].capacity;
    n++;
  }

  return st;
}

/* Records THR_EINPUT with why no edge of a draft is kept: all are loops in the file already, or
 * welding made loops of them. */
static thr_status fail_without_edges(const thr_draft *draft, double tolerance, thr_err *err)
{
  bool loops = true;

  for (int e = 0; e < draft->n_edges; e++)
    loops = loops && draft->edge[e].a == draft->edge[e].b;

  /* Two different mistakes: in the file, or of the tolerance. */
  if (loops)
    return thr_fail(err, THR_EINPUT,
                    "every edge joins a node to itself; check what is given as its two ends");

  return thr_fail(err, THR_EINPUT,
                  "every edge has zero length: its ends are one node, or within the weld tolerance "
                  "%g; use a smaller --weld",
                  tolerance);
}

/* Builds a framework: chooses a tolerance, welds, chooses edges, numbers the nodes that are left,
 * and fills the arrays. */
thr_status thr_draft_build(const thr_draft *draft, double tolerance, thr_frame *frame,
                           thr_read_report *report, thr_err *err)
{
  /* On failure *report keeps what it said before. */
  thr_frame framework = {0};
  thr_read_report read_report = *report;
  *frame = framework;
  read_report.nodes_read = draft->n_nodes;
  read_report.edges_read = draft->n_edges;

  if (draft->n_edges == 0)
    return thr_fail(err, THR_EINPUT,
                    "no edge found; a framework needs at least one edge between two nodes");

  /* Weld, then choose edges. */
  thr_status st = THR_OK;
  if (tolerance < 0 && (st = default_tolerance(draft, &tolerance, err))) return st;
  read_report.weld_tolerance = tolerance;

  int *parent = thr_calloc((size_t)draft->n_nodes, sizeof *parent);
  int *index = thr_calloc((size_t)draft->n_nodes, sizeof *index);
  bool *keep = thr_calloc((size_t)draft->n_edges, sizeof *keep);

  if (!parent || !index || !keep) {
    st = thr_nomem(err);
    goto done;
  }

  if ((st = weld(draft, tolerance, parent, err))) goto done;
  if ((st = choose_edges(draft, parent, keep, &read_report, err))) goto done;

  /* The nodes that an edge which is kept ends at get index 1, all others 0. */
  int n_nodes = 0, n_edges = 0;
  for (int e = 0; e < draft->n_edges; e++)
    if (keep[e]) {
      n_edges++;
      index[parent[draft->edge[e].a]] = index[parent[draft->edge[e].b]] = 1;
    }

  if (n_edges == 0) {
    st = fail_without_edges(draft, tolerance, err);
    goto done;
  }

  /* Number the nodes that stay: lowest of their group, and not isolated. */
  for (int v = 0; v < draft->n_nodes; v++) {
    if (parent[v] != v) {
      read_report.welded_nodes++;
      index[v] = -1;
    } else if (index[v]) {
      index[v] = n_nodes++;
    } else {
      read_report.isolated_nodes++;
      index[v] = -1;
    }
  }

  /* Fill the framework with what is left. */
  if ((st = allocate(&framework, n_nodes, n_edges, err))) goto done;
  if ((st = fill_nodes(&framework, draft, parent, index, err))) goto done;
  if ((st = check_names(&framework, draft, parent, index, err))) goto done;
  if ((st = fill_edges(&framework, draft, parent, index, keep, err))) goto done;
  if ((st = fill_passes(&framework, draft, keep, err))) goto done;

  snprintf(framework.units, sizeof framework.units, "%s", draft->units[0] ? draft->units : "mm");
  thr_frame_index(&framework);
  *report = read_report;
done:
  if (st) thr_frame_destroy(&framework);
  *frame = framework;

  free(parent);
  free(index);
  free(keep);

  return st;
}

/* Returns whether a name is the number v as text, which readers call nodes without a name. */
static bool is_index(const char *name, int v)
{
  char digits[THR_INT_TEXT];
  size_t n = thr_int_print(v, digits);
  return strlen(name) == n && memcmp(name, digits, n) == 0;
}

/* Returns whether node v of the draft is node v of the framework. */
static bool says_node(const thr_draft *draft, const thr_frame *frame, int v)
{
  const struct thr_draft_node *node = &draft->node[v];
  const char *name = thr_draft_name(draft, v);

  /* By their bytes, as the hash takes them: -0 is not 0. */
  const bool same_place = memcmp(node->xyz, frame->xyz[v], sizeof node->xyz) == 0;
  return same_place && node->foot == frame->foot[v] &&
         (name ? strcmp(name, frame->name[v]) == 0 : is_index(frame->name[v], v));
}

/* Returns whether edge e of the draft is edge e of the framework. */
static bool says_edge(const thr_draft *draft, const thr_frame *frame, int e)
{
  const struct thr_draft_edge *edge = &draft->edge[e];
  const double length =
      frame->own_lengths ? edge->length : thr_distance(frame->xyz[edge->a], frame->xyz[edge->b]);

  return edge->a == frame->edge[e][0] && edge->b == frame->edge[e][1] &&
         length == frame->length[e] && frame->own_lengths == (edge->length != 0) &&
         edge->cover == (frame->cover ? frame->cover[e] : 0) &&
         edge->capacity == (frame->capacity ? frame->capacity[e] : 0);
}

bool thr_draft_says(const thr_draft *draft, const thr_frame *frame)
{
  bool same = draft->n_nodes == frame->n_nodes && draft->n_edges == frame->n_edges &&
              strcmp(draft->units, frame->units) == 0;

  for (int v = 0; v < frame->n_nodes && same; v++)
    same = says_node(draft, frame, v);
  for (int e = 0; e < frame->n_edges && same; e++)
    same = says_edge(draft, frame, e);

  return same;
}

/* ---- the framework itself ---- */

void thr_frame_destroy(thr_frame *frame)
{
  free(frame->name);
  free(frame->names);
  free(frame->xyz);
  free(frame->cover);
  free(frame->capacity);
  free(frame->foot);
  free(frame->edge);
  free(frame->length);
  free(frame->first);
  free(frame->half);
  *frame = (thr_frame){0};
}

/* Copies arrays and names; what is NULL stays NULL. */
thr_status thr_frame_copy(thr_frame *to, const thr_frame *from, thr_err *err)
{
  thr_frame frame = {0};

  /* Names are allocated with the text that holds them. */
  thr_status st = allocate(&frame, from->n_nodes, from->n_edges, err);
  if (!st) st = allocate_passes(&frame, from->cover, from->capacity, err);
  if (st) goto done;
  size_t n = (size_t)from->n_nodes, m = (size_t)from->n_edges;
  memcpy(frame.xyz, from->xyz, n * sizeof *frame.xyz);

  memcpy(frame.foot, from->foot, n * sizeof *frame.foot);
  if (frame.cover) memcpy(frame.cover, from->cover, m * sizeof *frame.cover);
  if (frame.capacity) memcpy(frame.capacity, from->capacity, m * sizeof *frame.capacity);
  memcpy(frame.edge, from->edge, m * sizeof *frame.edge);
  memcpy(frame.length, from->length, m * sizeof *frame.length);

  memcpy(frame.first, from->first, (n + 1) * sizeof *frame.first);
  memcpy(frame.half, from->half, 2 * m * sizeof *frame.half);
  memcpy(frame.units, from->units, sizeof frame.units);
  frame.own_lengths = from->own_lengths;
  thr_text names = {0};

  /* The names are one text, which ends with the last node's name. */
  const char *last = n ? from->name[n - 1] : "";
  if (n)
    thr_text_append_bytes(&names, from->names, (size_t)(last - from->names) + strlen(last) + 1);

  st = thr_frame_take_names(&frame, &names, err);
done:
  if (st) thr_frame_destroy(&frame);
  *to = frame;

  return st;
}

int thr_frame_find(const thr_frame *frame, const char *name)
{
  for (int v = 0; v < frame->n_nodes; v++)
    if (strcmp(frame->name[v], name) == 0) return v;
  return -1;
}

bool thr_frame_names_are_indices(const thr_frame *frame)
{
  bool indices = true;
  for (int v = 0; v < frame->n_nodes && indices; v++)
    indices = is_index(frame->name[v], v);
  return indices;
}

int thr_frame_edge_between(const thr_frame *frame, int a, int b)
{
  for (int i = frame->first[a]; i < frame->first[a + 1]; i++)
    if (thr_head(frame, frame->half[i]) == b) return frame->half[i] >> 1;
  return -1;
}

double thr_frame_diagonal(const thr_frame *frame)
{
  return diagonal_of((const double(*)[3])frame->xyz, frame->n_nodes, sizeof *frame->xyz);
}

double thr_frame_total_length(const thr_frame *frame)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++)
    sum += frame->length[e];
  return sum;
}

int thr_frame_largest_degree(const thr_frame *frame)
{
  int most = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_degree(frame, v) > most) most = thr_degree(frame, v);
  return most;
}

/* Hashes the arrays as bytes; covers and capacities only if there are any, so that they change no
 * hash of a framework without them. */
uint64_t thr_frame_hash(const thr_frame *frame)
{
  if (frame->hash) return frame->hash;
  uint64_t hash = FNV_START;

  /* The numbers of nodes and edges tell where one array ends and the next begins. */
  hash = fnv(hash, &frame->n_nodes, sizeof frame->n_nodes);
  hash = fnv(hash, &frame->n_edges, sizeof frame->n_edges);
  hash = fnv(hash, frame->xyz, (size_t)frame->n_nodes * sizeof *frame->xyz);
  hash = fnv(hash, frame->edge, (size_t)frame->n_edges * sizeof *frame->edge);
  hash = fnv(hash, frame->length, (size_t)frame->n_edges * sizeof *frame->length);

  hash = fnv(hash, frame->foot, (size_t)frame->n_nodes * sizeof *frame->foot);

  /* The word keeps capacities apart from covers. */
  if (frame->cover) hash = fnv(hash, frame->cover, (size_t)frame->n_edges * sizeof *frame->cover);
  if (frame->capacity)
    hash = fnv(fnv(hash, "capacity", 8), frame->capacity,
               (size_t)frame->n_edges * sizeof *frame->capacity);

  return hash;
}

void thr_frame_keep_hash(thr_frame *frame)
{
  frame->hash = 0;
  frame->hash = thr_frame_hash(frame);
}

/* Numbers components by searches from the lowest node that has none. */
thr_status thr_frame_components(const thr_frame *frame, int *component, int *count, thr_err *err)
{
  thr_scratch own = {0};
  int *stack = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *stack);
  if (!component) component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component);
  const thr_status st = thr_scratch_check(&own, err);

  *count = 0;
  for (int v = 0; v < frame->n_nodes && !st; v++)
    component[v] = -1;

  /* A depth-first search with a stack of its own from every node that has no component yet; roots
   * ascend, so components are numbered by their lowest node. */
  for (int root = 0; root < frame->n_nodes && !st; root++) {
    if (component[root] >= 0) continue;
    int top = 0;
    component[root] = *count;
    stack[top++] = root;
    while (top) {
      /* The neighbours that have not been reached. */
      int v = stack[--top];
      for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
        int w = thr_head(frame, frame->half[i]);
        if (component[w] >= 0) continue;
        component[w] = *count;
        stack[top++] = w;
      }
    }
    ++*count;
  }

  thr_scratch_free(&own);
  return st;
}

/* Runs one depth-first search from root and marks the bridges of its component (Tarjan 1974).
 * order[v]: when v was reached, from 1; low[v]: the earliest node that v's subtree reaches without
 * the edge to its parent; cursor[v]: how many of v's half-edges have been followed; via[v]: the
 * half-edge that led to v. */
static void bridges_from(const thr_frame *frame, int root, int *order, int *low, int *cursor,
                         int *via, int *clock, bool *is_bridge)
{
  int v = root;

  via[root] = -1;
  order[root] = low[root] = ++*clock;
  for (;;) {
    if (frame->first[v] + cursor[v] < frame->first[v + 1]) {
      /* Follow the next half-edge, except back to the parent. */
      int h = frame->half[frame->first[v] + cursor[v]++], w = thr_head(frame, h);
      if (via[v] >= 0 && h >> 1 == via[v] >> 1) continue;
      if (order[w]) {
        /* A node that was reached before: an edge upwards. */
        if (order[w] < low[v]) low[v] = order[w];
      } else {
        /* A new node: go down. */
        via[w] = h;
        order[w] = low[w] = ++*clock;
        v = w;
      }
    } else {
      /* All half-edges followed: go back up. The edge to the parent is a bridge if nothing below
       * reaches the parent or an earlier node. */
      if (via[v] < 0) return;
      int u = thr_tail(frame, via[v]);
      if (low[v] > order[u]) is_bridge[via[v] >> 1] = true;
      if (low[v] < low[u]) low[u] = low[v];
      v = u;
    }
  }
}

/* Finds bridges by one depth-first search for each component. */
thr_status thr_frame_bridges(const thr_frame *frame, bool *is_bridge, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  int *work = thr_calloc(4 * n, sizeof *work);

  if (!work) return thr_nomem(err);

  /* order, low, cursor and via are one array; order 0 means not reached. */
  int clock = 0;
  memset(is_bridge, 0, (size_t)frame->n_edges * sizeof *is_bridge);
  for (int v = 0; v < frame->n_nodes; v++)
    if (!work[v])
      bridges_from(frame, v, work, work + n, work + 2 * n, work + 3 * n, &clock, is_bridge);

  free(work);
  return THR_OK;
}

void thr_direction(const thr_frame *frame, int half, double d[3])
{
  /* Differences may be as large as 1e100 or as small as 1e-100; scaled by the largest component
   * their squares neither overflow nor vanish. */
  const double *from = frame->xyz[thr_tail(frame, half)], *to = frame->xyz[thr_head(frame, half)];
  double largest = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = to[i] - from[i];
    largest = fabs(d[i]) > largest ? fabs(d[i]) : largest;
  }

  thr_divide(d, largest);
}
