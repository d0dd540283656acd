/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements --config FILE: options from a file, as if they stood before those of the command line.
 *
 * The lines of the file become words --name=value, which are put between the command and the words
 * that the user typed. The usual parser then reads all of them, and a later option wins.
 *
 * Example: a line "cover = 2" under "[plan]" makes `thread plan --config FILE dome.obj` run as
 * `thread plan --cover=2 dome.obj`. */
#include "cli/args/args.h"
#include "graph/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *source; /* the file, NULL = none was named */
static int n_words;        /* of it, from argv[1] of the command on */
static char **words;       /* of the new command line, for as long as the program runs */

const char *cli_config_of(int i)
{
  return i >= 1 && i <= n_words ? source : NULL;
}

/* Cuts blanks off both ends of a text, in place; returns its beginning. */
static char *trim(char *text)
{
  size_t n = strlen(text);
  while (n > 0 && strchr(" \t\r", text[n - 1]))
    text[--n] = '\0';
  return text + strspn(text, " \t");
}

/* Turns a line into a word of the command line, "" if the line is blank, a comment, a heading or
 * for another command. *applies: whether lines are for this command, which headings change. Returns
 * false after printing what is wrong with the line. A word is at most 8 bytes longer than its line.
 */
static bool word_of(char *line, int number, const char *command, bool *applies, char *word,
                    size_t size)
{
  char *name = trim(line), *value = strchr(name, '='), *after;
  size_t n = strlen(name);
  *word = '\0';

  /* Blank lines and comments. */
  if (n == 0 || *name == '#') return true;

  /* A heading names the command that the next lines are for. */
  if (*name == '[' && name[n - 1] == ']') {
    name[n - 1] = '\0';
    *applies = strcmp(trim(name + 1), command) == 0;
    return true;
  }

  /* An option: its name, and perhaps a value. */
  if (value) *value++ = '\0';
  name = trim(name);
  after = name + strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789-");
  if (*name == '-' || *name == '\0' || *after || strcmp(name, "config") == 0) {
    cli_error(
        "%s:%d: %s: expected `name = value`, the name of an option without dashes, or [command]",
        source, number, name);
    return false;
  }

  /* Only now: mistakes in lines for other commands are found as well. */
  if (*applies) snprintf(word, size, value ? "--%s=%s" : "--%s", name, value ? trim(value) : "");

  return true;
}

/* Fills `words` with the command and the words of the file; *n counts them. Returns an exit code.
 */
static int join(thr_text *file, const char *command, int argc, char **argv, int *n)
{
  int lines = 1, number = 0;
  bool applies = true;

  /* One word for each line at most. */
  for (size_t i = 0; i < file->length; i++)
    lines += file->data[i] == '\n';
  if (!(words = thr_calloc((size_t)argc + (size_t)lines + 1, sizeof *words)))
    return cli_fail(&(thr_err){THR_ENOMEM, "out of memory"});

  words[(*n)++] = argv[0];
  words[(*n)++] = argv[1];

  /* Each line is cut at its end, in place. */
  for (char *line = file->data, *end; line; line = end) {
    if ((end = strchr(line, '\n'))) *end++ = '\0';

    /* Room for the dashes before a name and what stands between it and its value. */
    const size_t size = strlen(line) + 8;
    char *word = thr_calloc(size, 1);
    if (!word) return cli_fail(&(thr_err){THR_ENOMEM, "out of memory"});

    bool good = word_of(line, ++number, command, &applies, word, size);
    if (*word)
      words[(*n)++] = word;
    else
      free(word);
    if (!good) return EXIT_INPUT;
  }

  n_words = *n - 2;

  return EXIT_OK;
}

/* Takes --config FILE or --config=FILE out of the command line; the last one counts. Returns false
 * if the value is missing. */
static bool take_out(int *argc, char **argv)
{
  int n = 2;

  /* Words behind "--" are operands, whatever they look like. */
  for (int i = 2; i < *argc; i++) {
    if (strcmp(argv[i], "--") == 0) {
      while (i < *argc)
        argv[n++] = argv[i++];
      break;
    }

    /* Either spelling, or another word, which stays. */
    if (strncmp(argv[i], "--config=", 9) == 0) {
      source = argv[i] + 9;
    } else if (strcmp(argv[i], "--config") == 0) {
      if (++i == *argc) return false;
      source = argv[i];
    } else {
      argv[n++] = argv[i];
    }
  }

  argv[n] = NULL;
  *argc = n;

  return true;
}

int cli_config(int *argc, char ***argv)
{
  thr_err err = {0};
  thr_text file = {0};
  int n = 0;

  /* Without --config the command line stays as it is. */
  if (!take_out(argc, *argv)) return cli_usage((*argv)[1], "--config needs a value");
  if (!source) return EXIT_OK;
  if (strcmp(source, "-") == 0)
    return cli_usage((*argv)[1], "--config -: options come from a file, not from stdin");

  /* The file is an input, which no output may overwrite. */
  if (thr_text_read_plain(&file, source, &err)) return cli_fail(&err);
  files_heard("config", source, false);

  int code = join(&file, (*argv)[1], *argc, *argv, &n);
  thr_text_destroy(&file);
  if (code) return code;

  /* The words of the user come last, and so win. */
  for (int i = 2; i < *argc; i++)
    words[n++] = (*argv)[i];
  words[n] = NULL;
  *argc = n;
  *argv = words;

  return EXIT_OK;
}
