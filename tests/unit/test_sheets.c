/* Step sheets: the PDF's text as pdftotext finds it, read row by row back into half-edges and compared with the plan; sizes of
 * pages and letters; every pass of a step numbered in its picture. */
#define _POSIX_C_SOURCE 200809L
#include "diagram/overview/guide.h"
#include "diagram/sheets/sheets.h"
#include "tests/sample_plans.h"
#include "tests/frameworks.h"
#include "diagram/export/paper.h"
#include "graph/limits.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double SEVEN_POINTS = 7 * 25.4 / 72; /* mm */
static const thr_limits none;

/* ---- making them ---- */

static thr_sheets *sheets_of(const thr_plan *p, thr_page_size page, bool middle)
{
  thr_err err = {0};
  thr_sheets *s;
  thr_sheets_options o = thr_sheets_options_default();
  o.page = page;
  o.middle = middle;
  ck_assert_msg(thr_sheets_make(&s, p, &o, &none, &err) == THR_OK, "%s", err.text);
  return s;
}

static thr_text pdf_of(const thr_sheets *s)
{
  thr_text t = {0};
  thr_err err = {0};
  ck_assert_msg(thr_sheets_pdf(s, &none, &t, &err) == THR_OK, "%s", err.text);
  return t;
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
  int *held, *last;
  char (*kind)[16]; /* [n_edges] as the row calls it that picks the bead up; "" = none does */
  int at;           /* node where the needle is; -1 = not known */
  int due;          /* node that the last check announced as the next one; -1 = none */
} reader;

static reader reader_make(const thr_plan *p)
{
  reader r = {.p = p, .at = -1, .due = -1};
  ck_assert_int_eq(thr_guide_make(&r.guide, &p->frame, NULL), THR_OK);
  r.half = calloc((size_t)p->n_cords, sizeof *r.half);
  r.held = calloc((size_t)p->frame.n_edges, sizeof *r.held);
  r.last = calloc((size_t)p->frame.n_edges, sizeof *r.last);
  r.kind = calloc((size_t)p->frame.n_edges, sizeof *r.kind);
  ck_assert(r.half && r.held && r.last && r.kind);
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
  free(r->held);
  free(r->last);
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

/* The needle goes over an edge as pass number k + 1 of cord c, forwards or (left needle) backwards. deed 0 .. 2, -1: not said but
 * whether the bead was new. */
static void go(reader *r, int c, int k, bool forwards, int from, int to, int deed, bool new)
{
  int e = thr_frame_edge_between(&r->p->frame, from, to);
  ck_assert_msg(e >= 0, "no bead between %s and %s", r->guide.label[from], r->guide.label[to]);
  int h = 2 * e + (r->p->frame.edge[e][0] != from);
  ck_assert(k >= 0 && k < r->p->cord[c].n_passes && r->half[c][k] < 0);
  r->half[c][k] = forwards ? h : h ^ 1;
  if (deed >= 0) ck_assert_int_eq(deed, !r->held[e] ? 0 : r->last[e] == h ? 1 : 2);
  ck_assert(new == !r->held[e]);
  r->held[e]++;
  r->last[e] = h;
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

/* " (kinds 1a, 2 x 2)": of the n beads of a row; words are cut up. */
static void read_kinds(reader *r, char *words, const int *edge, int n)
{
  int k = 0, times;
  char *s = strstr(words, " (kind"), name[16];
  if (!s) return;
  s += strcspn(s + 1, " ") + 1;
  bool one = !strchr(s, ',') && !strstr(s, " x ");
  while (*s == ' ') {
    int length = 0;
    ck_assert_msg(sscanf(s, " %15[0-9a-z]%n", name, &length) == 1, "%s", s);
    s += length;
    times = one ? n : 1;
    if (sscanf(s, " x %d%n", &times, &length) == 1) s += length;
    while (times-- > 0 && k < n)
      snprintf(r->kind[edge[k++]], 16, "%s", name);
    s += *s == ',';
  }
  ck_assert_msg(*s == ')' && k == n, "%s", words);
}

/* "pass 4-6: turn left 93 degrees, then straight on, 3 beads, D7 to D6 D5 D4: pick up 3 (kinds 1a, 2 x 2)" */
static void read_row(reader *r, int c, const char *row)
{
  static const char *const deeds[] = {": pick up ", ": pass through ", ": pass back through "};
  int first, last, deed = -1;
  const char *s = read_range(row + strlen("pass "), &first, &last), *deed_at = NULL;
  ck_assert_msg(*s == ':', "%s", row);
  for (int i = 0; i < 3; i++) {
    const char *found = strstr(s + 1, deeds[i]);
    if (found) deed = i, deed_at = found;
  }
  ck_assert_msg(deed >= 0, "%s", row);
  ck_assert_int_eq(atoi(deed_at + strlen(deeds[deed])), abs(last - first) + 1);
  const char *to = strstr(s, " to "), *from = to;
  ck_assert_msg(to && to < deed_at, "%s", row);
  while (from > s && from[-1] != ' ')
    from--;
  char name[64], places[2048], *word[MOST_WORDS];
  snprintf(name, sizeof name, "%.*s", (int)(to - from), from);
  snprintf(places, sizeof places, "%.*s", (int)(deed_at - to - 4), to + 4);
  int at = place_named(r, name), n = words_of(places, word);
  ck_assert_msg(n == abs(last - first) + 1, "%s", row);
  int edge[MOST_WORDS];
  if (r->at >= 0) ck_assert_int_eq(at, r->at);
  for (int i = 0; i < n; i++) {
    int next = place_named(r, word[i]);
    if (i == 0 && r->due >= 0) ck_assert_int_eq(next, r->due);
    go(r, c, (last < first ? first - i : first + i) - 1, s && last >= first, at, next, deed, deed == 0);
    edge[i] = thr_frame_edge_between(&r->p->frame, at, next);
    at = next;
  }
  char kinds[1024];
  snprintf(kinds, sizeof kinds, "%s", deed_at);
  if (deed == 0) read_kinds(r, kinds, edge, n);
  r->at = at;
  r->due = -1;
}

/* A row of one pass does not say which way its numbers run: the heading does. */
static void read_single(reader *r, int c, const char *row, bool left)
{
  if (!left) {
    read_row(r, c, row);
    return;
  }
  int first, last;
  read_range(row + strlen("pass "), &first, &last);
  read_row(r, c, row);
  if (first == last) r->half[c][first - 1] ^= 1;
}

/* "Check: the left needle comes out at foot F12 (node 3); next E12." */
static void read_check(reader *r, char *line)
{
  char *word[MOST_WORDS], *out = strstr(line, "comes out at "), *next = strstr(line, "; next ");
  ck_assert_ptr_nonnull(out);
  out += strlen("comes out at ");
  if (strncmp(out, "foot ", 5) == 0) out += 5;
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)strcspn(out, " ;:"), out);
  ck_assert_int_eq(place_named(r, name), r->at);
  if (!next) {
    r->at = -1;
    return;
  }
  ck_assert_int_eq(words_of(next + strlen("; next "), word), 1);
  ck_assert(word[0][strlen(word[0]) - 1] == '.');
  word[0][strlen(word[0]) - 1] = '\0';
  r->due = place_named(r, word[0]);
}

