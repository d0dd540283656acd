/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of symmetry/cover share among themselves and with symmetry/lift: relaxations,
 * bounds, searches and claims. symmetry/cover/cover.h says in which order to read the room. */
#ifndef THR_COVER_PARTS_H
#define THR_COVER_PARTS_H

#include "lp/model/tree.h"
#include "lp/tjoin/tjoin.h"
#include "symmetry/cover/cover.h"
#include "symmetry/symmetry.h"

/* ---- bounds.c: What no symmetric cover is better than, by one minimum T-join
 * (symmetry/cover/start.c) or by counting. */

/* A symmetric cover is a cover: the bound for the programme, and that for the group of the identity
 * alone, which holds as well.
 */
thr_status thr_bounds_overlap(const thr_programme *p, const thr_limits *limits, double *bound,
                              thr_err *err) THR_MUST_CHECK;

/* Steps or paths of the covers whose overlap is at most this. */
thr_status thr_bounds_tie(const thr_programme *p, thr_aim tie, double overlap,
                          const thr_limits *limits, double *bound, thr_err *err) THR_MUST_CHECK;

/* One path for every orbit of components. */
thr_status thr_bounds_paths(const thr_programme *p, double *bound, thr_err *err) THR_MUST_CHECK;

/* ---- claims.c: What the bounds of a cover prove of threadings as a plan counts them. */

/* Cords can run alike where an edge needs several passes. Elsewhere, of threadings that run alike
 * in part, or round several times, one has no more overlap, steps, paths or turning than the others
 * and no cords alike. */
typedef struct {
  bool repeats;  /* a part of the framework has cords that may run alike: weaker bounds */
  bool retraces; /* the plan has more steps than the cover, and so may threadings that are no better
                    than it */
  double least[THR_N_AIMS]; /* of every threading under H with the aims before at most at the plan's
                               values */
} thr_claims;

/* cover: with a cover; steps: of the plan that is made of it. O(order * edges + types); and a
 * T-join where overlap comes after an aim that a plan counts otherwise. */
thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options,
                           const thr_cover *cover, double steps, thr_claims *out,
                           thr_err *err) THR_MUST_CHECK;

/* ---- relaxation.c: The linear programme over the columns of symmetry/cover/programme.c, with rows
 * added as a point violates them (branch and cut: M. Padberg & G. Rinaldi, SIAM Review 33, 1991).
 */

typedef struct {
  const thr_programme *p;
  thr_search search; /* fixed rows: the equations; columns as x */
  thr_aim aim;       /* minimized at present */
  bool circles;      /* circles count from now on: paths are, or were, minimized */
  double *x;         /* [p->n] of the last solve */
  double objective; /* of the last solve, in the aim's unit, with its constant; rounded up to what a
                       cover can have */
  /* odd sets */
  thr_tjoin_problem problem;
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  int *column;    /* [problem.n_edges] that the edge stands for */
  double *metric; /* [problem.n_edges] overlap that it costs, in parts of the largest */
  bool *surplus; /* [problem.n_edges] or rather for the surplus of its edge orbit over the cover? */
  double *weight; /* [problem.n_edges] scratch */
} thr_relaxation;

