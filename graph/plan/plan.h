/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The threading plan: the vocabulary through which all stages meet. The planner makes a plan; the
 * checker, eval, compare and draw read it. docs/plan-format.md is the schema of its JSON.
 *
 * The room graph/plan holds what is asked of a plan, the plan itself with all that is claimed and
 * proved of it, and what follows from its cords without any search. Lengths are in the framework's
 * units, sizes of cord and bead in mm, angles in rad, forces in N.
 *
 * Read in this order:
 *   request.h, request.c         what is asked of a plan
 *   plan.h, plan.c               cords, claims, metrics
 *   turning_proof.h, turning.c   proofs of least turning: the model and its columns
 *   walk_proof.h                 proofs about the longest or hardest cord
 *   physics.h                    cord and bead: physics.c, friction.c, least_pull.c, ..
 *   evaluation.h, schedule.h     results of eval: evaluation.c, standing.c, schedule.c
 *   plan_measures.h, advice.h    what follows from the cords: chains.c, channels.c, seating.c, ..
 *   plan_fields.h                plan.json: request_fields.c, plan_read.c, plan_write.c, .. */
#ifndef THR_PLAN_H
#define THR_PLAN_H

#include "graph/plan/evaluation.h"
#include "graph/plan/request.h"

/* A cord: consecutive half-edges; half[i] arrives where half[i + 1] leaves. A closed cord also ends
 * where it starts. */
typedef struct thr_cord {
  char id[12];   /* "A", "B", .. "Z", "AA", .. */
  int component; /* of the framework, numbered by lowest node */
  bool closed;   /* both ends at one node */
  int n_passes;  /* >= 1 */
  int *half;     /* [n_passes] owned */
} thr_cord;

/* One odd cut: the edges leaving a node set that holds an odd number of odd nodes. The cuts of a
 * certificate form a forest: a cut's set is its own nodes and the sets of its children, all
 * disjoint. Sets of different trees may overlap in any way. So nested sets take no more room than
 * the largest of them. */
typedef struct {
  int parent; /* a later cut, the one right around this one; -1 = none */
  int n_nodes;
  int *node;     /* those in no child, ascending; owned */
  int64_t value; /* >= 0: its dual multiplier in units of 1/denominator */
} thr_cut;

/* Proof of a lower bound on the extra cord of one component (Edmonds & Johnson 1973): a packing of
 * odd cuts. Edge e weighs w_e = round(length_e * scale). A node is odd if the passes that its edges
 * need, with THR_ENDS_COUNTS and its cord ends, are odd in number. The values of the sets that an
 * edge leaves add up to at most w_e * denominator, if the edge has room for an extra pass at all;
 * those of the sets that hold a node where cord ends are allowed, to at most end_price. Then for
 * every j no extra passes that leave j cord ends weigh less than (sum - j * end_price) /
 * denominator: every set is left by an extra pass, or holds a cord end. With prices of places
 * (graph/plan/plan_measures.h) edges have other weights and nodes another parity, and the bound has
 * a term more. */
typedef struct {
  int component;
  double scale;        /* integer weight per unit of length, > 0 */
  int64_t denominator; /* > 0 */
  int64_t
      end_price; /* >= 0, in units of 1/denominator; 0 with THR_ENDS_CLOSED and THR_ENDS_COUNTS */
  int n_prices;  /* 0 unless as many cords as asked for may need more passes than a join has
                    (graph/plan/plan_measures.h) */
  int64_t *place_price; /* >= 0, in units of 1/denominator; owned */
  int64_t join;         /* weight of the extra passes of the plan */
  int64_t sum;          /* of the cuts' values */
  int n_cuts;
  thr_cut *cut; /* owned */
} thr_certificate;

typedef struct {
  bool present;
  bool optimal;       /* proved: the checker agrees, or it says violation */
  double lower_bound; /* no plan with these options is shorter, in units of length */
  double gap;         /* (length - lower_bound) / length */
  bool slack_open; /* not proved that the cords are within options.turning.length_slack of the least
                      length: said in the plan */
  int confirmed;   /* of the shortest passes: programmes on their cuts in which GLPK's exact method
                      found the same weight, and */
  int unconfirmed; /* those it was not asked about, or did not finish in time. A solver's word: not
                      written */
  int n_certificates;
  thr_certificate *certificate; /* one per component; owned */
  thr_turning_proof tied; /* THR_JOINT_TUBE, instead of certificates: the proof of thr_tied_task
                             (graph/plan/plan_measures.h) */
  thr_walk_proof walks;   /* of the longest cord (graph/plan/walk_proof.h); unit 0: none */
  thr_walk_proof pulled;  /* of the length within options.max_pull; unit 0: none */
} thr_length_proof;

