/* Options of the least turning. */
#include "cli/args/turning_args.h"
#include "graph/plan/turning_proof.h"

#include <stdlib.h>
#include <string.h>

enum { FRONTIER_POINTS = 9, FRONTIER_MOST = 1000, MOST_NODES = 1000000 };

turning_args turning_args_default(void)
{
  const thr_request usual = thr_request_default();
  return (turning_args){.options = usual.turning};
}

/* "5" or "5%". */
static bool slack(const char *text, double *out)
{
  char *end;
  double percent = strtod(text, &end);
  bool ok = end != text && (*end == '\0' || strcmp(end, "%") == 0) && percent >= 0 && percent <= 1e6;
  if (ok)
    *out = percent / 100;
  else
    cli_usage("plan", "--length-slack %s: expected a percentage from 0 to 1e+06, like 5 or 5%%", text);
  return ok;
}

bool turning_option(turning_args *a, int option, const char *value, bool *ok)
{
  thr_turning_options *options = &a->options;
  const char *name = NULL;
  int i = 0;
  switch (option) {
  case OPTION_TURNING_SLACK:
    *ok = slack(value, &options->length_slack);
    a->spelled = name = "--length-slack";
    break;
  case OPTION_TURNING_MINIMIZE:
    *ok = cli_choose("plan", "--minimize", value, thr_minimize_name, THR_N_MINIMIZE, &i);
    a->largest = *ok && i > 0;
    a->pull = *ok && thr_minimize_aim(i) == THR_AIM_PULL;
    a->minimize = true;
    a->spelled = name = "--minimize";
    break;
  case OPTION_TURNING_COST:
    *ok = cli_choose("plan", "--turn-cost", value, thr_turn_cost_name, THR_N_TURN_COSTS, &i);
    if (*ok) options->cost = (thr_turn_cost)i;
    a->spelled = name = "--turn-cost";
    break;
  case OPTION_TURNING_TOUR:
    *ok = cli_choose("plan", "--tour", value, thr_tour_name, THR_N_TOURS, &i);
    if (*ok) options->tour = (thr_tour)i;
    name = "--tour";
    break;
  case OPTION_TURNING_PAIRINGS:
    *ok = cli_choose("plan", "--pairings", value, thr_pairings_name, 2, &i);
    options->pairings = (thr_pairings)i;
    a->pairings = true;
    name = "--pairings";
    break;
  case OPTION_TURNING_NODES:
    *ok = cli_int("plan", "--nodes", value, 1, MOST_NODES, &options->nodes);
    name = "--nodes";
    break;
  case OPTION_TURNING_FRONTIER:
    a->frontier = FRONTIER_POINTS;
    *ok = !value || cli_int("plan", "--frontier", value, 2, FRONTIER_MOST, &a->frontier);
    name = "--frontier";
    break;
  case OPTION_TURNING_COMPARE:
    a->compare = true;
    name = "--compare-shortest";
    break;
  case OPTION_TURNING_PLOT:
    a->plot = value;
    name = "--plot";
    break;
  default: return false;
  }
  if (!a->given) a->given = name;
  return true;
}

/* What would be ignored is refused. */
int turning_args_check(const turning_args *a, const thr_request *wanted)
{
  const thr_turning_options *options = &a->options;
  if (!thr_wants_turning(wanted) && a->given) return cli_usage("plan", "%s needs --objective tortuosity", a->given);
  if (a->plot && !*a->plot) return cli_usage("plan", "an empty name is no place to write to");
  if (a->plot && strcmp(a->plot, "-") == 0) return cli_usage("plan", "--plot -: the summary has stdout; name a file");
  if (a->plot && !a->frontier) return cli_usage("plan", "--plot draws the frontier: it needs --frontier");
  if (a->pull && options->cost != THR_TURN_ANGLE)
    return cli_usage("plan", "--minimize pull is of angles: no --turn-cost %s", thr_turn_cost_name((int)options->cost));
  if (options->tour == THR_TOUR_LEAST)
    return a->pairings ? cli_usage("plan", "--pairings is for --tour fleury and --tour hierholzer") : -1;
  const char *tour = thr_tour_name(options->tour);
  if (options->nodes > 0) return cli_usage("plan", "--tour %s searches nothing: no --nodes", tour);
  if (options->length_slack > 0) return cli_usage("plan", "--tour %s takes the shortest passes: no --length-slack but 0", tour);
  if (a->largest)
    return cli_usage("plan", "--tour %s minimizes nothing: no --minimize %s", tour, a->pull ? "pull" : "max-turning");
  if (a->frontier) return cli_usage("plan", "--tour %s minimizes nothing: no --frontier", tour);
  return -1;
}
