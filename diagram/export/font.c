/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TrueType fonts (ISO/IEC 14496-22, "OpenType"): which glyph a letter has, how wide it is, and a
 * font of some glyphs alone for a PDF. Bytes are read within the file's bounds whatever it holds.
 * Private to diagram/. */
#include "diagram/export/export_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- bytes ---- */

static size_t read_32(const thr_font *f, size_t at)
{
  return (size_t)thr_font_16(f, at) << 16 | thr_font_16(f, at + 2);
}

static void put_16(thr_text *out, unsigned value)
{
  thr_text_byte(out, (char)(value >> 8 & 255));
  thr_text_byte(out, (char)(value & 255));
}

static void put_32(thr_text *out, size_t value)
{
  put_16(out, (unsigned)(value >> 16 & 0xffff));
  put_16(out, (unsigned)(value & 0xffff));
}

typedef struct {
  size_t at, n; /* bytes; n = 0: there is none */
} table;

static table find(const thr_font *f, const char *tag)
{
  enum { HEADER = 12, RECORD = 16 };
  unsigned n = thr_font_16(f, f->start + 4);
  for (unsigned i = 0; i < n; i++) {
    size_t at = f->start + HEADER + (size_t)i * RECORD;
    if (at + RECORD > f->file.length) break;
    table t = {read_32(f, at + 8), read_32(f, at + 12)};
    if (memcmp(f->file.data + at, tag, 4) == 0 && t.at <= f->file.length &&
        t.n <= f->file.length - t.at)
      return t;
  }
  return (table){0, 0};
}

/* ---- letters ---- */

/* A table of segments (format 4): runs of letters whose glyphs are theirs plus a constant, or stand
 * in a list. */
static void read_segments(thr_font *f, size_t at)
{
  size_t n = thr_font_16(f, at + 6) / 2, ends = at + 14, starts = ends + 2 * n + 2,
         deltas = starts + 2 * n, lists = deltas + 2 * n;
  for (size_t i = 0; i < n; i++) {
    unsigned first = thr_font_16(f, starts + 2 * i), last = thr_font_16(f, ends + 2 * i),
             list = thr_font_16(f, lists + 2 * i), delta = thr_font_16(f, deltas + 2 * i);
    for (unsigned c = first; c <= last && c < THR_FONT_LETTERS - 1; c++) {
      unsigned glyph = list ? thr_font_16(f, lists + 2 * i + list + 2 * (size_t)(c - first)) : c;
      if (glyph || !list) glyph = (glyph + delta) & 0xffff;
      f->glyph[c] = (int)glyph < f->n_glyphs ? (uint16_t)glyph : 0;
    }
  }
}

static bool read_letters(thr_font *f)
{
  table cmap = find(f, "cmap");
  for (unsigned i = 0; cmap.n && i < thr_font_16(f, cmap.at + 2); i++) {
    size_t record = cmap.at + 4 + 8 * (size_t)i, at = cmap.at + read_32(f, record + 4);
    unsigned platform = thr_font_16(f, record), encoding = thr_font_16(f, record + 2);
    bool unicode = platform == 0 || (platform == 3 && encoding == 1);
    if (!unicode || thr_font_16(f, at) != 4) continue;
    read_segments(f, at);
    return true;
  }
  return false;
}

static thr_status no_font(const char *path, const char *what, thr_err *err)
{
  return thr_fail(err, THR_ESOLVER, "the font %s cannot be used: %s; install fonts-dejavu-core",
                  path, what);
}

thr_status thr_font_read(thr_font *f, const char *path, int index, const char *name, thr_err *err)
{
  snprintf(f->name, sizeof f->name, "%.63s", name);
  thr_status st = thr_text_read(&f->file, path, err);
  if (st) return st;
  if (f->file.length > 12 && memcmp(f->file.data, "ttcf", 4) == 0)
    f->start = read_32(f, 12 + 4 * (size_t)index);
  table head = find(f, "head"), hhea = find(f, "hhea"), maxp = find(f, "maxp"),
        hmtx = find(f, "hmtx");
  if (!head.n || !hhea.n || !maxp.n || !hmtx.n || !find(f, "glyf").n || !find(f, "loca").n)
    return no_font(path, "it has no TrueType outlines", err);
  f->units = (int)thr_font_16(f, head.at + 18);
  for (size_t i = 0; i < 4; i++)
    f->box[i] = thr_font_signed(f, head.at + 36 + 2 * i);
  f->ascent = thr_font_signed(f, hhea.at + 4);
  f->descent = thr_font_signed(f, hhea.at + 6);
  f->n_metrics = (int)thr_font_16(f, hhea.at + 34);
  f->n_glyphs = (int)thr_font_16(f, maxp.at + 4);
  if (!f->units || !f->n_metrics || !f->n_glyphs) return no_font(path, "its sizes are none", err);
  f->glyph = thr_calloc(THR_FONT_LETTERS, sizeof *f->glyph);
  if (!f->glyph) return thr_nomem(err);
  return read_letters(f) ? THR_OK : no_font(path, "it has no table of Unicode letters", err);
}

void thr_font_destroy(thr_font *f)
{
  thr_text_destroy(&f->file);
  free(f->glyph);
  *f = (thr_font){0};
}

unsigned thr_font_letter(const char **s)
{
  const unsigned char *c = (const unsigned char *)*s;
  int n = *c < 0x80 ? 1 : *c >= 0xf0 ? 4 : *c >= 0xe0 ? 3 : *c >= 0xc0 ? 2 : 1;
  for (int i = 1; i < n; i++)
    if ((c[i] & 0xc0) != 0x80) n = i;
  *s += n;
  if (n == 1 && *c < 0x80) return *c;
  if (n == 2 && *c < 0xe0) return (*c & 0x1fu) << 6 | (c[1] & 0x3fu);
  if (n == 3 && *c < 0xf0) return (*c & 0x0fu) << 12 | (c[1] & 0x3fu) << 6 | (c[2] & 0x3fu);
  return 0xfffd;
}

