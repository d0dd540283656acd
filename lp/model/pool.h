/* The rows of a relaxation that separation has found: sum value x[column] >= lower (a pool of cuts).
 *
 * After Padberg & Rinaldi, SIAM Review 33, 1991. The pool says whether a point x violates a row, knows a row that it has already,
 * and forgets rows that have been slack for long. It solves nothing: its rows may stand in a linear programme (lp/model/search.h)
 * or be prices of a Lagrangian relaxation.
 *
 * A row is put together column by column and then added, or only if a point violates it and the pool has none like it:
 *   thr_pool_put(pool, 3, 1);
 *   thr_pool_put(pool, 7, 1);
 *   st = thr_pool_offer(pool, (thr_row){.lower = 1}, x, 1e-6, &added, err);   x[3] + x[7] >= 1 */
#ifndef THR_POOL_H
#define THR_POOL_H

#include "graph/status.h"

#include <stdint.h>

typedef struct {
  uint64_t name;   /* 0 = its columns, values and lower bound, which the pool then makes a name of */
  int kind, index; /* what it is the row of; the caller's */
  int n_members;   /* the same, where one number does not say it: a set, the blocks of a partition */
  int *member;     /* [n_members] or NULL; copied */
  double lower;    /* the right side; the rest is filled in by the pool */
  int n, *column;  /* [n] in the order in which they were put */
  double *value;   /* [n]; NULL = all 1 */
  int idle;        /* consecutive looks at which it was slack */
} thr_row;

typedef struct {
  int n_columns, count, capacity;
  thr_row *row;
  uint64_t *seen; /* open-addressed set of names */
  int seen_size, seen_used;
  double *sum;   /* [n_columns] coefficients of the row that is being put together */
  bool *drafted; /* [n_columns] does it stand in draft? */
  int *draft, n_draft;
} thr_pool;

/* For points x[n_columns]. */
thr_status thr_pool_init(thr_pool *p, int n_columns, thr_err *err) THR_MUST_CHECK;
void thr_pool_destroy(thr_pool *p);

/* Adds all rows of another pool for the same columns. */
thr_status thr_pool_copy(thr_pool *p, const thr_pool *from, thr_err *err) THR_MUST_CHECK;

/* Adds value to the coefficient of a column, in the row that is being put together. */
void thr_pool_put(thr_pool *p, int column, double value);

/* Is there a row of this name? */
bool thr_pool_knows(const thr_pool *p, uint64_t name);

/* The row that was put together becomes one of the pool, whatever is there already. */
thr_status thr_pool_add(thr_pool *p, thr_row row, thr_err *err) THR_MUST_CHECK;

/* The same if it is new and x violates it by more than the tolerance, counted in *added; else it is forgotten. */
thr_status thr_pool_offer(thr_pool *p, thr_row row, const double *x, double tolerance, int *added, thr_err *err) THR_MUST_CHECK;

/* sum value x[column] */
double thr_row_sum(const thr_row *r, const double *x);

/* reduced[column] -= price * value: what a row of this price leaves of the costs. */
void thr_row_charge(const thr_row *r, double price, double *reduced);

/* Forgets the rows marked in drop[count], which may be found again; the others keep their order. */
void thr_pool_drop(thr_pool *p, const bool *drop);

/* Forgets those from number `first` on that x does not violate by more than the tolerance. *added grows by the others. */
thr_status thr_pool_keep_violated(thr_pool *p, int first, const double *x, double tolerance, int *added,
                                  thr_err *err) THR_MUST_CHECK;

#endif
