/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include "tests/processes.h"

#include <check.h>
#include <errno.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

void pause_ms(long ms)
{
  struct timespec t = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000}, left;
  while (nanosleep(&t, &left) && errno == EINTR)
    t = left;
}

void assert_no_children(void)
{
  int status;
  errno = 0;
  ck_assert_int_eq(waitpid(-1, &status, WNOHANG), -1);
  ck_assert_int_eq(errno, ECHILD);
}

int open_files(void)
{
  int n = 0;
  for (int fd = 0; fd < 256; fd++)
    n += dup2(fd, fd) == fd;
  return n;
}

void allow_files(int most)
{
  struct rlimit files;
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = (rlim_t)most;
  setrlimit(RLIMIT_NOFILE, &files);
}

volatile sig_atomic_t interrupted;

void interrupt(int signal_number)
{
  (void)signal_number;
  interrupted = 1;
}
