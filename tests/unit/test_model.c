/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows, rounds and tree of lp/model/ against all whole points of small covering problems: minimize
 * cost x, A x >= lower, 0 <= x
 * <= most.
 */
#include "graph/limits.h"
#include "lp/model/tree.h"
#include "lp/solver/solver.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 5, ROWS = 6, MOST = 3 };

typedef struct {
  int cost[COLUMNS], row[ROWS][COLUMNS], lower[ROWS];
} covering;

static covering covering_make(rng *r)
{
  covering c;
  for (int j = 0; j < COLUMNS; j++)
    c.cost[j] = rng_between(r, 1, 4);
  for (int i = 0; i < ROWS; i++) {
    int room = 0;
    for (int j = 0; j < COLUMNS; j++)
      room += MOST * (c.row[i][j] = rng_below(r, 4));
    c.lower[i] = rng_below(r, 1 + room);
  }
  return c;
}

static int short_of(const covering *c, int i, const int *x)
{
  int missing = c->lower[i];
  for (int j = 0; j < COLUMNS; j++)
    missing -= c->row[i][j] * x[j];
  return missing;
}

static int price_of(const covering *c, const int *x)
{
  int sum = 0;
  for (int j = 0; j < COLUMNS; j++)
    sum += c->cost[j] * x[j];
  return sum;
}

/* Of all whole points. */
static int least_price(const covering *c)
{
  int best = INT32_MAX;
  for (int k = 0; k < 1 << (2 * COLUMNS); k++) {
    int x[COLUMNS], i = 0;
    for (int j = 0; j < COLUMNS; j++)
      x[j] = k >> (2 * j) & 3;
    while (i < ROWS && short_of(c, i, x) <= 0)
      i++;
    if (i == ROWS && price_of(c, x) < best) best = price_of(c, x);
  }
  return best;
}

/* ---- a tree over bounds without a linear programme ---- */

typedef struct {
  const covering *c;
  thr_tree tree;
  int low[COLUMNS], high[COLUMNS]; /* as the tree has told */
  int solved[4096], n_solved;
} search;

static thr_status tell(void *user, int column, int low, int high, thr_err *err)
{
  (void)err;
  search *s = user;
  s->low[column] = low;
  s->high[column] = high;
  return THR_OK;
}

static void assert_in_force(const search *s)
{
  for (int j = 0; j < COLUMNS; j++) {
    ck_assert_int_eq(s->low[j], s->tree.here.low[j]);
    ck_assert_int_eq(s->high[j], s->tree.here.high[j]);
  }
}

/* The price of the least values; a solution if they cover, none if the most do not, else a column
 * of a row that is short. */
static thr_status solve_by_least(void *user, int node, thr_tree_branch *branch, thr_err *err)
{
  (void)err;
  search *s = user;
  int i = 0, k = 0;
  s->solved[s->n_solved++] = node;
  assert_in_force(s);
  s->tree.node[node].bound = price_of(s->c, s->low);
  while (k < ROWS && short_of(s->c, k, s->high) <= 0)
    k++;
  while (i < ROWS && short_of(s->c, i, s->low) <= 0)
    i++;
  if (i == ROWS) s->tree.enough = fmin(s->tree.enough, s->tree.node[node].bound);
  if (i == ROWS || k < ROWS) return THR_OK;
  branch->column = 0;
  while (s->c->row[i][branch->column] == 0 || s->low[branch->column] == s->high[branch->column])
    branch->column++;
  branch->value = s->low[branch->column];
  branch->high = true;
  return THR_OK;
}

static void search_init(search *s, const covering *c)
{
  static const int most[COLUMNS] = {MOST, MOST, MOST, MOST, MOST};
  *s = (search){.c = c};
  memcpy(s->high, most, sizeof most);
  ck_assert_int_eq(thr_tree_init(&s->tree, COLUMNS, NULL, most, NULL), THR_OK);
}

START_TEST(the_tree_finds_the_least_of_all_points)
{
  rng r = rng_make((uint64_t)_i);
  const covering c = covering_make(&r);
  search s;
  search_init(&s, &c);
  const thr_tree_calls calls = {&s, NULL, tell, solve_by_least, NULL};
  ck_assert_int_eq(thr_tree_run(&s.tree, &calls, NULL), THR_OK);
  ck_assert(!s.tree.stopped);
  ck_assert_double_eq(s.tree.enough, least_price(&c));
  for (int i = 0; i < s.n_solved; i++) {
    const thr_tree_node *n = &s.tree.node[s.solved[i]];
    if (n->parent >= 0)
      ck_assert_msg(s.tree.node[n->parent].bound < s.tree.enough,
                    "a node below a closed one was solved");
  }
  ck_assert_int_eq(thr_tree_enter(&s.tree, &calls, 0, NULL), THR_OK);
  assert_in_force(&s);
  for (int j = 0; j < COLUMNS; j++)
    ck_assert(s.low[j] == 0 && s.high[j] == MOST);
  thr_tree_destroy(&s.tree);
}
END_TEST

