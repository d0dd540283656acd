/* The summary of `thread plan`, as text and as JSON. */
#include "cli/print/plan_summary.h"
#include "cli/print/symmetry_table.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/angle.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool turns_least(const thr_plan *plan)
{
  return thr_wants_turning(&plan->options);
}

/* ---- cords ---- */

/* Of the turns that the plan counts; for other objectives than the least turning of those inside the cord. */
typedef struct {
  double turning, sharpest; /* rad */
  int u_turns;
} cord_turns;

static cord_turns turns_of(const thr_plan *plan, const thr_cord *cord)
{
  cord_turns x = {0};
  int n = turns_least(plan) ? thr_cord_turns(&plan->options, cord) : cord->n_passes - 1;
  for (int k = 0; k < n; k++) {
    int out = cord->half[(k + 1) % cord->n_passes];
    double angle = thr_turn_angle(&plan->frame, cord->half[k], out);
    x.turning += angle;
    x.sharpest = fmax(x.sharpest, angle);
    x.u_turns += out == (cord->half[k] ^ 1);
  }
  return x;
}

static void put_cord(thr_text *text, const thr_plan *plan, const thr_cord *cord, double pull)
{
  const cord_turns x = turns_of(plan, cord);
  const char *from = plan->frame.name[thr_cord_start(&plan->frame, cord)],
             *to = plan->frame.name[thr_cord_end(&plan->frame, cord)];
  char factor[24];
  thr_text_printf(text, "%-5s %7d %14.3f %6.0f deg ", cord->id, cord->n_passes, thr_cord_length(&plan->frame, cord),
                  thr_degrees(x.turning));
  if (turns_least(plan)) thr_text_printf(text, "%6.0f deg ", thr_degrees(x.sharpest));
  thr_text_printf(text, "%8d ", x.u_turns);
  if (turns_least(plan))
    thr_text_printf(text, "%12s ", turning_factor(turning_capstan(plan->options.physics.mu, x.turning), factor));
  thr_text_printf(text, "%12s", turning_factor(pull, factor));
  thr_text_printf(text, cord->closed ? "  both at %s\n" : "  %s and %s\n", from, to);
}

static void put_cords(thr_text *text, const thr_plan *plan, const double *pull)
{
  enum { MOST = 12 };
  thr_text_printf(text, "%-5s %7s %14s %10s ", "cord", "passes", "length", "turning");
  if (turns_least(plan)) thr_text_printf(text, "%10s ", "sharpest");
  thr_text_printf(text, "%8s ", "U-turns");
  if (turns_least(plan)) thr_text_printf(text, "%12s ", "capstan");
  thr_text_printf(text, "%12s  %s\n", "pull", "ends");
  for (int i = 0; i < plan->n_cords && i < MOST; i++)
    put_cord(text, plan, &plan->cord[i], pull[i]);
  if (plan->n_cords > MOST) thr_text_printf(text, "..    and %d more\n", plan->n_cords - MOST);
}

/* ---- text ---- */

static int pieces_of(const thr_plan *plan)
{
  int last = 0;
  for (int i = 0; i < plan->n_cords; i++)
    if (plan->cord[i].component > last) last = plan->cord[i].component;
  return last + 1;
}

