/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes what a step says: its heading with number, cord, passes and tally; a row to tick off for
 * every visit; what to do before the first row; and a check of where the needle is after the last.
 *
 * Rows stand in two columns of nearly equal height. Texts are made before the step is placed, since
 * their height decides which steps share a page (sheets_steps.c).
 *
 * Example of a row: "[ ] 17  pick up X-10 (B5): in from A5, out to C5". */
#include "diagram/sheets/sheets_parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double NUMBER = 9;   /* mm: the number of a step */
static const double LOCATOR = 44; /* mm: width of the small picture in the corner */
static const double BOX = 5;      /* mm from the left edge of a box to tick to the number */
static const double COUNT = 8;    /* mm for the number of a row, with the blank behind it */
static const double AFTER = 0.7;  /* mm after a row */

/* Returns the width of one of the two columns of rows, mm. */
static double column_width(const thr_flow *flow)
{
  return 0.5 * (thr_sheets_width(flow) - 4);
}

/* Returns the distance between two lines of a row, mm. */
static double line_height(void)
{
  return 1.45 * THR_SHEET_SMALL;
}

/* ---- what is said beside the rows ---- */

/* Returns the node at which the needle is before a visit. */
static int place_before(const thr_known *known, int i)
{
  const thr_visit *visit = &known->visit[i];
  return visit->number ? thr_tail(known->f, visit->in) : visit->piece;
}

/* Appends what is done before the first visit of a needle: where the tail is left, or where the
 * fold lies. Appends nothing in other steps. */
static void put_beginning(const thr_known *known, int i, thr_text *text)
{
  thr_needle needle = known->move[i].needle;

  /* Only the first step of a needle has a beginning. */
  if (!thr_step_begins(known, i)) return;

  /* Threaded from its end: a tail stays there, to be pulled and knotted. */
  if (needle == THR_NEEDLE_ONLY) {
    thr_text_append(text, "Begin at ");
    thr_guide_place(&known->guide, place_before(known, i), text);
    thr_text_printf(text, ": leave a tail of %.0f mm there%s.", thr_supplies_tail(&known->supplies),
                    known->supplies.mm > 0 ? "" : " and a knot's length");
  } else {
    thr_text_printf(text, needle == THR_NEEDLE_RIGHT
                              ? "Right needle first: the fold of the cord lies at "
                              : "Now the left needle, from the fold of the cord at ");
    thr_guide_place(&known->guide, place_before(known, i), text);
    thr_text_append(text, ".");
  }
}

/* Appends the sentence by which a maker checks a step: "Check: the needle comes out of F12 and
 * points at E12." With tubes: "Check: the needle comes out at F12; next E12." */
static void put_check(const thr_known *known, int last, thr_text *text)
{
  const thr_visit *visit = &known->visit[last];
  thr_needle needle = known->move[last].needle;
  int at = visit->number ? thr_head(known->f, visit->in) : visit->piece;
  bool solid = known->pieces.solid;

  /* Which needle, if there are two, and where it is. */
  thr_text_printf(text, "Check: the %sneedle comes out %s ",
                  needle == THR_NEEDLE_RIGHT  ? "right "
                  : needle == THR_NEEDLE_LEFT ? "left "
                                              : "",
                  solid ? "of" : "at");

  thr_guide_place(&known->guide, at, text);

  /* Within a part the next place tells the direction; at its end there is none. */
  if (!thr_step_ends(known, last))
    thr_text_printf(text, solid ? " and points at %s." : "; next %s.",
                    known->guide.label[thr_head(known->f, known->visit[last + 1].in)]);
  else if (needle == THR_NEEDLE_RIGHT)
    thr_text_append(text, ": the end of the cord. Leave it there and go on with the left needle.");
  else
    thr_text_append(text, needle == THR_NEEDLE_LEFT ? ": the start of the cord."
                                                    : ": the end of the cord.");
}

void thr_step_destroy_text(thr_step *step)
{
  for (int i = 0; i < step->n_rows; i++)
    thr_text_destroy(&step->row[i]);
  thr_text_destroy(&step->before);
  thr_text_destroy(&step->after);
  step->n_rows = 0;
}

/* Returns how many lines words take in a width, 0 for an empty text. Fails the sheets if memory ran
 * out while the text was made. */
static int count_lines(thr_flow *flow, const thr_text *words, double width, double size)
{
  if (words->failed) thr_nomem(&flow->why);
  return words->data && !words->failed ? thr_sheets_lines(words->data, width, size) : 0;
}

/* Parts the rows into two columns of nearly equal height, in order: the left column takes rows
 * until it is at least half as high as all. */
static void part_rows(thr_step *step)
{
  double total = 0, left = 0;
  for (int i = 0; i < step->n_rows; i++)
    total += step->lines[i] * line_height() + AFTER;

  for (step->left = 0; step->left < step->n_rows && left < 0.5 * total - 1e-6; step->left++)
    left += step->lines[step->left] * line_height() + AFTER;

  step->rows_height = fmax(left, total - left);
}

