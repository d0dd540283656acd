/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gives walks a memory of edges they have passed, by one place for every set of remembered edges.
 *
 * An edge that needs one pass is rewarded once, though a walk may come round to it again. Where a
 * walk remembers that it passed the edge it is not rewarded again (ng-routes, see
 * graph/plan/walk_proof.h). The file replaces every place of the walks (now called a spot) by one
 * place for each set of the edges remembered there that some walk comes to with, and rebuilds the
 * steps between places.
 *
 * Example: a spot that remembers two edges becomes up to four places. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/arrays.h"
#include "graph/status.h"

enum { MOST_BITS = 16 };

/* The places before a memory are spots; a spot and a set of the edges that are remembered there
 * make a place. Sets are numbers whose bits say which edges of the spot's list are in them;
 * place[offset[spot] + set] is -1 until a walk is found to come there.
 */
typedef struct {
  thr_walk_steps *steps;
  thr_scratch own;
  int *first, *edge;   /* [n_spots + 1] lists of the edges that are remembered at a spot:
                          edge[first[spot]] .. */
  int *offset, *place; /* [n_spots + 1], [offset[n_spots]] */
  int *queue,
      *at; /* [offset[n_spots]] places as they are found: their index in place, and their spot */
  int n, n_steps; /* places found, steps from them */
} memory_builder;

/* ---- the lists ---- */

/* Checks that an edge, and the places where it is remembered, may follow the edge before it in a
 * list. */
static thr_status check_memory(const thr_walk_steps *steps, const thr_walk_memory *memory,
                               int before, thr_err *err)
{
  const thr_turning_columns *columns = steps->c;
  const thr_frame *frame = columns->f;
  const int e = memory->edge,
            most = steps->measure == THR_WALK_LENGTH ? frame->n_nodes : 2 * frame->n_edges;

  if (e <= before || e >= frame->n_edges ||
      columns->component[frame->edge[e][0]] != steps->component)
    return thr_fail(err, THR_EVIOLATED,
                    "walks: edge %d is not to be remembered: out of order, or of another component",
                    e);

  /* An edge that needs more passes is rewarded more than once. */
  if (columns->cover[e] != 1)
    return thr_fail(err, THR_EVIOLATED, "walks: edge %d, which is remembered, needs %d passes", e,
                    columns->cover[e]);

  /* Places ascend and are in the component. */
  for (int k = 0; k < memory->n; k++) {
    const int at = memory->place[k];
    if (at < 0 || at >= most || (k && at <= memory->place[k - 1]) || steps->place[at] < 0)
      return thr_fail(
          err, THR_EVIOLATED,
          "walks: edge %d is not to be remembered at %d: out of order, or of another component", e,
          at);
  }

  return THR_OK;
}

/* Makes for every spot the list of the edges remembered there, and numbers the sets of them. */
static thr_status make_lists(memory_builder *builder, const thr_walk_memory *memory, int n,
                             thr_err *err)
{
  const thr_walk_steps *steps = builder->steps;
  size_t total = 0, places = 0;
  thr_status st = THR_OK;

  for (int i = 0; i < n && !st; i++) {
    st = check_memory(steps, &memory[i], i ? memory[i - 1].edge : -1, err);
    total += (size_t)memory[i].n;
  }
  if (st) return st;

  /* Edges come in ascending order, so that an edge is listed once. */
  builder->first =
      thr_scratch_array(&builder->own, (size_t)steps->n_spots + 1, sizeof *builder->first);
  builder->offset =
      thr_scratch_array(&builder->own, (size_t)steps->n_spots + 1, sizeof *builder->offset);
  builder->edge = thr_scratch_array(&builder->own, total, sizeof *builder->edge);
  if ((st = thr_scratch_check(&builder->own, err))) return st;

  /* Count the edges of every spot, then number the sets: 2^count each. */
  for (int i = 0; i < n; i++)
    for (int k = 0; k < memory[i].n; k++)
      builder->first[steps->place[memory[i].place[k]] + 1]++;

  for (int s = 0; s < steps->n_spots; s++) {
    const int bits = builder->first[s + 1];
    if (bits > MOST_BITS || (places += (size_t)1 << bits) > THR_MOST_PLACES)
      return thr_fail(err, THR_EVIOLATED, "walks: more is remembered than can be checked");
    builder->offset[s + 1] = (int)places;
    builder->first[s + 1] += builder->first[s];
  }

  /* Each list is filled from its end, where first[s + 1] is. */
  for (int i = n; i-- > 0;)
    for (int k = 0; k < memory[i].n; k++)
      builder->edge[--builder->first[steps->place[memory[i].place[k]] + 1]] = memory[i].edge;

  /* After filling, the start of list s is at first[s + 1]. */
  for (int s = 0; s < steps->n_spots; s++)
    builder->first[s] = builder->first[s + 1];
  builder->first[steps->n_spots] = (int)total;
  return THR_OK;
}

/* ---- places ---- */

/* Returns whether an edge is in a set of a spot. */
static bool remembers(const memory_builder *builder, int spot, int set, int edge)
{
  for (int k = builder->first[spot]; k < builder->first[spot + 1]; k++)
    if (builder->edge[k] == edge) return set >> (k - builder->first[spot]) & 1;
  return false;
}

/* Returns the set at `spot` after an edge was passed from spot `before` with this set; before < 0:
 * nothing was passed before. */
static int set_after(const memory_builder *builder, int before, int set, int edge, int spot)
{
  int after = 0;

  /* An edge stays remembered as long as the walk is at spots that remember it. */
  for (int k = builder->first[spot]; k < builder->first[spot + 1]; k++)
    if (builder->edge[k] == edge ||
        (before >= 0 && remembers(builder, before, set, builder->edge[k])))
      after |= 1 << (k - builder->first[spot]);

  return after;
}

