/* Tube joints while it is still open which cord takes which passes: the turns of all walks at every node, counted, so that a
 * change of turns can be tried (graph/plan/junction.h). Internal to lp/ and tortuosity/. */
#ifndef THR_KNOTS_H
#define THR_KNOTS_H

#include "graph/threading/walks.h"

/* count[first[v] + a * degree + b]: turns between the half-edges number a and b of node v, in both orders. */
typedef struct {
  const thr_frame *f;
  size_t *first; /* [n_nodes] owned */
  int *place;    /* [2 * n_edges] owned; of a half-edge among those of its node */
  int *count;    /* owned */
  int *queue;    /* [largest degree] owned; scratch, and */
  bool *seen;    /* [largest degree] owned */
} thr_knots;

/* The turns of the walks, with those that close cyclic ones. O(passes + sum of the squares of the degrees), also in memory. */
thr_status thr_knots_init(thr_knots *t, const thr_frame *f, const thr_walks *w, thr_err *err) THR_MUST_CHECK;
void thr_knots_destroy(thr_knots *t);

/* Turns that come and go; at most THR_MOST_CHANGED. */
enum { THR_MOST_CHANGED = 16 };

typedef struct {
  int n;
  struct {
    int in, out, by; /* half-edge that arrives, half-edge that leaves; 1 or -1 */
  } turn[THR_MOST_CHANGED];
} thr_knots_change;

/* in or out < 0: a cord end, where nothing turns. */
void thr_knots_note(thr_knots_change *c, int in, int out, int by);

/* Does every node that the change is about stay tied (one that was not before is no worse for it), and does nothing turn back? */
bool thr_knots_allow(thr_knots *t, const thr_knots_change *c);
void thr_knots_make(thr_knots *t, const thr_knots_change *c);

#endif
