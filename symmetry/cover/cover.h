/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The room symmetry/cover: finds few unique paths whose images under a group cover every edge.
 *
 * A symmetric cover is a number of orbits for each type of the quotient
 * (symmetry/group/quotient.c): copies, turns, ends and folds. These numbers are the columns of an
 * integer programme that minimizes overlap, learned steps, paths and turning, one after the other.
 * symmetry/lift makes cords of a solution.
 *
 * To read in this order: programme.c has the columns, their costs and what makes a solution valid;
 * ruled_out.c the columns that no best cover needs; ties.c, tie_rows.c tube joints. relaxation.c is
 * the linear programme with its rows, folds.c one kind of them; cover_search.c the branch and cut.
 * contraction.c leaves turns out, so that most of the search is over few columns; start.c makes
 * first covers by a T-join, exchange.c joins their sets, bounds.c and turning_bound.c prove bounds.
 * cover.c puts the steps together; claims.c says what is proved of plans; solve.c solves all rows
 * of a table of groups. opening.c belongs to symmetry/lift/strands.c. */
#ifndef THR_COVER_H
#define THR_COVER_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/group/group.h"

/* ---- What is asked of a symmetric cover (symmetry/cover/cover.h). */

typedef struct {
  int cover;     /* passes that every edge needs at least */
  thr_ends ends; /* closed: every cord is closed. any: open or closed cords. feet, nodes: every cord
                    is open, its ends there */
  const bool *end_node;       /* [n_nodes] THR_ENDS_NODES only; borrowed. Must be invariant under H
                                 (THR_EINPUT), as the next two */
  thr_aim prefer[THR_N_AIMS]; /* what is minimized first, second, .. */
  const int *edge_cover;      /* [n_edges] instead of cover; NULL = all alike; borrowed */
  const int *edge_capacity; /* [n_edges] passes that an edge may have at most, INT_MAX = any number;
                               NULL = any; borrowed */
  int most_ends;            /* of cords, in all; 0 = any number */
  bool tube; /* tube joints: the turns tie the edges at every node (graph/plan/plan_measures.h),
                none goes back */
  double start_by; /* thr_clock() until when a first cover is looked for, even after the limits'
                      deadline */
  bool quick; /* overlap and steps only, as far as they come before turning: the rest is as it comes
               */
  int most_closed; /* of the cords: closed ones are as many as can be, up to so many in a component;
                      0: as few */
} thr_cover_options;

/* Is every cord open? With tube joints also if ends may be anywhere: where a closed cord comes out
 * it ties nothing, so that its ends are ends like others, which the group maps to ends. */
static inline bool thr_cover_all_open(const thr_cover_options *options)
{
  return options->ends == THR_ENDS_FEET || options->ends == THR_ENDS_NODES ||
         (options->ends == THR_ENDS_ANY && options->tube);
}

/* Where ends may be anywhere, it is to be learned of each where it comes out: a step like a pass.
 * Feet, and nodes that are named, show it by themselves. */
static inline int thr_cover_steps_of_end(const thr_cover_options *options)
{
  return options->ends == THR_ENDS_ANY;
}

/* ---- cover.c: The best symmetric cover for one group: how many orbits of each type of copies,
 * turns, ends and folds (symmetry/group/quotient.c), as an integer programme. */

/* value[aim]: overlap in units of length; learned steps (passes of the unique paths, a folded
 * path's half, a folded edge as 1/2); unique paths (orbits of cords); turning in rad of all cords.
 * bound[aim]: no symmetric cover is better in that, with the aims before it at their values. */
typedef struct {
  int *copies; /* [q->n_copies] orbits of each type; owned */
  int *pairs;  /* [q->n_pairs] owned */
  int *ends;   /* [q->n_darts] dart orbits that are cord ends; owned */
  double value[THR_N_AIMS], bound[THR_N_AIMS];
  bool optimal; /* solved to the end in all aims, by GLPK's word and to 4e-6 of an aim's largest
                   cost */
} thr_cover;

/* Lexicographic integer programme over the orbits, by branch and cut: dart balance, cover, odd sets
 * of dart types (Edmonds & Johnson 1973: every column meets at most two equations, so they nearly
 * close the gap), and rows added when a solution's quotient falls apart into more trails than its
 * terminals need or, where every cord is open, has more folds than ends can be led to. The aims
 * before turning are solved without the turns at most nodes (symmetry/cover/contraction.c) in at
 * most 7/10 of the time; before that a cover is made without any programme, copies made even by a
 * least T-join (symmetry/cover/start.c), so that a search that is stopped has one. The T-join and
 * that of the framework without symmetry prove overlap where they are as long
 * (symmetry/cover/bounds.c). Odd sets are looked for exactly among at most 4,000 dart types, beyond
 * that by balls only. At most 2 * cover + 2 orbits of one copy type, with tube joints 2 * (d - 1)
 * more for the d tubes at either end; U-turns, at the price of their angle, wherever a best cover
 * may need them (symmetry/cover/ruled_out.c), and never with tube joints. Those add the rows of
 * symmetry/cover/relaxation.c that every node is tied, and GLPK's branch and bound at the root. An
 * element that moves no node of a component maps its cords to themselves. THR_OK or THR_ELIMIT (out
 * holds the best found, with bounds; if there is none yet, out is empty); THR_EINFEASIBLE: a
 * component has no node where a cord may end (named), or there is none of this kind within the
 * capacities and the number of ends; otherwise out is empty. */
