/* Pairing at a node: subsets, exchanges, integer programming. */
#include "tortuosity/tour/pairing.h"
#include "lp/solver/lp.h"

#include <math.h>
#include <stdlib.h>

static void set_pair(int *mate, int a, int b)
{
  mate[a] = b;
  mate[b] = a;
}

double thr_pairing_price(int n, const double *price, const int *mate)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    if (mate[i] > i) sum += price[i * n + mate[i]];
  return sum;
}

static int lowest(unsigned s)
{
  int i = 0;
  while (!(s >> i & 1u))
    i++;
  return i;
}

static int size_of(unsigned s)
{
  int n = 0;
  for (; s; s &= s - 1)
    n++;
  return n;
}

/* Is subset s left when lowest points are paired off, one after the other, with any others? Then all points below its lowest are
 * gone, and with each of them at most one more. */
static bool is_left(int n, unsigned s, int low)
{
  int gone = n - size_of(s);
  return gone % 2 == 0 && gone <= 2 * low;
}

/* best[s] = least price of pairing the points of subset s; choice[s] = partner of its lowest. */
static thr_status pair_by_subsets(int n, const double *price, int *mate, thr_err *err)
{
  unsigned all = (1u << n) - 1;
  double *best = thr_calloc((size_t)all + 1, sizeof *best);
  unsigned char *choice = thr_calloc((size_t)all + 1, sizeof *choice);
  thr_status st = best && choice ? THR_OK : thr_nomem(err);
  for (unsigned s = 1; s <= all && !st; s++) {
    int i = lowest(s);
    if (!is_left(n, s, i)) continue;
    best[s] = INFINITY;
    for (int j = i + 1; j < n; j++) {
      if (!(s >> j & 1u)) continue;
      double total = price[i * n + j] + best[s & ~(1u << i | 1u << j)];
      if (total < best[s]) {
        best[s] = total;
        choice[s] = (unsigned char)j;
      }
    }
  }
  for (unsigned s = all; s && !st;) {
    int i = lowest(s);
    set_pair(mate, i, choice[s]);
    s &= ~(1u << i | 1u << choice[s]);
  }
  free(best);
  free(choice);
  return st;
}

/* One pass of exchanges (a b)(c d) -> (a c)(b d) or (a d)(b c); true if one saved. */
static bool exchange_pairs(int n, const double *price, int *mate)
{
  bool saved = false;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++) {
      int b = mate[a], d = mate[c];
      if (b == c) continue;
      double old = price[a * n + b] + price[c * n + d];
      double straight = price[a * n + c] + price[b * n + d], cross = price[a * n + d] + price[b * n + c];
      if (fmin(straight, cross) >= old - 1e-9 * (1 + fabs(old))) continue;
      set_pair(mate, a, straight <= cross ? c : d);
      set_pair(mate, b, straight <= cross ? d : c);
      saved = true;
    }
  return saved;
}

thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err)
{
  if (n % 2) return thr_fail(err, THR_EINPUT, "%d passes and ends at a node cannot be paired", n);
  if (n <= THR_PAIRING_EXACT) return pair_by_subsets(n, price, mate, err);
  for (int i = 0; i < n / 2; i++)
    set_pair(mate, i, i + n / 2);
  while (exchange_pairs(n, price, mate))
    ;
  return THR_OK;
}

/* ---- integer programming ---- */

static int pair_column(int n, int i, int j)
{
  return i < j ? i * (2 * n - i - 1) / 2 + (j - i - 1) : pair_column(n, j, i);
}

/* One equation per point over the columns of its pairs. */
static thr_status pair_programme(int n, const double *price, thr_lp **lp, thr_err *err)
{
  int columns = n * (n - 1) / 2, at = 0;
  size_t k = (size_t)columns;
  double *cost = thr_calloc(k, sizeof *cost), *value = thr_calloc(2 * k, sizeof *value),
         *one = thr_calloc((size_t)n, sizeof *one);
  int *start = thr_calloc(k + 1, sizeof *start), *row = thr_calloc(2 * k, sizeof *row);
  thr_status st = cost && value && one && start && row ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n && !st; i++) {
    one[i] = 1;
    for (int j = i + 1; j < n; j++, at++) {
      cost[at] = price[i * n + j];
      start[at] = 2 * at;
      row[2 * at] = i;
      row[2 * at + 1] = j;
      value[2 * at] = value[2 * at + 1] = 1;
    }
  }
  if (!st) {
    start[at] = 2 * at;
    st = thr_lp_create_equations(lp, n, one, columns, cost, NULL, start, row, value, err);
  }
  free(cost);
  free(value);
  free(one);
  free(start);
  free(row);
  return st;
}

thr_status thr_pairing_integer(int n, const double *price, const thr_limits *limits, int *mate, thr_pairing_relaxed *relaxed,
                               thr_err *err)
{
  thr_lp *lp = NULL;
  thr_lp_outcome outcome = THR_LP_OPTIMAL;
  bool whole = true;
  if (n % 2) return thr_fail(err, THR_EINPUT, "%d passes and ends at a node cannot be paired", n);
  if (relaxed) *relaxed = (thr_pairing_relaxed){0, true};
  if (n == 0) return THR_OK;
  double *x = thr_calloc((size_t)n * (size_t)(n - 1) / 2, sizeof *x);
  thr_status st = x ? pair_programme(n, price, &lp, err) : thr_nomem(err);
  if (!st) st = thr_lp_solve(lp, limits, &outcome, err);
  if (!st) thr_lp_primal(lp, x);
  for (int j = 0; j < n * (n - 1) / 2 && !st; j++)
    whole &= fabs(x[j] - nearbyint(x[j])) < 1e-6;
  if (!st && relaxed) *relaxed = (thr_pairing_relaxed){thr_lp_objective(lp), whole};
  if (!st && outcome == THR_LP_OPTIMAL && !whole) {
    st = thr_lp_solve_integer(lp, limits, &outcome, err);
    if (!st) thr_lp_primal(lp, x);
  }
  if (!st && outcome == THR_LP_STOPPED) st = thr_fail(err, THR_ELIMIT, "stopped early");
  if (!st && outcome != THR_LP_OPTIMAL) st = thr_fail(err, THR_ESOLVER, "GLPK found no pairing of %d passes and ends", n);
  for (int i = 0; i < n && !st; i++)
    for (int j = i + 1; j < n; j++)
      if (x[pair_column(n, i, j)] > 0.5) set_pair(mate, i, j);
  thr_lp_destroy(lp);
  free(x);
  return st;
}
