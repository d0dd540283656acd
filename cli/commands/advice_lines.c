/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints advice beside a plan: that a hand cannot pull its cords, and which number of cords it can,
 * with the command that makes that plan.
 *
 * A pull beyond 50 N at the hardest end is too hard (thr_hand_most). Advice is what `thread advise`
 * recommends, found with the same counted work, so that both say the same.
 *
 * Example, of the 7 x 7 dome with one cord, pulled with 181 N: "4 cords to the feet need about 3.21
 * and 3.27 N with as much cord: thread plan dome.json --cords 4 --ends feet --objective tortuosity
 * --minimize pull". */

#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "graph/number.h"
#include "graph/plan/plan_measures.h"
#include "planner/planner.h"

static const double usual_work = 2; /* counted, in seconds */

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

/* Returns the pull at the hardest end of a plan's cords, N. */
static double largest_pull(const thr_plan *plan)
{
  double pull[THR_ADVICE_PULLS];
  thr_advice_pulls(&plan->options.physics,
                   thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords), pull);
  return pull[THR_ADVICE_MU];
}

/* Appends the recommended row with its command. */
static void put_line(const thr_advice *advice, const thr_plan *plan, const char *path,
                     const cli_physics *physics, thr_text *text)
{
  const thr_advice_row *row = &advice->row[advice->chosen];
  thr_text options = {0}, command = {0};
  advice_command_options(physics, &options);
  advice_put_command(&command, path, options.data ? options.data : "", row);

  /* Without memory the line is left out, and whoever writes the text reports that. */
  if (options.failed || command.failed)
    text->failed = true;
  else
    advice_put_line(text, row, plan->metrics.length, command.data);
  thr_text_destroy(&options);
  thr_text_destroy(&command);
}

/* Appends that so much is beyond a hand; the line goes on. */
static void put_too_hard(thr_text *text, double newton)
{
  char force[64];
  thr_text_printf(text, "hand     %s is ", plain_force(newton, force));
  plain_put_hand(text, newton);
}

void advice_put_after_plan(const thr_plan *plan, const char *path, const cli_physics *physics,
                           thr_text *text)
{
  const thr_advise_options options = {.hand = thr_hand_always, .plan = plan};
  thr_advice advice = {0};
  double newton = largest_pull(plan), work = 0;

  if (newton <= thr_hand_most) return;

  /* First that it is too hard, then what is not. */
  put_too_hard(text, newton);
  thr_text_append(text, ":\n");

  /* As much work as for the table, so that the same row is recommended. */
  thr_limits limits = advice_limits(-1, &work);
  if (thr_advise(&plan->frame, &plan->options, &options, &limits, &advice, NULL))
    advice.chosen = -1;
  cli_progress_end();

  if (advice.chosen >= 0)
    put_line(&advice, plan, path, physics, text);
  else
    thr_text_append(
        text, "         no number of cords was found that it can pull; thread advise says more\n");
  thr_advice_destroy(&advice);
}

void advice_put_hint(const thr_plan *plan, thr_text *text)
{
  const double newton = largest_pull(plan);
  if (newton <= thr_hand_most || plan->options.max_pull > 0) return;
  put_too_hard(text, newton);
  thr_text_printf(text, "; --max-pull %g takes as few cords as need no more\n", thr_hand_most);
}

thr_limits advice_limits(double seconds, double *work)
{
  if (seconds < 0) *work = usual_work;
  thr_limits limits = cli_limits(seconds > 0 ? thr_dispatch_search_seconds(seconds, false) : 0);

  /* Advice is silent: a bar for many small searches would say nothing. */
  if (!cli_verbose) limits.progress = NULL;
  limits.advance = NULL;

  /* Counted work makes the same rows on every machine. */
  return *work > 0 ? thr_limits_counted(&limits, work) : limits;
}
