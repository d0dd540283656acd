/* Options of the pull force. */
#include "cli/pull.h"

#include <string.h>

static const char *const name[] = {"start", "end", "both"}; /* as thr_pull */

const char *pull_name(thr_pull pull)
{
  return name[pull];
}

pull_args pull_args_default(void)
{
  return (pull_args){thr_capstan_options_default(), false, false};
}

static bool parse_pull(const char *command, const char *value, thr_pull *pull)
{
  for (int i = 0; i < 3; i++)
    if (strcmp(value, name[i]) == 0) {
      *pull = (thr_pull)i;
      return true;
    }
  cli_usage(command, "--pull %s: expected start, end or both", value);
  return false;
}

bool pull_option(pull_args *a, const char *command, int option, const char *value, bool *ok)
{
  *ok = true;
  switch (option) {
  case OPTION_PULL_MU:
    a->mu_given = true;
    *ok = cli_double(command, "--mu", value, 0, 100, &a->capstan.mu);
    return true;
  case OPTION_PULL_SEATING: *ok = cli_double(command, "--seating", value, 1e-9, 1e9, &a->capstan.seating); return true;
  case OPTION_PULL_END: *ok = parse_pull(command, value, &a->capstan.pull); return true;
  case OPTION_PULL_METHOD:
    *ok = strcmp(value, "capstan") == 0;
    if (!*ok) cli_usage(command, "--method %s: this version knows capstan only", value);
    return true;
  case OPTION_PULL_JSON: a->json = true; return true;
  default: return false;
  }
}

int pull_eval(const pull_args *a, const char *path, const thr_plan *p, thr_capstan *out)
{
  thr_err err = {0}, found = {0};
  thr_capstan_options o = a->capstan;
  if (!a->mu_given) o.mu = p->options.mu;
  thr_status st = thr_capstan_eval(&p->frame, p->cord, p->n_cords, &o, out, &found);
  if (!st) return EXIT_OK;
  thr_fail(&err, st, "%s: %s", path, found.text);
  return cli_fail(&err);
}
