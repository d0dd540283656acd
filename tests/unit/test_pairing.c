/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairing at one node: subsets against enumeration and the matching engine, on random stars under
 * every price. */
#include "graph/plan/turning_proof.h"
#include "graph/threading/threading.h"
#include "tests/matchings.h"
#include "tests/support.h"

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
    if (!(used >> j & 1u))
      least =
          fmin(least, price[i * n + j] + least_by_enumeration(n, price, used | 1u << i | 1u << j));
  return least;
}

static double turn_between(const double *a, const double *b)
{
  double dot = 0, aa = 0, bb = 0;
  for (int k = 0; k < 3; k++) {
    dot -= a[k] * b[k];
    aa += a[k] * a[k];
    bb += b[k] * b[k];
  }
  return acos(fmax(-1, fmin(1, dot / sqrt(aa * bb))));
}

/* Prices between n darts of a random star of d spokes; a spoke may be passed several times, and
 * turning back costs more than any pairing without. */
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
    for (int j = 0; j < n; j++)
      price[i * n + j] =
          spoke[i] == spoke[j] ? 1000 : thr_turn_cost_of(cost, turn_between(at[i], at[j]));
}

static bool is_pairing(int n, const int *mate)
{
  for (int i = 0; i < n; i++)
    if (mate[i] < 0 || mate[i] >= n || mate[i] == i || mate[mate[i]] != i) return false;
  return true;
}

/* Fails the test with what went wrong in which case. Check writes every ck_assert to a pipe, too
 * slow for a million cases. */
static void must_hold(bool holds, const char *what, int k)
{
  if (!holds) ck_abort_msg("case %d: %s", k, what);
}

START_TEST(subsets_match_enumeration)
{
  rng r = rng_make((uint64_t)_i + 1);
  double price[MOST * MOST];
  int mate[MOST];
  for (int k = 0; k < share_of(30000); k++) {
    int n = 2 * rng_between(&r, 1, k % 20 ? 3 : 4);
    random_star(&r, n, (thr_turn_cost)(k % THR_N_TURN_COSTS), price);
    must_hold(thr_pairing_best(n, price, mate, NULL) == THR_OK && is_pairing(n, mate), "no pairing",
              k);
    must_hold(fabs(pairing_price(n, price, mate) - least_by_enumeration(n, price, 0)) <= 1e-9,
              "not the least", k);
  }
}
END_TEST

/* Prices between the passes of a random node of 3 to 6 spokes: a third has every spoke passed
 * twice, a third as few of them as makes the number even, a third any. */
static int random_node(rng *r, thr_turn_cost cost, double *price)
{
  double at[6][3], spoke_price[6][6];
  int spoke[12], n = 0, d = rng_between(r, 3, 6), odd = 0;
  int most = rng_below(r, 3) == 0 ? 1 : 2, least = rng_between(r, 1, most);
  bool planar = rng_below(r, 3) == 0;
  for (int i = 0; i < d; i++) {
    int passes = rng_between(r, least, most);
    odd ^= passes & 1;
    if (i + 1 == d && odd) passes = 3 - passes;
    for (int k = 0; k < 3; k++)
      at[i][k] = k == 2 && planar ? 0 : rng_unit(r) - 0.5;
    for (int k = 0; k < passes; k++)
      spoke[n++] = i;
  }
  for (int i = 0; i < d; i++)
    for (int j = 0; j <= i; j++)
      spoke_price[i][j] = spoke_price[j][i] =
          i == j ? 1000 : thr_turn_cost_of(cost, turn_between(at[i], at[j]));
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      price[i * n + j] = spoke_price[spoke[i]][spoke[j]];
  return n;
}

/* Nodes as planning meets them, and stars of as many passes as subsets serve. */
START_TEST(subsets_match_the_lightest_matching)
{
  rng r = rng_make((uint64_t)_i + 100);
  double price[MOST * MOST];
  int mate[MOST];
  for (int k = 0; k < share_of(9000); k++) {
    int n = k % 30 ? random_node(&r, (thr_turn_cost)_i, price)
                   : 2 * rng_between(&r, 1, THR_PAIRING_EXACT / 2);
    if (k % 30 == 0) random_star(&r, n, (thr_turn_cost)_i, price);
    must_hold(thr_pairing_best(n, price, mate, NULL) == THR_OK && is_pairing(n, mate), "no pairing",
              k);
    must_hold(fabs(pairing_price(n, price, mate) - least_pairing(n, price)) <= 1e-9,
              "not the least", k);
  }
}
END_TEST

START_TEST(large_nodes_are_paired)
{
  rng r = rng_make(1);
  double price[MOST * MOST];
  int mate[MOST];
  for (int k = 0; k < 20; k++) {
    random_star(&r, MOST, THR_TURN_ANGLE, price);
    ck_assert_int_eq(thr_pairing_best(MOST, price, mate, NULL), THR_OK);
    ck_assert(is_pairing(MOST, mate));
    ck_assert_double_ge(pairing_price(MOST, price, mate), least_pairing(MOST, price) - 1e-9);
  }
}
END_TEST

START_TEST(odd_numbers_are_refused)
{
  double price[9] = {0};
  int mate[3];
  thr_err err = {0};
  assert_status(thr_pairing_best(3, price, mate, &err), THR_EINPUT, &err, "3");
}
END_TEST

int main(void)
{
  Suite *s = suite_create("pairing");
  ADD_LOOP(s, 30, subsets_match_enumeration, 0, 3);
  ADD_LOOP(s, 30, subsets_match_the_lightest_matching, 0, THR_N_TURN_COSTS);
  ADD_TEST(s, 10, large_nodes_are_paired);
  ADD_TEST(s, 10, odd_numbers_are_refused);
  return run_suite(s);
}
