/* Growing text for everything that is written (JSON, SVG, CSV, tables), and whole-file input and output. */
#ifndef THR_TEXT_H
#define THR_TEXT_H

#include "graph/status.h"

/* {0} is valid and empty. A failed append sets failed and later appends do nothing, so a writer appends
 * freely and asks once at the end (thr_text_write does). data is NUL-terminated once anything was appended. */
typedef struct {
  char *data;
  size_t length, capacity;
  bool failed;
} thr_text;

void thr_text_printf(thr_text *t, const char *format, ...) THR_PRINTF(2, 3);
void thr_text_append(thr_text *t, const char *s);
void thr_text_append_bytes(thr_text *t, const char *s, size_t n);

/* Shortest decimal that reads back as the same double; "-0" is written as 0. Finite numbers only. */
void thr_text_double(thr_text *t, double value);

/* The same as JSON, which has no word for what is not finite: null. */
void thr_text_json_number(thr_text *t, double value);

/* JSON string with quotes and escapes; bytes >= 0x20 are passed through as UTF-8. */
void thr_text_json_string(thr_text *t, const char *s);

/* XML text with the five entities; control characters become spaces. */
void thr_text_xml(thr_text *t, const char *s);

void thr_text_destroy(thr_text *t);

/* Writes the text to path through a temporary file in the same folder and rename, so that path is either the
 * old file or the whole new one; "-" is stdout. THR_EIO with the path and the reason; THR_ENOMEM if an append failed. */
thr_status thr_text_write(const thr_text *t, const char *path, thr_err *err) THR_MUST_CHECK;

/* Reads a whole file ("-" is stdin) into an empty text. At most 1 GiB. */
thr_status thr_text_read(thr_text *t, const char *path, thr_err *err) THR_MUST_CHECK;

#endif
