/* The threading plan: the small vocabulary through which all stages meet. An objective makes one, the checker,
 * eval, compare and draw read it. docs/plan-format.md is the schema of its JSON. */
#ifndef THR_PLAN_H
#define THR_PLAN_H

#include "graph/evaluation.h"
#include "graph/turning_proof.h"

typedef enum { THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES } thr_ends;

typedef enum { THR_LENGTH, THR_TORTUOSITY, THR_SYMMETRY, THR_N_OBJECTIVES } thr_objective;

/* How the cords of a plan for the least turning are found. */
typedef enum {
  THR_TOUR_LEAST,  /* extra passes, ends and pairings chosen together */
  THR_TOUR_FLEURY, /* the classical tours through the shortest passes, to compare with */
  THR_TOUR_HIERHOLZER,
  THR_N_TOURS
} thr_tour;

/* What is asked for beside THR_TORTUOSITY. */
typedef struct {
  thr_turn_cost cost;
  double length_slack; /* cord allowed above the shortest, as a part of it; < 0 = any length */
  bool largest;        /* minimize the turning of the cord that turns most, not of all together */
  thr_tour tour;
  bool ignore_pairings; /* of the classical tours: edges in their order instead of the cheapest pairing of every node */
} thr_turning_options;

/* What a symmetric plan can have little of. */
typedef enum { THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING, THR_N_AIMS } thr_aim;

/* What is asked for beside THR_SYMMETRY. */
typedef struct {
  char group[16];             /* row of `thread symmetries` or name of a point group; "" = the default choice */
  double geometric;           /* isometries within this tolerance only; < 0 = any automorphism */
  thr_aim prefer[THR_N_AIMS]; /* what is minimized first, second, .. */
} thr_symmetry_options;

/* What the user asked for; echoed in the plan so that it can be made again. */
typedef struct {
  thr_objective objective;
  int cover;                     /* every edge gets at least this many passes, 1 .. 100 */
  int cords;                     /* in every component, 1 .. 1000; THR_LENGTH: 1; THR_SYMMETRY: the most in any, as it came out */
  thr_turning_options turning;   /* THR_TORTUOSITY only */
  thr_symmetry_options symmetry; /* THR_SYMMETRY only */
  thr_ends ends;
  bool *end_node;      /* [n_nodes] THR_ENDS_NODES only: where ends may be; owned, else NULL */
  thr_physics physics; /* of cord and beads, as asked: what eval starts from */
  double time_limit;   /* s, 0 = none */
} thr_plan_options;

/* A cord: consecutive half-edges; half[i] arrives where half[i + 1] leaves. A closed cord also ends where it starts. */
typedef struct {
  char id[12];   /* "A", "B", .. "Z", "AA", .. */
  int component; /* of the framework, numbered by lowest node */
  bool closed;   /* both ends at one node */
  int n_passes;  /* >= 1 */
  int *half;     /* [n_passes] owned */
} thr_cord;

/* One odd cut: the edges leaving a node set that holds an odd number of odd nodes. value is its dual multiplier in
 * units of 1/denominator. Nodes >= n_nodes of the framework are slots (see thr_certificate). */
typedef struct {
  int n_nodes;
  int *node;     /* ascending; owned */
  int64_t value; /* >= 0 */
} thr_cut;

/* Proof of a lower bound on the extra cord of one component (Edmonds & Johnson 1973): a packing of odd cuts.
 * Edge e weighs w_e = round(length_e * scale). With ends allowed at nodes F there are two more odd nodes per cord, the slots
 * n_nodes, n_nodes + 1, .., each joined to every node of F in the component by an edge of weight slot_cost, and to
 * each other by edges of 2 * slot_cost: a set of passes that leaves so many open cords is then a T-join of that graph.
 * If the cuts' values load no edge beyond w_e * denominator, no join is shorter than sum(value) / denominator. */
typedef struct {
  int component;
  double scale;        /* integer weight per unit of length, > 0 */
  int64_t denominator; /* > 0 */
  int n_slots;         /* 0 (closed) or 2 * options.cords; a plan may have fewer cords: its other slots are joined in pairs */
  int64_t slot_cost;
  int64_t join; /* weight of the extra passes of the plan, without slots */
  int64_t sum;  /* of the cuts' values */
  int n_cuts;
  thr_cut *cut; /* owned */
} thr_certificate;

typedef struct {
  bool present;
  bool optimal;       /* proved: the checker agrees, or it says violation */
  double lower_bound; /* no plan with these options is shorter, in units of length */
  double gap;         /* (length - lower_bound) / length */
  int n_certificates;
  thr_certificate *certificate; /* one per component; owned */
} thr_length_proof;

/* What is proved about the turning of a plan for THR_TORTUOSITY: of no plan with the same options, U-turns at nodes with one edge
 * only, at most most_passes over any edge and no more cord than length_limit are all turns together cheaper than lower_bound. */
typedef struct {
  bool present;
  bool optimal;         /* proved: the checker agrees, or it says violation */
  double price;         /* of all turns, as options.turning.cost prices them; THR_TURN_ANGLE: = metrics.turning */
  double lower_bound;   /* what the tree proves */
  double gap;           /* (price - lower_bound) / price, 0 if price is 0 */
  double pairing_bound; /* sum over the nodes of the cheapest pairing of the passes and ends there, each node on its own */
  double largest;       /* price of the cord that turns most */
  double largest_bound; /* no plan of the same kind has less: lower_bound shared out evenly */
  bool largest_optimal;
  int most_passes;
  double length_limit; /* in units; < 0 = none */
  thr_turning_proof tree;
} thr_turning_claim;

