/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing text, number formatting, cleaning of foreign text, whole-file input and output. */
#define _XOPEN_SOURCE 700
#include "graph/text.h"
#include "graph/number.h"
#include "graph/os.h"

#include <math.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_INPUT_BYTES = 1 << 30 };

#define NO_NAME "an empty name is no file; name one, or - for stdin or stdout"

static bool grow(thr_text *text, size_t extra)
{
  size_t wanted = text->capacity ? text->capacity : 256;
  while (wanted < text->length + extra + 1)
    wanted *= 2;
  char *data = thr_realloc(text->data, wanted, 1);
  if (!data) {
    text->failed = true;
    return false;
  }
  text->data = data;
  text->capacity = wanted;
  return true;
}

static inline bool reserve(thr_text *text, size_t extra)
{
  if (text->failed) return false;
  return text->length + extra + 1 <= text->capacity || grow(text, extra);
}

void thr_text_append_bytes(thr_text *text, const char *s, size_t n)
{
  if (!reserve(text, n)) return;
  if (n) memcpy(text->data + text->length, s, n); /* s may be NULL where n is 0 */
  text->length += n;
  text->data[text->length] = '\0';
}

void thr_text_base64(thr_text *text, const unsigned char three[3])
{
  static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const unsigned bits = (unsigned)three[0] << 16 | (unsigned)three[1] << 8 | three[2];
  for (int shift = 18; shift >= 0; shift -= 6)
    thr_text_byte(text, letter[bits >> shift & 63]);
}

void thr_text_append(thr_text *text, const char *s)
{
  thr_text_append_bytes(text, s, strlen(s));
}

void thr_text_printf(thr_text *text, const char *format, ...)
{
  va_list args, again;
  va_start(args, format);
  va_copy(again, args);
  const size_t room =
      text->data && !text->failed ? text->capacity - text->length : 0; /* most often enough */
  int n = vsnprintf(room ? text->data + text->length : NULL, room, format, args);
  va_end(args);
  if (n >= 0 && reserve(text, (size_t)n)) {
    if ((size_t)n >= room) vsnprintf(text->data + text->length, (size_t)n + 1, format, again);
    text->length += (size_t)n;
  }
  va_end(again);
  if (room && !text->failed) text->data[text->length] = '\0';
}

void thr_text_double(thr_text *text, double value)
{
  if (reserve(text, THR_NUMBER_TEXT))
    text->length += thr_number_print(value, text->data + text->length);
  if (text->data) text->data[text->length] = '\0';
}

void thr_text_int(thr_text *text, int64_t value)
{
  if (reserve(text, THR_INT_TEXT)) text->length += thr_int_print(value, text->data + text->length);
  if (text->data) text->data[text->length] = '\0';
}

void thr_text_json_number(thr_text *text, double value)
{
  if (isfinite(value))
    thr_text_double(text, value);
  else
    thr_text_append(text, "null");
}

const char *thr_plain_number(double value, int digits, char out[THR_PLAIN_NUMBER])
{
  const size_t size = THR_PLAIN_NUMBER;
  char rounded_text[40];

  if (isnan(value)) {
    snprintf(out, size, "-");
    return out;
  }

  /* Rounded first, so that 999.6 with three digits is counted in thousands. */
  snprintf(rounded_text, sizeof rounded_text, "%.*e", digits - 1, fmin(value, 1e300));
  const double rounded = strtod(rounded_text, NULL);

  if (rounded >= 1e12)
    snprintf(out, size, "over a trillion");
  else if (rounded >= 1e9)
    snprintf(out, size, "%.*g billion", digits, rounded / 1e9);
  else if (rounded >= 1e6)
    snprintf(out, size, "%.*g million", digits, rounded / 1e6);
  else if (rounded >= 1e3)
    snprintf(out, size, "%d,%03d", (int)rounded / 1000, (int)rounded % 1000);
  else if (value > 0 && rounded < 1e-4)
    snprintf(out, size, "under 0.0001");
  else
    snprintf(out, size, "%.*g", digits, value);

  return out;
}

const char *thr_plain_newtons(double newton, char out[THR_PLAIN_NUMBER])
{
  return thr_plain_number(newton, 3, out);
}

/* ---- letters of foreign text ---- */

