/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses the options of `thread plan` that say what the plan is to be (aims, cords, ends, turning),
 * checks whether they go together, and writes them into a thr_request.
 *
 * Options that are a number or a word are made from the rows of the request's table
 * (graph/plan/request_fields.c); the others have a function take_.. here. Which options exclude or
 * need each other is the table `refused`: a set of facts that must hold, a set none of which may
 * hold, and the text of the refusal. What depends on the framework (ends by name, number of cords,
 * limits in newtons) is settled last, in request_args_apply.
 *
 * Example: `--cords 2..4 --balance` gives least = 2, most = 4 and the aims longest, length;
 * `--balance` alone is refused, since one cord has no longest one. */
#include "cli/args/args.h"
#include "eval/cord/profile.h"
#include "graph/plan/plan_fields.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "planner/planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the options of a command line that asks for nothing. */
request_args request_args_default(void)
{
  return (request_args){.asked = thr_request_default(), .ends = "closed"};
}

/* ---- single options ---- */

/* Reads the first n letters of a value of --cords as a number of cords. Returns false after
 * printing what is wrong. */
static bool parse_number_of_cords(const char *text, int n, int *out)
{
  char number[16];
  if (n <= 0 || n >= (int)sizeof number) {
    cli_usage("plan", "--cords: expected a number of cords, A..B, ..B or auto");
    return false;
  }

  /* Copy the number: what follows in the text may be the dots of a range. */
  snprintf(number, sizeof number, "%.*s", n, text);

  return cli_int("plan", "--cords", number, 1, THR_MOST_CORDS, out);
}

/* Reads the value of --cords: "4", "2..4", "..4" or "auto". "auto" sets no limit beside
 * THR_MOST_CORDS. */
static bool take_cords(void *into, const cli_option *option, const char *value)
{
  request_args *args = into;
  const char *dots = strstr(value, "..");
  (void)option;

  /* Without any number given, a component may have 1 to THR_MOST_CORDS cords. */
  args->automatic = strcmp(value, "auto") == 0;
  args->least = 1;
  args->most = THR_MOST_CORDS;
  if (args->automatic) return true;

  /* One number is both ends of the range. */
  if (!dots) {
    const bool ok = parse_number_of_cords(value, (int)strlen(value), &args->most);
    args->least = args->most;
    return ok;
  }

  /* A range, whose first number may be left out. */
  if (dots > value && !parse_number_of_cords(value, (int)(dots - value), &args->least))
    return false;
  if (!parse_number_of_cords(dots + 2, (int)strlen(dots + 2), &args->most)) return false;

  if (args->least <= args->most) return true;
  cli_usage("plan", "--cords %s: the first number is the smaller one", value);

  return false;
}

/* Reads the value of --max-pull: "50" is newtons, "20x" is 20 times the seating tension. */
static bool take_max_pull(void *into, const cli_option *option, const char *value)
{
  request_args *args = into;
  char number[64];
  const size_t n = strlen(value);
  (void)option;

  /* The last letter tells a factor from newtons. */
  args->pull_is_factor = n > 1 && value[n - 1] == 'x';
  snprintf(number, sizeof number, "%.*s", (int)(args->pull_is_factor ? n - 1 : n), value);
  if (!cli_quantity("plan", "--max-pull", number, args->pull_is_factor ? "" : "N", 0, 1e100,
                    &args->max_pull))
    return false;

  /* No cord can be drawn in without any force. */
  if (args->max_pull == 0) {
    cli_usage("plan", "--max-pull 0: a cord needs some pull");
  }

  return args->max_pull > 0;
}

/* Reads the value of --hand, in newtons. */
static bool take_hand(void *into, const cli_option *option, const char *value)
{
  (void)option;
  return cli_hand("plan", value, &((request_args *)into)->hand);
}

/* Reads the value of --length-slack: "5" or "5%" becomes 0.05. */
static bool take_slack(void *into, const cli_option *option, const char *value)
{
  (void)option;
  if (thr_slack_parse(value, &((request_args *)into)->asked.turning.length_slack)) return true;
  cli_usage("plan", "--length-slack %s: expected a percentage from 0 to 1e+06, like 5 or 5%%",
            value);
  return false;
}

