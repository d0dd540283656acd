/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what follows from the cords of a plan without any search: loose chains while they are
 * threaded, channels inside pieces, junctions, gaps that are seated, knots, instructions; and the
 * prices that certificates may need. */
#ifndef THR_PLAN_MEASURES_H
#define THR_PLAN_MEASURES_H

#include "graph/plan/plan.h"

/* ---- chains.c: How what is threaded holds together while it is threaded. */

typedef struct {
  int longest;     /* pieces */
  int64_t squares; /* sum over all loose chains */
} thr_chains;

/* -1, 0 or 1: a shorter longest chain comes before smaller squares. */
int thr_chains_compare(thr_chains a, thr_chains b);

/* Of the work one part after the other. */
thr_chains thr_chains_together(thr_chains a, thr_chains b);

/* Passes: shorter cords are threaded from their end, with two needles too; closed cords from
 * THR_FOLD_LONG on, two steps of the booklet, with two needles if nothing else is said: each draws
 * through half as much cord, half as often. */
enum { THR_FOLD_LEAST = 24, THR_FOLD_LONG = 48 };
static const double THR_FOLD_ROUNDING =
    1e-9; /* of the length of a cord: so much nearer to its middle is no nearer */

/* Is it threaded from its fold? needles: 1, 2, or 0: as is usual. */
bool thr_cord_folded(int needles, const thr_cord *cord);

/* The pass that the right needle begins with: that at whose start the way along the cord is nearest
 * to half of it, of two the earlier; 0 of a cord that is not folded. O(passes). */
int thr_cord_fold(const thr_frame *frame, int needles, const thr_cord *cord);

/* Pieces in the order of the passes: n_passes with tube joints, one more with solid ones. item:
 * that many. */
int thr_cord_pieces(const thr_frame *frame, thr_joint joint, const thr_cord *cord, int *piece);

/* Pieces that are on cords. {0} is empty. */
typedef struct {
  int *on;   /* [pieces] on a cord that was kept, on that of the present trial, or neither; owned */
  int trial; /* >= 1 */
} thr_threaded;

enum { THR_KEPT = -1 };

thr_status thr_threaded_init(thr_threaded *threaded, const thr_frame *frame, thr_joint joint,
                             thr_err *err) THR_MUST_CHECK;
void thr_threaded_destroy(thr_threaded *threaded);

/* Pieces that a framework has, and whether piece is on a cord that was kept. */
int thr_chains_pieces(const thr_frame *frame, thr_joint joint);
static inline bool thr_threaded_kept(const thr_threaded *threaded, int piece)
{
  return threaded->on[piece] == THR_KEPT;
}

/* Threads the pieces piece[n] from number fold on, then those before it backwards, as a trial:
 * chain[n] receives the lengths of the loose chains, whose number is returned. O(n). */
int thr_threaded_try(thr_threaded *threaded, const int *piece, int n, int fold, int *chain);

/* The pieces stay. */
void thr_threaded_keep(thr_threaded *threaded, const int *piece, int n);

thr_chains thr_chains_of(const int *chain, int n);

/* The order in which cords are threaded: as they are numbered, but the copies of a path right after
 * it. order: [n_cords]. */
void thr_plan_work(const thr_plan *plan, int *order);

/* The loose chains of a plan threaded with so many needles (thr_cord_folded). O(passes). */
thr_status thr_plan_chains(const thr_plan *plan, int needles, thr_chains *chains,
                           thr_err *err) THR_MUST_CHECK;

/* ---- channels.c: Channels: the ways of the passes through the nodes, that is, with solid joints,
 * through the pieces that a maker holds. */

/* From which arm to which arm. A channel in which a cord begins or ends has one arm only. */
typedef struct {
  int cord;
  int pass;    /* by which the cord comes in, from 0; -1 = it begins here */
  int in, out; /* half-edges that leave the node: the arms; -1 = none */
  int crosses; /* other channels of the node that it crosses */
} thr_channel;

/* {0} is valid and empty. Arrays are owned. */
typedef struct {
  int *rank;  /* [2 * n_edges] places of half-edges in `around` (thr_channels_around) */
  int *first; /* [n_nodes + 1] */
  thr_channel
      *channel;      /* those of node v: channel[first[v] .. first[v + 1] - 1], by cord and pass */
  int64_t crossings; /* pairs of channels that cross, of all nodes */
  int crossed;       /* nodes with such a pair */
} thr_channels;

