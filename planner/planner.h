/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes plans from requests: the planners by objective, the choice among them, and advice.
 *
 * This folder is where the searches of lp/, tortuosity/ and symmetry/ become plans with proofs. A
 * planner fills a plan for one kind of request; what a request asks beyond that is composed of
 * several calls of other planners.
 *
 * Read make_plan.c first, the way of every plan, and dispatch.c, the choice of the planner and the
 * shares of the time; then the planners: length.c with short_few.c and even_length.c,
 * least_turning.c with even_turning.c and mixed.c, symmetric.c, distinct.c, and pull_limit.c with
 * the other files pull_*.c. Afterwards come the steps that serve every plan: trim.c, uncross.c with
 * recut.c and channel_search.c, order.c with starts.c and order_reverse.c, and prove.c. recommend.c
 * chooses where nobody says which plan; advise.c and rivals.c make many plans and compare them. */
#ifndef THR_PLANNER_H
#define THR_PLANNER_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lp/length/postman.h"
#include "symmetry/symmetry.h"

/* ---- make_plan.c: One way to make a plan: what is wanted goes in, a plan with its proofs comes
 * out (planner/dispatch.c says who plans it). */

/* What was found out beside the plan. */
typedef struct {
  thr_cords_word word; /* what a solver says of the cords and the checker cannot verify */
  thr_plan shortest; /* beside the least turning: the cords of the least length, proved; empty where
                        they were not needed */
  thr_symmetries symmetries; /* of a symmetric plan: the groups and their threadings, without the
                                cords that the plan has taken */
} thr_report;

void thr_report_destroy(thr_report *report);

/* Plans what is requested within the limits, which are all that bounds the time:
 * request->time_limit is only recorded. The plan's claims are what graph/check/check.c says of its
 * proofs. limits->found hears of cords as soon as there are some. report: NULL = not wanted.
 * THR_OK: what was to be least is proved to be, or as near to its bound as was asked
 * (thr_request_gap); where neither that nor a time was asked for (limits->usual) any plan but one
 * for the least length will do. THR_ELIMIT: the plan is valid and holds its bounds, or it is empty
 * because no cords were found in time. THR_EINFEASIBLE: there is no plan, or none was found (said).
 * THR_EINPUT: wishes that do not go together (said). Otherwise the plan is empty; the report must
 * be released in any case. */
thr_status thr_plan_make(const thr_frame *frame, const thr_request *request,
                         const thr_limits *limits, thr_plan *plan, thr_report *report,
                         thr_err *err) THR_MUST_CHECK;

/* Do the searches for a request tell limits->progress bounds of what is asked? They tell those of
 * the turning of all cords of a component together, and of extra cord. Where something else is
 * asked, as that the cord that turns most turns little, these bounds are of other questions, and
 * may be above the plan. */
thr_status thr_plan_tells_bounds(const thr_frame *frame, const thr_request *request, bool *tells,
                                 thr_err *err) THR_MUST_CHECK;

/* What the name of one of the THR_CLAIM_ .. is in sentences. */
const char *thr_claim_name(int claim);

/* Reads back the text of a plan that was just written, which takes the plan's place, and checks the
 * whole of it, as `thread check` does. Of claims that do not hold as few as may be are dropped;
 * *dropped receives their sum, 0: all hold. Then the text is written anew, and err says what the
 * check said first. name: of the file, for messages. THR_ESOLVER: the plan is broken without any
 * claim, too; it is then empty. */
thr_status thr_plan_confirm(thr_plan *plan, thr_text *text, const char *name, int *dropped,
                            thr_err *err) THR_MUST_CHECK;

/* ---- dispatch.c: Who plans what, and how the time is shared out: both tables are in
 * planner/dispatch.c. */

/* A planner: fills an empty plan and an empty report, with the statuses of thr_plan_make. */
typedef thr_status thr_planner(const thr_frame *f, const thr_request *o, const thr_limits *limits,
                               thr_plan *plan, thr_report *report, thr_err *err);