/* Reads the value of --objective. */
static bool take_objective(void *into, const cli_option *option, const char *value)
{
  int i;
  if (!cli_choose("plan", "--objective", value, option->word, option->n_words, &i)) return false;
  ((request_args *)into)->objective = thr_dispatch_objective(i);
  return true;
}

/* Reads the value of --minimize: turning, max-turning or pull. The last two are about one cord, and
 * so set `largest`. */
static bool take_minimize(void *into, const cli_option *option, const char *value)
{
  request_args *args = into;
  int i;
  args->minimize = true;
  if (!cli_choose("plan", "--minimize", value, option->word, option->n_words, &i)) return false;
  args->largest = i > 0;
  args->pull = thr_minimize_aim(i) == THR_AIM_PULL;
  return true;
}

/* Reads the number of points of --frontier, which may be left out. */
static bool take_frontier(void *into, const cli_option *option, const char *value)
{
  enum { USUAL_POINTS = 9, MOST_POINTS = 1000 };
  request_args *args = into;
  (void)option;
  args->frontier = USUAL_POINTS;
  return !value || cli_int("plan", "--frontier", value, 2, MOST_POINTS, &args->frontier);
}

/* ---- the rows ---- */

#define AT(member) .offset = offsetof(request_args, member)

static const cli_option own_planned[] = {
    {"objective", .kind = CLI_OTHER, .take = take_objective, .word = thr_dispatch_name,
     .n_words = THR_N_OBJECTIVES,
     .help = "what the plan is to have little of: cord (length, the default with --cords or a "
             "limit), paths to learn "
             "(symmetry), or turning, which makes cords hard to pull (tortuosity)"},
    {"cords", .value = "K", .kind = CLI_OTHER, .take = take_cords,
     .help = "K cords in every component, 1 to 1000, of much the same length (default: as few as a "
             "hand can pull; 1 with --objective, --gap or --aims); A..B, ..B: "
             "at most B; auto: as many as --max-length or --max-pull takes"},
    {"ends", .value = "closed|any|feet|FILE|NAME,..", .kind = CLI_TEXT, AT(ends),
     .help = "both ends of a cord at one node (default with --cords or --objective, else the best "
             "ones), or anywhere, at feet, at these nodes; "
             "NAME:N,..: exactly so many cord ends at each of these nodes"},
    {"balance", .kind = CLI_FLAG, AT(balance),
     .help = "of several cords: make the longest as short as can be"},
    {"max-pull", .value = "F", .kind = CLI_OTHER, .take = take_max_pull,
     .help = "as few cords as it takes for none to need more than F newtons, pulled at both ends; "
             "20x: more than 20 times the seating tension"},
    {"hand", .value = "one|two|N", .kind = CLI_OTHER, .take = take_hand,
     .help = "--max-pull by what hands manage: 50 newtons (one hand), 100 (two) or N"},
    {"cord-strength", .value = "N", .kind = CLI_AMOUNT, AT(strength), .low = CLI_ABOVE_0,
     .high = 1e100,
     .help =
         "refuse plans whose pull breaks a cord that bears N newtons when straight; an overhand "
         "knot leaves 45 % of that"},
    {"aims", .value = "LIST", .kind = CLI_TEXT, AT(aims),
     .help = "what to minimize first, second, .., in place of --objective, --balance, --minimize, "
             "--turn-cost, --length-slack and --prefer: length; or longest (cord), length; or "
             "turning, max-turning (of the cord that turns most) or pull, with another price of "
             "turns as turning:sine, after length+5% with at most 5 % more cord than the least; or "
             "of symmetric plans overlap, steps, paths, turning"},
    {0}};

