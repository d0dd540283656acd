/* Pairing the passes at one node: minimum-weight perfect matching of n points under any prices. */
#ifndef THR_PAIRING_H
#define THR_PAIRING_H

#include "graph/limits.h"
#include "graph/status.h"

enum { THR_PAIRING_EXACT = 16 }; /* largest n that thr_pairing_best solves exactly */

/* price[i * n + j] = price[j * n + i] of pairing i with j. mate[n] receives the pairs; n must be even (THR_EINPUT).
 * n <= THR_PAIRING_EXACT: least total price, by dynamic programming over subsets, O(2^n n). More: first with last half, then
 * exchanges of two pairs until none saves. */
thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err) THR_MUST_CHECK;

/* The optimum of the linear programme: no pairing is cheaper, and one is as cheap if the columns are whole. */
typedef struct {
  double price;
  bool whole;
} thr_pairing_relaxed;

/* The same by integer programming: every point in one pair, integer columns where the linear programme is fractional. For any n;
 * an independent method for tests, and exact where the table is too large. relaxed may be NULL. THR_ELIMIT if stopped. */
thr_status thr_pairing_integer(int n, const double *price, const thr_limits *limits, int *mate, thr_pairing_relaxed *relaxed,
                               thr_err *err) THR_MUST_CHECK;

double thr_pairing_price(int n, const double *price, const int *mate);

#endif
