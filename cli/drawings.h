/* The documents that are made from a plan, one table for all: what they are called, and writing one or all of them. */
#ifndef THR_CLI_DRAWINGS_H
#define THR_CLI_DRAWINGS_H

#include "cli/cli.h"

int drawings_count(void);
const char *drawings_type(int i); /* as --type names it: "svg", "steps.csv" */
const char *drawings_file(int i); /* usual file name: "overview.svg" */

/* Writes document i of the plan to path ("-" = stdout); pitch and colour are the overview's. Returns EXIT_OK or prints and
 * returns the code. */
int drawings_write(const thr_plan *p, int i, const char *path, double pitch_mm, thr_overview_colour colour);

/* Writes all of them into folder, which is made if needed, under their usual names; stops at the first that fails. */
int drawings_write_all(const thr_plan *p, const char *folder, double pitch_mm, thr_overview_colour colour);

#endif
