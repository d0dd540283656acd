/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses command lines by tables of options: the same rows make the parser, the help and the list
 * for completions of every command.
 *
 * getopt_long finds the options in the command line; a row says what becomes of a value. An option
 * for developers is a row of a group headed cli_tuned, and is spelled --tune NAME=VALUE.
 *
 * Example: the row {"cover", .kind = CLI_COUNT, .low = 1, .high = 100, ..} makes --cover 2 store an
 * int, --cover 0 a usage error, and --help print the row's text. */
#include "cli/args/args.h"
#include "graph/os.h"

#include <assert.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { MOST_OPTIONS = 160, FIRST_VALUE = 256, NAME_SIZE = 40, MOST_LENGTHS = 8 };

/* A length that was given with its unit, in mm. */
typedef struct {
  const char *name, *text;
  double *to;
} given_length;

const char cli_tuned[] = "for developers";
void (*cli_show_options)(const cli_group *groups);

/* The state of the parser: the rows of all groups one after another, as getopt_long wants them,
 * with the values given so far. */
static struct {
  const char *command;
  int n;
  struct option table[MOST_OPTIONS + 1];
  const cli_option *option[MOST_OPTIONS];
  void *into[MOST_OPTIONS];
  bool tuned[MOST_OPTIONS], given[MOST_OPTIONS];
  const char *value[MOST_OPTIONS]; /* as typed */
  char dashed[MOST_OPTIONS][NAME_SIZE], letters[MOST_OPTIONS];
  given_length length[MOST_LENGTHS];
  int n_lengths;
} parser;

/* ---- the options of every command ---- */

/* Takes --quiet. */
static bool be_quiet(void *into, const cli_option *option, const char *value)
{
  (void)into, (void)option, (void)value;
  cli_quiet = true;
  return true;
}

/* Takes --verbose. */
static bool be_verbose(void *into, const cli_option *option, const char *value)
{
  (void)into, (void)option, (void)value;
  cli_verbose = true;
  return true;
}

/* Takes --json. */
static bool be_json(void *into, const cli_option *option, const char *value)
{
  (void)into, (void)option, (void)value;
  cli_json = true;
  return true;
}

const cli_option cli_common_options[] = {
    {"quiet", 'q', NULL, "no notes, no progress, no summary", .kind = CLI_OTHER, .take = be_quiet},
    {"verbose", 'v', NULL, "what is done on the way", .kind = CLI_OTHER, .take = be_verbose},
    {"json", .kind = CLI_OTHER, .take = be_json,
     .help = "the answer as JSON on stdout, of a failure {\"error\": .., \"code\": ..}"},
    {"config", .value = "FILE",
     .help = "options from a file, as if they stood before the others: thread(1)",
     .kind = CLI_TEXT},
    {"help", 'h', NULL, "what stands here", .kind = CLI_SHOWS},
    {0}};

/* ---- the rows ---- */

/* Appends a row, whose value goes to a struct of its group. tuned: the row is for developers. */
static void add_row(const cli_option *option, void *into, bool tuned)
{
  const int i = parser.n++;
  assert(i < MOST_OPTIONS && strlen(option->name) + 8 < NAME_SIZE); /* known when it is compiled */

  parser.option[i] = option;
  parser.into[i] = into;
  parser.tuned[i] = tuned;
  snprintf(parser.dashed[i], NAME_SIZE, "--%s%s", tuned ? "tune " : "", option->name);
}

/* The option --tune itself, which getopt_long finds; take_tuned parses its value. */
static const cli_option tune = {"tune", .value = "NAME=VALUE", .kind = CLI_OTHER};

/* Returns whether an option takes a value: its value has a name, or is one of some words. */
static bool takes_value(const cli_option *option)
{
  return option->value || option->word;
}

/* Collects the rows of all groups, and makes getopt_long's table and letters of those that are not
 * tuned. */
