/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads members of the JSON objects of plan.json, and says what is wrong with them as "file: place:
 * what"; writes and reads whole objects by tables of their members. Private to the files that write
 * and read plans.
 *
 * Every reader but thr_field_only fails with the code of the thr_field_reader, so that the same
 * mistake is THR_EINPUT in the options and THR_EVIOLATED in a proof.
 *
 * Example: thr_field_int(reader, object, "cover", 1, 100, &n) of {"cover": 0} gives
 * plan.json: cover: missing or not an integer from 1 to 100. */
#include "graph/number.h"
#include "graph/plan/plan_fields.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

thr_field_reader thr_field_reader_in(const char *place, thr_err *err)
{
  return (thr_field_reader){.name = place, .code = THR_EVIOLATED, .err = err, .in_object = true};
}

thr_status thr_field_bad(const thr_field_reader *field_reader, const char *place, const char *what)
{
  return thr_fail(field_reader->err, field_reader->code, "%s%s%s: %s", field_reader->name,
                  field_reader->in_object ? "." : ": ", place, what);
}

thr_status thr_field_need(const thr_field_reader *field_reader, const thr_json *object,
                          const char *key, thr_json_type type, const thr_json **value)
{
  static const char *const article[] = {"null", "true or false", "a number",
                                        "text", "a list",        "an object"};

  /* The words are in the order of thr_json_type. */
  *value = thr_json_get(object, key);
  if (*value && thr_json_typeof(*value) == type) return THR_OK;
  if (field_reader->all_there && type == THR_JSON_ARRAY)
    return thr_field_bad(field_reader, key, "not a list");

  return thr_fail(field_reader->err, field_reader->code, "%s: %s: %s; expected %s",
                  field_reader->name, key, *value ? "wrong type" : "missing", article[type]);
}

thr_status thr_field_double(const thr_field_reader *field_reader, const thr_json *object,
                            const char *key, double *out)
{
  if (!thr_json_number(thr_json_get(object, key), out))
    return thr_field_bad(field_reader, key, "missing or not a finite number");
  *out += 0.0; /* -0.0 is 0 */
  return THR_OK;
}

/* Reads a bound, a price or a part, which is never negative. */
thr_status thr_field_amount(const thr_field_reader *field_reader, const thr_json *object,
                            const char *key, double *out)
{
  thr_status st = thr_field_double(field_reader, object, key, out);
  return !st && *out < 0 ? thr_field_bad(field_reader, key, "negative") : st;
}

