/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON texts on standard input, each after its length in four bytes, as thr_json_parse reads them:
 * one line each, for tests/second/read_json.py. A line is the value with strings in hexadecimal and
 * numbers as %a, or "error". */
#include "graph/io/json.h"
#include "graph/status.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static void put_text(const char *text)
{
  putchar('"');
  for (; *text; text++)
    printf("%02x", (unsigned)(unsigned char)*text);
  putchar('"');
}

static void put(const thr_json *value);

static void put_members(const thr_json *object)
{
  void *iter = NULL;
  const char *key, *comma = "";
  const thr_json *value;
  while (thr_json_next(object, &iter, &key, &value)) {
    fputs(comma, stdout);
    put_text(key);
    putchar(':');
    put(value);
    if (thr_json_get(object, key) != value) fputs(" is not found by its key", stdout);
    comma = ",";
  }
}

static void put(const thr_json *value)
{
  double number;
  switch (thr_json_typeof(value)) {
  case THR_JSON_NULL: fputs("null", stdout); break;
  case THR_JSON_BOOL: fputs(thr_json_true(value) ? "true" : "false", stdout); break;
  case THR_JSON_NUMBER:
    if (thr_json_number(value, &number)) printf("%a", number);
    break;
  case THR_JSON_NAN: break; /* not in what thr_json_parse reads */
  case THR_JSON_STRING: put_text(thr_json_string(value)); break;
  case THR_JSON_ARRAY:
    putchar('[');
    for (int i = 0; i < thr_json_size(value); i++) {
      if (i > 0) putchar(',');
      put(thr_json_at(value, i));
    }
    putchar(']');
    break;
  case THR_JSON_OBJECT:
    putchar('{');
    put_members(value);
    putchar('}');
  }
}

int main(void)
{
  uint32_t n;
  while (fread(&n, sizeof n, 1, stdin) == 1) {
    char *text = malloc(n + 1);
    thr_json *document = NULL;
    if (!text || fread(text, 1, n, stdin) != n) return 1;
    if (thr_json_parse(&document, text, n, "-", NULL) == THR_OK)
      put(document);
    else
      fputs("error", stdout);
    putchar('\n');
    thr_json_destroy(document);
    free(text);
  }
  return 0;
}