static const cli_option own_turning[] = {
    {"length-slack", .value = "P%", .kind = CLI_OTHER, .take = take_slack,
     .help = "at most P % more cord than the shortest; 0 = the least turning among the shortest "
             "(default: any)"},
    {"minimize", .kind = CLI_OTHER, .take = take_minimize, .word = thr_minimize_name,
     .n_words = THR_N_MINIMIZE,
     .help = "the turning of all cords together, that of the cord that turns most (default with "
             "several), or what the hand feels: the pull at the harder end of the cord that is "
             "hardest to pull at both ends"},
    {"frontier", .value = "[=N]", .kind = CLI_OTHER, .take = take_frontier,
     .help = "also the trade-off between length and turning, at up to N lengths, 2 to 1000 "
             "(default: 9)"},
    {"plot", .value = "FILE", .kind = CLI_OUTPUT, AT(plot),
     .help = "with --frontier: a picture of it, pull against cord, as SVG"},
    {"compare-shortest", .kind = CLI_FLAG, AT(compare),
     .help = "print beside it the least turning among the shortest cords; with --length-slack 0 "
             "that of any length, with a classical tour the least turning: one more search, as "
             "long as the first"},
    {0}};

/* Returns the option that a row of the request's table makes. On the command line counts go up to a
 * million. */
static cli_option option_of(const thr_request_field *field)
{
  const double most_counted = 1e6;
  const bool is_count = field->kind == THR_ASKS_COUNT;

  return (cli_option){.name = field->option ? field->option : field->key,
                      .value = field->value,
                      .help = field->help,
                      .kind = is_count                       ? CLI_COUNT
                              : field->kind == THR_ASKS_WORD ? CLI_WORD
                                                             : CLI_AMOUNT,
                      .offset = field->offset,
                      .low = field->low,
                      .high = is_count ? fmin(field->high, most_counted) : field->high,
                      .word = field->name,
                      .n_words = field->n_names};
}

cli_option request_option_of(const char *key)
{
  int i = 0;
  while (strcmp(thr_request_fields[i].key, key) != 0) {
    i++; /* a key of the table, known when this is compiled */
  }
  return option_of(&thr_request_fields[i]);
}

/* Returns the table of one kind of options: first the rows that are written out above, then the
 * rows that the request's table makes. Each table is built anew in static storage. */
const cli_option *request_options(request_rows rows)
{
  enum { MOST = 32 };
  static cli_option table[REQUEST_TUNED + 1][MOST];
  static const cli_option none[] = {{0}};
  const cli_option *own = rows == REQUEST_PLANNED   ? own_planned
                          : rows == REQUEST_TURNING ? own_turning
                                                    : none;
  int n = 0;

  /* Rows with a parser of their own. */
  for (; own->name; own++) {
    table[rows][n++] = *own;
  }

  /* Rows of the request's table; their offsets count from request_args.asked. */
  for (int i = 0; i < thr_request_n_fields; i++) {
    const thr_request_field *field = &thr_request_fields[i];
    const request_rows of = field->tuned ? REQUEST_TUNED
                            : field->in  ? REQUEST_TURNING
                                         : REQUEST_PLANNED;
    if (!field->help || of != rows) continue;
    table[rows][n] = option_of(field);
    table[rows][n++].offset += offsetof(request_args, asked);
  }

  /* A row without a name ends the table. */
  table[rows][n] = (cli_option){0};

  return table[rows];
}

/* ---- what they come to ---- */

/* Returns the option that limits the pull, or NULL if none was given. */
static const char *pull_limit(const request_args *args)
{
  return args->max_pull > 0   ? "--max-pull"
         : args->hand > 0     ? "--hand"
         : args->strength > 0 ? "--cord-strength"
                              : NULL;
}

/* Returns whether a limit was given within which as few cords as possible are asked for. */
static bool takes_few(const request_args *args)
{
  return args->asked.max_length > 0 || args->max_pull > 0 || args->hand > 0;
}

/* Returns the least number of passes over every edge: --cover if given, else one for each of the
 * different cords that --distinct asks for. */
static int cover_of(const request_args *args)
{
  return cli_given("cover") ? args->asked.cover : args->asked.distinct ? args->asked.distinct : 1;
}

/* Returns whether the cord that turns most is minimized before the sum over all cords. This is the
 * default with several cords: a small sum may leave one cord that nobody can pull. */
static bool wants_largest(const request_args *args)
{
  const bool several = args->most > 1 || takes_few(args);
  return args->minimize ? args->largest
                        : several && !args->balance && !args->frontier &&
                              args->asked.turning.tour == THR_TOUR_LEAST;
}

