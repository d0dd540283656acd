/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds automorphisms by Traces (B. McKay & A. Piperno 2014). The only file that knows nauty.
 *
 * nauty's callback has no user pointer, and its failures end the program. So there is one target at
 * a time in a thread, and alloc_error, which nauty calls when memory runs out, is replaced by a
 * jump back (the program's definition goes before the shared library's). Sparse nauty itself is not
 * used: it overruns its buffers on stars.
 *
 * Example: a square of four edges has order 8. If one edge has another colour, every edge gets a
 * node of its colour in its middle, and the order is 2. */
#include "graph/arrays.h"
#include "symmetry/group/group.h"

#include <traces.h>
#include <math.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_IMAGES = 1 << 26, /* in all generators: a quarter of a gigabyte */
  BYTES_PER_POINT = 1024 /* that Traces may use; measured: up to 230 on grids, tubes, spheres, trees
                            and random graphs */
};
/* Seed of nauty's random Schreier-Sims: generators are the same on every call. */
static const long SEED = 1;

/* Where the callback puts generators. */
typedef struct {
  thr_automorphisms *out;
  int capacity;      /* rows that out->generator has room for */
  thr_status status; /* why not all were collected */
} generator_collector;

static _Thread_local generator_collector *collecting;
static _Thread_local jmp_buf escape;

/* Is called by nauty, in place of its own function, when memory runs out. */
void alloc_error(const char *what)
{
  (void)what;
  longjmp(escape, 1);
}

/* Appends a generator: the callback of Traces. The first failure ends collecting. */
static void collect_generator(int count, int *image, int degree)
{
  (void)count, (void)degree;
  generator_collector *collector = collecting;
  thr_automorphisms *automorphisms = collector->out;
  size_t row = (size_t)automorphisms->n * sizeof *automorphisms->generator;
  if (collector->status) return;

  /* A row for the generator. */
  if (automorphisms->n_generators >= MOST_IMAGES / automorphisms->n)
    collector->status = THR_ELIMIT;
  else
    collector->status = thr_grow(&automorphisms->generator, automorphisms->n_generators,
                                 &collector->capacity, row, NULL);
  if (!collector->status)
    memcpy(
        &automorphisms->generator[(size_t)automorphisms->n_generators++ * (size_t)automorphisms->n],
        image, row);
}

/* The graph as Traces takes it: nodes, and one more for each edge if edges have colours. */
typedef struct {
  int n; /* nodes and subdivisions */
  sparsegraph graph;
  int *lab, *ptn; /* nodes by colour; ptn 0 at the last of each colour */
  int *orbits;
} coloured_graph;

static void coloured_destroy(coloured_graph *coloured)
{
  free(coloured->graph.v);
  free(coloured->graph.d);
  free(coloured->graph.e);
  free(coloured->lab);
  free(coloured->ptn);
  free(coloured->orbits);
}

/* A node or subdivision with what colours it. */
typedef struct {
  int kind, colour, index; /* kind: 0 a node, 1 a foot, 2 an edge */
} point;

/* Tells whether two points have one colour. */
static bool same_colour(const point *first, const point *second)
{
  return first->kind == second->kind && first->colour == second->colour;
}

/* Compares points by colour, then by index. */
static int by_colour(const void *a, const void *b)
{
  const point *first = a, *second = b;
  if (first->kind != second->kind) return first->kind < second->kind ? -1 : 1;
  if (first->colour != second->colour) return first->colour < second->colour ? -1 : 1;
  return (first->index > second->index) - (first->index < second->index);
}

static int colour_of(const int *colour, int i)
{
  return colour ? colour[i] : 0;
}

