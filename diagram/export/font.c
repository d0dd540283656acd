/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads TrueType fonts (ISO/IEC 14496-22, "OpenType"): which glyph a letter has, how wide a glyph
 * is, and a font of some glyphs alone for a PDF.
 *
 * A font file is a directory of tables with names of four letters. Used here: cmap (from letters to
 * glyphs), hmtx (widths), loca (where each outline begins), glyf (the outlines), head, hhea and
 * maxp (sizes). All numbers are big-endian. Whatever a file holds, bytes are read within the file's
 * bounds only: what lies beyond counts as 0.
 *
 * Example: of DejaVu Sans the letters of one booklet need some 80 outlines of some 6000. */
#include "diagram/export/export_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- bytes ---- */

/* Returns the number of 32 bits at a byte of the file. */
static size_t read_32(const thr_font *font, size_t at)
{
  return (size_t)thr_font_16(font, at) << 16 | thr_font_16(font, at + 2);
}

/* Appends a number of 16 bits, the higher byte first. */
static void put_16(thr_text *out, unsigned value)
{
  thr_text_byte(out, (char)(value >> 8 & 255));
  thr_text_byte(out, (char)(value & 255));
}

/* Appends a number of 32 bits, the highest byte first. */
static void put_32(thr_text *out, size_t value)
{
  put_16(out, (unsigned)(value >> 16 & 0xffff));
  put_16(out, (unsigned)(value & 0xffff));
}

/* Returns where a table of the font is, n = 0 if the font has none or the file ends before it. */
static thr_font_part find(const thr_font *font, const char *tag)
{
  enum { HEADER = 12, RECORD = 16 };

  unsigned n = thr_font_16(font, font->start + 4);
  for (unsigned i = 0; i < n; i++) {
    size_t at = font->start + HEADER + (size_t)i * RECORD;

    /* The directory of a file that was cut off ends early. */
    if (at + RECORD > font->file.length) break;

    /* A record holds the table's name, a sum of its bytes, where it is, and how long. */
    thr_font_part found = {read_32(font, at + 8), read_32(font, at + 12)};
    if (memcmp(font->file.data + at, tag, 4) == 0 && found.at <= font->file.length &&
        found.n <= font->file.length - found.at)
      return found;
  }
  return (thr_font_part){0, 0};
}

/* ---- letters ---- */

/* Reads a table of segments (cmap, format 4) into font->glyph: runs of letters whose glyphs are the
 * letters' own numbers plus a constant, or stand in a list. */
static void read_segments(thr_font *font, size_t at)
{
  /* Four arrays of n numbers each: last letter, first letter, constant, place of the list. */
  size_t n = thr_font_16(font, at + 6) / 2, ends = at + 14, starts = ends + 2 * n + 2,
         deltas = starts + 2 * n, lists = deltas + 2 * n;

  for (size_t i = 0; i < n; i++) {
    unsigned first = thr_font_16(font, starts + 2 * i), last = thr_font_16(font, ends + 2 * i),
             list = thr_font_16(font, lists + 2 * i), delta = thr_font_16(font, deltas + 2 * i);
    for (unsigned letter = first; letter <= last && letter < THR_FONT_LETTERS - 1; letter++) {
      /* The place of a list counts from where that place itself is written. */
      unsigned glyph =
          list ? thr_font_16(font, lists + 2 * i + list + 2 * (size_t)(letter - first)) : letter;
      if (glyph || !list) glyph = (glyph + delta) & 0xffff;

      font->glyph[letter] = (int)glyph < font->n_glyphs ? (uint16_t)glyph : 0;
    }
  }
}

/* Reads which glyph each letter has. Returns false if the font has no table of segments for
 * Unicode. */
static bool read_letters(thr_font *font)
{
  thr_font_part cmap = find(font, "cmap");

  for (unsigned i = 0; cmap.n && i < thr_font_16(font, cmap.at + 2); i++) {
    size_t record = cmap.at + 4 + 8 * (size_t)i, at = cmap.at + read_32(font, record + 4);
    unsigned platform = thr_font_16(font, record), encoding = thr_font_16(font, record + 2);

    /* Platform 0 is Unicode, platform 3 Windows. */
    bool unicode = platform == 0 || (platform == 3 && encoding == 1);

    /* Only tables of segments (format 4) are read. */
    if (!unicode || thr_font_16(font, at) != 4) continue;

    read_segments(font, at);
    return true;
  }
  return false;
}

/* Fails with what is wrong with a font and what to install. */
static thr_status no_font(const char *path, const char *what, thr_err *err)
{
  return thr_fail(err, THR_ESOLVER, "the font %s cannot be used: %s; install fonts-dejavu-core",
                  path, what);
}

