/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The walk model: linear programmes whose columns are the walks that cords can be within a limit on
 * their turning, their length or their pull.
 *
 * The programmes serve plans of several cords in two ways. Their dual prices prove that a limit is
 * too low, and hence bound the largest turning, the longest cord, the number of cords, or the total
 * length within a pull (graph/plan/walk_proof.h has the proof and its theorem). Their columns are
 * good cords, from which dives choose plans.
 *
 * Reading order: graph/plan/walk_proof.h first; walk_programme.c (the programme, and pricing by the
 * recursion over walks), walk_centre.c (prices near the middle) and walk_memory.c (stronger
 * programmes); then walk_dive.c (cords from columns); last what others call,
 * walk_bound.c (turning and length) and walk_pull.c (pull). walk_search.c stands alone: single
 * short walks, by graph search. */
#ifndef THR_WALK_MODEL_H
#define THR_WALK_MODEL_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/arrays.h"
#include "graph/status.h"
#include "graph/threading/threading.h"
#include "lp/model/tree.h"
#include "tortuosity/proof/branch.h"

/* ---- walk_bound.c: lower bounds on the largest turning, length or pull of a cord, and cords
 * little above the bound ---- */

typedef struct {
  thr_walk_measure measure;
  const thr_cord *cord; /* [n_cords] */
  int n_cords;
  double least;  /* proved: of the turning of all cords of the most expensive one's component, or
                    their  length */
  double enough; /* > 0: asked is only whether some cord costs more; one limit is tried, and better
                    cords are looked for just below it */
  thr_orbits_motions *motions; /* near ones will do; NULL: none */
} thr_walk_ask;

/* Raises *bound, on the turning of the cord that turns most, the pulled turning of the one that is
 * hardest to pull, of which no better cords are looked for, or the length of the longest, as far as
 * the highest limit below which the walks are too few: by bisection, in the component of that cord.
 * proof receives the prices, if there are any; what it held is released. *better, NULL at first,
 * receives n_cords cords of which the most expensive costs less, if the columns make some; the
 * caller's. Nothing is done for one cord in each component, or where places and units are more than
 * the recursion takes in a moment. A large framework that motions map onto itself is bounded by
 * prices that are the same for all images; then no cords are looked for. */
thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_walk_ask *ask,
                          const thr_limits *limits, thr_walk_proof *proof, double *bound,
                          thr_cord **better, thr_err *err) THR_MUST_CHECK;

/* ---- walk_programme.c: the linear programme over the walks that the cords of one component can be
 * below a limit ---- */

/* A first pass, and the sum of prices of the best walk that begins with this pass. */
typedef struct {
  int64_t worth;
  const thr_walk_step *first;
} thr_walk_start;

typedef struct {
  const thr_turning_columns *c;
  const thr_limits *limits;
  int component, cords; /* that it has at most */
  double least;         /* of the turning of its cords together, or their length; 0: not known */
  thr_scratch own;      /* the arrays */
  thr_walk_steps steps;
  int n_memories;
  thr_walk_memory *memory;       /* what the walks remember, as in a proof; owned */
  int64_t unit;                  /* of turning or length */
  int most_units;                /* that the table is for */
  int n_variables, *edge, *node; /* [n_edges], [n_nodes] their variables, -1: none. The last one, if
                                    least > 0: of all */
  int n_edges;                   /* variables of edges, which come first */
  bool lengths; /* with a pull: walks cost their length, else each as much, and the last variable is
                   a cord's price */
  double *right,
      *upper; /* [n_variables] the right sides: costs of the dual; and what a variable is at most */
  double scale, longest; /* of prices to the integers of a proof; with a pull 1 is the length of the
                            longest edge */
  double enough;   /* with a pull: a bound on the length that ends the search, or so few cords */
  double dearest;  /* with a pull: price of a pass at most */
  double per_cord; /* with a pull, 0: the cords are as many as there may be; else what one of any
                      number costs */
  int units;       /* of the limit that is being tried */
  bool to_exclude; /* is the limit to be excluded, or are walks looked for? */
  bool excluded;   /* it is, by the prices in trial */
  double *x, *middle, *try; /* [n_variables] the last optimum, the best so far, what is priced */
  int run;                  /* of the recursions, the one that was looked at last */
  double best;              /* number of cords that the best proves, or their length; 0: none yet */
  int64_t *value; /* [tables * steps.n * thr_walk_levels(most_units)] of the recursion; owned */
  thr_walk_start *start; /* [most first passes] in the order of their worth */
  bool *passed; /* [n_edges] by a walk that was found in this look at a recursion, or an image of it
                 */
  int *half;    /* a walk while it is traced */
  thr_walk_proof trial;
  thr_search search; /* rows: index is the number of units, member the walk's half-edges in order */
  thr_pool walks;    /* of all limits so far */
} thr_walk_programme;

