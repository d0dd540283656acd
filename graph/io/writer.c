/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON, written member by member. */
#include "graph/io/json.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

/* Begins the line that was asked for, with its blanks. */
static void break_line(thr_writer *writer)
{
  thr_text_byte(writer->out, '\n');
  for (; writer->line > 1; writer->line--)
    thr_text_byte(writer->out, ' ');
  writer->line = 0;
}

/* Writes a key and its colon. */
static void put_key(const thr_writer *writer, const char *key)
{
  thr_text_json_string(writer->out, key);
  thr_text_append(writer->out, writer->compact ? ":" : ": ");
}

/* Writes what comes before a value: a comma, a blank or a new line, and the key. */
static inline void begin(thr_writer *writer, const char *key)
{
  /* A new line replaces the blank after the comma. */
  const bool tight = writer->compact || (writer->tight & 1);
  if (writer->some) thr_text_byte(writer->out, ',');
  if (writer->some && !tight && !writer->line) thr_text_byte(writer->out, ' ');
  if (writer->line) break_line(writer);
  writer->some = true;
  if (key) put_key(writer, key);
}

/* Opens an object or an array; it has no member yet. */
static void enter(thr_writer *writer, const char *key, bool array, bool tight)
{
  /* The innermost bracket is the lowest bit. */
  begin(writer, key);
  thr_text_byte(writer->out, array ? '[' : '{');
  writer->array = writer->array << 1 | array;
  writer->tight = writer->tight << 1 | tight;
  writer->some = false;
}

void thr_write_object(thr_writer *writer, const char *key)
{
  enter(writer, key, false, false);
}

void thr_write_array(thr_writer *writer, const char *key)
{
  enter(writer, key, true, false);
}

void thr_write_row(thr_writer *writer, const char *key)
{
  enter(writer, key, true, true);
}

void thr_write_close(thr_writer *writer)
{
  if (writer->line) break_line(writer);
  thr_text_byte(writer->out, writer->array & 1 ? ']' : '}');
  writer->array >>= 1;
  writer->tight >>= 1;
  writer->some = true;
}

void thr_write_line(thr_writer *writer, int blanks)
{
  writer->line = blanks + 1;
}

void thr_write_int(thr_writer *writer, const char *key, int64_t value)
{
  begin(writer, key);
  thr_text_int(writer->out, value);
}

void thr_write_number(thr_writer *writer, const char *key, double value)
{
  begin(writer, key);
  thr_text_json_number(writer->out, value);
}

void thr_write_bool(thr_writer *writer, const char *key, bool value)
{
  thr_write_printf(writer, key, value ? "true" : "false");
}

void thr_write_null(thr_writer *writer, const char *key)
{
  thr_write_printf(writer, key, "null");
}

void thr_write_string(thr_writer *writer, const char *key, const char *value)
{
  begin(writer, key);
  thr_text_json_string(writer->out, value);
}

void thr_write_json(thr_writer *writer, const char *key, const thr_text *json)
{
  begin(writer, key);
  thr_text_append_bytes(writer->out, json->data ? json->data : "null",
                        json->data ? json->length : 4);
}

void thr_write_hash(thr_writer *writer, const char *key, uint64_t value)
{
  thr_write_printf(writer, key, "\"%016" PRIx64 "\"", value);
}

void thr_write_numbers(thr_writer *writer, const char *key, const double *value, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_number(writer, NULL, value[i]);
  thr_write_close(writer);
}

void thr_write_ints(thr_writer *writer, const char *key, const int *value, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_int(writer, NULL, value[i]);
  thr_write_close(writer);
}

void thr_write_words(thr_writer *writer, const char *key, thr_text *words)
{
  /* A text that failed lacks bytes, so the whole document fails. */
  thr_write_string(writer, key, words->data && !words->failed ? words->data : "");
  if (words->failed) writer->out->failed = true;
  thr_text_destroy(words);
}

void thr_write_printf(thr_writer *writer, const char *key, const char *format, ...)
{
  char value[64];

  /* All values that are formatted here are short. */
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(value, sizeof value, format, arguments);
  va_end(arguments);
  begin(writer, key);

  thr_text_append(writer->out, value);
}