static void join_rows(const cli_syntax *syntax, const cli_group *groups)
{
  int letters = 0, n = 0;

  memset(&parser, 0, sizeof parser);
  parser.command = syntax->command;

  /* The common rows come first, so that their letters win. */
  for (const cli_option *option = cli_common_options; option->name; option++) {
    add_row(option, NULL, false);
  }
  for (const cli_group *group = groups; group->option; group++) {
    for (const cli_option *option = group->option; option->name; option++) {
      add_row(option, group->into, group->heading == cli_tuned);
    }
  }

  /* --tune stands for all rows for developers. */
  add_row(&tune, NULL, false);

  /* The colon in front makes getopt_long tell a missing value from an unknown option. */
  parser.letters[letters++] = ':';
  for (int i = 0; i < parser.n; i++) {
    const cli_option *option = parser.option[i];
    if (parser.tuned[i]) continue;
    const int takes = !takes_value(option)                       ? no_argument
                      : option->value && option->value[0] == '[' ? optional_argument
                                                                 : required_argument;

    parser.table[n++] = (struct option){option->name, takes, NULL, FIRST_VALUE + i};

    /* A letter that needs a value has a colon behind it. */
    if (!option->letter) continue;
    parser.letters[letters++] = option->letter;
    if (takes == required_argument) {
      parser.letters[letters++] = ':';
    }
  }
}

/* Returns the row of what getopt_long returned: a letter, or FIRST_VALUE plus the row. */
static int find_row(int found)
{
  for (int i = 0; i < parser.n; i++) {
    if (found == FIRST_VALUE + i || found == parser.option[i]->letter) return i;
  }
  return -1;
}

/* Returns the row of an option that was given, or -1. */
static int find_given(const char *name)
{
  int i = parser.n - 1;
  while (i >= 0 && (!parser.given[i] || strcmp(parser.option[i]->name, name) != 0)) {
    i--;
  }
  return i;
}

const char *cli_given(const char *name)
{
  const int i = find_given(name);
  return i >= 0 ? parser.dashed[i] : NULL;
}

const char *cli_given_value(const char *name)
{
  const int i = find_given(name);
  return i >= 0 ? parser.value[i] : NULL;
}

const char *cli_given_of(const cli_option *options)
{
  for (; options->name; options++) {
    const char *given = cli_given(options->name);
    if (given) return given;
  }
  return NULL;
}

const char *cli_command_name(void)
{
  return parser.command;
}

/* ---- values ---- */

/* Stores the number of a word. */
static bool take_word(const cli_option *option, const char *name, const char *value, void *to)
{
  int i;
  if (!cli_choose(parser.command, name, value, option->word, option->n_words, &i)) return false;
  *(int *)to = i;
  return true;
}

/* Returns the unit in which a row's number is stored, by what its value is called; "": none. */
static const char *unit_of(const cli_option *option)
{
  static const char *const units[][2] = {{"MM", "mm"},   {"N", "N"},       {"S", "s"},
                                         {"DEG", "deg"}, {"MM/S", "mm/s"}, {"M/S2", "m/s2"},
                                         {"G", "g/cm3"}, {"PERCENT", "%"}};

  for (size_t i = 0; option->value && i < sizeof units / sizeof *units; i++) {
    if (strcmp(option->value, units[i][0]) == 0) return units[i][1];
  }
  return "";
}

/* Reads a length in the framework's units, which nobody knows yet: one with a unit of its own is
 * kept in mm until cli_lengths_in_units. Returns false if the text is no such length. */
static bool take_length(const char *name, const char *text, double *to)
{
  double number;

  /* A plain number is in the framework's units. */
  if (thr_quantity_read(text, "", &number, NULL) == THR_OK) return false;
  if (thr_quantity_read(text, "mm", &number, NULL) || number <= 0) return false;

  assert(parser.n_lengths < MOST_LENGTHS);
  parser.length[parser.n_lengths++] = (given_length){name, text, to};
  *to = number;
  return true;
}

