/* Options about cords: how many, how long, where they end, and what fits through a bead. */
#include "cli/args/cords_args.h"
#include "eval/cord/knots.h"
#include "graph/framework/bore.h"
#include "graph/plan/physics.h"
#include "graph/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PASSES = 100 };

cords_args cords_args_default(void)
{
  const thr_request usual = thr_request_default();
  return (cords_args){.ends = "closed", .capacity = usual.capacity, .distinct = usual.distinct, .joint = usual.joint};
}

/* ---- parsing ---- */

static bool cords_number(const char *text, int n, int *out)
{
  char number[16];
  if (n <= 0 || n >= (int)sizeof number) {
    cli_usage("plan", "--cords: expected a number of cords, A..B, ..B or auto");
    return false;
  }
  snprintf(number, sizeof number, "%.*s", n, text);
  return cli_int("plan", "--cords", number, 1, THR_MOST_CORDS, out);
}

/* "4", "2..4", "..4", "auto". */
static bool parse_cords(cords_args *a, const char *value)
{
  const char *dots = strstr(value, "..");
  a->automatic = strcmp(value, "auto") == 0;
  a->least = 1;
  a->most = THR_MOST_CORDS;
  if (a->automatic) return true;
  if (!dots) {
    bool ok = cords_number(value, (int)strlen(value), &a->most);
    a->least = a->most;
    return ok;
  }
  if (dots > value && !cords_number(value, (int)(dots - value), &a->least)) return false;
  if (!cords_number(dots + 2, (int)strlen(dots + 2), &a->most)) return false;
  if (a->least <= a->most) return true;
  cli_usage("plan", "--cords %s: the first number is the smaller one", value);
  return false;
}

/* "50" is newtons, "20x" times the seating tension. */
static bool parse_pull(cords_args *a, const char *value)
{
  char number[64];
  size_t n = strlen(value);
  a->pull_is_factor = n > 1 && value[n - 1] == 'x';
  snprintf(number, sizeof number, "%.*s", (int)(a->pull_is_factor ? n - 1 : n), value);
  if (!cli_double("plan", "--max-pull", number, 0, 1e100, &a->max_pull)) return false;
  if (a->max_pull == 0) cli_usage("plan", "--max-pull 0: a cord needs some pull");
  return a->max_pull > 0;
}

static bool parse_force(const char *option, const char *value, double *newtons)
{
  if (!cli_double("plan", option, value, 0, 1e100, newtons)) return false;
  if (*newtons == 0) cli_usage("plan", "%s 0: expected a force in newtons", option);
  return *newtons > 0;
}

bool cords_option(cords_args *a, int option, const char *value, bool *ok)
{
  int i = 0;
  switch (option) {
  case OPTION_CORDS: *ok = parse_cords(a, value); return true;
  case OPTION_CORDS_MAX_LENGTH:
    *ok = cli_double("plan", "--max-length", value, 0, 1e100, &a->max_length);
    if (*ok && a->max_length == 0) {
      cli_usage("plan", "--max-length 0: a cord has some length");
      *ok = false;
    }
    return true;
  case OPTION_CORDS_MAX_PULL: *ok = parse_pull(a, value); return true;
  case OPTION_CORDS_HAND: *ok = cli_hand("plan", value, &a->hand); return true;
  case OPTION_CORDS_STRENGTH: *ok = parse_force("--cord-strength", value, &a->strength); return true;
  case OPTION_CORDS_BALANCE: a->balance = true; return true;
  case OPTION_CORDS_COVER: *ok = cli_int("plan", "--cover", value, 1, MOST_PASSES, &a->cover); return true;
  case OPTION_CORDS_CAPACITY: *ok = cli_int("plan", "--capacity", value, 1, 10 * MOST_PASSES, &a->capacity); return true;
  case OPTION_CORDS_DISTINCT: *ok = cli_int("plan", "--distinct", value, 2, MOST_PASSES, &a->distinct); return true;
  case OPTION_CORDS_JOINT:
    *ok = cli_choose("plan", "--joint", value, thr_joint_name, 2, &i);
    a->joint = i ? THR_JOINT_TUBE : THR_JOINT_SOLID;
    return true;
  case OPTION_CORDS_ENGINE:
    *ok = cli_choose("plan", "--engine", value, thr_engine_name, 3, &i);
    if (*ok) a->engine = (thr_engine)i;
    return true;
  case OPTION_CORDS_CONFIRM:
    *ok = cli_choose("plan", "--confirm", value, thr_confirm_name, 3, &i);
    if (*ok) a->confirm = (thr_confirm)i;
    return true;
  case OPTION_CORDS_ENDS: a->ends = value; return true;
  default: return false;
  }
}

