/* Contract of the linear programming interface, and of the cut tree. */
#include "tests/support.h"
#include "graph/cuttree.h"
#include "lp/lp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits no_limit;

/* min 2x + 3y + 4z, x + y >= 3, y + z >= 2: optimum 8 at x = 1, y = 2; dual (2, 1). */
static thr_lp *tiny(void)
{
  thr_lp *lp;
  const double cost[3] = {2, 3, 4};
  ck_assert_int_eq(thr_lp_create(&lp, 3, cost, NULL, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 2, (const int[]){0, 1}, NULL, 3, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 2, (const int[]){1, 2}, (const double[]){1, 1}, 2, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_rows(lp), 2);
  return lp;
}

static void assert_solution(thr_lp *lp, int n, const double *x, int rows, const double *dual, double objective)
{
  double found[8];
  thr_lp_primal(lp, found);
  for (int j = 0; j < n; j++)
    ck_assert_double_eq_tol(found[j], x[j], 1e-9);
  thr_lp_dual(lp, found);
  for (int i = 0; i < rows; i++)
    ck_assert_double_eq_tol(found[i], dual[i], 1e-9);
  ck_assert_double_eq_tol(thr_lp_objective(lp), objective, 1e-9);
}

static void assert_outcome(thr_lp *lp, bool exact, thr_lp_outcome expected)
{
  thr_lp_outcome outcome;
  thr_err err = {0};
  thr_status st = exact ? thr_lp_solve_exact(lp, &no_limit, &outcome, &err) : thr_lp_solve(lp, &no_limit, &outcome, &err);
  ck_assert_msg(st == THR_OK, "%s", err.text);
  ck_assert_int_eq(outcome, expected);
}

START_TEST(optimum_and_duals_are_known)
{
  thr_lp *lp = tiny();
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){1, 2, 0}, 2, (const double[]){2, 1}, 8);
  assert_outcome(lp, true, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){1, 2, 0}, 2, (const double[]){2, 1}, 8);
  thr_lp_destroy(lp);
}
END_TEST

START_TEST(rows_are_added_and_dropped)
{
  thr_lp *lp = tiny();
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  ck_assert_int_eq(thr_lp_add_row(lp, 1, (const int[]){2}, NULL, 5, NULL), THR_OK); /* z >= 5 */
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){3, 0, 5}, 3, (const double[]){2, 0, 4}, 26);
  ck_assert(thr_lp_row_basic(lp, 1) && !thr_lp_row_basic(lp, 2));
  ck_assert_int_eq(thr_lp_drop_rows(lp, (const bool[]){false, true, false}, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_rows(lp), 2);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){3, 0, 5}, 2, (const double[]){2, 4}, 26);
  ck_assert_int_eq(thr_lp_drop_rows(lp, (const bool[]){false, false}, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_rows(lp), 2);
  thr_lp_destroy(lp);
}
END_TEST

START_TEST(costs_and_upper_bounds_count)
{
  thr_lp *lp;
  ck_assert_int_eq(thr_lp_create(&lp, 3, (const double[]){1, 2, 9}, (const double[]){1, 1.5, 0}, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 3, (const int[]){0, 1, 2}, NULL, 2, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){1, 1, 0}, 1, (const double[]){2}, 3);
  ck_assert_int_eq(thr_lp_set_costs(lp, (const double[]){3, 1, 0}, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){0.5, 1.5, 0}, 1, (const double[]){3}, 3);
  thr_lp_destroy(lp);
}
END_TEST

