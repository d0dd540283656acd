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
 * (cli/print/terms.c). */
#include "cli/cli.h"
#include "cli/print/print.h"
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/io/json.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
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

/* Appends what is verified of the turning of a plan that was made for it. Whether its length is the
 * shortest or not is another claim. */
static void put_turning(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;
  const char *cost = thr_turn_cost_name(plan->options.turning.cost);
  bool angles = plan->options.turning.cost == THR_TURN_ANGLE;

  if (!thr_wants_turning(&plan->options)) return;
  thr_text_printf(text, "; turning %.1f deg: ", thr_degrees(plan->metrics.turning));

  if (!claim->present) {
    thr_text_append(text, "nothing is claimed");
    return;
  }

  /* All cords together. */
  if (!angles) thr_text_printf(text, "price %.9g (%s), ", claim->price, cost);

  /* Optimal, or by how much the price may be above the least. */
  plain_put_proof(text, claim->optimal, claim->price, claim->lower_bound,
                  angles ? "nothing turns less" : "nothing has a lower price", "least possible");
  if (plan->n_cords == 1 && !thr_wants_largest(&plan->options)) return;

  /* The largest cord, as the request measures it: by pull, turning or price. */
  const bool pull = thr_wants_pull(&plan->options);
  thr_text_printf(text,
                  pull     ? "; the cord that is hardest to pull, %.1f deg before an end: "
                  : angles ? "; the cord that turns most, %.1f deg: "
                           : "; the dearest cord, %.6g: ",
                  angles ? thr_degrees(claim->largest) : claim->largest);
  plain_put_proof(text, claim->largest_optimal, claim->largest, claim->largest_bound,
                  pull     ? "it cannot be less"
                  : angles ? "it cannot turn less"
                           : "it cannot cost less",
                  "least possible");
}

/* Appends the group of a symmetric plan and what is to be learned. */
static void put_symmetry(thr_text *text, const thr_plan *plan)
{
  const thr_symmetry_record *record = &plan->symmetry;
  if (!record->present) return;
  thr_text_printf(text, "; group %s%sof order %d, %d unique %s, %g learned steps", record->name,
                  record->name[0] ? " " : "", record->order, record->unique_paths,
                  cli_plural(record->unique_paths, "path", "paths"), record->steps);
}

/* Appends what is verified of several cords where the plan was asked for it: the longest one, the
 * fewest possible, tied joints. */
static void put_cords(thr_text *text, const thr_plan *plan)
{
  const thr_cords_claim *claim = &plan->cords_claim;

  if (claim->present && thr_wants_balance(&plan->options)) {
    thr_text_printf(text, "; longest cord %.7g %s: ", claim->longest, plan->frame.units);
    plain_put_proof(text, claim->longest_optimal, claim->longest, claim->longest_bound,
                    "it can be no shorter", "shortest possible");
  }

  /* Fewer cords: whatever their pull, and within a limit on it. */
  if (claim->present) plain_put_fewest(text, plan, claim->fewest, " cords", "");
  if (plan->pull_claim.present)
    plain_put_fewest(text, plan, plan->pull_claim.fewest, " cords", " within that pull");
  if (plan->options.joint == THR_JOINT_TUBE) thr_text_append(text, "; every joint tied");
}

/* Appends, with --verbose, what the checker has added up: cuts of the length proof, branchings and
 * multipliers of the proof of turning. */
static void put_machinery(thr_text *text, const thr_plan *plan)
{
  const thr_turning_proof *tree = &plan->turning.tree;
  int cuts = thr_length_proof_cuts(&plan->proof), branchings = tree->n_nodes / 2;

  if (!cli_verbose || !plan->proof.present) return;

  thr_text_printf(text, "  certificate: %d %s, at least %.6f %s", cuts, cli_cuts_word(plan, cuts),
                  plan->proof.lower_bound, plan->frame.units);

  /* A branching has two children: b branchings make a tree of 2 b + 1 nodes. */
  if (plan->turning.present)
    thr_text_printf(text, "; of the turning: %d %s, %d %s", branchings,
                    cli_plural(branchings, "branching", "branchings"), tree->n_duals,
                    cli_plural(tree->n_duals, "multiplier set", "multiplier sets"));
  thr_text_append(text, "\n");
}

/* Appends, with --verbose and solid joints, how many pieces hold channels that cross inside
 * them. */
