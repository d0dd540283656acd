/* POSIX, and what Linux adds to it. */
#define _GNU_SOURCE /* madvise */
#include "graph/os.h"
#include "graph/status.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

/* ---- paths ---- */

bool thr_os_is_separator(char c)
{
  return c == '/';
}

const char *thr_os_name(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

bool thr_os_is_folder(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

bool thr_os_is_file(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0 && S_ISREG(s.st_mode);
}

bool thr_os_is_no_file(const char *path)
{
  struct stat s;
  return lstat(path, &s) == 0 && !S_ISREG(s.st_mode);
}

bool thr_os_make_folder(const char *path)
{
  return mkdir(path, 0777) == 0;
}

/* As the XDG base directory specification says: relative folders do not count. */
void thr_os_cache_folder(char *path, size_t size)
{
  const char *xdg = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  int n = 0;
  if (xdg && *xdg == '/')
    n = snprintf(path, size, "%s/thread", xdg);
  else if (home && *home == '/')
    n = snprintf(path, size, "%s/.cache/thread", home);
  if (n <= 0 || (size_t)n >= size) path[0] = '\0';
}

/* ---- writing ---- */

/* Waits until what was written is on the disk, where the file is on one: pipes and some file systems know no fsync. */
static bool reach_disk(int fd)
{
  return fsync(fd) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

static bool write_all(FILE *f, const char *data, size_t n)
{
  bool ok = (n == 0 || fwrite(data, 1, n, f) == n) && fflush(f) == 0 && reach_disk(fileno(f));
  int why = errno; /* of what failed first */
  bool closed = fclose(f) == 0;
  if (!ok) errno = why;
  return closed && ok;
}

/* The new name is in the folder, which is written back by itself (open group, "fsync"; Linux fsync(2)). Best effort: the file is
 * whole under either name, and a folder that may be written to but not read cannot be opened. */
static void folder_reaches_disk(const char *path, size_t folder)
{
  char *name = thr_calloc(folder + 2, 1);
  if (!name) return;
  memcpy(name, folder ? path : ".", folder ? folder : 1);
  int fd = open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd >= 0) {
    (void)reach_disk(fd);
    close(fd);
  }
  free(name);
}

/* A new file beside path, which then takes path's place; mode is what path is to have. */
static bool replace_file(const char *path, mode_t mode, const char *data, size_t n)
{
  static const char name[] = ".thread-XXXXXX"; /* short: the folder may allow no longer name than path's */
  size_t folder = (size_t)(thr_os_name(path) - path);
  char *temporary = thr_calloc(folder + sizeof name, 1);
  if (!temporary) {
    errno = ENOMEM;
    return false;
  }
  memcpy(temporary, path, folder);
  memcpy(temporary + folder, name, sizeof name);
  int fd = mkstemp(temporary);
  FILE *f = fd >= 0 && fchmod(fd, mode) == 0 ? fdopen(fd, "wb") : NULL;
  bool done = f && write_all(f, data, n) && rename(temporary, path) == 0;
  int why = errno;
  if (!f && fd >= 0) close(fd);
  if (!done && fd >= 0) unlink(temporary);
  if (done) folder_reaches_disk(path, folder);
  free(temporary);
  errno = why;
  return done;
}

/* The same with the signals held back that would leave the temporary file behind. */
static bool replace_undisturbed(const char *path, mode_t mode, const char *data, size_t n)
{
  sigset_t held, before;
  sigemptyset(&held);
  const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ};
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
    sigaddset(&held, signals[i]);
  sigprocmask(SIG_BLOCK, &held, &before);
  bool done = replace_file(path, mode, data, n);
  int why = errno;
  sigprocmask(SIG_SETMASK, &before, NULL);
  errno = why;
  return done;
}

bool thr_os_write(const char *path, const char *data, size_t n)
{
  struct stat target;
  bool exists = stat(path, &target) == 0;
  if (exists && !S_ISREG(target.st_mode)) { /* a device or pipe (/dev/stdout) must be written through, not replaced */
    FILE *f = fopen(path, "wb");
    return f && write_all(f, data, n);
  }
  if (!exists) {
    mode_t mask = umask(0);
    umask(mask);
    return replace_undisturbed(path, 0666 & ~mask, data, n);
  }
  if (access(path, W_OK) != 0) return false; /* rename would not ask */
  char *real = realpath(path, NULL);         /* a link stays a link */
  if (!real) return false;
  bool done = replace_undisturbed(real, target.st_mode & 07777, data, n);
  int why = errno;
  free(real);
  errno = why;
  return done;
}

/* O_NONBLOCK: a pipe of that name must not stop us. */
int thr_os_read_small(const char *path, char *data, int size)
{
  struct stat info;
  int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return -1;
  ssize_t n = -1, got = 0;
  if (fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size < size) {
    for (n = 0; n < size; n += got) {
      got = read(fd, data + n, (size_t)(size - n));
      if (got < 0 && errno == EINTR)
        got = 0;
      else if (got <= 0)
        break;
    }
    if (got < 0) n = -1;
  }
  close(fd);
  return n < size ? (int)n : -1;
}

/* ---- processes ---- */

void thr_os_heed_stop(void (*on_stop)(int signal))
{
  struct sigaction act = {.sa_handler = on_stop};
  sigaction(SIGINT, &act, NULL);
  sigaction(SIGTERM, &act, NULL); /* what timeout and batch systems send */
}

int thr_os_processors(void)
{
  long n = sysconf(_SC_NPROCESSORS_ONLN);
  return n > 1 ? n < INT32_MAX ? (int)n : INT32_MAX : 1;
}

static double seconds_of(struct timeval time)
{
  return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

double thr_os_processor_seconds(void)
{
  struct timespec own = {0};
  struct rusage children = {0};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &own);
  getrusage(RUSAGE_CHILDREN, &children);
  return (double)own.tv_sec + 1e-9 * (double)own.tv_nsec + seconds_of(children.ru_utime) + seconds_of(children.ru_stime);
}

/* ---- memory ---- */

/* Of pages of 4 kB a million edges take 140,000, and a fault for every one of them, which is a fifth of the time; asked for are
 * pages of 2 MB (Linux, madvise(2)). What it answers counts for nothing. */
void *thr_os_on_large_pages(void *block, size_t bytes)
{
#ifdef MADV_HUGEPAGE
  const size_t page = (size_t)1 << 21, large = page / 2;
  const int said = errno;
  if (block && bytes >= large) {
    char *first = (char *)block - (uintptr_t)block % page; /* the whole pages that the block is in */
    (void)madvise(first, ((size_t)((char *)block - first) + bytes + page - 1) / page * page, MADV_HUGEPAGE);
  }
  errno = said;
#else
  (void)bytes;
#endif
  return block;
}
