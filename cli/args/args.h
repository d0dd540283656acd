/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have. */
#ifndef THR_ARGS_H
#define THR_ARGS_H

#include "cli/args/options.h"
#include "cli/cli.h"
#include "graph/plan/physics.h"

#include <stdbool.h>

/* ---- config.c: --config FILE: options from a file, as if they stood before those of the command
 * line. */

/* A file of lines: "name = value" or "name", an option as on the command line without its dashes;
 * "[command]": what follows is for this command only; "# comment". What stands before any [command]
 * is for every command.
 *
 * Puts the file's options for the command argv[1] behind it, as --name=value, in place of --config
 * FILE; what else stands there comes after, and so wins. *argc and *argv are the new ones, which
 * live as long as the program. Returns EXIT_OK, or prints and returns the code. */
int cli_config(int *argc, char ***argv);

/* The name of the file that the word argv[i] of the command came from; NULL: the user typed it. */
const char *cli_config_of(int i);

/* ---- physics_args.c: The options that describe cord and beads, made from the table in
 * graph/plan/physics.h. Shared by eval, compare and plan. */

enum { CLI_PHYSICS_MOST = 64 };

/* What was given, in order. */
typedef struct {
  int n;
  struct {
    const cli_option *option;
    const char *value;
  } given[CLI_PHYSICS_MOST];
} cli_physics;

#define CLI_PHYSICS_HEADING "Cord and beads (default: what the plan says, else what stands here)"

/* The rows: a preset, a file, and a row for each quantity; into a cli_physics. */
const cli_option *cli_physics_options(void);

/* Lays what was given over *physics: presets and files first, then single quantities, each in the
 * order given. Returns EXIT_OK or prints and returns the code. */
int cli_physics_apply(const cli_physics *a, thr_physics *physics);

#endif
