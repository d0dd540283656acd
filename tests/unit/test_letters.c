/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Outlines of letters: as many closed curves as a letter has edges, holes against the rest,
 * capitals as high as they are to be.
 */
#include "diagram/export/paper.h"
#include "diagram/mat/mat.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A path of M, L, Q and Z: its curves, twice the area within their corners, the box around them. */
typedef struct {
  int curves, forwards;
  double low[2], high[2];
} shape;

static shape read_path(const char *d)
{
  shape s = {.low = {HUGE_VAL, HUGE_VAL}, .high = {-HUGE_VAL, -HUGE_VAL}};
  double first[2] = {0}, last[2] = {0}, area = 0;
  while (*d) {
    char what = *d++;
    if (what == 'Z') {
      area += last[0] * first[1] - first[0] * last[1];
      s.curves++;
      s.forwards += area > 0;
      continue;
    }
    ck_assert_msg(strchr("MLQ ", what) != NULL, "unexpected %c", what);
    double at[2];
    for (int k = 0; k < 2; k++) {
      char *end;
      at[k] = strtod(d, &end);
      ck_assert(end > d);
      d = end + (k == 0);
      s.low[k] = fmin(s.low[k], at[k]);
      s.high[k] = fmax(s.high[k], at[k]);
    }
    if (what == 'M') {
      memcpy(first, at, sizeof first);
      area = 0;
    } else
      area += last[0] * at[1] - at[0] * last[1];
    memcpy(last, at, sizeof last);
  }
  return s;
}

static shape shape_of(const thr_letters_set *set, const char *words)
{
  thr_text path = {0};
  thr_letters_put(set, words, (const double[]){5, 50}, 10, &path);
  ck_assert(path.data && !path.failed);
  shape s = read_path(path.data);
  thr_text_destroy(&path);
  return s;
}

/* The outer edge runs one way, holes the other: what every program fills or raises alike. */
START_TEST(letters_have_their_holes)
{
  static const struct {
    const char *letters;
    int holes;
  } kinds[] = {{"CEFGHIJKLMNSTUVWXYZ12357-", 0}, {"ADOPQR4690", 1}, {"B8", 2}};
  thr_letters_set *set;
  ck_assert_int_eq(thr_letters_open(&set, NULL), THR_OK);
  const int outer = shape_of(set, "I").forwards; /* of one curve */
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    for (const char *c = kinds[k].letters; *c; c++) {
      shape s = shape_of(set, (const char[]){*c, '\0'});
      ck_assert_msg(s.curves == 1 + kinds[k].holes, "%c: %d curves", *c, s.curves);
      ck_assert_int_eq(outer ? s.forwards : s.curves - s.forwards, 1);
    }
  thr_letters_close(set);
}
END_TEST

/* A letter with a mark is composed of two: as many curves as both, the letter where it is alone. */
START_TEST(composed_letters_are_whole)
{
  thr_letters_set *set;
  ck_assert_int_eq(thr_letters_open(&set, NULL), THR_OK);
  shape e = shape_of(set, "E"), marked = shape_of(set, "\xc3\x89"); /* U+00C9 */
  ck_assert_int_eq(marked.curves, e.curves + 1);
  ck_assert_double_eq_tol(marked.low[0], e.low[0], 1e-9);
  ck_assert_double_lt(marked.low[1], e.low[1] - 0.5);
  ck_assert_double_eq_tol(marked.high[1], e.high[1], 1e-9);
  thr_letters_close(set);
}
END_TEST

START_TEST(capitals_are_as_high_as_asked)
{
  thr_letters_set *set;
  ck_assert_int_eq(thr_letters_open(&set, NULL), THR_OK);
  shape h = shape_of(set, "H"), two = shape_of(set, "HH");
  ck_assert_double_eq_tol(h.low[1], 40, 0.01);
  ck_assert_double_eq_tol(h.high[1], 50, 0.01);
  ck_assert_double_eq_tol(two.high[0] - h.high[0], 10 * thr_letters_width(set, "H"), 0.01);
  thr_letters_close(set);
}
END_TEST

/* Every piece has its name, none wider than the room on its hub or higher than that: a square as
 * wide as an arm, 0.35 of 20 mm.
 */
START_TEST(names_lie_on_their_pieces)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 5 + 7 * _i, 0);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  thr_text svg = {0};
  int n = 0;
  ck_assert_int_eq(thr_emboss_svg(&p, &svg, NULL), THR_OK);
  for (const char *at = svg.data; (at = strstr(at, "<path d=\"")); n++) {
    at += strlen("<path d=\"");
    size_t length = strcspn(at, "\"");
    char *path = calloc(length + 1, 1);
    memcpy(path, at, length);
    shape s = read_path(path);
    free(path);
    ck_assert_double_lt(s.high[0] - s.low[0], 7.8);
    ck_assert_double_lt(s.high[1] - s.low[1], 7.8);
    ck_assert_double_gt(s.high[1] - s.low[1], 1);
  }
  ck_assert_int_eq(n, f.n_nodes);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

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
  ADD_TEST(s, 10, letters_have_their_holes);
  ADD_TEST(s, 10, composed_letters_are_whole);
  ADD_TEST(s, 10, capitals_are_as_high_as_asked);
  ADD_TEST(s, 10, all_parts_of_a_letter_are_kept);
  ADD_LOOP(s, 20, names_lie_on_their_pieces, 0, 2);
  return run_suite(s);
}
