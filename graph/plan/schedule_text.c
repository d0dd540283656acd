/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads and writes schedules as text: what somebody types, and what is printed. A step is "CORD:
 * VERB ..", steps end with a line or a semicolon, # begins a comment (graph/plan/schedule.h has all
 * forms).
 *
 * Example: "all: pull both 20; A: grip 37 18.5 from start". */
#include "graph/io/read_parts.h"
#include "graph/plan/plan.h"

#include <string.h>

/* The state while a step is read. */
typedef struct {
  const thr_plan *plan;
  const thr_scan *scan;
  thr_span rest; /* of the step's words */
  thr_err *err;
} step_reader;

/* Records THR_EINPUT: what was found, and what is expected. */
static thr_status expected(const step_reader *reader, thr_span found, const char *what)
{
  if (found.n == 0)
    return thr_scan_fail(reader->scan, reader->err, "the step ends where %s is expected", what);
  return thr_scan_fail(reader->scan, reader->err, "%.*s: expected %s", thr_span_width(found),
                       found.s, what);
}

/* Reads which end a step is about. */
static thr_status read_end(const step_reader *reader, thr_span word, thr_pull *end)
{
  for (int i = 0; i < THR_PULL_NONE; i++)
    if (thr_span_is(word, thr_pull_name(i))) {
      *end = (thr_pull)i;
      return THR_OK;
    }
  return expected(reader, word, "start, end or both");
}

/* Reads a force or a length, at most 1e12. */
static thr_status read_amount(const step_reader *reader, thr_span word, const char *what,
                              double *out)
{
  const double most = 1e12;
  return thr_span_number(word, false, out) && *out >= 0 && *out <= most
             ? THR_OK
             : expected(reader, word, what);
}

/* Returns the node with this name, or -1. */
static int node_of(const thr_frame *frame, thr_span word)
{
  char name[256];

  /* Longer names are not looked for. */
  if (word.n >= sizeof name) return -1;
  memcpy(name, word.s, word.n);
  name[word.n] = '\0';

  return thr_frame_find(frame, name);
}

/* Finds the pass of the cord along the edge between two nodes; THR_EINPUT unless there is exactly
 * one. */
static thr_status pass_between(const step_reader *reader, const thr_cord *cord, thr_span from,
                               thr_span to, int *pass)
{
  const thr_frame *frame = &reader->plan->frame;
  const int a = node_of(frame, from), b = node_of(frame, to),
            edge = a >= 0 && b >= 0 ? thr_frame_edge_between(frame, a, b) : -1;
  int times = 0;

  /* Both must be names of nodes. */
  if (a < 0) return expected(reader, from, "the number of a pass, or the names of two nodes");
  if (b < 0) return expected(reader, to, "the name of a second node");

  /* Count the passes over the edge, and keep the first one. */
  for (int k = 0; k < cord->n_passes; k++)
    if (cord->half[k] >> 1 == edge && times++ == 0) *pass = k;

  if (times == 1) return THR_OK;
  return thr_scan_fail(
      reader->scan, reader->err,
      "cord %s runs %s between %.*s and %.*s; give the number of the pass in steps.txt", cord->id,
      times ? "more than once" : "nowhere", thr_span_width(from), from.s, thr_span_width(to), to.s);
}

/* Reads a pass, by its number from 1 or by the nodes on both sides. */
static thr_status read_pass(step_reader *reader, const thr_cord *cord, int *pass)
{
  thr_span word = thr_span_word(&reader->rest);

  /* A word that is no number begins an edge's name. */
  if (!thr_span_int(word, pass))
    return pass_between(reader, cord, word, thr_span_word(&reader->rest), pass);
  if (*pass < 1 || *pass > cord->n_passes)
    return thr_scan_fail(reader->scan, reader->err, "pass %.*s: cord %s has passes 1 to %d",
                         thr_span_width(word), word.s, cord->id, cord->n_passes);

  /* Passes are counted from 1 by people, from 0 here. */
  --*pass;
  return THR_OK;
}

/* Reads "grip PASS FORCE [from END]", whose verb has been read. */
static thr_status read_grip(step_reader *reader, const thr_cord *cord, thr_schedule_step *step)
{
  thr_status st = read_pass(reader, cord, &step->pass);

  if (!st)
    st = read_amount(reader, thr_span_word(&reader->rest), "a force in newton", &step->force);

  /* From both sides unless one is said. */
  step->end = THR_PULL_BOTH;
  thr_span from = thr_span_word(&reader->rest);
  if (st || from.n == 0) return st;
  if (!thr_span_is(from, "from")) return expected(reader, from, "from start, from end, or nothing");

  return read_end(reader, thr_span_word(&reader->rest), &step->end);
}

/* Reads what follows the verb, for one cord. */
static thr_status read_deed(step_reader *reader, const thr_cord *cord, thr_schedule_step *step)
{
  /* A grip is at a pass, not at an end. */
  if (step->deed == THR_DEED_GRIP) return read_grip(reader, cord, step);
  step->end = THR_PULL_BOTH;
  if (step->deed == THR_DEED_NONE) return THR_OK;
  thr_status st = read_end(reader, thr_span_word(&reader->rest), &step->end);
  if (st) return st;

  /* Pulling and releasing have a force, a knot may have a slip. */
  if (step->deed != THR_DEED_KNOT)
    return read_amount(reader, thr_span_word(&reader->rest), "a force in newton", &step->force);

  thr_span slip = thr_span_word(&reader->rest);
  return slip.n ? read_amount(reader, slip, "the slip of the knot in mm", &step->slip) : THR_OK;
}

