/* Prints which part of the gaps between pieces is closed by which pull, and by one cord or the other. */
#ifndef THR_CLI_SEATED_H
#define THR_CLI_SEATED_H

#include "graph/io/writer.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/text.h"

/* Of the plan's evaluation: after a schedule what its tensions seat; else the pulls, equal at all pulled ends, that seat a
 * quarter to all of the gaps, and up to eight cords pulled alone. Nothing if not every cord is known. */
void seated_put(thr_text *text, const thr_plan *plan);

/* Appends the line, with `label` before it, that says what holding the pieces together takes where that is more than what seats
 * them, or that it was left out as they are too many. Nothing if it is no more or not decided, or the pieces are tubes.
 * evaluation: of the plan's cords, pulled until they are seated. */
void seated_put_holding(thr_text *text, const char *label, const thr_plan *plan, const thr_evaluation *evaluation);
/* The same as members: "holds_from", N at the hardest end, and null if no pull holds; none if that is not decided. */
void seated_put_holding_json(thr_writer *writer, const thr_plan *plan, const thr_evaluation *evaluation);

#endif
