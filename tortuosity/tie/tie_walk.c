/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Searches closed walks along which one pass more or less over each edge lowers the price of
 * turning at tied nodes. Internal to tortuosity/.
 *
 * A walk passes no node twice, so the change is the sum over its nodes of what their two edges
 * change together, which is exact as far as the nodes' prices are. A walk may go once from the ends
 * at one node to those at another: then an end moves. Every closed walk that saves can be started
 * at a place from which all partial sums are negative (S. Lin & B. W. Kernighan, "An effective
 * heuristic algorithm for the traveling-salesman problem", Operations Research 21, 1973), so
 * partial walks that do not save are dropped.
 *
 * Example: a triangle whose edges ab and ac lose a pass and whose edge bc gains one is a closed
 * walk of three steps. */
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>

enum { KNOWN_BITS = 18, DEPTH = 24, TABLE = 40, SPARE = 12 };

static const double saving = -1e-9;

void thr_walker_destroy(thr_walker *walker)
{
  thr_knot_destroy(&walker->knot);
  free(walker->price);
  free(walker->known);
  free(walker->change);
  free(walker->first);
  free(walker->seen);
  free(walker->reached);
  free(walker->label);
  *walker = (thr_walker){0};
}

/* Returns whether an edge may have `by` more passes. */
static bool room(const thr_walker *walker, int e, int by)
{
  int m = walker->passes[e] + by;
  return m >= walker->c->cover[e] && m <= walker->c->most[e];
}

/* Returns whether ends may move to or from node v. */
static bool may_end(const thr_walker *walker, int v)
{
  const thr_turning_columns *turning_columns = walker->c;
  return !turning_columns->task->end_count &&
         turning_columns->end_column[turning_columns->f->half[turning_columns->f->first[v]]] >= 0;
}

/* Returns the price of a pass beyond the cover. */
static double weight_of(const thr_walker *walker, int e)
{
  return ldexp((double)walker->c->weight[walker->c->first_extra + e], -THR_TURNING_BITS);
}

/* ---- prices ---- */

/* Returns a hash of a number. */
static uint64_t mixed(uint64_t z)
{
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  return (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
}

/* Returns the price of the turns that tie node v with the passes and ends as they are now. Prices
 * are kept in a table by a hash of node, passes and ends; a hash of 64 bits is taken to name them
 * uniquely. */
static double price_node(thr_walker *walker, int v)
{
  const thr_frame *frame = walker->c->f;
  uint64_t name = mixed((uint64_t)v + 1);
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    name = mixed(name + (uint64_t)walker->passes[frame->half[i] >> 1]);

  name = mixed(name + (uint64_t)walker->ends[v]);
  thr_walk_known *known = &walker->known[name >> (64 - KNOWN_BITS)];

  if (known->name != name) {
    thr_knot_tie(&walker->knot, v, walker->passes, walker->ends);
    *known = (thr_walk_known){name, walker->knot.turning};
  }
  return known->price;
}

/* Forgets what steps at node v change. */
static void forget(thr_walker *walker, int v)
{
  int wide = 2 * (thr_degree(walker->c->f, v) + 1);
  for (int i = 0; walker->first[v] >= 0 && i < wide * wide; i++)
    walker->change[walker->first[v] + i] = NAN;
}

void thr_walker_reset(thr_walker *walker)
{
  const thr_turning_columns *turning_columns = walker->c;
  walker->total = walker->extra = 0;

  /* Prices of the nodes, by the passes as they are. */
  for (int v = 0; v < turning_columns->f->n_nodes; v++) {
    walker->total += walker->price[v] = price_node(walker, v);
    forget(walker, v);
  }

  /* Prices and lengths of the extra passes. */
  for (int e = 0; e < turning_columns->f->n_edges; e++) {
    walker->total += (walker->passes[e] - turning_columns->cover[e]) * weight_of(walker, e);
    walker->extra +=
        (walker->passes[e] - turning_columns->cover[e]) * turning_columns->f->length[e];
  }
}

/* Divides the table of changes among the nodes with few enough edges, and returns its size. */
static size_t place_tables(thr_walker *walker)
{
  size_t cells = 0;
  for (int v = 0; v < walker->c->f->n_nodes; v++) {
    size_t wide = 2 * ((size_t)thr_degree(walker->c->f, v) + 1);
    bool keep = wide <= 2 * TABLE && cells < INT32_MAX / 2;
    walker->first[v] = keep ? (int)cells : -1;
    cells += keep ? wide * wide : 0;
  }
  return cells;
}

/* Returns the largest number of passes and ends at a node. */
static int most_at_a_node(const thr_walker *walker)
{
  const thr_frame *frame = walker->c->f;
  int most = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    int n = walker->ends[v];
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      n += walker->passes[frame->half[i] >> 1];
    if (n > most) most = n;
  }
  return most;
}

thr_status thr_walker_init(thr_walker *walker, const thr_turning_columns *turning_columns,
                           int *passes, int *ends, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes,
         steps =
             4 * (size_t)turning_columns->f->n_edges + 2 * (size_t)turning_columns->n_ends + 2 * n;

  *walker = (thr_walker){.c = turning_columns, .passes = passes, .ends = ends, .last = -1};

  walker->price = thr_calloc(n, sizeof *walker->price);
  walker->known = thr_calloc((size_t)1 << KNOWN_BITS, sizeof *walker->known);
  walker->first = thr_calloc(n, sizeof *walker->first);
  walker->seen = thr_calloc(steps, sizeof *walker->seen);
  walker->reached = thr_calloc(steps, sizeof *walker->reached);
  walker->label = thr_calloc(THR_WALK_LABELS, sizeof *walker->label);

  /* The table of changes is allocated last, as its size follows from first. */
  bool all = walker->price && walker->known && walker->first && walker->seen && walker->reached &&
             walker->label;
  if (all)
    all = (walker->change = thr_calloc(place_tables(walker), sizeof *walker->change)) != NULL;

  thr_status st =
      all ? thr_knot_init(&walker->knot, turning_columns, most_at_a_node(walker) + SPARE, err)
          : thr_nomem(err);
  if (st)
    thr_walker_destroy(walker);
  else
    thr_walker_reset(walker);
  return st;
}

/* ---- steps ---- */

/* Return the first steps to the ends and from there: steps are numbered as thr_walk_label says. */
static int first_to_ends(const thr_walker *walker)
{
  return 4 * walker->c->f->n_edges;
}

static int first_from_ends(const thr_walker *walker)
{
  return first_to_ends(walker) + 2 * walker->c->n_ends;
}

/* Returns how a step changes the number of passes. */
static int sign_of(int step)
{
  return step & 1 ? -1 : 1;
}

/* Returns the node that a step leads to; -1 = to the ends. */
static int node_after(const thr_walker *walker, int step)
{
  if (step < first_to_ends(walker)) return thr_head(walker->c->f, step >> 1);
  return step < first_from_ends(walker) ? -1 : (step - first_from_ends(walker)) >> 1;
}

/* Returns the place at its node that a step arrives at. */
static int place_after(const thr_walker *walker, int step, int v)
{
  return step < first_to_ends(walker) ? walker->c->position[(step >> 1) ^ 1]
                                      : thr_degree(walker->c->f, v);
}

/* Changes the passes, or the ends, of a place at node v. */
static void bump(thr_walker *walker, int v, int place, int by)
{
  const thr_frame *frame = walker->c->f;
  if (place == thr_degree(frame, v))
    walker->ends[v] += by;
  else
    walker->passes[frame->half[frame->first[v] + place] >> 1] += by;
}

/* Returns by how much the price of node v changes if the passes (or ends) of places i and j there
 * change by a and b. */
static double change_at(thr_walker *walker, int v, int i, int a, int j, int b)
{
  int wide = 2 * (thr_degree(walker->c->f, v) + 1), row = 2 * i + (a < 0), column = 2 * j + (b < 0);
  double *cell = walker->first[v] < 0 ? NULL : walker->change + walker->first[v];
  if (cell && !isnan(cell[row * wide + column])) return cell[row * wide + column];

  /* Try both changes, price the node, and take them back. */
  bump(walker, v, i, a);
  bump(walker, v, j, b);
  double change = price_node(walker, v) - walker->price[v];
  bump(walker, v, i, -a);
  bump(walker, v, j, -b);

  if (cell) cell[row * wide + column] = cell[column * wide + row] = change;
  return change;
}

/* Returns whether a partial walk has been at node v. */
static bool passed(const thr_walker *walker, int label, int v)
{
  for (; label >= 0; label = walker->label[label].before)
    if (node_after(walker, walker->label[label].step) == v) return true;
  return false;
}

/* Adds one more partial walk, unless one as cheap has come there. */
static void reach(thr_walker *walker, int before, int step, double gain, double longer)
{
  bool worse = walker->seen[step] == walker->searches && walker->reached[step] <= gain + 1e-12;
  if (worse || !(gain < walker->saved) || walker->n_labels == THR_WALK_LABELS) return;

  walker->seen[step] = walker->searches;
  walker->reached[step] = gain;
  walker->label[walker->n_labels++] =
      (thr_walk_label){gain, longer, step, before, walker->label[before].depth + 1};
}

/* ---- the search ---- */

/* Closes a partial walk at node v, where it began, and keeps it if it is the cheapest so far. */
static void close_walk(thr_walker *walker, int label, int v, int place)
{
  const thr_turning_task *task = walker->c->task;
  int begin = walker->label[0].step;
  double gain =
      walker->label[label].gain + change_at(walker, v, place, sign_of(walker->label[label].step),
                                            walker->c->position[begin >> 1], sign_of(begin));

  /* It must save more than the best so far, within the limit on the length. */
  if (!(gain < walker->saved) ||
      (task->extra_limit >= 0 && walker->extra + walker->label[label].longer > task->extra_limit))
    return;

  walker->saved = gain;
  walker->last = label;
}

/* Continues a partial walk from node v: over each edge there, or once to the ends. */
static void step_from_node(thr_walker *walker, int label, int v, int start)
{
  const thr_turning_columns *turning_columns = walker->c;
  const thr_frame *frame = turning_columns->f;
  const thr_walk_label from = walker->label[label];
  int place = place_after(walker, from.step, v), sign = sign_of(from.step),
      degree = thr_degree(frame, v);

  /* Over each other edge, with a pass more or less, to a node not passed yet. */
  for (int j = 0; j < degree; j++) {
    int h = frame->half[frame->first[v] + j], e = h >> 1, to = thr_head(frame, h);

    if (j == place || e == walker->label[0].step >> 2 || (to != start && passed(walker, label, to)))
      continue;

    for (int by = 1; by >= -1; by -= 2)
      if (room(walker, e, by))
        reach(walker, label, 2 * h + (by < 0),
              from.gain + change_at(walker, v, place, sign, j, by) + by * weight_of(walker, e),
              from.longer + by * frame->length[e]);
  }

  /* Or to the ends of this node, once in a walk. */
  if (place == degree || !may_end(walker, v)) return;

  for (int earlier = label; earlier >= 0; earlier = walker->label[earlier].before)
    if (node_after(walker, walker->label[earlier].step) < 0) return; /* once in a walk */
  for (int by = 1; by >= -1; by -= 2)
    if (walker->ends[v] + by >= 0)
      reach(walker, label, first_to_ends(walker) + 2 * turning_columns->end_group[v] + (by < 0),
            from.gain + change_at(walker, v, place, sign, degree, by), from.longer);
}

/* Continues a partial walk from the ends: an end more at one node is one less at another. Which
 * nodes come first changes from search to search. */
static void step_from_ends(thr_walker *walker, int label, int start)
{
  const thr_turning_columns *turning_columns = walker->c;
  const thr_walk_label from = walker->label[label];
  int n = turning_columns->f->n_nodes, group = (from.step - first_to_ends(walker)) >> 1,
      by = -sign_of(from.step);

  for (int i = 0, v = walker->searches % n; i < n; i++, v = v + 1 < n ? v + 1 : 0)
    if (turning_columns->end_group[v] == group && may_end(walker, v) && walker->ends[v] + by >= 0 &&
        (v == start || !passed(walker, label, v)))
      reach(walker, label, first_from_ends(walker) + 2 * v + (by < 0), from.gain, from.longer);
}

void thr_walker_search(thr_walker *walker, int step, double allowed)
{
  int e = step >> 2, start = thr_tail(walker->c->f, step >> 1);

  walker->n_labels = 0;
  walker->searches++;
  walker->last = -1;
  walker->saved = allowed;

  if (!room(walker, e, sign_of(step))) return;

  /* The first partial walk is the step alone; its price at the start comes in at the end. */
  walker->label[walker->n_labels++] = (thr_walk_label){
      sign_of(step) * weight_of(walker, e), sign_of(step) * walker->c->f->length[e], step, -1, 0};

  /* Partial walks in the order in which they were added, shorter ones first. */
  for (int label = 0; label < walker->n_labels; label++) {
    int v = node_after(walker, walker->label[label].step);
    if (v == start)
      close_walk(walker, label, v, place_after(walker, walker->label[label].step, v));
    else if (v < 0)
      step_from_ends(walker, label, start);
    else if (walker->label[label].depth < DEPTH)
      step_from_node(walker, label, v, start);
  }
}

/* ---- changes ---- */

/* Computes the price of node v anew. */
static void reprice(thr_walker *walker, int v)
{
  double price = price_node(walker, v);
  walker->total += price - walker->price[v];
  walker->price[v] = price;
  forget(walker, v);
}

/* Changes the passes of an edge, and the totals. */
static void change_edge(thr_walker *walker, int e, int by)
{
  walker->passes[e] += by;
  walker->total += by * weight_of(walker, e);
  walker->extra += by * walker->c->f->length[e];
}

void thr_walker_take(thr_walker *walker)
{
  for (int label = walker->last; label >= 0; label = walker->label[label].before) {
    int step = walker->label[label].step, by = sign_of(step);
    if (step < first_to_ends(walker))
      change_edge(walker, step >> 2, by);
    else if (step < first_from_ends(walker)) /* the node before loses what this gives to the ends */
      walker->ends[node_after(walker, walker->label[walker->label[label].before].step)] += by;
    else
      walker->ends[node_after(walker, step)] += by;
  }

  /* Prices are computed when all passes and ends have changed. */
  for (int label = walker->last; label >= 0; label = walker->label[label].before) {
    int v = node_after(walker, walker->label[label].step);
    if (v >= 0) reprice(walker, v);
  }
}

bool thr_walker_double(thr_walker *walker, int edge, int by)
{
  const thr_turning_columns *turning_columns = walker->c;
  const int *node = turning_columns->f->edge[edge];

  if (!room(walker, edge, 2 * by)) return false;
  if (turning_columns->task->extra_limit >= 0 &&
      walker->extra + 2 * by * turning_columns->f->length[edge] >
          turning_columns->task->extra_limit)
    return false;

  /* Try the change, and take it back if it does not save. */
  change_edge(walker, edge, 2 * by);
  double change = 2 * by * weight_of(walker, edge);
  for (int side = 0; side < 2; side++)
    change += price_node(walker, node[side]) - walker->price[node[side]];

  if (change < saving) {
    reprice(walker, node[0]);
    reprice(walker, node[1]);
    return true;
  }

  change_edge(walker, edge, -2 * by);
  return false;
}
