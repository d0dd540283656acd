/* The steps of a path: some twenty passes a page, as a picture and in rows to tick off. */
#include "diagram/sheets_parts.h"
#include "diagram/svg.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_MOVES = 48, USUAL_MOVES = 24, FEW_LINES = 14, MOST_LINES = 26, SMALLEST = 6 };
static const double HEAD = 14, NUMBER = 9;       /* mm: heading of a page; its step number */
static const double LOCATOR = 42;                /* mm: side of the small picture beside the rows */
static const double LEAST_PICTURE[2] = {90, 60}; /* mm: width and height */

/* A page: moves first .. end - 1. */
typedef struct {
  int first, end;
  thr_crop_view view;
  int lines;     /* of the text */
  thr_text *row; /* [end - first] words of the rows; the first n_rows are used */
  int n_rows;
} step;

static double text_width(const thr_sheets *s)
{
  return thr_sheets_width(s) - LOCATOR - 9;
}

static void destroy_rows(step *p)
{
  for (int i = 0; i < p->n_rows; i++)
    thr_text_destroy(&p->row[i]);
  p->n_rows = p->lines = 0;
}

/* Fills rows and lines. */
static void find_rows(thr_sheets *s, step *p)
{
  destroy_rows(p);
  for (int i = p->first; i < p->end && !s->st;) {
    thr_text *row = &p->row[p->n_rows++];
    *row = (thr_text){0};
    i = thr_sheets_run(s, i, p->end, row);
    if (row->failed)
      thr_sheets_fail(s, thr_nomem(&s->why), NULL);
    else
      p->lines += thr_sheets_lines(row->data, text_width(s), THR_SHEET_TEXT);
  }
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

/* Colour and words of the passes of the page. */
static void put_heading(thr_sheets *s, const step *p, int number)
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
  snprintf(big, sizeof big, "%d", number);
  thr_text tally = {0};
  put_tally(s, p, &tally);
  double x = THR_SHEET_MARGIN, y = THR_SHEET_MARGIN + 6.5;
  thr_svg_text(thr_sheets_out(s), x, y, NUMBER, " font-weight=\"bold\"", big);
  x += fmax(14, 0.72 * NUMBER * (double)strlen(big) + 3);
  thr_svg_text(thr_sheets_out(s), x, THR_SHEET_MARGIN + 3.5, 4.4, colour, line);
  if (tally.failed)
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  else
    thr_sheets_text(s, x, THR_SHEET_MARGIN + 9, THR_SHEET_SMALL, thr_sheets_width(s) + THR_SHEET_MARGIN - x,
                    " style=\"fill:#444\"", tally.data);
  thr_text_destroy(&tally);
}

/* ---- the picture ---- */

/* Height of the text below the picture, mm; the small picture beside it wants room, too. */
static double text_height(const step *p)
{
  return fmax((p->lines + 3) * THR_SHEET_LINE + 3, LOCATOR + 2 * THR_SHEET_LINE);
}

/* Room for the picture, mm. */
static void picture_room(const thr_sheets *s, const step *p, double room[2])
{
  room[0] = thr_sheets_width(s);
  room[1] = fmax(thr_sheets_bottom(s) - text_height(p) - THR_SHEET_MARGIN - HEAD, LEAST_PICTURE[1]);
}

/* Passes of the scene that the moves are, in their order. */
static int list_now(const thr_sheets *s, const step *p, int *now)
{
  int c = s->move[p->first].cord, first = s->first_pass[c];
  for (int i = p->first; i < p->end; i++)
    now[i - p->first] = first + s->move[i].pass;
  return p->end - p->first;
}

/* Does the page with the moves up to before end take its text, with every pass numbered in the picture? Fills what it shows. */
static bool is_good(thr_sheets *s, step *p)
{
  int now[MOST_MOVES], n = p->end - p->first;
  find_rows(s, p);
  if (s->st || (n > 1 && (p->lines > MOST_LINES || (n > USUAL_MOVES && p->lines > FEW_LINES)))) return n == 1;
  thr_crop crop = {.now = now, .n_now = list_now(s, p, now)};
  double room[2];
  picture_room(s, p, room);
  thr_status st = thr_crop_fit(&s->crops, &crop, room, LEAST_PICTURE, &p->view, &s->why);
  if (st) thr_sheets_fail(s, st, NULL);
  return n == 1 || p->view.scale <= SMALLEST;
}

