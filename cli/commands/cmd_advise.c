/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread advise: makes a plan for every number of cords and kind of ends that may be worth its
 * cord, prints a table of them, and recommends the one with the fewest cords that a hand can pull.
 *
 * The pull at the hardest end, N, grows with exp(mu x turning), so that a cord with half of the
 * turning needs only the square root of that factor. A hand manages 10 N time after time, 50 N at
 * most (graph/plan/plan_measures.h); recommended is what stays within the hand even at the upper
 * end of the band of mu.
 *
 * The searches are thr_advise's (planner/advise.c), the table is cli/print/advice_table.c. This
 * file parses the options, shows rows on a terminal as they are found, asks the recommended cords
 * from which pull on they hold the pieces, and writes table, picture, plan or JSON. --cords, with
 * --ends, takes another row than the recommended one, and its plan is the one that is written.
 *
 * Example: of the 7 x 7 dome `thread advise dome.json` recommends 4 cords to the feet, pulled with
 * 3.27 N at most. */
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/os.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"
#include "graph/plan/request.h"
#include "lib/lib.h"
#include "planner/planner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char intro[] =
    "thread advise FRAME [options]: how many cords, and from where, so that a hand can pull "
    "them\n\n"
    "Examples:\n"
    "  thread advise dome.json                       a table, and the command that makes its best "
    "row\n"
    "  thread advise dome.json -T svg -o advice.svg  pull and cord against the number of cords\n"
    "  thread advise shell.obj --feet lowest --seating 2 --mu 0.25\n";
static const char outro[] =
    "Every row is a plan whose cord that turns most turns as little as was found in its part of "
    "the time. Steps are the passes of those cords that are no mirrored or turned copies of "
    "others, and their ends if they may be anywhere: what is to be learned.\n"
    "Exit codes: 0 a row is recommended, 2 usage, 3 bad input, 4 no row stays within the hand "
    "(table printed), or no threading, 5 no row in time";

enum { TYPE_TEXT, TYPE_SVG, TYPE_PLAN, N_TYPES };

/* The command line. Strings point into argv. */
typedef struct {
  cli_frame_args frame;
  cli_physics physics;
  guard_limits guard;
  thr_request request;
  const char *path, *output;
  double hand;
  int type, cords, ends; /* cords: of the row that is taken; 0 = the recommended one */
  bool progress;
} advise_arguments;

static const char *type_name(int type)
{
  static const char *const name[] = {"text", "svg", "plan"};
  return name[type];
}

static bool take_hand(void *into, const cli_option *option, const char *value)
{
  (void)option;
  return cli_hand("advise", value, &((advise_arguments *)into)->hand);
}

#define AT(member) .offset = offsetof(advise_arguments, member)

static const cli_option own_options[] = {
    {"type", 'T', NULL, "a table (default), a picture, or the recommended plan", .kind = CLI_WORD,
     AT(type), .word = type_name, .n_words = N_TYPES},
    {"cords", .value = "K", .kind = CLI_COUNT, AT(cords), .low = 1, .high = THR_MOST_CORDS,
     .help = "with -T plan: the plan of the row of K cords instead, the first one if --ends does "
             "not say which"},
    {"ends", .kind = CLI_WORD, AT(ends), .word = thr_ends_name, .n_words = THR_ENDS_FEET + 1,
     .help = "of the row that --cords takes"},
    {"output", 'o', "FILE", "(default: stdout)", .kind = CLI_OUTPUT, AT(output)},
    {"progress", .kind = CLI_FLAG, AT(progress),
     .help = "a line of JSON on stderr each time a row is found or better, and as soon as it is "
             "known which one is recommended"},
    {"hand", .value = "N", .kind = CLI_OTHER, .take = take_hand,
     .help = "what the pull is to stay within, in newton, even at the upper end of the band of mu "
             "(default: 10, what a hand manages time after time; one: 50, the most; two: 100)"},
    {0}};

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT, .help = "for all rows together, 0 = until every search has ended (without "
                               "it less than a second, counted: the same rows on every machine)"},
    {0}};

