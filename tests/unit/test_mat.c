/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mat: true to size, no piece on another, every piece's name whole on a page, register marks of
 * two pages on each other. */
#include "diagram/export/paper.h"
#include "diagram/mat/mat.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
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

enum { MOST_MARKS = 2000 };

static thr_mat *mat_of(const thr_plan *p, thr_page_size page)
{
  thr_err err = {0};
  thr_mat *mat;
  assert_ok(thr_mat_make(&mat, p, page, 0, &err), &err);
  return mat;
}

static thr_text page_of(const thr_mat *mat, int i)
{
  thr_text svg = {0};
  ck_assert_int_eq(thr_mat_svg(mat, i, &svg, NULL), THR_OK);
  return svg;
}

/* What the mat is made of: a shape, so many mm from node to node, solid or tubes. */
static thr_plan plan_of(thr_shape shape, int size, double pitch, bool tubes)
{
  thr_frame f = shape_make(shape, size, 5);
  thr_request o = thr_request_default();
  for (int v = 0; v < f.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] *= pitch / 20;
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] *= pitch / 20;
  thr_plan p = plan_make(&f, &o);
  p.options.joint =
      tubes ? THR_JOINT_TUBE : THR_JOINT_SOLID; /* whether it is tied is nothing to the mat */
  thr_frame_destroy(&f);
  return p;
}

static const struct {
  thr_shape shape;
  int size;
  double pitch;
  bool tubes;
  int pages; /* 0 = some */
} cases[] = {{THR_MAKE_DOME, 7, 20, false, 1},
             {THR_MAKE_DOME, 7, 65, false, 6},
             {THR_MAKE_TUBE, 8, 30, false, 0},
             {THR_MAKE_DOME, 5, 90, true, 0},
             {THR_MAKE_GEODESIC, 2, 60, false, 0}};
enum { CASES = sizeof cases / sizeof *cases };

/* Neighbours are as far from each other as in the framework, or all further by the same part. */
START_TEST(middles_are_true_to_size)
{
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].pitch, false);
  thr_mat *mat = mat_of(&p, THR_PAGE_A4);
  double least = HUGE_VAL;
  for (int e = 0; e < p.frame.n_edges; e++) {
    double a[2], b[2];
    thr_mat_at(mat, p.frame.edge[e][0], a);
    thr_mat_at(mat, p.frame.edge[e][1], b);
    least = fmin(least, hypot(b[0] - a[0], b[1] - a[1]) / p.frame.length[e]);
  }
  ck_assert_double_eq_tol(least, 1, 1e-9);
  if (cases[_i].pages) ck_assert_int_eq(thr_mat_pages(mat), cases[_i].pages);
  thr_mat_destroy(mat);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(every_piece_is_whole_at_its_middle_on_a_page)
{
  const double room = 5; /* mm around it */
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].pitch, cases[_i].tubes);
  for (int page = 0; page < THR_N_PAGES; page++) {
    thr_mat *mat = mat_of(&p, (thr_page_size)page);
    double size[2];
    thr_page_mm((thr_page_size)page, size);
    int n = cases[_i].tubes ? p.frame.n_edges : p.frame.n_nodes;
    for (int piece = 0; piece < n; piece++) {
      double at[2];
      bool found = false;
      thr_mat_at(mat, piece, at);
      for (int i = 0; i < thr_mat_pages(mat) && !found; i++) {
        double corner[2];
        thr_mat_corner(mat, i, corner);
        found = at[0] - room > corner[0] && at[0] + room < corner[0] + size[0] - 24 &&
                at[1] - room > corner[1] && at[1] + room < corner[1] + size[1] - 24 - 39;
      }
      ck_assert(found);
    }
    thr_mat_destroy(mat);
  }
  thr_plan_destroy(&p);
}
END_TEST