bool cli_lengths_in_units(const char *units)
{
  for (int i = 0; i < parser.n_lengths; i++) {
    const given_length *length = &parser.length[i];
    double mm;
    if (thr_units_in_mm(units, &mm, NULL)) {
      cli_usage(parser.command,
                "%s %s: nobody knows how long one %s of the framework is; set --units",
                length->name, length->text, units);
      return false;
    }
    *length->to /= mm;
  }
  parser.n_lengths = 0;
  return true;
}

/* Stores a number within the range of its row. */
static bool take_amount(const cli_option *option, const char *name, const char *value, double *to)
{
  const double most = 1e100; /* of what has no limit, to say a number */
  const double low = option->low == CLI_ABOVE_0 ? 0 : option->low;

  if (option->value && strcmp(option->value, "L") == 0 && take_length(name, value, to)) return true;

  /* Infinite limits are not printed as numbers. */
  if (!cli_quantity(parser.command, name, value, unit_of(option), low,
                    isinf(option->high) ? most : option->high, to))
    return false;

  /* The range allows the lower limit 0, which CLI_ABOVE_0 excludes. */
  if (*to >= option->low) return true;
  cli_usage(parser.command, "%s %s: expected a number above 0", name, value);

  return false;
}

/* Stores the value of row i in its group. Returns false after printing what is wrong with the
 * value. */
static bool take_value(int i, const char *value)
{
  const cli_option *option = parser.option[i];
  const char *name = parser.dashed[i];
  void *to = parser.into[i];
  parser.given[i] = true;
  parser.value[i] = value;
  if (option->take) return option->take(to, option, value);

  /* A row without a group, as --config, stores nothing. */
  if (!to) return true;
  to = (char *)to + option->offset;
  switch (option->kind) {
  case CLI_FLAG: *(bool *)to = true; return true;
  case CLI_TEXT: *(const char **)to = value; return true;
  case CLI_OUTPUT:
    *(const char **)to = value;
    if (!*value) cli_usage(parser.command, "an empty name is no place to write to");
    return *value != '\0';
  case CLI_COUNT:
    return cli_int(parser.command, name, value, (int)option->low, (int)option->high, to);
  case CLI_AMOUNT: return take_amount(option, name, value, to);
  case CLI_WORD: return take_word(option, name, value, to);
  default: return false; /* the others take their values themselves */
  }
}

/* Reads "NAME=VALUE", the value of --tune. */
static bool take_tuned(const char *text)
{
  char question[THR_SUGGESTION_TEXT], name[NAME_SIZE];
  thr_suggestion suggestion = {.word = name};
  const size_t n = strcspn(text, "=");
  snprintf(name, sizeof name, "%.*s", (int)n, text);

  /* Find the row, and remember the most similar name. */
  for (int i = 0; i < parser.n; i++) {
    if (!parser.tuned[i]) continue;
    if (text[n] == '=' && strcmp(parser.option[i]->name, name) == 0)
      return take_value(i, text + n + 1);
    thr_suggestion_try(&suggestion, parser.option[i]->name);
  }

  thr_suggestion_ask(&suggestion, question);
  cli_usage(parser.command, "--tune %s: expected NAME=VALUE%s", text, question);

  return false;
}

/* ---- what is no option ---- */

/* Prints why a word "--name" or "--name=value" is refused: no option has the name, several begin
 * with it, or the option takes no value. Returns the exit code. */
static int bad_long_option(const char *word)
{
  char name[64], question[THR_SUGGESTION_TEXT], several[160] = "";
  thr_suggestion suggestion = {.word = name};
  int n = 0;
  snprintf(name, sizeof name, "%.*s", (int)strcspn(word + 2, "="), word + 2);

  /* Compare with all names, and list those that begin with this one. */
  for (int i = 0; i < parser.n; i++) {
    const char *known = parser.option[i]->name;
    if (strcmp(known, name) == 0)
      return parser.tuned[i] ? cli_usage(parser.command, "--%s is spelled --tune %s=..", name, name)
                             : cli_usage(parser.command, "--%s takes no value", name);
    thr_suggestion_try(&suggestion, known);
    if (strncmp(known, name, strlen(name)) != 0) continue;
    const size_t length = strlen(several);
    snprintf(several + length, sizeof several - length, "%s--%s", n++ ? ", " : "", known);
  }

  /* getopt_long takes unique beginnings of names. */
  if (n == 1) return cli_usage(parser.command, "%s takes no value", several);
  if (n > 1) return cli_usage(parser.command, "--%s may be %s", name, several);

  thr_suggestion_ask(&suggestion, question);
  const char *at = strstr(question, "mean ");
  if (!at) return cli_usage(parser.command, "--%s is not an option here", name);

  return cli_usage(parser.command, "--%s is not an option here; did you mean --%s", name,
                   at + strlen("mean "));
}

