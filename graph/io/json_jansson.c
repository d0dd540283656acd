/* The only file that knows jansson. A thr_json is a json_t under another name. */
#include "graph/io/json.h"
#include "graph/status.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const json_t *peek(const thr_json *value)
{
  return (const json_t *)(const void *)value;
}

static const thr_json *wrap(const json_t *v)
{
  return (const thr_json *)(const void *)v;
}

static _Thread_local bool ran_out; /* of memory, since the last parse began */

/* jansson's memory comes from where all memory comes from, so that tests can make it fail. */
static void *allocate(size_t n)
{
  void *p = thr_calloc(n, 1);
  if (!p) ran_out = true;
  return p;
}

/* Not every failed allocation sets jansson's error code: some leave it unknown, some come out as an invalid token. */
static thr_status not_parsed(const json_error_t *at, const char *name, thr_err *err)
{
  if (ran_out || json_error_code(at) == json_error_out_of_memory) return thr_nomem(err);
  return thr_fail(err, THR_EINPUT, "%s:%d:%d: not valid JSON: %s", name, at->line > 0 ? at->line : 1,
                  at->column > 0 ? at->column : 1, at->text);
}

thr_status thr_json_parse(thr_json **doc, const char *text, size_t n, const char *name, thr_err *err)
{
  *doc = NULL;
  if (n >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) { /* byte-order mark, as Windows editors leave it */
    text += 3;
    n -= 3;
  }
  size_t blank = 0; /* the text need not end in NUL */
  while (blank < n && strchr(" \t\r\n", text[blank]) && text[blank])
    blank++;
  if (blank == n) return thr_fail(err, THR_EINPUT, "%s:1: the file is empty", name);
  json_error_t at;
  ran_out = false;
  json_set_alloc_funcs(allocate, free);
  json_t *value = json_loadb(text, n, JSON_REJECT_DUPLICATES, &at);
  if (value && ran_out) { /* what could not be kept may be missing */
    json_decref(value);
    value = NULL;
  }
  if (!value) return not_parsed(&at, name, err);
  *doc = (thr_json *)(void *)value;
  return THR_OK;
}

void thr_json_destroy(thr_json *doc)
{
  json_decref((json_t *)(void *)doc);
}

thr_json_type thr_json_typeof(const thr_json *value)
{
  if (!value) return THR_JSON_NULL;
  switch (json_typeof(peek(value))) {
  case JSON_OBJECT: return THR_JSON_OBJECT;
  case JSON_ARRAY: return THR_JSON_ARRAY;
  case JSON_STRING: return THR_JSON_STRING;
  case JSON_INTEGER:
  case JSON_REAL: return THR_JSON_NUMBER;
  case JSON_TRUE:
  case JSON_FALSE: return THR_JSON_BOOL;
  default: return THR_JSON_NULL;
  }
}

const thr_json *thr_json_get(const thr_json *object, const char *key)
{
  return object ? wrap(json_object_get(peek(object), key)) : NULL;
}

int thr_json_size(const thr_json *value)
{
  if (!value) return 0;
  return (int)(json_is_array(peek(value)) ? json_array_size(peek(value)) : json_object_size(peek(value)));
}

const thr_json *thr_json_at(const thr_json *array, int i)
{
  return array && i >= 0 ? wrap(json_array_get(peek(array), (size_t)i)) : NULL;
}

const char *thr_json_string(const thr_json *value)
{
  return value ? json_string_value(peek(value)) : NULL;
}

bool thr_json_number(const thr_json *value, double *out)
{
  if (!value || !json_is_number(peek(value))) return false;
  double x = json_number_value(peek(value));
  if (!isfinite(x)) return false;
  *out = x;
  return true;
}

bool thr_json_int(const thr_json *value, int64_t *out)
{
  if (value && json_is_integer(peek(value))) {
    *out = (int64_t)json_integer_value(peek(value));
    return true;
  }
  double x;
  if (!thr_json_number(value, &x) || x != floor(x) || fabs(x) > 9007199254740992.0) return false;
  *out = (int64_t)x;
  return true;
}

bool thr_json_true(const thr_json *value)
{
  double x;
  return value && (json_is_true(peek(value)) || (thr_json_number(value, &x) && x != 0));
}

bool thr_json_next(const thr_json *object, void **iter, const char **key, const thr_json **value)
{
  if (!object || !json_is_object(peek(object))) return false;
  json_t *o = (json_t *)(void *)(size_t)peek(object);
  *iter = *iter ? json_object_iter_next(o, *iter) : json_object_iter(o);
  if (!*iter) return false;
  *key = json_object_iter_key(*iter);
  *value = wrap(json_object_iter_value(*iter));
  return true;
}

const char *thr_json_unknown(const thr_json *object, const char *const *known)
{
  void *iter = NULL;
  const char *key;
  const thr_json *value;
  while (thr_json_next(object, &iter, &key, &value)) {
    int i = 0;
    while (known[i] && strcmp(known[i], key) != 0)
      i++;
    if (!known[i]) return key;
  }
  return NULL;
}