/* For the component of the cord that turns most, or is longest, with a unit of which most of its
 * turns, or edges, are nearly whole numbers. least: the proved least of the turning of that
 * component's cords together, or of their length. THR_ELIMIT: too large for the recursion. On
 * failure programme is to be destroyed too. */
thr_status thr_walk_programme_init(thr_walk_programme *programme,
                                   const thr_turning_columns *columns, thr_walk_measure measure,
                                   const thr_cord *cord, int n_cords, double least,
                                   const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* The same for all cords of a component within options.max_pull, as many as suffice; or if lengths
 * count a given number: then a variable more is the price of a cord, and walks cost their length.
 * units are set. cord: of which one that pulls hardest says what unit is used. */
thr_status thr_walk_programme_init_pull(thr_walk_programme *programme,
                                        const thr_turning_columns *columns,
                                        const thr_request *options, const thr_cord *cord,
                                        int n_cords, int component, bool lengths,
                                        const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_walk_programme_destroy(thr_walk_programme *programme);

/* What has the same edge[n_edges] or node[n_nodes], the lowest of each, has one price from now on
 * (tortuosity/proof/orbits.c). That proves as much where all are images of each other, and walks
 * that are images of each other are one row; but cords cannot be chosen from them. Before any walk
 * is known. */
thr_status thr_walk_programme_merge(thr_walk_programme *programme, const int *edge, const int *node,
                                    thr_err *err) THR_MUST_CHECK;

/* Returns the price (of turns, or length) of so many units, rounded down. */
double thr_walk_programme_price(const thr_walk_programme *programme, int units);

/* Begins the search for a limit of `units` units, with the known walks that keep to the limit.
 * price: of a pass that no walk makes. */
thr_status thr_walk_programme_begin(thr_walk_programme *programme, int units, double price,
                                    thr_err *err) THR_MUST_CHECK;

/* Adds the walk of a cord of the component. */
thr_status thr_walk_programme_add(thr_walk_programme *programme, const thr_cord *cord,
                                  thr_err *err) THR_MUST_CHECK;

/* Adds walks, at most so many times, until the optimum knows all that it needs or the limit is
 * excluded. */
thr_status thr_walk_programme_rounds(thr_walk_programme *programme, int most_rounds,
                                     thr_err *err) THR_MUST_CHECK;

/* Separates: adds the walks with the largest sums of prices x[n_variables], as far as they differ
 * and the last optimum violates their rows, and counts them in *added. Where limits are to be
 * excluded, also computes what the prices prove: best, middle and excluded. With closed walks,
 * which take many recursions, ends as soon as there are some walks. */
thr_status thr_walk_programme_look(thr_walk_programme *programme, const double *x, int *added,
                                   thr_err *err) THR_MUST_CHECK;

/* Separates at prices between the last optimum, x, and the best so far; if no walk is found there,
 * at x. */
thr_status thr_walk_programme_find(thr_walk_programme *programme, int *added,
                                   thr_err *err) THR_MUST_CHECK;

/* With a pull: from now on walks are only those that certainly keep to it, as many as one likes at
 * that price each, in lengths of the longest edge. */
void thr_walk_programme_round_up(thr_walk_programme *programme, double per_cord);

/* The best prices so far become the trial. */
thr_status thr_walk_programme_middle(thr_walk_programme *programme, thr_err *err) THR_MUST_CHECK;

/* Puts together the row of a walk over n half-edges, which has to be added to the pool, without the
 * passes that it knows of. */
thr_row thr_walk_programme_row(const thr_walk_programme *programme, thr_pool *pool, const int *half,
                               int n);

/* Keeps the walks for the next limit. */
thr_status thr_walk_programme_end(thr_walk_programme *programme, thr_err *err) THR_MUST_CHECK;

/* ---- walk_pull.c: total length, and number of cords, within a limit on the pull ---- */

/* Bounds the total length of the cords of a component from below: *bound, in units of length; 0:
 * nothing was proved. proof, empty at first, receives the prices that prove the bound. cord: of a
 * plan within the pull. Does nothing where the recursion would have too many places and units. */
thr_status thr_walk_pull_length(const thr_turning_columns *columns, const thr_request *options,
                                const thr_cord *cord, int n_cords, int component,
                                const thr_limits *limits, thr_walk_proof *proof, double *bound,
                                thr_err *err) THR_MUST_CHECK;

/* Finds few cords of a component within options.max_pull, and among as few short ones, by diving on
 * the columns of a programme that prices cords. some, of all components: any cords. cord[most]
 * receives n cords without names; the caller's. *n is 0 if no such cords were found, or only more
 * than `most`. */
thr_status thr_walk_pull_few(const thr_turning_columns *columns, const thr_request *options,
                             const thr_cord *some, int n_some, int component,
                             const thr_limits *limits, int most, thr_cord *cord, int *n,
                             thr_err *err) THR_MUST_CHECK;

/* Proves that *excluded cords of the component, at most `cords`, are too few for options.max_pull;
 * 0: only numbers are that were known to be. proof, empty at first, receives the prices. cord: of a
 * plan within the pull, or of any plan. */
thr_status thr_walk_pull_too_few(const thr_turning_columns *columns, const thr_request *options,
                                 const thr_cord *cord, int n_cords, int component, int known,
                                 int cords, const thr_limits *limits, thr_walk_proof *proof,
                                 int *excluded, thr_err *err) THR_MUST_CHECK;

/* ---- walk_centre.c: whether a limit leaves too few walks, by an interior point method ---- */

/* Adds walks to a programme that has begun and asks whether its limit is excluded, until the limit
 * is, or until the known walks are enough for the programme's cords; looks for walks at most
 * most_looks times. programme->search then has the walks' weights. */
thr_status thr_walk_centre(thr_walk_programme *programme, int most_looks,
                           thr_err *err) THR_MUST_CHECK;

/* ---- walk_dive.c: cords from the columns of a programme ---- */

/* Dives for cords of at most `units` units: fixes the columns of value 1, or else the largest
 * column, and solves what is left again with few new walks, until the edges have their passes.
 * cord[programme->cords] receives the walks, *found whether there were enough. Begins and ends the
 * programme's search. */
thr_status thr_walk_dive(thr_walk_programme *programme, int units, thr_cord *cord, bool *found,
                         thr_err *err) THR_MUST_CHECK;

/* ---- walk_memory.c: edges that walks remember, so that repeated passes earn nothing ---- */

/* Makes the walks remember, from now on, the shortest rounds of the last optimum in which an edge
 * is passed again; *grown: there were some, and there was room. The recursion and the rows of the
 * known walks are made anew. To be called in place of thr_walk_programme_end. (R. Roberti & A.
 * Mingozzi, Transportation Science 48, 2014.) */
thr_status thr_walk_remember(thr_walk_programme *programme, bool *grown,
                             thr_err *err) THR_MUST_CHECK;

/* Moves the prices in trial, and what the walks remember, to the proof, whose former content is
 * released. trial is as after thr_walk_programme_init. */
thr_status thr_walk_take_proof(thr_walk_programme *programme, thr_walk_proof *proof,
                               thr_err *err) THR_MUST_CHECK;

/* ---- walk_search.c: single short walks without U-turns, except at nodes with one edge ---- */

typedef struct {
  const thr_turning_columns *c;
  int *by, *stamp, *queue; /* [2 * n_edges] search over half-edges */
  double *length;          /* [2 * n_edges] */
  int searches, head, n_queued;
  int *half, n; /* [2 * n_edges] the walk found last; n = 0: there is none */
} thr_walk_search;

thr_status thr_walk_search_init(thr_walk_search *walk_search,
                                const thr_turning_columns *turning_columns,
                                thr_err *err) THR_MUST_CHECK;
void thr_walk_search_destroy(thr_walk_search *walk_search);

/* Finds a closed walk of fewest edges through half-edge h. O(sum of the squares of the degrees). */
void thr_walk_search_closed(thr_walk_search *walk_search, int h);

/* Finds the shortest walk of a component between two nodes where cords may end, or back to the same
 * one, over edges with fewer passes than they may have. If the given passes can be paired without
 * U-turns, they can be with the walk's passes added: the walk turns back only where other passes
 * can be paired with its own. O(edges * sum of the squares of the
 * degrees) at worst. */
void thr_walk_search_open(thr_walk_search *walk_search, int component, const int *passes);

/* Adds the walk found last to passes[n_edges], if that leaves none above most_passes; says whether.
 */
bool thr_walk_search_add(const thr_walk_search *walk_search, int *passes);

#endif
