/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes what is drawn on one page as the operators of a PDF's content stream (ISO 32000-1, 8 and
 * 9).
 *
 * Coordinates are mm from the upper left corner, y downwards; the first operator turns them into
 * points (1/72 inch) from the lower left. Vectors stay vectors, text stays text. Two things keep
 * pages small: an operator is written only if it changes the graphics state, and what lies outside
 * of the clipping box is left out.
 *
 * Several pages may be drawn at a time, each in one thread; pdf.c makes a file of them.
 *
 * Example: a line of 0.5 mm from (10, 10) to (20, 10) is "0.5 w", "10 10 m", "20 10 l", "S". */
#include "diagram/export/paper.h"

#include "diagram/scene/scene.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double POINT = 25.4 / 72; /* mm */
/* Mitre limit, as in SVG: how far a corner reaches, in halves of the line's width. */
static const double MITRE = 4;

enum { DEPTH = 32, DASHES = 4 }; /* states that are saved; numbers of a dash pattern */

static const thr_box nowhere = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

/* The graphics state that the operators so far have set; < 0: nothing yet. */
typedef struct {
  double fill[3], stroke[3], width, dash[DASHES], dash_offset;
  int fill_opacity, stroke_opacity, n_dash, cap, join;
  double at[2];  /* where 0, 0 is, mm on the page */
  bool turned;   /* about it: then what is clipped away is not known */
  thr_box shown; /* what is not clipped away, mm on the page */
} graphics_state;

struct thr_paper {
  thr_text out;  /* the content stream so far */
  thr_text path; /* the path that grows; a state may not change inside a path, so that changes are
                    written to out before it */
  const thr_font *font;       /* [THR_FACES], borrowed */
  graphics_state open[DEPTH]; /* saved states, and the current one */
  int depth;                  /* index of the current state */
  thr_box box;                /* around the path that grows, in current coordinates */
  double pen[2];              /* where the path has come to */
  double trim; /* mm around a part of the path within which the line is seen; < 0: no part is left
                  out */
  bool lifted; /* is what led to the pen left out, so that a move comes first? */
  thr_paper_needs needs;
};

/* ---- operators ---- */

enum { NUMBER = 16, NUMBERS = 6 }; /* bytes of a number at most; numbers of an operator */

/* Prints a number with up to three decimals and a blank: "12.5 ", "-0.013 ". What is beyond any
 * page is cut off there. Returns the length. */
static size_t print_number(double value, char *to)
{
  const double most = 100000000;
  char text[NUMBER];
  size_t n = sizeof text;

  /* Thousandths as a whole number, in bounds. */
  double scaled = 1000 * value < -most ? -most : 1000 * value > most ? most : 1000 * value;
  int thousandths = (int)lround(scaled), rest = abs(thousandths) % 1000,
      whole = abs(thousandths) / 1000;

  text[--n] = ' ';

  /* From the last digit to the first; zeros at the end of the decimals are left out. */
  if (rest) {
    for (int i = 0; i < 3; i++, rest /= 10)
      if (rest % 10 || text[n] != ' ') text[--n] = (char)('0' + rest % 10);
    text[--n] = '.';
  }

  do
    text[--n] = (char)('0' + whole % 10);
  while (whole /= 10);

  if (thousandths < 0) text[--n] = '-';
  memcpy(to, text + n, sizeof text - n);
  return sizeof text - n;
}

/* Appends a number and a blank. */
static void put_number(thr_text *out, double value)
{
  char text[NUMBER];
  thr_text_append_bytes(out, text, print_number(value, text));
}

/* Appends an operator, a short word, behind n <= NUMBERS numbers, and ends the line. */
static void put(thr_text *out, int n, const double *number, const char *word)
{
  char text[NUMBERS * NUMBER + 8];

  /* Collected first: one call for a line costs less than one for each number. */
  size_t length = 0;
  for (int i = 0; i < n; i++)
    length += print_number(number[i], text + length);
  for (; *word && length + 1 < sizeof text; word++)
    text[length++] = *word;
  text[length++] = '\n';
  thr_text_append_bytes(out, text, length);
}

