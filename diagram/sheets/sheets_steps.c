/* The steps of a path: some twenty passes each, as a picture and in rows to tick off. A page takes as many as fit whole. */
#include "diagram/overview/crop.h"
#include "diagram/overview/draw.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/pieces.h"
#include "diagram/sheets/sheets_parts.h"
#include "diagram/overview/svg.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_VISITS = 25, MOST_LINES = 40, SMALLEST = 13 };
static const double HEAD = 25, NUMBER = 9;       /* mm: heading of a step with the small picture in its corner; its number */
static const double BETWEEN = 5;                 /* mm between two steps of a page */
static const double LOCATOR[2] = {44, 22};       /* mm: width and height of the small picture, at most */
static const double LEGEND = 6;                  /* mm below the picture */
static const double BOX = 5, COUNT = 8;          /* mm: a box to tick, and white behind it; the number of a row */
static const double AFTER = 0.7;                 /* mm after a row */
static const double LEAST_PICTURE[2] = {90, 60}; /* mm: width and height */

/* Visits first .. end - 1. */
typedef struct {
  int first, end;
  thr_crop_view view;
  thr_text *row; /* [end - first] words of the rows */
  int *lines;    /* [end - first] of them */
  int n_rows;
  int left;      /* rows in the left column */
  double height; /* of the rows, mm */
  thr_text before, after;
  int lines_before, lines_after;
} step;

static double column_width(const thr_sheets *sheets)
{
  return 0.5 * (thr_sheets_width(sheets) - 4);
}

static double line_height(void)
{
  return 1.45 * THR_SHEET_SMALL;
}

/* ---- what is said beside the rows ---- */

static bool begins(const thr_sheets *sheets, int i)
{
  return i == 0 || sheets->move[i].part != sheets->move[i - 1].part;
}

static bool ends(const thr_sheets *sheets, int i)
{
  return i + 1 == sheets->n_visits || begins(sheets, i + 1);
}

/* Where the needle is before a visit. */
static int place_before(const thr_sheets *sheets, int i)
{
  const thr_visit *visit = &sheets->visit[i];
  return visit->number ? thr_tail(sheets->f, visit->in) : visit->piece;
}

/* What is done before the first visit of a needle; empty in other steps. */
static void put_beginning(const thr_sheets *sheets, int i, thr_text *text)
{
  thr_needle needle = sheets->move[i].needle;
  if (!begins(sheets, i)) return;
  if (needle == THR_NEEDLE_ONLY) {
    thr_text_append(text, "Begin at ");
    thr_guide_place(&sheets->guide, place_before(sheets, i), text);
    thr_text_printf(text, ": leave a tail of %.0f mm there and a knot's length.", THR_SUPPLIES_TAIL);
  } else {
    thr_text_printf(text, needle == THR_NEEDLE_RIGHT ? "Right needle first: the fold of the cord lies at "
                                                     : "Now the left needle, from the fold of the cord at ");
    thr_guide_place(&sheets->guide, place_before(sheets, i), text);
    thr_text_append(text, ".");
  }
}

/* "Check: the needle comes out of F12 and points at E12." Tubes: "Check: the needle comes out at F12; next E12." */
static void put_check(const thr_sheets *sheets, int last, thr_text *text)
{
  const thr_visit *visit = &sheets->visit[last];
  thr_needle needle = sheets->move[last].needle;
  int at = visit->number ? thr_head(sheets->f, visit->in) : visit->piece;
  bool solid = sheets->pieces.solid;
  thr_text_printf(text, "Check: the %sneedle comes out %s ",
                  needle == THR_NEEDLE_RIGHT  ? "right "
                  : needle == THR_NEEDLE_LEFT ? "left "
                                              : "",
                  solid ? "of" : "at");
  thr_guide_place(&sheets->guide, at, text);
  if (!ends(sheets, last))
    thr_text_printf(text, solid ? " and points at %s." : "; next %s.",
                    sheets->guide.label[thr_head(sheets->f, sheets->visit[last + 1].in)]);
  else if (needle == THR_NEEDLE_RIGHT)
    thr_text_append(text, ": the end of the cord. Leave it there and go on with the left needle.");
  else
    thr_text_append(text, needle == THR_NEEDLE_LEFT ? ": the start of the cord." : ": the end of the cord.");
}

