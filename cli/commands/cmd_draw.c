/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread draw: makes pictures, steps, tables and lines of a plan.
 *
 * All documents stand in one table (lib/lib.h): name, usual file, and what makes it. --type
 * names one of them, or all; -o names a file, or a folder in which the document has its usual name.
 * Options say how documents are drawn (cli/commands/commands.h), and are ignored by those that have
 * no use for them.
 *
 * No document may take the place of a file that the command reads: outputs are claimed
 * (cli/files.c) before anything is drawn. The drawing is done in a child process, whose limits on
 * time and memory leave the documents that are there already.
 *
 * Example: `thread draw plan.json -T all -o diagrams/` writes overview.svg, steps.txt, sheets.pdf
 * and more into diagrams/. */
#include "cli/commands/commands.h"
#include "graph/io/json.h"
#include "graph/number.h"
#include "graph/plan/plan_measures.h"
#include "lib/lib.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char intro[] =
    "thread draw PLAN [options]: pictures, steps, tables and lines of a plan\n\n"
    "Examples:\n"
    "  thread draw plan.json -o overview.svg\n"
    "  thread draw plan.json -o diagrams/            overview.svg in that folder\n"
    "  thread draw plan.json -T all -o diagrams/     all documents there\n"
    "  thread draw plan.json -T pdf                  sheets.pdf: step by step on paper, with "
    "pictures\n"
    "  thread draw plan.json -T steps                steps.txt: row by row, to be ticked off\n"
    "  thread draw plan.json --color tension         after `thread eval plan.json -o plan.json`\n"
    "  thread draw plan.json --color turning         the sharper a turn the darker\n"
    "  thread draw plan.json -T picture -o dome.png  the pieces to print, with the cords in them\n";
static const char outro[] =
    "How the pieces come up, as a film and as stills in the booklet, is drawn by thread rise\n"
    "(--play, --film, --frames, --booklet).\n"
    "Exit codes: 0 drawn, 2 usage, 3 not a plan, 5 not all drawn in the time or memory";

/* Returns the value of --up for a choice: 0 = y, 1 = z. */
static const char *up_name(int up)
{
  return up ? "z" : "y";
}

/* Returns the name of a type of document, as --type takes it; the number of documents stands for
 * all of them. */
static const char *type_name(int t)
{
  return t < thr_documents_count() ? thr_document_type(t) : "all";
}

static const char *type_meaning(int t)
{
  return t < thr_documents_count() ? thr_document_meaning(t)
                                   : "the usual ones, into the folder of -o, else the current one";
}

/* What was asked. */
typedef struct {
  drawings_args drawings;
  guard_limits guard;
  int type, up;
  const char *output;
} draw_arguments;

/* Takes "1200x900". */
static bool take_size(void *into, const cli_option *option, const char *value)
{
  return cli_pixels("draw", option->name, value, 16, 10000,
                    ((draw_arguments *)into)->drawings.view.size);
}

/* Takes "-60,23", degrees. */
static bool take_view(void *into, const cli_option *option, const char *value)
{
  thr_kit_view *view = &((draw_arguments *)into)->drawings.view;
  int end = 0;
  (void)option;
  view->from = true;
  if (sscanf(value, "%lf,%lf%n", &view->azimuth, &view->elevation, &end) == 2 && !value[end] &&
      fabs(view->azimuth) <= 360 && fabs(view->elevation) <= 90) {
    view->azimuth *= THR_PI / 180;
    view->elevation *= THR_PI / 180;
    return true;
  }
  cli_usage("draw", "--view %s: expected two angles, around and up, as -60,23", value);
  return false;
}

#define AT(member) .offset = offsetof(draw_arguments, member)

static const cli_option own_options[] = {
    {"type", 'T', "TYPE", "what to make (default: svg)", .kind = CLI_WORD, AT(type),
     .word = type_name, .meaning = type_meaning},
    {"output", 'o', "FILE|DIR", "(default: its usual name in the current folder; - = stdout)",
     .kind = CLI_OUTPUT, AT(output)},
    {"lanes", .kind = CLI_FLAG, AT(drawings.lines.lanes),
     .help = "obj, gltf, dxf, compas: passes of an edge side by side, so that none coincide"},
    {"up", .kind = CLI_WORD, AT(up), .word = up_name, .n_words = 2,
     .help = "obj, dxf, compas: which coordinate points up (default: z; glTF always: y)"},
    {"color", .kind = CLI_WORD, AT(drawings.colour), .word = thr_overview_colour_name,
     .n_words = THR_N_COLOURS,
     .help = "what colours of the overview tell apart: cords (default), how tight each pass is, or "
             "how sharply the cord turns"},
    {"pitch", .value = "MM", .kind = CLI_AMOUNT, AT(drawings.pitch_mm), .low = 2, .high = 200,
     .help = "millimetres on paper per edge (default: 24, less for large frameworks)"},
    {"size", .value = "WxH", .kind = CLI_OTHER, .take = take_size,
     .help = "of the picture in pixels (default: 1200x900)"},
    {"view", .value = "AZ,EL", .kind = CLI_OTHER, .take = take_view,
     .help = "picture: from where it is seen, degrees from x towards y and above the ground "
             "(default: -60,23; of one piece: into its mouth)"},
    {"piece", .value = "NAME", .kind = CLI_TEXT, AT(drawings.piece),
     .help = "picture: this piece alone"},
    {"explode", .value = "X", .kind = CLI_AMOUNT, AT(drawings.view.explode), .low = 1, .high = 10,
     .help = "picture: pieces this many times as far from their middle (default: 1)"},
    {0}};

