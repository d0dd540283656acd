/* The cuts of a T-join as a linear programme, and a basis of it that the join gives, so that GLPK needs no pivot to confirm the
 * optimum. Internal to lp/.
 *
 * Minimize the sum of w(e) x(e) with x(edges that leave S) >= 1 for every set S of the nest; the basic columns are tight edges
 * that span each level of the nest.
 *
 * Example: one odd set S with two edges of weight 2 and 3 leaving it: the row x1 + x2 >= 1, basic x1 = 1, dual 2. */
#ifndef THR_CUTBASIS_H
#define THR_CUTBASIS_H

#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

/* Minimize weight x, x(cut i) - s[i] = 1 for every cut, x >= 0, s >= 0, with the equations of the cuts right inside of a cut
 * taken off its own: of the edges that leave both nothing is left, so that nests however deep have few entries. Columns: the
 * edges, then the slacks s; by columns, as thr_lp_create_equations takes it. All arrays are owned. */
typedef struct {
  int n_rows, n_columns; /* cuts; edges and cuts */
  double *rhs;           /* [n_rows] */
  int *start, *row;
  double *value;
  bool *basic; /* [n_columns] n_rows of them, a nonsingular matrix */
} thr_cut_programme;

/* If the cuts prove tjoin to the last unit and no node is named twice, as those of lp/matching/moat.h, the point of the basis is
 * the join (without edges of weight 0 that leave no set). Where the duals are not unique they are moved until they are a vertex:
 * mostly the basis is optimal as well; it need not be where sets inside of others hang by too few tight edges, as after
 * shrinking. Otherwise it is a basis with as much of the join as has cuts for itself. O(edges * depth + edges log cuts). Children
 * must come before their parents in tjoin's forest. On failure nothing is allocated. Release with thr_cut_programme_destroy. */
thr_status thr_cut_programme_init(thr_cut_programme *cut_programme, const thr_tjoin_problem *tjoin_problem,
                                  const thr_tjoin *tjoin, thr_err *err) THR_MUST_CHECK;
void thr_cut_programme_destroy(thr_cut_programme *cut_programme);

#endif
