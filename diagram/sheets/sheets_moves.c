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

/* Fills first_pass, first_visit, visited, threaded and move from the visits of all parts. */
static void index_visits(thr_known *known)
{
  int part = -1, first = 0;
  double used = 0;

  /* Passes are numbered cord by cord, as in a scene. */
  for (int c = 0; c < known->plan->n_cords; first += known->plan->cord[c++].n_passes)
    known->first_pass[c] = first;
  for (int i = 0, left = 0; i < known->n_visits; i++, left--) {
    const thr_visit *visit = &known->visit[i];

    /* The next part begins: with solid joints a part that begins a cord has one visit more than
     * passes. */
    if (!left) {
      const thr_part *next = &known->part[++part];
      left = next->end - next->first + (next->begins && known->pieces.solid);
      used = 0;
      if (next->begins) known->first_visit[visit->cord] = i;
    }

    const thr_part *own = &known->part[part];

    /* A visit with a number is led to by that pass; one without a number starts the cord. */
    if (visit->number) used += known->f->length[visit->in >> 1];
    if (visit->number) known->visited[known->first_pass[visit->cord] + visit->number - 1] = i;
    if (visit->nth == 1) known->threaded[visit->piece] = i;

    known->move[i] = (thr_move){.part = part,
                                .needle = own->backward              ? THR_NEEDLE_LEFT
                                          : known->fold[visit->cord] ? THR_NEEDLE_RIGHT
                                                                     : THR_NEEDLE_ONLY,
                                .used = used};
  }
}

thr_status thr_sheets_follow(thr_known *known, thr_err *err)
{
  int n = known->plan->n_cords;

  for (int c = 0; c < n; c++)
    known->n_passes += known->plan->cord[c].n_passes;

  /* A cord has at most one visit more than passes, and at most two parts. */
  size_t most = (size_t)known->n_passes + (size_t)n;
  known->part = thr_calloc(2 * (size_t)n, sizeof *known->part);
  known->move = thr_calloc(most, sizeof *known->move);
  known->visited = thr_calloc((size_t)known->n_passes, sizeof *known->visited);
  known->first_visit = thr_calloc((size_t)n, sizeof *known->first_visit);
  known->first_pass = thr_calloc((size_t)n, sizeof *known->first_pass);
  known->fold = thr_calloc((size_t)n, sizeof *known->fold);
  known->threaded = thr_calloc((size_t)known->pieces.n, sizeof *known->threaded);

  if (!known->part || !known->move || !known->visited || !known->first_visit ||
      !known->first_pass || !known->fold || !known->threaded)
    return thr_nomem(err);

  /* Where a cord's first part does not begin with pass 0, the cord is folded there. */
  known->n_parts = thr_pieces_parts(known->plan, known->copy, known->o.needles, known->part);
  for (int i = 0; i < known->n_parts; i++)
    if (known->part[i].begins) known->fold[known->part[i].cord] = known->part[i].first;

  /* The visits follow from the parts. */
  thr_status st = thr_pieces_follow(&known->pieces, known->part, known->n_parts, &known->visit,
                                    &known->n_visits, err);
  if (!st) index_visits(known);

  return st;
}

int thr_sheets_end(const thr_known *known, int c)
{
  return known->first_visit[c] + known->plan->cord[c].n_passes + known->pieces.solid;
}

int thr_sheets_count_new(const thr_known *known, int first, int end)
{
  int n = 0;

  for (int i = first; i < end; i++)
    n += known->visit[i].nth == 1;
  return n;
}

unsigned char *thr_sheets_piece_states(thr_flow *flow, const thr_known *known, int first, int end)
{
  unsigned char *piece = thr_calloc((size_t)known->pieces.n, sizeof *piece);
  if (!piece) thr_nomem(&flow->why);

  /* A piece is held if a visit before the range picks it up. */
  for (int i = 0; i < known->pieces.n && piece; i++)
    piece[i] = known->threaded[i] < first ? THR_PIECE_HELD
               : known->threaded[i] < end ? THR_PIECE_NEW
                                          : THR_PIECE_LATER;
  return piece;
}

const char (*thr_sheets_labels(const thr_known *known))[THR_LABEL]
{
  return (const char(*)[THR_LABEL])known->guide.label;
}

void thr_sheets_cord_words(const thr_known *known, int c, char words[96])
{
  static const char *const dash[THR_DASHES] = {"", ", dashed", ", dotted", ", dash-dotted"};

  /* Hues repeat after THR_COLOURS paths; dashes tell those apart. */
  int n = known->plan->n_cords, hue = known->copy[c].path;

  /* A single cord needs no colour to be told by. Copies have a pale shade of their path's
   * colour. */
  if (n == 1)
    snprintf(words, 96, "Cord %s", known->plan->cord[c].id);
  else
    snprintf(words, 96, "Cord %s (%s%s%s)", known->plan->cord[c].id,
             known->copy[c].of == c ? "" : "pale ", thr_palette(hue).name,
             dash[hue / THR_COLOURS % THR_DASHES]);
}