thr_status thr_field_int64_of(const thr_field_reader *field_reader, const thr_json *value,
                              const char *key, int64_t low, int64_t high, int64_t *out)
{
  if (thr_json_int(value, out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(field_reader->err, field_reader->code,
                  "%s%s%s: %snot an integer from %" PRId64 " to %" PRId64, field_reader->name,
                  field_reader->in_object ? "." : ": ", key,
                  field_reader->all_there ? "" : "missing or ", low, high);
}

thr_status thr_field_int64(const thr_field_reader *field_reader, const thr_json *object,
                           const char *key, int64_t low, int64_t high, int64_t *out)
{
  return thr_field_int64_of(field_reader, thr_json_get(object, key), key, low, high, out);
}

thr_status thr_field_int(const thr_field_reader *field_reader, const thr_json *object,
                         const char *key, int low, int high, int *out)
{
  int64_t wide = 0;
  thr_status st = thr_field_int64(field_reader, object, key, low, high, &wide);
  *out = (int)wide;
  return st;
}

/* Reads element i of a list of integers from 0 to limit - 1. place names the list. */
thr_status thr_field_index(const thr_field_reader *field_reader, const thr_json *list, int i,
                           int limit, const char *place, int *out)
{
  int64_t wide;
  const thr_json *value = thr_json_at(list, i);

  if (!thr_json_int(value, &wide))
    return thr_fail(field_reader->err, field_reader->code, "%s: %s[%d]: not an integer",
                    field_reader->name, place, i);

  /* Indices count from 0. */
  if (wide < 0 || wide >= limit)
    return thr_fail(field_reader->err, field_reader->code,
                    "%s: %s[%d]: %" PRId64 " is out of range; expected 0 to %d", field_reader->name,
                    place, i, wide, limit - 1);

  *out = (int)wide;

  return THR_OK;
}

void *thr_field_list(const thr_field_reader *field_reader, const thr_json *object, const char *key,
                     size_t size, int *count, const thr_json **list, thr_status *st)
{
  void *elements = NULL;
  if ((*st = thr_field_need(field_reader, object, key, THR_JSON_ARRAY, list))) return NULL;

  if ((elements = thr_calloc((size_t)thr_json_size(*list), size)))
    *count = thr_json_size(*list);
  else
    *st = thr_nomem(field_reader->err);
  return elements;
}

thr_status thr_field_indices(const thr_field_reader *field_reader, const thr_json *list, int n,
                             int limit, const char *place, int *out)
{
  if (thr_json_indices(list, n, limit, out)) return THR_OK;

  /* Read one by one only to say which element is wrong. */
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = thr_field_index(field_reader, list, i, limit, place, &out[i]);
  return st;
}

/* Refuses a member, key, of the object at `place`, or of the reader's own (NULL). */
static thr_status bad_member(const thr_field_reader *field_reader, const char *place,
                             const char *key, const char *what)
{
  char member[80];
  if (!place) return thr_field_bad(field_reader, key, what);
  snprintf(member, sizeof member, "%s.%s", place, key);
  return thr_field_bad(field_reader, member, what);
}

/* Refuses a member that is not known, whatever the reader's code; key NULL: there is none. */
static thr_status refuse_unknown(const thr_field_reader *field_reader, const char *place,
                                 const char *key)
{
  thr_field_reader violated = *field_reader;
  violated.code = THR_EVIOLATED;
  return key ? bad_member(&violated, place, key,
                          "this version does not know it and cannot check it")
             : THR_OK;
}

/* Refuses members that are not among `known`, which ends with NULL. A member that this version does
 * not know may be a claim that nobody checks. */
thr_status thr_field_only(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const char *const *known)
{
  return refuse_unknown(field_reader, place, thr_json_unknown(object, known));
}

/* Reads a text that is one of n names; *out becomes its number. */
thr_status thr_field_name_of(const thr_field_reader *field_reader, const thr_json *value,
                             const char *place, const char *key, int n, const char *(*name)(int),
                             int *out)
{
  char known[80] = "";
  const char *text = thr_json_string(value);

  /* Collect the names on the way, for the message. */
  for (*out = 0; *out < n; ++*out) {
    if (text && strcmp(text, name(*out)) == 0) return THR_OK;
    size_t length = strlen(known);
    snprintf(known + length, sizeof known - length, "%s%s", *out ? ", " : "", name(*out));
  }

  /* The first name is a valid number for callers that go on. */
  *out = 0;

  return thr_fail(field_reader->err, field_reader->code, "%s: %s.%s: this version knows %s only",
                  field_reader->name, place, key, known);
}

thr_status thr_field_name(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const char *key, int n, const char *(*name)(int),
                          int *out)
{
  return thr_field_name_of(field_reader, thr_json_get(object, key), place, key, n, name, out);
}

/* Reads a number of at least 0, or null, which becomes -1. */
static thr_status field_or_null(const thr_field_reader *field_reader, const thr_json *object,
                                const char *key, double *out)
{
  const thr_json *value = thr_json_get(object, key);
  *out = -1;
  if (value && thr_json_typeof(value) == THR_JSON_NULL) return THR_OK;
  return thr_field_amount(field_reader, object, key, out);
}

/* ---- tables ---- */

enum { MOST_FIELDS = 20 };

const char *thr_status_name(int optimal)
{
  return optimal ? "optimal" : "bound";
}

const char *thr_fields_unknown(const thr_json *object, const thr_field *fields)
{
  const char *known[MOST_FIELDS + 1] = {NULL};
  for (int i = 0; i < MOST_FIELDS && fields[i].key; i++)
    known[i] = fields[i].key;
  return thr_json_unknown(object, known);
}

/* Reads a value by the kind of its row. */
static thr_status read_value(const thr_field_reader *field_reader, const thr_json *object,
                             const char *place, const thr_field *field, void *to)
{
  const thr_json *member = thr_json_get(object, field->key);
  void *value = (char *)to + field->offset;
  const bool is_count = field->kind == THR_FIELD_COUNT;
  int64_t high = field->high ? field->high : is_count ? INT32_MAX : INT64_MAX;
  thr_status st = THR_OK;
  int status = 0, below = 0;

  /* The range may depend on another member. */
  if (field->below) memcpy(&below, (char *)to + field->below, sizeof below);
  if (field->below) high = below - 1;

  switch (field->kind) {
  case THR_FIELD_COUNT:
    return thr_field_int(field_reader, object, field->key, (int)field->low, (int)high, value);
  case THR_FIELD_WHOLE:
    return thr_field_int64(field_reader, object, field->key, field->low, high, value);
  case THR_FIELD_NUMBER: return thr_field_double(field_reader, object, field->key, value);
  case THR_FIELD_AMOUNT: return thr_field_amount(field_reader, object, field->key, value);
  case THR_FIELD_OR_NULL: return field_or_null(field_reader, object, field->key, value);
  case THR_FIELD_TRUTH:
    st = thr_field_need(field_reader, object, field->key, THR_JSON_BOOL, &member);
    *(bool *)value = thr_json_true(member);
    return st;
  case THR_FIELD_STATUS:
    st = thr_field_name(field_reader, object, place, field->key, 2, thr_status_name, &status);
    *(bool *)value = status == 1;
    return st;
  case THR_FIELD_WORD:
    return thr_field_name(field_reader, object, place, field->key, field->n_names, field->name,
                          value);
  default: break;
  }

  return THR_OK;
}

/* Reads the members of a row that is an object. */
static thr_status read_object(const thr_field_reader *field_reader, const thr_json *object,
                              const char *place, const thr_field *field, void *to)
{
  char inner[80];
  const thr_json *value = thr_json_get(object, field->key);
  thr_status st = field->when
                      ? THR_OK
                      : thr_field_need(field_reader, object, field->key, THR_JSON_OBJECT, &value);
  snprintf(inner, sizeof inner, "%s.%s", place, field->key);
  return st ? st : thr_fields_read(field_reader, value, inner, field->fields, to);
}

thr_status thr_field_read(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const thr_field *field, void *to)
{
  const bool is_there = thr_json_get(object, field->key) != NULL;

  /* Whether it has to be there. */
  if (field->with && field->when(to) != is_there)
    return bad_member(field_reader, place, field->key, field->with);
  if (!is_there && (field->optional || field->when)) return THR_OK;
  if (field->kind == THR_FIELD_OBJECT) return read_object(field_reader, object, place, field, to);

  /* The first message stays, and so a row with words of its own is read without any. */
  thr_field_reader reader = *field_reader;
  if (field->wrong) reader.err = NULL;
  thr_status st = read_value(&reader, object, place, field, to);

  return st && field->wrong ? bad_member(field_reader, place, field->key, field->wrong) : st;
}

/* Checks that an object has all members that may not be left out. */
static thr_status check_all_there(const thr_field_reader *field_reader, const thr_json *object,
                                  const thr_field *fields)
{
  if (thr_json_typeof(object) != THR_JSON_OBJECT)
    return thr_fail(field_reader->err, field_reader->code, "%s: expected an object",
                    field_reader->name);

  for (; fields->key; fields++)
    if (!fields->optional && !thr_json_get(object, fields->key))
      return thr_field_bad(field_reader, fields->key, "missing");
  return THR_OK;
}

thr_status thr_fields_read(const thr_field_reader *field_reader, const thr_json *object,
                           const char *place, const thr_field *fields, void *to)
{
  thr_status st = field_reader->all_there ? check_all_there(field_reader, object, fields) : THR_OK;
  if (!st) st = refuse_unknown(field_reader, place, thr_fields_unknown(object, fields));
  for (; fields->key && !st; fields++)
    st = thr_field_read(field_reader, object, place, fields, to);
  return st;
}

double thr_field_number(const thr_field *field, const void *from)
{
  const void *value = (const char *)from + field->offset;
  switch (field->kind) {
  case THR_FIELD_COUNT:
  case THR_FIELD_WORD: return *(const int *)value;
  case THR_FIELD_WHOLE: return (double)*(const int64_t *)value;
  case THR_FIELD_NUMBER:
  case THR_FIELD_AMOUNT:
  case THR_FIELD_OR_NULL: return *(const double *)value;
  case THR_FIELD_TRUTH:
  case THR_FIELD_STATUS: return *(const bool *)value;
  default: break;
  }
  return 0;
}

/* Writes the member of a row, unless it is left out. */
static void write_field(thr_writer *writer, const thr_field *field, const void *from)
{
  const void *value = (const char *)from + field->offset;
  const double number = thr_field_number(field, from);
  const char *key = field->key;

  /* A member that is left out leaves its line to the next one. */
  if (field->line) thr_write_line(writer, field->line);
  if ((field->when && !field->when(from)) ||
      (field->optional && !(isfinite(number) && number > field->unsaid)))
    return;

  switch (field->kind) {
  case THR_FIELD_COUNT: thr_write_int(writer, key, *(const int *)value); break;
  case THR_FIELD_WHOLE: thr_write_int(writer, key, *(const int64_t *)value); break;
  case THR_FIELD_NUMBER:
  case THR_FIELD_AMOUNT: thr_write_number(writer, key, number); break;
  case THR_FIELD_OR_NULL: thr_write_number(writer, key, number < 0 ? NAN : number); break;
  case THR_FIELD_TRUTH: thr_write_bool(writer, key, number != 0); break;
  case THR_FIELD_STATUS: thr_write_string(writer, key, thr_status_name(number != 0)); break;
  case THR_FIELD_WORD: thr_write_string(writer, key, field->name((int)number)); break;
  case THR_FIELD_OBJECT:
    thr_write_object(writer, key);
    thr_fields_write(writer, field->fields, from);
    thr_write_close(writer);
    break;
  default: break;
  }
}

void thr_fields_write(thr_writer *writer, const thr_field *fields, const void *from)
{
  for (; fields->key; fields++)
    write_field(writer, fields, from);
}

/* ---- objects of a plan ---- */

static bool wants_distinct(const void *plan)
{
  return ((const thr_plan *)plan)->options.distinct > 0;
}

static bool wants_crossings(const void *plan)
{
  return ((const thr_plan *)plan)->options.crossings != THR_CROSSINGS_ALLOW;
}

/* Two metrics are there if and only if the options ask about them. */
const thr_field thr_metrics_fields[] = {
    {"length", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.length)},
    {"base_length", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.base_length)},
    {"overlap", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.overlap)},
    {"passes", THR_FIELD_COUNT, .offset = offsetof(thr_plan, metrics.passes)},
    {"most_passes", THR_FIELD_COUNT, .offset = offsetof(thr_plan, metrics.most_passes)},
    {"distinct", THR_FIELD_COUNT, .offset = offsetof(thr_plan, metrics.distinct),
     .when = wants_distinct, .with = "goes with options.distinct"},
    {"crossings", THR_FIELD_COUNT, .offset = offsetof(thr_plan, metrics.crossings),
     .when = wants_crossings, .with = "goes with options.crossings", .line = 2},
    {"turning", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.turning)},
    {"max_turning", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.max_turning)},
    {"worst_turn", THR_FIELD_NUMBER, .offset = offsetof(thr_plan, metrics.worst_turn)},
    {"u_turns", THR_FIELD_COUNT, .offset = offsetof(thr_plan, metrics.u_turns)},
    {0}};

