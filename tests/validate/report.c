/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/validate/report.h"

#include <math.h>
#include <stdio.h>

void report_section(report *r, const char *title, const char *about)
{
  thr_text_printf(
      &r->text,
      "\n## %s\n\n%s\n\n| what | expected | found | error | bound | |\n|---|---|---|---|---|---|\n",
      title, about);
}

static void row(report *r, const char *what, const char *expected, const char *found,
                const char *error, const char *bound, bool holds)
{
  r->rows++;
  r->outside += !holds;
  thr_text_printf(&r->text, "| %s | %s | %s | %s | %s | %s |\n", what, expected, found, error,
                  bound, holds ? "ok" : "**OUTSIDE**");
}

void report_relative(report *r, const char *what, double expected, double found, double bound)
{
  char cell[4][48];
  double error = found / expected - 1;
  snprintf(cell[0], sizeof cell[0], "%.5g", expected);
  snprintf(cell[1], sizeof cell[1], "%.5g", found);
  snprintf(cell[2], sizeof cell[2], "%+.3f %%", 100 * error);
  snprintf(cell[3], sizeof cell[3], "%g %%", 100 * bound);
  row(r, what, cell[0], cell[1], cell[2], cell[3], fabs(error) <= bound); /* NaN is outside */
}

static void limit_row(report *r, const char *what, double found, double limit, bool below)
{
  char cell[2][48];
  snprintf(cell[0], sizeof cell[0], "%s %.4g", below ? "at most" : "at least", limit);
  snprintf(cell[1], sizeof cell[1], "%.4g", found);
  row(r, what, cell[0], cell[1], "", "", below ? found <= limit : found >= limit);
}

void report_at_most(report *r, const char *what, double found, double limit)
{
  limit_row(r, what, found, limit, true);
}

void report_at_least(report *r, const char *what, double found, double limit)
{
  limit_row(r, what, found, limit, false);
}

void report_holds(report *r, const char *what, const char *expected, const char *found, bool holds)
{
  row(r, what, expected, found, "", "", holds);
}

void report_shown(report *r, const char *what, double expected, double found, const char *why)
{
  thr_text_printf(&r->text, "| %s | %.5g | %.5g | %+.3f %% | %s | shown |\n", what, expected, found,
                  100 * (found / expected - 1), why);
}
