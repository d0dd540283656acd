/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds extra passes and cord ends of least weight under any prices of edges, with which every node
 * is even. The search for the least turning starts from them, and rounds its fractional points with
 * them.
 *
 * In every component this is a minimum T-join (J. Edmonds & E. L. Johnson 1973; lp/tjoin/engine.c):
 * T holds the nodes with an odd number of passes. Each cord end that may be anywhere is a further
 * odd node, a slot, with edges to all nodes where a cord may end, and to the other slots.
 *
 * Example: a path of three edges, one open cord: the two slots join the path's odd end nodes, and
 * no pass is added. */
#include "graph/framework/frame.h"
#include "lp/tjoin/tjoin.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/cords/walk_model.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

double thr_extra_length(const thr_turning_columns *turning_columns, const int *passes)
{
  double sum = 0;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    sum += (passes[e] - turning_columns->cover[e]) * turning_columns->f->length[e];
  return sum;
}

bool thr_passes_allowed(const thr_turning_columns *turning_columns, const int *passes)
{
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    if (passes[e] > turning_columns->most[e]) return false;
  return turning_columns->task->extra_limit < 0 ||
         thr_extra_length(turning_columns, passes) <= turning_columns->task->extra_limit;
}

/* The T-join problem of one component: its edges, then edges from slots to end nodes, then edges
 * between slots. */
typedef struct {
  const thr_turning_columns *columns;
  int component;
  int n_nodes, n_own, n_edges, n_slots; /* n_own: edges of the component */
  int *local, *node; /* [frame nodes] position in the component; [n_nodes] frame node */
  int (*edge)[2];
  int64_t *weight;
  int *what; /* [n_edges] frame edge, or frame node of an end, or -1 */
  bool *odd;
} instance;

/* Releases all arrays. */
static void instance_destroy(instance *join)
{
  free(join->local);
  free(join->node);
  free(join->edge);
  free(join->weight);
  free(join->what);
  free(join->odd);
}

/* Sets up the T-join problem of component k: its nodes, its edges, and slots, one for each cord end
 * that may be anywhere. THR_EINFEASIBLE: ends are needed and allowed nowhere. */
static thr_status instance_init(instance *join, const thr_turning_columns *turning_columns, int k,
                                bool given, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  size_t n = (size_t)frame->n_nodes;
  int allowed = 0;
  *join = (instance){.columns = turning_columns,
                     .component = k,
                     .n_slots = turning_columns->task->end_allowed && !given
                                    ? 2 * turning_columns->task->cords
                                    : 0};
  join->local = thr_calloc(n, sizeof *join->local);
  join->node = thr_calloc(n, sizeof *join->node);
  if (!join->local || !join->node) return thr_nomem(err);

  /* The component's nodes, and how many of them may have ends. */
  for (int v = 0; v < frame->n_nodes; v++) {
    if (turning_columns->component[v] != k) continue;
    allowed += turning_columns->task->end_allowed && turning_columns->task->end_allowed[v];
    join->local[v] = join->n_nodes;
    join->node[join->n_nodes++] = v;
  }

  if (join->n_slots && !allowed)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s has no node where a cord may end; name one with "
                    "--feet (try --feet lowest) or --ends, or use "
                    "--ends closed",
                    frame->name[join->node[0]]);

  /* Edges: those of the component, slots with nodes, slots with slots. */
  for (int e = 0; e < frame->n_edges; e++)
    join->n_own += turning_columns->component[frame->edge[e][0]] == k;

  size_t edges =
      (size_t)join->n_own + (size_t)join->n_slots * ((size_t)allowed + (size_t)join->n_slots);
  if (edges > (1u << 20))
    return thr_fail(err, THR_EINPUT, "too many cords for so many nodes where they may end");
  join->edge = thr_calloc(edges, sizeof *join->edge);
  join->weight = thr_calloc(edges, sizeof *join->weight);
  join->what = thr_calloc(edges, sizeof *join->what);
  join->odd = thr_calloc((size_t)join->n_nodes + (size_t)join->n_slots, sizeof *join->odd);
  return join->edge && join->weight && join->what && join->odd ? THR_OK : thr_nomem(err);
}

/* Appends an edge; `what` is its frame edge, the frame node of an end, or -1. */
static void add_edge(instance *join, int a, int b, int64_t weight, int what)
{
  join->edge[join->n_edges][0] = a;
  join->edge[join->n_edges][1] = b;
  join->weight[join->n_edges] = weight;
  join->what[join->n_edges++] = what;
}

/* Returns the number of passes that the edges at node v need. */
static int covers_at(const thr_turning_columns *turning_columns, int v)
{
  int sum = 0;
  for (int i = turning_columns->f->first[v]; i < turning_columns->f->first[v + 1]; i++)
    sum += turning_columns->cover[turning_columns->f->half[i] >> 1];
  return sum;
}

/* Fills in edges, weights and odd nodes. Weights add up to a power of 2 such that the slots' edges,
 * each more expensive than all others together, stay within what lp/tjoin/tjoin.h takes. */