/* The name of the i-th of THR_N_OBJECTIVES, in the order in which a user reads them, and which it
 * is. */
const char *thr_dispatch_name(int i);
thr_objective thr_dispatch_objective(int i);

/* The planner of what is asked: of the objective, but of different cords and of cords within a
 * limit on the pull those that ask the objective's planner for more than one plan. A symmetric plan
 * keeps to both itself. */
thr_planner *thr_dispatch(const thr_request *options);

/* Steps of a plan that have a part of the time to themselves, of what is left when their turn
 * comes. */
typedef enum {
  THR_STEP_FIRST,
  THR_STEP_TIED,
  THR_STEP_SEED,
  THR_STEP_ONE_CORD,
  THR_STEP_SHORTEST,
  THR_STEP_BY_LENGTH,
  THR_STEP_LEAST,
  THR_STEP_EXCHANGES,
  THR_STEP_EVEN_SEED,
  THR_STEP_FEWEST,
  THR_STEP_FEW_BOUND,
  THR_STEP_FEW_WALKS,
  THR_STEP_FEW_TRY,
  THR_STEP_FEW_ANNEAL,
  THR_STEP_SYMMETRIC_FEWER,
  THR_STEP_SYMMETRIC_TIED,
  THR_STEP_ANY_CORDS,
  THR_STEP_COVERS,
  THR_STEP_DIFFERENT,
  THR_N_STEPS
} thr_step;

thr_limits thr_dispatch_share(const thr_limits *limits, thr_step step);

/* Seconds for a plan if nobody says how many; 0 = any time. */
double thr_dispatch_usual_seconds(const thr_request *options);

/* Work that may be done, counted (graph/limits.h), for a plan of which nobody said how long it may
 * take: it is then the same on any machine. 0: the time by the clock is what counts. */
double thr_dispatch_work(const thr_request *options);

/* How many times as long it may take on a busy machine: where the planner counts its work, only
 * that ends it. */
double thr_dispatch_patience(const thr_request *options);

/* What of the seconds that everything may take is for the search: the rest is for checking and
 * writing, or for the plans that it is held against. Drawings have their own. */
double thr_dispatch_search_seconds(double seconds, bool compared);

/* ---- least_turning.c: Plans of the least turning: from the options of a plan to cords that turn
 * least, and what is proved of them (thesis, chapter 6; docs/method.md). */

/* Has the framework more passes than the search for the least turning takes? */
bool thr_tortuosity_too_large(const thr_frame *frame, const thr_request *options);

/* Makes a plan as options.turning says: extra passes, ends and pairings chosen together, or a
 * classical tour to compare with (which claims nothing about its turning). Among plans that turn
 * equally little it takes a short one if it finds it. The plan holds the proof of length
 * (graph/plan/plan.h, thr_length_proof) as well; with a length slack the limit is that part above
 * the shortest plan found for so many cords. Both claims are what graph/check/check.c says, never
 * what the solver hopes. THR_OK: what was to be minimized is proved optimal, or the tour is a
 * classical one. THR_ELIMIT: the plan is valid and holds its bound and gap. THR_EINFEASIBLE: no
 * node for a cord end in a component (named), or no plan within the limits on passes and length.
 * THR_EINPUT: options that do not go together (said). Otherwise the plan is empty. The aim
 * max-turning with max_pull: the search ends as soon as the cords keep to that, or cannot; they may
 * not, and the plan's options do not ask it of them. */
thr_status thr_tortuosity_plan(const thr_frame *frame, const thr_request *options,
                               const thr_limits *limits, thr_plan *plan,
                               thr_err *err) THR_MUST_CHECK;

/* The same with a second start for the aim max-turning: the cords of seed (NULL = none), another
 * plan of the framework, if they are as many in every component and keep to the options. A
 * symmetric plan may attain the bound at once (docs/method.md). */
thr_status thr_tortuosity_plan_from(const thr_frame *frame, const thr_request *options,
                                    const thr_plan *seed, const thr_limits *limits, thr_plan *plan,
                                    thr_err *err) THR_MUST_CHECK;

