/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Knows the files that a command reads and writes: no file is asked for twice, and every output is
 * tried before anything is computed.
 *
 * cli_options tells every option and operand to this list, so that a command needs no code of
 * its own: options that name an output are known here, every other value that is the name of a file
 * is taken for an input. Files are compared by what they are, not by their names
 * (thr_os_is_same_file). Only `thread eval PLAN -o PLAN` writes what it has read: the plan with its
 * evaluation.
 *
 * Example: `thread draw plan.json -o plan.json` is refused: plan.json is read by the command, and
 * --output would write over it. */
#include "cli/cli.h"
#include "graph/os.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a command does with a file. OUTPUT_FOLDER: it writes files of usual names into it. */
typedef enum { INPUT, OUTPUT, OUTPUT_FOLDER } file_kind;

/* A file that the command line names. Names are copies: tables of options end with the function
 * that parses them. */
typedef struct {
  char *option, *path; /* option: NULL = an operand; both owned */
  file_kind kind;
} known_file;

/* All files of this process, and the folders that it has made. */
static struct {
  known_file *file;
  int n;
  char **made; /* folders, in the order in which they were made */
  int n_made;
  const char *command;
} known;

/* ---- what was heard ---- */

/* Returns what a value of this option is. writes: is it the name of an output? */
static file_kind kind_of(const char *option, bool writes)
{
  if (option && strcmp(option, "draw") == 0) return OUTPUT_FOLDER;
  return writes || (option && strcmp(option, "output") == 0) ? OUTPUT : INPUT;
}

/* Frees an entry. */
static void forget(known_file *entry)
{
  free(entry->option);
  free(entry->path);
  *entry = (known_file){0};
}

void files_heard(const char *option, const char *value, bool writes)
{
  const file_kind kind = kind_of(option, writes);

  if (!value || !*value) return;

  known_file *longer = thr_realloc(known.file, (size_t)known.n + 1, sizeof *longer);
  if (!longer) return; /* whatever comes next says so */
  known.file = longer;

  /* Copies, since tables of options and config files end before the command does. */
  known_file heard = {option ? thr_strdup(option) : NULL, thr_strdup(value), kind};
  if ((option && !heard.option) || !heard.path) {
    forget(&heard);
    return;
  }

  /* Of an output that is named again only the last name counts. */
  for (int i = 0; i < known.n && kind != INPUT; i++)
    if (known.file[i].option && strcmp(known.file[i].option, option) == 0) {
      forget(&known.file[i]);
      known.file[i] = heard;
      return;
    }
  known.file[known.n++] = heard;
}

/* ---- comparing ---- */

/* Returns whether the path means stdin or stdout. */
static bool is_standard(const char *path)
{
  return strcmp(path, "-") == 0;
}

/* Returns whether writing to path would lose this file. What comes from a file by standard input is
 * that file. */
static bool is_lost_by(const char *path, const known_file *entry)
{
  /* Standard streams and folders lose nothing. */
  if (is_standard(path) || entry->kind == OUTPUT_FOLDER ||
      (entry->kind == OUTPUT && is_standard(entry->path)))
    return false;
  if (entry->kind == INPUT && is_standard(entry->path))
    return thr_os_is_same_file(path, "/dev/stdin");

  return (entry->kind == OUTPUT || thr_os_is_file(entry->path)) &&
         thr_os_is_same_file(path, entry->path);
}

/* Returns whether this output may be this input: an evaluation is written into the plan that was
 * evaluated. */
static bool is_sharing_allowed(const char *option, const known_file *entry)
{
  return known.command && strcmp(known.command, "eval") == 0 && option &&
         strcmp(option, "output") == 0 && !entry->option;
}

static bool is_same_option(const char *a, const char *b)
{
  return a && b && strcmp(a, b) == 0;
}

/* Returns the file that writing path for this option would lose, or NULL. */
static const known_file *find_lost(const char *path, const char *option)
{
  for (int i = 0; i < known.n; i++) {
    const known_file *entry = &known.file[i];
    if (!is_same_option(option, entry->option) && !is_sharing_allowed(option, entry) &&
        is_lost_by(path, entry))
      return entry;
  }
  return NULL;
}

bool files_is_taken(const char *path, const char *option)
{
  return find_lost(path, option) != NULL;
}

int files_claim(const char *command, const char *option, const char *path)
{
  const known_file *entry = find_lost(path, option);

  if (!entry) return EXIT_OK;

  /* An operand is read by the command itself. */
  const char *dashes = entry->option ? "--" : "",
             *name = entry->option ? entry->option : "the command";

  /* An input would be lost; an output would be written twice. */
  if (entry->kind == INPUT)
    return cli_usage(command, "%s is read by %s%s, and %s%s would write over it: name another file",
                     path, dashes, name, option ? "--" : "", option ? option : "a drawing");

  return cli_usage(command, "%s is written by %s%s, too: name another file", path, dashes, name);
}

