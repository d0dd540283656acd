/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the table of `thread advise`, as text and as JSON, and the commands that make its plans.
 *
 * A row is a number of cords and a kind of ends, with the cord that turns most turning as little as
 * was found. The pull at the harder end of a cord is seating tension x exp(mu x reach), N
 * (graph/plan/plan_measures.h); a row shows it at mu and at both ends of the band of mu. ">" marks
 * the row with the fewest cords whose pull stays within the hand even at the upper end, "*" rows on
 * the frontier.
 *
 * Example, of the 7 x 7 dome (cords, ends, cord, overlap, longest cord, turning, pulls):
 *
 *   >  4  at the feet  1995.249 mm  14.3 %  498.8 mm  683 deg  3.21 and 3.27 N  1.81 .. 5.93 N */
#include "cli/print/print.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void advice_put_word(thr_text *text, const char *word)
{
  static const char safe[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,:+=@%";

  /* A word of harmless letters needs no quotes. */
  if (*word && strspn(word, safe) == strlen(word)) {
    thr_text_append(text, word);
    return;
  }

  /* In single quotes nothing is special but the quote itself, which is written as '\'' outside of
   * them. */
  thr_text_append(text, "'");
  for (; *word; word++)
    if (*word == '\'')
      thr_text_append(text, "'\\''");
    else
      thr_text_byte(text, *word);
  thr_text_append(text, "'");
}

void advice_put_cords(thr_text *text, const thr_advice_row *row)
{
  const char *closed = row->ends == THR_ENDS_CLOSED ? "closed " : "";
  const char *where = row->ends == THR_ENDS_CLOSED ? ""
                      : row->ends == THR_ENDS_FEET ? " to the feet"
                      : row->ends == THR_ENDS_ANY  ? " with ends anywhere"
                                                   : " to the nodes named";

  /* Numbers are those of one component. */
  thr_text_printf(text, "%d %s%s", row->cords, closed, cli_plural(row->cords, "cord", "cords"));
  if (row->uneven)
    thr_text_printf(text, " at most in a component, %d in all,", row->all);
  else if (row->all > row->cords)
    thr_text_printf(text, " in every component, %d in all,", row->all);
  thr_text_append(text, where);
}

/* ---- text ---- */

void advice_put_head(thr_text *text, const thr_frame *frame, const thr_physics *physics)
{
  char units[24];

  snprintf(units, sizeof units, "cord, %.15s", frame->units);
  thr_text_printf(text,
                  "%d pieces, %d %s; pull at both ends of every cord, so that %g N is left where "
                  "it is slackest;\n",
                  frame->n_nodes, frame->n_edges,
                  cli_plural(frame->n_edges, "interface", "interfaces"), physics->seating);
  thr_text_printf(text, "friction mu = %g, or anything in its band from %g to %g\n\n", physics->mu,
                  physics->mu_low, physics->mu_high);

  /* The columns of advice_put_row. */
  thr_text_printf(
      text, "   cords\v0  %-11s\v3 %14s\v4 %8s\v7 %10s\v6 %12s\v0 %13s\v2 %19s\v5 %6s\v1  %s\n",
      "ends", units, "overlap", "longest", "most turning", "pull, N", "in the band of mu", "steps",
      "proved");
}

void advice_put_row(thr_text *text, const thr_advice_row *row, double base_length, const char *mark)
{
  const double over = 100 * (row->length / base_length - 1);
  char low[24], pull[64], high[24], band[56], proof[40] = "-";

  /* The band shows how little is known: friction stands in the exponent. */
  snprintf(band, sizeof band, "%s .. %s", thr_plain_newtons(row->pull[THR_ADVICE_LOW], low),
           thr_plain_newtons(row->pull[THR_ADVICE_HIGH], high));

  /* What is proved of the turning. */
  if (row->optimal)
    snprintf(proof, sizeof proof, "it cannot turn less");
  else if (row->bound > 0)
    snprintf(proof, sizeof proof, "turning of at least %.0f deg", floor(thr_degrees(row->bound)));

  /* An overlap that rounds to 0 has no sign. */
  thr_text_printf(text,
                  "%-3s%5d\v0  %-11s\v3 %14.3f\v4 %6.1f %%\v7 %10.4g\v6 %8.0f deg\v0 %13s\v2 "
                  "%19s\v5 %6d\v1  %s\n",
                  mark, row->cords, thr_advice_ends(row->ends), row->length, over < 0.05 ? 0 : over,
                  row->longest, thr_degrees(row->turning),
                  plain_two(row->other, row->pull[THR_ADVICE_MU], pull), band, row->steps, proof);
}

/* Returns what a limit on the pull is, where it is one of the two numbers with a source. */
static const char *hand_words(double hand)
{
  return hand == thr_hand_always ? ", what a hand manages time after time,"
         : hand == thr_hand_most ? ", the most for a hand,"
                                 : "";
}

/* Appends the recommended row with its command, or that no row stays within the hand. */
static void put_choice(thr_text *text, const thr_advice *advice, thr_advice_command *command,
                       const void *user)
{
  char low[24], pull[64], high[24], hand[64];

  plain_force(advice->hand, hand);

  /* No row: the user may allow more. */
  if (advice->chosen < 0) {
    thr_text_printf(text, "no row stays within %s%s at mu = %g; --hand N says what is enough\n",
                    hand, hand_words(advice->hand), advice->physics.mu_high);
    return;
  }

  /* The pull at mu, in the band, and what it stays within. */
  const thr_advice_row *row = &advice->row[advice->chosen];

  /* The recommended cords have the least length: longer ones may be fewer. */
  const thr_advice_row *fewer = NULL;
  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row *other = &advice->row[i];
    if (other->cords < (fewer ? fewer : row)->cords && thr_advice_within(advice, other))
      fewer = other;
  }

  thr_text_append(text, "> ");
  advice_put_cords(text, row);
  thr_text_printf(text, ": %s, or %s to %s N in the band. %s within %s%s even at mu = %g",
                  plain_both(row->other, row->pull[THR_ADVICE_MU], pull),
                  thr_plain_newtons(row->pull[THR_ADVICE_LOW], low),
                  thr_plain_newtons(row->pull[THR_ADVICE_HIGH], high),
                  fewer ? "They stay" : "The fewest found that stay", hand,
                  hand_words(advice->hand), advice->physics.mu_high);
  if (fewer) {
    thr_text_append(text, "; so do ");
    advice_put_cords(text, fewer);
    thr_text_printf(text, ", of %.4g instead of %.4g in all", fewer->length, row->length);
  }
  thr_text_append(text, "\n  ");

  command(user, row, text);
  thr_text_append(text, "\n");
}