/* Parses the command line into *args. Returns -1 to go on, or the exit code of the command. */
static int parse(int argc, char **argv, advise_arguments *args)
{
  static const cli_syntax syntax = {"advise", intro, outro};
  static cli_option asked[2];
  *args = (advise_arguments){.frame = cli_frame_args_default(),
                             .guard = guard_limits_default(),
                             .request = thr_request_default(),
                             .output = "-",
                             .hand = thr_hand_always};
  asked[0] = request_option_of("cover");
  const cli_group groups[] = {{"Options", own_options, args},
                              {NULL, asked, &args->request},
                              {NULL, time_options, &args->guard},
                              {NULL, guard_memory_options, &args->guard},
                              {"Framework", cli_frame_options, &args->frame},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &args->physics},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  if (args->progress) progress_begin();

  /* One operand: the framework. */
  if (optind + 1 != argc)
    return cli_usage("advise", optind == argc ? "which framework?" : "one framework at a time");
  args->path = argv[optind];

  /* Outputs. */
  const bool is_plan = args->type == TYPE_PLAN;
  if (args->cords > 0 && !is_plan) return cli_usage("advise", "--cords takes a row for -T plan");
  if (cli_given("ends") && args->cords == 0)
    return cli_usage("advise", "--ends says which row --cords takes: give both");
  if (is_plan && cli_no_plan_name("advise", args->output)) return EXIT_USAGE;
  if (cli_json && args->type != TYPE_TEXT && strcmp(args->output, "-") == 0)
    return cli_usage("advise", "--json and the %s both want stdout; -o FILE takes the %s",
                     is_plan ? "plan" : "picture", is_plan ? "plan" : "picture");

  return -1;
}

/* ---- rows as they are found ---- */

/* Columns that a terminal has at least on which rows are shown as they are found. */
enum { WIDE = 125 };

/* What is known while rows are found. */
typedef struct {
  const thr_frame *frame;
  const thr_physics *physics;
  double base_length;
  bool shown; /* on a terminal: rows are printed as they are found .. */
  int lines;  /* .. so many lines, which the finished table takes the place of */
  bool wants_plan;
  thr_text plan; /* the recommended one as JSON, if it is wanted and there is one .. */
  thr_status st; /* .. and whether it passed its check */
  thr_err err;
} table_state;

/* Tells programs of a row. */
static void tell_row(const char *what, const thr_advice_row *row)
{
  thr_text text = {0};
  if (!progress_wanted()) return;

  thr_writer writer = progress_open(&text, what);
  thr_advice_put_row(&writer, row);
  progress_close(&writer);
}

/* Keeps a plan as `thread plan` writes it. */
static void keep_plan(table_state *state, thr_plan *plan)
{
  int dropped;
  thr_text_destroy(&state->plan);
  thr_frame_keep_hash(&plan->frame);
  thr_plan_write(plan, &state->plan);
  state->st = thr_plan_confirm(plan, &state->plan, "plan.json", &dropped, &state->err);
  if (!state->st) guard_keep(&state->plan);
}

/* Tells which row is recommended, and keeps its plan as `thread plan` writes it, which a page has
 * before the table is whole. Signature of thr_advise_options.recommended. */
static void keep_recommended(void *user, const thr_advice_row *row, thr_plan *plan)
{
  table_state *state = user;
  tell_row("recommended", row);
  if (state->wants_plan) keep_plan(state, plan);
}

/* Shows a row that was found or got better on a terminal. Signature of thr_advise_options.row. */
static void show_row(void *user, const thr_advice_row *row)
{
  table_state *state = user;
  thr_text text = {0};

  tell_row("row", row);
  if (!state->shown) return;

  /* The head comes with the first row, and takes four lines. */
  cli_progress_wipe();
  if (state->lines == 0) {
    advice_put_head(&text, state->frame, state->physics);
    state->lines = 4;
  }

  /* Printed at once: the next row may take seconds. */
  advice_put_row(&text, row, state->base_length, "");
  print_fit(&text, 0);
  if (!text.failed) fputs(text.data, stdout);
  fflush(stdout);
  state->lines++;
  thr_text_destroy(&text);
}

