/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes the options of the methods that measure the pull of a plan, and runs these methods. Shared
 * by eval, compare and plan.
 *
 * --pull says which ends are pulled: one word for all cords, "start", "end" or "both", or a list
 * that names cords, "A=start,B=none", in which cords that are not named are pulled at both ends.
 * Whether there are such cords is known only when a plan is read, so that the value is kept as text
 * until then.
 *
 * What is said of cord and beads on the command line takes the place of what is stored in the plan;
 * sizes that nobody said follow from the framework (graph/plan/physics.h).
 *
 * Measured joints are cached in a folder, so that the next evaluation with the same cord and beads
 * takes no time; results do not depend on that. */
#define _POSIX_C_SOURCE 200809L

#include "cli/commands/commands.h"
#include "graph/framework/frame.h"
#include "graph/number.h"
#include "graph/os.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void pull_args_init(pull_args *args, thr_method method)
{
  *args = (pull_args){.options = thr_eval_options_default(), .method = method, .pull = "both"};
  args->options.processes = cli_processes();
  thr_os_cache_folder(args->cache, sizeof args->cache);
}

/* Finds the pull of that name, n letters long. Returns false if there is none. */
static bool pull_by_name(const char *value, size_t n, thr_pull *pull)
{
  for (int i = 0; i < THR_N_PULLS; i++) {
    const char *name = thr_pull_name(i);
    if (strlen(name) != n || strncmp(value, name, n) != 0) continue;
    *pull = (thr_pull)i;
    return true;
  }
  return false;
}

/* Parses the next item of a list such as A=start,B=none and moves *list behind it. Returns false at
 * the end of the list; *ok becomes false if the item is no such thing or ends the list with a
 * comma. */
static bool parse_next_pull(const char **list, char id[12], thr_pull *pull, bool *ok)
{
  if (!**list) return false;

  /* n: length of the item; letters: of the cord's id before "=". */
  size_t n = strcspn(*list, ","), letters = strcspn(*list, "=,");
  *ok = letters > 0 && letters < 12 && letters < n &&
        pull_by_name(*list + letters + 1, n - letters - 1, pull);

  if ((*list)[n] == ',' && !(*list)[n + 1]) *ok = false;

  /* A bad item names no cord. */
  snprintf(id, 12, "%.*s", *ok ? (int)letters : 0, *list);
  *list += n;
  *list += **list == ',';

  return true;
}

/* Returns whether the cord that the list names last before `end` was named earlier, too. */
static bool is_named_twice(const char *value, const char *end, const char id[12])
{
  thr_pull pull;
  char other[12];
  bool ok;
  for (const char *list = value; parse_next_pull(&list, other, &pull, &ok) && list != end;)
    if (strcmp(other, id) == 0) return true;
  return false;
}

/* Takes a value of --pull: a word, or a list without a cord that is named twice; or newtons. */
static bool take_pull(void *into, const cli_option *option, const char *value)
{
  const char *command = cli_command_name();
  pull_args *args = into;
  thr_pull pull;
  char id[12];
  (void)option;
  if (thr_number_parse(value, strlen(value), &args->newtons) && args->newtons > 0 &&
      args->newtons <= 1e6)
    return true;
  args->newtons = 0;
  args->pull = value;
  bool ok = pull_by_name(value, strlen(value), &pull) && pull != THR_PULL_NONE;

  /* A list. */
  if (!ok && strchr(value, '=')) {
    const char *list = value;
    for (ok = true; ok && parse_next_pull(&list, id, &pull, &ok);) {
      if (!ok || !is_named_twice(value, list, id)) continue;
      cli_usage(command, "--pull %s: cord %s is there twice", value, id);
      return false;
    }
  }

  if (!ok)
    cli_usage(command, "--pull %s: expected start, end or both, or a list like A=none,B=both",
              value);

  return ok;
}

const char *pull_method_name(int method)
{
  return method < THR_N_METHODS ? thr_method_name(method) : method == THR_BY_RISE ? "rise" : "all";
}

/* A whole number that JSON can hold. */
static bool take_seed(void *into, const cli_option *option, const char *value)
{
  const double most = 9007199254740992.0; /* 2^53 */
  double seed;
  (void)option;
  if (!cli_double(cli_command_name(), "--seed", value, 0, most, &seed)) return false;
  ((pull_args *)into)->options.seed = (uint64_t)seed;
  if (seed == floor(seed)) return true;
  cli_usage(cli_command_name(), "--seed %s: expected a whole number", value);
  return false;
}

