/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is asked of a plan: aims in their order, ends, joints, limits, physics. Everything that the
 * user may wish is a field of thr_request, which the plan keeps. */
#ifndef THR_REQUEST_H
#define THR_REQUEST_H

#include "graph/plan/physics.h"
#include "graph/plan/turning_proof.h"
#include "graph/text.h"

#include <limits.h>

/* ---- request.c: The request: what a plan is asked to be, and what it is to have little of, first,
 * second, ... */

enum { THR_MOST_CORDS = 1000 }; /* that a plan may have in a component */

/* THR_ENDS_COUNTS: at every node exactly so many cord ends. */
typedef enum {
  THR_ENDS_CLOSED,
  THR_ENDS_ANY,
  THR_ENDS_FEET,
  THR_ENDS_NODES,
  THR_ENDS_COUNTS
} thr_ends;

/* Solid: a node bead is one rigid piece, any pairing locks it. Tube: only edges are beads, and the
 * cord itself ties them together: at every node the graph of the edges there and of the turns
 * between them is connected, and no cord turns back into its edge (Demaine, Kirkpatrick & Lin
 * 2024). */
typedef enum { THR_JOINT_SOLID, THR_JOINT_TUBE } thr_joint;

/* What a plan can have little of, by the names in brackets. */
typedef enum {
  THR_AIM_OVERLAP, /* cord beyond what the edges need [overlap]: length, but for a constant */
  THR_AIM_STEPS,   /* what is to be learned of cords that are copies of each other [steps] */
  THR_AIM_PATHS,   /* cords of which the others are copies [paths] */
  THR_AIM_TURNING, /* of all cords [turning] */
  THR_N_AIMS,      /* of a symmetric plan: those above */
  THR_AIM_LENGTH = THR_N_AIMS, /* of all cords [length] */
  THR_AIM_LONGEST,             /* length of the longest cord [longest] */
  THR_AIM_MAX_TURNING,         /* of the cord that turns most [max-turning] */
  THR_AIM_PULL,                /* what an end of the cord that is hardest to pull has to overcome
                                  (thr_cord_pulled_turning) [pull] */
  THR_ALL_AIMS
} thr_aim;

/* What is minimized first, second, ... Which plan that is follows: with steps or paths a symmetric
 * one (THR_SYMMETRY), which has all THR_N_AIMS in some order, and perhaps the longest cord before
 * them; else with turning or max-turning one that turns little (THR_TORTUOSITY); else a short one
 * (THR_LENGTH), its length being the last aim if no other place is said. {0} is the least length.
 */
typedef struct {
  int n;
  thr_aim aim[THR_ALL_AIMS];
} thr_aims;

typedef enum { THR_LENGTH, THR_TORTUOSITY, THR_SYMMETRY, THR_N_OBJECTIVES } thr_objective;

/* How the cords of a plan for the least turning are found. */
typedef enum {
  THR_TOUR_LEAST,  /* extra passes, ends and pairings chosen together */
  THR_TOUR_FLEURY, /* the classical tours through the shortest passes, to compare with */
  THR_TOUR_HIERHOLZER,
  THR_N_TOURS
} thr_tour;

/* How a classical tour goes on at a node: by the cheapest pairing of its passes, or to the next
 * edge in the framework's order. */
typedef enum { THR_PAIRINGS_KEEP, THR_PAIRINGS_IGNORE } thr_pairings;

/* What is asked for of a plan that turns little. */
typedef struct {
  thr_turn_cost cost;
  double length_slack; /* cord allowed above the shortest, as a part of it; < 0 = any length */
  thr_tour tour;
  thr_pairings pairings; /* of the classical tours */
  int nodes; /* of the search's tree at most, which ends it at the same place on any machine; 0 =
                any number */
} thr_turning_options;

/* What is asked for of a symmetric plan. */
typedef struct {
  char group[16]; /* row of `thread symmetries` or name of a point group; "" = the default choice */
  double geometric; /* isometries within this tolerance only; < 0 = any automorphism */
  bool counted;    /* cords and cords_least are asked for, as of other plans; otherwise there are as
                      many as there are */
  double row_work; /* counted work (thr_limits_spend) for each row, which then ends by nothing else;
                      0 = by the time */
} thr_symmetry_options;

/* Which engine finds the shortest passes (lp/tjoin/engine.c). */
typedef enum {
  THR_ENGINE_AUTO, /* matching, unless the weights are more than it takes */
  THR_ENGINE_LP,   /* odd cuts, GLPK */
  THR_ENGINE_MATCHING
} thr_engine;

/* Whether GLPK's exact method is asked for the same minimum, too. */
typedef enum {
  THR_CONFIRM_AUTO,   /* of problems of moderate size, for a second at most (lp/tjoin/engine.c) */
  THR_CONFIRM_ALWAYS, /* whatever it takes, within the time limit */
  THR_CONFIRM_NEVER
} thr_confirm;

