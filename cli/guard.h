/* Limits that hold whatever a command does: it runs in a child process whose memory the system bounds, and which is ended when
 * its time is over. What the child has found so far it hands to its parent, which outlives it.
 *
 *   guard_end end;
 *   if (guard_fork(&limits, &end)) return conclude(&end);   the parent, after the child's end
 *   ..                                                       the child goes on, and returns its exit code as always */
#ifndef THR_GUARD_H
#define THR_GUARD_H

#include "graph/text.h"

#include <getopt.h>

/* --time-limit and --memory. */
typedef struct {
  double seconds; /* 0 = no limit, < 0 = not said */
  double memory;  /* bytes, 0 = no limit */
} guard_limits;

enum { OPTION_TIME = 900, OPTION_MEMORY }; /* beyond the options that commands number on from each other */
#define GUARD_OPTIONS                                                                                                            \
  {"time-limit", required_argument, NULL, OPTION_TIME},                                                                          \
  {                                                                                                                              \
    "memory", required_argument, NULL, OPTION_MEMORY                                                                             \
  }
#define GUARD_MEMORY_HELP "      --memory SIZE    give up beyond so much memory, as 500MB or 2GB, 0 = any (default: 2GB)\n"
#define GUARD_HELP "      --time-limit S   give up after S seconds, 0 = never (default: 0)\n" GUARD_MEMORY_HELP

guard_limits guard_limits_default(void); /* no time said, 2 GB */

/* Takes one of the options above; false if it is none of them. *ok false: its value was bad (printed). */
bool guard_option(guard_limits *l, const char *command, int option, const char *value, bool *ok);

typedef enum {
  GUARD_DONE,        /* the child ended by itself, with `code` */
  GUARD_TIME,        /* it did not end in its time, and was ended */
  GUARD_INTERRUPTED, /* nor when it was asked to by a signal */
  GUARD_MEMORY,      /* it had no more memory */
  GUARD_DIED         /* of a signal that nobody here sent, or a library ended it */
} guard_reason;

typedef struct {
  guard_reason reason;
  int code;      /* GUARD_DONE: the exit code */
  bool written;  /* its result was out, with exit code `code`: only what comes after is missing */
  thr_text kept; /* what it handed over last; owned by the caller */
  char why[120]; /* the reason in words: "not done after 2 s" */
} guard_end;

/* Forks. Returns false in the child. Returns true in the parent, after the child has ended, or if there could be none (printed:
 * GUARD_DONE with EXIT_INTERNAL). The first SIGINT, SIGTERM or SIGHUP is passed on to the child, which has half a second more
 * then; the second ends both at once, but for another SIGHUP. */
bool guard_fork(const guard_limits *l, guard_end *end);

/* Where there is only one process (in a browser, targets/alone_guard.c), guard_fork returns false, and the command asks this when
 * it is done, with its exit code: true if it left nothing but has kept something, for which *end is then filled as for a parent.
 * False where there are two. */
bool guard_alone(int code, guard_end *end);

/* thr_clock() at which the child must be done; 0 = any time. Without a child 0. */
double guard_deadline(void);

/* From here on there are so many seconds, whatever there were; 0 = any time. */
void guard_allow(double seconds);

/* In the child; nothing without one. kept: replaces what was handed over before. Between writing and written nothing ends the
 * child but a second signal. No memory: what the parent is to say if the child fails now; false if there is no parent. Ending:
 * the child exits with this code by itself, not a library. */
void guard_keep(const thr_text *text);
void guard_writing(void);
void guard_written(int code);
bool guard_no_memory(void);
void guard_ending(int code);

/* What a command does that has nothing to hand over: prints why it ended and returns the exit code. */
int guard_conclude(guard_end *end, const char *missing);

#endif
