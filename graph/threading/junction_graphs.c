/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts the turns of walks at every node, so that a change of turns can be tried while it is still
 * open which cord takes which passes.
 *
 * The turns at a node are the edges of its junction graph (graph/plan/plan_measures.h), whose nodes
 * are the half-edges there. A change is allowed if the junction graphs that it touches stay
 * connected, which ties the nodes, and have no turn back.
 *
 * Example: a node with three edges and the turns ab, bc is tied; without bc it is not. */
#include "graph/threading/threading.h"

#include <stdlib.h>
#include <string.h>

void thr_junction_graphs_destroy(thr_junction_graphs *graphs)
{
  free(graphs->first);
  free(graphs->place);
  free(graphs->count);
  free(graphs->queue);
  free(graphs->seen);
  *graphs = (thr_junction_graphs){0};
}

/* Counts a turn up or down, in both orders of its half-edges. */
static void count_turn(thr_junction_graphs *graphs, int in, int out, int by)
{
  int v = thr_tail(graphs->f, out);
  size_t degree = (size_t)thr_degree(graphs->f, v), a = (size_t)graphs->place[in ^ 1],
         b = (size_t)graphs->place[out];

  graphs->count[graphs->first[v] + a * degree + b] += by;
  if (a != b) graphs->count[graphs->first[v] + b * degree + a] += by;
}

/* Counts the turns of all walks, with those that close cyclic ones. */
static void count_walks(thr_junction_graphs *graphs, const thr_walks *walks)
{
  for (int i = 0; i < walks->n_walks; i++) {
    const thr_walk *walk = &walks->walk[i];
    for (int k = walk->cyclic ? 0 : 1; k < walk->n; k++)
      count_turn(graphs, walk->half[k ? k - 1 : walk->n - 1], walk->half[k], 1);
  }
}

thr_status thr_junction_graphs_init(thr_junction_graphs *graphs, const thr_frame *frame,
                                    const thr_walks *walks, thr_err *err)
{
  size_t sum = 0;
  int most = 1;
  *graphs =
      (thr_junction_graphs){.f = frame,
                            .first = thr_calloc((size_t)frame->n_nodes, sizeof *graphs->first),
                            .place = thr_calloc(2 * (size_t)frame->n_edges, sizeof *graphs->place)};

  /* Places of the half-edges, and where the counts of each node begin. */
  for (int v = 0; v < frame->n_nodes && graphs->first && graphs->place; v++) {
    int degree = thr_degree(frame, v);
    graphs->first[v] = sum;
    sum += (size_t)degree * (size_t)degree;
    if (degree > most) most = degree;
    for (int i = 0; i < degree; i++)
      graphs->place[frame->half[frame->first[v] + i]] = i;
  }

  graphs->count = thr_calloc(sum, sizeof *graphs->count);
  graphs->queue = thr_calloc((size_t)most, sizeof *graphs->queue);
  graphs->seen = thr_calloc((size_t)most, sizeof *graphs->seen);
  if (!graphs->first || !graphs->place || !graphs->count || !graphs->queue || !graphs->seen) {
    thr_junction_graphs_destroy(graphs);
    return thr_nomem(err);
  }

  count_walks(graphs, walks);
  return THR_OK;
}

/* Returns how many half-edges at node v are connected with the first one, by breadth-first search;
 * -1 if something turns back. */
static int reached(thr_junction_graphs *graphs, int v)
{
  int degree = thr_degree(graphs->f, v), n = 1;
  const int *count = graphs->count + graphs->first[v];

  memset(graphs->seen, 0, (size_t)degree * sizeof *graphs->seen);
  graphs->queue[0] = 0;
  graphs->seen[0] = true;

  /* The queue holds what is reached; a turn back is on the diagonal. */
  for (int at = 0; at < n; at++) {
    const int *row = count + (size_t)graphs->queue[at] * (size_t)degree;
    if (row[graphs->queue[at]] > 0) return -1;
    for (int b = 0; b < degree; b++)
      if (row[b] > 0 && !graphs->seen[b]) {
        graphs->seen[b] = true;
        graphs->queue[n++] = b;
      }
  }
  return n;
}

void thr_turn_change_note(thr_turn_change *change, int in, int out, int by)
{
  if (in < 0 || out < 0) return;
  change->turn[change->n].in = in;
  change->turn[change->n].out = out;
  change->turn[change->n++].by = by;
}

void thr_junction_graphs_make(thr_junction_graphs *graphs, const thr_turn_change *change)
{
  for (int i = 0; i < change->n; i++)
    count_turn(graphs, change->turn[i].in, change->turn[i].out, change->turn[i].by);
}

bool thr_junction_graphs_allow(thr_junction_graphs *graphs, const thr_turn_change *change)
{
  bool allowed = true;
  for (int i = 0; i < change->n && allowed; i++)
    allowed = change->turn[i].by < 0 || change->turn[i].in != (change->turn[i].out ^ 1);
  if (!allowed) return false;

  /* Make the change, look at all its nodes, and take it back. */
  thr_junction_graphs_make(graphs, change);

  for (int i = 0; i < change->n && allowed; i++) {
    int v = thr_tail(graphs->f, change->turn[i].out);
    allowed = reached(graphs, v) == thr_degree(graphs->f, v);
  }

  for (int i = 0; i < change->n; i++)
    count_turn(graphs, change->turn[i].in, change->turn[i].out, -change->turn[i].by);
  return allowed;
}