double thr_font_advance(const thr_font *f, int glyph)
{
  int i = glyph < f->n_metrics ? glyph : f->n_metrics - 1;
  return (double)thr_font_16(f, find(f, "hmtx").at + 4 * (size_t)i) / f->units;
}

/* ---- a part of a font ---- */

/* Outline of a glyph in table glyf. */
static table outline_of(const thr_font *f, int glyph)
{
  table glyf = find(f, "glyf"), loca = find(f, "loca");
  bool wide = thr_font_16(f, find(f, "head").at + 50) != 0;
  size_t i = (size_t)glyph, from, to;
  if ((wide ? 4 : 2) * (i + 2) > loca.n) return (table){0, 0};
  from = wide ? read_32(f, loca.at + 4 * i) : 2 * (size_t)thr_font_16(f, loca.at + 2 * i);
  to = wide ? read_32(f, loca.at + 4 * i + 4) : 2 * (size_t)thr_font_16(f, loca.at + 2 * i + 2);
  return from < to && to <= glyf.n ? (table){glyf.at + from, to - from} : (table){0, 0};
}

bool thr_font_place(const thr_font *f, int glyph, size_t *at, size_t *n)
{
  table outline = glyph >= 0 && glyph < f->n_glyphs ? outline_of(f, glyph) : (table){0, 0};
  *at = outline.at;
  *n = outline.n;
  return outline.n > 0;
}

/* Marks the parts of a composed glyph; each mark is new once, so it ends. */
static void mark_parts(const thr_font *f, int glyph, unsigned char *used)
{
  enum { WORDS = 1, SCALE = 8, MORE = 32, TWO_SCALES = 64, MATRIX = 128, DEPTH = 64 };
  int stack[DEPTH], depth = 0;
  for (stack[depth++] = glyph; depth;) {
    table outline = outline_of(f, stack[--depth]);
    if (outline.n < 10 || thr_font_signed(f, outline.at) >= 0) continue;
    unsigned flags = MORE;
    for (size_t at = outline.at + 10; flags & MORE && at + 4 <= outline.at + outline.n;) {
      int part = (int)thr_font_16(f, at + 2);
      flags = thr_font_16(f, at);
      at += 4 + (flags & WORDS ? 4u : 2u) +
            (flags & SCALE        ? 2u
             : flags & TWO_SCALES ? 4u
             : flags & MATRIX     ? 8u
                                  : 0u);
      if (part >= f->n_glyphs || used[part]) continue;
      used[part] = 1;
      if (depth < DEPTH) stack[depth++] = part;
    }
  }
}

/* The outlines one after the other, and where each begins. */
static void put_outlines(const thr_font *f, const unsigned char *used, thr_text *glyf,
                         thr_text *loca)
{
  for (int i = 0; i < f->n_glyphs; i++) {
    put_32(loca, glyf->length);
    table outline = used[i] ? outline_of(f, i) : (table){0, 0};
    if (outline.n) thr_text_append_bytes(glyf, f->file.data + outline.at, outline.n);
    while (glyf->length % 4)
      thr_text_byte(glyf, '\0');
  }
  put_32(loca, glyf->length);
}

static void put_tables(const thr_font *f, const thr_text *glyf, const thr_text *loca, thr_text *out)
{
  static const char *const tag[] = {"cvt ", "fpgm", "glyf", "head", "hhea",
                                    "hmtx", "loca", "maxp", "prep"};
  enum { N = sizeof tag / sizeof *tag, GLYF = 2, HEAD = 3, LOCA = 6 };
  size_t begin = out->length, at = 12 + 16 * N;
  table t[N];
  put_32(out, 0x00010000);
  put_16(out, N);
  put_16(out,
         128); /* for halving: 16 times the greatest power of 2 up to N, its exponent, the rest */
  put_16(out, 3);
  put_16(out, 16 * N - 128);
  for (int i = 0; i < N; i++) {
    t[i] = find(f, tag[i]);
    size_t n = i == GLYF ? glyf->length : i == LOCA ? loca->length : t[i].n;
    thr_text_append(out, tag[i]);
    put_32(out, 0); /* sums of tables are not looked at in a PDF */
    put_32(out, at);
    put_32(out, n);
    at += (n + 3) / 4 * 4;
  }
  for (int i = 0; i < N; i++) {
    size_t from = out->length;
    if (i == GLYF || i == LOCA) {
      const thr_text *made = i == GLYF ? glyf : loca;
      if (made->length) thr_text_append_bytes(out, made->data, made->length);
    } else if (t[i].n)
      thr_text_append_bytes(out, f->file.data + t[i].at, t[i].n);
    if (i == HEAD && !out->failed && t[i].n > 52)
      out->data[from + 51] = 1; /* places of outlines take 4 bytes */
    while (!out->failed && (out->length - begin) % 4)
      thr_text_byte(out, '\0');
  }
}

thr_status thr_font_subset(const thr_font *f, unsigned char *used, thr_text *out, thr_err *err)
{
  thr_text glyf = {0}, loca = {0};
  used[0] = 1;
  for (int i = 0; i < f->n_glyphs; i++)
    if (used[i]) mark_parts(f, i, used);
  put_outlines(f, used, &glyf, &loca);
  bool ok = !glyf.failed && !loca.failed;
  if (ok) put_tables(f, &glyf, &loca, out);
  thr_text_destroy(&glyf);
  thr_text_destroy(&loca);
  return ok && !out->failed ? THR_OK : thr_nomem(err);
}
