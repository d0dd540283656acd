/* Pairing the passes at one node: minimum-weight perfect matching of n points under any prices.
 *
 * Up to 16 points by dynamic programming over subsets: best(S) = min over j of price(i, j) + best(S - {i, j}), i the lowest
 * point of S; beyond, point i with i + n / 2, then exchanges of two pairs while any saves.
 *
 * Example: four passes straight across each other are paired with their opposites, at price 0. */
#ifndef THR_PAIRING_H
#define THR_PAIRING_H

#include "graph/status.h"

enum { THR_PAIRING_EXACT = 16 }; /* largest n that thr_pairing_best solves exactly */

/* price[i * n + j] = price[j * n + i] of pairing i with j. mate[n] receives the pairs; n must be even (THR_EINPUT).
 * n <= THR_PAIRING_EXACT: least total price, by dynamic programming over subsets, O(2^n n). More: first with last half, then
 * exchanges of two pairs until none saves. */
thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err) THR_MUST_CHECK;

#endif
