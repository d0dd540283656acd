/* The framework: drafts as readers collect them, welding, adjacency, hash. */
#include "graph/framework/frame.h"
#include "graph/disjoint.h"
#include "graph/framework/units.h"
#include "graph/sort.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lengths outside these bounds are nonsense in any unit, and their sums and quotients would overflow. */
static const double SHORTEST = 1e-100, LONGEST = 1e100;

/* ---- drafts ---- */

thr_status thr_draft_add_node(thr_draft *d, const double xyz[3], const char *name, bool foot, thr_err *err)
{
  for (int i = 0; i < 3; i++)
    if (!(fabs(xyz[i]) < LONGEST))
      return thr_fail(err, THR_EINPUT, "node %d has a coordinate that is not a finite number below %g", d->n_nodes, LONGEST);
  thr_status st = thr_grow(&d->node, d->n_nodes, &d->nodes_capacity, sizeof *d->node, err);
  if (st) return st;
  char *copy = NULL;
  if (name && !(copy = thr_strdup(name))) return thr_nomem(err);
  if (copy) thr_text_clean(copy);
  d->node[d->n_nodes++] = (struct thr_draft_node){{xyz[0], xyz[1], xyz[2]}, copy, foot};
  return THR_OK;
}

thr_status thr_draft_add_edge(thr_draft *d, int a, int b, double length, thr_err *err)
{
  int worst = a < 0 || a >= d->n_nodes ? a : b;
  if (worst < 0 || worst >= d->n_nodes)
    return thr_fail(err, THR_EINPUT, "edge %d names node %d, but there are %d nodes", d->n_edges, worst, d->n_nodes);
  thr_status st = thr_grow(&d->edge, d->n_edges, &d->edges_capacity, sizeof *d->edge, err);
  if (st) return st;
  d->edge[d->n_edges++] = (struct thr_draft_edge){.a = a, .b = b, .length = length};
  return THR_OK;
}

thr_status thr_draft_edge_passes(thr_draft *d, int cover, int capacity, thr_err *err)
{
  int e = d->n_edges - 1;
  if (cover < 0 || cover > 100)
    return thr_fail(err, THR_EINPUT, "edge %d needs %d passes; a cover lies between 1 and 100", e, cover);
  if (capacity < 0 || capacity > 100 || (capacity > 0 && capacity < cover))
    return thr_fail(err, THR_EINPUT, "edge %d has room for %d passes; a capacity lies between the cover and 100", e, capacity);
  d->edge[e].cover = cover;
  d->edge[e].capacity = capacity;
  return THR_OK;
}

thr_status thr_draft_set_units(thr_draft *d, const char *units, thr_err *err)
{
  const char *name;
  thr_status st = thr_units_find(units, &name, err);
  if (!st) snprintf(d->units, sizeof d->units, "%s", name);
  return st;
}

void thr_draft_destroy(thr_draft *d)
{
  for (int v = 0; v < d->n_nodes; v++)
    free(d->node[v].name);
  free(d->node);
  free(d->edge);
  *d = (thr_draft){0};
}

/* ---- welding: nodes closer than the tolerance are also close in their projection on any direction, so sort by a
 * projection that regular grids do not share and compare each node with the window before it ---- */

typedef struct {
  double along; /* projection on a fixed unit direction */
  const double *xyz;
  int node;
} projected;

static int by_projection(const void *pa, const void *pb)
{
  const projected *a = pa, *b = pb;
  if (a->along != b->along) return a->along < b->along ? -1 : 1;
  for (int i = 0; i < 3; i++)
    if (a->xyz[i] != b->xyz[i]) return a->xyz[i] < b->xyz[i] ? -1 : 1;
  return (a->node > b->node) - (a->node < b->node);
}

