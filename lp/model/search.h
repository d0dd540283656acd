/* Rounds of cutting: a linear programme is solved, its optimum is looked at, and rows that it violates are added, until there are
 * none or the bound suffices.
 *
 * Dantzig, Fulkerson & Johnson, Operations Research 2, 1954; at every node of a tree of bounds (lp/model/tree.h) it is branch and
 * cut (Padberg & Rinaldi, SIAM Review 33, 1991). What finds rows is handed in, the cheap before the dear, and so is what is made
 * of an optimum: a solution near it, a proof from its multipliers, the judgement that its bound suffices.
 *
 *   thr_search_init(&s, n, x, &err);             and s.lp, a programme of those columns
 *   thr_search_use(&s, find_some, user, 0);
 *   thr_search_use(&s, find_all, user, THR_FALLBACK);   where that has found none
 *   thr_search_rounds(&s, &calls, &limits, &err); */
#ifndef THR_SEARCH_H
#define THR_SEARCH_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/model/pool.h"
#include "lp/solver/lp.h"

/* Adds rows that the point violates to the pool, counted in *added. */
typedef thr_status thr_separator(void *user, int *added, thr_err *err);

/* When a separator is asked: only where those before have found none in this round; not when the limits say stop, which ends the
 * rounds. */
enum { THR_FALLBACK = 1, THR_SLOW = 2 };

typedef struct {
  thr_lp *lp;             /* owned */
  thr_pool pool;          /* its rows after the first n_fixed; the last of them may not be in it yet */
  int n_fixed, help;      /* help: a column of value 1 in every row of the pool, which keeps it feasible; at first -1: none */
  bool bare;              /* the next solve begins without the pool's rows, for which its basis is not feasible */
  double *x;              /* [columns of lp] borrowed: the point of the last solve */
  int n_dual;             /* rows at the last solve */
  double *dual;           /* [n_dual] its multipliers; owned */
  double objective;       /* its value */
  thr_lp_outcome outcome; /* its outcome; THR_LP_STOPPED also where a slow separator was not begun */
  bool whole, enough;     /* what thr_search_calls.look says of it */
  double at_drop;         /* objective when rows were last dropped */
  int n_separators;
  struct {
    thr_separator *find;
    void *user;
    int when;
  } separator[8];
} thr_search;

/* What is done in every round. */
typedef struct {
  void *user;
  const char *name; /* of a programme that always has an optimum: none is THR_ESOLVER; NULL = it may have none */
  /* Solves s->lp; NULL = thr_lp_solve. */
  thr_status (*solve)(void *user, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err);
  /* Of the last solve, whatever its outcome: s->enough: no more rows are needed; s->whole: it is no fractional point. */
  thr_status (*look)(void *user, thr_err *err);
  int most_rounds; /* for points that are not whole; 0 = any number */
  int patience;    /* rows slack for more rounds than this go, if all rows are the pool's; 0 = none goes */
} thr_search_calls;

/* Without a programme. pool_columns: of the pool's rows. x must outlive it. */
thr_status thr_search_init(thr_search *s, int pool_columns, double *x, thr_err *err) THR_MUST_CHECK;
void thr_search_destroy(thr_search *s);

/* One more separator, asked after those before: at most 8. when: 0, THR_FALLBACK, THR_SLOW or both. */
void thr_search_use(thr_search *s, thr_separator *find, void *user, int when);

/* Adds the pool's rows that are not in the programme yet. */
thr_status thr_search_load(thr_search *s, thr_err *err) THR_MUST_CHECK;

/* Until no row is violated, the last look has found the bound enough, or there is no optimum: outcome says which. */
thr_status thr_search_rounds(thr_search *s, const thr_search_calls *calls, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

#endif
