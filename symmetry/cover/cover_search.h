/* The search for the best whole solution of a programme (symmetry/cover/programme.h), aim by aim: when one is settled, or its
 * time is up, its value becomes a row and the next is minimized. Internal.
 *
 * Example: the least overlap is 0; then, with overlap 0 as a row, the fewest steps. */
#ifndef THR_COVER_SEARCH_H
#define THR_COVER_SEARCH_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/model/tree.h"
#include "symmetry/cover/programme.h"
#include "symmetry/cover/relaxation.h"

typedef struct {
  const thr_programme *p;
  const thr_limits *limits;
  thr_relaxation r; /* made when it is needed, with so many extra columns */
  int extra;
  int kept; /* so many aims, the first ones, have rows in r that keep them */
  bool found;
  bool lifted, valid; /* the last that was tried: are there turns for it, and can it be made concrete? */
  int *best;          /* [p->n] the best so far, if found */
  int *other;         /* [p->n] scratch */
  double worth[THR_N_AIMS], bound[THR_N_AIMS];
} thr_cover_search;

/* Without a solution, and with bounds of 0. */
thr_status thr_cover_search_init(thr_cover_search *s, const thr_programme *p, const thr_limits *limits,
                                 thr_err *err) THR_MUST_CHECK;
void thr_cover_search_destroy(thr_cover_search *s);

/* Keeps s->other if it can be made concrete and is better than the best so far; s->valid: can it? */
thr_status thr_cover_search_offer(thr_cover_search *s, thr_err *err) THR_MUST_CHECK;

/* Is the best so far as good as this bound? */
bool thr_cover_search_beaten(const thr_cover_search *s, thr_aim aim, double bound);

/* Minimizes the first n aims by branch and cut, best bound first, each with those before it kept. THR_ELIMIT: stopped;
 * THR_EINFEASIBLE: there is no solution. */
thr_status thr_cover_search_aims(thr_cover_search *s, int n, thr_err *err) THR_MUST_CHECK;

#endif
