/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes pixels as PNG (ISO/IEC 15948): a signature, then chunks of length, name, bytes and check
 * sum. Every row is written as differences to the row above, which compress well. */
#include "kit/picture.h"

#include "diagram/export/export_parts.h"
#include "kit/files.h"

#include <stdlib.h>

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

thr_status thr_png_write(const unsigned char *pixel, const int size[2], thr_text *png, thr_err *err)
{
  enum { UP = 2 }; /* the filter that takes the row above away */
  thr_status st = thr_deflate_load(err);
  if (st) return st;

  /* Width, height, 8 bits a colour, three colours, no choices. */
  char head[13] = {0};
  put_number((uint32_t)size[0], head);
  put_number((uint32_t)size[1], head + 4);
  head[8] = 8;
  head[9] = 2;

  /* Rows, each behind the number of its filter. */
  size_t row = 3 * (size_t)size[0], n = (row + 1) * (size_t)size[1];
  char *rows = thr_calloc(n, 1), *to = rows;
  if (!rows) return thr_nomem(err);
  for (int y = 0; y < size[1]; y++, pixel += row) {
    *to++ = UP;
    for (size_t i = 0; i < row; i++)
      *to++ = (char)(unsigned char)(pixel[i] - (y ? pixel[i - row] : 0));
  }

  thr_text small = {0}, whole = {0};
  st = thr_deflate(rows, n, &small, err);
  if (!st) {
    thr_text_append_bytes(&whole, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(&whole, "IHDR", head, sizeof head);
    put_chunk(&whole, "IDAT", small.data, small.length);
    put_chunk(&whole, "IEND", "", 0);
    if (!whole.failed) thr_text_append_bytes(png, whole.data, whole.length);
    if (whole.failed || png->failed) st = thr_nomem(err);
  }
  thr_text_destroy(&small);
  thr_text_destroy(&whole);
  free(rows);
  return st;
}
