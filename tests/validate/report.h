/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report of `make validate`: Markdown tables of numbers next to their expectation, error and
 * bound. */
#ifndef THR_REPORT_H
#define THR_REPORT_H

#include "graph/text.h"

typedef struct {
  thr_text text;
  int rows, outside; /* rows, and how many of them are outside their bound */
} report;

void report_section(report *r, const char *title, const char *about);

/* One row: found must be within bound (relative) of expected. */
void report_relative(report *r, const char *what, double expected, double found, double bound);
/* found must be at most / at least limit. */
void report_at_most(report *r, const char *what, double found, double limit);
void report_at_least(report *r, const char *what, double found, double limit);
/* A yes or no: e.g. an order of plans, or a refusal. found is what was seen, in words. */
void report_holds(report *r, const char *what, const char *expected, const char *found, bool holds);
/* A number that is shown but not judged, with the reason. */
void report_shown(report *r, const char *what, double expected, double found, const char *why);

#endif