void request_args_ask(const request_args *args, const symmetry_args *symmetry,
                      thr_objective objective, thr_request *request)
{
  const thr_request usual = thr_request_default();
  const bool is_own = objective == args->objective;
  thr_aims *aims = &request->aims;

  /* Options about turning or symmetry concern the objective that they were given with. Other
   * objectives, which `thread plan` may compute to compare with, keep the defaults. */
  *aims = thr_aims_of(objective);
  request->turning = is_own && thr_wants_turning(request) ? args->asked.turning : usual.turning;
  request->symmetry = is_own && thr_wants_symmetry(request) ? symmetry->options : usual.symmetry;
  if (thr_wants_symmetry(request)) {
    request->symmetry.counted = args->most > 0 || takes_few(args);
  }

  /* The aims in their order: --prefer, --minimize, and --balance before all others. */
  if (is_own && thr_wants_symmetry(request)) {
    memcpy(aims->aim, symmetry->prefer, sizeof symmetry->prefer);
  }
  if (is_own && thr_wants_turning(request) && wants_largest(args)) {
    aims->aim[0] = args->pull ? THR_AIM_PULL : THR_AIM_MAX_TURNING;
  }
  if (is_own && args->balance) {
    memmove(&aims->aim[1], aims->aim, (size_t)aims->n++ * sizeof *aims->aim);
    aims->aim[0] = THR_AIM_LONGEST;
  }

  /* The rest concerns any objective. A limit of the pull only gets a mark here: its value is known
   * when cord and beads are. */
  request->joint = args->asked.joint;
  request->order = args->asked.order;
  request->crossings = args->asked.crossings;
  request->gap = args->asked.gap;
  if (pull_limit(args) && request->max_pull == 0) {
    request->max_pull = 1;
  }
}

/* ---- what goes together ---- */

/* Facts about what was asked for, as a set of bits. */
enum {
  LENGTH = 1 << 0,
  TURNING = 1 << 1,
  SYMMETRY = 1 << 2,
  TUBE = 1 << 3,
  CLASSICAL = 1 << 4, /* a tour by Fleury or Hierholzer */
  PULL = 1 << 5,      /* a limit on it */
  MAX_LENGTH = 1 << 6,
  BALANCE = 1 << 7,
  AUTOMATIC = 1 << 8,
  RANGE = 1 << 9,
  FEW = 1 << 10,
  SEVERAL = 1 << 11,
  COUNTED_ENDS = 1 << 12,
  SLACK = 1 << 13,
  SOME_SLACK = 1 << 14, /* more than 0 */
  LARGEST = 1 << 15,
  LEAST_PULL = 1 << 16,
  FRONTIER = 1 << 17,
  COMPARE = 1 << 18,
  PLOT = 1 << 19,
  PAIRINGS = 1 << 20,
  NODES = 1 << 21,
  CONFIRM = 1 << 22,
  COST = 1 << 23, /* of turns, other than their angle */
  CROSSINGS = 1 << 24,
  DISTINCT = 1 << 25,
  OF_TURNING = 1 << 26,  /* an option that only plans of little turning know */
  OF_SYMMETRY = 1 << 27, /* the same of symmetric plans */
  BOTH_PULLS = 1 << 28,  /* --max-pull and --hand */
  MIXED = 1 << 29        /* little turning, and a wish that is about single cords or their number */
};

/* The combinations that are refused: a request with all facts of `all` and none of `none`. The
 * first row that applies gives the text. In a text, % and a letter stand for the option about
 * symmetry (S) or turning (G), the crossings (X), the tour (T), the cost of turns (C), the limit
 * (L), the limit of the pull (P), or the number of cords (K). */
