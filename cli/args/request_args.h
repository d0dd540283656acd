/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of a request. */
#ifndef THR_REQUEST_ARGS_H
#define THR_REQUEST_ARGS_H

#include "cli/args/symmetry_args.h"
#include "graph/framework/frame.h"

/* ---- request_args.c: The options of `thread plan` that say what the plan is to be: aims, cords,
 * ends, turning. */

enum {
  OPTION_AIMS = OPTION_SYMMETRY_FREE,
  OPTION_OBJECTIVE,
  OPTION_MINIMIZE,
  OPTION_SLACK,
  OPTION_FRONTIER,
  OPTION_COMPARE_SHORTEST,
  OPTION_FRONTIER_PLOT,
  OPTION_CORDS,
  OPTION_MAX_PULL,
  OPTION_HAND,
  OPTION_STRENGTH,
  OPTION_BALANCE,
  OPTION_ENDS,
  OPTION_FIELD, /* from here on rows of the request's table, in the order of REQUEST_OPTIONS */
  OPTION_REQUEST_FREE = OPTION_FIELD + 16
};
#define REQUEST_FIELD(name, i)                                                                     \
  {                                                                                                \
    name, required_argument, NULL, OPTION_FIELD + i                                                \
  }
#define REQUEST_OPTIONS                                                                            \
  REQUEST_FIELD("max-length", 0), REQUEST_FIELD("cover", 1), REQUEST_FIELD("capacity", 2),         \
      REQUEST_FIELD("distinct", 3), REQUEST_FIELD("joint", 4), REQUEST_FIELD("engine", 5),         \
      REQUEST_FIELD("confirm", 6), REQUEST_FIELD("crossings", 7), REQUEST_FIELD("order", 8),       \
      REQUEST_FIELD("gap", 9), REQUEST_FIELD("turn-cost", 10), REQUEST_FIELD("tour", 11),          \
      REQUEST_FIELD("pairings", 12), REQUEST_FIELD("nodes", 13),                                   \
      {"aims", required_argument, NULL, OPTION_AIMS},                                              \
      {"objective", required_argument, NULL, OPTION_OBJECTIVE},                                    \
      {"minimize", required_argument, NULL, OPTION_MINIMIZE},                                      \
      {"length-slack", required_argument, NULL, OPTION_SLACK},                                     \
      {"frontier", optional_argument, NULL, OPTION_FRONTIER},                                      \
      {"compare-shortest", no_argument, NULL, OPTION_COMPARE_SHORTEST},                            \
      {"plot", required_argument, NULL, OPTION_FRONTIER_PLOT},                                     \
      {"cords", required_argument, NULL, OPTION_CORDS},                                            \
      {"max-pull", required_argument, NULL, OPTION_MAX_PULL},                                      \
      {"hand", required_argument, NULL, OPTION_HAND},                                              \
      {"cord-strength", required_argument, NULL, OPTION_STRENGTH},                                 \
      {"balance", no_argument, NULL, OPTION_BALANCE},                                              \
  {                                                                                                \
    "ends", required_argument, NULL, OPTION_ENDS                                                   \
  }

#define AIMS_HELP                                                                                  \
  "      --aims LIST      what to minimize, first, second, ..: length; longest (cord), length; "   \
  "turning, max-turning (of the\n"                                                                 \
  "                       cord that turns most) or pull (as --minimize), as turning:sine with "    \
  "another price of turns, after\n"                                                                \
  "                       length+5%: at most so much above the least; or of symmetric plans "      \
  "overlap, steps, paths, turning\n"                                                               \
  "                       (default: length)\n"                                                     \
  "      --objective length|tortuosity|symmetry   the same: length, turning, or "                  \
  "overlap,steps,paths,turning; so do --balance\n"                                                 \
  "                       (longest first), --minimize, --turn-cost, --length-slack and --prefer\n"
#define CORDS_HELP                                                                                 \
  "      --ends closed|any|feet|FILE|NAME,..   both ends of a cord at one node (default), or "     \
  "anywhere, at feet, at these\n"                                                                  \
  "      --ends NAME:N,..  exactly so many cord ends at each of these nodes\n"                     \
  "      --cords K        K cords in every component, 1 to 1000 (default: 1);  A..B, ..B: at "     \
  "most B;  auto: with --max-length\n"                                                             \
  "                       or --max-pull\n"                                                         \
  "      --max-length L   no cord longer than L units, as few as it takes\n"                       \
  "      --max-pull F     no cord needs more at its ends, both pulled: F newtons, or 20x the "     \
  "seating tension; few cords\n"                                                                   \
  "      --hand one|two|N   the same: 50 newtons (one hand), 100 (two) or N\n"                     \
  "      --cord-strength N   refuse cords that would break: N newtons, of which an overhand knot " \
  "leaves 45 %\n"                                                                                  \
  "      --balance        make the longest cord short\n"                                           \
  "      --cover N        at least N passes over every interface (default: 1)\n"                   \
  "      --capacity N     at most N; --bore and --cord-diameter together: as many as fit\n"        \
  "      --distinct N     at least N different cords over every interface: two hold planar "       \
  "faces, three any (thesis);\n"                                                                   \
  "                       --cover and --cords are N if not given\n"                                \
  "      --engine auto|lp|matching   what finds the shortest passes (default: auto)\n"             \
  "      --confirm auto|always|never  does GLPK find the same length, exactly? auto: asked for a " \
  "second at most\n"                                                                               \
  "      --joint solid|tube   node beads are rigid pieces (default), or the cord ties the edges "  \
  "together at every node\n"
