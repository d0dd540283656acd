/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that a command reads and writes: no file is asked for twice, and every output is tried
 * before anything is computed.
 *
 * cli_next_option tells every option and operand to this list, so a command needs no code of its
 * own: options that name an output are known here, every other value that is the name of a file is
 * taken for an input. Files are compared by what they are, not by their names
 * (thr_os_is_same_file). Only `thread eval PLAN -o PLAN` writes what it has read: the plan with its
 * evaluation. */
#include "cli/cli.h"
#include "graph/os.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum { INPUT, OUTPUT, OUTPUT_FOLDER } file_kind;

/* Names are copies: tables of options end with the function that parses them. */
typedef struct {
  char *option, *path; /* option: NULL = an operand; both owned */
  file_kind kind;
} file;

static struct {
  file *file;
  int n;
  char **made; /* folders, in the order in which they were made */
  int n_made;
  const char *command;
} all;

/* ---- what was heard ---- */

static file_kind kind_of(const char *option)
{
  static const char *const output[] = {"output", "plot", "still", "stills"};
  for (size_t i = 0; option && i < sizeof output / sizeof *output; i++)
    if (strcmp(option, output[i]) == 0) return OUTPUT;
  return option && strcmp(option, "draw") == 0 ? OUTPUT_FOLDER : INPUT;
}

static void forget(file *f)
{
  free(f->option);
  free(f->path);
  *f = (file){0};
}

void files_heard(const char *option, const char *value)
{
  const file_kind kind = kind_of(option);
  if (!value || !*value) return;

  file *longer = thr_realloc(all.file, (size_t)all.n + 1, sizeof *longer);
  if (!longer) return; /* whatever comes next says so */
  all.file = longer;
  file heard = {option ? thr_strdup(option) : NULL, thr_strdup(value), kind};
  if ((option && !heard.option) || !heard.path) {
    forget(&heard);
    return;
  }

  /* Of an output that is named again only the last name counts. */
  for (int i = 0; i < all.n && kind != INPUT; i++)
    if (all.file[i].option && strcmp(all.file[i].option, option) == 0) {
      forget(&all.file[i]);
      all.file[i] = heard;
      return;
    }
  all.file[all.n++] = heard;
}

/* ---- comparing ---- */

static bool is_standard(const char *path)
{
  return strcmp(path, "-") == 0;
}

/* Does writing path lose this file? What comes from a file by standard input is that file. */
static bool loses(const char *path, const file *f)
{
  if (is_standard(path) || f->kind == OUTPUT_FOLDER || (f->kind == OUTPUT && is_standard(f->path)))
    return false;
  if (f->kind == INPUT && is_standard(f->path)) return thr_os_is_same_file(path, "/dev/stdin");
  return (f->kind == OUTPUT || thr_os_is_file(f->path)) && thr_os_is_same_file(path, f->path);
}

/* An evaluation is written into the plan that was evaluated. */
static bool may_share(const char *option, const file *f)
{
  return all.command && strcmp(all.command, "eval") == 0 && option &&
         strcmp(option, "output") == 0 && !f->option;
}

static bool is_same_option(const char *a, const char *b)
{
  return a && b && strcmp(a, b) == 0;
}

/* Returns the file that writing path for this option would lose, or NULL. */
static const file *find_lost(const char *path, const char *option)
{
  for (int i = 0; i < all.n; i++) {
    const file *f = &all.file[i];
    if (!is_same_option(option, f->option) && !may_share(option, f) && loses(path, f)) return f;
  }
  return NULL;
}

bool files_is_taken(const char *path, const char *option)
{
  return find_lost(path, option) != NULL;
}

int files_claim(const char *command, const char *option, const char *path)
{
  const file *f = find_lost(path, option);
  if (!f) return EXIT_OK;
  const char *dashes = f->option ? "--" : "", *name = f->option ? f->option : "the command";
  if (f->kind == INPUT)
    return cli_usage(command, "%s is read by %s%s, and %s%s would write over it: name another file",
                     path, dashes, name, option ? "--" : "", option ? option : "a drawing");
  return cli_usage(command, "%s is written by %s%s, too: name another file", path, dashes, name);
}

