/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread compare: evaluates plans of one framework, prints them side by side and ranks them by how
 * hard they are to pull.
 *
 * A value of a plan is an interval: a measured pull has a relative error, a limit analysis proves a
 * lower and finds an upper pull. Two plans whose intervals overlap tie (lib/ranking.c). There
 * is one ranking for each question that was asked: the seating pull by the closed form and by
 * simulated joints, the holding pull, the force in any state, what is left after a schedule, what a
 * load needs and what is carried (docs/method.md, "Comparing"); or what comes up in simulation
 * (lib/compare_rise.c).
 *
 * Example: two plans with seating pulls of 12.3 N (+-0.4 %) and 12.33 N (+-0.5 %) tie; 12.3 N and
 * 14.1 N do not.
 *
 * Order of work: read all plans, refuse loads and schedules that do not fit one of them, evaluate
 * every method for every plan, print. */
#include "cli/args/args.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "eval/rise/rise.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lib/comparison.h"
#include "lib/rise_pieces.h"

#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread compare PLAN.. [options]: plans of one framework side by side; * marks the best\n\n"
    "Examples:\n"
    "  thread compare closed.json feet.json --mu 0.3           by pull, joints measured in "
    "simulation\n"
    "  thread compare closed.json feet.json --method capstan   by the closed form, at once\n"
    "  thread compare data/dome7-*.json --method all           by either, and by when they stand\n"
    "  thread compare data/dome7-*.json --method structure --load D4=1   by what they carry\n"
    "  thread compare data/dome7-*.json --method rise --seeds 5   by whether they come up, and "
    "how\n";
static const char outro[] =
    "A difference within the measured error is a tie; so are runs of --method rise that overlap. "
    "That "
    "method makes the pieces of every plan and simulates them as `thread rise` does: a minute of a "
    "processor for 49 pieces and a run. `thread rise` says more of each plan, and has more "
    "options.";

/* What acts on the structures beside the pull: a load, leaning ground and the like, and a
 * schedule. */
typedef struct {
  load_args load;
  const char *schedule; /* as given; NULL: none */
} structure_actions;

/* What --method rise is asked, beside the pull. */
typedef struct {
  int seeds;
  thr_rise_start start;
  bool let_down;
} compare_rises;

/* A plan with its evaluations (lib/comparison.h). */
typedef thr_compare_entry entry;

/* Reads the plans into entries[n]. Pulls can be compared on one framework only: another one is an
 * error, other feet are not. Returns an exit code. */
static int read_entries(char **path, int n, entry *entries)
{
  for (int i = 0; i < n; i++) {
    entries[i].path = path[i];
    int code = cli_read_plan(path[i], &entries[i].plan);
    if (code) return code;

    /* Plans of other feet can be ranked, but the user should know. */
    thr_err err = {0};
    if (thr_compare_framework(&entries[i], &entries[0], &err)) return cli_fail(&err);
    if (thr_frame_hash(&entries[i].plan.frame) != thr_frame_hash(&entries[0].plan.frame))
      cli_note("note: %s has other feet than %s: each stands, and ends its cords, on its own",
               path[i], path[0]);
  }

  return EXIT_OK;
}

/* Turns loads and schedule into nodes and cords of one plan. *load receives newtons at each node,
 * or NULL; the caller frees it, and the schedule. */
static int read_actions(const structure_actions *actions, const entry *candidate,
                        thr_eval_options *options, thr_schedule *schedule, double (**load)[3])
{
  const int code = pull_read_schedule(actions->schedule, &candidate->plan, schedule);
  return code ? code : load_apply(&actions->load, &candidate->plan.frame, options, load);
}

/* Returns EXIT_OK if loads and schedule fit every plan, before any time is spent on evaluating
 * one. */
static int try_actions(const structure_actions *actions, const entry *entries, int n)
{
  int code = EXIT_OK;

  for (int i = 0; i < n && !code; i++) {
    thr_eval_options options = thr_eval_options_default();
    thr_schedule schedule = {0};
    double(*load)[3] = NULL;

    /* What they came to is not needed yet. */
    code = read_actions(actions, &entries[i], &options, &schedule, &load);
    thr_schedule_destroy(&schedule);
    free(load);
  }

  return code;
}

