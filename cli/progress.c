/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tells a program how far a search is (--progress): one JSON object on a line of stderr each time
 * the plan or its bound is better.
 *
 *    {"what":"plan","length":1995.2,"turning":53.5,"cords":1,"seconds":0.31}
 *        a whole plan was found
 *    {"what":"turning","best":53.5,"bound":51.2,"gap":4.3,"seconds":0.52}
 *        what is minimized, its lower bound, and the gap between them in per cent of the best
 *    {"what":"joints","done":0.25,"seconds":2.1}
 *        work whose amount is known, and the part that is done
 *
 * best and bound are prices of turns (rad, or as --turn-cost has it) where what is turning, else
 * extra cord; lengths are in the framework's units, turning in rad, seconds since the
 * search began. */
#include "cli/cli.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* s between two lines about bounds or parts. */
static const double OFTEN = 0.05;

/* What the last lines said, so that a line is only written for progress. */
static struct {
  bool wanted;
  double began, told; /* thr_clock() */
  char what[64];      /* of the last line */
  double best, bound, done;
} last_line;

void progress_begin(void)
{
  last_line.wanted = true;
  last_line.began = thr_clock();
}

bool progress_wanted(void)
{
  return last_line.wanted;
}

thr_writer progress_open(thr_text *text, const char *what)
{
  thr_writer writer = {.out = text, .compact = true};
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "what", what);
  return writer;
}

void progress_close(thr_writer *writer)
{
  thr_write_printf(writer, "seconds", "%.3f", thr_clock() - last_line.began);
  thr_write_close(writer);
  thr_text_append(writer->out, "\n");

  /* Whoever reads needs every line at once. */
  if (!writer->out->failed) fputs(writer->out->data, stderr);
  fflush(stderr);
  thr_text_destroy(writer->out);
}

/* Returns whether something else is told of than in the last line, and then forgets what that
 * was. */
static bool is_new_subject(const char *what)
{
  if (strncmp(last_line.what, what, sizeof last_line.what - 1) == 0) return false;

  /* Nothing is known of the new subject, so that its first line is one of progress. */
  snprintf(last_line.what, sizeof last_line.what, "%s", what);
  last_line.best = INFINITY;
  last_line.bound = -INFINITY;
  last_line.done = 0;

  return true;
}

/* Returns whether it is time for a line: at once for something else, else so many seconds after the
 * last one. */
static bool is_due(bool other)
{
  const double now = thr_clock();
  if (!other && now - last_line.told < OFTEN) return false;
  last_line.told = now;
  return true;
}

/* Tells the best value and the proved bound if one of them is better. Signature of
 * thr_limits.progress. */
static void tell_bound(void *user, const char *what, double best, double bound)
{
  const bool other = is_new_subject(what);
  thr_text text = {0};
  (void)user;
  best_look();

  /* No price and no weight is below 0; several searches may tell of the same, so that only progress
   * counts. */
  bound = fmax(bound, 0);
  if ((best >= last_line.best && bound <= last_line.bound) || !is_due(other)) return;

  /* The line tells the best of all searches so far. */
  last_line.best = fmin(best, last_line.best);
  last_line.bound = fmax(bound, last_line.bound);

  /* The gap in per cent of the best value. */
  thr_writer writer = progress_open(&text, what);
  thr_write_number(&writer, "best", last_line.best);
  thr_write_number(&writer, "bound", last_line.bound);
  thr_write_printf(
      &writer, "gap", "%.3g",
      last_line.best > 0 ? 100 * fmax(0, last_line.best - last_line.bound) / last_line.best : 0.);
  progress_close(&writer);
}

/* Tells which part of the work is done if that is more. Signature of thr_limits.advance. */
static void tell_part(void *user, const char *what, double done)
{
  const bool other = is_new_subject(what);
  thr_text text = {0};
  (void)user;
  best_look();

  /* Less than before: the same kind of work began once more. */
  if (!other && done < last_line.done) last_line.done = 0;
  if ((!other && done <= last_line.done) || !is_due(other)) return;
  last_line.done = done;

  thr_writer writer = progress_open(&text, what);
  thr_write_printf(&writer, "done", "%.3f", done);
  progress_close(&writer);
}

void progress_listen(thr_limits *limits)
{
  limits->progress = tell_bound;
  limits->advance = tell_part;
}

void progress_plan(const thr_plan *plan)
{
  thr_text text = {0};
  thr_writer writer = progress_open(&text, "plan");
  thr_write_number(&writer, "length", plan->metrics.length);
  thr_write_number(&writer, "turning", plan->metrics.turning);
  thr_write_int(&writer, "cords", plan->n_cords);
  progress_close(&writer);
}