static void put_crossings(thr_text *text, const thr_plan *plan)
{
  thr_channels channels = {0};

  if (!cli_verbose || plan->options.joint != THR_JOINT_SOLID) return;

  /* A failure is reported by whoever writes the text. */
  if (thr_channels_make(&channels, plan, NULL))
    text->failed = true;
  else
    thr_text_printf(text,
                    "  pieces: %d, %d of them with cords that cross inside (%" PRId64 " %s)\n",
                    plan->frame.n_nodes, channels.crossed, channels.crossings,
                    cli_plural((int)channels.crossings, "crossing", "crossings"));
  thr_channels_destroy(&channels);
}

/* Appends what a plan that holds says of itself, a line and its terms. */
static void put_verdict(thr_text *text, const char *path, const thr_plan *plan)
{
  const thr_metrics *metrics = &plan->metrics;
  const char *units = plan->frame.units;

  thr_text_append_clean(text, path);
  thr_text_printf(text, ": holds: %d %s, %d passes, every edge covered, %.7g %s: ", plan->n_cords,
                  cli_plural(plan->n_cords, "cord", "cords"), metrics->passes, metrics->length,
                  units);

  /* Every claim with its proof. */
  if (plan->proof.present)
    plain_put_length_proof(text, plan);
  else
    thr_text_append(text, "nothing is claimed");
  put_cords(text, plan);
  put_turning(text, plan);
  put_symmetry(text, plan);
  thr_text_append(text, "\n");

  /* Among which plans the claims hold. */
  terms_put(text, plan);
  put_machinery(text, plan);
  put_crossings(text, plan);
}

/* Writes the claim on the turning, rad, and on the price of all turns. */
static void put_turning_json(thr_writer *writer, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;

  thr_write_number(writer, "turning", plan->metrics.turning);

  /* Bounds are on the price, which may be another measure than the angle. */
  if (!claim->present) return;
  thr_write_string(writer, "turning_status", claim->optimal ? "optimal" : "bound");
  thr_write_number(writer, "price", claim->price);
  thr_write_number(writer, "price_lower_bound", claim->lower_bound);
  thr_write_number(writer, "turning_gap", claim->gap);
  if (claim->length_limit >= 0) thr_write_number(writer, "length_limit", claim->length_limit);
}

/* Writes the claims on the longest cord and on the number of cords. */
static void put_cords_json(thr_writer *writer, const thr_cords_claim *claim)
{
  thr_write_number(writer, "longest", claim->longest);
  thr_write_number(writer, "longest_lower_bound", claim->longest_bound);
  if (claim->fewest > 0) thr_write_int(writer, "fewest_cords", claim->fewest);
}

/* Writes the group of a symmetric plan and what is to be learned. */
static void put_symmetry_json(thr_writer *writer, const thr_symmetry_record *record)
{
  thr_write_int(writer, "group_order", record->order);
  thr_write_int(writer, "unique_paths", record->unique_paths);
  thr_write_number(writer, "learned_steps", record->steps);
}

/* Writes all claims of a plan that holds. */
static void put_claims_json(thr_writer *writer, const thr_plan *plan)
{
  thr_write_number(writer, "length", plan->metrics.length);
  if (plan->proof.present) {
    thr_write_string(writer, "status", plan->proof.optimal ? "optimal" : "bound");
    thr_write_number(writer, "lower_bound", plan->proof.lower_bound);
    thr_write_number(writer, "gap", plan->proof.gap);
  }

  /* What only some plans claim. */
  if (plan->cords_claim.present) put_cords_json(writer, &plan->cords_claim);
  if (plan->pull_claim.present)
    thr_write_int(writer, "fewest_cords_for_pull", plan->pull_claim.fewest);

  /* Turning, symmetry, and the terms of all claims. */
  if (thr_wants_turning(&plan->options)) put_turning_json(writer, plan);
  if (plan->symmetry.present) put_symmetry_json(writer, &plan->symmetry);
  terms_put_json(writer, plan);
}

/* Writes the verdict on a plan as one line of JSON. err: what is wrong with the plan, code 0 if it
 * holds. */
