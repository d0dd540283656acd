/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shows on a terminal what a command is doing, in one line of stderr that is written over and over:
 *
 *    thread: reading dome.json, 2 s
 *    thread: 4 cords, turning 683 deg, at least 649, 9 s
 *    thread: pages of the step sheets [######..................] 27 %, 8 s left
 *
 * Commands say the step (cli_step), searches the best value and its bound, and work whose amount is
 * known which part is done (graph/limits.h). A timer writes the line again every second, so that
 * nobody waits two seconds before a screen on which nothing moves. Where no terminal is there is no
 * line, nor with --quiet; with --progress there are lines for programs (progress.c); with --verbose
 * searches write lines of their own.
 *
 * The words of all steps that searches name stand in the table below. */
#define _POSIX_C_SOURCE 200809L
#include "cli/cli.h"
#include "graph/number.h"
#include "graph/os.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What searches call their steps, in words for the first screen. */
static const struct {
  const char *what, *says;
} steps[] = {
    {"extra cord", "the shortest cords"},
    {"turning", "cords that turn little"},
    {"threading under each group", "paths and their copies"},
    {"GLPK's exact method", "confirming the length"},
    {"the rank of a matrix", "what can move"},
    {"automorphisms", "symmetries"},
    {"placing nodes for the picture", "the picture"},
    {"pieces", "making pieces"},
    {"dragging a cord", "dragging a cord through a joint"},
};

static const char *words_of(const char *what)
{
  for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
    if (strcmp(what, steps[i].what) == 0) return steps[i].says;
  return what;
}

/* ---- the line ---- */

/* The line: its text, when it was written last, and since when the user has waited, by thr_clock().
 * began is 0 while nobody waits. */
static struct {
  char says[192];
  double written, began;
} waiting;

/* Whether the line stands on the terminal. */
static bool shown;

/* What the search has found so far: "4 cords"; "": nothing yet. */
static char found[32];

bool cli_is_terminal(int file)
{
  const char *term = getenv("TERM");
  return isatty(file) && term && *term && strcmp(term, "dumb") != 0;
}

bool cli_is_coloured(int file)
{
  const char *none = getenv("NO_COLOR");
  return cli_is_terminal(file) && !(none && *none);
}

/* Returns whether there is a line. */
static bool is_wanted(void)
{
  return !cli_quiet && !progress_wanted() && cli_is_terminal(STDERR_FILENO);
}

/* Writes the line once more, with the seconds passed so far, if nothing was written for some time.
 * Runs as a handler of a timer's signal, and so only calls what POSIX allows in handlers (no
 * printf); errno is kept. */
static void keep_alive(int signal)
{
  const double patience = 0.9; /* s */
  const double now = thr_clock();
  const int seconds = (int)(now - waiting.began), error = errno;
  char digits[12], line[256];
  int n = 0, length = 0;
  (void)signal;

  /* Nothing to do while the line is fresh. */
  if (waiting.began == 0 || now - waiting.written < patience) return;
  waiting.written = now;
  shown = true;

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
  if (write(STDERR_FILENO, line, (unsigned)length) < 0) waiting.began = 0;
  errno = error;
}

/* Changes the text of the line, cut to what fits beside the seconds, so that it never fills two
 * lines, of which only one could be written over. */
static void set_line(const char *format, ...)
{
  enum { SECONDS = 10, USUAL = 80 };
  char text[sizeof waiting.says];
  va_list args;
  const int columns = thr_os_columns(STDERR_FILENO);
  const size_t room = (size_t)((columns > 2 * SECONDS ? columns : USUAL) - SECONDS);

  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);

  /* No part of a letter of several bytes. */
  thr_text_clean(text);
  size_t n = strlen(text);
  if (n > room) n = room;
  while (n > 0 && thr_text_is_inside(text[n]))
    n--;
  text[n] = '\0';
  memcpy(waiting.says, text, n + 1);
}

/* Starts the timer that keeps the line alive, unless it runs already. */
static void begin_waiting(void)
{
  if (waiting.began > 0) return;
  waiting.written = waiting.began = thr_clock();
  thr_os_tick(1, keep_alive);
}

void cli_step(const char *what, const char *of)
{
  if (!is_wanted()) return;
  set_line("thread: %s%s%s", what, *of ? " " : "", of);
  begin_waiting();
}

void cli_status_found(int n_cords)
{
  snprintf(found, sizeof found, "%d %s", n_cords, cli_plural(n_cords, "cord", "cords"));
}

void cli_progress_wipe(void)
{
  if (shown) fputs("\r\033[K", stderr);
  shown = false;
}

void cli_wipe_line(void)
{
  if (cli_is_terminal(STDERR_FILENO)) fputs("\r\033[K", stderr);
}

