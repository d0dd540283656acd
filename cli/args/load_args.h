/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of what acts on the structure beside weight and cords: loads, a tilted ground, held feet.
 */
#ifndef THR_LOAD_ARGS_H
#define THR_LOAD_ARGS_H

#include "cli/args/options.h"
#include "cli/cli.h"
#include "eval/eval.h"
#include "graph/framework/frame.h"

enum { LOAD_MOST_PULLS = 32 };

typedef struct {
  const char *load; /* as given; NULL = none */
  double pulls[LOAD_MOST_PULLS], tilt, azimuth;
  int n_pulls, rays;
  bool clamped, taut;
} load_args;

/* --load, --load-pulls, --tilt, --clamp-feet, --taut; --tune rays. */
extern const cli_option cli_load_options[], cli_load_tuned[];

/* Does anything act on the structure beside weight and cords? */
bool load_any(const load_args *a);
/* Sets options; *load receives [n_nodes] that the caller frees. EXIT_OK, or prints and returns the
 * code. */
int load_apply(const load_args *a, const thr_frame *frame, thr_eval_options *options,
               double (**load)[3]);

#endif