/* The option that limits the pull; NULL = none. */
static const char *pull_limit(const cords_args *a)
{
  return a->max_pull > 0 ? "--max-pull" : a->hand > 0 ? "--hand" : a->strength > 0 ? "--cord-strength" : NULL;
}

bool cords_args_limits_pull(const cords_args *a)
{
  return pull_limit(a) != NULL;
}

bool cords_args_few(const cords_args *a)
{
  return a->max_length > 0 || a->max_pull > 0 || a->hand > 0;
}

const char *cords_args_refused(const cords_args *a, const thr_request *wanted)
{
  bool least = wanted->turning.tour == THR_TOUR_LEAST; /* classical tours take no wishes */
  if (!thr_wants_turning(wanted) || least) return NULL;
  return a->max_length > 0     ? "--max-length"
         : pull_limit(a)       ? pull_limit(a)
         : a->balance          ? "--balance"
         : a->automatic        ? "--cords auto"
         : a->least != a->most ? "a range of --cords"
                               : NULL;
}

/* Passes over every edge: as many as different cords unless it was said. */
static int cover_of(const cords_args *a)
{
  return a->cover ? a->cover : a->distinct ? a->distinct : 1;
}

static int check_distinct(const cords_args *a, const turning_args *turning)
{
  if (a->distinct == 0) return -1;
  if (turning->options.tour != THR_TOUR_LEAST)
    return cli_usage("plan", "--distinct: not with --tour %s, which makes one cord in each component",
                     thr_tour_name(turning->options.tour));
  if (a->cover > 0 && a->cover < a->distinct)
    return cli_usage("plan", "--cover %d: --distinct %d needs as many passes", a->cover, a->distinct);
  if (a->most == 0 || a->most >= a->distinct) return -1;
  cli_error("--cords %d: no edge is passed by %d different cords (proved: there are too few)", a->most, a->distinct);
  return EXIT_INFEASIBLE;
}

int cords_args_check(const cords_args *a, const turning_args *turning, const thr_request *wanted)
{
  const char *refused = cords_args_refused(a, wanted), *tour = thr_tour_name(turning->options.tour);
  if (refused) return cli_usage("plan", "%s: not with --objective %s", refused, thr_objective_name(thr_aims_objective(wanted)));
  if (a->confirm == THR_CONFIRM_ALWAYS && (!thr_wants_length(wanted) || a->joint == THR_JOINT_TUBE))
    return cli_usage("plan", "--confirm always: of shortest passes only, with --objective length and --joint solid");
  const bool counted = strchr(a->ends, ':'); /* ends by number say how many cords there are */
  if (a->balance && a->most < 2 && !counted && !cords_args_limits_pull(a))
    return cli_usage("plan", "--balance needs several --cords, or --max-pull");
  if (a->balance && (a->max_length > 0 || a->automatic))
    return cli_usage("plan", "--balance makes the longest cord as short as can be: no --%s with it",
                     a->automatic ? "cords auto" : "max-length");
  if (a->automatic && !cords_args_few(a))
    return cli_usage("plan", "--cords auto: as many as needed for what? Give --max-length or --max-pull");
  if (a->max_pull > 0 && a->hand > 0) return cli_usage("plan", "--max-pull says what --hand does: one of them");
  if (a->capacity > 0 && a->capacity < cover_of(a))
    return cli_usage("plan", "--capacity %d leaves no room for --%s %d", a->capacity, a->cover ? "cover" : "distinct",
                     cover_of(a));
  int code = check_distinct(a, turning);
  if (code >= 0) return code;
  const char *limit = pull_limit(a) ? pull_limit(a) : "--max-length";
  bool mixed = thr_wants_turning(wanted) && (a->max_length > 0 || pull_limit(a) || a->balance || a->least != a->most);
  if (mixed && turning->options.length_slack >= 0)
    return cli_usage("plan", "--length-slack: not with --balance, %s or a range of --cords, whose least length is not proved",
                     limit);
  if (mixed && (turning->frontier || turning->compare))
    return cli_usage("plan", "%s: not with --balance, %s or a range of --cords, whose least length is not proved",
                     turning->frontier ? "--frontier" : "--compare-shortest", limit);
  if (turning->options.tour == THR_TOUR_LEAST) return -1;
  if (a->most > 1) return cli_usage("plan", "--tour %s makes one cord in each component, not --cords %d", tour, a->most);
  if (a->joint == THR_JOINT_TUBE) return cli_usage("plan", "--tour %s ties no joints: no --joint tube", tour);
  return -1;
}