/* Lists the points by colour, as Traces takes colours. */
static thr_status fill_colours(coloured_graph *coloured, const thr_frame *frame,
                               const thr_automorphism_options *options, thr_err *err)
{
  point *points = thr_calloc((size_t)coloured->n, sizeof *points);
  if (!points) return thr_nomem(err);
  /* What colours each point. */
  for (int i = 0; i < coloured->n; i++) {
    int e = i - frame->n_nodes;
    points[i].index = i;
    points[i].kind = e >= 0 ? 2 : frame->foot[i] ? 1 : 0;
    points[i].colour =
        e >= 0 ? colour_of(options->edge_colour, e) : colour_of(options->node_colour, i);
  }

  qsort(points, (size_t)coloured->n, sizeof *points, by_colour);

  /* ptn is 0 at the last point of a colour. */
  for (int i = 0; i < coloured->n; i++) {
    coloured->lab[i] = points[i].index;
    coloured->ptn[i] = i + 1 < coloured->n && same_colour(&points[i], &points[i + 1]);
  }

  free(points);
  return THR_OK;
}

/* Fills the adjacency: nodes next to nodes, or, with subdivisions, nodes next to edges. */
static void fill_graph(coloured_graph *coloured, const thr_frame *frame)
{
  size_t at = 0;
  /* Nodes. */
  for (int v = 0; v < frame->n_nodes; v++) {
    coloured->graph.v[v] = at;
    coloured->graph.d[v] = thr_degree(frame, v);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      coloured->graph.e[at++] = coloured->n > frame->n_nodes
                                    ? frame->n_nodes + (frame->half[i] >> 1)
                                    : thr_head(frame, frame->half[i]);
  }

  /* Subdivisions have two neighbours. */
  for (int i = frame->n_nodes; i < coloured->n; i++) {
    coloured->graph.v[i] = at;
    coloured->graph.d[i] = 2;
    coloured->graph.e[at++] = frame->edge[i - frame->n_nodes][0];
    coloured->graph.e[at++] = frame->edge[i - frame->n_nodes][1];
  }

  coloured->graph.nv = coloured->n;
  coloured->graph.nde = at;
}

/* Tells whether all colours are the same. */
static bool all_equal(const int *colour, int n)
{
  for (int e = 1; e < n; e++)
    if (colour[e] != colour[0]) return false;
  return true;
}

/* Makes the coloured graph; edges are subdivided only if their colours differ. The caller destroys
 * it also on failure. */
static thr_status coloured_init(coloured_graph *coloured, const thr_frame *frame,
                                const thr_automorphism_options *options, thr_err *err)
{
  bool subdivide = options->edge_colour && !all_equal(options->edge_colour, frame->n_edges);
  SG_INIT(coloured->graph);
  /* nauty numbers points by int. */
  if (subdivide && frame->n_edges > NAUTY_INFINITY - 1 - frame->n_nodes)
    return thr_fail(err, THR_ELIMIT, "nauty: more than %d nodes and edges", NAUTY_INFINITY);

  coloured->n = frame->n_nodes + (subdivide ? frame->n_edges : 0);

  /* Every edge is in two lists, a subdivided one in four. */
  coloured->graph.vlen = coloured->graph.dlen = (size_t)coloured->n;
  coloured->graph.elen = (subdivide ? 4 : 2) * (size_t)frame->n_edges;
  coloured->graph.v = thr_calloc(coloured->graph.vlen, sizeof *coloured->graph.v);
  coloured->graph.d = thr_calloc(coloured->graph.dlen, sizeof *coloured->graph.d);
  coloured->graph.e = thr_calloc(coloured->graph.elen, sizeof *coloured->graph.e);
  coloured->lab = thr_calloc((size_t)coloured->n, sizeof *coloured->lab);
  coloured->ptn = thr_calloc((size_t)coloured->n, sizeof *coloured->ptn);
  coloured->orbits = thr_calloc((size_t)coloured->n, sizeof *coloured->orbits);

  if (!coloured->graph.v || !coloured->graph.d || !coloured->graph.e || !coloured->lab ||
      !coloured->ptn || !coloured->orbits)
    return thr_nomem(err);

  fill_graph(coloured, frame);
  return fill_colours(coloured, frame, options, err);
}