static void destroy_text(step *p)
{
  for (int i = 0; i < p->n_rows; i++)
    thr_text_destroy(&p->row[i]);
  thr_text_destroy(&p->before);
  thr_text_destroy(&p->after);
  p->n_rows = 0;
}

static int count_lines(thr_sheets *sheets, const thr_text *words, double width, double size)
{
  if (words->failed) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  return words->data && !words->failed ? thr_sheets_lines(words->data, width, size) : 0;
}

/* Parts the rows into two columns of nearly equal height. */
static void part_rows(step *p)
{
  double total = 0, left = 0;
  for (int i = 0; i < p->n_rows; i++)
    total += p->lines[i] * line_height() + AFTER;
  for (p->left = 0; p->left < p->n_rows && left < 0.5 * total - 1e-6; p->left++)
    left += p->lines[p->left] * line_height() + AFTER;
  p->height = fmax(left, total - left);
}

/* Fills texts and lines. */
static void find_text(thr_sheets *sheets, step *p)
{
  destroy_text(p);
  for (int i = p->first; i < p->end; i++)
    sheets->step[i] = sheets->n_steps + 1;
  for (int i = p->first; i < p->end && !sheets->st; i++) {
    thr_text *row = &p->row[p->n_rows];
    *row = (thr_text){0};
    thr_pieces_say(&sheets->pieces, thr_sheets_labels(sheets), sheets->visit, i, sheets->step, row);
    p->lines[p->n_rows++] = count_lines(sheets, row, column_width(sheets) - BOX - COUNT, THR_SHEET_SMALL);
  }
  for (int i = p->first; i < p->end; i++)
    sheets->step[i] = 0;
  part_rows(p);
  put_beginning(sheets, p->first, &p->before);
  put_check(sheets, p->end - 1, &p->after);
  p->lines_before = count_lines(sheets, &p->before, thr_sheets_width(sheets), THR_SHEET_TEXT);
  p->lines_after = count_lines(sheets, &p->after, thr_sheets_width(sheets), THR_SHEET_TEXT);
}

/* "11 pieces to pick up, 5 that are on a cord already; 38 of 49 are threaded then; cord used 640.1 mm, left 1773 mm" */
static void put_tally(const thr_sheets *sheets, const step *p, thr_text *text)
{
  char used[64], left[64];
  const thr_move *move = &sheets->move[p->end - 1];
  int picked = 0, before = 0, last = p->end - 1, n = sheets->pieces.n;
  for (int i = 0; i < p->end; i++) {
    picked += i >= p->first && sheets->visit[i].nth == 1;
    before += sheets->visit[i].nth == 1;
  }
  while (!ends(sheets, last))
    last++;
  thr_svg_length(move->used, sheets->f->units, used);
  if (last >= p->end)
    thr_svg_length(sheets->move[last].used - move->used, sheets->f->units, left);
  else
    snprintf(left, sizeof left, "none");
  thr_text_printf(text, "%d %s to pick up, %d on a cord already; %d of %d are threaded then; cord used%s %s, left for the way %s",
                  picked, thr_pieces_word(sheets->plan, picked), p->end - p->first - picked, before, n,
                  move->needle == THR_NEEDLE_ONLY ? "" : " by this needle", used, left);
}

/* Number of the first pass that a step draws. */
static int first_number(const thr_sheets *sheets, const step *p)
{
  const thr_visit *visit = &sheets->visit[p->first];
  return visit->number || p->first + 1 == p->end ? visit->number : visit[1].number;
}