thr_status thr_font_read(thr_font *font, const char *path, int index, const char *name,
                         thr_err *err)
{
  snprintf(font->name, sizeof font->name, "%.63s", name);

  thr_status st = thr_text_read(&font->file, path, err);
  if (st) return st;

  /* A collection holds several fonts: its header says where each begins. */
  if (font->file.length > 12 && memcmp(font->file.data, "ttcf", 4) == 0)
    font->start = read_32(font, 12 + 4 * (size_t)index);

  /* Everything that a PDF needs must be there. */
  thr_font_part head = find(font, "head"), hhea = find(font, "hhea"), maxp = find(font, "maxp"),
                hmtx = find(font, "hmtx");

  if (!head.n || !hhea.n || !maxp.n || !hmtx.n || !find(font, "glyf").n || !find(font, "loca").n)
    return no_font(path, "it has no TrueType outlines", err);

  /* Places of these numbers within their tables are fixed by the standard. */
  font->units = (int)thr_font_16(font, head.at + 18);
  for (size_t i = 0; i < 4; i++)
    font->box[i] = thr_font_signed(font, head.at + 36 + 2 * i);

  font->ascent = thr_font_signed(font, hhea.at + 4);
  font->descent = thr_font_signed(font, hhea.at + 6);
  font->n_metrics = (int)thr_font_16(font, hhea.at + 34);
  font->n_glyphs = (int)thr_font_16(font, maxp.at + 4);

  if (!font->units || !font->n_metrics || !font->n_glyphs)
    return no_font(path, "its sizes are none", err);

  font->glyph = thr_calloc(THR_FONT_LETTERS, sizeof *font->glyph);
  if (!font->glyph) return thr_nomem(err);

  return read_letters(font) ? THR_OK : no_font(path, "it has no table of Unicode letters", err);
}

void thr_font_destroy(thr_font *font)
{
  thr_text_destroy(&font->file);
  free(font->glyph);
  *font = (thr_font){0};
}

unsigned thr_font_letter(const char **words)
{
  const unsigned char *byte = (const unsigned char *)*words;

  /* The first byte says how many there are, unless one of the others does not go on. */
  int n = *byte < 0x80 ? 1 : *byte >= 0xf0 ? 4 : *byte >= 0xe0 ? 3 : *byte >= 0xc0 ? 2 : 1;

  for (int i = 1; i < n; i++)
    if ((byte[i] & 0xc0) != 0x80) n = i;

  *words += n;

  /* Six bits from each byte behind the first one. */
  if (n == 1 && *byte < 0x80) return *byte;
  if (n == 2 && *byte < 0xe0) return (*byte & 0x1fu) << 6 | (byte[1] & 0x3fu);
  if (n == 3 && *byte < 0xf0)
    return (*byte & 0x0fu) << 12 | (byte[1] & 0x3fu) << 6 | (byte[2] & 0x3fu);
  return 0xfffd;
}

double thr_font_advance(const thr_font *font, int glyph)
{
  /* Glyphs behind the last width have the same width, as in fonts of one width. */
  int i = glyph < font->n_metrics ? glyph : font->n_metrics - 1;
  return (double)thr_font_16(font, find(font, "hmtx").at + 4 * (size_t)i) / font->units;
}

/* ---- a part of a font ---- */

thr_font_part thr_font_place(const thr_font *font, int glyph)
{
  thr_font_part glyf = find(font, "glyf"), loca = find(font, "loca");

  /* As loca says: places are numbers of 32 bits, or halves of them in 16. */
  bool wide = thr_font_16(font, find(font, "head").at + 50) != 0;

  /* A glyph ends where the next one begins, so loca has one place more than glyphs. */
  size_t i = (size_t)glyph, from, to;

  if (glyph >= font->n_glyphs || (wide ? 4 : 2) * (i + 2) > loca.n) return (thr_font_part){0, 0};
  from = wide ? read_32(font, loca.at + 4 * i) : 2 * (size_t)thr_font_16(font, loca.at + 2 * i);
  to = wide ? read_32(font, loca.at + 4 * i + 4)
            : 2 * (size_t)thr_font_16(font, loca.at + 2 * i + 2);

  /* A blank has no bytes. */
  return from < to && to <= glyf.n ? (thr_font_part){glyf.at + from, to - from}
                                   : (thr_font_part){0, 0};
}

/* Flags of a part of a composed glyph: its offset has words; scales, of 14 bits behind the point,
 * and another part follow. */
enum { WORDS = 1, SCALE = 8, MORE = 32, TWO_SCALES = 64, MATRIX = 128 };

/* Takes a part off the front of what is left of a composed glyph's outline behind the head.
 * Returns false if there is none. */
static bool next_part(const thr_font *font, thr_font_part *left, int *glyph)
{
  if (left->n < 4) return false;
  const unsigned flags = thr_font_16(font, left->at);
  *glyph = (int)thr_font_16(font, left->at + 2);

  /* Behind flags and glyph: an offset, then one scale for both axes, one for each, or a matrix. */
  const size_t scales = flags & SCALE ? 1 : flags & TWO_SCALES ? 2 : flags & MATRIX ? 4 : 0;
  const size_t read = 4u + (flags & WORDS ? 4u : 2u) + 2 * scales;
  *left = flags & MORE && read < left->n ? (thr_font_part){left->at + read, left->n - read}
                                         : (thr_font_part){0, 0};
  return true;
}

