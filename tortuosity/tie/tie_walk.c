/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed walks along which one pass more or less over each edge changes the price of tied nodes.
 * Internal to tortuosity/.
 *
 * A walk passes no node twice, so the change is the sum over its nodes of what their two edges
 * change together, which is exact as far as the nodes' prices are. It may go once from the ends at
 * one node to those at another: then an end moves. Of every closed walk that saves, one of the
 * places to start from has only negative sums on the way (S. Lin & B. W. Kernighan, "An effective
 * heuristic algorithm for the traveling-salesman problem", Operations Research 21, 1973): all
 * others are left off. */
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { KNOWN_BITS = 18, DEPTH = 24, TABLE = 40, SPARE = 12 };

static const double saving = -1e-9;

void thr_walker_destroy(thr_walker *w)
{
  thr_knot_destroy(&w->knot);
  free(w->price);
  free(w->known);
  free(w->change);
  free(w->first);
  free(w->seen);
  free(w->reached);
  free(w->label);
  *w = (thr_walker){0};
}

static bool room(const thr_walker *w, int e, int by)
{
  int m = w->passes[e] + by;
  return m >= w->c->cover[e] && m <= w->c->most[e];
}

static bool may_end(const thr_walker *w, int v)
{
  const thr_turning_columns *turning_columns = w->c;
  return !turning_columns->task->end_count &&
         turning_columns->end_column[turning_columns->f->half[turning_columns->f->first[v]]] >= 0;
}

static double weight_of(const thr_walker *w, int e)
{
  return ldexp((double)w->c->weight[w->c->first_extra + e], -THR_TURNING_BITS);
}

/* ---- prices ---- */

static uint64_t mixed(uint64_t z)
{
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  return (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
}

static double price_node(thr_walker *w, int v)
{
  const thr_frame *frame = w->c->f;
  uint64_t name = mixed((uint64_t)v + 1);
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    name = mixed(name + (uint64_t)w->passes[frame->half[i] >> 1]);
  name = mixed(name + (uint64_t)w->ends[v]);
  thr_walk_known *known = &w->known[name >> (64 - KNOWN_BITS)];
  if (known->name != name) {
    thr_knot_tie(&w->knot, v, w->passes, w->ends);
    *known = (thr_walk_known){name, w->knot.turning};
  }
  return known->price;
}

static void forget(thr_walker *w, int v)
{
  int wide = 2 * (thr_degree(w->c->f, v) + 1);
  for (int i = 0; w->first[v] >= 0 && i < wide * wide; i++)
    w->change[w->first[v] + i] = NAN;
}

void thr_walker_reset(thr_walker *w)
{
  const thr_turning_columns *turning_columns = w->c;
  w->total = w->extra = 0;
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    w->total += w->price[v] = price_node(w, v);
    forget(w, v);
  }
  for (int e = 0; e < turning_columns->f->n_edges; e++) {
    w->total += (w->passes[e] - turning_columns->cover[e]) * weight_of(w, e);
    w->extra += (w->passes[e] - turning_columns->cover[e]) * turning_columns->f->length[e];
  }
}

static size_t place_tables(thr_walker *w)
{
  size_t cells = 0;
  for (int v = 0; v < w->c->f->n_nodes; v++) {
    size_t wide = 2 * ((size_t)thr_degree(w->c->f, v) + 1);
    bool keep = wide <= 2 * TABLE && cells < INT32_MAX / 2;
    w->first[v] = keep ? (int)cells : -1;
    cells += keep ? wide * wide : 0;
  }
  return cells;
}

static int most_at_a_node(const thr_walker *w)
{
  const thr_frame *frame = w->c->f;
  int most = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    int n = w->ends[v];
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      n += w->passes[frame->half[i] >> 1];
    if (n > most) most = n;
  }
  return most;
}

