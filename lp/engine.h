/* Minimum T-joins: which engine, shrinking first, and the word of a third party on the result. */
#ifndef THR_ENGINE_H
#define THR_ENGINE_H

#include "lp/tjoin.h"

/* As thr_tjoin_solve, by either engine: THR_ENGINE_LP is lp/tjoin.h, THR_ENGINE_MATCHING lp/moat.h (weights that do not
 * fit: THR_EINPUT). The problem is shrunk before (lp/shrink.h) where that pays: always for the linear
 * programme, for the matching if it loses many nodes. */
thr_status thr_tjoin_shrunk(const thr_tjoin_problem *p, thr_engine engine, const thr_limits *limits, thr_tjoin *out,
                            thr_err *err) THR_MUST_CHECK;

typedef enum {
  THR_CONFIRMED,      /* GLPK's exact rational simplex found the same value */
  THR_CONFIRM_SKIPPED /* the limits stopped it, or a library failed */
} thr_confirmation;

enum { THR_CONFIRM_EDGES = 10000 }; /* problems up to this size are confirmed well within a second */

/* Solves min weight x, x(cut) >= 1 for the cuts of t, x >= 0, with integer costs and a basis from the join, and compares: t being
 * optimal, the minimum is t->length by duality, or less than 1 below if rounding left the cuts' values so. THR_ESOLVER: it is
 * not, and t or GLPK is wrong. A library that fails confirms nothing, but is no error. */
thr_status thr_tjoin_confirm(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits, thr_confirmation *out,
                             thr_err *err) THR_MUST_CHECK;

typedef struct {
  bool always; /* whatever the size and the work; else of problems up to THR_CONFIRM_EDGES, with about a second's work */
  int confirmed, skipped; /* T-joins */
} thr_confirmations;

/* The same as *count says, and counted there; NULL: nothing is done. */
thr_status thr_tjoin_confirm_counted(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits,
                                     thr_confirmations *count, thr_err *err) THR_MUST_CHECK;

#endif