enum { BROKEN_LETTER = 0x110000 }; /* one beyond the last code point: bytes that are no UTF-8 */

/* Code point of the letter at s, of which n > 0 bytes are left, and its length in bytes; what is no
 * UTF-8 (Unicode 15, table 3-7) is one broken letter up to the next byte that can begin another. */
static uint32_t letter_at(const char *s, size_t n, size_t *length)
{
  const unsigned char *b = (const unsigned char *)s;
  size_t wanted = b[0] < 0x80   ? 1
                  : b[0] < 0xc2 ? 0
                  : b[0] < 0xe0 ? 2
                  : b[0] < 0xf0 ? 3
                  : b[0] < 0xf5 ? 4
                                : 0;
  size_t have = 1;
  while (have < n && thr_text_is_inside((char)b[have]) && (wanted < 2 || have < wanted) &&
         b[0] >= 0x80)
    have++;
  *length = have;
  if (wanted != have) return BROKEN_LETTER;
  uint32_t code = wanted == 1 ? b[0] : b[0] & (0x7fu >> wanted);
  for (size_t i = 1; i < wanted; i++)
    code = code << 6 | (b[i] & 0x3fu);
  bool overlong = (wanted == 3 && code < 0x800) || (wanted == 4 && code < 0x10000);
  bool nobody = (code >= 0xd800 && code < 0xe000) || code >= BROKEN_LETTER;
  return overlong || nobody ? BROKEN_LETTER : code;
}

/* Does this letter steer a terminal, a reader of lines or the direction of writing, instead of
 * standing for itself? C0, DEL, C1; the marks, embeddings, overrides and isolates of the Unicode
 * bidirectional algorithm (UAX 9); the separators of lines and paragraphs; and the two code points
 * that XML has no place for. */
static bool is_control(uint32_t code)
{
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e ||
         code == 0x200f || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xfffe || code == 0xffff;
}

/* Is it a letter of ASCII that stands for itself? */
static bool is_plain(char c)
{
  return c >= 0x20 && c < 0x7f;
}

/* How many of these there are from s on, up to n. */
static size_t plain_letters(const char *s, size_t n)
{
  size_t i = 0;
  while (i < n && is_plain(s[i]))
    i++;
  return i;
}

void thr_text_clean(char *s)
{
  s += plain_letters(s, strlen(s));
  char *to = s;
  for (size_t left = strlen(s), length = 0; left > 0; left -= length, s += length) {
    uint32_t code = letter_at(s, left, &length);
    if (code != BROKEN_LETTER && !is_control(code)) {
      memmove(to, s, length);
      to += length;
    } else {
      *to++ = code == BROKEN_LETTER ? '?' : ' ';
    }
  }
  *to = '\0';
}

void thr_text_copy_clean(char *to, size_t size, const char *s)
{
  size_t n = strnlen(s, size);
  if (n == size) { /* cut before the letter that does not fit */
    n = 0;
    for (size_t length = 0; letter_at(s + n, strnlen(s + n, 4), &length), n + length < size;)
      n += length;
  }
  memcpy(to, s, n);
  to[n] = '\0';
  thr_text_clean(to);
}

void thr_text_append_clean(thr_text *text, const char *s)
{
  size_t start = text->length;
  thr_text_append(text, s);
  if (text->failed) return;
  thr_text_clean(text->data + start);
  text->length = start + strlen(text->data + start);
}

bool thr_text_is_utf8(const char *s, size_t n)
{
  for (size_t i = plain_letters(s, n), length = 0; i < n; i += length)
    if (letter_at(s + i, n - i, &length) == BROKEN_LETTER) return false;
  return true;
}

int thr_text_columns(const char *s, size_t n)
{
  int columns = 0;
  for (size_t i = 0; i < n && s[i]; i++)
    columns += !thr_text_is_inside(s[i]);
  return columns;
}