static const struct {
  int all, none;
  const char *say;
} refused[] = {
    {OF_SYMMETRY, SYMMETRY, "%S needs --objective symmetry"},
    {CROSSINGS | TUBE, 0,
     "--crossings %X does not go with --joint tube: the cords of a tube lie side by side in one "
     "bore and cross nowhere inside"},
    {CROSSINGS | SYMMETRY, 0,
     "--crossings %X does not go with --objective symmetry: copies of a cord cross each other "
     "where they meet"},
    {CROSSINGS | PULL, 0, "--crossings %X does not go with a limit of the pull"},
    {CROSSINGS | CLASSICAL, 0, "--crossings %X does not go with a classical tour"},
    {OF_TURNING, TURNING, "%G needs --objective tortuosity"},
    {PLOT, FRONTIER, "--plot draws the frontier: it needs --frontier"},
    {LEAST_PULL | COST, 0, "--minimize pull is of angles: no --turn-cost %C"},
    {PAIRINGS, CLASSICAL, "--pairings is for --tour fleury and --tour hierholzer"},
    {CLASSICAL | NODES, 0, "--tour %T searches nothing: no --tune nodes"},
    {CLASSICAL | SOME_SLACK, 0, "--tour %T takes the shortest passes: no --length-slack but 0"},
    {CLASSICAL | LEAST_PULL, 0, "--tour %T minimizes nothing: no --minimize pull"},
    {CLASSICAL | LARGEST, 0, "--tour %T minimizes nothing: no --minimize max-turning"},
    {CLASSICAL | FRONTIER, 0, "--tour %T minimizes nothing: no --frontier"},
    {TURNING | CLASSICAL | MAX_LENGTH, 0, "--max-length: not with --objective tortuosity"},
    {TURNING | CLASSICAL | PULL, 0, "%P: not with --objective tortuosity"},
    {TURNING | CLASSICAL | BALANCE, 0, "--balance: not with --objective tortuosity"},
    {TURNING | CLASSICAL | AUTOMATIC, 0, "--cords auto: not with --objective tortuosity"},
    {TURNING | CLASSICAL | RANGE, 0, "a range of --cords: not with --objective tortuosity"},
    {CONFIRM, LENGTH,
     "--tune confirm=always: of shortest passes only, with --objective length and --joint solid"},
    {CONFIRM | TUBE, 0,
     "--tune confirm=always: of shortest passes only, with --objective length and --joint solid"},
    {BALANCE, SEVERAL | COUNTED_ENDS | PULL, "--balance needs several --cords, or --max-pull"},
    {BALANCE | AUTOMATIC, 0,
     "--balance makes the longest cord as short as can be: no --cords auto with it"},
    {BALANCE | MAX_LENGTH, 0,
     "--balance makes the longest cord as short as can be: no --max-length with it"},
    {AUTOMATIC, FEW, "--cords auto: as many as needed for what? Give --max-length or --max-pull"},
    {BOTH_PULLS, 0, "--max-pull says what --hand does: one of them"},
    {DISTINCT | CLASSICAL, 0,
     "--distinct: not with --tour %T, which makes one cord in each component"},
    {MIXED | SLACK, 0,
     "--length-slack: not with --balance, %L or a range of --cords, whose least length is not "
     "proved"},
    {MIXED | FRONTIER, 0,
     "--frontier: not with --balance, %L or a range of --cords, whose least length is not proved"},
    {MIXED | COMPARE, 0,
     "--compare-shortest: not with --balance, %L or a range of --cords, whose least length is not "
     "proved"},
    {CLASSICAL | SEVERAL, 0, "--tour %T makes one cord in each component, not --cords %K"},
    {CLASSICAL | TUBE, 0, "--tour %T ties no joints: no --joint tube"},
};

/* Returns the first option about turning that was given, or NULL. */
static const char *turning_given(void)
{
  const char *given = cli_given_of(request_options(REQUEST_TURNING));
  return given ? given : cli_given("nodes");
}

bool request_args_unsaid(thr_ends ends)
{
  static const char *const says[] = {"objective", "aims",     "cords",      "balance", "max-pull",
                                     "hand",      "distinct", "max-length", "gap"};
  bool said = ends == THR_ENDS_COUNTS;
  for (size_t i = 0; !said && i < sizeof says / sizeof *says; i++)
    said = cli_given(says[i]);
  return !said && !turning_given() && !cli_given_of(cli_symmetry_options) &&
         !cli_given_of(request_options(REQUEST_TUNED));
}

/* Returns the set of facts that hold of what was asked for. wanted holds the aims, args all else.
 */