/* ---- numbers of ends ---- */

/* The node whose name is before the last colon of text[0 .. n-1], -1 if there is none; *number: what is after it. Names may hold
 * colons themselves: what is a node's name as a whole has no number. */
static int counted_node(const thr_frame *frame, const char *text, int n, char number[256])
{
  char word[256], *colon;
  if (n >= (int)sizeof word) return -1;
  snprintf(word, sizeof word, "%.*s", n, text);
  if (thr_frame_find(frame, word) >= 0 || !(colon = strrchr(word, ':'))) return -1;
  snprintf(number, 256, "%s", colon + 1);
  *colon = '\0';
  return thr_frame_find(frame, word);
}

/* "A:2,B:1" into counts. -1 if no node comes with a number; EXIT_OK; or prints what is wrong and returns the code. */
static int parse_counts(const thr_frame *frame, const char *ends, int *counts)
{
  const char *word = ends, *end, *alone = NULL;
  bool some = false;
  for (bool more = *ends; more; word = end + 1) {
    char number[256], *rest;
    end = word + strcspn(word, ",");
    more = *end;
    int n = (int)(end - word), v = counted_node(frame, word, n, number);
    if (v < 0) {
      alone = alone ? alone : word;
      continue;
    }
    long count = strtol(number, &rest, 10);
    some = true;
    if (rest == number || *rest || count < 1 || count > 2 * THR_MOST_CORDS)
      return cli_usage("plan", "--ends %.*s: expected a number of cord ends from 1 to %d after the colon", n, word,
                       2 * THR_MOST_CORDS);
    if (counts[v]) return cli_usage("plan", "--ends %s: node %s comes twice", ends, frame->name[v]);
    counts[v] = (int)count;
  }
  if (!some) return -1;
  if (alone)
    return cli_usage("plan", "--ends %s: %.*s is no node with a number of cord ends; give every node one, or none", ends,
                     (int)strcspn(alone, ","), alone);
  return EXIT_OK;
}

/* Cords of the components that the ends belong to: *most and *least of any. */
static int count_cords(const thr_frame *frame, const int *counts, int *least, int *most)
{
  thr_err err = {0};
  int n, code = EXIT_OK, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  int *sum = thr_calloc((size_t)frame->n_nodes, sizeof *sum), *first = thr_calloc((size_t)frame->n_nodes, sizeof *first);
  thr_status st = component && sum && first ? thr_frame_components(frame, component, &n, &err) : thr_nomem(&err);
  *least = THR_MOST_CORDS;
  *most = 0;
  for (int v = frame->n_nodes - 1; v >= 0 && !st; v--) {
    sum[component[v]] += counts[v];
    first[component[v]] = v;
  }
  for (int k = 0; !st && !code && k < n; k++) {
    if (sum[k] % 2 || sum[k] == 0) {
      cli_error("--ends: the component with node %s has %d %s; cords have two each, and every component needs one",
                frame->name[first[k]], sum[k], cli_plural(sum[k], "cord end", "cord ends"));
      code = EXIT_INFEASIBLE;
    }
    if (sum[k] / 2 < *least) *least = sum[k] / 2;
    if (sum[k] / 2 > *most) *most = sum[k] / 2;
  }
  free(component);
  free(sum);
  free(first);
  return st ? cli_fail(&err) : code;
}

