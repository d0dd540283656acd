/* Proof that cords need as many passes as they have beyond a shortest join, by prices of places (graph/plan/prices.h).
 *
 * Let every pass at a node where a cord may end be worth p, a place for its end, as if it made the edge lighter, and let 2 K
 * such places cost 2 K p: the least join at these prices, put together, is a bound for K cords, and the best p is searched for.
 *
 * Example: docs/method.md, "Several cords". */
#ifndef THR_DECOMPOSITION_PRICES_H
#define THR_DECOMPOSITION_PRICES_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "lp/length/decomposition.h"

/* Where certificate, found without prices, proves less than these passes need for so many cords, looks for prices
 * that prove more: the bound is a concave function of the price, found between prices of too few and of too many places, each by
 * a minimum T-join. With ends free that closes the gap (places are one degree constraint; Edmonds & Johnson 1973); with closed
 * cords it need not. certificate then has the best found. What the limits stop, or is too large, leaves certificate as it is or
 * better. About 10 T-joins. */
thr_status thr_decomposition_prices(const thr_decomposition *decomposition, int cords, thr_certificate *certificate,
                                    thr_err *err) THR_MUST_CHECK;

#endif
