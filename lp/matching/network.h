/* A T-join problem made ready for shortest paths: adjacency in one block, edges of weight 0 contracted. Internal to lp/.
 *
 * A contracted place is odd if it holds an odd number of odd nodes; joins of the contracted graph and of the whole one have the
 * same weight.
 *
 * Example: in a triangle with weights 0, 3 and 4 the ends of the first edge become one place, with two arcs of weight 3 and 4 to
 * the third node. */
#ifndef THR_NETWORK_H
#define THR_NETWORK_H

#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

/* An edge as seen from one of its places. */
typedef struct {
  int64_t weight; /* > 0 */
  int head;       /* place where it leads */
  int edge;       /* of the problem */
} thr_arc;

/* Nodes that edges of weight 0 connect are one place; it is odd if an odd number of its nodes are. */
typedef struct {
  const thr_tjoin_problem *p; /* borrowed */
  int n_places, n_arcs, n_odd;
  thr_scratch own; /* the arrays */
  int *place;      /* [p->n_nodes] of a node */
  int *first;      /* [n_places + 1] arcs that leave v: arc[first[v] .. first[v + 1] - 1] */
  thr_arc *arc;    /* [n_arcs] */
  int *odd;        /* [n_odd] the odd places, ascending */
  int *number;     /* [n_places] position of a place in odd, or -1 */
} thr_network;

/* O(nodes + edges). Release with thr_network_destroy. */
thr_status thr_network_init(thr_network *net, const thr_tjoin_problem *tjoin_problem, thr_err *err) THR_MUST_CHECK;
void thr_network_destroy(thr_network *net);

/* Makes a T-join of the problem from any set of edges: changes it along a forest of edges of weight 0, which is enough where
 * every place has its parity already; with any_weight along a lightest spanning tree. O(nodes + edges log edges). */
thr_status thr_network_mend(const thr_network *net, bool any_weight, bool *in_join, thr_err *err) THR_MUST_CHECK;

/* Of a lightest spanning tree: there is a T-join that weighs no more, and no two nodes are farther apart. O(edges log edges). */
thr_status thr_network_tree_weight(const thr_tjoin_problem *tjoin_problem, double *weight, thr_err *err) THR_MUST_CHECK;

/* ---- a queue for Dijkstra's method ---- */

typedef struct {
  int64_t key;
  int place;
} thr_queued;

/* A heap, four children per node: greatest key first. {0} is empty; release entry with free. */
typedef struct {
  int count, capacity;
  thr_queued *entry;
} thr_queue;

thr_status thr_queue_push(thr_queue *q, thr_queued in, thr_err *err) THR_MUST_CHECK;
thr_queued thr_queue_pop(thr_queue *q);

#endif
