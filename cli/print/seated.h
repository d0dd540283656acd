/* Prints which part of the gaps between pieces is closed by which pull, and by one cord or the other. */
#ifndef THR_CLI_SEATED_H
#define THR_CLI_SEATED_H

#include "graph/plan/plan.h"
#include "graph/text.h"

/* Of the plan's evaluation: after a schedule what its tensions seat; else the pulls, equal at all pulled ends, that seat a
 * quarter to all of the gaps, and up to eight cords pulled alone. Nothing if not every cord is known. */
void seated_put(thr_text *text, const thr_plan *plan);

#endif
