/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans of all sorts, for what is drawn or written of any plan. */
#ifndef THR_SAMPLE_PLANS_H
#define THR_SAMPLE_PLANS_H

#include "tests/symmetric.h"
#include "graph/plan/plan.h"

thr_plan plan_of(thr_frame f, thr_ends ends, int cover); /* takes the framework */

/* Takes the framework. group "" = the default choice. */
thr_plan symmetric_plan(thr_frame f, thr_ends ends, int cover, const char *group);

/* Closed and open cords, one and several, covers of 1 to 3, several pieces, symmetric plans of
 * groups small and large. */
thr_plan plan_number(int i);
enum { N_PLANS = 14 };

#endif
