/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading JSON: a document is parsed once, into one array of eight bytes a value (graph/io/json.c).
 * Writing goes through graph/io/writer.h. */
#ifndef THR_JSON_H
#define THR_JSON_H

#include "graph/status.h"

typedef struct thr_json
    thr_json; /* a parsed value; borrowed from its document, never freed on its own */

/* Parses text (n bytes, not needed any more afterwards) as one JSON document, a list or an object
 * (RFC 8259); duplicate keys, trailing text, depth over 2048, \u0000 and numbers that no int64_t or
 * double holds are errors with "name:line:column: what". *doc must be released with
 * thr_json_destroy (NULL ok). O(n), and O(k log k) in the members of an object. */
thr_status thr_json_parse(thr_json **doc, const char *text, size_t n, const char *name,
                          thr_err *err) THR_MUST_CHECK;
/* The same of what Python's json module writes: NaN, Infinity and -Infinity are values that are no
 * numbers. */
thr_status thr_json_parse_python(thr_json **doc, const char *text, size_t n, const char *name,
                                 thr_err *err) THR_MUST_CHECK;
void thr_json_destroy(thr_json *doc);

typedef enum {
  THR_JSON_NULL,
  THR_JSON_BOOL,
  THR_JSON_NUMBER,
  THR_JSON_STRING,
  THR_JSON_ARRAY,
  THR_JSON_OBJECT,
  THR_JSON_NAN
} thr_json_type;

/* All accessors take NULL as "absent" and answer THR_JSON_NULL, 0, NULL or false for it. */
thr_json_type thr_json_typeof(const thr_json *value);
const thr_json *thr_json_get(const thr_json *object,
                             const char *key); /* NULL if absent or not an object; O(log members) */
int thr_json_size(const thr_json *value);      /* of an array or object, else 0 */
const thr_json *thr_json_at(const thr_json *array,
                            int i);                       /* NULL if out of range or not an array */
const char *thr_json_string(const thr_json *value);       /* NULL if not a string */
bool thr_json_number(const thr_json *value, double *out); /* finite number; false otherwise */
bool thr_json_int(const thr_json *value, int64_t *out);   /* integer (2 or 2.0); false otherwise */
bool thr_json_numbers(const thr_json *array, int n,
                      double *out); /* its first n values; false unless all are numbers */
bool thr_json_indices(const thr_json *array, int n, int limit,
                      int *out);           /* likewise whole numbers from 0 to limit - 1 */
bool thr_json_true(const thr_json *value); /* true, or a non-zero number */

/* Iterates an object in file order: start with *iter = NULL; false at the end. */
bool thr_json_next(const thr_json *object, void **iter, const char **key, const thr_json **value);

/* First member of an object that is not in known (which ends with NULL), or NULL. */
const char *thr_json_unknown(const thr_json *object, const char *const *known);

#endif
