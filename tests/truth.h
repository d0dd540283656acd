/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is true of several cords in small frameworks, by trying: the oracle of the adversary. Shares
 * no code with the checker. */
#ifndef THR_TRUTH_H
#define THR_TRUTH_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"

enum {
  TRUTH_NODES = 8,
  TRUTH_EDGES = 8,
  TRUTH_TABLE_EDGES = 6
}; /* at most, in all components together; for tables */

/* The least length of all cords together with solid joints, options.cords_least .. options.cords of
 * them in every component, and passes[n_edges] that have it (NULL ok). INFINITY if there are none.
 * Given numbers of ends: of passes that were found, perhaps not the least. Passes hold K closed
 * cords if they fall into K circuits, else if the nodes where ends may be have 2 K passes, and at
 * most 2 K nodes, all of these, an odd number. O(2^edges * (3^edges + cords)). */
double truth_length(const thr_frame *f, const thr_request *o, int *passes);

/* Tables over all numbers of passes of the edges of one component, up to `most` each and cord. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int most, size;     /* entries: (most + 1)^edges */
  double *length;     /* [size] of the passes */
  long double *price; /* [size] least price of the turns of one cord that runs so, turning back only
                     at nodes with one edge; INFINITY if none does */
  bool *runs;         /* [size] can one cord run so, turning back anywhere? */
} truth_table;

/* Ends closed, any, feet or nodes; connected frameworks of at most TRUTH_TABLE_EDGES edges. */
truth_table truth_table_make(const thr_frame *f, const thr_request *o, int most);
void truth_table_destroy(truth_table *t);

/* Of n cords that keep cover and capacity: the least sum of their prices with no more length in all
 * than length_limit (< 0 = any), or the least price of the dearest. An upper bound of what is true
 * where `most` is small. INFINITY if there are none. */
long double truth_price(const truth_table *t, int n, bool largest, double length_limit);

/* The least length of the longest of n cords: exact for most >= 2, as a cord that passes an edge
 * three times can do without two.
 */
double truth_longest(const truth_table *t, int n);

#endif
