/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --progress: how far a search is, for a program that reads it: one JSON object on a line of stderr
 * each time the plan or its bound is better.
 *
 *   {"what":"plan","length":1995.2,"turning":53.5,"cords":1,"seconds":0.31}   a whole plan was
 * found
 *   {"what":"turning","best":53.5,"bound":51.2,"gap":4.3,"seconds":0.52}      what is minimized,
 * and what nothing is below; gap:
 * %
 *   {"what":"joints","done":0.25,"seconds":2.1}                               work whose amount is
 * known
 *
 * best and bound are prices of turns (rad, or as --turn-cost has it) where what is turning, else
 * weights of extra cord; length is in the framework's units, turning in rad, seconds since the
 * search began. */
#include "cli/cli.h"

#include "graph/io/writer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double OFTEN = 0.05; /* s between two lines about bounds or parts */

static struct {
  bool wanted;
  double began, told; /* thr_clock() */
  char what[64];      /* of the last line */
  double best, bound, done;
} last;

void progress_begin(void)
{
  last.wanted = true;
  last.began = thr_clock();
}

bool progress_wanted(void)
{
  return last.wanted;
}

/* Begins a line; the caller writes its members. */
static thr_writer open_line(thr_text *text, const char *what)
{
  thr_writer writer = {.out = text, .compact = true};
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "what", what);
  return writer;
}

static void end_line(thr_writer *writer)
{
  thr_write_printf(writer, "seconds", "%.3f", thr_clock() - last.began);
  thr_write_close(writer);
  thr_text_append(writer->out, "\n");
  if (!writer->out->failed) fputs(writer->out->data, stderr);
  fflush(stderr);
  thr_text_destroy(writer->out);
}

/* Is it something else than in the last line? */
static bool is_other(const char *what)
{
  if (strncmp(last.what, what, sizeof last.what - 1) == 0) return false;
  snprintf(last.what, sizeof last.what, "%s", what);
  last.best = INFINITY;
  last.bound = -INFINITY;
  last.done = 0;
  return true;
}

/* Time for a line? */
static bool is_time(bool other)
{
  const double now = thr_clock();
  if (!other && now - last.told < OFTEN) return false;
  last.told = now;
  return true;
}

static void tell_bound(void *user, const char *what, double best, double bound)
{
  const bool other = is_other(what);
  thr_text text = {0};
  (void)user;
  bound = fmax(bound, 0); /* no price and no weight is below 0 */
  if ((best >= last.best && bound <= last.bound) || !is_time(other)) return;
  last.best = fmin(best, last.best);
  last.bound = fmax(bound, last.bound);
  thr_writer writer = open_line(&text, what);
  thr_write_number(&writer, "best", last.best);
  thr_write_number(&writer, "bound", last.bound);
  thr_write_printf(&writer, "gap", "%.3g",
                   last.best > 0 ? 100 * fmax(0, last.best - last.bound) / last.best : 0.);
  end_line(&writer);
}

static void tell_part(void *user, const char *what, double done)
{
  const bool other = is_other(what);
  thr_text text = {0};
  (void)user;
  if (!other && done < last.done) last.done = 0; /* the same kind of work once more */
  if ((!other && done <= last.done) || !is_time(other)) return;
  last.done = done;
  thr_writer writer = open_line(&text, what);
  thr_write_printf(&writer, "done", "%.3f", done);
  end_line(&writer);
}

void progress_listen(thr_limits *limits)
{
  limits->progress = tell_bound;
  limits->advance = tell_part;
}

void progress_plan(const thr_plan *plan)
{
  thr_text text = {0};
  thr_writer writer = open_line(&text, "plan");
  thr_write_number(&writer, "length", plan->metrics.length);
  thr_write_number(&writer, "turning", plan->metrics.turning);
  thr_write_int(&writer, "cords", plan->n_cords);
  end_line(&writer);
}
