/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The independent checker: recomputes every claim of a plan from its framework and cords, with no
 * solver.
 *
 * Every lower bound in a plan comes with a proof: odd cuts for the length, trees of multipliers for
 * the turning, prices of walks for the longest or hardest cord. This room verifies proofs, which is
 * far easier than finding them, and shares no search with the planners. Small components need no
 * proof: tables over all sets of their edges are made here and serve planners, too.
 *
 * Reading order: check.c (the whole plan), check_walked.c (the cords), then one proof at a time:
 * length in check_certificate.c, check_length.c, check_cords.c, ways_in.c, prices.c; turning in
 * check_turning.c, turning_proof.c, turning_leaf.c, turning_ranks.c, turning_symmetry.c,
 * junction.c; walks and pulls in walk_proof.c, walk_places.c, check_pull.c; tables in edge_sets.h;
 * symmetry in check_group.c, check_symmetry.c; what a plan says of its physics in
 * check_evaluation.c, check_schedule.c, check_standing.c. */
#ifndef THR_CHECK_H
#define THR_CHECK_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* Integer weight of an edge under a certificate's scale. */
int64_t thr_certificate_weight(const thr_frame *frame, const thr_certificate *certificate, int e);

/* Verifies all certificates, one per component, in exact integers: sets odd and inside the
 * component, multipliers >= 0, no edge overloaded, no node with a cord end held beyond the end
 * price, sum and join as stated. Gives the lower bound on the plan's length: the length itself if
 * every component is optimal. *optimal and *lower_bound are what a plan may claim. THR_EVIOLATED
 * with the place and the numbers. O(nodes + edges + size of the certificates * sqrt(edges) *
 * log(cuts)) at worst. pulled: what prices of walks prove of the length within options.max_pull
 * (NULL: none). */
thr_status thr_check_length_proof(const thr_frame *frame, const thr_request *options,
                                  const thr_cord *cord, int n_cords,
                                  const thr_certificate *certificate, int n_certificates,
                                  const thr_walk_proof *pulled, bool *optimal, double *lower_bound,
                                  thr_err *err) THR_MUST_CHECK;

/* What may be claimed of these cords, as many as the options say, with these certificates (NULL, 0
 * = none): fills found. Their longest is at least the least length of all cords of a component over
 * the number of them allowed there, and the shortest way for a cord over any edge. Cords of at most
 * max_length are too few where their least length, by the certificate with so many ends, is more
 * than they can have. walks (NULL = none): prices that bound the longest, too. As
 * thr_check_length_proof, and a Dijkstra from the allowed ends; closed: one round the longest edges
 * each, up to 2^24 steps. */
thr_status thr_check_cords(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                           int n_cords, const thr_certificate *certificate, int n_certificates,
                           const thr_walk_proof *walks, thr_cords_claim *found,
                           thr_err *err) THR_MUST_CHECK;

/* *least: no cords of a component, as many as it may have, are shorter together. Otherwise as
 * thr_check_cords. */
thr_status thr_check_component_least(const thr_frame *frame, const thr_request *options,
                                     const thr_cord *cord, int n_cords,
                                     const thr_certificate *certificate, int n_certificates,
                                     int component, double *least, thr_err *err) THR_MUST_CHECK;

/* The same with tube joints, by their proof of length (graph/plan/plan_measures.h). */
thr_status thr_check_tied_cords(const thr_frame *frame, const thr_request *options,
                                const thr_cord *cord, int n_cords, const thr_turning_proof *tied,
                                thr_cords_claim *found, thr_err *err) THR_MUST_CHECK;

/* What the tree of a claim proves about these cords (which must cover the framework as the options
 * say): fills found but for its tree. Of the claim only tree, most_passes and length_limit are
 * read. Optimal: the bound meets the price within the rounding of the sum. THR_EVIOLATED: the tree
 * proves nothing, or the cords are not of the kind that the proof is about. O(leaves * columns). */
thr_status thr_check_turning(const thr_frame *frame, const thr_request *options,
                             const thr_cord *cord, int n_cords, const thr_turning_claim *claim,
                             thr_turning_claim *found, thr_err *err) THR_MUST_CHECK;

/* Are so many cords in every component, or fewer (but not fewer than options.cords_least), too few
 * for options.max_pull? They are if one of them turns by more than thr_request_most_pulled on one
 * side of its cut turn: by single edges, by what the claim's tree (there may be none) proves of all
 * turns, shared out evenly, or in components of few edges by all sets of cords. It is about
 * threadings within a pull as docs/plan-format.md has them, of at most most_passes over any edge.
 * Reads tree, cut and most_passes of the claim. THR_EVIOLATED: the tree proves nothing. As
 * thr_check_turning. */
thr_status thr_check_too_few(const thr_frame *frame, const thr_request *options, int cords,
                             const thr_pull_claim *claim, bool *too_few,
                             thr_err *err) THR_MUST_CHECK;

/* *fewest: cords that options.max_pull takes in all components together: in some one more than are
 * excluded, in the others the least number asked for, or if that is more what all sets of cords
 * through few edges show. Not more than there are in any component, cords[components]. */
thr_status thr_check_fewest_pulled(const thr_frame *frame, const thr_request *options,
                                   const int *cords, int components, int excluded, int *fewest,
                                   thr_err *err) THR_MUST_CHECK;

/* The same for passes[n_edges] that no cords run through yet, *lower_bound then being one on their
 * length. THR_EVIOLATED also where cords cannot run so: too few passes of an edge, an odd number at
 * a node where no cord can end. */
thr_status thr_check_length_of_passes(const thr_frame *frame, const thr_request *options,
                                      const int *passes, const thr_certificate *certificate,
                                      int n_certificates, bool *optimal, double *lower_bound,
                                      thr_err *err) THR_MUST_CHECK;

/* What the checker, which said found and returned st, means to whoever has just made what it looked
 * at: a violation is a fault of the program, THR_ESOLVER. */
thr_status thr_check_own(thr_status st, const thr_err *found, thr_err *err) THR_MUST_CHECK;

/* Verifies the whole plan. THR_OK, or THR_EVIOLATED with the first violation: cord, pass, nodes or
 * certificate, cut, edge. */
thr_status thr_check_plan(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
