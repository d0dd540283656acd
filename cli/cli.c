/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements what the commands share: messages, values of options, reading of frameworks and plans,
 * and writing of results. cli/ is the only folder that prints or exits.
 *
 * Every message is one line on stderr that begins with "thread: ". A function that fails prints why
 * and returns the exit code, so that a command only passes the code on. */
#define _POSIX_C_SOURCE 200809L
#include "cli/cli.h"
#include "cli/args/args.h"
#include "graph/check/check.h"
#include "graph/os.h"
#include "lib/lib.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool cli_quiet, cli_verbose;
static int processes; /* 0 = not said */

enum { MOST_PROCESSES = 1024 };

/* ---- messages ---- */

/* Cuts the middle out of words of more than 400 bytes, so that a value pasted by mistake does not
 * fill the screen. */
static void shorten_words(char *line)
{
  enum { MOST = 400, KEPT = 100 /* at each end */ };
  for (char *word = line; *word; word += strcspn(word, " ")) {
    word += strspn(word, " ");
    const size_t length = strcspn(word, " ");
    if (length <= MOST) continue;

    /* Keep both ends, and no part of a letter of several bytes. */
    char *from = word + KEPT, *to = word + length - KEPT;
    while (thr_text_is_inside(*from))
      from--;
    while (thr_text_is_inside(*to))
      to++;

    /* Two dots stand for the middle. */
    from[0] = from[1] = '.';
    memmove(from + 2, to, strlen(to) + 1);
  }
}

/* Puts line ends in place of blanks, so that no line is wider than a terminal of so many columns. A
 * word that is wider stays whole. */
static void wrap(char *line, size_t columns)
{
  const size_t prefix = strlen("thread: ");
  size_t width = prefix;
  char *blank = NULL;

  for (char *at = line; *at; at++) {
    width += !thr_text_is_inside(*at);
    if (*at == ' ') blank = at;
    if (width <= columns || !blank) continue;
    *blank = '\n';
    width = (size_t)(at - blank);
    blank = NULL;
  }
}

/* Prints a message and a text after it as one line, whatever line breaks the names in it hold, but
 * wrapped where a terminal is; and takes it down if it is an error. Allocates nothing, and so also
 * works when memory runs out. */
static void say(const char *format, va_list args, const char *after, bool error)
{
  char line[8192 + 512];
  const int columns = thr_os_columns(STDERR_FILENO);
  const bool red = error && cli_is_coloured(STDERR_FILENO);

  vsnprintf(line, 8192, format, args);
  thr_text_clean(line);
  shorten_words(line);
  if (error) answer_error_is(line);

  const size_t n = strlen(line);
  snprintf(line + n, sizeof line - n, "%s", after);
  if (columns > 0) wrap(line, (size_t)columns);
  fprintf(stderr, "%sthread:%s %s\n", red ? "\033[1;31m" : "", red ? "\033[0m" : "", line);
}

void cli_note(const char *format, ...)
{
  if (cli_quiet) return;
  va_list args;
  cli_progress_wipe();
  va_start(args, format);
  say(format, args, "", false);
  va_end(args);
}

void cli_error(const char *format, ...)
{
  va_list args;
  va_start(args, format);
  cli_progress_end();
  say(format, args, "", true);
  va_end(args);
}

int cli_fail(const thr_err *err)
{
  if (err->code == THR_ENOMEM && guard_no_memory()) return EXIT_INTERNAL; /* the parent says so */

  /* Otherwise this process prints the text, and the status says the exit code. */
  cli_error("%s", err->text);
  switch (err->code) {
  case THR_OK: return EXIT_OK;
  case THR_EVIOLATED: /* only `check` calls this a violation; elsewhere the plan is simply no good
                         input */
  case THR_EIO:
  case THR_EINPUT: return EXIT_INPUT;
  case THR_EINFEASIBLE: return EXIT_INFEASIBLE;
  case THR_ELIMIT: return EXIT_LIMIT;
  default: return EXIT_INTERNAL;
  }
}

int cli_usage(const char *command, const char *format, ...)
{
  char where[400];
  va_list args;
  const char *config = cli_config_of(optind - 1); /* the word that is being looked at */

  /* Say if the option came from a config file, and which help to read. */
  snprintf(where, sizeof where, " (%s%.300s%ssee `thread %s --help`)", config ? "in " : "",
           config ? config : "", config ? "; " : "", command);
  va_start(args, format);
  say(format, args, where, true);
  va_end(args);

  return EXIT_USAGE;
}