static bool take_cache(void *into, const cli_option *option, const char *value)
{
  (void)option;
  ((pull_args *)into)->options.cache = value;
  if (!*value)
    cli_usage(cli_command_name(), "--cache: an empty name is no folder; --no-cache does without");
  return *value != '\0';
}

#define AT(member) .offset = offsetof(pull_args, member)

const cli_option pull_run_options[] = {
    {"cache", .value = "DIR", .kind = CLI_OTHER, .take = take_cache,
     .help = "keep measured joints here (default: $XDG_CACHE_HOME/thread or ~/.cache/thread)"},
    {"no-cache", .kind = CLI_FLAG, AT(no_cache),
     .help = "keep no measured joints, and measure anew"},
    {0}};

const cli_option pull_options[] = {
    {"law", .kind = CLI_WORD, AT(options.law), .word = thr_law_name, .n_words = THR_N_LAWS,
     .help = "of method capstan: exp(mu x turning), or the mitred bead of the thesis (default: "
             "capstan)"},
    {"pull", .value = "start|end|both", .kind = CLI_OTHER, .take = take_pull,
     .help = "which end of each cord is pulled (default: both); or A=start,B=none for single "
             "cords; rise: newtons, the most that hands pull every end with (default: 50)"},
    {"seed", .value = "N", .kind = CLI_OTHER, .take = take_seed,
     .help = "number of the small disorder that a simulation begins with, 0 to 2^53 (default: 0; "
             "rise: 1, of the first run)"},
    {0}};

/* Factors on the simulation's validated time step and iterations. */
const cli_option pull_tuned[] = {
    {"time-step", .kind = CLI_AMOUNT, AT(options.time_step), .low = 0.01, .high = 10},
    {"iterations", .kind = CLI_AMOUNT, AT(options.iterations), .low = 0.1, .high = 100},
    {0}};

/* Refuses options that would be ignored. */
int pull_check(const pull_args *args, const char *command)
{
  bool closed = args->method == THR_CAPSTAN || strcmp(command, "compare") == 0;

  /* thread compare shows the closed form whatever the method. */
  if (args->options.law != THR_LAW_CAPSTAN && !closed)
    return cli_usage(command, "--law is for --method capstan");

  /* Which ends, or how hard. */
  if (args->newtons > 0 && args->method != THR_BY_RISE)
    return cli_usage(command,
                     "--pull %s: expected start, end or both, or a list like A=none,B=both",
                     cli_given_value("pull"));
  if (args->method == THR_BY_RISE && cli_given("pull") && !(args->newtons > 0))
    return cli_usage(command, "--pull %s: --method rise pulls every end; expected newtons, as 20",
                     args->pull);

  return EXIT_OK;
}

/* Finds the pull of each cord of a plan. *out is owned by the caller, NULL if all cords are pulled
 * alike. Returns an exit code. */
static int resolve_pulls(const pull_args *args, const char *path, const thr_plan *plan,
                         thr_eval_options *options, thr_pull **out)
{
  const char *list = args->pull;
  char id[12];
  thr_pull pull = THR_PULL_BOTH;
  bool ok;

  *out = NULL;
  if (pull_by_name(list, strlen(list), &options->pull)) return EXIT_OK;
  if (!(*out = thr_calloc((size_t)plan->n_cords, sizeof **out))) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }

  /* A list: cords that it does not name are pulled at both ends. */
  for (int i = 0; i < plan->n_cords; i++)
    (*out)[i] = THR_PULL_BOTH;

  /* The list was checked when the option was taken, so that only unknown cords are left to
   * refuse. */
  while (parse_next_pull(&list, id, &pull, &ok)) {
    int i = 0;
    while (i < plan->n_cords && strcmp(plan->cord[i].id, id) != 0)
      i++;
    if (i == plan->n_cords) {
      cli_error("--pull %s: %s has no cord %s; the last of its cords is %s", args->pull, path, id,
                plan->cord[plan->n_cords - 1].id);
      return EXIT_INPUT;
    }

    (*out)[i] = pull;
  }

  /* At least one cord must be pulled. */
  for (int i = 0; i < plan->n_cords; i++)
    if ((*out)[i] != THR_PULL_NONE) options->cord_pull = *out;

  return options->cord_pull ? EXIT_OK
                            : cli_usage(cli_command_name(), "--pull %s: no cord of %s is pulled",
                                        args->pull, path);
}