int files_may_write(const char *path)
{
  for (int i = 0; i < known.n; i++) {
    const known_file *entry = &known.file[i];

    /* Only inputs are protected here. */
    if (entry->kind != INPUT || is_sharing_allowed("output", entry) || !is_lost_by(path, entry))
      continue;
    cli_error("%s was read, and is not written over: name another file", path);
    return EXIT_USAGE;
  }

  return EXIT_OK;
}

/* ---- trying ---- */

/* Prints why the system does not write there, and returns the exit code. */
static int cannot_write(const char *path)
{
  cli_error("%s: cannot write: %s", path, strerror(errno));
  return EXIT_INPUT;
}

/* Makes the folder that a file is to be in. Returns an exit code. */
static int make_folder_of(const char *path)
{
  const size_t n = (size_t)(thr_os_name(path) - path);
  char *folder = n > 0 ? thr_calloc(n + 1, 1) : NULL;

  if (n == 0) return EXIT_OK;
  if (!folder) return cli_fail(&(thr_err){THR_ENOMEM, "out of memory"});

  /* The path up to the file's name, without the separators at its end. */
  memcpy(folder, path, n);
  while (strlen(folder) > 1 && thr_os_is_separator(folder[strlen(folder) - 1]))
    folder[strlen(folder) - 1] = '\0';

  const int code = cli_make_folder(folder);
  free(folder);

  return code;
}

int files_try_folder(const char *folder)
{
  char inside[1200];
  const int code = cli_in_folder(folder, "plan.json", inside, sizeof inside);
  return code || thr_os_can_write(inside) ? code : cannot_write(folder);
}

/* Tries whether an output can be written. `thread draw -o` takes a folder as well, `thread kit -o`
 * nothing else. Returns an exit code. */
static int try_output(const known_file *entry)
{
  if (entry->kind == INPUT || is_standard(entry->path)) return EXIT_OK;

  if (strcmp(known.command, "kit") == 0) return files_try_folder(entry->path);

  /* Only a file can be an output of most commands. */
  if (entry->kind == OUTPUT && cli_is_folder(entry->path) && strcmp(known.command, "draw") != 0) {
    cli_error("%s: is a folder; give the name of a file", entry->path);
    return EXIT_INPUT;
  }

  if (entry->kind == OUTPUT_FOLDER || cli_is_folder(entry->path))
    return files_try_folder(entry->path);

  /* The system is asked: permissions, full disks and devices are its business. */
  const int code = make_folder_of(entry->path);

  return code || thr_os_can_write(entry->path) ? code : cannot_write(entry->path);
}

int files_settle(const char *command)
{
  int code = EXIT_OK;

  known.command = command;

  /* The operand of thread make is the name of a shape, not of a file. */
  if (strcmp(command, "make") == 0) {
    int kept = 0;
    for (int i = 0; i < known.n; i++)
      if (known.file[i].kind != INPUT)
        known.file[kept++] = known.file[i];
      else
        forget(&known.file[i]);
    known.n = kept;
  }

  /* No output is a file that is read or written otherwise; then all of them are tried. */
  for (int i = 0; i < known.n && !code; i++)
    if (known.file[i].kind == OUTPUT)
      code = files_claim(command, known.file[i].option, known.file[i].path);
  for (int i = 0; i < known.n && !code; i++)
    code = try_output(&known.file[i]);

  return code;
}

int files_also_read(const char *path)
{
  files_heard(NULL, path, false);
  int code = EXIT_OK;
  for (int i = 0; i < known.n && !code; i++)
    if (known.file[i].kind == OUTPUT)
      code = files_claim(known.command, known.file[i].option, known.file[i].path);
  return code;
}

/* ---- at the end ---- */

void files_name_beside(const char *path, char *name, size_t size)
{
  enum { MOST = 1000 };
  char stem[200];
  const char *ending = thr_path_ending(path);

  /* The name, and the ending, of a plan if there is no name. */
  cli_stem(is_standard(path) ? "plan.json" : path, stem, sizeof stem);
  if (is_standard(path)) ending = "json";
  const char *dot = *ending ? "." : "";

  /* The first name that no file has. */
  snprintf(name, size, "%s%s%.20s", stem, dot, ending);
  for (int i = 2; i <= MOST && (thr_os_is_file(name) || thr_os_is_no_file(name)); i++)
    snprintf(name, size, "%s-%d%s%.20s", stem, i, dot, ending);
}

void files_made(const char *folder)
{
  char *name = thr_strdup(folder);
  char **longer = name ? thr_realloc(known.made, (size_t)known.n_made + 1, sizeof *longer) : NULL;

  /* A folder that is not remembered merely stays. */
  if (!longer) {
    free(name);
    return;
  }

  known.made = longer;
  known.made[known.n_made++] = name;
}

void files_tidy(void)
{
  while (known.n_made > 0) {
    /* The last folder that was made is the innermost one. */
    (void)thr_os_remove_folder(known.made[--known.n_made]); /* refused where something is in it */
    free(known.made[known.n_made]);
  }

  /* Memory checkers see that nothing is left. */
  for (int i = 0; i < known.n; i++)
    forget(&known.file[i]);
  free(known.made);
  free(known.file);
  known.made = NULL;
  known.file = NULL;
  known.n = 0;
}
