/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The only file that knows Emscripten.
 *
 * The linker puts __wrap_x in the place of the library's x (--wrap): the clock, which every search
 * with a time limit asks, also asks the host whether to stop; sbrk, from which malloc has its
 * memory, holds --memory. */
#define _GNU_SOURCE
#include "targets/host.h"

#include <emscripten.h>
#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <sys/resource.h>
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

/* Emscripten measures no processor time. The engine has one thread, which is at work from the first
 * question on. */
static int processor_time(struct timespec *time)
{
  static struct timespec begun;
  if (__real_clock_gettime(CLOCK_MONOTONIC, time)) return -1;
  if (begun.tv_sec == 0 && begun.tv_nsec == 0) begun = *time;
  time->tv_sec -= begun.tv_sec;
  time->tv_nsec -= begun.tv_nsec;
  if (time->tv_nsec < 0) {
    time->tv_nsec += 1000000000;
    time->tv_sec--;
  }
  return 0;
}

int __wrap_clock_gettime(clockid_t id, struct timespec *time)
{
  static double asked;
  static int told;
  if (id == CLOCK_PROCESS_CPUTIME_ID) return processor_time(time);
  const int failed = __real_clock_gettime(id, time);
  if (failed || id != CLOCK_MONOTONIC || told) return failed;
  const double now = (double)time->tv_sec + 1e-9 * (double)time->tv_nsec;
  if (now - asked < ASK) return 0;
  asked = now;
  told = is_stopped();
  if (told) raise(SIGINT); /* as Ctrl-C */
  return 0;
}

int __wrap_getrusage(int who, struct rusage *used);

/* Emscripten's answers with numbers that mean nothing; there are no children. */
int __wrap_getrusage(int who, struct rusage *used)
{
  (void)who;
  *used = (struct rusage){0};
  return 0;
}