START_TEST(a_stopped_tree_knows_a_bound)
{
  rng r = rng_make((uint64_t)_i);
  const covering c = covering_make(&r);
  double work = 0;
  const thr_limits none = {.work = &work};
  for (int by_work = 0; by_work < 2; by_work++) {
    search s;
    search_init(&s, &c);
    const thr_tree_calls calls = {&s, by_work ? &none : NULL, tell, solve_by_least, NULL};
    if (!by_work) s.tree.most_nodes = 1 + _i % 8;
    ck_assert_int_eq(thr_tree_run(&s.tree, &calls, NULL), THR_OK);
    ck_assert_int_ge(s.n_solved, 1);
    if (by_work) ck_assert_int_eq(s.n_solved, 1); /* the root in any case */
    ck_assert_int_le(s.tree.n_nodes, by_work ? 3 : s.tree.most_nodes);
    if (s.tree.stopped) ck_assert_double_le(thr_tree_bound(&s.tree), least_price(&c));
    if (!s.tree.stopped) ck_assert_double_eq(s.tree.enough, least_price(&c));
    thr_tree_destroy(&s.tree);
  }
}
END_TEST

/* Columns that are alike in every row and in price, and whose bounds in force are. */
static bool are_alike(const search *s, int a, int b)
{
  bool alike = s->c->cost[a] == s->c->cost[b] && s->low[a] == s->low[b] && s->high[a] == s->high[b];
  for (int i = 0; i < ROWS; i++)
    alike &= s->c->row[i][a] == s->c->row[i][b];
  return alike;
}

/* The same, deciding for all that are alike at once. */
static thr_status solve_by_orbits(void *user, int node, thr_tree_branch *branch, thr_err *err)
{
  static int also[COLUMNS];
  search *s = user;
  thr_status st = solve_by_least(user, node, branch, err);
  const int j = branch->column;
  for (int k = 0; k < COLUMNS && j >= 0; k++)
    if (k != j && are_alike(s, j, k)) also[branch->n_also++] = k;
  branch->also = also;
  return st;
}

START_TEST(columns_that_are_alike_are_decided_at_once)
{
  rng r = rng_make((uint64_t)_i);
  covering c = covering_make(&r);
  const int from = _i % COLUMNS,
            apart = (_i / COLUMNS) % COLUMNS; /* all but one are like the first */
  for (int j = 0; j < COLUMNS; j++) {
    if (j == apart) continue;
    c.cost[j] = c.cost[from];
    for (int i = 0; i < ROWS; i++)
      c.row[i][j] = c.row[i][from];
  }
  for (int i = 0; i < ROWS; i++) { /* there is a point */
    const int most[COLUMNS] = {MOST, MOST, MOST, MOST, MOST}, missing = short_of(&c, i, most);
    if (missing > 0) c.lower[i] -= missing;
  }
  int solved[2];
  for (int at_once = 0; at_once < 2; at_once++) {
    search s;
    search_init(&s, &c);
    const thr_tree_calls calls = {&s, NULL, tell, at_once ? solve_by_orbits : solve_by_least, NULL};
    ck_assert_int_eq(thr_tree_run(&s.tree, &calls, NULL), THR_OK);
    ck_assert_double_eq(s.tree.enough, least_price(&c));
    solved[at_once] = s.n_solved;
    ck_assert_int_eq(thr_tree_enter(&s.tree, &calls, 0, NULL), THR_OK);
    assert_in_force(&s);
    thr_tree_destroy(&s.tree);
  }
  ck_assert_int_le(solved[1], solved[0]);
}
END_TEST

/* Two columns of 0 or 1, all bounds within one grain of each other. */
static thr_status solve_ties(void *user, int node, thr_tree_branch *branch, thr_err *err)
{
  (void)err;
  search *s = user;
  s->solved[s->n_solved++] = node;
  s->tree.node[node].bound = 10.5 - 0.01 * s->n_solved;
  if (s->tree.node[node].depth < 2)
    *branch = (thr_tree_branch){.column = s->tree.node[node].depth, .high = node == 0};
  return THR_OK;
}