void thr_text_json_string(thr_text *text, const char *s)
{
  thr_text_append(text, "\"");
  for (size_t left = strlen(s), length = 0; left > 0; left -= length, s += length) {
    uint32_t code = 'a'; /* of many plain letters in one go */
    for (length = 0; length < left && is_plain(s[length]) && s[length] != '"' && s[length] != '\\';
         length++)
      continue;
    if (length == 0) code = letter_at(s, left, &length);
    if (code == '"' || code == '\\')
      thr_text_printf(text, "\\%c", (int)code);
    else if (code == BROKEN_LETTER || is_control(code))
      thr_text_printf(text, "\\u%04x", code == BROKEN_LETTER ? 0xfffdu : (unsigned)code);
    else
      thr_text_append_bytes(text, s, length);
  }
  thr_text_append(text, "\"");
}

void thr_text_xml(thr_text *text, const char *s)
{
  for (size_t left = strlen(s), length = 0; left > 0; left -= length, s += length) {
    uint32_t code = letter_at(s, left, &length);
    switch (code) {
    case '&': thr_text_append(text, "&amp;"); break;
    case '<': thr_text_append(text, "&lt;"); break;
    case '>': thr_text_append(text, "&gt;"); break;
    case '"': thr_text_append(text, "&quot;"); break;
    case '\'': thr_text_append(text, "&apos;"); break;
    case BROKEN_LETTER: thr_text_append(text, "\xEF\xBF\xBD"); break;
    default: thr_text_append_bytes(text, is_control(code) ? " " : s, is_control(code) ? 1 : length);
    }
  }
}

void thr_text_destroy(thr_text *text)
{
  free(text->data);
  *text = (thr_text){0};
}

static thr_status write_failed(const char *path, thr_err *err)
{
  return thr_fail(err, THR_EIO, "%s: cannot write: %s", path, strerror(errno));
}

static thr_status write_stdout(const thr_text *text, thr_err *err)
{
  if (text->length && fwrite(text->data, 1, text->length, stdout) != text->length)
    return write_failed("stdout", err);
  return fflush(stdout) == 0 ? THR_OK : write_failed("stdout", err);
}

thr_status thr_text_write(const thr_text *text, const char *path, thr_err *err)
{
  if (text->failed) return thr_nomem(err);
  if (strcmp(path, "-") == 0) return write_stdout(text, err);
  if (!*path) return thr_fail(err, THR_EIO, NO_NAME);
  if (thr_os_is_folder(path))
    return thr_fail(err, THR_EIO, "%s: is a folder; give the name of a file", path);
  if (thr_os_write(path, text->data, text->length)) return THR_OK;
  return errno == ENOMEM ? thr_nomem(err) : write_failed(path, err);
}

thr_status thr_text_read(thr_text *text, const char *path, thr_err *err)
{
  bool is_stdin = strcmp(path, "-") == 0;
  if (!*path) return thr_fail(err, THR_EIO, NO_NAME);
  FILE *f = is_stdin ? stdin : fopen(path, "rb");
  if (!f) return thr_fail(err, THR_EIO, "%s: cannot open: %s", path, strerror(errno));
  struct stat about;
  const bool regular = fstat(fileno(f), &about) == 0 && S_ISREG(about.st_mode);
  size_t block = 1 << 16, n;
  if (regular && about.st_size >= (off_t)block && about.st_size <= MAX_INPUT_BYTES)
    block = (size_t)about.st_size + 1;
  for (; text->length <= MAX_INPUT_BYTES && reserve(text, block);
       text->length += n, block = 1 << 16)
    if ((n = fread(text->data + text->length, 1, block, f)) == 0) break;
  if (text->data) text->data[text->length] = '\0';
  thr_status st = THR_OK;
  if (ferror(f))
    st = thr_fail(err, THR_EIO, "%s: cannot read: %s", path, strerror(errno));
  else if (text->failed)
    st = thr_nomem(err);
  else if (text->length > MAX_INPUT_BYTES)
    st = thr_fail(err, THR_EINPUT, "%s: larger than 1 GiB; split it", path);
  if (!is_stdin) fclose(f);
  if (st) thr_text_destroy(text);
  return st;
}

thr_status thr_text_read_plain(thr_text *text, const char *path, thr_err *err)
{
  thr_status st = thr_text_read(text, path, err);
  if (st || !text->length || !memchr(text->data, 0, text->length)) return st;
  thr_text_destroy(text);
  return thr_fail(err, THR_EINPUT,
                  "%s: a NUL byte, so this is not plain text; save the file as UTF-8 text", path);
}
