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

/* Parses a size as 500MB, 2GB or bytes; 0 = no limit, less than 50 MB is refused. Returns false if
 * it is bad (printed). */
static bool parse_memory(const char *command, const char *value, double *bytes)
{
  static const struct {
    const char *name;
    double bytes;
  } unit[] = {{"", 1}, {"MB", 1e6}, {"M", 1e6}, {"GB", 1e9}, {"G", 1e9}};
  char *end;
  double number = strtod(value, &end), least = 50e6, most = 1e15;

  /* A number and one of the units. */
  for (size_t i = 0; i < sizeof unit / sizeof *unit && end != value; i++) {
    *bytes = number * unit[i].bytes;
    if (strcmp(end, unit[i].name) == 0 && (*bytes == 0 || (*bytes >= least && *bytes <= most)))
      return true;
  }

  cli_usage(command, "--memory %s: expected 50MB or more, as 500MB or 2GB, or 0 for any", value);

  return false;
}

bool guard_option(guard_limits *limits, const char *command, int option, const char *value,
                  bool *ok)
{
  /* 0 s and 0 bytes mean any. */
  *ok = true;
  switch (option) {
  case OPTION_TIME:
    *ok = cli_double(command, "--time-limit", value, 0, 1e9, &limits->seconds);
    return true;

  case OPTION_MEMORY: *ok = parse_memory(command, value, &limits->memory); return true;
  default: return false;
  }
}

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
