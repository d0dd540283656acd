/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which frameworks are drawn in space, and their overview there: every piece is named and every end
 * of a cord marked; failing allocations are reported. */
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/space/space.h"
#include "graph/number.h"
#include "tests/frameworks.h"
#include "tests/sample_plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A torus of so many rings of so many nodes each. */
static thr_frame torus_make(int rings, int round)
{
  enum { MOST = 64 };
  double xyz[MOST][3];
  int edge[2 * MOST][2], n = 0;
  for (int r = 0; r < rings; r++)
    for (int k = 0; k < round; k++, n++) {
      const double a = 2 * THR_PI * r / rings, b = 2 * THR_PI * k / round, far = 100 + 40 * cos(b);
      xyz[n][0] = far * cos(a);
      xyz[n][1] = far * sin(a);
      xyz[n][2] = 40 * sin(b);
      edge[2 * n][0] = edge[2 * n + 1][0] = n;
      edge[2 * n][1] = r * round + (k + 1) % round;
      edge[2 * n + 1][1] = (r + 1) % rings * round + k;
    }
  return frame_make(n, (const double(*)[3])xyz, 2 * n, (const int(*)[2])edge, NULL, NULL);
}

/* A tower of storeys of triangles or squares, with a diagonal in every side. */
static thr_frame tower_make(int sides, int storeys)
{
  enum { MOST = 64 };
  double xyz[MOST][3];
  int edge[3 * MOST][2], n = 0, m = 0;
  for (int s = 0; s < storeys; s++)
    for (int k = 0; k < sides; k++, n++) {
      xyz[n][0] = 30 * cos(2 * THR_PI * k / sides);
      xyz[n][1] = 30 * sin(2 * THR_PI * k / sides);
      xyz[n][2] = 35 * s;
      const int next = s * sides + (k + 1) % sides;
      edge[m][0] = n, edge[m++][1] = next;
      if (s + 1 == storeys) continue;
      edge[m][0] = n, edge[m++][1] = n + sides;
      edge[m][0] = n, edge[m++][1] = next + sides;
    }
  return frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL);
}

static bool is_flat(thr_frame frame)
{
  thr_guide guide;
  ck_assert_int_eq(thr_guide_make(&guide, &frame, NULL, NULL), THR_OK);
  const bool flat = guide.flat;
  thr_guide_destroy(&guide);
  thr_frame_destroy(&frame);
  return flat;
}

START_TEST(shells_are_flat_and_others_are_not)
{
  ck_assert(is_flat(shape_make(THR_MAKE_DOME, 7, 0)));
  ck_assert(is_flat(shape_make(THR_MAKE_TUBE, 12, 7)));
  ck_assert(is_flat(shape_make(THR_MAKE_GEODESIC, 2, 0)));
  ck_assert(is_flat(shape_make(THR_MAKE_SPHERE, 2, 0)));
  ck_assert(is_flat(path_make(4)));
  ck_assert(!is_flat(torus_make(8, 5)));
  ck_assert(!is_flat(tower_make(6, 3)));
}
END_TEST

static thr_status draw(const thr_plan *p, thr_text *svg, thr_err *err)
{
  thr_guide guide;
  const thr_overview_options o = thr_overview_options_default();
  thr_status st = thr_guide_make(&guide, &p->frame, NULL, err);
  if (!st) st = thr_space_overview(p, &guide, &o, svg, err);
  thr_guide_destroy(&guide);
  return st;
}

/* With tube joints, too; and the same bytes again. */
START_TEST(every_piece_is_named)
{
  thr_plan p = plan_of(_i % 2 ? tower_make(6, 3) : torus_make(8, 5), THR_ENDS_ANY, 2);
  thr_text svg = {0}, again = {0};
  thr_err err = {0};
  char word[64];
  if (_i > 1) p.options.joint = THR_JOINT_TUBE;
  assert_ok(draw(&p, &svg, &err), &err);
  assert_ok(draw(&p, &again, &err), &err);
  ck_assert_str_eq(svg.data, again.data);
  for (int v = 0; v < p.frame.n_nodes; v++) {
    snprintf(word, sizeof word, ">%s</text>", p.frame.name[v]);
    ck_assert_msg(strstr(svg.data, word), "%s has no name", p.frame.name[v]);
  }
  for (int c = 0; c < p.n_cords; c++)
    for (int end = 0; end < 2; end++) {
      snprintf(word, sizeof word, ">%c%s</text>", end ? 'E' : 'S',
               p.n_cords > 1 ? p.cord[c].id : "");
      ck_assert_msg(strstr(svg.data, word), "%s is not marked", word);
    }
  for (int i = 1; i <= 4; i++) {
    snprintf(word, sizeof word, "<g id=\"view-%d\">", i);
    ck_assert_ptr_nonnull(strstr(svg.data, word));
  }
  thr_text_destroy(&again);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(every_failing_allocation_is_reported)
{
  thr_plan p = plan_of(tower_make(3, 2), THR_ENDS_ANY, 1);
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k += 3) {
    thr_text svg = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = draw(&p, &svg, &err);
    thr_alloc_fail_at(0);
    if (st) assert_status(st, THR_ENOMEM, &err, "memory");
    if (st) ck_assert_uint_eq(svg.length, 0);
    thr_text_destroy(&svg);
  }
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("space_overview");
  ADD_TEST(s, 20, shells_are_flat_and_others_are_not);
  ADD_EXAMPLES(s, 20, every_piece_is_named, 4);
  ADD_TEST(s, 60, every_failing_allocation_is_reported);
  return run_suite(s);
}
