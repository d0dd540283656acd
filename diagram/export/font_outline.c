/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines of glyphs: quadratic curves through points that lie on them or off them (ISO/IEC
 * 14496-22, table glyf). */
#include "diagram/export/export_parts.h"

#include <stdlib.h>

enum { ON = 1, SHORT_X = 2, SHORT_Y = 4, REPEATED = 8, SAME_X = 16, SAME_Y = 32 };
enum { WORDS = 1, OFFSETS = 2, SCALE = 8, MORE = 32, TWO_SCALES = 64, MATRIX = 128 };
enum { DEPTH = 6, MOST_POINTS = 20000 };

typedef struct {
  double xy[2];
  bool on;
} point;

/* Flags, then all x, then all y, each as what it differs from the one before by. Returns false if
 * the glyph has not all of them.
 */
static bool read_points(const thr_font *f, size_t at, size_t end, point *points,
                        unsigned char *flags, int n)
{
  for (int i = 0; i < n;) {
    if (at + 1 > end) return false;
    unsigned flag = thr_font_8(f, at++), again = 1;
    if (flag & REPEATED) again += thr_font_8(f, at++);
    for (; again && i < n; again--)
      flags[i++] = (unsigned char)flag;
  }
  for (int axis = 0; axis < 2; axis++) {
    const unsigned small = axis ? SHORT_Y : SHORT_X, same = axis ? SAME_Y : SAME_X;
    double value = 0;
    for (int i = 0; i < n; i++) {
      if (flags[i] & small) {
        value += (flags[i] & same ? 1 : -1) * (double)thr_font_8(f, at++);
      } else if (!(flags[i] & same)) {
        value += thr_font_signed(f, at);
        at += 2;
      }
      points[i].xy[axis] = value;
      points[i].on = flags[i] & ON;
    }
  }
  return at <= end;
}

static void put(const double place[6], char what, const double xy[2], thr_text *path)
{
  thr_text_printf(path, "%c%.3f %.3f", what, place[0] * xy[0] + place[2] * xy[1] + place[4],
                  place[1] * xy[0] + place[3] * xy[1] + place[5]);
}

static void between(const point *a, const point *b, double xy[2])
{
  for (int k = 0; k < 2; k++)
    xy[k] = 0.5 * (a->xy[k] + b->xy[k]);
}

/* A closed curve. Between two points off it lies one on it, half way. */
static void put_contour(const point *points, int n, const double place[6], thr_text *path)
{
  double at[2];
  int first = 0;
  while (first < n && !points[first].on)
    first++;
  if (first < n)
    between(&points[first], &points[first], at);
  else
    between(&points[n - 1], &points[0], at);
  first = first < n ? first + 1 : 0;
  put(place, 'M', at, path);
  for (int i = 0; i < n; i++) {
    const point *p = &points[(first + i) % n], *next = &points[(first + i + 1) % n];
    if (p->on && i < n - 1) put(place, 'L', p->xy, path);
    if (p->on) continue;
    between(next->on ? next : p, next, at);
    put(place, 'Q', p->xy, path);
    put(place, ' ', at, path);
    i += next->on;
  }
  thr_text_byte(path, 'Z');
}

static void put_simple(const thr_font *f, size_t at, size_t end, const double place[6],
                       thr_text *path)
{
  int contours = thr_font_signed(f, at),
      n = contours ? thr_font_signed(f, at + 8 + 2 * (size_t)contours) + 1 : 0;
  size_t from = at + 10 + 2 * (size_t)contours;
  from += 2 + (size_t)thr_font_16(f, from); /* instructions */
  if (n <= 0 || n > MOST_POINTS) return;
  point *points = thr_calloc((size_t)n, sizeof *points);
  unsigned char *flags = thr_calloc((size_t)n, 1);
  bool whole = points && flags && read_points(f, from, end, points, flags, n);
  path->failed |= !points || !flags;
  for (int c = 0, begin = 0; c < contours && whole; c++) {
    int last = thr_font_signed(f, at + 10 + 2 * (size_t)c);
    if (last < begin || last >= n) break;
    put_contour(points + begin, last - begin + 1, place, path);
    begin = last + 1;
  }
  free(points);
  free(flags);
}

/* Numbers of 2.14 bits. */
static double part_scale(const thr_font *f, size_t at)
{
  return thr_font_signed(f, at) / 16384.0;
}

/* Where a part of a composed glyph lies in it; returns where the next one begins. */
static size_t read_part(const thr_font *f, size_t at, unsigned flags, double part[6])
{
  const bool words = flags & WORDS, moved = flags & OFFSETS;
  const double own[6] = {1, 0, 0, 1, 0, 0};
  for (int k = 0; k < 6; k++)
    part[k] = own[k];
  for (size_t k = 0; k < 2 && moved; k++)
    part[4 + k] =
        words ? thr_font_signed(f, at + 2 * k) : (double)(signed char)thr_font_8(f, at + k);
  at += words ? 4 : 2;
  const size_t n = flags & SCALE ? 1 : flags & TWO_SCALES ? 2 : flags & MATRIX ? 4 : 0;
  for (size_t k = 0; k < n; k++)
    part[n == 2 ? 3 * k : k] = part_scale(f, at + 2 * k);
  if (n == 1) part[3] = part[0];
  return at + 2 * n;
}

static void put_glyph(const thr_font *f, int glyph, const double place[6], int depth,
                      thr_text *path)
{
  size_t at, n;
  if (!thr_font_place(f, glyph, &at, &n) || n < 10 || depth > DEPTH) return;
  if (thr_font_signed(f, at) >= 0) {
    put_simple(f, at, at + n, place, path);
    return;
  }
  unsigned flags = MORE;
  for (size_t from = at + 10; flags & MORE && from + 4 <= at + n;) {
    double p[6], whole[6];
    int part = (int)thr_font_16(f, from + 2);
    flags = thr_font_16(f, from);
    from = read_part(f, from + 4, flags, p);
    for (int k = 0; k < 2; k++) {
      whole[k] = place[k] * p[0] + place[2 + k] * p[1];
      whole[2 + k] = place[k] * p[2] + place[2 + k] * p[3];
      whole[4 + k] = place[k] * p[4] + place[2 + k] * p[5] + place[4 + k];
    }
    put_glyph(f, part, whole, depth + 1, path);
  }
}

void thr_font_outline(const thr_font *f, int glyph, const double place[6], thr_text *path)
{
  put_glyph(f, glyph, place, 0, path);
}
