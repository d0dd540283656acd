/* Advice beside a plan. */
#include "cli/advice.h"
#include "cli/print/advice_table.h"
#include "graph/limits.h"
#include "graph/plan/advice.h"
#include "planner/advise.h"

#include <math.h>
#include <stdio.h>

static void put_option(thr_text *text, const char *option, const char *value)
{
  thr_text_printf(text, " --%s ", option);
  advice_put_word(text, value);
}

void advice_command_options(const cli_frame_args *a, const cli_physics *physics, thr_text *text)
{
  char weld[32];
  snprintf(weld, sizeof weld, "%.17g", a->read.weld);
  if (a->read.edges_path) put_option(text, "edges", a->read.edges_path);
  if (a->read.units) put_option(text, "units", a->read.units);
  if (a->feet) put_option(text, "feet", a->feet);
  if (a->read.weld >= 0) put_option(text, "weld", weld);
  for (int i = 0; i < physics->n; i++) {
    char name[24];
    cli_physics_spell(physics, i, name);
    put_option(text, name, physics->given[i].value);
  }
}

/* N, of the cord that is hardest to pull. */
static double force_of(const thr_plan *plan)
{
  double pull[THR_ADVICE_PULLS];
  thr_advice_pulls(&plan->options.physics, thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords), pull);
  return pull[THR_ADVICE_MU];
}

static void put_line(const thr_advice *advice, double force, const char *path, const cli_frame_args *a,
                     const cli_physics *physics, thr_text *text)
{
  thr_text options = {0}, command = {0};
  advice_command_options(a, physics, &options);
  advice_put_command(&command, path, options.data ? options.data : "", &advice->row[advice->chosen]);
  if (options.failed || command.failed)
    text->failed = true; /* which whoever writes the text reports */
  else
    advice_put_line(text, advice, force, command.data);
  thr_text_destroy(&options);
  thr_text_destroy(&command);
}

void advice_put_after_plan(const thr_plan *plan, const char *path, const cli_frame_args *a, const cli_physics *physics,
                           thr_text *text)
{
  const thr_advise_options options = {.hand = thr_hand_always, .plan = plan};
  thr_advice advice = {0};
  double force = force_of(plan);
  if (force <= thr_hand_most) return;
  if (thr_advise(&plan->frame, &plan->options, &options, &(thr_limits){0}, &advice, NULL)) return;
  if (advice.chosen >= 0) put_line(&advice, force, path, a, physics, text);
  thr_advice_destroy(&advice);
}
