/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves minimum T-join problems by one of two engines: by matching (lp/matching/moat.c), unless
 * the user asks for the linear programme (lp/tjoin/tjoin.c) or the weights are too large for whole
 * numbers of 64 bits. */
#include "lp/tjoin/tjoin.h"
#include "lp/matching/blossom.h"

thr_status thr_tjoin_minimum(const thr_tjoin_problem *tjoin_problem, thr_engine engine,
                             const thr_limits *limits, thr_tjoin *out, thr_err *err)
{
  *out = (thr_tjoin){0};

  /* Matching is faster, but its sums of weights must fit into 64 bits. */
  if (engine == THR_ENGINE_AUTO) {
    bool fits = true;
    thr_status st = thr_moat_fits(tjoin_problem, &fits, err);
    if (st) {
      return st;
    }
    engine = fits ? THR_ENGINE_MATCHING : THR_ENGINE_LP;
  }

  if (engine == THR_ENGINE_LP) {
    return thr_tjoin_solve(tjoin_problem, limits, out, err);
  }
  return thr_moat_solve(tjoin_problem, limits, out, err);
}
