/* Several cords through few edges, by the checker's tables, against all numbers of passes of all cords (tests/truth.h). */
#include "graph/check/few_edges.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/truth.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_CORDS = 4 };

START_TEST(tables_are_true)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 5), rng_below(&r, 3), LENGTHS_EUCLID);
  thr_request o = options_for(ends[_i % 3], 1);
  o.turning.cost = (thr_turn_cost)rng_below(&r, THR_N_TURN_COSTS);
  if (f.n_edges <= TRUTH_TABLE_EDGES) {
    int component[8] = {0};
    thr_few_edges by_length, by_turning;
    truth_table table = truth_table_make(&f, &o, 3);
    ck_assert_int_eq(thr_few_edges_init(&by_length, &f, &o, component, 0, false, NULL), THR_OK);
    ck_assert_int_eq(thr_few_edges_init(&by_turning, &f, &o, component, 0, true, NULL), THR_OK);
    for (int n = 1; n <= MOST_CORDS; n++) {
      double longest, dearest, sum, range, least = INFINITY;
      long double price = truth_price(&table, n, true, -1), all = truth_price(&table, n, false, -1);
      ck_assert_int_eq(thr_few_edges_least(&by_length, n, n, true, &longest, NULL), THR_OK);
      ck_assert_int_eq(thr_few_edges_least(&by_turning, n, n, true, &dearest, NULL), THR_OK);
      ck_assert_int_eq(thr_few_edges_least(&by_turning, n, n, false, &sum, NULL), THR_OK);
      ck_assert_double_eq_tol(longest, truth_longest(&table, n), 1e-9 * longest);
      if (price < INFINITY || dearest < INFINITY) ck_assert_double_eq_tol(dearest, (double)price, 1e-9);
      if (all < INFINITY || sum < INFINITY) ck_assert_double_eq_tol(sum, (double)all, 1e-9);
      for (int k = n; k <= MOST_CORDS; k++)
        least = fmin(least, (double)truth_price(&table, k, false, -1));
      ck_assert_int_eq(thr_few_edges_least(&by_turning, n, MOST_CORDS, false, &range, NULL), THR_OK);
      if (least < INFINITY || range < INFINITY) ck_assert_double_eq_tol(range, least, 1e-9);
    }
    thr_few_edges_destroy(&by_length);
    thr_few_edges_destroy(&by_turning);
    truth_table_destroy(&table);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Pieces one by one, until the sets run out; given ends say how many cords there are. */
START_TEST(bounds_are_of_all_pieces)
{
  thr_frame few = triangles_make(3), many = triangles_make(1), chain = path_make(THR_FEW_EDGES + 2),
            f = side_by_side(&many, &chain);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  double sum, dearest;
  o.cords = o.cords_least = 2;
  ck_assert_int_eq(thr_few_edges_bounds(&few, &o, false, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq_tol(sum, 9, 1e-12);
  ck_assert_double_eq_tol(dearest, 2, 1e-12);
  ck_assert_int_eq(thr_few_edges_bounds(&f, &o, false, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq(sum, 0); /* the chain has too many */
  ck_assert_double_eq_tol(dearest, 2, 1e-12);
  int ends[9] = {2, 0, 2, 2, 0, 0, 0, 0, 2}; /* two cords, one to and fro, one */
  o.ends = THR_ENDS_COUNTS;
  o.end_count = ends;
  ck_assert_int_eq(thr_few_edges_bounds(&few, &o, false, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq(sum, 0); /* single cords have proofs of their own */
  ck_assert_double_eq_tol(dearest, 2, 1e-12);
  thr_frame_destroy(&few);
  thr_frame_destroy(&many);
  thr_frame_destroy(&chain);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("few edges");
  ADD_EXAMPLES(s, 60, tables_are_true, 300);
  ADD_TEST(s, 20, bounds_are_of_all_pieces);
  return run_suite(s);
}