/* Marks the glyphs that a composed glyph is made of. Returns the first of all glyphs that was not
 * marked before, n_glyphs if there is none. */
static int mark_parts(const thr_font *font, int glyph, unsigned char *used)
{
  thr_font_part left = thr_font_place(font, glyph);
  int first = font->n_glyphs, part;

  /* A simple glyph has a number of contours >= 0 and no parts. */
  if (left.n < THR_FONT_HEAD || thr_font_signed(font, left.at) >= 0) return first;

  left = (thr_font_part){left.at + THR_FONT_HEAD, left.n - THR_FONT_HEAD};
  while (next_part(font, &left, &part)) {
    if (part >= font->n_glyphs || used[part]) continue;
    used[part] = 1;
    if (part < first) first = part;
  }
  return first;
}

/* Appends the used outlines one after the other to glyf, and where each begins to loca, in 32 bits.
 * A glyph that is not used has an empty one. */
static void put_outlines(const thr_font *font, const unsigned char *used, thr_text *glyf,
                         thr_text *loca)
{
  for (int i = 0; i < font->n_glyphs; i++) {
    put_32(loca, glyf->length);

    /* The number of a glyph stays the same, so the glyphs before it need places, too. */
    thr_font_part outline = used[i] ? thr_font_place(font, i) : (thr_font_part){0, 0};
    if (outline.n) thr_text_append_bytes(glyf, font->file.data + outline.at, outline.n);

    /* Outlines begin at multiples of four bytes. */
    while (glyf->length % 4)
      thr_text_byte(glyf, '\0');
  }

  put_32(loca, glyf->length);
}

/* Appends a font file: the directory, then the tables, two of them made anew and the others as they
 * were. */
static void put_tables(const thr_font *font, const thr_text *glyf, const thr_text *loca,
                       thr_text *out)
{
  static const char *const tag[] = {"cvt ", "fpgm", "glyf", "head", "hhea",
                                    "hmtx", "loca", "maxp", "prep"};
  enum { N = sizeof tag / sizeof *tag, GLYF = 2, HEAD = 3, LOCA = 6 };

  size_t begin = out->length, at = 12 + 16 * N;

  thr_font_part old[N];

  /* The header: version, number of tables, and three numbers for a search by halving: 16 times the
   * greatest power of 2 up to N, its exponent, 16 times the rest. */
  put_32(out, 0x00010000);
  put_16(out, N);
  put_16(out, 128);
  put_16(out, 3);
  put_16(out, 16 * N - 128);

  /* The directory, in the order of names; each table begins at a multiple of four bytes. */
  for (int i = 0; i < N; i++) {
    old[i] = find(font, tag[i]);
    size_t n = i == GLYF ? glyf->length : i == LOCA ? loca->length : old[i].n;

    thr_text_append(out, tag[i]);
    put_32(out, 0); /* sums of tables are not looked at in a PDF */
    put_32(out, at);
    put_32(out, n);
    at += (n + 3) / 4 * 4;
  }

  /* The tables. */
  for (int i = 0; i < N; i++) {
    size_t from = out->length;
    if (i == GLYF || i == LOCA) {
      const thr_text *made = i == GLYF ? glyf : loca;
      if (made->length) thr_text_append_bytes(out, made->data, made->length);
    } else if (old[i].n)
      thr_text_append_bytes(out, font->file.data + old[i].at, old[i].n);

    /* head says how wide the numbers of loca are: 32 bits now. */
    if (i == HEAD && !out->failed && old[i].n > 52) out->data[from + 51] = 1;

    while (!out->failed && (out->length - begin) % 4)
      thr_text_byte(out, '\0');
  }
}

thr_status thr_font_subset(const thr_font *font, unsigned char *used, thr_text *out, thr_err *err)
{
  thr_text glyf = {0}, loca = {0};

  /* Glyph 0 stands for all letters that the font lacks. A part with a smaller number sends the
   * search back to it; parts are marked only once, so that the search ends even in a wrong font. */
  used[0] = 1;
  for (int i = 0; i < font->n_glyphs;) {
    int first = used[i] ? mark_parts(font, i, used) : font->n_glyphs;
    i = first < i ? first : i + 1;
  }

  /* Both tables are made before the file that holds them. */
  put_outlines(font, used, &glyf, &loca);

  bool ok = !glyf.failed && !loca.failed;
  if (ok) put_tables(font, &glyf, &loca, out);

  thr_text_destroy(&glyf);
  thr_text_destroy(&loca);
  return ok && !out->failed ? THR_OK : thr_nomem(err);
}
