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
#include "graph/number.h"
#include "graph/plan/plan_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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
  /* Arrays of the answers. */
  for (int i = 0; i < standing->n_answers; i++)
    free(standing->answer[i].velocity);

  free(standing->answer);
  free(standing->load);
  free(standing->drawn);
  *standing = (thr_standing){0};
}

/* ---- members that are numbers and words, as they are written and read ---- */

static bool is_carried(const void *answer)
{
  return ((const thr_answer *)answer)->asked == THR_ASKED_CARRIED;
}

/* Returns whether an answer has a mechanism, which comes with what it proves. */
static bool is_proved(const void *answer)
{
  return ((const thr_answer *)answer)->n_beads > 0;
}

static const char not_amount[] = "not a number from 0 on",
                  not_angle[] = "not an angle from 0 to a right one";

static const thr_field answer_fields[] = {
    {"asked", THR_FIELD_WORD, .offset = offsetof(thr_answer, asked), .name = thr_asked_name,
     .n_names = THR_N_ASKED, .wrong = "an unknown word"},
    {"pull", THR_FIELD_AMOUNT, .offset = offsetof(thr_answer, pull), .when = is_carried,
     .with = "with carried, and only with it", .wrong = not_amount},
    {"found", THR_FIELD_AMOUNT, .offset = offsetof(thr_answer, found), .optional = true,
     .unsaid = -1, .wrong = not_amount},
    {"resists", THR_FIELD_AMOUNT, .offset = offsetof(thr_answer, resists), .optional = true,
     .unsaid = -1, .when = is_proved, .wrong = not_amount},
    {"proved", THR_FIELD_AMOUNT, .offset = offsetof(thr_answer, proved), .when = is_proved,
     .wrong = not_amount},
    {.key = "mechanism"},
    {0}};

/* A load's node is compared with the framework by the checker. */
static const thr_field load_fields[] = {{"node", THR_FIELD_COUNT,
                                         .offset = offsetof(thr_load, node),
                                         .wrong = "not a number of a node"},
                                        {.key = "force"},
                                        {0}};

static const thr_field drawn_fields[] = {
    {"pull", THR_FIELD_WORD, .offset = offsetof(thr_drawn, pull), .name = thr_pull_name,
     .n_names = THR_N_PULLS, .wrong = "an unknown word"},
    {"slackest", THR_FIELD_COUNT, .offset = offsetof(thr_drawn, slackest),
     .wrong = "not a number of a pass"},
    {0}};

/* An older version has no model, and stills of a simulation, which are passed over; strength and
 * letting down need not be stated. */
static const thr_field own_fields[] = {
    {"model", THR_FIELD_COUNT, .offset = offsetof(thr_standing, model), .low = 1,
     .high = THR_STANDING_MODEL, .optional = true, .unsaid = 1, .wrong = "not 1 or 2"},
    {"clamped", THR_FIELD_TRUTH, .offset = offsetof(thr_standing, clamped),
     .wrong = "expected true or false"},
    {"taut", THR_FIELD_TRUTH, .offset = offsetof(thr_standing, taut),
     .wrong = "expected true or false"},
    {"tilt", THR_FIELD_AMOUNT, .offset = offsetof(thr_standing, tilt), .wrong = not_angle},
    {"azimuth", THR_FIELD_NUMBER, .offset = offsetof(thr_standing, azimuth),
     .wrong = "not a finite number"},
    {"strength", THR_FIELD_AMOUNT, .offset = offsetof(thr_standing, strength), .optional = true,
     .wrong = not_amount},
    {"let_down", THR_FIELD_AMOUNT, .offset = offsetof(thr_standing, let_down), .optional = true,
     .unsaid = -1, .wrong = not_amount},
    {.key = "loads"},
    {.key = "drawn"},
    {.key = "stills"},
    {.key = "answers"},
    {0}};

/* ---- writing ---- */

