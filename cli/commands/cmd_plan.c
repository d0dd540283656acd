/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread plan: reads a framework, plans how cord is threaded through it, checks the plan, and
 * writes the plan, diagrams and a summary.
 *
 * The work is done in a child process (cli/guard.c). Whenever the search finds better cords, the
 * child hands them to its parent as a plan that claims nothing (cli/best.c). If the child is ended
 * by a limit on time or memory, or by a signal, the parent writes the last of these plans. So a
 * search that was ended never leaves nothing if it had found anything.
 *
 * Order of work in the child: parse options, try whether the outputs can be written, read the
 * framework, search (planner/planner.h), write the plan's text and check that text as `thread
 * check` does, print the summary, draw.
 *
 * Example: `thread plan dome.obj` writes dome/plan.json, dome/overview.svg, dome/sheets.pdf and
 * more; `-o plan.json` writes the plan alone; `--draw DIR` writes everything into DIR. */
#include "cli/commands/commands.h"
#include "cli/args/args.h"
#include "cli/cli.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/os.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "planner/planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char intro[] =
    "thread plan FRAME [options]: the threading that is shortest, turns least or is symmetric\n\n"
    "Examples:\n"
    "  thread plan dome.obj                               plan, pictures, tables in the folder "
    "dome/\n"
    "  thread plan dome.obj --cover 2 -o plan.json        two passes per interface; the plan only\n"
    "  thread plan dome.obj --cords 4 --ends feet --feet lowest --balance   of much the same "
    "length\n"
    "  thread plan dome.obj --max-length 900 --ends any   as few cords as that takes\n"
    "  thread plan dome.obj --objective tortuosity        what turns least, and pulls most easily\n"
    "  thread plan dome.obj --objective symmetry          a short path to learn, and its copies\n"
    "  thread make dome | thread plan - -o - | thread check -\n";
static const char outro[] =
    "Exit codes: 0 as asked: the shortest, or within the gap; of other aims without --gap and "
    "--time-limit within any gap, which is said; 2 usage, 3 bad input, 4 infeasible or none found, "
    "5 not as asked (plan written), 70 internal.\n"
    "What is said of cord and beads is stored in the plan; thread eval begins with it.";

/* ---- options ---- */

/* The command line. Strings point into argv. */
typedef struct {
  cli_frame_args frame;
  pull_args pull;
  symmetry_args symmetry;
  request_args request;
  guard_limits guard; /* seconds < 0: as the objective has it */
  thr_request wanted; /* aims, and what belongs to them */
  const char *path, *output, *draw;
  drawings_args drawings;
  bool json, compare, force, progress;
} plan_arguments;

#define AT(member) .offset = offsetof(plan_arguments, member)

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT,
     .help = "stop after S seconds with the best plan so far and its gap, 0 = never (default: 0 "
             "for length and solid joints, else 20). The searches of --frontier, "
             "--compare-shortest and --compare-objectives share an S that is given; else each has "
             "its 20 s. Drawings come on top. Without S the searches for one cord that turns "
             "least, for several by their largest turning, and for --max-pull count their work "
             "instead: some three seconds, thirty for --max-pull where three find no cords, and "
             "the same plan on every machine"},
    {0}};

static const cli_option output_options[] = {
    {"output", 'o', "FILE", "write the plan here (- = stdout), and no diagrams unless --draw",
     .kind = CLI_OUTPUT, AT(output)},
    {"draw", .value = "DIR", .kind = CLI_OUTPUT, AT(draw),
     .help = "write the diagrams into this folder, and without -o the plan too (no sheets.pdf for "
             "more than 1000 pieces: thread draw PLAN -T pdf makes it)"},
    {"force", .kind = CLI_FLAG, AT(force),
     .help = "replace another plan in the folder that is named after FRAME (else FRAME-2, FRAME-3, "
             "..)"},
    {"json", .kind = CLI_FLAG, AT(json), .help = "summary as JSON on stdout"},
    {"progress", .kind = CLI_FLAG, AT(progress),
     .help = "a line of JSON on stderr each time the plan or its bound is better"},
    {"compare-objectives", .kind = CLI_FLAG, AT(compare),
     .help = "make the plans for the other objectives, too, and compare the pulls, joints "
             "simulated"},
    {0}};

/* Parses the command line into *args. Returns -1 to go on, or the exit code of the command. */
static int parse(int argc, char **argv, plan_arguments *args)
{
  static const cli_syntax syntax = {"plan", intro, outro};
  *args = (plan_arguments){.frame = cli_frame_args_default(),
                           .symmetry = symmetry_args_default(),
                           .request = request_args_default(),
                           .guard = guard_limits_default(),
                           .drawings = {.quick = true}};
  pull_args_init(&args->pull, THR_JOINT);
  const cli_group groups[] = {
      {"What is planned", request_options(REQUEST_PLANNED), &args->request},
      {NULL, time_options, &args->guard},
      {NULL, guard_memory_options, &args->guard},
      {"Least turning (with --objective tortuosity)", request_options(REQUEST_TURNING),
       &args->request},
      {"Symmetry (with --objective symmetry; thread symmetries --help says more)",
       cli_symmetry_options, &args->symmetry},
      {"Framework", cli_frame_options, &args->frame},
      {"Output", output_options, args},
      {NULL, drawings_options, &args->drawings},
      {NULL, cli_processes_options, NULL},
      {NULL, pull_run_options, &args->pull},
      {CLI_PHYSICS_HEADING, cli_physics_options(), &args->pull.physics},
      {cli_tuned, request_options(REQUEST_TUNED), &args->request},
      {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (args->progress) progress_begin();
  if (optind + 1 != argc)
    return cli_usage("plan", optind == argc ? "which framework?" : "one framework at a time");
  args->path = argv[optind];

  /* Outputs: names that a file can have, and one text at most on stdout. */
  if (args->output && cli_no_plan_name("plan", args->output)) return EXIT_USAGE;

  const char *wordy = args->json               ? "--json"
                      : args->compare          ? "--compare-objectives"
                      : args->request.frontier ? "--frontier"
                                               : NULL;
  if (wordy && args->output && strcmp(args->output, "-") == 0)
    return cli_usage("plan", "%s and -o - both want stdout", wordy);

  return request_args_check(&args->request, &args->symmetry, &args->wanted);
}

/* Fills a request for one objective from the options. What is about turning or symmetry concerns
 * only one objective, and is left out of the others. */
static void ask(const plan_arguments *args, thr_objective objective, thr_request *options)
{
  request_args_ask(&args->request, &args->symmetry, objective, options);
  if (options->order != THR_ORDER_PLANNED) options->needles = args->drawings.needles;
  options->time_limit =
      args->guard.seconds < 0 ? thr_dispatch_usual_seconds(options) : args->guard.seconds;
}

/* Applies the options on cord and beads. What was said must fit the framework; if nothing was said,
 * a framework of any size will do. Returns an exit code. */
static int apply_physics(const plan_arguments *args, const thr_frame *framework,
                         thr_request *options)
{
  thr_err err = {0};
  thr_physics resolved;
  int code = cli_physics_apply(&args->pull.physics, &options->physics);
  if (code || args->pull.physics.n == 0) return code;
  return thr_physics_resolve(&options->physics, framework, &resolved, &err) ? cli_fail(&err)
                                                                            : EXIT_OK;
}

/* ---- the other objectives ---- */

/* Writes the largest pull of the plan for one objective, N, and its error (a part of the exponent).
 * code: why the pull is not known, EXIT_OK if it is. */
static void put_pull_json(thr_writer *writer, thr_objective objective, const thr_eval *eval,
                          int code)
{
  thr_write_object(writer, NULL);
  thr_write_string(writer, "objective", thr_objective_name(objective));
  thr_write_number(writer, "pull", code == EXIT_OK ? eval->record.largest : NAN);

  /* Turns that were refused have no known error. */
  if (code == EXIT_OK) {
    thr_write_number(writer, "error", eval->error);
    thr_write_int(writer, "refused", eval->refused);
  }
  thr_write_close(writer);
}

/* Appends the same as a line: "tortuosity 12.3 N (+-0.4 %) this plan". */
static void put_pull(thr_text *text, const plan_arguments *args, thr_objective objective,
                     const thr_plan *plan, const thr_eval *eval, int code)
{
  thr_text_printf(text, "  %-12s", thr_objective_name(objective));

  /* With turns that were refused, the error is at least that of the others. */
  if (code == EXIT_OK) {
    thr_text_printf(text,
                    eval->refused ? "%12.4g N (error at least %.3g %%" : "%12.4g N (+-%.3g %%",
                    eval->record.largest, pull_percent(eval->error));
    if (eval->refused)
      thr_text_printf(text, ": %d %s by closed form", eval->refused,
                      cli_plural(eval->refused, "turn", "turns"));

    thr_text_printf(text, ")%s", objective == args->request.objective ? "   this plan" : "");
    if (thr_wants_symmetry(&plan->options))
      thr_text_printf(text, "   %d %s", plan->n_cords, cli_plural(plan->n_cords, "cord", "cords"));
  } else {
    thr_text_printf(text, "%14s", "not known");
  }

  thr_text_append(text, "\n");
}

/* Measures the pull of a plan by simulated joints and adds it to the comparison. Returns an exit
 * code. */
static int put_objective(thr_writer *writer, const plan_arguments *args, thr_objective objective,
                         const thr_plan *plan)
{
  thr_eval eval;
  int code = pull_eval(&args->pull, thr_objective_name(objective), plan, THR_JOINT, &eval);

  /* A pull that is not known is told as such. */
  if (args->json)
    put_pull_json(writer, objective, &eval, code);
  else
    put_pull(writer->out, args, objective, plan, &eval, code);
  thr_eval_destroy(&eval);

  return code;
}

/* Returns limits for a search. Time that nobody asked for is no limit on work that is counted: such
 * a search ends at the same place on every machine, and the clock only ends it on a very busy one.
 * *work: what the limits count with; must stay while they are used. */
static thr_limits limits_for(const plan_arguments *args, const thr_request *options, double seconds,
                             double *work)
{
  const bool unsaid = args->guard.seconds < 0;
  thr_limits limits = cli_limits((unsaid ? thr_dispatch_patience(options) : 1) * seconds);
  limits.usual = unsaid;
  *work = thr_dispatch_work(options);
  return unsaid && *work > 0 ? thr_limits_counted(&limits, work) : limits;
}

/* Plans for one objective, unless this is the plan's own, and adds its pull to the comparison.
 * deadline: thr_clock(), 0 = none. Returns an exit code. */
static int plan_and_put(thr_writer *writer, const plan_arguments *args, thr_objective objective,
                        const thr_plan *plan, double deadline)
{
  thr_err err = {0};
  thr_plan other = {0};

  /* The plan that was asked for is there already. */
  if (objective == args->request.objective) return put_objective(writer, args, objective, plan);

  /* The same request with another objective. */
  thr_request options = plan->options;
  ask(args, objective, &options);
  double work;
  thr_limits limits = limits_for(args, &options, options.time_limit, &work);
  if (deadline > 0) limits.deadline = deadline;

  /* A plan that is not proved is good enough to compare with. */
  thr_status st = thr_plan_make(&plan->frame, &options, &limits, &other, NULL, &err);
  cli_progress_end();
  int code =
      st && st != THR_ELIMIT ? cli_fail(&err) : put_objective(writer, args, objective, &other);
  thr_plan_destroy(&other);

  return code;
}

/* Adds the pull of this plan beside that of plans for the other objectives. Returns the first exit
 * code that is not EXIT_OK. */
static int put_comparison(thr_writer *writer, const plan_arguments *args, const thr_plan *plan,
                          double deadline)
{
  int code = EXIT_OK;

  if (args->json)
    thr_write_array(writer, "objectives");
  else
    thr_text_append(writer->out, "\nlargest pull by objective, joints measured in simulation\n");

  /* This plan stands among the others, in the order of objectives. */
  for (int i = 0; i < THR_N_OBJECTIVES; i++) {
    int done = plan_and_put(writer, args, thr_dispatch_objective(i), plan, deadline);
    if (!code) code = done;
  }

  if (args->json) thr_write_close(writer);

  return code;
}

/* What was planned: the plan, and what else the planner found. */
typedef struct {
  thr_plan plan;
  thr_report report;
} planned_result;

/* Returns when everything must be done, as thr_clock(): the plan and those that it is compared with
 * share the time that was asked for. 0: none was. */
static double deadline_of(const plan_arguments *args)
{
  return args->guard.seconds > 0 ? guard_deadline() : 0;
}

/* Returns the seconds for the search: of a time that was asked for what comparisons, checks and
 * writing leave. */
static double time_of_plan(const plan_arguments *args, const thr_request *options)
{
  bool more = args->request.compare || args->request.frontier || args->compare;
  return args->guard.seconds <= 0 ? options->time_limit
                                  : thr_dispatch_search_seconds(options->time_limit, more);
}

/* Adds the summary of the plan, as text or JSON. */
static void put_plan(thr_writer *writer, const plan_arguments *args, const planned_result *result,
                     const thr_rivals *rivals)
{
  if (args->json)
    plan_put_json(writer, &result->plan, rivals, result->report.word);
  else
    plan_put_summary(writer->out, &result->plan, rivals, result->report.word);
}

/* Draws the frontier of length and turning into the file of --plot. Where there is none, says why.
 * Returns an exit code. */
static int write_frontier(const plan_arguments *args, const thr_plan *plan,
                          const thr_rivals *rivals)
{
  const thr_frontier *frontier = &rivals->frontier;
  thr_err err = {0};
  thr_text svg = {0};
  thr_physics physics;
  char stem[256];

  if (frontier->n == 0) {
    cli_error("%s: nothing to draw: there is no frontier", args->request.plot);
    return EXIT_INPUT;
  }

  cli_stem(args->path, stem, sizeof stem);
  thr_frontier_mark *mark = thr_calloc((size_t)frontier->n, sizeof *mark);
  thr_status st = mark ? thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, &err)
                       : thr_nomem(&err);

  /* A mark for each point, with its pulls over the band of mu, N. */
  for (int i = 0; i < frontier->n && !st; i++) {
    const thr_frontier_point *point = &frontier->point[i];
    mark[i] = (thr_frontier_mark){
        .length = point->length, .turning = point->turning, .proved = !point->open};
    thr_advice_pulls(&physics, point->pulled, mark[i].pull);
  }

  const thr_frontier_chart chart = {.name = stem,
                                    .units = plan->frame.units,
                                    .physics = &physics,
                                    .shortest = plan->proof.lower_bound,
                                    .n = frontier->n,
                                    .mark = mark};

  if (!st) st = thr_frontier_svg(&chart, &svg, &err);
  free(mark);

  return cli_write_drawn(st, &svg, args->request.plot, &err);
}

/* Makes the plans that a plan of least turning is compared with, and adds the summary with them.
 * Returns an exit code. */
static int put_turning(thr_writer *writer, const plan_arguments *args, planned_result *result)
{
  thr_rivals rivals = {0};
  thr_err err = {0};
  thr_limits limits = cli_limits(0);

  limits.deadline = deadline_of(args);

  /* The shortest cords that the planner left are taken over. */
  thr_status st = thr_rivals_make(&result->plan, &result->report.shortest, args->request.compare,
                                  args->request.frontier, &limits, &rivals, &err);
  cli_progress_end();

  /* What the user may not have expected. */
  if (args->request.frontier && !args->request.minimize && result->plan.options.cords > 1)
    cli_note("note: with --frontier all turning together is minimized; --minimize max-turning is "
             "for the cord that turns most");
  if (rivals.no_frontier.code) cli_note("no frontier: %s", rivals.no_frontier.text);

  put_plan(writer, args, result, &rivals);
  int code = st ? cli_fail(&err) : EXIT_OK;
  if (!code && args->request.plot) code = write_frontier(args, &result->plan, &rivals);
  thr_rivals_destroy(&rivals);

  return code;
}

/* Adds the table of groups and the summary of a symmetric plan. At most 8 rows as text; all of them
 * as JSON. */
static void put_symmetry(thr_writer *writer, const plan_arguments *args,
                         const planned_result *result)
{
  enum { ROWS = 8 };
  const thr_plan *plan = &result->plan;

  if (!args->json) {
    symmetry_put_head(writer->out, &plan->frame, &plan->options, &result->report.symmetries);
    symmetry_put_table(writer->out, &plan->options, &result->report.symmetries, ROWS);
    thr_text_append(writer->out, "\n");
  }

  /* The plan itself, and in JSON the table after it. */
  put_plan(writer, args, result, NULL);
  if (!args->json) return;
  thr_write_object(writer, "symmetries");
  symmetry_put_table_json(writer, &plan->options, &result->report.symmetries);
  thr_write_close(writer);
}

/* Prints the summary to stdout, as its objective needs it. Returns an exit code. */
static int print_summary(const plan_arguments *args, planned_result *result)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  int code = EXIT_OK;

  if (args->json) thr_write_object(&writer, NULL);

  /* Each objective is compared with something else. */
  if (thr_wants_turning(&result->plan.options))
    code = put_turning(&writer, args, result);
  else if (thr_wants_symmetry(&result->plan.options))
    put_symmetry(&writer, args, result);
  else
    put_plan(&writer, args, result, NULL);

  if (args->compare) {
    int done = put_comparison(&writer, args, &result->plan, deadline_of(args));
    if (!code) code = done;
  }

  if (args->json) {
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }

  /* With --quiet the text was made only because a picture is made on the way. */
  int written = EXIT_OK;
  if (cli_quiet && !args->json)
    thr_text_destroy(&text);
  else
    written = cli_write(&text, "-");

  return code ? code : written;
}

/* ---- outputs ---- */

/* Where plan and diagrams go: where the options say; where they say nothing, in a folder named
 * after the framework. */
typedef struct {
  const char *plan, *folder; /* folder: NULL = no diagrams */
  char own[280], in_folder[1200];
} output_places;

/* Returns whether the folder holds a plan whose text is not this one. */
static bool holds_another(const char *folder, const thr_text *text)
{
  char path[1200];
  thr_text there = {0};

  snprintf(path, sizeof path, "%s/plan.json", folder);
  if (access(path, F_OK) != 0) return false;

  /* The same request makes the same text, which may be written over. */
  bool same = !thr_text_read(&there, path, NULL) && there.length == text->length &&
              (text->length == 0 || memcmp(there.data, text->data, text->length) == 0);
  thr_text_destroy(&there);

  return !same;
}

/* Finds the folder for a plan of which nobody said where it goes: dome, or the first of dome-2,
 * dome-3, .. that holds no other plan, and no file that this command reads. */
static void find_folder(const plan_arguments *args, const thr_text *text, char folder[280])
{
  enum { MOST = 1000 };
  char stem[256];

  cli_stem(args->path, stem, sizeof stem);
  snprintf(folder, 280, "%s", stem);

  /* With --force another plan is replaced, but never a file that was read. */
  const bool reads = drawings_would_lose(stem);

  /* The first name that is free. */
  for (int i = 2;
       i <= MOST && ((!args->force && holds_another(folder, text)) || drawings_would_lose(folder));
       i++)
    snprintf(folder, 280, "%s-%d", stem, i);

  /* Say so where it is not the usual folder. */
  if (strcmp(folder, stem) != 0)
    cli_note(reads ? "note: in %s a drawing would take the place of a file that is read: this plan "
                     "is in %s"
                   : "note: %s holds another plan: this one is in %s (--force replaces the other)",
             stem, folder);
}

/* Tries, before the search, whether the plan and its drawings can be written where they go unasked,
 * and that no drawing takes the place of a file that is named on the command line. Returns an exit
 * code. */
static int try_places(const plan_arguments *args)
{
  char stem[256];

  cli_stem(args->path, stem, sizeof stem);
  if (!args->draw && !args->output) return files_try_folder(stem);
  int code = args->draw ? drawings_claim("plan", args->draw, -1) : EXIT_OK;
  if (code || !args->draw || args->output) return code;

  /* The plan goes among the drawings. */
  char plan[1200];
  code = cli_in_folder(args->draw, "plan.json", plan, sizeof plan);

  return code ? code : files_claim("plan", "draw", plan);
}

/* Finds where the plan and its drawings go. text: of the plan. Returns an exit code. */
static int find_places(const plan_arguments *args, const thr_text *text, output_places *places)
{
  if (!args->draw && !args->output) find_folder(args, text, places->own);

  places->folder = args->draw ? args->draw : args->output ? NULL : places->own;
  places->plan = args->output ? args->output : places->in_folder;
  return places->folder ? cli_in_folder(places->folder, "plan.json", places->in_folder,
                                        sizeof places->in_folder)
                        : EXIT_OK;
}

/* Reads back and checks the whole text that is to be written, as `thread check` does, so that no
 * claim is left that would be refused. *plan becomes what was read. *code becomes EXIT_LIMIT if a
 * claim was dropped. Returns an exit code; the text is not to be written unless it is EXIT_OK. */
static int check_text(thr_text *text, const char *path, thr_plan *plan, int *code)
{
  thr_err err = {0};
  int dropped;

  if (text->failed) return EXIT_OK; /* writing says so */
  thr_status st =
      thr_plan_confirm(plan, text, strcmp(path, "-") == 0 ? "stdout" : path, &dropped, &err);
  if (st == THR_ENOMEM) return cli_fail(&err);

  /* The plan itself does not hold. */
  if (st) {
    cli_error(
        "a fault of this program: the plan does not pass its own check, and is not written: %s",
        err.text);
    return EXIT_INTERNAL;
  }

  /* The plan holds without these claims, which are bits of a sum. */
  for (int claim = 1; claim <= THR_CLAIMS_ALL; claim *= 2)
    if (dropped & claim)
      cli_error("a fault of this program: what it proved of %s does not pass its own check, and is "
                "left out: %s",
                thr_claim_name(claim), err.text);
  if (dropped) *code = EXIT_LIMIT;

  return EXIT_OK;
}

/* Writes the plan. Only from here on is the plan what this run leaves, with the exit code *code,
 * which is another one if the plan lost a claim. places->plan receives where the plan is, which is
 * another place if it cannot be written there, or NULL if it is nowhere. Returns an exit code. */
static int write_plan(const plan_arguments *args, thr_plan *plan, output_places *places, int *code)
{
  thr_text text = {0};

  thr_frame_keep_hash(&plan->frame);
  thr_plan_write(plan, &text);

  int refused = find_places(args, &text, places);
  if (!refused) refused = check_text(&text, places->plan, plan, code);

  if (refused) {
    thr_text_destroy(&text);
    places->plan = NULL;
    return refused;
  }

  /* Until the last byte is written nothing but a second signal ends this process. */
  guard_writing();
  int written = cli_write_kept(&text, &places->plan);
  guard_written(written ? written : *code);

  return written;
}

/* Returns whether nothing was said of what the plan is to be, and how long it may take: then the
 * summary ends with advice. */
static bool is_usual(const plan_arguments *args, const thr_request *options)
{
  return thr_wants_length(options) && !thr_wants_balance(options) &&
         request_args_usual(&args->request) && args->guard.seconds < 0 && !args->compare;
}

/* Appends the line about the order of work: the longest chain of pieces that is loose at a time. */
static void put_order(const plan_arguments *args, const thr_plan *plan, thr_text *text)
{
  thr_err err = {0};
  thr_text_append(text, "order    ");
  if (drawings_chains(plan, &args->drawings, text, &err)) thr_text_append(text, err.text);
  thr_text_append(text, "\n");
}

/* Prints where the plan is and, unless folder is NULL, the drawings; and what to do if a hand
 * cannot pull the cords. Returns an exit code. */
static int print_places(const plan_arguments *args, const thr_plan *plan, const char *plan_path,
                        const char *folder)
{
  const bool usual = is_usual(args, &plan->options);
  char names[DRAWINGS_NAMES];
  thr_text text = {0};

  /* Where the files are. */
  thr_text_append(&text, args->compare || thr_wants_turning(&plan->options) ? "\n" : "");
  thr_text_append(&text, "plan     ");
  thr_text_append_clean(&text, plan_path);
  drawings_names(plan, &args->drawings, names);
  if (folder) {
    thr_text_append(&text, "\ndrawn    in ");
    thr_text_append_clean(&text, folder);
    thr_text_printf(&text, ": %s", names);
  }

  thr_text_append(&text, "\n");

  /* Order of work, and a hint for plans that were asked for with options. */
  if (plan->options.order == THR_ORDER_HAND || cli_verbose) put_order(args, plan, &text);
  if (!usual) advice_put_hint(plan, &text);
  int code = cli_write(&text, "-");
  if (code || !usual) return code;

  /* Advice takes a search of its own, so what is known is printed first. */
  advice_put_after_plan(plan, args->path, &args->pull.physics, &text);

  return cli_write(&text, "-");
}

/* Draws everything into the folder. Drawings are always whole: a limit on the time is the search's.
 * Returns an exit code. */
static int write_drawings(const plan_arguments *args, const thr_plan *plan,
                          const output_places *places)
{
  if (!places->folder) return EXIT_OK;

  /* A search that was ended by the clock leaves time for its drawings. */
  guard_allow(0);
  const int code = drawings_write_all(plan, places->folder, &args->drawings);
  if (!code && drawings_no_sheets(plan, &args->drawings))
    cli_note(
        "no sheets.pdf, which has hundreds of pages for more than %d pieces: thread draw %s -T pdf",
        DRAWINGS_SHEETS_PIECES, strcmp(places->plan, "-") == 0 ? "plan.json" : places->plan);

  return code;
}

/* Writes plan, summary and drawings. *planned_code: of the search; not EXIT_OK afterwards if a
 * claim was dropped. Returns an exit code. */
static int write_outputs(const plan_arguments *args, planned_result *result, int *planned_code)
{
  thr_plan *plan = &result->plan;
  output_places places = {0};
  const int written = write_plan(args, plan, &places, planned_code);

  if (!places.plan) return written; /* there is none */

  /* A plan on stdout leaves no place for a summary. */
  const bool is_silent =
      strcmp(places.plan, "-") == 0 || (cli_quiet && !args->json && !args->request.plot);
  int code = is_silent ? EXIT_OK : print_summary(args, result);

  /* Drawings are made only of a plan that is where it was to be. */
  const int drawn = written ? EXIT_OK : write_drawings(args, plan, &places);
  if (!code) code = drawn;
  if (!code && !is_silent && !args->json && !cli_quiet)
    code = print_places(args, plan, places.plan, written ? NULL : places.folder);

  return written ? written : code;
}

/* Runs the search. Time that nobody asked for is for the search alone: the guard's clock is stopped
 * again afterwards. */
static thr_status make_plan(const plan_arguments *args, const thr_frame *framework,
                            const thr_request *options, planned_result *result, thr_err *err)
{
  double work;

  /* The guard waits a little longer than the search's own limit. */
  if (args->guard.seconds < 0)
    guard_allow(options->time_limit > 0
                    ? 1 + 1.1 * thr_dispatch_patience(options) * options->time_limit
                    : 0);

  /* From here on the best cords go to the parent. */
  thr_limits limits = limits_for(args, options, time_of_plan(args, options), &work);
  best_begin(framework, options);
  limits.found = best_found;
  thr_status st = thr_plan_make(framework, options, &limits, &result->plan, &result->report, err);
  cli_progress_end();

  if (cli_verbose) cli_note("search: ended, %.3f CPU s", thr_os_processor_seconds());
  if (args->guard.seconds < 0) guard_allow(0);

  return st;
}

/* Says why there is no plan: in one line, and with --json as an object, too. Returns the exit code
 * that belongs to err. */
static int refuse(const plan_arguments *args, const thr_err *err)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  const int code = cli_fail(err);

  if (!args->json || err->code == THR_ENOMEM) return code;

  /* For programs. */
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "error", err->text);
  thr_write_int(&writer, "exit_code", code);
  thr_write_close(&writer);
  thr_text_append(&text, "\n");
  const int written = cli_write(&text, "-");

  return written ? written : code;
}

/* Makes a plan for a framework and writes all that is asked for. Releases the framework, of which
 * the plan has a copy. Returns an exit code. */
static int plan_frame(const plan_arguments *args, thr_frame *framework)
{
  thr_err err = {0};
  planned_result result = {0};
  thr_request options = thr_request_default();

  ask(args, args->request.objective, &options);

  /* The request. */
  int code = apply_physics(args, framework, &options);
  if (!code) code = request_args_apply(&args->request, framework, &options);
  if (code == EXIT_OK) {
    /* The search, and one last chance for its cords to be kept. */
    thr_status st = make_plan(args, framework, &options, &result, &err);
    if (guard_deadline() > 0)
      best_found(NULL, result.plan.cord, result.plan.n_cords,
                 result.plan.symmetry.present ? &result.plan.symmetry : NULL);

    best_begin(NULL, NULL);
    thr_frame_destroy(framework);

    /* A plan that is not proved within the limits is a plan, with EXIT_LIMIT. */
    int planned_code = st ? EXIT_LIMIT : EXIT_OK;
    const bool is_plan = st == THR_OK || (st == THR_ELIMIT && result.plan.n_cords > 0);
    if (is_plan) code = write_outputs(args, &result, &planned_code);
    if (code == EXIT_OK) code = !is_plan ? refuse(args, &err) : st ? cli_fail(&err) : planned_code;
  }

  free(options.end_node);
  free(options.end_count);
  thr_plan_destroy(&result.plan);
  thr_report_destroy(&result.report);
  thr_frame_destroy(framework);

  return code;
}

/* Draws, in a process of its own, a plan of a search that was ended: what fits into memory is
 * drawn. Returns the exit code of the search. */
static int draw_kept(const plan_arguments *args, const output_places *places)
{
  const guard_limits limits = {.memory = args->guard.memory};
  guard_end end;
  thr_plan plan;
  thr_err err = {0};

  if (guard_fork(&limits, &end)) {
    guard_conclude(&end, "not all that was to be drawn fits");
    return EXIT_LIMIT;
  }

  int code = thr_plan_read(&plan, places->plan, &err) ? cli_fail(&err) : EXIT_OK;
  if (!code) code = drawings_write_all(&plan, places->folder, &args->drawings);
  if (!code) cli_note("drawn in %s", places->folder);

  return EXIT_LIMIT; /* of the search */
}

/* Concludes the command in the parent, if there is one: if the child left no plan, but had handed
 * over some cords, they become the plan. Returns the exit code. */
static int conclude(const plan_arguments *args, guard_end *end)
{
  output_places places;

  /* The plan is out; only drawings or words are missing. */
  if (end->written)
    return guard_conclude(end,
                          "the plan is written, but not all that was to be drawn or said of it");

  /* An error that the user has to mend is told instead of any plan. */
  bool searched =
      end->code == EXIT_LIMIT || end->code == EXIT_INFEASIBLE || end->code == EXIT_INTERNAL;
  bool told = end->reason == GUARD_DONE && !searched; /* what the user wants to know */
  if (end->kept.length == 0 || told) return guard_conclude(end, "no plan was found");

  /* The best cords so far are written. */
  int code = find_places(args, &end->kept, &places);
  if (!code) code = cli_write_kept(&end->kept, &places.plan);
  thr_text_destroy(&end->kept);
  if (code) return code;
  cli_error("%s%s%s holds the best plan so far, of which nothing is proved", end->why,
            *end->why ? ": " : "", places.plan);

  if (places.folder && end->reason != GUARD_INTERRUPTED && strcmp(places.plan, "-") != 0)
    return draw_kept(args, &places);

  return EXIT_LIMIT;
}

/* Runs `thread plan` and returns the exit code. */
int cmd_plan(int argc, char **argv)
{
  plan_arguments args;
  thr_frame framework;
  guard_end end;
  int code = parse(argc, argv, &args);

  /* What cannot be written is found out before the search, not after it. */
  if (code >= 0 || (code = try_places(&args))) return code;

  /* The child does all of the work, the parent waits and concludes. */
  if (guard_fork(&args.guard, &end)) return conclude(&args, &end);

  if ((code = cli_read_frame(args.path, &args.frame, &framework))) return code;
  code = plan_frame(&args, &framework);

  return guard_alone(code, &end) ? conclude(&args, &end) : code;
}