/* Lists the channels of all nodes. Two channels cross if their four arms are different and lie
 * alternately around the node (see thr_channels_around): no choice of lanes keeps them apart, one
 * has to lie above the other. Where a cord is closed by its plan (thr_cord_turns) the last pass
 * leads on to the first. The cords fit the framework. O(n log n + pairs of channels of a node).
 * Release with thr_channels_destroy. */
thr_status thr_channels_make(thr_channels *channels, const thr_plan *plan,
                             thr_err *err) THR_MUST_CHECK;
void thr_channels_destroy(thr_channels *channels);

/* In around[2 * n_edges] the half-edges that leave each node, as frame->half, but in cyclic order
 * around its normal: the direction in which its arms spread least. On a surface, or nearly so, that
 * is the order in which one sees them; the sense of rotation is that of no side. Arms in one line
 * stand by ascending number. O(n log n). */
thr_status thr_channels_around(const thr_frame *frame, int *around, thr_err *err) THR_MUST_CHECK;

/* Do two channels of a node cross? rank: as in thr_channels. */
bool thr_channels_cross(const int *rank, const thr_channel *a, const thr_channel *b);

/* ---- Tube joints: where only edges are beads, the cord itself ties them together at every node
 * (Demaine, Kirkpatrick & Lin, "Graph Threading", ITCS 2024). */

/* What the proof of least length is about, and how it prices length. end_allowed[n_nodes] is
 * filled, and borrowed by task. Closed cords: one per component, whatever their number, for several
 * that tie the nodes make one of the same length where two pass one edge and are exchanged behind
 * it. most_passes: no shortest plan needs more. Of more passes than covers in one direction along a
 * stretch of edges, two that come from different edges or ends and part again could be joined there
 * and back, which saves the stretch twice; so all come from one node where so many may start, or go
 * to one. */
void thr_tied_task(const thr_frame *frame, const thr_request *options, bool *end_allowed,
                   thr_turning_task *task);

/* *least: no cords of the options with tube joints are shorter, in units of length. THR_EVIOLATED
 * for a proof that does not hold (nothing in it is trusted), THR_EINFEASIBLE if covers and
 * capacities contradict each other. */
thr_status thr_tied_least(const thr_frame *frame, const thr_request *options,
                          const thr_turning_proof *proof, double *least,
                          thr_err *err) THR_MUST_CHECK;

/* tied[v], for n_nodes nodes: is the graph connected whose nodes are the edges at v and whose edges
 * are the turns that cords make there? A turn back into the same edge ties nothing. closing_turns:
 * a closed cord also turns from its last pass into its first (THR_ENDS_CLOSED); else its two ends
 * come out there. A node with one edge is tied. Near-linear in passes and edges. */
thr_status thr_junction_tied(const thr_frame *frame, const thr_cord *cord, int n_cords,
                             bool closing_turns, bool *tied, thr_err *err) THR_MUST_CHECK;

/* ---- seating.c: Which gaps between adjacent pieces the cords close. */

/* Fills in evaluation->seated, the part of the gaps that any cord passes that the tensions seat,
 * and seated_known: not if a cord is not known. Tensions count to 1e-9 of the seating tension.
 * O(passes). THR_ENOMEM. */
thr_status thr_seating_fraction(const thr_frame *frame, const thr_cord *cord,
                                thr_evaluation *evaluation, thr_err *err) THR_MUST_CHECK;

/* pull[n], n = *n_gaps <= n_edges: for every gap that any cord passes the pull, N, equal at all
 * pulled ends, that seats it; ascending, INFINITY where no pull does. only: the cord that is pulled
 * while the others are slack, or -1: all. Every cord known, with its exponents, and no schedule.
 * pull has room for n_edges. O(passes + gaps log gaps). THR_ENOMEM. */
thr_status thr_seating_pulls(const thr_frame *frame, const thr_cord *cord,
                             const thr_evaluation *evaluation, int only, double *pull, int *n_gaps,
                             thr_err *err) THR_MUST_CHECK;

/* ---- knotted.c: Computes the most that a knotted cord resists a movement of the pieces by
 * tightening. */

typedef struct {
  double least, most; /* N; most below least counts as least */
  double gain;
  double exponent; /* of the turn behind the pass; of a cord's last pass it says nothing */
} thr_knotted_pass;

