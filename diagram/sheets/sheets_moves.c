/* The order of threading, and its rows in words. */
#include "diagram/overview/guide.h"
#include "diagram/scene/palette.h"
#include "diagram/sheets/sheets_parts.h"
#include "diagram/tables/supplies.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pass at whose start the way along the cord is nearest to half of it; 0 for a cord that is not worth a fold. */
static int middle_of(const thr_frame *f, const thr_cord *c)
{
  if (c->n_passes < THR_SHEETS_FOLD) return 0;
  double half = thr_cord_length(f, c) / 2, along = 0, least = HUGE_VAL;
  int best = 0;
  for (int k = 1; k < c->n_passes; k++) {
    along += f->length[c->half[k - 1] >> 1];
    if (fabs(along - half) >= least) break;
    least = fabs(along - half);
    best = k;
  }
  return best;
}

static void add_move(thr_sheets *s, thr_held *held, thr_needle needle, int c, int k, double *used)
{
  int h = s->plan->cord[c].half[k] ^ (needle == THR_NEEDLE_LEFT), e = h >> 1;
  *used += s->f->length[e];
  if (!held->cords[e]) s->threaded[e] = s->n_moves;
  thr_deed deed = thr_held_pass(held, h);
  s->move[s->n_moves++] = (thr_move){.cord = c, .pass = k, .half = h, .deed = deed, .needle = needle, .used = *used};
}

static void add_cord(thr_sheets *s, thr_held *held, int c)
{
  const thr_cord *cord = &s->plan->cord[c];
  int fold = s->fold[c] = s->o.middle ? middle_of(s->f, cord) : 0;
  double used = 0, other = 0;
  s->first_move[c] = s->n_moves;
  for (int k = fold; k < cord->n_passes; k++)
    add_move(s, held, fold ? THR_NEEDLE_RIGHT : THR_NEEDLE_ONLY, c, k, &used);
  for (int k = fold - 1; k >= 0; k--)
    add_move(s, held, THR_NEEDLE_LEFT, c, k, &other);
}

/* first_pass and moved: from the moves. */
static void index_moves(thr_sheets *s)
{
  int first = 0;
  for (int c = 0; c < s->plan->n_cords; c++) {
    int n = s->plan->cord[c].n_passes;
    s->first_pass[c] = first;
    for (int i = s->first_move[c]; i < s->first_move[c] + n; i++)
      s->moved[first + s->move[i].pass] = i;
    first += n;
  }
}

thr_status thr_sheets_plan_moves(thr_sheets *s, thr_err *err)
{
  int n = s->plan->n_cords, passes = 0;
  for (int c = 0; c < n; c++)
    passes += s->plan->cord[c].n_passes;
  thr_held held = {0};
  s->move = thr_calloc((size_t)passes, sizeof *s->move);
  s->moved = thr_calloc((size_t)passes, sizeof *s->moved);
  s->first_move = thr_calloc((size_t)n, sizeof *s->first_move);
  s->first_pass = thr_calloc((size_t)n, sizeof *s->first_pass);
  s->fold = thr_calloc((size_t)n, sizeof *s->fold);
  s->threaded = thr_calloc((size_t)s->f->n_edges, sizeof *s->threaded);
  thr_status st = s->move && s->moved && s->first_move && s->first_pass && s->fold && s->threaded
                      ? thr_held_make(&held, s->f->n_edges, err)
                      : thr_nomem(err);
  if (st) goto done;
  for (int e = 0; e < s->f->n_edges; e++)
    s->threaded[e] = passes;
  for (int path = 0; path < n; path++) {
    if (s->copy[path].of != path) continue;
    add_cord(s, &held, path);
    for (int c = 0; c < n; c++)
      if (c != path && s->copy[c].of == path) add_cord(s, &held, c);
  }
  index_moves(s);
done:
  thr_held_destroy(&held);
  return st;
}

