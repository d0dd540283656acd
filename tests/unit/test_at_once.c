/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords without a search: sound on every framework that they are for, and none on others. */
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>
#include <string.h>

/* How many cords there are; they are what the options ask for. */
static int made(thr_component_cords *make, const thr_frame *f, const thr_request *o)
{
  thr_plan p = {.frame = *f, .options = *o};
  thr_err err = {0};
  assert_ok(thr_components_cords(f, o, NULL, make, &p.cord, &p.n_cords, &err), &err);
  int n = p.n_cords;
  if (n > 0) {
    for (int i = 0; i < n; i++)
      ck_assert(o->max_length == 0 ||
                thr_cord_length(f, &p.cord[i]) <= o->max_length * (1 + 1e-12));
    ck_assert(thr_plan_measure(f, o, p.cord, n, &p.metrics, &err) == THR_OK);
    assert_ok(thr_check_plan(&p, &err), &err);
  }
  thr_cords_destroy(p.cord, n);
  return n;
}

static thr_request asked(thr_joint joint, thr_ends ends, int cords, double max_length)
{
  thr_request o = thr_request_default();
  o.joint = joint;
  o.ends = ends;
  o.cords = max_length > 0 ? 1000 : cords;
  o.cords_least = cords;
  o.max_length = max_length;
  return o;
}

static thr_frame frame_number(int i)
{
  switch (i) {
  case 0: return ring_make(5);
  case 1: return wheel_make(9);
  case 2: return triangles_make(4);
  case 3: return grid_make(5, 4);
  default: return solid_make((solid)(i - 4));
  }
}
enum { N_FRAMES = 9 };

START_TEST(cords_that_tie)
{
  thr_frame f = frame_number(_i);
  int components = _i == 2 ? 4 : 1;
  for (int cover = 1; cover <= 3; cover++)
    for (int cords = 1; cords <= 3; cords++) {
      thr_request closed = asked(THR_JOINT_TUBE, THR_ENDS_CLOSED, cords, 0),
                  open = asked(THR_JOINT_TUBE, THR_ENDS_ANY, cords, 0);
      closed.cover = open.cover = cover;
      ck_assert_int_eq(made(thr_tube_first, &f, &closed), cords * components);
      ck_assert_int_eq(made(thr_tube_first, &f, &open), cords * components);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* Each node can be opened once, so a cord is at most as long as the tour between two nodes. */
START_TEST(tied_cords_of_limited_length)
{
  thr_frame f = solid_make(ICOSAHEDRON);
  thr_request o = asked(THR_JOINT_TUBE, THR_ENDS_ANY, 1, 30);
  int n = made(thr_tube_first, &f, &o);
  ck_assert_int_ge(n, 2);
  o.max_length = 60;
  ck_assert_int_eq(made(thr_tube_first, &f, &o), 1);
  o.max_length = 0.5;
  ck_assert_int_eq(made(thr_tube_first, &f, &o), 0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cords_that_are_not_tied_this_way)
{
  thr_frame star = star_make(3), cube = solid_make(CUBE);
  thr_request o = asked(THR_JOINT_TUBE, THR_ENDS_ANY, 1, 0);
  ck_assert_int_eq(made(thr_tube_first, &star, &o), 0);
  o.capacity = 1;
  ck_assert_int_eq(made(thr_tube_first, &cube, &o), 0);
  o = asked(THR_JOINT_TUBE, THR_ENDS_ANY, 13, 0);
  ck_assert_int_eq(made(thr_tube_first, &cube, &o), 0); /* 8 nodes */
  o = asked(THR_JOINT_TUBE, THR_ENDS_CLOSED, 1, 8);
  ck_assert_int_eq(made(thr_tube_first, &cube, &o), 0);
  thr_frame_destroy(&star);
  thr_frame_destroy(&cube);
}
END_TEST

START_TEST(tours_are_cut)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = frame_number(_i);
  for (int i = 0; i < 3; i++)
    for (int cover = 1; cover <= 2; cover++)
      for (double limit = 1; limit < 100; limit *= 1.7) {
        thr_request o = asked(THR_JOINT_SOLID, ends[i], 1, limit);
        bool reached = thr_cords_reach(&f, &o, NULL) == THR_OK;
        o.cover = cover;
        ck_assert_int_eq(made(thr_cut_tour, &f, &o) > 0, reached);
      }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("at once");
  ADD_LOOP(s, 30, cords_that_tie, 0, N_FRAMES);
  ADD_TEST(s, 30, tied_cords_of_limited_length);
  ADD_TEST(s, 30, cords_that_are_not_tied_this_way);
  ADD_LOOP(s, 30, tours_are_cut, 0, N_FRAMES);
  return run_suite(s);
}
