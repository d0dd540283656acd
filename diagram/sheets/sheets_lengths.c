/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says how much cord is drawn through pieces in all, and after which rows a new length is joined
 * on.
 *
 * With one needle, pass k draws the whole rest of the cord through a piece: the sum over passes
 * grows with the square of the cord's length. Folding the cord halves both parts, and so about
 * halves the sum. A maker who works with lengths of working_mm joins a new one at the last foot
 * that the length reaches, where a knot keeps no faces apart.
 *
 * Example: 4 passes of 100 mm draw 300 + 200 + 100 + 0 = 600 mm from the end; from the fold 2 *
 * (100 + 0) = 200 mm. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>

enum { MOST_NAMED = 8 }; /* rows to join at that are named */

/* Returns the sum over all rows of the cord that the needle has yet to use then, in units. */
static double drawn_by_needles(const thr_known *known)
{
  double drawn = 0, whole = 0;

  /* Backwards, since the last visit of a part knows how much the part uses in all. */
  for (int i = known->n_visits - 1; i >= 0; i--) {
    if (i + 1 == known->n_visits || known->move[i].part != known->move[i + 1].part)
      whole = known->move[i].used;
    if (known->visit[i].number) drawn += whole - known->move[i].used;
  }

  return drawn;
}

/* Returns the same sum with a single needle for each cord, from its start, in units. */
static double drawn_by_one(const thr_known *known)
{
  double drawn = 0;
  for (int c = 0; c < known->plan->n_cords; c++) {
    const thr_cord *cord = &known->plan->cord[c];

    /* What is behind the needle after each pass. */
    double rest = thr_cord_length(known->f, cord);

    for (int k = 0; k < cord->n_passes; k++)
      drawn += rest -= known->f->length[cord->half[k] >> 1];
  }
  return drawn;
}

/* Returns the node at which the needle comes out at a visit. */
static int place_of(const thr_known *known, int i)
{
  const thr_visit *visit = &known->visit[i];
  return visit->number ? thr_head(known->f, visit->in) : visit->piece;
}

/* Appends the joins of the part that begins with visit `first`: each at the last foot that a length
 * of `working` units reaches. Returns the visit behind the part. *said counts joins; *late is set
 * if a stretch without a foot is longer than a length. */
static int put_joins(const thr_known *known, int first, double working, int *said, bool *late,
                     thr_text *words)
{
  double from = 0;
  int i = first, foot = -1;

  for (; i < known->n_visits && known->move[i].part == known->move[first].part; i++) {
    /* The last foot behind the last join at which a length could end. */
    bool more = i + 1 < known->n_visits && known->move[i + 1].part == known->move[i].part;
    if (known->move[i].used > from && known->f->foot[place_of(known, i)]) foot = i;

    /* The length still reaches the end of the next pass. */
    if (!more || known->move[i + 1].used - from <= working) continue;

    /* No foot within reach: nothing can be joined before the next one. */
    if (foot < 0) {
      *late = true;
      continue;
    }

    /* The new length begins at that foot. */
    from = known->move[foot].used;
    if ((*said)++ < MOST_NAMED)
      thr_text_printf(words, "%scord %s after row %d (foot %s)", *said > 1 ? ", " : "",
                      known->plan->cord[known->visit[foot].cord].id, known->visit[foot].number,
                      known->guide.label[place_of(known, foot)]);
    foot = -1;
  }
  return i;
}

void thr_sheets_lengths(thr_flow *flow, const thr_known *known)
{
  double mm = known->supplies.mm,
         working = known->o.working_mm > 0 ? known->o.working_mm : THR_SHEETS_WORKING;
  thr_text words = {0}, joins = {0};
  char now[64], one[64];

  int said = 0;
  bool late = false;

  /* Without a size in mm no length of cord can be compared with an arm's reach. */
  if (!(mm > 0)) return;

  /* What is drawn through in all, and what a single needle would draw. */
  thr_svg_length(drawn_by_needles(known) * mm / 1000, "m", now);
  thr_svg_length(drawn_by_one(known) * mm / 1000, "m", one);

  thr_text_printf(&words, "Drawn through the pieces in all: %s of cord", now);
  if (known->n_parts > known->plan->n_cords)
    thr_text_printf(&words, ", with two needles from the fold; %s with one from the end", one);
  thr_text_append(&words, ". ");

  /* Part by part, since each begins with a new end of cord. */
  for (int i = 0; i < known->n_visits;)
    i = put_joins(known, i, working / mm, &said, &late, &joins);
  snprintf(now, sizeof now, "%g m", working / 1000);

  /* Where lengths are joined, or why not. */
  if (said)
    thr_text_printf(&words, "With lengths of %s a new one is joined on: %s%s. ", now,
                    joins.data ? joins.data : "", said > MOST_NAMED ? ", .." : "");

  if (late)
    thr_text_printf(&words,
                    "Where no foot comes within %s nothing is joined: keep what the needle does "
                    "not need yet in a coil, and pull it through.",
                    now);
  else if (!said)
    thr_text_printf(&words, "No needle has more than %s of cord: nothing is joined on.", now);

  words.failed |= joins.failed;
  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
  thr_text_destroy(&joins);
}
