/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contract of the linear programming interface, and of the cut tree. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "lp/solver/solver.h"
#include "tests/frameworks.h"
#include "tests/support.h"

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
  ck_assert_int_eq(thr_lp_add_row(lp, 2, (const int[]){1, 2}, (const double[]){1, 1}, 2, NULL),
                   THR_OK);
  ck_assert_int_eq(thr_lp_rows(lp), 2);
  return lp;
}

static void assert_solution(thr_lp *lp, int n, const double *x, int rows, const double *dual,
                            double objective)
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
  thr_status st = exact ? thr_lp_solve_exact(lp, &no_limit, &outcome, &err)
                        : thr_lp_solve(lp, &no_limit, &outcome, &err);
  assert_ok(st, &err);
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
  ck_assert_int_eq(
      thr_lp_create(&lp, 3, (const double[]){1, 2, 9}, (const double[]){1, 1.5, 0}, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_add_row(lp, 3, (const int[]){0, 1, 2}, NULL, 2, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){1, 1, 0}, 1, (const double[]){2}, 3);
  ck_assert_int_eq(thr_lp_set_costs(lp, (const double[]){3, 1, 0}, NULL), THR_OK);
  assert_outcome(lp, false, THR_LP_OPTIMAL);
  assert_solution(lp, 3, (const double[]){0.5, 1.5, 0}, 1, (const double[]){3}, 3);
  thr_lp_destroy(lp);
}
END_TEST

/* A feasible basis, one that is not, a singular one and one of the wrong size: all lead to the
 * optimum. */