static double distance(const double a[3], const double b[3])
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/* parent[v] becomes the lowest node of v's welded group. */
static thr_status weld(const thr_draft *d, double tolerance, int *parent, thr_err *err)
{
  int n = d->n_nodes;
  projected *p = thr_calloc((size_t)n, sizeof *p);
  if (!p) return thr_nomem(err);
  for (int v = 0; v < n; v++) {
    const double *x = d->node[v].xyz;
    parent[v] = v;
    p[v] = (projected){0.6324 * x[0] + 0.5477 * x[1] + 0.5478 * x[2], x, v}; /* length 0.99999: never above 1 */
  }
  qsort(p, (size_t)n, sizeof *p, by_projection);
  for (int i = 0; i < n; i++)
    for (int j = i - 1; j >= 0 && !(p[i].along - p[j].along > tolerance); j--) {
      double apart = distance(p[i].xyz, p[j].xyz);
      if (apart <= tolerance) thr_disjoint_join(parent, p[i].node, p[j].node);
      if (apart == 0) break;     /* what is close to this node was compared with its twin already */
      if (tolerance == 0) break; /* twins are neighbours */
    }
  for (int v = 0; v < n; v++)
    parent[v] = thr_disjoint_find(parent, v);
  free(p);
  return THR_OK;
}

static double diagonal_of(const double (*xyz)[3], int n, size_t stride)
{
  double low[3] = {0}, high[3] = {0};
  for (int v = 0; v < n; v++) {
    const double *x = (const double *)(const void *)((const char *)xyz + (size_t)v * stride);
    for (int i = 0; i < 3; i++) {
      if (v == 0 || x[i] < low[i]) low[i] = x[i];
      if (v == 0 || x[i] > high[i]) high[i] = x[i];
    }
  }
  return distance(low, high);
}

/* 1e-6 of the bounding box's diagonal, but no more than a thousandth of the median edge: one stray node far away must not
 * weld everything else together. */
static thr_status default_tolerance(const thr_draft *d, double *tolerance, thr_err *err)
{
  double *length = thr_calloc((size_t)d->n_edges, sizeof *length);
  if (!length) return thr_nomem(err);
  int n = 0;
  for (int e = 0; e < d->n_edges; e++) {
    double apart = distance(d->node[d->edge[e].a].xyz, d->node[d->edge[e].b].xyz);
    if (apart > 0) length[n++] = apart;
  }
  thr_sort_doubles(length, (size_t)n);
  *tolerance = 1e-6 * diagonal_of((const double(*)[3])d->node[0].xyz, d->n_nodes, sizeof *d->node);
  if (n > 0) *tolerance = fmin(*tolerance, 1e-3 * length[n / 2]);
  free(length);
  return THR_OK;
}

/* ---- from draft to framework ---- */

typedef struct {
  int a, b, index;
} keyed_edge;

static int by_ends(const void *pa, const void *pb)
{
  const keyed_edge *x = pa, *y = pb;
  if (x->a != y->a) return x->a < y->a ? -1 : 1;
  if (x->b != y->b) return x->b < y->b ? -1 : 1;
  return (x->index > y->index) - (x->index < y->index);
}

/* keep[e] = 1 for the edges that survive: not of zero length, the first of equal pairs. */
static thr_status choose_edges(const thr_draft *d, const int *parent, bool *keep, thr_read_report *r, thr_err *err)
{
  keyed_edge *k = thr_calloc((size_t)d->n_edges, sizeof *k);
  if (!k) return thr_nomem(err);
  int n = 0;
  for (int e = 0; e < d->n_edges; e++) {
    int a = parent[d->edge[e].a], b = parent[d->edge[e].b];
    if (a == b)
      r->zero_length_edges++;
    else
      k[n++] = (keyed_edge){a < b ? a : b, a < b ? b : a, e};
  }
  qsort(k, (size_t)n, sizeof *k, by_ends);
  for (int i = 0; i < n; i++) {
    if (i > 0 && k[i].a == k[i - 1].a && k[i].b == k[i - 1].b)
      r->duplicate_edges++;
    else
      keep[k[i].index] = true;
  }
  free(k);
  return THR_OK;
}

