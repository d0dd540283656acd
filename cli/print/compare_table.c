/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the comparison of `thread compare`: the table of lib/compare_rows.c with a column for each
 * plan, what it was computed with, and the rankings; as text and as the note of a
 * picture.
 */
#include "cli/print/print.h"

#include <stdio.h>
#include <string.h>

/* Appends the head of the columns: the plans' file names or, if one is wider than a column (16
 * letters), numbers whose meaning is listed above the table. */
static void put_names(thr_text *text, const thr_compare_entry *entries, int n)
{
  bool wide = false;

  for (int i = 0; i < n; i++)
    wide |= strlen(entries[i].path) > 16;

  /* The legend of the numbers. */
  for (int i = 0; i < n && wide; i++)
    thr_text_printf(text, "plan %d  %s\n", i + 1, entries[i].path);
  thr_text_printf(text, "%s%-32s", wide ? "\n" : "", "");

  for (int i = 0; i < n; i++) {
    char number[24];
    snprintf(number, sizeof number, "plan %d", i + 1);
    thr_text_printf(text, "\v0 %16s ", wide ? number : entries[i].path);
  }
}

/* Appends the rows that have words, not numbers: names, objective, ends, and whether the plan is on
 * the frontier. */
static void put_head(thr_text *text, const thr_compare_entry *entries, int n)
{
  put_names(text, entries, n);
  thr_text_printf(text, "\n%-32s", "objective");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, "\v0 %16s ",
                    thr_objective_name(thr_aims_objective(&entries[i].plan.options)));

  /* Where cords may end: at the feet, anywhere, or nowhere. */
  thr_text_printf(text, "\n%-32s", "ends");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, "\v0 %16s ", thr_ends_name(entries[i].plan.options.ends));

  /* A frontier needs something to be compared with. */
  if (n < 2) return;
  thr_text_printf(text, "\n%-32s", "on the frontier");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, "\v0 %16s ", thr_compare_on_frontier(entries, n, i) ? "yes" : "-");
}

/* Returns whether all plans have the same cord and beads. */
static bool is_same_physics(const thr_compare_entry *entries, int n)
{
  for (int i = 1; i < n; i++)
    if (!thr_compare_same_physics(&entries[0], &entries[i])) return false;
  return true;
}

/* Fills at with words for the ends of the two bands of friction: numbers if all plans have the same
 * physics, else "the lower end of mu" and so on. The band of mu_bead is in proportion to that of
 * mu. */
static void name_ends(const thr_physics *physics, bool same, char at[THR_RANKING_ENDS][40])
{
  const double mu[2] = {physics->mu_low, physics->mu_high};

  for (int end = 0; end < 2; end++) {
    const char *const which = end ? "upper" : "lower";

    /* The band of the cords. */
    if (same)
      snprintf(at[end], sizeof at[end], "mu %.3g", mu[end]);
    else
      snprintf(at[end], sizeof at[end], "the %s end of mu", which);

    /* The band of beads and ground. */
    if (same && physics->mu > 0)
      snprintf(at[2 + end], sizeof at[2 + end], "mu_bead %.3g",
               physics->mu_bead * mu[end] / physics->mu);
    else
      snprintf(at[2 + end], sizeof at[2 + end], "the %s end of mu_bead", which);
  }
}

/* Returns whether a row is in the text for n plans. */
static bool is_shown(const thr_compare_entry *entries, int n, int row)
{
  const bool optional = thr_compare_rows[row].optional;

  if (thr_compare_rows[row].machinery && !cli_verbose) return false;

  /* Rows that only some plans have. */
  for (int i = 0; i < n && optional; i++)
    if (!isnan(entries[i].value[row])) return true;
  return !optional;
}

/* Appends a space, a value in 16 columns, and the mark of the best. */
static void put_cell(thr_text *text, int row, double value, bool best)
{
  const int decimals = thr_compare_rows[row].decimals;
  char cell[40];

  /* The number of digits is a property of the row. */
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (isinf(value))
    snprintf(cell, sizeof cell, "> 1e300");
  else if (decimals == -1)
    snprintf(cell, sizeof cell, "%.0f", value);
  else if (decimals < 0)
    snprintf(cell, sizeof cell, "%.*g", -decimals, value);
  else
    snprintf(cell, sizeof cell, "%.*f", decimals, value);

  thr_text_printf(text, "\v0 %16s%s", cell, best ? "*" : " ");
}

void compare_put_text(thr_text *text, const pull_args *args, const thr_compare_entry *entries,
                      int n, const thr_ranking *rankings, int count, const char *const *name)
{
  const thr_physics *first = &entries[0].eval[THR_CAPSTAN].record.physics;
  const bool same = is_same_physics(entries, n);

  /* The rows of wanted methods. Rows of machinery are for --verbose. */
  put_head(text, entries, n);
  for (int k = 0; k < THR_COMPARE_ROWS; k++) {
    if (!thr_compare_wants(args->method, thr_compare_rows[k].method) || !is_shown(entries, n, k))
      continue;
    thr_text_printf(text, "\n%-32s", thr_compare_rows[k].label);
    for (int i = 0; i < n; i++)
      put_cell(text, k, entries[i].value[k], thr_compare_is_best(entries, n, k, i));
  }

  /* Seating tension, pulled ends and friction. */
  thr_text_printf(text, "\n\n* best of the row. Pull: seating tension %g N, pulled at: %s, mu = ",
                  first->seating, args->pull);
  if (same)
    thr_text_printf(text, "%g\n", first->mu);
  else
    thr_text_append(text, "each plan's own\n");

  thr_text_append(text, "of its kind: with as many cords, the same ends, as many passes an edge\n");

  /* One plan alone has nothing to be ranked with. */
  if (n < 2) return;
  thr_text_append(text, "frontier: no other plan is as good in cord, number of cords and pull, and "
                        "better in one of them\n");
  thr_text why = {0};
  const int taken = thr_compare_take(entries, n, args->method, -1),
            next = thr_compare_take(entries, n, args->method, taken);
  const bool differs = thr_compare_put_why(entries, n, args->method, &why);
  thr_text_printf(text,
                  differs ? "\ntake %s rather than %s: %s\n\n" : "\n%s is as good as %s: %s\n\n",
                  name[taken], name[next], why.failed ? "" : why.data);
  text->failed |= why.failed;
  thr_text_destroy(&why);

  /* Rankings of two plans and more. */
  char at[THR_RANKING_ENDS][40];
  name_ends(first, same, at);
  for (int k = 0; k < count; k++) {
    thr_ranking_put_text(&rankings[k], name, text);
    thr_ranking_put_bands(&rankings[k], name, at, text);
  }

  thr_compare_put_agreement(rankings, count, name, text);
}

void compare_put_note(thr_text *text, const pull_args *args, const thr_compare_entry *entries,
                      int n)
{
  const thr_physics *physics = &entries[0].eval[THR_CAPSTAN].record.physics;

  /* Which ends: a list of cords is too long for a note. */
  thr_text_printf(text, "Pull at %s of every cord, ",
                  strcmp(args->pull, "both") == 0 ? "both ends"
                  : strchr(args->pull, '=')       ? "given ends"
                                                  : args->pull);

  /* With what friction. */
  if (is_same_physics(entries, n))
    thr_text_printf(text,
                    "so that %g N is left where it is slackest (closed form; mu = %g, the pale "
                    "bars its band from %g to %g).",
                    physics->seating, physics->mu, physics->mu_low, physics->mu_high);
  else
    thr_text_append(text, "by the closed form, each plan with its own cord and beads; the pale "
                          "bars are the bands of mu.");
}
