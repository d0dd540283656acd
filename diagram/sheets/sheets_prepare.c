/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the pages "Prepare first": how the steps are read, the cords to cut, the feet, the
 * pieces to make.
 *
 * The cut list has a row per cord, the table of pieces a row per kind. Kinds that a framework has
 * only once, as on a free form, would fill pages with rows that no step refers to: these are
 * counted together by letter, cords and bore.
 *
 * Example: 40 kinds X-1 .. X-40 of one piece each, 2 cords in a bore of 3.2 mm, become the row "X
 * 40 pieces  4 arms  2 cords  3.20 mm". */
#include "diagram/sheets/sheets_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- cords ---- */

/* Writes a length in units without naming the unit: to a tenth of a mm where the size of a unit is
 * known (1000 mm a unit: 4 decimals), else with five digits. Returns cell. */
static const char *length_cell(const thr_known *known, double length, char cell[32])
{
  if (known->supplies.mm > 0)
    snprintf(cell, 32, "%.*f", 1 + (int)nearbyint(log10(known->supplies.mm)), length);
  else
    snprintf(cell, 32, "%.5g", length);
  return cell;
}

/* Returns whether any cord is threaded from its fold with two needles, which makes two parts of
 * it. */
static bool some_folded(const thr_known *known)
{
  return known->n_parts > known->plan->n_cords;
}

/* Writes the row of cord c in the cut list; column: the columns' places (thr_sheets_cells). */
static void put_cord(thr_flow *flow, const thr_known *known, int c, const double *column)
{
  const thr_cord *cord = &known->plan->cord[c];
  const thr_cut_length cut = thr_supplies_cut(&known->supplies, c);
  const double tails = cut.tails + cut.knots;
  const double allowance[4] = {tails, cut.turns, cut.joins, cut.cut};
  char words[96], length[32], allowed[4][32], folded[32] = "";
  double fold = tails / 2;

  /* Allowances are in mm of cord and bore: without a size they stay open. */
  for (int i = 0; i < 4; i++)
    if (known->supplies.mm > 0)
      length_cell(known, allowance[i], allowed[i]);
    else
      snprintf(allowed[i], sizeof allowed[i], "-");

  /* The fold lies between two passes: count tail, knot and all passes before. Only cords that are
   * threaded from their middle have one to mark, and if they are cut in one. */
  for (int k = 0; k < known->fold[c]; k++)
    fold += known->f->length[cord->half[k] >> 1];
  if (known->fold[c] && !known->supplies.joins[c]) length_cell(known, fold, folded);

  thr_sheets_cord_words(known, c, words);
  thr_sheets_cells(flow, column, false, "%s\t%d\t%s\t%s\t%s\t%s\t%s\t%s\t%.30s - %.30s", words,
                   cord->n_passes, length_cell(known, cut.length, length), allowed[0], allowed[1],
                   allowed[2], allowed[3], folded,
                   known->guide.label[thr_cord_start(known->f, cord)],
                   known->guide.label[thr_cord_end(known->f, cord)]);
}

/* Writes the cut list: a heading with the cord's thickness, a row per cord, and what "cut" adds
 * up. */
static void put_cords(thr_flow *flow, const thr_known *known)
{
  static const double column[9] = {0, -58, -75, -90, -104, -118, -134, -150, 153};
  char cord[32] = "";

  if (known->supplies.mm > 0) snprintf(cord, sizeof cord, ", %.3g mm thick", known->supplies.cord);
  thr_sheets_put(flow, THR_BLOCK_TITLE, "Cut these cords (lengths in %s%s)", known->f->units, cord);

  /* The column of folds stays empty where no cord has one. */
  thr_sheets_cells(flow, column, true,
                   "cord\tpasses\tlength\ttails\tturns\tjoins\tcut\t%s\tfrom - to",
                   some_folded(known) ? "fold at" : "");
  for (int c = 0; c < known->plan->n_cords; c++)
    put_cord(flow, known, c, column);
  flow->y += 1;

  /* How the cut length comes about, or what is missing in it. */
  if (known->supplies.mm > 0)
    thr_sheets_put(
        flow, THR_BLOCK_PARAGRAPH,
        "Cut = length through the middles of the pieces + a tail of %.0f mm at each end, %.0f mm "
        "to "
        "hold and the rest for an overhand knot + what turns take at most where the cord lies at "
        "the outside of its bores + two tails for each join.%s",
        thr_supplies_tail(&known->supplies), THR_SUPPLIES_TAIL,
        some_folded(known)
            ? " Fold at: from the end that comes out at the first place of the last column."
            : "");
  else
    thr_sheets_put(
        flow, THR_BLOCK_PARAGRAPH,
        "The size of cord and pieces is not known: add tails, knots and what turns take.");

  thr_sheets_lengths(flow, known);
}

/* ---- pieces ---- */

