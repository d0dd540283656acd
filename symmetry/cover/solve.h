/* The best threading under each group of the table, and who gets how much of the time: all get a little, then those that are
 * open and may still be the best get more. Internal to symmetry/. */
#ifndef THR_SYMMETRY_SOLVE_H
#define THR_SYMMETRY_SOLVE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/symmetry.h"

/* Fills the rows that are asked for. With a deadline: first all rows, overlap and learned steps only; then, likewise, those that
 * may yet become the default choice; then what is left goes to all proofs, in equal shares, those with the fewest learned steps
 * first. only_choice: rows that another is sure to be chosen before are left out, and say which (thr_symmetry_row.behind). */
thr_status thr_symmetry_solve(const thr_frame *frame, const thr_request *options, bool only_choice, const thr_limits *limits,
                              thr_symmetries *symmetries, thr_err *err) THR_MUST_CHECK;

/* What the shortest cords with tube joints need, in units: few, and the cords need not be closed: with one cord in each
 * component, or else as few as can be; otherwise any number of cords. Closed cords can always be joined to one. *optimal = false:
 * what the shortest that was found in time needs, or if none was, what the edges need. */
thr_status thr_symmetry_shortest_tied(const thr_frame *frame, const thr_request *options, bool few, const thr_limits *limits,
                                      double *length, bool *optimal, thr_err *err) THR_MUST_CHECK;

/* group: as in thr_symmetry_options. */
bool thr_symmetry_asked(const thr_symmetries *symmetries, int row, const char *group);

#endif
