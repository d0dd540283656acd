/* Walks through the passes of a framework (graph theory's: consecutive half-edges, an edge as often as it comes), while it is
 * still open which cord takes which. */
#ifndef THR_WALKS_H
#define THR_WALKS_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/multigraph.h"

/* Consecutive half-edges. */
typedef struct {
  int n, *half;  /* owned */
  double length; /* in units */
  bool cyclic;   /* comes back to its start, where no cord end is yet */
} thr_walk;

typedef struct {
  int n_walks, capacity;
  thr_walk *walk; /* owned */
} thr_walks;

void thr_walks_destroy(thr_walks *walks);

/* As few walks as pass every edge passes[e] times, edges with passes being one component, paired for little turning: a cyclic one
 * where all nodes have an even number of passes, else open ones between those that have not. Near-linear in passes. */
thr_status thr_walks_trace(const thr_frame *frame, const int *passes, thr_walks *out, thr_err *err) THR_MUST_CHECK;

/* Appends the circuits of a transition system (graph/threading/transition.h): those with virtual edges first, which are cut
 * there; each from its lowest dart. Linear. */
thr_status thr_walks_follow(thr_walks *walks, const thr_frame *frame, const thr_multigraph *multigraph, const int *mate,
                            thr_err *err) THR_MUST_CHECK;

/* Appends a walk, which is taken over, or released on failure. Its length is worked out. */
thr_status thr_walks_add(thr_walks *walks, const thr_frame *frame, thr_walk walk, thr_err *err) THR_MUST_CHECK;

/* Appends a copy of half[n]. */
thr_status thr_walks_copy(thr_walks *walks, const thr_frame *frame, const int *half, int n, bool cyclic,
                          thr_err *err) THR_MUST_CHECK;

/* The number of passes that the walks make of each edge is added to passes[n_edges]. */
void thr_walks_count(const thr_walks *walks, int *passes);

double thr_walk_length(const thr_frame *frame, const int *half, int n);

/* Of all walks; the number of the longest, the first of equals, and its length, 0 if there are none. */
double thr_walks_length(const thr_walks *walks);
int thr_walks_longest(const thr_walks *walks);
double thr_walks_most(const thr_walks *walks);

/* The node before pass number at; with at = n, after the last one. */
int thr_walk_node(const thr_frame *frame, const thr_walk *w, int at);

/* The half-edge before pass number at of a cyclic walk, or of an open one if at > 0. */
static inline int thr_walk_before(const thr_walk *w, int at)
{
  return w->half[at ? at - 1 : w->n - 1];
}

/* The half-edges of a walk the other way round. */
void thr_walk_reverse(int *half, int n);

/* Turns a cyclic walk round so that it starts with what was its pass number at. */
thr_status thr_walk_rotate(thr_walk *w, int at, thr_err *err) THR_MUST_CHECK;

/* Price of going on from half-edge in with out: the turn in rad, and much more for a turn back. */
double thr_walk_turn(const thr_frame *frame, int in, int out);

/* The visits that walks pay to nodes, walk by walk, at positions 0 .. n of each; the last position of a cyclic one is listed, but
 * is no visit. */
typedef struct {
  const thr_frame *f;
  const thr_walk *w; /* the first walk */
  int n;
  int *first;  /* [n_nodes] newest visit, -1 = none */
  int *next;   /* [n] visit before of the same node, -1 = none */
  int *walk;   /* [n] */
  int *at;     /* [n] its position */
  double *sum; /* [n] length of the walk as far as there */
  bool own;    /* first is owned */
} thr_walk_visits;

/* Of walks w[0 .. n_walks - 1]. first: [n_nodes] of -1, borrowed and changed until thr_walk_visits_forget; NULL: one of its own.
 * O(positions), and O(nodes) for one of its own. */
thr_status thr_walk_visits_init(thr_walk_visits *visits, const thr_frame *frame, const thr_walk *w, int n_walks, int *first,
                                thr_err *err) THR_MUST_CHECK;
void thr_walk_visits_forget(const thr_walk_visits *visits);
void thr_walk_visits_destroy(thr_walk_visits *visits);

/* Moves the walks into cords: open ones from their lower end, cyclic ones from where closing leaves out most
 * (graph/threading/tour.h). On failure there are none. */
thr_status thr_walks_cords(thr_walks *walks, const thr_frame *frame, const thr_request *options, thr_cord **cord, int *n_cords,
                           thr_err *err) THR_MUST_CHECK;

#endif