static thr_status allocate(thr_frame *f, int n_nodes, int n_edges, thr_err *err)
{
  f->n_nodes = n_nodes;
  f->n_edges = n_edges;
  f->xyz = thr_calloc((size_t)n_nodes, sizeof *f->xyz);
  f->foot = thr_calloc((size_t)n_nodes, sizeof *f->foot);
  f->name = thr_calloc((size_t)n_nodes, sizeof *f->name);
  f->edge = thr_calloc((size_t)n_edges, sizeof *f->edge);
  f->length = thr_calloc((size_t)n_edges, sizeof *f->length);
  f->first = thr_calloc((size_t)n_nodes + 1, sizeof *f->first);
  f->half = thr_calloc(2 * (size_t)n_edges, sizeof *f->half);
  return f->xyz && f->foot && f->name && f->edge && f->length && f->first && f->half ? THR_OK : thr_nomem(err);
}

/* Room for covers or capacities, which most frameworks do not have. */
static thr_status allocate_passes(thr_frame *f, bool covers, bool capacities, thr_err *err)
{
  size_t m = (size_t)f->n_edges;
  if (covers && !(f->cover = thr_calloc(m, sizeof *f->cover))) return thr_nomem(err);
  if (capacities && !(f->capacity = thr_calloc(m, sizeof *f->capacity))) return thr_nomem(err);
  return THR_OK;
}

void thr_frame_index(thr_frame *f)
{
  for (int h = 0; h < 2 * f->n_edges; h++)
    f->first[thr_tail(f, h) + 1]++;
  for (int v = 0; v < f->n_nodes; v++)
    f->first[v + 1] += f->first[v];
  for (int h = 0; h < 2 * f->n_edges; h++)
    f->half[f->first[thr_tail(f, h)]++] = h;
  for (int v = f->n_nodes; v > 0; v--) /* the loop above moved each start to its end */
    f->first[v] = f->first[v - 1];
  f->first[0] = 0;
}

static thr_status fill_nodes(thr_frame *f, const thr_draft *d, const int *parent, const int *index, thr_err *err)
{
  for (int v = 0; v < d->n_nodes; v++) {
    int i = index[parent[v]];
    if (i < 0) continue;
    if (d->node[v].foot) f->foot[i] = true;
    if (parent[v] != v) continue;
    memcpy(f->xyz[i], d->node[v].xyz, sizeof f->xyz[i]);
    char digits[16];
    snprintf(digits, sizeof digits, "%d", v);
    f->name[i] = thr_strdup(d->node[v].name ? d->node[v].name : digits);
    if (!f->name[i]) return thr_nomem(err);
  }
  return THR_OK;
}

typedef struct {
  const char *name;
  int node; /* of the draft */
} named;

static int by_name(const void *pa, const void *pb)
{
  const named *a = pa, *b = pb;
  int order = strcmp(a->name, b->name);
  return order ? order : (a->node > b->node) - (a->node < b->node);
}

/* Options and tables call nodes by their names. O(n log n). */
static thr_status check_names(const thr_frame *f, const thr_draft *d, const int *parent, const int *index, thr_err *err)
{
  named *list = thr_calloc((size_t)f->n_nodes, sizeof *list);
  if (!list) return thr_nomem(err);
  for (int v = 0; v < d->n_nodes; v++)
    if (parent[v] == v && index[v] >= 0) list[index[v]] = (named){f->name[index[v]], v};
  qsort(list, (size_t)f->n_nodes, sizeof *list, by_name);
  thr_status st = THR_OK;
  for (int i = 1; i < f->n_nodes && !st; i++)
    if (strcmp(list[i - 1].name, list[i].name) == 0)
      st = thr_fail(err, THR_EINPUT, "nodes %d and %d, counted from 0, are both called '%.40s'; give each its own name",
                    list[i - 1].node, list[i].node, list[i].name);
  free(list);
  return st;
}

