/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread plan: framework in, plan and diagrams out. */
#include "cli/advice.h"
#include "cli/args/request_args.h"
#include "cli/cli.h"
#include "cli/drawings.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/limits.h"
#include "graph/os.h"
#include "graph/plan/advice.h"
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
    "thread plan FRAME [options]: plan how cord is threaded: shortest or turning least, proved, or "
    "symmetric\n\n"
    "Examples:\n"
    "  thread plan dome.obj                          plan.json, overview.svg, sheets.pdf and more "
    "in the folder dome/\n"
    "  thread plan dome.obj --cover 2 -o plan.json   two passes per interface; the plan only\n"
    "  thread plan dome.obj --cords 4 --ends feet --feet lowest --balance   four cords of much the "
    "same length\n"
    "  thread plan dome.obj --max-length 900 --ends any   as few cords as that takes\n"
    "  thread plan dome.obj --objective tortuosity   the cord that turns least: it pulls most "
    "easily\n"
    "  thread plan dome.obj --objective symmetry     a short path to learn, and its mirrored and "
    "turned copies\n"
    "  thread make dome | thread plan - -o - | thread check -\n";
static const char outro[] =
    "Exit codes: 0 as asked: the shortest, or within the gap; of other aims without --gap and "
    "--time-limit within any gap,\n"
    "which is said; 2 usage, 3 bad input, 4 infeasible or none found, 5 not as asked (plan "
    "written), 70 internal.\n"
    "What is said of cord and beads is stored in the plan; thread eval begins with it.\n";

/* ---- options ---- */

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
} arguments;

#define AT(member) .offset = offsetof(arguments, member)

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT,
     .help = "stop after S seconds with the best plan so far and its gap, 0 = never (default: 0; "
             "other objectives and tube joints: 20). --frontier, --compare-shortest and "
             "--compare-objectives share an S that is given; else each search has its 20 s. "
             "Drawings are made whole, and take their time. Without S --max-pull, one cord that "
             "turns least, and several by their largest turning, count their work instead, some "
             "three seconds, ten times as much for --max-pull where that finds no cords: the same "
             "plan on every machine, later on a busy one"},
    {0}};

static const cli_option output_options[] = {
    {"output", 'o', "FILE", "write the plan here (- = stdout), and no diagrams unless --draw",
     .kind = CLI_OUTPUT, AT(output)},
    {"draw", .value = "DIR", .kind = CLI_OUTPUT, AT(draw),
     .help = "write the diagrams into this folder, and without -o the plan too (no sheets.pdf for "
             "more than 1000 pieces: thread draw PLAN -T pdf makes it)"},
    {"force", .kind = CLI_FLAG, AT(force),
     .help = "in a folder named after FRAME, replace another plan (else FRAME-2, FRAME-3, ..)"},
    {"json", .kind = CLI_FLAG, AT(json), .help = "summary as JSON on stdout"},
    {"progress", .kind = CLI_FLAG, AT(progress),
     .help = "a line of JSON on stderr each time the plan or its bound is better"},
    {"compare-objectives", .kind = CLI_FLAG, AT(compare),
     .help = "pull of this plan beside those for the other objectives, joints simulated"},
    {0}};

