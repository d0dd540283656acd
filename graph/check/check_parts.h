/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of graph/check/ share: comparisons of stated values, the cords as they were
 * counted, and the parts of the proofs. See check.h for the order to read the files in. */
#ifndef THR_CHECK_PARTS_H
#define THR_CHECK_PARTS_H

#include "graph/arrays.h"
#include "graph/check/check.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"

/* Lengths, angles and forces are sums of doubles, taken in an order of the plan's own: equal up to
 * 1e-9 of what they are parts of. */
bool thr_check_close(double a, double b, double whole);

/* Turning angle by Kahan's formula on unit vectors, rad: another way than the one that made the
 * plan. */
double thr_check_angle(const thr_frame *frame, int in, int out);

/* Returns the first pass that the end's pull reaches: pulled at both ends the one behind the
 * slackest, unless the plan is of version 1, which parts cords at a pass; else the slackest. */
int thr_check_from_end(const thr_request *request, thr_pull pull, int slackest, int n_passes);

/* Is that pass the last one that the start's pull reaches, such that no other asks for less of the
 * harder end? before[n_passes]: exponents before each pass. O(n_passes). */
bool thr_check_slackest(const thr_request *request, thr_pull pull, int slackest,
                        const double *before, int n_passes);

/* Price of a turn, by that formula; of costs with a threshold by the one definition that there is.
 */
double thr_check_price(const thr_frame *frame, thr_turn_cost cost, int in, int out);

/* Components and passes, worked out once for everything that is checked. */
typedef struct {
  int n_components;
  int *component; /* [n_nodes] owned */
  int *passes;    /* [n_edges] owned */
  int *cords;     /* [n_components] owned; of cords that are not known: the most */
} thr_check_walked;

/* Without passes yet. On failure check_walked is empty. */
thr_status thr_check_walked_init(thr_check_walked *check_walked, const thr_frame *frame,
                                 const thr_request *options, thr_err *err) THR_MUST_CHECK;

/* The same from cords, which are checked on the way. */
thr_status thr_check_walked_from(thr_check_walked *check_walked, const thr_frame *frame,
                                 const thr_request *options, const thr_cord *cord, int n_cords,
                                 thr_err *err) THR_MUST_CHECK;
void thr_check_walked_destroy(thr_check_walked *check_walked);

/* Checks that every edge has the passes that it needs, and no more than fit. */
thr_status thr_check_cover(const thr_frame *frame, const thr_request *options, const int *passes,
                           thr_err *err) THR_MUST_CHECK;

/* As many cords in every component as the options say; where they were not asked for, in the one
 * that has most. */
thr_status thr_check_cord_count(const thr_check_walked *check_walked, const thr_request *options,
                                thr_err *err) THR_MUST_CHECK;

/* Returns whether cords end at allowed nodes, any number of them at each. */
static inline bool thr_check_ends_free(const thr_request *options)
{
  return options->ends != THR_ENDS_CLOSED && options->ends != THR_ENDS_COUNTS;
}

/* Part of a bound that may be taken off it for rounding, instead of so much for every extra pass.
 */
#define THR_CHECK_ROUNDING 5e-10

/* What a certificate proves about its component. Lengths round to weights, and what is rounded up
 * is taken off every bound: for as many extra passes of each edge as a shortest plan with these
 * options may have, not those of this plan. */
typedef struct {
  bool optimal;          /* the passes are the shortest for at most options.cords cords
                            (thr_plan_fewest_first: as many) */
  double extra;          /* no such cords have less extra cord, in units */
  double rounding;       /* what it adds at most, in units */
  double rounding_above; /* the same beyond THR_CHECK_ROUNDING of each edge's weight */
  thr_wide places;       /* what the prices of places add to the cuts' values */
} thr_check_verdict;

/* Cords that each component has at most: cords[check_walked->n_components]. Given numbers of ends
 * say how many. O(nodes). */
void thr_check_most_cords(const thr_frame *frame, const thr_request *options,
                          const thr_check_walked *check_walked, int *cords);

/* Verifies the certificates, which must be one per component in order, for passes that were checked
 * already: verdict[check_walked->n_components]. O(nodes + edges, and for each node in a list of the
 * cuts its edges, or sqrt(edges) if that is less, times log(cuts)). */