/* Writes one document to output: a file, a folder or NULL, the current folder. Returns an exit
 * code. */
static int draw_one(const thr_plan *plan, int type, const char *output, const drawings_args *args)
{
  char inside[1200];
  int code = EXIT_OK;

  /* The usual name, in the current folder or in the one that was named. */
  if (!output) output = thr_document_file(type);
  if (cli_is_folder(output)) {
    code = cli_in_folder(output, thr_document_file(type), inside, sizeof inside);
    output = inside;
  }

  return code ? code : drawings_write(plan, type, output, args);
}

/* Notes how many pieces are loose at a time at most while the plan is threaded. */
static void note_chains(const thr_plan *plan, const drawings_args *args)
{
  thr_text text = {0};
  if (!drawings_chains(plan, args, &text, NULL) && !text.failed) cli_note("%s", text.data);
  thr_text_destroy(&text);
}

/* Answers programs: the files, and the longest loose chain. Returns an exit code. */
static int answer(const char *path, const thr_plan *plan, const drawings_args *args)
{
  thr_err err = {0};
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  thr_chains chains;

  if (thr_plan_chains(plan, args->needles ? args->needles : plan->options.needles, &chains, &err))
    return cli_fail(&err);

  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "plan", path);
  answer_put_files(&writer);
  thr_write_int(&writer, "longest_loose_chain", chains.longest);
  return answer_close(&writer);
}

/* Runs `thread draw` and returns the exit code: EXIT_LIMIT if not all was drawn in the time or
 * memory. */
int cmd_draw(int argc, char **argv)
{
  static const cli_syntax syntax = {"draw", intro, outro};
  static cli_option own[sizeof own_options / sizeof *own_options];
  draw_arguments asked = {.guard = guard_limits_default(), .up = 1};
  guard_end end;
  memcpy(own, own_options, sizeof own_options);
  own[0].n_words = thr_documents_count() + 1;
  const cli_group groups[] = {{"Options", own, &asked},
                              {"Pages", drawings_options, &asked.drawings},
                              {NULL, guard_options, &asked.guard},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  drawings_args *args = &asked.drawings;
  const char *output = asked.output;
  const int type = asked.type;
  const bool all = type == thr_documents_count();
  args->lines.up_y = asked.up == 0;
  args->path = argv[optind];

  /* The output must fit what is made. */
  if (all && output && strcmp(output, "-") == 0)
    return cli_usage("draw", "--type all makes several files: -o names a folder");
  if (!all && output && cli_misnamed(output, thr_document_file(type)))
    return cli_usage("draw", "%s: --type %s makes %s; say which type", output, type_name(type),
                     thr_document_file(type));

  if (cli_json && output && strcmp(output, "-") == 0)
    return cli_usage("draw", "--json and -o - both want stdout");

  /* One operand: the plan. */
  if (optind + 1 != argc)
    return cli_usage("draw", optind == argc ? "which plan?" : "one plan at a time");

  /* No document may take the place of a file that is read. */
  const char *folder = !output ? "." : cli_is_folder(output) || all ? output : NULL;
  const int claimed = folder ? drawings_claim("draw", folder, all ? -1 : type) : EXIT_OK;
  if (claimed) return claimed;

  /* The child does all of the work. */
  if (guard_fork(&asked.guard, &end))
    return guard_conclude(&end, all ? "not all documents are drawn" : "nothing is drawn");

  thr_plan plan;

  code = cli_read_plan(argv[optind], &plan);
  if (code) return code;

  /* All documents, or one. */
  if (all) {
    char names[DRAWINGS_NAMES];
    drawings_names(&plan, args, names);
    code = drawings_write_all(&plan, output ? output : ".", args);
    if (!code && !output) cli_note("drawn in the current folder: %s", names);
  } else
    code = draw_one(&plan, type, output, args);

  /* Documents that show how to thread also say how loose the work is meanwhile. */
  if (!code && (all || thr_document_threads(type))) note_chains(&plan, args);
  if (!code && cli_json) code = answer(argv[optind], &plan, args);
  thr_plan_destroy(&plan);

  return code;
}
