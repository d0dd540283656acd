/* What the bounds of a cover prove of threadings as a plan counts them. Internal.
 *
 * The programme of a cover differs from a plan (thr_symmetry_record, thr_metrics) in three ways. It tells cords that run through
 * the same nodes apart; it takes the two passes of a cord that turns back over an edge which the group leaves where it is for
 * images of each other, so that one is learned with the other; and with ends anywhere it counts every turn of a closed cord, of
 * which a plan leaves one out. */
#ifndef THR_CLAIMS_H
#define THR_CLAIMS_H

#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/group/quotient.h"

/* Cords can run alike where an edge needs several passes. Elsewhere, of threadings that run alike in part, or round several
 * times, one has no more overlap, steps, paths or turning than the others and no cords alike. */
typedef struct {
  bool repeats;             /* a part of the framework has cords that may run alike: weaker bounds */
  bool retraces;            /* the plan has more steps than the cover, and so may threadings that are no better than it */
  double least[THR_N_AIMS]; /* of every threading under H with the aims before at most at the plan's values */
} thr_claims;

/* cover: with a cover; steps: of the plan that is made of it. O(order * edges + types); and a T-join where overlap comes after an
 * aim that a plan counts otherwise. */
thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options, const thr_cover *cover, double steps,
                           thr_claims *out, thr_err *err) THR_MUST_CHECK;

#endif
