/* What of a load is carried, in words and as JSON. */
#ifndef THR_LOAD_WORDS_H
#define THR_LOAD_WORDS_H

#include "eval/eval.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/text.h"

/* A line per pull, and one of what is carried after the schedule if there was one. */
void load_put(thr_text *text, const thr_plan *plan, const thr_eval *eval);
/* Member "load": a list of pulls, and "after". */
void load_put_json(thr_writer *writer, const thr_frame *frame, const thr_eval *eval);

#endif
