/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of a schedule, and their member of plan.json. */
#include "graph/plan/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const deed_name[THR_N_DEEDS] = {"pull", "grip", "release", "knot", "none"};

const char *thr_deed_name(int deed)
{
  return deed_name[deed];
}

thr_status thr_schedule_add(thr_schedule *schedule, const thr_schedule_step *step, thr_err *err)
{
  thr_status st =
      thr_grow(&schedule->step, schedule->n, &schedule->room, sizeof *schedule->step, err);
  if (!st) schedule->step[schedule->n++] = *step;
  return st;
}

void thr_schedule_destroy(thr_schedule *schedule)
{
  free(schedule->step);
  *schedule = (thr_schedule){0};
}

double thr_schedule_hardest(const thr_schedule *schedule, int i)
{
  double hardest = 0;

  for (int k = 0; k < schedule->n; k++) {
    const thr_schedule_step *step = &schedule->step[k];

    /* Only these draw a cord. */
    const bool pulls = step->deed == THR_DEED_PULL || step->deed == THR_DEED_GRIP;
    if (pulls && (i < 0 || step->cord == i)) hardest = fmax(hardest, step->force);
  }

  return hardest;
}

int thr_schedule_steps(const thr_schedule *schedule, int i)
{
  int n = 0;
  for (int k = 0; k < schedule->n; k++)
    n += schedule->step[k].cord == i;
  return n;
}

bool thr_schedule_slack(const thr_schedule *schedule, int i)
{
  bool slack = false;
  for (int k = 0; k < schedule->n; k++)
    slack |= schedule->step[k].cord == i && schedule->step[k].deed == THR_DEED_NONE;
  return slack;
}

int thr_schedule_grips(const thr_schedule *schedule, int i)
{
  int n = 0;
  for (int k = 0; k < schedule->n; k++)
    n += schedule->step[k].deed == THR_DEED_GRIP && (i < 0 || schedule->step[k].cord == i);
  return n;
}

/* Follows both ends of a cord through the schedule. */
bool thr_schedule_knotted(const thr_schedule *schedule, int i)
{
  bool start = false, end = false;

  /* The last step at each end decides; a grip is at neither. */
  for (int k = 0; k < schedule->n; k++) {
    const thr_schedule_step *step = &schedule->step[k];
    if (step->cord != i || step->deed == THR_DEED_GRIP) continue;
    if (step->end != THR_PULL_END) start = step->deed == THR_DEED_KNOT;
    if (step->end != THR_PULL_START) end = step->deed == THR_DEED_KNOT;
  }

  return start && end;
}

int thr_schedule_pulls(const thr_schedule *schedule)
{
  int n = 0;
  for (int k = 0; k < schedule->n; k++)
    n += schedule->step[k].deed == THR_DEED_GRIP || schedule->step[k].deed == THR_DEED_PULL;
  return n;
}

/* ---- plan.json ---- */

/* Returns whether a step has a force, in N. */
static bool has_force(thr_deed deed)
{
  return deed != THR_DEED_KNOT && deed != THR_DEED_NONE;
}

