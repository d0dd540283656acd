/* The options of the closed-form pull force, shared by eval and compare. */
#ifndef THR_PULL_H
#define THR_PULL_H

#include "cli/cli.h"
#include "eval/capstan.h"

enum {
  OPTION_PULL_MU = OPTION_FREE,
  OPTION_PULL_SEATING,
  OPTION_PULL_END,
  OPTION_PULL_METHOD,
  OPTION_PULL_JSON,
  OPTION_PULL_FREE
};
#define PULL_OPTIONS                                                                                                             \
  {"mu", required_argument, NULL, OPTION_PULL_MU}, {"seating", required_argument, NULL, OPTION_PULL_SEATING},                    \
      {"pull", required_argument, NULL, OPTION_PULL_END}, {"method", required_argument, NULL, OPTION_PULL_METHOD},               \
  {                                                                                                                              \
    "json", no_argument, NULL, OPTION_PULL_JSON                                                                                  \
  }
#define PULL_HELP                                                                                                                \
  "      --mu MU          friction coefficient cord on bead (default: the plan's)\n"                                             \
  "      --seating N      tension in newton that must reach the slackest point (default: 1)\n"                                   \
  "      --pull start|end|both   which end of each cord is pulled (default: both)\n"                                             \
  "      --method capstan closed form, force = seating tension x exp(mu x turning) (default, and the only one yet)\n"

typedef struct {
  thr_capstan_options capstan;
  bool mu_given; /* else each plan's own mu */
  bool json;
} pull_args;

pull_args pull_args_default(void);
/* Takes one of the options above; false if it is none of them. *ok false: its value was bad (printed). */
bool pull_option(pull_args *a, const char *command, int option, const char *value, bool *ok);
/* Evaluates a plan; prints and returns the exit code on failure. */
int pull_eval(const pull_args *a, const char *path, const thr_plan *p, thr_capstan *out);
const char *pull_name(thr_pull pull);

#endif
