/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three hand-made threadings of an n x n grid dome (thr_make's node order: i * n + j), the same
 * edges threaded three ways: the cases by which eval's rankings are judged. */
#ifndef THR_THREADINGS_H
#define THR_THREADINGS_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"

typedef enum { THREAD_LINES, THREAD_STAIRS, THREAD_SNAKE, N_THREADINGS } threading_kind;

extern const char *const threading_name[N_THREADINGS]; /* "lines", "stairs", "snake" */

/* lines: every grid line a cord. stairs: every diagonal staircase a cord; both pass each edge once.
 * snake (odd n): one cord through all rows, back and forth, and then through all columns, back to
 * its beginning. Ends anywhere. The frame is copied. */
thr_plan threading_make(const thr_frame *dome, int n, threading_kind kind);

#endif
