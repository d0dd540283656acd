/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walks that remember which edges they have passed: one place of a spot for every set of them. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdlib.h>

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
} making;

/* ---- the lists ---- */

/* THR_OK if an edge and places may stand in a memory after the edge before. */
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
  if (columns->cover[e] != 1)
    return thr_fail(err, THR_EVIOLATED, "walks: edge %d, which is remembered, needs %d passes", e,
                    columns->cover[e]);
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

static thr_status make_lists(making *m, const thr_walk_memory *memory, int n, thr_err *err)
{
  const thr_walk_steps *steps = m->steps;
  size_t total = 0, places = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    st = check_memory(steps, &memory[i], i ? memory[i - 1].edge : -1, err);
    total += (size_t)memory[i].n;
  }
  if (st) return st;
  m->first = thr_scratch_array(&m->own, (size_t)steps->n_spots + 1, sizeof *m->first);
  m->offset = thr_scratch_array(&m->own, (size_t)steps->n_spots + 1, sizeof *m->offset);
  m->edge = thr_scratch_array(&m->own, total, sizeof *m->edge);
  if ((st = thr_scratch_check(&m->own, err))) return st;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < memory[i].n; k++)
      m->first[steps->place[memory[i].place[k]] + 1]++;
  for (int s = 0; s < steps->n_spots; s++) {
    const int bits = m->first[s + 1];
    if (bits > MOST_BITS || (places += (size_t)1 << bits) > THR_MOST_PLACES)
      return thr_fail(err, THR_EVIOLATED, "walks: more is remembered than can be checked");
    m->offset[s + 1] = (int)places;
    m->first[s + 1] += m->first[s];
  }
  for (int i = n; i-- > 0;) /* each list is filled from its end, where first[s + 1] is */
    for (int k = 0; k < memory[i].n; k++)
      m->edge[--m->first[steps->place[memory[i].place[k]] + 1]] = memory[i].edge;
  for (int s = 0; s < steps->n_spots; s++)
    m->first[s] = m->first[s + 1];
  m->first[steps->n_spots] = (int)total;
  return THR_OK;
}

/* ---- places ---- */

/* Is an edge in a set of a spot? */
static bool remembers(const making *m, int spot, int set, int edge)
{
  for (int k = m->first[spot]; k < m->first[spot + 1]; k++)
    if (m->edge[k] == edge) return set >> (k - m->first[spot]) & 1;
  return false;
}

/* The set at a spot after that at another, from which an edge was passed. before < 0: nothing was
 * passed before. */
static int set_after(const making *m, int before, int set, int edge, int spot)
{
  int after = 0;
  for (int k = m->first[spot]; k < m->first[spot + 1]; k++)
    if (m->edge[k] == edge || (before >= 0 && remembers(m, before, set, m->edge[k])))
      after |= 1 << (k - m->first[spot]);
  return after;
}

/* The set where a walk begins: with the first pass, if it is made there. */
static int first_set(const making *m, const thr_walk_step *begin)
{
  const bool passed = !m->steps->closed || m->steps->n_homes > 0;
  return passed ? set_after(m, -1, 0, begin->half >> 1, begin->to) : 0;
}

static void find_place(making *m, int spot, int set)
{
  const int i = m->offset[spot] + set;
  if (m->place[i] >= 0) return;
  m->place[i] = m->n;
  m->at[m->n] = spot;
  m->queue[m->n++] = i;
}

/* Every place that a walk comes to from where one begins. */
static thr_status find_places(making *m, thr_err *err)
{
  const thr_walk_steps *steps = m->steps;
  const size_t most = (size_t)m->offset[steps->n_spots];
  m->place = thr_scratch_array(&m->own, most, sizeof *m->place);
  m->queue = thr_scratch_array(&m->own, most, sizeof *m->queue);
  m->at = thr_scratch_array(&m->own, most, sizeof *m->at);
  thr_status st = thr_scratch_check(&m->own, err);
  for (size_t i = 0; i < most && !st; i++)
    m->place[i] = -1;
  for (int k = 0; k < steps->n_begins && !st; k++)
    find_place(m, steps->begin[k].to, first_set(m, &steps->begin[k]));
  for (int i = 0; i < m->n && !st; i++) {
    const int spot = m->at[i], set = m->queue[i] - m->offset[spot];
    m->n_steps += steps->first[spot + 1] - steps->first[spot];
    for (int k = steps->first[spot]; k < steps->first[spot + 1]; k++)
      find_place(m, steps->step[k].to,
                 set_after(m, spot, set, steps->step[k].half >> 1, steps->step[k].to));
  }
  return st;
}

/* ---- the steps anew ---- */

/* Places in the order of their spots, and of the sets there. */
static void number_places(making *m, int *copy, int *spot)
{
  int n = 0;
  for (int s = 0; s < m->steps->n_spots; s++) {
    copy[s] = n;
    for (int i = m->offset[s]; i < m->offset[s + 1]; i++) {
      if (m->place[i] < 0) continue;
      spot[n] = s;
      m->queue[n] = i;
      m->place[i] = n++;
    }
  }
  copy[m->steps->n_spots] = n;
}

static void copy_steps(const making *m, thr_walk_steps *to)
{
  const thr_walk_steps *from = m->steps;
  int n = 0;
  for (int i = 0; i < to->n; i++) {
    const int s = to->spot[i], set = m->queue[i] - m->offset[s];
    to->first[i] = n;
    to->group[i] = from->group[s];
    to->end[i] = from->end[s];
    for (int k = from->first[s]; k < from->first[s + 1]; k++, n++) {
      const int after = from->step[k].to, edge = from->step[k].half >> 1;
      to->step[n] = from->step[k];
      to->step[n].to = m->place[m->offset[after] + set_after(m, s, set, edge, after)];
      to->step[n].known = remembers(m, s, set, edge);
    }
  }
  to->first[to->n] = n;
  for (int k = 0; k < from->n_begins; k++)
    to->begin[k].to = m->place[m->offset[from->begin[k].to] + first_set(m, &from->begin[k])];
}

thr_status thr_walk_steps_remember(thr_walk_steps *steps, const thr_walk_memory *memory, int n,
                                   thr_err *err)
{
  making m = {.steps = steps};
  if (n == 0) return THR_OK;
  thr_status st = make_lists(&m, memory, n, err);
  if (!st) st = find_places(&m, err);
  if (!st) {
    thr_walk_steps made = *steps;
    const size_t places = (size_t)m.n;
    made.n = m.n;
    made.spot = thr_scratch_array(&steps->own, places, sizeof *made.spot);
    made.copy = thr_scratch_array(&steps->own, (size_t)steps->n_spots + 1, sizeof *made.copy);
    made.group = thr_scratch_array(&steps->own, places, sizeof *made.group);
    made.first = thr_scratch_array(&steps->own, places + 1, sizeof *made.first);
    made.step = thr_scratch_array(&steps->own, (size_t)m.n_steps, sizeof *made.step);
    made.move = thr_scratch_array(&steps->own, (size_t)m.n_steps, sizeof *made.move);
    made.end = thr_scratch_array(&steps->own, places, sizeof *made.end);
    made.cut = thr_scratch_array(&steps->own, places, sizeof *made.cut);
    made.active = thr_scratch_array(&steps->own, places, sizeof *made.active);
    made.own = steps->own;
    st = thr_scratch_check(&steps->own, err);
    if (!st) {
      number_places(&m, made.copy, made.spot);
      copy_steps(&m, &made);
      *steps = made;
    }
  }
  thr_scratch_free(&m.own);
  return st;
}
