/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Step sheets: the PDF's text as pdftotext finds it, read row by row back into half-edges and
 * compared with the plan; sizes of pages and letters; every pass of a step numbered in its picture.
 */
#define _POSIX_C_SOURCE 200809L
#include "diagram/export/paper.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets.h"
#include "diagram/tables/tables.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/number.h"
#include "tests/frameworks.h"
#include "tests/sample_plans.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double SEVEN_POINTS = 7 * 25.4 / 72; /* mm */
static const thr_limits none;

/* ---- making them ---- */

static thr_sheets_options options_of(thr_page_size page, bool middle)
{
  thr_sheets_options o = thr_sheets_options_default();
  o.page = page;
  o.needles = middle ? 2 : 1;
  return o;
}

static thr_sheets *sheets_of(const thr_plan *p, thr_page_size page, bool middle)
{
  thr_err err = {0};
  thr_sheets *s;
  const thr_sheets_options o = options_of(page, middle);
  ck_assert_msg(thr_sheets_make(&s, p, &o, &none, &err) == THR_OK, "%s", err.text);
  return s;
}

static thr_text pdf_in_threads(const thr_plan *p, thr_page_size page, bool middle, int threads)
{
  thr_text t = {0};
  thr_err err = {0};
  int n;
  const thr_sheets_options o = options_of(page, middle);
  const thr_limits limits = {.threads = threads};
  ck_assert_msg(thr_sheets_write(p, &o, &limits, &n, &t, &err) == THR_OK, "%s", err.text);
  return t;
}

static thr_text pdf_of(const thr_plan *p, thr_page_size page, bool middle)
{
  return pdf_in_threads(p, page, middle, 0);
}

/* What a poppler tool says of a PDF. */
static thr_text told_by(const char *tool, const thr_text *pdf)
{
  char path[] = "/tmp/test_sheets_XXXXXX", command[128];
  int file = mkstemp(path);
  ck_assert(file >= 0);
  ck_assert(write(file, pdf->data, pdf->length) == (ssize_t)pdf->length);
  close(file);
  snprintf(command, sizeof command, "%s %s -", tool, path);
  FILE *told = popen(command, "r");
  ck_assert_ptr_nonnull(told);
  thr_text t = {0};
  char part[4096];
  for (size_t n; (n = fread(part, 1, sizeof part, told)) > 0;)
    thr_text_append_bytes(&t, part, n);
  ck_assert_int_eq(pclose(told), 0);
  unlink(path);
  ck_assert(t.data && !t.failed);
  return t;
}

/* ---- reading back ---- */

enum { MOST_WORDS = 200 };

typedef struct {
  const thr_plan *p;
  thr_guide guide; /* for the places' names */
  int **half;      /* [n_cords][n_passes] as read, -1 = not yet */
  bool solid;
  int n_pieces;
  int *cord, *row, *step; /* [pieces] where it was picked up: -1 = nowhere yet */
  char (*kind)[16];       /* [pieces] as the row calls it that picks it up; "" = none does */
  int now;                /* step that is read */
  int at, due; /* node where the needle is, and the one that it goes to next; -1 = not known */
} reader;

static reader reader_make(const thr_plan *p)
{
  reader r = {.p = p, .at = -1, .due = -1, .solid = p->options.joint == THR_JOINT_SOLID};
  r.n_pieces = r.solid ? p->frame.n_nodes : p->frame.n_edges;
  ck_assert_int_eq(thr_guide_make(&r.guide, &p->frame, NULL, NULL), THR_OK);
  r.half = calloc((size_t)p->n_cords, sizeof *r.half);
  r.cord = calloc((size_t)r.n_pieces, sizeof *r.cord);
  r.row = calloc((size_t)r.n_pieces, sizeof *r.row);
  r.step = calloc((size_t)r.n_pieces, sizeof *r.step);
  r.kind = calloc((size_t)r.n_pieces, sizeof *r.kind);
  ck_assert(r.half && r.cord && r.row && r.step && r.kind);
  for (int i = 0; i < r.n_pieces; i++)
    r.cord[i] = -1;
  for (int c = 0; c < p->n_cords; c++) {
    r.half[c] = malloc((size_t)p->cord[c].n_passes * sizeof **r.half);
    ck_assert_ptr_nonnull(r.half[c]);
    for (int k = 0; k < p->cord[c].n_passes; k++)
      r.half[c][k] = -1;
  }
  return r;
}

static void reader_destroy(reader *r)
{
  for (int c = 0; c < r->p->n_cords; c++)
    free(r->half[c]);
  free(r->half);
  free(r->cord);
  free(r->row);
  free(r->step);
  free(r->kind);
  thr_guide_destroy(&r->guide);
}

static int place_named(const reader *r, const char *name)
{
  for (int v = 0; v < r->p->frame.n_nodes; v++)
    if (strcmp(r->guide.label[v], name) == 0) return v;
  ck_abort_msg("no place is called %s", name);
}

static int cord_named(const reader *r, const char *id, size_t n)
{
  for (int c = 0; c < r->p->n_cords; c++)
    if (strlen(r->p->cord[c].id) == n && strncmp(r->p->cord[c].id, id, n) == 0) return c;
  ck_abort_msg("no cord is called %.*s", (int)n, id);
}

/* The needle goes over an edge as pass number k + 1 of cord c, forwards or (left needle) backwards.
 * Returns its edge. */
static int go(reader *r, int c, int k, bool forwards, int from, int to)
{
  int e = thr_frame_edge_between(&r->p->frame, from, to);
  ck_assert_msg(e >= 0, "nothing between %s and %s", r->guide.label[from], r->guide.label[to]);
  int h = 2 * e + (r->p->frame.edge[e][0] != from);
  ck_assert(k >= 0 && k < r->p->cord[c].n_passes && r->half[c][k] < 0);
  r->half[c][k] = forwards ? h : h ^ 1;
  return e;
}

