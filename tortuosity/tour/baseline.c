/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walks the classical tours on the multigraph of passes: Fleury (1883) never takes a bridge of
 * what is left while there is another way on, Hierholzer (1873) walks circuits and inserts each
 * into the walk where the two meet.
 *
 * Both take the cheapest pairing of the passes at each node as their preference, unless pairings
 * are ignored, and result in pairs of passes for the search's own structures
 * (tortuosity/cords/join.h).
 *
 * Example: two triangles with one node in common. Hierholzer walks the first and inserts the
 * second at the common node. */
#include "tortuosity/tour/baseline.h"
#include "graph/plan/turning_proof.h"
#include "graph/arrays.h"
#include "graph/threading/threading.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>

/* The passes that are walked so far, and the walk. */
typedef struct {
  thr_join *join;
  thr_scratch own; /* the arrays */
  int *partner;    /* [n_darts] in the cheapest pairing of its node; NULL if pairings are ignored */
  bool *used;      /* [n_darts] both darts of a pass that is walked */
  int *walk;       /* [n_darts / 2 + 1] darts in order */
  int *stack;      /* [n_darts / 2 + 1] */
  int *cursor;     /* [n_nodes] first dart at a node that may be unused */
  int *stamp;      /* [n_nodes] */
  int *queue;      /* [n_nodes] */
  int searches;
} tour_walker;

/* Allocates the arrays of a walker. Release with thr_scratch_free(&walker->own), after a failure
 * too. */
static thr_status walker_init(tour_walker *walker, thr_join *join, thr_err *err)
{
  size_t n_darts = (size_t)join->g.n_darts, n = (size_t)join->g.n_nodes;
  *walker = (tour_walker){.join = join};
  walker->used = thr_scratch_array(&walker->own, n_darts, sizeof *walker->used);
  walker->walk = thr_scratch_array(&walker->own, n_darts / 2 + 1, sizeof *walker->walk);
  walker->stack = thr_scratch_array(&walker->own, n_darts / 2 + 1, sizeof *walker->stack);
  walker->cursor = thr_scratch_array(&walker->own, n, sizeof *walker->cursor);
  walker->stamp = thr_scratch_array(&walker->own, n, sizeof *walker->stamp);
  walker->queue = thr_scratch_array(&walker->own, n, sizeof *walker->queue);
  thr_status st = thr_scratch_check(&walker->own, err);
  if (st) return st;

  /* All darts are unused. */
  for (size_t v = 0; v < n; v++)
    walker->cursor[v] = join->g.first[v];
  return THR_OK;
}

/* Returns the node that dart d arrives at. */
static int head_of(const tour_walker *walker, int d)
{
  return walker->join->g.tail[d ^ 1];
}

/* Returns an unused dart that leaves v, or -1. */
static int unused_at(tour_walker *walker, int v)
{
  const thr_multigraph *multigraph = &walker->join->g;
  while (walker->cursor[v] < multigraph->first[v + 1] &&
         walker->used[multigraph->dart[walker->cursor[v]]])
    walker->cursor[v]++;
  return walker->cursor[v] < multigraph->first[v + 1] ? multigraph->dart[walker->cursor[v]] : -1;
}

/* Returns what Hierholzer walks after the dart, or -1. */
static int next_in_circuit(tour_walker *walker, int dart)
{
  int partner = walker->partner ? walker->partner[dart ^ 1] : -1;
  return partner >= 0 && !walker->used[partner] ? partner
                                                : unused_at(walker, head_of(walker, dart));
}

/* Writes Hierholzer's circuit from dart start to walker->walk, and returns the number of its
 * darts. */
static int hierholzer(tour_walker *walker, int start)
{
  int top = 0, n = 0;
  walker->used[start] = walker->used[start ^ 1] = true;
  walker->stack[top++] = start;

  /* Go on while a pass is left; a dart that leads nowhere is done, and next in the walk. */
  while (top) {
    int dart = next_in_circuit(walker, walker->stack[top - 1]);
    if (dart < 0) {
      walker->walk[n++] = walker->stack[--top];
      continue;
    }
    walker->used[dart] = walker->used[dart ^ 1] = true;
    walker->stack[top++] = dart;
  }

  /* The walk was written from its end. */
  for (int i = 0; i < n / 2; i++) {
    int swap = walker->walk[i];
    walker->walk[i] = walker->walk[n - 1 - i];
    walker->walk[n - 1 - i] = swap;
  }
  return n;
}

