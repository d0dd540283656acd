/* JSON, written member by member. */
#include "graph/io/writer.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

static void break_line(thr_writer *w)
{
  thr_text_printf(w->out, "\n%*s", w->line - 1, "");
  w->line = 0;
}

/* What stands before a value. */
static void begin(thr_writer *w, const char *key)
{
  const bool tight = w->compact || (w->tight & 1);
  if (w->some) thr_text_append(w->out, tight || w->line ? "," : ", ");
  if (w->line) break_line(w);
  w->some = true;
  if (!key) return;
  thr_text_json_string(w->out, key);
  thr_text_append(w->out, w->compact ? ":" : ": ");
}

static void enter(thr_writer *w, const char *key, bool array, bool tight)
{
  begin(w, key);
  thr_text_append(w->out, array ? "[" : "{");
  w->array = w->array << 1 | array;
  w->tight = w->tight << 1 | tight;
  w->some = false;
}

void thr_write_object(thr_writer *w, const char *key)
{
  enter(w, key, false, false);
}

void thr_write_array(thr_writer *w, const char *key)
{
  enter(w, key, true, false);
}

void thr_write_row(thr_writer *w, const char *key)
{
  enter(w, key, true, true);
}

void thr_write_close(thr_writer *w)
{
  if (w->line) break_line(w);
  thr_text_append(w->out, w->array & 1 ? "]" : "}");
  w->array >>= 1;
  w->tight >>= 1;
  w->some = true;
}

void thr_write_line(thr_writer *w, int blanks)
{
  w->line = blanks + 1;
}

void thr_write_int(thr_writer *w, const char *key, int64_t value)
{
  thr_write_printf(w, key, "%" PRId64, value);
}

void thr_write_number(thr_writer *w, const char *key, double value)
{
  begin(w, key);
  thr_text_json_number(w->out, value);
}

void thr_write_bool(thr_writer *w, const char *key, bool value)
{
  thr_write_printf(w, key, value ? "true" : "false");
}

void thr_write_null(thr_writer *w, const char *key)
{
  thr_write_printf(w, key, "null");
}

void thr_write_string(thr_writer *w, const char *key, const char *value)
{
  begin(w, key);
  thr_text_json_string(w->out, value);
}

void thr_write_hash(thr_writer *w, const char *key, uint64_t value)
{
  thr_write_printf(w, key, "\"%016" PRIx64 "\"", value);
}

void thr_write_ints(thr_writer *w, const char *key, const int *value, int n)
{
  thr_write_row(w, key);
  for (int i = 0; i < n; i++)
    thr_write_int(w, NULL, value[i]);
  thr_write_close(w);
}

void thr_write_words(thr_writer *w, const char *key, thr_text *words)
{
  thr_write_string(w, key, words->data && !words->failed ? words->data : "");
  if (words->failed) w->out->failed = true;
  thr_text_destroy(words);
}

void thr_write_printf(thr_writer *w, const char *key, const char *format, ...)
{
  char value[64];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(value, sizeof value, format, arguments);
  va_end(arguments);
  begin(w, key);
  thr_text_append(w->out, value);
}
