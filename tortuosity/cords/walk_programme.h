/* A linear programme over the walks that the cords of one component can be, below a limit on their turning or their length.
 * Internal to tortuosity/.
 *
 * A column for every walk between nodes where cords may end, or every closed one, at the cost of 1: a cord. Every edge needs its
 * passes; at a node where their number is odd, passes and ends are one more; all cords together turn by the least that cords do,
 * or are as long as they must be. What is solved is the dual, whose variables are prices (graph/plan/walk_proof.h) and whose
 * rows, one for every walk, are found by the recursion that checks the proof (P. C. Gilmore & R. E. Gomory 1961). It goes by
 * prices between the last optimum and the best so far, where optima alone would swing (P. Wentges 1997); any prices give a valid
 * bound (A. A. Farley 1990), which ends most searches early. Optima are corners, by the simplex method, or near the middle
 * (tortuosity/cords/walk_centre.h). */
#ifndef THR_WALK_PROGRAMME_H
#define THR_WALK_PROGRAMME_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/model/pool.h"
#include "lp/model/search.h"

/* A first pass, and what the best walk from there is worth. */
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
  int n_variables, *edge, *node; /* [n_edges], [n_nodes] their variables, -1: none. The last one, if least > 0: of all */
  int n_edges;                   /* variables of edges, which come first */
  bool lengths;             /* with a pull: walks cost their length, else each as much, and the last variable is a cord's price */
  double *right, *upper;    /* [n_variables] the right sides: costs of the dual; and what a variable is at most */
  double scale, longest;    /* of prices to the integers of a proof; with a pull 1 is the length of the longest edge */
  double enough;            /* with a pull: a bound on the length that ends the search, or so few cords */
  double dearest;           /* with a pull: price of a pass at most */
  double per_cord;          /* with a pull, 0: the cords are as many as there may be; else what one of any number costs */
  int units;                /* of the limit that is being tried */
  bool to_exclude;          /* is the limit to be excluded, or are walks looked for? */
  bool excluded;            /* it is, by the prices in trial */
  double *x, *middle, *try; /* [n_variables] the last optimum, the best so far, what is priced */
  int run;                  /* of the recursions, the one that was looked at last */
  double best;              /* number of cords that the best proves, or their length; 0: none yet */
  int64_t *value;           /* [tables * steps.n * thr_walk_levels(most_units)] of the recursion; owned */
  thr_walk_start *start;    /* [most first passes] in the order of their worth */
  bool *passed;             /* [n_edges] by a walk that was found in this look at a recursion, or an image of it */
  int *half;                /* a walk while it is traced */
  thr_walk_proof trial;
  thr_search search; /* rows: index is the number of units, member the walk's half-edges in order */
  thr_pool walks;    /* of all limits so far */
} thr_walk_programme;

/* For the component of the cord that turns most, or is longest, with a unit of which most of its turns, or edges, are nearly
 * whole numbers. least: the proved least of the turning of that component's cords together, or of their length. THR_ELIMIT: too
 * large for the recursion. On failure programme is to be destroyed too. */
thr_status thr_walk_programme_init(thr_walk_programme *programme, const thr_turning_columns *columns, thr_walk_measure measure,
                                   const thr_cord *cord, int n_cords, double least, const thr_limits *limits,
                                   thr_err *err) THR_MUST_CHECK;

/* The same for all cords of a component within options.max_pull, as many as suffice; or if lengths count a given number: then a
 * variable more is the price of a cord, and walks cost their length. units are set. cord: of which one that pulls hardest says
 * what unit is used. */
thr_status thr_walk_programme_init_pull(thr_walk_programme *programme, const thr_turning_columns *columns,
                                        const thr_request *options, const thr_cord *cord, int n_cords, int component,
                                        bool lengths, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_walk_programme_destroy(thr_walk_programme *programme);

/* What has the same edge[n_edges] or node[n_nodes], the lowest of each, has one price from now on (tortuosity/proof/orbits.h).
 * That proves as much where all are images of each other, and walks that are images of each other are one row; but cords cannot
 * be chosen from them. Before any walk is known. */
thr_status thr_walk_programme_merge(thr_walk_programme *programme, const int *edge, const int *node, thr_err *err) THR_MUST_CHECK;

/* Price of so many units, rounded down. */
double thr_walk_programme_price(const thr_walk_programme *programme, int units);

/* Starts with the walks of at most so many units that are known. price: of a pass that no walk makes. */
thr_status thr_walk_programme_begin(thr_walk_programme *programme, int units, double price, thr_err *err) THR_MUST_CHECK;

/* Adds the walk of a cord of the component. */
thr_status thr_walk_programme_add(thr_walk_programme *programme, const thr_cord *cord, thr_err *err) THR_MUST_CHECK;

/* Adds walks, at most so many times, until the optimum knows all that it needs or the limit is excluded. */
thr_status thr_walk_programme_rounds(thr_walk_programme *programme, int most_rounds, thr_err *err) THR_MUST_CHECK;

/* Adds the walks that are worth most at prices x[n_variables], as far as the pool has none like them and the last optimum does
 * not know them, counted in *added. Where limits are to be excluded, what the prices prove: best, middle and excluded. Of closed
 * walks a look goes through the recursions only until it has some. */
thr_status thr_walk_programme_look(thr_walk_programme *programme, const double *x, int *added, thr_err *err) THR_MUST_CHECK;

/* The same at prices between the last optimum, x, and the best so far; where these find none, at x. */
thr_status thr_walk_programme_find(thr_walk_programme *programme, int *added, thr_err *err) THR_MUST_CHECK;

/* With a pull: from now on walks are only those that certainly keep to it, as many as one likes at that price each, in lengths of
 * the longest edge. */
void thr_walk_programme_round_up(thr_walk_programme *programme, double per_cord);

/* The best prices so far become the trial. */
thr_status thr_walk_programme_middle(thr_walk_programme *programme, thr_err *err) THR_MUST_CHECK;

/* Puts together the row of a walk over n half-edges, which has to be added to the pool, without the passes that it knows of. */
thr_row thr_walk_programme_row(const thr_walk_programme *programme, thr_pool *pool, const int *half, int n);

/* Keeps the walks for the next limit. */
thr_status thr_walk_programme_end(thr_walk_programme *programme, thr_err *err) THR_MUST_CHECK;

/* Price of the turns of a cord, its pulled turning, or its length; which one has most. */
double thr_walk_price(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord);
int thr_walk_dearest(const thr_turning_columns *columns, thr_walk_measure measure, const thr_cord *cord, int n_cords);

#endif
