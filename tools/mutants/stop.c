/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linked into the test programs that look for mutants. They end at the first assertion that fails (--wrap=_ck_assert_failed), and
 * behind every block of memory that calloc or realloc gives there is a margin of large numbers: whatever reads past the end of an
 * array gets an index, a length or a pointer that does not pass unnoticed, and not a zero by chance. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MARGIN = 64, FILL = 0x43 };

void __wrap__ck_assert_failed(const char *file, int line, const char *expression, const char *message, ...)
    __attribute__((noreturn));

void __wrap__ck_assert_failed(const char *file, int line, const char *expression, const char *message, ...)
{
  (void)file, (void)line, (void)expression, (void)message;
  _exit(1);
}

void *__libc_realloc(void *p, size_t size);

void *realloc(void *p, size_t size)
{
  if (size > PTRDIFF_MAX - MARGIN) return NULL;
  char *out = __libc_realloc(p, size + MARGIN);
  if (out) memset(out + size, FILL, MARGIN);
  return out;
}

void *calloc(size_t n, size_t size)
{
  if (size && n > (PTRDIFF_MAX - MARGIN) / size) return NULL;
  char *out = malloc(n * size + MARGIN);
  if (!out) return NULL;
  memset(out, 0, n * size);
  memset(out + n * size, FILL, MARGIN);
  return out;
}