/* Evaluates one plan by one method. Loads and schedules are of method structure alone. Returns an
 * exit code. */
static int evaluate_one(const pull_args *args, const structure_actions *actions, thr_method method,
                        entry *candidate)
{
  pull_args plain = *args;
  thr_schedule schedule = {0};
  double(*load)[3] = NULL;
  int code = EXIT_OK;

  if (method == THR_STRUCTURE)
    code = read_actions(actions, candidate, &plain.options, &schedule, &load);
  if (schedule.n > 0) plain.options.schedule = &schedule;
  if (!code)
    code = pull_eval(&plain, candidate->path, &candidate->plan, method, &candidate->eval[method]);

  thr_schedule_destroy(&schedule);
  free(load);

  return code;
}

/* Evaluates every wanted method for every plan. One that fails for a plan leaves the values
 * unknown, its message printed; but nothing can be compared if not even the closed form is known,
 * or if the user has stopped the work. Returns the first exit code that is not EXIT_OK. */
static int evaluate(const pull_args *args, const structure_actions *actions, entry *entries, int n)
{
  int worst = EXIT_OK;

  for (int method = 0; method < THR_N_METHODS; method++)
    for (int i = 0; i < n && thr_compare_wants(args->method, (thr_method)method); i++) {
      int code = evaluate_one(args, actions, (thr_method)method, &entries[i]);

      /* An interrupt, or a plan without even a closed form, ends the work. */
      if (code == EXIT_LIMIT || (code && method == THR_CAPSTAN)) return code;
      if (!worst) worst = code;

      /* Plans of different physics can be ranked, but the user should know. */
      if (i > 0 && method == THR_CAPSTAN && !thr_compare_same_physics(&entries[i], &entries[0]))
        cli_note("note: %s has its own cord and beads, other than %s: give --mu and the like to "
                 "compare like with like",
                 entries[i].path, entries[0].path);
    }

  return worst;
}

/* Lets all plans rise. Returns an exit code, of what failed first. */
static int evaluate_rises(const pull_args *args, const compare_rises *asked, entry *entries, int n)
{
  const thr_limits limits = cli_limits(0);
  const thr_compare_rise_asked runs = {.seeds = asked->seeds,
                                       .start = asked->start,
                                       .let_down = asked->let_down,
                                       .seed = cli_given("seed") ? args->options.seed : 1,
                                       .pull = args->newtons > 0 ? args->newtons : thr_rise_hand,
                                       .time_step = args->options.time_step,
                                       .processes = cli_processes()};
  thr_err err = {0};
  int code = EXIT_SUCCESS;
  for (int i = 0; i < n && !code; i++)
    code = rise_apply_physics(&args->physics, &entries[i].plan);
  if (code) return code;

  const thr_status st = thr_compare_rises(entries, n, &runs, &limits, &err);
  cli_progress_end();
  for (int i = 0; i < n; i++) {
    thr_err why = {0};
    if (!entries[i].rise.why.code) continue;
    thr_fail(&why, entries[i].rise.why.code, "%s: %s", entries[i].path, entries[i].rise.why.text);
    const int failed = cli_fail(&why);
    if (!code) code = failed;
  }
  return st == THR_ELIMIT ? EXIT_LIMIT : st ? cli_fail(&err) : code;
}

/* Draws the plans side by side with pull, cord and number of cords, and writes the picture to path.
 * Returns an exit code. */
static int write_plot(const pull_args *args, const entry *entries, int n, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0}, note = {0};
  thr_compare_column *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = column ? THR_OK : thr_nomem(&err);

  compare_put_note(&note, args, entries, n);
  if (note.failed && !st) st = thr_nomem(&err);

  /* A column per plan, with the band of its pull by the closed form. */
  for (int i = 0; i < n && !st; i++) {
    const thr_eval *eval = &entries[i].eval[THR_CAPSTAN];
    column[i] = (thr_compare_column){
        .name = entries[i].path,
        .plan = &entries[i].plan,
        .pull = {eval->band[0], thr_compare_largest(&entries[i], THR_CAPSTAN), eval->band[1]},
        .frontier = thr_compare_on_frontier(entries, n, i)};
  }

  if (!st) st = thr_compare_svg(column, n, note.data, &svg, &err);
  free(column);
  thr_text_destroy(&note);

  return cli_write_drawn(st, &svg, path, &err);
}

