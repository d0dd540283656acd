/* The options of `thread plan` that say what turns least, and how it is found. */
#ifndef THR_CLI_TURNING_ARGS_H
#define THR_CLI_TURNING_ARGS_H

#include "cli/pull.h"
#include "graph/plan/request.h"

enum {
  OPTION_TURNING_SLACK = OPTION_PULL_FREE,
  OPTION_TURNING_MINIMIZE,
  OPTION_TURNING_COST,
  OPTION_TURNING_TOUR,
  OPTION_TURNING_PAIRINGS,
  OPTION_TURNING_NODES,
  OPTION_TURNING_FRONTIER,
  OPTION_TURNING_COMPARE,
  OPTION_TURNING_PLOT,
  OPTION_TURNING_FREE
};
#define TURNING_OPTIONS                                                                                                          \
  {"length-slack", required_argument, NULL, OPTION_TURNING_SLACK},                                                               \
      {"minimize", required_argument, NULL, OPTION_TURNING_MINIMIZE},                                                            \
      {"turn-cost", required_argument, NULL, OPTION_TURNING_COST}, {"tour", required_argument, NULL, OPTION_TURNING_TOUR},       \
      {"pairings", required_argument, NULL, OPTION_TURNING_PAIRINGS}, {"nodes", required_argument, NULL, OPTION_TURNING_NODES},  \
      {"plot", required_argument, NULL, OPTION_TURNING_PLOT}, {"compare-shortest", no_argument, NULL, OPTION_TURNING_COMPARE},   \
  {                                                                                                                              \
    "frontier", optional_argument, NULL, OPTION_TURNING_FRONTIER                                                                 \
  }
#define TURNING_HELP                                                                                                             \
  "Least turning (with --objective tortuosity):\n"                                                                               \
  "      --length-slack P%   at most P % more cord than the shortest; 0 = the least turning among the shortest (default: any)\n" \
  "      --minimize turning|max-turning|pull   of all cords together, of the cord that turns most (default with several), or\n"  \
  "                       what the hand feels: what an end of the cord that is hardest to pull at both ends has to overcome\n"   \
  "      --turn-cost " THR_TURN_COSTS "   price of a turn: its angle (default), the sine of half of it, or 1 from 90\n"          \
  "                       degrees on, or for a U-turn\n"                                                                         \
  "      --tour least|fleury|hierholzer   the least turning (default), or a classical tour through the shortest passes\n"        \
  "      --pairings keep|ignore   of a classical tour: keep to the cheapest pairing at every node, or not (default: keep)\n"     \
  "      --nodes N        end the search when its tree has N nodes, wherever it runs (default: only --time-limit ends it)\n"     \
  "      --frontier[=N]   also the trade-off between length and turning, at up to N lengths, 2 to 1000 (default: 9)\n"           \
  "      --plot FILE      with --frontier: a picture of it, pull against cord, as SVG\n"                                         \
  "      --compare-shortest  beside it the least turning among the shortest cords; with --length-slack 0 that of any length, "   \
  "with\n"                                                                                                                       \
  "                       a classical tour the least turning: one more search, as long as the first\n"

typedef struct {
  thr_turning_options options;
  bool minimize;       /* --minimize, or --aims, says which: */
  bool largest;        /* max-turning or pull: */
  bool pull;           /* the latter */
  int frontier;        /* points, 0 = none */
  bool compare;        /* --compare-shortest */
  const char *plot;    /* where the picture of the frontier goes; NULL = nowhere */
  const char *given;   /* the first of these options; NULL = none */
  const char *spelled; /* one of them that says a part of --aims; NULL = none */
  bool pairings;       /* --pairings was given */
} turning_args;

turning_args turning_args_default(void);

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad (printed). */
bool turning_option(turning_args *a, int option, const char *value, bool *ok);

/* Does what was asked make sense together, and with the aims of what is wanted? -1, or prints and returns the code. */
int turning_args_check(const turning_args *a, const thr_request *wanted);

#endif
