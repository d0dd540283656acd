/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Removes trails between two folds: gives every trail a direction, with all folds at beginnings.
 *
 * Where every cord is open, the trail of a fold has to end in a cord end. The network's nodes are
 * the two sides of every dart type, that of the copies and that of the turns; its edges are the
 * orbits of copies, of turns and of darts (which lead from one side to the other), the folds (from
 * a source) and the cord ends (to a sink). If each fold has a path of its own to a cord end (a
 * maximum flow, L. Ford & D. Fulkerson 1956), what is left over is even at every node and falls
 * into circuits. At a type then as many copies arrive as turns lead away, so that they can be
 * matched.
 *
 * Example: one trail from fold to fold and one from end to end that share a dart type exchange what
 * follows there, and become two trails from a fold to an end. */
#include "graph/framework/frame.h"
#include "graph/arrays.h"
#include "graph/status.h"
#include "symmetry/lift/lift.h"

#include <math.h>
#include <string.h>

typedef struct {
  int end[2]; /* nodes */
  int to;     /* 0 or 1: directed towards that end; -1: not directed */
} arc;

/* Arcs: `o` is orbit o's own from side to side, n_orbits + o that of its copy, 2 * n_orbits + o
 * that of its turn. Those of a copy or turn of two orbits stand with the lower one; the other place
 * is empty (a loop at the sink). */
typedef struct {
  const thr_strands *strands;
  int source, sink, n_nodes, n_arcs;
  arc *arc;
  int *first, *list;   /* arcs at node v: list[first[v] .. first[v + 1] - 1]; loops twice */
  int *next, *waiting; /* [n_nodes] scratch */
  thr_scratch own;     /* the arrays */
} trail_network;

/* Makes the arcs of all orbits, without directions. */
static void make_arcs(trail_network *network)
{
  const thr_strands *strands = network->strands;
  for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
    int copies = 2 * strands->type[orbit], turns = copies + 1, other = strands->other[orbit],
        partner = strands->partner[orbit];
    const arc none = {{network->sink, network->sink}, -1};

    /* The orbit's own; its copy, which comes from the source if it is a fold; its turn or its end.
     */
    network->arc[orbit] = (arc){{copies, turns}, -1};
    network->arc[strands->n_orbits + orbit] =
        other < orbit
            ? none
            : (arc){{other == orbit ? network->source : copies, 2 * strands->type[other]}, -1};
    arc turn = none;
    if (partner < 0) turn = (arc){{turns, network->sink}, -1};
    if (partner == orbit) turn = (arc){{network->source, turns}, -1};
    if (partner > orbit) turn = (arc){{turns, 2 * strands->type[partner] + 1}, -1};
    network->arc[2 * strands->n_orbits + orbit] = turn;
  }
}

/* Initializes the network; the caller frees network->own also on failure. */
static thr_status network_init(trail_network *network, const thr_strands *strands, thr_err *err)
{
  *network = (trail_network){.strands = strands,
                             .source = 2 * strands->q->n_darts,
                             .sink = 2 * strands->q->n_darts + 1,
                             .n_arcs = 3 * strands->n_orbits};
  network->n_nodes = network->sink + 1;

  size_t n = (size_t)network->n_nodes, m = (size_t)network->n_arcs;
  network->arc = thr_scratch_array(&network->own, m, sizeof *network->arc);
  network->first = thr_scratch_array(&network->own, n + 2, sizeof *network->first);
  network->list = thr_scratch_array(&network->own, 2 * m, sizeof *network->list);
  network->next = thr_scratch_array(&network->own, n, sizeof *network->next);
  network->waiting = thr_scratch_array(&network->own, n, sizeof *network->waiting);
  thr_status st = thr_scratch_check(&network->own, err);
  if (st) return st;

  make_arcs(network);

  /* Arcs by node: count, two places further on, and fill. */
  for (int i = 0; i < 2 * network->n_arcs; i++)
    network->first[network->arc[i / 2].end[i % 2] + 2]++;
  for (int v = 0; v < network->n_nodes; v++)
    network->first[v + 2] += network->first[v + 1];
  for (int i = 0; i < 2 * network->n_arcs; i++)
    network->list[network->first[network->arc[i / 2].end[i % 2] + 1]++] = i / 2;

  return THR_OK;
}

/* Returns which end of an arc is not this node; the node's own for a loop. */
static int far_end(const arc *of, int node)
{
  return of->end[0] == node;
}