/* How the cords of a plan for THR_SYMMETRY are copies of a few unique paths under a group of automorphisms. Cords are compared by
 * the nodes that they run through: of two alike one is a copy of the other, by the identity if need be. */
typedef struct {
  bool present;
  int order;        /* of the group, 1 .. 1024 */
  char name[16];    /* its point group (Schoenflies), or "" if it is a group of the graph only */
  int n_generators; /* of the group, as images of the nodes */
  int *generator;   /* [n_generators * n_nodes] owned */
  int n_images;     /* elements that map unique paths to copies; image 0 is the identity */
  int *image;       /* [n_images * n_nodes] owned */
  int *unique;      /* [n_cords] the cord that this one is a copy of; itself for a unique path; owned */
  int *element;     /* [n_cords] image that maps that one to this, perhaps reversed, and a closed one perhaps from another start;
                       owned */
  double steps;     /* learned: passes of each unique path over the number of ways (from another start, reversed) in which it is
                       its own image under the group */
  int unique_paths; /* number of different values of unique */
} thr_symmetry_record;

void thr_symmetry_record_destroy(thr_symmetry_record *r);

typedef struct {
  double length;      /* of all cords, in units */
  double base_length; /* cover * sum of edge lengths */
  double overlap;     /* length - base_length */
  int passes;         /* of all cords */
  int most_passes;    /* on one edge */
  double turning;     /* sum of turning angles over all cords, rad; with THR_ENDS_CLOSED also the turn where a cord closes */
  double max_turning; /* of the cord that turns most, rad */
  double worst_turn;  /* sharpest single turn, rad */
  int u_turns;        /* turns from an edge back into the same edge */
} thr_metrics;

typedef struct {
  thr_frame frame;
  thr_plan_options options;
  char *generator; /* versions of program and libraries, one line; owned */
  int n_cords;
  thr_cord *cord; /* owned */
  thr_metrics metrics;
  thr_symmetry_record symmetry; /* present with THR_SYMMETRY */
  thr_evaluation evaluation;    /* of `thread eval`, if present */
  thr_length_proof proof;
  thr_turning_claim turning;
} thr_plan;

/* "length", "tortuosity", "symmetry"; "least", "fleury", "hierholzer"; "overlap", "steps", "paths", "turning". */
const char *thr_objective_name(thr_objective o);
const char *thr_tour_name(thr_tour t);
const char *thr_aim_name(thr_aim a);

thr_plan_options thr_plan_options_default(void);
void thr_plan_destroy(thr_plan *p);
void thr_cords_destroy(thr_cord *cord, int n); /* cord[n] and their half arrays; NULL ok */

/* Copies framework and options into an empty plan. */
thr_status thr_plan_request(thr_plan *p, const thr_frame *f, const thr_plan_options *o, thr_err *err) THR_MUST_CHECK;
void thr_cord_id(int i, char id[12]); /* 0 -> "A", 25 -> "Z", 26 -> "AA" */
void thr_certificate_destroy(thr_certificate *c);

int thr_length_proof_cuts(const thr_length_proof *proof); /* odd cuts of all its certificates */

const char *thr_ends_name(thr_ends e); /* "closed", "any", "feet", "nodes" */
bool thr_plan_end_allowed(const thr_frame *f, const thr_plan_options *o, int v);

/* First and last node of a cord (equal for a closed one). */
int thr_cord_start(const thr_frame *f, const thr_cord *c);
int thr_cord_end(const thr_frame *f, const thr_cord *c);
double thr_cord_length(const thr_frame *f, const thr_cord *c);

/* Turning angle in rad between arriving over half-edge in and leaving over half-edge out (head(in) = tail(out)):
 * 0 = straight on, pi = U-turn. */
double thr_turn_angle(const thr_frame *f, int in, int out);

/* Sum of the turning angles inside a cord, rad; with_closure adds the turn between a closed cord's last and first pass. */
double thr_cord_turning(const thr_frame *f, const thr_cord *c, bool with_closure);

/* Turns of a cord that count: with THR_ENDS_CLOSED as many as passes (the last one closes it), else one less. Turn k goes from
 * pass k to pass k + 1 (or 0). */
int thr_cord_turns(const thr_plan_options *o, const thr_cord *c);

/* Is a turn sharper than angle (both in rad), by more than 1e-9? */
bool thr_turn_over(double turn, double angle);

/* Turns of all cords that are sharper than angle (rad). */
int thr_plan_turns_over(const thr_plan *p, double angle);

/* Price of the turns of a cord. */
double thr_cord_price(const thr_frame *f, const thr_plan_options *o, const thr_cord *c);

/* Computes metrics from frame, options (cover, ends) and cords alone. */
thr_status thr_plan_measure(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_metrics *m,
                            thr_err *err) THR_MUST_CHECK;

/* JSON of a plan; and back. Errors are "name: place: what": THR_EINPUT for what is not a plan at all, THR_EVIOLATED for
 * cords, metrics and proofs that contradict the framework (a pass whose edge does not join its two nodes). */
void thr_plan_write(const thr_plan *p, thr_text *out);
thr_status thr_plan_read(thr_plan *p, const char *path, thr_err *err) THR_MUST_CHECK;
thr_status thr_plan_parse(thr_plan *p, const char *text, size_t n, const char *name, thr_err *err) THR_MUST_CHECK;

#endif