/* Returns the set with which a walk begins; its first pass is in the set, if it begins with one. */
static int first_set(const memory_builder *builder, const thr_walk_step *begin)
{
  const bool passed = !builder->steps->closed || builder->steps->n_homes > 0;
  return passed ? set_after(builder, -1, 0, begin->half >> 1, begin->to) : 0;
}

/* Numbers a place if it is new, and puts it into the queue. */
static void find_place(memory_builder *builder, int spot, int set)
{
  const int i = builder->offset[spot] + set;
  if (builder->place[i] >= 0) return;

  /* The set and the spot are found again by the place's number. */
  builder->place[i] = builder->n;
  builder->at[builder->n] = spot;
  builder->queue[builder->n++] = i;
}

/* Finds every place that a walk comes to from where one begins, by breadth-first search. */
static thr_status find_places(memory_builder *builder, thr_err *err)
{
  const thr_walk_steps *steps = builder->steps;
  const size_t most = (size_t)builder->offset[steps->n_spots];
  builder->place = thr_scratch_array(&builder->own, most, sizeof *builder->place);
  builder->queue = thr_scratch_array(&builder->own, most, sizeof *builder->queue);
  builder->at = thr_scratch_array(&builder->own, most, sizeof *builder->at);

  thr_status st = thr_scratch_check(&builder->own, err);

  for (size_t i = 0; i < most && !st; i++)
    builder->place[i] = -1;

  /* Walks begin here .. */
  for (int k = 0; k < steps->n_begins && !st; k++)
    find_place(builder, steps->begin[k].to, first_set(builder, &steps->begin[k]));

  /* .. and every step from a place found leads to a place. */
  for (int i = 0; i < builder->n && !st; i++) {
    const int spot = builder->at[i], set = builder->queue[i] - builder->offset[spot];
    builder->n_steps += steps->first[spot + 1] - steps->first[spot];

    for (int k = steps->first[spot]; k < steps->first[spot + 1]; k++)
      find_place(builder, steps->step[k].to,
                 set_after(builder, spot, set, steps->step[k].half >> 1, steps->step[k].to));
  }

  return st;
}

/* ---- the steps anew ---- */

/* Numbers the places in the order of their spots, and of the sets there: the order that the
 * recursion needs. */
static void number_places(memory_builder *builder, int *copy, int *spot)
{
  int n = 0;
  for (int s = 0; s < builder->steps->n_spots; s++) {
    copy[s] = n;
    for (int i = builder->offset[s]; i < builder->offset[s + 1]; i++) {
      if (builder->place[i] < 0) continue;

      /* From here on the queue holds the places by number. */
      spot[n] = s;
      builder->queue[n] = i;
      builder->place[i] = n++;
    }
  }

  copy[builder->steps->n_spots] = n;
}

/* Copies the steps from spots to places, each to the set after it; `known` marks edges that are
 * remembered. */
static void copy_steps(const memory_builder *builder, thr_walk_steps *to)
{
  const thr_walk_steps *from = builder->steps;
  int n = 0;
  for (int i = 0; i < to->n; i++) {
    const int s = to->spot[i], set = builder->queue[i] - builder->offset[s];
    to->first[i] = n;
    to->group[i] = from->group[s];
    to->end[i] = from->end[s];

    /* Steps stay those of the spot; only where they lead to depends on the set. */
    for (int k = from->first[s]; k < from->first[s + 1]; k++, n++) {
      const int after = from->step[k].to, edge = from->step[k].half >> 1;
      to->step[n] = from->step[k];
      to->step[n].to =
          builder->place[builder->offset[after] + set_after(builder, s, set, edge, after)];
      to->step[n].known = remembers(builder, s, set, edge);
    }
  }

  to->first[to->n] = n;

  /* Walks begin at the places with their first sets. */
  for (int k = 0; k < from->n_begins; k++)
    to->begin[k].to =
        builder->place[builder->offset[from->begin[k].to] + first_set(builder, &from->begin[k])];
}

thr_status thr_walk_steps_remember(thr_walk_steps *steps, const thr_walk_memory *memory, int n,
                                   thr_err *err)
{
  memory_builder builder = {.steps = steps};
  if (n == 0) return THR_OK;

  /* Lists of edges, then places. */
  thr_status st = make_lists(&builder, memory, n, err);
  if (!st) st = find_places(&builder, err);

  /* New arrays replace the old ones only when all are there. */
  if (!st) {
    thr_walk_steps made = *steps;
    const size_t places = (size_t)builder.n;
    made.n = builder.n;
    made.spot = thr_scratch_array(&steps->own, places, sizeof *made.spot);
    made.copy = thr_scratch_array(&steps->own, (size_t)steps->n_spots + 1, sizeof *made.copy);
    made.group = thr_scratch_array(&steps->own, places, sizeof *made.group);
    made.first = thr_scratch_array(&steps->own, places + 1, sizeof *made.first);
    made.step = thr_scratch_array(&steps->own, (size_t)builder.n_steps, sizeof *made.step);
    made.move = thr_scratch_array(&steps->own, (size_t)builder.n_steps, sizeof *made.move);
    made.end = thr_scratch_array(&steps->own, places, sizeof *made.end);
    made.cut = thr_scratch_array(&steps->own, places, sizeof *made.cut);
    made.active = thr_scratch_array(&steps->own, places, sizeof *made.active);
    made.own = steps->own;

    /* The old arrays stay in the same scratch until the end. */
    st = thr_scratch_check(&steps->own, err);
    if (!st) {
      number_places(&builder, made.copy, made.spot);
      copy_steps(&builder, &made);
      *steps = made;
    }
  }

  thr_scratch_free(&builder.own);
  return st;
}
