/* For LD_PRELOAD: allocations that fail. All of a process and of the children that it forks are counted together, in a file that
 * outlives them. Environment: FAIL_COUNT, that file, of 8 bytes (0 to begin with); FAIL_AT=k: the k-th allocation fails, and with
 * FAIL_ON=1 every later one. Needs glibc. */
#define _POSIX_C_SOURCE 200809L
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void *memalign(size_t, size_t);

static _Atomic long *count; /* NULL before the constructor has run: nothing fails then */
static long fail_at;
static bool fail_on;

__attribute__((constructor)) static void begin(void)
{
  const char *path = getenv("FAIL_COUNT"), *at = getenv("FAIL_AT");
  int fd = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
  if (fd < 0) return;
  void *page = mmap(NULL, sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  close(fd);
  fail_at = at ? strtol(at, NULL, 10) : 0;
  fail_on = getenv("FAIL_ON") != NULL;
  if (page != MAP_FAILED) count = page;
}

static bool fails(void)
{
  if (!count) return false;
  long k = atomic_fetch_add(count, 1) + 1;
  if (fail_at == 0 || k < fail_at || (k > fail_at && !fail_on)) return false;
  errno = ENOMEM;
  return true;
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
