/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threadings as objects that change: which pass continues into which at every node, the cords that
 * follow, and the changes that searches make.
 *
 * Planners use this room to turn numbers of passes into cords and to improve these. Read euler.h
 * first: passes as a multigraph, and pairings at one node. Then here: transition.c makes pairings
 * at all nodes, walks.c and splice.c keep walks and cut and join them, threading.c exchanges pairs,
 * and junction_graphs.c counts turns, so that nodes stay tied. even.c and anneal.h even cords out.
 * subsets.c, items.c and small_cords.c solve small frameworks exactly. */
#ifndef THR_THREADING_H
#define THR_THREADING_H

#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"

/* ---- Euler tours: a multigraph of passes, pairings at its nodes, and tours that keep to a
 * pairing. This is the first header of the room to read; threading.h builds on it. multigraph.c
 * comes first, then pairing.c for one node and tour.c for one cord. */

/* ---- multigraph.c: The passes of a plan as a multigraph: one copy of an edge per pass, plus a
 * virtual edge between each two cord ends, so that every degree is even and a threading is a set of
 * closed circuits. */

/* Copy c has two darts, 2c and 2c + 1, one leaving each of its nodes; dart ^ 1 is the other.
 * half[d] is the framework's half-edge that dart d runs along, or -1 for a virtual edge. */
typedef struct {
  int n_darts, n_nodes;
  int *half;  /* [n_darts] */
  int *tail;  /* [n_darts] node that the dart leaves */
  int *first; /* [n_nodes + 1] darts leaving v: dart[first[v] .. first[v + 1] - 1] */
  int *dart;  /* [n_darts] ascending within a node */
} thr_multigraph;

/* passes[e] copies of each edge (0 leaves an edge out), and n_ends virtual edges between end[i][0]
 * and end[i][1], which may also be one of n_more nodes that have numbers from the framework's
 * number of nodes on. O(n + darts). Release with thr_multigraph_destroy. */
thr_status thr_multigraph_init(thr_multigraph *multigraph, const thr_frame *frame, int n_more,
                               const int *passes, const int (*end)[2], int n_ends,
                               thr_err *err) THR_MUST_CHECK;
void thr_multigraph_destroy(thr_multigraph *multigraph);

/* Pairs a and b in an array in which every member names its mate. */
static inline void thr_set_pair(int *mate, int a, int b)
{
  mate[a] = b;
  mate[b] = a;
}

/* ---- pairing.c: Pairing the passes at one node: minimum-weight perfect matching of n points under
 * any prices. */

enum { THR_PAIRING_EXACT = 16 }; /* largest n that thr_pairing_best solves exactly */

/* price[i * n + j] = price[j * n + i] of pairing i with j. mate[n] receives the pairs; n must be
 * even (THR_EINPUT). n <= THR_PAIRING_EXACT: least total price, by dynamic programming over
 * subsets, O(2^n n). More: first with last half, then exchanges of two pairs until none saves. */
thr_status thr_pairing_best(int n, const double *price, int *mate, thr_err *err) THR_MUST_CHECK;

/* ---- tour.c: From edge multiplicities and ends to one cord, through the walk that
 * graph/threading/walks.c traces. */

/* The cord of a framework of one component; passes[e] >= 1 for every edge. ends are its two end
 * nodes: different nodes = open from the first to the second; both v = closed at v; both -1 =
 * closed, starting at an end node that the options allow (a foot rather than another) where the
 * turn that closing leaves out is sharpest. The half array of cord is allocated for the caller,
 * none on failure. THR_EINPUT if passes and ends leave a node with an odd number of both.
 * Near-linear in passes. */
thr_status thr_tour_cord(const thr_frame *frame, const thr_request *options, const int *passes,
                         const int ends[2], thr_cord *cord, thr_err *err) THR_MUST_CHECK;

/* The pass from which the closed circuit half[0 .. n-1] had best start as a cord, as above; options
 * NULL: at any node, the first of its sharpest turns. */
int thr_tour_start(const thr_frame *frame, const thr_request *options, const int *half, int n);

/* ---- threading.c: A threading while it is changed: the passes as half-edges
 * (graph/threading/multigraph.c), which of them continues into which at every node (its transition
 * system), the cords that this makes, in order, with running sums of a price, and exchanges of
 * pairs that are tried and taken back. */

/* The price of what is not allowed. */
#define THR_FORBIDDEN 1e9