thr_status thr_walker_init(thr_walker *w, const thr_turning_columns *turning_columns, int *passes,
                           int *ends, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes,
         steps =
             4 * (size_t)turning_columns->f->n_edges + 2 * (size_t)turning_columns->n_ends + 2 * n;
  *w = (thr_walker){.c = turning_columns, .passes = passes, .ends = ends, .last = -1};
  w->price = thr_calloc(n, sizeof *w->price);
  w->known = thr_calloc((size_t)1 << KNOWN_BITS, sizeof *w->known);
  w->first = thr_calloc(n, sizeof *w->first);
  w->seen = thr_calloc(steps, sizeof *w->seen);
  w->reached = thr_calloc(steps, sizeof *w->reached);
  w->label = thr_calloc(THR_WALK_LABELS, sizeof *w->label);
  bool all = w->price && w->known && w->first && w->seen && w->reached && w->label;
  if (all) all = (w->change = thr_calloc(place_tables(w), sizeof *w->change)) != NULL;
  thr_status st = all ? thr_knot_init(&w->knot, turning_columns, most_at_a_node(w) + SPARE, err)
                      : thr_nomem(err);
  if (st)
    thr_walker_destroy(w);
  else
    thr_walker_reset(w);
  return st;
}

/* ---- steps ---- */

static int first_to_ends(const thr_walker *w)
{
  return 4 * w->c->f->n_edges;
}

static int first_from_ends(const thr_walker *w)
{
  return first_to_ends(w) + 2 * w->c->n_ends;
}

static int sign_of(int step)
{
  return step & 1 ? -1 : 1;
}

/* Node that a step leads to, -1 = to the ends. */
static int node_after(const thr_walker *w, int step)
{
  if (step < first_to_ends(w)) return thr_head(w->c->f, step >> 1);
  return step < first_from_ends(w) ? -1 : (step - first_from_ends(w)) >> 1;
}

/* Place at its node that a step arrives at. */
static int place_after(const thr_walker *w, int step, int v)
{
  return step < first_to_ends(w) ? w->c->position[(step >> 1) ^ 1] : thr_degree(w->c->f, v);
}

static void bump(thr_walker *w, int v, int place, int by)
{
  const thr_frame *frame = w->c->f;
  if (place == thr_degree(frame, v))
    w->ends[v] += by;
  else
    w->passes[frame->half[frame->first[v] + place] >> 1] += by;
}

/* What it changes at node v if the passes (or ends) of two places there change by a and b. */
static double change_at(thr_walker *w, int v, int i, int a, int j, int b)
{
  int wide = 2 * (thr_degree(w->c->f, v) + 1), row = 2 * i + (a < 0), column = 2 * j + (b < 0);
  double *cell = w->first[v] < 0 ? NULL : w->change + w->first[v];
  if (cell && !isnan(cell[row * wide + column])) return cell[row * wide + column];
  bump(w, v, i, a);
  bump(w, v, j, b);
  double change = price_node(w, v) - w->price[v];
  bump(w, v, i, -a);
  bump(w, v, j, -b);
  if (cell) cell[row * wide + column] = cell[column * wide + row] = change;
  return change;
}

static bool passed(const thr_walker *w, int label, int v)
{
  for (; label >= 0; label = w->label[label].before)
    if (node_after(w, w->label[label].step) == v) return true;
  return false;
}

/* One more partial walk, unless one as cheap has come there. */
static void reach(thr_walker *w, int before, int step, double gain, double longer)
{
  bool worse = w->seen[step] == w->searches && w->reached[step] <= gain + 1e-12;
  if (worse || !(gain < w->saved) || w->n_labels == THR_WALK_LABELS) return;
  w->seen[step] = w->searches;
  w->reached[step] = gain;
  w->label[w->n_labels++] =
      (thr_walk_label){gain, longer, step, before, w->label[before].depth + 1};
}

/* ---- the search ---- */

/* At node v, which the walk began at: closes it. */
static void close_walk(thr_walker *w, int l, int v, int place)
{
  const thr_turning_task *task = w->c->task;
  int begin = w->label[0].step;
  double gain = w->label[l].gain + change_at(w, v, place, sign_of(w->label[l].step),
                                             w->c->position[begin >> 1], sign_of(begin));
  if (!(gain < w->saved) ||
      (task->extra_limit >= 0 && w->extra + w->label[l].longer > task->extra_limit))
    return;
  w->saved = gain;
  w->last = l;
}

