/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the files of planner/ share with each other and with nobody else: every planner
 * behind one signature, proofs of one plan for the cords of another, cutting cords, and the order
 * of work. planner/planner.h says in which order to read the files. */
#ifndef THR_PLANNER_PARTS_H
#define THR_PLANNER_PARTS_H

#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tortuosity/proof/branch.h"

/* ---- The planners that the table of planner/dispatch.c chooses from. Private to planner/. */

thr_planner thr_planner_length, thr_planner_turning, thr_planner_symmetric;

/* Of any objective, with a limit on the pull: as few cords as that takes, then the aims
 * (planner/pull_limit.c). */
thr_planner thr_planner_pull;

/* Of any objective but symmetry: every edge is passed by options.distinct different cords
 * (planner/distinct.c). */
thr_planner thr_planner_distinct;

/* Some cords that tie the joints, or the shortest, for whoever keeps the best so far: sooner than a
 * search has any. shortest (NULL = not wanted) receives those of solid joints if they are proved to
 * be the shortest, else it is empty. */
void thr_planner_tell_first(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *shortest);

/* Do the shortest passes of solid joints and what runs through them take milliseconds, whatever the
 * time? And the part of it for a step, then a second at least. O(n + m). */
bool thr_planner_is_quick(const thr_frame *frame, const thr_request *options);
thr_limits thr_planner_share(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_step step);

/* What the cords of a plan with tube joints are proved to be as to their length. */
thr_status thr_planner_prove_tied(thr_plan *plan, const thr_limits *limits,
                                  thr_err *err) THR_MUST_CHECK;

/* Cords that take no search, sound but long, for whoever keeps the best so far; nothing where
 * nobody listens. */
void thr_planner_tell_at_once(const thr_frame *frame, const thr_request *options,
                              const thr_limits *limits);

/* A proof that was made for other cords of the same request, which is moved, is one of the cords of
 * plan as well; what it proves of these. from: a plan with a proof of length. claim: of the
 * turning, none where the cords are of another kind than it is about. */
thr_status thr_planner_prove_length(thr_plan *plan, thr_plan *from, thr_err *err) THR_MUST_CHECK;
thr_status thr_planner_prove_turning(thr_plan *plan, thr_turning_claim *claim,
                                     thr_err *err) THR_MUST_CHECK;

/* Returns a limit on the length of the plans that a claim is about (< 0: none), raised to what the
 * slack above the proved length allows, so that no plan is shut out that the request allows. */
double thr_planner_length_limit(const thr_plan *plan, double limit);

/* Does a plan serve the aims better than another, which may be empty? */
bool thr_planner_is_better(const thr_request *options, const thr_plan *a, const thr_plan *b);

/* Where the longest cord of a plan of the least length is to be short and may be half a percent
 * longer than it must: what the programme over walks proves of it (tortuosity/cords/walk_bound.c),
 * and the cords that it finds. Solid joints. Without a deadline the work is counted.
 */
thr_status thr_planner_even_length(thr_plan *plan, const thr_limits *limits,
                                   thr_err *err) THR_MUST_CHECK;

/* Short cords in every component, as few as the options allow, without their limits on the pull and
 * the length. */
thr_status thr_planner_some_cords(const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_plan *some,
                                  thr_err *err) THR_MUST_CHECK;

/* Few cords within options.max_pull, of any number up to options.cords in a component, by the
 * programme over walks (tortuosity/cords/walk_pull.c); without proofs. some: any cords, or none.
 * plan is empty where none were found. */
thr_status thr_planner_pull_few(const thr_frame *frame, const thr_request *options,
                                const thr_plan *some, const thr_limits *limits, thr_plan *plan,
                                thr_err *err) THR_MUST_CHECK;

/* Of a plan within options.max_length that is not proved to have the fewest cords, or is empty,
 * because shares of the shortest passes were not short enough: one of fewer cords, the longest of
 * which is short by annealing and walks, if there is one. Solid joints, one component. Bisection on
 * the number, a plan for each. *longest: of a given number, the longest cord of those that were
 * tried; 0: there were none. */
thr_status thr_planner_short_few(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, double *longest,
                                 thr_err *err) THR_MUST_CHECK;

/* The most cords that a component has, and which one has them. */
int thr_planner_most_cords(const thr_plan *plan, int *component);

