/* The bound that one leaf's multipliers prove, and its parts. Private to the checker of turning proofs. */
#ifndef THR_TURNING_LEAF_H
#define THR_TURNING_LEAF_H

#include "graph/framework/frame.h"
#include "graph/plan/prices.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct {
  const thr_turning_columns *c;
  const thr_turning_dual *d;
  thr_scratch own;    /* the arrays */
  thr_wide *reduced;  /* [n_columns] price less what the multipliers take */
  bool *member;       /* [2 * n_edges + n_ends] all false between sets */
  thr_wide *constant; /* [n_components + 1] what the multipliers take in a component; last, what sets of several do, >= 0 */
  thr_wide limit;     /* what the multiplier of the length takes off the sum, >= 0 */
  int *of_ends;       /* [n_ends] component of an equation of ends */
  int *edges;         /* [n_components] */
  bool *open;         /* [n_components] may cords end there? */
  bool ranked;        /* connections are counted exactly where they can be */
} thr_turning_leaf;

static inline int thr_turning_leaf_component(const thr_turning_leaf *k, int h)
{
  return k->c->component[k->c->f->edge[h >> 1][0]];
}

/* What the multipliers leave of all prices, and the sum of what they take. Release own with thr_scratch_free, after a failure
 * too. */
thr_status thr_turning_leaf_init(thr_turning_leaf *k, const thr_turning_columns *turning_columns, const thr_turning_dual *dual,
                                 thr_err *err) THR_MUST_CHECK;

/* What column j adds to the least value, between these bounds. With multipliers below 2^58 and sets below 2^62 together, reduced
 * prices stay below 2^63, and nothing here comes near 2^127. */
thr_wide thr_turning_leaf_adds(const thr_turning_leaf *k, int j, int least, int most);

/* The nearest that 64 bits hold. */
int64_t thr_turning_in_64_bits(thr_wide total);

#endif
