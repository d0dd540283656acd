/* What `thread plan` minimizes: --aims, and --objective, which with --minimize, --turn-cost, --length-slack, --balance and
 * --prefer spells the same. */
#ifndef THR_CLI_AIMS_ARGS_H
#define THR_CLI_AIMS_ARGS_H

#include "cli/args/cords_args.h"
#include "graph/plan/request.h"

enum { OPTION_AIMS = OPTION_CORDS_FREE, OPTION_OBJECTIVE, OPTION_AIMS_FREE };
#define AIMS_OPTIONS                                                                                                             \
  {"aims", required_argument, NULL, OPTION_AIMS},                                                                                \
  {                                                                                                                              \
    "objective", required_argument, NULL, OPTION_OBJECTIVE                                                                       \
  }
#define AIMS_HELP                                                                                                                \
  "      --aims LIST      what to minimize, first, second, ..: length; longest (cord), length; turning, max-turning (of the\n"   \
  "                       cord that turns most) or pull (as --minimize), as turning:sine with another price of turns, after\n"   \
  "                       length+5%: at most so much above the least; or of symmetric plans overlap, steps, paths, turning\n"    \
  "                       (default: length)\n"                                                                                   \
  "      --objective length|tortuosity|symmetry   the same: length, turning, or overlap,steps,paths,turning; so do --balance\n"  \
  "                       (longest first), --minimize, --turn-cost, --length-slack and --prefer\n"

typedef struct {
  const char *aims;        /* NULL = not said */
  thr_objective objective; /* what the aims come to */
  bool given;              /* --objective was */
} aims_args;

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad (printed). */
bool aims_option(aims_args *a, int option, const char *value, bool *ok);

/* What --aims says, if it was given, as the other options would. -1, or prints and returns the code. */
int aims_args_settle(aims_args *a, turning_args *turning, symmetry_args *symmetry, cords_args *cords);

/* Aims, turning and symmetry of a request for this objective: what was said of another concerns it not. */
void aims_args_apply(const aims_args *a, const turning_args *turning, const symmetry_args *symmetry, const cords_args *cords,
                     thr_objective objective, thr_request *options);

#endif
