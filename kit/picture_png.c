/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes pixels as PNG (ISO/IEC 15948): a signature, then chunks of length, name, bytes and check
 * sum. Rows of colours are written as differences to the row above, which compress well; rows of
 * numbers of colours as they are. An animation has chunks between those of a PNG: acTL says how
 * many pictures there are, fcTL where and how long each is shown, fdAT is an IDAT with a number
 * (W3C, PNG, third edition). */
#include "kit/picture.h"

#include "diagram/export/export_parts.h"
#include "kit/files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char SIGNATURE[] = "\x89PNG\r\n\x1a\n";

/* Writes a number as four bytes, the largest first. */
static void put_number(uint32_t number, char bytes[4])
{
  for (int i = 0; i < 4; i++)
    bytes[i] = (char)(number >> (24 - 8 * i) & 0xff);
}

/* Appends a chunk with a name of four letters. */
static void put_chunk(thr_text *png, const char *name, const char *bytes, size_t n)
{
  char number[4];
  put_number((uint32_t)n, number);
  thr_text_append_bytes(png, number, sizeof number);
  thr_text_append_bytes(png, name, 4);
  thr_text_append_bytes(png, bytes, n);
  put_number(thr_kit_checksum(thr_kit_checksum(0, name, 4), bytes, n), number);
  thr_text_append_bytes(png, number, sizeof number);
}

/* Appends the first chunk: width, height, 8 bits a number, and what numbers are: 2 three colours, 3
 * places in a palette. */
static void put_head(thr_text *png, const int size[2], char kind)
{
  char head[13] = {0};
  put_number((uint32_t)size[0], head);
  put_number((uint32_t)size[1], head + 4);
  head[8] = 8;
  head[9] = kind;
  put_chunk(png, "IHDR", head, sizeof head);
}

/* Appends a whole file with one picture, whose rows are compressed. palette NULL: in true colours.
 * png is unchanged on failure. */
