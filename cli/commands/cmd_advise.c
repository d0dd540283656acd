/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread advise: how many cords, and from where. */
#include "cli/advice.h"
#include "cli/args/args.h"
#include "cli/args/request_args.h"
#include "cli/cli.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/limits.h"
#include "graph/plan/advice.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "planner/planner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char intro[] =
    "thread advise FRAME [options]: how many cords, and from where, so that a hand can pull "
    "them\n\n"
    "Examples:\n"
    "  thread advise dome.json                       a table, one line of it recommended, and the "
    "command that makes its plan\n"
    "  thread advise dome.json -T svg -o advice.svg  pull and cord against the number of cords\n"
    "  thread advise shell.obj --feet lowest --seating 2 --mu 0.25\n";
static const char outro[] =
    "Every row is a plan whose cord that turns most turns as little as was found in its part of "
    "the time. Steps are the\n"
    "passes of those cords that are no mirrored or turned copies of others, and their ends if they "
    "may be anywhere: what\n"
    "is to be learned.\n"
    "Exit codes: 0 a row is recommended, 2 usage, 3 bad input, 4 no row stays within the hand "
    "(table printed), or no\n"
    "threading, 5 no row in time\n";

enum { TYPE_TEXT, TYPE_SVG, N_TYPES };

typedef struct {
  cli_frame_args frame;
  cli_physics physics;
  guard_limits guard;
  thr_request request;
  const char *path, *output;
  double hand;
  int type;
  bool json;
} arguments;

static const char *type_name(int type)
{
  return type == TYPE_SVG ? "svg" : "text";
}

static bool take_hand(void *into, const cli_option *option, const char *value)
{
  (void)option;
  return cli_hand("advise", value, &((arguments *)into)->hand);
}

#define AT(member) .offset = offsetof(arguments, member)

static const cli_option own_options[] = {
    {"type", 'T', NULL, "a table (default), or a picture", .kind = CLI_WORD, AT(type),
     .word = type_name, .n_words = N_TYPES},
    {"output", 'o', "FILE", "(default: stdout)", .kind = CLI_OUTPUT, AT(output)},
    {"json", .kind = CLI_FLAG, AT(json),
     .help = "the table as JSON, with -T svg on stdout beside the picture in -o"},
    {"hand", .value = "N", .kind = CLI_OTHER, .take = take_hand,
     .help = "what the pull is to stay within, in newton, even at the upper end of the band of mu "
             "(default: 10, what a hand manages time after time; one: 50, the most; two: 100)"},
    {0}};

static const cli_option time_options[] = {
    {GUARD_TIME_LIMIT, .help = "for all rows together, 0 = until every search has ended (without "
                               "it some two seconds, counted: the same rows on every machine)"},
    {0}};

static int parse(int argc, char **argv, arguments *a)
{
  static const cli_syntax syntax = {"advise", intro, outro};
  static cli_option asked[2];
  *a = (arguments){.frame = cli_frame_args_default(),
                   .guard = guard_limits_default(),
                   .request = thr_request_default(),
                   .output = "-",
                   .hand = thr_hand_always};
  asked[0] = request_option_of("cover");
  const cli_group groups[] = {{"Options", own_options, a},
                              {NULL, asked, &a->request},
                              {NULL, time_options, &a->guard},
                              {NULL, guard_memory_options, &a->guard},
                              {"Framework", cli_frame_options, &a->frame},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &a->physics},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (optind + 1 != argc)
    return cli_usage("advise", optind == argc ? "which framework?" : "one framework at a time");
  a->path = argv[optind];
  if (a->json && a->type == TYPE_SVG && strcmp(a->output, "-") == 0)
    return cli_usage("advise",
                     "--json and the picture both want stdout; -o FILE takes the picture");
  return -1;
}

/* ---- rows as they are found ---- */

/* The cords that a row measures. */
typedef struct {
  thr_ends ends;
  int cords, n;
  thr_cord *cord; /* [n] owned */
} laid;

typedef struct {
  const thr_frame *frame;
  const thr_physics *physics;
  double base_length;
  bool shown; /* on a terminal: rows are printed as they are found .. */
  int lines;  /* .. so many lines, which the finished table takes the place of */
  laid *kept; /* [n_kept] owned */
  int n_kept;
} live;

/* Keeps a copy of the cords of a plan, as those of a row. Without memory for it there is nothing to
 * say of these cords. */
static void keep_cords(live *l, const thr_advice_row *row, const thr_plan *plan)
{
  int i = 0;
  while (i < l->n_kept && (l->kept[i].ends != row->ends || l->kept[i].cords != row->cords))
    i++;
  if (i == l->n_kept) {
    laid *more = thr_realloc(l->kept, (size_t)i + 1, sizeof *more);
    if (!more) return;
    l->kept = more;
    l->kept[l->n_kept++] = (laid){.ends = row->ends, .cords = row->cords};
  }
  thr_cords_destroy(l->kept[i].cord, l->kept[i].n);
  const thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &l->kept[i].cord, NULL);
  l->kept[i].n = st ? 0 : plan->n_cords;
}

static void forget_cords(live *l)
{
  for (int i = 0; i < l->n_kept; i++)
    thr_cords_destroy(l->kept[i].cord, l->kept[i].n);
  free(l->kept);
}

