/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of lp/length/ share when they cut passes into cords of even lengths. */
#ifndef THR_POSTMAN_PARTS_H
#define THR_POSTMAN_PARTS_H

#include "lp/length/postman.h"

enum {
  THR_MOST_VISITS = 32
}; /* of a node, that each of its visits is compared with: hubs are not quadratic */

/* ---- decomposition_prices.c: Proof that cords need as many passes as they have beyond a shortest
 * join, by prices of places (graph/plan/plan_measures.h). */

/* Where certificate, found without prices, proves less than these passes need for so many cords,
 * looks for prices that prove more: the bound is a concave function of the price, found between
 * prices of too few and of too many places, each by a minimum T-join. With ends free that closes
 * the gap (places are one degree constraint; Edmonds & Johnson 1973); with closed cords it need
 * not. certificate then has the best found. What the limits stop, or is too large, leaves
 * certificate as it is or better. About 10 T-joins. */
thr_status thr_decomposition_prices(const thr_decomposition *decomposition, int cords,
                                    thr_certificate *certificate, thr_err *err) THR_MUST_CHECK;

#endif
