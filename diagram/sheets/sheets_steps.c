/* The steps of a path: some twenty passes each, as a picture and in rows to tick off. A page takes as many as fit whole. */
#include "diagram/overview/crop.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/palette.h"
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

enum { MOST_MOVES = 48, USUAL_MOVES = 24, FEW_LINES = 14, MOST_LINES = 26, SMALLEST = 6 };
static const double HEAD = 14, NUMBER = 9;       /* mm: heading of a step; its number */
static const double BETWEEN = 5;                 /* mm between two steps of a page */
static const double LOCATOR[2] = {30, 42};       /* mm: least and greatest side of the small picture beside the rows */
static const double BOX = 5;                     /* mm: a box to tick, and white behind it */
static const double LEAST_PICTURE[2] = {90, 60}; /* mm: width and height */

/* Moves first .. end - 1. */
typedef struct {
  int first, end;
  thr_crop_view view;
  int lines;     /* of the rows */
  int all_lines; /* with what is said before and after them */
  thr_text *row; /* [end - first] words of the rows; the first n_rows are used */
  int n_rows;
  thr_text before, after;
} step;

static double text_width(const thr_sheets *sheets)
{
  return thr_sheets_width(sheets) - LOCATOR[1] - 9;
}

/* ---- what is said beside the rows ---- */

static bool begins(const thr_sheets *sheets, int i)
{
  return i == 0 || sheets->move[i].cord != sheets->move[i - 1].cord || sheets->move[i].needle != sheets->move[i - 1].needle;
}

static bool ends(const thr_sheets *sheets, int i)
{
  return i + 1 == sheets->n_moves || begins(sheets, i + 1);
}

static int tail_of(const thr_sheets *sheets, int i)
{
  return thr_tail(sheets->f, sheets->move[i].half);
}

/* What is done before the first pass of a needle; empty on other pages. */
static void put_beginning(const thr_sheets *sheets, int i, thr_text *text)
{
  const thr_move *move = &sheets->move[i];
  if (!begins(sheets, i)) return;
  if (move->needle == THR_NEEDLE_ONLY) {
    thr_text_append(text, "Begin at ");
    thr_guide_place(&sheets->guide, tail_of(sheets, i), text);
    thr_text_printf(text, ": leave a tail of %.0f mm there and a knot's length.", THR_SUPPLIES_TAIL);
  } else {
    thr_text_printf(text, move->needle == THR_NEEDLE_RIGHT ? "Right needle first: the fold of the cord lies at "
                                                           : "Now the left needle, from the fold of the cord at ");
    thr_guide_place(&sheets->guide, tail_of(sheets, i), text);
    thr_text_append(text, ".");
  }
}

/* "The needle comes out at F12; next E12." */
static void put_check(const thr_sheets *sheets, int last, thr_text *text)
{
  const thr_move *move = &sheets->move[last];
  thr_text_printf(text, "Check: the %sneedle comes out at ",
                  move->needle == THR_NEEDLE_RIGHT  ? "right "
                  : move->needle == THR_NEEDLE_LEFT ? "left "
                                                    : "");
  thr_guide_place(&sheets->guide, thr_head(sheets->f, move->half), text);
  if (!ends(sheets, last))
    thr_text_printf(text, "; next %s.", sheets->guide.label[thr_head(sheets->f, sheets->move[last + 1].half)]);
  else if (move->needle == THR_NEEDLE_RIGHT)
    thr_text_append(text, ": the end of the cord. Leave it there and go on with the left needle.");
  else
    thr_text_append(text, move->needle == THR_NEEDLE_LEFT ? ": the start of the cord." : ": the end of the cord.");
}

static void destroy_text(step *p)
{
  for (int i = 0; i < p->n_rows; i++)
    thr_text_destroy(&p->row[i]);
  thr_text_destroy(&p->before);
  thr_text_destroy(&p->after);
  p->n_rows = p->lines = p->all_lines = 0;
}