/* What is claimed about all turns together, and about the cord that turns most. */
static const thr_field largest_fields[] = {
    {"status", THR_FIELD_STATUS, .offset = offsetof(thr_plan, turning.largest_optimal)},
    {"price", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.largest)},
    {"lower_bound", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.largest_bound)},
    {"cut", THR_FIELD_WHOLE, .offset = offsetof(thr_plan, turning.cut), .optional = true, .low = 1,
     .high = (int64_t)(THR_PI * (1 << 22) * (1 << 22)),
     .wrong = "not a turn of at most 180 degrees in units of 2^-44"},
    {0}};

/* Only older plans state pairing_bound. */
const thr_field thr_turning_claim_fields[] = {
    {"status", THR_FIELD_STATUS, .offset = offsetof(thr_plan, turning.optimal)},
    {"price", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.price)},
    {"lower_bound", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.lower_bound)},
    {"gap", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.gap)},
    {"pairing_bound", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, turning.pairing_bound),
     .optional = true, .unsaid = INFINITY},
    {"largest", THR_FIELD_OBJECT, .fields = largest_fields, .line = 2},
    {"most_passes", THR_FIELD_COUNT, .offset = offsetof(thr_plan, turning.most_passes), .low = 1,
     .line = 2},
    {"length_limit", THR_FIELD_OR_NULL, .offset = offsetof(thr_plan, turning.length_limit)},
    {.key = "method"},
    {.key = "proof"},
    {0}};

