/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread symmetries: finds the groups of a framework's symmetries and, under each, the best
 * threading that the group maps onto itself, and prints them as a table
 * (cli/print/symmetry_table.c).
 *
 * Rows are the subgroups of the framework's automorphisms up to conjugacy or, with --geometric, of
 * the isometries among them. A threading under a group is a path for each orbit of cords, to be
 * learned once, and its copies. A large group has few paths to be learned, but may need more cord.
 *
 * "Best" is an order of aims, --prefer: overlap, learned steps, paths, turning. All rows share the
 * time limit, 20 s. --row-work counts the work of each row instead of measuring its time, so that
 * the table is the same on every machine.
 *
 * Example: under C4v the 7 x 7 dome has a threading of 5 cords in 2 unique paths, 13 steps to
 * learn, with 23.7 % overlap instead of 14.3 % of the shortest plan. */
#include "cli/args/symmetry_args.h"
#include "cli/cli.h"
#include "cli/print/print.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "symmetry/symmetry.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "thread symmetries FRAME [options]: groups of symmetries, and the best symmetric threading "
    "under each\n\n"
    "Examples:\n"
    "  thread symmetries dome.obj --ends feet        how much is to be learned under each group, "
    "and at what price in cord\n"
    "  thread symmetries dome.obj --prefer turning   the threadings that turn least instead of the "
    "shortest\n"
    "  thread symmetries dome.obj --geometric 0.01   only mirrors, rotations, .. of the shape\n"
    "  thread plan dome.obj --objective symmetry --group 3   the plan of row 3\n\n"
    "Options:\n"
    "      --ends closed|any|feet|FILE|NAME,..   where cord ends may be, as for thread plan "
    "(default: closed)\n"
    "      --cover N        at least N passes over every interface (default: 1)\n"
    "      --capacity N     at most N passes through any edge (default: what the framework file "
    "says, or any number)\n"
    "      --joint solid|tube   tube: only edges are beads, and cords tie them at every node "
    "(default: solid)\n" SYMMETRY_HELP
    "      --mu X           friction, for the capstan factor (default: 0.2)\n"
    "      --time-limit S   for all groups together, 0 = no limit (default: 20, with --row-work "
    "none)\n"
    "      --row-work N     for each row so much work, counted and not measured (1 is some "
    "seconds): the same table on every\n"
    "                       machine (default: each row has a share of the time)\n" GUARD_MEMORY_HELP
        CLI_PROCESSES_HELP "      --json           as JSON\n" CLI_FRAME_HELP
    "  -q, --quiet          no notes and no progress       -v, --verbose  what the solver does     "
    "  -h, --help\n\n"
    "* marks the default choice of thread plan --objective symmetry. A step, what is to be "
    "learned, is a pass of a unique\n"
    "path or, with --ends any, an end of it. Read: the instructions for that; beads straight on "
    "are one, and so is what\n"
    "comes again turned, mirrored or moved along.\n"
    "Exit codes: 0 every row optimal by the solver's word, 2 usage, 3 bad input, 4 infeasible, 5 "
    "some rows not in\n"
    "time (table printed)\n";

enum {
  OPTION_ENDS = OPTION_SYMMETRY_FREE,
  OPTION_COVER,
  OPTION_CAPACITY,
  OPTION_JOINT,
  OPTION_MU,
  OPTION_ROW_WORK,
  OPTION_JSON
};

static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      CLI_FRAME_OPTIONS,
                                      SYMMETRY_OPTIONS,
                                      {"ends", required_argument, NULL, OPTION_ENDS},
                                      {"cover", required_argument, NULL, OPTION_COVER},
                                      {"capacity", required_argument, NULL, OPTION_CAPACITY},
                                      {"joint", required_argument, NULL, OPTION_JOINT},
                                      {"mu", required_argument, NULL, OPTION_MU},
                                      {"row-work", required_argument, NULL, OPTION_ROW_WORK},
                                      GUARD_OPTIONS,
                                      CLI_PROCESSES_OPTION,
                                      {"json", no_argument, NULL, OPTION_JSON},
                                      {NULL, 0, NULL, 0}};

/* The command line. Strings point into argv. */
typedef struct {
  cli_frame_args frame;
  symmetry_args symmetry;
  guard_limits guard;
  thr_request plan;
  const char *path, *ends;
  bool json;
} symmetries_arguments;

/* Parses the value of --joint. Returns false if it is bad (printed). */
static bool parse_joint(const char *value, thr_joint *joint)
{
  int i = 0;
  bool ok = cli_choose("symmetries", "--joint", value, thr_joint_name, 2, &i);
  *joint = (thr_joint)i;
  return ok;
}

/* Parses the command line into *args, and fills in the request that all rows are planned for.
 * Returns -1 to go on, or the exit code of the command. */