static thr_status fill_edges(thr_frame *f, const thr_draft *d, const int *parent, const int *index, const bool *keep,
                             thr_err *err)
{
  int n = 0;
  for (int e = 0; e < d->n_edges; e++) {
    if (!keep[e]) continue;
    int a = index[parent[d->edge[e].a]], b = index[parent[d->edge[e].b]];
    double given = d->edge[e].length, euclidean = distance(f->xyz[a], f->xyz[b]);
    double length = given != 0 ? given : euclidean;
    if (!(euclidean > SHORTEST)) length = euclidean; /* without a direction there are no angles */
    if (!(length > SHORTEST && length < LONGEST))
      return thr_fail(err, THR_EINPUT, "edge %d (%s to %s) has length %g; lengths must lie between %g and %g", e, f->name[a],
                      f->name[b], length, SHORTEST, LONGEST);
    if (given != 0) f->own_lengths = true;
    f->edge[n][0] = a;
    f->edge[n][1] = b;
    f->length[n++] = length;
  }
  return THR_OK;
}

static thr_status fill_passes(thr_frame *f, const thr_draft *d, const bool *keep, thr_err *err)
{
  bool covers = false, capacities = false;
  for (int e = 0; e < d->n_edges; e++) {
    covers |= keep[e] && d->edge[e].cover > 0;
    capacities |= keep[e] && d->edge[e].capacity > 0;
  }
  thr_status st = allocate_passes(f, covers, capacities, err);
  for (int e = 0, n = 0; e < d->n_edges && !st; e++) {
    if (!keep[e]) continue;
    if (covers) f->cover[n] = d->edge[e].cover > 0 ? d->edge[e].cover : 1;
    if (capacities) f->capacity[n] = d->edge[e].capacity;
    n++;
  }
  return st;
}

thr_status thr_draft_build(const thr_draft *d, double tolerance, thr_frame *frame, thr_read_report *report, thr_err *err)
{
  thr_frame f = {0};
  thr_read_report r = *report;
  *frame = f;
  r.nodes_read = d->n_nodes;
  r.edges_read = d->n_edges;
  if (d->n_edges == 0) return thr_fail(err, THR_EINPUT, "no edge found; a framework needs at least one edge between two nodes");
  thr_status st = THR_OK;
  if (tolerance < 0 && (st = default_tolerance(d, &tolerance, err))) return st;
  r.weld_tolerance = tolerance;

  int *parent = thr_calloc((size_t)d->n_nodes, sizeof *parent);
  int *index = thr_calloc((size_t)d->n_nodes, sizeof *index);
  bool *keep = thr_calloc((size_t)d->n_edges, sizeof *keep);
  if (!parent || !index || !keep) {
    st = thr_nomem(err);
    goto done;
  }
  if ((st = weld(d, tolerance, parent, err))) goto done;
  if ((st = choose_edges(d, parent, keep, &r, err))) goto done;

  int n_nodes = 0, n_edges = 0;
  for (int e = 0; e < d->n_edges; e++)
    if (keep[e]) {
      n_edges++;
      index[parent[d->edge[e].a]] = index[parent[d->edge[e].b]] = 1;
    }
  if (n_edges == 0) {
    st = thr_fail(err, THR_EINPUT,
                  "every edge has zero length: its ends are one node, or within the weld tolerance %g; use a smaller --weld",
                  tolerance);
    goto done;
  }
  for (int v = 0; v < d->n_nodes; v++) {
    if (parent[v] != v) {
      r.welded_nodes++;
      index[v] = -1;
    } else if (index[v]) {
      index[v] = n_nodes++;
    } else {
      r.isolated_nodes++;
      index[v] = -1;
    }
  }
  if ((st = allocate(&f, n_nodes, n_edges, err))) goto done;
  if ((st = fill_nodes(&f, d, parent, index, err))) goto done;
  if ((st = check_names(&f, d, parent, index, err))) goto done;
  if ((st = fill_edges(&f, d, parent, index, keep, err))) goto done;
  if ((st = fill_passes(&f, d, keep, err))) goto done;
  snprintf(f.units, sizeof f.units, "%s", d->units[0] ? d->units : "mm");
  thr_frame_index(&f);
  *report = r;
done:
  if (st) thr_frame_destroy(&f);
  *frame = f;
  free(parent);
  free(index);
  free(keep);
  return st;
}

