/* The best symmetric cover for one group: how many orbits of each type of copies, turns, ends and folds
 * (symmetry/group/quotient.h), as an integer programme.
 *
 * Minimize overlap, then steps, then paths, subject to: every edge orbit is passed often enough, the turns and ends of every
 * dart type use up its darts, and what is chosen hangs together.
 *
 * Example: a ring of six edges under C6: one orbit of copies and one of turns make one closed cord. */
#ifndef THR_COVER_H
#define THR_COVER_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/group/quotient.h"

/* value[aim]: overlap in units of length; learned steps (passes of the unique paths, a folded path's half, a folded edge as 1/2);
 * unique paths (orbits of cords); turning in rad of all cords. bound[aim]: no symmetric cover is better in that, with the aims
 * before it at their values. */
typedef struct {
  int *copies; /* [q->n_copies] orbits of each type; owned */
  int *pairs;  /* [q->n_pairs] owned */
  int *ends;   /* [q->n_darts] dart orbits that are cord ends; owned */
  double value[THR_N_AIMS], bound[THR_N_AIMS];
  bool optimal; /* solved to the end in all aims, by GLPK's word and to 4e-6 of an aim's largest cost */
} thr_cover;

/* Lexicographic integer programme over the orbits, by branch and cut: dart balance, cover, odd sets of dart types (Edmonds &
 * Johnson 1973: every column meets at most two equations, so they nearly close the gap), and rows added when a solution's
 * quotient falls apart into more trails than its terminals need or, where every cord is open, has more folds than ends can be led
 * to. The aims before turning are solved without the turns at most nodes (symmetry/cover/contraction.h) in at most 7/10 of the
 * time; before that a cover is made without any programme, copies made even by a least T-join (symmetry/cover/start.c), and every
 * one is improved by exchanges, so that a search that is stopped has one. The T-join and that of the framework without symmetry
 * prove overlap where they are as long (symmetry/cover/bounds.h). Odd sets are looked for exactly among at most 4,000 dart types,
 * beyond that by balls only. At most 2 * cover + 2 orbits of one copy type, with tube joints 2 * (d - 1) more for the d tubes at
 * either end; U-turns, at the price of their angle, wherever a best cover may need them (symmetry/cover/ruled_out.c), and never
 * with tube joints. Those add the rows of symmetry/cover/relaxation.h that every node is tied, and GLPK's branch and bound at the
 * root. An element that moves no node of a component maps its cords to themselves. THR_OK or THR_ELIMIT (out holds the best
 * found, with bounds; if there is none yet, out is empty); THR_EINFEASIBLE: a component has no node where a cord may end (named),
 * or there is none of this kind within the capacities and the number of ends; otherwise out is empty. */
thr_status thr_cover_find(const thr_quotient *quotient, const thr_cover_options *options, const thr_limits *limits,
                          thr_cover *out, thr_err *err) THR_MUST_CHECK;
void thr_cover_destroy(thr_cover *c);

/* The same, going on from what was found and proved before for the same quotient and options, but for options->quick; c is
 * replaced. An empty c: as thr_cover_find. */
thr_status thr_cover_improve(const thr_quotient *quotient, const thr_cover_options *options, const thr_limits *limits,
                             thr_cover *c, thr_err *err) THR_MUST_CHECK;

/* The cords of a cover: copies and pairs made concrete, orbit by orbit, and traced. record: which cord is a copy of which, and
 * the element that maps it there (graph/plan/plan.h). cord is allocated, [*n_cords], owned by the caller. */
thr_status thr_cover_cords(const thr_quotient *quotient, const thr_cover_options *options, const thr_cover *c, thr_cord **cord,
                           int *n_cords, thr_symmetry_record *record, thr_err *err) THR_MUST_CHECK;

/* The record of any cords: symmetric under the identity alone. options: where ends may be, and the joints. O(cords^2 * passes^2)
 * at worst. */
thr_status thr_cords_alone(const thr_frame *frame, const thr_cover_options *options, const thr_cord *cord, int n_cords,
                           thr_symmetry_record *record, thr_err *err) THR_MUST_CHECK;

#endif
