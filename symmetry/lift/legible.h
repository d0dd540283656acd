/* Cords of a symmetric cover that are read in fewer instructions (graph/plan/reading.h), with every aim at the value it has: two
 * turns of a node, in all their images, exchange their partners where that turns no more.
 *
 * Example: two stairs over a grid that go right and then up here, up and then right there, become stairs that are one the other
 * moved along, which is read once. */
#ifndef THR_LEGIBLE_H
#define THR_LEGIBLE_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/group/quotient.h"

/* What a threading is for whoever has to do it. */
typedef struct {
  thr_cord *cord; /* [n_cords] owned */
  int n_cords;
  thr_symmetry_record record; /* owned */
} thr_threading;

/* Changes the cover and its cords, exchange by exchange, until none is left that needs fewer instructions, the work is done (it
 * is counted), or the limits stop it. As many cords and unique paths stay, with as many steps; turning, the cord that is pulled
 * hardest and the longest cord become no more; what is asked of the cords is kept as it was. *instructions: what is read then. */
thr_status thr_legible_cords(const thr_quotient *quotient, const thr_cover_options *options, const thr_request *request,
                             const thr_limits *limits, thr_cover *cover, thr_threading *threading, int *instructions,
                             thr_err *err) THR_MUST_CHECK;

#endif