static int facts_of(const request_args *args, const thr_request *wanted)
{
  const thr_request *asked = &args->asked;
  const thr_turning_options *turning = &asked->turning;
  const bool is_range = args->least != args->most, limits_pull = pull_limit(args);

  /* One condition for each fact, in the order of the enumeration. */
  const struct {
    bool holds;
    int fact;
  } facts[] = {
      {thr_wants_length(wanted), LENGTH},
      {thr_wants_turning(wanted), TURNING},
      {thr_wants_symmetry(wanted), SYMMETRY},
      {asked->joint == THR_JOINT_TUBE, TUBE},
      {turning->tour != THR_TOUR_LEAST, CLASSICAL},
      {limits_pull, PULL},
      {asked->max_length > 0, MAX_LENGTH},
      {args->balance, BALANCE},
      {args->automatic, AUTOMATIC},
      {is_range, RANGE},
      {takes_few(args), FEW},
      {args->most > 1, SEVERAL},
      {strchr(args->ends, ':'), COUNTED_ENDS},
      {turning->length_slack >= 0, SLACK},
      {turning->length_slack > 0, SOME_SLACK},
      {args->largest, LARGEST},
      {args->pull, LEAST_PULL},
      {args->frontier > 0, FRONTIER},
      {args->compare, COMPARE},
      {args->plot, PLOT},
      {cli_given("pairings"), PAIRINGS},
      {turning->nodes > 0, NODES},
      {asked->confirm == THR_CONFIRM_ALWAYS, CONFIRM},
      {turning->cost != THR_TURN_ANGLE, COST},
      {asked->crossings != THR_CROSSINGS_ALLOW, CROSSINGS},
      {asked->distinct > 0, DISTINCT},
      {turning_given(), OF_TURNING},
      {cli_given_of(cli_symmetry_options), OF_SYMMETRY},
      {args->max_pull > 0 && args->hand > 0, BOTH_PULLS},
      {thr_wants_turning(wanted) &&
           (asked->max_length > 0 || limits_pull || args->balance || is_range),
       MIXED},
  };

  int sum = 0;
  for (size_t i = 0; i < sizeof facts / sizeof *facts; i++) {
    sum |= facts[i].holds ? facts[i].fact : 0;
  }

  return sum;
}

/* Prints a refusal, its letters replaced by what they stand for; returns the exit code. */
static int refuse(const request_args *args, const char *say)
{
  char text[256], cords[16];
  size_t n = 0;

  snprintf(cords, sizeof cords, "%d", args->most);

  for (; *say && n + 1 < sizeof text; say++) {
    if (*say != '%') {
      text[n++] = *say;
      continue;
    }

    /* A letter after % stands for a word. */
    const char letter = *++say;
    const char *word = letter == 'S'   ? cli_given_of(cli_symmetry_options)
                       : letter == 'G' ? turning_given()
                       : letter == 'X' ? thr_crossings_name((int)args->asked.crossings)
                       : letter == 'T' ? thr_tour_name((int)args->asked.turning.tour)
                       : letter == 'C' ? thr_turn_cost_name((int)args->asked.turning.cost)
                       : letter == 'L' ? (pull_limit(args) ? pull_limit(args) : "--max-length")
                       : letter == 'P' ? pull_limit(args)
                                       : cords;
    n += (size_t)snprintf(text + n, sizeof text - n, "%s", word);
  }

  /* A text that is too long is cut. */
  text[n < sizeof text ? n : sizeof text - 1] = '\0';

  return cli_usage("plan", "%s", text);
}

/* Checks --cover, --capacity, --distinct and --cords against each other. Returns -1, or prints and
 * returns the exit code. */
static int check_numbers(const request_args *args)
{
  const thr_request *asked = &args->asked;
  const int cover = cover_of(args);

  /* Every edge needs its passes within its capacity, and as many passes as different cords. */
  if (asked->capacity > 0 && asked->capacity < cover)
    return cli_usage("plan", "--capacity %d leaves no room for --%s %d", asked->capacity,
                     cli_given("cover") ? "cover" : "distinct", cover);
  if (cli_given("cover") && asked->distinct > 0 && asked->cover < asked->distinct)
    return cli_usage("plan", "--cover %d: --distinct %d needs as many passes", asked->cover,
                     asked->distinct);

  /* k different cords over an edge take k cords in its component. */
  if (asked->distinct == 0 || args->most == 0 || args->most >= asked->distinct) return -1;

  cli_error("--cords %d: no edge is passed by %d different cords (proved: there are too few)",
            args->most, asked->distinct);

  return EXIT_INFEASIBLE;
}