/* THR_ELIMIT: stopped; relaxation is empty. */
thr_status thr_relaxation_init(thr_relaxation *relaxation, const thr_programme *p,
                               const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_relaxation_destroy(thr_relaxation *relaxation);

/* Adds the row that the pool of relaxation->search has put together, with this right side.
 * THR_ELIMIT: stopped. */
thr_status thr_relaxation_add_row(thr_relaxation *relaxation, double lower,
                                  thr_err *err) THR_MUST_CHECK;

/* The same if x violates it and it is new, counted in *added. */
thr_status thr_relaxation_add_violated(thr_relaxation *relaxation, double lower, int *added,
                                       thr_err *err) THR_MUST_CHECK;

/* In symmetry/cover/tie_rows.c, for tube joints. Between the b blocks of any partition of the tubes
 * at a node there are b - 1 turns: at first between all tubes; then, by a separator of a
 * thr_relaxation, for the blocks that turns join with more than some value of x, and where there
 * are few tubes for any two blocks. */
thr_status thr_relaxation_tie_first(thr_relaxation *relaxation, thr_err *err) THR_MUST_CHECK;
thr_status thr_relaxation_tie(void *relaxation, int *added, thr_err *err) THR_MUST_CHECK;

/* What is minimized from now on. */
thr_status thr_relaxation_aim(thr_relaxation *relaxation, thr_aim aim, thr_err *err) THR_MUST_CHECK;

/* Keeps the present aim at most at this value. */
thr_status thr_relaxation_fix(thr_relaxation *relaxation, double value,
                              thr_err *err) THR_MUST_CHECK;

/* After a solve that found an optimum: fills objective, and search.whole: is x integral? */
void thr_relaxation_look(thr_relaxation *relaxation);

/* The column to branch on where x is not whole: copies of edges with several types, other copies,
 * ends, turns; of these the most undecided. */
int thr_relaxation_branch(const thr_relaxation *relaxation);

/* ---- cover_search.c: The search for the best whole solution of a programme
 * (symmetry/cover/programme.c), aim by aim: when one is settled, or its time is up, its value
 * becomes a row and the next is minimized. */

typedef struct {
  const thr_programme *p;
  const thr_limits *limits;
  thr_relaxation r; /* made when it is needed */
  int kept;         /* so many aims, the first ones, have rows in r that keep them */
  bool found;
  bool lifted,
      valid;  /* the last that was tried: are there turns for it, and can it be made concrete? */
  int *best;  /* [p->n] the best so far, if found */
  int *other; /* [p->n] scratch */
  double worth[THR_N_AIMS], bound[THR_N_AIMS];
} thr_cover_search;

/* Without a solution, and with bounds of 0. */
thr_status thr_cover_search_init(thr_cover_search *s, const thr_programme *p,
                                 const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_cover_search_destroy(thr_cover_search *s);

/* Keeps s->other if it can be made concrete and is better than the best so far; s->valid: can it?
 */
thr_status thr_cover_search_offer(thr_cover_search *s, thr_err *err) THR_MUST_CHECK;

/* Is the best so far as good as this bound? */
bool thr_cover_search_beaten(const thr_cover_search *s, thr_aim aim, double bound);

/* Minimizes the first n aims by branch and cut, best bound first, each with those before it kept.
 * THR_ELIMIT: stopped; THR_EINFEASIBLE: there is no solution. */
thr_status thr_cover_search_aims(thr_cover_search *s, int n, thr_err *err) THR_MUST_CHECK;

/* ---- solve.c: The best threading under each group of the table, and who gets how much of the
 * time: all get a little, then those that are open and may still be the best get more. */

/* Fills the rows that are asked for. With a deadline: first all rows, overlap and learned steps
 * only; then, likewise, those that may yet become the default choice; then what is left goes to all
 * proofs, in equal shares, those with the fewest learned steps first. only_choice: rows that
 * another is sure to be chosen before are left out, and say which (thr_symmetry_row.behind). */
thr_status thr_symmetry_solve(const thr_frame *frame, const thr_request *options, bool only_choice,
                              const thr_limits *limits, thr_symmetries *symmetries,
                              thr_err *err) THR_MUST_CHECK;

/* What the shortest cords with tube joints need, in units: few, and the cords need not be closed:
 * with one cord in each component, or else as few as can be; otherwise any number of cords. Closed
 * cords can always be joined to one. *optimal = false: what the shortest that was found in time
 * needs, or if none was, what the edges need. */
thr_status thr_symmetry_shortest_tied(const thr_frame *frame, const thr_request *options, bool few,
                                      const thr_limits *limits, double *length, bool *optimal,
                                      thr_err *err) THR_MUST_CHECK;

/* Is this row asked for? group: the request's symmetry.group, a row's number from 1 or its name; ""
 * = all rows. */
bool thr_symmetry_asked(const thr_symmetries *symmetries, int row, const char *group);

/* ---- turning_bound.c: How much the cords of a symmetric cover turn at least, known at once. */

/* By a dual ascent at every node, in O(pair types): multipliers u >= 0 of the dart types with u[a]
 * + u[b] <= the price of every turn; an edge orbit that is covered pays those of its darts. Where
 * trails may end, either u = 0 or every end costs as much as the largest u there;
 * worth[THR_AIM_PATHS], if that aim comes before turning, says how many ends there are at most.
 * rad. No cover with that many paths turns less; the other aims do not matter. */
thr_status thr_turning_quick_bound(const thr_programme *p, const double worth[THR_N_AIMS],
                                   double *bound, thr_err *err) THR_MUST_CHECK;

#endif
