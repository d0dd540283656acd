/* What the files of the matching of units share: the units, and what the moats of their matching say. Internal to
 * tortuosity/proof/unit_*.c. */
#ifndef THR_UNIT_PARTS_H
#define THR_UNIT_PARTS_H

#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"

typedef struct {
  const thr_turning_columns *c;
  thr_scratch own; /* the arrays */
  int *needed;     /* [n_nodes] extra passes that a node asks for */
  int *kinds;      /* [n_nodes] kinds of pairs of spare units: 0 = one, whose units may take any edge; else unit i of kind k takes
                      those at whose place in the node's list bit k is i */
  int *spares;     /* [n_nodes] pairs of every kind */
  int *home;       /* [n_nodes] innermost blossom round a node, or -1 */
  int64_t *dual;   /* [2 * n_edges] what a pass over a half-edge pays there, in the matching's halves */
  int bits;        /* weights are prices / 2^bits */
} thr_units;

/* The matching of the units of one level: a unit stands for 2^level extra passes, so that the duals of the coarser levels, which
 * are quickly found, are where the finer ones begin. */
typedef struct {
  int *asked, *first; /* [n_nodes], [n_nodes + 1] units of a node: so many asked for, then the pairs of spare ones; owned */
  int n_edges;
  int (*edge)[2];  /* [n_edges] of the matching; owned */
  int *of;         /* [n_edges] edge of the framework, -1: a pair of spare units; owned */
  int64_t *weight; /* [n_edges] owned */
  thr_matching matching;
} thr_unit_layer;

/* Has the node passes enough, so that only their number may be odd? */
bool thr_unit_covered(const thr_turning_columns *c, int v);

/* May a unit take half-edge h of its node? Those asked for take any, but at a node of two edges the one that lacks passes. */
bool thr_unit_may_take(const thr_units *u, const thr_unit_layer *l, int h, int unit);

/* The multipliers of a matching, unless dual is NULL, in tortuosity/proof/unit_dual.c. *more: spare units were added where these
 * say that they may save. O(units * degree + nodes * depth of blossoms). */
thr_status thr_unit_dual(thr_units *u, const thr_unit_layer *l, thr_turning_dual *dual, bool *more, thr_err *err) THR_MUST_CHECK;

#endif
