/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many drag experiments at once, in forked processes. */
#ifndef THR_DRAGS_H
#define THR_DRAGS_H

#include "eval/joint/joint.h"
#include "tests/validate/validate.h"

enum { MOST_TURNS = 20 };

typedef struct {
  int n;
  double turn[MOST_TURNS], twist[MOST_TURNS];
  thr_drag drag; /* its turns are set from the above */
} drag_case;

thr_status drags_run(const drag_case *c, int n, thr_drag_result *found, thr_err *err);
const char *drag_status_name(int status);

#endif