/* Price of pairing half-edges a and b of one node: THR_FORBIDDEN or more if they must not be. */
typedef double thr_pair_price(const void *of, int a, int b);

/* A place on a cord, at a node: it arrives against half-edge in and leaves along out. */
typedef struct {
  int cord, index; /* of its cord; number on it, from 0 */
  int in, out;
  double before, price; /* of the pairs ahead of it on the cord, of its own */
} thr_place;

typedef struct {
  const thr_frame *f;
  const thr_multigraph *g;
  int *mate; /* [n_darts] as in graph/threading/transition.c; -1 where a cord ends. These three are
                borrowed. */
  thr_pair_price *price; /* of(a, b); NULL: all 0 */
  const void *of;
  bool tied;        /* cords must tie every node (graph/plan/plan_measures.h) */
  int n_cords;      /* open ones first */
  int n_places;     /* of all cords */
  int *first;       /* [n_cords + 1] places of cord k: place[first[k]] .. place[first[k + 1] - 1] */
  thr_place *place; /* in order along the cords */
  int *at;          /* [n_darts] the place that a half-edge is part of; below 0 where a cord ends */
  double *total;    /* [n_cords] price of all its pairs */
  int *parent;      /* [n_edges] scratch */

  /* Prices as they were computed last: paid[a] - 1 is the b of (a, b), pair_price[a] the price. */
  int *paid;          /* [n_darts] 0 = none yet; owned */
  double *pair_price; /* [n_darts] owned */
  struct thr_trace {
    int n_cords, n_places, *first, *at;
    thr_place *place;
    double *total;
  } before; /* what was followed the time before; owned */
} thr_threading;

/* Allocates a threading whose cords are not followed yet. On failure threading is to be destroyed
 * too. */
thr_status thr_threading_init(thr_threading *threading, const thr_frame *frame,
                              const thr_multigraph *multigraph, int *mate, thr_pair_price *price,
                              const void *of, bool tied, thr_err *err) THR_MUST_CHECK;
void thr_threading_destroy(thr_threading *threading);

/* Fills in all places from the pairs: open cords from the lower of their last half-edges, in that
 * order, then closed ones from their lowest. false: there are more than most cords, not all of
 * which are followed. O(darts). */
bool thr_threading_follow(thr_threading *threading, int most);

/* Goes back to what was followed the time before, once the pairs are again what they were then.
 * O(1). */
void thr_threading_unfollow(thr_threading *threading);

/* The same half-edges without an order: cord[n_darts] receives the number of the cord of each.
 * Returns how many cords there are.
 */
int thr_threading_label(const thr_multigraph *multigraph, const int *mate, int *cord);

/* Returns whether cord k comes back to its start, where no end is. */
static inline bool thr_threading_closed(const thr_threading *threading, int k)
{
  return threading->g->half[threading->place[threading->first[k]].in] >= 0;
}

/* Lists the places at node v, each once, in the order of the half-edges that cords arrive against,
 * and returns their number. */
int thr_threading_places(const thr_threading *threading, int v, int *place);

/* Returns whether the pairs at node v tie its edges. A node with a single edge is tied. */
bool thr_threading_tied(const thr_threading *threading, int v);

/* Pairs that were broken up, to be made again. {0}: none. */
typedef struct {
  int n, pair[4][2];
} thr_broken;

/* Pairs a with b and c with d, where a and b were paired with c and d, in either order. old: notes
 * what they were (NULL: no). */
void thr_threading_pair(thr_threading *threading, int a, int b, int c, int d, thr_broken *old);
void thr_threading_take_back(thr_threading *threading, thr_broken *old);

/* Takes the pairs back unless they leave all nodes tied that must be. */
bool thr_threading_keep(thr_threading *threading, thr_broken *old);

/* Two places of one node, paired anew: half-edges made[0] with made[1], made[2] with made[3]. */
typedef struct {
  int made[4];
  double extra; /* what that costs more */
  int change;   /* cords more: 1 cuts a closed one off, -1 joins one to another */
} thr_exchange;

/* crossed: arriving with arriving, which runs a part of one cord the other way round; else arriving
 * with leaving, which cuts it in two. Two open cords exchange their ends; others become one, either
 * way. */
thr_exchange thr_threading_exchange(const thr_threading *threading, int i, int k, bool crossed);

/* Returns whether an exchange makes no forbidden pair and leaves its node tied if it must be. */
bool thr_threading_allows(thr_threading *threading, const thr_exchange *x);

/* Makes an exchange. Afterwards the cords are to be followed again. */
void thr_threading_make(thr_threading *threading, const thr_exchange *x, thr_broken *old);