START_TEST(any_basis_may_be_set)
{
  static const bool row[4][2] = {{false, false}, {true, true}, {false, false}, {false, false}};
  static const bool column[4][3] = {
      {true, false, true}, {false, false, false}, {true, true, true}, {true, false, false}};
  for (int i = 0; i < 4; i++) {
    thr_lp *lp = tiny();
    if (i == 2)
      ck_assert_int_eq(thr_lp_add_row(lp, 2, (const int[]){0, 1}, NULL, 3, NULL),
                       THR_OK); /* row 0 again */
    const bool rows[3] = {row[i][0], row[i][1], false};
    ck_assert_int_eq(thr_lp_set_basis(lp, rows, column[i], NULL), THR_OK);
    assert_outcome(lp, false, THR_LP_OPTIMAL);
    ck_assert_double_eq_tol(thr_lp_objective(lp), 8, 1e-9);
    ck_assert(thr_lp_column_basic(lp, 0) && thr_lp_column_basic(lp, 1) &&
              !thr_lp_column_basic(lp, 2));
    thr_lp_destroy(lp);
  }
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

/* Fewest nodes that cover disjoint triangles, two of each, by a tree that grows with the number of
 * triangles: within so much work. Returns what is left of it. */
static double cover_triangles(int n, double work, thr_lp_outcome *outcome)
{
  double one[30] = {0};
  thr_lp *lp;
  thr_limits limits = {.work = &work};
  for (int j = 0; j < 3 * n; j++)
    one[j] = 1;
  ck_assert_int_eq(thr_lp_create(&lp, 3 * n, one, one, NULL), THR_OK);
  for (int j = 0; j < 3 * n; j++) {
    int next = j % 3 == 2 ? j - 2 : j + 1;
    ck_assert_int_eq(thr_lp_add_row(lp, 2, (const int[]){j, next}, NULL, 1, NULL), THR_OK);
  }
  ck_assert_int_eq(thr_lp_solve(lp, &limits, outcome, NULL), THR_OK);
  if (*outcome == THR_LP_OPTIMAL) {
    ck_assert_double_eq_tol(thr_lp_objective(lp), 1.5 * n, 1e-9);
    ck_assert_int_eq(thr_lp_solve_integer(lp, &limits, outcome, NULL), THR_OK);
  }
  if (*outcome == THR_LP_OPTIMAL) ck_assert_double_eq_tol(thr_lp_objective(lp), 2 * n, 1e-9);
  thr_lp_destroy(lp);
  return work;
}

/* Limited by work, not by time, a search ends at the same place in every run: with too little as
 * with enough. */
START_TEST(work_stops_at_the_same_place)
{
  const double enough = 1e3, spent = enough - cover_triangles(6, enough, &(thr_lp_outcome){0});
  ck_assert_double_gt(spent, 0);
  for (int tenths = 0; tenths <= 15; tenths++) {
    thr_lp_outcome one, other;
    double left = cover_triangles(6, spent * tenths / 10, &one);
    ck_assert(cover_triangles(6, spent * tenths / 10, &other) == left);
    ck_assert_int_eq(one, tenths > 10 ? THR_LP_OPTIMAL : tenths < 10 ? THR_LP_STOPPED : one);
    ck_assert_int_eq(other, one);
  }
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
    assert_status(thr_lp_add_row(lp, 2, wrong[i], NULL, 1, &err), THR_ESOLVER, &err, "GLPK");
    ck_assert_int_eq(thr_lp_solve(bystander, &no_limit, &outcome, &after),
                     THR_ESOLVER); /* the environment is gone for all */
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

/* ---- equations ---- */

/* x + y = 4, y + z + w = 3, z - w = 1 and w of any sign: z = 1 + w, y = 2 - 2w, x = 2 + 2w. The
 * cost x + 2y + 3z + 4w = 9 + 5w falls to w = -1, where x and z are 0. */
START_TEST(equations_with_a_free_column)
{
  static const double rhs[] = {4, 3, 1}, cost[] = {1, 2, 3, 4}, value[] = {1, 1, 1, 1, 1, 1, -1},
                      x[] = {0, 4, 0, -1};
  static const int start[] = {0, 1, 3, 5, 7}, row[] = {0, 0, 1, 1, 2, 1, 2};
  thr_lp *lp;
  thr_err err = {0};
  assert_ok(thr_lp_create_equations(&lp, 3, rhs, 4, cost, (const bool[]){false, false, false, true},
                                    start, row, value, &err),
            &err);
  ck_assert_int_eq(thr_lp_rows(lp), 3);
  for (int exact = 0; exact < 2; exact++) {
    double dual[3], sum = 0;
    assert_outcome(lp, exact, THR_LP_OPTIMAL);
    assert_solution(lp, 4, x, 0, NULL, 4);
    thr_lp_dual(lp, dual);
    for (int j = 0; j < 4; j++) {
      double reduced = cost[j];
      for (int k = start[j]; k < start[j + 1]; k++)
        reduced -= value[k] * dual[row[k]];
      ck_assert(j < 3 ? reduced > -1e-9 : fabs(reduced) < 1e-9);
    }
    for (int i = 0; i < 3; i++)
      sum += rhs[i] * dual[i];
    ck_assert_double_eq_tol(sum, 4, 1e-9);
  }
  thr_lp_destroy(lp);
}
END_TEST

START_TEST(equations_without_a_solution)
{
  thr_lp *lp;
  const double rhs[] = {1, 2}, cost[] = {1}, value[] = {1, 1};
  ck_assert_int_eq(thr_lp_create_equations(&lp, 2, rhs, 1, cost, NULL, (const int[]){0, 2},
                                           (const int[]){0, 1}, value, NULL),
                   THR_OK);
  assert_outcome(lp, false, THR_LP_INFEASIBLE);
  thr_lp_destroy(lp);
  thr_err err = {0}; /* one row twice in a column */
  assert_status(thr_lp_create_equations(&lp, 2, rhs, 1, cost, NULL, (const int[]){0, 2},
                                        (const int[]){1, 1}, value, &err),
                THR_ESOLVER, &err, "GLPK");
  ck_assert(lp == NULL);
}
END_TEST

/* ---- interior point ---- */

typedef struct {
  int m, n, start[401], row[1600];
  double rhs[64], cost[400], value[1600], x[400], dual[64];
} programme;

static thr_interior interior(programme *p, const thr_limits *limits)
{
  const thr_equations e = {
      .a = {p->m, p->n, p->start, p->row, p->value}, .rhs = p->rhs, .cost = p->cost};
  thr_interior found = {.x = p->x, .dual = p->dual};
  thr_err err = {0};
  assert_ok(thr_interior_solve(&e, limits, &found, &err), &err);
  return found;
}

/* Residuals and gap in sums of our own; returns the objective. */
static double assert_optimal(const programme *p)
{
  double left[64], primal = 0, dual = 0;
  memcpy(left, p->rhs, sizeof left);
  for (int j = 0; j < p->n; j++) {
    double reduced = p->cost[j];
    for (int k = p->start[j]; k < p->start[j + 1]; k++) {
      left[p->row[k]] -= p->value[k] * p->x[j];
      reduced -= p->value[k] * p->dual[p->row[k]];
    }
    primal += p->cost[j] * p->x[j];
    ck_assert(p->x[j] >= 0 && reduced > -1e-6);
  }
  for (int i = 0; i < p->m; i++) {
    ck_assert_double_eq_tol(left[i], 0, 1e-6);
    dual += p->rhs[i] * p->dual[i];
  }
  ck_assert_double_eq_tol(primal, dual, 1e-6 * (1 + fabs(primal)));
  return primal;
}

/* A D A^T of a programme's columns, dense. */
static void weigh(const programme *p, const double *weight, double out[64][64])
{
  memset(out, 0, 64 * sizeof *out);
  for (int j = 0; j < p->n; j++)
    for (int k = p->start[j]; k < p->start[j + 1]; k++)
      for (int l = p->start[j]; l < p->start[j + 1]; l++)
        out[p->row[k]][p->row[l]] += weight[j] * p->value[k] * p->value[l];
}

/* Columns of one to four rows, in any order of rows, which thin out towards the last. */
static void draw_columns(programme *p, rng *r)
{
  p->m = rng_between(r, 1, 40);
  p->n = rng_between(r, p->m / 2 + 1, 150);
  for (int j = 0; j < p->n; j++) {
    int count = rng_between(r, 1, p->m < 4 ? p->m : 4), taken = 0;
    for (int first = p->start[j]; taken < count;) {
      int row = rng_below(r, 1 + rng_below(r, p->m)), k = first;
      while (k < first + taken && p->row[k] != row)
        k++;
      if (k < first + taken) row = rng_below(r, p->m);
      for (k = first; k < first + taken && p->row[k] != row;)
        k++;
      if (k < first + taken) continue;
      p->row[first + taken] = row;
      p->value[first + taken++] = rng_unit(r) + 0.1;
    }
    p->start[j + 1] = p->start[j] + count;
  }
}

/* Right sides of which a solution is known are met, with this error of the largest. */
static void assert_solves(thr_normal *normal, int m, double dense[64][64], const double *weight,
                          rng *r, double error)
{
  double wanted[64], right[64] = {0}, found[64], most = 0;
  for (int i = 0; i < m; i++)
    wanted[i] = 2 * rng_unit(r) - 1;
  for (int i = 0; i < m; i++)
    for (int k = 0; k < m; k++)
      right[i] += dense[i][k] * wanted[k];
  thr_normal_factor(normal, weight);
  thr_normal_solve(normal, right, found);
  for (int i = 0; i < m; i++)
    most = fmax(most, fabs(right[i]));
  for (int i = 0; i < m; i++) {
    double left = right[i];
    for (int k = 0; k < m; k++)
      left -= dense[i][k] * found[k];
    ck_assert_double_eq_tol(left, 0, error * most);
  }
}

/* Against the dense matrix, factored with other values and with weights of several sizes; what is
 * asked for has a solution, though rows may depend on each other. */
START_TEST(normal_equations_are_solved)
{
  rng r = rng_make((uint64_t)_i + 500);
  programme p = {0};
  draw_columns(&p, &r);
  thr_columns a = {p.m, p.n, p.start, p.row, p.value};
  for (int round = 0; round < 3; round++) {
    double weight[400], dense[64][64];
    thr_normal *normal;
    for (int k = 0; k < p.start[p.n] && round > 0; k++)
      p.value[k] = rng_unit(&r) + 0.1;
    ck_assert_int_eq(thr_normal_create(&normal, &a, 0, NULL), THR_OK);
    for (int j = 0; j < p.n; j++)
      weight[j] = (0.1 + rng_unit(&r)) * pow(1e12, round - 1);
    weigh(&p, weight, dense);
    assert_solves(normal, p.m, dense, weight, &r, 1e-9);
    thr_normal_destroy(normal);
  }
}
END_TEST

/* Rows that depend on others have no part in the solution. What follows in the arrays is no column.
 */
START_TEST(equal_rows_are_solved_once)
{
  static const int start[] = {0, 2, 5, 6, 8}, row[] = {0, 2, 2, 1, 0, 1, 0, 1};
  static const double value[] = {1, 1, 2, 3, 2, 5, 100, 100}, weight[] = {1, 0.5, 2, 9},
                      right[] = {3, 7, 3};
  thr_columns a = {3, 3, start, row, value};
  thr_normal *normal;
  double y[4] = {0, 0, 0, 77}, z[4] = {0, 0, 0, 77}, back[4] = {0, 0, 0, 77};
  ck_assert_int_eq(thr_normal_create(&normal, &a, 0, NULL), THR_OK);
  thr_normal_factor(normal, weight);
  thr_normal_solve(normal, right, y);
  ck_assert((y[0] == 0) != (y[2] == 0));
  thr_bundles_transposed(thr_normal_bundles(normal), y, z);
  ck_assert(z[3] == 77);
  for (int j = 0; j < 3; j++)
    z[j] *= weight[j];
  thr_bundles_times(thr_normal_bundles(normal), z, back);
  for (int i = 0; i < 3; i++)
    ck_assert_double_eq_tol(back[i], right[i], 1e-12);
  ck_assert(y[3] == 77 && back[3] == 77);
  thr_normal_destroy(normal);
  thr_normal_destroy(NULL);
}
END_TEST

/* Columns three by three, with weights that are positive definite blocks: the dense matrix of the
 * same, by definition. */
START_TEST(columns_are_weighed_three_by_three)
{
  rng r = rng_make((uint64_t)_i + 900);
  programme p = {.m = rng_between(&r, 8, 40)};
  const int threes = rng_between(&r, 1, 20), rest = rng_between(&r, 0, 20);
  p.n = 3 * threes + rest;
  double block[100][3][3] = {{{0}}}, weight[200], dense[64][64] = {{0}};
  for (int j = 0, high = 1; j < p.n; j++) { /* often the rows of the one before */
    const bool alike = j > 0 && (j % 3 > 0 || rng_below(&r, 2));
    if (!alike) high = rng_between(&r, 1, 8);
    for (int k = 0, first = rng_below(&r, p.m); k < high; k++) {
      p.row[p.start[j] + k] = alike ? p.row[p.start[j - 1] + k] : (first + k) % p.m;
      p.value[p.start[j] + k] = 2 * rng_unit(&r) - 1;
    }
    p.start[j + 1] = p.start[j] + high;
  }
  for (int t = 0; t < threes; t++) {
    double root[3][3], *w = weight + 6 * t;
    for (int k = 0; k < 9; k++)
      root[k / 3][k % 3] = (k % 4 == 0) + 0.5 * rng_unit(&r);
    for (int k = 0; k < 27; k++)
      block[t][k / 9][k / 3 % 3] += root[k / 9][k % 3] * root[k / 3 % 3][k % 3];
    for (int k = 0, at = 0; k < 3; k++)
      for (int l = k; l < 3; l++)
        w[at++] = block[t][k][l];
  }
  for (int j = 0; j < rest; j++)
    weight[6 * threes + j] = 0.1 + rng_unit(&r);
  for (int j = 0; j < p.n; j++)
    for (int l = j / 3 < threes ? j / 3 * 3 : j; l < (j / 3 < threes ? j / 3 * 3 + 3 : j + 1); l++)
      for (int k = p.start[j]; k < p.start[j + 1]; k++)
        for (int q = p.start[l]; q < p.start[l + 1]; q++)
          dense[p.row[k]][p.row[q]] +=
              p.value[k] * p.value[q] *
              (j / 3 < threes ? block[j / 3][j % 3][l % 3] : weight[3 * threes + j]);
  const thr_columns a = {p.m, p.n, p.start, p.row, p.value};
  thr_normal *normal;
  ck_assert_int_eq(thr_normal_create(&normal, &a, threes, NULL), THR_OK);
  assert_solves(normal, p.m, dense, weight, &r, 1e-8);
  thr_normal_destroy(normal);
}
END_TEST

/* Every length and number of columns, beside sums as they are written down. */
START_TEST(dense_sums_are_right)
{
  enum { MOST = 29, APART = 31, MOST_K = 6 };
  rng r = rng_make(7);
  double from[APART * MOST_K + MOST], to[THR_DENSE_MOST * MOST], with[APART],
      factor[THR_DENSE_MOST];
  for (size_t i = 0; i < sizeof from / sizeof *from; i++)
    from[i] = 2 * rng_unit(&r) - 1;
  for (int i = 0; i < APART; i++)
    with[i] = rng_unit(&r);
  for (int n = 0; n <= MOST; n++)
    for (int n_q = 1; n_q <= THR_DENSE_MOST; n_q++) {
      thr_dense_product(to, from, from, APART, MOST_K, (size_t)n, n_q);
      thr_dense_sums(factor, from, APART, with, n_q, (size_t)n);
      for (int q = 0; q < n_q; q++) {
        double all = 0;
        for (int i = 0; i < n; i++) {
          double sum = 0;
          for (int k = 0; k < MOST_K; k++)
            sum += from[k * APART + i] * from[k * APART + q];
          ck_assert_double_eq_tol(to[q * n + i], sum, 1e-14);
          all += from[q * APART + i] * with[i];
        }
        ck_assert_double_eq_tol(factor[q], all, 1e-13);
      }
      double left[MOST + 1];
      for (int i = 0; i <= MOST; i++)
        left[i] = i;
      thr_dense_take(left, from, APART, with, n_q, (size_t)n);
      for (int i = 0; i <= MOST; i++) {
        double wanted = i;
        for (int q = 0; q < n_q && i < n; q++)
          wanted -= from[q * APART + i] * with[q];
        ck_assert_double_eq_tol(left[i], wanted, 1e-13);
      }
    }
}
END_TEST

enum {
  MOST_STEPS = 15
}; /* that small programmes like these take: a good start and good corrections take 5 to 10 */

/* Made from a solution: x and reduced costs of which one of each pair is 0. */
START_TEST(interior_finds_the_optimum_it_was_made_from)
{
  rng r = rng_make((uint64_t)_i + 1);
  programme p = {.m = rng_between(&r, 3, 30), .n = 100};
  double wanted = 0, dual[64];
  for (int i = 0; i < p.m; i++)
    dual[i] = 2 * rng_unit(&r) - 1;
  for (int j = 0; j < p.n; j++) {
    p.start[j + 1] = 2 * (j + 1);
    p.row[2 * j] = rng_below(&r, p.m);
    p.row[2 * j + 1] = (p.row[2 * j] + 1 + rng_below(&r, p.m - 1)) % p.m;
    double x = rng_below(&r, 3) ? 0 : 3 * rng_unit(&r), reduced = x > 0 ? 0 : rng_unit(&r);
    p.cost[j] = reduced;
    for (int k = 2 * j; k < 2 * j + 2; k++) {
      p.value[k] = 2 * rng_unit(&r) - 1;
      p.rhs[p.row[k]] += p.value[k] * x;
      p.cost[j] += p.value[k] * dual[p.row[k]];
    }
    wanted += p.cost[j] * x;
  }
  thr_interior found = interior(&p, &no_limit);
  ck_assert_msg(found.outcome == THR_LP_OPTIMAL && found.error < 1e-8, "error %g after %d",
                found.error, found.iterations);
  ck_assert_int_le(found.iterations, MOST_STEPS);
  ck_assert_double_eq_tol(assert_optimal(&p), wanted, 1e-6 * (1 + fabs(wanted)));
}
END_TEST

/* Cones of which each has its own directions: the same optimum as with a column for every ray,
 * which another solver is asked. And again from where it was on its way, with other costs. */
START_TEST(cones_stand_for_their_rays)
{
  enum { CONES = 12, RAYS = 5, REST = 8, ROWS = 10, N = CONES * RAYS + REST };
  static const double ray[2 * RAYS][3] = {{1, 0.5, 0},   {1, -0.5, 0},  {1, 0, 0.5},  {1, 0, -0.5},
                                          {1, 0.1, 0.1}, {1, 0.2, 0.1}, {1, -0.2, 0}, {1, 0, 0.3},
                                          {1, 0, -0.1},  {1, 0, 0}};
  rng r = rng_make((uint64_t)_i + 77);
  int start[3 * CONES + REST + 1] = {0}, row[(3 * CONES + REST) * ROWS], kind[CONES];
  int wide_start[N + 1] = {0}, wide_row[N * ROWS];
  double value[(3 * CONES + REST) * ROWS], wide[N * ROWS], cost[N], rhs[ROWS] = {0}, x[N],
                                                                    dual[ROWS];
  for (int j = 0; j < 3 * CONES + REST; j++) {
    start[j + 1] = (j + 1) * ROWS;
    for (int i = 0; i < ROWS; i++) {
      row[j * ROWS + i] = i;
      value[j * ROWS + i] = 2 * rng_unit(&r) - 1;
    }
  }
  for (int c = 0; c < CONES; c++)
    kind[c] = rng_below(&r, 2);
  for (int j = 0; j < N; j++) {
    wide_start[j + 1] = (j + 1) * ROWS;
    const int c = j / RAYS, plain = 3 * CONES + j - CONES * RAYS;
    for (int i = 0; i < ROWS; i++) {
      wide_row[j * ROWS + i] = i;
      wide[j * ROWS + i] = c < CONES ? 0 : value[plain * ROWS + i];
      for (int k = 0; k < 3 && c < CONES; k++)
        wide[j * ROWS + i] += ray[kind[c] * RAYS + j % RAYS][k] * value[(3 * c + k) * ROWS + i];
      if (rng_below(&r, 4) == 0) rhs[i] += wide[j * ROWS + i];
    }
    cost[j] = 1 + rng_unit(&r);
  }
  thr_warm warm = {0};
  for (int round = 0; round < 2; round++) {
    const thr_equations e = {.a = {ROWS, 3 * CONES + REST, start, row, value},
                             .rhs = rhs,
                             .cost = cost,
                             .warm = &warm,
                             .n_cones = CONES,
                             .n_rays = RAYS,
                             .kind = kind,
                             .ray = ray};
    thr_interior found = {.x = x, .dual = dual};
    thr_lp *lp;
    thr_err err = {0};
    double primal = 0;
    ck_assert_int_eq(thr_interior_solve(&e, &no_limit, &found, &err), THR_OK);
    ck_assert_int_eq(found.outcome, THR_LP_OPTIMAL);
    ck_assert_int_eq(
        thr_lp_create_equations(&lp, ROWS, rhs, N, cost, NULL, wide_start, wide_row, wide, &err),
        THR_OK);
    assert_outcome(lp, false, THR_LP_OPTIMAL);
    for (int j = 0; j < N; j++)
      primal += cost[j] * x[j];
    ck_assert_double_eq_tol(primal, thr_lp_objective(lp), 1e-6 * primal);
    thr_lp_destroy(lp);
    for (int j = 0; j < N; j++)
      cost[j] += 0.05 * rng_unit(&r);
  }
  ck_assert_int_eq(warm.n, N);
  thr_warm_destroy(&warm);
}
END_TEST

/* A pair that is complementary in a cone: one of them within it and the other 0, or both on its
 * boundary. */
static void complementary(rng *r, double x[3], double z[3])
{
  const double angle = 6.28 * rng_unit(r), size = 0.5 + rng_unit(r), other = 0.5 + rng_unit(r);
  const int kind = rng_below(r, 3);
  const double boundary[3] = {1, cos(angle), sin(angle)};
  for (int k = 0; k < 3; k++) {
    const double mirrored = k > 0 ? -boundary[k] : 1, within = k > 0 ? 0.7 * boundary[k] : 1;
    x[k] = kind == 0 ? size * boundary[k] : kind == 1 ? size * within : 0;
    z[k] = kind == 0 ? other * mirrored : kind == 1 ? 0 : other * within;
  }
}

/* Made round a point and multipliers that prove each other optimal: x and z complementary, b = A x,
 * c = A^T y + z. */
START_TEST(cones_find_a_planted_optimum)
{
  enum { CONES = 9, REST = 6, ROWS = 8, N = 3 * CONES + REST };
  rng r = rng_make((uint64_t)_i + 5);
  int start[N + 1] = {0}, row[N * ROWS];
  double value[N * ROWS], x[N], z[N], y[ROWS], cost[N], rhs[ROWS] = {0}, begin[N] = {0}, found_x[N],
                                                        dual[ROWS];
  for (int c = 0; c < CONES; c++) {
    complementary(&r, x + 3 * c, z + 3 * c);
    begin[3 * c] = 1;
  }
  for (int j = 3 * CONES; j < N; j++) {
    x[j] = j % 2 ? 0 : 1 + rng_unit(&r);
    z[j] = j % 2 ? 1 + rng_unit(&r) : 0;
    begin[j] = 1;
  }
  for (int i = 0; i < ROWS; i++)
    y[i] = 2 * rng_unit(&r) - 1;
  for (int j = 0; j < N; j++) {
    start[j + 1] = (j + 1) * ROWS;
    cost[j] = z[j];
    for (int i = 0; i < ROWS; i++) {
      row[j * ROWS + i] = i;
      value[j * ROWS + i] = 2 * rng_unit(&r) - 1;
      rhs[i] += value[j * ROWS + i] * x[j];
      cost[j] += value[j * ROWS + i] * y[i];
    }
  }
  const thr_cone_equations e = {.a = {ROWS, N, start, row, value},
                                .rhs = rhs,
                                .cost = cost,
                                .start = begin,
                                .goal = 1e-7,
                                .met = 1e-7,
                                .n_cones = CONES};
  thr_interior found = {.x = found_x, .dual = dual};
  double wanted = 0, primal = 0, proved = 0;
  ck_assert_int_eq(thr_cones_solve(&e, &no_limit, &found, NULL), THR_OK);
  ck_assert_int_eq(found.outcome, THR_LP_OPTIMAL);
  for (int j = 0; j < N; j++) {
    wanted += cost[j] * x[j];
    primal += cost[j] * found_x[j];
    ck_assert(j >= 3 * CONES ? found_x[j] > 0
                             : j % 3 || found_x[j] > hypot(found_x[j + 1], found_x[j + 2]));
  }
  for (int i = 0; i < ROWS; i++)
    proved += rhs[i] * dual[i];
  ck_assert_double_eq_tol(primal, wanted, 1e-5 * (1 + fabs(wanted)));
  ck_assert_double_eq_tol(proved, wanted, 1e-5 * (1 + fabs(wanted)));
}
END_TEST

/* A unit of flow through layers of nodes, all equations, of which one depends on the others: the
 * shortest way, layer by layer. */
START_TEST(interior_finds_the_shortest_way)
{
  enum { LAYERS = 12, WIDTH = 5 };
  rng r = rng_make((uint64_t)_i + 1);
  programme p = {.m = LAYERS * WIDTH};
  double way[LAYERS * WIDTH];
  for (int v = 0; v < p.m; v++)
    way[v] = v == 0 ? 0 : INFINITY;
  for (int a = 0; a + WIDTH < p.m; a++)
    for (int b = (a / WIDTH + 1) * WIDTH; b < (a / WIDTH + 2) * WIDTH; b++, p.n++) {
      p.cost[p.n] = rng_unit(&r);
      p.start[p.n + 1] = p.start[p.n] + 2;
      p.row[2 * p.n] = a;
      p.row[2 * p.n + 1] = b;
      p.value[2 * p.n] = 1;
      p.value[2 * p.n + 1] = -1;
      way[b] = fmin(way[b], way[a] + p.cost[p.n]);
    }
  p.rhs[0] = 1;
  p.rhs[p.m - 1] = -1;
  thr_interior found = interior(&p, &no_limit);
  ck_assert_msg(found.outcome == THR_LP_OPTIMAL && found.error < 1e-8, "error %g after %d",
                found.error, found.iterations);
  ck_assert_int_le(found.iterations, MOST_STEPS);
  ck_assert_double_eq_tol(assert_optimal(&p), way[p.m - 1], 1e-6);
}
END_TEST

START_TEST(interior_gives_up_and_stops)
{
  programme none = {
      .m = 2, .n = 1, .start = {0, 2}, .row = {0, 1}, .value = {1, 1}, .rhs = {1, 2}, .cost = {1}};
  ck_assert_int_eq(interior(&none, &no_limit).outcome, THR_LP_UNDECIDED);
  programme unbounded = {.m = 1,
                         .n = 2,
                         .start = {0, 1, 2},
                         .row = {0, 0},
                         .value = {1, -1},
                         .rhs = {1},
                         .cost = {-2, 1}};
  ck_assert_int_eq(interior(&unbounded, &no_limit).outcome, THR_LP_UNDECIDED);
  volatile sig_atomic_t pressed = 1;
  thr_limits interrupt = {.interrupted = &pressed};
  programme easy = {.m = 1,
                    .n = 2,
                    .start = {0, 1, 2},
                    .row = {0, 0},
                    .value = {1, 1},
                    .rhs = {1},
                    .cost = {2, 1}};
  ck_assert_int_eq(interior(&easy, &interrupt).outcome, THR_LP_STOPPED);
  ck_assert_int_eq(interior(&easy, &no_limit).outcome, THR_LP_OPTIMAL);
  ck_assert_double_eq_tol(assert_optimal(&easy), 1, 1e-7);
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
  ck_assert_int_eq(thr_cut_tree(n, f.n_edges, (const int(*)[2])f.edge, capacity, tree, flow, NULL),
                   THR_OK);
  for (int i = 0; i < n - 1; i++)
    ck_assert_double_eq_tol(cut_value(&f, capacity, side_of(n, tree, i)), flow[i], 1e-9);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < a; b++) {
      double by_tree = INFINITY;
      least[a][b] = INFINITY;
      for (uint32_t s = 0; s < UINT32_C(1) << n; s++)
        if ((s >> a & 1) && !(s >> b & 1))
          least[a][b] = fmin(least[a][b], cut_value(&f, capacity, s));
      for (int i = 0; i < n - 1; i++) {
        uint32_t s = side_of(n, tree, i);
        if ((s >> a ^ s >> b) & 1) by_tree = fmin(by_tree, flow[i]);
      }
      ck_assert_double_eq_tol(by_tree, least[a][b], 1e-9);
    }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(maximum_flow_is_as_large_as_its_cut)
{
  rng r = rng_make((uint64_t)_i + 1);
  int n = rng_between(&r, 2, 9), source = rng_below(&r, n), sink = (source + 1) % n;
  thr_frame f = random_frame(&r, n, rng_below(&r, 14), LENGTHS_EQUAL);
  double capacity[32], flow[32], out[9] = {0};
  bool side[9];
  for (int e = 0; e < f.n_edges; e++)
    capacity[e] = _i % 2 ? rng_unit(&r) : rng_below(&r, 4);
  ck_assert_int_eq(thr_maximum_flow(n, f.n_edges, (const int(*)[2])f.edge, capacity, source, sink,
                                    flow, side, NULL),
                   THR_OK);

  /* What flows is within the capacities, and leaves only the source. */
  for (int e = 0; e < f.n_edges; e++) {
    ck_assert_double_le(fabs(flow[e]), capacity[e] + 1e-9);
    out[f.edge[e][0]] += flow[e];
    out[f.edge[e][1]] -= flow[e];
  }
  for (int v = 0; v < n; v++)
    if (v != source && v != sink) ck_assert_double_eq_tol(out[v], 0, 1e-9);

  /* The sides are a cut of the same capacity. */
  uint32_t cut = 0;
  for (int v = 0; v < n; v++)
    cut |= (uint32_t)side[v] << v;
  ck_assert(side[source] && !side[sink]);
  ck_assert_double_eq_tol(out[source], cut_value(&f, capacity, cut), 1e-9);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cut_tree_of_nonsense_is_a_status)
{
  thr_err err = {0};
  int tree[2][2];
  double flow[2];
  assert_status(
      thr_cut_tree(3, 1, (const int[1][2]){{0, -1}}, (const double[]){1}, tree, flow, &err),
      THR_ESOLVER, &err, "igraph");
}
END_TEST

START_TEST(libraries_tell_their_versions)
{
  ck_assert(strchr(thr_glpk_version(), '.') && strchr(thr_igraph_version(), '.'));
}
END_TEST

/* Twice the sum of 41 zeros and ones is to be 41: branch and bound has to try nearly all (R.
 * Jeroslow, "Trivial integer programs unsolvable by branch-and-bound", Math. Programming 6, 1974).
 */
START_TEST(branch_and_bound_ends_in_time)
{
  enum { N = 41 };
  int start[N + 1], row[N];
  double cost[N] = {0}, two[N], odd = N;
  thr_lp *lp;
  thr_lp_outcome outcome;
  for (int j = 0; j < N; j++)
    start[j] = j, row[j] = 0, two[j] = 2;
  start[N] = N;
  ck_assert_int_eq(thr_lp_create_equations(&lp, 1, &odd, N, cost, NULL, start, row, two, NULL),
                   THR_OK);
  for (int j = 0; j < N; j++)
    ck_assert_int_eq(thr_lp_set_bounds(lp, j, 0, 1, NULL), THR_OK);
  const double begun = thr_clock();
  const thr_limits limits = {.deadline = begun + 0.3};
  ck_assert_int_eq(thr_lp_solve(lp, &limits, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_OPTIMAL);
  ck_assert_int_eq(thr_lp_solve_integer(lp, &limits, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_STOPPED);
  ck_assert_double_lt(thr_clock() - begun, 5); /* seconds on a busy machine, not years */
  thr_lp_destroy(lp);
}
END_TEST

/* The same numbers from a child, which keeps limits, as without limits: least x + 1.5 y with 2 x +
 * 3 y at least 7, in whole numbers. */
START_TEST(branch_and_bound_in_a_child_is_the_same)
{
  const double cost[2] = {1, 1.5}, value[2] = {2, 3};
  const int column[2] = {0, 1};
  for (int limited = 0; limited < 2; limited++) {
    const thr_limits limits = {.deadline = limited ? thr_clock() + 100 : 0};
    thr_lp *lp;
    thr_lp_outcome outcome;
    double x[2];
    ck_assert_int_eq(thr_lp_create(&lp, 2, cost, NULL, NULL), THR_OK);
    ck_assert_int_eq(thr_lp_add_row(lp, 2, column, value, 7, NULL), THR_OK);
    ck_assert_int_eq(thr_lp_solve(lp, &limits, &outcome, NULL), THR_OK);
    ck_assert_double_eq_tol(thr_lp_objective(lp), 3.5, 1e-9);
    ck_assert_int_eq(thr_lp_solve_integer(lp, &limits, &outcome, NULL), THR_OK);
    ck_assert_int_eq(outcome, THR_LP_OPTIMAL);
    thr_lp_primal(lp, x);
    ck_assert_double_eq_tol(thr_lp_objective(lp), 3.5, 1e-9); /* x = 2, y = 1 */
    ck_assert_double_eq_tol(x[0], 2, 1e-6);
    ck_assert_double_eq_tol(x[1], 1, 1e-6);
    ck_assert_int_eq(thr_lp_solve(lp, &limits, &outcome, NULL),
                     THR_OK); /* and goes on from there */
    ck_assert_double_eq_tol(thr_lp_objective(lp), 3.5, 1e-9);
    thr_lp_destroy(lp);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("linear programmes and cut tree");
  ADD_TEST(s, 10, optimum_and_duals_are_known);
  ADD_TEST(s, 10, rows_are_added_and_dropped);
  ADD_TEST(s, 10, costs_and_upper_bounds_count);
  ADD_TEST(s, 10, any_basis_may_be_set);
  ADD_TEST(s, 10, infeasible_and_unbounded_are_outcomes);
  ADD_TEST(s, 10, limits_stop_and_solving_goes_on);
  ADD_TEST(s, 10, work_stops_at_the_same_place);
  ADD_TEST(s, 10, abort_becomes_a_status);
  ADD_EXAMPLES(s, 10, random_covers_are_dual_pairs, 40);
  ADD_TEST(s, 10, equations_with_a_free_column);
  ADD_TEST(s, 10, equations_without_a_solution);
  ADD_EXAMPLES(s, 10, normal_equations_are_solved, 60);
  ADD_TEST(s, 10, equal_rows_are_solved_once);
  ADD_EXAMPLES(s, 10, columns_are_weighed_three_by_three, 40);
  ADD_TEST(s, 10, dense_sums_are_right);
  ADD_LOOP(s, 10, cones_stand_for_their_rays, 0, 20);
  ADD_LOOP(s, 10, cones_find_a_planted_optimum, 0, 20);
  ADD_EXAMPLES(s, 10, interior_finds_the_optimum_it_was_made_from, 40);
  ADD_LOOP(s, 10, interior_finds_the_shortest_way, 0, 20);
  ADD_TEST(s, 10, interior_gives_up_and_stops);
  ADD_EXAMPLES(s, 20, cut_tree_holds_all_minimum_cuts, 60);
  ADD_EXAMPLES(s, 20, maximum_flow_is_as_large_as_its_cut, 60);
  ADD_TEST(s, 10, cut_tree_of_nonsense_is_a_status);
  ADD_TEST(s, 10, libraries_tell_their_versions);
  ADD_TEST(s, 30, branch_and_bound_ends_in_time);
  ADD_TEST(s, 10, branch_and_bound_in_a_child_is_the_same);
  return run_suite(s);
}
