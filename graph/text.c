/* Growing text, number formatting, whole-file input and atomic output. */
#define _POSIX_C_SOURCE 200809L
#include "graph/text.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_INPUT_BYTES = 1 << 30 };

static bool reserve(thr_text *t, size_t extra)
{
  if (t->failed) return false;
  if (t->length + extra + 1 <= t->capacity) return true;
  size_t wanted = t->capacity ? t->capacity : 256;
  while (wanted < t->length + extra + 1)
    wanted *= 2;
  char *data = thr_realloc(t->data, wanted, 1);
  if (!data) {
    t->failed = true;
    return false;
  }
  t->data = data;
  t->capacity = wanted;
  return true;
}

void thr_text_append_bytes(thr_text *t, const char *s, size_t n)
{
  if (!reserve(t, n)) return;
  memcpy(t->data + t->length, s, n);
  t->length += n;
  t->data[t->length] = '\0';
}

void thr_text_append(thr_text *t, const char *s)
{
  thr_text_append_bytes(t, s, strlen(s));
}

void thr_text_printf(thr_text *t, const char *format, ...)
{
  va_list args, again;
  va_start(args, format);
  va_copy(again, args);
  int n = vsnprintf(NULL, 0, format, args);
  va_end(args);
  if (n >= 0 && reserve(t, (size_t)n)) {
    vsnprintf(t->data + t->length, (size_t)n + 1, format, again);
    t->length += (size_t)n;
  }
  va_end(again);
}

void thr_text_double(thr_text *t, double value)
{
  char digits[40];
  for (int precision = 15; precision <= 17; precision++) {
    snprintf(digits, sizeof digits, "%.*g", precision, value == 0 ? 0.0 : value);
    if (strtod(digits, NULL) == value) break;
  }
  thr_text_append(t, digits);
}

void thr_text_json_string(thr_text *t, const char *s)
{
  thr_text_append(t, "\"");
  for (; *s; s++) {
    unsigned char c = (unsigned char)*s;
    if (c == '"' || c == '\\')
      thr_text_printf(t, "\\%c", c);
    else if (c < 32 || c == 127)
      thr_text_printf(t, "\\u%04x", c);
    else
      thr_text_append_bytes(t, s, 1);
  }
  thr_text_append(t, "\"");
}

void thr_text_xml(thr_text *t, const char *s)
{
  for (; *s; s++) {
    switch (*s) {
    case '&': thr_text_append(t, "&amp;"); break;
    case '<': thr_text_append(t, "&lt;"); break;
    case '>': thr_text_append(t, "&gt;"); break;
    case '"': thr_text_append(t, "&quot;"); break;
    case '\'': thr_text_append(t, "&apos;"); break;
    default: thr_text_append_bytes(t, (unsigned char)*s < 32 || *s == 127 ? " " : s, 1);
    }
  }
}

void thr_text_destroy(thr_text *t)
{
  free(t->data);
  *t = (thr_text){0};
}

static thr_status write_failed(const char *path, thr_err *err)
{
  return thr_fail(err, THR_EIO, "%s: cannot write: %s", path, strerror(errno));
}

static thr_status write_stdout(const thr_text *t, thr_err *err)
{
  if (t->length && fwrite(t->data, 1, t->length, stdout) != t->length) return write_failed("stdout", err);
  return fflush(stdout) == 0 ? THR_OK : write_failed("stdout", err);
}

/* mkstemp makes the file private; give it the mode that a plain fopen would have given. */
static int open_temporary(char *name)
{
  int fd = mkstemp(name);
  if (fd >= 0) {
    mode_t mask = umask(0);
    umask(mask);
    fchmod(fd, 0666 & ~mask);
  }
  return fd;
}

thr_status thr_text_write(const thr_text *t, const char *path, thr_err *err)
{
  if (t->failed) return thr_nomem(err);
  if (strcmp(path, "-") == 0) return write_stdout(t, err);
  struct stat target;
  if (stat(path, &target) == 0 && S_ISDIR(target.st_mode))
    return thr_fail(err, THR_EIO, "%s: is a folder; give the name of a file", path);

  /* A device or pipe (/dev/stdout, /dev/null) must be written through, not replaced. */
  bool replace = stat(path, &target) != 0 || S_ISREG(target.st_mode);
  size_t n = strlen(path) + sizeof ".XXXXXX";
  char *temporary = thr_calloc(n, 1);
  if (!temporary) return thr_nomem(err);
  snprintf(temporary, n, "%s%s", path, replace ? ".XXXXXX" : "");
  thr_status st = THR_OK;
  FILE *f = NULL;
  if (replace) {
    int fd = open_temporary(temporary);
    f = fd >= 0 ? fdopen(fd, "wb") : NULL;
  } else {
    f = fopen(path, "wb");
  }
  if (!f) {
    st = write_failed(path, err);
    goto done;
  }
  bool ok = t->length == 0 || fwrite(t->data, 1, t->length, f) == t->length;
  if (fclose(f) != 0) ok = false;
  if (ok && replace) ok = rename(temporary, path) == 0;
  if (!ok) {
    st = write_failed(path, err);
    if (replace) unlink(temporary);
  }
done:
  free(temporary);
  return st;
}

thr_status thr_text_read(thr_text *t, const char *path, thr_err *err)
{
  bool is_stdin = strcmp(path, "-") == 0;
  FILE *f = is_stdin ? stdin : fopen(path, "rb");
  if (!f) return thr_fail(err, THR_EIO, "%s: cannot open: %s", path, strerror(errno));
  char block[1 << 16];
  size_t n;
  while (!t->failed && t->length <= MAX_INPUT_BYTES && (n = fread(block, 1, sizeof block, f)) > 0)
    thr_text_append_bytes(t, block, n);
  thr_status st = THR_OK;
  if (ferror(f))
    st = thr_fail(err, THR_EIO, "%s: cannot read: %s", path, strerror(errno));
  else if (t->failed)
    st = thr_nomem(err);
  else if (t->length > MAX_INPUT_BYTES)
    st = thr_fail(err, THR_EINPUT, "%s: larger than 1 GiB; split it", path);
  if (!is_stdin) fclose(f);
  if (st) thr_text_destroy(t);
  return st;
}
