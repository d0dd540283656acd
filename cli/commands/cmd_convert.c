/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread convert: reads a framework, checks it, and writes it in another format.
 *
 * The name of the output says the format; --type says it where there is no name. Reading merges
 * nodes, drops edges and guesses units as the options say (graph/io/read.h); what was done is noted
 * on stderr, and only the framework that is left is written.
 *
 * Example: `thread convert shell.stl --flat 1 -o shell.obj` writes the edges of a mesh without the
 * diagonals of flat faces. */
#include "cli/cli.h"
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/text.h"

#include <stdio.h>

static const char help[] =
    "thread convert FRAME [options]: a framework, read and checked, in another format\n\n"
    "Examples:\n"
    "  thread convert shell.stl --flat 1 -o shell.obj    the mesh's edges, without diagonals of "
    "flat faces\n"
    "  thread convert dome.obj --scale 1000 --units mm --feet lowest -o dome.json\n"
    "  thread convert - -T csv < dome.json | wc -l\n\n"
    "Options:\n"
    "  -o, --output FILE    .json, .obj, .csv, .ply, .dxf or .graphml (default: stdout)\n"
    "  -T, --type json|obj|csv|ply|dxf|graphml   the format, if the file's name does not say "
    "(default: json)\n" CLI_FRAME_HELP GUARD_HELP
    "  -q, --quiet          no notes                                                            "
    "-h, --help\n";

static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      CLI_FRAME_OPTIONS,
                                      GUARD_OPTIONS,
                                      {"output", required_argument, NULL, 'o'},
                                      {"type", required_argument, NULL, 'T'},
                                      {NULL, 0, NULL, 0}};

/* Reads and writes. Returns an exit code. */
static int convert(const char *path, const cli_frame_args *args, const thr_format *format,
                   const char *output)
{
  thr_frame frame;
  thr_text text = {0};
  int code = cli_read_frame(path, args, &frame);

  if (code) return code;

  /* The whole text is made first, so that a failure leaves no half of a file. */
  thr_frame_write(&frame, format, &text);
  thr_frame_destroy(&frame);

  return cli_write(&text, output);
}

/* Runs `thread convert` and returns the exit code. */
int cmd_convert(int argc, char **argv)
{
  int done, option;
  bool ok;
  const char *output = "-", *type = NULL;
  cli_frame_args args = cli_frame_args_default();
  guard_limits guard = guard_limits_default();
  guard_end end;

  while ((option = cli_next_option(argc, argv, "convert", ":" CLI_COMMON_LETTERS "o:T:", table,
                                   help, &done)) != -1) {
    if (cli_frame_option(&args, "convert", option, optarg, &ok) ||
        guard_option(&guard, "convert", option, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
    } else if (option == 'o') {
      output = optarg;
    } else if (option == 'T') {
      type = optarg;
    }
  }

  if (done >= 0) return done;

  /* One operand: the framework. */
  if (optind + 1 != argc)
    return cli_usage("convert", optind == argc ? "which framework?" : "one framework at a time");

  /* The output's name and --type must agree. */
  const thr_format *format;
  if (!cli_output_format("convert", output, type, &format)) return EXIT_USAGE;

  if (guard_fork(&guard, &end)) return guard_conclude(&end, "nothing is written");

  return convert(argv[optind], &args, format, output);
}
