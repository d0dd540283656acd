/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps what the limit analysis found of a structure, in the form of plan.json: what acts on the
 * structure, what was asked, and the mechanisms that prove the answers. The checker adds up the
 * powers of each mechanism by itself (graph/check/check_standing.c).
 *
 * A mechanism is the velocities of all beads, six numbers each: translation of the mass centre and
 * rotation. If what acts does more power in it than whatever resists can take up, there is no
 * equilibrium.
 *
 * Example: "pulled at both ends while it is drawn in, nothing holds the structure below 4.14 N",
 * with the velocities of all beads by which it then falls. */
#include "graph/plan/evaluation.h"

#include "graph/number.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const asked_name[] = {"holding",       "equal",   "any_state",
                                         "after",         "loaded",  "carried",
                                         "carried_after", "stretch", "tightest"};

const char *thr_asked_name(int asked)
{
  return asked_name[asked];
}

bool thr_asked_of_load(thr_asked asked)
{
  return asked == THR_ASKED_CARRIED || asked == THR_ASKED_CARRIED_AFTER;
}

bool thr_asked_after(thr_asked asked)
{
  return asked == THR_ASKED_AFTER || asked == THR_ASKED_CARRIED_AFTER ||
         asked == THR_ASKED_STRETCH || asked == THR_ASKED_TIGHTEST;
}

void thr_standing_destroy(thr_standing *standing)
{
  /* Arrays of the answers and stills. */
  for (int i = 0; i < standing->n_answers; i++)
    free(standing->answer[i].velocity);
  for (int i = 0; i < standing->n_stills; i++)
    free(standing->still[i].pose);

  free(standing->answer);
  free(standing->still);
  free(standing->load);
  free(standing->drawn);
  *standing = (thr_standing){0};
}

/* ---- writing ---- */

