/* Sections of walks, joined anew. */
#include "graph/threading/splice.h"

#include <stdlib.h>
#include <string.h>

thr_splice thr_splice_of(bool cyclic, const thr_walk *a, const thr_walk *b)
{
  thr_splice s = {.cyclic = cyclic, .row = {{a->half, a->n, false}}};
  if (b) {
    s.row[1].half = b->half;
    s.row[1].n = b->n;
  }
  return s;
}

void thr_splice_add(thr_splice *s, int row, const int *half, int n)
{
  s->row[row].half = half;
  s->row[row].n = n;
  s->row[row].added = true;
}

void thr_splice_put(thr_splice *s, int row, int from, int end, bool backwards)
{
  if (end <= from) return;
  s->section[s->n].row = row;
  s->section[s->n].from = from;
  s->section[s->n].end = end;
  s->section[s->n++].backwards = backwards;
}

void thr_splice_next(thr_splice *s)
{
  s->first = s->n;
}

/* ---- turns ---- */

static int half_at(const thr_splice *s, int i, bool last)
{
  int from = s->section[i].from, end = s->section[i].end - 1;
  const int *half = s->row[s->section[i].row].half;
  return s->section[i].backwards ? half[last ? from : end] ^ 1 : half[last ? end : from];
}

/* Does section i begin a walk? */
static bool begins(const thr_splice *s, int i)
{
  return i == 0 || i == s->first;
}

/* The section that comes before, round a closed walk. */
static int before(const thr_splice *s, int i)
{
  if (!begins(s, i)) return i - 1;
  return i == 0 && s->first > 0 ? s->first - 1 : s->n - 1;
}

/* Is the turn from the last pass of a closed walk into its first there before and afterwards? */
static bool closing_stays(const thr_splice *s, int i)
{
  int b = before(s, i), row = s->section[i].row;
  return b != i && s->section[b].row == row && s->section[i].from == 0 && s->section[b].end == s->row[row].n &&
         !s->section[i].backwards && !s->section[b].backwards;
}

thr_turn_change thr_splice_turns(const thr_splice *s)
{
  thr_turn_change c = {.n = 0};
  for (int i = 0; i < s->n; i++) {
    int from = s->section[i].from, row = s->section[i].row;
    const int *half = s->row[row].half;
    if (s->row[row].added) continue;
    if (from > 0)
      thr_turn_change_note(&c, half[from - 1], half[from], -1);
    else if (s->cyclic && !closing_stays(s, i))
      thr_turn_change_note(&c, half[s->row[row].n - 1], half[0], -1);
  }
  for (int i = 0; i < s->n; i++)
    if (s->cyclic ? !closing_stays(s, i) : !begins(s, i))
      thr_turn_change_note(&c, half_at(s, before(s, i), true), half_at(s, i, false), 1);
  return c;
}

static void make_turns(const thr_splice *s, thr_junction_graphs *ties)
{
  thr_turn_change c = thr_splice_turns(s);
  thr_junction_graphs_make(ties, &c);
  for (int i = 0; i < s->n; i++) {
    const int *half = s->row[s->section[i].row].half;
    for (int k = s->section[i].from + 1; s->row[s->section[i].row].added && k < s->section[i].end; k++) {
      c.n = 0;
      thr_turn_change_note(&c, half[k - 1], half[k], 1);
      thr_junction_graphs_make(ties, &c);
    }
  }
}

/* ---- walks ---- */

/* The walk of sections i .. end - 1. */
static thr_status join(const thr_splice *s, const thr_frame *f, int i, int end, thr_walk *out, thr_err *err)
{
  *out = (thr_walk){.cyclic = s->cyclic};
  int n = 0;
  for (int k = i; k < end; k++)
    n += s->section[k].end - s->section[k].from;
  if (!(out->half = thr_calloc((size_t)n, sizeof *out->half))) return thr_nomem(err);
  for (; i < end; i++) {
    int size = s->section[i].end - s->section[i].from;
    memcpy(out->half + out->n, s->row[s->section[i].row].half + s->section[i].from, (size_t)size * sizeof *out->half);
    if (s->section[i].backwards) thr_walk_reverse(out->half + out->n, size);
    out->n += size;
  }
  out->length = thr_walk_length(f, out->half, n);
  return THR_OK;
}

static void take_place(thr_walk *old, const thr_walk *new)
{
  free(old->half);
  *old = *new;
}

thr_status thr_splice_make(const thr_splice *s, const thr_frame *f, thr_walks *w, int a, int b, thr_junction_graphs *ties,
                           int *passes, thr_err *err)
{
  thr_walk one = {0}, two = {0};
  int first = s->first > 0 ? s->first : s->n;
  thr_status st = join(s, f, 0, first, &one, err);
  if (!st && first < s->n) st = join(s, f, first, s->n, &two, err);
  if (!st && b < 0 && two.half) st = thr_walks_add(w, f, two, err);
  if (st) {
    free(one.half);
    return st;
  }
  if (ties) make_turns(s, ties);
  for (int i = 0; i < s->n; i++)
    for (int k = s->section[i].from; s->row[s->section[i].row].added && k < s->section[i].end; k++)
      passes[s->row[s->section[i].row].half[k] >> 1]++;
  take_place(&w->walk[a], &one);
  if (b >= 0) take_place(&w->walk[b], two.half ? &two : &w->walk[w->n_walks - 1]);
  if (b >= 0 && !two.half) w->n_walks--;
  return THR_OK;
}

thr_status thr_splice_cut(thr_walks *w, const thr_frame *f, int i, int at, thr_err *err)
{
  const thr_walk *x = &w->walk[i];
  thr_splice s = thr_splice_of(false, x, NULL);
  thr_splice_put(&s, 0, 0, at, false);
  thr_splice_next(&s);
  thr_splice_put(&s, 0, at, x->n, false);
  return thr_splice_make(&s, f, w, i, -1, NULL, NULL, err);
}