thr_status thr_cover_find(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_limits *limits, thr_cover *out, thr_err *err) THR_MUST_CHECK;
void thr_cover_destroy(thr_cover *c);

/* The same, going on from what was found and proved before for the same quotient and options, but
 * for options->quick; c is replaced. An empty c: as thr_cover_find. */
thr_status thr_cover_improve(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_limits *limits, thr_cover *c, thr_err *err) THR_MUST_CHECK;

/* The cords of a cover: copies and pairs made concrete, orbit by orbit, and traced. record: which
 * cord is a copy of which, and the element that maps it there (graph/plan/plan.h). cord is
 * allocated, [*n_cords], owned by the caller. */
thr_status thr_cover_cords(const thr_quotient *quotient, const thr_cover_options *options,
                           const thr_cover *c, thr_cord **cord, int *n_cords,
                           thr_symmetry_record *record, thr_err *err) THR_MUST_CHECK;

/* The record of any cords: symmetric under the identity alone. options: where ends may be, and the
 * joints. O(cords^2 * passes^2) at worst. */
thr_status thr_cords_alone(const thr_frame *frame, const thr_cover_options *options,
                           const thr_cord *cord, int n_cords, thr_symmetry_record *record,
                           thr_err *err) THR_MUST_CHECK;

/* ---- ties.c: Tube joints (graph/plan/plan_measures.h) in the programme of a symmetric cover: at
 * every node the turns, as edges between its tubes, connect them all. */

typedef struct {
  int n;       /* stars: orbits of nodes with several tubes */
  int *node;   /* [n] lowest node of the orbit */
  int *degree; /* [n] */
  int *nodes;  /* [n] in the orbit */
  int *star;   /* [n_darts] of a dart type; -1 = its node has one tube */
  int *first;  /* [n + 1] turn columns of star i: pair[first[i]] .. pair[first[i + 1] - 1], as pair
                  types */
  int *pair;   /* [n_pairs] */
  int *turns;  /* [n_pairs] turns at the star's node in one orbit of turns */
  int *join;   /* [n_pairs + 1] pair type y joins tubes link[join[y]] .. link[join[y + 1] - 1], by
                  place at the node */
  int (*link)[2]; /* distinct; of a pair type that is only counted none */
  int most;       /* largest degree */
} thr_ties;

/* node_orbit: [n_nodes] the lowest node of each node's orbit. O(order * (pair types * degree +
 * nodes)). */
thr_status thr_ties_init(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                         thr_err *err) THR_MUST_CHECK;
void thr_ties_destroy(thr_ties *ties);

/* Of a contraction quotient: pair type y of the whole becomes pair[y] (-1: none), whose links are
 * known if keep[y]; node_orbit as above.
 */
thr_status thr_ties_contract(thr_ties *ties, const thr_ties *whole, int whole_pairs,
                             const thr_quotient *quotient, const int *node_orbit, const int *pair,
                             const bool *keep, thr_err *err) THR_MUST_CHECK;

/* Blocks of a star's tubes that known turns join of which there are more than `least`;
 * value[n_pairs]: of the pair types. block[degree] receives 0 .. blocks - 1. Returns their number.
 */
int thr_ties_blocks(const thr_ties *ties, int star, const double *value, double least, int *block);

/* Turns in one orbit of pair type y that go between different blocks; all that are only counted. */
int thr_ties_between(const thr_ties *ties, int y, const int *block);

/* Is the star tied by whole numbers of turns, as far as is known? parent: [ties->most] scratch. */
bool thr_ties_tied(const thr_ties *ties, int star, const int *value, int *parent);

/* ---- programme.c: The columns of the integer programme of symmetry/cover/cover.h, what they cost,
 * and what a whole solution is worth. */

/* Columns: copy types, pair types, ends by dart type, circles by dart type. A circle column is 1 at
 * one dart type of each connected set of types that no trail ends in. The columns are also the
 * edges of a graph whose nodes are the dart types and one more, the root: a column with a terminal
 * (end, folded edge, self pair) leads to the root. */
