/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread check: verifies everything that plans say, without any solver: coverage, ends, metrics,
 * and the proofs of length, turning, number of cords, tensions and holding (graph/check/check.h).
 *
 * Plans are checked one after the other in a guarded child process with so much time for each: 7 s
 * for every 20 MB, unless --time-limit says otherwise. A plan that cannot be judged in its time or
 * memory ends that process; the plans after it are checked by another one.
 *
 * Example: `thread check a.json b.json` prints a line for each plan: "a.json: holds: 1 cord, 96
 * passes, every edge covered, 1995.249 mm: proved: nothing shorter exists", and its terms
 * (cli/print/verdict.c). */
#include "cli/cli.h"
#include "cli/print/print.h"
#include "graph/check/check.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char intro[] =
    "thread check PLAN.. [options]: verify coverage, ends, lengths and proofs, without a solver\n\n"
    "Examples:\n"
    "  thread check plan.json\n"
    "  thread plan dome.obj -o - | thread check -\n";
static const char outro[] =
    "-q prints nothing for plans that hold; -v what proofs are made of, and crossings.\n"
    "Exit codes: 0 all plans hold, 1 a violation (printed with its place), 2 usage, 3 not a plan, "
    "5 not verified in the time or memory";

/* Returns the seconds that a plan of so many bytes may take if nobody said: 7 for each 20 MB, as
 * docs/plan-format.md promises, and never less. */
static double seconds_for(double bytes)
{
  return fmax(1, bytes / 20e6) * 7;
}

/* Returns the size of a file in bytes, or -1 for a stream. */
static double file_size(const char *path)
{
  struct stat about;
  return strcmp(path, "-") != 0 && stat(path, &about) == 0 && S_ISREG(about.st_mode)
             ? (double)about.st_size
             : -1;
}

/* Tells the waiting process that plan i of this child is next, and what time it has. Of a stream
 * the size is not known: reading it may take any time. */
static void announce(const char *path, int i)
{
  thr_text number = {0};
  const double bytes = file_size(path);
  thr_text_printf(&number, "%d", i);
  guard_keep(&number);
  guard_allow(bytes < 0 ? 0 : seconds_for(bytes));
  thr_text_destroy(&number);
}

/* Prints the verdict on one plan and returns the exit code, which is `code` unless printing
 * fails. */
static int put_one(const char *name, const thr_plan *plan, const thr_err *err, int code)
{
  thr_text text = {0};

  /* Errors other than violations were printed where they occurred. */
  if (cli_json)
    verdict_put_json(&text, name, plan, err, code);
  else if (code > EXIT_VIOLATION)
    ; /* said already */
  else if (code)
    cli_error("%s", err->text);
  else if (!cli_quiet)
    verdict_put(&text, name, plan);

  int written = print_text(&text);

  return code ? code : written;
}

static const char *name_of(const char *path)
{
  return strcmp(path, "-") == 0 ? "stdin" : path;
}

/* Reads and checks one plan and prints the verdict. timed: the time follows from the size. Returns
 * an exit code. */
static int check_one(const char *path, bool timed)
{
  thr_plan plan;
  thr_err err = {0}, found = {0};
  cli_step("checking", name_of(path));
  thr_status st = thr_plan_read(&plan, path, &err);

  /* A stream's time begins when its size is known: some 200 bytes an edge. */
  if (timed && !st && guard_deadline() == 0) guard_allow(seconds_for(200. * plan.frame.n_edges));

  /* Messages of the checker get the name of the plan. */
  if (!st && (st = thr_check_plan(&plan, &found)))
    thr_fail(&err, st, "%s: %s", name_of(path), found.text);

  /* A claim that does not hold is a violation, anything else a failure of this run. */
  int code = st == THR_OK ? EXIT_OK : EXIT_VIOLATION;
  if (st && st != THR_EVIOLATED) code = cli_fail(&err);
  code = put_one(name_of(path), &plan, &err, code);
  thr_plan_destroy(&plan);

  return code;
}

/* Checks plans one after the other and returns the largest of their exit codes. */
static int check_all(char **path, int n, bool timed)
{
  int code = EXIT_OK;
  for (int i = 0; i < n; i++) {
    if (timed) announce(path[i], i);
    int one = check_one(path[i], timed);
    if (one > code) code = one;
  }
  return code;
}

/* Prints that a plan was not judged, which is a failure, and returns its exit code. */
static int put_unjudged(const char *name, const guard_end *end)
{
  thr_err err = {0};
  const char *more = end->reason == GUARD_TIME ? " (--time-limit allows more)" : "";
  thr_fail(&err, THR_ELIMIT, "%s: not checked: %s%s", name, end->why, more);
  cli_error("%s", err.text);
  return put_one(name, NULL, &err, end->reason == GUARD_DIED ? EXIT_INTERNAL : EXIT_LIMIT);
}

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT,
     .help = "give up after S seconds, 0 = never (default: 7 for each plan of up to 20 MB)"},
    {0}};

/* Runs `thread check` and returns the largest exit code of all plans. */
int cmd_check(int argc, char **argv)
{
  static const cli_syntax syntax = {"check", intro, outro};
  guard_limits limits = guard_limits_default();
  guard_end end;
  const cli_group groups[] = {
      {"Options", time_options, &limits}, {NULL, guard_memory_options, &limits}, {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  code = EXIT_OK;

  if (optind == argc) return cli_usage("check", "which plan?");

  /* What cannot be judged in its time leaves the plans behind it to another process. */
  for (char **path = argv + optind, **last = argv + argc; path < last;) {
    /* A child for all plans that are left. */
    if (!guard_fork(&limits, &end)) return check_all(path, (int)(last - path), limits.seconds < 0);

    /* The child judged all plans that were left, or could not say which one it was at. */
    if (end.reason == GUARD_DONE || end.reason == GUARD_INTERRUPTED || end.kept.length == 0) {
      const int one = guard_conclude(&end, "not verified");
      return one > code ? one : code;
    }

    /* It was ended at plan number end.kept; the ones before it were judged. */
    path += atoi(end.kept.data);
    const int one = put_unjudged(name_of(*path++), &end);
    if (one > code) code = one;
    thr_text_destroy(&end.kept);
  }

  return code;
}
