/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For LD_PRELOAD: allocations that fail, told apart by the calls that lead to them. All of a
 * process and of the children that it forks share a file that outlives them, FAIL_FILE (a `record`;
 * empty to begin with). Every distinct stack of calls is noted there when it first allocates.
 * FAIL_STACK=hash (hexadecimal): the first allocation with this stack fails, and with FAIL_ON=1
 * every later one of any stack; FAIL_FROM=n: looked for after n allocations only, which is faster.
 * Needs glibc. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#pragma GCC visibility push(default) /* whatever the program is compiled with */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void *memalign(size_t, size_t);

enum { DEPTH = 200, MOST_STACKS = 1 << 18, MOST_CALLS = 1 << 16 };

/* tests/memory/run.sh reads it, but for the last member. */
typedef struct {
  _Atomic int64_t allocations, failed, stacks;
  struct {
    uint64_t stack;
    int64_t at; /* how many allocations there were before */
  } first[MOST_STACKS];
  _Atomic uint64_t known[2 * MOST_STACKS];
} record;

static record *shared; /* NULL before the constructor has run: nothing fails then */
static uint64_t fail_stack;
static int64_t fail_from;
static bool fail_on;
static _Thread_local bool inside __attribute__((tls_model("initial-exec")));

/* 0 is none. */
static uint64_t mix(uint64_t h, uint64_t x)
{
  h = (h ^ x) * 0x9E3779B97F4A7C15u;
  h ^= h >> 29;
  return h + (h == 0);
}

__attribute__((constructor)) static void begin(void)
{
  const char *path = getenv("FAIL_FILE"), *stack = getenv("FAIL_STACK"),
             *from = getenv("FAIL_FROM");
  void *once[1];
  int fd = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (fd < 0) return;
  void *page = ftruncate(fd, sizeof *shared)
                   ? MAP_FAILED
                   : mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  backtrace(once, 1); /* loads what it needs */
  fail_stack = stack ? strtoull(stack, NULL, 16) : 0;
  fail_from = from ? strtoll(from, NULL, 10) : 0;
  fail_on = getenv("FAIL_ON") != NULL;
  if (page != MAP_FAILED) shared = page;
}

/* Of a return address: its place in its module, wherever that was loaded. */
static uint64_t hash_of_call(void *address)
{
  static struct {
    void *address;
    uint64_t hash;
  } call[MOST_CALLS];
  Dl_info in;
  size_t i = mix(0, (uintptr_t)address) % MOST_CALLS;
  if (call[i].address == address) return call[i].hash;
  uint64_t h = (uintptr_t)address;
  if (dladdr(address, &in)) {
    h = mix(0, (uintptr_t)address - (uintptr_t)in.dli_fbase);
    for (const char *s = in.dli_fname; *s; s++)
      h = mix(h, (unsigned char)*s);
  }
  call[i].address = address;
  call[i].hash = h;
  return h;
}

/* A function that calls itself counts once: how deep it is makes no other place. */
static uint64_t hash_of_stack(void)
{
  void *call[DEPTH];
  uint64_t h = 0;
  int n = backtrace(call, DEPTH);
  for (int i = 0; i < n; i++)
    if (i == 0 || call[i] != call[i - 1]) h = mix(h, hash_of_call(call[i]));
  return h;
}

static void note(uint64_t stack, int64_t before)
{
  for (size_t i = stack % (2 * MOST_STACKS), tried = 0; tried < 2 * MOST_STACKS;
       i = (i + 1) % (2 * MOST_STACKS), tried++) {
    uint64_t there = 0;
    if (atomic_compare_exchange_strong(&shared->known[i], &there, stack)) {
      int64_t at = atomic_fetch_add(&shared->stacks, 1);
      if (at >= MOST_STACKS) return;
      shared->first[at].stack = stack;
      shared->first[at].at = before;
      return;
    }
    if (there == stack) return;
  }
}

static bool is_meant(int64_t before)
{
  int64_t none = 0;
  if (before < fail_from) return false;
  uint64_t stack = hash_of_stack();
  if (!fail_stack) note(stack, before);
  return fail_stack == stack && atomic_compare_exchange_strong(&shared->failed, &none, 1);
}

static bool fails(void)
{
  if (!shared || inside) return false;
  bool failed = atomic_load(&shared->failed);
  if (failed && !fail_on) return false;
  inside = true;
  int64_t before = atomic_fetch_add(&shared->allocations, 1);
  failed = failed || is_meant(before);
  inside = false;
  if (failed) errno = ENOMEM;
  return failed;
}

void *malloc(size_t size)
{
  return fails() ? NULL : __libc_malloc(size);
}

void *calloc(size_t n, size_t size)
{
  return fails() ? NULL : __libc_calloc(n, size);
}

void *realloc(void *p, size_t size)
{
  return fails() ? NULL : __libc_realloc(p, size);
}

void *memalign(size_t alignment, size_t size)
{
  return fails() ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
  return memalign(alignment, size);
}

int posix_memalign(void **p, size_t alignment, size_t size)
{
  int before = errno;
  void *made = memalign(alignment, size);
  errno = before;
  if (!made) return ENOMEM;
  *p = made;
  return 0;
}