/* Makes one change at node v that improves, and follows the cords again; false: there is none. */
typedef bool thr_node_improve(void *of, int v);

/* Descent: node by node, until a look at all of them improves nothing or the limits stop it. */
void thr_threading_descend(const thr_threading *threading, const thr_limits *limits,
                           thr_node_improve *improve, void *of);

/* ---- transition.c: Transition systems: at every node, which pass continues into which. */

/* mate[d] of dart d is the dart at the same node that the cord leaves by when it arrives against d
 * (along d ^ 1); mate[mate[d]] = d. Array of n_darts, owned by the caller. */

/* Price of continuing from dart a to dart b at their node: the turning angle in rad (0 for a cord
 * end), and THR_U_TURN_PRICE more for a U-turn or for joining two cord ends, which would leave a
 * cord without a pass. */
#define THR_U_TURN_PRICE 1000.0

/* Pairs the darts at every node. Up to 12 darts: least total price, by dynamic programming over
 * subsets, so a node has a U-turn only where no pairing is without one. More darts: no U-turn where
 * one can be avoided, price not minimized; linear. Every degree must be even (THR_EINPUT
 * otherwise). four[n_nodes], if it is not NULL, receives for thr_transition_join the prices of the
 * three pairings at nodes with four darts, which most nodes of shells have. */
thr_status thr_transition_pair(const thr_frame *frame, const thr_multigraph *multigraph, int *mate,
                               double (*four)[3], thr_err *err) THR_MUST_CHECK;

/* Exchanges pairs (a b)(c d) -> (a c)(b d) or (a d)(b c) at nodes where two circuits meet, cheapest
 * first, until each component of the multigraph is one circuit. Adds no U-turn where the pairs at
 * hand have none: if both new pairings had one, an old pair would have been one. Stops earlier
 * where no more than `enough` circuits are left (0: at no number). O(p log p) a round for p pairs
 * of pairs, few rounds. four: as thr_transition_pair left it, or NULL. */
thr_status thr_transition_join(const thr_frame *frame, const thr_multigraph *multigraph, int *mate,
                               const double (*four)[3], int enough, thr_err *err) THR_MUST_CHECK;

/* Where two passes of one edge are in different sets of circuits, exchanges their partners at one
 * node, which joins the sets: the same turns, fewer circuits. circuit[n_darts], which parent's
 * disjoint sets are of. Near-linear. */
void thr_transition_join_equal(const thr_multigraph *multigraph, const int *circuit, int *parent,
                               int *mate);

/* The other way round: pairs as walks run, the passes of each being the next copies of their edges;
 * the ends of an open one are the next virtual edges at its nodes. next[n_edges + n_nodes]: their
 * first darts, as thr_transition_copies says. Linear. */
void thr_transition_copies(const thr_frame *frame, const thr_multigraph *multigraph, int *next);
void thr_transition_walk(const thr_frame *frame, const thr_multigraph *multigraph, const int *half,
                         int n, bool open, int *next, int *mate);

/* The cord from dart start on, until it comes back there or ends (mate < 0): its darts into out,
 * room for n_darts / 2, *count how many. Linear. */
void thr_transition_trace(const int *mate, int start, int *out, int *count);

/* ---- walks.c: Walks through the passes of a framework (graph theory's: consecutive half-edges, an
 * edge as often as it comes), while it is still open which cord takes which. */

/* Consecutive half-edges. */
typedef struct {
  int n, *half;  /* owned */
  double length; /* in units */
  bool cyclic;   /* comes back to its start, where no cord end is yet */
} thr_walk;

typedef struct {
  int n_walks, capacity;
  thr_walk *walk; /* owned */
} thr_walks;

void thr_walks_destroy(thr_walks *walks);

/* As few walks as pass every edge passes[e] times, edges with passes being one component, paired
 * for little turning: a cyclic one where all nodes have an even number of passes, else open ones
 * between those that have not. Near-linear in passes. */
thr_status thr_walks_trace(const thr_frame *frame, const int *passes, thr_walks *out,
                           thr_err *err) THR_MUST_CHECK;

/* Appends the circuits of a transition system (graph/threading/transition.c): those with virtual
 * edges first, which are cut there; each from its lowest dart. Linear. */
thr_status thr_walks_follow(thr_walks *walks, const thr_frame *frame,
                            const thr_multigraph *multigraph, const int *mate,
                            thr_err *err) THR_MUST_CHECK;

