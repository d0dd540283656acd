/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes some cords for tube joints without a search, so that there are some before a search has
 * found any. Internal to tortuosity/.
 *
 * At every node each edge is followed by the next one, and the last by the first: a ring of turns,
 * which ties the node. Where two passes of one edge belong to different circuits, exchanging them
 * behind the edge joins the circuits and changes no turn; so there is one circuit. It may be opened
 * once at every node, because a ring without one turn is a path; more closed cords run around a
 * short circuit.
 *
 * Example: a ring of n edges gives one circuit of 2 n passes. */
#include "tortuosity/tie/tie.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

/* The circuit as pairs of passes, and then as walks. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int passes; /* of every edge */
  thr_multigraph multigraph;
  int *mate; /* [n_darts] */
  thr_walks walks;
  bool *mark; /* [n_nodes] scratch of paths; then, where a circuit was opened */
} first_cords;

static void first_destroy(first_cords *first)
{
  thr_walks_destroy(&first->walks);
  free(first->mate);
  free(first->mark);
  thr_multigraph_destroy(&first->multigraph);
}

/* Makes the multigraph, with as many passes of every edge. */
static thr_status first_init(first_cords *first, thr_err *err)
{
  const thr_frame *frame = first->f;
  int *passes = thr_calloc((size_t)frame->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++)
    passes[e] = first->passes;

  thr_status st = thr_multigraph_init(&first->multigraph, frame, 0, passes, NULL, 0, err);
  free(passes);
  if (st) return st;

  first->mate = thr_calloc((size_t)first->multigraph.n_darts, sizeof *first->mate);
  first->mark = thr_calloc((size_t)frame->n_nodes, sizeof *first->mark);
  return first->mate && first->mark ? THR_OK : thr_nomem(err);
}

/* Returns whether these options and this framework have such cords. Sets the number of passes. */
static bool is_possible(first_cords *first)
{
  const thr_request *options = first->o;
  bool closed = options->ends == THR_ENDS_CLOSED;

  if (options->ends == THR_ENDS_COUNTS || (closed && options->max_length > 0)) return false;

  /* An even number of passes, which is no less than any cover. */
  first->passes = 2;
  for (int e = 0; e < first->f->n_edges; e++)
    if (thr_plan_cover(first->f, options, e) > first->passes)
      first->passes = thr_plan_cover(first->f, options, e);
  first->passes += first->passes % 2;

  int more = closed ? options->cords_least - 1 : 0;
  for (int e = 0; e < first->f->n_edges; e++)
    if (thr_plan_capacity(first->f, options, e) - more < first->passes) return false;
  for (int v = 0; v < first->f->n_nodes; v++)
    if (thr_degree(first->f, v) < 2) return false;
  return true;
}

/* Pairs the passes at every node in a ring of its edges. The darts of a node stand edge by edge:
 * the second of every two of an edge goes on in the first of two of the next edge. */
static void pair_in_rings(first_cords *first)
{
  const thr_multigraph *multigraph = &first->multigraph;
  for (int v = 0; v < multigraph->n_nodes; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];

    for (int i = 1; i < n; i += 2) {
      int next = (i - 1 + first->passes) % n;
      thr_set_pair(first->mate, dart[i], dart[next]);
    }
  }
}

/* Joins the circuits to one, without changing a turn. */
static thr_status join_circuits(first_cords *first, thr_err *err)
{
  int *circuit = thr_calloc((size_t)first->multigraph.n_darts, sizeof *circuit),
      *parent = thr_calloc((size_t)first->multigraph.n_darts, sizeof *parent);
  thr_status st = circuit && parent ? THR_OK : thr_nomem(err);

  if (!st) {
    for (int k = thr_threading_label(&first->multigraph, first->mate, circuit) - 1; k >= 0; k--)
      parent[k] = k;
    thr_transition_join_equal(&first->multigraph, circuit, parent, first->mate);
  }

  free(circuit);
  free(parent);
  return st;
}

/* ---- more closed cords ---- */

/* Returns the node where the paths to a and b part. mark[n_nodes] is scratch, and all false. */
static int fork_of(const thr_paths *paths, int a, int b, bool *mark)
{
  for (int v = a; paths->over[v] >= 0; v = thr_tail(paths->f, paths->over[v]))
    mark[v] = true;

  while (!mark[b] && paths->over[b] >= 0)
    b = thr_tail(paths->f, paths->over[b]);

  for (int v = a; paths->over[v] >= 0; v = thr_tail(paths->f, paths->over[v]))
    mark[v] = false;
  return b;
}