/* Writes an answer: what was asked, what was found, and the mechanism that proves it. */
static void put_answer(thr_writer *writer, const thr_answer *answer)
{
  /* What was asked, and at which value the solver found an equilibrium. */
  thr_write_line(writer, 5);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "asked", thr_asked_name(answer->asked));
  if (answer->asked == THR_ASKED_CARRIED) thr_write_number(writer, "pull", answer->pull);
  if (isfinite(answer->found)) thr_write_number(writer, "found", answer->found);

  if (answer->n_beads > 0 && answer->resists >= 0)
    thr_write_number(writer, "resists", answer->resists);

  /* A mechanism comes with what it proves. */
  if (answer->n_beads > 0) {
    thr_write_number(writer, "proved", answer->proved);
    thr_write_row(writer, "mechanism");
    for (int v = 0; v < answer->n_beads; v++)
      for (int k = 0; k < 6; k++)
        thr_write_number(writer, NULL, answer->velocity[v][k]);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes the loads, in N at their nodes. */
static void put_loads(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "loads");

  /* Node and force of each load. */
  for (int i = 0; i < standing->n_loads; i++) {
    thr_write_object(writer, NULL);
    thr_write_int(writer, "node", standing->load[i].node);
    thr_write_row(writer, "force");
    for (int k = 0; k < 3; k++)
      thr_write_number(writer, NULL, standing->load[i].force[k]);
    thr_write_close(writer);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes how each cord is drawn in. */
static void put_drawn(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "drawn");

  /* One for each cord. */
  for (int i = 0; i < standing->n_cords; i++) {
    thr_write_object(writer, NULL);
    thr_write_string(writer, "pull", thr_pull_name((thr_pull)standing->drawn[i].pull));
    thr_write_int(writer, "slackest", standing->drawn[i].slackest);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes a still of the structure while its cords are drawn in: seven numbers for every bead. */
static void put_still(thr_writer *writer, const thr_posed *still)
{
  thr_write_line(writer, 5);
  thr_write_object(writer, NULL);
  thr_write_number(writer, "pull", still->pull);
  thr_write_number(writer, "counterweight", still->counterweight);
  thr_write_int(writer, "seated", still->seated);
  thr_write_row(writer, "poses");

  /* A bead's pose is its place in m and a quaternion. */
  for (int v = 0; v < still->n_beads; v++)
    for (int k = 0; k < 7; k++)
      thr_write_number(writer, NULL, still->pose[v][k]);

  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes all stills. */
static void put_stills(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "stills");
  for (int i = 0; i < standing->n_stills; i++)
    put_still(writer, &standing->still[i]);
  thr_write_close(writer);
}

/* Writes what acts, how cords are drawn in, stills, and the answers with their mechanisms. */
void thr_standing_write(const thr_standing *standing, thr_writer *writer, const char *key)
{
  /* What the structure stands on. */
  thr_write_object(writer, key);
  if (standing->model > 1) thr_write_int(writer, "model", standing->model);
  thr_write_bool(writer, "clamped", standing->clamped);
  thr_write_bool(writer, "taut", standing->taut);
  thr_write_number(writer, "tilt", standing->tilt);
  thr_write_number(writer, "azimuth", standing->azimuth);

  /* What only some structures have. */
  if (standing->strength > 0) thr_write_number(writer, "strength", standing->strength);
  if (isfinite(standing->let_down)) thr_write_number(writer, "let_down", standing->let_down);
  if (standing->n_loads > 0) put_loads(writer, standing);
  put_drawn(writer, standing);
  if (standing->n_stills > 0) put_stills(writer, standing);

  /* Answer by answer. */
  thr_write_line(writer, 4);
  thr_write_array(writer, "answers");
  for (int i = 0; i < standing->n_answers; i++)
    put_answer(writer, &standing->answer[i]);

  thr_write_close(writer);
  thr_write_line(writer, 3);
  thr_write_close(writer);
}

/* ---- reading ---- */

/* Returns the index of a word in a list, or -1. */
static int word_of(const thr_json *value, const char *const *word, int n)
{
  const char *text = thr_json_string(value);
  for (int i = 0; text && i < n; i++)
    if (strcmp(text, word[i]) == 0) return i;
  return -1;
}

/* Reads a number from 0 on, if it is there or needed; returns false if the number is wrong or
 * missing. */
static bool amount(const thr_json *object, const char *key, bool needed, double *value)
{
  const thr_json *member = thr_json_get(object, key);
  if (!member) return !needed;
  if (!thr_json_number(member, value)) return false;
  *value += 0.0; /* -0.0 is 0 */
  return *value >= 0;
}

/* Reads the mechanism of an answer. Returns what is wrong, "" if memory has run out, NULL if
 * nothing is wrong. */
static const char *read_mechanism(const thr_json *list, thr_answer *answer)
{
  const int n = thr_json_size(list);

  /* The numbers of all nodes follow one another. */
  if (n < 6 || n % 6) return "mechanism: not six numbers for every node";
  if (!(answer->velocity = thr_calloc((size_t)n / 6, sizeof *answer->velocity))) return "";
  answer->n_beads = n / 6;

  return thr_json_numbers(list, n, &answer->velocity[0][0]) ? NULL : "mechanism: not numbers";
}

/* Reads an answer. Returns what is wrong, "" if memory has run out, NULL if nothing is wrong. */
static const char *read_answer(const thr_json *object, thr_answer *answer)
{
  static const char *const known[] = {"asked",  "pull",      "found", "resists",
                                      "proved", "mechanism", NULL};
  const thr_json *proved = thr_json_get(object, "proved"),
                 *mechanism = thr_json_get(object, "mechanism");
  const int asked = word_of(thr_json_get(object, "asked"), asked_name, THR_N_ASKED);

  /* Which members belong to it depends on what was asked. */
  if (thr_json_typeof(object) != THR_JSON_OBJECT || thr_json_unknown(object, known))
    return "not an object with known members";

  if (asked < 0) return "asked: an unknown word";

  /* What is not stated is not known. */
  *answer = (thr_answer){.asked = (thr_asked)asked, .found = INFINITY, .resists = -1};
  if (thr_asked_of_load(answer->asked) && !proved) answer->proved = INFINITY;

  /* A pull belongs to one question only. */
  if ((asked == THR_ASKED_CARRIED) != (thr_json_get(object, "pull") != NULL))
    return "pull: with carried, and only with it";

  if (!amount(object, "pull", false, &answer->pull)) return "pull: not a number from 0 on";
  if (!amount(object, "found", false, &answer->found)) return "found: not a number from 0 on";

  /* A price of stretching belongs to one question only. */
  if (thr_json_get(object, "resists") && (asked != THR_ASKED_STRETCH || !proved))
    return "resists: only with a stretch that is proved";

  if (!amount(object, "resists", false, &answer->resists)) return "resists: not a number from 0 on";
  if (!amount(object, "proved", false, &answer->proved)) return "proved: not a number from 0 on";

  /* Without its mechanism nothing is proved. */
  if ((proved != NULL) != (mechanism != NULL))
    return "mechanism: with what it proves, and only with it";

  return mechanism ? read_mechanism(mechanism, answer) : NULL;
}

/* Reads a still. Returns what is wrong, "" if memory has run out, NULL if nothing is wrong. */
static const char *read_still(const thr_json *object, thr_posed *still)
{
  static const char *const known[] = {"pull", "counterweight", "seated", "poses", NULL};
  const thr_json *poses = thr_json_get(object, "poses");
  const int n = thr_json_size(poses);
  int64_t seated;

  if (thr_json_typeof(object) != THR_JSON_OBJECT || thr_json_unknown(object, known))
    return "not an object with known members";

  /* The pulls, and how many gaps are seated. */
  if (!amount(object, "pull", true, &still->pull)) return "pull: not a number from 0 on";
  if (!amount(object, "counterweight", true, &still->counterweight))
    return "counterweight: not a number from 0 on";

  if (!thr_json_int(thr_json_get(object, "seated"), &seated) || seated < 0 || seated > INT32_MAX)
    return "seated: not a number of gaps";

  still->seated = (int)seated;

  /* The beads: place and rotation of each. */
  if (n < 7 || n % 7) return "poses: not seven numbers for every node";
  if (!(still->pose = thr_calloc((size_t)n / 7, sizeof *still->pose))) return "";
  still->n_beads = n / 7;

  return thr_json_numbers(poses, n, &still->pose[0][0]) ? NULL : "poses: not numbers";
}

/* Reads a load. Returns what is wrong, NULL if nothing is. */
static const char *read_load(const thr_json *object, thr_load *load)
{
  static const char *const known[] = {"node", "force", NULL};
  const thr_json *force = thr_json_get(object, "force");
  int64_t node;

  if (thr_json_typeof(object) != THR_JSON_OBJECT || thr_json_unknown(object, known))
    return "not an object with known members";

  /* A load's node is compared with the framework by the checker. */
  if (!thr_json_int(thr_json_get(object, "node"), &node) || node < 0 || node > INT32_MAX)
    return "node: not a number of a node";

  if (thr_json_size(force) != 3 || !thr_json_numbers(force, 3, load->force))
    return "force: not three numbers";

  load->node = (int)node;
  return NULL;
}

/* Reads how a cord is drawn in. Returns what is wrong, NULL if nothing is. */
static const char *read_drawn(const thr_json *object, thr_drawn *drawn)
{
  static const char *const known[] = {"pull", "slackest", NULL};
  int64_t slackest;

  if (thr_json_typeof(object) != THR_JSON_OBJECT || thr_json_unknown(object, known))
    return "not an object with known members";

  /* The end is a word, the pass a number. */
  if ((drawn->pull = thr_pull_named(thr_json_string(thr_json_get(object, "pull")))) < 0)
    return "pull: an unknown word";

  if (!thr_json_int(thr_json_get(object, "slackest"), &slackest) || slackest < 0 ||
      slackest > INT32_MAX)
    return "slackest: not a number of a pass";

  drawn->slackest = (int)slackest;
  return NULL;
}

/* Where an object is, for messages "place.list[i].what". */
typedef struct {
  const char *place;
  thr_err *err;
} place_reader;

/* Records THR_EVIOLATED about element i of a list, or about a member (i < 0); THR_ENOMEM if `what`
 * is "". */
static thr_status bad(const place_reader *reader, const char *list, int i, const char *what)
{
  if (!*what) return thr_nomem(reader->err);
  if (i < 0) return thr_fail(reader->err, THR_EVIOLATED, "%s.%s: %s", reader->place, list, what);
  return thr_fail(reader->err, THR_EVIOLATED, "%s.%s[%d].%s", reader->place, list, i, what);
}

/* Reads the stills, if there are any. */
static thr_status read_stills(const place_reader *reader, const thr_json *list,
                              thr_standing *standing)
{
  const int n = thr_json_size(list);

  /* An older version wrote no stills. */
  if (!list) return THR_OK;
  if (thr_json_typeof(list) != THR_JSON_ARRAY || n < 1)
    return bad(reader, "stills", -1, "not a list of stills");

  standing->still = thr_calloc((size_t)n, sizeof *standing->still);
  if (!standing->still) return thr_nomem(reader->err);

  /* Count first, so that what a failure leaves is released. */
  while (standing->n_stills < n) {
    const int i = standing->n_stills++;
    const char *what = read_still(thr_json_at(list, i), &standing->still[i]);
    if (what) return bad(reader, "stills", i, what);
  }

  return THR_OK;
}

/* Reads loads, how cords are drawn in, and answers. */
static thr_status read_lists(const place_reader *reader, const thr_json *object,
                             thr_standing *standing)
{
  const thr_json *loads = thr_json_get(object, "loads"), *drawn = thr_json_get(object, "drawn"),
                 *answers = thr_json_get(object, "answers");
  const char *what = NULL;
  const int n_loads = thr_json_size(loads), n_answers = thr_json_size(answers);

  /* Shapes first, so that the arrays can be allocated. */
  if (loads && (thr_json_typeof(loads) != THR_JSON_ARRAY || n_loads < 1))
    return bad(reader, "loads", -1, "not a list of loads");
  if (thr_json_typeof(drawn) != THR_JSON_ARRAY || thr_json_size(drawn) != standing->n_cords)
    return bad(reader, "drawn", -1, "not one per cord");

  if (thr_json_typeof(answers) != THR_JSON_ARRAY || n_answers < 1)
    return bad(reader, "answers", -1, "missing or empty");

  /* One more load, so that none is no failure. */
  standing->load = thr_calloc((size_t)n_loads + 1, sizeof *standing->load);
  standing->drawn = thr_calloc((size_t)standing->n_cords, sizeof *standing->drawn);
  standing->answer = thr_calloc((size_t)n_answers, sizeof *standing->answer);
  if (!standing->load || !standing->drawn || !standing->answer) return thr_nomem(reader->err);

  /* Element by element. */
  for (; standing->n_loads < n_loads; standing->n_loads++)
    if ((what =
             read_load(thr_json_at(loads, standing->n_loads), &standing->load[standing->n_loads])))
      return bad(reader, "loads", standing->n_loads, what);

  /* As many as there are cords. */
  for (int i = 0; i < standing->n_cords; i++)
    if ((what = read_drawn(thr_json_at(drawn, i), &standing->drawn[i])))
      return bad(reader, "drawn", i, what);

  while (standing->n_answers < n_answers) {
    const int i = standing->n_answers++;
    if ((what = read_answer(thr_json_at(answers, i), &standing->answer[i])))
      return bad(reader, "answers", i, what);
  }

  return THR_OK;
}

/* Reads all members. */
static thr_status read_members(const place_reader *reader, const thr_json *object,
                               thr_standing *standing)
{
  static const char *const known[] = {"model",   "clamped",  "taut",     "tilt",
                                      "azimuth", "strength", "let_down", "loads",
                                      "drawn",   "stills",   "answers",  NULL};
  const char *key = thr_json_unknown(object, known);

  if (key) return bad(reader, key, -1, "this version does not know it and cannot check it");

  /* An older version has no model. */
  const thr_json *model = thr_json_get(object, "model");
  int64_t number = 1;
  if (model && (!thr_json_int(model, &number) || number < 1 || number > THR_STANDING_MODEL))
    return bad(reader, "model", -1, "not 1 or 2");

  standing->model = (int)number;

  /* What the structure stands on. */
  if (thr_json_typeof(thr_json_get(object, "clamped")) != THR_JSON_BOOL)
    return bad(reader, "clamped", -1, "expected true or false");
  if (thr_json_typeof(thr_json_get(object, "taut")) != THR_JSON_BOOL)
    return bad(reader, "taut", -1, "expected true or false");

  standing->clamped = thr_json_true(thr_json_get(object, "clamped"));
  standing->taut = thr_json_true(thr_json_get(object, "taut"));
  if (!amount(object, "tilt", true, &standing->tilt) || !(standing->tilt < THR_PI / 2))
    return bad(reader, "tilt", -1, "not an angle from 0 to a right one");

  if (!thr_json_number(thr_json_get(object, "azimuth"), &standing->azimuth))
    return bad(reader, "azimuth", -1, "not a finite number");

  /* Strength and letting down need not be stated. */
  standing->azimuth += 0.0; /* -0.0 is 0 */
  if (!amount(object, "strength", false, &standing->strength))
    return bad(reader, "strength", -1, "not a number from 0 on");

  if (!amount(object, "let_down", false, &standing->let_down))
    return bad(reader, "let_down", -1, "not a number from 0 on");

  thr_status st = read_stills(reader, thr_json_get(object, "stills"), standing);
  return st ? st : read_lists(reader, object, standing);
}

thr_status thr_standing_from_json(thr_standing *standing, const thr_json *object, int n_cords,
                                  const char *place, thr_err *err)
{
  const place_reader reader = {place, err};
  *standing = (thr_standing){.present = true, .let_down = NAN, .n_cords = n_cords};

  /* Until something is stated, nothing is known. */
  thr_status st = thr_json_typeof(object) == THR_JSON_OBJECT
                      ? read_members(&reader, object, standing)
                      : thr_fail(err, THR_EVIOLATED, "%s: not an object", place);
  if (st) thr_standing_destroy(standing);

  return st;
}