void thr_sheets_cord_words(const thr_sheets *s, int c, char words[96])
{
  static const char *const dash[THR_DASHES] = {"", ", dashed", ", dotted", ", dash-dotted"};
  int n = s->plan->n_cords, hue = s->copy[c].path;
  if (n == 1)
    snprintf(words, 96, "Cord %s", s->plan->cord[c].id);
  else
    snprintf(words, 96, "Cord %s (%s%s%s)", s->plan->cord[c].id, s->copy[c].of == c ? "" : "pale ", thr_palette(hue).name,
             dash[hue / THR_COLOURS % THR_DASHES]);
}

/* ---- rows ---- */

static const char *place_of(const thr_sheets *s, int v)
{
  return s->guide.label[v];
}

/* Does move i follow on the move before it, of the same needle? */
static bool follows(const thr_sheets *s, int i)
{
  return i > 0 && s->move[i].cord == s->move[i - 1].cord && s->move[i].needle == s->move[i - 1].needle;
}

/* How move i goes on from the one before it; only if it follows that. */
static thr_way way_of(const thr_sheets *s, int i)
{
  return thr_guide_way(&s->guide, s->move[i - 1].half, s->move[i].half);
}

static bool goes_ahead(const thr_sheets *s, int i)
{
  if (!follows(s, i)) return false;
  thr_way way = way_of(s, i);
  return way == THR_WAY_STRAIGHT || way == THR_WAY_OVER;
}

/* Are the beads that two moves pick up alike in kind and bore? */
static bool alike(const thr_sheets *s, int i, int k)
{
  int a = s->move[i].half >> 1, b = s->move[k].half >> 1;
  return s->edge_kind[a] == s->edge_kind[b] && s->edge_sort[a] == s->edge_sort[b];
}

/* " (kind 3)", " (kinds 3a x 4, 5, 3b)": of the beads that the moves from first to before end pick up. */
static void put_kinds(const thr_sheets *s, int first, int end, thr_text *words)
{
  bool distinct = false;
  for (int i = first; i < end; i++)
    distinct |= !alike(s, first, i);
  thr_text_append(words, distinct ? " (kinds" : " (kind");
  for (int i = first, next; i < end; i = next) {
    char name[16];
    int e = s->move[i].half >> 1;
    for (next = i + 1; next < end && alike(s, i, next);)
      next++;
    thr_bead_name(s->edge_kind[e], s->edge_sort[e], name);
    thr_text_printf(words, "%s %s", i > first ? "," : "", name);
    if (distinct && next - i > 1) thr_text_printf(words, " x %d", next - i);
  }
  thr_text_append(words, ")");
}

/* "turn left 93 degrees, then straight on", or what fits of it. */
static void put_way(const thr_sheets *s, int first, int end, thr_text *words)
{
  bool curved = false, alone = end == first + 1, ahead = goes_ahead(s, first);
  for (int i = ahead ? first : first + 1; i < end; i++)
    curved |= way_of(s, i) == THR_WAY_OVER;
  if (!follows(s, first))
    thr_text_append(words, alone ? "go" : "go ");
  else if (alone || !ahead)
    thr_guide_say(&s->guide, s->move[first - 1].half, s->move[first].half, words);
  if (!alone && !ahead && follows(s, first)) thr_text_append(words, ", then ");
  if (!alone) thr_text_append(words, curved ? "ahead over the curve" : "straight on");
}

int thr_sheets_run(const thr_sheets *s, int first, int end, thr_text *words)
{
  const thr_move *m = &s->move[first];
  int next = first + 1;
  while (next < end && goes_ahead(s, next) && s->move[next].deed == m->deed)
    next++;
  int n = next - first, last = s->move[next - 1].pass;
  thr_text_printf(words, "pass %d", m->pass + 1);
  if (n > 1) thr_text_printf(words, "-%d", last + 1);
  thr_text_append(words, ": ");
  put_way(s, first, next, words);
  if (n > 1) thr_text_printf(words, ", %d beads", n);
  thr_text_printf(words, ", %s to", place_of(s, thr_tail(s->f, m->half)));
  for (int i = first; i < next; i++)
    thr_text_printf(words, " %s", place_of(s, thr_head(s->f, s->move[i].half)));
  thr_text_printf(words, ": %s %d", thr_deed_words(m->deed), n);
  if (m->deed == THR_PICK_UP && (s->edge_kinds > 1 || s->edge_sort[0])) put_kinds(s, first, next, words);
  return next;
}