/* Says whether v can be reached from the head of the dart over unused passes other than the dart's.
 */
static bool leads_back(tour_walker *walker, int dart, int v)
{
  const thr_multigraph *multigraph = &walker->join->g;
  int head = 0, tail = 0, now = ++walker->searches;

  /* Breadth-first search from the head of the dart. */
  walker->stamp[head_of(walker, dart)] = now;
  walker->queue[tail++] = head_of(walker, dart);
  while (head < tail) {
    int u = walker->queue[head++];
    if (u == v) return true;

    for (int i = multigraph->first[u]; i < multigraph->first[u + 1]; i++) {
      int e = multigraph->dart[i], to = head_of(walker, e);
      if (walker->used[e] || (e | 1) == (dart | 1) || walker->stamp[to] == now) continue;
      walker->stamp[to] = now;
      walker->queue[tail++] = to;
    }
  }
  return false;
}

/* Returns how early Fleury tries dart e after the other dart. */
static double rank_of(const tour_walker *walker, int dart, int e)
{
  if (!walker->partner) return 0;
  return e == walker->partner[dart ^ 1] ? -1 : thr_join_price(walker->join, dart ^ 1, e);
}

/* Returns the dart that Fleury walks after the dart, or -1: the first by rank, and then in order,
 * whose pass is no bridge. No two of the passes left at a node are bridges, so two candidates are
 * enough. */
static int next_but_bridges(tour_walker *walker, int dart)
{
  const thr_multigraph *multigraph = &walker->join->g;
  int v = head_of(walker, dart), bridge = -1, next = -1, left;

  /* Choose the best dart that is left; if its pass is a bridge, the best of the others. */
  do {
    double best = INFINITY;
    bridge = next;
    next = -1;
    left = 0;
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
      int e = multigraph->dart[i];
      if (walker->used[e]) continue;
      left++;

      /* The cheapest turn but the bridge. */
      double rank = rank_of(walker, dart, e);
      if (e != bridge && rank < best) best = rank, next = e;
    }
  } while (left > 1 && bridge < 0 && !leads_back(walker, next, v));
  return next;
}

/* Writes Fleury's walk from dart start to walker->walk, and returns the number of its darts. */
static int fleury(tour_walker *walker, int start)
{
  int n = 0;
  for (int dart = start; dart >= 0; dart = next_but_bridges(walker, dart)) {
    walker->used[dart] = walker->used[dart ^ 1] = true;
    walker->walk[n++] = dart;
  }
  return n;
}

/* Pairs the darts along the walk; at end nodes nothing is paired. */
static void take_pairs(tour_walker *walker, int n)
{
  thr_join *join = walker->join;
  for (int i = 0; i < n; i++) {
    int arriving = walker->walk[i] ^ 1, leaving = walker->walk[(i + 1) % n];
    if (join->g.tail[arriving] < join->c->f->n_nodes) thr_set_pair(join->mate, arriving, leaving);
  }
}

/* Finds the cheapest pairing of the passes and ends at every node, and of the two ends of a
 * cord. */
static thr_status pair_nodes(tour_walker *walker, thr_err *err)
{
  const thr_multigraph *multigraph = &walker->join->g;
  int most = 0;

  /* Allocate for the node with the most darts. */
  for (int v = 0; v < multigraph->n_nodes; v++)
    if (multigraph->first[v + 1] - multigraph->first[v] > most)
      most = multigraph->first[v + 1] - multigraph->first[v];
  double *price = thr_scratch_array(&walker->own, (size_t)most * (size_t)most, sizeof *price);
  int *mate = thr_scratch_array(&walker->own, (size_t)most, sizeof *mate);
  walker->partner =
      thr_scratch_array(&walker->own, (size_t)multigraph->n_darts, sizeof *walker->partner);
  thr_status st = thr_scratch_check(&walker->own, err);

  /* Pair the darts of one node after the other. */
  for (int v = 0; v < multigraph->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    for (int i = 0; i < n; i++)
      for (int k = 0; k < n; k++)
        price[i * n + k] = i == k ? 0 : thr_join_price(walker->join, dart[i], dart[k]);

    st = thr_pairing_best(n, price, mate, err);
    for (int i = 0; i < n && !st; i++)
      walker->partner[dart[i]] = dart[mate[i]];
  }
  return st;
}

