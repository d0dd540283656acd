/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps what `thread eval` found out about a plan, in the form of plan.json: the eval methods fill
 * in an evaluation, drawings show it, the checker verifies that it is consistent with the plan.
 *
 * Tensions and forces are in N, turning in rad. An evaluation has one record for each cord; what
 * follows from the tensions (scale, colours) is written for readers of the file, and checked when
 * it is read.
 *
 * Example of a cord that is pulled at its end:
 *     {"id": "A", "known": true, "pull": "end", .., "tension": [1, 1.37], "colours": ["#f3d350",
 * "#4b023a"]} */

#include "graph/plan/plan_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const method_name[] = {"capstan", "joint", "structure"};
static const char *const law_name[] = {"capstan", "mitre"};

const char *thr_method_name(int method)
{
  return method_name[method];
}

const char *thr_law_name(int law)
{
  return law_name[law];
}

const thr_eval_cord *thr_evaluation_hardest(const thr_evaluation *evaluation)
{
  const thr_eval_cord *hardest = &evaluation->cord[0];
  for (int i = 1; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].force > hardest->force) hardest = &evaluation->cord[i];
  return hardest;
}

void thr_evaluation_sum(thr_evaluation *evaluation)
{
  evaluation->largest = evaluation->total = 0;
  for (int i = 0; i < evaluation->n_cords; i++) {
    evaluation->largest = fmax(evaluation->largest, evaluation->cord[i].force);
    evaluation->total += evaluation->cord[i].force + evaluation->cord[i].other_force;
  }
}

void thr_evaluation_destroy(thr_evaluation *evaluation)
{
  /* Arrays of every cord. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    free(evaluation->cord[i].tension);
    free(evaluation->cord[i].turn);
    free(evaluation->cord[i].most);
    free(evaluation->cord[i].exponent);
  }

  /* What belongs to the whole. */
  thr_schedule_destroy(&evaluation->schedule);
  thr_standing_destroy(&evaluation->standing);
  free(evaluation->cord);
  *evaluation = (thr_evaluation){0};
}

/* Does the plan state the exponents of every cord, which then cannot be worked out again from the
 * law or belong to a schedule? */
static bool evaluation_exponents(const thr_evaluation *evaluation)
{
  return evaluation->schedule.n > 0 || evaluation->standing.taut;
}

/* Finds the least and largest tension; the least above 0 after a schedule. */
bool thr_evaluation_range(const thr_evaluation *evaluation, double range[2])
{
  bool known = false;

  range[0] = INFINITY;
  range[1] = 0;

  /* Passes without tension after a schedule have no place on a logarithmic scale. */
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; evaluation->cord[i].known && k < evaluation->cord[i].n_passes; k++) {
      known = true;
      if (evaluation->cord[i].tension[k] > 0 || evaluation->schedule.n == 0)
        range[0] = fmin(range[0], evaluation->cord[i].tension[k]);
      range[1] = fmax(range[1], evaluation->cord[i].tension[k]);
    }

  /* Only slack passes: a scale of one value. */
  if (!known || range[0] > range[1]) range[0] = range[1];
  return known;
}

/* Finds the colour at log(tension / low) / log(high / low) of the way from pale to dark. */
void thr_tension_colour(const double range[2], double tension, char hex[8])
{
  /* Equal steps in the Oklab space (B. Ottosson, 2020), lightness 0.87 to 0.28, yellow over red to
   * violet. Lightness alone tells the order, so that the colours are read without colour vision,
   * too. */
  static const int stop[][3] = {{243, 211, 80}, {238, 176, 50}, {227, 142, 36},
                                {211, 110, 39}, {190, 79, 49},  {165, 51, 57},
                                {138, 23, 62},  {106, 5, 64},   {75, 2, 58}};
  enum { LAST = sizeof stop / sizeof *stop - 1 };

  /* The place on the logarithmic scale; NaN and infinities become its ends. */
  double span = log(range[1] / range[0]), at = span > 0 ? LAST * log(tension / range[0]) / span : 0;
  at = isfinite(at) ? fmin(fmax(at, 0), LAST) : 0;

  /* Interpolate between two stops. */
  int i = at < LAST ? (int)at : LAST - 1, rgb[3];
  for (int c = 0; c < 3; c++)
    rgb[c] = (int)nearbyint(stop[i][c] + (at - i) * (stop[i + 1][c] - stop[i][c]));

  snprintf(hex, 8, "#%02x%02x%02x", (unsigned)rgb[0] & 255, (unsigned)rgb[1] & 255,
           (unsigned)rgb[2] & 255);
}