/* Translates --aims, which lists all that is minimized, into the values that the other options
 * would have set. Refuses --aims beside any of those options. Returns -1, or prints and returns the
 * exit code. */
static int settle_aims(request_args *args, symmetry_args *symmetry)
{
  thr_err err = {0};
  thr_request listed = thr_request_default();
  static const char *const spelled[] = {"objective", "length-slack", "minimize",
                                        "turn-cost", "balance",      "prefer"};
  const char *other = NULL;

  /* Each of these options would say a part of the list again. */
  for (size_t i = 0; !other && i < sizeof spelled / sizeof *spelled; i++) {
    other = cli_given(spelled[i]);
  }
  if (!args->aims) return -1;
  if (other) return cli_usage("plan", "--aims says all that is minimized: no %s beside it", other);

  if (thr_aims_parse(args->aims, &listed, &err))
    return cli_usage("plan", "--aims %s: %s", args->aims, err.text);

  /* Set what --objective, --minimize, --turn-cost, --length-slack, --balance and --prefer set. */
  args->objective = thr_aims_objective(&listed);
  args->largest = thr_wants_largest(&listed);
  args->pull = thr_wants_pull(&listed);
  args->minimize = true;
  args->asked.turning.cost = listed.turning.cost;
  args->asked.turning.length_slack = listed.turning.length_slack;
  args->balance = thr_wants_balance(&listed);
  thr_aims_order(&listed, symmetry->prefer);

  return -1;
}

int request_args_check(request_args *args, symmetry_args *symmetry, thr_request *wanted)
{
  int code = settle_aims(args, symmetry);
  if (code >= 0) return code;

  request_args_ask(args, symmetry, args->objective, wanted);

  /* A picture has to go somewhere. */
  if (args->plot && strcmp(args->plot, "-") == 0)
    return cli_usage("plan", "--plot -: the summary has stdout; name a file");

  /* The first combination of the table that is refused. */
  const int facts = facts_of(args, wanted);
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    if ((facts & refused[i].all) == refused[i].all && !(facts & refused[i].none))
      return refuse(args, refused[i].say);
  }

  return check_numbers(args);
}

/* ---- with the framework ---- */

/* Sets request->max_pull, a factor on the seating tension, from --max-pull, --hand or
 * --cord-strength. Returns an exit code. */
static int apply_pull(const request_args *args, thr_request *request)
{
  const double seating = request->physics.seating;
  const double left = thr_strength_left(0), bears = args->strength * left;

  /* The first of the three options that was given counts; a strength is reduced by the knot. */
  const double newtons = args->max_pull > 0 ? args->max_pull * (args->pull_is_factor ? seating : 1)
                         : args->hand > 0   ? args->hand
                                            : bears;

  const char *option = pull_limit(args);
  if (!option) return EXIT_OK;

  /* With --cord-strength beside another limit, that limit must not break the cord at its knot. */
  if (args->strength > 0 && newtons > bears) {
    cli_error("%s: a pull of %.6g N would break a cord of --cord-strength %.6g, of which an %s "
              "knot leaves %.0f %%; --max-pull "
              "%.6g keeps to it",
              option, newtons, args->strength, thr_knot_name(0), 100 * left, bears);
    return EXIT_INFEASIBLE;
  }

  /* A pull below the seating tension seats no cord. */
  request->max_pull = newtons / seating;
  if (request->max_pull >= 1) return EXIT_OK;
  cli_error("%s: %.6g N is less than the seating tension of %.6g N, which every cord needs; "
            "--seating makes that less",
            option, newtons, seating);

  return EXIT_INFEASIBLE;
}

/* Sets the least and the largest number of cords in every component. A limit on length or pull
 * alone allows any number; --distinct needs as many as it names. */
