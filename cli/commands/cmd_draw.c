/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread draw: makes pictures, steps, tables and lines of a plan.
 *
 * All documents stand in one table (lib/documents.h): name, usual file, and what makes it. --type
 * names one of them, or all; -o names a file, or a folder in which the document has its usual name.
 * Options say how documents are drawn (cli/drawings.h), and are ignored by those that have no use
 * for them.
 *
 * No document may take the place of a file that the command reads: outputs are claimed
 * (cli/files.c) before anything is drawn. The drawing is done in a child process, whose limits on
 * time and memory leave the documents that are there already.
 *
 * Example: `thread draw plan.json -T all -o diagrams/` writes overview.svg, steps.txt, sheets.pdf
 * and more into diagrams/. */
#include "cli/cli.h"
#include "cli/drawings.h"
#include "diagram/overview/overview.h"
#include "graph/io/read.h"
#include "graph/plan/plan.h"
#include "graph/text.h"
#include "lib/documents.h"

#include <stdio.h>
#include <string.h>

static const char help[] =
    "thread draw PLAN [options]: pictures, steps, tables and lines of a plan\n\n"
    "Examples:\n"
    "  thread draw plan.json -o overview.svg\n"
    "  thread draw plan.json -o diagrams/            overview.svg in that folder\n"
    "  thread draw plan.json -T all -o diagrams/     all documents there\n"
    "  thread draw plan.json -T pdf                  sheets.pdf: step by step on paper, with "
    "pictures\n"
    "  thread draw plan.json -T steps                steps.txt: row by row, to be ticked off\n"
    "  thread draw plan.json --color tension         after `thread eval plan.json -o plan.json`\n"
    "  thread draw plan.json --color turning         the sharper a turn the darker\n\n"
    "Options:\n"
    "  -T, --type TYPE      what to make (default: svg)\n"
    "                       svg         overview.svg, the picture of all cords\n"
    "                       pdf         sheets.pdf: what to prepare, each step with its picture, "
    "what to do last\n"
    "                       steps       steps.txt: each path to learn once, then its copies\n"
    "                       html        viewer.html: step by step in space, in any browser\n"
    "                       steps.csv   a row per piece that the needle comes to: arms, turn, cord "
    "used\n"
    "                       cords.csv   the cut list: a row per cord, with tails and allowances\n"
    "                       beads.csv   the bead schedule: a row per piece, kinds, arms, bores\n"
    "                       channels.csv   which pass goes from which arm to which, piece by "
    "piece, and what crosses\n"
    "                       obj, gltf   cords.obj, cords.gltf: cords as lines for CAD and Blender\n"
    "                       all         all of these, into the folder of -o, else the current one\n"
    "                       mat         mat.pdf: the outlines of all pieces, true to size, to lay "
    "them out on\n"
    "                       labels      labels.svg: the pieces' names as outlines, true to size, "
    "to raise on printed pieces\n"
    "                       poster      poster.pdf: the overview over several sheets, to glue "
    "together; --pitch says how large\n"
    "                       sheets.html sheets.html: the pages of sheets.pdf for any browser, "
    "which prints them\n"
    "                       dxf         cords.dxf: a layer, a colour and a polyline in space for "
    "each cord\n"
    "                       compas      cords.json: COMPAS polylines\n"
    "      --lanes          obj, gltf, dxf, compas: passes of an edge side by side, so that none "
    "coincide\n"
    "      --up y|z         obj, dxf, compas: which coordinate points up (default: z; glTF always: "
    "y)\n"
    "      --color cord|tension|turning   what colours of the overview tell apart: cords "
    "(default), how\n"
    "                       tight each pass is, or how sharply the cord turns\n"
    "      --pitch MM       millimetres on paper per edge (default: 24, less for large "
    "frameworks)\n" DRAWINGS_HELP GUARD_HELP
    "  -o, --output FILE|DIR   (default: its usual name in the current folder; - = stdout)\n"
    "  -h, --help\n\n"
    "Exit codes: 0 drawn, 2 usage, 3 not a plan, 5 not all drawn in the time or memory\n";

