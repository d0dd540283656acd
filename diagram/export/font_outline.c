/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the outlines of glyphs as paths of quadratic curves (ISO/IEC 14496-22, table glyf).
 *
 * A contour is a closed sequence of points on the curve and off it. A point off the curve is the
 * control point of a quadratic curve; between two of them in a row lies a point on the curve, half
 * way. A composed glyph places other glyphs by an affine map each.
 *
 * Example: the points on a, off b, off c, on d give "M a Q b (b + c) / 2 Q c d .. Z". */
#include "diagram/export/export_parts.h"

#include <stdlib.h>
#include <string.h>

/* Flags of a point: on the curve; a byte for x, for y; the flag is repeated; of a byte: it is
 * positive, else: the coordinate is that of the point before. */
enum { ON = 1, SHORT_X = 2, SHORT_Y = 4, REPEATED = 8, SAME_X = 16, SAME_Y = 32 };
/* Flags of a part of a composed glyph: its offset has words; it is an offset; scales behind it. */
enum { WORDS = 1, OFFSETS = 2, SCALE = 8, MORE = 32, TWO_SCALES = 64, MATRIX = 128 };
enum { DEPTH = 6, MOST_POINTS = 20000 }; /* of glyphs inside glyphs; of one glyph */

/* A point of an outline, in units of the font, y upwards. */
typedef struct {
  double xy[2];
  bool on;
} outline_point;

/* Reads the points of a glyph: all flags, then all x, then all y, each as the difference from the
 * one before. Returns false if the glyph ends before. */
static bool read_points(const thr_font *font, size_t at, size_t end, outline_point *points,
                        unsigned char *flags, int n)
{
  for (int i = 0; i < n;) {
    if (at + 1 > end) return false;

    /* A flag may be repeated up to 255 times. */
    unsigned flag = thr_font_8(font, at++), again = 1;
    if (flag & REPEATED) again += thr_font_8(font, at++);

    for (; again && i < n; again--)
      flags[i++] = (unsigned char)flag;
  }

  for (int axis = 0; axis < 2; axis++) {
    /* All x come before all y; each axis begins at 0. */
    const unsigned small = axis ? SHORT_Y : SHORT_X, same = axis ? SAME_Y : SAME_X;
    double value = 0;
    for (int i = 0; i < n; i++) {
      /* A byte has its sign in the flags; a missing word means no difference. */
      if (flags[i] & small) {
        value += (flags[i] & same ? 1 : -1) * (double)thr_font_8(font, at++);
      } else if (!(flags[i] & same)) {
        value += thr_font_signed(font, at);
        at += 2;
      }

      points[i].xy[axis] = value;
      points[i].on = flags[i] & ON;
    }
  }

  return at <= end;
}

/* Appends a path command, or a blank, with a point moved to its place. */
static void put(const double place[6], char what, const double xy[2], thr_text *path)
{
  thr_text_printf(path, "%c%.3f %.3f", what, place[0] * xy[0] + place[2] * xy[1] + place[4],
                  place[1] * xy[0] + place[3] * xy[1] + place[5]);
}

/* Computes the point half way between two points. */
static void between(const outline_point *one, const outline_point *other, double xy[2])
{
  for (int k = 0; k < 2; k++)
    xy[k] = 0.5 * (one->xy[k] + other->xy[k]);
}

/* Appends a closed contour of n points. */
static void put_contour(const outline_point *points, int n, const double place[6], thr_text *path)
{
  double at[2];
  int first = 0;

  /* Begin at a point on the curve, or half way between two if none is. */
  while (first < n && !points[first].on)
    first++;
  if (first < n)
    between(&points[first], &points[first], at);
  else
    between(&points[n - 1], &points[0], at);

  first = first < n ? first + 1 : 0;

  put(place, 'M', at, path);
  for (int i = 0; i < n; i++) {
    const outline_point *now = &points[(first + i) % n], *next = &points[(first + i + 1) % n];

    /* The last line is drawn by Z. */
    if (now->on && i < n - 1) put(place, 'L', now->xy, path);
    if (now->on) continue;

    between(next->on ? next : now, next, at);
    put(place, 'Q', now->xy, path);
    put(place, ' ', at, path);

    /* The end of the curve was a point of its own: it is done, too. */
    i += next->on;
  }

  thr_text_byte(path, 'Z');
}

