/* The planners that the table of planner/dispatch.c chooses from. Private to planner/. */
#ifndef THR_PLANNERS_H
#define THR_PLANNERS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/length/cords.h"
#include "planner/dispatch.h"

thr_planner thr_planner_length, thr_planner_turning, thr_planner_symmetric;

/* Of any objective, with a limit on the pull: as few cords as that takes, then the aims (planner/pull_limit.c). */
thr_planner thr_planner_pull;

/* Of any objective but symmetry: every edge is passed by options.distinct different cords (planner/distinct.c). */
thr_planner thr_planner_distinct;

/* Some cords that tie the joints, or the shortest, for whoever keeps the best so far: sooner than a search has any. shortest
 * (NULL = not wanted) receives those of solid joints if they are proved to be the shortest, else it is empty. */
void thr_planner_tell_first(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *shortest);

/* Do the shortest passes of solid joints and what runs through them take milliseconds, whatever the time? And the part of it
 * for a step, then a second at least. O(n + m). */
bool thr_planner_is_quick(const thr_frame *frame, const thr_request *options);
thr_limits thr_planner_share(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_step step);

/* What the cords of a plan with tube joints are proved to be as to their length. */
thr_status thr_planner_prove_tied(thr_plan *plan, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Cords that take no search, sound but long, for whoever keeps the best so far; nothing where nobody listens. */
void thr_planner_tell_at_once(const thr_frame *frame, const thr_request *options, const thr_limits *limits);

/* A proof that was made for other cords of the same request, which is moved, is one of the cords of plan as well; what it proves
 * of these. from: a plan with a proof of length. claim: of the turning, none where the cords are of another kind than it is
 * about. */
thr_status thr_planner_prove_length(thr_plan *plan, thr_plan *from, thr_err *err) THR_MUST_CHECK;
thr_status thr_planner_prove_turning(thr_plan *plan, thr_turning_claim *claim, thr_err *err) THR_MUST_CHECK;

/* Returns a limit on the length of the plans that a claim is about (< 0: none), raised to what the slack above the proved length
 * allows, so that no plan is shut out that the request allows. */
double thr_planner_length_limit(const thr_plan *plan, double limit);

/* Does a plan serve the aims better than another, which may be empty? */
bool thr_planner_is_better(const thr_request *options, const thr_plan *a, const thr_plan *b);

/* thr_cords_plan, for solid joints and one component. Where the longest cord is to be short and may be half a percent longer than
 * it must, again from other passes: those that are shortest if the edges were a little longer, each by chance. */
thr_status thr_planner_even_starts(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                   thr_cords_word *word, thr_err *err) THR_MUST_CHECK;

/* Where the longest cord of a plan of the least length is to be short and may be half a percent longer than it must: what the
 * programme over walks proves of it (tortuosity/cords/walk_bound.h), and the cords that it finds. Solid joints. Without a
 * deadline the work is counted.
 */
thr_status thr_planner_even_length(thr_plan *plan, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Short cords in every component, as few as the options allow, without their limits on the pull and the length. */
thr_status thr_planner_some_cords(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *some,
                                  thr_err *err) THR_MUST_CHECK;

/* Few cords within options.max_pull, of any number up to options.cords in a component, by the programme over walks
 * (tortuosity/cords/walk_pull.h); without proofs. some: any cords, or none. plan is empty where none were found. */
thr_status thr_planner_pull_few(const thr_frame *frame, const thr_request *options, const thr_plan *some,
                                const thr_limits *limits, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Of a plan within options.max_length that is not proved to have the fewest cords, or is empty, because shares of the shortest
 * passes were not short enough: one of fewer cords, the longest of which is short by annealing and walks, if there is one. Solid
 * joints, one component. Bisection on the number, a plan for each. *longest: of a given number, the longest cord of those that
 * were tried; 0: there were none. */
thr_status thr_planner_short_few(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                 double *longest, thr_err *err) THR_MUST_CHECK;

/* The most cords that a component has, and which one has them. */
int thr_planner_most_cords(const thr_plan *plan, int *component);

/* *excluded: more cords in every component than the known number, but fewer than some component of a plan within the pull has,
 * are proved to be too few by walks, which may be taken; 0: none are. Of a plan that is not within it they may be as many as the
 * options allow. */
thr_status thr_planner_pull_too_few(const thr_frame *frame, const thr_request *options, const thr_plan *plan, int known,
                                    const thr_limits *limits, thr_walk_proof *walks, int *excluded, thr_err *err) THR_MUST_CHECK;

/* With a limit on the pull, of a plan for little length whose length is not proved: what the programme over walks proves of it
 * (tortuosity/cords/walk_pull.h). Solid joints. */
thr_status thr_planner_pull_length(thr_plan *plan, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Measures cords that are others than the plan's claims of length and turning are about, and proves of them what holds. */
thr_status thr_planner_prove_again(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Sets what the proof of a plan's length proves of its cords as they are. Solid joints. */
thr_status thr_planner_judge_length(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* With THR_AIM_PULL, raises what a claim, judged by the checker, proves of the cord that is hardest to pull, as far as its tree,
 * walks and few edges do. Else nothing. */
thr_status thr_planner_pull_least(const thr_frame *frame, const thr_request *request, const thr_cord *cord, int n_cords,
                                  const thr_limits *limits, thr_turning_claim *claim, thr_err *err) THR_MUST_CHECK;

/* Is what was asked to be least proved to be, by the plan's claims? Else THR_ELIMIT, and how far it may be off. */
thr_status thr_planner_verdict(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Does a plan that is not proved to be best keep to all that was asked, and is it as near to its bound as was asked? If neither a
 * gap nor a time was (limits->usual), any bound will do, but of plans for the least length. */
bool thr_planner_is_enough(const thr_plan *plan, const thr_limits *limits);

/* Is more asked of the turning's plan than its search knows, and the planner that composes it then (planner/mixed.c). With a
 * limit on the pull it plans for every aim, options.cords cords; seed (NULL = none) is one of the plans to choose from, none of
 * which has more cords; its cords and proof of turning may be taken. THR_EINFEASIBLE: none of them keeps to what is asked. */
bool thr_planner_is_mixed(const thr_request *options);
thr_status thr_planner_mixed(const thr_frame *frame, const thr_request *options, thr_plan *seed, const thr_limits *limits,
                             thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Shortens cords whose ends are free at both ends, such that every edge keeps the passes that it needs, every cord one pass, and
 * ends stay where they may be. What is left off together is the most that can be, unless the search for that is cut off after
 * some 1e5 choices. Bounds stay; values, gaps and certificates become those of the shorter cords. *trimmed: did any change?
 * Plans that are proved the shortest, symmetric ones, tied ones and those of different cords over every edge stay as they are.
 * O(passes) beside the search. */
thr_status thr_plan_trim(thr_plan *plan, bool *trimmed, thr_err *err) THR_MUST_CHECK;

#endif