/* Colour and words of its passes. */
static void put_heading(thr_sheets *sheets, const step *p, double top)
{
  int c = sheets->visit[p->first].cord, low = first_number(sheets, p), high = sheets->visit[p->end - 1].number;
  thr_needle needle = sheets->move[p->first].needle;
  char cord[96], line[256], colour[64], big[16];
  bool single = sheets->plan->n_cords == 1;
  thr_colour own = thr_palette(single ? (low - 1) / THR_COLOUR_PASSES : sheets->copy[c].path);
  thr_sheets_cord_words(sheets, c, cord);
  int n = snprintf(line, sizeof line, "%s%s%s%s%s: ", cord, single ? " (" : "", single ? own.name : "", single ? ")" : "",
                   needle == THR_NEEDLE_RIGHT  ? ", right needle"
                   : needle == THR_NEEDLE_LEFT ? ", left needle"
                                               : "");
  n += snprintf(line + n, sizeof line - (size_t)n, low == high ? "pass %d" : "passes %d-%d", low, high);
  snprintf(line + n, sizeof line - (size_t)n, " of %d", sheets->plan->cord[c].n_passes);
  snprintf(colour, sizeof colour, " font-weight=\"bold\" style=\"fill:%s\"", own.hex);
  snprintf(big, sizeof big, "%d", sheets->n_steps);
  thr_text tally = {0};
  put_tally(sheets, p, &tally);
  double x = THR_SHEET_MARGIN, width = thr_sheets_width(sheets) + THR_SHEET_MARGIN - LOCATOR[0] - 3;
  thr_svg_text(thr_sheets_out(sheets), x, top + 6.5, NUMBER, " font-weight=\"bold\"", big);
  x += fmax(14, 0.72 * NUMBER * (double)strlen(big) + 3);
  thr_svg_text(thr_sheets_out(sheets), x, top + 3.5, fmin(4.4, (width - x) / (0.66 * (double)strlen(line))), colour, line);
  if (tally.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else
    thr_sheets_text(sheets, x, top + 9, THR_SHEET_SMALL, width - x, " style=\"fill:#444\"", tally.data);
  thr_text_destroy(&tally);
}

/* What the looks of pieces in the picture mean. */
static void put_legend(thr_sheets *sheets, double y)
{
  static const char *const words[THR_PIECE_STATES] = {
      [THR_PIECE_NEW] = "pick up in this step", [THR_PIECE_HELD] = "on a cord already", [THR_PIECE_LATER] = "later"};
  double x = THR_SHEET_MARGIN;
  for (int state = THR_PIECE_STATES - 1; state > THR_PIECE_PLAIN; state--) {
    thr_draw_key(x, y - 2.4, 5, 2.8, (thr_piece_state)state, thr_sheets_out(sheets));
    thr_svg_text(thr_sheets_out(sheets), x + 6.5, y, THR_SHEET_SMALL, "", words[state]);
    x += 6.5 + 0.62 * THR_SHEET_SMALL * (double)strlen(words[state]) + 6;
  }
}

/* ---- the picture ---- */

/* Height of what is below the picture, mm. */
static double height_below(const step *p)
{
  return LEGEND + p->height + (p->lines_before + p->lines_after) * THR_SHEET_LINE + (p->lines_before ? 1 : 0) + THR_SHEET_LINE +
         1.5;
}

/* Room for the picture, mm. */
static void picture_room(const thr_sheets *sheets, const step *p, double room[2])
{
  room[0] = thr_sheets_width(sheets);
  room[1] = fmax(thr_sheets_bottom(sheets) - height_below(p) - THR_SHEET_MARGIN - HEAD, LEAST_PICTURE[1]);
}

/* Passes of the scene that the visits come by, in their order. */
static int list_now(const thr_sheets *sheets, int first, int end, int *now)
{
  int n = 0;
  for (int i = first; i < end; i++) {
    const thr_visit *visit = &sheets->visit[i];
    if (visit->number) now[n++] = sheets->first_pass[visit->cord] + visit->number - 1;
  }
  return n;
}

/* A step that is nothing but the start of a cord has no pass to draw. */
static int fewest(const thr_sheets *sheets, const step *p)
{
  return sheets->visit[p->first].number ? 1 : 2;
}

/* Does a page take the step with the visits up to before end, with every pass numbered in the picture? Fills what it shows. */
static bool is_good(thr_sheets *sheets, step *p)
{
  int now[MOST_VISITS], lines = 0;
  bool least = p->end - p->first <= fewest(sheets, p);
  find_text(sheets, p);
  for (int i = 0; i < p->n_rows; i++)
    lines += p->lines[i];
  if (sheets->st || (!least && lines > MOST_LINES)) return least;
  thr_crop crop = {.now = now, .n_now = list_now(sheets, p->first, p->end, now)};
  double room[2];
  picture_room(sheets, p, room);
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, LEAST_PICTURE, &p->view, &sheets->why);
  if (st) thr_sheets_fail(sheets, st, NULL);
  return least || p->view.scale <= SMALLEST;
}

