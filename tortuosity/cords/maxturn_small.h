/* The largest turning of any cord in small components, or that of all cords: exact, by the table of
 * graph/threading/small_cords.h. */
#ifndef THR_MAXTURN_SMALL_H
#define THR_MAXTURN_SMALL_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"

/* Cords of which the one that turns most turns least (even), or that turn least together, as many in every component as the
 * n_cords given ones are, which they are or improve. *found false: a component is too large, or the table's cords pass an edge
 * too often or are too long for the task; then j is as it was. */
thr_status thr_max_turning_small(const thr_turning_columns *turning_columns, const thr_cord *cord, int n_cords, bool even,
                                 const thr_limits *limits, thr_join *j, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