double thr_step_rows_height(int lines, int rows)
{
  return 0.5 * (lines + 1) * line_height() + 0.5 * (rows + 1) * AFTER;
}

double thr_step_words_height(double rows_height, int lines_before, int lines_after)
{
  return rows_height + (lines_before + lines_after) * THR_SHEET_LINE + (lines_before ? 1 : 0) +
         THR_SHEET_LINE + 1.5;
}

/* Appends the row of a visit: what the needle does, and the length that is joined on then. */
static void put_words_of(const thr_sheets *sheets, int visit, thr_text *row)
{
  const thr_known *known = &sheets->known;
  char length[64];
  thr_pieces_say(&known->pieces, thr_sheets_labels(known), known->visit, visit, sheets->step, row);
  if (!known->supplies.joined[visit]) return;
  thr_svg_length(thr_sheets_joined_length(known, visit), known->f->units, length);
  thr_text_printf(row, "; join on %s", length);
}

int thr_step_row_lines(thr_sheets *sheets, int visit)
{
  thr_text row = {0};
  put_words_of(sheets, visit, &row);

  int lines =
      count_lines(&sheets->flow, &row, column_width(&sheets->flow) - BOX - COUNT, THR_SHEET_SMALL);
  thr_text_destroy(&row);
  return lines;
}

void thr_step_find_text(thr_sheets *sheets, thr_step *step)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  thr_step_destroy_text(step);

  /* A row for each visit, with the number of its lines. */
  for (int i = step->first; i < step->end && !flow->why.code; i++) {
    thr_text *row = &step->row[step->n_rows];
    *row = (thr_text){0};
    put_words_of(sheets, i, row);
    step->lines[step->n_rows++] =
        count_lines(flow, row, column_width(flow) - BOX - COUNT, THR_SHEET_SMALL);
  }

  part_rows(step);

  /* Text before and after the rows spans both columns. */
  put_beginning(known, step->first, &step->before);
  put_check(known, step->end - 1, &step->after);

  step->lines_before = count_lines(flow, &step->before, thr_sheets_width(flow), THR_SHEET_TEXT);
  step->lines_after = count_lines(flow, &step->after, thr_sheets_width(flow), THR_SHEET_TEXT);
}

/* Appends what a step amounts to: "11 pieces to pick up, 5 on a cord already; 38 of 49 are threaded
 * then; cord used 640.1 mm, left for the way 1773 mm". Lengths are in the framework's units. */
static void put_tally(const thr_known *known, const thr_step *step, thr_text *text)
{
  char used[64], left[64];
  const thr_move *move = &known->move[step->end - 1];
  int picked = thr_sheets_count_new(known, step->first, step->end), last = step->end - 1;

  /* The way that is left reaches from here to the end of the needle's part. */
  while (!thr_step_ends(known, last))
    last++;
  thr_svg_length(move->used, known->f->units, used);
  if (last >= step->end)
    thr_svg_length(known->move[last].used - move->used, known->f->units, left);
  else
    snprintf(left, sizeof left, "none");

  /* With two needles the lengths are those of the needle in hand. */
  thr_text_printf(text,
                  "%d %s to pick up, %d on a cord already; %d of %d are threaded then; cord used%s "
                  "%s, left for the way %s",
                  picked, thr_pieces_word(known->plan, picked), step->end - step->first - picked,
                  thr_sheets_count_new(known, 0, step->end), known->pieces.n,
                  move->needle == THR_NEEDLE_ONLY ? "" : " by this needle", used, left);
}

/* Returns the number of the first pass that a step draws: a visit that only starts a cord (number
 * 0) has none. */
static int first_number(const thr_known *known, const thr_step *step)
{
  const thr_visit *visit = &known->visit[step->first];
  return visit->number || step->first + 1 == step->end ? visit->number : visit[1].number;
}

const char *thr_step_colour(const thr_known *known, const thr_step *step)
{
  enum { VERMILLION = 1 };

  int c = known->visit[step->first].cord;
  return thr_palette(known->plan->n_cords == 1 ? VERMILLION : known->copy[c].path).hex;
}

