/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writing JSON: objects and arrays are opened and closed, and the writer knows where commas, blanks
 * and quotes belong.
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
#ifndef THR_WRITER_H
#define THR_WRITER_H

#include "graph/text.h"

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
void thr_write_ints(thr_writer *writer, const char *key, const int *value, int n);

/* A string that was put together in a text of its own, which it destroys. */
void thr_write_words(thr_writer *writer, const char *key, thr_text *words);

/* A number in a format of the caller's. */
void thr_write_printf(thr_writer *writer, const char *key, const char *format, ...)
    THR_PRINTF(3, 4);

#endif
