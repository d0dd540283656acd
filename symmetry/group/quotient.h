/* Threadings that a group H of automorphisms maps to themselves, counted by orbits (docs/method.md).
 *
 * A symmetric threading is an H-set of copies (passes) over the edges with an H-invariant pairing of their darts (a dart is one
 * end of a copy) at the nodes. Fewer conditions are wrong: an H-invariant T-join with even degrees need not have an invariant
 * pairing. copy type (e, K)  an orbit of copies over the orbit of edge e; K <= H_e, up to conjugacy in H_e, maps one copy to
 * itself. It adds [H_e : K] passes to e. If an element of K turns e round, the copy is a fold: its trail is mapped to its
 * reverse. dart type (h, S)  an orbit of darts over half-edge h with stabilizer S <= H_h. A copy type without fold has two dart
 * orbits, of types (h, K) and (h ^ 1, K); with a fold one, of type (h, S) with S = the elements of K that do not turn e round.
 *   pair type         an orbit of turns at a node: darts a, b with equal stabilizers over half-edges of one node; over one
 * half-edge the cord turns back into its edge. If some g in H_v maps a to b, a pair within one dart orbit (a "self" pair) needs
 * such a g that also maps b to a; it folds the trail at the node. Two different dart orbits of one type can be paired in any
 * case. The stabilizer of a dart is that of all its trail (the layer): a trail over an edge in a mirror, passed by one fixed
 * copy, stays in the mirror. In the quotient a trail's orbit is a path between two terminals (cord end or fold) or a circle. */
#ifndef THR_QUOTIENT_H
#define THR_QUOTIENT_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "symmetry/group/group.h"

typedef struct {
  int edge_orbit;
  int edge;   /* representative e */
  int passes; /* [H_e : K]: that one orbit adds to every edge of the edge's orbit */
  int copies; /* [H : K] in one orbit */
  bool fold;
  int dart[2]; /* dart types of its ends; dart[1] = -1 for a fold; equal if H turns e round but K does not */
  int layer;
  thr_subgroup stabilizer; /* K */
} thr_copy_type;

typedef struct {
  int half; /* representative half-edge h; the type is the least (h, S) of its orbit */
  int layer;
  int darts;               /* [H : S] in one orbit */
  thr_subgroup stabilizer; /* S, as a subgroup of G */
} thr_dart_type;

typedef struct {
  int dart[2];  /* types of a and b */
  int half[2];  /* half-edges of a representative turn, both leaving one node: half[0] is that of dart[0]'s representative */
  bool self;    /* a and b in one dart orbit: uses 1 of the type; else 1 of each type, or 2 of one */
  int turns;    /* in one orbit of turns */
  double angle; /* rad, the mean over the orbit (warped frameworks differ) */
  int element;  /* self: a g as above; else -1 */
} thr_pair_type;

typedef struct {
  const thr_frame *f;             /* borrowed */
  const thr_group *group;         /* G: its elements permute the nodes; borrowed */
  const thr_subgroup *h;          /* borrowed */
  int *half_image;                /* [h->order * 2 * n_edges] image of each half-edge under the i-th element of h */
  int n_edge_orbits, *edge_orbit; /* [n_edges] */
  int *orbit_size;                /* [n_edge_orbits] edges */
  double *orbit_length;           /* [n_edge_orbits] sum of their lengths */
  int n_layers;                   /* classes of dart stabilizers under H; layer 0 is that of the trivial one if it occurs */
  int n_copies, n_darts, n_pairs;
  thr_copy_type *copy; /* owned */
  thr_dart_type *dart; /* owned */
  thr_pair_type *pair; /* owned */
} thr_quotient;

/* All types, in a fixed order (by edge, then by descending stabilizer; by half-edge; by darts and half-edges). THR_ELIMIT: more
 * than `most` types (frameworks with many interchangeable parts); out is empty. */
thr_status thr_quotient_init(thr_quotient *quotient, const thr_frame *frame, const thr_group *g, const thr_subgroup *subgroup,
                             int most, thr_err *err) THR_MUST_CHECK;

/* The same; THR_ELIMIT also when the limits say so. */
thr_status thr_quotient_make(thr_quotient *quotient, const thr_frame *frame, const thr_group *g, const thr_subgroup *subgroup,
                             int most, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_quotient_destroy(thr_quotient *quotient);

#endif