/* The novice takes a piece out of the box, once. */
static void take(reader *r, int piece, int c, int row)
{
  ck_assert_msg(r->cord[piece] < 0, "piece %d is taken twice", piece);
  r->cord[piece] = c;
  r->row[piece] = row;
  r->step[piece] = r->now;
}

/* Blank-separated words; returns how many. */
static int words_of(char *line, char **word)
{
  int n = 0;
  for (char *w = strtok(line, " "); w && n < MOST_WORDS; w = strtok(NULL, " "))
    word[n++] = w;
  return n;
}

/* "A" or "A-B" at the beginning, numbers from 1; returns what follows. */
static const char *read_range(const char *s, int *first, int *last)
{
  char *end;
  *first = *last = (int)strtol(s, &end, 10);
  ck_assert(end > s);
  if (*end == '-') *last = (int)strtol(end + 1, &end, 10);
  return end;
}

/* The place that a text begins with, followed by one of these; *s moves behind it. */
static int read_name(const reader *r, const char **s, const char *followers)
{
  int found = -1;
  size_t longest = 0;
  for (int v = 0; v < r->p->frame.n_nodes; v++) {
    size_t n = strlen(r->guide.label[v]);
    if (n <= longest || strncmp(r->guide.label[v], *s, n) != 0 || !strchr(followers, (*s)[n]))
      continue;
    found = v;
    longest = n;
  }
  ck_assert_msg(found >= 0, "no place is called as in: %s", *s);
  *s += longest;
  return found;
}

static bool skip(const char **s, const char *word)
{
  size_t n = strlen(word);
  if (strncmp(*s, word, n) != 0) return false;
  *s += n;
  return true;
}

/* A piece by its place, or a tube by both of its places. */
static int read_piece(const reader *r, const char **s)
{
  if (r->solid) return read_name(r, s, " ),:");
  int a = read_name(r, s, "-");
  ++*s;
  int e = thr_frame_edge_between(&r->p->frame, a, read_name(r, s, " ),:"));
  ck_assert_int_ge(e, 0);
  return e;
}

/* "X-10 (B5): ", "tube 2 (A1-A2): ", or of very many kinds with one member "24 (an X): ". */
static int read_new(reader *r, const char **s, int c, int row)
{
  const char *open = strstr(*s, " ("), *colon = strstr(*s, ": "), *inside = open + 2;
  ck_assert_ptr_nonnull(colon);
  bool alone = !open || open > colon || strncmp(inside, "an ", 3) == 0 ||
               strncmp(inside, "a ", 2) == 0 || strncmp(inside, "with ", 5) == 0;
  int piece = read_piece(r, alone ? s : &inside);
  if (!alone) snprintf(r->kind[piece], 16, "%.*s", (int)(open - *s), *s);
  *s = colon + 2;
  take(r, piece, c, row);
  return piece;
}

/* "F5, on cord A: ", "F5, on since step 3: ", "F5, your row 12: ", "F5, on the cord since its
 * start: ": a piece that was taken there.
 */
static int read_held(reader *r, const char **s, int c)
{
  int piece = read_piece(r, s);
  ck_assert_int_ge(r->cord[piece], 0);
  if (skip(s, ", on cord ")) {
    size_t n = strcspn(*s, ":");
    ck_assert_int_eq(cord_named(r, *s, n), r->cord[piece]);
    ck_assert_int_ne(r->cord[piece], c);
  } else {
    ck_assert_int_eq(r->cord[piece], c);
    if (skip(s, ", on since step ")) {
      ck_assert_int_eq(atoi(*s), r->step[piece]);
      ck_assert_int_lt(r->step[piece], r->now);
    } else if (skip(s, ", your row ")) {
      ck_assert_int_eq(atoi(*s), r->row[piece]);
      ck_assert_int_eq(r->step[piece], r->now);
    } else {
      ck_assert_msg(skip(s, ", on the cord since its start"), "%s", *s);
      ck_assert_int_eq(r->row[piece], 0);
    }
  }
  *s = strstr(*s, ": ");
  ck_assert_ptr_nonnull(*s);
  *s += 2;
  return piece;
}

/* "4 pick up X-10 (B5): in from A5, out to C5": with the piece before and the arm by which it was
 * left, a pass. */
static void read_row(reader *r, int c, char *line, bool left)
{
  const char *s = line;
  char *join = strstr(line, "; join on ");
  if (join) *join = '\0';
  int row = skip(&s, "S ") ? 0 : (int)strtol(s, (char **)&s, 10);
  s += *s == ' ';
  bool starts = strncmp(s, "start", 5) == 0;
  ck_assert_int_eq(starts, row == 0);
  if (!skip(&s, "start, ") && !skip(&s, "start in ")) skip(&s, "back ");
  skip(&s, "through ");
  int piece = skip(&s, "pick up ") ? read_new(r, &s, c, row) : read_held(r, &s, c);
  if (!r->solid) {
    ck_assert(skip(&s, "in at "));
    int in = read_name(r, &s, ",");
    ck_assert(skip(&s, ", out at "));
    int out = read_name(r, &s, "");
    ck_assert(r->at < 0 || in == r->at);
    ck_assert(r->due < 0 || out == r->due);
    ck_assert_int_eq(go(r, c, row - 1, !left, in, out), piece);
    r->at = out;
    r->due = -1;
    return;
  }
  if (!starts) {
    ck_assert(skip(&s, "in from "));
    int in = read_name(r, &s, ",");
    ck_assert(skip(&s, ", "));
    ck_assert(r->at < 0 || (in == r->at && piece == r->due));
    go(r, c, row - 1, !left, in, piece);
  }
  r->at = piece;
  r->due = skip(&s, "out to ") ? read_name(r, &s, "") : -1;
  ck_assert(!join || r->p->frame.foot[piece]);
  ck_assert_msg(*s == '\0' || strcmp(s, "here the end comes out") == 0, "%s", s);
}

