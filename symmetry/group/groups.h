/* Which groups of automorphisms are offered for a framework: all subgroups up to conjugacy where they can be listed, else the
 * isometries and what a few generators make. Internal to symmetry/.
 *
 * Example: of the square's group C4v: C1, C2, C4, two classes of mirrors, two of C2v, and C4v itself. */
#ifndef THR_SYMMETRY_GROUPS_H
#define THR_SYMMETRY_GROUPS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/symmetry.h"

/* Fills the groups of the table and its rows, without threadings; fewer when the limits say so. On failure the table can still be
 * destroyed. */
thr_status thr_symmetry_groups(const thr_frame *frame, const thr_request *options, const thr_limits *limits,
                               thr_symmetries *symmetries, thr_err *err) THR_MUST_CHECK;

#endif