/* How what is threaded is to hold together while it is threaded (planner/order.c): not looked at,
 * cords stay as they were found; by where they begin, which way they run and which comes first, and
 * in short plans by what that takes, a twentieth more turning at most; or whatever a tenth more
 * turning serves for. */
typedef enum { THR_ORDER_PLANNED, THR_ORDER_STARTS, THR_ORDER_HAND, THR_N_ORDERS } thr_order;

/* Channels that cross inside solid pieces (graph/plan/channels.c): as it comes; fewer, where passes
 * can go on otherwise at equal length and, of a plan for little turning, at equal turning; or none
 * (planner/uncross.c). */
typedef enum {
  THR_CROSSINGS_ALLOW,
  THR_CROSSINGS_PRICE,
  THR_CROSSINGS_FORBID,
  THR_N_CROSSINGS
} thr_crossings;

/* What the user asked for; echoed in the plan so that it can be made again. */
typedef struct {
  thr_aims aims;
  thr_joint joint;
  int cover; /* every edge gets at least this many passes, 1 .. 100; the framework may ask for more
                (cover) */
  int capacity; /* at most so many passes of any edge, 0 = no limit; the framework may allow fewer
                   (capacity) */
  int distinct; /* every edge is passed by at least so many different cords, at most cover and
                   cords_least; 0 = any */
  int cords;    /* at most so many in every component, 1 .. 1000; of a symmetric plan for which they
                   are not asked    (symmetry.counted): the most in any, as it came out */
  int cords_least;   /* at least so many; = cords: exactly */
  double max_length; /* no cord is longer, in units; 0 = no limit */
  double max_pull;   /* pulled at both ends, no cord needs more at either (thr_cord_pull): times the
                        seating tension,
                        >= 1; 0 = no limit */
  bool old_pull; /* of a plan of version 1, which parts cords at a pass, that both ends reach, and
                    not at a turn */
  thr_turning_options turning;   /* of plans that turn little only */
  thr_symmetry_options symmetry; /* of symmetric plans only */
  thr_ends ends;
  bool *end_node; /* [n_nodes] THR_ENDS_NODES only: where ends may be; owned, else NULL */
  int *end_count; /* [n_nodes] THR_ENDS_COUNTS only: how many ends there are, their sum in every
                     component even and at most 2 * cords; owned, else NULL */
  thr_physics physics; /* of cord and beads, as asked: what eval starts from */
  double time_limit;   /* s, 0 = none */
  double gap; /* %, 0 to 100: a search may end when plan and bound are so near; < 0: not said
                 (thr_request_gap) */
  thr_crossings
      crossings;   /* solid joints; not of symmetric plans, classical tours or with max_pull */
  thr_order order; /* of the work */
  int needles; /* that cords are threaded with then: 1, 2, or 0: as is usual (thr_cord_folded) */
  thr_engine engine;   /* changes no length */
  thr_confirm confirm; /* of the least length with THR_JOINT_SOLID only */
} thr_request;

thr_request thr_request_default(void);

/* ---- aims ---- */

extern const thr_aims thr_aims_shortest, thr_aims_straightest; /* length; turning */
extern const thr_aims thr_aims_symmetric; /* in the usual order: overlap, steps, paths, turning */
thr_aims thr_aims_of(thr_objective objective); /* one of these */

thr_objective thr_aims_objective(const thr_request *options);

/* What the aims come to, for those who plan, check or print. */
bool thr_wants_length(const thr_request *options);   /* a short plan, and neither of the next two */
bool thr_wants_turning(const thr_request *options);  /* one that turns little */
bool thr_wants_symmetry(const thr_request *options); /* a symmetric one */
bool thr_wants_balance(const thr_request *options);  /* a short longest cord */
bool thr_wants_largest(const thr_request *options);  /* that the cord that turns most turns little,
                                                        or is pulled easily */
bool thr_wants_pull(const thr_request *options);     /* the latter */

/* Passes over any edge up to which several cords are looked for: thr_turning_most_passes, and where
 * cords end at some nodes only at least 2 * cords, for all of them pass the few edges that lead
 * there. Example: an arch on two feet with one edge at each; every cord from foot to foot passes
 * both edges. O(edges). */
int thr_request_most_passes(const thr_frame *frame, const thr_request *options);

/* Returns what a request asks the least turning among, with any number of passes up to
 * thr_turning_most_passes and any length. Whatever a request says of turns, ends and passes enters
 * here, and the searches and their checks only narrow it. end_allowed: [n_nodes] filled (or NULL,
 * of closed cords only), and borrowed by the task, as the request is. O(nodes + edges). */
thr_turning_task thr_turning_task_of(const thr_frame *frame, const thr_request *request,
                                     bool *end_allowed);

/* The order of a symmetric plan's aims; the usual one where the aims name none of them. */
void thr_aims_order(const thr_request *options, thr_aim order[THR_N_AIMS]);

/* Reads a list of aims with commas: their names above; "length+5%" before turning or max-turning:
 * at most so much above the least length (also "length" alone: none); "turning:sine",
 * "max-turning:step": what a turn costs. The list says all: what of aims, length_slack and cost it
 * leaves out becomes the default. THR_EINPUT: words that are no aims, or that do not go together.
 * On failure options is unchanged. */