void advice_put_table(thr_text *text, const thr_frame *frame, const thr_advice *advice,
                      thr_advice_command *command, const void *user)
{
  advice_put_head(text, frame, &advice->physics);

  /* Recommended: ">"; on the frontier: "*". */
  for (int i = 0; i < advice->n; i++) {
    char mark[4];
    snprintf(mark, sizeof mark, "%s%s", i == advice->chosen ? ">" : " ",
             advice->row[i].frontier ? "*" : " ");
    advice_put_row(text, &advice->row[i], advice->base_length, mark);
  }

  /* What the marks mean, and what is missing. */
  thr_text_append(
      text,
      "\n* no other row is as good in number of cords, cord and pull, and better in one of them");
  if (advice->left_out)
    thr_text_printf(text, "; %d %s nothing %s left out", advice->left_out,
                    cli_plural(advice->left_out, "row that buys", "rows that buy"),
                    cli_plural(advice->left_out, "is", "are"));
  thr_text_append(text, "\n");

  put_choice(text, advice, command, user);
  thr_text_append(text, "any row's plan: ");
  command(user, NULL, text);
  thr_text_append(text, "\n");
}

void advice_put_holding(thr_text *text, const thr_plan *plan)
{
  thr_eval eval;
  if (thr_eval_closed_form(plan, plan->options.physics.seating, &eval, NULL)) return;
  seated_put_holding(text, "  ", plan, &eval.record);
  thr_eval_destroy(&eval);
}

/* ---- JSON ---- */

void advice_put_json(thr_writer *writer, const thr_frame *frame, const thr_advice *advice,
                     thr_advice_command *command, const void *user, const thr_plan *chosen)
{
  thr_write_object(writer, NULL);
  thr_advice_put_json(writer, frame, advice, command, user);
  thr_eval seated;
  if (chosen && !thr_eval_closed_form(chosen, chosen->options.physics.seating, &seated, NULL)) {
    turning_put_ends_json(writer, chosen, &seated);
    thr_eval_destroy(&seated);
  }
  answer_put_files(writer);
  thr_write_close(writer);
}