static int count_lines(thr_sheets *sheets, const thr_text *words, double width)
{
  if (words->failed) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  return words->data && !words->failed ? thr_sheets_lines(words->data, width, THR_SHEET_TEXT) : 0;
}

/* Fills texts and lines. */
static void find_text(thr_sheets *sheets, step *p)
{
  destroy_text(p);
  for (int i = p->first; i < p->end && !sheets->st;) {
    thr_text *row = &p->row[p->n_rows++];
    *row = (thr_text){0};
    i = thr_sheets_run(sheets, i, p->end, row);
    p->lines += count_lines(sheets, row, text_width(sheets));
  }
  put_beginning(sheets, p->first, &p->before);
  put_check(sheets, p->end - 1, &p->after);
  p->all_lines = p->lines + count_lines(sheets, &p->before, text_width(sheets) + BOX) +
                 count_lines(sheets, &p->after, text_width(sheets) + BOX);
}

/* "20 passes, 18 beads picked up, 38 of 84 threaded; cord used 640.1 mm, left 1773 mm" */
static void put_tally(const thr_sheets *sheets, const step *p, thr_text *text)
{
  char used[64], left[64];
  const thr_move *move = &sheets->move[p->end - 1];
  int picked = 0, before = 0, last = p->end - 1;
  for (int i = 0; i < p->end; i++) {
    if (sheets->move[i].deed != THR_PICK_UP) continue;
    picked += i >= p->first;
    before++;
  }
  while (!ends(sheets, last))
    last++;
  thr_svg_length(move->used, sheets->f->units, used);
  if (last >= p->end)
    thr_svg_length(sheets->move[last].used - move->used, sheets->f->units, left);
  else
    snprintf(left, sizeof left, "none");
  thr_text_printf(text, "%d pass%s, %d bead%s picked up, %d of %d threaded; cord used%s %s, left for the way %s",
                  p->end - p->first, p->end - p->first == 1 ? "" : "es", picked, picked == 1 ? "" : "s", before,
                  sheets->f->n_edges, move->needle == THR_NEEDLE_ONLY ? "" : " by this needle", used, left);
}