static int parse(int argc, char **argv, arguments *a)
{
  static const cli_syntax syntax = {"plan", intro, outro};
  *a = (arguments){.frame = cli_frame_args_default(),
                   .symmetry = symmetry_args_default(),
                   .request = request_args_default(),
                   .guard = guard_limits_default(),
                   .drawings = {.quick = true}};
  pull_args_init(&a->pull, THR_JOINT);
  const cli_group groups[] = {
      {"What is planned", request_options(REQUEST_PLANNED), &a->request},
      {NULL, time_options, &a->guard},
      {NULL, guard_memory_options, &a->guard},
      {"Least turning (with --objective tortuosity)", request_options(REQUEST_TURNING),
       &a->request},
      {"Symmetry (with --objective symmetry; thread symmetries --help says more)",
       cli_symmetry_options, &a->symmetry},
      {"Framework", cli_frame_options, &a->frame},
      {"Output", output_options, a},
      {NULL, drawings_options, &a->drawings},
      {NULL, cli_processes_options, NULL},
      {NULL, pull_run_options, &a->pull},
      {CLI_PHYSICS_HEADING, cli_physics_options(), &a->pull.physics},
      {cli_tuned, request_options(REQUEST_TUNED), &a->request},
      {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (a->progress) progress_begin();
  if (optind + 1 != argc)
    return cli_usage("plan", optind == argc ? "which framework?" : "one framework at a time");
  a->path = argv[optind];
  if (a->output && cli_no_plan_name("plan", a->output)) return EXIT_USAGE;
  const char *wordy = a->json               ? "--json"
                      : a->compare          ? "--compare-objectives"
                      : a->request.frontier ? "--frontier"
                                            : NULL;
  if (wordy && a->output && strcmp(a->output, "-") == 0)
    return cli_usage("plan", "%s and -o - both want stdout", wordy);
  return request_args_check(&a->request, &a->symmetry, &a->wanted);
}

/* What is asked of an objective: what is about turning or symmetry concerns only one of them. */
static void ask(const arguments *a, thr_objective objective, thr_request *options)
{
  request_args_ask(&a->request, &a->symmetry, objective, options);
  if (options->order != THR_ORDER_PLANNED) options->needles = a->drawings.needles;
  options->time_limit =
      a->guard.seconds < 0 ? thr_dispatch_usual_seconds(options) : a->guard.seconds;
}

/* What was said of cord and beads must fit the framework; if nothing was, a framework of any size
 * will do. */
static int apply_physics(const arguments *a, const thr_frame *framework, thr_request *options)
{
  thr_err err = {0};
  thr_physics resolved;
  int code = cli_physics_apply(&a->pull.physics, &options->physics);
  if (code || a->pull.physics.n == 0) return code;
  return thr_physics_resolve(&options->physics, framework, &resolved, &err) ? cli_fail(&err)
                                                                            : EXIT_OK;
}

/* ---- the other objectives ---- */

/* code: why its pull is not known, EXIT_OK if it is. */
static void put_pull_json(thr_writer *writer, thr_objective objective, const thr_eval *eval,
                          int code)
{
  thr_write_object(writer, NULL);
  thr_write_string(writer, "objective", thr_objective_name(objective));
  thr_write_number(writer, "pull", code == EXIT_OK ? eval->record.largest : NAN);
  if (code == EXIT_OK) {
    thr_write_number(writer, "error", eval->error);
    thr_write_int(writer, "refused", eval->refused);
  }
  thr_write_close(writer);
}

static void put_pull(thr_text *text, const arguments *a, thr_objective objective, const thr_plan *p,
                     const thr_eval *eval, int code)
{
  thr_text_printf(text, "  %-12s", thr_objective_name(objective));
  if (code == EXIT_OK) {
    thr_text_printf(text,
                    eval->refused ? "%12.4g N (error at least %.3g %%" : "%12.4g N (+-%.3g %%",
                    eval->record.largest, pull_percent(eval->error));
    if (eval->refused)
      thr_text_printf(text, ": %d %s by closed form", eval->refused,
                      cli_plural(eval->refused, "turn", "turns"));
    thr_text_printf(text, ")%s", objective == a->request.objective ? "   this plan" : "");
    if (thr_wants_symmetry(&p->options))
      thr_text_printf(text, "   %d %s", p->n_cords, cli_plural(p->n_cords, "cord", "cords"));
  } else {
    thr_text_printf(text, "%14s", "not known");
  }
  thr_text_append(text, "\n");
}

static int put_objective(thr_writer *writer, const arguments *a, thr_objective objective,
                         const thr_plan *p)
{
  thr_eval eval;
  int code = pull_eval(&a->pull, thr_objective_name(objective), p, THR_JOINT, &eval);
  if (a->json)
    put_pull_json(writer, objective, &eval, code);
  else
    put_pull(writer->out, a, objective, p, &eval, code);
  thr_eval_destroy(&eval);
  return code;
}

/* Time that nobody asked for is no limit on work that is counted. *work: what limits count with. */
static thr_limits limits_for(const arguments *a, const thr_request *options, double seconds,
                             double *work)
{
  const bool unsaid = a->guard.seconds < 0;
  thr_limits limits = cli_limits((unsaid ? thr_dispatch_patience(options) : 1) * seconds);
  limits.usual = unsaid;
  *work = thr_dispatch_work(options);
  return unsaid && *work > 0 ? thr_limits_counted(&limits, work) : limits;
}

static int plan_and_put(thr_writer *writer, const arguments *a, thr_objective objective,
                        const thr_plan *p, double deadline)
{
  thr_err err = {0};
  thr_plan other = {0};
  if (objective == a->request.objective) return put_objective(writer, a, objective, p);
  thr_request options = p->options;
  ask(a, objective, &options);
  double work;
  thr_limits limits = limits_for(a, &options, options.time_limit, &work);
  if (deadline > 0) limits.deadline = deadline;
  thr_status st = thr_plan_make(&p->frame, &options, &limits, &other, NULL, &err);
  cli_progress_end();
  int code = st && st != THR_ELIMIT ? cli_fail(&err) : put_objective(writer, a, objective, &other);
  thr_plan_destroy(&other);
  return code;
}

/* Pull of this plan beside that of the plans for the other objectives. */
static int put_comparison(thr_writer *writer, const arguments *a, const thr_plan *p,
                          double deadline)
{
  int code = EXIT_OK;
  if (a->json)
    thr_write_array(writer, "objectives");
  else
    thr_text_append(writer->out, "\nlargest pull by objective, joints measured in simulation\n");
  for (int i = 0; i < THR_N_OBJECTIVES; i++) {
    int done = plan_and_put(writer, a, thr_dispatch_objective(i), p, deadline);
    if (!code) code = done;
  }
  if (a->json) thr_write_close(writer);
  return code;
}

/* What was planned. */
typedef struct {
  thr_plan plan;
  thr_report report;
} planned;

/* When all must be done: the plan and what it is held against share the time that was asked for; 0
 * = none was. */
static double deadline_of(const arguments *a)
{
  return a->guard.seconds > 0 ? guard_deadline() : 0;
}

/* Seconds for the search: of a time that was asked for what the rest leaves. */
static double time_of_plan(const arguments *a, const thr_request *options)
{
  bool more = a->request.compare || a->request.frontier || a->compare;
  return a->guard.seconds <= 0 ? options->time_limit
                               : thr_dispatch_search_seconds(options->time_limit, more);
}

static void put_plan(thr_writer *writer, const arguments *a, const planned *x,
                     const thr_rivals *rivals)
{
  if (a->json)
    plan_put_json(writer, &x->plan, rivals, x->report.word);
  else
    plan_put_summary(writer->out, &x->plan, rivals, x->report.word);
}

/* The frontier as a picture; where there is none, why. */
static int write_frontier(const arguments *a, const thr_plan *plan, const thr_rivals *rivals)
{
  const thr_frontier *frontier = &rivals->frontier;
  thr_err err = {0};
  thr_text svg = {0};
  thr_physics physics;
  char stem[256];
  if (frontier->n == 0) {
    cli_error("%s: nothing to draw: there is no frontier", a->request.plot);
    return EXIT_INPUT;
  }
  cli_stem(a->path, stem, sizeof stem);
  thr_frontier_mark *mark = thr_calloc((size_t)frontier->n, sizeof *mark);
  thr_status st = mark ? thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, &err)
                       : thr_nomem(&err);
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
  return cli_write_drawn(st, &svg, a->request.plot, &err);
}

static int put_turning(thr_writer *writer, const arguments *a, planned *x)
{
  thr_rivals rivals = {0};
  thr_err err = {0};
  thr_limits limits = cli_limits(0);
  limits.deadline = deadline_of(a);
  thr_status st = thr_rivals_make(&x->plan, &x->report.shortest, a->request.compare,
                                  a->request.frontier, &limits, &rivals, &err);
  cli_progress_end();
  if (a->request.frontier && !a->request.minimize && x->plan.options.cords > 1)
    cli_note("note: with --frontier all turning together is minimized; --minimize max-turning is "
             "for the cord that turns most");
  if (rivals.no_frontier.code) cli_note("no frontier: %s", rivals.no_frontier.text);
  put_plan(writer, a, x, &rivals);
  int code = st ? cli_fail(&err) : EXIT_OK;
  if (!code && a->request.plot) code = write_frontier(a, &x->plan, &rivals);
  thr_rivals_destroy(&rivals);
  return code;
}

static void put_symmetry(thr_writer *writer, const arguments *a, const planned *x)
{
  enum { ROWS = 8 };
  const thr_plan *p = &x->plan;
  if (!a->json) {
    symmetry_put_head(writer->out, &p->frame, &p->options, &x->report.symmetries);
    symmetry_put_table(writer->out, &p->options, &x->report.symmetries, ROWS);
    thr_text_append(writer->out, "\n");
  }
  put_plan(writer, a, x, NULL);
  if (!a->json) return;
  thr_write_object(writer, "symmetries");
  symmetry_put_table_json(writer, &p->options, &x->report.symmetries);
  thr_write_close(writer);
}

static int print_summary(const arguments *a, planned *x)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  int code = EXIT_OK;
  if (a->json) thr_write_object(&writer, NULL);
  if (thr_wants_turning(&x->plan.options))
    code = put_turning(&writer, a, x);
  else if (thr_wants_symmetry(&x->plan.options))
    put_symmetry(&writer, a, x);
  else
    put_plan(&writer, a, x, NULL);
  if (a->compare) {
    int done = put_comparison(&writer, a, &x->plan, deadline_of(a));
    if (!code) code = done;
  }
  if (a->json) {
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }
  int written = EXIT_OK;
  if (cli_quiet && !a->json) /* it was made for the picture */
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
} places;