/* Appends a walk, which is taken over, or released on failure. Its length is worked out. */
thr_status thr_walks_add(thr_walks *walks, const thr_frame *frame, thr_walk walk,
                         thr_err *err) THR_MUST_CHECK;

/* Appends a copy of half[n] as a walk. */
thr_status thr_walks_copy(thr_walks *walks, const thr_frame *frame, const int *half, int n,
                          bool cyclic, thr_err *err) THR_MUST_CHECK;

/* Adds the number of passes that the walks make of each edge to passes[n_edges]. */
void thr_walks_count(const thr_walks *walks, int *passes);

double thr_walk_length(const thr_frame *frame, const int *half, int n);

/* Of all walks; the number of the longest, the first of equals, and its length, 0 if there are
 * none. */
double thr_walks_length(const thr_walks *walks);
int thr_walks_longest(const thr_walks *walks);
double thr_walks_most(const thr_walks *walks);

/* Returns the node before pass number at; with at = n, the node after the last pass. */
int thr_walk_node(const thr_frame *frame, const thr_walk *w, int at);

/* Returns the half-edge before pass number at of a cyclic walk, or of an open one if at > 0. */
static inline int thr_walk_before(const thr_walk *w, int at)
{
  return w->half[at ? at - 1 : w->n - 1];
}

/* Reverses the half-edges of a walk. */
void thr_walk_reverse(int *half, int n);

/* Turns a cyclic walk round so that it starts with what was its pass number at. */
thr_status thr_walk_rotate(thr_walk *w, int at, thr_err *err) THR_MUST_CHECK;

/* Returns the price of going on from half-edge in with out: the turn in rad, and much more for a
 * turn back. */
double thr_walk_turn(const thr_frame *frame, int in, int out);

/* The visits that walks pay to nodes, walk by walk, at positions 0 .. n of each; the last position
 * of a cyclic one is listed, but is no visit. */
typedef struct {
  const thr_frame *f;
  const thr_walk *w; /* the first walk */
  int n;
  int *first;  /* [n_nodes] newest visit, -1 = none */
  int *next;   /* [n] visit before of the same node, -1 = none */
  int *walk;   /* [n] */
  int *at;     /* [n] its position */
  double *sum; /* [n] length of the walk as far as there */
} thr_walk_visits;

/* Lists the visits of walks w[0 .. n_walks - 1], which are borrowed. O(positions + nodes). */
thr_status thr_walk_visits_init(thr_walk_visits *visits, const thr_frame *frame, const thr_walk *w,
                                int n_walks, thr_err *err) THR_MUST_CHECK;
void thr_walk_visits_destroy(thr_walk_visits *visits);

/* Moves the walks into cords: open ones from their lower end, cyclic ones from where closing leaves
 * out most (graph/threading/tour.c). On failure there are none. */
thr_status thr_walks_cords(thr_walks *walks, const thr_frame *frame, const thr_request *options,
                           thr_cord **cord, int *n_cords, thr_err *err) THR_MUST_CHECK;

/* ---- junction_graphs.c: The junction graph of every node (graph/plan/plan_measures.h) while it is
 * still open which cord takes which passes: the turns of all walks, counted, so that a change of
 * turns can be tried. */

/* count[first[v] + a * degree + b]: turns between the half-edges number a and b of node v, in both
 * orders. */
typedef struct {
  const thr_frame *f;
  size_t *first; /* [n_nodes] owned */
  int *place;    /* [2 * n_edges] owned; of a half-edge among those of its node */
  int *count;    /* owned */
  int *queue;    /* [largest degree] owned; scratch, and */
  bool *seen;    /* [largest degree] owned */
} thr_junction_graphs;

/* The turns of the walks, with those that close cyclic ones. O(passes + sum of the squares of the
 * degrees), also in memory. */
thr_status thr_junction_graphs_init(thr_junction_graphs *graphs, const thr_frame *frame,
                                    const thr_walks *walks, thr_err *err) THR_MUST_CHECK;
void thr_junction_graphs_destroy(thr_junction_graphs *graphs);

/* Turns that come and go; at most THR_MOST_CHANGED. */
enum { THR_MOST_CHANGED = 16 };

typedef struct {
  int n;
  struct {
    int in, out, by; /* half-edge that arrives, half-edge that leaves; 1 or -1 */
  } turn[THR_MOST_CHANGED];
} thr_turn_change;

/* in or out < 0: a cord end, where nothing turns. */
void thr_turn_change_note(thr_turn_change *change, int in, int out, int by);

