/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans the shortest cords, component by component: with solid joints by the postman's matching
 * (lp/length), with tube joints by tortuosity/tie, because turns are what ties a node.
 *
 * The proof is put together from the components' certificates. Where cords within a limit on their
 * length are not proved the fewest, planner/short_few.c looks for fewer; where the longest cord is
 * to be short, planner/even_length.c makes it shorter. */
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "planner/planner_parts.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>

typedef thr_status component_planner(const thr_frame *frame, const thr_request *options,
                                     const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                                     thr_err *err);

/* ---- several components ---- */

/* Plans one component by itself, in its part of the time: a component may need more cords than
 * another, or hold fewer. */
static thr_status plan_component(const thr_components *components, int k, component_planner *one,
                                 const thr_limits *limits, thr_plan *made, thr_cords_word *all,
                                 thr_err *err)
{
  thr_plan asked;
  thr_cords_word word = {0};
  thr_err why = {0};

  thr_status st = thr_component_take(components, k, &asked, err);
  if (st) return st;

  /* Its share of the time is that of its edges. */
  const int *first = components->first_edge;
  thr_limits share = thr_limits_part(limits, (double)(first[k + 1] - first[k]) /
                                                 (first[components->n] - first[k]));
  share.found = NULL; /* cords of a component are no plan */

  st = one(&asked.frame, &asked.options, &share, made, &word, &why);
  thr_plan_destroy(&asked);

  all->passes_least &= word.passes_least;
  all->longest_least &= word.longest_least || made->cords_claim.longest_optimal;
  return st && (st != THR_ELIMIT || made->n_cords == 0) ? thr_fail(err, st, "%s", why.text)
                                                        : THR_OK;
}

/* Takes the certificates of the components' plans, and counts how often GLPK agreed. */
static thr_status take_certificates(const thr_components *components, thr_plan *made,
                                    thr_length_proof *proof, thr_err *err)
{
  *proof = (thr_length_proof){.present = true};
  if (!(proof->certificate = thr_calloc((size_t)components->n, sizeof *proof->certificate)))
    return thr_nomem(err);
  proof->n_certificates = components->n;

  for (int k = 0; k < components->n; k++) {
    thr_component_give_certificate(components, k, &made[k], &proof->certificate[k]);
    proof->confirmed += made[k].proof.confirmed;
    proof->unconfirmed += made[k].proof.unconfirmed;
  }
  return THR_OK;
}

/* Fills the cords of plan, which holds framework and options, and with solid joints its
 * certificates. */
static thr_status plan_components(component_planner *one, const thr_limits *limits, thr_plan *plan,
                                  thr_cords_word *word, thr_err *err)
{
  thr_components components;
  thr_status st = thr_components_init(&components, &plan->frame, &plan->options, err);
  if (st) return st;

  thr_plan *made = thr_calloc((size_t)components.n, sizeof *made);
  if (!made) st = thr_nomem(err);
  *word = (thr_cords_word){true, thr_wants_balance(&plan->options)};

  /* Plan every component by itself. */
  for (int k = 0; k < components.n && !st; k++)
    st = plan_component(&components, k, one, limits, &made[k], word, err);

  /* Join the cords, and the certificates that solid joints have. */
  if (!st) st = thr_components_join(&components, made, plan, err);
  if (!st && plan->options.joint == THR_JOINT_SOLID)
    st = take_certificates(&components, made, &plan->proof, err);

  for (int k = 0; made && k < components.n; k++)
    thr_plan_destroy(&made[k]);
  free(made);
  thr_components_destroy(&components);
  return st;
}

/* ---- solid joints ---- */

/* States what the components' certificates prove of all cords together. */
static thr_status prove_solid(thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st = thr_plan_measure(frame, options, plan->cord, plan->n_cords, &plan->metrics, err);

  if (st) return st;

  /* Let the checker state what the certificates prove of the length, and of the cords. */
  st = thr_check_length_proof(frame, options, plan->cord, plan->n_cords, proof->certificate,
                              proof->n_certificates, NULL, &proof->optimal, &proof->lower_bound,
                              &found);
  if (!st)
    st = thr_check_cords(frame, options, plan->cord, plan->n_cords, proof->certificate,
                         proof->n_certificates, NULL, &plan->cords_claim, &found);

  proof->gap = (plan->metrics.length - proof->lower_bound) / plan->metrics.length;
  return thr_check_own(st, &found, err);
}