/* Lays out a plan with the recommended cords, all of it borrowed; false if they are not kept. */
static bool chosen_plan(const live *l, const thr_request *request, const thr_advice *advice,
                        thr_plan *plan)
{
  for (int i = 0; i < l->n_kept && advice->chosen >= 0; i++) {
    const thr_advice_row *row = &advice->row[advice->chosen];
    const laid *kept = &l->kept[i];
    if (kept->ends != row->ends || kept->cords != row->cords || kept->n == 0) continue;
    *plan =
        (thr_plan){.frame = *l->frame, .cord = kept->cord, .n_cords = kept->n, .options = *request};
    return true;
  }
  return false;
}

static void show_row(void *user, const thr_advice_row *row, const thr_plan *plan)
{
  live *l = user;
  thr_text text = {0};
  if (plan) keep_cords(l, row, plan);
  if (!l->shown) return;
  cli_progress_wipe();
  if (l->lines == 0) {
    advice_put_head(&text, l->frame, l->physics);
    l->lines = 4;
  }
  advice_put_row(&text, row, l->base_length, "");
  if (!text.failed) fputs(text.data, stdout);
  fflush(stdout);
  l->lines++;
  thr_text_destroy(&text);
}

static void wipe_rows(const live *l)
{
  if (l->lines > 0) printf("\033[%dA\033[J", l->lines);
}

/* ---- outputs ---- */

static thr_status draw(const arguments *a, const thr_frame *frame, const thr_advice *advice,
                       const char *command, thr_text *text, thr_err *err)
{
  char stem[256];
  cli_stem(a->path, stem, sizeof stem);
  return thr_advice_svg(
      advice, &(thr_advice_chart){.name = stem, .units = frame->units, .command = command}, text,
      err);
}

/* To stdout where the picture has the file. */
static int write_json(const arguments *a, const thr_frame *frame, const thr_advice *advice,
                      const char *command, const thr_plan *chosen)
{
  thr_text text = {0};
  advice_put_json(&(thr_writer){.out = &text}, frame, advice, command, chosen);
  thr_text_append(&text, "\n");
  return cli_write(&text, a->type == TYPE_SVG ? "-" : a->output);
}

static int write_advice(const arguments *a, const thr_frame *frame, const thr_advice *advice,
                        const live *l)
{
  thr_text text = {0}, options = {0}, command = {0};
  thr_err err = {0};
  thr_status st = THR_OK;
  int code = EXIT_OK;
  thr_plan chosen;
  const bool laid_out = chosen_plan(l, &a->request, advice, &chosen);
  advice_command_options(&a->physics, &options);
  if (advice->chosen >= 0)
    advice_put_command(&command, a->path, options.data ? options.data : "",
                       &advice->row[advice->chosen]);
  const char *words = command.data ? command.data : "";
  if (options.failed || command.failed)
    st = thr_nomem(&err);
  else if (a->type == TYPE_SVG)
    st = draw(a, frame, advice, words, &text, &err);
  else if (!a->json)
    advice_put_table(&text, frame, advice, words);
  if (!st && !a->json && a->type != TYPE_SVG && laid_out) advice_put_holding(&text, &chosen);
  if (!st && a->json) code = write_json(a, frame, advice, words, laid_out ? &chosen : NULL);
  if (!code && (st || !a->json || a->type == TYPE_SVG))
    code = cli_write_drawn(st, &text, a->output, &err);
  thr_text_destroy(&text);
  thr_text_destroy(&options);
  thr_text_destroy(&command);
  return code;
}

static int advise(arguments *a, const thr_frame *frame)
{
  thr_advice advice;
  thr_err err = {0};
  thr_physics resolved;
  int code = cli_physics_apply(&a->physics, &a->request.physics);
  if (code) return code;
  if (thr_physics_resolve(&a->request.physics, frame, &resolved, &err)) return cli_fail(&err);
  live l = {.frame = frame,
            .physics = &resolved,
            .base_length = a->request.cover * thr_frame_total_length(frame)};
  l.shown = a->type == TYPE_TEXT && !a->json && !cli_quiet && strcmp(a->output, "-") == 0 &&
            cli_is_terminal(STDOUT_FILENO);
  const thr_advise_options options = {.hand = a->hand, .row = show_row, .user = &l};
  double work = 0;
  thr_limits limits = advice_limits(a->guard.seconds, &work);
  thr_status st = thr_advise(frame, &a->request, &options, &limits, &advice, &err);
  cli_progress_end();
  wipe_rows(&l);
  if (!st) code = write_advice(a, frame, &advice, &l);
  forget_cords(&l);
  if (st) return cli_fail(&err);
  if (!advice.complete)
    cli_note(
        "note: the time was over before all numbers of cords were tried; --time-limit gives more");
  if (!code && advice.chosen < 0) code = EXIT_INFEASIBLE;
  thr_advice_destroy(&advice);
  return code;
}

int cmd_advise(int argc, char **argv)
{
  arguments a;
  thr_frame frame;
  guard_end end;
  int code = parse(argc, argv, &a);
  if (code >= 0) return code;
  if (guard_fork(&a.guard, &end)) return guard_conclude(&end, "no advice");
  if ((code = cli_read_frame(a.path, &a.frame, &frame))) return code;
  code = advise(&a, &frame);
  thr_frame_destroy(&frame);
  return code;
}
