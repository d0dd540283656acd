#include "cli/print/terms.h"
#include "cli/cli.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/request.h"
#include "graph/plan/standing.h"

#include <ctype.h>
#include <string.h>

static int components_of(const thr_plan *plan)
{
  int last = 0;
  for (int i = 0; i < plan->n_cords; i++)
    if (plan->cord[i].component > last) last = plan->cord[i].component;
  return last + 1;
}

/* Nodes where cords may end. */
static int end_nodes(const thr_plan *plan)
{
  int n = 0;
  for (int v = 0; v < plan->frame.n_nodes; v++)
    n += thr_plan_end_allowed(&plan->frame, &plan->options, v);
  return n;
}

static void put_ends(thr_text *text, const thr_plan *plan)
{
  int n = end_nodes(plan);
  switch (plan->options.ends) {
  case THR_ENDS_CLOSED: thr_text_append(text, "closed cords"); break;
  case THR_ENDS_ANY: thr_text_append(text, "cord ends at any node"); break;
  case THR_ENDS_FEET: thr_text_printf(text, "cord ends at the %d %s", n, cli_plural(n, "foot", "feet")); break;
  case THR_ENDS_NODES: thr_text_printf(text, "cord ends at %d given %s", n, cli_plural(n, "node", "nodes")); break;
  default: thr_text_printf(text, "given numbers of cord ends at %d %s", n, cli_plural(n, "node", "nodes"));
  }
}

static void put_passes(thr_text *text, const thr_plan *plan)
{
  const thr_request *options = &plan->options;
  thr_text_printf(text, "; %d %s of every edge or more", options->cover, cli_plural(options->cover, "pass", "passes"));
  if (plan->frame.cover) thr_text_append(text, ", as the framework says");
  if (options->distinct) thr_text_printf(text, ", by %d different cords", options->distinct);
  if (options->capacity) thr_text_printf(text, ", at most %d", options->capacity);
  if (plan->frame.capacity)
    thr_text_append(text, options->capacity ? " or what the framework allows" : ", at most what the framework allows");
}

