/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Automorphisms by Traces (McKay & Piperno 2014). The only file that knows nauty.
 *
 * nauty's callback has no user pointer and its failures end the program: one target at a time in a
 * thread, and alloc_error, which nauty calls when memory runs out, is replaced by a jump back (the
 * program's definition goes before the shared library's). Sparse nauty itself is not used: it
 * overruns its buffers on stars. */
#include "graph/disjoint.h"
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
static const long SEED =
    1; /* of nauty's random Schreier-Sims: generators are the same on every call */

typedef struct {
  thr_automorphisms *out;
  int capacity;      /* rows that out->generator has room for */
  thr_status status; /* why not all were collected */
} collector;

static _Thread_local collector *collecting;
static _Thread_local jmp_buf escape;

/* Called by nauty, instead of its own. */
void alloc_error(const char *what)
{
  (void)what;
  longjmp(escape, 1);
}

static void collect(int count, int *image, int degree)
{
  (void)count, (void)degree;
  collector *c = collecting;
  thr_automorphisms *a = c->out;
  size_t row = (size_t)a->n * sizeof *a->generator;
  if (c->status) return;
  if (a->n_generators >= MOST_IMAGES / a->n)
    c->status = THR_ELIMIT;
  else
    c->status = thr_grow(&a->generator, a->n_generators, &c->capacity, row, NULL);
  if (!c->status) memcpy(&a->generator[(size_t)a->n_generators++ * (size_t)a->n], image, row);
}

/* The graph as Traces takes it: nodes, and one more per edge when edges have colours. */
typedef struct {
  int n; /* nodes and subdivisions */
  sparsegraph graph;
  int *lab, *ptn; /* nodes by colour; ptn 0 at the last of each colour */
  int *orbits;
} coloured;

static void coloured_destroy(coloured *c)
{
  free(c->graph.v);
  free(c->graph.d);
  free(c->graph.e);
  free(c->lab);
  free(c->ptn);
  free(c->orbits);
}

typedef struct {
  int kind, colour, index; /* kind: 0 a node, 1 a foot, 2 an edge */
} point;

static bool same_colour(const point *p, const point *q)
{
  return p->kind == q->kind && p->colour == q->colour;
}

static int by_colour(const void *a, const void *b)
{
  const point *p = a, *q = b;
  if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
  if (p->colour != q->colour) return p->colour < q->colour ? -1 : 1;
  return (p->index > q->index) - (p->index < q->index);
}

static int colour_of(const int *colour, int i)
{
  return colour ? colour[i] : 0;
}

static thr_status fill_colours(coloured *c, const thr_frame *frame,
                               const thr_automorphism_options *options, thr_err *err)
{
  point *p = thr_calloc((size_t)c->n, sizeof *p);
  if (!p) return thr_nomem(err);
  for (int i = 0; i < c->n; i++) {
    int e = i - frame->n_nodes;
    p[i].index = i;
    p[i].kind = e >= 0 ? 2 : frame->foot[i] ? 1 : 0;
    p[i].colour = e >= 0 ? colour_of(options->edge_colour, e) : colour_of(options->node_colour, i);
  }
  qsort(p, (size_t)c->n, sizeof *p, by_colour);
  for (int i = 0; i < c->n; i++) {
    c->lab[i] = p[i].index;
    c->ptn[i] = i + 1 < c->n && same_colour(&p[i], &p[i + 1]);
  }
  free(p);
  return THR_OK;
}

static void fill_graph(coloured *c, const thr_frame *frame)
{
  size_t at = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    c->graph.v[v] = at;
    c->graph.d[v] = thr_degree(frame, v);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      c->graph.e[at++] = c->n > frame->n_nodes ? frame->n_nodes + (frame->half[i] >> 1)
                                               : thr_head(frame, frame->half[i]);
  }
  for (int i = frame->n_nodes; i < c->n; i++) {
    c->graph.v[i] = at;
    c->graph.d[i] = 2;
    c->graph.e[at++] = frame->edge[i - frame->n_nodes][0];
    c->graph.e[at++] = frame->edge[i - frame->n_nodes][1];
  }
  c->graph.nv = c->n;
  c->graph.nde = at;
}

static bool all_equal(const int *colour, int n)
{
  for (int e = 1; e < n; e++)
    if (colour[e] != colour[0]) return false;
  return true;
}