/* Colour and words of its passes. */
static void put_heading(thr_sheets *sheets, const step *p, double top)
{
  const thr_move *a = &sheets->move[p->first], *b = &sheets->move[p->end - 1];
  char cord[96], line[256], colour[64], big[16];
  bool single = sheets->plan->n_cords == 1;
  thr_colour own = thr_palette(single ? a->pass / THR_COLOUR_PASSES : sheets->copy[a->cord].path);
  thr_sheets_cord_words(sheets, a->cord, cord);
  int n = snprintf(line, sizeof line, "%s%s%s%s%s: ", cord, single ? " (" : "", single ? own.name : "", single ? ")" : "",
                   a->needle == THR_NEEDLE_RIGHT  ? ", right needle"
                   : a->needle == THR_NEEDLE_LEFT ? ", left needle"
                                                  : "");
  n += snprintf(line + n, sizeof line - (size_t)n, a == b ? "pass %d" : "passes %d-%d", a->pass + 1, b->pass + 1);
  snprintf(line + n, sizeof line - (size_t)n, " of %d", sheets->plan->cord[a->cord].n_passes);
  snprintf(colour, sizeof colour, " font-weight=\"bold\" style=\"fill:%s\"", own.hex);
  snprintf(big, sizeof big, "%d", sheets->n_steps);
  thr_text tally = {0};
  put_tally(sheets, p, &tally);
  double x = THR_SHEET_MARGIN, y = top + 6.5;
  thr_svg_text(thr_sheets_out(sheets), x, y, NUMBER, " font-weight=\"bold\"", big);
  x += fmax(14, 0.72 * NUMBER * (double)strlen(big) + 3);
  thr_svg_text(thr_sheets_out(sheets), x, top + 3.5, 4.4, colour, line);
  if (tally.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else
    thr_sheets_text(sheets, x, top + 9, THR_SHEET_SMALL, thr_sheets_width(sheets) + THR_SHEET_MARGIN - x, " style=\"fill:#444\"",
                    tally.data);
  thr_text_destroy(&tally);
}

/* ---- the picture ---- */

static double text_height(const step *p)
{
  return (p->all_lines + 1) * THR_SHEET_LINE;
}

/* The small picture beside the text is about as high as that. */
static void locator_size(const thr_sheets *sheets, const step *p, double size[2])
{
  size[0] = fmin(fmax(text_height(p) - 3, LOCATOR[0]), LOCATOR[1]);
  size[1] = fmin(sheets->crops.slender, 1) * size[0];
}

/* Height of what is below the picture, mm. */
static double height_below(const thr_sheets *sheets, const step *p)
{
  double locator[2];
  locator_size(sheets, p, locator);
  return fmax(text_height(p), locator[1] + 4);
}

/* Room for the picture, mm. */
static void picture_room(const thr_sheets *sheets, const step *p, double room[2])
{
  room[0] = thr_sheets_width(sheets);
  room[1] = fmax(thr_sheets_bottom(sheets) - height_below(sheets, p) - THR_SHEET_MARGIN - HEAD, LEAST_PICTURE[1]);
}

/* Passes of the scene that the moves are, in their order. */
static int list_now(const thr_sheets *sheets, int first, int end, int *now)
{
  for (int i = first; i < end; i++)
    now[i - first] = sheets->first_pass[sheets->move[first].cord] + sheets->move[i].pass;
  return end - first;
}

/* Does a page take the step with the moves up to before end, with every pass numbered in the picture? Fills what it shows. */
static bool is_good(thr_sheets *sheets, step *p)
{
  int now[MOST_MOVES], n = p->end - p->first;
  find_text(sheets, p);
  if (sheets->st || (n > 1 && (p->lines > MOST_LINES || (n > USUAL_MOVES && p->lines > FEW_LINES)))) return n == 1;
  thr_crop crop = {.now = now, .n_now = list_now(sheets, p->first, p->end, now)};
  double room[2];
  picture_room(sheets, p, room);
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, LEAST_PICTURE, &p->view, &sheets->why);
  if (st) thr_sheets_fail(sheets, st, NULL);
  return n == 1 || p->view.scale <= SMALLEST;
}

/* The move after the last one that could be in the step: another cord, needle or colour begins there. */
static int end_of_part(const thr_sheets *sheets, int first)
{
  const thr_move *move = &sheets->move[first];
  int end = first + 1;
  while (end < sheets->n_moves && end < first + MOST_MOVES && !begins(sheets, end) &&
         (sheets->plan->n_cords > 1 || sheets->move[end].pass / THR_COLOUR_PASSES == move->pass / THR_COLOUR_PASSES))
    end++;
  return end;
}

/* How many moves it takes: as many as are good; of those that need several steps alike many in each. */
static void choose_end(thr_sheets *sheets, step *p)
{
  int part = end_of_part(sheets, p->first) - p->first, n = 1;
  p->end = p->first + part;
  if (!is_good(sheets, p)) {
    for (p->end = p->first + 2; n < part && is_good(sheets, p); p->end++)
      n++;
    int steps = (part + n - 1) / n;
    p->end = p->first + (part + steps - 1) / steps;
    is_good(sheets, p);
  }
  if (p->view.scale >= THR_CROP_SCALES) p->view.scale = THR_CROP_SCALES - 1;
}