void thr_schedule_write(const thr_schedule *schedule, thr_writer *writer, const char *key)
{
  thr_write_array(writer, key);

  /* Members depend on what is done. */
  for (int k = 0; k < schedule->n; k++) {
    const thr_schedule_step *step = &schedule->step[k];
    char id[12];
    thr_cord_id(step->cord, id);
    thr_write_line(writer, 4);
    thr_write_object(writer, NULL);
    thr_write_string(writer, "cord", id);
    thr_write_string(writer, "do", thr_deed_name(step->deed));
    if (step->deed != THR_DEED_NONE) thr_write_string(writer, "end", thr_pull_name(step->end));
    if (step->deed == THR_DEED_GRIP) thr_write_int(writer, "pass", step->pass);
    if (has_force(step->deed)) thr_write_number(writer, "force", step->force);
    if (step->deed == THR_DEED_KNOT) thr_write_number(writer, "slip", step->slip);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Returns the index of a word among n names, or -1. */
static int word_of(const thr_json *value, const char *(*name)(int), int n)
{
  const char *word = thr_json_string(value);
  for (int i = 0; word && i < n; i++)
    if (strcmp(word, name(i)) == 0) return i;
  return -1;
}

/* Returns the cord with this id, or -1. */
static int cord_of(const char *id, int n_cords)
{
  char name[12];
  for (int i = 0; id && i < n_cords; i++) {
    thr_cord_id(i, name);
    if (strcmp(name, id) == 0) return i;
  }
  return -1;
}

/* Reads a number from 0 on, which must be there or must not. Returns false if that is not so. */
static bool number_if(const thr_json *object, const char *key, bool there, double *value)
{
  const thr_json *member = thr_json_get(object, key);
  *value = 0;
  return there ? thr_json_number(member, value) && *value >= 0 : !member;
}

/* Reads a step. Returns what is wrong, or NULL. */
static const char *read_step(const thr_json *object, int n_cords, thr_schedule_step *step)
{
  static const char *const known[] = {"cord", "do", "end", "pass", "force", "slip", NULL};
  double pass;
  const int deed = word_of(thr_json_get(object, "do"), thr_deed_name, THR_N_DEEDS),
            end = word_of(thr_json_get(object, "end"), thr_pull_name, THR_PULL_NONE);

  if (thr_json_typeof(object) != THR_JSON_OBJECT || thr_json_unknown(object, known))
    return "not an object with known members";
  *step =
      (thr_schedule_step){.cord = cord_of(thr_json_string(thr_json_get(object, "cord")), n_cords)};

  /* What is done, to which cord, and where. */
  if (step->cord < 0) return "cord: there is no such cord";
  if (deed < 0) return "do: expected pull, grip, release, knot or none";
  if (deed == THR_DEED_NONE ? thr_json_get(object, "end") != NULL : end < 0)
    return "end: expected start, end or both";

  /* A cord that stays slack does so at both ends. */
  step->deed = (thr_deed)deed;
  step->end = deed == THR_DEED_NONE ? THR_PULL_BOTH : (thr_pull)end;

  /* Numbers that belong to the kind of step. */
  if (!number_if(object, "pass", deed == THR_DEED_GRIP, &pass) || pass != floor(pass) || pass > 1e9)
    return "pass: not that of a grip";
  if (!number_if(object, "force", has_force((thr_deed)deed), &step->force))
    return "force: not a number of newtons for this";

  if (!number_if(object, "slip", deed == THR_DEED_KNOT, &step->slip))
    return "slip: not a length for this";

  step->pass = (int)pass;
  return NULL;
}

/* Reads the list step by step, and checks that slack cords are only slack. */
thr_status thr_schedule_from_json(thr_schedule *schedule, const thr_json *array, int n_cords,
                                  const char *place, thr_err *err)
{
  const int n = thr_json_size(array);
  *schedule = (thr_schedule){0};

  if (thr_json_typeof(array) != THR_JSON_ARRAY || n < 1)
    return thr_fail(err, THR_EVIOLATED, "%s: not a list of steps", place);

  thr_status st = THR_OK;

  /* Step after step. */
  for (int k = 0; k < n && !st; k++) {
    thr_schedule_step step;
    const char *wrong = read_step(thr_json_at(array, k), n_cords, &step);
    st = wrong ? thr_fail(err, THR_EVIOLATED, "%s[%d]: %s", place, k, wrong)
               : thr_schedule_add(schedule, &step, err);
  }

  /* A cord that stays slack on purpose has no other step. */
  for (int i = 0; i < n_cords && !st; i++)
    if (thr_schedule_slack(schedule, i) && thr_schedule_steps(schedule, i) > 1)
      st = thr_fail(err, THR_EVIOLATED, "%s: none is the only step of a cord", place);

  if (st) thr_schedule_destroy(schedule);
  return st;
}
