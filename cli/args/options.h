/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options as rows of tables. A command names its groups of rows; from them come the parser, the
 * help, what shells complete and, through the help, the man page. A new option is a row. */
#ifndef THR_CLI_OPTIONS_H
#define THR_CLI_OPTIONS_H

#include "graph/text.h"

#include <getopt.h> /* optind */

/* What an option takes, and what becomes of it in the struct of its group. */
typedef enum {
  CLI_FLAG,   /* nothing: a bool becomes true */
  CLI_TEXT,   /* anything: a const char *, which points into the command line */
  CLI_OUTPUT, /* the same, a name to write to, which is not empty */
  CLI_COUNT,  /* a whole number within low .. high: an int */
  CLI_AMOUNT, /* a number within low .. high: a double; low = CLI_ABOVE_0: more than 0 */
  CLI_WORD,   /* one of n_words words: its number, an int or an enumeration */
  CLI_OTHER,  /* what `take` makes of it */
  CLI_SHOWS   /* nothing: `take` prints something, and the command ends with EXIT_OK */
} cli_kind;

#define CLI_ABOVE_0 5e-324

/* Example: {"cover", .value = "N", .help = "at least N passes over every interface",
 *           .kind = CLI_COUNT, .offset = offsetof(thr_request, cover), .low = 1, .high = 100} */
typedef struct cli_option {
  const char *name;  /* without dashes; NULL ends a table */
  char letter;       /* for -x; '\0': none */
  const char *value; /* what help calls the value: "N", "FILE"; in brackets where it may be left
                        out; NULL: its words, or there is none */
  const char *help;  /* sentences, which are wrapped; NULL: the option is not shown */
  cli_kind kind;
  size_t offset; /* of the value in the struct of the group */
  double low, high;
  const char *(*word)(int), *(*meaning)(int); /* words, and what each of them is (NULL: not said) */
  int n_words;
  bool (*take)(void *into, const struct cli_option *option, const char *value);
} cli_option;

/* Rows under one heading of the help. */
typedef struct {
  const char *heading;      /* NULL: they go on under the last heading */
  const cli_option *option; /* ended by a row without a name; NULL ends the list of groups */
  void *into;               /* the struct that the values go to */
} cli_group;

/* The heading of rows for developers, which are spelled --tune NAME=VALUE. Help only names them. */
extern const char cli_tuned[];

/* What a command is called and says of itself. */
typedef struct {
  const char *command;
  const char
      *intro; /* usage and summary in the first line, then examples and what is to be known */
  const char *outro; /* what comes after the options, wrapped: exit codes; NULL: nothing */
} cli_syntax;

/* Reads all options of the command line into the groups, prints help if that is asked for, and
 * compares the files that are named (cli/files.c). Operands begin at argv[optind]. -h, -q, -v,
 * --json and --config are every command's. Returns -1 to go on; else what was wrong is printed, or
 * what was asked for is shown, and the exit code is returned. */
int cli_options(int argc, char **argv, const cli_syntax *syntax, const cli_group *groups);

/* The option with its dashes if it was given in this command line, else NULL. */
const char *cli_given(const char *name);

/* Its value as it was typed, the last if it was given more than once; NULL: it has none. */
const char *cli_given_value(const char *name);

/* The first option of these that was given, with its dashes; NULL: none was. */
const char *cli_given_of(const cli_option *options);

/* The command that reads its options, for messages. */
const char *cli_command_name(void);

/* Somebody to whom a command shows its options instead of doing anything; NULL: nobody. */
extern void (*cli_show_options)(const cli_group *groups);

/* Appends words wrapped at the width; further lines are indented to a column. at: the column where
 * the current line stands. Line breaks in the text are kept. O(letters). */
void cli_put_wrapped(thr_text *out, const char *words, int column, int at, int width);

/* The rows of every command: -h, -q, -v, --json, --config. */
extern const cli_option cli_common_options[];

#endif
