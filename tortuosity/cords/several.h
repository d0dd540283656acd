/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several cords: plans to start from, cords whose largest turning or pull is small, and cords that
 * differ over every edge.
 *
 * Read join.h first. several.c makes plans of several closed cords; maxturn.c lowers the largest
 * turning by exchanges, annealing and the walk model (walk_model.h), maxturn_small.c does so
 * exactly in small frameworks; distinct_cords.c and distinct_detour.c exchange passes between cords
 * until enough different cords pass every edge. */
#ifndef THR_SEVERAL_H
#define THR_SEVERAL_H

#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/branch.h"

/* ---- several.c: Plans with several closed cords in every component, to begin the search with:
 * covers by short circuits, the same number of passes everywhere, and in tiny frameworks all
 * choices of extra passes. */

/* Tries covers by short circuits over all edges, beginning with each edge in small frameworks; if
 * no plan is found, the same even number of passes over all edges; and in very small frameworks all
 * choices of at most 3 extra passes of every edge. A small framework of n edges takes n covers,
 * each of O(n^2) exchanges at worst. With tube joints, whose nodes circuits alone do not tie, cords
 * of few passes that tie every node take the place of the covers, with further circuits through
 * passes of their own. */
thr_status thr_several_plans(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* ---- maxturn.c: The largest turning of any cord: what the hand feels with several cords, each
 * pulled at both ends. */

/* The largest turning of a plan's cords, and what is proved of any plan's. */
typedef struct {
  double largest; /* price of the turns of the cord that turns most */
  double bound;   /* lower bound for every plan of the task: at least the mean of what a component's
                     cords are proved to turn together */
} thr_max_turning;

/* Evens out the turning of the cords in plan: of small components exactly
 * (tortuosity/cords/maxturn_small.c), else by exchanges: tails and heads of two open cords that
 * meet at a node, parts cut off one cord and joined to another, parts run the other way round, ends
 * moved to the other pass at their node; those that lower the sum of the 8th powers of the cords'
 * prices (so the largest counts most), and by simulated annealing a counted number at random. The
 * same from other ends, where the task allows them, and from other extra passes within its limits.
 * With tube joints all exchanges leave every node tied. Cords, prices, turning and length of plan
 * change; the plan's proof (of the sum) still holds, the claim of optimality (of the sum) may not.
 * Stops when the largest is at the bound, when the count is used up, or by the limits (no error).
 * The same input gives the same cords. enough > 0, rad: the search also stops as soon as no cord's
 * thr_cord_pulled_turning exceeds enough, or at once if some cord is proved to turn by more than
 * twice enough and 180 degrees. */
thr_status thr_max_turning_improve(const thr_frame *frame, double enough, const thr_limits *limits,
                                   thr_least *plan, thr_max_turning *out,
                                   thr_err *err) THR_MUST_CHECK;

/* Raises out->bound by the programme over walks (tortuosity/cords/walk_bound.c), whose prices go to
 * plan.proof, and replaces the cords if better ones are found, also when the limits stop the
 * search. motions: of the framework, approximate ones are enough; NULL: none. */
thr_status thr_max_turning_walks(const thr_frame *frame, double enough, thr_orbits_motions *motions,
                                 const thr_limits *limits, thr_least *plan, thr_max_turning *out,
                                 thr_err *err) THR_MUST_CHECK;

/* Lowers what an end of the cord that is hardest to pull has to overcome (thr_cord_pulled_turning;
 * closed cords begin where they turn sharpest), by simulated annealing of exchanges that keep the
 * passes. The number of steps is counted: of the limits only an interruption stops them. The plan's
 * cords stay if none are better. O(passes) a step. */
thr_status thr_max_turning_pull(const thr_frame *frame, const thr_limits *limits, thr_least *plan,
                                thr_err *err) THR_MUST_CHECK;

/* Replaces the plan's cords in small components by cords that turn least together, if the plan's
 * cords turn more: exactly, from the table that thr_max_turning_improve uses. */
thr_status thr_least_turning_small(const thr_frame *frame, const thr_limits *limits,
                                   thr_least *plan, thr_err *err) THR_MUST_CHECK;

/* ---- maxturn_small.c: The largest turning of any cord in small components, or that of all cords:
 * exact, by the table of graph/threading/small_cords.c. */

/* Cords of which the one that turns most turns least (even), or that turn least together, as many
 * in every component as the n_cords given ones are, which they are or improve. *found false: a
 * component is too large, or the table's cords pass an edge too often or are too long for the task;
 * then j is as it was. */
thr_status thr_max_turning_small(const thr_turning_columns *turning_columns, const thr_cord *cord,
                                 int n_cords, bool even, const thr_limits *limits, thr_join *j,
                                 bool *found, thr_err *err) THR_MUST_CHECK;

/* ---- distinct_cords.c: Different cords over every edge: passes are exchanged between cords until
 * enough different cords pass every edge. */

/* Changes cord[n_cords], a plan of the options (whose array is owned) of just so many cords, so
 * that more edges are passed by options.distinct different cords: by exchanges at the nodes at
 * random (simulated annealing), which keep the passes and serve the aims, too; where that does not
 * suffice, by detours over the edges that lack cords, as short as can be; and from other[n_cords]
 * (NULL: none), another plan of the options. Cords that keep to the options' greatest length and
 * pull still do, and all together are not longer than length_limit (< 0: none) unless they were.
 * They stay a plan of the options, which is perhaps longer, and are as before where nothing better
 * is found. Counted steps: the same input gives the same cords, unless the limits stop it. */
thr_status thr_distinct_make(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, double length_limit, const thr_cord *other,
                             thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;

/* ---- distinct_detour.c: Detours. Private to the files for different cords. */

/* Leads some of the cords cord[n_cords] over edges that fewer than options.distinct different cords
 * pass, by at most `most` detours. A detour leaves a cord at a node, turns back nowhere but at
 * nodes with one edge, and comes back to its node. Each is a shortest one for its edge.
 * O(half-edges log half-edges + passes) each. */
thr_status thr_distinct_detours(const thr_frame *frame, const thr_request *options, thr_cord *cord,
                                int n_cords, int most, thr_err *err) THR_MUST_CHECK;

/* ---- Simulated annealing of turns and extra passes, for the least turning of single cords. Read
 * join.h first, then anneal_turns.c (the proposals and the run), then anneal_turns_parts.c (the
 * state, changes that can be undone, and connected parts). */

/* ---- anneal_turns.c: Turns and extra passes changed together by simulated annealing (S.
 * Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983), for the least turning of single cords. */

/* Returns whether the annealing can serve the columns' task: solid joints, one cord in every
 * component, closed or open, turns that cost, and at most 64 edges at a node. */
bool thr_anneal_turns_serves(const thr_turning_columns *columns);

/* Anneals x[n_columns], whole numbers that keep the equations and are connected, in one run of so
 * many steps, or until the limits stop the run; x is replaced, and *better set, if a cheaper
 * connected state is found. cycles: those of the columns (thr_short_cycles_find). again: x was
 * found by such a run, and the temperature begins so low that most of x stays. seed: of the random
 * numbers. Cord ends stay at their nodes. A step takes O(length of a cycle * degree^2) and the
 * search for parts that are not connected; memory O(columns). */
thr_status thr_anneal_turns(const thr_turning_columns *columns, const thr_short_cycles *cycles,
                            bool again, int64_t steps, uint64_t seed, const thr_limits *limits,
                            int *x, bool *better, thr_err *err) THR_MUST_CHECK;

/* ---- anneal_turns_parts.c: What the annealing of turns is made of. */

/* Largest number of edges at a node, and of changes of columns that are proposed together. */
enum { THR_TURN_DEGREE = 64, THR_TURN_CHANGES = 5 * THR_CYCLE_MOST + 8 };

/* Whole numbers for all columns, and the changes that the current proposal has made to them. */
typedef struct {
  const thr_turning_columns *c;
  thr_scratch own;
  int *x;             /* [n_columns] */
  uint64_t *partners; /* [2 * n_edges] of a half-edge: bits of the positions, at its node, of the
                         half-edges that it has turns with */
  double *cost;       /* [n_columns] */
  int64_t spare;      /* extra length that is left, in units of c->length; INT64_MAX = no limit */
  int n_changes, change[THR_TURN_CHANGES][2]; /* column, by how much, in this order */
  double gain;                                /* price that the changes add */

  /* Scratch of thr_turn_parts. */
  int *label, *queue; /* [n_edges] source that an edge was reached from, -1 = none */
} thr_turn_state;

/* Starts with x[n_columns], which is copied, and without changes. On failure state is to be
 * destroyed too. */
thr_status thr_turn_state_init(thr_turn_state *state, const thr_turning_columns *columns,
                               const int *x, thr_err *err) THR_MUST_CHECK;
void thr_turn_state_destroy(thr_turn_state *state);

/* Returns the column of the turn between half-edges a and b of one node, or of the end at one of
 * them if the other one is -1. */
static inline int thr_turn_state_column(const thr_turn_state *state, int a, int b)
{
  return a < 0   ? state->c->end_column[b]
         : b < 0 ? state->c->end_column[a]
                 : thr_turning_column(state->c, a, b);
}

/* Adds `by` to a column and notes the change. */
void thr_turn_state_change(thr_turn_state *state, int column, int by);

/* Takes all noted changes back. */
void thr_turn_state_undo(thr_turn_state *state);

/* Returns the number of connected parts that hold an edge of a turn that was changed; 1 if there is
 * none. O(edges) at worst, few where the edges are connected nearby. */
int thr_turn_parts(thr_turn_state *state);

/* Returns the same number as it was before the changes. */
int thr_turn_parts_before(thr_turn_state *state);

#endif
