/* The least turning: extra passes, ends and pairings chosen together (docs/method.md).
 *
 * Minimize the sum of the prices of all turns (angle, sine or steps) over all threadings of the task; a first plan from least
 * joins, then branch and cut (tortuosity/proof/branch.h), then the integer proof, which is checked here once more.
 *
 * Example: two edges in line turn by 0 with ends anywhere; closed, the cord turns back at both ends: 2 pi. */
#ifndef THR_LEAST_H
#define THR_LEAST_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/orbits.h"

/* Cords of a plan. */
typedef struct {
  int n;
  thr_cord *cord; /* [n] */
} thr_least_start;

typedef struct {
  int cover, capacity; /* as in thr_request */
  bool tube;           /* tube joints; then start must be set, closed cords of any number */
  thr_ends ends;
  const bool *end_node; /* [n_nodes] THR_ENDS_NODES only; borrowed */
  const int *end_count; /* [n_nodes] THR_ENDS_COUNTS only; borrowed */
  int cords;            /* in every component, exactly, unless the ends are counted; 0 = 1 */
  int most_passes;      /* of an edge; 0 = 4 * cover + 4 */
  thr_turn_cost cost;
  double length_slack;     /* extra cord allowed above the shortest plan found, as a part of its length; < 0 = any length */
  double price_per_length; /* of extra cord, in the turns' price per unit of length */
  const thr_cord *start;   /* [n_start] a plan of the task to begin with; borrowed, NULL = none */
  int n_start;
  const thr_least_start *also; /* [n_also] plans of solid joints that the result turns no more than, whatever the time; they may
                                  turn back; borrowed */
  int n_also;
  bool slack_from_start;       /* start is the shortest plan known: the shortest passes hold none */
  int most_nodes;              /* of the branching tree; 1 = the root only, 0 = no linear programme */
  thr_orbits_motions *motions; /* asked when a tree begins: its nodes then decide for all images of a column; NULL = none */
} thr_least_options;

thr_least_options thr_least_options_default(void);

typedef struct {
  thr_turning_task task; /* what the proof is about; end_allowed is owned by this struct */
  bool *end_allowed;     /* [n_nodes] or NULL */
  int n_cords;
  thr_cord *cord; /* [n_cords] owned */
  double price;   /* of all turns and extra cord; where a cord has both ends at one node, nothing turns there (closed: it does) */
  double turning; /* rad, whatever the cost */
  double length, shortest; /* of these cords; of the shortest plan found for the same options. The shortest passes may not hold so
                              many cords: then those that a search without a limit finds count (docs/method.md) */
  double length_limit;     /* what the proof is restricted to; < 0 = none */
  double bound;            /* no plan of the task has a lower price: what the check of the proof says */
  bool optimal;            /* price and bound agree within 1e-9 of a U-turn per pass */
  bool shortened;          /* of plans that turn as little it is a short one already */
  const char *open;        /* why it is not proved; static text, NULL if optimal */
  thr_turning_proof proof;
  int rounds; /* linear programmes solved */
} thr_least;

/* THR_OK: optimal. THR_ELIMIT: the limits or the size of the tree stopped it; out holds the best plan, its bound and the proof of
 * that. THR_EINFEASIBLE: no node for an end, or no plan within most_passes and
 * length found (with several closed cords that proves nothing). Otherwise out is empty. */
thr_status thr_least_turning(const thr_frame *frame, const thr_least_options *options, const thr_limits *limits, thr_least *out,
                             thr_err *err) THR_MUST_CHECK;
void thr_least_destroy(thr_least *least);

/* Passes that the search takes: prices in units of 2^-THR_TURNING_BITS must add up in 64 bits. */
extern const int thr_least_most_passes;

/* Steps that other makers of cords share: the task of the options, and cords with price, turning and length from a joined
 * multigraph. */
thr_status thr_least_task(const thr_frame *frame, const thr_least_options *options, thr_least *out, thr_err *err) THR_MUST_CHECK;
thr_status thr_least_cords(const thr_frame *frame, const thr_join *j, thr_least *out, thr_err *err) THR_MUST_CHECK;

/* Sets optimal from price and bound, and open: why, if it is not. */
void thr_least_judge(thr_least *least, const char *why);

#endif
