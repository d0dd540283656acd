/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the comparison of `thread compare`: the table of compare_rows.c with a column for each
 * plan, what it was computed with, and the rankings; as text, as JSON, and as the note of a
 * picture.
 */
#include "cli/print/print.h"

#include <stdio.h>
#include <string.h>

/* Appends the head of the columns: the plans' file names or, if one is wider than a column (16
 * letters), numbers whose meaning is listed above the table. */
static void put_names(thr_text *text, const compare_entry *entries, int n)
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
static void put_head(thr_text *text, const compare_entry *entries, int n)
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
    thr_text_printf(text, "\v0 %16s ", compare_on_frontier(entries, n, i) ? "yes" : "-");
}

bool compare_same_physics(const compare_entry *one, const compare_entry *other)
{
  const thr_physics *a = &one->eval[THR_CAPSTAN].record.physics,
                    *b = &other->eval[THR_CAPSTAN].record.physics;
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(a, &thr_physics_fields[i]) != thr_physics_get(b, &thr_physics_fields[i]))
      return false;
  return true;
}

/* Returns whether all plans have the same cord and beads. */
static bool is_same_physics(const compare_entry *entries, int n)
{
  for (int i = 1; i < n; i++)
    if (!compare_same_physics(&entries[0], &entries[i])) return false;
  return true;
}

/* Fills at with words for the ends of the two bands of friction: numbers if all plans have the same
 * physics, else "the lower end of mu" and so on. The band of mu_bead is in proportion to that of
 * mu. */
static void name_ends(const thr_physics *physics, bool same, char at[RANKING_ENDS][40])
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

void compare_put_text(thr_text *text, const pull_args *args, const compare_entry *entries, int n,
                      const ranking *rankings, int count, const char *const *name)
{
  const thr_physics *first = &entries[0].eval[THR_CAPSTAN].record.physics;
  const bool same = is_same_physics(entries, n);

  /* The rows of wanted methods. Rows of machinery are for --verbose. */
  put_head(text, entries, n);
  for (int k = 0; k < COMPARE_ROWS; k++) {
    if (!pull_wants(args, compare_rows[k].method) || !compare_is_shown(entries, n, k)) continue;
    thr_text_printf(text, "\n%-32s", compare_rows[k].label);
    for (int i = 0; i < n; i++)
      compare_put_cell(text, k, entries[i].value[k], compare_is_best(entries, n, k, i));
  }

  /* Seating tension, pulled ends and friction. */
  thr_text_printf(text, "\n\n* best of the row. Pull: seating tension %g N, pulled at: %s, mu = ",
                  first->seating, args->pull);
  if (same)
    thr_text_printf(text, "%g\n", first->mu);
  else
    thr_text_append(text, "each plan's own\n");

  /* One plan alone has nothing to be ranked with. */
  if (n < 2) return;
  thr_text_append(text, "frontier: no other plan is as good in cord, number of cords and pull, and "
                        "better in one of them\n");
  thr_text_append(text, "\n");

  /* Rankings of two plans and more. */
  char at[RANKING_ENDS][40];
  name_ends(first, same, at);
  for (int k = 0; k < count; k++) {
    ranking_put_text(&rankings[k], name, text);
    ranking_put_bands(&rankings[k], name, at, text);
  }

  compare_put_agreement(rankings, count, name, text);
}

/* Writes an object for plan i: what it is, its values, its band of pulls, and the rows in which it
 * is the best. */
static void put_plan_json(thr_writer *writer, const pull_args *args, const compare_entry *entries,
                          int n, int i)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "plan", entries[i].path);
  thr_write_hash(writer, "framework", thr_frame_hash(&entries[i].plan.frame));
  thr_write_string(writer, "objective",
                   thr_objective_name(thr_aims_objective(&entries[i].plan.options)));
  thr_write_string(writer, "ends", thr_ends_name(entries[i].plan.options.ends));
  thr_physics_write(&entries[i].eval[THR_CAPSTAN].record.physics, writer, "physics");

  /* Members that are NAN are written as null. */
  for (int k = 0; k < COMPARE_ROWS; k++)
    if (pull_wants(args, compare_rows[k].method))
      thr_write_number(writer, compare_rows[k].key, entries[i].value[k]);
  thr_write_bool(writer, "frontier", compare_on_frontier(entries, n, i));
  thr_write_number(writer, "pull_low", entries[i].eval[THR_CAPSTAN].band[0]);
  thr_write_number(writer, "pull_high", entries[i].eval[THR_CAPSTAN].band[1]);

  if (entries[i].rise.jams > 0) {
    thr_write_array(writer, "rise_jams_between");
    for (int side = 0; side < 2; side++)
      thr_write_string(writer, NULL, entries[i].rise.jam[side]);
    thr_write_close(writer);
  }

  thr_write_array(writer, "best");
  for (int k = 0; k < COMPARE_ROWS; k++)
    if (compare_is_best(entries, n, k, i)) thr_write_string(writer, NULL, compare_rows[k].key);
  thr_write_close(writer);
  thr_write_close(writer);
}

void compare_put_json(thr_text *text, const pull_args *args, const compare_entry *entries, int n,
                      const ranking *rankings, int count, const char *const *name)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);

  thr_write_array(&writer, "plans");
  for (int i = 0; i < n; i++)
    put_plan_json(&writer, args, entries, n, i);

  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);

  thr_write_array(&writer, "rankings");
  for (int k = 0; k < count; k++) {
    thr_write_line(&writer, 1);
    ranking_put_json(&rankings[k], name, &writer);
  }

  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);

  /* Ties do not contradict each other. */
  thr_write_bool(&writer, "agree", compare_agree(rankings, count));
  answer_put_files(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

void compare_put_note(thr_text *text, const pull_args *args, const compare_entry *entries, int n)
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
