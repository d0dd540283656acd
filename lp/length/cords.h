/* The shortest plan with any number of cords: passes (lp/length/postman.h), shared out among cords (lp/length/decomposition.h,
 * lp/length/balance.h); for a length limit with more and more cords until none is longer.
 *
 * Example: a framework of 12 m of passes, no cord longer than 5 m: three cords at least, ceil(12 / 5). */
#ifndef THR_CORDS_H
#define THR_CORDS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/length/decomposition.h"

/* What is known beyond what graph/check/check.c can verify, for the one who asked. */
typedef struct {
  bool passes_least; /* these passes are the shortest that hold the cords: found by an exact method whose proof is not recorded */
  bool longest_least; /* balance: with as many cords, no longest cord is shorter: the word of an integer programme */
} thr_cords_word;

/* Plans options.cords_least .. options.cords cords (with THR_ENDS_COUNTS, as many as the counts say) in a framework of one
 * component, or one cord in each of several:
 * - usually the shortest passes of all, and the fewest cords through them, cut where they turn most;
 * - balance: the longest cord is made as short as the search finds, extra passes included;
 * - max_length: the fewest cords none of which is longer, as far as the search finds them.
 * word may be NULL. THR_OK: what was asked to be least is proved to be. THR_ELIMIT: the plan is valid and says its bounds.
 * An empty plan, too: none was found. THR_EINFEASIBLE: there is none (says why). Otherwise the plan is empty. */
thr_status thr_cords_plan(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                          thr_cords_word *word, thr_err *err) THR_MUST_CHECK;

/* ---- shared with tube joints, and with frameworks of several components (planner/length.c) ---- */

/* THR_EINFEASIBLE, said: an edge that no cord within options.max_length can pass, coming from where it may end and going where it
 * may end. */
thr_status thr_cords_reach(const thr_frame *frame, const thr_request *options, thr_err *err) THR_MUST_CHECK;

/* For a limit on the length: tries n cords, from the fewest that cords of this length together leave possible up to
 * options.cords, in larger steps after some, until *done. THR_EINFEASIBLE as above. */
typedef thr_status thr_cords_try(thr_decomposition *decomposition, void *with, int n, bool *done, thr_err *err);
thr_status thr_cords_grow(thr_decomposition *decomposition, double length, thr_cords_try *try_number, void *with, bool *done,
                          thr_err *err) THR_MUST_CHECK;

/* Is what was asked to be least proved to be, by the plan's claims? Else THR_ELIMIT, and how far it may be off; unproved: what is
 * to be said before that, if anything. */
thr_status thr_cords_judge(const thr_plan *plan, const thr_err *unproved, thr_err *err) THR_MUST_CHECK;

#endif