/* ---- the framework itself ---- */

void thr_frame_destroy(thr_frame *f)
{
  for (int v = 0; f->name && v < f->n_nodes; v++)
    free(f->name[v]);
  free(f->name);
  free(f->xyz);
  free(f->cover);
  free(f->capacity);
  free(f->foot);
  free(f->edge);
  free(f->length);
  free(f->first);
  free(f->half);
  *f = (thr_frame){0};
}

thr_status thr_frame_copy(thr_frame *to, const thr_frame *from, thr_err *err)
{
  thr_frame f = {0};
  thr_status st = allocate(&f, from->n_nodes, from->n_edges, err);
  if (!st) st = allocate_passes(&f, from->cover, from->capacity, err);
  if (st) goto done;
  size_t n = (size_t)from->n_nodes, m = (size_t)from->n_edges;
  memcpy(f.xyz, from->xyz, n * sizeof *f.xyz);
  memcpy(f.foot, from->foot, n * sizeof *f.foot);
  if (f.cover) memcpy(f.cover, from->cover, m * sizeof *f.cover);
  if (f.capacity) memcpy(f.capacity, from->capacity, m * sizeof *f.capacity);
  memcpy(f.edge, from->edge, m * sizeof *f.edge);
  memcpy(f.length, from->length, m * sizeof *f.length);
  memcpy(f.first, from->first, (n + 1) * sizeof *f.first);
  memcpy(f.half, from->half, 2 * m * sizeof *f.half);
  memcpy(f.units, from->units, sizeof f.units);
  f.own_lengths = from->own_lengths;
  for (size_t v = 0; v < n; v++)
    if (!(f.name[v] = thr_strdup(from->name[v]))) {
      st = thr_nomem(err);
      goto done;
    }
done:
  if (st) thr_frame_destroy(&f);
  *to = f;
  return st;
}

int thr_frame_find(const thr_frame *f, const char *name)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (strcmp(f->name[v], name) == 0) return v;
  return -1;
}

bool thr_frame_names_are_indices(const thr_frame *f)
{
  char digits[16];
  for (int v = 0; v < f->n_nodes; v++) {
    snprintf(digits, sizeof digits, "%d", v);
    if (strcmp(digits, f->name[v]) != 0) return false;
  }
  return true;
}

int thr_frame_edge_between(const thr_frame *f, int a, int b)
{
  for (int i = f->first[a]; i < f->first[a + 1]; i++)
    if (thr_head(f, f->half[i]) == b) return f->half[i] >> 1;
  return -1;
}

double thr_frame_diagonal(const thr_frame *f)
{
  return diagonal_of((const double(*)[3])f->xyz, f->n_nodes, sizeof *f->xyz);
}

void thr_frame_feet_lowest(thr_frame *f)
{
  double lowest = f->n_nodes ? f->xyz[0][2] : 0, tolerance = 1e-6 * thr_frame_diagonal(f);
  for (int v = 0; v < f->n_nodes; v++)
    if (f->xyz[v][2] < lowest) lowest = f->xyz[v][2];
  for (int v = 0; v < f->n_nodes; v++)
    f->foot[v] = f->xyz[v][2] <= lowest + tolerance;
}

double thr_frame_total_length(const thr_frame *f)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    sum += f->length[e];
  return sum;
}

static uint64_t fnv(uint64_t hash, const void *bytes, size_t n)
{
  const unsigned char *b = bytes;
  for (size_t i = 0; i < n; i++)
    hash = (hash ^ b[i]) * UINT64_C(1099511628211);
  return hash;
}

