/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Some cords for tube joints at once: what there is before a search has found any. Internal to
 * tortuosity/.
 *
 * Tied cords without a search. At every node each edge is followed by the next one, and the last by
 * the first: a ring of turns, which ties the node. Where two passes of one edge belong to different
 * circuits, exchanging them behind the edge joins the circuits and changes no turn; so there is one
 * circuit. It may be opened once at every node, because a ring without one turn is a path; more
 * closed cords run around a short circuit. */
#include "tortuosity/tie/tie.h"
#include "graph/threading/euler.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int passes; /* of every edge */
  thr_multigraph g;
  int *mate; /* [n_darts] */
  thr_walks walks;
  bool *mark; /* [n_nodes] scratch of paths; then, where a circuit was opened */
} first;

static void first_destroy(first *x)
{
  thr_walks_destroy(&x->walks);
  free(x->mate);
  free(x->mark);
  thr_multigraph_destroy(&x->g);
}

static thr_status first_init(first *x, thr_err *err)
{
  const thr_frame *frame = x->f;
  int *passes = thr_calloc((size_t)frame->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++)
    passes[e] = x->passes;
  thr_status st = thr_multigraph_init(&x->g, frame, 0, passes, NULL, 0, err);
  free(passes);
  if (st) return st;
  x->mate = thr_calloc((size_t)x->g.n_darts, sizeof *x->mate);
  x->mark = thr_calloc((size_t)frame->n_nodes, sizeof *x->mark);
  return x->mate && x->mark ? THR_OK : thr_nomem(err);
}

/* Do these options and this framework have such cords? Sets the number of passes. */
static bool is_possible(first *x)
{
  const thr_request *options = x->o;
  bool closed = options->ends == THR_ENDS_CLOSED;
  if (options->ends == THR_ENDS_COUNTS || (closed && options->max_length > 0)) return false;
  x->passes = 2;
  for (int e = 0; e < x->f->n_edges; e++)
    if (thr_plan_cover(x->f, options, e) > x->passes) x->passes = thr_plan_cover(x->f, options, e);
  x->passes += x->passes % 2;
  int more = closed ? options->cords_least - 1 : 0;
  for (int e = 0; e < x->f->n_edges; e++)
    if (thr_plan_capacity(x->f, options, e) - more < x->passes) return false;
  for (int v = 0; v < x->f->n_nodes; v++)
    if (thr_degree(x->f, v) < 2) return false;
  return true;
}

/* The darts of a node stand edge by edge: the second of every two of an edge goes on in the first
 * of two of the next edge. */
static void pair_in_rings(first *x)
{
  const thr_multigraph *multigraph = &x->g;
  for (int v = 0; v < multigraph->n_nodes; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    for (int i = 1; i < n; i += 2) {
      int next = (i - 1 + x->passes) % n;
      thr_set_pair(x->mate, dart[i], dart[next]);
    }
  }
}

static thr_status join_circuits(first *x, thr_err *err)
{
  int *circuit = thr_calloc((size_t)x->g.n_darts, sizeof *circuit),
      *parent = thr_calloc((size_t)x->g.n_darts, sizeof *parent);
  thr_status st = circuit && parent ? THR_OK : thr_nomem(err);
  if (!st) {
    for (int k = thr_threading_label(&x->g, x->mate, circuit) - 1; k >= 0; k--)
      parent[k] = k;
    thr_transition_join_equal(&x->g, circuit, parent, x->mate);
  }
  free(circuit);
  free(parent);
  return st;
}

/* ---- more closed cords ---- */

/* Where the paths to a and b part. */
static int fork_of(const thr_paths *g, int a, int b, bool *mark)
{
  for (int v = a; g->over[v] >= 0; v = thr_tail(g->f, g->over[v]))
    mark[v] = true;
  while (!mark[b] && g->over[b] >= 0)
    b = thr_tail(g->f, g->over[b]);
  for (int v = a; g->over[v] >= 0; v = thr_tail(g->f, g->over[v]))
    mark[v] = false;
  return b;
}

/* n times the circuit that edge e closes with the paths to its nodes. */
static thr_status add_circuit(first *x, const thr_paths *g, int e, int n, thr_err *err)
{
  int a = x->f->edge[e][0], b = x->f->edge[e][1], fork = fork_of(g, a, b, x->mark);
  int from_a = thr_paths_back(g, a, fork, NULL), from_b = thr_paths_back(g, b, fork, NULL);
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    thr_walk w = {1 + from_a + from_b, NULL, 0, true};
    if (!(w.half = thr_calloc((size_t)w.n, sizeof *w.half))) return thr_nomem(err);
    w.half[0] = 2 * e;
    thr_paths_back(g, b, fork, w.half + 1);
    thr_paths_back(g, a, fork, w.half + 1 + from_b);
    thr_walk_reverse(w.half + 1 + from_b, from_a);
    st = thr_walks_add(&x->walks, x->f, w, err);
  }
  return st;
}