/* Notes, once, that a very short edge makes every cord thin: sizes that were not said follow from
 * the edges (graph/plan/physics.h). */
static void note_thin_cord(const thr_frame *frame, const thr_physics *asked,
                           const thr_physics *resolved)
{
  static bool said;
  thr_edge_sizes sizes;

  /* Sizes are good, or the plan would not have been resolved. */
  if (said || asked->cord_diameter > 0 || thr_measure_edges(frame, &sizes, NULL)) return;
  if (!sizes.in_mm || resolved->cord_diameter >= thr_usual_cord(&sizes)) return;

  /* Once for all plans and methods of this run. */
  said = true;
  cli_note("note: the cord is taken to be %.3g mm thick, as the edge from %s to %s is only %.3g mm "
           "long; --cord-diameter says it",
           resolved->cord_diameter, frame->name[frame->edge[sizes.shortest_edge][0]],
           frame->name[frame->edge[sizes.shortest_edge][1]], sizes.shortest);
}

int pull_eval(const pull_args *args, const char *path, const thr_plan *plan, thr_method method,
              thr_eval *out)
{
  thr_err err = {0}, found = {0};
  thr_eval_options options = args->options;
  thr_pull *pulls = NULL;

  *out = (thr_eval){0};

  /* What is stored in the plan, then what the command line says. */
  options.physics = plan->options.physics;
  if (!options.cache && args->cache[0]) options.cache = args->cache;
  if (args->no_cache) options.cache = NULL;
  int code = cli_physics_apply(&args->physics, &options.physics);
  if (!code) code = resolve_pulls(args, path, plan, &options, &pulls);
  if (code) {
    free(pulls);
    return code;
  }

  thr_limits limits = cli_limits(0);
  cli_step("measuring the pull of", path);
  thr_status st = thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, method, &options, &limits,
                                out, &found);
  free(pulls);
  cli_progress_end();

  /* Stopped: measured joints are kept for the next run. */
  if (st == THR_ELIMIT) {
    int kept = options.cache && !out->cache_failed ? out->joints_measured : 0;

    if (method == THR_JOINT)
      cli_note("note: %s: %d %s kept in the cache for the next run", path, kept,
               cli_plural(kept, "joint is", "joints are"));
    return EXIT_LIMIT;
  }

  if (!st) {
    if (method != THR_CAPSTAN) note_thin_cord(&plan->frame, &options.physics, &out->record.physics);

    /* A folder that cannot be written is no reason to fail. */
    if (out->cache_failed)
      cli_note("note: measured joints could not be kept in %s; --cache names another folder",
               options.cache);
    return EXIT_OK;
  }

  /* Messages begin with the name of the plan. */
  thr_fail(&err, st, "%s: %s", path, found.text);

  return cli_fail(&err);
}

int pull_read_schedule(const char *value, const thr_plan *plan, thr_schedule *schedule)
{
  thr_text text = {0};
  thr_err err = {0};

  if (!value) return EXIT_OK;
  const bool file = !strchr(value, ':');

  /* A schedule has a colon in every step, a file name has none. */
  thr_status st = file ? thr_text_read_plain(&text, value, &err) : THR_OK;
  if (!file) thr_text_append(&text, value);
  if (!st && text.failed) st = thr_nomem(&err);

  if (!st)
    st = thr_schedule_parse(schedule, plan, text.data, text.length, file ? value : "--schedule",
                            &err);

  thr_text_destroy(&text);

  return st ? cli_fail(&err) : EXIT_OK;
}

void pull_unknown_cords(const thr_plan *plan, const thr_evaluation *evaluation, thr_text *text)
{
  enum { MOST = 12 };
  int n = 0;

  /* At most 12 cords are named. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (evaluation->cord[i].known) continue;
    if (n < MOST) thr_text_printf(text, "%s%s", n ? ", " : "", plan->cord[i].id);
    n++;
  }

  if (n > MOST) thr_text_printf(text, " and %d more", n - MOST);
}