/* Appends n times the circuit that edge e closes with the paths to its nodes. */
static thr_status add_circuit(first_cords *first, const thr_paths *paths, int e, int n,
                              thr_err *err)
{
  int a = first->f->edge[e][0], b = first->f->edge[e][1], fork = fork_of(paths, a, b, first->mark);
  int from_a = thr_paths_back(paths, a, fork, NULL), from_b = thr_paths_back(paths, b, fork, NULL);

  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    thr_walk walk = {1 + from_a + from_b, NULL, 0, true};

    if (!(walk.half = thr_calloc((size_t)walk.n, sizeof *walk.half))) return thr_nomem(err);

    /* Over edge e, from its second node to the fork, and back to its first node. */
    walk.half[0] = 2 * e;
    thr_paths_back(paths, b, fork, walk.half + 1);
    thr_paths_back(paths, a, fork, walk.half + 1 + from_b);
    thr_walk_reverse(walk.half + 1 + from_b, from_a);
    st = thr_walks_add(&first->walks, first->f, walk, err);
  }
  return st;
}

/* Returns the edge that closes the shortest circuit with the paths to its nodes. */
static int find_circuit(const thr_frame *frame, const thr_paths *paths)
{
  int best = -1;
  double shortest = INFINITY;
  for (int e = 0; e < frame->n_edges; e++) {
    int a = frame->edge[e][0], b = frame->edge[e][1];
    double length = frame->length[e] + paths->far[a] + paths->far[b];

    if (paths->over[a] >> 1 == e || paths->over[b] >> 1 == e || length >= shortest) continue;

    shortest = length;
    best = e;
  }
  return best;
}

/* Appends n more circuits, all around the shortest one that one edge closes with paths from the
 * first node. */
static thr_status add_circuits(first_cords *first, int n, thr_err *err)
{
  thr_paths paths;
  thr_status st = thr_paths_init(&paths, first->f, err);
  if (!st) st = thr_paths_start(&paths, 0, err);
  if (!st) st = thr_paths_spread(&paths, first->o, NULL, 0, INFINITY, err);
  if (!st) st = add_circuit(first, &paths, find_circuit(first->f, &paths), n, err);
  thr_paths_destroy(&paths);
  return st;
}

/* ---- open cords ---- */

/* Returns where the piece of a circuit that begins at pass `from` ends: at the first place from
 * length `least` on, or else the last place up to length `most`. -1: nowhere. The circuit's end is
 * a place. */
static int next_place(const first_cords *first, const thr_walk *walk, int from, double least,
                      double most)
{
  int found = -1;
  double length = 0;
  for (int i = from + 1; i <= walk->n; i++) {
    int v = thr_walk_node(first->f, walk, i);
    length += first->f->length[walk->half[i - 1] >> 1];

    if (length > most) return found;

    if (i < walk->n && (first->mark[v] || !thr_plan_end_allowed(first->f, first->o, v))) continue;

    found = i;
    if (length >= least) return found;
  }
  return found;
}

/* Cuts the circuit into pieces. *found: it could be cut into as many as asked for. */
static thr_status cut_circuit(first_cords *first, bool *found, thr_err *err)
{
  const thr_request *options = first->o;
  thr_walks *walks = &first->walks;
  int start = 0;
  *found = false;

  while (start < walks->walk[0].n &&
         !thr_plan_end_allowed(first->f, options, thr_walk_node(first->f, &walks->walk[0], start)))
    start++;
  if (start == walks->walk[0].n) return THR_OK;

  /* The circuit begins where a cord may end. No node is opened twice. */
  thr_status st = thr_walk_rotate(&walks->walk[0], start, err);
  first->mark[thr_walk_node(first->f, &walks->walk[0], 0)] = true;

  for (int last = 0, wanted = options->cords_least; !st; last++) {
    thr_walk *rest = &walks->walk[last];
    double part = rest->length / (wanted > last ? wanted - last : 1);

    int at = options->max_length > 0 ? next_place(first, rest, 0, INFINITY, options->max_length)
                                     : next_place(first, rest, 0, part * (1 - 1e-9), INFINITY);

    if (at < 0) return THR_OK;
    if (at == rest->n) break;

    first->mark[thr_walk_node(first->f, rest, at)] = true;
    st = thr_splice_cut(walks, first->f, last, at, err);
  }

  *found = walks->n_walks >= options->cords_least && walks->n_walks <= options->cords;
  return st;
}

thr_status thr_tube_first(const thr_frame *frame, const thr_request *options, const int *passes,
                          thr_cord **cord, int *n_cords, thr_err *err)
{
  first_cords first = {.f = frame, .o = options};
  bool found = true;
  (void)passes;
  *cord = NULL;
  *n_cords = 0;

  if (!is_possible(&first)) return THR_OK;

  /* One circuit through all passes, with every node tied. */
  thr_status st = first_init(&first, err);
  if (!st) pair_in_rings(&first);
  if (!st) st = join_circuits(&first, err);
  if (!st) st = thr_walks_follow(&first.walks, frame, &first.multigraph, first.mate, err);
  if (!st)
    st = options->ends == THR_ENDS_CLOSED ? add_circuits(&first, options->cords_least - 1, err)
                                          : cut_circuit(&first, &found, err);

  if (!st && found) st = thr_walks_cords(&first.walks, frame, options, cord, n_cords, err);
  first_destroy(&first);
  return st;
}
