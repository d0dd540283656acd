/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time limits and interrupts. */
#define _POSIX_C_SOURCE 200809L
#include "graph/limits.h"

#include <math.h>
#include <time.h>

static double read_clock(clockid_t id)
{
  struct timespec t = {0};
  clock_gettime(id, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double thr_clock(void)
{
  return read_clock(CLOCK_MONOTONIC);
}

double thr_processor_clock(void)
{
  return read_clock(CLOCK_PROCESS_CPUTIME_ID);
}

void thr_limits_spend(const thr_limits *limits, double seconds)
{
  if (limits->work) *limits->work -= seconds;
}

double thr_limits_work(const thr_limits *limits)
{
  return *limits->work - limits->work_kept;
}

double thr_limits_left(const thr_limits *limits, double most)
{
  if ((limits->interrupted && *limits->interrupted) ||
      (limits->work && thr_limits_work(limits) <= 0))
    return 0;
  if (limits->deadline == 0) return most;
  double left = limits->deadline - thr_clock();
  return left < 0 ? 0 : left < most ? left : most;
}

thr_limits thr_limits_part(const thr_limits *limits, double part)
{
  thr_limits some = *limits;
  const double now = thr_clock();
  if (limits->work)
    some.work_kept = fmax(limits->work_kept, *limits->work - part * thr_limits_work(limits));
  else if (limits->deadline > 0)
    some.deadline = now + part * fmax(0, limits->deadline - now);
  return some;
}

thr_limits thr_limits_counted(const thr_limits *limits, double *work)
{
  thr_limits counted = *limits;
  counted.work = work;
  counted.work_kept = 0;
  return counted;
}

thr_limits thr_limits_brief(const thr_limits *limits, double *work)
{
  thr_limits few = *work > 0 && !limits->work ? thr_limits_counted(limits, work) : *limits;
  few.brief = few.work;
  return few;
}

bool thr_limits_near(const thr_limits *limits, double value, double bound)
{
  return value <= bound * (1 + fmax(1e-9, limits->gap));
}

bool thr_limits_stop(const thr_limits *limits)
{
  const double between = 1e-5; /* s */
  thr_limits_spend(limits, between);
  return thr_limits_left(limits, 1) <= 0;
}

void thr_limits_found(const thr_limits *limits, const struct thr_cord *cord, int n_cords,
                      const struct thr_symmetry_record *symmetry)
{
  if (limits->found && n_cords > 0) limits->found(limits->user, cord, n_cords, symmetry);
}
