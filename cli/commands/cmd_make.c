/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread make: makes an example framework: dome, geodesic dome, sphere, tube, honeycomb, row, arch
 * or a row of bends (graph/framework/frame.h).
 *
 * Example: `thread make dome --size 7 -o dome.json` makes a grid of 7 x 7 nodes with a foot at each
 * corner. */
#include "cli/cli.h"
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char intro[] =
    "thread make SHAPE [options]: an example framework\n\n"
    "Examples:\n"
    "  thread make dome --size 7 -o dome.json        7 x 7 nodes, feet at the four corners\n"
    "  thread make tube --size 12 --rings 7 -o tube.obj\n\n"
    "Shapes (what --size counts):\n"
    "  dome       square grid, domed, a foot at each corner (nodes per side)\n"
    "  geodesic   geodesic dome standing on its rim (frequency)\n"
    "  sphere     closed geodesic sphere (frequency)\n"
    "  tube       square grid rolled up, standing on its first ring (nodes around)\n"
    "  honeycomb  hexagonal grid, domed (rings of hexagons)\n"
    "  row        straight, lying (nodes)\n"
    "  arch       equal edges round a circle, standing on two feet (nodes)\n"
    "  alternating  a row of equal bends, each turned over from the last (nodes)\n";

/* Returns the shape of that name; prints which ones there are, with the nearest name, and returns
 * -1 if there is none. */
static int find_shape(const char *name)
{
  char question[THR_SUGGESTION_TEXT];
  thr_suggestion suggestion = {.word = name};

  for (int i = 0; i < THR_N_SHAPES; i++) {
    if (strcmp(name, thr_shape_name(i)) == 0) return i;
    thr_suggestion_try(&suggestion, thr_shape_name(i));
  }

  /* No such shape: which one was meant? */
  thr_suggestion_ask(&suggestion, question);
  cli_usage(
      "make",
      "there is no shape %s; there are dome, geodesic, sphere, tube, honeycomb, row, arch and "
      "alternating%s",
      name, question);

  return -1;
}

typedef struct {
  thr_make_options wanted; /* usual values of the shape where nothing is said */
  const char *output;
} make_arguments;

#define AT(member) .offset = offsetof(make_arguments, member)

/* What help says of the formats that are written, once cmd_make has listed them. */
static char output_help[160];

static const cli_option own_options[] = {
    {"size", .value = "N", .kind = CLI_COUNT, AT(wanted.size), .low = 1, .high = 1000000,
     .help = "see above"},
    {"rings", .value = "N", .kind = CLI_COUNT, AT(wanted.rings), .low = 1, .high = 1000000,
     .help = "tube: rings along the axis"},
    {"pitch", .value = "MM", .kind = CLI_AMOUNT, AT(wanted.pitch), .low = 1e-6, .high = 1e9,
     .help = "distance between neighbours in mm"},
    {"rise", .value = "R", .kind = CLI_AMOUNT, AT(wanted.rise), .high = 100,
     .help = "dome, honeycomb, arch: height over half span; alternating: tangent of half a bend"},
    {"twist", .value = "DEG", .kind = CLI_AMOUNT, AT(wanted.twist), .low = 60, .high = 180,
     .help = "alternating: from each bend to the next (default: 180, a zigzag)"},
    {"output", 'o', "FILE", output_help, .kind = CLI_TEXT, AT(output)},
    {0}};

/* The usual values of a shape, and over them what was said. */
static bool apply_options(const make_arguments *args, thr_make_options *options)
{
  const bool has_twist = options->shape == THR_MAKE_ALTERNATING,
             has_rise = has_twist || options->shape == THR_MAKE_DOME ||
                        options->shape == THR_MAKE_HONEYCOMB || options->shape == THR_MAKE_ARCH;
  const char *foreign = cli_given("rings") && options->shape != THR_MAKE_TUBE ? "--rings"
                        : cli_given("rise") && !has_rise                      ? "--rise"
                        : cli_given("twist") && !has_twist                    ? "--twist"
                                                                              : NULL;
  if (foreign) {
    cli_usage("make", "a %s has no %s", thr_shape_name(options->shape), foreign);
    return false;
  }
  if (cli_given("size")) options->size = args->wanted.size;
  if (cli_given("rings")) options->rings = args->wanted.rings;
  if (cli_given("pitch")) options->pitch = args->wanted.pitch;
  if (cli_given("rise")) options->rise = args->wanted.rise;
  if (cli_given("twist")) options->twist = args->wanted.twist;
  return true;
}

/* Makes the framework and writes it. Returns an exit code. */
static int make(const thr_make_options *options, const thr_format *format, const char *output)
{
  thr_err err = {0};
  thr_draft draft = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_text text = {0};

  /* The shape as a draft, then as a framework. */
  thr_status st = thr_make(&draft, options, &err);

  if (!st) st = thr_draft_build(&draft, -1, &frame, &report, &err);
  if (!st) thr_frame_write(&frame, format, &text);

  /* Bad sizes are the user's, not a file's. */
  int code = st == THR_EINPUT ? cli_usage("make", "%s", err.text)
             : st             ? cli_fail(&err)
                              : cli_write(&text, output);
  if (!code && cli_json) code = answer_frame(&frame, output);
  if (!code && strcmp(output, "-") == 0 && cli_is_terminal(STDOUT_FILENO))
    cli_note("this is the framework as a file; -o dome.json keeps it, and thread plan dome.json "
             "plans it");

  thr_draft_destroy(&draft);
  thr_frame_destroy(&frame);

  return code;
}

/* Runs `thread make` and returns the exit code. */
int cmd_make(int argc, char **argv)
{
  static const cli_syntax syntax = {"make", intro, NULL};
  make_arguments args = {.output = "-"};
  const cli_group groups[] = {{"Options", own_options, &args}, {NULL}};

  /* The formats, for help. */
  char list[120];
  thr_formats_written(list, sizeof list, ".", ", ", " or ");
  snprintf(output_help, sizeof output_help, "%s (default: JSON on stdout)", list);

  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* One operand: the shape. */
  if (optind + 1 != argc)
    return cli_usage(
        "make",
        optind == argc
            ? "which shape? dome, geodesic, sphere, tube, honeycomb, row, arch or alternating"
            : "one shape at a time");

  /* The output's name says the format. */
  int shape = find_shape(argv[optind]);
  if (shape < 0) return EXIT_USAGE;

  const thr_format *format;
  if (!cli_output_format("make", args.output, NULL, &format)) return EXIT_USAGE;

  /* Defaults depend on the shape. */
  thr_make_options options = thr_make_options_default((thr_shape)shape);

  return apply_options(&args, &options) ? make(&options, format, args.output) : EXIT_USAGE;
}
