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

static double text_width(const thr_sheets *s)
{
  return thr_sheets_width(s) - LOCATOR[1] - 9;
}

/* ---- what is said beside the rows ---- */

static bool begins(const thr_sheets *s, int i)
{
  return i == 0 || s->move[i].cord != s->move[i - 1].cord || s->move[i].needle != s->move[i - 1].needle;
}

static bool ends(const thr_sheets *s, int i)
{
  return i + 1 == s->n_moves || begins(s, i + 1);
}

static int tail_of(const thr_sheets *s, int i)
{
  return thr_tail(s->f, s->move[i].half);
}

/* What is done before the first pass of a needle; empty on other pages. */
static void put_beginning(const thr_sheets *s, int i, thr_text *t)
{
  const thr_move *m = &s->move[i];
  if (!begins(s, i)) return;
  if (m->needle == THR_NEEDLE_ONLY) {
    thr_text_append(t, "Begin at ");
    thr_guide_place(&s->guide, tail_of(s, i), t);
    thr_text_printf(t, ": leave a tail of %.0f mm there and a knot's length.", THR_SUPPLIES_TAIL);
  } else {
    thr_text_printf(t, m->needle == THR_NEEDLE_RIGHT ? "Right needle first: the fold of the cord lies at "
                                                     : "Now the left needle, from the fold of the cord at ");
    thr_guide_place(&s->guide, tail_of(s, i), t);
    thr_text_append(t, ".");
  }
}

/* "The needle comes out at F12; next E12." */
static void put_check(const thr_sheets *s, int last, thr_text *t)
{
  const thr_move *m = &s->move[last];
  thr_text_printf(t, "Check: the %sneedle comes out at ",
                  m->needle == THR_NEEDLE_RIGHT  ? "right "
                  : m->needle == THR_NEEDLE_LEFT ? "left "
                                                 : "");
  thr_guide_place(&s->guide, thr_head(s->f, m->half), t);
  if (!ends(s, last))
    thr_text_printf(t, "; next %s.", s->guide.label[thr_head(s->f, s->move[last + 1].half)]);
  else if (m->needle == THR_NEEDLE_RIGHT)
    thr_text_append(t, ": the end of the cord. Leave it there and go on with the left needle.");
  else
    thr_text_append(t, m->needle == THR_NEEDLE_LEFT ? ": the start of the cord." : ": the end of the cord.");
}

static void destroy_text(step *p)
{
  for (int i = 0; i < p->n_rows; i++)
    thr_text_destroy(&p->row[i]);
  thr_text_destroy(&p->before);
  thr_text_destroy(&p->after);
  p->n_rows = p->lines = p->all_lines = 0;
}

static int count_lines(thr_sheets *s, const thr_text *words, double width)
{
  if (words->failed) thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  return words->data && !words->failed ? thr_sheets_lines(words->data, width, THR_SHEET_TEXT) : 0;
}

/* Fills texts and lines. */
static void find_text(thr_sheets *s, step *p)
{
  destroy_text(p);
  for (int i = p->first; i < p->end && !s->st;) {
    thr_text *row = &p->row[p->n_rows++];
    *row = (thr_text){0};
    i = thr_sheets_run(s, i, p->end, row);
    p->lines += count_lines(s, row, text_width(s));
  }
  put_beginning(s, p->first, &p->before);
  put_check(s, p->end - 1, &p->after);
  p->all_lines = p->lines + count_lines(s, &p->before, text_width(s) + BOX) + count_lines(s, &p->after, text_width(s) + BOX);
}

/* "20 passes, 18 beads picked up, 38 of 84 threaded; cord used 640.1 mm, left 1773 mm" */
static void put_tally(const thr_sheets *s, const step *p, thr_text *t)
{
  char used[64], left[64];
  const thr_move *m = &s->move[p->end - 1];
  int picked = 0, before = 0, last = p->end - 1;
  for (int i = 0; i < p->end; i++) {
    if (s->move[i].deed != THR_PICK_UP) continue;
    picked += i >= p->first;
    before++;
  }
  while (!ends(s, last))
    last++;
  thr_svg_length(m->used, s->f->units, used);
  if (last >= p->end)
    thr_svg_length(s->move[last].used - m->used, s->f->units, left);
  else
    snprintf(left, sizeof left, "none");
  thr_text_printf(t, "%d pass%s, %d bead%s picked up, %d of %d threaded; cord used%s %s, left for the way %s", p->end - p->first,
                  p->end - p->first == 1 ? "" : "es", picked, picked == 1 ? "" : "s", before, s->f->n_edges,
                  m->needle == THR_NEEDLE_ONLY ? "" : " by this needle", used, left);
}