static int parse(int argc, char **argv, symmetries_arguments *args)
{
  int done, option;
  bool ok = true;
  double row_work = 0;

  *args = (symmetries_arguments){.frame = cli_frame_args_default(),
                                 .symmetry = symmetry_args_default(),
                                 .guard = guard_limits_default(),
                                 .plan = thr_request_default(),
                                 .ends = "closed"};
  while ((option =
              cli_next_option(argc, argv, "symmetries", ":" CLI_COMMON_LETTERS CLI_PROCESSES_LETTER,
                              table, help, &done)) != -1) {
    /* Options that several commands share, then those of this one. */
    if (!cli_frame_option(&args->frame, "symmetries", option, optarg, &ok) &&
        !symmetry_option(&args->symmetry, "symmetries", option, optarg, &ok) &&
        !guard_option(&args->guard, "symmetries", option, optarg, &ok)) {
      switch (option) {
      case 'j': ok = cli_processes_option("symmetries", optarg); break;
      case OPTION_ENDS: args->ends = optarg; break;
      case OPTION_COVER:
        ok = cli_int("symmetries", "--cover", optarg, 1, 100, &args->plan.cover);
        break;
      case OPTION_CAPACITY:
        ok = cli_int("symmetries", "--capacity", optarg, 1, 1000, &args->plan.capacity);
        break;
      case OPTION_JOINT: ok = parse_joint(optarg, &args->plan.joint); break;
      case OPTION_MU:
        ok = cli_double("symmetries", "--mu", optarg, 0, 10, &args->plan.physics.mu);
        break;
      case OPTION_ROW_WORK:
        ok = cli_double("symmetries", "--row-work", optarg, 1e-6, 1e9, &row_work);
        break;
      case OPTION_JSON: args->json = true; break;
      }
    }
    if (!ok) return EXIT_USAGE;
  }

  if (done >= 0) return done;

  /* One operand: the framework. */
  if (optind + 1 != argc)
    return cli_usage("symmetries", optind == argc ? "which framework?" : "one framework at a time");

  if (args->plan.capacity > 0 && args->plan.capacity < args->plan.cover)
    return cli_usage("symmetries", "--capacity %d leaves no room for --cover %d",
                     args->plan.capacity, args->plan.cover);

  args->path = argv[optind];

  /* Counted work needs no clock; else 20 s unless something was said. */
  if (args->guard.seconds < 0) args->guard.seconds = row_work > 0 ? 0 : 20;

  /* The request that all rows are planned for. */
  args->plan.symmetry = args->symmetry.options;
  args->plan.symmetry.row_work = row_work;
  args->plan.aims.n = THR_N_AIMS;
  memcpy(args->plan.aims.aim, args->symmetry.prefer, sizeof args->symmetry.prefer);
  args->plan.time_limit = args->guard.seconds;

  return -1;
}

/* Writes the table with what it was made for. */
static void put_json(thr_text *text, const symmetries_arguments *args, const thr_frame *framework,
                     const thr_symmetries *symmetries)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);

  /* Of which framework. */
  thr_write_hash(&writer, "framework", thr_frame_hash(framework));
  thr_write_int(&writer, "nodes", framework->n_nodes);
  thr_write_int(&writer, "edges", framework->n_edges);
  thr_write_string(&writer, "units", framework->units);

  /* What was asked for. */
  thr_write_string(&writer, "ends", thr_ends_name(args->plan.ends));
  thr_write_int(&writer, "cover", args->plan.cover);
  thr_write_string(&writer, "joint", thr_joint_name(args->plan.joint));

  symmetry_put_table_json(&writer, &args->plan, symmetries);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Prints the table to stdout: all rows, with a head that says which group they are subgroups of.
 * Returns an exit code. */
static int print(const symmetries_arguments *args, const thr_frame *framework,
                 const thr_symmetries *symmetries)
{
  thr_text text = {0};

  /* As text every row is shown, not only those round the chosen one. */
  if (args->json) {
    put_json(&text, args, framework, symmetries);
  } else {
    symmetry_put_head(&text, framework, &args->plan, symmetries);
    symmetry_put_table(&text, &args->plan, symmetries, symmetries->n);
  }

  return cli_write(&text, "-");
}

/* Finds and prints the table. Returns an exit code; a table that is not proved is printed all the
 * same. */
static int list_symmetries(symmetries_arguments *args, const thr_frame *framework)
{
  thr_err err = {0};
  thr_symmetries symmetries;
  int code = cli_resolve_ends(args->ends, framework, &args->plan);

  /* Where cord ends may be needs the framework. */
  if (code == EXIT_OK) {
    /* The time is that of all groups together. */
    const thr_limits limits = cli_limits(args->plan.time_limit);
    thr_status st = thr_symmetries_find(framework, &args->plan, false, &limits, &symmetries, &err);
    cli_progress_end();

    /* Rows that are not proved say so. */
    if (!st || st == THR_ELIMIT) code = print(args, framework, &symmetries);
    if (code == EXIT_OK && st) code = cli_fail(&err);
    thr_symmetries_destroy(&symmetries);
  }

  free(args->plan.end_node);

  return code;
}

/* Runs `thread symmetries` and returns the exit code. */
int cmd_symmetries(int argc, char **argv)
{
  symmetries_arguments args;
  thr_frame framework;
  guard_end end;
  int code = parse(argc, argv, &args);

  if (code >= 0) return code;

  /* The child does all of the work. */
  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "no threadings");
  if ((code = cli_read_frame(args.path, &args.frame, &framework))) return code;
  code = list_symmetries(&args, &framework);
  thr_frame_destroy(&framework);

  return code;
}
