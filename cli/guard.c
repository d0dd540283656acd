/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds time and memory of a command whatever it does: it runs in a child process whose memory the
 * system bounds, and which is ended when its time is over. What the child has found so far it hands
 * to its parent, which outlives it.
 *
 *    guard_end end;
 *    if (guard_fork(&limits, &end)) return conclude(&end);   the parent, after the child's end
 *    ..                                                       the child goes on as a command does
 *
 * This file has the limits of a command as options, and the words for one that was ended. The two
 * processes are in guard_process.c. */
#include "cli/cli.h"

#include <stdlib.h>
#include <string.h>

guard_limits guard_limits_default(void)
{
  return (guard_limits){.seconds = -1, .memory = 2e9};
}

/* Reads the value of --memory: a number of bytes, or of MB or GB. 0 is no limit; other limits are
 * 50 MB at least. */
static bool take_memory(void *into, const cli_option *option, const char *value)
{
  double *bytes = &((guard_limits *)into)->memory;
  static const struct {
    const char *name;
    double bytes;
  } unit[] = {{"", 1}, {"MB", 1e6}, {"M", 1e6}, {"GB", 1e9}, {"G", 1e9}};
  char *end;
  (void)option;
  double number = strtod(value, &end), least = 50e6, most = 1e15;

  /* A number and one of the units. */
  for (size_t i = 0; i < sizeof unit / sizeof *unit && end != value; i++) {
    *bytes = number * unit[i].bytes;
    if (strcmp(end, unit[i].name) == 0 && (*bytes == 0 || (*bytes >= least && *bytes <= most)))
      return true;
  }
  cli_usage(cli_command_name(), "--memory %s: expected 50MB or more, as 500MB or 2GB, or 0 for any",
            value);

  return false;
}

#define MEMORY                                                                                     \
  {                                                                                                \
    "memory", .value = "SIZE", .kind = CLI_OTHER, .take = take_memory,                             \
              .help = "give up beyond so much memory, as 500MB or 2GB, 0 = any (default: 2GB)"     \
  }

const cli_option guard_options[] = {
    {GUARD_TIME_LIMIT, .help = "give up after S seconds, 0 = never (default: 0)"}, MEMORY, {0}};
const cli_option guard_memory_options[] = {MEMORY, {0}};

int guard_conclude(guard_end *end, const char *missing)
{
  thr_text_destroy(&end->kept);
  if (end->reason == GUARD_DONE) return end->code;

  /* The child was ended: by a limit, a signal, or an accident. */
  cli_error("%s: %s", end->why, missing);

  /* A result that is out keeps its exit code. */
  if (end->written) return end->code;

  return end->reason == GUARD_DIED ? EXIT_INTERNAL : EXIT_LIMIT;
}
