/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps walks through the passes of a framework, while it is still open which cord takes which.
 *
 * A walk in the sense of graph theory is a sequence of consecutive half-edges, which may contain an
 * edge several times. thr_walks_trace makes as few walks as pass every edge a given number of
 * times: nodes with an odd number of passes are joined in pairs by virtual edges, passes are paired
 * at every node for little turning, circuits are joined to one, and the circuit is cut at the
 * virtual edges (Euler). Walks can be copied, reversed, rotated, listed by the nodes that they
 * visit, and made cords.
 *
 * Example: a path of two edges, each passed once, is one open walk; each passed twice, one cyclic
 * walk of four passes. */
#include "graph/threading/threading.h"

#include <stdlib.h>
#include <string.h>

void thr_walks_destroy(thr_walks *walks)
{
  for (int i = 0; i < walks->n_walks; i++)
    free(walks->walk[i].half);
  free(walks->walk);
  *walks = (thr_walks){0};
}

double thr_walk_length(const thr_frame *frame, const int *half, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += frame->length[half[i] >> 1];
  return sum;
}

double thr_walks_length(const thr_walks *walks)
{
  double sum = 0;
  for (int i = 0; i < walks->n_walks; i++)
    sum += walks->walk[i].length;
  return sum;
}

int thr_walks_longest(const thr_walks *walks)
{
  int best = 0;
  for (int i = 1; i < walks->n_walks; i++)
    if (walks->walk[i].length > walks->walk[best].length) best = i;
  return best;
}

double thr_walks_most(const thr_walks *walks)
{
  return walks->n_walks > 0 ? walks->walk[thr_walks_longest(walks)].length : 0;
}

thr_status thr_walks_add(thr_walks *walks, const thr_frame *frame, thr_walk walk, thr_err *err)
{
  thr_status st =
      thr_grow(&walks->walk, walks->n_walks, &walks->capacity, sizeof *walks->walk, err);
  if (st) {
    free(walk.half);
    return st;
  }

  walk.length = thr_walk_length(frame, walk.half, walk.n);
  walks->walk[walks->n_walks++] = walk;
  return THR_OK;
}

thr_status thr_walks_copy(thr_walks *walks, const thr_frame *frame, const int *half, int n,
                          bool cyclic, thr_err *err)
{
  thr_walk new = {n, thr_calloc((size_t)n, sizeof *new.half), 0, cyclic};
  if (!new.half) return thr_nomem(err);
  memcpy(new.half, half, (size_t)n * sizeof *half);
  return thr_walks_add(walks, frame, new, err);
}

void thr_walks_count(const thr_walks *walks, int *passes)
{
  for (int i = 0; i < walks->n_walks; i++)
    for (int k = 0; k < walks->walk[i].n; k++)
      passes[walks->walk[i].half[k] >> 1]++;
}

double thr_walk_turn(const thr_frame *frame, int in, int out)
{
  return thr_turn_angle(frame, in, out) + (out == (in ^ 1) ? THR_U_TURN_PRICE : 0);
}

/* ---- tracing ---- */

/* Lists the nodes with an odd number of passes in pairs, by ascending numbers; returns the number
 * of pairs. */
static int pair_odd_nodes(const thr_frame *frame, const int *passes, int (*pair)[2])
{
  int n = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    int sum = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += passes[frame->half[i] >> 1];

    if (sum % 2) pair[n / 2][n % 2] = v, n++;
  }
  return n / 2;
}

/* Cuts the circuit dart[0 .. n-1] at its virtual darts, and appends the parts as walks. The circuit
 * starts with a virtual dart if it has any; a circuit without one is a cyclic walk. */