void thr_step_put_heading(thr_flow *flow, const thr_known *known, const thr_step *step, double top)
{
  int c = known->visit[step->first].cord, low = first_number(known, step),
      high = known->visit[step->end - 1].number;
  thr_needle needle = known->move[step->first].needle;
  char cord[96], line[256], colour[64], big[16];
  const char *own = thr_step_colour(known, step);
  thr_sheets_cord_words(known, c, cord);

  /* "Cord A (blue), right needle: passes 17-36 of 86". low may exceed high with the left needle. */
  int n = snprintf(line, sizeof line, "%s%s: ", cord,
                   needle == THR_NEEDLE_RIGHT  ? ", right needle"
                   : needle == THR_NEEDLE_LEFT ? ", left needle"
                                               : "");

  n += snprintf(line + n, sizeof line - (size_t)n, low == high ? "pass %d" : "passes %d-%d", low,
                high);
  snprintf(line + n, sizeof line - (size_t)n, " of %d", known->plan->cord[c].n_passes);
  snprintf(colour, sizeof colour, " font-weight=\"bold\" style=\"fill:%s\"", own);

  snprintf(big, sizeof big, "%d", step->number);
  thr_text tally = {0};
  put_tally(known, step, &tally);

  /* The number stands large on the left; the small picture of the whole takes the right corner. */
  double x = THR_SHEET_MARGIN, width = thr_sheets_width(flow) + THR_SHEET_MARGIN - LOCATOR - 3;
  thr_svg_text(thr_sheets_out(flow), x, top + 6.5, NUMBER, " font-weight=\"bold\"", big);
  x += fmax(14, 0.72 * NUMBER * (double)strlen(big) + 3);

  /* The line shrinks to fit between both; bold letters are at most 0.66 em wide on average. */
  thr_svg_text(thr_sheets_out(flow), x, top + 3.5,
               fmin(4.4, (width - x) / (0.66 * (double)strlen(line))), colour, line);

  /* The tally below in as many lines as needed. */
  if (tally.failed) thr_nomem(&flow->why);
  thr_sheets_text(flow, x, top + 9, THR_SHEET_SMALL, width - x, " style=\"fill:#444\"",
                  tally.data ? tally.data : "");
  thr_text_destroy(&tally);
}

void thr_step_put_legend(thr_flow *flow, double y, const char *what)
{
  char now[48];
  const char *const words[THR_PIECE_STATES] = {
      [THR_PIECE_NEW] = now, [THR_PIECE_HELD] = "on a cord already", [THR_PIECE_LATER] = "later"};
  double x = THR_SHEET_MARGIN;

  /* The same looks serve the maps of sections. */
  snprintf(now, sizeof now, "pick up in this %s", what);

  /* From the piece that is picked up now to the one that waits, as the maker needs them. */
  for (int state = THR_PIECE_STATES - 1; state > THR_PIECE_PLAIN; state--) {
    thr_draw_key(x, y - 2.4, 5, 2.8, (thr_piece_state)state, thr_sheets_out(flow));
    thr_svg_text(thr_sheets_out(flow), x + 6.5, y, THR_SHEET_SMALL, "", words[state]);
    x += 6.5 + 0.62 * THR_SHEET_SMALL * (double)strlen(words[state]) + 6;
  }
}

/* ---- rows ---- */

/* Writes flowing text over the whole width at the current height and moves on below. */
static void put_words(thr_flow *flow, const thr_text *words, const char *attributes)
{
  if (words->data)
    flow->y = thr_sheets_text(flow, THR_SHEET_MARGIN, flow->y, THR_SHEET_TEXT,
                              thr_sheets_width(flow), attributes, words->data);
}

/* Writes row i of a step at (x, y): a box, the number of the pass ("S" where a cord starts), the
 * words. Rows that pick up a piece are black, rows through a piece that is on a cord already are
 * grey. */
static void put_row(thr_flow *flow, const thr_known *known, const thr_step *step, int i, double x,
                    double y)
{
  char number[16] = "S";
  const thr_visit *visit = &known->visit[step->first + i];
  if (visit->number) snprintf(number, sizeof number, "%d", visit->number);

  /* From left to right: box, number, words. */
  thr_sheets_box(thr_sheets_out(flow), x, y);
  thr_svg_text(thr_sheets_out(flow), x + BOX + COUNT - 1.5, y, THR_SHEET_SMALL,
               " text-anchor=\"end\" font-weight=\"bold\"", number);
  thr_sheets_text(flow, x + BOX + COUNT, y, THR_SHEET_SMALL, column_width(flow) - BOX - COUNT,
                  visit->nth == 1 ? "" : " style=\"fill:#444\"", step->row[i].data);
}

void thr_step_put_rows(thr_flow *flow, const thr_known *known, const thr_step *step)
{
  flow->y += THR_SHEET_LINE;

  /* What to do first, over the whole width. */
  put_words(flow, &step->before, " style=\"fill:#444\"");
  if (step->lines_before) flow->y += 1;

  /* The second column begins at the height of the first. */
  double y = flow->y;
  for (int i = 0; i < step->n_rows && !flow->why.code; i++) {
    if (i == step->left) y = flow->y;
    put_row(flow, known, step, i, THR_SHEET_MARGIN + (i < step->left ? 0 : column_width(flow) + 4),
            y);
    y += step->lines[i] * line_height() + AFTER;
  }

  /* Where the needle is then: a step is done only if this is right. */
  flow->y += step->rows_height + 1;
  put_words(flow, &step->after, " font-weight=\"bold\"");
}