static void apply_number(const request_args *args, thr_request *request)
{
  const bool is_free = args->most == 0 && takes_few(args);
  const bool is_counted = args->most > 0 || is_free || !thr_wants_symmetry(request);
  const int usual = request->distinct > 0 && is_counted ? request->distinct : 1;

  /* --cords counts before all else; without it a limit leaves the number open. */
  request->cords = args->most ? args->most : is_free ? THR_MOST_CORDS : usual;
  request->cords_least = args->most && args->least > usual ? args->least : usual;
}

/* Sets the number of cords from the numbers of cord ends at the nodes (--ends NAME:N), and checks
 * --cords, --tour and --distinct against it. Returns an exit code. */
static int apply_counts(const request_args *args, const thr_frame *frame, thr_request *request)
{
  int least, most;
  if (thr_wants_symmetry(request))
    return cli_usage(
        "plan",
        "--ends NAME:N: not with --objective symmetry, whose groups move ends to other nodes");

  const int code = end_counts_cords(frame, request->end_count, &least, &most);
  if (code) return code;

  /* A classical tour is one cord. */
  if (request->turning.tour != THR_TOUR_LEAST && most > 1)
    return cli_usage("plan", "--tour %s makes one cord in each component, not the %d of --ends %s",
                     thr_tour_name((int)request->turning.tour), most, args->ends);

  /* --cords names a range, if it was given. */
  if (most > THR_MOST_CORDS || (args->most && (most > args->most || least < args->least))) {
    const int wrong = most > args->most ? most : least;
    cli_error("--ends %s: these are the ends of %d %s in a component; --cords says otherwise",
              args->ends, wrong, cli_plural(wrong, "cord", "cords"));
    return EXIT_INFEASIBLE;
  }

  if (least < request->distinct) {
    cli_error("--ends %s: these are the ends of %d %s in a component; --distinct %d needs as many",
              args->ends, least, cli_plural(least, "cord", "cords"), request->distinct);
    return EXIT_INFEASIBLE;
  }

  /* Each component gets half as many cords as it has ends. */
  request->ends = THR_ENDS_COUNTS;
  request->cords_least = least;
  request->cords = most;

  return EXIT_OK;
}

/* Copies what the options say that are rows of the request's table, but for those about turning,
 * which concern one objective only. */
static void copy_rows(const thr_request *asked, thr_request *request)
{
  for (int i = 0; i < thr_request_n_fields; i++) {
    const thr_request_field *field = &thr_request_fields[i];
    if (!field->help || field->in) continue;
    const bool is_int = field->kind == THR_ASKS_COUNT || field->kind == THR_ASKS_WORD;
    memcpy((char *)request + field->offset, (const char *)asked + field->offset,
           is_int ? sizeof(int) : sizeof(double));
  }
}

/* Notes what was asked for and changes nothing. */
static void note_useless(const request_args *args, const thr_request *request)
{
  if (args->minimize && request->cords == 1 && thr_wants_largest(request) &&
      !thr_wants_pull(request))
    cli_note("note: one cord is the one that turns most: --minimize max-turning changes nothing; "
             "--cords N makes several");
}

int request_args_apply(const request_args *args, const thr_frame *frame, thr_request *request)
{
  copy_rows(&args->asked, request);
  request->cover = cover_of(args);

  /* Limits that follow from cord and bead. */
  thr_err err = {0};
  if (thr_request_fit_bore(request, &err)) return cli_fail(&err);
  int code = apply_pull(args, request);
  if (code) return code;

  apply_number(args, request);

  /* --ends gives numbers of ends at nodes, or the nodes where ends may be. */
  request->end_count = thr_calloc((size_t)frame->n_nodes, sizeof *request->end_count);
  if (!request->end_count) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }
  code = end_counts_parse(frame, args->ends, request->end_count);
  if (code == EXIT_OK) {
    code = apply_counts(args, frame, request);
  } else if (code < 0) {
    free(request->end_count);
    request->end_count = NULL;
    code = cli_resolve_ends(args->ends, frame, request);
  }

  if (!code) note_useless(args, request);
  return code;
}
