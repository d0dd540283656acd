/* How the passes of a component are shared out among several cords (docs/method.md).
 *
 * Open cords: one walk, cut where cords may end, costs nothing. Closed cords: a walk that comes twice past a node falls into two
 * there; where no node is passed twice, further passes make more circuits.
 *
 * Example: a figure of eight, two closed cords: cut at its middle. */
#ifndef THR_SHARE_H
#define THR_SHARE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"

/* Where cords may end, and how many ends there are. All is borrowed. */
typedef struct {
  const thr_frame *f;
  const thr_request *o; /* ends, end_node, end_count */
  const int *component; /* [n_nodes] */
} thr_share;

/* Makes room for the ends of n cords in component k: where passes[n_edges], the shortest, leave too few places for them, they are
 * replaced by the shortest ones of all that do not, as one perfect matching (Edmonds & Johnson's reduction of degree
 * constraints). certificate gives the weights. *changed: they were. THR_EINFEASIBLE: no passes within the capacities have as many
 * (says where). THR_ELIMIT: stopped, or too large a matching; then passes are as before. */
thr_status thr_share_places(const thr_share *share, int k, int n, const thr_certificate *certificate, const thr_limits *limits,
                            int *passes, bool *changed, thr_err *err) THR_MUST_CHECK;

/* Cuts the walks of a component (thr_walks_trace) into n cords, or as many more as must be: at the sharpest turns where cords
 * may end, or, even = true, so that no cord is much longer than the others. With THR_ENDS_COUNTS the counts say how many.
 * THR_EINFEASIBLE: there are fewer places (thr_share_places makes room for as many as are asked for). */
thr_status thr_share_cut(const thr_share *share, int n, bool even, thr_walks *walks, thr_err *err) THR_MUST_CHECK;

/* The same with THR_ENDS_CLOSED: n closed walks. *enough false: these passes do not hold as many, or so many were not found;
 * walks then holds as many as were. */
thr_status thr_share_circuits(const thr_share *share, int n, bool even, thr_walks *walks, bool *enough,
                              thr_err *err) THR_MUST_CHECK;

/* Splits closed walks at nodes that one visits twice, without further passes, until there are n or none can be: where that turns
 * least, or, even = true, the longest in halves. ties: those of the walks, which stay tied; or NULL. */
thr_status thr_share_split(const thr_share *share, int n, bool even, thr_junction_graphs *ties, thr_walks *walks,
                           thr_err *err) THR_MUST_CHECK;

/* The same for tube joints, with further passes where it must be: n closed walks that tie what walks ties, few of them. even:
 * from options.cords_least on no more than make the longest shorter. *found false: the capacities leave no room for as many as
 * must be among those that were looked for; walks then holds as many as there was room for. */
thr_status thr_share_tied(const thr_share *share, int n, bool even, int *passes, thr_walks *walks, bool *found,
                          thr_err *err) THR_MUST_CHECK;

/* What thr_share_circuits did not find: pairs of passes of component k over the shortest edges, until there are n closed walks.
 * *found false: the capacities leave no room. */
thr_status thr_share_more(const thr_share *share, int k, int n, int *passes, thr_walks *walks, bool *found,
                          thr_err *err) THR_MUST_CHECK;

/* Splits the longest closed walk, again and again, into two that both pass a way between two of its nodes, or if that is no good
 * into one for each of its edges, until there are n or none gets shorter by it. O(n * passes of a walk * edges around it). */
thr_status thr_share_chords(const thr_share *share, int n, int *passes, thr_walks *walks, thr_err *err) THR_MUST_CHECK;

/* Closed walk i becomes two, its passes from .. end - 1 and the others, which both pass the way way[n] between their ends: from
 * the node before pass number from to that before number end. ties: of the walks, or NULL. */
thr_status thr_share_chord(const thr_share *share, thr_walks *walks, int i, int from, int end, const int *way, int n,
                           thr_junction_graphs *ties, int *passes, thr_err *err) THR_MUST_CHECK;

/* Joins cyclic walks at shared nodes until there are n, with little turning. */
thr_status thr_share_merge(const thr_share *share, int n, thr_walks *walks, thr_err *err) THR_MUST_CHECK;

#endif