thr_status thr_check_certificates(const thr_frame *frame, const thr_request *options,
                                  const thr_check_walked *check_walked,
                                  const thr_certificate *certificate, int n,
                                  thr_check_verdict *verdict, thr_err *err) THR_MUST_CHECK;

/* Least extra cord of that component, in units, with so many cord ends, by a certificate with this
 * verdict. */
double thr_check_extra(const thr_certificate *certificate, const thr_check_verdict *check_verdict,
                       int64_t ends);

/* Length of passes, and the edges that so many different cords pass. */
double thr_check_length_of(const thr_frame *frame, const int *passes);
thr_status thr_check_count_different(const thr_frame *frame, int distinct, const thr_cord *cord,
                                     int n_cords, int *found, thr_err *err) THR_MUST_CHECK;

/* How many different cords plans like this one have over every edge: what is asked for, if it has
 * them; else 1. */
thr_status thr_check_different(const thr_frame *frame, const thr_request *options,
                               const thr_cord *cord, int n_cords, int *each,
                               thr_err *err) THR_MUST_CHECK;

/* Verifies the certificates for passes that were checked already. *verdict is for the caller to
 * free; NULL on failure. */
thr_status thr_check_judge(const thr_frame *frame, const thr_request *options,
                           const thr_check_walked *check_walked, const thr_certificate *certificate,
                           int n, thr_check_verdict **verdict, thr_err *err) THR_MUST_CHECK;

/* What the verdicts prove of passes with this length; and, of cords (each > 0: so many different
 * ones over every edge), what all sets of few edges do, and prices of walks within a pull (NULL:
 * none). */
thr_status thr_check_sum_verdicts(const thr_frame *frame, const thr_request *options,
                                  const thr_check_walked *check_walked, int each,
                                  const thr_check_verdict *verdict, const thr_walk_proof *pulled,
                                  double length, bool *optimal, double *lower_bound,
                                  thr_err *err) THR_MUST_CHECK;

/* What can be claimed of several cords that were checked already: fills found. verdict NULL: no
 * certificates; tied: the proof of tube joints, or NULL; walks: prices that bound the longest, or
 * NULL. */
thr_status thr_check_several(const thr_frame *frame, const thr_request *options,
                             const thr_check_walked *check_walked, const thr_cord *cord,
                             int n_cords, const thr_certificate *certificate,
                             const thr_check_verdict *verdict, const thr_turning_proof *tied,
                             const thr_walk_proof *walks, thr_cords_claim *found,
                             thr_err *err) THR_MUST_CHECK;

