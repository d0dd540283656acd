/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of `thread symmetries` and of `thread plan --objective symmetry` that say which
 * symmetry, and what counts first. */
#ifndef THR_CLI_SYMMETRY_ARGS_H
#define THR_CLI_SYMMETRY_ARGS_H

#include "cli/args/options.h"
#include "graph/plan/request.h"

typedef struct {
  thr_symmetry_options options;
  thr_aim prefer[THR_N_AIMS]; /* what counts first, second, .. */
} symmetry_args;

symmetry_args symmetry_args_default(void);

/* --group, --geometric, --prefer. */
extern const cli_option cli_symmetry_options[];

#endif