/* Does every node that the change is about stay tied (one that was not before is no worse for it),
 * and does nothing turn back? */
bool thr_junction_graphs_allow(thr_junction_graphs *graphs, const thr_turn_change *change);
void thr_junction_graphs_make(thr_junction_graphs *graphs, const thr_turn_change *change);

/* ---- splice.c: Walks cut into sections that are joined anew. */

enum { THR_MOST_SECTIONS = 10 };

typedef struct {
  bool cyclic; /* the walks, before and afterwards */
  struct {
    const int *half; /* borrowed */
    int n;
    bool added; /* new passes, not those of a walk */
  } row[3];     /* where sections come from */
  struct {
    int row, from, end;
    bool backwards;
  } section[THR_MOST_SECTIONS];
  int n, first; /* the first walk afterwards is section[0 .. first - 1], the second the others;
                   first 0: there is one walk only */
} thr_splice;

/* From one walk, or two (b NULL: one). Its third row, or its second, may be set to new passes. */
thr_splice thr_splice_of(bool cyclic, const thr_walk *a, const thr_walk *b);

/* The new passes half[n], borrowed, as row number row. */
void thr_splice_add(thr_splice *splice, int row, const int *half, int n);

/* Passes from .. end - 1 of a row come next; none are no section. */
void thr_splice_put(thr_splice *splice, int row, int from, int end, bool backwards);

/* The second walk begins. */
void thr_splice_next(thr_splice *splice);

/* Turns where the rows are cut, and where sections meet; those inside new passes are left out. */
thr_turn_change thr_splice_turns(const thr_splice *splice);

/* The walk or walks afterwards take the place of walks a and b of walks; b < 0: the second is
 * added, and where there is no second one, b is removed and its number is that of the last. ties:
 * gets and loses the turns (NULL ok); passes[n_edges]: gets the new passes (NULL where there are
 * none). On failure nothing has changed. */
thr_status thr_splice_make(const thr_splice *splice, const thr_frame *frame, thr_walks *walks,
                           int a, int b, thr_junction_graphs *ties, int *passes,
                           thr_err *err) THR_MUST_CHECK;

/* Open walk number i keeps its passes before number at; the others become a new walk, the last. */
thr_status thr_splice_cut(thr_walks *walks, const thr_frame *frame, int i, int at,
                          thr_err *err) THR_MUST_CHECK;

/* ---- even.c: Exchanges that even out the totals of a threading's cords: the sum of their 8th
 * powers, in which the largest counts most, is made small by descent and by simulated annealing (S.
 * Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983). */

typedef struct {
  thr_threading *t; /* borrowed; all its cords are open, or all closed */
  const thr_limits *limits;
  int n_cords;    /* that there are to be */
  double scale;   /* a total that counts as 1 */
  uint64_t state; /* of the random numbers */
} thr_evener;

/* Follows all cords again. false: there are circuits that are no cords, or not as many cords.
 * O(darts). */
bool thr_evener_follow(thr_evener *evener);

double thr_evener_value(const thr_evener *evener);
double thr_evener_largest(const thr_evener *evener);

/* Exchanges that lower the value, until none does or the limits stop it: tails and heads of two
 * open cords that meet at a node, parts run the other way round, parts cut off one cord and joined
 * to another. */
void thr_evener_even(thr_evener *evener);

/* One change at random, at this place among others, that keeps the number of cords if *old is not
 * empty and thr_evener_follow, which is to be called next, says so. Else the pairs are to be taken
 * back, and what was followed, too (thr_threading_unfollow). */
void thr_evener_propose(thr_evener *evener, int place, thr_broken *old);

/* The same at random, so many steps, and some that raise the value, with falling probability; ends
 * at the best that it came by, or where the largest total is at the bound. What most changes make
 * of the totals is known from running sums: O(1) a step that is not taken, O(darts) one that is.
 * best: [n_darts] scratch. */
void thr_evener_anneal(thr_evener *evener, int steps, double bound, int *best);

/* ---- subsets.c: The cheapest walks of a small component, exactly, by a table over subsets of what
 * they have to collect together. */

enum { THR_SUBSETS_MOST_ITEMS = 20 };

typedef struct {
  int from, to; /* states */
  double cost;  /* >= 0 */
  uint32_t gains;
  uint32_t one_of[2]; /* and one more of each of these groups; 0 = none. All are there: only if they
                         may be had again */
} thr_subsets_step;

