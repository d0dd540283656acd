/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing text for everything that is written (JSON, SVG, CSV, tables), and whole-file input and
 * output. */
#ifndef THR_TEXT_H
#define THR_TEXT_H

#include "graph/status.h"

/* {0} is valid and empty. A failed append sets failed and later appends do nothing, so a writer
 * appends freely and asks once at the end (thr_text_write does). data is NUL-terminated once
 * anything was appended. */
typedef struct {
  char *data;
  size_t length, capacity;
  bool failed;
} thr_text;

void thr_text_printf(thr_text *text, const char *format, ...) THR_PRINTF(2, 3);
void thr_text_append(thr_text *text, const char *s);
void thr_text_append_bytes(thr_text *text, const char *s, size_t n);

/* One byte, which most often there is room for. */
static inline void thr_text_byte(thr_text *text, char byte)
{
  if (text->failed || text->length + 2 > text->capacity) {
    thr_text_append_bytes(text, &byte, 1);
    return;
  }
  text->data[text->length++] = byte;
  text->data[text->length] = '\0';
}

/* Shortest decimal that reads back as the same double; "-0" is written as 0. Finite numbers only
 * (graph/number.h). */
void thr_text_double(thr_text *text, double value);

void thr_text_int(thr_text *text, int64_t value);

/* Three bytes as four letters of base64 (RFC 4648). */
void thr_text_base64(thr_text *text, const unsigned char three[3]);

/* The same as JSON, which has no word for what is not finite: null. */
void thr_text_json_number(thr_text *text, double value);

enum { THR_PLAIN_NUMBER = 24 }; /* bytes that hold a number for a reader */

/* Formats a number >= 0 for a reader, rounded to 1 <= digits <= 6 digits and without an exponent:
 * "3.49", "2,290", "1.6 million", "over a trillion"; "under 0.0001", "-" for NAN. Returns out. */
const char *thr_plain_number(double value, int digits, char out[THR_PLAIN_NUMBER]);

/* Formats newtons without a unit, with three digits as above. Returns out. */
const char *thr_plain_newtons(double newton, char out[THR_PLAIN_NUMBER]);

/* Foreign text (of a file, a file's name, the command line) made harmless in place, so that it
 * stays on its line, in its direction and in its field wherever it is printed, drawn or written:
 * control characters (C0, DEL, C1), marks of writing direction (U+061C, U+200E, U+200F, U+202A to
 * U+202E, U+2066 to U+2069), the separators of lines and paragraphs (U+2028, U+2029), U+FFFE and
 * U+FFFF become a blank, and a run of bytes that is no UTF-8 a question mark. All other letters
 * stay. Doing it twice changes nothing, and text never gets longer. O(bytes). */
void thr_text_clean(char *s);

/* Appends it so. */
void thr_text_append_clean(thr_text *text, const char *s);

/* Copies it so, as many whole letters as fit into size bytes. O(size). */
void thr_text_copy_clean(char *to, size_t size, const char *s);

bool thr_text_is_utf8(const char *s, size_t n);

/* Is this byte of UTF-8 text inside a letter, not its first? */
static inline bool thr_text_is_inside(char byte)
{
  return ((unsigned char)byte & 0xC0) == 0x80;
}

/* Width in columns of the first n bytes of UTF-8 text, or of all of it if there are fewer: one for
 * each letter. */
int thr_text_columns(const char *s, size_t n);

/* JSON string in quotes, valid whatever the bytes: what thr_text_clean takes for a control
 * character is escaped (a program that reads it gets it back), what is no UTF-8 is U+FFFD. */
void thr_text_json_string(thr_text *text, const char *s);

/* XML text with the five entities, cleaned; what is no UTF-8 is U+FFFD. */
void thr_text_xml(thr_text *text, const char *s);

void thr_text_destroy(thr_text *text);

/* Writes the text to path through a temporary file in the same folder and rename, so that path is
 * either the old file or the whole new one, and after a loss of power as well: the file is on the
 * disk before it takes the name; "-" is stdout. THR_EIO with the path and the reason; THR_ENOMEM if
 * an append failed. */
thr_status thr_text_write(const thr_text *text, const char *path, thr_err *err) THR_MUST_CHECK;

/* Reads a whole file ("-" is stdin) into an empty text. At most 1 GiB. */
thr_status thr_text_read(thr_text *text, const char *path, thr_err *err) THR_MUST_CHECK;

/* The same of a text for people: THR_EINPUT if it has NUL bytes, as UTF-16 has. */
thr_status thr_text_read_plain(thr_text *text, const char *path, thr_err *err) THR_MUST_CHECK;

/* ---- "did you mean": the word among those that there are which is nearest to what was typed. */

enum { THR_SUGGESTION_TEXT = 96 };

/* {word} is the beginning: no word is near. */
typedef struct {
  const char *word; /* what was typed */
  const char *best; /* borrowed; NULL = none is near */
  int distance;     /* of the best */
} thr_suggestion;

/* Looks at a word that there is. Words that differ only in the case of their letters are as near as
 * can be; else letters left out, added, changed or swapped count (Damerau & Levenshtein), at most
 * one in three of the longer word. Of equally near ones the first stays. O(letters of one x letters
 * of the other). */
void thr_suggestion_try(thr_suggestion *suggestion, const char *candidate);

/* "; did you mean plan?", or "" where none is near. */
void thr_suggestion_ask(const thr_suggestion *suggestion, char question[THR_SUGGESTION_TEXT]);

#endif