/* ---- values of options ---- */

bool cli_pixels(const char *command, const char *option, const char *text, int low, int high,
                int size[2])
{
  int end = 0;
  if (sscanf(text, "%5dx%5d%n", &size[0], &size[1], &end) == 2 && !text[end] && size[0] >= low &&
      size[1] >= low && size[0] <= high && size[1] <= high)
    return true;
  cli_usage(command, "--%s %s: expected width x height in px, %d to %d, as 1200x900", option, text,
            low, high);
  return false;
}

bool cli_double(const char *command, const char *option, const char *text, double low, double high,
                double *out)
{
  return cli_quantity(command, option, text, "", low, high, out);
}

bool cli_quantity(const char *command, const char *option, const char *text, const char *unit,
                  double low, double high, double *out)
{
  double number;
  thr_err err = {0};

  /* NaN and infinities are refused as well. */
  thr_status st = thr_quantity_read(text, unit, &number, &err);
  if (!st && number >= low && number <= high) {
    *out = number;
    return true;
  }

  /* A number with a wrong unit, or no number that is wanted. */
  const size_t digits = strspn(text, "0123456789.+-");
  if (st && *unit && digits > 0 && text[digits])
    cli_usage(command, "%s %s: %s", option, text, err.text);
  else
    cli_usage(command, "%s %s: expected a number from %g to %g%s%s", option, text, low, high,
              *unit ? " " : "", unit);

  return false;
}

bool cli_hand(const char *command, const char *text, double *newtons)
{
  const double one = thr_hand_most, two = 2 * thr_hand_most, least = 1e-6, most = 1e9; /* N */
  const bool is_one = strcmp(text, "one") == 0;

  /* What one hand, or two, pull again and again. */
  if (is_one || strcmp(text, "two") == 0) {
    *newtons = is_one ? one : two;
    return true;
  }

  /* Any other text is a force. */
  const double force = strtod(text, NULL);
  if (!(force > 0)) {
    cli_usage(command, "--hand %s: expected one, two or a force in newtons", text);
    return false;
  }

  return cli_quantity(command, "--hand", text, "N", least, most, newtons);
}

bool cli_int(const char *command, const char *option, const char *text, int low, int high, int *out)
{
  double number;
  if (!cli_double(command, option, text, low, high, &number)) return false;
  *out = (int)number;
  if (*out == number) return true;
  cli_usage(command, "%s %s: expected a whole number", option, text);
  return false;
}

bool cli_choose(const char *command, const char *option, const char *value,
                const char *(*name)(int), int n, int *out)
{
  char known[160] = "", question[THR_SUGGESTION_TEXT];
  thr_suggestion suggestion = {.word = value};

  /* Compare with every name, and remember the most similar one. */
  for (*out = 0; *out < n; ++*out) {
    if (strcmp(value, name(*out)) == 0) return true;
    thr_suggestion_try(&suggestion, name(*out));
  }

  /* List the names: "a, b or c". */
  thr_suggestion_ask(&suggestion, question);
  for (int i = 0; i < n; i++) {
    size_t length = strlen(known);
    snprintf(known + length, sizeof known - length, "%s%s",
             i == 0       ? ""
             : i == n - 1 ? " or "
                          : ", ",
             name(i));
  }

  cli_usage(command, "%s %s: expected %s%s", option, value, known, question);

  return false;
}

/* ---- frameworks ---- */

/* Prints what reading did to the framework (merged, dropped, odd), a note for each line. */
static thr_status note_read(const thr_frame *frame, const thr_read_report *report, thr_err *err)
{
  if (cli_quiet) return THR_OK;

  thr_text text = {0};
  thr_status st = thr_read_notes(frame, report, &text, err);

  for (char *save = NULL, *line = st || !text.data ? NULL : strtok_r(text.data, "\n", &save); line;
       line = strtok_r(NULL, "\n", &save))
    cli_note("note: %s", line);

  thr_text_destroy(&text);

  return st;
}

int cli_read_frame(const char *path, const cli_frame_args *args, thr_frame *frame)
{
  thr_read_report report = {0};
  return cli_read_frame_report(path, args, frame, &report);
}