thr_status thr_paper_open(thr_paper **out, const double size[2], const thr_font *font, thr_err *err)
{
  thr_paper *paper = *out = thr_calloc(1, sizeof *paper);
  if (!paper) return thr_nomem(err);

  const double upright[6] = {1 / POINT, 0, 0, -1 / POINT, 0, size[1] / POINT};
  paper->font = font;
  paper->box = nowhere;
  paper->trim = -1;

  /* No operator has been written: every property differs from what is wanted first. */
  paper->open[0] = (graphics_state){.shown = {-HUGE_VAL, -HUGE_VAL, HUGE_VAL, HUGE_VAL},
                                    .fill = {-1},
                                    .stroke = {-1},
                                    .width = -1,
                                    .fill_opacity = -1,
                                    .stroke_opacity = -1,
                                    .cap = -1,
                                    .join = -1};

  /* Millimetres downwards become points upwards. */
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
  /* Restore every state that is still saved, the first one too. */
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

  /* PDF and paper save the same state. */
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
  const double cosine = cos(degrees * THR_PI / 180), sine = sin(degrees * THR_PI / 180),
               matrix[6] = {cosine, sine, -sine, cosine, 0, 0};

  /* Boxes would have to be turned, too: from here on nothing is known to be hidden. */
  put(&paper->out, 6, matrix, "cm");
  paper->open[paper->depth].turned = true;
}

/* Returns whether a box in current coordinates, with a margin of `around` mm, is clipped away
 * completely. */
static bool is_hidden(const thr_paper *paper, thr_box box, double around)
{
  const graphics_state *now = &paper->open[paper->depth];
  const thr_box *shown = &now->shown;
  return !now->turned &&
         (box.x1 + around + now->at[0] < shown->x0 || box.x0 - around + now->at[0] > shown->x1 ||
          box.y1 + around + now->at[1] < shown->y0 || box.y0 - around + now->at[1] > shown->y1);
}

/* Appends an operator of the path with its points, and extends the box around the path. */
static void put_path(thr_paper *paper, int points, const double *point, const char *word)
{
  for (int i = 0; i < points; i++)
    thr_box_point(&paper->box, point + 2 * i);
  put(&paper->path, 2 * points, point, word);
}

/* Appends a part of the path, from the pen to the last of its points, unless all of it is clipped
 * away. The box of a cubic's points holds the curve, which lies in their convex hull. */
static void put_part(thr_paper *paper, int points, const double *point, const char *word)
{
  if (paper->trim >= 0) {
    /* The box around the pen and all points of the part. */
    thr_box box = {paper->pen[0], paper->pen[1], paper->pen[0], paper->pen[1]};
    for (int i = 0; i < points; i++)
      thr_box_point(&box, point + 2 * i);

    /* Behind parts that were left out the pen must be moved to where this one begins. */
    const bool hidden = is_hidden(paper, box, paper->trim);
    if (!hidden && paper->lifted) put_path(paper, 1, paper->pen, "m");
    paper->lifted = hidden;

    memcpy(paper->pen, point + 2 * (points - 1), sizeof paper->pen);
    if (hidden) return;
  }
  put_path(paper, points, point, word);
}

void thr_paper_trim(thr_paper *paper, const thr_line *line)
{
  paper->trim = line ? MITRE / 2 * line->width : -1;
}

