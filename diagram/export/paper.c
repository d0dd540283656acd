/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is drawn on one page, in mm from its upper left corner: vectors stay vectors, text stays
 * text. Several pages may be drawn at a time, each in one thread; diagram/export/pdf.c makes a file
 * of them. Private to diagram/. */
#include "diagram/export/paper.h"

#include "diagram/scene/scene.h"
#include "graph/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double POINT = 25.4 / 72; /* mm */
static const double MITRE =
    4; /* as in SVG: how far a corner reaches, in halves of the line's width */

enum { DEPTH = 32, DASHES = 4 };

static const thr_box nowhere = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

/* What the last operators have set; < 0: nothing yet. */
typedef struct {
  double fill[3], stroke[3], width, dash[DASHES], dash_offset;
  int fill_opacity, stroke_opacity, n_dash, cap, join;
  double at[2];  /* where 0, 0 is, mm on the page */
  bool turned;   /* about it: then what is clipped away is not known */
  thr_box shown; /* what is not clipped away, mm on the page */
} state;

struct thr_paper {
  thr_text out, path; /* path: that which grows; states may not change inside one, so that they are
                         written before it */
  const thr_font *font; /* [THR_FACES], borrowed */
  state open[DEPTH];
  int depth;           /* of the state that holds */
  thr_box box;         /* around the path that grows */
  double pen[2], trim; /* where it is; so much around its parts, the rest of which is clipped away,
                          is drawn; < 0: all is */
  bool lifted;         /* the pen: what came before is left out */
  thr_paper_needs needs;
};

/* ---- operators ---- */

enum { NUMBER = 16, NUMBERS = 6 }; /* bytes of a number at most; numbers of an operator */

/* A number with up to three decimals and a blank: 12.5, -0.013. What is beyond any page is cut off
 * there. Returns its length. */
static size_t print_number(double value, char *to)
{
  const double most = 100000000;
  char s[NUMBER];
  size_t n = sizeof s;
  double scaled = 1000 * value < -most ? -most : 1000 * value > most ? most : 1000 * value;
  int x = (int)lround(scaled), rest = abs(x) % 1000, whole = abs(x) / 1000;
  s[--n] = ' ';
  if (rest) {
    for (int i = 0; i < 3; i++, rest /= 10)
      if (rest % 10 || s[n] != ' ') s[--n] = (char)('0' + rest % 10);
    s[--n] = '.';
  }
  do
    s[--n] = (char)('0' + whole % 10);
  while (whole /= 10);
  if (x < 0) s[--n] = '-';
  memcpy(to, s + n, sizeof s - n);
  return sizeof s - n;
}

static void put_number(thr_text *out, double value)
{
  char s[NUMBER];
  thr_text_append_bytes(out, s, print_number(value, s));
}

/* n <= NUMBERS; the operator is a short word. */
static void put(thr_text *out, int n, const double *x, const char *operator)
{
  char s[NUMBERS * NUMBER + 8];
  size_t length = 0;
  for (int i = 0; i < n; i++)
    length += print_number(x[i], s + length);
  for (; *operator&& length + 1<sizeof s; operator++)
    s[length++] = *operator;
  s[length++] = '\n';
  thr_text_append_bytes(out, s, length);
}

thr_status thr_paper_open(thr_paper **out, const double size[2], const thr_font *font, thr_err *err)
{
  thr_paper *paper = *out = thr_calloc(1, sizeof *paper);
  if (!paper) return thr_nomem(err);
  const double upright[6] = {1 / POINT, 0, 0, -1 / POINT, 0, size[1] / POINT};
  paper->font = font;
  paper->box = nowhere;
  paper->trim = -1;
  paper->open[0] = (state){.shown = {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL},
                           .fill = {-1},
                           .stroke = {-1},
                           .width = -1,
                           .fill_opacity = -1,
                           .stroke_opacity = -1,
                           .cap = -1,
                           .join = -1};
  thr_text_printf(&paper->out, "q\n%.6f 0 0 %.6f 0 %.6f cm\n", upright[0], upright[3], upright[5]);
  put(&paper->out, 1, &MITRE, "M");
  return THR_OK;
}

void thr_paper_destroy(thr_paper *paper)
{
  if (!paper) return;
  thr_text_destroy(&paper->out);
  thr_text_destroy(&paper->path);
  for (int i = 0; i < THR_FACES; i++)
    free(paper->needs.letter[i]);
  free(paper);
}