/* "Check: the left needle comes out of foot F12 (node 3) and points at E12." Tubes: "comes out at
 * F12; next E12." */
static void read_check(reader *r, char *line)
{
  char *word[MOST_WORDS], *out = strstr(line, r->solid ? "comes out of " : "comes out at ");
  char *next = strstr(line, r->solid ? " and points at " : "; next ");
  ck_assert_ptr_nonnull(out);
  const char *s = out + strlen("comes out at ");
  skip(&s, "foot ");
  ck_assert_int_eq(read_name(r, &s, " ;:"), r->at);
  if (!next) {
    if (r->solid) ck_assert_int_eq(r->due, -1);
    r->at = r->due = -1;
    return;
  }
  ck_assert_int_eq(words_of(next + strlen(r->solid ? " and points at " : "; next "), word), 1);
  ck_assert(word[0][strlen(word[0]) - 1] == '.');
  word[0][strlen(word[0]) - 1] = '\0';
  if (r->solid) ck_assert_int_eq(place_named(r, word[0]), r->due);
  r->due = place_named(r, word[0]);
}

/* A place in a list; in brackets if the piece holds cord already. */
static int read_place(const reader *r, char *word, bool *held)
{
  *held = *word == '(' && word[strlen(word) - 1] == ')';
  if (*held) {
    word++;
    word[strlen(word) - 1] = '\0';
  }
  return place_named(r, word);
}

/* "Cord B, left needle, passes 7-1: G1 to F1 (E1)": rest continues it until all places are there.
 * Returns whether they are. */
static bool read_places(reader *r, const char *row)
{
  int first, last;
  size_t id = strcspn(row + strlen("Cord "), ",");
  int c = cord_named(r, row + strlen("Cord "), id);
  bool left = strstr(row, "left needle, ") != NULL, held;
  const char *range = strstr(row, "pass");
  range += strcspn(range, " ") + 1;
  const char *s = read_range(range, &first, &last);
  char copy[4096], *word[MOST_WORDS];
  ck_assert(*s == ':');
  snprintf(copy, sizeof copy, "%s", s + 1);
  int n = words_of(copy, word), passes = abs(last - first) + 1;
  if (n < passes + 2) return false;
  ck_assert_str_eq(word[1], "to");
  int at = read_place(r, word[0], &held);
  if (r->solid && !held) take(r, at, c, 0);
  for (int i = 0; i < passes; i++) {
    int number = left ? first - i : first + i, next = read_place(r, word[i + 2], &held);
    int e = go(r, c, number - 1, !left, at, next), piece = r->solid ? next : e;
    ck_assert_int_eq(held, r->cord[piece] >= 0);
    if (!held) take(r, piece, c, number);
    at = next;
  }
  return true;
}

static bool starts(const char *line, const char *word)
{
  return strncmp(line, word, strlen(word)) == 0;
}

/* Does a line begin a row of a step: its number, then what is done? */
static bool is_row(const char *line)
{
  if (starts(line, "S start")) return true;
  size_t digits = strspn(line, "0123456789");
  return digits && line[digits] == ' ' &&
         (starts(line + digits + 1, "pick up ") || starts(line + digits + 1, "through ") ||
          starts(line + digits + 1, "back through "));
}

/* Two rows side by side may be told as one line: breaks it before the number of the second. */
static void split_rows(char *text)
{
  static const char *const deeds[] = {" pick up ", " through ", " back through "};
  for (int i = 0; i < 3; i++)
    for (char *s = strstr(text, deeds[i]); s; s = strstr(s + 1, deeds[i])) {
      char *number = s;
      while (number > text && isdigit((unsigned char)number[-1]))
        number--;
      if (number < s && number > text && number[-1] == ' ') number[-1] = '\n';
    }
}

/* "12 Cord B (blue), left needle: passes 7-1 of 24": the number of the step, and what it is about.
 */
static void read_heading(reader *r, const char *line, const char *title, int *cord, bool *left)
{
  r->now = atoi(line);
  ck_assert_int_gt(r->now, 0);
  *cord = cord_named(r, title + strlen("Cord "), strcspn(title + strlen("Cord "), " ,:"));
  *left = strstr(line, "left needle") != NULL;
}

/* Joins the lines of a row: it ends where the next one, or what is no row, begins. */
static void read_text(reader *r, char *text)
{
  char row[4096] = "", step[4096] = "";
  int cord = -1;
  bool left = false;
  split_rows(text);
  for (char *line = strtok_r(text, "\n\f", &text); line; line = strtok_r(NULL, "\n\f", &text)) {
    const char *title = line + strspn(line, "0123456789 "); /* behind the number of the step */
    bool heading = starts(title, "Cord ") && strstr(title, " of ") && strstr(title, ": pass");
    bool begins = cord >= 0 && is_row(line), check = starts(line, "Check: the ");
    bool places = starts(line, "Cord ") && strstr(line, ", pass") && strstr(line, " to ");
    if (step[0] && (heading || begins || check)) {
      read_row(r, cord, step, left);
      step[0] = '\0';
    }
    if (heading) {
      read_heading(r, line, title, &cord, &left);
    } else if (begins) {
      snprintf(step, sizeof step, "%s", line);
    } else if (check) {
      read_check(r, line);
    } else if (step[0]) {
      strncat(step, " ", sizeof step - strlen(step) - 1);
      strncat(step, line, sizeof step - strlen(step) - 1);
    } else if (places || row[0]) {
      if (!places) strncat(row, " ", sizeof row - strlen(row) - 1);
      strncat(row, line, sizeof row - strlen(row) - 1);
      if (read_places(r, row)) row[0] = '\0';
    }
  }
  ck_assert_msg(!row[0] && !step[0], "%s%s", row, step);
}

