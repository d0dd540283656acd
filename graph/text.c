/* Growing text, number formatting, whole-file input and atomic output. */
#define _XOPEN_SOURCE 700
#include "graph/text.h"

#include <math.h>
#include <errno.h>
#include <signal.h>
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

void thr_text_json_number(thr_text *t, double value)
{
  if (isfinite(value))
    thr_text_double(t, value);
  else
    thr_text_append(t, "null");
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

static bool write_all(FILE *f, const thr_text *t)
{
  bool ok = t->length == 0 || fwrite(t->data, 1, t->length, f) == t->length;
  return fclose(f) == 0 && ok;
}

/* A new file beside path, which then takes path's place; mode is what path is to have. */
static thr_status replace_file(const thr_text *t, const char *path, mode_t mode, thr_err *err)
{
  static const char name[] = ".thread-XXXXXX"; /* short: the folder may allow no longer name than path's */
  const char *slash = strrchr(path, '/');
  size_t folder = slash ? (size_t)(slash - path) + 1 : 0;
  char *temporary = thr_calloc(folder + sizeof name, 1);
  if (!temporary) return thr_nomem(err);
  memcpy(temporary, path, folder);
  memcpy(temporary + folder, name, sizeof name);
  thr_status st = THR_OK;
  int fd = mkstemp(temporary);
  FILE *f = fd >= 0 && fchmod(fd, mode) == 0 ? fdopen(fd, "wb") : NULL;
  if (!f || !write_all(f, t) || rename(temporary, path) != 0) {
    st = write_failed(path, err);
    if (!f && fd >= 0) close(fd);
    if (fd >= 0) unlink(temporary);
  }
  free(temporary);
  return st;
}

/* The same with the signals held back that would leave the temporary file behind. */
static thr_status replace_undisturbed(const thr_text *t, const char *path, mode_t mode, thr_err *err)
{
  sigset_t held, before;
  sigemptyset(&held);
  const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ};
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
    sigaddset(&held, signals[i]);
  sigprocmask(SIG_BLOCK, &held, &before);
  thr_status st = replace_file(t, path, mode, err);
  sigprocmask(SIG_SETMASK, &before, NULL);
  return st;
}

thr_status thr_text_write(const thr_text *t, const char *path, thr_err *err)
{
  if (t->failed) return thr_nomem(err);
  if (strcmp(path, "-") == 0) return write_stdout(t, err);
  struct stat target;
  bool exists = stat(path, &target) == 0;
  if (exists && S_ISDIR(target.st_mode)) return thr_fail(err, THR_EIO, "%s: is a folder; give the name of a file", path);
  if (exists && !S_ISREG(target.st_mode)) { /* a device or pipe (/dev/stdout) must be written through, not replaced */
    FILE *f = fopen(path, "wb");
    return f && write_all(f, t) ? THR_OK : write_failed(path, err);
  }
  if (!exists) {
    mode_t mask = umask(0);
    umask(mask);
    return replace_undisturbed(t, path, 0666 & ~mask, err);
  }
  if (access(path, W_OK) != 0) return write_failed(path, err); /* rename would not ask */
  char *real = realpath(path, NULL);                           /* a link stays a link */
  if (!real) return write_failed(path, err);
  thr_status st = replace_undisturbed(t, real, target.st_mode & 07777, err);
  free(real);
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