/* Makes the rankings and prints the comparison to stdout, as text or JSON. Returns an exit code. */
static int print(const pull_args *args, const entry *entries, int n)
{
  thr_err err = {0};
  thr_text text = {0};
  thr_ranking rankings[THR_COMPARE_RANKINGS] = {{0}};
  int count = 0;
  const char **name = thr_calloc((size_t)n, sizeof *name);
  thr_status st =
      name ? thr_compare_rank(args->method, entries, n, rankings, &count, &err) : thr_nomem(&err);

  /* Plans are named by their files. */
  if (!st) {
    for (int i = 0; i < n; i++)
      name[i] = entries[i].path;
    thr_writer writer = {.out = &text};
    if (cli_json) {
      thr_write_object(&writer, NULL);
      thr_compare_put_json(&writer, args->method, entries, n, rankings, count, name);
      answer_put_files(&writer);
      thr_write_close(&writer);
      thr_text_append(&text, "\n");
    } else
      compare_put_text(&text, args, entries, n, rankings, count, name);
  }

  for (int i = 0; i < THR_COMPARE_RANKINGS; i++)
    thr_ranking_destroy(&rankings[i]);
  free(name);

  return st ? cli_fail(&err) : print_text(&text);
}

/* Does the work of the command. plot: where the picture goes, NULL = nowhere. Returns the exit
 * code: the first one of reading, evaluating and drawing, unless printing fails. */
static int compare(const pull_args *args, const structure_actions *actions,
                   const compare_rises *rise, char **path, int n, entry *entries, const char *plot)
{
  int code = read_entries(path, n, entries);

  if (code) return code;
  if ((code = try_actions(actions, entries, n))) return code;

  /* If the last plan has no closed form, nothing can be compared. */
  code = evaluate(args, actions, entries, n);
  if (code && code != EXIT_LIMIT && !entries[n - 1].eval[THR_CAPSTAN].record.present) return code;

  /* An interrupt ends the work; what is known is printed all the same. */
  if (code != EXIT_LIMIT && args->method == THR_BY_RISE) {
    const int ended = evaluate_rises(args, rise, entries, n);
    if (!code || ended == EXIT_LIMIT) code = ended;
  }

  for (int i = 0; i < n; i++)
    thr_compare_measure(&entries[i]);
  for (int i = 0; i < n && !cli_json; i++)
    thr_text_clean(path[i]); /* the files are read; what follows is for people */

  /* A picture on stdout leaves no place for the table. */
  int drawn = plot ? write_plot(args, entries, n, plot) : EXIT_OK;
  if (!code) code = drawn;
  answer_file(plot, "the plans side by side");
  int printed = plot && strcmp(plot, "-") == 0 ? EXIT_OK : print(args, entries, n);
  if (code == EXIT_LIMIT) cli_error("stopped: what is - above is not known");

  return printed ? printed : code;
}

/* Refuses options that would be ignored. Sets the default pull for a load (10 N). Returns an exit
 * code. */
static int check_actions(const pull_args *args, structure_actions *actions)
{
  const bool structure = thr_compare_wants(args->method, THR_STRUCTURE),
             any = load_any(&actions->load) || actions->schedule;

  /* Options of method structure. */
  if (!structure && (any || actions->load.rays || actions->load.taut))
    return cli_usage("compare",
                     "--load, --tilt, --clamp-feet, --taut, --tune rays and --schedule are "
                     "of --method structure or all");

  if (actions->schedule && !*actions->schedule)
    return cli_usage("compare", "--schedule: an empty one does nothing");

  /* A load and the pull at which it hangs. */
  if (actions->load.n_pulls && !actions->load.load)
    return cli_usage("compare", "--load-pulls needs --load");
  if (actions->load.n_pulls > 1)
    return cli_usage("compare", "--load-pulls: one pull, to rank by what is carried at it");

  if (actions->load.load && !actions->load.n_pulls)
    actions->load.pulls[actions->load.n_pulls++] = 10;

  return EXIT_OK;
}

