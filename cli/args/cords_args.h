/* The options of `thread plan` that say how many cords there are, how long, where they end and what fits through a bead. */
#ifndef THR_CLI_CORDS_ARGS_H
#define THR_CLI_CORDS_ARGS_H

#include "cli/args/symmetry_args.h"
#include "cli/args/turning_args.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"

enum {
  OPTION_CORDS = OPTION_SYMMETRY_FREE,
  OPTION_CORDS_MAX_LENGTH,
  OPTION_CORDS_MAX_PULL,
  OPTION_CORDS_HAND,
  OPTION_CORDS_STRENGTH,
  OPTION_CORDS_BALANCE,
  OPTION_CORDS_COVER,
  OPTION_CORDS_CAPACITY,
  OPTION_CORDS_DISTINCT,
  OPTION_CORDS_JOINT,
  OPTION_CORDS_ENDS,
  OPTION_CORDS_ENGINE,
  OPTION_CORDS_CONFIRM,
  OPTION_CORDS_FREE
};
#define CORDS_OPTIONS                                                                                                            \
  {"cords", required_argument, NULL, OPTION_CORDS}, {"max-length", required_argument, NULL, OPTION_CORDS_MAX_LENGTH},            \
      {"max-pull", required_argument, NULL, OPTION_CORDS_MAX_PULL}, {"hand", required_argument, NULL, OPTION_CORDS_HAND},        \
      {"cord-strength", required_argument, NULL, OPTION_CORDS_STRENGTH}, {"balance", no_argument, NULL, OPTION_CORDS_BALANCE},   \
      {"cover", required_argument, NULL, OPTION_CORDS_COVER}, {"capacity", required_argument, NULL, OPTION_CORDS_CAPACITY},      \
      {"distinct", required_argument, NULL, OPTION_CORDS_DISTINCT}, {"joint", required_argument, NULL, OPTION_CORDS_JOINT},      \
      {"engine", required_argument, NULL, OPTION_CORDS_ENGINE}, {"confirm", required_argument, NULL, OPTION_CORDS_CONFIRM},      \
  {                                                                                                                              \
    "ends", required_argument, NULL, OPTION_CORDS_ENDS                                                                           \
  }
#define CORDS_HELP                                                                                                               \
  "      --ends closed|any|feet|FILE|NAME,..   both ends of a cord at one node (default), or anywhere, at feet, at these\n"      \
  "      --ends NAME:N,..  exactly so many cord ends at each of these nodes\n"                                                   \
  "      --cords K        K cords in every component, 1 to 1000 (default: 1);  A..B, ..B: at most B;  auto: with --max-length\n" \
  "                       or --max-pull\n"                                                                                       \
  "      --max-length L   no cord longer than L units, as few as it takes\n"                                                     \
  "      --max-pull F     no cord needs more at its ends, both pulled: F newtons, or 20x the seating tension; few cords\n"       \
  "      --hand one|two|N   the same: 50 newtons (one hand), 100 (two) or N\n"                                                   \
  "      --cord-strength N   refuse cords that would break: N newtons, of which an overhand knot leaves 45 %\n"                  \
  "      --balance        make the longest cord short\n"                                                                         \
  "      --cover N        at least N passes over every interface (default: 1)\n"                                                 \
  "      --capacity N     at most N; --bore and --cord-diameter together: as many as fit\n"                                      \
  "      --distinct N     at least N different cords over every interface: two hold planar faces, three any (thesis);\n"         \
  "                       --cover and --cords are N if not given\n"                                                              \
  "      --engine auto|lp|matching   what finds the shortest passes (default: auto)\n"                                           \
  "      --confirm auto|always|never  does GLPK find the same length, exactly? auto: asked for a second at most\n"               \
  "      --joint solid|tube   node beads are rigid pieces (default), or the cord ties the edges together at every node\n"

typedef struct {
  const char *ends;
  int cover;              /* as thr_request; 0 = not said */
  int capacity, distinct; /* as thr_request */
  int least, most;        /* cords; 0 = not said */
  bool automatic;         /* --cords auto */
  double max_length;      /* 0 = not said */
  double max_pull;        /* N, or times the seating tension; 0 = not said */
  bool pull_is_factor;
  double hand, strength; /* N; 0 = not said */
  bool balance;
  thr_joint joint;
  thr_engine engine;
  thr_confirm confirm;
} cords_args;

cords_args cords_args_default(void);

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad (printed). */
bool cords_option(cords_args *a, int option, const char *value, bool *ok);

/* Does what was asked make sense together, and with the aims of what is wanted? -1, or prints and returns the code. */
int cords_args_check(const cords_args *a, const turning_args *turning, const thr_request *wanted);

/* What of these options plans with such aims cannot do: a few words like "--balance", or NULL. */
const char *cords_args_refused(const cords_args *a, const thr_request *wanted);

/* Is anything asked that takes as many cords as needed, and is the pull limited? */
bool cords_args_few(const cords_args *a);
bool cords_args_limits_pull(const cords_args *a);

/* Lays them over *options, which holds cord and beads already, for this framework. Returns EXIT_OK or prints and returns the
 * code. The caller frees options->end_node and options->end_count. */
int cords_args_apply(const cords_args *a, const thr_frame *frame, thr_request *options);

#endif