/* Colour and words of its passes. */
static void put_heading(thr_sheets *s, const step *p, double top)
{
  const thr_move *a = &s->move[p->first], *b = &s->move[p->end - 1];
  char cord[96], line[256], colour[64], big[16];
  bool single = s->plan->n_cords == 1;
  thr_colour own = thr_palette(single ? a->pass / THR_COLOUR_PASSES : s->copy[a->cord].path);
  thr_sheets_cord_words(s, a->cord, cord);
  int n = snprintf(line, sizeof line, "%s%s%s%s%s: ", cord, single ? " (" : "", single ? own.name : "", single ? ")" : "",
                   a->needle == THR_NEEDLE_RIGHT  ? ", right needle"
                   : a->needle == THR_NEEDLE_LEFT ? ", left needle"
                                                  : "");
  n += snprintf(line + n, sizeof line - (size_t)n, a == b ? "pass %d" : "passes %d-%d", a->pass + 1, b->pass + 1);
  snprintf(line + n, sizeof line - (size_t)n, " of %d", s->plan->cord[a->cord].n_passes);
  snprintf(colour, sizeof colour, " font-weight=\"bold\" style=\"fill:%s\"", own.hex);
  snprintf(big, sizeof big, "%d", s->n_steps);
  thr_text tally = {0};
  put_tally(s, p, &tally);
  double x = THR_SHEET_MARGIN, y = top + 6.5;
  thr_svg_text(thr_sheets_out(s), x, y, NUMBER, " font-weight=\"bold\"", big);
  x += fmax(14, 0.72 * NUMBER * (double)strlen(big) + 3);
  thr_svg_text(thr_sheets_out(s), x, top + 3.5, 4.4, colour, line);
  if (tally.failed)
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  else
    thr_sheets_text(s, x, top + 9, THR_SHEET_SMALL, thr_sheets_width(s) + THR_SHEET_MARGIN - x, " style=\"fill:#444\"",
                    tally.data);
  thr_text_destroy(&tally);
}

/* ---- the picture ---- */

static double text_height(const step *p)
{
  return (p->all_lines + 1) * THR_SHEET_LINE;
}

/* The small picture beside the text is about as high as that. */
static void locator_size(const thr_sheets *s, const step *p, double size[2])
{
  size[0] = fmin(fmax(text_height(p) - 3, LOCATOR[0]), LOCATOR[1]);
  size[1] = fmin(s->crops.slender, 1) * size[0];
}

/* Height of what is below the picture, mm. */
static double height_below(const thr_sheets *s, const step *p)
{
  double locator[2];
  locator_size(s, p, locator);
  return fmax(text_height(p), locator[1] + 4);
}

/* Room for the picture, mm. */
static void picture_room(const thr_sheets *s, const step *p, double room[2])
{
  room[0] = thr_sheets_width(s);
  room[1] = fmax(thr_sheets_bottom(s) - height_below(s, p) - THR_SHEET_MARGIN - HEAD, LEAST_PICTURE[1]);
}

/* Passes of the scene that the moves are, in their order. */
static int list_now(const thr_sheets *s, int first, int end, int *now)
{
  for (int i = first; i < end; i++)
    now[i - first] = s->first_pass[s->move[first].cord] + s->move[i].pass;
  return end - first;
}

/* Does a page take the step with the moves up to before end, with every pass numbered in the picture? Fills what it shows. */
static bool is_good(thr_sheets *s, step *p)
{
  int now[MOST_MOVES], n = p->end - p->first;
  find_text(s, p);
  if (s->st || (n > 1 && (p->lines > MOST_LINES || (n > USUAL_MOVES && p->lines > FEW_LINES)))) return n == 1;
  thr_crop crop = {.now = now, .n_now = list_now(s, p->first, p->end, now)};
  double room[2];
  picture_room(s, p, room);
  thr_status st = thr_crop_fit(&s->crops, &crop, room, LEAST_PICTURE, &p->view, &s->why);
  if (st) thr_sheets_fail(s, st, NULL);
  return n == 1 || p->view.scale <= SMALLEST;
}

/* The move after the last one that could be in the step: another cord, needle or colour begins there. */
static int end_of_part(const thr_sheets *s, int first)
{
  const thr_move *m = &s->move[first];
  int end = first + 1;
  while (end < s->n_moves && end < first + MOST_MOVES && !begins(s, end) &&
         (s->plan->n_cords > 1 || s->move[end].pass / THR_COLOUR_PASSES == m->pass / THR_COLOUR_PASSES))
    end++;
  return end;
}

/* How many moves it takes: as many as are good; of those that need several steps alike many in each. */
static void choose_end(thr_sheets *s, step *p)
{
  int part = end_of_part(s, p->first) - p->first, n = 1;
  p->end = p->first + part;
  if (!is_good(s, p)) {
    for (p->end = p->first + 2; n < part && is_good(s, p); p->end++)
      n++;
    int steps = (part + n - 1) / n;
    p->end = p->first + (part + steps - 1) / steps;
    is_good(s, p);
  }
  if (p->view.scale >= THR_CROP_SCALES) p->view.scale = THR_CROP_SCALES - 1;
}

