/* How the passes of a component are shared out among several cords (docs/method.md).
 *
 * Open cords: one walk, cut where cords may end, costs nothing. Closed cords: a walk that comes twice past a node falls into two
 * there; where no node is passed twice, further passes make more circuits.
 *
 * Example: a figure of eight, two closed cords: cut at its middle. */
#ifndef THR_DECOMPOSITION_H
#define THR_DECOMPOSITION_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"

/* Cords on the way, of a framework of one component. */
typedef struct {
  const thr_frame *f;   /* these three are borrowed */
  const thr_request *o; /* covers, capacities, joint, ends */
  const thr_limits *limits;
  thr_walks walks; /* cyclic with THR_ENDS_CLOSED, else open */
  int *passes;     /* [n_edges] of these walks, or for walks to come; owned */
  bool least;      /* the passes are the shortest that hold the cords */
  bool certain;    /* the longest cord is as short as can be: the solver's word */
  bool asked;      /* options.max_length: the table was, for any number of cords */
  bool none;       /* and there are none */
} thr_decomposition;

/* No walks yet, and no passes. On failure it is to be destroyed too. */
thr_status thr_decomposition_init(thr_decomposition *decomposition, const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_decomposition_destroy(thr_decomposition *decomposition);

/* Makes room for the ends of n cords: where the passes, the shortest, leave too few places for them, they are replaced by the
 * shortest ones of all that do not, as one perfect matching (Edmonds & Johnson's reduction of degree constraints). certificate
 * gives the weights. THR_EINFEASIBLE: no passes within the capacities have as many (says where). THR_ELIMIT: stopped, or too
 * large a matching; then passes are as before. */
thr_status thr_decomposition_places(thr_decomposition *decomposition, int n, const thr_certificate *certificate,
                                    thr_err *err) THR_MUST_CHECK;

/* Cuts the walks (thr_walks_trace) into n cords, or as many more as must be: at the sharpest turns where cords may end, or, even
 * = true, so that no cord is much longer than the others. With THR_ENDS_COUNTS the counts say how many. THR_EINFEASIBLE: there
 * are fewer places (thr_decomposition_places makes room for as many as are asked for). */
thr_status thr_decomposition_cut(thr_decomposition *decomposition, int n, bool even, thr_err *err) THR_MUST_CHECK;

/* The same with THR_ENDS_CLOSED: n closed walks. *enough false: these passes do not hold as many, or so many were not found;
 * there are then as many walks as were. */
thr_status thr_decomposition_circuits(thr_decomposition *decomposition, int n, bool even, bool *enough,
                                      thr_err *err) THR_MUST_CHECK;

/* Splits closed walks at nodes that one visits twice, without further passes, until there are n or none can be: where that turns
 * least, or, even = true, the longest in halves. ties: those of the walks, which stay tied; or NULL. */
thr_status thr_decomposition_split(thr_decomposition *decomposition, int n, bool even, thr_junction_graphs *ties,
                                   thr_err *err) THR_MUST_CHECK;

/* The same for tube joints, with further passes where it must be: n closed walks that tie what the walks, few of them, tie. even:
 * from options.cords_least on no more than make the longest shorter. *found false: the capacities leave no room for as many as
 * must be among those that were looked for; there are then as many as there was room for. */
thr_status thr_decomposition_tied(thr_decomposition *decomposition, int n, bool even, bool *found, thr_err *err) THR_MUST_CHECK;

/* What thr_decomposition_circuits did not find: pairs of passes over the shortest edges, until there are n closed walks. *found
 * false: the capacities leave no room. */
thr_status thr_decomposition_more(thr_decomposition *decomposition, int n, bool *found, thr_err *err) THR_MUST_CHECK;

/* Splits the longest closed walk, again and again, into two that both pass a path between two of its nodes, or if that is no good
 * into one for each of its edges, until there are n or none gets shorter by it. O(n * passes of a walk * edges around it). */
thr_status thr_decomposition_chords(thr_decomposition *decomposition, int n, thr_err *err) THR_MUST_CHECK;

/* Closed walk i becomes two, its passes from .. end - 1 and the others, which both pass the path path[n] between their ends: from
 * the node before pass number from to that before number end. ties: of the walks, or NULL. */
thr_status thr_decomposition_chord(thr_decomposition *decomposition, int i, int from, int end, const int *path, int n,
                                   thr_junction_graphs *ties, thr_err *err) THR_MUST_CHECK;

/* Joins cyclic walks at shared nodes until there are n, with little turning. */
thr_status thr_decomposition_merge(thr_decomposition *decomposition, int n, thr_err *err) THR_MUST_CHECK;

/* Makes the longest walk as short as exchanges do it (lp/length/balance.h) and, where the framework is small, as the table knows
 * it. goal > 0: until none is longer than this, with the fewest cords from then on. */
thr_status thr_decomposition_even(thr_decomposition *decomposition, double goal, thr_err *err) THR_MUST_CHECK;

static inline bool thr_decomposition_within(double length, double limit)
{
  return length <= limit * (1 + 1e-12);
}

#endif