enum { OPTION_PITCH = OPTION_FREE, OPTION_COLOR, OPTION_LANES };
static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      {"type", required_argument, NULL, 'T'},
                                      {"pitch", required_argument, NULL, OPTION_PITCH},
                                      {"color", required_argument, NULL, OPTION_COLOR},
                                      {"lanes", no_argument, NULL, OPTION_LANES},
                                      {"up", required_argument, NULL, OPTION_UP},
                                      DRAWINGS_OPTIONS,
                                      GUARD_OPTIONS,
                                      {"output", required_argument, NULL, 'o'},
                                      {NULL, 0, NULL, 0}};

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

/* Runs `thread draw` and returns the exit code: EXIT_LIMIT if not all was drawn in the time or
 * memory. */
int cmd_draw(int argc, char **argv)
{
  int done, option;
  drawings_args args = {0};
  guard_limits guard = guard_limits_default();
  guard_end end;
  int color = THR_COLOUR_CORD, type = 0;
  int up = 1;
  const char *output = NULL;

  while ((option = cli_next_option(argc, argv, "draw", ":" CLI_COMMON_LETTERS "T:o:", table, help,
                                   &done)) != -1) {
    if (option == 'T' &&
        !cli_choose("draw", "--type", optarg, type_name, thr_documents_count() + 1, &type))
      return EXIT_USAGE;

    /* Options that several commands share, then those of this one. */
    bool ok = true;
    if ((drawings_option(&args, "draw", option, optarg, &ok) ||
         guard_option(&guard, "draw", option, optarg, &ok)) &&
        !ok)
      return EXIT_USAGE;

    if (option == OPTION_PITCH && !cli_double("draw", "--pitch", optarg, 2, 200, &args.pitch_mm))
      return EXIT_USAGE;
    if (option == OPTION_COLOR &&
        !cli_choose("draw", "--color", optarg, thr_overview_colour_name, THR_N_COLOURS, &color))
      return EXIT_USAGE;

    if (option == 'o') output = optarg;
    if (option == OPTION_LANES) args.lines.lanes = true;
    if (option == OPTION_UP && !cli_choose("draw", "--up", optarg, up_name, 2, &up))
      return EXIT_USAGE;
  }

  if (done >= 0) return done;

  /* Choices that cli_choose returns as numbers. */
  args.colour = (thr_overview_colour)color;
  args.lines.up_y = up == 0;
  bool all = type == thr_documents_count();

  /* The output must fit what is made. */
  if (output && !*output) return cli_usage("draw", "an empty name is no place to write to");
  if (all && output && strcmp(output, "-") == 0)
    return cli_usage("draw", "--type all makes several files: -o names a folder");
  if (!all && output && cli_misnamed(output, thr_document_file(type)))
    return cli_usage("draw", "%s: --type %s makes %s; say which type", output, type_name(type),
                     thr_document_file(type));

  /* One operand: the plan. */
  if (optind + 1 != argc)
    return cli_usage("draw", optind == argc ? "which plan?" : "one plan at a time");

  /* No document may take the place of a file that is read. */
  const char *folder = !output ? "." : cli_is_folder(output) || all ? output : NULL;
  const int claimed = folder ? drawings_claim("draw", folder, all ? -1 : type) : EXIT_OK;
  if (claimed) return claimed;

  /* The child does all of the work. */
  if (guard_fork(&guard, &end))
    return guard_conclude(&end, all ? "not all documents are drawn" : "nothing is drawn");

  thr_plan plan;

  int code = cli_read_plan(argv[optind], &plan);
  if (code) return code;

  /* All documents, or one. */
  if (all) {
    char names[DRAWINGS_NAMES];
    drawings_names(&plan, &args, names);
    code = drawings_write_all(&plan, output ? output : ".", &args);
    if (!code && !output) cli_note("drawn in the current folder: %s", names);
  } else
    code = draw_one(&plan, type, output, &args);

  /* Documents that show how to thread also say how loose the work is meanwhile. */
  if (!code && (all || thr_document_threads(type))) note_chains(&plan, &args);
  thr_plan_destroy(&plan);

  return code;
}