/* How many cords were asked for. */
static void put_number(thr_text *text, const thr_plan *plan, int components)
{
  enum { NO_LIMIT = 1000 };
  const thr_request *options = &plan->options;
  const char *each = components > 1 ? " in each component" : "";
  if (!thr_plan_counted(options) || options->ends == THR_ENDS_COUNTS)
    thr_text_printf(text, "; %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  else if (options->max_pull > 0 && plan->pull_claim.present)
    ; /* as many as the pull takes */
  else if (options->cords_least < options->cords && options->cords < NO_LIMIT)
    thr_text_printf(text, "; %d to %d cords%s", options->cords_least, options->cords, each);
  else if (options->cords_least < options->cords && options->cords_least > 1)
    thr_text_printf(text, "; %d cords and more%s", options->cords_least, each);
  else if (options->cords_least == options->cords && options->cords > 1)
    thr_text_printf(text, "; %d cords%s", options->cords, each);
  if (thr_wants_balance(options)) thr_text_append(text, "; of even length");
  if (options->max_length > 0) thr_text_printf(text, "; none longer than %g %s", options->max_length, plan->frame.units);
  if (options->max_pull > 0)
    thr_text_printf(text, "; none pulled by more than %g N", options->max_pull * options->physics.seating);
}

static void put_head(thr_text *text, const thr_plan *plan)
{
  const thr_request *options = &plan->options;
  int components = pieces_of(plan);
  thr_text_printf(text, "%d nodes, %d %s, %d %s; %d %s per edge", plan->frame.n_nodes, plan->frame.n_edges,
                  cli_plural(plan->frame.n_edges, "edge", "edges"), components, cli_plural(components, "component", "components"),
                  options->cover, cli_plural(options->cover, "pass", "passes"));
  if (plan->frame.cover) thr_text_append(text, " or as the framework says");
  if (options->capacity) thr_text_printf(text, ", at most %d", options->capacity);
  thr_text_printf(text, "; ends: %s", thr_ends_name(options->ends));
  if (options->joint == THR_JOINT_TUBE) thr_text_append(text, "; joints: tube");
  put_number(text, plan, components);
  thr_text_append(text, "\n\n");
}

/* How long the longest cord is, and whether fewer would do. */
static void put_claim(thr_text *text, const thr_plan *plan, thr_cords_word word)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  const char *units = plan->frame.units;
  if (!claim->present) return;
  thr_text_printf(text, "longest  %.6f %s", claim->longest, units);
  if (claim->longest_optimal)
    thr_text_append(text, "; optimal: with these options the longest cord is no shorter (verified)");
  else if (thr_wants_balance(&plan->options))
    thr_text_printf(text, "; at least %.6f %s is needed (verified), gap %.3g %%%s", claim->longest_bound, units,
                    100 * (claim->longest - claim->longest_bound) / claim->longest,
                    word.longest_least ? ";\n         optimal by the solver's word (not verified): none shorter exists" : "");
  thr_text_append(text, "\n");
  if (claim->fewest == 0) return;
  thr_text_printf(text, "cords    %d; ", plan->n_cords);
  if (claim->fewest_optimal)
    thr_text_append(text, "optimal: no fewer will do (verified)\n");
  else
    thr_text_printf(text, "at least %d are needed (verified)\n", claim->fewest);
}

/* What hand and cord feel, and whether fewer cords would do with it. */
static void put_pull_limit(thr_text *text, const thr_plan *plan, double largest)
{
  const thr_request *options = &plan->options;
  const thr_pull_claim *claim = &plan->pull_claim;
  double seating = options->physics.seating;
  if (options->max_pull <= 0) return;
  thr_text_printf(text, "hand     %.4g N at most at the end of a cord, both pulled: %.4g x %g N seating; %.6g N are allowed\n",
                  largest * seating, largest, seating, options->max_pull * seating);
  if (!claim->present) return;
  thr_text_printf(text, "cords    %d; ", plan->n_cords);
  if (claim->optimal)
    thr_text_printf(text, "optimal: fewer than %d are impossible within that pull (verified)\n", claim->fewest);
  else
    thr_text_printf(text, "fewer than %d are impossible within that pull (verified)\n", claim->fewest);
}

/* What the checker has verified, and whether GLPK's exact simplex finds the same minimum on these cuts. */
static void put_certificate(thr_text *text, const thr_plan *plan)
{
  const thr_length_proof *proof = &plan->proof;
  int cuts = thr_length_proof_cuts(proof);
  bool agreed = proof->confirmed > 0 && proof->unconfirmed == 0;
  bool missed = proof->unconfirmed > 0 && plan->options.confirm == THR_CONFIRM_ALWAYS;
  thr_text_printf(text, "(certificate: %d %s, verified%s)", cuts, cli_cuts_word(plan, cuts),
                  agreed   ? "; GLPK agrees"
                  : missed ? "; not confirmed by GLPK"
                           : "");
}

static void put_length_status(thr_text *text, const thr_plan *plan, thr_cords_word word)
{
  const thr_length_proof *proof = &plan->proof;
  if (proof->optimal) {
    thr_text_append(text, "optimal: no threading with these options uses less cord ");
    put_certificate(text, plan);
    thr_text_append(text, "\n");
  } else if (!thr_wants_length(&plan->options) || plan->options.max_length > 0 ||
             thr_wants_balance(&plan->options)) { /* which asks for more */
    thr_text_printf(text, "at least %.6f %s is needed ", proof->lower_bound, plan->frame.units);
    put_certificate(text, plan);
    thr_text_printf(text, "; this is %.2f %% more\n", 100 * (plan->metrics.length / proof->lower_bound - 1));
  } else {
    thr_text_printf(text, "not proved optimal: at least %.6f %s is needed, gap %.3g %%\n", proof->lower_bound, plan->frame.units,
                    100 * proof->gap);
  }
  if (!proof->optimal && word.passes_least && plan->options.max_length == 0 && !thr_wants_balance(&plan->options))
    thr_text_append(text,
                    "         optimal by the solver's word (not verified): all other passes were ruled out for so many cords\n");
}

