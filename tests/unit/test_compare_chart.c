/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a comparison: bars, points and bands as high as the numbers say, texts apart and
 * on the sheet; what the frontier is. */
#include "diagram/overview/charts.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/svg_tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 7 };

/* Plans of a ring with 1, 2, .. cords, and pulls of which nothing is asked but that they differ. */
typedef struct {
  int n;
  thr_frame f;
  thr_plan plan[MOST];
  char name[MOST][120];
  thr_compare_column column[MOST];
} sample;

static sample sample_make(rng *r, int n)
{
  static const char letters[] =
      "a_long/name of-a.plan without_an_end_that_has_to_be_broken_somewhere_all_the_same_";
  sample s = {.n = n, .f = ring_make(12)};
  for (int i = 0; i < n; i++) {
    thr_request request = thr_request_default();
    request.ends = THR_ENDS_ANY;
    request.cords = request.cords_least = 1 + rng_below(r, 6);
    request.cover = 1 + rng_below(r, 2);
    ck_assert_int_eq(thr_plan_make(&s.f, &request, &(thr_limits){0}, &s.plan[i], NULL, NULL),
                     THR_OK);
    snprintf(s.name[i], sizeof s.name[i], "%.*s%d.json", rng_below(r, 80), letters, i);
  }
  return s;
}

/* A struct that is copied takes its plans elsewhere: only now do the columns point to them. */
static void fill_columns(sample *s, rng *r)
{
  for (int i = 0; i < s->n; i++) {
    double pull = exp(9 * rng_unit(r)), band = exp(0.1 + 2 * rng_unit(r));
    s->column[i] = (thr_compare_column){.name = s->name[i],
                                        .plan = &s->plan[i],
                                        .pull = {fmax(1, pull / band), pull, pull * band},
                                        .frontier = rng_below(r, 2)};
  }
}

static void sample_destroy(sample *s)
{
  for (int i = 0; i < s->n; i++)
    thr_plan_destroy(&s->plan[i]);
  thr_frame_destroy(&s->f);
}

static int find(const svg_tree *t, int group, const char *word)
{
  for (int i = 0; i < t->n; i++)
    if (svg_inside(t, i, group) && svg_has_class(t, i, word)) return i;
  return -1;
}

/* What the drawing of plan i says, mm: cord and what the edges need of it, number of cords, y of
 * the pull, and of its band. */
typedef struct {
  double cord, base, count, pull, high, low;
} heights;

static heights read_column(const svg_tree *t, const sample *s, int i)
{
  char id[24];
  snprintf(id, sizeof id, "plan-%d", i + 1);
  int group = svg_by_id(t, id);
  ck_assert_int_ge(group, 0);
  int base = find(t, group, "base"), over = find(t, group, "over"), band = find(t, group, "band"),
      count = find(t, group, "count");
  int point = find(t, group, s->column[i].frontier ? "chosen" : "point");
  for (int k = 0; k < t->n && s->column[i].frontier; k++)
    if (svg_inside(t, k, group) && strcmp(t->element[k].name, "circle") == 0) point = k;
  ck_assert(base >= 0 && band >= 0 && count >= 0 && point >= 0);
  heights h = {.base = svg_number(t, base, "height"),
               .count = svg_number(t, count, "height"),
               .pull = svg_number(t, point, "cy"),
               .high = svg_number(t, band, "y")};
  h.low = h.high + svg_number(t, band, "height");
  h.cord = h.base + (over >= 0 ? svg_number(t, over, "height") : 0);
  return h;
}

START_TEST(what_is_drawn_is_to_scale)
{
  rng r = rng_make((uint64_t)_i);
  sample s = sample_make(&r, rng_between(&r, 2, MOST));
  thr_text svg = {0}, again = {0};
  fill_columns(&s, &r);
  ck_assert_int_eq(thr_compare_svg(s.column, s.n, "a note", &svg, NULL), THR_OK);
  ck_assert_int_eq(thr_compare_svg(s.column, s.n, "a note", &again, NULL), THR_OK);
  ck_assert_str_eq(svg.data, again.data);
  svg_tree t = svg_parse(svg.data);
  heights first = read_column(&t, &s, 0);
  const thr_compare_column *c = s.column;
  for (int i = 1; i < s.n; i++) {
    heights h = read_column(&t, &s, i);
    const thr_metrics *mine = &s.plan[i].metrics, *other = &s.plan[0].metrics;
    ck_assert_double_eq_tol(h.cord * other->length, first.cord * mine->length,
                            0.012 * (mine->length + other->length));
    ck_assert_double_eq_tol(h.base * other->length,
                            first.cord * fmin(mine->base_length, mine->length),
                            0.012 * (mine->length + other->length));
    ck_assert_double_eq_tol(h.count * s.plan[0].n_cords, first.count * s.plan[i].n_cords,
                            0.012 * (s.plan[i].n_cords + s.plan[0].n_cords));
    /* one scale for all pulls and bands */
    double mm =
        (first.low - first.high) / log(c[0].pull[THR_ADVICE_HIGH] / c[0].pull[THR_ADVICE_LOW]);
    ck_assert_double_eq_tol(first.pull - h.pull,
                            mm * log(c[i].pull[THR_ADVICE_MU] / c[0].pull[THR_ADVICE_MU]), 0.5);
    ck_assert_double_eq_tol(h.low - h.high,
                            mm * log(c[i].pull[THR_ADVICE_HIGH] / c[i].pull[THR_ADVICE_LOW]), 0.5);
  }
  svg_tree_destroy(&t);
  thr_text_destroy(&svg);
  thr_text_destroy(&again);
  sample_destroy(&s);
}
END_TEST