/* The visit after the last one that could be in the step: another cord, needle or colour begins there. */
static int end_of_part(const thr_sheets *sheets, int first)
{
  int end = first + (sheets->visit[first].number ? 1 : 2); /* where a cord starts it has no colour yet */
  int colour = (sheets->visit[end - 1].number - 1) / THR_COLOUR_PASSES;
  while (end < sheets->n_visits && end < first + MOST_VISITS && !begins(sheets, end) &&
         (sheets->plan->n_cords > 1 || (sheets->visit[end].number - 1) / THR_COLOUR_PASSES == colour))
    end++;
  return end;
}

/* How many visits it takes: as many as are good; of those that need several steps alike many in each. */
static void choose_end(thr_sheets *sheets, step *p)
{
  int part = end_of_part(sheets, p->first) - p->first, n = fewest(sheets, p);
  p->end = p->first + part;
  if (!is_good(sheets, p)) {
    for (p->end = p->first + n + 1; n < part && is_good(sheets, p); p->end++)
      n++;
    int steps = (part + n - 1) / n, each = (part + steps - 1) / steps;
    p->end = p->first + (each < fewest(sheets, p) ? fewest(sheets, p) : each);
    is_good(sheets, p);
  }
  if (p->view.scale >= THR_CROP_SCALES) p->view.scale = THR_CROP_SCALES - 1;
}

static void put_pictures(thr_sheets *sheets, const step *p, double top, unsigned char *state, unsigned char *piece)
{
  int now[MOST_VISITS];
  thr_box shown[2] = {{0}};
  for (int i = 0; i < sheets->n_passes; i++)
    state[i] = sheets->visited[i] < p->first ? THR_DRAW_EARLIER : sheets->visited[i] < p->end ? THR_DRAW_NOW : THR_DRAW_HIDDEN;
  for (int i = 0; i < sheets->pieces.n; i++)
    piece[i] = sheets->threaded[i] < p->first ? THR_PIECE_HELD : sheets->threaded[i] < p->end ? THR_PIECE_NEW : THR_PIECE_LATER;
  thr_crop crop = {.number = sheets->n_steps, .state = state, .piece = piece, .now = now};
  crop.n_now = list_now(sheets, p->first, p->end, now);
  crop.backward = sheets->move[p->first].needle == THR_NEEDLE_LEFT;
  double at[2] = {0.5 * (sheets->size[0] - p->view.size[0]), top + HEAD}, right = sheets->size[0] - THR_SHEET_MARGIN;
  thr_text *text = thr_sheets_out(sheets);
  thr_status st =
      thr_grow(&sheets->locator, sheets->n_locators, &sheets->locators_capacity, sizeof *sheets->locator, &sheets->why);
  if (!st) st = thr_crop_draw(&sheets->crops, &crop, &p->view, at, shown, text, &sheets->why);
  sheets->y = at[1] + p->view.size[1];
  if (st)
    thr_sheets_fail(sheets, st, NULL);
  else
    sheets->locator[sheets->n_locators++] = (thr_locator){.page = sheets->n_pages,
                                                          .first = p->first,
                                                          .end = p->end,
                                                          .view = p->view,
                                                          .shown = {shown[0], shown[1]},
                                                          .paper = {right - LOCATOR[0], top, right, top + LOCATOR[1]}};
}

void thr_sheets_locate(const thr_sheets *sheets, int page, thr_text *text)
{
  for (int i = 0; i < sheets->n_locators; i++) {
    int now[MOST_VISITS];
    const thr_locator *locator = &sheets->locator[i];
    if (locator->page != page) continue;
    thr_crop crop = {.now = now, .n_now = list_now(sheets, locator->first, locator->end, now)};
    crop.backward = sheets->move[locator->first].needle == THR_NEEDLE_LEFT;
    thr_crop_locate(&sheets->crops, &crop, &locator->view, locator->shown, locator->paper, text);
  }
}

/* ---- rows ---- */

static void put_words(thr_sheets *sheets, const thr_text *words, const char *attributes)
{
  if (words->data)
    sheets->y =
        thr_sheets_text(sheets, THR_SHEET_MARGIN, sheets->y, THR_SHEET_TEXT, thr_sheets_width(sheets), attributes, words->data);
}