static void put_pictures(thr_sheets *sheets, const step *p, double top, unsigned char *state, bool *filled)
{
  int now[MOST_MOVES];
  thr_box shown[2] = {{0}};
  for (int i = 0; i < sheets->n_moves; i++)
    state[i] = sheets->moved[i] < p->first ? THR_DRAW_EARLIER : sheets->moved[i] < p->end ? THR_DRAW_NOW : THR_DRAW_HIDDEN;
  for (int e = 0; e < sheets->f->n_edges; e++)
    filled[e] = sheets->threaded[e] < p->first;
  thr_crop crop = {.number = sheets->n_steps, .state = state, .filled = filled, .now = now};
  crop.n_now = list_now(sheets, p->first, p->end, now);
  crop.backward = sheets->move[p->first].needle == THR_NEEDLE_LEFT;
  double at[2] = {0.5 * (sheets->size[0] - p->view.size[0]), top + HEAD}, right = sheets->size[0] - THR_SHEET_MARGIN, locator[2];
  locator_size(sheets, p, locator);
  thr_text *text = thr_sheets_out(sheets);
  thr_status st =
      thr_grow(&sheets->locator, sheets->n_locators, &sheets->locators_capacity, sizeof *sheets->locator, &sheets->why);
  if (!st) st = thr_crop_draw(&sheets->crops, &crop, &p->view, at, shown, text, &sheets->why);
  sheets->y = at[1] + p->view.size[1];
  if (st)
    thr_sheets_fail(sheets, st, NULL);
  else
    sheets->locator[sheets->n_locators++] =
        (thr_locator){.page = sheets->n_pages,
                      .first = p->first,
                      .end = p->end,
                      .view = p->view,
                      .shown = {shown[0], shown[1]},
                      .paper = {right - locator[0], sheets->y + 3, right, sheets->y + 3 + locator[1]}};
}

void thr_sheets_locate(const thr_sheets *sheets, int page, thr_text *text)
{
  for (int i = 0; i < sheets->n_locators; i++) {
    int now[MOST_MOVES];
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
        thr_sheets_text(sheets, THR_SHEET_MARGIN, sheets->y, THR_SHEET_TEXT, text_width(sheets) + BOX, attributes, words->data);
}

static void put_rows(thr_sheets *sheets, const step *p)
{
  sheets->y += 1.5 + THR_SHEET_LINE;
  put_words(sheets, &p->before, " style=\"fill:#444\"");
  for (int i = 0; i < p->n_rows && !sheets->st; i++) {
    thr_sheets_box(thr_sheets_out(sheets), THR_SHEET_MARGIN, sheets->y);
    sheets->y =
        thr_sheets_text(sheets, THR_SHEET_MARGIN + BOX, sheets->y, THR_SHEET_TEXT, text_width(sheets), "", p->row[i].data);
  }
  sheets->y += 1;
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
  if (limits->advance) limits->advance(limits->user, "pages of the step sheets", (double)first / sheets->n_moves);
  if (thr_limits_stop(limits))
    thr_sheets_fail(sheets, thr_fail(&sheets->why, THR_ELIMIT, "interrupted at page %d of the step sheets", sheets->n_pages + 1),
                    NULL);
}

static void put_step(thr_sheets *sheets, const step *p, unsigned char *state, bool *filled)
{
  double height = HEAD + p->view.size[1] + height_below(sheets, p), top = find_top(sheets, height);
  sheets->n_steps++;
  if (!sheets->st) put_heading(sheets, p, top);
  if (!sheets->st) put_pictures(sheets, p, top, state, filled);
  if (!sheets->st) put_rows(sheets, p);
  sheets->y = top + height;
}

void thr_sheets_steps(thr_sheets *sheets, int c)
{
  thr_text row[MOST_MOVES + 1] = {{0}};
  step p = {.first = sheets->first_move[c], .row = row};
  unsigned char *state = thr_calloc((size_t)sheets->n_moves, sizeof *state);
  bool *filled = thr_calloc((size_t)sheets->f->n_edges, sizeof *filled);
  int end = p.first + sheets->plan->cord[c].n_passes;
  if (!state || !filled) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  while (p.first < end && !sheets->st) {
    poll(sheets, p.first);
    if (!sheets->st) choose_end(sheets, &p);
    if (!sheets->st) put_step(sheets, &p, state, filled);
    destroy_text(&p);
    p.first = p.end;
  }
  free(state);
  free(filled);
}
