/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When to stop, and whom to tell how far it is: handed down to every long computation. */
#ifndef THR_LIMITS_H
#define THR_LIMITS_H

#include "graph/plan/plan.h"

#include <signal.h>

struct thr_cord;
struct thr_symmetry_record;

/* {0}: no limit, no interrupt, silent. */
typedef struct {
  double deadline;                          /* thr_clock() at which to stop; 0 = none */
  const volatile sig_atomic_t *interrupted; /* set by a signal handler, or NULL */
  int threads; /* in which independent parts may run (graph/process/process.h); 0 = 1. The results
                  do not depend on it */
  /* NULL, or the work that may still be done, in seconds that are counted (thr_limits_spend) and
   * not measured: it ends a search at the same place on any machine, whatever else that does. Work
   * is over when work_kept of it is left. One thread at a time.
   */
  double *work, work_kept;
  bool
      usual; /* nobody has said how long it may take: it is the usual effort that ends the search */
  double gap; /* as a part of the bound: what is to be least may be so much above it for a search to
                 end; 0: to the proof */
  bool brief; /* so little work is counted that cords are not annealed */
  double weight; /* units of the framework that a weight of a minimum join is worth; 0 = none that
                    anybody is told */
  bool unpriced; /* no walks are priced for a better bound or better cords, which takes seconds */
  /* called now and then with what is being done and the best value and proven bound so far (same
   * unit) */
  void (*progress)(void *user, const char *what, double best, double bound);
  /* called by work whose amount is known beforehand, with the part that is done: 0 .. 1 */
  void (*advance)(void *user, const char *what, double done);
  /* thr_limits_found */
  void (*found)(void *user, const struct thr_cord *cord, int n_cords,
                const struct thr_symmetry_record *symmetry);
  void *user;
} thr_limits;

/* Seconds on a clock that never goes back; only differences mean anything. */
double thr_clock(void);

/* Seconds of the processor that this process has had. */
double thr_processor_clock(void);

/* Is it time to stop? Where work is counted, what is done between two such questions counts as 10
 * microseconds. */
bool thr_limits_stop(const thr_limits *limits);

/* Seconds by the clock that are left, at most `most` and at least 0. */
double thr_limits_left(const thr_limits *limits, double most);

/* Is a value near enough to its bound? But for rounding. */
bool thr_limits_near(const thr_limits *limits, double value, double bound);

/* Work is counted that takes about so many seconds, beyond what thr_limits_stop counts. Without
 * limits->work: nothing. */
void thr_limits_spend(const thr_limits *limits, double seconds);

/* Work that is left where it is counted, below 0: more was done. */
double thr_limits_work(const thr_limits *limits);

/* The same with only a part of the work that is left, 0 .. 1, or of the time where none is counted:
 * the deadline of counted work is that of all parts. */
thr_limits thr_limits_part(const thr_limits *limits, double part);

/* The same with *work seconds that are counted, whatever was counted before; work is borrowed. */
thr_limits thr_limits_counted(const thr_limits *limits, double *work);

/* The same of so little work that cords are not annealed, or of what is counted already; as it was
 * where *work is 0. */
thr_limits thr_limits_brief(const thr_limits *limits, double *work);

/* Cords of the whole framework that may be what is asked for, as soon as there are some and
 * whenever there are better ones: they are what is left if the search has to be ended. Who listens
 * finds out itself whether they are; symmetry: of cords that are copies of each other, else NULL.
 * Nothing is taken over. */
void thr_limits_found(const thr_limits *limits, const struct thr_cord *cord, int n_cords,
                      const struct thr_symmetry_record *symmetry);

#endif
