/* thread eval --calibrate: friction from weights at the bench, and the piece that they hang from. */
#ifndef THR_CLI_CALIBRATE_H
#define THR_CLI_CALIBRATE_H

#include <stdbool.h>

#define CALIBRATE_HELP                                                                                                           \
  "      --calibrate HANG,IN,OUT   no plan: friction from weights at the bench. HANG hangs from a cord that goes round\n"        \
  "                       90 degrees; IN at its other end just draws it up, OUT just lets it slip down. Several weighings\n"     \
  "                       with semicolons. With -o FILE it is kept for --physics FILE\n"                                         \
  "      --calibrate piece   a drawing of the piece to drill, true to size (SVG; -o FILE.stl: to print), by --bore mm\n"

/* value: of --calibrate; bore: mm, of the piece. Returns the exit code. */
int calibrate_run(const char *value, double bore, const char *output, bool json);

#endif