/* Does the folder hold a plan, and not this text? */
static bool holds_another(const char *folder, const thr_text *text)
{
  char path[1200];
  thr_text there = {0};
  snprintf(path, sizeof path, "%s/plan.json", folder);
  if (access(path, F_OK) != 0) return false;
  bool same = !thr_text_read(&there, path, NULL) && there.length == text->length &&
              (text->length == 0 || memcmp(there.data, text->data, text->length) == 0);
  thr_text_destroy(&there);
  return !same;
}

/* dome, or the first of dome-2, dome-3, .. that holds no other plan, and no file that is read. */
static void find_folder(const arguments *a, const thr_text *text, char folder[280])
{
  enum { MOST = 1000 };
  char stem[256];
  cli_stem(a->path, stem, sizeof stem);
  snprintf(folder, 280, "%s", stem);
  const bool reads = drawings_would_lose(stem);
  for (int i = 2;
       i <= MOST && ((!a->force && holds_another(folder, text)) || drawings_would_lose(folder));
       i++)
    snprintf(folder, 280, "%s-%d", stem, i);
  if (strcmp(folder, stem) != 0)
    cli_note(reads ? "note: in %s a drawing would take the place of a file that is read: this plan "
                     "is in %s"
                   : "note: %s holds another plan: this one is in %s (--force replaces the other)",
             stem, folder);
}