/* Prints what is wrong with the word that getopt_long refused; returns the exit code. getopt_long
 * has moved operands behind the options, so that the culprit is the word before optind, or a letter
 * inside that word.
 */
static int bad_option(int found, char **argv)
{
  const char *word = argv[optind - 1];
  const bool is_long = strncmp(word, "--", 2) == 0;

  if (found == ':')
    return is_long ? cli_usage(parser.command, "%s needs a value", word)
                   : cli_usage(parser.command, "-%c needs a value", optopt);

  return is_long ? bad_long_option(word)
                 : cli_usage(parser.command, "-%c is not an option here", optopt);
}

/* ---- help ---- */

enum { TEXT_COLUMN = 23, NARROWEST = 60, WIDEST = 100 };

void cli_put_wrapped(thr_text *out, const char *words, int column, int at, int width)
{
  while (*words) {
    /* A word that does not fit begins a new line. */
    const int n = (int)strcspn(words, " \n");
    if (at > column && at + 1 + n > width) {
      thr_text_printf(out, "\n%*s", column, "");
      at = column;
    } else if (at > column) {
      thr_text_append(out, " ");
      at++;
    }

    thr_text_printf(out, "%.*s", n, words);
    at += n;
    words += n;

    if (*words == '\n') {
      thr_text_printf(out, "\n%*s", column, "");
      at = column;
    }
    words += *words != '\0';
  }
  thr_text_append(out, "\n");
}

/* Writes what help calls the value of an option: "N", or its words with bars, "keep|ignore"; "":
 * there is none. */
static void name_value(const cli_option *option, char *text, size_t size)
{
  size_t n = (size_t)snprintf(text, size, "%s", option->value ? option->value : "");

  /* Without a name of its own the value is one of the words. */
  for (int i = 0; !option->value && option->word && i < option->n_words && n < size; i++) {
    n += (size_t)snprintf(text + n, size - n, "%s%s", i ? "|" : "", option->word(i));
  }
}

/* Appends the help of an option, "  -o, --output FILE    what it does", in as many lines as needed,
 * and a line for each word whose meaning is said. */
static void put_option(thr_text *out, const cli_option *option, int width)
{
  char head[160], value[100], letter[8] = "    ";
  if (option->letter) {
    snprintf(letter, sizeof letter, "-%c, ", option->letter);
  }

  /* The head: letter, name and value. */
  name_value(option, value, sizeof value);
  const int n = snprintf(head, sizeof head, "  %s--%s%s%s", letter, option->name,
                         *value && *value != '[' ? " " : "", value);

  /* A long head has its text behind it, too, after three blanks. */
  thr_text_append(out, head);
  const int at = n + 2 <= TEXT_COLUMN ? TEXT_COLUMN : n + 3;
  thr_text_printf(out, "%*s", at - n, "");
  const int first = (int)strcspn(option->help, " \n");
  if (at + first > width) {
    thr_text_printf(out, "\n%*s", TEXT_COLUMN, "");
    cli_put_wrapped(out, option->help, TEXT_COLUMN, TEXT_COLUMN, width);
  } else {
    thr_text_printf(out, "%.*s", first, option->help);
    const char *rest = option->help + first;
    cli_put_wrapped(out, rest + (*rest != '\0'), TEXT_COLUMN, at + first, width);
  }

  /* The words of the value with their meanings, in a column of their own. */
  const int room = 14;
  for (int i = 0; option->meaning && i < option->n_words; i++) {
    const int length = (int)strlen(option->word(i));
    thr_text_printf(out, "%*s%s%*s", TEXT_COLUMN, "", option->word(i),
                    length + 2 < room ? room - length : 2, "");
    cli_put_wrapped(out, option->meaning(i), TEXT_COLUMN + room, TEXT_COLUMN + room, width);
  }
}