/* What is proved about several cords, of plans with the same options. */
typedef struct {
  bool present;
  double longest;       /* length of the longest cord, in units */
  double longest_bound; /* no plan has a shorter longest cord */
  bool longest_optimal; /* proved: the checker agrees, or it says violation */
  int fewest; /* no plan has fewer cords in all, none being longer than options.max_length; 0 = not
                 claimed */
  bool fewest_optimal; /* this one has no more */
} thr_cords_claim;

/* What is proved about how few cords options.max_pull takes: of threadings within a pull
 * (docs/plan-format.md) with the same options but fewer cords, by a tree only of those with at most
 * most_passes over any edge. (In version 1 also: U-turns at nodes with one edge only.) */
typedef struct thr_pull_claim {
  bool present;
  bool optimal; /* proved: this plan has no more */
  int fewest;   /* no such plan has fewer cords in all */
  int excluded; /* at most so many in every component are too few: one would turn too much; below
                   options.cords_least: none */
  int most_passes;
  int64_t cut; /* no turn counts for more in the tree, 2^-THR_TURNING_BITS; 0: no tree, or of
                  version 1 */
  thr_turning_proof tree; /* of so many cords at most; empty where nothing is excluded, or walks or
                             few edges prove it */
  thr_walk_proof walks;   /* of any plans (graph/plan/walk_proof.h); unit 0: none */

  /* What is proved of every component alone, as a framework of its own, instead of all that is
   * above. */
  int n_parts, n_nodes,
      n_edges; /* 0, or as many as there are components; and of a part, what its component has */
  struct thr_pull_claim *part; /* [n_parts], owned; they have no parts */
} thr_pull_claim;

enum { THR_MOST_PULL_PARTS = 100 };

void thr_pull_claim_destroy(thr_pull_claim *claim);

enum {
  THR_PULL_PASSES = 1000000
}; /* most_passes of a tree at least: cords are many, and a pull does not limit passes */

/* Is a number of cords excluded? */
bool thr_pull_excludes(const thr_pull_claim *claim);

/* What is proved about the turning of a plan that turns little: of no plan with the same options,
 * U-turns at nodes with one edge only, at most most_passes over any edge and no more cord than
 * length_limit are all turns together cheaper than lower_bound. */
typedef struct {
  bool present;
  bool optimal;         /* proved: the checker agrees, or it says violation */
  double price;         /* of all turns, as options.turning.cost prices them; THR_TURN_ANGLE: =
                           metrics.turning */
  double lower_bound;   /* what the tree proves */
  double gap;           /* (price - lower_bound) / price, 0 if price is 0 */
  double pairing_bound; /* that an older plan states; 0: none. Nothing verifies it, and it is not
                           written */
  double largest; /* price of the cord that turns most, or with THR_AIM_PULL the largest pulled
                     turning, rad */
  double largest_bound; /* no plan of the same kind has less; with THR_AIM_PULL no threading whose
                           cords turn back anywhere */
  bool largest_optimal;
  int64_t cut; /* with THR_AIM_PULL: no turn counts for more where the tree is read for that,
                  2^-THR_TURNING_BITS; 0: it is not */
  int most_passes;
  double length_limit; /* in units; < 0 = none */
  thr_turning_proof tree;
} thr_turning_claim;

/* How the cords of a symmetric plan are copies of a few unique paths under a group of
 * automorphisms. Cords are compared by the nodes that they run through: of two alike one is a copy
 * of the other, by the identity if need be. */
