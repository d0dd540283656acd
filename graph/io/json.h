/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading JSON: a document is parsed once, into one array of eight bytes a value (graph/io/json.c).
 * Writing goes through graph/io/json.h. */
#ifndef THR_JSON_H
#define THR_JSON_H

#include "graph/status.h"
#include "graph/text.h"

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

/* ---- Writing JSON: objects and arrays are opened and closed, and the writer knows where commas,
 * blanks and quotes belong.
 *
 *   thr_writer w = {.out = &text};
 *   thr_write_object(&w, NULL);
 *   thr_write_int(&w, "order", 6);
 *   thr_write_ints(&w, "nodes", node, 3);
 *   thr_write_close(&w);                        {"order": 6, "nodes": [0,2,5]}
 *
 * Every function that writes a value takes its key, NULL in an array and for the document. A failed
 * append is remembered by the text (graph/text.h). At most 64 objects and arrays are open at a
 * time. */

typedef struct {
  thr_text *out;
  bool compact;          /* no blanks at all */
  bool some;             /* the innermost object or array has a member already */
  int line;              /* a new line comes next, with line - 1 blanks; 0: none does */
  uint64_t array, tight; /* one bit for each that is open, the innermost lowest: an array? without
                            blanks after commas? */
} thr_writer;

void thr_write_object(thr_writer *writer, const char *key);
void thr_write_array(thr_writer *writer, const char *key);
void thr_write_row(thr_writer *writer,
                   const char *key);      /* an array without blanks after its commas */
void thr_write_close(thr_writer *writer); /* the innermost */

/* What comes next, a member or the closing bracket, begins a new line with so many blanks. */
void thr_write_line(thr_writer *writer, int blanks);

void thr_write_int(thr_writer *writer, const char *key, int64_t value);
void thr_write_number(thr_writer *writer, const char *key,
                      double value); /* null if it is not finite */
void thr_write_bool(thr_writer *writer, const char *key, bool value);
void thr_write_null(thr_writer *writer, const char *key);
void thr_write_string(thr_writer *writer, const char *key, const char *value);
void thr_write_hash(thr_writer *writer, const char *key,
                    uint64_t value); /* 16 hexadecimal digits, as a string */
void thr_write_numbers(thr_writer *writer, const char *key, const double *value, int n);
void thr_write_ints(thr_writer *writer, const char *key, const int *value, int n);

/* A string that was put together in a text of its own, which it destroys. */
void thr_write_words(thr_writer *writer, const char *key, thr_text *words);

/* A value that is JSON already, as it is. */
void thr_write_json(thr_writer *writer, const char *key, const thr_text *json);

/* A number in a format of the caller's. */
void thr_write_printf(thr_writer *writer, const char *key, const char *format, ...)
    THR_PRINTF(3, 4);

#endif