static thr_status put_file(const int size[2], const thr_png_palette *palette, const thr_text *rows,
                           thr_text *png, thr_err *err)
{
  thr_text whole = {0};
  thr_text_append_bytes(&whole, SIGNATURE, 8);
  put_head(&whole, size, palette ? 3 : 2);
  if (palette) put_chunk(&whole, "PLTE", (const char *)palette->colour, sizeof palette->colour);
  put_chunk(&whole, "IDAT", rows->data, rows->length);
  put_chunk(&whole, "IEND", "", 0);
  if (!whole.failed) thr_text_append_bytes(png, whole.data, whole.length);
  const bool failed = whole.failed || png->failed;
  thr_text_destroy(&whole);
  return failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_png_write(const unsigned char *pixel, const int size[2], thr_text *png, thr_err *err)
{
  enum { UP = 2 }; /* the filter that takes the row above away */
  thr_status st = thr_deflate_load(err);
  if (st) return st;

  /* Rows, each behind the number of its filter. */
  size_t row = 3 * (size_t)size[0], n = (row + 1) * (size_t)size[1];
  char *rows = thr_calloc(n, 1), *to = rows;
  if (!rows) return thr_nomem(err);
  for (int y = 0; y < size[1]; y++, pixel += row) {
    *to++ = UP;
    for (size_t i = 0; i < row; i++)
      *to++ = (char)(unsigned char)(pixel[i] - (y ? pixel[i - row] : 0));
  }

  thr_text small = {0};
  st = thr_deflate(rows, n, THR_DEFLATE_FAST, &small, err);
  if (!st) st = put_file(size, NULL, &small, png, err);
  thr_text_destroy(&small);
  free(rows);
  return st;
}

/* ---- numbers of colours ---- */

/* A part of a picture, px: its upper left corner, width and height. */
typedef struct {
  int at[2], size[2];
} part;

/* Appends the compressed rows of a part. Where a number is that of `last`, 0 is written; NULL: no
 * such picture. */
static thr_status squeeze(const unsigned char *index, const unsigned char *last, int width,
                          part box, thr_text *small, thr_err *err)
{
  size_t row = (size_t)box.size[0] + 1, n = row * (size_t)box.size[1];
  char *rows = thr_calloc(n, 1); /* each behind the number of its filter, 0: none */
  if (!rows) return thr_nomem(err);
  for (int y = 0; y < box.size[1]; y++)
    for (int x = 0; x < box.size[0]; x++) {
      size_t from = (size_t)(box.at[1] + y) * (size_t)width + (size_t)(box.at[0] + x);
      bool same = last && index[from] == last[from];
      rows[(size_t)y * row + (size_t)x + 1] = (char)(same ? 0 : index[from]);
    }
  thr_status st = thr_deflate(rows, n, THR_DEFLATE_SMALL, small, err);
  free(rows);
  return st;
}

thr_status thr_png_write_indexed(const unsigned char *index, const int size[2],
                                 const thr_png_palette *palette, thr_text *png, thr_err *err)
{
  thr_text small = {0};
  thr_status st = thr_deflate_load(err);
  if (!st) st = squeeze(index, NULL, size[0], (part){.size = {size[0], size[1]}}, &small, err);
  if (!st) st = put_file(size, palette, &small, png, err);
  thr_text_destroy(&small);
  return st;
}

/* ---- animations ---- */

thr_status thr_apng_begin(thr_apng *apng, const int size[2], int n_pictures,
                          const thr_png_palette *palette, thr_text *png, thr_err *err)
{
  *apng = (thr_apng){.size = {size[0], size[1]}, .png = png};
  thr_status st = thr_deflate_load(err);
  if (st) return st;
  apng->last = thr_calloc((size_t)size[0] * (size_t)size[1], 1);
  if (!apng->last) return thr_nomem(err);

  char count[8] = {0}; /* of pictures; of times that it is played, 0: for ever */
  put_number((uint32_t)n_pictures, count);
  thr_text_append_bytes(png, SIGNATURE, 8);
  put_head(png, size, 3);
  put_chunk(png, "acTL", count, sizeof count);
  put_chunk(png, "PLTE", (const char *)palette->colour, sizeof palette->colour);
  put_chunk(png, "tRNS", "", 1); /* number 0 lets the picture before be seen */
  return png->failed ? thr_nomem(err) : THR_OK;
}

/* Returns the box of the pixels that changed, or the first pixel if none did. */
static part find_change(const thr_apng *apng, const unsigned char *index)
{
  int low[2] = {apng->size[0], apng->size[1]}, high[2] = {-1, -1};
  for (int y = 0; y < apng->size[1]; y++)
    for (int x = 0; x < apng->size[0]; x++) {
      size_t i = (size_t)y * (size_t)apng->size[0] + (size_t)x;
      if (index[i] == apng->last[i]) continue;
      low[0] = x < low[0] ? x : low[0];
      high[0] = x > high[0] ? x : high[0];
      low[1] = y < low[1] ? y : low[1];
      high[1] = y;
    }
  if (high[0] < 0) return (part){.size = {1, 1}};
  return (part){{low[0], low[1]}, {high[0] - low[0] + 1, high[1] - low[1] + 1}};
}

thr_status thr_apng_add(thr_apng *apng, const unsigned char *index, double seconds, thr_err *err)
{
  enum { SIZE = 4, AT = 12, DELAY = 20, BLEND = 25, PARTS = 1000 };
  bool first = apng->written == 0;
  part box = {.size = {apng->size[0], apng->size[1]}};
  if (!first) box = find_change(apng, index);

  /* Its number, place and time; a picture stays where the next one has nothing over it. */
  char control[26] = {0};
  put_number(apng->written++, control);
  for (int k = 0; k < 2; k++) {
    put_number((uint32_t)box.size[k], control + SIZE + 4 * k);
    put_number((uint32_t)box.at[k], control + AT + 4 * k);
  }
  put_number((uint32_t)lround(PARTS * seconds) << 16 | PARTS, control + DELAY);
  control[BLEND] = (char)!first;
  put_chunk(apng->png, "fcTL", control, sizeof control);

  /* Its pixels: the chunk of the first picture has no number before them. */
  thr_text small = {0};
  char number[4];
  put_number(apng->written, number);
  if (!first) thr_text_append_bytes(&small, number, sizeof number);
  thr_status st = squeeze(index, first ? NULL : apng->last, apng->size[0], box, &small, err);
  if (!st) put_chunk(apng->png, first ? "IDAT" : "fdAT", small.data, small.length);
  apng->written += !first;
  thr_text_destroy(&small);
  memcpy(apng->last, index, (size_t)apng->size[0] * (size_t)apng->size[1]);
  return !st && apng->png->failed ? thr_nomem(err) : st;
}

thr_status thr_apng_end(thr_apng *apng, thr_err *err)
{
  put_chunk(apng->png, "IEND", "", 0);
  return apng->png->failed ? thr_nomem(err) : THR_OK;
}

void thr_apng_destroy(thr_apng *apng)
{
  free(apng->last);
  *apng = (thr_apng){0};
}