int files_may_write(const char *path)
{
  for (int i = 0; i < all.n; i++) {
    const file *f = &all.file[i];
    if (f->kind != INPUT || may_share("output", f) || !loses(path, f)) continue;
    cli_error("%s was read, and is not written over: name another file", path);
    return EXIT_USAGE;
  }
  return EXIT_OK;
}

/* ---- trying ---- */

static int cannot_write(const char *path)
{
  cli_error("%s: cannot write: %s", path, strerror(errno));
  return EXIT_INPUT;
}

/* Makes the folder that a file is to be in. */
static int make_folder_of(const char *path)
{
  const size_t n = (size_t)(thr_os_name(path) - path);
  char *folder = n > 0 ? thr_calloc(n + 1, 1) : NULL;
  if (n == 0) return EXIT_OK;
  if (!folder) return cli_fail(&(thr_err){THR_ENOMEM, "out of memory"});
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

/* Tries one output. Only `thread draw -o` takes a folder as well. */
static int try_output(const file *f)
{
  if (f->kind == INPUT || is_standard(f->path)) return EXIT_OK;
  if (f->kind == OUTPUT && cli_is_folder(f->path) && strcmp(all.command, "draw") != 0) {
    cli_error("%s: is a folder; give the name of a file", f->path);
    return EXIT_INPUT;
  }
  if (f->kind == OUTPUT_FOLDER || cli_is_folder(f->path)) return files_try_folder(f->path);
  const int code = make_folder_of(f->path);
  return code || thr_os_can_write(f->path) ? code : cannot_write(f->path);
}

int files_settle(const char *command)
{
  int code = EXIT_OK;
  all.command = command;

  /* An example's name is no file. */
  if (strcmp(command, "make") == 0) {
    int kept = 0;
    for (int i = 0; i < all.n; i++)
      if (all.file[i].kind != INPUT)
        all.file[kept++] = all.file[i];
      else
        forget(&all.file[i]);
    all.n = kept;
  }
  for (int i = 0; i < all.n && !code; i++)
    if (all.file[i].kind == OUTPUT)
      code = files_claim(command, all.file[i].option, all.file[i].path);
  for (int i = 0; i < all.n && !code; i++)
    code = try_output(&all.file[i]);
  return code;
}

int files_also_read(const char *path)
{
  files_heard(NULL, path);
  int code = EXIT_OK;
  for (int i = 0; i < all.n && !code; i++)
    if (all.file[i].kind == OUTPUT)
      code = files_claim(all.command, all.file[i].option, all.file[i].path);
  return code;
}

/* ---- at the end ---- */

void files_name_beside(const char *path, char *name, size_t size)
{
  enum { MOST = 1000 };
  char stem[200];
  const char *ending = thr_path_ending(path);
  cli_stem(is_standard(path) ? "plan.json" : path, stem, sizeof stem);
  if (is_standard(path)) ending = "json";
  const char *dot = *ending ? "." : "";
  snprintf(name, size, "%s%s%.20s", stem, dot, ending);
  for (int i = 2; i <= MOST && (thr_os_is_file(name) || thr_os_is_no_file(name)); i++)
    snprintf(name, size, "%s-%d%s%.20s", stem, i, dot, ending);
}

void files_made(const char *folder)
{
  char *name = thr_strdup(folder);
  char **longer = name ? thr_realloc(all.made, (size_t)all.n_made + 1, sizeof *longer) : NULL;
  if (!longer) {
    free(name);
    return;
  }
  all.made = longer;
  all.made[all.n_made++] = name;
}

void files_tidy(void)
{
  while (all.n_made > 0) {
    (void)thr_os_remove_folder(all.made[--all.n_made]); /* refused where something is in it */
    free(all.made[all.n_made]);
  }
  for (int i = 0; i < all.n; i++)
    forget(&all.file[i]);
  free(all.made);
  free(all.file);
  all.made = NULL;
  all.file = NULL;
  all.n = 0;
}
