/* Automorphisms of a framework: renumberings of its nodes that keep edges and feet (McKay & Piperno 2014). */
#ifndef THR_AUTOMORPHISMS_H
#define THR_AUTOMORPHISMS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"

typedef struct {
  const int *node_colour; /* [n_nodes] borrowed, NULL = all alike. Feet and other nodes are told apart in any case */
  const int *edge_colour; /* [n_edges] borrowed, NULL = all alike */
} thr_automorphism_options;

/* Generators of the whole group. */
typedef struct {
  int n; /* nodes */
  int n_generators;
  int *generator;  /* [n_generators * n] image of each node; owned */
  double mantissa; /* the group's order is mantissa * 10^exponent; below 10^14 exact, and exponent 0 */
  int exponent;
  int *orbit; /* [n] lowest node of each node's orbit; owned */
} thr_automorphisms;

/* By nauty's Traces, edges with colours by subdivision. Deterministic: the same generators on every call. The framework has an
 * edge. THR_ELIMIT: more generators than can be held (2^26 images; thousands of equal components). THR_ESOLVER: nauty gave up
 * (said why). Not re-entrant. */
thr_status thr_automorphisms_find(const thr_frame *f, const thr_automorphism_options *o, thr_automorphisms *out,
                                  thr_err *err) THR_MUST_CHECK;

/* The same in a child process, which the limits can end, as Traces cannot be stopped; without limits that stop anything, here.
 * *all = false: it was not done in time, and out has the identity alone. */
thr_status thr_automorphisms_within(const thr_frame *f, const thr_automorphism_options *o, const thr_limits *limits, bool *all,
                                    thr_automorphisms *out, thr_err *err) THR_MUST_CHECK;

/* Fills the orbits from the generators. */
thr_status thr_automorphisms_orbits(thr_automorphisms *a, thr_err *err) THR_MUST_CHECK;

void thr_automorphisms_destroy(thr_automorphisms *a);

const char *thr_nauty_version(void);

#endif
