/* Route Inspection: the shortest cord that covers a framework (thesis, chapter 5 "Length"; Edmonds & Johnson 1973).
 *
 * Length = cover x sum of all lengths + a minimum T-join of the nodes that these passes leave odd. K cords have 2 K ends, which
 * may take odd nodes out of T (lp/tjoin/endjoin.h).
 *
 * Example: a square with one diagonal of length d: two odd nodes. Closed: 4 + 2 d, the diagonal twice; with two ends there: 4 +
 * d. */
#ifndef THR_POSTMAN_H
#define THR_POSTMAN_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/tjoin/engine.h"

/* Passes of the shortest cords that cover a framework, at most options.cords of them in every component, before anything runs
 * through them. */
typedef struct {
  int *passes; /* [n_edges] owned; only where a cord may end are they odd in number */
  int n_certificates;
  thr_certificate *certificate; /* one per component; owned */
  double length;                /* of these passes, in units */
  double lower_bound;           /* of the passes of any such cords */
  bool optimal;                 /* these are the shortest */
  thr_confirmations confirmed;  /* if the options ask for them */
} thr_shortest;

/* What optimal and lower_bound say is what graph/check/check.c verifies, never what the solver hopes. THR_OK: optimal.
 * THR_ELIMIT: out is valid and holds its bound. THR_EINFEASIBLE: a component has no node where a cord end is allowed, or given
 * ends that are no cords', or an edge has no room (named). Otherwise out is empty. */
thr_status thr_postman_shortest(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_shortest *out,
                                thr_err *err) THR_MUST_CHECK;
void thr_shortest_destroy(thr_shortest *shortest);

/* One cord per component through passes that leave at most two nodes of it with an odd number, paired for little turning
 * (graph/threading/tour.h). cord is allocated, [*n_cords] with their half arrays, for the caller; NULL on failure. Near-linear in
 * passes.
 */
thr_status thr_postman_cords(const thr_frame *frame, const thr_request *options, const int *passes, thr_cord **cord, int *n_cords,
                             thr_err *err) THR_MUST_CHECK;

/* What the certificates of shortest, which are moved, prove of these cords for the same framework and options: fills proof with
 * them, each join being that of the cords, and with what graph/check/check.c says. On failure (THR_ENOMEM, or THR_ESOLVER for
 * cords that do not pass the check) proof can still be released. */
thr_status thr_postman_prove(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                             thr_shortest *shortest, thr_length_proof *proof, thr_err *err) THR_MUST_CHECK;

/* Makes a plan: one shortest cord per component of the framework, its certificates, metrics and proof. The options'
 * end_node is copied. The proof is what graph/check/check.c verifies, never what the solver hopes.
 * THR_OK: optimal. THR_ELIMIT: plan is valid and holds its bound and gap. THR_EINFEASIBLE: a component has no node where a
 * cord end is allowed (named). THR_EINPUT: more than one cord per component. Otherwise the plan is empty. */
thr_status thr_postman_plan(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                            thr_err *err) THR_MUST_CHECK;

#endif
