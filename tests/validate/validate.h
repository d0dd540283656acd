/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of `make validate`. Each appends a section or two to the report. */
#ifndef THR_VALIDATE_H
#define THR_VALIDATE_H

#include "tests/validate/report.h"
#include "graph/status.h"

thr_status validate_joint(report *r,
                          thr_err *err); /* capstan ratio, straight channel, convergence, seeds */
thr_status validate_cord(report *r,
                         thr_err *err); /* 20 turns against the product over the taut path */
thr_status validate_mitre(report *r, thr_err *err);      /* thesis, Fig. 13 */
thr_status validate_cantilever(report *r, thr_err *err); /* thesis, Fig. 12 */
thr_status validate_ranking(
    report *r, thr_err *err); /* three threadings of the 7x7 dome, under varied settings */

#endif