static void put_number(thr_text *text, const thr_plan *plan)
{
  const thr_request *options = &plan->options;
  int components = components_of(plan), least = thr_plan_cords_least(options);
  if (options->ends == THR_ENDS_COUNTS)
    thr_text_printf(text, "; %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  else if (least < options->cords)
    thr_text_printf(text, "; %d to %d cords", least, options->cords);
  else
    thr_text_printf(text, "; %d %s", options->cords, cli_plural(options->cords, "cord", "cords"));
  if (components > 1 && options->ends != THR_ENDS_COUNTS) thr_text_printf(text, " in each of %d components", components);
  if (options->max_length > 0) thr_text_printf(text, ", none longer than %.12g %s", options->max_length, plan->frame.units);
  if (options->max_pull > 0)
    thr_text_printf(text, ", none that needs more than %.6g times the seating tension at mu = %g", options->max_pull,
                    options->physics.mu);
}

/* Of what turning and fewest cords are proved. */
static void put_kind(thr_text *text, const thr_plan *plan)
{
  if (plan->pull_claim.tree.n_nodes > 0)
    thr_text_printf(text, "; for the fewest cords: at most %d passes of an edge, back only at nodes with one edge",
                    plan->pull_claim.most_passes);
  if (!plan->turning.present) return;
  thr_text_printf(text, "; for the turning: at most %d passes of an edge, back only at nodes with one edge",
                  plan->turning.most_passes);
  if (plan->turning.length_limit >= 0) thr_text_printf(text, ", at most %.6f %s", plan->turning.length_limit, plan->frame.units);
}

static void put_plans(thr_text *text, const thr_plan *plan)
{
  put_ends(text, plan);
  put_passes(text, plan);
  put_number(text, plan);
  thr_text_append(text, plan->options.joint == THR_JOINT_TUBE ? "; tube joints" : "; solid joints");
  if (plan->frame.own_lengths) thr_text_append(text, "; lengths of edges as given, not from their nodes");
  put_kind(text, plan);
}

static bool slack_asked(const thr_plan *plan)
{
  return thr_wants_turning(&plan->options) && plan->options.turning.length_slack >= 0;
}

static bool slack_proved(const thr_plan *plan)
{
  return plan->proof.present && !plan->proof.slack_open;
}

static bool measured(const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  return evaluation->present && evaluation->method != THR_CAPSTAN && (!evaluation->standing.present || evaluation->standing.taut);
}

/* Was a row of a table asked for, which says nothing without the table? */
static bool row_asked(const thr_plan *plan)
{
  return thr_wants_symmetry(&plan->options) && isdigit((unsigned char)plan->options.symmetry.group[0]);
}

/* "below 4.14 N at the harder ends, .. nothing holds it: verified", a line for each answer of the limit analysis. */
static void standing_put(thr_text *text, const thr_plan *plan)
{
  static const char *const below[] = {
      [THR_ASKED_HOLDING] = "N at the harder ends, while the cords are drawn in, nothing holds it",
      [THR_ASKED_EQUAL] = "N at all ends, while the cords are drawn in, nothing holds it",
      [THR_ASKED_ANY_STATE] = "N at all ends, whatever was done to the cords before, nothing holds it",
      [THR_ASKED_AFTER] = "of the tensions that the schedule leaves nothing holds it",
      [THR_ASKED_STRETCH] = "N m, by which the tension of knotted cord grows x its length, nothing holds it after the schedule",
      [THR_ASKED_LOADED] = "N at all ends, while the cords are drawn in, it does not carry the load"};
  const thr_standing *standing = &plan->evaluation.standing;
  for (int i = 0; i < standing->n_answers; i++) {
    const thr_answer *answer = &standing->answer[i];
    if (answer->n_beads == 0) continue;
    if (!thr_asked_of_load(answer->asked))
      thr_text_printf(text, "  below %.6g %s: verified\n", answer->proved, below[answer->asked]);
    else if (answer->asked == THR_ASKED_CARRIED)
      thr_text_printf(text, "  %.6g N at all ends carry no more than %.4g times the load: verified\n", answer->pull,
                      answer->proved);
    else
      thr_text_printf(text, "  after the schedule it carries no more than %.4g times the load: verified\n", answer->proved);
  }
  if (standing->present) thr_text_append(text, "  not verified: that the equilibria which the limit analysis found exist\n");
}

/* Does a plan of version 1 say anything of pulls at both ends? */
static bool is_of_older_pull(const thr_plan *plan)
{
  bool says = plan->options.max_pull > 0 || plan->evaluation.standing.present;
  for (int i = 0; i < plan->evaluation.n_cords; i++)
    says |= plan->evaluation.cord[i].pull == THR_PULL_BOTH && plan->evaluation.schedule.n == 0;
  return says && plan->options.old_pull;
}

void terms_put(thr_text *text, const thr_plan *plan)
{
  thr_text_append(text, "  terms: ");
  put_plans(text, plan);
  thr_text_append(text, "\n");
  if (slack_asked(plan))
    thr_text_printf(text, "  cord at most %g %% above the least length: %s\n", 100 * plan->options.turning.length_slack,
                    slack_proved(plan) ? "verified" : "not verified");
  if (row_asked(plan))
    thr_text_printf(text, "  not verified: that the group is row %s of a table of symmetries\n", plan->options.symmetry.group);
  if (measured(plan) && plan->evaluation.standing.taut)
    thr_text_append(text, "  not verified: the turns of the tight cords; what follows from them is\n");
  else if (measured(plan))
    thr_text_printf(text, "  not verified: the tensions, which method %s measured; what follows from them is\n",
                    thr_method_name(plan->evaluation.method));
  if (is_of_older_pull(plan))
    thr_text_append(
        text,
        "  pulls at both ends are those of plans of version 1, which ask both for the pass in the middle: more than is needed\n");
  standing_put(text, plan);
}

void terms_put_json(thr_writer *writer, const thr_plan *plan)
{
  thr_text words = {0};
  put_plans(&words, plan);
  thr_write_words(writer, "terms", &words);
  if (slack_asked(plan)) {
    thr_write_printf(writer, "length_slack", "%.12g", plan->options.turning.length_slack);
    thr_write_bool(writer, "slack_verified", slack_proved(plan));
  }
  if (plan->evaluation.present) thr_write_bool(writer, "tensions_verified", !measured(plan));
  if (is_of_older_pull(plan)) thr_write_int(writer, "pulls_of_version", 1);
}
