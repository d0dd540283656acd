/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that several commands have. */
#ifndef THR_ARGS_H
#define THR_ARGS_H

#include "cli/cli.h"
#include "graph/plan/physics.h"

#include <getopt.h>
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

/* ---- listing.c: The options of a command as its help lists them: what completions and man pages
 * are made from. */

typedef struct {
  char name[32];     /* without dashes */
  char letter;       /* '\0' = none */
  char value[64];    /* "FILE", "solid|tube"; "" = takes none */
  const char *text;  /* what the help says of it in this line; not ended .. */
  int length;        /* .. after so many bytes */
  const char *below; /* the line after this one; in it may stand what the values mean */
} cli_listed;

/* The next option of the table that the help lists from *at on, and moves *at behind it; false:
 * there is none. An option is listed where "-x, --name" or "--name" stands at the beginning of a
 * line, indented, or after two blanks or more. */
bool cli_listed_next(const char **at, const struct option *table, cli_listed *out);

/* Hands over the words that the option's value may be: "a|b|FILE" has a and b; of others, those
 * that lines below begin with. */
void cli_listed_values(const cli_listed *option, void (*take)(void *user, const char *word),
                       void *user);

/* ---- physics_args.c: The options that describe cord and beads, made from the table in
 * graph/plan/physics.h. Shared by eval, compare and plan. */

enum { CLI_PHYSICS_MOST = 64 };

/* What was given, in order. */
typedef struct {
  int n;
  struct {
    int option;
    const char *value;
  } given[CLI_PHYSICS_MOST];
} cli_physics;

/* cli_next_option for a command with these options beside its own: they are taken here, their help
 * is printed after the command's. */
int cli_physics_option(cli_physics *a, int argc, char **argv, const char *command,
                       const char *letters, const struct option *own, const char *help, int *done);

/* Lays what was given over *physics: presets and files first, then single quantities, each in the
 * order given. Returns EXIT_OK or prints and returns the code. */
int cli_physics_apply(const cli_physics *a, thr_physics *physics);

/* The i-th option that was given, as it is spelled, without "--". */
void cli_physics_spell(const cli_physics *a, int i, char name[24]);

#endif
