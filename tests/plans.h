/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Requests, the plans that answer them, and what is asserted of every plan. Builders assert that
 * they succeed. */
#ifndef THR_TEST_PLANS_H
#define THR_TEST_PLANS_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "lp/length/postman.h"
#include "planner/planner.h"
#include "tests/frameworks.h"

/* ---- requests ---- */

/* Asks for these aims, a list as thr_aims_parse reads; prices of turns and the slack of the length
 * stay as they are. */
void want(thr_request *o, const char *aims);

/* A plan of the least length, as the planner makes it. word: NULL = not wanted. */
thr_status length_plan(const thr_frame *f, const thr_request *o, const thr_limits *limits,
                       thr_plan *p, thr_cords_word *word, thr_err *err);

/* ---- plans ---- */

thr_request options_for(thr_ends ends, int cover);
thr_plan plan_make(const thr_frame *f, const thr_request *o);
thr_plan plan_simple(const thr_frame *f, thr_ends ends, int cover);

/* Plan of o->cords cords through the shortest passes of a connected framework with ends; the proof
 * is the postman's. Its cords are a walk's pieces, cut where an end may be: fails if there are too
 * few such places. */
thr_plan plan_of_cords(const thr_frame *f, const thr_request *o);

/* Appends so many closed cords there and back over an edge, and counts them in *n. */
void add_loops(thr_cord *cord, int *n, int edge, int count);

thr_text plan_text(const thr_plan *p);
thr_plan plan_from(const char *text);

void assert_same_text(const thr_text *a, const thr_text *b);

/* Asserts that the checker agrees, that JSON survives a round trip byte for byte. */
void assert_plan_sound(const thr_plan *p);

/* The checker agrees. */
void assert_holds(const thr_plan *p);

/* It does not, in one line that contains word (NULL: any); nor after a round trip through JSON. */
void assert_violated(const thr_plan *p, const char *word);

/* Status of thr_plan_parse and, if it parses, thr_check_plan. */
thr_status judge_text(const char *text, size_t n, thr_err *err);

/* Status after a round trip of an altered plan. */
thr_status judge_plan(const thr_plan *p, thr_err *err);

#endif
