/* The table of groups, and how the cords of a symmetric plan are copies of each other. */
#ifndef THR_CLI_SYMMETRY_TABLE_H
#define THR_CLI_SYMMETRY_TABLE_H

#include "cli/cli.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/text.h"
#include "symmetry/symmetry.h"

/* "8 automorphisms, ..": the group, its orbits, and what was not listed. */
void symmetry_put_head(thr_text *text, const thr_frame *frame, const thr_request *options, const thr_symmetries *symmetries);

/* At most `most` rows, those before and behind the chosen one if there are more (with --group, only the rows that were asked
 * for), and why it was chosen. */
void symmetry_put_table(thr_text *text, const thr_request *options, const thr_symmetries *symmetries, int most);

/* "A: unique, 9 learned steps; B, C, D: copies of A by C4, C2, C4^3", and the learned steps of all. */
void symmetry_put_paths(thr_text *text, const thr_plan *plan);

/* The table as members of an object that is left open, the first without a comma before it. */
void symmetry_put_table_json(thr_writer *writer, const thr_request *options, const thr_symmetries *symmetries);

/* Group and paths of a plan as members of an object, each with a comma before it. */
void symmetry_put_json(thr_writer *writer, const thr_plan *plan);

#endif
