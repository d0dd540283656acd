/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints beside a plan whether a hand can pull its cords, and which plan it can.
 *
 * A pull beyond 50 N at the hardest end is too hard (thr_hand_most). The plan that is made where
 * no objective and no number is said (planner/recommend.c) stays within 10 N (thr_hand_always) even
 * at the upper end of the band of mu.
 *
 * Example, of the 7 x 7 dome: "4 cords to the feet, 3.45 N each at most, or 6.42 N if mu is 0.3: as
 * few as were found that a hand can pull time after time, with 10 N". */

#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "planner/planner.h"

#include <math.h>

static const double much_more = 1.5; /* than what seats the cords, that holds the pieces */

/* Appends an option with a word that a shell reads as it is. */
static void put_option(thr_text *text, const char *option, const char *value)
{
  thr_text_printf(text, " --%s ", option);
  advice_put_word(text, value);
}

/* Appends the options that were given of how FRAME is read and of what cord and beads are. */
static void put_command_options(thr_text *text, const cli_physics *physics)
{
  for (const cli_option *option = cli_frame_options; option->name; option++) {
    const char *value = cli_given(option->name) ? cli_given_value(option->name) : NULL;
    if (value) {
      put_option(text, option->name, value);
    } else if (cli_given(option->name)) {
      thr_text_printf(text, " --%s", option->name);
    }
  }
  for (int i = 0; i < physics->n; i++) {
    put_option(text, physics->given[i].option->name, physics->given[i].value);
  }
  if (cli_given("cover")) put_option(text, "cover", cli_given_value("cover"));
}

void advice_put_command(const void *user, const thr_advice_row *row, thr_text *text)
{
  static const char *const again[] = {"hand", "time-limit"};
  const advice_commands *of = user;

  /* What a hand always manages is what `thread plan` makes unasked. */
  const bool unasked = row && row->planned && of->hand == thr_hand_always;
  thr_text_append(text, unasked ? "thread plan " : "thread advise ");
  advice_put_word(text, of->path);
  put_command_options(text, of->physics);
  if (unasked) return;

  /* Any other row is found again. */
  for (int i = 0; i < 2; i++)
    if (cli_given(again[i])) put_option(text, again[i], cli_given_value(again[i]));
  if (row)
    thr_text_printf(text, " --cords %d --ends %s", row->cords, thr_ends_name((int)row->ends));
  else
    thr_text_append(text, " --cords K --ends closed|feet|any");
  thr_text_append(text, " -T plan -o plan.json");
}

/* Appends that so much is beyond a hand; the line goes on. */
static void put_too_hard(thr_text *text, double newton)
{
  char force[64];
  thr_text_printf(text, "hand     %s is ", plain_force(newton, force));
  plain_put_hand(text, newton);
}

void advice_put_hint(const thr_plan *plan, bool unsaid, thr_text *text)
{
  double pull[THR_ADVICE_PULLS];
  thr_plan_pulls(plan, pull);
  const double newton = pull[THR_ADVICE_MU];
  if (newton <= thr_hand_most || plan->options.max_pull > 0) return;
  put_too_hard(text, newton);
  thr_text_append(text, unsaid ? "; no number of cords was found that it can pull\n"
                               : ";\n         thread plan without --objective and --cords takes "
                                 "as few cords as it can pull\n");
}

/* Appends what holds the pieces beside what seats the cords; nothing where it is hardly more. Both
 * are N at the hardest end; holds may be NAN: not known. Where a hand cannot hold them, the weight
 * says why. */
static void put_holds(const thr_plan *plan, double seats, double holds, thr_text *text)
{
  char force[64];
  if (!(holds > much_more * seats)) return;
  thr_text_append(text, "         that seats the cords; to hold the pieces until all is knotted ");
  if (isinf(holds)) {
    thr_text_append(text, "no pull is enough: support them\n");
    return;
  }
  thr_text_printf(text, "takes %s, ", plain_force(holds, force));
  plain_put_hand(text, holds);

  /* What holds is in proportion to the weight, which a maker can change. */
  thr_kit_estimate kit;
  thr_err unknown;
  const bool weighed = holds > thr_hand_most && !thr_kit_estimate_make(&kit, plan, &unknown);
  const double weight = weighed ? thr_kit_weight(&kit, &plan->options.physics) : 0;
  if (weight > 0) {
    thr_text_printf(text, ":\n         the pieces weigh about %s in all (",
                    plain_force(weight, force));
    plain_put_material(text, &plan->options.physics);
    thr_text_append(text, "); hollow pieces or a smaller scale take less, a scaffold carries them");
  }
  thr_text_append(text, "\n");
}

bool advice_put_recommended(const thr_plan *plan, double hand, double holds, thr_text *text)
{
  const thr_request *options = &plan->options;
  const bool as_pulled = options->max_pull > 0; /* several components share no number */
  const int cords = as_pulled ? plan->n_cords : options->cords;
  const thr_advice_row row = {.ends = options->ends, .cords = cords, .all = plan->n_cords};
  double pull[THR_ADVICE_PULLS];
  char force[64], most[64], within[64];
  const double mu_high = thr_plan_pulls(plan, pull).mu_high;
  if (pull[THR_ADVICE_HIGH] > hand * (1 + 1e-9)) return false;

  thr_text_append(text, "hand     ");
  advice_put_cords(text, &row);
  thr_text_printf(text, ", %s%s, or %s if mu is %g: as few as were found\n",
                  thr_plain_newtons(pull[THR_ADVICE_MU], force),
                  plan->n_cords > 1 ? " N each at most" : " N",
                  plain_force(pull[THR_ADVICE_HIGH], most), mu_high);
  thr_text_printf(text, "         %sthat %s, with %s",
                  options->turning.length_slack == 0 ? "at the least length " : "",
                  hand < thr_hand_always ? "the cord bears" : "a hand can pull time after time",
                  plain_force(hand, within));

  /* One cord is there for sure where it may pass every edge twice, and need not tie tubes. */
  bool one = plan->n_cords > 1 && !as_pulled && options->joint == THR_JOINT_SOLID;
  for (int e = 0; e < plan->frame.n_edges && one; e++)
    one = thr_plan_capacity(&plan->frame, options, e) >= 2 * options->cover;
  thr_text_append(text, one ? "; --cords 1 is one cord\n" : "\n");
  put_holds(plan, pull[THR_ADVICE_MU], holds, text);
  return true;
}

thr_limits advice_limits(double seconds, double *work)
{
  if (seconds < 0) *work = thr_advise_work;
  thr_limits limits = cli_limits(seconds > 0 ? thr_dispatch_search_seconds(seconds, false) : 0);

  /* Advice is silent: a bar for many small searches would say nothing. */
  if (!cli_verbose) limits.progress = NULL;
  limits.advance = NULL;

  /* Counted work makes the same rows on every machine. */
  return *work > 0 ? thr_limits_counted(&limits, work) : limits;
}