/* Returns the most cords in one arm of a piece, or in a tube. */
static int most_cords(const thr_known *known, int piece)
{
  int most = 0;
  if (!known->pieces.solid) return known->supplies.passes[piece];

  /* An arm of a solid piece is half an edge: as many cords as the edge has passes. */
  for (int i = known->f->first[piece]; i < known->f->first[piece + 1]; i++) {
    int n = known->supplies.passes[known->f->half[i] >> 1];
    most = n > most ? n : most;
  }

  return most;
}

/* A row of the table of kinds: one kind; or several kinds of a single piece each that agree in
 * letter, cords and bore, counted together. */
typedef struct {
  char name[24]; /* "X-10", or "X" of several kinds */
  int model;     /* a piece of the kind */
  int pieces;    /* how many pieces to make */
  int cords;     /* the most in one arm of a piece, or in a tube */
  double bore;   /* the widest that a piece needs, in cord diameters */
} kind_row;

/* Writes the five cells of a row of the table of kinds. */
static void put_kind(const thr_known *known, const kind_row *kind, char cells[160])
{
  char measure[32], bore[32];

  /* The number of arms describes a solid piece, the length a tube. */
  if (known->pieces.solid)
    snprintf(measure, sizeof measure, "%d", thr_pieces_arms(&known->pieces, kind->model));
  else
    length_cell(known, known->f->length[kind->model], measure);

  /* A bore is given in mm if sizes are known, else in cord diameters. */
  if (known->supplies.mm > 0)
    snprintf(bore, sizeof bore, "%.2f mm", thr_supplies_bore_mm(&known->supplies, kind->bore));
  else
    snprintf(bore, sizeof bore, "%.2f cords", kind->bore);
  snprintf(cells, 160, "%s\t%d\t%s\t%d\t%s", kind->name, kind->pieces, measure, kind->cords, bore);
}

/* Writes n rows of the table of kinds, two beside each other on a line. */
static void put_kinds(thr_flow *flow, const thr_known *known, const kind_row *row, int n)
{
  static const double column[] = {-14, -28, -48, -64, -86, -109, -123, -143, -159, -181};
  char left[160], right[160];

  /* The heading, over both halves of the table if both are used. */
  snprintf(left, sizeof left, "kind\tpieces\t%s\tcords\tbore",
           known->pieces.solid ? "arms" : "length");
  thr_sheets_cells(flow, column, true, "%s%s%s", left, n > 1 ? "\t" : "", n > 1 ? left : "");

  for (int k = 0; k < n; k += 2) {
    const bool both = k + 1 < n;
    put_kind(known, &row[k], left);
    if (both) put_kind(known, &row[k + 1], right);
    thr_sheets_cells(flow, column, false, "%s%s%s", left, both ? "\t" : "", both ? right : "");
  }
}

/* Fills row[k - 1] for every kind k = 1, 2, ..: its pieces, and the most cords and the widest bore
 * that one of them needs, so that all pieces of a kind can be made alike. */
static void find_kinds(const thr_known *known, kind_row *row)
{
  const thr_pieces *pieces = &known->pieces;

  /* What a kind is by itself. */
  for (int k = 0; k < pieces->n_kinds; k++) {
    thr_pieces_kind_name(pieces, k + 1, row[k].name);
    row[k].model = pieces->model[k + 1];
    row[k].pieces = pieces->members[k + 1];
  }

  /* What its pieces need: the maximum over all of them. */
  for (int i = 0; i < pieces->n; i++) {
    kind_row *kind = &row[pieces->kind[i] - 1];
    int cords = most_cords(known, i);
    double bore = pieces->solid ? thr_supplies_node_bore(&known->supplies, i)
                                : thr_supplies_bore(&known->supplies, i);

    kind->cords = cords > kind->cords ? cords : kind->cords;
    kind->bore = fmax(kind->bore, bore);
  }
}

/* Merges the rows of kinds that have a single piece where letter, cords and bore agree. Returns how
 * many rows are left of n; they stay in order. */
static int count_together(kind_row *row, int n)
{
  int left = 0;
  for (int k = 0; k < n; k++) {
    kind_row kind = row[k];
    int same = left;

    /* Without its number, "X-10" becomes "X"; look for a row that it can be added to. */
    if (kind.pieces == 1) {
      kind.name[strcspn(kind.name, "-")] = '\0';
      for (same = 0; same < left; same++)
        if (strcmp(row[same].name, kind.name) == 0 && row[same].cords == kind.cords &&
            fabs(row[same].bore - kind.bore) < 1e-9)
          break;
    }

    /* No such row: this one stays. Larger kinds always do. */
    if (same == left)
      row[left++] = kind;
    else
      row[same].pieces++;
  }

  return left;
}