/* Before the search: where drawings and the plan go unasked is tried, and no drawing takes the
 * place of a file that is named. */
static int try_places(const arguments *a)
{
  char stem[256];
  cli_stem(a->path, stem, sizeof stem);
  if (!a->draw && !a->output) return files_try_folder(stem);
  int code = a->draw ? drawings_claim("plan", a->draw, -1) : EXIT_OK;
  if (code || !a->draw || a->output) return code;
  char plan[1200];
  code = cli_in_folder(a->draw, "plan.json", plan, sizeof plan);
  return code ? code : files_claim("plan", "draw", plan);
}

static int find_places(const arguments *a, const thr_text *text, places *to)
{
  if (!a->draw && !a->output) find_folder(a, text, to->own);
  to->folder = a->draw ? a->draw : a->output ? NULL : to->own;
  to->plan = a->output ? a->output : to->in_folder;
  return to->folder ? cli_in_folder(to->folder, "plan.json", to->in_folder, sizeof to->in_folder)
                    : EXIT_OK;
}

/* What is written is first read back and checked as a whole, as by thread check: a claim that it
 * would refuse is not left. *code: of the plan, if it is kept. */
static int check_text(thr_text *text, const char *path, thr_plan *plan, int *code)
{
  thr_err err = {0};
  int dropped;
  if (text->failed) return EXIT_OK; /* writing says so */
  thr_status st =
      thr_plan_confirm(plan, text, strcmp(path, "-") == 0 ? "stdout" : path, &dropped, &err);
  if (st == THR_ENOMEM) return cli_fail(&err);
  if (st) {
    cli_error(
        "a fault of this program: the plan does not pass its own check, and is not written: %s",
        err.text);
    return EXIT_INTERNAL;
  }
  for (int claim = 1; claim <= THR_CLAIMS_ALL; claim *= 2)
    if (dropped & claim)
      cli_error("a fault of this program: what it proved of %s does not pass its own check, and is "
                "left out: %s",
                thr_claim_name(claim), err.text);
  if (dropped) *code = EXIT_LIMIT;
  return EXIT_OK;
}

