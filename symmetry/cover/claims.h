/* What the bounds of a cover prove of threadings as a plan counts them. Internal.
 *
 * The programme of a cover differs from a plan (thr_symmetry_record, thr_metrics) in two ways. It tells cords that run through
 * the same nodes apart; and with ends anywhere it counts every turn of a closed cord, of which a plan leaves one out. */
#ifndef THR_CLAIMS_H
#define THR_CLAIMS_H

#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/group/quotient.h"

/* Cords can run alike where an edge needs several passes; a cord can run back the way it came from a node with one edge where no
 * cord may end, if another such node or an end is where it began. Elsewhere, of threadings that run alike in part, one has no
 * more overlap, steps, paths or turning than the others and no cords alike. */
typedef struct {
  bool repeats;             /* a part of the framework has cords that may run alike: weaker bounds */
  double least[THR_N_AIMS]; /* of every threading under H with the aims before at most at the cover's values */
} thr_claims;

/* cover: with a cover. O(order * edges + types); and a T-join where overlap comes after an aim that a plan counts otherwise. */
thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options, const thr_cover *cover,
                           thr_claims *out, thr_err *err) THR_MUST_CHECK;

#endif