/* Walks every component, and pairs the passes as they follow each other. */
static thr_status walk_all(thr_join *join, thr_tour tour, bool ignore_pairings, thr_err *err)
{
  tour_walker walker;
  thr_status st = walker_init(&walker, join, err);
  if (!st && !ignore_pairings) st = pair_nodes(&walker, err);

  /* Begin at the extra node where the cord's ends are joined; a closed cord begins anywhere. */
  for (int k = 0; k < join->c->n_components && !st; k++) {
    int v = join->c->f->n_nodes + k, start = 0;
    if (join->c->task->end_allowed)
      start = join->g.dart[join->g.first[v]];
    else
      while (join->c->component[join->g.tail[start]] != k)
        start++;

    take_pairs(&walker,
               tour == THR_TOUR_FLEURY ? fleury(&walker, start) : hierholzer(&walker, start));
  }
  thr_scratch_free(&walker.own);
  return st;
}

/* Sets where the cords end: at the nodes of task->end_count, or at nodes with an odd number of
 * passes; where a component has no such node, both ends are at the first node that may have them.
 * Closed cords have no ends. */
static void find_ends(const thr_turning_columns *turning_columns, const int *passes, int *ends)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *task = turning_columns->task;

  /* A node with an odd number of passes has an end. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int sum = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += passes[frame->half[i] >> 1];
    ends[v] = task->end_count ? task->end_count[v] : sum % 2;
  }

  /* A component without such a node needs two ends at one node. */
  for (int k = 0; k < turning_columns->n_components && task->end_allowed; k++) {
    int n = 0, first = -1;
    for (int v = frame->n_nodes - 1; v >= 0; v--) {
      if (turning_columns->component[v] != k) continue;
      n += ends[v];
      if (task->end_allowed[v]) first = v;
    }
    if (n == 0 && first >= 0) ends[first] = 2;
  }
}

thr_status thr_baseline_tour(const thr_frame *frame, const thr_least_options *options,
                             thr_tour tour, bool ignore_pairings, const int *passes, thr_least *out,
                             thr_err *err)
{
  thr_least made = {0};
  thr_turning_columns turning_columns = {0};
  thr_join join = {0};
  *out = (thr_least){0};

  if (tour != THR_TOUR_FLEURY && tour != THR_TOUR_HIERHOLZER)
    return thr_fail(err, THR_EINPUT,
                    "the least turning is no classical tour; name fleury or hierholzer");

  if (options->request.cords > 1)
    return thr_fail(err, THR_EINPUT,
                    "the classical tours make one cord per component; leave --cords out");

  /* The structures of the search hold the tour: its task, columns and pairs. */
  int *ends = thr_calloc((size_t)frame->n_nodes, sizeof *ends);
  thr_status st = ends ? thr_least_task(frame, options, &made, err) : thr_nomem(err);
  if (!st) st = thr_turning_columns_init(&turning_columns, frame, &made.task, err);

  /* Walk, and follow the pairs. */
  if (!st) find_ends(&turning_columns, passes, ends);
  if (!st) st = thr_join_init(&join, &turning_columns, passes, made.end_allowed ? ends : NULL, err);
  if (!st) st = walk_all(&join, tour, ignore_pairings, err);
  if (!st) st = thr_least_cords(frame, &join, &made, err);
  if (!st) {
    made.shortest = made.length;
    *out = made;
    made = (thr_least){0};
  }
  thr_least_destroy(&made);
  thr_join_destroy(&join);
  thr_turning_columns_destroy(&turning_columns);
  free(ends);
  return st;
}
