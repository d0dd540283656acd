/* How cords are tightened, in words: the steps of a plan's schedule (graph/plan/schedule.h), for steps.txt and the booklet. */
#ifndef THR_TIGHTEN_H
#define THR_TIGHTEN_H

#include "diagram/overview/guide.h"
#include "graph/plan/evaluation.h"

/* "Cord A, pass 25: grip it between E5 and D5 and draw it from the side of its start, with 15 N; hold it until the next has taken
 * its slack." Places are the guide's. */
void thr_tighten_step(const thr_plan *plan, const thr_guide *guide, const thr_schedule_step *step, thr_text *words);

#endif