thr_status thr_paper_content(thr_paper *paper, thr_text const **content, thr_err *err)
{
  for (; paper->depth >= 0; paper->depth--)
    put(&paper->out, 0, NULL, "Q");
  *content = &paper->out;
  return paper->out.failed ? thr_nomem(err) : THR_OK;
}

const thr_paper_needs *thr_paper_needs_of(const thr_paper *paper)
{
  return &paper->needs;
}

/* ---- drawing ---- */

void thr_paper_push(thr_paper *paper)
{
  if (paper->depth + 1 == DEPTH) {
    paper->out.failed = true;
    return;
  }
  put(&paper->out, 0, NULL, "q");
  paper->open[paper->depth + 1] = paper->open[paper->depth];
  paper->depth++;
}

void thr_paper_pop(thr_paper *paper)
{
  if (paper->depth == 0) return;
  put(&paper->out, 0, NULL, "Q");
  paper->depth--;
}

void thr_paper_shift(thr_paper *paper, const double by[2])
{
  const double matrix[6] = {1, 0, 0, 1, by[0], by[1]};
  put(&paper->out, 6, matrix, "cm");
  for (int k = 0; k < 2; k++)
    paper->open[paper->depth].at[k] += by[k];
}

void thr_paper_turn(thr_paper *paper, double degrees)
{
  const double c = cos(degrees * THR_PI / 180), s = sin(degrees * THR_PI / 180),
               matrix[6] = {c, s, -s, c, 0, 0};
  put(&paper->out, 6, matrix, "cm");
  paper->open[paper->depth].turned = true;
}

/* Is a box, with so much around it, all clipped away? */
static bool is_hidden(const thr_paper *paper, thr_box box, double around)
{
  const state *now = &paper->open[paper->depth];
  const thr_box *shown = &now->shown;
  return !now->turned &&
         (box.x1 + around + now->at[0] < shown->x0 || box.x0 - around + now->at[0] > shown->x1 ||
          box.y1 + around + now->at[1] < shown->y0 || box.y0 - around + now->at[1] > shown->y1);
}

/* Puts an operator of the path with its points. */
static void put_path(thr_paper *paper, int points, const double *x, const char *operator)
{
  for (int i = 0; i < points; i++)
    thr_box_extend(&paper->box, (thr_box){x[2 * i], x[2 * i + 1], x[2 * i], x[2 * i + 1]});
  put(&paper->path, 2 * points, x, operator);
}

/* Puts a part of the path from the pen to the last of its points, if any of it may be seen. */
static void put_part(thr_paper *paper, int points, const double *x, const char *operator)
{
  if (paper->trim >= 0) {
    thr_box box = {paper->pen[0], paper->pen[1], paper->pen[0], paper->pen[1]};
    for (int i = 0; i < points; i++)
      thr_box_extend(&box, (thr_box){x[2 * i], x[2 * i + 1], x[2 * i], x[2 * i + 1]});
    const bool hidden = is_hidden(paper, box, paper->trim);
    if (!hidden && paper->lifted) put_path(paper, 1, paper->pen, "m");
    paper->lifted = hidden;
    memcpy(paper->pen, x + 2 * (points - 1), sizeof paper->pen);
    if (hidden) return;
  }
  put_path(paper, points, x, operator);
}

void thr_paper_trim(thr_paper *paper, const thr_line *line)
{
  paper->trim = line ? MITRE / 2 * line->width : -1;
}

void thr_paper_move(thr_paper *paper, const double to[2])
{
  memcpy(paper->pen, to, sizeof paper->pen);
  paper->lifted = true;
  if (paper->trim < 0) put_path(paper, 1, to, "m");
}

void thr_paper_line(thr_paper *paper, const double to[2])
{
  put_part(paper, 1, to, "l");
}

void thr_paper_curve(thr_paper *paper, const double a[2], const double b[2], const double to[2])
{
  const double x[6] = {a[0], a[1], b[0], b[1], to[0], to[1]};
  put_part(paper, 3, x, "c");
}

void thr_paper_end(thr_paper *paper)
{
  put(&paper->path, 0, NULL, "h");
}

/* A quarter of a circle from where the pen is, which is at a multiple i of a right angle: the cubic
 * that leaves it by 0.03 % of the radius at most has its inner points 4 (sqrt 2 - 1) / 3 radii from
 * its ends. */