/* Returns that sum for the n passes of one cord, n > 0. point[n + 2] is scratch. O(n) if few
 * corners of the function are between the limits, O(n^2) at most. */
double thr_knotted_most(const thr_knotted_pass *pass, int n, double (*point)[2]);

/* ---- reading.c: What a hand reads of a plan: a run of passes that go straight on is one
 * instruction, what repeats itself along the framework is read once. */

/* Turns of less are "straight on". */
static const double THR_STRAIGHT = 0.26179938779914943654; /* rad, 15 degrees */

/* How far from another node's a node's place may be, moved along, to be that node's in what repeats
 * itself: in parts of the mean length of an edge. */
static const double THR_READING_NEAR = 0.05;

typedef struct {
  int instructions; /* runs; ends that may be anywhere; one more for each path that repeats itself,
                       or is repeated elsewhere */
  int repeated;     /* paths that repeat themselves: their first period is read */
  int mapped; /* paths that are images of a part of themselves under the plan's group: that part is
                 read, up to where it is turned, or to the mirror */
  int moved;  /* unique paths that are an earlier one moved along, without a turn: not read */
} thr_reading;

/* Of the plan's unique paths, or of all its cords if it has no record of symmetry. O(passes^2) at
 * worst for every path, for every two paths of as many passes, and for every generator and two
 * copies of a path. */
thr_reading thr_reading_of(const thr_plan *plan);

/* ---- Prices of places: what a certificate (graph/plan/plan.h) says beyond odd cuts where cords
 * need more passes than a join has.
 *
 * Passes hold as many cords as are asked for only if there are places enough:
 * - ends free: every pass that arrives where a cord may end is a place for an end, and two are
 * needed for a cord;
 * - ends given at nodes (THR_ENDS_COUNTS): the same, as many as there are ends, at each node;
 * - closed: K cords are K circuits. Of two circuits over one edge, one may have both passes, so all
 * pairs of passes count as circuits, two places each. The other passes are a set of edges that
 * falls into circuits; one over edge e has as many edges as the shortest loop of e at least, so e
 * has 2 / that many places. With a price for each place, the least weight less the prices of the
 * places that there are, plus those of the places that are needed, is a lower bound (Lagrange).
 * Less its price an edge may cost less passed than not; then it has an odd number of passes in the
 * first place, which changes the parity of its two nodes, and the odd cuts are about passes more or
 * less than that. */

__extension__ typedef __int128 thr_wide; /* sums of hostile 64-bit multipliers cannot overflow it */

/* Of one edge, in units of 1/denominator: weight of extra passes less the price of the places that
 * they add. */
typedef struct {
  thr_wide even, odd; /* least with an even and with an odd number of extra passes */
  thr_wide held;      /* price of the places that the passes it needs are */
  int passes[2];      /* extra passes, even and odd, that cost that */
  bool room, endless; /* does it have room for one? Is more and more of it ever cheaper? */
} thr_priced;

/* Prices that a certificate must have, if any: of every place alike (1); THR_ENDS_COUNTS: one for
 * every node of its component, in order. None with symmetric plans, whose cords are not asked for
 * by number. */
int thr_prices_number(const thr_request *options, int n_nodes);

/* of: sum of the prices at the edge's two nodes where cords may end; THR_ENDS_CLOSED: the price of
 * a place. weight: of the edge, times the denominator. loop: as thr_prices_loops says. */
thr_priced thr_prices_edge(const thr_frame *frame, const thr_request *options, int e,
                           thr_wide weight, thr_wide of, int loop);

/* Number of edges of the shortest loop over each of edge[n], or fewer: no more than 10 are told
 * apart, and 2^24 steps taken. loop is indexed like edge. work[2 * n_nodes] is 0 at first, and may
 * serve for other edges after that. */
void thr_prices_loops(const thr_frame *frame, const int *edge, int n, int *work, int *loop);

/* ---- How many cords, and from where: what `thread advise` found out, plan by plan, and which of
 * them it recommends. The planner fills it in (planner/advise.c), tables and pictures show it.
 *
 * Pulled at both ends, a cord is slackest at the pass with the turning from both ends most nearly
 * equal. Its reach is the turning from there to the end that is farther off, and the pull in N is
 * seating x exp(mu x reach) (docs/method.md, "Pull force").
 *
 * Example: turns of 30, 90 and 40 degrees: after the second there are 120 and 40 degrees, after the
 * first 30 and 130: reach 120 degrees. */