thr_status thr_aims_parse(const char *text, thr_request *options, thr_err *err) THR_MUST_CHECK;

/* Reads a percentage from 0 to 1e6, "5" or "5%", as a part of 1. False: it is none. */
bool thr_slack_parse(const char *text, double *slack);

/* ---- the rest ---- */

/* What options and plans call the values of an enumeration, or of a yes or no:
 * "length", "tortuosity", "symmetry"; "least", "fleury", "hierholzer"; "overlap", "steps", .. */
const char *thr_objective_name(int o);
const char *thr_tour_name(int t);
const char *thr_aim_name(int a);
const char *thr_minimize_name(int i); /* of thr_minimize_aim: "turning", "max-turning", "pull" */
thr_aim thr_minimize_aim(int i);      /* i < THR_N_MINIMIZE */
const char *thr_largest_name(const thr_request *options); /* "the largest turning of a cord", or
                                                             with pull what an end overcomes */
enum { THR_N_MINIMIZE = 3 };
const char *thr_pairings_name(int p);  /* "keep", "ignore" */
const char *thr_ends_name(int e);      /* "closed", "any", "feet", "nodes", "counts" */
const char *thr_joint_name(int j);     /* "solid", "tube" */
const char *thr_crossings_name(int c); /* "allow", "price", "forbid" */
const char *thr_order_name(int o);     /* "planned", "starts", "hand" */
const char *thr_engine_name(int e);    /* "auto", "lp", "matching" */
const char *thr_confirm_name(int c);   /* "auto", "always", "never" */

/* How near plan and bound may be for a search to end, as a part of the bound: what was asked for,
 * else 0 of a short plan and a hundredth of others. */
double thr_request_gap(const thr_request *options);

/* Is the cord within the asked part above the least length (options.turning.length_slack), by this
 * lower bound on that? True where none was asked for. */
bool thr_plan_within_slack(const thr_request *options, double length, double least);

bool thr_plan_end_allowed(const thr_frame *frame, const thr_request *options, int v);

/* Is the number of cords asked for? Of a symmetric plan it may be what it came to. */
bool thr_plan_counted(const thr_request *options);

/* Returns whether few cords are asked for before little length. Then length is compared with that
 * of as many cords as a plan has.
 */
bool thr_plan_fewest_first(const thr_request *options);

/* Cords that every component has at least. Where they are not asked for, options.cords is the most
 * in any, and the others may have fewer: 1. */
int thr_plan_cords_least(const thr_request *options);

/* What an end of a cord may have to overcome within max_pull (thr_cord_pulled_turning), rad:
 * ln(max_pull) / mu. INFINITY: anything, without a limit or without friction. Example: 15 times the
 * seating tension at mu = 0.2: 13.54 rad. */
double thr_request_most_pulled(const thr_request *options);

/* By how much a cord may turn between its ends then: by so much from each of them, and by the turn
 * that neither slides over, which is 180 degrees at most. Example: 15 times the seating tension at
 * mu = 0.2: 30.22 rad. */
double thr_request_most_turning(const thr_request *options);

/* Does every cord pass every edge, because there are no more cords than distinct asks for? Then
 * each may be planned by itself, once over every edge, and all of them are alike: *one is that
 * request, whose arrays are borrowed. True of solid joints, if no edge needs more passes, none has
 * a capacity, the numbers of ends are free, and no symmetric plan is asked for. */
bool thr_request_alike(const thr_frame *frame, const thr_request *options, thr_request *one);

/* Passes that edge e needs, and the most that it may have (INT_MAX: no limit): what options and
 * framework say together. */
static inline int thr_plan_cover(const thr_frame *frame, const thr_request *options, int e)
{
  return frame->cover && frame->cover[e] > options->cover ? frame->cover[e] : options->cover;
}
static inline int thr_plan_capacity(const thr_frame *frame, const thr_request *options, int e)
{
  int own = frame->capacity && frame->capacity[e] > 0 ? frame->capacity[e] : INT_MAX;
  return options->capacity > 0 && options->capacity < own ? options->capacity : own;
}

/* Limits the capacity to what goes through the bore, if the diameters of cord and bore are both
 * given. Symmetric plans are not limited so. THR_EINFEASIBLE: the cover needs more. */
thr_status thr_request_fit_bore(thr_request *request, thr_err *err) THR_MUST_CHECK;

/* ---- distinct_needs.c: Passes that edges need where several different cords are to pass each of
 * them. */

/* *needs: [n_edges] passes that every edge has in a plan of these options whose edges all have
 * their different cords; NULL where that is no more than thr_plan_cover says, and of symmetric
 * plans, whose proof of length is about any cords. Owned by the caller. O(nodes + edges). */
thr_status thr_distinct_needs(const thr_frame *frame, const thr_request *options, int **needs,
                              thr_err *err) THR_MUST_CHECK;

#endif