/* Removes the rows that were shown: moves the cursor up and erases to the end of the screen. The
 * finished table takes their place. */
static void wipe_rows(const table_state *state)
{
  if (state->lines > 0) printf("\033[%dA\033[J", state->lines);
}

/* ---- outputs ---- */

/* Draws pull and cord against the number of cords. command: that makes the recommended plan. */
static thr_status draw(const advise_arguments *args, const thr_frame *frame,
                       const thr_advice *advice, const char *command, thr_text *text, thr_err *err)
{
  char stem[256];
  cli_stem(args->path, stem, sizeof stem);
  return thr_advice_svg(
      advice, &(thr_advice_chart){.name = stem, .units = frame->units, .command = command}, text,
      err);
}

/* Writes the table as JSON: to stdout where the picture has the file. Returns an exit code. */
static int write_json(const advise_arguments *args, const thr_frame *frame,
                      const thr_advice *advice, const advice_commands *commands,
                      const thr_plan *chosen)
{
  thr_text text = {0};
  advice_put_json(&(thr_writer){.out = &text}, frame, advice, advice_put_command, commands, chosen);
  thr_text_append(&text, "\n");
  return cli_write(&text, args->type == TYPE_TEXT ? args->output : "-");
}

/* Writes table, picture or JSON; with JSON and a picture both. Returns an exit code. */
static int write_advice(const advise_arguments *args, const thr_frame *frame,
                        const thr_advice *advice)
{
  const advice_commands commands = {args->path, &args->physics, advice->hand};
  const thr_advice_row *row = advice->chosen >= 0 ? &advice->row[advice->chosen] : NULL;
  const bool is_table = args->type == TYPE_TEXT;
  thr_text text = {0}, command = {0};
  thr_err err = {0};
  thr_status st = THR_OK;
  int code = EXIT_OK;
  thr_plan chosen = {0};

  if (row) st = thr_advice_plan(frame, &args->request, row, &chosen, &err);

  /* Text or picture, which names the command that makes the recommended plan. */
  if (row) advice_put_command(&commands, row, &command);
  if (!st && args->type == TYPE_SVG)
    st = draw(args, frame, advice, command.data ? command.data : "", &text, &err);
  else if (!st && is_table && !cli_json)
    advice_put_table(&text, frame, advice, advice_put_command, &commands);
  text.failed |= command.failed;

  /* From which pull on the recommended cords hold the pieces. */
  if (!st && !cli_json && is_table && row) advice_put_holding(&text, &chosen);
  if (args->type == TYPE_SVG) answer_file(args->output, "the table as a picture");
  if (!st && cli_json) code = write_json(args, frame, advice, &commands, row ? &chosen : NULL);

  if (!st && is_table)
    print_fit(&text, strcmp(args->output, "-") == 0 ? thr_os_columns(STDOUT_FILENO) : 0);

  /* With --json text on stdout is the table; the picture goes to its file all the same. */
  if (!code && args->type != TYPE_PLAN && (st || !cli_json || !is_table))
    code = cli_write_drawn(st, &text, args->output, &err);
  else if (st)
    code = cli_fail(&err);

  thr_plan_destroy(&chosen);
  thr_text_destroy(&text);
  thr_text_destroy(&command);
  return code;
}

/* Returns the row that the command line takes: the recommended one, or what --cords and --ends say;
 * NULL: there is none, which is said. */
static const thr_advice_row *taken_row(const advise_arguments *args, const thr_advice *advice)
{
  for (int i = 0; i < advice->n && args->cords > 0; i++)
    if (advice->row[i].cords == args->cords &&
        (!cli_given("ends") || (int)advice->row[i].ends == args->ends))
      return &advice->row[i];

  if (args->cords == 0 && advice->chosen >= 0) return &advice->row[advice->chosen];
  if (args->cords == 0 && !cli_json)
    cli_error("no plan: no number of cords stays within the hand");
  else if (args->cords > 0)
    cli_error("--cords %d: the table has no such row%s", args->cords,
              cli_given("ends") ? " with these --ends" : "");
  return NULL;
}

