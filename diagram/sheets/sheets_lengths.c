/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says how much cord is drawn through pieces in all, and after which rows a new length is joined
 * on.
 *
 * With one needle, pass k draws the whole rest of the cord through a piece: the sum over passes
 * grows with the square of the cord's length. Folding the cord halves both parts, and so about
 * halves the sum. Where lengths are joined, thr_supplies_join says for all documents.
 *
 * Example: 4 passes of 100 mm draw 300 + 200 + 100 + 0 = 600 mm from the end; from the fold 2 *
 * (100 + 0) = 200 mm. */
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>

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

/* Returns both tails of a length with their knots, in units. */
static double tails_of(const thr_known *known)
{
  return 2 * thr_supplies_tail(&known->supplies) / known->supplies.mm;
}

/* Returns how far the length that begins behind visit i, or with a part, reaches along its part, in
 * units of the framework. */
static double way_from(const thr_known *known, int i, bool with_part)
{
  const int part = known->move[i].part;
  const double from = with_part ? 0 : known->move[i].used;
  int last = with_part ? i : i + 1;

  while (last + 1 < known->n_visits && known->move[last + 1].part == part &&
         !known->supplies.joined[last])
    last++;
  return known->move[last].used - from;
}

/* Returns how long a length of cord c is cut whose way is so long: with its share of what turns
 * take, and its tails. */
static double cut_of(const thr_known *known, int c, double way)
{
  const thr_cut_length cut = thr_supplies_cut(&known->supplies, c);
  return way * (1 + (cut.length > 0 ? cut.turns / cut.length : 0)) + tails_of(known);
}

double thr_sheets_joined_length(const thr_known *known, int i)
{
  return cut_of(known, known->visit[i].cord, way_from(known, i, false));
}

/* Appends the lengths of cord c in the order of work: the first one, and those that are joined on,
 * each after a row. */
static void put_joins(const thr_known *known, int c, thr_text *words)
{
  enum { MOST_NAMED = 100 };
  const int first = known->first_visit[c], end = thr_sheets_end(known, c);
  double way = way_from(known, first, true), fold = 0;
  char length[64];
  int said = 0;

  /* Of a folded cord the first length reaches both ways from the fold. */
  for (int i = first + 1; i < end && known->fold[c]; i++)
    if (known->move[i].part != known->move[i - 1].part) fold = way_from(known, i, true);

  thr_svg_length(cut_of(known, c, way + fold), known->f->units, length);
  thr_text_printf(words, "Cord %s in %d lengths: %s", known->plan->cord[c].id,
                  known->supplies.joins[c] + 1, length);
  if (known->fold[c]) {
    thr_svg_length(cut_of(known, c, fold) - 0.5 * tails_of(known), known->f->units, length);
    thr_text_printf(words, " (fold at %s)", length);
  }

  for (int i = first; i < end && said < MOST_NAMED; i++) {
    if (!known->supplies.joined[i]) continue;
    thr_svg_length(thr_sheets_joined_length(known, i), known->f->units, length);
    thr_text_printf(words, "%s %s after row %d (foot %s)", said++ ? "," : "; joined on:", length,
                    known->visit[i].number, known->guide.label[place_of(known, i)]);
  }
  thr_text_append(words,
                  said < known->supplies.joins[c] ? ", and so on (the rows say it). " : ". ");
}

void thr_sheets_lengths(thr_flow *flow, const thr_known *known)
{
  const double mm = known->supplies.mm, working = known->supplies.working;
  thr_text words = {0};
  char now[64], one[64], why[112] = "";
  bool joined = false;

  /* Without a size in mm nothing is known of an arm's reach. */
  if (!(mm > 0)) return;

  /* What is drawn through in all, and what a single needle would draw. */
  thr_svg_length(drawn_by_needles(known) * mm / 1000, "m", now);
  thr_svg_length(drawn_by_one(known) * mm / 1000, "m", one);

  thr_text_printf(&words, "Drawn through the pieces in all: %s of cord", now);
  if (known->n_parts > known->plan->n_cords)
    thr_text_printf(&words, ", with two needles from the fold; %s with one from the end", one);
  thr_text_append(&words, ". ");
  snprintf(now, sizeof now, "%.3g m", working / 1000);

  /* Where lengths are joined, or why not, and what was assumed. */
  for (int c = 0; c < known->plan->n_cords; c++)
    joined |= known->supplies.joins[c] > 0;
  if (!(known->o.working_mm > 0)) {
    char usual[32] = "more than both arms reach";
    if (working > THR_SUPPLIES_WORKING)
      snprintf(usual, sizeof usual, "%d interfaces", THR_SUPPLIES_WORKING_EDGES);
    snprintf(why, sizeof why, " (taken for the usual: %s; another can be named)", usual);
  }
  if (joined)
    thr_text_printf(
        &words,
        "Lengths are joined on at feet (panel 6), for needles to work with %s%s; each has "
        "a tail at both ends. ",
        now, why);
  for (int c = 0; c < known->plan->n_cords; c++)
    if (known->supplies.joins[c]) put_joins(known, c, &words);

  if (known->supplies.late)
    thr_text_printf(&words,
                    "Where no foot comes within %s%s nothing is joined: keep what the needle does "
                    "not need yet in a coil, and pull it through.",
                    now, joined ? "" : why);
  else if (!joined)
    thr_text_printf(&words, "No needle has more than %s of cord%s: nothing is joined on.", now,
                    why);

  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
}
