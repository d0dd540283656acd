/* The junction graph of every node (graph/plan/junction.h) while it is still open which cord takes which passes: the turns of all
 * walks, counted, so that a change of turns can be tried. */
#ifndef THR_JUNCTION_GRAPHS_H
#define THR_JUNCTION_GRAPHS_H

#include "graph/framework/frame.h"
#include "graph/status.h"
#include "graph/threading/walks.h"

/* count[first[v] + a * degree + b]: turns between the half-edges number a and b of node v, in both orders. */
typedef struct {
  const thr_frame *f;
  size_t *first; /* [n_nodes] owned */
  int *place;    /* [2 * n_edges] owned; of a half-edge among those of its node */
  int *count;    /* owned */
  int *queue;    /* [largest degree] owned; scratch, and */
  bool *seen;    /* [largest degree] owned */
} thr_junction_graphs;

/* The turns of the walks, with those that close cyclic ones. O(passes + sum of the squares of the degrees), also in memory. */
thr_status thr_junction_graphs_init(thr_junction_graphs *graphs, const thr_frame *frame, const thr_walks *walks,
                                    thr_err *err) THR_MUST_CHECK;
void thr_junction_graphs_destroy(thr_junction_graphs *graphs);

/* Turns that come and go; at most THR_MOST_CHANGED. */
enum { THR_MOST_CHANGED = 16 };

typedef struct {
  int n;
  struct {
    int in, out, by; /* half-edge that arrives, half-edge that leaves; 1 or -1 */
  } turn[THR_MOST_CHANGED];
} thr_turn_change;

/* in or out < 0: a cord end, where nothing turns. */
void thr_turn_change_note(thr_turn_change *change, int in, int out, int by);

/* Does every node that the change is about stay tied (one that was not before is no worse for it), and does nothing turn back? */
bool thr_junction_graphs_allow(thr_junction_graphs *graphs, const thr_turn_change *change);
void thr_junction_graphs_make(thr_junction_graphs *graphs, const thr_turn_change *change);

#endif