/* Names are whole, whatever their length: their lines, put together, are the name but for blanks.
 */
static void check_name(const svg_tree *t, const char *name)
{
  char all[20000] = "", wanted[200] = "";
  for (int i = 0; i < t->n; i++)
    if (strcmp(t->element[i].name, "text") == 0)
      for (const char *s = t->element[i].text; *s; s++)
        if (*s != ' ') strncat(all, s, 1);
  for (const char *s = name; *s; s++)
    if (*s != ' ') strncat(wanted, s, 1);
  ck_assert_msg(strstr(all, wanted) != NULL, "%s is not in the picture", name);
}

START_TEST(texts_lie_apart_and_on_the_sheet)
{
  rng r = rng_make((uint64_t)_i + 500);
  sample s = sample_make(&r, 1 + _i % MOST);
  thr_text svg = {0};
  double box[4], other[4];
  fill_columns(&s, &r);
  if (_i % 3 == 0) s.column[0].pull[THR_ADVICE_HIGH] = INFINITY;
  if (_i % 5 == 0) s.column[0].pull[THR_ADVICE_MU] = s.column[0].pull[THR_ADVICE_HIGH] = INFINITY;
  ck_assert_int_eq(
      thr_compare_svg(s.column, s.n,
                      "Pull at both ends of every cord, so that 1 N is left where it is slackest.",
                      &svg, NULL),
      THR_OK);
  svg_tree t = svg_parse(svg.data);
  for (int i = 0; i < t.n; i++) {
    if (strcmp(t.element[i].name, "text") != 0) continue;
    ck_assert_double_ge(svg_number(&t, i, "font-size"), 7 * 25.4 / 72);
    svg_box(&t, i, box);
    ck_assert_msg(box[0] > 0 && box[1] > 0 && box[2] < t.width && box[3] < t.height,
                  "%s leaves the sheet", t.element[i].text);
    for (int k = 0; k < i; k++) {
      if (strcmp(t.element[k].name, "text") != 0) continue;
      svg_box(&t, k, other);
      ck_assert_msg(!svg_overlap(box, other, 0), "%s lies on %s", t.element[i].text,
                    t.element[k].text);
    }
  }
  for (int i = 0; i < s.n; i++)
    check_name(&t, s.name[i]);
  svg_tree_destroy(&t);
  thr_text_destroy(&svg);
  sample_destroy(&s);
}
END_TEST

/* The frontier by its definition over all pairs: nobody on it is beaten, everybody off it is, by
 * somebody on it. */
START_TEST(the_frontier_is_what_nobody_beats)
{
  rng r = rng_make((uint64_t)_i);
  thr_price p[9];
  bool on[9];
  for (int i = 0; i < 9; i++)
    p[i] = (thr_price){rng_between(&r, 1, 3), rng_between(&r, 1, 3),
                       rng_below(&r, 8) ? (double)rng_between(&r, 1, 3) : (double)INFINITY};
  for (int i = 0; i < 9; i++) {
    on[i] = true;
    for (int k = 0; k < 9; k++)
      on[i] &= !thr_price_beats(&p[k], &p[i]);
  }
  for (int i = 0; i < 9; i++) {
    bool better = false;
    for (int k = 0; k < 9; k++)
      better |= on[k] && p[k].cords <= p[i].cords && p[k].length <= p[i].length &&
                p[k].pull <= p[i].pull &&
                (p[k].cords < p[i].cords || p[k].length < p[i].length || p[k].pull < p[i].pull);
    ck_assert(on[i] != better);
  }
  ck_assert(!thr_price_beats(&(thr_price){1, 1, NAN}, &p[0]) &&
            !thr_price_beats(&p[0], &(thr_price){9, 9, NAN}));
}
END_TEST

int main(void)
{
  Suite *s = suite_create("compare chart");
  ADD_EXAMPLES(s, 10, what_is_drawn_is_to_scale, 40);
  ADD_EXAMPLES(s, 10, texts_lie_apart_and_on_the_sheet, 42);
  ADD_EXAMPLES(s, 10, the_frontier_is_what_nobody_beats, 300);
  return run_suite(s);
}