#define TURNING_HELP                                                                               \
  "Least turning (with --objective tortuosity):\n"                                                 \
  "      --length-slack P%   at most P % more cord than the shortest; 0 = the least turning "      \
  "among the shortest (default: any)\n"                                                            \
  "      --minimize turning|max-turning|pull   of all cords together, of the cord that turns "     \
  "most (default with several), or\n"                                                              \
  "                       what the hand feels: what an end of the cord that is hardest to pull "   \
  "at both ends has to overcome\n"                                                                 \
  "      --turn-cost " THR_TURN_COSTS                                                              \
  "   price of a turn: its angle (default), the sine of half of it, or 1 from 90\n"                \
  "                       degrees on, or for a U-turn\n"                                           \
  "      --tour least|fleury|hierholzer   the least turning (default), or a classical tour "       \
  "through the shortest passes\n"                                                                  \
  "      --pairings keep|ignore   of a classical tour: keep to the cheapest pairing at every "     \
  "node, or not (default: keep)\n"                                                                 \
  "      --nodes N        end the search when its tree has N nodes, wherever it runs (default: "   \
  "only --time-limit ends it)\n"                                                                   \
  "      --frontier[=N]   also the trade-off between length and turning, at up to N lengths, 2 "   \
  "to 1000 (default: 9)\n"                                                                         \
  "      --plot FILE      with --frontier: a picture of it, pull against cord, as SVG\n"           \
  "      --compare-shortest  beside it the least turning among the shortest cords; with "          \
  "--length-slack 0 that of any length, "                                                          \
  "with\n"                                                                                         \
  "                       a classical tour the least turning: one more search, as long as the "    \
  "first\n"

typedef struct {
  thr_request asked;       /* rows of the table as they were given, the others as usual */
  const char *aims;        /* --aims; NULL: not said */
  bool objective_said;     /* --objective was */
  thr_objective objective; /* what the aims come to */
  bool balance;            /* --balance, or --aims, wants a short longest cord */
  bool minimize;           /* --minimize, or --aims, says which: */
  bool largest, pull;      /* max-turning or pull; the latter */
  const char *ends;
  int least, most;     /* cords; 0: not said */
  bool automatic;      /* --cords auto */
  bool cover_said;     /* --cover was given */
  double max_pull;     /* N, or times the seating tension; 0: not said */
  bool pull_is_factor; /* the latter */
  double hand;         /* N; 0: not said */
  double strength;     /* N; 0: not said */
  int frontier;        /* points; 0: none */
  bool compare;        /* --compare-shortest */
  const char *plot;    /* where the picture of the frontier goes; NULL: nowhere */
  const char *turning; /* the first option that is about turning; NULL: none */
  const char *spelled; /* an option that says a part of --aims; NULL: none */
  bool pairings_said;  /* --pairings was given */
} request_args;

request_args request_args_default(void);

/* Takes one of the options above; returns false if it is none of them. *ok becomes false if its
 * value was bad (printed). */
bool request_option(request_args *a, int option, const char *value, bool *ok);

/* Settles what --aims says, as the other options would, and checks whether all that was asked goes
 * together. *wanted becomes the request's aims, and what belongs to them. Returns -1, or prints and
 * returns the exit code. */
int request_args_check(request_args *a, symmetry_args *symmetry, thr_request *wanted);

/* Sets what was asked for that needs no framework in a request for an objective; what is about
 * turning or symmetry concerns that one objective only. */
void request_args_ask(const request_args *a, const symmetry_args *symmetry, thr_objective objective,
                      thr_request *request);

/* Sets what needs the framework: ends, numbers of cords, room, pull. The request holds cord and
 * beads already. Returns EXIT_OK or prints and returns the exit code. The caller frees
 * request->end_node and request->end_count. */
int request_args_apply(const request_args *a, const thr_frame *frame, thr_request *request);

/* Is the pull of cords limited? */
bool request_args_limits_pull(const request_args *a);

/* Was nothing asked for but a short cord? */
bool request_args_usual(const request_args *a);

/* ---- end_counts.c: `--ends NAME:N,..`: how many cord ends there are at each node. */

/* Reads "A:2,B:1" into counts[n_nodes]. Returns -1 if no node comes with a number; EXIT_OK; or
 * prints what is wrong and returns the exit code. */
int end_counts_parse(const thr_frame *frame, const char *ends, int *counts);

/* Finds the least and the most number of cords of any component that these ends make. Returns
 * EXIT_OK, or prints and returns the exit code if some component has no end or an odd number of
 * them. */
int end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most);

#endif
