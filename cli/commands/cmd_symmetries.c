/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread symmetries: the groups of a framework, and the best symmetric threading under each. */
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

typedef struct {
  cli_frame_args frame;
  symmetry_args symmetry;
  guard_limits guard;
  thr_request plan;
  const char *path, *ends;
  bool json;
} arguments;

static bool parse_joint(const char *value, thr_joint *joint)
{
  int i = 0;
  bool ok = cli_choose("symmetries", "--joint", value, thr_joint_name, 2, &i);
  *joint = (thr_joint)i;
  return ok;
}

static int parse(int argc, char **argv, arguments *a)
{
  int done, o;
  bool ok = true;
  double row_work = 0;
  *a = (arguments){.frame = cli_frame_args_default(),
                   .symmetry = symmetry_args_default(),
                   .guard = guard_limits_default(),
                   .plan = thr_request_default(),
                   .ends = "closed"};
  while ((o = cli_next_option(argc, argv, "symmetries", ":" CLI_COMMON_LETTERS CLI_PROCESSES_LETTER,
                              table, help, &done)) != -1) {
    if (!cli_frame_option(&a->frame, "symmetries", o, optarg, &ok) &&
        !symmetry_option(&a->symmetry, "symmetries", o, optarg, &ok) &&
        !guard_option(&a->guard, "symmetries", o, optarg, &ok)) {
      switch (o) {
      case 'j': ok = cli_processes_option("symmetries", optarg); break;
      case OPTION_ENDS: a->ends = optarg; break;
      case OPTION_COVER:
        ok = cli_int("symmetries", "--cover", optarg, 1, 100, &a->plan.cover);
        break;
      case OPTION_CAPACITY:
        ok = cli_int("symmetries", "--capacity", optarg, 1, 1000, &a->plan.capacity);
        break;
      case OPTION_JOINT: ok = parse_joint(optarg, &a->plan.joint); break;
      case OPTION_MU:
        ok = cli_double("symmetries", "--mu", optarg, 0, 10, &a->plan.physics.mu);
        break;
      case OPTION_ROW_WORK:
        ok = cli_double("symmetries", "--row-work", optarg, 1e-6, 1e9, &row_work);
        break;
      case OPTION_JSON: a->json = true; break;
      }
    }
    if (!ok) return EXIT_USAGE;
  }
  if (done >= 0) return done;
  if (optind + 1 != argc)
    return cli_usage("symmetries", optind == argc ? "which framework?" : "one framework at a time");
  if (a->plan.capacity > 0 && a->plan.capacity < a->plan.cover)
    return cli_usage("symmetries", "--capacity %d leaves no room for --cover %d", a->plan.capacity,
                     a->plan.cover);
  a->path = argv[optind];
  if (a->guard.seconds < 0) a->guard.seconds = row_work > 0 ? 0 : 20;
  a->plan.symmetry = a->symmetry.options;
  a->plan.symmetry.row_work = row_work;
  a->plan.aims.n = THR_N_AIMS;
  memcpy(a->plan.aims.aim, a->symmetry.prefer, sizeof a->symmetry.prefer);
  a->plan.time_limit = a->guard.seconds;
  return -1;
}

static void put_json(thr_text *text, const arguments *a, const thr_frame *framework,
                     const thr_symmetries *symmetries)
{
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_hash(&writer, "framework", thr_frame_hash(framework));
  thr_write_int(&writer, "nodes", framework->n_nodes);
  thr_write_int(&writer, "edges", framework->n_edges);
  thr_write_string(&writer, "units", framework->units);
  thr_write_string(&writer, "ends", thr_ends_name(a->plan.ends));
  thr_write_int(&writer, "cover", a->plan.cover);
  thr_write_string(&writer, "joint", thr_joint_name(a->plan.joint));
  symmetry_put_table_json(&writer, &a->plan, symmetries);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

static int print(const arguments *a, const thr_frame *framework, const thr_symmetries *symmetries)
{
  thr_text text = {0};
  if (a->json) {
    put_json(&text, a, framework, symmetries);
  } else {
    symmetry_put_head(&text, framework, &a->plan, symmetries);
    symmetry_put_table(&text, &a->plan, symmetries, symmetries->n);
  }
  return cli_write(&text, "-");
}

static int list_symmetries(arguments *a, const thr_frame *framework)
{
  thr_err err = {0};
  thr_symmetries symmetries;
  int code = cli_resolve_ends(a->ends, framework, &a->plan);
  if (code == EXIT_OK) {
    const thr_limits limits = cli_limits(a->plan.time_limit);
    thr_status st = thr_symmetries_find(framework, &a->plan, false, &limits, &symmetries, &err);
    cli_progress_end();
    if (!st || st == THR_ELIMIT) code = print(a, framework, &symmetries);
    if (code == EXIT_OK && st) code = cli_fail(&err);
    thr_symmetries_destroy(&symmetries);
  }
  free(a->plan.end_node);
  return code;
}

int cmd_symmetries(int argc, char **argv)
{
  arguments a;
  thr_frame framework;
  guard_end end;
  int code = parse(argc, argv, &a);
  if (code >= 0) return code;
  if (guard_fork(&a.guard, &end)) return guard_conclude(&end, "no threadings");
  if ((code = cli_read_frame(a.path, &a.frame, &framework))) return code;
  code = list_symmetries(&a, &framework);
  thr_frame_destroy(&framework);
  return code;
}