/* A register mark is a circle of this radius. */
static int read_marks(const thr_text *svg, const double corner[2], double (*mark)[2], int n)
{
  for (const char *c = svg->data; (c = strstr(c, "<circle cx=\"")) != NULL; c++) {
    double x, y, r;
    ck_assert_int_eq(sscanf(c, "<circle cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &r), 3);
    if (r != 1.8) continue;
    ck_assert_int_lt(n, MOST_MARKS);
    mark[n][0] = x - 12 + corner[0];
    mark[n++][1] = y - 31 + corner[1];
  }
  return n;
}

START_TEST(marks_of_two_pages_lie_on_each_other)
{
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].pitch, cases[_i].tubes);
  thr_mat *mat = mat_of(&p, THR_PAGE_A4);
  double(*mark)[2] = calloc(MOST_MARKS, sizeof *mark);
  int n = 0;
  for (int i = 0; i < thr_mat_pages(mat); i++) {
    double corner[2];
    thr_mat_corner(mat, i, corner);
    thr_text svg = page_of(mat, i);
    int before = n;
    n = read_marks(&svg, corner, mark, n);
    if (thr_mat_pages(mat) > 1) ck_assert_int_ge(n - before, 3);
    ck_assert_ptr_nonnull(strstr(svg.data, "h100.00"));
    thr_text_destroy(&svg);
  }
  for (int i = 0; i < n; i++) {
    int twins = 0;
    for (int j = 0; j < n; j++)
      twins += j != i && hypot(mark[j][0] - mark[i][0], mark[j][1] - mark[i][1]) < 0.02;
    ck_assert_int_ge(twins, 1);
  }
  ck_assert_int_eq(n == 0, thr_mat_pages(mat) == 1);
  free(mark);
  thr_mat_destroy(mat);
  thr_plan_destroy(&p);
}
END_TEST

/* All pages in one file, each with names of its own; nothing where memory runs out. */
START_TEST(as_html)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 7, 65, false);
  thr_mat *mat = mat_of(&p, THR_PAGE_A4);
  thr_text html = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_mat_html(mat, &html, &err), THR_OK);
  int n = 0;
  for (const char *c = html.data; (c = strstr(c, "<section class=\"page\"")) != NULL; c++)
    n++;
  ck_assert_int_eq(n, thr_mat_pages(mat));
  ck_assert_ptr_nonnull(strstr(html.data, "url(#p6-window)"));
  ck_assert_ptr_null(strstr(html.data, "url(#window)"));
  thr_text_destroy(&html);

  thr_status st = THR_ENOMEM;
  for (int k = 1; st; k++) {
    html = (thr_text){0};
    thr_alloc_fail_at(k);
    st = thr_mat_html(mat, &html, &err);
    thr_alloc_fail_at(0);
    if (st) ck_assert_int_eq(st, THR_ENOMEM);
    if (st) ck_assert_uint_eq(html.length, 0);
    thr_text_destroy(&html);
  }
  thr_mat_destroy(mat);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(what_has_no_mat)
{
  thr_err err = {0};
  thr_mat *mat;
  thr_plan p = plan_of(THR_MAKE_DOME, 7, 20, false);
  snprintf(p.frame.units, sizeof p.frame.units, "unit");
  ck_assert_int_eq(thr_mat_make(&mat, &p, THR_PAGE_A4, 0, &err), THR_EINPUT);
  ck_assert_ptr_null(mat);
  ck_assert_ptr_nonnull(strstr(err.text, "nobody knows"));
  err = (thr_err){0};
  snprintf(p.frame.units, sizeof p.frame.units, "m");
  ck_assert_int_eq(thr_mat_make(&mat, &p, THR_PAGE_A4, 0, &err), THR_EINPUT);
  ck_assert_ptr_null(mat);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("mat");
  ADD_LOOP(s, 30, middles_are_true_to_size, 0, CASES);
  ADD_LOOP(s, 30, every_piece_is_whole_at_its_middle_on_a_page, 0, CASES);
  ADD_LOOP(s, 30, marks_of_two_pages_lie_on_each_other, 0, CASES);
  ADD_TEST(s, 30, as_html);
  ADD_TEST(s, 30, what_has_no_mat);
  return run_suite(s);
}