/* "Cord B, left needle, passes 7-1: G1 to F1 (E1)": rest continues it until all places are there. Returns whether they are. */
static bool read_places(reader *r, const char *row)
{
  int first, last;
  size_t id = strcspn(row + strlen("Cord "), ",");
  int c = cord_named(r, row + strlen("Cord "), id);
  bool left = strstr(row, "left needle, ") != NULL;
  const char *range = strstr(row, "pass");
  range += strcspn(range, " ") + 1;
  const char *s = read_range(range, &first, &last);
  char copy[4096], *word[MOST_WORDS];
  ck_assert(*s == ':');
  snprintf(copy, sizeof copy, "%s", s + 1);
  int n = words_of(copy, word), passes = abs(last - first) + 1;
  if (n < passes + 2) return false;
  ck_assert_str_eq(word[1], "to");
  int at = place_named(r, word[0]);
  for (int i = 0; i < passes; i++) {
    char *name = word[i + 2];
    bool new = *name != '(';
    if (!new) {
      name++;
      ck_assert(name[strlen(name) - 1] == ')');
      name[strlen(name) - 1] = '\0';
    }
    int next = place_named(r, name);
    go(r, c, (left ? first - i : first + i) - 1, !left, at, next, -1, new);
    at = next;
  }
  return true;
}

static bool starts(const char *line, const char *word)
{
  return strncmp(line, word, strlen(word)) == 0;
}