/* Pieces of one kind, as the rows call them, have arms that are as long; a kind's letter is that of
 * its arms. */
static void assert_kinds(const reader *r)
{
  const thr_frame *f = &r->p->frame;
  for (int a = 0; a < r->n_pieces; a++) {
    const char *kind = r->kind[a];
    if (!*kind || !r->solid) continue;
    int arms = thr_degree(f, a), said = *kind == 'P'          ? 1
                                        : strchr("IL", *kind) ? 2
                                        : strchr("TY", *kind) ? 3
                                                              : atoi(kind);
    ck_assert_int_eq(arms, *kind == 'X' ? 4 : said);
    for (int b = 0; b < a; b++)
      if (strcmp(kind, r->kind[b]) == 0) ck_assert_int_eq(arms, thr_degree(f, b));
  }
}

static void assert_reads_back(const thr_plan *p, const thr_text *pdf)
{
  reader r = reader_make(p);
  thr_text text = told_by("pdftotext -raw", pdf);
  read_text(&r, text.data);
  for (int c = 0; c < p->n_cords; c++)
    for (int k = 0; k < p->cord[c].n_passes; k++)
      ck_assert_msg(r.half[c][k] == p->cord[c].half[k], "cord %s, pass %d", p->cord[c].id, k + 1);
  for (int i = 0; i < r.n_pieces; i++)
    ck_assert_msg(r.cord[i] >= 0, "piece %d is left over", i);
  assert_kinds(&r);
  thr_text_destroy(&text);
  reader_destroy(&r);
}

/* ---- sizes ---- */

/* The next attribute name="number" at or after *s, which is set behind it. */
static bool next_number(const char **s, const char *name, double *value)
{
  *s = strstr(*s, name);
  if (!*s) return false;
  *s += strlen(name);
  *value = strtod(*s, NULL);
  return true;
}

/* Pages of the size asked for, no word beyond their edges and none smaller than 7 pt. */
static void assert_pages(const thr_text *pdf, int n_pages, double width, double height)
{
  thr_text boxes = told_by("pdftotext -bbox", pdf);
  const char *s = boxes.data;
  int pages = 0, words = 0;
  double x0, y0, x1, y1, w = 0, h = 0;
  for (const char *page = strstr(s, "<page "); page; page = strstr(page, "<page ")) {
    ck_assert(next_number(&page, "width=\"", &w) && next_number(&page, "height=\"", &h));
    ck_assert_double_eq_tol(w * 25.4 / 72, width, 0.01);
    ck_assert_double_eq_tol(h * 25.4 / 72, height, 0.01);
    pages++;
  }
  ck_assert_int_eq(pages, n_pages);
  while (next_number(&s, "xMin=\"", &x0)) {
    ck_assert(next_number(&s, "yMin=\"", &y0) && next_number(&s, "xMax=\"", &x1) &&
              next_number(&s, "yMax=\"", &y1));
    ck_assert_msg(x0 > 15 && x1 < w - 15 && y0 > 15 && y1 < h - 15, "a word at %g %g .. %g %g pt",
                  x0, y0, x1, y1);
    ck_assert_msg(y1 - y0 > 7, "a word %g pt high", y1 - y0);
    words++;
  }
  ck_assert_int_gt(words, 50);
  thr_text_destroy(&boxes);
}

/* What is set in every page's SVG, and that nothing in it is scaled. */
static void assert_letters(const thr_text *svg)
{
  const char *s = svg->data;
  double size, least = 1e9;
  while (next_number(&s, "font-size=\"", &size))
    least = size < least ? size : least;
  ck_assert_msg(least >= SEVEN_POINTS && least < 100, "letters of %g mm", least);
  ck_assert(!strstr(svg->data, "scale(") && !strstr(svg->data, "matrix(") &&
            !strstr(svg->data, "nan"));
}

/* ---- pictures ---- */

/* The picture that begins at view, and ends at end: the passes that its heading names have one
 * number each in it, and no two numbers overlap. */
static void assert_picture(const char *page, const char *view, const char *end)
{
  enum { MOST = 64 };
  const char *heading = NULL;
  for (const char *h = strstr(page, ">Cord "); h && h < view; h = strstr(h + 1, ">Cord "))
    heading = h;
  ck_assert_ptr_nonnull(heading);
  const char *of = strstr(heading, ": pass");
  ck_assert(of && of < strchr(heading + 1, '<'));
  int first, last, seen[MOST] = {0}, n = 0;
  double x[MOST], y[MOST], w[MOST];
  read_range(strpbrk(of, "0123456789"), &first, &last);
  int low = first < last ? first : last, high = first < last ? last : first;
  for (const char *s = strstr(view, "class=\"pill\""); s && s < end;
       s = strstr(s, "class=\"pill\"")) {
    ck_assert(n < MOST && next_number(&s, "x=\"", &x[n]) && next_number(&s, "y=\"", &y[n]) &&
              next_number(&s, "width=\"", &w[n]));
    s = strstr(s, "<text");
    s = strchr(s, '>') + 1;
    s += strcspn(s, "0123456789");
    int number = atoi(s);
    ck_assert_msg(number >= low && number <= high, "%d in a picture of passes %d-%d", number, low,
                  high);
    ck_assert_int_eq(seen[number - low]++, 0);
    for (int i = 0; i < n; i++)
      ck_assert_msg(x[i] + w[i] < x[n] + 0.01 || x[n] + w[n] < x[i] + 0.01 || y[i] + 3.49 < y[n] ||
                        y[n] + 3.49 < y[i],
                    "numbers on each other among %d-%d: %g %g, %g %g", low, high, x[i], y[i], x[n],
                    y[n]);
    n++;
  }
  ck_assert_int_eq(n, high - low + 1);
}