START_TEST(infeasible_and_unbounded_are_outcomes)
{
  thr_lp *lp;
  ck_assert_int_eq(thr_lp_create(&lp, 1, (const double[]){1}, (const double[]){1}, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 1, (const int[]){0}, NULL, 2, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_INFEASIBLE);
  thr_lp_destroy(lp);
  ck_assert_int_eq(thr_lp_create(&lp, 1, (const double[]){-1}, NULL, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 1, (const int[]){0}, NULL, 2, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_UNBOUNDED);
  thr_lp_destroy(lp);
}
END_TEST

START_TEST(limits_stop_and_solving_goes_on)
{
  volatile sig_atomic_t pressed = 1;
  thr_limits late = {.deadline = thr_clock() - 1}, interrupt = {.interrupted = &pressed};
  thr_lp_outcome outcome;
  thr_lp *lp = tiny();
  ck_assert_int_eq(thr_lp_solve(lp, &late, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_STOPPED);
  ck_assert_int_eq(thr_lp_solve_exact(lp, &interrupt, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_STOPPED);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){1, 2, 0}, 2, (const double[]){2, 1}, 8);
  thr_lp_destroy(lp);
}
END_TEST

/* Column indices that GLPK answers with abort(). */
START_TEST(abort_becomes_a_status)
{
  static const int wrong[][2] = {{-5, 1}, {0, 99}, {1, 1}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_lp_outcome outcome;
    thr_err err = {0}, after = {0};
    thr_lp *lp = tiny(), *bystander = tiny();
    ck_assert_int_eq(thr_lp_add_row(lp, 2, wrong[i], NULL, 1, &err), THR_ESOLVER);
    assert_one_line(&err, "GLPK");
    ck_assert_int_eq(thr_lp_solve(bystander, &no_limit, &outcome, &after), THR_ESOLVER); /* the environment is gone for all */
    ck_assert_int_eq(thr_lp_set_costs(lp, (const double[]){1, 1, 1}, NULL), THR_ESOLVER);
    ck_assert_int_eq(thr_lp_drop_rows(lp, (const bool[]){true, true}, NULL), THR_ESOLVER);
    ck_assert_int_eq(thr_lp_add_row(lp, 1, (const int[]){0}, NULL, 1, NULL), THR_ESOLVER);
    assert_one_line(&after, "lost");
    thr_lp *fresh = tiny();
    assert_outcome(fresh, false, THR_LP_OPTIMAL);
    thr_lp_destroy(lp);
    thr_lp_destroy(bystander);
    assert_outcome(fresh, true, THR_LP_OPTIMAL);
    thr_lp_destroy(fresh);
  }
  thr_lp_destroy(NULL);
}
END_TEST

/* Covering problems: feasibility, and both sides of duality, recomputed. */
START_TEST(random_covers_are_dual_pairs)
{
  enum { N = 12, M = 15 };
  rng r = rng_make((uint64_t)_i + 1);
  double cost[N], x[N], dual[M], load[N] = {0}, primal = 0, sum = 0;
  int row[M][4];
  thr_lp *lp;
  for (int j = 0; j < N; j++)
    cost[j] = rng_between(&r, 1, 9);
  ck_assert_int_eq(thr_lp_create(&lp, N, cost, NULL, NULL), THR_OK);
  for (int i = 0; i < M; i++) {
    for (int k = 0; k < 4; k++)
      row[i][k] = 3 * k + rng_below(&r, 3);
    ck_assert_int_eq(thr_lp_add_row(lp, 4, row[i], NULL, 1, NULL), THR_OK);
    assert_outcome(lp, _i % 2 && i > 10, THR_LP_OPTIMAL);
  }
  thr_lp_primal(lp, x);
  thr_lp_dual(lp, dual);
  for (int i = 0; i < M; i++) {
    double covered = 0;
    for (int k = 0; k < 4; k++)
      covered += x[row[i][k]], load[row[i][k]] += dual[i];
    ck_assert(covered > 1 - 1e-7 && dual[i] > -1e-9);
    sum += dual[i];
  }
  for (int j = 0; j < N; j++) {
    ck_assert(x[j] > -1e-9 && load[j] < cost[j] + 1e-7);
    primal += cost[j] * x[j];
  }
  ck_assert_double_eq_tol(primal, sum, 1e-7);
  ck_assert_double_eq_tol(thr_lp_objective(lp), sum, 1e-7);
  thr_lp_destroy(lp);
}
END_TEST

/* ---- cut tree ---- */

static double cut_value(const thr_frame *f, const double *capacity, uint32_t side)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    if ((side >> f->edge[e][0] ^ side >> f->edge[e][1]) & 1) sum += capacity[e];
  return sum;
}

/* Nodes on the side of tree[i][0] when edge i is taken out. */
static uint32_t side_of(int n, int (*tree)[2], int i)
{
  uint32_t side = UINT32_C(1) << tree[i][0], before = 0;
  while (side != before) {
    before = side;
    for (int k = 0; k < n - 1; k++) {
      uint32_t both = UINT32_C(1) << tree[k][0] | UINT32_C(1) << tree[k][1];
      if (k != i && side & both) side |= both;
    }
  }
  return side;
}

START_TEST(cut_tree_holds_all_minimum_cuts)
{
  rng r = rng_make((uint64_t)_i + 1);
  int n = rng_between(&r, 2, 9), tree[8][2];
  thr_frame f = random_frame(&r, n, rng_below(&r, 14), LENGTHS_EQUAL);
  double capacity[32], flow[8], least[9][9];
  for (int e = 0; e < f.n_edges; e++)
    capacity[e] = _i % 2 ? rng_unit(&r) : rng_below(&r, 4);
  ck_assert_int_eq(thr_cut_tree(n, f.n_edges, (const int(*)[2])f.edge, capacity, tree, flow, NULL), THR_OK);
  for (int i = 0; i < n - 1; i++)
    ck_assert_double_eq_tol(cut_value(&f, capacity, side_of(n, tree, i)), flow[i], 1e-9);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < a; b++) {
      double by_tree = INFINITY;
      least[a][b] = INFINITY;
      for (uint32_t s = 0; s < UINT32_C(1) << n; s++)
        if ((s >> a & 1) && !(s >> b & 1)) least[a][b] = fmin(least[a][b], cut_value(&f, capacity, s));
      for (int i = 0; i < n - 1; i++) {
        uint32_t s = side_of(n, tree, i);
        if ((s >> a ^ s >> b) & 1) by_tree = fmin(by_tree, flow[i]);
      }
      ck_assert_double_eq_tol(by_tree, least[a][b], 1e-9);
    }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cut_tree_of_nonsense_is_a_status)
{
  thr_err err = {0};
  int tree[2][2];
  double flow[2];
  ck_assert_int_eq(thr_cut_tree(3, 1, (const int[1][2]){{0, -1}}, (const double[]){1}, tree, flow, &err), THR_ESOLVER);
  assert_one_line(&err, "igraph");
}
END_TEST

START_TEST(libraries_tell_their_versions)
{
  ck_assert(strchr(thr_glpk_version(), '.') && strchr(thr_igraph_version(), '.'));
}
END_TEST

int main(void)
{
  Suite *s = suite_create("linear programmes and cut tree");
  ADD_TEST(s, 10, optimum_and_duals_are_known);
  ADD_TEST(s, 10, rows_are_added_and_dropped);
  ADD_TEST(s, 10, costs_and_upper_bounds_count);
  ADD_TEST(s, 10, infeasible_and_unbounded_are_outcomes);
  ADD_TEST(s, 10, limits_stop_and_solving_goes_on);
  ADD_TEST(s, 10, abort_becomes_a_status);
  ADD_LOOP(s, 10, random_covers_are_dual_pairs, 0, 40);
  ADD_LOOP(s, 20, cut_tree_holds_all_minimum_cuts, 0, 60);
  ADD_TEST(s, 10, cut_tree_of_nonsense_is_a_status);
  ADD_TEST(s, 10, libraries_tell_their_versions);
  return run_suite(s);
}