/* Writes the table of the pieces to make, kind by kind. */
static void put_pieces(thr_flow *flow, const thr_known *known)
{
  const thr_pieces *pieces = &known->pieces;
  char unit[64] = "";
  kind_row *row = thr_calloc((size_t)pieces->n_kinds, sizeof *row);
  if (!row) {
    thr_nomem(&flow->why);
    return;
  }

  /* Kinds that no step calls by their numbers are counted by their letters. */
  find_kinds(known, row);
  const bool together = pieces->solid && pieces->single > THR_PIECES_SINGLE;

  /* The heading counts pieces and kinds, before any are merged. */
  if (!pieces->solid) snprintf(unit, sizeof unit, " (lengths in %s)", known->f->units);
  thr_sheets_put(flow, THR_BLOCK_TITLE, "%d %s in %d kind%s by shape%s", pieces->n,
                 thr_pieces_word(known->plan, pieces->n), pieces->n_kinds,
                 pieces->n_kinds == 1 ? "" : "s", unit);

  /* Merging happens in place, so the number of rows comes from the call. */
  put_kinds(flow, known, row, together ? count_together(row, pieces->n_kinds) : pieces->n_kinds);
  if (together)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Letters without a number: so many pieces, each one of a kind.");

  free(row);
}

/* Writes the places of all feet in a line, or "None.". */
static void put_feet(thr_flow *flow, const thr_known *known)
{
  thr_text words = {0};

  /* Two blanks between names. */
  for (int v = 0; v < known->f->n_nodes; v++)
    if (known->f->foot[v])
      thr_text_printf(&words, "%s%s", words.length ? "  " : "", known->guide.label[v]);
  thr_text_append(&words, words.length ? "." : "None.");

  thr_sheets_put(flow, THR_BLOCK_TITLE, "Feet");
  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
}

/* ---- how to read ---- */

/* Explains the rows of steps, the names of pieces, the looks in pictures and, if any cord has a
 * fold, the order of the two needles. Solid joints and tubes are read in different ways. */
static void put_reading(thr_flow *flow, const thr_known *known)
{
  thr_sheets_put(flow, THR_BLOCK_TITLE, "How to read the steps");

  /* What a row says. */
  thr_sheets_put(
      flow, THR_BLOCK_PARAGRAPH,
      known->pieces.solid
          ? "Each row is a piece that the needle comes to. Pick up: a new piece goes on the cord. "
            "Through: it is on a cord already. In from A5, out to C5: arms are called by the "
            "pieces that they face; all pieces lie with the side of their names up and turned as "
            "in the picture. The number of a row is that in the picture, on the arm by which the "
            "cord "
            "comes in. S: the cord starts in this piece."
          : "Each row is a tube that the needle comes to. Pick up: a new tube goes on the cord. "
            "Through: it is on a cord already, and the needle goes the way that the cord in it "
            "went last; back through: against that way. The number of a row is that in the "
            "picture.");

  /* What a name says. */
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "%s%s",
                 known->pieces.solid
                     ? "A piece has its kind in the box, by letter and number, and its place in "
                       "the whole: X-10 (B5) is one of kind X-10 that comes to B5. Put its place "
                       "on it when it goes on the cord: later rows call it by that."
                     : "Tube 4 (11-17) is one of kind 4 that comes between the places 11 and 17: "
                       "later rows call it by these.",
                 known->plan->n_cords > 1
                     ? " With a colon, A:5 is no piece, but pass 5 of cord A: there it is drawn in "
                       "that cord's colour."
                     : "");

  /* What a picture says. */
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                 "In the pictures pieces to pick up have a bold outline, those that are on a cord "
                 "are grey, those that wait are dashed. Grey lines are earlier passes, coloured "
                 "ones those of the step. The small picture shows where they are. S: a cord "
                 "starts. E: it ends.");

  /* Two needles, if any cord needs them. */
  if (some_folded(known))
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Cords that have a fold in the cut list are threaded from there with a needle "
                   "at each end: first the right needle, to the end of the cord, then the left "
                   "needle from the fold back to its start, with falling numbers.");
}

void thr_sheets_prepare(thr_flow *flow, const thr_known *known)
{
  thr_sheets_page(flow, "Prepare first", "Prepare first (continued)");
  put_reading(flow, known);
  put_cords(flow, known);
  put_feet(flow, known);
  put_pieces(flow, known);
  flow->y += 1;
  thr_sheets_put(
      flow, THR_BLOCK_PARAGRAPH, "%s",
      known->pieces.solid
          ? "Cords: the most in one arm of such a piece; the bore holds them side by side. "
            "Which piece is of which kind, and which way the cords take through each: the "
            "tables of beads and of channels, files of their own. Printed pieces of a kind that "
            "differ inside or by their names have a letter more: T-2a and T-2b are of kind T-2."
          : "Cords: the most in one tube of such a kind; the bore holds them side by side. Tubes "
            "of "
            "a kind are alike but for their cut ends, and are not drawn one by one: which tube is "
            "of which kind is in the table of beads, a file of its own.");
}