int cli_read_frame_report(const char *path, const cli_frame_args *args, thr_frame *frame,
                          thr_read_report *report)
{
  thr_err err = {0};
  char pair[1024] = "";

  /* A table of nodes may have its edges in a second file beside it. */
  cli_step("reading", strcmp(path, "-") == 0 ? "stdin" : path);
  thr_status st = thr_frame_read(frame, report, path, &args->read, pair, sizeof pair, &err);
  if (pair[0])
    cli_note("note: read together with %s", pair); /* before an error that may name that file */
  if (st) return cli_fail(&err);
  cli_step("working", "");

  /* The second file must not be an output of this command. */
  const int taken = pair[0] ? files_also_read(pair) : EXIT_OK;
  if (taken) {
    thr_frame_destroy(frame);
    return taken;
  }

  /* Say what was changed on reading. */
  if (note_read(frame, report, &err)) {
    thr_frame_destroy(frame);
    return cli_fail(&err);
  }

  /* Lengths in options, which are in the framework's units from now on. */
  if (!cli_lengths_in_units(frame->units)) {
    thr_frame_destroy(frame);
    return EXIT_USAGE;
  }

  /* --feet replaces the feet of the file: by words for some of them, or by those named. */
  if (!args->feet) return EXIT_OK;
  int code = EXIT_OK;
  if (thr_feet_is_word(args->feet)) {
    if (thr_frame_feet_where(frame, args->feet, &err)) {
      cli_error("--feet %s", err.text);
      code = EXIT_INPUT;
    }
  } else {
    memset(frame->foot, 0, (size_t)frame->n_nodes * sizeof *frame->foot);
    if (!cli_mark_nodes(frame, args->feet, "--feet", frame->foot)) code = EXIT_INPUT;
  }
  if (code) thr_frame_destroy(frame);

  return code;
}

bool cli_is_folder(const char *path)
{
  size_t n = strlen(path);
  return (n && thr_os_is_separator(path[n - 1])) || thr_os_is_folder(path);
}

bool cli_misnamed(const char *output, const char *like)
{
  const char *ending = thr_path_ending(output);
  return *ending && !cli_is_folder(output) && strcmp(output, "-") != 0 &&
         strcmp(ending, thr_path_ending(like)) != 0;
}

bool cli_no_plan_name(const char *command, const char *output)
{
  const bool wrong = cli_misnamed(output, "plan.json");
  if (wrong)
    cli_usage(command, "%s: a plan is JSON; end its name in .json (thread draw makes the pictures)",
              output);
  return wrong;
}

bool cli_output_format(const char *command, const char *output, const char *type,
                       const thr_format **format)
{
  const bool ends = *thr_path_ending(output) != '\0';
  const thr_format *named = thr_format_of_path(output);
  char list[160];

  /* -T names the format of an output without an ending; an ending must agree with -T. */
  *format = named;
  if (type && !(*format = thr_format_written(type))) {
    thr_formats_written(list, sizeof list, "", ", ", " or ");
    cli_usage(command, "-T %s: expected %s", type, list);
    return false;
  }

  if (ends && (!named || (type && named != *format))) {
    thr_formats_written(list, sizeof list, ".", ", ", " or ");
    cli_usage(command, "%s: the ending must be %s%s", output, type ? "." : "", type ? type : list);
    return false;
  }

  if (cli_json && strcmp(output, "-") == 0) {
    cli_usage(command, "--json and the framework both want stdout; -o FILE takes the framework");
    return false;
  }

  return true;
}

int cli_no_node(const thr_frame *frame, const char *option, const char *what, const char *name)
{
  char question[THR_SUGGESTION_TEXT];
  thr_suggestion suggestion = {.word = name};

  for (int v = 0; v < frame->n_nodes; v++)
    thr_suggestion_try(&suggestion, frame->name[v]);
  thr_suggestion_ask(&suggestion, question);

  cli_error("%s: there is no %s %s; the first node is %s%s", option, what, name, frame->name[0],
            question);

  return EXIT_INPUT;
}

/* Marks the node with this name. Returns false after printing that there is none. */
static bool mark_node(const thr_frame *frame, const char *name, const char *option, bool *mark)
{
  int v = thr_frame_find(frame, name);
  if (v < 0) {
    cli_no_node(frame, option, "file and no node called", name);
    return false;
  }
  mark[v] = true;
  return true;
}