/* Tells whether there is memory for a run: asks for it and gives it back. */
static bool enough_memory(const coloured_graph *coloured)
{
  void *probe = thr_calloc((size_t)coloured->n + 1024, BYTES_PER_POINT);
  free(probe);
  return probe != NULL;
}

/* Runs Traces. When it jumps out because memory ran out, its tables are released, and its search
 * tree is lost. */
static thr_status run_traces(coloured_graph *coloured, generator_collector *collector, thr_err *err)
{
  TracesStats stats = {0};

  DEFAULTOPTIONS_TRACES(options);
  options.defaultptn = FALSE;
  options.userautomproc = collect_generator;
  collecting = collector;
  if (!enough_memory(coloured)) return thr_nomem(err);

  /* alloc_error jumps here. */
  if (setjmp(escape)) {
    traces_freedyn();
    nausparse_freedyn();
    schreier_freedyn();
    nautil_freedyn();
    return thr_nomem(err);
  }

  ran_init(SEED);
  Traces(&coloured->graph, coloured->lab, coloured->ptn, coloured->orbits, &options, &stats, NULL);

  /* Did it succeed, and could all generators be kept? */
  if (stats.errstatus)
    return thr_fail(err, THR_ESOLVER, "nauty: Traces gave up with status %d", stats.errstatus);
  if (collector->status == THR_ELIMIT)
    return thr_fail(err, THR_ELIMIT, "the group of %d nodes has too many generators to hold",
                    collector->out->n);
  if (collector->status) return thr_nomem(err);

  collector->out->mantissa = stats.grpsize1;
  collector->out->exponent = stats.grpsize2;
  return THR_OK;
}

/* Restores the order as an integer without power of ten where a double holds it: nauty takes powers
 * of ten out as soon as it can. */
static void normalize_order(thr_automorphisms *automorphisms)
{
  double order = automorphisms->mantissa * pow(10, automorphisms->exponent);
  if (order >= 1e15) return;
  automorphisms->mantissa = nearbyint(order);
  automorphisms->exponent = 0;
}

thr_status thr_automorphisms_orbits(thr_automorphisms *automorphisms, thr_err *err)
{
  automorphisms->orbit = thr_calloc((size_t)automorphisms->n, sizeof *automorphisms->orbit);
  if (!automorphisms->orbit) return thr_nomem(err);

  /* Images are joined. */
  for (int v = 0; v < automorphisms->n; v++)
    automorphisms->orbit[v] = v;
  for (int generator = 0; generator < automorphisms->n_generators; generator++)
    for (int v = 0; v < automorphisms->n; v++)
      thr_disjoint_join(
          automorphisms->orbit, v,
          automorphisms->generator[(size_t)generator * (size_t)automorphisms->n + (size_t)v]);

  /* Every orbit has its lowest node as root. */
  for (int v = 0; v < automorphisms->n; v++)
    automorphisms->orbit[v] = thr_disjoint_find(automorphisms->orbit, v);
  return THR_OK;
}

thr_status thr_automorphisms_find(const thr_frame *frame, const thr_automorphism_options *options,
                                  thr_automorphisms *out, thr_err *err)
{
  coloured_graph coloured = {0};
  thr_automorphisms automorphisms = {.n = frame->n_nodes, .mantissa = 1};
  generator_collector collector = {.out = &automorphisms};

  /* Run Traces on the graph. */
  thr_status st = coloured_init(&coloured, frame, options, err);
  if (!st && coloured.n > 0) st = run_traces(&coloured, &collector, err);
  if (!st) normalize_order(&automorphisms);
  if (!st) st = thr_automorphisms_orbits(&automorphisms, err);

  coloured_destroy(&coloured);
  if (st) thr_automorphisms_destroy(&automorphisms);
  *out = automorphisms;
  return st;
}

void thr_automorphisms_destroy(thr_automorphisms *automorphisms)
{
  free(automorphisms->generator);
  free(automorphisms->orbit);
  *automorphisms = (thr_automorphisms){0};
}

const char *thr_nauty_version(void)
{
  return NAUTYVERSION;
}