void thr_paper_move(thr_paper *paper, const double to[2])
{
  memcpy(paper->pen, to, sizeof paper->pen);
  paper->lifted = true;

  /* With trimming the move is written when a part that is seen follows. */
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

/* Appends a quarter of a circle from angle i * pi / 2 on, where the pen is, as a cubic whose inner
 * points lie 4 (sqrt 2 - 1) / 3 radii along the tangents from its ends; it leaves the circle by at
 * most 0.03 % of the radius. */
static void put_quarter(thr_paper *paper, const double middle[2], double radius, int i)
{
  static const double cosine[] = {1, 0, -1, 0, 1}, sine[] = {0, 1, 0, -1, 0};
  const double inner = 4 * (sqrt(2) - 1) / 3;
  double point[6];

  for (int k = 0; k < 2; k++) {
    /* The tangent at angle i is (-sine, cosine). */
    const double *axis = k ? sine : cosine, *along = k ? cosine : sine;
    double sign = k ? 1 : -1;
    point[k] = middle[k] + radius * (axis[i] + sign * inner * along[i]);
    point[2 + k] = middle[k] + radius * (axis[i + 1] - sign * inner * along[i + 1]);
    point[4 + k] = middle[k] + radius * axis[i + 1];
  }

  put_path(paper, 3, point, "c");
}

void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2], double radius)
{
  const double box[4] = {at[0], at[1], size[0], size[1]};

  /* Square corners have an operator of their own. */
  if (radius <= 0) {
    thr_box_extend(&paper->box, (thr_box){at[0], at[1], at[0] + size[0], at[1] + size[1]});
    put(&paper->path, 4, box, "re");
    return;
  }
  /* Corners right and low, left and low, left and high, right and high. */
  for (int i = 0; i < 4; i++) {
    /* A quarter around the middle of each corner; lines lead from one to the next. */
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

/* Writes colour and opacity of an ink, for lines or areas, where they differ from the current
 * ones. */
static void take_ink(thr_paper *paper, const thr_ink *ink, bool stroke)
{
  graphics_state *now = &paper->open[paper->depth];
  double *colour = stroke ? now->stroke : now->fill;
  int *opacity = stroke ? &now->stroke_opacity : &now->fill_opacity;

  /* Hundredths are fine enough, and a file has at most 202 such states. */
  int part = (int)lround(100 * fmin(fmax(ink->opacity, 0), 1));

  /* Opacities are graphics states /s0 .. /s100 and /f0 .. /f100 of the file, which must know which
   * are used. */
  if (part != *opacity) {
    thr_text_printf(&paper->out, "/%c%d gs\n", stroke ? 's' : 'f', part);
    (stroke ? paper->needs.stroke : paper->needs.fill)[part] = 1;
    *opacity = part;
  }

  /* The colour, unless it is the current one. */
  if (memcmp(colour, ink->colour, sizeof ink->colour) == 0) return;

  put(&paper->out, 3, ink->colour, stroke ? "RG" : "rg");
  memcpy(colour, ink->colour, sizeof ink->colour);
}

/* Writes what a line needs where it differs from the current state: ink, width, ends, corners,
 * dashes. */
static void take_line(thr_paper *paper, const thr_line *line)
{
  graphics_state *now = &paper->open[paper->depth];
  int cap = line->round_ends, join = line->round_corners;

  take_ink(paper, &line->ink, true);

  /* Each property is written only if it changes. */
  if (line->width != now->width) put(&paper->out, 1, &line->width, "w");
  if (cap != now->cap) put(&paper->out, 0, NULL, cap ? "1 J" : "0 J");
  if (join != now->join) put(&paper->out, 0, NULL, join ? "1 j" : "0 j");

  /* A dash pattern is one array with its offset. */
  if (line->n_dash != now->n_dash || line->dash_offset != now->dash_offset ||
      memcmp(line->dash, now->dash, (size_t)line->n_dash * sizeof *line->dash) != 0) {
    thr_text_byte(&paper->out, '[');
    for (int i = 0; i < line->n_dash; i++)
      put_number(&paper->out, line->dash[i]);
    thr_text_append(&paper->out, "] ");
    put(&paper->out, 1, &line->dash_offset, "d");
  }

  /* The state is what the line asks for now. */
  now->width = line->width;
  now->cap = cap;
  now->join = join;
  now->n_dash = line->n_dash;
  now->dash_offset = line->dash_offset;
  memcpy(now->dash, line->dash, sizeof now->dash);
}

/* Drops the path that grows. */
static void forget_path(thr_paper *paper)
{
  paper->path.length = 0;
  paper->box = nowhere;
}

/* Appends the path that grows, the operator that paints it or clips to it, and begins an empty
 * one. */
static void end_path(thr_paper *paper, const char *word)
{
  if (paper->path.failed) paper->out.failed = true;
  if (paper->path.length) thr_text_append_bytes(&paper->out, paper->path.data, paper->path.length);

  put(&paper->out, 0, NULL, word);
  forget_path(paper);
}

void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line)
{
  /* Mitred corners reach so far beyond the path. */
  if (is_hidden(paper, paper->box, line ? MITRE / 2 * line->width : 0)) {
    forget_path(paper);
    return;
  }

  /* States first, then the path: "f" fills, "S" draws along, "B" does both. */
  if (fill) take_ink(paper, fill, false);
  if (line) take_line(paper, line);
  if (paper->path.length && (fill || line)) end_path(paper, fill ? line ? "B" : "f" : "S");
  forget_path(paper);
}

void thr_paper_clip(thr_paper *paper)
{
  graphics_state *now = &paper->open[paper->depth];

  /* The box around the path bounds what is seen from now on. */
  if (paper->path.length && !now->turned) {
    now->shown.x0 = fmax(now->shown.x0, paper->box.x0 + now->at[0]);
    now->shown.y0 = fmax(now->shown.y0, paper->box.y0 + now->at[1]);
    now->shown.x1 = fmin(now->shown.x1, paper->box.x1 + now->at[0]);
    now->shown.y1 = fmin(now->shown.y1, paper->box.y1 + now->at[1]);
  }

  if (paper->path.length) end_path(paper, "W n");
}

/* ---- text ---- */

/* Returns the width of words in em. */
static double width_of(const thr_font *font, const char *words)
{
  double width = 0;
  while (*words)
    width += thr_font_advance(font, font->glyph[thr_font_letter(&words)]);
  return width;
}

/* Appends letters as four hexadecimal digits each, and notes which letters the face needs. */
static void put_letters(thr_paper *paper, int face, const char *words, thr_text *out)
{
  static const char digit[] = "0123456789ABCDEF";
  unsigned char *needs = paper->needs.letter[face];

  while (*words) {
    /* The code of a letter in the file's fonts is its Unicode number. */
    unsigned letter = thr_font_letter(&words);
    for (int shift = 12; shift >= 0; shift -= 4)
      thr_text_byte(out, digit[letter >> shift & 15]);
    needs[letter / 8] |= (unsigned char)(1u << letter % 8);
  }
}

/* Opens a span with the actual text if words hold letters beyond the basic plane, which the page
 * shows as boxes; a search then finds the letters themselves. Returns whether the span was
 * opened. */
static bool open_span(thr_paper *paper, const char *words)
{
  bool beyond = false;

  /* Letters beyond the basic plane begin with a byte of 0xf0 or more in UTF-8. */
  for (const char *place = words; *place; place++)
    beyond = beyond || (unsigned char)*place >= 0xf0;
  if (!beyond) return false;

  /* FEFF says that UTF-16 follows, the higher byte first. */
  thr_text_append(&paper->out, "/Span <</ActualText <FEFF");
  for (const char *place = words; *place;) {
    const unsigned char *bytes = (const unsigned char *)place;
    unsigned letter = thr_font_letter(&place);

    /* UTF-16 writes such a letter as two surrogates (RFC 2781). */
    if (*bytes >= 0xf0 && place - (const char *)bytes == 4) {
      unsigned high = ((*bytes & 7u) << 18 | (bytes[1] & 0x3fu) << 12 | (bytes[2] & 0x3fu) << 6 |
                       (bytes[3] & 0x3fu)) -
                      0x10000;
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

  /* Where the text begins, from the width of all its letters. */
  const double size = letters->size, width = size * width_of(&paper->font[face], words),
               left = at[0] - letters->anchor * width;

  /* No letter reaches further than two sizes around the base line. */
  if (is_hidden(paper, (thr_box){left, at[1], left + width, at[1]}, 2 * size))
    return; /* no letter reaches further */
  if (!paper->needs.letter[face]) paper->needs.letter[face] = thr_calloc(THR_FONT_LETTERS / 8, 1);
  if (!paper->needs.letter[face]) {
    paper->out.failed = true;
    return;
  }

  thr_text set = {0};
  put_letters(paper, face, words, &set);

  /* Letters stand upright although y points down. */
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
