/* When to stop, and whom to tell how far it is: handed down to every long computation. */
#ifndef THR_LIMITS_H
#define THR_LIMITS_H

#include <signal.h>
#include <stdbool.h>

/* {0}: no limit, no interrupt, silent. */
typedef struct {
  double deadline;                          /* thr_clock() at which to stop; 0 = none */
  const volatile sig_atomic_t *interrupted; /* set by a signal handler, or NULL */
  double *work; /* NULL, or what linear programmes may still do (lp/lp.h): ends a search at the same place on any machine */
  /* called now and then with what is being done and the best value and proven bound so far (same unit) */
  void (*progress)(void *user, const char *what, double best, double bound);
  /* called by work whose amount is known beforehand, with the part that is done: 0 .. 1 */
  void (*advance)(void *user, const char *what, double done);
  void *user;
} thr_limits;

/* Seconds on a clock that never goes back; only differences mean anything. */
double thr_clock(void);

bool thr_limits_stop(const thr_limits *l);

/* Seconds left, at most `most` and at least 0. */
double thr_limits_left(const thr_limits *l, double most);

#endif
