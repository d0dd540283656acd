/* Members of plan.json, one at a time. */
#include "graph/plan/plan_fields.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

thr_status thr_field_bad(const thr_field_reader *r, const char *place, const char *what)
{
  return thr_fail(r->err, r->code, "%s: %s: %s", r->name, place, what);
}

thr_status thr_field_need(const thr_field_reader *r, const thr_json *o, const char *key, thr_json_type type, const thr_json **v)
{
  static const char *const article[] = {"null", "true or false", "a number", "text", "a list", "an object"};
  *v = thr_json_get(o, key);
  if (*v && thr_json_typeof(*v) == type) return THR_OK;
  return thr_fail(r->err, r->code, "%s: %s: %s; expected %s", r->name, key, *v ? "wrong type" : "missing", article[type]);
}

thr_status thr_field_double(const thr_field_reader *r, const thr_json *o, const char *key, double *out)
{
  if (thr_json_number(thr_json_get(o, key), out)) return THR_OK;
  return thr_field_bad(r, key, "missing or not a finite number");
}

/* A bound, a price or a part: never negative. */
thr_status thr_field_amount(const thr_field_reader *r, const thr_json *o, const char *key, double *out)
{
  thr_status st = thr_field_double(r, o, key, out);
  return !st && *out < 0 ? thr_field_bad(r, key, "negative") : st;
}

thr_status thr_field_int64(const thr_field_reader *r, const thr_json *o, const char *key, int64_t low, int64_t high, int64_t *out)
{
  if (thr_json_int(thr_json_get(o, key), out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(r->err, r->code, "%s: %s: missing or not an integer from %" PRId64 " to %" PRId64, r->name, key, low, high);
}

thr_status thr_field_int(const thr_field_reader *r, const thr_json *o, const char *key, int low, int high, int *out)
{
  int64_t wide = 0;
  thr_status st = thr_field_int64(r, o, key, low, high, &wide);
  *out = (int)wide;
  return st;
}

/* Element i of a list of integers from 0 to limit - 1. place names the list. */
thr_status thr_field_index(const thr_field_reader *r, const thr_json *list, int i, int limit, const char *place, int *out)
{
  int64_t wide;
  const thr_json *v = thr_json_at(list, i);
  if (!thr_json_int(v, &wide)) return thr_fail(r->err, r->code, "%s: %s[%d]: not an integer", r->name, place, i);
  if (wide < 0 || wide >= limit)
    return thr_fail(r->err, r->code, "%s: %s[%d]: %" PRId64 " is out of range; expected 0 to %d", r->name, place, i, wide,
                    limit - 1);
  *out = (int)wide;
  return THR_OK;
}

/* A member that this version does not know may be a claim that nobody checked. known ends with NULL. */
thr_status thr_field_only(const thr_field_reader *r, const thr_json *o, const char *place, const char *const *known)
{
  const char *key = thr_json_unknown(o, known);
  if (!key) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s: %s.%s: this version does not know it and cannot check it", r->name, place, key);
}

/* Text that is one of n names; *out is its number. */
thr_status thr_field_name_of(const thr_field_reader *r, const thr_json *v, const char *place, const char *key, int n,
                             const char *(*name)(int), int *out)
{
  char known[80] = "";
  const char *value = thr_json_string(v);
  for (*out = 0; *out < n; ++*out) {
    if (value && strcmp(value, name(*out)) == 0) return THR_OK;
    size_t length = strlen(known);
    snprintf(known + length, sizeof known - length, "%s%s", *out ? ", " : "", name(*out));
  }
  *out = 0;
  return thr_fail(r->err, r->code, "%s: %s.%s: this version knows %s only", r->name, place, key, known);
}

thr_status thr_field_name(const thr_field_reader *r, const thr_json *o, const char *place, const char *key, int n,
                          const char *(*name)(int), int *out)
{
  return thr_field_name_of(r, thr_json_get(o, key), place, key, n, name, out);
}

/* A number >= 0, or null, which is -1. */
thr_status thr_field_or_null(const thr_field_reader *r, const thr_json *o, const char *key, double *out)
{
  const thr_json *v = thr_json_get(o, key);
  *out = -1;
  if (v && thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  return thr_field_amount(r, o, key, out);
}