static void put_json(thr_text *text, const char *path, const thr_plan *plan, const thr_err *err)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "plan", path);
  thr_write_bool(&writer, "ok", !err->code);

  /* A violation is about the plan, an error about this run. */
  if (err->code)
    thr_write_string(&writer, err->code == THR_EVIOLATED ? "violation" : "error", err->text);
  else
    put_claims_json(&writer, plan);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

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
static int put_one(const char *name, bool json, const thr_plan *plan, const thr_err *err, int code)
{
  thr_text text = {0};

  /* Errors other than violations were printed where they occurred. */
  if (json)
    put_json(&text, name, plan, err);
  else if (code > EXIT_VIOLATION)
    ; /* said already */
  else if (code)
    cli_error("%s", err->text);
  else if (!cli_quiet)
    put_verdict(&text, name, plan);

  int written = cli_write(&text, "-");

  return code ? code : written;
}

static const char *name_of(const char *path)
{
  return strcmp(path, "-") == 0 ? "stdin" : path;
}

/* Reads and checks one plan and prints the verdict. timed: the time follows from the size. Returns
 * an exit code. */
static int check_one(const char *path, bool json, bool timed)
{
  thr_plan plan;
  thr_err err = {0}, found = {0};
  thr_status st = thr_plan_read(&plan, path, &err);

  /* A stream's time begins when its size is known: some 200 bytes an edge. */
  if (timed && !st && guard_deadline() == 0) guard_allow(seconds_for(200. * plan.frame.n_edges));

  /* Messages of the checker get the name of the plan. */
  if (!st && (st = thr_check_plan(&plan, &found)))
    thr_fail(&err, st, "%s: %s", name_of(path), found.text);

  /* A claim that does not hold is a violation, anything else a failure of this run. */
  int code = st == THR_OK ? EXIT_OK : EXIT_VIOLATION;
  if (st && st != THR_EVIOLATED) code = cli_fail(&err);
  code = put_one(name_of(path), json, &plan, &err, code);
  thr_plan_destroy(&plan);

  return code;
}

/* Checks plans one after the other and returns the largest of their exit codes. */
static int check_all(char **path, int n, bool json, bool timed)
{
  int code = EXIT_OK;
  for (int i = 0; i < n; i++) {
    if (timed) announce(path[i], i);
    int one = check_one(path[i], json, timed);
    if (one > code) code = one;
  }
  return code;
}

/* Prints that a plan was not judged, which is a failure, and returns its exit code. */
static int put_unjudged(const char *name, bool json, const guard_end *end)
{
  thr_err err = {0};
  const char *more = end->reason == GUARD_TIME ? " (--time-limit allows more)" : "";
  thr_fail(&err, THR_ELIMIT, "%s: not checked: %s%s", name, end->why, more);
  cli_error("%s", err.text);
  return put_one(name, json, NULL, &err, end->reason == GUARD_DIED ? EXIT_INTERNAL : EXIT_LIMIT);
}

/* What was asked. */
typedef struct {
  guard_limits guard;
  bool json;
} check_arguments;

static const cli_option own_options[] = {{"json", .kind = CLI_FLAG,
                                          .offset = offsetof(check_arguments, json),
                                          .help = "one JSON line per plan"},
                                         {0}};
static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT,
     .help = "give up after S seconds, 0 = never (default: 7 for each plan of up to 20 MB)"},
    {0}};

/* Runs `thread check` and returns the largest exit code of all plans. */
int cmd_check(int argc, char **argv)
{
  static const cli_syntax syntax = {"check", intro, outro};
  check_arguments args = {.guard = guard_limits_default()};
  guard_end end;
  const cli_group groups[] = {{"Options", own_options, &args},
                              {NULL, time_options, &args.guard},
                              {NULL, guard_memory_options, &args.guard},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  code = EXIT_OK;

  if (optind == argc) return cli_usage("check", "which plan?");

  /* What cannot be judged in its time leaves the plans behind it to another process. */
  for (char **path = argv + optind, **last = argv + argc; path < last;) {
    /* A child for all plans that are left. */
    if (!guard_fork(&args.guard, &end))
      return check_all(path, (int)(last - path), args.json, args.guard.seconds < 0);

    /* The child judged all plans that were left, or could not say which one it was at. */
    if (end.reason == GUARD_DONE || end.reason == GUARD_INTERRUPTED || end.kept.length == 0) {
      const int one = guard_conclude(&end, "not verified");
      return one > code ? one : code;
    }

    /* It was ended at plan number end.kept; the ones before it were judged. */
    path += atoi(end.kept.data);
    const int one = put_unjudged(name_of(*path++), args.json, &end);
    if (one > code) code = one;
    thr_text_destroy(&end.kept);
  }

  return code;
}
