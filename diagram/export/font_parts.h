/* Bytes of a font: big-endian; what is beyond the end of the file is 0. Private to the files font*.c. */
#ifndef THR_FONT_PARTS_H
#define THR_FONT_PARTS_H

#include "diagram/export/font.h"

static inline unsigned thr_font_8(const thr_font *f, size_t at)
{
  return at < f->file.length ? ((const unsigned char *)f->file.data)[at] : 0;
}

static inline unsigned thr_font_16(const thr_font *f, size_t at)
{
  return at + 2 <= f->file.length && at + 2 > at ? thr_font_8(f, at) << 8 | thr_font_8(f, at + 1) : 0;
}

static inline int thr_font_signed(const thr_font *f, size_t at)
{
  int value = (int)thr_font_16(f, at);
  return value >= 0x8000 ? value - 0x10000 : value;
}

/* Where the outline of a glyph stands in the file: *n bytes. False: it has none. */
bool thr_font_place(const thr_font *f, int glyph, size_t *at, size_t *n);

#endif