/* Appends all contours of a simple glyph, nothing if its bytes make no sense. */
static void put_simple(const thr_font *font, size_t at, size_t end, const double place[6],
                       thr_text *path)
{
  /* The last contour's last point says how many points there are. */
  int contours = thr_font_signed(font, at),
      n = contours ? thr_font_signed(font, at + 8 + 2 * (size_t)contours) + 1 : 0;

  size_t from = at + 10 + 2 * (size_t)contours;
  from += 2 + (size_t)thr_font_16(font, from); /* instructions */
  if (n <= 0 || n > MOST_POINTS) return;

  outline_point *points = thr_calloc((size_t)n, sizeof *points);
  unsigned char *flags = thr_calloc((size_t)n, 1);
  bool whole = points && flags && read_points(font, from, end, points, flags, n);

  path->failed |= !points || !flags;
  for (int contour = 0, begin = 0; contour < contours && whole; contour++) {
    /* Contours follow each other; each says its last point. */
    int last = thr_font_signed(font, at + 10 + 2 * (size_t)contour);
    if (last < begin || last >= n) break;
    put_contour(points + begin, last - begin + 1, place, path);
    begin = last + 1;
  }

  free(points);
  free(flags);
}

/* Returns a scale, a number with 14 bits behind the point. */
static double part_scale(const thr_font *font, size_t at)
{
  return thr_font_signed(font, at) / 16384.0;
}

bool thr_font_next_part(const thr_font *font, thr_font_part *left, int *glyph, double map[6])
{
  const double same[6] = {1, 0, 0, 1, 0, 0};
  if (left->n < 4) return false;

  const unsigned flags = thr_font_16(font, left->at);
  *glyph = (int)thr_font_16(font, left->at + 2);
  memcpy(map, same, sizeof same);

  /* An offset; parts that are placed by matching points stay where they are. */
  size_t at = left->at + 4;
  const bool words = flags & WORDS, moved = flags & OFFSETS;
  for (size_t k = 0; k < 2 && moved; k++)
    map[4 + k] =
        words ? thr_font_signed(font, at + 2 * k) : (double)(signed char)thr_font_8(font, at + k);

  at += words ? 4 : 2;

  /* One scale for both axes, one for each, or a whole matrix. */
  const size_t n = flags & SCALE ? 1 : flags & TWO_SCALES ? 2 : flags & MATRIX ? 4 : 0;
  for (size_t k = 0; k < n; k++)
    map[n == 2 ? 3 * k : k] = part_scale(font, at + 2 * k);

  if (n == 1) map[3] = map[0];
  at += 2 * n;

  /* Another part follows if the flags say so and the outline has bytes left. */
  const size_t read = at - left->at;
  *left =
      flags & MORE && read < left->n ? (thr_font_part){at, left->n - read} : (thr_font_part){0, 0};
  return true;
}

/* Appends a glyph, simple or composed; depth of glyphs inside glyphs, from 0. */
static void put_glyph(const thr_font *font, int glyph, const double place[6], int depth,
                      thr_text *path)
{
  thr_font_part left = thr_font_place(font, glyph);
  double own[6], whole[6];
  int part;
  if (left.n < THR_FONT_HEAD || depth > DEPTH) return;

  if (thr_font_signed(font, left.at) >= 0) {
    put_simple(font, left.at, left.at + left.n, place, path);
    return;
  }

  /* A composed glyph: its parts one after the other. */
  left = (thr_font_part){left.at + THR_FONT_HEAD, left.n - THR_FONT_HEAD};
  while (thr_font_next_part(font, &left, &part, own)) {
    /* The part's map, then the map of the whole. */
    for (int k = 0; k < 2; k++) {
      whole[k] = place[k] * own[0] + place[2 + k] * own[1];
      whole[2 + k] = place[k] * own[2] + place[2 + k] * own[3];
      whole[4 + k] = place[k] * own[4] + place[2 + k] * own[5] + place[4 + k];
    }

    put_glyph(font, part, whole, depth + 1, path);
  }
}

void thr_font_outline(const thr_font *font, int glyph, const double place[6], thr_text *path)
{
  put_glyph(font, glyph, place, 0, path);
}
