/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The groups that a plan may repeat by, the largest first, and the order of permutations.
 * symmetry/group/group.h says in which order to read the room. */
#ifndef THR_GROUPS_H
#define THR_GROUPS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/symmetry.h"

/* ---- groups.c: Which groups of automorphisms are offered for a framework: all subgroups up to
 * conjugacy where they can be listed, else the isometries and what a few generators make. */

/* Fills the groups of the table and its rows, without threadings; fewer when the limits say so. On
 * failure the table can still be destroyed. */
thr_status thr_symmetry_groups(const thr_frame *frame, const thr_request *options,
                               const thr_limits *limits, thr_symmetries *symmetries,
                               thr_err *err) THR_MUST_CHECK;

/* ---- rows.c: Permutations as rows of images, in lexicographic order, so that equal ones are found
 * by bisection. */

/* Sorts count rows of n ints. order: [count] receives which row comes first, second, .., as
 * numbered before; NULL = not asked. */
thr_status thr_rows_sort(int *row, int count, int n, int *order, thr_err *err) THR_MUST_CHECK;

#endif
