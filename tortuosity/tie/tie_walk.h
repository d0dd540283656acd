/* Closed walks along which one pass more or less over each edge changes the price of tied nodes. Internal to tortuosity/.
 *
 * A walk passes no node twice, so the change is the sum over its nodes of what their two edges change together, which is exact as
 * far as the nodes' prices are. It may go once from the ends at one node to those at another: then an end moves. Of every closed
 * walk that saves, one of the places to start from has only negative sums on the way (S. Lin & B. W. Kernighan, "An effective
 * heuristic algorithm for the traveling-salesman problem", Operations Research 21, 1973): all others are left off. */
#ifndef THR_TIE_WALK_H
#define THR_TIE_WALK_H

#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/tie/tie.h"

enum { THR_WALK_LABELS = 600 }; /* partial walks that one search looks at, at most */

/* A partial walk. A step is 2 * half-edge, + 1 if its edge loses a pass instead of getting one; after those of the half-edges the
 * steps to the ends of equation k (2 k), then those from there to node v (2 v), + 1 if the node loses an end. */
typedef struct {
  double gain;   /* price of what has changed so far, but for the first node */
  double longer; /* length */
  int step, before, depth;
} thr_walk_label;

/* The price of a node's passes and ends, by a hash of both. */
typedef struct {
  uint64_t name;
  double price;
} thr_walk_known;

typedef struct {
  const thr_turning_columns *c;
  thr_knot knot;
  int *passes, *ends; /* borrowed */
  double total;       /* price of all turns and extra passes */
  double extra;       /* length of the extra passes */
  double *price;      /* [n_nodes] of the turns there */
  thr_walk_known *known;
  double *change;        /* what two steps at a node change, by node; NAN = not known */
  int *first;            /* [n_nodes] where the node's changes begin, -1 = too many to keep */
  int searches, *seen;   /* [steps] search that reached it last */
  double *reached;       /* [steps] with what gain */
  int n_labels, last;    /* of the walk found: its last label, -1 = none */
  double saved;          /* by it (< 0), or its price */
  thr_walk_label *label; /* [THR_WALK_LABELS] */
} thr_walker;

/* For passes and ends with which every node can be tied; else total is INFINITY. Memory: a number for every two steps at a node
 * of up to 40 edges. */
thr_status thr_walker_init(thr_walker *w, const thr_turning_columns *turning_columns, int *passes, int *ends,
                           thr_err *err) THR_MUST_CHECK;
void thr_walker_destroy(thr_walker *w);

/* The cheapest closed walk found that begins with a step over a half-edge and changes the price by less than allowed; no sum on
 * the way is more. Fills last and saved. */
void thr_walker_search(thr_walker *w, int step, double allowed);

/* Goes the walk found. */
void thr_walker_take(thr_walker *w);

/* Two passes more, or less (by), over the edge alone, if that saves. */
bool thr_walker_double(thr_walker *w, int edge, int by);

/* Prices and changes anew, after passes and ends were set from outside. */
void thr_walker_reset(thr_walker *w);

#endif
