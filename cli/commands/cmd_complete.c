/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread complete: prints what may stand next on a command line, for the completions of shells.
 *
 * Each command is run with nothing but a listener: cli_show_options makes it show its rows of
 * options (cli/args/options.h) instead of doing anything, so that there is no second list.
 *
 * Example: `thread complete plan --ob` prints a line for each option of thread plan, "--objective"
 * with what its help says first among them; the shell chooses what fits. `thread complete --json
 * plan --ob` answers {"words": [{"word": "--objective", "meaning": ".."}, ..]}. */
#include "cli/cli.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* The option whose values are looked for, as it was typed; NULL = all options. */
static const char *wanted;

/* Has the command that is asked shown a value? */
static bool found;

/* The answer of --json. */
static thr_text answer;
static thr_writer writer = {.out = &answer};

/* Prints a word that may stand next, with what it is (NULL: not said). */
static void put_word(const char *word, const char *meaning)
{
  if (!cli_json) {
    printf(meaning ? "%s\t%s\n" : "%s\n", word, meaning);
    return;
  }
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "word", word);
  if (meaning) thr_write_string(&writer, "meaning", meaning);
  thr_write_close(&writer);
}

/* The words that the value of an option may be, with what each is; of others those of its value
 * that are words: "lowest|FILE" has one. */
static void put_values(const cli_option *option)
{
  for (int i = 0; option->word && i < option->n_words; i++) {
    found = true;
    put_word(option->word(i), option->meaning ? option->meaning(i) : NULL);
  }
  const char *word = option->word || !option->value ? "" : option->value;
  while (*word) {
    const int n = (int)strcspn(word, "|");
    if (islower((unsigned char)*word) && strchr(option->value, '|') &&
        strcspn(word, ",.") >= (size_t)n) {
      char one[64];
      found = true;
      snprintf(one, sizeof one, "%.*s", n, word);
      put_word(one, NULL);
    }
    word += n + (word[n] == '|');
  }
}

/* A line for each option that is shown: the word, a tab, how its help begins. */
static void show_rows(const cli_option *option)
{
  const int most = 70;
  for (; option->name; option++) {
    const bool is_wanted =
        wanted && (wanted[1] != '-' ? option->letter && wanted[1] == option->letter
                                    : strstr(option->name, wanted + 2) == option->name);
    if (is_wanted && !found) put_values(option);
    if (!wanted && option->help) {
      int n = (int)strcspn(option->help, "\n");
      if (n > most) {
        for (n = most; n > 0 && option->help[n] != ' ';) {
          n--;
        }
      }
      char name[64], begins[96];
      snprintf(name, sizeof name, "--%s", option->name);
      snprintf(begins, sizeof begins, "%.*s%s", n, option->help, option->help[n] ? " .." : "");
      put_word(name, begins);
    }
  }
}

/* Shows all rows; those for developers are values of --tune. */
static void show_groups(const cli_group *groups)
{
  const char tune[] = "--tune";
  const bool tuned = wanted && strcmp(wanted, tune) == 0;
  bool any = false;

  for (const cli_group *group = groups; group->option; group++) {
    if (group->heading != cli_tuned) {
      show_rows(group->option);
      continue;
    }
    any = true;
    for (const cli_option *option = group->option; tuned && option->name; option++) {
      char name[64];
      found = true;
      snprintf(name, sizeof name, "%s=", option->name);
      put_word(name, NULL);
    }
  }
  if (any && !wanted) put_word(tune, cli_tuned);
  show_rows(cli_common_options);
}

/* Returns the command of that name, or NULL. */
static const cli_command *find_command(const char *name)
{
  for (int i = 0; i < cli_n_commands; i++)
    if (strcmp(name, cli_commands[i].name) == 0) return &cli_commands[i];
  return NULL;
}

/* Has a command show its options or, unless option is NULL, the values of this one. */
static void ask_command(const cli_command *command, const char *option)
{
  char name[16];

  snprintf(name, sizeof name, "%s", command->name);
  char *argv[] = {name, NULL};

  /* The command's own parsing ends as soon as it has shown its options. */
  wanted = option;
  cli_show_options = show_groups;
  (void)command->run(1, argv);
  cli_show_options = NULL;
}

/* Prints a line for each command. */
static void put_commands(void)
{
  for (int i = 0; i < cli_n_commands; i++)
    put_word(cli_commands[i].name, cli_commands[i].summary);
}

/* argv: "complete" and the words of the line after "thread", of which the last is being typed.
 * Prints a line for each word that may stand in its place, whatever of it is typed already, with a
 * tab and an explanation; nothing where any file may. */
static void put_words(int argc, char **argv)
{
  const char *last = argc > 1 ? argv[argc - 1] : "", *before = argc > 2 ? argv[argc - 2] : "";
  const cli_command *command = argc > 2 ? find_command(argv[1]) : NULL;

  if (strcmp(before, "=") == 0 && argc > 3)
    before = argv[argc - 3]; /* shells that take --name=value for three words */

  /* The value of an option: after --name=, or as a word of its own. */
  if (strcmp(last, "=") == 0) {
    last = "";
  } else if (strncmp(last, "--", 2) == 0 && strchr(last, '=')) {
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(last, "="), last);
    if (command) ask_command(command, name);
    return;
  }

  /* The command itself. */
  if (argc <= 2 || strcmp(argv[1], "help") == 0) {
    put_commands();
    if (argc <= 2) put_word("help", "what a command does");
    if (argc > 2 || last[0] != '-') return;
    put_word("--help", NULL);
    put_word("--version", NULL);
    return;
  }

  if (!command) return;

  /* Values of the option before, then options, then the shapes of thread make. */
  if (before[0] == '-' && before[1]) ask_command(command, before);
  if (found) return;
  if (last[0] == '-') ask_command(command, NULL);
  if (last[0] != '-' && argc == 3 && command->run == cmd_make)
    for (int i = 0; i < THR_N_SHAPES; i++)
      put_word(thr_shape_name(i), NULL);
}

/* --json as the first word is about the answer; later it is a word of the line. */
int cmd_complete(int argc, char **argv)
{
  const bool json = argc > 1 && strcmp(argv[1], "--json") == 0;
  if (json) argv[1] = argv[0];

  cli_json = json;
  if (json) thr_write_object(&writer, NULL);
  if (json) thr_write_array(&writer, "words");
  put_words(argc - json, argv + json);
  if (!json) return EXIT_OK;

  thr_write_close(&writer);
  return answer_close(&writer);
}