/* ---- members that are numbers, as they are written and read ---- */

/* Of a cord that is known; its tensions, which say how many passes it has, are read before. */
static const thr_field cord_fields[] = {
    {.key = "id"},
    {.key = "known"},
    {.key = "pull"},
    {"turning", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, turning)},
    {"taut_turning", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, taut_turning)},
    {"force", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, force), .line = 5},
    {"other_force", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, other_force)},
    {"loss", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, loss)},
    {"work", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, work)},
    {"error", THR_FIELD_NUMBER, .offset = offsetof(thr_eval_cord, error)},
    {"slackest", THR_FIELD_COUNT, .offset = offsetof(thr_eval_cord, slackest),
     .below = offsetof(thr_eval_cord, n_passes)},
    {"refused", THR_FIELD_COUNT, .offset = offsetof(thr_eval_cord, refused),
     .below = offsetof(thr_eval_cord, n_passes)},
    {.key = "tension"},
    {.key = "tension_most"},
    {.key = "colours"},
    {.key = "exponents"},
    {0}};

/* Of the whole evaluation. */
static bool knows_seated(const void *evaluation)
{
  return ((const thr_evaluation *)evaluation)->seated_known;
}

static const thr_field own_fields[] = {
    {.key = "method"},
    {.key = "law"},
    {.key = "physics"},
    {"seed", THR_FIELD_WHOLE, .offset = offsetof(thr_evaluation, seed), .high = INT64_C(1) << 53},
    {"time_step", THR_FIELD_NUMBER, .offset = offsetof(thr_evaluation, time_step)},
    {"iterations", THR_FIELD_NUMBER, .offset = offsetof(thr_evaluation, iterations)},
    {"largest", THR_FIELD_NUMBER, .offset = offsetof(thr_evaluation, largest)},
    {"total", THR_FIELD_NUMBER, .offset = offsetof(thr_evaluation, total)},
    {"seated", THR_FIELD_NUMBER, .offset = offsetof(thr_evaluation, seated), .when = knows_seated},
    {.key = "scale"},
    {.key = "schedule"},
    {.key = "structure"},
    {.key = "cords"},
    {0}};

/* ---- writing ---- */

/* Writes a list of numbers on a line of its own. */
static void put_numbers(thr_writer *writer, const char *key, const double *number, int n)
{
  thr_write_line(writer, 5);
  thr_write_numbers(writer, key, number, n);
}

/* Writes the tensions of a cord's passes, and their colours. */
static void put_tension(thr_writer *writer, const thr_eval_cord *cord, const double range[2])
{
  put_numbers(writer, "tension", cord->tension, cord->n_passes);
  if (cord->most) put_numbers(writer, "tension_most", cord->most, cord->n_passes);
  thr_write_line(writer, 5);
  thr_write_row(writer, "colours");

  /* A colour for each tension. */
  for (int k = 0; k < cord->n_passes; k++) {
    char hex[8];
    thr_tension_colour(range, cord->tension[k], hex);
    thr_write_string(writer, NULL, hex);
  }

  thr_write_close(writer);
}

/* Writes what is known of cord i. */
static void put_cord(thr_writer *writer, const thr_eval_cord *cord, int i, const double range[2],
                     bool exponents)
{
  char id[12];

  /* What is known of every cord. */
  thr_cord_id(i, id);
  thr_write_line(writer, 4);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "id", id);
  thr_write_bool(writer, "known", cord->known);
  thr_write_string(writer, "pull", thr_pull_name(cord->pull));

  /* Of a cord that is not known nothing else is written. */
  if (cord->known) {
    thr_fields_write(writer, cord_fields, cord);
    if (exponents) put_numbers(writer, "exponents", cord->exponent, cord->n_passes - 1);
    put_tension(writer, cord, range);
  }

  thr_write_close(writer);
}

/* Writes the evaluation: how it was computed, sums, scale, schedule, structure, and cord by
 * cord. */