/* Walks begin with a start (its from means nothing) and end with an end. Open ones: any start, any
 * end (its to means nothing). Closed ones, which may be turned round: the start is of the lowest
 * state that they visit, and the end leads back to that. */
typedef struct {
  int n_states, n_items;
  bool closed;
  int first[THR_SUBSETS_MOST_ITEMS]; /* the items like item i are from item first[i] on, one after
                                        the other: a group */
  uint32_t once; /* items that are collected at most once, by all walks together: of groups all or
                    none */
  uint32_t required; /* items that all walks together have to collect, one at least; of groups the
                        first ones */
  int n_steps, n_starts, n_ends;
  thr_subsets_step *step, *start, *end; /* steps by ascending from */
} thr_subsets_model;

typedef struct thr_subsets thr_subsets;

/* Fills f of the model, which is borrowed. *work: how often states and parts of sets may be looked
 * at, which this and the functions below take from. *subsets is NULL if that or the limits stopped
 * it, or there are more than 10 million sets and states: 18 items have room for 38 states. 12 bytes
 * each. */
thr_status thr_subsets_create(const thr_subsets_model *subsets_model, const thr_limits *limits,
                              double *work, thr_subsets **subsets, thr_err *err) THR_MUST_CHECK;
void thr_subsets_destroy(thr_subsets *subsets);

/* Least cost of the dearest of least .. most walks that collect enough together; INFINITY: there
 * are none, NAN: too long to find out. */
thr_status thr_subsets_dearest(thr_subsets *subsets, int least, int most, double *cost,
                               thr_err *err) THR_MUST_CHECK;

/* The cheapest least .. most walks together of which none costs more than limit; fewest: as few as
 * there are in the first place. *n = 0: there are none, -1: too long to find out. */
thr_status thr_subsets_find(thr_subsets *subsets, int least, int most, bool fewest, double limit,
                            int *n, double *cost, thr_err *err) THR_MUST_CHECK;

/* States of walk i of those found last, and its cost: *state is the caller's to free. THR_ELIMIT:
 * stopped. */
thr_status thr_subsets_walk(thr_subsets *subsets, int i, int **state, int *n, double *cost,
                            thr_err *err) THR_MUST_CHECK;

/* ---- items.c: A small framework of one component as walks that collect items
 * (graph/threading/subsets.c): states are its half-edges. */

typedef struct {
  const thr_frame *f;
  const thr_request *o; /* joint, cover, capacity, ends */
  bool turning;         /* turns are what costs, as options.turning prices them, not length */
  uint32_t full;        /* edges whose capacities count, 1 << i */
  int n_cuts;
  uint64_t cut[THR_SUBSETS_MOST_ITEMS]; /* sets of states that leave one node */
  double longest;                       /* edge */
  int n_edges;
  uint32_t *pass, *end; /* [n_edges], [f->n_nodes] their items */
  uint32_t *turn;       /* [n_cuts] its item */
  thr_subsets_model m;
} thr_items;

/* Without capacities or cuts. With turning U-turns are only at nodes with one edge, with tube
 * joints nowhere. */
thr_status thr_items_init(thr_items *items, const thr_frame *frame, const thr_request *options,
                          bool turning, thr_err *err) THR_MUST_CHECK;
void thr_items_destroy(thr_items *items);

/* Makes the model. *small false: it has too many items. */
thr_status thr_items_model(thr_items *items, bool *small, thr_err *err) THR_MUST_CHECK;

/* Of walks of such a model, n_passes[i] states each. *keep: they keep the capacities and tie the
 * nodes. Else what they miss counts from now on; *more: there was something to add. */
thr_status thr_items_refine(thr_items *items, int n_walks, int *const *state, const int *n_passes,
                            bool *keep, bool *more, thr_err *err) THR_MUST_CHECK;

/* ---- small_cords.c: All cords of a small framework of one component at once, exactly: shortest or
 * turning least, together or the worst of them, or as few as a limit allows. */

/* Cost is length, or with turning the price of turns (options.turning.cost). */
typedef struct {
  int least, most; /* so many cords */
  bool turning;
  bool even;    /* the dearest as cheap as can be; then, and without it, cheap in all */
  double limit; /* of each cord's cost, INFINITY = none: then as few cords as can be */
  int known;    /* cords that are known already; 0 = none. What these cost: */
  double known_dearest, known_sum;
} thr_small_ask;

typedef struct {
  int n;
  int *n_passes, **half; /* half-edges of each; owned */
} thr_small_cords;

