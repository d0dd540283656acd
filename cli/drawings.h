/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the documents that are made from a plan: one of them, or all into a folder, where they
 * have their usual names (lib/documents.h has the table). Shared by `thread draw` and `thread
 * plan`. */
#ifndef THR_CLI_DRAWINGS_H
#define THR_CLI_DRAWINGS_H

#include "cli/cli.h"
#include "diagram/scene/scene.h"

/* How documents are drawn. */
typedef struct {
  double pitch_mm;            /* of the overview; 0 = automatic */
  thr_overview_colour colour; /* of the overview */
  double
      kind_tolerance; /* pieces that differ by no more are of a kind, in units; 0 = the usual one */
  double working_mm;  /* cord that is worked with at a time; 0 = the usual one */
  int page;           /* of the step sheets: thr_page_size */
  int needles; /* that cords are threaded with in the step sheets: 1, 2 = from their middle; 0 = not
                  said */
  thr_line_options lines; /* of cords for CAD */
  bool quick;             /* all documents means all but the step sheets of too many pieces */
} drawings_args;

/* With more pieces step sheets are hundreds of pages, which nobody prints unasked. */
enum { DRAWINGS_SHEETS_PIECES = 1000, DRAWINGS_NAMES = 128 };

/* --kind-tolerance; --page, --from, --working-length: of the step sheets. */
extern const cli_option drawings_options[];

/* Writes document i of the plan to path ("-" = stdout). Returns EXIT_OK or prints and returns the
 * code. */
int drawings_write(const thr_plan *plan, int i, const char *path, const drawings_args *a);

/* Writes all of them into folder, which is made if needed, under their usual names; stops at the
 * first that fails, and with EXIT_LIMIT, printed, where the time of the command is over. */
int drawings_write_all(const thr_plan *plan, const char *folder, const drawings_args *a);

/* Compares the names of document i, or of all that drawings_write_all may write (i = -1), in folder
 * with the files that this command reads and writes (cli/files.c). Returns EXIT_OK, or prints which
 * one would be lost and returns EXIT_USAGE. */
int drawings_claim(const char *command, const char *folder, int i);

/* Returns whether one of all documents, or the plan, would take the place of such a file. */
bool drawings_would_lose(const char *folder);

/* Appends how many pieces hang loose in a chain at most while the plan is threaded: "longest loose
 * chain: 8 pieces". */
thr_status drawings_chains(const thr_plan *plan, const drawings_args *a, thr_text *text,
                           thr_err *err) THR_MUST_CHECK;

/* Returns whether drawings_write_all leaves out the step sheets. */
bool drawings_no_sheets(const thr_plan *plan, const drawings_args *a);

/* Fills names with what drawings_write_all writes: "overview.svg steps.txt". */
void drawings_names(const thr_plan *plan, const drawings_args *a, char names[DRAWINGS_NAMES]);

#endif