static thr_status break_circuit(const thr_frame *frame, const thr_multigraph *multigraph,
                                const int *dart, int n, thr_walks *out, thr_err *err)
{
  thr_status st = THR_OK;
  bool cyclic = multigraph->half[dart[0]] >= 0;

  /* The parts between virtual darts. */
  for (int from = cyclic ? 0 : 1, end; from < n && !st; from = end + 1) {
    for (end = from; end < n && multigraph->half[dart[end]] >= 0;)
      end++;

    if (end == from) return thr_fail(err, THR_ESOLVER, "a cord without a pass");

    thr_walk walk = {end - from, thr_calloc((size_t)(end - from), sizeof *walk.half), 0, cyclic};
    if (!walk.half) return thr_nomem(err);
    for (int i = from; i < end; i++)
      walk.half[i - from] = multigraph->half[dart[i]];

    st = thr_walks_add(out, frame, walk, err);
  }
  return st;
}

thr_status thr_walks_follow(thr_walks *walks, const thr_frame *frame,
                            const thr_multigraph *multigraph, const int *mate, thr_err *err)
{
  int *walk = thr_calloc((size_t)multigraph->n_darts, sizeof *walk), n;
  bool *seen = thr_calloc((size_t)multigraph->n_darts, sizeof *seen);
  thr_status st = walk && seen ? THR_OK : thr_nomem(err);

  /* First the circuits with virtual edges, each from such an edge; then the others. */
  for (int closed = 0; closed < 2; closed++)
    for (int d = 0; d < multigraph->n_darts && !st; d++) {
      if (seen[d] || (!closed && multigraph->half[d] >= 0)) continue;

      thr_transition_trace(mate, d, walk, &n);
      for (int i = 0; i < n; i++)
        seen[walk[i]] = seen[walk[i] ^ 1] = true;
      st = break_circuit(frame, multigraph, walk, n, walks, err);
    }

  free(walk);
  free(seen);
  return st;
}

thr_status thr_walks_trace(const thr_frame *frame, const int *passes, thr_walks *out, thr_err *err)
{
  thr_multigraph multigraph = {0};
  int *mate = NULL, (*pair)[2] = thr_calloc((size_t)frame->n_nodes / 2 + 1, sizeof *pair);
  double(*four)[3] = NULL;
  *out = (thr_walks){0};
  if (!pair) return thr_nomem(err);

  thr_status st = thr_multigraph_init(&multigraph, frame, 0, passes, (const int(*)[2])pair,
                                      pair_odd_nodes(frame, passes, pair), err);

  /* Pair the passes at every node, join the circuits, and cut them into walks. */
  if (!st && !(mate = thr_calloc((size_t)multigraph.n_darts, sizeof *mate))) st = thr_nomem(err);
  if (!st && !(four = thr_calloc((size_t)frame->n_nodes, sizeof *four))) st = thr_nomem(err);
  if (!st) st = thr_transition_pair(frame, &multigraph, mate, four, err);
  if (!st) st = thr_transition_join(frame, &multigraph, mate, (const double(*)[3])four, 0, err);
  free(four);
  if (!st) st = thr_walks_follow(out, frame, &multigraph, mate, err);

  if (st) thr_walks_destroy(out);
  thr_multigraph_destroy(&multigraph);
  free(mate);
  free(pair);
  return st;
}

/* ---- changes ---- */

thr_status thr_walk_rotate(thr_walk *walk, int at, thr_err *err)
{
  if (at == 0) return THR_OK;
  int *half = thr_calloc((size_t)walk->n, sizeof *half);
  if (!half) return thr_nomem(err);
  memcpy(half, walk->half + at, (size_t)(walk->n - at) * sizeof *half);
  memcpy(half + walk->n - at, walk->half, (size_t)at * sizeof *half);
  free(walk->half);
  walk->half = half;
  return THR_OK;
}

/* ---- visits ---- */