void thr_small_cords_destroy(thr_small_cords *cords);

/* Of the options ends, covers, capacities and joint. out: cords that are better than those
 * known, and as asked for; else none. *certain: nothing is better than those or, without them, than
 * the known ones; or there are none at all. Not certain: too many items, or stopped by the limits.
 */
thr_status thr_small_cords_find(const thr_frame *frame, const thr_request *options,
                                const thr_small_ask *ask, const thr_limits *limits,
                                thr_small_cords *out, bool *certain, thr_err *err) THR_MUST_CHECK;

/* ---- Simulated annealing of several cords, which makes the largest length, or the largest sum of
 * turns, of a cord small.
 *
 * Read anneal.c first: the runs, the temperatures and which changes are taken. Then anneal_walks.c:
 * the walks, what is known of them, and how a change is made. anneal_exchange.c and anneal_route.c
 * propose the changes: exchanges, which keep all passes, and routes, which do not. */

/* ---- walk_price.c: Computes what one cord counts for, by length, turning or pull. */

/* Returns the price of the turns of a cord, its pulled turning, or its length, as measure says; the
 * second one the number of the cord with the largest price, the first of equals. */
double thr_walk_price(const thr_turning_columns *columns, thr_walk_measure measure,
                      const thr_cord *cord);
int thr_walk_dearest(const thr_turning_columns *columns, thr_walk_measure measure,
                     const thr_cord *cord, int n_cords);

/* Return the summands of thr_walk_price: what the pass after number k adds, for k = -1 .. n - 1,
 * and this n. */
double thr_walk_pass_price(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord, int k);
int thr_walk_priced_passes(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord);

/* ---- anneal.c: Cords evened out by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P.
 * Vecchi 1983) that changes their passes, too. */

typedef struct {
  thr_walk_measure measure;
  int steps;         /* of a run at most: changes at random */
  int first, rounds; /* number of the first round, whose random numbers are others than those of the
                        rounds before; and how many */
  bool alone;        /* one run in a round instead of two: this thread has no other beside it */
  bool near; /* of turnings: every second run stays near the best cords, again and again, where the
                others forget them */
  double enough; /* largest price or length that need not become less */
} thr_anneal_task;

/* Lowers the largest price of the turns of n_cords cords, or their largest length, and replaces
 * them where it falls, as long as it is above enough: in rounds of two runs each from the best so
 * far (alone: of one; of lengths every second run begins hotter), until all rounds are done, or
 * several in turn were in vain, or the limits' time is up. Where
 * ends are counted at nodes they stay; with tube joints every node stays tied. Every edge keeps the
 * passes that the columns ask for, and has no more than they allow. *better: whether it fell. A
 * change that is not taken takes time that does not depend on the framework, one that is O(passes
 * of two cords). */
thr_status thr_anneal(const thr_turning_columns *columns, const thr_anneal_task *task,
                      const thr_limits *limits, thr_cord *cord, int n_cords, bool *better,
                      thr_err *err) THR_MUST_CHECK;

/* ---- The walks that are annealed, and changes of them. Internal to anneal*.c. */

/* A cord. An open one visits the nodes between its passes, number i ahead of pass i, for i = 1 .. n
 * - 1; a closed one also ahead of pass 0. */
typedef struct {
  int n, room, *half, *slot; /* [room]; slot: of visit i, in the list of its node */
  double *sum; /* [room] price as far as into pass i; of a closed one from pass 0 on */
  double total;
} thr_anneal_walk;

typedef struct {
  int cord, at;
} thr_anneal_visit;

/* A change of one cord or two, put together from sections of what there is and of new passes. */
typedef struct {
  int n_cords, cord[2];
  double total[2]; /* what the cords turn by afterwards */
  int n[2];        /* passes of each in made */
  bool keeps;      /* every edge keeps its passes */
} thr_anneal_change;