/* The edge that closes the shortest circuit with the paths to its nodes. */
static int find_circuit(const thr_frame *frame, const thr_paths *g)
{
  int best = -1;
  double shortest = INFINITY;
  for (int e = 0; e < frame->n_edges; e++) {
    int a = frame->edge[e][0], b = frame->edge[e][1];
    double length = frame->length[e] + g->far[a] + g->far[b];
    if (g->over[a] >> 1 == e || g->over[b] >> 1 == e || length >= shortest) continue;
    shortest = length;
    best = e;
  }
  return best;
}

/* n more circuits, all around the shortest that one edge closes with paths from the first node. */
static thr_status add_circuits(first *x, int n, thr_err *err)
{
  thr_paths g;
  thr_status st = thr_paths_init(&g, x->f, err);
  if (!st) st = thr_paths_start(&g, 0, err);
  if (!st) st = thr_paths_spread(&g, x->o, NULL, 0, INFINITY, err);
  if (!st) st = add_circuit(x, &g, find_circuit(x->f, &g), n, err);
  thr_paths_destroy(&g);
  return st;
}

/* ---- open cords ---- */

/* Where the piece of circuit w that begins at pass `from` ends: at the first place from length
 * `least` on, or else the last place up to length `most`. -1: nowhere. The circuit's end is a
 * place. */
static int next_place(const first *x, const thr_walk *w, int from, double least, double most)
{
  int found = -1;
  double length = 0;
  for (int i = from + 1; i <= w->n; i++) {
    int v = thr_walk_node(x->f, w, i);
    length += x->f->length[w->half[i - 1] >> 1];
    if (length > most) return found;
    if (i < w->n && (x->mark[v] || !thr_plan_end_allowed(x->f, x->o, v))) continue;
    found = i;
    if (length >= least) return found;
  }
  return found;
}

/* The circuit cut into pieces. *found: it could be cut into as many as asked for. */
static thr_status cut_circuit(first *x, bool *found, thr_err *err)
{
  const thr_request *options = x->o;
  thr_walks *w = &x->walks;
  int start = 0;
  *found = false;
  while (start < w->walk[0].n &&
         !thr_plan_end_allowed(x->f, options, thr_walk_node(x->f, &w->walk[0], start)))
    start++;
  if (start == w->walk[0].n) return THR_OK;
  thr_status st = thr_walk_rotate(&w->walk[0], start, err);
  x->mark[thr_walk_node(x->f, &w->walk[0], 0)] = true;
  for (int last = 0, wanted = options->cords_least; !st; last++) {
    thr_walk *rest = &w->walk[last];
    double part = rest->length / (wanted > last ? wanted - last : 1);
    int at = options->max_length > 0 ? next_place(x, rest, 0, INFINITY, options->max_length)
                                     : next_place(x, rest, 0, part * (1 - 1e-9), INFINITY);
    if (at < 0) return THR_OK;
    if (at == rest->n) break;
    x->mark[thr_walk_node(x->f, rest, at)] = true;
    st = thr_splice_cut(w, x->f, last, at, err);
  }
  *found = w->n_walks >= options->cords_least && w->n_walks <= options->cords;
  return st;
}

thr_status thr_tube_first(const thr_frame *frame, const thr_request *options, const int *passes,
                          thr_cord **cord, int *n_cords, thr_err *err)
{
  first x = {.f = frame, .o = options};
  bool found = true;
  (void)passes;
  *cord = NULL;
  *n_cords = 0;
  if (!is_possible(&x)) return THR_OK;
  thr_status st = first_init(&x, err);
  if (!st) pair_in_rings(&x);
  if (!st) st = join_circuits(&x, err);
  if (!st) st = thr_walks_follow(&x.walks, frame, &x.g, x.mate, err);
  if (!st)
    st = options->ends == THR_ENDS_CLOSED ? add_circuits(&x, options->cords_least - 1, err)
                                          : cut_circuit(&x, &found, err);
  if (!st && found) st = thr_walks_cords(&x.walks, frame, options, cord, n_cords, err);
  first_destroy(&x);
  return st;
}
