/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Extra passes and ends of least weight under any prices of edges: where the search for the least
 * turning starts, and how its points are rounded. A minimum T-join (lp/tjoin/engine.c) with slots
 * for the ends. */
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
  const thr_turning_columns *c;
  int k, n_nodes, n_own, n_edges, n_slots;
  int *local, *node; /* [frame nodes] position in the component; [n_nodes] frame node */
  int (*edge)[2];
  int64_t *weight;
  int *what; /* [n_edges] frame edge, or frame node of an end, or -1 */
  bool *odd;
} instance;

static void instance_destroy(instance *in)
{
  free(in->local);
  free(in->node);
  free(in->edge);
  free(in->weight);
  free(in->what);
  free(in->odd);
}

/* Sets up the T-join problem of component k: its nodes, its edges, and slots, one for each cord end
 * that may be anywhere. THR_EINFEASIBLE: ends are needed and allowed nowhere. */
static thr_status instance_init(instance *in, const thr_turning_columns *turning_columns, int k,
                                bool given, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  size_t n = (size_t)frame->n_nodes;
  int allowed = 0;
  *in = (instance){.c = turning_columns,
                   .k = k,
                   .n_slots = turning_columns->task->end_allowed && !given
                                  ? 2 * turning_columns->task->cords
                                  : 0};
  in->local = thr_calloc(n, sizeof *in->local);
  in->node = thr_calloc(n, sizeof *in->node);
  if (!in->local || !in->node) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    if (turning_columns->component[v] != k) continue;
    allowed += turning_columns->task->end_allowed && turning_columns->task->end_allowed[v];
    in->local[v] = in->n_nodes;
    in->node[in->n_nodes++] = v;
  }

  if (in->n_slots && !allowed)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s has no node where a cord may end; name one with "
                    "--feet (try --feet lowest) or --ends, or use "
                    "--ends closed",
                    frame->name[in->node[0]]);
  for (int e = 0; e < frame->n_edges; e++)
    in->n_own += turning_columns->component[frame->edge[e][0]] == k;
  size_t edges = (size_t)in->n_own + (size_t)in->n_slots * ((size_t)allowed + (size_t)in->n_slots);
  if (edges > (1u << 20))
    return thr_fail(err, THR_EINPUT, "too many cords for so many nodes where they may end");
  in->edge = thr_calloc(edges, sizeof *in->edge);
  in->weight = thr_calloc(edges, sizeof *in->weight);
  in->what = thr_calloc(edges, sizeof *in->what);
  in->odd = thr_calloc((size_t)in->n_nodes + (size_t)in->n_slots, sizeof *in->odd);
  return in->edge && in->weight && in->what && in->odd ? THR_OK : thr_nomem(err);
}

static void add_edge(instance *in, int a, int b, int64_t weight, int what)
{
  in->edge[in->n_edges][0] = a;
  in->edge[in->n_edges][1] = b;
  in->weight[in->n_edges] = weight;
  in->what[in->n_edges++] = what;
}

/* Passes that the edges at node v need. */
static int covers_at(const thr_turning_columns *turning_columns, int v)
{
  int sum = 0;
  for (int i = turning_columns->f->first[v]; i < turning_columns->f->first[v + 1]; i++)
    sum += turning_columns->cover[turning_columns->f->half[i] >> 1];
  return sum;
}

/* Fills in edges, weights and odd nodes. Weights add up to a power of 2 such that the slots' edges,
 * each more expensive than all others together, stay within what lp/tjoin/tjoin.h takes. */
static void fill(instance *in, const double *weight, const double *end_weight, const int *ends)
{
  const thr_frame *frame = in->c->f;
  assert(in->edge && in->weight && in->what && in->odd);
  const double whole =
      exp2(fmin(44, floor(50 - log2(2 + 2.0 * in->n_slots * (in->n_nodes + in->n_slots)))));
  double sum = 0, most = 0;
  int full = 0; /* edges with no room for an extra pass: each dearer than all others together */
  for (int e = 0; e < frame->n_edges; e++) {
    if (in->c->component[frame->edge[e][0]] != in->k) continue;
    full += in->c->most[e] == in->c->cover[e];
    if (in->c->most[e] > in->c->cover[e]) sum += weight[e];
  }

  /* The scale from weights to integers. */
  const double dear = sum > 0 ? 2 * sum : 1;
  sum += full * dear;
  const double scale = sum > 0 ? exp2(floor(log2(whole / sum))) : 0; /* powers of 2 keep ties */
  for (int i = 0; end_weight && i < in->n_nodes; i++)
    most = fmax(most, end_weight[in->node[i]]);

  /* The component's own edges, each once. */
  for (int i = 0; i < in->n_nodes; i++)
    for (int k = frame->first[in->node[i]]; k < frame->first[in->node[i] + 1]; k++) {
      int h = frame->half[k];
      if (h % 2 == 0)
        add_edge(in, i, in->local[thr_head(frame, h)],
                 (int64_t)nearbyint(
                     (in->c->most[h >> 1] > in->c->cover[h >> 1] ? weight[h >> 1] : dear) * scale),
                 h >> 1);
    }

  /* A slot is odd: it is joined to a node where an end may be, or to another slot, which stands for
   * a cord whose two ends are at one node. */
  int64_t slot = (int64_t)whole + 1;
  for (int s = 0; s < in->n_slots; s++) {
    for (int i = 0; i < in->n_nodes; i++)
      if (in->c->task->end_allowed[in->node[i]])
        add_edge(in, i, in->n_nodes + s,
                 slot +
                     (end_weight && most > 0 ? (int64_t)(end_weight[in->node[i]] / most * 64) : 0),
                 in->node[i]);
    for (int t = s + 1; t < in->n_slots; t++)
      add_edge(in, in->n_nodes + s, in->n_nodes + t, 2 * slot, -1);
    in->odd[in->n_nodes + s] = true;
  }
  for (int i = 0; i < in->n_nodes; i++)
    in->odd[i] = (covers_at(in->c, in->node[i]) + (in->n_slots ? 0 : ends[in->node[i]])) % 2 != 0;
}