/* A row with its box and number. */
static void put_row(thr_sheets *sheets, const step *p, int i, double x, double y)
{
  char number[16] = "S";
  const thr_visit *visit = &sheets->visit[p->first + i];
  if (visit->number) snprintf(number, sizeof number, "%d", visit->number);
  thr_sheets_box(thr_sheets_out(sheets), x, y);
  thr_svg_text(thr_sheets_out(sheets), x + BOX + COUNT - 1.5, y, THR_SHEET_SMALL, " text-anchor=\"end\" font-weight=\"bold\"",
               number);
  thr_sheets_text(sheets, x + BOX + COUNT, y, THR_SHEET_SMALL, column_width(sheets) - BOX - COUNT,
                  visit->nth == 1 ? "" : " style=\"fill:#444\"", p->row[i].data);
}

static void put_rows(thr_sheets *sheets, const step *p)
{
  put_legend(sheets, sheets->y + 4);
  sheets->y += LEGEND + THR_SHEET_LINE;
  put_words(sheets, &p->before, " style=\"fill:#444\"");
  if (p->lines_before) sheets->y += 1;
  double y = sheets->y;
  for (int i = 0; i < p->n_rows && !sheets->st; i++) {
    if (i == p->left) y = sheets->y;
    put_row(sheets, p, i, THR_SHEET_MARGIN + (i < p->left ? 0 : column_width(sheets) + 4), y);
    y += p->lines[i] * line_height() + AFTER;
  }
  sheets->y += p->height + 1;
  put_words(sheets, &p->after, " font-weight=\"bold\"");
}

/* Where the step begins: on the page of the one before if it fits there whole, below a rule, else on a page of its own. */
static double find_top(thr_sheets *sheets, double height)
{
  double y = sheets->y + BETWEEN;
  bool follows = sheets->n_pages == sheets->step_page && y + height <= thr_sheets_bottom(sheets);
  if (follows)
    thr_text_printf(thr_sheets_out(sheets), "<path stroke=\"#999\" stroke-width=\"0.20\" d=\"M%.2f %.2fh%.2f\"/>\n",
                    THR_SHEET_MARGIN, sheets->y + 0.5 * BETWEEN, thr_sheets_width(sheets));
  else
    thr_sheets_page(sheets, "", "");
  sheets->step_page = sheets->n_pages;
  return follows ? y : THR_SHEET_MARGIN;
}

/* Before each step: it may be stopped there. */
static void poll(thr_sheets *sheets, int first)
{
  const thr_limits *limits = sheets->limits;
  if (limits->advance) limits->advance(limits->user, "pages of the step sheets", (double)first / sheets->n_visits);
  if (thr_limits_stop(limits))
    thr_sheets_fail(sheets, thr_fail(&sheets->why, THR_ELIMIT, "interrupted at page %d of the step sheets", sheets->n_pages + 1),
                    NULL);
}

static void put_step(thr_sheets *sheets, const step *p, unsigned char *state, unsigned char *piece)
{
  double height = HEAD + p->view.size[1] + height_below(p), top = find_top(sheets, height);
  sheets->n_steps++;
  for (int i = p->first; i < p->end; i++)
    sheets->step[i] = sheets->n_steps;
  if (!sheets->st) put_heading(sheets, p, top);
  if (!sheets->st) put_pictures(sheets, p, top, state, piece);
  if (!sheets->st) put_rows(sheets, p);
  sheets->y = top + height;
}

void thr_sheets_steps(thr_sheets *sheets, int c)
{
  thr_text row[MOST_VISITS] = {{0}};
  int lines[MOST_VISITS];
  step p = {.first = sheets->first_visit[c], .row = row, .lines = lines};
  unsigned char *state = thr_calloc((size_t)sheets->n_passes, sizeof *state);
  unsigned char *piece = thr_calloc((size_t)sheets->pieces.n, sizeof *piece);
  int end = thr_sheets_end(sheets, c);
  if (!state || !piece) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  while (p.first < end && !sheets->st) {
    poll(sheets, p.first);
    if (!sheets->st) choose_end(sheets, &p);
    if (!sheets->st) put_step(sheets, &p, state, piece);
    destroy_text(&p);
    p.first = p.end;
  }
  free(state);
  free(piece);
}