/* Lists the visits of walk i. The newest visit of a node is the first in the node's list. */
static void list_walk(thr_walk_visits *visits, int i)
{
  const thr_walk *walk = &visits->w[i];
  double sum = 0;
  for (int k = 0; k <= walk->n; k++) {
    int visit = visits->n++;
    visits->walk[visit] = i;
    visits->at[visit] = k;
    visits->sum[visit] = sum;
    visits->next[visit] = -1;
    if (k < walk->n) sum += visits->f->length[walk->half[k] >> 1];

    /* The last position of a cyclic walk is the first one again. */
    if (k == walk->n && walk->cyclic) continue;
    int *first = &visits->first[thr_walk_node(visits->f, walk, k)];
    visits->next[visit] = *first;
    *first = visit;
  }
}

thr_status thr_walk_visits_init(thr_walk_visits *visits, const thr_frame *frame,
                                const thr_walk *walk, int n_walks, thr_err *err)
{
  size_t n = (size_t)n_walks, nodes = (size_t)frame->n_nodes;
  for (int i = 0; i < n_walks; i++)
    n += (size_t)walk[i].n;

  *visits = (thr_walk_visits){.f = frame,
                              .w = walk,
                              .first = thr_calloc(nodes, sizeof *visits->first),
                              .next = thr_calloc(n, sizeof *visits->next),
                              .walk = thr_calloc(n, sizeof *visits->walk),
                              .at = thr_calloc(n, sizeof *visits->at),
                              .sum = thr_calloc(n, sizeof *visits->sum)};
  if (!visits->first || !visits->next || !visits->walk || !visits->at || !visits->sum) {
    thr_walk_visits_destroy(visits);
    return thr_nomem(err);
  }

  /* Every first visit is -1 before the walks are listed. */
  memset(visits->first, 0xff, nodes * sizeof *visits->first);
  for (int i = 0; i < n_walks; i++)
    list_walk(visits, i);
  return THR_OK;
}

void thr_walk_visits_destroy(thr_walk_visits *visits)
{
  free(visits->first);
  free(visits->next);
  free(visits->walk);
  free(visits->at);
  free(visits->sum);
  *visits = (thr_walk_visits){0};
}

/* ---- cords ---- */

int thr_walk_node(const thr_frame *frame, const thr_walk *walk, int at)
{
  return at < walk->n ? thr_tail(frame, walk->half[at]) : thr_head(frame, walk->half[walk->n - 1]);
}

void thr_walk_reverse(int *half, int n)
{
  for (int i = 0, j = n - 1; i <= j; i++, j--) {
    int h = half[i];
    half[i] = half[j] ^ 1;
    half[j] = h ^ 1;
  }
}

/* Moves a walk into a cord: an open walk from its lower end, a cyclic one from where closing the
 * cord leaves out most. An open walk that comes back to its start becomes a closed cord. */
static thr_status make_cord(thr_walk *walk, const thr_frame *frame, const thr_request *options,
                            thr_cord *cord, thr_err *err)
{
  int start = thr_tail(frame, walk->half[0]), end = thr_head(frame, walk->half[walk->n - 1]);
  if (start > end) thr_walk_reverse(walk->half, walk->n);

  thr_status st =
      walk->cyclic ? thr_walk_rotate(walk, thr_tour_start(frame, options, walk->half, walk->n), err)
                   : THR_OK;
  if (st) return st;

  *cord = (thr_cord){.closed = start == end, .n_passes = walk->n, .half = walk->half};
  walk->half = NULL;
  return THR_OK;
}

thr_status thr_walks_cords(thr_walks *walks, const thr_frame *frame, const thr_request *options,
                           thr_cord **cord, int *n_cords, thr_err *err)
{
  const int n = walks->n_walks;
  *n_cords = 0;
  if (!(*cord = thr_calloc((size_t)n, sizeof **cord))) return thr_nomem(err);

  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    st = make_cord(&walks->walk[i], frame, options, &(*cord)[i], err);
    thr_cord_id(i, (*cord)[i].id);
  }

  /* On failure the cords that were made are released, too. */
  if (st) {
    thr_cords_destroy(*cord, n);
    *cord = NULL;
    return st;
  }

  *n_cords = n;
  thr_walks_destroy(walks);
  return THR_OK;
}