void thr_evaluation_write(const thr_evaluation *evaluation, thr_writer *writer, const char *key)
{
  double range[2];

  thr_evaluation_range(evaluation, range);
  thr_write_object(writer, key);

  /* How it was computed. */
  thr_write_string(writer, "method", thr_method_name(evaluation->method));
  if (evaluation->method == THR_CAPSTAN)
    thr_write_string(writer, "law", thr_law_name(evaluation->law));

  thr_write_line(writer, 2);
  thr_physics_write(&evaluation->physics, writer, "physics");
  thr_write_line(writer, 2);
  thr_fields_write(writer, own_fields, evaluation);

  /* The scale of the colours. */
  thr_write_line(writer, 2);
  thr_write_object(writer, "scale");
  thr_write_number(writer, "low", range[0]);
  thr_write_number(writer, "high", range[1]);
  thr_write_close(writer);

  /* What only some evaluations have. */
  if (evaluation->schedule.n > 0) {
    thr_write_line(writer, 2);
    thr_schedule_write(&evaluation->schedule, writer, "schedule");
  }

  if (evaluation->standing.present) {
    thr_write_line(writer, 2);
    thr_standing_write(&evaluation->standing, writer, "structure");
  }

  /* Cord by cord. */
  thr_write_line(writer, 2);
  thr_write_array(writer, "cords");
  for (int i = 0; i < evaluation->n_cords; i++)
    put_cord(writer, &evaluation->cord[i], i, range, evaluation_exponents(evaluation));

  thr_write_line(writer, 2);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* ---- reading ---- */

/* Reads a member as one of n words; *out becomes its index. */
static thr_status get_word(const thr_field_reader *reader, const thr_json *object, const char *key,
                           const char *const *word, int n, int *out)
{
  const char *value = thr_json_string(thr_json_get(object, key));
  for (*out = 0; value && *out < n; ++*out)
    if (strcmp(value, word[*out]) == 0) return THR_OK;
  *out = 0;
  return thr_field_bad(reader, key, value ? "an unknown word" : "missing or not text");
}

/* Returns whether two colours "#rrggbb" differ by at most one step of 255 in each part, because the
 * logarithm is not the same to the last bit on all machines. */
static bool same_colour(const char *a, const char *b)
{
  unsigned first[3], second[3];

  /* sscanf alone would take signs and blanks. */
  if (!a || strlen(a) != 7 || a[strspn(a, "#0123456789abcdef")]) return false;
  if (sscanf(a, "#%2x%2x%2x", &first[0], &first[1], &first[2]) != 3 ||
      sscanf(b, "#%2x%2x%2x", &second[0], &second[1], &second[2]) != 3)
    return false;

  for (int i = 0; i < 3; i++)
    if (first[i] > second[i] + 1 || second[i] > first[i] + 1) return false;

  return true;
}

/* Reads the tensions of a cord's passes, as many as there are. Colours are only counted here. */
static thr_status read_tension(const thr_field_reader *reader, const thr_json *object,
                               thr_eval_cord *cord)
{
  const thr_json *list = thr_json_get(object, "tension"),
                 *colours = thr_json_get(object, "colours");
  int n = thr_json_size(list);

  /* One tension for each pass, and one colour for each tension. */
  if (thr_json_typeof(list) != THR_JSON_ARRAY || n < 1)
    return thr_field_bad(reader, "tension", "missing or empty");
  if (thr_json_typeof(colours) != THR_JSON_ARRAY || thr_json_size(colours) != n)
    return thr_field_bad(reader, "colours", "not one per tension");

  if (!(cord->tension = thr_calloc((size_t)n, sizeof *cord->tension)))
    return thr_nomem(reader->err);

  /* Tensions cannot be negative. */
  cord->n_passes = n;
  for (int k = 0; k < n; k++)
    if (!thr_json_number(thr_json_at(list, k), &cord->tension[k]) || !(cord->tension[k] >= 0))
      return thr_fail(reader->err, THR_EVIOLATED, "%s.tension[%d]: not a number from 0 on",
                      reader->name, k);

  return THR_OK;
}

/* Reads a list of n numbers from 0 on into *number, or leaves NULL if there is no such member. */
static thr_status read_numbers(const thr_field_reader *reader, const thr_json *object,
                               const char *key, int n, double **number)
{
  const thr_json *list = thr_json_get(object, key);
  if (!list) return THR_OK;
  if (thr_json_typeof(list) != THR_JSON_ARRAY || thr_json_size(list) != n)
    return thr_field_bad(reader, key, "not one per pass or turn");

  /* One more, so that n = 0 is no failure. */
  if (!(*number = thr_calloc((size_t)n + 1, sizeof **number))) return thr_nomem(reader->err);

  /* Neither exponents nor tensions can be negative. */
  for (int k = 0; k < n; k++)
    if (!thr_json_number(thr_json_at(list, k), &(*number)[k]) || !((*number)[k] >= 0))
      return thr_fail(reader->err, THR_EVIOLATED, "%s.%s[%d]: not a number from 0 on", reader->name,
                      key, k);

  return THR_OK;
}

/* Reads the record of cord i. */
static thr_status read_cord(const thr_field_reader *reader, const thr_json *object, int i,
                            thr_eval_cord *cord)
{
  static const char *const unknown[] = {"id", "known", "pull", NULL};

  char name[12];

  /* Which cord it is, whether it is known, and how it was pulled. */
  thr_cord_id(i, name);
  const char *id = thr_json_string(thr_json_get(object, "id"));
  const thr_json *known = thr_json_get(object, "known");
  const int pull = thr_pull_named(thr_json_string(thr_json_get(object, "pull")));

  /* Records are in the order of the cords. */
  if (!id || strcmp(id, name) != 0)
    return thr_field_bad(reader, "id", "not the plan's cord with this number");
  if (thr_json_typeof(known) != THR_JSON_BOOL)
    return thr_field_bad(reader, "known", "missing; expected true or false");

  cord->known = thr_json_true(known);

  /* A cord that is not known has no numbers. */
  thr_status st = cord->known ? THR_OK : thr_field_only(reader, object, NULL, unknown);
  if (!st && pull < 0) st = thr_field_bad(reader, "pull", "missing or an unknown word");
  if (st) return st;
  cord->pull = (thr_pull)pull;
  if (!cord->known) return THR_OK;

  /* The tensions tell how many passes and turns there are. */
  st = read_tension(reader, object, cord);
  if (!st) st = read_numbers(reader, object, "exponents", cord->n_passes - 1, &cord->exponent);
  if (!st) st = read_numbers(reader, object, "tension_most", cord->n_passes, &cord->most);

  return st ? st : thr_fields_read(reader, object, NULL, cord_fields, cord);
}

/* Reads the records of all cords. */
static thr_status read_cords(const thr_field_reader *reader, const thr_json *object,
                             thr_evaluation *evaluation)
{
  const thr_json *list = thr_json_get(object, "cords");
  int n = thr_json_size(list);

  /* There is at least one cord. */
  if (thr_json_typeof(list) != THR_JSON_ARRAY || n < 1)
    return thr_field_bad(reader, "cords", "missing or empty");
  if (!(evaluation->cord = thr_calloc((size_t)n, sizeof *evaluation->cord)))
    return thr_nomem(reader->err);

  evaluation->n_cords = n;

  /* Each record's place is part of the messages. */
  for (int i = 0; i < n; i++) {
    char place[256];
    snprintf(place, sizeof place, "%.200s.cords[%d]", reader->name, i);
    const thr_field_reader inner = thr_field_reader_in(place, reader->err);
    thr_status st = read_cord(&inner, thr_json_at(list, i), i, &evaluation->cord[i]);
    if (st) return st;
  }

  return THR_OK;
}

/* Checks the scale and the colours, which are no members of the record in memory, because they
 * follow from the tensions. */
static thr_status check_colours(const thr_field_reader *reader, const thr_json *object,
                                const thr_evaluation *evaluation)
{
  static const char *const known[] = {"low", "high", NULL};
  double range[2], stated[2];
  const thr_json *scale = thr_json_get(object, "scale"), *cords = thr_json_get(object, "cords");
  thr_status st = thr_field_only(reader, scale, NULL, known);

  /* Stated, and as it follows from the tensions. */
  if (!st) st = thr_field_double(reader, scale, "low", &stated[0]);
  if (!st) st = thr_field_double(reader, scale, "high", &stated[1]);
  if (st) return st;
  thr_evaluation_range(evaluation, range);

  /* The scale is that of the tensions. */
  if (stated[0] != range[0] || stated[1] != range[1])
    return thr_field_bad(reader, "scale", "not the least and largest tension");

  /* The colour of every tension. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    const thr_json *colours = thr_json_get(thr_json_at(cords, i), "colours");
    for (int k = 0; evaluation->cord[i].known && k < evaluation->cord[i].n_passes; k++) {
      char hex[8];
      thr_tension_colour(range, evaluation->cord[i].tension[k], hex);
      if (!same_colour(thr_json_string(thr_json_at(colours, k)), hex))
        return thr_fail(reader->err, THR_EVIOLATED,
                        "%s.cords[%d].colours[%d]: expected %s for this tension", reader->name, i,
                        k, hex);
    }
  }

  return THR_OK;
}

/* Reads what the limit analysis found, of method structure only. */
static thr_status read_standing(const thr_field_reader *reader, const thr_json *object,
                                thr_evaluation *evaluation)
{
  const thr_json *value = thr_json_get(object, "structure");
  char place[256];

  /* An older version wrote none. */
  if (!value) return THR_OK;
  if (evaluation->method != THR_STRUCTURE)
    return thr_field_bad(reader, "structure", "only the method structure finds it");

  snprintf(place, sizeof place, "%.200s.structure", reader->name);
  return thr_standing_from_json(&evaluation->standing, value, evaluation->n_cords, place,
                                reader->err);
}

/* Reads the schedule, and checks that the lists which belong to it are there with it. */
static thr_status read_schedule(const thr_field_reader *reader, const thr_json *object,
                                thr_evaluation *evaluation)
{
  const thr_json *list = thr_json_get(object, "schedule");
  char place[256];

  snprintf(place, sizeof place, "%.200s.schedule", reader->name);
  thr_status st = list ? thr_schedule_from_json(&evaluation->schedule, list, evaluation->n_cords,
                                                place, reader->err)
                       : THR_OK;

  /* Exponents are stated where they cannot be computed from the law. */
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].known &&
        evaluation_exponents(evaluation) != (evaluation->cord[i].exponent != NULL))
      st = thr_field_bad(
          reader, "cords",
          "exponents come with a schedule, or with turns of the tight cord, of all cords that "
          "are known");

  /* The most that may be in a pass is left open only by a schedule. */
  for (int i = 0; i < evaluation->n_cords && !st && !list; i++)
    if (evaluation->cord[i].most)
      st = thr_field_bad(reader, "cords", "tension_most comes with a schedule");

  return st;
}