/* From here on the plan is what this run leaves, with this exit code, which is another if the plan
 * lost a claim. Where it cannot be written, to->plan says where it is instead. */
static int write_plan(const arguments *a, thr_plan *p, places *to, int *code)
{
  thr_text text = {0};
  thr_frame_keep_hash(&p->frame);
  thr_plan_write(p, &text);
  int refused = find_places(a, &text, to);
  if (!refused) refused = check_text(&text, to->plan, p, code);
  if (refused) {
    thr_text_destroy(&text);
    to->plan = NULL;
    return refused;
  }
  guard_writing();
  int written = cli_write_kept(&text, &to->plan);
  guard_written(written ? written : *code);
  return written;
}

/* Was nothing said of what the plan is to be, and how long it may take? */
static bool is_usual(const arguments *a, const thr_request *options)
{
  return thr_wants_length(options) && !thr_wants_balance(options) &&
         request_args_usual(&a->request) && a->guard.seconds < 0 && !a->compare;
}

static void put_order(const arguments *a, const thr_plan *p, thr_text *text)
{
  thr_err err = {0};
  thr_text_append(text, "order    ");
  if (drawings_chains(p, &a->drawings, text, &err)) thr_text_append(text, err.text);
  thr_text_append(text, "\n");
}

/* Where the plan is and, unless folder is NULL, the drawings; and what to do if a hand cannot pull
 * it. */
static int print_places(const arguments *a, const thr_plan *p, const char *plan_path,
                        const char *folder)
{
  const bool usual = is_usual(a, &p->options);
  char names[DRAWINGS_NAMES];
  thr_text text = {0};
  thr_text_append(&text, a->compare || thr_wants_turning(&p->options) ? "\n" : "");
  thr_text_append(&text, "plan     ");
  thr_text_append_clean(&text, plan_path);
  drawings_names(p, &a->drawings, names);
  if (folder) {
    thr_text_append(&text, "\ndrawn    in ");
    thr_text_append_clean(&text, folder);
    thr_text_printf(&text, ": %s", names);
  }
  thr_text_append(&text, "\n");
  if (p->options.order == THR_ORDER_HAND || cli_verbose) put_order(a, p, &text);
  if (!usual) advice_put_hint(p, &text);
  int code = cli_write(&text, "-");
  if (code || !usual) return code;
  advice_put_after_plan(p, a->path, &a->pull.physics, &text);
  return cli_write(&text, "-");
}

/* Drawings are always whole: a limit on the time is the search's, not theirs. */
static int write_drawings(const arguments *a, const thr_plan *p, const places *to)
{
  if (!to->folder) return EXIT_OK;
  guard_allow(0);
  const int code = drawings_write_all(p, to->folder, &a->drawings);
  if (!code && drawings_no_sheets(p, &a->drawings))
    cli_note(
        "no sheets.pdf, which has hundreds of pages for more than %d pieces: thread draw %s -T pdf",
        DRAWINGS_SHEETS_PIECES, strcmp(to->plan, "-") == 0 ? "plan.json" : to->plan);
  return code;
}

/* *planned_code: of the plan; not 0 afterwards if a claim was left out. */
static int write_outputs(const arguments *a, planned *x, int *planned_code)
{
  thr_plan *p = &x->plan;
  places to = {0};
  const int written = write_plan(a, p, &to, planned_code);
  if (!to.plan) return written; /* there is none */
  const bool is_silent = strcmp(to.plan, "-") == 0 || (cli_quiet && !a->json && !a->request.plot);
  int code = is_silent ? EXIT_OK : print_summary(a, x);
  const int drawn = written ? EXIT_OK : write_drawings(a, p, &to);
  if (!code) code = drawn;
  if (!code && !is_silent && !a->json && !cli_quiet)
    code = print_places(a, p, to.plan, written ? NULL : to.folder);
  return written ? written : code;
}

/* Time that nobody asked for is the search's alone. */
static thr_status make_plan(const arguments *a, const thr_frame *framework,
                            const thr_request *options, planned *x, thr_err *err)
{
  double work;
  if (a->guard.seconds < 0)
    guard_allow(options->time_limit > 0
                    ? 1 + 1.1 * thr_dispatch_patience(options) * options->time_limit
                    : 0);
  thr_limits limits = limits_for(a, options, time_of_plan(a, options), &work);
  best_begin(framework, options);
  limits.found = best_found;
  thr_status st = thr_plan_make(framework, options, &limits, &x->plan, &x->report, err);
  cli_progress_end();
  if (cli_verbose) cli_note("search: ended, %.3f CPU s", thr_os_processor_seconds());
  if (a->guard.seconds < 0) guard_allow(0);
  return st;
}

