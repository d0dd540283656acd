/* The shortest cords for tube joints: Graph Threading (Demaine, Kirkpatrick & Lin, ITCS 2024) with ends, covers, capacities.
 *
 * Minimize the length with, at every node of degree d: passes that arrive, less ends, at least 2 (d - 1), no edge with more of
 * them than all others together, and an even number; these are the passes whose node can be tied (tortuosity/tie/tie.h).
 *
 * Example: an octahedron: 6 passes arrive at every node of degree 4, so it takes 18 over its twelve edges, where solid joints
 * take 12. */
#ifndef THR_TUBE_H
#define THR_TUBE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

typedef struct {
  int n_cords;
  thr_cord *cord; /* [n_cords] owned */
  double length;
  int most_passes;         /* of any edge */
  thr_turning_proof proof; /* of bound, for graph/plan/junction.h */
  double bound;            /* no cords of the options are shorter */
} thr_tube;

/* Cords that tie every node, the shortest, from options.cords_least to options.cords in every component, with little turning at
 * the nodes. Closed: one in every component, which is no longer than any number of them. THR_OK: proved. THR_ELIMIT: out holds
 * cords, and what is proved. THR_EINFEASIBLE: a node or a component that no cords can tie (named), or none found. THR_EINPUT:
 * several closed cords for another plan than one of the least length. Otherwise out is empty. */
thr_status thr_tube_shortest(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_tube *out,
                             thr_err *err) THR_MUST_CHECK;

/* Some such cords, without a search: bound is 0. Near-linear in passes as a rule. */
thr_status thr_tube_some(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_tube *out,
                         thr_err *err) THR_MUST_CHECK;
void thr_tube_destroy(thr_tube *tube);

/* What the proof of tube, which is moved, says of cords of this length. */
void thr_tube_prove(thr_tube *tube, double length, thr_length_proof *proof);

#endif