/* Pictures of steps on a page. Each is wholly above the next step, and above the foot of the page.
 */
static int count_pictures(const thr_text *svg, double height)
{
  static const char group[] = "<g class=\"view-", frame[] = "<clipPath ";
  int n = 0;
  double below = 0, y, high;
  for (const char *view = strstr(svg->data, group), *next; view; view = next, n++) {
    next = strstr(view + 1, group);
    const char *end = next ? next : svg->data + svg->length;
    assert_picture(svg->data, view, end);
    double low = below;
    for (const char *s = strstr(view, frame); s && s < end; s = strstr(s, frame)) {
      ck_assert(next_number(&s, " y=\"", &y) && next_number(&s, " height=\"", &high));
      ck_assert_msg(y > low && y + high < height - 21, "a picture from %g to %g mm", y, y + high);
      below = y + high > below ? y + high : below;
    }
  }
  return n;
}

/* ---- the tests ---- */

static void judge(thr_plan p, bool middle, thr_page_size page)
{
  double size[2];
  thr_sheets *s = sheets_of(&p, page, middle);
  thr_text pdf = pdf_of(&p, page, middle);
  int n = thr_sheets_pages(s), steps = 0;
  thr_page_mm(page, size);
  assert_pages(&pdf, n, size[0], size[1]);
  assert_reads_back(&p, &pdf);
  for (int i = 0; i < n; i++) {
    thr_text svg = {0};
    ck_assert_int_eq(thr_sheets_svg(s, i, &svg, NULL), THR_OK);
    assert_letters(&svg);
    steps += count_pictures(&svg, size[1]);
    thr_text_destroy(&svg);
  }
  ck_assert_int_ge(steps, 1);
  thr_text_destroy(&pdf);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}

START_TEST(plans_are_read_back_from_the_pdf)
{
  thr_plan p = plan_number(_i % N_PLANS);
  if (_i >= N_PLANS) p.options.joint = THR_JOINT_TUBE;
  judge(p, false, _i % 2 ? THR_PAGE_LETTER : THR_PAGE_A4);
}
END_TEST

START_TEST(plans_threaded_from_the_middle_too)
{
  thr_plan p = plan_number(_i % N_PLANS);
  if (_i >= N_PLANS) p.options.joint = THR_JOINT_TUBE;
  judge(p, true, _i % 2 ? THR_PAGE_A4 : THR_PAGE_LETTER);
}
END_TEST

/* A single bead; U-turns; a frame that no view shows without crossings; feet nowhere. */
START_TEST(odd_plans_are_read_back)
{
  rng r = rng_make((uint64_t)_i);
  switch (_i) {
  case 0: judge(plan_of(path_make(2), THR_ENDS_ANY, 1), false, THR_PAGE_A4); break;
  case 1: judge(plan_of(path_make(2), THR_ENDS_CLOSED, 1), false, THR_PAGE_A4); break;
  case 2: judge(plan_of(star_make(7), THR_ENDS_CLOSED, 1), true, THR_PAGE_A4); break;
  case 3: judge(plan_of(no_feet(ring_make(30)), THR_ENDS_CLOSED, 2), true, THR_PAGE_LETTER); break;
  default:
    judge(plan_of(random_frame(&r, 14, 20, LENGTHS_RANDOM), THR_ENDS_ANY, 1), _i % 2, THR_PAGE_A4);
  }
}
END_TEST

/* Sections pick up all pieces once. */
static void assert_sections(const thr_text *pdf, int n_pieces)
{
  thr_text told = told_by("pdftotext -raw", pdf);
  int sections = 0, pieces = 0, last = 0, first, end;
  char *text = told.data;
  for (char *line = strtok_r(text, "\n\f", &text); line; line = strtok_r(NULL, "\n\f", &text)) {
    if (strstr(line, " pieces to lay ready: ")) pieces += atoi(line);
    if (!starts(line, "Section ") || !strstr(line, ": steps ") || strstr(line, "continued"))
      continue;
    ck_assert_int_eq(sscanf(strstr(line, ": steps "), ": steps %d to %d", &first, &end), 2);
    ck_assert_int_eq(first, last + 1);
    ck_assert_int_ge(end, first);
    last = end;
    sections++;
  }
  ck_assert_int_gt(sections, 2);
  ck_assert_int_eq(pieces, n_pieces);
  thr_text_destroy(&told);
}

/* The 1,800 edges of a dome: what hands thread for days. */
START_TEST(a_large_plan_is_read_back)
{
  thr_plan p = plan_of(frame_load("data/jax_fdm/liew_dome.json", NULL), THR_ENDS_FEET, 1);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false);
  assert_reads_back(&p, &pdf);
  assert_pages(&pdf, thr_sheets_pages(s), 210, 297);
  assert_sections(&pdf, p.frame.n_nodes);
  thr_text_destroy(&pdf);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

/* What hands have to know beside the steps, and of this plan: how many pieces and cords, where one
 * starts, where its feet are. */
START_TEST(making_is_told)
{
  static const char *const said[] = {"stopper",
                                     "join",
                                     "went wrong",
                                     "slack",
                                     "Tightening",
                                     "overhand knot",
                                     "16 pieces; 1 cord of ",
                                     "starts at foot A1",
                                     "(feet: A1, A4, D1, D4)"};
  thr_plan p = plan_of(shape_make(THR_MAKE_DOME, 4, 0), THR_ENDS_FEET, 1);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false), told = told_by("pdftotext", &pdf);
  for (char *c = told.data; *c; c++)
    if (*c == '\n') *c = ' ';
  for (size_t i = 0; i < sizeof said / sizeof *said; i++)
    ck_assert_msg(strstr(told.data, said[i]), "\"%s\" is not said", said[i]);
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

