/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread eval --calibrate: computes frictions from weights and tilted boards at the bench, and
 * draws the piece that the weights hang from. */
#ifndef THR_CLI_CALIBRATE_H
#define THR_CLI_CALIBRATE_H

#include <stdbool.h>

/* value: of --calibrate; bore: mm, of the piece. Returns the exit code. */
int calibrate_run(const char *value, double bore, const char *output, bool json);

#endif