/* Directs the arcs that a maximum flow of at most 1 on every arc leads along. */
static thr_status direct_flow(trail_network *network, thr_err *err)
{
  thr_scratch own = {0};
  size_t n = (size_t)network->n_nodes, m = (size_t)network->n_arcs;
  int(*edge)[2] = thr_scratch_array(&own, m, sizeof *edge);
  double *capacity = thr_scratch_array(&own, m, sizeof *capacity),
         *flow = thr_scratch_array(&own, m, sizeof *flow);
  bool *side = thr_scratch_array(&own, n, sizeof *side);
  thr_status st = thr_scratch_check(&own, err);

  for (int i = 0; i < network->n_arcs && !st; i++) {
    memcpy(edge[i], network->arc[i].end, sizeof edge[i]);
    capacity[i] = 1;
  }
  if (!st)
    st = thr_maximum_flow(network->n_nodes, network->n_arcs, (const int(*)[2])edge, capacity,
                          network->source, network->sink, flow, side, err);
  for (int i = 0; i < network->n_arcs && !st; i++)
    if (edge[i][0] != edge[i][1] && fabs(flow[i]) > 0.5) network->arc[i].to = flow[i] > 0;

  thr_scratch_free(&own);
  return st;
}

/* Directs all arcs that are left: from any node along arcs without direction until there is none,
 * which is at the node where the walk began, as numbers are even. */
static void direct_circuits(trail_network *network)
{
  int *next = network->next;
  memcpy(next, network->first, (size_t)network->n_nodes * sizeof *next);
  for (int start = 0; start < network->n_nodes; start++)
    for (int node = start; next[node] < network->first[node + 1];) {
      arc *next_arc = &network->arc[network->list[next[node]++]];
      if (next_arc->to >= 0) continue;
      next_arc->to = far_end(next_arc, node);
      node = next_arc->end[next_arc->to];
    }
}

/* Tells whether the trail comes over the copy to this orbit's darts. */
static bool arrives(const trail_network *network, int orbit)
{
  int n_orbits = network->strands->n_orbits, other = network->strands->other[orbit];
  return other > orbit ? network->arc[n_orbits + orbit].to == 0
                       : network->arc[n_orbits + other].to == 1;
}

/* Tells whether the trail leads away from this orbit's place in its turn, or ends there. */
static bool leads_away(const trail_network *network, int orbit)
{
  int n_orbits = network->strands->n_orbits, partner = network->strands->partner[orbit];
  return partner >= 0 && partner <= orbit ? network->arc[2 * n_orbits + partner].to == 0
                                          : network->arc[2 * n_orbits + orbit].to == 1;
}

/* Makes every trail go on in its direction: orbits that arrive where their turn arrives, too,
 * change places with orbits of their type where both lead away. waiting: the first orbit of a type
 * that has no such partner yet; next: [n_orbits] the one after it. */
static void match_places(const trail_network *network, thr_strands *strands, int *wrong, int *next)
{
  int *waiting = network->waiting;

  /* List the orbits where both arrive. */
  for (int type = 0; type < strands->q->n_darts; type++)
    waiting[type] = -1;
  for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
    wrong[orbit] = arrives(network, orbit) - leads_away(network, orbit);
    if (wrong[orbit] <= 0) continue;
    next[orbit] = waiting[strands->type[orbit]];
    waiting[strands->type[orbit]] = orbit;
  }

  /* Exchange each where both lead away with one of them. */
  for (int orbit = 0; orbit < strands->n_orbits; orbit++) {
    int other = waiting[strands->type[orbit]];
    if (wrong[orbit] >= 0 || other < 0) continue;
    waiting[strands->type[orbit]] = next[other];
    thr_strands_exchange(strands, orbit, other);
  }
}

/* Directs all trails. THR_ESOLVER: a fold has no path to an end. */
static thr_status direct_trails(trail_network *network, thr_err *err)
{
  thr_status st = direct_flow(network, err);
  if (st) return st;

  /* Every arc from the source must be in it. */
  for (int i = network->first[network->source]; i < network->first[network->source + 1]; i++) {
    int arc_index = network->list[i], orbit = arc_index % network->strands->n_orbits;
    if (network->arc[arc_index].to < 0)
      return thr_fail(
          err, THR_ESOLVER,
          "the cords over edge %d and its images would be closed, where ends are asked for",
          network->strands->q->dart[network->strands->type[orbit]].half >> 1);
  }

  direct_circuits(network);
  return THR_OK;
}

thr_status thr_strands_open(thr_strands *strands, thr_err *err)
{
  trail_network network;
  thr_status st = network_init(&network, strands, err);
  int *wrong = thr_scratch_array(&network.own, (size_t)strands->n_orbits, sizeof *wrong),
      *next = thr_scratch_array(&network.own, (size_t)strands->n_orbits, sizeof *next);
  if (!st) st = thr_scratch_check(&network.own, err);

  if (!st) st = direct_trails(&network, err);
  if (!st) match_places(&network, strands, wrong, next);

  thr_scratch_free(&network.own);
  return st;
}