/* Lengths of a metre of a cord of 3.4 m: what is cut for it is what its lengths are cut to and what
 * cords.csv says, and rows say where each is joined on. */
START_TEST(lengths_add_up_to_what_is_cut)
{
  thr_plan p = plan_of(shape_make(THR_MAKE_TUBE, 12, 7), THR_ENDS_CLOSED, 1);
  thr_sheets_options o = options_of(THR_PAGE_A4, _i);
  thr_text pdf = {0};
  double cut, sum, more;
  int n, joins = 0, rows = 0;
  o.working_mm = 1000;
  ck_assert_int_eq(thr_sheets_write(&p, &o, &none, &n, &pdf, NULL), THR_OK);
  thr_text told = told_by("pdftotext -raw", &pdf);
  for (char *c = told.data; *c; c++)
    if (*c == '\n' || *c == '\f') *c = ' ';
  ck_assert_int_eq(sscanf(strstr(told.data, "Cord A 1"), "Cord A %*d %*f %*f %*f %*f %lf", &cut),
                   1);
  const char *s = strstr(told.data, "Cord A in "), *end = strstr(s, "). ");
  ck_assert_int_eq(sscanf(s, "Cord A in %d lengths: %lf mm", &n, &sum), 2);
  for (s = strstr(s, "; joined on: ") + 12; s && s < end; s = strchr(s + 1, ','), joins++) {
    ck_assert_int_eq(sscanf(s + 1, "%lf mm after row", &more), 1);
    sum += more;
  }
  for (s = told.data; (s = strstr(s, "; join on ")); s++)
    rows++;
  ck_assert_int_gt(n, 1);
  ck_assert_int_eq(joins, n - 1);
  ck_assert_int_eq(rows, n - 1);
  ck_assert_double_eq_tol(sum, cut, 0.5 * n);

  /* The last column of numbers but one in the only row of the table. */
  thr_text table = {0};
  double listed;
  ck_assert_int_eq(thr_table_cords(&p, NULL, o.needles, o.working_mm, NULL, &table, NULL), THR_OK);
  ck_assert_int_eq(sscanf(strstr(table.data, "\nA,"),
                          "\nA,%*[^,],%*[^,],%*[^,],%*d,%*f,%*f,%*f,%*f,%*f,%lf", &listed),
                   1);
  ck_assert_double_eq_tol(listed, cut, 0.05 + 1e-9);
  thr_text_destroy(&table);
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

/* Of metre-sized pieces a length reaches over 24 interfaces, so that few are joined; the booklet
 * says so. */
START_TEST(lengths_of_large_pieces_are_longer)
{
  thr_plan p = plan_of(shape_make(THR_MAKE_TUBE, 12, 7), THR_ENDS_CLOSED, 1);
  thr_sheets_options o = options_of(THR_PAGE_A4, true);
  thr_text pdf = {0};
  int n;
  snprintf(p.frame.units, sizeof p.frame.units, "m");
  ck_assert_int_eq(thr_sheets_write(&p, &o, &none, &n, &pdf, NULL), THR_OK);
  thr_text told = told_by("pdftotext -raw", &pdf);
  for (char *c = told.data; *c; c++)
    if (*c == '\n' || *c == '\f') *c = ' ';
  ck_assert_ptr_nonnull(strstr(told.data, "(taken for the usual: 24 interfaces; another"));
  ck_assert_int_eq(sscanf(strstr(told.data, "Cord A in "), "Cord A in %d lengths", &n), 1);
  ck_assert_int_le(n, 168 / 24 + 1);
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

/* The goal is the one that was asked for; forces that are given are told, and more where the pieces
 * hold only from more; what no hand, printer or mat can do is not asked for. */
START_TEST(goal_and_forces_are_told)
{
  thr_plan p = plan_of(shape_make(THR_MAKE_DOME, 4, 0), THR_ENDS_FEET, 1);
  thr_eval_cord cord = {.known = true, .pull = THR_PULL_BOTH, .force = 2.5, .other_force = 2};
  const thr_evaluation pulls = {
      .present = true, .physics = p.options.physics, .n_cords = 1, .cord = &cord, .largest = 2.5};
  thr_sheets_options o = options_of(THR_PAGE_A4, false);
  int n;
  o.pulls = &pulls;
  const bool heavy = _i == 2; /* beyond a hand, a printer and pages of paper */
  o.holding = heavy ? 12000 : _i ? 4 : NAN;
  o.weight = 91600;
  o.no_mat = o.too_large = heavy;
  p.options.aims = (thr_aims){1, {_i ? THR_AIM_MAX_TURNING : THR_AIM_PULL}};
  thr_text pdf = {0};
  thr_err err = {0};
  assert_ok(thr_sheets_write(&p, &o, &none, &n, &pdf, &err), &err);
  thr_text told = told_by("pdftotext", &pdf);
  for (char *c = told.data; *c; c++)
    if (*c == '\n') *c = ' ';
  ck_assert_ptr_nonnull(strstr(told.data, _i ? "Goal: as little turning as possible of the cord"
                                             : "Goal: the hardest pull as easy as possible"));
  ck_assert_ptr_nonnull(strstr(told.data, "2.50 N"));
  ck_assert_int_eq(strstr(told.data, "only from 4 times that, 10.0 N") != NULL, _i == 1);
  ck_assert_int_eq(strstr(told.data, "takes 30,000 N at the hardest end") != NULL, heavy);
  ck_assert_int_eq(strstr(told.data, "the pieces weigh about 91,600 N") != NULL, heavy);
  ck_assert_int_eq(strstr(told.data, "Have the pieces made") != NULL, heavy);
  ck_assert_int_eq(strstr(told.data, "out by the overview") != NULL, heavy);
  ck_assert_ptr_null(strstr(told.data, "too hard for a hand"));
  ck_assert_ptr_null(strstr(told.data, "Forces are not known"));
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(a_pdf_tells_no_time_and_no_place)
{
  thr_plan p = plan_of(ring_make(5), THR_ENDS_CLOSED, 1);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false);
  thr_text info = {0};
  thr_text_append_bytes(&info, pdf.data, pdf.length);
  for (size_t i = 0; i < info.length; i++)
    if (!info.data[i]) info.data[i] = ' ';
  const char *date = strstr(info.data, "/CreationDate");
  ck_assert(!date || strstr(date, "20000101"));
  ck_assert(strstr(info.data, "%PDF-") == info.data && !strstr(info.data, "/tmp"));
  thr_text_destroy(&info);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(an_interrupt_stops_the_layout)
{
  volatile sig_atomic_t stop = 1;
  thr_limits limits = {.interrupted = &stop};
  thr_err err = {0};
  thr_plan p = plan_of(ring_make(5), THR_ENDS_CLOSED, 1);
  thr_sheets_options o = thr_sheets_options_default();
  thr_sheets *s;
  thr_text pdf = {0};
  int n;
  ck_assert_int_eq(thr_sheets_make(&s, &p, &o, &limits, &err), THR_ELIMIT);
  assert_one_line(&err, "interrupted at page 3 of the step sheets");
  ck_assert_ptr_null(s);
  ck_assert_int_eq(thr_sheets_write(&p, &o, &limits, &n, &pdf, NULL), THR_ELIMIT);
  ck_assert_uint_eq(pdf.length, 0);
  thr_plan_destroy(&p);
}
END_TEST

static int count_before(const char *s, const char *end, const char *what)
{
  int n = 0;
  for (s = strstr(s, what); s && (!end || s < end); s = strstr(s + 1, what))
    n++;
  return n;
}

/* Of a closed shell, which no flat picture shows whole, each step is one picture. */
START_TEST(a_shell_is_seen_in_space)
{
  int views = 0;
  thr_plan p = plan_number(2);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  for (int i = 0; i < thr_sheets_pages(s); i++) {
    thr_text svg = {0};
    ck_assert_int_eq(thr_sheets_svg(s, i, &svg, NULL), THR_OK);
    for (const char *view = strstr(svg.data, "<g class=\"view-"), *next; view;
         view = next, views++) {
      next = strstr(view + 1, "<g class=\"view-");
      ck_assert_int_eq(count_before(view, next, "<clipPath "), 1);
    }
    ck_assert(!strstr(svg.data, ">from below<") ||
              i == 0); /* the picture of the whole has two halves */
    thr_text_destroy(&svg);
  }
  ck_assert_int_gt(views, 6);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

/* A step ends behind a straight run, not within it, where the run is short enough: rows of seven.
 */
START_TEST(steps_end_where_the_cord_turns)
{
  thr_plan p = plan_number(0);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false), told = told_by("pdftotext -raw", &pdf);
  int ends = 0;
  char *text = told.data;
  for (char *line = strtok_r(text, "\n\f", &text); line; line = strtok_r(NULL, "\n\f", &text)) {
    const char *range = strstr(line, ": passes ");
    int first, last;
    if (!starts(line + strspn(line, "0123456789 "), "Cord ") || !range) continue;
    read_range(range + strlen(": passes "), &first, &last);
    const thr_cord *cord = &p.cord[0];
    if (last == cord->n_passes) continue;
    ck_assert_msg(thr_turn_angle(&p.frame, cord->half[last - 1], cord->half[last]) > 0.6,
                  "pass %d goes straight on", last);
    ends++;
  }
  ck_assert_int_gt(ends, 2);
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
}
END_TEST

/* Of a pentagon and a path with a bend of 40 degrees, each closed, the path turns more only with
 * the U-turn into its start: 440 degrees against 360, and it is pulled first. */
START_TEST(cords_are_pulled_in_the_order_of_the_turning_shown)
{
  const double bend[3][3] = {{0}, {1, 0, 0}, {1 + cos(THR_PI / 4.5), sin(THR_PI / 4.5), 0}};
  const int edge[2][2] = {{0, 1}, {1, 2}}, foot[2] = {0, -1};
  thr_frame ring = ring_make(5), path = frame_make(3, bend, 2, edge, NULL, foot);
  thr_plan p = plan_of(side_by_side(&ring, &path), THR_ENDS_CLOSED, 1);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false), told = told_by("pdftotext -layout", &pdf);
  const char *table = strstr(told.data, "Pull the cords tight"), *first, *second;
  ck_assert_ptr_nonnull(table);
  first = strstr(table, " 440\n");
  second = strstr(table, " 360\n");
  ck_assert(first && second && first < second);
  thr_text_destroy(&told);
  thr_text_destroy(&pdf);
  thr_plan_destroy(&p);
  thr_frame_destroy(&ring);
  thr_frame_destroy(&path);
}
END_TEST

START_TEST(plans_that_cannot_be_drawn_are_refused)
{
  thr_err err = {0};
  thr_sheets *s;
  thr_sheets_options o = thr_sheets_options_default();
  thr_plan p = plan_of(ring_make(5), THR_ENDS_CLOSED, 1);
  p.cord[0].half[2] = 99;
  ck_assert_int_eq(thr_sheets_make(&s, &p, &o, &none, &err), THR_EINPUT);
  assert_one_line(&err, "pass 3");
  ck_assert_ptr_null(s);
  thr_cords_destroy(p.cord, p.n_cords);
  p.cord = NULL;
  p.n_cords = 0;
  err = (thr_err){0};
  ck_assert_int_eq(thr_sheets_make(&s, &p, &o, &none, &err), THR_EINPUT);
  assert_one_line(&err, "no cord");
  thr_plan_destroy(&p);
}
END_TEST

static long after(long k)
{
  return k < 400 ? k + 1 : k + 17;
}

START_TEST(every_failing_allocation_is_reported)
{
  thr_plan p = _i ? symmetric_plan(solid_make(TETRAHEDRON), THR_ENDS_ANY, 1, "")
                  : plan_of(path_make(2), THR_ENDS_ANY, 1);
  thr_sheets_options o = thr_sheets_options_default();
  double pose[4][7] = {{0}};
  for (int v = 0; v < p.frame.n_nodes; v++) {
    memcpy(pose[v], p.frame.xyz[v], sizeof p.frame.xyz[v]);
    pose[v][6] = 1;
  }
  const thr_still_panel panel = {"rise-1", "flat", (const double(*)[7])pose};
  const thr_still rise = {"How it comes up", "Seen.", 0.3, 0, 1, &panel, -1};
  o.rise = &rise;
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k = after(k)) {
    thr_sheets *s = NULL;
    thr_alloc_fail_at(k);
    st = thr_sheets_make(&s, &p, &o, &none, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || (st == THR_ENOMEM && !s));
    thr_sheets_destroy(s);
  }
  thr_plan_destroy(&p);
}
END_TEST

/* Every 41st but for the first ones: each finds fonts in a child process. */
START_TEST(every_failing_allocation_of_the_pdf_is_reported)
{
  thr_plan p = plan_of(path_make(2), THR_ENDS_ANY, 1);
  thr_sheets_options o = thr_sheets_options_default();
  thr_status st = THR_ENOMEM;
  int n = 0;
  for (long k = 1; st; k = k < 40 ? k + 1 : k + 41) {
    thr_text pdf = {0};
    thr_alloc_fail_at(k);
    st = thr_sheets_write(&p, &o, &none, &n, &pdf, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || (st == THR_ENOMEM && !pdf.length));
    thr_text_destroy(&pdf);
  }
  thr_plan_destroy(&p);
}
END_TEST

/* In any number of threads the same bytes, and as many pages as are laid out without a file. */
START_TEST(threads_give_the_same_bytes)
{
  thr_plan p = plan_of(shape_make(THR_MAKE_DOME, 12, 0), THR_ENDS_FEET, 1);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  thr_text pdf = pdf_of(&p, THR_PAGE_A4, false),
           other = pdf_in_threads(&p, THR_PAGE_A4, false, 2 + _i);
  assert_pages(&pdf, thr_sheets_pages(s), 210, 297);
  ck_assert(pdf.length == other.length && memcmp(pdf.data, other.data, pdf.length) == 0);
  thr_text_destroy(&pdf);
  thr_text_destroy(&other);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(what_fits_no_room_is_drawn_at_the_smallest_scale)
{
  const int now = 0;
  const double room[2] = {1, 1}, page[2] = {100, 100}, corner[2] = {0, 0};
  thr_plan p = plan_of(shape_make(THR_MAKE_DOME, 4, 0), THR_ENDS_FEET, 1);
  thr_guide guide;
  thr_crops crops;
  thr_crop_view view;
  thr_box shown;
  thr_text picture = {0};
  unsigned char *state = calloc((size_t)p.cord[0].n_passes, 1);
  const thr_crop crop = {.state = state, .now = &now, .n_now = 1};

  ck_assert_ptr_nonnull(state);
  ck_assert_int_eq(thr_guide_make(&guide, &p.frame, NULL, NULL), THR_OK);
  thr_crops_make(&crops, &p, &guide.layout);
  ck_assert_int_eq(thr_crop_fit(&crops, &crop, room, room, &view, NULL), THR_OK);
  ck_assert_int_eq(view.scale, THR_CROP_SCALES - 1);
  thr_crop_fill(&crops, &view, page);
  ck_assert(view.size[0] > 1 && view.size[0] < 20 && view.size[1] > 1 && view.size[1] < 20);
  ck_assert_int_eq(thr_crop_draw(&crops, &crop, &view, corner, &shown, &picture, NULL), THR_OK);
  thr_text_destroy(&picture);
  thr_crops_destroy(&crops);
  thr_guide_destroy(&guide);
  free(state);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("sheets");
  ADD_EXAMPLES(s, 60, plans_are_read_back_from_the_pdf, 2 * N_PLANS);
  ADD_EXAMPLES(s, 60, plans_threaded_from_the_middle_too, 2 * N_PLANS);
  ADD_EXAMPLES(s, 60, odd_plans_are_read_back, 10);
  ADD_LARGE(s, 120, a_large_plan_is_read_back, 0, 1);
  ADD_TEST(s, 20, making_is_told);
  ADD_EXAMPLES(s, 20, lengths_add_up_to_what_is_cut, 2);
  ADD_TEST(s, 20, lengths_of_large_pieces_are_longer);
  ADD_EXAMPLES(s, 20, goal_and_forces_are_told, 3);
  ADD_TEST(s, 20, what_fits_no_room_is_drawn_at_the_smallest_scale);
  ADD_TEST(s, 20, a_pdf_tells_no_time_and_no_place);
  ADD_TEST(s, 20, an_interrupt_stops_the_layout);
  ADD_TEST(s, 20, a_shell_is_seen_in_space);
  ADD_TEST(s, 20, steps_end_where_the_cord_turns);
  ADD_TEST(s, 20, cords_are_pulled_in_the_order_of_the_turning_shown);
  ADD_TEST(s, 20, plans_that_cannot_be_drawn_are_refused);
  ADD_EXAMPLES(s, 20, threads_give_the_same_bytes, 2);
  ADD_EXAMPLES(s, 60, every_failing_allocation_is_reported, 2);
  ADD_TEST(s, 60, every_failing_allocation_of_the_pdf_is_reported);
  return run_suite(s);
}