static void put_quarter(thr_paper *paper, const double middle[2], double radius, int i)
{
  static const double cosine[] = {1, 0, -1, 0, 1}, sine[] = {0, 1, 0, -1, 0};
  const double k = 4 * (sqrt(2) - 1) / 3;
  double x[6];
  for (int c = 0; c < 2; c++) {
    const double *axis = c ? sine : cosine, *along = c ? cosine : sine;
    double sign = c ? 1 : -1;
    x[c] = middle[c] + radius * (axis[i] + sign * k * along[i]);
    x[2 + c] = middle[c] + radius * (axis[i + 1] - sign * k * along[i + 1]);
    x[4 + c] = middle[c] + radius * axis[i + 1];
  }
  put_path(paper, 3, x, "c");
}

void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2], double radius)
{
  const double box[4] = {at[0], at[1], size[0], size[1]};
  if (radius <= 0) {
    thr_box_extend(&paper->box, (thr_box){at[0], at[1], at[0] + size[0], at[1] + size[1]});
    put(&paper->path, 4, box, "re");
    return;
  }
  for (int i = 0; i < 4;
       i++) { /* corners right and low, left and low, left and high, right and high */
    double middle[2] = {i == 0 || i == 3 ? at[0] + size[0] - radius : at[0] + radius,
                        i < 2 ? at[1] + size[1] - radius : at[1] + radius};
    double from[2] = {middle[0] + radius * cos(i * THR_PI / 2),
                      middle[1] + radius * sin(i * THR_PI / 2)};
    put_path(paper, 1, from, i ? "l" : "m");
    put_quarter(paper, middle, radius, i);
  }
  thr_paper_end(paper);
}

void thr_paper_circle(thr_paper *paper, const double middle[2], double radius)
{
  const double from[2] = {middle[0] + radius, middle[1]};
  put_path(paper, 1, from, "m");
  for (int i = 0; i < 4; i++)
    put_quarter(paper, middle, radius, i);
  thr_paper_end(paper);
}

/* ---- ink ---- */

static void take_ink(thr_paper *paper, const thr_ink *ink, bool stroke)
{
  state *now = &paper->open[paper->depth];
  double *colour = stroke ? now->stroke : now->fill;
  int *opacity = stroke ? &now->stroke_opacity : &now->fill_opacity;
  int part = (int)lround(100 * fmin(fmax(ink->opacity, 0), 1));
  if (part != *opacity) {
    thr_text_printf(&paper->out, "/%c%d gs\n", stroke ? 's' : 'f', part);
    (stroke ? paper->needs.stroke : paper->needs.fill)[part] = 1;
    *opacity = part;
  }
  if (memcmp(colour, ink->colour, sizeof ink->colour) == 0) return;
  put(&paper->out, 3, ink->colour, stroke ? "RG" : "rg");
  memcpy(colour, ink->colour, sizeof ink->colour);
}

static void take_line(thr_paper *paper, const thr_line *line)
{
  state *now = &paper->open[paper->depth];
  int cap = line->round_ends, join = line->round_corners;
  take_ink(paper, &line->ink, true);
  if (line->width != now->width) put(&paper->out, 1, &line->width, "w");
  if (cap != now->cap) put(&paper->out, 0, NULL, cap ? "1 J" : "0 J");
  if (join != now->join) put(&paper->out, 0, NULL, join ? "1 j" : "0 j");
  if (line->n_dash != now->n_dash || line->dash_offset != now->dash_offset ||
      memcmp(line->dash, now->dash, (size_t)line->n_dash * sizeof *line->dash) != 0) {
    thr_text_byte(&paper->out, '[');
    for (int i = 0; i < line->n_dash; i++)
      put_number(&paper->out, line->dash[i]);
    thr_text_append(&paper->out, "] ");
    put(&paper->out, 1, &line->dash_offset, "d");
  }
  now->width = line->width;
  now->cap = cap;
  now->join = join;
  now->n_dash = line->n_dash;
  now->dash_offset = line->dash_offset;
  memcpy(now->dash, line->dash, sizeof now->dash);
}

static void forget_path(thr_paper *paper)
{
  paper->path.length = 0;
  paper->box = nowhere;
}

/* The path, how it is painted, and no path. */
static void end_path(thr_paper *paper, const char *operator)
{
  if (paper->path.failed) paper->out.failed = true;
  if (paper->path.length) thr_text_append_bytes(&paper->out, paper->path.data, paper->path.length);
  put(&paper->out, 0, NULL, operator);
  forget_path(paper);
}