/* Returns the allowed node of least weight, for a cord whose two ends are at one node. */
static int closing_node(const instance *in, const double *end_weight)
{
  int best = -1;
  for (int i = 0; i < in->n_nodes; i++) {
    int v = in->node[i];
    if (in->c->task->end_allowed[v] &&
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
  instance in;
  thr_tjoin tjoin = {0};
  thr_status st = instance_init(&in, turning_columns, k, given, err);
  if (!st) {
    fill(&in, weight, end_weight, ends);
    thr_tjoin_problem tjoin_problem = {in.n_nodes + in.n_slots,
                                       in.n_edges,
                                       (const int(*)[2])in.edge,
                                       in.weight,
                                       in.odd,
                                       in.n_slots};
    st = solve_join(&tjoin_problem, limits, &tjoin, err);
  }

  /* Edges of the join are extra passes; edges of slots are ends. */
  for (int i = 0; !st && i < in.n_edges; i++) {
    if (!tjoin.in_join[i]) continue;
    if (i < in.n_own)
      passes[in.what[i]]++;
    else if (in.what[i] >= 0)
      ends[in.what[i]]++;
    else
      ends[closing_node(&in, end_weight)] += 2;
  }
  thr_tjoin_destroy(&tjoin);
  instance_destroy(&in);
  return st;
}

/* ---- ends that the passes hold ---- */

/* Returns the number of passes at node v less the cord ends there. */
static int room_at(const thr_frame *frame, int v, const int *passes, const int *ends)
{
  int room = -ends[v];
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    room += passes[frame->half[i] >> 1];
  return room;
}

/* Moves ends, two at a time, so that every node stays even, from nodes with more ends than passes
 * to the node with most passes to spare. Returns how many ends no node takes; they are left out. */
static int move_ends(const thr_turning_columns *turning_columns, int k, const int *passes,
                     int *ends)
{
  const thr_frame *frame = turning_columns->f;
  int homeless = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    if (turning_columns->component[v] != k || !turning_columns->task->end_allowed[v]) continue;
    int over = -room_at(frame, v, passes, ends);
    for (; over > 0; over -= 2) {
      /* The node that can take two more ends, with most passes to spare. */
      int best = -1, most = 1;
      for (int u = 0; u < frame->n_nodes; u++) {
        if (turning_columns->component[u] != k || !turning_columns->task->end_allowed[u]) continue;
        int room = room_at(frame, u, passes, ends);
        if (room > most) most = room, best = u;
      }
      ends[v] -= 2;
      if (best >= 0)
        ends[best] += 2;
      else
        homeless += 2;
    }
  }
  return homeless;
}

/* Makes sure that no node has more ends than passes: ends move, or passes are added along the
 * shortest walk between nodes where cords may end. If edges have no passes left for such a walk,
 * the last allowed node gets too many ends, which no pairing holds. */
static thr_status fit_ends(const thr_turning_columns *turning_columns, int k, int *passes,
                           int *ends, thr_err *err)
{
  int homeless = move_ends(turning_columns, k, passes, ends), last = -1;
  if (homeless == 0) return THR_OK;
  thr_walk_search walk_search;
  thr_status st = thr_walk_search_init(&walk_search, turning_columns, err);
  for (; homeless > 0 && !st; homeless -= 2) {
    thr_walk_search_open(&walk_search, k, passes);
    if (!thr_walk_search_add(&walk_search, passes)) break;
    ends[thr_tail(turning_columns->f, walk_search.half[0])]++;
    ends[thr_head(turning_columns->f, walk_search.half[walk_search.n - 1])]++;
  }

  /* No walk is left. */
  for (int v = 0; v < turning_columns->f->n_nodes && homeless > 0; v++)
    if (turning_columns->component[v] == k && turning_columns->task->end_allowed[v]) last = v;
  if (last >= 0) ends[last] += homeless;
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
  const int *count = turning_columns->task->end_count;
  given |= count != NULL;
  for (int v = 0; v < turning_columns->f->n_nodes && (!given || count); v++)
    ends[v] = count ? count[v] : 0;
  for (int k = 0; k < turning_columns->n_components && !st; k++)
    st = solve_component(turning_columns, k, weight, end_weight, given, limits, passes, ends, err);
  for (int k = 0;
       k < turning_columns->n_components && !st && turning_columns->task->end_allowed && !count;
       k++)
    st = fit_ends(turning_columns, k, passes, ends, err);
  return st;
}

/* An end is placed where the fewest are, nodes with an odd number of passes and ends first. */
void thr_extra_spread_ends(const thr_turning_columns *turning_columns, int *ends)
{
  const thr_frame *frame = turning_columns->f;
  for (int v = 0; v < frame->n_nodes; v++)
    ends[v] = 0;
  for (int k = 0; k < turning_columns->n_components && turning_columns->task->end_allowed; k++)
    for (int i = 0; i < 2 * turning_columns->task->cords; i++) {
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