/* Writes the table, or the plan of the row that is taken, or with --json both. Returns an exit
 * code.
 */
static int write_all(const advise_arguments *args, const thr_frame *frame, const thr_advice *advice,
                     table_state *state)
{
  if (args->type != TYPE_PLAN) return write_advice(args, frame, advice);

  const thr_advice_row *row = taken_row(args, advice);
  if (!row && args->cords > 0) return EXIT_INFEASIBLE;
  if (row)
    answer_file(args->output, args->cords > 0 ? "the plan of the row" : "the recommended plan");
  const int code = cli_json ? write_advice(args, frame, advice) : EXIT_OK;
  if (code || !row) return code ? code : EXIT_INFEASIBLE;

  /* The recommended plan is kept with its proofs. */
  if (advice->chosen < 0 || row != &advice->row[advice->chosen]) {
    thr_plan plan;
    thr_text_destroy(&state->plan);
    state->st = thr_advice_plan(frame, &args->request, row, &plan, &state->err);
    if (!state->st) keep_plan(state, &plan);
    thr_plan_destroy(&plan);
  }
  return state->st ? cli_fail(&state->err) : cli_write(&state->plan, args->output);
}

/* Finds and writes the advice for a framework. Returns an exit code. */
static int advise(advise_arguments *args, const thr_frame *frame)
{
  thr_advice advice;
  thr_err err = {0};
  thr_physics resolved;
  int code = cli_physics_apply(&args->physics, &args->request.physics);

  if (code) return code;
  if (thr_physics_resolve(&args->request.physics, frame, &resolved, &err)) return cli_fail(&err);

  /* On a wide terminal rows are shown as they are found. */
  table_state state = {.frame = frame,
                       .physics = &resolved,
                       .base_length = args->request.cover * thr_frame_total_length(frame)};
  const int columns = thr_os_columns(STDOUT_FILENO); /* 0: the terminal does not say */
  state.wants_plan = args->type == TYPE_PLAN;
  state.shown = (columns == 0 || columns >= WIDE) && args->type == TYPE_TEXT && !cli_json &&
                !cli_quiet && strcmp(args->output, "-") == 0 && cli_is_terminal(STDOUT_FILENO);

  /* The search, whose work is counted unless a time was given. */
  const thr_advise_options options = {
      .hand = args->hand, .row = show_row, .recommended = keep_recommended, .user = &state};
  double work = 0;
  thr_limits limits = advice_limits(args->guard.seconds, &work);
  cli_step("trying numbers of cords", "");
  thr_status st = thr_advise(frame, &args->request, &options, &limits, &advice, &err);
  cli_progress_end();

  /* The finished table takes the place of the rows. */
  wipe_rows(&state);
  if (!st) code = write_all(args, frame, &advice, &state);
  thr_text_destroy(&state.plan);
  if (st) return cli_fail(&err);

  /* What a user should know of the table. */
  if (!advice.complete)
    cli_note(
        "note: the time was over before all numbers of cords were tried; --time-limit gives more");
  if (!code && advice.chosen < 0 && args->cords == 0) code = EXIT_INFEASIBLE;
  thr_advice_destroy(&advice);

  return code;
}

/* Runs `thread advise` and returns the exit code. */
int cmd_advise(int argc, char **argv)
{
  advise_arguments args;
  thr_frame frame;
  guard_end end;
  int code = parse(argc, argv, &args);

  if (code >= 0) return code;

  /* The child does all of the work. */
  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "no advice");
  if ((code = cli_read_frame(args.path, &args.frame, &frame))) return code;
  code = advise(&args, &frame);
  thr_frame_destroy(&frame);

  return code;
}
