/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the options of symmetric threading: the group, whether symmetries must be those of the
 * shape, and the order of the aims.
 *
 * Example: `--prefer steps` makes the order steps, overlap, paths, turning. */
#include "cli/args/args.h"

#include <stdio.h>
#include <string.h>

symmetry_args symmetry_args_default(void)
{
  const thr_request usual = thr_request_default();
  symmetry_args args = {.options = usual.symmetry};
  thr_aims_order(&usual, args.prefer);
  return args;
}

/* Reads the value of --prefer: the aims in the list come first, then the others in their usual
 * order. */
static bool take_prefer(void *into, const cli_option *option, const char *value)
{
  symmetry_args *args = into;
  const char *command = cli_command_name();
  bool taken[THR_N_AIMS] = {false};
  int n = 0;
  (void)option;
  if (!*value) cli_usage(command, "--prefer: what counts first?");

  /* The aims that are named, each once. */
  const char *word = value, *end = value;
  for (bool more = *value; more; more = *end, word = end + 1) {
    char name[16];
    int aim;
    end = word + strcspn(word, ",");
    snprintf(name, sizeof name, "%.*s", (int)(end - word), word);
    if (!cli_choose(command, "--prefer", name, thr_aim_name, THR_N_AIMS, &aim)) return false;
    if (taken[aim]) {
      cli_usage(command, "--prefer %s: %s is there twice", value, name);
      return false;
    }
    taken[aim] = true;
    args->prefer[n++] = (thr_aim)aim;
  }

  /* The others. n is 0 after an empty list, which was refused. */
  for (int aim = 0; aim < THR_N_AIMS && n; aim++) {
    if (!taken[aim]) {
      args->prefer[n++] = (thr_aim)aim;
    }
  }

  return n > 0;
}

/* Reads the value of --group: a number or a name, which is looked up later. */
static bool take_group(void *into, const cli_option *option, const char *value)
{
  symmetry_args *args = into;
  (void)option;

  /* A name that does not fit is refused. */
  snprintf(args->options.group, sizeof args->options.group, "%s", value);
  if (*value && strlen(value) < sizeof args->options.group) return true;
  cli_usage(cli_command_name(), "--group %s: expected a number or a name from `thread symmetries`",
            value);

  return false;
}

const cli_option cli_symmetry_options[] = {
    {"group", .value = "ID|NAME", .kind = CLI_OTHER, .take = take_group,
     .help = "the threading under this group: its number in the table of `thread symmetries`, or "
             "its name (C4v)"},
    {"geometric", .value = "TOL", .kind = CLI_AMOUNT,
     .offset = offsetof(symmetry_args, options.geometric), .high = 1,
     .help = "only symmetries of the shape: each node within TOL of the framework's size, 0 to 1 "
             "(default: those of the graph, whatever its shape)"},
    {"prefer", .value = "overlap,steps,paths,turning", .kind = CLI_OTHER, .take = take_prefer,
     .help = "what counts first, second, .. under each group; the others follow"},
    {0}};