static int apply_counts(const cords_args *a, const thr_frame *frame, thr_request *options)
{
  int least, most, code;
  if (thr_wants_symmetry(options))
    return cli_usage("plan", "--ends NAME:N: not with --objective symmetry, whose groups move ends to other nodes");
  if ((code = count_cords(frame, options->end_count, &least, &most))) return code;
  if (options->turning.tour != THR_TOUR_LEAST && most > 1)
    return cli_usage("plan", "--tour %s makes one cord in each component, not the %d of --ends %s",
                     thr_tour_name(options->turning.tour), most, a->ends);
  if (most > THR_MOST_CORDS || (a->most && (most > a->most || least < a->least))) {
    cli_error("--ends %s: these are the ends of %d %s in a component; --cords says otherwise", a->ends,
              most > a->most ? most : least, cli_plural(most > a->most ? most : least, "cord", "cords"));
    return EXIT_INFEASIBLE;
  }
  if (least < options->distinct) {
    cli_error("--ends %s: these are the ends of %d %s in a component; --distinct %d needs as many", a->ends, least,
              cli_plural(least, "cord", "cords"), options->distinct);
    return EXIT_INFEASIBLE;
  }
  options->ends = THR_ENDS_COUNTS;
  options->cords_least = least;
  options->cords = most;
  return EXIT_OK;
}

/* ---- together ---- */

/* Cord and bore say how many passes there is room for, where both were given. A symmetric plan is not held to that. */
static int apply_bore(thr_request *options)
{
  const thr_physics *physics = &options->physics;
  if (physics->bore == 0 || physics->cord_diameter == 0 || thr_wants_symmetry(options)) return EXIT_OK;
  int fit = thr_bore_fits(physics->bore, physics->cord_diameter);
  if (fit < options->cover) {
    cli_error("%d %s of a cord of %g mm %s through a bore of %g mm with ease; --cover asks for %d", fit,
              cli_plural(fit, "pass", "passes"), physics->cord_diameter, fit == 1 ? "goes" : "go", physics->bore, options->cover);
    return EXIT_INFEASIBLE;
  }
  if (options->capacity == 0 || fit < options->capacity) options->capacity = fit;
  return EXIT_OK;
}

/* Cord and seating tension are known: what may be pulled, as a factor on that. */
static int apply_pull(const cords_args *a, thr_request *options)
{
  const double seating = options->physics.seating;
  const char *option = pull_limit(a);
  const double left = thr_strength_left(0), bears = a->strength * left;
  double newtons = a->max_pull > 0 ? a->max_pull * (a->pull_is_factor ? seating : 1) : a->hand > 0 ? a->hand : bears;
  if (!option) return EXIT_OK;
  if (a->strength > 0 && newtons > bears) {
    cli_error("%s: a pull of %.6g N would break a cord of --cord-strength %.6g, of which an %s knot leaves %.0f %%; --max-pull "
              "%.6g keeps to it",
              option, newtons, a->strength, thr_knot_name(0), 100 * left, bears);
    return EXIT_INFEASIBLE;
  }
  options->max_pull = newtons / seating;
  if (options->max_pull >= 1) return EXIT_OK;
  cli_error("%s: %.6g N is less than the seating tension of %.6g N, which every cord needs; --seating makes that less", option,
            newtons, seating);
  return EXIT_INFEASIBLE;
}

static void apply_number(const cords_args *a, thr_request *options)
{
  bool free_number = a->most == 0 && cords_args_few(a);
  bool counted = a->most > 0 || free_number || !thr_wants_symmetry(options);
  int usual = a->distinct && counted ? a->distinct : 1;
  options->cords = a->most ? a->most : free_number ? THR_MOST_CORDS : usual;
  options->cords_least = a->most && a->least > usual ? a->least : usual;
}

int cords_args_apply(const cords_args *a, const thr_frame *frame, thr_request *options)
{
  options->cover = cover_of(a);
  options->distinct = a->distinct;
  options->capacity = a->capacity;
  options->joint = a->joint;
  options->engine = a->engine;
  options->confirm = a->confirm;
  options->max_length = a->max_length;
  int code = apply_bore(options);
  if (!code) code = apply_pull(a, options);
  if (code) return code;
  apply_number(a, options);
  if (!(options->end_count = thr_calloc((size_t)frame->n_nodes, sizeof *options->end_count))) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }
  code = parse_counts(frame, a->ends, options->end_count);
  if (code == EXIT_OK) return apply_counts(a, frame, options);
  if (code > 0) return code;
  free(options->end_count);
  options->end_count = NULL;
  return cli_resolve_ends(a->ends, frame, options);
}