/* A plan of the trade-off between length and turning: nothing that is no longer turns less than
 * lower_bound. */
typedef struct {
  double length, overlap;      /* units */
  double price, lower_bound;   /* of all turns */
  const char *open;            /* why it is not proved; static text, NULL if it is */
  double turning, max_turning; /* rad */
  double pulled; /* rad, thr_cords_pulled_turning: what the hardest pull has to overcome */
} thr_frontier_point;

typedef struct {
  int n;
  thr_frontier_point *point; /* [n] owned; lengths ascend, prices descend: none is both longer and
                                dearer than another */
} thr_frontier;

/* From the least turning among the shortest to the least turning of any length, with at most `most`
 * points (>= 2), whose limits on the length are evenly spaced between the two. Each point gets an
 * equal share of the time. Where the frontier has few points (beads of equal length) all of them
 * may be found; a limit that no plan is found for is left out. THR_ELIMIT: some are not proved.
 * Release with thr_frontier_destroy. */
thr_status thr_tortuosity_frontier(const thr_frame *frame, const thr_request *options, int most,
                                   const thr_limits *limits, thr_frontier *out,
                                   thr_err *err) THR_MUST_CHECK;
void thr_frontier_destroy(thr_frontier *frontier);

/* ---- rivals.c: The plans that one of the least turning is held against. */

/* A plan that another is held against. */
typedef struct {
  const char *title, *key; /* of its column; of its JSON member */
  bool made;
  thr_plan plan;
  thr_err why; /* if it is not made */
} thr_rival;

typedef struct {
  thr_rival corner; /* the least turning among the shortest, or of any length; of a classical tour:
                       the least turning */
  thr_rival length; /* of the least length */
  thr_frontier frontier;
  thr_err no_frontier; /* why there is none although one was asked for; code 0 otherwise */
} thr_rivals;

/* Makes them within the limits (without a deadline the frontier has the time limit of the plan once
 * more): the shortest plan where it takes no search, or shortest, which is taken, unless it has no
 * cords; optima: that in any case, and the corner, which is a search as long as the plan's own; and
 * a frontier of that many points (0 = none). THR_OK also where there is no such plan (why says so);
 * on failure out holds what was made. Release with thr_rivals_destroy. */
thr_status thr_rivals_make(const thr_plan *p, thr_plan *shortest, bool optima, int frontier,
                           const thr_limits *limits, thr_rivals *out, thr_err *err) THR_MUST_CHECK;
void thr_rivals_destroy(thr_rivals *rivals);

/* ---- uncross.c: Channels that cross inside pieces, led otherwise. */

/* Where two channels of one cord cross in a node, from arm a to b and from c to d, the part of the
 * cord between them is run the other way round: they go from a to c and from b to d then, which do
 * not cross, through the same passes, and no other node has other channels. A third channel that
 * crosses one of the new ones, or both, crossed as many of the old ones, so that crossings become
 * fewer each time, and a plan of one cord in each component ends without any. Two cords that cross
 * there go on as each other, from a to d and from c to b, or from a to c and from b to d, whichever
 * leaves them more even: there are as many cords, as long together, with the same ends, and none of
 * those crossings either. Closed cords become one by that, which is cut again when nothing crosses
 * any longer (planner/recut.c). Different cords are led otherwise in short plans, and in any if no
 * crossing is allowed, as long as that keeps to max_length and distinct, and to balance where
 * crossings only have their price. Of several pairs those of one cord come first, and of these that
 * which takes least turning; in plans for little turning only where the turning stays the same,
 * unless no crossing is allowed: the claim of the turning is then to be made anew. Metrics are
 * measured again, and the claim of the longest cord is about the cords as they are now. Where that
 * leaves crossings that are forbidden, or cords that are longer, other cords are searched for
 * (planner/channel_search.c). *others: edges have other numbers of passes now, and what is proved
 * is to be proved again. options.crossings says whether it is asked for. Passes of cords are owned,
 * and others may take their place, as may plan->cord. THR_ELIMIT: none are allowed and some are
 * left (said how many), which does not prove that there is no such plan. O(crossings x passes). */