static void put_text(thr_text *text, const thr_plan *plan, const double *pull, double largest, const thr_rivals *rivals,
                     thr_cords_word word)
{
  const thr_metrics *metrics = &plan->metrics;
  double mu = plan->options.physics.mu;
  put_head(text, plan);
  put_cords(text, plan, pull);
  if (plan->symmetry.present) symmetry_put_paths(text, plan);
  thr_text_printf(text, "\nlength   %.6f %s = %.6f for ", metrics->length, plan->frame.units, metrics->base_length);
  if (plan->frame.cover)
    thr_text_append(text, "the passes that every edge needs");
  else
    thr_text_printf(text, "%d %s over every edge", plan->options.cover, cli_plural(plan->options.cover, "pass", "passes"));
  thr_text_printf(text, " + %.6f overlap (%.1f %%)\n", metrics->overlap, 100 * metrics->overlap / metrics->base_length);
  thr_text_append(text, "         ");
  put_length_status(text, plan, word);
  put_claim(text, plan, word);
  put_pull_limit(text, plan, largest);
  if (rivals) turning_put_status(text, plan, rivals);
  if (rivals) thr_text_printf(text, "capstan  exp(mu x turning): the factor from one end of a cord to the other (mu = %g)\n", mu);
  thr_text_printf(text, "pull     with both ends pulled, times the tension that must reach the slackest point (mu = %g)\n", mu);
  if (rivals) turning_put_table(text, plan, rivals);
  if (rivals) turning_put_frontier(text, plan, rivals);
}

static double *pulls_of(thr_text *text, const thr_plan *plan, double *largest)
{
  double *pull = thr_calloc((size_t)plan->n_cords, sizeof *pull);
  if (!pull) text->failed = true; /* which whoever writes the text reports */
  if (pull) *largest = turning_pull(plan, pull);
  return pull;
}

void plan_put_summary(thr_text *text, const thr_plan *plan, const thr_rivals *rivals, thr_cords_word word)
{
  double largest, *pull = pulls_of(text, plan, &largest);
  if (pull) put_text(text, plan, pull, largest, rivals, word);
  free(pull);
}

/* ---- JSON ---- */

static void put_claim_json(thr_writer *writer, const thr_plan *plan, thr_cords_word word)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  thr_write_number(writer, "longest", claim->longest);
  thr_write_number(writer, "longest_bound", claim->longest_bound);
  thr_write_string(writer, "longest_status",
                   claim->longest_optimal ? "optimal"
                   : word.longest_least   ? "bound, optimal by the solver's word"
                                          : "bound");
  if (!claim->fewest) return;
  thr_write_int(writer, "fewest_cords", claim->fewest);
  thr_write_string(writer, "fewest_status", claim->fewest_optimal ? "optimal" : "bound");
}

void plan_put_json(thr_writer *writer, const thr_plan *plan, const thr_rivals *rivals, thr_cords_word word)
{
  const thr_metrics *metrics = &plan->metrics;
  thr_write_hash(writer, "framework", thr_frame_hash(&plan->frame));
  thr_write_int(writer, "nodes", plan->frame.n_nodes);
  thr_write_int(writer, "edges", plan->frame.n_edges);
  thr_write_int(writer, "cords", plan->n_cords);
  thr_write_string(writer, "units", plan->frame.units);
  thr_write_number(writer, "length", metrics->length);
  thr_write_number(writer, "base_length", metrics->base_length);
  thr_write_number(writer, "overlap", metrics->overlap);
  thr_write_number(writer, "lower_bound", plan->proof.lower_bound);
  thr_write_number(writer, "gap", plan->proof.gap);
  thr_write_number(writer, "turning", metrics->turning);
  thr_write_number(writer, "max_turning", metrics->max_turning);
  thr_write_number(writer, "mu", plan->options.physics.mu);
  thr_write_string(writer, "status", plan->proof.optimal ? "optimal" : "bound");
  thr_write_number(writer, "pull_factor", turning_pull(plan, NULL));
  if (plan->options.max_pull > 0) thr_write_number(writer, "max_pull", plan->options.max_pull);
  if (plan->pull_claim.present) {
    thr_write_int(writer, "fewest_cords_for_pull", plan->pull_claim.fewest);
    thr_write_string(writer, "fewest_cords_for_pull_status", plan->pull_claim.optimal ? "optimal" : "bound");
  }
  if (plan->cords_claim.present) put_claim_json(writer, plan, word);
  if (rivals) turning_put_json(writer, plan, rivals);
  if (plan->symmetry.present) symmetry_put_json(writer, plan);
}
