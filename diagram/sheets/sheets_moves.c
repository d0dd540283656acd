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
static int middle_of(const thr_frame *frame, const thr_cord *cord)
{
  if (cord->n_passes < THR_SHEETS_FOLD) return 0;
  double half = thr_cord_length(frame, cord) / 2, along = 0, least = HUGE_VAL;
  int best = 0;
  for (int k = 1; k < cord->n_passes; k++) {
    along += frame->length[cord->half[k - 1] >> 1];
    if (fabs(along - half) >= least) break;
    least = fabs(along - half);
    best = k;
  }
  return best;
}

static void add_move(thr_sheets *sheets, thr_held *held, thr_needle needle, int c, int k, double *used)
{
  int h = sheets->plan->cord[c].half[k] ^ (needle == THR_NEEDLE_LEFT), e = h >> 1;
  *used += sheets->f->length[e];
  if (!held->cords[e]) sheets->threaded[e] = sheets->n_moves;
  thr_deed deed = thr_held_pass(held, h);
  sheets->move[sheets->n_moves++] = (thr_move){.cord = c, .pass = k, .half = h, .deed = deed, .needle = needle, .used = *used};
}

static void add_cord(thr_sheets *sheets, thr_held *held, int c)
{
  const thr_cord *cord = &sheets->plan->cord[c];
  int fold = sheets->fold[c] = sheets->o.middle ? middle_of(sheets->f, cord) : 0;
  double used = 0, other = 0;
  sheets->first_move[c] = sheets->n_moves;
  for (int k = fold; k < cord->n_passes; k++)
    add_move(sheets, held, fold ? THR_NEEDLE_RIGHT : THR_NEEDLE_ONLY, c, k, &used);
  for (int k = fold - 1; k >= 0; k--)
    add_move(sheets, held, THR_NEEDLE_LEFT, c, k, &other);
}

/* first_pass and moved: from the moves. */
static void index_moves(thr_sheets *sheets)
{
  int first = 0;
  for (int c = 0; c < sheets->plan->n_cords; c++) {
    int n = sheets->plan->cord[c].n_passes;
    sheets->first_pass[c] = first;
    for (int i = sheets->first_move[c]; i < sheets->first_move[c] + n; i++)
      sheets->moved[first + sheets->move[i].pass] = i;
    first += n;
  }
}

thr_status thr_sheets_plan_moves(thr_sheets *sheets, thr_err *err)
{
  int n = sheets->plan->n_cords, passes = 0;
  for (int c = 0; c < n; c++)
    passes += sheets->plan->cord[c].n_passes;
  thr_held held = {0};
  sheets->move = thr_calloc((size_t)passes, sizeof *sheets->move);
  sheets->moved = thr_calloc((size_t)passes, sizeof *sheets->moved);
  sheets->first_move = thr_calloc((size_t)n, sizeof *sheets->first_move);
  sheets->first_pass = thr_calloc((size_t)n, sizeof *sheets->first_pass);
  sheets->fold = thr_calloc((size_t)n, sizeof *sheets->fold);
  sheets->threaded = thr_calloc((size_t)sheets->f->n_edges, sizeof *sheets->threaded);
  thr_status st = sheets->move && sheets->moved && sheets->first_move && sheets->first_pass && sheets->fold && sheets->threaded
                      ? thr_held_make(&held, sheets->f->n_edges, err)
                      : thr_nomem(err);
  if (st) goto done;
  for (int e = 0; e < sheets->f->n_edges; e++)
    sheets->threaded[e] = passes;
  for (int path = 0; path < n; path++) {
    if (sheets->copy[path].of != path) continue;
    add_cord(sheets, &held, path);
    for (int c = 0; c < n; c++)
      if (c != path && sheets->copy[c].of == path) add_cord(sheets, &held, c);
  }
  index_moves(sheets);
done:
  thr_held_destroy(&held);
  return st;
}

void thr_sheets_cord_words(const thr_sheets *sheets, int c, char words[96])
{
  static const char *const dash[THR_DASHES] = {"", ", dashed", ", dotted", ", dash-dotted"};
  int n = sheets->plan->n_cords, hue = sheets->copy[c].path;
  if (n == 1)
    snprintf(words, 96, "Cord %s", sheets->plan->cord[c].id);
  else
    snprintf(words, 96, "Cord %s (%s%s%s)", sheets->plan->cord[c].id, sheets->copy[c].of == c ? "" : "pale ",
             thr_palette(hue).name, dash[hue / THR_COLOURS % THR_DASHES]);
}