void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line)
{
  if (is_hidden(paper, paper->box,
                line ? MITRE / 2 * line->width : 0)) { /* corners reach so far beyond the line */
    forget_path(paper);
    return;
  }
  if (fill) take_ink(paper, fill, false);
  if (line) take_line(paper, line);
  if (paper->path.length && (fill || line)) end_path(paper, fill ? line ? "B" : "f" : "S");
  forget_path(paper);
}

void thr_paper_clip(thr_paper *paper)
{
  state *now = &paper->open[paper->depth];
  if (paper->path.length && !now->turned) {
    now->shown.x0 = fmax(now->shown.x0, paper->box.x0 + now->at[0]);
    now->shown.y0 = fmax(now->shown.y0, paper->box.y0 + now->at[1]);
    now->shown.x1 = fmin(now->shown.x1, paper->box.x1 + now->at[0]);
    now->shown.y1 = fmin(now->shown.y1, paper->box.y1 + now->at[1]);
  }
  if (paper->path.length) end_path(paper, "W n");
}

/* ---- text ---- */

/* In em. */
static double width_of(const thr_font *font, const char *words)
{
  double width = 0;
  while (*words)
    width += thr_font_advance(font, font->glyph[thr_font_letter(&words)]);
  return width;
}

/* Letters as four hexadecimal digits each. */
static void put_letters(thr_paper *paper, int face, const char *words, thr_text *out)
{
  static const char digit[] = "0123456789ABCDEF";
  unsigned char *needs = paper->needs.letter[face];
  while (*words) {
    unsigned letter = thr_font_letter(&words);
    for (int shift = 12; shift >= 0; shift -= 4)
      thr_text_byte(out, digit[letter >> shift & 15]);
    needs[letter / 8] |= (unsigned char)(1u << letter % 8);
  }
}

/* What is beyond the basic plane is found as itself, too: the span says what its boxes stand for.
 */
static bool open_span(thr_paper *paper, const char *words)
{
  bool beyond = false;
  for (const char *c = words; *c; c++)
    beyond = beyond || (unsigned char)*c >= 0xf0;
  if (!beyond) return false;
  thr_text_append(&paper->out, "/Span <</ActualText <FEFF");
  for (const char *c = words; *c;) {
    const unsigned char *s = (const unsigned char *)c;
    unsigned letter = thr_font_letter(&c);
    if (*s >= 0xf0 && c - (const char *)s == 4) {
      unsigned high =
          ((*s & 7u) << 18 | (s[1] & 0x3fu) << 12 | (s[2] & 0x3fu) << 6 | (s[3] & 0x3fu)) - 0x10000;
      thr_text_printf(&paper->out, "%04X", 0xd800 | (high >> 10 & 0x3ff));
      letter = 0xdc00 | (high & 0x3ff);
    }
    thr_text_printf(&paper->out, "%04X", letter);
  }
  thr_text_append(&paper->out, ">>> BDC\n");
  return true;
}

void thr_paper_text(thr_paper *paper, const double at[2], const thr_letters *letters,
                    const char *words)
{
  int face = (letters->bold ? THR_FACE_BOLD : 0) + (letters->mono ? THR_FACE_MONO : 0);
  const double size = letters->size, width = size * width_of(&paper->font[face], words),
               left = at[0] - letters->anchor * width;
  if (is_hidden(paper, (thr_box){left, at[1], left + width, at[1]}, 2 * size))
    return; /* no letter reaches further */
  if (!paper->needs.letter[face]) paper->needs.letter[face] = thr_calloc(THR_FONT_LETTERS / 8, 1);
  if (!paper->needs.letter[face]) {
    paper->out.failed = true;
    return;
  }
  thr_text set = {0};
  put_letters(paper, face, words, &set);
  const double matrix[6] = {1, 0, 0, -1, left, at[1]};
  take_ink(paper, &letters->ink, false);
  bool span = open_span(paper, words);
  thr_text_printf(&paper->out, "BT /F%d ", face);
  put(&paper->out, 1, &letters->size, "Tf");
  put(&paper->out, 6, matrix, "Tm");
  if (set.failed) paper->out.failed = true;
  if (set.length) thr_text_printf(&paper->out, "<%s> Tj ", set.data);
  thr_text_append(&paper->out, span ? "ET EMC\n" : "ET\n");
  thr_text_destroy(&set);
}
