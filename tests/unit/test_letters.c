/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of composed letters: a font that is cut down to some letters keeps all of their parts. */
#include "diagram/export/paper.h"
#include "graph/status.h"
#include "graph/text.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

enum { PARTS = 100 };

/* Appends a glyph that is composed of n others, one after the other. */
static void put_composed(thr_text *glyf, int first, int n)
{
  const char head[10] = {(char)0xff, (char)0xff};
  thr_text_append_bytes(glyf, head, sizeof head);
  for (int i = 0; i < n; i++) {
    const char more = i + 1 < n ? 32 : 0,
               part[6] = {0, more, (char)((first + i) >> 8), (char)((first + i) & 255)};
    thr_text_append_bytes(glyf, part, sizeof part);
  }
}

/* Appends the record of a table to a font's directory. */
static void put_record(thr_text *file, const char *tag, int at, size_t n)
{
  const char record[12] = {
      0, 0, 0, 0, 0, 0, (char)(at >> 8), (char)(at & 255), 0, 0, (char)(n >> 8), (char)(n & 255)};
  thr_text_append(file, tag);
  thr_text_append_bytes(file, record, sizeof record);
}

/* Glyph 2 PARTS + 1 has PARTS parts, each of which has a part, with smaller numbers. */
START_TEST(all_parts_of_a_letter_are_kept)
{
  enum { GLYPHS = 2 * PARTS + 2, HEAD = 12 + 3 * 16, LOCA = HEAD + 54 };
  thr_font font = {.n_glyphs = GLYPHS};
  thr_text glyf = {0}, loca = {0}, out = {0};
  unsigned char used[GLYPHS] = {0};

  for (int i = 0; i <= GLYPHS; i++) {
    const size_t half = glyf.length / 2;
    const char at[2] = {(char)(half >> 8), (char)(half & 255)}, simple[12] = {0};
    thr_text_append_bytes(&loca, at, sizeof at);
    if (i <= PARTS)
      thr_text_append_bytes(&glyf, simple, sizeof simple);
    else if (i < GLYPHS - 1)
      put_composed(&glyf, i - PARTS, 1);
    else if (i < GLYPHS)
      put_composed(&glyf, PARTS + 1, PARTS);
  }

  const char start[12] = {0, 1, 0, 0, 0, 3}, head[54] = {0};
  const int at = LOCA + (int)loca.length;
  thr_text_append_bytes(&font.file, start, sizeof start);
  put_record(&font.file, "glyf", at, glyf.length);
  put_record(&font.file, "head", HEAD, sizeof head);
  put_record(&font.file, "loca", LOCA, loca.length);
  thr_text_append_bytes(&font.file, head, sizeof head);
  thr_text_append_bytes(&font.file, loca.data, loca.length);
  thr_text_append_bytes(&font.file, glyf.data, glyf.length);

  used[GLYPHS - 1] = 1;
  ck_assert_int_eq(thr_font_subset(&font, used, &out, NULL), THR_OK);
  for (int i = 0; i < GLYPHS; i++)
    ck_assert_msg(used[i], "glyph %d", i);
  thr_text_destroy(&glyf);
  thr_text_destroy(&loca);
  thr_text_destroy(&out);
  thr_font_destroy(&font);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("letters");
  ADD_TEST(s, 10, all_parts_of_a_letter_are_kept);
  return run_suite(s);
}