/* ---- rows ---- */

static const char *place_of(const thr_sheets *sheets, int v)
{
  return sheets->guide.label[v];
}

/* Does move i follow on the move before it, of the same needle? */
static bool follows(const thr_sheets *sheets, int i)
{
  return i > 0 && sheets->move[i].cord == sheets->move[i - 1].cord && sheets->move[i].needle == sheets->move[i - 1].needle;
}

/* How move i goes on from the one before it; only if it follows that. */
static thr_way way_of(const thr_sheets *sheets, int i)
{
  return thr_guide_way(&sheets->guide, sheets->move[i - 1].half, sheets->move[i].half);
}

static bool goes_ahead(const thr_sheets *sheets, int i)
{
  if (!follows(sheets, i)) return false;
  thr_way way = way_of(sheets, i);
  return way == THR_WAY_STRAIGHT || way == THR_WAY_OVER;
}

/* Are the beads that two moves pick up alike in kind and bore? */
static bool alike(const thr_sheets *sheets, int i, int k)
{
  int a = sheets->move[i].half >> 1, b = sheets->move[k].half >> 1;
  return sheets->edge_kind[a] == sheets->edge_kind[b] && sheets->edge_sort[a] == sheets->edge_sort[b];
}

/* " (kind 3)", " (kinds 3a x 4, 5, 3b)": of the beads that the moves from first to before end pick up. */
static void put_kinds(const thr_sheets *sheets, int first, int end, thr_text *words)
{
  bool distinct = false;
  for (int i = first; i < end; i++)
    distinct |= !alike(sheets, first, i);
  thr_text_append(words, distinct ? " (kinds" : " (kind");
  for (int i = first, next; i < end; i = next) {
    char name[16];
    int e = sheets->move[i].half >> 1;
    for (next = i + 1; next < end && alike(sheets, i, next);)
      next++;
    thr_bead_name(sheets->edge_kind[e], sheets->edge_sort[e], name);
    thr_text_printf(words, "%s %s", i > first ? "," : "", name);
    if (distinct && next - i > 1) thr_text_printf(words, " x %d", next - i);
  }
  thr_text_append(words, ")");
}

/* "turn left 93 degrees, then straight on", or what fits of it. */
static void put_way(const thr_sheets *sheets, int first, int end, thr_text *words)
{
  bool curved = false, alone = end == first + 1, ahead = goes_ahead(sheets, first);
  for (int i = ahead ? first : first + 1; i < end; i++)
    curved |= way_of(sheets, i) == THR_WAY_OVER;
  if (!follows(sheets, first))
    thr_text_append(words, alone ? "go" : "go ");
  else if (alone || !ahead)
    thr_guide_say(&sheets->guide, sheets->move[first - 1].half, sheets->move[first].half, words);
  if (!alone && !ahead && follows(sheets, first)) thr_text_append(words, ", then ");
  if (!alone) thr_text_append(words, curved ? "ahead over the curve" : "straight on");
}

int thr_sheets_run(const thr_sheets *sheets, int first, int end, thr_text *words)
{
  const thr_move *move = &sheets->move[first];
  int next = first + 1;
  while (next < end && goes_ahead(sheets, next) && sheets->move[next].deed == move->deed)
    next++;
  int n = next - first, last = sheets->move[next - 1].pass;
  thr_text_printf(words, "pass %d", move->pass + 1);
  if (n > 1) thr_text_printf(words, "-%d", last + 1);
  thr_text_append(words, ": ");
  put_way(sheets, first, next, words);
  if (n > 1) thr_text_printf(words, ", %d beads", n);
  thr_text_printf(words, ", %s to", place_of(sheets, thr_tail(sheets->f, move->half)));
  for (int i = first; i < next; i++)
    thr_text_printf(words, " %s", place_of(sheets, thr_head(sheets->f, sheets->move[i].half)));
  thr_text_printf(words, ": %s %d", thr_deed_words(move->deed), n);
  if (move->deed == THR_PICK_UP && (sheets->edge_kinds > 1 || sheets->edge_sort[0])) put_kinds(sheets, first, next, words);
  return next;
}
