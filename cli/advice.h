/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints advice on the number of cords beside a plan: shared by `thread advise` and by the last
 * lines of `thread plan`. */
#ifndef THR_CLI_ADVICE_H
#define THR_CLI_ADVICE_H

#include "cli/args/args.h"
#include "cli/cli.h"

/* The options that were given of how FRAME is read and of what cord and beads are, each with a
 * blank before it, for a shell. */
void advice_command_options(const cli_physics *physics, thr_text *text);

/* Returns limits for so many seconds by the clock, 0 = none, silent but for --verbose; and for so
 * much counted work, 0 = any. Seconds below 0: as much work as advice is usually given, which *work
 * becomes. *work stays while the limits are used. */
thr_limits advice_limits(double seconds, double *work);

/* The lines that say that the plan's pull is beyond a hand, and what is not, as `thread advise`
 * recommends it, which takes up to its usual seconds: nothing where it is not beyond a hand. path:
 * of the framework, as typed. */
void advice_put_after_plan(const thr_plan *plan, const char *path, const cli_physics *physics,
                           thr_text *text);

/* Appends, where a plan that was asked for with options is beyond a hand, which option takes the
 * fewest cords that are not. Nothing where a limit on the pull was given. */
void advice_put_hint(const thr_plan *plan, thr_text *text);

#endif
