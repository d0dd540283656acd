/* What `thread plan` says of a plan: its cords, their length, turning and pull. */
#ifndef THR_CLI_PLAN_SUMMARY_H
#define THR_CLI_PLAN_SUMMARY_H

#include "cli/print/turning_summary.h"
#include "lp/length/postman.h"

/* rivals: for a plan of the least turning, what it is held against; NULL for others. word: what is known beyond what is verified.
 */
void plan_put_summary(thr_text *text, const thr_plan *plan, const thr_rivals *rivals, thr_cords_word word);

/* The same as members of an object that is left open. */
void plan_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals, thr_cords_word word);

#endif