static thr_status coloured_init(coloured *c, const thr_frame *frame,
                                const thr_automorphism_options *options, thr_err *err)
{
  bool subdivide = options->edge_colour && !all_equal(options->edge_colour, frame->n_edges);
  SG_INIT(c->graph);
  if (subdivide && frame->n_edges > NAUTY_INFINITY - 1 - frame->n_nodes)
    return thr_fail(err, THR_ELIMIT, "nauty: more than %d nodes and edges", NAUTY_INFINITY);
  c->n = frame->n_nodes + (subdivide ? frame->n_edges : 0);
  c->graph.vlen = c->graph.dlen = (size_t)c->n;
  c->graph.elen = (subdivide ? 4 : 2) * (size_t)frame->n_edges;
  c->graph.v = thr_calloc(c->graph.vlen, sizeof *c->graph.v);
  c->graph.d = thr_calloc(c->graph.dlen, sizeof *c->graph.d);
  c->graph.e = thr_calloc(c->graph.elen, sizeof *c->graph.e);
  c->lab = thr_calloc((size_t)c->n, sizeof *c->lab);
  c->ptn = thr_calloc((size_t)c->n, sizeof *c->ptn);
  c->orbits = thr_calloc((size_t)c->n, sizeof *c->orbits);
  if (!c->graph.v || !c->graph.d || !c->graph.e || !c->lab || !c->ptn || !c->orbits)
    return thr_nomem(err);
  fill_graph(c, frame);
  return fill_colours(c, frame, options, err);
}

/* Is there memory for a run? Asked for and given back. */
static bool enough_memory(const coloured *c)
{
  void *probe = thr_calloc((size_t)c->n + 1024, BYTES_PER_POINT);
  free(probe);
  return probe != NULL;
}

/* Traces leaves what it was working on behind when it jumps out: its tables are released, its
 * search tree is lost. */
static thr_status run_traces(coloured *c, collector *k, thr_err *err)
{
  TracesStats stats = {0};
  DEFAULTOPTIONS_TRACES(options);
  options.defaultptn = FALSE;
  options.userautomproc = collect;
  collecting = k;
  if (!enough_memory(c)) return thr_nomem(err);
  if (setjmp(escape)) {
    traces_freedyn();
    nausparse_freedyn();
    schreier_freedyn();
    nautil_freedyn();
    return thr_nomem(err);
  }
  ran_init(SEED);
  Traces(&c->graph, c->lab, c->ptn, c->orbits, &options, &stats, NULL);
  if (stats.errstatus)
    return thr_fail(err, THR_ESOLVER, "nauty: Traces gave up with status %d", stats.errstatus);
  if (k->status == THR_ELIMIT)
    return thr_fail(err, THR_ELIMIT, "the group of %d nodes has too many generators to hold",
                    k->out->n);
  if (k->status) return thr_nomem(err);
  k->out->mantissa = stats.grpsize1;
  k->out->exponent = stats.grpsize2;
  return THR_OK;
}

/* nauty takes powers of ten out as soon as it can: back where the order is an integer that a double
 * holds. */
static void normalize_order(thr_automorphisms *a)
{
  double order = a->mantissa * pow(10, a->exponent);
  if (order >= 1e15) return;
  a->mantissa = nearbyint(order);
  a->exponent = 0;
}

thr_status thr_automorphisms_orbits(thr_automorphisms *a, thr_err *err)
{
  a->orbit = thr_calloc((size_t)a->n, sizeof *a->orbit);
  if (!a->orbit) return thr_nomem(err);
  for (int v = 0; v < a->n; v++)
    a->orbit[v] = v;
  for (int g = 0; g < a->n_generators; g++)
    for (int v = 0; v < a->n; v++)
      thr_disjoint_join(a->orbit, v, a->generator[(size_t)g * (size_t)a->n + (size_t)v]);
  for (int v = 0; v < a->n; v++)
    a->orbit[v] = thr_disjoint_find(a->orbit, v);
  return THR_OK;
}

thr_status thr_automorphisms_find(const thr_frame *frame, const thr_automorphism_options *options,
                                  thr_automorphisms *out, thr_err *err)
{
  coloured c = {0};
  thr_automorphisms a = {.n = frame->n_nodes, .mantissa = 1};
  collector k = {.out = &a};
  thr_status st = coloured_init(&c, frame, options, err);
  if (!st && c.n > 0) st = run_traces(&c, &k, err);
  if (!st) normalize_order(&a);
  if (!st) st = thr_automorphisms_orbits(&a, err);
  coloured_destroy(&c);
  if (st) thr_automorphisms_destroy(&a);
  *out = a;
  return st;
}

void thr_automorphisms_destroy(thr_automorphisms *a)
{
  free(a->generator);
  free(a->orbit);
  *a = (thr_automorphisms){0};
}

const char *thr_nauty_version(void)
{
  return NAUTYVERSION;
}
