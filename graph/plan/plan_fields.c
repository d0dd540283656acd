/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads single members of the JSON objects of plan.json, and says what is wrong with them as "file:
 * place: what". Private to the files that read plans.
 *
 * Every reader but thr_field_only fails with the code of the thr_field_reader, so that the same
 * mistake is THR_EINPUT in the options and THR_EVIOLATED in a proof.
 *
 * Example: thr_field_int(reader, object, "cover", 1, 100, &n) of {"cover": 0} gives
 * plan.json: cover: missing or not an integer from 1 to 100. */
#include "graph/plan/plan_fields.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

thr_status thr_field_bad(const thr_field_reader *field_reader, const char *place, const char *what)
{
  return thr_fail(field_reader->err, field_reader->code, "%s: %s: %s", field_reader->name, place,
                  what);
}

thr_status thr_field_need(const thr_field_reader *field_reader, const thr_json *object,
                          const char *key, thr_json_type type, const thr_json **value)
{
  static const char *const article[] = {"null", "true or false", "a number",
                                        "text", "a list",        "an object"};

  /* The words are in the order of thr_json_type. */
  *value = thr_json_get(object, key);
  if (*value && thr_json_typeof(*value) == type) return THR_OK;

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

thr_status thr_field_int64(const thr_field_reader *field_reader, const thr_json *object,
                           const char *key, int64_t low, int64_t high, int64_t *out)
{
  if (thr_json_int(thr_json_get(object, key), out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(field_reader->err, field_reader->code,
                  "%s: %s: missing or not an integer from %" PRId64 " to %" PRId64,
                  field_reader->name, key, low, high);
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

/* Refuses members that are not among `known`, which ends with NULL. A member that this version does
 * not know may be a claim that nobody checks. */
thr_status thr_field_only(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const char *const *known)
{
  const char *key = thr_json_unknown(object, known);
  if (!key) return THR_OK;
  return thr_fail(field_reader->err, THR_EVIOLATED,
                  "%s: %s.%s: this version does not know it and cannot check it",
                  field_reader->name, place, key);
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
thr_status thr_field_or_null(const thr_field_reader *field_reader, const thr_json *object,
                             const char *key, double *out)
{
  const thr_json *value = thr_json_get(object, key);
  *out = -1;
  if (value && thr_json_typeof(value) == THR_JSON_NULL) return THR_OK;
  return thr_field_amount(field_reader, object, key, out);
}