/* The move after the last one that could be on the page: another cord, needle or colour begins there. */
static int end_of_part(const thr_sheets *s, int first)
{
  const thr_move *m = &s->move[first];
  int end = first + 1;
  while (end < s->n_moves && end < first + MOST_MOVES && !begins(s, end) &&
         (s->plan->n_cords > 1 || s->move[end].pass / THR_COLOUR_PASSES == m->pass / THR_COLOUR_PASSES))
    end++;
  return end;
}

/* How many moves the page takes: as many as are good; of those that need several pages alike many on each. */
static void choose_end(thr_sheets *s, step *p)
{
  int part = end_of_part(s, p->first) - p->first, n = 1;
  for (p->end = p->first + 2; n < part && is_good(s, p); p->end++)
    n++;
  int pages = (part + n - 1) / n;
  p->end = p->first + (part + pages - 1) / pages;
  is_good(s, p);
  if (p->view.scale >= THR_CROP_SCALES) p->view.scale = THR_CROP_SCALES - 1;
}

static void put_pictures(thr_sheets *s, const step *p, unsigned char *state, bool *filled)
{
  int now[MOST_MOVES];
  thr_box shown[2];
  for (int i = 0; i < s->n_moves; i++)
    state[i] = s->moved[i] < p->first ? THR_DRAW_EARLIER : s->moved[i] < p->end ? THR_DRAW_NOW : THR_DRAW_HIDDEN;
  for (int e = 0; e < s->f->n_edges; e++)
    filled[e] = s->threaded[e] < p->first;
  thr_crop crop = {.state = state, .filled = filled, .now = now, .n_now = list_now(s, p, now)};
  crop.backward = s->move[p->first].needle == THR_NEEDLE_LEFT;
  double at[2] = {0.5 * (s->size[0] - p->view.size[0]), THR_SHEET_MARGIN + HEAD}, right = s->size[0] - THR_SHEET_MARGIN;
  thr_text *t = thr_sheets_out(s);
  thr_status st = thr_crop_draw(&s->crops, &crop, &p->view, at, shown, t, &s->why);
  s->y = at[1] + p->view.size[1];
  if (st)
    thr_sheets_fail(s, st, NULL);
  else
    thr_crop_locate(&s->crops, &crop, &p->view, shown, (thr_box){right - LOCATOR, s->y + 3, right, s->y + 3 + LOCATOR}, t);
}

/* ---- rows ---- */

static void put_words(thr_sheets *s, thr_text *words, double width, const char *attributes)
{
  if (words->failed)
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  else if (words->data)
    s->y = thr_sheets_text(s, THR_SHEET_MARGIN, s->y, THR_SHEET_TEXT, width, attributes, words->data);
  thr_text_destroy(words);
}

static void put_rows(thr_sheets *s, const step *p)
{
  thr_text words = {0};
  s->y += 2 + THR_SHEET_LINE;
  put_beginning(s, p->first, &words);
  put_words(s, &words, text_width(s) + 5, " style=\"fill:#444\"");
  for (int i = 0; i < p->n_rows && !s->st; i++) {
    thr_sheets_box(thr_sheets_out(s), THR_SHEET_MARGIN, s->y);
    s->y = thr_sheets_text(s, THR_SHEET_MARGIN + 5, s->y, THR_SHEET_TEXT, text_width(s), "", p->row[i].data);
  }
  put_check(s, p->end - 1, &words);
  s->y += 1;
  put_words(s, &words, text_width(s) + 5, " font-weight=\"bold\"");
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
    choose_end(s, &p);
    thr_sheets_page(s, "", "");
    if (!s->st) put_heading(s, &p, ++s->n_steps);
    if (!s->st) put_pictures(s, &p, state, filled);
    if (!s->st) put_rows(s, &p);
    destroy_rows(&p);
    p.first = p.end;
  }
  free(state);
  free(filled);
}
