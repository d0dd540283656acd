/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values and names in JSON frameworks. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <string.h>

static size_t write_path(const thr_json_where *at, char *out, size_t size)
{
  if (!at || !at->up) return 0;
  size_t n = write_path(at->up, out, size);
  bool plain =
      at->key && *at->key &&
      strspn(at->key, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_") == strlen(at->key);
  int length = !at->key ? snprintf(out + n, size - n, "[%d]", at->index)
               : plain  ? snprintf(out + n, size - n, "%s%.60s", n ? "." : "", at->key)
                        : snprintf(out + n, size - n, "[\"%.60s\"]", at->key);
  if (length > 0) n += (size_t)length;
  return n < size ? n : size - 1;
}

thr_status thr_json_bad(thr_json_reader *r, const thr_json_where *at, const char *what)
{
  char path[240] = "";
  write_path(at, path, sizeof path);
  return thr_fail(r->err, THR_EINPUT, "%s: %s: %s", r->file, *path ? path : "document", what);
}

bool thr_json_is_array(const thr_json *v)
{
  return thr_json_typeof(v) == THR_JSON_ARRAY;
}
bool thr_json_is_object(const thr_json *v)
{
  return thr_json_typeof(v) == THR_JSON_OBJECT;
}

const thr_json *thr_json_member(const thr_json *object, const char *const *keys, const char **which)
{
  *which = keys[0];
  for (; *keys; keys++) {
    const thr_json *v = thr_json_get(object, *keys);
    if (!v) continue;
    *which = *keys;
    return v;
  }
  return NULL;
}

/* ---- values ---- */

static thr_status read_number(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                              double *x)
{
  if (!v) return thr_json_bad(r, at, "missing; give a number");
  if (thr_json_typeof(v) == THR_JSON_NAN)
    return thr_json_bad(r, at, "Python wrote NaN or Infinity; give a number or null");
  const bool text = thr_json_string(v) &&
                    thr_span_number(thr_span_trim(thr_span_of(thr_json_string(v))), false, x);
  if (!text && !thr_json_number(v, x))
    return thr_json_bad(r, at, "not a number; give a decimal number");
  if (*x == 0) *x = 0; /* -0 and 0 are written alike */
  return THR_OK;
}

thr_status thr_json_point(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                          const thr_json *defaults, double xyz[3])
{
  static const char *const letter[] = {"x", "y", "z"}, *const capital[] = {"X", "Y", "Z"};
  if (thr_json_numbers(v, 3, xyz)) {
    for (int i = 0; i < 3; i++)
      if (xyz[i] == 0) xyz[i] = 0; /* -0, as below */
    r->has_z = true;
    return THR_OK;
  }
  if (!thr_json_is_array(v) && !thr_json_is_object(v))
    return thr_json_bad(r, at, "no coordinates; give [x, y, z]");
  for (int i = 0; i < 3; i++) {
    const char *which = NULL;
    const thr_json *c = thr_json_is_array(v) ? thr_json_at(v, i)
                                             : THR_JSON_MEMBER(v, &which, letter[i], capital[i]);
    if (!c) c = thr_json_get(defaults, letter[i]);
    thr_json_where here = {at, which, i};
    xyz[i] = 0;
    if (i == 2 && !c) continue;
    r->has_z |= i == 2;
    thr_status st = read_number(r, &here, c, &xyz[i]);
    if (st) return st;
  }
  return THR_OK;
}

thr_status thr_json_length(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                           double *length)
{
  *length = 0;
  if (thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  thr_status st = read_number(r, at, v, length);
  return st || *length > 0
             ? st
             : thr_json_bad(
                   r, at,
                   "a length that is not positive; leave it out for the distance of the two nodes");
}

/* A number of passes; text: as text, too. */
static thr_status count_of(const thr_json *v, const char *what, bool text, int *count, thr_err *err)
{
  int64_t wide = 0;
  *count = 0;
  if (text && thr_json_string(v) &&
      thr_span_int(thr_span_trim(thr_span_of(thr_json_string(v))), count) && *count >= 0 &&
      *count <= 100)
    return THR_OK;
  if (thr_json_typeof(v) != THR_JSON_NULL && (!thr_json_int(v, &wide) || wide < 0 || wide > 100))
    return thr_fail(err, THR_EINPUT, "a %s that is not a whole number up to 100", what);
  *count = (int)wide;
  return THR_OK;
}

static thr_status take_passes(thr_draft *draft, const thr_json *cover, const thr_json *capacity,
                              bool text, thr_err *err)
{
  int least = 0, most = 0;
  thr_status st = count_of(cover, "cover", text, &least, err);
  if (!st) st = count_of(capacity, "capacity", text, &most, err);
  return st ? st : thr_draft_edge_passes(draft, least, most, err);
}

thr_status thr_json_edge_passes(thr_draft *draft, const thr_json *cover, const thr_json *capacity,
                                thr_err *err)
{
  return take_passes(draft, cover, capacity, false, err);
}

thr_status thr_json_passes(thr_json_reader *r, const thr_json_where *at, const thr_json *cover,
                           const thr_json *capacity)
{
  thr_err why = {0};
  thr_status st = take_passes(r->d, cover, capacity, true, &why);
  return st ? thr_json_bad(r, at, why.text) : THR_OK;
}

thr_status thr_json_index(thr_json_reader *r, const thr_json_where *at, const thr_json *v, int n,
                          int *index)
{
  int64_t i;
  if (!thr_json_int(v, &i)) return thr_json_bad(r, at, "not a node number; count nodes from 0");
  if (i >= 0 && i < n) {
    *index = (int)i;
    return THR_OK;
  }
  char what[80];
  snprintf(what, sizeof what, "there is no node %lld; the %d nodes count from 0", (long long)i, n);
  return thr_json_bad(r, at, what);
}

thr_status thr_json_units(thr_json_reader *r, const thr_json_where *up, const char *key,
                          const thr_json *v)
{
  thr_json_where here = {up, key, 0};
  thr_err why = {0};
  if (thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  if (!thr_json_string(v)) return thr_json_bad(r, &here, "not text; name a unit of length");
  return thr_draft_set_units(r->d, thr_json_string(v), &why) ? thr_json_bad(r, &here, why.text)
                                                             : THR_OK;
}

/* ---- names ---- */

/* Appends a name without the quotes of a Python string. */
static void append_key(thr_text *text, const char *key)
{
  size_t n = strlen(key);
  bool quoted = n >= 2 && (key[0] == '\'' || key[0] == '"') && key[n - 1] == key[0];
  thr_text_append_bytes(text, key + quoted, n - 2 * (size_t)quoted);
}

static void append_name(thr_text *text, const thr_json *v)
{
  int64_t whole;
  double x;
  if (thr_json_string(v))
    thr_text_append(text, thr_json_string(v));
  else if (thr_json_int(v, &whole))
    thr_text_printf(text, "%lld", (long long)whole);
  else if (thr_json_number(v, &x))
    thr_text_double(text, x);
}

thr_status thr_json_name_of(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                            const char **name)
{
  thr_text *text = &r->scratch;
  text->length = 0;
  thr_text_append(text, "");
  if (thr_json_is_array(v)) {
    thr_text_append(text, "(");
    for (int i = 0; i < thr_json_size(v); i++) {
      thr_text_append(text, i ? ", " : "");
      append_name(text, thr_json_at(v, i));
    }
    thr_text_append(text, ")");
  } else {
    append_name(text, v);
  }
  if (text->failed) return thr_nomem(r->err);
  thr_text_clean(text->data); /* as the draft keeps it */
  *name = text->data;
  return text->length ? THR_OK
                      : thr_json_bad(r, at, "not a node's name; use a string or a whole number");
}

thr_status thr_json_key_name(thr_json_reader *r, const thr_json_where *at, const char *key,
                             const char **name)
{
  thr_text *text = &r->scratch;
  text->length = 0;
  thr_text_append(text, "");
  append_key(text, key);
  if (text->failed) return thr_nomem(r->err);
  thr_text_clean(text->data);
  *name = text->data;
  return text->length ? THR_OK : thr_json_bad(r, at, "an empty name");
}

thr_status thr_json_find_node(thr_json_reader *r, const thr_json_where *at, const char *name,
                              int *node)
{
  *node = thr_names_find(&r->names, thr_span_of(name));
  if (*node >= 0) return THR_OK;
  char what[120];
  snprintf(what, sizeof what, "there is no node '%.60s'", name);
  return thr_json_bad(r, at, what);
}

thr_status thr_json_reference(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                              int *node)
{
  const char *name;
  if (!v) return thr_json_bad(r, at, "missing; name a node");
  thr_status st = thr_json_name_of(r, at, v, &name);
  return st ? st : thr_json_find_node(r, at, name, node);
}