/* What is claimed about the longest cord and, if few were asked for, the number of cords. */
static const thr_field longest_fields[] = {
    {"status", THR_FIELD_STATUS, .offset = offsetof(thr_plan, cords_claim.longest_optimal)},
    {"length", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, cords_claim.longest)},
    {"lower_bound", THR_FIELD_AMOUNT, .offset = offsetof(thr_plan, cords_claim.longest_bound)},
    {0}};
static const thr_field fewest_fields[] = {
    {"status", THR_FIELD_STATUS, .offset = offsetof(thr_plan, cords_claim.fewest_optimal)},
    {"lower_bound", THR_FIELD_COUNT, .offset = offsetof(thr_plan, cords_claim.fewest), .low = 1},
    {0}};

static bool claims_fewest(const void *plan)
{
  return ((const thr_plan *)plan)->cords_claim.fewest > 0;
}

const thr_field thr_cords_claim_fields[] = {
    {"longest", THR_FIELD_OBJECT, .fields = longest_fields},
    {"fewest", THR_FIELD_OBJECT, .fields = fewest_fields, .when = claims_fewest},
    {.key = "walks"},
    {.key = "sets"},
    {0}};

/* A packing of odd cuts; the component, which comes first, is below the number of nodes. What a
 * negative price means the checker says. */
const thr_field thr_certificate_fields[] = {
    {.key = "component"},
    {"scale", THR_FIELD_NUMBER, .offset = offsetof(thr_certificate, scale)},
    {"denominator", THR_FIELD_WHOLE, .offset = offsetof(thr_certificate, denominator), .low = 1,
     .high = INT64_C(1) << 40},
    {"end_price", THR_FIELD_WHOLE, .offset = offsetof(thr_certificate, end_price)},
    {"join", THR_FIELD_WHOLE, .offset = offsetof(thr_certificate, join), .high = INT64_C(1) << 60},
    {"sum", THR_FIELD_WHOLE, .offset = offsetof(thr_certificate, sum)},
    {.key = "cuts"},
    {.key = "place_prices"},
    {0}};