typedef struct {
  const thr_quotient *q;
  const thr_cover_options *o;
  int n, first_pair, first_end, first_circle;
  bool open;             /* every cord is open */
  int *cover, *capacity; /* [n_edge_orbits] passes that an edge needs at least, and may have at most
                            (INT_MAX: any number) */
  int *least, *most;     /* [n] bounds; most < 0: no bound but the equations */
  int (*join)[2];        /* [n] nodes of the graph; circles: their dart type twice */
  double *cost[THR_N_AIMS]; /* [n] */
  double constant[THR_N_AIMS];
  double scale[THR_N_AIMS]; /* largest cost */
  double unit[THR_N_AIMS];  /* what every cover's worth is a multiple of, but for the constant; 0 =
                               not known */
  int *first, *incident; /* pair types at dart type d: incident[first[d] .. first[d + 1] - 1], those
                            within one type once */
  int *node_orbit;       /* [n_nodes] lowest node */
  const thr_limits *limits; /* when to stop, or NULL; borrowed */
  thr_ties *ties;           /* that a solution has to have; NULL = none; owned */
} thr_programme;

thr_status thr_programme_init(thr_programme *p, const thr_quotient *quotient,
                              const thr_cover_options *options, thr_err *err) THR_MUST_CHECK;
void thr_programme_destroy(thr_programme *p);

/* Copies the numbers of orbits of a cover to the columns value[p->n], but for the circles; or from
 * there to the arrays of a cover. */
void thr_programme_from_cover(const thr_programme *p, const thr_cover *cover, int *value);
void thr_programme_to_cover(const thr_programme *p, const int *value, thr_cover *cover);

/* Every node is to be tied from now on, where o->tube asks for it of the whole programme; p without
 * ties is what is left of the conditions then, and its bounds hold. */
thr_status thr_programme_tie(thr_programme *p, thr_err *err) THR_MUST_CHECK;

/* In symmetry/cover/ruled_out.c, the last step of thr_programme_init: most[] = 0 for copies that
 * come to where they can neither turn nor end, for those exchanged by elements that move no node of
 * their component, without which no cover has more overlap, and for turns back that others serve
 * as well as; least[] for copy types that are alone in their edge orbit then.
 * THR_EINFEASIBLE: an edge has no copy type left that fits its capacity. O(types + order * nodes).
 */
thr_status thr_programme_rule_out(thr_programme *p, thr_err *err) THR_MUST_CHECK;

bool thr_programme_end_allowed(const thr_programme *p, int node);

/* THR_ELIMIT, without a text, when the limits say so. */
thr_status thr_programme_check_time(const thr_programme *p) THR_MUST_CHECK;

bool thr_programme_terminal(const thr_programme *p,
                            int column); /* does a trail end here, in an end or a fold? */

bool thr_programme_loop(const thr_programme *p,
                        int dart); /* may two orbits of this dart type turn into each other? */

/* Connected sets of dart types in a whole solution: root[d] is the lowest of its set, -1 = unused;
 * by root the terminals, among them the ends, and the orbits of copies. Arrays: [n_darts]. */
typedef struct {
  int *root, *terminals, *ends, *copies;
} thr_programme_parts;

thr_status thr_programme_parts_init(thr_programme_parts *programme_parts, const thr_programme *p,
                                    thr_err *err) THR_MUST_CHECK;
void thr_programme_parts_find(thr_programme_parts *programme_parts, const thr_programme *p,
                              const int *value);
void thr_programme_parts_destroy(thr_programme_parts *programme_parts);

/* In symmetry/cover/folds.c. Of any point that keeps the equations: a set of dart types whose folds
 * outnumber its ends and what leaves it, marked in side[n_darts] (a minimum cut between folds and
 * ends); *found = false if there is none. Copies and turns have sides of their own at a dart type,
 * so that a trail alternates. copy_side, pair_side: [n_darts]. */
thr_status thr_programme_folds(const thr_programme *p, const double *value, bool *copy_side,
                               bool *pair_side, bool *found, thr_err *err) THR_MUST_CHECK;

/* Worth of a whole solution by aim, circles counted from the connected sets; valid: can it be made
 * concrete, within capacity, with all ties? */
thr_status thr_programme_value(const thr_programme *p, const int *value, double worth[THR_N_AIMS],
                               bool *valid, thr_err *err) THR_MUST_CHECK;

/* What two worths in an aim may differ by without being different. */
double thr_programme_tolerance(const thr_programme *p, thr_aim aim);

/* The least that a cover can be worth if it is worth this or more. */
double thr_programme_round(const thr_programme *p, thr_aim aim, double worth);

/* -1 or 1 if worth a is better or worse than b in the first aim in which they differ. */
int thr_programme_compare(const thr_programme *p, const double *a, const double *b);

/* In symmetry/cover/exchange.c: the partners of two turns at one node are exchanged, or those of a
 * turn and of an end or fold. */

