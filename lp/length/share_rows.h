/* What the integer programmes for several cords of a small component have in common. Internal to lp/. */
#ifndef THR_SHARE_ROWS_H
#define THR_SHARE_ROWS_H

#include "lp/solver/lp.h"
#include "lp/length/share.h"

/* Every cord has block columns, one cord after the other: first its passes of every edge, then whether it passes them. */
typedef struct {
  const thr_share *s;
  int n_cords, block;
  int n_edges, *edge; /* of the component; numbers in the framework */
  double most;        /* passes of an edge by a cord */
  thr_lp *lp;
  int n, *column; /* entries of the row at hand; room for all columns */
  double *value;
  double *x; /* of the solution */
} thr_share_rows;

/* Frees edge, lp, the row and x. */
void thr_share_rows_destroy(thr_share_rows *r);

/* Room for a row and x, once n_cords and block are known. */
thr_status thr_share_rows_init(thr_share_rows *r, thr_err *err) THR_MUST_CHECK;

static inline int thr_share_passes(const thr_share_rows *r, int c, int e)
{
  return c * r->block + e;
}

static inline int thr_share_used(const thr_share_rows *r, int c, int e)
{
  return c * r->block + r->n_edges + e;
}

void thr_share_put(thr_share_rows *r, int column, double value);

/* Ends the row: sum >= lower, and with both also sum <= lower. */
thr_status thr_share_row(thr_share_rows *r, double lower, bool both, thr_err *err) THR_MUST_CHECK;

/* Passes of every edge by all cords: no fewer than its cover, no more than its capacity. */
thr_status thr_share_covers(thr_share_rows *r, thr_err *err) THR_MUST_CHECK;

/* Passes of cord c only of edges that are used, some of them; no longer than limit (INFINITY: none), nor than the cord before. */
thr_status thr_share_lengths(thr_share_rows *r, int c, double limit, thr_err *err) THR_MUST_CHECK;

#endif
