/* Solves minimum T-join problems by one of two engines, and asks GLPK whether the result is the minimum.
 *
 * Matching (lp/matching/moat.h) is the engine, unless the user asks for the linear programme (lp/tjoin/tjoin.h) or the weights
 * are too large for whole numbers of 64 bits. */
#ifndef THR_ENGINE_H
#define THR_ENGINE_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

/* Computes the same as thr_tjoin_solve: THR_ENGINE_LP by thr_tjoin_solve itself, THR_ENGINE_MATCHING by thr_moat_solve (which
 * returns THR_EINPUT for weights that do not fit), THR_ENGINE_AUTO by matching if the weights fit. */
thr_status thr_tjoin_minimum(const thr_tjoin_problem *tjoin_problem, thr_engine engine, const thr_limits *limits, thr_tjoin *out,
                             thr_err *err) THR_MUST_CHECK;

enum { THR_CONFIRM_EDGES = 10000 }; /* problems up to this size are confirmed well within a second */

/* T-joins that GLPK is asked about: it solves min weight x, x(cut) >= 1 for the cuts of t, x >= 0, with integer costs and a basis
 * from the join; t being optimal, the minimum is t->length by duality, or less than 1 below if rounding left the cuts' values so.
 */
typedef struct thr_confirm_job thr_confirm_job;
typedef struct {
  bool always; /* whatever the size and the work; else problems up to THR_CONFIRM_EDGES, with about a second's work each */
  int confirmed, skipped; /* GLPK's exact rational simplex found the same value; the limits stopped it, or a library failed */
  int n_jobs, capacity;
  thr_confirm_job *job; /* owned, until they are run */
} thr_confirmations;

/* Remembers a T-join as optimal and to be asked about; confirmations NULL: nothing is done. O(entries of its cuts). */
thr_status thr_confirmations_add(thr_confirmations *confirmations, const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                 thr_err *err) THR_MUST_CHECK;

/* Asks about all that were added, in a child process, and counts. THR_ESOLVER: GLPK finds another minimum, so that a join or GLPK
 * is wrong. A library that fails, or a child that dies, confirms nothing, but is no error. */
thr_status thr_confirmations_run(thr_confirmations *confirmations, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_confirmations_destroy(thr_confirmations *confirmations);

typedef enum { THR_CONFIRMED, THR_CONFIRM_SKIPPED } thr_confirmation;

/* The same for one, whatever its size. */
thr_status thr_tjoin_confirm(const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin, const thr_limits *limits,
                             thr_confirmation *out, thr_err *err) THR_MUST_CHECK;

#endif