uint64_t thr_frame_hash(const thr_frame *f)
{
  uint64_t hash = UINT64_C(14695981039346656037);
  hash = fnv(hash, &f->n_nodes, sizeof f->n_nodes);
  hash = fnv(hash, &f->n_edges, sizeof f->n_edges);
  hash = fnv(hash, f->xyz, (size_t)f->n_nodes * sizeof *f->xyz);
  hash = fnv(hash, f->edge, (size_t)f->n_edges * sizeof *f->edge);
  hash = fnv(hash, f->length, (size_t)f->n_edges * sizeof *f->length);
  hash = fnv(hash, f->foot, (size_t)f->n_nodes * sizeof *f->foot);
  if (f->cover) hash = fnv(hash, f->cover, (size_t)f->n_edges * sizeof *f->cover);
  if (f->capacity) hash = fnv(fnv(hash, "capacity", 8), f->capacity, (size_t)f->n_edges * sizeof *f->capacity);
  return hash;
}

thr_status thr_frame_components(const thr_frame *f, int *component, int *count, thr_err *err)
{
  int *stack = thr_calloc((size_t)f->n_nodes, sizeof *stack);
  if (!stack) return thr_nomem(err);
  *count = 0;
  for (int v = 0; v < f->n_nodes; v++)
    component[v] = -1;
  for (int root = 0; root < f->n_nodes; root++) {
    if (component[root] >= 0) continue;
    int top = 0;
    component[root] = *count;
    stack[top++] = root;
    while (top) {
      int v = stack[--top];
      for (int i = f->first[v]; i < f->first[v + 1]; i++) {
        int w = thr_head(f, f->half[i]);
        if (component[w] >= 0) continue;
        component[w] = *count;
        stack[top++] = w;
      }
    }
    ++*count;
  }
  free(stack);
  return THR_OK;
}

/* One depth-first search from root: low[v] = earliest node reachable from v's subtree without the edge to its parent. */
static void bridges_from(const thr_frame *f, int root, int *order, int *low, int *cursor, int *via, int *clock, bool *is_bridge)
{
  int v = root;
  via[root] = -1;
  order[root] = low[root] = ++*clock;
  for (;;) {
    if (f->first[v] + cursor[v] < f->first[v + 1]) {
      int h = f->half[f->first[v] + cursor[v]++], w = thr_head(f, h);
      if (via[v] >= 0 && h >> 1 == via[v] >> 1) continue;
      if (order[w]) {
        if (order[w] < low[v]) low[v] = order[w];
      } else {
        via[w] = h;
        order[w] = low[w] = ++*clock;
        v = w;
      }
    } else {
      if (via[v] < 0) return;
      int u = thr_tail(f, via[v]);
      if (low[v] > order[u]) is_bridge[via[v] >> 1] = true;
      if (low[v] < low[u]) low[u] = low[v];
      v = u;
    }
  }
}

thr_status thr_frame_bridges(const thr_frame *f, bool *is_bridge, thr_err *err)
{
  size_t n = (size_t)f->n_nodes;
  int *work = thr_calloc(4 * n, sizeof *work);
  if (!work) return thr_nomem(err);
  int clock = 0;
  memset(is_bridge, 0, (size_t)f->n_edges * sizeof *is_bridge);
  for (int v = 0; v < f->n_nodes; v++)
    if (!work[v]) bridges_from(f, v, work, work + n, work + 2 * n, work + 3 * n, &clock, is_bridge);
  free(work);
  return THR_OK;
}

void thr_direction(const thr_frame *f, int half, double d[3])
{
  const double *from = f->xyz[thr_tail(f, half)], *to = f->xyz[thr_head(f, half)];
  double largest = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = to[i] - from[i];
    largest = fmax(largest, fabs(d[i]));
  }
  for (int i = 0; i < 3; i++)
    d[i] /= largest;
}
