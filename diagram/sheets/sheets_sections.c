/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Divides large frameworks into sections: before some hundred pieces a page with a map of where
 * they go, and how many pieces of which kind to lay ready.
 *
 * A section has at least max(SECTION, pieces / MOST) new pieces. Example: 1000 pieces in one path
 * make six sections of 166 pieces; 3000 pieces make twelve of 250. */
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>
#include <stdlib.h>

enum {
  LARGE = 300,   /* a framework of more pieces has sections */
  SECTION = 150, /* new pieces of a section, at least */
  MOST = 12      /* sections of a framework, about */
};

/* Returns how many pieces are picked up in visits first .. end - 1. */
static int count_new(const thr_sheets *sheets, int first, int end)
{
  int n = 0;

  for (int i = first; i < end; i++)
    n += sheets->visit[i].nth == 1;
  return n;
}

int thr_sheets_sections(const thr_sheets *sheets, int first, int end)
{
  int n = sheets->pieces.n, size = n / MOST > SECTION ? n / MOST : SECTION,
      new = count_new(sheets, first, end);

  /* Less than half the pieces of a section get no page. */
  return n <= LARGE || 2 * new < size ? 0 : new < size ? 1 : new / size;
}

/* Writes what is laid ready: "30 pieces to lay ready: 12 of kind X-10, 4 of kind T-3, ..". */
static void put_kinds(thr_sheets *sheets, int first, int end)
{
  thr_text words = {0};
  int *count = thr_calloc((size_t)sheets->pieces.n_kinds + 1, sizeof *count);
  bool any = false;

  if (!count) {
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
    return;
  }

  /* Count the new pieces by kind; kinds are numbered from 1. */
  for (int i = first; i < end; i++)
    if (sheets->visit[i].nth == 1) count[sheets->pieces.kind[sheets->visit[i].piece]]++;

  thr_text_printf(&words, "%d %s to lay ready: ", count_new(sheets, first, end),
                  thr_pieces_word(sheets->plan, count_new(sheets, first, end)));

  /* In the order of kinds, those without a new piece left out. */
  for (int k = 1; k <= sheets->pieces.n_kinds; k++) {
    char name[24];
    if (!count[k]) continue;
    thr_pieces_kind_name(&sheets->pieces, k, name);
    thr_text_printf(&words, "%s%d of kind %s", any ? ", " : "", count[k], name);
    any = true;
  }

  /* The list ends with a full stop. */
  thr_text_append(&words, ".");
  if (words.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else
    thr_sheets_paragraph(sheets, 0, words.data);

  thr_text_destroy(&words);
  free(count);
}

/* Draws the whole framework with the pieces of the section bold, earlier ones grey, later ones
 * dashed, and no cord. */
static thr_status put_map(thr_sheets *sheets, int first, int end, thr_err *err)
{
  unsigned char *piece = thr_calloc((size_t)sheets->pieces.n, sizeof *piece);
  unsigned char *state = thr_calloc((size_t)sheets->n_passes, sizeof *state);
  thr_box paper = {THR_SHEET_MARGIN, sheets->y, sheets->size[0] - THR_SHEET_MARGIN,
                   thr_sheets_bottom(sheets) - THR_STEP_LEGEND};

  thr_status st = piece && state ? THR_OK : thr_nomem(err);

  /* A piece is held if a visit before the section picks it up. */
  for (int i = 0; i < sheets->pieces.n && !st; i++)
    piece[i] = sheets->threaded[i] < first ? THR_PIECE_HELD
               : sheets->threaded[i] < end ? THR_PIECE_NEW
                                           : THR_PIECE_LATER;

  /* A map is about pieces: no pass is drawn. */
  for (int i = 0; i < sheets->n_passes && !st; i++)
    state[i] = THR_DRAW_HIDDEN;

  /* The same projection as the pictures of steps. */
  if (!st && sheets->in_space)
    st = thr_space_whole(&sheets->space, piece, paper, thr_sheets_out(sheets), err);
  if (!st && !sheets->in_space)
    st = thr_crop_whole(sheets->plan, &sheets->guide.layout, state, piece, paper,
                        &sheets->map_pitch, sheets->limits, thr_sheets_out(sheets), err);

  free(piece);
  free(state);
  return st;
}

void thr_sheets_section(thr_sheets *sheets, int nth, int n, int first, int end, int steps)
{
  char title[128];
  const char *id = sheets->plan->cord[sheets->visit[first].cord].id;

  /* Steps that wait come before this page. */
  thr_sheets_flush(sheets);

  /* Steps are numbered on from those that are laid out. */
  if (n > 1)
    snprintf(title, sizeof title, "Section %d of %d of cord %.11s: steps %d to %d", nth, n, id,
             sheets->n_steps + 1, sheets->n_steps + steps);
  else
    snprintf(title, sizeof title, "Section of cord %.11s: steps %d to %d", id, sheets->n_steps + 1,
             sheets->n_steps + steps);

  if (!sheets->st) thr_sheets_page(sheets, title, title);
  if (!sheets->st) put_kinds(sheets, first, end);

  thr_status st = sheets->st ? sheets->st : put_map(sheets, first, end, &sheets->why);
  if (st) {
    thr_sheets_fail(sheets, st, NULL);
    return;
  }

  /* The legend stands below the map. */
  thr_step_put_legend(sheets, thr_sheets_bottom(sheets) - 1, "section");
}