typedef struct {
  const thr_turning_columns *c;
  thr_walk_measure measure;
  bool closed;
  bool fixed;      /* open cords end where they do, as ends are counted at nodes */
  bool tube;       /* the turns tie the edges of every node together */
  thr_scratch own; /* all but the walks' arrays */
  int n_cords;
  thr_anneal_walk *walk; /* [n_cords] */
  int *pair_first;       /* [n_nodes] of the prices of the turns at a node */
  double *price; /* [sum of the squares of the degrees] by the numbers of both half-edges at their
                    node */
  int *tied;     /* tube: [2 * n_edges] half-edges of a node */
  int *turns; /* tube: [as price] how often cords turn from one of these half-edges to the other */
  double *end_price; /* [n_edges] of a cord end; lengths are half those of the passes before and
                        after a turn */
  double noise;      /* of the prices of a route */
  int *visit_first;  /* [n_nodes] of a node's visits */
  int *n_visits;     /* [n_nodes] */
  thr_anneal_visit *visit;  /* as many as there may be passes */
  int *passes;              /* [n_edges] */
  int *count;               /* [n_edges] zeros: passes of what is looked at */
  double extra, most_extra; /* length of the passes beyond the covers, and how much it may be */
  double *to_end; /* [2 * n_edges] open: least price of the turns from a half-edge to an end; */
  int *next;      /* [2 * n_edges] the half-edge after it on that way, -1: it ends there */
  int room;       /* of made, for each cord */
  int *made[2];   /* what a change makes of its cords */
  int *route, n_route; /* [room] new passes */
  double *reached;     /* [2 * n_edges] searches for routes */
  int *before, *hops, *stamp, *queue, search;
  uint64_t state; /* of the random numbers */
} thr_annealer;

/* Returns the price of a turn from half-edge in to half-edge out; THR_FORBIDDEN: such a turn is not
 * allowed. */
static inline double thr_anneal_turn(const thr_annealer *annealer, int in, int out)
{
  const thr_turning_columns *c = annealer->c;
  const int v = c->f->edge[out >> 1][out & 1];
  const int degree = c->f->first[v + 1] - c->f->first[v];
  return annealer->price[annealer->pair_first[v] + c->position[in ^ 1] * degree + c->position[out]];
}

/* Copies the cords as walks into an annealer. The state of the random numbers becomes 1. On failure
 * the annealer is to be destroyed too. O(passes + turns). */
thr_status thr_annealer_init(thr_annealer *annealer, const thr_turning_columns *columns,
                             thr_walk_measure measure, const thr_cord *cord, int n_cords,
                             thr_err *err) THR_MUST_CHECK;
void thr_annealer_destroy(thr_annealer *annealer);

/* Makes a change, unless edges would no longer keep to their covers and limits, or tube joints
 * would no longer be tied. O(passes of its cords, and the squares of the degrees where turns go).
 */
thr_status thr_anneal_make(thr_annealer *annealer, const thr_anneal_change *change,
                           thr_err *err) THR_MUST_CHECK;

/* Appends the passes from .. end - 1 of half[], turned round if backwards, to what is made of a
 * change's cord i. */
void thr_anneal_put(thr_annealer *annealer, thr_anneal_change *change, int i, const int *half,
                    int from, int end, bool backwards);

/* Computes the price of the passes that are made for cord i of a change; THR_FORBIDDEN or more:
 * they have a turn that is not allowed. O(passes). */
double thr_anneal_total(const thr_annealer *annealer, const thr_anneal_change *change, int i);

/* Returns whether every edge keeps its cover without the passes from .. end - 1 of a cord. */
bool thr_anneal_spare(thr_annealer *annealer, const thr_anneal_walk *walk, int from, int end);

/* An exchange of sections whose totals are known from running sums; thr_anneal_build puts the walks
 * together if the exchange is taken. */
typedef struct {
  thr_anneal_change change;
  enum { THR_ANNEAL_TAILS, THR_ANNEAL_REVERSE, THR_ANNEAL_LOOP, THR_ANNEAL_MIDDLES } kind;
  int i, i2, j, j2, m; /* places on both cords; of a loop, where it is entered */
  bool turned;         /* the part of the second cord, or the loop, runs backwards */
} thr_anneal_exchange;

/* Each proposes a change of cord number `cord` and returns whether there is one. All but
 * thr_anneal_exchanges have put the walks together when they return. */
bool thr_anneal_exchanges(thr_annealer *annealer, int cord, thr_anneal_exchange *exchange);
void thr_anneal_build(thr_annealer *annealer, thr_anneal_exchange *exchange);
bool thr_anneal_drop_loop(thr_annealer *annealer, int cord, thr_anneal_change *change);
bool thr_anneal_end_elsewhere(thr_annealer *annealer, int cord, thr_anneal_change *change);
bool thr_anneal_reroute(thr_annealer *annealer, int cord, thr_anneal_change *change);

/* Returns a visit to a node, drawn from all of them; cord -1: there is none. */
thr_anneal_visit thr_anneal_visit_at(thr_annealer *annealer, int node);

#endif
