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

#include "graph/plan/plan.h"

#include <inttypes.h>
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

bool thr_evaluation_exponents(const thr_evaluation *evaluation)
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

/* ---- writing ---- */

/* Writes a list of numbers on a line of its own. */
static void put_numbers(thr_writer *writer, const char *key, const double *number, int n)
{
  thr_write_line(writer, 5);
  thr_write_row(writer, key);
  for (int k = 0; k < n; k++)
    thr_write_number(writer, NULL, number[k]);
  thr_write_close(writer);
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
    thr_write_number(writer, "turning", cord->turning);
    thr_write_number(writer, "taut_turning", cord->taut_turning);
    thr_write_line(writer, 5);
    thr_write_number(writer, "force", cord->force);
    thr_write_number(writer, "other_force", cord->other_force);
    thr_write_number(writer, "loss", cord->loss);
    thr_write_number(writer, "work", cord->work);
    thr_write_number(writer, "error", cord->error);
    thr_write_int(writer, "slackest", cord->slackest);
    thr_write_int(writer, "refused", cord->refused);

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
  thr_write_printf(writer, "seed", "%" PRIu64, evaluation->seed);
  thr_write_number(writer, "time_step", evaluation->time_step);
  thr_write_number(writer, "iterations", evaluation->iterations);

  /* What all cords come to. */
  thr_write_number(writer, "largest", evaluation->largest);
  thr_write_number(writer, "total", evaluation->total);
  if (evaluation->seated_known) thr_write_number(writer, "seated", evaluation->seated);

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
    put_cord(writer, &evaluation->cord[i], i, range, thr_evaluation_exponents(evaluation));

  thr_write_line(writer, 2);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* ---- reading: every failure is "place.member: what" ---- */

/* Where an object is, for messages "place.member: what". */
typedef struct {
  const char *place;
  thr_err *err;
} place_reader;

/* Records THR_EVIOLATED about a member. */
static thr_status bad(const place_reader *reader, const char *key, const char *what)
{
  return thr_fail(reader->err, THR_EVIOLATED, "%s.%s: %s", reader->place, key, what);
}

/* Checks that an object has no members but those known; the list ends with NULL. */
static thr_status only_members(const place_reader *reader, const thr_json *object,
                               const char *const *known)
{
  const char *key = thr_json_unknown(object, known);
  return key ? bad(reader, key, "this version does not know it and cannot check it") : THR_OK;
}

/* Reads a member as a finite number. */
static thr_status get_double(const place_reader *reader, const thr_json *object, const char *key,
                             double *out)
{
  return thr_json_number(thr_json_get(object, key), out)
             ? THR_OK
             : bad(reader, key, "missing or not a finite number");
}

/* Reads a member as an integer from 0 to high. */
static thr_status get_int(const place_reader *reader, const thr_json *object, const char *key,
                          int64_t high, int64_t *out)
{
  if (thr_json_int(thr_json_get(object, key), out) && *out >= 0 && *out <= high) return THR_OK;
  return thr_fail(reader->err, THR_EVIOLATED, "%s.%s: missing or not an integer from 0 to %" PRId64,
                  reader->place, key, high);
}

/* Reads a member as one of n words; *out becomes its index. */
static thr_status get_word(const place_reader *reader, const thr_json *object, const char *key,
                           const char *const *word, int n, int *out)
{
  const char *value = thr_json_string(thr_json_get(object, key));
  for (*out = 0; value && *out < n; ++*out)
    if (strcmp(value, word[*out]) == 0) return THR_OK;
  *out = 0;
  return bad(reader, key, value ? "an unknown word" : "missing or not text");
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
static thr_status read_tension(const place_reader *reader, const thr_json *object,
                               thr_eval_cord *cord)
{
  const thr_json *list = thr_json_get(object, "tension"),
                 *colours = thr_json_get(object, "colours");
  int n = thr_json_size(list);

  /* One tension for each pass, and one colour for each tension. */
  if (thr_json_typeof(list) != THR_JSON_ARRAY || n < 1)
    return bad(reader, "tension", "missing or empty");
  if (thr_json_typeof(colours) != THR_JSON_ARRAY || thr_json_size(colours) != n)
    return bad(reader, "colours", "not one per tension");

  if (!(cord->tension = thr_calloc((size_t)n, sizeof *cord->tension)))
    return thr_nomem(reader->err);

  /* Tensions cannot be negative. */
  cord->n_passes = n;
  for (int k = 0; k < n; k++)
    if (!thr_json_number(thr_json_at(list, k), &cord->tension[k]) || !(cord->tension[k] >= 0))
      return thr_fail(reader->err, THR_EVIOLATED, "%s.tension[%d]: not a number from 0 on",
                      reader->place, k);

  return THR_OK;
}

/* Reads a list of n numbers from 0 on into *number, or leaves NULL if there is no such member. */
static thr_status read_numbers(const place_reader *reader, const thr_json *object, const char *key,
                               int n, double **number)
{
  const thr_json *list = thr_json_get(object, key);

  if (!list) return THR_OK;
  if (thr_json_typeof(list) != THR_JSON_ARRAY || thr_json_size(list) != n)
    return bad(reader, key, "not one per pass or turn");

  /* One more, so that n = 0 is no failure. */
  if (!(*number = thr_calloc((size_t)n + 1, sizeof **number))) return thr_nomem(reader->err);

  /* Neither exponents nor tensions can be negative. */
  for (int k = 0; k < n; k++)
    if (!thr_json_number(thr_json_at(list, k), &(*number)[k]) || !((*number)[k] >= 0))
      return thr_fail(reader->err, THR_EVIOLATED, "%s.%s[%d]: not a number from 0 on",
                      reader->place, key, k);

  return THR_OK;
}

/* Reads the record of cord i. */
static thr_status read_cord(const place_reader *reader, const thr_json *object, int i,
                            thr_eval_cord *cord)
{
  static const char *const all[] = {
      "id",      "known",     "pull",  "turning",  "taut_turning", "force",   "other_force",
      "loss",    "work",      "error", "slackest", "refused",      "tension", "tension_most",
      "colours", "exponents", NULL};
  static const char *const unknown[] = {"id", "known", "pull", NULL};

  char name[12];

  /* Which cord it is, whether it is known, and how it was pulled. */
  thr_cord_id(i, name);
  const char *id = thr_json_string(thr_json_get(object, "id"));
  const thr_json *known = thr_json_get(object, "known");
  const int pull = thr_pull_named(thr_json_string(thr_json_get(object, "pull")));
  int64_t slackest = 0, refused = 0;

  /* Records are in the order of the cords. */
  if (!id || strcmp(id, name) != 0)
    return bad(reader, "id", "not the plan's cord with this number");
  if (thr_json_typeof(known) != THR_JSON_BOOL)
    return bad(reader, "known", "missing; expected true or false");

  cord->known = thr_json_true(known);

  /* A cord that is not known has no numbers. */
  thr_status st = only_members(reader, object, cord->known ? all : unknown);
  if (!st && pull < 0) st = bad(reader, "pull", "missing or an unknown word");
  if (st) return st;
  cord->pull = (thr_pull)pull;
  if (!cord->known) return THR_OK;

  /* Numbers first, then lists, whose lengths follow from the first one. */
  const struct {
    const char *key;
    double *to;
  } number[] = {{"turning", &cord->turning}, {"taut_turning", &cord->taut_turning},
                {"force", &cord->force},     {"other_force", &cord->other_force},
                {"loss", &cord->loss},       {"work", &cord->work},
                {"error", &cord->error}};

  for (size_t k = 0; k < sizeof number / sizeof *number && !st; k++)
    st = get_double(reader, object, number[k].key, number[k].to);

  /* The tensions tell how many passes and turns the other lists must have. */
  if (!st) st = read_tension(reader, object, cord);
  if (!st) st = read_numbers(reader, object, "exponents", cord->n_passes - 1, &cord->exponent);
  if (!st) st = read_numbers(reader, object, "tension_most", cord->n_passes, &cord->most);
  if (!st) st = get_int(reader, object, "slackest", cord->n_passes - 1, &slackest);
  if (!st) st = get_int(reader, object, "refused", cord->n_passes - 1, &refused);

  cord->slackest = (int)slackest;
  cord->refused = (int)refused;
  return st;
}

/* Reads the records of all cords. */
static thr_status read_cords(const place_reader *reader, const thr_json *object,
                             thr_evaluation *evaluation)
{
  const thr_json *list = thr_json_get(object, "cords");
  int n = thr_json_size(list);

  /* There is at least one cord. */
  if (thr_json_typeof(list) != THR_JSON_ARRAY || n < 1)
    return bad(reader, "cords", "missing or empty");
  if (!(evaluation->cord = thr_calloc((size_t)n, sizeof *evaluation->cord)))
    return thr_nomem(reader->err);

  evaluation->n_cords = n;

  /* Each record's place is part of the messages. */
  for (int i = 0; i < n; i++) {
    char place[256];
    snprintf(place, sizeof place, "%.200s.cords[%d]", reader->place, i);
    thr_status st = read_cord(&(place_reader){place, reader->err}, thr_json_at(list, i), i,
                              &evaluation->cord[i]);
    if (st) return st;
  }

  return THR_OK;
}

/* Checks the scale and the colours, which are no members of the record in memory, because they
 * follow from the tensions. */
static thr_status check_colours(const place_reader *reader, const thr_json *object,
                                const thr_evaluation *evaluation)
{
  static const char *const known[] = {"low", "high", NULL};
  double range[2], stated[2];
  const thr_json *scale = thr_json_get(object, "scale"), *cords = thr_json_get(object, "cords");
  thr_status st = only_members(reader, scale, known);

  /* Stated, and as it follows from the tensions. */
  if (!st) st = get_double(reader, scale, "low", &stated[0]);
  if (!st) st = get_double(reader, scale, "high", &stated[1]);
  if (st) return st;
  thr_evaluation_range(evaluation, range);

  /* The scale is that of the tensions. */
  if (stated[0] != range[0] || stated[1] != range[1])
    return bad(reader, "scale", "not the least and largest tension");

  /* The colour of every tension. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    const thr_json *colours = thr_json_get(thr_json_at(cords, i), "colours");
    for (int k = 0; evaluation->cord[i].known && k < evaluation->cord[i].n_passes; k++) {
      char hex[8];
      thr_tension_colour(range, evaluation->cord[i].tension[k], hex);
      if (!same_colour(thr_json_string(thr_json_at(colours, k)), hex))
        return thr_fail(reader->err, THR_EVIOLATED,
                        "%s.cords[%d].colours[%d]: expected %s for this tension", reader->place, i,
                        k, hex);
    }
  }

  return THR_OK;
}

/* Reads what the limit analysis found, of method structure only. */
static thr_status read_standing(const place_reader *reader, const thr_json *object,
                                thr_evaluation *evaluation)
{
  const thr_json *value = thr_json_get(object, "structure");
  char place[256];

  /* An older version wrote none. */
  if (!value) return THR_OK;
  if (evaluation->method != THR_STRUCTURE)
    return bad(reader, "structure", "only the method structure finds it");

  snprintf(place, sizeof place, "%.200s.structure", reader->place);
  return thr_standing_from_json(&evaluation->standing, value, evaluation->n_cords, place,
                                reader->err);
}

/* Reads the schedule, and checks that the lists which belong to it are there with it. */
static thr_status read_schedule(const place_reader *reader, const thr_json *object,
                                thr_evaluation *evaluation)
{
  const thr_json *list = thr_json_get(object, "schedule");
  char place[256];

  snprintf(place, sizeof place, "%.200s.schedule", reader->place);
  thr_status st = list ? thr_schedule_from_json(&evaluation->schedule, list, evaluation->n_cords,
                                                place, reader->err)
                       : THR_OK;

  /* Exponents are stated where they cannot be computed from the law. */
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].known &&
        thr_evaluation_exponents(evaluation) != (evaluation->cord[i].exponent != NULL))
      st = bad(reader, "cords",
               "exponents come with a schedule, or with turns of the tight cord, of all cords that "
               "are known");

  /* The most that may be in a pass is left open only by a schedule. */
  for (int i = 0; i < evaluation->n_cords && !st && !list; i++)
    if (evaluation->cord[i].most) st = bad(reader, "cords", "tension_most comes with a schedule");

  return st;
}

/* Reads all members of an evaluation. */
static thr_status read_members(const place_reader *reader, const thr_json *object,
                               thr_evaluation *evaluation)
{
  static const char *const known[] = {"method",     "law",      "physics",   "seed",   "time_step",
                                      "iterations", "largest",  "total",     "seated", "scale",
                                      "cords",      "schedule", "structure", NULL};
  char place[256];
  int method = 0, law = 0;

  int64_t seed = 0;
  thr_err found = {0};
  thr_status st = only_members(reader, object, known);

  if (!st) st = get_word(reader, object, "method", method_name, THR_N_METHODS, &method);
  if (st) return st;

  /* Only the method capstan has a choice of laws. */
  if (method == THR_CAPSTAN)
    st = get_word(reader, object, "law", law_name, THR_N_LAWS, &law);
  else if (thr_json_get(object, "law"))
    st = bad(reader, "law", "only the method capstan goes by a law");

  if (st) return st;
  *evaluation = (thr_evaluation){.present = true,
                                 .method = (thr_method)method,
                                 .law = (thr_law)law,
                                 .physics = thr_physics_default()};

  /* The messages of others become ours: what is wrong is the plan. */
  snprintf(place, sizeof place, "%.200s.physics", reader->place);
  if (thr_physics_from_json(&evaluation->physics, thr_json_get(object, "physics"), place, &found))
    return thr_fail(reader->err, THR_EVIOLATED, "%s", found.text);

  /* Numbers of the whole evaluation. */
  if ((st = get_int(reader, object, "seed", INT64_C(1) << 53, &seed))) return st;
  evaluation->seed = (uint64_t)seed;
  if ((st = get_double(reader, object, "time_step", &evaluation->time_step))) return st;
  if ((st = get_double(reader, object, "iterations", &evaluation->iterations))) return st;
  if ((st = get_double(reader, object, "largest", &evaluation->largest))) return st;

  if ((st = get_double(reader, object, "total", &evaluation->total))) return st;
  evaluation->seated_known = thr_json_get(object, "seated") != NULL;
  if (evaluation->seated_known && (st = get_double(reader, object, "seated", &evaluation->seated)))
    return st;

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
  const place_reader reader = {place, err};
  thr_status st = thr_json_typeof(object) == THR_JSON_OBJECT
                      ? read_members(&reader, object, &read)
                      : thr_fail(err, THR_EVIOLATED, "%s: not an object", place);

  /* Half of an evaluation is none. */
  if (st) thr_evaluation_destroy(&read);
  *evaluation = read;
  return st;
}