static void step_from_node(thr_walker *w, int l, int v, int start)
{
  const thr_turning_columns *turning_columns = w->c;
  const thr_frame *frame = turning_columns->f;
  const thr_walk_label from = w->label[l];
  int place = place_after(w, from.step, v), sign = sign_of(from.step), d = thr_degree(frame, v);
  for (int j = 0; j < d; j++) {
    int h = frame->half[frame->first[v] + j], e = h >> 1, to = thr_head(frame, h);
    if (j == place || e == w->label[0].step >> 2 || (to != start && passed(w, l, to))) continue;
    for (int by = 1; by >= -1; by -= 2)
      if (room(w, e, by))
        reach(w, l, 2 * h + (by < 0),
              from.gain + change_at(w, v, place, sign, j, by) + by * weight_of(w, e),
              from.longer + by * frame->length[e]);
  }
  if (place == d || !may_end(w, v)) return;
  for (int q = l; q >= 0; q = w->label[q].before)
    if (node_after(w, w->label[q].step) < 0) return; /* once in a walk */
  for (int by = 1; by >= -1; by -= 2)
    if (w->ends[v] + by >= 0)
      reach(w, l, first_to_ends(w) + 2 * turning_columns->end_group[v] + (by < 0),
            from.gain + change_at(w, v, place, sign, d, by), from.longer);
}

/* An end more at one node is one less at another. Which nodes come first is a matter of turns. */
static void step_from_ends(thr_walker *w, int l, int start)
{
  const thr_turning_columns *turning_columns = w->c;
  const thr_walk_label from = w->label[l];
  int n = turning_columns->f->n_nodes, group = (from.step - first_to_ends(w)) >> 1,
      by = -sign_of(from.step);
  for (int i = 0, v = w->searches % n; i < n; i++, v = v + 1 < n ? v + 1 : 0)
    if (turning_columns->end_group[v] == group && may_end(w, v) && w->ends[v] + by >= 0 &&
        (v == start || !passed(w, l, v)))
      reach(w, l, first_from_ends(w) + 2 * v + (by < 0), from.gain, from.longer);
}

void thr_walker_search(thr_walker *w, int step, double allowed)
{
  int e = step >> 2, start = thr_tail(w->c->f, step >> 1);
  w->n_labels = 0;
  w->searches++;
  w->last = -1;
  w->saved = allowed;
  if (!room(w, e, sign_of(step))) return;
  w->label[w->n_labels++] = (thr_walk_label){sign_of(step) * weight_of(w, e),
                                             sign_of(step) * w->c->f->length[e], step, -1, 0};
  for (int l = 0; l < w->n_labels; l++) {
    int v = node_after(w, w->label[l].step);
    if (v == start)
      close_walk(w, l, v, place_after(w, w->label[l].step, v));
    else if (v < 0)
      step_from_ends(w, l, start);
    else if (w->label[l].depth < DEPTH)
      step_from_node(w, l, v, start);
  }
}

/* ---- changes ---- */

static void reprice(thr_walker *w, int v)
{
  double price = price_node(w, v);
  w->total += price - w->price[v];
  w->price[v] = price;
  forget(w, v);
}

static void change_edge(thr_walker *w, int e, int by)
{
  w->passes[e] += by;
  w->total += by * weight_of(w, e);
  w->extra += by * w->c->f->length[e];
}

void thr_walker_take(thr_walker *w)
{
  for (int l = w->last; l >= 0; l = w->label[l].before) {
    int step = w->label[l].step, by = sign_of(step);
    if (step < first_to_ends(w))
      change_edge(w, step >> 2, by);
    else if (step < first_from_ends(w)) /* the node before loses what this gives to the ends */
      w->ends[node_after(w, w->label[w->label[l].before].step)] += by;
    else
      w->ends[node_after(w, step)] += by;
  }
  for (int l = w->last; l >= 0; l = w->label[l].before) {
    int v = node_after(w, w->label[l].step);
    if (v >= 0) reprice(w, v);
  }
}

bool thr_walker_double(thr_walker *w, int edge, int by)
{
  const thr_turning_columns *turning_columns = w->c;
  const int *node = turning_columns->f->edge[edge];
  if (!room(w, edge, 2 * by)) return false;
  if (turning_columns->task->extra_limit >= 0 &&
      w->extra + 2 * by * turning_columns->f->length[edge] > turning_columns->task->extra_limit)
    return false;
  change_edge(w, edge, 2 * by);
  double change = 2 * by * weight_of(w, edge);
  for (int side = 0; side < 2; side++)
    change += price_node(w, node[side]) - w->price[node[side]];
  if (change < saving) {
    reprice(w, node[0]);
    reprice(w, node[1]);
    return true;
  }
  change_edge(w, edge, -2 * by);
  return false;
}