bool cli_mark_nodes(const thr_frame *frame, const char *list, const char *option, bool *mark)
{
  thr_err err = {0};
  thr_text text = {0};

  /* The list may be the name of one node, although the name holds separators. */
  if (thr_frame_find(frame, list) >= 0)
    return mark_node(frame, list, option, mark); /* "(0, 1)" is one COMPAS key */

  /* Else the list is a file of names, or the names themselves. */
  if (thr_os_is_file(list)) {
    if (thr_text_read_plain(&text, list, &err)) {
      cli_fail(&err);
      return false;
    }
  } else {
    thr_text_append(&text, list);
  }

  /* Names are separated by commas, semicolons or blanks. */
  bool ok = true, some = false;
  for (char *save = NULL, *name = text.data ? strtok_r(text.data, ", \t\r\n;", &save) : NULL;
       name && ok; name = strtok_r(NULL, ", \t\r\n;", &save)) {
    ok = mark_node(frame, name, option, mark);
    some = true;
  }

  /* A list of separators alone is a mistake. */
  if (ok && !some) {
    cli_error("%s %s: names no node", option, list);
    ok = false;
  }
  thr_text_destroy(&text);

  return ok;
}

int cli_resolve_ends(const char *ends, const thr_frame *frame, thr_request *options)
{
  /* A word for a kind of ends. */
  for (int kind = THR_ENDS_CLOSED; kind < THR_ENDS_NODES; kind++)
    if (strcmp(ends, thr_ends_name(kind)) == 0) {
      options->ends = (thr_ends)kind;
      return EXIT_OK;
    }

  /* Anything else names nodes. */
  options->ends = THR_ENDS_NODES;
  if (!(options->end_node = thr_calloc((size_t)frame->n_nodes, sizeof *options->end_node))) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }

  return cli_mark_nodes(frame, ends, "--ends", options->end_node) ? EXIT_OK : EXIT_INPUT;
}

int cli_read_plan(const char *path, thr_plan *plan)
{
  thr_err err = {0}, found = {0};
  cli_step("reading and checking", strcmp(path, "-") == 0 ? "stdin" : path);
  if (thr_plan_read(plan, path, &err)) return cli_fail(&err);

  /* A plan that does not hold is used nevertheless, with a warning. */
  thr_status st = thr_check_plan(plan, &found);
  cli_step("working", "");
  if (st)
    cli_error(st == THR_EVIOLATED ? "warning: %s does not hold: %s"
                                  : "warning: %s could not be checked: %s",
              path, found.text);

  return EXIT_OK;
}

/* ---- files ---- */

void cli_stem(const char *path, char *out, size_t size)
{
  const char *name = thr_os_name(path), *dot = strrchr(name, '.');
  int n = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (strcmp(path, "-") == 0 || n == 0)
    snprintf(out, size, "frame");
  else
    snprintf(out, size, "%.*s", n, name);
}

const char *cli_thing(const char *path, char name[64])
{
  if (!path || strcmp(path, "-") == 0) return NULL;
  cli_stem(path, name, 64);
  return strcmp(name, "plan") == 0 ? NULL : name;
}

int cli_make_folder(const char *folder)
{
  char part[1024];
  const size_t n = strlen(folder);

  if (n >= sizeof part) {
    cli_error("%.60s..: the path is too long", folder);
    return EXIT_INPUT;
  }

  /* Make every folder on the path, from the outermost one on, as mkdir -p does. */
  for (size_t i = 1; i <= n; i++) {
    if (!thr_os_is_separator(folder[i]) && folder[i] != '\0') continue;
    snprintf(part, sizeof part, "%.*s", (int)i, folder);
    if (thr_os_is_folder(part)) continue;
    if (thr_os_make_folder(part)) {
      files_made(part);
      continue;
    }

    /* Another process may have made the folder in the meantime. */
    const int why = errno;
    if (thr_os_is_folder(part)) continue;
    cli_error("%s: cannot make this folder (%s); say where to write with -o or --draw", part,
              strerror(why));
    return EXIT_INPUT;
  }

  return EXIT_OK;
}

int cli_in_folder(const char *folder, const char *file, char *out, size_t size)
{
  const size_t n = strlen(folder);

  if (n == 0) {
    cli_error("an empty name is no folder");
    return EXIT_USAGE;
  }

  /* A separator and the final NUL take two bytes. */
  if (n + strlen(file) + 2 > size) {
    cli_error("%.60s..: the path is too long", folder);
    return EXIT_INPUT;
  }

  const int code = cli_make_folder(folder);
  if (!code)
    snprintf(out, size, "%s%s%s", folder, thr_os_is_separator(folder[n - 1]) ? "" : "/", file);

  return code;
}

