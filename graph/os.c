/* SPDX-License-Identifier: GPL-3.0-or-later */
/* POSIX, and what Linux adds to it. */
#define _GNU_SOURCE /* madvise */
#include "graph/os.h"
#include "graph/status.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/ioctl.h>
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

bool thr_os_remove_folder(const char *path)
{
  return rmdir(path) == 0;
}

/* Returns how many bytes of a path name the folder that its file is in. */
static size_t folder_length(const char *path)
{
  return (size_t)(thr_os_name(path) - path);
}

/* Returns the path that a link leads to, whether a file is there or not, and of anything else the
 * path itself: to be freed. NULL with errno: no memory, or links that go round in a circle. */
static char *follow_links(const char *path)
{
  enum { MOST_LINKS = 40, MOST_BYTES = 4096 };
  char *at = thr_strdup(path), to[MOST_BYTES];
  for (int i = 0; at && i < MOST_LINKS; i++) {
    const ssize_t n = readlink(at, to, sizeof to);
    if (n < 0 || n == sizeof to) return at; /* no link, or nothing at all */

    /* What a link says counts from the folder that it is in. */
    const size_t folder = *to == '/' ? 0 : folder_length(at);
    char *next = thr_calloc(folder + (size_t)n + 1, 1);
    if (next) {
      memcpy(next, at, folder);
      memcpy(next + folder, to, (size_t)n);
    }
    free(at);
    at = next;
  }
  const int why = at ? ELOOP : ENOMEM;
  free(at);
  errno = why;
  return NULL;
}

/* Finds the folder of a path whose links have been followed; false if there is none. */
static bool stat_folder(const char *path, struct stat *about)
{
  const size_t n = folder_length(path);
  char *folder = n ? strndup(path, n) : thr_strdup(".");
  const bool found = folder && stat(folder, about) == 0;
  free(folder);
  return found;
}

/* Are they names of one file in one folder, once it is made? */
static bool will_be_same(const char *a, const char *b)
{
  struct stat in_a, in_b;
  char *x = follow_links(a), *y = follow_links(b);
  const bool same = x && y && strcmp(thr_os_name(x), thr_os_name(y)) == 0 &&
                    stat_folder(x, &in_a) && stat_folder(y, &in_b) && in_a.st_dev == in_b.st_dev &&
                    in_a.st_ino == in_b.st_ino;
  free(x);
  free(y);
  return same;
}

bool thr_os_is_same_file(const char *a, const char *b)
{
  struct stat x, y;
  const bool has_a = stat(a, &x) == 0, has_b = stat(b, &y) == 0;
  if (has_a && has_b) return S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
  return !has_a && !has_b && will_be_same(a, b);
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

/* Waits until what was written is on the disk, where the file is on one: pipes and some file
 * systems know no fsync. */
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

/* The new name is in the folder, which is written back by itself (open group, "fsync"; Linux
 * fsync(2)). Best effort: the file is whole under either name, and a folder that may be written to
 * but not read cannot be opened. */
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

/* Opens a new file beside path; -1 with errno. *temporary is its name, to be freed. */
static int open_beside(const char *path, char **temporary)
{
  static const char name[] =
      ".thread-XXXXXX"; /* short: the folder may allow no longer name than path's */
  const size_t folder = folder_length(path);
  if (!(*temporary = thr_calloc(folder + sizeof name, 1))) {
    errno = ENOMEM;
    return -1;
  }
  memcpy(*temporary, path, folder);
  memcpy(*temporary + folder, name, sizeof name);
  return mkstemp(*temporary);
}

/* A new file beside path, which then takes path's place; mode is what path is to have. */
static bool replace_file(const char *path, mode_t mode, const char *data, size_t n)
{
  char *temporary;
  int fd = open_beside(path, &temporary);
  FILE *f = fd >= 0 && fchmod(fd, mode) == 0 ? fdopen(fd, "wb") : NULL;
  bool done = f && write_all(f, data, n) && rename(temporary, path) == 0;
  int why = errno;
  if (!f && fd >= 0) close(fd);
  if (!done && fd >= 0) unlink(temporary);
  if (done) folder_reaches_disk(path, folder_length(path));
  free(temporary);
  errno = why;
  return done;
}

/* Opens a file beside path and takes it away again. */
static bool try_beside(const char *path)
{
  char *temporary;
  const int fd = open_beside(path, &temporary);
  const int why = errno;
  if (fd >= 0) {
    close(fd);
    unlink(temporary);
  }
  free(temporary);
  errno = why;
  return fd >= 0;
}

/* Holds back the signals that would leave a temporary file behind. */
static void hold_signals(sigset_t *before)
{
  const int signals[] = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ};
  sigset_t held;
  sigemptyset(&held);
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
    sigaddset(&held, signals[i]);
  sigprocmask(SIG_BLOCK, &held, before);
}

