/* The options that describe cord and beads, made from the table in graph/plan/physics.h. Shared by eval, compare and plan. */
#ifndef THR_CLI_PHYSICS_H
#define THR_CLI_PHYSICS_H

#include "cli/cli.h"
#include "graph/plan/physics.h"

enum { CLI_PHYSICS_MOST = 64 };

/* What was given, in order. */
typedef struct {
  int n;
  struct {
    int option;
    const char *value;
  } given[CLI_PHYSICS_MOST];
} cli_physics;

/* cli_next_option for a command with these options beside its own: they are taken here, their help is printed after the
 * command's. */
int cli_physics_option(cli_physics *a, int argc, char **argv, const char *command, const char *letters, const struct option *own,
                       const char *help, int *done);

/* Lays what was given over *physics: presets and files first, then single quantities, each in the order given. Returns EXIT_OK or
 * prints and returns the code. */
int cli_physics_apply(const cli_physics *a, thr_physics *physics);

/* The i-th option that was given, as it is spelled, without "--". */
void cli_physics_spell(const cli_physics *a, int i, char name[24]);

#endif