/* No cords of a component, as many as it may have, are shorter together than *least. */
thr_status thr_check_least_of(const thr_frame *frame, const thr_request *options,
                              const thr_check_walked *check_walked,
                              const thr_certificate *certificate, const thr_check_verdict *verdict,
                              int component, double *least, thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's claim about its turning, which must be present, with cords and length proof
 * that were checked already. least_length: what the latter proves. */
thr_status thr_check_turning_claim(const thr_plan *plan, double least_length,
                                   thr_err *err) THR_MUST_CHECK;

/* Raises *side to what is proved, whatever the pull, of the turning on a side of some cord's cut
 * turn (docs/plan-format.md, "The cord that is hardest to pull"): by single edges, by the claim's
 * tree and walks, and of few edges by trying what is claimed. task: of the claim's turning, without
 * a cut. THR_EVIOLATED: of walks that prove nothing. */
thr_status thr_check_pulled_least(const thr_frame *frame, const thr_request *options,
                                  const thr_turning_task *task, const thr_turning_claim *claim,
                                  double *side, thr_err *err) THR_MUST_CHECK;

/* Returns the most cords that component k has: half of its given ends, or else `cords`. */
int thr_check_cords_of(const thr_turning_columns *columns, int k, int cords);

/* Computes what a tree, and prices of walks with it, prove of the price of turns. *all: of all
 * cords together; *largest: raised to that of the cord with the largest price, each component
 * alone. */
thr_status thr_check_shares(const thr_turning_columns *columns, int cords,
                            const thr_turning_proof *tree, double *all, double *largest,
                            thr_err *err) THR_MUST_CHECK;

/* Returns what the harder of two pulled ends of the cord has to overcome, rad, if the cord is
 * thought to be cut at the turn where that is least (docs/plan-format.md). at_pass: as in version 1
 * the turn at the cut belongs to the first part. O(passes). */
double thr_check_pulled_turning(const thr_frame *frame, const thr_cord *cord, bool at_pass);

/* Checks that no cord needs more pull than the options allow. */
thr_status thr_check_pulls(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                           int n_cords, thr_err *err) THR_MUST_CHECK;

/* Raises length[n_components] of one component to what prices of walks within the pull prove. */
thr_status thr_check_pulled_length(const thr_frame *frame, const thr_request *options,
                                   const thr_check_walked *check_walked,
                                   const thr_walk_proof *pulled, double *length,
                                   thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's claim about the fewest cords for its pull, which must be present. */
thr_status thr_check_pull_claim(const thr_plan *plan, const thr_check_walked *check_walked,
                                thr_err *err) THR_MUST_CHECK;

/* The elements of a symmetric plan's group as images of the nodes. */
typedef struct {
  int n, order; /* nodes; elements, the identity first */
  int *image;   /* [order * n] owned */
} thr_check_elements;

/* Verifies what the record says of the group itself: generators, images, order and name. On failure
 * out is empty. */
thr_status thr_check_group(const thr_plan *plan, thr_check_elements *out,
                           thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's record of its symmetry, which must be present, with cords that were checked
 * already. */
thr_status thr_check_symmetry(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Verifies the plan's evaluation, which must be present, with cords that were checked already. */
thr_status thr_check_evaluation(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* ln of the ratio of the tensions on both sides of the turn after pass i, by the evaluation's law;
 * 0 after the last pass. */
double thr_check_exponent(const thr_frame *frame, const thr_evaluation *evaluation,
                          const thr_cord *cord, int i);

/* The tension that turns with this exponent, negative towards the slack side, lead from a tension
 * to, by the law of the physics.
 */
double thr_check_tension(const thr_physics *physics, double tension, double exponent);

/* Verifies what the limit analysis proved of the structure, which must be present, by the powers of
 * its mechanisms. */
thr_status thr_check_standing(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Checks that the tensions of cord i are those that the schedule leaves. */
thr_status thr_check_schedule(const thr_frame *frame, const thr_cord *path,
                              const thr_schedule *schedule, int i, const thr_physics *physics,
                              const thr_eval_cord *claim, thr_err *err) THR_MUST_CHECK;

/* ---- turning_leaf.c: The bound that one leaf's multipliers prove, and its parts. */

typedef struct {
  const thr_turning_columns *c;
  const thr_turning_dual *d;
  thr_scratch own;    /* the arrays */
  thr_wide *reduced;  /* [n_columns] price less what the multipliers take */
  bool *member;       /* [2 * n_edges + n_ends] all false between sets */
  thr_wide *constant; /* [n_components + 1] what the multipliers take in a component; last, what
                         sets of several do, >= 0 */
  thr_wide limit;     /* what the multiplier of the length takes off the sum, >= 0 */
  int *of_ends;       /* [n_ends] component of an equation of ends */
  int *edges;         /* [n_components] */
  bool *open;         /* [n_components] may cords end there? */
  bool ranked;        /* connections are counted exactly where they can be */
} thr_turning_leaf;

static inline int thr_turning_leaf_component(const thr_turning_leaf *k, int h)
{
  return k->c->component[k->c->f->edge[h >> 1][0]];
}

/* What the multipliers leave of all prices, and the sum of what they take. Release own with
 * thr_scratch_free, after a failure too. */
thr_status thr_turning_leaf_init(thr_turning_leaf *k, const thr_turning_columns *turning_columns,
                                 const thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

/* What column j adds to the least value, between these bounds. With multipliers below 2^58 and sets
 * below 2^62 together, reduced prices stay below 2^63, and nothing here comes near 2^127. */
thr_wide thr_turning_leaf_adds(const thr_turning_leaf *k, int j, int least, int most);

/* The nearest that 64 bits hold. */
int64_t thr_turning_in_64_bits(thr_wide total);

/* ---- ways_in.c: A lower bound on the longest of several cords, by cuts round the nodes where
 * cords may end. */

/* Computes *longest, which the longest of at most so many cords of component `number` reaches; 0
 * for closed cords, given numbers of ends, tube joints, prices of places, and problems too large to
 * try. certificate: verified, of that component. O(cuts (nodes + edges)). */
thr_status thr_ways_in(const thr_frame *frame, const thr_request *options, const int *component,
                       int number, int cords, const thr_certificate *certificate, double *longest,
                       thr_err *err) THR_MUST_CHECK;

/* ---- Tables over sets of edges: the least cost of a cord over each set, and how many cords cover
 * all edges. They prove lower bounds for small components, for the checker and for planners alike.
 *
 * Read few_edges.c first: it fills the table of single cords over all sets of a few edges, and
 * computes the least sum and the least largest cost of several cords from the table.
 * few_different.c asks for different cords over every edge. short_cords.c lists only the sets that
 * cords within a limit can pass, so that the framework may have more edges. */

/* ---- few_edges.c and few_different.c: the least cost of several cords through a component of few
 * edges, from tables over all sets of edges ---- */

enum {
  THR_FEW_EDGES = 18,
  THR_FEW_SUMMED = 12,    /* edges up to which the least sum is computed, too */
  THR_FEW_SETS = 1 << 18, /* of all components together */
  THR_PULL_SETS =
      1 << 16 /* the same within a pull; with closed cords for each node of the component */
};

typedef struct {
  int n;       /* edges; 0: there is no table, as there are too many edges or sets */
  double *one; /* [2^n] least cost of a cord that passes at least the edges of a set; owned */
} thr_few_edges;

/* Fills the table of component `number` (component[n_nodes] as of thr_frame_components). The cost
 * is the price of turns, without U-turns but at nodes with one edge (with tube joints none at all),
 * or the length, with any U-turns (tube joints: none). If there are more than THR_FEW_SUMMED edges,
 * cords above limit cost INFINITY. n = 0 if the table needs more than so many sets. O(2^n n^2), and
 * 16 n 2^n bytes while the table is made. */
thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame,
                              const thr_request *options, const int *component, int number,
                              bool turning, double limit, int sets, thr_err *err) THR_MUST_CHECK;
void thr_few_edges_destroy(thr_few_edges *few);

/* Computes the least largest cost of so many cords through the component; fewer cords cost no less.
 * INFINITY: there are no such cords. O(2^n n^2). */
thr_status thr_few_edges_dearest(const thr_few_edges *few, int cords, double *cost,
                                 thr_err *err) THR_MUST_CHECK;

/* Computes the least sum of the costs of least .. most cords, each of which passes some edge, over
 * all of these numbers. At most THR_FEW_SUMMED edges. O(3^n n). */
thr_status thr_few_edges_sum(const thr_few_edges *few, int least, int most, double *cost,
                             thr_err *err) THR_MUST_CHECK;

/* Lists the finite costs in the table, ascending and without equal ones: value[n], which the caller
 * owns. */
thr_status thr_few_edges_costs(const thr_few_edges *few, double **value, size_t *n,
                               thr_err *err) THR_MUST_CHECK;

/* Computes the least and the largest number of cords that component `number` may have. */
void thr_few_edges_cords(const thr_frame *frame, const thr_request *options, const int *component,
                         int number, int *least, int *most);

/* Computes the least sum of the costs of least .. most cords of which at least `each` different
 * ones pass every edge; 0 if there are too many states of what the edges still need, (2 each +
 * 1)^n. */
thr_status thr_few_edges_different(const thr_few_edges *few, int each, int least, int most,
                                   double *cost, thr_err *err) THR_MUST_CHECK;

/* Computes the sets of edges, set[cords], that the cords of the least sum pass at least. *found is
 * false if there are too many sets to look at, or no such cords. */
thr_status thr_few_edges_sets(const thr_few_edges *few, int each, int cords, unsigned *set,
                              bool *found, thr_err *err) THR_MUST_CHECK;

/* Computes the same for the largest cost of so many cords: *proved is a lower bound, and *found is
 * reached by cords, or INFINITY if none are known. Both are one number unless there are too many
 * sets to look at. set[cords] (NULL: not wanted) receives the edges that the cords of *found pass
 * at least. known: the largest cost of cords that are known, from where to look downwards; 0: none
 * are known. */
thr_status thr_few_edges_different_dearest(const thr_few_edges *few, int each, int cords,
                                           double known, unsigned *set, double *proved,
                                           double *found, thr_err *err) THR_MUST_CHECK;

/* Computes the least total length of the cords of each component, least[n_components]; 0 for
 * components that may have one cord only, have more than THR_FEW_SUMMED edges, or come when the
 * sets are used up. No cord is longer than the options allow. cords[n_components]: the largest
 * number of cords (NULL: as the options allow). each: different cords over every edge, at least. */
thr_status thr_few_edges_lengths(const thr_frame *frame, const thr_request *options,
                                 const int *component, int n_components, const int *cords, int each,
                                 double *least, thr_err *err) THR_MUST_CHECK;

/* Computes bounds on the price of turns, with as many cords in each component as the options allow.
 * *sum: of all cords, 0 if there are too many edges; *dearest: the largest of one cord in any
 * component of few edges, INFINITY above limit. Components that may have one cord only, and those
 * that come when the sets are used up (THR_FEW_SETS), count as large. */
thr_status thr_few_edges_bounds(const thr_frame *frame, const thr_request *options, double limit,
                                double *sum, double *dearest, thr_err *err) THR_MUST_CHECK;

/* Raises fewest[c] for every component c, as long as it is below enough[c] and so many cords, each
 * within a pull that overcomes turns of `allowed` rad on either side of a cut turn, do not pass all
 * edges of the component (docs/plan-format.md, "Threadings within a pull"). Left as it was where
 * that is not known: of components with more than THR_FEW_SUMMED edges, and as soon as there are
 * more than THR_PULL_SETS sets to look at. options.turning.cost is not looked at. A side of a cord
 * is a walk from where it may end (closed: from some node, both sides the same) to the node of the
 * cut turn. Sets that sides from one end to one node pass are found from set to set as above; the
 * cord's are the unions of two of them. */
thr_status thr_few_edges_within(const thr_frame *frame, const thr_request *options, double allowed,
                                const int *enough, int *fewest, thr_err *err) THR_MUST_CHECK;

/* ---- short_cords.c: how short the longest of several cords can be that pass few edges each, from
 * all sets of edges that a cord within a limit can pass ---- */

enum { THR_SHORT_EDGES = 128, THR_SHORT_STATES = 1 << 19 };

__extension__ typedef unsigned __int128 thr_edge_set; /* bit e: edge e */

/* A label: a walk passes the set and ends at the node. */
typedef struct {
  thr_edge_set set;
  double length;
  int node, from, half; /* from: the state before half was passed; -1: here it began */
  int at;               /* position in the heap; -1: settled */
} thr_short_state;

/* A set of edges that a cord within the limit can pass. */
typedef struct {
  thr_edge_set set;
  double length; /* of the shortest cord that passes just these edges */
  int state;     /* the label of this cord */
} thr_short_set;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits; /* that stop the searches; NULL: none */
  double limit;
  int n; /* sets; 0: none is known, or there are too many */
  int n_states;
  thr_short_set *set;     /* [THR_SHORT_STATES] the first n */
  thr_short_state *state; /* [THR_SHORT_STATES] the first n_states */
  thr_scratch own;
} thr_short_cords;

/* Lists the sets of edges of cords of at most this length. limits (NULL: none) stop this search and
 * the one below; then nothing is known. n = 0 also for several components, tube joints, given
 * numbers of ends and more than THR_SHORT_EDGES edges. O(states (degree + log states)), 100 bytes a
 * state. Release with thr_short_cords_destroy, after a failure too. */
thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame,
                                const thr_request *options, double limit, const thr_limits *limits,
                                thr_err *err) THR_MUST_CHECK;
void thr_short_cords_destroy(thr_short_cords *cords);

/* Computes how short the longest of n cords can be that together pass every edge which needs
 * passes: *proved is a lower bound (the limit if all cords below are excluded), and *found is
 * reached by the sets of numbers chosen[n] (NULL: not wanted; -1: any set), or INFINITY if no cords
 * are known. Both are one number unless this takes too long. known: the longest of cords that are
 * known, from where to look downwards. */
thr_status thr_short_cords_longest(const thr_short_cords *cords, int n, double known, int *chosen,
                                   double *proved, double *found, thr_err *err) THR_MUST_CHECK;

/* Makes the shortest cord over just the edges of set number i. The caller owns its half-edges. */
thr_status thr_short_cords_walk(const thr_short_cords *cords, int i, thr_cord *cord,
                                thr_err *err) THR_MUST_CHECK;

#endif