/* Reads the rest of a step for one cord, and appends the step. */
static thr_status read_for_cord(step_reader *reader, int cord, int deed, thr_schedule *schedule)
{
  thr_schedule_step step = {.cord = cord, .deed = (thr_deed)deed};
  thr_status st = read_deed(reader, &reader->plan->cord[cord], &step);
  thr_span more = thr_span_word(&reader->rest);
  if (!st && more.n) st = expected(reader, more, "nothing more in this step");
  return st ? st : thr_schedule_add(schedule, &step, reader->err);
}

/* Reads "CORD: VERB ..", for one cord or for all. */
static thr_status read_step(step_reader *reader, thr_span text, thr_schedule *schedule)
{
  const char *colon = memchr(text.s, ':', text.n);

  if (!colon)
    return expected(reader, text,
                    "a cord, a colon and what is done to it, as in \"A: pull both 20\"");

  /* Who, and what is done. */
  thr_span who = thr_span_trim((thr_span){text.s, (size_t)(colon - text.s)});
  thr_span words = {colon + 1, (size_t)(text.s + text.n - colon - 1)}, verb = thr_span_word(&words);
  int deed = 0, found = 0;

  while (deed < THR_N_DEEDS && !thr_span_is(verb, thr_deed_name(deed)))
    deed++;

  if (deed == THR_N_DEEDS) return expected(reader, verb, "pull, grip, release, knot or none");

  /* The same words are read for each cord that is meant. */
  thr_status st = THR_OK;
  for (int i = 0; i < reader->plan->n_cords && !st; i++) {
    if (!thr_span_is(who, "all") && !thr_span_is(who, reader->plan->cord[i].id)) continue;
    found++;
    reader->rest = words;
    st = read_for_cord(reader, i, deed, schedule);
    if (!st) schedule->step[schedule->n - 1].together = found > 1;
  }
  if (st || found) return st;

  return thr_scan_fail(
      reader->scan, reader->err, "%.*s: the plan has no such cord; its cords are A to %s",
      thr_span_width(who), who.s, reader->plan->cord[reader->plan->n_cords - 1].id);
}

/* Reads the steps of a line, between semicolons. */
static thr_status read_line(step_reader *reader, thr_span line, thr_schedule *schedule)
{
  thr_status st = THR_OK;

  /* A comment ends the line. */
  const char *comment = memchr(line.s, '#', line.n);
  if (comment) line.n = (size_t)(comment - line.s);

  /* Step by step, between semicolons; empty ones do not matter. */
  while (line.n && !st) {
    const char *end = memchr(line.s, ';', line.n);
    const size_t n = end ? (size_t)(end - line.s) : line.n;
    const thr_span step = thr_span_trim((thr_span){line.s, n});
    if (step.n) st = read_step(reader, step, schedule);
    line.s += n + (end != NULL);
    line.n -= n + (end != NULL);
  }

  return st;
}

/* Reads a text line by line. */
thr_status thr_schedule_parse(thr_schedule *schedule, const thr_plan *plan, const char *text,
                              size_t n, const char *name, thr_err *err)
{
  thr_scan scan;
  thr_span line;
  step_reader reader = {.plan = plan, .scan = &scan, .err = err};
  *schedule = (thr_schedule){0};
  thr_status st = thr_scan_start(&scan, text, n, name, err);

  /* Line after line. */
  while (!st && thr_scan_line(&scan, &line))
    st = read_line(&reader, line, schedule);

  /* A cord that stays slack on purpose has no other step. */
  for (int i = 0; i < plan->n_cords && !st; i++)
    if (thr_schedule_slack(schedule, i) && thr_schedule_steps(schedule, i) > 1)
      st = thr_fail(err, THR_EINPUT, "%s: cord %s: none is a cord's only step: it stays slack",
                    name, plan->cord[i].id);

  if (!st && schedule->n == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no step in it; expected for instance \"A: pull both 20\"",
                  name);

  return st;
}

/* ---- in words ---- */

/* Writes a step so that thr_schedule_parse reads it, but for the nodes in brackets. */
void thr_schedule_put_step(const thr_plan *plan, const thr_schedule_step *step, thr_text *text)
{
  const thr_cord *cord = &plan->cord[step->cord];
  const thr_frame *frame = &plan->frame;

  thr_text_printf(text, "%s: %s", cord->id, thr_deed_name(step->deed));
  if (step->deed == THR_DEED_NONE) return;
  thr_text_append(text, " ");

  /* A grip, with the nodes on both sides, so that people find the pass. */
  if (step->deed == THR_DEED_GRIP) {
    thr_text_printf(text, "%d %.4g", step->pass + 1, step->force);
    if (step->end != THR_PULL_BOTH) thr_text_printf(text, " from %s", thr_pull_name(step->end));
    thr_text_append(text, " (between ");
    thr_text_append_clean(text, frame->name[thr_tail(frame, cord->half[step->pass])]);
    thr_text_append(text, " and ");
    thr_text_append_clean(text, frame->name[thr_head(frame, cord->half[step->pass])]);
    thr_text_append(text, ")");
    return;
  }

  /* All other steps: an end, and a force or a slip. */
  thr_text_append(text, thr_pull_name(step->end));
  if (step->deed != THR_DEED_KNOT)
    thr_text_printf(text, " %.4g", step->force);
  else if (step->slip > 0)
    thr_text_printf(text, " %.4g", step->slip);
}