typedef struct thr_symmetry_record {
  bool present;
  int order;        /* of the group, 1 .. 1024 */
  char name[16];    /* its point group (Schoenflies), or "" if it is a group of the graph only */
  int n_generators; /* of the group, as images of the nodes */
  int *generator;   /* [n_generators * n_nodes] owned */
  int n_images;     /* elements that map unique paths to copies; image 0 is the identity */
  int *image;       /* [n_images * n_nodes] owned */
  int *unique;  /* [n_cords] the cord that this one is a copy of; itself for a unique path; owned */
  int *element; /* [n_cords] image that maps that one to this, perhaps reversed, and a closed one
                   perhaps from another start (not where its ends matter: THR_ENDS_FEET and _NODES,
                   with tube joints also _ANY); owned */
  double steps; /* learned: passes of each unique path and, with THR_ENDS_ANY, ends (of one that
                   runs round none), over the number of elements of the group that map it to itself,
                   those that do so alike counting once */
  int unique_paths; /* number of different values of unique */
  bool retraced; /* are steps counted so? Else, as in older plans, by the ways (from another start,
                    reversed) in which a path is its own image: the same but for paths that read the
                    same backward, or from another start; and it matters where a closed path starts
                    whose first and last pass are over one edge (thr_cord_runs_round) */
} thr_symmetry_record;

void thr_symmetry_record_destroy(thr_symmetry_record *record);

typedef struct {
  double length;      /* of all cords, in units */
  double base_length; /* of the passes that the edges need, in units */
  double overlap;     /* length - base_length */
  int passes;         /* of all cords */
  int most_passes;    /* on one edge */
  int distinct;   /* edges passed by at least options.distinct different cords; 0 where that is not
                     asked for */
  int crossings;  /* of channels inside pieces (thr_channels_make); 0 where options.crossings allows
                     any */
  double turning; /* sum of turning angles over all cords, rad; with THR_ENDS_CLOSED also the turn
                     where a cord closes */
  double max_turning; /* of the cord that turns most, rad */
  double worst_turn;  /* sharpest single turn, rad */
  int u_turns;        /* turns from an edge back into the same edge */
} thr_metrics;

typedef struct {
  thr_frame frame;
  thr_request options;
  char *generator; /* versions of program and libraries, one line; owned */
  int n_cords;
  thr_cord *cord; /* owned */
  thr_metrics metrics;
  thr_symmetry_record symmetry; /* present with symmetric plans */
  thr_evaluation evaluation;    /* of `thread eval`, if present */
  thr_length_proof proof;
  thr_cords_claim cords_claim;
  thr_pull_claim pull_claim;
  thr_turning_claim turning;
  bool left_out; /* of a plan of version 1: what it proves within max_pull, when it was read */
} thr_plan;

void thr_plan_destroy(thr_plan *plan);

/* Gives the plan a new evaluation, which is emptied. A plan of version 1 becomes one of version 2;
 * returns whether what it proves within max_pull by the older definition was left out. */
bool thr_plan_take_evaluation(thr_plan *plan, thr_evaluation *evaluation);
void thr_cords_destroy(thr_cord *cord, int n); /* cord[n] and their half arrays; NULL ok */
thr_status thr_cords_copy(const thr_cord *cord, int n, thr_cord **copy,
                          thr_err *err) THR_MUST_CHECK; /* NULL on failure */

/* Adds to passes[n_edges] how often the cords pass each edge, times by. O(passes). */
void thr_cords_add_passes(const thr_cord *cord, int n, int by, int *passes);

/* Copies framework and options into an empty plan. */
thr_status thr_plan_request(thr_plan *plan, const thr_frame *framework, const thr_request *wishes,
                            thr_err *err) THR_MUST_CHECK;
void thr_cord_id(int i, char id[12]); /* 0 -> "A", 25 -> "Z", 26 -> "AA" */
void thr_certificate_destroy(thr_certificate *c);

int thr_length_proof_cuts(const thr_length_proof *proof); /* odd cuts, or odd sets and junctions,
                                                             that it puts a multiplier on */

/* The longest step that every edge is a whole number of, as is every cord then, within 1e-10 of it;
 * 0: none of a thousandth of the longest edge or more. O(edges). */
double thr_plan_unit(const thr_frame *framework);
/* First and last node of a cord (equal for a closed one). */
int thr_cord_start(const thr_frame *framework, const thr_cord *c);
int thr_cord_end(const thr_frame *framework, const thr_cord *c);
double thr_cord_length(const thr_frame *framework, const thr_cord *c);
int thr_cords_passes(const thr_cord *cord, int n); /* of all together */
int thr_plan_components(
    const thr_plan *plan); /* number of components, from the cords: each has one */
