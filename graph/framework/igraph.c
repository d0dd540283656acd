/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls igraph: cut trees, maximum flows, drawings of graphs. No other
 * file knows igraph, and the library is loaded only when it is first needed.
 *
 * igraph's default error handler aborts the program; ours returns the error code. igraph keeps
 * global state, so that one thread at a time may use it. No routine of igraph that uses GLPK may be
 * called here: it would replace the hooks that lp/solver/lp_glpk.c sets. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/process/process.h"

#include <igraph.h>
#include <pthread.h>

#include <string.h>

/* The functions that are used, to be looked up in the library. */
#define FUNCTIONS(F)                                                                               \
  F(igraph_create)                                                                                 \
  F(igraph_destroy)                                                                                \
  F(igraph_error_handler_ignore)                                                                   \
  F(igraph_gomory_hu_tree)                                                                         \
  F(igraph_layout_kamada_kawai)                                                                    \
  F(igraph_matrix_destroy)                                                                         \
  F(igraph_matrix_init)                                                                            \
  F(igraph_maxflow)                                                                                \
  F(igraph_set_error_handler)                                                                      \
  F(igraph_strerror)                                                                               \
  F(igraph_vcount)                                                                                 \
  F(igraph_vector_destroy)                                                                         \
  F(igraph_vector_init)                                                                            \
  F(igraph_vector_int_destroy)                                                                     \
  F(igraph_vector_int_init)

static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

/* Loads the library, unless it is loaded. */
static thr_status load(thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  return thr_lazy_load(&lib.loaded, THR_LIBRARY_IGRAPH, symbol, sizeof symbol / sizeof *symbol,
                       err);
}

/* Records what igraph's code means. */
static thr_status failed(igraph_error_t code, thr_err *err)
{
  if (code == IGRAPH_ENOMEM) return thr_nomem(err);
  return thr_fail(err, THR_ESOLVER, "igraph: %s", lib.igraph_strerror(code));
}

/* Held from enter to leave, because igraph keeps its stack of what to release in static variables:
 * one thread at a time. */
static pthread_mutex_t one_thread = PTHREAD_MUTEX_INITIALIZER;

/* Begins the use of igraph; *old receives the error handler for leave. */
static thr_status enter(igraph_error_handler_t **old, thr_err *err)
{
  pthread_mutex_lock(&one_thread);
  thr_status st = load(err);
  if (st)
    pthread_mutex_unlock(&one_thread);
  else
    *old = lib.igraph_set_error_handler(lib.igraph_error_handler_ignore);

  return st;
}

/* Ends the use of igraph. */
static void leave(igraph_error_handler_t *old)
{
  lib.igraph_set_error_handler(old);
  pthread_mutex_unlock(&one_thread);
}

/* Initializes ends with the ends of the m edges, one after the other, as igraph_create takes
 * them. */
static igraph_error_t list_ends(igraph_vector_int_t *ends, int m, const int (*edge)[2])
{
  igraph_error_t code = lib.igraph_vector_int_init(ends, 2 * (igraph_integer_t)m);

  if (code) return code;
  for (int e = 0; e < m; e++) {
    VECTOR(*ends)[2 * e] = edge[e][0];
    VECTOR(*ends)[2 * e + 1] = edge[e][1];
  }

  return code;
}

/* Initializes weights with those of the m edges. */
static igraph_error_t list_weights(igraph_vector_t *weights, int m, const double *weight)
{
  igraph_error_t code = lib.igraph_vector_init(weights, m);
  for (int e = 0; e < m && !code; e++)
    VECTOR(*weights)[e] = weight[e];
  return code;
}

