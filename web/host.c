/* The only file that knows Emscripten.
 *
 * The linker puts __wrap_x in the place of the library's x (--wrap): the clock, which every search with a time limit asks, also
 * asks the host whether to stop; sbrk, from which malloc has its memory, holds --memory. */
#define _GNU_SOURCE
#include "targets/host.h"

#include <emscripten.h>
#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <sys/stat.h>
#include <time.h>

static const double ASK = 0.05; /* s between two questions whether to stop */

/* clang-format off */
EM_JS(void, give_plan, (const char *json, int n), {
  if (Module['threadPlan']) Module['threadPlan'](UTF8ToString(json, n));
})

EM_JS(int, is_stopped, (void), {
  return Module['threadStopped'] && Module['threadStopped']() ? 1 : 0;
})

EM_JS(int, mask_of_files, (void), {
  return Module['threadUmask'];
})
/* clang-format on */

void host_plan(const char *json, size_t n)
{
  give_plan(json, (int)n);
}

/* Emscripten begins with a mask that leaves files without any rights. */
__attribute__((constructor)) static void begin(void)
{
  umask((mode_t)mask_of_files());
}

/* ---- memory ---- */

void *__real_sbrk(intptr_t increment);
void *__wrap_sbrk(intptr_t increment);

static double most;

void host_bound_memory(double bytes)
{
  most = bytes;
}

void *__wrap_sbrk(intptr_t increment)
{
  const uintptr_t end = (uintptr_t)__real_sbrk(0);
  if (most > 0 && increment > 0 && (double)end + (double)increment > most) {
    errno = ENOMEM;
    return (void *)-1; /* as sbrk says it */
  }
  return __real_sbrk(increment);
}

/* ---- the clock ---- */

int __real_clock_gettime(clockid_t id, struct timespec *time);
int __wrap_clock_gettime(clockid_t id, struct timespec *time);

int __wrap_clock_gettime(clockid_t id, struct timespec *time)
{
  static double asked;
  static int told;
  const int failed = __real_clock_gettime(id, time);
  if (failed || id != CLOCK_MONOTONIC || told) return failed;
  const double now = (double)time->tv_sec + 1e-9 * (double)time->tv_nsec;
  if (now - asked < ASK) return 0;
  asked = now;
  told = is_stopped();
  if (told) raise(SIGINT); /* as Ctrl-C */
  return 0;
}