START_TEST(of_equal_bounds_the_deepest_the_youngest_the_preferred)
{
  static const int least[COLUMNS], most[COLUMNS] = {1, 1, 1, 1, 1};
  search s = {.n_solved = 0};
  ck_assert_int_eq(thr_tree_init(&s.tree, COLUMNS, least, most, NULL), THR_OK);
  s.tree.grain = 1;
  const thr_tree_calls calls = {&s, NULL, tell, solve_ties, NULL};
  ck_assert_int_eq(thr_tree_run(&s.tree, &calls, NULL), THR_OK);
  const int expected[] = {0, 2, 3, 4,
                          1, 5, 6}; /* 1, 2 below the root, the high one first; then the low ones */
  ck_assert_int_eq(s.n_solved, 7);
  for (int i = 0; i < 7; i++)
    ck_assert_int_eq(s.solved[i], expected[i]);
  thr_tree_destroy(&s.tree);
}
END_TEST

/* ---- rows that are found as a point violates them ---- */

typedef struct {
  search s;
  thr_search cut;
  double x[COLUMNS];
  rng r;
  int asked, rounds; /* separators begun after others had found rows; looks */
  bool whole;        /* what a look says */
} cutting;

static thr_status set_in_programme(void *user, int column, int low, int high, thr_err *err)
{
  cutting *k = user;
  thr_status st = tell(&k->s, column, low, high, err);
  return st ? st : thr_lp_set_bounds(k->cut.lp, column, low, high, err);
}

/* One row that x violates, begun anywhere: of the even ones, or of the odd ones. */
static thr_status find(cutting *k, int parity, int *added, thr_err *err)
{
  const covering *c = k->s.c;
  thr_status st = THR_OK;
  for (int q = 0, before = *added, first = rng_below(&k->r, ROWS);
       q < ROWS && *added == before && !st; q++) {
    int i = (first + q) % ROWS;
    if (i % 2 != parity) continue;
    for (int j = 0; j < COLUMNS; j++) {
      thr_pool_put(&k->cut.pool, j, c->row[i][j] + 1); /* in two steps, which must add up */
      thr_pool_put(&k->cut.pool, j, -1);
    }
    st = thr_pool_offer(&k->cut.pool, (thr_row){.index = i, .lower = c->lower[i]}, k->x, 1e-6,
                        added, err);
  }
  return st;
}

static thr_status find_even(void *user, int *added, thr_err *err)
{
  ck_assert_int_eq(*added, 0);
  return find(user, 0, added, err);
}

static thr_status find_odd(void *user, int *added, thr_err *err)
{
  cutting *k = user;
  k->asked += *added > 0;
  return find(k, 1, added, err);
}

static thr_status look(void *user, thr_err *err)
{
  (void)err;
  cutting *k = user;
  const thr_search *cut = &k->cut;
  k->rounds++;
  if (cut->outcome != THR_LP_OPTIMAL) return THR_OK;
  ck_assert_int_eq(cut->pool.count, thr_lp_rows(cut->lp));
  double paid = 0, reduced[COLUMNS];
  for (int j = 0; j < COLUMNS; j++)
    reduced[j] = k->s.c->cost[j];
  for (int i = 0; i < cut->pool.count; i++) {
    ck_assert_double_ge(thr_row_sum(&cut->pool.row[i], k->x), cut->pool.row[i].lower - 1e-6);
    ck_assert_double_ge(cut->dual[i], -1e-9);
    paid += cut->dual[i] * cut->pool.row[i].lower;
    thr_row_charge(&cut->pool.row[i], cut->dual[i], reduced);
  }
  for (int j = 0; j < COLUMNS; j++) /* duality: what the rows and the bounds on columns pay */
    paid += reduced[j] * (reduced[j] > 0 ? k->s.low[j] : k->s.high[j]);
  ck_assert_double_eq_tol(paid, cut->objective, 1e-6);
  k->cut.enough = cut->objective > k->s.tree.enough - 1 + 1e-6; /* prices are whole numbers */
  return THR_OK;
}

static thr_status solve_by_programme(void *user, int node, thr_tree_branch *branch, thr_err *err)
{
  cutting *k = user;
  thr_tree *t = &k->s.tree;
  const thr_limits none = {0};
  const thr_search_calls calls = {.user = k, .look = look, .patience = 2};
  ck_assert_int_eq(thr_search_rounds(&k->cut, &calls, &none, err), THR_OK);
  if (k->cut.outcome == THR_LP_INFEASIBLE || k->cut.enough) return THR_OK;
  ck_assert_int_eq(k->cut.outcome, THR_LP_OPTIMAL);
  t->node[node].bound = fmax(t->node[node].bound, k->cut.objective - 1e-6);
  branch->column = thr_tree_undecided(k->x, 0, COLUMNS, 1e-5, NULL);
  if (branch->column >= 0)
    branch->value = (int)floor(k->x[branch->column]);
  else
    t->enough = fmin(t->enough, nearbyint(k->cut.objective));
  return THR_OK;
}

