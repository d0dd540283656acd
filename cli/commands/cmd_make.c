/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread make: makes an example framework: dome, geodesic dome, sphere, tube or honeycomb
 * (graph/framework/make.h).
 *
 * Example: `thread make dome --size 7 -o dome.json` makes a grid of 7 x 7 nodes with a foot at each
 * corner. */
#include "cli/cli.h"
#include "graph/framework/frame.h"
#include "graph/framework/make.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/suggestion.h"
#include "graph/text.h"

#include <string.h>

static const char help[] =
    "thread make SHAPE [options]: an example framework\n\n"
    "Examples:\n"
    "  thread make dome --size 7 -o dome.json        7 x 7 nodes, feet at the four corners\n"
    "  thread make tube --size 12 --rings 7 -o tube.obj\n\n"
    "Shapes (what --size counts):\n"
    "  dome       square grid, domed, a foot at each corner (nodes per side)\n"
    "  geodesic   geodesic dome standing on its rim (frequency)\n"
    "  sphere     closed geodesic sphere (frequency)\n"
    "  tube       square grid rolled up, standing on its first ring (nodes around)\n"
    "  honeycomb  hexagonal grid, domed (rings of hexagons)\n\n"
    "Options:\n"
    "      --size N         see above\n"
    "      --rings N        tube: rings along the axis\n"
    "      --pitch MM       distance between neighbours in mm\n"
    "      --rise R         dome, honeycomb: height over half span\n"
    "  -o, --output FILE    .json, .obj, .csv, .ply, .dxf or .graphml (default: JSON on stdout)\n"
    "  -h, --help\n";

enum { OPTION_SIZE = OPTION_FREE, OPTION_RINGS, OPTION_PITCH, OPTION_RISE };
static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      {"size", required_argument, NULL, OPTION_SIZE},
                                      {"rings", required_argument, NULL, OPTION_RINGS},
                                      {"pitch", required_argument, NULL, OPTION_PITCH},
                                      {"rise", required_argument, NULL, OPTION_RISE},
                                      {"output", required_argument, NULL, 'o'},
                                      {NULL, 0, NULL, 0}};

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
  cli_usage("make", "there is no shape %s; there are dome, geodesic, sphere, tube and honeycomb%s",
            name, question);

  return -1;
}

/* The values of options, NULL = not given: which are valid depends on the shape, which comes
 * last. */
typedef struct {
  const char *output, *size, *rings, *pitch, *rise;
} make_arguments;

/* Checks the values against the shape and sets options. Returns false if one is bad or does not
 * belong to the shape (printed). */
static bool apply_options(const make_arguments *args, thr_make_options *options)
{
  bool has_rise = options->shape == THR_MAKE_DOME || options->shape == THR_MAKE_HONEYCOMB;

  /* Options of other shapes. */
  if ((args->rings && options->shape != THR_MAKE_TUBE) || (args->rise && !has_rise)) {
    cli_usage("make", "a %s has no %s", thr_shape_name(options->shape),
              args->rings && options->shape != THR_MAKE_TUBE ? "--rings" : "--rise");
    return false;
  }

  /* Sizes: pitch in mm, rise as a part of the half span. */
  if (args->size && !cli_int("make", "--size", args->size, 1, 1000000, &options->size))
    return false;
  if (args->rings && !cli_int("make", "--rings", args->rings, 1, 1000000, &options->rings))
    return false;
  if (args->pitch && !cli_double("make", "--pitch", args->pitch, 1e-6, 1e9, &options->pitch))
    return false;

  return !args->rise || cli_double("make", "--rise", args->rise, 0, 100, &options->rise);
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

  thr_draft_destroy(&draft);
  thr_frame_destroy(&frame);

  /* Bad sizes are the user's, not a file's. */
  if (st == THR_EINPUT) return cli_usage("make", "%s", err.text);

  return st ? cli_fail(&err) : cli_write(&text, output);
}

/* Runs `thread make` and returns the exit code. */
int cmd_make(int argc, char **argv)
{
  int done, option;
  make_arguments args = {.output = "-"};

  while ((option = cli_next_option(argc, argv, "make", ":" CLI_COMMON_LETTERS "o:", table, help,
                                   &done)) != -1) {
    switch (option) {
    case OPTION_SIZE: args.size = optarg; break;
    case OPTION_RINGS: args.rings = optarg; break;
    case OPTION_PITCH: args.pitch = optarg; break;
    case OPTION_RISE: args.rise = optarg; break;
    case 'o': args.output = optarg; break;
    }
  }

  if (done >= 0) return done;

  /* One operand: the shape. */
  if (optind + 1 != argc)
    return cli_usage("make", optind == argc
                                 ? "which shape? dome, geodesic, sphere, tube or honeycomb"
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
