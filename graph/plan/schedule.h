/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is done to the cords after threading, in order: pulled, gripped on the way, let down,
 * knotted. The tensions that a schedule leaves in every pass follow from it (eval/cord/history.c),
 * and the checker computes them again.
 *
 *   A: grip 37 18.5 from start   is drawn out at its pass 37, from the side of its start, by 18.5 N
 *   A: pull end 20               its end is pulled with 20 N, and held
 *   A: release end 2             its end is let down to 2 N
 *   A: knot end 0.5              its end is tied; the knot gives way by 0.5 mm
 *   B: none                      stays slack: its only step */
#ifndef THR_SCHEDULE_H
#define THR_SCHEDULE_H

#include "graph/plan/plan.h"

const char *thr_deed_name(int deed); /* "pull", "grip", "release", "knot", "none" */

/* Adds a step; THR_ENOMEM. */
thr_status thr_schedule_add(thr_schedule *schedule, const thr_schedule_step *step,
                            thr_err *err) THR_MUST_CHECK;
void thr_schedule_destroy(thr_schedule *schedule);

/* The largest force, N, that a hand pulls cord i with, or all cords (i < 0). 0 if it never does. */
double thr_schedule_hardest(const thr_schedule *schedule, int i);
int thr_schedule_steps(const thr_schedule *schedule, int i); /* of cord i */
bool thr_schedule_slack(const thr_schedule *schedule,
                        int i); /* Does it leave cord i slack on purpose? */
int thr_schedule_grips(const thr_schedule *schedule, int i); /* of cord i, or of all (i < 0) */
int thr_schedule_pulls(const thr_schedule *schedule); /* grips too; both ends at once are one */

/* Returns whether both ends of cord i are knotted at last: nothing that is done to either end comes
 * after its knot. */
bool thr_schedule_knotted(const thr_schedule *schedule, int i);

/* Text as above: "CORD: pull|release END N", "CORD: grip PASS N [from END]", "CORD: knot END [MM]",
 * "CORD: none"; END is start, end or both; CORD an id of the plan's, or "all"; PASS counts from 1
 * as in steps.txt, or is the names of the two nodes of an edge that the cord passes once. Steps end
 * with a line or a semicolon; # begins a comment. THR_EINPUT with name and line: what is wrong, and
 * what is expected. O(text x passes). Release with thr_schedule_destroy, also after a failure. */
thr_status thr_schedule_parse(thr_schedule *schedule, const thr_plan *plan, const char *text,
                              size_t n, const char *name, thr_err *err) THR_MUST_CHECK;

/* A step in the words of that text; for grips with the nodes on both sides in brackets. */
void thr_schedule_put_step(const thr_plan *plan, const thr_schedule_step *step, thr_text *text);

/* The member "schedule" of an evaluation, and reading it: shapes and ranges are checked against
 * n_cords; passes by the checker.
 */
void thr_schedule_write(const thr_schedule *schedule, thr_writer *writer, const char *key);
thr_status thr_schedule_from_json(thr_schedule *schedule, const thr_json *array, int n_cords,
                                  const char *place, thr_err *err) THR_MUST_CHECK;

#endif
