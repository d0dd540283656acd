/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Answers programs (--json): which files a command wrote, and why it failed.
 *
 *    {"files": [{"file": "dome/overview.svg", "what": "the overview picture"}], ..}
 *    {"error": "a.json: cannot read: No such file or directory", "code": 3}
 *
 * A command that fails writes the line on stderr as without --json. The process that the user
 * started writes the second object when everything else is over, unless the command has already
 * written to stdout: a plan that misses its gap is an answer, too.
 *
 * The table of exit codes is the one that documents repeat (tests/documents.py). */
#include "cli/cli.h"
#include "graph/os.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool cli_json;

const cli_exit_code cli_exit_codes[] = {
    {EXIT_OK, "done. plan: the shortest, proved; or as near to the least possible as --gap says (1 "
              "%, but for length); or, if neither that nor --time-limit is given, any plan that "
              "keeps to what was asked, with its proven gap"},
    {EXIT_VIOLATION, "check: something in a plan is not true; the message says what and where"},
    {EXIT_USAGE, "wrong usage"},
    {EXIT_INPUT, "input unreadable or invalid, or output not writable"},
    {EXIT_INFEASIBLE,
     "impossible as asked: no threading with these options, and the message says what to change; "
     "eval and compare: no pull holds the structure; info: no motion to draw"},
    {EXIT_LIMIT,
     "not all of it: stopped by --time-limit, --memory, Ctrl-C, SIGTERM or SIGHUP, or not proved "
     "as near to the least possible as was asked, or nothing found and not proved impossible. What "
     "is known so far is written, a plan with its proven gap, and the message says what is "
     "missing"},
    {EXIT_INTERNAL, "a library failed, the program has a fault, or numbers defeated a solver and "
                    "the message says what to change"},
    {EXIT_SECOND_SIGNAL, "ended at once by a second signal; nothing is written"},
};
const int cli_n_exit_codes = sizeof cli_exit_codes / sizeof *cli_exit_codes;

/* ---- failures ---- */

/* The last message of an error, and whether stdout has an answer already. */
static char last_error[8192];
static bool answered;

void answer_error_is(const char *message)
{
  snprintf(last_error, sizeof last_error, "%s", message);
}

const char *answer_error(void)
{
  return answered ? "" : last_error;
}

void answer_given(void)
{
  answered = true;
}

void answer_failure(int code)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  if (!code || !cli_json || answered || !*last_error) return;

  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "error", last_error);
  thr_write_int(&writer, "code", code);
  thr_write_close(&writer);
  thr_text_append(&text, "\n");

  /* Without memory, or with nobody who reads, the line on stderr and the code have to do. */
  if (!text.failed) fputs(text.data, stdout);
  fflush(stdout);
  thr_text_destroy(&text);
}

/* ---- files ---- */

/* What was written so far; both strings of a file are owned. */
static struct {
  char *path, *what;
} * file;
static int n_files;

void answer_file(const char *path, const char *what)
{
  if (!path || strcmp(path, "-") == 0) return;
  char *name = thr_strdup(path), *words = thr_strdup(what);
  void *more = name && words ? thr_realloc(file, (size_t)n_files + 1, sizeof *file) : NULL;

  /* A file that is not remembered is written all the same. */
  if (!more) {
    free(name);
    free(words);
    return;
  }

  file = more;
  file[n_files].path = name;
  file[n_files++].what = words;
}

void answer_put_files(thr_writer *writer)
{
  if (n_files == 0) return;
  thr_write_array(writer, "files");
  for (int i = 0; i < n_files; i++) {
    thr_write_object(writer, NULL);
    thr_write_string(writer, "file", file[i].path);
    thr_write_string(writer, "what", file[i].what);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

int answer_close(thr_writer *writer)
{
  thr_write_close(writer);
  thr_text_append(writer->out, "\n");
  return cli_write(writer->out, "-");
}

int answer_frame(const thr_frame *frame, const char *path)
{
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  answer_file(path, "the framework");
  thr_write_object(&writer, NULL);
  answer_put_files(&writer);
  thr_write_int(&writer, "nodes", frame->n_nodes);
  thr_write_int(&writer, "edges", frame->n_edges);
  thr_write_string(&writer, "units", frame->units);
  thr_write_number(&writer, "length", thr_frame_total_length(frame));
  return answer_close(&writer);
}

void answer_tidy(void)
{
  for (int i = 0; i < n_files; i++) {
    free(file[i].path);
    free(file[i].what);
  }
  free(file);
  file = NULL;
  n_files = 0;
}

/* ---- exit codes ---- */

int answer_exit_codes(void)
{
  enum { COLUMN = 5, USUAL = 96 };
  const int columns = thr_os_columns(STDOUT_FILENO);
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  if (cli_json) {
    thr_write_object(&writer, NULL);
    for (int i = 0; i < cli_n_exit_codes; i++) {
      char code[12];
      snprintf(code, sizeof code, "%d", cli_exit_codes[i].code);
      thr_write_string(&writer, code, cli_exit_codes[i].meaning);
    }
    return answer_close(&writer);
  }

  for (int i = 0; i < cli_n_exit_codes; i++) {
    thr_text_printf(&text, "%-*d", COLUMN, cli_exit_codes[i].code);
    cli_put_wrapped(&text, cli_exit_codes[i].meaning, COLUMN, COLUMN,
                    columns > 0 ? columns : USUAL);
  }

  return cli_write(&text, "-");
}
