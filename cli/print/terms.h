/* Of which plans the claims of a plan speak, in words: a proof without its terms can be taken for more than it is. */
#ifndef THR_CLI_TERMS_H
#define THR_CLI_TERMS_H

#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/text.h"

/* Indented lines: what plans the claims are about (ends, passes, cords, joints, lengths), what is proved of the length slack,
 * and which statements of the plan nobody can verify, if there are any. */
void terms_put(thr_text *text, const thr_plan *plan);

/* The same as members of a JSON object, from ", " on. */
void terms_put_json(thr_writer *writer, const thr_plan *plan);

#endif
