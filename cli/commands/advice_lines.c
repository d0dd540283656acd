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
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "planner/planner.h"

/* Appends an option with a word that a shell reads as it is. */
static void put_option(thr_text *text, const char *option, const char *value)
{
  thr_text_printf(text, " --%s ", option);
  advice_put_word(text, value);
}

void advice_command_options(const cli_physics *physics, thr_text *text)
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

void advice_put_recommended(const thr_plan *plan, double hand, thr_text *text)
{
  const thr_request *options = &plan->options;
  const thr_advice_row row = {.ends = options->ends, .cords = options->cords, .all = plan->n_cords};
  double pull[THR_ADVICE_PULLS];
  char force[64], most[64], within[64];
  const double mu_high = thr_plan_pulls(plan, pull).mu_high;

  thr_text_append(text, "hand     ");
  advice_put_cords(text, &row);
  thr_text_printf(text, ", %s%s, or %s if mu is %g: as few as were found\n",
                  thr_plain_newtons(pull[THR_ADVICE_MU], force),
                  plan->n_cords > 1 ? " N each at most" : " N",
                  plain_force(pull[THR_ADVICE_HIGH], most), mu_high);
  thr_text_printf(text, "         that %s, with %s%s\n",
                  hand < thr_hand_always ? "the cord bears" : "a hand can pull time after time",
                  plain_force(hand, within), plan->n_cords > 1 ? "; --cords 1 is one cord" : "");
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
