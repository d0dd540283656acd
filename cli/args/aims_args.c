/* What is minimized, in one list or in the options that spell it. */
#include "cli/args/aims_args.h"
#include "graph/status.h"
#include "planner/dispatch.h"

#include <string.h>

bool aims_option(aims_args *a, int option, const char *value, bool *ok)
{
  int i;
  switch (option) {
  case OPTION_AIMS: a->aims = value; return true;
  case OPTION_OBJECTIVE:
    a->given = true;
    *ok = cli_choose("plan", "--objective", value, thr_dispatch_name, THR_N_OBJECTIVES, &i);
    if (*ok) a->objective = thr_dispatch_objective(i);
    return true;
  default: return false;
  }
}

/* An option that says a part of what --aims says whole; NULL = none was given. */
static const char *spelled(const aims_args *a, const turning_args *turning, const symmetry_args *symmetry,
                           const cords_args *cords)
{
  return a->given              ? "--objective"
         : turning->spelled    ? turning->spelled
         : cords->balance      ? "--balance"
         : symmetry->preferred ? "--prefer"
                               : NULL;
}

int aims_args_settle(aims_args *a, turning_args *turning, symmetry_args *symmetry, cords_args *cords)
{
  thr_err err = {0};
  thr_request options = thr_request_default();
  const char *other = spelled(a, turning, symmetry, cords);
  if (!a->aims) return -1;
  if (other) return cli_usage("plan", "--aims says all that is minimized: no %s beside it", other);
  if (thr_aims_parse(a->aims, &options, &err)) return cli_usage("plan", "--aims %s: %s", a->aims, err.text);
  a->objective = thr_aims_objective(&options);
  turning->largest = thr_wants_largest(&options);
  turning->pull = thr_wants_pull(&options);
  turning->minimize = true;
  turning->options.cost = options.turning.cost;
  turning->options.length_slack = options.turning.length_slack;
  cords->balance = thr_wants_balance(&options);
  thr_aims_order(&options, symmetry->prefer);
  return -1;
}

/* Of several cords the hand feels the one that turns most: a small sum may leave one that nobody can pull. */
static bool wants_largest(const turning_args *turning, const cords_args *cords)
{
  bool several = cords->most > 1 || cords_args_few(cords);
  return turning->minimize ? turning->largest
                           : several && !cords->balance && !turning->frontier && turning->options.tour == THR_TOUR_LEAST;
}

void aims_args_apply(const aims_args *a, const turning_args *turning, const symmetry_args *symmetry, const cords_args *cords,
                     thr_objective objective, thr_request *options)
{
  const thr_request usual = thr_request_default();
  bool own = objective == a->objective;
  options->aims = thr_aims_of(objective);
  options->turning = own && thr_wants_turning(options) ? turning->options : usual.turning;
  options->symmetry = own && thr_wants_symmetry(options) ? symmetry->options : usual.symmetry;
  if (thr_wants_symmetry(options)) options->symmetry.counted = cords->most > 0 || cords_args_few(cords);
  if (own && thr_wants_symmetry(options)) memcpy(options->aims.aim, symmetry->prefer, sizeof symmetry->prefer);
  if (own && thr_wants_turning(options) && wants_largest(turning, cords))
    options->aims.aim[0] = turning->pull ? THR_AIM_PULL : THR_AIM_MAX_TURNING;
  if (own && cords->balance) {
    memmove(&options->aims.aim[1], options->aims.aim, (size_t)options->aims.n++ * sizeof *options->aims.aim);
    options->aims.aim[0] = THR_AIM_LONGEST;
  }
}
