/* The relaxation of tortuosity/proof/relax.h without its turns, for the shortest passes with tube joints: where turns cost
 * nothing, what they say about passes and ends is (tortuosity/tie/tie.h) at every node v with d edges: passes - ends >= 2 (d - 1)
 * (0 if d = 1); for every edge e there: the passes less ends of the others >= those of e; passes less ends of e >= 1, if d > 1;
 * passes and ends out of a set of nodes that has an odd number of covers: at least one extra pass or end. Internal to
 * tortuosity/: relax.c calls these for tasks with free turns. */
#ifndef THR_PROJECT_H
#define THR_PROJECT_H

#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/proof/relax.h"

thr_status thr_project_create(thr_relax *relax, double penalty, thr_err *err) THR_MUST_CHECK;
thr_status thr_project_graph(thr_relax *relax, thr_err *err) THR_MUST_CHECK;

/* Separators, of a thr_relax: rows of the numbers of ends; of the edges at their nodes. */
thr_status thr_project_ends(void *relax, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_project_sides(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* The multipliers of the last solve as those of the whole model: a node's row is its junction of single edges. */
thr_status thr_project_dual(const thr_relax *relax, thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

#endif
