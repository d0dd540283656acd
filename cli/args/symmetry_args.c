/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options of symmetric threading. */
#include "cli/args/symmetry_args.h"

#include <stdio.h>
#include <string.h>

symmetry_args symmetry_args_default(void)
{
  const thr_request usual = thr_request_default();
  symmetry_args a = {.options = usual.symmetry};
  thr_aims_order(&usual, a.prefer);
  return a;
}

/* The aims in the list, then the others in their usual order. */
static bool parse_prefer(const char *command, const char *value, thr_aim prefer[THR_N_AIMS])
{
  bool taken[THR_N_AIMS] = {false};
  int n = 0;
  const char *word = value, *end = value;
  if (!*value) cli_usage(command, "--prefer: what counts first?");
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
    prefer[n++] = (thr_aim)aim;
  }
  for (int aim = 0; aim < THR_N_AIMS && n; aim++)
    if (!taken[aim]) prefer[n++] = (thr_aim)aim;
  return n > 0;
}

bool symmetry_option(symmetry_args *a, const char *command, int option, const char *value, bool *ok)
{
  thr_symmetry_options *options = &a->options;
  const char *name;
  switch (option) {
  case OPTION_SYMMETRY_GROUP:
    name = "--group";
    *ok = *value && strlen(value) < sizeof options->group;
    if (*ok)
      snprintf(options->group, sizeof options->group, "%s", value);
    else
      cli_usage(command, "--group %s: expected a number or a name from `thread symmetries`", value);
    break;
  case OPTION_SYMMETRY_GEOMETRIC:
    name = "--geometric";
    *ok = cli_double(command, name, value, 0, 1, &options->geometric);
    break;
  case OPTION_SYMMETRY_PREFER:
    name = "--prefer";
    *ok = parse_prefer(command, value, a->prefer);
    a->preferred = true;
    break;
  default: return false;
  }
  if (!a->given) a->given = name;
  return true;
}
