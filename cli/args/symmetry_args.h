/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of `thread symmetries` and of `thread plan --objective symmetry` that say which
 * symmetry, and what counts first. */
#ifndef THR_CLI_SYMMETRY_ARGS_H
#define THR_CLI_SYMMETRY_ARGS_H

#include "cli/pull.h"
#include "graph/plan/request.h"

enum {
  OPTION_SYMMETRY_GROUP = OPTION_PULL_FREE,
  OPTION_SYMMETRY_GEOMETRIC,
  OPTION_SYMMETRY_PREFER,
  OPTION_SYMMETRY_FREE
};
#define SYMMETRY_OPTIONS                                                                           \
  {"group", required_argument, NULL, OPTION_SYMMETRY_GROUP},                                       \
      {"geometric", required_argument, NULL, OPTION_SYMMETRY_GEOMETRIC},                           \
  {                                                                                                \
    "prefer", required_argument, NULL, OPTION_SYMMETRY_PREFER                                      \
  }
#define SYMMETRY_HELP                                                                              \
  "      --group ID|NAME  the threading under this group: its number in the table of `thread "     \
  "symmetries`, or its name (C4v)\n"                                                               \
  "      --geometric TOL  only symmetries of the shape: each node within TOL of the framework's "  \
  "size, 0 to 1 (default: those\n"                                                                 \
  "                       of the graph, whatever its shape)\n"                                     \
  "      --prefer overlap,steps,paths,turning   what counts first, second, .. under each group; "  \
  "the others follow\n"

typedef struct {
  thr_symmetry_options options;
  thr_aim prefer[THR_N_AIMS]; /* what counts first, second, .. */
  bool preferred;             /* --prefer was given */
  const char *given;          /* the first of these options; NULL = none */
} symmetry_args;

symmetry_args symmetry_args_default(void);

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad
 * (printed). */
bool symmetry_option(symmetry_args *a, const char *command, int option, const char *value,
                     bool *ok);

#endif
