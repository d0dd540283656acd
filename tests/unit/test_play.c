/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Play of pieces on a cord that is thinner than its bores. */
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/support.h"

static thr_play play_of(const thr_frame *frame)
{
  const thr_physics physics = {.bore = 1.5, .cord_diameter = 1};
  thr_play play;
  ck_assert_int_eq(thr_play_find(frame, &physics, &play, NULL), THR_OK);
  return play;
}

/* A row from its foot; a ring, whose far side is reached from both; two pieces of a framework, each
 * from its own foot. */
START_TEST(it_adds_up_from_the_nearest_foot)
{
  thr_frame row = path_make(7), ring = ring_make(9), both = side_by_side(&row, &ring);
  const thr_play a = play_of(&row), b = play_of(&ring), c = play_of(&both);
  ck_assert(a.gaps == row.n_nodes - 1 && a.piece == row.n_nodes - 1 && a.gap == 0.5 &&
            a.most == 0.5 * a.gaps);
  ck_assert(b.gaps == 4 && b.piece == 4 && b.most == 2);
  ck_assert(c.gaps == a.gaps && c.piece == a.piece);
  thr_frame_destroy(&row);
  thr_frame_destroy(&ring);
  thr_frame_destroy(&both);
}
END_TEST

/* Without feet the lowest nodes are: here all of them. */
START_TEST(what_stands_on_all_its_nodes_has_none)
{
  const double xyz[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const int edge[][2] = {{0, 1}, {1, 2}};
  thr_frame flat = frame_make(3, xyz, 2, edge, NULL, NULL);
  const thr_play play = play_of(&flat);
  ck_assert(play.gaps == 0 && play.piece == 0 && play.most == 0);
  thr_frame_destroy(&flat);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("play");
  ADD_TEST(s, 10, it_adds_up_from_the_nearest_foot);
  ADD_TEST(s, 10, what_stands_on_all_its_nodes_has_none);
  return run_suite(s);
}
