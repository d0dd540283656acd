/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads values and names in JSON frameworks: coordinates, lengths, passes, indices, units, and what
 * nodes are called. Every failure names the path to the value, such as data.node["21"].x, and what
 * to give instead.
 *
 * Foreign programs write numbers as text, nodes as strings, numbers or tuples, and keys in upper or
 * lower case; all of these are understood here, so that the readers need not know them. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <string.h>

/* Writes the path to a value, from the document on, and returns its length. Keys of letters are
 * written as members, other ones in brackets. */
static size_t write_path(const thr_json_where *at, char *out, size_t size)
{
  if (!at || !at->up) return 0;
  size_t n = write_path(at->up, out, size);

  /* The path above comes first. */
  bool plain =
      at->key && *at->key &&
      strspn(at->key, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_") == strlen(at->key);
  int length = !at->key ? snprintf(out + n, size - n, "[%d]", at->index)
               : plain  ? snprintf(out + n, size - n, "%s%.60s", n ? "." : "", at->key)
                        : snprintf(out + n, size - n, "[\"%.60s\"]", at->key);

  if (length > 0) n += (size_t)length;

  /* snprintf returns what it would have written. */
  return n < size ? n : size - 1;
}

thr_status thr_json_bad(thr_json_reader *reader, const thr_json_where *at, const char *what)
{
  char path[240] = "";
  write_path(at, path, sizeof path);
  return thr_fail(reader->err, THR_EINPUT, "%s: %s: %s", reader->file, *path ? path : "document",
                  what);
}

bool thr_json_is_array(const thr_json *value)
{
  return thr_json_typeof(value) == THR_JSON_ARRAY;
}
bool thr_json_is_object(const thr_json *value)
{
  return thr_json_typeof(value) == THR_JSON_OBJECT;
}

const thr_json *thr_json_member(const thr_json *object, const char *const *keys, const char **which)
{
  *which = keys[0];
  for (; *keys; keys++) {
    const thr_json *value = thr_json_get(object, *keys);
    if (!value) continue;
    *which = *keys;
    return value;
  }

  return NULL;
}

/* ---- values ---- */

/* Reads a number, also one that is written as text: "1.5". */
static thr_status read_number(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *value, double *number)
{
  if (!value) return thr_json_bad(reader, at, "missing; give a number");
  if (thr_json_typeof(value) == THR_JSON_NAN)
    return thr_json_bad(reader, at, "Python wrote NaN or Infinity; give a number or null");

  const bool text =
      thr_json_string(value) &&
      thr_span_number(thr_span_trim(thr_span_of(thr_json_string(value))), false, number);

  if (!text && !thr_json_number(value, number))
    return thr_json_bad(reader, at, "not a number; give a decimal number");

  /* Writers do not tell -0 from 0. */
  if (*number == 0) *number = 0;
  return THR_OK;
}

/* Reads three coordinates in any of the forms that programs write. */
thr_status thr_json_point(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                          const thr_json *defaults, double xyz[3])
{
  static const char *const letter[] = {"x", "y", "z"}, *const capital[] = {"X", "Y", "Z"};

  /* Most points are lists of three numbers, which are read together. */
  if (thr_json_numbers(value, 3, xyz)) {
    for (int i = 0; i < 3; i++)
      if (xyz[i] == 0) xyz[i] = 0; /* -0, as below */
    reader->has_z = true;
    return THR_OK;
  }

  if (!thr_json_is_array(value) && !thr_json_is_object(value))
    return thr_json_bad(reader, at, "no coordinates; give [x, y, z]");

  /* Otherwise each coordinate by itself: of a list, a member in either case, or a default. */
  for (int i = 0; i < 3; i++) {
    const char *which = NULL;
    const thr_json *coordinate = thr_json_is_array(value)
                                     ? thr_json_at(value, i)
                                     : THR_JSON_MEMBER(value, &which, letter[i], capital[i]);
    if (!coordinate) coordinate = thr_json_get(defaults, letter[i]);
    thr_json_where here = {at, which, i};
    xyz[i] = 0;

    /* Only z may be missing. */
    if (i == 2 && !coordinate) continue;
    reader->has_z |= i == 2;
    thr_status st = read_number(reader, &here, coordinate, &xyz[i]);
    if (st) return st;
  }

  return THR_OK;
}

thr_status thr_json_length(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                           double *length)
{
  *length = 0;
  if (thr_json_typeof(value) == THR_JSON_NULL) return THR_OK;
  thr_status st = read_number(reader, at, value, length);
  return st || *length > 0
             ? st
             : thr_json_bad(
                   reader, at,
                   "a length that is not positive; leave it out for the distance of the two nodes");
}

/* Reads a number of passes from 0 to 100; null, and what is missing, is 0. text: a number may be
 * written as text, too. */
static thr_status count_of(const thr_json *value, const char *what, bool text, int *count,
                           thr_err *err)
{
  int64_t wide = 0;
  *count = 0;

  /* A number as text is read where foreign programs may write one. */
  if (text && thr_json_string(value) &&
      thr_span_int(thr_span_trim(thr_span_of(thr_json_string(value))), count) && *count >= 0 &&
      *count <= 100)
    return THR_OK;

  /* Null is the same as nothing. */
  if (thr_json_typeof(value) != THR_JSON_NULL &&
      (!thr_json_int(value, &wide) || wide < 0 || wide > 100))
    return thr_fail(err, THR_EINPUT, "a %s that is not a whole number up to 100", what);
  *count = (int)wide;

  return THR_OK;
}

/* Gives the edge added last its passes, as numbers or, if `text` says so, as text. */
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

thr_status thr_json_passes(thr_json_reader *reader, const thr_json_where *at, const thr_json *cover,
                           const thr_json *capacity)
{
  thr_err why = {0};

  /* The draft says why not, the reader where. */
  thr_status st = take_passes(reader->d, cover, capacity, true, &why);
  return st ? thr_json_bad(reader, at, why.text) : THR_OK;
}

thr_status thr_json_index(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                          int n, int *index)
{
  int64_t whole;

  /* Negative numbers count from nowhere. */
  if (!thr_json_int(value, &whole))
    return thr_json_bad(reader, at, "not a node number; count nodes from 0");
  if (whole >= 0 && whole < n) {
    *index = (int)whole;
    return THR_OK;
  }

  /* The message tells how many nodes there are. */
  char what[80];
  snprintf(what, sizeof what, "there is no node %lld; the %d nodes count from 0", (long long)whole,
           n);

  return thr_json_bad(reader, at, what);
}

thr_status thr_json_units(thr_json_reader *reader, const thr_json_where *up, const char *key,
                          const thr_json *value)
{
  thr_json_where here = {up, key, 0};
  thr_err why = {0};

  if (thr_json_typeof(value) == THR_JSON_NULL) return THR_OK;

  /* A word that is no unit fails with the units that there are. */
  if (!thr_json_string(value))
    return thr_json_bad(reader, &here, "not text; name a unit of length");

  return thr_draft_set_units(reader->d, thr_json_string(value), &why)
             ? thr_json_bad(reader, &here, why.text)
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

/* Appends a name: text, or a number as it would be written. */
static void append_name(thr_text *text, const thr_json *value)
{
  int64_t whole;
  double number;

  /* As it would be written. */
  if (thr_json_string(value))
    thr_text_append(text, thr_json_string(value));
  else if (thr_json_int(value, &whole))
    thr_text_printf(text, "%lld", (long long)whole);
  else if (thr_json_number(value, &number))
    thr_text_double(text, number);
}

/* Writes a name as Python writes it, tuples in brackets. */
thr_status thr_json_name_of(thr_json_reader *reader, const thr_json_where *at,
                            const thr_json *value, const char **name)
{
  thr_text *text = &reader->scratch;

  text->length = 0;

  /* Even without a letter the text is not NULL. */
  thr_text_append(text, "");

  /* networkx calls nodes of grids by tuples: (0, 1). */
  if (thr_json_is_array(value)) {
    thr_text_append(text, "(");
    for (int i = 0; i < thr_json_size(value); i++) {
      thr_text_append(text, i ? ", " : "");
      append_name(text, thr_json_at(value, i));
    }
    thr_text_append(text, ")");
  } else {
    append_name(text, value);
  }

  if (text->failed) return thr_nomem(reader->err);
  thr_text_clean(text->data); /* as the draft keeps it */
  *name = text->data;
  return text->length
             ? THR_OK
             : thr_json_bad(reader, at, "not a node's name; use a string or a whole number");
}

thr_status thr_json_key_name(thr_json_reader *reader, const thr_json_where *at, const char *key,
                             const char **name)
{
  thr_text *text = &reader->scratch;

  text->length = 0;
  thr_text_append(text, "");
  append_key(text, key);

  /* Clean the name as the draft does, so that both are the same. */
  if (text->failed) return thr_nomem(reader->err);
  thr_text_clean(text->data);
  *name = text->data;
  return text->length ? THR_OK : thr_json_bad(reader, at, "an empty name");
}

thr_status thr_json_find_node(thr_json_reader *reader, const thr_json_where *at, const char *name,
                              int *node)
{
  *node = thr_names_find(&reader->names, thr_span_of(name));
  if (*node >= 0) return THR_OK;
  char what[120];
  snprintf(what, sizeof what, "there is no node '%.60s'", name);
  return thr_json_bad(reader, at, what);
}

thr_status thr_json_reference(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *value, int *node)
{
  const char *name;
  if (!value) return thr_json_bad(reader, at, "missing; name a node");
  thr_status st = thr_json_name_of(reader, at, value, &name);
  return st ? st : thr_json_find_node(reader, at, name, node);
}