/* Joins the lines of a row: it ends where the next one, or what is no row, begins. */
static void read_text(reader *r, char *text)
{
  char row[4096] = "", step[4096] = "";
  int cord = -1;
  bool left = false;
  for (char *line = strtok_r(text, "\n\f", &text); line; line = strtok_r(NULL, "\n\f", &text)) {
    const char *title = line + strspn(line, "0123456789 "); /* behind the number of the step */
    bool heading = starts(title, "Cord ") && strstr(title, " of ") && strstr(title, ": pass");
    bool begins = starts(line, "pass ") && isdigit((unsigned char)line[5]), check = starts(line, "Check: the ");
    bool places = starts(line, "Cord ") && strstr(line, ", pass") && strstr(line, " to ");
    if (step[0] && (heading || begins || check)) {
      read_single(r, cord, step, left);
      step[0] = '\0';
    }
    if (heading) {
      cord = cord_named(r, title + strlen("Cord "), strcspn(title + strlen("Cord "), " ,:"));
      left = strstr(line, "left needle") != NULL;
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

static int by_length(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median_length(const thr_frame *f)
{
  double *length = malloc((size_t)f->n_edges * sizeof *length);
  ck_assert_ptr_nonnull(length);
  for (int e = 0; e < f->n_edges; e++)
    length[e] = f->length[e];
  qsort(length, (size_t)f->n_edges, sizeof *length, by_length);
  double median = length[f->n_edges / 2];
  free(length);
  return median;
}

/* Beads of one number differ by at most two hundredths of the median; they have one name if and only if they hold as many cords.
 */
static void assert_kinds(const reader *r)
{
  const thr_frame *f = &r->p->frame;
  double most = 0.021 * median_length(f);
  for (int a = 0; a < f->n_edges; a++)
    for (int b = 0; b < a; b++) {
      const char *p = r->kind[a], *q = r->kind[b];
      if (!*p || !*q || atoi(p) != atoi(q)) continue;
      ck_assert_double_eq_tol(f->length[a], f->length[b], most);
      ck_assert_msg((strcmp(p, q) == 0) == (r->held[a] == r->held[b]), "%s for %d cords, %s for %d", p, r->held[a], q,
                    r->held[b]);
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
    ck_assert(next_number(&s, "yMin=\"", &y0) && next_number(&s, "xMax=\"", &x1) && next_number(&s, "yMax=\"", &y1));
    ck_assert_msg(x0 > 15 && x1 < w - 15 && y0 > 15 && y1 < h - 15, "a word at %g %g .. %g %g pt", x0, y0, x1, y1);
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
  ck_assert(!strstr(svg->data, "scale(") && !strstr(svg->data, "matrix(") && !strstr(svg->data, "nan"));
}

/* ---- pictures ---- */

/* The picture that begins at view, and ends at end: the passes that its heading names have one number each in it, and no two
 * numbers overlap. */
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
  for (const char *s = strstr(view, "class=\"pill\""); s && s < end; s = strstr(s, "class=\"pill\"")) {
    ck_assert(n < MOST && next_number(&s, "x=\"", &x[n]) && next_number(&s, "y=\"", &y[n]) && next_number(&s, "width=\"", &w[n]));
    s = strstr(s, "<text");
    s = strchr(s, '>') + 1;
    s += strcspn(s, "0123456789");
    int number = atoi(s);
    ck_assert_msg(number >= low && number <= high, "%d in a picture of passes %d-%d", number, low, high);
    ck_assert_int_eq(seen[number - low]++, 0);
    for (int i = 0; i < n; i++)
      ck_assert_msg(x[i] + w[i] < x[n] + 0.01 || x[n] + w[n] < x[i] + 0.01 || y[i] + 3.49 < y[n] || y[n] + 3.49 < y[i],
                    "numbers on each other among %d-%d: %g %g, %g %g", low, high, x[i], y[i], x[n], y[n]);
    n++;
  }
  ck_assert_int_eq(n, high - low + 1);
}

/* Pictures of steps on a page. Each is wholly above the next step, and above the foot of the page. */
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
  thr_text pdf = pdf_of(s), again = pdf_of(s);
  int n = thr_sheets_pages(s), steps = 0;
  thr_page_mm(page, size);
  assert_pages(&pdf, n, size[0], size[1]);
  assert_reads_back(&p, &pdf);
  ck_assert(pdf.length == again.length && memcmp(pdf.data, again.data, pdf.length) == 0);
  for (int i = 0; i < n; i++) {
    thr_text svg = {0};
    ck_assert_int_eq(thr_sheets_svg(s, i, &svg, NULL), THR_OK);
    assert_letters(&svg);
    steps += count_pictures(&svg, size[1]);
    thr_text_destroy(&svg);
  }
  ck_assert_int_ge(steps, 1);
  thr_text_destroy(&pdf);
  thr_text_destroy(&again);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}

START_TEST(plans_are_read_back_from_the_pdf)
{
  judge(plan_number(_i), false, _i % 2 ? THR_PAGE_LETTER : THR_PAGE_A4);
}
END_TEST

START_TEST(plans_threaded_from_the_middle_too)
{
  judge(plan_number(_i), true, _i % 2 ? THR_PAGE_A4 : THR_PAGE_LETTER);
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
  default: judge(plan_of(random_frame(&r, 14, 20, LENGTHS_RANDOM), THR_ENDS_ANY, 1), _i % 2, THR_PAGE_A4);
  }
}
END_TEST

/* The 1,800 edges of a dome: what hands thread for days. */
START_TEST(a_large_plan_is_read_back)
{
  thr_plan p = plan_of(frame_load("data/jax_fdm/liew_dome.json", NULL), THR_ENDS_FEET, 1);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  thr_text pdf = pdf_of(s);
  assert_reads_back(&p, &pdf);
  assert_pages(&pdf, thr_sheets_pages(s), 210, 297);
  thr_text_destroy(&pdf);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(a_pdf_tells_no_time_and_no_place)
{
  thr_plan p = plan_of(ring_make(5), THR_ENDS_CLOSED, 1);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  thr_text pdf = pdf_of(s);
  thr_text info = {0};
  thr_text_append_bytes(&info, pdf.data, pdf.length);
  for (size_t i = 0; i < info.length; i++)
    if (!info.data[i]) info.data[i] = ' ';
  const char *date = strstr(info.data, "/CreationDate");
  ck_assert(!date || strstr(date, "20000101"));
  ck_assert(strstr(info.data, "%PDF-") == info.data && !strstr(info.data, "/tmp"));
  thr_text_destroy(&info);
  thr_text_destroy(&pdf);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(an_interrupt_stops_it)
{
  volatile sig_atomic_t stop = 1;
  thr_limits limits = {.interrupted = &stop};
  thr_err err = {0};
  thr_text pdf = {0};
  thr_plan p = plan_of(ring_make(5), THR_ENDS_CLOSED, 1);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  ck_assert_int_eq(thr_sheets_pdf(s, &limits, &pdf, &err), THR_ELIMIT);
  assert_one_line(&err, "page 1");
  ck_assert_uint_eq(pdf.length, 0);
  thr_sheets_destroy(s);
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
  ck_assert_int_eq(thr_sheets_make(&s, &p, &o, &limits, &err), THR_ELIMIT);
  assert_one_line(&err, "interrupted at page 2 of the step sheets");
  ck_assert_ptr_null(s);
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

/* Which half a window shows, in each of them. */
START_TEST(windows_on_a_shell_say_its_side)
{
  int windows = 0;
  thr_plan p = plan_number(2);
  thr_sheets *s = sheets_of(&p, THR_PAGE_A4, false);
  for (int i = 0; i < thr_sheets_pages(s); i++) {
    thr_text svg = {0};
    ck_assert_int_eq(thr_sheets_svg(s, i, &svg, NULL), THR_OK);
    for (const char *view = strstr(svg.data, "<g class=\"view-"), *next; view; view = next) {
      next = strstr(view + 1, "<g class=\"view-");
      int n = count_before(view, next, "<clipPath ");
      ck_assert_int_eq(count_before(view, next, ">from above<") + count_before(view, next, ">from below<"), n);
      windows += n;
      if (n == 2) ck_assert_int_eq(count_before(view, next, ">from above<"), 1);
    }
    thr_text_destroy(&svg);
  }
  ck_assert_int_gt(windows, 6);
  thr_sheets_destroy(s);
  thr_plan_destroy(&p);
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

START_TEST(every_failing_allocation_is_reported)
{
  thr_plan p = _i ? symmetric_plan(solid_make(TETRAHEDRON), THR_ENDS_ANY, 1, "") : plan_of(path_make(2), THR_ENDS_ANY, 1);
  thr_sheets_options o = thr_sheets_options_default();
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k += k < 400 ? 1 : 17) {
    thr_sheets *s = NULL;
    thr_err err = {0};
    thr_text pdf = {0};
    thr_alloc_fail_at(k);
    st = thr_sheets_make(&s, &p, &o, &none, &err);
    ck_assert(st == THR_OK || !s);
    if (!st) st = thr_sheets_pdf(s, &none, &pdf, &err);
    thr_alloc_fail_at(0);
    if (st) ck_assert_int_eq(st, THR_ENOMEM);
    ck_assert(!st || !pdf.length);
    thr_text_destroy(&pdf);
    thr_sheets_destroy(s);
  }
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("sheets");
  ADD_EXAMPLES(s, 60, plans_are_read_back_from_the_pdf, N_PLANS);
  ADD_EXAMPLES(s, 60, plans_threaded_from_the_middle_too, N_PLANS);
  ADD_EXAMPLES(s, 60, odd_plans_are_read_back, 10);
  ADD_LARGE(s, 120, a_large_plan_is_read_back, 0, 1);
  ADD_TEST(s, 20, a_pdf_tells_no_time_and_no_place);
  ADD_TEST(s, 20, an_interrupt_stops_it);
  ADD_TEST(s, 20, an_interrupt_stops_the_layout);
  ADD_TEST(s, 20, windows_on_a_shell_say_its_side);
  ADD_TEST(s, 20, plans_that_cannot_be_drawn_are_refused);
  ADD_EXAMPLES(s, 60, every_failing_allocation_is_reported, 2);
  return run_suite(s);
}