double thr_cords_longest(const thr_frame *framework, const thr_cord *cord,
                         int n); /* length of the longest; 0 of none */

/* Turning angle in rad between arriving over half-edge in and leaving over half-edge out (head(in)
 * = tail(out)): 0 = straight on, pi = U-turn. */
double thr_turn_angle(const thr_frame *framework, int in, int out);

/* The same along a cord, where every direction is worked out once: begun with a half-edge, next
 * says how the one that follows turns away from the last. The frame is borrowed. */
typedef struct {
  const thr_frame *frame;
  double way[2][3];
  int last; /* of the two */
} thr_turns;
thr_turns thr_turns_begin(const thr_frame *framework, int half);
double thr_turns_next(thr_turns *turns, int half);

/* Sum of the turning angles inside a cord, rad; with_closure adds the turn between a closed cord's
 * last and first pass. */
double thr_cord_turning(const thr_frame *framework, const thr_cord *c, bool with_closure);

/* Turns of a cord that count: with THR_ENDS_CLOSED as many as passes (the last one closes it), else
 * one less. Turn k goes from pass k to pass k + 1 (or 0). */
int thr_cord_turns(const thr_request *wishes, const thr_cord *c);

/* Tells whether it does not matter where the cord starts: of a closed one, where its ends may be
 * anywhere and tie nothing. Unless symmetry.retraced says otherwise, as in older plans, it matters
 * with ends of any kind where the cord would turn back. */
bool thr_cord_runs_round(const thr_plan *plan, const thr_cord *c);

/* Is a turn sharper than angle (both in rad), by more than 1e-9? */
bool thr_turn_over(double turn, double angle);

/* Turns of all cords that are sharper than angle (rad). */
int thr_plan_turns_over(const thr_plan *plan, double angle);

/* Price of turns, k of them, between consecutive half-edges half[0], half[1], .. of n; turn n - 1
 * leads back to the first. */
double thr_turns_price(const thr_frame *framework, thr_turn_cost cost, const int *half, int n,
                       int k);

/* Price of the turns of a cord. */
double thr_cord_price(const thr_frame *framework, const thr_request *wishes, const thr_cord *c);

/* Turning that a pull has to overcome at the end that needs more, both being pulled, rad: the
 * larger part of the cord's, parted at the turn where that is least (graph/plan/least_pull.c; a
 * closed cord's last turn is at its ends and counts for neither part); and the largest of several
 * cords. By the capstan law the pull is exp(mu x that) times the seating tension. O(passes).
 * Example: turns of 30, 90 and 60 degrees are parted at the 90, and 60 are left to the end. */
double thr_cord_pulled_turning(const thr_frame *framework, const thr_cord *cord);
double thr_cords_pulled_turning(const thr_frame *framework, const thr_cord *cord, int n);

/* The same of several cords; *other: what the other end of that cord, the first of several, has to
 * overcome then. */
double thr_cords_pulled_turnings(const thr_frame *framework, const thr_cord *cord, int n,
                                 double *other);

/* Do all cords need no more than options.max_pull? */
bool thr_cords_within_pull(const thr_frame *framework, const thr_request *wishes,
                           const thr_cord *cord, int n);

/* only[n_edges] receives the number of the one cord over each edge: what holds there until that
 * cord is cut. -1 where there are several cords, or none. O(passes). */
void thr_cords_only(const thr_frame *framework, const thr_cord *cord, int n, int *only);

/* Computes metrics from frame, options (cover, ends) and cords alone. */
thr_status thr_plan_measure(const thr_frame *framework, const thr_request *wishes,
                            const thr_cord *cord, int n_cords, thr_metrics *m,
                            thr_err *err) THR_MUST_CHECK;

/* By how much what the plan was to have least of first (the longest cord, length, turning) may be
 * above the least possible, as a part of that: 0 = it is proved to be least; INFINITY: nothing is
 * proved of it, as of symmetric plans. */
double thr_plan_gap(const thr_plan *plan);

/* JSON of a plan; and back. Errors are "name: place: what": THR_EINPUT for what is not a plan at
 * all, THR_EVIOLATED for cords, metrics and proofs that contradict the framework (a pass whose edge
 * does not join its two nodes). */
