/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements what the commands share: messages, values of options, reading of frameworks and plans,
 * writing of results, and the progress line of long computations. cli/ is the only folder that
 * prints or exits.
 *
 * Every message is one line on stderr that begins with "thread: ". A function that fails prints why
 * and returns the exit code, so that a command only passes the code on. */
#define _POSIX_C_SOURCE 200809L
#include "cli/cli.h"
#include "cli/args/args.h"
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/os.h"
#include "graph/plan/plan_measures.h"
#include "graph/text.h"
#include "lib/lib.h"

#include <errno.h>
#include <math.h>
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

/* Prints a message and a text after it as one line, whatever line breaks the names in it hold, and
 * takes it down if it is an error. Allocates nothing, and so also works when memory runs out. */
static void say(const char *format, va_list args, const char *after, bool error)
{
  char line[8192];
  vsnprintf(line, sizeof line, format, args);
  thr_text_clean(line);
  shorten_words(line);
  fprintf(stderr, "thread: %s%s\n", line, after);
  if (error) answer_error_is(line);
}

/* Whether the progress line stands on the terminal. */
static bool progress_shown;

void cli_progress_wipe(void)
{
  if (progress_shown) fputs("\r\033[K", stderr);
  progress_shown = false;
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

bool cli_double(const char *command, const char *option, const char *text, double low, double high,
                double *out)
{
  char *end;
  errno = 0;

  /* Text behind the number, NaN and infinities are refused as well. */
  double number = strtod(text, &end);
  if (end != text && *end == '\0' && isfinite(number) && number >= low && number <= high) {
    *out = number;
    return true;
  }

  cli_usage(command, "%s %s: expected a number from %g to %g", option, text, low, high);

  return false;
}

bool cli_hand(const char *command, const char *text, double *newtons)
{
  const double one = thr_hand_most, two = 2 * thr_hand_most, least = 1e-6, most = 1e9; /* N */
  const bool is_one = strcmp(text, "one") == 0;
  char *end;

  /* What one hand, or two, pull again and again. */
  if (is_one || strcmp(text, "two") == 0) {
    *newtons = is_one ? one : two;
    return true;
  }

  /* Any other text is a force in newtons. */
  const double force = strtod(text, &end);
  if (end == text || !(force > 0)) {
    cli_usage(command, "--hand %s: expected one, two or a force in newtons", text);
    return false;
  }

  return cli_double(command, "--hand", text, least, most, newtons);
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
  thr_status st = thr_frame_read(frame, report, path, &args->read, pair, sizeof pair, &err);
  if (pair[0])
    cli_note("note: read together with %s", pair); /* before an error that may name that file */
  if (st) return cli_fail(&err);

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

  /* --feet replaces the feet of the file: the lowest nodes, or those named. */
  if (args->feet && strcmp(args->feet, "lowest") == 0) {
    thr_frame_feet_lowest(frame);
  } else if (args->feet) {
    memset(frame->foot, 0, (size_t)frame->n_nodes * sizeof *frame->foot);
    if (!cli_mark_nodes(frame, args->feet, "--feet", frame->foot)) {
      thr_frame_destroy(frame);
      return EXIT_INPUT;
    }
  }

  return EXIT_OK;
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
  if (thr_plan_read(plan, path, &err)) return cli_fail(&err);

  /* A plan that does not hold is used nevertheless, with a warning. */
  thr_status st = thr_check_plan(plan, &found);
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

/* The progress line on the terminal: its text, when it was written last, and since when the user
 * has waited, by thr_clock(). began is 0 while nobody waits. */
static struct {
  char says[144];
  double written, began;
} waiting;

/* Writes the progress line once more, with the seconds passed so far, if nothing was written for
 * some time. Runs as a handler of a timer's signal, and so only calls what POSIX allows in handlers
 * (no printf); errno is kept. */
static void keep_alive(int signal)
{
  const double patience = 0.9; /* s */
  const double now = thr_clock();
  const int seconds = (int)(now - waiting.began), error = errno;
  char digits[12], line[192];
  int n = 0, length = 0;
  (void)signal;

  /* Nothing to do while the line is fresh. */
  if (waiting.began == 0 || now - waiting.written < patience) return;
  waiting.written = now;
  progress_shown = true;

  /* Compose the line: erase, the text, then the seconds digit by digit. */
  for (const char *from = "\r\033[K"; *from; from++)
    line[length++] = *from;
  for (const char *from = waiting.says; *from; from++)
    line[length++] = *from;
  line[length++] = ',';
  line[length++] = ' ';

  for (int left = seconds; n == 0 || left > 0; left /= 10)
    digits[n++] = (char)('0' + left % 10);
  while (n > 0)
    line[length++] = digits[--n];
  line[length++] = ' ';
  line[length++] = 's';

  /* A terminal that is gone needs no more lines. */
  if (write(STDERR_FILENO, line, (size_t)length) < 0) waiting.began = 0;
  errno = error;
}

/* Starts the timer that keeps the progress line alive, unless it runs already. */
static void begin_waiting(void)
{
  if (waiting.began > 0) return;
  snprintf(waiting.says, sizeof waiting.says, "thread: working");
  waiting.written = waiting.began = thr_clock();
  thr_os_tick(1, keep_alive);
}

/* Stops the timer. */
static void end_waiting(void)
{
  if (waiting.began > 0) thr_os_tick(0, NULL);
  waiting.began = 0;
}

/* Writes the progress line in place of the last one. */
static void put_line(void)
{
  waiting.written = thr_clock();
  fprintf(stderr, "\r\033[K%s", waiting.says);
  fflush(stderr);
}

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

/* What the progress line of one computation knows: when it was shown last, which step of the work
 * runs and since when, and which part of the step is done. */
typedef struct {
  double shown, began;
  char what[48];
  double done;
} progress_watch;

/* Returns whether the line may be written again: at most ten times a second. */
static bool is_time_to_show(progress_watch *watch)
{
  double now = thr_clock();
  if (now - watch->shown < 0.1) return false;
  watch->shown = now;
  progress_shown = true;
  return true;
}

/* Returns whether `what` is the search for the least turning, which reports prices of turns; all
 * other searches report the weight of extra cord. */
static bool is_turning(const char *what)
{
  return strcmp(what, "turning") == 0;
}

/* Returns the relative gap between incumbent and lower bound, per cent. Prices and weights are
 * never negative, and so 0 is a lower bound from the start. */
static double progress_gap(double best, double bound)
{
  return best > 0 ? 100 * (best - fmax(bound, 0)) / best : 0;
}

/* Shows how close the incumbent of a search is to its lower bound (thr_limits.progress). */
static void show_progress(void *user, const char *what, double best, double bound)
{
  if (!is_time_to_show(user)) return;

  snprintf(waiting.says, sizeof waiting.says, "thread: %.40s%s within %.3g %% of the least", what,
           is_turning(what) ? "" : ": extra cord", progress_gap(best, bound));
  put_line();
}

/* Shows a bar for the part of a step that is done, and the time left (thr_limits.advance). The
 * estimate is linear: the rest takes as long for its part as what is done. */
static void show_advance(void *user, const char *what, double done)
{
  enum { WIDE = 24 };
  progress_watch *watch = user;
  double now = thr_clock();

  /* A new step, or the same step once more, restarts the clock. */
  if (strncmp(watch->what, what, sizeof watch->what - 1) != 0 || done < watch->done) {
    snprintf(watch->what, sizeof watch->what, "%s", what);
    watch->began = now;
  }
  watch->done = done;

  if (!is_time_to_show(watch)) return;

  /* The bar. */
  char bar[WIDE + 1], left[48] = "";
  for (int i = 0; i < WIDE; i++)
    bar[i] = i < (int)(WIDE * done) ? '#' : '.';
  bar[WIDE] = '\0';

  /* The time left, once the estimate is not mere noise. */
  double seconds = done > 0 ? (now - watch->began) * (1 - done) / done : 0;
  if (done > 0.02 && now - watch->began > 1) {
    if (seconds < 90)
      snprintf(left, sizeof left, ", %.0f s left", ceil(seconds));
    else
      snprintf(left, sizeof left, ", %.0f min left", ceil(seconds / 60));
  }

  snprintf(waiting.says, sizeof waiting.says, "thread: %.40s [%s] %d %%%s", what, bar,
           (int)(100 * done), left);
  put_line();
}

/* Prints a line for every new incumbent or bound, with --verbose. */
static void log_progress(void *user, const char *what, double best, double bound)
{
  (void)user;
  if (is_turning(what)) /* in rad, or as --turn-cost prices them */
    cli_note("turning: price of all turns %.9g, at least %.9g, gap %.3g %%, %.3f CPU s", best,
             fmax(bound, 0), progress_gap(best, bound), thr_os_processor_seconds());
  else
    cli_note("%s: best join %.0f, bound %.1f (integer weights), %.3f CPU s", what, best, bound,
             thr_os_processor_seconds());
}

bool cli_is_terminal(int file)
{
  const char *term = getenv("TERM");
  return isatty(file) && term && *term && strcmp(term, "dumb") != 0;
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
  static progress_watch seen;
  thr_limits limits = {.interrupted = &interrupted, .user = &seen, .threads = cli_processes()};

  /* Start afresh, with signals noted from here on. */
  seen = (progress_watch){0};
  cli_heed_signals();

  /* The earlier of two deadlines: the caller's, and that of the child process. */
  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  if (guard_deadline() > 0 && (limits.deadline == 0 || limits.deadline > guard_deadline()))
    limits.deadline = guard_deadline();

  /* Verbose lines take the place of the progress line. A terminal also shows a bar. */
  if (cli_verbose)
    limits.progress = log_progress;
  else if (!cli_quiet && cli_is_terminal(STDERR_FILENO))
    limits.progress = show_progress;
  if (!cli_quiet && cli_is_terminal(STDERR_FILENO)) {
    limits.advance = show_advance;
    if (!progress_wanted()) begin_waiting();
  }

  /* --progress writes JSON for programs. */
  if (progress_wanted()) progress_listen(&limits);

  return limits;
}

void cli_wipe_line(void)
{
  if (cli_is_terminal(STDERR_FILENO)) fputs("\r\033[K", stderr);
}

void cli_progress_end(void)
{
  end_waiting();
  cli_progress_wipe();
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