/* Computes the Gomory-Hu tree and its flows, as thr_cut_tree gives them. */
static igraph_error_t cut_tree(const igraph_vector_int_t *ends, int n,
                               const igraph_vector_t *capacity, int (*tree)[2], double *flow)
{
  igraph_t graph, cuts;
  igraph_vector_t flows;
  igraph_error_t code = lib.igraph_create(&graph, ends, n, IGRAPH_UNDIRECTED);

  if (code) return code;
  if ((code = lib.igraph_vector_init(&flows, 0))) goto no_flows;
  if ((code = lib.igraph_gomory_hu_tree(&graph, &cuts, &flows, capacity))) goto no_tree;

  /* The tree has n - 1 edges, in the order of the flows. */
  for (int i = 0; i < n - 1; i++) {
    tree[i][0] = (int)IGRAPH_FROM(&cuts, i);
    tree[i][1] = (int)IGRAPH_TO(&cuts, i);
    flow[i] = VECTOR(flows)[i];
  }

  lib.igraph_destroy(&cuts);
no_tree:
  lib.igraph_vector_destroy(&flows);
no_flows:
  lib.igraph_destroy(&graph);

  return code;
}

/* Computes a Gomory-Hu tree by igraph. */
thr_status thr_cut_tree(int n, int m, const int (*edge)[2], const double *capacity, int (*tree)[2],
                        double *flow, thr_err *err)
{
  igraph_error_handler_t *old;
  thr_status st = enter(&old, err);
  if (st) return st;

  /* Lists in igraph's vectors, then the tree. */
  igraph_vector_int_t ends;
  igraph_vector_t weights;
  igraph_error_t code = list_ends(&ends, m, edge);
  if (code) goto no_ends;
  if ((code = list_weights(&weights, m, capacity))) goto no_weights;

  code = cut_tree(&ends, n, &weights, tree, flow);
  lib.igraph_vector_destroy(&weights);
no_weights:
  lib.igraph_vector_int_destroy(&ends);
no_ends:
  leave(old);

  return code ? failed(code, err) : THR_OK;
}

/* Computes a maximum flow. flow receives the flow along each edge, above 0 towards the node of
 * higher number; side receives the source's nodes of a minimum cut. */
static igraph_error_t maximum_flow(const igraph_vector_int_t *ends, int n, int source, int sink,
                                   const igraph_vector_t *weights, igraph_vector_t *flow,
                                   igraph_vector_int_t *side)
{
  igraph_t graph;
  igraph_real_t value;
  igraph_error_t code = lib.igraph_create(&graph, ends, n, IGRAPH_UNDIRECTED);

  if (code) return code;
  code = lib.igraph_maxflow(&graph, &value, flow, NULL, side, NULL, source, sink, weights, NULL);
  lib.igraph_destroy(&graph);

  return code;
}

/* Computes a maximum flow by igraph, and the source's side of a minimum cut. */
thr_status thr_maximum_flow(int n, int m, const int (*edge)[2], const double *capacity, int source,
                            int sink, double *flow, bool *source_side, thr_err *err)
{
  igraph_error_handler_t *old;
  thr_status st = enter(&old, err);
  if (st) return st;
  igraph_vector_int_t ends, side;
  igraph_vector_t weights, flows;

  igraph_error_t code = list_ends(&ends, m, edge);
  if (code) goto no_ends;
  if ((code = list_weights(&weights, m, capacity))) goto no_weights;
  if ((code = lib.igraph_vector_init(&flows, 0))) goto no_flows;
  if ((code = lib.igraph_vector_int_init(&side, 0))) goto no_side;

  /* igraph counts flows towards the higher node; here they count along the edges as they are given.
   * Of the nodes on one side igraph gives a list; here they are marks. */
  code = maximum_flow(&ends, n, source, sink, &weights, &flows, &side);
  for (int e = 0; e < m && !code; e++)
    flow[e] = edge[e][0] < edge[e][1] ? VECTOR(flows)[e] : -VECTOR(flows)[e];

  /* Marks of the source's side. */
  for (int v = 0; v < n && !code; v++)
    source_side[v] = false;
  for (const igraph_integer_t *v = side.stor_begin; v < side.end && !code; v++)
    source_side[*v] = true;

  lib.igraph_vector_int_destroy(&side);
no_side:
  lib.igraph_vector_destroy(&flows);
no_flows:
  lib.igraph_vector_destroy(&weights);
no_weights:
  lib.igraph_vector_int_destroy(&ends);
no_ends:
  leave(old);

  return code ? failed(code, err) : THR_OK;
}

