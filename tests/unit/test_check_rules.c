/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rules of the checker about a plan as a whole, and that no claim outlives a failure before it. */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- failures last ---- */

/* What is wrong early is wrong whatever follows, and nothing is found then. */
START_TEST(failures_are_not_forgotten)
{
  static const double length[2] = {1, 2};
  thr_frame f = chain_make(2, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0, passes[2] = {2, 2};
  bool optimal;
  double bound;
  add_loops(cord, &n, 0, 1);
  add_loops(cord, &n, 1, 1);
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 3}, wrong = c;
  wrong.join = 2;
  for (int k = 0; k < 5; k++) {
    thr_request o = options_for(THR_ENDS_CLOSED, k == 1 ? 3 : 1);
    o.cords = o.cords_least = k == 2 ? 1 : k == 3 ? 3 : 2;
    const thr_certificate *proof = k == 4 ? &wrong : &c;
    thr_status expected = k ? THR_EVIOLATED : THR_OK;
    thr_turning_proof tied = {0};
    thr_cords_claim found;
    ck_assert_int_eq(
        thr_check_length_proof(&f, &o, cord, 2, proof, 1, NULL, &optimal, &bound, NULL), expected);
    ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, proof, 1, NULL, &found, NULL), expected);
    ck_assert_int_eq(found.present, k == 0);
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, 2, &tied, &found, NULL),
                     THR_EVIOLATED); /* that proof is empty */
    ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, NULL, 0, NULL, &optimal, &bound, NULL),
                     THR_EVIOLATED);
    if (k != 2 && k != 3)
      ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, proof, 1, &optimal, &bound, NULL),
                       expected);
  }
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* On a chain that is passed there and back, of whichever edge none or too many pairs are. */
START_TEST(every_edge_is_covered_and_has_room)
{
  static const double length[3] = {1, 1, 1};
  thr_frame f = chain_make(3, length);
  thr_request o = options_for(THR_ENDS_CLOSED, 2);
  o.capacity = 3;
  for (int e = -1; e < 3; e++)
    for (int more = -2; more <= 2; more += 4) {
      int passes[3] = {2, 2, 2};
      if (e >= 0) passes[e] += more;
      const thr_certificate c = {.scale = 1, .denominator = 1};
      bool optimal;
      double bound;
      thr_err err = {0};
      thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
      ck_assert_msg(st == (e < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
      char said[96];
      snprintf(said, sizeof said, "edge %d (nodes %d and %d): %s", e, e, e + 1,
               more < 0 ? "0 of 2" : "4 passes, but only 3");
      if (st) assert_one_line(&err, said);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* Both ends of a cord are where ends may be; and a greatest length below 1 is one, too. */
START_TEST(cords_end_where_they_may_and_are_no_longer)
{
  static const double length[2] = {0.25, 0.5};
  thr_frame f = chain_make(2, length);
  int half[2][2] = {{0, 2}, {3, 1}};
  for (int foot = -1; foot < 3; foot += 2)
    for (int back = 0; back < 2; back++) {
      const thr_cord cord = {.id = "A", .n_passes = 2, .half = half[back]};
      thr_request o = options_for(foot < 0 ? THR_ENDS_ANY : THR_ENDS_FEET, 1);
      thr_cords_claim found;
      thr_err err = {0};
      for (int v = 0; v < 3; v++)
        f.foot[v] = v == foot + 1; /* node 2 */
      o.max_length = foot < 0 ? 0.7 : 0.75;
      assert_status(thr_check_cords(&f, &o, &cord, 1, NULL, 0, NULL, &found, &err), THR_EVIOLATED,
                    &err,
                    foot < 0 ? "0.75 long; the plan's options allow 0.7"
                    : back   ? "ends at node 0"
                             : "starts at node 0");
    }
  const thr_cord cord = {.id = "A", .n_passes = 2, .half = half[0]};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_cords_claim found;
  o.max_length = 0.75;
  ck_assert_int_eq(thr_check_cords(&f, &o, &cord, 1, NULL, 0, NULL, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest_bound, 0.75, 1e-9);
  thr_frame_destroy(&f);
}
END_TEST

/* So many odd nodes as there are cord ends in a component, and no more; given ends have the parity
 * of their passes. */
START_TEST(passes_leave_ends_for_the_cords)
{
  thr_frame f = star_make(4); /* the tips are odd, the hub is even */
  int passes[4] = {1, 1, 1, 1}, end_count[5] = {0, 1, 1, 1, 1};
  bool optimal;
  double bound;
  for (int cords = 1; cords <= 3; cords++) {
    thr_request o = options_for(THR_ENDS_ANY, 1);
    thr_certificate c = {.scale = 1, .denominator = 1};
    o.cords = o.cords_least = cords;
    ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL),
                     cords < 2 ? THR_EVIOLATED : THR_OK);
  }
  thr_request o = options_for(THR_ENDS_COUNTS, 1);
  thr_certificate c = {.scale = 1, .denominator = 1};
  o.cords = o.cords_least = 2;
  o.end_count = end_count;
  ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL),
                   THR_OK);
  end_count[1] = 2, end_count[0] = 1;
  ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL),
                   THR_EVIOLATED);
  thr_frame_destroy(&f);
}
END_TEST

/* An edge passed once, and an end where a foot is: the other of its nodes is odd, and no cord ends
 * there. */
START_TEST(every_odd_node_has_an_end)
{
  static const double length[1] = {1};
  static const int passes[1] = {1};
  thr_frame f = chain_make(1, length);
  for (int foot = 0; foot < 2; foot++) {
    thr_request o = options_for(THR_ENDS_FEET, 1);
    const thr_certificate c = {.scale = 1, .denominator = 1};
    bool optimal;
    double bound;
    thr_err err = {0};
    f.foot[foot] = true, f.foot[!foot] = false;
    assert_status(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err),
                  THR_EVIOLATED, &err, foot ? "node 0: 1 passes" : "node 1: 1 passes");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- metrics ---- */

/* Of a straight cord, which turns by nothing: angles are compared with 1, too. */
START_TEST(angles_of_a_straight_cord_may_round)
{
  thr_frame f = path_make(4);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  double *const angle[] = {&p.metrics.turning, &p.metrics.max_turning, &p.metrics.worst_turn};
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  for (int i = 0; i < 3; i++) {
    double kept = *angle[i];
    ck_assert_double_eq(kept, 0);
    *angle[i] = 0.9e-9;
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    *angle[i] = 1.1e-9;
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
    *angle[i] = kept;
  }
  double *const size[] = {&p.metrics.length, &p.metrics.base_length};
  for (int i = 0; i < 2; i++) {
    double kept = *size[i];
    *size[i] = kept * (1 + 0.9e-9);
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    *size[i] = kept * (1 + 1.1e-9);
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
    *size[i] = kept;
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rules of the checker");
  ADD_TEST(s, 10, failures_are_not_forgotten);
  ADD_TEST(s, 10, every_edge_is_covered_and_has_room);
  ADD_TEST(s, 10, cords_end_where_they_may_and_are_no_longer);
  ADD_TEST(s, 10, passes_leave_ends_for_the_cords);
  ADD_TEST(s, 10, every_odd_node_has_an_end);
  ADD_TEST(s, 10, angles_of_a_straight_cord_may_round);
  return run_suite(s);
}