/* Tells whether there is to be one cord in each component, which is a problem that falls apart by
 * itself. */
static bool one_each(const thr_request *options)
{
  return options->cords == 1 && options->max_length == 0 && options->ends != THR_ENDS_COUNTS;
}

/* Plans a framework of one component. */
static thr_status one_component(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                                thr_err *err)
{
  thr_err why = {0};
  thr_status st = thr_cords_plan(frame, options, limits, plan, word, &why);

  bool open = st == THR_ELIMIT && plan->cords_claim.present && thr_wants_balance(options);
  if (!open) return st ? thr_fail(err, st, "%s", why.text) : THR_OK;

  /* Where the longest cord is not proved the shortest, make it shorter. */
  st = thr_planner_even_length(plan, limits, err);
  if (!st) return thr_cords_judge(plan, &(thr_err){0}, err);
  thr_plan_destroy(plan);
  return st;
}

/* Plans cords of solid joints: at once where the framework is one component, else component by
 * component. */
static thr_status plan_solid(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                             thr_err *err)
{
  int n = 1;

  thr_status st = one_each(options) ? THR_OK : thr_frame_components(frame, NULL, &n, err);
  if (st) return st;
  if (n == 1) return one_component(frame, options, limits, plan, word, err);

  st = thr_plan_request(plan, frame, options, err);
  if (!st) st = plan_components(thr_cords_plan, limits, plan, word, err);
  if (!st) st = prove_solid(plan, err);
  if (!st) st = thr_planner_even_length(plan, limits, err);

  if (!st) return thr_cords_judge(plan, &(thr_err){0}, err);
  thr_plan_destroy(plan);
  return st;
}

/* ---- tube joints ---- */

/* Proves the length of tied cords, for the whole framework at once. */
static thr_status prove_tied(thr_tube *tube, thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  thr_status st = thr_plan_measure(frame, options, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st) thr_tube_prove(tube, plan->metrics.length, &plan->proof);
  if (st || one_each(options)) return st;
  return thr_check_tied_cords(frame, options, plan->cord, plan->n_cords, &plan->proof.tied,
                              &plan->cords_claim, err);
}

/* Plans cords of tube joints, by components where these can be planned by themselves. */
static thr_status plan_tied(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                            thr_err *err)
{
  thr_tube tube = {0};
  thr_err why = {0};
  int n;

  /* With more asked of single cords only a part of the time goes into the proof of the length. */
  const thr_limits part = thr_wants_balance(options) || options->max_length > 0
                              ? thr_dispatch_share(limits, THR_STEP_TIED)
                              : *limits;
  thr_status proved = thr_tube_shortest(frame, options, &part, &tube, &why);
  if (proved && proved != THR_ELIMIT) return thr_fail(err, proved, "%s", why.text);

  thr_status st = thr_plan_request(plan, frame, options, err);
  if (!st) st = thr_frame_components(frame, NULL, &n, err);

  if (!st)
    st = n > 1 && thr_tube_shares(options) ? plan_components(plan_tied, limits, plan, word, err)
                                           : thr_tube_cords(&tube, limits, plan, word, err);

  if (!st) st = prove_tied(&tube, plan, err);
  thr_tube_destroy(&tube);
  if (!st) return thr_cords_judge(plan, &(thr_err){0}, err);
  thr_plan_destroy(plan);
  return st;
}

/* ---- the planner ---- */

/* Cords within a limit on their length of which it is not proved that they are the fewest, or none:
 * fewer by another way, of which the solver says nothing. st: of what there is. */