/* Writes the loads, in N at their nodes. */
static void put_loads(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "loads");

  for (int i = 0; i < standing->n_loads; i++) {
    thr_write_object(writer, NULL);
    thr_fields_write(writer, load_fields, &standing->load[i]);
    thr_write_numbers(writer, "force", standing->load[i].force, 3);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes how each cord is drawn in. */
static void put_drawn(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "drawn");

  for (int i = 0; i < standing->n_cords; i++) {
    thr_write_object(writer, NULL);
    thr_fields_write(writer, drawn_fields, &standing->drawn[i]);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes the answers with the mechanisms that prove them. */
static void put_answers(thr_writer *writer, const thr_standing *standing)
{
  thr_write_line(writer, 4);
  thr_write_array(writer, "answers");

  for (int i = 0; i < standing->n_answers; i++) {
    const thr_answer *answer = &standing->answer[i];
    thr_write_line(writer, 5);
    thr_write_object(writer, NULL);
    thr_fields_write(writer, answer_fields, answer);
    if (is_proved(answer))
      thr_write_numbers(writer, "mechanism", &answer->velocity[0][0], 6 * answer->n_beads);
    thr_write_close(writer);
  }

  thr_write_close(writer);
}

/* Writes what acts, how cords are drawn in, and the answers with their mechanisms. */
void thr_standing_write(const thr_standing *standing, thr_writer *writer, const char *key)
{
  thr_write_object(writer, key);
  thr_fields_write(writer, own_fields, standing);

  /* Lists, some of which only some structures have. */
  if (standing->n_loads > 0) put_loads(writer, standing);
  put_drawn(writer, standing);
  put_answers(writer, standing);
  thr_write_line(writer, 3);
  thr_write_close(writer);
}

/* ---- reading ---- */

/* Reads n numbers into number; returns false if they are not as many, or no numbers. */
static bool read_row(const thr_json *list, int n, double *number)
{
  return thr_json_size(list) == n && thr_json_numbers(list, n, number);
}

/* Reads the mechanism of an answer, and checks which members go together. */
static thr_status read_mechanism(const thr_field_reader *reader, const thr_json *object, void *into)
{
  thr_answer *answer = into;
  const thr_json *list = thr_json_get(object, "mechanism");
  const bool proved = thr_json_get(object, "proved") != NULL;
  const int n = thr_json_size(list);

  /* A price of stretching belongs to one question only. */
  if (thr_json_get(object, "resists") && (answer->asked != THR_ASKED_STRETCH || !proved))
    return thr_field_bad(reader, "resists", "only with a stretch that is proved");

  /* Without its mechanism nothing is proved. */
  if (proved != (list != NULL))
    return thr_field_bad(reader, "mechanism", "with what it proves, and only with it");
  if (thr_asked_of_load(answer->asked) && !proved) answer->proved = INFINITY;
  if (!list) return THR_OK;

  /* The numbers of all nodes follow one another. */
  if (n < 6 || n % 6) return thr_field_bad(reader, "mechanism", "not six numbers for every node");
  if (!(answer->velocity = thr_calloc((size_t)n / 6, sizeof *answer->velocity)))
    return thr_nomem(reader->err);
  answer->n_beads = n / 6;

  return read_row(list, n, &answer->velocity[0][0])
             ? THR_OK
             : thr_field_bad(reader, "mechanism", "not numbers");
}

/* Reads the force of a load. */
static thr_status read_force(const thr_field_reader *reader, const thr_json *object, void *into)
{
  return read_row(thr_json_get(object, "force"), 3, ((thr_load *)into)->force)
             ? THR_OK
             : thr_field_bad(reader, "force", "not three numbers");
}

/* A list of the structure: its elements have members of a table, and `rest` reads the others. */
typedef struct {
  const char *key;
  const thr_field *fields;
  size_t size; /* of an element */
  thr_status (*rest)(const thr_field_reader *reader, const thr_json *object, void *into);
} standing_list;

/* Reads the n elements of a list. *count is one more before each, so that what a failure leaves is
 * released. */
static thr_status read_list(const thr_field_reader *reader, const thr_json *object,
                            const standing_list *list, void *elements, int n, int *count)
{
  thr_status st = THR_OK;

  for (int i = 0; i < n && !st; i++) {
    char place[300];
    const thr_json *element = thr_json_at(thr_json_get(object, list->key), i);
    void *into = (char *)elements + (size_t)i * list->size;
    snprintf(place, sizeof place, "%s.%s[%d]", reader->name, list->key, i);
    const thr_field_reader inner = thr_field_reader_in(place, reader->err);

    *count = i + 1;
    if (thr_json_typeof(element) != THR_JSON_OBJECT || thr_fields_unknown(element, list->fields))
      return thr_fail(reader->err, THR_EVIOLATED, "%s.not an object with known members", place);
    st = thr_fields_read(&inner, element, NULL, list->fields, into);
    if (!st && list->rest) st = list->rest(&inner, element, into);
  }

  return st;
}

/* Reads loads, how cords are drawn in, and answers. */
static thr_status read_lists(const thr_field_reader *reader, const thr_json *object,
                             thr_standing *standing)
{
  static const standing_list of_loads = {"loads", load_fields, sizeof(thr_load), read_force};
  static const standing_list of_drawn = {"drawn", drawn_fields, sizeof(thr_drawn), NULL};
  static const standing_list of_answers = {"answers", answer_fields, sizeof(thr_answer),
                                           read_mechanism};
  const thr_json *loads = thr_json_get(object, "loads"), *drawn = thr_json_get(object, "drawn"),
                 *answers = thr_json_get(object, "answers");
  const int n_loads = thr_json_size(loads), n_answers = thr_json_size(answers);

  /* Shapes first, so that the arrays can be allocated. */
  if (loads && (thr_json_typeof(loads) != THR_JSON_ARRAY || n_loads < 1))
    return thr_field_bad(reader, "loads", "not a list of loads");
  if (thr_json_typeof(drawn) != THR_JSON_ARRAY || thr_json_size(drawn) != standing->n_cords)
    return thr_field_bad(reader, "drawn", "not one per cord");
  if (thr_json_typeof(answers) != THR_JSON_ARRAY || n_answers < 1)
    return thr_field_bad(reader, "answers", "missing or empty");

  standing->load = thr_calloc((size_t)n_loads, sizeof *standing->load);
  standing->drawn = thr_calloc((size_t)standing->n_cords, sizeof *standing->drawn);
  standing->answer = thr_calloc((size_t)n_answers, sizeof *standing->answer);
  if (!standing->load || !standing->drawn || !standing->answer) return thr_nomem(reader->err);

  /* What an answer does not state is not known. */
  for (int i = 0; i < n_answers; i++)
    standing->answer[i] = (thr_answer){.found = INFINITY, .resists = -1};

  /* There are as many cords drawn in as there are cords. */
  int n_drawn;
  thr_status st = read_list(reader, object, &of_loads, standing->load, n_loads, &standing->n_loads);
  if (!st) st = read_list(reader, object, &of_drawn, standing->drawn, standing->n_cords, &n_drawn);

  return st ? st
            : read_list(reader, object, &of_answers, standing->answer, n_answers,
                        &standing->n_answers);
}

/* Reads all members. */
static thr_status read_members(const thr_field_reader *reader, const thr_json *object,
                               thr_standing *standing)
{
  const thr_status st = thr_fields_read(reader, object, NULL, own_fields, standing);

  /* A slope steeper than a right angle is none. */
  if (!st && !(standing->tilt < THR_PI / 2)) return thr_field_bad(reader, "tilt", not_angle);
  return st ? st : read_lists(reader, object, standing);
}

thr_status thr_standing_from_json(thr_standing *standing, const thr_json *object, int n_cords,
                                  const char *place, thr_err *err)
{
  const thr_field_reader reader = thr_field_reader_in(place, err);
  *standing = (thr_standing){.present = true, .model = 1, .let_down = NAN, .n_cords = n_cords};

  /* Until something is stated, nothing is known. */
  thr_status st = thr_json_typeof(object) == THR_JSON_OBJECT
                      ? read_members(&reader, object, standing)
                      : thr_fail(err, THR_EVIOLATED, "%s: not an object", place);
  if (st) thr_standing_destroy(standing);

  return st;
}