void thr_plan_write(const thr_plan *plan, thr_text *out);
thr_status thr_plan_read(thr_plan *plan, const char *path, thr_err *err) THR_MUST_CHECK;
thr_status thr_plan_parse(thr_plan *plan, const char *text, size_t n, const char *name,
                          thr_err *err) THR_MUST_CHECK;

/* Reads a plan as thr_plan_parse does, but passes over some of its claims, as if they were not
 * there. claims: a sum of these. */
enum {
  THR_CLAIM_TURNING = 1,
  THR_CLAIM_PULL = 2,
  THR_CLAIM_CORDS = 4,
  THR_CLAIM_LENGTH = 8,
  THR_CLAIMS_ALL = 15
};
thr_status thr_plan_parse_without(thr_plan *plan, const char *text, size_t n, const char *name,
                                  int claims, thr_err *err) THR_MUST_CHECK;

/* Reads back what thr_plan_write wrote of the plan, and puts it in the plan's place: all is read as
 * by thr_plan_parse, but the framework is not built again. Every number and name of it in the text
 * is compared with the plan's, which thr_draft_build made; a difference is THR_EINPUT. On failure
 * plan is empty. */
thr_status thr_plan_parse_back(thr_plan *plan, const char *text, size_t n, const char *name,
                               thr_err *err) THR_MUST_CHECK;

/* ---- What is done to the cords after threading, in order: pulled, gripped on the way, let down,
 * knotted. The tensions that a schedule leaves in every pass follow from it (eval/cord/history.c),
 * and the checker computes them again.
 *
 *   A: grip 37 18.5 from start   is drawn out at its pass 37, from the side of its start, by 18.5 N
 *   A: pull end 20               its end is pulled with 20 N, and held
 *   A: release end 2             its end is let down to 2 N
 *   A: knot end 0.5              its end is tied; the knot gives way by 0.5 mm
 *   B: none                      stays slack: its only step */

const char *thr_deed_name(int deed); /* "pull", "grip", "release", "knot", "none" */

/* Adds a step; THR_ENOMEM. */
thr_status thr_schedule_add(thr_schedule *schedule, const thr_schedule_step *step,
                            thr_err *err) THR_MUST_CHECK;
void thr_schedule_destroy(thr_schedule *schedule);

/* The largest force, N, that a hand pulls cord i with, or all cords (i < 0). 0 if it never does. */
double thr_schedule_hardest(const thr_schedule *schedule, int i);
int thr_schedule_steps(const thr_schedule *schedule, int i); /* of cord i */
bool thr_schedule_slack(const thr_schedule *schedule,
                        int i); /* Does it leave cord i slack on purpose? */
int thr_schedule_grips(const thr_schedule *schedule, int i); /* of cord i, or of all (i < 0) */
int thr_schedule_pulls(const thr_schedule *schedule); /* grips too; both ends at once are one */

/* Returns whether both ends of cord i are knotted at last: nothing that is done to either end comes
 * after its knot. */
bool thr_schedule_knotted(const thr_schedule *schedule, int i);

/* Text as above: "CORD: pull|release END N", "CORD: grip PASS N [from END]", "CORD: knot END [MM]",
 * "CORD: none"; END is start, end or both; CORD an id of the plan's, or "all"; PASS counts from 1
 * as in steps.txt, or is the names of the two nodes of an edge that the cord passes once. Steps end
 * with a line or a semicolon; # begins a comment. THR_EINPUT with name and line: what is wrong, and
 * what is expected. O(text x passes). Release with thr_schedule_destroy, also after a failure. */
thr_status thr_schedule_parse(thr_schedule *schedule, const thr_plan *plan, const char *text,
                              size_t n, const char *name, thr_err *err) THR_MUST_CHECK;

/* A step in the words of that text; for grips with the nodes on both sides in brackets. */
void thr_schedule_put_step(const thr_plan *plan, const thr_schedule_step *step, thr_text *text);

/* The member "schedule" of an evaluation, and reading it: shapes and ranges are checked against
 * n_cords; passes by the checker.
 */
void thr_schedule_write(const thr_schedule *schedule, thr_writer *writer, const char *key);
thr_status thr_schedule_from_json(thr_schedule *schedule, const thr_json *array, int n_cords,
                                  const char *place, thr_err *err) THR_MUST_CHECK;

#endif