/* Says why there is no plan: in one line, and with --json as an object, too. Returns the exit code.
 */
static int refuse(const arguments *a, const thr_err *err)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  const int code = cli_fail(err);
  if (!a->json || err->code == THR_ENOMEM) return code;
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "error", err->text);
  thr_write_int(&writer, "exit_code", code);
  thr_write_close(&writer);
  thr_text_append(&text, "\n");
  const int written = cli_write(&text, "-");
  return written ? written : code;
}

/* Releases the framework, of which the plan has its own. */
static int plan_frame(const arguments *a, thr_frame *framework)
{
  thr_err err = {0};
  planned x = {0};
  thr_request options = thr_request_default();
  ask(a, a->request.objective, &options);
  int code = apply_physics(a, framework, &options);
  if (!code) code = request_args_apply(&a->request, framework, &options);
  if (code == EXIT_OK) {
    thr_status st = make_plan(a, framework, &options, &x, &err);
    if (guard_deadline() > 0)
      best_found(NULL, x.plan.cord, x.plan.n_cords,
                 x.plan.symmetry.present ? &x.plan.symmetry : NULL);
    best_begin(NULL, NULL);
    thr_frame_destroy(framework);
    int planned_code = st ? EXIT_LIMIT : EXIT_OK;
    const bool is_plan = st == THR_OK || (st == THR_ELIMIT && x.plan.n_cords > 0);
    if (is_plan) code = write_outputs(a, &x, &planned_code);
    if (code == EXIT_OK) code = !is_plan ? refuse(a, &err) : st ? cli_fail(&err) : planned_code;
  }
  free(options.end_node);
  free(options.end_count);
  thr_plan_destroy(&x.plan);
  thr_report_destroy(&x.report);
  thr_frame_destroy(framework);
  return code;
}

/* Draws a plan that a search left which did not end by itself, in a process of its own: what fits
 * is drawn. */
static int draw_kept(const arguments *a, const places *to)
{
  const guard_limits limits = {.memory = a->guard.memory};
  guard_end end;
  thr_plan plan;
  thr_err err = {0};
  if (guard_fork(&limits, &end)) {
    guard_conclude(&end, "not all that was to be drawn fits");
    return EXIT_LIMIT;
  }
  int code = thr_plan_read(&plan, to->plan, &err) ? cli_fail(&err) : EXIT_OK;
  if (!code) code = drawings_write_all(&plan, to->folder, &a->drawings);
  if (!code) cli_note("drawn in %s", to->folder);
  return EXIT_LIMIT; /* of the search */
}

/* After the planning, in the parent if there is one: if it left no plan, but had some cords, they
 * are the plan. */
static int conclude(const arguments *a, guard_end *end)
{
  places to;
  if (end->written)
    return guard_conclude(end,
                          "the plan is written, but not all that was to be drawn or said of it");
  bool searched =
      end->code == EXIT_LIMIT || end->code == EXIT_INFEASIBLE || end->code == EXIT_INTERNAL;
  bool told = end->reason == GUARD_DONE && !searched; /* what the user wants to know */
  if (end->kept.length == 0 || told) return guard_conclude(end, "no plan was found");
  int code = find_places(a, &end->kept, &to);
  if (!code) code = cli_write_kept(&end->kept, &to.plan);
  thr_text_destroy(&end->kept);
  if (code) return code;
  cli_error("%s%s%s holds the best plan so far, of which nothing is proved", end->why,
            *end->why ? ": " : "", to.plan);
  if (to.folder && end->reason != GUARD_INTERRUPTED && strcmp(to.plan, "-") != 0)
    return draw_kept(a, &to);
  return EXIT_LIMIT;
}

int cmd_plan(int argc, char **argv)
{
  arguments a;
  thr_frame framework;
  guard_end end;
  int code = parse(argc, argv, &a);
  if (code >= 0 || (code = try_places(&a))) return code;
  if (guard_fork(&a.guard, &end)) return conclude(&a, &end);
  if ((code = cli_read_frame(a.path, &a.frame, &framework))) return code;
  code = plan_frame(&a, &framework);
  return guard_alone(code, &end) ? conclude(&a, &end) : code;
}
