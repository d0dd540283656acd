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

int thr_sheets_sections(const thr_known *known, int first, int end)
{
  int n = known->pieces.n, size = n / MOST > SECTION ? n / MOST : SECTION,
      new = thr_sheets_count_new(known, first, end);

  /* Less than half the pieces of a section get no page. */
  return n <= LARGE || 2 * new < size ? 0 : new < size ? 1 : new / size;
}

/* Writes what is laid ready: "30 pieces to lay ready: 12 of kind X-10, 4 of kind T-3, ..". */
static void put_kinds(thr_flow *flow, const thr_known *known, int first, int end)
{
  thr_text words = {0};
  const int n = thr_sheets_count_new(known, first, end);
  int *count = thr_calloc((size_t)known->pieces.n_kinds + 1, sizeof *count);
  const char *before = "";

  if (!count) {
    thr_nomem(&flow->why);
    return;
  }

  /* Count the new pieces by kind; kinds are numbered from 1. */
  for (int i = first; i < end; i++)
    if (known->visit[i].nth == 1) count[known->pieces.kind[known->visit[i].piece]]++;

  thr_text_printf(&words, "%d %s to lay ready: ", n, thr_pieces_word(known->plan, n));

  /* In the order of kinds, those without a new piece left out. */
  for (int k = 1; k <= known->pieces.n_kinds; k++) {
    char name[24];
    if (!count[k]) continue;
    thr_pieces_kind_name(&known->pieces, k, name);
    thr_text_printf(&words, "%s%d of kind %s", before, count[k], name);
    before = ", ";
  }

  thr_text_append(&words, ".");
  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
  free(count);
}

/* Draws the whole framework with the pieces of the section bold, earlier ones grey, later ones
 * dashed, and no cord, in the same projection as the pictures of steps. */
static void put_map(thr_sheets *sheets, int first, int end)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  unsigned char *piece = thr_sheets_piece_states(flow, known, first, end);
  unsigned char *state = thr_calloc((size_t)known->n_passes, sizeof *state);
  if (!state) thr_nomem(&flow->why);

  /* A map is about pieces: no pass is drawn. */
  for (int i = 0; i < known->n_passes && state; i++)
    state[i] = THR_DRAW_HIDDEN;

  thr_sheets_whole(sheets, known->in_space, state, piece, thr_sheets_bottom(flow) - THR_STEP_LEGEND,
                   &sheets->map_pitch);
  free(piece);
  free(state);
}

void thr_sheets_section(thr_sheets *sheets, int nth, int n, int first, int end, int steps)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  char title[128], of_all[32] = "";
  const char *id = known->plan->cord[known->visit[first].cord].id;

  /* Steps that wait come before this page. They are numbered on from those that are laid out. */
  thr_sheets_flush(sheets);
  if (n > 1) snprintf(of_all, sizeof of_all, " %d of %d", nth, n);
  snprintf(title, sizeof title, "Section%s of cord %.11s: steps %d to %d", of_all, id,
           sheets->n_steps + 1, sheets->n_steps + steps);

  /* The legend stands below the map. */
  if (!flow->why.code) thr_sheets_page(flow, title, title);
  if (!flow->why.code) put_kinds(flow, known, first, end);
  if (!flow->why.code) put_map(sheets, first, end);
  if (!flow->why.code) thr_step_put_legend(flow, thr_sheets_bottom(flow) - 1, "section");
}
