/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks the plans of `thread compare --method rise`, and says of each what was seen.
 *
 * The order is one of three: a plan that comes up in all runs has the interval of the pulls at
 * which it does; all others are put behind, by the part of their runs that come up, and within one
 * part by the interval of the part of the faces that stay open. So plans tie whose runs overlap
 * (ranking.c).
 *
 * Example: lines come up in 6 of 6 runs at 1.14 N, 4 cords in 6 of 6 at 1.49 N (1.29 to 1.49), and
 * the snake in none, with 85 of 96 faces closed: ranks 1, 2, 3. */
#include "lib/comparison.h"

#include <math.h>
#include <stdio.h>

/* Puts a plan that was seen in simulation in its place: those that come up in all runs by the pull
 * at which they do, behind them the others by the part of the runs, and of these by their closed
 * faces. */
static void rank_rise(thr_ranking *ranked, const thr_compare_rise *rise, int i)
{
  if (rise->runs == 0) return;
  if (rise->up == rise->runs) {
    ranked->low[i] = rise->pull[0];
    ranked->value[i] = rise->pull[1];
    ranked->high[i] = rise->pull[2];
    return;
  }
  const double open_part = 1e3, part = (double)rise->up / rise->runs,
               behind = thr_ranking_order * (1 + floor(1e6 * (1 - part)));
  ranked->low[i] = behind + open_part * (1 - rise->closed[2] / rise->faces);
  ranked->value[i] = behind + open_part * (1 - rise->closed[1] / rise->faces);
  ranked->high[i] = behind + open_part * (1 - rise->closed[0] / rise->faces);
}

/* Appends "1.3 N", or "1.3 N (1.28 to 1.34)" of several runs. */
static void put_spread(thr_text *text, const double value[3], int runs)
{
  char middle[THR_PLAIN_NUMBER], least[THR_PLAIN_NUMBER], most[THR_PLAIN_NUMBER];
  thr_text_printf(text, "%s N", thr_plain_newtons(value[1], middle));
  if (runs > 1)
    thr_text_printf(text, " (%s to %s)", thr_plain_newtons(value[0], least),
                    thr_plain_newtons(value[2], most));
}

/* Says what was seen of a plan in simulation. */
static void say_rise(const thr_compare_rise *rise, thr_text *text)
{
  if (rise->runs > 1)
    thr_text_printf(text, "comes up in %d of %d runs", rise->up, rise->runs);
  else
    thr_text_append(text, rise->up ? "comes up" : "does not come up");
  if (rise->up > 0) {
    thr_text_append(text, rise->runs > 1 ? ", at " : " at ");
    put_spread(text, rise->pull, rise->up);
  }
  if (rise->up < rise->runs) {
    thr_text_printf(text, "; %g of %d faces closed at most", rise->closed[1], rise->faces);
    if (rise->runs > 1) thr_text_printf(text, " (%g to %g)", rise->closed[0], rise->closed[2]);
    thr_text_printf(text, "; jams between %s and %s", rise->jam[0], rise->jam[1]);
    if (rise->runs - rise->up > 1)
      thr_text_printf(text, " in %d of %d", rise->jams, rise->runs - rise->up);
  }
  if (rise->fell > 0) {
    thr_text_append(text, "; let down, it falls below ");
    put_spread(text, rise->fall, rise->fell);
  }
}

thr_status thr_compare_rank_rises(thr_ranking *ranked, const thr_compare_entry *entries,
                                  thr_err *err)
{
  ranked->words = thr_calloc((size_t)ranked->n, sizeof *ranked->words);
  thr_status st = ranked->words ? THR_OK : thr_nomem(err);
  for (int i = 0; i < ranked->n && !st; i++) {
    thr_text text = {0};
    rank_rise(ranked, &entries[i].rise, i);
    say_rise(&entries[i].rise, &text);
    if (text.failed) st = thr_nomem(err);
    if (!st) snprintf(ranked->words[i], THR_RANKING_WORDS, "%s", text.data);
    thr_text_destroy(&text);
  }
  return st;
}
