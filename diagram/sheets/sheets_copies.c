/* The copies of a path: all in one picture, how each repeats it, and the places of each in full. */
#include "diagram/overview/crop.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/copies.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROW = 16 }; /* passes in a row of places */

/* The path bold, its copies pale, other cords grey if they are threaded already. */
static void put_picture(thr_sheets *s, int path)
{
  unsigned char *state = thr_calloc((size_t)s->n_moves, sizeof *state);
  if (!state) {
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
    return;
  }
  for (int c = 0, i = 0; c < s->plan->n_cords; c++) {
    unsigned char own = s->copy[c].of == path ? THR_DRAW_NOW : s->copy[c].of < path ? THR_DRAW_EARLIER : THR_DRAW_HIDDEN;
    for (int k = 0; k < s->plan->cord[c].n_passes; k++)
      state[i++] = own;
  }
  double height = 0.52 * (thr_sheets_bottom(s) - s->y);
  thr_box paper = {THR_SHEET_MARGIN, s->y, s->size[0] - THR_SHEET_MARGIN, s->y + height};
  thr_status st = thr_crop_whole(s->plan, &s->guide.layout, state, paper, s->limits, thr_sheets_out(s), &s->why);
  if (st) thr_sheets_fail(s, st, NULL);
  s->y += height + 2 * THR_SHEET_LINE;
  free(state);
}

/* Words that are said with a box to tick. */
static void tick(thr_sheets *s, thr_text *words)
{
  if (words->failed)
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  else
    thr_sheets_tick(s, words->data);
  thr_text_destroy(words);
}

/* "Cord B, turned by 90 degrees: start at foot G1, first to F1 E1 D1, end at A7" */
static void put_copy(thr_sheets *s, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &s->plan->cord[c];
  thr_copies_words(s->plan, s->copy, c, s->o.motion, how);
  thr_text_printf(&words, "Repeat as cord %s%s: start at ", cord->id, how);
  thr_guide_place(&s->guide, thr_cord_start(s->f, cord), &words);
  thr_text_append(&words, ", first to");
  for (int k = 0; k < cord->n_passes && k < 3; k++)
    thr_text_printf(&words, " %s", s->guide.label[thr_head(s->f, cord->half[k])]);
  thr_text_append(&words, ", end at ");
  thr_guide_place(&s->guide, thr_cord_end(s->f, cord), &words);
  tick(s, &words);
}

/* "Cord B, passes 1-16: G1 to F1 E1 (D1) .." */
static int put_places(thr_sheets *s, int first, int end)
{
  thr_text words = {0};
  const thr_move *m = &s->move[first];
  int next = first + 1;
  while (next < end && next < first + ROW && s->move[next].needle == m->needle)
    next++;
  thr_text_printf(&words, "Cord %s%s, ", s->plan->cord[m->cord].id,
                  m->needle == THR_NEEDLE_RIGHT  ? ", right needle"
                  : m->needle == THR_NEEDLE_LEFT ? ", left needle"
                                                 : "");
  thr_text_printf(&words, next > first + 1 ? "passes %d-%d: " : "pass %d: ", m->pass + 1, s->move[next - 1].pass + 1);
  thr_text_printf(&words, "%s to", s->guide.label[thr_tail(s->f, m->half)]);
  for (int i = first; i < next; i++) {
    bool held = s->move[i].deed != THR_PICK_UP;
    thr_text_printf(&words, held ? " (%s)" : " %s", s->guide.label[thr_head(s->f, s->move[i].half)]);
  }
  tick(s, &words);
  return next;
}

void thr_sheets_copies(thr_sheets *s, int c)
{
  char line[160];
  int n = s->plan->n_cords, copies = thr_copies_count(s->copy, n, c);
  if (!copies || s->st) return;
  snprintf(line, sizeof line, "Repeat cord %s with %d other cord%s", s->plan->cord[c].id, copies, copies == 1 ? "" : "s");
  thr_sheets_page(s, line, line);
  if (s->st) return;
  put_picture(s, c);
  for (int i = 0; i < n; i++)
    if (i != c && s->copy[i].of == c) put_copy(s, i);
  thr_sheets_title(s, "The places of these cords, in order");
  thr_sheets_paragraph(
      s, 0, "To check by. In brackets: the way there is through a bead that holds cord already. All other beads are new.");
  for (int i = 0; i < n; i++) {
    if (i == c || s->copy[i].of != c) continue;
    int end = s->first_move[i] + s->plan->cord[i].n_passes;
    for (int k = s->first_move[i]; k < end && !s->st;)
      k = put_places(s, k, end);
  }
}
