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
  unsigned char *state = thr_calloc((size_t)sheets->n_passes, sizeof *state);

  if (!state) {
    thr_nomem(&sheets->why);
    return;
  }

  /* All passes of a cord have its state; i counts them in the order of the scene. */
  for (int c = 0, i = 0; c < sheets->plan->n_cords; c++) {
    unsigned char own = sheets->copy[c].of == path  ? THR_DRAW_NOW
                        : sheets->copy[c].of < path ? THR_DRAW_EARLIER
                                                    : THR_DRAW_HIDDEN;
    for (int k = 0; k < sheets->plan->cord[c].n_passes; k++)
      state[i++] = own;
  }

  /* The lower half of the page is for the words, with two lines of air above them. */
  double bottom = sheets->y + 0.52 * (thr_sheets_bottom(sheets) - sheets->y);
  thr_sheets_whole(sheets, false, state, NULL, bottom, NULL);
  sheets->y = bottom + 2 * THR_SHEET_LINE;
  free(state);
}

/* Writes how a copy repeats its path: by which symmetry, where it starts, its first places, where
 * it ends. */
static void put_copy(thr_sheets *sheets, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &sheets->plan->cord[c];

  /* "turned by 90 degrees": the symmetry, as far as it has a name. */
  thr_copies_words(sheets->plan, sheets->copy, c, sheets->o.motion, how);
  thr_text_printf(&words, "Repeat as cord %s%s: start at ", cord->id, how);
  thr_guide_place(&sheets->guide, thr_cord_start(sheets->f, cord), &words);

  /* Three places show the direction. */
  thr_text_append(&words, ", first to");
  for (int k = 0; k < cord->n_passes && k < 3; k++)
    thr_text_printf(&words, " %s", sheets->guide.label[thr_head(sheets->f, cord->half[k])]);

  thr_text_append(&words, ", end at ");
  thr_guide_place(&sheets->guide, thr_cord_end(sheets->f, cord), &words);

  thr_sheets_put_text(sheets, THR_BLOCK_TICK, &words);
}

/* Appends the place of a node, in brackets if the piece holds cord already. */
static void put_place(const thr_sheets *sheets, int node, bool held, thr_text *words)
{
  thr_text_printf(words, held ? " (%s)" : " %s", sheets->guide.label[node]);
}

/* Writes the places of the next visits, at most ROW passes of one needle. Returns the visit behind
 * them. With tubes the brackets are about the tube on the way to a place. */
static int put_places(thr_sheets *sheets, int first, int end)
{
  thr_text words = {0};
  const thr_visit *visit = &sheets->visit[first];
  int part = sheets->move[first].part;

  /* A visit that starts the cord has no pass: its piece is the first place. */
  bool starts = visit->number == 0, held = starts ? visit->nth > 1 : sheets->pieces.solid;

  if (starts) visit = &sheets->visit[++first];

  /* As many passes as a row takes, of one needle. */
  int next = first + 1;
  while (next < end && next < first + ROW && sheets->move[next].part == part)
    next++;

  thr_needle needle = sheets->move[first].needle;
  thr_text_printf(&words, "Cord %s%s, ", sheets->plan->cord[visit->cord].id,
                  needle == THR_NEEDLE_RIGHT  ? ", right needle"
                  : needle == THR_NEEDLE_LEFT ? ", left needle"
                                              : "");

  thr_text_printf(&words, next > first + 1 ? "passes %d-%d:" : "pass %d:", visit->number,
                  sheets->visit[next - 1].number);
  put_place(sheets, thr_tail(sheets->f, visit->in), held, &words);
  thr_text_append(&words, " to");

  /* Each pass leads to the node at the head of its half-edge. */
  for (int i = first; i < next; i++)
    put_place(sheets, thr_head(sheets->f, sheets->visit[i].in), sheets->visit[i].nth > 1, &words);

  thr_sheets_put_text(sheets, THR_BLOCK_TICK, &words);
  return next;
}

void thr_sheets_copies(thr_sheets *sheets, int c)
{
  char line[160];
  int n = sheets->plan->n_cords, copies = thr_copies_count(sheets->copy, n, c);

  if (!copies || sheets->why.code) return;

  /* Steps that wait come before this page. */
  thr_sheets_flush(sheets);
  snprintf(line, sizeof line, "Repeat cord %s with %d other cord%s", sheets->plan->cord[c].id,
           copies, copies == 1 ? "" : "s");
  thr_sheets_page(sheets, line, line);

  if (!sheets->why.code) put_picture(sheets, c);

  /* First how, for all copies; then the places of each. */
  for (int i = 0; i < n; i++)
    if (i != c && sheets->copy[i].of == c) put_copy(sheets, i);

  thr_sheets_put(sheets, THR_BLOCK_TITLE, "The places of these cords, in order");
  thr_sheets_put(
      sheets, THR_BLOCK_PARAGRAPH,
      sheets->pieces.solid
          ? "To check by. In brackets: pieces that hold cord already. All others are picked up."
          : "To check by. In brackets: the way there is through a tube that holds cord already. "
            "All others are picked up.");

  for (int i = 0; i < n; i++) {
    if (i == c || sheets->copy[i].of != c) continue;

    /* put_places returns where the next row begins. */
    int end = thr_sheets_end(sheets, i);
    for (int k = sheets->first_visit[i]; k < end && !sheets->why.code;)
      k = put_places(sheets, k, end);
  }
}