static void fill(instance *join, const double *weight, const double *end_weight, const int *ends)
{
  const thr_frame *frame = join->columns->f;
  assert(join->edge && join->weight && join->what && join->odd);
  const double whole =
      exp2(fmin(44, floor(50 - log2(2 + 2.0 * join->n_slots * (join->n_nodes + join->n_slots)))));
  double sum = 0, most = 0;

  /* The sum of all weights. */
  int full = 0; /* edges that may have no extra pass: each costs more than all others together */
  for (int e = 0; e < frame->n_edges; e++) {
    if (join->columns->component[frame->edge[e][0]] != join->component) continue;
    full += join->columns->most[e] == join->columns->cover[e];
    if (join->columns->most[e] > join->columns->cover[e]) sum += weight[e];
  }

  /* The scale from weights to integers. */
  const double forbidden = sum > 0 ? 2 * sum : 1;
  sum += full * forbidden;
  const double scale = sum > 0 ? exp2(floor(log2(whole / sum))) : 0; /* powers of 2 keep ties */
  for (int i = 0; end_weight && i < join->n_nodes; i++)
    most = fmax(most, end_weight[join->node[i]]);

  /* The component's own edges, each once. */
  for (int i = 0; i < join->n_nodes; i++)
    for (int k = frame->first[join->node[i]]; k < frame->first[join->node[i] + 1]; k++) {
      int h = frame->half[k];
      if (h % 2 == 0)
        add_edge(join, i, join->local[thr_head(frame, h)],
                 (int64_t)nearbyint((join->columns->most[h >> 1] > join->columns->cover[h >> 1]
                                         ? weight[h >> 1]
                                         : forbidden) *
                                    scale),
                 h >> 1);
    }

  /* A slot is odd: it is joined to a node where an end may be, or to another slot, which stands for
   * a cord whose two ends are at one node. */
  int64_t slot = (int64_t)whole + 1;
  for (int s = 0; s < join->n_slots; s++) {
    for (int i = 0; i < join->n_nodes; i++)
      if (join->columns->task->end_allowed[join->node[i]])
        add_edge(
            join, i, join->n_nodes + s,
            slot + (end_weight && most > 0 ? (int64_t)(end_weight[join->node[i]] / most * 64) : 0),
            join->node[i]);
    for (int t = s + 1; t < join->n_slots; t++)
      add_edge(join, join->n_nodes + s, join->n_nodes + t, 2 * slot, -1);
    join->odd[join->n_nodes + s] = true;
  }

  /* T: nodes whose passes and ends together are odd. */
  for (int i = 0; i < join->n_nodes; i++)
    join->odd[i] =
        (covers_at(join->columns, join->node[i]) + (join->n_slots ? 0 : ends[join->node[i]])) % 2 !=
        0;
}

/* Returns the allowed node of least weight, for a cord whose two ends are at one node. */
static int closing_node(const instance *join, const double *end_weight)
{
  int best = -1;

  for (int i = 0; i < join->n_nodes; i++) {
    int v = join->node[i];
    if (join->columns->task->end_allowed[v] &&
        (best < 0 || (end_weight && end_weight[v] < end_weight[best])))
      best = v;
  }
  return best;
}

/* Computes the minimum T-join; when the limits stop that, a T-join in which every slot has one
 * edge, which the matching's quick join does not ensure. */
static thr_status solve_join(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                             thr_tjoin *tjoin, thr_err *err)
{
  thr_err stopped = {0};
  thr_limits quiet = *limits; /* the join's best and bound are not those of the turning */
  quiet.progress = NULL;
  thr_status st = thr_tjoin_minimum(tjoin_problem, THR_ENGINE_AUTO, &quiet, tjoin, &stopped);

  /* Stopped: a join that uses every slot once. */
  if (st == THR_ELIMIT && tjoin_problem->n_leaves) {
    thr_tjoin_destroy(tjoin);
    st = thr_tjoin_solve(tjoin_problem, &quiet, tjoin, &stopped);
  }
  if (st == THR_ELIMIT) return THR_OK; /* a join is a join */
  return st ? thr_fail(err, st, "%s", stopped.text) : THR_OK;
}

/* Adds the least extra passes of component k to passes, and its ends to ends. */
static thr_status solve_component(const thr_turning_columns *turning_columns, int k,
                                  const double *weight, const double *end_weight, bool given,
                                  const thr_limits *limits, int *passes, int *ends, thr_err *err)
{
  instance join;
  thr_tjoin tjoin = {0};
  thr_status st = instance_init(&join, turning_columns, k, given, err);

  if (!st) {
    fill(&join, weight, end_weight, ends);
    thr_tjoin_problem tjoin_problem = {join.n_nodes + join.n_slots,
                                       join.n_edges,
                                       (const int(*)[2])join.edge,
                                       join.weight,
                                       join.odd,
                                       join.n_slots};
    st = solve_join(&tjoin_problem, limits, &tjoin, err);
  }

  /* Edges of the join are extra passes; edges of slots are ends. */
  for (int i = 0; !st && i < join.n_edges; i++) {
    if (!tjoin.in_join[i]) continue;
    if (i < join.n_own)
      passes[join.what[i]]++;
    else if (join.what[i] >= 0)
      ends[join.what[i]]++;
    else
      ends[closing_node(&join, end_weight)] += 2;
  }

  thr_tjoin_destroy(&tjoin);
  instance_destroy(&join);
  return st;
}

