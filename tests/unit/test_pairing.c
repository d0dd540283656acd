/* Pairing at one node: subsets against integer programming against enumeration, on random stars under every price. */
#include "tests/support.h"
#include "tortuosity/pairing.h"
#include "graph/turning_proof.h"

#include <math.h>

enum { MOST = 18 };

/* Least total by trying every partner of the first free point. */
static double least_by_enumeration(int n, const double *price, unsigned used)
{
  int i = 0;
  double least = INFINITY;
  while (i < n && used >> i & 1u)
    i++;
  if (i == n) return 0;
  for (int j = i + 1; j < n; j++)
    if (!(used >> j & 1u)) least = fmin(least, price[i * n + j] + least_by_enumeration(n, price, used | 1u << i | 1u << j));
  return least;
}

/* Prices between n darts of a random star of d spokes; a spoke may be passed several times, and turning back costs more than any
 * pairing without. */
static void random_star(rng *r, int n, thr_turn_cost cost, double *price)
{
  double at[MOST][3];
  int spoke[MOST];
  bool planar = rng_below(r, 3) == 0;
  for (int i = 0; i < n; i++) {
    spoke[i] = i > 1 && rng_below(r, 4) == 0 ? spoke[i - 2] : i;
    for (int k = 0; k < 3; k++)
      at[i][k] = spoke[i] < i ? at[spoke[i]][k] : k == 2 && planar ? 0 : rng_unit(r) - 0.5;
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double dot = 0, a = 0, b = 0;
      for (int k = 0; k < 3; k++) {
        dot -= at[i][k] * at[j][k];
        a += at[i][k] * at[i][k];
        b += at[j][k] * at[j][k];
      }
      double angle = acos(fmax(-1, fmin(1, dot / sqrt(a * b))));
      price[i * n + j] = spoke[i] == spoke[j] ? 1000 : thr_turn_cost_of(cost, angle);
    }
}

static void assert_pairing(int n, const int *mate)
{
  for (int i = 0; i < n; i++) {
    ck_assert(mate[i] >= 0 && mate[i] < n && mate[i] != i);
    ck_assert_int_eq(mate[mate[i]], i);
  }
}

START_TEST(subsets_match_enumeration)
{
  rng r = rng_make((uint64_t)_i + 1);
  double price[MOST * MOST];
  int mate[MOST];
  for (int k = 0; k < 30000; k++) {
    int n = 2 * rng_between(&r, 1, k % 20 ? 3 : 4);
    random_star(&r, n, (thr_turn_cost)(k % 3), price);
    ck_assert_int_eq(thr_pairing_best(n, price, mate, NULL), THR_OK);
    assert_pairing(n, mate);
    ck_assert_double_eq_tol(thr_pairing_price(n, price, mate), least_by_enumeration(n, price, 0), 1e-9);
  }
}
END_TEST

START_TEST(subsets_match_integer_programming)
{
  rng r = rng_make((uint64_t)_i + 100);
  double price[MOST * MOST];
  int mate[MOST], other[MOST];
  thr_limits limits = {0};
  for (int k = 0; k < 400; k++) {
    int n = 2 * rng_between(&r, 1, 6);
    random_star(&r, n, (thr_turn_cost)(k % 3), price);
    ck_assert_int_eq(thr_pairing_best(n, price, mate, NULL), THR_OK);
    ck_assert_int_eq(thr_pairing_integer(n, price, &limits, other, NULL), THR_OK);
    assert_pairing(n, other);
    ck_assert_double_eq_tol(thr_pairing_price(n, price, mate), thr_pairing_price(n, price, other), 1e-6);
  }
}
END_TEST

/* Two triangles joined by one dear pair: the linear programme takes halves round both triangles for nothing. */
START_TEST(fractional_relaxation_is_branched)
{
  double price[36];
  int mate[6];
  thr_limits limits = {0};
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++)
      price[i * 6 + j] = i / 3 == j / 3 ? 0 : 1;
  ck_assert_int_eq(thr_pairing_integer(6, price, &limits, mate, NULL), THR_OK);
  assert_pairing(6, mate);
  ck_assert_double_eq(thr_pairing_price(6, price, mate), 1);
}
END_TEST

START_TEST(large_nodes_are_paired)
{
  rng r = rng_make(1);
  double price[MOST * MOST];
  int mate[MOST], best[MOST];
  thr_limits limits = {0};
  for (int k = 0; k < 20; k++) {
    random_star(&r, MOST, THR_TURN_ANGLE, price);
    ck_assert_int_eq(thr_pairing_best(MOST, price, mate, NULL), THR_OK);
    assert_pairing(MOST, mate);
    ck_assert_int_eq(thr_pairing_integer(MOST, price, &limits, best, NULL), THR_OK);
    ck_assert_double_ge(thr_pairing_price(MOST, price, mate), thr_pairing_price(MOST, price, best) - 1e-6);
  }
}
END_TEST

START_TEST(odd_numbers_are_refused)
{
  double price[9] = {0};
  int mate[3];
  thr_err err = {0};
  thr_limits limits = {0};
  ck_assert_int_eq(thr_pairing_best(3, price, mate, &err), THR_EINPUT);
  assert_one_line(&err, "3");
  ck_assert_int_eq(thr_pairing_integer(3, price, &limits, mate, NULL), THR_EINPUT);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("pairing");
  ADD_LOOP(s, 30, subsets_match_enumeration, 0, 3);
  ADD_LOOP(s, 30, subsets_match_integer_programming, 0, 3);
  ADD_TEST(s, 10, fractional_relaxation_is_branched);
  ADD_TEST(s, 10, large_nodes_are_paired);
  ADD_TEST(s, 10, odd_numbers_are_refused);
  return run_suite(s);
}