int cli_write(thr_text *text, const char *path)
{
  thr_err err = {0};
  int code = files_may_write(path);
  if (strcmp(path, "-") == 0) cli_progress_end(); /* where both are one terminal */
  if (!code && thr_text_write(text, path, &err)) code = cli_fail(&err);
  thr_text_destroy(text);

  /* What programs read is out, and no failure after it writes there. */
  if (!code && strcmp(path, "-") == 0) {
    answer_given();
    guard_answered();
  }

  return code;
}

int cli_write_kept(thr_text *text, const char **path)
{
  static char beside[300];
  thr_err err = {0}, again = {0};

  /* Try the file that was asked for. */
  int code = files_may_write(*path);
  if (!code && thr_text_write(text, *path, &err)) code = EXIT_INPUT;

  /* Without memory there is nothing to write; otherwise the result goes beside, or to stdout. */
  if (code == EXIT_INPUT && err.code == THR_ENOMEM) {
    code = cli_fail(&err);
  } else if (code) {
    files_name_beside(*path, beside, sizeof beside);
    const bool left = thr_text_write(text, beside, &again) == THR_OK;
    *path = left ? beside : "-";
    cli_error("%s%sit is %s%s instead", err.text, *err.text ? "; " : "", left ? "in " : "on ",
              left ? beside : "stdout");
    if (!left && thr_text_write(text, "-", &again)) cli_fail(&again);
  }

  thr_text_destroy(text);

  return code;
}

int cli_write_drawn(thr_status st, thr_text *text, const char *path, const thr_err *err)
{
  if (st == THR_OK) return cli_write(text, path);
  thr_text_destroy(text);
  return cli_fail(err);
}

/* ---- long computations ---- */

/* Set by the signal handler; the computations look at this flag through thr_limits. */
static volatile sig_atomic_t interrupted;

/* Notes a signal to stop. A second signal, more than 0.3 s after the first, ends the process at
 * once: `timeout` sends its signal to the process and to its group, which counts as one. A further
 * SIGHUP ends nothing. */
static void on_interrupt(int signal)
{
  static double first;
  double now = thr_clock();
  if (interrupted && now - first > 0.3 && signal != THR_OS_HANGUP) _exit(EXIT_SECOND_SIGNAL);
  if (!interrupted) first = now;
  interrupted = 1;
}

void cli_heed_signals(void)
{
  thr_os_heed_stop(on_interrupt);
}

int cli_processes(void)
{
  if (processes > 0) return processes;
  const int processors = thr_os_processors();
  return processors < MOST_PROCESSES ? processors : MOST_PROCESSES;
}

/* Reads the value of --processes. */
static bool take_processes(void *into, const cli_option *option, const char *value)
{
  (void)into, (void)option;
  return cli_int(cli_command_name(), "--processes", value, 1, MOST_PROCESSES, &processes);
}

const cli_option cli_processes_options[] = {
    {"processes", 'j', "N",
     "so many things at a time (default: one per processor); changes no result", .kind = CLI_OTHER,
     .take = take_processes},
    {0}};

thr_limits cli_limits(double seconds)
{
  thr_limits limits = {.interrupted = &interrupted, .threads = cli_processes()};

  /* Signals are noted from here on. */
  cli_heed_signals();

  /* The earlier of two deadlines: the caller's, and that of the child process. */
  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  if (guard_deadline() > 0 && (limits.deadline == 0 || limits.deadline > guard_deadline()))
    limits.deadline = guard_deadline();

  /* What is found on the way: for people, or as JSON for programs. */
  status_listen(&limits);
  if (progress_wanted()) progress_listen(&limits);

  return limits;
}

/* ---- tables ---- */

const char *cli_plural(int n, const char *one, const char *many)
{
  return n == 1 ? one : many;
}

const char *cli_cuts_word(const thr_plan *plan, int n)
{
  bool tube = plan->options.joint == THR_JOINT_TUBE;
  return cli_plural(n, tube ? "odd set or junction" : "odd cut",
                    tube ? "odd sets and junctions" : "odd cuts");
}