/* *excluded: more cords in every component than the known number, but fewer than some component of
 * a plan within the pull has, are proved to be too few by walks, which may be taken; 0: none are.
 * Of a plan that is not within it they may be as many as the options allow. */
thr_status thr_planner_pull_too_few(const thr_frame *frame, const thr_request *options,
                                    const thr_plan *plan, int known, const thr_limits *limits,
                                    thr_walk_proof *walks, int *excluded,
                                    thr_err *err) THR_MUST_CHECK;

/* With a limit on the pull, of a plan for little length whose length is not proved: what the
 * programme over walks proves of it (tortuosity/cords/walk_pull.c). Solid joints. */
thr_status thr_planner_pull_length(thr_plan *plan, const thr_limits *limits,
                                   thr_err *err) THR_MUST_CHECK;

/* Measures cords that are others than the plan's claims of length and turning are about, and proves
 * of them what holds. */
thr_status thr_planner_prove_again(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Sets what the proof of a plan's length proves of its cords as they are. Solid joints. */
thr_status thr_planner_judge_length(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* With THR_AIM_PULL, raises what a claim, judged by the checker, proves of the cord that is hardest
 * to pull, as far as its tree, walks and few edges do. Else nothing. */
thr_status thr_planner_pull_least(const thr_frame *frame, const thr_request *request,
                                  const thr_cord *cord, int n_cords, const thr_limits *limits,
                                  thr_turning_claim *claim, thr_err *err) THR_MUST_CHECK;

/* Is what was asked to be least proved to be, by the plan's claims? Else THR_ELIMIT, and how far it
 * may be off. */
thr_status thr_planner_verdict(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Does a plan that is not proved to be best keep to all that was asked, and is it as near to its
 * bound as was asked? If neither a gap nor a time was (limits->usual), any bound will do, but of
 * plans for the least length. */
bool thr_planner_is_enough(const thr_plan *plan, const thr_limits *limits);

/* Is more asked of the turning's plan than its search knows, and the planner that composes it then
 * (planner/mixed.c). With a limit on the pull it plans for every aim, options.cords cords; seed
 * (NULL = none) is one of the plans to choose from, none of which has more cords; its cords and
 * proof of turning may be taken. THR_EINFEASIBLE: none of them keeps to what is asked. */
bool thr_planner_is_mixed(const thr_request *options);
thr_status thr_planner_mixed(const thr_frame *frame, const thr_request *options, thr_plan *seed,
                             const thr_limits *limits, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Shortens cords whose ends are free at both ends, such that every edge keeps the passes that it
 * needs, every cord one pass, and ends stay where they may be. What is left off together is the
 * most that can be, unless the search for that is cut off after some 1e5 choices. Bounds stay;
 * values, gaps and certificates become those of the shorter cords. *trimmed: did any change? Plans
 * that are proved the shortest, symmetric ones, tied ones and those of different cords over every
 * edge stay as they are. O(passes) beside the search. */
thr_status thr_plan_trim(thr_plan *plan, bool *trimmed, thr_err *err) THR_MUST_CHECK;

/* ---- recommend.c: what it tries, which advice does, too. */

/* Plans so many cords in every component, as asked but for their number, with little counted work
 * and without pricing walks. *plan stays empty where none are found; THR_ENOMEM else. report may be
 * NULL. */
thr_status thr_planner_try_cords(const thr_frame *frame, const thr_request *asked, int cords,
                                 const thr_limits *limits, thr_plan *plan, thr_report *report,
                                 thr_err *err) THR_MUST_CHECK;

/* *cords: the fewest in every component with which no edge needs more passes than request->cover:
 * half its nodes with an odd number of passes, where a cord has to end, or 1 where there are none.
 * 0: no cord may end at one of these nodes, or they are more than there may be. O(nodes + edges).
 */
thr_status thr_planner_bare_cords(const thr_frame *frame, const thr_request *request, int *cords,
                                  thr_err *err) THR_MUST_CHECK;

/* ---- cut.c: More cords by cutting few: a start for the cord that turns most, and the rows of
 * advice. */

/* Makes of one closed cord in every component a plan with cords that begin and end at one node
 * where an end may be, of these nodes where they turn most. opened is an empty plan; it stays empty
 * where a cord comes by no such node. O(passes). */
thr_status thr_cut_open(const thr_frame *frame, const thr_request *request, const thr_plan *closed,
                        thr_plan *opened, thr_err *err) THR_MUST_CHECK;

/* Opens the closed cords, one in every component, and cuts them into options->cords parts each;
 * with a range of numbers and a limit on pull or length into as few as keep to it, in every
 * component by itself. Cut closed cords stay closed only as one part. seed is an empty plan without
 * proofs; it stays empty where there are no such parts. */
thr_status thr_cut_few(const thr_frame *frame, const thr_request *options, const thr_plan *closed,
                       thr_plan *seed, thr_err *err) THR_MUST_CHECK;

/* Both, and a plan of the parts for options->cords. seed is an empty plan; it stays empty where
 * there are no such parts. */
thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed,
                        thr_err *err) THR_MUST_CHECK;

/* ---- recut.c: Closed cords joined to one where they cross, and cut again where nothing does. */

/* Passes from .. last, the other way round. */
void thr_passes_reverse(int *half, int from, int last);

/* Two closed cords through one node become one, in place of the first; the last cord takes the
 * place of the second. From a's first arm it goes to where b goes on, round b and to where a goes
 * on; or, backwards, to where b came from. If the channels a and b cross, neither way's do.
 * O(passes). */
thr_status thr_cords_join(thr_plan *plan, const thr_channel *a, const thr_channel *b,
                          bool backwards, thr_err *err) THR_MUST_CHECK;

/* How many cords each component has. */
typedef struct {
  const int *rank; /* [2 n_edges] of half-edges around their nodes (thr_channels_cross); borrowed */
  int n, n_cords;  /* components, cords of all */
  int *component;  /* [n_nodes] owned */
  int *cords;      /* [n] owned */
} thr_recut;

/* Sets all but rank. O(nodes + edges). Release with thr_recut_destroy, also on failure. */
thr_status thr_recut_count(thr_recut *recut, const thr_plan *plan, thr_err *err) THR_MUST_CHECK;
void thr_recut_destroy(thr_recut *recut);

/* Cuts closed cords in two until every component has as many as were counted, or no cut is left:
 * where a cord visits a node twice and its two channels can be led otherwise such that they cross
 * no other, and turn back into no edge (into one where no crossing is allowed and nothing else is
 * left). The longest cord of a component comes first, where it falls into the most even parts.
 * Drawn on a plane two such channels run side by side in opposite directions, so that every one of
 * these leads a cord otherwise that falls in two. Cords that are missing then, where no crossing is
 * allowed, go to and fro over an edge that needs no more passes: the cords are longer by them.
 * plan->cord has room for as many cords as were counted. O(cuts x pairs of channels of a node). */
thr_status thr_recut_cords(const thr_recut *recut, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* ---- channel_search.c: Cords without crossing channels, by branching on the channels of every
 * node. */

/* Looks again where exchanging channels pair by pair (planner/uncross.c) left crossings, or made a
 * component longer than it was: as many cords in that component, none longer than
 * options.max_length, without any crossing, over the passes that the plan had before (cord
 * before[n_before]), and then over any passes, the shortest first, that are shorter than those of
 * the plan now. Components of up to 40 edges; the work is counted: 1e6 choices in all, 2e5 for the
 * passes of one kind, 20,000 kinds of them, up to 1.25 times the length of a plan that crosses.
 * Nothing is missed but for these. What is not found is not proved not to be. *changed: cords were
 * replaced; claims and metrics are then of other cords. */
thr_status thr_channel_search(thr_plan *plan, const thr_cord *before, int n_before, bool *changed,
                              thr_err *err) THR_MUST_CHECK;

/* ---- distinct_few.c: Several different cords over every edge, through few edges: the shortest,
 * exactly. */

/* options.cords cords, no more and no fewer, that are to be short together and nothing else.
 * *n_cords = 0: too many edges or components, anything else is asked for, or the limits stop it.
 * cord is the caller's. */
thr_status thr_distinct_few(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_cord **cord, int *n_cords,
                            thr_err *err) THR_MUST_CHECK;

/* ---- even_turning.c: The cord that turns most: a symmetric start for it, and the exchanges from
 * there. */

/* A symmetric plan with as many cords in every component as options.cords, if there is one; else
 * seed stays empty. */
thr_status thr_even_seed(const thr_frame *frame, const thr_request *options,
                         const thr_limits *limits, thr_plan *seed, thr_err *err) THR_MUST_CHECK;

/* Replaces the cords of least by the better of what comes of its own and of the seed's (NULL =
 * none), which is tried first. enough: as in thr_max_turning_improve. */
thr_status thr_even_turning(const thr_frame *frame, const thr_plan *seed, double enough,
                            const thr_limits *limits, thr_least *least,
                            thr_err *err) THR_MUST_CHECK;

/* ---- images.c: Motions of a framework onto itself, for those who bound what cords cost
 * (tortuosity/proof/orbits.c). */

/* All of them, if they are not very many: to rounding; or to a ten-thousandth of the framework's
 * size, as coordinates in files are rounded, too. */
thr_orbits_motions thr_planner_motions;
thr_orbits_motions thr_planner_near_motions;

/* ---- order.c: The order of work: among threadings of equal value the one in which what is
 * threaded holds together. */

/* Beyond so many passes in a component its cords stay as they were found; longer cords are only
 * begun elsewhere. */
enum { THR_ORDER_MOST = 5000, THR_ORDER_REVERSED = 2500 };

/* As the plan's request asks (thr_order), cords of a plan without an evaluation are begun
 * elsewhere, turned round and numbered anew, such that the longest loose chain is short, and then
 * the sum of squares of all loose chains is small (graph/plan/chains.c). Passes, claims and their
 * proofs stay as they are; metrics are measured again. THR_ORDER_STARTS: if a chain that is longer
 * than a hand holds well gets shorter by it; without more turning or pull, or, in plans that are
 * short and nothing else, with as little as serves, a twentieth more turning at most. What changes:
 * - Closed cords, where ends do not matter, begin at a foot if they come by one, where a knot can
 * lie; all directions and, of few cords, all orders are tried (of many, that which holds together
 * best comes next).
 * - With solid joints parts of a cord between visits of its nodes are run the other way round, or
 * change places, as long as chains are longer than a hand holds well. THR_ORDER_HAND: whatever
 * makes chains shorter; in plans that are short and nothing else a cord may turn by a tenth more,
 * in all and as far as it is pulled. Other cords turn as much as before, and need no more pull.
 * - Copies in a symmetric plan follow their path. */
thr_status thr_plan_order(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* ---- What the files that order the work share. Private to planner/. */

/* How much a cord may turn, rad: in all, and before an end that is pulled
 * (thr_cord_pulled_turning). */
typedef struct {
  double turning, pulled;
  bool exactly; /* in all neither more nor less: a proof counts on it */
} thr_turning_room;

/* May a closed cord begin anywhere? Where ends matter its start is theirs. */
bool thr_order_turns(const thr_request *request, const thr_cord *cord);

/* Replaces the passes of cord c of the plan, within room, by those of less loose chains, after the
 * pieces that are kept, if it finds any: simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P.
 * Vecchi 1983). Parts between two visits of a node are run the other way round, and two parts of
 * three change places; where crossings of channels are not just allowed, only if there are no more
 * of them after it. At most 20,000 steps of O(passes). */
thr_status thr_order_reverse(const thr_plan *plan, int c, thr_turning_room room,
                             thr_threaded *threaded, thr_err *err) THR_MUST_CHECK;

enum { THR_HELD_WELL = 8 }; /* pieces of a loose chain that a hand holds well */

/* ---- starts.c: Every start of a closed cord: how loose what is threaded is from there, and how
 * hard the cord is to pull. */

/* chains[s]: the loose chains of the closed cord begun with pass s, after those that were kept.
 * What moves on from one start to the next are a few pieces: O(passes), but for a search through a
 * chain where a fold moves on. */
thr_status thr_starts_chains(const thr_frame *frame, const thr_request *request,
                             const thr_cord *cord, const thr_threaded *threaded, thr_chains *chains,
                             thr_err *err) THR_MUST_CHECK;

/* pulled[s]: thr_cord_pulled_turning of it, rad. O(passes log passes). */
thr_status thr_starts_pulled(const thr_frame *frame, const thr_cord *cord, double *pulled,
                             thr_err *err) THR_MUST_CHECK;

/* half[n_passes]: the passes of a closed cord begun with pass start; backwards: where that begins,
 * with the pass before it. */
void thr_starts_turn(const thr_cord *cord, int start, bool backwards, int *half);

#endif