/* Joins connected sets by exchanges, cheapest turning first, as long as a set has no terminal
 * (open: no end). */
thr_status thr_programme_mend(const thr_programme *p, int *value, thr_err *err) THR_MUST_CHECK;

/* Where every cord is open: two ends instead of a turn, in every set without ends that has a node
 * where ends may be. */
thr_status thr_programme_open(const thr_programme *p, int *value, thr_err *err) THR_MUST_CHECK;

/* Calls attempt with value after each exchange that leaves what is tied so (level: and turns no
 * more); which is then taken back. */
thr_status thr_programme_attempt(const thr_programme *p, int *value, bool level,
                                 thr_status (*attempt)(void *user, thr_err *err), void *user,
                                 thr_err *err) THR_MUST_CHECK;

/* ---- contraction.c: The programme without the turns at most nodes: which orbits of copies, ends
 * and folds, but not who meets whom. */

typedef struct {
  const thr_programme *whole; /* borrowed */
  int *root;                  /* [n_darts] lowest dart type of its cell */
  bool *keep;                 /* [n_darts] by lowest type: the cell is left as it is */
  int *becomes;               /* [n_darts] dart type of q */
  int *pair;                  /* [n_pairs] pair type of q, -1 = none, for it is not allowed */
  thr_quotient
      q; /* with arrays of its own for copy, dart and pair, whose stabilizers are borrowed */
  thr_programme p; /* over q */
} thr_contraction;

/* Every cell becomes one type; if not all, without those of two types that do not turn into
 * themselves: they need equal numbers.
 */
thr_status thr_contraction_init(thr_contraction *contraction, const thr_programme *whole, bool all,
                                thr_err *err) THR_MUST_CHECK;
void thr_contraction_destroy(thr_contraction *contraction);

/* Makes q and p anew from keep. */
thr_status thr_contraction_make(thr_contraction *contraction, thr_err *err) THR_MUST_CHECK;

/* In symmetry/lift/lift.c. A solution of p with turns, cheap ones first, but with tube
 * joints first those that tie: value[whole->n]. *kept > 0: in so many cells no turns can be found,
 * or none that tie their nodes; they are left as they are from now on, and the contraction is to be
 * made anew. THR_ELIMIT, without a text: stopped by the limits of the programme. */
thr_status thr_contraction_lift(thr_contraction *contraction, const int *small, int *value,
                                int *kept, thr_err *err) THR_MUST_CHECK;

/* The other way round: what a solution of the whole programme (value[whole->n]) is in p,
 * small[p.n]. Circles: 0. */
void thr_contraction_lower(const thr_contraction *contraction, const int *value, int *small);

/* What a start has: copies of least overlap, folds and all; the same without folds; the freest
 * copies, so often that each dart orbit has another of its type. */
typedef enum {
  THR_CONTRACTION_LEAST,
  THR_CONTRACTION_PLAIN,
  THR_CONTRACTION_TWICE
} thr_contraction_kind;

/* In symmetry/cover/start.c. Of a contraction of all cells: such copies, of types that
 * are not barred[p.first_pair], the first two kinds made even by a least T-join over copies and
 * terminals (small[p.n], without the turns, which lifting finds, unless one type outnumbers all
 * others of its cell). Of least overlap where every edge orbit has one copy type, but not always
 * the best, and its sets may lack ends; *found = false if there is none of this kind. The last kind
 * can always be lifted, and always be joined into one set for every component. */
thr_status thr_contraction_start(const thr_contraction *contraction, thr_contraction_kind kind,
                                 const bool *barred, const thr_limits *limits, int *small,
                                 bool *found, thr_err *err) THR_MUST_CHECK;

/* In symmetry/lift/fasten.c. For tube joints: more copies, two of a type where that keeps
 * numbers even, until every node has turns enough to be tied; of stars that are
 * failed[whole->ties->n], or NULL, one more turn than they have. As cheap as goes copy by copy;
 * copies that are barred excepted. *found = false if capacities leave no such copies. O(copies^2).
 */
thr_status thr_contraction_fasten(const thr_contraction *contraction, const bool *barred,
                                  const bool *failed, int *small, bool *found,
                                  thr_err *err) THR_MUST_CHECK;

/* What overlap and an aim with few values are added up with, so that it decides between equal
 * overlaps: the aim's weight. */
double thr_contraction_tie(const thr_contraction *contraction, thr_aim aim);

/* As above. No cover has less overlap or, if tie is another aim, no less overlap +
 * thr_contraction_tie * that aim: what is certain of every edge orbit and the proved value of the
 * least T-join, in which edge orbits with several copy types cost nothing. */
thr_status thr_contraction_bound(const thr_contraction *contraction, thr_aim tie,
                                 const thr_limits *limits, double *bound,
                                 thr_err *err) THR_MUST_CHECK;

#endif
