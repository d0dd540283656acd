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
#include "cli/commands/plan_parts.h"
#include "graph/os.h"
#include "graph/plan/physics.h"

#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread plan FRAME [options]: as few cords as a hand can pull, from the best ends; or, as "
    "asked, "
    "the threading that is shortest, turns least or is symmetric\n\n"
    "Examples:\n"
    "  thread plan dome.obj                               plan, pictures, tables in the folder "
    "dome/\n"
    "  thread plan dome.obj --cover 2 -o plan.json        two passes per interface; the plan only\n"
    "  thread plan dome.obj --cords 1                     one closed cord, the shortest\n"
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
  args->path = args->drawings.path = argv[optind];

  /* Outputs: names that a file can have, and one text at most on stdout. */
  if (args->output && cli_no_plan_name("plan", args->output)) return EXIT_USAGE;

  const char *wordy = cli_json                 ? "--json"
                      : args->compare          ? "--compare-objectives"
                      : args->request.frontier ? "--frontier"
                                               : NULL;
  if (wordy && args->output && strcmp(args->output, "-") == 0)
    return cli_usage("plan", "%s and -o - both want stdout", wordy);

  return request_args_check(&args->request, &args->symmetry, &args->wanted);
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

void plan_ask(const plan_arguments *args, thr_objective objective, thr_request *options)
{
  request_args_ask(&args->request, &args->symmetry, objective, options);
  if (options->order != THR_ORDER_PLANNED) options->needles = args->drawings.needles;
  options->time_limit =
      args->guard.seconds < 0 ? thr_dispatch_usual_seconds(options) : args->guard.seconds;
}

bool plan_is_recommended(const plan_arguments *args, const thr_request *request)
{
  return request_args_unsaid(request->ends) && !args->compare;
}

thr_limits plan_limits(const plan_arguments *args, const thr_request *options, double seconds,
                       double *work)
{
  const bool unsaid = args->guard.seconds < 0;
  thr_limits limits = cli_limits((unsaid ? thr_dispatch_patience(options) : 1) * seconds);
  limits.usual = unsaid;
  *work = thr_dispatch_work(options);
  return unsaid && *work > 0 ? thr_limits_counted(&limits, work) : limits;
}

/* Returns the seconds for the search: of a time that was asked for what comparisons, checks and
 * writing leave. */
static double time_of_plan(const plan_arguments *args, const thr_request *options)
{
  bool more = args->request.compare || args->request.frontier || args->compare;
  return args->guard.seconds <= 0 ? options->time_limit
                                  : thr_dispatch_search_seconds(options->time_limit, more);
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
  thr_limits limits = plan_limits(args, options, time_of_plan(args, options), &work);
  cli_step("planning", "");
  const bool recommends = plan_is_recommended(args, options);
  best_begin(framework, options, recommends ? thr_hand_always : 0);
  limits.found = best_found;

  /* Programs hear only bounds of what was asked. */
  bool tells = true;
  thr_status st =
      progress_wanted() ? thr_plan_tells_bounds(framework, options, &tells, err) : THR_OK;
  if (st) return st;
  if (progress_wanted() && (!tells || recommends)) limits.progress = NULL;

  st = recommends ? thr_plan_recommended(framework, options,
                                         &(thr_recommend_options){.hand = thr_hand_always,
                                                                  .ends_given = cli_given("ends")},
                                         &limits, &result->plan, &result->report, err)
                  : thr_plan_make(framework, options, &limits, &result->plan, &result->report, err);
  cli_progress_end();

  if (cli_verbose) cli_note("search: ended, %.3f CPU s", thr_os_processor_seconds());
  if (args->guard.seconds < 0) guard_allow(0);

  return st;
}

/* Notes a limit that one cord in every component keeps to already. */
static void note_idle_limit(const plan_arguments *args, const thr_plan *plan)
{
  static const char *const options[] = {"max-length", "max-pull", "hand"};
  const char *limit = NULL;
  const int components = thr_plan_components(plan);
  for (int i = 0; i < 3 && !limit; i++)
    limit = cli_given(options[i]);
  if (limit && !args->request.most && plan->n_cords > 0 && plan->n_cords == components)
    cli_note("note: one cord%s is within %s already", components > 1 ? " in every component" : "",
             limit);
}

/* Notes the cords without which every interface would still be covered: more were asked for than
 * are of use. O(passes). */
static void note_repeats(const plan_arguments *args, const thr_plan *plan)
{
  if (args->request.most < 2 || plan->options.distinct > 1) return;
  int *passes = thr_calloc((size_t)plan->frame.n_edges, sizeof *passes);
  if (!passes) return;

  /* The last ones first: a cord is taken away for good if enough passes are left where it goes. */
  int n = 0;
  thr_cords_add_passes(plan->cord, plan->n_cords, 1, passes);
  for (int i = plan->n_cords - 1; i >= 0; i--) {
    const thr_cord *cord = &plan->cord[i];
    bool is_needed = false;
    thr_cords_add_passes(cord, 1, -1, passes);
    for (int j = 0; j < cord->n_passes && !is_needed; j++) {
      const int edge = cord->half[j] / 2;
      is_needed = passes[edge] < thr_plan_cover(&plan->frame, &plan->options, edge);
    }
    if (is_needed) thr_cords_add_passes(cord, 1, 1, passes);
    n += !is_needed;
  }
  free(passes);

  if (n)
    cli_note("note: %d of the %d cords only %s what others pass: %d would do", n, plan->n_cords,
             n > 1 ? "repeat" : "repeats", plan->n_cords - n);
}

/* Makes a plan for a framework and writes all that is asked for. Releases the framework, of which
 * the plan has a copy. Returns an exit code. */
static int plan_frame(const plan_arguments *args, thr_frame *framework)
{
  thr_err err = {0};
  planned_result result = {0};
  thr_request options = thr_request_default();

  plan_ask(args, args->request.objective, &options);

  /* The request. */
  int code = apply_physics(args, framework, &options);
  if (!code) code = request_args_apply(&args->request, framework, &options);
  if (args->guard.seconds < 0 && plan_is_recommended(args, &options))
    options.time_limit = 0; /* its work is counted */
  if (code == EXIT_OK) {
    /* The search. Whoever watches, or may end the command, has its plan before it is written. */
    thr_status st = make_plan(args, framework, &options, &result, &err);
    const bool is_watched = guard_deadline() > 0 || progress_wanted();
    best_end(is_watched ? &result.plan : &(thr_plan){0});
    thr_frame_destroy(framework);

    /* A plan that is not proved within the limits is a plan, with EXIT_LIMIT. */
    int planned_code = st ? EXIT_LIMIT : EXIT_OK;
    const bool is_plan = st == THR_OK || (st == THR_ELIMIT && result.plan.n_cords > 0);
    if (is_plan) note_idle_limit(args, &result.plan);
    if (is_plan) note_repeats(args, &result.plan);
    if (is_plan) code = plan_write_outputs(args, &result, &planned_code);
    if (code == EXIT_OK) code = st ? cli_fail(&err) : planned_code;
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
  int code = plan_find_places(args, &end->kept, &places);
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
  if (code >= 0 || (code = plan_try_places(&args))) return code;

  /* The child does all of the work, the parent waits and concludes. */
  if (guard_fork(&args.guard, &end)) return conclude(&args, &end);

  if ((code = cli_read_frame(args.path, &args.frame, &framework))) return code;
  code = plan_frame(&args, &framework);

  return guard_alone(code, &end) ? conclude(&args, &end) : code;
}
