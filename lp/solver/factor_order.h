/* Order and pattern of the factors of A A^T, by blocks: consecutive columns of the factor with the same rows below them
 * (supernodes: J. W. H. Liu, E. G. Ng & B. W. Peyton, SIAM J. Matrix Anal. Appl. 14, 1993). Least degree (W. F. Tinney &
 * J. W. Walker, 1967) takes rows with the same neighbours as one, such as the six rows of a bead; blocks follow each other as
 * children and parents do, and are joined where that stores few zeros.
 *
 * Example: A A^T with the rows {0, 1} and {1, 2} joined: 0 and 2 go before 1, and no entry is added. */
#ifndef THR_FACTOR_ORDER_H
#define THR_FACTOR_ORDER_H

#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/solver/bundles.h"

typedef struct {
  int n_rows, n_blocks;
  int *place;  /* [n_rows] of a row in the order */
  int *first;  /* [n_blocks + 1] places of each block */
  size_t *end; /* [n_blocks + 1] where a block's rows end in below: end[b] .. end[b + 1] - 1 */
  int *below;  /* places below each block, ascending */
  thr_scratch own;
} thr_factor_order;

/* O(sum of squares of the factor's columns, by groups of rows). */
thr_status thr_factor_order_make(thr_factor_order *order, const thr_columns *a, thr_err *err) THR_MUST_CHECK;
void thr_factor_order_destroy(thr_factor_order *order);

#endif