static void cutting_init(cutting *k, const covering *c, rng r, bool fallback)
{
  double cost[COLUMNS], most[COLUMNS] = {MOST, MOST, MOST, MOST, MOST};
  *k = (cutting){.r = r};
  for (int j = 0; j < COLUMNS; j++)
    cost[j] = c->cost[j];
  search_init(&k->s, c);
  ck_assert_int_eq(thr_search_init(&k->cut, COLUMNS, k->x, NULL), THR_OK);
  ck_assert_int_eq(thr_lp_create(&k->cut.lp, COLUMNS, cost, most, NULL), THR_OK);
  thr_search_use(&k->cut, find_even, k, 0);
  thr_search_use(&k->cut, find_odd, k, (fallback ? THR_FALLBACK : 0) | THR_SLOW);
}

static void cutting_destroy(cutting *k)
{
  thr_tree_destroy(&k->s.tree);
  thr_search_destroy(&k->cut);
}

START_TEST(rows_found_on_the_way_lead_to_the_same_price)
{
  rng r = rng_make((uint64_t)_i);
  const covering c = covering_make(&r);
  for (int fallback = 0; fallback < 2; fallback++) {
    cutting k;
    cutting_init(&k, &c, r, fallback);
    const thr_tree_calls calls = {&k, NULL, set_in_programme, solve_by_programme, NULL};
    ck_assert_int_eq(thr_tree_run(&k.s.tree, &calls, NULL), THR_OK);
    ck_assert_double_eq(k.s.tree.enough, least_price(&c));
    if (fallback) ck_assert_int_eq(k.asked, 0);
    cutting_destroy(&k);
  }
}
END_TEST

static thr_status look_idly(void *user, thr_err *err)
{
  (void)err;
  cutting *k = user;
  k->rounds++;
  k->cut.whole = k->whole;
  return THR_OK;
}

START_TEST(rounds_end_where_they_are_told_to)
{
  rng r = rng_make((uint64_t)_i);
  const covering c = covering_make(&r);
  double work = 0;
  const thr_limits none = {0}, over = {.work = &work};
  cutting k;
  for (int whole = 0; whole < 2; whole++) { /* which the number of rounds does not end */
    cutting_init(&k, &c, r, true);
    k.whole = whole;
    const thr_search_calls calls = {.user = &k, .look = look_idly, .most_rounds = 2};
    ck_assert_int_eq(thr_search_rounds(&k.cut, &calls, &none, NULL), THR_OK);
    if (!whole) ck_assert_int_le(k.rounds, 2);
    for (int i = 0; i < ROWS && (whole || k.rounds < 2); i++) {
      double sum = 0;
      for (int j = 0; j < COLUMNS; j++)
        sum += c.row[i][j] * k.x[j];
      ck_assert_double_ge(sum, c.lower[i] - 1e-5);
    }
    cutting_destroy(&k);
  }
  cutting_init(&k, &c, r, true);
  const thr_search_calls calls = {.user = &k, .look = look_idly, .name = "a covering problem"};
  ck_assert_int_eq(thr_search_rounds(&k.cut, &calls, &over, NULL), THR_OK);
  ck_assert(k.cut.outcome == THR_LP_STOPPED && k.rounds == 1);
  thr_err err = {0}; /* of no solution the name is told */
  thr_pool_put(&k.cut.pool, 0, 1);
  ck_assert_int_eq(thr_pool_add(&k.cut.pool, (thr_row){.lower = MOST + 1}, NULL), THR_OK);
  ck_assert_int_eq(thr_search_rounds(&k.cut, &calls, &none, &err), THR_ESOLVER);
  ck_assert_ptr_nonnull(strstr(err.text, "a covering problem"));
  cutting_destroy(&k);
}
END_TEST