void cli_progress_end(void)
{
  if (waiting.began > 0) thr_os_tick(0, NULL);
  waiting.began = 0;
  cli_progress_wipe();
}

/* Writes the line in place of the last one. */
static void put_line(void)
{
  waiting.written = thr_clock();
  fprintf(stderr, "\r\033[K%s", waiting.says);
  fflush(stderr);
}

/* ---- what searches tell ---- */

/* What is known of one computation: when the line was written last, which step of the work runs and
 * since when, and which part of the step is done. */
typedef struct {
  double shown, began;
  char what[48];
  double done;
} status_watch;

/* Returns whether the line may be written again: at most ten times a second. */
static bool is_time_to_show(status_watch *watch)
{
  double now = thr_clock();
  if (now - watch->shown < 0.1) return false;
  watch->shown = now;
  shown = true;
  return true;
}

/* Returns whether `what` is the search for the least turning, which reports prices of turns; all
 * other searches report extra cord, in units. */
static bool is_turning(const char *what)
{
  return strcmp(what, "turning") == 0;
}

/* Returns the relative gap between incumbent and lower bound, per cent. Prices and weights are
 * never negative, and so 0 is a lower bound from the start. */
static double gap_of(double best, double bound)
{
  return best > 0 ? 100 * (best - fmax(bound, 0)) / best : 0;
}

/* Shows how near the best cords are to the least that is possible (thr_limits.progress). A gap is
 * said where it says something: not while hardly anything is proved, nor when it is closed. */
static void show_progress(void *user, const char *what, double best, double bound)
{
  const double much = 50, nothing = 0.01; /* % */
  const double gap = gap_of(best, bound);
  const char *comma = *found ? ", " : "";

  if (!is_time_to_show(user)) return;

  if (gap < nothing)
    set_line("thread: %s%s%s, proved", found, comma, words_of(what));
  else if (is_turning(what) && gap <= much)
    set_line("thread: %s%sturning %.0f deg, at least %.0f", found, comma, thr_degrees(best),
             floor(thr_degrees(bound)));
  else if (gap <= much)
    set_line("thread: %s%s%s, extra cord %.2g %% above the least at most", found, comma,
             words_of(what), gap);
  else
    set_line("thread: %s%s%s", found, comma, words_of(what));
  put_line();
}

/* Shows a bar for the part of a step that is done, and the time left (thr_limits.advance). The
 * estimate is linear: the rest takes as long for its part as what is done. */
static void show_advance(void *user, const char *what, double done)
{
  enum { WIDE = 24, NARROW = 10, ROOMY = 100 };
  status_watch *watch = user;
  const double now = thr_clock();
  const int wide = thr_os_columns(STDERR_FILENO) < ROOMY ? NARROW : WIDE;

  /* A new step, or the same step once more, restarts the clock. */
  if (strncmp(watch->what, what, sizeof watch->what - 1) != 0 || done < watch->done) {
    snprintf(watch->what, sizeof watch->what, "%s", what);
    watch->began = now;
  }
  watch->done = done;

  if (!is_time_to_show(watch)) return;

  /* The bar. */
  char bar[WIDE + 1], left[48] = "";
  for (int i = 0; i < wide; i++)
    bar[i] = i < (int)(wide * done) ? '#' : '.';
  bar[wide] = '\0';

  /* The time left, once the estimate is not mere noise. */
  double seconds = done > 0 ? (now - watch->began) * (1 - done) / done : 0;
  if (done > 0.02 && now - watch->began > 1) {
    if (seconds < 90)
      snprintf(left, sizeof left, ", %.0f s left", ceil(seconds));
    else
      snprintf(left, sizeof left, ", %.0f min left", ceil(seconds / 60));
  }

  set_line("thread: %.40s [%s] %d %%%s", words_of(what), bar, (int)(100 * done), left);
  put_line();
}

/* Prints a line for every new incumbent or bound, with --verbose. */
static void log_progress(void *user, const char *what, double best, double bound)
{
  (void)user;
  if (is_turning(what)) /* in rad, or as --turn-cost prices them */
    cli_note("turning: price of all turns %.9g, at least %.9g, gap %.2f %%, %.3f CPU s", best,
             fmax(bound, 0), gap_of(best, bound), thr_os_processor_seconds());
  else
    cli_note("%s: %.9g, at least %.9g, %.3f CPU s", what, best, bound, thr_os_processor_seconds());
}

void status_listen(thr_limits *limits)
{
  static status_watch seen;

  seen = (status_watch){0};
  limits->user = &seen;

  /* Verbose lines take the place of what searches find. */
  if (cli_verbose)
    limits->progress = log_progress;
  else if (is_wanted())
    limits->progress = show_progress;
  if (!cli_quiet && cli_is_terminal(STDERR_FILENO)) limits->advance = show_advance;
  if (waiting.began == 0) cli_step("working", "");
}