thr_status thr_plan_uncross(thr_plan *plan, bool *others, thr_err *err) THR_MUST_CHECK;

/* metrics.crossings, if the request asks for anything but any number of them. O(n log n). */
thr_status thr_plan_count_crossings(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* ---- recommend.c: The plan where nobody says which. */

typedef struct {
  double hand;     /* N: what an end of a cord may need */
  bool ends_given; /* cords end where the request says, which is not THR_ENDS_COUNTS */
} thr_recommend_options;

/* Plans as few cords as stay within the hand at the upper end of the band of mu; of so many cords
 * the shortest that are found, and of these ones that are easily pulled. Unless ends are given,
 * they are at the feet where these take at most 1.5 times as much cord as ends anywhere. A limit of
 * the request on the pull makes the hand smaller. Of the request aims, cords and slack do not
 * count; plan->options says what was chosen. Work is counted: the same plan on every machine. Where
 * no number of cords stays within the hand: the shortest cord, closed unless ends are given; what
 * is easiest to pull if the time ends the search. THR_OK: a plan, whatever is proved of it, which
 * its claims say. Otherwise as thr_plan_make. The report must be released in any case. */
thr_status thr_plan_recommended(const thr_frame *frame, const thr_request *request,
                                const thr_recommend_options *options, const thr_limits *limits,
                                thr_plan *plan, thr_report *report, thr_err *err) THR_MUST_CHECK;

/* ---- advise.c: How many cords, and from where: a plan for every number of cords and kind of ends
 * that may be worth it, and a choice among them. */

/* Work of advice where nobody says how long, in s that are counted: with it the rows are the same
 * for everybody. */
extern const double thr_advise_work;

typedef struct {
  double hand; /* N: what the pull is to stay within */
  /* Hears of every row as soon as it is there or better, before any is dropped, borrowed with its
   * cords; NULL = nobody. */
  void (*row)(void *user, const thr_advice_row *row);
  /* Hears, where a plan stays within the hand, of the row that is recommended, and of its plan:
   * before most of the searches of what recommend.c makes, and at the end where another row became
   * the better one. Borrowed; the plan may be confirmed (thr_plan_confirm). NULL = nobody. */
  void (*recommended)(void *user, const thr_advice_row *row, thr_plan *plan);
  void *user;
} thr_advise_options;

/* Of the request only cover, capacity and physics count. Rows: one closed cord; for ends at the
 * feet, if there are any, and ends anywhere, 1, 2, 3, 4, 6, 8, 12, .. cords until the pull is that
 * of the seating tension, two more numbers have bought nothing, or there are four times as many
 * cords as stay within the hand; numbers below the fewest that do; and as few as need no overlap.
 * (More closed cords than one buy nothing that cords with ends anywhere do not.) First the cord
 * that turns least is cut evenly into every number of cords, or symmetric cords are taken if they
 * turn less; then what is recommended is planned (recommend.c); then every number has a search from
 * there, the fewest within the hand first, each with a part of the time that is left: where they
 * end before it is over the same input gives the same rows. Of more than 5,000 edges only the
 * shortest closed cords are cut. Of several components each has rows of its own; a row of all is of
 * the most cords in a component, and every other one has as few as need no more pull. THR_EINPUT:
 * physics that do not fit. THR_ELIMIT, THR_EINFEASIBLE: no row has a plan. THR_OK also if the time
 * was over before all searches had their turn (complete says so), as long as there is a row.
 * Release with thr_advice_destroy. */
thr_status thr_advise(const thr_frame *frame, const thr_request *request,
                      const thr_advise_options *options, const thr_limits *limits, thr_advice *out,
                      thr_err *err) THR_MUST_CHECK;

/* Makes a plan, which claims nothing, of the cords of a row of that frame and request. On failure
 * *plan is empty. O(passes). */
thr_status thr_advice_plan(const thr_frame *frame, const thr_request *request,
                           const thr_advice_row *row, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
