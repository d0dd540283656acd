/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of the frontier: circles and bands where the numbers say, texts apart and on the
 * sheet. */
#include "diagram/overview/charts.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"
#include "tests/support.h"
#include "tests/svg_tree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 60 };

static const thr_physics physics = {.mu = 0.2, .mu_low = 0.1, .mu_high = 0.3, .seating = 1};

/* Lengths that grow and turnings that fall, of the same size or of very different ones. */
static thr_frontier_chart chart_make(rng *r, int n, thr_frontier_mark mark[MOST])
{
  double length = 1 + 1000 * rng_unit(r), turning = 5 + 60 * rng_unit(r);
  for (int i = 0; i < n; i++) {
    mark[i] = (thr_frontier_mark){.length = length, .turning = turning, .proved = rng_below(r, 2)};
    thr_advice_pulls(&physics, turning / 2, mark[i].pull);
    length *= 1 + 0.1 * rng_unit(r) * rng_unit(r);
    turning *= 0.9 + 0.1 * rng_unit(r);
  }
  return (thr_frontier_chart){.name = "a_name_without_any_blank_that_is_longer_than_the_sheet_is_"
                                      "wide_and_so_has_to_be_broken_all_the_"
                                      "same_and_once_more",
                              .units = "mm",
                              .physics = &physics,
                              .shortest = mark[0].length,
                              .n = n,
                              .mark = mark};
}

/* The circle of a point, and the band drawn about it. */
static int circle_of(const svg_tree *t, int i)
{
  char id[24];
  snprintf(id, sizeof id, "point-%d", i + 1);
  ck_assert_int_ge(svg_by_id(t, id), 0);
  return svg_by_id(t, id);
}

static int band_of(const svg_tree *t, int i)
{
  for (int k = 0; k < t->n; k++)
    if (svg_has_class(t, k, "band") && i-- == 0) return k;
  ck_abort_msg("too few bands");
}

START_TEST(points_and_bands_are_to_scale)
{
  rng r = rng_make((uint64_t)_i);
  thr_frontier_mark mark[MOST];
  int n = rng_between(&r, 2, MOST);
  thr_frontier_chart chart = chart_make(&r, n, mark);
  thr_text svg = {0}, again = {0};
  ck_assert_int_eq(thr_frontier_svg(&chart, &svg, NULL), THR_OK);
  ck_assert_int_eq(thr_frontier_svg(&chart, &again, NULL), THR_OK);
  ck_assert_str_eq(svg.data, again.data);
  svg_tree t = svg_parse(svg.data);
  int first = circle_of(&t, 0), last = circle_of(&t, n - 1);
  double wide = (svg_number(&t, last, "cx") - svg_number(&t, first, "cx")) /
                (mark[n - 1].length - mark[0].length);
  double mm = svg_number(&t, band_of(&t, 0), "height") /
              log(mark[0].pull[THR_ADVICE_HIGH] / mark[0].pull[THR_ADVICE_LOW]);
  for (int i = 0; i < n; i++) {
    int circle = circle_of(&t, i), band = band_of(&t, i);
    double y = svg_number(&t, circle, "cy");
    ck_assert_double_eq_tol(svg_number(&t, circle, "cx") - svg_number(&t, first, "cx"),
                            wide * (mark[i].length - mark[0].length), 0.03);
    ck_assert_double_eq_tol(y - svg_number(&t, first, "cy"),
                            mm * log(mark[0].pull[THR_ADVICE_MU] / mark[i].pull[THR_ADVICE_MU]),
                            0.1);
    ck_assert_double_eq_tol(y - svg_number(&t, band, "y"),
                            mm * log(mark[i].pull[THR_ADVICE_HIGH] / mark[i].pull[THR_ADVICE_MU]),
                            0.1);
    ck_assert_double_eq_tol(svg_number(&t, band, "height"),
                            mm * log(mark[i].pull[THR_ADVICE_HIGH] / mark[i].pull[THR_ADVICE_LOW]),
                            0.1);
    ck_assert(svg_has_class(&t, circle, "proved") == mark[i].proved);
  }
  svg_tree_destroy(&t);
  thr_text_destroy(&svg);
  thr_text_destroy(&again);
}
END_TEST

START_TEST(texts_lie_apart_and_on_the_sheet)
{
  rng r = rng_make((uint64_t)_i + 100);
  thr_frontier_mark mark[MOST];
  int n = 1 + 3 * _i % MOST;
  thr_frontier_chart chart = chart_make(&r, n, mark);
  thr_text svg = {0};
  double box[4], other[4];
  if (_i % 4 == 0) mark[0].pull[THR_ADVICE_HIGH] = INFINITY;
  if (_i % 8 == 0) mark[0].pull[THR_ADVICE_MU] = INFINITY;
  ck_assert_int_eq(thr_frontier_svg(&chart, &svg, NULL), THR_OK);
  svg_tree t = svg_parse(svg.data);
  for (int i = 0; i < t.n; i++) {
    if (strcmp(t.element[i].name, "text") != 0 || !t.element[i].text[0]) continue;
    ck_assert_double_ge(svg_number(&t, i, "font-size"), 7 * 25.4 / 72);
    svg_box(&t, i, box);
    ck_assert_msg(box[0] > 0 && box[1] > 0 && box[2] < t.width && box[3] < t.height,
                  "%s leaves the sheet", t.element[i].text);
    for (int k = 0; k < i; k++) {
      if (strcmp(t.element[k].name, "text") != 0 || !t.element[k].text[0]) continue;
      svg_box(&t, k, other);
      ck_assert_msg(!svg_overlap(box, other, 0), "%s lies on %s", t.element[i].text,
                    t.element[k].text);
    }
  }
  svg_tree_destroy(&t);
  thr_text_destroy(&svg);
}
END_TEST

START_TEST(no_point_no_picture)
{
  const thr_frontier_chart chart = {.name = "", .units = "mm", .physics = &physics};
  thr_text svg = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_frontier_svg(&chart, &svg, &err), THR_EINPUT);
  ck_assert_ptr_null(svg.data);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("frontier chart");
  ADD_LOOP(s, 10, points_and_bands_are_to_scale, 0, 20);
  ADD_LOOP(s, 10, texts_lie_apart_and_on_the_sheet, 0, 20);
  ADD_TEST(s, 10, no_point_no_picture);
  return run_suite(s);
}
