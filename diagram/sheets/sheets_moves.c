/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the order of threading: parts, visits, and what is known of each visit.
 *
 * A cord that is threaded from its end is one part; one that is threaded from its fold is two,
 * first with the right needle, then with the left. A visit is one stay of a needle in a piece.
 * Everything that pages ask for is indexed here once: which visit a pass leads to, which visit
 * picks up a piece, how much cord a needle has used. */
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fills first_pass, first_visit, visited, threaded and move from the visits of all parts. */
static void index_visits(thr_sheets *sheets)
{
  int part = -1, first = 0;
  double used = 0;

  /* Passes are numbered cord by cord, as in a scene. */
  for (int c = 0; c < sheets->plan->n_cords; first += sheets->plan->cord[c++].n_passes)
    sheets->first_pass[c] = first;
  for (int i = 0, left = 0; i < sheets->n_visits; i++, left--) {
    const thr_visit *visit = &sheets->visit[i];

    /* The next part begins: with solid joints a part that begins a cord has one visit more than
     * passes. */
    if (!left) {
      const thr_part *next = &sheets->part[++part];
      left = next->end - next->first + (next->begins && sheets->pieces.solid);
      used = 0;
      if (next->begins) sheets->first_visit[visit->cord] = i;
    }

    const thr_part *own = &sheets->part[part];

    /* A visit with a number is led to by that pass; one without a number starts the cord. */
    if (visit->number) used += sheets->f->length[visit->in >> 1];
    if (visit->number) sheets->visited[sheets->first_pass[visit->cord] + visit->number - 1] = i;
    if (visit->nth == 1) sheets->threaded[visit->piece] = i;

    sheets->move[i] = (thr_move){.part = part,
                                 .needle = own->backward               ? THR_NEEDLE_LEFT
                                           : sheets->fold[visit->cord] ? THR_NEEDLE_RIGHT
                                                                       : THR_NEEDLE_ONLY,
                                 .used = used};
  }
}

thr_status thr_sheets_follow(thr_sheets *sheets, thr_err *err)
{
  int n = sheets->plan->n_cords;

  for (int c = 0; c < n; c++)
    sheets->n_passes += sheets->plan->cord[c].n_passes;

  /* A cord has at most one visit more than passes, and at most two parts. */
  size_t most = (size_t)sheets->n_passes + (size_t)n;
  sheets->part = thr_calloc(2 * (size_t)n, sizeof *sheets->part);
  sheets->move = thr_calloc(most, sizeof *sheets->move);
  sheets->step = thr_calloc(most, sizeof *sheets->step);
  sheets->visited = thr_calloc((size_t)sheets->n_passes, sizeof *sheets->visited);
  sheets->first_visit = thr_calloc((size_t)n, sizeof *sheets->first_visit);
  sheets->first_pass = thr_calloc((size_t)n, sizeof *sheets->first_pass);
  sheets->fold = thr_calloc((size_t)n, sizeof *sheets->fold);
  sheets->threaded = thr_calloc((size_t)sheets->pieces.n, sizeof *sheets->threaded);

  if (!sheets->part || !sheets->move || !sheets->step || !sheets->visited || !sheets->first_visit ||
      !sheets->first_pass || !sheets->fold || !sheets->threaded)
    return thr_nomem(err);

  /* Where a cord's first part does not begin with pass 0, the cord is folded there. */
  sheets->n_parts = thr_pieces_parts(sheets->plan, sheets->copy, sheets->o.needles, sheets->part);
  for (int i = 0; i < sheets->n_parts; i++)
    if (sheets->part[i].begins) sheets->fold[sheets->part[i].cord] = sheets->part[i].first;

  /* The visits follow from the parts. */
  thr_status st = thr_pieces_follow(&sheets->pieces, sheets->part, sheets->n_parts, &sheets->visit,
                                    &sheets->n_visits, err);
  if (!st) index_visits(sheets);

  return st;
}

int thr_sheets_end(const thr_sheets *sheets, int c)
{
  return sheets->first_visit[c] + sheets->plan->cord[c].n_passes + sheets->pieces.solid;
}

unsigned char *thr_sheets_piece_states(thr_sheets *sheets, int first, int end)
{
  unsigned char *piece = thr_calloc((size_t)sheets->pieces.n, sizeof *piece);
  if (!piece) thr_nomem(&sheets->why);

  /* A piece is held if a visit before the range picks it up. */
  for (int i = 0; i < sheets->pieces.n && piece; i++)
    piece[i] = sheets->threaded[i] < first ? THR_PIECE_HELD
               : sheets->threaded[i] < end ? THR_PIECE_NEW
                                           : THR_PIECE_LATER;
  return piece;
}

const char (*thr_sheets_labels(const thr_sheets *sheets))[THR_LABEL]
{
  return (const char(*)[THR_LABEL])sheets->guide.label;
}

void thr_sheets_cord_words(const thr_sheets *sheets, int c, char words[96])
{
  static const char *const dash[THR_DASHES] = {"", ", dashed", ", dotted", ", dash-dotted"};

  /* Hues repeat after THR_COLOURS paths; dashes tell those apart. */
  int n = sheets->plan->n_cords, hue = sheets->copy[c].path;

  /* A single cord needs no colour to be told by. Copies have a pale shade of their path's
   * colour. */
  if (n == 1)
    snprintf(words, 96, "Cord %s", sheets->plan->cord[c].id);
  else
    snprintf(words, 96, "Cord %s (%s%s%s)", sheets->plan->cord[c].id,
             sheets->copy[c].of == c ? "" : "pale ", thr_palette(hue).name,
             dash[hue / THR_COLOURS % THR_DASHES]);
}