/* N. The most for a hand: what `thread plan --hand one` allows, and the mean strength of women's
 * tip pinch (some 11 pounds: Mathiowetz et al., Arch. Phys. Med. Rehabil. 66, 1985). And what thumb
 * and finger manage time after time: 14 % of the strongest (endurance of intermittent contractions:
 * Bjorksten & Jonsson, Scand. J. Work Environ. Health 3, 1977) of the key pinch (some 16 pounds, 72
 * N). */
extern const double thr_hand_most, thr_hand_always; /* 50, 10 */

enum { THR_ADVICE_LOW, THR_ADVICE_MU, THR_ADVICE_HIGH, THR_ADVICE_PULLS };

/* A plan of `cords` cords in every component, or with `uneven` in the one that has most, whose cord
 * that turns most turns as little as was found in time. */
typedef struct {
  int cords, all;         /* all: of all components together */
  bool uneven;            /* has a component fewer than another? */
  thr_ends ends;          /* closed, any or feet */
  double length, longest; /* units, of all cords and of the longest */
  double turning;         /* rad, of the cord that turns most */
  double bound;           /* rad; no such plan has less. 0 = not known */
  bool optimal;           /* proved: turning is the least */
  bool searched; /* false: the cords are those of another plan, cut evenly, or symmetric ones */
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; INFINITY beyond
                                    1e300 */
  double other;                  /* N at the other end of that cord, at mu */
  int passes;                    /* of all cords */
  int steps; /* learned: passes of those cords that no automorphism maps onto an earlier one, and
                with THR_ENDS_ANY their ends */
  bool frontier; /* no other row has no more cords, no more cord and no more pull at mu, and less of
                    one of them */
  bool planned;  /* the row measures what `thread plan` alone would make within this hand */
  thr_cord *cord; /* [all] that the row measures, of the whole framework; owned by the advice */
} thr_advice_row;

/* {0} is empty. */
typedef struct {
  thr_physics physics; /* resolved */
  double hand;         /* N: what the pull is to stay within */
  double base_length;  /* units, of the passes that the edges need */
  int n;
  thr_advice_row *row; /* [n] by ends (closed, feet, any), then cords; owned */
  int left_out;        /* rows that buy nothing */
  int chosen;          /* the recommended row; -1: no row stays within the hand at mu_high */
  bool complete;       /* false: the time was over before all numbers of cords were tried */
} thr_advice;

/* What plans of a framework cost. */
typedef struct {
  int cords;
  double length, pull; /* units, N */
} thr_price;

/* Has other no more of anything than one, and less of something? What differs by a part in 1e9 is
 * as much. Plans that no other beats are the frontier. A pull of NAN neither beats nor is beaten.
 */
bool thr_price_beats(const thr_price *other, const thr_price *one);

void thr_advice_destroy(thr_advice *advice);

/* Pulls from the largest reach of a plan's cords. */
void thr_advice_pulls(const thr_physics *physics, double reach, double pull[THR_ADVICE_PULLS]);

/* The same for a plan as it is, N, with its own physics, which is returned as it is resolved; one
 * that does not fit the framework makes pulls of INFINITY. */
thr_physics thr_plan_pulls(const thr_plan *plan, double pull[THR_ADVICE_PULLS]);

/* Does a row stay within the hand even at mu_high? */
bool thr_advice_within(const thr_advice *advice, const thr_advice_row *row);

/* Sorts the rows, chooses, marks the frontier and drops what buys nothing, and rows of more cords
 * of which one is longer than the longest of fewer, unless none of fewer stays within the hand.
 * Chosen is, within thr_hand_always, the row that is planned, which is never dropped; else, or
 * where it is beyond the hand, the row with the fewest cords that stays within the hand at mu_high:
 * of those with ends at the feet, if one of them does and needs no more than half as much cord
 * again as the fewest of all, else of all. A row buys nothing if another with no more cords, and
 * ends of the same kind or at the feet, has at most a twentieth more pull and no more cord. O(n^2).
 */
void thr_advice_settle(thr_advice *advice);

/* "closed", "at the feet", "anywhere". */
const char *thr_advice_ends(thr_ends ends);

#endif
