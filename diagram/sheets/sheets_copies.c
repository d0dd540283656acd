/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the copies of a path: a picture of all of them, how each repeats the path, and the
 * places of each in full.
 *
 * A copy is a cord that a symmetry of the framework maps a path to (scene.h, thr_copy). Its steps
 * need no pictures of their own: who has threaded the path repeats it from another place. The lists
 * of places are there to check by.
 *
 * Example: "[ ] Repeat as cord B, turned by 90 degrees: start at foot G1, first to F1 E1 D1, end at
 * A7" and "[ ] Cord B, passes 1-16: G1 to F1 E1 (D1) .." */
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROW = 16 }; /* passes in a row of places */

/* Draws the path and its copies bold, cords that are threaded already grey, over half the page. */
static void put_picture(thr_sheets *sheets, int path)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  unsigned char *state = thr_calloc((size_t)known->n_passes, sizeof *state);

  if (!state) {
    thr_nomem(&flow->why);
    return;
  }

  /* All passes of a cord have its state; i counts them in the order of the scene. */
  for (int c = 0, i = 0; c < known->plan->n_cords; c++) {
    unsigned char own = known->copy[c].of == path  ? THR_DRAW_NOW
                        : known->copy[c].of < path ? THR_DRAW_EARLIER
                                                   : THR_DRAW_HIDDEN;
    for (int k = 0; k < known->plan->cord[c].n_passes; k++)
      state[i++] = own;
  }

  /* The lower half of the page is for the words, with two lines of air above them. */
  double bottom = flow->y + 0.52 * (thr_sheets_bottom(flow) - flow->y);
  thr_sheets_whole(sheets, false, state, NULL, bottom, NULL);
  flow->y = bottom + 2 * THR_SHEET_LINE;
  free(state);
}

/* Writes how a copy repeats its path: by which symmetry, where it starts, its first places, where
 * it ends. */
static void put_copy(thr_flow *flow, const thr_known *known, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &known->plan->cord[c];

  /* "turned by 90 degrees": the symmetry, as far as it has a name. */
  thr_copies_words(known->plan, known->copy, c, known->o.motion, how);
  thr_text_printf(&words, "Repeat as cord %s%s: start at ", cord->id, how);
  thr_guide_place(&known->guide, thr_cord_start(known->f, cord), &words);

  /* Three places show the direction. */
  thr_text_append(&words, ", first to");
  for (int k = 0; k < cord->n_passes && k < 3; k++)
    thr_text_printf(&words, " %s", known->guide.label[thr_head(known->f, cord->half[k])]);

  thr_text_append(&words, ", end at ");
  thr_guide_place(&known->guide, thr_cord_end(known->f, cord), &words);

  thr_sheets_put_text(flow, THR_BLOCK_TICK, &words);
}

/* Appends the place of a node, in brackets if the piece holds cord already. */
static void put_place(const thr_known *known, int node, bool held, thr_text *words)
{
  thr_text_printf(words, held ? " (%s)" : " %s", known->guide.label[node]);
}

/* Writes the places of the next visits, at most ROW passes of one needle. Returns the visit behind
 * them. With tubes the brackets are about the tube on the way to a place. */
static int put_places(thr_flow *flow, const thr_known *known, int first, int end)
{
  thr_text words = {0};
  const thr_visit *visit = &known->visit[first];
  int part = known->move[first].part;

  /* A visit that starts the cord has no pass: its piece is the first place. */
  bool starts = visit->number == 0, held = starts ? visit->nth > 1 : known->pieces.solid;

  if (starts) visit = &known->visit[++first];

  /* As many passes as a row takes, of one needle. */
  int next = first + 1;
  while (next < end && next < first + ROW && known->move[next].part == part)
    next++;

  thr_needle needle = known->move[first].needle;
  thr_text_printf(&words, "Cord %s%s, ", known->plan->cord[visit->cord].id,
                  needle == THR_NEEDLE_RIGHT  ? ", right needle"
                  : needle == THR_NEEDLE_LEFT ? ", left needle"
                                              : "");

  thr_text_printf(&words, next > first + 1 ? "passes %d-%d:" : "pass %d:", visit->number,
                  known->visit[next - 1].number);
  put_place(known, thr_tail(known->f, visit->in), held, &words);
  thr_text_append(&words, " to");

  /* Each pass leads to the node at the head of its half-edge. */
  for (int i = first; i < next; i++)
    put_place(known, thr_head(known->f, known->visit[i].in), known->visit[i].nth > 1, &words);

  thr_sheets_put_text(flow, THR_BLOCK_TICK, &words);
  return next;
}

void thr_sheets_copies(thr_sheets *sheets, int c)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  char line[160];
  int n = known->plan->n_cords, copies = thr_copies_count(known->copy, n, c);

  if (!copies || flow->why.code) return;

  /* Steps that wait come before this page. */
  thr_sheets_flush(sheets);
  snprintf(line, sizeof line, "Repeat cord %s with %d other cord%s", known->plan->cord[c].id,
           copies, copies == 1 ? "" : "s");
  thr_sheets_page(flow, line, line);

  if (!flow->why.code) put_picture(sheets, c);

  /* First how, for all copies; then the places of each. */
  for (int i = 0; i < n; i++)
    if (i != c && known->copy[i].of == c) put_copy(flow, known, i);

  thr_sheets_put(flow, THR_BLOCK_TITLE, "The places of these cords, in order");
  thr_sheets_put(
      flow, THR_BLOCK_PARAGRAPH,
      known->pieces.solid
          ? "To check by. In brackets: pieces that hold cord already. All others are picked up."
          : "To check by. In brackets: the way there is through a tube that holds cord already. "
            "All others are picked up.");

  for (int i = 0; i < n; i++) {
    if (i == c || known->copy[i].of != c) continue;

    /* put_places returns where the next row begins. */
    int end = thr_sheets_end(known, i);
    for (int k = known->first_visit[i]; k < end && !flow->why.code;)
      k = put_places(flow, known, k, end);
  }
}