/* ---- ends that the passes hold ---- */

/* Returns the number of passes at node v less the cord ends there. */
static int spare_at(const thr_frame *frame, int v, const int *passes, const int *ends)
{
  int spare = -ends[v];
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    spare += passes[frame->half[i] >> 1];
  return spare;
}

/* Moves ends, two at a time, so that every node stays even, from nodes with more ends than passes
 * to the node with most passes to spare. Returns how many ends no node takes; they are left out. */
static int move_ends(const thr_turning_columns *turning_columns, int k, const int *passes,
                     int *ends)
{
  const thr_frame *frame = turning_columns->f;
  int left_out = 0;

  for (int v = 0; v < frame->n_nodes; v++) {
    if (turning_columns->component[v] != k || !turning_columns->task->end_allowed[v]) continue;
    int over = -spare_at(frame, v, passes, ends);
    for (; over > 0; over -= 2) {
      /* The node that can take two more ends, with most passes to spare. */
      int best = -1, most = 1;
      for (int u = 0; u < frame->n_nodes; u++) {
        if (turning_columns->component[u] != k || !turning_columns->task->end_allowed[u]) continue;
        int spare = spare_at(frame, u, passes, ends);
        if (spare > most) most = spare, best = u;
      }

      ends[v] -= 2;
      if (best >= 0)
        ends[best] += 2;
      else
        left_out += 2;
    }
  }
  return left_out;
}

/* Makes sure that no node has more ends than passes: ends move, or passes are added along the
 * shortest walk between nodes where cords may end. If edges have no passes left for such a walk,
 * the last allowed node gets too many ends, which no pairing holds. */
static thr_status fit_ends(const thr_turning_columns *turning_columns, int k, int *passes,
                           int *ends, thr_err *err)
{
  int left_out = move_ends(turning_columns, k, passes, ends), last = -1;
  if (left_out == 0) return THR_OK;

  /* A walk brings two ends with it. */
  thr_walk_search walk_search;
  thr_status st = thr_walk_search_init(&walk_search, turning_columns, err);
  for (; left_out > 0 && !st; left_out -= 2) {
    thr_walk_search_open(&walk_search, k, passes);
    if (!thr_walk_search_add(&walk_search, passes)) break;
    ends[thr_tail(turning_columns->f, walk_search.half[0])]++;
    ends[thr_head(turning_columns->f, walk_search.half[walk_search.n - 1])]++;
  }

  /* No walk is left for the others. */
  for (int v = 0; v < turning_columns->f->n_nodes && left_out > 0; v++)
    if (turning_columns->component[v] == k && turning_columns->task->end_allowed[v]) last = v;
  if (last >= 0) ends[last] += left_out;
  thr_walk_search_destroy(&walk_search);
  return st;
}

thr_status thr_extra_passes(const thr_turning_columns *turning_columns, const double *weight,
                            const double *end_weight, bool given, const thr_limits *limits,
                            int *passes, int *ends, thr_err *err)
{
  thr_status st = THR_OK;

  for (int e = 0; e < turning_columns->f->n_edges; e++)
    passes[e] = turning_columns->cover[e];

  /* Ends that the task counts, or the caller gives, are not chosen here. */
  const int *count = turning_columns->task->end_count;
  given |= count != NULL;
  for (int v = 0; v < turning_columns->f->n_nodes && (!given || count); v++)
    ends[v] = count ? count[v] : 0;

  for (int k = 0; k < turning_columns->n_components && !st; k++)
    st = solve_component(turning_columns, k, weight, end_weight, given, limits, passes, ends, err);

  /* Ends that are free must not be more than the passes at their nodes. */
  for (int k = 0;
       k < turning_columns->n_components && !st && turning_columns->task->end_allowed && !count;
       k++)
    st = fit_ends(turning_columns, k, passes, ends, err);
  return st;
}

void thr_extra_spread_ends(const thr_turning_columns *turning_columns, int *ends)
{
  const thr_frame *frame = turning_columns->f;
  for (int v = 0; v < frame->n_nodes; v++)
    ends[v] = 0;

  /* One end after the other, component by component. */
  for (int k = 0; k < turning_columns->n_components && turning_columns->task->end_allowed; k++)
    for (int i = 0; i < 2 * turning_columns->task->cords; i++) {
      /* The node with fewest ends; one with an odd number of passes and ends counts one end less.
       */
      int best = -1;
      for (int v = 0; v < frame->n_nodes; v++) {
        int own = covers_at(turning_columns, v) + ends[v];
        if (turning_columns->component[v] != k || !turning_columns->task->end_allowed[v]) continue;

        int than = best < 0 ? 0 : covers_at(turning_columns, best) + ends[best];
        if (best < 0 || ends[v] - own % 2 < ends[best] - than % 2) best = v;
      }
      if (best >= 0) ends[best]++;
    }
}
