/* The cuts of a T-join as rows of a linear programme: minimize weight x, x(cut) >= 1 for every cut, x >= 0; and a basis of it
 * that the join gives. Internal to lp/. */
#ifndef THR_CUTBASIS_H
#define THR_CUTBASIS_H

#include "lp/tjoin.h"

/* The edges that leave the set of cut i are edge[first[i] .. first[i + 1] - 1]. */
typedef struct {
  int *tree; /* [n_cuts] the outermost cut round cut i, or i; owned */
  int *first, *edge;
} thr_cut_rows;

/* Children come before their parents in t's forest. O(entries + nodes named + edges * trees that name one of their ends). Release
 * with thr_cut_rows_destroy, after a failure too. */
thr_status thr_cut_rows_init(thr_cut_rows *r, const thr_tjoin_problem *p, const thr_tjoin *t, thr_err *err) THR_MUST_CHECK;
void thr_cut_rows_destroy(thr_cut_rows *r);

/* Marks a basis: of row[n_cuts] those whose slack is basic, of column[n_edges] the basic edges; as many together as there are
 * rows, never singular. Its point is the join (without edges of weight 0 that leave no set). If the cuts prove the join to the
 * last unit and no node is named twice, the basis is mostly optimal as well: where the duals are not unique, they are moved until
 * they are a vertex. That takes O((entries + edges) log cuts). */
thr_status thr_cut_basis(const thr_cut_rows *r, const thr_tjoin_problem *p, const thr_tjoin *t, bool *row, bool *column,
                         thr_err *err) THR_MUST_CHECK;

#endif
