/* The least longest of several cords that pass few edges each, without a proof: all sets of edges that a cord below a limit
 * passes are looked at. Private to the checker and the planner.
 *
 *   States are (set passed so far, node); Dijkstra's method settles them by length, and goes on only where the way back, or to an
 * end, stays below the limit. Few are left where a cord passes some dozen edges of a framework whose nodes have three or four.
 *   Whether K cords below a limit do is decided by depth first search: the next one passes the edge that is lacking and in the
 * fewest sets; sets that are part of others are left out, and what failed before. What is lacking cannot be passed by j cords
 *   - where it weighs more than j times the heaviest set, for weights of the edges that make many cords (any would be right), and
 *   - where its length, and what its odd nodes add (half of the shortest edge there, but for 2 j of them if cords may end there:
 *     half an edge from either side are odd cuts), is more than j times the limit.
 * A table over the sets of few edges (graph/check/few_edges.h) has no limit on the cords; this one has none on the framework.
 *
 * Example: four closed cords through robarch_tree_S, 45 edges of three at a node: 37,260 sets of at most 780 mm, none of which
 * four pass all. Least length over four is 741.5. */
#ifndef THR_SHORT_CORDS_H
#define THR_SHORT_CORDS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdint.h>

enum { THR_SHORT_EDGES = 128, THR_SHORT_STATES = 1 << 19 };

__extension__ typedef unsigned __int128 thr_edge_set; /* bit e: edge e */

/* Where a walk may be, and how long it is then. */
typedef struct {
  thr_edge_set set;
  double length;
  int node, from, half; /* from: the state before half was passed; -1: here it began */
  int at;               /* in the queue; -1: not any more */
} thr_short_state;

typedef struct {
  thr_edge_set set;
  double length; /* of the shortest cord that passes just these edges */
  int state;     /* where it ends */
} thr_short_set;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits; /* that stop the searches; NULL: none */
  double limit;
  int n; /* sets; 0: none is known, or there are too many */
  int n_states;
  thr_short_set *set;     /* [THR_SHORT_STATES] the first n */
  thr_short_state *state; /* [THR_SHORT_STATES] the first n_states */
  thr_scratch own;
} thr_short_cords;

/* Sets of cords of at most this length. limits: NULL = none; where they stop it, or the search below, nothing is known. n = 0
 * also for several components, tube joints, given numbers of ends and more than THR_SHORT_EDGES edges. O(states (degree + log
 * states)), 100 bytes a state. Release with thr_short_cords_destroy, after a failure too. */
thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame, const thr_request *options, double limit,
                                const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_short_cords_destroy(thr_short_cords *cords);

/* The longest of so many cords, of those that pass every edge which needs passes: no less than *proved, the limit if none can
 * have less; *found is had by sets chosen[n] (NULL: not wanted; numbers, -1: one more of any), INFINITY: it is not known. One
 * number unless it takes too long. known: the longest of some that are known, from where to look downwards. */
thr_status thr_short_cords_longest(const thr_short_cords *cords, int n, double known, int *chosen, double *proved, double *found,
                                   thr_err *err) THR_MUST_CHECK;

/* The shortest cord over just the edges of set number i: its half-edges are the caller's. */
thr_status thr_short_cords_walk(const thr_short_cords *cords, int i, thr_cord *cord, thr_err *err) THR_MUST_CHECK;

#endif