static thr_status few_short(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_status st, thr_plan *plan,
                            thr_cords_word *word, thr_err *err)
{
  enum { MOST_EDGES = 2000 };
  thr_err why = {0};
  int n = 0;
  const int before = plan->n_cords;
  double longest = 0;

  /* Nothing is left to do where the number is proved, or where other planners keep to the limit. */
  if (st != THR_ELIMIT || options->max_length == 0 || options->max_pull > 0 ||
      thr_wants_balance(options) || options->ends == THR_ENDS_COUNTS ||
      frame->n_edges > MOST_EDGES ||
      (plan->cords_claim.present && plan->cords_claim.fewest_optimal))
    return st;

  thr_status found = thr_frame_components(frame, NULL, &n, &why);
  if (!found && n == 1) found = thr_planner_short_few(frame, options, limits, plan, &longest, &why);
  if (found == THR_ENOMEM) return thr_nomem(err);

  /* No cords fit: say how short the longest one could be made. */
  if (plan->n_cords == 0 && longest > 0) {
    if (err) *err = (thr_err){0};
    return thr_fail(err, st,
                    "did not find %d cords with none longer than %g %s; with --balance instead of "
                    "--max-length the longest is %g %s",
                    options->cords, options->max_length, frame->units, longest, frame->units);
  }

  if (found || n != 1 || plan->n_cords == before) return st;

  *word = (thr_cords_word){0};
  if (err) *err = (thr_err){0};
  return thr_cords_judge(plan, &(thr_err){0}, err);
}

thr_status thr_planner_length(const thr_frame *frame, const thr_request *options,
                              const thr_limits *limits, thr_plan *plan, thr_report *report,
                              thr_err *err)
{
  thr_cords_word word = {0};
  *plan = (thr_plan){0};

  thr_status st = (options->joint == THR_JOINT_TUBE ? plan_tied : plan_solid)(
      frame, options, limits, plan, &word, err);

  if (options->joint == THR_JOINT_SOLID)
    st = few_short(frame, options, limits, st, plan, &word, err);
  if (report) report->word = word;
  return st;
}

bool thr_planner_is_quick(const thr_frame *frame, const thr_request *options)
{
  enum { EDGES = 20000, DEGREE = 1000 };
  return options->joint == THR_JOINT_SOLID && frame->n_edges <= EDGES &&
         thr_frame_largest_degree(frame) <= DEGREE && options->engine != THR_ENGINE_LP;
}

/* Returns the limits of a step, which has at least a second where planning is quick. */
thr_limits thr_planner_share(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_step step)
{
  const double least = 1;
  thr_limits share = thr_dispatch_share(limits, step);
  if (share.deadline > 0 && thr_planner_is_quick(frame, options))
    share.deadline = fmax(share.deadline, thr_clock() + least);
  return share;
}

void thr_planner_tell_first(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *shortest)
{
  thr_request length = *options;
  thr_limits share = thr_planner_share(frame, options, limits, THR_STEP_FIRST);
  thr_plan plan = {0};
  thr_tube tube = {0};

  if (shortest) *shortest = (thr_plan){0};
  if (!limits->found) return;

  /* Plan the shortest cords in a part of the time, without confirmation. */
  share.found = NULL;
  share.brief = true; /* not evened out: it is the first plan to tell of, no more */
  length.aims = thr_aims_shortest;
  length.turning = thr_request_default().turning;
  length.confirm = THR_CONFIRM_NEVER;
  thr_status st = options->joint == THR_JOINT_TUBE
                      ? thr_tube_some(frame, &length, &share, &tube, NULL)
                      : thr_planner_length(frame, &length, &share, &plan, NULL, NULL);

  /* Tell of them, and hand the plan over where the caller wants it. */
  if (!st || st == THR_ELIMIT)
    thr_limits_found(limits, tube.cord ? tube.cord : plan.cord,
                     tube.cord ? tube.n_cords : plan.n_cords, NULL);

  if (!st && shortest) {
    *shortest = plan;
    plan = (thr_plan){0};
  }

  thr_plan_destroy(&plan);
  thr_tube_destroy(&tube);
}

/* Closed cords are as long as one in every component. */
thr_status thr_planner_prove_tied(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  thr_tube tube;
  thr_request options = plan->options;
  thr_err why = {0};

  if (options.ends == THR_ENDS_CLOSED) options.cords = options.cords_least = 1;

  /* The search's proof becomes one for the plan's own request. */
  thr_status st = thr_tube_shortest(&plan->frame, &options, limits, &tube, &why);
  if (st == THR_OK || st == THR_ELIMIT)
    st = thr_tied_least(&plan->frame, &plan->options, &tube.proof, &tube.bound, err);
  else
    st = thr_fail(err, st, "%s", why.text);

  if (!st) thr_tube_prove(&tube, plan->metrics.length, &plan->proof);
  thr_tube_destroy(&tube);
  return st;
}
