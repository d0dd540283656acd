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
#include "graph/os.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>

static const char intro[] =
    "thread convert FRAME [FILE] [options]: a framework, read and checked, in another format\n\n"
    "Examples:\n"
    "  thread convert dome.json dome.dxf                 the name says the format\n"
    "  thread convert shell.stl --flat 1 -o shell.obj    without the diagonals of flat faces\n"
    "  thread convert dome.obj --scale 1000 --units mm --feet lowest -o dome.json\n"
    "  thread convert - -T csv < dome.json | wc -l\n";

/* What was asked. */
typedef struct {
  cli_frame_args frame;
  guard_limits guard;
  const char *output, *type;
} convert_arguments;

/* What help says of the formats that are written, once cmd_convert has listed them. */
static char output_help[160], types[80];

static const cli_option own_options[] = {
    {"output", 'o', "FILE", output_help, .kind = CLI_TEXT,
     .offset = offsetof(convert_arguments, output)},
    {"type", 'T', types, "the format, if the file's name does not say (default: json)",
     .kind = CLI_TEXT, .offset = offsetof(convert_arguments, type)},
    {0}};

/* Tells whether the second of two files named may be meant to be read, too: a file of the same
 * ending, as `thread convert *.obj` names it. */
static bool is_input(const char *path, const char *second)
{
  const char *ending = strrchr(path, '.'), *other = strrchr(second, '.');
  return ending && other && strcmp(ending, other) == 0 && thr_os_is_file(second);
}

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
  code = cli_write(&text, output);
  if (!code && cli_json) code = answer_frame(&frame, output);
  thr_frame_destroy(&frame);

  return code;
}

/* Runs `thread convert` and returns the exit code. */
int cmd_convert(int argc, char **argv)
{
  static const cli_syntax syntax = {"convert", intro, NULL};
  convert_arguments args = {cli_frame_args_default(), guard_limits_default(), .output = "-"};
  guard_end end;
  const cli_group groups[] = {{"Options", own_options, &args},
                              {NULL, guard_options, &args.guard},
                              {"Framework", cli_frame_options, &args.frame},
                              {NULL}};

  /* The formats, for help. */
  char list[120];
  thr_formats_written(list, sizeof list, ".", ", ", " or ");
  snprintf(output_help, sizeof output_help, "%s (default: stdout)", list);
  thr_formats_written(types, sizeof types, "", "|", "|");

  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* The framework, and perhaps the file to write, which -o may say instead. */
  const int operands = argc - optind;
  if (operands == 0) return cli_usage("convert", "which framework?");
  if (operands > 2) return cli_usage("convert", "one framework at a time, and one file to write");
  if (operands == 2 && cli_given("output"))
    return cli_usage("convert", "%s and --output %s: one file to write", argv[optind + 1],
                     args.output);
  if (operands == 2) args.output = argv[optind + 1];
  if (operands == 2 && is_input(argv[optind], args.output))
    return cli_usage("convert", "%s is there and of the format of %s; -o %s replaces it",
                     args.output, argv[optind], args.output);

  /* The output's name and --type must agree. */
  const thr_format *format;
  if (!cli_output_format("convert", args.output, args.type, &format)) return EXIT_USAGE;

  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "nothing is written");

  return convert(argv[optind], &args.frame, format, args.output);
}
