/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts walks into sections that are joined anew. Whatever is done to walks, to cut one, join two,
 * exchange parts of them, turn a part round or lead one over further passes, is a list of sections.
 *
 * Example: walk b, which starts at the node before pass i of walk a, is put in there backwards;
 * both are closed.
 *
 *   thr_splice s = thr_splice_of(true, &walks->walk[a], &walks->walk[b]);
 *   thr_splice_put(&s, 0, 0, i, false);                           walk a up to pass i
 *   thr_splice_put(&s, 1, 0, walks->walk[b].n, true);             walk b, backwards
 *   thr_splice_put(&s, 0, i, walks->walk[a].n, false);            the rest of walk a
 *   st = thr_splice_make(&s, f, walks, a, b, NULL, NULL, err);    one walk, number a */
#include "graph/threading/threading.h"

#include <stdlib.h>
#include <string.h>

thr_splice thr_splice_of(bool cyclic, const thr_walk *a, const thr_walk *b)
{
  thr_splice splice = {.cyclic = cyclic, .row = {{a->half, a->n, false}}};
  if (b) {
    splice.row[1].half = b->half;
    splice.row[1].n = b->n;
  }
  return splice;
}

void thr_splice_add(thr_splice *splice, int row, const int *half, int n)
{
  splice->row[row].half = half;
  splice->row[row].n = n;
  splice->row[row].added = true;
}

void thr_splice_put(thr_splice *splice, int row, int from, int end, bool backwards)
{
  if (end <= from) return;
  splice->section[splice->n].row = row;
  splice->section[splice->n].from = from;
  splice->section[splice->n].end = end;
  splice->section[splice->n++].backwards = backwards;
}

void thr_splice_next(thr_splice *splice)
{
  splice->first = splice->n;
}

/* ---- turns ---- */

/* Returns the first or last half-edge of section i, as the section runs. */
static int half_at(const thr_splice *splice, int i, bool last)
{
  int from = splice->section[i].from, end = splice->section[i].end - 1;
  const int *half = splice->row[splice->section[i].row].half;
  return splice->section[i].backwards ? half[last ? from : end] ^ 1 : half[last ? end : from];
}

/* Returns whether section i begins a walk. */
static bool begins(const thr_splice *splice, int i)
{
  return i == 0 || i == splice->first;
}

/* Returns the section before section i, going round a closed walk. */
static int before(const thr_splice *splice, int i)
{
  if (!begins(splice, i)) return i - 1;
  return i == 0 && splice->first > 0 ? splice->first - 1 : splice->n - 1;
}

/* Returns whether section i and the one before it make the closing turn that their walk has
 * already, from its last pass into its first. */
static bool closing_stays(const thr_splice *splice, int i)
{
  int b = before(splice, i), row = splice->section[i].row;
  return b != i && splice->section[b].row == row && splice->section[i].from == 0 &&
         splice->section[b].end == splice->row[row].n && !splice->section[i].backwards &&
         !splice->section[b].backwards;
}

thr_turn_change thr_splice_turns(const thr_splice *splice)
{
  thr_turn_change change = {.n = 0};

  /* The turns where the old walks are cut, which is ahead of each section that comes from one, go.
   */
  for (int i = 0; i < splice->n; i++) {
    int from = splice->section[i].from, row = splice->section[i].row;
    const int *half = splice->row[row].half;

    if (splice->row[row].added) continue;

    if (from > 0)
      thr_turn_change_note(&change, half[from - 1], half[from], -1);
    else if (splice->cyclic && !closing_stays(splice, i))
      thr_turn_change_note(&change, half[splice->row[row].n - 1], half[0], -1);
  }

  /* The turns where two sections meet come. */
  for (int i = 0; i < splice->n; i++)
    if (splice->cyclic ? !closing_stays(splice, i) : !begins(splice, i))
      thr_turn_change_note(&change, half_at(splice, before(splice, i), true),
                           half_at(splice, i, false), 1);
  return change;
}

/* Counts the turns that come and go, with those inside new passes. */
static void make_turns(const thr_splice *splice, thr_junction_graphs *ties)
{
  thr_turn_change change = thr_splice_turns(splice);
  thr_junction_graphs_make(ties, &change);

  for (int i = 0; i < splice->n; i++) {
    const int *half = splice->row[splice->section[i].row].half;

    for (int k = splice->section[i].from + 1;
         splice->row[splice->section[i].row].added && k < splice->section[i].end; k++) {
      change.n = 0;
      thr_turn_change_note(&change, half[k - 1], half[k], 1);
      thr_junction_graphs_make(ties, &change);
    }
  }
}

/* ---- walks ---- */

/* Joins the sections i .. end - 1 to a walk. */
static thr_status join(const thr_splice *splice, const thr_frame *frame, int i, int end,
                       thr_walk *out, thr_err *err)
{
  *out = (thr_walk){.cyclic = splice->cyclic};

  int n = 0;
  for (int k = i; k < end; k++)
    n += splice->section[k].end - splice->section[k].from;

  /* Copy the sections one after the other. */
  if (!(out->half = thr_calloc((size_t)n, sizeof *out->half))) return thr_nomem(err);

  for (; i < end; i++) {
    int size = splice->section[i].end - splice->section[i].from;
    memcpy(out->half + out->n, splice->row[splice->section[i].row].half + splice->section[i].from,
           (size_t)size * sizeof *out->half);
    if (splice->section[i].backwards) thr_walk_reverse(out->half + out->n, size);
    out->n += size;
  }

  out->length = thr_walk_length(frame, out->half, n);
  return THR_OK;
}

/* Puts a new walk in the place of an old one, which is released. */
static void take_place(thr_walk *old, const thr_walk *new)
{
  free(old->half);
  *old = *new;
}

thr_status thr_splice_make(const thr_splice *splice, const thr_frame *frame, thr_walks *walks,
                           int a, int b, thr_junction_graphs *ties, int *passes, thr_err *err)
{
  thr_walk one = {0}, two = {0};
  int first = splice->first > 0 ? splice->first : splice->n;

  /* Make the new walks first: on failure nothing has changed. */
  thr_status st = join(splice, frame, 0, first, &one, err);
  if (!st && first < splice->n) st = join(splice, frame, first, splice->n, &two, err);
  if (!st && b < 0 && two.half) st = thr_walks_add(walks, frame, two, err);

  if (st) {
    free(one.half);
    return st;
  }

  /* From here on nothing fails: count turns and passes, and put the walks in place. */
  if (ties) make_turns(splice, ties);

  for (int i = 0; i < splice->n; i++)
    for (int k = splice->section[i].from;
         splice->row[splice->section[i].row].added && k < splice->section[i].end; k++)
      passes[splice->row[splice->section[i].row].half[k] >> 1]++;

  take_place(&walks->walk[a], &one);
  if (b >= 0) take_place(&walks->walk[b], two.half ? &two : &walks->walk[walks->n_walks - 1]);
  if (b >= 0 && !two.half) walks->n_walks--;
  return THR_OK;
}

thr_status thr_splice_cut(thr_walks *walks, const thr_frame *frame, int i, int at, thr_err *err)
{
  const thr_walk *walk = &walks->walk[i];
  thr_splice splice = thr_splice_of(false, walk, NULL);

  thr_splice_put(&splice, 0, 0, at, false);
  thr_splice_next(&splice);
  thr_splice_put(&splice, 0, at, walk->n, false);

  return thr_splice_make(&splice, frame, walks, i, -1, NULL, NULL, err);
}
