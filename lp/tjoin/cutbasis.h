/* The cuts of a T-join as a linear programme, and a basis of it from the join, so that GLPK needs few pivots to confirm the
 * optimum. Internal to lp/.
 *
 * Minimize the sum of w(e) x(e) with x(edges that leave S) >= 1 for every set S among the cuts.
 *
 * Example: one odd set S with two edges of weight 2 and 3 leaving it: the row x1 + x2 >= 1, basic x1 = 1. */
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

/* Writes the programme. Basic are edges of the join that leave a cut which no other edge of the join leaves, and the slacks of
 * all other cuts. If the cuts prove tjoin to the last unit, that point is the join (but for edges that leave no cut), which GLPK
 * then only has to price; otherwise it need not be feasible. Children must come before their parents in tjoin's forest.
 * O(edges * depth). On failure nothing is allocated. Release with thr_cut_programme_destroy. */
thr_status thr_cut_programme_init(thr_cut_programme *cut_programme, const thr_tjoin_problem *tjoin_problem,
                                  const thr_tjoin *tjoin, thr_err *err) THR_MUST_CHECK;
void thr_cut_programme_destroy(thr_cut_programme *cut_programme);

#endif