static void put_pictures(thr_sheets *s, const step *p, double top, unsigned char *state, bool *filled)
{
  int now[MOST_MOVES];
  thr_box shown[2] = {{0}};
  for (int i = 0; i < s->n_moves; i++)
    state[i] = s->moved[i] < p->first ? THR_DRAW_EARLIER : s->moved[i] < p->end ? THR_DRAW_NOW : THR_DRAW_HIDDEN;
  for (int e = 0; e < s->f->n_edges; e++)
    filled[e] = s->threaded[e] < p->first;
  thr_crop crop = {.number = s->n_steps, .state = state, .filled = filled, .now = now};
  crop.n_now = list_now(s, p->first, p->end, now);
  crop.backward = s->move[p->first].needle == THR_NEEDLE_LEFT;
  double at[2] = {0.5 * (s->size[0] - p->view.size[0]), top + HEAD}, right = s->size[0] - THR_SHEET_MARGIN, locator[2];
  locator_size(s, p, locator);
  thr_text *t = thr_sheets_out(s);
  thr_status st = thr_grow(&s->locator, s->n_locators, &s->locators_capacity, sizeof *s->locator, &s->why);
  if (!st) st = thr_crop_draw(&s->crops, &crop, &p->view, at, shown, t, &s->why);
  s->y = at[1] + p->view.size[1];
  if (st)
    thr_sheets_fail(s, st, NULL);
  else
    s->locator[s->n_locators++] = (thr_locator){.page = s->n_pages,
                                                .first = p->first,
                                                .end = p->end,
                                                .view = p->view,
                                                .shown = {shown[0], shown[1]},
                                                .paper = {right - locator[0], s->y + 3, right, s->y + 3 + locator[1]}};
}

void thr_sheets_locate(const thr_sheets *s, int page, thr_text *t)
{
  for (int i = 0; i < s->n_locators; i++) {
    int now[MOST_MOVES];
    const thr_locator *l = &s->locator[i];
    if (l->page != page) continue;
    thr_crop crop = {.now = now, .n_now = list_now(s, l->first, l->end, now)};
    crop.backward = s->move[l->first].needle == THR_NEEDLE_LEFT;
    thr_crop_locate(&s->crops, &crop, &l->view, l->shown, l->paper, t);
  }
}

/* ---- rows ---- */

static void put_words(thr_sheets *s, const thr_text *words, const char *attributes)
{
  if (words->data)
    s->y = thr_sheets_text(s, THR_SHEET_MARGIN, s->y, THR_SHEET_TEXT, text_width(s) + BOX, attributes, words->data);
}

static void put_rows(thr_sheets *s, const step *p)
{
  s->y += 1.5 + THR_SHEET_LINE;
  put_words(s, &p->before, " style=\"fill:#444\"");
  for (int i = 0; i < p->n_rows && !s->st; i++) {
    thr_sheets_box(thr_sheets_out(s), THR_SHEET_MARGIN, s->y);
    s->y = thr_sheets_text(s, THR_SHEET_MARGIN + BOX, s->y, THR_SHEET_TEXT, text_width(s), "", p->row[i].data);
  }
  s->y += 1;
  put_words(s, &p->after, " font-weight=\"bold\"");
}

/* Where the step begins: on the page of the one before if it fits there whole, below a rule, else on a page of its own. */
static double find_top(thr_sheets *s, double height)
{
  double y = s->y + BETWEEN;
  bool follows = s->n_pages == s->step_page && y + height <= thr_sheets_bottom(s);
  if (follows)
    thr_text_printf(thr_sheets_out(s), "<path stroke=\"#999\" stroke-width=\"0.20\" d=\"M%.2f %.2fh%.2f\"/>\n", THR_SHEET_MARGIN,
                    s->y + 0.5 * BETWEEN, thr_sheets_width(s));
  else
    thr_sheets_page(s, "", "");
  s->step_page = s->n_pages;
  return follows ? y : THR_SHEET_MARGIN;
}

/* Before each step: it may be stopped there. */
static void poll(thr_sheets *s, int first)
{
  const thr_limits *l = s->limits;
  if (l->advance) l->advance(l->user, "pages of the step sheets", (double)first / s->n_moves);
  if (thr_limits_stop(l))
    thr_sheets_fail(s, thr_fail(&s->why, THR_ELIMIT, "interrupted at page %d of the step sheets", s->n_pages + 1), NULL);
}

static void put_step(thr_sheets *s, const step *p, unsigned char *state, bool *filled)
{
  double height = HEAD + p->view.size[1] + height_below(s, p), top = find_top(s, height);
  s->n_steps++;
  if (!s->st) put_heading(s, p, top);
  if (!s->st) put_pictures(s, p, top, state, filled);
  if (!s->st) put_rows(s, p);
  s->y = top + height;
}

void thr_sheets_steps(thr_sheets *s, int c)
{
  thr_text row[MOST_MOVES + 1] = {{0}};
  step p = {.first = s->first_move[c], .row = row};
  unsigned char *state = thr_calloc((size_t)s->n_moves, sizeof *state);
  bool *filled = thr_calloc((size_t)s->f->n_edges, sizeof *filled);
  int end = p.first + s->plan->cord[c].n_passes;
  if (!state || !filled) thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  while (p.first < end && !s->st) {
    poll(s, p.first);
    if (!s->st) choose_end(s, &p);
    if (!s->st) put_step(s, &p, state, filled);
    destroy_text(&p);
    p.first = p.end;
  }
  free(state);
  free(filled);
}
