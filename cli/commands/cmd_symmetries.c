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
#include "cli/args/args.h"
#include "cli/cli.h"
#include "cli/print/print.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lib/lib.h"
#include "symmetry/symmetry.h"

#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread symmetries FRAME [options]: groups of symmetries, the best threading under each\n\n"
    "Examples:\n"
    "  thread symmetries dome.obj --ends feet        what is to be learned, and for how much cord\n"
    "  thread symmetries dome.obj --prefer turning   threadings that turn least, not the shortest\n"
    "  thread symmetries dome.obj --geometric 0.01   only mirrors, rotations, .. of the shape\n"
    "  thread plan dome.obj --objective symmetry --group 3   the plan of row 3\n";
static const char outro[] =
    "* marks the default choice of thread plan --objective symmetry. A step, what is to be "
    "learned, is a pass of a unique path or, with --ends any, an end of it. Read: the instructions "
    "for that; beads straight on are one, and so is what comes again turned, mirrored or moved "
    "along. May be less: the first value of which it is not proved that no threading under this "
    "group has less.\n"
    "Exit codes: 0 every row proved, 2 usage, 3 bad input, 4 infeasible, 5 some rows not proved, "
    "or "
    "not in time (table printed)";

/* The command line. Strings point into argv. */
typedef struct {
  cli_frame_args frame;
  symmetry_args symmetry;
  guard_limits guard;
  thr_request plan;
  const char *path, *ends;
  double row_work; /* counted, for each row; 0: not said */
} symmetries_arguments;

#define AT(member) .offset = offsetof(symmetries_arguments, member)

static const cli_option own_options[] = {
    {"ends", .value = "closed|any|feet|FILE|NAME,..", .kind = CLI_TEXT, AT(ends),
     .help = "where cord ends may be, as for thread plan (default: closed)"},
    {"mu", .value = "X", .kind = CLI_AMOUNT, AT(plan.physics.mu), .high = 10,
     .help = "friction, cord on bead, for the pull in the table (default: 0.2)"},
    {0}};

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT, .help = "for all groups together, 0 = no limit (default: 20, with --tune "
                               "row-work none)"},
    {0}};

/* For each row so much work, counted and not measured (1 is some seconds): the same table on every
 * machine. Else each row has a share of the time. */
static const cli_option tuned_options[] = {
    {"row-work", .kind = CLI_AMOUNT, AT(row_work), .low = 1e-6, .high = 1e9}, {0}};

/* Parses the command line into *args, and fills in the request that all rows are planned for.
 * Returns -1 to go on, or the exit code of the command. */
static int parse(int argc, char **argv, symmetries_arguments *args)
{
  static const cli_syntax syntax = {"symmetries", intro, outro};
  static cli_option asked[4];
  *args = (symmetries_arguments){.frame = cli_frame_args_default(),
                                 .symmetry = symmetry_args_default(),
                                 .guard = guard_limits_default(),
                                 .plan = thr_request_default(),
                                 .ends = "closed"};
  asked[0] = request_option_of("cover");
  asked[1] = request_option_of("capacity");
  asked[2] = request_option_of("joint");
  const cli_group groups[] = {{"Options", own_options, args},
                              {NULL, asked, &args->plan},
                              {NULL, cli_symmetry_options, &args->symmetry},
                              {NULL, time_options, &args->guard},
                              {NULL, guard_memory_options, &args->guard},
                              {NULL, cli_processes_options, NULL},
                              {"Framework", cli_frame_options, &args->frame},
                              {cli_tuned, tuned_options, args},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* One operand: the framework. */
  if (optind + 1 != argc)
    return cli_usage("symmetries", optind == argc ? "which framework?" : "one framework at a time");

  if (args->plan.capacity > 0 && args->plan.capacity < args->plan.cover)
    return cli_usage("symmetries", "--capacity %d leaves no room for --cover %d",
                     args->plan.capacity, args->plan.cover);

  args->path = argv[optind];

  /* Counted work needs no clock; else 20 s unless something was said. */
  if (args->guard.seconds < 0) args->guard.seconds = args->row_work > 0 ? 0 : 20;

  /* The request that all rows are planned for. */
  args->plan.symmetry = args->symmetry.options;
  args->plan.symmetry.row_work = args->row_work;
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
  thr_symmetries_put_json(&writer, framework, &args->plan, symmetries);
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
  if (cli_json) {
    put_json(&text, args, framework, symmetries);
  } else {
    symmetry_put_head(&text, framework, &args->plan, symmetries);
    symmetry_put_table(&text, &args->plan, symmetries, symmetries->n);
  }

  return print_text(&text);
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
    cli_step("looking for symmetries", "");
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