/* Appends the names of the options for developers, as the help of --tune. */
static void put_tuned(thr_text *out, const cli_group *groups, int width)
{
  thr_text names = {0};

  /* Their names only, with commas. */
  for (const cli_group *group = groups; group->option; group++) {
    if (group->heading != cli_tuned) continue;
    for (const cli_option *option = group->option; option->name; option++) {
      thr_text_printf(&names, "%s%s", names.length ? ", " : "for developers: ", option->name);
    }
  }

  if (names.length && !names.failed) {
    const cli_option row = {"tune", .value = "NAME=VALUE", .help = names.data};
    put_option(out, &row, width);
  }
  thr_text_destroy(&names);
}

/* Appends the help of a command, as wide as the terminal within limits. */
static void put_help(thr_text *out, const cli_syntax *syntax, const cli_group *groups)
{
  const int columns = thr_os_columns(STDOUT_FILENO);
  const int width = columns < NARROWEST ? WIDEST - 4 : columns > WIDEST ? WIDEST : columns;
  thr_text_append(out, syntax->intro);

  /* The options of the command, group by group. */
  for (const cli_group *group = groups; group->option; group++) {
    if (group->heading == cli_tuned) continue;
    if (group->heading) thr_text_printf(out, "\n%s:\n", group->heading);
    for (const cli_option *option = group->option; option->name; option++) {
      if (option->help) put_option(out, option, width);
    }
  }

  /* The options of every command. */
  thr_text_append(out, "\nEvery command:\n");
  put_tuned(out, groups, width);
  for (const cli_option *option = cli_common_options; option->name; option++) {
    put_option(out, option, width);
  }

  if (syntax->outro) {
    thr_text_append(out, "\n");
    cli_put_wrapped(out, syntax->outro, 0, 0, width);
  }
}

/* ---- parsing ---- */

/* Notes the operands, which are files as well, and compares all files that were named. Returns -1,
 * or prints and returns the exit code. */
static int settle_operands(int argc, char **argv)
{
  for (int i = optind; i < argc; i++) {
    if (!*argv[i]) return cli_usage(parser.command, "an empty name is no file");
    files_heard(NULL, argv[i], false);
  }

  const int code = files_settle(parser.command);
  return code ? code : -1;
}

int cli_options(int argc, char **argv, const cli_syntax *syntax, const cli_group *groups)
{
  /* Completion only asks which options there are. */
  if (cli_show_options) {
    cli_show_options(groups);
    return EXIT_OK;
  }

  /* getopt_long prints nothing itself. */
  join_rows(syntax, groups);
  opterr = 0;
  for (;;) {
    const int found = getopt_long(argc, argv, parser.letters, parser.table, NULL);
    if (found == -1) return settle_operands(argc, argv);
    if (found == ':' || found == '?') return bad_option(found, argv);

    /* Note a value in case it names a file. */
    const int i = find_row(found);
    const cli_option *option = parser.option[i];
    if (optarg) files_heard(option->name, optarg, option->kind == CLI_OUTPUT);

    /* Help ends the command; a value goes to its row. */
    if (option == &tune) {
      if (!take_tuned(optarg)) return EXIT_USAGE;
    } else if (option->kind == CLI_SHOWS && !option->take) {
      thr_text help = {0};
      put_help(&help, syntax, groups);
      return cli_write(&help, "-");
    } else if (!take_value(i, optarg)) {
      return EXIT_USAGE;
    } else if (option->kind == CLI_SHOWS) {
      return EXIT_OK;
    }
  }
}