/* Draws a graph in the plane, from the given places or from a circle: at most 50 n steps, to a
 * constant of n, without random numbers. */
static igraph_error_t kamada_kawai(const igraph_t *graph, const igraph_vector_t *length,
                                   bool circle, double (*xy)[2])
{
  igraph_matrix_t at;
  igraph_integer_t n = lib.igraph_vcount(graph);
  igraph_error_t code = lib.igraph_matrix_init(&at, n, 2);

  if (code) return code;

  /* Places go into igraph's matrix and come back. */
  for (igraph_integer_t v = 0; v < n; v++)
    for (int k = 0; k < 2; k++)
      MATRIX(at, v, k) = xy[v][k];

  /* n is the usual constant of the springs. */
  code = lib.igraph_layout_kamada_kawai(graph, &at, !circle, 50 * n, 0, (double)n, length, NULL,
                                        NULL, NULL, NULL);
  for (igraph_integer_t v = 0; v < n && !code; v++)
    for (int k = 0; k < 2; k++)
      xy[v][k] = MATRIX(at, v, k);

  lib.igraph_matrix_destroy(&at);
  return code;
}

/* What a drawing by springs needs: n nodes, m edges with lengths, where to start, and places. */
typedef struct {
  int n, m;
  const int (*edge)[2];
  const double *length;
  bool circle;
  double (*xy)[2];
} spring_layout;

/* Draws the graph of a layout. */
static igraph_error_t place(const spring_layout *layout)
{
  igraph_vector_int_t ends;
  igraph_vector_t lengths;
  igraph_t graph;
  igraph_error_t code = list_ends(&ends, layout->m, layout->edge);

  if (code) goto no_ends;

  /* The graph and the lengths of its edges, then the search. */
  if ((code = lib.igraph_create(&graph, &ends, layout->n, IGRAPH_UNDIRECTED))) goto no_graph;
  if ((code = list_weights(&lengths, layout->m, layout->length))) goto no_lengths;
  code = kamada_kawai(&graph, &lengths, layout->circle, layout->xy);
  lib.igraph_vector_destroy(&lengths);
no_lengths:
  lib.igraph_destroy(&graph);
no_graph:
  lib.igraph_vector_int_destroy(&ends);
no_ends:
  return code;
}

/* Draws a graph and sends the places; runs in a child process, where a long search can be stopped
 * and cannot hold igraph's lock. */
static thr_status place_and_send(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  /* The child has igraph to itself. */
  const spring_layout *layout = user;
  (void)limits;
  thr_text places = {0};
  thr_status st = load(err);
  if (st) return st;

  lib.igraph_set_error_handler(lib.igraph_error_handler_ignore);
  igraph_error_t code = place(layout);
  if (code) return failed(code, err);
  thr_text_append_bytes(&places, (const char *)layout->xy, (size_t)layout->n * sizeof *layout->xy);
  st = thr_child_send(to, &places, err);

  thr_text_destroy(&places);
  return st;
}

/* Draws a graph in a child process, and waits for the places. */
thr_status thr_kamada_kawai(int n, int m, const int (*edge)[2], const double *length, bool circle,
                            double (*xy)[2], thr_err *err)
{
  /* The child's answer is the places as bytes. */
  spring_layout layout = {n, m, edge, length, circle, xy};
  const thr_child child = {
      .what = "placing nodes for the picture", .run = place_and_send, .user = &layout};
  const thr_limits none = {0};
  thr_text places = {0};

  thr_status st = thr_child_run(&child, &none, &places, err);
  if (!st && n > 0) memcpy(xy, places.data, (size_t)n * sizeof *xy);
  thr_text_destroy(&places);

  return st;
}

const char *thr_igraph_version(void)
{
  return IGRAPH_VERSION; /* that the program was built with: asking the library would load it */
}