START_TEST(the_most_undecided_column)
{
  const double x[] = {2, 0.3, 0.5, 1.5, 7};
  const int decided[] = {0, 0, 1, 0, 0};
  ck_assert_int_eq(thr_tree_undecided(x, 0, 5, 1e-6, NULL), 2); /* of equal ones the first */
  ck_assert_int_eq(thr_tree_undecided(x, 0, 5, 1e-6, decided), 3);
  ck_assert_int_eq(thr_tree_undecided(x, 0, 2, 1e-6, NULL), 1);
  ck_assert_int_eq(thr_tree_undecided(x, 0, 2, 0.4, NULL), -1);
  ck_assert_int_eq(thr_tree_undecided(x, 4, 5, 1e-6, NULL), -1);
}
END_TEST

static void put_row(thr_pool *p, double a, double b)
{
  thr_pool_put(p, 2, a);
  thr_pool_put(p, 0, b);
  thr_pool_put(p, 1, 3);
  thr_pool_put(p, 1, -3); /* nothing is left of it */
}

START_TEST(a_row_is_known_until_it_is_dropped)
{
  const double none[3] = {0}, enough[3] = {2, 0, 2};
  double reduced[3] = {10, 10, 10};
  int added = 0, set[] = {7, 9};
  thr_pool p;
  ck_assert_int_eq(thr_pool_init(&p, 3, NULL), THR_OK);
  put_row(&p, 1, 2);
  ck_assert_int_eq(thr_pool_offer(&p, (thr_row){.lower = 4}, enough, 1e-6, &added, NULL), THR_OK);
  ck_assert_int_eq(p.count, 0); /* not violated */
  for (int twice = 0; twice < 2; twice++) {
    put_row(&p, 1, 2);
    ck_assert_int_eq(thr_pool_offer(&p, (thr_row){.lower = 4, .member = set, .n_members = 2}, none,
                                    1e-6, &added, NULL),
                     THR_OK);
  }
  ck_assert(added == 1 && p.count == 1 && p.row[0].n == 2 && p.row[0].column[0] == 2 &&
            p.row[0].column[1] == 0);
  set[1] = 0; /* its own copy */
  ck_assert(p.row[0].n_members == 2 && p.row[0].member[1] == 9);
  ck_assert_double_eq(thr_row_sum(&p.row[0], enough), 6);
  thr_row_charge(&p.row[0], 3, reduced);
  ck_assert(reduced[0] == 4 && reduced[1] == 10 && reduced[2] == 7);
  put_row(&p, 1, 1); /* another row */
  ck_assert_int_eq(thr_pool_offer(&p, (thr_row){.lower = 4}, none, 1e-6, &added, NULL), THR_OK);
  ck_assert(added == 2 && p.count == 2 && p.row[1].value == NULL);
  ck_assert_int_eq(thr_pool_keep_violated(&p, 0, enough, 1e-6, &added, NULL), THR_OK);
  ck_assert(added == 2 && p.count == 0);
  put_row(&p, 1, 2);
  ck_assert_int_eq(thr_pool_offer(&p, (thr_row){.lower = 4}, none, 1e-6, &added, NULL), THR_OK);
  ck_assert(added == 3 && p.count == 1);
  thr_pool_destroy(&p);
}
END_TEST

START_TEST(a_pool_of_thousands_knows_them_all)
{
  enum { MANY = 3000 };
  const double x[2] = {0};
  int added = 0;
  thr_pool p;
  ck_assert_int_eq(thr_pool_init(&p, 2, NULL), THR_OK);
  for (int i = 0; i < 2 * MANY; i++) {
    thr_pool_put(&p, i % 2, 1 + i % MANY);
    ck_assert_int_eq(thr_pool_offer(&p, (thr_row){.lower = 1}, x, 1e-6, &added, NULL), THR_OK);
  }
  ck_assert_int_eq(added, MANY);
  for (int i = 0; i < MANY; i++)
    ck_assert(thr_pool_knows(&p, p.row[i].name) && p.row[i].column[0] == i % 2);
  thr_pool_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rows, rounds and tree");
  ADD_EXAMPLES(s, 20, the_tree_finds_the_least_of_all_points, 200);
  ADD_EXAMPLES(s, 20, a_stopped_tree_knows_a_bound, 50);
  ADD_EXAMPLES(s, 20, columns_that_are_alike_are_decided_at_once, 200);
  ADD_TEST(s, 5, of_equal_bounds_the_deepest_the_youngest_the_preferred);
  ADD_EXAMPLES(s, 20, rows_found_on_the_way_lead_to_the_same_price, 200);
  ADD_EXAMPLES(s, 20, rounds_end_where_they_are_told_to, 50);
  ADD_TEST(s, 5, the_most_undecided_column);
  ADD_TEST(s, 5, a_row_is_known_until_it_is_dropped);
  ADD_TEST(s, 5, a_pool_of_thousands_knows_them_all);
  return run_suite(s);
}
