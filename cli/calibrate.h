/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread eval --calibrate: computes frictions from weights and tilted boards at the bench, and
 * draws the piece that the weights hang from. */
#ifndef THR_CLI_CALIBRATE_H
#define THR_CLI_CALIBRATE_H

#include <stdbool.h>

#define CALIBRATE_HELP                                                                             \
  "      --calibrate HANG,IN,OUT   no plan: friction from weights at the bench. HANG hangs from "  \
  "a cord that goes round\n"                                                                       \
  "                       90 degrees; IN at its other end just draws it up, OUT just lets it "     \
  "slip down. Several weighings\n"                                                                 \
  "                       with semicolons. With -o FILE it is kept for --physics FILE\n"           \
  "      --calibrate bead=DEGREES,..   likewise, also together: a piece slides on others that "    \
  "lie on a board tilted by\n"                                                                     \
  "                       that (mu_bead); ground=DEGREES,..: on what the feet stand on "           \
  "(mu_ground)\n"                                                                                  \
  "      --calibrate piece   a drawing of the piece to drill, true to size (SVG; -o FILE.stl: to " \
  "print), by --bore mm\n"

/* Runs --calibrate. value: as given; bore: mm, of the piece; output: NULL = stdout. Returns the
 * exit code. */
int calibrate_run(const char *value, double bore, const char *output, bool json);

#endif