/* Reads all members of an evaluation. */
static thr_status read_members(const thr_field_reader *reader, const thr_json *object,
                               thr_evaluation *evaluation)
{
  char place[256];
  int method = 0, law = 0;
  thr_err found = {0};
  thr_status st = get_word(reader, object, "method", method_name, THR_N_METHODS, &method);
  if (st) return st;

  /* Only the method capstan has a choice of laws. */
  if (method == THR_CAPSTAN)
    st = get_word(reader, object, "law", law_name, THR_N_LAWS, &law);
  else if (thr_json_get(object, "law"))
    st = thr_field_bad(reader, "law", "only the method capstan goes by a law");

  if (st) return st;
  *evaluation = (thr_evaluation){.present = true,
                                 .method = (thr_method)method,
                                 .law = (thr_law)law,
                                 .physics = thr_physics_default()};

  /* The messages of others become ours: what is wrong is the plan. */
  snprintf(place, sizeof place, "%.200s.physics", reader->name);
  if (thr_physics_from_json(&evaluation->physics, thr_json_get(object, "physics"), place, &found))
    return thr_fail(reader->err, THR_EVIOLATED, "%s", found.text);

  /* Numbers of the whole evaluation. */
  evaluation->seated_known = thr_json_get(object, "seated") != NULL;
  if ((st = thr_fields_read(reader, object, NULL, own_fields, evaluation))) return st;

  /* Cords first, because the others refer to them. */
  if ((st = read_cords(reader, object, evaluation))) return st;
  if ((st = read_standing(reader, object, evaluation))) return st;
  if ((st = read_schedule(reader, object, evaluation))) return st;

  return check_colours(reader, object, evaluation);
}

/* Reads all members into an evaluation of its own, so that a failure leaves none. */
thr_status thr_evaluation_from_json(thr_evaluation *evaluation, const thr_json *object,
                                    const char *place, thr_err *err)
{
  thr_evaluation read = {0};
  const thr_field_reader reader = thr_field_reader_in(place, err);
  thr_status st = thr_json_typeof(object) == THR_JSON_OBJECT
                      ? read_members(&reader, object, &read)
                      : thr_fail(err, THR_EVIOLATED, "%s: not an object", place);

  /* Half of an evaluation is none. */
  if (st) thr_evaluation_destroy(&read);
  *evaluation = read;
  return st;
}