static bool replace_undisturbed(const char *path, mode_t mode, const char *data, size_t n)
{
  sigset_t before;
  hold_signals(&before);
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
  if (!exists && errno != ENOENT) return false;
  if (exists && !S_ISREG(target.st_mode)) { /* a device or pipe (/dev/stdout) must be written
                                               through, not replaced */
    FILE *f = fopen(path, "wb");
    return f && write_all(f, data, n);
  }
  if (exists && access(path, W_OK) != 0) return false; /* rename would not ask */
  mode_t mask = umask(0);
  umask(mask);
  char *real = follow_links(path); /* a link stays a link */
  if (!real) return false;
  bool done = replace_undisturbed(real, exists ? target.st_mode & 07777 : 0666 & ~mask, data, n);
  int why = errno;
  free(real);
  errno = why;
  return done;
}

bool thr_os_can_write(const char *path)
{
  struct stat target;
  const bool exists = stat(path, &target) == 0;
  if (!exists && errno != ENOENT) return false;
  if (exists && access(path, W_OK) != 0) return false;
  if (exists && !S_ISREG(target.st_mode)) return true;
  char *real = follow_links(path);
  if (!real) return false;
  sigset_t before;
  hold_signals(&before);
  const bool can = try_beside(real);
  const int why = errno;
  sigprocmask(SIG_SETMASK, &before, NULL);
  free(real);
  errno = why;
  return can;
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

static void (*stop)(int signal);

/* Whoever read what the program prints is gone with the terminal, too: the plan is written all the
 * same. */
static void on_hangup(int signal_number)
{
  (void)signal_number;
  signal(SIGPIPE, SIG_IGN);
  stop(THR_OS_HANGUP);
}

void thr_os_heed_stop(void (*on_stop)(int signal))
{
  struct sigaction act = {.sa_handler = on_stop}, hangup = {.sa_handler = on_hangup}, before;
  stop = on_stop;
  sigaction(SIGINT, &act, NULL);
  sigaction(SIGTERM, &act, NULL); /* what timeout and batch systems send */
  if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &hangup, NULL);
}

void thr_os_tick(int seconds, void (*on_tick)(int signal))
{
  struct sigaction act = {.sa_handler = seconds > 0 ? on_tick : SIG_IGN, .sa_flags = SA_RESTART};
  const struct itimerval every = {{seconds, 0}, {seconds, 0}};
  if (seconds > 0) sigaction(SIGALRM, &act, NULL);
  setitimer(ITIMER_REAL, &every, NULL);
  if (seconds == 0) sigaction(SIGALRM, &act, NULL);
}

int thr_os_processors(void)
{
  long n = sysconf(_SC_NPROCESSORS_ONLN);
  return n > 1 ? n < INT32_MAX ? (int)n : INT32_MAX : 1;
}

int thr_os_columns(int file)
{
  struct winsize size = {0};
  return isatty(file) && ioctl(file, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
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
  return (double)own.tv_sec + 1e-9 * (double)own.tv_nsec + seconds_of(children.ru_utime) +
         seconds_of(children.ru_stime);
}

/* ---- memory ---- */

/* Of pages of 4 kB a million edges take 140,000, and a fault for every one of them, which is a
 * fifth of the time; asked for are pages of 2 MB (Linux, madvise(2)). What it answers counts for
 * nothing. */
void *thr_os_on_large_pages(void *block, size_t bytes)
{
#ifdef MADV_HUGEPAGE
  const size_t page = (size_t)1 << 21, large = page / 2;
  const int said = errno;
  if (block && bytes >= large) {
    char *first =
        (char *)block - (uintptr_t)block % page; /* the whole pages that the block is in */
    (void)madvise(first, ((size_t)((char *)block - first) + bytes + page - 1) / page * page,
                  MADV_HUGEPAGE);
  }
  errno = said;
#else
  (void)bytes;
#endif
  return block;
}
