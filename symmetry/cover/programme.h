/* The columns of the integer programme of symmetry/cover/cover.h, what they cost, and what a whole solution is worth. Internal.
 *
 * A column is a number of orbits; its cost in an aim is what one orbit adds to overlap, steps, paths or turning. Every value of
 * an aim is a constant plus a multiple of its unit, so that a bound may be rounded up to the next one.
 *
 * Example: an orbit of three copies of an edge of length 2 that is covered already adds 6 to the overlap. */
#ifndef THR_PROGRAMME_H
#define THR_PROGRAMME_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/cover/ties.h"
#include "symmetry/group/quotient.h"

/* Columns: copy types, pair types, ends by dart type, circles by dart type. A circle column is 1 at one dart type of each
 * connected set of types that no trail ends in. The columns are also the edges of a graph whose nodes are the dart types and one
 * more, the root: a column with a terminal (end, folded edge, self pair) leads to the root. */
typedef struct {
  const thr_quotient *q;
  const thr_cover_options *o;
  int n, first_pair, first_end, first_circle;
  bool open;                /* every cord is open */
  int *cover, *capacity;    /* [n_edge_orbits] passes that an edge needs at least, and may have at most (INT_MAX: any number) */
  int *least, *most;        /* [n] bounds; most < 0: no bound but the equations */
  int (*join)[2];           /* [n] nodes of the graph; circles: their dart type twice */
  double *cost[THR_N_AIMS]; /* [n] */
  double constant[THR_N_AIMS];
  double scale[THR_N_AIMS]; /* largest cost */
  double unit[THR_N_AIMS];  /* what every cover's worth is a multiple of, but for the constant; 0 = not known */
  int *first, *incident;    /* pair types at dart type d: incident[first[d] .. first[d + 1] - 1], those within one type once */
  int *node_orbit;          /* [n_nodes] lowest node */
  const thr_limits *limits; /* when to stop, or NULL; borrowed */
  thr_ties *ties;           /* that a solution has to have; NULL = none; owned */
} thr_programme;

thr_status thr_programme_init(thr_programme *p, const thr_quotient *quotient, const thr_cover_options *options,
                              thr_err *err) THR_MUST_CHECK;
void thr_programme_destroy(thr_programme *p);

/* Every node is to be tied from now on, where o->tube asks for it of the whole programme; p without ties is what is left of the
 * conditions then, and its bounds hold. */
thr_status thr_programme_tie(thr_programme *p, thr_err *err) THR_MUST_CHECK;

/* In symmetry/cover/ruled_out.c, the last step of thr_programme_init: most[] = 0 for copies that come to where they can neither
 * turn nor end, for those exchanged by elements that move no node of their component, without which no cover has more overlap,
 * and for copies and turns back that others serve as well as; least[] for copy types that are alone in their edge orbit then.
 * THR_EINFEASIBLE: an edge has no copy type left that fits its capacity. O(types * longest chain + order * nodes). */
thr_status thr_programme_rule_out(thr_programme *p, thr_err *err) THR_MUST_CHECK;

bool thr_programme_end_allowed(const thr_programme *p, int node);

/* THR_ELIMIT, without a text, when the limits say so. */
thr_status thr_programme_check_time(const thr_programme *p) THR_MUST_CHECK;

bool thr_programme_terminal(const thr_programme *p, int column); /* does a trail end here, in an end or a fold? */

bool thr_programme_loop(const thr_programme *p, int dart); /* may two orbits of this dart type turn into each other? */

/* Connected sets of dart types in a whole solution: root[d] is the lowest of its set, -1 = unused; by root the terminals, among
 * them the ends, and the orbits of copies. Arrays: [n_darts]. */
typedef struct {
  int *root, *terminals, *ends, *copies;
} thr_programme_parts;

thr_status thr_programme_parts_init(thr_programme_parts *programme_parts, const thr_programme *p, thr_err *err) THR_MUST_CHECK;
void thr_programme_parts_find(thr_programme_parts *programme_parts, const thr_programme *p, const int *value);
void thr_programme_parts_destroy(thr_programme_parts *programme_parts);

/* In symmetry/cover/folds.c. Of any point that keeps the equations: a set of dart types whose folds outnumber its ends and what
 * leaves it, marked in side[n_darts] (a minimum cut between folds and ends); *found = false if there is none. Copies and turns
 * have sides of their own at a dart type, so that a trail alternates. copy_side, pair_side: [n_darts]. */
thr_status thr_programme_folds(const thr_programme *p, const double *value, bool *copy_side, bool *pair_side, bool *found,
                               thr_err *err) THR_MUST_CHECK;

/* Worth of a whole solution by aim, circles counted from the connected sets; valid: can it be made concrete, within capacity,
 * with all ties? */
thr_status thr_programme_value(const thr_programme *p, const int *value, double worth[THR_N_AIMS], bool *valid,
                               thr_err *err) THR_MUST_CHECK;

/* What two worths in an aim may differ by without being different. */
double thr_programme_tolerance(const thr_programme *p, thr_aim aim);

/* The least that a cover can be worth if it is worth this or more. */
double thr_programme_round(const thr_programme *p, thr_aim aim, double worth);

/* -1 or 1 if worth a is better or worse than b in the first aim in which they differ. */
int thr_programme_compare(const thr_programme *p, const double *a, const double *b);

/* In symmetry/cover/exchange.c: the partners of two turns at one node are exchanged, or those of a turn and of an end or fold. */

/* Exchanges that save turning, whatever they do to the connected sets, until there is none or the limits stop it. */
thr_status thr_programme_straighten(const thr_programme *p, const thr_limits *limits, int *value, thr_err *err) THR_MUST_CHECK;

/* Joins connected sets by exchanges, cheapest turning first, as long as a set has no terminal (open: no end). */
thr_status thr_programme_mend(const thr_programme *p, int *value, thr_err *err) THR_MUST_CHECK;

/* Where every cord is open: two ends instead of a turn, in every set without ends that has a node where ends may be. */
thr_status thr_programme_open(const thr_programme *p, int *value, thr_err *err) THR_MUST_CHECK;

/* Calls attempt with value after each exchange that leaves what is tied so (level: and turns no more); which is then taken
 * back. */
thr_status thr_programme_attempt(const thr_programme *p, int *value, bool level, thr_status (*attempt)(void *user, thr_err *err),
                                 void *user, thr_err *err) THR_MUST_CHECK;

/* Exchanges that make a valid solution better in the aims' order, until there is none or the limits stop it. */
thr_status thr_programme_improve(const thr_programme *p, const thr_limits *limits, int *value, thr_err *err) THR_MUST_CHECK;

#endif