/* What was asked. */
typedef struct {
  pull_args pull;
  guard_limits guard;
  structure_actions actions;
  compare_rises rise;
  int start; /* of rise */
  const char *plot;
} compare_arguments;

#define AT(member) .offset = offsetof(compare_arguments, member)

static const cli_option own_options[] = {
    {"method", .value = "joint|capstan|structure|rise|all", .kind = CLI_WORD, AT(pull.method),
     .word = pull_method_name, .n_words = THR_BY_ALL + 1,
     .help = "what to rank by (default: joint; all: by the first three); the closed form is always "
             "shown beside it"},
    {"schedule", .value = "TEXT", .kind = CLI_TEXT, AT(actions.schedule),
     .help = "structure: and after what is done to the cords, as `thread eval` takes it"},
    {"start", .kind = CLI_WORD, AT(start), .word = thr_rise_start_name,
     .n_words = THR_RISE_N_STARTS,
     .help = "rise: where pieces begin, as for `thread rise` (default: flat)"},
    {"seeds", .value = "N", .kind = CLI_COUNT, AT(rise.seeds), .low = 1,
     .high = THR_RISE_MOST_SEEDS, .help = "rise: so many runs of every plan (default: 3)"},
    {"let-down", .kind = CLI_FLAG, AT(rise.let_down),
     .help = "rise: and the cords let go again, until it falls"},
    {"plot", .value = "FILE", .kind = CLI_OUTPUT, AT(plot),
     .help = "write a picture as SVG: the plans side by side, small, with pull, cord and number of "
             "cords"},
    {0}};

/* Refuses options that would be ignored. Returns an exit code. */
static int check_rise(const pull_args *args)
{
  static const char *const own[] = {"start", "seeds", "let-down"};
  const bool rise = args->method == THR_BY_RISE;
  for (size_t i = 0; i < sizeof own / sizeof *own; i++)
    if (!rise && cli_given(own[i])) return cli_usage("compare", "--%s is of --method rise", own[i]);
  if (rise && args->options.iterations != 1)
    return cli_usage("compare", "--tune iterations: `thread rise` takes them");
  return EXIT_OK;
}

/* Runs `thread compare`: parses the options, does the work in a guarded child process, and returns
 * the exit code. */
int cmd_compare(int argc, char **argv)
{
  static const cli_syntax syntax = {"compare", intro, outro};
  compare_arguments asked = {.guard = guard_limits_default(), .rise = {.seeds = 3}};
  guard_end end;
  pull_args_init(&asked.pull, THR_JOINT);
  const cli_group groups[] = {{"Options", own_options, &asked},
                              {NULL, pull_options, &asked.pull},
                              {NULL, cli_processes_options, NULL},
                              {NULL, pull_run_options, &asked.pull},
                              {NULL, guard_options, &asked.guard},
                              {"What acts on the structure, to rank by what the plans carry",
                               cli_load_options, &asked.actions.load},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &asked.pull.physics},
                              {cli_tuned, pull_tuned, &asked.pull},
                              {cli_tuned, cli_load_tuned, &asked.actions.load},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* Every operand is a plan. */
  int n = argc - optind;
  if (n < 1) return cli_usage("compare", "which plans?");
  if (cli_json && asked.plot && strcmp(asked.plot, "-") == 0)
    return cli_usage("compare", "--json and --plot - both want stdout");

  code = pull_check(&asked.pull, "compare");
  if (!code) code = check_actions(&asked.pull, &asked.actions);
  if (!code) code = check_rise(&asked.pull);
  if (code) return code;
  asked.rise.start = (thr_rise_start)asked.start;

  /* From here on in the child, whose time and memory are bounded. */
  if (guard_fork(&asked.guard, &end)) return guard_conclude(&end, "no comparison");
  entry *entries = thr_calloc((size_t)n, sizeof *entries);
  if (!entries) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }

  code = compare(&asked.pull, &asked.actions, &asked.rise, argv + optind, n, entries, asked.plot);

  /* Plans and evaluations that were never filled in are all 0, which is valid. */
  for (int i = 0; i < n; i++) {
    thr_plan_destroy(&entries[i].plan);
    for (int k = 0; k < THR_N_METHODS; k++)
      thr_eval_destroy(&entries[i].eval[k]);
  }

  free(entries);

  return code;
}
